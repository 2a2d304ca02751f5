//! Meshes, energies and fields for the tests inside the crate.

use crate::cancel::Cancel;
use crate::case::new_energy;
use crate::executor::Executor;
use crate::fem::block::{Block, Field, RowState};
use crate::fem::mesh::{Mesh, MeshSize};
use crate::material::energy::Energy;

/// The calling thread alone, never cancelled.
pub fn serial() -> Executor<'static> {
    Executor::serial(Cancel::never())
}

pub fn mesh(columns: usize, rows: usize, depth: f64, order: usize) -> Mesh {
    Mesh::new(&MeshSize::new(columns, rows, depth, order).unwrap())
}

pub fn energy(kind: &str, parameters: &[(&str, f64)]) -> Energy {
    new_energy(kind, parameters).unwrap()
}

/// Let the pressures of one row be what its volumes ask for.
pub fn balance_volumes(block: &Block<'_>, row: usize, state: &RowState, field: &mut Field) {
    let volumes = block.row_volumes(row, field, state);
    let masses = &block.mesh.elements[row].mode_mass;
    let (columns, at) = (block.mesh.columns, row * volumes.len());
    for (i, volume) in volumes.into_iter().enumerate() {
        let (mode, column) = (i / columns, i % columns);
        let pressure = &mut field.pressure[at + column * masses.len() + mode];
        *pressure += block.bulk_modulus / masses[mode] * volume;
    }
}
