//! A robot that asks, and what it reads.

use super::*;

/// An answer as a robot reads it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Reply {
    pub(crate) verdict: u32,
    pub(crate) sequence: u32,
    pub(crate) boot: u32,
    pub(crate) age_ms: i64,
    pub(crate) camera: u32,
    pub(crate) flags: u32,
    pub(crate) number: u32,
    pub(crate) point: u32,
    pub(crate) points: u32,
    pub(crate) speed_mm_s: f64,
    /// Numbers of the pose; the first three in millimetres.
    pub(crate) numbers: Vec<f64>,
    /// Empty if the protocol has no texts.
    pub(crate) part: String,
    pub(crate) reason: String,
}

const VERDICTS: [&str; 11] = [
    "none",
    "accepted",
    "refused",
    "no_part",
    "stale",
    "error",
    "full",
    "bad_request",
    "move",
    "done",
    "stay",
];
const CAMERAS: [&str; 4] = ["opening", "running", "lost", "over"];

fn index_of(word: &str, words: &[&str]) -> u32 {
    let index = words.iter().position(|other| *other == word);
    index.unwrap_or_else(|| panic!("{word}")) as u32
}

/// A client that speaks one of the protocols.
pub(crate) struct Robot {
    pub(crate) protocol: String,
    pub(crate) stream: BufReader<TcpStream>,
}

impl Robot {
    pub(crate) fn connect(address: SocketAddr, listen: &str) -> Self {
        let stream = TcpStream::connect(address).expect("connected");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        stream.set_write_timeout(Some(PATIENCE)).expect("set");
        let protocol = listen.split('=').next().expect("a protocol");
        Self {
            protocol: protocol.to_owned(),
            stream: BufReader::new(stream),
        }
    }

    pub(crate) fn send(&mut self, bytes: &[u8]) {
        self.stream.get_mut().write_all(bytes).expect("sent");
    }

    pub(crate) fn ask(&mut self, word: &str) -> Reply {
        self.ask_point(word, 0)
    }

    pub(crate) fn ask_point(&mut self, word: &str, point: u32) -> Reply {
        let bytes = request(&self.protocol, word, point);
        self.send(&bytes);
        self.reply()
    }

    /// Asks for a point of the path, or a part, of the inspection with this number.
    pub(crate) fn ask_of(&mut self, sequence: u32, word: &str, number: u32) -> Reply {
        let bytes = match self.protocol.as_str() {
            "ascii" | "urscript" => format!("{word} {number} {sequence}\n").into_bytes(),
            "eki" => format!(
                "<Robot><Request>{word}</Request><Point>{number}</Point><Sequence>{sequence}</Sequence></Robot>"
            )
            .into_bytes(),
            protocol => frame(protocol, word, &[number, sequence]),
        };
        self.send(&bytes);
        self.reply()
    }

    pub(crate) fn reply(&mut self) -> Reply {
        if self.protocol.starts_with("binary") {
            let mut frame = [0; 256];
            self.stream.read_exact(&mut frame).expect("a frame");
            return reply_in_frame(&frame, self.protocol == "binary-be");
        }
        let mut line = String::new();
        self.stream.read_line(&mut line).expect("a line");
        let line = line.strip_suffix('\n').expect("a whole line");
        match self.protocol.as_str() {
            "ascii" => reply_in_fields(line),
            "eki" => reply_in_xml(line),
            _ => reply_in_list(line),
        }
    }

    /// True once the server has closed the connection.
    pub(crate) fn is_let_go(&mut self) -> bool {
        let mut rest = Vec::new();
        match self.stream.read_to_end(&mut rest) {
            Ok(_) => rest.is_empty(),
            // Reset, because the server had not read all bytes.
            Err(error) => error.kind() == std::io::ErrorKind::ConnectionReset,
        }
    }
}

/// CRC-32 bit by bit, as ISO 3309 defines it.
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            let is_odd = crc & 1 == 1;
            crc >>= 1;
            if is_odd {
                crc ^= 0xedb8_8320;
            }
        }
    }
    !crc
}

pub(crate) fn request(protocol: &str, word: &str, point: u32) -> Vec<u8> {
    match protocol {
        "ascii" | "urscript" if matches!(word, "PATH" | "PART") => {
            format!("{word} {point}\n").into_bytes()
        }
        "ascii" | "urscript" => format!("{word}\n").into_bytes(),
        "eki" => {
            format!("<Robot><Request>{word}</Request><Point>{point}</Point></Robot>").into_bytes()
        }
        _ => frame(protocol, word, &[point]),
    }
}

/// A request as a binary frame with these numbers.
pub(crate) fn frame(protocol: &str, word: &str, numbers: &[u32]) -> Vec<u8> {
    let words = ["TRIGGER", "STATUS", "LAST", "PATH", "PART", "SERVO"];
    let code = index_of(word, &words) + 1;
    let mut frame = b"PSRQ".to_vec();
    let is_big = protocol == "binary-be";
    let mut put = |value: u32, num_bytes: usize| {
        let little = value.to_le_bytes();
        let bytes = little[..num_bytes].iter();
        if is_big {
            frame.extend(bytes.rev());
        } else {
            frame.extend(bytes);
        }
    };
    put(1, 2);
    put(16 + 4 * numbers.len() as u32, 2);
    put(code, 2);
    put(0, 2);
    for number in numbers {
        put(*number, 4);
    }
    let checksum = crc32(&frame);
    let checksum = if is_big {
        checksum.to_be_bytes()
    } else {
        checksum.to_le_bytes()
    };
    frame.extend(checksum);
    frame
}

