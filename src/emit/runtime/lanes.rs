/// The same for several variants of the mechanism, or several times, at once: in loops over the
/// lanes that a compiler turns into vector instructions. Each lane has the bits that it would have
/// alone.
pub mod lanes {
    // what is done in every lane reads best, and vectorises best, with the lane's number
    #![allow(clippy::needless_range_loop)]

    use super::*;

    /// Lanes that are worked on together.
    pub const LANES: usize = $lanes;

    /// A number in each lane.
    pub type Each = [f64; LANES];

    /// As many mechanisms, each with its own parameters, at a time of its own.
    #[derive(Clone, Debug)]
    pub struct States {
        models: [Model; LANES],
        /// The solutions of now and the ones before, or the next ones in the making.
        solutions: [Solutions; 2],
        /// Whether those of now are the second.
        is_second: bool,
        is_smooth: [bool; LANES],
        steepness: Each,
        step: Each,
//# if sides
        sides: [Sides; LANES],
//# end
//# if watches
        watched: [[bool; WATCHES]; LANES],
//# end
//# if inputs
        /// What follows inputs in each lane, and whether they have led there rather than the time.
        led: [following::Led; LANES],
        is_led: [bool; LANES],
//# end
    }

    impl States {
        /// The solutions of now.
        fn now(&self) -> &Solutions {
            let [first, second] = &self.solutions;
            if self.is_second { second } else { first }
        }

        /// The ones before, or the next ones in the making.
        fn other(&self) -> &Solutions {
            let [first, second] = &self.solutions;
            if self.is_second { first } else { second }
        }

        /// Both, to be changed: those of now, and the others.
        fn both(&mut self) -> (&mut Solutions, &mut Solutions) {
            let [first, second] = &mut self.solutions;
            if self.is_second {
                (second, first)
            } else {
                (first, second)
            }
        }

        /// The times (s).
        #[must_use]
        pub fn t(&self) -> &Each {
            &self.now().t
        }

        /// The coordinates (m, rad), by the indices in [`coordinate`].
        #[must_use]
        pub fn q(&self) -> &[Each; N] {
            &self.now().q
        }

        /// Their velocities (m/s, rad/s).
        #[must_use]
        pub fn qd(&self) -> &[Each; N] {
            &self.now().qd
        }

        /// Their accelerations (m/s^2, rad/s^2).
        #[must_use]
        pub fn qdd(&self) -> &[Each; N] {
            &self.now().qdd
        }

        /// A lane on its own; none where there is no such lane.
        #[must_use]
        pub fn get(&self, lane: usize) -> Option<State> {
            (lane < LANES).then(|| self.lane(lane))
        }

        /// A lane, which is below [`LANES`], on its own.
        fn lane(&self, k: usize) -> State {
            let [first, ..] = &self.models;
            let model = self.models.get(k).unwrap_or(first).clone();
//# if inputs
            let [first_led, ..] = &self.led;
//# end
            let mut solutions = [self.now().lane(k), self.other().lane(k)];
            for at in &mut solutions {
                at.is_settled = true;
//# if sides
                at.sides = self.sides.get(k).copied().unwrap_or([0.0; SIDES]);
//# end
//# if watches
                at.watched = self.watched.get(k).copied().unwrap_or([false; WATCHES]);
//# end
            }
            State {
                model,
                solutions,
                is_second: false,
                is_smooth: self.is_smooth.get(k).copied().unwrap_or(false),
                steepness: of(&self.steepness, k),
                step: of(&self.step, k),
//# if inputs
                led: self.led.get(k).unwrap_or(first_led).clone(),
                is_led: self.is_led.get(k).copied().unwrap_or(false),
//# end
//# if rims
                passed: [f64::NEG_INFINITY; RIMS],
//# end
            }
        }

