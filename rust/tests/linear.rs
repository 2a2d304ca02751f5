//! Linear algebra: panels of a large matrix, small complex blocks, and GMRES.

use gripscale_kernel::linear::{gmres, invert, Factor, Matrix};
use gripscale_kernel::spectral::Complex64;
use gripscale_kernel::watch::Watch;

use crate::noise;

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

/// No entry of the diagonal stands out: rows are exchanged. Right to the condition times round-off.
#[test]
fn a_block_times_its_inverse_is_one() {
    for size in 1..=8 {
        let entry = |at: usize| Complex64::new(noise(100 * size + at), noise(5000 + at));
        let block: Vec<Complex64> = (0..size * size).map(entry).collect();
        let mut inverse = block.clone();
        assert!(invert(&mut inverse, size));
        for i in 0..size {
            for j in 0..size {
                let sum: Complex64 = (0..size)
                    .map(|k| block[k * size + i] * inverse[j * size + k])
                    .sum();
                let one = if i == j { 1.0 } else { 0.0 };
                assert!((sum - one).norm() < 1e-12, "{size}: {sum}");
            }
        }
    }
    assert!(!invert(&mut [Complex64::default(); 4], 2));
}

/// Without preconditioner, starting anew every 12 products: the residual handed over is that of the
/// answer, at most the target, and a system of n unknowns needs no more than n products.
#[test]
fn gmres_leaves_the_residual_it_says() {
    let size = 40;
    let matrix = Matrix::from_fn(size, size, |i, j| {
        0.1 * noise(size * i + j) + if i == j { 2.0 } else { 0.0 }
    });
    let right: Vec<f64> = (0..size).map(|i| noise(9000 + i)).collect();
    let apply = |x: &[f64], out: &mut [f64]| {
        for i in 0..size {
            out[i] = (0..size).map(|j| matrix[(i, j)] * x[j]).sum();
        }
    };
    for (basis, most, target) in [(12, 500, 1e-10), (100, 500, 1e-12), (100, 5, 1e-12)] {
        let found = gmres(apply, &right, target, (basis, most), &Watch::endless()).unwrap();
        let mut product = vec![0.0; size];
        apply(&found.y, &mut product);
        let mut left = 0.0;
        for i in 0..size {
            assert!((right[i] - product[i] - found.left[i]).abs() < 1e-14);
            left += (right[i] - product[i]).powi(2);
        }
        assert!(found.iterations <= most && (left.sqrt() <= 1.01 * target || most == 5));
        assert!(basis < size || found.iterations <= size);
    }
}
