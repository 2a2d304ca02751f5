//! The material at one point: neo-Hookean network, temporary networks, volumetric pressure.
//!
//! S = J^(-2/3) DEV[H] + p J C^-1,  H = G(t) I + history of Y,  Y = Cbar^-1 = J^(2/3) C^-1
//! (Lubliner, Mech. Res. Commun. 12 (1985) 93, with neo-Hookean springs; plane strain).
//! H is the sum of the permanent network G_inf I and of the temporary networks G_i A_i; anything
//! proportional to the local Y may be added to it, because DEV removes it.
//!
//! Tensors are flat: F, P = [11, 12, 21, 22]; H, Y = [11, 22, 12, 33] (symmetric, 12 once).

pub type Gradient = [f64; 4];
pub type Symmetric = [f64; 4];

/// The symmetric unit tensor.
pub const UNIT: Symmetric = [1.0, 1.0, 0.0, 1.0];

/// det F in plane strain.
pub fn jacobian(f: &Gradient) -> f64 {
    f[0] * f[3] - f[1] * f[2]
}

/// dJ/dF.
pub fn cofactor(f: &Gradient) -> Gradient {
    [f[3], -f[2], -f[1], f[0]]
}

/// C = F^T F, with C33 = 1.
pub fn right_cauchy_green(f: &Gradient) -> Symmetric {
    [
        f[0] * f[0] + f[2] * f[2],
        f[1] * f[1] + f[3] * f[3],
        f[0] * f[1] + f[2] * f[3],
        1.0,
    ]
}

/// H : C of two symmetric tensors.
pub fn contract(a: &Symmetric, b: &Symmetric) -> f64 {
    a[0] * b[0] + a[1] * b[1] + 2.0 * a[2] * b[2] + a[3] * b[3]
}

/// Isochoric Cbar = J^(-2/3) C.
pub fn isochoric(f: &Gradient) -> Symmetric {
    let factor = jacobian(f).powf(-2.0 / 3.0);
    right_cauchy_green(f).map(|c| factor * c)
}

/// Y = Cbar^-1, the state that the temporary networks remember.
pub fn remembered(f: &Gradient) -> Symmetric {
    let j = jacobian(f);
    let c = right_cauchy_green(f);
    let factor = j.powf(-4.0 / 3.0);
    [
        factor * c[1],
        factor * c[0],
        -factor * c[2],
        j.powf(2.0 / 3.0),
    ]
}

/// dY/dF, `[component of Y][component of F]`.
pub fn remembered_slope(f: &Gradient) -> [Gradient; 4] {
    let j = jacobian(f);
    let factor = j.powf(-4.0 / 3.0);
    let g = cofactor(f).map(|value| value / j);
    let y = remembered(f);
    let c22 = [0.0, 2.0 * f[1], 0.0, 2.0 * f[3]];
    let c11 = [2.0 * f[0], 0.0, 2.0 * f[2], 0.0];
    let c12 = [f[1], f[0], f[3], f[2]];
    let mut slope = [[0.0; 4]; 4];
    for k in 0..4 {
        slope[0][k] = factor * c22[k] - 4.0 / 3.0 * g[k] * y[0];
        slope[1][k] = factor * c11[k] - 4.0 / 3.0 * g[k] * y[1];
        slope[2][k] = -factor * c12[k] - 4.0 / 3.0 * g[k] * y[2];
        slope[3][k] = 2.0 / 3.0 * g[k] * y[3];
    }
    slope
}

/// First Piola-Kirchhoff stress P(F; H, p).
pub fn stress(f: &Gradient, h: &Symmetric, pressure: f64) -> Gradient {
    let j = jacobian(f);
    let factor = j.powf(-2.0 / 3.0);
    let cof = cofactor(f);
    let trace = contract(h, &right_cauchy_green(f)) / (3.0 * j);
    let fh = forward(f, h);
    let mut p = [0.0; 4];
    for k in 0..4 {
        p[k] = factor * (fh[k] - trace * cof[k]) + pressure * cof[k];
    }
    p
}

/// dP/dF at fixed H and pressure, `[component of P][component of F]`.
pub fn tangent(f: &Gradient, h: &Symmetric, pressure: f64) -> [Gradient; 4] {
    let j = jacobian(f);
    let factor = j.powf(-2.0 / 3.0);
    let g = cofactor(f).map(|value| value / j);
    let trace = contract(h, &right_cauchy_green(f)) / 3.0;
    let fh = forward(f, h);
    let mut d = [[0.0; 4]; 4];
    for a in 0..4 {
        let isochoric = factor * (fh[a] - trace * g[a]);
        for b in 0..4 {
            let (row_a, col_a, row_b, col_b) = (a / 2, a % 2, b / 2, b % 2);
            // dg_iJ/dF_kL = -g_kJ g_iL
            let slope_g = -g[2 * row_b + col_a] * g[2 * row_a + col_b];
            let slope_fh = if row_a == row_b {
                component(h, col_b, col_a)
            } else {
                0.0
            };
            d[a][b] = -2.0 / 3.0 * g[b] * isochoric
                + factor * (slope_fh - 2.0 / 3.0 * fh[b] * g[a] - trace * slope_g);
        }
    }
    // d(cof F)/dF
    d[0][3] += pressure;
    d[1][2] -= pressure;
    d[2][1] -= pressure;
    d[3][0] += pressure;
    d
}

/// dP/dH, `[component of P][component of H]`; component 12 moves both off-diagonal entries.
pub fn memory_slope(f: &Gradient) -> [Symmetric; 4] {
    let j = jacobian(f);
    let factor = j.powf(-2.0 / 3.0);
    let g = cofactor(f).map(|value| value / j);
    let c = right_cauchy_green(f);
    let direct = [
        [f[0], 0.0, f[1], 0.0],
        [0.0, f[1], f[0], 0.0],
        [f[2], 0.0, f[3], 0.0],
        [0.0, f[3], f[2], 0.0],
    ];
    let traced = [c[0] / 3.0, c[1] / 3.0, 2.0 * c[2] / 3.0, 1.0 / 3.0];
    let mut slope = [[0.0; 4]; 4];
    for a in 0..4 {
        for k in 0..4 {
            slope[a][k] = factor * (direct[a][k] - traced[k] * g[a]);
        }
    }
    slope
}

/// Smallest and largest in-plane principal stretch.
pub fn principal_stretches(f: &Gradient) -> (f64, f64) {
    let c = right_cauchy_green(f);
    let mean = 0.5 * (c[0] + c[1]);
    let radius = (0.25 * (c[0] - c[1]).powi(2) + c[2] * c[2]).sqrt();
    ((mean - radius).max(0.0).sqrt(), (mean + radius).sqrt())
}

fn component(h: &Symmetric, row: usize, column: usize) -> f64 {
    match (row, column) {
        (0, 0) => h[0],
        (1, 1) => h[1],
        _ => h[2],
    }
}

fn forward(f: &Gradient, h: &Symmetric) -> Gradient {
    [
        f[0] * h[0] + f[1] * h[2],
        f[0] * h[2] + f[1] * h[1],
        f[2] * h[0] + f[3] * h[2],
        f[2] * h[2] + f[3] * h[1],
    ]
}
