//! Hover text of names, words and codes.

use super::declaration_info::{Subject, declaration_info};
use super::lexical::{is_in_comment, path_at, word_at};
use super::location::{FilePosition, FileRange};
use super::snapshot::{CheckedFile, Snapshot};
use super::word_docs::word_docs;
use mechc_lang::check::{DeclaredName, Meaning, NameKind};
use mechc_pipeline::{Checked, Declaration, Interface};
use mechc_text::diag::Code;
use mechc_text::vocabulary::{Category, words};
use std::ops::Range;

/// The hover text of a word.
#[derive(Clone, PartialEq, Debug)]
pub struct Hover {
    /// The range of the word.
    pub location: FileRange,
    /// The text, in Markdown.
    pub text: String,
}

/// Returns the hover text at a position.
#[must_use]
pub fn hover(snapshot: &Snapshot, position: &FilePosition) -> Option<Hover> {
    let file = snapshot.checked(&position.path)?;
    let parsed = snapshot.parsed(&position.path)?;
    let text = &parsed.sources().get(parsed.file()).text;
    let word = word_at(text, position.offset as usize)?;
    let text_of_word = of_code(&text[word.clone()]).or_else(|| {
        let hovered = HoveredWord { snapshot, position, text, word: &word };
        if is_in_comment(text, word.start) { None } else { hovered.describe(&file) }
    })?;
    let location = FileRange { path: position.path.clone(), start: word.start as u32, end: word.end as u32 };
    Some(Hover { location, text: text_of_word })
}

/// Returns the page of a diagnostic code, which may be in a comment.
fn of_code(word: &str) -> Option<String> {
    Code::named(word).filter(|code| code.as_str() == word).map(|code| code.page().to_owned())
}

/// The word under the pointer.
struct HoveredWord<'a> {
    snapshot: &'a Snapshot,
    position: &'a FilePosition,
    text: &'a str,
    word: &'a Range<usize>,
}

impl HoveredWord<'_> {
    fn describe(&self, file: &CheckedFile) -> Option<String> {
        let checked = file.mechanism_at(self.position.offset).or(file.mechanisms.first())?;
        let symbols = checked.symbols();
        match symbols.at(checked.file(), self.word.start as u32).filter(|used| used.span.end as usize == self.word.end)
        {
            Some(used) => match used.meaning {
                Meaning::Word(word) => Some(word_docs(word)),
                Meaning::Declared(id) => Some(self.declared(checked, symbols.get(id))),
            },
            None => self.in_part(checked).or_else(|| self.mechanism(checked)).or_else(|| self.by_letters(checked)),
        }
    }

    /// Describes a name that the mechanism declares.
    fn declared(&self, checked: &Checked, name: &DeclaredName) -> String {
        let symbols = checked.symbols();
        let owner = name.owner.map(|owner| symbols.get(owner)).filter(|_| name.kind != NameKind::Argument);
        let names: Vec<&str> = owner.map(|owner| owner.name.as_str()).into_iter().chain([name.name.as_str()]).collect();
        let written = self.written();
        let is_written = without_indices(&written) == names.join(".");
        let path = if is_written { written } else { names.join(".") };
        let declaration = match name.kind {
            NameKind::Mechanism => checked.interface(None, &name.name).map(|interface| interface.docs),
            _ => checked.find_declaration(&names).map(|declaration| declaration.docs),
        };
        let code = head(checked.sources().text(name.declaration), name.kind);
        let mut parts =
            declaration.filter(|docs| !docs.is_empty()).map(|docs| docs.join("\n")).into_iter().collect::<Vec<_>>();
        parts.push(code);
        parts.extend(owner.map(|owner| format!("of `{}`", owner.name)));
        parts.extend(declaration_info(
            self.snapshot,
            &self.position.path,
            &Subject { kind: name.kind, path: &path, checked },
        ));
        parts.join("\n\n")
    }

    /// Describes a name in a part: `front.crank.A`.
    fn in_part(&self, checked: &Checked) -> Option<String> {
        let path = path_at(self.text, self.word);
        let names: Vec<&str> = path.iter().map(|(name, _)| name.as_str()).collect();
        let Declaration { kind, span, docs } = checked.find_declaration(&names).filter(|_| names.len() > 1)?;
        let mut parts: Vec<String> = (!docs.is_empty()).then(|| docs.join("\n")).into_iter().collect();
        parts.push(head(checked.sources().text(span), kind));
        parts.push(format!("of `{}`", names[..names.len() - 1].join(".")));
        parts.extend(declaration_info(
            self.snapshot,
            &self.position.path,
            &Subject { kind, path: &self.written(), checked },
        ));
        Some(parts.join("\n\n"))
    }

    /// Describes the mechanism of a part.
    fn mechanism(&self, checked: &Checked) -> Option<String> {
        let path = path_at(self.text, self.word);
        let interface = match path.as_slice() {
            [(name, _)] => checked.interface(None, name),
            [(prefix, _), (name, _)] => checked.interface(Some(prefix), name),
            _ => None,
        };
        interface.map(|interface| of_interface(&interface))
    }

    /// Describes a word in text that cannot be parsed: a name of the mechanism, or a word of the language.
    fn by_letters(&self, checked: &Checked) -> Option<String> {
        let word = &self.text[self.word.clone()];
        let is_alone = path_at(self.text, self.word).len() == 1;
        let name = checked.symbols().iter().find(|(_, name)| name.name == word && name.owner.is_none() && is_alone);
        let of_language = || words().find(|other| other.name == word && other.category != Category::Unit && is_alone);
        name.map(|(_, name)| self.declared(checked, name)).or_else(|| of_language().map(word_docs))
    }

    /// Returns the path as it is written, with the indices that are literal numbers.
    fn written(&self) -> String {
        let number = |numbers: &String| {
            let inside = numbers.trim_start_matches('[').trim_end_matches(']');
            inside.split(',').all(|one| one.trim().parse::<i64>().is_ok()).then(|| numbers.replace(' ', ""))
        };
        let segments = path_at(self.text, self.word);
        let text = segments.iter().map(|(name, numbers)| format!("{name}{}", number(numbers).unwrap_or_default()));
        text.collect::<Vec<String>>().join(".")
    }
}

