//! The names of a mechanism: its declarations, names imported from parts, and what a name in a formula may stand for.
//!
//! This layer owns `Scope`. It reports duplicates and reserved names, and knows neither values nor the model.

mod bare_names;
mod entity;
mod free_names;
mod names;
pub(in crate::check) mod point_kinds;

pub(in crate::check) use bare_names::{BareName, resolve_bare_name};
pub(in crate::check) use entity::Entity;
pub use free_names::name_of;
pub(in crate::check) use free_names::{indices, visit_free_names};
pub(in crate::check) use names::{BrokenName, DefinitionOrder, Space, is_constant, ordered};
pub(in crate::check) use point_kinds::{Expected, coordinate};

use super::errors::{self, Reporter};
use crate::model::Declared;
use mechc_syntax::ast::{Expr, ExprKind, Item, ItemKind, Mechanism, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Constant, QuantityWord, ReductionWord, Unit, gives_way, is_called};
use names::Count;
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// The names of one mechanism or part.
pub(in crate::check) struct Scope<'a> {
    pub tree: &'a Mechanism,
    /// The prefix of its names, such as `leg[2].`, or an empty string.
    pub path: String,
    space: Space<Entity>,
    /// The number of named declarations of each kind.
    pub count: Count,
    /// The entities of each part that are used here.
    pub imports: Vec<Vec<Import>>,
    imported: FxHashMap<Entity, (usize, Entity)>,
    /// The paths of params of parts that are points.
    point_paths: FxHashSet<String>,
    /// The params that are points.
    point_params: FxHashSet<&'a str>,
    /// The functions and tables that hide functions of the language.
    hidden: FxHashSet<&'a str>,
    /// The params that determine repetitions.
    pub deciding: Rc<FxHashSet<String>>,
}

/// An entity of a part that the enclosing mechanism names by a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Import {
    /// The entity in the enclosing mechanism.
    pub entity: Entity,
    /// The entity in the part.
    pub inside: Entity,
}

impl<'a> Scope<'a> {
    /// Returns the scope of a mechanism whose declarations have not been collected.
    pub fn new(tree: &'a Mechanism) -> Scope<'a> {
        Scope {
            tree,
            path: String::new(),
            space: Space::new(),
            count: Count::default(),
            imports: Vec::new(),
            imported: FxHashMap::default(),
            point_paths: FxHashSet::default(),
            point_params: point_kinds::point_params(tree),
            hidden: point_kinds::hiding_functions(tree),
            deciding: Rc::default(),
        }
    }

    /// Returns the entity of a name, if it is declared.
    pub fn get(&self, name: &str) -> Option<Entity> {
        self.space.get(name)
    }

    /// Returns the location of the declaration of a name.
    pub fn span(&self, name: &str) -> Option<Span> {
        self.space.span(name)
    }

    /// Returns the names of the entities that `expected` accepts, in order of declaration.
    pub fn names(&self, expected: impl Fn(Entity) -> bool) -> impl Iterator<Item = &str> {
        self.space.names(expected)
    }

    /// Returns the names to suggest from; none after many errors.
    pub fn suggestions(&self, reporter: &Reporter<'_>, expected: impl Fn(Entity) -> bool) -> Vec<&str> {
        self.space.suggestions(reporter, expected)
    }

    /// Returns whether a function or table of the mechanism hides a function of the language.
    pub fn hides(&self, name: &str) -> bool {
        self.hidden.contains(name)
    }

    /// Declares the path of an entity inside a part, and returns its entity here.
    pub fn import(&mut self, part: usize, path: &str, span: Span, inside: Entity, is_point: bool) -> Entity {
        let next = |count: &mut usize| {
            *count += 1;
            *count - 1
        };
        let count = &mut self.count;
        let entity = match inside {
            Entity::Param(_) => Entity::Param(next(&mut count.params)),
            Entity::Input(_) => Entity::Input(next(&mut count.inputs)),
            Entity::Body(_) | Entity::Ground => Entity::Body(next(&mut count.bodies)),
            Entity::Joint(_) => Entity::Joint(next(&mut count.joints)),
            Entity::Equation(_) => Entity::Equation(next(&mut count.equations)),
            Entity::Measure(_) => Entity::Measure(next(&mut count.measures)),
            Entity::Result(_) => Entity::Result(next(&mut count.results)),
            other => other,
        };
        if is_point {
            self.point_paths.insert(path.to_owned());
        }
        let _ = self.space.declare(&Name { text: path.to_owned(), span }, entity);
        self.imports[part].push(Import { entity, inside });
        self.imported.insert(entity, (part, inside));
        entity
    }

    /// Returns the part that declares an imported entity, with the entity there.
    pub fn origin(&self, entity: Entity) -> Option<(usize, Entity)> {
        self.imported.get(&entity).copied()
    }

    pub fn items(&self) -> &'a [Item] {
        &self.tree.items
    }

    /// Returns a name with the prefix of its part.
    pub fn declared(&self, name: &Name) -> Declared {
        Declared { name: format!("{}{}", self.path, name.text), span: name.span }
    }

    /// Returns the entity of a name; `None` if it is not declared. `Err` if its declaration is broken, which has been reported.
    ///
    /// Every name of a formula or reference that can be reported is resolved here.
    pub fn resolve(&self, name: &Name) -> Result<Option<Entity>, BrokenName> {
        match self.get(&name.text) {
            Some(Entity::Broken) => Err(BrokenName),
            None if self.space.is_incomplete() => Err(BrokenName),
            entity => Ok(entity),
        }
    }

