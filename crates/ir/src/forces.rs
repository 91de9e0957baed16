//! What holds a determined motion: the multipliers `λ` of `Φ_qᵀ λ = p`, of which each equation has one.
//!
//! `p = M q̈ + … − Q` is what the inertia of the bodies asks for, less what weights and loads give (Lagrange's equations of the first
//! kind; E. J. Haug, *Computer-Aided Kinematics and Dynamics of Mechanical Systems*, 1989, 11.3). The equations exert `Φ_qᵀ λ`
//! on the coordinates.

use super::{Condition, ConstraintSystem, DeclarationId, SparseRows};
use mechc_expr::{Dependence, ExprId, Symbol};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

/// The equations for the multipliers.
#[derive(Clone, Debug)]
pub struct Forces {
    /// `p`, one entry per coordinate [N for a length, N·m for an angle, J for a pure number].
    pub needed: Vec<ExprId>,
    /// What is tabulated of all joints, constraints and drivers, where that is asked for.
    pub reactions: Vec<Reaction>,
    /// Whether they are there to be drawn, and may be left out where they are not determined.
    pub are_pictured: bool,
    /// The loads.
    pub loads: Vec<LoadForce>,
    /// Of contacts.
    pub presses: Vec<Press>,
}

/// A load, as its formula gives it.
#[derive(Clone, Debug)]
pub struct LoadForce {
    /// Its name.
    pub name: String,
    /// The place of that.
    pub span: Span,
    /// In SI.
    pub force: ExprId,
    /// Of one on a distance: by how much that is longer than what has no direction (m).
    pub excess: Option<ExprId>,
    /// What must hold for the formula to have a value.
    pub conditions: Vec<Condition>,
}

/// What a contact presses with.
#[derive(Clone, Copy, Debug)]
pub struct Press {
    /// The contact.
    pub declaration: DeclarationId,
    /// The normal force (N); below zero where it pulls. Where it is not known which side the bodies are on, to the left of the tangent.
    pub force: ExprId,
    /// Whether that is known.
    pub is_sided: bool,
}

/// A column of what a joint exerts, or of what a constraint or driver supplies; in pictures of what a load is, too.
#[derive(Clone, Debug)]
pub struct Reaction {
    /// `big_end.fx`, `motor.effort`
    pub name: String,
    /// Its value in SI.
    pub value: ExprId,
    /// Its SI unit: `N`, `N*m`.
    pub unit: String,
    /// The place of the declaration's name.
    pub span: Span,
}

impl LoadForce {
    /// All formulas of it.
    pub fn formulas(&self) -> impl Iterator<Item = ExprId> {
        let conditions = self.conditions.iter().map(|condition| condition.positive);
        [self.force].into_iter().chain(self.excess).chain(conditions)
    }
}

/// What multipliers have to hold, in the words of mechanics: `Φ_qᵀ λ = M q̈ − Q`.
#[derive(Clone, Debug)]
pub struct Mechanics {
    /// `M`, by rows (kg, kg·m, kg·m²).
    pub mass_matrix: SparseRows,
    /// `Q`, by coordinate (N, N·m): weights, loads, and what turning bodies need whose centres are not at their origins.
    pub applied: Vec<ExprId>,
}

impl Forces {
    /// All formulas of it.
    pub fn formulas(&self) -> impl Iterator<Item = ExprId> {
        let loads = self.loads.iter().flat_map(LoadForce::formulas);
        let columns = self.reactions.iter().map(|of| of.value).chain(loads);
        columns.chain(self.presses.iter().map(|of| of.force)).chain(self.needed.iter().copied())
    }
}

impl ConstraintSystem {
    /// What multipliers have to hold, in the words of mechanics; nothing where nobody asks for forces.
    pub fn mechanics(&mut self) -> Option<Mechanics> {
        let needed = self.forces.as_ref()?.needed.clone();
        let mut mass_matrix = SparseRows::new();
        for &of in &needed {
            mass_matrix.push(self.graph.slopes(of, 2));
        }
        let nothing = self.graph.constant(0.0);
        let at_rest = self
            .graph
            .substituted(&needed, |symbol| matches!(symbol, Symbol::Coordinate { order: 2, .. }).then_some(nothing));
        let applied = at_rest.into_iter().map(|of| self.graph.neg(of)).collect();
        Some(Mechanics { mass_matrix, applied })
    }

