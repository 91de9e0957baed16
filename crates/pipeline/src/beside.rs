//! Places of a mechanism that are looked at side by side, a lane for each: its inputs and params differ, and the time is the same. As in a sweep
//! (`abreast.rs`), what is in doubt is left to the careful way.

use super::options::RunOptions;
use super::over::FromOwn;
use mechc_engine::analysis::Times;
use mechc_engine::sweep::{Each, LANES, Numbers, Room, Team, Together, WantedOfEach};
use mechc_ir::program::LaneValues;
use mechc_text::diag::Diagnostic;
use std::array::from_fn;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

/// What is asked for, in values of all params of the model (SI).
pub(super) struct Aim {
    pub values: Vec<f64>,
    pub times: Times,
}

/// What is asked for, or why that cannot be.
pub(super) type Aimed = Result<Aim, Box<Diagnostic>>;

/// So many at a time that nobody has asked for before are worth what it takes to lay it out.
const MANY: usize = LANES / 2;

/// What such places share.
pub(super) struct Beside {
    /// The params that may be led, by their numbers.
    led: Vec<u32>,
    /// Of the times that were asked for last.
    known: Mutex<Option<Known>>,
}

struct Known {
    times: Times,
    /// Nothing where places had better be looked at alone.
    together: Option<Arc<Together>>,
    /// Lanes that nobody is in now.
    idle: Vec<SideBySide>,
}

/// Some places side by side.
pub(super) struct SideBySide {
    of: Arc<Together>,
    team: Team,
    params: Vec<Each>,
    /// By column, place by place.
    columns: Vec<Numbers>,
    /// Those of which nothing is in doubt.
    done: [bool; LANES],
}

impl Beside {
    pub fn of(led: Vec<u32>) -> Beside {
        Beside { led, known: Mutex::default() }
    }

    /// Looks at as many places as there are lanes, or fewer, and all of so many columns; nothing where they had better be looked at alone.
    pub fn follow(&self, aims: &[Aimed], of: (&FromOwn, usize), options: &RunOptions) -> Option<SideBySide> {
        let aim = aims.iter().flatten().next()?;
        let is_of_them = |of: &Aim| are_the_same(&of.times, &aim.times);
        // lanes that are left over do the first one again
        let lanes: [Option<&Aim>; LANES] = from_fn(|lane| aims.get(lane)?.as_ref().ok().filter(|of| is_of_them(of)));
        let mut side = self.side(&aim.times, lanes.iter().flatten().count(), of, options)?;
        side.params.resize(aim.values.len(), LaneValues([0.0; LANES]));
        for (place, param) in side.params.iter_mut().enumerate() {
            param.0 = lanes.map(|of| of.unwrap_or(aim).values[place]);
        }
        for column in &mut side.columns {
            column.truncate(0);
            column.make_room(aims.len().min(LANES));
        }
        let room = Room { columns: &mut side.columns, before: 0, rows: 1 };
        side.done = side.team.follow(&side.params, lanes.map(|of| of.is_some()), room, &options.cancel);
        Some(side)
    }

    /// Lanes for so many places at a time; for few of them, if that is the time that was asked for before, or none was.
    fn side(&self, times: &Times, count: usize, of: (&FromOwn, usize), options: &RunOptions) -> Option<SideBySide> {
        let (from_own, columns) = of;
        let mut known = self.known()?;
        let is_of_others = |known: &Known| !are_the_same(&known.times, times);
        if known.as_ref().is_none_or(is_of_others) {
            if known.is_some() && count < MANY {
                return None;
            }
            let all: Vec<usize> = (0..columns).collect();
            let wanted = WantedOfEach { rows: (times, Some(&all)), results: false };
            let together = from_own.together(&self.led, &wanted, options).map(Arc::new);
            // what was given up says nothing
            if options.cancel.is_cancelled() {
                return None;
            }
            *known = Some(Known { times: times.clone(), together, idle: Vec::new() });
        }
        let known = known.as_mut()?;
        let of = Arc::clone(known.together.as_ref()?);
        let new = || SideBySide {
            team: Team::new(&of),
            of,
            params: Vec::new(),
            columns: vec![Numbers::default(); columns],
            done: [false; LANES],
        };
        Some(known.idle.pop().unwrap_or_else(new))
    }

    /// Takes lanes back.
    pub fn give_back(&self, side: SideBySide) {
        let Some(mut known) = self.known() else { return };
        let is_of_them = |known: &&mut Known| known.together.as_ref().is_some_and(|of| Arc::ptr_eq(of, &side.of));
        if let Some(known) = known.as_mut().filter(is_of_them) {
            known.idle.push(side);
        }
    }

    /// What is known. Who cannot look, because another process was forked while somebody did, does without.
    fn known(&self) -> Option<MutexGuard<'_, Option<Known>>> {
        match self.known.try_lock() {
            Ok(known) => Some(known),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

impl SideBySide {
    /// Writes the row of a place; says whether it is known.
    pub fn write_row(&self, lane: usize, row: &mut Vec<f64>) -> bool {
        if self.done[lane] {
            row.clear();
            row.extend(self.columns.iter().map(|column| column[lane]));
        }
        self.done[lane]
    }
}

fn are_the_same(times: &Times, others: &Times) -> bool {
    let bits = |times: &Times| (times.len(), times.from().to_bits(), times.at(0).to_bits());
    bits(times) == bits(others)
}
