//! Specifications of sweeps: reads `--vary` and `--sample`, and lists the variants.

use crate::checked::VARY;
use crate::option_reader::{OptionNumber, OptionReader, refuse_duplicates, si_unit, unusable, written};
use crate::options::spaceless;
use crate::{Checked, Choice};
use mechc_engine::sweep::{Levels, MAX_SOBOL_DIMENSIONS, Method, Points, Sampling, Varying};
use mechc_lang::check::{self, Column, ParamOverride};
use mechc_lang::model::Dimension;
use mechc_syntax::{self as syntax, ast};
use mechc_text::diag::{Diagnostic, Diagnostics, Error};
use mechc_text::source::{Sources, Span};
use mechc_text::world::{self, World};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The options that specify a sweep.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct VaryOptions {
    /// `NAME=A..B:N`, `NAME=A,B,C`, `@FILE.csv`, and with a sample `NAME=A..B`.
    pub params: Vec<String>,
    /// Number of sample points within the ranges that have no number of values.
    pub sample: Option<u64>,
    /// The distribution of the sample.
    pub method: Option<Method>,
    /// Selects one of the samples of its method.
    pub seed: Option<u64>,
}

/// The variants of a sweep: the params that vary, and their values in each variant.
#[derive(Clone, Debug)]
pub struct Variants {
    points: Points,
    /// For each param, the SI unit of its values as a formula has it; empty for a pure number.
    units: Vec<String>,
    /// For each param, the formula of one of its unit.
    ones: Vec<ast::Expr>,
    /// The texts of the mechanism, of the options, and of the files that these name.
    sources: Sources,
    named_files: Vec<PathBuf>,
    /// Indices of the params that decide counts, found at the first use.
    pub(crate) count_params: OnceLock<Vec<usize>>,
}

impl Variants {
    /// Makes variants of points. `units` holds for each param the SI unit of its values, empty for a pure number; `option` is named in messages.
    pub(crate) fn new(
        points: Points,
        units: Vec<String>,
        mut sources: Sources,
        option: &str,
    ) -> Result<Variants, Error> {
        let mut ones = Vec::with_capacity(units.len());
        for (name, unit) in points.params().iter().zip(&units) {
            let file = sources.add_option(format!("{option} {name}"), written(1.0, unit));
            ones.push(syntax::parse_expression(&sources, file).map_err(|why| Error::new(why, &sources))?);
        }
        Ok(Variants { points, units, ones, sources, named_files: Vec::new(), count_params: OnceLock::new() })
    }

    /// Returns the values of the params.
    #[must_use]
    pub fn points(&self) -> &Points {
        &self.points
    }

    /// Returns the SI unit of each param that varies; `1` for a pure number.
    pub fn units(&self) -> impl Iterator<Item = &str> {
        self.units.iter().map(|unit| if unit.is_empty() { "1" } else { unit.as_str() })
    }

    /// Returns the texts of the mechanism, of the options, and of the files that these name.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Returns the files that list variants.
    #[must_use]
    pub fn named_files(&self) -> &[PathBuf] {
        &self.named_files
    }

    /// Returns the settings of a variant, as `--set` takes them: `rod=0.12 m`. They give the same values, to the bit.
    #[must_use]
    pub fn settings(&self, variant: u64) -> Vec<String> {
        let set = |((name, unit), value): ((&String, &String), f64)| format!("{name}={}", written(value, unit));
        let names = self.points.params().iter().zip(&self.units);
        names.zip(self.values(variant)).map(set).collect()
    }

    /// Returns the settings of given values as formulas.
    pub(crate) fn read_settings(&self, values: &[f64]) -> impl Iterator<Item = ParamOverride> {
        let set = |(((name, unit), is_unitless), &value): (((&String, &ast::Expr), bool), &f64)| {
            let number = ast::ExprKind::Literal { value, unit: None };
            let kind = if value == 0.0 && is_unitless {
                // A product is no literal zero, which fits any dimension.
                number
            } else {
                let number = ast::Expr { kind: number, span: unit.span };
                ast::ExprKind::Product(Box::new(number), vec![(ast::Factor::Times, unit.clone())])
            };
            ParamOverride { path: name.clone(), value: ast::Expr { kind, span: unit.span } }
        };
        let is_unitless = self.units.iter().map(String::is_empty);
        self.points.params().iter().zip(&self.ones).zip(is_unitless).zip(values).map(set)
    }

