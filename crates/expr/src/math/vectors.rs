//! Selection of vector instructions at run time, and transposition of rows to columns. The results have the same bits with all
//! instructions: each lane runs the operations that it would run alone, and a product and a sum are never fused. Only this file knows pulp.

use std::array::from_fn;

/// A set of vector instructions that the processor supports.
#[derive(Clone, Copy, Debug)]
pub struct Vectors(Unit);

#[derive(Clone, Copy, Debug)]
enum Unit {
    /// Baseline of the platform.
    Base,
    #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
    Avx2(pulp::x86::V3),
    #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
    Avx512(pulp::x86::V4),
}

impl Vectors {
    /// The baseline instructions of the platform.
    pub const BASE: Vectors = Vectors(Unit::Base);

    /// Names of all sets, the widest last.
    pub const NAMES: [&str; 3] = ["base", "avx2", "avx512"];

    /// Returns the widest set that this processor supports.
    #[must_use]
    pub fn widest() -> Vectors {
        Vectors::NAMES.into_iter().rev().find_map(Vectors::named).unwrap_or(Vectors::BASE)
    }

    /// Returns the set of a name; `None` if the processor does not support it.
    #[must_use]
    pub fn named(name: &str) -> Option<Vectors> {
        match name {
            "base" => Some(Vectors::BASE),
            #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
            "avx2" => pulp::x86::V3::try_new().map(|unit| Vectors(Unit::Avx2(unit))),
            #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
            "avx512" => pulp::x86::V4::try_new().map(|unit| Vectors(Unit::Avx512(unit))),
            _ => None,
        }
    }

    /// Runs a closure with these instructions, as far as it is inlined here: functions that it calls are compiled for the baseline.
    #[inline(always)]
    #[allow(clippy::inline_always)] // code that is not inlined does not get the instructions
    pub fn run<R>(self, work: impl FnOnce() -> R) -> R {
        match self.0 {
            Unit::Base => work(),
            #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
            Unit::Avx2(unit) => unit.vectorize(work),
            #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
            Unit::Avx512(unit) => unit.vectorize(work),
        }
    }
}

/// Number of `f64` in the widest vector register, and in a cache line.
pub const WIDE: usize = 8;

/// Returns the number of `f64` from an address to the next cache line. Writing whole cache lines is faster.
#[must_use]
pub fn numbers_to_cache_line(address: *const f64) -> usize {
    address.align_offset(WIDE * size_of::<f64>()) % WIDE
}

/// A square block of rows.
type Tile = [[f64; WIDE]; WIDE];

impl Vectors {
    /// Transposes rows to columns or back: `from[row][k]` goes to position `first + row` of the `k`th chunk of `to`, where each chunk has
    /// the given length. `to` may have fewer chunks than a row has numbers.
    pub fn turn<const W: usize>(self, from: [&[f64; W]; WIDE], to: &mut [f64], (first, length): (usize, usize)) {
        match self.0 {
            Unit::Base => transpose_tiles(from, to, (first, length), transposed),
            #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
            Unit::Avx2(unit) => unit.vectorize(
                #[inline(always)]
                || transpose_tiles(from, to, (first, length), |tile| transposed_by_fours(unit, tile)),
            ),
            #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
            Unit::Avx512(unit) => unit.vectorize(
                #[inline(always)]
                || transpose_tiles(from, to, (first, length), |tile| transposed_at_once(unit, tile)),
            ),
        }
    }
}

#[inline(always)]
#[allow(clippy::inline_always)] // it is compiled for several kinds of processors, as the transpositions are
fn transpose_tiles<const W: usize>(
    from: [&[f64; W]; WIDE],
    to: &mut [f64],
    (first, length): (usize, usize),
    transposed: impl Fn(&Tile) -> Tile,
) {
    for (part, to) in to.chunks_mut(length * WIDE).enumerate() {
        // no closures: one that is not inlined is compiled for the baseline
        let mut tile = [[0.0; WIDE]; WIDE];
        for (tile_row, row) in tile.iter_mut().zip(from) {
            *tile_row = row.as_chunks().0[part];
        }
        let tile = transposed(&tile);
        for (column, to) in tile.iter().zip(to.chunks_exact_mut(length)) {
            to[first..first + WIDE].copy_from_slice(column);
        }
    }
}

/// Transposes a tile number by number.
fn transposed(tile: &Tile) -> Tile {
    from_fn(|column| from_fn(|row| tile[row][column]))
}

