//! Tolerance analysis: reads `--tol`, computes derivatives of measures and results at the nominal values, and verifies them at corners.
//!
//! All numbers are those of sweep variants, the nominal one included.

mod deviation;
mod followers;

pub use deviation::{CornerReport, Deviation, DisplayUnit, OutputSensitivity, Tolerance};

use self::followers::Followers;
use crate::checked::TOL;
use crate::option_reader::{OptionReader, number_and_unit, si_unit, unusable};
use crate::options::spaceless;
use crate::{Checked, Choice, Compiled, RequestedTimes, RunOptions, SweepOptions, Variants};
use mechc_engine::sweep::{Levels, Method, Points, Sampling, Status, Swept, Varying};
use mechc_expr::{Binary, Dependence, ExprId, Node, Unary};
use mechc_ir::Measure;
use mechc_ir::layout::ColumnUnit;
use mechc_lang::model::Dimension;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, Error};
use mechc_text::world::World;
use std::collections::BTreeSet;

/// Up to this many params, all corners are computed; with more, the worst corners by derivatives, and a sample.
const MAX_CORNER_PARAMS: usize = 12;
const SAMPLE: u64 = 10_000;

/// A tolerance analysis of a mechanism.
pub struct Tolerancing<'c> {
    checked: &'c Checked,
    choice: &'c Choice,
    world: &'c dyn World,
    tolerances: Vec<Tolerance>,
}

impl Checked {
    /// Reads tolerances, `rod=0.05mm` or `rod=-0.1mm..0mm`, of a sound mechanism; `choice` is what it was checked with.
    ///
    /// # Errors
    /// A param cannot have such a tolerance; with the texts that the diagnostics point into.
    pub fn tolerancing<'c>(
        &'c self,
        arguments: &[String],
        choice: &'c Choice,
        world: &'c dyn World,
    ) -> Result<Tolerancing<'c>, Error> {
        let refused = |why: Diagnostic| Error::new(why, self.sources());
        let plain = Choice { lead: false, results: Vec::new(), ..choice.clone() };
        let reader = OptionReader { parsed: &self.parsed, checked: self, choice: &plain, world, option: TOL };
        let mut tolerances: Vec<Tolerance> = Vec::new();
        for text in arguments {
            let argument = ToleranceArgument::parse(text).map_err(|why| refused(*why))?;
            for tolerance in argument.tolerances(&reader)? {
                if tolerances.iter().any(|other| other.name == tolerance.name) {
                    let why = unusable(format!("`{}` has two tolerances", tolerance.name));
                    return Err(refused(why.help("say one of them")));
                }
                tolerances.push(tolerance);
            }
        }
        Ok(Tolerancing { checked: self, choice, world, tolerances })
    }

    /// Returns params of a name as symbols of the model, with their values (SI); those of all copies if the name has no index.
    fn symbolic_params(&self, name: &str) -> Vec<(String, f64, Dimension)> {
        self.with_symbolic_params(vec![name.to_owned()]).and_then(|symbolic| symbolic.model.clone()).map_or(
            Vec::new(),
            |model| {
                model
                    .continued
                    .iter()
                    .map(|param| (param.declared.name.clone(), param.line[0], param.dimension))
                    .collect()
            },
        )
    }
}

/// A `--tol` argument.
struct ToleranceArgument {
    name: String,
    /// Deviations below and above; one if they are equal.
    ends: Vec<String>,
}

const TOL_HELP: &str =
    "write `--tol rod=0.05mm` for ±0.05 mm, or `--tol rod=-0.1mm..0mm` for what it may be below and above";

impl ToleranceArgument {
    fn parse(text: &str) -> Result<ToleranceArgument, Box<Diagnostic>> {
        let named = text.split_once('=').map(|(name, rest)| (spaceless(name), rest.trim()));
        let refused = |problem: &str| Box::new(unusable(format!("`{TOL} {text}` {problem}")).help(TOL_HELP));
        let Some((name, rest)) = named.filter(|(name, _)| !name.is_empty()) else {
            return Err(refused("does not say what may be off, and how far"));
        };
        let ends: Vec<String> = if let Some((low, high)) = rest.split_once("..") {
            vec![low.trim().to_owned(), high.trim().to_owned()]
        } else {
            let bare = ["±", "+/-", "+-"].iter().find_map(|sign| rest.strip_prefix(sign)).unwrap_or(rest);
            vec![bare.trim().to_owned()]
        };
        if ends.iter().any(String::is_empty) {
            return Err(refused("does not say how far it may be off"));
        }
        Ok(ToleranceArgument { name, ends })
    }

