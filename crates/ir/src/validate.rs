//! Validation of a constraint system: what passes here, later stages accept without further checks.
//!
//! Checked are ids and symbols; poses; rows and their units; `Φ_q`; right sides; variations with their right sides, also those of results;
//! multipliers and reductions; and the symbols allowed in `Φ`, in constant formulas and in monitored ones. Not checked are the units of
//! measures and reactions, the values of formulas, and that derivatives belong to their formulas.

use super::{
    BodyId, ConstraintSystem, CoordinateKind, DeclarationId, DeclarationKind, Forces, Owner, ReductionKind, Row,
    Variations, With,
};
use mechc_expr::{ExprId, Symbol, TIME_SIGNAL};

impl ConstraintSystem {
    /// Checks all invariants and returns the first violation, in terms of the compiler's internals. Takes about as long as printing the
    /// system, so it serves tests and debug builds.
    pub fn validate(&self) -> Result<(), String> {
        self.check_ids()?;
        self.check_poses()?;
        self.check_row_counts()?;
        self.check_pattern()?;
        self.check_right_sides()?;
        self.check_variations(self.variations.as_deref())?;
        self.check_variations(self.results.variations.as_deref())?;
        self.check_symbols()?;
        self.check_dependences()?;
        self.check_row_units()
    }

    fn check_ids(&self) -> Result<(), String> {
        let declarations = self.rows.iter().map(|row| ("row", row.declaration));
        let declarations = declarations
            .chain(self.checks.iter().map(|check| ("check", check.declaration)))
            .chain(self.watches.iter().map(|monitor| ("monitor", monitor.declaration)))
            .chain(self.fits.iter().map(|fit| ("fit", fit.declaration)))
            .chain(self.contact_forces().iter().map(|press| ("press", press.declaration)))
            .chain(self.open_contacts.iter().map(|contact| ("contact", contact.declaration)))
            .chain(
                self.domain_boundaries
                    .iter()
                    .flat_map(|boundary| &boundary.declarations)
                    .map(|id| ("domain boundary", *id)),
            )
            .chain(self.parts_with_derivatives.iter().flat_map(|part| &part.declarations).map(|id| ("part", *id)));
        for (what, declaration) in declarations {
            ensure(declaration.index() < self.declarations.len(), || format!("a {what} of no declaration"))?;
        }
        let points = self.declarations.iter().flat_map(|of| of.points.iter().chain(&of.features));
        for point in points {
            ensure(point.index() < self.points.len(), || "a declaration at no point".to_owned())?;
        }
        let axes = self.declarations.iter().flat_map(|of| &of.axes);
        ensure(axes.into_iter().all(|id| id.index() < self.axes.len()), || "a declaration at no axis".to_owned())?;
        let circles = self.declarations.iter().flat_map(|of| &of.circles);
        ensure(circles.into_iter().all(|id| id.index() < self.circles.len()), || {
            "a declaration at no circle".to_owned()
        })?;
        let through = self.axes.iter().map(|axis| axis.origin).chain(self.circles.iter().map(|circle| circle.center));
        ensure(through.into_iter().all(|id| id.index() < self.points.len()), || {
            "an axis or circle at no point".to_owned()
        })?;
        let bodies = self.points.iter().filter_map(|point| point.body);
        for body in bodies.chain(self.parts.iter().flat_map(|part| part.bodies.iter().copied())) {
            ensure(body.index() < self.bodies.len(), || "a point or part of no body".to_owned())?;
        }
        let columns = self.parts.iter().flat_map(|part| part.poses.clone().chain(part.own.clone()));
        let requested =
            self.parts_with_derivatives.iter().flat_map(|part| &part.columns).map(|&column| column as usize);
        for column in columns.chain(requested) {
            ensure(column < self.coordinates.len(), || "a part with no such coordinate".to_owned())?;
        }
        Ok(())
    }

