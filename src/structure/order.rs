//! The order of solution in words: which bodies follow from which equations, and which are solved for together.

use super::Determined;

/// Longer orders are cut.
const LONGEST: usize = 40;

/// A line for each body or group of bodies: `crank  from main, motor`, `rod, slider  together, from big, small, guide`.
#[must_use]
pub fn order_of_solution(determined: &Determined) -> String {
    let system = determined.system();
    // those that are solved for, the declarations, whether together
    let mut steps: Vec<(Vec<&str>, Vec<&str>, bool)> = Vec::new();
    for block in determined.blocks() {
        let mut owners: Vec<usize> = block.columns.iter().map(|&column| column as usize).collect();
        owners.sort_unstable();
        let mut names: Vec<&str> = owners.into_iter().map(|column| system.owner_name(column)).collect();
        names.dedup();
        let mut equations: Vec<usize> = block.rows.iter().map(|&row| system.rows[row as usize].declaration).collect();
        equations.sort_unstable();
        equations.dedup();
        let equations: Vec<&str> = equations.into_iter().map(|k| system.declarations[k].name.as_str()).collect();
        match steps.iter_mut().find(|(known, _, together)| *known == names && !*together && block.rows.len() == 1) {
            Some((_, from, _)) => {
                for equation in equations {
                    if !from.contains(&equation) {
                        from.push(equation);
                    }
                }
            }
            None => steps.push((names, equations, block.rows.len() > 1)),
        }
    }
    let left_out = steps.len().saturating_sub(LONGEST);
    steps.truncate(LONGEST);
    let heads: Vec<String> = steps.iter().map(|(names, ..)| names.join(", ")).collect();
    let width = heads.iter().map(|head| head.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for (head, (names, equations, together)) in heads.iter().zip(&steps) {
        let how = if *together && names.len() > 1 { "together, from" } else { "from" };
        text += &format!("  {head:<width$}  {how} {}\n", equations.join(", "));
    }
    if left_out > 0 {
        text += &format!("  … {left_out} more\n");
    }
    text
}
