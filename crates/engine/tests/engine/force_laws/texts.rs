//! Random masses and loads, and the texts of mechanisms that have them.

use super::mechanisms::{Equation, Frame, Quantity, Skeleton};
use crate::support::random::Random;
use std::fmt::Write;

/// Where a mechanism stands: by itself, or as a part.
#[derive(Clone, Copy, Default)]
pub struct Seat {
    /// Where the part's frame is in that of what carries it.
    pub pose: [f64; 3],
    pub is_mirrored: bool,
    /// How a turntable carries it that goes on so (rad/s, rad/s²); none where it stands on the ground.
    pub turning: Option<[f64; 2]>,
}

impl Seat {
    /// 1, or −1 where y is turned over.
    pub fn sign(self) -> f64 {
        if self.is_mirrored { -1.0 } else { 1.0 }
    }
}

pub struct Mass {
    pub frame: usize,
    pub amount: f64,
    pub at: [f64; 2],
    pub inertia: f64,
}

/// `−k (K − rest) − c K̇ + a sin(w t)` on K.
pub struct Load {
    pub on: Quantity,
    pub stiffness: f64,
    pub rest: f64,
    pub damping: f64,
    pub push: f64,
    pub pace: f64,
}

impl Load {
    pub fn force(&self, value: f64, rate: f64, t: f64) -> f64 {
        -self.stiffness * (value - self.rest) - self.damping * rate + self.push * (self.pace * t).sin()
    }
}

pub struct Forces {
    pub gravity: [f64; 2],
    pub masses: Vec<Mass>,
    pub loads: Vec<Load>,
}

impl Forces {
    pub fn random(of: &Skeleton, random: &mut Random) -> Forces {
        let mut masses = Vec::new();
        for frame in 1..of.frames.len() {
            // none, one or two
            for _ in 0..random.below(3) {
                let inertia = if random.below(3) == 0 { 0.0 } else { random.between(1e-4, 0.05) };
                let at = [random.between(-0.1, 0.1), random.between(-0.1, 0.1)];
                masses.push(Mass { frame, amount: random.between(0.1, 4.0), at, inertia });
            }
        }
        let mut loads = Vec::new();
        for &on in of.quantities {
            if random.below(2) == 0 {
                loads.push(Load::random(on, random));
            }
        }
        Forces { loads, masses, gravity: [random.between(-3.0, 3.0), random.between(-10.0, 10.0)] }
    }

    /// Those that potential energy is known of.
    pub fn conservative(mut self) -> Forces {
        for load in &mut self.loads {
            (load.damping, load.push) = (0.0, 0.0);
        }
        self
    }
}

impl Load {
    fn random(on: Quantity, random: &mut Random) -> Load {
        let [force, length] = if on.is_angle() { [1.0, 1.0] } else { [50.0, 0.1] };
        Load {
            on,
            stiffness: random.between(0.2, 2.0) * force / length,
            rest: random.between(-1.0, 1.0) * length,
            damping: random.between(0.0, 0.1) * force / length,
            push: random.between(-1.0, 1.0) * force,
            pace: random.between(1.0, 9.0),
        }
    }
}

impl Quantity {
    pub fn is_angle(self) -> bool {
        matches!(self, Quantity::Angle(_) | Quantity::AngleBetween(..) | Quantity::Rotation(..))
    }

    pub fn written(self) -> String {
        match self {
            Quantity::X(point) => format!("x({point})"),
            Quantity::Y(point) => format!("y({point})"),
            Quantity::Distance(from, to) => format!("distance({from}, {to})"),
            Quantity::Angle(body) => format!("angle({body})"),
            Quantity::AngleBetween(from, to) => format!("angle({from}, {to})"),
            Quantity::Rotation(joint, _) => format!("rotation({joint})"),
            Quantity::Displacement { joint, .. } => format!("displacement({joint})"),
        }
    }
}

impl Equation {
    pub fn left(&self) -> String {
        if let [(factor, on)] = self.left
            && factor.to_bits() == 1.0_f64.to_bits()
        {
            return on.written();
        }
        let terms: Vec<String> =
            self.left.iter().map(|(factor, on)| format!("({factor}) * {}", on.written())).collect();
        terms.join(" + ")
    }
}