    fn tolerances(&self, reader: &OptionReader<'_>) -> Result<Vec<Tolerance>, Error> {
        let refused = |why: Diagnostic| Error::new(why, reader.checked.sources());
        let params = reader.checked.symbolic_params(&self.name);
        let is_open =
            |(_, nominal, dimension): &(String, f64, Dimension)| *nominal == 0.0 && dimension.is(Dimension::PURE);
        let may_be_open = params.iter().any(is_open);
        let (mut values, mut given) = (Vec::with_capacity(2), Dimension::PURE);
        for end in &self.ends {
            let (checked, number) = reader.number(&self.name, end)?;
            // A literal zero fits any dimension, its deviation does not.
            let unlike =
                checked.diagnostics().iter().filter(|diagnostic| may_be_open && diagnostic.code == Code::E0401);
            let unlike: Diagnostics = unlike.cloned().collect();
            if !unlike.is_empty() {
                return Err(Error::new(unlike, checked.sources()));
            }
            values.push(number.si);
            given = if number.is_dimensional { number.dimension } else { given.marked_by(number.dimension) };
        }
        let range = match values[..] {
            [one] if one < 0.0 => {
                let why = unusable(format!("the tolerance of `{}` is negative: `{}`", self.name, self.ends[0]));
                return Err(refused(why.help(TOL_HELP)));
            }
            [low, high] if low > high => {
                let [low, high] = [&self.ends[0], &self.ends[1]];
                let why = unusable(format!("the tolerance of `{}` goes from `{low}` down to `{high}`", self.name));
                return Err(refused(why.help(TOL_HELP)));
            }
            [low, high] => [low, high],
            _ => [-values[0], values[0]],
        };
        if params.is_empty() {
            let message = format!("`{}` decides what is repeated, and cannot be a little off", self.name);
            return Err(refused(unusable(message).help("give tolerances to lengths, angles and other numbers")));
        }
        let unit_of = |dimension: Dimension| {
            let is_open = dimension.is(Dimension::PURE) && !given.is(Dimension::PURE);
            match si_unit(if is_open { given } else { dimension.marked_by(given) }) {
                unit if unit.is_empty() => "1".to_owned(),
                unit => unit,
            }
        };
        let tolerance = |(name, nominal, dimension): (String, f64, Dimension)| {
            let si = unit_of(dimension);
            let unit = self.unit(reader).unwrap_or((si.clone(), 1.0));
            Tolerance { name, nominal, range, si, unit }
        };
        Ok(params.into_iter().map(tolerance).collect())
    }

    /// Returns the unit of the argument and its value in SI, if all its numbers have that unit.
    fn unit(&self, reader: &OptionReader<'_>) -> Option<(String, f64)> {
        let unit_of =
            |end: &String| number_and_unit(end).filter(|(value, _)| *value != 0.0).map(|(_, unit)| unit.to_owned());
        let unit = self.ends.iter().find_map(unit_of).filter(|unit| !unit.is_empty())?;
        let size = reader.value(&format!("1 {unit}")).ok()?.si;
        let is_of_all = |end: &String| number_and_unit(end).is_some_and(|(value, other)| value == 0.0 || other == unit);
        self.ends.iter().all(is_of_all).then_some((unit, size))
    }
}

