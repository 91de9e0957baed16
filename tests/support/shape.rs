//! Trees without spans: texts with the same meaning have the same shape.

use mechc_syntax::ast::{
    Binding, Expr, ExprKind, Feature, FeatureKind, File, IndexRange, Item, ItemKind, Mechanism, Name, Part,
    PathSegment, TableRows, UsedFile, WrittenUnit,
};

/// Returns the shape of a formula: no parentheses, sums and products as pairs from the left, `and` and `or` flat, `else if` nested.
pub fn shape(e: &Expr) -> String {
    let pairs = |first: &Expr, rest: Vec<(String, &Expr)>| {
        rest.into_iter().fold(shape(first), |before, (sign, e)| format!("({sign} {before} {})", shape(e)))
    };
    match &e.kind {
        ExprKind::Literal { value, unit: None } => format!("{value:?}"),
        ExprKind::Literal { value, unit: Some((unit, power)) } => format!("<{value:?} {}^{power}>", unit.text),
        ExprKind::Name(name) => name.text.clone(),
        ExprKind::Member { owner, feature } => format!("{}.{}", owner.text, feature.text),
        ExprKind::Path(segments) => {
            let part = |segment: &PathSegment| format!("{}{}", segment.name.text, shapes(&segment.indices));
            segments.iter().map(part).collect::<Vec<_>>().join(".")
        }
        ExprKind::Call { name, arguments, window } => {
            let window = window.as_ref().map_or_else(String::new, |window| {
                let bound = |bound: &Option<Expr>| bound.as_ref().map_or_else(|| "…".to_owned(), shape);
                format!(" from {} to {}", bound(&window.from), bound(&window.to))
            });
            format!("{}{}{window}", name.text, shapes(arguments))
        }
        ExprKind::Paren(inner) => shape(inner),
        ExprKind::Tuple(list) => shapes(list),
        ExprKind::Negate(inner) => format!("(neg {})", shape(inner)),
        ExprKind::Not(inner) => format!("(not {})", shape(inner)),
        ExprKind::Sum(first, rest) => pairs(first, rest.iter().map(|(sign, e)| (format!("{sign:?}"), e)).collect()),
        ExprKind::Product(first, rest) => pairs(first, rest.iter().map(|(f, e)| (format!("{f:?}"), e)).collect()),
        ExprKind::Power(base, exponent) => format!("(power {} {})", shape(base), shape(exponent)),
        ExprKind::Compare(a, comparison, b) => format!("({comparison:?} {} {})", shape(a), shape(b)),
        ExprKind::And(_) | ExprKind::Or(_) => {
            let word = if matches!(e.kind, ExprKind::And(_)) { "and" } else { "or" };
            let mut list = Vec::new();
            operands(e, word, &mut list);
            format!("({word} {})", list.join(" "))
        }
        ExprKind::If { arms, otherwise } => arms
            .iter()
            .rev()
            .fold(shape(otherwise), |rest, (c, value)| format!("(if {} {} {rest})", shape(c), shape(value))),
    }
}

fn operands(e: &Expr, word: &str, list: &mut Vec<String>) {
    match (&e.bare().kind, word) {
        (ExprKind::And(inner), "and") | (ExprKind::Or(inner), "or") => {
            for e in inner {
                operands(e, word, list);
            }
        }
        _ => list.push(shape(e)),
    }
}

fn shapes(list: &[Expr]) -> String {
    format!("[{}]", list.iter().map(shape).collect::<Vec<_>>().join(", "))
}

/// Returns the shapes of all declarations of a file, a line each.
pub fn file_shape(file: &File) -> Vec<String> {
    let uses = file.uses.iter().map(use_shape);
    uses.chain(file.mechanisms.iter().flat_map(mechanism_shape)).collect()
}

fn use_shape(used: &UsedFile) -> String {
    let text = |name: &Option<Name>| name.as_ref().map(|name| name.text.clone());
    format!("{:?} use {:?} as {:?}", used.docs, text(&used.path), text(&used.prefix))
}

fn mechanism_shape(mechanism: &Mechanism) -> Vec<String> {
    let mut lines = vec![format!("{:?} mechanism {}", mechanism.docs, mechanism.name.text)];
    for item in &mechanism.items {
        lines.push(format!("{:?} {}", item.docs, item_shape(item)));
        if let ItemKind::Ground { features } | ItemKind::Body { features, .. } = &item.kind {
            lines.extend(features.iter().map(feature_shape));
        }
    }
    lines
}

fn item_shape(item: &Item) -> String {
    let range = |range: &IndexRange| {
        format!("{} {} {} {}", range.index.text, shape(&range.from), shape(&range.to), range.is_closed)
    };
    let ranges: Vec<String> = item.ranges.iter().map(range).collect();
    format!("{} {ranges:?}", kind_shape(&item.kind))
}

