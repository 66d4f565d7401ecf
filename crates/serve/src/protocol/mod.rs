//! The protocols: parsing of requests and encoding of answers, as pure functions.
//!
//! | protocol | request | answer | pose |
//! | --- | --- | --- | --- |
//! | [`Ascii`](Protocol::Ascii) | a line | a line of fields | any convention |
//! | [`Binary`](Protocol::Binary) | 20 to 80 bytes | 256 bytes | conventions of up to seven numbers |
//! | [`Eki`](Protocol::Eki) | an XML element | an XML element | KUKA |
//! | [`UrScript`](Protocol::UrScript) | a line | a list of numbers in parentheses | Universal Robots |
//!
//! `docs/guide/robots_that_ask.md` describes them in full. They stay compatible: a new field is appended, or uses reserved
//! space.
//!
//! Sources: KUKA, *Ethernet KRL 2.1*, for the elements that EKI reads and writes; Universal Robots, *Script manual*,
//! `socket_read_ascii_float`, for the list of numbers. None of this has been tested on a controller.

mod ascii;
pub(super) mod bad_request;
pub(super) mod binary;
mod eki;
mod line;
mod urscript;

use self::bad_request::BadRequest;
use super::answer::Answer;
use super::request::{Request, ServoRequest};
use robot::{Convention, calibration::CELL_DISTANCES};

/// A protocol between client and server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    /// Lines of text, for PLCs.
    Ascii,
    /// Frames of fixed length, for PLCs.
    Binary(ByteOrder),
    /// XML as read and written by KUKA's option package Ethernet KRL.
    Eki,
    /// Lists of numbers, as read by a Universal Robots program.
    UrScript,
}

/// Byte order of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// Least significant byte first, as in PCs and most controllers.
    Little,
    /// Most significant byte first, as in Siemens S7.
    Big,
}

impl Protocol {
    /// Every protocol and byte order.
    pub const ALL: [Self; 5] = [
        Self::Ascii,
        Self::Binary(ByteOrder::Little),
        Self::Binary(ByteOrder::Big),
        Self::Eki,
        Self::UrScript,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ascii => "ascii",
            Self::Binary(ByteOrder::Little) => "binary",
            Self::Binary(ByteOrder::Big) => "binary-be",
            Self::Eki => "eki",
            Self::UrScript => "urscript",
        }
    }

    /// The convention that the protocol prescribes; none if it has to be chosen.
    pub fn own_convention(self) -> Option<Convention> {
        match self {
            Self::Ascii | Self::Binary(_) => None,
            Self::Eki => Some(Convention::Kuka),
            Self::UrScript => Some(Convention::UniversalRobots),
        }
    }

    /// Parses the request at the start of the bytes received so far; a pose in it is in this convention.
    pub fn parse(self, bytes: &[u8], convention: Convention) -> Parsed {
        match self {
            Self::Ascii | Self::UrScript => line::parse(bytes, convention),
            Self::Binary(order) => binary::parse(bytes, convention, order),
            Self::Eki => eki::parse(bytes),
        }
    }

    /// Encodes an answer, with its pose in this convention.
    pub fn write(self, answer: &Answer, convention: Convention) -> Vec<u8> {
        match self {
            Self::Ascii => ascii::write(answer, convention).into_bytes(),
            Self::Binary(order) => binary::write(answer, convention, order),
            Self::Eki => eki::write(answer).into_bytes(),
            Self::UrScript => urscript::write(answer).into_bytes(),
        }
    }
}

/// The request of a robot at rest whose flange has the pose of these numbers.
fn servo_request(
    part: u32,
    is_start: bool,
    numbers: &[f64],
    convention: Convention,
) -> Result<Request, BadRequest> {
    let bad = |why: String| BadRequest::BadPose { why };
    let read = convention.read(numbers);
    let robot_from_flange = read.map_err(|error| bad(error.to_string()))?;
    let [least, most] = CELL_DISTANCES;
    let distance = robot_from_flange.translation.vector.norm();
    if !(least.0..=most.0).contains(&distance) {
        return Err(bad(format!("it is {distance:.3} m from the base's origin")));
    }
    Ok(Request::Servo(ServoRequest {
        part,
        is_start,
        robot_from_flange,
    }))
}

/// The result of parsing the start of a client's bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct Parsed {
    /// Number of bytes at the start that were used up.
    pub used: usize,
    /// The request, or why the bytes are none; `None` if it is incomplete.
    pub request: Option<Result<Request, BadRequest>>,
}

impl Parsed {
    /// More bytes are needed after this much filler, which is skipped.
    fn skipped(used: usize) -> Self {
        Self {
            used,
            request: None,
        }
    }