impl Tolerancing<'_> {
    /// Returns the tolerances.
    #[must_use]
    pub fn tolerances(&self) -> &[Tolerance] {
        &self.tolerances
    }

    /// Computes derivatives of measures and results by the params. `compiled` is made of the mechanism.
    ///
    /// # Errors
    /// The nominal mechanism does not run, or has no measure and no result; with the texts that the diagnostics point into.
    pub fn sensitivities(&self, compiled: &Compiled, options: &SweepOptions) -> Result<Vec<OutputSensitivity>, Error> {
        let slopes = Some([options.times.from.is_none(), options.times.to.is_none()]);
        let by = self.tolerances.iter().map(|tolerance| tolerance.name.clone()).collect();
        // results that options add are in the tree already
        let choice = Choice { by, slopes, lead: true, results: Vec::new(), ..self.choice.clone() };
        let mut means = if self.tolerances.is_empty() { JumpMeans::default() } else { JumpMeans::new(compiled) };
        let mut checked = self.checked.parsed.check(&Choice { results: means.texts(), ..choice.clone() }, self.world);
        if !checked.is_sound() {
            means = JumpMeans::default();
            checked = self.checked.parsed.check(&choice, self.world);
        }
        let refused = |diagnostics: &Diagnostics| Error::new(diagnostics.clone(), checked.sources());
        if !checked.is_sound() {
            return Err(refused(checked.diagnostics()));
        }
        let (with_slopes, diagnostics) = checked.compile(options.redundant, &options.cancel);
        let with_slopes = with_slopes.ok_or_else(|| refused(&diagnostics))?;
        let outputs = self.tolerated_outputs(&with_slopes, means);
        if outputs.measures.is_empty() && outputs.results.is_empty() {
            let why = unusable("there is no measure and no result that could be off".to_owned())
                .help("add one to the file, or a result with `--result 'stroke = max(x(P)) - min(x(P))'`");
            return Err(refused(&why.into()));
        }
        let followers = checked.model().map_or(Followers::default(), |model| Followers::new(model, &self.tolerances));
        // Nothing is set: a param that followed no other one any more would change what is measured.
        let points = Points::new(Vec::new(), Vec::new()).ok_or_else(|| refused(&Diagnostics::default()))?;
        let variants = Variants::new(points, Vec::new(), checked.sources().clone(), TOL)?;
        let columns = (!outputs.measures.is_empty()).then(|| outputs.columns());
        let options = SweepOptions { columns, jobs: Some(1), ..options.clone() };
        let sweep = checked.sweep(&with_slopes, &variants, &options, |swept| swept);
        let swept: Option<Swept> = sweep?.next();
        let Some(mut swept) = swept else { return Err(refused(&Diagnostics::default())) };
        if !swept.statuses[0].is_complete() {
            return Err(Error::new(nominal_failure(compiled, &options), self.checked.sources()));
        }
        outputs.hold_others(&mut swept, &followers, self.tolerances.len());
        let mut affected = outputs.affected(&swept, &self.tolerances);
        for output in &mut affected {
            output.is_verifiable = !followers.change(&output.name);
        }
        Ok(affected)
    }

    /// For each measure or result, returns the largest nominal value of its SI unit among all and among the params.
    fn largest(&self, affected: &[OutputSensitivity]) -> Vec<f64> {
        let of_params = self.tolerances.iter().map(|tolerance| (&tolerance.si, tolerance.nominal));
        let all: Vec<(&String, f64)> =
            of_params.chain(affected.iter().map(|output| (&output.si, output.nominal))).collect();
        let largest_of = |si: &String| {
            // `f64::max` ignores NaN
            all.iter().filter(|(unit, _)| *unit == si).fold(0.0, |largest: f64, (_, value)| largest.max(value.abs()))
        };
        affected.iter().map(|output| largest_of(&output.si)).collect()
    }

    /// Returns the indices of all params.
    fn all(&self) -> Vec<usize> {
        (0..self.tolerances.len()).collect()
    }

    fn variants(&self, checked: &Checked, axes: Vec<Varying>) -> Result<Variants, Error> {
        let names = self.tolerances.iter().map(|tolerance| tolerance.name.clone()).collect();
        let units = self
            .tolerances
            .iter()
            .map(|tolerance| if tolerance.si == "1" { String::new() } else { tolerance.si.clone() })
            .collect();
        let too_many = || unusable("there are too many corners".to_owned());
        let points = Points::new(names, axes).ok_or_else(too_many)?;
        Variants::new(points, units, checked.sources().clone(), TOL)
    }

    /// Returns the columns and results of a mechanism that is compiled with their derivatives.
    fn tolerated_outputs(&self, compiled: &Compiled, means: JumpMeans) -> ToleratedOutputs {
        let (columns, units) = (compiled.columns(), compiled.units());
        let column_of = |name: &str| columns.iter().position(|column| column == name);
        let by = |name: &str| -> Vec<Option<usize>> {
            self.tolerances.iter().map(|tolerance| column_of(&format!("{name}.by.{}", tolerance.name))).collect()
        };
        let measures = compiled.system().measures().iter().filter_map(|measure| {
            let column = column_of(&measure.name)?;
            let (name, si) = (measure.name.clone(), measure.units.si.clone());
            Some(MeasureColumns { by: by(&name), name, column, unit: units[column].clone(), si })
        });
        let results = compiled.results().into_iter().zip(compiled.variant_results());
        let results = results.map(|((name, unit), (_, si))| (name, unit, si)).collect::<Vec<_>>();
        let nominal_count = results.len() / (self.tolerances.len() + 1) - means.measures.len();
        ToleratedOutputs { measures: measures.collect(), results: results[..nominal_count].to_vec(), means }
    }

    /// Returns the axes of the variants that verify derivatives, and whether they are all corners.
    fn corners(&self, affected: &[OutputSensitivity]) -> (Vec<Vec<Varying>>, bool) {
        let ends: Vec<[f64; 2]> = self.tolerances.iter().map(Tolerance::ends).collect();
        if self.tolerances.len() <= MAX_CORNER_PARAMS {
            let axis = |(param, ends): (usize, &[f64; 2])| {
                let values = if ends[0] < ends[1] { ends.to_vec() } else { vec![ends[0]] };
                Varying { params: vec![param], values: Levels::Listed(values) }
            };
            return (vec![ends.iter().enumerate().map(axis).collect()], true);
        }
        let mut worst: Vec<Vec<f64>> = Vec::new();
        for output in affected {
            for sign in [1.0, -1.0] {
                let end =
                    |(slope, ends): (&Option<f64>, &[f64; 2])| ends[usize::from(sign * slope.unwrap_or(0.0) > 0.0)];
                let corner: Vec<f64> = output.slopes.iter().zip(&ends).map(end).collect();
                if !worst.contains(&corner) {
                    worst.push(corner);
                }
            }
        }
        let corners = Varying { params: self.all(), values: Levels::Listed(worst.concat()) };
        let sample = Sampling::of(ends, SAMPLE, Method::Sobol, None);
        let sample = Varying { params: self.all(), values: Levels::Sampled(Box::new(sample)) };
        (vec![vec![corners], vec![sample]], false)
    }

    /// Returns the number of variants that verification computes.
    #[must_use]
    pub fn count(&self, affected: &[OutputSensitivity]) -> u64 {
        let variants: u64 =
            self.corners(affected).0.iter().map(|axes| axes.iter().map(Varying::count).product::<u64>()).sum();
        variants * CornerSearch::new(affected).sweeps(&SweepOptions::default(), &[]).len() as u64
    }

    /// Computes variants with deviating params; `tick` receives the number of variants that are done. `compiled` is made of the mechanism.
    ///
    /// # Errors
    /// The times are not given; with the texts that the diagnostics point into.
    pub fn verify(
        &self,
        compiled: &Compiled,
        affected: &[OutputSensitivity],
        options: &SweepOptions,
        mut tick: impl FnMut(u64),
    ) -> Result<CornerReport, Error> {
        let (all, are_all_corners) = self.corners(affected);
        let mut search = CornerSearch::new(affected);
        for (group, axes) in all.into_iter().enumerate() {
            let variants = self.variants(self.checked, axes)?;
            search.variants += variants.points().count();
            for sweep_options in search.sweeps(options, &compiled.columns()) {
                for swept in self.checked.sweep(compiled, &variants, &sweep_options, |swept| swept)? {
                    search.take(&swept, sweep_options.columns.is_some(), group, &variants);
                    tick(swept.len() as u64);
                }
            }
        }
        Ok(search.verified(are_all_corners, self.largest(affected)))
    }
}

