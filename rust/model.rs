//! Rubber and profile in kernel units: lengths in wavelengths, stresses in |G*(w)| at one frequency.
//!
//! Steady sliding and sliding in time share this model; they differ in the unit of time.

use std::f64::consts::TAU;

use crate::contact::edges::EdgeLaw;
use crate::contact::profile::{hertz_contact_width, Heights};
use crate::contact::sampling::Sampling;
use crate::contact::PressedBlock;
use crate::executor::Executor;
use crate::fem::block::{Block, Memory};
use crate::fem::mesh::Mesh;
use crate::material::energy::Energy;
use crate::material::maxwell::Maxwell;
use crate::material::sliding_history::SlidingHistory;
use crate::problem::{Profile, Rubber};

#[derive(Clone)]
pub struct Model {
    /// Unit of stress [Pa].
    pub stress_unit: f64,
    /// Moduli in stress units, times in time units.
    pub maxwell: Maxwell,
    energy: Energy,
    bulk_modulus: f64,
    pub heights: Heights,
    /// At the nodes, unless changed: what was verified of single waves holds for them.
    pub sampling: Sampling,
}

impl Model {
    /// The model with times in units of `time_unit` [s], infinite for the relaxed rubber, and
    /// stresses in |G*| at the angular frequency `omega` [1 / time unit].
    pub fn new(rubber: &Rubber, profile: &Profile, time_unit: f64, omega: f64) -> Self {
        let networks = rubber.moduli.iter().zip(&rubber.relaxation_times);
        let (moduli, times) = networks
            .filter(|_| time_unit.is_finite())
            .map(|(modulus, time)| (modulus, time / time_unit))
            .unzip();
        let mut maxwell = Maxwell { equilibrium: rubber.equilibrium_modulus, moduli, times };
        let stress_unit = maxwell.magnitude(omega);
        maxwell.equilibrium /= stress_unit;
        maxwell.moduli.iter_mut().for_each(|g| *g /= stress_unit);
        Self {
            stress_unit,
            maxwell,
            energy: rubber.energy,
            bulk_modulus: rubber.bulk_modulus / stress_unit,
            heights: profile.heights.over(profile.wavelength),
            sampling: Sampling::Nodes,
        }
    }

    /// The block on its profile, whose work `executor` does.
    pub fn pressed<'a>(
        &'a self,
        mesh: &'a Mesh,
        memory: &'a Memory,
        executor: &'a Executor<'a>,
    ) -> PressedBlock<'a> {
        PressedBlock {
            block: Block {
                mesh,
                energy: self.energy,
                equilibrium: self.maxwell.equilibrium,
                memory,
                bulk_modulus: self.bulk_modulus,
            },
            heights: &self.heights,
            sampling: self.sampling,
            executor,
        }
    }

    /// The memory of the networks on `mesh` in steady sliding, after a load time of `passages` of the wave.
    pub fn sliding_memory(&self, mesh: &Mesh, passages: f64) -> Memory {
        if self.maxwell.moduli.is_empty() {
            return Memory::Relaxed;
        }
        Memory::Sliding(SlidingHistory::new(mesh.columns, &self.maxwell, passages))
    }

    /// The same rubber on other heights.
    pub fn with_heights(&self, heights: Heights) -> Self {
        Self { heights, ..self.clone() }
    }

    /// Contact width in wavelengths under a small `load`, by Hertz.
    pub fn expected_contact(&self, load: f64) -> f64 {
        hertz_contact_width(load, self.heights.crest_curvature(), |omega| {
            self.maxwell.magnitude(omega)
        })
    }

    /// The edge law for the modulus at a wave of four node spacings and `speed` [wavelengths / time unit].
    pub fn edge_law(&self, mesh: &Mesh, speed: f64) -> EdgeLaw {
        let omega = TAU * mesh.layer_nodes() as f64 / 4.0 * speed.abs();
        let (storage, loss) = self.maxwell.complex_modulus(omega);
        EdgeLaw::new(storage, loss, speed >= 0.0)
    }
}
