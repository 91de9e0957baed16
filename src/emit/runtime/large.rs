/// Results of the solver, by their columns.
impl Results for Solution {
    fn store(&mut self, column: usize, value: f64) {
        if let Some(place) = self.place(column) {
            // 0 instead of -0
            *place = value + 0.0;
        }
    }

    fn stored(&self, column: usize) -> f64 {
        // the first column is the time
        let mut rest = column.wrapping_sub(1);
        for list in self.lists() {
            if let Some(value) = list.get(rest) {
                return *value;
            }
            rest = rest.wrapping_sub(list.len());
        }
        f64::NAN
    }

    fn bounded(&mut self, size: f64, bound: f64) {
        self.holds &= size <= bound;
    }

    fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
        if let Some(is_negative) = self.is_negative.get_mut(turn) {
            *is_negative ^= inverse < 0.0;
        }
        self.steepest = larger(self.steepest, inverse.abs() * weight);
    }
}

impl Solution {
//# if measures
    fn lists(&self) -> [&[f64]; $lists] {
        let [values, rates, accelerations] = self.measures.lists();
        [&self.q, values, &self.qd, rates, &self.qdd, accelerations$by_signal$joined]
    }
//# end
//# if !measures
    fn lists(&self) -> [&[f64]; $lists] {
        [&self.q, &self.qd, &self.qdd$by_signal]
    }
//# end

    fn place(&mut self, column: usize) -> Option<&mut f64> {
        let mut rest = column.wrapping_sub(1);
//# if measures
        let of = &mut self.measures;
        let lists: [&mut [f64]; $lists] = [
            &mut self.q,
            &mut of.values,
            &mut self.qd,
            &mut of.rates,
            &mut self.qdd,
            &mut of.accelerations,
//# if led
            self.by_signal.as_flattened_mut(),
//# end
//# if joined
            &mut self.joined,
//# end
        ];
//# end
//# if !measures
        let lists: [&mut [f64]; $lists] = [&mut self.q, &mut self.qd, &mut self.qdd$by_signal_mut];
//# end
        for list in lists {
            if rest < list.len() {
                return list.get_mut(rest);
            }
            rest = rest.wrapping_sub(list.len());
        }
        None
    }
}

/// Operations that follow each other, and the coordinates that they are repeated for.
struct Segment {
    code: [usize; 2],
//# if newton
    tears: [usize; 2],
//# end
}

/// Position, velocity and acceleration at a time, by the operations of [`SOLVE`].
#[rustfmt::skip]
fn solve(guess: &[f64; TEARS], t: f64, $m: &Model$sides_argument, at: &mut Solution) {
    at.begin(t);
//# if params
    let params = $p.list();
//# end
//# if !params
    let params = [];
//# end
    let inputs: Inputs<'_> = [&params, $known, $given_sides, &$time, &[], &[], &[], &[]$varied];
    let mut v = [0.0; REGISTERS];
    for segment in &SEGMENTS {
        let code = SOLVE.get(segment.code[0]..segment.code[1]).unwrap_or(&[]);
//# if newton
        let tears = SETTLING.get(segment.tears[0]..segment.tears[1]).unwrap_or(&[]);
        if tears.is_empty() {
            run(code, guess, &inputs, &mut v, at);
            continue;
        }
        let mut newton = Newton::new();
        for _ in 0..ITERATIONS {
            for (registers, sizes) in tears {
                if let Some(x) = v.get_mut(registers[0]) {
                    *x = on_grid(*x, sizes[0]);
                }
            }
            run(code, guess, &inputs, &mut v, at);
            for (registers, sizes) in tears {
                let delta = v.get(registers[1]).copied().unwrap_or(f64::NAN);
                if let Some(x) = v.get_mut(registers[0]) {
                    *x = newton.corrected(*x, delta, sizes[0], sizes[1]);
                }
            }
            if newton.is_done() {
                break;
            }
        }
        at.note(&newton);
//# end
//# if !newton
        run(code, guess, &inputs, &mut v, at);
//# end
    }
}
