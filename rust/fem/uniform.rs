//! The Jacobian averaged along the rows, solved harmonic by harmonic: nearly that of a laterally
//! uniform state, and the preconditioner of the exact one.
//!
//! What is the same in all columns is diagonal in the harmonics exp(2 pi i k x): for each of them the
//! node layers are eliminated from the lid down, in blocks of 2 (bilinear) or 8 (biquadratic) complex
//! unknowns, pressures condensed before. Solving costs two transforms a layer and O(rows) a harmonic;
//! harmonics know nothing of one another and are solved in bands.

use super::harmonic_row::HarmonicRow;
use super::jacobian::Jacobian;
use super::mesh::Mesh;
use crate::linear::invert;
use crate::spectral::{Complex64, Lines};
use crate::status::Status;
use crate::threads::Threads;
use crate::watch::Watch;

/// Most harmonics of a band: their layers stay near the processor.
const BAND: usize = 64;

/// Coefficients of one kind for all harmonics of a band: `[entry][harmonic]`.
type Blocks = Vec<Complex64>;

pub struct Uniform<'a> {
    pub mesh: &'a Mesh,
    harmonics: usize,
    bands: Vec<Band>,
    /// Displacements of the surface layer per unit forces on it, `[(to, from)][harmonic]`.
    pub surface: Blocks,
}

/// Neighbouring harmonics.
struct Band {
    from: usize,
    count: usize,
    /// Contact surface first.
    rows: Vec<Row>,
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

/// Harmonics of one band: of all layers, `[unknown of a layer][harmonic]`, and of the pressures.
struct BandRoom {
    layers: Vec<Complex64>,
    pressures: Vec<Complex64>,
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
        let count = harmonics.div_ceil(BAND);
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
            sums: vec![nothing(self.lowest() * mesh.order * BAND); count],
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
        self.moved(&room.spectra[..lowest * count], &mut room.lines[0])
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

impl Band {
    /// Harmonics after `from`, by what they turn by and what multiplies the memory in them; and how
    /// the surface answers, `[(to, from)][harmonic]`.
    fn new(
        mesh: &Mesh,
        bulk_modulus: f64,
        averaged: &[HarmonicRow],
        from: usize,
        turns: &[(Complex64, Option<Complex64>)],
    ) -> Result<(Self, Blocks), Status> {
        let (lowest, count) = (2 * mesh.order, turns.len());
        let mut rows: Vec<Row> = Vec::with_capacity(mesh.rows);
        let mut above = vec![Complex64::default(); lowest * lowest * count];
        for (index, averaged) in averaged.iter().enumerate().rev() {
            let size = averaged.size;
            let mut matrix = vec![Complex64::default(); size * size];
            let top = usize::from(index + 1 == mesh.rows);
            let upper = lowest * (mesh.order - top);
            let mut row = Row::new(mesh, bulk_modulus, index, upper, count);
            for (k, &(turn, weight)) in turns.iter().enumerate() {
                averaged.matrix(turn, weight, &mut matrix);
                if top == 0 {
                    for j in 0..lowest {
                        for i in 0..lowest {
                            let at = (size - lowest + j) * size + size - lowest + i;
                            matrix[at] += above[(j * lowest + i) * count + k];
                        }
                    }
                }
                row.eliminate(&matrix, averaged.pressing(turn), (k, count), &mut above)?;
            }
            rows.push(row);
        }
        rows.reverse();
        let mut block = vec![Complex64::default(); lowest * lowest];
        for k in 0..count {
            for (entry, value) in block.iter_mut().enumerate() {
                *value = above[entry * count + k];
            }
            if !invert(&mut block, lowest) {
                return Err(Status::NotFinite);
            }
            for (entry, value) in block.iter().enumerate() {
                above[entry * count + k] = *value;
            }
        }
        Ok((Self { from, count, rows }, above))
    }

    /// From the lid down to the surface.
    fn down(&self, mesh: &Mesh, room: &mut BandRoom, sum: &mut [Complex64]) {
        let (count, lowest, modes) = (self.count, 2 * mesh.order, mesh.modes());
        for (index, row) in self.rows.iter().enumerate().rev() {
            let own = &mut room.layers[index * mesh.order * lowest * count..];
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
            let sum = &mut sum[..row.upper * count];
            sum.fill(Complex64::default());
            product(sum, &row.upper_inverse, up, 1.0, count);
            up.copy_from_slice(sum);
            product(low, &row.lower_upper, up, -1.0, count);
        }
    }

    /// From the surface up to the lid.
    fn up(&self, mesh: &Mesh, room: &mut BandRoom) {
        let (count, lowest, modes) = (self.count, 2 * mesh.order, mesh.modes());
        for (index, row) in self.rows.iter().enumerate() {
            let own = &mut room.layers[index * mesh.order * lowest * count..];
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
