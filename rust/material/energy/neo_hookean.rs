//! Neo-Hooke: W = 1/2 (I1 - 3), a Gaussian network (Treloar, Trans. Faraday Soc. 39 (1943) 241).

use super::{Invariants, Parameters, StrainEnergy};
use crate::error::KernelError;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHookean;

impl StrainEnergy for NeoHookean {
    const NAME: &'static str = "neo_hookean";
    const PARAMETERS: &'static [&'static str] = &[];
    const CONSTANT: bool = true;

    fn new(_: &Parameters) -> Result<Self, KernelError> {
        Ok(Self)
    }

    fn density(&self, [i1, _]: Invariants) -> f64 {
        0.5 * (i1 - 3.0)
    }

    fn slopes(&self, _: Invariants) -> [f64; 2] {
        [0.5, 0.0]
    }

    fn curvatures(&self, _: Invariants) -> [f64; 3] {
        [0.0; 3]
    }
}
