//! What must hold of a constraint system, put to the test. What passes here, the rooms behind take without asking.

use super::{
    BodyId, ConstraintSystem, CoordinateKind, DeclarationId, DeclarationKind, JointKind, Owner, Row, RowUnit, With,
};
use crate::expr::{ExprId, Symbol};

impl ConstraintSystem {
    /// Looks at all that must hold, and says the first thing that does not, in the words of who works on the compiler. Takes about as long
    /// as printing the system: for tests and debug builds.
    pub fn validate(&self) -> Result<(), String> {
        self.every_id_is_of_something()?;
        self.poses_are_of_their_bodies()?;
        self.rows_are_counted()?;
        self.phi_q_is_sparse()?;
        self.right_sides_are_whole()?;
        self.formulas_hold_what_they_may()?;
        self.rows_are_measured_in_their_units()
    }

    fn every_id_is_of_something(&self) -> Result<(), String> {
        let declarations = self.rows.iter().map(|row| ("row", row.declaration));
        let declarations = declarations
            .chain(self.checks.iter().map(|check| ("check", check.declaration)))
            .chain(self.watches.iter().map(|watch| ("watch", watch.declaration)))
            .chain(self.fits.iter().map(|fit| ("fit", fit.declaration)))
            .chain(self.rims.iter().flat_map(|rim| &rim.declarations).map(|id| ("rim", *id)))
            .chain(self.asking_parts.iter().flat_map(|part| &part.declarations).map(|id| ("part", *id)));
        for (what, declaration) in declarations {
            holds(declaration.index() < self.declarations.len(), || format!("a {what} of no declaration"))?;
        }
        let points = self.declarations.iter().flat_map(|of| of.points.iter().chain(&of.features));
        for point in points {
            holds(point.index() < self.points.len(), || "a declaration at no point".to_owned())?;
        }
        let axes = self.declarations.iter().flat_map(|of| &of.axes);
        holds(axes.into_iter().all(|id| id.index() < self.axes.len()), || "a declaration at no axis".to_owned())?;
        let circles = self.declarations.iter().flat_map(|of| &of.circles);
        holds(circles.into_iter().all(|id| id.index() < self.circles.len()), || {
            "a declaration at no circle".to_owned()
        })?;
        let through = self.axes.iter().map(|axis| axis.origin).chain(self.circles.iter().map(|circle| circle.center));
        holds(through.into_iter().all(|id| id.index() < self.points.len()), || {
            "an axis or circle at no point".to_owned()
        })?;
        let bodies = self.points.iter().filter_map(|point| point.body);
        for body in bodies.chain(self.parts.iter().flat_map(|part| part.bodies.iter().copied())) {
            holds(body.index() < self.bodies.len(), || "a point or part of no body".to_owned())?;
        }
        let columns = self.parts.iter().flat_map(|part| part.poses.clone().chain(part.own.clone()));
        let asked = self.asking_parts.iter().flat_map(|part| &part.columns).map(|&column| column as usize);
        for column in columns.chain(asked) {
            holds(column < self.coordinates.len(), || "a part with no such coordinate".to_owned())?;
        }
        Ok(())
    }

    /// Three coordinates of each body, and the others of joints.
    fn poses_are_of_their_bodies(&self) -> Result<(), String> {
        const KINDS: [CoordinateKind; 3] = [CoordinateKind::Length, CoordinateKind::Length, CoordinateKind::Angle];
        let is_of = |column: usize, body: BodyId, kind: CoordinateKind| {
            self.coordinates.get(column).is_some_and(|of| of.owner == Owner::Body(body) && of.kind == kind)
        };
        for (id, body) in self.bodies.pairs() {
            let is_whole = body.pose.into_iter().zip(KINDS).all(|(column, kind)| is_of(column, id, kind));
            holds(is_whole, || format!("the pose of `{}` is not its own", body.name))?;
        }
        let of_bodies = self.coordinates.iter().filter(|of| matches!(of.owner, Owner::Body(_))).count();
        holds(of_bodies == 3 * self.bodies.len(), || "a body with more than a pose".to_owned())?;
        let is_joint = |id: DeclarationId| matches!(self.declarations.get(id.index()), Some(of) if matches!(of.kind, DeclarationKind::Joint(_)));
        for coordinate in &self.coordinates {
            let is_owned = match coordinate.owner {
                Owner::Body(_) => true,
                Owner::Joint(joint) => is_joint(joint),
            };
            holds(is_owned, || format!("`{}` is of no joint", coordinate.name))?;
        }
        Ok(())
    }

