//! Bodies, the ground, and their features. Circles and curves are in `profiles`.

use super::dimensions::require_dimension;
use super::entity::Entity;
use super::formula::{Context, Value};
use super::formula_scope::{FormulaSite, InitialPoint};
use super::names::{Space, ordered};
use super::point_kinds::{self, Expected, coordinate};
use super::quantities::describe;
use super::{Checker, errors};
use crate::model::{Axis, AxisId, Body, CircleId, CurveId, Dimension, Frame, GuardKind, Point, PointId};
use mechc_expr::ExprId;
use mechc_syntax::ast::{self, DrawnPose, Expr, ExprKind, FeatureKind, Item, ItemKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::Keyword;
use rustc_hash::FxHashMap;

/// A feature that a name of a body stands for; `None` if it is broken, which has been reported.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Feature {
    Point(Option<PointId>),
    Axis(Option<AxisId>),
    Circle(Option<CircleId>),
    Curve(Option<CurveId>),
    /// Its declaration does not follow the grammar, which has been reported.
    Broken,
}

impl Feature {
    /// Returns whether it can stand where a feature of that kind is expected. A circle can stand for a curve.
    pub fn is(self, what: &str) -> bool {
        match self {
            Feature::Point(_) => what == "point",
            Feature::Axis(_) => what == "axis",
            Feature::Circle(_) => ["circle", "curve"].contains(&what),
            Feature::Curve(_) => what == "curve",
            Feature::Broken => false,
        }
    }

    /// Returns the noun of the keyword that declares it.
    pub fn with_article(keyword: &str) -> &'static str {
        match keyword {
            "point" => "a point",
            "axis" => "an axis",
            "circle" => "a circle",
            _ => "a curve or a circle",
        }
    }

    pub fn noun(self) -> &'static str {
        match self {
            Feature::Point(_) => "a point",
            Feature::Axis(_) => "an axis",
            Feature::Circle(_) => "a circle",
            Feature::Curve(_) => "a curve",
            Feature::Broken => "a feature that cannot be read",
        }
    }
}

impl<'a> Checker<'a> {
    /// Evaluates bodies, features and poses.
    pub(super) fn features(&mut self) {
        self.add_frames();
        self.collect_all_features();
        self.mount_parts();
        self.read_features();
        self.poses();
    }

    /// Declares bodies and the grounds of parts, in the order of the text.
    pub(super) fn add_frames(&mut self) {
        self.common.features.insert(self.address.ground, Space::new());
        let mut parts = 0..;
        for item in self.scope.items() {
            match &item.kind {
                ItemKind::Ground { features } => self.frames.push((self.address.ground, features)),
                ItemKind::Body { name, features, .. } => {
                    let frame = self.add_body(item, name);
                    self.frames.push((frame, features));
                }
                ItemKind::Part(part) => self.add_part(parts.next().unwrap_or_default(), part),
                _ => {}
            }
        }
        self.import_frames();
    }

    pub(super) fn collect_all_features(&mut self) {
        for (frame, features) in self.frames.clone() {
            self.collect_features(frame, features);
        }
        self.in_parts(Checker::collect_all_features);
    }

    /// Evaluates points first, then the features that use them, so that points may be used before their declaration.
    pub(super) fn read_features(&mut self) {
        let frames = self.frames.clone();
        for &(frame, features) in &frames {
            self.points_of(frame, features);
        }
        for &(frame, features) in &frames {
            self.axes_of(frame, features);
            self.profiles_of(frame, features);
            self.masses_of(frame, features);
        }
        self.in_parts(Checker::read_features);
    }

    fn add_body(&mut self, item: &Item, name: &Name) -> Frame {
        let zero = self.model.graph.constant(0.0);
        let pose_span = match &item.kind {
            ItemKind::Body { pose, .. } => pose.as_ref().map(DrawnPose::span),
            _ => None,
        };
        let (declared, part) = (self.scope.declared(name), self.address.part);
        let id = self.model.add_body(Body { part, declared, docs: item.docs.clone(), pose: [zero; 3], pose_span });
        self.bodies.push(Frame::Body(id));
        self.common.features.insert(Frame::Body(id), Space::new());
        Frame::Body(id)
    }

