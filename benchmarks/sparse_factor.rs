//! Sparse factors of the assembled tangent against the iteration that the solver uses.

#[path = "../rust/tests/local_tangent.rs"]
mod local_tangent;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{self, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering};
use faer::sparse::linalg::{lu, qr, SupernodalThreshold, SymbolicSupernodalParams};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut, Par, Side};

use gripscale_kernel::contact::complementarity;
use gripscale_kernel::contact::profile::Heights;
use gripscale_kernel::contact::touching::{Compliance, Linearised};
use gripscale_kernel::contact::{PressedBlock, State};
use gripscale_kernel::fem::block::{Block, Memory, RowState};
use gripscale_kernel::fem::jacobian::Jacobian;
use gripscale_kernel::fem::mesh::Mesh;
use gripscale_kernel::linear::{gmres, Matrix};
use gripscale_kernel::material::energy::Energy;
use gripscale_kernel::material::sliding_history::SlidingHistory;
use gripscale_kernel::model::Model;
use gripscale_kernel::problem::{Load, MeshSize, Problem, Profile, Rubber};
use gripscale_kernel::settings::Settings;
use gripscale_kernel::solve::krylov::{self, Accuracy};
use gripscale_kernel::solve::newton;
use gripscale_kernel::solve::transfer::transfer;
use gripscale_kernel::status::Status;
use gripscale_kernel::steady;
use gripscale_kernel::watch::Watch;
use local_tangent::{places, ElementTangent};

struct Counting;
static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(now, Relaxed);
        System.alloc(layout)
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        System.dealloc(at, layout);
    }
}
#[global_allocator]
static ALLOCATOR: Counting = Counting;

extern "C" {
    fn clock() -> std::ffi::c_long;
}
fn cpu() -> f64 {
    unsafe { clock() as f64 * 1e-6 }
}

/// Best processor time of repetitions [ms], megabytes at the peak above the start, and the last result.
fn timed<T>(mut work: impl FnMut() -> T) -> (f64, f64, T) {
    let mut best = f64::INFINITY;
    let begin = cpu();
    let before = NOW.load(Relaxed);
    PEAK.store(before, Relaxed);
    let mut out;
    let mut count = 0;
    loop {
        let start = cpu();
        out = work();
        best = best.min(cpu() - start);
        count += 1;
        if (cpu() - begin > 0.4 && count >= 2) || cpu() - begin > 5.0 {
            break;
        }
        drop(out);
    }
    (1e3 * best, (PEAK.load(Relaxed) - before) as f64 * 1e-6, out)
}

const NONE: usize = usize::MAX;

/// Number of every displacement of a field in the elimination; the lid has none.
struct Numbering {
    of: Vec<usize>,
    count: usize,
}

fn natural(mesh: &Mesh) -> Numbering {
    let layers = mesh.layers() - 1;
    let nodes: Vec<(usize, usize)> = (0..mesh.layer_nodes())
        .flat_map(|x| (0..layers).map(move |y| (x, y)))
        .collect();
    numbered(mesh, &nodes)
}

fn numbered(mesh: &Mesh, nodes: &[(usize, usize)]) -> Numbering {
    let mut of = vec![NONE; mesh.layers() * mesh.layer_size()];
    for (i, &(x, y)) in nodes.iter().enumerate() {
        for d in 0..2 {
            of[y * mesh.layer_size() + mesh.place(x, d)] = 2 * i + d;
        }
    }
    Numbering { of, count: 2 * nodes.len() }
}

/// Nested dissection of the periodic strip, the cuts along lines of element edges.
fn dissection(mesh: &Mesh) -> Numbering {
    let (width, height, order) = (mesh.layer_nodes(), mesh.layers() - 1, mesh.order);
    let half = mesh.columns / 2 * order;
    let mut nodes = Vec::new();
    dissect((1, half), (0, height), order, &mut nodes);
    dissect((half + 1, width), (0, height), order, &mut nodes);
    for x in [half, 0] {
        nodes.extend((0..height).map(|y| (x, y)));
    }
    assert_eq!(nodes.len(), width * height);
    numbered(mesh, &nodes)
}

fn dissect(x: (usize, usize), y: (usize, usize), order: usize, nodes: &mut Vec<(usize, usize)>) {
    let cut = |(from, to): (usize, usize)| {
        let middle = (from + to) / 2;
        let at = (middle + order / 2) / order * order;
        (to > from + 1 && at > from && at + 1 < to).then_some(at)
    };
    let (wide, high) = (x.1 - x.0, y.1 - y.0);
    let (by_x, by_y) = (cut(x), cut(y));
    if wide * high > 6 {
        if let (Some(at), true) = (by_x, wide >= high || by_y.is_none()) {
            dissect((x.0, at), y, order, nodes);
            dissect((at + 1, x.1), y, order, nodes);
            nodes.extend((y.0..y.1).map(|y| (at, y)));
            return;
        }
        if let Some(at) = by_y {
            dissect(x, (y.0, at), order, nodes);
            dissect(x, (at + 1, y.1), order, nodes);
            nodes.extend((x.0..x.1).map(|x| (x, at)));
            return;
        }
    }
    nodes.extend((x.0..x.1).flat_map(|x| (y.0..y.1).map(move |y| (x, y))));
}

/// Compressed columns and where every element's entries go.
struct Pattern {
    count: usize,
    pointer: Vec<usize>,
    rows: Vec<usize>,
    /// Element by element, entry by entry of its stiffness.
    to: Vec<u32>,
    /// Place of every diagonal entry.
    diagonal: Vec<usize>,
    number: Vec<usize>,
}

impl Pattern {
    fn new(block: &Block<'_>, numbering: Numbering, lower: bool) -> Self {
        let mesh = block.mesh;
        let Numbering { of, count } = numbering;
        let mut columns: Vec<Vec<usize>> = vec![Vec::new(); count];
        let all = || (0..mesh.rows).flat_map(|r| (0..mesh.columns).map(move |c| (r, c)));
        for at in all() {
            let own: Vec<usize> = places(block, at).iter().map(|&p| of[p]).collect();
            for &j in own.iter().filter(|&&j| j != NONE) {
                columns[j].extend(own.iter().filter(|&&i| i != NONE && (!lower || i >= j)));
            }
        }
        let (mut pointer, mut rows) = (vec![0], Vec::new());
        for column in &mut columns {
            column.sort_unstable();
            column.dedup();
            rows.extend_from_slice(column);
            pointer.push(rows.len());
        }
        let mut to = Vec::new();
        for at in all() {
            let own: Vec<usize> = places(block, at).iter().map(|&p| of[p]).collect();
            for &i in &own {
                for &j in &own {
                    let free = i != NONE && j != NONE && (!lower || i >= j);
                    to.push(if free {
                        let column = &columns[j];
                        (pointer[j] + column.binary_search(&i).unwrap()) as u32
                    } else {
                        u32::MAX
                    });
                }
            }
        }
        let diagonal = (0..count)
            .map(|j| pointer[j] + columns[j].binary_search(&j).unwrap())
            .collect();
        Self { count, pointer, rows, to, diagonal, number: of }
    }

    fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.count, self.count, &self.pointer, None, &self.rows)
    }
}

struct Assembled {
    values: Vec<f64>,
    /// Element by element, `[mode][unknown]`.
    volumes: Vec<f64>,
}

/// The condensed tangent, and of the contact forces that follow the profile.
fn assemble(
    pattern: &Pattern,
    block: &Block<'_>,
    state: &State,
    rows: &[RowState],
    bend: &[f64],
) -> Assembled {
    let mesh = block.mesh;
    let mut values = vec![0.0; pattern.rows.len()];
    let mut volumes = Vec::new();
    let mut element = ElementTangent::new(block);
    let size = element.stiffness.len();
    for row in 0..mesh.rows {
        for column in 0..mesh.columns {
            element.fill(block, &state.field, &rows[row], (row, column));
            element.condense(&mesh.elements[row].mode_mass, block.bulk_modulus);
            let to = &pattern.to[(row * mesh.columns + column) * size..][..size];
            for (&to, value) in to.iter().zip(&element.stiffness) {
                if to != u32::MAX {
                    values[to as usize] += value;
                }
            }
            volumes.extend_from_slice(&element.volume);
        }
    }
    for (a, bend) in bend.iter().enumerate() {
        values[pattern.diagonal[pattern.number[mesh.place(a, 0)]]] += bend;
    }
    Assembled { values, volumes }
}

/// A sparse Cholesky factor.
struct Cholesky {
    kind: Kind,
    symbolic: SymbolicCholesky<usize>,
}

