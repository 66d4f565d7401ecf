//! Frames of fixed length, for PLCs that cannot easily parse text.
//!
//! Integers and reals (IEEE 754) are in the byte order chosen for the port. Texts are UTF-8, padded with zeros. The
//! checksum is CRC-32 (ISO 3309, as in ZIP and PNG) over all bytes before it.
//!
//! | request: from | bytes | |
//! | --- | --- | --- |
//! | 0 | 4 | `PSRQ` |
//! | 4 | 2 | version, 1 |
//! | 6 | 2 | length: 20, and 4 for each further number, up to 48; up to 80 with places; 84 with a count |
//! | 8 | 2 | 1 trigger, 2 status, 3 last, 4 path, 5 part, 6 servo |
//! | 10 | 2 | trigger: how many parts are expected, 0 to 8; otherwise 0 |
//! | 12 | 4 | path and part: number of the point or part from 1, or 0; trigger: number of the first expected part |
//! | 16 | 4 | path and part: sequence number of the inspection whose path or part is wanted, or 0, or left out; trigger: number of the second expected part, and so on |
//! | 44 | 4 | trigger, after eight numbers of parts, of which the last may be 0: number of the first part's place, or 0 for any; number of the second part's place, and so on |
//! | 76 | 4 | trigger, after eight places, of which the last may be 0: count of the line's encoder |
//! | last | 4 | checksum |
//!
//! | request of a robot that servoes, 76 bytes: from | bytes | |
//! | --- | --- | --- |
//! | 10 | 2 | 1: a new run begins; otherwise 0 |
//! | 12 | 4 | number of the part |
//! | 16 | 56 | seven reals: the numbers of the flange's pose in the convention, then zeros |
//!
//! | answer: from | bytes | |
//! | --- | --- | --- |
//! | 0 | 4 | `PSAN` |
//! | 4 | 2 | version, 1 |
//! | 6 | 2 | length, 256; 284 of a part on a line |
//! | 8 | 2 | code of the request; 0: it could not be read |
//! | 10 | 2 | verdict |
//! | 12 | 4 | boot |
//! | 16 | 4 | sequence |
//! | 20 | 4 | age in ms, signed; -1: no frame |
//! | 24 | 2 | camera |
//! | 26 | 2 | flags; bit 0: there is a pose |
//! | 28 | 4 | number of the part |
//! | 32 | 4 | point |
//! | 36 | 4 | points |
//! | 40 | 2 | number of the pose's reals; 0: no pose |
//! | 42 | 2 | number of the part's place in the rack; 0: none |
//! | 44 | 4 | reserved, 0 |
//! | 48 | 8 | speed in mm/s; 0: none |
//! | 56 | 56 | seven reals: the numbers of the convention, then zeros |
//! | 112 | 64 | name of the part |
//! | 176 | 24 | reason |
//! | 200 | 52 | message, cut off |
//! | 252 | 4 | checksum |
//!
//! | answer about a line: from | bytes | |
//! | --- | --- | --- |
//! | 252 | 4 | number of the part on the line; 0 without a pose |
//! | 256 | 4 | count at which it has the pose: the one that was sent |
//! | 260 | 4 | time since then in ms, signed; -1: no pose |
//! | 264 | 8 | bound of the pose in mm |
//! | 272 | 8 | speed of the line in mm/s |
//! | 280 | 4 | checksum |
//! An answer to a robot that servoes has a message of 16 bytes, and behind it, from 216, four reals: the error that is left in mm
//! and degrees, and its bounds; all 0 where there are none.

use std::iter;

use super::{ByteOrder, Parsed, bad_request::BadRequest, servo_request};
use crate::answer::{Answer, RemainingError};
use crate::request::{ExpectedNumber, Request};
use files::crc32;
use robot::Convention;
use stages::segment::MAX_PARTS;

/// Version of the frames.
pub(super) const VERSION: u16 = 1;
/// Length of a request, bytes.
pub const REQUEST_BYTES: usize = 20;
/// Length of a request with as many numbers as possible, those of parts and of their places, and a count, bytes.
pub(super) const MAX_REQUEST_BYTES: usize =
    NUMBERS_OFFSET_BYTES + 4 * (2 * MAX_PARTS + 1) + CHECKSUM_BYTES;
