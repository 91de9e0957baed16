//! The constraint system as data for other programs: one JSON object, every formula as text in the language's own syntax.
//!
//! `docs/emit-json.md` is the contract. A formula shares its parts and a text does not, so large parts that stand in several
//! places are listed once as `terms`, and the size of the whole stays that of the expression graph.

use super::not_written;
use mechc_expr::{ExprId, Printer, Symbol, Table};
use mechc_ir::{
    ConditionKind, ConstraintSystem, CoordinateKind, DeclarationKind, Mechanics, MonitorKind, Owner, SparseRows,
};
use mechc_text::source::{Sources, Span};
use serde_json::{Value, json};

/// Version of the layout. It increases with every change that breaks readers of the previous layout.
const LAYOUT: u32 = 1;

/// Returns the system as one JSON object.
///
/// `file` is the name of the source, and `sources` has the text that the system's places lie in.
#[must_use]
pub fn json(
    system: &ConstraintSystem,
    mechanics: Option<&Mechanics>,
    is_determined: bool,
    sources: &Sources,
    file: &str,
) -> String {
    let prefix = prefix_of_terms(system);
    let mut printer = Printer::new(system.graph(), |symbol| match symbol {
        Symbol::Multiplier(row) => format!("lambda[{row}]"),
        symbol => system.symbol_name(symbol),
    });
    let terms = printer.name_shared(&roots(system, mechanics), |k| format!("{prefix}{}", k + 1));
    let terms = terms.iter().map(|(name, id)| json!({ "name": name, "value": printer.definition(*id) })).collect();
    let writer = Writer { system, sources, text: &|id| printer.text(id) };
    let mut object = Object::new();
    object.field("layout", &json!(LAYOUT));
    object.field("mechc", &json!(env!("CARGO_PKG_VERSION")));
    object.field("mechanism", &json!(system.name()));
    object.field("file", &json!(file));
    if !is_determined {
        object.field("determined", &json!(false));
    }
    object.field("analysis", &writer.analysis());
    object.list("params", writer.params());
    if !system.inputs().is_empty() {
        object.list("inputs", writer.inputs());
    }
    object.list("tables", writer.tables());
    object.list("bodies", writer.bodies());
    object.list("coordinates", writer.coordinates());
    object.list("declarations", writer.declarations());
    object.list("terms", terms);
    object.list("rows", writer.rows());
    object.list("phi_q", writer.entries(system.phi_q()));
    object.list("nu", writer.texts(system.nu()));
    object.list("gamma", writer.texts(system.gamma()));
    if let Some(Mechanics { mass_matrix, applied }) = mechanics {
        object.list("mass_matrix", writer.entries(mass_matrix));
        object.list("applied", writer.texts(applied));
        object.list("reactions", writer.reactions());
    }
    object.list("measures", writer.measures());
    object.list("conditions", writer.conditions());
    object.list("watches", writer.watches());
    object.list("left_out", writer.left_out());
    object.finish()
}

/// Returns all formulas that are emitted.
fn roots(system: &ConstraintSystem, mechanics: Option<&Mechanics>) -> Vec<ExprId> {
    let mut roots: Vec<ExprId> = system.rows().iter().map(|row| row.phi).collect();
    roots.extend(system.phi_q().entries().iter().map(|&(_, id)| id));
    roots.extend(system.nu().iter().chain(system.gamma()));
    roots.extend(system.coordinates().iter().map(|coordinate| coordinate.estimate));
    roots.extend(system.inputs().iter().flat_map(|input| input.formulas));
    let measures = system.measures().iter().flat_map(|of| [Some(of.value), of.first, of.second].into_iter().flatten());
    roots.extend(measures.filter(|&id| not_written(system, id).is_none()));
    if let Some(Mechanics { mass_matrix, applied }) = mechanics {
        roots.extend(mass_matrix.entries().iter().map(|&(_, id)| id).chain(applied.iter().copied()));
        roots.extend(system.reactions().iter().map(|of| of.value));
    }
    roots.extend(system.conditions().iter().map(|condition| condition.positive));
    roots.extend(system.monitors().iter().map(|watch| watch.value));
    roots.extend(system.checks().iter().map(|check| check.phi));
    roots.extend(system.graph().tables().iter().flat_map(|table| table.cells().chain(table.values.iter().copied())));
    roots
}

