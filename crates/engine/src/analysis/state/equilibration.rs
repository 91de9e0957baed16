//! Equilibration: a scale for each equation and each coordinate, block by block, which measure the nearness to a singular position.
//!
//! The result must not depend on the unit, on the location of the origin, on drawn features that no equation uses, or on the size of one body
//! relative to the others. So an entry of a block counts with its typical magnitude along a motion, not with its value at one position: the slope of
//! a joint's equation in a turn is that of its lever, in whatever direction the lever points; a formula's slope is also evaluated near the position.
//! The matrix of these magnitudes is equilibrated: every row and every column comes to unit norm (R. Sinkhorn, P. Knopp, 1967). Divided by the same
//! scales, `Φ_q` has entries of about 1 where it is good, and one that vanishes only here is noticed.
//!
//! Where a body's frame lies far from its features, its turn is about their centroid, and its motion is that of the centroid:
//! else turning would be almost the same as moving.

use mechc_expr::math;
use mechc_ir::structure::Block;
use mechc_ir::{BodyId, ConstraintSystem, CoordinateKind, DeclarationKind, IdVec, PointId};
use std::ops::Range;

/// Number of sweeps over rows and columns; the remaining factor is irrelevant.
const SWEEPS: usize = 12;
/// Norm of equilibrated rows: that of a joint's equation in the coordinates of one of its bodies, with the other body fixed.
const ROW_NORM: f64 = 0.5;
/// A centroid counts if it is this many times as far from the origin of the frame as the features are from it.
const FAR_FRAME: f64 = 4.0;
/// Smallest lever of an axis along which another body can approach the features of this one, in sizes of the smaller body.
const LEAST_LEVER: f64 = 0.1;
/// A moment about a centroid below this part of its terms is rounding.
const ROUNDING: f64 = 1e-10;

/// No entry, or no body.
const NONE: u32 = u32::MAX;

/// Entry of `Φ_q` within a block.
#[derive(Clone, Copy)]
struct Entry {
    row: u32,
    column: u32,
    /// In the pattern of `Φ_q`.
    position: u32,
    /// Positions of the same row's slopes in x and y of the same body.
    along: [u32; 2],
    kind: EntryKind,
}

#[derive(Clone, Copy)]
enum EntryKind {
    /// The slope of a joint's equation in a place: which way it points is nothing to its magnitude.
    Place,
    /// The slope in a turn: the lever (m), and the index of the centroid that the body turns about, if not about its origin.
    Turn {
        lever: f64,
        about: u32,
    },
    Other,
}

/// A body of a block that moves and turns with it, whose frame lies far from its features.
#[derive(Clone, Copy, Debug)]
pub struct Centroid {
    /// The column of φ, and its place within the block.
    pub turn: [u32; 2],
    /// The columns of x and y, and their places, as far as they are in the block.
    pub moves: [Option<[u32; 2]>; 2],
    /// Position in the frame of the body (m).
    local: [f64; 2],
    /// Vector from the body's origin, in the global frame, as far as it moves with the block (m).
    pub from_origin: [f64; 2],
}

#[derive(Clone)]
struct Part {
    rows: Range<usize>,
    entries: Range<usize>,
    centroids: Range<usize>,
    /// True if the magnitudes of its entries change along the motion.
    changes: bool,
}

/// Row and column scales of all blocks.
#[derive(Clone)]
pub struct Equilibration {
    parts: Vec<Part>,
    /// Rows and columns in the order of blocks.
    rows: Vec<u32>,
    columns: Vec<u32>,
    entries: Vec<Entry>,
    centroids: Vec<Centroid>,
    /// Magnitudes of the entries, and, by index in the pattern, those of slopes at a nearby position.
    magnitudes: Vec<f64>,
    nearby_slopes: Vec<f64>,
    /// By row and by column: `Φ_q[i, j]·column[j] / row[i]` is what is judged.
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
    /// By column: where no equation has a slope.
    size: Vec<f64>,
    /// By row or by column: the accumulated mean of its entries.
    gathered: Vec<[f64; 2]>,
    is_measured: bool,
}