        /// Moves a lane on its own, and leaves it among the other solutions.
        fn alone(&mut self, k: usize, t: f64) -> Result<(), Error> {
            let mut state = self.lane(k);
            // where the solution before was, the one that has been tried is now
            state.is_smooth = false;
            let result = step(t, &mut state);
            self.both().1.set_lane(k, state.at());
//# if inputs
            if let (Some(led), Some(is_led)) = (self.led.get_mut(k), self.is_led.get_mut(k)) {
                (*led, *is_led) = (state.led.clone(), state.is_led);
            }
//# end
            if let Some(is_smooth) = self.is_smooth.get_mut(k) {
                *is_smooth = false;
            }
            if let Some(step) = self.step.get_mut(k) {
                *step = state.step;
            }
//# if sides
            if let Some(sides) = self.sides.get_mut(k) {
                *sides = state.at().sides;
            }
//# end
//# if watches
            if let Some(watched) = self.watched.get_mut(k) {
                *watched = state.at().watched;
            }
//# end
            result
        }
    }

    /// Brings the mechanisms to the first time, each with its own parameters; says of each lane why
    /// it cannot be assembled, if it cannot. Such a lane has the parameters of the file.
    ///
    /// # Errors
    /// Not even the file's own mechanism can be assembled.
    #[rustfmt::skip]
    pub fn assemble(params: &[Params; LANES]) -> Result<(States, [Result<(), Error>; LANES]), Error> {
//# if params
        let one = super::assemble(&Params::default())?;
//# end
//# if !params
        let one = super::assemble(&Params)?;
//# end
        let mut states = States {
            models: core::array::from_fn(|_| one.model.clone()),
            solutions: [Solutions::ZERO, Solutions::ZERO],
            is_second: false,
            is_smooth: [false; LANES],
            steepness: [one.steepness; LANES],
            step: [LONGEST_STEP; LANES],
//# if inputs
            led: core::array::from_fn(|_| one.led.clone()),
            is_led: [false; LANES],
//# end
//# if sides
            sides: [one.at().sides; LANES],
//# end
//# if watches
            watched: [one.at().watched; LANES],
//# end
        };
        let mut results = [Ok(()); LANES];
        for (k, (params, result)) in params.iter().zip(&mut results).enumerate() {
            let found = super::assemble(params);
            *result = found.as_ref().map(|_| ()).map_err(|error| *error);
            let state = found.unwrap_or_else(|_| one.clone());
            states.both().0.set_lane(k, state.at());
            if let Some(model) = states.models.get_mut(k) {
                *model = state.model.clone();
            }
            if let Some(steepness) = states.steepness.get_mut(k) {
                *steepness = state.steepness;
            }
//# if inputs
            if let Some(led) = states.led.get_mut(k) {
                led.clone_from(&state.led);
            }
//# end
//# if sides
            if let Some(sides) = states.sides.get_mut(k) {
                *sides = state.at().sides;
            }
//# end
//# if watches
            if let Some(watched) = states.watched.get_mut(k) {
                *watched = state.at().watched;
            }
//# end
        }
        Ok((states, results))
    }

