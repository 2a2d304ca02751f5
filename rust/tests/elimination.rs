//! Block elimination gives the solution of the assembled system.

use crate::noise;
use gripscale_kernel::linear::{self, Elimination, Factor, Matrix};
use gripscale_kernel::watch::Watch;

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

fn dense(matrix: &Matrix<f64>, right: &[f64]) -> Vec<f64> {
    let solved = linear::solve_dense(matrix, right, &Watch::endless());
    solved.unwrap().unwrap()
}

/// Sizes beside the tiles in which large matrices are factored, multiplied and solved.
#[test]
fn a_matrix_of_several_panels_is_solved_as_one() {
    for size in [511, 512, 513, 1025] {
        // No entry of the diagonal stands out: rows are exchanged.
        let matrix = Matrix::from_fn(size, size, |i, j| noise(size * i + j));
        let right = Matrix::from_fn(size, 600, |i, j| noise(7 * size + 600 * i + j));
        let watch = Watch::endless();
        let mut x = right.clone();
        let factor = Factor::new(matrix.as_ref(), &watch).unwrap();
        factor.solve(&mut x, &watch).unwrap();
        let left = &matrix * &x - &right;
        // Backward stable: the residual is of the order of the size times round-off.
        let bound = 1e-15 * size as f64 * x.norm_max();
        assert!(left.norm_max() < bound, "{size}: {}", left.norm_max());
    }
}

#[test]
fn elimination_solves_the_assembled_system() {
    let watch = Watch::endless();
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
        let expected = dense(&full, &total);
        let below = (0..rows - 1).rev().map(|r| Ok(row(order + 1, r)));
        let elimination = Elimination::new(LAYER, row(order + 1, rows - 1), below, &watch).unwrap();
        let rights: Vec<Vec<f64>> = (0..rows).map(|r| right(order + 1, r)).collect();
        let reduced = elimination.reduce(&rights, &watch).unwrap();
        let surface = dense(&elimination.surface_matrix, &reduced.surface_right);
        let all = elimination.expand(&reduced, &surface, &watch).unwrap();
        assert_eq!(all.len(), unknowns);
        for (a, b) in all.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-12);
        }
    }
}
