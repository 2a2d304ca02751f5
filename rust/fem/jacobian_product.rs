//! The Jacobian applied to a direction, `LANES` columns at a time.
//!
//! Memory layout. All elements of a row are equal, so that one instruction works on `LANES` neighbouring
//! columns. In a vector of unknowns every layer of nodes has 2 order lines of `columns` numbers: line
//! direction * order + place holds one displacement of all nodes that have the same place in their
//! elements. A row of elements uses order + 1 layers, of which the last is the first of the row above.
//!
//! A strip is a copy of the lines of these layers, one after the other, every line padded to
//!     width = (chunks + 1) LANES,   chunks = columns / LANES, rounded up.
//! Number `columns` of a line repeats number 0, because the mesh is periodic: the right-hand nodes of
//! column c are the first nodes of column c + 1, so they are read from the same line one number further
//! on. The additional chunk keeps these reads within the line. What stands beyond number `columns` does
//! not count: `PointSlopes` are zero there.
//!
//! The memory is a product of harmonics along every line of Gauss points (`RowWorkspace::past`).

use super::element::MOST_NODES;
use super::jacobian::Jacobian;
use super::point_slopes::{lane, Lane, LANES};
use crate::executor::Threads;
use crate::spectral::Lines;

/// Rows of elements in a band, which a thread takes at a time.
const BAND_ROWS: usize = 2;

/// Memory for products.
pub struct ProductWorkspace<'t> {
    threads: &'t Threads,
    /// One for every thread.
    rows: Vec<RowWorkspace>,
    /// Forces on the layer above every band, which belongs to the next band.
    above: Vec<f64>,
}

/// What a band writes to: forces on its layers and on the one above, and volumes.
type BandOutput<'a> = ((&'a mut [f64], &'a mut [f64]), &'a mut [f64]);

/// Memory for the product of one row of elements.
#[derive(Clone)]
struct RowWorkspace {
    lines: Lines,
    /// Displacements of the row's layers.
    strip: Vec<f64>,
    /// Forces on the row's layers, laid out like `strip`.
    forces: Vec<f64>,
    /// `[mode]`, lines of `width` numbers.
    pressure: Vec<f64>,
    volume: Vec<f64>,
    /// `[chunk][point][component]`.
    stress: Vec<Lane>,
    /// Changes of what is remembered, then of H: `[point][component]`, lines of `width` numbers.
    past: Vec<f64>,
}

