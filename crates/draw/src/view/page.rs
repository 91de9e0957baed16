//! Self-contained HTML page of a motion: its data, and the page built in `page/` around them.
//!
//! The data are JSON in a versioned format ([`FORMAT`]) that `page/src/data/format.ts` describes. Lengths are metres, as everywhere here.
//! The same input gives the same bytes, and no part of a text is interpreted as HTML.

mod base64;
mod json;
mod still;
mod table_compression;
mod utf16_offsets;

use super::text::{escape, first_sentence};
use crate::scene::{Motion, Scene};
use mechc_text::diag::Diagnostic;
use mechc_text::source::{FileId, Source};

/// Version of the data format.
pub const FORMAT: u32 = 1;

/// Size limit of a page (bytes); a larger one leaves rows out.
pub const LONGEST: usize = 20_000_000;
/// Limit of attempts to leave rows out.
const MOST_ATTEMPTS: usize = 6;

/// Placeholder of the page's size in the data. Quotes in texts are escaped, so nothing else matches it.
const NO_SIZE: &str = "\"bytes\":0";
/// Width of the size's number, padded with blanks.
const SIZE_DIGITS: usize = 9;

/// Template of the page; its build is reproducible (`.ci/page`).
const TEMPLATE: &str = include_str!("../../page/page.html");
const SCRIPT: &str = include_str!("../../page/page.js");
const STYLE: &str = include_str!("../../page/page.css");

/// Licence notices of the code in the page.
pub const NOTICES: &str = include_str!("../../page/notices.txt");

/// Contents of a page.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// Texts of the declarations, the mechanism's own first.
    pub texts: Vec<(FileId, &'a Source)>,
    /// Columns of the table, in order; the first is time.
    pub columns: Vec<Column<'a>>,
    /// Varied parameters.
    pub vary: Vec<Vary>,
    /// All variants: the product of all varied values, the last parameter fastest; a single one without varied parameters.
    pub variants: Vec<Variant<'a>>,
}

/// Name and unit of a column or result.
#[derive(Clone, Debug)]
pub struct Column<'a> {
    /// Name.
    pub name: &'a str,
    /// Unit; `1` for a pure number.
    pub unit: &'a str,
    /// Conversion from SI to the unit: a divisor, a factor, and a divisor.
    pub scale: [f64; 3],
    /// Kind of column for the page; empty for a result.
    pub kind: &'static str,
}

/// A parameter with its values.
#[derive(Clone, Debug)]
pub struct Vary {
    /// Name.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// Values in the unit, ascending.
    pub values: Vec<f64>,
    /// Index of the value that the page begins with, the nearest to the file's own value.
    pub nearest: usize,
    /// The file's own value in the unit, if it is not one of `values`.
    pub nominal: Option<f64>,
}

/// A motion of the page.
#[derive(Clone, Debug)]
pub struct Variant<'a> {
    /// Scene.
    pub scene: &'a Scene,
    /// Motion; a still one has no rows in its table.
    pub motion: &'a Motion,
    /// Number of rows of the motion before some were left out.
    pub all_rows: usize,
    /// Results of the whole motion, in SI.
    pub results: Vec<(Column<'a>, Option<f64>)>,
    /// Messages.
    pub messages: Vec<&'a Diagnostic>,
}