    /// Checks that each body has three coordinates and that all others belong to joints.
    fn check_poses(&self) -> Result<(), String> {
        const KINDS: [CoordinateKind; 3] = [CoordinateKind::Length, CoordinateKind::Length, CoordinateKind::Angle];
        let is_of = |column: usize, body: BodyId, kind: CoordinateKind| {
            self.coordinates.get(column).is_some_and(|of| of.owner == Owner::Body(body) && of.kind == kind)
        };
        for (id, body) in self.bodies.pairs() {
            let is_whole = body.pose.into_iter().zip(KINDS).all(|(column, kind)| is_of(column, id, kind));
            ensure(is_whole, || format!("the pose of `{}` is not its own", body.name))?;
        }
        let of_bodies = self.coordinates.iter().filter(|of| matches!(of.owner, Owner::Body(_))).count();
        ensure(of_bodies == 3 * self.bodies.len(), || "a body with more than a pose".to_owned())?;
        let is_joint = |id: DeclarationId| matches!(self.declarations.get(id.index()), Some(of) if matches!(of.kind, DeclarationKind::Joint(_)));
        for coordinate in &self.coordinates {
            let is_owned = match coordinate.owner {
                Owner::Body(_) => true,
                Owner::Joint(joint) => is_joint(joint),
            };
            ensure(is_owned, || format!("`{}` is of no joint", coordinate.name))?;
        }
        Ok(())
    }

    /// Checks that the rows of a declaration are adjacent, and their number.
    fn check_row_counts(&self) -> Result<(), String> {
        let mut next = self.rows.iter().peekable();
        for (id, declaration) in self.declarations.pairs() {
            let mut count = 0;
            while next.next_if(|row| row.declaration == id).is_some() {
                count += 1;
            }
            ensure(count == declaration.rows, || format!("{count} rows of `{}`", declaration.name))?;
        }
        ensure(next.next().is_none(), || "rows out of the order of their declarations".to_owned())
    }

    /// Checks that the rows of a joint that are left have the units of its kind.
    fn check_row_units(&self) -> Result<(), String> {
        let mut expected_units = self.declarations.map(|declaration| match declaration.kind {
            DeclarationKind::Joint(kind) => Some(kind.rows.iter()),
            DeclarationKind::Constraint | DeclarationKind::Driver => None,
        });
        for (k, Row { declaration, unit, .. }) in self.rows.iter().enumerate() {
            ensure(unit.is_finite(), || format!("a unit of row {k} that is none"))?;
            let matches_kind =
                expected_units[*declaration].as_mut().is_none_or(|units| units.any(|expected| expected == unit));
            ensure(matches_kind, || format!("row {k} is in {}", unit.display_unit()))?;
        }
        Ok(())
    }

    fn check_pattern(&self) -> Result<(), String> {
        ensure(self.phi_q.rows() == self.rows.len(), || "`Φ_q` has other rows than `Φ`".to_owned())?;
        for row in 0..self.rows.len() {
            let entries = self.phi_q.row(row);
            let is_sorted = entries.windows(2).all(|pair| pair[0].0 < pair[1].0);
            let is_inside = entries.iter().all(|&(column, _)| (column as usize) < self.coordinates.len());
            ensure(is_sorted && is_inside, || format!("the pattern of row {row}"))?;
            let is_zero = |&(_, id): &(u32, ExprId)| self.graph.as_const(id) == Some(0.0);
            ensure(!entries.iter().any(is_zero), || format!("an entry of row {row} that vanishes"))?;
        }
        Ok(())
    }

    fn check_right_sides(&self) -> Result<(), String> {
        for (k, side) in self.right_sides.iter().enumerate() {
            let is_whole = side.entries.len() == self.rows.len();
            ensure(is_whole, || format!("{} entries with {:?}", side.entries.len(), side.with))?;
            let is_new = self.right_sides[..k].iter().all(|other| other.with != side.with);
            let is_defined = match side.with {
                With::Time(order) => (1..=3).contains(&order),
                With::Input(k) => k < self.inputs.len(),
                With::Param(k) => k < self.params.len(),
            };
            ensure(is_new && is_defined, || format!("a right side with {:?}", side.with))?;
        }
        let is_determined_by_time = !self.nu().is_empty() && !self.gamma().is_empty();
        ensure(self.rows.is_empty() || is_determined_by_time, || "no `ν` or no `γ`".to_owned())
    }

    /// Checks that variations refer to existing variables, and have a right side for each row.
    fn check_variations(&self, variations: Option<&Variations>) -> Result<(), String> {
        let Some(variations) = variations else { return Ok(()) };
        let is_variable = |variable: u32| (variable as usize) < variations.variables.len();
        for (k, variation) in variations.listed().iter().enumerate() {
            let (first, second) = variation.by;
            let is_defined = is_variable(first) && second.is_none_or(is_variable);
            ensure(is_defined, || format!("variation {k} by nothing"))?;
            let is_whole = variation.rights.iter().all(|right| right.len() == self.rows.len());
            ensure(is_whole, || format!("variation {k} with other right sides than rows"))?;
            let is_whole = variation.forces.is_empty() || variation.forces.len() == self.coordinates.len();
            ensure(is_whole, || format!("variation {k} with other forces than coordinates"))?;
        }
        let columns = &mut variations.appended.iter();
        ensure(columns.all(|column| is_variable(column.variable)), || "a column by nothing".to_owned())
    }