fn part_shape(part: &Part) -> String {
    let binding = |binding: &Binding| {
        let coordinate = binding.coordinate.as_ref().map(|name| name.text.as_str());
        format!("{} {coordinate:?} {}", binding.name.text, shape(&binding.value))
    };
    let bindings: Vec<String> = part.bindings.iter().map(binding).collect();
    let places: Vec<String> = part.on.iter().chain(&part.at).map(shape).collect();
    let (name, mechanism) = (&part.name.text, part.mechanism.text());
    format!("part {name} {mechanism} {bindings:?} {places:?} {:?}", part.mirrored.is_some())
}

fn kind_shape(kind: &ItemKind) -> String {
    match kind {
        ItemKind::Input { name, value } => format!("input {} {}", name.text, shape(value)),
        ItemKind::Param { name, value } => format!("param {} {}", name.text, shape(value)),
        ItemKind::Function { name, argument, value } => format!("fn {} {} {}", name.text, argument.text, shape(value)),
        ItemKind::Table { name, periodic, rows } => match rows {
            TableRows::Listed(rows) => format!("table {} {periodic} {}", name.text, shapes(rows)),
            TableRows::File { path, columns, units } => {
                let units: Vec<String> = units.iter().flatten().map(|unit| unit_shape(Some(unit))).collect();
                let columns: Vec<_> = columns.iter().flatten().map(|column| &column.kind).collect();
                format!("table {} {periodic} {:?} {columns:?} {units:?}", name.text, path.text)
            }
        },
        ItemKind::Ground { .. } => "ground".to_owned(),
        ItemKind::Body { name, pose, .. } => {
            let pose = pose.as_ref().map(|pose| pose.parts().map(shape).collect::<Vec<_>>());
            format!("body {} {pose:?}", name.text)
        }
        ItemKind::Joint { name, kind, arguments, .. } => {
            format!("joint {} {}{}", name.text, kind.text, shapes(arguments))
        }
        ItemKind::Equation { driver, name, left, right } => {
            format!("equation {driver} {} {} {}", name.text, shape(left), shape(right))
        }
        ItemKind::Gravity { acceleration } => format!("gravity {}", shape(acceleration)),
        ItemKind::Load { name, force, on } => format!("load {} {} {}", name.text, shape(force), shape(on)),
        ItemKind::Measure { name, value, unit } => {
            format!("measure {} {} {}", name.text, shape(value), unit_shape(unit.as_ref()))
        }
        ItemKind::Trace { name, point, unit } => {
            format!("trace {} {} {}", name.text, shape(point), unit_shape(unit.as_ref()))
        }
        ItemKind::Part(part) => part_shape(part),
        ItemKind::Result { name, value, unit } => {
            format!("result {} {} {}", name.text, shape(value), unit_shape(unit.as_ref()))
        }
        ItemKind::Requirement(of) => {
            let name = of.name.as_ref().map(|name| name.text.as_str());
            let rest: Vec<String> =
                of.rest.iter().map(|side| format!("{:?} {}", side.sign, shape(&side.right))).collect();
            format!("require {name:?} {} {rest:?} {:?}", shape(&of.first), of.within.as_ref().map(shape))
        }
        ItemKind::Broken { .. } => "broken".to_owned(),
        ItemKind::Analysis { from, to, every } => format!("analysis {} {} {}", shape(from), shape(to), shape(every)),
    }
}

fn feature_shape(feature: &Feature) -> String {
    let text = match &feature.kind {
        FeatureKind::Broken => "broken".to_owned(),
        FeatureKind::Point { at } => format!("point {:?}", at.as_ref().map(shape)),
        FeatureKind::AxisAlong { origin, direction } => format!("along {} {}", shape(origin), shape(direction)),
        FeatureKind::AxisTo { origin, target } => format!("to {} {}", shape(origin), shape(target)),
        FeatureKind::Circle { center, radius } => format!("circle {} {}", shape(center), shape(radius)),
        FeatureKind::Curve { argument, at, estimate } => {
            format!("curve {} {} {:?}", argument.text, shape(at), estimate.as_deref().map(shape))
        }
        FeatureKind::Mass { mass, at, inertia } => {
            let rest: Vec<_> = [at, inertia].map(|e| e.as_deref().map(shape)).into();
            format!("mass {} {rest:?}", shape(mass))
        }
    };
    format!("    {:?} {} {text}", feature.docs, feature.name.text)
}

fn unit_shape(unit: Option<&WrittenUnit>) -> String {
    let factors = unit.iter().flat_map(|unit| &unit.factors);
    let texts: Vec<String> = factors.map(|of| format!("{:?} {}^{}", of.factor, of.name.text, of.power)).collect();
    texts.join(" ")
}
