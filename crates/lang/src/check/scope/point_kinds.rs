//! Decides which formulas are points, and which names in them can only be points. It uses the tree alone, for the formula reader and the
//! symbol table.

use mechc_syntax::ast::{Expr, ExprKind, ItemKind, Mechanism, Name};
use mechc_text::vocabulary::{Function, Group, gives_way};
use rustc_hash::{FxHashMap, FxHashSet};

/// The kind of value that is expected of a name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::check) enum Expected {
    /// A number.
    Number,
    /// A point only.
    Point,
    /// A number or a point, as for a factor.
    Either,
}

/// Returns the coordinate of a point that `P.x` or `P.y` selects.
pub(in crate::check) fn coordinate(feature: &Name) -> Option<usize> {
    ["x", "y"].iter().position(|name| feature.text == *name)
}

/// Returns whether a function for points takes points, as `mid`, `length` and `direction` do, and not numbers, as `polar` does; `None`
/// for other functions.
fn takes_points(function: &str) -> Option<bool> {
    let of_points = Function::named(function).is_some_and(|function| function.group == Group::Points);
    of_points.then(|| function != "polar")
}

/// Returns the children of a formula with the expected kinds; `hidden` are the functions and tables of the file.
pub(in crate::check) fn inside(e: &Expr, expected: Expected, hidden: impl Fn(&str) -> bool) -> Vec<(&Expr, Expected)> {
    let inner = match &e.kind {
        ExprKind::Paren(_) | ExprKind::Negate(_) | ExprKind::Sum(..) => expected,
        ExprKind::Product(..) if expected != Expected::Number => Expected::Either,
        ExprKind::Call { name, .. } if takes_points(&name.text) == Some(true) && !hidden(&name.text) => Expected::Point,
        _ => Expected::Number,
    };
    e.children().into_iter().map(|child| (child, inner)).collect()
}

/// Visits every name of a formula that stands alone, or before `.x` and `.y`, with its expected kind.
pub(in crate::check) fn names_in<'e>(
    formula: &'e Expr,
    expected: Expected,
    hidden: impl Fn(&str) -> bool,
    mut each: impl FnMut(&'e Name, Expected),
) {
    let mut open = vec![(formula, expected)];
    while let Some((e, expected)) = open.pop() {
        match &e.kind {
            ExprKind::Name(name) => each(name, expected),
            ExprKind::Member { owner, feature } if expected != Expected::Point && coordinate(feature).is_some() => {
                each(owner, Expected::Point);
            }
            _ => {}
        }
        open.extend(inside(e, expected, &hidden).into_iter().rev());
    }
}

/// Returns whether a formula is a point; `is_one` answers for a name and for `body.feature`.
pub(in crate::check) fn is_point(
    formula: &Expr,
    hidden: impl Fn(&str) -> bool,
    is_one: impl Fn(&Expr) -> bool,
) -> bool {
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
            // Conditions are not points.
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

/// Returns the names of a mechanism's params that are points.
pub(in crate::check) fn point_params(mechanism: &Mechanism) -> FxHashSet<&str> {
    let hiding = hiding_functions(mechanism);
    let hidden = |name: &str| hiding.contains(name);
    let (mut points, mut users): (Vec<&str>, FxHashMap<&str, Vec<&str>>) = (Vec::new(), FxHashMap::default());
    for item in &mechanism.items {
        let ItemKind::Param { name, value } = &item.kind else { continue };
        if is_point(value, hidden, |_| false) {
            points.push(&name.text);
        }
        names_in(value, Expected::Either, hidden, |used, expected| {
            if expected == Expected::Either {
                users.entry(&used.text).or_default().push(&name.text);
            }
        });
    }
    // A param that refers to a point is a point too.
    let mut found = FxHashSet::default();
    while let Some(name) = points.pop() {
        if found.insert(name) {
            points.extend(users.get(name).into_iter().flatten());
        }
    }
    found
}

/// Returns the functions and tables that hide a function of the language; a broken declaration may be one.
pub(in crate::check) fn hiding_functions(mechanism: &Mechanism) -> FxHashSet<&str> {
    let names = mechanism.items.iter().flat_map(|item| match &item.kind {
        ItemKind::Function { name, .. } | ItemKind::Table { name, .. } => std::slice::from_ref(name),
        ItemKind::Broken { names } => names,
        _ => &[],
    });
    names.map(|name| name.text.as_str()).filter(|name| gives_way(name)).collect()
}
