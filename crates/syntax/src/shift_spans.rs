//! Shifts the spans of a tree to where its text stands after an edit before it.

use super::ast::{
    Binding, ColumnName, DrawnPose, Expr, ExprKind, Feature, FeatureKind, IndexRange, Item, ItemKind, MechanismName,
    Name, Part, PathSegment, TableRows, UnitFactor, WrittenUnit,
};
use super::build::Head;
use mechc_text::source::{FileId, Span};

/// A shift of spans from one text to another.
#[derive(Clone, Copy)]
pub(super) struct Shift {
    pub file: FileId,
    /// Number of bytes by which spans move, modulo 2^32, since they may move back.
    pub by: u32,
}

impl Shift {
    fn span(self, span: &mut Span) {
        let at = |byte: u32| byte.wrapping_add(self.by);
        *span = Span { file: self.file, start: at(span.start), end: at(span.end) };
    }

    fn name(self, name: &mut Name) {
        self.span(&mut name.span);
    }

    fn names(self, names: &mut [Name]) {
        for name in names {
            self.name(name);
        }
    }

    /// Shifts a declaration; its documentation has no spans.
    pub fn item(self, item: &mut Item) {
        self.span(&mut item.span);
        self.ranges(&mut item.ranges);
        match &mut item.kind {
            ItemKind::Param { name, value } | ItemKind::Input { name, value } => self.defined(name, value),
            ItemKind::Function { name, argument, value } => {
                self.name(argument);
                self.defined(name, value);
            }
            ItemKind::Table { name, periodic: _, rows } => {
                self.name(name);
                self.rows(rows);
            }
            ItemKind::Part(part) => self.part(part),
            ItemKind::Ground { features } => {
                for feature in features {
                    self.feature(feature);
                }
            }
            ItemKind::Body { name, pose, features } => {
                self.name(name);
                if let Some(pose) = pose {
                    self.pose(pose);
                }
                for feature in features {
                    self.feature(feature);
                }
            }
            ItemKind::Joint { name, kind, arguments, call_span } => {
                self.name(name);
                self.name(kind);
                self.exprs(arguments);
                self.span(call_span);
            }
            ItemKind::Equation { driver: _, name, left, right } => {
                self.defined(name, left);
                self.expr(right);
            }
            ItemKind::Gravity { acceleration } => self.expr(acceleration),
            ItemKind::Load { name, force, on } => {
                self.defined(name, force);
                self.expr(on);
            }
            ItemKind::Measure { name, value, unit }
            | ItemKind::Trace { name, point: value, unit }
            | ItemKind::Result { name, value, unit } => {
                self.defined(name, value);
                if let Some(unit) = unit {
                    self.unit(unit);
                }
            }
            ItemKind::Broken { names } => self.names(names),
            ItemKind::Analysis { from, to, every } => {
                for expr in [from, to, every] {
                    self.expr(expr);
                }
            }
        }
    }

    fn defined(self, name: &mut Name, value: &mut Expr) {
        self.name(name);
        self.expr(value);
    }

    /// Shifts the head of a body.
    pub fn head(self, head: &mut Head) {
        self.name(&mut head.name);
        self.ranges(&mut head.ranges);
        if let Some(pose) = &mut head.pose {
            self.pose(pose);
        }
    }

    fn ranges(self, ranges: &mut [IndexRange]) {
        for IndexRange { index, from, to, is_closed: _ } in ranges {
            self.defined(index, from);
            self.expr(to);
        }
    }

    fn pose(self, pose: &mut DrawnPose) {
        self.expr(&mut pose.at);
        if let Some(toward) = &mut pose.toward {
            self.expr(toward);
        }
    }

