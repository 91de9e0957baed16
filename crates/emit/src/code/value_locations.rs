//! Locations of values: in a loop, in a function, or among the terms that functions pass on.

use super::parts::Part;
use super::{Code, CodeContext};
use mechc_engine::solver::Instruction;
use mechc_ir::program::Register;
use std::ops::Range;

/// Location of a value.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Location {
    /// An input, which no operation writes.
    Given,
    /// A variable that only its function uses, and only within its loop if `of_loop` is not [`STRAIGHT`].
    Local { function: u32, of_loop: u32 },
    /// A variable that its function also uses outside the loop.
    BeyondLoop { function: u32 },
    /// A term that functions pass on.
    Term(u32),
}

/// Number for code outside of loops.
const STRAIGHT: u32 = 0;
/// Number for uses in several functions.
const OTHERS: u32 = u32::MAX;

/// Locations of all values, by their registers.
pub(super) struct ValueLocations<'p, S> {
    context: &'p S,
    instructions: &'p [Instruction],
    of: Vec<Location>,
    is_read: Vec<bool>,
    /// Number of terms that functions pass on.
    pub terms: u32,
    /// Preferred names of values.
    pub result_names: Vec<Option<String>>,
}

impl<'p, S: CodeContext> ValueLocations<'p, S> {
    /// Locates the values of code that is printed in parts.
    pub fn of(code: &Code<'p>, context: &'p S, parts: &[Part<'p>]) -> ValueLocations<'p, S> {
        let mut locations = ValueLocations {
            context,
            instructions: code.instructions,
            of: vec![Location::Given; code.registers],
            is_read: vec![false; code.registers],
            terms: 0,
            result_names: vec![None; code.registers],
        };
        locations.find(parts);
        locations
    }

    /// Returns the location of a value.
    pub fn location(&self, register: Register) -> Location {
        self.of[register as usize]
    }

    /// Returns whether an instruction reads the value.
    pub fn is_read(&self, register: Register) -> bool {
        self.is_read[register as usize]
    }

    /// Finds out which values go beyond their loop or function.
    fn find(&mut self, parts: &[Part<'_>]) {
        let (mut function, mut loops) = (0, STRAIGHT);
        for part in parts {
            match part {
                Part::Straight(pieces) => {
                    for piece in pieces {
                        loops += u32::from(piece.tears.is_some());
                        let of_loop = if piece.tears.is_some() { loops } else { STRAIGHT };
                        self.settle_in(piece.range.clone(), function, of_loop);
                        for tear in piece.tears.unwrap_or(&[]) {
                            // with lanes, other loops use the corrections too
                            let reader = if self.context.has_lanes() { OTHERS } else { function };
                            self.read(tear.x, function, STRAIGHT);
                            self.read(tear.delta, reader, STRAIGHT);
                        }
                    }
                }
                Part::Loop { bodies, tears } => {
                    for body in bodies {
                        self.settle_in(body.clone(), function, STRAIGHT);
                        function += 1;
                    }
                    for register in tears.iter().flat_map(|tear| [tear.x, tear.delta]) {
                        self.read(register, function, STRAIGHT);
                    }
                }
            }
            function += 1;
        }
    }

    fn settle_in(&mut self, range: Range<usize>, function: u32, of_loop: u32) {
        for at in range {
            let instruction = self.instructions[at];
            for register in instruction.reads() {
                self.read(register, function, of_loop);
            }
            if let Some((table, column)) = instruction.column() {
                self.context.cells(table, column).into_iter().for_each(|cell| self.read(cell, function, of_loop));
            }
            for register in instruction.writes() {
                self.of[register as usize] = Location::Local { function, of_loop };
            }
            if let Instruction::Store { column, a } = instruction
                && self.result_names[a as usize].is_none()
            {
                self.result_names[a as usize] = self.context.name(column);
            }
        }
    }

    fn read(&mut self, register: Register, reader: u32, reading_loop: u32) {
        self.is_read[register as usize] = true;
        let location = &mut self.of[register as usize];
        match *location {
            Location::Local { function, .. } | Location::BeyondLoop { function } if function != reader => {
                *location = Location::Term(self.terms);
                self.terms += 1;
            }
            Location::Local { function, of_loop } if of_loop != STRAIGHT && of_loop != reading_loop => {
                *location = Location::BeyondLoop { function };
            }
            _ => {}
        }
    }
}