    /// The rows of a declaration stand together, and are as many as it says.
    fn rows_are_counted(&self) -> Result<(), String> {
        let mut next = self.rows.iter().peekable();
        for (id, declaration) in self.declarations.pairs() {
            let mut count = 0;
            while next.next_if(|row| row.declaration == id).is_some() {
                count += 1;
            }
            holds(count == declaration.rows, || format!("{count} rows of `{}`", declaration.name))?;
        }
        holds(next.next().is_none(), || "rows out of the order of their declarations".to_owned())
    }

    /// The rows of a joint are measured in what its kind has, those that are left of them.
    fn rows_are_measured_in_their_units(&self) -> Result<(), String> {
        let mut coming = self.declarations.map(|declaration| match declaration.kind {
            DeclarationKind::Joint(kind) => Some(units_of(kind).iter()),
            DeclarationKind::Constraint | DeclarationKind::Driver => None,
        });
        for (k, Row { declaration, unit, .. }) in self.rows.iter().enumerate() {
            holds(unit.dimension.is_finite(), || format!("a unit of row {k} that is none"))?;
            let is_its = coming[*declaration].as_mut().is_none_or(|units| units.any(|wanted| wanted == unit));
            holds(is_its, || format!("row {k} is in {unit}"))?;
        }
        Ok(())
    }

    fn phi_q_is_sparse(&self) -> Result<(), String> {
        holds(self.phi_q.rows() == self.rows.len(), || "`Φ_q` has other rows than `Φ`".to_owned())?;
        for row in 0..self.rows.len() {
            let entries = self.phi_q.row(row);
            let is_sorted = entries.windows(2).all(|pair| pair[0].0 < pair[1].0);
            let is_inside = entries.iter().all(|&(column, _)| (column as usize) < self.coordinates.len());
            holds(is_sorted && is_inside, || format!("the pattern of row {row}"))?;
            let is_zero = |&(_, id): &(u32, ExprId)| self.graph.as_const(id) == Some(0.0);
            holds(!entries.iter().any(is_zero), || format!("an entry of row {row} that vanishes"))?;
        }
        Ok(())
    }

    fn right_sides_are_whole(&self) -> Result<(), String> {
        for (k, side) in self.right_sides.iter().enumerate() {
            let is_whole = side.entries.len() == self.rows.len();
            holds(is_whole, || format!("{} entries with {:?}", side.entries.len(), side.with))?;
            let is_new = self.right_sides[..k].iter().all(|other| other.with != side.with);
            let is_of_something = match side.with {
                With::Time(order) => (1..=3).contains(&order),
                With::Input(k) => k < self.inputs.len(),
                With::Param(k) => k < self.params.len(),
            };
            holds(is_new && is_of_something, || format!("a right side with {:?}", side.with))?;
        }
        let is_determined_by_time = !self.nu().is_empty() && !self.gamma().is_empty();
        holds(self.rows.is_empty() || is_determined_by_time, || "no `ν` or no `γ`".to_owned())
    }

