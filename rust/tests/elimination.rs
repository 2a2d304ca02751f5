//! Block elimination gives the solution of the assembled system.

use crate::noise;
use gripscale_kernel::linear::{self, Matrix, RowSystem};

const LAYER: usize = 3;

fn row(layers: usize, index: usize) -> RowSystem {
    let size = layers * LAYER;
    let seed = 10_000 * index;
    RowSystem {
        matrix: Matrix::from_fn(size, size, |i, j| {
            noise(seed + size * i + j) + if i == j { 8.0 } else { 0.0 }
        }),
        right: (0..size).map(|i| noise(seed + 7777 + i)).collect(),
    }
}

#[test]
fn elimination_solves_the_assembled_system() {
    for (order, rows) in [(1, 1), (1, 4), (2, 1), (2, 3)] {
        let unknowns = order * rows * LAYER;
        let mut full = Matrix::<f64>::zeros(unknowns, unknowns);
        let mut right = vec![0.0; unknowns];
        for r in 0..rows {
            let system = row(order + 1, r);
            let offset = r * order * LAYER;
            for i in 0..system.right.len() {
                // The lid, the last layer, is fixed.
                if offset + i >= unknowns {
                    continue;
                }
                right[offset + i] += system.right[i];
                for j in 0..system.right.len() {
                    if offset + j < unknowns {
                        full[(offset + i, offset + j)] += system.matrix[(i, j)];
                    }
                }
            }
        }
        let expected = linear::solve_dense(&full, &right).unwrap();
        let elimination = linear::eliminate(rows, LAYER, |r| row(order + 1, r));
        let surface =
            linear::solve_dense(&elimination.surface_matrix, &elimination.surface_right).unwrap();
        let all = elimination.expand(&surface);
        assert_eq!(all.len(), unknowns);
        for (a, b) in all.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-12);
        }
    }
}
