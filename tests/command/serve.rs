//! `partsight serve`: the built program asked over TCP, with the simulated cell as its camera.

// Ctrl-C is sent as a signal.
#![cfg(unix)]

use std::{
    fs,
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::TcpStream,
    process::{Child, Command, Stdio},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU32, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use serde_json::Value;

use crate::workplace::{Workplace, matrix};

/// Timeout with room for a busy machine; what is awaited normally comes at once.
const PATIENCE: Duration = Duration::from_mins(5);

/// A cell whose base frame is the camera frame.
const CALIBRATE: [&str; 7] = [
    "calibrate",
    "set",
    "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1",
    "--mount",
    "eye-to-hand",
    "--out",
    "cell.toml",
];

/// A running service.
struct Service {
    child: Child,
    /// Its standard error so far.
    messages: Arc<Mutex<String>>,
    reader: Option<JoinHandle<()>>,
}

impl Service {
    fn start(place: &Workplace, args: &[&str]) -> Self {
        Self::start_into(place, args, Stdio::piped())
    }

    /// As [`Self::start`], with this standard output.
    fn start_into(place: &Workplace, args: &[&str], out: Stdio) -> Self {
        place.accepted(&CALIBRATE);
        let calibrated = ["--calibration", "cell.toml"];
        Self::start_as_it_is(place, &[&calibrated[..], args].concat(), out)
    }

    /// As [`Self::start_into`], without a calibration.
    fn start_as_it_is(place: &Workplace, args: &[&str], out: Stdio) -> Self {
        let mut child = place
            .command(&[&["serve", "--json"][..], args].concat())
            .stdout(out)
            .stderr(Stdio::piped())
            .spawn()
            .expect("starts");
        let messages = Arc::new(Mutex::new(String::new()));
        let theirs = Arc::clone(&messages);
        let stderr = BufReader::new(child.stderr.take().expect("a pipe"));
        let reader = thread::spawn(move || {
            for line in stderr.lines().map_while(Result::ok) {
                let mut messages = theirs.lock().expect("whole");
                *messages += &line;
                *messages += "\n";
            }
        });
        Self {
            child,
            messages,
            reader: Some(reader),
        }
    }

    fn messages(&self) -> String {
        self.messages.lock().expect("whole").clone()
    }

    /// A connection in this protocol.
    fn connect(&mut self, protocol: &str) -> BufReader<TcpStream> {
        let begin = format!("Listening: {protocol}=");
        let until = Instant::now() + PATIENCE;
        let address = loop {
            let messages = self.messages();
            let line = messages.lines().find_map(|line| line.strip_prefix(&begin));
            if let Some((address, _)) = line.and_then(|line| line.split_once(',')) {
                break address.to_owned();
            }
            let ended = self.child.try_wait().expect("asked");
            assert!(ended.is_none() && Instant::now() < until, "{messages}");
            thread::sleep(Duration::from_millis(20));
        };
        let stream = TcpStream::connect(address).expect("connected");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        BufReader::new(stream)
    }

    /// Where the simulated flange stands at first, in each convention that is spoken.
    fn flanges(&self, num: usize) -> Vec<String> {
        let until = Instant::now() + PATIENCE;
        loop {
            let messages = self.messages();
            let lines = messages.lines();
            let flanges = lines.filter_map(|line| line.strip_prefix("Flange: ")?.split_once(", "));
            let flanges: Vec<String> = flanges.map(|(numbers, _)| numbers.to_owned()).collect();
            if flanges.len() == num {
                return flanges;
            }
            assert!(Instant::now() < until, "{messages}");
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// Ends it as Ctrl-C does; returns its exit code, standard output and messages.
    fn interrupt(mut self) -> (Option<i32>, String, String) {
        let sent = Command::new("kill")
            .args(["-INT", &self.child.id().to_string()])
            .status();
        assert!(sent.expect("kill is there").success());
        let mut out = String::new();
        if let Some(stdout) = &mut self.child.stdout {
            stdout.read_to_string(&mut out).expect("text");
        }
        let code = self.child.wait().expect("ends").code();
        if let Some(reader) = self.reader.take() {
            reader.join().expect("read");
        }
        (code, out, self.messages())
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        // It has ended already if the test completed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn asked(stream: &mut BufReader<TcpStream>, request: &str) -> String {
    stream
        .get_mut()
        .write_all(request.as_bytes())
        .expect("sent");
    let mut line = String::new();
    stream.read_line(&mut line).expect("a line");
    line.trim_end().to_owned()
}

/// The answer to a trigger while this file is copied into the watched folder `scans` again and again: only one that is written
/// after the trigger counts.
fn asked_before(
    place: &Workplace,
    file: &str,
    robot: &mut BufReader<TcpStream>,
    request: &str,
) -> String {
    static NUM_SCANS: AtomicU32 = AtomicU32::new(0);
    let is_answered = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            for _ in 0..1000 {
                if is_answered.load(Ordering::Relaxed) {
                    break;
                }
                let number = NUM_SCANS.fetch_add(1, Ordering::Relaxed);
                fs::copy(place.path(file), place.path("new")).expect("copied");
                let scan = place.path(format!("scans/{number}.pcd"));
                fs::rename(place.path("new"), scan).expect("renamed");
                thread::sleep(Duration::from_millis(200));
            }
        });
        let answer = asked(robot, request);
        is_answered.store(true, Ordering::Relaxed);
        answer
    })
}

