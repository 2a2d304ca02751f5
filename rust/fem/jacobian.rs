//! The exact Jacobian of the mixed system, applied to a direction and never formed:
//!     r_u = int (dP/dF : grad du + dP/dH : dH + dp cof F) : grad N dV,
//!     r_p = int m cof F : grad du dV - M dp / K,     dH(x) = sum weight(x - x') dY/dF : grad du(x'),
//! with the slopes kept at every Gauss point. Displacement and pressure both stay unknowns: condensed,
//! the volume's stiffness varies from point to point and no uniform state is near it.
//!
//! `LANES` columns at a time: all elements of a row are equal, and unknowns of equal place in their
//! elements stand together. The memory is a product of harmonics along every line of points.

use super::block::{Block, Field, Memory, RowState};
use super::mesh::Mesh;
use crate::material::kinematics::{cofactor, remembered_slope, Gradient};
use crate::material::stress::{memory_slope, tangent};
use crate::spectral::{Complex64, Lines};
use crate::status::Status;
use crate::threads::Threads;
use crate::watch::Watch;

const LANES: usize = 8;
/// Rows of elements that a thread takes at a time.
const BAND: usize = 2;
type Lane = [f64; LANES];

/// Nodes and points of a biquadratic element.
const MOST_NODES: usize = 9;

/// Slopes at one Gauss point of `LANES` columns, its weight included once.
#[derive(Clone)]
struct Local {
    /// dP/dF at fixed memory, `[component of P * 4 + component of F]`.
    stiffness: [Lane; 16],
    /// dJ/dF.
    volume: [Lane; 4],
}

/// The same for the memory: dP/dH, and dY/dF without the weight.
#[derive(Clone)]
struct Remembering {
    stress: [Lane; 16],
    state: [Lane; 16],
}

/// Means along a row of the slopes at one Gauss point of its elements.
#[derive(Clone)]
pub struct MeanSlopes {
    pub stiffness: [f64; 16],
    pub volume: [f64; 4],
    /// Of dP/dH times the mean of dY/dF.
    pub memory: Option<[f64; 16]>,
}

pub struct Jacobian<'a> {
    pub mesh: &'a Mesh,
    pub bulk_modulus: f64,
    /// Harmonics of the memory's weights along a line, none where nothing is remembered.
    pub memory: Option<Vec<Complex64>>,
    chunks: usize,
    /// `[row][chunk * points + point]`.
    local: Vec<Vec<Local>>,
    remembering: Vec<Vec<Remembering>>,
}

/// Where products take place.
pub struct Room<'t> {
    threads: &'t Threads,
    /// One a thread.
    rows: Vec<RowRoom>,
    /// Forces on the layer above every band of rows, by its uppermost row.
    above: Vec<f64>,
}

/// What a band of rows adds to: forces on its layers and on the one above, volumes.
type Band<'a> = ((&'a mut [f64], &'a mut [f64]), &'a mut [f64]);

/// Room for one row at a time.
#[derive(Clone)]
struct RowRoom {
    lines: Lines,
    /// Unknowns of the layers of a row, each line wrapped round at its end.
    strip: Vec<f64>,
    forces: Vec<f64>,
    pressure: Vec<f64>,
    volume: Vec<f64>,
    stress: Vec<Lane>,
    /// What is remembered, line by line: `[point][component][column]`.
    past: Vec<f64>,
}

impl<'a> Jacobian<'a> {
    /// At the state of `field`, whose rows are in the states `rows`.
    pub fn new(
        block: &Block<'a>,
        field: &Field,
        rows: &[RowState],
        watch: &Watch<'_>,
    ) -> Result<Self, Status> {
        let mesh = block.mesh;
        let memory = match block.memory {
            Memory::Sliding(history) => Some(history.spectrum.clone()),
            Memory::Relaxed | Memory::Given(_) => None,
        };
        let mut jacobian = Self {
            mesh,
            bulk_modulus: block.bulk_modulus,
            memory,
            chunks: mesh.columns.div_ceil(LANES),
            local: Vec::new(),
            remembering: Vec::new(),
        };
        let slopes = |row: usize| jacobian.slopes(block, field, row, &rows[row]);
        let slopes = watch.map(jacobian.size(), mesh.rows, slopes)?;
        (jacobian.local, jacobian.remembering) = slopes.into_iter().unzip();
        Ok(jacobian)
    }

