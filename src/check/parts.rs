//! Parts: each is checked as the mechanism that it is, by a checker of its own that shares the model with those around it.

use super::formula::{Context, Dim, Value};
use super::instances::Instance;
use super::names::Entity;
use super::rates;
use super::results::ResultState;
use super::sites::{Drawn, Site};
use super::{Checker, MeasureState, Surroundings, errors};
use crate::diag::nearest;
use crate::expr::{ExprId, Graph};
use crate::model::{Declared, Dimension, Frame, Part, Placement};
use crate::source::{Sources, Span};
use crate::syntax::ast::{self, Binding, Expr, ExprKind, ItemKind, Name};
use crate::syntax::normalized;

/// A name of a part that is known in the mechanism around it, by its path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Import {
    /// What it is here.
    entity: Entity,
    /// What it is in the part.
    inside: Entity,
}

/// What is said of a param where its mechanism is used.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bound {
    /// It is a number; whether its dimension was worked out.
    Number(Value, bool),
    /// It is a point.
    Point(Drawn),
    /// So is one of its coordinates.
    Coordinate(usize, Value, bool),
}

/// A param with what is said of it, and where.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundParam<'a> {
    pub name: &'a str,
    pub bound: Bound,
    pub span: Option<Span>,
}

impl<'a> Checker<'a> {
    /// A checker of a mechanism with its parts, which are all there before anything of them is read; each knows its path, and where it is
    /// used.
    pub(super) fn of_instance(
        instance: &'a Instance<'a>,
        surroundings: &'a Surroundings,
        sources: &'a Sources,
        path: &str,
        used_at: &[(String, Span)],
    ) -> Checker<'a> {
        let mut checker = Checker::new(instance.tree(), surroundings, sources);
        checker.deciding = instance.deciding.clone();
        path.clone_into(&mut checker.path);
        checker.used_at = used_at.to_vec();
        checker.collect(instance.tree());
        let mut parts = instance.parts.iter();
        for item in &instance.tree().items {
            let ItemKind::Part(part) = &item.kind else { continue };
            let Some(inner) = parts.next() else { continue };
            let name = format!("{path}{}", part.name.text);
            let mut used_at = used_at.to_vec();
            used_at.insert(0, (name.clone(), part.name.span));
            let mut child = Checker::of_instance(inner, surroundings, sources, &format!("{name}."), &used_at);
            child.bound_inputs = part.bindings.iter().map(|binding| binding.name.text.as_str()).collect();
            checker.parts.push(child);
            checker.imports.push(Vec::new());
            checker.bindings.push(part);
        }
        for path in &instance.paths {
            checker.entity_inside(path);
        }
        checker
    }

    /// Work in a part, on the model that is shared.
    pub(super) fn in_part<T>(&mut self, part: usize, work: impl FnOnce(&mut Checker<'a>) -> T) -> T {
        let mut parts = std::mem::take(&mut self.parts);
        self.share_with(&mut parts[part]);
        let result = work(&mut parts[part]);
        self.share_with(&mut parts[part]);
        self.parts = parts;
        result
    }

    /// Gives what is shared to another checker, and takes what it has.
    fn share_with(&mut self, other: &mut Checker<'a>) {
        use std::mem::swap;
        swap(&mut self.diagnostics, &mut other.diagnostics);
        swap(&mut self.model, &mut other.model);
        swap(&mut self.features, &mut other.features);
        swap(&mut self.named, &mut other.named);
        swap(&mut self.derivative_orders, &mut other.derivative_orders);
        swap(&mut self.values, &mut other.values);
        swap(&mut self.dimensional_points, &mut other.dimensional_points);
        swap(&mut self.broken_poses, &mut other.broken_poses);
    }

    /// The same work in every part.
    pub(super) fn in_parts(&mut self, work: impl Fn(&mut Checker<'a>)) {
        for part in 0..self.parts.len() {
            self.in_part(part, &work);
        }
    }

    // ---- names

    /// Its name as the whole mechanism has it.
    pub(super) fn declared(&self, name: &Name) -> Declared {
        Declared { name: format!("{}{}", self.path, name.text), span: name.span }
    }

    /// A frame's name as this text has it.
    pub(super) fn frame_name(&self, frame: Frame) -> &str {
        let name = self.model.frame_name(frame);
        name.strip_prefix(self.path.as_str()).unwrap_or(name)
    }

    /// What a path stands for, `leg[0].foot`; makes its name known here.
    fn entity_inside(&mut self, path: &str) -> Option<Entity> {
        if let Some(known) = self.space.get(path) {
            return Some(known);
        }
        let (part, rest) = path.split_once('.')?;
        let Some(Entity::Part(k)) = self.space.get(part) else { return None };
        let child = self.parts.get_mut(k)?;
        let (inside, span) = match rest {
            "ground" => (Entity::Ground, child.tree.span),
            _ => (child.entity_inside(rest)?, child.space.span(rest)?),
        };
        let entity = match inside {
            Entity::Param(_) => Entity::Param(next(&mut self.count.params)),
            Entity::Input(_) => Entity::Input(next(&mut self.count.inputs)),
            Entity::Body(_) | Entity::Ground => Entity::Body(next(&mut self.count.bodies)),
            Entity::Joint(_) => Entity::Joint(next(&mut self.count.joints)),
            Entity::Measure(_) => Entity::Measure(next(&mut self.count.measures)),
            Entity::Result(_) => Entity::Result(next(&mut self.count.results)),
            other => other,
        };
        if child.is_point_name(rest) {
            self.point_paths.insert(path.to_owned());
        }
        let _ = self.space.declare(&Name { text: path.to_owned(), span }, entity);
        self.imports[k].push(Import { entity, inside });
        self.imported.insert(entity, (k, inside));
        Some(entity)
    }

    /// Brings over what is known by now of the params of parts that have a name here.
    pub(super) fn import_params(&mut self) {
        for part in 0..self.parts.len() {
            self.import_params_of(part);
        }
    }

    fn import_params_of(&mut self, part: usize) {
        let child = &self.parts[part];
        for import in &self.imports[part] {
            let (Entity::Param(k), Entity::Param(m)) = (import.entity, import.inside) else { continue };
            set(&mut self.params, k, child.params.get(m).copied(), None);
            set(&mut self.drawn, k, child.drawn.get(m).copied(), None);
            set(&mut self.param_angles, k, child.param_angles.get(m).copied(), 0);
            if let Some(&formula) = child.param_formulas.get(m) {
                set(&mut self.param_formulas, k, Some(formula), formula);
            }
        }
    }

    /// The same of their bodies, once its own are there.
    pub(super) fn import_frames(&mut self) {
        for (imports, child) in self.imports.iter().zip(&self.parts) {
            for import in imports {
                let (Entity::Body(k), inside) = (import.entity, import.inside) else { continue };
                let frame = match inside {
                    Entity::Body(m) => child.bodies.get(m).copied(),
                    _ => Some(child.ground),
                };
                set(&mut self.bodies, k, frame, Frame::Ground);
            }
        }
    }

    /// The same of their joints.
    pub(super) fn import_joints(&mut self) {
        for (imports, child) in self.imports.iter().zip(&self.parts) {
            for import in imports {
                let (Entity::Joint(k), Entity::Joint(m)) = (import.entity, import.inside) else { continue };
                set(&mut self.joints, k, child.joints.get(m).copied(), None);
            }
        }
    }

    /// Whether a name is that of a param that is a point.
    pub(super) fn is_point_name(&self, name: &str) -> bool {
        self.point_params.contains(name) || self.point_paths.contains(name)
    }

    /// The checker of the part in which something is declared, with what it is there; this one for its own.
    pub(super) fn home_of(&self, entity: Entity) -> (&Checker<'a>, Entity) {
        match self.imported.get(&entity) {
            Some(&(part, inside)) => self.parts[part].home_of(inside),
            None => (self, entity),
        }
    }

    /// What is known of a measure, be it of a part or not.
    pub(super) fn measure_known(&self, k: usize) -> Option<&MeasureState<'a>> {
        match self.home_of(Entity::Measure(k)) {
            (home, Entity::Measure(k)) => home.measures.get(k),
            _ => None,
        }
    }

    /// What is known of a result, be it of a part or not.
    pub(super) fn result_known(&self, k: usize) -> Option<&ResultState<'a>> {
        match self.home_of(Entity::Result(k)) {
            (home, Entity::Result(k)) => home.results.get(k),
            _ => None,
        }
    }

    /// What an input is, be it of a part or not.
    pub(super) fn input_known(&self, k: usize) -> Option<Value> {
        match self.home_of(Entity::Input(k)) {
            (home, Entity::Input(k)) => home.inputs.get(k)?.value,
            _ => None,
        }
    }

    // ---- definitions

    /// Params, functions, tables and inputs of a part, with what is said of its params.
    pub(super) fn definitions_of_part(&mut self, part: usize) {
        let bound = self.params_bound(part);
        let samples = self.samples.clone();
        self.in_part(part, |child| {
            child.bound_params = bound;
            child.samples = samples;
            child.definitions();
        });
        self.import_params_of(part);
    }

    /// What is said of the params of a part.
    fn params_bound(&mut self, part: usize) -> Vec<BoundParam<'a>> {
        let of_part = self.bindings[part];
        let mut bound: Vec<BoundParam<'a>> = Vec::new();
        for binding in &of_part.bindings {
            let known = self.parts[part].space.get(&binding.name.text);
            let before = of_part.bindings.iter().take_while(|other| other.span != binding.span);
            if let Some(first) = before.into_iter().find(|other| is_twice(other, binding)) {
                self.report(errors::bound_twice(binding, first.span));
                continue;
            }
            match known {
                Some(Entity::Param(_)) => {
                    let is_point = self.parts[part].point_params.contains(binding.name.text.as_str());
                    if let Some(value) = self.param_bound(binding, is_point) {
                        bound.push(BoundParam { name: &binding.name.text, bound: value, span: Some(binding.span) });
                    }
                }
                Some(Entity::Input(_)) if binding.coordinate.is_none() => {}
                Some(Entity::Broken) => {}
                other => self.nothing_to_bind(part, binding, other),
            }
        }
        bound
    }

    fn nothing_to_bind(&mut self, part: usize, binding: &Binding, found: Option<Entity>) {
        let child = &self.parts[part];
        let known: Vec<&str> = child.space.names(|e| matches!(e, Entity::Param(_) | Entity::Input(_))).collect();
        let meant = nearest(&binding.name.text, known.iter().copied());
        let mechanism = &child.tree.name.text;
        let diagnostic = errors::nothing_to_bind(mechanism, binding, found.map(Entity::noun), &known, meant);
        self.report(diagnostic);
    }

    fn param_bound(&mut self, binding: &'a Binding, is_point: bool) -> Option<Bound> {
        let value = &binding.value;
        let context = Context::constant("a binding of a param");
        if let Some(coordinate) = &binding.coordinate {
            let Some(k) = super::kinds::coordinate(coordinate).filter(|_| is_point) else {
                self.report(errors::no_coordinate_to_bind(binding, coordinate, is_point));
                return None;
            };
            let judged = self.is_dimensional(value);
            let number = self.formula(value, &Context { judged, ..context })?;
            return Some(Bound::Coordinate(k, number, judged));
        }
        if is_point {
            if !self.is_point(value) {
                self.report(errors::number_for_point(binding));
                return None;
            }
            return self.at_site(Site::Mechanism, None, |c| c.point_formula(value, &context)).map(Bound::Point);
        }
        let judged = self.is_dimensional(value);
        let number = self.formula(value, &Context { judged, ..context })?;
        self.constant_value(number.id);
        Some(Bound::Number(if self.is_zero(value) { Value { dim: Dim::Any, ..number } } else { number }, judged))
    }

    /// A constant that is known as a number.
    pub(super) fn number_bound(&mut self, value: f64) -> Bound {
        Bound::Number(Value { id: self.model.graph.constant(value), dim: Dim::Any }, false)
    }

    /// A param with what is said of it where its mechanism is used.
    pub(super) fn as_bound(&mut self, name: &Name, in_file: Value) -> Option<Option<Value>> {
        let BoundParam { bound: Bound::Number(value, judged), span, .. } = *self.bound_param(name)? else {
            return None;
        };
        let fits = match (in_file.dim, value.dim) {
            (Dim::Of(wanted), Dim::Of(found)) if judged => wanted.is(found),
            _ => true,
        };
        if let (false, Dim::Of(wanted), Dim::Of(found), Some(span)) = (fits, in_file.dim, value.dim, span) {
            let place = format!("the parameter `{}`", name.text);
            let part = rates::Part { span, dimension: found };
            self.report(errors::wrong_dimension(&place, wanted, part, self.sources.text(span)));
            return Some(None);
        }
        let dim = if in_file.dim == Dim::Any { value.dim } else { in_file.dim };
        if self.deciding.contains(&name.text)
            && let Some(number) = self.constant_value(value.id)
        {
            return Some(Some(Value { id: self.model.graph.constant(number), dim }));
        }
        Some(Some(Value { id: value.id, dim }))
    }

    /// What is said of a param where its mechanism is used.
    pub(super) fn bound_param(&self, name: &Name) -> Option<&BoundParam<'a>> {
        self.bound_params.iter().find(|bound| bound.name == name.text)
    }

    /// A point with what is said of it, or of its coordinates, where its mechanism is used.
    pub(super) fn point_as_bound(&mut self, name: &Name, mut point: Drawn) -> Option<Drawn> {
        for k in 0..self.bound_params.len() {
            let BoundParam { name: bound_name, bound, span } = self.bound_params[k];
            if bound_name != name.text {
                continue;
            }
            match bound {
                Bound::Point(bound) => point = bound,
                Bound::Coordinate(axis, value, judged) => {
                    let place = format!("the coordinate `{}.{}`", name.text, ["x", "y"][axis]);
                    let context = Context { judged, ..Context::constant("a binding of a param") };
                    let span = span.unwrap_or(name.span);
                    self.demand(&place, Dimension::LENGTH, span, value.dim, &context)?;
                    point.at[axis] = value.id;
                    point.dimensional |= judged;
                }
                Bound::Number(..) => {}
            }
        }
        Some(point)
    }

    /// What is bound of its params, as far as it could be read.
    fn bound_numbers(&self) -> Vec<(String, ExprId)> {
        let numbers = |bound: &BoundParam<'_>| match bound.bound {
            Bound::Number(value, _) => vec![(bound.name.to_owned(), value.id)],
            Bound::Point(Drawn { at: [x, y], .. }) => {
                vec![(format!("{}.x", bound.name), x), (format!("{}.y", bound.name), y)]
            }
            Bound::Coordinate(axis, value, _) => vec![(format!("{}.{}", bound.name, ["x", "y"][axis]), value.id)],
        };
        self.bound_params.iter().flat_map(numbers).collect()
    }

    /// Params that are known as numbers (SI), as if they were bound: those of a part that stands alone.
    pub(super) fn bind_numbers(&mut self, numbers: &'a [(String, f64)]) {
        for (name, value) in numbers {
            let bound = self.number_bound(*value);
            let coordinate = name.rsplit_once('.').zip(match bound {
                Bound::Number(value, _) => Some(value),
                _ => None,
            });
            let param = match coordinate {
                Some(((owner, axis), value)) => BoundParam {
                    name: owner,
                    bound: Bound::Coordinate(usize::from(axis == "y"), value, false),
                    span: None,
                },
                None => BoundParam { name, bound, span: None },
            };
            self.bound_params.push(param);
        }
    }

    // ---- frames

    /// The ground of a part, and what stands in it.
    pub(super) fn add_part(&mut self, part: usize, written: &ast::Part) {
        if part >= self.parts.len() {
            return;
        }
        let zero = self.model.graph.constant(0.0);
        let declared = self.declared(&written.name);
        let is_turned_over = written.mirrored.is_some();
        let text = self.parts[part].tree.name.span;
        let id = self.model.add_part(Part {
            text,
            params: self.parts[part].bound_numbers(),
            inputs: Vec::new(),
            ground_name: format!("{}.ground", declared.name),
            declared,
            within: self.part,
            mount: self.ground,
            pose: [zero; 3],
            is_turned_over,
            is_mirrored: self.model.is_mirrored(self.part) != is_turned_over,
        });
        self.in_part(part, |child| {
            child.part = Some(id);
            child.ground = Frame::Part(id);
            child.add_frames();
        });
    }

    /// What carries each part, and where.
    pub(super) fn mount_parts(&mut self) {
        for k in 0..self.parts.len() {
            let written = self.bindings[k];
            let mount = written.on.as_ref().map(|on| self.carrier_of(on));
            let pose = written.at.as_ref().map(|at| self.at_site(Site::Drawing, None, |c| c.pose_of_part(at)));
            let Some(id) = self.parts[k].part else { continue };
            let own = Frame::Part(id);
            if let Some(Some(mount)) = mount {
                if self.model.carrier_chain(mount).any(|frame| frame == own) {
                    self.report(errors::carries_itself(
                        &written.name,
                        written.on.as_ref().map_or(written.name.span, |on| on.span),
                    ));
                } else {
                    self.model.parts[id.index()].mount = mount;
                }
            }
            if let Some(Some(pose)) = pose {
                self.model.parts[id.index()].pose = pose;
            }
        }
        self.in_parts(Checker::mount_parts);
    }

    fn carrier_of(&mut self, on: &Expr) -> Option<Frame> {
        match &on.kind {
            ExprKind::Name(name) => self.body(name),
            _ => {
                self.wrong_kind(on.span, "a body", Self::describe(on));
                None
            }
        }
    }

    /// A part's frame: those of the poses of bodies that need no body.
    fn pose_of_part(&mut self, at: &Expr) -> Option<[ExprId; 3]> {
        let (place, phi) = self.place_and_angle(at)?;
        let ([x, y], phi) = (place?, phi?);
        Some([x, y, phi])
    }

    /// Where a frame is drawn in that of this text.
    pub(super) fn drawn_frame(&mut self, frame: Frame) -> Placement {
        let mut graph = std::mem::replace(&mut self.model.graph, Graph::new());
        let placement = self.model.drawn(&mut graph, &mut |_, id| id, self.part, frame);
        self.model.graph = graph;
        placement
    }

    /// Whether a frame moves, as this text sees it.
    pub(super) fn moves(&self, frame: Frame) -> bool {
        let mut chain = self.model.carrier_chain(frame);
        chain.find_map(|frame| match frame {
            _ if frame == self.ground => Some(false),
            Frame::Body(_) => Some(true),
            Frame::Ground => Some(false),
            Frame::Part(_) => None,
        }) == Some(true)
    }

    // ---- inputs

    /// What is said of the inputs of parts, from the outside in.
    pub(super) fn bind_inputs(&mut self) {
        for part in 0..self.parts.len() {
            let of_part = self.bindings[part];
            for binding in &of_part.bindings {
                let Some(Entity::Input(k)) = self.parts[part].space.get(&binding.name.text) else { continue };
                let value = self.input_bound(part, k, binding);
                self.parts[part].inputs[k].value = value;
            }
            self.tell_inputs(part);
            self.in_part(part, Checker::bind_inputs);
        }
    }

    /// Writes down what the inputs of a part are in the end, those of parts within it that nobody binds by their paths there.
    fn tell_inputs(&mut self, part: usize) {
        let Some(id) = self.parts[part].part else { return };
        let child = &self.parts[part];
        let own = child.inputs.iter().filter_map(|input| Some((input.name.text.clone(), input.value?.id)));
        let mut inputs: Vec<(String, ExprId)> = own.collect();
        let deeper = self.model.inputs.iter().filter_map(|input| {
            let name = input.declared.name.strip_prefix(child.path.as_str())?;
            name.contains('.').then(|| (name.to_owned(), input.value))
        });
        inputs.extend(deeper);
        self.model.parts[id.index()].inputs = inputs;
    }

    fn input_bound(&mut self, part: usize, k: usize, binding: &Binding) -> Option<Value> {
        let wanted = self.parts[part].inputs.get(k)?.value?.dim;
        let judged = self.is_dimensional(&binding.value);
        let context = Context {
            judged,
            time: true,
            inputs: true,
            quantities: true,
            ..Context::constant("a binding of an input")
        };
        let conditions = self.model.conditions.len();
        let value = self.formula(&binding.value, &context)?;
        let owner = format!("{}{}", self.path, self.bindings[part].name.text);
        for condition in &mut self.model.conditions[conditions..] {
            condition.owner.clone_from(&owner);
        }
        if let (Dim::Of(wanted), Dim::Of(found)) = (wanted, value.dim)
            && judged
            && !wanted.is(found)
        {
            let place = format!("the input `{}` of `{}`", binding.name.text, self.bindings[part].name.text);
            let wrong = rates::Part { span: binding.value.span, dimension: found };
            self.report(errors::wrong_dimension(&place, wanted, wrong, self.sources.text(binding.value.span)));
            return None;
        }
        Some(Value { dim: wanted, ..value })
    }

    // ---- what is told from outside

    /// All params or inputs, those of parts by their paths, each with the place of its binding if it has one.
    pub(super) fn settable_names(&self, of: fn(&ItemKind) -> Option<&Name>) -> Vec<(String, Option<Span>)> {
        let mut found = Vec::new();
        self.add_settable("", &[], of, &mut found);
        found
    }

    fn add_settable(
        &self,
        path: &str,
        bindings: &[Binding],
        of: fn(&ItemKind) -> Option<&Name>,
        found: &mut Vec<(String, Option<Span>)>,
    ) {
        for name in self.items().iter().filter_map(|item| of(&item.kind)) {
            let binding =
                bindings.iter().find(|binding| binding.name.text == name.text && binding.coordinate.is_none());
            found.push((format!("{path}{}", name.text), binding.map(|binding| binding.span)));
        }
        for (child, part) in self.parts.iter().zip(&self.bindings) {
            child.add_settable(&format!("{path}{}.", part.name.text), &part.bindings, of, found);
        }
    }
}

