//! The tree of a `.mech` file as written: every node with its span, without meaning.

use mechc_text::source::Span;

/// A name as written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Name {
    /// Text in NFC.
    pub text: String,
    /// Span.
    pub span: Span,
}

/// A whole file.
#[derive(Clone, PartialEq, Debug)]
pub struct File {
    /// Files that it uses, in order.
    pub uses: Vec<UsedFile>,
    /// Mechanisms, in order.
    pub mechanisms: Vec<Mechanism>,
}

/// `use "FILE.mech" as PREFIX`
#[derive(Clone, PartialEq, Debug)]
pub struct UsedFile {
    /// Text of the `///` lines above.
    pub docs: Vec<String>,
    /// Span of the declaration.
    pub span: Span,
    /// Path as written, with the span of the string; `None` if it cannot be read.
    pub path: Option<Name>,
    /// Prefix for the names of its mechanisms.
    pub prefix: Option<Name>,
    /// True if it contains a syntax error: it may have been intended to define any name.
    pub is_broken: bool,
}

/// `mechanism NAME { … }`.
#[derive(Clone, PartialEq, Debug)]
pub struct Mechanism {
    /// Text of the `///` lines above.
    pub docs: Vec<String>,
    /// Name.
    pub name: Name,
    /// Span from the keyword to the closing brace.
    pub span: Span,
    /// Declarations, in order.
    pub items: Vec<Item>,
}

/// A declaration with its documentation.
#[derive(Clone, PartialEq, Debug)]
pub struct Item {
    /// Text of the `///` lines above.
    pub docs: Vec<String>,
    /// Span of the declaration.
    pub span: Span,
    /// Index ranges behind its name: it stands for one declaration per index.
    pub ranges: Vec<IndexRange>,
    /// Kind.
    pub kind: ItemKind,
}

impl Item {
    /// Returns its formulas, with those of its features and ranges.
    #[must_use]
    pub fn formulas(&self) -> Vec<&Expr> {
        let mut all: Vec<&Expr> = self.ranges.iter().flat_map(|range| [&range.from, &range.to]).collect();
        match &self.kind {
            ItemKind::Param { value, .. }
            | ItemKind::Input { value, .. }
            | ItemKind::Function { value, .. }
            | ItemKind::Measure { value, .. }
            | ItemKind::Trace { point: value, .. }
            | ItemKind::Result { value, .. }
            | ItemKind::Gravity { acceleration: value } => all.push(value),
            ItemKind::Part(part) => {
                all.extend(part.bindings.iter().map(|binding| &binding.value).chain(&part.on).chain(&part.at));
            }
            ItemKind::Table { rows: TableRows::Listed(rows), .. } => all.extend(rows),
            ItemKind::Table { .. } | ItemKind::Broken { .. } => {}
            ItemKind::Ground { features } => all.extend(features.iter().flat_map(Feature::formulas)),
            ItemKind::Body { pose, features, .. } => {
                all.extend(pose.iter().flat_map(DrawnPose::parts).chain(features.iter().flat_map(Feature::formulas)));
            }
            ItemKind::Joint { arguments, .. } => all.extend(arguments),
            ItemKind::Equation { left, right, .. } | ItemKind::Load { force: left, on: right, .. } => {
                all.extend([left, right]);
            }
            ItemKind::Requirement(requirement) => all.extend(requirement.formulas()),
            ItemKind::Analysis { from, to, every } => all.extend([from, to, every]),
        }
        all
    }
}

/// A range of indices: `k in 0..n`.
#[derive(Clone, PartialEq, Debug)]
pub struct IndexRange {
    /// Name of the index in the declaration.
    pub index: Name,
    /// First index.
    pub from: Expr,
    /// Last index, or the one behind it.
    pub to: Expr,
    /// True for `..=`: `to` is included.
    pub is_closed: bool,
}

