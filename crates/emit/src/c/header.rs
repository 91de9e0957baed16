//! The C and C++ header: constants, structures and functions.

use super::functions::{Function, Return};
use super::names::{comment, field};
use super::{Interface, codes, constant};
use crate::names::Case;
use crate::params::{FieldType, Params};
use crate::print::Page;
use crate::text::{literal, unit};
use mechc_engine::limits::step_control::FEWEST_STEPS;

/// Documentation that holds for all functions.
const ABOUT: &str = "\
All is in m, rad and s. The caller has the memory of everything: nothing is allocated, nothing is kept
between calls, and nothing here waits, prints or ends the program. States are independent of each other:
use as many as you like, each by one thread at a time.

A state is a plain value. One that is static, or set to 0, is none yet, and is refused until `assemble`
has made it one; memory that was never written may be anything, and must be set to 0 first. Copying a state
by assignment keeps it for a try.

Functions answer with a code, 0 (OK) if all went well; one below 0 is no error. No call does more than a bounded
amount of work, whatever it is given, and all do all or nothing: after an error, which is a code above 0, a state is
bit for bit what it was. Work is counted in evaluations of the equations; what one costs, the crate's page says.

A pointer that is null or not aligned, a list of
another length, a state that was not assembled and a number that is not one are refused with a code, and
change nothing. That a list is as long as is said, and that a pointer leads somewhere, C alone can know.";

