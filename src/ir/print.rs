//! The constraint system as readable text.

use super::{ConstraintSystem, DeclarationKind, WatchKind};
use crate::expr::{ExprId, Printer, Symbol, number};

impl ConstraintSystem {
    /// A symbol as the result tables name it: `crank.phi`, `crank.phi.d`.
    #[must_use]
    pub fn symbol_name(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Param(k) => self.params[k as usize].name.clone(),
            Symbol::Time => "t".to_owned(),
            Symbol::Coordinate { index, order } => {
                let name = &self.coordinates[index as usize].name;
                if order == 0 { name.clone() } else { format!("{name}.{}", "d".repeat(order as usize)) }
            }
            Symbol::Named(k) => format!("named_{k}"),
        }
    }

    /// A row by the declaration that wrote it: `big`, or `big 2` where it wrote several.
    #[must_use]
    pub fn row_name(&self, row: usize) -> String {
        let declaration = self.rows[row].declaration;
        let name = &self.declarations[declaration].name;
        if self.declarations[declaration].rows == 1 {
            return name.clone();
        }
        let before = self.rows[..row].iter().rev().take_while(|other| other.declaration == declaration).count();
        format!("{name} {}", before + 1)
    }
}

/// Every coordinate, every row of `Φ` with the declaration that wrote it, the entries of `Φ_q`, `ν`, `γ`, the measures.
impl std::fmt::Display for ConstraintSystem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut printer = Printer::new(&self.graph, |symbol| self.symbol_name(symbol));
        let prefix = self.prefix_of_shared();
        let shared = printer.name_shared(&self.printed(), |k| format!("{prefix}{}", k + 1));
        writeln!(
            f,
            "constraint system of {}: {} coordinates, {} equations",
            self.name,
            self.coordinates.len(),
            self.rows.len()
        )?;
        if !self.params.is_empty() {
            section(f, "parameters", self.params.iter().map(|p| (p.name.clone(), format!("= {}", number(p.value)))))?;
        }
        if !shared.is_empty() {
            let title = "parts that stand in several places";
            section(
                f,
                title,
                shared.iter().map(|(name, id)| (name.clone(), format!("= {}", printer.definition(*id)))),
            )?;
        }
        section(
            f,
            "coordinates q, with their estimates",
            self.coordinates
                .iter()
                .map(|c| (c.name.clone(), format!("≈ {} {}", printer.text(c.estimate), c.kind.unit()))),
        )?;
        let row = |k: usize| self.row_name(k);
        let rows = 0..self.rows.len();
        section(
            f,
            "equations Φ = 0",
            rows.clone().map(|k| (row(k), format!("0 = {}", printer.text(self.rows[k].phi)))),
        )?;
        writeln!(f, "\nwritten by")?;
        for declaration in &self.declarations {
            let kind = match declaration.kind {
                DeclarationKind::Joint(word) => format!("joint, {word}"),
                other => other.noun().to_owned(),
            };
            writeln!(f, "  {}: {kind}", declaration.name)?;
        }
        let entries = rows.clone().flat_map(|k| {
            let entry = |&(column, id): &(u32, ExprId)| {
                let by = &self.coordinates[column as usize].name;
                (format!("{} by {by}", self.row_name(k)), format!("= {}", printer.text(id)))
            };
            self.phi_q.row(k).iter().map(entry).collect::<Vec<_>>()
        });
        section(f, "Jacobian Φ_q, entries that are not 0", entries)?;
        section(
            f,
            "velocity, right side ν of Φ_q q̇ = ν",
            rows.clone().map(|k| (row(k), format!("= {}", printer.text(self.nu[k])))),
        )?;
        let gamma = rows.clone().map(|k| (row(k), format!("= {}", printer.text(self.gamma[k]))));
        section(f, "acceleration, right side γ of Φ_q q̈ = γ", gamma)?;
        if let Some(jerk) = &self.jerk {
            let jerk = rows.map(|k| (row(k), format!("= {}", printer.text(jerk[k]))));
            section(f, "jerk, right side of Φ_q q⃛ = …", jerk)?;
        }
        if !self.measures.is_empty() {
            let lines = self.measures.iter().flat_map(|measure| {
                let parts = [("", Some(measure.value)), (".d", measure.first), (".dd", measure.second)];
                parts.into_iter().filter_map(|(end, id)| {
                    id.map(|id| (format!("{}{end}", measure.name), format!("= {}", printer.text(id))))
                })
            });
            section(f, "measures", lines)?;
        }
        if !self.conditions.is_empty() {
            let lines = self.conditions.iter().map(|c| (c.owner.clone(), format!("{} > 0", printer.text(c.positive))));
            section(f, "conditions", lines)?;
        }
        if !self.watches.is_empty() {
            let lines = self.watches.iter().map(|watch| {
                let rule = match watch.kind {
                    WatchKind::LineOfCenters => "> 0, along the line of centres",
                    WatchKind::Tangents => "keeps its sign: the tangents",
                    WatchKind::Curvature => "keeps its sign: the relative curvature",
                };
                let name = self.declarations[watch.declaration].name.clone();
                (name, format!("{} {rule}", printer.text(watch.value)))
            });
            section(f, "watched along the way", lines)?;
        }
        Ok(())
    }
}

impl ConstraintSystem {
    /// All that is printed, so that what it shares can be named.
    fn printed(&self) -> Vec<ExprId> {
        let mut roots: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        roots.extend(self.coordinates.iter().map(|coordinate| coordinate.estimate));
        roots.extend(self.conditions.iter().map(|condition| condition.positive));
        roots.extend(self.watches.iter().map(|watch| watch.value));
        roots.extend(self.phi_q.entries().iter().map(|&(_, id)| id));
        roots.extend(self.nu.iter().chain(&self.gamma).chain(self.jerk.iter().flatten()));
        roots.extend(self.measures.iter().flat_map(|m| [Some(m.value), m.first, m.second].into_iter().flatten()));
        roots
    }

    /// A letter for the names of shared parts that no parameter begins with.
    fn prefix_of_shared(&self) -> &'static str {
        let free = |prefix: &&str| !self.params.iter().any(|param| param.name.starts_with(*prefix));
        ["k", "e", "u", "w"].into_iter().find(free).unwrap_or("shared_")
    }
}

/// A title, and lines of two columns.
fn section(
    f: &mut std::fmt::Formatter<'_>,
    title: &str,
    lines: impl Iterator<Item = (String, String)>,
) -> std::fmt::Result {
    let lines: Vec<(String, String)> = lines.collect();
    let width = lines.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    writeln!(f, "\n{title}")?;
    for (name, text) in lines {
        writeln!(f, "  {name:<width$}  {text}")?;
    }
    Ok(())
}
