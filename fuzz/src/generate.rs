//! Mechanisms made of bytes: element after element is hung onto what is there already, drawn where its equations hold at
//! the start, so that most of them assemble and move; and now and then something is taken away or said twice.

use mechc_expr::math;
use std::f64::consts::TAU;

/// Elements of one mechanism at most.
const MOST_ELEMENTS: usize = 4;

type Point = [f64; 2];

/// The text of the mechanism that bytes stand for. Every text is one.
#[must_use]
pub fn text(bytes: &[u8]) -> String {
    let mut bytes = Bytes::new(bytes);
    let mut draft = Draft::new(&mut bytes, "made");
    for _ in 0..=draft.pick(MOST_ELEMENTS) {
        draft.element();
    }
    draft.spoil();
    for k in 0..draft.pick(4) {
        draft.measure(k);
    }
    draft.written()
}

/// Bytes that choose; zeros when they are used up.
pub struct Bytes<'b>(std::slice::Iter<'b, u8>);

impl<'b> Bytes<'b> {
    #[must_use]
    pub fn new(bytes: &'b [u8]) -> Bytes<'b> {
        Bytes(bytes.iter())
    }

    pub fn byte(&mut self) -> u8 {
        self.0.next().copied().unwrap_or(0)
    }
}

/// The ground, or a body.
pub struct Body {
    pub name: String,
    /// Where its frame lies [m, m, rad].
    pose: [f64; 3],
    features: Vec<String>,
    /// The names of its points.
    pub points: Vec<String>,
}

/// A mechanism that grows.
pub struct Draft<'d, 'b> {
    bytes: &'d mut Bytes<'b>,
    /// What it is called.
    pub mechanism: String,
    /// Whether numbers have their units.
    pub units: bool,
    /// Whether it has many params and inputs.
    pub is_open: bool,
    /// The ground first.
    pub bodies: Vec<Body>,
    pub declarations: Vec<String>,
    /// What joints are called, those that turn and those that slide.
    pub turning: Vec<String>,
    sliding: Vec<String>,
    /// Params that are lengths, each with its value (m).
    pub params: Vec<(String, f64)>,
    /// Inputs that are pure numbers.
    pub inputs: Vec<String>,
    named: usize,
}

impl<'d, 'b> Draft<'d, 'b> {
    pub fn new(bytes: &'d mut Bytes<'b>, mechanism: &str) -> Draft<'d, 'b> {
        let ground = Body { name: "ground".to_owned(), pose: [0.0; 3], features: Vec::new(), points: Vec::new() };
        let mut draft = Draft {
            bytes,
            mechanism: mechanism.to_owned(),
            units: false,
            is_open: false,
            bodies: vec![ground],
            declarations: Vec::new(),
            turning: Vec::new(),
            sliding: Vec::new(),
            params: Vec::new(),
            inputs: Vec::new(),
            named: 0,
        };
        draft.units = draft.pick(2) == 1;
        draft
    }

    // ---- choices

    pub fn byte(&mut self) -> u8 {
        self.bytes.byte()
    }