/// The declarations of a mechanism.
#[derive(Clone, PartialEq, Debug)]
pub enum ItemKind {
    /// `param NAME = EXPR`
    Param {
        /// Name.
        name: Name,
        /// Formula.
        value: Expr,
    },
    /// `fn NAME(ARGUMENT) = EXPR`
    Function {
        /// Name.
        name: Name,
        /// The single argument.
        argument: Name,
        /// Formula.
        value: Expr,
    },
    /// `table NAME = periodic? spline …`
    Table {
        /// Name.
        name: Name,
        /// True if it repeats.
        periodic: bool,
        /// The points.
        rows: TableRows,
    },
    /// `input NAME = EXPR`
    Input {
        /// Name.
        name: Name,
        /// Default formula, used unless a value is set.
        value: Expr,
    },
    /// `part NAME: MECHANISM(BINDING, …) on BODY at (x, y, phi) mirrored`
    Part(Box<Part>),
    /// `ground { … }`
    Ground {
        /// The features.
        features: Vec<Feature>,
    },
    /// `body NAME at (x, y, phi) { … }`, `body NAME at (P, phi) { … }`, `body NAME at P toward Q { … }`
    Body {
        /// Name.
        name: Name,
        /// Pose behind `at`.
        pose: Option<DrawnPose>,
        /// The features.
        features: Vec<Feature>,
    },
    /// `joint NAME: KIND(…)`
    Joint {
        /// Name.
        name: Name,
        /// The kind of joint.
        kind: Name,
        /// Joined features.
        arguments: Vec<Expr>,
        /// Span of `KIND(…)`.
        call_span: Span,
    },
    /// `constraint NAME: EXPR = EXPR` or `driver NAME: EXPR = EXPR`
    Equation {
        /// Constraint or driver.
        driver: bool,
        /// Name.
        name: Name,
        /// Left of the `=`.
        left: Expr,
        /// Right of the `=`.
        right: Expr,
    },
    /// `gravity (gx, gy)`
    Gravity {
        /// A tuple.
        acceleration: Expr,
    },
    /// `load NAME: EXPR on QUANTITY`
    Load {
        /// Name.
        name: Name,
        /// The force or torque.
        force: Expr,
        /// Quantity that the load acts on.
        on: Expr,
    },
    /// `measure NAME = EXPR in UNIT`
    Measure {
        /// Name.
        name: Name,
        /// Formula.
        value: Expr,
        /// The unit behind `in`.
        unit: Option<WrittenUnit>,
    },
    /// `trace NAME = P in UNIT`
    Trace {
        /// Name.
        name: Name,
        /// A point of a body, or a tuple.
        point: Expr,
        /// The unit behind `in`.
        unit: Option<WrittenUnit>,
    },
    /// `result NAME = EXPR in UNIT`
    Result {
        /// Name.
        name: Name,
        /// Formula, over reductions.
        value: Expr,
        /// The unit behind `in`.
        unit: Option<WrittenUnit>,
    },
    /// `require NAME: A <= EXPR <= B`, `require EXPR == EXPR within EXPR`
    Requirement(Box<Requirement>),
    /// A declaration with a syntax error.
    Broken {
        /// Names that it may define.
        names: Vec<Name>,
    },
    /// `analysis from A to B every H`
    Analysis {
        /// First time.
        from: Expr,
        /// Last time.
        to: Expr,
        /// Step.
        every: Expr,
    },
}

impl ItemKind {
    /// Returns the features of the ground or of a body.
    pub fn features_mut(&mut self) -> Option<&mut Vec<Feature>> {
        match self {
            ItemKind::Ground { features } | ItemKind::Body { features, .. } => Some(features),
            _ => None,
        }
    }
}

/// A requirement: a comparison, or a formula between two bounds.
#[derive(Clone, PartialEq, Debug)]
pub struct Requirement {
    /// Name, if given.
    pub name: Option<Name>,
    /// Left of the first comparison.
    pub first: Expr,
    /// The comparisons: one, or two.
    pub rest: Vec<ComparedSide>,
    /// The tolerance behind `within`, if given.
    pub within: Option<Expr>,
}

impl Requirement {
    /// Returns its formulas.
    pub fn formulas(&self) -> impl Iterator<Item = &Expr> {
        std::iter::once(&self.first).chain(self.rest.iter().map(|comparison| &comparison.right)).chain(&self.within)
    }
}

