//! Sums of vectors and scalar products, vectorised in a fixed order.

use crate::spectral::Real;

/// Sums of a scalar product that are taken at once, so that the compiler uses vector registers.
const LANES: usize = 16;
/// Values whose sums are taken in the precision of the values: that of more would lose digits.
const BLOCK: usize = 1 << 16;

pub fn norm<T: Real>(x: &[T]) -> f64 {
    dot(x, x).sqrt()
}

pub fn dot<T: Real>(a: &[T], b: &[T]) -> f64 {
    a.chunks(BLOCK).zip(b.chunks(BLOCK)).map(|(a, b)| dot_of_block(a, b)).sum()
}

fn dot_of_block<T: Real>(a: &[T], b: &[T]) -> f64 {
    pulp::Arch::new().dispatch(|| {
        let mut sums = [T::default(); LANES];
        let (whole_a, whole_b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
        let rest = whole_a.remainder().iter().zip(whole_b.remainder());
        let rest: f64 = rest.map(|(&x, &y)| x.into() * y.into()).sum();
        for (x, y) in whole_a.zip(whole_b) {
            for i in 0..LANES {
                sums[i] += x[i] * y[i];
            }
        }
        sums.into_iter().map(T::into).sum::<f64>() + rest
    })
}

/// to += factor x.
pub fn add<T: Real>(to: &mut [T], factor: T, x: &[T]) {
    pulp::Arch::new().dispatch(|| {
        for (to, x) in to.iter_mut().zip(x) {
            *to += factor * *x;
        }
    });
}