/// Where the numbers of a request begin.
const NUMBERS_OFFSET_BYTES: usize = 12;
/// Where the flange's pose begins in the request of a robot that servoes.
const POSE_OFFSET_BYTES: usize = 16;
/// Length of the request of a robot that servoes, bytes.
const SERVO_BYTES: usize = POSE_OFFSET_BYTES + 8 * MAX_NUMBERS + CHECKSUM_BYTES;
/// Length of an answer, bytes.
pub const ANSWER_BYTES: usize = 256;
/// Number of the bytes that an answer about a line has more.
const ON_LINE_BYTES: usize = 28;
/// Maximum number of a pose's reals.
pub const MAX_NUMBERS: usize = 7;

const REQUEST_MAGIC: [u8; 4] = *b"PSRQ";
const ANSWER_MAGIC: [u8; 4] = *b"PSAN";
const CHECKSUM_BYTES: usize = 4;

pub(super) fn parse(bytes: &[u8], convention: Convention, order: ByteOrder) -> Parsed {
    let begun = bytes.len().min(REQUEST_MAGIC.len());
    if bytes[..begun] != REQUEST_MAGIC[..begun] {
        return Parsed::bad(BadRequest::Magic);
    }
    let Some(begin) = bytes.first_chunk::<REQUEST_BYTES>() else {
        return Parsed::skipped(0);
    };
    let num_bytes = match length_in(begin, order) {
        Ok(num_bytes) => num_bytes,
        Err(why) => return Parsed::bad(why),
    };
    match bytes.get(..num_bytes) {
        Some(frame) => Parsed::read(num_bytes, request_in(frame, convention, order)),
        None => Parsed::skipped(0),
    }
}

/// The length of a request by its first bytes.
fn length_in(begin: &[u8], order: ByteOrder) -> Result<usize, BadRequest> {
    let found = u16_of(begin, 4, order);
    if found != VERSION {
        return Err(BadRequest::Version { found, order });
    }
    let found = u16_of(begin, 6, order);
    match usize::from(found) {
        num_bytes @ REQUEST_BYTES..=MAX_REQUEST_BYTES if num_bytes.is_multiple_of(4) => {
            Ok(num_bytes)
        }
        _ => Err(BadRequest::Length { found }),
    }
}

fn request_in(
    frame: &[u8],
    convention: Convention,
    order: ByteOrder,
) -> Result<Request, BadRequest> {
    let end = frame.len() - CHECKSUM_BYTES;
    let expected = crc32(&frame[..end]);
    let found = u32_of(frame, end, order);
    if found != expected {
        return Err(BadRequest::Checksum { found, expected });
    }
    let code = u16_of(frame, 8, order);
    let request = Request::find(|(_, known)| known == code);
    let request = request.ok_or_else(|| BadRequest::unknown(code.to_string().as_bytes()))?;
    let found = u16_of(frame, 6, order);
    let wrong_length = || BadRequest::Length { found };
    if let Request::Servo(_) = request {
        let reals = frame[POSE_OFFSET_BYTES..end].chunks_exact(8);
        let reals: Vec<f64> = reals.map(|bytes| f64_of(bytes, order)).collect();
        let is_whole = frame.len() == SERVO_BYTES;
        let numbers = reals.get(..convention.names().len());
        let numbers = numbers.filter(|_| is_whole).ok_or_else(wrong_length)?;
        let part = u32_of(frame, NUMBERS_OFFSET_BYTES, order);
        let is_start = u16_of(frame, 10, order) != 0;
        return servo_request(part, is_start, numbers, convention);
    }
    let num_numbers = match request {
        Request::Trigger { .. } => usize::from(u16_of(frame, 10, order)),
        Request::Path { .. } | Request::Part { .. } => (end - NUMBERS_OFFSET_BYTES) / 4,
        // They ignore the numbers.
        Request::Status | Request::Last | Request::Servo(_) => 0,
    };
    let numbers = frame[NUMBERS_OFFSET_BYTES..end].chunks_exact(4);
    let numbers: Vec<u32> = numbers.map(|bytes| u32_of(bytes, 0, order)).collect();
    let given = numbers.get(..num_numbers).ok_or_else(wrong_length)?;
    let request = match request {
        Request::Trigger { .. } => {
            let places = numbers
                .iter()
                .skip(MAX_PARTS)
                .copied()
                .chain(iter::repeat(0));
            let parts = given.iter().zip(places);
            let parts = parts.map(|(&part, place)| ExpectedNumber { part, place });
            let count = numbers.get(2 * MAX_PARTS).copied();
            Request::expecting(parts).map(|request| request.at_count(count))
        }
        _ => request.numbered(given),
    };
    request.ok_or_else(wrong_length)
}

