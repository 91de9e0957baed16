//! Queries of editors about one declaration of a mechanism that was checked or compiled.

use crate::{Assembly, Checked, Compiled};
use mechc_expr::Symbol;
use mechc_lang::check::{self, DeclarationInfo, NameKind};
use mechc_lang::model::Dimension;
use mechc_syntax::ast::{self, Feature, FeatureKind, Item, ItemKind, Mechanism, MechanismName};
use mechc_text::source::Span;

/// A declaration that a path of names leads to, through parts and bodies.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Declaration {
    /// Kind of the declaration.
    pub kind: NameKind,
    /// Span of the whole declaration, in the text that holds it.
    pub span: Span,
    /// Text of its `///` lines.
    pub docs: Vec<String>,
}

/// The interface of a mechanism that is used as a part.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Interface {
    /// Name of the mechanism.
    pub name: String,
    /// Text of its `///` lines.
    pub docs: Vec<String>,
    /// Its params and inputs, each with its formula as it is written.
    pub bindings: Vec<(String, String)>,
}

impl Checked {
    /// Returns facts about its declarations and the values of its params, as far as the text gives them, even if it has errors.
    #[must_use]
    pub fn declaration_info(&self) -> &DeclarationInfo {
        self.query_cache.facts.get_or_init(|| {
            self.tree().map(|tree| check::known(tree, &self.check_options, self.sources())).unwrap_or_default()
        })
    }

    /// Returns the declaration of a path without indices of copies: `crank`, `crank.pin`, `front.crank.pin`.
    #[must_use]
    pub fn find_declaration(&self, path: &[&str]) -> Option<Declaration> {
        let mut tree = self.tree()?;
        let mut names = path.iter();
        loop {
            let item = item_named(tree, names.next()?)?;
            match (&item.kind, names.as_slice()) {
                (_, []) | (ItemKind::Param { .. } | ItemKind::Trace { .. }, ["x" | "y"]) => {
                    return Some(declaration(item));
                }
                (ItemKind::Part(part), _) => tree = self.mechanism(&part.mechanism)?,
                (ItemKind::Body { features, .. } | ItemKind::Ground { features }, [feature]) => {
                    return features.iter().find(|declared| declared.name.text == **feature).map(feature_declaration);
                }
                _ => return None,
            }
        }
    }

    /// Returns the interface of a mechanism that its text may use as a part, by its name and prefix.
    #[must_use]
    pub fn interface(&self, prefix: Option<&str>, name: &str) -> Option<Interface> {
        let here = self.tree()?.name.span;
        let named = |text: &str| ast::Name { text: text.to_owned(), span: here };
        let tree = self.mechanism(&MechanismName { prefix: prefix.map(named), name: named(name) })?;
        let bindings = tree.items.iter().filter_map(|item| match &item.kind {
            ItemKind::Param { name, value } | ItemKind::Input { name, value } => {
                Some((name.text.clone(), self.sources().text(value.span).to_owned()))
            }
            _ => None,
        });
        Some(Interface { name: tree.name.text.clone(), docs: tree.docs.clone(), bindings: bindings.collect() })
    }

    /// Returns the equations of a joint, constraint or driver with their right sides, even if the mechanism is not determined; `None` if it has
    /// errors.
    #[must_use]
    pub fn equations_of(&self, name: &str) -> Option<String> {
        let lowered = self.query_cache.lowered.get_or_init(|| self.lowered());
        lowered.as_ref()?.equations_of(name)
    }

    /// Returns the first two derivatives of a `fn` by its argument, as formulas; `None` if it cannot be read.
    #[must_use]
    pub fn slopes_of(&self, function: &str) -> Option<[String; 2]> {
        check::slopes(self.tree()?, function, &self.check_options, self.sources())
    }

    /// Returns the value (SI) and dimension of a param of a part, `front.reach`; without an index, of the first copy. `None` if the mechanism has
    /// errors, or the param follows from others.
    #[must_use]
    pub fn param_in_part(&self, path: &str) -> Option<(f64, Dimension)> {
        let params = || self.model().into_iter().flat_map(|model| &model.params);
        let find = |is_match: &dyn Fn(&str) -> bool| params().find(|param| is_match(&param.declared.name));
        let param = find(&|name| name == path).or_else(|| find(&|name| is_copy_of(name, path)))?;
        Some((param.value, param.dimension))
    }

    pub(crate) fn mechanism(&self, name: &MechanismName) -> Option<&Mechanism> {
        let mechanism = self.library.find(name.prefix.as_ref(), &name.name, self.sources()).ok()?;
        Some(self.library.tree(mechanism))
    }
}

