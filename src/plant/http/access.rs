//! Who may ask.

use std::{net::IpAddr, path::Path};

use axum::http::{
    HeaderMap,
    header::{AUTHORIZATION, HOST, ORIGIN},
    uri::Authority,
};
use subtle::{Choice, ConstantTimeEq as _};

use super::{error::HttpError, refusal::Refusal};
use crate::files::{FileError, read_limited};

/// Letters that a token has at least: too many to be guessed over the network.
const MIN_LETTERS: usize = 16;
/// And at most.
const MAX_LETTERS: usize = 512;
/// A line for each client.
const MAX_FILE_BYTES: u64 = 1 << 16;

/// The tokens of which a client has to send one, as `Authorization: Bearer TOKEN`. Without any, programs on this computer
/// may ask.
#[derive(Clone, Default)]
pub struct Tokens(Vec<Vec<u8>>);

impl Tokens {
    /// Of a file with one on each line; empty lines do not count.
    pub fn load(path: &Path) -> Result<Self, HttpError> {
        let text = match read_limited(path, MAX_FILE_BYTES) {
            Err(FileError::Empty { .. }) => Vec::new(),
            text => text?,
        };
        let mut tokens = Vec::new();
        for (i, line) in text.split(|byte| *byte == b'\n').enumerate() {
            let token = line.trim_ascii();
            if token.is_empty() {
                continue;
            }
            let has_length = (MIN_LETTERS..=MAX_LETTERS).contains(&token.len());
            if !has_length || !token.iter().all(u8::is_ascii_graphic) {
                return Err(HttpError::BadToken {
                    path: path.to_owned(),
                    line: i + 1,
                    min_letters: MIN_LETTERS,
                    max_letters: MAX_LETTERS,
                });
            }
            tokens.push(token.to_owned());
        }
        if tokens.is_empty() {
            return Err(HttpError::NoToken {
                path: path.to_owned(),
            });
        }
        Ok(Self(tokens))
    }

    /// True if none is asked for.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether the client that sent this head may ask.
    pub(super) fn check(&self, head: &HeaderMap) -> Result<(), Refusal> {
        if self.is_empty() {
            return if is_of_web_page(head) {
                Err(Refusal::WebPage)
            } else {
                Ok(())
            };
        }
        let sent = head.get(AUTHORIZATION).and_then(|sent| {
            let (scheme, token) = sent.as_bytes().split_at_checked(7)?;
            scheme.eq_ignore_ascii_case(b"bearer ").then_some(token)
        });
        let sent = sent.ok_or(Refusal::WrongToken)?.trim_ascii();
        // Neither the right letters nor the right token show in the time that it takes; only the length does.
        let known = self.0.iter().fold(Choice::from(0), |known, token| {
            known | token.as_slice().ct_eq(sent)
        });
        if bool::from(known) {
            Ok(())
        } else {
            Err(Refusal::WrongToken)
        }
    }
}

/// True of what a page in a browser on this computer sends: browsers name the page of a foreign request, and the name by
/// which they found this computer.
fn is_of_web_page(head: &HeaderMap) -> bool {
    let host = head.get(HOST).map(|host| {
        let host = host.to_str().ok()?.parse::<Authority>().ok()?;
        let name = host.host().trim_matches(['[', ']']);
        (name == "localhost" || name.parse::<IpAddr>().is_ok()).then_some(())
    });
    head.contains_key(ORIGIN) || host == Some(None)
}
