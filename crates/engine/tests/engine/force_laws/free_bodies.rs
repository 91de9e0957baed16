//! Free bodies: all forces and torques on each, by where they take hold, from a table's own columns.

use super::mechanisms::{Quantity, Reduced, Skeleton};
use super::texts::{Forces, Load, Seat};
use std::collections::HashMap;

/// Two components, and a moment about the outermost origin.
pub type Wrench = [f64; 3];

/// A place or a direction.
type Vector = [f64; 2];

/// A row of a table by the names of its columns.
pub struct Row<'t> {
    columns: &'t HashMap<String, usize>,
    values: &'t [f64],
}

impl<'t> Row<'t> {
    pub fn new(columns: &'t HashMap<String, usize>, values: &'t [f64]) -> Row<'t> {
        Row { columns, values }
    }

    pub fn get(&self, name: &str) -> f64 {
        self.values[*self.columns.get(name).unwrap_or_else(|| panic!("no column {name}"))]
    }

    fn body(&self, name: &str) -> Moving {
        let part = |ending: &str| ["x", "y", "phi"].map(|part| self.get(&format!("{name}.{part}{ending}")));
        Moving { pose: part(""), rate: part(".d"), acceleration: part(".dd") }
    }
}

/// A frame that moves.
#[derive(Clone, Copy, Default)]
struct Moving {
    pose: [f64; 3],
    rate: [f64; 3],
    acceleration: [f64; 3],
}

fn turned(phi: f64, [x, y]: Vector) -> Vector {
    [x * phi.cos() - y * phi.sin(), x * phi.sin() + y * phi.cos()]
}

fn cross([x, y]: Vector, [fx, fy]: Vector) -> f64 {
    x * fy - y * fx
}

impl Moving {
    fn place(&self, local: Vector) -> Vector {
        let [x, y] = turned(self.pose[2], local);
        [self.pose[0] + x, self.pose[1] + y]
    }

    fn acceleration_of(&self, local: Vector) -> Vector {
        let [x, y] = turned(self.pose[2], local);
        let (square, growth) = (self.rate[2] * self.rate[2], self.acceleration[2]);
        [self.acceleration[0] - square * x - growth * y, self.acceleration[1] - square * y + growth * x]
    }

    fn velocity_of(&self, local: Vector) -> Vector {
        let [x, y] = turned(self.pose[2], local);
        [self.rate[0] - self.rate[2] * y, self.rate[1] + self.rate[2] * x]
    }

    /// A frame that is fixed in this one.
    fn carried(&self, [x, y, phi]: [f64; 3]) -> Moving {
        let [place, rate, acceleration] = [self.place([x, y]), self.velocity_of([x, y]), self.acceleration_of([x, y])];
        Moving {
            pose: [place[0], place[1], self.pose[2] + phi],
            rate: [rate[0], rate[1], self.rate[2]],
            acceleration: [acceleration[0], acceleration[1], self.acceleration[2]],
        }
    }

    /// The power of a wrench on it.
    fn power(&self, [fx, fy, moment]: Wrench) -> f64 {
        let about_own = moment - cross([self.pose[0], self.pose[1]], [fx, fy]);
        fx * self.rate[0] + fy * self.rate[1] + about_own * self.rate[2]
    }
}

/// A mechanism at one time.
pub struct Moment<'t> {
    row: &'t Row<'t>,
    skeleton: &'t Skeleton,
    seat: Seat,
    prefix: &'static str,
    /// The ground first.
    frames: Vec<Moving>,
}

