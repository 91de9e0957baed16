//! Slider ranges: reads `--vary NAME=A..B:N` for pages, where params take values one after the other.

use crate::checked::VARY;
use crate::option_reader::{OptionReader, number_and_unit, refuse_duplicates, si_unit, unusable, written};
use crate::options::spaceless;
use crate::{Checked, Choice};
use mechc_engine::sweep::{linspace_value, round_to_15_digits};
use mechc_lang::check::Amount;
use mechc_lang::model::Dimension;
use mechc_text::diag::{Diagnostic, Error};
use mechc_text::world::World;

/// A slider still has a position for each of this many values.
const MAX_VALUES: usize = 201;
/// Number of params that may vary at once.
const MAX_PARAMS: usize = 2;
/// A page has at most this many variants.
const MAX_VARIANTS: usize = 1000;
/// Values nearer to each other than this fraction of a step are equal.
const EQUAL: f64 = 1e-9;

const EXAMPLE: &str = "as in `--vary rod_length=120mm..180mm:13`";

/// A param with the values of its slider.
#[derive(Clone, PartialEq, Debug)]
pub struct SliderRange {
    /// Path of the param.
    pub name: String,
    /// Unit of the values; `1` for a pure number.
    pub unit: String,
    /// The values in that unit, rising.
    pub values: Vec<f64>,
    /// The setting for each value, as a [`Choice`] takes it.
    pub settings: Vec<String>,
    /// Index of the value nearest to the nominal one.
    pub nearest: usize,
    /// The nominal value in that unit, if it is known and none of the values.
    pub nominal: Option<f64>,
}

/// A `NAME=A..B:N` argument.
struct SliderRequest {
    name: String,
    ends: [String; 2],
    count: usize,
}

impl Checked {
    /// Reads the slider ranges of a mechanism, sound or not; `choice` is what it was checked with.
    ///
    /// # Errors
    /// A param cannot vary as specified; with the texts that the diagnostics point into.
    pub fn slider_ranges(
        &self,
        arguments: &[String],
        choice: &Choice,
        world: &dyn World,
    ) -> Result<Vec<SliderRange>, Error> {
        let with_sources = |why: Box<Diagnostic>| Error::new(why, self.sources());
        let requests = read_requests(arguments).map_err(with_sources)?;
        refuse_duplicates(requests.iter().map(|request| &request.name), choice).map_err(with_sources)?;
        let reader = OptionReader { parsed: &self.parsed, checked: self, choice, world, option: VARY };
        requests.iter().map(|request| reader.slider_range(request)).collect()
    }
}

fn read_requests(arguments: &[String]) -> Result<Vec<SliderRequest>, Box<Diagnostic>> {
    if arguments.len() > MAX_PARAMS {
        let message =
            format!("{} params are to vary, and a page has sliders for {MAX_PARAMS} at most", arguments.len());
        return Err(unusable(message).help("set the others with `--set`").into());
    }
    let requests = arguments.iter().map(|text| SliderRequest::parse(text)).collect::<Result<Vec<_>, _>>()?;
    let variants: usize = requests.iter().map(|request| request.count).product();
    if variants > MAX_VARIANTS {
        let counts: Vec<String> = requests.iter().map(|request| request.count.to_string()).collect();
        let message = format!("{} are {variants} variants, and a page has {MAX_VARIANTS} at most", counts.join(" × "));
        return Err(unusable(message).help("ask for fewer values").into());
    }
    Ok(requests)
}

impl SliderRequest {
    fn parse(text: &str) -> Result<SliderRequest, Box<Diagnostic>> {
        let parts = text.split_once('=').and_then(|(name, rest)| {
            let (interval, count) = rest.rsplit_once(':')?;
            let (first, last) = interval.split_once("..")?;
            Some((name, [first, last], count.trim()))
        });
        let Some((name, ends, count)) = parts.filter(|(name, ..)| !name.trim().is_empty()) else {
            return Err(unusable(format!("`{VARY} {text}` does not say what varies from where to where"))
                .help(format!("write `{VARY} NAME=A..B:N`, {EXAMPLE}: so many values, evenly from A to B"))
                .into());
        };
        let number = count.parse().ok().filter(|count| (2..=MAX_VALUES).contains(count));
        let Some(count) = number else {
            return Err(unusable(format!("`{count}` is no number of values for `{}`", name.trim()))
                .help(format!("a whole number from 2 to {MAX_VALUES} is wanted, {EXAMPLE}"))
                .into());
        };
        Ok(SliderRequest { name: spaceless(name), ends: ends.map(|end| end.trim().to_owned()), count })
    }
}

