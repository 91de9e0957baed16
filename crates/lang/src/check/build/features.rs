//! Bodies, the ground, and their features. Circles and curves are in `profiles`.

use super::Builder;
use crate::check::errors;
use crate::check::formulas::{Feature, FormulaSite, InitialPoint};
use crate::check::scope::{Space, ordered};
use crate::model::{Axis, Body, Frame, Point};
use mechc_syntax::ast::{self, DrawnPose, FeatureKind, Item, ItemKind, Name};

impl<'a> Builder<'_, 'a> {
    /// Evaluates bodies, features and poses.
    pub(in crate::check) fn features(&mut self) {
        self.add_frames();
        self.collect_all_features();
        self.mount_parts();
        self.read_features();
        self.poses();
    }

    /// Declares bodies and the grounds of parts, in the order of the text.
    pub(super) fn add_frames(&mut self) {
        self.formulas.common.features.insert(self.formulas.address.ground, Space::new());
        let mut parts = 0..;
        for item in self.formulas.scope.items() {
            match &item.kind {
                ItemKind::Body { name, .. } => self.add_body(item, name),
                ItemKind::Part(part) => self.add_part(parts.next().unwrap_or_default(), part),
                _ => {}
            }
        }
        self.formulas.import_frames();
    }

    /// Returns the ground and the bodies of this text with their features.
    fn frames(&self) -> Vec<(Frame, &'a [ast::Feature])> {
        let mut bodies = self.formulas.bodies.iter();
        let frame = |item: &'a Item| match &item.kind {
            ItemKind::Ground { features } => Some((self.formulas.address.ground, features.as_slice())),
            ItemKind::Body { features, .. } => Some((*bodies.next()?, features.as_slice())),
            _ => None,
        };
        self.formulas.scope.items().iter().filter_map(frame).collect()
    }

    pub(super) fn collect_all_features(&mut self) {
        for (frame, features) in self.frames() {
            self.collect_features(frame, features);
        }
        self.in_parts(|part| part.collect_all_features());
    }

    /// Evaluates points first, then the features that use them, so that points may be used before their declaration.
    pub(super) fn read_features(&mut self) {
        let frames = self.frames();
        for &(frame, features) in &frames {
            self.points_of(frame, features);
        }
        for &(frame, features) in &frames {
            self.axes_of(frame, features);
            self.profiles_of(frame, features);
            self.masses_of(frame, features);
        }
        self.in_parts(|part| part.read_features());
    }

    fn add_body(&mut self, item: &Item, name: &Name) {
        let zero = self.formulas.model.graph.constant(0.0);
        let pose_span = match &item.kind {
            ItemKind::Body { pose, .. } => pose.as_ref().map(DrawnPose::span),
            _ => None,
        };
        let (declared, part) = (self.formulas.scope.declared(name), self.formulas.address.part);
        let id =
            self.formulas.model.add_body(Body { part, declared, docs: item.docs.clone(), pose: [zero; 3], pose_span });
        self.formulas.bodies.push(Frame::Body(id));
        self.formulas.common.features.insert(Frame::Body(id), Space::new());
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
                    if let Some(space) = self.formulas.common.features.get_mut(&frame) {
                        space.declare_nameless();
                    }
                    continue;
                }
                FeatureKind::Broken => Feature::Broken,
            };
            let first = self
                .formulas
                .common
                .features
                .get_mut(&frame)
                .and_then(|space| space.declare(&feature.name, entity).err());
            if let Some(first) = first {
                self.formulas.reporter.report(errors::declared_twice(&feature.name, first));
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
        let uses = self.formulas.uses_of_points(frame, &points);
        for k in ordered(&mut self.formulas.reporter, &uses).order {
            let (name, at) = points[k];
            let drawn = self.formulas.at_site(FormulaSite::Inside(frame), Some(&name.text), |formulas| match at {
                Some(at) => formulas.place_of(at, "point", "a point", None),
                None => formulas.point_of_the_mechanism(name),
            });
            let point = drawn.map(|InitialPoint { at, dimensional }| {
                let point = Point { frame, name: Some(name.text.clone()), span: name.span, at };
                let id = self.formulas.model.add_point(point);
                self.formulas.common.dimensional_points.extend(dimensional.then_some(id));
                id
            });
            self.settle(frame, name, Feature::Point(point));
        }
    }

    fn axes_of(&mut self, frame: Frame, features: &'a [ast::Feature]) {
        for feature in features {
            let ends = match &feature.kind {
                FeatureKind::AxisAlong { origin, direction } => {
                    self.formulas.at_site(FormulaSite::Inside(frame), None, |formulas| {
                        let origin = formulas.place(frame, origin);
                        let direction = formulas.direction_of(direction);
                        origin.zip(direction)
                    })
                }
                FeatureKind::AxisTo { origin, target } => {
                    self.formulas.at_site(FormulaSite::Inside(frame), None, |formulas| {
                        let (from, to) = (formulas.place(frame, origin), formulas.place(frame, target));
                        let (from, to) = (from?, to?);
                        let (p, q) = (formulas.model[from].at, formulas.model[to].at);
                        let direction = [0, 1].map(|k| formulas.model.graph.sub(q[k], p[k]));
                        let direction = formulas.not_zero(direction, origin.span.to(target.span))?;
                        Some((from, direction))
                    })
                }
                _ => continue,
            };
            let axis = ends.map(|(origin, direction)| {
                let name = feature.name.text.clone();
                self.formulas.model.add_axis(Axis { frame, name, span: feature.name.span, origin, direction })
            });
            self.settle(frame, &feature.name, Feature::Axis(axis));
        }
    }

    /// Sets the feature of a name, unless the name is a duplicate.
    pub(super) fn settle(&mut self, frame: Frame, name: &Name, feature: Feature) {
        if let Some(space) = self.formulas.common.features.get_mut(&frame)
            && space.span(&name.text) == Some(name.span)
        {
            space.replace(&name.text, feature);
        }
    }
}
