//! The names that formulas use, and their locations.

use super::point_kinds::coordinate;
use mechc_syntax::ast::{Expr, ExprKind, Item, ItemKind, Mechanism, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Constant, NamedConstant, gives_way, is_called};

/// Returns the uses of a function's or curve's argument in its formula.
pub(super) fn uses_of_argument(argument: &Name, formula: &Expr) -> Vec<Span> {
    let mut uses = Vec::new();
    visit_free_names(formula, gives_way, |name, _| {
        if name.text == argument.text {
            uses.push(name.span);
        }
    });
    uses
}

/// Returns the uses of a declaration in a mechanism, as a call or as a plain name.
pub(in crate::check) fn uses_in(mechanism: &Mechanism, declared: &Name, is_called: bool) -> Vec<Span> {
    // A lone `t` may also be the time.
    let is_time =
        Constant::named(&declared.text).is_some_and(|constant| matches!(constant.stands_for, NamedConstant::Time));
    let mut open: Vec<&Expr> = mechanism.items.iter().flat_map(Item::formulas).collect();
    let mut uses = Vec::new();
    while let Some(e) = open.pop() {
        let used = match &e.kind {
            ExprKind::Call { name, .. } if is_called => Some(name),
            ExprKind::Name(name) if !is_called && !is_time => Some(name),
            ExprKind::Member { owner, .. } if !is_called => Some(owner),
            _ => None,
        };
        uses.extend(used.filter(|name| name.text == declared.text).map(|name| name.span));
        open.extend(e.children());
    }
    uses
}

/// Returns the indices of all paths in a formula.
pub(in crate::check) fn indices<'e>(formula: &'e Expr) -> Vec<&'e Expr> {
    let indices_of = |e: &'e Expr| match &e.kind {
        ExprKind::Path(segments) => segments.as_slice(),
        _ => &[],
    };
    formula.parts().flat_map(indices_of).flat_map(|segment| &segment.indices).collect()
}

/// Returns the name that a declaration introduces.
#[must_use]
pub fn name_of(item: &Item) -> Option<&Name> {
    match &item.kind {
        ItemKind::Param { name, .. }
        | ItemKind::Function { name, .. }
        | ItemKind::Table { name, .. }
        | ItemKind::Input { name, .. }
        | ItemKind::Body { name, .. }
        | ItemKind::Joint { name, .. }
        | ItemKind::Equation { name, .. }
        | ItemKind::Load { name, .. }
        | ItemKind::Measure { name, .. }
        | ItemKind::Trace { name, .. }
        | ItemKind::Result { name, .. } => Some(name),
        ItemKind::Requirement(requirement) => requirement.name.as_ref(),
        ItemKind::Part(part) => Some(&part.name),
        ItemKind::Ground { .. } | ItemKind::Gravity { .. } | ItemKind::Broken { .. } | ItemKind::Analysis { .. } => {
            None
        }
    }
}

/// Calls `each` for every free name of a formula, with whether it is called. A name before `.x` or `.y` counts; a call of the language's
/// own function or quantity does not, unless `hidden` says that the file's function or table, or a quantity's name, takes precedence.
pub(in crate::check) fn visit_free_names<'e>(
    formula: &'e Expr,
    hidden: impl Fn(&str) -> bool,
    mut each: impl FnMut(&'e Name, bool),
) {
    let mut open = vec![formula];
    while let Some(e) = open.pop() {
        match &e.kind {
            ExprKind::Call { name, .. } if is_called(&name.text) && !hidden(&name.text) => {}
            ExprKind::Name(name) => each(name, false),
            ExprKind::Call { name, .. } => each(name, true),
            ExprKind::Member { owner, feature } if coordinate(feature).is_some() => each(owner, false),
            _ => {}
        }
        open.extend(e.children().into_iter().rev());
    }
}
