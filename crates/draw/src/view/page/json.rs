//! Data of a page as JSON.

use super::utf16_offsets::{TextRange, Texts};
use super::{Column, FORMAT, Page, Variant, table_compression};
use crate::scene::{
    Alignment, Anchor, Attachment, Contact, ForceValue, ForceVector, Node, Pen, Scene, Torque, Touch, Trace,
};
use crate::view::path::path_data;
use mechc_text::diag::Diagnostic;
use mechc_text::source::Source;
use serde_json::{Map, Value, json};
use std::path::Path;

/// Size of a symbol in units of the last decimal: six digits are enough for drawing.
const LEAST_DIGITS: f64 = 1e5;
/// Limit of decimals.
const MOST_DECIMALS: usize = 30;

/// Writes the data with every `every`th row of the tables and the last one. It contains nothing that ends a script element.
pub(super) fn write(page: &Page, every: usize) -> String {
    // a script element ends at `</script`, and `<!--` has a meaning of its own
    value(page, every, Tables::Embedded).to_string().replace('<', "\\u003c")
}

/// Location of the numbers of tables.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Tables {
    Embedded,
    Separate,
}

/// Returns the data, or null if the page has no variant to show.
pub(super) fn value(page: &Page, every: usize, tables: Tables) -> Value {
    let texts = Texts::new(&page.texts);
    let Some(first) = page.first() else { return Value::Null };
    let scene = scene(first.scene, &texts);
    let variants: Vec<Value> = page
        .variants
        .iter()
        .map(|variant| {
            let table = if tables == Tables::Embedded { table(variant, every, page.columns.len()) } else { Vec::new() };
            let packed = if table.is_empty() { String::new() } else { table_compression::compress(&table) };
            variant_object(variant, every, &packed, &texts, first.scene, &scene)
        })
        .collect();
    let mut all = json!({
        "format": FORMAT,
        "mechc": env!("CARGO_PKG_VERSION"),
        "bytes": 0,
        "name": first.scene.name,
        "docs": first.scene.docs.join("\n"),
        "texts": page.texts.iter().map(|(_, source)| text(source)).collect::<Vec<_>>(),
        "scene": scene,
        "columns": page.columns.iter().map(|column| Value::Object(column_object(column))).collect::<Vec<_>>(),
        "vary": page.vary.iter().map(|vary| {
            json!({ "name": vary.name, "unit": vary.unit, "values": vary.values, "nearest": vary.nearest, "own": vary.nominal })
        }).collect::<Vec<_>>(),
        "variants": variants,
    });
    if let (Some(message), Some(object)) = (thinning_note(first, every), all.as_object_mut()) {
        object.insert("thinned".to_owned(), message.into());
    }
    all
}

/// Returns a text with the name of its file; the folder is private.
fn text(source: &Source) -> Value {
    let name = Path::new(&source.name).file_name().map_or(source.name.clone().into(), |name| name.to_string_lossy());
    json!({ "name": name, "text": source.text })
}

fn column_object(column: &Column) -> Map<String, Value> {
    let mut object = Map::new();
    object.insert("name".to_owned(), column.name.into());
    object.insert("unit".to_owned(), column.unit.into());
    if column.scale.iter().any(|part| part.to_bits() != 1.0_f64.to_bits()) {
        object.insert("scale".to_owned(), json!(column.scale));
    }
    if !column.kind.is_empty() {
        object.insert("kind".to_owned(), column.kind.into());
    }
    object
}

/// Returns the note that rows were left out, if any were.
fn thinning_note(variant: &Variant, every: usize) -> Option<String> {
    let (all, kept) = (variant.all_rows, kept_rows(variant.motion.rows().len(), every).count());
    (kept < all).then(|| format!("This page has {kept} of the {all} rows of the motion, evenly spread."))
}

/// Returns every `every`th row and the last one.
fn kept_rows(rows: usize, every: usize) -> impl Iterator<Item = usize> {
    let last = rows.checked_sub(1);
    (0..rows).step_by(every).chain(last.filter(move |last| last % every != 0))
}

/// Returns the columns of a table; without rows there are none.
pub(super) fn table(variant: &Variant, every: usize, count: usize) -> Vec<Vec<f64>> {
    let table = variant.motion.rows();
    let rows: Vec<usize> = kept_rows(table.len(), every).collect();
    let values_of = |column: usize| {
        // infinite values are stored as NaN
        let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
        rows.iter().map(|row| finite(table[*row].get(column).copied().unwrap_or(f64::NAN))).collect()
    };
    if rows.is_empty() { Vec::new() } else { (0..count).map(values_of).collect() }
}

