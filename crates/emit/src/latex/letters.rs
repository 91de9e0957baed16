//! Names and numbers in LaTeX: what plain `amsmath` and pdflatex can set, each with an estimate of its width.
//!
//! A name may hold any letter of Unicode. Greek letters and Latin ones with an accent are set as such; any other letter is
//! set as its code point, `[6D4B]`, so that every name stays legible, unlike all others, and no engine stumbles over it.

use mechc_expr::number;
use unicode_normalization::char::decompose_canonical;

/// Length beyond which names are cut in formulas and distinguished by a number.
const LONGEST: usize = 24;

/// Number of letters of a long name before it may be broken.
const UNBROKEN: usize = 12;

/// Letters that LaTeX has a command for in mathematics, with their names; `π` gets another form than the number.
const GREEK: &[(char, &str)] = &[
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "varepsilon"),
    ('ϵ', "epsilon"),
    ('ζ', "zeta"),
    ('η', "eta"),
    ('θ', "theta"),
    ('ϑ', "vartheta"),
    ('ι', "iota"),
    ('κ', "kappa"),
    ('λ', "lambda"),
    ('μ', "mu"),
    ('µ', "mu"),
    ('ν', "nu"),
    ('ξ', "xi"),
    ('π', "varpi"),
    ('ρ', "rho"),
    ('ς', "varsigma"),
    ('σ', "sigma"),
    ('τ', "tau"),
    ('υ', "upsilon"),
    ('φ', "varphi"),
    ('ϕ', "phi"),
    ('χ', "chi"),
    ('ψ', "psi"),
    ('ω', "omega"),
    ('Γ', "Gamma"),
    ('Δ', "Delta"),
    ('Θ', "Theta"),
    ('Λ', "Lambda"),
    ('Ξ', "Xi"),
    ('Π', "Pi"),
    ('Σ', "Sigma"),
    ('Υ', "Upsilon"),
    ('Φ', "Phi"),
    ('Ψ', "Psi"),
    ('Ω', "Omega"),
];

/// Letters of the Latin script without a canonical decomposition.
const LATIN: &[(char, &str)] = &[
    ('ß', r"\ss"),
    ('æ', r"\ae"),
    ('Æ', r"\AE"),
    ('œ', r"\oe"),
    ('Œ', r"\OE"),
    ('ø', r"\o"),
    ('Ø', r"\O"),
    ('ł', r"\l"),
    ('Ł', r"\L"),
    ('ı', r"\i"),
    ('ȷ', r"\j"),
];

/// Combining marks, and the accents that set them.
const ACCENTS: &[(char, &str)] = &[
    ('\u{300}', r"\`"),
    ('\u{301}', r"\'"),
    ('\u{302}', r"\^"),
    ('\u{303}', r"\~"),
    ('\u{304}', r"\="),
    ('\u{306}', r"\u"),
    ('\u{307}', r"\."),
    ('\u{308}', "\\\""),
    ('\u{30a}', r"\r"),
    ('\u{30b}', r"\H"),
    ('\u{30c}', r"\v"),
    ('\u{323}', r"\d"),
    ('\u{327}', r"\c"),
    ('\u{331}', r"\b"),
];

/// Font style of the letters of a name in a formula.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Style {
    Upright,
    Italic,
}

/// A piece of a formula: its source, and about how wide it is (em).
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Set {
    pub text: String,
    pub width: f64,
}

/// Returns a name as a symbol of a formula. `number` distinguishes names that are cut.
pub(super) fn symbol(name: &str, style: Style, number: usize) -> Set {
    let (cut, is_cut) = match name.char_indices().nth(LONGEST) {
        Some(_) => (name.char_indices().nth(LONGEST - 6).map_or(name, |(at, _)| &name[..at]), true),
        None => (name, false),
    };
    let mut width: f64 = cut.chars().map(width_of).sum();
    let single = single(cut).filter(|_| !is_cut && style == Style::Italic);
    if let Some(text) = single {
        return Set { text, width };
    }
    let is_mathematical = cut.chars().all(|c| c.is_ascii() || greek(c).is_some());
    let mut letters: String = cut.chars().map(|c| if is_mathematical { in_formula(c) } else { in_text(c) }).collect();
    if is_cut {
        letters += &format!(r"\ldots {}", number + 1);
        width += 4.5;
    }
    let text = match (is_mathematical, style) {
        (true, Style::Upright) => format!(r"\mathrm{{{letters}}}"),
        (true, Style::Italic) => format!(r"\mathit{{{letters}}}"),
        (false, Style::Upright) => format!(r"\text{{{letters}}}"),
        (false, Style::Italic) => format!(r"\text{{\textit{{{letters}}}}}"),
    };
    Set { text, width }
}

