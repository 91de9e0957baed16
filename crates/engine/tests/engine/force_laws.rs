//! Laws of mechanics, which hold for random masses and loads on mechanisms with every kind of joint: Newton's and Euler's for each free
//! body, the balance of power, what statics says of potential energy; and that forces do not depend on how a mechanism is written down.

#![allow(clippy::expect_used, clippy::panic)] // a test fails by panicking
#![allow(clippy::format_collect)] // texts are short
#![allow(clippy::disallowed_methods)] // what is compared to a tolerance needs no bits of its own

use crate::support;

mod free_bodies;
mod mechanisms;
mod texts;

use crate::support::Outcome;
use crate::support::random::Random;
use free_bodies::{Moment, Row, Wrench};
use mechanisms::{ALL, Skeleton};
use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions, Times};
use std::collections::HashMap;
use texts::{Forces, Seat, Text};

/// Sums that vanish are as small as this part of their largest term.
const BALANCED: f64 = 1e-9;
/// The number of sets of masses and loads for each mechanism.
const SEEDS: u64 = 4;

/// A table with all reactions and efforts.
struct Table {
    columns: HashMap<String, usize>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn of(text: &str, set: &[String]) -> Table {
        let choice = Choice { reactions: true, set: set.to_vec(), ..Choice::default() };
        let checked = Parsed::new("text", text).check(&choice, &Memory::default());
        let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
        let mut outcome = Outcome {
            sources: checked.sources().clone(),
            diagnostics: checked.diagnostics().clone(),
            columns: Vec::new(),
            rows: Vec::new(),
        };
        outcome.diagnostics.extend(messages);
        let compiled = compiled.unwrap_or_else(|| panic!("{text}\n{}", outcome.text()));
        let [from, to, every] = compiled.analysis().expect("an analysis");
        let times = Times::grid(from, to, every).expect("a grid");
        support::follow(&compiled, &times, &RunOptions::default(), &mut outcome);
        assert!(outcome.succeeded() && !outcome.rows.is_empty(), "{text}\n{}", outcome.text());
        let columns = outcome.columns.iter().cloned().enumerate().map(|(k, name)| (name, k)).collect();
        Table { columns, rows: outcome.rows }
    }

    fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|row| Row::new(&self.columns, row))
    }

    /// All columns of forces are those of another table as they are seen here.
    fn holds_forces_of(&self, other: &Table, prefix: &str, seen: impl Fn(&Row, &str) -> f64, about: &str) {
        for (row, wanted) in self.rows().zip(other.rows()) {
            let names = || other.columns.keys().filter(|name| is_force(name));
            let largest = names().map(|name| wanted.get(name).abs()).fold(0.0, f64::max);
            for name in names() {
                let (found, wanted) = (row.get(&format!("{prefix}{name}")), seen(&wanted, name));
                assert!((found - wanted).abs() <= BALANCED * largest, "{about}: {name} is {found}, not {wanted}");
            }
        }
    }
}

fn is_force(column: &str) -> bool {
    [".fx", ".fy", ".torque", ".effort"].iter().any(|ending| column.ends_with(ending))
}

/// Each mechanism several times, with a name for what is wrong.
fn each(mut test: impl FnMut(&Skeleton, &Forces, &mut Random, &str)) {
    for skeleton in ALL {
        for seed in 1..=SEEDS {
            let mut random = Random::new(seed);
            let forces = Forces::random(skeleton, &mut random);
            test(skeleton, &forces, &mut random, &format!("{}, {seed}", skeleton.name));
        }
    }
}

/// Some seats, all of them with gravity as it is outside.
fn seats(random: &mut Random) -> [Option<Seat>; 4] {
    let mut pose = || [random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-3.0, 3.0)];
    let (first, second, third) = (pose(), pose(), pose());
    let turning = Some([random.between(-4.0, 4.0), random.between(-5.0, 5.0)]);
    [
        None,
        Some(Seat { pose: first, is_mirrored: true, turning: None }),
        Some(Seat { pose: second, is_mirrored: false, turning }),
        Some(Seat { pose: third, is_mirrored: true, turning }),
    ]
}

