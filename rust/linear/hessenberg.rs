//! The least-squares problem of GMRES: the Hessenberg matrix of a Krylov space, made triangular by rotations
//! column by column (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856).

pub struct Hessenberg {
    /// Columns of the triangular factor.
    columns: Vec<Vec<f64>>,
    /// Cosine and sine of every rotation.
    rotations: Vec<(f64, f64)>,
    /// The right-hand side, rotated; its last entry is the residual.
    rotated: Vec<f64>,
}

impl Hessenberg {
    /// Of a space whose first direction is a residual of this `norm`.
    pub fn new(norm: f64) -> Self {
        Self { columns: Vec::new(), rotations: Vec::new(), rotated: vec![norm] }
    }

    pub fn size(&self) -> usize {
        self.columns.len()
    }

    /// Norm of the smallest residual.
    pub fn residual(&self) -> f64 {
        self.rotated[self.size()].abs()
    }

    /// Add the components of an image along all directions, the new one last. Returns its entry of the
    /// diagonal, the length of what is new in the image of the space.
    pub fn add(&mut self, mut column: Vec<f64>) -> f64 {
        let last = self.size();
        for (i, (cosine, sine)) in self.rotations.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            column[i] = cosine * a + sine * b;
            column[i + 1] = cosine * b - sine * a;
        }
        let radius = column[last].hypot(column[last + 1]);
        let (cosine, sine) = (column[last] / radius, column[last + 1] / radius);
        column[last] = radius;
        self.rotations.push((cosine, sine));
        self.columns.push(column);
        self.rotated.push(-sine * self.rotated[last]);
        self.rotated[last] *= cosine;
        radius
    }

    /// Weights of the directions in the vector of smallest residual.
    pub fn weights(&self) -> Vec<f64> {
        let size = self.size();
        let mut weights = self.rotated[..size].to_vec();
        for i in (0..size).rev() {
            let solved: f64 = (i + 1..size).map(|j| self.columns[j][i] * weights[j]).sum();
            weights[i] = (weights[i] - solved) / self.columns[i][i];
        }
        weights
    }

    /// The smallest residual along the directions: the rotated last unit vector.
    pub fn residual_coordinates(&self) -> Vec<f64> {
        let size = self.size();
        let mut coordinates = vec![0.0; size + 1];
        coordinates[size] = self.rotated[size];
        for (i, (cosine, sine)) in self.rotations.iter().enumerate().rev() {
            let (a, b) = (coordinates[i], coordinates[i + 1]);
            coordinates[i] = cosine * a - sine * b;
            coordinates[i + 1] = sine * a + cosine * b;
        }
        coordinates
    }
}
