//! The numerics: solves constraint systems, follows their motion, and does so for many variants at once. It knows nothing of the language.

pub mod analysis;
pub mod limits;
pub mod solver;
pub mod sweep;