    /// Returns the values of a variant's params (SI).
    pub(crate) fn values(&self, variant: u64) -> Vec<f64> {
        let mut values = vec![0.0; self.points.params().len()];
        self.points.values(variant, &mut values);
        values
    }
}

impl Checked {
    /// Reads the variants of a sound mechanism; `choice` is what it was checked with.
    ///
    /// # Errors
    /// A param cannot vary as specified; with the texts that the diagnostics point into.
    pub fn variants(&self, vary: &VaryOptions, choice: &Choice, world: &dyn World) -> Result<Variants, Error> {
        let with_sources = |why: Box<Diagnostic>| Error::new(why, self.sources());
        let arguments = vary.params.iter().map(|text| VaryArgument::parse(text)).collect::<Result<Vec<_>, _>>();
        let arguments = arguments.map_err(with_sources)?;
        refuse_without_counterpart(vary, &arguments).map_err(with_sources)?;
        // each variant reports for itself whether it reaches its values; results that options add are in the tree already
        let choice = Choice { lead: false, results: Vec::new(), until: None, ..choice.clone() };
        let reader = OptionReader { parsed: &self.parsed, checked: self, choice: &choice, world, option: VARY };
        let mut builder =
            SpecBuilder { reader, sources: self.sources().clone(), params: Vec::new(), named_files: Vec::new() };
        let mut axes = Vec::new();
        let mut ranges: Option<(usize, Vec<usize>, Vec<[f64; 2]>)> = None;
        for argument in &arguments {
            match builder.read(argument)? {
                ParsedArgument::Axis(axis) => axes.push(axis),
                ParsedArgument::Range(param, ends) => {
                    let (_, params, all) = ranges.get_or_insert_with(|| (axes.len(), Vec::new(), Vec::new()));
                    params.push(param);
                    all.push(ends);
                }
            }
        }
        if let (Some((at, params, ends)), Some(count)) = (ranges, vary.sample) {
            let sample = Sampling::of(ends, count, vary.method.unwrap_or_default(), vary.seed);
            axes.insert(at, Varying { params, values: Levels::Sampled(Box::new(sample)) });
        }
        let names: Vec<String> = builder.params.iter().map(|param| param.name.clone()).collect();
        refuse_duplicates(names.iter(), &choice).map_err(with_sources)?;
        let too_many = || {
            let why = unusable("there are more variants than can be counted".to_owned());
            with_sources(Box::new(why.help("ask for fewer values")))
        };
        let points = Points::new(names, axes).ok_or_else(too_many)?;
        builder.variants(points)
    }
}

/// A `--vary` argument.
enum VaryArgument {
    /// `NAME=A..B:N`
    Even { name: String, ends: [String; 2], count: u64 },
    /// `NAME=A..B`
    Range { name: String, ends: [String; 2] },
    /// `NAME=A,B,C`
    List { name: String, values: Vec<String> },
    /// `@FILE.csv`
    File(PathBuf),
}

impl VaryArgument {
    fn parse(text: &str) -> Result<VaryArgument, Box<Diagnostic>> {
        if let Some(file) = text.trim().strip_prefix('@') {
            return Ok(VaryArgument::File(PathBuf::from(file.trim())));
        }
        let named = text.split_once('=').map(|(name, rest)| (spaceless(name), rest.trim()));
        let Some((name, rest)) = named.filter(|(name, rest)| !name.is_empty() && !rest.is_empty()) else {
            return refuse(format!("`{VARY} {text}` does not say what varies"), VARY_HELP);
        };
        let Some((first, last)) = rest.split_once("..") else {
            return Ok(VaryArgument::List { name, values: split_at_commas(rest) });
        };
        let (last, count) = match last.rsplit_once(':') {
            None => (last, None),
            Some((last, count)) => (last, Some(count.trim())),
        };
        let ends = [first, last].map(|end| end.trim().to_owned());
        if ends.iter().any(String::is_empty) {
            return refuse(format!("`{VARY} {text}` does not say from where to where"), VARY_HELP);
        }
        match count {
            None => Ok(VaryArgument::Range { name, ends }),
            Some(count) => match count.parse() {
                Ok(count) if count > 0 => Ok(VaryArgument::Even { name, ends, count }),
                _ => {
                    let [first, last] = &ends;
                    refuse(
                        format!("`{count}` is no number of values for `{name}`"),
                        &format!("a whole number from 1 on is wanted, as in `{VARY} {name}={first}..{last}:50`"),
                    )
                }
            },
        }
    }
}