impl OptionReader<'_> {
    fn slider_range(&self, request: &SliderRequest) -> Result<SliderRange, Error> {
        let SliderRequest { name, ends: [first, last], count } = request;
        let [(low, a), (high, b)] = [self.number(name, first)?, self.number(name, last)?];
        let (at_ends, si) = ([low, high], [a.si, b.si]);
        let refused = |why: Diagnostic| Error::new(why, self.checked.sources());
        let of_param = |checked: &Checked| checked.param_in_part(name);
        if at_ends.iter().any(Checked::is_sound) && at_ends.iter().all(|checked| of_param(checked).is_none()) {
            return Err(refused(decides_counts(name)));
        }
        let dimension = at_ends.iter().find_map(of_param).map_or(Dimension::PURE, |(_, dimension)| dimension);
        let (ends, unit) = same_unit(first, last)
            .unwrap_or_else(|| (si, si_unit(dimension.marked_by(a.dimension).marked_by(b.dimension))));
        let values = grid(ends, *count);
        if values.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(refused(too_near(name, first, last)));
        }
        let settings = values.iter().map(|value| format!("{name}={}", written(*value, &unit))).collect();
        let own =
            self.nominal_value(name).map(|value| ends[0] + (value - si[0]) / (si[1] - si[0]) * (ends[1] - ends[0]));
        let nearest = own.map_or(0, |own| nearest(&values, own));
        let step = (values[1] - values[0]).abs();
        let own =
            own.filter(|own| own.is_finite() && (own - values[nearest]).abs() > EQUAL * step).map(round_to_15_digits);
        let unit = if unit.is_empty() || unit.starts_with('/') { format!("1{unit}") } else { unit };
        Ok(SliderRange { name: name.clone(), unit, values, settings, nearest, nominal: own })
    }

    /// Returns the nominal value (SI), if it is known.
    fn nominal_value(&self, name: &str) -> Option<f64> {
        let written = || {
            let is_param = |name_at| self.checked.sources().text(name_at) == name;
            let value = self.checked.declaration_info().values.iter().find(|value| value.name.is_some_and(is_param))?;
            match value.amount {
                Amount::Number { si, .. } => Some(si),
                Amount::Point(_) => None,
            }
        };
        self.checked.param_in_part(name).map(|(value, _)| value).or_else(written)
    }
}

/// Returns the ends in one unit, if both are plain numbers; zero is of any unit.
fn same_unit(first: &str, last: &str) -> Option<([f64; 2], String)> {
    let [(a, first), (b, last)] = [number_and_unit(first)?, number_and_unit(last)?];
    let unit = match (first, last) {
        _ if first == last => first,
        ("", unit) if a == 0.0 => unit,
        (unit, "") if b == 0.0 => unit,
        _ => return None,
    };
    Some(([a, b], unit.to_owned()))
}

/// Returns values spread evenly from end to end, rising.
fn grid(ends: [f64; 2], count: usize) -> Vec<f64> {
    let count = count as u64;
    let mut values: Vec<f64> = (0..count).map(|k| linspace_value(ends, k, count)).collect();
    if ends[0] > ends[1] {
        values.reverse();
    }
    values
}

fn nearest(values: &[f64], target: f64) -> usize {
    let away = |k: &usize| (values[*k] - target).abs();
    (0..values.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0)
}

fn decides_counts(name: &str) -> Diagnostic {
    unusable(format!("`{name}` decides what is repeated, and cannot vary on a page"))
        .help("write a page for each of its values, with `--set`")
}

fn too_near(name: &str, first: &str, last: &str) -> Diagnostic {
    unusable(format!("`{name}` does not vary from `{first}` to `{last}`")).help("two different values are wanted")
}

#[cfg(test)]
mod tests {
    use super::{SliderRange, grid, number_and_unit};
    use crate::{Choice, Parsed};
    use mechc_text::world::Memory;

