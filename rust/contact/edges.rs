//! The contact's edges, located between the surface nodes by the shape of pressure and gap.

/// How the modulus grows with frequency at the scale of the mesh, |E*| ~ w^power, and which way the
/// rubber moves: both decide the shape of pressure and gap at the contact edges.
#[derive(Debug, Clone, Copy)]
pub struct EdgeLaw {
    /// 0 is elastic.
    pub power: f64,
    pub forward: bool,
}

impl EdgeLaw {
    /// From storage and loss modulus: a power law of exponent a has loss angle a pi / 2.
    pub fn new(storage: f64, loss: f64, forward: bool) -> Self {
        Self { power: loss.atan2(storage) / std::f64::consts::FRAC_PI_2, forward }
    }

    /// Exponents of pressure inside and gap outside at the edge on the side `outward` of x, and the
    /// weight of the pressure's estimate of the place of the edge.
    ///
    /// The stiffness |k| (i k)^a factors into k^(1/2) on one side and k^(1/2 + a) on the other:
    /// where the rubber enters p ~ s^(1/2 - a), gap ~ s^(3/2); where it leaves p ~ s^(1/2),
    /// gap ~ s^(3/2 + a). For a = 0 both are Hertz's. The pressure of a lossy rubber rises too
    /// steeply at the entering edge for the nodes to resolve, so its weight falls to zero there.
    fn exponents(&self, outward: isize) -> (f64, f64, f64) {
        if (outward < 0) == self.forward {
            let weight = 0.5 * (1.0 - 4.0 * self.power).max(0.0);
            ((0.5 - self.power).max(0.1), 1.5, weight)
        } else {
            (0.5, 1.5 + self.power, 0.5)
        }
    }
}

/// Contact intervals from runs of nodes in the active set, with their edges located between the nodes.
pub fn contacts(
    x: &[f64],
    pressure: &[f64],
    gap: &[f64],
    active_set: &[bool],
    law: EdgeLaw,
) -> Vec<(f64, f64)> {
    let n = x.len();
    if active_set.iter().all(|&a| a) {
        return vec![(x[0], x[0] + 1.0)];
    }
    let mut out = Vec::new();
    for a in 0..n {
        if active_set[a] && !active_set[(a + n - 1) % n] {
            let mut length = 1;
            while active_set[(a + length) % n] {
                length += 1;
            }
            let at = |i: isize| {
                let index = a as isize + i;
                let node = index.rem_euclid(n as isize);
                (x[node as usize] + index.div_euclid(n as isize) as f64, node as usize)
            };
            let open = |from: isize, outward: isize| {
                (0..n as isize).take_while(|i| !active_set[at(from + i * outward).1]).count()
            };
            let last = length as isize - 1;
            let end = |last: isize, outward: isize| Edge {
                last,
                outward,
                closed: length,
                open: open(last + outward, outward),
                exponents: law.exponents(outward),
            };
            let from = end(0, -1).locate(at, pressure, gap);
            let to = end(last, 1).locate(at, pressure, gap);
            out.push((from, to));
        }
    }
    out
}

/// One contact edge between the last closed node and the first open one.
struct Edge {
    last: isize,
    outward: isize,
    /// Consecutive closed nodes inside and open nodes outside.
    closed: usize,
    open: usize,
    exponents: (f64, f64, f64),
}

impl Edge {
    /// Where pressure inside and gap outside, raised to be linear in the distance, vanish.
    ///
    /// The errors of the two estimates have opposite signs; their mean is right to about a tenth of the node
    /// spacing. With too few nodes on one side only the other estimate is used.
    fn locate(&self, at: impl Fn(isize) -> (f64, usize), pressure: &[f64], gap: &[f64]) -> f64 {
        let (x0, inside) = at(self.last);
        let (x1, outside) = at(self.last + self.outward);
        let (inner, outer) = (1.0 / self.exponents.0, 1.0 / self.exponents.1);
        let margin = 0.5 * (x1 - x0).abs();
        let within = |x: f64| x.clamp(x0.min(x1) - margin, x0.max(x1) + margin);
        let from_pressure = (self.closed > 1).then(|| {
            let (x_in, second) = at(self.last - self.outward);
            let (near, far) = (pressure[inside].powf(inner), pressure[second].powf(inner));
            (far > near).then(|| within(x0 + (x0 - x_in) * near / (far - near)))
        });
        let from_gap = (self.open > 1).then(|| {
            let (x2, further) = at(self.last + 2 * self.outward);
            let near = gap[outside].max(0.0).powf(outer);
            let far = gap[further].max(0.0).powf(outer);
            (far > near).then(|| within(x1 - (x2 - x1) * near / (far - near)))
        });
        match (from_pressure.flatten(), from_gap.flatten()) {
            (Some(a), Some(b)) => self.exponents.2 * a + (1.0 - self.exponents.2) * b,
            (Some(a), None) => a,
            (None, Some(b)) => b,
            (None, None) => 0.5 * (x0 + x1),
        }
    }
}