const VARY_HELP: &str = "write `--vary rod=100mm..200mm:50` for so many values, both ends included, `--vary speed=60rpm,90rpm` for a list,\n\
                     `--vary @variants.csv` for a table, or `--vary rod=100mm..200mm` with `--sample 1000`";

/// Splits at commas outside parentheses.
fn split_at_commas(text: &str) -> Vec<String> {
    let mut depth = 0_u32;
    let is_between = |c: char| {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        c == ',' && depth == 0
    };
    text.split(is_between).map(|part| part.trim().to_owned()).collect()
}

/// Refuses ranges without a number of values if there is no sample, and the reverse.
fn refuse_without_counterpart(vary: &VaryOptions, arguments: &[VaryArgument]) -> Result<(), Box<Diagnostic>> {
    let range = arguments.iter().find_map(|argument| match argument {
        VaryArgument::Range { name, ends: [first, last] } => Some((name, first, last)),
        _ => None,
    });
    let even = arguments.iter().find_map(|argument| match argument {
        VaryArgument::Even { name, .. } => Some(name),
        _ => None,
    });
    let ranges = arguments.iter().filter(|argument| matches!(argument, VaryArgument::Range { .. })).count();
    match (range, even, vary.sample) {
        (Some((name, ..)), Some(even), _) => refuse(
            format!("`{even}` has a number of values, and `{name}` has none"),
            "give all ranges a number of values, as in `--vary NAME=A..B:50`, or none, with `--sample N` for all of them together",
        ),
        (Some((name, first, last)), None, None) => refuse(
            format!("it is not said how many values `{name}` has"),
            &format!(
                "write `{VARY} {name}={first}..{last}:50` for 50, evenly, or add `--sample 1000` for a sample of all ranges"
            ),
        ),
        (None, _, Some(_)) => refuse(
            "there is no range to take a sample of".to_owned(),
            "`--sample` is for ranges without a number of values: `--vary rod=100mm..200mm`",
        ),
        (Some(_), None, Some(0)) => refuse("a sample has one variant at least".to_owned(), "as in `--sample 1000`"),
        (Some(_), None, Some(_)) if ranges > MAX_SOBOL_DIMENSIONS && vary.method != Some(Method::Random) => refuse(
            format!("Sobol's sequence is known here for {MAX_SOBOL_DIMENSIONS} params, and {ranges} are to vary"),
            "add `--method random`",
        ),
        (None, _, None) if vary.method.is_some() || vary.seed.is_some() => {
            let option = if vary.method.is_some() { "--method" } else { "--seed" };
            let message = format!("`{option}` says how a sample is taken, and there is none");
            refuse(message, "add `--sample N`, or leave it out")
        }
        _ => Ok(()),
    }
}

fn refuse<T>(message: String, help: &str) -> Result<T, Box<Diagnostic>> {
    Err(Box::new(unusable(message).help(help)))
}

/// A param that varies.
struct VaryingParam {
    name: String,
    /// SI unit of its values; empty for a pure number.
    unit: String,
}

/// A `--vary` argument with values.
enum ParsedArgument {
    Axis(Varying),
    /// A range to sample: index of the param, first and last value (SI).
    Range(usize, [f64; 2]),
}

/// Collects what varies, argument by argument.
struct SpecBuilder<'r> {
    reader: OptionReader<'r>,
    sources: Sources,
    params: Vec<VaryingParam>,
    named_files: Vec<PathBuf>,
}

