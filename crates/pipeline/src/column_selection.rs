//! Selection of columns by patterns of their names.

use crate::Compiled;
use mechc_text::diag::{Code, Diagnostic, Error, nearest};
use wildmatch::WildMatch;

impl Compiled {
    /// Returns the indices of the columns that match any pattern, in which `*` matches any text and `?` one character; the first column, the time,
    /// is always included. Returns all columns if there is no pattern.
    ///
    /// # Errors
    /// No column matches one of them.
    pub fn select_columns(&self, patterns: &[String]) -> Result<Vec<usize>, Error> {
        select_columns(patterns, &self.columns())
    }
}

fn select_columns(patterns: &[String], columns: &[String]) -> Result<Vec<usize>, Error> {
    if patterns.is_empty() {
        return Ok((0..columns.len()).collect());
    }
    let mut is_selected = vec![false; columns.len()];
    is_selected[0] = true;
    for pattern in patterns {
        let pattern_match = WildMatch::new(pattern.trim());
        let mut has_match = false;
        for (selected, _) in is_selected.iter_mut().zip(columns).filter(|(_, column)| pattern_match.matches(column)) {
            *selected = true;
            has_match = true;
        }
        if !has_match {
            let diagnostic = Diagnostic::new(Code::E0706, format!("there is no column `{}`", pattern.trim()));
            let parts: Vec<&str> = pattern.split(',').map(str::trim).collect();
            let is_there = |part: &&str| columns.iter().any(|column| WildMatch::new(part).matches(column));
            if parts.len() > 1 && parts.iter().all(is_there) {
                let repeated: Vec<String> = parts.iter().map(|part| format!("--columns '{part}'")).collect();
                return Err(diagnostic.help(format!("repeat the option: `{}`", repeated.join(" "))).into());
            }
            let suggestion = nearest(pattern.trim(), columns.iter().map(String::as_str));
            let help = match suggestion {
                Some(name) => format!("was `{name}` meant?"),
                None if names_reaction(pattern) => "forces have columns with `--reactions`".to_owned(),
                None => "`*` stands for anything, `?` for one character, as in `--columns 'rod.*'`".to_owned(),
            };
            return Err(diagnostic.help(help).into());
        }
    }
    Ok((0..columns.len()).filter(|&k| is_selected[k]).collect())
}

/// Returns whether a pattern ends as the columns of reactions and efforts do.
fn names_reaction(pattern: &str) -> bool {
    [".fx", ".fy", ".torque", ".effort"].iter().any(|ending| pattern.trim().ends_with(ending))
}

#[cfg(test)]
mod tests {
    use super::select_columns;

    #[test]
    fn patterns_select_by_name() {
        let columns = ["t", "rod.x", "rod.x.d", "leg[1].x", "leg[2].x"].map(str::to_owned);
        let select = |patterns: &[&str]| {
            select_columns(&patterns.iter().map(|&pattern| pattern.to_owned()).collect::<Vec<_>>(), &columns).ok()
        };
        let why = select_columns(&["rod.x,leg[1].x".to_owned()], &columns).expect_err("one pattern is one name");
        assert_eq!(
            why.first().expect("an error").help,
            ["repeat the option: `--columns 'rod.x' --columns 'leg[1].x'`"]
        );
        assert_eq!(select(&[]), Some(vec![0, 1, 2, 3, 4]));
        assert_eq!(select(&["rod.x"]), Some(vec![0, 1]));
        assert_eq!(select(&["rod.*", "t"]), Some(vec![0, 1, 2]));
        assert_eq!(select(&["leg[?].x"]), Some(vec![0, 3, 4]));
        assert_eq!(select(&["leg[2].x", "rod.x"]), Some(vec![0, 1, 4]), "in the order of the table");
        assert_eq!(select(&["rod.y"]), None);
        let why = select_columns(&["main.fx".to_owned()], &columns).expect_err("no such column");
        assert_eq!(why.first().expect("an error").help, ["forces have columns with `--reactions`"]);
        assert_eq!(select(&[""]), None);
    }
}