    fn formulas_hold_what_they_may(&self) -> Result<(), String> {
        let fixed = self.coordinates.iter().map(|coordinate| coordinate.estimate);
        let fixed = fixed.chain(self.points.iter().flat_map(|point| point.at));
        let fixed = fixed.chain(self.axes.iter().flat_map(|axis| axis.direction));
        for formula in fixed.chain(self.circles.iter().map(|circle| circle.radius)) {
            let dependence = self.graph.dependence(formula);
            holds(dependence.is_constant(), || "an estimate or feature that is not of parameters alone".to_owned())?;
        }
        let of_equations: Vec<ExprId> = self.phi().into_iter().chain(self.checks.iter().map(|of| of.phi)).collect();
        for symbol in self.graph.symbols_of_all(&of_equations) {
            holds(self.may_stand_in_phi(symbol), || format!("{symbol:?} in `Φ`"))?;
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

/// What the rows of a joint are measured in, in their order.
fn units_of(kind: JointKind) -> &'static [RowUnit] {
    const LENGTH: RowUnit = RowUnit::LENGTH;
    match kind {
        JointKind::Translational => &[LENGTH, RowUnit::NUMBER],
        JointKind::Weld => &[LENGTH, LENGTH, RowUnit::ANGLE],
        JointKind::RevoluteRevolute => &[RowUnit::AREA],
        JointKind::RevoluteTranslational | JointKind::RackPinion => &[LENGTH],
        JointKind::Cam => &[LENGTH, LENGTH, RowUnit::AREA],
        JointKind::Revolute
        | JointKind::Gear
        | JointKind::InternalGear
        | JointKind::PointFollower
        | JointKind::FlatFollower => &[LENGTH, LENGTH],
    }
}

fn holds(it: bool, fault: impl Fn() -> String) -> Result<(), String> {
    if it { Ok(()) } else { Err(fault()) }
}

#[cfg(test)]
mod tests {
    use super::{ConstraintSystem, DeclarationId, Owner, With};
    use crate::expr::Symbol;
    use crate::ir::RowUnit;
    use crate::{Cancel, Choice, Memory, Parsed, Redundant};

    fn system() -> ConstraintSystem {
        let text = include_str!("../../examples/hoeken.mech");
        let checked = Parsed::of("hoeken.mech", text).check(&Choice::default(), &Memory::default());
        let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
        compiled.expect("it is determined").system().clone()
    }

    /// What is said of a system that something was done to.
    fn broken(how: impl Fn(&mut ConstraintSystem)) -> String {
        let mut system = system();
        assert_eq!(system.validate(), Ok(()));
        how(&mut system);
        system.validate().expect_err("it is broken")
    }

    #[test]
    fn ids_are_of_something() {
        assert_eq!(broken(|s| s.rows[0].declaration = DeclarationId::from(99)), "a row of no declaration");
        assert_eq!(broken(|s| s.points[1.into()].body = Some(99.into())), "a point or part of no body");
        assert_eq!(broken(|s| s.declarations[0.into()].points.push(99.into())), "a declaration at no point");
    }

    #[test]
    fn a_body_has_its_three_coordinates() {
        let said = broken(|s| s.bodies[0.into()].pose.swap(1, 2));
        assert!(said.starts_with("the pose of"), "{said}");
        let said = broken(|s| s.coordinates[4].owner = Owner::Body(0.into()));
        assert!(said.starts_with("the pose of"), "{said}");
    }

    #[test]
    fn rows_are_those_of_their_declarations() {
        let said = broken(|s| s.declarations[0.into()].rows += 1);
        assert!(said.starts_with("2 rows of"), "{said}");
        assert!(broken(|s| s.rows.swap(0, 2)).starts_with("0 rows of"));
    }

    #[test]
    fn rows_are_in_their_units() {
        assert_eq!(broken(|s| s.rows[0].unit = RowUnit::AREA), "row 0 is in m^2");
        assert_eq!(broken(|s| s.rows[0].unit.dimension.time = f64::NAN), "a unit of row 0 that is none");
    }

    #[test]
    fn right_sides_have_an_entry_for_each_row() {
        let said = broken(|s| s.right_sides[0].entries.truncate(1));
        assert!(said.ends_with("entries with Time(1)"), "{said}");
        assert_eq!(broken(|s| s.right_sides[1].with = With::Param(99)), "a right side with Param(99)");
        assert_eq!(broken(|s| s.right_sides.truncate(1)), "no `ν` or no `γ`");
    }

    #[test]
    fn a_matrix_holds_no_zeros_and_is_in_order() {
        let with = |s: &mut ConstraintSystem, entries: &[(u32, f64)]| {
            let entries: Vec<_> = entries.iter().map(|&(column, x)| (column, s.graph.constant(x))).collect();
            let rest: Vec<Vec<_>> = (1..s.rows.len()).map(|row| s.phi_q.row(row).to_vec()).collect();
            s.phi_q = crate::ir::SparseRows::new();
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
    fn formulas_hold_nothing_else() {
        let coordinate = Symbol::Coordinate { index: 0, order: 0 };
        let said = broken(|s| s.coordinates[0].estimate = s.graph.symbol(coordinate));
        assert!(said.starts_with("an estimate"), "{said}");
        assert_eq!(broken(|s| s.rows[0].phi = s.graph.symbol(Symbol::Named(0))), "Named(0) in `Φ`");
        let velocity = Symbol::Coordinate { index: 0, order: 1 };
        assert!(broken(|s| s.rows[0].phi = s.graph.symbol(velocity)).ends_with("in `Φ`"));
    }
}
