//! Copies of declarations: all formulas with numbers in the place of indices.

use super::{Expanded, Expander, NotExpandable, Numbers, broken, named};
use mechc_syntax::ast::{
    self, DrawnPose, Expr, ExprKind, Feature, FeatureKind, Item, ItemKind, Name, TableRows, Window,
};

impl Expander<'_, '_> {
    /// Returns a copy of a declaration, which is broken if something in it cannot be expanded.
    pub(in crate::check) fn copy(&mut self, item: &Item, numbers: &Numbers<'_>) -> Item {
        match self.kind(&item.kind, numbers) {
            Ok(kind) => Item { docs: item.docs.clone(), span: item.span, ranges: Vec::new(), kind },
            Err(NotExpandable) => broken(item, numbers),
        }
    }

    fn kind(&mut self, kind: &ItemKind, numbers: &Numbers<'_>) -> Expanded<ItemKind> {
        let renamed = |name: &Name| named(name, numbers);
        Ok(match kind {
            ItemKind::Param { name, value } => {
                ItemKind::Param { name: name.clone(), value: self.formula(value, numbers)? }
            }
            ItemKind::Function { name, argument, value } => {
                let value = self.formula_with_argument(argument, value)?;
                ItemKind::Function { name: name.clone(), argument: argument.clone(), value }
            }
            ItemKind::Table { name, periodic, rows: TableRows::Listed(rows) } => {
                let rows = TableRows::Listed(self.formulas(rows, numbers)?);
                ItemKind::Table { name: name.clone(), periodic: *periodic, rows }
            }
            ItemKind::Analysis { from, to, every } => ItemKind::Analysis {
                from: self.formula(from, numbers)?,
                to: self.formula(to, numbers)?,
                every: self.formula(every, numbers)?,
            },
            ItemKind::Input { name, value } => {
                ItemKind::Input { name: renamed(name), value: self.formula(value, numbers)? }
            }
            ItemKind::Measure { name, value, unit } => {
                ItemKind::Measure { name: renamed(name), value: self.formula(value, numbers)?, unit: unit.clone() }
            }
            ItemKind::Trace { name, point, unit } => {
                ItemKind::Trace { name: renamed(name), point: self.formula(point, numbers)?, unit: unit.clone() }
            }
            ItemKind::Result { name, value, unit } => {
                ItemKind::Result { name: renamed(name), value: self.formula(value, numbers)?, unit: unit.clone() }
            }
            ItemKind::Requirement(requirement) => {
                let ast::Requirement { name, first, rest, within } = &**requirement;
                let side = |side: &ast::ComparedSide| {
                    Ok(ast::ComparedSide { right: self.formula(&side.right, numbers)?, ..side.clone() })
                };
                ItemKind::Requirement(Box::new(ast::Requirement {
                    name: name.clone(),
                    rest: rest.iter().map(side).collect::<Expanded<_>>()?,
                    first: self.formula(first, numbers)?,
                    within: within.as_ref().map(|within| self.formula(within, numbers)).transpose()?,
                }))
            }
            ItemKind::Ground { features } => ItemKind::Ground { features: self.features(features, numbers)? },
            ItemKind::Body { name, pose, features } => ItemKind::Body {
                name: renamed(name),
                pose: pose.as_ref().map(|pose| self.pose(pose, numbers)).transpose()?,
                features: self.features(features, numbers)?,
            },
            ItemKind::Joint { name, kind, arguments, call_span } => ItemKind::Joint {
                name: renamed(name),
                kind: kind.clone(),
                arguments: self.formulas(arguments, numbers)?,
                call_span: *call_span,
            },
            ItemKind::Equation { driver, name, left, right } => ItemKind::Equation {
                driver: *driver,
                name: renamed(name),
                left: self.formula(left, numbers)?,
                right: self.formula(right, numbers)?,
            },
            ItemKind::Gravity { acceleration } => {
                ItemKind::Gravity { acceleration: self.formula(acceleration, numbers)? }
            }
            ItemKind::Load { name, force, on } => ItemKind::Load {
                name: renamed(name),
                force: self.formula(force, numbers)?,
                on: self.formula(on, numbers)?,
            },
            ItemKind::Part(part) => ItemKind::Part(Box::new(self.part(part, numbers)?)),
            other => other.clone(),
        })
    }

    /// Expands a part, which is broken if its mechanism is unknown.
    fn part(&mut self, part: &ast::Part, numbers: &Numbers<'_>) -> Expanded<ast::Part> {
        let name = named(&part.name, numbers);
        if self.parts.get(&name.text).is_none_or(Option::is_none) {
            return Err(NotExpandable);
        }
        let binding = |binding: &ast::Binding| {
            Ok(ast::Binding { value: self.formula(&binding.value, numbers)?, ..binding.clone() })
        };
        let bindings = part.bindings.iter().map(binding).collect::<Expanded<_>>()?;
        let mut place = |e: &Option<Expr>| e.as_ref().map(|e| self.formula(e, numbers)).transpose();
        Ok(ast::Part { name, bindings, on: place(&part.on)?, at: place(&part.at)?, ..part.clone() })
    }

