//! Kinematics of mechanism `arm`, written by mechc 0.1.0 from `inputs.mech`.
//!
//! - coordinates `q`: 3 (m, rad), equations `phi = 0`: 3
//! - `phi_q`: 3 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 0; those that follow from others are worked out
//! - the motion: [`assemble`], then [`step`] from time to time
//! - the motion by its inputs: [`follow`] from [`Inputs`] to others
//! - needs no other crate
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op, clippy::neg_multiply)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

use runtime::blocks::Blocks;
use runtime::blocks::work_of;
use runtime::equations::Branches;
use runtime::equations::Checks;
use runtime::equations::Equations;
use runtime::error::Fault;
use runtime::follow::InputContinuation;
use runtime::pivoting::Pivoting;
use runtime::pivoting::close;
use runtime::pivoting::solve_with_pivoting;
use runtime::solution::Solved;
use runtime::state::Parameters;
use runtime::state::Time;
use runtime::state::Timed;

/// The mechanism has no parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Params;

impl Parameters for Params {
    fn towards(&self, _: &Self, _: f64) -> Self {
        Self
    }

    fn is_finite(&self) -> bool {
        true
    }
}

/// Number of coordinates, and of equations.
pub const N: usize = 3;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 3;

/// Coordinates (m, rad).
pub type Q = [f64; N];

/// Velocities (m/s, rad/s).
pub type Qd = [f64; N];

/// Accelerations (m/s^2, rad/s^2).
pub type Qdd = [f64; N];

/// Where each coordinate stands in `q`.
pub mod coordinate {
    /// `arm.x` (m), line 3
    pub const ARM_X: usize = 0;
    /// `arm.y` (m), line 3
    pub const ARM_Y: usize = 1;
    /// `arm.phi` (rad), line 3
    pub const ARM_PHI: usize = 2;
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `main 1` (m), line 4
    pub const MAIN_1: usize = 0;
    /// joint `main 2` (m), line 4
    pub const MAIN_2: usize = 1;
    /// driver `motor` (rad), line 6
    pub const MOTOR: usize = 2;
}

/// Row and column of each value that [`phi_q`] gives.
#[rustfmt::skip]
pub static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
    (0, 0),
    (1, 1),
    (2, 2),
];

/// The bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// `arm`, line 3
    Arm,
}

/// Where a body is, or how its place changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// (m)
    pub x: f64,
    /// (m)
    pub y: f64,
    /// (rad)
    pub phi: f64,
}

impl Pose {
    /// That of a body, out of the coordinates or their derivatives.
    #[rustfmt::skip]
#[must_use]
    pub fn of(q: &[f64; N], body: Body) -> Self {
        match body {
            Body::Arm => Self { x: q[0], y: q[1], phi: q[2] },
        }
    }
}

/// The residual of the equations, each in its unit: see [`row`].
///
/// 5 operations.
pub fn phi(q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_x = q[0];
    let arm_y = q[1];
    let arm_phi = q[2];

    let v1 = 2.0 * t;
    let v2 = v1 + 0.5235987755982988;
    let v3 = -arm_x;
    let v4 = -arm_y;
    let v5 = arm_phi - v2;

    out[0] = v3;
    out[1] = v4;
    out[2] = v5;
    out
}

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or
/// rad).
///
/// 0 operations.
pub fn phi_q(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = 1.0;
    out
}