fn variant_object(
    variant: &Variant,
    every: usize,
    packed: &str,
    texts: &Texts,
    first: &Scene,
    shared: &Value,
) -> Value {
    let motion = variant.motion;
    let rows = kept_rows(motion.rows().len(), every).count();
    let results = variant.results.iter().map(|(column, value)| {
        let mut object = column_object(column);
        object.insert("value".to_owned(), json!(value));
        Value::Object(object)
    });
    let mut object = json!({
        "rows": rows,
        "data": packed,
        "results": results.collect::<Vec<_>>(),
        "messages": variant.messages.iter().map(|diagnostic| message(diagnostic, texts)).collect::<Vec<_>>(),
        "edges": motion.edges,
    });
    if let Some(object) = object.as_object_mut() {
        if rows == 0 && !motion.is_empty() {
            let drawn: Vec<[f64; 3]> = motion.poses(0).iter().map(|pose| [pose.at[0], pose.at[1], pose.phi]).collect();
            object.insert("drawn".to_owned(), json!(drawn));
        }
        if !variant.scene.named.is_empty() {
            object.insert("named".to_owned(), json!(variant.scene.named));
        }
        let is_first = std::ptr::eq(first, variant.scene);
        let scene_changes = if is_first { None } else { changes(shared, &scene(variant.scene, texts)) };
        if let Some(changes) = scene_changes {
            object.insert("scene".to_owned(), changes);
        }
    }
    object
}

/// Returns what turns one value into another, or `None` if they are equal. A replaced value is an array of one element; for arrays of equal
/// length and objects with equal keys it holds only the differences, by index or key.
fn changes(from: &Value, to: &Value) -> Option<Value> {
    if from == to {
        return None;
    }
    let changed = match (from, to) {
        (Value::Array(from), Value::Array(to)) if from.len() == to.len() => {
            let pairs = from.iter().zip(to).enumerate();
            pairs.filter_map(|(index, (from, to))| Some((index.to_string(), changes(from, to)?))).collect()
        }
        (Value::Object(from), Value::Object(to)) if from.keys().eq(to.keys()) => {
            let pairs = from.iter().zip(to.values());
            pairs.filter_map(|((key, from), to)| Some((key.clone(), changes(from, to)?))).collect()
        }
        _ => return Some(json!([to])),
    };
    Some(Value::Object(changed))
}

fn message(message: &Diagnostic, texts: &Texts) -> Value {
    let label = |label: &mechc_text::diag::Label| {
        let TextRange { text, start, end } = texts.locate(label.span)?;
        Some(json!({ "text": text, "from": start, "to": end, "says": label.text }))
    };
    let mut object = json!({
        "severity": message.severity().as_str(),
        "code": message.code.as_str(),
        "text": message.message,
        "labels": message.labels.iter().filter_map(label).collect::<Vec<_>>(),
        "notes": message.notes,
        "help": message.help,
    });
    if let (Some(time), Some(object)) = (message.data.get("t").and_then(Value::as_f64), object.as_object_mut()) {
        object.insert("time".to_owned(), time.into());
    }
    object
}

/// Returns the scene with the spans of declarations in the texts.
pub(super) fn scene(scene: &Scene, texts: &Texts) -> Value {
    let decimals = decimals(scene.unit);
    let declarations = scene.declarations.iter().map(|declaration| {
        let TextRange { text, start, end } = texts.locate(declaration.span).unwrap_or_default();
        json!([declaration.name, declaration.kind, text, start, end])
    });
    let points = scene.points.iter().map(|point| {
        json!({
            "name": point.name, "declaration": point.declaration, "frame": point.frame, "at": point.at, "pin": point.is_pin,
        })
    });
    // without finite values the page computes an extent of its own
    let extent = if scene.extent.iter().flatten().all(|part| part.is_finite()) { scene.extent } else { [[0.0; 2]; 2] };
    let mut all = json!({
        "unit": scene.unit,
        "extent": extent,
        "declarations": declarations.collect::<Vec<_>>(),
        "frames": scene.frames,
        "points": points.collect::<Vec<_>>(),
        "nodes": scene.nodes.iter().map(|node| node_value(node, decimals)).collect::<Vec<_>>(),
        "traces": scene.traces.iter().map(trace).collect::<Vec<_>>(),
        "profiles": scene.profiles.iter().map(|profile| {
            json!({ "declaration": profile.declaration, "frame": profile.frame })
        }).collect::<Vec<_>>(),
        "contacts": scene.contacts.iter().map(contact).collect::<Vec<_>>(),
    });
    let lists = [
        ("forces", scene.forces.iter().map(force).collect::<Vec<Value>>()),
        ("torques", scene.torques.iter().map(torque).collect()),
    ];
    for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
        if let Some(object) = all.as_object_mut() {
            object.insert(name.to_owned(), list.into());
        }
    }
    all
}

