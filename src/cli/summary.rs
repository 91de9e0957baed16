//! The summary of a sweep: counts of variants by status, each with a command that runs the first of them.

use super::arguments::{Following, Input, Interval};
use mechc_engine::sweep::Status;
use std::collections::BTreeMap;

/// The variants that were written.
#[derive(Default)]
pub(super) struct Summary {
    /// Number of variants with each status, and the first of them.
    counts: BTreeMap<&'static str, (u64, u64)>,
    completed: u64,
    rows: u64,
    /// The completed variants without a value, for each result.
    without_value: Vec<MissingValues>,
}

/// The completed variants without a value of a result.
struct MissingValues {
    result: String,
    count: u64,
    first: u64,
}

impl Summary {
    /// Creates an empty summary for some results.
    pub fn new(results: Vec<String>) -> Summary {
        let missing = |result| MissingValues { result, count: 0, first: 0 };
        Summary { without_value: results.into_iter().map(missing).collect(), ..Summary::default() }
    }

    /// Adds, for each result, the number of variants of a block without a value, and the first of them.
    pub fn add_without_value(&mut self, missing: &[(u64, u64)]) {
        for (total, (more, variant)) in self.without_value.iter_mut().zip(missing) {
            total.first = if total.count == 0 { *variant } else { total.first };
            total.count += more;
        }
    }

    /// Adds the variants of a block, with its number of rows.
    pub fn add(&mut self, first: u64, statuses: &[Status], rows: usize) {
        for (status, variant) in statuses.iter().zip(first..) {
            self.counts.entry(status.as_str()).or_insert((0, variant)).0 += 1;
            self.completed += u64::from(status.is_complete());
        }
        self.rows += rows as u64;
    }

    /// Returns the number of variants.
    pub fn count(&self) -> u64 {
        self.counts.values().map(|(count, _)| count).sum()
    }

    /// Returns the number of variants that ran to their end.
    pub fn completed(&self) -> u64 {
        self.completed
    }

    /// Formats a line for all variants, one for each status but `ok`, and one for each result with missing values.
    pub fn text(&self, command: &dyn Fn(u64) -> String) -> String {
        let of = |status: Status| self.counts.get(status.as_str()).map_or(0, |(count, _)| *count);
        let (ok, reassembled) = (of(Status::Ok), of(Status::Reassembled));
        let mut parts = vec![format!("{ok} ok")];
        let stopped = self.count() - ok - reassembled;
        parts.extend((reassembled > 0).then(|| format!("{reassembled} reassembled")));
        parts.extend((stopped > 0).then(|| format!("{stopped} stopped")));
        let rows = if self.rows > 0 { format!("; {} rows", self.rows) } else { String::new() };
        let mut text = format!("{}{rows}\n", parts.join(", "));
        let which = |count: u64, first: u64| {
            let which = if count == 1 { "variant" } else { "the first is variant" };
            format!("{which} {first}: {}", command(first))
        };
        for (status, &(count, first)) in self.counts.iter().filter(|(status, _)| **status != Status::Ok.as_str()) {
            text += &format!("  {status:<11} {count:>8}, {}\n", which(count, first));
        }
        for MissingValues { result, count, first } in self.without_value.iter().filter(|missing| missing.count > 0) {
            text += &format!("  no value of `{result}` in {count}, {}\n", which(*count, *first));
        }
        text
    }
}

/// The options of a command that runs a single variant, without the settings of the variant.
pub(super) struct VariantCommand<'a> {
    pub input: &'a Input,
    pub interval: &'a Interval,
    pub at: &'a [String],
    pub result: &'a [String],
    pub following: &'a Following,
}

impl VariantCommand<'_> {
    /// Formats the command that runs a variant.
    pub fn format(&self, settings: &[String]) -> String {
        let VariantCommand { input, interval, at, result, following } = self;
        // a name that begins with `-` would be read as an option
        let is_like_an_option = input.file.starts_with('-') && input.file != "-";
        let file = if is_like_an_option { format!("./{}", input.file) } else { input.file.clone() };
        let mut words = vec!["mechc".to_owned(), "run".to_owned(), file, "--lead".to_owned()];
        let mut add = |option: &str, value: &str| words.extend([option.to_owned(), value.to_owned()]);
        input.mechanism.iter().for_each(|name| add("--mechanism", name));
        input.set.iter().chain(settings).for_each(|set| add("--set", set));
        input.signals.iter().for_each(|signal| add("--input", signal));
        input.samples.iter().for_each(|file| add("--samples", &file.to_string_lossy()));
        let times = [("--from", &interval.from), ("--to", &interval.to), ("--every", &interval.every)];
        for (option, time) in times.iter().filter_map(|(option, time)| Some((option, time.as_ref()?))) {
            add(option, time);
        }
        at.iter().for_each(|time| add("--at", time));
        result.iter().for_each(|result| add("--result", result));
        if following.tolerance.to_bits() != mechc_pipeline::RunOptions::default().tolerance.to_bits() {
            add("--tolerance", &following.tolerance.to_string());
        }
        let flags =
            [("--allow-redundant", following.allow_redundant), ("--pass-bifurcations", following.pass_bifurcations)];
        words.extend(flags.into_iter().filter(|(_, is_set)| *is_set).map(|(flag, _)| flag.to_owned()));
        words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }
}

/// Quotes a word for a shell.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::{Summary, quoted};
    use mechc_engine::sweep::Status;
    use mechc_text::diag::Code;

    #[test]
    fn statuses_are_counted_with_the_first_of_each() {
        let mut summary = Summary::default();
        summary.add(10, &[Status::Ok, Status::Stopped(Code::E0602)], 5);
        summary.add(12, &[Status::Reassembled, Status::Stopped(Code::E0602), Status::Ok], 0);
        assert_eq!((summary.count(), summary.completed()), (5, 3));
        let text = summary.text(&|variant| format!("see {variant}"));
        let expected = "2 ok, 1 reassembled, 2 stopped; 5 rows\n  E0602              2, the first is variant 11: see 11\n  reassembled        1, variant 12: see 12\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn results_without_a_value_are_counted() {
        let mut summary = Summary::new(vec!["a".to_owned(), "b".to_owned()]);
        summary.add(0, &[Status::Ok; 4], 0);
        summary.add_without_value(&[(0, 0), (2, 1)]);
        summary.add_without_value(&[(0, 0), (1, 3)]);
        let expected = "4 ok\n  no value of `b` in 3, the first is variant 1: see 1\n";
        assert_eq!(summary.text(&|variant| format!("see {variant}")), expected);
    }

    #[test]
    fn words_are_quoted_for_a_shell() {
        for (word, expected) in [("rod=0.1", "rod=0.1"), ("rod=0.1 m", "'rod=0.1 m'"), ("", "''"), ("a'b", r"'a'\''b'")]
        {
            assert_eq!(quoted(word), expected);
        }
    }
}
