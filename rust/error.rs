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
    OutOfRange {
        name: &'static str,
        least: usize,
        most: usize,
        value: usize,
    },
    #[error("{name} must be one of {expected}; got {value:?}")]
    UnknownName {
        name: &'static str,
        expected: &'static str,
        value: String,
    },
    #[error("a stage may slide over at most {longest} wavelengths; got {wavelengths}")]
    TooLong { longest: f64, wavelengths: f64 },
    #[error("moduli and relaxation_times must have the same length; got {moduli} and {times}")]
    LengthMismatch { moduli: usize, times: usize },
}

pub fn positive(name: &'static str, value: f64) -> Result<f64, KernelError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(KernelError::NotPositive { name, value })
    }
}

pub fn whole(
    name: &'static str,
    value: usize,
    least: usize,
    most: usize,
) -> Result<usize, KernelError> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(KernelError::OutOfRange {
            name,
            least,
            most,
            value,
        })
    }
}
