//! Linear algebra: dense matrices, small complex blocks, and GMRES.

use crate::linear::vectors::dot;
use crate::linear::{add, gmres, invert, norm, single_gmres, Factor, Matrix};
use crate::spectral::Complex64;

use crate::tests::fixture::{noise, serial};

#[test]
fn a_dense_matrix_is_solved() {
    let size = 200;
    // No entry of the diagonal stands out: rows are exchanged.
    let matrix = Matrix::from_fn(size, size, |i, j| noise(size * i + j));
    let right: Vec<f64> = (0..size).map(|i| noise(7000 + i)).collect();
    let mut x = right.clone();
    assert!(Factor::new(&matrix).solve(&mut x));
    let largest = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for i in 0..size {
        let product: f64 = (0..size).map(|j| matrix[(i, j)] * x[j]).sum();
        // Backward stable: the residual is of the order of the size times round-off.
        assert!((product - right[i]).abs() < 1e-15 * size as f64 * largest);
    }
    let singular = Matrix::from_fn(3, 3, |i, j| ((i + 1) * (j + 1)) as f64);
    assert!(!Factor::new(&singular).solve(&mut [1.0, 0.0, 0.0]));
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
                let sum: Complex64 =
                    (0..size).map(|k| block[k * size + i] * inverse[j * size + k]).sum();
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((sum - expected).norm() < 1e-12, "{size}: {sum}");
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
        let solution = gmres(apply, &right, target, (basis, most), &serial()).unwrap();
        let mut product = vec![0.0; size];
        apply(&solution.y, &mut product);
        let mut square = 0.0;
        for i in 0..size {
            assert!((right[i] - product[i] - solution.residual[i]).abs() < 1e-14);
            square += (right[i] - product[i]).powi(2);
        }
        assert!(solution.iterations <= most && (square.sqrt() <= 1.01 * target || most == 5));
        assert!(basis < size || solution.iterations <= size);
    }
}

#[test]
fn single_precision_solves_a_system_that_is_not_symmetric() {
    let matrix = |x: &[f32]| -> Vec<f32> {
        let n = x.len();
        (0..n).map(|i| 3.0 * x[i] + x[(i + 1) % n] - 0.5 * x[(i + 5) % n]).collect()
    };
    let raw: Vec<f32> = (0..40).map(|i| (0.9 * i as f32).sin() + 0.1 * i as f32).collect();
    let right: Vec<f32> = raw.iter().map(|value| value / norm(&raw) as f32).collect();
    let apply = |x: &[f32]| Ok::<_, ()>(matrix(x));
    let solved = single_gmres::gmres(apply, right.clone(), 1e-5, 60).unwrap();
    let mut rest = right.clone();
    add(&mut rest, -1.0, &matrix(&solved.x));
    assert!(solved.residual <= 1e-5 && solved.products < 40);
    assert!((norm(&rest) / solved.residual - 1.0).abs() < 0.2, "{}", norm(&rest));
    let few = single_gmres::gmres(apply, right.clone(), 1e-5, 3).unwrap();
    assert!(few.products == 3 && few.residual > 1e-5);
    assert!(single_gmres::gmres(|_| Err(()), right, 1e-5, 3).is_err());
}

/// Added one after the other in single precision, a sum of ones ends at 2^24 in each register.
#[test]
fn a_long_scalar_product_keeps_its_digits() {
    let ones = vec![0.1_f32; 40_000_000];
    let sum = dot(&ones, &ones);
    assert!((sum / (4e7 * f64::from(0.1_f32).powi(2)) - 1.0).abs() < 1e-4, "{sum}");
}
