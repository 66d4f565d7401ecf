//! Interfaces to the systems of a plant, beside the line protocols of [`serve`].

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

pub mod bundle;
mod credentials;
pub mod database;
mod host;
pub mod http;
pub mod mqtt;

pub use self::credentials::CredentialError;

// Tests of the program play brokers and clients with the libraries that are already here.
#[doc(hidden)]
pub use {rumqttc, tokio_rustls};
