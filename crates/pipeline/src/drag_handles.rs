//! Drag handles: bodies whose angle a driver sets, which a user can turn in a picture.

use crate::Compiled;
use crate::controls::at_time;
use mechc_expr::{ExprId, Symbol};
use mechc_ir::{BodyId, ConstraintSystem, Declaration, Input};

/// An input that changes an angle less than this [rad per SI unit of the input] cannot turn it.
const LEAST_RATE: f64 = 1e-9;

/// A body whose angle alone a driver sets.
#[derive(Clone, PartialEq, Debug)]
pub struct DragHandle {
    /// Index among the bodies.
    pub body: usize,
    /// The point at which it is joined to the ground (m).
    pub pivot: [f64; 2],
    /// The input of its driver; `None` if time alone turns it.
    pub input: Option<TurningInput>,
}

/// An input that turns a body.
#[derive(Clone, PartialEq, Debug)]
pub struct TurningInput {
    /// Path of the input.
    pub name: String,
    /// Derivative of the angle by the input at the first time [rad per SI unit of the input]: finite, and not 0.
    pub rate: f64,
}

impl Compiled {
    /// Returns the bodies that can be turned by hand, at a time (s).
    #[must_use]
    pub fn drag_handles(&self, t: f64) -> Vec<DragHandle> {
        let system = self.system();
        // the equations of the text have formulas of time in place of inputs
        let signals = self.with_signals();
        let system = signals.as_ref().unwrap_or(system);
        let moment = Moment { by_time: self.system(), system, t };
        (0..system.rows().len()).filter(|&row| system.is_driver(row)).filter_map(|row| moment.crank(row)).collect()
    }
}

/// A mechanism whose inputs are signals, at a time (s).
struct Moment<'s> {
    /// The mechanism whose inputs are formulas of time.
    by_time: &'s ConstraintSystem,
    system: &'s ConstraintSystem,
    t: f64,
}

impl Moment<'_> {
    /// Returns the body that the driver of a row turns.
    fn crank(&self, row: usize) -> Option<DragHandle> {
        let system = self.system;
        let [(column, by_angle)] = system.phi_q().row(row) else { return None };
        let body = system.body_of(*column as usize)?;
        let [.., phi] = system.pose_of(body);
        let pivot = system.declarations().iter().find_map(|joint| pivot(system, joint, body))?;
        let by_input = system.by_inputs().zip(system.inputs());
        let mut turning = by_input
            .map(|(side, input)| (side[row], input))
            .filter(|(slope, input)| !input.is_time() && !system.graph().is_zero(*slope))
            .map(|(slope, input)| self.turning_input(slope, *by_angle, input))
            .peekable();
        let has_inputs = turning.peek().is_some();
        let input = turning.flatten().next();
        // a body that an input turns, but not at this time, is not turned by time either
        (phi == *column as usize && has_inputs == input.is_some()).then_some(DragHandle {
            body: body.index(),
            pivot,
            input,
        })
    }

    /// Returns the input if it changes the angle, by `−Φ_u` and `Φ_φ`.
    fn turning_input(&self, slope: ExprId, by_angle: ExprId, input: &Input) -> Option<TurningInput> {
        let rate = self.value(slope) / self.value(by_angle);
        (rate.is_finite() && rate.abs() > LEAST_RATE).then(|| TurningInput { name: input.name.clone(), rate })
    }

    /// Evaluates a formula at that time, with estimates as coordinates.
    fn value(&self, formula: ExprId) -> f64 {
        let Moment { by_time, system, t } = self;
        system.graph().value(formula, |symbol| match symbol {
            Symbol::Param(k) => system.params()[k as usize].value,
            Symbol::Coordinate { index, order: 0 } => {
                system.value_at(system.coordinates()[index as usize].estimate, &[])
            }
            Symbol::Shift(_) => 0.0,
            Symbol::Signal { order: 0, .. } => {
                let has_symbol = |input: &&Input| input.symbol() == symbol;
                let named = |name: &str| by_time.inputs().iter().find(|input| input.name == name);
                match system.inputs().iter().find(has_symbol) {
                    Some(input) if !input.is_time() => {
                        named(&input.name).map_or(f64::NAN, |input| at_time(by_time, input.formulas[0], *t))
                    }
                    _ => *t,
                }
            }
            Symbol::Time => *t,
            _ => f64::NAN,
        })
    }
}

/// Returns the point at which a joint connects a body to the ground.
fn pivot(system: &ConstraintSystem, joint: &Declaration, body: BodyId) -> Option<[f64; 2]> {
    let [one, other] = joint.points.as_slice() else { return None };
    let on_body = match [one, other].map(|point| system.points()[*point].body) {
        [None, Some(on)] if on == body => other,
        [Some(on), None] if on == body => one,
        _ => return None,
    };
    Some(system.points()[*on_body].at.map(|id| system.value_at(id, &[])))
}

#[cfg(test)]
mod tests {
    use super::TurningInput;
    use crate::{Choice, Parsed, Redundant};
    use mechc_text::cancel::Cancel;
    use mechc_text::world::Memory;

    /// Returns the inputs that turn a disc whose driver names `axle`, or `back`, whose points are in reverse order.
    fn inputs_of(driver: &str) -> Vec<Option<TurningInput>> {
        let text = format!(
            "mechanism disc {{
    input turn = 60 deg + 1 rev/s * t
    input lift = 5 mm
    ground {{ point O = (0, 0) }}
    body wheel at (0, 0, 60 deg) {{ point O = (0, 0) point P = (20 mm, 0) }}
    joint axle: revolute({})
    driver motor: {driver}
    analysis from 0 s to 1 s every 10 ms
}}",
            if driver.contains("back") { "wheel.O, ground.O" } else { "ground.O, wheel.O" }
        )
        .replace("joint axle", if driver.contains("back") { "joint back" } else { "joint axle" });
        let checked = Parsed::new("disc.mech", &text).check(&Choice::default(), &Memory::default());
        let (compiled, diagnostics) = checked.compile(Redundant::Refused, &Cancel::default());
        let compiled = compiled.unwrap_or_else(|| panic!("{driver}: {diagnostics:?}"));
        compiled.drag_handles(0.0).into_iter().map(|crank| crank.input).collect()
    }

    #[test]
    fn rates_of_angles_follow_from_the_equations() {
        for (driver, name, rate) in [
            ("rotation(axle) = turn", "turn", 1.0),
            ("rotation(axle) = 2 * turn", "turn", 2.0),
            ("rotation(axle) = -turn", "turn", -1.0),
            ("rotation(axle) = sin(turn)", "turn", 0.5),
            ("rotation(back) = turn", "turn", -1.0),
            ("2 * rotation(axle) = turn + 10 deg/s * t", "turn", 0.5),
            ("rotation(axle) = lift / 2 mm", "lift", 500.0),
        ] {
            let inputs = inputs_of(driver);
            let [Some(input)] = inputs.as_slice() else { panic!("{driver}: {inputs:?}") };
            assert_eq!(input.name, name, "{driver}");
            assert!((input.rate - rate).abs() < 1e-9 * rate.abs(), "{driver}: {}", input.rate);
        }
        assert_eq!(inputs_of("rotation(axle) = 1 rev/s * t"), [None]);
        // the input does not turn the disc at the first time
        assert_eq!(inputs_of("rotation(axle) = 1 rev/s * t * (turn - 60 deg)"), []);
        assert_eq!(inputs_of("rotation(axle) = (turn - 60 deg)^2"), []);
    }
}
