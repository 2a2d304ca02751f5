//! Strain energies of the permanent network: a new one is one arm in each of the two functions here.
//!
//! S_iso = J^(-2/3) DEV[2 dW/dCbar]. Written for a unit shear modulus, b = 2 dW/dCbar:
//!     neo-Hookean    W = 1/2 (I1 - 3)                                          b = 1
//!     Mooney-Rivlin  W = (1 - s)/2 (I1 - 3) + s/2 (I2 - 3)                     b = (1 - s) 1 + s (I1 1 - Cbar)
//!     Yeoh           W = 1/2 ((I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3)        b = (1 + 2 c2 (I1 - 3) + 3 c3 (I1 - 3)^2) 1
//! Sources: M. Mooney, J. Appl. Phys. 11 (1940) 582; R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948)
//! 379; O. H. Yeoh, Rubber Chem. Technol. 66 (1993) 754.

use crate::network::{cofactor, isochoric, jacobian, Gradient, Symmetric, UNIT};

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Energy {
    NeoHookean,
    /// Share of the second invariant in the small-strain modulus, 0 to 1.
    MooneyRivlin {
        share: f64,
    },
    /// Second and third coefficient over half the shear modulus.
    Yeoh {
        second: f64,
        third: f64,
    },
}

impl Energy {
    /// b = 2 dW/dCbar for a unit shear modulus.
    pub fn network(&self, f: &Gradient) -> Symmetric {
        let c = isochoric(f);
        let first = trace(&c);
        match *self {
            Energy::NeoHookean => UNIT,
            Energy::MooneyRivlin { share } => {
                let mut b = UNIT.map(|unit| (1.0 - share + share * first) * unit);
                for k in 0..4 {
                    b[k] -= share * c[k];
                }
                b
            }
            Energy::Yeoh { second, third } => {
                let strain = first - 3.0;
                let level = 1.0 + 2.0 * second * strain + 3.0 * third * strain * strain;
                UNIT.map(|unit| level * unit)
            }
        }
    }

    /// db/dF, `[component of b][component of F]`; None where b is constant.
    pub fn network_slope(&self, f: &Gradient) -> Option<[Gradient; 4]> {
        if *self == Energy::NeoHookean {
            return None;
        }
        let c_slope = isochoric_slope(f);
        let mut trace_slope = [0.0; 4];
        for k in 0..4 {
            trace_slope[k] = c_slope[0][k] + c_slope[1][k] + c_slope[3][k];
        }
        let mut slope = [[0.0; 4]; 4];
        for a in 0..4 {
            for k in 0..4 {
                slope[a][k] = match *self {
                    Energy::NeoHookean => 0.0,
                    Energy::MooneyRivlin { share } => {
                        share * (UNIT[a] * trace_slope[k] - c_slope[a][k])
                    }
                    Energy::Yeoh { second, third } => {
                        let strain = trace(&isochoric(f)) - 3.0;
                        UNIT[a] * (2.0 * second + 6.0 * third * strain) * trace_slope[k]
                    }
                };
            }
        }
        Some(slope)
    }
}

fn trace(c: &Symmetric) -> f64 {
    c[0] + c[1] + c[3]
}

/// d(Cbar)/dF.
fn isochoric_slope(f: &Gradient) -> [Gradient; 4] {
    let j = jacobian(f);
    let factor = j.powf(-2.0 / 3.0);
    let g = cofactor(f).map(|value| value / j);
    let c = isochoric(f);
    let direct = [
        [2.0 * f[0], 0.0, 2.0 * f[2], 0.0],
        [0.0, 2.0 * f[1], 0.0, 2.0 * f[3]],
        [f[1], f[0], f[3], f[2]],
        [0.0; 4],
    ];
    let mut slope = [[0.0; 4]; 4];
    for a in 0..4 {
        for k in 0..4 {
            slope[a][k] = factor * direct[a][k] - 2.0 / 3.0 * g[k] * c[a];
        }
    }
    slope
}
