//! What all variants of a mechanism share, and the careful way from there to one of them: it is assembled with its own values, and led over
//! to others along the branch. Where a variant begins depends on its own values alone, whichever others there are.

use crate::analysis::{self, Horizon, LeadOptions, Solving, Started, Stop, Unassembled, Warning};
use crate::solver::Solver;
use mechc_ir::program::Program;
use mechc_ir::structure::Determined;
use mechc_text::cancel::Cancel;
use std::sync::Arc;

/// A mechanism that is compiled.
pub type Whole = (Arc<Determined>, Arc<Program>);

/// The bifurcations that were passed, by their parts of the way from 0 to 1, with what is to be said of each.
pub type Passed = Vec<Warning>;

/// A place where a mechanism stands, with what solves for its rows from there on.
#[derive(Clone)]
struct Place {
    /// Its coordinates [m, rad].
    q: Vec<f64>,
    solver: Option<Arc<Solver>>,
}

impl Place {
    fn of(started: &Started) -> Place {
        Place { q: started.q().to_vec(), solver: started.shared_solver() }
    }

    fn shared(&self) -> (&[f64], Option<Arc<Solver>>) {
        (&self.q, self.solver.clone())
    }
}

/// What all variants share.
pub struct Base {
    whole: Whole,
    own: Vec<f64>,
    /// Where it stands with its own values, at its own first time.
    stands: Place,
    /// The same mechanism on its way, whose further parameters say where it leads (`lower::lower_on_its_way`), and where all ways begin.
    on_its_way: Whole,
    begins: Place,
    /// The parameters that may be led, by their numbers.
    led: Vec<u32>,
    /// Whether time goes on the way.
    goes: bool,
    /// Whether the equations are smooth all along every way.
    is_plain: bool,
    options: LeadOptions,
}

/// A variant that stands where it was led to.
pub struct Arrived {
    /// It can be followed from there.
    pub started: Started,
    /// What was passed on the way.
    pub passed: Passed,
    /// What is to be said of its motion from its own first time to the one that is asked for.
    pub said: Vec<Warning>,
}

/// Why a variant stands nowhere.
pub enum Lost {
    /// The way ends at a part of it, from 0 to 1, with what happens there.
    OnItsWay(Box<Stop>),
    /// It got there, and cannot begin there.
    There(Box<Stop>),
}

impl Base {
    /// Of a mechanism that was started with its own values, and the same on its way: with the params that are led there, by their numbers,
    /// and whether time goes on it.
    ///
    /// # Errors
    /// No way begins where it stands.
    pub fn new(
        whole: Whole,
        started: &Started,
        on_its_way: Whole,
        (led, goes): (Vec<u32>, bool),
        options: LeadOptions,
    ) -> Result<Base, Box<Stop>> {
        let (own, stands) = (whole.0.system().values_of_params(), Place::of(started));
        let begins = analysis::before_ways(&on_its_way.0, &on_its_way.1, &stands.q, &options)?;
        let (is_plain, begins) = (begins.is_plain(), Place::of(&begins));
        Ok(Base { whole, own, stands, on_its_way, begins, led, goes, is_plain, options })
    }

    /// Where it stands with its own values, and what it is there.
    pub(super) fn stands(&self) -> (&Whole, &[f64]) {
        (&self.whole, &self.own)
    }

    /// Whether ways lead all of some parameters, by their numbers, and on none anything happens but that the mechanism moves.
    pub(super) fn leads_plainly(&self, params: &[u32]) -> bool {
        self.is_plain && !self.goes && params.iter().all(|param| self.led.contains(param))
    }

    /// A variant, by the values of all its parameters (SI).
    #[must_use]
    pub fn variant(&self, values: &[f64]) -> Arc<Determined> {
        Arc::new(self.whole.0.with_values(values))
    }

    /// A variant where it begins, for the time for which it is looked at.
    ///
    /// # Errors
    /// It does not get there, or cannot begin there.
    pub fn alone(&self, variant: Arc<Determined>, horizon: Horizon, cancel: &Cancel) -> Result<Arrived, Lost> {
        let LeadOptions { tolerance, t: own, pass_bifurcations, .. } = self.options;
        let (q, passed) = self.way_to(&variant.system().values_of_params(), horizon.from, cancel)?;
        let is_there = self.goes || horizon.from.total_cmp(&own).is_eq();
        let program = Arc::clone(&self.whole.1);
        let cancel = cancel.clone();
        let whole = Unassembled { determined: variant, program, horizon, tolerance, pass_bifurcations, cancel };
        let solving = Solving::With(self.stands.solver.clone());
        if is_there {
            let started = whole.assemble_at(&q, solving).map_err(Lost::There)?;
            return Ok(Arrived { started, passed, said: Vec::new() });
        }
        let begun = Unassembled { horizon: horizon.beginning(own), ..whole.clone() }.assemble_at(&q, solving);
        let followed = begun.and_then(|begun| analysis::follow_to(&whole, (begun, own)));
        let (started, said) = followed.map_err(Lost::There)?;
        Ok(Arrived { started, passed, said })
    }

    /// Where the way leads, with what was passed on it.
    fn way_to(&self, values: &[f64], t: f64, cancel: &Cancel) -> Result<(Vec<f64>, Passed), Lost> {
        let is_own = |&k: &u32| values[k as usize].to_bits() == self.own[k as usize].to_bits();
        if !self.goes && self.led.iter().all(is_own) {
            return Ok((self.stands.q.clone(), Vec::new()));
        }
        let ends = self.led.iter().map(|&k| values[k as usize]);
        let times = self.goes.then_some([self.options.t, t]).into_iter().flatten();
        let on_its_way: Vec<f64> = self.own.iter().copied().chain(ends).chain(times).collect();
        let determined = Arc::new(self.on_its_way.0.with_values(&on_its_way));
        let options = LeadOptions { cancel: cancel.clone(), ..self.options.clone() };
        let way = analysis::lead_again(&determined, &self.on_its_way.1, self.begins.shared(), &options);
        let mut way = way.map_err(|stop| Lost::OnItsWay(Box::new(Stop { t: 0.0, ..*stop })))?;
        match (way.reached.pop(), way.stopped) {
            (Some(q), _) => Ok((q, way.passed)),
            (None, Some(stop)) => Err(Lost::OnItsWay(stop)),
            // who cancelled does not read why
            (None, None) => Ok((self.stands.q.clone(), Vec::new())),
        }
    }
}