/// Whether what is told of a path is told of a thing: of itself, or of all copies of something repeated; spaces count nothing.
pub(super) fn is_told_by(full: &str, told: &str) -> bool {
    let told: String = told.chars().filter(|c| !c.is_whitespace()).collect();
    if told == full {
        return true;
    }
    let told = normalized(&told);
    let (mut own, mut others) = (full.split('.'), told.split('.'));
    loop {
        match (own.next(), others.next()) {
            (None, None) => return true,
            (Some(own), Some(other)) => {
                let is_it = own == other || own.split_once('[').is_some_and(|(base, _)| base == other);
                if !is_it {
                    return false;
                }
            }
            _ => return false,
        }
    }
}

fn is_twice(a: &Binding, b: &Binding) -> bool {
    let coordinates = [a, b].map(|binding| binding.coordinate.as_ref().map(|name| name.text.as_str()));
    a.name.text == b.name.text && (coordinates[0] == coordinates[1] || coordinates.contains(&None))
}

fn next(count: &mut usize) -> usize {
    *count += 1;
    *count - 1
}

/// Sets an element of a list, which is made long enough.
fn set<T: Clone>(list: &mut Vec<T>, k: usize, value: Option<T>, otherwise: T) {
    if list.len() <= k {
        list.resize(k + 1, otherwise);
    }
    if let Some(value) = value {
        list[k] = value;
    }
}
