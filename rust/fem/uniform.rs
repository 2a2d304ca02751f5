//! The Jacobian averaged along the rows, solved harmonic by harmonic: nearly that of a laterally
//! uniform state, and the preconditioner of the exact one.
//!
//! What is the same in all columns is diagonal in the harmonics exp(2 pi i k x): for each of them the
//! node layers are eliminated from the lid down, in blocks of 2 (bilinear) or 8 (biquadratic) complex
//! unknowns, pressures condensed before. Solving costs two transforms a layer and O(rows) a harmonic.

use super::harmonic_row::HarmonicRow;
use super::jacobian::Jacobian;
use super::mesh::Mesh;
use crate::linear::invert;
use crate::spectral::{Complex64, Lines};
use crate::status::Status;
use crate::watch::Watch;

/// Coefficients of one kind for all harmonics: `[entry][harmonic]`.
type Blocks = Vec<Complex64>;

pub struct Uniform<'a> {
    pub mesh: &'a Mesh,
    harmonics: usize,
    /// Contact surface first.
    rows: Vec<Row>,
    /// Displacements of the surface layer per unit forces on it, `[(to, from)][harmonic]`.
    pub surface: Blocks,
}

struct Row {
    /// Unknowns of a layer, and of the row with the lid's where it ends there.
    lowest: usize,
    unknowns: usize,
    /// Free unknowns above the lowest layer.
    upper: usize,
    upper_inverse: Blocks,
    lower_upper: Blocks,
    /// u_upper = offset - coupling u_lowest.
    coupling: Blocks,
    /// Forces per unit pressure mode, `[(unknown, mode)][harmonic]`.
    pressing: Blocks,
    /// K / M of every mode.
    stiffness: Vec<f64>,
}

/// Where solving takes place.
pub struct Room {
    lines: Lines,
    /// Harmonics of all layers, `[unknown of a layer][harmonic]`, and of the pressures.
    layers: Vec<Complex64>,
    pressures: Vec<Complex64>,
    sum: Vec<Complex64>,
}

impl<'a> Uniform<'a> {
    pub fn new(jacobian: &Jacobian<'a>, watch: &Watch<'_>) -> Result<Self, Status> {
        let mesh = jacobian.mesh;
        let lines = Lines::new(mesh.columns);
        let harmonics = lines.harmonics();
        let lowest = 2 * mesh.order;
        let mut rows: Vec<Row> = Vec::with_capacity(mesh.rows);
        let mut above = vec![Complex64::default(); lowest * lowest * harmonics];
        for index in (0..mesh.rows).rev() {
            watch.look()?;
            let means = jacobian.means(index);
            let averaged = HarmonicRow::new(mesh, index, &means, jacobian.bulk_modulus);
            let size = averaged.size;
            let mut matrix = vec![Complex64::default(); size * size];
            let top = usize::from(index + 1 == mesh.rows);
            let mut row = Row::new(
                mesh,
                jacobian.bulk_modulus,
                index,
                lowest * (mesh.order - top),
                harmonics,
            );
            for k in 0..harmonics {
                let turn = lines.turn(k);
                averaged.matrix(turn, jacobian.memory.as_ref().map(|w| w[k]), &mut matrix);
                if top == 0 {
                    for j in 0..lowest {
                        for i in 0..lowest {
                            let at = (size - lowest + j) * size + size - lowest + i;
                            matrix[at] += above[(j * lowest + i) * harmonics + k];
                        }
                    }
                }
                row.eliminate(&matrix, averaged.pressing(turn), (k, harmonics), &mut above)?;
            }
            rows.push(row);
        }
        rows.reverse();
        let mut block = vec![Complex64::default(); lowest * lowest];
        for k in 0..harmonics {
            for (entry, value) in block.iter_mut().enumerate() {
                *value = above[entry * harmonics + k];
            }
            if !invert(&mut block, lowest) {
                return Err(Status::NotFinite);
            }
            for (entry, value) in block.iter().enumerate() {
                above[entry * harmonics + k] = *value;
            }
        }
        Ok(Self {
            mesh,
            harmonics,
            rows,
            surface: above,
        })
    }

