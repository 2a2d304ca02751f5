//! GMRES in single precision, for systems whose caller refines the solution iteratively.
//!
//! Modified Gram-Schmidt, rotations of the small triangular system in double precision (Saad & Schultz,
//! SIAM J. Sci. Stat. Comput. 7 (1986) 856). A preconditioner is part of the operator.

/// Length of a new direction over that of its image at which the Krylov space is complete.
const COMPLETE: f64 = 1e-6;
/// Sums of a scalar product that are taken at once, so that the compiler uses vector registers.
const LANES: usize = 16;

/// An approximate solution.
#[derive(Debug)]
pub struct Approximation {
    pub x: Vec<f32>,
    /// |right - A x|, as the rotations estimate it.
    pub residual: f64,
    pub products: usize,
}

/// Solve A x = `right`, of unit length, until the residual is at most `target`, or with `most` products.
pub fn gmres<E>(
    mut apply: impl FnMut(&[f32]) -> Result<Vec<f32>, E>,
    right: Vec<f32>,
    target: f64,
    most: usize,
) -> Result<Approximation, E> {
    let mut basis = vec![right];
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<(f64, f64)> = Vec::new();
    let mut reduced = vec![1.0];
    for k in 0..most {
        let mut image = apply(&basis[k])?;
        let mut column = Vec::with_capacity(k + 2);
        for direction in &basis {
            column.push(dot(direction, &image));
            add(&mut image, -column[column.len() - 1] as f32, direction);
        }
        let length = dot(&image, &image).sqrt();
        column.push(length);
        for (i, &turn) in rotations.iter().enumerate() {
            (column[i], column[i + 1]) = rotated(turn, column[i], column[i + 1]);
        }
        let radius = column[k].hypot(length);
        let turn = (column[k] / radius, length / radius);
        rotations.push(turn);
        column[k] = radius;
        columns.push(column);
        let (kept, rest) = rotated(turn, reduced[k], 0.0);
        reduced[k] = kept;
        reduced.push(rest);
        if rest.abs() <= target || length <= COMPLETE * radius {
            break;
        }
        if k + 1 < most {
            image.iter_mut().for_each(|value| *value /= length as f32);
            basis.push(image);
        }
    }
    let mut x = vec![0.0; basis[0].len()];
    for (weight, direction) in triangular_solution(&columns, &reduced).iter().zip(&basis) {
        add(&mut x, *weight as f32, direction);
    }
    Ok(Approximation { x, residual: reduced[columns.len()].abs(), products: columns.len() })
}

/// Weights of the directions: the upper triangle of `columns` times them is `right`.
fn triangular_solution(columns: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let mut weights = right[..columns.len()].to_vec();
    for i in (0..columns.len()).rev() {
        let solved: f64 = (i + 1..columns.len()).map(|j| columns[j][i] * weights[j]).sum();
        weights[i] = (weights[i] - solved) / columns[i][i];
    }
    weights
}

fn rotated((cosine, sine): (f64, f64), first: f64, second: f64) -> (f64, f64) {
    (cosine * first + sine * second, cosine * second - sine * first)
}

fn dot(a: &[f32], b: &[f32]) -> f64 {
    pulp::Arch::new().dispatch(|| {
        let mut sums = [0.0_f32; LANES];
        let (whole_a, whole_b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
        let rest = whole_a.remainder().iter().zip(whole_b.remainder());
        let rest: f64 = rest.map(|(&x, &y)| f64::from(x) * f64::from(y)).sum();
        for (x, y) in whole_a.zip(whole_b) {
            for i in 0..LANES {
                sums[i] += x[i] * y[i];
            }
        }
        sums.iter().map(|&sum| f64::from(sum)).sum::<f64>() + rest
    })
}

/// to += factor x.
fn add(to: &mut [f32], factor: f32, x: &[f32]) {
    pulp::Arch::new().dispatch(|| {
        for (to, x) in to.iter_mut().zip(x) {
            *to += factor * x;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_system_that_is_not_symmetric() {
        let matrix = |x: &[f32]| {
            let n = x.len();
            let row = |i: usize| 3.0 * x[i] + x[(i + 1) % n] - 0.5 * x[(i + 5) % n];
            (0..n).map(row).collect::<Vec<f32>>()
        };
        let raw: Vec<f32> = (0..40).map(|i| (0.9 * i as f32).sin() + 0.1 * i as f32).collect();
        let length = dot(&raw, &raw).sqrt() as f32;
        let right: Vec<f32> = raw.iter().map(|value| value / length).collect();
        let apply = |x: &[f32]| Ok::<_, ()>(matrix(x));
        let solved = gmres(apply, right.clone(), 1e-5, 60).unwrap();
        let mut rest = right.clone();
        add(&mut rest, -1.0, &matrix(&solved.x));
        let true_residual = dot(&rest, &rest).sqrt();
        assert!(solved.residual <= 1e-5 && solved.products < 40);
        assert!((true_residual / solved.residual - 1.0).abs() < 0.2, "{true_residual}");
        let few = gmres(apply, right.clone(), 1e-5, 3).unwrap();
        assert!(few.products == 3 && few.residual > 1e-5);
        assert!(gmres(|_| Err(()), right, 1e-5, 3).is_err());
    }
}
