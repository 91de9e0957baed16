//! Structures of the parameters that users can set.

use super::Writer;
use crate::params::{FieldType, Params};
use crate::print::{Head, Page};
use crate::text::{literal, one_line};

/// Head of the method that interpolates between two sets of parameters.
const TOWARDS: Head<'_> = Head {
    kind: "fn",
    name: "towards",
    arguments: &[("&self", ""), ("other", "&Self"), ("part", "f64")],
    result: "Self",
};

impl Writer<'_> {
    pub fn parameters(&self, page: &mut Page) {
        let system = self.unit.system;
        if system.params().is_empty() {
            return self.no_parameters(page);
        }
        let params = Params::new(system);
        self.types_of_params(&params, page);
        page.item("impl Default for Params", |page| {
            page.line("#[rustfmt::skip]");
            page.block("fn default() -> Self", |page| {
                page.text(&params.value("Self", "", &|param| literal(system.params()[param].value)));
            });
        });
        let fields: Vec<String> = self.names.params.iter().map(|name| format!("self.{name}")).collect();
        if self.unit.motion.is_some() {
            self.requires("state", "Parameters");
            page.item("impl Parameters for Params", |page| {
                page.line("#[rustfmt::skip]");
                page.function(&TOWARDS, |page| {
                    page.text(&params.value("Self", "", &|param| {
                        let path = &params.paths[param];
                        format!("self.{path} + part * (other.{path} - self.{path})")
                    }));
                });
                page.line("#[rustfmt::skip]");
                page.block("fn is_finite(&self) -> bool", |page| {
                    page.list("let all = [", &fields, "];");
                    page.line("all.into_iter().all(f64::is_finite)");
                });
            });
        }
    }

    /// Prints the attribute for C layout if C accesses the structure.
    fn as_in_c(&self, page: &mut Page) {
        if self.unit.for_c {
            page.line("#[repr(C)]");
        }
    }

    fn no_parameters(&self, page: &mut Page) {
        page.docs("The mechanism has no parameters.");
        page.line("#[derive(Clone, Copy, Debug, Default, PartialEq)]");
        page.line("pub struct Params;\n");
        if self.unit.motion.is_some() {
            self.requires("state", "Parameters");
            page.item("impl Parameters for Params", |page| {
                let head = Head { arguments: &[("&self", ""), ("_", "&Self"), ("_", "f64")], ..TOWARDS };
                page.function(&head, |page| page.line("Self"));
                page.block("fn is_finite(&self) -> bool", |page| page.line("true"));
            });
        }
    }

    /// Prints the structures of the parameters.
    fn types_of_params(&self, params: &Params, page: &mut Page) {
        for of in &params.types {
            page.docs(&if of.source.is_empty() {
                "The parameters, in SI; those of the file by default.".to_owned()
            } else {
                format!("The parameters of a part, as `{}`, in SI.", of.source)
            });
            page.line("#[derive(Clone, Copy, Debug, PartialEq)]");
            self.as_in_c(page);
            page.item(&format!("pub struct {}", of.name), |page| {
                for field in &of.fields {
                    let (source, name) = (one_line(&field.source), &field.name);
                    let (docs, of) = match &field.kind {
                        FieldType::Number(param) => {
                            let param = &self.unit.system.params()[*param];
                            (format!("`{source}` ({}){}", param.unit(), self.line(param.span)), "f64".to_owned())
                        }
                        FieldType::Part(part) => (format!("Those of `{source}`."), params.types[*part].name.clone()),
                        FieldType::Copies(part, lengths) => {
                            let inner = params.types[*part].name.clone();
                            let array = lengths.iter().rev().fold(inner, |of, length| format!("[{of}; {length}]"));
                            (format!("Those of `{source}`, by its numbers."), array)
                        }
                    };
                    page.docs(&docs);
                    page.line(&format!("pub {name}: {of},"));
                }
            });
        }
    }
}
