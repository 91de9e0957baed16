//! The equations of one declaration, as readable text.

use super::ConstraintSystem;
use mechc_expr::{ExprId, Printer};

impl ConstraintSystem {
    /// The rows of `Φ` that a joint, constraint or driver wrote, with their `ν` and `γ`, and the parts that stand in several places; a line
    /// each. Nothing where no declaration of that name wrote any.
    #[must_use]
    pub fn equations_of(&self, name: &str) -> Option<String> {
        let declaration = self.declarations.find(|declaration| declaration.name == name)?;
        let rows: Vec<usize> = (0..self.rows.len()).filter(|&row| self.rows[row].declaration == declaration).collect();
        let of = |list: &[ExprId]| rows.iter().map(|&row| list[row]).collect::<Vec<ExprId>>();
        let phi: Vec<ExprId> = rows.iter().map(|&row| self.rows[row].phi).collect();
        let columns = [("Φ", phi), ("ν", of(self.nu())), ("γ", of(self.gamma()))];
        let mut printer = Printer::new(&self.graph, |symbol| self.symbol_name(symbol));
        let roots: Vec<ExprId> = columns.iter().flat_map(|(_, list)| list.iter().copied()).collect();
        let prefix = self.prefix_of_shared();
        let shared = printer.name_shared(&roots, |k| format!("{prefix}{}", k + 1));
        let mut lines: Vec<String> = Vec::new();
        for (letter, list) in &columns {
            for (k, &id) in list.iter().enumerate() {
                let number = if list.len() > 1 { (k + 1).to_string() } else { String::new() };
                lines.push(format!("{letter}{number} = {}", printer.text(id)));
            }
        }
        lines.extend(shared.iter().map(|(name, id)| format!("{name} = {}", printer.definition(*id))));
        (!rows.is_empty()).then(|| lines.join("\n"))
    }
}
