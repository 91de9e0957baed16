//! Prints a tree that has no text, as of an import, without layout: a line for each declaration, and a blank line where their kind changes.

use super::expression::{comparison_sign, expression};
use super::rows::Group;
use crate::ast::{
    Binding, ColumnName, ColumnWord, ComparedSide, DrawnPose, Expr, ExprKind, Factor, Feature, FeatureKind, File,
    IndexRange, Item, ItemKind, Mechanism, Name, Part, Requirement, TableRows, UsedFile, WrittenUnit,
};

/// Prints a file so that it parses to the same tree, apart from locations and redundant parentheses.
pub(super) fn print(file: &File) -> String {
    let uses: String = file.uses.iter().map(|used| documentation(&used.docs) + &use_file(used)).collect();
    let blocks: Vec<String> =
        Some(uses).filter(|uses| !uses.is_empty()).into_iter().chain(file.mechanisms.iter().map(mechanism)).collect();
    blocks.join("\n")
}

fn use_file(used: &UsedFile) -> String {
    // broken declarations have no text
    let Some(path) = &used.path else { return String::new() };
    let prefix = used.prefix.as_ref().map_or_else(String::new, |prefix| format!(" as {}", prefix.text));
    format!("use \"{}\"{prefix}\n", path.text)
}

fn mechanism(mechanism: &Mechanism) -> String {
    let groups = mechanism.items.chunk_by(|a, b| Group::of(&a.kind) == Group::of(&b.kind));
    let groups: Vec<String> = groups.map(|items| items.iter().map(documented).collect()).collect();
    let docs = documentation(&mechanism.docs);
    format!("{docs}mechanism {} {{\n{}}}\n", mechanism.name.text, groups.join("\n"))
}

fn documented(of: &Item) -> String {
    documentation(&of.docs) + &item(of) + "\n"
}

/// Returns the `///` lines above a declaration.
fn documentation(docs: &[String]) -> String {
    let lines = docs.iter().flat_map(|doc| doc.split('\n'));
    lines.map(|line| if line.is_empty() { "///\n".to_owned() } else { format!("/// {line}\n") }).collect()
}

fn item(item: &Item) -> String {
    let named = |name: &Name| format!("{}{}", name.text, ranges(&item.ranges));
    match &item.kind {
        // broken declarations have no text
        ItemKind::Broken { .. } => String::new(),
        ItemKind::Param { name, value } => format!("param {} {}", name.text, defined(value)),
        ItemKind::Function { name, argument, value } => {
            format!("fn {}({}) {}", name.text, argument.text, defined(value))
        }
        ItemKind::Table { name, periodic, rows } => format!("table {} {}", name.text, table(*periodic, rows)),
        ItemKind::Input { name, value } => format!("input {} {}", named(name), defined(value)),
        ItemKind::Part(of) => format!("part {}: {}", named(&of.name), part(of)),
        ItemKind::Ground { features } => format!("ground {}", block(features)),
        ItemKind::Body { name, pose, features } => {
            let pose = pose.as_ref().map_or_else(String::new, |pose| format!(" at {}", placed(pose)));
            format!("body {}{pose} {}", named(name), block(features))
        }
        ItemKind::Joint { name, kind, arguments, .. } => {
            format!("joint {}: {}({})", named(name), kind.text, list(arguments))
        }
        ItemKind::Equation { driver, name, left, right } => {
            let keyword = if *driver { "driver" } else { "constraint" };
            format!("{keyword} {}: {} {}", named(name), expression(left), defined(right))
        }
        ItemKind::Gravity { acceleration } => format!("gravity {}", pair(acceleration)),
        ItemKind::Load { name, force, on } => {
            format!("load {}: {} on {}", named(name), expression(force), expression(on))
        }
        ItemKind::Measure { name, value, unit } => {
            format!("measure {} {}{}", named(name), defined(value), in_unit(unit.as_ref()))
        }
        ItemKind::Trace { name, point, unit } => {
            format!("trace {} {}{}", named(name), defined(point), in_unit(unit.as_ref()))
        }
        ItemKind::Result { name, value, unit } => {
            format!("result {} {}{}", named(name), defined(value), in_unit(unit.as_ref()))
        }
        ItemKind::Requirement(of) => format!("require {}", requirement(of)),
        ItemKind::Analysis { from, to, every } => {
            format!("analysis from {} to {} every {}", expression(from), expression(to), expression(every))
        }
    }
}

fn requirement(of: &Requirement) -> String {
    let name = of.name.as_ref().map_or_else(String::new, |name| format!("{}: ", name.text));
    let mut text = format!("{name}{}", expression(&of.first));
    for ComparedSide { sign, right, .. } in &of.rest {
        text += &format!(" {} {}", comparison_sign(*sign), expression(right));
    }
    text + &of.within.as_ref().map_or_else(String::new, |within| format!(" within {}", expression(within)))
}

