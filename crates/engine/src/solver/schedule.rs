//! The schedule of a component: when its values are available, and how often they are computed.

/// A time in the execution of a component; later is greater. Rounds follow one another: the inputs of a block, its Newton loop, the values behind
/// that loop, the next loop, and so on.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct EvalTime {
    round: u32,
    phase: Phase,
}

/// The frequency of a computation.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Phase {
    Once,
    /// In each iteration of Newton.
    InLoop,
}

impl EvalTime {
    /// The time before all others, for undefined values.
    pub const NEVER: EvalTime = EvalTime { round: 0, phase: Phase::Once };

    /// Returns the time in the loop that begins now.
    pub fn in_loop(self) -> EvalTime {
        EvalTime { round: self.round, phase: Phase::InLoop }
    }

    /// Returns the time after the present round.
    pub fn after(self) -> EvalTime {
        EvalTime { round: self.round + 1, phase: Phase::Once }
    }

    pub fn is_in_loop(self) -> bool {
        self.phase == Phase::InLoop
    }
}