/// The partial derivative of `phi` by time (the equation's unit per s).
///
/// 0 operations.
pub fn phi_t(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[2] = -2.0;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[2] = 2.0;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 0 operations.
pub fn gamma(_q: &[f64; N], _qd: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    [0.0; N]
}

/// The Jacobian as a full matrix, row by row.
pub fn phi_q_dense(q: &[f64; N], t: f64, p: &Params) -> [[f64; N]; N] {
    let mut full = [[0.0; N]; N];
    for (&(row, column), value) in PHI_Q_PATTERN.iter().zip(phi_q(q, t, p)) {
        if let Some(entry) = full.get_mut(row).and_then(|line| line.get_mut(column)) {
            *entry = value;
        }
    }
    full
}

pub use runtime::error::Error;
pub use runtime::limits::MOST_STEPS;
pub use runtime::state::Assembly;
pub use runtime::work::{Progress, Work};

/// The mechanism at a time.
pub type State = runtime::state::State<Model>;

impl State {
    /// Where a body is (m, m, rad).
    #[must_use]
    pub fn pose(&self, body: Body) -> Pose {
        Pose::of(self.q(), body)
    }

    /// How fast a body moves (m/s, m/s, rad/s).
    #[must_use]
    pub fn velocity(&self, body: Body) -> Pose {
        Pose::of(self.qd(), body)
    }

    /// How a body's velocity changes (m/s^2, m/s^2, rad/s^2).
    #[must_use]
    pub fn acceleration(&self, body: Body) -> Pose {
        Pose::of(self.qdd(), body)
    }

    /// The inputs: what they were followed to, or what their formulas say at this time.
    #[must_use]
    pub fn inputs(&self) -> Inputs {
        Inputs::of(&runtime::follow::signals(self))
    }
}

/// Evaluations that any call takes at most that is not told how many steps it may take.
pub const MOST_WORK: usize = most_work(MOST_STEPS);

/// Evaluations that [`assemble`] takes at most.
pub const MOST_WORK_TO_ASSEMBLE: usize = runtime::assemble::most_work::<Model>();

/// Evaluations that a call takes at most that may take so many steps.
#[must_use]
pub const fn most_work(most: usize) -> usize {
    runtime::step::most_work::<Model>(most)
}

/// Brings the mechanism to its first time with some parameters: along the branch that the file's
/// parameters give, where a short way leads there; else from the poses that the file draws with these
/// parameters, as `mechc run --set` does. `State::assembly` says which way it went.
///
/// # Errors
/// It cannot be assembled with these.
pub fn assemble(params: &Params) -> Result<State, Error> {
    counted::assemble(params, &mut Work::default())
}

/// Moves a state to time `t` (s), in steps as short as the motion asks for: position, velocity
/// and acceleration are those of the branch that it is on, whichever way `t` lies.
///
/// It takes [`MOST_STEPS`] steps at most, and mostly one: [`MOST_WORK`] evaluations, whatever it is
/// given. What a driver does and undoes within a
/// step, by formulas without branches, is not seen: no step is longer than [`LONGEST_STEP`].
///
/// # Errors
/// Why it cannot get there; the state is then bit for bit as it was.
pub fn step(t: f64, state: &mut State) -> Result<(), Error> {
    counted::step(t, state, &mut Work::default())
}

/// As [`step`], in so many steps at most, for those who have a deadline: [`most_work`] says how many
/// evaluations that are. A step that has to be made shorter counts as well. What these steps do not
/// reach is on its way: the same call goes on from there.
///
/// # Errors
/// Why it cannot get there; the state is then bit for bit as it was.
pub fn step_within(t: f64, state: &mut State, most: usize) -> Result<Progress, Error> {
    counted::step_within(t, state, most, &mut Work::default())
}

/// The same functions, which add the evaluations that they do to those of a [`Work`]: for tests of a
/// deadline, and for tables of what calls cost.
#[rustfmt::skip]
pub mod counted {
    #![allow(clippy::missing_errors_doc)] // they are those of the functions outside

    use super::*;

    /// The same, counted.
    pub fn assemble(params: &Params, work: &mut Work) -> Result<State, Error> {
        runtime::assemble::assemble(params, work)
    }

    /// The same, counted.
    pub fn step(t: f64, state: &mut State, work: &mut Work) -> Result<(), Error> {
        runtime::step::step(t, state, MOST_STEPS, work)
    }

    /// The same, counted.
    pub fn step_within(
        t: f64,
        state: &mut State,
        most: usize,
        work: &mut Work,
    ) -> Result<Progress, Error> {
        runtime::step::step_within(t, state, most, work)
    }

    /// The same, counted.
    pub fn follow(inputs: &Inputs, state: &mut State, work: &mut Work) -> Result<(), Error> {
        runtime::follow::follow(&inputs.signals(), state, MOST_STEPS_TO_FOLLOW, work)
    }

    /// The same, counted.
    pub fn follow_within(
        inputs: &Inputs,
        state: &mut State,
        most: usize,
        work: &mut Work,
    ) -> Result<Progress, Error> {
        runtime::follow::follow_within(&inputs.signals(), state, most, work)
    }
}

/// Number of results at a time.
pub const COLUMNS: usize = 10;

/// The first time of the file's analysis (s), at which the mechanism is assembled.
pub const START_TIME: f64 = 0.0;

/// How long the file's analysis takes (s).
const SPAN: f64 = 1.0;

/// The longest step (s).
pub const LONGEST_STEP: f64 = 0.03125;

/// The shortest step (s).
const SMALLEST_STEP: f64 = 1e-12;

/// What a change of each coordinate is judged against.
#[rustfmt::skip]
static SCALES: [f64; N] = [
    1.0, 1.0, 1.0,
];

/// The assembled position (m, rad).
#[rustfmt::skip]
static START: [f64; N] = [
    0.0, 0.0, 0.5235987755982988,
];

/// The mechanism with its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    params: Params,
}

