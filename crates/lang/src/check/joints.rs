//! Joints: their arguments, and what the drawn poses must determine.

use super::{Checker, errors};
use crate::model::{BodyId, CircleId, Dimension, Frame, GuardKind, JoinedFeatures, Joint, JointId, PointId, Side};
use mechc_expr::ExprId;
use mechc_syntax::ast::{Expr, ExprKind, ItemKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::JointWord;

impl Checker<'_> {
    pub(super) fn joints(&mut self) {
        let (mut parts, mut numbers) = (0..self.parts.len(), 0..);
        for item in self.items() {
            match &item.kind {
                ItemKind::Joint { name, kind, arguments, call_span } => {
                    let joint = self.joint(name, kind, arguments, *call_span);
                    let (declared, part) = (self.declared(name), self.address.part);
                    let id = joint.map(|features| self.model.add_joint(Joint { part, declared, features }));
                    self.set_joint(numbers.next().unwrap_or_default(), id);
                }
                ItemKind::Part(_) => {
                    if let Some(part) = parts.next() {
                        self.in_part(part, Checker::joints);
                    }
                }
                _ => {}
            }
        }
        self.import_joints();
    }

    fn set_joint(&mut self, k: usize, joint: Option<JointId>) {
        if self.joints.len() <= k {
            self.joints.resize(k + 1, None);
        }
        self.joints[k] = joint;
    }

    fn joint(&mut self, name: &Name, kind: &Name, arguments: &[Expr], span: Span) -> Option<JoinedFeatures> {
        if self.refuses_arguments(kind, arguments) {
            return None;
        }
        let joint = match kind.text.as_str() {
            "revolute" | "weld" | "revolute_revolute" => self.joint_of_points(kind, arguments, span),
            "translational" | "revolute_translational" => self.joint_of_axes(kind, arguments, span),
            "gear" | "internal_gear" => self.gear(kind, arguments, span),
            "rack_pinion" => self.rack_pinion(kind, arguments, span),
            "point_follower" | "cam" | "flat_follower" => self.contact(kind, arguments, span),
            _ => self.unknown_joint(kind, arguments),
        }?;
        let frames = joint.frames(&self.model);
        if self.model.carrier(frames[0]) == self.model.carrier(frames[1]) {
            let frame = self.frame_name(frames[0]).to_owned();
            self.report(errors::joint_with_itself(name, &frame, [arguments[0].span, arguments[1].span]));
            return None;
        }
        self.is_drawn_apart(joint, arguments).then_some(joint)
    }

    fn unknown_joint(&mut self, kind: &Name, arguments: &[Expr]) -> Option<JoinedFeatures> {
        let texts: Vec<&str> = arguments.iter().map(|e| self.sources.text(e.span)).collect();
        let diagnostic = errors::unknown_joint(kind, &texts);
        self.report(diagnostic);
        None
    }

    fn wrong_count(&mut self, kind: &Name, span: Span, found: usize) -> Option<JoinedFeatures> {
        if let Some(joint) = JointWord::named(&kind.text) {
            self.report(errors::argument_count(&kind.text, Some(&joint.word), span, joint.takes, found));
        }
        None
    }

    fn joint_of_points(&mut self, kind: &Name, arguments: &[Expr], span: Span) -> Option<JoinedFeatures> {
        Some(match (kind.text.as_str(), arguments) {
            ("revolute", [p, q]) => {
                let (p, q) = self.two_points(p, q)?;
                JoinedFeatures::Revolute(p, q)
            }
            ("weld", [p, q]) => {
                let (p, q) = self.two_points(p, q)?;
                JoinedFeatures::Weld(p, q, self.model.graph.constant(0.0))
            }
            ("weld", [p, q, angle]) => {
                let points = self.two_points(p, q);
                let angle = self.angle(angle, "the angle of a weld");
                let (p, q) = points?;
                JoinedFeatures::Weld(p, q, angle?)
            }
            ("revolute_revolute", [p, q, length]) => {
                let points = self.two_points(p, q);
                let length = self.positive_length(length, "the length of the link");
                let (p, q) = points?;
                JoinedFeatures::RevoluteRevolute(p, q, length?)
            }
            _ => return self.wrong_count(kind, span, arguments.len()),
        })
    }

    fn joint_of_axes(&mut self, kind: &Name, arguments: &[Expr], span: Span) -> Option<JoinedFeatures> {
        Some(match (kind.text.as_str(), arguments) {
            ("translational", [a, b]) => {
                let (a, b) = (self.axis(a), self.axis(b));
                JoinedFeatures::Translational(a?, b?)
            }
            ("revolute_translational", [p, a]) => {
                let (p, a) = (self.point(p), self.axis(a));
                JoinedFeatures::RevoluteTranslational(p?, a?, self.model.graph.constant(0.0))
            }
            ("revolute_translational", [p, a, offset]) => {
                let (p, a) = (self.point(p), self.axis(a));
                let place = "the offset from the axis";
                let offset = self.constant_by(offset, place, Dimension::LENGTH, GuardKind::Finite);
                JoinedFeatures::RevoluteTranslational(p?, a?, offset?.0)
            }
            _ => return self.wrong_count(kind, span, arguments.len()),
        })
    }

    fn gear(&mut self, kind: &Name, arguments: &[Expr], span: Span) -> Option<JoinedFeatures> {
        let ([c, d] | [c, d, _]) = arguments else {
            return self.wrong_count(kind, span, arguments.len());
        };
        let circles = (self.circle(c), self.circle(d));
        let phase = arguments.get(2).map(|phase| self.phase(phase));
        let circles = [circles.0?, circles.1?];
        Some(JoinedFeatures::Gear { circles, internal: kind.text == "internal_gear", phase: settled(phase)? })
    }

    fn rack_pinion(&mut self, kind: &Name, arguments: &[Expr], span: Span) -> Option<JoinedFeatures> {
        let ([c, a] | [c, a, _] | [c, a, _, _]) = arguments else {
            return self.wrong_count(kind, span, arguments.len());
        };
        let (pinion, rack) = (self.circle(c), self.axis(a));
        let phase = arguments.get(2).map(|phase| self.phase(phase));
        let side = arguments.get(3).map(|side| self.side(side));
        Some(JoinedFeatures::RackPinion { pinion: pinion?, rack: rack?, phase: settled(phase)?, side: settled(side)? })
    }

    fn contact(&mut self, kind: &Name, arguments: &[Expr], span: Span) -> Option<JoinedFeatures> {
        let [first, second] = arguments else {
            return self.wrong_count(kind, span, arguments.len());
        };
        Some(match kind.text.as_str() {
            "point_follower" => {
                let (point, profile) = (self.point(first), self.profile(second));
                JoinedFeatures::PointFollower(point?, profile?)
            }
            "cam" => {
                let (k, m) = (self.profile(first), self.profile(second));
                JoinedFeatures::Cam(k?, m?)
            }
            _ => {
                let (profile, face) = (self.profile(first), self.axis(second));
                JoinedFeatures::FlatFollower(profile?, face?)
            }
        })
    }

    fn positive_length(&mut self, e: &Expr, what: &str) -> Option<ExprId> {
        let (id, value) = self.constant_by(e, what, Dimension::LENGTH, GuardKind::Sign)?;
        if value <= 0.0 {
            self.report(errors::not_positive_length(what, e.span, value));
            return None;
        }
        Some(id)
    }

    pub(super) fn radius(&mut self, e: &Expr) -> Option<ExprId> {
        self.positive_length(e, "the radius of a circle")
    }

    /// Evaluates the phase `κ`, a length.
    fn phase(&mut self, e: &Expr) -> Option<ExprId> {
        if let ExprKind::Name(name) = &e.bare().kind
            && side_named(&name.text).is_some()
            && self.entity(name).is_none()
        {
            self.report(errors::side_without_phase(&name.text, e.span));
            return None;
        }
        self.constant_by(e, "the phase", Dimension::LENGTH, GuardKind::Finite).map(|(id, _)| id)
    }

    fn side(&mut self, e: &Expr) -> Option<Side> {
        let side = match &e.kind {
            ExprKind::Name(name) => side_named(&name.text),
            _ => None,
        };
        if side.is_none() {
            self.report(errors::no_side(e.span));
        }
        side
    }

    /// Returns whether the drawn poses determine the side or direction of one wheel relative to the other.
    fn is_drawn_apart(&mut self, joint: JoinedFeatures, arguments: &[Expr]) -> bool {
        // A broken pose has been reported.
        if joint.frames(&self.model).iter().any(|frame| self.is_place_broken(*frame)) {
            return true;
        }
        match joint {
            JoinedFeatures::Gear { circles, .. } => {
                let [c, d] = circles.map(|circle| self.drawn_center(circle));
                let apart = c.zip(d).is_none_or(|(c, d)| (c[0] - d[0]).abs() + (c[1] - d[1]).abs() > 0.0);
                if !apart {
                    self.report(errors::centers_coincide([arguments[0].span, arguments[1].span]));
                    // A body without a pose is marked, so that it is reported once and not for each of its gears.
                    let frames = circles.map(|circle| self.model[self.model[circle].center].frame);
                    let without: Vec<Frame> = frames.into_iter().filter(|frame| self.has_no_pose(*frame)).collect();
                    self.common.broken_poses.extend(without);
                }
                apart
            }
            JoinedFeatures::RackPinion { pinion, rack, side: None, .. } => {
                let (origin, direction) = (self.model[rack].origin, self.model[rack].direction);
                let turned = self.drawn(self.model[rack].frame, direction, false);
                let apart = match (self.drawn_center(pinion), self.drawn_point(origin), turned) {
                    (Some(c), Some(o), Some([vx, vy])) => vx * (c[1] - o[1]) - vy * (c[0] - o[0]) != 0.0,
                    _ => true,
                };
                if !apart {
                    self.report(errors::center_on_the_rack([arguments[0].span, arguments[1].span]));
                }
                apart
            }
            _ => true,
        }
    }

    fn has_no_pose(&self, frame: Frame) -> bool {
        matches!(frame, Frame::Body(body) if self.model[body].pose_span.is_none())
    }

    fn drawn_center(&mut self, circle: CircleId) -> Option<[f64; 2]> {
        self.drawn_point(self.model[circle].center)
    }

    fn drawn_point(&mut self, point: PointId) -> Option<[f64; 2]> {
        let (frame, at) = (self.model[point].frame, self.model[point].at);
        self.drawn(frame, at, true)
    }

    /// Returns a point or direction of a frame in the ground's frame, in the drawn poses.
    fn drawn(&mut self, frame: Frame, local: [ExprId; 2], is_point: bool) -> Option<[f64; 2]> {
        let [x, y] = local.map(|id| self.constant_value(id));
        let (x, y) = (x?, y?);
        if frame == self.address.ground {
            return Some([x, y]);
        }
        let Some(body) = self.local_body(frame) else { return self.drawn_through_parts(frame, local, is_point) };
        let pose = self.model[body].pose.map(|id| self.constant_value(id));
        let (sin, cos) = mechc_expr::math::sin_cos(pose[2]?);
        let origin = if is_point { [pose[0]?, pose[1]?] } else { [0.0, 0.0] };
        Some([origin[0] + x * cos - y * sin, origin[1] + x * sin + y * cos])
    }
}