impl Cholesky {
    fn new(pattern: &Pattern, kind: Kind, amd: bool, simplicial: bool) -> Self {
        let identity: Vec<usize> = (0..pattern.count).collect();
        let order = if amd {
            SymmetricOrdering::Amd
        } else {
            SymmetricOrdering::Custom(PermRef::new_checked(&identity, &identity, pattern.count))
        };
        let params = cholesky::CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: if simplicial {
                SupernodalThreshold::FORCE_SIMPLICIAL
            } else {
                SupernodalThreshold::FORCE_SUPERNODAL
            },
            ..Default::default()
        };
        let symbolic =
            cholesky::factorize_symbolic_cholesky(pattern.symbolic(), Side::Lower, order, params)
                .unwrap();
        Self { kind, symbolic }
    }

    /// Entries and multiplications with additions.
    fn cost(&self) -> (f64, f64) {
        let SymbolicCholeskyRaw::Supernodal(s) = self.symbolic.raw() else {
            return (self.symbolic.len_val() as f64, f64::NAN);
        };
        let (mut fill, mut flops) = (0.0, 0.0);
        for k in 0..s.n_supernodes() {
            let columns = s.supernode_end()[k] - s.supernode_begin()[k];
            let below = s.col_ptr_for_row_idx()[k + 1] - s.col_ptr_for_row_idx()[k];
            for j in 0..columns {
                let left = (columns - j + below) as f64;
                fill += left;
                flops += left * left;
            }
        }
        (fill, flops)
    }

    fn factor(&self, pattern: &Pattern, values: &[f64]) -> Option<Numbers> {
        let a = SparseColMatRef::new(pattern.symbolic(), values);
        let n = pattern.count;
        let mut l = vec![0.0; self.symbolic.len_val()];
        let kind = self.kind;
        let req = match kind {
            Kind::Llt => self.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
            Kind::Ldlt => self.symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default()),
            Kind::Lblt => self.symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(Par::Seq, Default::default()),
        };
        let mut memory = MemBuffer::new(req);
        let stack = MemStack::new(&mut memory);
        let (mut below, mut forward, mut inverse) = (Vec::new(), Vec::new(), Vec::new());
        match kind {
            Kind::Llt => {
                self.symbolic.factorize_numeric_llt(&mut l, a, Side::Lower, Default::default(), Par::Seq, stack, Default::default()).ok()?;
            }
            Kind::Ldlt => {
                self.symbolic.factorize_numeric_ldlt(&mut l, a, Side::Lower, Default::default(), Par::Seq, stack, Default::default()).ok()?;
            }
            Kind::Lblt => {
                below = vec![0.0; n];
                forward = vec![0; n];
                inverse = vec![0; n];
                self.symbolic.factorize_numeric_intranode_lblt(&mut l, &mut below, &mut forward, &mut inverse, a, Side::Lower, Par::Seq, stack, Default::default());
            }
        }
        Some(Numbers { l, below, forward, inverse })
    }

    fn solve(&self, numbers: &Numbers, right: MatMut<'_, f64>) {
        let req = self.symbolic.solve_in_place_scratch::<f64>(right.ncols(), Par::Seq);
        let mut memory = MemBuffer::new(req);
        let stack = MemStack::new(&mut memory);
        let (symbolic, l) = (&self.symbolic, &numbers.l[..]);
        match self.kind {
            Kind::Llt => cholesky::LltRef::new(symbolic, l).solve_in_place_with_conj(Conj::No, right, Par::Seq, stack),
            Kind::Ldlt => cholesky::LdltRef::new(symbolic, l).solve_in_place_with_conj(Conj::No, right, Par::Seq, stack),
            Kind::Lblt => {
                let order = PermRef::new_checked(&numbers.forward, &numbers.inverse, right.nrows());
                cholesky::IntranodeLbltRef::new(symbolic, l, &numbers.below, order)
                    .solve_in_place_with_conj(Conj::No, right, Par::Seq, stack);
            }
        }
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Llt,
    Ldlt,
    Lblt,
}

struct Numbers {
    l: Vec<f64>,
    below: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

/// A sparse LU factor: by COLAMD through the front door, in the order given through the back.
enum Lu {
    Front(lu::SymbolicLu<usize>),
    Back(Vec<usize>, lu::supernodal::SymbolicSupernodalLu<usize>),
}

enum LuNumbers {
    Front(lu::NumericLu<usize, f64>),
    Back(Vec<usize>, Vec<usize>, lu::supernodal::SupernodalLu<usize, f64>),
}

fn transposed(p: &Pattern, values: &[f64]) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
    let mut pointer = vec![0; p.count + 1];
    p.rows.iter().for_each(|&i| pointer[i + 1] += 1);
    (0..p.count).for_each(|i| pointer[i + 1] += pointer[i]);
    let mut next = pointer.clone();
    let (mut rows, mut out) = (vec![0; p.rows.len()], vec![0.0; p.rows.len()]);
    for j in 0..p.count {
        for at in p.pointer[j]..p.pointer[j + 1] {
            let to = next[p.rows[at]];
            next[p.rows[at]] += 1;
            rows[to] = j;
            out[to] = values[at];
        }
    }
    (pointer, rows, out)
}

impl Lu {
    fn colamd(pattern: &Pattern, simplicial: bool) -> Self {
        let params = lu::LuSymbolicParams {
            supernodal_flop_ratio_threshold: if simplicial {
                SupernodalThreshold::FORCE_SIMPLICIAL
            } else {
                SupernodalThreshold::FORCE_SUPERNODAL
            },
            ..Default::default()
        };
        Self::Front(lu::factorize_symbolic_lu(pattern.symbolic(), params).unwrap())
    }

    /// With an upper bound of the entries of U.
    fn given(pattern: &Pattern) -> (Self, f64) {
        let n = pattern.count;
        let identity: Vec<usize> = (0..n).collect();
        let perm = PermRef::new_checked(&identity, &identity, n);
        let (t_pointer, t_rows, _) = transposed(pattern, &vec![0.0; pattern.rows.len()]);
        let transpose = SymbolicSparseColMatRef::new_checked(n, n, &t_pointer, None, &t_rows);
        let mut memory = MemBuffer::new(StackReq::all_of(&[
            StackReq::new::<usize>(20 * n + 20),
            lu::supernodal::factorize_supernodal_symbolic_lu_scratch::<usize>(n, n),
        ]));
        let (mut tree, mut post) = (vec![0; n], vec![0; n]);
        let (mut counts, mut least) = (vec![0; n], vec![0; n]);
        let tree = qr::col_etree(
            pattern.symbolic(),
            Some(perm),
            &mut tree,
            MemStack::new(&mut memory),
        );
        qr::postorder(&mut post, tree, MemStack::new(&mut memory));
        qr::column_counts_ata(
            &mut counts,
            &mut least,
            transpose,
            Some(perm),
            tree,
            &post,
            MemStack::new(&mut memory),
        );
        let symbolic = lu::supernodal::factorize_supernodal_symbolic_lu::<usize>(
            pattern.symbolic(),
            Some(perm),
            &least,
            tree,
            &counts,
            MemStack::new(&mut memory),
            SymbolicSupernodalParams::default(),
        )
        .unwrap();
        let bound = counts.iter().sum::<usize>() as f64;
        (Self::Back(identity, symbolic), bound)
    }

    fn factor(&self, pattern: &Pattern, values: &[f64]) -> Option<LuNumbers> {
        let a = SparseColMatRef::new(pattern.symbolic(), values);
        match self {
            Self::Front(symbolic) => {
                let mut numbers = lu::NumericLu::new();
                let req =
                    symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default());
                let mut memory = MemBuffer::new(req);
                symbolic
                    .factorize_numeric_lu(
                        &mut numbers,
                        a,
                        Par::Seq,
                        MemStack::new(&mut memory),
                        Default::default(),
                    )
                    .ok()?;
                Some(LuNumbers::Front(numbers))
            }
            Self::Back(identity, symbolic) => {
                let n = pattern.count;
                let (t_pointer, t_rows, t_values) = transposed(pattern, values);
                let transpose = SparseColMatRef::new(
                    SymbolicSparseColMatRef::new_checked(n, n, &t_pointer, None, &t_rows),
                    &t_values[..],
                );
                let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
                let mut numbers = lu::supernodal::SupernodalLu::new();
                let req = lu::supernodal::factorize_supernodal_numeric_lu_scratch::<usize, f64>(
                    symbolic,
                    Default::default(),
                );
                let mut memory = MemBuffer::new(req);
                lu::supernodal::factorize_supernodal_numeric_lu(
                    &mut forward,
                    &mut inverse,
                    &mut numbers,
                    a,
                    transpose,
                    PermRef::new_checked(identity, identity, n),
                    symbolic,
                    Par::Seq,
                    MemStack::new(&mut memory),
                    Default::default(),
                )
                .ok()?;
                Some(LuNumbers::Back(forward, inverse, numbers))
            }
        }
    }

    fn solve(&self, numbers: &LuNumbers, right: MatMut<'_, f64>) {
        let (n, k) = (right.nrows(), right.ncols());
        match (self, numbers) {
            (Self::Front(symbolic), LuNumbers::Front(numbers)) => {
                let req = symbolic.solve_in_place_scratch::<f64>(k, Par::Seq);
                let mut memory = MemBuffer::new(req);
                lu::LuRef::new_unchecked(symbolic, numbers).solve_in_place_with_conj(
                    Conj::No,
                    right,
                    Par::Seq,
                    MemStack::new(&mut memory),
                );
            }
            (Self::Back(identity, _), LuNumbers::Back(forward, inverse, numbers)) => {
                let req = lu::supernodal::solve_in_place_scratch::<usize, f64>(n, k, Par::Seq);
                let mut memory = MemBuffer::new(req);
                numbers.solve_in_place_with_conj(
                    PermRef::new_checked(forward, inverse, n),
                    PermRef::new_checked(identity, identity, n),
                    Conj::No,
                    right,
                    Par::Seq,
                    MemStack::new(&mut memory),
                );
            }
            _ => unreachable!(),
        }
    }
}

/// A case: relaxed or sliding rubber on a sine.
struct Case {
    amplitude: f64,
    /// Over the modulus.
    pressure: f64,
    slides: bool,
}

fn problem(case: &Case, columns: usize, order: usize) -> Problem {
    let (moduli, times) = if case.slides {
        (vec![2.0, 6.0], vec![0.3, 0.03])
    } else {
        (vec![], vec![])
    };
    let rows = (20.0 * (columns as f64 / 128.0).powf(0.33) / order as f64).round() as usize;
    Problem {
        rubber: Rubber::new(
            Energy::new("neo_hookean", &Default::default()).unwrap(),
            1.0,
            moduli,
            times,
            1000.0,
        )
        .unwrap(),
        profile: Profile::new(1.0, Heights::sine(case.amplitude).unwrap()).unwrap(),
        load: Load::new(case.pressure, if case.slides { 1.0 } else { 0.0 }, 5.0).unwrap(),
        mesh: MeshSize::new(columns / order, rows.max(4), 1.5, order).unwrap(),
    }
}

