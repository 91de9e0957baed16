//! Tree to text: a file as a person would write it.
//!
//! What is printed reads back as the same tree, apart from places and from parentheses that change nothing. Columns
//! are aligned, and a blank line stands where the kind of declaration changes. Comments stay beside the declaration that they stood
//! beside; those within one go above it.
//!
//! This room knows how things are written, not what they mean: a tree that `check` would refuse is printed as well.

mod comments;
mod expression;

use super::ast::{
    Binding, Column, ColumnKind, Expr, ExprKind, Factor, Feature, FeatureKind, File, Item, ItemKind, Mechanism, Name,
    Part, Pose, Range, TableRows, Use, WrittenUnit,
};
use super::trivia::Trivia;
use comments::{Comments, lines};
pub use expression::expression;

/// One level of indentation.
const INDENT: &str = "    ";

/// Cells wider than this stick out of their column instead of pushing the others away.
const WIDEST_CELL: usize = 40;

/// A table's rows stand on one line up to this width, and on a line each beyond it.
const WIDEST_LIST: usize = 72;

/// A tree as text. It ends with a line end, and is empty if the tree is.
#[must_use]
pub fn format(file: &File) -> String {
    format_with(file, Comments::none())
}

/// The same of a tree that was read from a text, with the text's comments.
#[must_use]
pub fn format_with_comments(file: &File, trivia: &Trivia, text: &str) -> String {
    format_with(file, Comments::of(file, trivia, text))
}

fn format_with(file: &File, mut comments: Comments<'_>) -> String {
    let uses = (!file.uses.is_empty()).then(|| uses(&file.uses, &mut comments));
    let mechanisms = file.mechanisms.iter().map(|of_file| mechanism(of_file, &mut comments));
    let blocks: Vec<String> = uses.into_iter().chain(mechanisms).collect();
    let text = blocks.join("\n");
    let rest = lines(&comments.rest(), "");
    if text.is_empty() || rest.is_empty() { text + &rest } else { format!("{text}\n{rest}") }
}

/// The files that are used, a line each.
fn uses(uses: &[Use], comments: &mut Comments<'_>) -> String {
    let mut rows = Vec::new();
    for used in uses {
        let above = comments.before(used.span.end);
        let behind = comments.behind(used.span.end);
        rows.push(Row { above, docs: &used.docs, cells: use_cells(used), behind });
    }
    columns(&rows, "")
}

fn use_cells(used: &Use) -> Vec<String> {
    // what is broken has no form
    let Some(path) = &used.path else { return Vec::new() };
    let path = format!("\"{}\"", path.text);
    match &used.prefix {
        Some(prefix) => cells(["use", &path, &format!("as {}", prefix.text)]),
        None => cells(["use", &path]),
    }
}

fn mechanism(mechanism: &Mechanism, comments: &mut Comments<'_>) -> String {
    let above = lines(&comments.before(mechanism.span.start), "");
    let groups = mechanism.items.chunk_by(|a, b| Group::of(&a.kind) == Group::of(&b.kind));
    let mut groups: Vec<String> = groups.map(|items| group(items, comments)).collect();
    let at_the_end = lines(&comments.before(mechanism.span.end), INDENT);
    if !at_the_end.is_empty() {
        groups.push(at_the_end);
    }
    let trailing = comments.behind(mechanism.span.end).map_or(String::new(), |comment| format!(" {comment}"));
    let docs = documentation(&mechanism.docs, "");
    format!("{above}{docs}mechanism {} {}{trailing}\n", mechanism.name.text, braces(&groups.join("\n"), ""))
}

/// Declarations that stand together, without a blank line between them.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Group {
    Params,
    Functions,
    Tables,
    Inputs,
    Parts,
    Bodies,
    Joints,
    Constraints,
    Drivers,
    Measures,
    Results,
    Analysis,
    Broken,
}

impl Group {
    fn of(kind: &ItemKind) -> Group {
        match kind {
            ItemKind::Param { .. } => Group::Params,
            ItemKind::Function { .. } => Group::Functions,
            ItemKind::Table { .. } => Group::Tables,
            ItemKind::Input { .. } => Group::Inputs,
            ItemKind::Part(_) => Group::Parts,
            ItemKind::Ground { .. } | ItemKind::Body { .. } => Group::Bodies,
            ItemKind::Joint { .. } => Group::Joints,
            ItemKind::Equation { driver: false, .. } => Group::Constraints,
            ItemKind::Equation { driver: true, .. } => Group::Drivers,
            ItemKind::Measure { .. } | ItemKind::Trace { .. } => Group::Measures,
            ItemKind::Result { .. } => Group::Results,
            ItemKind::Analysis { .. } => Group::Analysis,
            ItemKind::Broken { .. } => Group::Broken,
        }
    }
}

