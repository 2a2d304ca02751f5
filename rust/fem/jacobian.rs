//! The exact Jacobian of the mixed system, which is never formed:
//!     r_u = int (dP/dF : grad du + dP/dH : dH + dp cof F) : grad N dV,
//!     r_p = int m cof F : grad du dV - M dp / K,     dH(x) = sum weight(x - x') dY/dF : grad du(x').
//!
//! This file builds it at a state: deformation and stiffness at every Gauss point, and their averages
//! along every row. `jacobian_product` applies it. Displacement and pressure both stay unknowns: with the
//! pressures condensed, the volumetric stiffness would vary from point to point, and no laterally uniform
//! state would be near it.

use super::block::{Block, Field, Memory, RowState};
use super::mesh::Mesh;
use super::point_slopes::{AveragedSlopes, PointSlopes, SlopeSums, LANES};
use crate::executor::Executor;
use crate::material::kinematics::{Deformation, Gradient};
use crate::material::stress::{memory_slope, tangent};
use crate::spectral::Complex64;
use crate::status::Status;

pub struct Jacobian<'a> {
    pub mesh: &'a Mesh,
    pub bulk_modulus: f64,
    /// Harmonics of the memory's weights along a line; None without memory.
    pub memory: Option<Vec<Complex64>>,
    /// Groups of `LANES` columns in a row.
    pub(super) chunks: usize,
    /// `[row][chunk * points + point]`.
    pub(super) slopes: Vec<Vec<PointSlopes>>,
    /// `[row][point]`.
    averages: Vec<Vec<AveragedSlopes>>,
}

impl<'a> Jacobian<'a> {
    /// The Jacobian at `field`, whose rows are in the states `rows`.
    pub fn new(
        block: &Block<'a>,
        field: &Field,
        rows: &[RowState],
        executor: &Executor<'_>,
    ) -> Result<Self, Status> {
        let mesh = block.mesh;
        let memory = match block.memory {
            Memory::Sliding(history) => Some(history.spectrum.clone()),
            Memory::Relaxed | Memory::Given(_) => None,
        };
        let mut jacobian = Self {
            mesh,
            bulk_modulus: block.bulk_modulus,
            memory,
            chunks: mesh.columns.div_ceil(LANES),
            slopes: Vec::new(),
            averages: Vec::new(),
        };
        let of_row = |row: usize| jacobian.row_slopes(block, field, row, &rows[row]);
        let of_rows = executor.map(jacobian.size(), mesh.rows, of_row)?;
        (jacobian.slopes, jacobian.averages) = of_rows.into_iter().unzip();
        Ok(jacobian)
    }

    /// How many numbers are kept.
    pub fn size(&self) -> usize {
        16 * self.mesh.points()
    }

    /// Gauss points of an element.
    pub(super) fn points(&self) -> usize {
        (self.mesh.order + 1).pow(2)
    }

    /// Displacement unknowns, without the fixed lid.
    pub fn displacements(&self) -> usize {
        (self.mesh.layers() - 1) * self.mesh.layer_size()
    }

    /// Averages along a row at every Gauss point of its elements.
    pub fn averages(&self, row: usize) -> &[AveragedSlopes] {
        &self.averages[row]
    }

    fn row_slopes(
        &self,
        block: &Block<'_>,
        field: &Field,
        row: usize,
        state: &RowState,
    ) -> (Vec<PointSlopes>, Vec<AveragedSlopes>) {
        let element = &self.mesh.elements[row];
        let mut slopes = vec![PointSlopes::default(); self.chunks * self.points()];
        let mut sums = vec![SlopeSums::default(); self.points()];
        for column in 0..self.mesh.columns {
            let (chunk, lane) = (column / LANES, column % LANES);
            let pressure = block.element_pressure(field, row, column);
            for (at, line, q) in block.gauss_points(column) {
                let (point, h) = (&state.deformation[line][q], &state.h[line][q]);
                let modes = element.mode[at].iter().zip(pressure);
                let level = modes.map(|(mode, p)| mode * p).sum();
                let mut stiffness = tangent(point, h, level);
                add_network_slope(block, point, &mut stiffness);
                slopes[chunk * self.points() + at].put(lane, element.weight[at], point, &stiffness);
                sums[at].add(point, &stiffness);
            }
        }
        let (columns, remembers) = (self.mesh.columns, self.memory.is_some());
        if remembers {
            pulp::Arch::new().dispatch(|| {
                for chunk in slopes.chunks_exact(self.points()) {
                    for (at, slopes) in chunk.iter().enumerate() {
                        sums[at].add_memory(slopes, element.weight[at]);
                    }
                }
            });
        }
        let averages = sums.iter().zip(&element.weight);
        let averages = averages.map(|(sums, weight)| sums.average(columns, *weight, remembers));
        (slopes, averages.collect())
    }
}

/// Add the stiffness of the permanent network to dP/dF, if its b changes with the strain.
pub(super) fn add_network_slope(block: &Block<'_>, point: &Deformation, d: &mut [Gradient; 4]) {
    let Some(slope) = block.energy.network_slope(point) else {
        return;
    };
    let by_h = memory_slope(point);
    for a in 0..4 {
        for k in 0..4 {
            let sum: f64 = (0..4).map(|c| by_h[a][c] * slope[c][k]).sum();
            d[a][k] += block.equilibrium * sum;
        }
    }
}
