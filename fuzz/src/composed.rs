//! Texts with several mechanisms, made of bytes: parts, what is repeated, inputs, drawn points and traces are added to what
//! `generate` makes. Each text comes in two forms: with ranges, and with all copies written out by hand.
//!
//! What is repeated is drafted with marks. `⟪k in 0..3⟫` in front of a line stands for its ranges, `⟦*⟧` behind the name that it
//! declares; `⟦k - 1⟧` behind a name means one of its copies, and `«k»` is a number in a formula.

use super::generate::{Bytes, Draft};
use mechc_expr::math;
use std::fmt::Write as _;

/// Copies of one declaration at most, for each index.
const MOST_COPIES: u8 = 3;

/// A text in its two forms; the first mechanism uses the others.
pub struct Composed {
    pub text: String,
    pub by_hand: String,
    /// One of its mechanisms as a part, and what that must be like alone.
    pub part: PartOf,
}

/// A mechanism that holds nothing but one part, and what carries it.
pub struct PartOf {
    /// With all mechanisms; the first is the one around the part.
    pub text: String,
    /// What the mechanism around is called, and the part.
    pub around: &'static str,
    pub name: &'static str,
    /// The mechanism that is the part, and what it is told, so that alone it is what the part is.
    pub mechanism: String,
    pub set: Vec<String>,
    pub inputs: Vec<String>,
    /// How far its mount gets from where it is alone (m, rad).
    pub distance: f64,
}

/// What the mechanism around a part needs to know of it.
struct Used {
    mechanism: String,
    params: Vec<(String, f64)>,
    inputs: Vec<String>,
    /// Bodies, each with a point.
    points: Vec<[String; 2]>,
    turning: Vec<String>,
    measures: usize,
}

/// The texts that bytes stand for.
#[must_use]
pub fn composed(bytes: &[u8]) -> Composed {
    let mut bytes = Bytes::new(bytes);
    let (leaf, leaf_text) = mechanism(&mut bytes, "leaf", &[], 2);
    let mut used = vec![leaf];
    let mut texts = vec![leaf_text];
    if bytes.byte() < 100 {
        let (middle, text) = mechanism(&mut bytes, "middle", &used, 2);
        used.push(middle);
        texts.push(text);
    }
    let (_, whole) = mechanism(&mut bytes, "whole", &used, 3);
    let part = part_of(&mut bytes, &used, &texts);
    texts.push(whole);
    texts.reverse();
    let marked = texts.join("\n");
    Composed { text: with_ranges(&marked), by_hand: by_hand(&marked), part }
}

fn mechanism(bytes: &mut Bytes<'_>, name: &str, parts: &[Used], elements: usize) -> (Used, String) {
    let mut draft = Draft::new(bytes, name);
    draft.is_open = true;
    let turned = draft.pick(elements + 1);
    for k in 0..=elements {
        match draft.pick(4) {
            _ if k == turned => draft.element(),
            0 => row(&mut draft),
            1 => drawn(&mut draft),
            _ => draft.element(),
        }
    }
    let mut placed: Vec<(String, &Used)> = Vec::new();
    for _ in 0..parts.len() {
        for k in 0..=draft.pick(2) {
            let which = &parts[parts.len() - 1 - k.min(parts.len() - 1)];
            part(&mut draft, which, &mut placed);
        }
    }
    // what is said twice may be any declaration, also one that repeats
    if draft.byte() > 240 {
        draft.spoil();
    }
    let measures = draft.pick(4);
    for k in 0..measures {
        draft.measure(k);
    }
    let points: Vec<[String; 2]> =
        draft.bodies.iter().filter_map(|body| Some([body.name.clone(), body.points.first()?.clone()])).collect();
    for (k, [body, point]) in points.iter().enumerate() {
        let angle = if body == "ground" { String::new() } else { format!("\nmeasure own{k}_phi = angle({body})") };
        let all = format!("measure own{k}_x = x({body}.{point})\nmeasure own{k}_y = y({body}.{point}){angle}");
        draft.declarations.push(all);
        if draft.chance(40) {
            draft.declarations.push(format!("trace path{k} = {body}.{point}"));
        }
        if draft.chance(40) {
            draft.declarations.push(format!("result reach{k} = max(own{k}_x) - min(own{k}_x)"));
        }
    }
    let used = Used {
        mechanism: name.to_owned(),
        params: draft.params.clone(),
        inputs: draft.inputs.clone(),
        points,
        turning: draft.turning.clone(),
        measures,
    };
    (used, draft.written())
}

