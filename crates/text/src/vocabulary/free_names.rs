//! Suggestions of free names in place of names that are words of the language.

use super::{Dimension, is_called, is_taken};

/// Kind of what a name is for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum KindOfName {
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

impl KindOfName {
    /// Returns the kind of the name after a keyword.
    #[must_use]
    pub fn behind(keyword: &str) -> KindOfName {
        match keyword {
            "body" | "mechanism" => KindOfName::Body,
            "joint" => KindOfName::Joint,
            "driver" | "constraint" => KindOfName::Equation,
            "point" | "axis" | "circle" | "curve" => KindOfName::Feature,
            "fn" | "table" => KindOfName::Function,
            _ => KindOfName::Value,
        }
    }

    /// Returns the kind of a parameter's name, from the dimension of its first unit.
    #[must_use]
    pub fn of_value(dimension: Option<Dimension>) -> KindOfName {
        match dimension {
            Some(dimension) if dimension.is(Dimension::MASS) => KindOfName::Mass,
            Some(dimension) if dimension.is(Dimension::TIME) => KindOfName::Time,
            _ => KindOfName::Value,
        }
    }

    /// Returns general names for the kind.
    fn names(self) -> &'static [&'static str] {
        match self {
            KindOfName::Body => &["arm", "slide", "link", "lever", "plate"],
            KindOfName::Joint => &["hinge", "pin", "guide", "bearing"],
            KindOfName::Equation => &["motor", "feed", "coupling"],
            KindOfName::Feature => &["tip", "center", "edge", "heel"],
            KindOfName::Value => &["size", "offset", "width", "height"],
            KindOfName::Mass => &["m1", "payload", "ballast"],
            KindOfName::Time => &["period", "delay", "duration"],
            KindOfName::Function => &["law", "lift", "shape"],
            KindOfName::Argument => &["u", "v", "w", "x", "y", "z"],
        }
    }
}

/// Substitutes for words of the language: as the name of a body, of a joint or equation, and of a feature or value.
const SUBSTITUTES: &[(&str, [&str; 3])] = &[
    // ---- units and constants
    ("s", ["slide", "guide", "stroke"]),
    ("m", ["arm", "mount", "module"]),
    ("mm", ["arm", "mount", "span"]),
    ("cm", ["arm", "mount", "span"]),
    ("in", ["input_arm", "entry", "entry"]),
    ("ft", ["foot", "foot_pin", "height"]),
    ("ms", ["slide", "guide", "delay"]),
    ("deg", ["arm", "hinge", "tilt"]),
    ("rad", ["wheel", "bearing", "r"]),
    ("rev", ["wheel", "bearing", "turns"]),
    ("rpm", ["rotor", "spindle", "speed"]),
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
pub fn another_name(word: &str, kind: KindOfName, is_free: impl Fn(&str) -> bool) -> Option<&'static str> {
    let substitute = SUBSTITUTES.iter().find(|(other, _)| *other == word).and_then(|(_, names)| match kind {
        KindOfName::Body => Some(names[0]),
        KindOfName::Joint | KindOfName::Equation => Some(names[1]),
        KindOfName::Feature | KindOfName::Value | KindOfName::Function => Some(names[2]),
        KindOfName::Argument => Some("u"),
        // the substitutes for values are mostly lengths
        KindOfName::Mass | KindOfName::Time => None,
    });
    substitute
        .into_iter()
        .chain(kind.names().iter().copied())
        .find(|name| !is_taken(name) && !is_called(name) && is_free(name))
}

#[cfg(test)]
mod tests {
    use super::{KindOfName, SUBSTITUTES, another_name};
    use crate::vocabulary::{Keyword, Unit, is_called, is_taken};

    #[test]
    fn every_proposed_name_can_be_declared() {
        let general = ["body", "joint", "driver", "point", "param", "fn"].map(KindOfName::behind);
        let values = [KindOfName::Mass, KindOfName::Time];
        let kinds = general.iter().chain(&values).flat_map(|kind| kind.names());
        let names = SUBSTITUTES.iter().flat_map(|(_, names)| names).chain(kinds);
        for name in names {
            let is_word = is_taken(name) || is_called(name) || Unit::named(name).is_some();
            assert!(!is_word && Keyword::named(name).is_none(), "`{name}` is a word of the language");
        }
    }

    #[test]
    fn a_name_is_proposed_that_the_text_does_not_use() {
        let kind = KindOfName::behind("body");
        assert_eq!(another_name("s", kind, |_| true), Some("slide"));
        assert_eq!(another_name("s", kind, |name| name != "slide"), Some("arm"));
        assert_eq!(another_name("cosh", kind, |name| !["arm", "slide"].contains(&name)), Some("link"));
        assert_eq!(another_name("s", kind, |_| false), None);
        assert_eq!(another_name("m", KindOfName::Mass, |_| true), Some("m1"));
    }
}