    /// Returns the entity of a name, where undeclared names are not reported.
    pub fn entity(&self, name: &Name) -> Option<Entity> {
        self.resolve(name).ok().flatten()
    }

    /// Returns whether a name of the language is declared, which has been reported. It may mean either.
    pub fn is_reserved_but_declared(&self, name: &Name) -> bool {
        let is_callable = |entity| matches!(entity, Entity::Function(_) | Entity::Table(_));
        let is_function = is_called(&name.text) && !gives_way(&name.text);
        self.get(&name.text).is_some_and(|entity| is_constant(name) || is_function && is_callable(entity))
    }

    /// Returns whether a call is one of the language's own functions or quantities.
    pub fn is_of_language(&self, name: &str) -> bool {
        is_called(name) && !self.hides(name)
    }

    /// Returns a quantity of the language, unless a function or table of the mechanism hides it.
    pub fn quantity_word(&self, name: &Name) -> Option<&'static QuantityWord> {
        let is_hidden = || matches!(self.entity(name), Some(Entity::Function(_) | Entity::Table(_)));
        QuantityWord::named(&name.text).filter(|quantity| !quantity.gives_way() || !is_hidden())
    }

    /// Returns the reduction of a call. A function or table of the mechanism takes precedence.
    pub fn reduction_word(&self, name: &Name, arguments: usize) -> Option<&'static ReductionWord> {
        let is_hidden = || matches!(self.entity(name), Some(Entity::Function(_) | Entity::Table(_)));
        let compares = ["max", "min"].contains(&name.text.as_str());
        let word = ReductionWord::named(&name.text).filter(|_| !compares || arguments == 1)?;
        (compares || !is_hidden()).then_some(word)
    }

    /// Returns whether a name is that of a param that is a point.
    pub fn is_point_name(&self, name: &str) -> bool {
        self.point_params.contains(name) || self.point_paths.contains(name)
    }

    /// Returns the param of a name, if it is a point.
    pub fn point_param(&self, name: &Name) -> Option<usize> {
        match self.entity(name) {
            Some(Entity::Param(k)) if self.is_point_name(&name.text) => Some(k),
            _ => None,
        }
    }

    /// Returns whether a name, of the mechanism or of the language, is a number in every formula.
    pub fn is_number_name(&self, name: &Name) -> bool {
        let declared = self.get(&name.text);
        match declared {
            Some(Entity::Param(_)) => !self.is_point_name(&name.text),
            Some(_) => false,
            None => Constant::named(&name.text).is_some() || Unit::named(&name.text).is_some(),
        }
    }

    pub fn is_body(&self, name: &Name) -> bool {
        name.text == "ground" || matches!(self.entity(name), Some(Entity::Body(_)))
    }

    /// Returns the unit of a name without a number before it.
    pub fn unit_alone(&self, name: &Name) -> Option<&'static Unit> {
        Unit::named(&name.text).filter(|_| self.get(&name.text).is_none())
    }

    /// Describes a name that stands in the place of a feature.
    pub fn describe_name(&self, name: &Name) -> &'static str {
        self.entity(name).map_or("a name", Entity::noun)
    }

    /// Returns whether a formula of the tree holds a kinematic quantity.
    pub fn holds_quantity(&self, formula: &Expr) -> bool {
        let is_quantity =
            |e: &Expr| matches!(&e.kind, ExprKind::Call { name, .. } if self.quantity_word(name).is_some());
        formula.parts().any(is_quantity)
    }

    /// Returns the driver that refers to a joint.
    pub fn driver_of(&self, joint: &str) -> Option<String> {
        let is_it = |e: &Expr| matches!(&e.kind, ExprKind::Name(name) if name.text == joint);
        let speaks_of_it = |e: &Expr| e.parts().any(is_it);
        self.items().iter().find_map(|item| match &item.kind {
            ItemKind::Equation { driver: true, name, left, right } if [left, right].into_iter().any(speaks_of_it) => {
                Some(name.text.clone())
            }
            _ => None,
        })
    }

    /// Returns the paths of the params and inputs that a formula uses.
    pub fn free_names_in(&self, formula: &Expr) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        visit_free_names(
            formula,
            |name| self.hides(name),
            |name, _| {
                let path = format!("{}{}", self.path, name.text);
                if matches!(self.entity(name), Some(Entity::Param(_) | Entity::Input(_))) && !found.contains(&path) {
                    found.push(path);
                }
            },
        );
        found
    }

    /// Returns the names of points to suggest from.
    pub fn point_param_names(&self, reporter: &Reporter<'_>) -> Vec<&str> {
        let mut candidates = self.suggestions(reporter, |entity| matches!(entity, Entity::Param(_)));
        candidates.retain(|name| self.is_point_name(name));
        candidates
    }

    /// Reports a trace where a number or point is expected.
    pub fn trace_in_a_formula(&self, reporter: &mut Reporter<'_>, span: Span, expected: &str, name: &Name) {
        let point = self.items().iter().find_map(|item| match &item.kind {
            ItemKind::Trace { name: trace, point, .. } if trace.text == name.text => Some(reporter.text(point.span)),
            _ => None,
        });
        let diagnostic = errors::trace_in_a_formula(span, expected, name, point);
        reporter.report(diagnostic);
    }
}