impl SpecBuilder<'_> {
    fn read(&mut self, argument: &VaryArgument) -> Result<ParsedArgument, Error> {
        Ok(match argument {
            VaryArgument::Even { name, ends, count } => {
                let (param, values) = self.param(name, ends)?;
                let values = Levels::Even { ends: [values[0], values[1]], count: *count };
                ParsedArgument::Axis(Varying { params: vec![param], values })
            }
            VaryArgument::Range { name, ends } => {
                let (param, values) = self.param(name, ends)?;
                ParsedArgument::Range(param, [values[0], values[1]])
            }
            VaryArgument::List { name, values } => {
                let (param, values) = self.param(name, values)?;
                ParsedArgument::Axis(Varying { params: vec![param], values: Levels::Listed(values) })
            }
            VaryArgument::File(path) => ParsedArgument::Axis(self.file(path)?),
        })
    }

    /// Evaluates formulas for a param, each of which it must accept; returns its index and their values (SI).
    fn param(&mut self, name: &str, formulas: &[String]) -> Result<(usize, Vec<f64>), Error> {
        let read = |formula: &String| Ok::<_, Error>(self.reader.number(name, formula)?.1);
        let numbers = formulas.iter().map(read).collect::<Result<Vec<OptionNumber>, Error>>()?;
        let values = numbers.iter().map(|number| number.si).collect();
        let unit = if numbers.iter().all(|number| !number.is_dimensional && number.si == 0.0) {
            self.unit_of_zeros(name)
        } else {
            let known =
                numbers.iter().find(|number| number.is_dimensional).map_or(Dimension::PURE, |one| one.dimension);
            si_unit(numbers.iter().fold(known, |known, number| known.marked_by(number.dimension)))
        };
        Ok((self.add(name, unit), values))
    }

    /// Returns the SI unit that a param has in the text, for zeros, which have no unit of their own.
    fn unit_of_zeros(&self, name: &str) -> String {
        let param_info = self.reader.checked.settable_params().into_iter().find(|param| param.name == name);
        let unit = param_info.map(|param| param.unit).unwrap_or_default();
        // a point may have plain numbers as coordinates
        let is_accepted = self.reader.check_with(name, &format!("0 * {}", written(1.0, &unit))).is_ok();
        if is_accepted { unit } else { String::new() }
    }

    fn add(&mut self, name: &str, unit: String) -> usize {
        self.params.push(VaryingParam { name: name.to_owned(), unit });
        self.params.len() - 1
    }

    /// Reads the variants that a table lists, a column for each param.
    fn file(&mut self, path: &Path) -> Result<Varying, Error> {
        self.named_files.push(path.to_owned());
        let file = world::read_rows(self.reader.world, path, &mut self.sources);
        let file = file.map_err(|why| Error::new(why, &self.sources))?;
        let columns = check::variants(self.sources.get(file), file).map_err(|faults| {
            let mut diagnostics = Diagnostics::default();
            diagnostics.extend(faults);
            Error::new(diagnostics, &self.sources)
        })?;
        let mut params = Vec::with_capacity(columns.len());
        for Column { name, span, dimension, values } in &columns {
            let nonzero = values.iter().copied().find(|value| *value != 0.0);
            let unit = match (dimension, nonzero) {
                (None, None) => self.unit_of_zeros(name),
                (dimension, _) => si_unit(dimension.unwrap_or(Dimension::PURE)),
            };
            let sample = written(nonzero.unwrap_or(0.0), &unit);
            self.reader.check_with(name, &sample).map_err(|why| self.at_header(*span, why))?;
            params.push(self.add(name, unit));
        }
        let rows = columns.first().map_or(0, |column| column.values.len());
        let values = (0..rows).flat_map(|row| columns.iter().map(move |column| column.values[row])).collect();
        Ok(Varying { params, values: Levels::Listed(values) })
    }

    /// Moves diagnostics of a column to its header: the value that was tried is in no text that a user has.
    fn at_header(&self, header: Span, why: Error) -> Error {
        let Error { mut sources, diagnostics, .. } = why;
        let table = self.sources.get(header.file);
        let file = sources.add(table.name.clone(), table.text.clone());
        let mut relabeled = Diagnostics::default();
        for mut diagnostic in diagnostics.iter().cloned() {
            if let Some(label) = diagnostic.labels.first_mut() {
                label.span = Span { file, ..header };
            }
            diagnostic.help.extend(diagnostic.fixes.drain(..).map(|fix| fix.message));
            if self.sources.text(header).ends_with(')') {
                diagnostic.help = vec!["a unit stands in brackets behind the name: `rod [mm]`".to_owned()];
            }
            relabeled.push(diagnostic);
        }
        Error::new(relabeled, &sources)
    }

    fn variants(self, points: Points) -> Result<Variants, Error> {
        let units = self.params.into_iter().map(|param| param.unit).collect();
        Variants::new(points, units, self.sources, VARY)
            .map(|variants| Variants { named_files: self.named_files, ..variants })
    }
}