    /// Moves every lane to a time of its own (s). A lane that asks for more than one step, as any
    /// does that has further to go than [`LONGEST_STEP`], goes its way alone.
    ///
    /// What comes back says of each lane whether it has got there, and if not, why; it stays at the
    /// last time that it could reach.
    pub fn step_each(t: &Each, states: &mut States) -> [Result<(), Error>; LANES] {
        let is_done = advance(t, states);
        let mut results = [Ok(()); LANES];
        for k in 0..LANES {
            if !is_done[k] {
                results[k] = states.alone(k, t[k]);
            }
        }
        states.is_second = !states.is_second;
        results
    }

//# if inputs
    /// Leads every lane to inputs of its own, each with the bits that it would have alone, one after
    /// the other: lanes that follow share no vector instructions.
    ///
    /// What comes back says of each lane whether it has got there, and if not, why; it stays as it was.
    pub fn follow_each(
        inputs: &[Inputs; LANES],
        states: &mut States,
    ) -> [Result<(), Error>; LANES] {
        let mut results = [Ok(()); LANES];
        for (k, (inputs, result)) in inputs.iter().zip(&mut results).enumerate() {
            let mut state = states.lane(k);
            *result = follow(inputs, &mut state);
            states.both().0.set_lane(k, state.at());
            if let (Some(led), Some(is_led)) = (states.led.get_mut(k), states.is_led.get_mut(k)) {
                (*led, *is_led) = (state.led, state.is_led);
            }
            if let Some(is_smooth) = states.is_smooth.get_mut(k) {
                *is_smooth = false;
            }
        }
        results
    }

//# end
    /// Tries one step of every lane; says which ones have got there.
    fn advance(t: &Each, states: &mut States) -> [bool; LANES] {
        let [first, second] = &mut states.solutions;
        let (from, at) = if states.is_second {
            (second, first)
        } else {
            (first, second)
        };
        let from = &*from;
        let mut h = [0.0; LANES];
        for k in 0..LANES {
            h[k] = t[k] - from.t[k];
        }
//# if newton
        let mut back = [0.0; LANES];
        let mut u = [0.0; LANES];
        for k in 0..LANES {
            back[k] = from.t[k] - at.t[k];
            let ratio = h[k] / back[k];
            let is_known = states.is_smooth[k] && ratio.abs() <= FARTHEST_BEND;
            u[k] = if is_known { ratio } else { 0.0 };
        }
        let (x, v, a) = (tears(&from.q), tears(&from.qd), tears(&from.qdd));
        let (y, w, b) = (tears(&at.q), tears(&at.qd), tears(&at.qdd));
        let mut guess = [[0.0; LANES]; TEARS];
        let mut motion = [0.0; LANES];
        for i in 0..TEARS {
            for k in 0..LANES {
                // as `bend` has it
                let (h, back, u) = (h[k], back[k], u[k]);
                let (x, v, a) = (x[i][k], v[i][k], a[i][k]);
                let value = y[i][k] - x + back * (v - 0.5 * back * a);
                let slope = back * (v - back * a - w[i][k]);
                let curvature = 0.5 * back * back * (b[i][k] - a);
                let cubic = 4.0 * slope - 10.0 * value - curvature;
                let quartic = 7.0 * slope - 15.0 * value - 2.0 * curvature;
                let quintic = 3.0 * slope - 6.0 * value - curvature;
                let bend = u * u * u * (cubic + u * (quartic + u * quintic));
                let way = h * (v + 0.5 * h * a) + bend;
                guess[i][k] = x + way;
                motion[k] = larger(motion[k], way.abs() / TEAR_SCALES[i]);
            }
        }
//# end
//# if !newton
        let guess = [];
//# end
        solve(&guess, t, &states.models$lane_sides, at);
//# if newton
        let mut gap = [0.0; LANES];
        let (y, w, b) = (tears(&at.q), tears(&at.qd), tears(&at.qdd));
        for i in 0..TEARS {
            for k in 0..LANES {
                let rates = 0.5 * h[k] * (v[i][k] + w[i][k]);
                let bends = h[k] * h[k] * (1.0 / 12.0) * (a[i][k] - b[i][k]);
                let gap_here = y[i][k] - x[i][k] - rates - bends;
                gap[k] = larger(gap[k], gap_here.abs() / TEAR_SCALES[i]);
            }
        }
//# end
        let is_finite = at.are_finite();
        let mut is_done = [false; LANES];
        for k in 0..LANES {
            let is_short = h[k].abs() <= states.step[k] && h[k] != 0.0;
            let is_solved = at.strain[k] <= 1.0 && at.steepest[k] <= STEEP * states.steepness[k];
            let is_solved = is_solved && is_finite[k];
            is_done[k] = is_solved && is_short;
//# if inputs
            // time takes up where inputs have led
            is_done[k] &= !states.is_led[k];
//# end
        }
//# if newton
        for k in 0..LANES {
            let is_near = motion[k] <= LARGEST_MOTION && at.first[k] <= LARGEST_CORRECTION;
            is_done[k] &= is_near && at.open[k] <= HALF_A_CELL && gap[k] <= LARGEST_GAP;
        }
//# end
//# if pivots
        for i in 0..TURNS {
            for k in 0..LANES {
                is_done[k] &= (at.signs[i][k] ^ from.signs[i][k]) >> 63 == 0;
            }
        }
//# end
        for k in 0..LANES {
//# if checks
            is_done[k] = is_done[k] && keeps_branch(k, states);
//# end
            if is_done[k] {
//# if newton
                let first = states.other().first[k];
                let is_calm = first < LARGEST_CORRECTION / 12.0 && gap[k] < LARGEST_GAP / 100.0;
//# end
//# if !newton
                let is_calm = true;
//# end
                let size = h[k].abs();
                let longest = if is_calm { 2.0 * size } else { 0.0 };
                let shortest = if is_calm { states.step[k] } else { size };
                states.step[k] = f64::max(longest, shortest).min(LONGEST_STEP);
                states.is_smooth[k] = true;
            }
        }
        is_done
    }
//# if checks

