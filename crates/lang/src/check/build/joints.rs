//! Joints: their arguments, and what the drawn poses must determine.

use super::Builder;
use crate::check::errors;
use crate::model::{Argument, Dimension, Frame, GuardKind, Joint, JointFeature, JointId, PointId, Profile};
use mechc_expr::ExprId;
use mechc_syntax::ast::{Expr, ExprKind, ItemKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::{ArgumentSpec, FeatureWord, JointSpec};

impl Builder<'_, '_> {
    pub(in crate::check) fn joints(&mut self) {
        let (mut parts, mut numbers) = (0..self.formulas.parts.len(), 0..);
        for item in self.formulas.scope.items() {
            match &item.kind {
                ItemKind::Joint { name, kind, arguments, call_span } => {
                    let joint = self.joint(name, kind, arguments, *call_span);
                    let id = joint.map(|joint| self.formulas.model.add_joint(joint));
                    self.set_joint(numbers.next().unwrap_or_default(), id);
                }
                ItemKind::Part(_) => {
                    if let Some(part) = parts.next() {
                        self.in_part(part, |part| part.joints());
                    }
                }
                _ => {}
            }
        }
        self.formulas.import_joints();
    }

    fn set_joint(&mut self, k: usize, joint: Option<JointId>) {
        if self.formulas.joints.len() <= k {
            self.formulas.joints.resize(k + 1, None);
        }
        self.formulas.joints[k] = joint;
    }

    fn joint(&mut self, name: &Name, kind: &Name, arguments: &[Expr], span: Span) -> Option<Joint> {
        let Some(spec) = JointSpec::named(&kind.text) else {
            let texts: Vec<&str> = arguments.iter().map(|e| self.formulas.reporter.text(e.span)).collect();
            let diagnostic = errors::unknown_joint(kind, &texts);
            self.formulas.reporter.report(diagnostic);
            return None;
        };
        if self.formulas.refuses_arguments(kind, spec, arguments) {
            return None;
        }
        let required = spec.arguments.iter().filter(|argument| matches!(argument, ArgumentSpec::Length(_))).count();
        let (&[ref first, ref second, ref rest @ ..], true) = (arguments, arguments.len() >= 2 + required) else {
            return self.wrong_count(spec, span, arguments.len());
        };
        if rest.len() > spec.arguments.len() {
            return self.wrong_count(spec, span, arguments.len());
        }
        let features = [(spec.features[0], first), (spec.features[1], second)].map(|(word, e)| self.joined(word, e));
        let given: Vec<Option<Argument>> =
            spec.arguments.iter().zip(rest).map(|(argument, e)| self.argument(*argument, e)).collect();
        let (features, mut arguments) = ([features[0]?, features[1]?], given.into_iter().collect::<Option<Vec<_>>>()?);
        if let Some(ArgumentSpec::Angle(_) | ArgumentSpec::Offset(_)) = spec.arguments.get(arguments.len()) {
            arguments.push(Argument::Value(self.formulas.model.graph.constant(0.0)));
        }
        let joint = Joint {
            part: self.formulas.address.part,
            declared: self.formulas.scope.declared(name),
            spec,
            features,
            arguments,
        };
        let frames = joint.frames(&self.formulas.model);
        if self.formulas.model.carrier(frames[0]) == self.formulas.model.carrier(frames[1]) {
            let frame = self.formulas.frame_name(frames[0]).to_owned();
            self.formulas.reporter.report(errors::joint_with_itself(name, &frame, [first.span, second.span]));
            return None;
        }
        self.is_drawn_apart(&joint, [first.span, second.span]).then_some(joint)
    }

    fn wrong_count(&mut self, spec: &JointSpec, span: Span, found: usize) -> Option<Joint> {
        self.formulas.reporter.report(errors::argument_count(spec.name(), Some(&spec.word), span, spec.takes, found));
        None
    }

    fn joined(&mut self, word: FeatureWord, e: &Expr) -> Option<JointFeature> {
        Some(match word {
            FeatureWord::Point => JointFeature::Point(self.formulas.point(e)?),
            FeatureWord::Axis => JointFeature::Axis(self.formulas.axis(e)?),
            FeatureWord::Circle => JointFeature::Profile(Profile::Circle(self.circle(e)?)),
            FeatureWord::Curve => JointFeature::Profile(self.profile(e)?),
        })
    }

    fn argument(&mut self, spec: ArgumentSpec, e: &Expr) -> Option<Argument> {
        Some(match spec {
            ArgumentSpec::Angle(what) => Argument::Value(self.formulas.angle(e, what)?),
            ArgumentSpec::Offset(what) => {
                Argument::Value(self.formulas.constant_by(e, what, Dimension::LENGTH, GuardKind::Finite)?.0)
            }
            ArgumentSpec::Length(what) => Argument::Value(self.formulas.positive_length(e, what)?),
            ArgumentSpec::Phase => Argument::Value(self.phase(e)?),
            ArgumentSpec::Word(words, what) => {
                let word = words.iter().find(|word| matches!(&e.kind, ExprKind::Name(name) if name.text == **word));
                if word.is_none() {
                    self.formulas.reporter.report(errors::no_word(words, what, e.span));
                }
                Argument::Word(word?)
            }
        })
    }

    /// Evaluates the phase `κ`, a length.
    fn phase(&mut self, e: &Expr) -> Option<ExprId> {
        if let ExprKind::Name(name) = &e.bare().kind
            && ["left", "right"].contains(&name.text.as_str())
            && self.formulas.scope.entity(name).is_none()
        {
            self.formulas.reporter.report(errors::side_without_phase(&name.text, e.span));
            return None;
        }
        self.formulas.constant_by(e, "the phase", Dimension::LENGTH, GuardKind::Finite).map(|(id, _)| id)
    }

    /// Returns whether the drawn poses determine the side or direction of one wheel relative to the other.
    fn is_drawn_apart(&mut self, joint: &Joint, spans: [Span; 2]) -> bool {
        let frames = joint.frames(&self.formulas.model);
        // A broken pose has been reported.
        if !joint.spec.rolls() || frames.iter().any(|frame| self.formulas.is_place_broken(*frame)) {
            return true;
        }
        let [Some(first), Some(second)] = joint.features.map(|feature| feature.point(&self.formulas.model)) else {
            return true;
        };
        match joint.features[1].axis() {
            Some(_) if joint.has_word("left") || joint.has_word("right") => true,
            Some(rack) => {
                let turned = self.drawn(frames[1], self.formulas.model[rack].direction, false);
                let apart = match (self.drawn_point(first), self.drawn_point(second), turned) {
                    (Some(c), Some(o), Some([vx, vy])) => vx * (c[1] - o[1]) - vy * (c[0] - o[0]) != 0.0,
                    _ => true,
                };
                if !apart {
                    self.formulas.reporter.report(errors::center_on_the_rack(spans));
                }
                apart
            }
            None => {
                let (c, d) = (self.drawn_point(first), self.drawn_point(second));
                let apart = c.zip(d).is_none_or(|(c, d)| (c[0] - d[0]).abs() + (c[1] - d[1]).abs() > 0.0);
                if !apart {
                    self.formulas.reporter.report(errors::centers_coincide(spans));
                    // A body without a pose is marked, so that it is reported once and not for each of its gears.
                    let without: Vec<Frame> = frames.into_iter().filter(|frame| self.has_no_pose(*frame)).collect();
                    self.formulas.common.broken_poses.extend(without);
                }
                apart
            }
        }
    }

    fn has_no_pose(&self, frame: Frame) -> bool {
        matches!(frame, Frame::Body(body) if self.formulas.model[body].pose_span.is_none())
    }

    fn drawn_point(&mut self, point: PointId) -> Option<[f64; 2]> {
        let (frame, at) = (self.formulas.model[point].frame, self.formulas.model[point].at);
        self.drawn(frame, at, true)
    }

    /// Returns a point or direction of a frame in the ground's frame, in the drawn poses.
    fn drawn(&mut self, frame: Frame, local: [ExprId; 2], is_point: bool) -> Option<[f64; 2]> {
        let [x, y] = local.map(|id| self.formulas.constant_value(id));
        let (x, y) = (x?, y?);
        if frame == self.formulas.address.ground {
            return Some([x, y]);
        }
        let Some(body) = self.formulas.local_body(frame) else {
            return self.drawn_through_parts(frame, local, is_point);
        };
        let pose = self.formulas.model[body].pose.map(|id| self.formulas.constant_value(id));
        let (sin, cos) = mechc_expr::math::sin_cos(pose[2]?);
        let origin = if is_point { [pose[0]?, pose[1]?] } else { [0.0, 0.0] };
        Some([origin[0] + x * cos - y * sin, origin[1] + x * sin + y * cos])
    }
}

impl Builder<'_, '_> {
    /// Returns a point or direction of a part's frame in the ground's frame, in the drawn poses.
    fn drawn_through_parts(&mut self, frame: Frame, local: [ExprId; 2], is_point: bool) -> Option<[f64; 2]> {
        let placement = self.formulas.drawn_frame(frame);
        let graph = &mut self.formulas.model.graph;
        let place = if is_point { placement.placed(graph, local) } else { placement.turned(graph, local) };
        let [x, y] = place.map(|id| self.formulas.constant_value(id));
        Some([x?, y?])
    }
}