    /// Checks that all symbols in formulas other than equations are defined.
    fn check_symbols(&self) -> Result<(), String> {
        let of_forces = self.forces.iter().flat_map(Forces::formulas);
        let of_rows = self.conditions.iter().map(|of| of.positive);
        let of_rows = of_rows.chain(self.watches.iter().map(|of| of.value)).chain(of_forces);
        let of_rows =
            of_rows.chain(self.domain_boundaries.iter().flat_map(|boundary| [boundary.gauge, boundary.slope]));
        let of_rows: Vec<ExprId> = of_rows.chain(self.measures.iter().map(|measure| measure.value)).collect();
        let variations = self.variations.as_deref();
        for symbol in self.graph.symbols_of_all(&of_rows) {
            ensure(self.is_defined(symbol, variations), || format!("{symbol:?} is of nothing"))?;
        }
        let of_results = self.results.reductions.iter().flat_map(|reduction| {
            let time = if let ReductionKind::At(time) = reduction.kind { Some(time) } else { None };
            time.into_iter().chain(reduction.window.into_iter().flatten()).chain([reduction.of])
        });
        let of_results: Vec<ExprId> = of_results.chain(self.results.outcomes.iter().map(|of| of.value)).collect();
        let variations = self.results.variations.as_deref();
        for symbol in self.graph.symbols_of_all(&of_results) {
            let is_reduction = matches!(symbol, Symbol::Named(k) if (k as usize) < self.results.reductions.len());
            ensure(is_reduction || self.is_defined(symbol, variations), || {
                format!("{symbol:?} in results is of nothing")
            })?;
        }
        let needed = self.forces.as_ref().is_none_or(|forces| forces.needed.len() == self.coordinates.len());
        ensure(needed, || "other forces than coordinates".to_owned())
    }

    fn is_defined(&self, symbol: Symbol, variations: Option<&Variations>) -> bool {
        let is_variation = |k: u32| variations.is_some_and(|all| (k as usize) < all.listed().len());
        match symbol {
            Symbol::Param(k) => (k as usize) < self.params.len(),
            Symbol::Shift(_) | Symbol::Time | Symbol::Signal { index: TIME_SIGNAL, .. } => true,
            Symbol::Signal { index, .. } => self.inputs.iter().any(|input| input.index == index),
            Symbol::Coordinate { index, order } => (index as usize) < self.coordinates.len() && order <= 3,
            Symbol::Varied { index, order, variation } => {
                (index as usize) < self.coordinates.len() && order <= 2 && is_variation(variation)
            }
            Symbol::Multiplier(row) => self.forces.is_some() && (row as usize) < self.rows.len(),
            Symbol::VariedMultiplier { row, variation } => {
                self.forces.is_some() && (row as usize) < self.rows.len() && is_variation(variation)
            }
            Symbol::Named(_) => false,
        }
    }

    fn check_dependences(&self) -> Result<(), String> {
        let fixed = self.coordinates.iter().map(|coordinate| coordinate.estimate);
        let fixed = fixed.chain(self.points.iter().flat_map(|point| point.at));
        let fixed = fixed.chain(self.axes.iter().flat_map(|axis| axis.direction));
        for formula in fixed.chain(self.circles.iter().map(|circle| circle.radius)) {
            let dependence = self.graph.dependence(formula);
            ensure(dependence.is_constant(), || "an estimate or feature that is not of parameters alone".to_owned())?;
        }
        let of_equations: Vec<ExprId> = self.phi().into_iter().chain(self.checks.iter().map(|of| of.phi)).collect();
        for symbol in self.graph.symbols_of_all(&of_equations) {
            ensure(self.may_stand_in_phi(symbol), || format!("{symbol:?} in `Φ`"))?;
        }
        Ok(())
    }

    fn may_stand_in_phi(&self, symbol: Symbol) -> bool {
        match symbol {
            Symbol::Param(k) => (k as usize) < self.params.len(),
            Symbol::Shift(_) => true,
            Symbol::Time => !self.has_signals,
            Symbol::Signal { index, order } => {
                self.has_signals && order == 0 && self.inputs.iter().any(|of| of.index == index)
            }
            Symbol::Coordinate { index, order } => order == 0 && (index as usize) < self.coordinates.len(),
            Symbol::Named(_) | Symbol::Varied { .. } | Symbol::Multiplier(_) | Symbol::VariedMultiplier { .. } => false,
        }
    }
}

