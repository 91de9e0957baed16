//! Many variants of the four-bar, beside its closed form: what a row, a motion, a result of a variant cost.

use crate::mechanisms::compile_as;
use crate::timing::{least, per_step};
use mechc::{Checked, Choice, Compiled, Memory, Parsed, SweepOptions, Swept, VaryOptions};
use std::f64::consts::PI;
use std::hint::black_box;

/// Variants that are enough to time one, side by side; what they share is made once and included.
const ABREAST: u32 = 20_000;
/// The same for larger mechanisms.
const FEW_ABREAST: u32 = 4_000;

/// The four-bar of the closed form, whose coupler and rocker may have other lengths.
fn four_bar(times: u32, more: &str) -> String {
    format!(
        "mechanism four_bar {{
            param rod = 3.5
            param arm = 3
            ground {{ point A = (0, 0) point B = (4, 0) }}
            body crank at (0, 0, 0.5) {{ point A = (0, 0) point C = (1, 0) }}
            body coupler at (0.88, 0.48, 0.78) {{ point C = (0, 0) point D = (rod, 0) }}
            body rocker at (3.7, 1.5, 1.8) {{ point B = (-arm / 2, 0) point D = (arm / 2, 0) }}
            joint main: revolute(ground.A, crank.A)
            joint pin: revolute(crank.C, coupler.C)
            joint knee: revolute(coupler.D, rocker.D)
            joint pivot: revolute(ground.B, rocker.B)
            driver motor: rotation(main) = 0.5 + 2 * t
            {more}
            analysis from 0 to {PI} every {}
        }}",
        PI / f64::from(times - 1)
    )
}

/// A mechanism, and what of it is varied.
struct Subject {
    text: String,
    params: [&'static str; 2],
    checked: Checked,
    compiled: Compiled,
    choice: Choice,
}

impl Subject {
    fn four_bar(times: u32, more: &str) -> Subject {
        Subject::new(four_bar(times, more), ["rod=3.4..3.6", "arm=2.9..3.1"])
    }

    fn new(text: String, params: [&'static str; 2]) -> Subject {
        let choice = Choice { lead: true, ..Choice::default() };
        let checked = Parsed::new("bench.mech", &text).check(&choice, &Memory::default());
        let compiled = compile_as(&text, &choice);
        Subject { text, params, checked, compiled, choice }
    }

    /// The columns but time.
    fn all_columns(&self) -> Vec<usize> {
        (1..self.compiled.columns().len()).collect()
    }

    /// ns a variant, of some columns; of results where none are wanted. Whoever has computed a block is done with it, as when he has made a
    /// table of it.
    fn per_variant(&self, columns: Option<&[usize]>, count: u32, jobs: usize) -> f64 {
        self.per_variant_made(columns, (count, jobs), |block| black_box(block).len(), |len| *len)
    }

    /// The same with what is made of blocks, which is handed to who asks for them; and how many variants that has.
    fn per_variant_made<T: Send + 'static>(
        &self,
        columns: Option<&[usize]>,
        (count, jobs): (u32, usize),
        make: impl Fn(Swept) -> T + Copy + Send + Sync + 'static,
        len: impl Fn(&T) -> usize,
    ) -> f64 {
        let vary = VaryOptions {
            params: self.params.map(str::to_owned).to_vec(),
            sample: Some(u64::from(count)),
            ..VaryOptions::default()
        };
        let variants = self.checked.variants(&vary, &self.choice, &Memory::default());
        let variants = variants.unwrap_or_else(|_| panic!("they vary: {}", self.text));
        let options =
            SweepOptions { columns: columns.map(<[usize]>::to_vec), jobs: Some(jobs), ..SweepOptions::default() };
        least(5, || {
            per_step(count, || {
                let blocks = self.checked.sweep(&self.compiled, &variants, &options, make).expect("times");
                let done: usize = blocks.map(|made| len(&black_box(made))).sum();
                assert_eq!(done, count as usize);
            })
        })
    }
}

/// ns a row of variants that go side by side, of so many times each, with all columns.
pub fn row_of_variants(text: String, params: [&'static str; 2], times: u32) -> f64 {
    let subject = Subject::new(text, params);
    subject.per_variant(Some(&subject.all_columns()), FEW_ABREAST, 1) / f64::from(times)
}

pub fn sweeps(floor: f64) {
    println!("variants of the four-bar, one thread");
    let turn = Subject::four_bar(360, "");
    let all = turn.all_columns();
    let one = turn.per_variant(Some(&all), ABREAST, 1);
    let row = one / 360.0;
    println!("  (a) rows: 360 times, 27 numbers            {row:>9.0} ns a row {:>7.2} x", row / floor);
    let two = Subject::four_bar(200, "").per_variant(Some(&[4, 5]), ABREAST, 1);
    println!("  (b) two columns of position, 200 times     {:>9.1} s for 1,000,000", two * 1e-3);
    let result = Subject::four_bar(360, "result farthest = max(x(coupler.C))").per_variant(None, ABREAST, 1);
    println!("  (c) the largest of a coordinate in a turn  {:>9.1} us a variant", result * 1e-3);
    let three = Subject::four_bar(3, "").per_variant(Some(&all), ABREAST, 1);
    println!("  (d) three times, leading over included     {:>9.1} us a variant", three * 1e-3);
    if std::thread::available_parallelism().is_ok_and(|cores| cores.get() > 1) {
        let by_two = turn.per_variant(Some(&all), ABREAST, 2);
        println!("  (a) by two threads                         {:>9.2} times as fast", one / by_two);
        let handed_over = turn.per_variant_made(Some(&all), (ABREAST, 2), |block| block, Swept::len);
        println!("      and all blocks handed to one of them   {:>9.2} times as fast", one / handed_over);
    }
    println!();
}