impl Jacobian<'_> {
    /// Length of a line of a strip.
    fn width(&self) -> usize {
        (self.chunks + 1) * LANES
    }

    pub fn workspace<'t>(&self, threads: &'t Threads) -> ProductWorkspace<'t> {
        let (mesh, width) = (self.mesh, self.width());
        let strip = (mesh.order + 1) * 2 * mesh.order * width;
        let row = RowWorkspace {
            lines: Lines::new(mesh.columns),
            strip: vec![0.0; strip],
            forces: vec![0.0; strip],
            pressure: vec![0.0; mesh.modes() * width],
            volume: vec![0.0; mesh.modes() * width],
            stress: vec![[0.0; LANES]; 4 * self.points() * self.chunks],
            past: vec![0.0; 4 * self.points() * width],
        };
        ProductWorkspace {
            threads,
            rows: vec![row; threads.count_for(self.size())],
            above: vec![0.0; mesh.rows.div_ceil(BAND_ROWS) * mesh.layer_size()],
        }
    }

    /// `out` = J `x`.
    pub fn product(&self, x: &[f64], out: &mut [f64], workspace: &mut ProductWorkspace<'_>) {
        let displacements = self.displacements();
        let (u, p) = x.split_at(displacements);
        let (forces, volumes) = out.split_at_mut(displacements);
        forces.fill(0.0);
        workspace.above.fill(0.0);
        let (columns, layer) = (self.mesh.columns, self.mesh.layer_size());
        let per_row = self.mesh.modes() * columns;
        let per_band = BAND_ROWS * self.mesh.order * layer;
        let bands = forces
            .chunks_mut(per_band)
            .zip(workspace.above.chunks_exact_mut(layer))
            .zip(volumes.chunks_mut(BAND_ROWS * per_row))
            .enumerate();
        let band_product = |work: &mut RowWorkspace, (band, output): (usize, BandOutput<'_>)| {
            let ((forces, above), volumes) = output;
            let mut lines: Vec<&mut [f64]> = forces.chunks_exact_mut(columns).collect();
            lines.extend(above.chunks_exact_mut(columns));
            for (at, volumes) in volumes.chunks_exact_mut(per_row).enumerate() {
                let row = band * BAND_ROWS + at;
                let lines = &mut lines[2 * self.mesh.order.pow(2) * at..];
                let pressure = &p[row * per_row..][..per_row];
                self.row_product(row, u, pressure, work);
                self.add_forces(lines, work);
                self.put_volumes(row, pressure, volumes, work);
            }
        };
        workspace.threads.share(self.size(), &mut workspace.rows, bands, band_product);
        let next_bands = forces.chunks_mut(per_band).skip(1);
        for (to, above) in next_bands.zip(workspace.above.chunks_exact(layer)) {
            for (to, force) in to.iter_mut().zip(above) {
                *to += force;
            }
        }
    }

    /// Forces and changes of volume of one row, into `work`.
    fn row_product(&self, row: usize, u: &[f64], pressure: &[f64], work: &mut RowWorkspace) {
        self.fill_strip(row, u, work);
        let width = self.width();
        for (line, values) in pressure.chunks_exact(self.mesh.columns).enumerate() {
            work.pressure[line * width..][..values.len()].copy_from_slice(values);
        }
        pulp::Arch::new().dispatch(|| match self.mesh.order {
            1 => self.stresses::<4>(row, work),
            _ => self.stresses::<MOST_NODES>(row, work),
        });
        if let Some(spectrum) = &self.memory {
            for line in work.past.chunks_exact_mut(width) {
                let line = &mut line[..self.mesh.columns];
                work.lines.convolve(spectrum, line);
            }
        }
        work.forces.fill(0.0);
        pulp::Arch::new().dispatch(|| match self.mesh.order {
            1 => self.internal_forces::<4>(row, work),
            _ => self.internal_forces::<MOST_NODES>(row, work),
        });
    }

    /// Where the horizontal line of a local node begins in a strip, its column 0.
    fn line_start(&self, node: usize) -> usize {
        let order = self.mesh.order;
        let (layer, place) = (node / (order + 1), node % (order + 1));
        (2 * layer * order + place % order) * self.width() + usize::from(place == order)
    }

    /// Copy the layers of a row into the strip, the fixed lid as zeros.
    fn fill_strip(&self, row: usize, u: &[f64], work: &mut RowWorkspace) {
        let mesh = self.mesh;
        let from = row * mesh.order * mesh.layer_size();
        let lines = u[from..].chunks_exact(mesh.columns);
        let mut strip = work.strip.chunks_exact_mut(self.width());
        for (line, to) in lines.zip(&mut strip) {
            to[..mesh.columns].copy_from_slice(line);
            to[mesh.columns] = line[0];
        }
        strip.for_each(|to| to.fill(0.0));
    }

    /// Stresses at fixed memory, changes of volume, and changes of what is remembered, from the strip.
    #[inline(always)]
    fn stresses<const NODES: usize>(&self, row: usize, work: &mut RowWorkspace) {
        let element = &self.mesh.elements[row];
        let (points, modes) = (self.points(), self.mesh.modes());
        let width = self.width();
        let starts: [usize; NODES] = std::array::from_fn(|node| self.line_start(node));
        let to_vertical = self.mesh.order * width;
        for chunk in 0..self.chunks {
            let at = chunk * LANES;
            let u: [[Lane; 2]; NODES] = std::array::from_fn(|node| {
                let from = starts[node] + at;
                [lane(&work.strip, from), lane(&work.strip, from + to_vertical)]
            });
            let mut volumes = [[0.0; LANES]; 3];
            for point in 0..points {
                let mut f = [[0.0; LANES]; 4];
                let gradient: &[[f64; 2]] = &element.gradient[point];
                for node in 0..NODES {
                    let [x, z] = gradient[node];
                    for i in 0..LANES {
                        f[0][i] += x * u[node][0][i];
                        f[1][i] += z * u[node][0][i];
                        f[2][i] += x * u[node][1][i];
                        f[3][i] += z * u[node][1][i];
                    }
                }
                let slopes = &self.slopes[row][chunk * points + point];
                let (mode, weight) = (&element.mode[point], element.weight[point]);
                let mut level = [0.0; LANES];
                for m in 0..modes {
                    let p = lane(&work.pressure, m * width + at);
                    for i in 0..LANES {
                        level[i] += weight * mode[m] * p[i];
                    }
                }
                let volume = slopes.volume(&f);
                for m in 0..modes {
                    for i in 0..LANES {
                        volumes[m][i] += weight * mode[m] * volume[i];
                    }
                }
                let stress = &mut work.stress[4 * (chunk * points + point)..][..4];
                stress.copy_from_slice(&slopes.stress(&f, &level));
                if self.memory.is_some() {
                    for (k, change) in slopes.remembered(&f, &volume).iter().enumerate() {
                        let from = (4 * point + k) * width + at;
                        work.past[from..from + LANES].copy_from_slice(change);
                    }
                }
            }
            for m in 0..modes {
                work.volume[m * width + at..][..LANES].copy_from_slice(&volumes[m]);
            }
        }
    }

    /// Nodal forces of the stresses, including those of the memory, into the strip of forces.
    #[inline(always)]
    fn internal_forces<const NODES: usize>(&self, row: usize, work: &mut RowWorkspace) {
        let element = &self.mesh.elements[row];
        let points = self.points();
        let width = self.width();
        let starts: [usize; NODES] = std::array::from_fn(|node| self.line_start(node));
        let to_vertical = self.mesh.order * width;
        for chunk in 0..self.chunks {
            let at = chunk * LANES;
            let mut forces = [[[0.0; LANES]; 2]; NODES];
            for point in 0..points {
                let stress = &work.stress[4 * (chunk * points + point)..][..4];
                let mut p: [Lane; 4] = std::array::from_fn(|a| stress[a]);
                if self.memory.is_some() {
                    let slopes = &self.slopes[row][chunk * points + point];
                    let h = std::array::from_fn(|k| {
                        let from = (4 * point + k) * width + at;
                        lane(&work.past, from)
                    });
                    slopes.add_memory(&mut p, &h, element.weight[point]);
                }
                let gradient: &[[f64; 2]] = &element.gradient[point];
                for node in 0..NODES {
                    let [x, z] = gradient[node];
                    for i in 0..LANES {
                        forces[node][0][i] += x * p[0][i] + z * p[1][i];
                        forces[node][1][i] += x * p[2][i] + z * p[3][i];
                    }
                }
            }
            for node in 0..NODES {
                for direction in 0..2 {
                    let from = starts[node] + direction * to_vertical + at;
                    let to = &mut work.forces[from..from + LANES];
                    for i in 0..LANES {
                        to[i] += forces[node][direction][i];
                    }
                }
            }
        }
    }

    /// Add the forces in the strip to the lines of the layers.
    fn add_forces(&self, layers: &mut [&mut [f64]], work: &RowWorkspace) {
        let strip = work.forces.chunks_exact(self.width());
        for (to, line) in layers.iter_mut().zip(strip) {
            for (to, force) in to.iter_mut().zip(line) {
                *to += force;
            }
            to[0] += line[self.mesh.columns];
        }
    }

    fn put_volumes(&self, row: usize, pressure: &[f64], out: &mut [f64], work: &RowWorkspace) {
        let element = &self.mesh.elements[row];
        let columns = self.mesh.columns;
        let width = self.width();
        for (m, mass) in element.mode_mass.iter().enumerate() {
            let softness = mass / self.bulk_modulus;
            for column in 0..columns {
                let at = m * columns + column;
                out[at] = work.volume[m * width + column] - softness * pressure[at];
            }
        }
    }
}