/// A comparison with the formula on its right.
#[derive(Clone, PartialEq, Debug)]
pub struct ComparedSide {
    /// Operator.
    pub sign: ComparisonSign,
    /// Span of the operator.
    pub span: Span,
    /// Formula.
    pub right: Expr,
}

/// An instance of another mechanism.
#[derive(Clone, PartialEq, Debug)]
pub struct Part {
    /// Name.
    pub name: Name,
    /// The mechanism.
    pub mechanism: MechanismName,
    /// Bindings of its params and inputs.
    pub bindings: Vec<Binding>,
    /// Carrier of the part, if given.
    pub on: Option<Expr>,
    /// Pose of its frame in the frame of its carrier.
    pub at: Option<Expr>,
    /// Span of `mirrored`, if given.
    pub mirrored: Option<Span>,
    /// Span of `MECHANISM(…)`.
    pub call_span: Span,
}

/// Name of a mechanism in a part.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct MechanismName {
    /// Prefix of the used file, if any.
    pub prefix: Option<Name>,
    /// Name in that file.
    pub name: Name,
}

impl MechanismName {
    /// Returns the span of prefix and name.
    #[must_use]
    pub fn span(&self) -> Span {
        self.prefix.as_ref().map_or(self.name.span, |prefix| prefix.span.to(self.name.span))
    }

    /// Returns the name as written.
    #[must_use]
    pub fn text(&self) -> String {
        self.prefix.as_ref().map_or(String::new(), |prefix| format!("{}.", prefix.text)) + &self.name.text
    }
}

/// Value of a param or input of a part: `turn = angle(shaft)`, `A.x = 3 mm`.
#[derive(Clone, PartialEq, Debug)]
pub struct Binding {
    /// Name in the part.
    pub name: Name,
    /// Coordinate of a point, if only one is bound.
    pub coordinate: Option<Name>,
    /// Formula over the names of the mechanism that contains the part.
    pub value: Expr,
    /// Span of the binding.
    pub span: Span,
}

/// Source of a table's points.
#[derive(Clone, PartialEq, Debug)]
pub enum TableRows {
    /// `[(a, b), …]`
    Listed(Vec<Expr>),
    /// `"file.csv" columns 1, 3 (unit, unit)`
    File {
        /// Path as written, with its span.
        path: Name,
        /// The two columns.
        columns: Option<[ColumnName; 2]>,
        /// Units of the two columns.
        units: Option<[WrittenUnit; 2]>,
    },
}

/// Pose in which a body is drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct DrawnPose {
    /// `(x, y, phi)`, `(P, phi)`, or before `toward` a point alone.
    pub at: Expr,
    /// Point that the x axis of the body is directed to.
    pub toward: Option<Expr>,
}

impl DrawnPose {
    /// Returns the span of everything behind `at`.
    #[must_use]
    pub fn span(&self) -> Span {
        self.toward.as_ref().map_or(self.at.span, |toward| self.at.span.to(toward.span))
    }

    /// Returns its formulas.
    pub fn parts(&self) -> impl Iterator<Item = &Expr> {
        std::iter::once(&self.at).chain(&self.toward)
    }
}

/// A column of a file, as named in a text.
#[derive(Clone, PartialEq, Debug)]
pub struct ColumnName {
    /// Number or name.
    pub kind: ColumnWord,
    /// Span.
    pub span: Span,
}

/// Ways to name a column.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum ColumnWord {
    /// Number, from 1.
    Number(u32),
    /// Name in the header line.
    Named(String),
}

/// Units with powers, joined by `*` and `/`: `mm/s^2`.
#[derive(Clone, PartialEq, Debug)]
pub struct WrittenUnit {
    /// Factors in order, at least one; the first one divides in `1/s`.
    pub factors: Vec<UnitFactor>,
    /// Span of the unit.
    pub span: Span,
}

/// A unit with its power, as a factor of a product.
#[derive(Clone, PartialEq, Debug)]
pub struct UnitFactor {
    /// The unit.
    pub name: Name,
    /// Power as written.
    pub power: i32,
    /// Multiplication or division.
    pub factor: Factor,
    /// Span with the power.
    pub span: Span,
}

