//! How far rounding may be off in what moves.

/// The largest magnitudes that were seen of some things that move, each with three time derivatives: rounding goes by these.
pub(super) struct Sizes(Vec<[f64; 4]>);

impl Sizes {
    /// For so many things.
    pub fn new(count: usize) -> Sizes {
        Sizes(vec![[0.0; 4]; count])
    }

    /// Takes note of one of them with its derivatives.
    pub fn note(&mut self, k: usize, tower: &[f64; 4]) {
        for (largest, value) in self.0[k].iter_mut().zip(tower) {
            if value.is_finite() {
                *largest = largest.max(value.abs());
            }
        }
    }

    /// Of each one at a state, given with its derivatives by their orders, the intervals that they are in, if they are off by such parts of the
    /// largest: values and their derivatives.
    pub fn around<'s>(
        &'s self,
        towers: impl IntoIterator<Item = [f64; 4]> + 's,
        [of_places, of_rates]: [f64; 2],
    ) -> impl Iterator<Item = [[f64; 2]; 4]> + 's {
        let largest = |order: usize| self.0.iter().map(|largest| largest[order]).fold(0.0, f64::max);
        let fastest = if largest(0) > 0.0 { largest(1) / largest(0) } else { 0.0 };
        // what rests has the rounding of what does not
        let by_rate = [1.0, fastest, fastest * fastest, 0.0];
        towers.into_iter().zip(&self.0).map(move |(tower, largest)| {
            [0, 1, 2, 3].map(|order| {
                let size = largest[order].max(largest[0] * by_rate[order]);
                let off = size * if order == 0 { of_places } else { of_rates };
                [tower[order] - off, tower[order] + off]
            })
        })
    }
}
