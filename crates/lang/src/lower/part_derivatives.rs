//! Parts whose texts differentiate by inputs or parameters, with their equations and coordinates.

use super::Lowering;
use crate::model::PartId;
use mechc_ir::{DeclarationId, PartWithDerivatives};

impl Lowering<'_> {
    /// Returns the parts whose texts differentiate by inputs or parameters.
    pub(super) fn parts_with_derivatives(&mut self) -> Vec<PartWithDerivatives> {
        let mut parts: Vec<PartId> = self.model.part_derivatives.iter().map(|derivative| derivative.part).collect();
        parts.sort_unstable();
        parts.dedup();
        parts.into_iter().map(|part| self.part_with_derivatives(part)).collect()
    }

    fn part_with_derivatives(&mut self, part: PartId) -> PartWithDerivatives {
        let model = self.model;
        let derivatives = || model.part_derivatives.iter().filter(|derivative| derivative.part == part);
        let mut places: Vec<_> = derivatives().map(|derivative| derivative.span).collect();
        places.dedup();
        let used_at = model.parts_around(Some(part));
        PartWithDerivatives {
            name: model[part].declared.name.clone(),
            used_at: used_at.map(|part| (model[part].declared.name.clone(), model[part].declared.span)).collect(),
            places,
            from_outside: derivatives().next().and_then(|derivative| derivative.from_outside.clone()),
            columns: self.numbering.of_part(model, |to| self.belongs(to, part)),
            inputs: model[part].inputs.iter().map(|(_, id)| self.formula(*id)).collect(),
            declarations: self.declarations_of(part),
        }
    }

    /// Returns whether `part` is or encloses the part `to` in which something is declared.
    fn belongs(&self, to: Option<PartId>, part: PartId) -> bool {
        self.model.parts_around(to).any(|around| around == part)
    }

    /// Returns the joints, constraints and drivers of a part and of the parts in it.
    fn declarations_of(&self, part: PartId) -> Vec<DeclarationId> {
        let path = format!("{}.", self.model[part].declared.name);
        let is_of_part = |k: &DeclarationId| match self.model.joints.get(k.index()) {
            Some(joint) => self.belongs(joint.part, part),
            None => self.declarations[*k].name.starts_with(&path),
        };
        self.declarations.ids().filter(is_of_part).collect()
    }
}