/// The linearisation of a state.
struct Linear {
    rows: Vec<RowState>,
    slope: Vec<f64>,
    bend: Vec<f64>,
    gap: Vec<f64>,
    /// Forces out of balance, of the condensed system in the order of a field.
    right: Vec<f64>,
    volumes: Vec<f64>,
}

fn linearise(pressed: &PressedBlock<'_>, state: &State) -> Linear {
    let mesh = pressed.block.mesh;
    let rows = pressed.row_states(&state.field).unwrap();
    let x = pressed.abscissae(&state.field);
    let slope: Vec<f64> = x.iter().map(|&x| pressed.heights.slope(x)).collect();
    let bend = x.iter().zip(&state.force);
    let bend = bend.map(|(&x, f)| f * pressed.heights.curvature(x)).collect();
    let mut right = vec![0.0; state.field.u.len()];
    let mut volumes = Vec::new();
    for (row, of) in rows.iter().enumerate() {
        let (forces, _) = pressed.block.row_forces(row, &state.field, of);
        let from = row * mesh.order * mesh.layer_size();
        right[from..].iter_mut().zip(&forces).for_each(|(to, f)| *to -= f);
        volumes.extend(pressed.block.row_volumes(row, &state.field, of).iter().map(|v| -v));
    }
    for (a, force) in state.force.iter().enumerate() {
        right[mesh.place(a, 0)] -= slope[a] * force;
        right[mesh.place(a, 1)] += force;
    }
    let gap = pressed.gaps(state, &x);
    Linear { rows, slope, bend, gap, right, volumes }
}

/// Which factor.
enum Way {
    Cholesky(Cholesky),
    Lu(Lu),
}
enum Factor<'a> {
    Cholesky(&'a Cholesky, Numbers),
    Lu(&'a Lu, LuNumbers),
}
impl Way {
    fn factor(&self, pattern: &Pattern, values: &[f64]) -> Option<Factor<'_>> {
        Some(match self {
            Self::Cholesky(one) => Factor::Cholesky(one, one.factor(pattern, values)?),
            Self::Lu(one) => Factor::Lu(one, one.factor(pattern, values)?),
        })
    }
}
impl Factor<'_> {
    fn solve(&self, right: MatMut<'_, f64>) {
        match self {
            Self::Cholesky(one, l) => one.solve(l, right),
            Self::Lu(one, numbers) => one.solve(numbers, right),
        }
    }
}

/// The factored tangent at one state.
struct Tangent<'a> {
    mesh: &'a Mesh,
    bulk_modulus: f64,
    pattern: &'a Pattern,
    factor: Factor<'a>,
    volumes: Vec<f64>,
    /// What the mean shift does: J_l^-1 bend and 1 - its own shift.
    shift: (Vec<f64>, f64),
    places: Vec<Vec<usize>>,
}

impl<'a> Tangent<'a> {
    fn new(
        pressed: &PressedBlock<'a>,
        state: &State,
        linear: &Linear,
        pattern: &'a Pattern,
        way: &'a Way,
    ) -> Option<Self> {
        let block = &pressed.block;
        let assembled = assemble(pattern, block, state, &linear.rows, &linear.bend);
        let factor = way.factor(pattern, &assembled.values)?;
        let mesh = block.mesh;
        let places = (0..mesh.rows)
            .flat_map(|r| (0..mesh.columns).map(move |c| (r, c)))
            .map(|at| places(block, at))
            .collect();
        let mut own = Self {
            mesh,
            bulk_modulus: block.bulk_modulus,
            pattern,
            factor,
            volumes: assembled.volumes,
            shift: (Vec::new(), 1.0),
            places,
        };
        let mut bend = vec![0.0; state.field.u.len()];
        for (a, value) in linear.bend.iter().enumerate() {
            bend[mesh.place(a, 0)] = *value;
        }
        let moved = own.displaced(&bend);
        own.shift.1 = 1.0 - mesh.mean_shift(&moved);
        own.shift.0 = moved;
        Some(own)
    }

    fn local(&self, right: &mut Mat<f64>) {
        self.factor.solve(right.as_mut());
    }

    /// Displacements by forces, both as a field, at fixed shift where that is not known yet.
    fn displaced(&self, forces: &[f64]) -> Vec<f64> {
        let number = &self.pattern.number;
        let mut right = Mat::zeros(self.pattern.count, 1);
        for (force, &to) in forces.iter().zip(number) {
            if to != NONE {
                right[(to, 0)] = *force;
            }
        }
        self.local(&mut right);
        let mut u: Vec<f64> =
            number.iter().map(|&from| if from == NONE { 0.0 } else { right[(from, 0)] }).collect();
        self.follow(&mut u);
        u
    }

    /// What the mean shift adds.
    fn follow(&self, u: &mut [f64]) {
        let part = self.mesh.mean_shift(u) / self.shift.1;
        u.iter_mut().zip(&self.shift.0).for_each(|(u, by)| *u += part * by);
    }

    /// Forces with those of volumes `[row][column][mode]`, condensed.
    fn condensed(&self, forces: &[f64], volumes: &[f64]) -> Vec<f64> {
        let mut out = forces.to_vec();
        self.each(|places, volume, m, mass, at| {
            let factor = self.bulk_modulus / mass * volumes[at];
            let _ = m;
            for (&place, b) in places.iter().zip(volume) {
                out[place] += factor * b;
            }
        });
        out
    }

    fn pressures(&self, u: &[f64], volumes: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; volumes.len()];
        self.each(|places, volume, _, mass, at| {
            let sum: f64 = places.iter().zip(volume).map(|(&place, b)| b * u[place]).sum();
            out[at] = self.bulk_modulus / mass * (sum - volumes[at]);
        });
        out
    }

    fn each(&self, mut visit: impl FnMut(&[usize], &[f64], usize, f64, usize)) {
        let mesh = self.mesh;
        let (modes, size) = (mesh.modes(), 2 * mesh.elements[0].nodes());
        for e in 0..mesh.rows * mesh.columns {
            for m in 0..modes {
                let mass = mesh.elements[e / mesh.columns].mode_mass[m];
                let volume = &self.volumes[(e * modes + m) * size..][..size];
                visit(&self.places[e], volume, m, mass, e * modes + m);
            }
        }
    }

    /// What the displacements of the surface add to the gaps.
    fn opening(&self, u: &[f64], slope: &[f64]) -> Vec<f64> {
        let shift = self.mesh.mean_shift(u);
        let of = |(a, slope): (usize, &f64)| {
            u[self.mesh.place(a, 1)] - slope * (u[self.mesh.place(a, 0)] - shift)
        };
        slope.iter().enumerate().map(of).collect()
    }

    /// What unit contact forces at the nodes of `set` add to the gaps there.
    fn compliance(&self, set: &[usize], slope: &[f64]) -> Dense {
        let mut columns = Vec::new();
        let surface: Vec<usize> = (0..self.mesh.layer_size()).collect();
        for part in set.chunks(32) {
            let mut right = Mat::zeros(self.pattern.count, part.len());
            for (k, &a) in part.iter().enumerate() {
                right[(self.pattern.number[self.mesh.place(a, 0)], k)] = -slope[a];
                right[(self.pattern.number[self.mesh.place(a, 1)], k)] = 1.0;
            }
            self.local(&mut right);
            for k in 0..part.len() {
                let mut u: Vec<f64> =
                    surface.iter().map(|&p| right[(self.pattern.number[p], k)]).collect();
                self.follow(&mut u);
                let opening = self.opening(&u, slope);
                columns.push(set.iter().map(|&a| opening[a]).collect());
            }
        }
        Dense(columns)
    }
}

/// Columns of a compliance.
struct Dense(Vec<Vec<f64>>);
impl Compliance for Dense {
    fn between(&self, to: usize, from: usize) -> f64 {
        self.0[from][to]
    }
    fn open(&self, force: &[f64], gap: &mut [f64]) {
        for (column, f) in self.0.iter().zip(force) {
            if *f != 0.0 {
                gap.iter_mut().zip(column).for_each(|(gap, c)| *gap += c * f);
            }
        }
    }
}

/// The nodes that touch and some beside them.
fn candidates(active: &[bool]) -> Vec<usize> {
    let n = active.len();
    let margin = (n / 32).max(2);
    let near = |a: usize| (0..=2 * margin).any(|i| active[(a + n + i - margin) % n]);
    (0..n).filter(|&a| near(a)).collect()
}

/// Times of the parts of one step [ms].
#[derive(Default, Clone, Copy)]
struct Parts {
    assembly: f64,
    factor: f64,
    surface: f64,
    contact: f64,
    rest: f64,
    nodes: usize,
}

