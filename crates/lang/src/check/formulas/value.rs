//! Values: formulas in the graph with their dimensions, and the context in which a formula is read.

use crate::model::Dimension;
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// The identity of a dimension in a cache.
pub(super) type DimKey = (bool, bool, [u64; 4]);

/// The dimension of a formula.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in crate::check) enum Dim {
    /// A literal zero, which fits any dimension.
    Any,
    /// A known dimension.
    Of(Dimension),
    /// An open dimension: a number without a unit is a factor in a plain formula. Judged formulas do not have it.
    Plain {
        /// The dimension if numbers are pure.
        read: Dimension,
        /// True if its terms agree if numbers are pure.
        fits: bool,
    },
}

impl Dim {
    pub const PURE: Dim = Dim::Of(Dimension::PURE);
    pub const LENGTH: Dim = Dim::Of(Dimension::LENGTH);
    /// The dimension of a number without a unit.
    pub const PLAIN: Dim = Dim::Plain { read: Dimension::PURE, fits: true };
    /// The dimension of a formula whose numbers must have dimensions for its terms to agree.
    pub const UNFIT: Dim = Dim::Plain { read: Dimension::PURE, fits: false };

    /// Returns the dimension if numbers without units are pure.
    pub fn settled(self) -> Dimension {
        match self {
            Dim::Any => Dimension::PURE,
            Dim::Of(dimension) | Dim::Plain { read: dimension, .. } => dimension,
        }
    }

    /// Returns the dimension of a term. A zero fits any dimension only as a whole formula.
    pub fn of_term(self) -> Dim {
        if self == Dim::Any { Dim::PLAIN } else { self }
    }

    /// Returns the dimension in a judged formula, where numbers are pure.
    pub fn when_judged(self, judged: bool) -> Dim {
        match self {
            Dim::Plain { read, .. } if judged => Dim::Of(read),
            _ => self,
        }
    }

    /// Returns the dimension of a function of one value, such as a root or derivative.
    pub fn map(self, f: impl FnOnce(Dimension) -> Dimension) -> Dim {
        match self.of_term() {
            Dim::Plain { read, fits } => Dim::Plain { read: f(read), fits },
            other => Dim::Of(f(other.settled())),
        }
    }

    /// Returns it marked as an angle.
    pub fn of_angle(self) -> Dim {
        self.map(|dimension| dimension.marked_by(Dimension::ANGLE))
    }

    /// Returns the dimension of a product or quotient.
    pub fn with(self, other: Dim, f: impl Fn(Dimension, Dimension) -> Dimension) -> Dim {
        let read = f(self.settled(), other.settled());
        match (self, other) {
            (Dim::Of(_), Dim::Of(_)) => Dim::Of(read),
            _ => Dim::Plain { read, fits: self.fits() && other.fits() },
        }
    }

    /// Returns whether its terms agree if numbers are pure.
    pub fn fits(self) -> bool {
        !matches!(self, Dim::Plain { fits: false, .. })
    }

    /// Returns its identity in a cache.
    pub fn key(self) -> DimKey {
        let read = self.settled();
        let powers = [read.length, read.time, read.mass, read.angle].map(|power| (power + 0.0).to_bits());
        (matches!(self, Dim::Of(_)), self.fits() && self != Dim::Any, powers)
    }

    /// Returns the expected and the found dimension if they differ. A zero fits any dimension.
    pub fn other_than(self, found: Dim) -> Option<[Dimension; 2]> {
        let both = [self.settled(), found.settled()];
        (self != Dim::Any && found != Dim::Any && !both[0].is(both[1])).then_some(both)
    }

    /// Returns whether it is known to be a pure number.
    pub fn is_a_pure_number(self) -> bool {
        matches!(self, Dim::Of(dimension) if dimension.is(Dimension::PURE))
    }

    /// Returns whether it fits a pure number, if numbers without units are pure.
    pub fn is_pure(self) -> bool {
        self.fits() && self.settled().is(Dimension::PURE)
    }
}

/// A formula in the graph with its dimension.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in crate::check) struct Value {
    pub id: ExprId,
    pub dim: Dim,
}

impl Value {
    pub fn has_a_dimension(self) -> bool {
        matches!(self.dim, Dim::Of(dimension) if !dimension.is(Dimension::PURE))
    }
}

/// The permissions of a formula, and the way in which it is read.
#[derive(Clone, Copy)]
#[allow(clippy::struct_excessive_bools)] // permissions that depend on nothing but the place
pub(in crate::check) struct Context<'c> {
    /// The place in messages, such as `a constraint`.
    pub place: &'c str,
    /// True if dimensions are compared.
    pub judged: bool,
    /// True if `t` is allowed.
    pub time: bool,
    /// True if inputs are allowed.
    pub inputs: bool,
    /// True if kinematic quantities are allowed.
    pub quantities: bool,
    /// True if `der` and quantities with rates are allowed.
    pub rates: bool,
    /// True if measures and computed forces are allowed.
    pub measures: bool,
    /// True if reductions and results are allowed.
    pub results: bool,
    /// True if names of the file are allowed.
    pub names: bool,
    /// True if functions are expanded. A function that is checked on its own is not, as those that it calls are checked themselves.
    pub expands: bool,
    /// The argument of the function that is being expanded.
    pub argument: Option<(&'c str, Value)>,
    /// The unit in which the argument is printed, if it is a unit of angle other than the radian.
    pub printed: Option<Span>,
}

impl<'c> Context<'c> {
    /// Returns the context of a constant over params and functions.
    pub fn constant(place: &'c str) -> Context<'c> {
        Context {
            place,
            judged: false,
            time: false,
            inputs: false,
            quantities: false,
            rates: false,
            measures: false,
            results: false,
            names: true,
            expands: true,
            argument: None,
            printed: None,
        }
    }

    /// Returns this context for another place and argument.
    pub fn at<'p>(&self, place: &'p str, argument: Option<(&'p str, Value)>) -> Context<'p> {
        let &Context { judged, time, inputs, quantities, rates, measures, results, names, expands, printed, .. } = self;
        Context { place, judged, time, inputs, quantities, rates, measures, results, names, expands, argument, printed }
    }
}
