//! The magnitudes of moving quantities, which determine their rounding.

use crate::analysis::state::State;
use mechc_ir::CoordinateKind;

/// The largest magnitudes of a mechanism's coordinates, by time derivative: the rounding of a coordinate at rest is that of the moving ones.
#[derive(Clone, Copy, Default)]
pub(super) struct Largest {
    /// The magnitudes of lengths (m, m/s, m/s²).
    lengths: [f64; 3],
    /// The magnitudes of angles (rad, rad/s, rad/s²).
    angles: [f64; 3],
}

impl Largest {
    /// Records the coordinates of a state, whose kinds are given.
    pub fn note(&mut self, state: &State, kinds: impl Iterator<Item = CoordinateKind>) {
        for (k, kind) in kinds.enumerate() {
            let largest = match kind {
                CoordinateKind::Angle => &mut self.angles,
                CoordinateKind::Length => &mut self.lengths,
                CoordinateKind::Argument => continue,
            };
            for (largest, value) in largest.iter_mut().zip(state.tower(k)) {
                *largest = largest.max(value.abs());
            }
        }
    }

    /// Returns the least magnitude, by time derivative, that determines the rounding of a coordinate of a kind. Rotations and translations are
    /// converted into each other by the largest distance.
    fn of(&self, kind: CoordinateKind) -> [f64; 4] {
        let (lengths, angles) = (self.lengths, self.angles);
        let far = lengths[0];
        let turned = |length: f64| if far > 0.0 { length / far } else { 0.0 };
        match kind {
            CoordinateKind::Length => [far, lengths[1].max(angles[1] * far), lengths[2].max(angles[2] * far), 0.0],
            CoordinateKind::Angle => [1.0, angles[1].max(turned(lengths[1])), angles[2].max(turned(lengths[2])), 0.0],
            CoordinateKind::Argument => [0.0; 4],
        }
    }
}

/// The largest magnitudes so far of some moving quantities, each with three time derivatives.
pub(super) struct Magnitudes {
    largest: Vec<[f64; 4]>,
    /// The kind of each quantity that is a coordinate.
    kinds: Vec<Option<CoordinateKind>>,
    /// The magnitudes of the whole mechanism.
    of_all: Largest,
}

impl Magnitudes {
    /// Returns magnitudes of zero for quantities of some kinds; `None` for one that is not a coordinate.
    pub fn new(kinds: Vec<Option<CoordinateKind>>) -> Magnitudes {
        Magnitudes { largest: vec![[0.0; 4]; kinds.len()], kinds, of_all: Largest::default() }
    }

    /// Records a quantity with its time derivatives.
    pub fn note(&mut self, k: usize, tower: &[f64; 4]) {
        for (largest, value) in self.largest[k].iter_mut().zip(tower) {
            if value.is_finite() {
                *largest = largest.max(value.abs());
            }
        }
    }

    /// Records the largest magnitudes of the mechanism's coordinates.
    pub fn note_all(&mut self, of_all: Largest) {
        self.of_all = of_all;
    }

    /// Returns, for each quantity, the intervals of its value and time derivatives at a state, whose errors are parts of the largest magnitudes:
    /// `of_values` for values, `of_rates` for derivatives.
    pub fn around<'s>(
        &'s self,
        towers: impl IntoIterator<Item = [f64; 4]> + 's,
        [of_values, of_rates]: [f64; 2],
    ) -> impl Iterator<Item = [[f64; 2]; 4]> + 's {
        towers.into_iter().zip(&self.largest).zip(&self.kinds).map(move |((tower, largest), kind)| {
            let least = kind.map_or([0.0; 4], |kind| self.of_all.of(kind));
            [0, 1, 2, 3].map(|order| {
                let error = largest[order].max(least[order]) * if order == 0 { of_values } else { of_rates };
                [tower[order] - error, tower[order] + error]
            })
        })
    }
}
