//! The features that equations use. Other features are drawn or measured, and do not count for sizes.

use crate::model::{AxisId, EquationForm, Mechanism, Named, PointId, Quantity};
use mechc_expr::{ExprId, Symbol};

/// Flags of the features that joints or equations use.
pub(super) struct UsedFeatures {
    /// By point.
    pub points: Vec<bool>,
    /// By circle.
    pub circles: Vec<bool>,
    /// By curve.
    pub curves: Vec<bool>,
}

impl UsedFeatures {
    pub fn new(model: &Mechanism) -> UsedFeatures {
        let mut uses = UsedFeatures {
            points: vec![false; model.points.len()],
            circles: vec![false; model.circles.len()],
            curves: vec![false; model.curves.len()],
        };
        for joint in &model.joints {
            joint.points(model).into_iter().for_each(|point| uses.points[point.index()] = true);
            joint.circles().for_each(|circle| uses.circles[circle.index()] = true);
            joint.curves().for_each(|curve| uses.curves[curve.index()] = true);
        }
        for k in 0..model.equations.len() {
            for point in equation_points(model, k) {
                uses.points[point.index()] = true;
            }
        }
        uses
    }
}

/// Returns the points that an equation uses, by its number.
pub(super) fn equation_points(model: &Mechanism, equation: usize) -> Vec<PointId> {
    let mut points = Vec::new();
    match model.equations[equation].form {
        EquationForm::Equality(left, right) => collect_formula_points(model, &[left, right], &mut points),
        EquationForm::Distance(p, q, distance) => {
            points.extend([p, q]);
            collect_formula_points(model, &[distance], &mut points);
        }
    }
    points
}

fn collect_formula_points(model: &Mechanism, formulas: &[ExprId], points: &mut Vec<PointId>) {
    let mut open = formulas.to_vec();
    while let Some(formula) = open.pop() {
        for symbol in model.graph.symbols_of_all(&[formula]) {
            let Symbol::Named(k) = symbol else { continue };
            match model.named[k as usize] {
                Named::Quantity(_, quantity) => collect_quantity_points(model, quantity, points),
                // A symbol refers to earlier symbols only, so that this ends.
                Named::Derivative(inner) | Named::By(inner, _) => open.push(inner),
                Named::Argument | Named::Reduction(_) | Named::Exists(..) | Named::Force(..) => {}
            }
        }
    }
}

fn collect_quantity_points(model: &Mechanism, quantity: Quantity, points: &mut Vec<PointId>) {
    let origin = |axis: AxisId| model[axis].origin;
    match quantity {
        Quantity::X(from, to) | Quantity::Y(from, to) => points.extend(from.into_iter().chain([to])),
        Quantity::Distance(p, q) => points.extend([p, q]),
        Quantity::Displacement(_, a, b) => points.extend([origin(a), origin(b)]),
        // Equations do not hold points through other quantities.
        _ => {}
    }
}
