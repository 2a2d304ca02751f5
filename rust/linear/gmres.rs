//! GMRES for operators that are applied, never formed, preconditioned from the right.
//!
//! min |r - A M^-1 V y| over the Krylov space of A M^-1 (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7
//! (1986) 856; Saad, "Iterative Methods for Sparse Linear Systems", 2nd ed. (2003), section 9.3.2).
//! With the preconditioner on the right the residual that is minimised is the true one.

use crate::status::Status;
use crate::threads::Threads;
use crate::watch::Watch;

/// Numbers of a vector that a thread takes at a time; what is summed is summed piece by piece, in
/// their order.
const PIECE: usize = 8192;

/// What an iteration found.
#[derive(Debug, Clone)]
pub struct Found {
    pub y: Vec<f64>,
    /// The residual that is left.
    pub left: Vec<f64>,
    pub iterations: usize,
}

/// An approximate y of A M^-1 y = `right`, with `apply` the product with A M^-1: until the residual
/// is at most `target`, or for at most `most` products. At most `basis` directions are kept at a
/// time. The answer is handed over as y, to be turned into M^-1 y by the caller.
pub fn gmres(
    mut apply: impl FnMut(&[f64], &mut [f64]),
    right: &[f64],
    target: f64,
    (basis, most): (usize, usize),
    watch: &Watch<'_>,
) -> Result<Found, Status> {
    let mut y = vec![0.0; right.len()];
    let mut left = right.to_vec();
    let (mut iterations, mut residual) = (0, norm(&left));
    while residual > target && iterations < most {
        let count = basis.min(most - iterations);
        let mut space = Space::new(left, residual, watch.threads);
        while space.residual() > target && space.size() < count {
            watch.look()?;
            let mut next = vec![0.0; right.len()];
            apply(space.last(), &mut next);
            iterations += 1;
            if !space.add(next) {
                break;
            }
        }
        let change;
        (change, left) = space.solution();
        add(&mut y, 1.0, &change);
        let before = std::mem::replace(&mut residual, norm(&left));
        if residual >= before {
            break;
        }
    }
    if !residual.is_finite() {
        return Err(Status::NotFinite);
    }
    Ok(Found {
        y,
        left,
        iterations,
    })
}

/// An orthonormal basis of a Krylov space with its Hessenberg matrix, rotated to be triangular.
struct Space<'t> {
    threads: &'t Threads,
    basis: Vec<Vec<f64>>,
    /// Columns of the triangular factor.
    columns: Vec<Vec<f64>>,
    /// Cosine and sine of every rotation.
    turns: Vec<(f64, f64)>,
    /// The right-hand side, rotated; its last entry is the residual.
    rotated: Vec<f64>,
}

impl<'t> Space<'t> {
    fn new(mut first: Vec<f64>, norm: f64, threads: &'t Threads) -> Self {
        first.iter_mut().for_each(|value| *value /= norm);
        Self {
            threads,
            basis: vec![first],
            columns: Vec::new(),
            turns: Vec::new(),
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

    /// Add the image of the last direction; false if it leads nowhere new.
    fn add(&mut self, mut image: Vec<f64>) -> bool {
        let mut column: Vec<f64> = vec![0.0; self.size() + 2];
        let before = self.add_and_dot(&mut image, None, None).sqrt();
        let mut left = self.orthogonalise(&mut image, &mut column);
        // Where most of it went, so did its digits: once more (Giraud, Langou & Rozloznik, 2005).
        if left < 0.1 * before {
            left = self.orthogonalise(&mut image, &mut column);
        }
        let last = self.size();
        column[last + 1] = left;
        for (i, (cosine, sine)) in self.turns.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            column[i] = cosine * a + sine * b;
            column[i + 1] = cosine * b - sine * a;
        }
        let radius = column[last].hypot(left);
        let (cosine, sine) = (column[last] / radius, left / radius);
        column[last] = radius;
        column.pop();
        self.turns.push((cosine, sine));
        self.columns.push(column);
        self.rotated.push(-sine * self.rotated[last]);
        self.rotated[last] *= cosine;
        if left > 1e-14 * before {
            image.iter_mut().for_each(|value| *value /= left);
            self.basis.push(image);
            return true;
        }
        // Invariant: what is left of the residual has no direction any more.
        self.basis.push(vec![0.0; image.len()]);
        false
    }

    /// Take the directions of the basis out of `image`, one after the other (modified Gram-Schmidt),
    /// and add what there was of them to `column`; returns the norm of what is left.
    fn orthogonalise(&self, image: &mut [f64], column: &mut [f64]) -> f64 {
        let mut part = self.add_and_dot(image, None, self.basis.first());
        for (i, direction) in self.basis.iter().enumerate() {
            column[i] += part;
            part = self.add_and_dot(image, Some((-part, direction)), self.basis.get(i + 1));
        }
        part.sqrt()
    }

    /// `to` += factor x, and then its scalar product with a vector, with itself if there is none.
    fn add_and_dot(
        &self,
        to: &mut [f64],
        added: Option<(f64, &Vec<f64>)>,
        with: Option<&Vec<f64>>,
    ) -> f64 {
        let mut sums = vec![0.0; to.len().div_ceil(PIECE)];
        let size = 4 * to.len();
        let pieces = sums.iter_mut().zip(to.chunks_mut(PIECE)).enumerate();
        let mut rooms = vec![(); self.threads.on(size)];
        self.threads
            .share(size, &mut rooms, pieces, |(), (piece, (sum, to))| {
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
        let mut rooms = vec![(); self.threads.on(size)];
        let pieces = to.chunks_mut(PIECE).enumerate();
        self.threads
            .share(size, &mut rooms, pieces, |(), (piece, to)| {
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
            let known: f64 = (i + 1..size).map(|j| self.columns[j][i] * weights[j]).sum();
            weights[i] = (weights[i] - known) / self.columns[i][i];
        }
        let mut x = vec![0.0; self.basis[0].len()];
        self.combine(&mut x, &weights);
        // The residual is the rotated last unit vector, in the basis.
        let mut coordinates = vec![0.0; size + 1];
        coordinates[size] = self.rotated[size];
        for (i, (cosine, sine)) in self.turns.iter().enumerate().rev() {
            let (a, b) = (coordinates[i], coordinates[i + 1]);
            coordinates[i] = cosine * a - sine * b;
            coordinates[i + 1] = sine * a + cosine * b;
        }
        let mut residual = vec![0.0; x.len()];
        self.combine(&mut residual, &coordinates);
        (x, residual)
    }
}

pub(crate) fn norm(x: &[f64]) -> f64 {
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
pub(crate) fn add(to: &mut [f64], factor: f64, x: &[f64]) {
    pulp::Arch::new().dispatch(|| {
        for (to, x) in to.iter_mut().zip(x) {
            *to += factor * x;
        }
    });
}