/// Returns why the nominal mechanism does not run.
fn nominal_failure(compiled: &Compiled, options: &SweepOptions) -> Diagnostics {
    let times = options.times.over(compiled.analysis()).and_then(|times| times.times());
    let times = match times {
        Ok(times) => times,
        Err(why) => return why.diagnostics,
    };
    let SweepOptions { tolerance, pass_bifurcations, ref cancel, .. } = *options;
    let options = RunOptions { tolerance, pass_bifurcations, cancel: cancel.clone(), ..RunOptions::default() };
    let (run, mut diagnostics) = compiled.run(&times, &options);
    if let Some(Err(why)) = run.and_then(|mut run| run.find(Result::is_err)) {
        diagnostics.extend(why.diagnostics);
    }
    if !diagnostics.has_errors() {
        diagnostics.push(unusable("no way leads to what is set along the branch".to_owned()).help("leave `--set` out"));
    }
    diagnostics
}

/// Columns and results that can deviate.
struct ToleratedOutputs {
    measures: Vec<MeasureColumns>,
    results: Vec<(String, ColumnUnit, String)>,
    means: JumpMeans,
}

/// Means of measures that may jump, added after all other results. If the time of a jump depends on a param, the measure has derivatives at all
/// other times, which do not show it; the mean has none.
#[derive(Default)]
struct JumpMeans {
    /// Names of the measures.
    measures: Vec<String>,
}

