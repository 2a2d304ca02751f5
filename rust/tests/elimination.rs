//! Block elimination gives the solution of the assembled system.

use crate::noise;
use gripscale_kernel::linear::{self, Elimination, Matrix};

const LAYER: usize = 3;

fn row(layers: usize, index: usize) -> Matrix<f64> {
    let size = layers * LAYER;
    Matrix::from_fn(size, size, |i, j| {
        noise(10_000 * index + size * i + j) + if i == j { 8.0 } else { 0.0 }
    })
}

fn right(layers: usize, index: usize) -> Vec<f64> {
    (0..layers * LAYER)
        .map(|i| noise(10_000 * index + 7777 + i))
        .collect()
}

#[test]
fn elimination_solves_the_assembled_system() {
    for (order, rows) in [(1, 1), (1, 4), (2, 1), (2, 3)] {
        let unknowns = order * rows * LAYER;
        let mut full = Matrix::<f64>::zeros(unknowns, unknowns);
        let mut total = vec![0.0; unknowns];
        for r in 0..rows {
            let (matrix, values) = (row(order + 1, r), right(order + 1, r));
            let offset = r * order * LAYER;
            for i in 0..values.len() {
                // The lid, the last layer, is fixed.
                if offset + i >= unknowns {
                    continue;
                }
                total[offset + i] += values[i];
                for j in 0..values.len() {
                    if offset + j < unknowns {
                        full[(offset + i, offset + j)] += matrix[(i, j)];
                    }
                }
            }
        }
        let expected = linear::solve_dense(&full, &total).unwrap();
        let below = (0..rows - 1).rev().map(|r| row(order + 1, r));
        let elimination = Elimination::new(LAYER, row(order + 1, rows - 1), below);
        let rights: Vec<Vec<f64>> = (0..rows).map(|r| right(order + 1, r)).collect();
        let reduced = elimination.reduce(&rights);
        let surface =
            linear::solve_dense(&elimination.surface_matrix, &reduced.surface_right).unwrap();
        let all = elimination.expand(&reduced, &surface);
        assert_eq!(all.len(), unknowns);
        for (a, b) in all.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-12);
        }
    }
}