/// Transposes a tile in quarters: exchanges single numbers in pairs, then pairs of numbers.
#[cfg(all(feature = "vectors", target_arch = "x86_64"))]
#[inline(always)]
#[allow(clippy::inline_always)]
fn transposed_by_fours(unit: pulp::x86::V3, tile: &Tile) -> Tile {
    use std::arch::x86_64::__m256d;
    let avx = unit.avx;
    let mut columns = [[0.0; WIDE]; WIDE];
    for [top, left] in [[0, 0], [0, 4], [4, 0], [4, 4]] {
        let mut rows: [__m256d; 4] = pulp::cast([[0.0_f64; 4]; 4]);
        for (row, from) in rows.iter_mut().zip(&tile[top..]) {
            let [first, second] = pulp::cast::<[f64; WIDE], [__m256d; 2]>(*from);
            *row = if left == 0 { first } else { second };
        }
        let [a, b, c, d] = rows;
        let [even, odd] = [avx._mm256_unpacklo_pd(a, b), avx._mm256_unpackhi_pd(a, b)];
        let [even_below, odd_below] = [avx._mm256_unpacklo_pd(c, d), avx._mm256_unpackhi_pd(c, d)];
        let transposed: [[f64; 4]; 4] = pulp::cast([
            avx._mm256_permute2f128_pd::<0x20>(even, even_below),
            avx._mm256_permute2f128_pd::<0x20>(odd, odd_below),
            avx._mm256_permute2f128_pd::<0x31>(even, even_below),
            avx._mm256_permute2f128_pd::<0x31>(odd, odd_below),
        ]);
        for (to, column) in columns[left..].iter_mut().zip(transposed) {
            to[top..top + 4].copy_from_slice(&column);
        }
    }
    columns
}

/// Transposes all eight rows at once: exchanges single numbers, then pairs, then fours.
#[cfg(all(feature = "vectors", target_arch = "x86_64"))]
#[inline(always)]
#[allow(clippy::inline_always)]
fn transposed_at_once(unit: pulp::x86::V4, tile: &Tile) -> Tile {
    use std::arch::x86_64::__m512d;
    let avx = unit.avx512f;
    macro_rules! pairs {
        (even $a:expr, $b:expr) => {
            avx._mm512_shuffle_f64x2::<0b10_00_10_00>($a, $b)
        };
        (odd $a:expr, $b:expr) => {
            avx._mm512_shuffle_f64x2::<0b11_01_11_01>($a, $b)
        };
    }
    let [a, b, c, d, e, f, g, h]: [__m512d; WIDE] = pulp::cast(*tile);
    // even and odd columns of two rows
    let [ab, cd] = [avx._mm512_unpacklo_pd(a, b), avx._mm512_unpacklo_pd(c, d)];
    let [ef, gh] = [avx._mm512_unpacklo_pd(e, f), avx._mm512_unpacklo_pd(g, h)];
    let [ab_odd, cd_odd] = [avx._mm512_unpackhi_pd(a, b), avx._mm512_unpackhi_pd(c, d)];
    let [ef_odd, gh_odd] = [avx._mm512_unpackhi_pd(e, f), avx._mm512_unpackhi_pd(g, h)];
    // columns 0 and 4, 1 and 5, 2 and 6, 3 and 7 of four rows
    let above = [pairs!(even ab, cd), pairs!(even ab_odd, cd_odd), pairs!(odd ab, cd), pairs!(odd ab_odd, cd_odd)];
    let below = [pairs!(even ef, gh), pairs!(even ef_odd, gh_odd), pairs!(odd ef, gh), pairs!(odd ef_odd, gh_odd)];
    pulp::cast([
        pairs!(even above[0], below[0]),
        pairs!(even above[1], below[1]),
        pairs!(even above[2], below[2]),
        pairs!(even above[3], below[3]),
        pairs!(odd above[0], below[0]),
        pairs!(odd above[1], below[1]),
        pairs!(odd above[2], below[2]),
        pairs!(odd above[3], below[3]),
    ])
}

impl Default for Vectors {
    fn default() -> Vectors {
        Vectors::widest()
    }
}

#[cfg(test)]
mod tests {
    use super::{Vectors, WIDE};
    use std::array::from_fn;

    #[test]
    fn all_instructions_transpose_alike() {
        const COLUMNS: usize = 16;
        let rows: [[f64; COLUMNS]; WIDE] = from_fn(|row| from_fn(|column| (100 * row + column) as f64));
        let (first, length) = (3, 13);
        for vectors in Vectors::NAMES.into_iter().filter_map(Vectors::named) {
            // all chunks, and fewer than a row has numbers
            for count in [COLUMNS, 11] {
                let mut to = vec![-1.0; count * length];
                vectors.turn(rows.each_ref(), &mut to, (first, length));
                for (at, &value) in to.iter().enumerate() {
                    let (column, row) = (at / length, (at % length).checked_sub(first).filter(|row| *row < WIDE));
                    let expected = row.map_or(-1.0, |row| rows[row][column]);
                    assert_eq!(value.to_bits(), expected.to_bits(), "{vectors:?} {count} {at}");
                }
            }
        }
    }
}
