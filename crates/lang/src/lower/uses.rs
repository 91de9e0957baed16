//! The features that equations use: what else a body has is drawn, measured or forgotten, and weighs nothing.

use crate::model::{AxisId, EquationForm, Mechanism, Named, PointId, Quantity};
use mechc_expr::{ExprId, Symbol};

/// What joints and equations take hold of.
pub(super) struct Uses {
    /// By point.
    pub points: Vec<bool>,
    /// By circle.
    pub circles: Vec<bool>,
    /// By curve.
    pub curves: Vec<bool>,
}

impl Uses {
    pub fn of(model: &Mechanism) -> Uses {
        let mut uses = Uses {
            points: vec![false; model.points.len()],
            circles: vec![false; model.circles.len()],
            curves: vec![false; model.curves.len()],
        };
        for joint in &model.joints {
            joint.kind.points(model).into_iter().for_each(|point| uses.points[point.index()] = true);
            joint.kind.circles().into_iter().for_each(|circle| uses.circles[circle.index()] = true);
            joint.kind.curves().into_iter().for_each(|curve| uses.curves[curve.index()] = true);
        }
        for k in 0..model.equations.len() {
            for point in of_equation(model, k) {
                uses.points[point.index()] = true;
            }
        }
        uses
    }
}

/// The points that an equation speaks of, by its number.
pub(super) fn of_equation(model: &Mechanism, equation: usize) -> Vec<PointId> {
    let mut points = Vec::new();
    match model.equations[equation].form {
        EquationForm::Equality(left, right) => of_formulas(model, &[left, right], &mut points),
        EquationForm::Distance(p, q, distance) => {
            points.extend([p, q]);
            of_formulas(model, &[distance], &mut points);
        }
    }
    points
}

fn of_formulas(model: &Mechanism, formulas: &[ExprId], points: &mut Vec<PointId>) {
    let mut open = formulas.to_vec();
    while let Some(formula) = open.pop() {
        for symbol in model.graph.symbols_of_all(&[formula]) {
            let Symbol::Named(k) = symbol else { continue };
            match model.named[k as usize] {
                Named::Quantity(_, quantity) => of_quantity(model, quantity, points),
                // it speaks only of symbols before it
                Named::Derivative(inner) | Named::By(inner, ..) | Named::Held(_, inner) => open.push(inner),
                Named::Argument | Named::Reduction(_) | Named::Exists(..) | Named::Force(..) => {}
            }
        }
    }
}

fn of_quantity(model: &Mechanism, quantity: Quantity, points: &mut Vec<PointId>) {
    let origin = |axis: AxisId| model[axis].origin;
    match quantity {
        Quantity::X(from, to) | Quantity::Y(from, to) => points.extend(from.into_iter().chain([to])),
        Quantity::Distance(p, q) => points.extend([p, q]),
        Quantity::Displacement(_, a, b) => points.extend([origin(a), origin(b)]),
        // the others stand in no equation
        _ => {}
    }
}
