//! The Jacobian averaged along the rows, solved harmonic by harmonic: nearly that of a laterally
//! uniform state, and the preconditioner of the exact one.
//!
//! What is the same in all columns is diagonal in the harmonics exp(2 pi i k x): for each of them the
//! node layers are eliminated from the lid down, in blocks of 2 (bilinear) or 8 (biquadratic) complex
//! unknowns, pressures condensed before. Solving costs two transforms a layer and O(rows) a harmonic;
//! harmonics know nothing of one another and are solved in bands.

use super::harmonic_band::{product, Band, BandRoom, Blocks};
use super::harmonic_row::HarmonicRow;
use super::jacobian::Jacobian;
use super::mesh::Mesh;
use crate::spectral::{Complex64, Lines};
use crate::status::Status;
use crate::threads::Threads;
use crate::watch::Watch;

/// Most harmonics of a band: their layers stay near the processor.
const MOST: usize = 64;

pub struct Uniform<'a> {
    pub mesh: &'a Mesh,
    harmonics: usize,
    bands: Vec<Band>,
    /// Displacements of the surface layer per unit forces on it, `[(to, from)][harmonic]`.
    pub surface: Blocks,
}

/// Where solving takes place.
pub struct Room<'t> {
    threads: &'t Threads,
    /// One a thread.
    lines: Vec<Lines>,
    /// Harmonics of all lines, `[unknown of a layer or pressure][harmonic]`; on the way up those of
    /// the lowest layer alone.
    spectra: Vec<Complex64>,
    bands: Vec<BandRoom>,
    /// One a thread.
    sums: Vec<Vec<Complex64>>,
}

impl<'a> Uniform<'a> {
    pub fn new(jacobian: &Jacobian<'a>, watch: &Watch<'_>) -> Result<Self, Status> {
        let mesh = jacobian.mesh;
        let lines = Lines::new(mesh.columns);
        let harmonics = lines.harmonics();
        let averaged =
            |row: usize| HarmonicRow::new(mesh, row, jacobian.means(row), jacobian.bulk_modulus);
        let averaged = watch.map(jacobian.size(), mesh.rows, averaged)?;
        let turn = |k: usize| {
            let weight = jacobian.memory.as_ref().map(|weights| weights[k]);
            (lines.turn(k), weight)
        };
        let count = harmonics.div_ceil(MOST);
        let band = |band: usize| {
            let within = band * harmonics / count..(band + 1) * harmonics / count;
            let turns: Vec<_> = within.clone().map(turn).collect();
            Band::new(mesh, jacobian.bulk_modulus, &averaged, within.start, &turns)
        };
        let size = harmonics * mesh.layers() * 8 * mesh.order.pow(3);
        let solved = watch.map(size, count, band)?;
        let solved: Vec<(Band, Blocks)> = solved.into_iter().collect::<Result<_, _>>()?;
        let lowest = 2 * mesh.order;
        let mut surface = vec![Complex64::default(); lowest * lowest * harmonics];
        let mut bands = Vec::with_capacity(count);
        for (band, answers) in solved {
            put(&mut surface, harmonics, &answers, (band.from, band.count));
            bands.push(band);
        }
        Ok(Self {
            mesh,
            harmonics,
            bands,
            surface,
        })
    }

