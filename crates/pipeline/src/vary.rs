//! Which variants a sweep computes: what `--vary` and `--sample` say, read.

use super::checked::VARY;
use super::varied::{Found, Reader, is_of_angles, refuse_twice, si_unit, spaceless, unusable, written};
use super::{Checked, Choice};
use mechc_engine::sweep::{Levels, MOST_OF_SOBOL, Method, Points, Sampling, Varying};
use mechc_lang::check::{self, Column, Setting};
use mechc_lang::model::Dimension;
use mechc_syntax::{self as syntax, ast};
use mechc_text::diag::{Diagnostic, Diagnostics};
use mechc_text::source::{Sources, Span};
use mechc_text::world::{self, World};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// What is to vary, as options say it.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct VaryOptions {
    /// `NAME=A..B:N`, `NAME=A,B,C`, `@FILE.csv`, and with a sample `NAME=A..B`.
    pub params: Vec<String>,
    /// So many points within the ranges without a number of values.
    pub sample: Option<u64>,
    /// How these are spread.
    pub method: Option<Method>,
    /// Which of the samples of its kind it is.
    pub seed: Option<u64>,
}

/// The variants of a mechanism: which of its params vary, and what they are in each.
#[derive(Clone, Debug)]
pub struct Variants {
    points: Points,
    /// By param: the SI unit of its values, as a formula has it; empty for a pure number.
    units: Vec<String>,
    /// By param: one of that unit.
    ones: Vec<ast::Expr>,
    /// With the texts of the options, and of the files that they name.
    sources: Sources,
    named: Vec<PathBuf>,
    /// The numbers of the params that decide how often something is there, once somebody has asked.
    pub(super) deciding: OnceLock<Vec<usize>>,
}

impl Variants {
    /// Of points, and by param the SI unit of its values, empty for a pure number; with the texts of the mechanism, and the option that says
    /// what varies.
    pub(super) fn of(points: Points, units: Vec<String>, mut sources: Sources, option: &str) -> Found<Variants> {
        let mut ones = Vec::with_capacity(units.len());
        for (name, unit) in points.params().iter().zip(&units) {
            let file = sources.add_option(format!("{option} {name}"), written(1.0, unit));
            ones.push(syntax::parse_expression(&sources, file).map_err(|why| (sources.clone(), why))?);
        }
        Ok(Variants { points, units, ones, sources, named: Vec::new(), deciding: OnceLock::new() })
    }

    /// The values of their params.
    #[must_use]
    pub fn points(&self) -> &Points {
        &self.points
    }

    /// By param that varies: the SI unit of its values; `1` for a pure number.
    pub fn units(&self) -> impl Iterator<Item = &str> {
        self.units.iter().map(|unit| if unit.is_empty() { "1" } else { unit.as_str() })
    }

    /// The texts that were read, with those that were known before.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// The files that list variants.
    #[must_use]
    pub fn named_files(&self) -> &[PathBuf] {
        &self.named
    }

    /// What sets the params of a variant, as `--set` takes it: `rod=0.12 m`. It gives the same values, to the bit.
    #[must_use]
    pub fn settings(&self, variant: u64) -> Vec<String> {
        let set = |((name, unit), value): ((&String, &String), f64)| format!("{name}={}", written(value, unit));
        let names = self.points.params().iter().zip(&self.units);
        names.zip(self.values(variant)).map(set).collect()
    }

    /// The same, read.
    pub(super) fn read_settings(&self, values: &[f64]) -> impl Iterator<Item = Setting> {
        let set = |((name, one), &value): ((&String, &ast::Expr), &f64)| {
            let number = ast::Expr { kind: ast::ExprKind::Literal { value, unit: None }, span: one.span };
            let kind = ast::ExprKind::Product(Box::new(number), vec![(ast::Factor::Times, one.clone())]);
            Setting { path: name.clone(), value: ast::Expr { kind, span: one.span } }
        };
        self.points.params().iter().zip(&self.ones).zip(values).map(set)
    }

