//! One HTML file that shows a motion and needs nothing else: its data, and around them the page that `page/` builds.
//!
//! The data are JSON, whose form has a number ([`FORMAT`]) and is described in `page/src/data/format.ts`. Lengths are metres there, as they
//! are here. The same input gives the same bytes. Nothing of a text becomes HTML.

mod base64;
mod columns;
mod json;
mod places;
mod still;

use super::{escaped, first_sentence};
use crate::scene::{Motion, Scene};
use mechc_text::diag::Diagnostic;
use mechc_text::source::{FileId, Source};

/// The number of the form of the data.
pub const FORMAT: u32 = 1;

/// The longest page (bytes): of more than that rows are left out.
pub const LONGEST: usize = 20_000_000;
/// Rows are left out of a page that is too long no more often than this.
const MOST_THINNINGS: usize = 6;

/// How the data tell the size of the page before it is known: quotes of texts are escaped there, and so nothing else reads like it.
const NO_SIZE: &str = "\"bytes\":0";
/// The size takes so many letters, some of them blanks.
const SIZE_DIGITS: usize = 9;

/// What the page is built from: the same bytes each time (`.ci/page`).
const TEMPLATE: &str = include_str!("../../page/page.html");
const SCRIPT: &str = include_str!("../../page/page.js");
const STYLE: &str = include_str!("../../page/page.css");

/// What the licences of what the page carries ask to be said.
pub const NOTICES: &str = include_str!("../../page/notices.txt");

/// All that a page is made of.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// The texts that declarations stand in, the mechanism's own first.
    pub texts: Vec<(FileId, &'a Source)>,
    /// The table's columns, in order; the first is time.
    pub columns: Vec<Column<'a>>,
    /// What was varied, if anything.
    pub vary: Vec<Vary>,
    /// Every variant: the product of all that was varied, the last fastest; the only one where nothing was.
    pub variants: Vec<Variant<'a>>,
}

/// How a number is called and printed.
#[derive(Clone, Debug)]
pub struct Column<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its unit; `1` for a pure number.
    pub unit: &'a str,
    /// What SI is divided by, multiplied with and divided by to be in the unit.
    pub scale: [f64; 3],
    /// What a column holds, as the page reads it; nothing for a result.
    pub kind: &'static str,
}

/// A parameter with the values that it was given.
#[derive(Clone, Debug)]
pub struct Vary {
    /// Its name.
    pub name: String,
    /// The unit of its values.
    pub unit: String,
    /// In the unit, rising.
    pub values: Vec<f64>,
    /// Which of them the page begins with: the one nearest to the file's own.
    pub nearest: usize,
    /// The file's own value, in the unit, where it is none of them.
    pub own: Option<f64>,
}

/// One motion.
#[derive(Clone, Debug)]
pub struct Variant<'a> {
    /// What there is to draw.
    pub scene: &'a Scene,
    /// The motion; of a still the table has no rows.
    pub motion: &'a Motion,
    /// How many rows there would be if none had been left out before.
    pub all_rows: usize,
    /// Numbers for the whole motion, in SI.
    pub results: Vec<(Column<'a>, Option<f64>)>,
    /// What there is to say of it.
    pub messages: Vec<&'a Diagnostic>,
}

impl Page<'_> {
    /// The page as HTML; empty where there is no variant to show.
    #[must_use]
    pub fn written(&self) -> String {
        self.at_most(LONGEST)
    }

    /// The data of a page that is told them later: the JSON, in which the table is missing, and the table's columns.
    #[must_use]
    pub fn data(&self) -> (serde_json::Value, Vec<Vec<f64>>) {
        let columns = self.first().map_or_else(Vec::new, |first| json::table(first, 1, self.columns.len()));
        (json::value(self, 1, json::Tables::Beside), columns)
    }

    /// What there is to draw, for a page that has all else; and the table's columns.
    #[must_use]
    pub fn picture(&self) -> (serde_json::Value, Vec<Vec<f64>>) {
        let texts = places::Texts::of(&self.texts);
        let of_first = |first: &Variant| (json::scene(first.scene, &texts), json::table(first, 1, self.columns.len()));
        self.first().map_or_else(Default::default, of_first)
    }

    /// The variant that it begins with.
    fn first(&self) -> Option<&Variant<'_>> {
        let place = self.vary.iter().fold(0, |place, vary| place * vary.values.len() + vary.nearest);
        self.variants.get(place)
    }

    /// Rows are left out until it is no longer than so many bytes, as far as that goes.
    fn at_most(&self, longest: usize) -> String {
        let mut every = 1;
        let mut html = self.with_every(every);
        for _ in 0..MOST_THINNINGS {
            if html.len() <= longest {
                break;
            }
            // tables are nearly all of it; thinned ones are compressed less well
            every = (every + 1).max(every * html.len() / longest);
            html = self.with_every(every);
        }
        html
    }

    fn with_every(&self, every: usize) -> String {
        let Some(first) = self.first() else { return String::new() };
        let parts = [
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("title", escaped(&first.scene.name).into_owned()),
            ("docs", docs(&first.scene.docs)),
            ("style", STYLE.to_owned()),
            ("still", still::still(first.scene, first.motion)),
            ("text", self.texts.first().map_or_else(String::new, |(_, source)| plain(&source.text))),
            ("notices", NOTICES.trim_end().to_owned()),
            ("data", json::written(self, every)),
            ("script", SCRIPT.to_owned()),
        ];
        with_size(&filled(TEMPLATE, &parts))
    }
}