    fn collect_features(&mut self, frame: Frame, features: &[ast::Feature]) {
        for feature in features {
            let entity = match feature.kind {
                FeatureKind::Point { .. } => Feature::Point(None),
                FeatureKind::AxisAlong { .. } | FeatureKind::AxisTo { .. } => Feature::Axis(None),
                FeatureKind::Circle { .. } => Feature::Circle(None),
                FeatureKind::Curve { .. } => Feature::Curve(None),
                FeatureKind::Mass { .. } => continue,
                FeatureKind::Broken if feature.name.text.is_empty() => {
                    if let Some(space) = self.common.features.get_mut(&frame) {
                        space.declare_nameless();
                    }
                    continue;
                }
                FeatureKind::Broken => Feature::Broken,
            };
            let first =
                self.common.features.get_mut(&frame).and_then(|space| space.declare(&feature.name, entity).err());
            if let Some(first) = first {
                self.reporter.report(errors::declared_twice(&feature.name, first));
            }
        }
    }

    /// Evaluates points, each after those that its formula uses.
    fn points_of(&mut self, frame: Frame, features: &'a [ast::Feature]) {
        let mut points = Vec::new();
        for feature in features {
            if let FeatureKind::Point { at } = &feature.kind {
                points.push((&feature.name, at.as_ref()));
            }
        }
        let uses = self.uses_of_points(frame, &points);
        for k in ordered(&mut self.reporter, &uses).order {
            let (name, at) = points[k];
            let drawn = self.at_site(FormulaSite::Inside(frame), Some(&name.text), |checker| match at {
                Some(at) => checker.place_of(at, "point", "a point", None),
                None => checker.point_of_the_mechanism(name),
            });
            let point = drawn.map(|InitialPoint { at, dimensional }| {
                let point = Point { frame, name: Some(name.text.clone()), span: name.span, at };
                let id = self.model.add_point(point);
                self.common.dimensional_points.extend(dimensional.then_some(id));
                id
            });
            self.settle(frame, name, Feature::Point(point));
        }
    }