// ---- what is repeated

/// The ranges of something, and the numbers that copies of it may be named by.
fn ranges(draft: &mut Draft<'_, '_>) -> (String, Vec<i64>) {
    let count = i64::from(draft.byte() % (MOST_COPIES + 1));
    let from = if draft.chance(200) { 0 } else { i64::from(draft.byte() % 5) - 3 };
    let last = from + count;
    let range = match draft.pick(4) {
        0 => format!("k in {from}..={}", last - 1),
        1 => {
            let name = draft.name("count");
            draft.declarations.push(format!("param {name} = {last}"));
            // told to those who write it out by hand
            format!("k in {from}..{name}={last}")
        }
        _ => format!("k in {from}..{last}"),
    };
    (range, (from..last).collect())
}

/// Bodies in a row, each with its joint and driver.
fn row(draft: &mut Draft<'_, '_>) {
    let (range, numbers) = ranges(draft);
    let [name, joint, driver] = ["row", "pin", "motor"].map(|word| draft.name(word));
    let size = draft.size().clamp(0.125, 4.0);
    let unit = if draft.units { " m" } else { "" };
    let time = if draft.units { "t / 1 s" } else { "t" };
    let body = |range: &str| {
        format!(
            "⟪{range}⟫body {name}⟦*⟧ at («k» * {size}{unit}, 0, 0.2 * «k») {{ point O = (0, 0)  point E = ({size}{unit} + «k» * 0.125{unit}, 0) }}"
        )
    };
    let base = draft.any_body();
    let at = draft.place();
    let base = draft.point(base, at);
    let rate = draft.number().clamp(-3.0, 3.0);
    let mut law = format!("0.2 * «k» + {rate} * ({time})");
    if draft.chance(128) {
        let signal = draft.name("turned");
        draft.declarations.push(format!("⟪{range}⟫input {signal}⟦*⟧ = {law}"));
        law = format!("{signal}⟦k⟧");
    }
    match draft.pick(4) {
        // a chain
        0 if numbers.len() > 1 && numbers[0] == 0 => {
            draft.declarations.push(body(&range));
            draft.declarations.push(format!("joint {joint}: revolute({base}, {name}⟦0⟧.O)"));
            let rest = range.replacen("in 0", "in 1", 1);
            let next = draft.name("next");
            draft.declarations.push(format!("⟪{rest}⟫joint {next}⟦*⟧: revolute({name}⟦k - 1⟧.E, {name}⟦k⟧.O)"));
            draft.declarations.push(format!("⟪{range}⟫driver {driver}⟦*⟧: angle({name}⟦k⟧) = {law}"));
        }
        // a grid, each placed by itself
        1 => {
            let up_to = if draft.chance(128) { "0..2" } else { "0..=k" };
            let grid = format!("{range}, j in {up_to}");
            draft.declarations.push(format!(
                "⟪{grid}⟫body {name}⟦*⟧ at («k» * {size}{unit}, «j»{}, 0) {{ point O = (0, 0)  point E = ({size}{unit}, 0) }}",
                if draft.units { " * 1 m" } else { "" }
            ));
            draft
                .declarations
                .push(format!("⟪{grid}⟫joint {joint}⟦*⟧: weld({base}, {name}⟦k, j⟧.O, 0.3 * «k» + 0.1 * «j»)"));
            draft.declarations.push(format!(
                "⟪{grid}⟫measure wide_{name}⟦*⟧ = x({name}⟦k, j⟧.E) + «j»{}",
                if draft.units { " * 1 m" } else { "" }
            ));
            return;
        }
        2 => {
            draft.declarations.push(body(&range));
            draft.declarations.push(format!("⟪{range}⟫joint {joint}⟦*⟧: revolute({base}, {name}⟦k⟧.O)"));
            let turned = draft.name("turn");
            draft.declarations.push(format!("⟪{range}⟫driver {driver}⟦*⟧: rotation({joint}⟦k⟧) = {law}"));
            draft.declarations.push(format!("⟪{range}⟫measure {turned}⟦*⟧ = der(rotation({joint}⟦k⟧))"));
        }
        _ => {
            draft.declarations.push(body(&range));
            draft.declarations.push(format!("⟪{range}⟫driver {driver}⟦*⟧: angle({name}⟦k⟧) = {law}"));
            let [wide, high] = ["wide", "high"].map(|word| draft.name(word));
            draft.declarations.push(format!("⟪{range}⟫constraint {wide}⟦*⟧: x({name}⟦k⟧.O) = «k» * {size}{unit}"));
            draft.declarations.push(format!("⟪{range}⟫constraint {high}⟦*⟧: y({name}⟦k⟧.O) = 0{unit}"));
        }
    }
    let seen = draft.name("seen");
    if draft.chance(128) {
        draft.declarations.push(format!("⟪{range}⟫trace {seen}⟦*⟧ = {name}⟦k⟧.E"));
    } else {
        draft.declarations.push(format!("⟪{range}⟫measure {seen}⟦*⟧ = y({name}⟦k⟧.E)"));
        let most = draft.name("most");
        draft.declarations.push(format!("⟪{range}⟫result {most}⟦*⟧ = max({seen}⟦k⟧) + «k» * first({seen}⟦k⟧)"));
    }
}

