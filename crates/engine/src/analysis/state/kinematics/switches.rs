//! Switches, domain boundaries and signals, which time and motion decide.

use super::Kinematics;
use mechc_ir::program::{BoundaryRegisters, Enclosure, FrozenSwitches, Op, Register, Signal, Stage, Switch};

impl Kinematics {
    /// Selects the switches that stay as they are from now on.
    pub fn freeze(&mut self, time: bool, motion: bool) {
        self.registers.freeze(FrozenSwitches { time, motion });
    }

    /// Sets the switches of time to what they are at a time, and keeps them so.
    pub fn settle_time(&mut self, t: f64) {
        self.freeze(false, true);
        self.set_time(t);
        self.freeze(true, true);
    }

    /// Sets the switches of the motion to what they are at a position, and keeps them so.
    pub fn settle_motion(&mut self, q: &[f64]) {
        self.freeze(true, false);
        // a fault of the position shows when it is solved for
        let _ = self.set_position(q);
        self.freeze(true, true);
    }

    /// Returns the switches, at which the equations may have edges.
    pub fn switches(&self) -> &[Switch] {
        self.program.switches()
    }

    /// Returns the result that a switch has now.
    pub fn switch(&self, switch: &Switch) -> f64 {
        self.registers.get(switch.to)
    }

    /// Gives the switches the results that they had.
    pub fn set_switches(&mut self, kept: &[f64]) {
        for (switch, kept) in self.program.switches().iter().zip(kept) {
            self.registers.set(switch.to, *kept);
        }
    }

    /// Gives the switches the results that they have elsewhere, and keeps them so.
    pub fn take_switches(&mut self, of: &Kinematics) {
        for switch in self.program.switches() {
            self.registers.set(switch.to, of.switch(switch));
        }
        self.freeze(true, true);
    }

    /// Returns the domain boundaries, at which the domains of functions end.
    pub fn boundaries(&self) -> &[BoundaryRegisters] {
        &self.program.outputs.domain_boundaries
    }

    /// Returns a workspace for proofs about domain boundaries of time, or of the motion.
    pub fn enclosure_of_boundaries(&self, on_time: bool) -> Enclosure {
        Enclosure::of_domain_boundaries(&self.program, &self.registers, on_time)
    }

    /// Returns the event function of a domain boundary where time and position were set.
    pub fn gauge(&mut self, boundary: &BoundaryRegisters) -> f64 {
        self.program.run(Stage::DomainBoundaries, &mut self.registers);
        self.registers.get(boundary.gauge)
    }

    /// Returns the event function of a domain boundary of time and its slope where time was set.
    pub fn gauge_and_slope(&mut self, boundary: &BoundaryRegisters) -> [f64; 2] {
        let gauge = self.gauge(boundary);
        [gauge, boundary.slope.map_or(f64::NAN, |slope| self.registers.get(slope))]
    }

    /// Returns the largest term of an event function, which must just have been evaluated.
    pub fn largest_term(&self, boundary: &BoundaryRegisters) -> f64 {
        boundary.terms.iter().map(|&register| self.registers.get(register).abs()).fold(0.0, f64::max)
    }

    /// Encloses from one time (s) to another, coordinates being anywhere in their intervals (middle and reach).
    pub fn enclose_motion(&self, enclosure: &mut Enclosure, times: [f64; 2], q: &[[f64; 2]]) {
        enclosure.set_all(self.program.inputs.coordinates[0], q);
        enclosure.enclose(&self.program, &self.registers, times);
    }

    /// Returns whether a switch would have another result now if it were not frozen.
    pub fn would_switch(&self, switch: &Switch) -> bool {
        let (live, now) = (self.program.live(switch, &self.registers), self.registers.get(switch.to));
        // a value that is not a number is reported elsewhere
        !live.is_nan() && (live + 0.0).to_bits() != (now + 0.0).to_bits()
    }

    /// Returns the value that decides a switch at the present time and position, and its distance from the edge.
    pub fn edge(&self, switch: &Switch) -> (f64, f64) {
        self.program.edge(switch, &self.registers)
    }

    /// Returns whether a switch stands exactly on its edge.
    pub fn is_on_edge(&self, switch: &Switch) -> bool {
        match switch.op {
            Op::Compare { a, b, .. } => self.registers.get(a).total_cmp(&self.registers.get(b)).is_eq(),
            _ => false,
        }
    }

    /// Returns workspaces for proofs about what time alone decides, and about what the motion decides.
    pub fn enclosures(&self) -> [Enclosure; 2] {
        let of = [Enclosure::of_time, Enclosure::of_motion];
        of.map(|enclosure| enclosure(&self.program, &self.registers))
    }

    /// Returns the signals: terms of the equations that time alone decides, but not those that are linear in it.
    pub fn signals(&self) -> Vec<Signal> {
        self.program.signals()
    }

    pub fn read_signals(&self, signals: &[Signal], values: &mut [f64]) {
        for (value, signal) in values.iter_mut().zip(signals) {
            *value = self.registers.get(signal.register);
        }
    }

    pub fn enclosure_of(&self, signals: &[Signal]) -> Enclosure {
        let registers: Vec<Register> = signals.iter().map(|signal| signal.register).collect();
        Enclosure::for_registers(&self.program, &self.registers, &registers)
    }

    /// Encloses signals from one time (s) to another.
    pub fn enclose(&self, enclosure: &mut Enclosure, times: [f64; 2]) {
        enclosure.enclose(&self.program, &self.registers, times);
    }

    /// Returns how much of the mechanism's size each signal moves an equation by, per unit of the signal; `nudge` is the relative change of
    /// the signal by which this is measured.
    pub fn effects(&mut self, signals: &[Signal], q: &[f64], nudge: f64) -> Vec<f64> {
        // a fault of the position shows when it is solved for
        let _ = self.set_position(q);
        let before: Vec<Vec<f64>> = signals
            .iter()
            .map(|signal| {
                let rows = signal.rows.iter().map(|&row| self.phi(row));
                rows.chain(signal.checks.iter().map(|&k| self.check(k))).collect()
            })
            .collect();
        let values: Vec<f64> = signals.iter().map(|signal| self.registers.get(signal.register)).collect();
        let step = |value: f64| nudge * f64::max(value.abs(), 1.0);
        for (signal, value) in signals.iter().zip(&values) {
            self.registers.set(signal.register, value + step(*value));
        }
        let _ = self.set_position(q);
        let effects = signals.iter().zip(&before).zip(&values).map(|((signal, before), value)| {
            let rows = signal.rows.iter().map(|&row| (self.phi(row), self.linear.row_norm(row)));
            let scales = self.system().checks();
            let all = rows.chain(signal.checks.iter().map(|&k| (self.check(k), scales[k].scale)));
            let changes = all.zip(before).map(|((after, scale), before)| (after - before).abs() / scale);
            changes.fold(0.0, f64::max) / step(*value)
        });
        let effects = effects.collect();
        for (signal, value) in signals.iter().zip(values) {
            self.registers.set(signal.register, value);
        }
        let _ = self.set_position(q);
        effects
    }

    /// Returns whether nothing happens from one time (s) to another; see [`Enclosure::is_steady`].
    pub fn is_steady(
        &self,
        enclosure: &mut Enclosure,
        times: [f64; 2],
        coordinates: &[[f64; 2]],
        may_change: impl Fn(Register) -> bool,
    ) -> bool {
        enclosure.is_steady(&self.program, &self.registers, times, coordinates, may_change)
    }
}
