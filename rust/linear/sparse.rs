//! Sparse symmetric matrices: L D L^T without pivots, symbolic once and numeric often.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    self, CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymmetricOrdering,
};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};

/// The symbolic factorisation, which follows from the pattern alone.
pub struct Ldl {
    lower: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
}

/// Numbers of a factor.
pub struct LdlFactor(Vec<f64>);

impl Ldl {
    /// Analyse the pattern of a lower triangle in compressed columns, which has every diagonal entry and
    /// its unknowns in the order of elimination; None if memory does not suffice.
    pub fn new(column_starts: Vec<usize>, rows: Vec<usize>) -> Option<Self> {
        let size = column_starts.len() - 1;
        let lower = SymbolicSparseColMat::new_checked(size, size, column_starts, None, rows);
        let identity: Vec<usize> = (0..size).collect();
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let order = SymmetricOrdering::Custom(PermRef::new_checked(&identity, &identity, size));
        let symbolic =
            cholesky::factorize_symbolic_cholesky(lower.as_ref(), Side::Lower, order, params);
        Some(Self { symbolic: symbolic.ok()?, lower })
    }

    /// Factor the matrix with these `values`; None if a pivot vanishes.
    pub fn factor(&self, values: &[f64]) -> Option<LdlFactor> {
        let matrix = SparseColMatRef::new(self.lower.as_ref(), values);
        let mut factor = vec![0.0; self.symbolic.len_val()];
        let symbolic = &self.symbolic;
        let params = Default::default();
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, params);
        let result = symbolic.factorize_numeric_ldlt(
            &mut factor,
            matrix,
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            params,
        );
        result.is_ok().then_some(LdlFactor(factor))
    }

    /// Replace `right` by the solution.
    pub fn solve(&self, factor: &LdlFactor, right: &mut [f64]) {
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        let size = right.len();
        LdltRef::new(&self.symbolic, &factor.0).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right, size, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }
}
