//! A request as a line of text: `TRIGGER` or, if the parts number 3 and 5 are expected, `TRIGGER 3 5` or, at the first and the
//! second place of the rack, `TRIGGER 1=3 2=5`; `STATUS`, `LAST`, `PATH`, `PATH 3` or, of the inspection number 41,
//! `PATH 3 41`; `PART` likewise. `ENC=123456` behind `TRIGGER` is the count of a line's encoder, `ENC=123456@40` one that was read 40 ms before. `ORDER=4711`, `SERIAL=TL-1` or both
//! stand instead of the parts of that order; a text with blanks or semicolons is in double quotes.
//! `SERVO 3 1450 -310 890 10 20 30`, or `SERVO START 3 …`: of part 3 with the flange there.
//!
//! A line ends with LF, CR or both. Case does not matter. Empty lines, and blanks and zeros around a request, are ignored.

use std::time::Duration;

use super::{Parsed, bad_request::BadRequest, is_filler, servo_request};
use crate::request::{AskedOrder, ExpectedNumber, Request, count_age};
use robot::Convention;

/// Maximum length of a line, bytes; every request is shorter.
const MAX_LINE_BYTES: usize = 256;
/// The word of a request that begins a new run of servoing.
const START: &[u8] = b"START";

pub(super) fn parse(bytes: &[u8], convention: Convention) -> Parsed {
    let start = bytes.iter().position(|&byte| !is_filler(byte));
    let Some(start) = start else {
        return Parsed::skipped(bytes.len());
    };
    let line = &bytes[start..];
    let end = line.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
    match end {
        Some(end) if end <= MAX_LINE_BYTES => {
            Parsed::read(start + end + 1, request(&line[..end], convention))
        }
        None if line.len() <= MAX_LINE_BYTES => Parsed::skipped(start),
        _ => Parsed::bad(BadRequest::TooLong {
            limit: MAX_LINE_BYTES,
        }),
    }
}

fn request(line: &[u8], convention: Convention) -> Result<Request, BadRequest> {
    let mut words = words_of(line);
    let word = words.next().unwrap_or_default();
    if let Some(Request::Servo(_)) = of_name(word) {
        return servo(words, convention);
    }
    named(word, words).ok_or_else(|| BadRequest::unknown(line))?
}

/// Splits a text at blanks and semicolons that are not between double quotes.
pub(super) fn words_of(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut is_quoted = false;
    let words = text.split(move |&byte| {
        is_quoted ^= byte == b'"';
        !is_quoted && (is_filler(byte) || byte == b';')
    });
    words.filter(|word| !word.is_empty())
}

/// Reads `3 1450 -310 890 10 20 30`, or the same behind `START`. The pose may be in brackets with commas, as a program of Universal Robots writes one.
fn servo<'a>(
    words: impl Iterator<Item = &'a [u8]>,
    convention: Convention,
) -> Result<Request, BadRequest> {
    let words = words.flat_map(|word| word.split(|byte| matches!(byte, b',' | b'[' | b']')));
    let mut words = words.filter(|word| !word.is_empty() && *word != b"p");
    let first = words.next().unwrap_or_default();
    let is_start = first.eq_ignore_ascii_case(START);
    let part = if is_start { words.next() } else { Some(first) };
    let part = number_in(part.unwrap_or_default())?;
    let numbers = words.map(real_in).collect::<Result<Vec<f64>, _>>()?;
    servo_request(part, is_start, &numbers, convention)
}

/// Reads a number of a pose.
pub(super) fn real_in(text: &[u8]) -> Result<f64, BadRequest> {
    let number = std::str::from_utf8(text).ok();
    let number = number.and_then(|text| text.parse().ok());
    number.ok_or_else(|| BadRequest::no_real(text))
}

/// Finds a request by its word and the numbers after it; `None` if the word is no request, or does not take as many numbers.
pub(super) fn named<'a>(
    word: &[u8],
    numbers: impl Iterator<Item = &'a [u8]>,
) -> Option<Result<Request, BadRequest>> {
    let request = of_name(word)?;
    let numbers: Vec<&[u8]> = numbers.collect();
    if let Request::Trigger { .. } = request {
        return trigger(numbers).transpose();
    }
    // As many as it takes, whatever they are.
    request.numbered(&vec![0; numbers.len()])?;
    let numbers: Result<Vec<u32>, _> = numbers.into_iter().map(number_in).collect();
    (numbers.map(|numbers| request.numbered(&numbers))).transpose()
}