/// Returns a name or a file's name in running text; a long one may be broken.
pub(super) fn words(name: &str) -> String {
    let is_long = name.chars().count() > LONGEST;
    let mut text = String::new();
    for (k, c) in name.chars().enumerate() {
        if is_long && k > 0 && k % UNBROKEN == 0 {
            text += r"\allowbreak{}";
        }
        text += &in_text(c);
    }
    text
}

/// Returns a single letter, which needs no font command; the name of a Greek letter stands for it.
fn single(name: &str) -> Option<String> {
    let mut chars = name.chars();
    let (first, rest) = (chars.next()?, chars.next());
    match rest {
        None if first.is_ascii_alphabetic() => Some(first.to_string()),
        None => greek(first).map(|word| format!(r"\{word}")),
        Some(_) => None,
    }
}

fn greek(c: char) -> Option<&'static str> {
    GREEK.iter().find(|(letter, _)| *letter == c).map(|(_, word)| *word)
}

fn in_formula(c: char) -> String {
    match greek(c) {
        Some(word) => format!(r"\{word} "),
        None => in_text(c),
    }
}

fn in_text(c: char) -> String {
    match c {
        '#' | '$' | '%' | '&' | '_' | '{' | '}' => format!(r"\{c}"),
        '\\' => r"\textbackslash{}".to_owned(),
        '~' => r"\textasciitilde{}".to_owned(),
        '^' => r"\textasciicircum{}".to_owned(),
        // these have no place of their own in the old encoding of the fonts
        '<' | '>' | '|' => format!("${c}$"),
        c if c.is_ascii_control() => "?".to_owned(),
        c if c.is_ascii() => c.to_string(),
        c => greek(c).map(|word| format!(r"$\{word}$")).or_else(|| latin(c)).unwrap_or_else(|| code_point(c)),
    }
}

fn latin(c: char) -> Option<String> {
    if let Some((_, command)) = LATIN.iter().find(|(letter, _)| *letter == c) {
        return Some(format!("{command}{{}}"));
    }
    let mut parts = Vec::new();
    decompose_canonical(c, |part| parts.push(part));
    let [base, mark] = parts.as_slice() else { return None };
    let (_, accent) = ACCENTS.iter().find(|(letter, _)| letter == mark)?;
    match base {
        'i' | 'j' => Some(format!(r"{accent}{{\{base}}}")),
        base if base.is_ascii_alphabetic() => Some(format!("{accent}{{{base}}}")),
        _ => None,
    }
}

fn code_point(c: char) -> String {
    format!("[{:04X}]", u32::from(c))
}

fn width_of(c: char) -> f64 {
    match c {
        'm' | 'w' | 'M' | 'W' => 0.95,
        'i' | 'j' | 'l' | 't' | 'f' | 'r' => 0.42,
        c if c.is_ascii_uppercase() => 0.78,
        c if c.is_ascii() => 0.56,
        c if greek(c).is_some() || latin(c).is_some() => 0.8,
        c => 0.53 * code_point(c).len() as f64,
    }
}

/// Returns a number that is not negative, for a reader: twelve digits at most, and multiples of π and simple fractions as what they
/// are.
pub(super) fn numeral(value: f64) -> Set {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    let text = number(rounded);
    if text.chars().filter(char::is_ascii_digit).count() > 9
        && let Some(set) = recognized(value)
    {
        return set;
    }
    match text.split_once('e') {
        Some((digits, exponent)) => {
            let width = 0.52 * digits.len() as f64 + 1.9 + 0.4 * exponent.len() as f64;
            let text =
                if digits == "1" { format!("10^{{{exponent}}}") } else { format!(r"{digits}\cdot 10^{{{exponent}}}") };
            Set { text, width }
        }
        None => Set { width: 0.52 * text.len() as f64, text },
    }
}