/// Returns a path without its indices.
fn without_indices(path: &str) -> String {
    let mut depth = 0;
    let is_outside = |c: &char| {
        depth += i32::from(*c == '[');
        let is_outside = depth == 0;
        depth -= i32::from(*c == ']');
        is_outside
    };
    path.chars().filter(is_outside).collect()
}

/// Formats a declaration as it is written, without its block.
fn head(text: &str, kind: NameKind) -> String {
    let has_block = matches!(kind, NameKind::Mechanism | NameKind::Ground | NameKind::Body);
    let head = if has_block { text.split('{').next().unwrap_or(text) } else { text };
    format!("```mech\n{}\n```", head.trim_end())
}

fn of_interface(interface: &Interface) -> String {
    let bindings: Vec<String> =
        interface.bindings.iter().map(|(name, value)| format!("    {name} = {value}")).collect();
    let inside = if bindings.is_empty() { String::new() } else { format!("\n{}", bindings.join(",\n")) };
    let mut parts: Vec<String> = (!interface.docs.is_empty()).then(|| interface.docs.join("\n")).into_iter().collect();
    parts.push(format!("```mech\nmechanism {}{inside}\n```", interface.name));
    parts.join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::hover;
    use crate::testing::{FOUR_BAR, at_cursor, shown};

    fn hover_text(text: &str) -> String {
        let (snapshot, position) = at_cursor(text);
        let hover = hover(&snapshot, &position);
        hover.map_or("nothing".to_owned(), |hover| format!("{}\n\n{}", shown(&snapshot, &hover.location), hover.text))
    }

    fn of(from: &str, to: &str) -> String {
        assert!(FOUR_BAR.contains(from), "{from}");
        hover_text(&FOUR_BAR.replacen(from, to, 1))
    }

    #[test]
    fn a_point_shows_its_place_and_a_body_its_pose() {
        insta::assert_snapshot!(of("crank.B", "crank.$0B"), @r"
        main.mech:22
            joint pin:   revolute(crank.B, coupler.B)
                                        ^

        ```mech
        point B = (crank_length, 0)
        ```

        of `crank`

        At t = 0 s: x = 0.015 m, y = 0.0259808 m in the ground's frame
        ");
        insta::assert_snapshot!(of("body coupler", "/// What the others follow.\n    body cou$0pler"), @r"
        main.mech:13
            body coupler at (15 mm, 26 mm, 30 deg) {
                 ^^^^^^^

        What the others follow.

        ```mech
        body coupler at (15 mm, 26 mm, 30 deg)
        ```

        At t = 0 s: x = 0.015 m, y = 0.0259808 m, phi = 0.422457 rad = 24.205°
        ");
    }

    #[test]
    fn a_joint_shows_its_equations() {
        insta::assert_snapshot!(of("joint pin", "joint p$0in"), @r"
        main.mech:22
            joint pin:   revolute(crank.B, coupler.B)
                  ^^^

        ```mech
        joint pin:   revolute(crank.B, coupler.B)
        ```

        ```text
        Φ1 = crank.x + cos(crank.phi) * crank_length - coupler.x
        Φ2 = crank.y + sin(crank.phi) * crank_length - coupler.y
        ν1 = 0
        ν2 = 0
        γ1 = cos(crank.phi) * crank.phi.d * crank.phi.d * crank_length
        γ2 = sin(crank.phi) * crank.phi.d * crank.phi.d * crank_length
        ```

        At t = 0 s: `crank.B` = (0.015, 0.0259808) m, `coupler.B` = (0.015, 0.0259808) m
        ");
        // a mechanism that is not determined has no position
        let free = FOUR_BAR.replacen("    driver motor: rotation(main) = 60 deg + 90 deg/s * t\n", "", 1);
        insta::assert_snapshot!(hover_text(&free.replacen("joint knee", "joint kn$0ee", 1)), @r"
        main.mech:23
            joint knee:  revolute(coupler.C, rocker.C)
                  ^^^^

        ```mech
        joint knee:  revolute(coupler.C, rocker.C)
        ```

        ```text
        Φ1 = coupler.x + 0.08 * cos(coupler.phi) - (0.06 * cos(rocker.phi) + rocker.x)
        Φ2 = coupler.y + 0.08 * sin(coupler.phi) - (0.06 * sin(rocker.phi) + rocker.y)
        ν1 = 0
        ν2 = 0
        γ1 = -(-0.08 * cos(coupler.phi) * coupler.phi.d * coupler.phi.d + 0.06 * cos(rocker.phi) * rocker.phi.d * rocker.phi.d)
        γ2 = -(-0.08 * sin(coupler.phi) * coupler.phi.d * coupler.phi.d + 0.06 * sin(rocker.phi) * rocker.phi.d * rocker.phi.d)
        ```
        ");
        insta::assert_snapshot!(of("driver motor", "driver mo$0tor"), @r"
        main.mech:25
            driver motor: rotation(main) = 60 deg + 90 deg/s * t
                   ^^^^^

        ```mech
        driver motor: rotation(main) = 60 deg + 90 deg/s * t
        ```

        ```text
        Φ = crank.phi - (1.5707963267948966 * t + 1.0471975511965976)
        ν = 1.5707963267948966
        γ = 0
        ```
        ");
    }

    #[test]
    fn values_are_those_of_the_start() {
        let with = |more: &str| hover_text(&FOUR_BAR.replacen("    analysis", &format!("    {more}\n    analysis"), 1));
        insta::assert_snapshot!(of("param crank", "param cra$0nk"), @r"
        main.mech:2
            param crank_length = 30 mm
                  ^^^^^^^^^^^^

        ```mech
        param crank_length = 30 mm
        ```

        = 0.03 m = 30 mm, a length
        ");
        insta::assert_snapshot!(with("measure speed$0y = der(angle(rocker)) in deg/s"), @r"
        main.mech:27
            measure speedy = der(angle(rocker)) in deg/s
                    ^^^^^^

        ```mech
        measure speedy = der(angle(rocker)) in deg/s
        ```

        At t = 0 s: 26.9732 deg/s, an angular velocity (rad/s)
        ");
        insta::assert_snapshot!(with("trace pa$0th = coupler.C in mm"), @r"
        main.mech:27
            trace path = coupler.C in mm
                  ^^^^

        ```mech
        trace path = coupler.C in mm
        ```

        At t = 0 s: x = 87.9668 mm, a length

        At t = 0 s: y = 58.781 mm, a length
        ");
        insta::assert_snapshot!(with("input tu$0rn = 30 deg + 1 rad/s * t"), @r"
        main.mech:27
            input turn = 30 deg + 1 rad/s * t
                  ^^^^

        ```mech
        input turn = 30 deg + 1 rad/s * t
        ```

        At t = 0 s: 0.523599 rad, an angle
        ");
        insta::assert_snapshot!(with("fn swi$0ng(u) = crank_length * sin(u)^2"), @r"
        main.mech:27
            fn swing(u) = crank_length * sin(u)^2
               ^^^^^

        ```mech
        fn swing(u) = crank_length * sin(u)^2
        ```

        With its derivatives:

        ```text
        swing' = 2 * crank_length * sin(u) * cos(u)
        swing'' = 2 * crank_length * (cos(u)^2 - sin(u)^2)
        ```
        ");
        insta::assert_snapshot!(with("result most$0 = max(x(coupler.C)) in mm"), @r"
        main.mech:27
            result most = max(x(coupler.C)) in mm
                   ^^^^

        ```mech
        result most = max(x(coupler.C)) in mm
        ```
        ");
    }

    #[test]
    fn words_show_their_documentation() {
        insta::assert_snapshot!(of("revolute", "revo$0lute"), @r"
        main.mech:21
            joint main:  revolute(ground.A, crank.A)
                         ^^^^^^^^

        ```mech
        revolute(P, Q)
        ```

        two points coincide, and the bodies turn about them

        2 equations

        `Φ = r_i^P − r_j^Q`
        ");
        insta::assert_snapshot!(of("30 mm", "30 m$0m"), @r"
        main.mech:2
            param crank_length = 30 mm
                                    ^^

        ```mech
        50 mm
        ```

        the millimetre

        `1 mm = 0.001 m`
        ");
        insta::assert_snapshot!(of("60 deg + 90", "si$0n(60 deg) + 90"), @r"
        main.mech:25
            driver motor: rotation(main) = sin(60 deg) + 90 deg/s * t
                                           ^^^

        ```mech
        sin(a)
        ```

        the sine of an angle

        The angle is in radians, or has a unit of its own: `30 deg`. Takes and gives a pure number.

        With its derivatives:

        ```mech
        C   = sin(t)
        C'  = cos(t)
        C'' = -sin(t)
        ```
        ");
        insta::assert_snapshot!(of("driver motor", "dri$0ver motor"), @r"
        main.mech:25
            driver motor: rotation(main) = 60 deg + 90 deg/s * t
            ^^^^^^

        ```mech
        driver NAME: FORMULA = FORMULA
        ```

        an equation that holds time: what a motor or actuator prescribes

        Between kinematic quantities on one side, mostly, and a formula of `t` on the other. Each takes one degree of freedom.
        ");
        assert!(of("    driver", "    // E05$002 here\n    driver").contains("# "), "the page of a code");
        assert_eq!(of("    driver", "    // the cra$0nk\n    driver"), "nothing");
        assert_eq!(of("four_bar {", "four_bar {$0"), "nothing");
    }

    #[test]
    fn names_in_parts_and_copies_are_described() {
        let text = "\
/// Swings.
mechanism lever {
    param reach = 80 mm
    input turn = 30 deg
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) point tip = (reach, 0) }
    joint pivot: revolute(ground.O, arm.O)
    driver motor: rotation(pivot) = turn
}
mechanism two {
    part front: lever()
    part back[k in 0..2]: lever(reach = 60 mm, turn = angle(front.arm)) at (100 mm * (k + 1), 0, 0)
    measure a = x(front.arm.tip)
    measure b = x(back[1].arm.tip)
}
";
        let at = |from: &str, to: &str| hover_text(&text.replacen(from, to, 1));
        insta::assert_snapshot!(at("front.arm.tip", "front.arm.ti$0p"), @r"
        main.mech:13
            measure a = x(front.arm.tip)
                                    ^^^

        ```mech
        point tip = (reach, 0)
        ```

        of `front.arm`

        At t = 0 s: x = 0.069282 m, y = 0.04 m in the ground's frame
        ");
        insta::assert_snapshot!(at("back[1].arm.tip", "back[1].ar$0m.tip"), @r"
        main.mech:14
            measure b = x(back[1].arm.tip)
                                  ^^^

        ```mech
        body arm
        ```

        of `back`

        At t = 0 s: x = 0.2 m, y = 0 m, phi = 0.523599 rad = 30°
        ");
        // the bound value of a param, and its default
        assert!(at("x(back[1].arm.tip)", "x(back[1].arm.tip) + back[1].rea$0ch").ends_with("= 0.06 m, a length"));
        assert!(at("x(front.arm.tip)", "x(front.arm.tip) + front.rea$0ch").ends_with("= 0.08 m, a length"));
        // the mechanism of a part has a position by itself
        let tip = at("point tip", "point ti$0p");
        assert!(tip.ends_with("At t = 0 s: x = 0.069282 m, y = 0.04 m in the ground's frame"), "{tip}");
        assert!(at("joint pivot", "joint piv$0ot").contains("At t = 0 s: `ground.O` = (0, 0) m"));
        insta::assert_snapshot!(at("front: lever", "front: le$0ver"), @r"
        main.mech:11
            part front: lever()
                        ^^^^^

        Swings.

        ```mech
        mechanism lever
            reach = 80 mm,
            turn = 30 deg
        ```
        ");
        insta::assert_snapshot!(at("part front", "part fro$0nt"), @r"
        main.mech:11
            part front: lever()
                 ^^^^^

        ```mech
        part front: lever()
        ```
        ");
    }

    #[test]
    fn a_broken_text_has_hovers_too() {
        insta::assert_snapshot!(of("joint pin:   revolute(crank.B, coupler.B)", "joint pin:   revolute(cra$0nk."), @r"
        main.mech:22
            joint pin:   revolute(crank.
                                  ^^^^^

        ```mech
        body crank at (0, 0, 60 deg)
        ```
        ");
        assert!(of("joint pin:   revolute(", "joint pin   revol$0ute(").contains("revolute(P, Q)"));
    }
}
