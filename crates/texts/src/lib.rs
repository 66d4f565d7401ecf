//! One catalogue of the messages of the library, in the languages of the window, in Mozilla's Fluent format.
//!
//! A type whose texts are in the catalogue is [`Described`]: its fields, as it is serialised, are the variables of its
//! [`Message`]. Commands show the message in English, the window in its own language. The texts are in
//! `language/<language>/<family>.ftl`; a new kind of a refusal costs a variant and its entry there.
//!
//! The language is a property of the thread, see [`Language::current`].

mod catalogue;
mod functions;
mod language;
mod message;

pub use self::{
    catalogue::{Catalogue, Files, LIBRARY},
    language::Language,
    message::{Described, Message, Value},
};
