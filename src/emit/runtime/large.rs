/// Results of the solver, by their columns.
impl Results for Solution {
    fn store(&mut self, column: usize, value: f64) {
        if let Some(place) = self.place(column) {
            // 0 instead of -0
            *place = value + 0.0;
        }
    }

    fn stored(&self, column: usize) -> f64 {
        let mut copy = column;
        for list in self.lists() {
            if let Some(value) = list.get(copy) {
                return *value;
            }
            copy -= list.len();
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
    fn lists(&self) -> [&[f64]; $list_count] {
        $lists
    }

    fn place(&mut self, column: usize) -> Option<&mut f64> {
        let mut column = column;
        for list in $lists_mut {
            if column < list.len() {
                return list.get_mut(column);
            }
            column -= list.len();
        }
        None
    }
}

/// Operations that follow each other, and the coordinates that they are repeated for.
struct Segment {
    code: [usize; 2],
    tears: [usize; 2],
}

/// Position, velocity and acceleration at a time, by the operations of [`SOLVE`].
fn solve(guess: &[f64; TEARS], t: f64, m: &Model$sides_argument, at: &mut Solution) {
    at.begin(t);
    let params = m.params.list();
    let inputs: Inputs<'_> = [&params, $known, $given_sides, &[t], &[], &[], &[], &[]];
    let mut v = [0.0; REGISTERS];
    for segment in &SEGMENTS {
        let code = SOLVE.get(segment.code[0]..segment.code[1]).unwrap_or(&[]);
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
                    newton.correct(x, delta, sizes[0], sizes[1]);
                }
            }
            if newton.is_done() {
                break;
            }
        }
        at.note(&newton);
    }
}
