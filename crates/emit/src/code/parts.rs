//! Partition of operations into functions of limited length.

use super::Code;
use mechc_engine::solver::{Segment, Tear};
use std::ops::Range;

/// Largest number of operations of a function: the time that rustc takes grows superlinearly.
const LONGEST_FUNCTION: usize = 2000;
/// Largest length of a loop over lanes, which should become vector instructions.
const LONGEST_LOOP: usize = 400;

/// Run of operations that becomes a function.
pub(super) enum Part<'c> {
    Straight(Vec<Piece<'c>>),
    /// Loop with a body so long that it consists of several functions.
    Loop {
        bodies: Vec<Range<usize>>,
        tears: &'c [Tear],
    },
}

pub(super) struct Piece<'c> {
    pub range: Range<usize>,
    /// Coordinates of a Newton loop.
    pub tears: Option<&'c [Tear]>,
}

impl<'c> Code<'c> {
    /// Splits the segments into parts that are short enough; with lanes each loop is a separate part.
    pub(super) fn parts(&self, has_lanes: bool) -> Vec<Part<'c>> {
        let longest = if has_lanes { LONGEST_LOOP } else { LONGEST_FUNCTION };
        let mut cut = Cut { parts: Vec::new(), pieces: Vec::new(), length: 0, longest };
        for segment in self.segments {
            match segment {
                Segment::Once(range) => cut.straight(range.clone()),
                Segment::Newton { instructions, tears } if has_lanes => cut.push(instructions.clone(), Some(tears)),
                Segment::Newton { instructions, tears } => cut.newton(instructions.clone(), tears),
            }
            if has_lanes {
                cut.close();
            }
        }
        cut.close();
        if cut.parts.is_empty() {
            cut.parts.push(Part::Straight(Vec::new()));
        }
        cut.parts
    }
}

/// Builder of parts.
struct Cut<'c> {
    parts: Vec<Part<'c>>,
    pieces: Vec<Piece<'c>>,
    length: usize,
    longest: usize,
}

impl<'c> Cut<'c> {
    fn straight(&mut self, range: Range<usize>) {
        let mut from = range.start;
        while from < range.end {
            let to = range.end.min(from + self.longest - self.length);
            self.push(from..to, None);
            from = to;
        }
    }

    fn newton(&mut self, range: Range<usize>, tears: &'c [Tear]) {
        if self.length + range.len() > self.longest {
            self.close();
        }
        if range.len() > LONGEST_FUNCTION {
            let starts = range.clone().step_by(LONGEST_FUNCTION);
            let bodies = starts.map(|from| from..range.end.min(from + LONGEST_FUNCTION)).collect();
            self.parts.push(Part::Loop { bodies, tears });
        } else {
            self.push(range, Some(tears));
        }
    }

    fn push(&mut self, range: Range<usize>, tears: Option<&'c [Tear]>) {
        self.length += range.len();
        self.pieces.push(Piece { range, tears });
        if self.length >= self.longest {
            self.close();
        }
    }

    fn close(&mut self) {
        if !self.pieces.is_empty() {
            self.parts.push(Part::Straight(std::mem::take(&mut self.pieces)));
        }
        self.length = 0;
    }
}
