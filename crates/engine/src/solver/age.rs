//! When, in the solution of a component, a value is known.

/// Rounds follow one another: what a block needs, its loop, what follows from that loop, the next loop, and so on. Later is greater.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Age {
    round: u32,
    when: When,
}

/// How often a value is computed.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum When {
    Once,
    /// Anew in each iteration of Newton.
    InLoop,
}

impl Age {
    /// Before all others: of what is not known.
    pub const NEVER: Age = Age { round: 0, when: When::Once };

    /// In the loop that begins now.
    pub fn in_loop(self) -> Age {
        Age { round: self.round, when: When::InLoop }
    }

    /// When what is under way has been done.
    pub fn after(self) -> Age {
        Age { round: self.round + 1, when: When::Once }
    }

    pub fn is_in_loop(self) -> bool {
        self.when == When::InLoop
    }
}