    pub fn room(&self) -> Room {
        let (mesh, lines) = (self.mesh, Lines::new(self.mesh.columns));
        let nothing = |count: usize| vec![Complex64::default(); count * self.harmonics];
        Room {
            lines,
            layers: nothing((mesh.layers() - 1) * 2 * mesh.order),
            pressures: nothing(mesh.rows * mesh.modes()),
            sum: nothing(2 * mesh.order * mesh.order),
        }
    }

    /// Unknowns of one layer in one harmonic.
    fn lowest(&self) -> usize {
        2 * self.mesh.order
    }

    /// Carry a right-hand side down to the surface; its displacements there come back, if nothing
    /// else acts on it, and wait in `room` to be carried up.
    pub fn reduce(&self, right: &[f64], room: &mut Room) -> Vec<f64> {
        let (columns, count) = (self.mesh.columns, self.harmonics);
        let Room {
            lines,
            layers,
            pressures,
            ..
        } = room;
        let spectra = layers.chunks_exact_mut(count);
        let spectra = spectra.chain(pressures.chunks_exact_mut(count));
        for (line, spectrum) in right.chunks_exact(columns).zip(spectra) {
            lines.forward(line, spectrum);
        }
        let (lowest, modes) = (self.lowest(), self.mesh.modes());
        for (index, row) in self.rows.iter().enumerate().rev() {
            let own = &mut room.layers[index * self.mesh.order * lowest * count..];
            let own = &mut own[..(lowest + row.upper) * count];
            for m in 0..modes {
                let pressure = &room.pressures[(index * modes + m) * count..][..count];
                for (i, to) in own.chunks_exact_mut(count).enumerate() {
                    let entry = m * row.unknowns + i;
                    let factors = &row.pressing[entry * count..][..count];
                    multiply_add(to, factors, pressure, row.stiffness[m]);
                }
            }
            let (low, up) = own.split_at_mut(lowest * count);
            let sum = &mut room.sum[..row.upper * count];
            sum.fill(Complex64::default());
            product(sum, &row.upper_inverse, up, 1.0, count);
            up.copy_from_slice(sum);
            product(low, &row.lower_upper, up, -1.0, count);
        }
        self.moved(&room.layers[..lowest * count], &mut room.lines)
    }

    /// Displacements of the surface layer by forces on it.
    pub fn answer(&self, forces: &[f64], lines: &mut Lines) -> Vec<f64> {
        let (columns, count) = (self.mesh.columns, self.harmonics);
        let mut spectra = vec![Complex64::default(); self.lowest() * count];
        for (line, spectrum) in forces
            .chunks_exact(columns)
            .zip(spectra.chunks_exact_mut(count))
        {
            lines.forward(line, spectrum);
        }
        self.moved(&spectra, lines)
    }

    /// Displacements of the surface layer by the harmonics of the forces on it.
    fn moved(&self, forces: &[Complex64], lines: &mut Lines) -> Vec<f64> {
        let (columns, count) = (self.mesh.columns, self.harmonics);
        let mut moved = vec![Complex64::default(); self.lowest() * count];
        product(&mut moved, &self.surface, forces, 1.0, count);
        let mut surface = vec![0.0; self.lowest() * columns];
        for (spectrum, line) in moved
            .chunks_exact(count)
            .zip(surface.chunks_exact_mut(columns))
        {
            lines.inverse(spectrum, line);
        }
        surface
    }

    /// The whole solution of what was reduced, from the displacements of the surface.
    pub fn expand(&self, surface: &[f64], out: &mut [f64], room: &mut Room) {
        let (columns, count) = (self.mesh.columns, self.harmonics);
        let (lowest, modes) = (self.lowest(), self.mesh.modes());
        let spectra = room.layers.chunks_exact_mut(count);
        for (line, spectrum) in surface.chunks_exact(columns).zip(spectra) {
            room.lines.forward(line, spectrum);
        }
        for (index, row) in self.rows.iter().enumerate() {
            let own = &mut room.layers[index * self.mesh.order * lowest * count..];
            let own = &mut own[..(lowest + row.upper) * count];
            let (low, up) = own.split_at_mut(lowest * count);
            product(up, &row.coupling, low, -1.0, count);
            for m in 0..modes {
                // dp = K / M (B^T du - b_p)
                let pressure = &mut room.pressures[(index * modes + m) * count..][..count];
                pressure.iter_mut().for_each(|value| *value = -*value);
                for (i, u) in own.chunks_exact(count).enumerate() {
                    let factors = &row.pressing[(m * row.unknowns + i) * count..][..count];
                    for ((p, factor), u) in pressure.iter_mut().zip(factors).zip(u) {
                        *p += factor.conj() * u;
                    }
                }
                let stiffness = row.stiffness[m];
                pressure.iter_mut().for_each(|value| *value *= stiffness);
            }
        }
        let Room {
            lines,
            layers,
            pressures,
            ..
        } = room;
        let spectra = layers
            .chunks_exact(count)
            .chain(pressures.chunks_exact(count));
        for (line, spectrum) in out.chunks_exact_mut(columns).zip(spectra) {
            lines.inverse(spectrum, line);
        }
    }
}