    const LEVER: &str = "mechanism lever {
        param length = 50 mm
        param offset = length / 4
        param speed = 60 rpm
        param count = 2
        param A = (10 mm, 0)
        ground { point O = A }
        body bar[k in 0..count] at (0, 0, k * 1 deg) { point O = (offset, 0) point P = (length, 0) }
    }";

    fn varied(arguments: &[&str], set: &[&str]) -> Result<Vec<SliderRange>, Vec<String>> {
        let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>();
        let (world, choice) = (Memory::default(), Choice { set: owned(set), ..Choice::default() });
        let checked = Parsed::new("lever.mech", LEVER).check(&choice, &world);
        checked
            .slider_ranges(&owned(arguments), &choice, &world)
            .map_err(|why| why.diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect())
    }

    fn one(argument: &str) -> SliderRange {
        varied(&[argument], &[]).expect("it can vary").remove(0)
    }

    #[test]
    fn values_are_round() {
        let length = one("length = 40mm .. 60 mm:5");
        assert_eq!((length.name.as_str(), length.unit.as_str()), ("length", "mm"));
        assert_eq!(length.values, [40.0, 45.0, 50.0, 55.0, 60.0]);
        assert_eq!(length.settings[1], "length=45 mm");
        assert_eq!((length.nearest, length.nominal), (2, None));
        assert_eq!(grid([0.1, 0.3], 3), [0.1, 0.2, 0.3]);
        assert_eq!(grid([3.0, -1.0], 3), [-1.0, 1.0, 3.0]);
    }

    #[test]
    fn units_are_as_written_or_si() {
        for (request, unit, values, setting) in [
            ("speed=0..10 rpm:2", "rpm", [0.0, 10.0], "speed=10 rpm"),
            ("length=40mm..0.06m:2", "m", [0.04, 0.06], "length=0.06 m"),
            ("length=2*20mm..60mm:2", "m", [0.04, 0.06], "length=0.06 m"),
            ("speed=1/s..180 deg/s / 30:2", "rad/s", [0.104_719_755_119_659_77, 1.0], "speed=1 rad/s"),
            ("A.x=-1e1mm..5mm:2", "mm", [-10.0, 5.0], "A.x=5 mm"),
        ] {
            let range = one(request);
            assert_eq!((range.unit.as_str(), range.settings[1].as_str()), (unit, setting), "{request}");
            assert!(range.values.iter().zip(values).all(|(a, b)| (a - b).abs() < 1e-15), "{:?}", range.values);
        }
    }

    #[test]
    fn the_nominal_value_is_one_of_the_values_or_kept() {
        let between = one("length=40mm..60mm:4");
        assert_eq!((between.nearest, between.nominal), (1, Some(50.0)));
        let following = one("offset=10mm..20mm:3");
        assert_eq!((following.nearest, following.nominal), (0, Some(12.5)));
        assert_eq!(one("speed=1rpm..2rpm:2").nearest, 1);
    }

    #[test]
    fn impossible_ranges_are_refused() {
        for (arguments, set, expected) in [
            (
                &["length=40mm..60mm"][..],
                &[][..],
                "`--vary length=40mm..60mm` does not say what varies from where to where",
            ),
            (&["length=40mm:3"], &[], "`--vary length=40mm:3` does not say what varies from where to where"),
            (&["length=1mm..2mm:1"], &[], "`1` is no number of values for `length`"),
            (&["length=1mm..2mm:x"], &[], "`x` is no number of values for `length`"),
            (&["length=5mm..0.5e1mm:3"], &[], "`length` does not vary from `5mm` to `0.5e1mm`"),
            (&["length=1..2mm:3"], &[], "the parameter `length` must be a length, found a pure number"),
            (&["length=1mm..2:3"], &[], "the parameter `length` must be a length, found a pure number"),
            (&["lenght=1mm..2mm:3"], &[], "mechanism `lever` has no parameter `lenght`"),
            (&["length=1mm..speed:3"], &[], "a value from outside the file cannot name `speed`"),
            (&["A=1mm..2mm:3"], &[], "`A` is a point, and `--vary` takes numbers: `1mm` cannot be said of it"),
            (
                &["A=(1mm, 0)..(2mm, 0):3"],
                &[],
                "`A` is a point, and `--vary` takes numbers: `(1mm, 0)` cannot be said of it",
            ),
            (&["count=1..4:4"], &[], "`count` decides what is repeated, and cannot vary on a page"),
            (&["length=1mm..2mm:3", "length = 1mm..3mm:3"], &[], "`length` is to vary twice"),
            (&["length=1mm..2mm:3"], &["length=3mm"], "`length` is set, and is to vary"),
            (
                &["length=1mm..2mm:40", "speed=1rpm..2rpm:40"],
                &[],
                "40 × 40 are 1600 variants, and a page has 1000 at most",
            ),
            (&["a", "b", "c"], &[], "3 params are to vary, and a page has sliders for 2 at most"),
        ] {
            let messages = varied(arguments, set).expect_err("it is refused");
            assert_eq!(messages.first().map(String::as_str), Some(expected), "{messages:?}");
        }
    }

    #[test]
    fn numbers_are_no_formulas() {
        for (text, expected) in [
            ("40mm", Some((40.0, "mm"))),
            ("-.5e1 m", Some((-5.0, "m"))),
            ("3", Some((3.0, ""))),
            ("90 deg/s", Some((90.0, "deg/s"))),
            ("2*3mm", None),
            ("1/3", None),
            ("2 mm^2", Some((2.0, "mm^2"))),
            ("3e-4 kg*m^2", Some((3e-4, "kg*m^2"))),
            ("2 N*s/m", Some((2.0, "N*s/m"))),
            ("2 N * s / m", Some((2.0, "N * s / m"))),
            ("3/s", Some((3.0, "/s"))),
            ("(3 mm)", Some((3.0, "mm"))),
            ("-( 3 mm )", Some((-3.0, "mm"))),
            ("3 mm/rod", None),
            ("3 mm*2", None),
            ("(3 mm) + (4 mm)", None),
            ("2 mm^k", None),
            ("inf", None),
            ("4 mm + 1 mm", None),
        ] {
            assert_eq!(number_and_unit(text), expected, "{text}");
        }
    }
}
