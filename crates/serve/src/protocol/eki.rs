//! XML as read and written by KUKA's option package Ethernet KRL (EKI).
//!
//! ```text
//! <Robot><Request>TRIGGER</Request><Point>0</Point></Robot>
//!
//! <Partsight><Request>TRIGGER</Request><Verdict>accepted</Verdict><Code>1</Code>…<Pose X="1200.500" …/>…</Partsight>
//! ```
//!
//! Only the form that EKI sends with the guide's configuration is read, not every equivalent XML: no comments or references, and
//! attributes of the pose and the count alone. The pose is an element of EKI's type FRAME; without a pose it is missing.

use std::time::Duration;

use super::{
    MAX_MESSAGE_CHARS, Parsed,
    ascii::{figure, name_of},
    bad_request::BadRequest,
    is_filler,
    line::{age_in, expected_in, named, number_in, number_of_count, of_name, real_in, words_of},
    plain, servo_request,
};
use crate::answer::Answer;
use crate::request::{AskedOrder, Request};
use robot::Convention;

/// Maximum length of a request, bytes, with room for an XML declaration and line breaks.
const MAX_REQUEST_BYTES: usize = 512;
const END: &[u8] = b"</Robot>";

pub(super) fn parse(bytes: &[u8]) -> Parsed {
    let start = bytes.iter().position(|&byte| !is_filler(byte));
    let Some(start) = start else {
        return Parsed::skipped(bytes.len());
    };
    let text = &bytes[start..];
    if text[0] != b'<' {
        let shown = &text[..text.len().min(MAX_REQUEST_BYTES)];
        return Parsed::bad(BadRequest::not_xml(shown));
    }
    let searched = &text[..text.len().min(MAX_REQUEST_BYTES)];
    let end = searched.windows(END.len()).position(|part| part == END);
    match end {
        Some(end) => {
            let end = end + END.len();
            Parsed::read(start + end, request(&text[..end]))
        }
        None if text.len() < MAX_REQUEST_BYTES => Parsed::skipped(start),
        None => Parsed::bad(BadRequest::TooLong {
            limit: MAX_REQUEST_BYTES,
        }),
    }
}

fn request(bytes: &[u8]) -> Result<Request, BadRequest> {
    let wrong = || BadRequest::not_xml(bytes);
    let text = std::str::from_utf8(bytes).ok().ok_or_else(wrong)?;
    let text = match text.strip_prefix("<?xml") {
        Some(rest) => rest.split_once("?>").ok_or_else(wrong)?.1.trim_start(),
        None => text,
    };
    let inner = text
        .strip_prefix("<Robot>")
        .and_then(|text| text.strip_suffix("</Robot>"))
        .ok_or_else(wrong)?;
    let elements = Elements::read(inner).ok_or_else(wrong)?;
    let word = elements.get("Request").ok_or_else(wrong)?;
    let age = elements.count_age().ok_or_else(wrong)?.as_bytes();
    // EKI sends every element with every request, also with those that do not take it.
    let of = |name| elements.text(name).as_bytes();
    let filled = |tag| Some(of(tag)).filter(|number| !number.is_empty());
    let request = of_name(word.as_bytes()).ok_or_else(|| BadRequest::unknown(word.as_bytes()))?;
    if let Request::Servo(_) = request {
        let is_start = number_in(filled("Start").unwrap_or(b"0"))? != 0;
        let names = Convention::Kuka.names().iter();
        let numbers = names.map(|name| real_in(elements.pose_attribute(name).as_bytes()));
        let numbers = numbers.collect::<Result<Vec<f64>, _>>()?;
        return servo_request(
            number_in(of("Expected"))?,
            is_start,
            &numbers,
            Convention::Kuka,
        );
    }
    if let Request::Trigger { .. } = request {
        let expected = words_of(of("Expected")).map(expected_in);
        let request = Request::expecting(expected.collect::<Result<Vec<_>, _>>()?);
        let request = request.ok_or_else(|| BadRequest::unknown(bytes))?;
        let count = filled(COUNT).map(number_of_count).transpose()?;
        let age = match (count, age) {
            (_, []) => Duration::ZERO,
            (Some(_), age) => age_in(age)?,
            (None, age) => return Err(BadRequest::no_number(age)),
        };
        let text = |name| unescaped(elements.text(name));
        let order = AskedOrder::new(&text("Order"), &text("Serial"));
        let order = order.ok_or_else(|| BadRequest::bad_order(bytes))?;
        let request = request.at_count(count).read_before(age).of_order(order);
        return request.ok_or(BadRequest::OrderAndParts);
    }
    let numbers: Vec<&[u8]> = match request {
        Request::Path { .. } | Request::Part { .. } => {
            match (filled("Point"), filled("Sequence")) {
                (point, None) => point.into_iter().collect(),
                (point, Some(sequence)) => vec![point.unwrap_or(b"0"), sequence],
            }
        }
        Request::Trigger { .. } | Request::Status | Request::Last | Request::Servo(_) => Vec::new(),
    };
    let numbered = named(word.as_bytes(), numbers.into_iter());
    numbered.ok_or_else(|| BadRequest::unknown(bytes))?
}

