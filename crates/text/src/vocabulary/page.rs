//! Pages of `mechc explain`: one for each word, and an overview of each kind of words.

use super::functions::MOTION_NOTES;
use super::joints::NOTATION;
use super::{
    Category, Example, FUNCTIONS, Function, JOINTS, JointSpec, KEYWORDS, Keyword, QUANTITIES, QuantityWord, REDUCTIONS,
    Role, Synonym, UNITS, Unit, Word, topic, words,
};

/// Length limit of lines of prose (characters).
const WIDTH: usize = 100;

/// Names of the overviews.
pub const OVERVIEWS: &[&str] =
    &["functions", "motions", "quantities", "reductions", "joints", "units", "keywords", "constants"];

/// Returns the page of an overview, a topic or a word. A name of several words has all their pages, one after the other.
#[must_use]
pub fn page(name: &str) -> Option<String> {
    let pages = || words().filter(|word| word.name == name).map(word_page).collect::<Vec<String>>();
    overview(name)
        .or_else(|| topic(name).map(str::to_owned))
        .or_else(|| Some(pages()).filter(|pages| !pages.is_empty()).map(|pages| pages.join("\n")))
}

impl Category {
    fn noun(self) -> &'static str {
        match self {
            Category::Keyword => "a keyword",
            Category::Function => "a function",
            Category::Motion => "a motion function",
            Category::Quantity => "a kinematic quantity",
            Category::Reduction => "a reduction, in results",
            Category::Joint => "a joint",
            Category::Unit => "a unit",
            Category::Constant => "a constant",
        }
    }
}

impl Word {
    /// Returns the text of a mechanism that shows the word.
    #[must_use]
    pub fn example(&self) -> String {
        let mut other_mechanism = "";
        let inside = match self.example {
            Example::Whole(inside) => inside.to_owned(),
            Example::Using(other, inside) => {
                other_mechanism = other;
                inside.to_owned()
            }
            Example::Of(other) => return words().find(|word| word.name == other).map_or(String::new(), Word::example),
            Example::Arm(more) => {
                let has_driver = more.lines().any(|line| line.starts_with("driver motor:"));
                let driver = if has_driver { "" } else { "driver motor: rotation(main) = 90 deg/s * t\n" };
                format!(
                    "ground {{\n    point O = (0, 0)\n}}\nbody arm {{\n    point O   = (0, 0)\n    point tip = (100 mm, 0)\n\
                     }}\njoint main: revolute(ground.O, arm.O)\n{driver}{more}"
                )
            }
        };
        let lines: Vec<String> = inside.lines().map(|line| format!("    {line}")).collect();
        format!("mechanism example {{\n{}\n}}\n{other_mechanism}", lines.join("\n"))
    }
}

fn word_page(word: &'static Word) -> String {
    let mut text = format!("# `{}`: {}\n\n", word.name, noun(word));
    for form in word.forms {
        text += &format!("    {form}\n");
    }
    if !word.letters.is_empty() {
        text += &paragraph(&sentence(word.letters));
    }
    text += &paragraph(&sentence(word.meaning));
    for more in details(word) {
        text += &paragraph(&more);
    }
    text += &format!("\n## An example\n\n```mech\n{}```\n", word.example());
    let others: Vec<String> = Synonym::names_for(word.name).map(|name| format!("`{name}`")).collect();
    if !others.is_empty() {
        text += "\n## What others call it\n";
        text += &paragraph(&others.join(", "));
    }
    text
}

fn noun(word: &Word) -> &'static str {
    match Keyword::named(word.name).filter(|_| word.category == Category::Keyword) {
        Some(keyword) if !keyword.is_reserved() => "a word in its place, and a name elsewhere",
        _ => word.category.noun(),
    }
}

/// Returns the paragraphs after the meaning.
fn details(word: &Word) -> Vec<String> {
    let mut details = Vec::new();
    if let Some(joint) = JointSpec::named(word.name).filter(|_| word.category == Category::Joint) {
        details.push(joint.counts() + ".");
        details.push(word.more.to_owned());
        details.push(NOTATION.to_owned());
        return details;
    }
    if let Some(unit) = Unit::named(word.name).filter(|_| word.category == Category::Unit) {
        details.push(format!("`1 {}` is `{}` in SI.", word.name, in_si(unit)));
        details.push(
            "A name of the mechanism that is called so wins over it, except behind a number, behind `in` and in the units of a table's columns. Where both could be \
             meant, as in `2 rad/s` beside `param s`, `check` asks which."
                .to_owned(),
        );
    }
    if !word.more.is_empty() {
        details.push(word.more.to_owned());
    }
    if word.category == Category::Function && Function::named(word.name).is_some_and(|function| function.gives_way) {
        details.push("A function or table of the file that is called so hides it.".to_owned());
    }
    let quantity = QuantityWord::named(word.name).filter(|_| word.category == Category::Quantity);
    if let Some(quantity) = quantity.filter(|quantity| quantity.gives_way()) {
        let places = if quantity.is_force() { "measures and results" } else { "measures, traces and results" };
        details.push(format!(
            "It stands in {places} alone. A `fn` or `table` of the mechanism that is called so is meant where it is called."
        ));
    }
    if Function::named(word.name).is_some_and(|function| function.group == super::Group::Motion) {
        details.push(MOTION_NOTES.to_owned());
    }
    details
}

/// Returns the value of one unit in SI: `0.001 m`.
fn in_si(unit: &Unit) -> String {
    let value = unit.to_si(1.0, 1);
    match unit.dimension.unit().as_str() {
        "1" => value.to_string(),
        "1/s" => format!("{value}/s"),
        si => format!("{value} {si}"),
    }
}