/// Number of coordinates that Newton solves for; the others follow.
const TEARS: usize = 0;

/// What a change of each of them is judged against (m, or 1 rad).
static TEAR_SCALES: [f64; TEARS] = [];

/// Number of blocks of equations whose determinants change with the position.
const TURNS: usize = 0;

/// Whether they are negative where all pivots are positive.
static TURNED: [bool; TURNS] = [];

/// Number of places where formulas have branches.
const SIDES: usize = 0;

/// Which branch is taken at each: what a comparison gives, the number of a piece.
type Sides = [f64; SIDES];

/// What solves the equations at a time.
type Solution = runtime::solution::Solution<Model>;

/// Position, velocity and acceleration at a time. Every coordinate follows from those before it.
///
/// 1 operations.
fn solve(_guess: &[f64; TEARS], t: f64, _m: &Model, at: &mut Solution) {
    at.begin(t);
    let arm_phi = 2.0 * t + 0.5235987755982988;
    at.q[2] = arm_phi + 0.0;
    at.qd[2] = 2.0;
}

impl Equations for Model {
    type Q = Q;
    type Entries = [f64; ENTRIES];
    type Sides = Sides;

    fn pattern() -> &'static [(usize, usize)] {
        &PHI_Q_PATTERN
    }

    fn scales() -> &'static Q {
        &SCALES
    }

    fn phi(&self, q: &Q, t: f64, _sides: &Sides) -> Q {
        phi(q, t, &self.params)
    }

    fn phi_q(&self, q: &Q, t: f64, _sides: &Sides) -> Self::Entries {
        phi_q(q, t, &self.params)
    }

    fn nu(&self, q: &Q, t: f64, _sides: &Sides) -> Q {
        nu(q, t, &self.params)
    }

    fn gamma(&self, q: &Q, qd: &Qd, t: f64, _sides: &Sides) -> Qdd {
        gamma(q, qd, t, &self.params)
    }
}

impl Branches for Model {}

impl Checks for Model {
    type Monitors = [bool; 0];
}

impl Solved for Model {
    type Tears = [f64; TEARS];
    type Turns = [bool; TURNS];
    type Measures = ();
    type Joined = [f64; 0];
    type Along = Time;

    fn tear_scales() -> &'static Self::Tears {
        &TEAR_SCALES
    }

    fn turned() -> &'static Self::Turns {
        &TURNED
    }

    #[rustfmt::skip]
    fn tears(_q: &Q) -> Self::Tears {
        []
    }

    fn solve(&self, guess: &Self::Tears, t: f64, _sides: &Sides, at: &mut Solution) {
        solve(guess, t, self, at);
    }

    fn pivoted(&self, q: &Q, t: f64, sides: &Sides, _at: &Solution) -> Result<Solution, Fault> {
        solve_with_pivoting(self, q, t, sides)
    }
}

