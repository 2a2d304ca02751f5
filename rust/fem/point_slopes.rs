//! Deformation and slopes at one Gauss point of several columns at a time, and their averages along a row.
//!
//! The slopes of the memory are computed from the deformation in every product, because loading them from
//! memory would take longer.

use crate::material::kinematics::{cofactor, Deformation, Gradient};

/// Columns at a time.
pub const LANES: usize = 8;
pub type Lane = [f64; LANES];

/// Slopes in `LANES` columns; zeros beyond the last column.
#[derive(Clone, Default)]
pub struct PointSlopes {
    /// Upper triangle of dP/dF at fixed memory by rows, symmetric as P then has a potential; times the
    /// point's weight.
    stiffness: [Lane; 10],
    f: [Lane; 4],
    /// 1 / J.
    inverse: Lane,
    /// J^(-2/3).
    scale: Lane,
}

/// Averages along a row of the slopes at one Gauss point of its elements.
#[derive(Clone)]
pub struct AveragedSlopes {
    pub stiffness: [f64; 16],
    pub volume: [f64; 4],
    /// dP/dH times dY/dF.
    pub memory: Option<[f64; 16]>,
}

/// SlopeSums along a row of the slopes at one Gauss point of its elements, without its weight.
#[derive(Clone, Default)]
pub struct SlopeSums {
    stiffness: [Gradient; 4],
    volume: Gradient,
    /// dP/dH times dY/dF, with the weight.
    memory: [f64; 16],
}

impl SlopeSums {
    pub fn add(&mut self, point: &Deformation, stiffness: &[Gradient; 4]) {
        for (sums, values) in self.stiffness.iter_mut().zip(stiffness) {
            (0..4).for_each(|k| sums[k] += values[k]);
        }
        let volume = cofactor(&point.f);
        (0..4).for_each(|k| self.volume[k] += volume[k]);
    }

    /// Add dP/dH dY/dF of several columns. The memory responds to waves shorter than the changes of F with
    /// the mean of this product; where F changes much, the product of the means is far from it.
    #[inline(always)]
    pub fn add_memory(&mut self, slopes: &PointSlopes, weight: f64) {
        for b in 0..4 {
            let mut df = [[0.0; LANES]; 4];
            df[b] = [1.0; LANES];
            let mut p = [[0.0; LANES]; 4];
            slopes.add_memory(&mut p, &slopes.remembered(&df, &slopes.volume(&df)), weight);
            for (a, p) in p.iter().enumerate() {
                self.memory[4 * a + b] += p.iter().sum::<f64>();
            }
        }
    }

    pub fn average(&self, columns: usize, weight: f64, remembers: bool) -> AveragedSlopes {
        let share = 1.0 / columns as f64;
        AveragedSlopes {
            stiffness: std::array::from_fn(|at| self.stiffness[at / 4][at % 4] * weight * share),
            volume: self.volume.map(|sum| sum * weight * share),
            memory: remembers.then(|| self.memory.map(|sum| sum * share)),
        }
    }
}

impl PointSlopes {
    pub fn put(
        &mut self,
        lane: usize,
        weight: f64,
        point: &Deformation,
        stiffness: &[Gradient; 4],
    ) {
        let mut entry = 0;
        for a in 0..4 {
            for b in a..4 {
                self.stiffness[entry][lane] = weight * stiffness[a][b];
                entry += 1;
            }
            self.f[a][lane] = point.f[a];
        }
        self.inverse[lane] = 1.0 / point.j;
        self.scale[lane] = point.scale;
    }

    /// dJ of a change `df` of F.
    #[inline(always)]
    pub fn volume(&self, df: &[Lane; 4]) -> Lane {
        let f = &self.f;
        each(|i| f[3][i] * df[0][i] - f[2][i] * df[1][i] - f[1][i] * df[2][i] + f[0][i] * df[3][i])
    }

