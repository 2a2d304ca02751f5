//! Every input the kernel refuses, with the value and what was expected.

use thiserror::Error;

#[derive(Debug, Clone, PartialEq, Error)]
pub enum KernelError {
    #[error("{name} must be greater than zero and finite; got {value}")]
    NotPositive { name: &'static str, value: f64 },
    #[error("{name} must be a finite number; got {value}")]
    NotFinite { name: &'static str, value: f64 },
    #[error("{name} must be zero or more{allowed}; got {value}")]
    Negative {
        name: &'static str,
        allowed: &'static str,
        value: f64,
    },
    #[error("{name} must be a whole number from {least} to {most}; got {value}")]
    NotWhole {
        name: &'static str,
        least: usize,
        most: usize,
        value: f64,
    },
    #[error("{name} must be from {least:?} to {most:?}; got {value:?}")]
    OutOfRange {
        name: &'static str,
        least: f64,
        most: f64,
        value: f64,
    },
    #[error("{name} must be one of {expected}; got {value:?}")]
    UnknownName {
        name: String,
        expected: String,
        value: String,
    },
    #[error("{owner} must have the parameter {name:?}")]
    MissingParameter {
        owner: &'static str,
        name: &'static str,
    },
    #[error("a stage may slide over at most {longest} wavelengths; got {wavelengths}")]
    TooLong { longest: f64, wavelengths: f64 },
    #[error("moduli and relaxation_times must have the same length; got {moduli} and {times}")]
    LengthMismatch { moduli: usize, times: usize },
    #[error("start must be of the same rubber and profile; its {name} is {start}, not {here}")]
    OtherStart {
        name: &'static str,
        start: String,
        here: String,
    },
    #[error("start must be a solution that converged; its status is {0:?}")]
    UnsolvedStart(&'static str),
    #[error("internal error: {0}; please report it")]
    Internal(&'static str),
}

pub fn positive(name: &'static str, value: f64) -> Result<f64, KernelError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(KernelError::NotPositive { name, value })
    }
}

pub fn finite(name: &'static str, value: f64) -> Result<f64, KernelError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(KernelError::NotFinite { name, value })
    }
}

/// From zero to `most`; `allowed` says in words what that means.
pub fn not_negative(
    name: &'static str,
    allowed: &'static str,
    value: f64,
    most: f64,
) -> Result<f64, KernelError> {
    if (0.0..=most).contains(&value) {
        Ok(value)
    } else {
        Err(KernelError::Negative {
            name,
            allowed,
            value,
        })
    }
}

pub fn whole(
    name: &'static str,
    value: f64,
    least: usize,
    most: usize,
) -> Result<usize, KernelError> {
    if value.fract() == 0.0 && (least as f64..=most as f64).contains(&value) {
        Ok(value as usize)
    } else {
        Err(KernelError::NotWhole {
            name,
            least,
            most,
            value,
        })
    }
}