/// The width of a cell of each coordinate's grid.
#[rustfmt::skip]
static CELLS: [f64; N] = [
    7.450580596923828e-9, 7.450580596923828e-9, 7.450580596923828e-9,
];

/// Number of blocks of equations that can be solved one after the other.
const BLOCKS: usize = 3;

/// The blocks whose determinants change.
static TURNING: [usize; TURNS] = [];

/// Numbers that the elimination of the largest block works on.
const WORK: usize = work_of(1);

/// How the equations fall apart into blocks.
#[rustfmt::skip]
static EQUATIONS: Blocks<'static> = Blocks {
    sizes: &[
        1, 1, 1,
    ],
    rows: &[
        0, 1, 2,
    ],
    columns: &[
        0, 1, 2,
    ],
    starts: &[
        0, 1, 2, 3,
    ],
    entries: &[
        0, 1, 2,
    ],
    places: &[
        0, 1, 2,
    ],
    units: &[
        1.0, 1.0, 1.0,
    ],
};

impl Pivoting for Model {
    type Work = [f64; WORK];
    type Blocks = [bool; BLOCKS];
    type Varied = [f64; 0];
    type Rights = [Q; 0];

    const TOLERANCE: f64 = 1e-12;

    fn blocks() -> &'static Blocks<'static> {
        &EQUATIONS
    }

    fn turning() -> &'static [usize] {
        &TURNING
    }

    fn cells() -> &'static Q {
        &CELLS
    }

    fn rights(&self, _q: &Q, _t: f64, _sides: &Sides) -> [Q; 0] {
        []
    }

    fn measured(&self, _orders: [&Q; 4], _varied: &[f64; 0], _multipliers: &Q, _t: f64) {}
}

/// Where the file's poses put the coordinates, roughly: what is not closed yet.
///
/// 0 operations.
fn drawn(_p: &Params) -> [f64; N] {
    [0.0; N]
}

impl Timed for Model {
    type Params = Params;
    type Continuation = InputContinuation<following::Model, SIGNALS>;
    type Passed = [f64; 0];
    type Row = [f64; COLUMNS];

    const START_TIME: f64 = START_TIME;
    const SPAN: f64 = SPAN;
    const LONGEST_STEP: f64 = LONGEST_STEP;
    const SMALLEST_STEP: f64 = SMALLEST_STEP;

    fn new(params: &Params) -> Self {
        Self { params: *params }
    }

    fn params(&self) -> &Params {
        &self.params
    }

    fn start() -> &'static Q {
        &START
    }

    fn drawn(&self) -> Q {
        drawn(&self.params)
    }

    fn closed(&self, q: &Q, t: f64, work: &mut Work) -> Option<Q> {
        close(self, q, t, work)
    }
}

/// What is given of an input, in SI: its value, and how that changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Signal {
    /// The value.
    pub value: f64,
    /// Its first time derivative.
    pub rate: f64,
    /// Its second time derivative.
    pub acceleration: f64,
}

/// Number of inputs.
pub const INPUTS: usize = 1;

/// Number of signals: time is one where formulas hold it beside inputs.
const SIGNALS: usize = 1;

/// Where each input stands in what [`influence`] gives.
pub mod input {
    /// `turn` (a pure number)
    pub const TURN: usize = 0;
}

/// What comes from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {
    /// `turn` (a pure number)
    pub turn: Signal,
}

impl Inputs {
    /// What the text's formulas say at a time (s).
    #[must_use]
    pub fn at(t: f64, params: &Params) -> Self {
        use runtime::input_path::InputDriven;

        Self::of(&following::Model::by_formulas(params, t))
    }

    #[rustfmt::skip]
    fn of([values, rates, accelerations]: &[[f64; SIGNALS]; 3]) -> Self {
        Self {
            turn: Signal { value: values[0], rate: rates[0], acceleration: accelerations[0] },
        }
    }

    /// Values, rates and accelerations.
    #[rustfmt::skip]
    fn signals(&self) -> [[f64; SIGNALS]; 3] {
        let all = [self.turn];
        [all.map(|of| of.value), all.map(|of| of.rate), all.map(|of| of.acceleration)]
    }
}