/// A declaration in columns; the last one is as wide as it likes.
struct Row<'a> {
    /// Comments on lines of their own.
    above: Vec<String>,
    docs: &'a [String],
    cells: Vec<String>,
    /// The comment behind it.
    behind: Option<String>,
}

fn group(items: &[Item], comments: &mut Comments<'_>) -> String {
    let rows: Vec<Row<'_>> = items.iter().map(|item| item_row(item, comments)).collect();
    columns(&rows, INDENT)
}

fn item_row<'a>(item: &'a Item, comments: &mut Comments<'_>) -> Row<'a> {
    let (above, block) = match &item.kind {
        ItemKind::Ground { features } | ItemKind::Body { features, .. } => {
            let above = comments.before(item.span.start);
            (above, body(features, item.span.end, comments))
        }
        _ => (comments.around(item), String::new()),
    };
    let cells = item_cells(item, &block);
    Row { above, docs: &item.docs, cells, behind: comments.behind(item.span.end) }
}

/// With the block of a body or of the ground as text.
fn item_cells(item: &Item, block: &str) -> Vec<String> {
    let named = |name: &Name| format!("{}{}", name.text, ranges(&item.ranges));
    match &item.kind {
        // what is broken has no form
        ItemKind::Broken { .. } => Vec::new(),
        ItemKind::Param { name, value } => cells(["param", &name.text, &defined(value)]),
        ItemKind::Function { name, argument, value } => {
            cells(["fn", &format!("{}({})", name.text, argument.text), &defined(value)])
        }
        ItemKind::Table { name, periodic, rows } => cells(["table", &name.text, &table(*periodic, rows)]),
        ItemKind::Input { name, value } => cells(["input", &named(name), &defined(value)]),
        ItemKind::Part(of) => cells(["part", &(named(&of.name) + ":"), &part(of)]),
        ItemKind::Ground { .. } => vec![format!("ground {block}")],
        ItemKind::Body { name, pose: None, .. } => vec![format!("body {} {block}", named(name))],
        ItemKind::Body { name, pose: Some(pose), .. } => {
            vec![format!("body {} at {} {block}", named(name), placed(pose))]
        }
        ItemKind::Joint { name, kind, arguments, .. } => {
            cells(["joint", &(named(name) + ":"), &format!("{}({})", kind.text, list(arguments))])
        }
        ItemKind::Equation { driver, name, left, right } => {
            let keyword = if *driver { "driver" } else { "constraint" };
            cells([keyword, &(named(name) + ":"), &expression(left), &defined(right)])
        }
        ItemKind::Measure { name, value, unit: printed } => {
            cells(["measure", &named(name), &(defined(value) + &in_unit(printed.as_ref()))])
        }
        ItemKind::Trace { name, point, unit: printed } => {
            cells(["trace", &named(name), &(defined(point) + &in_unit(printed.as_ref()))])
        }
        ItemKind::Result { name, value, unit: printed } => {
            cells(["result", &named(name), &(defined(value) + &in_unit(printed.as_ref()))])
        }
        ItemKind::Analysis { from, to, every } => {
            vec![format!("analysis from {} to {} every {}", expression(from), expression(to), expression(every))]
        }
    }
}

/// `MECHANISM(BINDING, …) on BODY at (x, y, phi) mirrored`
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

fn cells<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).into()
}

fn defined(value: &Expr) -> String {
    format!("= {}", expression(value))
}

/// `[k in 0..n]`
fn ranges(ranges: &[Range]) -> String {
    let range = |range: &Range| {
        let dots = if range.is_closed { "..=" } else { ".." };
        format!("{} in {}{dots}{}", range.index.text, expression(&range.from), expression(&range.to))
    };
    let list: Vec<String> = ranges.iter().map(range).collect();
    if list.is_empty() { String::new() } else { format!("[{}]", list.join(", ")) }
}

/// ` in mm/s^2`, or nothing.
fn in_unit(written: Option<&WrittenUnit>) -> String {
    written.map_or_else(String::new, |written| format!(" in {}", unit(written)))
}

fn unit(written: &WrittenUnit) -> String {
    let mut text = String::new();
    for (k, of) in written.factors.iter().enumerate() {
        match of.factor {
            Factor::Times if k == 0 => {}
            Factor::Times => text += "*",
            Factor::Over if k == 0 => text += "1/",
            Factor::Over => text += "/",
        }
        text += &of.name.text;
        if of.power != 1 {
            text += &format!("^{}", of.power);
        }
    }
    text
}