/// One Newton step by the factor, whole.
fn sparse_step(
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
    pattern: &Pattern,
    way: &Way,
    settings: &Settings,
    parts: &mut Parts,
) -> Option<()> {
    let mesh = pressed.block.mesh;
    let mark = cpu();
    let linear = linearise(pressed, state);
    parts.rest += cpu() - mark;
    let tangent = Tangent::new(pressed, state, &linear, pattern, way)?;
    let right = tangent.condensed(&linear.right, &linear.volumes);
    parts.factor += cpu() - mark;
    let set = candidates(&state.active);
    let free_moved = tangent.opening(&tangent.displaced(&right), &linear.slope);
    let mark = cpu();
    let compliance = tangent.compliance(&set, &linear.slope);
    parts.surface += cpu() - mark;
    parts.nodes = set.len();
    let mark = cpu();
    let old: Vec<f64> = set.iter().map(|&a| state.force[a]).collect();
    let mut by_old = vec![0.0; set.len()];
    compliance.open(&old, &mut by_old);
    let free: Vec<f64> = set
        .iter()
        .zip(by_old)
        .map(|(&a, old)| linear.gap[a] + state.approach + free_moved[a] - old)
        .collect();
    let contact = complementarity::solve(
        &Linearised { compliance: &compliance, free: &free, load },
        &set.iter().map(|&a| state.active[a]).collect::<Vec<_>>(),
        settings,
        pressed.watch,
    )
    .ok()?;
    parts.contact += cpu() - mark;
    let mark = cpu();
    let mut force = vec![0.0; state.force.len()];
    let mut active = vec![false; state.force.len()];
    for (k, &a) in set.iter().enumerate() {
        force[a] = contact.force[k];
        active[a] = contact.active[k];
    }
    let mut right = right;
    for a in 0..force.len() {
        let change = force[a] - state.force[a];
        right[mesh.place(a, 0)] -= linear.slope[a] * change;
        right[mesh.place(a, 1)] += change;
    }
    let u = tangent.displaced(&right);
    let p = tangent.pressures(&u, &linear.volumes);
    state.field.u.iter_mut().zip(&u).for_each(|(to, u)| *to += u);
    state.field.pressure.iter_mut().zip(&p).for_each(|(to, p)| *to += p);
    state.force = force;
    state.active = active;
    state.approach = contact.approach;
    parts.rest += cpu() - mark;
    Some(())
}

/// Newton steps on a set of nodes that touch: their constraint eliminated, one factor and three
/// solutions a step.
struct Direct<'a> {
    pattern: Pattern,
    way: Cholesky,
    pressed: &'a PressedBlock<'a>,
    places: Vec<usize>,
    columns_of: Vec<usize>,
}

/// A factor with what belongs to it.
struct Kept {
    elements: Elements,
    numbers: Numbers,
    slope: Vec<f64>,
    active: Vec<bool>,
    moved: Vec<Vec<f64>>,
    pressed: Vec<Vec<f64>>,
}

/// What is kept of the elements: their volumes, and the stiffness of those at the surface.
struct Elements {
    values: Vec<f64>,
    volumes: Vec<f64>,
    surface: Vec<f64>,
}

fn element<const SIZE: usize>(
    block: &Block<'_>,
    pressures: &[f64],
    state: &RowState,
    (row, column): (usize, usize),
    k: &mut [[f64; SIZE]; SIZE],
    b: &mut [[f64; SIZE]; 3],
) {
    use gripscale_kernel::material::kinematics::cofactor;
    use gripscale_kernel::material::stress::tangent;
    let element = &block.mesh.elements[row];
    let points = block.mesh.order + 1;
    *k = [[0.0; SIZE]; SIZE];
    *b = [[0.0; SIZE]; 3];
    for at in 0..points * points {
        let (line, q) = (at / points, column * points + at % points);
        let f = &state.gradient[line][q];
        let mode = &element.mode[at];
        let level = mode.iter().zip(pressures).map(|(mode, p)| mode * p).sum();
        let weight = element.weight[at];
        let d = tangent(f, &state.h[line][q], level);
        let cof = cofactor(f);
        let mut stress = [[0.0; SIZE]; 4];
        let mut volume = [0.0; SIZE];
        let gradient = &element.gradient[at];
        for j in 0..SIZE / 2 {
            let [x, z] = gradient[j];
            let (x, z) = (weight * x, weight * z);
            for a in 0..4 {
                stress[a][2 * j] = d[a][0] * x + d[a][1] * z;
                stress[a][2 * j + 1] = d[a][2] * x + d[a][3] * z;
            }
            volume[2 * j] = cof[0] * x + cof[1] * z;
            volume[2 * j + 1] = cof[2] * x + cof[3] * z;
        }
        for i in 0..SIZE / 2 {
            let [x, z] = gradient[i];
            for j in 0..SIZE {
                k[2 * i][j] += x * stress[0][j] + z * stress[1][j];
                k[2 * i + 1][j] += x * stress[2][j] + z * stress[3][j];
            }
        }
        for (m, mode) in mode.iter().enumerate() {
            for j in 0..SIZE {
                b[m][j] += mode * volume[j];
            }
        }
    }
    for (m, mass) in element.mode_mass.iter().enumerate() {
        let stiffness = block.bulk_modulus / mass;
        for i in 0..SIZE {
            let factor = stiffness * b[m][i];
            for j in 0..SIZE {
                k[i][j] += factor * b[m][j];
            }
        }
    }
}

impl<'a> Direct<'a> {
    fn new(pressed: &'a PressedBlock<'a>) -> Self {
        let mesh = pressed.block.mesh;
        let pattern = Pattern::new(&pressed.block, dissection(mesh), true);
        let way = Cholesky::new(&pattern, Kind::Ldlt, false, false);
        let places = (0..mesh.rows)
            .flat_map(|r| (0..mesh.columns).map(move |c| (r, c)))
            .flat_map(|at| places(&pressed.block, at))
            .collect();
        Self { pattern, way, pressed, places, columns_of: Vec::new() }
    }

    fn elements(&self, state: &State, rows: &[RowState], slope: &[f64], bend: &[f64]) -> Elements {
        match self.pressed.block.mesh.order {
            1 => self.elements_of::<8>(state, rows, slope, bend),
            _ => self.elements_of::<18>(state, rows, slope, bend),
        }
    }

    fn elements_of<const SIZE: usize>(&self, state: &State, rows: &[RowState], slope: &[f64], bend: &[f64]) -> Elements {
        let block = &self.pressed.block;
        let mesh = block.mesh;
        let modes = mesh.modes();
        // One more place for what belongs nowhere.
        let mut values = vec![0.0; self.pattern.rows.len()];
        let mut volumes = Vec::with_capacity(mesh.rows * mesh.columns * modes * SIZE);
        let mut surface = Vec::with_capacity(mesh.columns * SIZE * SIZE);
        let mut k = [[0.0; SIZE]; SIZE];
        let mut b = [[0.0; SIZE]; 3];
        for row in 0..mesh.rows {
            for column in 0..mesh.columns {
                let e = row * mesh.columns + column;
                let pressures = &state.field.pressure[e * modes..][..modes];
                pulp::Arch::new().dispatch(|| element::<SIZE>(block, pressures, &rows[row], (row, column), &mut k, &mut b));
                b[..modes].iter().for_each(|b| volumes.extend_from_slice(b));
                if row == 0 {
                    k.iter().for_each(|line| surface.extend_from_slice(line));
                    for sub in 0..=mesh.order {
                        let a = (column * mesh.order + sub) % mesh.layer_nodes();
                        if state.active[a] {
                            let (x, z) = (2 * sub, 2 * sub + 1);
                            for i in 0..SIZE {
                                k[i][x] += slope[a] * k[i][z];
                                k[i][z] = 0.0;
                            }
                            for j in 0..SIZE {
                                k[x][j] += slope[a] * k[z][j];
                                k[z][j] = 0.0;
                            }
                        }
                    }
                }
                let to = &self.pattern.to[e * SIZE * SIZE..][..SIZE * SIZE];
                for i in 0..SIZE {
                    for j in 0..SIZE {
                        let to = to[i * SIZE + j];
                        if to != u32::MAX {
                            values[to as usize] += k[i][j];
                        }
                    }
                }
            }
        }
        for (a, bend) in bend.iter().enumerate() {
            let number = &self.pattern.number;
            values[self.pattern.diagonal[number[mesh.place(a, 0)]]] += bend;
            if state.active[a] {
                values[self.pattern.diagonal[number[mesh.place(a, 1)]]] = 1.0;
            }
        }
        Elements { values, volumes, surface }
    }

    /// Forces on the surface layer's z, and on all of the lowest row, by displacements of it.
    fn by_surface(&self, elements: &Elements, u: &[f64]) -> Vec<f64> {
        let mesh = self.pressed.block.mesh;
        let size = 2 * mesh.elements[0].nodes();
        let mut out = vec![0.0; (mesh.order + 1) * mesh.layer_size()];
        for column in 0..mesh.columns {
            let places = &self.places[column * size..][..size];
            let k = &elements.surface[column * size * size..][..size * size];
            let mut own = [0.0; 18];
            for (to, &place) in own.iter_mut().zip(places) {
                *to = u[place];
            }
            for (line, &place) in k.chunks_exact(size).zip(places) {
                out[place] += line.iter().zip(&own).map(|(k, u)| k * u).sum::<f64>();
            }
        }
        out
    }

    /// Load and residual as the solver judges them.
    fn judged(&self, linear: &Linear, state: &State, load: f64) -> f64 {
        let free = linear.right.len() - self.pressed.block.mesh.layer_size();
        let forces = linear.right[..free].iter().map(|f| f * f).sum::<f64>().sqrt() / load;
        let volumes = linear.volumes.iter().map(|f| f * f).sum::<f64>().sqrt();
        let total = (state.force.iter().sum::<f64>() / load - 1.0).abs();
        let gap = linear.gap.iter().zip(&state.active);
        let gap = gap.map(|(gap, active)| if *active { gap.abs() } else { -gap }).fold(0.0, f64::max);
        forces.max(volumes).max(total).max(gap / self.pressed.heights.half_range())
    }

    /// Steps with the factor that there is as long as they halve the residual four times or so.
    fn chord(&self, state: &mut State, load: f64, kept: &mut Option<Kept>, counts: &mut [usize; 2]) -> bool {
        let mut before = f64::INFINITY;
        for _ in 0..60 {
            let linear = linearise(self.pressed, state);
            let residual = self.judged(&linear, state, load);
            if residual < 1e-8 {
                return true;
            }
            let stale = kept.as_ref().is_none_or(|kept| kept.active != state.active);
            if stale || residual > 0.3 * before {
                *kept = self.keep(state, &linear);
                counts[0] += 1;
            }
            before = residual;
            counts[1] += 1;
            let Some(next) = self.by_kept(state, load, &linear, kept.as_ref()) else { return false };
            if next != state.active {
                before = f64::INFINITY;
            }
            for a in 0..next.len() {
                if !next[a] {
                    state.force[a] = 0.0;
                }
            }
            state.active = next;
        }
        false
    }

