//! The Jacobian averaged along the rows, solved harmonic by harmonic: the preconditioner of the exact one.
//!
//! A matrix that is the same in all columns is block-circulant, that is, diagonal in the harmonics
//! exp(2 pi i k x). For each of them the node layers are eliminated from the lid down, in blocks of 2
//! (bilinear) or 8 (biquadratic) complex unknowns, after the pressures have been condensed. A solution
//! costs two transforms a layer and O(rows) a harmonic. Harmonics are independent of one another and are
//! solved in blocks of neighbours.

use std::f64::consts::TAU;

use super::harmonic_block::{product, Coefficients, HarmonicBlock, HarmonicWorkspace};
use super::harmonic_row::HarmonicRow;
use super::jacobian::Jacobian;
use super::mesh::Mesh;
use crate::executor::{Executor, Threads};
use crate::spectral::{Complex64, Lines};
use crate::status::Status;

/// Largest number of harmonics in a block: their layers then stay in the cache.
const BLOCK_HARMONICS: usize = 64;

pub struct AveragedJacobian<'a> {
    pub mesh: &'a Mesh,
    harmonics: usize,
    blocks: Vec<HarmonicBlock>,
    /// Displacements of the surface layer per unit forces on it, `[(to, from)][harmonic]`.
    pub surface: Coefficients,
}

/// Memory for solutions.
pub struct SolutionWorkspace<'t> {
    threads: &'t Threads,
    /// One for every thread.
    lines: Vec<Lines>,
    /// Harmonics of all lines, `[unknown of a layer or pressure][harmonic]`; in `expand` those of the
    /// lowest layer alone.
    spectra: Vec<Complex64>,
    blocks: Vec<HarmonicWorkspace>,
    /// One for every thread.
    sums: Vec<Vec<Complex64>>,
}

impl<'a> AveragedJacobian<'a> {
    pub fn new(jacobian: &Jacobian<'a>, executor: &Executor<'_>) -> Result<Self, Status> {
        let mesh = jacobian.mesh;
        let harmonics = mesh.columns / 2 + 1;
        let averaged =
            |row: usize| HarmonicRow::new(mesh, row, jacobian.averages(row), jacobian.bulk_modulus);
        let averaged = executor.map(jacobian.size(), mesh.rows, averaged)?;
        let factors = |k: usize| {
            let weight = jacobian.memory.as_ref().map(|weights| weights[k]);
            (Complex64::cis(TAU * k as f64 / mesh.columns as f64), weight)
        };
        let count = harmonics.div_ceil(BLOCK_HARMONICS);
        let eliminate = |block: usize| {
            let range = block * harmonics / count..(block + 1) * harmonics / count;
            let factors: Vec<_> = range.clone().map(factors).collect();
            let bulk_modulus = jacobian.bulk_modulus;
            HarmonicBlock::new(mesh, bulk_modulus, &averaged, range.start, &factors)
        };
        let size = harmonics * mesh.layers() * 8 * mesh.order.pow(3);
        let eliminated = executor.map(size, count, eliminate)?;
        let lowest = 2 * mesh.order;
        let mut surface = vec![Complex64::default(); lowest * lowest * harmonics];
        let mut blocks = Vec::with_capacity(count);
        for eliminated in eliminated {
            let (block, response) = eliminated?;
            put(&mut surface, harmonics, &response, (block.from, block.count));
            blocks.push(block);
        }
        Ok(Self { mesh, harmonics, blocks, surface })
    }