/// A crank that is drawn: its points are params, made of each other.
fn drawn(draft: &mut Draft<'_, '_>) {
    let [a, b, body, joint] = ["A", "B", "crank", "pin"].map(|word| draft.name(word));
    let at = draft.place();
    let at = draft.pair(at);
    let (reach, turn) = (draft.size().clamp(0.125, 4.0), draft.number());
    let unit = if draft.units { " m" } else { "" };
    draft.declarations.push(format!("param {a} = {at}"));
    draft.declarations.push(format!("param {b} = {a} + polar({reach}{unit}, {turn})"));
    let features = format!(
        "{{ point O = (0, 0)  point P = (length({a}, {b}), 0)  point M = mid((0, 0), P) + polar({reach}{unit}, 0.5) }}"
    );
    draft.declarations.push(format!("body {body} at {a} toward {b} {features}"));
    draft.declarations.push(format!("joint {joint}: revolute({a}, {body}.O)"));
    let law = draft.turn(turn);
    draft.driver(&format!("rotation({joint}) = {law}"));
    draft.declarations.push(format!("measure far_{body} = distance({body}.M, {b})"));
}

// ---- parts

fn part<'u>(draft: &mut Draft<'_, '_>, of: &'u Used, placed: &mut Vec<(String, &'u Used)>) {
    let name = draft.name("part");
    let (range, numbers) = if draft.chance(128) { ranges(draft) } else { (String::new(), Vec::new()) };
    let is_repeated = !range.is_empty();
    let k = if is_repeated { " + 0.1 * «k»" } else { "" };
    let unit = if draft.units { " m" } else { "" };
    let mut bindings = Vec::new();
    for (param, value) in &of.params {
        if draft.chance(90) {
            let nearly = value * (1.0 + 0.01 * draft.number().clamp(-3.0, 3.0));
            bindings.push(format!("{param} = {nearly} m"));
        }
    }
    for input in &of.inputs {
        if draft.chance(128) {
            let formula = signal(draft, placed);
            bindings.push(format!("{input} = {formula}{k}"));
        }
    }
    // what carries it
    let mut carriers: Vec<String> = draft.bodies.iter().map(|body| body.name.clone()).collect();
    for (copy, used) in placed.iter() {
        carriers.extend(used.points.iter().map(|[body, _]| format!("{copy}.{body}")));
    }
    let on = match draft.pick(carriers.len() + 1).checked_sub(1) {
        Some(carrier) => format!(" on {}", carriers[carrier]),
        None => String::new(),
    };
    let at = if draft.chance(200) {
        let ([x, y], phi) = (draft.place(), draft.number());
        let across = if is_repeated { format!(" + «k» * 1.5{unit}") } else { String::new() };
        format!(" at ({x}{unit}{across}, {y}{unit}, {phi}{k})")
    } else {
        String::new()
    };
    let mirrored = if draft.chance(80) { " mirrored" } else { "" };
    let (mark, star) = if is_repeated { (format!("⟪{range}⟫"), "⟦*⟧") } else { (String::new(), "") };
    let mechanism = &of.mechanism;
    draft.declarations.push(format!("{mark}part {name}{star}: {mechanism}({}){on}{at}{mirrored}", bindings.join(", ")));
    let copies: Vec<String> =
        if is_repeated { numbers.iter().map(|k| format!("{name}⟦{k}⟧")).collect() } else { vec![name.clone()] };
    if let Some([body, point]) = of.points.last() {
        let [seen, path] = ["seen", "path"].map(|word| draft.name(word));
        let copy = if is_repeated { format!("{name}⟦k⟧") } else { name.clone() };
        draft.declarations.push(format!("{mark}measure {seen}{star} = x({copy}.{body}.{point})"));
        draft.declarations.push(format!("{mark}trace {path}{star} = {copy}.{body}.{point}"));
        if of.measures > 0 && draft.chance(128) {
            let inner = draft.name("inner");
            draft.declarations.push(format!("{mark}measure {inner}{star} = {copy}.m0"));
        }
        if let Some(copy) = copies.last().filter(|_| draft.chance(60)) {
            hung_on(draft, &format!("{copy}.{body}.{point}"));
        }
    }
    placed.extend(copies.into_iter().map(|copy| (copy, of)));
}