const EKI_TRIGGER: &str = "<Robot><Request>TRIGGER</Request><Point>0</Point></Robot>";

/// A trigger as a binary frame, little-endian; another program computed its checksum.
const BINARY_TRIGGER: [u8; 20] =
    *b"PSRQ\x01\x00\x14\x00\x01\x00\x00\x00\x00\x00\x00\x00\xdd\x81\x35\xd0";

#[test]
fn every_protocol_triggers_the_simulated_camera_and_gets_the_pose() {
    let place = Workplace::new();
    let mut service = Service::start(
        &place,
        &[
            "--source",
            "simulated,fps=5:fender",
            "--listen",
            "ascii=0",
            "--listen",
            "binary=0",
            "--listen",
            "eki=0",
            "--listen",
            "urscript=0",
            "--as",
            "kuka",
            "--number",
            "fender=7",
        ],
    );
    let line = asked(&mut service.connect("ascii"), "TRIGGER\n");
    let fields: Vec<&str> = line.split(';').collect();
    assert_eq!(fields[..3], ["TRIGGER", "accepted", "1"], "{line}");
    // The verdict of a simulated frame on the part with this number, with a pose.
    assert_eq!(fields[5..8], ["running", "fender", "7"], "{line}");
    let flags: u32 = fields[8].parse().expect("a number");
    assert_eq!(flags & 5, 5, "{line}");
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let ascii: Vec<f64> = fields[12..15].iter().map(|field| number(field)).collect();

    let mut binary = service.connect("binary");
    binary.get_mut().write_all(&BINARY_TRIGGER).expect("sent");
    let mut frame = [0; 256];
    binary.read_exact(&mut frame).expect("a frame");
    let short = |at: usize| u16::from_le_bytes([frame[at], frame[at + 1]]);
    assert_eq!((short(8), short(10), short(40)), (1, 1, 6));
    let real = |at: usize| f64::from_le_bytes(frame[at..at + 8].try_into().expect("eight"));
    let binary = [real(56), real(64), real(72)];

    let line = asked(&mut service.connect("eki"), EKI_TRIGGER);
    assert!(
        line.contains("<Code>1</Code><Sequence>3</Sequence>"),
        "{line}"
    );
    let attribute = |name: &str| {
        let rest = line.split_once(&format!("{name}=\"")).expect(name).1;
        number(rest.split('"').next().expect("a value"))
    };
    let eki = ["X", "Y", "Z"].map(attribute);

    let line = asked(&mut service.connect("urscript"), "TRIGGER\n");
    let inner = line
        .strip_prefix('(')
        .and_then(|line| line.strip_suffix(')'));
    let list: Vec<f64> = inner.expect("a list").split(", ").map(number).collect();
    assert_eq!(
        (list.len(), list[0], list[1], list[2]),
        (17, 16.0, 1.0, 4.0)
    );
    let urscript = [list[11], list[12], list[13]].map(|metres| metres * 1000.0);

    let (code, out, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
    assert!(messages.contains("4 inspected"), "{messages}");
    assert!(
        messages.contains("Simulated: no camera is read"),
        "{messages}"
    );
    let lines: Vec<Value> = out
        .lines()
        .map(|line| serde_json::from_str(line).expect("a line of JSON"))
        .collect();
    assert_eq!(lines.len(), 4, "{out}");
    for (line, reply) in lines.iter().zip([&ascii[..], &binary, &eki, &urscript]) {
        assert_eq!(line["part"], "fender");
        let pose = matrix(&line["robot"]["robot_from_part"]);
        for (metres, mm) in [pose[3], pose[7], pose[11]].iter().zip(reply) {
            assert!((metres * 1000.0 - mm).abs() < 2e-3, "{line} {reply:?}");
        }
    }
    // Each trigger had its own frame, captured after the previous inspection.
    let numbers = lines
        .iter()
        .map(|line| line["number"].as_u64().expect("a number"));
    assert!(numbers.is_sorted_by(|a, b| a + 1 < *b), "{out}");
    let listed = place.accepted(&["history", "list", "--json"]).lines();
    assert_eq!(listed.len(), 4, "a row for each trigger");
}

#[test]
fn an_empty_cell_has_no_part_and_no_numbers() {
    let place = Workplace::new();
    let source = ["--source", "simulated,fps=5:empty", "--as", "fanuc"];
    let listen = ["--listen", "ascii=0", "--listen", "eki=0", "--no-history"];
    let mut service = Service::start(&place, &[&source[..], &listen[..]].concat());
    let line = asked(&mut service.connect("ascii"), "TRIGGER\n");
    let fields: Vec<&str> = line.split(';').collect();
    assert_eq!(fields.len(), 20, "{line}");
    assert!(matches!(fields[1], "no_part" | "refused"), "{line}");
    assert_eq!(fields[12..18], [""; 6], "{line}");
    assert!(!fields[18].is_empty() && !fields[19].is_empty(), "{line}");
    let line = asked(&mut service.connect("eki"), EKI_TRIGGER);
    assert!(
        line.contains("<Sequence>2</Sequence>") && !line.contains("<Pose"),
        "{line}"
    );
    let (code, _, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
}

#[test]
fn a_trigger_without_a_frame_is_a_line_of_json_as_well() {
    let place = Workplace::new();
    fs::create_dir(place.path("scans")).expect("made");
    let source = ["--source", "watch:scans", "--frame-timeout", "0.1"];
    let rest = ["--listen", "ascii=0", "--as", "kuka", "--no-history"];
    let mut service = Service::start(&place, &[&source[..], &rest[..]].concat());
    let answer = asked(&mut service.connect("ascii"), "TRIGGER\n");
    let fields: Vec<&str> = answer.split(';').collect();
    assert_eq!(fields[1], "error", "{answer}");
    let (code, out, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
    let line: Value = serde_json::from_str(&out).expect("one line of JSON");
    assert_eq!(line["status"], "error", "{line}");
    assert!(
        line["scene"]
            .as_str()
            .is_some_and(|scene| scene.contains("scans")),
        "{line}"
    );
    assert_eq!(line["accepted"], false, "{line}");
    assert_eq!(line["reason_kind"], fields[18], "{line} {answer}");
    assert!(
        line["reason"]
            .as_str()
            .is_some_and(|why| why.contains("to do")),
        "{line}"
    );
}

#[test]
fn a_file_for_a_trigger_shows_no_motion_and_answer_line_and_history_say_so() {
    let place = Workplace::new();
    let placed = ["--placement", "facing", "--out", "fender.pcd"];
    place.accepted(&[&["simulate", "--part", "fender"][..], &placed].concat());
    fs::create_dir(place.path("scans")).expect("made");
    let source = ["--source", "watch:scans", "--frame-timeout", "60"];
    let args = [&source[..], &["--listen", "ascii=0", "--as", "kuka"]].concat();
    let mut service = Service::start(&place, &args);
    let mut robot = service.connect("ascii");
    let answer = asked_before(&place, "fender.pcd", &mut robot, "TRIGGER\n");
    let fields: Vec<&str> = answer.split(';').collect();
    assert_eq!(fields[1], "accepted", "{answer}");
    let flags: u32 = fields[8].parse().expect("a number");
    assert_eq!(flags & 0b10_0001, 0b10_0001, "{answer}");
    let (code, out, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
    let line: Value = serde_json::from_str(&out).expect("one line of JSON");
    assert_eq!(line["motion_checked"], false, "{line}");
    assert!(line["robot"]["robot_from_part"].is_array(), "{line}");
    let record = place.accepted(&["history", "show", "1", "--json"]).json();
    assert_eq!(record["line"], line);
}

#[test]
fn before_a_rack_each_part_has_its_place_and_an_order_says_what_is_missing() {
    const PARTS: &str = "1=radiator_support|2=back_door|3=front_door";
    let place = Workplace::new();
    let rack = ["simulate", "--rack", "3", "--rack-kind", "apart"];
    place.accepted(&[&rack[..], &["--seed", "4", "--out", "rack.pcd"]].concat());
    let add = ["rack", "add", "rack.toml", "rack.pcd", "--each"];
    place.accepted(&add);
    // Again, they would be further places where others are.
    let made = place.read("rack.toml");
    assert_eq!(place.run(&add).code, 2);
    assert_eq!(place.read("rack.toml"), made);
    // At the fourth place hangs nothing.
    let far = "[[place]]\nname = \"far\"\ncentre_mm = [9000, 0, 2000]\nsize_mm = [99, 99, 99]\n";
    place.write("rack.toml", &(place.read("rack.toml") + far));
    let head = "order;serial;parts\n";
    let [missing, all] = [
        format!("4711;;{PARTS}|far=grille\n"),
        format!("4712;;{PARTS}\n"),
    ];
    place.write("orders.csv", &format!("{head}{missing}{all}"));
    fs::create_dir(place.path("scans")).expect("made");
    let source = ["--source", "watch:scans", "--frame-timeout", "60"];
    let rack = [
        "--as",
        "kuka",
        "--rack",
        "rack.toml",
        "--orders",
        "orders.csv",
    ];
    let listen = ["ascii=0", "eki=0", "urscript=0"].map(|listen| ["--listen", listen]);
    let args = [&source[..], &rack, listen.as_flattened()].concat();
    let mut service = Service::start(&place, &args);
    let mut robot = service.connect("ascii");
    let fields = |answer: &str| -> Vec<String> { answer.split(';').map(str::to_owned).collect() };
    // Verdict, part, reason and place; an answer without an inspection has none.
    let shown = |answer: &str| {
        let fields = fields(answer);
        [1, 6, 18, 20].map(|field: usize| fields.get(field).cloned().unwrap_or_default())
    };
    // The table says what is expected, so a trigger has to name its order.
    let unnamed = asked(&mut robot, "TRIGGER\n");
    assert_eq!(shown(&unnamed), ["error", "", "not_known", ""], "{unnamed}");
    let unknown = asked(&mut robot, "TRIGGER ORDER=\"47 11\"\n");
    assert_eq!(shown(&unknown), ["error", "", "not_known", ""], "{unknown}");
    assert!(unknown.contains("order 47 11 is not"), "{unknown}");
    let request = "TRIGGER ORDER=4711 SERIAL=TL-1\n";
    let answer = asked_before(&place, "rack.pcd", &mut robot, request);
    let expected = ["accepted", "radiator_support", "", "1"];
    assert_eq!(shown(&answer), expected, "{answer}");
    for (number, expected) in [
        (2, ["accepted", "back_door", "", "2"]),
        (3, ["accepted", "front_door", "", "3"]),
        (4, ["no_part", "grille", "missing", "4"]),
    ] {
        let answer = asked(&mut robot, &format!("PART {number}\n"));
        assert_eq!(shown(&answer), expected, "{answer}");
    }
    // The table has changed meanwhile.
    place.write("orders.csv", &format!("{head}{all}"));
    let gone = asked(&mut robot, "TRIGGER ORDER=4711\n");
    assert_eq!(shown(&gone), ["error", "", "not_known", ""], "{gone}");
    let mut eki = service.connect("eki");
    let request = "<Robot><Request>TRIGGER</Request><Order>4712</Order></Robot>";
    let answer = asked_before(&place, "rack.pcd", &mut eki, request);
    assert!(answer.ends_with("<Place>1</Place></Partsight>"), "{answer}");
    let mut list = service.connect("urscript");
    let answer = asked_before(&place, "rack.pcd", &mut list, "TRIGGER ORDER=4712\n");
    assert!(
        answer.starts_with("(17, 1,") && answer.ends_with(", 1)"),
        "{answer}"
    );
    let (code, out, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
    let lines = out.lines().map(serde_json::from_str::<Value>);
    let lines: Vec<Value> = lines.collect::<Result<_, _>>().expect("JSON");
    let line = lines.iter().find(|line| line["serial"] == "TL-1");
    let line = line.expect("the trigger's");
    assert_eq!(line["order"], "4711");
    assert_eq!(line["missing"], serde_json::json!(["grille"]));
    let rows = place.accepted(&["history", "list", "--json"]).lines();
    let num_traced = |serial: &str, order: &str| {
        let is_it = |row: &&Value| {
            row["serial"].as_str().unwrap_or_default() == serial && row["order"] == order
        };
        rows.iter().filter(is_it).count()
    };
    assert_eq!(num_traced("TL-1", "4711"), 3);
    assert_eq!(num_traced("", "4712"), 6);
    assert_eq!(rows.len(), 9);
}

#[test]
fn without_a_table_an_order_is_not_known_and_a_trigger_without_one_is_answered_as_ever() {
    let place = Workplace::new();
    let source = ["--source", "simulated,fps=5:fender", "--as", "kuka"];
    let listen = ["--listen", "ascii=0", "--order", "4711"];
    let mut service = Service::start(&place, &[&source[..], &listen].concat());
    let mut robot = service.connect("ascii");
    let refused = asked(&mut robot, "TRIGGER ORDER=4712 SERIAL=TL-2\n");
    assert!(
        refused.contains(";error;") && refused.contains(";not_known;"),
        "{refused}"
    );
    assert!(refused.contains("--orders"), "{refused}");
    let counted = asked(&mut robot, "TRIGGER ENC=5\n");
    assert!(
        counted.contains(";error;") && counted.contains(";no_line;"),
        "{counted}"
    );
    let plain = asked(&mut robot, "TRIGGER\n");
    assert_eq!(plain.split(';').count(), 20, "{plain}");
    assert!(plain.starts_with("TRIGGER;accepted;"), "{plain}");
    let (_, out, messages) = service.interrupt();
    let lines: Vec<Value> = out
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    let traced = lines
        .iter()
        .map(|line| serde_json::json!([line["status"], line["order"], line["serial"]]));
    let expected = [
        serde_json::json!(["error", "4712", "TL-2"]),
        serde_json::json!(["error", "4711", null]),
        serde_json::json!(["ok", "4711", null]),
    ];
    assert_eq!(traced.collect::<Vec<_>>(), expected, "{messages}");
}

#[test]
fn a_robot_that_servoes_is_told_where_to_go_and_leaves_a_run_but_no_inspection() {
    let place = Workplace::new();
    let source = ["--source", "simulated,fps=10:fender", "--as", "kuka"];
    let listen = [
        "--listen",
        "ascii=0",
        "--number",
        "fender=7",
        "--longest-move",
        "50",
    ];
    let mut service = Service::start(&place, &[&source[..], &listen[..]].concat());
    let mut robot = service.connect("ascii");
    let answer = asked(&mut robot, "SERVO START 7 900 0 1100 0 90 0\n");
    let fields: Vec<&str> = answer.split(';').collect();
    assert_eq!(
        (fields.len(), fields[0], fields[1]),
        (24, "SERVO", "move"),
        "{answer}"
    );
    assert_eq!(
        (fields[6], fields[7], fields[8]),
        ("fender", "7", "5"),
        "{answer}"
    );
    let number = |field: &str| field.parse::<f64>().expect("a number");
    let shift = [(12, 900.0), (13, 0.0), (14, 1100.0)].map(|(at, from)| number(fields[at]) - from);
    let shift = shift.iter().map(|by| by * by).sum::<f64>().sqrt();
    assert!(shift > 1.0 && shift < 50.1, "{answer}");
    assert!(
        number(fields[20]) > 1.0 && fields[22..] == ["0.0000", "0.0000"],
        "{answer}"
    );
    let unknown = asked(&mut robot, "SERVO 8 900 0 1100 0 90 0\n");
    assert!(
        unknown.contains(";error;") && unknown.contains(";unknown_number;"),
        "{unknown}"
    );
    let (code, out, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
    let lines: Vec<Value> = out
        .lines()
        .map(|line| serde_json::from_str(line).expect("a line of JSON"))
        .collect();
    assert_eq!(
        (&lines[0]["servo"], &lines[0]["part"]),
        (&"move".into(), &"fender".into())
    );
    assert_eq!(lines[1]["reason_kind"], "unknown_number");
    let metres = lines[0]["error_m"].as_f64().expect("an error");
    assert!((1000.0 * metres - number(fields[20])).abs() < 1e-3, "{out}");
    let listed = place.accepted(&["history", "list", "--json"]).lines();
    assert!(listed.is_empty(), "{listed:?}");
    let runs = place.accepted(&["history", "runs", "--json"]).lines();
    assert_eq!(runs.len(), 1, "{runs:?}");
    let run = &runs[0];
    assert_eq!(
        (&run["part"], &run["robot"]),
        (&"fender".into(), &"serve".into())
    );
    assert_eq!(run["source"], "simulated,fps=10:fender");
    // It was told to move, and asked for another part.
    assert_eq!(run["stopped"]["kind"], "robot_stopped", "{run}");
    assert_eq!(
        (&run["simulated"], &run["speed_m_s"]),
        (&true.into(), &Value::Null)
    );
    assert_eq!(run["num_looks"], 6, "{run}");
    let text = place.accepted(&["history", "run", "1"]).out;
    assert!(text.contains("serve") && !text.contains("speed"), "{text}");
}

#[test]
fn the_program_of_a_robot_is_tried_on_a_simulated_arm_that_stands_where_it_says() {
    let place = Workplace::new();
    let camera = ["--simulated", "fender", "--hand-eye", "10,1", "--delay=50"];
    let robots = [
        "--as",
        "fanuc",
        "--listen",
        "ascii=0",
        "--listen",
        "urscript=0",
        "--number",
        "fender=3",
    ];
    let args = [&camera[..], &robots[..]].concat();
    let mut service = Service::start_as_it_is(&place, &args, Stdio::piped());
    let mut robot = service.connect("ascii");
    let [mut pose, list]: [String; 2] = service.flanges(2).try_into().expect("two conventions");
    let (mut start, mut num_stays, mut lefts) = ("START ", 0, Vec::new());
    let done = loop {
        let answer = asked(&mut robot, &format!("SERVO {start}3 {pose}\n"));
        start = "";
        let fields: Vec<String> = answer.split(';').map(str::to_owned).collect();
        match &*fields[1] {
            "move" => {
                lefts.push(fields[20].parse::<f64>().expect("an error"));
                pose = fields[12..18].join(" ");
                assert!(lefts.len() < 20, "{lefts:?}");
            }
            "stay" => {
                num_stays += 1;
                assert!(num_stays < 5, "{answer}");
            }
            _ => break answer,
        }
    };
    let fields: Vec<&str> = done.split(';').collect();
    assert_eq!(
        (fields[1], fields[6], fields[8]),
        ("done", "fender", "4"),
        "{done}"
    );
    let left: f64 = fields[20].parse().expect("an error");
    assert!(
        lefts.len() > 1 && lefts[0] > 50.0 && left < 2.0,
        "{lefts:?}, {done}"
    );
    // Where the arm cannot stand.
    let away = asked(&mut robot, "SERVO START 3 9000 0 1100 0 90 0\n");
    assert!(
        away.contains(";stay;") && away.contains(";out_of_reach;"),
        "{away}"
    );
    // The same arm, from its start again, for another protocol.
    let mut other = service.connect("urscript");
    let pose = list.split(' ').collect::<Vec<_>>().join(", ");
    let moved = asked(&mut other, &format!("SERVO START 3 p[{pose}]\n"));
    assert!(moved.starts_with("(20, 8, "), "{moved}");
    let (code, _, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
    assert!(messages.contains("up to 10.0 mm and 1.0°"), "{messages}");
    let runs = place.accepted(&["history", "runs", "--json"]).lines();
    let arrived = runs.iter().find(|run| run["arrived"] == true);
    let arrived = arrived.expect("a run that arrived");
    assert_eq!(
        (&arrived["part"], &arrived["simulated"]),
        (&"fender".into(), &true.into())
    );
    assert_eq!(arrived["source"], "simulated:fender");
}

/// Serves without a history.
const WITHOUT_HISTORY: [&str; 7] = [
    "--source",
    "simulated,fps=5:fender",
    "--as",
    "kuka",
    "--listen",
    "ascii=0",
    "--no-history",
];

/// Triggers twice, and expects two answers, one warning and, at the end, this exit code.
fn warns_once_and_goes_on(mut service: Service, message: &str, exit_code: i32) {
    let mut robot = service.connect("ascii");
    for _ in 0..2 {
        let answer = asked(&mut robot, "TRIGGER\n");
        assert!(answer.starts_with("TRIGGER;accepted;"), "{answer}");
        let until = Instant::now() + PATIENCE;
        while !service.messages().contains(message) {
            assert!(Instant::now() < until, "{}", service.messages());
            thread::sleep(Duration::from_millis(20));
        }
    }
    let (code, _, messages) = service.interrupt();
    assert_eq!(code, Some(exit_code), "{messages}");
    assert_eq!(messages.matches(message).count(), 1, "{messages}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_service_whose_disk_is_full_warns_once_and_goes_on() {
    let place = Workplace::new();
    let full = fs::File::options().write(true).open("/dev/full");
    let full = full.expect("there").into();
    let service = Service::start_into(&place, &WITHOUT_HISTORY, full);
    let message = "the output could not be written: the disk is full";
    warns_once_and_goes_on(service, message, 2);
}

#[test]
fn a_service_whose_reader_has_ended_warns_once_and_goes_on() {
    let place = Workplace::new();
    let mut service = Service::start(&place, &WITHOUT_HISTORY);
    drop(service.child.stdout.take());
    let message = "warning: the reader of the standard output has closed it";
    warns_once_and_goes_on(service, message, 0);
}

#[test]
fn a_replayed_source_is_warned_of_and_its_answers_are_marked() {
    let place = Workplace::new();
    fs::create_dir(place.path("frames")).expect("made");
    for number in 0..200 {
        // Measured data in which there is no part.
        place.write(&format!("frames/{number}.xyz"), "0 0 1\n0.1 0 1\n0 0.1 1\n");
    }
    let source = ["--source", "recording,pace=20:frames", "--as", "kuka"];
    let args = [&source[..], &["--listen", "ascii=0", "--no-history"]].concat();
    let mut service = Service::start(&place, &args);
    let mut robot = service.connect("ascii");
    let until = Instant::now() + PATIENCE;
    let answer = loop {
        let answer = asked(&mut robot, "TRIGGER\n");
        // At its end, the recording starts over.
        if !answer.contains(";source_ended;") {
            break answer;
        }
        assert!(Instant::now() < until, "{answer}");
    };
    let fields: Vec<&str> = answer.split(';').collect();
    assert!(matches!(fields[1], "no_part" | "refused"), "{answer}");
    assert_eq!((fields[6], fields[8]), ("", "4"), "{answer}");
    let servoed = asked(&mut robot, "SERVO 1 900 0 1100 0 90 0\n");
    assert!(
        servoed.starts_with("SERVO;error;") && servoed.contains(";replayed;"),
        "{servoed}"
    );
    let (code, out, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
    let warning = "warning: recording,pace=20:frames is replayed";
    assert_eq!(messages.matches(warning).count(), 1, "{messages}");
    let line = out.lines().rev().nth(1).expect("that of the last trigger");
    let line: Value = serde_json::from_str(line).expect("a line of JSON");
    assert_eq!(line["simulated"], false, "a camera saw it: {line}");
    assert_eq!(line["replayed"], true, "{line}");
}

#[test]
fn a_path_that_does_not_aim_at_the_part_goes_to_no_robot() {
    let place = Workplace::new();
    place.with_part("fender");
    place.write(
        "far.csv",
        "x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,stand_off_mm\n5000,5000,9000,0,0,-1,150\n",
    );
    let library = ["library", "--library", "parts", "path", "fender"];
    place.coded(1, &[&library[..], &["far.csv"]].concat());
    let source = ["--source", "simulated,fps=5:fender", "--as", "kuka"];
    let rest = ["--listen", "ascii=0", "--no-history", "--library", "parts"];
    let mut service = Service::start(&place, &[&source[..], &rest[..]].concat());
    let mut robot = service.connect("ascii");
    let answer = asked(&mut robot, "TRIGGER\n");
    assert!(answer.starts_with("TRIGGER;accepted;"), "{answer}");
    let answer = asked(&mut robot, "PATH\n");
    let fields: Vec<&str> = answer.split(';').collect();
    assert_eq!(fields[6], "fender", "{answer}");
    assert_eq!(fields[10], "0", "{answer}");
    let (code, _, messages) = service.interrupt();
    assert_eq!(code, Some(0), "{messages}");
    let wanted = "robots get no path of fender: the spray path does not aim at the part";
    assert!(messages.contains(wanted), "{messages}");
}

/// The number in the answer to a trigger of a service with this library.
fn number_of_fender(place: &Workplace) -> String {
    let source = ["--source", "simulated,fps=5:fender", "--as", "kuka"];
    let rest = ["--listen", "ascii=0", "--no-history", "--library", "parts"];
    let mut service = Service::start(place, &[&source[..], &rest[..]].concat());
    let answer = asked(&mut service.connect("ascii"), "TRIGGER\n");
    let fields: Vec<&str> = answer.split(';').collect();
    assert_eq!(fields[6], "fender", "{answer}");
    fields[7].to_owned()
}

#[test]
fn a_part_keeps_its_number_when_others_are_enrolled_and_removed() {
    let place = Workplace::new();
    place.with_part("fender");
    place.with_part("grille");
    let library = |args: &[&str]| {
        let all = [&["library", "--library", "parts"], args].concat();
        place.accepted(&all).out
    };
    assert!(
        library(&["list"]).contains(" -  "),
        "{}",
        library(&["list"])
    );
    assert_eq!(number_of_fender(&place), "1");
    library(&["rename", "grille", "--to", "a_grille"]);
    place.with_part("front_door");
    assert_eq!(number_of_fender(&place), "1");
    library(&["remove", "a_grille"]);
    assert_eq!(number_of_fender(&place), "1");
    let shown = |part| library(&["show", part]);
    assert!(shown("fender").contains("1, by which robots know it"));
    assert!(shown("front_door").contains("3, by which robots know it"));

    fs::write(place.path("parts/numbers.toml"), "[parts").expect("written");
    let serve = ["serve", "--source", "simulated:fender", "--as", "kuka"];
    let rest = ["--calibration", "cell.toml", "--library", "parts"];
    let ran = place.coded(2, &[&serve[..], &rest[..]].concat());
    assert!(ran.err.contains("cannot read the numbers"), "{}", ran.err);
    assert!(ran.err.contains("restore it from a copy"), "{}", ran.err);
    place.coded(1, &["library", "--library", "parts", "verify"]);
}

#[test]
fn what_the_service_cannot_start_with_is_said_with_what_to_do() {
    let place = Workplace::new();
    let serve = ["serve", "--source", "simulated:fender"];
    let err = |code, args: &[&str]| {
        let ran = place.coded(code, &[&serve[..], args].concat());
        assert!(
            ran.err.contains("to do") || ran.err.contains("expected"),
            "{}",
            ran.err
        );
        ran.err
    };
    assert!(err(2, &[]).contains("--as"));
    if !place.has_plant() {
        assert!(err(2, &["--http", "8080"]).contains("--features plant"));
    }
    assert!(err(2, &["--as", "kuka"]).contains("where the camera sits"));
    place.accepted(&CALIBRATE);
    let calibrated = ["--as", "kuka", "--calibration", "cell.toml"];
    for (args, words) in [
        (&["--listen", "modbus=502"][..], "is not a protocol"),
        (&["--listen", "binary=0", "--as", "matrix"], "16 numbers"),
        (&["--number", "boat=1"], "no part boat"),
        (
            &["--number", "fender=1", "--number", "grille=1"],
            "already given",
        ),
        (&["--max-age", "0"], "expected a number"),
        (&["--longest-move", "1"], "expected a number"),
        (&["--volume", "0,0,0"], "two opposite corners"),
        (&["--seen-as", "missing.png"], "missing.png"),
    ] {
        let args = if args.contains(&"--as") {
            [args, &calibrated[2..]].concat()
        } else {
            [args, &calibrated[..]].concat()
        };
        let found = err(2, &args);
        assert!(found.contains(words), "{args:?}: {found}");
    }
    let simulated = |more: &[&str]| {
        let args = [&["serve", "--as", "kuka", "--simulated"][..], more].concat();
        place.coded(2, &args).err
    };
    assert!(simulated(&["boat"]).contains("partsight library list"));
    for more in [
        ["fender", "--calibration", "cell.toml"],
        ["fender", "--source", "simulated:fender"],
        ["fender", "--volume", "0,0,0,1000,1000,1000"],
    ] {
        assert!(simulated(&more).contains("cannot be used with"));
    }
    assert!(
        place
            .coded(2, &["serve", "--as", "kuka"])
            .err
            .contains("--source")
    );
    let stepping = ["--source", "recording,pace=step:x"];
    let ran = place.coded(2, &[&serve[..1], &stepping[..], &calibrated[..]].concat());
    assert!(ran.err.contains("pace=10"), "{}", ran.err);
    let missing = ["--source", "recording:missing", "--listen", "ascii=0"];
    let ran = place.coded(2, &[&serve[..1], &missing[..], &calibrated[..]].concat());
    assert!(ran.err.contains("the folder does not exist"), "{}", ran.err);
}