// ---- overviews

fn overview(name: &str) -> Option<String> {
    let words_of = |category: Category| words().filter(move |word| word.category == category).collect::<Vec<_>>();
    Some(match name {
        "functions" => {
            let functions: Vec<&Word> = FUNCTIONS.iter().filter(|f| !f.is_motion()).map(|f| &f.word).collect();
            let intro = "Called with numbers in any formula; `polar`, `mid`, `length` and `direction` are of points; `der` in measures, results and loads. Motion functions have a page of their own, \
                         `mechc explain motions`; `fn` declares more.";
            list("Functions", intro, &functions)
        }
        "motions" => list("Motion functions", MOTION_NOTES, &words_of(Category::Motion)),
        "quantities" => {
            let quantities: Vec<&Word> = QUANTITIES.iter().map(|quantity| &quantity.word).collect();
            let intro = "Numbers that depend on where the bodies are. An equation between them is a `constraint`, one with time a \
                         `driver`, and a formula of them a `measure`.";
            list("Kinematic quantities", intro, &quantities)
        }
        "reductions" => {
            let reductions: Vec<&Word> = REDUCTIONS.iter().map(|reduction| &reduction.word).collect();
            let intro = "What a `result` asks of a formula over the whole analysis; they stand in results alone. All but `at` take a \
                         window too: `max(e, from A to B)`, `max(e, from A)`, `max(e, to B)`. But for `max` and `min`, a `fn` or \
                         `table` of the mechanism that is called so is meant where it is called.";
            list("Reductions", intro, &reductions)
        }
        "joints" => {
            let joints: Vec<&Word> = JOINTS.iter().map(|joint| &joint.word).collect();
            let intro = "Each joins two bodies, or a body and the ground, by features of theirs, and brings equations. Beyond these, \
                         any equation between kinematic quantities is a `constraint`.";
            list("Joints", intro, &joints)
        }
        "units" => units(),
        "keywords" => keywords(),
        "constants" => list("Constants", "Names that are always there.", &words_of(Category::Constant)),
        _ => return None,
    })
}

fn list(title: &str, intro: &str, words: &[&Word]) -> String {
    let rows: Vec<[String; 2]> = words
        .iter()
        .map(|word| [word.forms.first().copied().unwrap_or(word.name).to_owned(), word.meaning.to_owned()])
        .collect();
    format!("# {title}\n{}\n{}", paragraph(intro), columns(&rows))
}

fn units() -> String {
    let intro = "A unit follows a literal number, with its power if it has one: `50 mm`, `50 mm^2`. Elsewhere it is a constant: \
                 `9.81 m/s^2`. Inside, all is in m, rad and s, and so are the tables of results, but for measures and traces with \
                 another unit behind `in`: units with powers, joined by `*` and `/`. Angles are pure numbers.";
    let rows: Vec<[String; 2]> = UNITS
        .iter()
        .map(|unit| [unit.word.name.to_owned(), format!("{:24}  {}", in_si(unit), unit.word.meaning)])
        .collect();
    format!("# Units\n{}\n{}", paragraph(intro), columns(&rows))
}

fn keywords() -> String {
    let parts: [(&str, &[Role]); 4] = [
        ("Declarations", &[Role::Declaration, Role::Opener]),
        ("In a body or the ground", &[Role::Feature, Role::FeatureOpener]),
        ("In formulas", &[Role::Formula]),
        ("Words in their places, and names elsewhere", &[Role::Opener, Role::Separator, Role::Place, Role::Side]),
    ];
    let mut text = "# Keywords\n".to_owned();
    for (title, roles) in parts {
        let rows: Vec<[String; 2]> = KEYWORDS
            .iter()
            .filter(|keyword| roles.contains(&keyword.role))
            .map(|keyword| [keyword.word.name.to_owned(), keyword.word.meaning.to_owned()])
            .collect();
        text += &format!("\n{title}:\n\n{}", columns(&rows));
    }
    text
}

/// Formats two columns, indented as code.
fn columns(rows: &[[String; 2]]) -> String {
    let width = rows.iter().map(|[first, _]| first.chars().count()).max().unwrap_or(0);
    rows.iter().fold(String::new(), |text, [first, second]| {
        let gap = " ".repeat(width - first.chars().count());
        text + &format!("    {first}{gap}  {second}\n")
    })
}

// ---- prose

/// Adds a capital letter and a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    // a single letter is a name
    let is_name = text.split(' ').next().is_some_and(|word| word.chars().count() == 1 && word != "a");
    let first = letters.next().map(|c| if is_name { c.to_string() } else { c.to_uppercase().collect() });
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}

/// Formats a paragraph after a blank line, in lines of limited length that do not break code.
fn paragraph(text: &str) -> String {
    let mut lines = vec![String::new()];
    let mut in_code = false;
    let mut piece = String::new();
    let mut pieces = Vec::new();
    for c in text.chars() {
        in_code ^= c == '`';
        if c == ' ' && !in_code {
            pieces.push(std::mem::take(&mut piece));
        } else {
            piece.push(c);
        }
    }
    pieces.push(piece);
    for piece in pieces {
        let Some(line) = lines.last_mut() else { break };
        if line.is_empty() {
            *line = piece;
        } else if line.chars().count() + 1 + piece.chars().count() <= WIDTH {
            *line += " ";
            *line += &piece;
        } else {
            lines.push(piece);
        }
    }
    format!("\n{}\n", lines.join("\n"))
}