    /// Shifts a feature of a body.
    pub fn feature(self, feature: &mut Feature) {
        self.span(&mut feature.span);
        self.name(&mut feature.name);
        match &mut feature.kind {
            FeatureKind::Broken => {}
            FeatureKind::Point { at } => {
                if let Some(at) = at {
                    self.expr(at);
                }
            }
            FeatureKind::AxisAlong { origin: one, direction: two }
            | FeatureKind::AxisTo { origin: one, target: two }
            | FeatureKind::Circle { center: one, radius: two } => {
                self.expr(one);
                self.expr(two);
            }
            FeatureKind::Curve { argument, at, estimate } => {
                self.defined(argument, at);
                if let Some(estimate) = estimate {
                    self.expr(estimate);
                }
            }
            FeatureKind::Mass { mass, at, inertia } => {
                for expr in std::iter::once(mass).chain(at).chain(inertia) {
                    self.expr(expr);
                }
            }
        }
    }

    fn rows(self, rows: &mut TableRows) {
        match rows {
            TableRows::Listed(rows) => self.exprs(rows),
            TableRows::File { path, columns, units } => {
                self.name(path);
                for ColumnName { kind: _, span } in columns.iter_mut().flatten() {
                    self.span(span);
                }
                for unit in units.iter_mut().flatten() {
                    self.unit(unit);
                }
            }
        }
    }

    fn part(self, part: &mut Part) {
        let Part { name, mechanism: MechanismName { prefix, name: local }, bindings, on, at, mirrored, call_span } =
            part;
        self.name(name);
        if let Some(prefix) = prefix {
            self.name(prefix);
        }
        self.name(local);
        for Binding { name, coordinate, value, span } in bindings {
            self.defined(name, value);
            if let Some(coordinate) = coordinate {
                self.name(coordinate);
            }
            self.span(span);
        }
        for expr in on.iter_mut().chain(at) {
            self.expr(expr);
        }
        if let Some(mirrored) = mirrored {
            self.span(mirrored);
        }
        self.span(call_span);
    }

    fn unit(self, unit: &mut WrittenUnit) {
        self.span(&mut unit.span);
        for UnitFactor { name, power: _, factor: _, span } in &mut unit.factors {
            self.name(name);
            self.span(span);
        }
    }

    fn exprs(self, exprs: &mut [Expr]) {
        for expr in exprs {
            self.expr(expr);
        }
    }

    fn expr(self, expr: &mut Expr) {
        self.span(&mut expr.span);
        match &mut expr.kind {
            ExprKind::Literal { value: _, unit } => {
                if let Some((unit, _)) = unit {
                    self.name(unit);
                }
            }
            ExprKind::Name(name) => self.name(name),
            ExprKind::Member { owner, feature } => {
                self.name(owner);
                self.name(feature);
            }
            ExprKind::Path(segments) => {
                for PathSegment { name, indices } in segments {
                    self.name(name);
                    self.exprs(indices);
                }
            }
            ExprKind::Call { name, arguments, window } => {
                self.name(name);
                self.exprs(arguments);
                if let Some(window) = window {
                    self.span(&mut window.span);
                    window.from.iter_mut().chain(&mut window.to).for_each(|bound| self.expr(bound));
                }
            }
            ExprKind::Paren(e) | ExprKind::Negate(e) | ExprKind::Not(e) => self.expr(e),
            ExprKind::Tuple(list) | ExprKind::And(list) | ExprKind::Or(list) => self.exprs(list),
            ExprKind::Sum(first, rest) => {
                self.expr(first);
                for (_, e) in rest {
                    self.expr(e);
                }
            }
            ExprKind::Product(first, rest) => {
                self.expr(first);
                for (_, e) in rest {
                    self.expr(e);
                }
            }
            ExprKind::Power(a, b) | ExprKind::Compare(a, _, b) => {
                self.expr(a);
                self.expr(b);
            }
            ExprKind::If { arms, otherwise } => {
                for (condition, value) in arms {
                    self.expr(condition);
                    self.expr(value);
                }
                self.expr(otherwise);
            }
        }
    }
}
