//! Which formulas are points, and which names in them can only be points: by the tree alone, for the reader of formulas and for the
//! table of names.

use mechc_syntax::ast::{Expr, ExprKind, ItemKind, Mechanism, Name};
use mechc_text::vocabulary::{Function, Group, gives_way};
use rustc_hash::{FxHashMap, FxHashSet};

/// What is asked of a name where it stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Wanted {
    /// A number.
    Number,
    /// A point, and nothing else could stand there.
    Point,
    /// A number or a point: a factor.
    Either,
}

/// Whether `P.x` asks for a coordinate of a point.
pub(super) fn coordinate(feature: &Name) -> Option<usize> {
    ["x", "y"].iter().position(|name| feature.text == *name)
}

/// What a call of the language's own takes, if it is about points: `mid`, `length` and `direction` take points.
fn takes_points(function: &str) -> Option<bool> {
    let of_points = Function::named(function).is_some_and(|function| function.group == Group::Points);
    of_points.then(|| function != "polar")
}

/// The formulas inside one, each with what it stands for; `hidden` tells the functions and tables of the file.
pub(super) fn inside(e: &Expr, wanted: Wanted, hidden: impl Fn(&str) -> bool) -> Vec<(&Expr, Wanted)> {
    let inner = match &e.kind {
        ExprKind::Paren(_) | ExprKind::Negate(_) | ExprKind::Sum(..) => wanted,
        ExprKind::Product(..) if wanted != Wanted::Number => Wanted::Either,
        ExprKind::Call { name, .. } if takes_points(&name.text) == Some(true) && !hidden(&name.text) => Wanted::Point,
        _ => Wanted::Number,
    };
    e.children().into_iter().map(|child| (child, inner)).collect()
}

/// Every name of a formula that stands alone, or before `.x` and `.y`, with what is asked of it.
pub(super) fn names_in<'e>(
    formula: &'e Expr,
    wanted: Wanted,
    hidden: impl Fn(&str) -> bool,
    mut each: impl FnMut(&'e Name, Wanted),
) {
    let mut open = vec![(formula, wanted)];
    while let Some((e, wanted)) = open.pop() {
        match &e.kind {
            ExprKind::Name(name) => each(name, wanted),
            ExprKind::Member { owner, feature } if wanted != Wanted::Point && coordinate(feature).is_some() => {
                each(owner, Wanted::Point);
            }
            _ => {}
        }
        open.extend(inside(e, wanted, &hidden).into_iter().rev());
    }
}

/// Whether a formula is a point; `is_one` tells it of a name and of `body.feature`.
pub(super) fn is_point(formula: &Expr, hidden: impl Fn(&str) -> bool, is_one: impl Fn(&Expr) -> bool) -> bool {
    let mut open = vec![formula];
    while let Some(e) = open.pop() {
        let holds = match &e.kind {
            ExprKind::Tuple(_) => true,
            ExprKind::Name(_) | ExprKind::Member { .. } => is_one(e),
            ExprKind::Call { name, .. } => matches!(name.text.as_str(), "polar" | "mid") && !hidden(&name.text),
            ExprKind::Paren(_) | ExprKind::Negate(_) | ExprKind::Sum(..) | ExprKind::Product(..) => {
                open.extend(e.children());
                false
            }
            // the conditions are none
            ExprKind::If { arms, otherwise } => {
                open.extend(arms.iter().map(|(_, value)| value));
                open.push(otherwise);
                false
            }
            _ => false,
        };
        if holds {
            return true;
        }
    }
    false
}

/// The names of a mechanism's params that are points.
pub(super) fn point_params(mechanism: &Mechanism) -> FxHashSet<&str> {
    let own = own_functions(mechanism);
    let hidden = |name: &str| own.contains(name);
    let (mut points, mut users): (Vec<&str>, FxHashMap<&str, Vec<&str>>) = (Vec::new(), FxHashMap::default());
    for item in &mechanism.items {
        let ItemKind::Param { name, value } = &item.kind else { continue };
        if is_point(value, hidden, |_| false) {
            points.push(&name.text);
        }
        names_in(value, Wanted::Either, hidden, |used, wanted| {
            if wanted == Wanted::Either {
                users.entry(&used.text).or_default().push(&name.text);
            }
        });
    }
    // what holds a point is one
    let mut found = FxHashSet::default();
    while let Some(name) = points.pop() {
        if found.insert(name) {
            points.extend(users.get(name).into_iter().flatten());
        }
    }
    found
}

/// The names of its functions and tables that hide one of the language; what cannot be read may be one.
pub(super) fn own_functions(mechanism: &Mechanism) -> FxHashSet<&str> {
    let names = mechanism.items.iter().flat_map(|item| match &item.kind {
        ItemKind::Function { name, .. } | ItemKind::Table { name, .. } => std::slice::from_ref(name),
        ItemKind::Broken { names } => names,
        _ => &[],
    });
    names.map(|name| name.text.as_str()).filter(|name| gives_way(name)).collect()
}