/// Forces and moments of free bodies, each against the largest of its kind.
fn balance(bodies: &[(Vec<Wrench>, Wrench)], is_held: impl Fn(usize) -> bool, about: &str) {
    let terms = || bodies.iter().flat_map(|(given, needed)| given.iter().chain([needed]));
    let largest = [
        terms().flat_map(|[x, y, _]| [x.abs(), y.abs()]).fold(0.0, f64::max),
        terms().map(|[.., moment]| moment.abs()).fold(0.0, f64::max),
    ];
    for (number, (given, needed)) in bodies.iter().enumerate().filter(|(number, _)| !is_held(*number)) {
        for part in 0..3 {
            let off = given.iter().map(|wrench| wrench[part]).sum::<f64>() - needed[part];
            let size = largest[usize::from(part == 2)];
            assert!(off.abs() <= BALANCED * size, "{about}: body {number}, component {part} is off by {off} of {size}");
        }
    }
}

#[test]
fn bodies_obey_newton_and_euler() {
    each(|skeleton, forces, random, about| {
        for (number, seat) in seats(random).into_iter().enumerate() {
            let table = Table::of(&Text { seat, ..Text::of(skeleton, forces) }.written(), &[]);
            let is_fixed = seat.is_none_or(|seat| seat.turning.is_none());
            for row in table.rows() {
                let moment = Moment::new(&row, skeleton, seat);
                let about = format!("{about}, seat {number}, t = {}", row.get("t"));
                balance(&moment.free_bodies(forces), |body| body == 0 && is_fixed, &about);
            }
        }
    });
}

#[test]
fn power_balances_energy() {
    each(|skeleton, forces, _, about| {
        let table = Table::of(&Text::of(skeleton, forces).written(), &[]);
        for row in table.rows() {
            let powers = Moment::new(&row, skeleton, None).powers(forces);
            let largest = powers.iter().map(|power| power.abs()).fold(0.0, f64::max);
            let off: f64 = powers.iter().sum();
            assert!(off.abs() <= BALANCED * largest, "{about}: {off} W of {largest} W at {}", row.get("t"));
        }
    });
}

/// Central differences: by so much of a value, so close to the slope, and so much of what they are differences of for its rounding.
const STEP: f64 = 1e-5;
const WIDE_STEP: f64 = 1e-4;
const CLOSE: f64 = 1e-7;
const ROUNDED: f64 = 1e-12;