impl Equilibration {
    pub fn new(system: &ConstraintSystem, blocks: &[Block]) -> Equilibration {
        let n = system.coordinates().len();
        let features = Features::new(system);
        let mut equilibration = Equilibration {
            parts: Vec::with_capacity(blocks.len()),
            rows: Vec::with_capacity(n),
            columns: Vec::with_capacity(n),
            entries: Vec::new(),
            centroids: Vec::new(),
            magnitudes: Vec::new(),
            nearby_slopes: vec![0.0; system.phi_q().entries().len()],
            row_scale: vec![1.0; n],
            column_scale: vec![1.0; n],
            size: system.coordinates().iter().map(|coordinate| coordinate.scale).collect(),
            gathered: vec![[0.0; 2]; n],
            is_measured: false,
        };
        let mut place_of = vec![NONE; n];
        let mut centroid_of = system.bodies().map(|_| NONE);
        for block in blocks {
            for (place, &column) in block.columns.iter().enumerate() {
                place_of[column as usize] = place as u32;
            }
            equilibration.add(system, block, &features, &place_of, &mut centroid_of);
            block.columns.iter().for_each(|&column| place_of[column as usize] = NONE);
        }
        equilibration.magnitudes = vec![0.0; equilibration.entries.len()];
        equilibration
    }

    fn add(
        &mut self,
        system: &ConstraintSystem,
        block: &Block,
        features: &Features,
        place_of: &[u32],
        centroid_of: &mut IdVec<BodyId, u32>,
    ) {
        let (rows, entries, centroids) = (self.rows.len(), self.entries.len(), self.centroids.len());
        self.rows.extend_from_slice(&block.rows);
        self.columns.extend_from_slice(&block.columns);
        let far = features.far_centroids(system, block, place_of);
        for &(body, local) in &far {
            let [x, y, phi] = system.pose_of(body).map(|column| [column as u32, place_of[column]]);
            let moves = [x, y].map(|[column, place]| (place != NONE).then_some([column, place]));
            centroid_of[body] = self.centroids.len() as u32;
            self.centroids.push(Centroid { turn: phi, moves, local, from_origin: local });
        }
        for &row in &block.rows {
            for (position, &(column, _)) in system.phi_q().range(row as usize).zip(system.phi_q().row(row as usize)) {
                if place_of[column as usize] != NONE {
                    let (along, kind) = self.kind_of(system, [row, column], features, centroid_of);
                    self.entries.push(Entry { row, column, position: position as u32, along, kind });
                }
            }
        }
        for (body, _) in far {
            centroid_of[body] = NONE;
        }
        self.parts.push(Part {
            rows: rows..self.rows.len(),
            entries: entries..self.entries.len(),
            centroids: centroids..self.centroids.len(),
            changes: block.rows.iter().any(|&row| changes(system, row as usize)),
        });
    }

    /// Returns the neighboring slopes of an entry, given by row and column, and the kind of its coordinate.
    fn kind_of(
        &self,
        system: &ConstraintSystem,
        [row, column]: [u32; 2],
        features: &Features,
        centroid_of: &IdVec<BodyId, u32>,
    ) -> ([u32; 2], EntryKind) {
        let body = system.body_of(column as usize);
        let along = body.map_or([NONE; 2], |body| {
            let [x, y, _] = system.pose_of(body);
            [x, y].map(|column| slope(system, row, column))
        });
        let kind = match (system.coordinates()[column as usize].kind, body) {
            (CoordinateKind::Angle, Some(body)) => {
                let about = centroid_of[body];
                let centroid = self.centroids.get(about as usize).map_or([0.0; 2], |one| one.local);
                EntryKind::Turn { lever: features.lever(system, row as usize, body, centroid), about }
            }
            (CoordinateKind::Length, Some(_)) if is_of_joint(system, row as usize) => EntryKind::Place,
            _ => EntryKind::Other,
        };
        (along, kind)
    }

    /// Returns whether the magnitudes have been measured.
    pub fn is_measured(&self) -> bool {
        self.is_measured
    }

