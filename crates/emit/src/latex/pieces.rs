//! Typeset formulas with estimates of their widths, and their composition.

/// Largest width of a part of a fraction, which cannot be broken (em).
pub(super) const WIDEST_FRACTION: f64 = 20.0;

/// Width from which a row of factors or arguments may be broken between any two of them (em).
const BREAKABLE: f64 = 20.0;

/// Precedence of a piece.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Level {
    Or,
    And,
    Relation,
    Sum,
    Product,
    /// `sin x`: stands last in a product.
    Function,
    Power,
    Atom,
}

/// Typeset formula.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) text: String,
    /// Estimated width (em).
    pub(super) width: f64,
    /// Nesting depth of fractions.
    pub(super) tall: u32,
    pub(super) level: Level,
    /// True if a minus belongs in front of it.
    pub(super) is_negative: bool,
}

impl Piece {
    pub(super) fn new(text: impl Into<String>, width: f64, level: Level) -> Piece {
        Piece { text: text.into(), width, tall: 0, level, is_negative: false }
    }

    pub(super) fn tall(mut self, tall: u32) -> Piece {
        self.tall = tall;
        self
    }

    /// Returns the piece with its sign, for the beginning of a formula.
    pub(super) fn signed(mut self) -> Piece {
        if self.is_negative {
            self.text.insert(0, '-');
            (self.width, self.level, self.is_negative) = (self.width + 0.8, Level::Sum, false);
        }
        self
    }

    pub(super) fn in_parentheses(self) -> Piece {
        self.enclosed(["(", ")"])
    }

    /// Encloses the piece in delimiters that are as tall as needed and still let a wide piece be broken.
    pub(super) fn enclosed(self, [left, right]: [&str; 2]) -> Piece {
        let piece = self.signed();
        let text = match piece.tall {
            0 => format!("{left}{}{right}", piece.text),
            _ if piece.width <= WIDEST_FRACTION => format!(r"\left{left} {} \right{right}", piece.text),
            _ => format!(r"\biggl{left} {} \biggr{right}", piece.text),
        };
        Piece::new(text, piece.width + 1.4, Level::Atom).tall(piece.tall)
    }

    pub(super) fn at_least(self, level: Level) -> Piece {
        if self.is_negative || self.level < level { self.in_parentheses() } else { self }
    }
}

/// Kind of a factor, in the order of writing: a function last, so that nothing seems to be its argument, and a sum
/// not behind a symbol that it could be taken for an argument of.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rank {
    Number,
    Symbol,
    Sum,
    Function,
}

pub(super) type Factor = (Rank, Piece);

pub(super) fn rank(piece: &Piece) -> Rank {
    match piece.level {
        Level::Function => Rank::Function,
        _ if piece.is_negative
            || piece.level < Level::Product
            || piece.text.ends_with([')', '}']) && piece.tall > 0 =>
        {
            Rank::Sum
        }
        _ => Rank::Symbol,
    }
}

/// Returns a quotient of products, as one fraction or as several if the factors are wide.
pub(super) fn quotient(above: Vec<Factor>, below: Vec<Factor>) -> Piece {
    if below.is_empty() {
        return row(above);
    }
    let mut lines: Vec<Vec<Factor>> = vec![Vec::new()];
    let mut width = 0.0;
    for factor in below {
        if width > 0.0 && width + factor.1.width > WIDEST_FRACTION {
            lines.push(Vec::new());
            width = 0.0;
        }
        width += factor.1.width + 1.5;
        if let Some(line) = lines.last_mut() {
            line.push(factor);
        }
    }
    let whole = row(above.clone());
    let fits = whole.width <= WIDEST_FRACTION && whole.tall <= 1;
    // wide factors stand next to the fraction, except numbers
    let (numbers, rest) = if fits { (Vec::new(), Vec::new()) } else { above.into_iter().partition(is_number) };
    let mut top = if fits { whole } else { row(numbers) };
    let is_negative = std::mem::take(&mut top.is_negative);
    let mut factors: Vec<Factor> = Vec::new();
    for line in lines {
        let bottom = row(line).signed();
        let width = top.width.max(bottom.width) + 0.4;
        let text = format!(r"\frac{{{}}}{{{}}}", top.text, bottom.text);
        factors.push((Rank::Number, Piece::new(text, width, Level::Product).tall(1 + top.tall.max(bottom.tall))));
        top = Piece::new("1", 0.5, Level::Atom);
    }
    factors.extend(rest);
    let mut piece = row(factors);
    piece.is_negative ^= is_negative;
    piece
}

fn is_number((rank, _): &Factor) -> bool {
    *rank == Rank::Number
}

/// Returns a product as a row of factors.
fn row(mut factors: Vec<Factor>) -> Piece {
    factors.sort_by_key(|(rank, _)| *rank);
    let Some((_, first)) = factors.first() else { return Piece::new("1", 0.5, Level::Atom) };
    if factors.len() == 1 {
        return first.clone();
    }
    let width: f64 = factors.iter().map(|(_, piece)| piece.width + 0.3).sum();
    let mut row = Piece::new("", width, Level::Product);
    let mut before = None;
    for (rank, piece) in factors {
        row.is_negative ^= piece.is_negative;
        let piece = Piece { is_negative: false, ..piece }.at_least(Level::Product);
        row.text += match before {
            None => "",
            // two numbers side by side would be read as one
            Some(Rank::Number) if rank == Rank::Number && !piece.text.starts_with(r"\frac") => r" \cdot ",
            Some(_) if width > BREAKABLE => r" \by ",
            Some(_) => r" \, ",
        };
        row.text += &piece.text;
        row.tall = row.tall.max(piece.tall);
        before = Some(rank);
    }
    row
}

/// Typesets a call of a function of width `width` (em); an operator such as `\sin` takes a lone symbol without parentheses.
pub(super) fn call(word: &str, width: f64, arguments: Vec<Piece>, is_operator: bool) -> Piece {
    if let [argument] = arguments.as_slice()
        && is_operator
        && argument.level == Level::Atom
        && !argument.is_negative
        && !argument.text.ends_with(')')
    {
        let text = format!("{word} {}", argument.text);
        return Piece::new(text, width + argument.width + 0.2, Level::Function).tall(argument.tall);
    }
    let arguments: Vec<Piece> = arguments.into_iter().map(Piece::signed).collect();
    let inside: f64 = arguments.iter().map(|piece| piece.width + 0.5).sum();
    let comma = if inside > BREAKABLE { r",\allowbreak\, " } else { r",\, " };
    let tall = arguments.iter().map(|piece| piece.tall).max().unwrap_or(0);
    let texts: Vec<String> = arguments.into_iter().map(|piece| piece.text).collect();
    let inner = Piece::new(texts.join(comma), inside, Level::Sum).tall(tall).in_parentheses();
    Piece::new(format!("{word}{}", inner.text), width + inner.width, Level::Function).tall(tall)
}
