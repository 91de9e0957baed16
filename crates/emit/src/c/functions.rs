//! Functions that C calls: their arguments, bodies and source file.

use super::names::field;
use super::{Interface, codes};
use crate::names::Case;
use crate::print::{Head, Page};
use crate::text::unit;

/// Type of an argument.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    State,
    StateToWrite,
    Params,
    Inputs,
    InputsToWrite,
    Number,
    Numbers,
    NumbersToWrite,
    WholeToWrite,
    Count,
    Code,
}

/// Type of a result.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Return {
    Code,
    Message,
    Params,
    Count,
}

/// Function of the header.
pub(super) struct Function {
    pub name: &'static str,
    pub docs: &'static str,
    pub arguments: Vec<(&'static str, Type)>,
    pub result: Return,
    /// Body as a Rust expression, of type `Result<(), Status>` if the function returns a code.
    pub body: &'static str,
}

impl Type {
    fn in_rust(self) -> &'static str {
        match self {
            Type::State => "*const Memory",
            Type::StateToWrite => "*mut Memory",
            Type::Params => "*const Params",
            Type::Inputs => "*const Inputs",
            Type::InputsToWrite => "*mut Inputs",
            Type::Number => "f64",
            Type::Numbers => "*const f64",
            Type::NumbersToWrite => "*mut f64",
            Type::WholeToWrite => "*mut i32",
            Type::Count => "usize",
            Type::Code => "i32",
        }
    }

    /// Returns the declaration of an argument in C.
    pub fn in_c(self, name: &str, prefix: &str) -> String {
        match self {
            Type::State => format!("const {prefix}_state *{name}"),
            Type::StateToWrite => format!("{prefix}_state *{name}"),
            Type::Params => format!("const {prefix}_params *{name}"),
            Type::Inputs => format!("const {prefix}_inputs *{name}"),
            Type::InputsToWrite => format!("{prefix}_inputs *{name}"),
            Type::Number => format!("double {name}"),
            Type::Numbers => format!("const double *{name}"),
            Type::NumbersToWrite => format!("double *{name}"),
            Type::WholeToWrite => format!("int32_t *{name}"),
            Type::Count => format!("size_t {name}"),
            Type::Code => format!("int32_t {name}"),
        }
    }
}

impl Return {
    fn in_rust(self) -> &'static str {
        match self {
            Return::Code => "i32",
            Return::Message => "*const c_char",
            Return::Params => "Params",
            Return::Count => "usize",
        }
    }
}

const PARAMS_DEFAULT: &str = "The parameters of the file.";
const MESSAGE: &str = "What a code means, in English; never null.";
const ASSEMBLE: &str =
    "Brings the mechanism to its first time, START_TIME: along the branch of the file's parameters where a short way
leads there, else from the poses that the file draws with these. Whatever the state was, it is a new one; after an
error it is what it was. MOST_WORK_TO_ASSEMBLE evaluations at most.";
const ASSEMBLY: &str = "Which way that went: ASSEMBLY_LED or ASSEMBLY_DRAWN.";
const STEP: &str =
    "Takes a state to a time t (s), forwards or back, on the branch of the motion that it is on, in MOST_STEPS steps
and MOST_WORK evaluations at most. After an error it is bit for bit what it was.";
const STEP_WITHIN: &str =
    "The same in so many steps at most, for those who have a deadline. What these do not reach is answered with
ON_THE_WAY, which is no error: the state is at a time between, and the same call goes on.";
const ROW: &str =
    "All results, in SI, in the order of the columns of `mechc run`; the length of the list is COLUMNS. A measure
without a value is NAN.";
const VALUE: &str = "One of them, by its column.";
const INPUTS_AT: &str = "What the text's formulas say of the inputs at a time t (s).";
const INPUTS: &str = "The inputs of a state: what they were followed to, or what their formulas say at its time.";
const FOLLOW: &str =
    "Leads a state from its inputs to others, along the straight line between them, in MOST_STEPS_TO_FOLLOW steps and
MOST_WORK_TO_FOLLOW evaluations at most. After an error it is bit for bit what it was. A change beyond the largest
is TOO_FAR at once.";
const FOLLOW_WITHIN: &str =
    "The same in so many steps at most. What these do not reach is answered with ON_THE_WAY, which is no error: the
state, its inputs and its row are those of a place between, and the same call goes on.";
const SET_LARGEST_CHANGE: &str =
    "Sets the largest change of each input that a call takes, by their numbers: at first half a turn of an angle, of a
length twice the largest body, and none of what is neither. A state keeps it. The length of the list is INPUTS.";
const MOST_WORK: &str = "How many evaluations step_within and follow_within take at most that may take so many steps.";
const INFLUENCE: &str =
    "The derivatives of the coordinates by each input: that of coordinate c by input i stands at i * COORDINATES + c.