    /// Returns the points of a body that the formula of each one uses.
    fn uses_of_points<'n>(
        &mut self,
        frame: Frame,
        points: &[(&'n Name, Option<&'a Expr>)],
    ) -> Vec<(&'n Name, Vec<(usize, Span)>)> {
        // A duplicate name keeps its first meaning.
        let mut positions = FxHashMap::default();
        for (k, (name, _)) in points.iter().enumerate() {
            positions.entry(name.text.as_str()).or_insert(k);
        }
        let outer = std::mem::replace(&mut self.current.site, FormulaSite::Inside(frame));
        let uses = points.iter().map(|&(name, formula)| {
            let mut uses = Vec::new();
            if let Some(formula) = formula {
                let hidden = |name: &str| self.scope.hides(name);
                point_kinds::names_in(formula, Expected::Point, hidden, |used, expected| {
                    let is_local = used.text != name.text && self.body_point(used, expected).is_some();
                    uses.extend(positions.get(used.text.as_str()).filter(|_| is_local).map(|&k| (k, used.span)));
                });
            }
            (name, uses)
        });
        let uses = uses.collect();
        self.current.site = outer;
        uses
    }

    fn axes_of(&mut self, frame: Frame, features: &'a [ast::Feature]) {
        for feature in features {
            let ends = match &feature.kind {
                FeatureKind::AxisAlong { origin, direction } => {
                    self.at_site(FormulaSite::Inside(frame), None, |checker| {
                        let origin = checker.place(frame, origin);
                        let direction = checker.direction_of(direction);
                        origin.zip(direction)
                    })
                }
                FeatureKind::AxisTo { origin, target } => self.at_site(FormulaSite::Inside(frame), None, |checker| {
                    let (from, to) = (checker.place(frame, origin), checker.place(frame, target));
                    let (from, to) = (from?, to?);
                    let (p, q) = (checker.model[from].at, checker.model[to].at);
                    let direction = [0, 1].map(|k| checker.model.graph.sub(q[k], p[k]));
                    let direction = checker.not_zero(direction, origin.span.to(target.span))?;
                    Some((from, direction))
                }),
                _ => continue,
            };
            let axis = ends.map(|(origin, direction)| {
                let name = feature.name.text.clone();
                self.model.add_axis(Axis { frame, name, span: feature.name.span, origin, direction })
            });
            self.settle(frame, &feature.name, Feature::Axis(axis));
        }
    }

    /// Sets the feature of a name, unless the name is a duplicate.
    pub(super) fn settle(&mut self, frame: Frame, name: &Name, feature: Feature) {
        if let Some(space) = self.common.features.get_mut(&frame)
            && space.span(&name.text) == Some(name.span)
        {
            space.replace(&name.text, feature);
        }
    }

    fn direction_of(&mut self, e: &Expr) -> Option<[ExprId; 2]> {
        let ExprKind::Tuple(parts) = &e.kind else {
            self.reporter.report(errors::no_direction(e.span, describe(e), self.angle_of_place(e)));
            return None;
        };
        let [dx, dy] = parts.as_slice() else {
            self.reporter.report(errors::argument_count(
                "along",
                Keyword::named("along").map(|keyword| &keyword.word),
                e.span,
                "two numbers",
                parts.len(),
            ));
            return None;
        };
        let context = self.pair_context([dx, dy], "a direction", None);
        let (x, y) = (self.formula(dx, &context), self.formula(dy, &context));
        let (x, y) = (x?, y?);
        self.unify("the two parts of the direction are", (dx.span, x), (dy.span, y), &context)?;
        self.not_zero([x.id, y.id], e.span)
    }

    /// Returns the text of the angle of a position given by distance and angle.
    fn angle_of_place(&self, e: &Expr) -> Option<&'a str> {
        match &e.bare().kind {
            ExprKind::Call { name, arguments, .. } if name.text == "polar" => {
                arguments.get(1).map(|angle| self.reporter.text(angle.span))
            }
            _ => None,
        }
    }

    fn not_zero(&mut self, direction: [ExprId; 2], span: Span) -> Option<[ExprId; 2]> {
        let [x, y] = direction.map(|id| self.decided(id, GuardKind::Sign));
        if x? == 0.0 && y? == 0.0 {
            self.reporter.report(errors::zero_direction(span));
            return None;
        }
        Some(direction)
    }

    pub(super) fn pair_context(
        &self,
        parts: [&Expr; 2],
        place: &'static str,
        argument: Option<&str>,
    ) -> Context<'static> {
        let judged = parts.iter().any(|part| self.is_dimensional_with(argument, part));
        Context { judged, ..Context::constant(place) }
    }

    pub(super) fn lengths_in(&mut self, parts: [&Expr; 2], context: &Context<'_>) -> Option<[ExprId; 2]> {
        let values = parts.map(|part| self.formula(part, context));
        self.two_lengths(parts, values, context)
    }

    /// Evaluates the two coordinates of a point, whose dimensions are judged together.
    pub(super) fn two_lengths(
        &mut self,
        parts: [&Expr; 2],
        [x, y]: [Option<Value>; 2],
        context: &Context<'_>,
    ) -> Option<[ExprId; 2]> {
        let (x, y) = (x?, y?);
        self.unify("the coordinates of a point are", (parts[0].span, x), (parts[1].span, y), context)?;
        for part in parts {
            if !context.judged && self.reject_angle("a coordinate", part) {
                return None;
            }
        }
        for (part, value) in parts.into_iter().zip([x, y]) {
            require_dimension(&mut self.reporter, "a coordinate", Dimension::LENGTH, part.span, value.dim, context)?;
            self.record_length_term(part, value.id, context.judged);
        }
        Some([x.id, y.id])
    }

    /// Evaluates a constant angle, with a warning if it was probably intended in degrees.
    pub(super) fn angle(&mut self, e: &Expr, place: &str) -> Option<ExprId> {
        self.warn_of_degrees_in(e);
        let (id, _) = self.constant_by(e, place, Dimension::PURE, GuardKind::Finite)?;
        Some(id)
    }

    /// Returns the point where an axis starts or ends: a named point of the frame, or a formula of points.
    pub(super) fn place(&mut self, frame: Frame, e: &Expr) -> Option<PointId> {
        match &e.kind {
            ExprKind::Name(name)
                if self.body_point(name, Expected::Point).is_some() || self.scope.point_param(name).is_none() =>
            {
                self.record_body_point(name);
                self.point_named(frame, name)
            }
            ExprKind::Member { owner, feature } if self.is_feature_of_frame(frame, owner, feature) => {
                self.reporter.report(errors::redundant_owner(e.span, &owner.text, &feature.text));
                None
            }
            _ => self.unnamed_point(frame, e),
        }
    }

    /// Returns whether `arm.tip` stands within the braces of `arm`.
    fn is_feature_of_frame(&self, frame: Frame, owner: &Name, feature: &Name) -> bool {
        let is_there = || self.common.features.get(&frame).is_some_and(|space| space.get(&feature.text).is_some());
        self.frame_name(frame) == owner.text && is_there()
    }

    fn unnamed_point(&mut self, frame: Frame, e: &Expr) -> Option<PointId> {
        let at = self.place_of(e, "point", "a point", None)?.at;
        Some(self.model.add_point(Point { frame, name: None, span: e.span, at }))
    }

    /// Returns a point of a body or of the ground, or one of the ground by a formula of points.
    pub(super) fn point(&mut self, e: &Expr) -> Option<PointId> {
        match &e.kind {
            ExprKind::Tuple(_) => self.unnamed_point(self.address.ground, e),
            ExprKind::Member { owner, feature }
                if coordinate(feature).is_some() && self.scope.point_param(owner).is_some() =>
            {
                self.reporter.report(errors::coordinate_as_point(e.span, owner));
                None
            }
            ExprKind::Member { owner, feature } => {
                let frame = self.body(owner)?;
                self.point_named(frame, feature)
            }
            _ if self.is_point(e) => self.unnamed_point(self.address.ground, e),
            ExprKind::Name(name) => {
                self.bare_name(name, "point");
                None
            }
            _ => {
                self.reporter.report(errors::wrong_kind(e.span, "a point", describe(e)));
                None
            }
        }
    }

    pub(super) fn point_named(&mut self, frame: Frame, name: &Name) -> Option<PointId> {
        match self.feature(frame, name, "point", |feature| matches!(feature, Feature::Point(_)))? {
            Feature::Point(point) => point,
            other => {
                self.reporter.report(errors::wrong_kind(name.span, "a point", other.noun()));
                None
            }
        }
    }

    /// Returns an axis of a body or of the ground.
    pub(super) fn axis(&mut self, e: &Expr) -> Option<AxisId> {
        match &e.kind {
            ExprKind::Member { owner, feature } => {
                let frame = self.body(owner)?;
                match self.feature(frame, feature, "axis", |feature| matches!(feature, Feature::Axis(_)))? {
                    Feature::Axis(axis) => axis,
                    Feature::Point(_) => {
                        let diagnostic = errors::wrong_kind(feature.span, "an axis", "a point");
                        self.reporter.report(diagnostic.fix_if(self.suggest_axis(frame, feature)));
                        None
                    }
                    other => {
                        self.reporter.report(errors::wrong_kind(feature.span, "an axis", other.noun()));
                        None
                    }
                }
            }
            ExprKind::Name(name) => {
                self.bare_name(name, "axis");
                None
            }
            _ => {
                self.reporter.report(errors::wrong_kind(e.span, "an axis", describe(e)));
                None
            }
        }
    }

    /// Reports a name alone where `body.feature` is expected.
    pub(super) fn bare_name(&mut self, name: &Name, what: &str) {
        let Ok(entity) = self.scope.resolve(name) else { return };
        if entity == Some(Entity::Trace) && what == "point" {
            self.scope.trace_in_a_formula(&mut self.reporter, name.span, "a point", name);
            return;
        }
        let expected = if what == "axis" { "an axis".to_owned() } else { format!("a {what}") };
        let other_owners = self.owners_in_arguments(name.span);
        let owners: Vec<String> = std::iter::once(self.address.ground)
            .chain(self.bodies.iter().copied())
            .filter(|&frame| !other_owners.contains(&self.frame_name(frame)))
            .filter(|frame| self.common.features.get(frame).is_some_and(|space| space.get(&name.text).is_some()))
            .map(|frame| format!("`{}.{}`", self.frame_name(frame), name.text))
            .collect();
        let help = match (owners.is_empty(), entity) {
            (false, _) => format!("was {} meant?", owners.join(" or ")),
            (true, Some(Entity::Body(_))) => match &self.features_of(name, |feature| feature.is(what))[..] {
                [] => format!("name one of its features: `{}.…`", name.text),
                names => format!("name one of its features: {}", names.join(", ")),
            },
            _ => format!("outside a body {expected} is written `body.{}`", name.text),
        };
        let found = match self.scope.describe_name(name) {
            "a name" => format!("the name `{}`", name.text),
            noun => noun.to_owned(),
        };
        self.reporter.report(errors::wrong_kind(name.span, &expected, &found).help(help));
    }

    pub(super) fn feature(
        &mut self,
        frame: Frame,
        name: &Name,
        what: &str,
        expected: impl Fn(Feature) -> bool,
    ) -> Option<Feature> {
        let space = self.common.features.get(&frame)?;
        match space.get(&name.text) {
            Some(Feature::Broken) => return None,
            None if space.is_incomplete() => return None,
            None => {}
            feature => return feature,
        }
        let candidates = space.suggestions(&self.reporter, expected);
        let diagnostic = errors::unknown_feature(what, self.frame_name(frame), name, &candidates);
        self.reporter.report(diagnostic);
        None
    }

    /// Describes `owner.feature` for a message.
    pub(super) fn describe_member(&self, owner: &Name, feature: &Name) -> String {
        let space = self.frame_of(owner).and_then(|frame| self.common.features.get(&frame));
        let found = space.and_then(|space| space.get(&feature.text));
        if let (None, Some(Entity::Joint(_))) = (space, self.scope.entity(owner)) {
            return "a coordinate of a joint, which is a column of the table and stands in no formula".to_owned();
        }
        found.map_or("a feature of a body", Feature::noun).to_owned()
    }
}