/// Returns a prefix for the names of terms with which no parameter and no table begins.
fn prefix_of_terms(system: &ConstraintSystem) -> String {
    let tables = system.graph().tables().iter().map(|table| &table.name);
    let names: Vec<&String> = system.params().iter().map(|param| &param.name).chain(tables).collect();
    let mut prefix = "k".to_owned();
    while names.iter().any(|name| name.starts_with(&prefix)) {
        prefix.push('_');
    }
    prefix
}

struct Writer<'s> {
    system: &'s ConstraintSystem,
    sources: &'s Sources,
    text: &'s dyn Fn(ExprId) -> String,
}

impl Writer<'_> {
    fn texts(&self, list: &[ExprId]) -> Vec<Value> {
        list.iter().map(|&id| Value::String((self.text)(id))).collect()
    }

    /// Returns the line of a span's start, from 1.
    fn line(&self, span: Span) -> usize {
        self.sources.get(span.file).position(span.start).0
    }

    fn analysis(&self) -> Value {
        self.system
            .analysis()
            .map_or(Value::Null, |[from, to, every]| json!({ "from": from, "to": to, "every": every }))
    }

    fn params(&self) -> Vec<Value> {
        let params = self.system.params().iter();
        params.map(|param| json!({ "name": param.name, "value": param.value, "unit": param.unit() })).collect()
    }

    fn inputs(&self) -> Vec<Value> {
        let inputs = self.system.inputs().iter().map(|input| {
            let [value, rate, acceleration] = input.formulas.map(|id| (self.text)(id));
            json!({
                "name": input.name,
                "line": self.line(input.span),
                "unit": input.unit(),
                "value": value,
                "rate": rate,
                "acceleration": acceleration,
            })
        });
        inputs.collect()
    }

    fn tables(&self) -> Vec<Value> {
        let table = |table: &Table| {
            json!({
                "name": table.name,
                "periodic": table.periodic,
                "knots": self.texts(&table.knots),
                "values": self.texts(&table.values),
                "coefficients": table.coefficients.iter().map(|list| self.texts(list)).collect::<Vec<_>>(),
            })
        };
        self.system.graph().tables().iter().map(table).collect()
    }

    fn bodies(&self) -> Vec<Value> {
        let bodies = self.system.bodies().iter();
        bodies.map(|body| json!({ "name": body.name, "line": self.line(body.span) })).collect()
    }

    fn coordinates(&self) -> Vec<Value> {
        let coordinates = self.system.coordinates().iter().map(|coordinate| {
            let kind = match coordinate.kind {
                CoordinateKind::Length => "length",
                CoordinateKind::Angle => "angle",
                CoordinateKind::Argument => "argument",
            };
            let unit = Some(coordinate.kind.unit()).filter(|unit| !unit.is_empty()).unwrap_or("1");
            let owner = match coordinate.owner {
                Owner::Body(body) => json!({ "body": body.index() }),
                Owner::Joint(joint) => json!({ "declaration": joint.index() }),
            };
            json!({
                "name": coordinate.name,
                "owner": owner,
                "kind": kind,
                "unit": unit,
                "scale": coordinate.scale,
                "estimate": (self.text)(coordinate.estimate),
            })
        });
        coordinates.collect()
    }

    fn declarations(&self) -> Vec<Value> {
        let declarations = self.system.declarations().iter().map(|declaration| {
            let joint = match declaration.kind {
                DeclarationKind::Joint(kind) => Some(kind.name()),
                DeclarationKind::Constraint | DeclarationKind::Driver => None,
            };
            json!({
                "name": declaration.name,
                "kind": declaration.kind.noun(),
                "joint": joint,
                "rows": declaration.rows,
                "line": self.line(declaration.span),
            })
        });
        declarations.collect()
    }

    fn left_out(&self) -> Vec<Value> {
        let checks = self.system.checks().iter();
        let left_out = checks.map(|check| {
            json!({
                "declaration": check.declaration.index(),
                "unit": check.unit.display_unit(),
                "phi": (self.text)(check.phi),
            })
        });
        left_out.collect()
    }

    fn rows(&self) -> Vec<Value> {
        let rows = self.system.rows().iter().enumerate().map(|(k, row)| {
            json!({
                "name": self.system.row_name(k),
                "declaration": row.declaration.index(),
                "unit": row.unit.display_unit(),
                "phi": (self.text)(row.phi),
            })
        });
        rows.collect()
    }

    /// Returns the nonzero entries of a matrix.
    fn entries(&self, matrix: &SparseRows) -> Vec<Value> {
        let entries = (0..matrix.rows()).flat_map(|row| {
            let entries = matrix.row(row).iter();
            entries.map(move |&(column, id)| json!({ "row": row, "column": column, "value": (self.text)(id) }))
        });
        entries.collect()
    }

    fn reactions(&self) -> Vec<Value> {
        let reactions = self.system.reactions().iter();
        let reactions = reactions.map(|of| {
            json!({ "name": of.name, "line": self.line(of.span), "unit": of.unit, "value": (self.text)(of.value) })
        });
        reactions.collect()
    }

    fn measures(&self) -> Vec<Value> {
        let text = |id: ExprId| not_written(self.system, id).is_none().then(|| (self.text)(id));
        let measures = self.system.measures().iter().map(|measure| {
            let mut object = json!({
                "name": measure.name,
                "line": self.line(measure.span),
                "unit": measure.units.si,
                "value": text(measure.value),
                "first": measure.first.and_then(text),
                "second": measure.second.and_then(text),
            });
            if let (Some(reason), Some(fields)) = (not_written(self.system, measure.value), object.as_object_mut()) {
                fields.insert("reason".to_owned(), json!(reason));
            }
            object
        });
        measures.collect()
    }

    fn conditions(&self) -> Vec<Value> {
        let conditions = self.system.conditions().iter().map(|condition| {
            let (kind, table) = match condition.kind {
                ConditionKind::Distance => ("distance", None),
                ConditionKind::Interval => ("interval", None),
                ConditionKind::Range(table) | ConditionKind::Samples(table) => {
                    ("range", Some(&self.system.graph().tables()[table.index()].name))
                }
            };
            json!({
                "owner": condition.owner,
                "kind": kind,
                "table": table,
                "positive": (self.text)(condition.positive),
            })
        });
        conditions.collect()
    }

    fn watches(&self) -> Vec<Value> {
        let watches = self.system.monitors().iter().map(|watch| {
            let kind = match watch.kind {
                MonitorKind::LineOfCenters => "line_of_centers",
                MonitorKind::Tangents => "tangents",
                MonitorKind::Curvature => "curvature",
            };
            json!({ "declaration": watch.declaration.index(), "kind": kind, "value": (self.text)(watch.value) })
        });
        watches.collect()
    }
}

/// Builder of a JSON object with a line for each field and for each item of a list.
struct Object {
    text: String,
}

impl Object {
    fn new() -> Object {
        Object { text: "{".to_owned() }
    }

    fn key(&mut self, key: &str) {
        let comma = if self.text.ends_with('{') { "" } else { "," };
        self.text += &format!("{comma}\n  \"{key}\": ");
    }

    fn field(&mut self, key: &str, value: &Value) {
        self.key(key);
        self.text += &value.to_string();
    }

    fn list(&mut self, key: &str, items: Vec<Value>) {
        self.key(key);
        self.text.push('[');
        let is_empty = items.is_empty();
        for (k, item) in items.into_iter().enumerate() {
            let comma = if k == 0 { "" } else { "," };
            self.text += &format!("{comma}\n    {item}");
        }
        self.text += if is_empty { "]" } else { "\n  ]" };
    }

    fn finish(self) -> String {
        self.text + "\n}\n"
    }
}
