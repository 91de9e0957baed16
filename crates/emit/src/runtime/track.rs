//! Present and previous solution of a continuation.

use super::solution::{Solution, Solved};

/// The present solution, and the previous one or the next one in progress.
#[derive(Clone, Copy, Debug)]
pub struct Track<M: Solved> {
    pub(super) solutions: [Solution<M>; 2],
    /// True if the present solution is the second.
    pub(super) is_second: bool,
    /// True if the previous solution lies on the same smooth motion.
    pub(super) is_smooth: bool,
    /// Step size that works well: a time (s), or a change of a signal.
    pub(super) stride: f64,
}

impl<M: Solved> Track<M> {
    /// Returns the present solution.
    #[inline]
    pub fn at(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// Returns the present solution for modification.
    #[inline]
    pub fn at_mut(&mut self) -> &mut Solution<M> {
        let [first, second] = &mut self.solutions;
        if self.is_second { second } else { first }
    }

    /// Returns the previous solution, or the next one in progress.
    #[inline]
    pub fn other(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { first } else { second }
    }

    /// Returns the present solution, and the other one for modification.
    #[inline]
    pub fn both(&mut self) -> (&Solution<M>, &mut Solution<M>) {
        let [first, second] = &mut self.solutions;
        if self.is_second { (second, first) } else { (first, second) }
    }
}

/// Checkpoint of a track before a call, from which an error restores every bit.
pub struct Checkpoint<M: Solved> {
    /// Time or position of the solution at the checkpoint.
    t: f64,
    is_second: bool,
    is_smooth: bool,
    stride: f64,
    other: Solution<M>,
    /// The solution at the checkpoint, once a second step is about to overwrite it.
    now: Option<Solution<M>>,
}

impl<M: Solved> Checkpoint<M> {
    /// Creates a checkpoint of a track.
    #[inline]
    pub fn of(track: &Track<M>) -> Self {
        let Track { is_second, is_smooth, stride, .. } = *track;
        Self { t: track.at().t, is_second, is_smooth, stride, other: *track.other(), now: None }
    }

    /// Keeps the solution of the checkpoint, which is the other solution after the first step.
    #[inline]
    pub fn keep(&mut self, track: &Track<M>) {
        if self.now.is_none() {
            self.now = Some(*track.other());
        }
    }

    /// Restores the track.
    #[cold]
    pub fn restore(&self, track: &mut Track<M>) {
        (track.is_second, track.is_smooth, track.stride) = (self.is_second, self.is_smooth, self.stride);
        if let Some(now) = self.now {
            *track.at_mut() = now;
        }
        track.at_mut().t = self.t;
        *track.both().1 = self.other;
    }
}