    /// A request in the first `used` bytes, or why they are none.
    fn read(used: usize, request: Result<Request, BadRequest>) -> Self {
        Self {
            used,
            request: Some(request),
        }
    }

    /// The bytes cannot become a request.
    fn bad(why: BadRequest) -> Self {
        Self::read(0, Err(why))
    }
}

/// True for bytes allowed between requests: line ends, blanks, and the zeros with which PLCs pad texts.
fn is_filler(byte: u8) -> bool {
    byte == 0 || byte.is_ascii_whitespace()
}

/// Maximum length of a message in an answer, characters.
const MAX_MESSAGE_CHARS: usize = 200;

/// End of a text that was too long.
const ELLIPSIS: &str = "...";

/// Makes a text safe for every controller: printable ASCII without field separators. If it is too long, it ends at a word,
/// with an ellipsis.
fn plain(text: &str, max_letters: usize) -> String {
    let text = text.replace('°', " deg");
    let letters = text.chars().map(|c| match c {
        ';' => ',',
        ' '..='~' => c,
        _ => '?',
    });
    let mut shown: String = letters.take(max_letters + 1).collect();
    if shown.len() > max_letters {
        let room = max_letters.saturating_sub(ELLIPSIS.len());
        // All letters are ASCII by now. A word that takes up half of the room is cut.
        let words = shown[..=room].rfind(' ').filter(|end| *end > room / 2);
        shown.truncate(words.unwrap_or(room));
        shown.push_str(ELLIPSIS);
    }
    shown
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use proptest::prelude::*;

    use super::*;
    use crate::answer::{CameraState, FrameFacts, Problem, RackPlace, VerdictCode};

    /// An answer without a pose whose other fields are as awkward as possible.
    pub(super) fn refused() -> Answer {
        Answer {
            request: Some(Request::TRIGGER),
            verdict: VerdictCode::Refused,
            sequence: 41,
            boot: 1_234_567,
            age_ms: Some(215),
            camera: CameraState::Running,
            part: "front_door".into(),
            number: 3,
            marks: Answer::SIMULATED,
            problem: Problem {
                reason: "low_score".into(),
                message: format!(
                    "it scores; <0.5> & \"less\"\r\nthan 90 % at 3°, {}",
                    "ü".repeat(500)
                ),
            },
            ..Answer::default()
        }
    }

    /// The answer before a rack with places, about a part at the one with this number, or at none.
    fn in_rack(answer: &Answer, number: Option<u32>) -> Answer {
        let name = String::from("left hook");
        Answer {
            place: number.map(|number| RackPlace { number, name }),
            facts: Arc::new(FrameFacts {
                empty_places: Some(Vec::new()),
                ..FrameFacts::default()
            }),
            ..answer.clone()
        }
    }

    #[test]
    fn before_a_rack_the_number_of_the_place_is_behind_everything_else() {
        let pose = geometry::rigid::from_euler_zyx([0.4, -0.2, 1.3, 1.2, -0.4, 1.9]);
        let accepted = Answer {
            verdict: VerdictCode::Accepted,
            pose: Some(pose),
            problem: Problem::default(),
            ..refused()
        };
        for (answer, place) in [
            (&accepted, Some(2)),
            (&refused(), Some(8)),
            (&refused(), None),
        ] {
            let placed = in_rack(answer, place);
            let number = place.unwrap_or(0);
            let text = |protocol: Protocol, answer: &Answer| {
                let convention = protocol.own_convention().unwrap_or(Convention::Abb);
                String::from_utf8(protocol.write(answer, convention)).expect("text")
            };
            let [before, after] = [answer, &placed].map(|one| text(Protocol::Ascii, one));
            let before = before.trim_end_matches('\n');
            assert_eq!(after, format!("{before};{number}\n"));
            let [before, after] = [answer, &placed].map(|one| text(Protocol::Eki, one));
            let before = before.trim_end_matches("</Partsight>\n");
            assert_eq!(
                after,
                format!("{before}<Place>{number}</Place></Partsight>\n")
            );
            let [before, after] = [answer, &placed].map(|one| text(Protocol::UrScript, one));
            let list = |text: &str| {
                let (count, rest) = text[1..].split_once(", ").expect("a list");
                (count.parse::<usize>().expect("a count"), rest.to_owned())
            };
            let ((count, rest), more) = (list(&before), list(&after));
            let rest = rest.trim_end_matches(")\n");
            assert_eq!(more, (count + 1, format!("{rest}, {number})\n")));
            for order in [ByteOrder::Little, ByteOrder::Big] {
                let frame = |answer| Protocol::Binary(order).write(answer, Convention::Abb);
                let (mut before, after) = (frame(answer), frame(&placed));
                let end = before.len() - 4;
                let at = if order == ByteOrder::Little { 42 } else { 43 };
                before[at] = number as u8;
                assert_eq!(before[..end], after[..end]);
            }
        }
    }

    #[test]
    fn names_are_as_many_as_protocols() {
        let names: std::collections::BTreeSet<_> = Protocol::ALL
            .iter()
            .map(|protocol| protocol.name())
            .collect();
        assert_eq!(names.len(), Protocol::ALL.len());
    }

    #[test]
    fn a_text_of_an_answer_is_one_line_of_printable_letters() {
        let shown = plain(&refused().problem.message, MAX_MESSAGE_CHARS);
        assert_eq!(shown.len(), MAX_MESSAGE_CHARS);
        assert!(shown.starts_with("it scores, <0.5> & \"less\"??than 90 % at 3 deg, ????"));
    }

    #[test]
    fn a_text_that_is_too_long_ends_at_a_word() {
        for (max_letters, expected) in [
            (24, "Clear the table and look"),
            (23, "Clear the table and..."),
            (22, "Clear the table and..."),
            (21, "Clear the table..."),
        ] {
            let shown = plain("Clear the table and look", max_letters);
            assert_eq!(shown, expected);
        }
        assert_eq!(plain(&"x".repeat(300), 9), "xxxxxx...");
    }

    proptest! {
        /// For any bytes: no panic, no more bytes used than there are, and no more kept than a request can have.
        #[test]
        fn any_bytes_are_a_request_or_refused_and_never_pile_up(
            bytes in proptest::collection::vec(any::<u8>(), 0..2000)
        ) {
            for protocol in Protocol::ALL {
                let mut rest = bytes.as_slice();
                for _ in 0..=bytes.len() {
                    let Parsed { used, request } = protocol.parse(rest, Convention::Abb);
                    prop_assert!(used <= rest.len());
                    match request {
                        Some(Ok(_)) => prop_assert!(used > 0),
                        Some(Err(_)) => break,
                        None if used == 0 => {
                            prop_assert!(rest.len() <= 600, "{} bytes kept by {}", rest.len(), protocol.name());
                            break;
                        }
                        None => {}
                    }
                    rest = &rest[used..];
                }
            }
        }

        /// A request that comes in pieces is read as if it came whole.
        #[test]
        fn a_request_in_pieces_is_read_when_it_is_whole(cut in 0_usize..100) {
            let wanted = Request::Path { point: 3, sequence: Some(41) };
            let element = b"<Robot><Request>PATH</Request><Point>3</Point><Sequence>41</Sequence></Robot>";
            let requests: [(Protocol, Vec<u8>); 5] = [
                (Protocol::Ascii, b"PATH 3 41\r\n".to_vec()),
                (Protocol::UrScript, b"path 3 41\n".to_vec()),
                (Protocol::Eki, element.to_vec()),
                (Protocol::Binary(ByteOrder::Little), binary::request(&wanted, ByteOrder::Little)),
                (Protocol::Binary(ByteOrder::Big), binary::request(&wanted, ByteOrder::Big)),
            ];
            for (protocol, bytes) in requests {
                let cut = cut % bytes.len();
                let parse = |bytes: &[u8]| protocol.parse(bytes, Convention::Abb);
                let begun = parse(&bytes[..cut]);
                // Either half of CR LF ends a line.
                if protocol == Protocol::Ascii && cut + 1 == bytes.len() {
                    continue;
                }
                prop_assert_eq!(begun.request, None, "{} of {}", cut, protocol.name());
                let whole = parse(&bytes);
                prop_assert_eq!(whole.request, Some(Ok(wanted.clone())));
            }
        }
    }

    #[test]
    fn nothing_in_an_answer_without_a_pose_is_a_number_of_one() {
        // A pose that would be noticed: the digits of its numbers appear nowhere else.
        let with_pose = Answer {
            verdict: VerdictCode::Accepted,
            pose: Some(geometry::rigid::from_euler_zyx([
                0.1, 0.2, 0.3, 1.117, 1.118, 1.119,
            ])),
            ..refused()
        };
        for protocol in [Protocol::Ascii, Protocol::Eki, Protocol::UrScript] {
            let convention = protocol.own_convention().unwrap_or(Convention::Fanuc);
            let text = |answer: &Answer| {
                String::from_utf8(protocol.write(answer, convention)).expect("text")
            };
            let shows = |text: &str| {
                ["1117", "1118", "1119", "1.117", "1.118", "1.119"]
                    .iter()
                    .any(|number| text.contains(number))
            };
            assert!(shows(&text(&with_pose)), "{}", text(&with_pose));
            assert!(!shows(&text(&refused())), "{}", text(&refused()));
        }
    }
}
