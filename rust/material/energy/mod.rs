//! Strain energies of the permanent network. To add one, add a file here and its line in `energies!`.
//!
//! The isochoric stress follows from W(I1, I2) of the invariants of Cbar, for a unit shear modulus:
//!     S_iso = J^(-2/3) DEV[G b],   b = 2 dW/dCbar = 2 W_1 1 + 2 W_2 (I1 1 - Cbar)
//! with W_i = dW/dI_i (Holzapfel, "Nonlinear Solid Mechanics" (2000), section 6.4).

mod isihara;
mod kraus;
mod mooney_rivlin;
mod neo_hookean;
mod yeoh;

use std::collections::BTreeMap;
use std::fmt;

use super::kinematics::{
    contract, isochoric, isochoric_slope, Deformation, Gradient, Symmetric, UNIT,
};
use crate::error::{finite, unknown, KernelError};

/// Parameters of a strain energy by name.
pub type Parameters = BTreeMap<String, f64>;

/// First and second invariant of Cbar.
pub type Invariants = [f64; 2];

/// W(I1, I2) for a unit shear modulus at small strain, W_1 + W_2 = 1/2 at (3, 3).
pub trait StrainEnergy: Sized {
    const NAME: &'static str;
    const PARAMETERS: &'static [&'static str];
    /// Whether W is a multiple of I1 - 3, so that b is constant and need not be computed.
    const CONSTANT: bool = false;

    /// Read the parameters named in `PARAMETERS` and refuse values out of range.
    fn new(parameters: &Parameters) -> Result<Self, KernelError>;

    /// W.
    fn density(&self, invariants: Invariants) -> f64;

    /// [W_1, W_2].
    fn slopes(&self, invariants: Invariants) -> [f64; 2];

    /// [W_11, W_12, W_22].
    fn curvatures(&self, invariants: Invariants) -> [f64; 3];
}

macro_rules! energies {
    ($($file:ident::$kind:ident),+ $(,)?) => {
        $(pub use $file::$kind;)+

        /// One of the strain energies.
        #[derive(Clone, Copy, PartialEq)]
        pub enum Energy {
            $($kind($kind),)+
        }

        impl fmt::Debug for Energy {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self {
                    $(Self::$kind(energy) => energy.fmt(f),)+
                }
            }
        }

        impl Energy {
            /// Name and parameters of every strain energy.
            pub const KINDS: &'static [(&'static str, &'static [&'static str])] =
                &[$(($kind::NAME, $kind::PARAMETERS)),+];

            /// The strain energy called `kind`.
            pub fn new(kind: &str, parameters: &Parameters) -> Result<Self, KernelError> {
                $(if kind == $kind::NAME {
                    refuse_unknown::<$kind>(parameters)?;
                    return Ok(Self::$kind($kind::new(parameters)?));
                })+
                Err(unknown("strain_energy", kind, &[$($kind::NAME),+]))
            }

            /// W at F.
            pub fn density(&self, f: &Gradient) -> f64 {
                let at = invariants(&isochoric(f));
                match self {
                    $(Self::$kind(energy) => energy.density(at),)+
                }
            }

            /// b = 2 dW/dCbar at F.
            pub(crate) fn network(&self, f: impl Into<Deformation>) -> Symmetric {
                match self {
                    $(Self::$kind(energy) => network(energy, &f.into()),)+
                }
            }

            /// db/dF, `[component of b][component of F]`; None where b is constant.
            pub(crate) fn network_slope(&self, f: impl Into<Deformation>) -> Option<[Gradient; 4]> {
                match self {
                    $(Self::$kind(energy) => network_slope(energy, &f.into()),)+
                }
            }
        }
    };
}

energies! {
    neo_hookean::NeoHookean,
    mooney_rivlin::MooneyRivlin,
    yeoh::Yeoh,
    isihara::Isihara,
    kraus::Kraus,
}

fn invariants(c: &Symmetric) -> Invariants {
    let first = c[0] + c[1] + c[3];
    [first, 0.5 * (first * first - contract(c, c))]
}

fn network<E: StrainEnergy>(energy: &E, f: &Deformation) -> Symmetric {
    if E::CONSTANT {
        let [w1, _] = energy.slopes([3.0, 3.0]);
        return UNIT.map(|unit| 2.0 * w1 * unit);
    }
    let c = isochoric(f);
    let at = invariants(&c);
    let [w1, w2] = energy.slopes(at);
    let mut b = UNIT.map(|unit| (2.0 * w1 + 2.0 * w2 * at[0]) * unit);
    for k in 0..4 {
        b[k] -= 2.0 * w2 * c[k];
    }
    b
}

/// db/dF with dI1 = 1 : dCbar and dI2 = I1 dI1 - Cbar : dCbar.
fn network_slope<E: StrainEnergy>(energy: &E, f: &Deformation) -> Option<[Gradient; 4]> {
    if E::CONSTANT {
        return None;
    }
    let (c, c_slope) = (isochoric(f), isochoric_slope(f));
    let at = invariants(&c);
    let ([_, w2], [w11, w12, w22]) = (energy.slopes(at), energy.curvatures(at));
    let mut slope = [[0.0; 4]; 4];
    for k in 0..4 {
        let dc = [0, 1, 2, 3].map(|a| c_slope[a][k]);
        let first = dc[0] + dc[1] + dc[3];
        let second = at[0] * first - contract(&c, &dc);
        let (dw1, dw2) = (w11 * first + w12 * second, w12 * first + w22 * second);
        for a in 0..4 {
            slope[a][k] = 2.0 * dw1 * UNIT[a]
                + 2.0 * dw2 * (at[0] * UNIT[a] - c[a])
                + 2.0 * w2 * (UNIT[a] * first - dc[a]);
        }
    }
    Some(slope)
}

/// The finite value of one parameter.
fn parameter<E: StrainEnergy>(
    parameters: &Parameters,
    name: &'static str,
) -> Result<f64, KernelError> {
    let owner = E::NAME;
    let value = parameters.get(name);
    let value = value.ok_or(KernelError::MissingParameter { owner, name })?;
    finite(name, *value)
}

fn refuse_unknown<E: StrainEnergy>(parameters: &Parameters) -> Result<(), KernelError> {
    let other = |name: &&String| !E::PARAMETERS.contains(&name.as_str());
    match parameters.keys().find(other) {
        None => Ok(()),
        Some(name) => {
            let owner = format!("a parameter of {}", E::NAME);
            Err(unknown(&owner, name, E::PARAMETERS))
        }
    }
}
