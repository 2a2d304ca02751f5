//! Errors: inputs that the kernel refuses, with the value and what was expected.

use std::fmt::Display;

use thiserror::Error;

#[derive(Debug, Clone, PartialEq, Error)]
pub enum KernelError {
    #[error("{name} must be {expected}; got {value}")]
    Refused { name: String, expected: String, value: String },
    #[error("{owner} must have the parameter {name:?}")]
    MissingParameter { owner: &'static str, name: &'static str },
    #[error("a stage may slide over at most {longest} wavelengths; got {wavelengths}")]
    TooLong { longest: f64, wavelengths: f64 },
    #[error("moduli and relaxation_times must have the same length; got {moduli} and {times}")]
    LengthMismatch { moduli: usize, times: usize },
    #[error("start must be of the same rubber and profile; its {name} is {start}, not {here}")]
    OtherStart { name: &'static str, start: String, here: String },
    #[error("start must be a solution that converged; its status is {0:?}")]
    UnsolvedStart(&'static str),
    #[error("stopped by the caller")]
    Stopped,
    /// A state that no input should reach.
    #[error("internal error: {0}; please report it")]
    Internal(&'static str),
}

/// `value` if it is `valid`, else a refusal that says what was `expected`.
fn checked<T: Display>(
    valid: bool,
    name: &str,
    value: T,
    expected: impl Display,
) -> Result<T, KernelError> {
    if valid {
        return Ok(value);
    }
    Err(KernelError::Refused {
        name: name.to_owned(),
        expected: expected.to_string(),
        value: value.to_string(),
    })
}

pub(crate) fn positive(name: &str, value: f64) -> Result<f64, KernelError> {
    let valid = value.is_finite() && value > 0.0;
    checked(valid, name, value, "greater than zero and finite")
}

pub(crate) fn finite(name: &str, value: f64) -> Result<f64, KernelError> {
    checked(value.is_finite(), name, value, "a finite number")
}

/// From zero to `most`; `allowed` says in words what that means.
pub(crate) fn not_negative(
    name: &str,
    value: f64,
    most: f64,
    allowed: &str,
) -> Result<f64, KernelError> {
    let valid = (0.0..=most).contains(&value);
    checked(valid, name, value, format_args!("zero or more{allowed}"))
}

pub(crate) fn between(name: &str, value: f64, least: f64, most: f64) -> Result<f64, KernelError> {
    let valid = (least..=most).contains(&value);
    checked(valid, name, value, format_args!("from {least:?} to {most:?}"))
}

pub(crate) fn whole(
    name: &str,
    value: f64,
    least: usize,
    most: usize,
) -> Result<usize, KernelError> {
    let valid = value.fract() == 0.0 && (least as f64..=most as f64).contains(&value);
    let expected = format_args!("a whole number from {least} to {most}");
    checked(valid, name, value, expected).map(|value| value as usize)
}

/// The refusal of a name that is not among `known`.
pub(crate) fn unknown(name: &str, value: &str, known: &[&str]) -> KernelError {
    KernelError::Refused {
        name: name.to_owned(),
        expected: match known {
            [] => "left out: there is none".to_owned(),
            _ => format!("one of {}", known.join(", ")),
        },
        value: format!("{value:?}"),
    }
}