impl JumpMeans {
    fn new(compiled: &Compiled) -> JumpMeans {
        let system = compiled.system();
        let of_equations: Vec<ExprId> = system.rows().iter().map(|row| row.phi).collect();
        let may_break = |roots: &[ExprId]| {
            let graph = system.graph();
            graph.reachable(roots).into_iter().any(|id| may_jump(graph.node(id)))
        };
        let equations_bend = may_break(&of_equations);
        // velocities and positions do not jump where equations have kinks
        let jumps = |measure: &&Measure| {
            let dependence = system.graph().dependence(measure.value);
            let is_driven = dependence.highest_order() >= Some(2) || dependence.on(Dependence::FORCES);
            may_break(&[measure.value]) || (is_driven && (equations_bend || dependence.on(Dependence::FORCES)))
        };
        JumpMeans { measures: system.measures().iter().filter(jumps).map(|measure| measure.name.clone()).collect() }
    }

    fn texts(&self) -> Vec<String> {
        self.measures.iter().enumerate().map(|(k, name)| format!("mean_that_may_jump_{k} = mean({name})")).collect()
    }
}

/// Returns whether the value of a node may jump.
fn may_jump(node: Node) -> bool {
    matches!(
        node,
        Node::Compare(..) | Node::Binary(Binary::Atan2 | Binary::Mod, ..) | Node::Unary(Unary::Floor | Unary::Sign, _)
    )
}

struct MeasureColumns {
    name: String,
    column: usize,
    /// For each tolerance, the column of the derivative, if there is one.
    by: Vec<Option<usize>>,
    unit: ColumnUnit,
    si: String,
}

/// Values of a measure over the times of the nominal variant.
struct Rows<'s> {
    times: &'s [f64],
    values: &'s [f64],
    /// For each tolerance, the derivative, if there is one.
    slopes: Vec<Option<&'s [f64]>>,
}

impl ToleratedOutputs {
    /// Returns the columns of the time, and of each measure with its derivatives.
    fn columns(&self) -> Vec<usize> {
        let columns = |measure: &MeasureColumns| {
            [measure.column].into_iter().chain(measure.by.iter().copied().flatten()).collect()
        };
        [0].into_iter().chain(self.measures.iter().flat_map(|measure| -> Vec<usize> { columns(measure) })).collect()
    }

    /// Makes derivatives of those along the formulas of the text that hold all other params with tolerances.
    fn hold_others(&self, swept: &mut Swept, followers: &Followers, count: usize) {
        if followers.is_empty() {
            return;
        }
        let mut next = 1;
        for measure in &self.measures {
            // behind the measure stand its derivatives
            let mut last = next;
            let mut place = |by: &Option<usize>| {
                last += usize::from(by.is_some());
                by.map(|_| last)
            };
            let places: Vec<Option<usize>> = measure.by.iter().map(&mut place).collect();
            next = last + 1;
            for row in 0..swept.columns[0].len() {
                let slope = |place: &Option<usize>| place.map_or(f64::NAN, |place| swept.columns[place][row]);
                let mut slopes: Vec<f64> = places.iter().map(slope).collect();
                followers.hold_others(&mut slopes);
                for (place, slope) in places.iter().zip(slopes) {
                    if let Some(place) = place {
                        swept.columns[*place][row] = slope;
                    }
                }
            }
        }
        let first = self.results.len() + self.means.measures.len();
        for results in swept.results[first..].chunks_exact_mut(count) {
            let mut slopes: Vec<f64> = results.iter().map(|result| result[0]).collect();
            followers.hold_others(&mut slopes);
            results.iter_mut().zip(slopes).for_each(|(result, slope)| result[0] = slope);
        }
    }