    /// Numbers kept.
    pub fn size(&self) -> usize {
        let a_point = if self.memory.is_some() { 52 } else { 20 };
        a_point * self.mesh.points()
    }

    fn points(&self) -> usize {
        (self.mesh.order + 1).pow(2)
    }

    /// Displacement unknowns, those of the fixed lid left out.
    pub fn displacements(&self) -> usize {
        (self.mesh.layers() - 1) * self.mesh.layer_size()
    }

    /// Displacements, then pressures `[row][mode][column]`.
    pub fn unknowns(&self) -> usize {
        self.displacements() + self.mesh.rows * self.mesh.modes() * self.mesh.columns
    }

    fn slopes(
        &self,
        block: &Block<'_>,
        field: &Field,
        row: usize,
        state: &RowState,
    ) -> (Vec<Local>, Vec<Remembering>) {
        let element = &self.mesh.elements[row];
        let places = self.chunks * self.points();
        let nothing = [[0.0; LANES]; 16];
        let mut local = vec![
            Local {
                stiffness: nothing,
                volume: [[0.0; LANES]; 4],
            };
            places
        ];
        let remembers = self.memory.is_some();
        let empty = Remembering {
            stress: nothing,
            state: nothing,
        };
        let mut remembering = vec![empty; if remembers { places } else { 0 }];
        for column in 0..self.mesh.columns {
            let (chunk, lane) = (column / LANES, column % LANES);
            let pressure = block.element_pressure(field, row, column);
            for (at, line, q) in block.gauss_points(column) {
                let (f, h) = (&state.gradient[line][q], &state.h[line][q]);
                let weight = element.weight[at];
                let modes = element.mode[at].iter().zip(pressure);
                let level = modes.map(|(mode, p)| mode * p).sum();
                let mut d = tangent(f, h, level);
                add_network_slope(block, f, &mut d);
                let place = chunk * self.points() + at;
                put(&mut local[place].stiffness, lane, weight, &d);
                for (to, slope) in local[place].volume.iter_mut().zip(cofactor(f)) {
                    to[lane] = weight * slope;
                }
                if remembers {
                    let target = &mut remembering[place];
                    put(&mut target.stress, lane, weight, &memory_slope(f));
                    put(&mut target.state, lane, 1.0, &remembered_slope(f));
                }
            }
        }
        (local, remembering)
    }

    /// Means along one row at every Gauss point of its elements.
    pub fn means(&self, row: usize) -> Vec<MeanSlopes> {
        let points = self.points();
        (0..points).map(|at| self.mean(row, at)).collect()
    }

    fn mean(&self, row: usize, at: usize) -> MeanSlopes {
        let points = self.points();
        let mut mean = MeanSlopes {
            stiffness: [0.0; 16],
            volume: [0.0; 4],
            memory: None,
        };
        for local in self.local[row].iter().skip(at).step_by(points) {
            add_sums(&mut mean.stiffness, &local.stiffness);
            add_sums(&mut mean.volume, &local.volume);
        }
        let share = 1.0 / self.mesh.columns as f64;
        mean.stiffness.iter_mut().for_each(|sum| *sum *= share);
        mean.volume.iter_mut().for_each(|sum| *sum *= share);
        if self.memory.is_some() {
            let (mut stress, mut state) = ([0.0; 16], [0.0; 16]);
            for past in self.remembering[row].iter().skip(at).step_by(points) {
                add_sums(&mut stress, &past.stress);
                add_sums(&mut state, &past.state);
            }
            mean.memory = Some(std::array::from_fn(|at| {
                let (a, b) = (at / 4, at % 4);
                let products = (0..4).map(|k| stress[4 * a + k] * state[4 * k + b]);
                products.sum::<f64>() * share * share
            }));
        }
        mean
    }

