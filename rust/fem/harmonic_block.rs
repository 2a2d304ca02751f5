//! A block of neighbouring harmonics of the averaged Jacobian: its layers are eliminated from the lid down
//! to the surface.

use super::harmonic_row::HarmonicRow;
use super::mesh::Mesh;
use crate::linear::invert;
use crate::spectral::Complex64;
use crate::status::Status;

/// Entries of matrices for all harmonics of a block: `[entry][harmonic]`.
pub type Coefficients = Vec<Complex64>;

/// Neighbouring harmonics, solved together.
pub struct HarmonicBlock {
    pub from: usize,
    pub count: usize,
    /// Contact surface first.
    rows: Vec<Row>,
}

struct Row {
    /// Unknowns of the lowest layer.
    lowest: usize,
    /// Unknowns of all layers of the row, including those of the lid in the last row.
    unknowns: usize,
    /// Free unknowns above the lowest layer.
    upper: usize,
    upper_inverse: Coefficients,
    lower_upper: Coefficients,
    /// u_upper = offset - coupling u_lowest.
    coupling: Coefficients,
    /// Forces per unit pressure mode, `[(unknown, mode)][harmonic]`.
    pressing: Coefficients,
    /// K / M of every mode.
    stiffness: Vec<f64>,
}

/// Harmonics of displacements, `[unknown of a layer][harmonic]`, and of pressures, of one block.
pub struct HarmonicWorkspace {
    pub layers: Vec<Complex64>,
    pub pressures: Vec<Complex64>,
}

impl HarmonicBlock {
    /// Eliminate the harmonics that begin at `from`, given the phase step and the memory's factor of each.
    /// Also returns the displacements of the surface by unit forces on it, `[(to, from)][harmonic]`.
    pub fn new(
        mesh: &Mesh,
        bulk_modulus: f64,
        averaged: &[HarmonicRow],
        from: usize,
        factors: &[(Complex64, Option<Complex64>)],
    ) -> Result<(Self, Coefficients), Status> {
        let (lowest, count) = (2 * mesh.order, factors.len());
        let mut rows: Vec<Row> = Vec::with_capacity(mesh.rows);
        let mut above = vec![Complex64::default(); lowest * lowest * count];
        for (index, averaged) in averaged.iter().enumerate().rev() {
            let size = averaged.size;
            let mut matrix = vec![Complex64::default(); size * size];
            let top = usize::from(index + 1 == mesh.rows);
            let upper = lowest * (mesh.order - top);
            let mut row = Row::new(mesh, bulk_modulus, index, upper, count);
            for (k, &(phase, weight)) in factors.iter().enumerate() {
                averaged.matrix(phase, weight, &mut matrix);
                if top == 0 {
                    for j in 0..lowest {
                        for i in 0..lowest {
                            let at = (size - lowest + j) * size + size - lowest + i;
                            matrix[at] += above[(j * lowest + i) * count + k];
                        }
                    }
                }
                row.eliminate(&matrix, averaged.pressing(phase), (k, count), &mut above)?;
            }
            rows.push(row);
        }
        rows.reverse();
        if !invert_each(&mut above, lowest, count) {
            return Err(Status::NotFinite);
        }
        Ok((Self { from, count, rows }, above))
    }

    /// Reduce a right-hand side from the lid down to the surface.
    pub fn reduce(&self, mesh: &Mesh, work: &mut HarmonicWorkspace, sum: &mut [Complex64]) {
        let (count, lowest, modes) = (self.count, 2 * mesh.order, mesh.modes());
        for (index, row) in self.rows.iter().enumerate().rev() {
            let layers = &mut work.layers[index * mesh.order * lowest * count..];
            let layers = &mut layers[..(lowest + row.upper) * count];
            for m in 0..modes {
                let pressure = &work.pressures[(index * modes + m) * count..][..count];
                for (i, to) in layers.chunks_exact_mut(count).enumerate() {
                    let entry = m * row.unknowns + i;
                    let factors = &row.pressing[entry * count..][..count];
                    multiply_add(to, factors, pressure, row.stiffness[m]);
                }
            }
            let (low, up) = layers.split_at_mut(lowest * count);
            let sum = &mut sum[..row.upper * count];
            sum.fill(Complex64::default());
            product(sum, &row.upper_inverse, up, 1.0, count);
            up.copy_from_slice(sum);
            product(low, &row.lower_upper, up, -1.0, count);
        }
    }

    /// Complete the solution from the surface up to the lid.
    pub fn expand(&self, mesh: &Mesh, work: &mut HarmonicWorkspace) {
        let (count, lowest, modes) = (self.count, 2 * mesh.order, mesh.modes());
        for (index, row) in self.rows.iter().enumerate() {
            let layers = &mut work.layers[index * mesh.order * lowest * count..];
            let layers = &mut layers[..(lowest + row.upper) * count];
            let (low, up) = layers.split_at_mut(lowest * count);
            product(up, &row.coupling, low, -1.0, count);
            for m in 0..modes {
                // dp = K / M (B^T du - b_p)
                let pressure = &mut work.pressures[(index * modes + m) * count..][..count];
                pressure.iter_mut().for_each(|value| *value = -*value);
                for (i, u) in layers.chunks_exact(count).enumerate() {
                    let factors = &row.pressing[(m * row.unknowns + i) * count..][..count];
                    for ((p, factor), u) in pressure.iter_mut().zip(factors).zip(u) {
                        *p += factor.conj() * u;
                    }
                }
                let stiffness = row.stiffness[m];
                pressure.iter_mut().for_each(|value| *value *= stiffness);
            }
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

    /// Eliminate the upper unknowns of harmonic k; the Schur complement of the lowest layer goes to `schur`.
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
                (0..up).map(|l| inverse[l * up + i] * entry(low + l, j)).sum()
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
pub fn product(
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

/// Replace square blocks of `size` rows, one for each harmonic, by their inverses; false if one is
/// singular.
pub fn invert_each(blocks: &mut [Complex64], size: usize, count: usize) -> bool {
    let mut block = vec![Complex64::default(); size * size];
    (0..count).all(|k| {
        for (entry, value) in block.iter_mut().enumerate() {
            *value = blocks[entry * count + k];
        }
        let regular = invert(&mut block, size);
        for (entry, value) in block.iter().enumerate() {
            blocks[entry * count + k] = *value;
        }
        regular
    })
}

/// to += factor a x, entry by entry.
fn multiply_add(to: &mut [Complex64], a: &[Complex64], x: &[Complex64], factor: f64) {
    pulp::Arch::new().dispatch(|| {
        for ((to, a), x) in to.iter_mut().zip(a).zip(x) {
            *to += a * x * factor;
        }
    });
}