/// Returns a number as `nπ/d`, `n/(dπ)` or `n/d` if it equals one of these up to rounding.
fn recognized(value: f64) -> Option<Set> {
    const OF_A_TURN: [f64; 20] = [
        1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 9.0, 10.0, 12.0, 15.0, 18.0, 20.0, 24.0, 30.0, 36.0, 45.0, 60.0, 90.0, 180.0,
    ];
    let whole = |scaled: f64| -> Option<f64> {
        let n = scaled.round();
        let is_whole = (scaled - n).abs() <= 4.0 * f64::EPSILON * n && (1.0..=9999.0).contains(&n);
        is_whole.then_some(n)
    };
    let pi = std::f64::consts::PI;
    let times_pi = |n: f64| if n > 1.0 { format!(r"{n}\pi") } else { r"\pi".to_owned() };
    for d in OF_A_TURN {
        if let Some(n) = whole(value / pi * d) {
            return Some(fraction(&times_pi(n), (d > 1.0).then(|| d.to_string())));
        }
    }
    for d in [1.0, 2.0, 4.0, 8.0] {
        if let Some(n) = whole(value * pi * d) {
            return Some(fraction(&n.to_string(), Some(times_pi(d))));
        }
    }
    for d in 3..=12 {
        if let Some(n) = whole(value * f64::from(d)) {
            return Some(fraction(&n.to_string(), Some(d.to_string())));
        }
    }
    None
}

fn fraction(above: &str, below: Option<String>) -> Set {
    let width = |text: &str| 0.5 * text.replace(r"\pi", "p").len() as f64;
    match below {
        Some(below) => {
            Set { text: format!(r"\tfrac{{{above}}}{{{below}}}"), width: 0.4 + width(above).max(width(&below)) }
        }
        None => Set { text: above.to_owned(), width: width(above) + 0.2 },
    }
}

#[cfg(test)]
mod tests {
    use super::{Style, numeral, symbol, words};

    #[test]
    fn names_are_valid_for_pdflatex() {
        let cases = [
            ("crank_length", r"\mathit{crank\_length}"),
            ("a", "a"),
            ("ω", r"\omega"),
            ("Δx", r"\mathit{\Delta x}"),
            ("länge", r"\text{\textit{l\{a}nge}}".replace(r"\{", "\\\"{").as_str()),
            ("naïf", "\\text{\\textit{na\\\"{\\i}f}}"),
            ("Straße_θ", r"\text{\textit{Stra\ss{}e\_$\theta$}}"),
            ("测", r"\text{\textit{[6D4B]}}"),
            ("ш1", r"\text{\textit{[0448]1}}"),
        ]
        .map(|(name, wanted)| (name, wanted.to_owned()));
        for (name, wanted) in cases {
            assert_eq!(symbol(name, Style::Italic, 0).text, wanted, "{name}");
        }
        assert_eq!(symbol("a", Style::Upright, 0).text, r"\mathrm{a}");
        assert_eq!(symbol("é", Style::Upright, 0).text, r"\text{\'{e}}");
    }

    #[test]
    fn long_names_are_cut_and_stay_apart() {
        let (a, b) = ("a".repeat(200), "a".repeat(201));
        let (a, b) = (symbol(&a, Style::Upright, 4), symbol(&b, Style::Upright, 5));
        assert_eq!(a.text, format!(r"\mathrm{{{}\ldots 5}}", "a".repeat(18)));
        assert!(a.text != b.text && a.width < 16.0);
        assert!(words(&"b".repeat(30)).contains(r"\allowbreak{}"));
    }

    #[test]
    fn words_of_any_file_name_are_harmless() {
        assert_eq!(words("50%_{x}#1 & $2^~.mech"), r"50\%\_\{x\}\#1 \& \$2\textasciicircum{}\textasciitilde{}.mech");
        assert_eq!(words("a\\b\n<c>"), r"a\textbackslash{}b?$<$c$>$");
    }

    #[test]
    fn numerals_match_their_values() {
        let cases = [
            (0.05, "0.05"),
            (3.0, "3"),
            (30.0_f64.to_radians(), r"\tfrac{\pi}{6}"),
            (50.0 * std::f64::consts::PI, r"50\pi"),
            (1.0 / 3.0, r"\tfrac{1}{3}"),
            (0.5 / std::f64::consts::PI, r"\tfrac{1}{2\pi}"),
            (0.1 + 0.2, "0.3"),
            (1.5e-7, r"1.5\cdot 10^{-7}"),
            (1e-9, "10^{-9}"),
            (0.123_456_789_012_345_67, "0.123456789012"),
        ];
        for (value, wanted) in cases {
            assert_eq!(numeral(value).text, wanted);
        }
    }
}
