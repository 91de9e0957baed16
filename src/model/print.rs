//! The model as readable text: names resolved, values in SI.

use super::{AxisId, Direction, EquationForm, Frame, JointKind, Mechanism, Named, PointId, Quantity};
use crate::expr::{ExprId, Printer, Symbol, number};
use rustc_hash::FxHashMap;

/// A mechanism with names for the parts that its formulas share, so that none is written out many times.
struct Text<'m> {
    model: &'m Mechanism,
    names: FxHashMap<ExprId, String>,
}

impl Text<'_> {
    /// A point as the language names it; a literal one by its coordinates.
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
        }
    }

    /// A formula of the model as text.
    fn formula_text(&self, id: ExprId) -> String {
        self.print(id, false)
    }

    /// A formula as text; one that has a name itself is written out if the whole is wanted.
    fn print(&self, id: ExprId, whole: bool) -> String {
        let text = |inner: ExprId| self.formula_text(inner);
        let printer = Printer::new(&self.model.graph, |symbol| match symbol {
            Symbol::Param(k) => self.model.params[k as usize].declared.name.clone(),
            Symbol::Time => "t".to_owned(),
            Symbol::Named(k) => match self.model.named[k as usize] {
                Named::Quantity(quantity) => self.quantity_text(quantity, &text),
                Named::Derivative(inner) => format!("der({})", self.formula_text(inner)),
                Named::Argument => "u".to_owned(),
            },
            Symbol::Coordinate { .. } => "q".to_owned(),
        })
        .with_names(&self.names);
        if whole { printer.definition(id) } else { printer.text(id) }
    }

    fn joint_text(&self, kind: JointKind) -> String {
        let text = |id: ExprId| self.formula_text(id);
        let point = |id: PointId| self.point_text(id, &text);
        let arguments = match kind {
            JointKind::Revolute(p, q) => vec![point(p), point(q)],
            JointKind::Translational(a, b) => vec![self.axis_text(a), self.axis_text(b)],
            JointKind::Weld(p, q, value) | JointKind::RevoluteRevolute(p, q, value) => {
                vec![point(p), point(q), text(value)]
            }
            JointKind::RevoluteTranslational(p, a, offset) => vec![point(p), self.axis_text(a), text(offset)],
        };
        format!("{}({})", kind.word(), arguments.join(", "))
    }

    fn write_features(&self, f: &mut std::fmt::Formatter<'_>, frame: Frame) -> std::fmt::Result {
        for point in self.model.points.iter().filter(|point| point.frame == frame) {
            let name = point.name.as_deref().unwrap_or("(literal)");
            writeln!(f, "    point {name} = ({}, {})", self.formula_text(point.at[0]), self.formula_text(point.at[1]))?;
        }
        for axis in self.model.axes.iter().filter(|axis| axis.frame == frame) {
            let text = |id: ExprId| self.formula_text(id);
            let [dx, dy] = axis.direction.map(text);
            writeln!(f, "    axis {} = {} along ({dx}, {dy})", axis.name, self.point_text(axis.origin, &text))?;
        }
        Ok(())
    }
}

impl Mechanism {
    /// Every formula of the mechanism.
    fn formulas(&self) -> Vec<ExprId> {
        let mut list: Vec<ExprId> = self.points.iter().flat_map(|point| point.at).collect();
        list.extend(self.axes.iter().flat_map(|axis| axis.direction));
        list.extend(self.bodies.iter().flat_map(|body| body.pose));
        list.extend(self.joints.iter().filter_map(|joint| match joint.kind {
            JointKind::Weld(_, _, value)
            | JointKind::RevoluteRevolute(_, _, value)
            | JointKind::RevoluteTranslational(_, _, value) => Some(value),
            JointKind::Revolute(..) | JointKind::Translational(..) => None,
        }));
        for equation in &self.equations {
            match equation.form {
                EquationForm::Difference(left, right) => list.extend([left, right]),
                EquationForm::SquaredDistance(_, _, distance) => list.push(distance),
            }
        }
        list.extend(self.measures.iter().map(|measure| measure.value));
        list.extend(self.named.iter().filter_map(|named| match named {
            Named::Derivative(inner) => Some(*inner),
            Named::Quantity(_) | Named::Argument => None,
        }));
        list
    }
}

/// Every declaration with its names resolved and its values in SI.
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
        writeln!(f, "\nground")?;
        text.write_features(f, Frame::Ground)?;
        for (id, body) in self.body_ids().zip(&self.bodies) {
            let [x, y, phi] = body.pose.map(|part| text.formula_text(part));
            writeln!(f, "\nbody {} at ({x}, {y}, {phi})", body.declared.name)?;
            text.write_features(f, Frame::Body(id))?;
        }
        writeln!(f, "\njoints")?;
        for joint in &self.joints {
            writeln!(f, "  {}: {}", joint.declared.name, text.joint_text(joint.kind))?;
        }
        writeln!(f, "\nconstraints and drivers")?;
        for equation in &self.equations {
            let kind = if equation.driver { "driver" } else { "constraint" };
            let side = |id: ExprId| text.formula_text(id);
            let (left, right) = match equation.form {
                EquationForm::Difference(left, right) => (side(left), side(right)),
                EquationForm::SquaredDistance(p, q, distance) => {
                    (text.quantity_text(Quantity::Distance(p, q), &side), side(distance))
                }
            };
            writeln!(f, "  {kind} {}: {left} = {right}", equation.declared.name)?;
        }
        if !self.measures.is_empty() {
            writeln!(f, "\nmeasures")?;
        }
        for measure in &self.measures {
            writeln!(f, "  {} = {}", measure.declared.name, text.formula_text(measure.value))?;
        }
        if let Some(analysis) = self.analysis {
            let [from, to, every] = [analysis.from, analysis.to, analysis.every].map(number);
            writeln!(f, "\nanalysis from {from} s to {to} s every {every} s")?;
        }
        Ok(())
    }
}
