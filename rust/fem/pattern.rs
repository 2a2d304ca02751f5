//! The sparsity pattern of the assembled tangent, with the unknowns in the order of elimination.
//!
//! Nested dissection (George, SIAM J. Numer. Anal. 10 (1973) 345) of the periodic strip: two cuts from
//! surface to lid, then every part is halved along its longer side. All cuts follow element edges.

use super::block::Block;
use super::mesh::Mesh;

/// In position of a number, for displacements that are no unknowns.
const NONE: usize = usize::MAX;

/// Parts with at most this number of nodes are not cut further.
const LEAF: usize = 6;

/// The lower triangle in compressed columns, and the positions of the entries of every element.
pub struct Pattern {
    pub column_starts: Vec<usize>,
    pub rows: Vec<usize>,
    /// Entry of the diagonal of every unknown.
    pub diagonal: Vec<usize>,
    /// Position in a field of every unknown.
    pub unknowns: Vec<usize>,
    /// Number of every displacement of a field; the lid's have none.
    number: Vec<usize>,
    /// Displacements of every element in a field, element after element of every row.
    positions: Vec<usize>,
    /// Entries of an element's stiffness, row by row; `OUTSIDE` in the upper triangle or at the lid.
    entries: Vec<u32>,
    size: usize,
}

const OUTSIDE: u32 = u32::MAX;

impl Pattern {
    pub fn new(block: &Block<'_>) -> Self {
        let mesh = block.mesh;
        let mut number = vec![NONE; mesh.layers() * mesh.layer_size()];
        let nodes = dissection(mesh).into_iter();
        let positions = nodes.flat_map(|(x, y)| {
            [0, 1].map(|direction| y * mesh.layer_size() + mesh.position(x, direction))
        });
        let unknowns: Vec<usize> = positions.collect();
        for (i, &position) in unknowns.iter().enumerate() {
            number[position] = i;
        }
        let mut pattern = Self {
            column_starts: vec![0],
            rows: Vec::new(),
            diagonal: Vec::new(),
            positions: element_positions(block),
            entries: Vec::new(),
            size: 2 * mesh.elements[0].nodes(),
            unknowns,
            number,
        };
        pattern.compress();
        pattern.find_entries();
        pattern
    }

    /// Displacements of an element in a field.
    pub fn positions(&self, element: usize) -> &[usize] {
        &self.positions[element * self.size..][..self.size]
    }

    /// The diagonal's entry of a free displacement of a field.
    pub fn diagonal_of(&self, position: usize) -> usize {
        self.diagonal[self.number[position]]
    }

    /// Add the stiffness of an element to the matrix.
    pub fn add(&self, element: usize, stiffness: &[f64], values: &mut [f64]) {
        let count = stiffness.len();
        let entries = &self.entries[element * count..][..count];
        for (&entry, value) in entries.iter().zip(stiffness) {
            if entry != OUTSIDE {
                values[entry as usize] += value;
            }
        }
    }

    /// Numbers of an element's unknowns.
    fn numbers<'a>(
        number: &'a [usize],
        positions: &'a [usize],
    ) -> impl Iterator<Item = usize> + 'a {
        positions.iter().map(|&position| number[position])
    }

    fn compress(&mut self) {
        let mut of_column: Vec<Vec<usize>> = vec![Vec::new(); self.unknowns.len()];
        for positions in self.positions.chunks_exact(self.size) {
            let free = || Self::numbers(&self.number, positions).filter(|&i| i != NONE);
            for j in free() {
                of_column[j].extend(free().filter(|&i| i >= j));
            }
        }
        for mut column in of_column {
            column.sort_unstable();
            column.dedup();
            self.diagonal.push(self.rows.len());
            self.rows.append(&mut column);
            self.column_starts.push(self.rows.len());
        }
    }

    fn find_entries(&mut self) {
        let entry = |i: usize, j: usize| {
            if i == NONE || j == NONE || i < j {
                return OUTSIDE;
            }
            let (from, to) = (self.column_starts[j], self.column_starts[j + 1]);
            (from + self.rows[from..to].partition_point(|&row| row < i)) as u32
        };
        let mut entries = Vec::with_capacity(self.positions.len() * self.size);
        for positions in self.positions.chunks_exact(self.size) {
            for i in Self::numbers(&self.number, positions) {
                entries.extend(Self::numbers(&self.number, positions).map(|j| entry(i, j)));
            }
        }
        self.entries = entries;
    }
}

fn element_positions(block: &Block<'_>) -> Vec<usize> {
    let mesh = block.mesh;
    let mut positions = Vec::with_capacity(mesh.rows * mesh.columns * 2 * mesh.elements[0].nodes());
    for row in 0..mesh.rows {
        let from = block.row_offset(row);
        for column in 0..mesh.columns {
            let unknowns = block.local_unknowns(column);
            let of_element = unknowns[..block.mesh.elements[row].nodes()].iter().flatten();
            positions.extend(of_element.map(|at| from + at));
        }
    }
    positions
}

/// Node columns and layers in the order of elimination.
fn dissection(mesh: &Mesh) -> Vec<(usize, usize)> {
    let (width, layers) = (mesh.layer_nodes(), mesh.layers() - 1);
    let half = mesh.columns / 2 * mesh.order;
    let mut nodes = Vec::with_capacity(width * layers);
    dissect((1, half), (0, layers), mesh.order, &mut nodes);
    dissect((half + 1, width), (0, layers), mesh.order, &mut nodes);
    for x in [half, 0] {
        nodes.extend((0..layers).map(|y| (x, y)));
    }
    nodes
}

fn dissect(x: (usize, usize), y: (usize, usize), order: usize, nodes: &mut Vec<(usize, usize)>) {
    let cut = |(from, to): (usize, usize)| {
        let at = ((from + to) / 2 + order / 2) / order * order;
        (at > from && at + 1 < to).then_some(at)
    };
    let (wide, high) = (x.1 - x.0, y.1 - y.0);
    let (by_x, by_y) = match wide * high > LEAF {
        true => (cut(x), cut(y)),
        false => (None, None),
    };
    match (by_x, by_y) {
        (Some(at), _) if wide >= high || by_y.is_none() => {
            dissect((x.0, at), y, order, nodes);
            dissect((at + 1, x.1), y, order, nodes);
            nodes.extend((y.0..y.1).map(|y| (at, y)));
        }
        (_, Some(at)) => {
            dissect(x, (y.0, at), order, nodes);
            dissect(x, (at + 1, y.1), order, nodes);
            nodes.extend((x.0..x.1).map(|x| (x, at)));
        }
        _ => nodes.extend((x.0..x.1).flat_map(|x| (y.0..y.1).map(move |y| (x, y)))),
    }
}
