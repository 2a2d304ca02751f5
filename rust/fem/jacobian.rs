//! The exact Jacobian of the mixed system, applied to a direction and never formed:
//!     r_u = int (dP/dF : grad du + dP/dH : dH + dp cof F) : grad N dV,
//!     r_p = int m cof F : grad du dV - M dp / K,     dH(x) = sum weight(x - x') dY/dF : grad du(x'),
//! with deformation and stiffness kept at every Gauss point. Displacement and pressure both stay
//! unknowns: condensed, the volume's stiffness varies from point to point and no uniform state is near it.
//!
//! `LANES` columns at a time: all elements of a row are equal, and unknowns of equal place in their
//! elements stand together. The memory is a product of harmonics along every line of points.

use super::block::{Block, Field, Memory, RowState};
use super::element::MOST_NODES;
use super::mesh::Mesh;
use super::point_slopes::{lane, Lane, Local, MeanSlopes, Sums, LANES};
use crate::material::kinematics::{Deformation, Gradient};
use crate::material::stress::{memory_slope, tangent};
use crate::spectral::{Complex64, Lines};
use crate::status::Status;
use crate::threads::Threads;
use crate::watch::Watch;

/// Rows of elements that a thread takes at a time.
const BAND: usize = 2;

pub struct Jacobian<'a> {
    pub mesh: &'a Mesh,
    pub bulk_modulus: f64,
    /// Harmonics of the memory's weights along a line, none where nothing is remembered.
    pub memory: Option<Vec<Complex64>>,
    chunks: usize,
    /// `[row][chunk * points + point]`.
    local: Vec<Vec<Local>>,
    /// `[row][point]`.
    means: Vec<Vec<MeanSlopes>>,
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
            means: Vec::new(),
        };
        let slopes = |row: usize| jacobian.slopes(block, field, row, &rows[row]);
        let slopes = watch.map(jacobian.size(), mesh.rows, slopes)?;
        (jacobian.local, jacobian.means) = slopes.into_iter().unzip();
        Ok(jacobian)
    }

    /// Numbers kept.
    pub fn size(&self) -> usize {
        16 * self.mesh.points()
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

    /// Of one row.
    fn slopes(
        &self,
        block: &Block<'_>,
        field: &Field,
        row: usize,
        state: &RowState,
    ) -> (Vec<Local>, Vec<MeanSlopes>) {
        let element = &self.mesh.elements[row];
        let mut local = vec![Local::default(); self.chunks * self.points()];
        let mut sums = vec![Sums::default(); self.points()];
        for column in 0..self.mesh.columns {
            let (chunk, lane) = (column / LANES, column % LANES);
            let pressure = block.element_pressure(field, row, column);
            for (at, line, q) in block.gauss_points(column) {
                let (point, h) = (&state.deformation[line][q], &state.h[line][q]);
                let modes = element.mode[at].iter().zip(pressure);
                let level = modes.map(|(mode, p)| mode * p).sum();
                let mut d = tangent(point, h, level);
                add_network_slope(block, point, &mut d);
                local[chunk * self.points() + at].put(lane, element.weight[at], point, &d);
                sums[at].add(point, &d);
            }
        }
        let (columns, remembers) = (self.mesh.columns, self.memory.is_some());
        if remembers {
            pulp::Arch::new().dispatch(|| {
                for local in local.chunks_exact(self.points()) {
                    for (at, local) in local.iter().enumerate() {
                        sums[at].add_memory(local, element.weight[at]);
                    }
                }
            });
        }
        let means = sums.iter().zip(&element.weight);
        let means = means.map(|(sums, weight)| sums.mean(columns, *weight, remembers));
        (local, means.collect())
    }

    /// Means along one row at every Gauss point of its elements.
    pub fn means(&self, row: usize) -> &[MeanSlopes] {
        &self.means[row]
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
                let (mode, weight) = (&element.mode[point], element.weight[point]);
                let mut level = [0.0; LANES];
                for m in 0..modes {
                    let p = lane(&room.pressure, m * width + at);
                    for i in 0..LANES {
                        level[i] += weight * mode[m] * p[i];
                    }
                }
                let volume = local.volume(&f);
                for m in 0..modes {
                    for i in 0..LANES {
                        volumes[m][i] += weight * mode[m] * volume[i];
                    }
                }
                let stress = &mut room.stress[4 * (chunk * points + point)..][..4];
                stress.copy_from_slice(&local.stress(&f, &level));
                if self.memory.is_some() {
                    for (k, change) in local.remembered(&f, &volume).iter().enumerate() {
                        let from = (4 * point + k) * width + at;
                        room.past[from..from + LANES].copy_from_slice(change);
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
                    let local = &self.local[row][chunk * points + point];
                    let h = std::array::from_fn(|k| {
                        let from = (4 * point + k) * width + at;
                        lane(&room.past, from)
                    });
                    local.add_memory(&mut p, &h, element.weight[point]);
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

/// Stiffness from the permanent network where its b changes with the strain.
pub(super) fn add_network_slope(block: &Block<'_>, point: &Deformation, d: &mut [Gradient; 4]) {
    let Some(slope) = block.energy.network_slope(point) else {
        return;
    };
    let by_h = memory_slope(point);
    for a in 0..4 {
        for k in 0..4 {
            let sum: f64 = (0..4).map(|c| by_h[a][c] * slope[c][k]).sum();
            d[a][k] += block.equilibrium * sum;
        }
    }
}