    pub fn pick(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    pub fn chance(&mut self, of_256: u8) -> bool {
        self.byte() > 255 - of_256
    }

    /// Mostly about 1, rarely something else.
    pub fn number(&mut self) -> f64 {
        match self.byte() {
            255 => [0.0, 1e-9, 1e9, 1e-3, 1e3, -1e6, 1e-300, 1e300][self.pick(8)],
            b => (f64::from(b) - 127.0) / 48.0,
        }
    }

    /// Mostly above zero.
    pub fn size(&mut self) -> f64 {
        match self.byte() {
            255 => self.number(),
            b => 0.125 + f64::from(b) / 64.0,
        }
    }

    pub fn place(&mut self) -> Point {
        [self.number(), self.number()]
    }

    pub fn any_body(&mut self) -> usize {
        self.pick(self.bodies.len())
    }

    pub fn name(&mut self, word: &str) -> String {
        self.named += 1;
        let word = match self.byte() {
            0..=200 => word,
            201..=215 => "at",
            216..=230 => "größe",
            231..=245 => "spline",
            _ => "_",
        };
        format!("{word}{}", self.named)
    }

    // ---- numbers as text

    pub fn length(&mut self, metres: f64) -> String {
        if !self.units {
            return format!("{metres}");
        }
        let text = if self.chance(64) { format!("{metres} m") } else { format!("{} mm", metres * 1000.0) };
        if !self.chance(if self.is_open { 80 } else { 24 }) {
            return text;
        }
        let name = self.name("p");
        self.params.push((name.clone(), metres));
        self.declarations.push(format!("param {name} = {text}"));
        name
    }

    pub fn angle(&mut self, radians: f64) -> String {
        if self.units { format!("{} deg", radians.to_degrees()) } else { format!("{radians}") }
    }

    pub fn seconds(&self, seconds: f64) -> String {
        if self.units { format!("{seconds} s") } else { format!("{seconds}") }
    }

    // ---- formulas of time

    /// A formula that has a value at t = 0, or nearly so, and goes on from there by a scale.
    pub fn motion(&mut self, start: &str, scale: &str) -> String {
        let time = if self.units { "(t / 1 s)" } else { "t" };
        let fast = match self.byte() {
            0..=200 => 1.0,
            201..=240 => 3.0,
            // what is faster takes long, by its own fault
            _ => self.number().clamp(-3.0, 3.0),
        };
        let time = format!("({fast} * {time})");
        let (a, b) = (self.size() - 0.125, self.size());
        let kind = self.pick(22);
        let part = match kind {
            0 => time,
            1 => format!("sin({time})"),
            2..=7 => {
                let word = ["step", "step5", "step7", "harmonic", "cycloidal", "modsine"][kind - 2];
                format!("{word}({time}, {a}, 0, {}, 1)", a + b)
            }
            8 => format!("poly({time}, {a}, 0, 1, {b})"),
            9 => self.table(&time),
            10 => {
                let name = self.name("f");
                self.declarations.push(format!("fn {name}(u) = u^2 + {a} * sin(u)"));
                format!("{name}({time})")
            }
            11 => format!("(if {time} < {a} then 0 else ({time} - {a})^{})", 1 + self.pick(3)),
            12 => format!("mod({time} + {a}, {b})^2 * (mod({time} + {a}, {b}) - {b})^2"),
            13 => format!("(abs({time} - {a}) - {a})"),
            14 => format!("min({time}, {a})"),
            15 => format!("max(0, {time} - {a})^3"),
            16 => format!("(exp(sin({time})) - 1)"),
            17 => format!("(tanh({time}) + ln(1 + {time}))"),
            18 => format!("(sqrt({b} + {time}) - hypot({time}, {a}))"),
            19 => format!("atan2({time}, {a})"),
            20 => format!("sign({time} - {a}) * ({time} - {a})^2"),
            _ => format!("(1 / (1 + {b} + cos({time})) + asin(sin({time})))"),
        };
        if self.chance(if self.is_open { 160 } else { 16 }) {
            let name = self.name("signal");
            self.inputs.push(name.clone());
            self.declarations.push(format!("input {name} = {part}"));
            return format!("{start} + {scale} * {name}");
        }
        format!("{start} + {scale} * {part}")
    }

    /// A call of a new table, over the first second or round and round.
    fn table(&mut self, argument: &str) -> String {
        let (name, rows, periodic) = (self.name("table_"), 2 + self.pick(5), self.chance(128));
        let values: Vec<f64> = (0..rows).map(|_| self.number()).collect();
        let last = if periodic { values[0] } else { self.number() };
        let all = values.iter().chain([&last]).enumerate();
        let listed: Vec<String> = all.map(|(k, value)| format!("({}, {value})", k as f64 / rows as f64)).collect();
        let word = if periodic { "periodic spline" } else { "spline" };
        self.declarations.push(format!("table {name} = {word} [{}]", listed.join(", ")));
        let from_zero = if self.chance(200) { format!("({name}({argument}) - {name}(0))") } else { String::new() };
        if from_zero.is_empty() { format!("{name}({argument})") } else { from_zero }
    }

    pub fn turn(&mut self, start: f64) -> String {
        let (start, scale) = (self.angle(start), self.size().clamp(-20.0, 20.0));
        let scale = self.angle(scale);
        self.motion(&start, &scale)
    }

    fn way(&mut self, start: f64) -> String {
        let scale = self.number().clamp(-20.0, 20.0) * 0.25;
        let (start, scale) = (self.length(start), self.length(scale));
        self.motion(&start, &scale)
    }

    // ---- bodies and features

    pub fn body(&mut self) -> usize {
        let [x, y] = self.place();
        let phi = self.number();
        let name = self.name("b");
        self.bodies.push(Body { name, pose: [x, y, phi], features: Vec::new(), points: Vec::new() });
        self.bodies.len() - 1
    }

    fn turned(&self, body: usize, [x, y]: Point) -> Point {
        let (sin, cos) = math::sin_cos(self.bodies[body].pose[2]);
        [cos * x + sin * y, cos * y - sin * x]
    }

    fn local(&self, body: usize, [x, y]: Point) -> Point {
        let [ox, oy, _] = self.bodies[body].pose;
        self.turned(body, [x - ox, y - oy])
    }

    pub fn pair(&mut self, [x, y]: Point) -> String {
        let (x, y) = (self.length(x), self.length(y));
        format!("({x}, {y})")
    }

    pub fn feature(&mut self, body: usize, word: &str, rest: &str) -> String {
        let name = self.name(word);
        let (argument, body) = (if word == "curve" { "(u)" } else { "" }, &mut self.bodies[body]);
        body.features.push(format!("{word} {name}{argument} = {rest}"));
        if word == "point" {
            body.points.push(name.clone());
        }
        format!("{}.{name}", body.name)
    }

    pub fn point(&mut self, body: usize, at: Point) -> String {
        let local = self.local(body, at);
        let pair = self.pair(local);
        // a literal point of the ground needs no name
        if body == 0 && self.chance(64) { pair } else { self.feature(body, "point", &pair) }
    }

    fn axis(&mut self, body: usize, at: Point, along: Point) -> String {
        let (local, along) = (self.local(body, at), self.turned(body, along));
        let at = self.pair(local);
        let rest = if self.chance(64) {
            let to = self.pair([local[0] + along[0], local[1] + along[1]]);
            format!("{at} to {to}")
        } else {
            format!("{at} along ({}, {})", along[0], along[1])
        };
        self.feature(body, "axis", &rest)
    }

    fn circle(&mut self, body: usize, center: Point, radius: f64) -> String {
        let local = self.local(body, center);
        let (at, radius) = (self.pair(local), self.length(radius));
        self.feature(body, "circle", &format!("{at} radius {radius}"))
    }

    /// A curve through a place, with its tangent there; `hollow` is how far its middle lies to the left of the tangent.
    fn curve(&mut self, body: usize, at: Point, tangent: Point, hollow: f64) -> String {
        let ([px, py], [tx, ty]) = (self.local(body, at), self.turned(body, tangent));
        let (px, py, wide, high) = (self.length(px), self.length(py), self.size(), hollow);
        let (along, across) = match self.pick(4) {
            0 => ("sin(u)", "(1 - cos(u))"),
            1 => ("u", "u^2 / 2"),
            2 => ("u", "(if u < 0 then u^2 / 2 else u^2)"),
            _ => ("sin(u)", "(1 - cos(u) + sin(u)^3 / 8)"),
        };
        let unit = if self.units { "1 m * " } else { "" };
        let estimate = match self.byte() {
            0..=127 => " at 0",
            128..=170 => " at 0.25",
            _ => "",
        };
        let rest = format!(
            "({px} + {unit}({} * {along} - {} * {across}), {py} + {unit}({} * {along} + {} * {across})){estimate}",
            wide * tx,
            high * ty,
            wide * ty,
            high * tx,
        );
        self.feature(body, "curve", &rest)
    }

    pub fn joint(&mut self, call: &str) -> String {
        let name = self.name("j");
        self.declarations.push(format!("joint {name}: {call}"));
        name
    }

    pub fn driver(&mut self, equation: &str) {
        let name = self.name("d");
        self.declarations.push(format!("driver {name}: {equation}"));
    }

    fn pin(&mut self, a: usize, b: usize, at: Point) -> String {
        let (p, q) = (self.point(a, at), self.point(b, at));
        // a joint between two literal points joins nothing
        let joint = self.joint(&format!("revolute({p}, {q})"));
        self.turning.push(joint.clone());
        joint
    }

    fn guide(&mut self, a: usize, b: usize, at: Point, along: Point) -> String {
        let (v, w) = (self.axis(a, at, along), self.axis(b, at, along));
        let joint = self.joint(&format!("translational({v}, {w})"));
        self.sliding.push(joint.clone());
        joint
    }

    fn direction(&mut self) -> Point {
        let (sin, cos) = math::sin_cos(f64::from(self.byte()) / 256.0 * TAU);
        [cos, sin]
    }

    // ---- elements, each with as many equations as coordinates

    pub fn element(&mut self) {
        let (base, at, along) = (self.any_body(), self.place(), self.direction());
        match self.pick(17) {
            0 | 1 => self.crank(base, at),
            2 => {
                let body = self.body();
                let guide = self.guide(base, body, at, along);
                let way = self.way(0.0);
                self.driver(&format!("displacement({guide}) = {way}"));
            }
            3 => self.dyad(base, at, false),
            4 => self.dyad(base, at, true),
            5 => self.pin_in_slot(base, at, along),
            6 => self.link(base, at),
            7 => {
                let body = self.body();
                let (p, q) = (self.point(base, at), self.point(body, at));
                let angle = self.bodies[body].pose[2] - self.bodies[base].pose[2];
                let angle = self.angle(angle);
                self.joint(&format!("weld({p}, {q}, {angle})"));
            }
            8 => self.gears(base, at, along, false),
            9 => self.gears(base, at, along, true),
            10 => self.rack(base, at, along),
            11 => self.follower(base, at, along),
            12 | 13 => self.cam(base, at, along),
            14 => self.flat_follower(base, at, along),
            15 => self.steered(base, at),
            _ => self.coupled(base, at),
        }
    }

    fn crank(&mut self, base: usize, at: Point) {
        let body = self.body();
        let pin = self.pin(base, body, at);
        let start = self.bodies[body].pose[2] - self.bodies[base].pose[2];
        let turn = self.turn(start);
        self.driver(&format!("rotation({pin}) = {turn}"));
    }

    /// Two bodies between two others; the last joint may slide.
    fn dyad(&mut self, base: usize, at: Point, slides: bool) {
        let (other, knee, end, along) = (self.any_body(), self.place(), self.place(), self.direction());
        let (first, second) = (self.body(), self.body());
        self.pin(base, first, at);
        self.pin(first, second, knee);
        if slides {
            self.guide(other, second, end, along);
        } else {
            self.pin(second, other, end);
        }
    }

    fn pin_in_slot(&mut self, base: usize, at: Point, along: Point) {
        let (other, body, pin, offset) = (self.any_body(), self.body(), self.place(), self.number());
        self.pin(base, body, at);
        let (slotted, pinned) = if self.chance(128) { (body, other) } else { (other, body) };
        let p = self.point(pinned, pin);
        if self.chance(128) {
            let origin = [pin[0] + offset * along[1], pin[1] - offset * along[0]];
            let (slot, offset) = (self.axis(slotted, origin, along), self.length(offset));
            self.joint(&format!("revolute_translational({p}, {slot}, {offset})"));
        } else {
            let slot = self.axis(slotted, pin, along);
            self.joint(&format!("revolute_translational({p}, {slot})"));
        }
    }

    fn link(&mut self, base: usize, at: Point) {
        let (other, body, from, to) = (self.any_body(), self.body(), self.place(), self.place());
        self.pin(base, body, at);
        let (p, q) = (self.point(body, from), self.point(other, to));
        let distance = math::hypot(to[0] - from[0], to[1] - from[1]);
        match self.pick(3) {
            0 => {
                let distance = self.length(distance);
                self.joint(&format!("revolute_revolute({p}, {q}, {distance})"));
            }
            1 => {
                let way = self.way(distance);
                self.driver(&format!("distance({p}, {q}) = {way}"));
            }
            _ => {
                let (name, distance) = (self.name("c"), self.length(distance));
                self.declarations.push(format!("constraint {name}: distance({p}, {q}) = {distance}"));
            }
        }
    }

    fn gears(&mut self, base: usize, at: Point, along: Point, inside: bool) {
        let (other, wheel, small, large) = (self.any_body(), self.body(), self.size(), self.size());
        self.pin(base, wheel, at);
        let apart = if inside { large - small } else { large + small };
        let center = [at[0] + apart * along[0], at[1] + apart * along[1]];
        let (c, d) = (self.circle(wheel, at, small), self.circle(other, center, large));
        let [word, end] = match (inside, self.pick(4)) {
            (false, 0) => ["belt", ""],
            (false, 1) => ["belt", ", crossed"],
            (false, _) => ["gear", ""],
            (true, _) => ["internal_gear", ""],
        };
        self.joint(&format!("{word}({c}, {d}{end})"));
    }

    fn rack(&mut self, base: usize, at: Point, along: Point) {
        let (other, body, radius) = (self.any_body(), self.body(), self.size());
        let center = [at[0] - radius * along[1], at[1] + radius * along[0]];
        let (pinion, toothed) = if self.chance(128) {
            self.guide(base, body, at, along);
            (other, body)
        } else {
            self.pin(base, body, center);
            (body, other)
        };
        let (circle, axis) = (self.circle(pinion, center, radius), self.axis(toothed, at, along));
        let side = ["", ", 0, left", ", 0, right"][self.pick(3)];
        self.joint(&format!("rack_pinion({circle}, {axis}{side})"));
    }

    fn follower(&mut self, base: usize, at: Point, along: Point) {
        let (other, body, pivot, hollow) = (self.any_body(), self.body(), self.place(), self.number());
        self.pin(base, body, pivot);
        let (pointed, curved) = if self.chance(128) { (body, other) } else { (other, body) };
        let point = self.point(pointed, at);
        let curve = if self.chance(64) {
            let radius = self.size();
            self.circle(curved, [at[0] + radius * along[0], at[1] + radius * along[1]], radius)
        } else {
            self.curve(curved, at, along, hollow)
        };
        self.joint(&format!("point_follower({point}, {curve})"));
    }

    fn cam(&mut self, base: usize, at: Point, along: Point) {
        let (other, body, pivot) = (self.any_body(), self.body(), self.place());
        if self.chance(128) {
            self.pin(base, body, pivot);
        } else {
            let way = self.direction();
            self.guide(base, body, pivot, way);
        }
        let profile = |draft: &mut Self, body: usize, side: f64| {
            let radius = draft.size();
            if draft.chance(128) {
                let center = [at[0] - side * radius * along[1], at[1] + side * radius * along[0]];
                draft.circle(body, center, radius)
            } else {
                draft.curve(body, at, along, side * radius)
            }
        };
        let (k, m) = (profile(self, other, -1.0), profile(self, body, 1.0));
        self.joint(&format!("cam({k}, {m})"));
    }

    fn flat_follower(&mut self, base: usize, at: Point, along: Point) {
        let (other, body, pivot, hollow) = (self.any_body(), self.body(), self.place(), self.size());
        if self.chance(128) {
            self.pin(base, body, pivot);
        } else {
            let way = self.direction();
            self.guide(base, body, pivot, way);
        }
        let (flat, round) = if self.chance(128) { (body, other) } else { (other, body) };
        let curve = if self.chance(96) {
            let center = [at[0] - hollow * along[1], at[1] + hollow * along[0]];
            self.circle(round, center, hollow)
        } else {
            self.curve(round, at, along, hollow)
        };
        let axis = self.axis(flat, at, along);
        self.joint(&format!("flat_follower({curve}, {axis})"));
    }

    /// A body whose place is said by itself.
    fn steered(&mut self, base: usize, at: Point) {
        let (body, way_x, way_y) = (self.body(), self.way(at[0]), self.way(at[1]));
        let p = self.point(body, at);
        let start = self.bodies[body].pose[2];
        let name = self.bodies[body].name.clone();
        self.driver(&format!("x({p}) = {way_x}"));
        self.driver(&format!("{way_y} = y({p})"));
        if base == 0 || self.chance(128) {
            let turn = self.turn(start);
            self.driver(&format!("angle({name}) = {turn}"));
        } else {
            let turn = self.turn(start - self.bodies[base].pose[2]);
            let other = self.bodies[base].name.clone();
            self.driver(&format!("angle({other}, {name}) = {turn}"));
        }
    }

    /// A body whose turn follows from another's.
    fn coupled(&mut self, base: usize, at: Point) {
        let (body, name) = (self.body(), self.name("c"));
        let pin = self.pin(base, body, at);
        let start = self.bodies[body].pose[2] - self.bodies[base].pose[2];
        let start = self.angle(start);
        let ratio = self.number();
        let right = match (self.pick(4), self.turning.first().filter(|first| **first != pin)) {
            (0, _) | (_, None) => start,
            (1, Some(first)) => format!("{start} + {ratio} * rotation({first})"),
            (2, Some(first)) => format!("{start} + sin(rotation({first}))^2"),
            (_, Some(first)) => {
                let first = first.clone();
                let table = self.table(&format!("sin(rotation({first}))^2"));
                format!("{start} + {table}")
            }
        };
        self.declarations.push(format!("constraint {name}: rotation({pin}) = {right}"));
    }

    // ---- what is measured, and what is spoilt

    pub fn measure(&mut self, k: usize) {
        let (a, b, at, to) = (self.any_body(), self.any_body(), self.place(), self.place());
        let (p, q) = (self.point(a, at), self.point(b, to));
        let name = self.bodies[a].name.clone();
        let quantity = match self.pick(7) {
            0 => format!("y({p})"),
            1 => format!("distance({p}, {q})"),
            2 if a != 0 => format!("angle({name})"),
            3 => self.turning.last().map_or_else(|| "t".to_owned(), |joint| format!("rotation({joint})")),
            4 => self.sliding.last().map_or_else(|| "t".to_owned(), |joint| format!("displacement({joint})")),
            5 => format!("atan2(x({p}), y({p}))"),
            _ => format!("x({p}, {q})"),
        };
        // none that decides what is repeated, by which there is no derivative
        let param = self.params.last().map(|(name, _)| name.clone());
        let value = match (self.pick(8), param) {
            (7, Some(param)) => format!("der(der(der({quantity}, {param})), {param})"),
            (which, _) => measured(which, quantity),
        };
        self.declarations.push(format!("measure m{k} = {value}"));
    }

    /// Now and then one declaration less, or one twice.
    pub fn spoil(&mut self) {
        let count = self.declarations.len();
        match self.byte() {
            230..=239 if count > 0 => {
                let k = self.pick(count);
                self.declarations.remove(k);
            }
            240..=249 if count > 0 => {
                let (k, name) = (self.pick(count), self.name("again"));
                let twin = self.declarations[k].clone();
                let Some((word, (_, rest))) = twin.split_once(' ').and_then(|(w, r)| Some((w, r.split_once(':')?)))
                else {
                    return;
                };
                self.declarations.push(format!("{word} {name}:{rest}"));
            }
            250.. => {
                let name = self.name("free");
                self.bodies.push(Body { name, pose: [0.0; 3], features: Vec::new(), points: Vec::new() });
            }
            _ => {}
        }
    }

    /// The text of the mechanism.
    pub fn written(mut self) -> String {
        let mut text = format!("mechanism {} {{\n", self.mechanism);
        let (late, roughly) = (self.chance(64), self.chance(64));
        for k in 0..self.bodies.len() {
            let [mut x, y, mut phi] = self.bodies[k].pose;
            if roughly {
                // as a sketch is
                x += 0.02;
                phi -= 0.05;
            }
            let (pair, phi) = (self.pair([x, y]), self.angle(phi));
            let (body, pair) = (&self.bodies[k], pair.trim_end_matches(')'));
            let head = if k == 0 { "ground".to_owned() } else { format!("body {} at {pair}, {phi})", body.name) };
            text += &format!("{head} {{\n{}\n}}\n", body.features.join("\n"));
        }
        // the first billionth of an analysis is one moment to it, which must not be seconds
        let to = self.size().clamp(-4.0, 4.0);
        let (from, to) = if late { (0.5, 0.5 + to) } else { (0.0, to) };
        let every = self.seconds((to - from) / 8.0);
        let (from, to) = (self.seconds(from), self.seconds(to));
        text += &self.declarations.join("\n");
        text + &format!("\nanalysis from {from} to {to} every {every}\n}}\n")
    }
}

/// A formula of a kinematic quantity.
fn measured(which: usize, quantity: String) -> String {
    match which {
        0 => format!("der({quantity})"),
        1 => format!("der(der({quantity}))"),
        2 => format!("der(der(der({quantity})))"),
        3 => format!("abs({quantity})"),
        4 => format!("({quantity})^2 + ({quantity})^2"),
        5 => format!("max({quantity}, {quantity} / 2)"),
        _ => quantity,
    }
}