    pub fn room<'t>(&self, threads: &'t Threads) -> Room<'t> {
        let mesh = self.mesh;
        let width = (self.chunks + 1) * LANES;
        let strip = (mesh.order + 1) * 2 * mesh.order * width;
        let row = RowRoom {
            lines: Lines::new(mesh.columns),
            strip: vec![0.0; strip],
            forces: vec![0.0; strip],
            pressure: vec![0.0; mesh.modes() * width],
            volume: vec![0.0; mesh.modes() * width],
            stress: vec![[0.0; LANES]; 4 * self.points() * self.chunks],
            past: vec![0.0; 4 * self.points() * width],
        };
        Room {
            threads,
            rows: vec![row; threads.on(self.size())],
            above: vec![0.0; mesh.rows.div_ceil(BAND) * mesh.layer_size()],
        }
    }

    /// `out` = J `x`.
    pub fn product(&self, x: &[f64], out: &mut [f64], room: &mut Room<'_>) {
        let displacements = self.displacements();
        let (u, p) = x.split_at(displacements);
        let (forces, volumes) = out.split_at_mut(displacements);
        forces.fill(0.0);
        room.above.fill(0.0);
        let (columns, layer) = (self.mesh.columns, self.mesh.layer_size());
        let per_row = self.mesh.modes() * columns;
        let per_band = BAND * self.mesh.order * layer;
        let bands = forces
            .chunks_mut(per_band)
            .zip(room.above.chunks_exact_mut(layer))
            .zip(volumes.chunks_mut(BAND * per_row))
            .enumerate();
        let band = |room: &mut RowRoom, (band, part): (usize, Band<'_>)| {
            let ((forces, above), volumes) = part;
            let mut lines: Vec<&mut [f64]> = forces.chunks_exact_mut(columns).collect();
            lines.extend(above.chunks_exact_mut(columns));
            for (at, volumes) in volumes.chunks_exact_mut(per_row).enumerate() {
                let row = band * BAND + at;
                let lines = &mut lines[2 * self.mesh.order.pow(2) * at..];
                self.row(row, u, &p[row * per_row..][..per_row], room);
                self.collect(lines, room);
                self.volumes(row, &p[row * per_row..][..per_row], volumes, room);
            }
        };
        room.threads.share(self.size(), &mut room.rows, bands, band);
        let next = forces.chunks_mut(per_band).skip(1);
        for (to, above) in next.zip(room.above.chunks_exact(layer)) {
            for (to, force) in to.iter_mut().zip(above) {
                *to += force;
            }
        }
    }

    /// Forces and changes of volume in one row, into `room`.
    fn row(&self, row: usize, u: &[f64], pressure: &[f64], room: &mut RowRoom) {
        self.fill(row, u, room);
        let width = (self.chunks + 1) * LANES;
        for (line, values) in pressure.chunks_exact(self.mesh.columns).enumerate() {
            room.pressure[line * width..][..values.len()].copy_from_slice(values);
        }
        pulp::Arch::new().dispatch(|| match self.mesh.order {
            1 => self.strain::<4>(row, room),
            _ => self.strain::<MOST_NODES>(row, room),
        });
        if let Some(spectrum) = &self.memory {
            for line in room.past.chunks_exact_mut(width) {
                let line = &mut line[..self.mesh.columns];
                room.lines.convolve(spectrum, line);
            }
        }
        room.forces.fill(0.0);
        pulp::Arch::new().dispatch(|| match self.mesh.order {
            1 => self.balance::<4>(row, room),
            _ => self.balance::<MOST_NODES>(row, room),
        });
    }

    /// Where the line of local node `node` begins in a strip, in direction 0.
    fn start(&self, node: usize) -> usize {
        let order = self.mesh.order;
        let (layer, sub) = (node / (order + 1), node % (order + 1));
        let width = (self.chunks + 1) * LANES;
        (2 * layer * order + sub % order) * width + usize::from(sub == order)
    }

    /// Copy the layers of a row into the strip, the lid's as zeros.
    fn fill(&self, row: usize, u: &[f64], room: &mut RowRoom) {
        let mesh = self.mesh;
        let width = (self.chunks + 1) * LANES;
        let from = row * mesh.order * mesh.layer_size();
        let lines = u[from..].chunks_exact(mesh.columns);
        let mut strip = room.strip.chunks_exact_mut(width);
        for (line, to) in lines.zip(&mut strip) {
            to[..mesh.columns].copy_from_slice(line);
            to[mesh.columns] = line[0];
        }
        strip.for_each(|to| to.fill(0.0));
    }

    /// Stresses at fixed memory, changes of volume and of what is remembered.
    #[inline(always)]
    fn strain<const NODES: usize>(&self, row: usize, room: &mut RowRoom) {
        let element = &self.mesh.elements[row];
        let (points, modes) = (self.points(), self.mesh.modes());
        let width = (self.chunks + 1) * LANES;
        let starts: [usize; NODES] = std::array::from_fn(|node| self.start(node));
        let other = self.mesh.order * width;
        for chunk in 0..self.chunks {
            let at = chunk * LANES;
            let u: [[Lane; 2]; NODES] = std::array::from_fn(|node| {
                let from = starts[node] + at;
                [lane(&room.strip, from), lane(&room.strip, from + other)]
            });
            let mut volumes = [[0.0; LANES]; 3];
            for point in 0..points {
                let mut f = [[0.0; LANES]; 4];
                let slopes: &[[f64; 2]] = &element.gradient[point];
                for node in 0..NODES {
                    let [x, z] = slopes[node];
                    for i in 0..LANES {
                        f[0][i] += x * u[node][0][i];
                        f[1][i] += z * u[node][0][i];
                        f[2][i] += x * u[node][1][i];
                        f[3][i] += z * u[node][1][i];
                    }
                }
                let local = &self.local[row][chunk * points + point];
                let mode = &element.mode[point];
                let (mut level, mut volume) = ([0.0; LANES], [0.0; LANES]);
                for m in 0..modes {
                    let p = lane(&room.pressure, m * width + at);
                    for i in 0..LANES {
                        level[i] += mode[m] * p[i];
                    }
                }
                for k in 0..4 {
                    for i in 0..LANES {
                        volume[i] += local.volume[k][i] * f[k][i];
                    }
                }
                for m in 0..modes {
                    for i in 0..LANES {
                        volumes[m][i] += mode[m] * volume[i];
                    }
                }
                let stress = &mut room.stress[4 * (chunk * points + point)..][..4];
                for a in 0..4 {
                    let row = &local.stiffness[4 * a..][..4];
                    for i in 0..LANES {
                        stress[a][i] = level[i] * local.volume[a][i]
                            + row[0][i] * f[0][i]
                            + row[1][i] * f[1][i]
                            + row[2][i] * f[2][i]
                            + row[3][i] * f[3][i];
                    }
                }
                if self.memory.is_some() {
                    let slopes = &self.remembering[row][chunk * points + point].state;
                    for a in 0..4 {
                        let row = &slopes[4 * a..][..4];
                        let past = &mut room.past[(4 * point + a) * width + at..][..LANES];
                        for i in 0..LANES {
                            past[i] = row[0][i] * f[0][i]
                                + row[1][i] * f[1][i]
                                + row[2][i] * f[2][i]
                                + row[3][i] * f[3][i];
                        }
                    }
                }
            }
            for m in 0..modes {
                room.volume[m * width + at..][..LANES].copy_from_slice(&volumes[m]);
            }
        }
    }

    /// Forces of the stresses, those of the memory included.
    #[inline(always)]
    fn balance<const NODES: usize>(&self, row: usize, room: &mut RowRoom) {
        let element = &self.mesh.elements[row];
        let points = self.points();
        let width = (self.chunks + 1) * LANES;
        let starts: [usize; NODES] = std::array::from_fn(|node| self.start(node));
        let other = self.mesh.order * width;
        for chunk in 0..self.chunks {
            let at = chunk * LANES;
            let mut forces = [[[0.0; LANES]; 2]; NODES];
            for point in 0..points {
                let stress = &room.stress[4 * (chunk * points + point)..][..4];
                let mut p: [Lane; 4] = std::array::from_fn(|a| stress[a]);
                if self.memory.is_some() {
                    let slopes = &self.remembering[row][chunk * points + point].stress;
                    for k in 0..4 {
                        let h = lane(&room.past, (4 * point + k) * width + at);
                        for a in 0..4 {
                            for i in 0..LANES {
                                p[a][i] += slopes[4 * a + k][i] * h[i];
                            }
                        }
                    }
                }
                let slopes: &[[f64; 2]] = &element.gradient[point];
                for node in 0..NODES {
                    let [x, z] = slopes[node];
                    for i in 0..LANES {
                        forces[node][0][i] += x * p[0][i] + z * p[1][i];
                        forces[node][1][i] += x * p[2][i] + z * p[3][i];
                    }
                }
            }
            for node in 0..NODES {
                for direction in 0..2 {
                    let from = starts[node] + direction * other + at;
                    let to = &mut room.forces[from..from + LANES];
                    for i in 0..LANES {
                        to[i] += forces[node][direction][i];
                    }
                }
            }
        }
    }

    /// Add the forces in the strip to those of the layers.
    fn collect(&self, layers: &mut [&mut [f64]], room: &RowRoom) {
        let columns = self.mesh.columns;
        let width = (self.chunks + 1) * LANES;
        for (to, line) in layers.iter_mut().zip(room.forces.chunks_exact(width)) {
            for (to, force) in to.iter_mut().zip(line) {
                *to += force;
            }
            to[0] += line[columns];
        }
    }

    fn volumes(&self, row: usize, pressure: &[f64], out: &mut [f64], room: &RowRoom) {
        let element = &self.mesh.elements[row];
        let columns = self.mesh.columns;
        let width = (self.chunks + 1) * LANES;
        for (m, mass) in element.mode_mass.iter().enumerate() {
            let softness = mass / self.bulk_modulus;
            for column in 0..columns {
                let at = m * columns + column;
                out[at] = room.volume[m * width + column] - softness * pressure[at];
            }
        }
    }
}

fn add_sums(sums: &mut [f64], lanes: &[Lane]) {
    for (sum, lane) in sums.iter_mut().zip(lanes) {
        *sum += lane.iter().sum::<f64>();
    }
}

fn lane(values: &[f64], at: usize) -> Lane {
    let mut lane = [0.0; LANES];
    lane.copy_from_slice(&values[at..at + LANES]);
    lane
}

fn put(to: &mut [Lane; 16], lane: usize, weight: f64, slopes: &[Gradient; 4]) {
    for a in 0..4 {
        for b in 0..4 {
            to[4 * a + b][lane] = weight * slopes[a][b];
        }
    }
}

/// Stiffness from the permanent network where its b changes with the strain.
fn add_network_slope(block: &Block<'_>, f: &Gradient, d: &mut [Gradient; 4]) {
    let Some(slope) = block.energy.network_slope(f) else {
        return;
    };
    let by_h = memory_slope(f);
    for a in 0..4 {
        for k in 0..4 {
            let sum: f64 = (0..4).map(|c| by_h[a][c] * slope[c][k]).sum();
            d[a][k] += block.equilibrium * sum;
        }
    }
}