impl<'t> Moment<'t> {
    pub fn new(row: &'t Row<'t>, skeleton: &'t Skeleton, seat: Option<Seat>) -> Moment<'t> {
        let (prefix, seat) = (if seat.is_some() { "p." } else { "" }, seat.unwrap_or_default());
        let carrier = if seat.turning.is_some() { row.body("turntable") } else { Moving::default() };
        let bodies = skeleton.frames[1..].iter().map(|frame| row.body(&format!("{prefix}{}", frame.name)));
        let frames = std::iter::once(carrier.carried(seat.pose)).chain(bodies).collect();
        Moment { row, skeleton, seat, prefix, frames }
    }

    fn frame(&self, name: &str) -> usize {
        self.skeleton.frames.iter().position(|frame| frame.name == name).expect("a frame")
    }

    /// A direction or place of a frame's text, as the frame has it.
    fn local(&self, [x, y]: Vector) -> Vector {
        [x, self.seat.sign() * y]
    }

    /// The frame of a point, and where it is in that.
    fn point(&self, path: &str) -> (usize, Vector) {
        let (frame, name) = path.split_once('.').expect("a path");
        let frame = self.frame(frame);
        let (_, at) = self.skeleton.frames[frame].points.iter().find(|(known, _)| *known == name).expect("a point");
        (frame, self.local(*at))
    }

    fn place(&self, path: &str) -> (usize, Vector) {
        let (frame, at) = self.point(path);
        (frame, self.frames[frame].place(at))
    }

    /// What a force of 1 on a quantity is on each frame.
    pub fn unit_on(&self, on: Quantity) -> Vec<(usize, Wrench)> {
        let (sign, frames) = (self.seat.sign(), &self.frames);
        let pair = |[from, to]: [usize; 2], at: [Vector; 2], way: Vector| {
            let along = |factor: f64, place: Vector| {
                let force = [factor * way[0], factor * way[1]];
                [force[0], force[1], cross(place, force)]
            };
            vec![(from, along(-1.0, at[0])), (to, along(1.0, at[1]))]
        };
        let couple = |from: usize, to: usize| vec![(from, [0.0, 0.0, -sign]), (to, [0.0, 0.0, sign])];
        match on {
            Quantity::X(path) | Quantity::Y(path) => {
                let way = if matches!(on, Quantity::X(_)) { [1.0, 0.0] } else { [0.0, sign] };
                let (frame, place) = self.place(path);
                pair([0, frame], [place; 2], turned(frames[0].pose[2], way))
            }
            Quantity::Distance(from, to) => {
                let ((first, a), (second, b)) = (self.place(from), self.place(to));
                let way = [b[0] - a[0], b[1] - a[1]];
                let length = way[0].hypot(way[1]);
                pair([first, second], [a, b], way.map(|part| part / length))
            }
            Quantity::Angle(body) => couple(0, self.frame(body)),
            Quantity::AngleBetween(from, to) | Quantity::Rotation(_, [from, to]) => {
                couple(self.frame(from), self.frame(to))
            }
            Quantity::Displacement { from, along, to, .. } => {
                let ((first, _), (second, place)) = (self.point(from), self.place(to));
                let length = along[0].hypot(along[1]);
                let way = turned(frames[first].pose[2], self.local(along.map(|part| part / length)));
                pair([first, second], [place; 2], way)
            }
        }
    }

    pub fn value(&self, on: Quantity) -> f64 {
        let frames = &self.frames;
        let turn = |from: usize, to: usize| self.seat.sign() * (frames[to].pose[2] - frames[from].pose[2]);
        let between = |from: Vector, to: Vector| [to[0] - from[0], to[1] - from[1]];
        match on {
            Quantity::X(path) | Quantity::Y(path) => {
                let origin = [frames[0].pose[0], frames[0].pose[1]];
                let [x, y] = turned(-frames[0].pose[2], between(origin, self.place(path).1));
                if matches!(on, Quantity::X(_)) { x } else { self.seat.sign() * y }
            }
            Quantity::Distance(from, to) => {
                let [x, y] = between(self.place(from).1, self.place(to).1);
                x.hypot(y)
            }
            Quantity::Angle(body) => turn(0, self.frame(body)),
            Quantity::AngleBetween(from, to) | Quantity::Rotation(_, [from, to]) => {
                turn(self.frame(from), self.frame(to))
            }
            Quantity::Displacement { from, along, to, .. } => {
                let ((first, start), (_, end)) = (self.place(from), self.place(to));
                let length = along[0].hypot(along[1]);
                let way = turned(frames[first].pose[2], self.local(along.map(|part| part / length)));
                let [x, y] = between(start, end);
                x * way[0] + y * way[1]
            }
        }
    }

    pub fn rate(&self, on: Quantity) -> f64 {
        self.unit_on(on).into_iter().map(|(frame, wrench)| self.frames[frame].power(wrench)).sum()
    }

    fn load(&self, load: &Load) -> f64 {
        load.force(self.value(load.on), self.rate(load.on), self.row.get("t"))
    }

    fn effort(&self, equation: &str) -> f64 {
        self.row.get(&format!("{}{equation}.effort", self.prefix))
    }

    /// All wrenches on each frame, and what its masses ask for. They are the same.
    pub fn free_bodies(&self, forces: &Forces) -> Vec<(Vec<Wrench>, Wrench)> {
        let mut bodies: Vec<(Vec<Wrench>, Wrench)> = vec![(Vec::new(), [0.0; 3]); self.frames.len()];
        let mut add = |scale: f64, wrenches: Vec<(usize, Wrench)>| {
            for (frame, wrench) in wrenches {
                bodies[frame].0.push(wrench.map(|part| scale * part));
            }
        };
        for equation in self.skeleton.equations {
            for (factor, on) in equation.left {
                add(factor * self.effort(equation.name), self.unit_on(*on));
            }
        }
        for load in &forces.loads {
            add(self.load(load), self.unit_on(load.on));
        }
        for joint in self.skeleton.joints {
            let column = |ending: &str| self.row.get(&format!("{}{}.{ending}", self.prefix, joint.name));
            let force = [column("fx"), column("fy")];
            let torque = if joint.has_torque { column("torque") } else { 0.0 };
            let place = match joint.reduced_to {
                Reduced::To(path) => self.place(path).1,
                Reduced::ToContact { point, radius } => {
                    let (frame, [x, y]) = self.point(point);
                    let [dx, dy] = self.local(turned(column("u"), [radius, 0.0]));
                    self.frames[frame].place([x + dx, y + dy])
                }
            };
            let wrench = [force[0], force[1], torque + cross(place, force)];
            let [first, second] = joint.on.map(|name| self.frame(name));
            add(1.0, vec![(second, wrench), (first, wrench.map(|part| -part))]);
        }
        for mass in &forces.masses {
            let (frame, at) = (&self.frames[mass.frame], self.local(mass.at));
            let place = frame.place(at);
            let weight = forces.gravity.map(|part| mass.amount * part);
            let requested = frame.acceleration_of(at).map(|part| mass.amount * part);
            let turning = mass.inertia * frame.acceleration[2];
            let (given, needed) = &mut bodies[mass.frame];
            given.push([weight[0], weight[1], cross(place, weight)]);
            for (sum, part) in needed.iter_mut().zip([requested[0], requested[1], cross(place, requested) + turning]) {
                *sum += part;
            }
        }
        if self.seat.turning.is_some() {
            // on the turntable stand pivot and motor beside what the part feels of it
            let (place, force) = ([self.row.get("turntable.x"), self.row.get("turntable.y")], ["fx", "fy"]);
            let force = force.map(|ending| self.row.get(&format!("pivot.{ending}")));
            bodies[0].0.push([force[0], force[1], cross(place, force) + self.row.get("spin.effort")]);
        }
        bodies
    }

    /// The powers of efforts and loads, and of weights and inertia, the latter with the opposite sign. They add up to zero.
    pub fn powers(&self, forces: &Forces) -> Vec<f64> {
        let mut powers = Vec::new();
        for equation in self.skeleton.equations {
            let rate: f64 = equation.left.iter().map(|(factor, on)| factor * self.rate(*on)).sum();
            powers.push(self.effort(equation.name) * rate);
        }
        powers.extend(forces.loads.iter().map(|load| self.load(load) * self.rate(load.on)));
        for mass in &forces.masses {
            let (frame, at) = (&self.frames[mass.frame], self.local(mass.at));
            let ([vx, vy], [ax, ay]) = (frame.velocity_of(at), frame.acceleration_of(at));
            let [gx, gy] = forces.gravity;
            powers.push(-mass.amount * (vx * (ax - gx) + vy * (ay - gy)));
            powers.push(-mass.inertia * frame.rate[2] * frame.acceleration[2]);
        }
        powers
    }

    /// Of weights and springs (J).
    pub fn potential_energy(&self, forces: &Forces) -> f64 {
        let of_weight = forces.masses.iter().map(|mass| {
            let [x, y] = self.frames[mass.frame].place(self.local(mass.at));
            -mass.amount * (forces.gravity[0] * x + forces.gravity[1] * y)
        });
        let of_springs = forces.loads.iter().map(|load| {
            let stretch = self.value(load.on) - load.rest;
            0.5 * load.stiffness * stretch * stretch
        });
        of_weight.chain(of_springs).sum()
    }
}