fn reply_in_frame(frame: &[u8; 256], is_big: bool) -> Reply {
    let whole = |at: usize, num_bytes: usize| {
        let bytes = &frame[at..at + num_bytes];
        let add = |sum: u64, byte: &u8| (sum << 8) | u64::from(*byte);
        if is_big {
            bytes.iter().fold(0, add)
        } else {
            bytes.iter().rev().fold(0, add)
        }
    };
    let number = |at, num_bytes| whole(at, num_bytes) as u32;
    let real = |at| f64::from_bits(whole(at, 8));
    let text = |at: usize, num_bytes: usize| {
        let text = String::from_utf8(frame[at..at + num_bytes].to_vec()).expect("text");
        text.trim_end_matches('\0').to_owned()
    };
    assert_eq!(frame[..4], *b"PSAN");
    assert_eq!([number(4, 2), number(6, 2)], [1, 256]);
    assert_eq!(number(252, 4), crc32(&frame[..252]));
    let num = number(40, 2) as usize;
    let numbers: Vec<f64> = (0..7).map(|i| real(56 + 8 * i)).collect();
    assert!(numbers[num..].iter().all(|number| number.to_bits() == 0));
    Reply {
        verdict: number(10, 2),
        boot: number(12, 4),
        sequence: number(16, 4),
        age_ms: i64::from(number(20, 4).cast_signed()),
        camera: number(24, 2),
        flags: number(26, 2),
        number: number(28, 4),
        point: number(32, 4),
        points: number(36, 4),
        speed_mm_s: real(48),
        numbers: numbers[..num].to_vec(),
        part: text(112, 64),
        reason: text(176, 24),
    }
}

fn reply_in_fields(line: &str) -> Reply {
    let fields: Vec<&str> = line.split(';').collect();
    assert_eq!(fields.len(), 20, "{line}");
    let number = |i: usize| fields[i].parse::<i64>().expect("a whole number");
    let numbers = fields[12..18].iter().filter(|field| !field.is_empty());
    Reply {
        verdict: index_of(fields[1], &VERDICTS),
        sequence: number(2) as u32,
        boot: number(3) as u32,
        age_ms: number(4),
        camera: index_of(fields[5], &CAMERAS),
        part: fields[6].into(),
        number: number(7) as u32,
        flags: number(8) as u32,
        point: number(9) as u32,
        points: number(10) as u32,
        speed_mm_s: fields[11].parse().unwrap_or(0.0),
        numbers: numbers
            .map(|field| field.parse().expect("a number"))
            .collect(),
        reason: fields[18].into(),
    }
}

fn reply_in_xml(line: &str) -> Reply {
    let between = |begin: &str, end: &str| {
        let rest = line.split_once(begin).map(|(_, rest)| rest);
        rest.and_then(|rest| rest.split_once(end))
            .map(|(content, _)| content.to_owned())
    };
    let text = |tag: &str| between(&format!("<{tag}>"), &format!("</{tag}>")).expect(tag);
    let number = |tag: &str| text(tag).parse::<i64>().expect("a whole number");
    assert!(line.starts_with("<Partsight>") && line.ends_with("</Partsight>"));
    let numbers = between("<Pose ", "/>").map_or_else(Vec::new, |frame| {
        let attributes = frame.split(' ').zip(["X", "Y", "Z", "A", "B", "C"]);
        let attributes = attributes.map(|(attribute, name)| {
            let (found, value) = attribute.split_once('=').expect("an attribute");
            assert_eq!(found, name);
            value.trim_matches('"').parse().expect("a number")
        });
        attributes.collect()
    });
    let verdict = number("Code") as u32;
    assert_eq!(VERDICTS[verdict as usize], text("Verdict"));
    Reply {
        verdict,
        sequence: number("Sequence") as u32,
        boot: number("Boot") as u32,
        age_ms: number("Age"),
        camera: number("Camera") as u32,
        flags: number("Flags") as u32,
        number: number("Number") as u32,
        point: number("Point") as u32,
        points: number("Points") as u32,
        speed_mm_s: text("Speed").parse().expect("a number"),
        numbers,
        part: text("Part"),
        reason: text("Reason"),
    }
}

fn reply_in_list(line: &str) -> Reply {
    let inner = line
        .strip_prefix('(')
        .and_then(|line| line.strip_suffix(')'));
    let list = inner.expect("parentheses").split(',');
    let list: Vec<f64> = list
        .map(|number| number.trim().parse().expect("a number"))
        .collect();
    assert_eq!(list[0] as usize, list.len() - 1);
    assert!(matches!(list.len(), 11 | 17), "{line}");
    let number = |i: usize| list[i] as u32;
    // The other protocols send millimetres.
    let numbers = list[11..].iter().enumerate();
    let numbers = numbers.map(|(i, number)| if i < 3 { number * 1000.0 } else { *number });
    Reply {
        verdict: number(1),
        sequence: number(2),
        boot: number(3),
        age_ms: list[4] as i64,
        camera: number(5),
        flags: number(6),
        number: number(7),
        point: number(8),
        points: number(9),
        speed_mm_s: list[10],
        numbers: numbers.collect(),
        part: String::new(),
        reason: String::new(),
    }
}

pub(crate) fn assert_at(reply: &Reply, expected: [f64; 3]) {
    assert_eq!(reply.numbers.len(), 6, "{reply:?}");
    for (found, expected) in reply.numbers.iter().zip(expected) {
        assert!((found - expected).abs() < 2e-3, "{reply:?}");
    }
    assert_eq!(reply.flags & 1, 1);
}

pub(crate) fn assert_no_numbers(reply: &Reply) {
    assert!(reply.numbers.is_empty(), "{reply:?}");
    assert_eq!((reply.flags & 1, reply.points), (0, 0), "{reply:?}");
}