impl runtime::follow::Follows<following::Model, SIGNALS> for Model {
    const HAS_TIME: bool = false;
}

pub use runtime::limits::MOST_STEPS_TO_FOLLOW;

/// Evaluations that [`follow`] takes at most.
#[rustfmt::skip]
pub const MOST_WORK_TO_FOLLOW: usize = runtime::follow::most_work::<following::Model, SIGNALS>(MOST_STEPS_TO_FOLLOW);

/// Leads a state from its inputs to others, along the straight line between them, in as many steps
/// as the branch asks for; their rates and accelerations there decide velocities and accelerations.
///
/// It takes [`MOST_STEPS_TO_FOLLOW`] steps at most, and mostly one: [`MOST_WORK_TO_FOLLOW`]
/// evaluations, whatever it is given. A kink of a formula on the way is passed. What a measure makes
/// of more than the accelerations of inputs has no value. [`step`] goes on by the text's formulas: it
/// first leads back to what these say of the inputs at the state's time.
///
/// # Errors
/// Why it cannot get there; the state is then bit for bit as it was. [`Error::TooFar`] is told at
/// once of an input that changes by more than `State::largest_change`.
pub fn follow(inputs: &Inputs, state: &mut State) -> Result<(), Error> {
    counted::follow(inputs, state, &mut Work::default())
}

/// As [`follow`], in so many steps at most, for those who have a deadline: [`most_work`] says how
/// many evaluations that are. A step that has to be made shorter counts as well. What these steps do
/// not reach is on its way: the same call goes on from there, and inputs, coordinates and measures of
/// the state are those of the place that it has come to.
///
/// # Errors
/// Why it cannot get there; the state is then bit for bit as it was.
pub fn follow_within(inputs: &Inputs, state: &mut State, most: usize) -> Result<Progress, Error> {
    counted::follow_within(inputs, state, most, &mut Work::default())
}

impl State {
    /// By input: the largest change that a call takes, by the numbers in [`input`]. One that asks for
    /// more is refused at once, as a value that an encoder never had. At first half a turn of an angle,
    /// and of a length twice the largest body; infinite where an input is neither.
    #[must_use]
    pub fn largest_change(&self) -> [f64; INPUTS] {
        let all = runtime::follow::largest_change(self);
        *all
    }

    /// Sets it; a state keeps that, and its clones do.
    pub fn set_largest_change(&mut self, largest: [f64; INPUTS]) {
        let all = runtime::follow::largest_change_mut(self);
        *all = largest;
    }
}

/// The derivatives of the coordinates by each input, by the numbers in [`input`]: for a constant
/// shift of it, along the branch that the state is on.
///
/// # Errors
/// The equations cannot be solved with the inputs as signals.
pub fn influence(state: &State) -> Result<[Q; INPUTS], Error> {
    runtime::follow::influence(state)
}

/// What follows inputs: along a way from 0 to 1, on which `t` is a place.
#[rustfmt::skip]
mod following {
    use super::*;

    use super::runtime::blocks::Blocks;
    use super::runtime::blocks::work_of;
    use super::runtime::equations::Branches;
    use super::runtime::equations::Checks;
    use super::runtime::equations::Equations;
    use super::runtime::error::Fault;
    use super::runtime::input_path::InputDriven;
    use super::runtime::input_path::Signals;
    use super::runtime::input_path::Slopes;
    use super::runtime::pivoting::Pivoting;
    use super::runtime::pivoting::solve_with_pivoting;
    use super::runtime::solution::Solved;

    /// Value, rate and acceleration of each signal by the text's formulas.
    ///
    /// 2 operations.
    fn by_formulas(t: f64, _p: &Params) -> [f64; 3 * SIGNALS] {
        let mut out = [0.0; 3 * SIGNALS];
        let v1 = 2.0 * t;
        let v2 = v1 + 0.5235987755982988;

        out[0] = v2;
        out[1] = 2.0;
        out
    }

    /// The path of the signals.
    type Path = super::runtime::input_path::InputPath<Params, SIGNALS>;

    const ENTRIES: usize = 3;

