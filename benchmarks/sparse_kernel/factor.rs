//! faer's sparse factors of the assembled tangent: L D L^T of its lower triangle, and LU with partial
//! pivoting of all of it. What depends on the pattern alone is done once.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    self, CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
};
use faer::sparse::linalg::lu::{self, LuRef, LuSymbolicParams, NumericLu, SymbolicLu};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use gripscale_kernel::contact::State;
use gripscale_kernel::fem::block::Block;
use gripscale_kernel::fem::block::RowState;
use gripscale_kernel::fem::element_tangent::ElementTangent;
use gripscale_kernel::fem::pattern::Pattern;

/// A matrix in compressed columns.
pub struct Compressed {
    pub size: usize,
    columns: Vec<usize>,
    rows: Vec<usize>,
    pub values: Vec<f64>,
}

impl Compressed {
    /// The lower triangle of the tangent of `state`, by nested dissection; no node is held.
    pub fn lower(block: &Block<'_>, pattern: &Pattern, state: &State, rows: &[RowState]) -> Self {
        let mesh = block.mesh;
        let mut values = vec![0.0; pattern.rows.len()];
        let mut element = ElementTangent::new(block);
        for at in 0..mesh.rows * mesh.columns {
            let (row, column) = (at / mesh.columns, at % mesh.columns);
            element.assemble_condensed(block, &state.field, &rows[row], (row, column));
            pattern.add(at, &element.stiffness, &mut values);
        }
        Self {
            size: pattern.unknowns.len(),
            columns: pattern.column_starts.clone(),
            rows: pattern.rows.clone(),
            values,
        }
    }

    /// All of the symmetric matrix whose lower triangle this is.
    pub fn full(&self) -> Self {
        let mut of_column: Vec<Vec<(usize, f64)>> = vec![Vec::new(); self.size];
        for j in 0..self.size {
            for k in self.columns[j]..self.columns[j + 1] {
                let (i, value) = (self.rows[k], self.values[k]);
                of_column[j].push((i, value));
                if i != j {
                    of_column[i].push((j, value));
                }
            }
        }
        let (mut columns, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in &mut of_column {
            column.sort_unstable_by_key(|&(row, _)| row);
            rows.extend(column.iter().map(|&(row, _)| row));
            values.extend(column.iter().map(|&(_, value)| value));
            columns.push(rows.len());
        }
        Self {
            size: self.size,
            columns,
            rows,
            values,
        }
    }

    fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.size, self.size, &self.columns, None, &self.rows)
    }

    fn matrix(&self) -> SparseColMatRef<'_, usize, f64> {
        SparseColMatRef::new(self.symbolic(), &self.values)
    }
}

/// Supernodal L D L^T without pivots: the tangent is symmetric; without the profile that holds the
/// pressed block it is not positive definite, so that Cholesky finds no factor.
pub struct Ldl {
    symbolic: SymbolicCholesky<usize>,
}

impl Ldl {
    /// In the order of the matrix, or in that of faer's approximate minimum degree.
    pub fn new(matrix: &Compressed, minimum_degree: bool) -> Self {
        let own: Vec<usize> = (0..matrix.size).collect();
        let order = match minimum_degree {
            true => SymmetricOrdering::Amd,
            false => SymmetricOrdering::Custom(PermRef::new_checked(&own, &own, matrix.size)),
        };
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let pattern = matrix.symbolic();
        let symbolic = cholesky::factorize_symbolic_cholesky(pattern, Side::Lower, order, params);
        Self {
            symbolic: symbolic.expect("memory for the symbolic factor"),
        }
    }

    /// Entries of L, and multiplications and additions to find them.
    pub fn cost(&self) -> (f64, f64) {
        let SymbolicCholeskyRaw::Supernodal(nodes) = self.symbolic.raw() else {
            return (f64::NAN, f64::NAN);
        };
        let (begin, end) = (nodes.supernode_begin(), nodes.supernode_end());
        let rows = nodes.col_ptr_for_row_idx();
        let columns = (0..nodes.n_supernodes()).flat_map(|k| {
            let below = rows[k + 1] - rows[k];
            (1..=end[k] - begin[k]).map(move |left| (left + below) as f64)
        });
        columns.fold((0.0, 0.0), |(fill, flops), n| (fill + n, flops + n * n))
    }

    /// None where a pivot vanishes.
    pub fn factor(&self, matrix: &Compressed) -> Option<Vec<f64>> {
        let mut factor = vec![0.0; self.symbolic.len_val()];
        let params = Default::default();
        let scratch = self
            .symbolic
            .factorize_numeric_ldlt_scratch::<f64>(Par::Seq, params);
        self.symbolic
            .factorize_numeric_ldlt(
                &mut factor,
                matrix.matrix(),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                params,
            )
            .ok()?;
        Some(factor)
    }

    pub fn solve(&self, factor: &[f64], right: MatMut<'_, f64>) {
        let scratch = self
            .symbolic
            .solve_in_place_scratch::<f64>(right.ncols(), Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        LdltRef::new(&self.symbolic, factor).solve_in_place_with_conj(
            Conj::No,
            right,
            Par::Seq,
            stack,
        );
    }
}

/// Supernodal LU with COLAMD's order of the columns.
pub struct Lu {
    symbolic: SymbolicLu<usize>,
}

impl Lu {
    pub fn new(matrix: &Compressed) -> Self {
        let params = LuSymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic = lu::factorize_symbolic_lu(matrix.symbolic(), params);
        Self {
            symbolic: symbolic.expect("memory for the symbolic factor"),
        }
    }

    pub fn factor(&self, matrix: &Compressed) -> Option<NumericLu<usize, f64>> {
        let mut factor = NumericLu::new();
        let params = Default::default();
        let scratch = self
            .symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, params);
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        self.symbolic
            .factorize_numeric_lu(&mut factor, matrix.matrix(), Par::Seq, stack, params)
            .ok()?;
        Some(factor)
    }

    pub fn solve(&self, factor: &NumericLu<usize, f64>, right: MatMut<'_, f64>) {
        let scratch = self
            .symbolic
            .solve_in_place_scratch::<f64>(right.ncols(), Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        LuRef::new_unchecked(&self.symbolic, factor).solve_in_place_with_conj(
            Conj::No,
            right,
            Par::Seq,
            stack,
        );
    }
}
