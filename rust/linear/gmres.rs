//! GMRES for operators that are applied, never formed, preconditioned from the right.
//!
//! min |r - A M^-1 V y| over the Krylov space of A M^-1 (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7
//! (1986) 856; Saad, "Iterative Methods for Sparse Linear Systems", 2nd ed. (2003), section 9.3.2).
//! With the preconditioner on the right the residual that is minimised is the true one.

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
        let mut space = KrylovSpace::new(residual, size, executor.threads);
        while space.residual() > target && space.size() < count {
            executor.check_cancelled()?;
            let mut next = vec![0.0; right.len()];
            apply(space.last(), &mut next);
            iterations += 1;
            if !space.add(next) {
                break;
            }
        }
        let change;
        (change, residual) = space.solution();
        add(&mut y, 1.0, &change);
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

/// An orthonormal basis of a Krylov space with its Hessenberg matrix, rotated to be triangular.
struct KrylovSpace<'t> {
    threads: &'t Threads,
    basis: Vec<Vec<f64>>,
    /// Columns of the triangular factor.
    columns: Vec<Vec<f64>>,
    /// Cosine and sine of every rotation.
    rotations: Vec<(f64, f64)>,
    /// The right-hand side, rotated; its last entry is the residual.
    rotated: Vec<f64>,
}

impl<'t> KrylovSpace<'t> {
    fn new(mut first: Vec<f64>, norm: f64, threads: &'t Threads) -> Self {
        first.iter_mut().for_each(|value| *value /= norm);
        Self {
            threads,
            basis: vec![first],
            columns: Vec::new(),
            rotations: Vec::new(),
            rotated: vec![norm],
        }
    }

    fn size(&self) -> usize {
        self.columns.len()
    }

    fn last(&self) -> &[f64] {
        &self.basis[self.size()]
    }

    fn residual(&self) -> f64 {
        self.rotated[self.size()].abs()
    }

    /// Add the image of the last direction; false if it lies in the space already.
    fn add(&mut self, mut image: Vec<f64>) -> bool {
        let mut column: Vec<f64> = vec![0.0; self.size() + 2];
        let before = self.add_and_dot(&mut image, None, None).sqrt();
        let mut rest = self.orthogonalise(&mut image, &mut column);
        // If little is left of the image, so are its digits: repeat (Giraud, Langou & Rozloznik, 2005).
        if rest < 0.1 * before {
            rest = self.orthogonalise(&mut image, &mut column);
        }
        let last = self.size();
        column[last + 1] = rest;
        for (i, (cosine, sine)) in self.rotations.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            column[i] = cosine * a + sine * b;
            column[i + 1] = cosine * b - sine * a;
        }
        let radius = column[last].hypot(rest);
        let (cosine, sine) = (column[last] / radius, rest / radius);
        column[last] = radius;
        column.pop();
        self.rotations.push((cosine, sine));
        self.columns.push(column);
        self.rotated.push(-sine * self.rotated[last]);
        self.rotated[last] *= cosine;
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

    /// `to` += the sum of the directions of the basis times `weights`.
    fn combine(&self, to: &mut [f64], weights: &[f64]) {
        let size = to.len() * weights.len();
        let mut workspaces = vec![(); self.threads.count_for(size)];
        let pieces = to.chunks_mut(PIECE).enumerate();
        self.threads.share(size, &mut workspaces, pieces, |(), (piece, to)| {
            for (weight, direction) in weights.iter().zip(&self.basis) {
                add(to, *weight, &direction[piece * PIECE..][..to.len()]);
            }
        });
    }

    /// The vector of smallest residual, and that residual.
    fn solution(&self) -> (Vec<f64>, Vec<f64>) {
        let size = self.size();
        let mut weights = self.rotated[..size].to_vec();
        for i in (0..size).rev() {
            let solved: f64 = (i + 1..size).map(|j| self.columns[j][i] * weights[j]).sum();
            weights[i] = (weights[i] - solved) / self.columns[i][i];
        }
        let mut x = vec![0.0; self.basis[0].len()];
        self.combine(&mut x, &weights);
        // The residual is the rotated last unit vector, in the basis.
        let mut coordinates = vec![0.0; size + 1];
        coordinates[size] = self.rotated[size];
        for (i, (cosine, sine)) in self.rotations.iter().enumerate().rev() {
            let (a, b) = (coordinates[i], coordinates[i + 1]);
            coordinates[i] = cosine * a - sine * b;
            coordinates[i + 1] = sine * a + cosine * b;
        }
        let mut residual = vec![0.0; x.len()];
        self.combine(&mut residual, &coordinates);
        (x, residual)
    }
}

pub fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    pulp::Arch::new().dispatch(|| {
        let mut sums = [0.0; 16];
        let (whole_a, whole_b) = (a.chunks_exact(16), b.chunks_exact(16));
        let rest = whole_a.remainder().iter().zip(whole_b.remainder());
        let rest: f64 = rest.map(|(x, y)| x * y).sum();
        for (x, y) in whole_a.zip(whole_b) {
            for i in 0..16 {
                sums[i] += x[i] * y[i];
            }
        }
        sums.iter().sum::<f64>() + rest
    })
}

/// to += factor x.
pub fn add(to: &mut [f64], factor: f64, x: &[f64]) {
    pulp::Arch::new().dispatch(|| {
        for (to, x) in to.iter_mut().zip(x) {
            *to += factor * x;
        }
    });
}