/// Converts a number's bytes from little-endian to this order, or back.
fn ordered<const N: usize>(mut bytes: [u8; N], order: ByteOrder) -> [u8; N] {
    if order == ByteOrder::Big {
        bytes.reverse();
    }
    bytes
}

fn u16_of(bytes: &[u8], at: usize, order: ByteOrder) -> u16 {
    u16::from_le_bytes(ordered([bytes[at], bytes[at + 1]], order))
}

fn u32_of(bytes: &[u8], at: usize, order: ByteOrder) -> u32 {
    let bytes = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
    u32::from_le_bytes(ordered(bytes, order))
}

fn f64_of(bytes: &[u8], order: ByteOrder) -> f64 {
    f64::from_le_bytes(ordered(std::array::from_fn(|i| bytes[i]), order))
}

pub(super) fn write(answer: &Answer, convention: Convention, order: ByteOrder) -> Vec<u8> {
    let pose = answer.pose.as_ref().map(|pose| convention.write(pose));
    let numbers = pose.map_or_else(Vec::new, |pose| pose.numbers());
    assert!(
        numbers.len() <= MAX_NUMBERS,
        "conventions of more numbers are refused at the start"
    );
    let mut frame = FrameWriter {
        bytes: Vec::with_capacity(ANSWER_BYTES),
        order,
    };
    frame.bytes.extend(ANSWER_MAGIC);
    frame.short(VERSION);
    let more = answer.on_line.map_or(0, |_| ON_LINE_BYTES);
    frame.short((ANSWER_BYTES + more) as u16);
    let request = answer.request.as_ref();
    frame.short(request.map_or(0, |request| request.name().1));
    frame.short(answer.verdict.code());
    frame.long(answer.boot);
    frame.long(answer.sequence);
    frame.long(answer.age_or_none().cast_unsigned());
    frame.short(answer.camera.code());
    frame.short(answer.flags());
    frame.long(answer.number);
    frame.long(answer.point);
    frame.long(answer.points);
    frame.short(numbers.len() as u16);
    frame.short(answer.place_number().unwrap_or(0) as u16);
    frame.zeros(4);
    frame.real(answer.speed_mm_s.unwrap_or(0.0));
    for i in 0..MAX_NUMBERS {
        frame.real(numbers.get(i).copied().unwrap_or(0.0));
    }
    frame.text(&answer.part, 64);
    frame.text(&answer.problem.reason, 24);
    if let Some(Request::Servo(_)) = answer.request {
        frame.text(&answer.problem.message, 16);
        let error = answer.servo_error.as_ref().map(RemainingError::figures);
        for figure in error.unwrap_or_default() {
            frame.real(figure);
        }
        frame.zeros(4);
    } else {
        frame.text(&answer.problem.message, 52);
    }
    if let Some(on_line) = &answer.on_line {
        frame.long(on_line.number);
        frame.long(on_line.count.unwrap_or(0));
        frame.long(answer.on_line_since_or_none().cast_unsigned());
        frame.real(on_line.bound_mm);
        frame.real(on_line.speed_mm_s);
    }
    let checksum = crc32(&frame.bytes);
    frame.long(checksum);
    frame.bytes
}

/// A frame under construction.
struct FrameWriter {
    bytes: Vec<u8>,
    order: ByteOrder,
}

impl FrameWriter {
    fn short(&mut self, value: u16) {
        self.bytes.extend(ordered(value.to_le_bytes(), self.order));
    }

    fn long(&mut self, value: u32) {
        self.bytes.extend(ordered(value.to_le_bytes(), self.order));
    }

    fn real(&mut self, value: f64) {
        self.bytes.extend(ordered(value.to_le_bytes(), self.order));
    }

