//! The problem of one wave in SI units, checked where its parts are made.

use crate::error::{not_negative, positive, KernelError};

pub use crate::contact::profile::Heights;
pub use crate::fem::mesh::MeshSize;
pub use crate::material::energy::{Energy, Parameters};

/// A rubber of shear moduli [Pa] and relaxation times [s]; its small-strain limit is a Prony series.
#[derive(Debug, Clone, PartialEq)]
pub struct Rubber {
    pub(crate) energy: Energy,
    pub(crate) equilibrium_modulus: f64,
    pub(crate) moduli: Vec<f64>,
    pub(crate) relaxation_times: Vec<f64>,
    pub(crate) bulk_modulus: f64,
}

impl Rubber {
    pub fn new(
        energy: Energy,
        equilibrium_modulus: f64,
        moduli: Vec<f64>,
        relaxation_times: Vec<f64>,
        bulk_modulus: f64,
    ) -> Result<Self, KernelError> {
        if moduli.len() != relaxation_times.len() {
            return Err(KernelError::LengthMismatch {
                moduli: moduli.len(),
                times: relaxation_times.len(),
            });
        }
        for (&modulus, &time) in moduli.iter().zip(&relaxation_times) {
            positive("moduli", modulus)?;
            positive("relaxation_times", time)?;
        }
        Ok(Self {
            energy,
            equilibrium_modulus: positive("equilibrium_modulus", equilibrium_modulus)?,
            moduli,
            relaxation_times,
            bulk_modulus: positive("bulk_modulus", bulk_modulus)?,
        })
    }
}

/// One period of a rigid profile: its wavelength and its heights [m].
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    pub(crate) wavelength: f64,
    pub(crate) heights: Heights,
}

impl Profile {
    pub fn new(wavelength: f64, heights: Heights) -> Result<Self, KernelError> {
        let wavelength = positive("wavelength", wavelength)?;
        Ok(Self { wavelength, heights })
    }

    /// Refuse a mesh that does not resolve the smallest wave of the heights.
    pub(crate) fn check_resolved(&self, mesh: &MeshSize) -> Result<(), KernelError> {
        let fewest = self.heights.fewest_nodes().div_ceil(mesh.order);
        if mesh.columns >= fewest {
            return Ok(());
        }
        Err(KernelError::Refused {
            name: "columns".to_owned(),
            expected: format!("at least {fewest} to follow the smallest wave of the heights"),
            value: mesh.columns.to_string(),
        })
    }
}

/// Mean pressure [Pa], sliding speed [m/s] and the time [s] the mean deformation has had to relax.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    pub(crate) pressure: f64,
    /// Zero is static: the relaxed rubber.
    pub(crate) speed: f64,
    pub(crate) load_time: f64,
}

impl Load {
    pub fn new(pressure: f64, speed: f64, load_time: f64) -> Result<Self, KernelError> {
        let endless = " (infinity is allowed)";
        Ok(Self {
            pressure: positive("pressure", pressure)?,
            speed: not_negative("speed", speed, f64::MAX, " and finite")?,
            load_time: not_negative("load_time", load_time, f64::INFINITY, endless)?,
        })
    }
}

/// A rubber pressed on a profile and slid over it steadily.
#[derive(Debug, Clone)]
pub struct Problem {
    pub rubber: Rubber,
    pub profile: Profile,
    pub load: Load,
    pub mesh: MeshSize,
}

impl Problem {
    /// Refuse another rubber or profile than this problem's, naming the difference.
    pub(crate) fn check_same(&self, rubber: &Rubber, profile: &Profile) -> Result<(), KernelError> {
        let (start, here) = (parts(&self.rubber, &self.profile), parts(rubber, profile));
        for ((name, start), (_, here)) in start.into_iter().zip(here) {
            if start != here {
                return Err(KernelError::OtherStart { name, start, here });
            }
        }
        if self.profile.heights == profile.heights {
            return Ok(());
        }
        Err(KernelError::OtherStart {
            name: "profile",
            start: format!("{:?}", self.profile.heights),
            here: format!("{:?}", profile.heights),
        })
    }
}

fn parts(rubber: &Rubber, profile: &Profile) -> [(&'static str, String); 6] {
    [
        ("strain_energy", format!("{:?}", rubber.energy)),
        ("equilibrium_modulus", format!("{:?}", rubber.equilibrium_modulus)),
        ("moduli", format!("{:?}", rubber.moduli)),
        ("relaxation_times", format!("{:?}", rubber.relaxation_times)),
        ("bulk_modulus", format!("{:?}", rubber.bulk_modulus)),
        ("wavelength", format!("{:?}", profile.wavelength)),
    ]
}
