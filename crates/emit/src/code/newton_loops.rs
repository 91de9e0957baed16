//! Loops of Newton's method, for a single variant and for lanes.

use super::value_locations::Location;
use super::{AT, CodeContext, Printer};
use crate::operand::Operand;
use crate::text::literal;
use mechc_engine::solver::Tear;
use std::ops::Range;

impl<S: CodeContext> Printer<'_, S> {
    pub(super) fn newton(&mut self, range: Range<usize>, tears: &[Tear], text: &mut String) {
        let mut body = String::new();
        for at in range.clone() {
            self.instruction(self.instructions[at], "        ", &mut body);
        }
        for at in range {
            for register in self.instructions[at].writes() {
                if let (Location::BeyondLoop { .. }, Some(name)) =
                    (self.locations.location(register), &self.names[register as usize])
                {
                    *text += &format!("    let mut {name} = 0.0;\n");
                }
            }
        }
        *text += &self.around(tears, &body);
    }

    /// Appends Newton's loop for all lanes.
    pub(super) fn newton_of_lanes(&mut self, range: Range<usize>, tears: &[Tear], text: &mut String) {
        let mut places = Vec::new();
        let (mut begin, mut before) = (String::new(), String::new());
        for (number, tear) in tears.iter().enumerate() {
            let (place, name) = (self.value(tear.x), format!("x{}", number + 1));
            begin += &format!("        {place} = on_grid({place}, {});\n", literal(tear.cell));
            before += &format!("            let {name} = {place};\n");
            self.used.extend(place.arguments());
            places.push(place);
            self.names[tear.x as usize] = Some(Operand::local(name));
        }
        let mut body = String::new();
        for at in range {
            self.instruction(self.instructions[at], "            ", &mut body);
        }
        let (mut after, mut go_on, mut end) = (String::new(), String::new(), String::new());
        for (tear, place) in tears.iter().zip(places) {
            let delta = self.value(tear.delta);
            let number = self.guessed.get(&tear.x).copied().unwrap_or(0);
            let (cell, scale) = (format!("TEAR_CELLS[{number}]"), format!("TEAR_SCALES[{number}]"));
            after += &format!("            newton.record(k, {delta}, {cell}, {scale});\n");
            go_on += &format!("            {place} = newton.next(k, {place}, {delta}, {cell});\n");
            end += &format!("        {place} += {delta};\n");
            self.names[tear.x as usize] = Some(place);
        }
        self.used.insert(AT);
        let lanes = "for k in 0..LANES {\n";
        *text += &format!(
            "    {lanes}{begin}    }}\n    let mut newton = LaneNewton::new();\n    for _ in 0..ITERATIONS {{\n        \
             {lanes}{before}{body}{after}        }}\n        if newton.is_done() {{\n            break;\n        }}\n        \
             {lanes}{go_on}        }}\n    }}\n    newton.note(at);\n    {lanes}{end}    }}\n"
        );
    }

    /// Returns a Newton loop with the given body.
    pub(super) fn around(&mut self, tears: &[Tear], body: &str) -> String {
        let (mut begin, mut after, mut go_on, mut end) = (String::new(), String::new(), String::new(), String::new());
        for tear in tears {
            let (x, delta) = (self.value(tear.x), self.value(tear.delta));
            let (cell, scale) = (literal(tear.cell), literal(tear.scale));
            begin += &format!("    {x} = on_grid({x}, {cell});\n");
            after += &format!("        newton.record({delta}, {cell}, {scale});\n");
            go_on += &format!("        {x} = newton.next({x}, {delta}, {cell});\n");
            end += &format!("    {x} += {delta};\n");
        }
        self.used.insert(AT);
        format!(
            "{begin}    let mut newton = Newton::new();\n    for _ in 0..ITERATIONS {{\n{body}{after}        \
             if newton.is_done() {{\n            break;\n        }}\n{go_on}    }}\n    at.note(&newton);\n{end}"
        )
    }
}
