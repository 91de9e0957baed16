//! Reasons why an analysis stops, and events that it warns of, as data: the numerics decide by them, and
//! [`Stop::explain`] and [`Warning::explain`] turn them into words.

use super::determine::explain_dependent;
use super::errors::{self, StartVerdict};
use super::free_motion::motion_in_words;
use super::open_loop::OpenLoop;
use crate::analysis::state::{Horizon, Unknown};
use mechc_ir::{ConstraintSystem, DeclarationId};
use mechc_text::diag::{Code, Diagnostic, Label};

/// The place and the reason at which an analysis stops.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Time (s), or the fraction of a path from 0 to 1 where that stands for time.
    pub t: f64,
    /// Reason.
    pub cause: StopCause,
    /// Largest scaled residual of `Φ` at the last accepted state, where the reason was searched for there.
    pub residual: Option<f64>,
}

/// The reason of a [`Stop`].
///
/// Rows, conditions, monitors, checks, columns and loads are indices into the constraint system.
#[derive(Clone, Debug)]
pub enum StopCause {
    /// A formula of these declarations, or a derivative of it, is not finite.
    NotFinite {
        /// Declarations that hold the formula.
        declarations: Vec<DeclarationId>,
    },
    /// A condition of a formula does not hold: a distance, an interval, the range of a table.
    Condition {
        /// Index of the condition.
        index: usize,
    },
    /// A load is not finite.
    Load {
        /// Index of the load.
        index: usize,
        /// Index of the load's condition that does not hold.
        broken: Option<usize>,
    },
    /// A contact ends.
    NoContact {
        /// Index of the monitor of the contact.
        monitor: usize,
    },
    /// A flat follower touches a cusp.
    Undercut {
        /// Index of the monitor of the contact.
        monitor: usize,
    },
    /// A redundant equation that was left out does not hold any more.
    RedundantRow {
        /// Index of the check.
        check: usize,
    },
    /// A redundant equation that was left out does not hold where the others are assembled.
    RedundantRowAtStart {
        /// Index of the check.
        check: usize,
    },
    /// A dead point: a driver cannot move on.
    LockUp {
        /// Row of the driver.
        driver: usize,
        /// Singular position.
        singular: SingularPosition,
    },
    /// Two branches of the motion meet.
    Bifurcation {
        /// Singular position.
        singular: SingularPosition,
    },
    /// A driver rests in a dead point, from where two motions go on.
    RestInDeadPoint {
        /// Row of the driver.
        driver: usize,
        /// Joints and constraints that depend on each other.
        joints: Vec<DeclarationId>,
    },
    /// Rounding dominates the accelerations, so near is a singular position.
    Uncertain {
        /// Declarations that nearly depend on each other.
        declarations: Vec<DeclarationId>,
    },
    /// A position jumps.
    PositionJump {
        /// Declarations whose formulas jump.
        declarations: Vec<DeclarationId>,
        /// Coordinate that would have to jump furthest, and by how much (m or rad); `None` at a corner of a curve.
        jump: Option<(usize, f64)>,
        /// True if it may be that only the tangents of a contact's curve do not agree.
        is_corner: bool,
    },
    /// A velocity jumps.
    VelocityJump {
        /// Declarations whose formulas have the jump.
        declarations: Vec<DeclarationId>,
        /// Coordinate that jumps.
        column: usize,
        /// Its velocity before and after (m/s or rad/s).
        velocities: [f64; 2],
    },
    /// No step leads on, for none of the other reasons.
    NoStep {
        /// Row of the fastest driver.
        driver: Option<usize>,
    },
    /// Too many steps did not reach the next output time.
    TooFast {
        /// Row of the fastest driver.
        driver: Option<usize>,
        /// Next output time (s).
        target: f64,
        /// Number of steps.
        steps: u64,
    },
    /// A loop does not close.
    OpenLoop(Box<OpenLoop>),
    /// A position is not found, and no loop is to blame.
    NotAssembled {
        /// Row that stays open furthest.
        row: usize,
        /// Its residual, scaled.
        residual: f64,
    },
    /// The derivatives of an equation by all coordinates vanish in the assembled position.
    WithoutEffect {
        /// Row of the equation.
        row: usize,
    },
    /// The start is a singular position.
    SingularStart {
        /// Kind of the position.
        verdict: StartVerdict,
        /// Declarations that depend on each other.
        declarations: Vec<DeclarationId>,
        /// Right singular vector: the free motion, scaled, by coordinate.
        free: Vec<f64>,
        /// Columns that the free motion moves.
        columns: Vec<usize>,
        /// Time of the start and the span of the analysis.
        horizon: Horizon,
    },
    /// The equations along a path do not determine the mechanism.
    Undetermined(Box<Diagnostic>),
    /// The analysis stops on the way from its own first time (s) to the requested one.
    BeforeStart {
        /// First time of the mechanism's own analysis (s).
        from: f64,
        /// True if the requested time is earlier: rows and numbers of the reason are then those of a path back.
        is_backward: bool,
        /// Reason.
        stop: Box<Stop>,
    },
}

