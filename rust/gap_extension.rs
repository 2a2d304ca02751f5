//! The gap of the points of a periodic map in contact, extended to the open points beside them; the
//! bindings' alone: E of `gripscale.half_space.active_set`.

/// Weight of a neighbour along an axis and across, 1/distance^3.
const STRAIGHT: f32 = 1.0;
const DIAGONAL: f32 = 0.353_553_4;

/// The open points next to contacts, row after row.
pub struct GapExtension {
    rows: usize,
    columns: usize,
    /// Where the points of each row begin, and the end of the last.
    starts: Vec<usize>,
    column: Vec<u32>,
    /// One over the weights of the neighbours in contact and of all farther points.
    share: Vec<f32>,
}

impl GapExtension {
    /// Find the points beside `active`, rows of so many `columns`; `far` is the weight of all farther points.
    pub fn new(active: &[bool], columns: usize, far: f32) -> Self {
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
                    [
                        around[0][j],
                        around[2][j],
                        around[1][left],
                        around[1][right],
                    ],
                    [
                        around[0][left],
                        around[0][right],
                        around[2][left],
                        around[2][right],
                    ],
                );
                column.push(j as u32);
                share.push(1.0 / (weight + far));
            }
            starts.push(column.len());
        }
        Self {
            rows,
            columns,
            starts,
            column,
            share,
        }
    }

    /// Number of points of the map.
    pub fn points(&self) -> usize {
        self.rows * self.columns
    }

    /// Set the points beside the contacts; `values` is the gap in contact and zero elsewhere.
    pub fn extend(&self, values: &mut [f32]) {
        let row = |i: usize| i % self.rows * self.columns;
        // no point beside a contact may be read as a neighbour after it is set
        let mut extended = Vec::with_capacity(self.column.len());
        for i in 0..self.rows {
            let [above, here, below] = [row(i + self.rows - 1), row(i), row(i + 1)]
                .map(|at| &values[at..at + self.columns]);
            for k in self.starts[i]..self.starts[i + 1] {
                let j = self.column[k] as usize;
                let (left, right) = beside(j, self.columns);
                let straight = above[j] + below[j] + here[left] + here[right];
                let diagonal = above[left] + above[right] + below[left] + below[right];
                extended.push(self.share[k] * (STRAIGHT * straight + DIAGONAL * diagonal));
            }
        }
        for i in 0..self.rows {
            for k in self.starts[i]..self.starts[i + 1] {
                values[row(i) + self.column[k] as usize] = extended[k];
            }
        }
    }
}

fn beside(j: usize, columns: usize) -> (usize, usize) {
    let left = if j == 0 { columns - 1 } else { j - 1 };
    (left, if j + 1 == columns { 0 } else { j + 1 })
}
