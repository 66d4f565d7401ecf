//! Authorisation of clients.

use std::{net::IpAddr, path::Path};

use axum::http::{
    HeaderMap,
    header::{AUTHORIZATION, HOST, ORIGIN},
    uri::Authority,
};
use subtle::{Choice, ConstantTimeEq as _};

use super::{error::HttpError, refusal::Refusal};
use files::{FileError, read_limited};

/// Minimum length of a token, characters: too long to be guessed over the network.
pub(super) const MIN_LETTERS: usize = 16;
/// Maximum length of a token, characters.
pub(super) const MAX_LETTERS: usize = 512;
/// Maximum size of the token file, which has one line per client.
const MAX_FILE_BYTES: u64 = 1 << 16;

/// The accepted tokens, of which a client has to send one as `Authorization: Bearer TOKEN`. If there are none, programs on
/// this computer have access.
#[derive(Clone, Default)]
pub struct Tokens(Vec<Vec<u8>>);

impl Tokens {
    /// Reads one token per line from a file; empty lines are ignored.
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

    /// True if no token is required.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Checks whether a client with these request headers has access.
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
        // The time taken reveals neither matching characters nor the matching token, only the length.
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

/// True if a web page in a browser on this computer sends the request: browsers send the page's origin with cross-origin
/// requests, and in `Host` the name by which they reached this computer.
fn is_of_web_page(head: &HeaderMap) -> bool {
    let host = head.get(HOST).map(|host| {
        let host = host.to_str().ok()?.parse::<Authority>().ok()?;
        let name = host.host().trim_matches(['[', ']']);
        (name == "localhost" || name.parse::<IpAddr>().is_ok()).then_some(())
    });
    head.contains_key(ORIGIN) || host == Some(None)
}