    fn keep(&self, state: &State, linear: &Linear) -> Option<Kept> {
        let mesh = self.pressed.block.mesh;
        let elements = self.elements(state, &linear.rows, &linear.slope, &linear.bend);
        let numbers = self.way.factor(&self.pattern, &elements.values)?;
        let touching: Vec<usize> = (0..mesh.layer_nodes()).filter(|&a| state.active[a]).collect();
        let mut kept = Kept { elements, numbers, slope: linear.slope.clone(), active: state.active.clone(), moved: Vec::new(), pressed: Vec::new() };
        let mut loads = Mat::zeros(self.pattern.count, 2);
        let mut prescribed = Vec::new();
        for which in 0..2 {
            let mut q = vec![0.0; (mesh.order + 1) * mesh.layer_size()];
            for &a in &touching {
                q[mesh.place(a, 1)] = if which == 0 { 1.0 } else { -linear.slope[a] };
            }
            let mut force: Vec<f64> = self.by_surface(&kept.elements, &q).iter().map(|f| -f).collect();
            if which == 1 {
                linear.bend.iter().enumerate().for_each(|(a, bend)| force[mesh.place(a, 0)] += bend);
            }
            self.project(&mut force, &kept, &touching);
            for (f, &to) in force.iter().zip(&self.pattern.number) {
                if to != NONE {
                    loads[(to, which)] = *f;
                }
            }
            prescribed.push(q);
        }
        self.way.solve(&kept.numbers, loads.as_mut());
        for (which, q) in prescribed.iter().enumerate() {
            let u = self.unprojected(&loads, which, q, &kept, &touching);
            let by = self.by_surface(&kept.elements, &u);
            kept.pressed.push(touching.iter().map(|&a| by[mesh.place(a, 1)]).collect());
            kept.moved.push(u);
        }
        Some(kept)
    }

    fn project(&self, force: &mut [f64], kept: &Kept, touching: &[usize]) {
        let mesh = self.pressed.block.mesh;
        for &a in touching {
            let z = std::mem::take(&mut force[mesh.place(a, 1)]);
            force[mesh.place(a, 0)] += kept.slope[a] * z;
        }
    }

    fn unprojected(&self, loads: &Mat<f64>, which: usize, q: &[f64], kept: &Kept, touching: &[usize]) -> Vec<f64> {
        let mesh = self.pressed.block.mesh;
        let column = loads.col_as_slice(which);
        let number = self.pattern.number.iter();
        let mut u: Vec<f64> = number.map(|&n| if n == NONE { 0.0 } else { column[n] }).collect();
        for &a in touching {
            u[mesh.place(a, 1)] = kept.slope[a] * u[mesh.place(a, 0)] + q[mesh.place(a, 1)];
        }
        u
    }

    fn by_kept(&self, state: &mut State, load: f64, linear: &Linear, kept: Option<&Kept>) -> Option<Vec<bool>> {
        let kept = kept?;
        let mesh = self.pressed.block.mesh;
        let (size, modes, nodes) = (2 * mesh.elements[0].nodes(), mesh.modes(), mesh.layer_nodes());
        let bulk = self.pressed.block.bulk_modulus;
        let mut right = linear.right.clone();
        for (e, volume) in kept.elements.volumes.chunks_exact(modes * size).enumerate() {
            let places = &self.places[e * size..][..size];
            for (m, b) in volume.chunks_exact(size).enumerate() {
                let factor = bulk / mesh.elements[e / mesh.columns].mode_mass[m] * linear.volumes[e * modes + m];
                places.iter().zip(b).for_each(|(&p, b)| right[p] += factor * b);
            }
        }
        let touching: Vec<usize> = (0..nodes).filter(|&a| state.active[a]).collect();
        let mut q = vec![0.0; (mesh.order + 1) * mesh.layer_size()];
        for &a in &touching {
            q[mesh.place(a, 1)] = -linear.gap[a];
        }
        let mut force = right.clone();
        force.iter_mut().zip(self.by_surface(&kept.elements, &q)).for_each(|(f, by)| *f -= by);
        self.project(&mut force, kept, &touching);
        let mut loads = Mat::zeros(self.pattern.count, 1);
        for (f, &to) in force.iter().zip(&self.pattern.number) {
            if to != NONE {
                loads[(to, 0)] = *f;
            }
        }
        self.way.solve(&kept.numbers, loads.as_mut());
        let mut u = self.unprojected(&loads, 0, &q, kept, &touching);
        let by = self.by_surface(&kept.elements, &u);
        let pressed: Vec<f64> = touching.iter().map(|&a| by[mesh.place(a, 1)] - right[mesh.place(a, 1)]).collect();
        let mean = [mesh.mean_shift(&u), mesh.mean_shift(&kept.moved[0]), mesh.mean_shift(&kept.moved[1])];
        let sum = [pressed.iter().sum::<f64>(), kept.pressed[0].iter().sum(), kept.pressed[1].iter().sum()];
        let old: f64 = touching.iter().map(|&a| state.force[a]).sum();
        let (a11, a12, b1) = (mean[1], mean[2] - 1.0, -mean[0]);
        let (a21, a22, b2) = (sum[1], sum[2], load - old - sum[0]);
        let determinant = a11 * a22 - a12 * a21;
        let approach = (b1 * a22 - a12 * b2) / determinant;
        let shift = (a11 * b2 - b1 * a21) / determinant;
        for (u, (a, b)) in u.iter_mut().zip(kept.moved[0].iter().zip(&kept.moved[1])) {
            *u += approach * a + shift * b;
        }
        let mut next = state.active.clone();
        for (k, &a) in touching.iter().enumerate() {
            state.force[a] += pressed[k] + approach * kept.pressed[0][k] + shift * kept.pressed[1][k];
            next[a] = state.force[a] >= 0.0;
        }
        for a in (0..nodes).filter(|&a| !state.active[a]) {
            let gap = linear.gap[a] + u[mesh.place(a, 1)] - kept.slope[a] * (u[mesh.place(a, 0)] - shift) - approach;
            next[a] = gap < 0.0;
        }
        for (e, volume) in kept.elements.volumes.chunks_exact(modes * size).enumerate() {
            let places = &self.places[e * size..][..size];
            for (m, b) in volume.chunks_exact(size).enumerate() {
                let sum: f64 = places.iter().zip(b).map(|(&p, b)| b * u[p]).sum();
                state.field.pressure[e * modes + m] += bulk / mesh.elements[e / mesh.columns].mode_mass[m] * (sum - linear.volumes[e * modes + m]);
            }
        }
        state.field.u.iter_mut().zip(&u).for_each(|(to, u)| *to += u);
        state.approach += approach;
        Some(next)
    }

    /// One step on the set of `state`; the next set is in what comes back.
    fn step(&self, state: &mut State, load: f64, clocks: &mut [f64; 5]) -> Option<Vec<bool>> {
        let mesh = self.pressed.block.mesh;
        let mut mark = cpu();
        let mut lap = |i: usize| {
            let now = cpu();
            clocks[i] += now - mark;
            mark = now;
        };
        let linear = linearise(self.pressed, state);
        lap(0);
        let elements = self.elements(state, &linear.rows, &linear.slope, &linear.bend);
        lap(1);
        let numbers = self.way.factor(&self.pattern, &elements.values)?;
        lap(2);
        let size = 2 * mesh.elements[0].nodes();
        let modes = mesh.modes();
        // Condensed right-hand side.
        let mut right = linear.right.clone();
        for (e, volume) in elements.volumes.chunks_exact(modes * size).enumerate() {
            let places = &self.places[e * size..][..size];
            for (m, b) in volume.chunks_exact(size).enumerate() {
                let mass = mesh.elements[e / mesh.columns].mode_mass[m];
                let factor = self.pressed.block.bulk_modulus / mass * linear.volumes[e * modes + m];
                places.iter().zip(b).for_each(|(&p, b)| right[p] += factor * b);
            }
        }
        // Of the gaps, of the approach and of the shift: what is prescribed.
        let nodes = mesh.layer_nodes();
        let touching: Vec<usize> = (0..nodes).filter(|&a| state.active[a]).collect();
        let reach = (mesh.order + 1) * mesh.layer_size();
        let prescribed: [Vec<f64>; 3] = std::array::from_fn(|which| {
            let mut q = vec![0.0; reach];
            for &a in &touching {
                q[mesh.place(a, 1)] = match which {
                    0 => -linear.gap[a],
                    1 => 1.0,
                    _ => -linear.slope[a],
                };
            }
            q
        });
        let mut loads = Mat::zeros(self.pattern.count, 3);
        let mut forces: Vec<Vec<f64>> = Vec::new();
        for (which, q) in prescribed.iter().enumerate() {
            let mut force: Vec<f64> = self.by_surface(&elements, q).iter().map(|f| -f).collect();
            force.resize(right.len(), 0.0);
            match which {
                0 => force.iter_mut().zip(&right).for_each(|(f, r)| *f += r),
                2 => linear.bend.iter().enumerate().for_each(|(a, bend)| force[mesh.place(a, 0)] += bend),
                _ => {}
            }
            for &a in &touching {
                let z = std::mem::take(&mut force[mesh.place(a, 1)]);
                force[mesh.place(a, 0)] += linear.slope[a] * z;
            }
            for (f, &to) in force.iter().zip(&self.pattern.number) {
                if to != NONE {
                    loads[(to, which)] = *f;
                }
            }
            forces.push(force);
        }
        self.way.solve(&numbers, loads.as_mut());
        lap(3);
        // Displacements, and the forces at the nodes that touch, of each.
        let mut moved: Vec<Vec<f64>> = Vec::new();
        let mut pressed: Vec<Vec<f64>> = Vec::new();
        for (which, q) in prescribed.iter().enumerate() {
            let number = self.pattern.number.iter();
            let mut u: Vec<f64> = number.map(|&n| if n == NONE { 0.0 } else { loads[(n, which)] }).collect();
            for &a in &touching {
                u[mesh.place(a, 1)] = linear.slope[a] * u[mesh.place(a, 0)] + q[mesh.place(a, 1)];
            }
            let by = self.by_surface(&elements, &u);
            pressed.push(touching.iter().map(|&a| {
                let z = mesh.place(a, 1);
                by[z] - if which == 0 { right[z] } else { 0.0 }
            }).collect());
            moved.push(u);
        }
        // sigma = mean u_x, sum f = load.
        let mean: Vec<f64> = moved.iter().map(|u| mesh.mean_shift(u)).collect();
        let sum: Vec<f64> = pressed.iter().map(|f| f.iter().sum()).collect();
        let old: f64 = touching.iter().map(|&a| state.force[a]).sum();
        // mean0 + d mean1 + s mean2 = s; sum0 + d sum1 + s sum2 = load - old
        let (a11, a12, b1) = (mean[1], mean[2] - 1.0, -mean[0]);
        let (a21, a22, b2) = (sum[1], sum[2], load - old - sum[0]);
        let determinant = a11 * a22 - a12 * a21;
        let approach = (b1 * a22 - a12 * b2) / determinant;
        let shift = (a11 * b2 - b1 * a21) / determinant;
        let combined = |parts: &[Vec<f64>], i: usize| parts[0][i] + approach * parts[1][i] + shift * parts[2][i];
        let u: Vec<f64> = (0..right.len()).map(|i| combined(&moved, i)).collect();
        let mut next = state.active.clone();
        let mut open = vec![true; nodes];
        for (k, &a) in touching.iter().enumerate() {
            let force = state.force[a] + combined(&pressed, k);
            open[a] = false;
            state.force[a] = force;
            if force < 0.0 {
                next[a] = false;
            }
        }
        for a in (0..nodes).filter(|&a| open[a]) {
            let gap = linear.gap[a] + u[mesh.place(a, 1)] - linear.slope[a] * (u[mesh.place(a, 0)] - shift) - approach;
            if gap < 0.0 {
                next[a] = true;
            }
        }
        for (e, volume) in elements.volumes.chunks_exact(modes * size).enumerate() {
            let places = &self.places[e * size..][..size];
            for (m, b) in volume.chunks_exact(size).enumerate() {
                let mass = mesh.elements[e / mesh.columns].mode_mass[m];
                let sum: f64 = places.iter().zip(b).map(|(&p, b)| b * u[p]).sum();
                state.field.pressure[e * modes + m] += self.pressed.block.bulk_modulus / mass * (sum - linear.volumes[e * modes + m]);
            }
        }
        state.field.u.iter_mut().zip(&u).for_each(|(to, u)| *to += u);
        state.approach += approach;
        lap(4);
        Some(next)
    }