/// The characters that are written as entities.
const ENTITIES: [(char, &str); 5] = [
    ('<', "&lt;"),
    ('>', "&gt;"),
    ('"', "&quot;"),
    ('\'', "&apos;"),
    ('&', "&amp;"),
];

fn unescaped(text: &str) -> String {
    let entities = ENTITIES.iter();
    entities.fold(text.to_owned(), |text, (letter, entity)| {
        text.replace(entity, letter.encode_utf8(&mut [0; 4]))
    })
}

/// The elements that a request may have, each once.
const ELEMENTS: [&str; 9] = [
    "Request", "Point", "Sequence", "Expected", "Order", "Serial", COUNT, "Start", POSE,
];
/// Those with attributes.
const COUNT: &str = "Count";
const POSE: &str = "Pose";

/// The elements of a request: name, attributes and text. One that cannot be read makes the request wrong, since what it asks
/// for must not be left out.
struct Elements<'a>(Vec<(&'a str, &'a str, &'a str)>);

impl<'a> Elements<'a> {
    fn read(inner: &'a str) -> Option<Self> {
        let mut elements = Self(Vec::new());
        let mut rest = inner.trim();
        while !rest.is_empty() {
            let (tag, after) = rest.strip_prefix('<')?.split_once('>')?;
            let (tag, is_empty) = match tag.strip_suffix('/') {
                Some(tag) => (tag, true),
                None => (tag, false),
            };
            let tag = tag.trim_end();
            let blank = |c: char| c.is_ascii_whitespace();
            let (name, attributes) = tag.split_once(blank).unwrap_or((tag, ""));
            let is_new = elements.0.iter().all(|(other, ..)| *other != name);
            let may_have = attributes.is_empty() || name == COUNT || name == POSE;
            if !(ELEMENTS.contains(&name) && is_new && may_have) {
                return None;
            }
            let (text, after) = if is_empty {
                ("", after)
            } else {
                let (text, after) = after.split_once("</")?;
                let end = after.strip_prefix(name)?.trim_start().strip_prefix('>')?;
                (text.trim(), end)
            };
            if text.contains('<') {
                return None;
            }
            elements.0.push((name, attributes, text));
            rest = after.trim_start();
        }
        Some(elements)
    }

    /// The text of an element, if it has that.
    fn get(&self, name: &str) -> Option<&'a str> {
        let mut elements = self.0.iter();
        let element = elements.find(|(found, ..)| *found == name);
        element.map(|(.., text)| *text)
    }

    /// The text of an element; empty if it is missing.
    fn text(&self, name: &str) -> &'a str {
        self.get(name).unwrap_or_default()
    }

    /// What is written as the age of the count; empty if nothing is, and `None` if the count has any other attribute.
    fn count_age(&self) -> Option<&'a str> {
        let count = self.0.iter().find(|(found, ..)| *found == COUNT);
        let attributes = count.map_or("", |(_, attributes, _)| attributes.trim());
        if attributes.is_empty() {
            return Some("");
        }
        let value = attributes.strip_prefix("Age")?.trim_start();
        let value = value.strip_prefix('=')?.trim_start();
        let value = value.strip_prefix('"')?.strip_suffix('"')?;
        (!value.contains('"')).then(|| value.trim())
    }

    /// An attribute of the pose; empty if it is missing.
    fn pose_attribute(&self, name: &str) -> &'a str {
        let mut elements = self.0.iter();
        let pose = elements.find(|(found, ..)| *found == POSE);
        let mut pairs = pose.map_or("", |(_, attributes, _)| attributes).split('"');
        while let (Some(found), Some(value)) = (pairs.next(), pairs.next()) {
            if found.trim().strip_suffix('=').map(str::trim) == Some(name) {
                return value.trim();
            }
        }
        ""
    }
}

