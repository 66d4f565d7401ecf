//! Interfaces to the systems of a plant, with the built program and real servers on the other side.

#![allow(clippy::disallowed_methods, reason = "tests change files")]

mod bundles;
mod http;
#[path = "../kit/mod.rs"]
mod kit;
#[cfg(unix)]
mod mqtt;
#[cfg(unix)]
mod postgres;
