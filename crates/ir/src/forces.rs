//! Forces of a determined motion: the multipliers `λ` of `Φ_qᵀ λ = p`, one for each equation.
//!
//! `p = M q̈ + … − Q` is the inertia of the bodies, less weights and loads (Lagrange's equations of the first kind; E. J. Haug,
//! *Computer-Aided Kinematics and Dynamics of Mechanical Systems*, 1989, 11.3). The equations exert `Φ_qᵀ λ` on the coordinates.

use super::{Condition, ConstraintSystem, DeclarationId, SparseRows};
use mechc_expr::{Dependence, ExprId, Symbol};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

/// The equations for the multipliers.
#[derive(Clone, Debug)]
pub struct Forces {
    /// `p`, one entry per coordinate [N for a length, N·m for an angle, J for a pure number].
    pub needed: Vec<ExprId>,
    /// Columns of reactions and efforts of all joints, constraints and drivers, if requested.
    pub reactions: Vec<Reaction>,
    /// True if the reactions only serve pictures, and may be omitted where they are not determined.
    pub only_for_drawing: bool,
    /// The loads.
    pub loads: Vec<LoadForce>,
    /// Normal forces of contacts.
    pub presses: Vec<ContactForce>,
}

/// A load, as its formula gives it, before it is applied.
#[derive(Clone, Debug)]
pub struct LoadForce {
    /// Name.
    pub name: String,
    /// Span of the name.
    pub span: Span,
    /// Force or torque in SI.
    pub force: ExprId,
    /// Amount by which the distance of a load along a distance exceeds the length below which it has no direction (m).
    pub excess: Option<ExprId>,
    /// Conditions under which the formula has a value.
    pub conditions: Vec<Condition>,
}

/// Normal force of a contact.
#[derive(Clone, Copy, Debug)]
pub struct ContactForce {
    /// The contact.
    pub declaration: DeclarationId,
    /// Normal force (N), negative where the contact pulls. If the sides of the bodies are unknown, positive to the left of the tangent.
    pub force: ExprId,
    /// True if the sides of the bodies are known.
    pub is_sided: bool,
}

/// A column of what a joint exerts or a constraint or driver supplies; in pictures also of a load.
#[derive(Clone, Debug)]
pub struct Reaction {
    /// Name, such as `big_end.fx` or `motor.effort`.
    pub name: String,
    /// Value in SI.
    pub value: ExprId,
    /// SI unit: `N`, `N*m`.
    pub unit: String,
    /// Span of the declaration's name.
    pub span: Span,
}

impl LoadForce {
    /// Returns the formulas of the load and its conditions.
    pub fn formulas(&self) -> impl Iterator<Item = ExprId> {
        let conditions = self.conditions.iter().map(|condition| condition.positive);
        [self.force].into_iter().chain(self.excess).chain(conditions)
    }
}

/// Inertia and applied forces: `Φ_qᵀ λ = M q̈ − Q`.
#[derive(Clone, Debug)]
pub struct Mechanics {
    /// `M`, by rows (kg, kg·m, kg·m²).
    pub mass_matrix: SparseRows,
    /// `Q`, by coordinate (N, N·m): weights, loads, and velocity terms of bodies whose centroids are off their origins.
    pub applied: Vec<ExprId>,
}

impl Forces {
    /// Returns all formulas.
    pub fn formulas(&self) -> impl Iterator<Item = ExprId> {
        let loads = self.loads.iter().flat_map(LoadForce::formulas);
        let columns = self.reactions.iter().map(|of| of.value).chain(loads);
        columns.chain(self.presses.iter().map(|of| of.force)).chain(self.needed.iter().copied())
    }
}

impl ConstraintSystem {
    /// Returns the mass matrix and the applied forces; `None` if forces are not requested.
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

    /// Returns `p` of `Φ_qᵀ λ = p`, one entry per coordinate; empty if forces are not requested.
    #[must_use]
    pub fn required_forces(&self) -> &[ExprId] {
        self.forces.as_ref().map_or(&[], |forces| &forces.needed)
    }

    /// Returns the columns of reactions and efforts; empty if they are not requested.
    #[must_use]
    pub fn reactions(&self) -> &[Reaction] {
        self.forces.as_ref().map_or(&[], |forces| &forces.reactions)
    }

    /// Returns the loads; empty if forces are not requested.
    #[must_use]
    pub fn loads(&self) -> &[LoadForce] {
        self.forces.as_ref().map_or(&[], |forces| &forces.loads)
    }

    /// Returns the normal forces of contacts; empty if forces are not requested.
    #[must_use]
    pub fn contact_forces(&self) -> &[ContactForce] {
        self.forces.as_ref().map_or(&[], |forces| &forces.presses)
    }

    /// Returns all formulas of columns, measures, results and contact forces that contain multipliers.
    #[must_use]
    pub fn formulas_with_forces(&self) -> Vec<ExprId> {
        let columns = self.reactions().iter().map(|of| of.value).chain(self.contact_forces().iter().map(|of| of.force));
        let results = self.results.reductions.iter().map(|of| of.of);
        let all = columns.chain(self.measures.iter().map(|of| of.value)).chain(results);
        all.filter(|&id| self.graph.dependence(id).on(Dependence::FORCES)).collect()
    }

    /// Removes reactions that only serve pictures, and contact forces, unless `is_kept` returns true.
    pub fn retain_forces(&mut self, mut is_kept: impl FnMut(ExprId) -> bool) {
        if let Some(forces) = &mut self.forces {
            forces.reactions.retain(|of| !forces.only_for_drawing || is_kept(of.value));
            forces.presses.retain(|press| is_kept(press.force));
        }
    }

    /// Renumbers multipliers after rows have been removed; those of removed rows become zero.
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
        let of_forces = self.forces.iter_mut().flat_map(|Forces { reactions, presses, .. }| {
            let reactions = reactions.iter_mut().map(|reaction| &mut reaction.value);
            reactions.chain(presses.iter_mut().map(|press| &mut press.force))
        });
        let varied = [&mut self.variations, &mut self.results.variations].into_iter().flatten();
        let locations: Vec<&mut ExprId> = formulas
            .chain(of_forces)
            .chain(reduced)
            .chain(varied.flat_map(|varied| varied.formulas_with_forces()))
            .collect();
        let roots: Vec<ExprId> = locations.iter().map(|location| **location).collect();
        for (location, id) in locations.into_iter().zip(self.graph.substituted(&roots, of)) {
            *location = id;
        }
    }

    /// Returns `p − Φ_qᵀ λ`, one entry per coordinate; empty unless forces are requested and varied.
    pub(super) fn open_forces(&mut self) -> Vec<ExprId> {
        let mut open = self.required_forces().to_vec();
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
