//! How the server speaks with the systems of a plant, beside the line protocols of [`crate::serve`].

pub mod http;
pub mod mqtt;
