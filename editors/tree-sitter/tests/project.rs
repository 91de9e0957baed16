//! All texts of the project: valid ones parse without an error, and broken ones keep what is whole.

mod support;

use std::fmt::Write;
use std::ops::Range;
use support::{Declaration, Text, kept, parser, read, texts, tokens, tree};

/// The least part of the declarations beside a broken one that keep their node.
const LEAST_KEPT: f64 = 0.9;

/// Damages of each kind for each declaration that is damaged.
const DAMAGED_IN_EACH_TEXT: usize = 2;

#[test]
fn what_is_valid_parses_without_an_error() {
    let (mut valid, mut declared, mut faults) = (0, 0, String::new());
    for Text { name, text } in texts() {
        let found = read(&text);
        if !found.is_valid {
            continue;
        }
        let tree = tree(&text);
        let missing = found.declarations.len() - kept(&tree, &found.declarations);
        if tree.root_node().has_error() || missing > 0 {
            let _ = writeln!(faults, "{name}: {missing} declarations missing");
        }
        valid += 1;
        declared += found.declarations.len();
    }
    println!("{valid} valid texts with {declared} declarations");
    assert!(faults.is_empty(), "{faults}");
    assert!(valid > 500 && declared > 5_000, "{valid} texts, {declared} declarations");
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_are_no_errors() {
    let text = "\u{feff}// one\r\nmechanism a {\r\n    param b = 5 mm // two\r\n}\r\n";
    assert!(read(text.trim_start_matches('\u{feff}')).is_valid);
    assert!(!tree(text).root_node().has_error(), "{}", tree(text).root_node().to_sexp());
}

#[test]
fn broken_inputs_of_the_tests_keep_what_is_whole() {
    let (mut broken, mut wanted, mut found) = (0, 0, 0);
    let mut worst = String::new();
    for Text { name, text } in texts() {
        let whole = read(&text);
        if whole.is_valid || whole.declarations.is_empty() {
            continue;
        }
        let kept = kept(&tree(&text), &whole.declarations);
        if (kept as f64) < LEAST_KEPT * whole.declarations.len() as f64 {
            let _ = writeln!(worst, "{name}: {kept} of {}", whole.declarations.len());
        }
        broken += 1;
        wanted += whole.declarations.len();
        found += kept;
    }
    let part = found as f64 / wanted as f64;
    println!("{broken} broken texts: {found} of {wanted} declarations kept, {:.1} %\n{worst}", 100.0 * part);
    assert!(broken > 50 && wanted > 500, "{broken} texts, {wanted} declarations");
    assert!(part >= LEAST_KEPT, "{part}\n{worst}");
}

#[test]
fn a_damaged_declaration_leaves_the_others_whole() {
    let mut chance = Chance(0x2545_f491_4f6c_dd15);
    let mut parser = parser();
    let mut tallies = DAMAGES.map(|_| Tally::default());
    for Text { text, .. } in texts() {
        let whole = read(&text);
        if !whole.is_valid || whole.declarations.len() < 5 {
            continue;
        }
        for _ in 0..DAMAGED_IN_EACH_TEXT {
            let victim = &whole.declarations[chance.below(whole.declarations.len())];
            for ((_, damage), tally) in DAMAGES.iter().zip(&mut tallies) {
                let head = head_of(&text, victim);
                let Some(changed) = damage(&text, head, &mut chance) else { continue };
                if read(&changed).is_valid {
                    continue;
                }
                let shift = changed.len() as isize - text.len() as isize;
                let others: Vec<Declaration> =
                    whole.declarations.iter().filter_map(|one| beside(one, victim, shift)).collect();
                let tree = parser.parse(&changed, None).expect("nothing cancels it");
                tally.texts += 1;
                tally.wanted += others.len();
                tally.kept += kept(&tree, &others);
            }
        }
    }
    for ((name, _), tally) in DAMAGES.iter().zip(&tallies) {
        println!(
            "{name:>12}: {:5} texts, {:6} of {:6} kept, {:.1} %",
            tally.texts,
            tally.kept,
            tally.wanted,
            100.0 * tally.part()
        );
    }
    for ((name, _), tally) in DAMAGES.iter().zip(&tallies) {
        assert!(tally.texts > 500, "{name}: only {} texts", tally.texts);
        assert!(tally.part() >= LEAST_KEPT, "{name}: {}", tally.part());
    }
}

#[derive(Clone, Copy, Default)]
struct Tally {
    texts: usize,
    wanted: usize,
    kept: usize,
}

impl Tally {
    fn part(self) -> f64 {
        self.kept as f64 / self.wanted as f64
    }
}

/// A generator of numbers that look random (xorshift).
struct Chance(u64);

impl Chance {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit as u64) as usize
    }
}

