//! The server for robots and PLCs, tested over real sockets on the loopback address with an inspector that needs no
//! camera.
//!
//! Requests are written and answers parsed here according to the guide, not with the program's own functions.

use std::{
    collections::{BTreeSet, VecDeque},
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::{SocketAddr, TcpStream},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};

use geometry::rigid::RigidTransform;
use robot::Convention;
use serve::{
    Answer, Asked, CameraState, CameraStatus, ClientEvent, ClientNews, Found, FrameParts,
    ListenAddress, Listener, PathStep, Problem, Server, ServerSettings, VerdictCode,
    fixtures::{self, RunningServer},
};

/// Timeout with room for a busy machine; what is awaited normally comes at once.
const PATIENCE: Duration = Duration::from_mins(2);

/// Every protocol, at any free port.
const ALL: [&str; 5] = ["ascii=0", "binary=0", "binary-be=0", "eki=0", "urscript=0"];

/// An accepted part with a path.
fn accepted(number: u32) -> Found {
    let step = |x, marks, speed| PathStep {
        robot_from_nozzle: RigidTransform::translation(x, 0.25, 1.5),
        marks,
        speed,
    };
    Found {
        path: vec![
            step(0.007, Answer::GUN_ON, Some(0.25)),
            step(0.008, 0, None),
        ],
        ..fixtures::accepted(number)
    }
}

fn refused(number: u32) -> Found {
    fixtures::refused(accepted(number))
}

/// A running server.
struct Service {
    addresses: Vec<SocketAddr>,
    camera: Arc<Mutex<CameraStatus>>,
    events: Arc<Mutex<Vec<ClientEvent>>>,
    server: RunningServer,
}

impl Service {
    fn start<F: Into<FrameParts>>(
        listen: &[&str],
        settings: ServerSettings,
        mut find: impl FnMut(u32) -> F + Send + 'static,
    ) -> Self {
        let listeners = listen.iter().map(|text| {
            let at: ListenAddress = text.parse().expect("an address");
            Listener::new(at, Some(Convention::Fanuc)).expect("spoken")
        });
        let listeners: Vec<Listener> = listeners.collect();
        let camera = Arc::new(Mutex::new(CameraStatus {
            state: CameraState::Running,
            problem: None,
        }));
        let events = Arc::new(Mutex::new(Vec::new()));
        let (of_clients, reply) = (Arc::clone(&camera), Arc::clone(&events));
        let server = Server::start(
            &listeners,
            settings,
            move || of_clients.lock().expect("whole").clone(),
            move |event| reply.lock().expect("whole").push(event),
        )
        .expect("started");
        let addresses = server.addresses().iter().map(|at| at.address).collect();
        let find = move |number, asked: &Asked| {
            assert!(asked.at <= Instant::now());
            find(number).into()
        };
        Self {
            addresses,
            camera,
            events,
            server: RunningServer::start(server, find, drop),
        }
    }

    fn robot(&self, place: usize) -> Robot {
        Robot::connect(self.addresses[place], ALL[place])
    }

    fn wait_for(&self, news: impl Fn(&ClientNews) -> bool) {
        wait_until(|| {
            let events = self.events.lock().expect("whole");
            events.iter().any(|event| news(&event.news))
        });
    }
}

fn wait_until(what: impl Fn() -> bool) {
    let until = Instant::now() + PATIENCE;
    while !what() {
        assert!(Instant::now() < until, "it took too long");
        thread::sleep(Duration::from_millis(5));
    }
}

/// An answer as a robot reads it.
#[derive(Clone, Debug, Default, PartialEq)]
struct Reply {
    verdict: u32,
    sequence: u32,
    boot: u32,
    age_ms: i64,
    camera: u32,
    flags: u32,
    number: u32,
    point: u32,
    points: u32,
    speed_mm_s: f64,
    /// Numbers of the pose; the first three in millimetres.
    numbers: Vec<f64>,
    /// Empty if the protocol has no texts.
    part: String,
    reason: String,
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

fn place_of(word: &str, words: &[&str]) -> u32 {
    let place = words.iter().position(|other| *other == word);
    place.unwrap_or_else(|| panic!("{word}")) as u32
}

/// A client that speaks one of the protocols.
struct Robot {
    protocol: String,
    stream: BufReader<TcpStream>,
}

impl Robot {
    fn connect(address: SocketAddr, listen: &str) -> Self {
        let stream = TcpStream::connect(address).expect("connected");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        stream.set_write_timeout(Some(PATIENCE)).expect("set");
        let protocol = listen.split('=').next().expect("a protocol");
        Self {
            protocol: protocol.to_owned(),
            stream: BufReader::new(stream),
        }
    }

