//! What a page asks, as data: the bodies of its requests, read.

use serde_json::Value;

/// More settings than this no page sends.
const MOST: usize = 4096;
/// Nor longer names and formulas (bytes).
const LONGEST: usize = 1000;

/// A motion, or where a mechanism stands while its inputs are moved by hand.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Question {
    /// Which page asks: what it asks next takes the place of what it is waiting for.
    pub page: String,
    /// Params with what they are set to, as `--set` takes them.
    pub set: Vec<(String, String)>,
    /// The time (s) whose picture alone is wanted.
    pub at: Option<f64>,
    /// Whether time stands still.
    pub jog: Option<Jogged>,
}

/// Inputs that are moved by hand.
#[derive(Clone, PartialEq, Debug)]
pub struct Jogged {
    /// When time stands still (s).
    pub time: f64,
    /// What the inputs are (SI); the others are what they are then.
    pub inputs: Vec<(String, f64)>,
}

/// Values that are to stand in the file.
#[derive(Clone, PartialEq, Debug)]
pub struct Write {
    /// The version of the texts that the page shows.
    pub version: u64,
    /// What is to be written, each thing in its place.
    pub changes: Vec<Change>,
    /// Whether formulas may go.
    pub sure: bool,
}

/// A value that is to stand in the place of another one.
#[derive(Clone, PartialEq, Debug)]
pub struct Change {
    /// The param, or the coordinate of one that is a point.
    pub name: String,
    /// What stands there, as far as the page knows.
    pub old: String,
    /// What is to stand there, in the unit that it has on the page.
    pub value: f64,
}

/// Why a body is none of these; said to nobody but who tries by hand.
pub type Wrong = &'static str;

impl Question {
    /// Reads the body of a request.
    ///
    /// # Errors
    /// It is none.
    pub fn of(body: &[u8]) -> Result<Question, Wrong> {
        let body = object(body)?;
        let page = text(&body["page"])?.to_owned();
        let set = list(&body["set"])?.iter().map(|one| Ok((text(&one[0])?.to_owned(), text(&one[1])?.to_owned())));
        let jog = match &body["jog"] {
            Value::Null => None,
            jog => {
                let inputs = list(&jog["inputs"])?.iter();
                let inputs = inputs.map(|one| Ok((text(&one[0])?.to_owned(), number(&one[1])?)));
                Some(Jogged { time: number(&jog["time"])?, inputs: inputs.collect::<Result<_, Wrong>>()? })
            }
        };
        let at = match &body["at"] {
            Value::Null => None,
            at => Some(number(at)?),
        };
        Ok(Question { page, set: set.collect::<Result<_, Wrong>>()?, at, jog })
    }
}

impl Write {
    /// Reads the body of a request.
    ///
    /// # Errors
    /// It is none.
    pub fn of(body: &[u8]) -> Result<Write, Wrong> {
        let body = object(body)?;
        let changes = list(&body["changes"])?.iter().map(|one| {
            let (name, old) = (text(&one["name"])?.to_owned(), text(&one["old"])?.to_owned());
            Ok(Change { name, old, value: number(&one["value"])? })
        });
        let changes = changes.collect::<Result<Vec<Change>, Wrong>>()?;
        if changes.is_empty() {
            return Err("there is nothing to write");
        }
        let version = body["version"].as_u64().ok_or("a version is a number")?;
        Ok(Write { version, changes, sure: body["sure"].as_bool().unwrap_or(false) })
    }
}

/// Reads the place that a page shows in the editor (UTF-16).
///
/// # Errors
/// There is none.
pub(super) fn place_of(body: &[u8]) -> Result<u32, Wrong> {
    let at = object(body)?["at"].as_u64().and_then(|at| u32::try_from(at).ok());
    at.ok_or("a place is a number")
}

fn object(body: &[u8]) -> Result<Value, Wrong> {
    serde_json::from_slice(body).ok().filter(Value::is_object).ok_or("a JSON object is wanted")
}

fn text(value: &Value) -> Result<&str, Wrong> {
    value.as_str().filter(|text| text.len() <= LONGEST).ok_or("a text is wanted, and no long one")
}

fn list(value: &Value) -> Result<&[Value], Wrong> {
    match value {
        Value::Null => Ok(&[]),
        Value::Array(list) if list.len() <= MOST => Ok(list),
        _ => Err("a list is wanted, and no long one"),
    }
}

fn number(value: &Value) -> Result<f64, Wrong> {
    value.as_f64().filter(|value| value.is_finite()).ok_or("a number is wanted")
}

#[cfg(test)]
mod tests {
    use super::{Change, Jogged, Question, Write};

    #[test]
    fn bodies_are_read() {
        let asked = Question::of(br#"{"page":"a","set":[["rod","2 mm"]],"jog":{"time":0.5,"inputs":[["turn",1]]}}"#);
        let jog = Some(Jogged { time: 0.5, inputs: vec![("turn".into(), 1.0)] });
        let set = vec![("rod".to_owned(), "2 mm".to_owned())];
        assert_eq!(asked, Ok(Question { page: "a".into(), set, at: None, jog }));
        let glimpse = Question::of(br#"{"page":"a","at":0.25}"#);
        assert_eq!(glimpse, Ok(Question { page: "a".into(), at: Some(0.25), ..Question::default() }));
        let write =
            Write::of(br#"{"version":3,"changes":[{"name":"rod","old":"2 mm","value":3}]}"#).expect("it is one");
        let rod = Change { name: "rod".into(), old: "2 mm".into(), value: 3.0 };
        assert_eq!(write, Write { version: 3, changes: vec![rod], sure: false });
    }

    #[test]
    fn numbers_are_read_to_the_last_bit() {
        for value in [0.1_f64 + 0.2, 1.817_724_553_117_437_2, 51.248_170_270_318_33, 1.153_729_583_102_345e-5, 5e-324] {
            let asked = Question::of(format!(r#"{{"page":"a","jog":{{"time":{value},"inputs":[]}}}}"#).as_bytes());
            let time = asked.ok().and_then(|asked| asked.jog).map(|jog| jog.time.to_bits());
            assert_eq!(time, Some(value.to_bits()), "{value}");
        }
    }

    #[test]
    fn what_is_none_is_refused() {
        for body in [
            "",
            "[]",
            "{",
            "\"a\"",
            "{}",
            r#"{"page":1}"#,
            r#"{"page":"a","set":1}"#,
            r#"{"page":"a","set":[["rod"]]}"#,
            r#"{"page":"a","set":[[["rod"],"2"]]}"#,
            r#"{"page":"a","at":"0"}"#,
            r#"{"page":"a","jog":{}}"#,
            r#"{"page":"a","jog":{"time":"0"}}"#,
            r#"{"page":"a","jog":{"time":0,"inputs":[["turn",null]]}}"#,
        ] {
            assert!(Question::of(body.as_bytes()).is_err(), "{body}");
        }
        let long = format!(r#"{{"page":"{}"}}"#, "a".repeat(2000));
        assert!(Question::of(long.as_bytes()).is_err());
        for body in [
            r#"{"version":1,"changes":[]}"#,
            r#"{"version":-1,"changes":[{"name":"a","old":"","value":1}]}"#,
            r#"{"changes":[{"name":"a","old":"","value":1}]}"#,
            r#"{"version":1,"changes":[{"name":"a","value":1}]}"#,
            r#"{"version":1,"changes":[{"name":"a","old":"","value":[1]}]}"#,
        ] {
            assert!(Write::of(body.as_bytes()).is_err(), "{body}");
        }
    }
}