fn ensure(holds: bool, fault: impl Fn() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(fault()) }
}

#[cfg(test)]
mod tests {
    use super::{BodyId, ConstraintSystem, CoordinateKind, DeclarationId, DeclarationKind, Owner, Row, With};
    use crate::{
        Body, Coordinate, Declaration, DomainBoundary, JointSpec, Measure, Monitor, MonitorKind, Outcome, Point, Units,
        Written,
    };
    use mechc_expr::{ExprId, Graph, Symbol, Unary};
    use mechc_text::source::{Sources, Span};
    use mechc_text::vocabulary::Dimension;

    /// Returns two arms with a measure: the first is pinned to the ground and driven, the second pinned to its tip.
    fn system() -> ConstraintSystem {
        let mut sources = Sources::default();
        let file = sources.add("arms.mech", "");
        let span: Span = sources.end_of(file);
        let mut graph = Graph::new();
        let q: Vec<ExprId> = (0..6).map(|index| graph.symbol(Symbol::Coordinate { index, order: 0 })).collect();
        let (zero, time) = (graph.constant(0.0), graph.symbol(Symbol::Time));
        let (cosine, sine) = (graph.unary(Unary::Cos, q[2]), graph.unary(Unary::Sin, q[2]));
        let tip = [graph.add(q[0], cosine), graph.add(q[1], sine)];
        let phi = [q[0], q[1], graph.sub(q[3], tip[0]), graph.sub(q[4], tip[1]), graph.sub(q[2], time)];
        let rows = phi.into_iter().enumerate().map(|(k, phi)| Row {
            declaration: DeclarationId::from(k / 2),
            phi,
            unit: if k < 4 { Dimension::LENGTH } else { Dimension::ANGLE },
        });
        let body =
            |k: usize| Body { name: format!("arm{k}"), span, pose_span: None, pose: [3 * k, 3 * k + 1, 3 * k + 2] };
        let point = |body: Option<usize>| Point { body: body.map(BodyId::from), name: None, at: [zero; 2] };
        let coordinate = |k: usize| Coordinate {
            name: format!("q{k}"),
            owner: Owner::Body((k / 3).into()),
            kind: if k % 3 == 2 { CoordinateKind::Angle } else { CoordinateKind::Length },
            estimate: zero,
            scale: 1.0,
        };
        let declaration = |(k, kind): (usize, DeclarationKind)| Declaration {
            name: format!("d{k}"),
            span,
            kind,
            rows: if k < 2 { 2 } else { 1 },
            points: if k < 2 { vec![k.into(), (k + 1).into()] } else { Vec::new() },
            features: Vec::new(),
            axes: Vec::new(),
            circles: Vec::new(),
            at: None,
            written: None,
            is_referenced: false,
        };
        let revolute = JointSpec::named("revolute").map(DeclarationKind::Joint).expect("a joint");
        let units = Units { si: "m".to_owned(), printed: ["m", "m/s", "m/s^2"].map(str::to_owned), scale: [1.0; 3] };
        let written = Written {
            name: "arms".to_owned(),
            span,
            params: Vec::new(),
            has_signals: false,
            bodies: (0..2).map(body).collect(),
            points: [None, Some(0), Some(1)].map(point).into_iter().collect(),
            coordinates: (0..6).map(coordinate).collect(),
            declarations: [revolute, revolute, DeclarationKind::Driver]
                .into_iter()
                .enumerate()
                .map(declaration)
                .collect(),
            rows: rows.collect(),
            forces: None,
            variations: None,
            measures: vec![Measure { name: "far".to_owned(), value: tip[0], first: None, second: None, span, units }],
            conditions: Vec::new(),
            watches: Vec::new(),
            open_contacts: Vec::new(),
            fits: Vec::new(),
            parts: Vec::new(),
            parts_with_derivatives: Vec::new(),
            length: 1.0,
            analysis: None,
            graph,
        };
        ConstraintSystem::of(written, false)
    }

    /// Returns what `validate` reports for a system after a modification.
    fn broken(how: impl Fn(&mut ConstraintSystem)) -> String {
        let mut system = system();
        assert_eq!(system.validate(), Ok(()));
        how(&mut system);
        system.validate().expect_err("it is broken")
    }

    #[test]
    fn ids_refer_to_something() {
        assert_eq!(broken(|s| s.rows[0].declaration = DeclarationId::from(99)), "a row of no declaration");
        assert_eq!(broken(|s| s.points[1.into()].body = Some(99.into())), "a point or part of no body");
        assert_eq!(broken(|s| s.declarations[0.into()].points.push(99.into())), "a declaration at no point");
    }