    /// Collects measures and results from the nominal variant.
    fn affected(self, swept: &Swept, tolerances: &[Tolerance]) -> Vec<OutputSensitivity> {
        let (mut columns, mut all) = (swept.columns.iter(), Vec::new());
        let (nominal_count, count) = (self.results.len(), tolerances.len());
        let number = |k: usize| Some(swept.results[k][0]).filter(|value| value.is_finite());
        let all_results = nominal_count + self.means.measures.len();
        let jumps = |measure: &MeasureColumns| -> Vec<bool> {
            let mean = self
                .means
                .measures
                .iter()
                .position(|name| *name == measure.name)
                .filter(|k| number(nominal_count + k).is_some());
            let slope = |k: usize, j: usize| number(all_results + (nominal_count + k) * count + j);
            (0..count).map(|j| mean.is_some_and(|k| slope(k, j).is_none())).collect()
        };
        if let Some(times) = columns.next() {
            for measure in self.measures {
                let Some(values) = columns.next() else { break };
                let slopes =
                    measure.by.iter().map(|by| by.and_then(|_| columns.next().map(|column| &**column))).collect();
                let rows = Rows { times, values, slopes };
                let jumps = jumps(&measure);
                all.push(if jumps.contains(&true) {
                    where_it_jumps(measure, &rows, &jumps)
                } else {
                    where_it_is_worst(measure, &rows, tolerances)
                });
            }
        }
        all.extend(self.results.into_iter().enumerate().map(|(k, (name, unit, si))| OutputSensitivity {
            name,
            at: None,
            nominal: swept.results[k][0],
            unit,
            si,
            slopes: (0..count).map(|j| number(all_results + k * count + j)).collect(),
            unknown: [0, 1],
            is_verifiable: true,
        }));
        all
    }
}

/// Returns a measure after its largest jump, without derivatives by the params that move the jump.
fn where_it_jumps(measure: MeasureColumns, rows: &Rows<'_>, jumps: &[bool]) -> OutputSensitivity {
    let Rows { times, values, slopes } = rows;
    let change = |row: &usize| (values[*row] - values[*row - 1]).abs();
    let widest = (1..times.len()).filter(|row| change(row).is_finite()).max_by(|a, b| change(a).total_cmp(&change(b)));
    let row = widest.or_else(|| values.iter().position(|value| value.is_finite()));
    let number = |column: &[f64]| row.map(|row| column[row]).filter(|value| value.is_finite());
    let slopes = slopes.iter().zip(jumps).map(|(slope, jumps)| slope.filter(|_| !jumps).and_then(number));
    OutputSensitivity {
        at: row.map(|row| times[row]).or(times.first().copied()),
        nominal: number(values).unwrap_or(f64::NAN),
        slopes: slopes.collect(),
        unknown: [0, times.len() as u64],
        is_verifiable: true,
        name: measure.name,
        unit: measure.unit,
        si: measure.si,
    }
}

/// Returns a measure at the time of its largest worst case; at the first time if no derivative is known.
fn where_it_is_worst(measure: MeasureColumns, rows: &Rows<'_>, tolerances: &[Tolerance]) -> OutputSensitivity {
    let Rows { times, values, slopes } = rows;
    let rows: Vec<usize> = (0..times.len()).filter(|&row| values[row].is_finite()).collect();
    let (mut worst, mut unknown) = (None, 0);
    for &row in &rows {
        let at_row = slopes.iter().map(|slope| slope.map_or(f64::NAN, |slope| slope[row]));
        let size = size(at_row.zip(tolerances));
        unknown += u64::from(!size.is_finite());
        if size.is_finite() && worst.is_none_or(|(largest, _)| size > largest) {
            worst = Some((size, row));
        }
    }
    let row = worst.map(|(_, row)| row).or(rows.first().copied());
    let number = |column: &[f64]| row.map(|row| column[row]).filter(|value| value.is_finite());
    OutputSensitivity {
        at: row.map(|row| times[row]).or(times.first().copied()),
        nominal: number(values).unwrap_or(f64::NAN),
        slopes: slopes.iter().map(|slope| slope.and_then(number)).collect(),
        unknown: [unknown, rows.len() as u64],
        is_verifiable: true,
        name: measure.name,
        unit: measure.unit,
        si: measure.si,
    }
}

/// Returns the largest deviation that slopes cause; NaN if one of them is NaN.
fn size<'t>(slopes: impl Iterator<Item = (f64, &'t Tolerance)>) -> f64 {
    let [low, high] = slopes.fold([0.0, 0.0], |[low, high], (slope, tolerance)| {
        let [less, more] = tolerance.times(slope);
        [low + less, high + more]
    });
    // `f64::max` ignores NaN
    if (low + high).is_finite() { f64::max(-low, high) } else { f64::NAN }
}