pub(super) fn write(answer: &Answer) -> String {
    let elements = [
        (
            "Request",
            answer.request.as_ref().map_or("NONE", name_of).to_owned(),
        ),
        ("Verdict", answer.verdict.name().to_owned()),
        ("Code", answer.verdict.code().to_string()),
        ("Sequence", answer.sequence.to_string()),
        ("Boot", answer.boot.to_string()),
        ("Age", answer.age_or_none().to_string()),
        ("Camera", answer.camera.code().to_string()),
        ("Part", escaped(&answer.part)),
        ("Number", answer.number.to_string()),
        ("Flags", answer.flags().to_string()),
        ("Point", answer.point.to_string()),
        ("Points", answer.points.to_string()),
        ("Speed", format!("{:.1}", answer.speed_mm_s.unwrap_or(0.0))),
        ("Reason", escaped(&answer.problem.reason)),
        ("Message", escaped(&answer.problem.message)),
    ];
    let elements = elements.map(|(tag, content)| format!("<{tag}>{content}</{tag}>"));
    let pose = answer.pose.as_ref().map(|pose| {
        let values = Convention::Kuka.write(pose).values;
        let numbers = values.iter();
        let numbers = numbers.map(|value| format!("{}=\"{}\"", value.name, value.rounded()));
        format!("<Pose {}/>", numbers.collect::<Vec<_>>().join(" "))
    });
    let on_line = answer.on_line.map(|on_line| {
        let (count, since) = (on_line.count.unwrap_or(0), answer.on_line_since_or_none());
        format!(
            "<Line Number=\"{}\" Count=\"{}\" Since=\"{since}\" Bound=\"{:.2}\" Speed=\"{:.2}\"/>",
            on_line.number,
            count.cast_signed(),
            on_line.bound_mm,
            on_line.speed_mm_s
        )
    });
    let error = answer.servo_error.map(|error| {
        let tags = ["Error", "ErrorTurn", "Bound", "BoundTurn"].into_iter();
        let figures = tags.zip(error.figures().map(figure));
        let elements = figures.map(|(tag, figure)| format!("<{tag}>{figure}</{tag}>"));
        elements.collect::<String>()
    });
    let place = answer.place_number();
    let place = place.map(|number| format!("<Place>{number}</Place>"));
    let further = [pose, on_line, error, place].map(Option::unwrap_or_default);
    format!(
        "<Partsight>{}{}</Partsight>\n",
        elements.concat(),
        further.concat()
    )
}