/// A text in the making. What it is to say beside what the skeleton says.
pub struct Text<'s> {
    pub skeleton: &'s Skeleton,
    pub forces: &'s Forces,
    pub seat: Option<Seat>,
    pub is_reversed: bool,
    /// Right sides of equations in place of their own.
    pub rights: &'s [(&'s str, String)],
    /// Declarations more.
    pub more: &'s str,
}

impl<'s> Text<'s> {
    pub fn of(skeleton: &'s Skeleton, forces: &'s Forces) -> Text<'s> {
        Text { skeleton, forces, seat: None, is_reversed: false, rights: &[], more: "" }
    }

    pub fn written(&self) -> String {
        let mut items = self.items();
        if self.is_reversed {
            items.reverse();
        }
        let name = self.skeleton.name;
        let [gx, gy] = self.forces.gravity;
        let gravity = format!("gravity ({gx}, {gy})\n analysis from 0 to 0.5 every 0.1\n");
        let Some(Seat { pose: [x, y, phi], is_mirrored, turning }) = self.seat else {
            return format!("mechanism {name} {{\n {}\n {gravity}}}\n", items.join("\n "));
        };
        let mirrored = if is_mirrored { " mirrored" } else { "" };
        let (table, on) = match turning {
            None => (String::new(), ""),
            Some([speed, growth]) => {
                let table = "ground { point O = (0.3, 0.2) }\n body turntable at (0.3, 0.2, 0) { point O = (0, 0) }\n \
                             joint pivot: revolute(ground.O, turntable.O)\n";
                (format!("{table} driver spin: rotation(pivot) = {speed} * t + {growth} * t^2\n"), " on turntable")
            }
        };
        format!(
            "mechanism outer {{\n {table} part p: {name}(){on} at ({x}, {y}, {phi}){mirrored}\n {gravity}}}\n\
             mechanism {name} {{\n {}\n}}\n",
            items.join("\n ")
        )
    }

    fn items(&self) -> Vec<String> {
        let Text { skeleton, forces, .. } = self;
        let mut items: Vec<String> =
            skeleton.frames.iter().enumerate().map(|(k, frame)| self.frame(k, frame)).collect();
        items.extend(skeleton.joints.iter().map(|joint| format!("joint {}: {}", joint.name, joint.call)));
        for equation in skeleton.equations {
            let Equation { word, name, right, .. } = equation;
            let other = self.rights.iter().find(|(known, _)| known == name).map(|(_, right)| right.as_str());
            items.push(format!("{word} {name}: {} = {}", equation.left(), other.unwrap_or(right)));
        }
        for (k, load) in forces.loads.iter().enumerate() {
            let Load { stiffness, rest, damping, push, pace, .. } = load;
            let on = load.on.written();
            let [force, length] = if load.on.is_angle() { ["N * m", ""] } else { ["N", " m"] };
            let per = if load.on.is_angle() { "N * m" } else { "N / m" };
            items.push(format!(
                "load l{k}: -({stiffness} {per}) * ({on} - ({rest}{length})) - ({damping} {per} * s) * der({on}) \
                 + ({push} {force}) * sin({pace} rad/s * t) on {on}"
            ));
        }
        items.push(self.more.to_owned());
        items
    }

    fn frame(&self, number: usize, frame: &Frame) -> String {
        let [x, y, phi] = frame.at;
        let mut text = match number {
            0 => "ground {".to_owned(),
            _ => format!("body {} at ({x}, {y}, {phi}) {{", frame.name),
        };
        for (name, [x, y]) in frame.points {
            let _ = write!(text, " point {name} = ({x}, {y})");
        }
        for (name, through, [x, y]) in frame.axes {
            let _ = write!(text, " axis {name} = {through} along ({x}, {y})");
        }
        for (name, around, radius) in frame.circles {
            let _ = write!(text, " circle {name} = {around} radius {radius}");
        }
        for Mass { amount, at: [x, y], inertia, .. } in self.forces.masses.iter().filter(|mass| mass.frame == number) {
            let _ = write!(text, " mass {amount} at ({x}, {y}) inertia {inertia}");
        }
        text + " }"
    }
}