    fn send(&mut self, bytes: &[u8]) {
        self.stream.get_mut().write_all(bytes).expect("sent");
    }

    fn ask(&mut self, word: &str) -> Reply {
        self.ask_point(word, 0)
    }

    fn ask_point(&mut self, word: &str, point: u32) -> Reply {
        let bytes = request(&self.protocol, word, point);
        self.send(&bytes);
        self.reply()
    }

    /// Asks for a point of the path, or a part, of the inspection with this number.
    fn ask_of(&mut self, sequence: u32, word: &str, number: u32) -> Reply {
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

    fn reply(&mut self) -> Reply {
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
    fn is_let_go(&mut self) -> bool {
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

fn request(protocol: &str, word: &str, point: u32) -> Vec<u8> {
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
fn frame(protocol: &str, word: &str, numbers: &[u32]) -> Vec<u8> {
    let words = ["TRIGGER", "STATUS", "LAST", "PATH", "PART", "SERVO"];
    let code = place_of(word, &words) + 1;
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
        verdict: place_of(fields[1], &VERDICTS),
        sequence: number(2) as u32,
        boot: number(3) as u32,
        age_ms: number(4),
        camera: place_of(fields[5], &CAMERAS),
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

fn assert_at(reply: &Reply, expected: [f64; 3]) {
    assert_eq!(reply.numbers.len(), 6, "{reply:?}");
    for (found, expected) in reply.numbers.iter().zip(expected) {
        assert!((found - expected).abs() < 2e-3, "{reply:?}");
    }
    assert_eq!(reply.flags & 1, 1);
}

fn assert_no_numbers(reply: &Reply) {
    assert!(reply.numbers.is_empty(), "{reply:?}");
    assert_eq!((reply.flags & 1, reply.points), (0, 0), "{reply:?}");
}

#[test]
fn every_protocol_triggers_asks_again_and_fetches_the_path() {
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    for place in 0..ALL.len() {
        let mut robot = service.robot(place);
        let has_texts = robot.protocol != "urscript";
        let triggered = robot.ask("TRIGGER");
        let sequence = place as u32 + 1;
        assert_eq!(
            (triggered.verdict, triggered.sequence, triggered.camera),
            (1, sequence, 1)
        );
        assert_at(&triggered, [f64::from(sequence), 250.0, 1500.0]);
        assert_eq!((triggered.number, triggered.points), (4, 2));
        assert_eq!(triggered.flags, u32::from(Answer::POSE | Answer::SIMULATED));
        assert_eq!(triggered.part, if has_texts { "fender" } else { "" });
        assert!((0..600_000).contains(&triggered.age_ms));
        let again = robot.ask("LAST");
        assert_eq!(again.numbers, triggered.numbers);
        assert_eq!(
            (again.sequence, again.boot),
            (triggered.sequence, triggered.boot)
        );
        assert!(again.boot > 0 && again.age_ms >= triggered.age_ms);
        let status = robot.ask("STATUS");
        assert_eq!((status.verdict, status.sequence), (1, sequence));
        assert!(status.numbers.is_empty());
        let count = robot.ask_point("PATH", 0);
        assert_eq!((count.points, count.point), (2, 0));
        assert!(count.numbers.is_empty());
        let first = robot.ask_point("PATH", 1);
        assert_at(&first, [7.0, 250.0, 1500.0]);
        assert_eq!(
            (first.point, first.points, first.sequence),
            (1, 2, sequence)
        );
        assert!((first.speed_mm_s - 250.0).abs() < 1e-9);
        assert_eq!(first.flags & u32::from(Answer::GUN_ON), 8);
        let second = robot.ask_point("PATH", 2);
        assert_at(&second, [8.0, 250.0, 1500.0]);
        assert_eq!(second.flags & u32::from(Answer::GUN_ON), 0);
        let beyond = robot.ask_point("PATH", 3);
        assert_eq!((beyond.verdict, beyond.flags & 1), (7, 0));
        assert!(beyond.numbers.is_empty());
    }
    assert_eq!(service.server.num_inspected(), 5);
}

#[test]
fn a_refused_part_and_a_stale_pose_have_no_numbers() {
    let service = Service::start(&ALL, ServerSettings::default(), refused);
    let never_fresh = ServerSettings {
        max_age: Duration::ZERO,
        ..ServerSettings::default()
    };
    let old = |number| Found {
        captured: Instant::now().checked_sub(Duration::from_secs(1)),
        ..accepted(number)
    };
    let stale = Service::start(&ALL, never_fresh, old);
    for (service, verdict, reason) in [(&service, 2, "low_score"), (&stale, 4, "stale")] {
        for place in 0..ALL.len() {
            let mut robot = service.robot(place);
            for (word, point) in [
                ("TRIGGER", 0),
                ("LAST", 0),
                ("STATUS", 0),
                ("PATH", 0),
                ("PATH", 1),
            ] {
                let reply = robot.ask_point(word, point);
                assert_eq!(reply.verdict, verdict, "{} {word}", robot.protocol);
                assert_eq!(reply.sequence, place as u32 + 1);
                assert_no_numbers(&reply);
                if robot.protocol != "urscript" {
                    assert_eq!(reply.reason, reason);
                }
            }
        }
    }
}

/// The parts of the frame with this number: 2, 8, none, and an accepted one beside a refused one.
fn several(frame: u32) -> FrameParts {
    let all = |num| (1..=num).map(|part| accepted(1000 * frame + part));
    let parts: Vec<Found> = match frame % 4 {
        1 => all(2).collect(),
        2 => all(8).collect(),
        3 => vec![Found {
            verdict: VerdictCode::NoPart,
            part: String::new(),
            ..refused(0)
        }],
        _ => vec![accepted(1000 * frame + 1), refused(2)],
    };
    let mut parts = parts.into_iter();
    FrameParts {
        first: parts.next().expect("one at least"),
        others: parts.collect(),
    }
}

#[test]
fn every_protocol_gives_the_parts_of_a_frame_one_by_one_and_a_trigger_the_first() {
    let service = Service::start(&ALL, ServerSettings::default(), several);
    let mut frame = 0;
    let mut next_sequence = 1;
    for place in 0..ALL.len() {
        let mut robot = service.robot(place);
        let none = robot.ask_point("PART", 1);
        assert_eq!((none.verdict, none.numbers.len()), (7, 0), "not triggered");
        for num_parts in [2, 8, 0, 2] {
            frame += 1;
            let triggered = robot.ask("TRIGGER");
            assert_eq!(triggered.sequence, next_sequence);
            let count = robot.ask_point("PART", 0);
            assert_eq!((count.point, count.points), (0, num_parts));
            assert_eq!(count.verdict, triggered.verdict);
            assert!(count.numbers.is_empty());
            for part in 1..=num_parts {
                let sequence = next_sequence + part - 1;
                let own = robot.ask_point("PART", part);
                assert_eq!((own.point, own.points), (part, num_parts));
                assert_eq!(own.sequence, sequence);
                // As from any of the numbers of its frame.
                let named = robot.ask_of(next_sequence + num_parts - 1, "PART", part);
                assert_eq!(named.numbers, own.numbers);
                let point = robot.ask_of(sequence, "PATH", 1);
                assert_eq!(point.sequence, sequence);
                if frame % 4 == 0 && part == 2 {
                    assert_eq!((own.verdict, own.numbers.len()), (2, 0), "refused");
                    assert_eq!((point.verdict, point.numbers.len()), (2, 0));
                } else {
                    let x = f64::from(1000 * frame + part);
                    assert_at(&own, [x, 250.0, 1500.0]);
                    assert_at(&point, [7.0, 250.0, 1500.0]);
                }
            }
            if num_parts > 0 {
                assert_at(&triggered, [f64::from(1000 * frame + 1), 250.0, 1500.0]);
            }
            let beyond = robot.ask_point("PART", num_parts + 1);
            assert_eq!((beyond.verdict, beyond.numbers.len()), (7, 0));
            assert_eq!(beyond.sequence, next_sequence);
            if robot.protocol != "urscript" {
                assert_eq!(beyond.reason, "no_such_part");
            }
            assert_eq!(robot.ask("LAST").numbers, triggered.numbers);
            next_sequence += num_parts.max(1);
        }
    }
}

#[test]
fn of_ten_thousand_triggers_by_several_clients_none_is_lost_or_answered_twice() {
    const CLIENTS: usize = 8;
    const EACH: usize = 1250;
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    let reply: Vec<Reply> = thread::scope(|scope| {
        let service = &service;
        let clients = (0..CLIENTS).map(|client| {
            scope.spawn(move || {
                let mut robot = service.robot(client % ALL.len());
                (0..EACH).map(|_| robot.ask("TRIGGER")).collect::<Vec<_>>()
            })
        });
        // Start all of them before waiting for the first.
        let clients: Vec<_> = clients.collect();
        let reply = clients
            .into_iter()
            .map(|client| client.join().expect("served"));
        let reply: Vec<Vec<Reply>> = reply.collect();
        for of_one in &reply {
            assert!(of_one.is_sorted_by(|a, b| a.sequence < b.sequence));
        }
        reply.into_iter().flatten().collect()
    });
    for reply in &reply {
        assert_eq!(reply.verdict, 1);
        assert_at(reply, [f64::from(reply.sequence), 250.0, 1500.0]);
    }
    let sequences: BTreeSet<u32> = reply.iter().map(|reply| reply.sequence).collect();
    assert!(sequences.into_iter().eq(1..=10_000));
    assert_eq!(service.server.num_inspected(), 10_000);
}

#[test]
fn triggers_wait_in_their_order_and_a_status_does_not() {
    let (begun, has_begun) = mpsc::channel();
    let (go_on, may_go_on) = mpsc::channel::<()>();
    let find = move |number| {
        begun.send(number).expect("awaited");
        may_go_on.recv().expect("released");
        accepted(number)
    };
    let service = Service::start(&["ascii=0"], ServerSettings::default(), find);
    let [mut first, mut second, mut other] = [0; 3].map(|place| service.robot(place));
    first.send(b"TRIGGER\n");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(1));
    second.send(b"TRIGGER\n");
    let status = other.ask("STATUS");
    assert_eq!((status.verdict, status.sequence, status.age_ms), (0, 0, -1));
    go_on.send(()).expect("awaited");
    assert_eq!(first.reply().sequence, 1);
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(2));
    assert_eq!(other.ask("LAST").sequence, 1);
    go_on.send(()).expect("awaited");
    assert_eq!(second.reply().sequence, 2);
}

/// Sets the flag when dropped, to end the threads that watch it.
struct EndAtLast<'a>(&'a AtomicBool);

impl Drop for EndAtLast<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

#[test]
fn hostile_clients_do_not_disturb_a_good_one() {
    let settings = ServerSettings {
        max_clients: 24,
        request_timeout: Duration::from_millis(200),
        ..ServerSettings::default()
    };
    let service = Service::start(&ALL, settings, accepted);
    // They connect before any other client does.
    let mut good: Vec<Robot> = (0..ALL.len()).map(|place| service.robot(place)).collect();
    for robot in &mut good {
        assert_eq!(robot.ask("STATUS").verdict, 0);
    }
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        for (i, address) in service.addresses.iter().enumerate() {
            let address = *address;
            let is_over = &is_over;
            // The server may do anything with a hostile client: it continues with a new connection.
            let attack = move |bytes: &[u8], num: usize| {
                while !is_over.load(Ordering::SeqCst) {
                    thread::sleep(Duration::from_millis(1));
                    let Ok(mut stream) = TcpStream::connect(address) else {
                        continue;
                    };
                    let _ = stream.set_write_timeout(Some(Duration::from_millis(50)));
                    let _ = stream.set_read_timeout(Some(Duration::from_millis(50)));
                    for _ in 0..num {
                        if stream.write_all(bytes).is_err() {
                            break;
                        }
                    }
                    let mut answer = [0; 64];
                    let _ = stream.read(&mut answer);
                }
            };
            let protocol = ALL[i].split('=').next().expect("a protocol");
            let half = request(protocol, "LAST", 0)[..3].to_vec();
            // Half a request, meaningless bytes, and a gigabyte without a line end.
            scope.spawn(move || attack(&half, 1));
            scope.spawn(move || attack(&[0xff, 0x00, 0x80, b'<', b'R', b'\n'], 100));
            scope.spawn(move || attack(&vec![b'A'; 65_536], 16_384));
        }
        // Ends the attacks even if a good client fails.
        let _end = EndAtLast(&is_over);
        for round in 0..40 {
            for robot in &mut good {
                let reply = robot.ask("TRIGGER");
                assert_eq!(reply.verdict, 1, "round {round}: {reply:?}");
                assert_at(&reply, [f64::from(reply.sequence), 250.0, 1500.0]);
            }
        }
    });
    assert_eq!(service.server.num_inspected(), 200);
    // The places of the hostile clients become free again.
    for place in 0..ALL.len() {
        wait_until(|| {
            let mut robot = service.robot(place);
            robot.ask("STATUS").verdict != 6
        });
    }
}

#[test]
fn a_thousand_connections_leave_the_good_one_alone_and_get_an_answer() {
    let settings = ServerSettings {
        max_clients: 2,
        ..ServerSettings::default()
    };
    let service = Service::start(&ALL, settings, accepted);
    let mut good = service.robot(0);
    let mut other = service.robot(1);
    assert_eq!(good.ask("TRIGGER").sequence, 1);
    assert_eq!(other.ask("LAST").sequence, 1);
    for i in 0..1000 {
        let mut robot = service.robot(i % ALL.len());
        if i % 100 < ALL.len() {
            let reply = robot.reply();
            assert_eq!(
                (reply.verdict, reply.sequence),
                (6, 0),
                "{}",
                robot.protocol
            );
            assert_no_numbers(&reply);
            assert!(robot.is_let_go());
        }
    }
    assert_eq!(good.ask("TRIGGER").sequence, 2);
    service.wait_for(|news| *news == ClientNews::TurnedAway);
    drop(other);
    wait_until(|| {
        let mut robot = service.robot(0);
        robot.ask("LAST").sequence == 2
    });
}

#[test]
fn of_a_gigabyte_without_an_end_hardly_anything_is_read() {
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    for place in 0..ALL.len() {
        let mut robot = service.robot(place);
        let stream = robot.stream.get_mut();
        let chunk = vec![b'A'; 65_536];
        let chunks = (0..16_384).take_while(|_| stream.write_all(&chunk).is_ok());
        let num_taken = chunks.count();
        // What both sides of the connection buffer, and what the server discards so that the client can read why.
        assert!(num_taken < 1024, "{}: {num_taken}", robot.protocol);
        assert_eq!(service.robot(place).ask("TRIGGER").verdict, 1);
    }
}

#[test]
fn a_thousand_silent_connections_make_room_for_others() {
    /// Connections that are open at a time: systems allow a program about a thousand.
    const HELD: usize = 500;
    let settings = ServerSettings {
        max_clients: 4,
        request_timeout: PATIENCE,
        ..ServerSettings::default()
    };
    let service = Service::start(&ALL, settings, accepted);
    let mut kept = service.robot(0);
    assert_eq!(kept.ask("TRIGGER").sequence, 1);
    let mut silent = VecDeque::new();
    for i in 0..1000 {
        let mut robot = service.robot(i % ALL.len());
        // Every second one sends half a request.
        if i % 2 == 0 {
            let half = request(&robot.protocol, "TRIGGER", 0)[..3].to_vec();
            robot.send(&half);
        }
        silent.push_back(robot);
        if silent.len() > HELD {
            silent.pop_front();
        }
        if i % 100 == 99 {
            assert_eq!(kept.ask("LAST").verdict, 1);
        }
    }
    // Until the silent connections have been there for a moment, there is no place.
    let connected = |place| {
        let until = Instant::now() + PATIENCE;
        loop {
            let mut robot = service.robot(place);
            if robot.ask("LAST").verdict != 6 {
                return robot;
            }
            assert!(Instant::now() < until, "there is no place");
            thread::sleep(Duration::from_millis(20));
        }
    };
    for place in 0..ALL.len() {
        let reply = connected(place).ask("TRIGGER");
        assert_eq!((reply.verdict, reply.sequence), (1, place as u32 + 2));
    }
    assert_eq!(kept.ask("TRIGGER").sequence, ALL.len() as u32 + 2);
    // Whoever has sent a request keeps its place.
    let others = [1, 2, 3].map(connected);
    assert_eq!(service.robot(4).reply().verdict, 6);
    assert_eq!(others.map(|mut robot| robot.ask("LAST").verdict), [1; 3]);
    assert_eq!(kept.ask("LAST").verdict, 1);
}

#[test]
fn a_bad_request_is_answered_with_its_reason_and_the_connection_closed() {
    let settings = ServerSettings {
        request_timeout: Duration::from_millis(50),
        ..ServerSettings::default()
    };
    let service = Service::start(&ALL, settings, accepted);
    let mut version = request("binary", "TRIGGER", 0);
    version[4] = 9;
    let mut checksum = request("binary-be", "TRIGGER", 0);
    checksum[19] ^= 1;
    for (place, bytes, reason) in [
        (0, b"START\n".to_vec(), "unknown_request"),
        (0, vec![b'A'; 5000], "too_long"),
        (0, b"TRIG".to_vec(), "incomplete"),
        (1, b"GET / HTTP/1.1\r\n\r\n".to_vec(), "magic"),
        (1, version, "version"),
        (2, checksum, "checksum"),
        (
            2,
            request("binary-be", "TRIGGER", 0)[..19].to_vec(),
            "incomplete",
        ),
        (3, b"TRIGGER\n".to_vec(), "not_xml"),
        (
            3,
            b"<Robot><Request>TRIGGER</Request>".to_vec(),
            "incomplete",
        ),
        (4, b"PATH x\n".to_vec(), "no_point"),
        (0, b"SERVO 3 1200 -400\n".to_vec(), "bad_pose"),
        (0, [b"SERVO 3", &[b' '; 600][..]].concat(), "too_long"),
        (0, b"SERVO 3 1200 -400 1900 0".to_vec(), "incomplete"),
        (1, frame("binary", "SERVO", &[3]), "length"),
        (1, frame("binary", "SERVO", &[3; 15]), "bad_pose"),
        (2, frame("binary-be", "SERVO", &[u32::MAX; 15]), "bad_pose"),
        (
            3,
            b"<Robot><Request>SERVO</Request><Expected>3</Expected></Robot>".to_vec(),
            "bad_pose",
        ),
        (4, b"SERVO 3 p[nan,0,0,0,0,0]\n".to_vec(), "bad_pose"),
    ] {
        let mut robot = service.robot(place);
        robot.send(&bytes);
        let reply = robot.reply();
        assert_eq!(reply.verdict, 7, "{reason}");
        assert_no_numbers(&reply);
        if robot.protocol != "urscript" {
            assert_eq!(reply.reason, reason);
        }
        assert!(robot.is_let_go(), "{reason}");
        // The client may connect again.
        assert_eq!(service.robot(place).ask("LAST").verdict, 0);
    }
    assert_eq!(service.server.num_inspected(), 0);
    service.wait_for(|news| matches!(news, ClientNews::BadRequest(_)));
}

#[test]
fn a_server_that_moves_no_robot_says_so_and_the_connection_stays_open() {
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    let mut robot = service.robot(0);
    robot.send(b"SERVO 3 1200 -400 1900 0 0 0\n");
    let mut line = String::new();
    robot.stream.read_line(&mut line).expect("a line");
    assert!(line.starts_with("SERVO;error;1;"), "{line}");
    assert!(line.contains(";no_servoing;"), "{line}");
    assert_eq!(line.matches(';').count(), 23, "{line}");
    // It is no inspection that anyone asks for.
    assert_eq!(robot.ask("LAST").verdict, 0);
    let triggered = robot.ask("TRIGGER");
    assert_eq!((triggered.verdict, triggered.sequence), (1, 2));
}

#[test]
fn a_request_in_pieces_and_several_at_once_are_answered_one_by_one() {
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    for place in 0..ALL.len() {
        let mut robot = service.robot(place);
        let protocol = robot.protocol.clone();
        let before = robot.ask("LAST").sequence;
        for byte in request(&protocol, "TRIGGER", 0) {
            robot.send(&[byte]);
        }
        assert_eq!(robot.reply().sequence, before + 1);
        let three = request(&protocol, "TRIGGER", 0).repeat(3);
        robot.send(&three);
        for i in 2..=4 {
            assert_eq!(robot.reply().sequence, before + i);
        }
    }
}

#[test]
fn a_client_that_asks_for_nothing_is_let_go() {
    let settings = ServerSettings {
        idle_timeout: Duration::from_millis(50),
        ..ServerSettings::default()
    };
    let service = Service::start(&["ascii=0"], settings, accepted);
    assert!(service.robot(0).is_let_go());
    service.wait_for(|news| *news == ClientNews::Left);
}

#[test]
fn a_camera_that_is_lost_is_an_error_and_the_next_trigger_may_succeed() {
    let problem = Problem {
        reason: "camera_lost".into(),
        message: "the camera is gone (to do: Plug it in)".into(),
    };
    let lost = problem.clone();
    let find = move |number| match number {
        2 => Found::error(lost.clone()),
        3 => panic!("no ray for this pixel"),
        _ => accepted(number),
    };
    let service = Service::start(&["ascii=0"], ServerSettings::default(), find);
    let mut robot = service.robot(0);
    assert_eq!(robot.ask("TRIGGER").verdict, 1);
    *service.camera.lock().expect("whole") = CameraStatus {
        state: CameraState::Lost,
        problem: Some(problem),
    };
    let status = robot.ask("STATUS");
    assert_eq!((status.verdict, status.camera), (1, 2));
    assert_eq!(status.reason, "camera_lost");
    for (sequence, reason) in [(2, "camera_lost"), (3, "fault")] {
        let reply = robot.ask("TRIGGER");
        assert_eq!(
            (reply.verdict, reply.sequence, reply.age_ms),
            (5, sequence, -1)
        );
        assert_eq!(reply.reason, reason);
        assert_no_numbers(&reply);
        assert_eq!(robot.ask("LAST").verdict, 5);
    }
    *service.camera.lock().expect("whole") = CameraStatus {
        state: CameraState::Running,
        problem: None,
    };
    let reply = robot.ask("TRIGGER");
    assert_eq!((reply.verdict, reply.sequence, reply.camera), (1, 4, 1));
}

#[test]
fn whichever_side_starts_again_the_other_goes_on() {
    let mut service = Service::start(&["ascii=0"], ServerSettings::default(), accepted);
    let mut robot = service.robot(0);
    let reply = robot.ask("TRIGGER");
    // The robot restarts before it has read the answer.
    robot.send(b"TRIGGER\n");
    wait_until(|| service.server.num_inspected() == 2);
    drop(robot);
    let mut robot = service.robot(0);
    let last = robot.ask("LAST");
    assert_eq!(last.boot, reply.boot);
    assert!((1..=2).contains(&last.sequence));
    // The server restarts at the same port.
    let address = format!("ascii={}", service.addresses[0]);
    service.server.end();
    assert!(robot.is_let_go());
    let service = Service::start(&[address.as_str()], ServerSettings::default(), accepted);
    let mut robot = service.robot(0);
    let none = robot.ask("LAST");
    assert_eq!((none.verdict, none.sequence), (0, 0));
    assert_no_numbers(&none);
    assert_eq!(robot.ask("TRIGGER").sequence, 1);
}

#[test]
fn who_waits_when_the_service_ends_is_told_so() {
    let (begun, has_begun) = mpsc::channel();
    let (go_on, may_go_on) = mpsc::channel::<()>();
    let find = move |number| {
        begun.send(number).expect("awaited");
        may_go_on.recv().expect("released");
        accepted(number)
    };
    let mut service = Service::start(&["ascii=0"], ServerSettings::default(), find);
    let [mut first, mut second] = [0; 2].map(|place| service.robot(place));
    first.send(b"TRIGGER\n");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(1));
    second.send(b"TRIGGER\n");
    service.server.ask_to_end();
    go_on.send(()).expect("awaited");
    // Its inspection had begun.
    assert_eq!(first.reply().sequence, 1);
    // There is no line if the server ended before it read the request.
    let mut line = String::new();
    let _ = second.stream.read_line(&mut line);
    assert!(line.is_empty() || line.contains(";stopping;"), "{line}");
    service.server.end();
}

#[test]
fn a_client_reads_the_path_of_its_own_trigger_or_of_one_that_it_names() {
    // The path of each inspection is another one.
    let find = |number| {
        let mut found = accepted(number);
        found.path[0].robot_from_nozzle =
            RigidTransform::translation(f64::from(number) / 100.0, 0.25, 1.5);
        found
    };
    let service = Service::start(&ALL, ServerSettings::default(), find);
    let assert_of = |reply: &Reply, sequence: u32| {
        assert_eq!((reply.verdict, reply.sequence), (1, sequence), "{reply:?}");
        assert_at(reply, [f64::from(sequence) * 10.0, 250.0, 1500.0]);
    };
    for place in 0..ALL.len() {
        let [mut first, mut second, mut third] = [0; 3].map(|_| service.robot(place));
        let own = first.ask("TRIGGER").sequence;
        let others = second.ask("TRIGGER").sequence;
        assert_eq!(others, own + 1);
        assert_of(&first.ask_point("PATH", 1), own);
        assert_of(&second.ask_point("PATH", 1), others);
        assert_of(&first.ask_of(others, "PATH", 1), others);
        // One that has not triggered, or that has connected again, has to say which one it means.
        for point in [0, 1] {
            let reply = third.ask_point("PATH", point);
            assert_eq!((reply.verdict, reply.sequence), (7, 0), "{reply:?}");
            assert_no_numbers(&reply);
            if third.protocol != "urscript" {
                assert_eq!((&*reply.reason, &*reply.part), ("no_trigger", ""));
            }
        }
        drop(first);
        assert_of(&third.ask_of(own, "PATH", 1), own);
        assert_eq!(third.ask_of(own, "PATH", 0).points, 2);
        let never = third.ask_of(1000, "PATH", 1);
        assert_eq!(never.verdict, 7, "{never:?}");
        assert_no_numbers(&never);
        if third.protocol != "urscript" {
            assert_eq!(never.reason, "no_such_inspection");
        }
        // The connection stays open, and the next trigger's path is another one.
        let next = third.ask("TRIGGER").sequence;
        assert_of(&third.ask_point("PATH", 1), next);
        assert_of(&second.ask_point("PATH", 1), others);
    }
}

#[test]
fn triggers_of_clients_that_have_gone_are_not_inspected() {
    let (begun, has_begun) = mpsc::channel();
    let (go_on, may_go_on) = mpsc::channel::<()>();
    let find = move |number| {
        begun.send(number).expect("awaited");
        may_go_on.recv().expect("released");
        accepted(number)
    };
    let service = Service::start(&ALL, ServerSettings::default(), find);
    let [mut first, mut second, mut half] = [0; 3].map(|place| service.robot(place));
    first.send(b"TRIGGER\n");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(1));
    for i in 0..10 {
        let mut gone = service.robot(i % ALL.len());
        let bytes = request(&gone.protocol, "TRIGGER", 0);
        gone.send(&bytes);
    }
    // It has ended its side only, and learns why it gets no pose.
    half.send(b"TRIGGER\n");
    let ended = half.stream.get_ref().shutdown(std::net::Shutdown::Write);
    ended.expect("shut down");
    second.send(b"TRIGGER\n");
    for _ in 0..2 {
        go_on.send(()).expect("awaited");
    }
    assert_eq!(first.reply().sequence, 1);
    assert_eq!(second.reply().sequence, 2);
    let reply = half.reply();
    assert_eq!(
        (reply.verdict, &*reply.reason),
        (5, "withdrawn"),
        "{reply:?}"
    );
    assert_no_numbers(&reply);
    let mut last = service.robot(0);
    go_on.send(()).expect("awaited");
    assert_eq!(last.ask("TRIGGER").sequence, 3);
    assert_eq!(service.server.num_inspected(), 3);
}
