//! Errors and warnings of the library as Python's: the message, and the advice on a second line.

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

/// Makes an exception with this message and advice.
pub(crate) fn refused(message: impl Display, advice: &str) -> PyErr {
    PartsightError::new_err(with_advice(&message, advice))
}

/// Converts an error of the library to an exception.
pub(crate) fn advised(error: impl Advice + Display) -> PyErr {
    refused(&error, &error.advice())
}

/// Issues a `UserWarning`; fails if the caller turned warnings into errors.
pub(crate) fn warn(py: Python<'_>, warning: &(impl Advice + Display)) -> PyResult<()> {
    warn_about(py, warning, &warning.advice())
}

/// Issues a `UserWarning` with this message and advice; fails as [`warn`] does.
pub(crate) fn warn_about(py: Python<'_>, message: impl Display, advice: &str) -> PyResult<()> {
    // A path in the message may hold a zero byte, which a C string cannot.
    let text = with_advice(&message, advice).replace('\0', "\u{fffd}");
    let category = py.get_type::<PyUserWarning>();
    PyErr::warn(py, &category, &CString::new(text)?, 1)
}