    pub fn room<'t>(&self, threads: &'t Threads) -> Room<'t> {
        let mesh = self.mesh;
        let nothing = |count: usize| vec![Complex64::default(); count];
        let layers = (mesh.layers() - 1) * self.lowest();
        let pressures = mesh.rows * mesh.modes();
        let band = |band: &Band| BandRoom {
            layers: nothing(layers * band.count),
            pressures: nothing(pressures * band.count),
        };
        let count = threads.on(self.size());
        Room {
            threads,
            lines: vec![Lines::new(mesh.columns); count],
            spectra: nothing((layers + pressures) * self.harmonics),
            bands: self.bands.iter().map(band).collect(),
            sums: vec![nothing(self.lowest() * mesh.order * MOST); count],
        }
    }

    /// Numbers that are worked on.
    fn size(&self) -> usize {
        8 * self.harmonics * self.mesh.layers() * self.lowest() * self.mesh.order
    }

    /// Unknowns of one layer in one harmonic.
    fn lowest(&self) -> usize {
        2 * self.mesh.order
    }

    /// Carry a right-hand side down to the surface; its displacements there come back, if nothing
    /// else acts on it, and wait in `room` to be carried up.
    pub fn reduce(&self, right: &[f64], room: &mut Room<'_>) -> Vec<f64> {
        let (columns, count) = (self.mesh.columns, self.harmonics);
        let spectra = room.spectra.chunks_exact_mut(count);
        let lines = right.chunks_exact(columns).zip(spectra);
        room.threads
            .share(self.size(), &mut room.lines, lines, |lines, (line, to)| {
                lines.forward(line, to);
            });
        let (spectra, bands) = (&room.spectra, self.bands.iter().zip(&mut room.bands));
        room.threads
            .share(self.size(), &mut room.sums, bands, |sum, (band, room)| {
                let (layers, pressures) = spectra.split_at(room.layers.len() / band.count * count);
                take(&mut room.layers, layers, count, (band.from, band.count));
                take(
                    &mut room.pressures,
                    pressures,
                    count,
                    (band.from, band.count),
                );
                band.down(self.mesh, room, sum);
            });
        let lowest = self.lowest();
        for (band, from) in self.bands.iter().zip(&room.bands) {
            let reduced = &from.layers[..lowest * band.count];
            put(&mut room.spectra, count, reduced, (band.from, band.count));
        }
        multiplied(
            &self.surface,
            &room.spectra[..lowest * count],
            &mut room.lines[0],
        )
    }

    /// Displacements of the surface layer by forces on it.
    pub fn answer(&self, forces: &[f64], lines: &mut Lines) -> Vec<f64> {
        convolved(&self.surface, forces, lines)
    }

    /// The whole solution of what was reduced, from the displacements of the surface.
    pub fn expand(&self, surface: &[f64], out: &mut [f64], room: &mut Room<'_>) {
        let (columns, count) = (self.mesh.columns, self.harmonics);
        let spectra = room.spectra.chunks_exact_mut(count);
        for (line, spectrum) in surface.chunks_exact(columns).zip(spectra) {
            room.lines[0].forward(line, spectrum);
        }
        let (spectra, bands) = (&room.spectra, self.bands.iter().zip(&mut room.bands));
        room.threads
            .share(self.size(), &mut room.sums, bands, |_, (band, room)| {
                let lowest = &mut room.layers[..self.lowest() * band.count];
                take(lowest, spectra, count, (band.from, band.count));
                band.up(self.mesh, room);
            });
        let (bands, lines) = (&room.bands, out.chunks_exact_mut(columns).enumerate());
        let layers = (self.mesh.layers() - 1) * self.lowest();
        room.threads
            .share(self.size(), &mut room.lines, lines, |lines, (at, line)| {
                let pieces = self.bands.iter().zip(bands).map(|(band, room)| {
                    let from = match at.checked_sub(layers) {
                        None => room.layers[at * band.count..].as_ref(),
                        Some(at) => &room.pressures[at * band.count..],
                    };
                    &from[..band.count]
                });
                lines.inverse_of(pieces, line);
            });
    }
}

/// Lines convolved round the period with those of which `blocks` has the harmonics,
/// `[(to, from)][harmonic]`.
pub fn convolved(blocks: &[Complex64], values: &[f64], lines: &mut Lines) -> Vec<f64> {
    let (columns, count) = (lines.len(), lines.harmonics());
    let mut spectra = vec![Complex64::default(); values.len() / columns * count];
    for (line, spectrum) in values
        .chunks_exact(columns)
        .zip(spectra.chunks_exact_mut(count))
    {
        lines.forward(line, spectrum);
    }
    multiplied(blocks, &spectra, lines)
}

/// The lines of the harmonics `spectra` times `blocks`.
fn multiplied(blocks: &[Complex64], spectra: &[Complex64], lines: &mut Lines) -> Vec<f64> {
    let (columns, count) = (lines.len(), lines.harmonics());
    let mut products = vec![Complex64::default(); spectra.len()];
    product(&mut products, blocks, spectra, 1.0, count);
    let mut values = vec![0.0; spectra.len() / count * columns];
    for (spectrum, line) in products
        .chunks_exact(count)
        .zip(values.chunks_exact_mut(columns))
    {
        lines.inverse(spectrum, line);
    }
    values
}

/// Copy the part (from, count) of every line of `count` harmonics.
fn take(
    to: &mut [Complex64],
    lines: &[Complex64],
    harmonics: usize,
    (from, count): (usize, usize),
) {
    for (to, line) in to
        .chunks_exact_mut(count)
        .zip(lines.chunks_exact(harmonics))
    {
        to.copy_from_slice(&line[from..from + count]);
    }
}

/// Copy lines to the part (from, count) of lines of `harmonics`.
fn put(
    lines: &mut [Complex64],
    harmonics: usize,
    part: &[Complex64],
    (from, count): (usize, usize),
) {
    for (line, part) in lines
        .chunks_exact_mut(harmonics)
        .zip(part.chunks_exact(count))
    {
        line[from..from + count].copy_from_slice(part);
    }
}
