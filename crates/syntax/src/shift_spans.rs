//! Shifts the spans of a tree to where its text stands after an edit before it.

use super::ast::{
    Binding, ColumnName, ColumnWord, ComparedSide, ComparisonSign, DrawnPose, Expr, ExprKind, Factor, Feature,
    FeatureKind, IndexRange, Item, ItemKind, MechanismName, Name, Part, PathSegment, Requirement, Sign, TableRows,
    UnitFactor, Window, WrittenUnit,
};
use mechc_text::source::{FileId, Span};

/// A shift of spans from one text to another.
#[derive(Clone, Copy)]
pub(super) struct Shift {
    pub file: FileId,
    /// Number of bytes by which spans move, modulo 2^32, since they may move back.
    pub by: u32,
}

/// A part of the tree.
pub(super) trait Spans {
    /// Shifts all spans in it.
    fn shift(&mut self, to: Shift);
}

impl Spans for Span {
    fn shift(&mut self, to: Shift) {
        let at = |byte: u32| byte.wrapping_add(to.by);
        *self = Span { file: to.file, start: at(self.start), end: at(self.end) };
    }
}

impl<T: Spans> Spans for [T] {
    fn shift(&mut self, to: Shift) {
        for part in self {
            part.shift(to);
        }
    }
}

impl<T: Spans> Spans for Box<T> {
    fn shift(&mut self, to: Shift) {
        (**self).shift(to);
    }
}

impl<A: Spans, B: Spans> Spans for (A, B) {
    fn shift(&mut self, to: Shift) {
        self.0.shift(to);
        self.1.shift(to);
    }
}

/// Implements [`Spans`] for collections.
macro_rules! collections {
    ($([$($size:tt)*] $node:ty),*) => { $(
        impl<T: Spans, $($size)*> Spans for $node {
            fn shift(&mut self, to: Shift) {
                self.as_mut_slice().shift(to);
            }
        }
    )* };
}

/// Implements [`Spans`] for types without spans.
macro_rules! without_spans {
    ($($node:ty),*) => { $(impl Spans for $node { fn shift(&mut self, _: Shift) {} })* };
}

/// Implements [`Spans`] for structures with all their fields.
macro_rules! structures {
    ($($node:ident { $($field:ident),* })*) => { $(
        impl Spans for $node {
            fn shift(&mut self, to: Shift) {
                let $node { $($field),* } = self;
                $($field.shift(to);)*
            }
        }
    )* };
}

/// Implements [`Spans`] for enumerations with all their variants and fields.
macro_rules! enumerations {
    ($($node:ident { $($variant:ident $(($($place:ident),*))? $({ $($field:ident),* })?,)* })*) => { $(
        impl Spans for $node {
            fn shift(&mut self, to: Shift) {
                match self {
                    $($node::$variant $(($($place),*))? $({ $($field),* })? => {
                        $($($place.shift(to);)*)?
                        $($($field.shift(to);)*)?
                    })*
                }
            }
        }
    )* };
}

collections!([] Vec<T>, [] Option<T>, [const N: usize] [T; N]);
without_spans!(bool, f64, i32, String, ColumnWord, ComparisonSign, Factor, Sign);

structures! {
    ComparedSide { sign, span, right }
    Binding { name, coordinate, value, span }
    ColumnName { kind, span }
    DrawnPose { at, toward }
    Expr { kind, span }
    Feature { docs, span, name, kind }
    IndexRange { index, from, to, is_closed }
    Item { docs, span, ranges, kind }
    MechanismName { prefix, name }
    Name { text, span }
    Part { name, mechanism, bindings, on, at, mirrored, call_span }
    Requirement { name, first, rest, within }
    PathSegment { name, indices }
    UnitFactor { name, power, factor, span }
    Window { from, to, span }
    WrittenUnit { factors, span }
}

enumerations! {
    ItemKind {
        Param { name, value },
        Function { name, argument, value },
        Table { name, periodic, rows },
        Input { name, value },
        Part(part),
        Ground { features },
        Body { name, pose, features },
        Joint { name, kind, arguments, call_span },
        Equation { driver, name, left, right },
        Gravity { acceleration },
        Load { name, force, on },
        Measure { name, value, unit },
        Trace { name, point, unit },
        Result { name, value, unit },
        Requirement(requirement),
        Broken { names },
        Analysis { from, to, every },
    }
    TableRows {
        Listed(rows),
        File { path, columns, units },
    }
    FeatureKind {
        Broken,
        Point { at },
        AxisAlong { origin, direction },
        AxisTo { origin, target },
        Circle { center, radius },
        Curve { argument, at, estimate },
        Mass { mass, at, inertia },
    }
    ExprKind {
        Literal { value, unit },
        Name(name),
        Member { owner, feature },
        Path(segments),
        Call { name, arguments, window },
        Paren(inner),
        Tuple(parts),
        Negate(inner),
        Not(inner),
        Sum(first, rest),
        Product(first, rest),
        Power(base, exponent),
        Compare(left, sign, right),
        And(parts),
        Or(parts),
        If { arms, otherwise },
    }
}