/// Collects the extreme deviations of measures and results over variants.
struct CornerSearch<'a> {
    affected: &'a [OutputSensitivity],
    /// The times (s) of measures, rising, without repetition.
    times: Vec<f64>,
    extremes: Vec<Option<[f64; 2]>>,
    /// Complete variants without a value: their number, and the settings of the first.
    missing: Vec<Option<(u64, Vec<String>)>>,
    variants: u64,
    /// Variants that did not complete on the branch, by group and index; settings and status of the first.
    lost: BTreeSet<(usize, u64)>,
    first_lost: Option<(Vec<String>, &'static str)>,
}

impl CornerSearch<'_> {
    fn new(affected: &[OutputSensitivity]) -> CornerSearch<'_> {
        let mut times: Vec<f64> = affected.iter().filter_map(|output| output.at).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let (extremes, missing) = (vec![None; affected.len()], vec![None; affected.len()]);
        CornerSearch { affected, times, extremes, missing, variants: 0, lost: BTreeSet::new(), first_lost: None }
    }

    /// Returns the sweeps to compute: one for measures, at their times, and one for results.
    fn sweeps(&self, options: &SweepOptions, columns: &[String]) -> Vec<SweepOptions> {
        let mut sweeps = Vec::with_capacity(2);
        if !self.times.is_empty() {
            let column = |output: &OutputSensitivity| columns.iter().position(|column| *column == output.name);
            let columns = self.affected.iter().filter(|output| output.at.is_some()).filter_map(column).collect();
            let times = RequestedTimes { at: self.times.clone(), ..options.times.clone() };
            sweeps.push(SweepOptions { columns: Some(columns), times, ..options.clone() });
        }
        if self.affected.iter().any(|output| output.at.is_none()) {
            sweeps.push(SweepOptions { columns: None, ..options.clone() });
        }
        sweeps
    }

    /// Adds a block of variants with measures or with results.
    fn take(&mut self, swept: &Swept, has_measures: bool, group: usize, variants: &Variants) {
        let mut first_row = 0;
        for (k, &length) in swept.lengths.iter().enumerate() {
            let (number, status, row) = (swept.first + k as u64, swept.statuses[k], first_row);
            first_row += length;
            if status != Status::Ok {
                self.lost.insert((group, number));
                self.first_lost.get_or_insert_with(|| (variants.settings(number), status.as_str()));
            } else if has_measures {
                self.take_measures(swept, row, || variants.settings(number));
            } else {
                self.take_results(swept, k, || variants.settings(number));
            }
        }
    }

    fn take_measures(&mut self, swept: &Swept, first_row: usize, set: impl Fn() -> Vec<String>) {
        let measures = (0..self.affected.len()).filter_map(|k| Some((k, self.affected[k].at?)));
        for (column, (k, at)) in measures.enumerate().collect::<Vec<_>>() {
            let row = self.times.iter().position(|time| time.total_cmp(&at).is_eq());
            let value = row.and_then(|row| swept.columns.get(column)?.get(first_row + row).copied());
            self.record(k, value.unwrap_or(f64::NAN), &set);
        }
    }

    fn take_results(&mut self, swept: &Swept, variant: usize, set: impl Fn() -> Vec<String>) {
        let results: Vec<usize> = (0..self.affected.len()).filter(|&k| self.affected[k].at.is_none()).collect();
        for (result, k) in results.into_iter().enumerate() {
            self.record(k, swept.results[result][variant], &set);
        }
    }

    fn record(&mut self, k: usize, value: f64, set: impl Fn() -> Vec<String>) {
        let off = value - self.affected[k].nominal;
        if !self.affected[k].is_verifiable {
            return;
        }
        if off.is_finite() {
            let [low, high] = self.extremes[k].unwrap_or([off; 2]);
            self.extremes[k] = Some([low.min(off), high.max(off)]);
        } else if self.affected[k].nominal.is_finite() {
            self.missing[k].get_or_insert_with(|| (0, set())).0 += 1;
        }
    }

    fn verified(self, are_all_corners: bool, largest: Vec<f64>) -> CornerReport {
        let count = self.lost.len() as u64;
        CornerReport {
            variants: self.variants,
            are_all_corners,
            largest,
            found: self.extremes,
            missing: self.missing,
            lost: self.first_lost.map(|(set, status)| (count, set, status)),
        }
    }
}
