//! Interfaces to the systems of a plant, beside the line protocols of [`crate::serve`].

pub mod bundle;
mod credentials;
pub mod database;
mod host;
pub mod http;
pub mod mqtt;

pub use self::credentials::CredentialError;
