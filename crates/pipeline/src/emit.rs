//! Emission of a compiled mechanism as code: collects what `mechc_emit` writes.

use crate::{Compiled, RunOptions};
use mechc_emit::{self as emit, CrateFile, EmittedMotion, Following, LARGEST_STRAIGHT, Reference, TranslationUnit};
use mechc_engine::analysis::{self, Horizon, Solving, Times};
use mechc_engine::solver::BlockTables;
use mechc_expr::Dependence;
use mechc_ir::layout::RowLayout;
use mechc_ir::program::Program;
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostic, Diagnostics};

/// Limits of the rows and numbers that a crate is tested against.
const MAX_ROWS: usize = 20;
const MAX_NUMBERS: usize = 20_000;

/// Options of emitted Rust code.
#[derive(Clone, Debug)]
pub struct RustOptions {
    /// Name of the file, for the header.
    pub file: String,
    /// True if the code assembles the mechanism and follows its motion, in addition to evaluating the equations.
    pub with_motion: bool,
    /// True if the code computes derivatives of the coordinates by the params.
    pub with_sensitivities: bool,
    /// Number of variants or times that are solved at once, in addition to single ones.
    pub lanes: Option<usize>,
    /// True if a crate has a header and functions for C.
    pub for_c: bool,
}

impl RustOptions {
    /// Returns the options of code with a motion and nothing else.
    #[must_use]
    pub fn new(file: impl Into<String>) -> RustOptions {
        let (with_motion, with_sensitivities, for_c) = (true, false, false);
        RustOptions { file: file.into(), with_motion, with_sensitivities, lanes: None, for_c }
    }
}

impl Compiled {
    /// Emits a Rust module; returns diagnostics, too. `None` if the start cannot be assembled, or the module would be too large.
    #[must_use]
    pub fn rust(&self, options: &RustOptions) -> (Option<String>, Diagnostics) {
        self.emit_with(options, |_, unit, _| Ok(emit::rust(unit)))
    }

    /// Emits a crate of a name around that module. Its test compares it with the rows of the text's analysis, or of the first second. Reports why the
    /// motion stops, if it does.
    #[must_use]
    pub fn package(&self, name: &str, options: &RustOptions) -> (Option<Vec<CrateFile>>, Diagnostics) {
        self.emit_with(options, |compiled, unit, diagnostics| {
            let reference = compiled.reference(diagnostics)?;
            Ok(emit::package(unit, &reference, name))
        })
    }

