//! Where the entries of the assembled tangent stand, in the order in which they are eliminated.

use faer::sparse::SymbolicSparseColMatRef;
use gripscale_kernel::fem::block::Block;
use gripscale_kernel::fem::mesh::Mesh;

use crate::local_tangent::places;

/// Instead of the number of what is not eliminated.
pub const NONE: usize = usize::MAX;

/// Nodes with fewer are not cut further.
const LEAF: usize = 6;

/// Node columns and layers in the order of elimination.
pub type Order = Vec<(usize, usize)>;

/// Column by column.
pub fn natural(mesh: &Mesh) -> Order {
    let layers = mesh.layers() - 1;
    let columns = 0..mesh.layer_nodes();
    columns
        .flat_map(|x| (0..layers).map(move |y| (x, y)))
        .collect()
}

/// Nested dissection (George, SIAM J. Numer. Anal. 10 (1973) 345) of the periodic strip: two cuts
/// from surface to lid, then the longer side halved, along lines of element edges.
pub fn dissection(mesh: &Mesh) -> Order {
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

fn dissect(x: (usize, usize), y: (usize, usize), order: usize, nodes: &mut Order) {
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

/// Compressed columns, and where the entries of every element go.
pub struct Pattern {
    pub size: usize,
    pub columns: Vec<usize>,
    pub rows: Vec<usize>,
    /// Number of every displacement of a field; the lid's have none.
    pub number: Vec<usize>,
    pub diagonal: Vec<usize>,
    /// Unknowns of every element in a field, element after element.
    pub places: Vec<usize>,
    /// Places of an element's entries, row by row; `NONE` outside the matrix.
    pub to: Vec<usize>,
}

impl Pattern {
    /// All of the matrix or its lower triangle.
    pub fn new(block: &Block<'_>, order: &Order, lower: bool) -> Self {
        let mesh = block.mesh;
        let mut number = vec![NONE; mesh.layers() * mesh.layer_size()];
        for (i, &(x, y)) in order.iter().enumerate() {
            for d in 0..2 {
                number[y * mesh.layer_size() + mesh.place(x, d)] = 2 * i + d;
            }
        }
        let size = 2 * order.len();
        let elements = (0..mesh.rows).flat_map(|row| (0..mesh.columns).map(move |c| (row, c)));
        let places: Vec<usize> = elements.flat_map(|at| places(block, at)).collect();
        let per_element = 2 * mesh.elements[0].nodes();
        let inside = |i: usize, j: usize| i != NONE && j != NONE && (!lower || i >= j);
        let numbers = |own: &[usize]| -> Vec<usize> { own.iter().map(|&p| number[p]).collect() };
        let mut of_column: Vec<Vec<usize>> = vec![Vec::new(); size];
        for own in places.chunks_exact(per_element).map(numbers) {
            for &j in own.iter().filter(|&&j| j != NONE) {
                of_column[j].extend(own.iter().filter(|&&i| inside(i, j)));
            }
        }
        let (mut columns, mut rows) = (vec![0], Vec::new());
        for column in &mut of_column {
            column.sort_unstable();
            column.dedup();
            rows.extend_from_slice(column);
            columns.push(rows.len());
        }
        let place = |i: usize, j: usize| match inside(i, j) {
            true => columns[j] + of_column[j].partition_point(|&row| row < i),
            false => NONE,
        };
        let mut to = Vec::with_capacity(places.len() * per_element);
        for own in places.chunks_exact(per_element).map(numbers) {
            for &i in &own {
                to.extend(own.iter().map(|&j| place(i, j)));
            }
        }
        let diagonal = (0..size).map(|j| place(j, j)).collect();
        Self {
            size,
            columns,
            rows,
            number,
            diagonal,
            places,
            to,
        }
    }

    pub fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.size, self.size, &self.columns, None, &self.rows)
    }
}
