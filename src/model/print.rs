//! The model as readable text: names resolved, values in SI.

use super::{AxisId, Direction, EquationForm, Frame, JointKind, Mechanism, Named, PointId, Quantity};
use crate::expr::{ExprId, Printer, Symbol, number};

impl Mechanism {
    /// A point as the language names it; a literal one by its coordinates.
    fn point_text(&self, id: PointId, text: &dyn Fn(ExprId) -> String) -> String {
        let point = &self[id];
        match &point.name {
            Some(name) => format!("{}.{name}", self.frame_name(point.frame)),
            None => format!("({}, {})", text(point.at[0]), text(point.at[1])),
        }
    }

    fn axis_text(&self, id: AxisId) -> String {
        format!("{}.{}", self.frame_name(self[id].frame), self[id].name)
    }

    fn direction_text(&self, direction: Direction) -> String {
        match direction {
            Direction::Frame(frame) => self.frame_name(frame).to_owned(),
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
            Quantity::Rotation(joint, None) => format!("rotation({})", self[joint].declared.name),
            Quantity::Rotation(joint, Some((u, v))) => {
                format!("rotation({}, {}, {})", self[joint].declared.name, self.axis_text(u), self.axis_text(v))
            }
            Quantity::Displacement(joint, ..) => format!("displacement({})", self[joint].declared.name),
        }
    }

    /// A formula of the model as text.
    fn formula_text(&self, id: ExprId) -> String {
        let text = |inner: ExprId| self.formula_text(inner);
        let printer = Printer::new(&self.graph, |symbol| match symbol {
            Symbol::Param(k) => self.params[k as usize].declared.name.clone(),
            Symbol::Time => "t".to_owned(),
            Symbol::Named(k) => match self.named[k as usize] {
                Named::Quantity(quantity) => self.quantity_text(quantity, &text),
                Named::Derivative(inner) => format!("der({})", self.formula_text(inner)),
                Named::Argument => "u".to_owned(),
            },
            Symbol::Coordinate { .. } => "q".to_owned(),
        });
        printer.text(id)
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
        for point in self.points.iter().filter(|point| point.frame == frame) {
            let name = point.name.as_deref().unwrap_or("(literal)");
            writeln!(f, "    point {name} = ({}, {})", self.formula_text(point.at[0]), self.formula_text(point.at[1]))?;
        }
        for axis in self.axes.iter().filter(|axis| axis.frame == frame) {
            let text = |id: ExprId| self.formula_text(id);
            let [dx, dy] = axis.direction.map(text);
            writeln!(f, "    axis {} = {} along ({dx}, {dy})", axis.name, self.point_text(axis.origin, &text))?;
        }
        Ok(())
    }
}

/// Every declaration with its names resolved and its values in SI.
impl std::fmt::Display for Mechanism {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "model of {}", self.declared.name)?;
        writeln!(f, "\nparameters, in SI")?;
        for param in &self.params {
            writeln!(f, "  {} = {} [{}]", param.declared.name, number(param.value), param.dimension.unit())?;
        }
        writeln!(f, "\nground")?;
        self.write_features(f, Frame::Ground)?;
        for (id, body) in self.body_ids().zip(&self.bodies) {
            let [x, y, phi] = body.pose.map(|part| self.formula_text(part));
            writeln!(f, "\nbody {} at ({x}, {y}, {phi})", body.declared.name)?;
            self.write_features(f, Frame::Body(id))?;
        }
        writeln!(f, "\njoints")?;
        for joint in &self.joints {
            writeln!(f, "  {}: {}", joint.declared.name, self.joint_text(joint.kind))?;
        }
        writeln!(f, "\nconstraints and drivers")?;
        for equation in &self.equations {
            let kind = if equation.driver { "driver" } else { "constraint" };
            let text = |id: ExprId| self.formula_text(id);
            let (left, right) = match equation.form {
                EquationForm::Difference(left, right) => (text(left), text(right)),
                EquationForm::SquaredDistance(p, q, distance) => {
                    (self.quantity_text(Quantity::Distance(p, q), &text), text(distance))
                }
            };
            writeln!(f, "  {kind} {}: {left} = {right}", equation.declared.name)?;
        }
        writeln!(f, "\nmeasures")?;
        for measure in &self.measures {
            writeln!(f, "  {} = {}", measure.declared.name, self.formula_text(measure.value))?;
        }
        if let Some(analysis) = self.analysis {
            let [from, to, every] = [analysis.from, analysis.to, analysis.every].map(number);
            writeln!(f, "\nanalysis from {from} s to {to} s every {every} s")?;
        }
        Ok(())
    }
}