/// The declarations and coordinates that take part in a singular position.
#[derive(Clone, Debug)]
pub struct SingularPosition {
    /// Joints and constraints whose equations depend on each other, heaviest first.
    pub joints: Vec<DeclarationId>,
    /// Columns that the free motion moves.
    pub columns: Vec<usize>,
    /// Contact whose relative curvature vanishes there.
    pub flat_contact: Option<DeclarationId>,
}

impl StopCause {
    /// Makes a stop of the cause.
    #[must_use]
    pub fn at(self, t: f64) -> Box<Stop> {
        Box::new(Stop { t, cause: self, residual: None })
    }
}

impl Stop {
    /// Returns the stop before the start of an analysis, on the way there from the mechanism's own first time (s).
    #[must_use]
    pub(in crate::analysis) fn before_start(self: Box<Stop>, from: f64) -> Box<Stop> {
        let t = self.t;
        StopCause::BeforeStart { from, is_backward: false, stop: self }.at(t)
    }

    /// True if a velocity or position jumps there.
    #[must_use]
    pub fn is_jump(&self) -> bool {
        matches!(self.cause, StopCause::PositionJump { .. } | StopCause::VelocityJump { .. })
    }

    /// True if a driver cannot move on.
    #[must_use]
    pub fn is_dead_point(&self) -> bool {
        matches!(self.cause, StopCause::LockUp { .. } | StopCause::RestInDeadPoint { .. })
    }

    /// True if a formula has no value there.
    #[must_use]
    pub fn is_without_value(&self) -> bool {
        matches!(self.cause, StopCause::NotFinite { .. } | StopCause::Condition { .. } | StopCause::Load { .. })
    }

    /// Describes the stop of a system in words.
    #[must_use]
    pub fn explain(&self, system: &ConstraintSystem) -> Diagnostic {
        let diagnostic = self.cause.explain(system, self.t);
        match self.residual {
            Some(residual) => diagnostic.datum("residual", residual),
            None => diagnostic,
        }
    }
}

impl StopCause {
    fn explain(&self, system: &ConstraintSystem, t: f64) -> Diagnostic {
        match self {
            StopCause::NotFinite { declarations } => errors::formula_not_finite(system, declarations, t),
            StopCause::Condition { index } => errors::condition(system, &system.conditions()[*index], t),
            StopCause::Load { index, broken } => errors::load_not_finite(system, &system.loads()[*index], *broken, t),
            StopCause::NoContact { monitor } => errors::no_contact(system, *monitor, t),
            StopCause::Undercut { monitor } => errors::undercut(system, *monitor, t),
            StopCause::RedundantRow { check } => errors::ceases_to_hold(system, *check, t),
            StopCause::RedundantRowAtStart { check } => errors::does_not_hold(system, *check, t),
            StopCause::LockUp { driver, singular } => {
                singular.annotate(system, errors::lock_up(system, *driver, &singular.joints, &singular.columns, t))
            }
            StopCause::Bifurcation { singular } => {
                singular.annotate(system, errors::bifurcation(system, &singular.joints, &singular.columns, t))
            }
            StopCause::RestInDeadPoint { driver, joints } => errors::driver_rests(system, *driver, joints, t, false),
            StopCause::Uncertain { declarations } => errors::uncertain(system, declarations, t),
            StopCause::PositionJump { declarations, jump, is_corner } => {
                let (column, by) = jump.unwrap_or_default();
                errors::position_jump(system, declarations, *is_corner, column, by, t)
            }
            StopCause::VelocityJump { declarations, column, velocities } => {
                errors::velocity_jump(system, declarations, *column, *velocities, t)
            }
            StopCause::NoStep { driver } => errors::cannot_follow(system, t, *driver),
            StopCause::TooFast { driver, target, steps } => errors::too_fast(system, t, *target, *steps, *driver),
            StopCause::OpenLoop(open) => errors::open_loop(system, open, t),
            StopCause::NotAssembled { row, residual } => errors::cannot_assemble(system, *row, *residual, t),
            StopCause::WithoutEffect { row } => errors::without_effect(system, *row, t),
            StopCause::SingularStart { verdict, declarations, free, columns, horizon } => {
                let dependent =
                    if *verdict == StartVerdict::Always { explain_dependent(system, *horizon) } else { None };
                dependent.unwrap_or_else(|| {
                    errors::singular_start(system, declarations, columns, *verdict, t)
                        .note(motion_in_words(system, free))
                })
            }
            StopCause::Undetermined(diagnostic) => (**diagnostic).clone(),
            StopCause::BeforeStart { from, is_backward, stop } => {
                let inner = stop.explain(system);
                errors::before_start(if *is_backward { at_another_time(inner, t) } else { inner }, *from)
            }
        }
    }
}

impl SingularPosition {
    fn annotate(&self, system: &ConstraintSystem, diagnostic: Diagnostic) -> Diagnostic {
        match self.flat_contact {
            Some(joint) => errors::equal_curvatures(diagnostic, system, joint),
            None => diagnostic,
        }
    }
}