#[test]
fn at_rest_efforts_are_slopes_of_the_potential_energy() {
    for skeleton in ALL {
        let mut random = Random::new(11);
        let forces = Forces::random(skeleton, &mut random).conservative();
        let start: Vec<(&str, f64)> = {
            let table = Table::of(&Text::of(skeleton, &forces).written(), &[]);
            let row = table.rows().next().expect("a row");
            let moment = Moment::new(&row, skeleton, None);
            let value = |left: &[(f64, mechanisms::Quantity)]| {
                left.iter().map(|(factor, on)| factor * moment.value(*on)).sum::<f64>()
            };
            skeleton.equations.iter().map(|equation| (equation.name, value(equation.left))).collect()
        };
        // all stand still, one of them a little beside where it stands
        let at_rest = |beside: usize, by: f64| {
            let right = |(k, (name, value)): (usize, &(&'static str, f64))| {
                (*name, format!("{}", value + if k == beside { by } else { 0.0 }))
            };
            let rights: Vec<(&str, String)> = start.iter().enumerate().map(right).collect();
            Table::of(&Text { rights: &rights, ..Text::of(skeleton, &forces) }.written(), &[])
        };
        let table = at_rest(0, 0.0);
        let row = table.rows().next().expect("a row");
        let sizes = start.iter().map(|(name, _)| row.get(&format!("{name}.effort")).abs());
        let size = sizes.fold(0.0, f64::max);
        for (number, (name, _)) in start.iter().enumerate() {
            let energy = |by: f64| {
                let table = at_rest(number, by);
                let row = table.rows().next().expect("a row");
                Moment::new(&row, skeleton, None).potential_energy(&forces)
            };
            // of fourth order: some springs are wound up on small pinions
            let [near, far] = [WIDE_STEP, 2.0 * WIDE_STEP].map(|by| energy(by) - energy(-by));
            let wanted = (8.0 * near - far) / (12.0 * WIDE_STEP);
            let found = row.get(&format!("{name}.effort"));
            let about = skeleton.name;
            let close = CLOSE * size + ROUNDED * energy(0.0).abs() / WIDE_STEP;
            assert!((found - wanted).abs() <= close, "{about}: {name} supplies {found}, and not {wanted}");
        }
    }
}

#[test]
fn the_order_of_declarations_changes_no_force() {
    each(|skeleton, forces, _, about| {
        let text = Text::of(skeleton, forces);
        let (table, other) = (text.written(), Text { is_reversed: true, ..text }.written());
        let same = |row: &Row, name: &str| row.get(name);
        Table::of(&other, &[]).holds_forces_of(&Table::of(&table, &[]), "", same, about);
    });
}

#[test]
fn resting_parts_keep_their_forces() {
    each(|skeleton, forces, random, about| {
        let alone = Table::of(&Text::of(skeleton, forces).written(), &[]);
        for is_mirrored in [false, true] {
            let pose @ [.., phi] = [random.between(-9.0, 9.0), random.between(-9.0, 9.0), random.between(-3.0, 3.0)];
            let seat = Seat { pose, is_mirrored, turning: None };
            let seen = |[x, y]: [f64; 2]| {
                let y = seat.sign() * y;
                [x * phi.cos() - y * phi.sin(), x * phi.sin() + y * phi.cos()]
            };
            // gravity is turned along
            let turned = Forces { gravity: seen(forces.gravity), masses: Vec::new(), loads: Vec::new() };
            let text = Text { seat: Some(seat), ..Text::of(skeleton, forces) }.written();
            let [from, to] = [forces, &turned].map(|forces| {
                let [x, y] = forces.gravity;
                format!("gravity ({x}, {y})")
            });
            let part = Table::of(&text.replacen(&from, &to, 1), &[]);
            let wanted = |row: &Row, name: &str| {
                let (joint, ending) = name.rsplit_once('.').expect("a column of forces");
                let force = || seen(["fx", "fy"].map(|ending| row.get(&format!("{joint}.{ending}"))));
                match ending {
                    "fx" => force()[0],
                    "fy" => force()[1],
                    "torque" => seat.sign() * row.get(name),
                    _ => row.get(name),
                }
            };
            part.holds_forces_of(&alone, "p.", wanted, about);
        }
    });
}

/// Params, and what stands for them in a text: a mass, a length, a stiffness, and what a driver is at.
fn with_params(text: &str, forces: &Forces, skeleton: &Skeleton) -> (String, Vec<(&'static str, f64)>) {
    let mut text = text.to_owned();
    let mut params = Vec::new();
    let mut replace = |text: &mut String, name: &'static str, (from, to): (String, String), value: f64| {
        if text.contains(&from) {
            *text = text.replacen(&from, &to, 1);
            params.push((name, value));
        }
    };
    if let Some(mass) = forces.masses.first() {
        let written = |amount: &str| format!(" mass {amount} at");
        replace(&mut text, "heavy", (written(&mass.amount.to_string()), written("heavy")), mass.amount);
    }
    if let Some(load) = forces.loads.first() {
        let written = |stiffness: &str| format!("load l0: -({stiffness})");
        replace(&mut text, "stiff", (written(&load.stiffness.to_string()), written("stiff")), load.stiffness);
    }
    let (name, [x, y]) = skeleton.frames[1].points.last().expect("a point");
    let written = |x: &str| format!(" point {name} = ({x}, {y})");
    replace(&mut text, "long", (written(&x.to_string()), written("long")), *x);
    (text, params)
}

#[test]
fn force_derivatives_match_differences() {
    for skeleton in ALL {
        let forces = Forces::random(skeleton, &mut Random::new(3));
        let (text, params) = with_params(&Text::of(skeleton, &forces).written(), &forces, skeleton);
        let efforts: Vec<&str> = skeleton.equations.iter().map(|equation| equation.name).collect();
        let declared: String = params.iter().map(|(name, value)| format!("param {name} = {value}\n ")).collect();
        let measures: String = params
            .iter()
            .flat_map(|(name, _)| efforts.iter().map(move |effort| (name, effort)))
            .map(|(name, effort)| format!("measure by_{name}_{effort} = der(effort({effort}), {name})\n "))
            .collect();
        let text = text.replacen("{\n", &format!("{{\n {declared}{measures}"), 1);
        let table = Table::of(&text, &[]);
        for (name, value) in &params {
            let step = STEP * value.abs().max(0.01);
            let beside = |by: f64| Table::of(&text, &[format!("{name}={}", value + by)]);
            let (more, less) = (beside(step), beside(-step));
            for ((row, more), less) in table.rows().zip(more.rows()).zip(less.rows()) {
                for effort in &efforts {
                    let column = format!("{effort}.effort");
                    let wanted = (more.get(&column) - less.get(&column)) / (2.0 * step);
                    let found = row.get(&format!("by_{name}_{effort}"));
                    let sizes = efforts.iter().map(|effort| row.get(&format!("{effort}.effort")).abs());
                    let close = CLOSE * found.abs() + ROUNDED * sizes.fold(0.0, f64::max) / step;
                    let about = format!("{}, t = {}", skeleton.name, row.get("t"));
                    assert!((found - wanted).abs() <= close, "{about}: {column} by {name} is {found}, not {wanted}");
                }
            }
        }
    }
}

/// A roller that its weight holds on a disc, with a load that lifts it for a moment: how much (N), when and for how long (s), in rows so far apart
/// (s).
fn lifted([force, at, width]: [f64; 3], every: f64) -> support::Outcome {
    let text = format!(
        "mechanism pulse {{
            ground {{ point O = (0, 0) axis w = (0, 0) along (0, 1) }}
            body d {{ point O = (0, 0) circle k = (10 mm, 0) radius 30 mm }}
            body f at (0, 38 mm, 0) {{ axis w = (0, 0) along (0, 1) circle r = (0, 0) radius 8 mm mass 1 kg }}
            gravity (0, -9.81 m/s^2)
            joint m_: revolute(ground.O, d.O)
            joint gd: translational(ground.w, f.w)
            joint c: cam(d.k, f.r)
            driver dr: rotation(m_) = 1 rad/s * t
            load up: {force} N * exp(-((t - {at} s) / ({width} s))^2) on displacement(gd)
            measure fy = force_y(c)
            analysis from 0 s to 1 s every {every} s
        }}"
    );
    support::run("pulse", &text, support::Span::default())
}

#[test]
fn a_contact_that_pulls_between_rows_is_reported() {
    let mut random = support::random::Random::new(11);
    for _ in 0..12 {
        let (at, width) = (random.between(0.05, 0.45), random.between(0.002, 0.02));
        let found = lifted([50.0, at, width], 0.5);
        assert_eq!(found.codes(), ["W0604"], "{at}, {width}: {}", found.text());
        let t = found.diagnostics.iter().next().and_then(|report| report.data["t"].as_f64()).expect("a time");
        assert!((t - at).abs() < width, "{t}, not {at}");
        // rows are what they are without a pull
        let rows = lifted([5.0, at, width], 0.5);
        assert_eq!(found.column("f.y"), rows.column("f.y"));
        assert!(rows.codes().is_empty(), "{at}, {width}: {}", rows.text());
    }
}