    pub fn workspace<'t>(&self, threads: &'t Threads) -> SolutionWorkspace<'t> {
        let mesh = self.mesh;
        let zeros = |count: usize| vec![Complex64::default(); count];
        let layers = (mesh.layers() - 1) * self.lowest();
        let pressures = mesh.rows * mesh.modes();
        let block = |block: &HarmonicBlock| HarmonicWorkspace {
            layers: zeros(layers * block.count),
            pressures: zeros(pressures * block.count),
        };
        let count = threads.count_for(self.size());
        SolutionWorkspace {
            threads,
            lines: vec![Lines::new(mesh.columns); count],
            spectra: zeros((layers + pressures) * self.harmonics),
            blocks: self.blocks.iter().map(block).collect(),
            sums: vec![zeros(self.lowest() * mesh.order * BLOCK_HARMONICS); count],
        }
    }

    /// How many numbers a solution reads and writes.
    fn size(&self) -> usize {
        8 * self.harmonics * self.mesh.layers() * self.lowest() * self.mesh.order
    }

    /// Unknowns of one layer in one harmonic.
    fn lowest(&self) -> usize {
        2 * self.mesh.order
    }

    /// Reduce a right-hand side to the surface. Returns the displacements of the surface if no other
    /// force acts on it; the rest stays in `work` for `expand`.
    pub fn reduce(&self, right: &[f64], work: &mut SolutionWorkspace<'_>) -> Vec<f64> {
        let (columns, count) = (self.mesh.columns, self.harmonics);
        let spectra = work.spectra.chunks_exact_mut(count);
        let lines = right.chunks_exact(columns).zip(spectra);
        work.threads.share(self.size(), &mut work.lines, lines, |lines, (line, to)| {
            lines.forward(line, to);
        });
        let (spectra, blocks) = (&work.spectra, self.blocks.iter().zip(&mut work.blocks));
        work.threads.share(self.size(), &mut work.sums, blocks, |sum, (block, work)| {
            let (layers, pressures) = spectra.split_at(work.layers.len() / block.count * count);
            let range = (block.from, block.count);
            take(&mut work.layers, layers, count, range);
            take(&mut work.pressures, pressures, count, range);
            block.reduce(self.mesh, work, sum);
        });
        let lowest = self.lowest();
        for (block, from) in self.blocks.iter().zip(&work.blocks) {
            let reduced = &from.layers[..lowest * block.count];
            put(&mut work.spectra, count, reduced, (block.from, block.count));
        }
        multiply(&self.surface, &work.spectra[..lowest * count], &mut work.lines[0])
    }

    /// Complete the solution that `reduce` began, from the displacements of the surface.
    pub fn expand(&self, surface: &[f64], out: &mut [f64], work: &mut SolutionWorkspace<'_>) {
        let (columns, count) = (self.mesh.columns, self.harmonics);
        let spectra = work.spectra.chunks_exact_mut(count);
        for (line, spectrum) in surface.chunks_exact(columns).zip(spectra) {
            work.lines[0].forward(line, spectrum);
        }
        let (spectra, blocks) = (&work.spectra, self.blocks.iter().zip(&mut work.blocks));
        work.threads.share(self.size(), &mut work.sums, blocks, |_, (block, work)| {
            let lowest = &mut work.layers[..self.lowest() * block.count];
            take(lowest, spectra, count, (block.from, block.count));
            block.expand(self.mesh, work);
        });
        let (blocks, lines) = (&work.blocks, out.chunks_exact_mut(columns).enumerate());
        let layers = (self.mesh.layers() - 1) * self.lowest();
        work.threads.share(self.size(), &mut work.lines, lines, |lines, (at, line)| {
            let pieces = self.blocks.iter().zip(blocks).map(|(block, work)| {
                let from = match at.checked_sub(layers) {
                    None => work.layers[at * block.count..].as_ref(),
                    Some(at) => &work.pressures[at * block.count..],
                };
                &from[..block.count]
            });
            lines.inverse_of_pieces(pieces, line);
        });
    }
}

/// Convolution round the period of the lines in `values` with the lines whose harmonics are `blocks`,
/// `[(to, from)][harmonic]`.
pub fn convolve(blocks: &[Complex64], values: &[f64], lines: &mut Lines) -> Vec<f64> {
    let (columns, count) = (lines.length(), lines.harmonics());
    let mut spectra = vec![Complex64::default(); values.len() / columns * count];
    for (line, spectrum) in values.chunks_exact(columns).zip(spectra.chunks_exact_mut(count)) {
        lines.forward(line, spectrum);
    }
    multiply(blocks, &spectra, lines)
}

/// The lines with the harmonics `blocks` times `spectra`.
fn multiply(blocks: &[Complex64], spectra: &[Complex64], lines: &mut Lines) -> Vec<f64> {
    let (columns, count) = (lines.length(), lines.harmonics());
    let mut products = vec![Complex64::default(); spectra.len()];
    product(&mut products, blocks, spectra, 1.0, count);
    let mut values = vec![0.0; spectra.len() / count * columns];
    for (spectrum, line) in products.chunks_exact(count).zip(values.chunks_exact_mut(columns)) {
        lines.inverse(spectrum, line);
    }
    values
}

/// Copy the range (from, count) of every line of `harmonics`.
fn take(
    to: &mut [Complex64],
    lines: &[Complex64],
    harmonics: usize,
    (from, count): (usize, usize),
) {
    for (to, line) in to.chunks_exact_mut(count).zip(lines.chunks_exact(harmonics)) {
        to.copy_from_slice(&line[from..from + count]);
    }
}

/// Copy lines to the range (from, count) of lines of `harmonics`.
fn put(
    lines: &mut [Complex64],
    harmonics: usize,
    part: &[Complex64],
    (from, count): (usize, usize),
) {
    for (line, part) in lines.chunks_exact_mut(harmonics).zip(part.chunks_exact(count)) {
        line[from..from + count].copy_from_slice(part);
    }
}
