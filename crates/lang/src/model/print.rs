//! The model as readable text: names are resolved, values are in SI units.

use super::{
    Argument, AxisId, BodyId, Direction, EquationForm, Frame, Joint, JointFeature, MeasuredArgument, Mechanism, Named,
    PointId, Profile, Quantity, Reduction,
};
use mechc_expr::{ExprId, Printer, Symbol, number};
use mechc_text::vocabulary::ArgumentSpec;
use rustc_hash::FxHashMap;

/// A mechanism as text. Subformulas that occur several times have names, so that each is written out once.
struct Text<'m> {
    model: &'m Mechanism,
    names: FxHashMap<ExprId, String>,
}

impl Text<'_> {
    /// Returns the name of a point; for a literal point its coordinates.
    fn point_text(&self, id: PointId, text: &dyn Fn(ExprId) -> String) -> String {
        let point = &self.model[id];
        match &point.name {
            Some(name) => format!("{}.{name}", self.model.frame_name(point.frame)),
            None => format!("({}, {})", text(point.at[0]), text(point.at[1])),
        }
    }

    fn axis_text(&self, id: AxisId) -> String {
        format!("{}.{}", self.model.frame_name(self.model[id].frame), self.model[id].name)
    }

    fn profile_text(&self, profile: Profile) -> String {
        format!("{}.{}", self.model.frame_name(profile.frame(self.model)), profile.name(self.model))
    }

    fn direction_text(&self, direction: Direction) -> String {
        match direction {
            Direction::Frame(frame) => self.model.frame_name(frame).to_owned(),
            Direction::Axis(axis) => self.axis_text(axis),
        }
    }

    fn quantity_text(&self, quantity: Quantity, text: &dyn Fn(ExprId) -> String) -> String {
        let point = |id: PointId| self.point_text(id, text);
        match quantity {
            Quantity::X(None, p) => format!("x({})", point(p)),
            Quantity::Y(None, p) => format!("y({})", point(p)),
            Quantity::X(Some(p), q) => format!("x({}, {})", point(p), point(q)),
            Quantity::Y(Some(p), q) => format!("y({}, {})", point(p), point(q)),
            Quantity::Distance(p, q) => format!("distance({}, {})", point(p), point(q)),
            Quantity::Angle(None, b) => format!("angle({})", self.direction_text(b)),
            Quantity::Angle(Some(b), c) => format!("angle({}, {})", self.direction_text(b), self.direction_text(c)),
            Quantity::Rotation(joint, None) => format!("rotation({})", self.model[joint].declared.name),
            Quantity::Rotation(joint, Some((u, v))) => {
                format!("rotation({}, {}, {})", self.model[joint].declared.name, self.axis_text(u), self.axis_text(v))
            }
            Quantity::Displacement(joint, ..) => format!("displacement({})", self.model[joint].declared.name),
            Quantity::Corner(points) => format!("angle({})", points.map(&point).join(", ")),
            Quantity::Measured(measured) => {
                let argument = |argument: MeasuredArgument| match argument {
                    MeasuredArgument::Point(id) => point(id),
                    MeasuredArgument::Frame(frame) => self.model.frame_name(frame).to_string(),
                    MeasuredArgument::Joint(joint) => self.model[joint].declared.name.clone(),
                };
                let arguments: Vec<String> = measured.arguments().map(argument).collect();
                format!("{}({})", measured.word.word.name, arguments.join(", "))
            }
        }
    }

    fn write_masses(&self, f: &mut std::fmt::Formatter<'_>, body: BodyId) -> std::fmt::Result {
        let text = |id: ExprId| self.formula_text(id);
        for of in self.model.masses.iter().filter(|mass| mass.body == body) {
            let at = self.point_text(of.at, &text);
            writeln!(f, "    mass {} at {at} inertia {}", text(of.amount), text(of.inertia))?;
        }
        Ok(())
    }

    /// Returns a formula of the model as text.
    fn formula_text(&self, id: ExprId) -> String {
        self.print(id, false)
    }

    /// Returns a formula as text. If `whole`, a formula that has a name is written out too.
    fn print(&self, id: ExprId, whole: bool) -> String {
        let text = |inner: ExprId| self.formula_text(inner);
        let printer = Printer::new(&self.model.graph, |symbol| match symbol {
            Symbol::Param(k) => self.model.params[k as usize].declared.name.clone(),
            Symbol::Time => "t".to_owned(),
            Symbol::Signal { index, .. } => self.model.inputs[index as usize].declared.name.clone(),
            Symbol::Named(k) => match self.model.named[k as usize] {
                Named::Quantity(_, quantity) => self.quantity_text(quantity, &text),
                Named::Derivative(inner) => format!("der({})", self.formula_text(inner)),
                Named::Force(_, force) => force.written(self.model),
                Named::Exists(_, quantity) => format!("exists {}", self.quantity_text(quantity, &text)),
                Named::By(inner, variable) => {
                    let by = &self.model.variables[variable as usize].declared.name;
                    format!("der({}, {by})", self.formula_text(inner))
                }
                Named::Reduction(k) => {
                    let Reduction { kind, of, window, .. } = &self.model.reductions[k as usize];
                    kind.written(&self.formula_text(*of), *window, text)
                }
                Named::Argument => "u".to_owned(),
            },
            Symbol::Shift(_) => "0".to_owned(),
            Symbol::Coordinate { .. } | Symbol::Varied { .. } => "q".to_owned(),
            Symbol::Multiplier(_) | Symbol::VariedMultiplier { .. } => "lambda".to_owned(),
        })
        .with_names(&self.names)
        .for_readers();
        if whole { printer.definition(id) } else { printer.text(id) }
    }

    fn joint_text(&self, joint: &Joint) -> String {
        let text = |id: ExprId| self.formula_text(id);
        let feature = |feature: JointFeature| match feature {
            JointFeature::Point(point) => self.point_text(point, &text),
            JointFeature::Axis(axis) => self.axis_text(axis),
            JointFeature::Profile(profile) => self.profile_text(profile),
        };
        let argument = |argument: &Argument| match argument {
            Argument::Value(id) => text(*id),
            Argument::Word(word) => (*word).to_owned(),
        };
        let arguments: Vec<String> =
            joint.features.map(feature).into_iter().chain(joint.arguments.iter().map(argument)).collect();
        let is_drawn = joint.spec.arguments.contains(&ArgumentSpec::Phase) && joint.value().is_none();
        let drawn = if is_drawn { ", meshing as drawn" } else { "" };
        format!("{}({}){drawn}", joint.spec.name(), arguments.join(", "))
    }

    fn write_features(&self, f: &mut std::fmt::Formatter<'_>, frame: Frame) -> std::fmt::Result {
        for point in self.model.points.iter().filter(|point| point.frame == frame) {
            // Literal points are written out where they are used.
            let Some(name) = &point.name else {
                continue;
            };
            writeln!(f, "    point {name} = ({}, {})", self.formula_text(point.at[0]), self.formula_text(point.at[1]))?;
        }
        for axis in self.model.axes.iter().filter(|axis| axis.frame == frame) {
            let text = |id: ExprId| self.formula_text(id);
            let [dx, dy] = axis.direction.map(text);
            writeln!(f, "    axis {} = {} along ({dx}, {dy})", axis.name, self.point_text(axis.origin, &text))?;
        }
        self.write_profiles(f, frame)
    }

    fn write_tables(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if !self.model.graph.tables().is_empty() {
            writeln!(f, "\ntables, in SI")?;
        }
        for table in self.model.graph.tables() {
            let text = |id: &ExprId| self.formula_text(*id);
            let rows: Vec<String> =
                table.knots.iter().zip(&table.values).map(|(x, y)| format!("({}, {})", text(x), text(y))).collect();
            let periodic = if table.periodic { "periodic " } else { "" };
            writeln!(f, "  {} = {periodic}spline [{}]", table.name, rows.join(", "))?;
        }
        Ok(())
    }

    fn write_profiles(&self, f: &mut std::fmt::Formatter<'_>, frame: Frame) -> std::fmt::Result {
        let text = |id: ExprId| self.formula_text(id);
        for circle in self.model.circles.iter().filter(|circle| circle.frame == frame) {
            let center = self.point_text(circle.center, &text);
            writeln!(f, "    circle {} = {center} radius {}", circle.name, text(circle.radius))?;
        }
        for curve in self.model.curves.iter().filter(|curve| curve.frame == frame) {
            // The argument of every curve is printed as `u`.
            let [x, y] = curve.at.map(text);
            let estimate = curve.estimate.map_or(String::new(), |estimate| format!(" at {}", text(estimate)));
            writeln!(f, "    curve {}(u) = ({x}, {y}){estimate}", curve.name)?;
        }
        Ok(())
    }

    /// Writes the ground, bodies and parts with their features.
    fn write_frames(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "\nground")?;
        self.write_features(f, Frame::Ground)?;
        for (id, body) in self.model.body_ids().zip(&self.model.bodies) {
            let [x, y, phi] = body.pose.map(|part| self.formula_text(part));
            writeln!(f, "\nbody {} at ({x}, {y}, {phi})", body.declared.name)?;
            self.write_features(f, Frame::Body(id))?;
            self.write_masses(f, id)?;
        }
        for (part, frame) in self.model.parts.iter().zip(self.model.part_frames()) {
            let [x, y, phi] = part.pose.map(|id| self.formula_text(id));
            let mount = self.model.frame_name(part.mount);
            let mirrored = if part.is_mirrored_in_parent { " mirrored" } else { "" };
            writeln!(f, "\n{} on {mount} at ({x}, {y}, {phi}){mirrored}", part.ground_name)?;
            self.write_features(f, frame)?;
        }
        Ok(())
    }

    /// Writes joints, constraints and drivers.
    fn write_equations(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "\njoints")?;
        for joint in &self.model.joints {
            writeln!(f, "  {}: {}", joint.declared.name, self.joint_text(joint))?;
        }
        writeln!(f, "\nconstraints and drivers")?;
        for equation in &self.model.equations {
            let kind = if equation.driver { "driver" } else { "constraint" };
            let side = |id: ExprId| self.formula_text(id);
            let (left, right) = match equation.form {
                EquationForm::Equality(left, right) => (side(left), side(right)),
                EquationForm::Distance(p, q, distance) => {
                    (self.quantity_text(Quantity::Distance(p, q), &side), side(distance))
                }
            };
            writeln!(f, "  {kind} {}: {left} = {right}", equation.declared.name)?;
        }
        Ok(())
    }

    /// Writes gravity and loads.
    fn write_loads(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some(gravity) = self.model.gravity {
            let [x, y] = gravity.map(|id| self.formula_text(id));
            writeln!(f, "\ngravity ({x}, {y})")?;
        }
        if !self.model.loads.is_empty() {
            writeln!(f, "\nloads")?;
        }
        for load in &self.model.loads {
            let side = |id: ExprId| self.formula_text(id);
            let (force, on) = (side(load.force), self.quantity_text(load.on, &side));
            writeln!(f, "  {}: {force} on {on}", load.declared.name)?;
        }
        Ok(())
    }

    /// Writes measures, results and the analysis.
    fn write_outputs(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if !self.model.measures.is_empty() {
            writeln!(f, "\nmeasures")?;
        }
        for measure in &self.model.measures {
            let [unit, ..] = &measure.units.printed;
            let unit = if *unit == measure.units.si { String::new() } else { format!(" in {unit}") };
            writeln!(f, "  {} = {}{unit}", measure.declared.name, self.formula_text(measure.value))?;
        }
        if !self.model.outcomes.is_empty() {
            writeln!(f, "\nresults")?;
        }
        for outcome in &self.model.outcomes {
            let [unit, ..] = &outcome.units.printed;
            let unit = if *unit == outcome.units.si { String::new() } else { format!(" in {unit}") };
            writeln!(f, "  {} = {}{unit}", outcome.declared.name, self.formula_text(outcome.value))?;
        }
        if let Some(analysis) = self.model.analysis {
            let [from, to, every] = [analysis.from, analysis.to, analysis.every].map(number);
            writeln!(f, "\nanalysis from {from} s to {to} s every {every} s")?;
        }
        Ok(())
    }
}