    /// The values of a variant's params (SI).
    pub(super) fn values(&self, variant: u64) -> Vec<f64> {
        let mut values = vec![0.0; self.points.params().len()];
        self.points.values(variant, &mut values);
        values
    }
}

impl Checked {
    /// The variants that are asked for, of a mechanism that is sound; `choice` is what it was checked with.
    ///
    /// # Errors
    /// Something cannot vary so; with the texts that the diagnostics speak of.
    pub fn variants(
        &self,
        vary: &VaryOptions,
        choice: &Choice,
        world: &dyn World,
    ) -> Result<Variants, (Sources, Diagnostics)> {
        let own = |why: Box<Diagnostic>| (self.sources().clone(), Diagnostics::from(*why));
        let asked = vary.params.iter().map(|text| Asked::of(text)).collect::<Result<Vec<_>, _>>().map_err(own)?;
        refuse_without_counterpart(vary, &asked).map_err(own)?;
        // whether it gets there is seen of each variant, and what is asked for beside the text stands in it already
        let choice = Choice { lead: false, results: Vec::new(), until: None, ..choice.clone() };
        let reader = Reader { parsed: &self.parsed, own: self, choice: &choice, world, option: VARY };
        let mut listing = Listing { reader, sources: self.sources().clone(), params: Vec::new(), named: Vec::new() };
        let mut axes = Vec::new();
        let mut ranges: Option<(usize, Vec<usize>, Vec<[f64; 2]>)> = None;
        for asked in &asked {
            match listing.read(asked)? {
                Read::Varying(axis) => axes.push(axis),
                Read::Range(param, ends) => {
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
        let names: Vec<String> = listing.params.iter().map(|param| param.name.clone()).collect();
        refuse_twice(names.iter(), &choice).map_err(own)?;
        let too_many = || {
            let why = unusable("there are more variants than can be counted".to_owned());
            own(Box::new(why.help("ask for fewer values")))
        };
        let points = Points::new(names, axes).ok_or_else(too_many)?;
        listing.variants(points)
    }
}

/// One `--vary` in its parts.
enum Asked {
    /// `NAME=A..B:N`
    Even { name: String, ends: [String; 2], count: u64 },
    /// `NAME=A..B`
    Range { name: String, ends: [String; 2] },
    /// `NAME=A,B,C`
    List { name: String, values: Vec<String> },
    /// `@FILE.csv`
    File(PathBuf),
}

impl Asked {
    fn of(text: &str) -> Result<Asked, Box<Diagnostic>> {
        if let Some(file) = text.trim().strip_prefix('@') {
            return Ok(Asked::File(PathBuf::from(file.trim())));
        }
        let named = text.split_once('=').map(|(name, rest)| (spaceless(name), rest.trim()));
        let Some((name, rest)) = named.filter(|(name, rest)| !name.is_empty() && !rest.is_empty()) else {
            return refused(format!("`{VARY} {text}` does not say what varies"), FORMS);
        };
        let Some((first, last)) = rest.split_once("..") else {
            return Ok(Asked::List { name, values: between_commas(rest) });
        };
        let (last, count) = match last.rsplit_once(':') {
            None => (last, None),
            Some((last, count)) => (last, Some(count.trim())),
        };
        let ends = [first, last].map(|end| end.trim().to_owned());
        if ends.iter().any(String::is_empty) {
            return refused(format!("`{VARY} {text}` does not say from where to where"), FORMS);
        }
        match count {
            None => Ok(Asked::Range { name, ends }),
            Some(count) => match count.parse() {
                Ok(count) if count > 0 => Ok(Asked::Even { name, ends, count }),
                _ => {
                    let [first, last] = &ends;
                    refused(
                        format!("`{count}` is no number of values for `{name}`"),
                        &format!("a whole number from 1 on is wanted, as in `{VARY} {name}={first}..{last}:50`"),
                    )
                }
            },
        }
    }
}

const FORMS: &str = "write `--vary rod=100mm..200mm:50` for so many values, both ends included, `--vary speed=60rpm,90rpm` for a list,\n\
                     `--vary @variants.csv` for a table, or `--vary rod=100mm..200mm` with `--sample 1000`";

/// What stands between commas that are in no parentheses.
fn between_commas(text: &str) -> Vec<String> {
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

/// Ranges without a number of values and samples need each other.
fn refuse_without_counterpart(vary: &VaryOptions, asked: &[Asked]) -> Result<(), Box<Diagnostic>> {
    let range = asked.iter().find_map(|asked| match asked {
        Asked::Range { name, ends: [first, last] } => Some((name, first, last)),
        _ => None,
    });
    let even = asked.iter().find_map(|asked| match asked {
        Asked::Even { name, .. } => Some(name),
        _ => None,
    });
    let ranges = asked.iter().filter(|asked| matches!(asked, Asked::Range { .. })).count();
    match (range, even, vary.sample) {
        (Some((name, ..)), Some(even), _) => refused(
            format!("`{even}` has a number of values, and `{name}` has none"),
            "give all ranges a number of values, as in `--vary NAME=A..B:50`, or none, with `--sample N` for all of them together",
        ),
        (Some((name, first, last)), None, None) => refused(
            format!("it is not said how many values `{name}` has"),
            &format!(
                "write `{VARY} {name}={first}..{last}:50` for 50, evenly, or add `--sample 1000` for a sample of all ranges"
            ),
        ),
        (None, _, Some(_)) => refused(
            "there is no range to take a sample of".to_owned(),
            "`--sample` is for ranges without a number of values: `--vary rod=100mm..200mm`",
        ),
        (Some(_), None, Some(0)) => refused("a sample has one variant at least".to_owned(), "as in `--sample 1000`"),
        (Some(_), None, Some(_)) if ranges > MOST_OF_SOBOL && vary.method != Some(Method::Random) => refused(
            format!("Sobol's sequence is known here for {MOST_OF_SOBOL} params, and {ranges} are to vary"),
            "add `--method random`",
        ),
        (None, _, None) if vary.method.is_some() || vary.seed.is_some() => {
            let option = if vary.method.is_some() { "--method" } else { "--seed" };
            let said = format!("`{option}` says how a sample is taken, and there is none");
            refused(said, "add `--sample N`, or leave it out")
        }
        _ => Ok(()),
    }
}

fn refused<T>(message: String, help: &str) -> Result<T, Box<Diagnostic>> {
    Err(Box::new(unusable(message).help(help)))
}

/// A param that varies.
struct Param {
    name: String,
    /// The SI unit of its values; empty for a pure number.
    unit: String,
}

/// What one `--vary` says.
enum Read {
    Varying(Varying),
    /// A range that is to be sampled: of which param, first and last (SI).
    Range(usize, [f64; 2]),
}

/// What varies, as far as it is read.
struct Listing<'r> {
    reader: Reader<'r>,
    sources: Sources,
    params: Vec<Param>,
    named: Vec<PathBuf>,
}

impl Listing<'_> {
    fn read(&mut self, asked: &Asked) -> Found<Read> {
        Ok(match asked {
            Asked::Even { name, ends, count } => {
                let (param, values) = self.param(name, ends)?;
                let values = Levels::Even { ends: [values[0], values[1]], count: *count };
                Read::Varying(Varying { params: vec![param], values })
            }
            Asked::Range { name, ends } => {
                let (param, values) = self.param(name, ends)?;
                Read::Range(param, [values[0], values[1]])
            }
            Asked::List { name, values } => {
                let (param, values) = self.param(name, values)?;
                Read::Varying(Varying { params: vec![param], values: Levels::Listed(values) })
            }
            Asked::File(path) => Read::Varying(self.file(path)?),
        })
    }

    /// A param with formulas that it takes, each of which it could be set to: its number, and their values (SI).
    fn param(&mut self, name: &str, formulas: &[String]) -> Found<(usize, Vec<f64>)> {
        let (mut values, mut dimension) = (Vec::with_capacity(formulas.len()), None);
        for formula in formulas {
            let (_, value, found) = self.reader.number(name, formula)?;
            values.push(value);
            dimension = dimension.or(found);
        }
        let texts: Vec<&str> = formulas.iter().map(String::as_str).collect();
        let unit = if dimension.is_none() && values.iter().all(|value| *value == 0.0) {
            self.unit_of_zeros(name)
        } else {
            si_unit(dimension.unwrap_or(Dimension::PURE), texts.iter().any(|text| is_of_angles(text)))
        };
        Ok((self.add(name, unit), values))
    }

    /// The SI unit that a param has in the text, for zeros, which say none.
    fn unit_of_zeros(&self, name: &str) -> String {
        let known = self.reader.own.settable_params().into_iter().find(|param| param.name == name);
        let unit = known.map(|param| param.unit).unwrap_or_default();
        // a point may be one of plain numbers
        let is_its = self.reader.with(name, &format!("0 * {}", written(1.0, &unit))).is_ok();
        if is_its { unit } else { String::new() }
    }

    fn add(&mut self, name: &str, unit: String) -> usize {
        self.params.push(Param { name: name.to_owned(), unit });
        self.params.len() - 1
    }

    /// The variants that a table lists: a column for each param.
    fn file(&mut self, path: &Path) -> Found<Varying> {
        self.named.push(path.to_owned());
        let file = world::rows_given(self.reader.world, path, &mut self.sources);
        let file = file.map_err(|why| (self.sources.clone(), (*why).into()))?;
        let columns = check::variants(self.sources.get(file), file).map_err(|faults| {
            let mut said = Diagnostics::default();
            said.extend(faults);
            (self.sources.clone(), said)
        })?;
        let mut params = Vec::with_capacity(columns.len());
        for Column { name, span, dimension, is_of_angles, values } in &columns {
            let telling = values.iter().copied().find(|value| *value != 0.0);
            let unit = match (dimension, telling) {
                (None, None) => self.unit_of_zeros(name),
                (dimension, _) => si_unit(dimension.unwrap_or(Dimension::PURE), *is_of_angles),
            };
            let tried = written(telling.unwrap_or(0.0), &unit);
            self.reader.with(name, &tried).map_err(|why| self.of_column(*span, why))?;
            params.push(self.add(name, unit));
        }
        let rows = columns.first().map_or(0, |column| column.values.len());
        let values = (0..rows).flat_map(|row| columns.iter().map(move |column| column.values[row])).collect();
        Ok(Varying { params, values: Levels::Listed(values) })
    }

    /// What is wrong with a column, said at its header: the value that was tried stands in no text that a user has.
    fn of_column(&self, header: Span, (mut sources, said): (Sources, Diagnostics)) -> (Sources, Diagnostics) {
        let table = self.sources.get(header.file);
        let file = sources.add(table.name.clone(), table.text.clone());
        let mut moved = Diagnostics::default();
        for mut one in said.iter().cloned() {
            if let Some(label) = one.labels.first_mut() {
                label.span = Span { file, ..header };
            }
            one.help.extend(one.fixes.drain(..).map(|fix| fix.message));
            if self.sources.text(header).ends_with(')') {
                one.help = vec!["a unit stands in brackets behind the name: `rod [mm]`".to_owned()];
            }
            moved.push(one);
        }
        (sources, moved)
    }

    fn variants(self, points: Points) -> Found<Variants> {
        let units = self.params.into_iter().map(|param| param.unit).collect();
        Variants::of(points, units, self.sources, VARY).map(|variants| Variants { named: self.named, ..variants })
    }
}