    /// Returns whether magnitudes change along the motion and must be measured again.
    pub fn changes(&self) -> bool {
        self.parts.iter().any(|part| part.changes)
    }

    pub fn row(&self, row: usize) -> f64 {
        self.row_scale[row]
    }

    pub fn column(&self, column: usize) -> f64 {
        self.column_scale[column]
    }

    /// Returns the centroids of the bodies of a block that turn about theirs.
    pub fn centroids(&self, part: usize) -> &[Centroid] {
        &self.centroids[self.parts[part].centroids.clone()]
    }

    /// Turns the centroids along; `angle` gives a coordinate (rad) by its column.
    pub fn turn(&mut self, angle: impl Fn(usize) -> f64) {
        for centroid in &mut self.centroids {
            let (sin, cos) = math::sin_cos(angle(centroid.turn[0] as usize));
            let [x, y] = centroid.local;
            let [moves_right, moves_up] = centroid.moves.map(|moves| moves.is_some());
            let [right, up] = [x * cos - y * sin, x * sin + y * cos];
            // turning about the centroid moves the origin up by what lies to the right of it
            centroid.from_origin = [if moves_up { right } else { 0.0 }, if moves_right { up } else { 0.0 }];
        }
    }

    /// Returns the magnitude of a slope at a nearby position, by its index in the pattern.
    pub fn nearby_slope(&mut self, position: usize) -> &mut f64 {
        &mut self.nearby_slopes[position]
    }

    /// Measures the slopes at the current position: `slope` gives each by its position in the pattern, and `rounding` gives the rounding
    /// of a row. A slope counts as zero if its product with the size of its coordinate does not exceed that.
    pub fn measure(&mut self, slope: impl Fn(usize) -> f64, rounding: impl Fn(usize) -> f64) {
        for k in 0..self.parts.len() {
            if self.parts[k].changes || !self.is_measured {
                for index in self.parts[k].entries.clone() {
                    let entry = self.entries[index];
                    let magnitude = self.magnitude(entry, &slope);
                    let counts = magnitude * self.size[entry.column as usize] > rounding(entry.row as usize);
                    self.magnitudes[index] = if counts { magnitude } else { 0.0 };
                }
                self.equilibrate(k);
            }
        }
        self.is_measured = true;
    }

    fn magnitude(&self, entry: Entry, slope: &impl Fn(usize) -> f64) -> f64 {
        let slope = |position: u32| if position == NONE { 0.0 } else { slope(position as usize) };
        let [x, y] = entry.along.map(slope);
        let here = slope(entry.position);
        let magnitude = match entry.kind {
            EntryKind::Place => math::hypot(x, y),
            EntryKind::Turn { lever, about: NONE } => f64::max(here.abs(), lever * math::hypot(x, y)),
            EntryKind::Turn { lever, about } => {
                let [right, up] = self.centroids[about as usize].from_origin;
                let (turn, terms) = (here + up * x - right * y, here.abs() + (up * x).abs() + (right * y).abs());
                // rounding of an equation that holds at the centroid is no slope
                let moment = if turn.abs() > ROUNDING * terms { turn.abs() } else { 0.0 };
                return f64::max(moment, lever * math::hypot(x, y));
            }
            EntryKind::Other => here.abs(),
        };
        f64::max(magnitude, self.nearby_slopes[entry.position as usize])
    }