/// A pure number that moves: of time, of an input, or of what is there already.
fn signal(draft: &mut Draft<'_, '_>, placed: &[(String, &Used)]) -> String {
    let time = if draft.units { "t / 1 s" } else { "t" };
    let rate = draft.number().clamp(-2.0, 2.0);
    let turning =
        |(copy, used): &(String, &Used)| used.turning.first().map(|joint| format!("rotation({copy}.{joint})"));
    let choice = draft.pick(6);
    let of_joint = draft.turning.first().cloned();
    let of_part = placed.last().and_then(turning);
    match (choice, of_joint, of_part, draft.inputs.first()) {
        (0, Some(joint), ..) => format!("{rate} * rotation({joint})"),
        (1, _, Some(of_part), _) => format!("{rate} * {of_part}"),
        (2, _, _, Some(input)) => format!("{rate} * {input}"),
        (3, ..) => format!("sin({rate} * ({time}))"),
        (4, ..) => format!("{rate}"),
        _ => format!("{rate} * ({time})"),
    }
}

/// A body at a point of a part.
fn hung_on(draft: &mut Draft<'_, '_>, point: &str) {
    let [body, joint] = ["hung", "hand"].map(|word| draft.name(word));
    draft.declarations.push(format!("body {body} {{ point O = (0, 0) }}"));
    draft.declarations.push(format!("joint {joint}: revolute({point}, {body}.O)"));
    let law = draft.turn(0.0);
    draft.driver(&format!("rotation({joint}) = {law}"));
}

/// One of some mechanisms as the only part of another.
fn part_of(bytes: &mut Bytes<'_>, used: &[Used], texts: &[String]) -> PartOf {
    let mut draft = Draft::new(bytes, "around");
    let of = &used[draft.pick(used.len())];
    let (mut set, mut inputs, mut bindings) = (Vec::new(), Vec::new(), Vec::new());
    for (param, value) in &of.params {
        if draft.chance(60) {
            let nearly = value * (1.0 + 0.01 * draft.number().clamp(-3.0, 3.0));
            bindings.push(format!("{param} = {nearly} m"));
            set.push(format!("{param}={nearly} m"));
        }
    }
    let is_carried = draft.chance(128);
    for input in &of.inputs {
        if draft.chance(128) {
            let (rate, start) = (draft.number().clamp(-2.0, 2.0), draft.number().clamp(-1.0, 1.0));
            let formula = format!("{start} + {rate} * t / 1 s");
            inputs.push(format!("{input}={formula}"));
            bindings.push(if is_carried && draft.chance(128) {
                format!("{input} = {start} + {rate} / 0.9 * (angle(carrier) - 0.4)")
            } else {
                format!("{input} = {formula}")
            });
        }
    }
    let ([x, y], phi) = (draft.place(), draft.number());
    let mirrored = if draft.chance(128) { " mirrored" } else { "" };
    let (carrier, on) = if is_carried {
        (
            "body carrier { point O = (0, 0) }\ndriver along: x(carrier.O) = sin(1.3 * t)\n\
             driver across: y(carrier.O) = cos(0.7 * t)\ndriver spin: angle(carrier) = 0.4 + 0.9 * t\n",
            " on carrier",
        )
    } else {
        ("", "")
    };
    let call = format!("part p: {}({}){on} at ({x}, {y}, {phi}){mirrored}", of.mechanism, bindings.join(", "));
    let text = format!("mechanism around {{\n{carrier}{call}\n}}\n{}", with_ranges(&texts.join("\n")));
    let distance = math::hypot(x, y).max(phi.abs()) + if is_carried { 2.0 } else { 0.0 };
    PartOf { text, around: "around", name: "p", mechanism: of.mechanism.clone(), set, inputs, distance }
}

// ---- the two forms

/// A number's name in one of the copies.
type Numbers<'t> = [(&'t str, i64)];