    /// Row and column of each value that `phi_q` gives.
    #[rustfmt::skip]
    static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
        (0, 0),
        (1, 1),
        (2, 2),
    ];

    /// The mechanism with its path.
    #[derive(Clone, Copy, Debug)]
    pub struct Model {
        path: Path,
    }

    /// Number of coordinates that Newton solves for; the others follow.
    const TEARS: usize = 0;

    /// What a change of each of them is judged against (m, or 1 rad).
    static TEAR_SCALES: [f64; TEARS] = [];

    /// Number of blocks of equations whose determinants change with the position.
    const TURNS: usize = 0;

    /// Whether they are negative where all pivots are positive.
    static TURNED: [bool; TURNS] = [];

    /// Number of places where formulas have branches.
    const SIDES: usize = 0;

    /// Which branch is taken at each: what a comparison gives, the number of a piece.
    type Sides = [f64; SIDES];

    /// What solves the equations at a time.
    type Solution = super::runtime::solution::Solution<Model>;

    /// Position, velocity and acceleration at a time. Every coordinate follows from those before it.
    ///
    /// 0 operations.
    fn solve(_guess: &[f64; TEARS], t: f64, m: &Model, at: &mut Solution) {
        at.begin(t);
        at.q[2] = m.path.value(0, t) + 0.0;
        at.qd[2] = m.path.rates[0] + 0.0;
        let arm_phi_dd = m.path.accelerations[0];
        at.qdd[2] = arm_phi_dd + 0.0;
        at.along.by_signal[0][2] = 1.0;
    }

    /// As [`super::phi`], with the signals of a way.
    ///
    /// 3 operations.
    fn phi(q: &[f64; N], t: f64, p: &Path) -> [f64; N] {
        let mut out = [0.0; N];
        let arm_x = q[0];
        let arm_y = q[1];
        let arm_phi = q[2];
        let turn = p.value(0, t);

        let v1 = -arm_x;
        let v2 = -arm_y;
        let v3 = arm_phi - turn;

        out[0] = v1;
        out[1] = v2;
        out[2] = v3;
        out
    }

    /// As [`super::phi_q`], with the signals of a way.
    ///
    /// 0 operations.
    fn phi_q(_q: &[f64; N], _t: f64, _p: &Path) -> [f64; ENTRIES] {
        let mut out = [0.0; ENTRIES];
        out[0] = -1.0;
        out[1] = -1.0;
        out[2] = 1.0;
        out
    }

    /// As [`super::nu`], with the signals of a way.
    ///
    /// 0 operations.
    fn nu(_q: &[f64; N], _t: f64, p: &Path) -> [f64; N] {
        let mut out = [0.0; N];
        let turn_d = p.rates[0];

        out[2] = turn_d;
        out
    }

    /// As [`super::gamma`], with the signals of a way.
    ///
    /// 0 operations.
    fn gamma(_q: &[f64; N], _qd: &[f64; N], _t: f64, p: &Path) -> [f64; N] {
        let mut out = [0.0; N];
        let turn_dd = p.accelerations[0];

        out[2] = turn_dd;
        out
    }

    impl Equations for Model {
        type Q = Q;
        type Entries = [f64; ENTRIES];
        type Sides = Sides;

        fn pattern() -> &'static [(usize, usize)] {
            &PHI_Q_PATTERN
        }

        fn scales() -> &'static Q {
            &SCALES
        }

        fn phi(&self, q: &Q, t: f64, _sides: &Sides) -> Q {
            phi(q, t, &self.path)
        }

        fn phi_q(&self, q: &Q, t: f64, _sides: &Sides) -> Self::Entries {
            phi_q(q, t, &self.path)
        }

        fn nu(&self, q: &Q, t: f64, _sides: &Sides) -> Q {
            nu(q, t, &self.path)
        }

        fn gamma(&self, q: &Q, qd: &Qd, t: f64, _sides: &Sides) -> Qdd {
            gamma(q, qd, t, &self.path)
        }
    }

    impl Branches for Model {}

    impl Checks for Model {
        type Monitors = [bool; 0];
    }

    impl Solved for Model {
        type Tears = [f64; TEARS];
        type Turns = [bool; TURNS];
        type Measures = ();
        type Joined = [f64; 0];
        type Along = Slopes<Q, SIGNALS>;

        fn tear_scales() -> &'static Self::Tears {
            &TEAR_SCALES
        }

        fn turned() -> &'static Self::Turns {
            &TURNED
        }

        #[rustfmt::skip]
        fn tears(_q: &Q) -> Self::Tears {
            []
        }

        fn solve(&self, guess: &Self::Tears, t: f64, _sides: &Sides, at: &mut Solution) {
            solve(guess, t, self, at);
        }

        fn pivoted(&self, q: &Q, t: f64, sides: &Sides, _at: &Solution) -> Result<Solution, Fault> {
            solve_with_pivoting(self, q, t, sides)
        }
    }

    /// The width of a cell of each coordinate's grid.
    #[rustfmt::skip]
    static CELLS: [f64; N] = [
        7.450580596923828e-9, 7.450580596923828e-9, 7.450580596923828e-9,
    ];

    /// Number of blocks of equations that can be solved one after the other.
    const BLOCKS: usize = 3;

    /// The blocks whose determinants change.
    static TURNING: [usize; TURNS] = [];

    /// Numbers that the elimination of the largest block works on.
    const WORK: usize = work_of(1);

    /// How the equations fall apart into blocks.
    #[rustfmt::skip]
    static EQUATIONS: Blocks<'static> = Blocks {
        sizes: &[
            1, 1, 1,
        ],
        rows: &[
            0, 1, 2,
        ],
        columns: &[
            0, 1, 2,
        ],
        starts: &[
            0, 1, 2, 3,
        ],
        entries: &[
            0, 1, 2,
        ],
        places: &[
            0, 1, 2,
        ],
        units: &[
            1.0, 1.0, 1.0,
        ],
    };

    /// The right sides of the equations for the derivatives of the coordinates by each signal.
    fn rights_by_signal(q: &Q, t: f64, p: &Path) -> [Q; SIGNALS] {
        let mut all = all_rights_by_signal(q, t, p).into_iter();
        let mut next = || all.next().unwrap_or(f64::NAN);
        core::array::from_fn(|_| core::array::from_fn(|_| next()))
    }

    /// The partial derivatives of the equations by each signal, negated, one behind the other.
    ///
    /// 0 operations.
    fn all_rights_by_signal(_q: &[f64; N], _t: f64, _p: &Path) -> [f64; N * SIGNALS] {
        let mut out = [0.0; N * SIGNALS];
        out[2] = 1.0;
        out
    }

    impl Pivoting for Model {
        type Work = [f64; WORK];
        type Blocks = [bool; BLOCKS];
        type Varied = [f64; 0];
        type Rights = [Q; SIGNALS];

        const TOLERANCE: f64 = 1e-12;

        fn blocks() -> &'static Blocks<'static> {
            &EQUATIONS
        }

        fn turning() -> &'static [usize] {
            &TURNING
        }

        fn cells() -> &'static Q {
            &CELLS
        }

        fn rights(&self, q: &Q, t: f64, _sides: &Sides) -> [Q; SIGNALS] {
            rights_by_signal(q, t, &self.path)
        }

        fn measured(&self, _orders: [&Q; 4], _varied: &[f64; 0], _multipliers: &Q, _t: f64) {}
    }

    impl InputDriven<SIGNALS> for Model {
        type Params = Params;

        const LARGEST_CHANGE: [f64; SIGNALS] = [3.141592653589793];

        fn new(path: &Path) -> Self {
            Self { path: *path }
        }

        fn path(&self) -> &Path {
            &self.path
        }

        fn path_mut(&mut self) -> &mut Path {
            &mut self.path
        }

        fn by_formulas(params: &Params, t: f64) -> Signals<SIGNALS> {
            let all = by_formulas(t, params);
            let get = |k: usize| all.get(k).copied().unwrap_or(f64::NAN);
            core::array::from_fn(|order| core::array::from_fn(|k| get(3 * k + order)))
        }
    }
}