    /// `p` of `Φ_qᵀ λ = p`, one entry per coordinate; none where nobody asks for forces.
    #[must_use]
    pub fn needed_forces(&self) -> &[ExprId] {
        self.forces.as_ref().map_or(&[], |forces| &forces.needed)
    }

    /// The columns of reactions and efforts; none where they are not asked for.
    #[must_use]
    pub fn reactions(&self) -> &[Reaction] {
        self.forces.as_ref().map_or(&[], |forces| &forces.reactions)
    }

    /// The loads, as their formulas give them; none where nobody asks for forces.
    #[must_use]
    pub fn loads(&self) -> &[LoadForce] {
        self.forces.as_ref().map_or(&[], |forces| &forces.loads)
    }

    /// What contacts press with; none where nobody asks for forces.
    #[must_use]
    pub fn presses(&self) -> &[Press] {
        self.forces.as_ref().map_or(&[], |forces| &forces.presses)
    }

    /// All that is told of forces: columns, measures, what results are of, and what contacts press with.
    #[must_use]
    pub fn formulas_with_forces(&self) -> Vec<ExprId> {
        let columns = self.reactions().iter().map(|of| of.value).chain(self.presses().iter().map(|of| of.force));
        let results = self.results.reductions.iter().map(|of| of.of);
        let all = columns.chain(self.measures.iter().map(|of| of.value)).chain(results);
        all.filter(|&id| self.graph.dependence(id).on(Dependence::FORCES)).collect()
    }

    /// Leaves out what nobody asked for: columns of what is drawn, and what contacts press with.
    pub fn retain_forces(&mut self, mut is_kept: impl FnMut(ExprId) -> bool) {
        if let Some(forces) = &mut self.forces {
            forces.reactions.retain(|of| !forces.are_pictured || is_kept(of.value));
            forces.presses.retain(|press| is_kept(press.force));
        }
    }

    /// Multipliers get the numbers that their rows have when some are taken out; nobody asks for those of rows that are not kept.
    pub(super) fn renumber_multipliers(&mut self, kept: &[usize]) {
        if self.forces.is_none() {
            return;
        }
        let varied = [&self.variations, &self.results.variations].into_iter().flatten();
        let variations = varied.map(|variations| variations.count()).max().unwrap_or(0) as u32;
        let nothing = self.graph.constant(0.0);
        let mut renumbered = FxHashMap::default();
        for (new, &old) in (0..).zip(kept) {
            let old = old as u32;
            renumbered.insert(Symbol::Multiplier(old), self.graph.symbol(Symbol::Multiplier(new)));
            for variation in 0..variations {
                let [old, new] = [old, new].map(|row| Symbol::VariedMultiplier { row, variation });
                renumbered.insert(old, self.graph.symbol(new));
            }
        }
        let of = |symbol: Symbol| match symbol {
            Symbol::Multiplier(_) | Symbol::VariedMultiplier { .. } => {
                Some(renumbered.get(&symbol).copied().unwrap_or(nothing))
            }
            _ => None,
        };
        let formulas = self.measures.iter_mut().map(|measure| &mut measure.value);
        let reduced = self.results.reductions.iter_mut().map(|reduction| &mut reduction.of);
        let own = self.forces.iter_mut().flat_map(|Forces { reactions, presses, .. }| {
            let reactions = reactions.iter_mut().map(|reaction| &mut reaction.value);
            reactions.chain(presses.iter_mut().map(|press| &mut press.force))
        });
        let varied = [&mut self.variations, &mut self.results.variations].into_iter().flatten();
        let places: Vec<&mut ExprId> =
            formulas.chain(own).chain(reduced).chain(varied.flat_map(|varied| varied.formulas_with_forces())).collect();
        let roots: Vec<ExprId> = places.iter().map(|place| **place).collect();
        for (place, id) in places.into_iter().zip(self.graph.substituted(&roots, of)) {
            *place = id;
        }
    }

    /// What is left of `Φ_qᵀ λ = p`, one entry per coordinate, where forces are asked for and varied.
    pub(super) fn open_forces(&mut self) -> Vec<ExprId> {
        let mut open = self.needed_forces().to_vec();
        if open.is_empty() || self.variations.is_none() && self.results.variations.is_none() {
            return Vec::new();
        }
        for row in 0..self.rows.len() {
            let multiplier = self.graph.symbol(Symbol::Multiplier(row as u32));
            for &(column, slope) in self.phi_q.row(row) {
                let exerted = self.graph.mul(slope, multiplier);
                open[column as usize] = self.graph.sub(open[column as usize], exerted);
            }
        }
        open
    }
}
