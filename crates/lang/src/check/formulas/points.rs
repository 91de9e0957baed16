//! Formulas of points: sums, multiples, `polar` and `mid`; and numbers that depend on two points.
//!
//! A point is two lengths. In a body its own points take precedence over those of the mechanism. After `at` points of other bodies are
//! allowed, at their drawn positions.

use super::Formulas;
use super::dimensions::require_dimension;
use super::formula_scope::{FormulaSite, InitialPoint, Position};
use super::point_names::PointLookup;
use super::quantities::describe;
use super::reductions::reject_window;
use super::value::{Context, Dim, Value};
use crate::check::errors::{self, Reporter};
use crate::check::scope::{Expected, coordinate};

use crate::model::{Dimension, Frame, GuardKind};
use mechc_expr::{Binary, Comparison, ExprId, Graph, Node, Unary};
use mechc_syntax::ast::{Expr, ExprKind, Factor, Name, Sign, Window};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Function, Keyword};
use rustc_hash::FxHashSet;

/// The formula is not a coordinate of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct NotAPoint;

/// A product up to some factor.
enum Scaled {
    Number(Value),
    /// With the dimension of its numeric factors.
    Point(Position, Dim),
}

impl Formulas<'_> {
    /// Evaluates a whole formula of points, judged on its own.
    pub(super) fn point_formula(&mut self, e: &Expr, context: &Context<'_>) -> Option<InitialPoint> {
        let argument = context.argument.map(|(name, _)| name);
        let dimensional = context.judged || self.holds_dimension(argument, e, Expected::Point);
        self.start_count();
        let at = self.point_at(e, &Context { judged: dimensional, ..*context })?;
        Some(InitialPoint { at, dimensional })
    }

    /// Evaluates a formula of points within another one; `None` if it is broken, which has been reported.
    fn point_at(&mut self, e: &Expr, context: &Context<'_>) -> Option<Position> {
        self.level(context, |formulas| formulas.point_here(e, context))
    }

    fn point_here(&mut self, e: &Expr, context: &Context<'_>) -> Option<Position> {
        self.count_part(e.span)?;
        match &e.kind {
            ExprKind::Paren(inner) => self.point_at(inner, context),
            ExprKind::Tuple(parts) => self.literal_point(e, parts, context),
            ExprKind::Name(name) => self.named_point(name, context),
            ExprKind::Member { owner, feature } => self.feature_point(e, owner, feature),
            ExprKind::Negate(inner) => {
                let at = self.point_at(inner, context)?;
                Some(at.map(|id| self.model.graph.neg(id)))
            }
            ExprKind::Sum(first, rest) => self.sum_of_points(first, rest, context),
            ExprKind::Product(first, rest) => self.multiple(e, first, rest, context),
            ExprKind::Call { name, arguments, window } => {
                self.called_point(e, (name, window.as_deref()), arguments, context)
            }
            _ => {
                no_point(&mut self.reporter, e);
                None
            }
        }
    }

    fn literal_point(&mut self, e: &Expr, parts: &[Expr], context: &Context<'_>) -> Option<Position> {
        let [x, y] = parts else {
            let word = Keyword::named("point").map(|keyword| &keyword.word);
            let diagnostic = errors::argument_count("point", word, e.span, "two lengths", parts.len());
            self.reporter.report(diagnostic.instead_if(self.suggest_decimal_point(parts, 2)));
            return None;
        };
        let values = [x, y].map(|part| self.number(part, context));
        self.two_lengths([x, y], values, context)
    }

    fn named_point(&mut self, name: &Name, context: &Context<'_>) -> Option<Position> {
        if !context.names {
            self.reporter.report(errors::names_in_option(name));
            return None;
        }
        match self.lookup_point(name, Expected::Point) {
            PointLookup::Point(drawn) => Some(drawn.at),
            PointLookup::Broken => None,
            PointLookup::NotAPoint => {
                self.no_point_named(name);
                None
            }
        }
    }

    /// Evaluates `crank.pin` at its drawn position.
    fn feature_point(&mut self, e: &Expr, owner: &Name, feature: &Name) -> Option<Position> {
        if self.is_named_point(owner) || self.scope.is_body(owner) && !self.current.site.takes_drawn_points() {
            let diagnostic = self.no_place(e.span, owner, feature);
            self.reporter.report(diagnostic);
            return None;
        }
        let frame = self.body(owner)?;
        let point = self.point_named(frame, feature)?;
        let at = self.model[point].at;
        match self.current.site {
            FormulaSite::Mount(mount) => self.drawn_from(mount, frame, at),
            _ => self.drawn_place(frame, at),
        }
    }

    /// Returns the drawn position of a frame's point in this text's frame; `None` if a pose is broken.
    pub(super) fn drawn_place(&mut self, frame: Frame, [x, y]: Position) -> Option<Position> {
        if frame == self.address.ground {
            return Some([x, y]);
        }
        if self.is_place_broken(frame) {
            return None;
        }
        let Some(body) = self.local_body(frame) else {
            let placement = self.drawn_frame(frame);
            return Some(placement.placed(&mut self.model.graph, [x, y]));
        };
        let [origin_x, origin_y, phi] = self.model[body].pose;
        let graph = &mut self.model.graph;
        let (sin, cos) = (graph.unary(Unary::Sin, phi), graph.unary(Unary::Cos, phi));
        let (x_cos, y_sin) = (graph.mul(x, cos), graph.mul(y, sin));
        let (x_sin, y_cos) = (graph.mul(x, sin), graph.mul(y, cos));
        let (dx, dy) = (graph.sub(x_cos, y_sin), graph.add(x_sin, y_cos));
        Some([graph.add(origin_x, dx), graph.add(origin_y, dy)])
    }

    fn sum_of_points(&mut self, first: &Expr, rest: &[(Sign, Expr)], context: &Context<'_>) -> Option<Position> {
        let mut sum = self.point_at(first, context);
        for (sign, term) in rest {
            let (Some(left), Some(right)) = (sum, self.point_at(term, context)) else {
                sum = None;
                continue;
            };
            let graph = &mut self.model.graph;
            sum = Some([0, 1].map(|k| match sign {
                Sign::Plus => graph.add(left[k], right[k]),
                Sign::Minus => graph.sub(left[k], right[k]),
            }));
        }
        sum
    }

    /// Evaluates a point multiplied or divided by numbers.
    fn multiple(&mut self, e: &Expr, first: &Expr, rest: &[(Factor, Expr)], context: &Context<'_>) -> Option<Position> {
        let mut product = self.factor(first, context);
        for (factor, term) in rest {
            let (Some(left), Some(right)) = (product, self.factor(term, context)) else {
                product = None;
                continue;
            };
            product = self.scaled(left, *factor, right, term.span);
        }
        match product? {
            Scaled::Point(at, dim) => {
                require_dimension(
                    &mut self.reporter,
                    "what a point is multiplied by",
                    Dimension::PURE,
                    e.span,
                    dim,
                    context,
                )?;
                self.finite_point(e.span, at)
            }
            Scaled::Number(_) => {
                self.reporter
                    .report(errors::wrong_kind(e.span, "a point", "a number").help("a point is written `(x, y)`"));
                None
            }
        }
    }

    fn factor(&mut self, e: &Expr, context: &Context<'_>) -> Option<Scaled> {
        if self.is_point(e) {
            self.point_at(e, context).map(|at| Scaled::Point(at, Dim::PURE))
        } else {
            self.number(e, context).map(Scaled::Number)
        }
    }

    fn scaled(&mut self, left: Scaled, factor: Factor, right: Scaled, span: Span) -> Option<Scaled> {
        let graph = &mut self.model.graph;
        let of = |dimension: fn(Dimension, Dimension) -> Dimension, a: Dim, b: Dim| a.with(b, dimension);
        Some(match (left, factor, right) {
            (Scaled::Number(a), Factor::Times, Scaled::Number(b)) => {
                Scaled::Number(Value { id: graph.mul(a.id, b.id), dim: of(Dimension::times, a.dim, b.dim) })
            }
            (Scaled::Number(a), Factor::Divide, Scaled::Number(b)) => {
                Scaled::Number(Value { id: graph.div(a.id, b.id), dim: of(Dimension::over, a.dim, b.dim) })
            }
            (Scaled::Number(a), Factor::Times, Scaled::Point(at, dim)) => {
                Scaled::Point(at.map(|id| graph.mul(a.id, id)), of(Dimension::times, a.dim, dim))
            }
            (Scaled::Point(at, dim), Factor::Times, Scaled::Number(b)) => {
                Scaled::Point(at.map(|id| graph.mul(id, b.id)), of(Dimension::times, dim, b.dim))
            }
            (Scaled::Point(at, dim), Factor::Divide, Scaled::Number(b)) => {
                Scaled::Point(at.map(|id| graph.div(id, b.id)), of(Dimension::over, dim, b.dim))
            }
            (Scaled::Point(..), Factor::Times, Scaled::Point(..)) | (_, Factor::Divide, Scaled::Point(..)) => {
                self.reporter.report(errors::product_of_points(span, factor == Factor::Divide));
                return None;
            }
        })
    }

    fn finite_point(&mut self, span: Span, at: Position) -> Option<Position> {
        for id in at {
            self.finite(span, Value { id, dim: Dim::LENGTH })?;
        }
        Some(at)
    }

    /// Evaluates `polar(r, angle)` or `mid(P, Q)`.
    fn called_point(
        &mut self,
        e: &Expr,
        (name, window): (&Name, Option<&Window>),
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Position> {
        if self.scope.hides(&name.text) || !matches!(name.text.as_str(), "polar" | "mid") {
            // A fault of the call itself explains more.
            self.number(e, context)?;
            no_point(&mut self.reporter, e);
            return None;
        }
        reject_window(&mut self.reporter, name, window)?;
        let [first, second] = two_arguments(&mut self.reporter, e, name, arguments)?;
        if name.text == "polar" {
            return self.polar(first, second, context);
        }
        let (p, q) = (self.point_at(first, context), self.point_at(second, context));
        let (p, q) = (p?, q?);
        let graph = &mut self.model.graph;
        let half = graph.constant(0.5);
        Some([0, 1].map(|k| {
            let sum = graph.add(p[k], q[k]);
            graph.mul(half, sum)
        }))
    }

    fn polar(&mut self, radius: &Expr, angle: &Expr, context: &Context<'_>) -> Option<Position> {
        self.warn_of_degrees_in(angle);
        let (r, a) = (self.number(radius, context), self.number(angle, context));
        let (r, a) = (r?, a?);
        if !context.judged && self.reject_angle("the first argument of `polar`", radius) {
            return None;
        }
        require_dimension(
            &mut self.reporter,
            "the first argument of `polar`",
            Dimension::LENGTH,
            radius.span,
            r.dim,
            context,
        )?;
        require_dimension(&mut self.reporter, "the angle of `polar`", Dimension::PURE, angle.span, a.dim, context)?;
        self.record_length_term(radius, r.id, context.judged);
        let graph = &mut self.model.graph;
        let (sin, cos) = (graph.unary(Unary::Sin, a.id), graph.unary(Unary::Cos, a.id));
        Some([graph.mul(r.id, cos), graph.mul(r.id, sin)])
    }

    // ---- numbers of points

    /// Evaluates `length(P, Q)` or `direction(P, Q)`.
    pub(super) fn number_of_points(
        &mut self,
        e: &Expr,
        name: &Name,
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Value> {
        if matches!(name.text.as_str(), "polar" | "mid") {
            self.reporter.report(errors::wrong_kind(e.span, "a number", "a point"));
            return None;
        }
        let [first, second] = two_arguments(&mut self.reporter, e, name, arguments)?;
        if let Some(member) = self.moving_among([first, second]).filter(|_| name.text == "length") {
            let texts = [first, second].map(|e| self.reporter.text(e.span));
            self.reporter.report(errors::length_of_moving(name, member, texts));
            return None;
        }
        let argument = context.argument.map(|(name, _)| name);
        let judged = [first, second].into_iter().any(|e| self.holds_dimension(argument, e, Expected::Point));
        let inner = Context {
            judged,
            time: false,
            quantities: false,
            rates: false,
            measures: false,
            ..context.at("a point", context.argument)
        };
        let (p, q) = (self.point_at(first, &inner), self.point_at(second, &inner));
        let (p, q) = (p?, q?);
        let offset = [0, 1].map(|k| self.model.graph.sub(q[k], p[k]));
        if name.text == "length" {
            let id = self.model.graph.binary(Binary::Hypot, offset[0], offset[1]);
            return Some(Value { id, dim: Dim::LENGTH });
        }
        let id = self.direction_of_vector(offset, "`direction`", e.span)?;
        Some(Value { id, dim: Dim::PURE })
    }

    /// Returns the location of a body's point among two points, if the site allows no drawn points.
    fn moving_among(&self, points: [&Expr; 2]) -> Option<Span> {
        let is_moving = |e: &&Expr| match &e.bare().kind {
            ExprKind::Member { owner, .. } => self.scope.is_body(owner) && !self.is_named_point(owner),
            _ => false,
        };
        points.into_iter().find(is_moving).map(|e| e.span).filter(|_| !self.current.site.takes_drawn_points())
    }

    /// Returns the angle of the vector between two points, in (−π, π].
    pub(super) fn direction_of_vector(&mut self, offset: Position, what: &str, span: Span) -> Option<ExprId> {
        let [dx, dy] = offset.map(|id| self.decided(id, GuardKind::Sign));
        if dx == Some(0.0) && dy == Some(0.0) && !self.branch.is_untaken {
            self.reporter.report(errors::points_coincide(what, span));
            return None;
        }
        let graph = &mut self.model.graph;
        let angle = graph.binary(Binary::Atan2, offset[1], offset[0]);
        // `atan2` of a negative zero is −π.
        if !may_be_negative_zero(graph, offset[1]) {
            return Some(angle);
        }
        let [lowest, turn] = [-std::f64::consts::PI, std::f64::consts::TAU].map(|value| graph.constant(value));
        let is_lowest = graph.compare(Comparison::LessEqual, angle, lowest);
        let other = graph.add(angle, turn);
        Some(graph.select(is_lowest, other, angle))
    }

    /// Evaluates `P.x`, a coordinate of a point; `None` if it is broken, which has been reported.
    pub(super) fn coordinate_of(&mut self, e: &Expr, context: &Context<'_>) -> Result<Option<Value>, NotAPoint> {
        let ExprKind::Member { owner, feature } = &e.kind else { return Err(NotAPoint) };
        if !context.names {
            self.scope.point_param(owner).ok_or(NotAPoint)?;
            self.reporter.report(errors::names_in_option(owner));
            return Ok(None);
        }
        let drawn = match self.lookup_point(owner, Expected::Point) {
            PointLookup::NotAPoint => return Err(NotAPoint),
            PointLookup::Broken => return Ok(None),
            PointLookup::Point(drawn) => drawn,
        };
        let Some(k) = coordinate(feature) else {
            self.reporter.report(errors::no_coordinate(owner, feature));
            return Ok(None);
        };
        Ok(Some(Value { id: drawn.at[k], dim: Dim::LENGTH }))
    }
}

/// Returns whether a formula could be −0. Params are not, nor are differences and means of such.
fn may_be_negative_zero(graph: &Graph, id: ExprId) -> bool {
    let mut open = vec![id];
    let mut visited = FxHashSet::default();
    while let Some(id) = open.pop() {
        if !visited.insert(id) {
            continue;
        }
        match graph.node(id) {
            Node::Const(bits) if bits == (-0.0_f64).to_bits() => return true,
            Node::Const(_) | Node::Symbol(_) => {}
            Node::Add(a, b) => open.extend([a, b]),
            // A difference of +0 and 0 is +0.
            Node::Sub(a, _) => open.push(a),
            Node::Mul(a, b) if graph.as_const(a).is_some_and(|factor| factor > 0.0) => open.push(b),
            _ => return true,
        }
    }
    false
}

fn two_arguments<'e>(
    reporter: &mut Reporter<'_>,
    e: &Expr,
    name: &Name,
    arguments: &'e [Expr],
) -> Option<[&'e Expr; 2]> {
    if let [first, second] = arguments {
        return Some([first, second]);
    }
    let function = Function::named(&name.text)?;
    let found = arguments.len();
    reporter.report(errors::argument_count(&name.text, Some(&function.word), e.span, &function.takes(), found));
    None
}

/// Reports a formula that is not a point.
fn no_point(reporter: &mut Reporter<'_>, e: &Expr) {
    let found = match &e.kind {
        ExprKind::If { .. } => "an `if`",
        ExprKind::Call { .. } => "a number",
        _ => describe(e),
    };
    let diagnostic = errors::wrong_kind(e.span, "a point", found);
    reporter.report(match &e.kind {
        ExprKind::If { .. } => diagnostic.help("choose the coordinates: `(if … then … else …, …)`"),
        ExprKind::Literal { .. } | ExprKind::Call { .. } => diagnostic.help("a point is written `(x, y)`"),
        _ => diagnostic,
    });
}
