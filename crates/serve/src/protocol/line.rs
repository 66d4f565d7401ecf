//! A request as a line of text: `TRIGGER`, `STATUS`, `LAST`, `PATH`, `PATH 3` or, of the inspection number 41, `PATH 3 41`;
//! `PART` likewise.
//!
//! A line ends with LF, CR or both. Case does not matter. Empty lines, and blanks and zeros around a request, are ignored.

use super::{Parsed, bad_request::BadRequest, is_filler};
use crate::answer::Request;

/// Maximum length of a line, bytes; every request is shorter.
const MAX_LINE: usize = 64;

pub(super) fn parse(bytes: &[u8]) -> Parsed {
    let start = bytes.iter().position(|&byte| !is_filler(byte));
    let Some(start) = start else {
        return Parsed::skipped(bytes.len());
    };
    let line = &bytes[start..];
    let end = line.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
    match end {
        Some(end) if end <= MAX_LINE => Parsed::read(start + end + 1, request(&line[..end])),
        None if line.len() <= MAX_LINE => Parsed::skipped(start),
        _ => Parsed::bad(BadRequest::TooLong { limit: MAX_LINE }),
    }
}

fn request(line: &[u8]) -> Result<Request, BadRequest> {
    let mut words = line
        .split(|&byte| is_filler(byte) || byte == b';')
        .filter(|word| !word.is_empty());
    let (word, number, sequence) = (words.next().unwrap_or_default(), words.next(), words.next());
    if words.next().is_some() {
        return Err(BadRequest::unknown(line));
    }
    named(word, number, sequence).ok_or_else(|| BadRequest::unknown(line))?
}

/// Finds a request by its word and the numbers after it; `None` if the word is no request or takes no numbers.
pub(super) fn named(
    word: &[u8],
    number: Option<&[u8]>,
    sequence: Option<&[u8]>,
) -> Option<Result<Request, BadRequest>> {
    let request = of_name(word)?;
    if number.is_none() && sequence.is_none() {
        return Some(Ok(request));
    }
    match (number_in(number), number_in(sequence)) {
        (Ok(number), Ok(sequence)) => request.numbered(number, sequence).map(Ok),
        (Err(why), _) | (_, Err(why)) => request.numbered(0, 0).map(|_| Err(why)),
    }
}

/// Finds a request by its word, ignoring case; its numbers are 0.
pub(super) fn of_name(word: &[u8]) -> Option<Request> {
    Request::find(|(name, _)| name.as_bytes().eq_ignore_ascii_case(word))
}

/// Reads a number; 0 if there is none.
fn number_in(text: Option<&[u8]>) -> Result<u32, BadRequest> {
    let Some(text) = text else {
        return Ok(0);
    };
    let number = std::str::from_utf8(text).ok();
    let number = number.and_then(|text| text.parse().ok());
    number.ok_or_else(|| BadRequest::no_point(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn only(text: &str) -> Result<Request, BadRequest> {
        let parsed = parse(text.as_bytes());
        assert_eq!(parsed.used, text.len(), "{text:?}");
        parsed
            .request
            .unwrap_or_else(|| panic!("{text:?} is whole"))
    }

    #[test]
    fn every_request_is_read_with_any_end_and_in_any_case() {
        for (text, request) in [
            ("TRIGGER\n", Request::Trigger),
            ("status\r", Request::Status),
            ("Last\n", Request::Last),
            ("PATH\n", Request::path(0, 0)),
            ("PATH 12\n", Request::path(12, 0)),
            ("PATH 12 41\n", Request::path(12, 41)),
            ("path;0;41\n", Request::path(0, 41)),
            ("PATH 12 0\n", Request::path(12, 0)),
            ("PATH;7\n", Request::path(7, 0)),
            ("PART\n", Request::part(0, 0)),
            ("part 2 41\n", Request::part(2, 41)),
            ("\r\n \0\0TRIGGER \0\n", Request::Trigger),
        ] {
            assert_eq!(only(text), Ok(request), "{text:?}");
        }
    }

    #[test]
    fn lines_are_read_one_after_the_other() {
        let text = b"STATUS\r\nTRIGGER\r\nLA";
        let first = parse(text);
        assert_eq!((first.used, first.request), (7, Some(Ok(Request::Status))));
        let second = parse(&text[7..]);
        assert_eq!(
            (second.used, second.request),
            (9, Some(Ok(Request::Trigger)))
        );
        // The second half of the line ending.
        assert_eq!(parse(&text[16..]), Parsed::skipped(1));
        assert_eq!(parse(&text[17..]), Parsed::skipped(0));
    }

    #[test]
    fn anything_else_is_refused_by_name() {
        for (text, reason) in [
            ("START\n", "unknown_request"),
            ("TRIGGER 1\n", "unknown_request"),
            ("PATH 1 2 3\n", "unknown_request"),
            ("PART 1 2 3\n", "unknown_request"),
            ("LAST 1 2\n", "unknown_request"),
            ("PATH -1\n", "no_point"),
            ("PATH 1 x\n", "no_point"),
            ("PART x\n", "no_point"),
            ("PATH 99999999999\n", "no_point"),
            ("GET / HTTP/1.1\r", "unknown_request"),
            ("\u{e4}\u{1b}[2J\n", "unknown_request"),
        ] {
            let why = only(text).expect_err(text);
            assert_eq!(why.reason(), reason, "{text:?}");
            assert!(!why.to_string().contains('\u{1b}'), "{why}");
        }
        let endless = [b'A'; MAX_LINE + 1];
        let refused = parse(&endless).request.expect("refused");
        assert_eq!(refused.expect_err("too long").reason(), "too_long");
        assert_eq!(parse(&endless[1..]), Parsed::skipped(0));
    }
}