The length of the list is INPUTS * COORDINATES.";
const SENSITIVITY: &str =
    "The derivatives of the coordinates by each parameter, next to a state: that of coordinate c by parameter p
stands at p * COORDINATES + c. The length of the list is PARAMS * COORDINATES.";

const FORCES: &str =
    "What joints exert on their second bodies and what drivers supply at a state, in SI, by the numbers of FORCE; NAN
close to a singular position. The length of the list is FORCES.";

fn function(
    name: &'static str,
    docs: &'static str,
    arguments: &[(&'static str, Type)],
    body: &'static str,
) -> Function {
    Function { name, docs, arguments: arguments.to_vec(), result: Return::Code, body }
}

impl Interface<'_> {
    /// Returns all functions.
    pub(super) fn all(&self) -> Vec<Function> {
        let (state, to_write) = (("state", Type::State), ("state", Type::StateToWrite));
        let (params, inputs) = (("params", Type::Params), ("inputs", Type::Inputs));
        let (t, most, list, length) =
            (("t", Type::Number), ("most", Type::Count), ("list", Type::NumbersToWrite), ("length", Type::Count));
        let mut all = vec![Function {
            result: Return::Message,
            ..function("message", MESSAGE, &[("code", Type::Code)], "message(code).as_ptr()")
        }];
        if self.has_params() {
            let default = function("params_default", PARAMS_DEFAULT, &[], "Params::default()");
            all.push(Function { result: Return::Params, ..default });
            let body = "let params = given(params)?; given_to_write(state)?.hold(|| Ok(assemble(params)?))";
            all.push(function("assemble", ASSEMBLE, &[to_write, params], body));
        } else {
            let body = "given_to_write(state)?.hold(|| Ok(assemble(&Params)?))";
            all.push(function("assemble", ASSEMBLE, &[to_write], body));
        }
        let assembly = [state, ("assembly", Type::WholeToWrite)];
        all.push(function(
            "assembly",
            ASSEMBLY,
            &assembly,
            "write_whole(assembly, state_of(state)?.assembly() as i32)",
        ));
        let most_work = function("most_work", MOST_WORK, &[most], "most_work(most)");
        all.push(Function { result: Return::Count, ..most_work });
        let body = "Ok(step(t, state_to_write(state)?)?)";
        all.push(function("step", STEP, &[to_write, t], body));
        let body = "reached(step_within(t, state_to_write(state)?, most)?)";
        all.push(function("step_within", STEP_WITHIN, &[to_write, t, most], body));
        let body = "write(list, length, &state_of(state)?.row())";
        all.push(function("row", ROW, &[state, list, length], body));
        let body = "write(value, 1, &[*state_of(state)?.row().get(column).ok_or(NO_SUCH_COLUMN)?])";
        all.push(function("value", VALUE, &[state, ("column", Type::Count), ("value", Type::NumbersToWrite)], body));
        if self.has_inputs() {
            let to_inputs = ("inputs", Type::InputsToWrite);
            let (given, body) = if self.has_params() {
                (vec![t, params, to_inputs], "say(inputs, || Ok(Inputs::at(number(t)?, given(params)?)))")
            } else {
                (vec![t, to_inputs], "say(inputs, || Ok(Inputs::at(number(t)?, &Params)))")
            };
            all.push(function("inputs_at", INPUTS_AT, &given, body));
            let body = "say(inputs, || Ok(state_of(state)?.inputs()))";
            all.push(function("inputs_of", INPUTS, &[state, to_inputs], body));
            let body = "Ok(follow(given(inputs)?, state_to_write(state)?)?)";
            all.push(function("follow", FOLLOW, &[to_write, inputs], body));
            let body = "reached(follow_within(given(inputs)?, state_to_write(state)?, most)?)";
            all.push(function("follow_within", FOLLOW_WITHIN, &[to_write, inputs, most], body));
            let body = "read(list, length, |all| state_to_write(state).map(|state| state.set_largest_change(all)))";
            let arguments = [to_write, ("list", Type::Numbers), ("length", Type::Count)];
            all.push(function("set_largest_change", SET_LARGEST_CHANGE, &arguments, body));
            let body = "write(list, length, influence(state_of(state)?)?.as_flattened())";
            all.push(function("influence", INFLUENCE, &[state, list, length], body));
        }
        if self.has_sensitivity() {
            let body = "write(list, length, sensitivity(given(params)?, state_of(state)?)?.as_flattened())";
            all.push(function("sensitivity", SENSITIVITY, &[state, params, list, length], body));
        }
        if self.unit.has_forces() {
            all.push(function(
                "forces",
                FORCES,
                &[state, list, length],
                "write(list, length, &forces(state_of(state)?))",
            ));
        }
        all
    }

    /// Returns the names in the crate of all that the functions use.
    fn used(&self) -> Vec<&'static str> {
        let mut used = vec!["Error", "Params", "Progress", "State", "assemble", "most_work", "step", "step_within"];
        if self.has_inputs() {
            used.extend(["INPUTS", "Inputs", "follow", "follow_within", "influence"]);
        }
        if self.has_sensitivity() {
            used.push("sensitivity");
        }
        if self.unit.has_forces() {
            used.push("forces");
        }
        // rustfmt sorts types before functions
        used.sort_by_key(|name| (name.starts_with(|c: char| c.is_ascii_lowercase()), *name));
        used
    }

    /// Returns the Rust source file of the functions.
    pub(super) fn functions(&self) -> String {
        let mut page = Page::default();
        page.line(&format!("// {}", self.mark));
        page.blank();
        let header = format!("include/{}.h", self.prefix);
        page.line(&format!("//! What C calls, as `{header}` declares it, and all in this crate that is unsafe."));
        page.blank();
        page.line("#[rustfmt::skip]");
        page.line(&format!("use super::{{{}}};", self.used().join(", ")));
        page.text(include_str!("../package/memory.rs"));
        page.blank();
        if self.has_inputs() {
            page.text(include_str!("../package/given_inputs.rs"));
            page.blank();
        }
        page.constant("Words of 8 bytes that a state takes.", "const WORDS: usize", &self.words.to_string());
        page.line("// what the header says of steps and work is what this crate does");
        for (name, value) in self.bounds {
            page.line(&format!("const _: () = assert!(super::{name} == {value});"));
        }
        page.blank();
        let docs = "What the first word of a state says, of this mechanism alone.";
        page.constant(docs, "const SIGN: u64", &format!("{:#x}", self.sign()));
        of_codes(&mut page);
        for function in self.all() {
            self.print(&function, &mut page);
        }
        page.done().trim_end().to_owned() + "\n"
    }

    /// Returns the hash (FNV-1a) that marks states of this mechanism.
    fn sign(&self) -> u64 {
        let what = self.prefix.bytes().chain(self.words.to_le_bytes());
        what.fold(0xcbf2_9ce4_8422_2325, |sign, byte| (sign ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }

    fn print(&self, function: &Function, page: &mut Page) {
        let arguments: Vec<(&str, &str)> = function.arguments.iter().map(|(name, of)| (*name, of.in_rust())).collect();
        let is_safe = !function.arguments.iter().any(|(_, of)| of.in_rust().starts_with('*'));
        page.docs(function.docs);
        page.line("#[rustfmt::skip]");
        page.line("#[unsafe(no_mangle)]");
        let kind = if is_safe { "pub extern \"C\" fn" } else { "pub unsafe extern \"C\" fn" };
        let name = format!("{}_{}", self.prefix, function.name);
        let head = Head { kind, name: &name, arguments: &arguments, result: function.result.in_rust() };
        page.function(&head, |page| match function.result {
            Return::Code => {
                page.line("// SAFETY: pointers are what the header asks for; null ones are refused");
                page.line(&format!("answer(|| unsafe {{ {} }})", function.body));
            }
            _ => page.line(function.body),
        });
    }

    /// Returns name, documentation and whether it is time, for each field of the C structure of inputs.
    pub(super) fn fields_of_inputs(&self) -> Vec<(String, String, bool)> {
        let Some(following) = &self.unit.following else {
            return Vec::new();
        };
        let inputs = following.unit.system.inputs();
        let names = Case::Snake.names_of_inputs(inputs);
        let fields = inputs.iter().zip(names);
        fields
            .map(|(input, name)| (field(&name), format!("{} ({})", input.name, unit(&input.unit())), input.is_time()))
            .collect()
    }
}

/// Prints the status codes with their messages.
fn of_codes(page: &mut Page) {
    let codes = codes();
    for (number, code) in codes.iter().filter(|(number, code)| *number != 0 && code.error.is_none()) {
        page.docs(&format!("{}.", capital(code.message)));
        // not every mechanism has lists of all kinds
        page.line(&format!("const {}: Status = Status({number});", code.name));
    }
    page.blank();
    page.item("impl From<Error> for Status", |page| {
        let head = Head { kind: "fn", name: "from", arguments: &[("error", "Error")], result: "Self" };
        page.function(&head, |page| {
            page.block("match error", |page| {
                for (number, code) in &codes {
                    if let Some(error) = code.error {
                        page.line(&format!("Error::{error} => Self({number}),"));
                    }
                }
            });
        });
    });
    let head = Head { kind: "fn", name: "message", arguments: &[("code", "i32")], result: "&'static CStr" };
    page.function(&head, |page| {
        page.block("match code", |page| {
            for (number, code) in &codes {
                page.line(&format!("{number} => c\"{}\",", code.message));
            }
            page.line("_ => c\"there is no such code\",");
        });
    });
}

/// Returns a text with its first letter in upper case.
fn capital(text: &str) -> String {
    let (first, rest) = text.split_at(text.len().min(1));
    first.to_uppercase() + rest
}