impl Checker<'_> {
    /// Returns the body of a frame, if it belongs to this text.
    pub(super) fn local_body(&self, frame: Frame) -> Option<BodyId> {
        match frame {
            Frame::Body(body) if self.model[body].part == self.address.part => Some(body),
            _ => None,
        }
    }

    /// Returns a point or direction of a part's frame in the ground's frame, in the drawn poses.
    fn drawn_through_parts(&mut self, frame: Frame, local: [ExprId; 2], is_point: bool) -> Option<[f64; 2]> {
        let placement = self.drawn_frame(frame);
        let graph = &mut self.model.graph;
        let place = if is_point { placement.placed(graph, local) } else { placement.turned(graph, local) };
        let [x, y] = place.map(|id| self.constant_value(id));
        Some([x?, y?])
    }
}

fn side_named(word: &str) -> Option<Side> {
    match word {
        "left" => Some(Side::Left),
        "right" => Some(Side::Right),
        _ => None,
    }
}

/// Returns the value of an optional argument: the inner `None` if it is left out, the outer `None` if it is broken.
#[allow(clippy::option_option)] // left out, or broken
fn settled<T>(argument: Option<Option<T>>) -> Option<Option<T>> {
    match argument {
        None => Some(None),
        Some(value) => value.map(Some),
    }
}