/// Returns `MECHANISM(BINDING, …) on BODY at (x, y, phi) mirrored`.
fn part(of: &Part) -> String {
    let bindings: Vec<String> = of.bindings.iter().map(binding).collect();
    let mut text = format!("{}({})", of.mechanism.text(), bindings.join(", "));
    text += &of.on.as_ref().map_or_else(String::new, |carrier| format!(" on {}", expression(carrier)));
    text += &of.at.as_ref().map_or_else(String::new, |at| format!(" at {}", pair(at)));
    text + if of.mirrored.is_some() { " mirrored" } else { "" }
}

fn binding(binding: &Binding) -> String {
    let coordinate = binding.coordinate.as_ref().map_or_else(String::new, |name| format!(".{}", name.text));
    format!("{}{coordinate} {}", binding.name.text, defined(&binding.value))
}

fn defined(value: &Expr) -> String {
    format!("= {}", expression(value))
}

/// Returns `[k in 0..n]`.
fn ranges(ranges: &[IndexRange]) -> String {
    let range = |range: &IndexRange| {
        let dots = if range.is_closed { "..=" } else { ".." };
        format!("{} in {}{dots}{}", range.index.text, expression(&range.from), expression(&range.to))
    };
    let list: Vec<String> = ranges.iter().map(range).collect();
    if list.is_empty() { String::new() } else { format!("[{}]", list.join(", ")) }
}

/// Returns ` in mm/s^2`, or an empty text.
fn in_unit(written: Option<&WrittenUnit>) -> String {
    written.map_or_else(String::new, |written| format!(" in {}", unit(written)))
}

fn unit(written: &WrittenUnit) -> String {
    let mut text = String::new();
    for (k, of) in written.factors.iter().enumerate() {
        match of.factor {
            Factor::Times if k == 0 => {}
            Factor::Times => text += "*",
            Factor::Divide if k == 0 => text += "1/",
            Factor::Divide => text += "/",
        }
        text += &of.name.text;
        if of.power != 1 {
            text += &format!("^{}", of.power);
        }
    }
    text
}

fn column(column: &ColumnName) -> String {
    match &column.kind {
        ColumnWord::Number(number) => number.to_string(),
        ColumnWord::Named(name) => format!("\"{name}\""),
    }
}

fn list(list: &[Expr]) -> String {
    let texts: Vec<String> = list.iter().map(expression).collect();
    texts.join(", ")
}

fn table(periodic: bool, rows: &TableRows) -> String {
    let spline = if periodic { "= periodic spline" } else { "= spline" };
    match rows {
        TableRows::File { path, columns, units } => {
            let columns = columns.as_ref().map(|[a, b]| format!(" columns {}, {}", column(a), column(b)));
            let units = units.as_ref().map(|[a, b]| format!(" ({}, {})", unit(a), unit(b)));
            format!("{spline} \"{}\"{}{}", path.text, columns.unwrap_or_default(), units.unwrap_or_default())
        }
        TableRows::Listed(rows) => format!("{spline} [{}]", list(rows)),
    }
}

/// Returns the features of a body or of the ground in their braces.
fn block(features: &[Feature]) -> String {
    let lines: String = features.iter().map(|of| documentation(&of.docs) + &feature(of) + "\n").collect();
    format!("{{\n{lines}}}")
}

fn feature(feature: &Feature) -> String {
    let name = &feature.name.text;
    match &feature.kind {
        FeatureKind::Broken => String::new(),
        FeatureKind::Point { at: None } => format!("point {name}"),
        FeatureKind::Point { at: Some(at) } => format!("point {name} {}", defined(at)),
        FeatureKind::AxisAlong { origin, direction } => {
            format!("axis {name} {} along {}", defined(origin), pair(direction))
        }
        FeatureKind::AxisTo { origin, target } => format!("axis {name} {} to {}", defined(origin), expression(target)),
        FeatureKind::Circle { center, radius } => {
            format!("circle {name} {} radius {}", defined(center), expression(radius))
        }
        FeatureKind::Curve { argument, at, estimate } => {
            let estimate = estimate.as_ref().map_or_else(String::new, |e| format!(" at {}", expression(e)));
            format!("curve {name}({}) {}{estimate}", argument.text, defined(at))
        }
        FeatureKind::Mass { mass, at, inertia } => {
            let at = at.as_ref().map_or_else(String::new, |at| format!(" at {}", expression(at)));
            let inertia = inertia.as_ref().map_or_else(String::new, |of| format!(" inertia {}", expression(of)));
            format!("mass {}{at}{inertia}", expression(mass))
        }
    }
}

/// Prints an expression in the parentheses that the grammar requires, unless it has them.
fn pair(e: &Expr) -> String {
    match e.bare().kind {
        ExprKind::Tuple(_) => expression(e),
        _ => format!("({})", expression(e)),
    }
}

/// Prints the pose behind a body's `at`.
fn placed(pose: &DrawnPose) -> String {
    let parts: Vec<String> = pose.parts().map(expression).collect();
    parts.join(" toward ")
}
