//! What a name or word is, where the pointer rests on it.

use super::place::{Place, Stretch};
use super::snapshot::Snapshot;
use crate::check::{DeclaredName, Meaning, Symbols};
use crate::stages::Checked;
use crate::vocabulary::Word;

/// What is to be shown of a place.
#[derive(Clone, PartialEq, Debug)]
pub struct Hover {
    /// What is spoken of.
    pub place: Stretch,
    /// Markdown.
    pub text: String,
}

/// What stands at a place.
#[must_use]
pub fn hover(snapshot: &Snapshot, place: &Place) -> Option<Hover> {
    let checked = snapshot.checked(&place.path)?;
    let checked = checked.mechanism_at(place.offset)?;
    let used = checked.symbols().at(checked.file(), place.offset)?;
    let text = match used.meaning {
        Meaning::Word(word) => of_word(word),
        Meaning::Declared(id) => of_declared(checked.symbols().get(id), checked.symbols(), checked),
    };
    Some(Hover { place: Stretch::of(used.span, checked.sources()), text })
}

fn of_word(word: &Word) -> String {
    let forms = word.forms.join("\n");
    format!("```mech\n{forms}\n```\n\n{}", word.meaning)
}

fn of_declared(name: &DeclaredName, symbols: &Symbols, checked: &Checked) -> String {
    let owner = name.owner.map(|owner| format!("of `{}`", symbols.get(owner).name));
    let text = checked.sources().text(name.declaration);
    // of a body its head is enough
    let head = text.split('{').next().unwrap_or(text).trim_end();
    let code = format!("```mech\n{head}\n```");
    owner.map_or(code.clone(), |owner| format!("{code}\n\n{owner}"))
}

#[cfg(test)]
mod tests {
    use super::hover;
    use crate::ide::testing::{FOUR_BAR, at_cursor, shown};

    #[test]
    fn a_name_shows_its_declaration_and_a_word_its_meaning() {
        let of = |from: &str, to: &str| {
            let (snapshot, place) = at_cursor(&FOUR_BAR.replacen(from, to, 1));
            hover(&snapshot, &place).map(|hover| format!("{}\n{}", shown(&snapshot, &hover.place), hover.text))
        };
        insta::assert_snapshot!(of("crank.B", "crank.$0B").expect("a point"), @r"
        main.mech:22
            joint pin:   revolute(crank.B, coupler.B)
                                        ^
        ```mech
        point B = (crank_length, 0)
        ```

        of `crank`
        ");
        insta::assert_snapshot!(of("revolute", "revo$0lute").expect("a joint"), @r"
        main.mech:21
            joint main:  revolute(ground.A, crank.A)
                         ^^^^^^^^
        ```mech
        revolute(P, Q)
        ```

        two points coincide, and the bodies turn about them
        ");
        assert_eq!(of("mechanism four_bar {", "mechanism four_bar {$0"), None);
    }
}
