/// Why a mechanism could not be brought to a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The time, a parameter or a formula is not a number.
    NotANumber,
    /// A driver has come to a position beyond which the mechanism cannot follow it: a dead point.
    LockUp,
    /// Two branches of the motion meet: which one goes on is not determined.
    Bifurcation,
    /// Newton's iteration does not arrive, however short the step.
    Divergence,
    /// The steps that were allowed do not lead so far; nothing is wrong with the motion up to here.
    TooFar,
    /// At a time where a formula of time goes over to another branch, a position or velocity jumps.
    NotSmooth,
    /// An equation that was left out as redundant does not hold beside the others.
    Inconsistent,
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Error::NotANumber => "the time, a parameter or a formula is not a number",
            Error::LockUp => "the mechanism locks up: its driver cannot go on",
            Error::Bifurcation => "two branches of the motion meet",
            Error::Divergence => "the motion cannot be followed",
            Error::TooFar => "the time is too far away for so few steps",
            Error::NotSmooth => "a position or velocity jumps",
            Error::Inconsistent => "an equation that was left out as redundant does not hold",
        })
    }
}

impl core::error::Error for Error {}

/// The mechanism at a time.
#[derive(Clone, Debug)]
pub struct State {
    model: Model,
    /// The solution of now and the one before, or the next one in the making.
    solutions: [Solution; 2],
    /// Whether that of now is the second.
    is_second: bool,
    /// Whether the one before lies on the same smooth motion.
    is_smooth: bool,
    /// How much steeper these parameters make the equations than the file's.
    steepness: f64,
    /// The step that goes well (s).
    step: f64,
//# if inputs
    /// What follows inputs, and whether they have led here rather than the time.
    led: following::Led,
    is_led: bool,
//# end
//# if rims
    /// By rim: the time at which it was looked at last (s).
    passed: [f64; RIMS],
//# end
}

impl State {
    /// The solution of now.
    fn at(&self) -> &Solution {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// The time (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.at().t
    }

//# if inputs
    /// The inputs: what they were followed to, or what their formulas say at this time.
    #[must_use]
    pub fn inputs(&self) -> Inputs {
        if self.is_led {
            self.led.inputs()
        } else {
            Inputs::at(self.at().t, &self.model.params)
        }
    }

//# end
    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &Params {
        &self.model.params
    }

    /// The coordinates (m, rad), by the indices in [`coordinate`].
    #[must_use]
    pub fn q(&self) -> &Q {
        &self.at().q
    }

    /// Their velocities (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &Qd {
        &self.at().qd
    }

    /// Their accelerations (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &Qdd {
        &self.at().qdd
    }
//# if bodies

    /// Where a body is (m, m, rad).
    #[must_use]
    pub fn pose(&self, body: Body) -> Pose {
        Pose::of(&self.at().q, body)
    }

    /// How fast a body moves (m/s, m/s, rad/s).
    #[must_use]
    pub fn velocity(&self, body: Body) -> Pose {
        Pose::of(&self.at().qd, body)
    }

    /// How a body's velocity changes (m/s^2, m/s^2, rad/s^2).
    #[must_use]
    pub fn acceleration(&self, body: Body) -> Pose {
        Pose::of(&self.at().qdd, body)
    }
//# end
//# if measures

    /// The measures, by the indices in [`measure`], and their first and second time derivatives; `NAN` where
    /// one has no value, and no step fails for that.
    #[must_use]
    pub fn measures(&self) -> &Measures {
        &self.at().measures
    }
//# end

    /// All results, in the order of the columns of `mechc run`: the time, coordinates and measures,
    /// then their first and their second derivatives.
    #[must_use]
    pub fn row(&self) -> [f64; COLUMNS] {
        let at = self.at();
//# if measures
        let [values, rates, accelerations] = at.measures.lists();
        let zeroth = at.q.iter().chain(values);
        let first = at.qd.iter().chain(rates);
        let second = at.qdd.iter().chain(accelerations);
        let all = zeroth.chain(first).chain(second);
//# end
//# if !measures
        let all = at.q.iter().chain(&at.qd).chain(&at.qdd);
//# end
        let mut row = [at.t; COLUMNS];
        for (cell, value) in row.iter_mut().skip(1).zip(all) {
            *cell = *value;
        }
        row
    }
}