/// A feature of a body or of the ground.
#[derive(Clone, PartialEq, Debug)]
pub struct Feature {
    /// Text of the `///` lines above.
    pub docs: Vec<String>,
    /// Span of the declaration.
    pub span: Span,
    /// Name; empty for a mass, and where it cannot be read.
    pub name: Name,
    /// Kind.
    pub kind: FeatureKind,
}

/// Kinds of features. Points are frequent, so the larger kinds are boxed.
#[derive(Clone, PartialEq, Debug)]
pub enum FeatureKind {
    /// A feature with a syntax error.
    Broken,
    /// `point P = (x, y)`, or `point P` alone: that of the mechanism
    Point {
        /// A formula of points.
        at: Option<Expr>,
    },
    /// `axis a = P along (dx, dy)`
    AxisAlong {
        /// A formula of points.
        origin: Box<Expr>,
        /// A tuple.
        direction: Box<Expr>,
    },
    /// `axis a = P to Q`
    AxisTo {
        /// A formula of points.
        origin: Box<Expr>,
        /// A formula of points.
        target: Box<Expr>,
    },
    /// `circle c = P radius r`
    Circle {
        /// A formula of points.
        center: Box<Expr>,
        /// A length.
        radius: Box<Expr>,
    },
    /// `curve k(u) = (x, y) at e`
    Curve {
        /// Name of the parameter.
        argument: Name,
        /// A formula of points, over the parameter.
        at: Box<Expr>,
        /// First estimate of the parameter.
        estimate: Option<Box<Expr>>,
    },
    /// `mass M at (x, y) inertia I`
    Mass {
        /// The mass.
        mass: Box<Expr>,
        /// Centre: a formula of points.
        at: Option<Box<Expr>>,
        /// Moment of inertia about the centre.
        inertia: Option<Box<Expr>>,
    },
}

impl Feature {
    /// Returns its formulas.
    #[must_use]
    pub fn formulas(&self) -> Vec<&Expr> {
        match &self.kind {
            FeatureKind::Broken => Vec::new(),
            FeatureKind::Point { at } => at.iter().collect(),
            FeatureKind::AxisAlong { origin: one, direction: two }
            | FeatureKind::AxisTo { origin: one, target: two }
            | FeatureKind::Circle { center: one, radius: two } => vec![one, two],
            FeatureKind::Curve { at, estimate, .. } => std::iter::once(&**at).chain(estimate.as_deref()).collect(),
            FeatureKind::Mass { mass, at, inertia } => {
                std::iter::once(&**mass).chain(at.as_deref()).chain(inertia.as_deref()).collect()
            }
        }
    }
}

/// A formula, a tuple of formulas, or a condition; `check` decides which one its position allows.
#[derive(Clone, PartialEq, Debug)]
pub struct Expr {
    /// Kind.
    pub kind: ExprKind,
    /// Span.
    pub span: Span,
}

/// Forms of an expression. Long sums and chains are flat, so the depth is the nesting.
#[derive(Clone, PartialEq, Debug)]
pub enum ExprKind {
    /// `50`, `50 mm`, `50 mm^2`
    Literal {
        /// The number.
        value: f64,
        /// Unit and its power.
        unit: Option<(Name, i32)>,
    },
    /// `speed`
    Name(Name),
    /// `crank.pin`, `ground.O`
    Member {
        /// The body, or `ground`.
        owner: Name,
        /// The feature.
        feature: Name,
    },
    /// A path with indices: `link[k].pin`, `link[0]`.
    Path(Vec<PathSegment>),
    /// `x(rod.tip)`
    Call {
        /// Name of the function.
        name: Name,
        /// Arguments, in order.
        arguments: Vec<Expr>,
        /// Part of the analysis that a reduction covers, if given.
        window: Option<Box<Window>>,
    },
    /// `(e)`
    Paren(Box<Expr>),
    /// `(a, b)` or longer
    Tuple(Vec<Expr>),
    /// `-e`
    Negate(Box<Expr>),
    /// `not e`
    Not(Box<Expr>),
    /// `a + b - c`
    Sum(Box<Expr>, Vec<(Sign, Expr)>),
    /// `a * b / c`
    Product(Box<Expr>, Vec<(Factor, Expr)>),
    /// `a ^ b`
    Power(Box<Expr>, Box<Expr>),
    /// `a < b`
    Compare(Box<Expr>, ComparisonSign, Box<Expr>),
    /// `a and b and c`
    And(Vec<Expr>),
    /// `a or b or c`
    Or(Vec<Expr>),
    /// `if c then a else if d then b else e`
    If {
        /// Conditions with their values, in order.
        arms: Vec<(Expr, Expr)>,
        /// Value if no condition holds.
        otherwise: Box<Expr>,
    },
}