    /// Makes code from a translation unit; returns diagnostics, too.
    fn emit_with<T>(
        &self,
        options: &RustOptions,
        make: impl FnOnce(&Compiled, &TranslationUnit<'_>, &mut Diagnostics) -> Result<T, Box<Diagnostic>>,
    ) -> (Option<T>, Diagnostics) {
        if let Err(why) = self.check_no_varied_forces() {
            return (None, (*why).into());
        }
        let with_reactions = self.with_reactions();
        let compiled = with_reactions.as_ref().unwrap_or(self);
        let by_params = if options.with_sensitivities { compiled.by_params().map(Some) } else { Ok(None) };
        let by_params = match by_params {
            Ok(compiled) => compiled,
            Err(why) => return (None, why),
        };
        let compiled = by_params.as_ref().unwrap_or(compiled);
        let signals = match compiled.signals_for_code(options) {
            Ok(signals) => signals,
            Err(why) => return (None, why),
        };
        let mut diagnostics = Diagnostics::default();
        let made = compiled
            .unit(options, signals.as_ref(), &mut diagnostics)
            .and_then(|unit| make(compiled, &unit, &mut diagnostics));
        match made {
            Ok(made) => (Some(made), diagnostics),
            Err(why) => (None, (*why).into()),
        }
    }

    /// Returns whether the mechanism can be emitted.
    ///
    /// # Errors
    /// A measure holds the derivative of a force by an input or param, which only `run` computes.
    fn check_no_varied_forces(&self) -> Result<(), Box<Diagnostic>> {
        let system = self.system();
        let has_varied_forces = |id| system.graph().dependence(id).on(Dependence::VARIED_MULTIPLIERS);
        let Some(measure) = system.measures().iter().find(|measure| has_varied_forces(measure.value)) else {
            return Ok(());
        };
        let message = format!("measure `{}` holds the derivative of a force", measure.name);
        let diagnostic = Diagnostic::new(Code::E0706, message).at(measure.span, "is for `run` alone");
        Err(Box::new(diagnostic.help("leave the measure out here; `mechc run` computes it")))
    }

    /// Returns the mechanism with inputs as signals, if it has any and its motion is emitted.
    fn signals_for_code(&self, options: &RustOptions) -> Result<Option<Signals>, Diagnostics> {
        if !options.with_motion {
            return Ok(None);
        }
        let compiled = self.signals(&Cancel::default())?;
        Ok(compiled.map(|compiled| Signals { given: compiled.program().with_signals_as_inputs(), compiled }))
    }

    fn unit<'u>(
        &'u self,
        options: &'u RustOptions,
        signals: Option<&'u Signals>,
        diagnostics: &mut Diagnostics,
    ) -> Result<TranslationUnit<'u>, Box<Diagnostic>> {
        let program = &**self.program();
        let motion = if options.with_motion { Some(self.motion(program, None, options, diagnostics)?) } else { None };
        let (system, sources) = (self.system(), self.sources());
        let RustOptions { ref file, lanes, for_c, .. } = *options;
        let following = match signals {
            None => None,
            Some(Signals { compiled, given: program }) => {
                // the diagnostics of the assembly are reported already
                let begin = motion.as_ref().map(|motion| motion.q.as_slice());
                let motion = Some(compiled.motion(program, begin, options, &mut Diagnostics::default())?);
                let system = compiled.system();
                let unit = TranslationUnit { system, program, sources, file, motion, lanes, for_c, following: None };
                Some(Following { unit: Box::new(unit), by_text: compiled.program() })
            }
        };
        let unit = TranslationUnit { system, program, sources, file, motion, lanes, for_c, following };
        check_size(&unit)?;
        Ok(unit)
    }

    /// Returns what code needs to follow the motion by the operations of a program, from the start of the text's analysis or from 0 s. `begin`
    /// holds the start, if it is known.
    fn motion(
        &self,
        program: &Program,
        begin: Option<&[f64]>,
        options: &RustOptions,
        diagnostics: &mut Diagnostics,
    ) -> Result<EmittedMotion, Box<Diagnostic>> {
        let horizon = Horizon::of_analysis(self.analysis());
        let mut started = if let Some(q) = begin {
            self.unassembled(horizon, &RunOptions::default())
                .assemble_at(q, Solving::New)
                .map_err(|stop| Box::new(self.explain_start(&stop, horizon)))?
        } else {
            let (started, report) = self.start(horizon, &RunOptions::default());
            diagnostics.extend(report.diagnostics);
            started.map_err(|stop| Box::new(self.explain_start(&stop, horizon)))?
        };
        diagnostics.extend(started.remarks());
        let mut solver_of =
            |program: &Program| started.solver_for_code_of(program).ok_or_else(|| Box::new(too_large()));
        let plain = program.without_reactions();
        let solver = solver_of(&plain.without_params())?;
        let sensitive = if options.with_sensitivities { Some(solver_of(&plain)?) } else { None };
        let with_reactions = !program.outputs.reactions.is_empty();
        let forced = if with_reactions { Some(solver_of(&program.without_params())?) } else { None };
        Ok(EmittedMotion {
            solver,
            sensitive,
            forced,
            blocks: BlockTables::new(self.determined()),
            q: started.q().to_vec(),
            bounds: started.bounds(),
            from: horizon.from,
            to: self.times().map(|times| times.at(times.len().saturating_sub(1))),
            tolerance: analysis::TOLERANCE,
        })
    }

    /// Returns the motion over the text's analysis, or over the first second.
    fn reference(&self, diagnostics: &mut Diagnostics) -> Result<Reference, Box<Diagnostic>> {
        let [from, to, every] = self.analysis().unwrap_or([0.0, 1.0, 0.1]);
        let times = Times::grid(from, to, every).unwrap_or_else(|| Times::listed(from, vec![from]));
        // without an analysis the last time is omitted, as its row belongs to the motion after an edge
        let count = if self.analysis().is_some() { times.len() } else { times.len() - 1 };
        let (run, remarks) = self.run(&times, &RunOptions::default());
        let Some(mut run) = run else {
            return Err(Box::new(remarks.into_iter().next_back().unwrap_or_else(too_large)));
        };
        let mut columns = run.columns().to_vec();
        let reactions = RowLayout::new(self.system()).reactions();
        columns.drain(reactions.clone());
        let sampled = (MAX_NUMBERS / columns.len()).clamp(2, MAX_ROWS) as u64;
        // spread evenly, the first and the last included
        let is_sampled = |k: u64| k == 0 || k * (sampled - 1) / (count - 1) > (k - 1) * (sampled - 1) / (count - 1);
        let (mut rows, mut last, mut number) = (Vec::new(), Vec::new(), 0);
        let mut why = None;
        while number < count
            && let Some(row) = run.next_row()
        {
            match row {
                Ok(row) if is_sampled(number) => rows.push(row.to_vec()),
                Ok(row) => row.clone_into(&mut last),
                Err(error) => {
                    why = error.diagnostics.into_iter().next();
                    break;
                }
            }
            number += 1;
        }
        if number == 0
            && let Some(why) = why
        {
            return Err(Box::new(why));
        }
        if rows.last().map(|row| row[0]) < last.first().copied() {
            rows.push(last);
        }
        let forces = rows.iter_mut().map(|row: &mut Vec<f64>| row.drain(reactions.clone()).collect()).collect();
        diagnostics.extend(run.take_warnings());
        let stopped = why.as_ref().map(|why| why.message.clone());
        diagnostics.extend(why);
        Ok(Reference { columns, rows, forces, steps: number - 1, every, stopped })
    }
}

/// A mechanism with inputs as signals.
struct Signals {
    compiled: Compiled,
    /// The program without operations that evaluate the inputs.
    given: Program,
}

/// Returns whether a mechanism can be emitted.
///
/// # Errors
/// It needs more operations than are emitted.
fn check_size(unit: &TranslationUnit<'_>) -> Result<(), Box<Diagnostic>> {
    let of_following = unit.following.as_ref().map_or(0, |following| following.unit.operations());
    let operations = unit.operations().max(of_following);
    if operations <= LARGEST_STRAIGHT {
        return Ok(());
    }
    let message = format!("emitted Rust would need {operations} operations, more than {LARGEST_STRAIGHT}");
    let do_equations_fit = emit::operations_of_equations(unit.program) <= LARGEST_STRAIGHT;
    let equations = do_equations_fit.then(|| "or write the equations alone: `--with equations`".to_owned());
    let help = "use `mechc run`, the Rust library or Python: they evaluate mechanisms of any size";
    Err(Box::new(Diagnostic::new(Code::E0706, message).help(help).help_if(equations)))
}

/// Returns the error of a mechanism whose solver has too many operations even to be generated.
fn too_large() -> Diagnostic {
    Diagnostic::new(Code::E0706, "the solver of this mechanism would take too many operations")
        .help("write the equations alone: `--with equations`")
}