impl Mechanism {
    /// Returns every formula of the mechanism.
    fn formulas(&self) -> Vec<ExprId> {
        let mut list: Vec<ExprId> = self.points.iter().flat_map(|point| point.at).collect();
        list.extend(self.axes.iter().flat_map(|axis| axis.direction));
        list.extend(self.bodies.iter().flat_map(|body| body.pose));
        list.extend(self.joints.iter().filter_map(Joint::value));
        list.extend(self.graph.tables().iter().flat_map(|table| table.knots.iter().chain(&table.values)));
        list.extend(self.circles.iter().map(|circle| circle.radius));
        list.extend(self.curves.iter().flat_map(|curve| curve.at.into_iter().chain(curve.estimate)));
        for equation in &self.equations {
            match equation.form {
                EquationForm::Equality(left, right) => list.extend([left, right]),
                EquationForm::Distance(_, _, distance) => list.push(distance),
            }
        }
        list.extend(self.masses.iter().flat_map(|mass| [mass.amount, mass.inertia]));
        list.extend(self.gravity.into_iter().flatten());
        list.extend(self.loads.iter().map(|load| load.force));
        list.extend(self.measures.iter().map(|measure| measure.value));
        list.extend(self.outcomes.iter().map(|outcome| outcome.value));
        list.extend(self.reductions.iter().map(|reduction| reduction.of));
        list.extend(self.named.iter().filter_map(|named| match named {
            Named::Derivative(inner) | Named::By(inner, _) => Some(*inner),
            Named::Quantity(..) | Named::Force(..) | Named::Exists(..) | Named::Reduction(_) | Named::Argument => None,
        }));
        list
    }
}

/// Writes every declaration with its names resolved and its values in SI units.
impl std::fmt::Display for Mechanism {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut printer = Printer::new(&self.graph, |_| String::new());
        let shared = printer.name_shared(&self.formulas(), |k| format!("part_{}", k + 1));
        let names = shared.iter().map(|(name, id)| (*id, name.clone())).collect();
        let text = Text { model: self, names };
        writeln!(f, "model of {}", self.declared.name)?;
        writeln!(f, "\nparameters, in SI")?;
        for param in &self.params {
            writeln!(f, "  {} = {} [{}]", param.declared.name, number(param.value), param.dimension.unit())?;
        }
        if !shared.is_empty() {
            writeln!(f, "\nparts that stand in several places")?;
            for (name, id) in &shared {
                writeln!(f, "  {name} = {}", text.print(*id, true))?;
            }
        }
        text.write_tables(f)?;
        if !self.inputs.is_empty() {
            writeln!(f, "\ninputs, in SI")?;
        }
        for input in &self.inputs {
            writeln!(f, "  {} = {}", input.declared.name, text.print(input.formula.value, false))?;
        }
        text.write_frames(f)?;
        text.write_equations(f)?;
        text.write_loads(f)?;
        text.write_outputs(f)
    }
}
