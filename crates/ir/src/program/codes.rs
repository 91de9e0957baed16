// The numbers of operations, where they are written as numbers. What runs them in emitted code has this list too, word for word.
// Those that read and write registers alone come with their result, or two, then their operands, then what they are about.

/// `to`, and the place of its number.
pub const NUMBER: u32 = 0;
/// `to`, the array that it is given in, and the place there.
pub const INPUT: u32 = 1;
/// `to`, and the column that it has been stored in.
pub const STORED: u32 = 2;
/// `to`, and the number of the unknown that iteration begins with.
pub const GUESS: u32 = 3;
/// The column to store in, and what.
pub const STORE: u32 = 4;
pub const ADD: u32 = 5;
pub const SUB: u32 = 6;
pub const MUL: u32 = 7;
pub const DIV: u32 = 8;
pub const MUL_ADD: u32 = 9;
pub const MUL_LESS: u32 = 10;
pub const LESS_MUL: u32 = 11;
pub const NEG: u32 = 12;
pub const RECIP: u32 = 13;
pub const SIN_COS: u32 = 14;
/// A multiplier, and the index of the weight that makes it at most 1.
pub const MULTIPLIER: u32 = 15;
/// Residual of an equation, and the index of its bound.
pub const RESIDUAL: u32 = 16;
/// Reciprocal of a pivot, the turn that it counts for, and the index of its weight.
pub const PIVOT: u32 = 17;
pub const UNARY: u32 = 18;
pub const BINARY: u32 = 19;
pub const LESS: u32 = 20;
pub const LESS_EQUAL: u32 = 21;
pub const EQUAL: u32 = 22;
pub const AND: u32 = 23;
pub const OR: u32 = 24;
pub const NOT: u32 = 25;
pub const SELECT: u32 = 26;
pub const EITHER: u32 = 27;
pub const COPY: u32 = 28;
pub const PIECE: u32 = 29;
pub const PICK: u32 = 30;
pub const PRODUCT_OF_THREE: u32 = 31;
pub const SUM_OF_PRODUCTS: u32 = 32;
pub const DIFFERENCE_OF_PRODUCTS: u32 = 33;
pub const SUM_OF_PRODUCTS_TIMES: u32 = 34;
pub const DIFFERENCE_OF_PRODUCTS_TIMES: u32 = 35;
pub const TURN: u32 = 36;
