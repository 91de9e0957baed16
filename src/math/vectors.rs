//! Which vector instructions a loop is made of, chosen by what the processor has when it runs: its bits are the same with all of them, for each
//! lane has the operations that it would have alone, and a product and a sum are never fused. The only file that knows pulp.

/// The vector instructions of a processor.
#[derive(Clone, Copy, Debug)]
pub struct Vectors(Unit);

#[derive(Clone, Copy, Debug)]
enum Unit {
    /// What every processor of the platform has.
    Base,
    #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
    Avx2(pulp::x86::V3),
    #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
    Avx512(pulp::x86::V4),
}

impl Vectors {
    /// Those that every processor of the platform has.
    pub const BASE: Vectors = Vectors(Unit::Base);

    /// The names that there are, the widest last.
    pub const NAMES: [&str; 3] = ["base", "avx2", "avx512"];

    /// The widest ones that this processor has.
    #[must_use]
    pub fn widest() -> Vectors {
        Vectors::NAMES.into_iter().rev().find_map(Vectors::named).unwrap_or(Vectors::BASE)
    }

    /// Those of a name; none where this processor does not have them.
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

    /// Does some work with these instructions: as far as that is inlined here, for what is called is compiled for every processor.
    #[inline(always)]
    #[allow(clippy::inline_always)] // what is not inlined does not get the instructions
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

impl Default for Vectors {
    fn default() -> Vectors {
        Vectors::widest()
    }
}