/// Bytes as Base64.
#[must_use]
pub fn base64(bytes: &[u8]) -> String {
    base64::written(bytes)
}

/// A page without data, which asks the server that it comes from.
#[must_use]
pub fn shell() -> String {
    let parts = [
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("title", "mechc".to_owned()),
        ("connect", "; connect-src 'self'".to_owned()),
        ("style", STYLE.to_owned()),
        ("notices", NOTICES.trim_end().to_owned()),
        ("script", SCRIPT.to_owned()),
    ];
    filled(TEMPLATE, &parts)
}

/// A page that knows how large it is: a number as wide as any takes the place of [`NO_SIZE`]'s.
fn with_size(html: &str) -> String {
    let bytes = html.len() + SIZE_DIGITS - 1;
    html.replacen(NO_SIZE, &format!("\"bytes\":{bytes:>SIZE_DIGITS$}"), 1)
}

/// A template with what belongs into its gaps, which are written `{{so}}`; what is put in is not looked at again.
fn filled(template: &str, parts: &[(&str, String)]) -> String {
    let mut html = String::with_capacity(template.len() + parts.iter().map(|(_, part)| part.len()).sum::<usize>());
    let mut pieces = template.split("{{");
    html += pieces.next().unwrap_or_default();
    for piece in pieces {
        let (name, rest) = piece.split_once("}}").unwrap_or(("", piece));
        html += parts.iter().find(|(known, _)| *known == name).map_or("", |(_, part)| part);
        html += rest;
    }
    html
}

/// The text of the `///` lines: its first sentence, and the rest for who asks for it.
fn docs(lines: &[String]) -> String {
    let text = lines.join("\n");
    let (first, rest) = first_sentence(&text);
    if first.is_empty() {
        return String::new();
    }
    let first = format!("<p>{}</p>", escaped(first));
    if rest.is_empty() {
        return format!("<div class=\"docs\">{first}</div>");
    }
    format!(
        "<div class=\"docs\">{first} <details><summary>more</summary><p class=\"rest\">{}</p></details></div>",
        escaped(rest)
    )
}

fn plain(text: &str) -> String {
    format!("<pre class=\"plain\">{}</pre>", escaped(text))
}

#[cfg(test)]
mod tests {
    use super::{Column, Page, Variant, docs, filled};
    use crate::scene::{Declaration, Motion, Point, Scene};
    use mechc_text::source::{FileId, Source, Sources, Span};
    use serde_json::Value;

    /// A name that would like to be something else.
    const HOSTILE: &str = "</script><script>alert(1)</script><!-- & \" ' \u{5d0}\u{1f600}";

    fn scene(file: FileId) -> Scene {
        let declared =
            |name: &str, kind, start, end| Declaration { name: name.to_owned(), kind, span: Span { file, start, end } };
        Scene {
            name: HOSTILE.to_owned(),
            docs: vec![HOSTILE.to_owned()],
            declarations: vec![
                declared("ground", "ground", 0, 0),
                declared("b", "body", 0, 4),
                declared("b.<P>", "point", 0, 4),
            ],
            frames: vec![0, 1],
            points: vec![Point { declaration: 2, name: "b.<P>".to_owned(), frame: 1, at: [0.1, -0.0], is_pin: true }],
            pins: Vec::new(),
            nodes: Vec::new(),
            traces: Vec::new(),
            profiles: Vec::new(),
            contacts: Vec::new(),
            forces: Vec::new(),
            torques: Vec::new(),
            pitch_lines: Vec::new(),
            unit: 0.01,
            extent: [[0.0; 2], [1.0; 2]],
            named: vec![1],
            remarks: Vec::new(),
        }
    }