    fn features(&mut self, features: &[Feature], numbers: &Numbers<'_>) -> Expanded<Vec<Feature>> {
        let copy = |feature: &Feature| {
            let mut of = |e: &Expr| self.formula(e, numbers).map(Box::new);
            let kind = match &feature.kind {
                FeatureKind::Broken => FeatureKind::Broken,
                FeatureKind::Point { at } => {
                    FeatureKind::Point { at: at.as_ref().map(|e| self.formula(e, numbers)).transpose()? }
                }
                FeatureKind::AxisAlong { origin, direction } => {
                    FeatureKind::AxisAlong { origin: of(origin)?, direction: of(direction)? }
                }
                FeatureKind::AxisTo { origin, target } => {
                    FeatureKind::AxisTo { origin: of(origin)?, target: of(target)? }
                }
                FeatureKind::Circle { center, radius } => {
                    FeatureKind::Circle { center: of(center)?, radius: of(radius)? }
                }
                FeatureKind::Curve { argument, at, estimate } => FeatureKind::Curve {
                    argument: argument.clone(),
                    at: of(at)?,
                    estimate: estimate.as_deref().map(of).transpose()?,
                },
                FeatureKind::Mass { mass, at, inertia } => FeatureKind::Mass {
                    mass: of(mass)?,
                    at: at.as_deref().map(&mut of).transpose()?,
                    inertia: inertia.as_deref().map(of).transpose()?,
                },
            };
            Ok(Feature { docs: feature.docs.clone(), span: feature.span, name: feature.name.clone(), kind })
        };
        features.iter().map(copy).collect()
    }

    fn pose(&mut self, pose: &DrawnPose, numbers: &Numbers<'_>) -> Expanded<DrawnPose> {
        let toward = pose.toward.as_ref().map(|toward| self.formula(toward, numbers)).transpose()?;
        Ok(DrawnPose { at: self.formula(&pose.at, numbers)?, toward })
    }

    /// Expands the formula of a function, whose argument hides a repeated declaration.
    fn formula_with_argument(&mut self, argument: &Name, formula: &Expr) -> Expanded<Expr> {
        let hidden = self.copies.remove_entry(argument.text.as_str());
        let written = self.formula(formula, &Vec::new());
        self.copies.extend(hidden);
        written
    }

    fn formulas(&mut self, list: &[Expr], numbers: &Numbers<'_>) -> Expanded<Vec<Expr>> {
        list.iter().map(|e| self.formula(e, numbers)).collect()
    }

    fn window(&mut self, window: &Window, numbers: &Numbers<'_>) -> Expanded<Window> {
        let mut bound = |bound: &Option<Expr>| bound.as_ref().map(|e| self.formula(e, numbers)).transpose();
        Ok(Window { from: bound(&window.from)?, to: bound(&window.to)?, span: window.span })
    }

    /// Expands a formula: indices become numbers, and paths become names.
    pub(in crate::check) fn formula(&mut self, e: &Expr, numbers: &Numbers<'_>) -> Expanded<Expr> {
        let mut boxed = |e: &Expr| self.formula(e, numbers).map(Box::new);
        let kind = match &e.kind {
            ExprKind::Literal { .. } => e.kind.clone(),
            ExprKind::Name(name) => {
                if let Some(&(_, k)) = numbers.iter().find(|(index, _)| *index == name.text) {
                    ExprKind::Literal { value: k as f64, unit: None }
                } else {
                    self.must_not_be_repeated(name)?;
                    e.kind.clone()
                }
            }
            ExprKind::Member { owner, feature } => {
                self.must_not_be_repeated(owner)?;
                match self.parts.get(&owner.text).cloned() {
                    Some(part) => {
                        let segment = ast::PathSegment { name: feature.clone(), indices: Vec::new() };
                        self.inside(e.span, &owner.text, part, &[segment], numbers)?
                    }
                    None => e.kind.clone(),
                }
            }
            ExprKind::Path(segments) => self.path(e.span, segments, numbers)?,
            ExprKind::Call { name, arguments, window } => ExprKind::Call {
                name: name.clone(),
                arguments: self.formulas(arguments, numbers)?,
                window: match window {
                    Some(window) => Some(Box::new(self.window(window, numbers)?)),
                    None => None,
                },
            },
            ExprKind::Paren(inner) => ExprKind::Paren(boxed(inner)?),
            ExprKind::Negate(inner) => ExprKind::Negate(boxed(inner)?),
            ExprKind::Not(inner) => ExprKind::Not(boxed(inner)?),
            ExprKind::Power(a, b) => ExprKind::Power(boxed(a)?, boxed(b)?),
            ExprKind::Compare(a, relation, b) => ExprKind::Compare(boxed(a)?, *relation, boxed(b)?),
            ExprKind::Tuple(list) => ExprKind::Tuple(self.formulas(list, numbers)?),
            ExprKind::And(list) => ExprKind::And(self.formulas(list, numbers)?),
            ExprKind::Or(list) => ExprKind::Or(self.formulas(list, numbers)?),
            ExprKind::Sum(first, rest) => {
                let terms = rest.iter().map(|(sign, term)| Ok((*sign, self.formula(term, numbers)?)));
                let rest = terms.collect::<Expanded<_>>()?;
                ExprKind::Sum(Box::new(self.formula(first, numbers)?), rest)
            }
            ExprKind::Product(first, rest) => {
                let factors = rest.iter().map(|(kind, factor)| Ok((*kind, self.formula(factor, numbers)?)));
                let rest = factors.collect::<Expanded<_>>()?;
                ExprKind::Product(Box::new(self.formula(first, numbers)?), rest)
            }
            ExprKind::If { arms, otherwise } => {
                let arms = arms
                    .iter()
                    .map(|(condition, value)| Ok((self.formula(condition, numbers)?, self.formula(value, numbers)?)));
                let arms = arms.collect::<Expanded<_>>()?;
                ExprKind::If { arms, otherwise: Box::new(self.formula(otherwise, numbers)?) }
            }
        };
        Ok(Expr { kind, span: e.span })
    }
}
