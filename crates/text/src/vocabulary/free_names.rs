//! Suggestions of free names in place of names that are words of the language.

use super::{Constant, Dimension, Unit, is_called};

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

/// Substitutes for words of the language: as the name of a body, of a joint or equation, and of a feature or value.
const SUBSTITUTES: &[(&str, [&str; 3])] = &[
    // ---- constants
    ("t", ["top", "top_pin", "thickness"]),
    ("pi", ["shaft", "pin", "ratio"]),
    ("tau", ["arm", "hinge", "delay"]),
    // ---- keywords
    ("analysis", ["sample", "probe", "study"]),
    ("axis", ["shaft", "shaft_bearing", "line"]),
    ("body", ["housing", "mount", "center"]),
    ("circle", ["wheel", "hub", "rim"]),
    ("constraint", ["stop", "coupling", "limit"]),
    ("curve", ["cam", "contact", "profile"]),
    ("driver", ["crank", "motor", "drive"]),
    ("ground", ["base", "base_pin", "base"]),
    ("joint", ["knuckle", "hinge", "pivot"]),
    ("measure", ["gauge", "gauge_pin", "reading"]),
    ("mechanism", ["machine", "hinge", "machine"]),
    ("param", ["arm", "hinge", "value"]),
    ("point", ["pointer", "tip_pin", "tip"]),
    ("table", ["plate", "plate_pin", "top"]),
    // ---- what is called
    ("x", ["arm", "hinge", "across"]),
    ("y", ["arm", "hinge", "height"]),
    ("angle", ["arm", "hinge", "tilt"]),
    ("distance", ["arm", "hinge", "reach"]),
    ("rotation", ["arm", "hinge", "turn"]),
    ("displacement", ["arm", "hinge", "travel"]),
];

/// Returns a free name in place of a word of the language.
pub fn substitute_name(word: &str, kind: SubstituteKind, is_free: impl Fn(&str) -> bool) -> Option<&'static str> {
    let substitute = SUBSTITUTES.iter().find(|(other, _)| *other == word).and_then(|(_, names)| match kind {
        SubstituteKind::Body => Some(names[0]),
        SubstituteKind::Joint | SubstituteKind::Equation => Some(names[1]),
        SubstituteKind::Feature | SubstituteKind::Value | SubstituteKind::Function => Some(names[2]),
        SubstituteKind::Argument => Some("u"),
        // the substitutes for values are mostly lengths
        SubstituteKind::Mass | SubstituteKind::Time => None,
    });
    substitute.into_iter().chain(kind.names().iter().copied()).find(|name| {
        Constant::named(name).is_none() && Unit::named(name).is_none() && !is_called(name) && is_free(name)
    })
}

#[cfg(test)]
mod tests {
    use super::{SUBSTITUTES, SubstituteKind, substitute_name};
    use crate::vocabulary::{Constant, Keyword, Unit, is_called};

    #[test]
    fn every_proposed_name_can_be_declared() {
        let general = ["body", "joint", "driver", "point", "param", "fn"].map(SubstituteKind::behind);
        let values = [SubstituteKind::Mass, SubstituteKind::Time];
        let kinds = general.iter().chain(&values).flat_map(|kind| kind.names());
        let names = SUBSTITUTES.iter().flat_map(|(_, names)| names).chain(kinds);
        for name in names {
            let is_word = Constant::named(name).is_some() || Unit::named(name).is_some() || is_called(name);
            assert!(!is_word && Keyword::named(name).is_none(), "`{name}` is a word of the language");
        }
    }

    #[test]
    fn proposed_names_are_unused() {
        let kind = SubstituteKind::behind("body");
        assert_eq!(substitute_name("t", kind, |_| true), Some("top"));
        assert_eq!(substitute_name("t", kind, |name| name != "top"), Some("arm"));
        assert_eq!(substitute_name("cosh", kind, |name| !["arm", "slide"].contains(&name)), Some("link"));
        assert_eq!(substitute_name("t", kind, |_| false), None);
        assert_eq!(substitute_name("tau", SubstituteKind::Mass, |_| true), Some("m1"));
    }
}
