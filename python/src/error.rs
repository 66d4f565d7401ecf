//! Errors and warnings of the library as Python's: the message, and on a second line what to do.

use std::{ffi::CString, fmt::Display};

use partsight::Advice;
use pyo3::{
    create_exception,
    exceptions::{PyException, PyUserWarning},
    prelude::*,
};

create_exception!(
    partsight,
    PartsightError,
    PyException,
    "Something could not be read, computed or saved. The message says what was found and what to do."
);

fn with_advice(message: &dyn Display, advice: &str) -> String {
    format!("{message}\n  to do: {advice}")
}

/// An exception with this message and advice.
pub(crate) fn refused(message: impl Display, advice: &str) -> PyErr {
    PartsightError::new_err(with_advice(&message, advice))
}

/// An error of the library as an exception.
pub(crate) fn advised(error: impl Advice + Display) -> PyErr {
    refused(&error, &error.advice())
}

/// Issues a `UserWarning`; it is an error where the caller made warnings errors.
pub(crate) fn warn(py: Python<'_>, warning: &(impl Advice + Display)) -> PyResult<()> {
    warn_about(py, warning, &warning.advice())
}

/// As [`warn`], with a message of its own.
pub(crate) fn warn_about(py: Python<'_>, message: impl Display, advice: &str) -> PyResult<()> {
    // A path may hold what no C string can.
    let text = with_advice(&message, advice).replace('\0', "\u{fffd}");
    let category = py.get_type::<PyUserWarning>();
    PyErr::warn(py, &category, &CString::new(text)?, 1)
}