    fn zeros(&mut self, num_bytes: usize) {
        self.bytes.resize(self.bytes.len() + num_bytes, 0);
    }

    /// Writes a text into a field of this size, truncated at a character boundary and padded with zeros.
    fn text(&mut self, text: &str, num_bytes: usize) {
        let end = text.floor_char_boundary(num_bytes);
        self.bytes.extend(&text.as_bytes()[..end]);
        self.zeros(num_bytes - end);
    }
}

/// Encodes a request as a frame, without an order and the age of a count; one of a robot that servoes without its pose, so that it is refused.
pub fn request(request: &Request, order: ByteOrder) -> Vec<u8> {
    let mut frame = FrameWriter {
        bytes: REQUEST_MAGIC.to_vec(),
        order,
    };
    let mut numbers = request.numbers();
    let num_expected = match request {
        Request::Trigger { .. } => numbers.len(),
        _ => 0,
    };
    if let Request::Trigger {
        expected, count, ..
    } = request
        && (count.is_some() || expected.iter().any(|one| one.place > 0))
    {
        numbers.resize(MAX_PARTS, 0);
        numbers.extend(expected.map(|one| one.place));
        numbers.extend(count);
    }
    numbers.resize(numbers.len().max(1), 0);
    let num_bytes = NUMBERS_OFFSET_BYTES + 4 * numbers.len() + CHECKSUM_BYTES;
    frame.short(VERSION);
    frame.short(num_bytes as u16);
    frame.short(request.name().1);
    frame.short(num_expected as u16);
    for number in numbers {
        frame.long(number);
    }
    let checksum = crc32(&frame.bytes);
    frame.long(checksum);
    frame.bytes
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::{
        answer::{Problem, VerdictCode},
        protocol::tests::refused,
        request::ServoRequest,
    };
    use geometry::{
        rigid::{PoseDelta, RigidTransform, from_euler_zyx, pose_error},
        units::{Metres, Radians},
    };
    use robot::line::OnLine;

    fn parse(bytes: &[u8], order: ByteOrder) -> Parsed {
        super::parse(bytes, Convention::Abb, order)
    }

    const ORDERS: [ByteOrder; 2] = [ByteOrder::Little, ByteOrder::Big];

    fn real(frame: &[u8], at: usize, order: ByteOrder) -> f64 {
        let bytes = frame[at..at + 8].try_into().expect("eight");
        match order {
            ByteOrder::Little => f64::from_le_bytes(bytes),
            ByteOrder::Big => f64::from_be_bytes(bytes),
        }
    }

    fn expecting(numbers: &[u32]) -> Request {
        Request::TRIGGER.numbered(numbers).expect("not too many")
    }

    /// The bytes with the right checksum at their end, little-endian.
    fn sealed(mut frame: Vec<u8>) -> Vec<u8> {
        let checksum = crc32(&frame);
        frame.extend(checksum.to_le_bytes());
        frame
    }

    #[test]
    fn numbers_that_a_trigger_does_not_announce_are_ignored_and_those_that_it_lacks_are_an_error() {
        let little = ByteOrder::Little;
        // A robot that sends the numbers of its last request for a path again.
        let mut frame = request(&Request::path(7, 41), little);
        frame.truncate(20);
        frame[8] = 1;
        let read = |frame: Vec<u8>| parse(&sealed(frame), little).request.expect("whole");
        assert_eq!(read(frame.clone()), Ok(Request::TRIGGER));
        frame[10] = 2;
        assert_eq!(read(frame.clone()), Ok(expecting(&[7, 41])));
        frame[10] = 3;
        assert_eq!(read(frame.clone()).expect_err("too few").reason(), "length");
        // A path has no third number.
        let mut long = frame[..20].to_vec();
        (long[6], long[8], long[10]) = (28, 4, 0);
        long.extend([0; 4]);
        assert_eq!(read(long).expect_err("too many").reason(), "length");
    }

    #[test]
    fn a_trigger_has_the_places_of_its_parts_behind_eight_numbers_of_parts() {
        let numbers = |parts: &[(u32, u32)]| {
            let parts = parts
                .iter()
                .map(|&(part, place)| ExpectedNumber { part, place });
            Request::expecting(parts).expect("not too many")
        };
        let most: Vec<(u32, u32)> = (1..=8).map(|number| (number, 9 - number)).collect();
        for wanted in [
            numbers(&[(3, 1), (5, 2)]),
            numbers(&[(3, 0), (5, 2)]),
            numbers(&most),
        ] {
            for order in ORDERS {
                let frame = request(&wanted, order);
                assert_eq!(frame.len(), 80);
                assert_eq!(parse(&frame, order), Parsed::read(80, Ok(wanted.clone())));
            }
        }
        // As in the guide; places that are left out are any.
        let little = ByteOrder::Little;
        let frame = request(&numbers(&[(3, 1), (5, 2)]), little);
        assert_eq!(frame[6..11], [80, 0, 1, 0, 2]);
        assert_eq!(
            [12, 16, 20, 44, 48, 52].map(|at| frame[at]),
            [3, 5, 0, 1, 2, 0]
        );
        assert_eq!(frame[76..], [0x4b, 0x31, 0x04, 0x46]);
        let mut short = frame[..48].to_vec();
        short[6] = 52;
        let read = parse(&sealed(short), little).request.expect("whole");
        assert_eq!(read, Ok(numbers(&[(3, 1), (5, 0)])));
        // A controller that never clears its list of numbers.
        let mut older = frame[..44].to_vec();
        (older[6], older[20]) = (48, 7);
        let read = parse(&sealed(older), little).request.expect("whole");
        assert_eq!(read, Ok(expecting(&[3, 5])));
        let mut long = frame[..76].to_vec();
        long[6] = 88;
        long.extend([0; 8]);
        let read = parse(&sealed(long), little).request.expect("read");
        assert_eq!(read.expect_err("too long").reason(), "length");
    }

    /// The request of a robot that servoes, little-endian, with this length in its head.
    fn servo_frame(num_bytes: u16, start: u16, reals: [f64; 7]) -> Vec<u8> {
        let mut frame = b"PSRQ\x01\x00".to_vec();
        for short in [num_bytes, 6, start] {
            frame.extend(short.to_le_bytes());
        }
        frame.extend(3_u32.to_le_bytes());
        frame.extend(reals.iter().flat_map(|real| real.to_le_bytes()));
        frame.truncate(usize::from(num_bytes) - 4);
        sealed(frame)
    }

    #[test]
    fn a_robot_that_servoes_sends_seven_reals_and_gets_the_error_behind_a_short_message() {
        let little = ByteOrder::Little;
        let flange = [1200.0, -400.0, 1900.0, 1.0, 0.0, 0.0, 0.0];
        let request = ServoRequest {
            part: 3,
            is_start: true,
            robot_from_flange: RigidTransform::translation(1.2, -0.4, 1.9),
        };
        let frame = servo_frame(76, 1, flange);
        let wanted = Request::Servo(request);
        assert_eq!(parse(&frame, little), Parsed::read(76, Ok(wanted.clone())));
        assert_eq!(parse(&frame[..75], little), Parsed::skipped(0));
        // Six numbers and a zero.
        let kuka = servo_frame(76, 0, [1200.0, -400.0, 1900.0, 0.0, 0.0, 0.0, 0.0]);
        let read = super::parse(&kuka, Convention::Kuka, little);
        let goes_on = Request::Servo(ServoRequest {
            is_start: false,
            ..request
        });
        assert_eq!(read, Parsed::read(76, Ok(goes_on)));
        let not_unit = [1200.0, -400.0, 1900.0, 1.0, 1.0, 0.0, 0.0];
        let unknown = [f64::NAN, -400.0, 1900.0, 1.0, 0.0, 0.0, 0.0];
        for (frame, reason) in [
            (servo_frame(72, 0, flange), "length"),
            (servo_frame(20, 0, flange), "length"),
            (servo_frame(76, 0, not_unit), "bad_pose"),
            (servo_frame(76, 0, unknown), "bad_pose"),
            (servo_frame(76, 0, [0.0; 7]), "bad_pose"),
            (super::request(&wanted, little), "length"),
        ] {
            let read = parse(&frame, little).request.expect("whole");
            assert_eq!(read.expect_err("refused").reason(), reason);
        }
        let delta = |mm, degrees| PoseDelta {
            shift: Metres::from_mm(mm),
            rotation: Radians::from_degrees(degrees),
        };
        let answer = Answer {
            request: Some(wanted),
            verdict: VerdictCode::Done,
            servo_error: Some(RemainingError {
                error: delta(0.5, 0.25),
                bounds: Some(delta(2.0, 0.125)),
            }),
            ..refused()
        };
        for order in ORDERS {
            let frame = write(&answer, Convention::Abb, order);
            assert_eq!(frame.len(), ANSWER_BYTES);
            assert_eq!([8, 10, 40].map(|at| u16_of(&frame, at, order)), [6, 9, 0]);
            assert_eq!(frame[200..216], *b"it scores; <0.5>");
            let figures = [216, 224, 232, 240].map(|at| real(&frame, at, order));
            for (figure, wanted) in figures.iter().zip([0.5, 0.25, 2.0, 0.125]) {
                assert!((figure - wanted).abs() < 1e-9, "{figures:?}");
            }
            assert_eq!(frame[248..252], [0; 4]);
            assert_eq!(u32_of(&frame, 252, order), crc32(&frame[..252]));
        }
    }

    #[test]
    fn a_count_stands_behind_the_places_and_what_is_known_of_a_line_behind_the_answer() {
        for wanted in [Request::TRIGGER, expecting(&[3, 5])] {
            for (order, count) in ORDERS.into_iter().zip([0, u32::MAX]) {
                let wanted = wanted.clone().at_count(Some(count));
                let frame = request(&wanted, order);
                assert_eq!(parse(&frame, order), Parsed::read(84, Ok(wanted)));
            }
        }
        for order in ORDERS {
            let plain = write(&refused(), Convention::Kuka, order);
            let answer = Answer {
                on_line: Some(OnLine {
                    number: 12,
                    count: Some(70_000),
                    at: jiff::Timestamp::default(),
                    bound_mm: 3.5,
                    speed_mm_s: -99.5,
                }),
                on_line_since_ms: Some(215),
                ..refused()
            };
            let frame = write(&answer, Convention::Kuka, order);
            assert_eq!((frame.len(), u16_of(&frame, 6, order)), (284, 284));
            assert_eq!(frame[8..252], plain[8..252]);
            let long = |at| u32_of(&frame, at, order);
            assert_eq!([252, 256, 260].map(long), [12, 70_000, 215]);
            let reals = [264, 272].map(|at| real(&frame, at, order));
            assert!((reals[0] - 3.5).abs() < 1e-9 && (reals[1] + 99.5).abs() < 1e-9);
            assert_eq!(long(280), crc32(&frame[..280]));
        }
    }

    #[test]
    fn requests_come_back_in_either_byte_order() {
        for order in ORDERS {
            for wanted in [
                Request::TRIGGER,
                Request::Status,
                Request::Last,
                Request::path(0, 0),
                Request::path(70_000, 0),
                Request::path(70_000, 16_777_215),
                Request::part(2, 0),
                Request::part(8, 16_777_215),
                expecting(&[3]),
                expecting(&[1, 2, 3, 4, 5, 6, 7, 16_777_215]),
            ] {
                let frame = request(&wanted, order);
                let num_bytes = match wanted.numbers().len() {
                    0 | 1 => 20,
                    2 => 24,
                    _ => 48,
                };
                assert_eq!(frame.len(), num_bytes);
                assert_eq!(parse(&frame, order), Parsed::read(num_bytes, Ok(wanted)));
                let short = parse(&frame[..num_bytes - 1], order);
                assert_eq!(short, Parsed::skipped(0));
            }
        }
        // As in the guide.
        assert_eq!(
            request(&Request::TRIGGER, ByteOrder::Little)[..16],
            *b"PSRQ\x01\x00\x14\x00\x01\x00\x00\x00\x00\x00\x00\x00"
        );
    }

    #[test]
    fn whatever_is_wrong_with_a_frame_is_named() {
        let reason = |frame: &[u8], order| {
            let read = parse(frame, order).request.expect("whole");
            read.expect_err("refused").reason()
        };
        for order in ORDERS {
            let whole = request(&Request::path(3, 0), order);
            let other = ORDERS[usize::from(order == ByteOrder::Little)];
            assert_eq!(reason(&whole, other), "version");
            // Each byte counts.
            for at in 0..REQUEST_BYTES {
                let mut changed = whole.clone();
                changed[at] ^= 0x80;
                let expected = match at {
                    0..4 => "magic",
                    4..6 => "version",
                    6..8 => "length",
                    _ => "checksum",
                };
                assert_eq!(reason(&changed, order), expected, "byte {at}");
            }
            let mut unknown = whole.clone();
            unknown[8..10].copy_from_slice(&[9, 9]);
            let checksum = crc32(&unknown[..16]);
            let checksum = match order {
                ByteOrder::Little => checksum.to_le_bytes(),
                ByteOrder::Big => checksum.to_be_bytes(),
            };
            unknown[16..].copy_from_slice(&checksum);
            assert_eq!(reason(&unknown, order), "unknown_request");
        }
        assert_eq!(reason(b"GET / HTTP/1.1", ByteOrder::Little), "magic");
        assert_eq!(reason(b"P\0", ByteOrder::Little), "magic");
        assert_eq!(parse(b"PSR", ByteOrder::Little), Parsed::skipped(0));
        let advice = |why: BadRequest| geometry::error::Advice::advice(&why);
        let swapped = BadRequest::Version {
            found: 0x0100,
            order: ByteOrder::Little,
        };
        assert!(advice(swapped).contains("binary-be"));
    }

    #[test]
    fn an_answer_has_its_fields_where_the_guide_says() {
        let pose = from_euler_zyx([0.4, -0.2, 1.3, 1.2005, -0.4, 1.9]);
        let answer = Answer {
            request: Some(Request::path(2, 0)),
            verdict: VerdictCode::Accepted,
            point: 2,
            points: 9,
            speed_mm_s: Some(250.0),
            marks: Answer::GUN_ON,
            pose: Some(pose),
            problem: Problem::default(),
            ..refused()
        };
        for order in ORDERS {
            for (convention, count) in [(Convention::Fanuc, 6), (Convention::Abb, 7)] {
                let frame = write(&answer, convention, order);
                assert_eq!(frame.len(), ANSWER_BYTES);
                assert_eq!(frame[..4], ANSWER_MAGIC);
                let short = |at| u16_of(&frame, at, order);
                let long = |at| u32_of(&frame, at, order);
                assert_eq!([4, 6, 8, 10].map(short), [1, 256, 4, 1]);
                assert_eq!([12, 16, 20].map(long), [1_234_567, 41, 215]);
                assert_eq!([24, 26].map(short), [1, 9]);
                assert_eq!([28, 32, 36].map(long), [3, 2, 9]);
                assert_eq!(short(40), count);
                assert!((real(&frame, 48, order) - 250.0).abs() < 1e-9);
                let numbers: Vec<f64> = (0..usize::from(count))
                    .map(|i| real(&frame, 56 + 8 * i, order))
                    .collect();
                let read = convention.read(&numbers).expect("a pose");
                let off = pose_error(&read, &pose, &Point3::origin());
                assert!(off.shift.mm() < 1e-6 && off.rotation.degrees() < 1e-4);
                assert_eq!(frame[112..122], *b"front_door");
                assert!(frame[122..252].iter().all(|&byte| byte == 0));
                assert_eq!(long(252), crc32(&frame[..252]));
            }
        }
    }

    #[test]
    fn without_a_pose_every_real_is_zero() {
        for order in ORDERS {
            let frame = write(&refused(), Convention::Abb, order);
            assert_eq!(frame.len(), ANSWER_BYTES);
            assert!(frame[40..112].iter().all(|&byte| byte == 0));
            assert_eq!(u16_of(&frame, 26, order), Answer::SIMULATED);
            assert_eq!(frame[176..185], *b"low_score");
            let never = Answer {
                age_ms: None,
                ..refused()
            };
            let frame = write(&never, Convention::Abb, order);
            assert_eq!(frame[20..24], [0xff; 4]);
        }
    }

    #[test]
    fn a_text_that_is_too_long_is_cut_off_between_two_letters() {
        let mut frame = FrameWriter {
            bytes: Vec::new(),
            order: ByteOrder::Little,
        };
        frame.text("aüü", 4);
        assert_eq!(frame.bytes, b"a\xc3\xbc\0");
    }
}
