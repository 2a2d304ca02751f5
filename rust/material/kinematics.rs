//! Deformation at one point in plane strain: F, J, C, its isochoric part, and Y = Cbar^-1.
//!
//! Tensors are flat: F, P = [11, 12, 21, 22]; C, H, Y = [11, 22, 12, 33] (symmetric, 12 once).

pub type Gradient = [f64; 4];
pub type Symmetric = [f64; 4];

/// The symmetric unit tensor.
pub const UNIT: Symmetric = [1.0, 1.0, 0.0, 1.0];

/// F with J and J^(-2/3). They are computed once, because the power costs as much as all the rest.
#[derive(Debug, Clone, Copy)]
pub struct Deformation {
    pub f: Gradient,
    pub j: f64,
    /// J^(-2/3).
    pub scale: f64,
}

impl From<&Gradient> for Deformation {
    fn from(f: &Gradient) -> Self {
        let j = jacobian(f);
        Self { f: *f, j, scale: j.powf(-2.0 / 3.0) }
    }
}

impl From<&Deformation> for Deformation {
    fn from(deformation: &Deformation) -> Self {
        *deformation
    }
}

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
    [f[0] * f[0] + f[2] * f[2], f[1] * f[1] + f[3] * f[3], f[0] * f[1] + f[2] * f[3], 1.0]
}

/// H : C of two symmetric tensors.
pub fn contract(a: &Symmetric, b: &Symmetric) -> f64 {
    a[0] * b[0] + a[1] * b[1] + 2.0 * a[2] * b[2] + a[3] * b[3]
}

/// Isochoric Cbar = J^(-2/3) C.
pub fn isochoric(deformation: impl Into<Deformation>) -> Symmetric {
    let Deformation { f, scale, .. } = deformation.into();
    right_cauchy_green(&f).map(|c| scale * c)
}

/// dCbar/dF, `[component of Cbar][component of F]`.
pub fn isochoric_slope(deformation: impl Into<Deformation>) -> [Gradient; 4] {
    let deformation = deformation.into();
    let Deformation { f, j, scale } = deformation;
    let g = cofactor(&f).map(|value| value / j);
    let c = isochoric(deformation);
    let direct = [
        [2.0 * f[0], 0.0, 2.0 * f[2], 0.0],
        [0.0, 2.0 * f[1], 0.0, 2.0 * f[3]],
        [f[1], f[0], f[3], f[2]],
        [0.0; 4],
    ];
    let mut slope = [[0.0; 4]; 4];
    for a in 0..4 {
        for k in 0..4 {
            slope[a][k] = scale * direct[a][k] - 2.0 / 3.0 * g[k] * c[a];
        }
    }
    slope
}

/// Y = Cbar^-1, the state that the temporary networks remember.
pub fn remembered(deformation: impl Into<Deformation>) -> Symmetric {
    let Deformation { f, scale, .. } = deformation.into();
    let c = right_cauchy_green(&f);
    let factor = scale * scale;
    [factor * c[1], factor * c[0], -factor * c[2], 1.0 / scale]
}

/// Smallest and largest in-plane principal stretch.
pub fn principal_stretches(f: &Gradient) -> (f64, f64) {
    let c = right_cauchy_green(f);
    let mean = 0.5 * (c[0] + c[1]);
    let radius = (0.25 * (c[0] - c[1]).powi(2) + c[2] * c[2]).sqrt();
    ((mean - radius).max(0.0).sqrt(), (mean + radius).sqrt())
}
