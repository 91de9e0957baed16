//! Names of emitted code: a declaration that is added to a text changes no name of another, unless it is spelled as a path of that other.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::random::Random;
use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RustOptions};
use std::collections::{BTreeMap, BTreeSet};

/// Texts with additions, some of which cannot be.
const TRIALS: u64 = 90;
const LEAST: usize = 50;

const TEXT: &str = "mechanism machine {
    //<
    param Reach  = 1 m
    param A      = (0, 0)
    param rear_a = 1 m
    input swing[k in 0..2] = k + t / 1 s
    ground { point O = (0, 0) }
    body shaft { point O = (0, 0)  point tip = (Reach + A.x + rear_a, 0) }
    joint main: revolute(ground.O, shaft.O)
    driver motor: rotation(main) = swing[0] + swing[1]
    part leg[k in -1..1]: leg(turn = angle(shaft))
    part foot[i in 0..2, j in 0..2]: arm(turn = angle(shaft))
    part front: leg(turn = angle(shaft)) on shaft
    part rear: arm()
    measure high = y(front.arm.tip)
    //>
}
mechanism leg {
    param shank = 1 m
    input turn  = t / 1 s
    ground { point O = (0, 0) }
    body arm { point O = (0, 0)  point tip = (shank, 0) }
    joint hip: revolute(ground.O, arm.O)
    driver d: rotation(hip) = turn
    part toe[k in 0..2]: arm(turn = angle(arm)) on arm
    measure height = y(arm.tip)
}
mechanism arm {
    param reach = 1 m
    param A     = (0, 0)
    input turn  = t / 1 s
    ground { point O = A }
    body bar { point O = A  point tip = (reach, 0) }
    joint pin: revolute(ground.O, bar.O)
    driver d: rotation(pin) = turn
    measure height = y(bar.tip)
}
";

/// What is added is called so: much of it is how a path of the text is spelled.
const NAMES: [&str; 36] = [
    "leg_0",
    "leg_m1",
    "Leg_0",
    "leg0",
    "leg_0_arm",
    "leg_0_arm_x",
    "leg_0_toe_1",
    "leg_0_shank",
    "leg_m1_height",
    "leg_0_height",
    "front_shank",
    "front_arm",
    "Front_arm",
    "front_toe",
    "front_toe_0",
    "front_toe_1_bar",
    "front_toe_0_height",
    "front_hip",
    "rear_a_x",
    "rear_a_2",
    "rear_reach",
    "rear_turn",
    "rear_bar",
    "Rear",
    "foot_0_1",
    "foot_1_1_reach",
    "foot_0_0_bar_phi",
    "a_x",
    "A_y",
    "reach",
    "swing_0",
    "swing_1",
    "shaft_x",
    "Shaft",
    "params",
    "toe",
];

/// The names of a module, by what they are of: those of a structure, enumeration or list of constants are told apart.
fn names(text: &str) -> Option<BTreeMap<(String, String), String>> {
    let checked = Parsed::new("machine.mech", text)
        .check(&Choice { mechanism: Some("machine".to_owned()), ..Choice::default() }, &Memory::default());
    let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0?;
    let options = RustOptions { with_sensitivities: true, ..RustOptions::new("machine.mech") };
    let module = compiled.rust(&options).0.expect("a module");
    let whole: Vec<&str> = module.lines().collect();
    let lines: Vec<&str> = whole.iter().map(|line| line.trim()).collect();
    let quoted = |line: &str| Some(line.strip_prefix("/// ")?.split_once('`')?.1.split_once('`')?.0.to_owned());
    let word = |line: &str| {
        let line = ["pub ", "const ", "struct ", "mod ", "enum "]
            .iter()
            .fold(line, |line, word| line.trim_start_matches(word));
        line.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect::<String>()
    };
    let mut found = BTreeMap::new();
    let mut group = String::new();
    for (k, line) in lines.iter().enumerate().skip(2) {
        if ["pub struct ", "pub enum ", "pub mod "].iter().any(|start| line.starts_with(start)) {
            group = format!("in {}", word(line));
            if let Some(part) = quoted(lines[k - 2]).filter(|_| lines[k - 2].contains("parameters of a part")) {
                group = format!("in {part}");
                // copies share their type
                let of = part.split(['[', ']']).step_by(2).collect();
                found.insert(("types".to_owned(), of), word(line));
            }
        } else if whole[k] == "}" {
            group.clear();
        } else if !group.is_empty()
            && let Some(source) = quoted(lines[k - 1])
            && (line.starts_with("pub const ") || line.starts_with("pub ") || line.ends_with(','))
        {
            found.insert((group.clone(), source), word(line));
        }
    }
    Some(found)
}

