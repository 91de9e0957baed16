//! Names of parts in the mechanism that uses them: entities that its formulas name by paths are imported when they are available.

use super::Formulas;
use super::measures::MeasureState;
use super::params::ParamState;
use super::reductions::ResultState;
use super::value::Value;
use crate::check::scope::Entity;
use crate::model::Frame;

impl<'a> Formulas<'a> {
    /// Returns a frame's name as this text uses it.
    pub(in crate::check) fn frame_name(&self, frame: Frame) -> &str {
        let name = self.model.frame_name(frame);
        name.strip_prefix(self.scope.path.as_str()).unwrap_or(name)
    }

    /// Returns the entity of a path such as `leg[0].foot`, and declares its name here.
    pub(in crate::check) fn entity_inside(&mut self, path: &str) -> Option<Entity> {
        if let Some(entity) = self.scope.get(path) {
            return Some(entity);
        }
        let (part, rest) = path.split_once('.')?;
        let Some(Entity::Part(k)) = self.scope.get(part) else { return None };
        let child = self.parts.get_mut(k)?;
        let (inside, span) = match rest {
            "ground" => (Entity::Ground, child.scope.tree.span),
            _ => (child.entity_inside(rest)?, child.scope.span(rest)?),
        };
        let is_point = child.scope.is_point_name(rest);
        Some(self.scope.import(k, path, span, inside, is_point))
    }

    /// Imports the values of the params of parts that are named here.
    pub(super) fn import_params(&mut self) {
        for part in 0..self.parts.len() {
            self.import_params_of(part);
        }
    }

    pub(super) fn import_params_of(&mut self, part: usize) {
        let child = &self.parts[part];
        for import in &self.scope.imports[part] {
            let (Entity::Param(k), Entity::Param(m)) = (import.entity, import.inside) else { continue };
            set(&mut self.params, k, child.params.get(m).copied(), ParamState::default());
        }
    }

    /// Imports the bodies of parts, after those of this text.
    pub(in crate::check) fn import_frames(&mut self) {
        for (imports, child) in self.scope.imports.iter().zip(&self.parts) {
            for import in imports {
                let (Entity::Body(k), inside) = (import.entity, import.inside) else { continue };
                let frame = match inside {
                    Entity::Body(m) => child.bodies.get(m).copied(),
                    _ => Some(child.address.ground),
                };
                set(&mut self.bodies, k, frame, Frame::Ground);
            }
        }
    }

    /// Imports the joints of parts.
    pub(in crate::check) fn import_joints(&mut self) {
        for (imports, child) in self.scope.imports.iter().zip(&self.parts) {
            for import in imports {
                let (Entity::Joint(k), Entity::Joint(m)) = (import.entity, import.inside) else { continue };
                set(&mut self.joints, k, child.joints.get(m).copied(), None);
            }
        }
    }

    /// Imports the constraints and drivers of parts.
    pub(in crate::check) fn import_equations(&mut self) {
        for (imports, child) in self.scope.imports.iter().zip(&self.parts) {
            for import in imports {
                let (Entity::Equation(k), Entity::Equation(m)) = (import.entity, import.inside) else { continue };
                set(&mut self.equations, k, child.equations.get(m).copied(), None);
            }
        }
    }

    /// Returns the formulas that declares an entity, with the entity there.
    pub(super) fn home_of(&self, entity: Entity) -> (&Formulas<'a>, Entity) {
        match self.scope.origin(entity) {
            Some((part, inside)) => self.parts[part].home_of(inside),
            None => (self, entity),
        }
    }

    /// Returns the state of a measure of this text or of a part.
    pub(in crate::check) fn measure_state(&self, k: usize) -> Option<&MeasureState<'a>> {
        match self.home_of(Entity::Measure(k)) {
            (home, Entity::Measure(k)) => home.measures.get(k),
            _ => None,
        }
    }

    /// Returns the state of a result of this text or of a part.
    pub(in crate::check) fn result_state(&self, k: usize) -> Option<&ResultState<'a>> {
        match self.home_of(Entity::Result(k)) {
            (home, Entity::Result(k)) => home.results.get(k),
            _ => None,
        }
    }

    /// Returns the value of an input of this text or of a part.
    pub(super) fn value_of_input(&self, k: usize) -> Option<Value> {
        match self.home_of(Entity::Input(k)) {
            (home, Entity::Input(k)) => home.inputs.get(k)?.value,
            _ => None,
        }
    }
}

/// Sets an element of a list, extending the list if necessary.
fn set<T: Clone>(list: &mut Vec<T>, k: usize, value: Option<T>, otherwise: T) {
    if list.len() <= k {
        list.resize(k + 1, otherwise);
    }
    if let Some(value) = value {
        list[k] = value;
    }
}
