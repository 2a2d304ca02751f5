//! faer's sparse factors: L D L^T of the lower triangle, and LU with partial pivoting of all of it.
//! What depends on the pattern alone is done once.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    self, CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
};
use faer::sparse::linalg::lu::{self, LuRef, LuSymbolicParams, NumericLu, SymbolicLu};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::SparseColMatRef;
use faer::{Conj, MatMut, Par, Side};

use crate::pattern::Pattern;

/// Supernodal L D L^T without pivots: the tangent is symmetric; without the profile that holds the
/// pressed block it is not positive definite, so that Cholesky finds no factor.
pub struct Ldl {
    symbolic: SymbolicCholesky<usize>,
}

impl Ldl {
    /// In the order of the pattern, or in that of faer's approximate minimum degree.
    pub fn new(pattern: &Pattern, minimum_degree: bool) -> Self {
        let own: Vec<usize> = (0..pattern.size).collect();
        let order = match minimum_degree {
            true => SymmetricOrdering::Amd,
            false => SymmetricOrdering::Custom(PermRef::new_checked(&own, &own, pattern.size)),
        };
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let pattern = pattern.symbolic();
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
    pub fn factor(&self, pattern: &Pattern, values: &[f64]) -> Option<Vec<f64>> {
        let matrix = SparseColMatRef::new(pattern.symbolic(), values);
        let mut factor = vec![0.0; self.symbolic.len_val()];
        let params = Default::default();
        let scratch = self
            .symbolic
            .factorize_numeric_ldlt_scratch::<f64>(Par::Seq, params);
        self.symbolic
            .factorize_numeric_ldlt(
                &mut factor,
                matrix,
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
    pub fn new(pattern: &Pattern) -> Self {
        let params = LuSymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic = lu::factorize_symbolic_lu(pattern.symbolic(), params);
        Self {
            symbolic: symbolic.expect("memory for the symbolic factor"),
        }
    }

    pub fn factor(&self, pattern: &Pattern, values: &[f64]) -> Option<NumericLu<usize, f64>> {
        let matrix = SparseColMatRef::new(pattern.symbolic(), values);
        let mut factor = NumericLu::new();
        let params = Default::default();
        let scratch = self
            .symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, params);
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        self.symbolic
            .factorize_numeric_lu(&mut factor, matrix, Par::Seq, stack, params)
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
