//! The periodic mesh: one wavelength wide, graded from the contact surface towards the lid.
//!
//! Lengths are in wavelengths. Layer 0 is the contact surface (z = 0), the last layer the lid.

use super::element::{lagrange, Element};
use crate::error::{positive, whole, KernelError};

const LEAST_COLUMNS: usize = 4;
const MOST_COLUMNS: usize = 4096;
const LEAST_ROWS: usize = 2;
const MOST_ROWS: usize = 256;

/// Size of a mesh: elements along and across the block, depth in wavelengths, order of the elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshSize {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) depth: f64,
    pub(crate) order: usize,
}

impl MeshSize {
    pub fn new(
        columns: usize,
        rows: usize,
        depth: f64,
        element_order: usize,
    ) -> Result<Self, KernelError> {
        Ok(Self {
            columns: whole("columns", columns as f64, LEAST_COLUMNS, MOST_COLUMNS)?,
            rows: whole("rows", rows as f64, LEAST_ROWS, MOST_ROWS)?,
            depth: positive("depth", depth)?,
            order: whole("element_order", element_order as f64, 1, 2)?,
        })
    }

    /// The size with other columns; the rows change with the power `row_exponent` of the columns.
    pub(crate) fn with_columns(&self, columns: usize, row_exponent: f64) -> Self {
        if columns == self.columns {
            return *self;
        }
        let share = (columns as f64 / self.columns as f64).powf(row_exponent);
        let rows = (share * self.rows as f64).round() as usize;
        Self { columns, rows: rows.clamp(LEAST_ROWS, MOST_ROWS), ..*self }
    }
}

#[derive(Debug, Clone)]
pub struct Mesh {
    pub order: usize,
    pub columns: usize,
    pub rows: usize,
    /// Height of every element row, contact surface first.
    pub row_height: Vec<f64>,
    /// One element per row (all columns of a row are equal).
    pub elements: Vec<Element>,
}

impl Mesh {
    pub fn new(size: &MeshSize) -> Self {
        let &MeshSize { columns, rows, depth, order } = size;
        let width = 1.0 / columns as f64;
        let row_height = graded(width.min(depth / rows as f64), rows, depth);
        let elements =
            row_height.iter().map(|&height| Element::new(order, width, height)).collect();
        Self { order, columns, rows, row_height, elements }
    }

    /// Whether the unknowns of the other mesh have the same positions.
    pub fn same(&self, other: &Self) -> bool {
        self.order == other.order
            && self.columns == other.columns
            && self.row_height == other.row_height
    }

    /// Nodes along x in one layer (the last column's right edge is the first column's left edge).
    pub fn layer_nodes(&self) -> usize {
        self.order * self.columns
    }

    /// Displacement unknowns of one layer.
    pub fn layer_size(&self) -> usize {
        2 * self.layer_nodes()
    }

    /// Gauss points of all elements.
    pub fn points(&self) -> usize {
        self.rows * self.columns * (self.order + 1).pow(2)
    }

    /// Node layers, the lid included.
    pub fn layers(&self) -> usize {
        self.order * self.rows + 1
    }

    /// Position of the x (0) or z (1) displacement of a node within its layer.
    ///
    /// Nodes with the same place in their elements stand together, so that loops over the elements of a
    /// row run over contiguous vectors.
    pub fn position(&self, node: usize, direction: usize) -> usize {
        let (column, sub) = (node / self.order % self.columns, node % self.order);
        (direction * self.order + sub) * self.columns + column
    }

    /// Mean horizontal displacement of the contact surface.
    pub fn mean_shift(&self, u: &[f64]) -> f64 {
        let nodes = self.layer_nodes();
        (0..nodes).map(|a| u[self.position(a, 0)]).sum::<f64>() / nodes as f64
    }

    pub fn node_spacing(&self) -> f64 {
        1.0 / self.layer_nodes() as f64
    }

    /// Pressure modes per element.
    pub fn modes(&self) -> usize {
        self.elements[0].mode_mass.len()
    }

    /// Heights z of the middles of the element rows.
    pub fn row_middles(&self) -> Vec<f64> {
        let mut base = 0.0;
        let middle = |height: &f64| {
            base += height;
            base - 0.5 * height
        };
        self.row_height.iter().map(middle).collect()
    }

    /// Node layers' heights z.
    pub fn layer_heights(&self) -> Vec<f64> {
        let mut heights = vec![0.0];
        let mut base = 0.0;
        for &height in &self.row_height {
            for sub in 1..=self.order {
                heights.push(base + height * sub as f64 / self.order as f64);
            }
            base += height;
        }
        heights
    }

    /// Interpolate nodal displacements `u` of this mesh at (x, z), both in wavelengths.
    pub fn interpolate(&self, u: &[f64], x: f64, z: f64) -> [f64; 2] {
        let mut row = 0;
        let mut base = 0.0;
        while row + 1 < self.rows && z > base + self.row_height[row] {
            base += self.row_height[row];
            row += 1;
        }
        let scaled = x.rem_euclid(1.0) * self.columns as f64;
        let column = (scaled.floor() as usize).min(self.columns - 1);
        let nx = lagrange(self.order, 2.0 * (scaled - column as f64) - 1.0);
        let nz =
            lagrange(self.order, (2.0 * (z - base) / self.row_height[row] - 1.0).clamp(-1.0, 1.0));
        let mut value = [0.0; 2];
        for (layer, &shape_z) in nz.iter().enumerate() {
            for (sub, &shape_x) in nx.iter().enumerate() {
                let node = self.order * column + sub;
                let at = (self.order * row + layer) * self.layer_size();
                value[0] += shape_x * shape_z * u[at + self.position(node, 0)];
                value[1] += shape_x * shape_z * u[at + self.position(node, 1)];
            }
        }
        value
    }
}

/// Row heights growing geometrically from `first` so that they fill the depth.
///
/// Near the contact edges the length scale of the field is the distance from the surface, so row heights
/// should be proportional to it. Coarser rows where the first harmonic has decayed would save little.
fn graded(first: f64, rows: usize, depth: f64) -> Vec<f64> {
    let sum = |ratio: f64| (0..rows).map(|i| first * ratio.powi(i as i32)).sum::<f64>();
    let (mut low, mut high) = (1.0, 1.0 + depth / first);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if sum(middle) < depth {
            low = middle;
        } else {
            high = middle;
        }
    }
    let heights: Vec<f64> = (0..rows).map(|i| first * low.powi(i as i32)).collect();
    let total: f64 = heights.iter().sum();
    heights.iter().map(|h| h * depth / total).collect()
}