/// An event that an analysis goes beyond, and warns of.
#[derive(Clone, Debug)]
pub struct Warning {
    /// Time (s), or the fraction of a path from 0 to 1 where that stands for time.
    pub t: f64,
    /// Event.
    pub cause: WarningCause,
}

/// The event of a [`Warning`].
///
/// Columns, rows, loads and contacts are indices into the constraint system.
#[derive(Clone, Debug)]
pub enum WarningCause {
    /// A bifurcation was passed, along the branch that continues smoothly.
    Passed {
        /// Row of a driver that rests there in a dead point.
        driver: Option<usize>,
        /// Joints and constraints that depend on each other there.
        joints: Vec<DeclarationId>,
        /// Columns that the free motion moves.
        columns: Vec<usize>,
    },
    /// A bifurcation was passed on the way from the mechanism's own first time (s) to the requested one.
    PassedBeforeStart {
        /// First time of the mechanism's own analysis (s).
        from: f64,
        /// True if the requested time is earlier: rows and numbers of the event are then those of a path back.
        is_backward: bool,
        /// Event.
        warning: Box<Warning>,
    },
    /// The motion passes near a change point.
    NearChangePoint {
        /// Joints and constraints that nearly depend on each other.
        joints: Vec<DeclarationId>,
        /// Columns that the free motion moves.
        columns: Vec<usize>,
        /// Distance, as a part of the lengths.
        within: f64,
    },
    /// An acceleration jumps.
    AccelerationJump {
        /// Declarations whose formulas have the jump.
        declarations: Vec<DeclarationId>,
        /// Names of the columns of a row that jump.
        columns: Vec<String>,
    },
    /// Cells of rows have no value.
    WithoutValue {
        /// The quantity of these cells.
        quantity: Unknown,
        /// Number of rows.
        rows: u64,
    },
    /// A load works on a distance that is zero.
    LoadWithoutDirection {
        /// Index of the load.
        index: usize,
    },
    /// A distance that has to stay what it is at the start changes.
    SpacingChanges {
        /// Index of the fit.
        index: usize,
        /// Distance at the time of the warning, where it has changed most (m).
        distance: f64,
        /// Distance at the start (m).
        at_start: f64,
    },
    /// A contact would have to pull.
    ContactPulls {
        /// Index of the contact force.
        index: usize,
        /// Contact force (N), negative.
        force: f64,
    },
}

impl Warning {
    /// True if a bifurcation was passed.
    #[must_use]
    pub fn is_passage(&self) -> bool {
        matches!(self.cause, WarningCause::Passed { .. } | WarningCause::PassedBeforeStart { .. })
    }

    /// Returns the event as one that happened on the way from the mechanism's own first time (s) to the requested one.
    #[must_use]
    pub(in crate::analysis) fn before_start(self, from: f64) -> Warning {
        Warning {
            t: self.t,
            cause: WarningCause::PassedBeforeStart { from, is_backward: false, warning: Box::new(self) },
        }
    }

    /// Describes the event of a system in words.
    #[must_use]
    pub fn explain(&self, system: &ConstraintSystem) -> Diagnostic {
        let t = self.t;
        match &self.cause {
            WarningCause::Passed { driver: Some(driver), joints, .. } => {
                errors::driver_rests(system, *driver, joints, t, true)
            }
            WarningCause::Passed { driver: None, joints, columns } => errors::passed(system, joints, columns, t),
            WarningCause::PassedBeforeStart { from, is_backward, warning } => {
                let inner = warning.explain(system);
                errors::before_start(if *is_backward { at_another_time(inner, t) } else { inner }, *from)
            }
            WarningCause::NearChangePoint { joints, columns, within } => {
                errors::near_change_point(system, joints, columns, *within, t)
            }
            WarningCause::AccelerationJump { declarations, columns } => {
                errors::acceleration_jump(system, declarations, columns, t)
            }
            WarningCause::WithoutValue { quantity, rows } => errors::without_value(system, *quantity, t, *rows),
            WarningCause::LoadWithoutDirection { index } => errors::load_without_direction(&system.loads()[*index], t),
            WarningCause::SpacingChanges { index, distance, at_start } => {
                errors::spacing_changes(system, &system.fits()[*index], [*distance, *at_start], t)
            }
            WarningCause::ContactPulls { index, force } => {
                errors::contact_pulls(system, &system.contact_forces()[*index], *force, t)
            }
        }
    }
}

/// Reduces a diagnostic to its title, at another time (s), where its numbers are those of a path and not of the motion.
fn at_another_time(diagnostic: Diagnostic, t: f64) -> Diagnostic {
    let code: Code = diagnostic.code;
    let message = format!("there is {} at {}", code.title(), errors::at(t));
    let text = |is_primary: bool| if is_primary { "here" } else { "" }.to_owned();
    let labels = diagnostic.labels.into_iter().map(|label| Label { text: text(label.primary), ..label }).collect();
    Diagnostic { labels, ..Diagnostic::new(code, message).datum("t", t) }
}
