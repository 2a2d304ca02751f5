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
use gripscale_kernel::fem::uniform::Uniform;
use gripscale_kernel::linear::{gmres, solve_dense, Matrix};
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

fn main() {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    match wanted.as_str() {
        "fill" => fill(),
        "solve" => solves(),
        "slide" => slide(),
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

fn slide() {}