/// A part of the analysis: `from A to B`, `from A`, `to B`.
#[derive(Clone, PartialEq, Debug)]
pub struct Window {
    /// First time; that of the analysis if absent.
    pub from: Option<Expr>,
    /// Last time; that of the analysis if absent.
    pub to: Option<Expr>,
    /// Span of the window.
    pub span: Span,
}

impl Window {
    /// Returns the given times.
    pub fn bounds(&self) -> impl Iterator<Item = &Expr> {
        self.from.iter().chain(&self.to)
    }
}

/// A segment of a path.
#[derive(Clone, PartialEq, Debug)]
pub struct PathSegment {
    /// Name.
    pub name: Name,
    /// Indices in brackets behind it.
    pub indices: Vec<Expr>,
}

/// Sign of a term in a sum.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Sign {
    /// `+`
    Plus,
    /// `-`
    Minus,
}

/// Operator of a factor in a product.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Factor {
    /// `*`
    Times,
    /// `/`
    Divide,
}

/// Comparison operators.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ComparisonSign {
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
}

impl Expr {
    /// Returns the expression without enclosing parentheses.
    #[must_use]
    pub fn bare(&self) -> &Expr {
        let mut inner = self;
        while let ExprKind::Paren(e) = &inner.kind {
            inner = e;
        }
        inner
    }

    /// Returns the value of a number without unit, with its sign and without parentheses.
    #[must_use]
    pub fn bare_number(&self) -> Option<f64> {
        match &self.bare().kind {
            ExprKind::Literal { value, unit: None } => Some(*value),
            ExprKind::Negate(e) => e.bare_number().map(|v| -v),
            _ => None,
        }
    }

    /// Iterates over the expression and its subexpressions, each before its own subexpressions.
    #[must_use]
    pub fn parts(&self) -> Parts<'_> {
        Parts { open: vec![self] }
    }

    /// Returns the direct subexpressions.
    #[must_use]
    pub fn children(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Literal { .. } | ExprKind::Name(_) | ExprKind::Member { .. } => Vec::new(),
            ExprKind::Path(segments) => segments.iter().flat_map(|segment| &segment.indices).collect(),
            ExprKind::Call { arguments, window, .. } => {
                arguments.iter().chain(window.iter().flat_map(|window| window.bounds())).collect()
            }
            ExprKind::Tuple(list) | ExprKind::And(list) | ExprKind::Or(list) => list.iter().collect(),
            ExprKind::Paren(e) | ExprKind::Negate(e) | ExprKind::Not(e) => vec![e],
            ExprKind::Sum(first, rest) => std::iter::once(&**first).chain(rest.iter().map(|(_, e)| e)).collect(),
            ExprKind::Product(first, rest) => std::iter::once(&**first).chain(rest.iter().map(|(_, e)| e)).collect(),
            ExprKind::Power(a, b) | ExprKind::Compare(a, _, b) => vec![a, b],
            ExprKind::If { arms, otherwise } => {
                let mut list: Vec<&Expr> = arms.iter().flat_map(|(c, e)| [c, e]).collect();
                list.push(otherwise);
                list
            }
        }
    }
}

/// Iterator over an expression and its subexpressions, without recursion.
pub struct Parts<'e> {
    open: Vec<&'e Expr>,
}

impl<'e> Iterator for Parts<'e> {
    type Item = &'e Expr;

    fn next(&mut self) -> Option<&'e Expr> {
        let e = self.open.pop()?;
        self.open.extend(e.children());
        Some(e)
    }
}
