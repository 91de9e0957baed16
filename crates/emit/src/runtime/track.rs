//! Where something is on its way.

use super::solution::{Solution, Solved};

/// The solution of now, and the one before it or the next one in the making.
#[derive(Clone, Copy, Debug)]
pub struct Track<M: Solved> {
    pub(super) solutions: [Solution<M>; 2],
    /// Whether that of now is the second.
    pub(super) is_second: bool,
    /// Whether the one before lies on the same smooth motion.
    pub(super) is_smooth: bool,
    /// The step that goes well: a time (s), or a change of a signal.
    pub(super) stride: f64,
}

impl<M: Solved> Track<M> {
    /// The solution of now.
    #[inline]
    pub fn at(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// The same, to be written.
    #[inline]
    pub fn at_mut(&mut self) -> &mut Solution<M> {
        let [first, second] = &mut self.solutions;
        if self.is_second { second } else { first }
    }

    /// The one before, or the next one in the making.
    #[inline]
    pub fn other(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { first } else { second }
    }

    /// Both: that of now, and the other one, to be written.
    #[inline]
    pub fn both(&mut self) -> (&Solution<M>, &mut Solution<M>) {
        let [first, second] = &mut self.solutions;
        if self.is_second { (second, first) } else { (first, second) }
    }
}

/// What a track was before a call, which an error gives back bit for bit.
pub struct Checkpoint<M: Solved> {
    /// The time or place of the solution of then.
    t: f64,
    is_second: bool,
    is_smooth: bool,
    stride: f64,
    other: Solution<M>,
    /// The solution of then, once a second step is about to write over it.
    now: Option<Solution<M>>,
}

impl<M: Solved> Checkpoint<M> {
    /// What a track is now.
    #[inline]
    pub fn of(track: &Track<M>) -> Self {
        let Track { is_second, is_smooth, stride, .. } = *track;
        Self { t: track.at().t, is_second, is_smooth, stride, other: *track.other(), now: None }
    }

    /// Keeps the solution of then, which stands beside that of now after the first step.
    #[inline]
    pub fn keep(&mut self, track: &Track<M>) {
        if self.now.is_none() {
            self.now = Some(*track.other());
        }
    }

    /// Gives back what was.
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
