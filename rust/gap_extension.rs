//! The gap of the points in contact, extended to open points of a periodic line or map; the bindings' alone: E of
//! `gripscale.half_space.active_set`, which has the formulas.

use std::f32::consts::{FRAC_2_PI, FRAC_PI_2};

/// Extension of gaps on one set of points in contact.
pub struct GapExtension {
    points: usize,
    kind: Kind,
}

enum Kind {
    Line(LineExtension),
    Map(MapExtension),
}

impl GapExtension {
    /// Extend over each gap of a line: linearly, or as a harmonic function of contacts `reach` times as long.
    pub fn of_line(active: &[bool], reach: Option<f32>) -> Self {
        let kind = Kind::Line(LineExtension::new(active, reach));
        Self { points: active.len(), kind }
    }

    /// Extend to the points of a map beside contacts; `far` is the weight of all farther points.
    pub fn of_map(active: &[bool], columns: usize, far: f32) -> Self {
        let kind = Kind::Map(MapExtension::new(active, columns, far));
        Self { points: active.len(), kind }
    }

    /// Number of points of the line or map.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Extension on a map, if it is one.
    pub fn on_map(&self) -> Option<&MapExtension> {
        match &self.kind {
            Kind::Line(_) => None,
            Kind::Map(map) => Some(map),
        }
    }

    /// Set the open points; `values` is the gap in contact, and zero elsewhere.
    pub fn extend(&self, values: &mut [f32]) {
        match &self.kind {
            Kind::Line(line) => line.extend(values),
            Kind::Map(map) => map.extend(values),
        }
    }
}

/// The gaps of a line, one after the other.
struct LineExtension {
    /// First point and number of points of each; it may go on at the start of the line.
    gaps: Vec<(usize, usize)>,
    /// Weights of the ends before and after each open point.
    weights: Vec<[f32; 2]>,
}

impl LineExtension {
    fn new(active: &[bool], reach: Option<f32>) -> Self {
        let points = active.len();
        let begins = |&i: &usize| active[i] && !active[(i + points - 1) % points];
        let contacts: Vec<usize> = (0..points).filter(begins).collect();
        let length =
            |start: usize| (0..points).take_while(|k| active[(start + k) % points]).count();
        let lengths: Vec<usize> = contacts.iter().map(|&start| length(start)).collect();
        let (mut gaps, mut weights) = (Vec::new(), Vec::new());
        for (k, (&start, &length)) in contacts.iter().zip(&lengths).enumerate() {
            let following = (k + 1) % contacts.len();
            let first = start + length;
            let count = (contacts[following] + 2 * points - first - 1) % points + 1;
            gaps.push((first % points, count));
            match reach {
                None => weights.extend((1..=count).map(|before| {
                    let [near, far] = [before as f32, (count + 1 - before) as f32];
                    [far, near].map(|part| part / (near + far))
                })),
                Some(reach) => {
                    let lengths = [length, lengths[following]].map(|n| reach * n as f32);
                    add_harmonic_measures(&mut weights, count, lengths);
                }
            }
        }
        Self { gaps, weights }
    }

    fn extend(&self, values: &mut [f32]) {
        let (points, mut weights) = (values.len(), self.weights.iter());
        for &(first, count) in &self.gaps {
            let ends = [values[(first + points - 1) % points], values[(first + count) % points]];
            for (k, [before, after]) in weights.by_ref().take(count).enumerate() {
                let at = first + k;
                values[if at < points { at } else { at - points }] =
                    before * ends[0] + after * ends[1];
            }
        }
    }
}

/// Add the harmonic measures of the contacts before and after a gap, of the `lengths`, at its `count` points.
fn add_harmonic_measures(weights: &mut Vec<[f32; 2]>, count: usize, lengths: [f32; 2]) {
    let (first, end) = (weights.len(), (count + 1) as f32);
    weights.resize(first + count, [0.0; 2]);
    let measure = |length: f32, near: f32| {
        FRAC_2_PI * arctan_of_root(length * (end - near) / ((length + end) * near))
    };
    pulp::Arch::new().dispatch(|| {
        for (k, weight) in weights[first..].iter_mut().enumerate() {
            let near = (k + 1) as f32;
            *weight = [measure(lengths[0], near), measure(lengths[1], end - near)];
        }
    });
}

