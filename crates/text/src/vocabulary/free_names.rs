//! Suggestions of free names in place of names that are words of the language.

use super::Dimension;

/// Kind of what a name is for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SubstituteKind {
    /// Body.
    Body,
    /// Joint.
    Joint,
    /// Driver or constraint.
    Equation,
    /// Point, axis, circle or curve.
    Feature,
    /// Parameter or measure.
    Value,
    /// Parameter with the dimension of a mass.
    Mass,
    /// Parameter with the dimension of a time.
    Time,
    /// Function or table.
    Function,
    /// Argument of a function or curve.
    Argument,
}

impl SubstituteKind {
    /// Returns the kind of the name after a keyword.
    #[must_use]
    pub fn behind(keyword: &str) -> SubstituteKind {
        match keyword {
            "body" | "mechanism" => SubstituteKind::Body,
            "joint" => SubstituteKind::Joint,
            "driver" | "constraint" => SubstituteKind::Equation,
            "point" | "axis" | "circle" | "curve" => SubstituteKind::Feature,
            "fn" | "table" => SubstituteKind::Function,
            _ => SubstituteKind::Value,
        }
    }

    /// Returns the kind of a parameter's name, from the dimension of its first unit.
    #[must_use]
    pub fn of_value(dimension: Option<Dimension>) -> SubstituteKind {
        match dimension {
            Some(dimension) if dimension.is(Dimension::MASS) => SubstituteKind::Mass,
            Some(dimension) if dimension.is(Dimension::TIME) => SubstituteKind::Time,
            _ => SubstituteKind::Value,
        }
    }

    /// Returns general names for the kind.
    fn names(self) -> &'static [&'static str] {
        match self {
            SubstituteKind::Body => &["arm", "slide", "link", "lever", "plate"],
            SubstituteKind::Joint => &["hinge", "pin", "guide", "bearing"],
            SubstituteKind::Equation => &["motor", "feed", "coupling"],
            SubstituteKind::Feature => &["tip", "center", "edge", "heel"],
            SubstituteKind::Value => &["size", "offset", "width", "height"],
            SubstituteKind::Mass => &["m1", "payload", "ballast"],
            SubstituteKind::Time => &["period", "delay", "duration"],
            SubstituteKind::Function => &["law", "lift", "shape"],
            SubstituteKind::Argument => &["u", "v", "w", "x", "y", "z"],
        }
    }
}

/// Returns a free name in place of a word of the language.
pub fn substitute_name(kind: SubstituteKind, is_free: impl Fn(&str) -> bool) -> Option<&'static str> {
    kind.names().iter().copied().find(|name| is_free(name))
}

#[cfg(test)]
mod tests {
    use super::{SubstituteKind, substitute_name};
    use crate::vocabulary::{Constant, Keyword, Unit, is_called};

    #[test]
    fn every_proposed_name_can_be_declared() {
        let general = ["body", "joint", "driver", "point", "param", "fn"].map(SubstituteKind::behind);
        let values = [SubstituteKind::Mass, SubstituteKind::Time];
        for name in general.iter().chain(&values).flat_map(|kind| kind.names()) {
            let is_word = Constant::named(name).is_some() || Unit::named(name).is_some() || is_called(name);
            assert!(!is_word && Keyword::named(name).is_none(), "`{name}` is a word of the language");
        }
    }

    #[test]
    fn proposed_names_are_unused() {
        let kind = SubstituteKind::behind("body");
        assert_eq!(substitute_name(kind, |_| true), Some("arm"));
        assert_eq!(substitute_name(kind, |name| !["arm", "slide"].contains(&name)), Some("link"));
        assert_eq!(substitute_name(kind, |_| false), None);
        assert_eq!(substitute_name(SubstituteKind::Argument, |name| !"uvwxy".contains(name)), Some("z"));
    }
}