fn escaped(text: &str) -> String {
    // The sign that begins an entity comes first.
    let entities = ENTITIES.iter().rev();
    entities.fold(plain(text, MAX_MESSAGE_CHARS), |text, (letter, entity)| {
        text.replace(*letter, entity)
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::{
        answer::{Problem, RemainingError, VerdictCode},
        protocol::tests::refused,
        request::{ExpectedNumber, ServoRequest},
    };
    use geometry::{
        rigid::{PoseDelta, RigidTransform, from_euler_zyx, pose_error},
        units::{Metres, Radians},
    };

    fn only(text: &str) -> Result<Request, BadRequest> {
        let parsed = parse(text.as_bytes());
        parsed
            .request
            .unwrap_or_else(|| panic!("{text:?} is whole"))
    }

    /// The text between an element's tags.
    fn content_of<'a>(text: &'a str, tag: &str) -> Option<&'a str> {
        let (_, rest) = text.split_once(&format!("<{tag}>"))?;
        Some(rest.split_once(&format!("</{tag}>"))?.0)
    }

    #[test]
    fn a_request_is_read_as_eki_sends_it() {
        for (text, request) in [
            (
                "<Robot><Request>TRIGGER</Request><Point>0</Point></Robot>",
                Request::TRIGGER,
            ),
            (
                "<Robot><Point>4</Point><Request>PATH</Request></Robot>",
                Request::path(4, 0),
            ),
            (
                "<Robot><Request>PATH</Request><Point>4</Point><Sequence>41</Sequence></Robot>",
                Request::path(4, 41),
            ),
            (
                "<Robot><Request>PATH</Request><Point>4</Point><Sequence>0</Sequence></Robot>",
                Request::path(4, 0),
            ),
            (
                "<Robot><Request>TRIGGER</Request><Expected></Expected><Count>-7</Count></Robot>",
                Request::TRIGGER.at_count(Some(u32::MAX - 6)),
            ),
            (
                "<Robot><Request>TRIGGER</Request><Count Age=\"40\">-7</Count></Robot>",
                Request::TRIGGER
                    .at_count(Some(u32::MAX - 6))
                    .read_before(Duration::from_millis(40)),
            ),
            (
                "<Robot><Request>TRIGGER</Request><Count Age = \"\" >7</Count></Robot>",
                Request::TRIGGER.at_count(Some(7)),
            ),
            (
                "<Robot><Request>TRIGGER</Request><Count Age=\"\"/></Robot>",
                Request::TRIGGER,
            ),
            (
                "<Robot><Request>STATUS</Request><Count Age=\"40\">9</Count></Robot>",
                Request::Status,
            ),
            (
                "<Robot><Request>LAST</Request><Point>0</Point><Sequence>0</Sequence></Robot>",
                Request::Last,
            ),
            (
                "<Robot><Request>TRIGGER</Request><Expected>2=3 5</Expected></Robot>",
                Request::expecting([3, 5].map(|part| ExpectedNumber {
                    part,
                    place: if part == 3 { 2 } else { 0 },
                }))
                .expect("two"),
            ),
            (
                "<Robot><Request>PATH</Request></Robot>",
                Request::path(0, 0),
            ),
            ("<Robot><Request>LAST</Request></Robot>", Request::Last),
            (
                "\r\n<?xml version=\"1.0\"?>\r\n<Robot>\r\n  <Request> STATUS </Request>\r\n  <Point>7</Point>\r\n</Robot>",
                Request::Status,
            ),
        ] {
            assert_eq!(only(text), Ok(request), "{text}");
        }
        let two =
            b"<Robot><Request>LAST</Request></Robot>\r\n<Robot><Request>STATUS</Request></Robot>";
        let first = parse(two);
        assert_eq!((first.used, first.request), (38, Some(Ok(Request::Last))));
        assert_eq!(parse(&two[38..]).request, Some(Ok(Request::Status)));
    }

    #[test]
    fn a_robot_that_servoes_sends_its_flange_as_attributes_and_gets_the_error_behind_the_pose() {
        let pose = "<Pose X=\"1200.0\" Y=\"-400.0\" Z=\"1900.0\" A=\"0.0\" B=\"0\" C=\"0\"";
        let servo = |rest: &str| format!("<Robot><Request>SERVO</Request>{rest}</Robot>");
        let request = ServoRequest {
            part: 3,
            is_start: false,
            robot_from_flange: RigidTransform::translation(1.2, -0.4, 1.9),
        };
        for end in ["/>", "></Pose>"] {
            let text = servo(&format!(
                "<Expected>3</Expected><Start>0</Start>{pose}{end}"
            ));
            assert_eq!(only(&text), Ok(Request::Servo(request)), "{text}");
        }
        let is_start = true;
        let text = servo(&format!("{pose}/><Start>1</Start><Expected>3</Expected>"));
        let starts = Request::Servo(ServoRequest {
            is_start,
            ..request
        });
        assert_eq!(only(&text), Ok(starts));
        for (rest, reason) in [
            ("<Expected>3</Expected>".to_owned(), "bad_pose"),
            (
                "<Expected>3</Expected><Pose X=\"1200\"/>".into(),
                "bad_pose",
            ),
            ("<Expected>3</Expected><Pose X=\"\"\"/>".into(), "bad_pose"),
            (format!("{pose}/>"), "no_point"),
            (format!("<Expected>2=3</Expected>{pose}/>"), "no_point"),
            (
                format!("<Start>x</Start><Expected>3</Expected>{pose}/>"),
                "no_point",
            ),
        ] {
            let text = servo(&rest);
            assert_eq!(only(&text).expect_err(&text).reason(), reason, "{text}");
        }
        let answer = Answer {
            request: Some(Request::Servo(request)),
            verdict: VerdictCode::Move,
            pose: Some(request.robot_from_flange),
            servo_error: Some(RemainingError {
                error: PoseDelta {
                    shift: Metres(0.0875),
                    rotation: Radians::from_degrees(4.25),
                },
                bounds: None,
            }),
            ..refused()
        };
        let text = write(&answer);
        assert!(
            text.contains("<Code>8</Code>") && text.contains("<Pose X=\"1200.000\""),
            "{text}"
        );
        let end = "/><Error>87.5000</Error><ErrorTurn>4.2500</ErrorTurn><Bound>0.0000</Bound><BoundTurn>0.0000</BoundTurn></Partsight>\n";
        assert!(text.ends_with(end), "{text}");
    }

    #[test]
    fn a_trigger_may_name_an_order_and_a_serial_number() {
        let trigger = |rest: &str| format!("<Robot><Request>TRIGGER</Request>{rest}</Robot>");
        let asked = |order: &str, serial: &str| {
            let asked = AskedOrder::new(order, serial).expect("plain");
            Request::TRIGGER.of_order(asked).expect("no parts")
        };
        for (rest, request) in [
            ("<Order>4711</Order>", asked("4711", "")),
            (
                "<Order> A 17; 5 </Order><Serial>TL-1</Serial>",
                asked("A 17; 5", "TL-1"),
            ),
            (
                "<Order>A &amp;lt; &lt;b&gt;</Order>",
                asked("A &lt; <b>", ""),
            ),
            ("<Order></Order><Serial/>", Request::TRIGGER),
            (
                "<Serial>TL-1</Serial><Count>7</Count><Expected>0</Expected>",
                asked("", "TL-1").at_count(Some(7)),
            ),
        ] {
            let text = trigger(rest);
            assert_eq!(only(&text), Ok(request), "{text}");
        }
        for rest in [
            "<Order>4711</Order><Expected>3</Expected>",
            "<Order>a\u{7}b</Order>",
        ] {
            let text = trigger(rest);
            assert_eq!(
                only(&text).expect_err(&text).reason(),
                "bad_order",
                "{text}"
            );
        }
        assert_eq!(
            only(&trigger("<Order >4711</Order >")),
            Ok(asked("4711", ""))
        );
        for rest in [
            "<Order type=\"s\">4711</Order>",
            "<Order>4711</Serial>",
            "<Order>4711",
            "<order>4711</order>",
            "<Exp>3</Exp>",
            "<Expected></Expected><Expected>3</Expected>",
            "<X><Order>4711</Order></X>",
            "<Order><X>4711</X></Order>",
            "<!--<Expected>7</Expected>-->",
            "<Count x=\"1\">7</Count>",
            "<Count Age=40>7</Count>",
            "<Count Age=\"40\" x=\"1\">7</Count>",
            "<Count Age=\"4\" Age=\"5\">7</Count>",
            "<Count AgeX=\"4\">7</Count>",
            "<Request>STATUS</Request>",
            "4711",
        ] {
            let text = trigger(rest);
            assert_eq!(only(&text).expect_err(&text).reason(), "not_xml", "{text}");
        }
        for words in ["ORDER=4711", "SERIAL=TL-1", "ENC=7"] {
            let text = trigger(&format!("<Expected>{words}</Expected>"));
            assert_eq!(only(&text).expect_err(&text).reason(), "no_point", "{text}");
        }
        for count in [
            "<Count Age=\"x\">7</Count>",
            "<Count Age=\"-1\">7</Count>",
            "<Count Age=\"10001\">7</Count>",
            "<Count Age=\"40\"></Count>",
            "<Count Age=\"40\"/>",
            "<Count>7@40</Count>",
        ] {
            let text = trigger(count);
            assert_eq!(only(&text).expect_err(&text).reason(), "no_point", "{text}");
        }
        // EKI sends every element with every request.
        let status = "<Robot><Request>STATUS</Request><Order>4711</Order></Robot>";
        assert_eq!(only(status), Ok(Request::Status));
    }

    #[test]
    fn anything_else_is_refused_and_never_kept_for_long() {
        for (text, reason) in [
            ("TRIGGER\n", "not_xml"),
            ("<Robot></Robot>", "not_xml"),
            ("<Request>TRIGGER</Request></Robot>", "not_xml"),
            ("<Robot><Request>TRIGGER</Robot>", "not_xml"),
            ("<Robot><Request>GO</Request></Robot>", "unknown_request"),
            ("<Robot><Request></Request></Robot>", "unknown_request"),
            (
                "<Robot><Request>PATH</Request><Point>-3</Point></Robot>",
                "no_point",
            ),
            (
                "<Robot><Request>PATH</Request><Point>3</Point><Sequence>x</Sequence></Robot>",
                "no_point",
            ),
            ("<?xml <Robot><Request>LAST</Request></Robot>", "not_xml"),
        ] {
            assert_eq!(only(text).expect_err(text).reason(), reason, "{text}");
        }
        let mut endless = b"<Robot>".to_vec();
        endless.resize(MAX_REQUEST_BYTES, b' ');
        let refused = parse(&endless).request.expect("refused");
        assert_eq!(refused.expect_err("too long").reason(), "too_long");
        assert_eq!(parse(&endless[..MAX_REQUEST_BYTES - 1]), Parsed::skipped(0));
    }

    #[test]
    fn the_pose_is_a_frame_of_krl_and_is_missing_without_one() {
        let pose = from_euler_zyx([0.4, -0.2, 1.3, 1.2005, -0.4, 1.9]);
        let accepted = Answer {
            verdict: VerdictCode::Accepted,
            pose: Some(pose),
            problem: Problem::default(),
            ..refused()
        };
        let text = write(&accepted);
        let (_, frame) = text.split_once("<Pose ").expect("a frame");
        let (frame, _) = frame.split_once("/>").expect("its end");
        let values: Vec<&str> = frame.split('"').collect();
        let names: Vec<&str> = values.iter().step_by(2).map(|name| name.trim()).collect();
        assert_eq!(names, ["X=", "Y=", "Z=", "A=", "B=", "C=", ""]);
        let numbers = values.iter().skip(1).step_by(2);
        let numbers: Vec<f64> = numbers
            .map(|number| number.parse().expect("a number"))
            .collect();
        let read = Convention::Kuka.read(&numbers).expect("a pose");
        let off = pose_error(&read, &pose, &Point3::origin());
        assert!(off.shift.mm() < 0.01 && off.rotation.degrees() < 0.001);
        for (tag, content) in [
            ("Request", "TRIGGER"),
            ("Verdict", "accepted"),
            ("Code", "1"),
            ("Sequence", "41"),
            ("Boot", "1234567"),
            ("Age", "215"),
            ("Camera", "1"),
            ("Part", "front_door"),
            ("Number", "3"),
            ("Flags", "5"),
            ("Point", "0"),
            ("Points", "0"),
            ("Speed", "0.0"),
        ] {
            assert_eq!(content_of(&text, tag), Some(content), "{tag}");
        }
        let text = write(&refused());
        assert!(!text.contains("<Pose"), "{text}");
        assert_eq!(content_of(&text, "Code"), Some("2"));
        assert_eq!(content_of(&text, "Reason"), Some("low_score"));
        let message = content_of(&text, "Message").expect("why");
        assert!(message.starts_with("it scores, &lt;0.5&gt; &amp; &quot;less&quot;??than"));
        assert!(text.is_ascii() && text.ends_with("</Partsight>\n"));
    }
}