/// Where a declaration stands without its braces.
fn head_of(text: &str, one: &Declaration) -> Range<usize> {
    let end = one.end.expect("the text is valid");
    let length = text[one.start..end].find('{').filter(|_| ["body", "ground"].contains(&one.kind));
    one.start..length.map_or(end, |length| one.start + length)
}

/// Where another declaration stands after the damage; none of what is in or around the damaged one.
fn beside(one: &Declaration, victim: &Declaration, shift: isize) -> Option<Declaration> {
    let (end, victim_end) = (one.end?, victim.end?);
    if end <= victim.start {
        return Some(one.clone());
    }
    let moved = |place: usize| place.saturating_add_signed(shift);
    (one.start >= victim_end).then(|| Declaration { kind: one.kind, start: moved(one.start), end: Some(moved(end)) })
}

type Damage = fn(&str, Range<usize>, &mut Chance) -> Option<String>;

/// What happens to a declaration while somebody writes it.
const DAMAGES: [(&str, Damage); 6] = [
    ("half typed", half_typed),
    ("deleted", |text, head, chance| Some(replaced(text, any_token(text, head, chance)?, ""))),
    ("doubled", |text, head, chance| {
        let token = any_token(text, head, chance)?;
        let twice = text[token.clone()].repeat(2);
        Some(replaced(text, token, &twice))
    }),
    ("mistyped", |text, head, chance| {
        let token = any_token(text, head, chance)?;
        let sign = ["x", "7", "=", ":", ",", "*", "(", ")", "@", "..", "if", "at", "\"", ";"][chance.below(14)];
        Some(replaced(text, token, sign))
    }),
    ("inserted", |text, head, chance| {
        let token = any_token(text, head, chance)?;
        let sign = [" x ", " 7 ", "=", ":", ",", "*", "(", ")", "@", ".", "[", "]", "#", "'"][chance.below(14)];
        Some(replaced(text, token.end..token.end, sign))
    }),
    ("swapped", |text, head, chance| {
        let tokens = tokens(text, head);
        let at = chance.below(tokens.len().checked_sub(1).filter(|most| *most > 0)?);
        let (first, second) = (tokens[at].clone(), tokens[at + 1].clone());
        let turned = format!("{} {}", &text[second.clone()], &text[first.clone()]);
        Some(replaced(text, first.start..second.end, &turned))
    }),
];

/// Its end is not there yet.
fn half_typed(text: &str, head: Range<usize>, chance: &mut Chance) -> Option<String> {
    let from = any_token(text, head.clone(), chance)?.end;
    let last = tokens(text, head).last()?.end;
    Some(replaced(text, from..last, ""))
}

fn any_token(text: &str, head: Range<usize>, chance: &mut Chance) -> Option<Range<usize>> {
    let tokens = tokens(text, head);
    (!tokens.is_empty()).then(|| tokens[chance.below(tokens.len())].clone())
}

fn replaced(text: &str, place: Range<usize>, by: &str) -> String {
    format!("{}{by}{}", &text[..place.start], &text[place.end..])
}
