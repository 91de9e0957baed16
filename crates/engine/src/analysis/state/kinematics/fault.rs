//! Faults of a state.

/// Reason why a state cannot be computed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Fault {
    /// An entry of Φ, Φ_q or a right side is not finite: its row.
    NotFinite { row: usize },
    /// Φ_q is singular, or nearer to it than can be trusted.
    Singular,
    /// Newton does not arrive, or asks for more than the predictor allows.
    TooFar,
    /// A formula that must be positive is not: its number.
    Condition { index: usize },
    /// A monitor changes its sign: its number.
    Monitor { index: usize },
    /// An equation that was left out ceases to hold: its number among the checks.
    Check { index: usize },
    /// Derivatives would be more rounding than digits.
    Uncertain,
    /// The equations that are solved come near to depending on each other where all equations together do not.
    Choice,
    /// The step passes a domain boundary that the motion decides, by its number, before a time (s).
    DomainBoundary { index: usize, t: f64 },
    /// The step passes an edge of a switch, by its number, before a time (s).
    Edge { t: f64, switch: usize },
}