impl Row {
    fn new(mesh: &Mesh, bulk_modulus: f64, index: usize, upper: usize, harmonics: usize) -> Self {
        let lowest = 2 * mesh.order;
        let unknowns = lowest * (mesh.order + 1);
        let blocks = |entries: usize| vec![Complex64::default(); entries * harmonics];
        let masses = mesh.elements[index].mode_mass.iter();
        Self {
            lowest,
            unknowns,
            upper,
            upper_inverse: blocks(upper * upper),
            lower_upper: blocks(lowest * upper),
            coupling: blocks(upper * lowest),
            pressing: blocks(unknowns * mesh.modes()),
            stiffness: masses.map(|mass| bulk_modulus / mass).collect(),
        }
    }

    /// Eliminate the upper unknowns of harmonic k; what is left of the lowest layer goes to `schur`.
    fn eliminate(
        &mut self,
        matrix: &[Complex64],
        pressing: impl Iterator<Item = Complex64>,
        (k, count): (usize, usize),
        schur: &mut [Complex64],
    ) -> Result<(), Status> {
        let (low, up, size) = (self.lowest, self.upper, self.unknowns);
        let entry = |i: usize, j: usize| matrix[j * size + i];
        let mut inverse = vec![Complex64::default(); up * up];
        for j in 0..up {
            for i in 0..up {
                inverse[j * up + i] = entry(low + i, low + j);
            }
        }
        if !invert(&mut inverse, up) {
            return Err(Status::NotFinite);
        }
        for (at, value) in inverse.iter().enumerate() {
            self.upper_inverse[at * count + k] = *value;
        }
        for (at, value) in pressing.enumerate() {
            self.pressing[at * count + k] = value;
        }
        for j in 0..low {
            let coupled = |i: usize| -> Complex64 {
                (0..up)
                    .map(|l| inverse[l * up + i] * entry(low + l, j))
                    .sum()
            };
            let column: Vec<Complex64> = (0..up).map(coupled).collect();
            for (i, value) in column.iter().enumerate() {
                self.coupling[(j * up + i) * count + k] = *value;
            }
            for i in 0..low {
                let through: Complex64 = (0..up).map(|l| entry(i, low + l) * column[l]).sum();
                schur[(j * low + i) * count + k] = entry(i, j) - through;
            }
        }
        for j in 0..up {
            for i in 0..low {
                self.lower_upper[(j * low + i) * count + k] = entry(i, low + j);
            }
        }
        Ok(())
    }
}

/// target += factor blocks x for each of `count` harmonics, blocks column-major.
fn product(
    target: &mut [Complex64],
    blocks: &[Complex64],
    x: &[Complex64],
    factor: f64,
    count: usize,
) {
    let rows = target.len() / count;
    for (j, x) in x.chunks_exact(count).enumerate() {
        for (i, to) in target.chunks_exact_mut(count).enumerate() {
            let block = &blocks[(j * rows + i) * count..][..count];
            multiply_add(to, block, x, factor);
        }
    }
}

/// to += factor a x, entry by entry.
fn multiply_add(to: &mut [Complex64], a: &[Complex64], x: &[Complex64], factor: f64) {
    pulp::Arch::new().dispatch(|| {
        for ((to, a), x) in to.iter_mut().zip(a).zip(x) {
            *to += a * x * factor;
        }
    });
}
