//! "Did you mean": the nearest name in scope.

/// Returns the name that `wanted` most probably stands for.
///
/// It has at most one mistake per three characters, rounded up; a name that differs only in case always qualifies.
#[must_use]
pub fn nearest<'a>(misspelled: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = misspelled.to_lowercase();
    let limit = misspelled.chars().count().div_ceil(3);
    names
        .into_iter()
        .filter(|name| *name != misspelled)
        .map(|name| {
            let differs_in_case = name.to_lowercase() == lower;
            let distance = if differs_in_case { 0 } else { strsim::damerau_levenshtein(misspelled, name) };
            (distance, name)
        })
        // a replacement of every letter proves nothing
        .filter(|&(distance, name)| distance <= limit && (distance == 0 || distance < name.chars().count()))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn offers_what_a_typist_meant() {
        let names = ["crank", "rod", "slider"];
        assert_eq!(nearest("crnak", names), Some("crank"));
        assert_eq!(nearest("ROD", names), Some("rod"));
        assert_eq!(nearest("piston", names), None);
        assert_eq!(nearest("q", ["p"]), None);
    }
}