/// How a name is spelled, whatever marks its words.
fn spelled(source: &str) -> String {
    let text = source.replace("[-", "[m");
    text.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase()
}

fn is_path(source: &str) -> usize {
    source.chars().filter(|c| ".[ ".contains(*c)).count()
}

/// A declaration, and whether it stands in front of all others.
fn addition(random: &mut Random) -> (String, bool) {
    let name = random.of(&NAMES);
    let range = random.of(&["", "", "[k in 0..2]", "[k in -1..1]", "[i in 0..2, j in 0..2]"]);
    let declaration = match random.below(6) {
        0 => format!("param {name} = 2 m"),
        1 => format!("param {name} = (1, 2)"),
        2 => format!("input {name}{range} = t / 1 s"),
        3 => format!("measure {name}{range} = t / 1 s"),
        4 => format!("part {name}{range}: {}(turn = angle(shaft))", random.of(&["arm", "leg"])),
        _ => {
            let index = range.find('[').map_or("", |_| if range.contains('j') { "[i, j]" } else { "[k]" });
            format!(
                "body {name}{range} {{ point O = (0, 0) }} joint j_{name}{range}: revolute(ground.O, {name}{index}.O)
                 driver d_{name}{range}: rotation(j_{name}{index}) = t / 1 s"
            )
        }
    };
    (declaration, random.below(2) == 0)
}

#[test]
fn additions_change_no_other_name() {
    let before = names(TEXT).expect("determined");
    assert!(before.len() > 150, "{before:?}");
    let (mut looked_at, mut gave_way) = (0, 0);
    for seed in 0..TRIALS {
        let mut random = Random::new(seed);
        let mut text = TEXT.to_owned();
        let mut all = String::new();
        for _ in 0..=random.below(3) {
            let (declaration, is_first) = addition(&mut random);
            let place = if is_first { "//<" } else { "//>" };
            text = text.replacen(place, &format!("{declaration}\n    {place}"), 1);
            all += &format!("{declaration}\n");
        }
        let Some(after) = names(&text) else { continue };
        looked_at += 1;
        let mut seen: BTreeSet<(&str, &str)> = BTreeSet::new();
        for ((group, _), name) in &after {
            assert!(seen.insert((group, name)), "{all}two are called {name} {group}");
        }
        for ((group, source), name) in &before {
            let now = after.get(&(group.clone(), source.clone())).unwrap_or_else(|| panic!("{all}no {source} {group}"));
            if now == name {
                continue;
            }
            gave_way += 1;
            let is_new = |other: &str| !before.contains_key(&(group.clone(), other.to_owned()));
            let takes_it = after.keys().any(|(of, other)| {
                of == group && is_new(other) && spelled(other) == spelled(source) && is_path(other) <= is_path(source)
            });
            assert!(takes_it, "{all}{group}: {source} was {name}, is {now}");
            assert!(
                now.starts_with(name.as_str()) && now[name.len()..].trim_matches('_').parse::<u32>().is_ok(),
                "{all}{now}"
            );
        }
    }
    assert!(looked_at > LEAST && gave_way > 20, "{looked_at} texts, {gave_way} names gave way");
}
