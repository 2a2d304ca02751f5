//! The stress at one point: permanent network, temporary networks, volumetric pressure.
//!
//! S = J^(-2/3) DEV[H] + p J C^-1,  H = G(t) I + history of Y,  Y = Cbar^-1 = J^(2/3) C^-1
//! (Lubliner, Mech. Res. Commun. 12 (1985) 93, with neo-Hookean springs; plane strain).
//! H is the sum of the permanent network G_inf I and of the temporary networks G_i A_i; anything
//! proportional to the local Y may be added to it, because DEV removes it.

use super::kinematics::{cofactor, contract, right_cauchy_green, Deformation, Gradient, Symmetric};

/// First Piola-Kirchhoff stress P(F; H, p).
pub fn stress(deformation: impl Into<Deformation>, h: &Symmetric, pressure: f64) -> Gradient {
    let Deformation { f, j, scale } = deformation.into();
    let cof = cofactor(&f);
    let trace = contract(h, &right_cauchy_green(&f)) / (3.0 * j);
    let fh = forward(&f, h);
    let mut p = [0.0; 4];
    for k in 0..4 {
        p[k] = scale * (fh[k] - trace * cof[k]) + pressure * cof[k];
    }
    p
}

/// dP/dF at fixed H and pressure, `[component of P][component of F]`.
pub fn tangent(deformation: impl Into<Deformation>, h: &Symmetric, pressure: f64) -> [Gradient; 4] {
    let Deformation { f, j, scale } = deformation.into();
    let g = cofactor(&f).map(|value| value / j);
    let trace = contract(h, &right_cauchy_green(&f)) / 3.0;
    let fh = forward(&f, h);
    let mut d = [[0.0; 4]; 4];
    for a in 0..4 {
        let isochoric = scale * (fh[a] - trace * g[a]);
        for b in 0..4 {
            let (row_a, col_a, row_b, col_b) = (a / 2, a % 2, b / 2, b % 2);
            // dg_iJ/dF_kL = -g_kJ g_iL
            let slope_g = -g[2 * row_b + col_a] * g[2 * row_a + col_b];
            let slope_fh = if row_a == row_b { component(h, col_b, col_a) } else { 0.0 };
            d[a][b] = -2.0 / 3.0 * g[b] * isochoric
                + scale * (slope_fh - 2.0 / 3.0 * fh[b] * g[a] - trace * slope_g);
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
pub fn memory_slope(deformation: impl Into<Deformation>) -> [Symmetric; 4] {
    let Deformation { f, j, scale } = deformation.into();
    let g = cofactor(&f).map(|value| value / j);
    let c = right_cauchy_green(&f);
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
            slope[a][k] = scale * (direct[a][k] - traced[k] * g[a]);
        }
    }
    slope
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
