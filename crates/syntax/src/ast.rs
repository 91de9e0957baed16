//! The tree of a `.mech` file, as written: every node with its span, no meaning yet.

use mechc_text::source::Span;

/// A name as written, in NFC.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Name {
    /// In NFC.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// A whole file.
#[derive(Clone, PartialEq, Debug)]
pub struct File {
    /// The files that it uses, in order.
    pub uses: Vec<UsedFile>,
    /// In order.
    pub mechanisms: Vec<Mechanism>,
}

/// `use "FILE.mech" as PREFIX`
#[derive(Clone, PartialEq, Debug)]
pub struct UsedFile {
    /// The text of the `///` lines above.
    pub docs: Vec<String>,
    /// All of it.
    pub span: Span,
    /// The path as written, with the place of the string; nothing where it cannot be read.
    pub path: Option<Name>,
    /// What stands before the names of its mechanisms.
    pub prefix: Option<Name>,
    /// Whether a part of it does not follow the grammar: it may have been meant to give any name.
    pub is_broken: bool,
}

/// `mechanism NAME { … }`.
#[derive(Clone, PartialEq, Debug)]
pub struct Mechanism {
    /// The text of the `///` lines above.
    pub docs: Vec<String>,
    /// Its name.
    pub name: Name,
    /// The keyword to the closing brace.
    pub span: Span,
    /// In order.
    pub items: Vec<Item>,
}

/// A declaration with its documentation.
#[derive(Clone, PartialEq, Debug)]
pub struct Item {
    /// The text of the `///` lines above.
    pub docs: Vec<String>,
    /// The whole declaration.
    pub span: Span,
    /// Behind its name: it stands for one declaration for each of the numbers.
    pub ranges: Vec<IndexRange>,
    /// Which one.
    pub kind: ItemKind,
}

impl Item {
    /// Its formulas, those of its features and ranges among them.
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
            ItemKind::Analysis { from, to, every } => all.extend([from, to, every]),
        }
        all
    }
}

/// `k in 0..n`: the whole numbers from one to another.
#[derive(Clone, PartialEq, Debug)]
pub struct IndexRange {
    /// What the number is called in the declaration.
    pub index: Name,
    /// The first number.
    pub from: Expr,
    /// The last number, or the one behind it.
    pub to: Expr,
    /// `..=`: the last number is one of them.
    pub is_closed: bool,
}

/// The declarations of a mechanism.
#[derive(Clone, PartialEq, Debug)]
pub enum ItemKind {
    /// `param NAME = EXPR`
    Param {
        /// Its name.
        name: Name,
        /// Its formula.
        value: Expr,
    },
    /// `fn NAME(ARGUMENT) = EXPR`
    Function {
        /// Its name.
        name: Name,
        /// Its one argument.
        argument: Name,
        /// Its formula.
        value: Expr,
    },
    /// `table NAME = periodic? spline …`
    Table {
        /// Its name.
        name: Name,
        /// Whether it repeats.
        periodic: bool,
        /// Its points.
        rows: TableRows,
    },
    /// `input NAME = EXPR`
    Input {
        /// Its name.
        name: Name,
        /// What it is unless something else is said.
        value: Expr,
    },
    /// `part NAME: MECHANISM(BINDING, …) on BODY at (x, y, phi) mirrored`
    Part(Box<Part>),
    /// `ground { … }`
    Ground {
        /// Its features.
        features: Vec<Feature>,
    },
    /// `body NAME at (x, y, phi) { … }`, `body NAME at (P, phi) { … }`, `body NAME at P toward Q { … }`
    Body {
        /// Its name.
        name: Name,
        /// What stands behind `at`.
        pose: Option<DrawnPose>,
        /// Its features.
        features: Vec<Feature>,
    },
    /// `joint NAME: KIND(…)`
    Joint {
        /// Its name.
        name: Name,
        /// The kind of joint.
        kind: Name,
        /// What it joins.
        arguments: Vec<Expr>,
        /// `KIND(…)`.
        call_span: Span,
    },
    /// `constraint NAME: EXPR = EXPR` or `driver NAME: EXPR = EXPR`
    Equation {
        /// Which of the two.
        driver: bool,
        /// Its name.
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
        /// Its name.
        name: Name,
        /// The force or torque.
        force: Expr,
        /// What it works on.
        on: Expr,
    },
    /// `measure NAME = EXPR in UNIT`
    Measure {
        /// Its name.
        name: Name,
        /// Its formula.
        value: Expr,
        /// The unit behind `in`.
        unit: Option<WrittenUnit>,
    },
    /// `trace NAME = P in UNIT`
    Trace {
        /// Its name.
        name: Name,
        /// A point of a body, or a tuple.
        point: Expr,
        /// The unit behind `in`.
        unit: Option<WrittenUnit>,
    },
    /// `result NAME = EXPR in UNIT`
    Result {
        /// Its name.
        name: Name,
        /// Its formula, over reductions.
        value: Expr,
        /// The unit behind `in`.
        unit: Option<WrittenUnit>,
    },
    /// What does not follow the grammar
    Broken {
        /// The names that it may have declared.
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
    /// The features of the ground or of a body.
    pub fn features_mut(&mut self) -> Option<&mut Vec<Feature>> {
        match self {
            ItemKind::Ground { features } | ItemKind::Body { features, .. } => Some(features),
            _ => None,
        }
    }
}

/// The declarations of another mechanism, once more.
#[derive(Clone, PartialEq, Debug)]
pub struct Part {
    /// Its name.
    pub name: Name,
    /// Which mechanism it is.
    pub mechanism: MechanismName,
    /// What is said of its params and inputs.
    pub bindings: Vec<Binding>,
    /// What carries it, if that is said.
    pub on: Option<Expr>,
    /// Where its frame stands in the frame of what carries it.
    pub at: Option<Expr>,
    /// Where it says that y is turned over.
    pub mirrored: Option<Span>,
    /// `MECHANISM(…)`
    pub call_span: Span,
}

/// The name of a mechanism, as a part has it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct MechanismName {
    /// What stands before its names, where a file is used under one.
    pub prefix: Option<Name>,
    /// Its own name.
    pub name: Name,
}

