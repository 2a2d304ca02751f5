//! GMRES for operators that are applied, never formed, preconditioned from the right.
//!
//! min |r - A M^-1 V y| over the Krylov space of A M^-1 (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7
//! (1986) 856; Saad, "Iterative Methods for Sparse Linear Systems", 2nd ed. (2003), section 9.3.2).
//! With the preconditioner on the right the residual that is minimised is the true one.

use super::hessenberg::Hessenberg;
use super::vectors::{add, dot, norm};
use crate::executor::{Executor, Threads};
use crate::status::Status;

/// Numbers of a vector that a thread takes at a time. Sums are taken piece by piece in a fixed order, so
/// that they do not depend on the number of threads.
const PIECE: usize = 8192;

/// An approximate solution and its residual.
#[derive(Debug, Clone)]
pub struct GmresSolution {
    pub y: Vec<f64>,
    pub residual: Vec<f64>,
    pub iterations: usize,
}

/// Solve A M^-1 y = `right` approximately, where `apply` is the product with A M^-1: until the norm of
/// the residual is at most `target`, or for at most `limit` products. At most `basis` directions are
/// kept before the iteration restarts. The caller computes the solution M^-1 y from y.
pub fn gmres(
    mut apply: impl FnMut(&[f64], &mut [f64]),
    right: &[f64],
    target: f64,
    (basis, limit): (usize, usize),
    executor: &Executor<'_>,
) -> Result<GmresSolution, Status> {
    let mut y = vec![0.0; right.len()];
    let mut residual = right.to_vec();
    let (mut iterations, mut size) = (0, norm(&residual));
    while size > target && iterations < limit {
        let count = basis.min(limit - iterations);
        // Extend the space until it holds a solution, or is full.
        let mut space = KrylovSpace::new(residual, size, executor.threads);
        while space.hessenberg.residual() > target && space.hessenberg.size() < count {
            executor.check_cancelled()?;
            let mut next = vec![0.0; right.len()];
            apply(&space.basis[space.hessenberg.size()], &mut next);
            iterations += 1;
            if !space.add(next) {
                break;
            }
        }
        // Add its best solution.
        add(&mut y, 1.0, &space.combined(&space.hessenberg.weights()));
        residual = space.combined(&space.hessenberg.residual_coordinates());
        let before = std::mem::replace(&mut size, norm(&residual));
        if size >= before {
            break;
        }
    }
    if !size.is_finite() {
        return Err(Status::NotFinite);
    }
    Ok(GmresSolution { y, residual, iterations })
}

/// An orthonormal basis of a Krylov space.
struct KrylovSpace<'t> {
    threads: &'t Threads,
    basis: Vec<Vec<f64>>,
    hessenberg: Hessenberg,
}

impl<'t> KrylovSpace<'t> {
    fn new(mut first: Vec<f64>, norm: f64, threads: &'t Threads) -> Self {
        first.iter_mut().for_each(|value| *value /= norm);
        Self { threads, basis: vec![first], hessenberg: Hessenberg::new(norm) }
    }

    /// Add the image of the last direction; false if it lies in the space already.
    fn add(&mut self, mut image: Vec<f64>) -> bool {
        let mut column = vec![0.0; self.basis.len() + 1];
        let before = self.add_and_dot(&mut image, None, None).sqrt();
        let mut rest = self.orthogonalise(&mut image, &mut column);
        // If little is left of the image, so are its digits: repeat (Giraud, Langou & Rozloznik, 2005).
        if rest < 0.1 * before {
            rest = self.orthogonalise(&mut image, &mut column);
        }
        column[self.basis.len()] = rest;
        self.hessenberg.add(column);
        if rest > 1e-14 * before {
            image.iter_mut().for_each(|value| *value /= rest);
            self.basis.push(image);
            return true;
        }
        // The space is invariant: the rest of the residual has no further direction.
        self.basis.push(vec![0.0; image.len()]);
        false
    }

    /// Subtract the components along the basis from `image`, one after the other (modified
    /// Gram-Schmidt), and add them to `column`; returns the norm of the rest.
    fn orthogonalise(&self, image: &mut [f64], column: &mut [f64]) -> f64 {
        let mut part = self.add_and_dot(image, None, self.basis.first());
        for (i, direction) in self.basis.iter().enumerate() {
            column[i] += part;
            part = self.add_and_dot(image, Some((-part, direction)), self.basis.get(i + 1));
        }
        part.sqrt()
    }

    /// `to` += factor x, and then the scalar product of `to` with a vector, with itself if none is given.
    fn add_and_dot(
        &self,
        to: &mut [f64],
        added: Option<(f64, &Vec<f64>)>,
        with: Option<&Vec<f64>>,
    ) -> f64 {
        let mut sums = vec![0.0; to.len().div_ceil(PIECE)];
        let size = 4 * to.len();
        let pieces = sums.iter_mut().zip(to.chunks_mut(PIECE)).enumerate();
        let mut workspaces = vec![(); self.threads.count_for(size)];
        self.threads.share(size, &mut workspaces, pieces, |(), (piece, (sum, to))| {
            let within = piece * PIECE..piece * PIECE + to.len();
            if let Some((factor, x)) = added {
                add(to, factor, &x[within.clone()]);
            }
            *sum = with.map_or_else(|| dot(to, to), |with| dot(to, &with[within]));
        });
        sums.iter().sum()
    }

    /// The sum of the directions times `weights`.
    fn combined(&self, weights: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.basis[0].len()];
        let size = sum.len() * weights.len();
        let mut workspaces = vec![(); self.threads.count_for(size)];
        let pieces = sum.chunks_mut(PIECE).enumerate();
        self.threads.share(size, &mut workspaces, pieces, |(), (piece, to)| {
            for (weight, direction) in weights.iter().zip(&self.basis) {
                add(to, *weight, &direction[piece * PIECE..][..to.len()]);
            }
        });
        sum
    }
}