    /// Iterations it took.
    fn solve(&self, state: &mut State, load: f64, clocks: &mut [f64; 5]) -> usize {
        for iteration in 0..40 {
            let settled = newton::missed(self.pressed, state, load) < 1e-8;
            if settled {
                return iteration;
            }
            let Some(next) = self.step(state, load, clocks) else { return 98 };
            for a in 0..next.len() {
                if !next[a] {
                    state.force[a] = 0.0;
                }
            }
            state.active = next;
        }
        99
    }
}

fn directs() {
    let settings = Settings::default();
    for order in [1, 2] {
        for columns in sizes() {
            for (amplitude, pressure) in [(0.05, 0.1), (0.1, 0.5), (0.15, 1.0), (0.2, 1.5)] {
                let case = Case { amplitude, pressure, slides: false };
                let (fine, mesh, start, solved, _) = carried(&case, columns, order);
                let model = Model::new(&fine_rubber(&fine), &fine_profile(&case), f64::INFINITY, 1.0);
                let memory = Memory::Relaxed;
                let watch = Watch::endless();
                let pressed = model.pressed(&mesh, &memory, &watch);
                let (by_gmres, gmres_mb, report) = timed(|| {
                    let mut state = start.clone();
                    newton::solve(&pressed, &mut state, case.pressure, &settings)
                });
                let (setup, _, direct) = timed(|| Direct::new(&pressed));
                let mut clocks = [0.0; 5];
                let mut runs = 0;
                let (by_direct, direct_mb, (iterations, state)) = timed(|| {
                    runs += 1;
                    let mut state = start.clone();
                    let count = direct.solve(&mut state, case.pressure, &mut clocks);
                    (count, state)
                });
                let (by_chord, _, chord) = timed(|| {
                    let mut state = start.clone();
                    let mut counts = [0; 2];
                    let done = direct.chord(&mut state, case.pressure, &mut None, &mut counts);
                    (done, counts, (state.approach - solved.approach).abs() / case.amplitude)
                });
                let far = state.force.iter().zip(&solved.force).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / case.pressure * state.force.len() as f64;
                let far = far.max((state.approach - solved.approach).abs() / case.amplitude);
                println!("    chord {by_chord:.2} ms {chord:?}, gmres/chord with setup {:.2}", by_gmres / (by_chord + setup));
                println!(
                    "order {order} {}x{} A {amplitude} p {pressure} touch {}: gmres {by_gmres:.2} ms, {} newton, {} products, {:.2}/step {gmres_mb:.1} MB | direct {by_direct:.2} ms + setup {setup:.2}, {iterations} newton, {:.2}/step {direct_mb:.1} MB: lin {:.2} asm {:.2} factor {:.2} solve {:.2} rest {:.2} | gmres/direct {:.2}, with setup {:.2}, a step {:.2} | apart {far:.1e}",
                    mesh.columns, mesh.rows,
                    solved.active.iter().filter(|&&a| a).count(),
                    report.iterations, report.products, by_gmres / report.iterations as f64,
                    by_direct / iterations as f64,
                    1e3 * clocks[0] / (runs * iterations) as f64,
                    1e3 * clocks[1] / (runs * iterations) as f64,
                    1e3 * clocks[2] / (runs * iterations) as f64,
                    1e3 * clocks[3] / (runs * iterations) as f64,
                    1e3 * clocks[4] / (runs * iterations) as f64,
                    by_gmres / by_direct,
                    by_gmres / (by_direct + setup),
                    by_gmres / report.iterations as f64 * iterations as f64 / by_direct,
                );
            }
        }
    }
}

fn main() {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    match wanted.as_str() {
        "fill" => fill(),
        "solve" => solves(),
        "slide" => slide(),
        "direct" => directs(),
        "steps" => steps(),
        _ => fill(),
    }
}

fn sizes() -> Vec<usize> {
    let most: usize = std::env::args().nth(2).and_then(|s| s.parse().ok()).unwrap_or(1024);
    [32, 64, 128, 256, 512, 1024].into_iter().filter(|&n| n <= most).collect()
}

/// A converged coarse solution on half the columns, carried to the mesh.
fn carried(case: &Case, columns: usize, order: usize) -> (Problem, Mesh, State, State, f64) {
    let fine = problem(case, columns, order);
    let solution = steady::solve(&fine, &Settings::default(), None, None, &Watch::endless()).unwrap();
    assert_eq!(solution.finest.report.status, Status::Converged);
    let mesh = Mesh::new(&fine.mesh);
    let unit = solution.stress_unit;
    let (coarse, state) = solution.finest.judged_by.clone().unwrap();
    let start = transfer(&coarse, &state, &mesh, 1.0);
    (fine, mesh, start, solution.finest.state, unit)
}

fn fill() {
    println!("order columns rows unknowns | way: symbolic ms, numeric ms, solve ms, fill M, Gflop, MB");
    for order in [1, 2] {
        for columns in sizes() {
            let case = Case { amplitude: 0.1, pressure: 0.5, slides: false };
            let (fine, mesh, _, state, unit) = carried(&case, columns, order);
            let _ = unit;
            let model = Model::new(&fine_rubber(&fine), &fine_profile(&case), f64::INFINITY, 1.0);
            let memory = Memory::Relaxed;
            let watch = Watch::endless();
            let pressed = model.pressed(&mesh, &memory, &watch);
            let linear = linearise(&pressed, &state);
            println!(
                "order {order} {}x{} unknowns {} touching {}",
                mesh.columns,
                mesh.rows,
                2 * mesh.layer_nodes() * (mesh.layers() - 1),
                state.active.iter().filter(|&&a| a).count()
            );
            for name in ["llt nd", "ldlt nd", "lblt nd", "ldlt amd", "ldlt simplicial amd", "lu nd", "lu colamd", "lu simplicial colamd"] {
                if name.contains("simplicial") && columns > 256 {
                    continue;
                }
                let numbering = if name.contains("nd") { dissection(&mesh) } else { natural(&mesh) };
                let llt = !name.contains("lu");
                let (structure, _, pattern) = timed(|| {
                    let numbering = Numbering { of: numbering.of.clone(), count: numbering.count };
                    Pattern::new(&pressed.block, numbering, llt)
                });
                let mut cost = (f64::NAN, f64::NAN);
                let (symbolic, _, way) = timed(|| match name {
                    "llt nd" => Way::Cholesky(Cholesky::new(&pattern, Kind::Llt, false, false)),
                    "ldlt nd" => Way::Cholesky(Cholesky::new(&pattern, Kind::Ldlt, false, false)),
                    "lblt nd" => Way::Cholesky(Cholesky::new(&pattern, Kind::Lblt, false, false)),
                    "ldlt amd" => Way::Cholesky(Cholesky::new(&pattern, Kind::Ldlt, true, false)),
                    "ldlt simplicial amd" => Way::Cholesky(Cholesky::new(&pattern, Kind::Ldlt, true, true)),
                    "lu nd" => {
                        let (way, bound) = Lu::given(&pattern);
                        cost = (bound, f64::NAN);
                        Way::Lu(way)
                    }
                    "lu colamd" => Way::Lu(Lu::colamd(&pattern, false)),
                    _ => Way::Lu(Lu::colamd(&pattern, true)),
                });
                if let Way::Cholesky(one) = &way {
                    cost = one.cost();
                }
                let (assembly, _, assembled) = timed(|| {
                    assemble(&pattern, &pressed.block, &state, &linear.rows, &linear.bend)
                });
                let (numeric, megabytes, factor) =
                    timed(|| way.factor(&pattern, &assembled.values));
                let Some(factor) = factor else {
                    println!("   {name}: no factor");
                    continue;
                };
                let right = Mat::from_fn(pattern.count, 1, |i, _| ((i * 7919) % 1000) as f64 * 1e-3);
                let (solve, _, x) = timed(|| {
                    let mut x = right.clone();
                    factor.solve(x.as_mut());
                    x
                });
                let many = Mat::from_fn(pattern.count, 32, |i, j| (((i + j) * 7919) % 1000) as f64 * 1e-3);
                let (block_solve, _, _) = timed(|| {
                    let mut x = many.clone();
                    factor.solve(x.as_mut());
                });
                let error = left(&pattern, &assembled.values, &x, &right, llt);
                println!(
                    "   {name:22} structure {structure:8.2} symbolic {symbolic:8.2} assembly {assembly:8.2} numeric {numeric:8.2} solve {solve:7.3} solve32/32 {:7.3} fill {:.3} M gflop {:.4} ({:.1} GF/s) MB {megabytes:.1} left {error:.1e}",
                    block_solve / 32.0,
                    cost.0 * 1e-6,
                    cost.1 * 1e-9,
                    cost.1 * 1e-6 / numeric,
                );
            }
        }
    }
}