impl MechanismName {
    /// Both of its words.
    #[must_use]
    pub fn span(&self) -> Span {
        self.prefix.as_ref().map_or(self.name.span, |prefix| prefix.span.to(self.name.span))
    }

    /// As it is written.
    #[must_use]
    pub fn text(&self) -> String {
        self.prefix.as_ref().map_or(String::new(), |prefix| format!("{}.", prefix.text)) + &self.name.text
    }
}

/// `turn = angle(shaft)`, `A.x = 3 mm`: what a param or input of a part is.
#[derive(Clone, PartialEq, Debug)]
pub struct Binding {
    /// Of the part.
    pub name: Name,
    /// Which of its coordinates, where it is a point of which one is bound.
    pub coordinate: Option<Name>,
    /// A formula over the names of the mechanism around the part.
    pub value: Expr,
    /// All of it.
    pub span: Span,
}

/// Where a table's points come from.
#[derive(Clone, PartialEq, Debug)]
pub enum TableRows {
    /// `[(a, b), …]`
    Listed(Vec<Expr>),
    /// `"file.csv" columns 1, 3 (unit, unit)`
    File {
        /// Path as written, with its place.
        path: Name,
        /// Which two of its columns; the first two if it has no others.
        columns: Option<[ColumnName; 2]>,
        /// Units of the two columns.
        units: Option<[WrittenUnit; 2]>,
    },
}

/// Where a body is drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct DrawnPose {
    /// `(x, y, phi)`, `(P, phi)`, or before `toward` a point alone.
    pub at: Expr,
    /// The point that the body's x axis goes to.
    pub toward: Option<Expr>,
}

impl DrawnPose {
    /// All that stands behind `at`.
    #[must_use]
    pub fn span(&self) -> Span {
        self.toward.as_ref().map_or(self.at.span, |toward| self.at.span.to(toward.span))
    }

    /// Its formulas.
    pub fn parts(&self) -> impl Iterator<Item = &Expr> {
        std::iter::once(&self.at).chain(&self.toward)
    }
}

/// A column of a file, as it is named in a text.
#[derive(Clone, PartialEq, Debug)]
pub struct ColumnName {
    /// Which one.
    pub kind: ColumnWord,
    /// Where it is named.
    pub span: Span,
}

/// The ways to name a column.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum ColumnWord {
    /// By its number, from 1.
    Number(u32),
    /// By its name in the header line.
    Named(String),
}

/// Units with powers, joined by `*` and `/`: `mm/s^2`.
#[derive(Clone, PartialEq, Debug)]
pub struct WrittenUnit {
    /// In order, one at least; the first one divides in `1/s`.
    pub factors: Vec<UnitFactor>,
    /// All of it.
    pub span: Span,
}

