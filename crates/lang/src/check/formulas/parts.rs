//! Parts: each has formulas of its own, which share the model with those that enclose it.

use super::Formulas;
use super::references::Feature;
use super::variables::Variables;
use crate::check::scope::Space;
use crate::model::{EquationId, Frame, Named, NamedId, PartId, PointId};
use mechc_text::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// The state that a mechanism shares with its parts, besides the model and the diagnostics.
#[derive(Default)]
pub(in crate::check) struct SharedState {
    /// The features of each frame by their names.
    pub features: FxHashMap<Frame, Space<Feature>>,
    /// The points whose formulas hold a unit.
    pub dimensional_points: FxHashSet<PointId>,
    /// Frames whose drawn pose is broken.
    pub broken_poses: FxHashSet<Frame>,
    /// The graph's named symbols, and the order of time derivatives in each.
    pub named: FxHashMap<Named, NamedId>,
    pub derivative_orders: Vec<u8>,
    /// The values of the graph's nodes; NaN for those that are not constant.
    pub values: Vec<f64>,
    /// Equations of unknown dimension: a number without a unit scales both sides.
    pub plain_equations: FxHashSet<EquationId>,
    /// The bare numbers next to angles in degrees that have been reported.
    pub reported_radians: FxHashSet<Span>,
    /// The variables of derivatives.
    pub variables: Variables,
}

/// The position of a text in the whole mechanism.
pub(in crate::check) struct Address {
    /// The part in the model; `None` for the outermost mechanism.
    pub part: Option<PartId>,
    /// The frame of its ground.
    pub ground: Frame,
}

impl Default for Address {
    /// Returns the address of the outermost mechanism.
    fn default() -> Address {
        Address { part: None, ground: Frame::Ground }
    }
}

impl<'a> Formulas<'a> {
    /// Runs `work` in the formulas of a part, with the shared state.
    pub(in crate::check) fn in_part<T>(&mut self, part: usize, work: impl FnOnce(&mut Formulas<'a>) -> T) -> T {
        let mut parts = std::mem::take(&mut self.parts);
        self.share_with(&mut parts[part]);
        let result = work(&mut parts[part]);
        self.share_with(&mut parts[part]);
        self.parts = parts;
        result
    }

    /// Swaps the shared state with a part.
    fn share_with(&mut self, other: &mut Formulas<'a>) {
        std::mem::swap(&mut self.reporter.diagnostics, &mut other.reporter.diagnostics);
        std::mem::swap(&mut self.model, &mut other.model);
        std::mem::swap(&mut self.common, &mut other.common);
    }

    /// Collects the variables of derivatives in the formulas of all texts.
    pub(in crate::check) fn collect_variables(&mut self) {
        self.common.variables.add(self.scope.tree, &self.scope.path);
        self.in_parts(Formulas::collect_variables);
    }

    /// Runs `work` in every part.
    pub(in crate::check) fn in_parts(&mut self, work: impl Fn(&mut Formulas<'a>)) {
        for part in 0..self.parts.len() {
            self.in_part(part, &work);
        }
    }
}