/// Returns the decimals of metres that give a symbol's size [`LEAST_DIGITS`] units of the last decimal.
fn decimals(unit: f64) -> usize {
    // no logarithms: their bits differ between platforms
    let (mut decimals, mut size) = (0, unit * (1.0 + f64::EPSILON));
    while size < LEAST_DIGITS && decimals < MOST_DECIMALS {
        size *= 10.0;
        decimals += 1;
    }
    decimals
}

fn anchor_value(anchor: &Anchor) -> Value {
    json!([anchor.frame, anchor.at[0], anchor.at[1]])
}

fn force(force: &ForceVector) -> Value {
    let mut all = json!({ "declaration": force.declaration, "kind": force.kind.word(), "at": anchor_value(&force.at) });
    let (name, value) = match &force.value {
        ForceValue::Constant(force) => ("constant", json!(force)),
        ForceValue::Components(columns) => ("columns", json!(columns)),
        ForceValue::Along { column, frame, direction } => ("along", json!([column, frame, direction])),
        ForceValue::Apart { column, from, to } => ("apart", json!([column, anchor_value(from), anchor_value(to)])),
    };
    if let Some(object) = all.as_object_mut() {
        object.insert(name.to_owned(), value);
    }
    all
}

fn torque(Torque { declaration, kind, at, column, sign }: &Torque) -> Value {
    json!({ "declaration": declaration, "kind": kind.word(), "at": anchor_value(at), "column": column, "sign": sign })
}

fn node_value(node: &Node, decimals: usize) -> Value {
    let (name, attachment) = match &node.attachment {
        Attachment::Fixed(frame) => ("fixed", json!(frame)),
        Attachment::Upright(at) => ("upright", anchor_value(at)),
        Attachment::Between { from, to, alignment } => {
            let alignment = match alignment {
                Alignment::Start => "from",
                Alignment::End => "to",
                Alignment::Stretch => "stretched",
            };
            ("between", json!([anchor_value(from), anchor_value(to), alignment]))
        }
    };
    let shapes = node
        .shapes
        .iter()
        .map(|shape| json!({ "look": shape.look.word(), "d": path_data(&shape.path, 1.0, decimals) }));
    json!({ "declaration": node.declaration, name: attachment, "shapes": shapes.collect::<Vec<_>>() })
}

fn contact(contact: &Contact) -> Value {
    let Contact { declaration, cam, follower, .. } = contact;
    let (kind, touch) = match &contact.touch {
        Touch::Tip(at) => ("tip", json!(at)),
        Touch::Roller { centre, arms, argument } => {
            ("roller", json!({ "centre": centre, "arms": arms, "argument": argument }))
        }
        Touch::Face(at, along) => ("face", json!([at, along])),
    };
    json!({ "declaration": declaration, "cam": cam, "follower": follower, kind: touch })
}

fn trace(trace: &Trace) -> Value {
    match &trace.pen {
        Pen::Point(anchor) => json!({ "declaration": trace.declaration, "frame": anchor.frame, "at": anchor.at }),
        Pen::Columns { name, frame, pose, is_mirrored } => json!({
            "declaration": trace.declaration, "frame": frame, "columns": name,
            "pose": [pose.at[0], pose.at[1], pose.phi], "mirrored": is_mirrored,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::{changes, decimals, kept_rows};
    use serde_json::json;

    #[test]
    fn only_what_differs_is_told() {
        let from = json!({ "a": [1, [2, 3]], "b": { "c": "d" } });
        assert_eq!(changes(&from, &from), None);
        let to = json!({ "a": [1, [2, 4]], "b": { "c": "e" } });
        assert_eq!(changes(&from, &to), Some(json!({ "a": { "1": { "1": [4] } }, "b": { "c": ["e"] } })));
        let to = json!({ "a": [1], "b": { "c": "d", "f": null } });
        assert_eq!(changes(&from, &to), Some(json!({ "a": [[1]], "b": [{ "c": "d", "f": null }] })));
    }

    #[test]
    fn the_last_row_is_kept() {
        let kept = |rows, every| kept_rows(rows, every).collect::<Vec<_>>();
        assert_eq!(kept(7, 3), [0, 3, 6]);
        assert_eq!(kept(6, 3), [0, 3, 5]);
        assert_eq!(kept(3, 1), [0, 1, 2]);
        assert_eq!(kept(1, 5), [0]);
        assert!(kept(0, 2).is_empty());
    }

    #[test]
    fn shapes_have_six_digits_of_a_symbol() {
        for (unit, expected) in [(0.004, 8), (40.0, 4), (4e-8, 13), (1.0, 5)] {
            assert_eq!(decimals(unit), expected, "{unit}");
        }
    }
}