    /// Whether a lane's next solution lies on the branches of formulas that it comes from.
    fn keeps_branch(k: usize, states: &States) -> bool {
        let (model, at) = (&states.models[k], states.other().lane(k));
        let t = at.t;
//# if rims
        if first_rim(states.now().t[k], t, model, &[f64::NEG_INFINITY; RIMS]).is_some() {
            return false;
        }
//# end
//# if sides
        let sides = &states.sides[k];
//# end
//# if motion
        let mut ahead = at.clone();
        ahead.sides = with_time(sides, &sides_at(t, model));
        if sides_ahead(&ahead, model) != *sides {
            return false;
        }
//# end
//# if !motion
//# if sides
        if sides_at(t, model) != *sides {
            return false;
        }
//# end
//# end
//# if conditions
        if !conditions_hold(&at.q, t, &model.params$sides) {
            return false;
        }
//# end
//# if left_out
        if !left_out_holds(&at.q, t, &model.params$sides) {
            return false;
        }
//# end
//# if watches
        let watched = watched(&at.q, t, &model.params$sides).map(|value| value > 0.0);
        if watched != states.watched[k] {
            return false;
        }
//# end
        true
    }
//# end

    /// What solves the equations in every lane.
    #[derive(Clone, Debug)]
    struct Solutions {
        t: Each,
        q: [Each; N],
        qd: [Each; N],
        qdd: [Each; N],
//# if measures
        values: [Each; MEASURES],
        rates: [Each; RATES],
        accelerations: [Each; ACCELERATIONS],
//# end
//# if joined
        /// What only measures need.
        joined: [Each; JOINED],
//# end
        /// By block: what has the sign of its determinant.
        signs: [[u64; LANES]; TURNS],
        /// Multipliers, residuals and angles beside what is bearable: 1 at most.
        strain: Each,
        /// Newton's largest first correction, scaled.
        first: Each,
        /// Its largest last correction, in cells of the grid.
        open: Each,
        /// One over the smallest pivot, scaled.
        steepest: Each,
    }

    impl Solutions {
        const ZERO: Self = Self {
            t: [0.0; LANES],
            q: [[0.0; LANES]; N],
            qd: [[0.0; LANES]; N],
            qdd: [[0.0; LANES]; N],
//# if measures
            values: [[0.0; LANES]; MEASURES],
            rates: [[0.0; LANES]; RATES],
            accelerations: [[0.0; LANES]; ACCELERATIONS],
//# end
//# if joined
            joined: [[0.0; LANES]; JOINED],
//# end
            signs: [[0; LANES]; TURNS],
            strain: [0.0; LANES],
            first: [0.0; LANES],
            open: [0.0; LANES],
            steepest: [0.0; LANES],
        };

        /// Makes ready for being solved for.
        fn begin(&mut self, t: &Each) {
            self.t = *t;
            let zero = [0.0; LANES];
            (self.strain, self.first, self.open, self.steepest) = (zero, zero, zero, zero);
            for (signs, is_negative) in self.signs.iter_mut().zip(&TURNED) {
                *signs = [u64::from(*is_negative) << 63; LANES];
            }
        }

        fn are_finite(&self) -> [bool; LANES] {
            let mut sum = [0.0; LANES];
            for each in self.q.iter().chain(&self.qd).chain(&self.qdd) {
                for k in 0..LANES {
                    sum[k] += 0.0 * each[k];
                }
            }
            sum.map(|sum| sum == 0.0)
        }

        /// A lane on its own.
        fn lane(&self, k: usize) -> Solution {
            let mut at = Solution::ZERO;
            at.t = of(&self.t, k);
            at.q = self.q.map(|each| of(&each, k));
            at.qd = self.qd.map(|each| of(&each, k));
            at.qdd = self.qdd.map(|each| of(&each, k));
//# if measures
            at.measures.values = self.values.map(|each| of(&each, k));
            at.measures.rates = self.rates.map(|each| of(&each, k));
            at.measures.accelerations = self.accelerations.map(|each| of(&each, k));
            at.measures.leave_out();
//# end
            for (is_negative, signs) in at.is_negative.iter_mut().zip(&self.signs) {
                *is_negative = signs.get(k).is_some_and(|sign| sign >> 63 == 1);
            }
            at.steepest = of(&self.steepest, k);
            at
        }