    /// Scales the rows and columns of a block in turn: first such that their largest and smallest entries are as far from 1, by
    /// factors (D. R. Fulkerson, P. Wolfe, 1962), which soon brings together what is of very different size, then to their norm.
    fn equilibrate(&mut self, k: usize) {
        let part = &self.parts[k];
        let (rows, columns) = (&self.rows[part.rows.clone()], &self.columns[part.rows.clone()]);
        let entries = &self.entries[part.entries.clone()];
        let magnitudes = &self.magnitudes[part.entries.clone()];
        for &column in columns {
            self.column_scale[column as usize] = self.size[column as usize];
        }
        let sweeps = if rows.len() == 1 { 0 } else { SWEEPS };
        for sweep in 0..=sweeps {
            let mean = if sweep < sweeps / 2 { Mean::OfExtremes } else { Mean::Norm };
            let gathered = &mut self.gathered;
            for &row in rows {
                gathered[row as usize] = mean.of_none();
            }
            for (entry, magnitude) in entries.iter().zip(magnitudes) {
                let scaled = magnitude * self.column_scale[entry.column as usize];
                mean.gather(&mut gathered[entry.row as usize], scaled);
            }
            for &row in rows {
                self.row_scale[row as usize] = mean.value_or_one(gathered[row as usize]) / ROW_NORM;
            }
            if sweep == sweeps {
                break;
            }
            for &column in columns {
                gathered[column as usize] = mean.of_none();
            }
            for (entry, magnitude) in entries.iter().zip(magnitudes) {
                mean.gather(&mut gathered[entry.column as usize], magnitude / self.row_scale[entry.row as usize]);
            }
            for &column in columns {
                self.column_scale[column as usize] = ROW_NORM / mean.value_or_one(gathered[column as usize]);
            }
        }
    }
}

/// Mean of the entries of a row or column.
#[derive(Clone, Copy)]
enum Mean {
    /// The geometric one of the largest and the smallest.
    OfExtremes,
    Norm,
}

impl Mean {
    fn of_none(self) -> [f64; 2] {
        match self {
            Mean::OfExtremes => [f64::INFINITY, 0.0],
            Mean::Norm => [0.0; 2],
        }
    }

    fn gather(self, [low, high]: &mut [f64; 2], value: f64) {
        match self {
            Mean::OfExtremes if value > 0.0 => (*low, *high) = (low.min(value), high.max(value)),
            Mean::OfExtremes => {}
            Mean::Norm => *high += value * value,
        }
    }

    /// Returns the mean, or 1 if it is zero or not finite.
    fn value_or_one(self, [low, high]: [f64; 2]) -> f64 {
        let value = match self {
            Mean::OfExtremes => low.sqrt() * high.sqrt(),
            Mean::Norm => high.sqrt(),
        };
        if value > 0.0 && value.is_finite() { value } else { 1.0 }
    }
}

/// Returns the index in the pattern of a row's slope in a coordinate.
fn slope(system: &ConstraintSystem, row: u32, column: usize) -> u32 {
    let at = system.phi_q().row(row as usize).binary_search_by_key(&(column as u32), |&(column, _)| column);
    at.map_or(NONE, |at| (system.phi_q().range(row as usize).start + at) as u32)
}

/// Returns whether a row is of a joint or of a distance, whose slopes in places have one magnitude wherever it points.
fn is_of_joint(system: &ConstraintSystem, row: usize) -> bool {
    let declaration = system.declaration_of(row);
    matches!(declaration.kind, DeclarationKind::Joint(_)) || !declaration.points.is_empty()
}

/// Returns whether the magnitudes of a row's slopes change along the motion.
fn changes(system: &ConstraintSystem, row: usize) -> bool {
    match system.declaration_of(row).kind {
        DeclarationKind::Joint(joint) => !joint.is_of_points(),
        _ => system.phi_q().row(row).iter().any(|&(_, slope)| !system.graph().dependence(slope).is_constant()),
    }
}

/// Returns whether a row's slopes need to be evaluated near a position too: it is written by hand, or moves along a curve or line of centres.
pub fn needs_nearby_slope(system: &ConstraintSystem, row: usize) -> bool {
    let slopes = system.phi_q().row(row);
    let has_argument = slopes.iter().any(|&(column, _)| system.body_of(column as usize).is_none());
    let constant = |&(_, slope): &(u32, _)| system.graph().dependence(slope).is_constant();
    (has_argument || !is_of_joint(system, row)) && !slopes.iter().all(constant)
}

/// Locations of features in the frames of their bodies (m), by point.
struct Features {
    places: IdVec<PointId, [f64; 2]>,
}