impl Compiled {
    /// Returns the equations of a joint, constraint or driver with their right sides.
    #[must_use]
    pub fn equations_of(&self, name: &str) -> Option<String> {
        self.system().equations_of(name)
    }

    /// Returns the full name of a body, joint, constraint, driver, measure or result; a name without an index is that of the first copy.
    #[must_use]
    pub fn first_copy(&self, name: &str) -> Option<String> {
        let system = self.system();
        let names = || {
            let bodies = system.bodies().iter().map(|body| &body.name);
            let declarations = system.declarations().iter().map(|declaration| &declaration.name);
            let measures = system.measures().iter().map(|measure| &measure.name);
            bodies
                .chain(declarations)
                .chain(measures)
                .chain(system.results().outcomes.iter().map(|outcome| &outcome.name))
        };
        names().find(|other| *other == name).or_else(|| names().find(|other| is_copy_of(other, name))).cloned()
    }

    /// Returns the named points that a joint, constraint or driver connects.
    #[must_use]
    pub fn points_of(&self, name: &str) -> Vec<String> {
        let system = self.system();
        let declaration = system.declarations().iter().find(|declaration| declaration.name == name);
        let points = declaration.map(|declaration| declaration.points.as_slice()).unwrap_or_default();
        points.iter().filter_map(|&point| system.point_name(point)).collect()
    }

    /// Returns the value of an input at a time (s), and its SI unit.
    #[must_use]
    pub fn input_at(&self, name: &str, t: f64) -> Option<(f64, String)> {
        let system = self.system();
        let input = system.inputs().iter().find(|input| input.name == name)?;
        let value = system.graph().value(input.formulas[0], |symbol| match symbol {
            Symbol::Time => t,
            Symbol::Param(k) => system.params()[k as usize].value,
            _ => f64::NAN,
        });
        Some((value, input.dimension.display_unit()))
    }

    /// Returns the position of a point, as `crank.pin` or `ground.O`, in the ground's frame (m).
    #[must_use]
    pub fn place_of(&self, point: &str, assembly: &Assembly) -> Option<[f64; 2]> {
        let system = self.system();
        let k = system.points().ids().find(|&k| system.point_name(k).as_deref() == Some(point))?;
        let q: Vec<f64> = assembly.coordinates.iter().map(|(_, value, _)| *value).collect();
        let [x, y] = system.points()[k].at.map(|formula| system.value_at(formula, &q));
        let Some(body) = system.points()[k].body else { return Some([x, y]) };
        let [origin_x, origin_y, phi] = system.pose_of(body).map(|k| q.get(k).copied());
        let (origin_x, origin_y, phi) = (origin_x?, origin_y?, phi?);
        let (sin, cos) = (mechc_expr::math::sin(phi), mechc_expr::math::cos(phi));
        Some([origin_x + x * cos - y * sin, origin_y + x * sin + y * cos])
    }
}

/// Returns whether `copy` is `name` with indices of copies.
fn is_copy_of(copy: &str, name: &str) -> bool {
    let mut parts = copy.split('[');
    let mut rest = name;
    let Some(behind) = parts.next().and_then(|first| rest.strip_prefix(first)) else { return false };
    rest = behind;
    for part in parts {
        let Some(behind) = part.split_once(']').and_then(|(_, text)| rest.strip_prefix(text)) else { return false };
        rest = behind;
    }
    rest.is_empty()
}

pub(crate) fn item_named<'t>(tree: &'t Mechanism, name: &str) -> Option<&'t Item> {
    tree.items.iter().find(|item| match &item.kind {
        ItemKind::Ground { .. } => name == "ground",
        _ => check::name_of(item).is_some_and(|declared| declared.text == name),
    })
}

fn declaration(item: &Item) -> Declaration {
    Declaration { kind: NameKind::of(item), span: item.span, docs: item.docs.clone() }
}

fn feature_declaration(feature: &Feature) -> Declaration {
    let kind = match feature.kind {
        FeatureKind::Point { .. } => NameKind::Point,
        FeatureKind::AxisAlong { .. } | FeatureKind::AxisTo { .. } => NameKind::Axis,
        FeatureKind::Circle { .. } => NameKind::Circle,
        FeatureKind::Curve { .. } => NameKind::Curve,
        FeatureKind::Broken | FeatureKind::Mass { .. } => NameKind::Broken,
    };
    Declaration { kind, span: feature.span, docs: feature.docs.clone() }
}