        fn set_lane(&mut self, k: usize, at: &Solution) {
            let put = |each: &mut Each, value: f64| {
                if let Some(place) = each.get_mut(k) {
                    *place = value;
                }
            };
            put(&mut self.t, at.t);
            put(&mut self.steepest, at.steepest);
            let all = self.q.iter_mut().chain(&mut self.qd).chain(&mut self.qdd);
            let values = at.q.iter().chain(&at.qd).chain(&at.qdd);
            for (each, value) in all.zip(values) {
                put(each, *value);
            }
//# if measures
            for (each, value) in self.values.iter_mut().zip(at.measures.values) {
                put(each, value);
            }
            for (each, rate) in self.rates.iter_mut().zip(at.measures.rates) {
                put(each, rate);
            }
            for (each, value) in self.accelerations.iter_mut().zip(at.measures.accelerations) {
                put(each, value);
            }
//# end
            for (signs, is_negative) in self.signs.iter_mut().zip(at.is_negative) {
                if let Some(sign) = signs.get_mut(k) {
                    *sign = u64::from(is_negative) << 63;
                }
            }
        }
//# if watched

        /// Takes note of a value that must not be above 1 when it is multiplied by a factor.
        #[inline]
        fn watch(&mut self, k: usize, value: f64, factor: f64) {
            self.strain[k] = larger(self.strain[k], value.abs() * factor);
        }
//# end
//# if pivots

        /// Takes note of one over a pivot, and of what makes that a pure number.
        #[inline]
        fn pivot(&mut self, k: usize, turn: usize, inverse: f64, weight: f64) {
            self.signs[turn][k] ^= inverse.to_bits();
            self.steepest[k] = larger(self.steepest[k], inverse.abs() * weight);
        }
//# end
    }

    /// The number of a lane.
    fn of(each: &Each, k: usize) -> f64 {
        each.get(k).copied().unwrap_or(f64::NAN)
    }
//# if newton

    /// An iteration of Newton in every lane, until all have settled or are lost.
    struct Settling {
        is_first: bool,
        first: Each,
        far: Each,
        open: Each,
    }

    impl Settling {
        fn new() -> Self {
            let zero = [0.0; LANES];
            Self {
                is_first: true,
                first: zero,
                far: zero,
                open: zero,
            }
        }

        fn begin(&mut self) {
            self.open = [0.0; LANES];
        }

        /// Corrects a coordinate whose grid has cells so wide, and which is judged against `scale`.
        #[inline]
        fn correct(&mut self, k: usize, x: &mut f64, delta: f64, cell: f64, scale: f64) {
            let size = delta.abs();
            self.far[k] = larger(self.far[k], size / scale);
            self.open[k] = larger(self.open[k], size / cell);
            *x += delta;
        }

        /// Whether no further iteration is needed, or none helps.
        fn is_done(&mut self) -> bool {
            if self.is_first {
                self.first = self.far;
                self.is_first = false;
            }
            let mut pairs = self.open.iter().zip(&self.far);
            let is_lost = |far: f64| far.is_nan() || far > LARGEST_CORRECTION;
            pairs.all(|(open, far)| *open <= HALF_A_CELL || is_lost(*far))
        }

        /// Leaves word of how it went.
        fn note(&self, at: &mut Solutions) {
            for k in 0..LANES {
                at.first[k] = larger(at.first[k], self.first[k]);
                at.open[k] = larger(at.open[k], self.open[k]);
                let lost = self.far[k] * (1.0 / LARGEST_CORRECTION);
                at.strain[k] = larger(at.strain[k], lost);
            }
        }
    }
//# end
//# if newton

    /// Out of all coordinates those that Newton solves for.
    #[rustfmt::skip]
    fn tears(q: &[Each; N]) -> [Each; TEARS] {
        $lane_tears
    }
//# end