/// arctan sqrt(x) within 1e-7, by the polynomial of M. Abramowitz & I. A. Stegun, Handbook of Mathematical
/// Functions (1964), 4.4.49; without a branch or call, so that the compiler uses vector registers.
#[inline(always)]
fn arctan_of_root(x: f32) -> f32 {
    const COEFFICIENTS: [f32; 8] = [
        0.002_866_226,
        -0.016_165_737,
        0.042_909_614,
        -0.075_289_64,
        0.106_562_64,
        -0.142_089,
        0.199_935_51,
        -0.333_331_45,
    ];
    let square = if x > 1.0 { 1.0 / x } else { x };
    let sum = COEFFICIENTS.iter().fold(0.0, |sum, next| (sum + next) * square);
    let angle = square.sqrt() * (1.0 + sum);
    if x > 1.0 {
        FRAC_PI_2 - angle
    } else {
        angle
    }
}

/// Weight of a neighbour along an axis and across, 1/distance^3.
const STRAIGHT: f32 = 1.0;
const DIAGONAL: f32 = 0.353_553_4;

/// The open points of a map next to contacts, row after row.
pub struct MapExtension {
    rows: usize,
    columns: usize,
    /// Where the points of each row begin, and the end of the last.
    starts: Vec<usize>,
    column: Vec<u32>,
    /// One over the weights of the neighbours in contact and of all farther points.
    share: Vec<f32>,
}

impl MapExtension {
    /// Find the points beside `active`, rows of so many `columns`; `far` is the weight of all farther points.
    fn new(active: &[bool], columns: usize, far: f32) -> Self {
        let rows = active.len() / columns;
        let row = |i: usize| &active[i % rows * columns..][..columns];
        let (mut starts, mut column, mut share) = (vec![0], Vec::new(), Vec::new());
        let mut near = vec![false; columns];
        for i in 0..rows {
            let around = [row(i + rows - 1), row(i), row(i + 1)];
            for (j, near) in near.iter_mut().enumerate() {
                *near = around[0][j] | around[1][j] | around[2][j];
            }
            for j in 0..columns {
                let (left, right) = beside(j, columns);
                if around[1][j] || !(near[left] | near[j] | near[right]) {
                    continue;
                }
                let count = |straight: [bool; 4], diagonal: [bool; 4]| {
                    STRAIGHT * straight.iter().map(|&on| f32::from(on)).sum::<f32>()
                        + DIAGONAL * diagonal.iter().map(|&on| f32::from(on)).sum::<f32>()
                };
                let weight = count(
                    [around[0][j], around[2][j], around[1][left], around[1][right]],
                    [around[0][left], around[0][right], around[2][left], around[2][right]],
                );
                column.push(j as u32);
                share.push(1.0 / (weight + far));
            }
            starts.push(column.len());
        }
        Self { rows, columns, starts, column, share }
    }

    /// Rows and columns of the map.
    pub fn shape(&self) -> (usize, usize) {
        (self.rows, self.columns)
    }

    /// Set the open points of the row `i` from the gaps in contact there and in the rows beside it.
    pub fn extend_row(&self, i: usize, above: &[f32], row: &mut [f32], below: &[f32]) {
        let extended: Vec<f32> = self.open_of_row(i, above, row, below).collect();
        for (&j, value) in self.column[self.starts[i]..].iter().zip(extended) {
            row[j as usize] = value;
        }
    }

    fn open_of_row<'r>(
        &'r self,
        i: usize,
        above: &'r [f32],
        row: &'r [f32],
        below: &'r [f32],
    ) -> impl Iterator<Item = f32> + 'r {
        (self.starts[i]..self.starts[i + 1]).map(move |k| {
            let j = self.column[k] as usize;
            let (left, right) = beside(j, self.columns);
            let straight = above[j] + below[j] + row[left] + row[right];
            let diagonal = above[left] + above[right] + below[left] + below[right];
            self.share[k] * (STRAIGHT * straight + DIAGONAL * diagonal)
        })
    }

    fn extend(&self, values: &mut [f32]) {
        let row = |i: usize| &values[i % self.rows * self.columns..][..self.columns];
        // no point beside a contact may be read as a neighbour after it is set
        let mut extended = Vec::with_capacity(self.column.len());
        for i in 0..self.rows {
            extended.extend(self.open_of_row(i, row(i + self.rows - 1), row(i), row(i + 1)));
        }
        for i in 0..self.rows {
            for k in self.starts[i]..self.starts[i + 1] {
                values[i * self.columns + self.column[k] as usize] = extended[k];
            }
        }
    }
}

fn beside(j: usize, columns: usize) -> (usize, usize) {
    let left = if j == 0 { columns - 1 } else { j - 1 };
    (left, if j + 1 == columns { 0 } else { j + 1 })
}

#[cfg(test)]
mod tests {
    use super::arctan_of_root;

    #[test]
    fn arctan_is_that_of_the_library() {
        for step in -200..200 {
            let x = 10f32.powf(step as f32 / 20.0);
            assert!((arctan_of_root(x) - x.sqrt().atan()).abs() < 3e-7, "{x}");
        }
    }
}