impl Interface<'_> {
    /// Returns the header.
    pub(super) fn header(&self) -> String {
        let mut page = Page::default();
        let (name, guard) = (self.unit.system.name(), format!("{}_H", self.constants()));
        page.line(&comment(self.mark));
        page.blank();
        page.line("/*");
        page.text(&format!("Kinematics of the mechanism {name}, for C99 and later, and for C++.\n\n{ABOUT}"));
        page.line("*/");
        page.blank();
        page.text(&format!("#ifndef {guard}\n#define {guard}\n\n#include <stddef.h>\n#include <stdint.h>\n"));
        page.blank();
        page.text("#ifdef __cplusplus\nextern \"C\" {\n#endif");
        page.blank();
        self.codes(&mut page);
        self.numbers(&mut page);
        self.structures(&mut page);
        for function in self.all() {
            self.declared(&function, &mut page);
        }
        page.text("#ifdef __cplusplus\n}\n#endif");
        page.blank();
        page.line("#endif");
        page.done()
    }

    fn codes(&self, page: &mut Page) {
        let constants = self.constants();
        page.line("/* What functions answer. */");
        page.block("enum", |page| {
            for (number, code) in codes() {
                page.line(&comment(code.message));
                page.line(&format!("{constants}_{} = {number},", code.name));
            }
        });
        page.end_statement();
    }

    /// Prints indices and counts.
    fn numbers(&self, page: &mut Page) {
        let (system, constants) = (self.unit.system, self.constants());
        let coordinates = Case::Constant.names(system.coordinates().iter().map(|of| of.name.as_str()));
        let descriptions = system.coordinates().iter().map(|of| format!("{} ({})", of.name, unit(of.kind.unit())));
        let coordinates = coordinates.into_iter().zip(descriptions).collect::<Vec<_>>();
        self.places(page, "COLUMN", "COLUMNS", "Where each result stands in a row.", &self.columns());
        self.places(page, "COORDINATE", "COORDINATES", "Where each coordinate stands in a list of them.", &coordinates);
        if self.has_params() {
            let names = Case::Constant.names(system.params().iter().map(|of| of.name.as_str()));
            let descriptions = system.params().iter().map(|of| format!("{} ({})", of.name, unit(&of.unit())));
            self.places(
                page,
                "PARAM",
                "PARAMS",
                "The numbers of the parameters.",
                &names.into_iter().zip(descriptions).collect::<Vec<_>>(),
            );
        }
        if let Some(following) = &self.unit.following {
            let inputs = following.unit.system.inputs();
            let names = Case::Constant.names_of_inputs(inputs);
            let inputs = inputs.iter().zip(names).filter(|(of, _)| !of.is_time());
            let inputs =
                inputs.map(|(of, name)| (name, format!("{} ({})", of.name, unit(&of.unit())))).collect::<Vec<_>>();
            self.places(page, "INPUT", "INPUTS", "The numbers of the inputs.", &inputs);
        }
        if self.unit.has_forces() {
            let reactions = system.reactions();
            let names = Case::Constant.names(reactions.iter().map(|of| of.name.as_str()));
            let descriptions = reactions.iter().map(|of| format!("{} ({})", of.name, unit(&of.unit)));
            let named = names.into_iter().zip(descriptions).collect::<Vec<_>>();
            self.places(
                page,
                "FORCE",
                "FORCES",
                "Where each force, moment and effort stands in a list of them.",
                &named,
            );
        }
        let Some(motion) = &self.unit.motion else {
            return;
        };
        let span = motion.to.map_or(1.0, |to| if to > motion.from { to - motion.from } else { 1.0 });
        page.line("/* The first time of the file's analysis (s), and the longest step of the motion (s). */");
        page.line(&format!("#define {constants}_START_TIME {}", literal(motion.from)));
        page.line(&format!("#define {constants}_LONGEST_STEP {}", literal(span / FEWEST_STEPS)));
        page.blank();
        page.line("/* How many steps calls take at most, and how many evaluations these are: no call does more. */");
        for (name, value) in self.bounds {
            page.line(&format!("#define {constants}_{name} {value}"));
        }
        page.blank();
        page.line("/* Which way a state was assembled: led along the branch of the file's parameters, or from its drawn poses. */");
        page.line(&format!("enum {{ {constants}_ASSEMBLY_LED = 0, {constants}_ASSEMBLY_DRAWN = 1 }};"));
        page.blank();
    }

    /// Prints named indices and their count.
    fn places(&self, page: &mut Page, one: &str, all: &str, docs: &str, named: &[(String, String)]) {
        let constants = self.constants();
        page.line(&comment(docs));
        page.block("enum", |page| {
            for (k, (name, docs)) in named.iter().enumerate() {
                page.line(&format!("{constants}_{one}_{name} = {k}, {}", comment(docs)));
            }
            page.line(&format!("{constants}_{all} = {} /* how many they are */", named.len()));
        });
        page.end_statement();
    }

    fn structures(&self, page: &mut Page) {
        let (prefix, constants) = (self.prefix, self.constants());
        if self.has_params() {
            self.params(page);
        }
        if self.has_inputs() {
            page.line("/* What is given of an input: its value, and its first and second time derivatives. */");
            self.structure(page, "signal", |page| page.line("double value, rate, acceleration;"));
            page.line("/* What comes from outside, in SI. */");
            self.structure(page, "inputs", |page| {
                for (name, docs, is_time) in self.fields_of_inputs() {
                    let of = if is_time { "double".to_owned() } else { format!("{prefix}_signal") };
                    page.line(&format!("{of} {name}; {}", comment(&docs)));
                }
            });
        }
        page.line("/* The mechanism at a time; what is in it is for these functions alone. */");
        page.line(&format!("#define {constants}_STATE_WORDS {}", self.words));
        self.structure(page, "state", |page| page.line(&format!("uint64_t memory[{constants}_STATE_WORDS];")));
    }

    fn structure(&self, page: &mut Page, name: &str, body: impl FnOnce(&mut Page)) {
        let prefix = self.prefix;
        page.line(&format!("typedef struct {prefix}_{name} {{"));
        page.indented(body);
        page.line(&format!("}} {prefix}_{name};"));
        page.blank();
    }

    /// Prints the structures of the parameters, nested ones first.
    fn params(&self, page: &mut Page) {
        let params = Params::new(self.unit.system);
        let called = |name: &str| constant(name).to_lowercase();
        for of in params.types.iter().rev() {
            page.line(&comment(&if of.source.is_empty() {
                "The parameters, in SI.".to_owned()
            } else {
                format!("The parameters of a part, as {}, in SI.", of.source)
            }));
            self.structure(page, &called(&of.name), |page| {
                for member in &of.fields {
                    let name = field(&member.name);
                    let inner = |part: usize| format!("{}_{}", self.prefix, called(&params.types[part].name));
                    let (declared, docs) = match &member.kind {
                        FieldType::Number(param) => {
                            let of = self.unit.system.params()[*param].unit();
                            (format!("double {name}"), format!("{} ({})", member.source, unit(&of)))
                        }
                        FieldType::Part(part) => (format!("{} {name}", inner(*part)), member.source.clone()),
                        FieldType::Copies(part, lengths) => {
                            let lengths: Vec<String> = lengths.iter().map(|length| format!("[{length}]")).collect();
                            (format!("{} {name}{}", inner(*part), lengths.concat()), member.source.clone())
                        }
                    };
                    page.line(&format!("{declared}; {}", comment(&docs)));
                }
            });
        }
    }

    fn declared(&self, function: &Function, page: &mut Page) {
        let prefix = self.prefix;
        page.line(&format!("/* {} */", function.docs));
        let arguments: Vec<String> = function.arguments.iter().map(|(name, of)| of.in_c(name, prefix)).collect();
        let arguments = if arguments.is_empty() { "void".to_owned() } else { arguments.join(", ") };
        let result = match function.result {
            Return::Code => "int32_t ".to_owned(),
            Return::Message => "const char *".to_owned(),
            Return::Params => format!("{prefix}_params "),
            Return::Count => "size_t ".to_owned(),
        };
        page.line(&format!("{result}{prefix}_{}({arguments});", function.name));
        page.blank();
    }
}
