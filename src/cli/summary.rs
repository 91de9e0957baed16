//! What became of the variants of a sweep, counted, with the first of each kind as a command that shows it in full.

use super::arguments::{Following, Input, Interval};
use mechc_engine::sweep::Status;
use std::collections::BTreeMap;

/// The variants that were written.
#[derive(Default)]
pub(super) struct Summary {
    /// By status: how many, and the first of them.
    counts: BTreeMap<&'static str, (u64, u64)>,
    completed: u64,
    rows: u64,
    /// By result that some have no value of though they ran to their end: its name, how many, and the first of them.
    without_value: Vec<(String, u64, u64)>,
}

impl Summary {
    /// Of none yet, with such results.
    pub fn of(results: Vec<String>) -> Summary {
        Summary { without_value: results.into_iter().map(|name| (name, 0, 0)).collect(), ..Summary::default() }
    }

    /// Adds, by result, how many of a block have no value of it, and the first of them.
    pub fn add_without_value(&mut self, lacking: &[(u64, u64)]) {
        for ((_, count, first), (more, variant)) in self.without_value.iter_mut().zip(lacking) {
            *first = if *count == 0 { *variant } else { *first };
            *count += more;
        }
    }

    /// Adds a block of them with its rows.
    pub fn add(&mut self, first: u64, statuses: &[Status], rows: usize) {
        for (status, variant) in statuses.iter().zip(first..) {
            self.counts.entry(status.as_str()).or_insert((0, variant)).0 += 1;
            self.completed += u64::from(status.is_complete());
        }
        self.rows += rows as u64;
    }

    /// How many there are.
    pub fn count(&self) -> u64 {
        self.counts.values().map(|(count, _)| count).sum()
    }

    /// How many ran to their end.
    pub fn completed(&self) -> u64 {
        self.completed
    }

    /// A line for all of them, one for each status but `ok`, and one for each result that has no value in some.
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
        for (name, count, first) in self.without_value.iter().filter(|(_, count, _)| *count > 0) {
            text += &format!("  no value of `{name}` in {count}, {}\n", which(*count, *first));
        }
        text
    }
}

/// What variants are computed by, beside what sets them.
pub(super) struct Again<'a> {
    pub input: &'a Input,
    pub interval: &'a Interval,
    pub at: &'a [String],
    pub result: &'a [String],
    pub following: &'a Following,
}

impl Again<'_> {
    /// The command that shows a variant in full.
    pub fn command(&self, settings: &[String]) -> String {
        let Again { input, interval, at, result, following } = self;
        // no option begins with a folder
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

/// A word as a shell takes it.
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
        let wanted = "2 ok, 1 reassembled, 2 stopped; 5 rows\n  E0602              2, the first is variant 11: see 11\n  reassembled        1, variant 12: see 12\n";
        assert_eq!(text, wanted);
    }

    #[test]
    fn results_without_a_value_are_counted() {
        let mut summary = Summary::of(vec!["a".to_owned(), "b".to_owned()]);
        summary.add(0, &[Status::Ok; 4], 0);
        summary.add_without_value(&[(0, 0), (2, 1)]);
        summary.add_without_value(&[(0, 0), (1, 3)]);
        let wanted = "4 ok\n  no value of `b` in 3, the first is variant 1: see 1\n";
        assert_eq!(summary.text(&|variant| format!("see {variant}")), wanted);
    }

    #[test]
    fn words_are_quoted_for_a_shell() {
        for (word, wanted) in [("rod=0.1", "rod=0.1"), ("rod=0.1 m", "'rod=0.1 m'"), ("", "''"), ("a'b", r"'a'\''b'")] {
            assert_eq!(quoted(word), wanted);
        }
    }
}
