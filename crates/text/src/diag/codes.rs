//! Catalogue of diagnostic codes by area. The page of each code is `explain/CODE.md`.

use super::Severity;

macro_rules! catalogue {
    ($($area:literal { $($code:ident $severity:ident $title:literal)* })*) => {
        /// A stable code; the meaning of a number never changes.
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        pub enum Code {
            $($(#[doc = $title] $code,)*)*
        }

        impl Code {
            /// All codes in order.
            pub const ALL: &'static [Code] = &[$($(Code::$code),*),*];

            /// Returns the code as printed: `E0201`.
            #[must_use]
            pub fn as_str(self) -> &'static str {
                match self { $($(Code::$code => stringify!($code)),*),* }
            }

            /// Returns the severity.
            #[must_use]
            pub fn severity(self) -> Severity {
                match self { $($(Code::$code => Severity::$severity),*),* }
            }

            /// Returns the meaning in one line.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self { $($(Code::$code => $title),*),* }
            }

            /// Returns the area of the catalogue: `names`.
            #[must_use]
            pub fn area(self) -> &'static str {
                match self { $($(Code::$code => $area),*),* }
            }

            /// Returns the page in Markdown: the meaning, a faulty example, the reason, and the corrected example.
            #[must_use]
            pub fn page(self) -> &'static str {
                match self {
                    $($(Code::$code => include_str!(concat!("explain/", stringify!($code), ".md"))),*),*
                }
            }
        }
    };
}

catalogue! {
    "reading the text" {
        E0101 Error "the text does not follow the grammar"
        E0102 Error "the file is not UTF-8"
        E0103 Error "formulas are nested too deep"
        E0104 Error "the file holds no mechanism"
    }
    "names" {
        E0201 Error "an unknown name"
        E0202 Error "an unknown unit"
        E0203 Error "a name declared twice"
        E0204 Error "a reserved name"
        E0205 Error "a declaration that may stand only once"
        E0206 Error "definitions that go in a circle"
        E0207 Error "an argument that hides a name"
        E0208 Error "a repetition, or one of its copies, that cannot be"
        E0209 Error "a part, or one of its bindings, that cannot be"
        E0210 Error "a factor that is both a name and a unit"
    }
    "kinds and arguments" {
        E0301 Error "a wrong number of arguments"
        E0302 Error "a wrong kind of argument"
        E0303 Error "a joint of a body with itself"
        E0304 Error "a quantity of a joint that does not have it"
        E0305 Error "axes that are not on the joint's bodies"
        E0306 Error "time where only constants may stand"
        E0307 Error "a kinematic quantity where it may not stand"
        E0308 Error "an equation without any kinematic quantity"
        E0309 Error "a number and a condition confused"
        E0310 Error "a derivative where it may not stand"
        E0311 Error "an equation in which no body takes part"
        E0312 Error "a mass or a force where it may not stand"
        E0313 Error "a load on something else than a quantity of positions"
        E0318 Error "points of two frames in one formula"
        E0322 Error "a result or reduction where it may not stand, or something else in its place"
    }
    "dimensions and values" {
        E0401 Error "unlike dimensions"
        E0402 Error "a wrong dimension for its place"
        E0403 Error "an exponent that is not constant"
        E0404 Error "a constant that is not finite"
        E0405 Error "a direction of zero length"
        E0406 Error "a length that is not positive"
        E0407 Error "an analysis step that is not positive"
        E0408 Error "an analysis that ends before its start"
        E0409 Error "a motion whose interval is empty"
        E0410 Error "a formula that is too large"
        E0411 Error "a curve that is a point"
        E0412 Error "gears that are drawn onto each other"
        E0413 Error "a table or samples of too few rows"
        E0414 Error "arguments of a table, or times of samples, that do not rise"
        E0415 Error "a periodic table whose ends differ"
        E0416 Error "a row of a table or of samples that is not all numbers"
        E0417 Error "an argument out of a table's range"
        E0418 Error "a mass or moment of inertia below zero"
        E0419 Error "a load whose work is no energy"
        E0422 Error "a time of a result that is not within the analysis, or a window that ends before it begins"
        E0423 Error "a requirement that cannot be judged"
        W0401 Warning "an angle that was probably meant in degrees"
        W0402 Warning "a length that has lost its unit"
        W0403 Warning "gravity that does not count"
    }
    "degrees of freedom and the start" {
        E0501 Error "an empty mechanism"
        E0502 Error "a mechanism with degrees of freedom left, or too many equations"
        E0503 Error "a part with too many equations beside a part with too few"
        E0504 Error "a start in a singular position"
        E0506 Error "equations that are redundant"
        E0507 Error "equations that conflict"
        E0508 Error "a derivative in a part that is not determined alone"
        E0509 Error "a force in a loop with redundant equations"
        W0501 Warning "gears, racks or belts whose centres are not as far apart as they should be"
        W0502 Warning "redundant equations that are left out"
    }
    "assembly and motion" {
        E0601 Error "a mechanism that cannot be assembled"
        E0602 Error "a lock-up"
        E0603 Error "a bifurcation"
        E0604 Error "a motion that cannot be followed"
        E0605 Error "a formula that is not finite"
        E0606 Error "a distance that is not positive"
        E0607 Error "a contact or mesh that cannot be"
        E0608 Error "an argument beyond its table, or a time beyond its samples, on the way"
        E0609 Error "a motion that jumps"
        E0610 Error "a position that is too near to a singular one"
        E0611 Error "a redundant equation that ceases to hold"
        E0612 Error "a way to the inputs given that ends before"
        E0613 Error "a requirement that does not hold"
        W0601 Warning "an acceleration that jumps"
        W0602 Warning "a bifurcation that was passed"
        W0603 Warning "a measure without a value"
        W0604 Warning "a contact that would have to pull"
        W0605 Warning "a change point that is nearly met"
        N0601 Note "the estimates were far from the assembled start"
        N0604 Note "a result without a value"
        N0605 Note "a result of a part of the analysis, or of few digits"
        N0606 Note "requirements that are not judged"
    }
    "the command line and files" {
        E0701 Error "a file that cannot be read"
        E0702 Error "a file that cannot be written"
        E0703 Error "an unknown parameter or input"
        E0704 Error "a mechanism that has to be named"
        E0705 Error "an analysis without times"
        E0706 Error "a value of the command line that cannot be used"
        E0707 Error "a model file that cannot be translated"
        E0708 Error "a bound param or input that is told from outside"
        W0701 Warning "a curve that is drawn in part"
        N0701 Note "what was not carried over"
        N0702 Note "a name that was changed"
    }
}

impl Code {
    /// Returns the code for a name as a user types it: `E0203`, `e0203`.
    #[must_use]
    pub fn named(name: &str) -> Option<Code> {
        Code::ALL.iter().copied().find(|code| code.as_str().eq_ignore_ascii_case(name))
    }
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}