/// A unit with its power, in a product.
#[derive(Clone, PartialEq, Debug)]
pub struct UnitFactor {
    /// The unit.
    pub name: Name,
    /// Its power as written.
    pub power: i32,
    /// Whether it multiplies or divides.
    pub factor: Factor,
    /// With its power.
    pub span: Span,
}

/// A feature of a body or of the ground.
#[derive(Clone, PartialEq, Debug)]
pub struct Feature {
    /// The text of the `///` lines above.
    pub docs: Vec<String>,
    /// The whole declaration.
    pub span: Span,
    /// Its name; empty of a mass, which has none, and where it cannot be read.
    pub name: Name,
    /// Which one.
    pub kind: FeatureKind,
}

/// The kinds of features. Points are many, so that what others have more stands elsewhere.
#[derive(Clone, PartialEq, Debug)]
pub enum FeatureKind {
    /// What does not follow the grammar
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
        /// The name of the parameter.
        argument: Name,
        /// A formula of points, over the parameter.
        at: Box<Expr>,
        /// First estimate of the parameter.
        estimate: Option<Box<Expr>>,
    },
    /// `mass M at (x, y) inertia I`
    Mass {
        /// How much.
        mass: Box<Expr>,
        /// Its centre: a formula of points.
        at: Option<Box<Expr>>,
        /// Its moment of inertia about that.
        inertia: Option<Box<Expr>>,
    },
}

impl Feature {
    /// Its formulas.
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

/// A formula, or a tuple of formulas, or a condition: which one its place allows is for `check` to say.
#[derive(Clone, PartialEq, Debug)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it stands.
    pub span: Span,
}

/// The forms of an expression. Long sums and chains are flat, so that depth is nesting and nothing else.
#[derive(Clone, PartialEq, Debug)]
pub enum ExprKind {
    /// `50`, `50 mm`, `50 mm^2`
    Literal {
        /// The number.
        value: f64,
        /// Its unit and the unit's power.
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
    /// `link[k].pin`, `link[0]`: what is repeated, by its numbers.
    Path(Vec<PathSegment>),
    /// `x(rod.tip)`
    Call {
        /// What is called.
        name: Name,
        /// In order.
        arguments: Vec<Expr>,
        /// The part of the analysis that a reduction takes, if it does not take all of it.
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
        /// The value if none holds.
        otherwise: Box<Expr>,
    },
}

/// `from A to B`, `from A`, `to B`: a part of the analysis.
#[derive(Clone, PartialEq, Debug)]
pub struct Window {
    /// Its first time; that of the analysis where none is given.
    pub from: Option<Expr>,
    /// Its last time; that of the analysis where none is given.
    pub to: Option<Expr>,
    /// All of it.
    pub span: Span,
}

impl Window {
    /// The times that are given.
    pub fn bounds(&self) -> impl Iterator<Item = &Expr> {
        self.from.iter().chain(&self.to)
    }
}

/// A part of a path.
#[derive(Clone, PartialEq, Debug)]
pub struct PathSegment {
    /// Its name.
    pub name: Name,
    /// The numbers in brackets behind it.
    pub indices: Vec<Expr>,
}

/// How a term enters a sum.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Sign {
    /// `+`
    Plus,
    /// `-`
    Minus,
}

/// How a factor enters a product.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Factor {
    /// `*`
    Times,
    /// `/`
    Over,
}

/// The comparisons.
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
    /// The expression inside any parentheses.
    #[must_use]
    pub fn bare(&self) -> &Expr {
        let mut inner = self;
        while let ExprKind::Paren(e) = &inner.kind {
            inner = e;
        }
        inner
    }

    /// A number without a unit, alone but for parentheses and its sign.
    #[must_use]
    pub fn bare_number(&self) -> Option<f64> {
        match &self.bare().kind {
            ExprKind::Literal { value, unit: None } => Some(*value),
            ExprKind::Negate(e) => e.bare_number().map(|v| -v),
            _ => None,
        }
    }

    /// The expression and all that it is made of, each before what it is made of.
    #[must_use]
    pub fn parts(&self) -> Parts<'_> {
        Parts { open: vec![self] }
    }

    /// The direct sub-expressions.
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

/// An expression and all that it is made of. It goes into whatever depth there is without recursion.
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
