//! GMRES in single precision, for systems whose caller refines the solution iteratively; one Gram-Schmidt pass
//! is then enough. A preconditioner is part of the operator.

use super::hessenberg::Hessenberg;
use super::vectors::{add, dot, norm};

/// Length of a new direction over that of its image at which the Krylov space is complete.
const COMPLETE: f64 = 1e-6;

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
    let mut x = vec![0.0; right.len()];
    let mut basis = vec![right];
    let mut hessenberg = Hessenberg::new(1.0);
    while hessenberg.size() < most {
        let mut image = apply(&basis[hessenberg.size()])?;
        let mut column = Vec::with_capacity(basis.len() + 1);
        for direction in &basis {
            let part = dot(direction, &image);
            add(&mut image, -part as f32, direction);
            column.push(part);
        }
        let length = norm(&image);
        column.push(length);
        let radius = hessenberg.add(column);
        if hessenberg.residual() <= target || length <= COMPLETE * radius {
            break;
        }
        image.iter_mut().for_each(|value| *value /= length as f32);
        basis.push(image);
    }
    for (weight, direction) in hessenberg.weights().iter().zip(&basis) {
        add(&mut x, *weight as f32, direction);
    }
    Ok(Approximation { x, residual: hessenberg.residual(), products: hessenberg.size() })
}
