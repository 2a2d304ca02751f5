//! The rubber block: its unknowns, its material, and the positions of unknowns in an element row.

use super::element::MOST_NODES;
use super::mesh::Mesh;
use crate::material::carried_history::Points;
use crate::material::energy::Energy;
use crate::material::kinematics::{Deformation, Symmetric};
use crate::material::sliding_history::SlidingHistory;

/// Displacements (all layers, lid included) and pressure modes `[row][column][mode]`.
#[derive(Debug, Clone)]
pub struct Field {
    pub u: Vec<f64>,
    pub pressure: Vec<f64>,
}

impl Field {
    pub fn at_rest(mesh: &Mesh) -> Self {
        Self {
            u: vec![0.0; mesh.layers() * mesh.layer_size()],
            pressure: vec![0.0; mesh.rows * mesh.columns * mesh.modes()],
        }
    }
}

/// The contribution of the temporary networks to H.
#[derive(Debug, Clone)]
pub enum Memory {
    /// None: the relaxed rubber.
    Relaxed,
    /// Steady sliding: every point of a line depends on all others.
    Sliding(SlidingHistory),
    /// A contribution that is known before the step.
    Given(Points),
}

/// The rubber in a mesh: everything that assembly needs except the field.
pub struct Block<'a> {
    pub mesh: &'a Mesh,
    pub energy: Energy,
    /// Shear modulus of the permanent network.
    pub equilibrium: f64,
    pub memory: &'a Memory,
    pub bulk_modulus: f64,
}

/// Kinematics and memory at the Gauss points of one element row: `[line][column * points + point]`.
#[derive(Debug, Clone)]
pub struct RowState {
    pub deformation: Vec<Vec<Deformation>>,
    pub h: Vec<Vec<Symmetric>>,
}

impl Block<'_> {
    pub(super) fn points(&self) -> usize {
        self.mesh.order + 1
    }

    /// Gauss points of element `column`: point of the element, its line, its place along the line.
    pub(super) fn gauss_points(
        &self,
        column: usize,
    ) -> impl Iterator<Item = (usize, usize, usize)> {
        let n = self.points();
        (0..n).flat_map(move |line| (0..n).map(move |i| (line * n + i, line, column * n + i)))
    }

    /// Positions of the unknowns of element `column` in the vector of its row, node by node. Entries
    /// beyond the nodes of the element are zero.
    pub(super) fn local_unknowns(&self, column: usize) -> [[usize; 2]; MOST_NODES] {
        let order = self.mesh.order;
        let mut out = [[0; 2]; MOST_NODES];
        for layer in 0..=order {
            for sub in 0..=order {
                let at = layer * self.mesh.layer_size();
                let node = order * column + sub;
                out[layer * (order + 1) + sub] = [0, 1].map(|to| at + self.mesh.position(node, to));
            }
        }
        out
    }

    pub(super) fn row_offset(&self, row: usize) -> usize {
        row * self.mesh.order * self.mesh.layer_size()
    }

    pub(super) fn element_pressure<'f>(
        &self,
        field: &'f Field,
        row: usize,
        column: usize,
    ) -> &'f [f64] {
        let modes = self.mesh.modes();
        let at = (row * self.mesh.columns + column) * modes;
        &field.pressure[at..at + modes]
    }
}