impl Features {
    fn new(system: &ConstraintSystem) -> Features {
        let formulas: Vec<_> = system.points().iter().flat_map(|point| point.at).collect();
        let mut values = Vec::new();
        if !formulas.is_empty() {
            let value = |symbol| match symbol {
                mechc_expr::Symbol::Param(k) => system.params()[k as usize].value,
                mechc_expr::Symbol::Shift(_) => 0.0,
                _ => f64::NAN,
            };
            system.graph().extend_values(&mut values, value);
        }
        Features { places: system.points().map(|point| point.at.map(|id| values[id.index()])) }
    }

    /// Returns the features of a body that a row speaks of.
    fn of_row<'f>(
        &'f self,
        system: &'f ConstraintSystem,
        row: usize,
        body: BodyId,
    ) -> impl Iterator<Item = [f64; 2]> + 'f {
        let features = &system.declaration_of(row).features;
        features.iter().filter(move |&&k| system.points()[k].body == Some(body)).map(|&k| self.places[k])
    }

    /// Returns the largest distance from a centroid at which a row acts on a body (m).
    fn lever(&self, system: &ConstraintSystem, row: usize, body: BodyId, [x, y]: [f64; 2]) -> f64 {
        // if all features are one point, rounding may put their centroid next to it
        let distance = |at: &[f64; 2]| math::hypot(at[0] - x, at[1] - y);
        let is_lever = |at: &[f64; 2]| distance(at).is_finite() && distance(at) > ROUNDING * math::hypot(x, y);
        let levers = self.of_row(system, row, body).filter(is_lever).map(|at| distance(&at));
        let longest = levers.fold(0.0, f64::max);
        if system.declaration_of(row).axes.is_empty() {
            return longest;
        }
        let bodies = system.phi_q().row(row).iter().filter_map(|&(column, _)| system.body_of(column as usize));
        let smallest = bodies.map(|body| system.size_of(body)).fold(f64::INFINITY, f64::min);
        f64::max(longest, if smallest.is_finite() { LEAST_LEVER * smallest } else { 0.0 })
    }

    /// Returns the bodies of a block that move and turn with it, and whose frames lie far from the features that its equations use, with
    /// the centroids of these features.
    fn far_centroids(&self, system: &ConstraintSystem, block: &Block, place_of: &[u32]) -> Vec<(BodyId, [f64; 2])> {
        let in_block = |column: usize| place_of[column] != NONE;
        let turning = block.columns.iter().filter_map(|&column| {
            let body = system.body_of(column as usize)?;
            let [x, y, phi] = system.pose_of(body);
            let whole = column as usize == phi && (in_block(x) || in_block(y));
            whole.then_some(body)
        });
        let mut places: Vec<(BodyId, [f64; 2])> = Vec::new();
        let bodies: Vec<BodyId> = turning.collect();
        if bodies.is_empty() {
            return Vec::new();
        }
        for &row in &block.rows {
            let mut touched: Vec<BodyId> = system
                .phi_q()
                .row(row as usize)
                .iter()
                .filter_map(|&(column, _)| system.body_of(column as usize))
                .filter(|&body| in_block(system.pose_of(body)[2]))
                .collect();
            touched.dedup();
            for body in touched {
                places.extend(self.of_row(system, row as usize, body).map(|at| (body, at)));
            }
        }
        places.sort_by_key(|&(body, _)| body);
        bodies.into_iter().filter_map(|body| Some((body, far_centroid(&places, body)?))).collect()
    }
}

/// Returns the centroid of a body's features, if the frame lies far from them.
fn far_centroid(places: &[(BodyId, [f64; 2])], body: BodyId) -> Option<[f64; 2]> {
    let start = places.partition_point(|&(other, _)| other < body);
    let features: Vec<[f64; 2]> =
        places[start..].iter().take_while(|&&(other, _)| other == body).map(|&(_, at)| at).collect();
    let count = features.len() as f64;
    let mean = |part: usize| features.iter().map(|at| at[part]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let reach = features.iter().map(|at| math::hypot(at[0] - x, at[1] - y)).fold(0.0, f64::max);
    // with a single feature, about which the body turns, no lever distinguishes turning from moving either
    (math::hypot(x, y) > FAR_FRAME * reach).then_some([x, y])
}