/// Reads what stands behind `TRIGGER`; `None` if it is more parts than a frame can show.
fn trigger(mut words: Vec<&[u8]>) -> Result<Option<Request>, BadRequest> {
    let mut taken = |name: &str| -> Vec<&[u8]> {
        let values = words.extract_if(.., |word| value_of(word, name).is_some());
        values.filter_map(|word| value_of(word, name)).collect()
    };
    let (count, age) = match taken("ENC=")[..] {
        [] => (None, Duration::ZERO),
        [value] => {
            let mut pieces = value.splitn(2, |byte| *byte == b'@');
            let count = number_of_count(pieces.next().unwrap_or_default())?;
            (
                Some(count),
                pieces.next().map_or(Ok(Duration::ZERO), age_in)?,
            )
        }
        [first, ..] => return Err(BadRequest::no_number(first)),
    };
    let mut text = |name: &str| match taken(name)[..] {
        [] => Ok(""),
        // A program whose variable is empty must not get what hangs there by chance.
        [value] => (text_in(value).ok().filter(|text| !text.trim().is_empty()))
            .ok_or_else(|| BadRequest::bad_order(value)),
        [first, ..] => Err(BadRequest::bad_order(first)),
    };
    let [order, serial] = [text("ORDER=")?, text("SERIAL=")?];
    let asked = AskedOrder::new(order, serial);
    let asked =
        asked.ok_or_else(|| BadRequest::bad_order(&[order, serial].concat().into_bytes()))?;
    let parts = words.into_iter().map(expected_in);
    let Some(request) = Request::expecting(parts.collect::<Result<Vec<_>, _>>()?) else {
        return Ok(None);
    };
    let request = request.at_count(count).read_before(age).of_order(asked);
    request.map(Some).ok_or(BadRequest::OrderAndParts)
}

/// Finds a request by its word, ignoring case; its numbers are 0.
pub(super) fn of_name(word: &[u8]) -> Option<Request> {
    Request::find(|(name, _)| name.as_bytes().eq_ignore_ascii_case(word))
}

/// Reads `PART` or `PLACE=PART`.
pub(super) fn expected_in(text: &[u8]) -> Result<ExpectedNumber, BadRequest> {
    let (place, part) = match text.iter().position(|byte| *byte == b'=') {
        Some(at) => (number_in(&text[..at])?, &text[at + 1..]),
        None => (0, text),
    };
    let part = number_in(part)?;
    Ok(ExpectedNumber { part, place })
}

/// The value of a word that begins with this name.
fn value_of<'a>(word: &'a [u8], name: &str) -> Option<&'a [u8]> {
    let (found, value) = word.split_at_checked(name.len())?;
    found.eq_ignore_ascii_case(name.as_bytes()).then_some(value)
}

/// Reads a text that may be in double quotes.
fn text_in(value: &[u8]) -> Result<&str, BadRequest> {
    let inner = match value.strip_prefix(b"\"") {
        Some(inner) => inner.strip_suffix(b"\""),
        None => Some(value),
    };
    let text = inner.and_then(|inner| std::str::from_utf8(inner).ok());
    let text = text.filter(|text| !text.contains('"'));
    text.ok_or_else(|| BadRequest::bad_order(value))
}

/// Reads a count of a signed or an unsigned counter of up to 32 bits. Some controllers count in reals, such as `7.0`.
pub(super) fn number_of_count(text: &[u8]) -> Result<u32, BadRequest> {
    let number = std::str::from_utf8(text).ok();
    let number = number.and_then(|text| text.parse::<f64>().ok());
    let range = f64::from(i32::MIN)..=f64::from(u32::MAX);
    let number = number.filter(|number| number.fract() == 0.0 && range.contains(number));
    // A negative count is that of a counter of 32 bits.
    let number = number.map(|number| number as i64 as u32);
    number.ok_or_else(|| BadRequest::no_number(text))
}

/// Reads the milliseconds before a trigger at which its count was read.
pub(super) fn age_in(text: &[u8]) -> Result<Duration, BadRequest> {
    let number = std::str::from_utf8(text).ok();
    let age = number.and_then(|text| count_age(text.parse().ok()?));
    age.ok_or_else(|| BadRequest::no_number(text))
}

