//! The bodies of a page's requests, parsed into data.

use serde_json::Value;

/// The maximum length of a list in a request.
const MAX_ITEMS: usize = 4096;
/// The maximum length of a name or formula (bytes).
const MAX_TEXT: usize = 1000;

/// A request for a motion, for a preview at one time, or for the position after inputs are moved by hand.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct MotionRequest {
    /// The page that sends the request; its next request supersedes the one that it is waiting for.
    pub page: String,
    /// Params and their values, as `--set` takes them.
    pub set: Vec<(String, String)>,
    /// The time (s) of a preview; `None` requests the whole motion.
    pub at: Option<f64>,
    /// Inputs moved by hand while time stands still.
    pub manual: Option<ManualInputs>,
}

/// Values of inputs that are moved by hand.
#[derive(Clone, PartialEq, Debug)]
pub struct ManualInputs {
    /// The time (s) at which the mechanism is held.
    pub time: f64,
    /// Inputs and their values (SI); other inputs keep their values at `time`.
    pub inputs: Vec<(String, f64)>,
}

/// A request to write values into the file.
#[derive(Clone, PartialEq, Debug)]
pub struct WriteRequest {
    /// The version of the texts that the page shows.
    pub version: u64,
    /// The values to write.
    pub changes: Vec<ValueChange>,
    /// True if the user has confirmed that formulas and shared values may be replaced.
    pub is_confirmed: bool,
}

/// A new value for a param.
#[derive(Clone, PartialEq, Debug)]
pub struct ValueChange {
    /// The param, or a coordinate of a param that is a point.
    pub name: String,
    /// The text of the current value, as far as the page knows.
    pub old: String,
    /// The new value, in the unit that the page shows.
    pub value: f64,
}

/// The reason why a body is invalid. Pages never send an invalid body, so only requests made by hand see it.
pub type RequestError = &'static str;

impl MotionRequest {
    /// Parses the body of a request.
    ///
    /// # Errors
    /// The body is not valid JSON of this shape.
    pub fn parse(body: &[u8]) -> Result<MotionRequest, RequestError> {
        let body = object(body)?;
        let page = text(&body["page"])?.to_owned();
        let set = list(&body["set"])?.iter().map(|one| Ok((text(&one[0])?.to_owned(), text(&one[1])?.to_owned())));
        let manual = match &body["jog"] {
            Value::Null => None,
            manual => {
                let inputs = list(&manual["inputs"])?.iter();
                let inputs = inputs.map(|one| Ok((text(&one[0])?.to_owned(), number(&one[1])?)));
                Some(ManualInputs {
                    time: number(&manual["time"])?,
                    inputs: inputs.collect::<Result<_, RequestError>>()?,
                })
            }
        };
        let at = match &body["at"] {
            Value::Null => None,
            at => Some(number(at)?),
        };
        Ok(MotionRequest { page, set: set.collect::<Result<_, RequestError>>()?, at, manual })
    }
}

impl WriteRequest {
    /// Parses the body of a request.
    ///
    /// # Errors
    /// The body is not valid JSON of this shape.
    pub fn parse(body: &[u8]) -> Result<WriteRequest, RequestError> {
        let body = object(body)?;
        let changes = list(&body["changes"])?.iter().map(|one| {
            let (name, old) = (text(&one["name"])?.to_owned(), text(&one["old"])?.to_owned());
            Ok(ValueChange { name, old, value: number(&one["value"])? })
        });
        let changes = changes.collect::<Result<Vec<ValueChange>, RequestError>>()?;
        if changes.is_empty() {
            return Err("there is nothing to write");
        }
        let version = body["version"].as_u64().ok_or("a version is a number")?;
        Ok(WriteRequest { version, changes, is_confirmed: body["sure"].as_bool().unwrap_or(false) })
    }
}

/// Parses the position that a page wants to show in the editor (UTF-16).
///
/// # Errors
/// The body has no such position.
pub(super) fn parse_position(body: &[u8]) -> Result<u32, RequestError> {
    let at = object(body)?["at"].as_u64().and_then(|at| u32::try_from(at).ok());
    at.ok_or("a place is a number")
}

fn object(body: &[u8]) -> Result<Value, RequestError> {
    serde_json::from_slice(body).ok().filter(Value::is_object).ok_or("a JSON object is wanted")
}

fn text(value: &Value) -> Result<&str, RequestError> {
    value.as_str().filter(|text| text.len() <= MAX_TEXT).ok_or("a text is wanted, and no long one")
}

fn list(value: &Value) -> Result<&[Value], RequestError> {
    match value {
        Value::Null => Ok(&[]),
        Value::Array(list) if list.len() <= MAX_ITEMS => Ok(list),
        _ => Err("a list is wanted, and no long one"),
    }
}

fn number(value: &Value) -> Result<f64, RequestError> {
    value.as_f64().filter(|value| value.is_finite()).ok_or("a number is wanted")
}

#[cfg(test)]
mod tests {
    use super::{ManualInputs, MotionRequest, ValueChange, WriteRequest};

    #[test]
    fn bodies_are_parsed() {
        let request =
            MotionRequest::parse(br#"{"page":"a","set":[["rod","2 mm"]],"jog":{"time":0.5,"inputs":[["turn",1]]}}"#);
        let manual = Some(ManualInputs { time: 0.5, inputs: vec![("turn".into(), 1.0)] });
        let set = vec![("rod".to_owned(), "2 mm".to_owned())];
        assert_eq!(request, Ok(MotionRequest { page: "a".into(), set, at: None, manual }));
        let preview = MotionRequest::parse(br#"{"page":"a","at":0.25}"#);
        assert_eq!(preview, Ok(MotionRequest { page: "a".into(), at: Some(0.25), ..MotionRequest::default() }));
        let write = WriteRequest::parse(br#"{"version":3,"changes":[{"name":"rod","old":"2 mm","value":3}]}"#)
            .expect("a valid body");
        let rod = ValueChange { name: "rod".into(), old: "2 mm".into(), value: 3.0 };
        assert_eq!(write, WriteRequest { version: 3, changes: vec![rod], is_confirmed: false });
    }

    #[test]
    fn numbers_keep_their_bits() {
        for value in [0.1_f64 + 0.2, 1.817_724_553_117_437_2, 51.248_170_270_318_33, 1.153_729_583_102_345e-5, 5e-324] {
            let request =
                MotionRequest::parse(format!(r#"{{"page":"a","jog":{{"time":{value},"inputs":[]}}}}"#).as_bytes());
            let time = request.ok().and_then(|request| request.manual).map(|manual| manual.time.to_bits());
            assert_eq!(time, Some(value.to_bits()), "{value}");
        }
    }

    #[test]
    fn invalid_bodies_are_refused() {
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
            assert!(MotionRequest::parse(body.as_bytes()).is_err(), "{body}");
        }
        let long = format!(r#"{{"page":"{}"}}"#, "a".repeat(2000));
        assert!(MotionRequest::parse(long.as_bytes()).is_err());
        for body in [
            r#"{"version":1,"changes":[]}"#,
            r#"{"version":-1,"changes":[{"name":"a","old":"","value":1}]}"#,
            r#"{"changes":[{"name":"a","old":"","value":1}]}"#,
            r#"{"version":1,"changes":[{"name":"a","value":1}]}"#,
            r#"{"version":1,"changes":[{"name":"a","old":"","value":[1]}]}"#,
        ] {
            assert!(WriteRequest::parse(body.as_bytes()).is_err(), "{body}");
        }
    }
}