    #[test]
    fn a_body_has_its_three_coordinates() {
        let fault = broken(|s| s.bodies[0.into()].pose.swap(1, 2));
        assert!(fault.starts_with("the pose of"), "{fault}");
        let fault = broken(|s| s.coordinates[4].owner = Owner::Body(0.into()));
        assert!(fault.starts_with("the pose of"), "{fault}");
    }

    #[test]
    fn rows_follow_their_declarations() {
        let fault = broken(|s| s.declarations[0.into()].rows += 1);
        assert!(fault.starts_with("2 rows of"), "{fault}");
        assert!(broken(|s| s.rows.swap(0, 2)).starts_with("0 rows of"));
    }

    #[test]
    fn rows_are_in_their_units() {
        assert_eq!(broken(|s| s.rows[0].unit = Dimension::AREA), "row 0 is in m^2");
        assert_eq!(broken(|s| s.rows[0].unit.time = f64::NAN), "a unit of row 0 that is none");
    }

    #[test]
    fn right_sides_have_an_entry_for_each_row() {
        let fault = broken(|s| s.right_sides[0].entries.truncate(1));
        assert!(fault.ends_with("entries with Time(1)"), "{fault}");
        assert_eq!(broken(|s| s.right_sides[1].with = With::Param(99)), "a right side with Param(99)");
        assert_eq!(broken(|s| s.right_sides.truncate(1)), "no `ν` or no `γ`");
    }

    #[test]
    fn symbols_outside_the_equations_are_defined() {
        let named = |s: &mut ConstraintSystem| s.graph.symbol(Symbol::Named(7));
        let coordinate = |s: &mut ConstraintSystem| s.graph.symbol(Symbol::Coordinate { index: 999, order: 1 });
        let fault = broken(|s| {
            let value = named(s);
            s.measures[0].value = value;
        });
        assert_eq!(fault, "Named(7) is of nothing");
        let fault = broken(|s| {
            let (gauge, slope) = (coordinate(s), coordinate(s));
            s.domain_boundaries.push(DomainBoundary { gauge, slope, declarations: Vec::new() });
        });
        assert!(fault.starts_with("Coordinate { index: 999"), "{fault}");
        let fault = broken(|s| {
            let value = named(s);
            let units = s.measures[0].units.clone();
            let outcome = Outcome { name: String::new(), span: s.span, value, units, unknown_is_false: false };
            s.results.outcomes.push(outcome);
        });
        assert_eq!(fault, "Named(7) in results is of nothing");
        let fault = broken(|s| {
            let force = s.graph.symbol(Symbol::Multiplier(0));
            s.watches.push(Monitor { value: force, kind: MonitorKind::Tangents, scale: 1.0, declaration: 0.into() });
        });
        assert_eq!(fault, "Multiplier(0) is of nothing", "no forces are requested");
    }

    #[test]
    fn a_pattern_is_sorted_and_without_zeros() {
        let with = |s: &mut ConstraintSystem, entries: &[(u32, f64)]| {
            let entries: Vec<_> = entries.iter().map(|&(column, x)| (column, s.graph.constant(x))).collect();
            let rest: Vec<Vec<_>> = (1..s.rows.len()).map(|row| s.phi_q.row(row).to_vec()).collect();
            s.phi_q = crate::SparseRows::new();
            s.phi_q.push(entries);
            for row in rest {
                s.phi_q.push(row);
            }
        };
        assert_eq!(broken(|s| with(s, &[(0, 0.0)])), "an entry of row 0 that vanishes");
        assert_eq!(broken(|s| with(s, &[(1, 1.0), (0, 1.0)])), "the pattern of row 0");
        assert_eq!(broken(|s| with(s, &[(999, 1.0)])), "the pattern of row 0");
    }

    #[test]
    fn forbidden_symbols_are_found() {
        let coordinate = Symbol::Coordinate { index: 0, order: 0 };
        let fault = broken(|s| s.coordinates[0].estimate = s.graph.symbol(coordinate));
        assert!(fault.starts_with("an estimate"), "{fault}");
        assert_eq!(broken(|s| s.rows[0].phi = s.graph.symbol(Symbol::Named(0))), "Named(0) in `Φ`");
        let velocity = Symbol::Coordinate { index: 0, order: 1 };
        assert!(broken(|s| s.rows[0].phi = s.graph.symbol(velocity)).ends_with("in `Φ`"));
    }
}
