//! When, in the solution of a component, a value is known.

/// Rounds follow one another: what a block needs, its loop, what follows from that loop, the next loop, and so on. Later is greater.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct EvalTime {
    round: u32,
    phase: Phase,
}

/// How often a value is computed.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Phase {
    Once,
    /// Anew in each iteration of Newton.
    InLoop,
}

impl EvalTime {
    /// Before all others: of what is not known.
    pub const NEVER: EvalTime = EvalTime { round: 0, phase: Phase::Once };

    /// In the loop that begins now.
    pub fn in_loop(self) -> EvalTime {
        EvalTime { round: self.round, phase: Phase::InLoop }
    }

    /// When what is under way has been done.
    pub fn after(self) -> EvalTime {
        EvalTime { round: self.round + 1, phase: Phase::Once }
    }

    pub fn is_in_loop(self) -> bool {
        self.phase == Phase::InLoop
    }
}