/// The marked text with ranges.
fn with_ranges(marked: &str) -> String {
    let mut text = String::new();
    for line in marked.lines() {
        let (ranges, line) = split(line);
        let line = match ranges {
            Some(ranges) => line.replace("⟦*⟧", &format!("[{}]", without_numbers(ranges))),
            None => line.to_owned(),
        };
        let _ = writeln!(text, "{}", line.replace('⟦', "[").replace('⟧', "]").replace(['«', '»'], ""));
    }
    text
}

/// The marked text with all copies written out.
fn by_hand(marked: &str) -> String {
    let mut text = String::new();
    for line in marked.lines() {
        match split(line) {
            (None, line) => {
                let _ = writeln!(text, "{}", copy(line, &[]));
            }
            (Some(ranges), line) => {
                let ranges: Vec<&str> = ranges.split(", ").collect();
                written_out(line, &ranges, &mut Vec::new(), &mut text);
            }
        }
    }
    text
}

fn split(line: &str) -> (Option<&str>, &str) {
    match line.strip_prefix('⟪').and_then(|rest| rest.split_once('⟫')) {
        Some((ranges, line)) => (Some(ranges), line),
        None => (None, line),
    }
}

/// `k in 0..n=3` as `k in 0..n`
fn without_numbers(ranges: &str) -> String {
    let without = |range: &str| match range.split_once('=') {
        Some((named, _)) if !named.ends_with("..") => named.to_owned(),
        _ => range.to_owned(),
    };
    ranges.split(", ").map(without).collect::<Vec<_>>().join(", ")
}

fn written_out<'t>(line: &str, ranges: &[&'t str], numbers: &mut Vec<(&'t str, i64)>, text: &mut String) {
    let Some((range, rest)) = ranges.split_first() else {
        let _ = writeln!(text, "{}", copy(line, numbers));
        return;
    };
    let (index, bounds) = range.split_once(" in ").unwrap_or_default();
    let (from, to) = bounds.split_once("..").unwrap_or_default();
    let through = i64::from(to.starts_with('='));
    let to = to.rsplit_once('=').map_or(to, |(_, to)| to);
    for k in whole(from, numbers)..whole(to, numbers) + through {
        numbers.push((index, k));
        written_out(line, rest, numbers, text);
        numbers.pop();
    }
}

/// The value of `k - 1`.
fn whole(formula: &str, numbers: &Numbers<'_>) -> i64 {
    let (mut sum, mut sign) = (0, 1);
    for word in formula.split_whitespace() {
        match word {
            "-" => sign = -1,
            "+" => sign = 1,
            _ => {
                let named = numbers.iter().find(|(name, _)| *name == word).map(|(_, k)| *k);
                sum += sign * named.or_else(|| word.parse().ok()).unwrap_or(0);
            }
        }
    }
    sum
}

/// A line with its numbers in their places.
fn copy(line: &str, numbers: &Numbers<'_>) -> String {
    let (mut text, mut rest) = (String::new(), line);
    while let Some(at) = rest.find(['⟦', '«']) {
        let (before, mark) = rest.split_at(at);
        text += before;
        let is_name = mark.starts_with('⟦');
        let end = mark.find(if is_name { '⟧' } else { '»' }).unwrap_or(mark.len());
        let begin = if is_name { '⟦'.len_utf8() } else { '«'.len_utf8() };
        let inside = mark.get(begin..end).unwrap_or_default();
        text += &match (is_name, inside) {
            (true, "*") => suffix(numbers.iter().map(|(_, k)| *k)),
            (true, indices) => suffix(indices.split(", ").map(|index| whole(index, numbers))),
            (false, index) => match whole(index, numbers) {
                k if k < 0 => format!("({k})"),
                k => k.to_string(),
            },
        };
        rest = &mark[(end + if is_name { '⟧'.len_utf8() } else { '»'.len_utf8() }).min(mark.len())..];
    }
    text + rest
}

/// What copies are called by hand.
fn suffix(numbers: impl Iterator<Item = i64>) -> String {
    numbers.map(|k| format!("_{k}").replace('-', "m")).collect()
}

/// A column's name as it is by hand: `leg[0].tile[1,-2].x` is `leg_0.tile_1_m2.x`.
#[must_use]
pub fn column_by_hand(column: &str) -> String {
    let (mut text, mut is_inside) = (String::new(), false);
    for c in column.chars() {
        match c {
            '[' => {
                is_inside = true;
                text.push('_');
            }
            ']' => is_inside = false,
            ',' => text.push('_'),
            '-' if is_inside => text.push('m'),
            _ => text.push(c),
        }
    }
    text
}