fn column(column: &Column) -> String {
    match &column.kind {
        ColumnKind::Number(number) => number.to_string(),
        ColumnKind::Named(name) => format!("\"{name}\""),
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
        TableRows::Listed(rows) => {
            let on_one_line = list(rows);
            if width(&on_one_line) <= WIDEST_LIST {
                return format!("{spline} [{on_one_line}]");
            }
            let lines: Vec<String> = rows.iter().map(expression).collect();
            let line_end = format!(",\n{INDENT}{INDENT}");
            format!("{spline} [\n{INDENT}{INDENT}{},\n{INDENT}]", lines.join(&line_end))
        }
    }
}

/// The features of a body or of the ground in their braces.
fn body(features: &[Feature], end: u32, comments: &mut Comments<'_>) -> String {
    let mut rows = Vec::new();
    for feature in features {
        let above = comments.before(feature.span.end);
        let behind = comments.behind(feature.span.end);
        rows.push(Row { above, docs: &feature.docs, cells: feature_cells(feature), behind });
    }
    let indent = INDENT.repeat(2);
    let at_the_end = lines(&comments.before(end), &indent);
    braces(&(columns(&rows, &indent) + &at_the_end), INDENT)
}

fn feature_cells(feature: &Feature) -> Vec<String> {
    let name = &feature.name.text;
    match &feature.kind {
        FeatureKind::Broken => Vec::new(),
        FeatureKind::Point { at: None } => cells(["point", name]),
        FeatureKind::Point { at: Some(at) } => cells(["point", name, &defined(at)]),
        FeatureKind::AxisAlong { origin, direction } => {
            cells(["axis", name, &format!("{} along {}", defined(origin), pair(direction))])
        }
        FeatureKind::AxisTo { origin, target } => {
            cells(["axis", name, &format!("{} to {}", defined(origin), expression(target))])
        }
        FeatureKind::Circle { center, radius } => {
            cells(["circle", name, &format!("{} radius {}", defined(center), expression(radius))])
        }
        FeatureKind::Curve { argument, at, estimate } => {
            let estimate = estimate.as_ref().map_or_else(String::new, |e| format!(" at {}", expression(e)));
            cells(["curve", &format!("{name}({})", argument.text), &format!("{}{estimate}", defined(at))])
        }
    }
}

/// Where the grammar wants parentheses, whatever stands in them.
fn pair(e: &Expr) -> String {
    match e.bare().kind {
        ExprKind::Tuple(_) => expression(e),
        _ => format!("({})", expression(e)),
    }
}

/// What stands behind a body's `at`.
fn placed(pose: &Pose) -> String {
    let parts: Vec<String> = pose.parts().map(expression).collect();
    parts.join(" toward ")
}

/// Lines in braces, or empty braces if there are none.
fn braces(lines: &str, indent: &str) -> String {
    if lines.is_empty() { "{}".to_owned() } else { format!("{{\n{lines}{indent}}}") }
}

/// The `///` lines above a declaration.
fn documentation(docs: &[String], indent: &str) -> String {
    let mut text = String::new();
    for line in docs.iter().flat_map(|doc| doc.split('\n')) {
        text += indent;
        text += "///";
        if !line.is_empty() {
            text += " ";
            text += line;
        }
        text += "\n";
    }
    text
}

/// A line per row, every cell but the last as wide as the widest of its column.
fn columns(rows: &[Row<'_>], indent: &str) -> String {
    let widest = |column: usize| {
        let others = rows.iter().filter_map(|row| row.cells.split_last()?.1.get(column));
        others.map(|cell| width(cell)).filter(|&width| width <= WIDEST_CELL).max().unwrap_or(0)
    };
    let count = rows.iter().map(|row| row.cells.len()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..count).map(widest).collect();
    let mut text = String::new();
    for row in rows {
        text += &lines(&row.above, indent);
        text += &documentation(row.docs, indent);
        text += indent;
        if let Some((last, others)) = row.cells.split_last() {
            for (cell, &wide) in others.iter().zip(&widths) {
                text += &format!("{cell:wide$} ");
            }
            text += last;
        }
        if let Some(comment) = &row.behind {
            text += " ";
            text += comment;
        }
        text += "\n";
    }
    text
}

/// In characters, as the padding of `format!` counts them.
fn width(text: &str) -> usize {
    text.chars().count()
}
