/// Results with the derivatives by parameters behind them.
struct Derivatives<'a> {
    at: &'a mut Solution,
    by: &'a mut [Q; PARAMS],
}

impl Results for Derivatives<'_> {
    fn store(&mut self, column: usize, value: f64) {
        let place = column.checked_sub($results);
        match place.and_then(|place| self.by.as_flattened_mut().get_mut(place)) {
            Some(by) => *by = value + 0.0,
            None => self.at.store(column, value),
        }
    }

    fn stored(&self, column: usize) -> f64 {
        self.at.stored(column)
    }

    fn bounded(&mut self, size: f64, bound: f64) {
        self.at.bounded(size, bound);
    }

    fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
        self.at.pivot(turn, inverse, weight);
    }
}