    fn motion(rows: u32) -> Motion {
        let columns = ["t", "b.x", "b.y", "b.phi"].map(str::to_owned);
        let row =
            |k: u32| vec![f64::from(k) * 0.1, f64::from(k.wrapping_mul(2_654_435_761)), f64::NAN, f64::from(k) / 3.0];
        Motion::of_rows(&[[[1, 2, 3], [4, 5, 6], [7, 8, 9]]], &columns, (0..rows).map(row).collect(), vec![0.25])
    }

    /// The page of a motion, and the data in it.
    fn written(rows: u32, longest: usize) -> (String, Value) {
        let mut sources = Sources::default();
        let file = sources.add("/somewhere/secret/b.mech", format!("body {HOSTILE}"));
        let (scene, motion) = (scene(file), motion(rows));
        let source: &Source = sources.get(file);
        let column = |name| Column { name, unit: "m", scale: [1.0, 1000.0, 1.0], kind: "body" };
        let variant = Variant {
            scene: &scene,
            motion: &motion,
            all_rows: rows as usize,
            results: vec![(column("r"), None)],
            messages: vec![],
        };
        let columns = ["t", "b.x", "b.y", "b.phi"].map(column).to_vec();
        let page = Page { texts: vec![(file, source)], columns, vary: vec![], variants: vec![variant] };
        let html = page.at_most(longest);
        assert_eq!(html, page.at_most(longest), "the same input gives the same bytes");
        let (_, behind) = html.split_once("id=\"mechc\">").expect("the data");
        let data = serde_json::from_str(behind.split_once("</script>").expect("their end").0).expect("JSON");
        (html, data)
    }

    #[test]
    fn nothing_of_a_text_becomes_html() {
        let (html, data) = written(5, usize::MAX);
        assert_eq!(html.matches("<script").count(), 2, "the data, and the script");
        assert!(!html.contains("alert(1)</script"));
        assert!(!html.contains("secret"), "where a file lies is in the page");
        assert_eq!(data["name"], HOSTILE);
        assert_eq!(data["texts"][0]["name"], "b.mech");
        assert_eq!(data["scene"]["declarations"][2][0], "b.<P>");
        assert_eq!(data["variants"][0]["edges"][0], 0.25);
        assert_eq!(data["columns"][0]["scale"][1], 1000.0);
        assert_eq!(data["columns"][0]["kind"], "body");
        assert_eq!(data["bytes"], html.len());
        assert_eq!(data["variants"][0]["named"], serde_json::json!([1]));
        assert_eq!(data["scene"]["named"], Value::Null, "variants share a scene whatever is wrong with them");
        assert!(
            html.contains(env!("CARGO_PKG_VERSION")) && html.contains("uPlot") && html.contains("default-src 'none'")
        );
    }

    #[test]
    fn a_page_that_is_too_long_has_fewer_rows_and_says_so() {
        let (whole, data) = written(2000, usize::MAX);
        assert_eq!(data["variants"][0]["rows"], 2000);
        assert_eq!(data["thinned"], Value::Null);
        let longest = whole.len() - 3000;
        let (html, data) = written(2000, longest);
        assert!(html.len() <= longest, "{} bytes", html.len());
        let rows = data["variants"][0]["rows"].as_u64().expect("a number");
        assert!(rows < 2000);
        assert_eq!(data["thinned"], format!("This page has {rows} of the 2000 rows of the motion, evenly spread."));
    }

    #[test]
    fn gaps_are_filled_once() {
        let parts = [("a", "{{b}}".to_owned()), ("b", "x".to_owned())];
        assert_eq!(filled("<{{a}}|{{b}}|{{c}}>", &parts), "<{{b}}|x|>");
    }

    #[test]
    fn the_first_sentence_stands_alone() {
        let lines = ["A <b> crank.".to_owned(), "It turns.".to_owned()];
        let html = docs(&lines);
        assert!(html.starts_with("<div class=\"docs\"><p>A &lt;b&gt; crank.</p> <details>"), "{html}");
        assert!(html.contains("<p class=\"rest\">It turns.</p>"), "{html}");
        assert_eq!(docs(&[]), "");
    }
}