impl Page<'_> {
    /// Writes the page as HTML; without a variant to show it is empty.
    #[must_use]
    pub fn written(&self) -> String {
        self.at_most(LONGEST)
    }

    /// Returns the data without the table, and the table's columns, for a page that receives them later.
    #[must_use]
    pub fn data(&self) -> (serde_json::Value, Vec<Vec<f64>>) {
        let columns = self.first().map_or_else(Vec::new, |first| json::table(first, 1, self.columns.len()));
        (json::value(self, 1, json::Tables::Separate), columns)
    }

    /// Returns the scene and the table's columns, for a page that has everything else.
    #[must_use]
    pub fn picture(&self) -> (serde_json::Value, Vec<Vec<f64>>) {
        let texts = utf16_offsets::Texts::new(&self.texts);
        let picture_of =
            |first: &Variant| (json::scene(first.scene, &texts), json::table(first, 1, self.columns.len()));
        self.first().map_or_else(Default::default, picture_of)
    }

    /// Returns the variant that the page begins with.
    fn first(&self) -> Option<&Variant<'_>> {
        let index = self.vary.iter().fold(0, |index, vary| index * vary.values.len() + vary.nearest);
        self.variants.get(index)
    }

    /// Writes the page, and leaves rows out until it has at most `longest` bytes, as far as possible.
    fn at_most(&self, longest: usize) -> String {
        let mut every = 1;
        let mut html = self.write_thinned(every);
        for _ in 0..MOST_ATTEMPTS {
            if html.len() <= longest {
                break;
            }
            // tables are nearly all of the page; thinned ones compress less well
            every = (every + 1).max(every * html.len() / longest);
            html = self.write_thinned(every);
        }
        html
    }

    fn write_thinned(&self, every: usize) -> String {
        let Some(first) = self.first() else { return String::new() };
        let parts = [
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("title", escape(&first.scene.name).into_owned()),
            ("docs", docs(&first.scene.docs)),
            ("style", STYLE.to_owned()),
            ("still", still::still(first.scene, first.motion)),
            ("text", self.texts.first().map_or_else(String::new, |(_, source)| plain_text(&source.text))),
            ("notices", NOTICES.trim_end().to_owned()),
            ("data", json::write(self, every)),
            ("script", SCRIPT.to_owned()),
        ];
        insert_size(&fill(TEMPLATE, &parts))
    }
}

/// Encodes bytes as Base64.
#[must_use]
pub fn base64(bytes: &[u8]) -> String {
    base64::encode(bytes)
}

/// Writes a page without data, which requests them from its server.
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
    fill(TEMPLATE, &parts)
}

/// Replaces the placeholder [`NO_SIZE`] by the size of the page, in a fixed width.
fn insert_size(html: &str) -> String {
    let bytes = html.len() + SIZE_DIGITS - 1;
    html.replacen(NO_SIZE, &format!("\"bytes\":{bytes:>SIZE_DIGITS$}"), 1)
}

/// Replaces the gaps `{{name}}` of a template. Inserted text is not searched for gaps.
fn fill(template: &str, parts: &[(&str, String)]) -> String {
    let mut html = String::with_capacity(template.len() + parts.iter().map(|(_, part)| part.len()).sum::<usize>());
    let mut pieces = template.split("{{");
    html += pieces.next().unwrap_or_default();
    for piece in pieces {
        let (name, rest) = piece.split_once("}}").unwrap_or(("", piece));
        html += parts.iter().find(|(other, _)| *other == name).map_or("", |(_, part)| part);
        html += rest;
    }
    html
}

/// Writes the documentation of a mechanism: its first sentence, and the rest in a fold.
fn docs(lines: &[String]) -> String {
    let text = lines.join("\n");
    let (first, rest) = first_sentence(&text);
    if first.is_empty() {
        return String::new();
    }
    let first = format!("<p>{}</p>", escape(first));
    if rest.is_empty() {
        return format!("<div class=\"docs\">{first}</div>");
    }
    format!(
        "<div class=\"docs\">{first} <details><summary>more</summary><p class=\"rest\">{}</p></details></div>",
        escape(rest)
    )
}

fn plain_text(text: &str) -> String {
    format!("<pre class=\"plain\">{}</pre>", escape(text))
}

#[cfg(test)]
mod tests {
    use super::{Column, Page, Variant, docs, fill};
    use crate::scene::{Declaration, Motion, Point, Scene};
    use mechc_text::source::{FileId, Source, Sources, Span};
    use serde_json::Value;

    /// A name that tries to break out of its element.
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

    /// Returns the page of a motion, and its data.
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
        let (_, after) = html.split_once("id=\"mechc\">").expect("the data");
        let data = serde_json::from_str(after.split_once("</script>").expect("their end").0).expect("JSON");
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
        assert_eq!(fill("<{{a}}|{{b}}|{{c}}>", &parts), "<{{b}}|x|>");
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