fn left(p: &Pattern, values: &[f64], x: &Mat<f64>, right: &Mat<f64>, lower: bool) -> f64 {
    let mut out = right.clone();
    for j in 0..p.count {
        for at in p.pointer[j]..p.pointer[j + 1] {
            out[(p.rows[at], 0)] -= values[at] * x[(j, 0)];
            if lower && p.rows[at] != j {
                out[(j, 0)] -= values[at] * x[(p.rows[at], 0)];
            }
        }
    }
    out.norm_max() / (right.norm_max() + x.norm_max())
}

fn fine_rubber(_: &Problem) -> Rubber {
    Rubber::new(Energy::new("neo_hookean", &Default::default()).unwrap(), 1.0, vec![], vec![], 1000.0)
        .unwrap()
}
fn fine_profile(case: &Case) -> Profile {
    Profile::new(1.0, Heights::sine(case.amplitude).unwrap()).unwrap()
}

fn solves() {
    let settings = Settings::default();
    for order in [1, 2] {
        for columns in sizes() {
            for (amplitude, pressure) in [(0.05, 0.1), (0.1, 0.5), (0.2, 1.5)] {
                let case = Case { amplitude, pressure, slides: false };
                let (fine, mesh, start, solved, _) = carried(&case, columns, order);
                let (whole, whole_mb, _) = timed(|| {
                    steady::solve(&fine, &settings, None, None, &Watch::endless()).unwrap()
                });
                let model = Model::new(&fine_rubber(&fine), &fine_profile(&case), f64::INFINITY, 1.0);
                let memory = Memory::Relaxed;
                let watch = Watch::endless();
                let pressed = model.pressed(&mesh, &memory, &watch);
                let (one_step, _, _) = timed(|| {
                    let rows = pressed.row_states(&start.field).unwrap();
                    let accuracy = Accuracy { share: 1e-3, least: 1e-9 };
                    krylov::increment(&pressed, &start, &rows, case.pressure, accuracy, &settings).unwrap().products
                });
                let (by_gmres, gmres_mb, report) = timed(|| {
                    let mut state = start.clone();
                    newton::solve(&pressed, &mut state, case.pressure, &settings)
                });
                let numbering = dissection(&mesh);
                let pattern = Pattern::new(&pressed.block, numbering, true);
                let way = Way::Cholesky(Cholesky::new(&pattern, Kind::Ldlt, false, false));
                let mut iterations = 0;
                let mut parts = Parts::default();
                let (by_sparse, sparse_mb, state) = timed(|| {
                    let mut state = start.clone();
                    iterations = 0;
                    parts = Parts::default();
                    while newton::missed(&pressed, &state, case.pressure) > 1e-8 && iterations < 30 {
                        iterations += 1;
                        if sparse_step(&pressed, &mut state, case.pressure, &pattern, &way, &settings, &mut parts).is_none() {
                            iterations = 99;
                            break;
                        }
                    }
                    state
                });
                let far = state.force.iter().zip(&solved.force).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / case.pressure * state.force.len() as f64;
                let far = far.max((state.approach - solved.approach).abs() / case.amplitude);
                let ms = |s: f64| 1e3 * s / iterations as f64;
                println!(
                    "order {order} {}x{} A {amplitude} p {pressure} touch {}: first step gmres {one_step:.2} ms, whole {whole:.1} ms {whole_mb:.1} MB | fine gmres {by_gmres:.2} ms, {} newton, {} products, {:.2}/step, {gmres_mb:.1} MB | sparse {by_sparse:.2} ms, {iterations} newton, {:.2}/step (factor {:.2} surface {:.2} [{} nodes] contact {:.2} rest {:.2}), {sparse_mb:.1} MB | ratio {:.2} floor {:.2} | apart {far:.1e}",
                    mesh.columns, mesh.rows,
                    solved.active.iter().filter(|&&a| a).count(),
                    report.iterations, report.products, by_gmres / report.iterations as f64,
                    by_sparse / iterations as f64,
                    ms(parts.factor), ms(parts.surface), parts.nodes, ms(parts.contact), ms(parts.rest),
                    by_sparse / by_gmres,
                    (by_sparse - 1e3 * parts.surface - 1e3 * parts.contact) / by_gmres,
                );
            }
        }
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// `[row][column][mode]` of `[row][mode][column]`, or back.
fn turned(mesh: &Mesh, p: &[f64], by_mode: bool) -> Vec<f64> {
    let (modes, columns) = (mesh.modes(), mesh.columns);
    let mut out = vec![0.0; p.len()];
    for row in 0..mesh.rows {
        for m in 0..modes {
            for c in 0..columns {
                let (a, b) = ((row * modes + m) * columns + c, (row * columns + c) * modes + m);
                if by_mode {
                    out[b] = p[a];
                } else {
                    out[a] = p[b];
                }
            }
        }
    }
    out
}

/// Steady sliding: the first Newton step on a mesh, preconditioned by the average and by a factor.
fn slide() {
    let settings = Settings::default();
    for order in [1, 2] {
        for columns in sizes() {
            for (amplitude, pressure) in [(0.05, 0.5), (0.1, 2.0), (0.16, 5.0)] {
                let case = Case { amplitude, pressure, slides: true };
                let (fine, mesh, start, _, unit) = carried(&case, columns, order);
                let model = Model::new(&fine.rubber, &fine_profile(&case), 1.0, std::f64::consts::TAU);
                let load = pressure / unit;
                let history = SlidingHistory::new(mesh.columns, &model.maxwell, 5.0);
                let own_weight = history.stress[0];
                let memory = Memory::Sliding(history);
                let watch = Watch::endless();
                let pressed = model.pressed(&mesh, &memory, &watch);
                let mut increment = None;
                let (by_average, _, _) = timed(|| {
                    let rows = pressed.row_states(&start.field).unwrap();
                    let accuracy = Accuracy { share: 1e-3, least: 1e-12 };
                    increment = Some(krylov::increment(&pressed, &start, &rows, load, accuracy, &settings).unwrap());
                });
                let increment = increment.unwrap();
                print!("order {order} {}x{} A {amplitude} p {pressure}: average {by_average:.2} ms, {} products |", mesh.columns, mesh.rows, increment.products);
                let pattern = Pattern::new(&pressed.block, dissection(&mesh), true);
                let way = Way::Cholesky(Cholesky::new(&pattern, Kind::Ldlt, false, false));
                let set: Vec<usize> = (0..start.active.len()).filter(|&a| increment.contact.active[a]).collect();
                for instantaneous in [false, true] {
                    let mut parts = [0.0; 3];
                    let (ms, mb, products) = timed(|| {
                        let mark = cpu();
                        let mut linear = linearise(&pressed, &start);
                        let jacobian = Jacobian::new(&pressed.block, &start.field, &linear.rows, &watch).unwrap();
                        if instantaneous {
                            for row in &mut linear.rows {
                                let past = row.remembered();
                                for (h, y) in row.h.iter_mut().flatten().zip(past.iter().flatten()) {
                                    (0..4).for_each(|k| h[k] -= own_weight * y[k]);
                                }
                            }
                        }
                        let tangent = Tangent::new(&pressed, &start, &linear, &pattern, &way).unwrap();
                        parts[0] = cpu() - mark;
                        let mark = cpu();
                        let compliance = tangent.compliance(&set, &linear.slope);
                        parts[1] = cpu() - mark;
                        let mark = cpu();
                        let n = set.len();
                        let border = compliance.0[0][0].abs();
                        let matrix = Matrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
                            (true, true) => compliance.0[j][i],
                            (true, false) => -border,
                            (false, true) => border,
                            _ => 0.0,
                        });
                        let held = gripscale_kernel::linear::Factor::new(matrix.as_ref(), &watch).unwrap();
                        let free = jacobian.displacements();
                        let mut room = jacobian.room();
                        // M^-1 with gaps `target` on the set and forces that sum to `total`.
                        let corrected = |v: &[f64], target: &[f64], total: f64| {
                            let mut forces = v[..free].to_vec();
                            forces.resize(start.field.u.len(), 0.0);
                            let volumes = turned(&mesh, &v[free..], true);
                            let mut right = tangent.condensed(&forces, &volumes);
                            let opening = tangent.opening(&tangent.displaced(&right), &linear.slope);
                            let mut border_right: Vec<f64> = set.iter().enumerate().map(|(k, &a)| target[k] - opening[a]).collect();
                            border_right.push(border * total);
                            let mut solution = Mat::from_fn(n + 1, 1, |i, _| border_right[i]);
                            held.solve(&mut solution, &watch).unwrap();
                            let mut force = vec![0.0; start.force.len()];
                            for (k, &a) in set.iter().enumerate() {
                                force[a] = solution[(k, 0)];
                                right[mesh.place(a, 0)] -= linear.slope[a] * force[a];
                                right[mesh.place(a, 1)] += force[a];
                            }
                            let u = tangent.displaced(&right);
                            let p = tangent.pressures(&u, &volumes);
                            let mut y = u[..free].to_vec();
                            y.extend(turned(&mesh, &p, false));
                            (y, force)
                        };
                        let mut product = |y: &[f64], force: &[f64], out: &mut [f64]| {
                            jacobian.product(y, out, &mut room);
                            let shift = mesh.mean_shift(y);
                            for (a, bend) in linear.bend.iter().enumerate() {
                                let (x, z) = (mesh.place(a, 0), mesh.place(a, 1));
                                out[x] += bend * (y[x] - shift) + linear.slope[a] * force[a];
                                out[z] -= force[a];
                            }
                        };
                        let mut right = linear.right[..free].to_vec();
                        right.extend(turned(&mesh, &linear.volumes, false));
                        // Forces of nodes that no longer touch are taken away.
                        let mut gone = vec![0.0; start.force.len()];
                        for a in 0..gone.len() {
                            if !increment.contact.active[a] {
                                gone[a] = -start.force[a];
                            }
                        }
                        let total: f64 = load - start.force.iter().sum::<f64>() - gone.iter().sum::<f64>();
                        for (a, f) in gone.iter().enumerate() {
                            right[mesh.place(a, 0)] -= linear.slope[a] * f;
                            right[mesh.place(a, 1)] += f;
                        }
                        let target: Vec<f64> = set.iter().map(|&a| -linear.gap[a]).collect();
                        let (y, force) = corrected(&right, &target, total);
                        let mut left = vec![0.0; right.len()];
                        product(&y, &force, &mut left);
                        left.iter_mut().zip(&right).for_each(|(left, r)| *left = r - *left);
                        let goal = 1e-3 * norm(&right).max(norm(&left));
                        let nothing = vec![0.0; n];
                        let apply = |v: &[f64], out: &mut [f64]| {
                            let (y, force) = corrected(v, &nothing, 0.0);
                            product(&y, &force, out);
                        };
                        let found = gmres(apply, &left, goal, (100, 400), &watch).unwrap();
                        parts[2] = cpu() - mark;
                        found.iterations
                    });
                    print!(" {} {ms:.2} ms (factor {:.2} surface {:.2} iteration {:.2}), {products} products, {mb:.0} MB |", if instantaneous { "instantaneous" } else { "fixed memory" }, 1e3 * parts[0], 1e3 * parts[1], 1e3 * parts[2]);
                }
                println!();
            }
        }
    }
}