pub(super) fn number_in(text: &[u8]) -> Result<u32, BadRequest> {
    let number = std::str::from_utf8(text).ok();
    let number = number.and_then(|text| text.parse().ok());
    number.ok_or_else(|| BadRequest::no_number(text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::ServoRequest;
    use geometry::rigid::RigidTransform;

    fn parse(bytes: &[u8]) -> Parsed {
        super::parse(bytes, Convention::UniversalRobots)
    }

    fn only(text: &str) -> Result<Request, BadRequest> {
        let parsed = parse(text.as_bytes());
        assert_eq!(parsed.used, text.len(), "{text:?}");
        parsed
            .request
            .unwrap_or_else(|| panic!("{text:?} is whole"))
    }

    fn expecting(numbers: &[u32]) -> Request {
        Request::TRIGGER.numbered(numbers).expect("not too many")
    }

    /// Expects parts at places, both by number.
    fn placed(parts: [(u32, u32); 2]) -> Request {
        let parts = parts.map(|(part, place)| ExpectedNumber { part, place });
        Request::expecting(parts).expect("not too many")
    }

    #[test]
    fn every_request_is_read_with_any_end_and_in_any_case() {
        for (text, request) in [
            ("TRIGGER\n", Request::TRIGGER),
            ("TRIGGER 3 5\n", expecting(&[3, 5])),
            (
                "trigger;1;2;3;4;5;6;7;16777215\n",
                expecting(&[1, 2, 3, 4, 5, 6, 7, 16_777_215]),
            ),
            ("TRIGGER 1=3 2=5\n", placed([(3, 1), (5, 2)])),
            ("trigger;2=16777215;7\n", placed([(16_777_215, 2), (7, 0)])),
            (
                "TRIGGER ENC=123456\n",
                Request::TRIGGER.at_count(Some(123_456)),
            ),
            ("TRIGGER ENC=7.0\n", Request::TRIGGER.at_count(Some(7))),
            (
                "trigger 3 enc=-2 5\n",
                expecting(&[3, 5]).at_count(Some(u32::MAX - 1)),
            ),
            (
                "TRIGGER ENC=4294967295\n",
                Request::TRIGGER.at_count(Some(u32::MAX)),
            ),
            (
                "trigger 3 enc=-2@40 5\n",
                expecting(&[3, 5])
                    .at_count(Some(u32::MAX - 1))
                    .read_before(Duration::from_millis(40)),
            ),
            (
                "TRIGGER ENC=7@12.5\n",
                Request::TRIGGER
                    .at_count(Some(7))
                    .read_before(Duration::from_micros(12_500)),
            ),
            ("TRIGGER ENC=7@0\n", Request::TRIGGER.at_count(Some(7))),
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
            ("\r\n \0\0TRIGGER \0\n", Request::TRIGGER),
        ] {
            assert_eq!(only(text), Ok(request), "{text:?}");
        }
    }

    #[test]
    fn a_trigger_may_name_an_order_and_a_serial_number() {
        let asked = |order: &str, serial: &str| {
            let asked = AskedOrder::new(order, serial).expect("plain");
            Request::TRIGGER.of_order(asked).expect("no parts")
        };
        for (text, request) in [
            ("TRIGGER ORDER=4711\n", asked("4711", "")),
            (
                "trigger serial=TL-0042;order=4711\n",
                asked("4711", "TL-0042"),
            ),
            (
                "TRIGGER SERIAL=TL-1 ENC=7\n",
                asked("", "TL-1").at_count(Some(7)),
            ),
            (
                "TRIGGER ORDER=\"A 17; left=2\" ENC=7\n",
                asked("A 17; left=2", "").at_count(Some(7)),
            ),
            ("TRIGGER ORDER=Türen=2\n", asked("Türen=2", "")),
            ("TRIGGER ORDER=4711 0\n", asked("4711", "")),
        ] {
            assert_eq!(only(text), Ok(request), "{text:?}");
        }
        for (text, reason) in [
            ("TRIGGER ORDER=4711 3\n", "bad_order"),
            ("TRIGGER ORDER=A 17\n", "bad_order"),
            ("TRIGGER ORDER=A door\n", "no_point"),
            ("TRIGGER ORDER=\"A 17\n", "bad_order"),
            ("TRIGGER ORDER=\n", "bad_order"),
            ("TRIGGER ORDER= 3 5\n", "bad_order"),
            ("TRIGGER ORDER=4711 SERIAL=\" \"\n", "bad_order"),
            ("TRIGGER ORDER=4711 ORDER=4712\n", "bad_order"),
            ("TRIGGER ORDER=\"A\"17\n", "bad_order"),
            ("TRIGGER ORDER=A\"1 7\"\n", "bad_order"),
            ("TRIGGER SERIAL=\"A\t17\"\n", "bad_order"),
            ("STATUS ORDER=4711\n", "unknown_request"),
            ("PATH ORDER=4711\n", "no_point"),
        ] {
            assert_eq!(only(text).expect_err(text).reason(), reason, "{text:?}");
        }
        let bytes = b"TRIGGER ORDER=\xff\n";
        let refused = parse(bytes).request.expect("whole");
        assert_eq!(refused.expect_err("no text").reason(), "bad_order");
    }

    #[test]
    fn a_robot_that_servoes_names_its_part_and_the_pose_of_its_flange() {
        let wanted = |is_start| {
            Request::Servo(ServoRequest {
                part: 3,
                is_start,
                robot_from_flange: RigidTransform::translation(1.2, -0.4, 1.9),
            })
        };
        for (text, is_start) in [
            ("SERVO 3 1.2 -0.4 1.9 0 0 0\n", false),
            ("servo;start;3;1.2;-0.4;1.9;0;0;0\n", true),
            ("SERVO 3 p[1.2,-0.4,1.9,0,0,0]\n", false),
            ("SERVO START 3 p[1.2, -4e-1, 1.9, 0.0, 0.0, 0.0]\n", true),
        ] {
            assert_eq!(only(text), Ok(wanted(is_start)), "{text:?}");
        }
        for (text, reason) in [
            ("SERVO\n", "no_point"),
            ("SERVO START\n", "no_point"),
            ("SERVO -3 1.2 -0.4 1.9 0 0 0\n", "no_point"),
            ("SERVO 3\n", "bad_pose"),
            ("SERVO 3 1.2 -0.4 1.9 0 0\n", "bad_pose"),
            ("SERVO 3 1.2 -0.4 1.9 0 0 0 0\n", "bad_pose"),
            ("SERVO 3 1.2 -0.4 1.9 0 0 x\n", "bad_pose"),
            ("SERVO 3 1.2 -0.4 nan 0 0 0\n", "bad_pose"),
            ("SERVO 3 1.2 -0.4 1e999 0 0 0\n", "bad_pose"),
            ("SERVO 3 1200 -400 1900 0 0 0\n", "bad_pose"),
            ("SERVO 3 0 0 0 0 0 0\n", "bad_pose"),
            ("SERVO 3 1.2 -0.4 1.9 0 0 90\n", "bad_pose"),
        ] {
            assert_eq!(only(text).expect_err(text).reason(), reason, "{text:?}");
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
            (9, Some(Ok(Request::TRIGGER)))
        );
        // The second half of the line ending.
        assert_eq!(parse(&text[16..]), Parsed::skipped(1));
        assert_eq!(parse(&text[17..]), Parsed::skipped(0));
    }

    #[test]
    fn anything_else_is_refused_by_name() {
        for (text, reason) in [
            ("START\n", "unknown_request"),
            ("TRIGGER 1 2 3 4 5 6 7 8 9\n", "unknown_request"),
            ("TRIGGER x\n", "no_point"),
            ("TRIGGER ENC=\n", "no_point"),
            ("TRIGGER ENC=4294967296\n", "no_point"),
            ("TRIGGER ENC=1.5\n", "no_point"),
            ("TRIGGER ENC=7@\n", "no_point"),
            ("TRIGGER ENC=7@-1\n", "no_point"),
            ("TRIGGER ENC=7@nan\n", "no_point"),
            ("TRIGGER ENC=7@10001\n", "no_point"),
            ("TRIGGER ENC=7@4@4\n", "no_point"),
            ("TRIGGER ENC=@40\n", "no_point"),
            ("TRIGGER ENC=7 @40\n", "no_point"),
            ("TRIGGER ENC=7 ENC=8\n", "no_point"),
            ("STATUS ENC=1\n", "unknown_request"),
            ("TRIGGER 1=\n", "no_point"),
            ("TRIGGER =3\n", "no_point"),
            ("TRIGGER 1=2=3\n", "no_point"),
            ("PATH 1=2\n", "no_point"),
            ("STATUS 1\n", "unknown_request"),
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
        let endless = [b'A'; MAX_LINE_BYTES + 1];
        let refused = parse(&endless).request.expect("refused");
        assert_eq!(refused.expect_err("too long").reason(), "too_long");
        assert_eq!(parse(&endless[1..]), Parsed::skipped(0));
    }
}
