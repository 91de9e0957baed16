//! Indices of coordinates, equations, bodies and measures.

use super::Writer;
use crate::names::Case;
use crate::print::{Head, Page};
use crate::text::unit;
use mechc_ir::{Measure, Units};

impl Writer<'_> {
    pub fn indices(&self, page: &mut Page) {
        let system = self.unit.system;
        let (n, entries) = (system.coordinates().len(), system.phi_q().entries().len());
        page.constant("Number of coordinates, and of equations.", "pub const N: usize", &n.to_string());
        let docs = "Number of entries of `phi_q` that do not vanish.";
        page.constant(docs, "pub const ENTRIES: usize", &entries.to_string());
        page.constant("Coordinates (m, rad).", "pub type Q", "[f64; N]");
        page.constant("Velocities (m/s, rad/s).", "pub type Qd", "[f64; N]");
        page.constant("Accelerations (m/s^2, rad/s^2).", "pub type Qdd", "[f64; N]");
        let names = Case::Constant.names(system.coordinates().iter().map(|coordinate| coordinate.name.as_str()));
        let coordinates = system.coordinates().iter().enumerate().map(|(k, coordinate)| {
            format!("`{}` ({}){}", coordinate.name, unit(coordinate.kind.unit()), self.line(system.owner_span(k)))
        });
        numbered(page, "Where each coordinate stands in `q`.", "coordinate", coordinates.zip(&names));
        let rows: Vec<String> = (0..system.rows().len()).map(|k| system.row_name(k)).collect();
        let names = Case::Constant.names(rows.iter().map(String::as_str));
        let equations = rows.iter().enumerate().map(|(k, row)| {
            let declaration = system.declaration_of(k);
            let of = system.rows()[k].unit.display_unit();
            format!("{} `{row}` ({}){}", declaration.kind.noun(), unit(&of), self.line(declaration.span))
        });
        numbered(
            page,
            "Which equation each joint, constraint or driver wrote, and its unit.",
            "row",
            equations.zip(&names),
        );
        self.pattern("pub ", "Row and column of each value that [`phi_q`] gives.", page);
        self.bodies(page);
        self.measure_indices(page);
        self.force_indices(page);
    }

    /// Prints the sparsity pattern of the Jacobian.
    pub fn pattern(&self, visibility: &str, docs: &str, page: &mut Page) {
        let system = self.unit.system;
        page.docs(docs);
        page.line("#[rustfmt::skip]");
        page.line(&format!("{visibility}static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = ["));
        for row in 0..system.rows().len() {
            for (column, _) in system.phi_q().row(row) {
                page.line(&format!("    ({row}, {column}),"));
            }
        }
        page.line("];\n");
    }

    /// Prints the indices of bodies, and the function for their poses.
    fn bodies(&self, page: &mut Page) {
        let system = self.unit.system;
        if system.bodies().is_empty() {
            return;
        }
        let names = Case::Camel.names(system.bodies().iter().map(|body| body.name.as_str()));
        page.docs("The bodies.");
        page.line("#[derive(Clone, Copy, Debug, PartialEq, Eq)]");
        page.item("pub enum Body", |page| {
            for (body, name) in system.bodies().iter().zip(&names) {
                page.docs(&format!("`{}`{}", body.name, self.line(body.span)));
                page.line(&format!("{name},"));
            }
        });
        page.docs("Where a body is, or how its place changes.");
        page.line("#[derive(Clone, Copy, Debug, PartialEq)]");
        page.item("pub struct Pose", |page| {
            for (unit, name) in [("m", "x"), ("m", "y"), ("rad", "phi")] {
                page.docs(&format!("({unit})"));
                page.line(&format!("pub {name}: f64,"));
            }
        });
        page.item("impl Pose", |page| {
            page.docs("That of a body, out of the coordinates or their derivatives.");
            page.line("#[rustfmt::skip]\n#[must_use]");
            let of = [("q", "&[f64; N]"), ("body", "Body")];
            let head = Head { kind: "pub fn", name: "of", arguments: &of, result: "Self" };
            page.function(&head, |page| {
                page.block("match body", |page| {
                    for ((id, _), name) in system.bodies().pairs().zip(&names) {
                        let [x, y, phi] = system.pose_of(id);
                        page.line(&format!("Body::{name} => Self {{ x: q[{x}], y: q[{y}], phi: q[{phi}] }},"));
                    }
                });
            });
        });
    }

    fn measure_indices(&self, page: &mut Page) {
        let measures = self.unit.system.measures();
        if measures.is_empty() {
            return;
        }
        let having = |has: fn(&Measure) -> bool| measures.iter().filter(|m| has(m)).collect::<Vec<&Measure>>();
        let kinds = [
            ("measure", "Where each measure stands among the values, all in SI.", "MEASURES", having(|_| true)),
            (
                "measure_rate",
                "Where the first time derivative of each measure that has one stands among the rates.",
                "RATES",
                having(|m| m.first.is_some()),
            ),
            (
                "measure_acceleration",
                "Where the second time derivative of each measure that has one stands among the accelerations.",
                "ACCELERATIONS",
                having(|m| m.second.is_some()),
            ),
        ];
        for (module, docs, count, list) in kinds {
            let names = Case::Constant.names(list.iter().map(|measure| measure.name.as_str()));
            let descriptions =
                |measure: &&Measure| format!("`{}`{}{}", measure.name, in_si(measure), self.line(measure.span));
            numbered(page, docs, module, list.iter().map(descriptions).zip(&names));
            page.constant("How many they are.", &format!("pub const {count}: usize"), &list.len().to_string());
        }
        page.docs("The measures with their time derivatives; `NAN` where one has no value.");
        page.line("#[derive(Clone, Copy, Debug, PartialEq)]");
        page.item("pub struct Measures", |page| {
            page.docs("By the indices in [`measure`].");
            page.line("pub values: [f64; MEASURES],");
            page.docs("First time derivatives, by the indices in [`measure_rate`].");
            page.line("pub rates: [f64; RATES],");
            page.docs("Second time derivatives, by the indices in [`measure_acceleration`].");
            page.line("pub accelerations: [f64; ACCELERATIONS],");
        });
    }
}

/// Prints a module of named indices, given documentation and name of each.
pub(super) fn numbered<'n>(page: &mut Page, docs: &str, module: &str, all: impl Iterator<Item = (String, &'n String)>) {
    page.docs(docs);
    let mut all = all.enumerate().peekable();
    if all.peek().is_none() {
        return page.line(&format!("pub mod {module} {{}}\n"));
    }
    page.item(&format!("pub mod {module}"), |page| {
        for (k, (docs, name)) in all {
            page.docs(&docs);
            page.line(&format!("pub const {name}: usize = {k};"));
        }
    });
}

/// Returns a note for a measure that tables print in another unit.
fn in_si(measure: &Measure) -> String {
    let Units { si, printed: [printed, ..], .. } = &measure.units;
    let unit = if si == "1" { "as a pure number".to_owned() } else { format!("in {si}") };
    if si == printed { String::new() } else { format!(", {unit}; tables have it in {printed}") }
}