    /// dP at fixed memory, `level` the change of pressure, all times the weight.
    #[inline(always)]
    pub fn stress(&self, df: &[Lane; 4], level: &Lane) -> [Lane; 4] {
        let (d, f) = (&self.stiffness, &self.f);
        let row = |[a, b, c, e]: [usize; 4], i: usize| {
            d[a][i] * df[0][i] + d[b][i] * df[1][i] + d[c][i] * df[2][i] + d[e][i] * df[3][i]
        };
        [
            each(|i| level[i] * f[3][i] + row([0, 1, 2, 3], i)),
            each(|i| -level[i] * f[2][i] + row([1, 4, 5, 6], i)),
            each(|i| -level[i] * f[1][i] + row([2, 5, 7, 8], i)),
            each(|i| level[i] * f[0][i] + row([3, 6, 8, 9], i)),
        ]
    }

    /// C11, C22 and C12.
    #[inline(always)]
    fn stretches(&self) -> [Lane; 3] {
        let f = &self.f;
        [
            each(|i| f[0][i] * f[0][i] + f[2][i] * f[2][i]),
            each(|i| f[1][i] * f[1][i] + f[3][i] * f[3][i]),
            each(|i| f[0][i] * f[1][i] + f[2][i] * f[3][i]),
        ]
    }

    /// dY of a change `df` of F and `volume` of J, with
    /// Y33 = J^(2/3) = J^2 J^(-4/3).
    #[inline(always)]
    pub fn remembered(&self, df: &[Lane; 4], volume: &Lane) -> [Lane; 4] {
        let (f, [c11, c22, c12]) = (&self.f, self.stretches());
        let factor: Lane = each(|i| self.scale[i] * self.scale[i]);
        let third: Lane = each(|i| 2.0 / 3.0 * volume[i] * self.inverse[i]);
        let j: Lane = each(|i| f[0][i] * f[3][i] - f[1][i] * f[2][i]);
        [
            each(|i| {
                let change = f[1][i] * df[1][i] + f[3][i] * df[3][i];
                2.0 * factor[i] * (change - third[i] * c22[i])
            }),
            each(|i| {
                let change = f[0][i] * df[0][i] + f[2][i] * df[2][i];
                2.0 * factor[i] * (change - third[i] * c11[i])
            }),
            each(|i| {
                let first = f[1][i] * df[0][i] + f[0][i] * df[1][i];
                let change = first + f[3][i] * df[2][i] + f[2][i] * df[3][i];
                factor[i] * (2.0 * third[i] * c12[i] - change)
            }),
            each(|i| third[i] * factor[i] * j[i] * j[i]),
        ]
    }

    /// Add dP of a change `h` of H (`stress::memory_slope`), times the weight.
    #[inline(always)]
    pub fn add_memory(&self, p: &mut [Lane; 4], h: &[Lane; 4], weight: f64) {
        let (f, [c11, c22, c12]) = (&self.f, self.stretches());
        let scale: Lane = each(|i| weight * self.scale[i]);
        let trace: Lane = each(|i| {
            let sum = c11[i] * h[0][i] + c22[i] * h[1][i] + 2.0 * c12[i] * h[2][i] + h[3][i];
            1.0 / 3.0 * self.inverse[i] * sum
        });
        for i in 0..LANES {
            p[0][i] += scale[i] * (f[0][i] * h[0][i] + f[1][i] * h[2][i] - trace[i] * f[3][i]);
            p[1][i] += scale[i] * (f[1][i] * h[1][i] + f[0][i] * h[2][i] + trace[i] * f[2][i]);
            p[2][i] += scale[i] * (f[2][i] * h[0][i] + f[3][i] * h[2][i] + trace[i] * f[1][i]);
            p[3][i] += scale[i] * (f[3][i] * h[1][i] + f[2][i] * h[2][i] - trace[i] * f[0][i]);
        }
    }
}

/// A loop, as `array::from_fn` is not always taken apart where it is called.
#[inline(always)]
fn each(value: impl Fn(usize) -> f64) -> Lane {
    let mut out = [0.0; LANES];
    for (i, to) in out.iter_mut().enumerate() {
        *to = value(i);
    }
    out
}

pub fn lane(values: &[f64], at: usize) -> Lane {
    let mut lane = [0.0; LANES];
    lane.copy_from_slice(&values[at..at + LANES]);
    lane
}
