//! What one writes first: Newton on the full `Φ`, with a general LU, from Taylor's predictor.
//!
//! `Φ`, `Φ_q`, `ν` and `γ` are evaluated by mechc's program; the linear systems are those of another library.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use mechc_ir::ConstraintSystem;
use mechc_ir::program::{Program, Registers, Stage};
use mechc_ir::structure::Determined;
use nalgebra::{DMatrix, DVector, Dyn, LU};

/// A residual below this is none.
const TOLERANCE: f64 = 1e-12;

/// Linear systems with `Φ_q`.
pub trait Linear {
    /// Factors; `value` gives the entries by their position in the pattern.
    fn factor(&mut self, value: impl Fn(usize) -> f64);
    /// Solves for a right side, which becomes the solution.
    fn solve(&self, right: &mut [f64]);
}

/// With a full matrix.
pub struct Dense {
    places: Vec<(usize, usize)>,
    matrix: DMatrix<f64>,
    lu: Option<LU<f64, Dyn, Dyn>>,
}

/// Row and column of each entry, by its position in the pattern.
fn places(system: &ConstraintSystem) -> Vec<(usize, usize)> {
    let columns = |row| system.phi_q().row(row).iter().map(move |&(column, _)| (row, column as usize));
    (0..system.rows().len()).flat_map(columns).collect()
}

impl Dense {
    pub fn new(determined: &Determined) -> Dense {
        let n = determined.system().rows().len();
        Dense { places: places(determined.system()), matrix: DMatrix::zeros(n, n), lu: None }
    }
}

impl Linear for Dense {
    fn factor(&mut self, value: impl Fn(usize) -> f64) {
        for (at, &place) in self.places.iter().enumerate() {
            self.matrix[place] = value(at);
        }
        self.lu = Some(self.matrix.clone().lu());
    }

    fn solve(&self, right: &mut [f64]) {
        let solution = self.lu.as_ref().and_then(|lu| lu.solve(&DVector::from_column_slice(right)));
        right.copy_from_slice(solution.expect("no singular position").as_slice());
    }
}

/// With a sparse matrix, whose pattern is analysed once.
pub struct Sparse {
    /// The position in the pattern of each entry, column by column.
    order: Vec<usize>,
    symbolic: SymbolicLu<usize>,
    matrix: SparseColMat<usize, f64>,
    lu: Option<Lu<usize, f64>>,
}

impl Sparse {
    pub fn new(determined: &Determined) -> Sparse {
        let places = places(determined.system());
        let n = determined.system().rows().len();
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_by_key(|&at| (places[at].1, places[at].0));
        let mut starts = vec![0; n + 1];
        for &(_, column) in &places {
            starts[column + 1] += 1;
        }
        (0..n).for_each(|column| starts[column + 1] += starts[column]);
        let rows = order.iter().map(|&at| places[at].0).collect();
        let pattern = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
        let symbolic = SymbolicLu::try_new(pattern.as_ref()).expect("enough memory");
        Sparse { matrix: SparseColMat::new(pattern, vec![0.0; order.len()]), order, symbolic, lu: None }
    }
}

impl Linear for Sparse {
    fn factor(&mut self, value: impl Fn(usize) -> f64) {
        for (entry, &at) in self.matrix.val_mut().iter_mut().zip(&self.order) {
            *entry = value(at);
        }
        let lu = Lu::try_new_with_symbolic(self.symbolic.clone(), self.matrix.as_ref());
        self.lu = Some(lu.expect("no singular position"));
    }

    fn solve(&self, right: &mut [f64]) {
        let n = right.len();
        let right = faer::MatMut::from_column_major_slice_mut(right, n, 1);
        self.lu.as_ref().expect("factors").solve_in_place(right);
    }
}

/// A motion, followed step by step.
pub struct Newton<'p, L> {
    linear: L,
    program: &'p Program,
    registers: Registers,
    t: f64,
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
}

impl<'p, L: Linear> Newton<'p, L> {
    /// At the first time, from an assembled position.
    pub fn new(linear: L, determined: &Determined, program: &'p Program, q: &[f64]) -> Newton<'p, L> {
        let system = determined.system();
        let params: Vec<f64> = system.params().iter().map(|param| param.value).collect();
        let [t, ..] = system.analysis().expect("an analysis");
        let zero = vec![0.0; q.len()];
        let registers = program.start(&params);
        let mut newton = Newton { linear, program, registers, t, q: q.to_vec(), qd: zero.clone(), qdd: zero };
        newton.step(t);
        newton
    }

    /// q, q̇, q̈ at the next time.
    pub fn step(&mut self, t: f64) -> Vec<f64> {
        let h = t - self.t;
        for k in 0..self.q.len() {
            self.q[k] += h * (self.qd[k] + 0.5 * h * self.qdd[k]);
        }
        self.t = t;
        self.registers.set(self.program.inputs.time, t);
        self.program.run(Stage::Time, &mut self.registers);
        for _ in 0..20 {
            self.evaluate();
            let outputs = &self.program.outputs;
            let mut delta: Vec<f64> = outputs.phi.iter().map(|&register| -self.registers.get(register)).collect();
            let (registers, entries) = (&self.registers, &outputs.phi_q);
            self.linear.factor(|at| registers.get(entries[at]));
            if delta.iter().all(|residual| residual.abs() <= TOLERANCE) {
                return self.derivatives();
            }
            self.linear.solve(&mut delta);
            self.q.iter_mut().zip(&delta).for_each(|(q, delta)| *q += delta);
        }
        panic!("Newton does not arrive at t = {t}");
    }

    fn evaluate(&mut self) {
        self.registers.set_all(self.program.inputs.coordinates[0], &self.q);
        self.program.run(Stage::Position, &mut self.registers);
    }

    fn derivatives(&mut self) -> Vec<f64> {
        let (outputs, [_, qd, ..]) = (&self.program.outputs, self.program.inputs.coordinates);
        self.program.run(Stage::Velocity, &mut self.registers);
        self.qd = outputs.nu().iter().map(|&register| self.registers.get(register)).collect();
        self.linear.solve(&mut self.qd);
        self.registers.set_all(qd, &self.qd);
        self.program.run(Stage::Acceleration, &mut self.registers);
        self.qdd = outputs.gamma().iter().map(|&register| self.registers.get(register)).collect();
        self.linear.solve(&mut self.qdd);
        [&self.q, &self.qd, &self.qdd].into_iter().flatten().copied().collect()
    }
}
