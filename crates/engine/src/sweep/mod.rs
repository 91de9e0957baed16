//! Many variants of one mechanism: which there are, what they share, and what became of them. They differ in the values of its parameters alone,
//! so that it is lowered, proven and compiled once, with these as symbols at the values of its text.

mod asked;
mod base;
mod each;
mod judge;
mod numbers;
mod points;
mod sheet;
mod sobol;
mod steps;
mod survey;
mod swept;
mod table;
mod team;
mod together;
mod walk;

pub use base::{Arrived, Base, Lost, Whole};
pub use each::{Each, LANES, PART};
pub use numbers::{Numbers, Spare};
pub use points::{Levels, MOST_OF_SOBOL, Method, Points, Sampling, Varying, evenly, rounded};
pub use sheet::SweptColumn;
pub use swept::{OneVariant, Status, Swept};
pub use table::Room;
pub use team::Team;
pub use together::{Together, WantedOfEach};
