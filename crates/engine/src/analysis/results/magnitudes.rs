//! How far rounding may be off in what moves.

use crate::analysis::state::State;
use mechc_ir::CoordinateKind;

/// The largest magnitudes of a mechanism's coordinates, by time derivative: what rests is as far off as what moves.
#[derive(Clone, Copy, Default)]
pub(super) struct Largest {
    /// In m and s.
    lengths: [f64; 3],
    /// In rad and s.
    angles: [f64; 3],
}

impl Largest {
    /// Records a state's coordinates, of which these are angles.
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

    /// Returns the least size, by time derivative, that rounding of a coordinate of this kind is a part of. A turn moves what is far away by
    /// a length, and the other way round.
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

/// The largest magnitudes that were seen of some things that move, each with three time derivatives: rounding goes by these.
pub(super) struct Magnitudes {
    largest: Vec<[f64; 4]>,
    /// The kind of each quantity that is a coordinate.
    kinds: Vec<Option<CoordinateKind>>,
    /// The magnitudes of the whole mechanism.
    of_all: Largest,
}

impl Magnitudes {
    /// Magnitudes of quantities of these kinds; `None` for one that is not a coordinate.
    pub fn new(kinds: Vec<Option<CoordinateKind>>) -> Magnitudes {
        Magnitudes { largest: vec![[0.0; 4]; kinds.len()], kinds, of_all: Largest::default() }
    }

    /// Records one of them with its derivatives.
    pub fn note(&mut self, k: usize, tower: &[f64; 4]) {
        for (largest, value) in self.largest[k].iter_mut().zip(tower) {
            if value.is_finite() {
                *largest = largest.max(value.abs());
            }
        }
    }

    /// Records how large the coordinates of the mechanism are.
    pub fn note_all(&mut self, of_all: Largest) {
        self.of_all = of_all;
    }

    /// Returns, for each quantity, the intervals of its value and derivatives at a state, if their errors are these parts of the largest
    /// magnitudes.
    pub fn around<'s>(
        &'s self,
        towers: impl IntoIterator<Item = [f64; 4]> + 's,
        [of_places, of_rates]: [f64; 2],
    ) -> impl Iterator<Item = [[f64; 2]; 4]> + 's {
        towers.into_iter().zip(&self.largest).zip(&self.kinds).map(move |((tower, largest), kind)| {
            let least = kind.map_or([0.0; 4], |kind| self.of_all.of(kind));
            [0, 1, 2, 3].map(|order| {
                let off = largest[order].max(least[order]) * if order == 0 { of_places } else { of_rates };
                [tower[order] - off, tower[order] + off]
            })
        })
    }
}