/// Sliding in time from static contact: a step by each.
fn steps() {
    use gripscale_kernel::material::carried_history::{CarriedHistory, Points};
    let settings = Settings::default();
    for order in [1, 2] {
        for columns in sizes() {
            for (amplitude, pressure) in [(0.05, 0.3), (0.1, 0.8), (0.16, 2.0)] {
                let relaxed = Case { amplitude, pressure: 0.5 * pressure, slides: false };
                let (_, mesh, _, solved, _) = carried(&relaxed, columns, order);
                let rubber = problem(&Case { amplitude, pressure, slides: true }, columns, order).rubber;
                let model = Model::new(&rubber, &fine_profile(&relaxed), 1.0, std::f64::consts::TAU);
                let unit = model.stress_unit;
                let load = relaxed.pressure / unit;
                let watch = Watch::endless();
                let nothing = Memory::Relaxed;
                let remembered = |pressed: &PressedBlock<'_>, state: &State| -> Points {
                    pressed.row_states(&state.field).unwrap().iter().map(|row| row.remembered()).collect()
                };
                let first = solved.restressed(1.0 / unit);
                let y = remembered(&model.pressed(&mesh, &nothing, &watch), &first);
                let dt = 1.0 / mesh.columns as f64;
                let passages: f64 = std::env::args().nth(3).and_then(|s| s.parse().ok()).unwrap_or(0.125);
                let count = (passages * mesh.columns as f64).ceil() as usize;
                let mut lines = Vec::new();
                let mut ends = Vec::new();
                for way in ["gmres", "direct", "chord", "kept"] {
                    let mut kept_average = None;
                    let mut best = f64::INFINITY;
                    let mut line = String::new();
                    for _ in 0..1 {
                        let mut networks = CarriedHistory::relaxed(y.clone(), mesh.columns, &model.maxwell);
                        let mut state = first.clone();
                        let (mut spent, mut newtons, mut products, mut factors) = (0.0, 0, 0, 0);
                        let mut kept = None;
                        let mut failed = false;
                        let template = Memory::Relaxed;
                        let pressed = model.pressed(&mesh, &template, &watch);
                        let shell = Direct::new(&pressed);
                        let begin = cpu();
                        let mut shell = Some((shell.pattern, shell.way, shell.places));
                        for _ in 0..count {
                            networks.carry(true);
                            let memory: &'static Memory = Box::leak(Box::new(Memory::Given(networks.known_part(&model.maxwell, dt))));
                            let pressed = model.pressed(&mesh, memory, &watch);
                            let (pattern, symbolic, places) = shell.take().unwrap();
                            let direct = Direct { pattern, way: symbolic, places, pressed: &pressed, columns_of: Vec::new() };
                            let mark = cpu();
                            match way {
                                "gmres" => {
                                    let report = newton::solve(&pressed, &mut state, load, &settings);
                                    newtons += report.iterations;
                                    products += report.products;
                                    failed |= report.status != Status::Converged;
                                }
                                "direct" => {
                                    let mut clocks = [0.0; 5];
                                    let count = direct.solve(&mut state, load, &mut clocks);
                                    failed |= count > 90;
                                    newtons += count;
                                    factors += count;
                                }
                                "kept" => {
                                    let mut before = f64::INFINITY;
                                    let share: f64 = std::env::args().nth(4).and_then(|s| s.parse().ok()).unwrap_or(0.05);
                                    for i in 0.. {
                                        let rows = pressed.row_states(&state.field).unwrap();
                                        let linear = linearise(&pressed, &state);
                                        let residual = direct.judged(&linear, &state, load);
                                        if residual < 1e-8 { break; }
                                        if i == 40 { failed = true; break; }
                                        if kept_average.is_none() || residual > 0.25 * before {
                                            let jacobian = Jacobian::new(&pressed.block, &state.field, &rows, &watch).unwrap();
                                            let uniform = gripscale_kernel::fem::uniform::Uniform::new(&jacobian, &watch).unwrap();
                                            kept_average = Some((jacobian, uniform));
                                            factors += 1;
                                        }
                                        before = residual;
                                        newtons += 1;
                                        let (jacobian, uniform) = kept_average.as_ref().unwrap();
                                        let accuracy = Accuracy { share, least: 1e-9 * load.min(1.0) };
                                        let by = krylov::increment_by(jacobian, uniform, &pressed, &state, &rows, load, accuracy, &settings).unwrap();
                                        products += by.products;
                                        state.field.u.iter_mut().zip(&by.u).for_each(|(to, u)| *to += u);
                                        state.field.pressure.iter_mut().zip(&by.pressure).for_each(|(to, p)| *to += p);
                                        state.force = by.contact.force;
                                        state.active = by.contact.active;
                                        state.approach = by.contact.approach;
                                    }
                                }
                                _ => {
                                    let mut counts = [0; 2];
                                    failed |= !direct.chord(&mut state, load, &mut kept, &mut counts);
                                    newtons += counts[1];
                                    factors += counts[0];
                                }
                            }
                            spent += cpu() - mark;
                            shell = Some((direct.pattern, direct.way, direct.places));
                            networks.advance(remembered(&pressed, &state), &model.maxwell, dt);
                            let relaxed = model.pressed(&mesh, &nothing, &watch);
                            gripscale_kernel::outcome::Outcome::of(&relaxed, &state, model.edge_law(&mesh, 1.0)).unwrap();
                        }
                        let whole = cpu() - begin;
                        let each = |n: usize| n as f64 / count as f64;
                        if spent < best {
                            best = spent;
                            line = format!("{way} {:.2} ms a step, {:.2} whole ({:.1} iterations, {:.1} products, {:.1} factors{})", 1e3 * spent / count as f64, 1e3 * whole / count as f64, each(newtons), each(products), each(factors), if failed { ", FAILED" } else { "" });
                        }
                        ends.push(state.approach);
                    }
                    lines.push((line, best));
                }
                let apart = ends.iter().map(|e| (e - ends[0]).abs()).fold(0.0, f64::max) / amplitude;
                println!("order {order} {}x{} A {amplitude} p {:.2}: {} | {} | {} | {} | gmres/direct {:.2} gmres/chord {:.2} gmres/kept {:.2} apart {apart:.1e}", mesh.columns, mesh.rows, relaxed.pressure, lines[0].0, lines[1].0, lines[2].0, lines[3].0, lines[0].1 / lines[1].1, lines[0].1 / lines[2].1, lines[0].1 / lines[3].1);
            }
        }
    }
}
