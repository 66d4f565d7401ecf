//! Robots that ask the real server over the loopback network, and move in the simulated cell as they are told.
//!
//! Requests are written and answers parsed according to the guide, not with the program's own functions.

use std::{
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::{SocketAddr, TcpStream},
    ops::ControlFlow,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

use super::*;
use crate::{NumberedPart, servoing::ServoTarget};
use geometry::{
    error::lock,
    oriented_box::OrientedBox,
    units::{Metres, Radians},
};
use inspection::fixtures::shipped_library;
use robot::{Convention, RobotFrame, spray::default_path};
use serve::{
    CameraStatus, FrameParts, Inspector, ListenAddress, Listener, PoseKind, Server, ServerSettings,
};
use servo::{
    ServoParams, Target,
    simulated::{
        ArmDynamics, CellPart, CellSetup, Disturbance, HandEyeError, SimulatedCell, SimulatedTarget,
    },
};
use simulate::PartKind;
use stages::stand_off::StandOffParams;

/// Long enough for a busy machine; normally what is waited for comes at once.
const PATIENCE: Duration = Duration::from_mins(10);
const ALL: [(&str, Convention); 5] = [
    ("ascii", Convention::Fanuc),
    ("binary", Convention::Abb),
    ("binary-be", Convention::Abb),
    ("eki", Convention::Kuka),
    ("urscript", Convention::UniversalRobots),
];
/// How long a move takes.
const MOVE_TIME: Duration = Duration::from_secs(1);
const MOVE: u32 = 8;
const DONE: u32 = 9;
const STAY: u32 = 10;

fn setup(disturbance: Disturbance) -> CellSetup {
    CellSetup {
        part: CellPart::Simulated(PartKind::Fender),
        target: SimulatedTarget::Standard,
        noise: 1.0,
        start: (Metres(0.25), Radians::from_degrees(25.0)),
        hand_eye: HandEyeError {
            shift: Metres::from_mm(20.0),
            turn: Radians::from_degrees(2.0),
        },
        frame_period: Duration::from_millis(100),
        delay: Duration::ZERO,
        dynamics: ArmDynamics::default(),
        disturbance,
        seed: 5,
    }
}

/// Where the robot and the part really are.
struct World {
    flange: RigidTransform,
    /// How far the part was pushed.
    push: RigidTransform,
    /// Simulated time.
    at: Duration,
    num_frames: u64,
    /// By how much frames are dated too early.
    early: Duration,
}

/// Takes frames in the simulated cell.
struct CellInspector<'a> {
    cell: &'a SimulatedCell<'a>,
    world: &'a Mutex<World>,
    library: &'a Library,
    finder: PartFinder,
    moves: SingleMoves,
    is_ending: &'a AtomicBool,
}

impl Inspector for CellInspector<'_> {
    fn inspect(&mut self, _: &Asked) -> FrameParts {
        panic!("nobody triggers")
    }

    fn servo(&mut self, request: &ServoRequest, client: u64, asked: &Asked) -> Found {
        let (cell, world) = (self.cell, self.world);
        let recipe = NamedRecipe::default();
        let parts = ServoParts {
            finder: &self.finder,
            library: self.library,
            recipe: &recipe,
        };
        (self.moves).answer(request, client, asked, parts, |prepared, asked, num| {
            let mut world = lock(world);
            let mut looks = Vec::new();
            for _ in 0..num {
                world.at += cell_period();
                world.num_frames += 1;
                let flange = world.push.inverse() * world.flange;
                let look = cell.look(&flange, world.at, world.num_frames);
                let arrived = Instant::now()
                    .checked_sub(world.early)
                    .expect("it runs for a while");
                // The cell looks for its own part.
                let (part, other) = (prepared.task.part.clone(), cell.task.part.clone());
                let is_other = part != other;
                looks.extend(look.map(|look| match look.seen {
                    Ok(_) if is_other => (arrived, Err(StopReason::AnotherPart { part, other })),
                    seen => (arrived, seen),
                }));
            }
            Ok(RestFrames {
                looks,
                captured: asked.at,
                marks: Answer::SIMULATED,
                last: None,
            })
        })
    }

    fn answered(&mut self) {}

    fn turn(&mut self) -> ControlFlow<()> {
        if self.is_ending.load(Ordering::SeqCst) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

fn cell_period() -> Duration {
    Duration::from_millis(100)
}

/// Ends the server, also if a robot fails.
struct EndAtLast<'a>(&'a AtomicBool);

impl Drop for EndAtLast<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

/// The robots of a cell.
struct Robots<'a> {
    addresses: Vec<SocketAddr>,
    world: &'a Mutex<World>,
    start: RigidTransform,
    cell: &'a SimulatedCell<'a>,
    fender: u32,
    grille: u32,
}

impl Robots<'_> {
    fn connect(&self, index: usize) -> Robot {
        let stream = TcpStream::connect(self.addresses[index]).expect("connected");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        Robot {
            protocol: ALL[index].0,
            convention: ALL[index].1,
            stream: BufReader::new(stream),
        }
    }

    /// Asks for the part with this number, and goes where it is told.
    fn ask(&self, robot: &mut Robot, part: u32, is_start: bool) -> Reply {
        let flange = lock(self.world).flange;
        let reply = robot.ask(part, is_start, &flange);
        if reply.verdict == MOVE {
            let mut world = lock(self.world);
            world.flange = reply.pose.expect("a pose");
            world.at += MOVE_TIME;
        } else {
            assert_eq!(reply.pose, None, "{reply:?}");
        }
        reply
    }
}

/// Runs a server for a cell, and lets robots ask it. Returns the rows of the history.
fn served(
    setup: CellSetup,
    change: impl FnOnce(&mut ServoSetup),
    settings: ServerSettings,
    talk: impl FnOnce(&Robots<'_>) + Send,
) -> Vec<ServoRecord> {
    let library = shipped_library();
    let cell = SimulatedCell::arrange(setup, &library).expect("a start");
    let params = ServoParams {
        settle: Duration::ZERO,
        num_final: 3,
        ..ServoParams::default()
    };
    let mut servo_setup = ServoSetup {
        camera: cell.task.camera,
        calibration: None,
        target: ServoTarget::StandardPosition,
        flange_from_nozzle: None,
        placed: None,
        volume: cell.fence.volume,
        params,
    };
    if let Target::Nozzle {
        flange_from_nozzle,
        calibration,
        ..
    } = cell.task.target
    {
        servo_setup.target = ServoTarget::PathStart;
        servo_setup.flange_from_nozzle = Some(flange_from_nozzle);
        servo_setup.calibration = Some(calibration);
    }
    change(&mut servo_setup);
    let number_of = |name: &str| {
        let index = library.references.iter().position(|one| one.name == name);
        index.expect("enrolled") as u32 + 1
    };
    let has_path = cell.setup().target == SimulatedTarget::PathStart;
    let parts = (1..)
        .zip(&library.references)
        .map(|(number, reference)| NumberedPart {
            number,
            path: default_path(reference, &StandOffParams::default()).filter(|_| has_path),
            ..NumberedPart::default()
        });
    let finder = PartFinder {
        parts: parts.collect(),
        robot: RobotFrame {
            robot_from_camera: RigidTransform::identity(),
            name: "cell".into(),
        },
        kind: PoseKind::RobotFromPart,
    };
    let listeners = ALL.map(|(protocol, convention)| {
        let at: ListenAddress = format!("{protocol}=0").parse().expect("an address");
        Listener::new(at, Some(convention)).expect("spoken")
    });
    let mut server = Server::start(&listeners, settings, CameraStatus::default, |_| ());
    let server = server.as_mut().expect("started");
    let start = cell.arm().true_flange();
    let world = Mutex::new(World {
        flange: start,
        push: RigidTransform::identity(),
        at: Duration::ZERO,
        num_frames: 0,
        early: Duration::ZERO,
    });
    let is_ending = AtomicBool::new(false);
    let robots = Robots {
        addresses: server.addresses().iter().map(|at| at.address).collect(),
        world: &world,
        start,
        cell: &cell,
        fender: number_of("fender"),
        grille: number_of("grille"),
    };
    let mut inspector = CellInspector {
        cell: &cell,
        world: &world,
        library: &library,
        finder,
        moves: SingleMoves::new(servo_setup, SingleMoves::USUAL_LONGEST, "camera".into())
            .expect("sound"),
        is_ending: &is_ending,
    };
    thread::scope(|scope| {
        scope.spawn(|| {
            let _end = EndAtLast(&is_ending);
            talk(&robots);
        });
        server.run(&mut inspector);
    });
    inspector.moves.end_run();
    inspector.moves.take_ended()
}

/// An answer as a robot reads it.
#[derive(Debug)]
struct Reply {
    verdict: u32,
    part: u32,
    flags: u32,
    pose: Option<RigidTransform>,
    /// The error in millimetres and degrees, and its bounds; none if they are not given.
    error: Option<[f64; 4]>,
    /// Empty if the protocol has no texts.
    reason: String,
    message: String,
}

struct Robot {
    protocol: &'static str,
    convention: Convention,
    stream: BufReader<TcpStream>,
}

impl Robot {
    fn ask(&mut self, part: u32, is_start: bool, flange: &RigidTransform) -> Reply {
        let numbers = self.convention.write(flange).numbers();
        let bytes = match self.protocol {
            "ascii" | "urscript" => {
                let start = if is_start { "START " } else { "" };
                let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
                let pose = if self.protocol == "ascii" {
                    numbers.join(" ")
                } else {
                    format!("p[{}]", numbers.join(", "))
                };
                format!("SERVO {start}{part} {pose}\n").into_bytes()
            }
            "eki" => {
                let names = ["X", "Y", "Z", "A", "B", "C"].iter().zip(numbers);
                let pose: Vec<String> = names.map(|(name, n)| format!("{name}=\"{n}\"")).collect();
                let pose = pose.join(" ");
                let start = u8::from(is_start);
                format!("<Robot><Request>SERVO</Request><Point>0</Point><Sequence>0</Sequence><Expected>{part}</Expected><Start>{start}</Start><Pose {pose}></Pose></Robot>").into_bytes()
            }
            protocol => frame(part, is_start, &numbers, protocol == "binary-be"),
        };
        self.stream.get_mut().write_all(&bytes).expect("sent");
        self.reply()
    }

    fn reply(&mut self) -> Reply {
        if self.protocol.starts_with("binary") {
            return self.reply_in_frame();
        }
        let mut line = String::new();
        self.stream.read_line(&mut line).expect("a line");
        let line = line.trim_end();
        match self.protocol {
            "ascii" => self.reply_in_fields(line),
            "eki" => self.reply_in_xml(line),
            _ => self.reply_in_list(line),
        }
    }

    fn pose(&self, numbers: &[f64]) -> Option<RigidTransform> {
        let pose = |numbers| self.convention.read(numbers).expect("a pose");
        (!numbers.is_empty()).then(|| pose(numbers))
    }

    fn reply_in_fields(&self, line: &str) -> Reply {
        let fields: Vec<&str> = line.split(';').collect();
        assert_eq!((fields.len(), fields[0]), (24, "SERVO"), "{line}");
        let verdicts = [
            "accepted",
            "refused",
            "no_part",
            "stale",
            "error",
            "full",
            "bad_request",
        ];
        let verdicts = verdicts.iter().chain(&["move", "done", "stay"]);
        let verdict = verdicts.zip(1..).find(|(name, _)| **name == fields[1]);
        let numbers = |fields: &[&str]| -> Vec<f64> {
            let given = fields.iter().filter(|field| !field.is_empty());
            given
                .map(|field| field.parse().expect("a number"))
                .collect()
        };
        Reply {
            verdict: verdict.expect("a verdict").1,
            part: fields[7].parse().expect("a number"),
            flags: fields[8].parse().expect("a number"),
            pose: self.pose(&numbers(&fields[12..18])),
            error: numbers(&fields[20..]).try_into().ok(),
            reason: fields[18].into(),
            message: fields[19].into(),
        }
    }

    fn reply_in_xml(&self, line: &str) -> Reply {
        let text = |tag: &str| {
            let (_, rest) = line.split_once(&format!("<{tag}>"))?;
            Some(rest.split_once(&format!("</{tag}>"))?.0.to_owned())
        };
        let number = |tag: &str| text(tag).expect(tag).parse::<u32>().expect("a number");
        let pose: Option<Vec<f64>> = line.split_once("<Pose ").map(|(_, rest)| {
            let values = rest.split('"').skip(1).step_by(2).take(6);
            values
                .map(|value| value.parse().expect("a number"))
                .collect()
        });
        let figures = ["Error", "ErrorTurn", "Bound", "BoundTurn"].iter();
        let figures: Option<Vec<f64>> = figures.map(|tag| text(tag)?.parse().ok()).collect();
        Reply {
            verdict: number("Code"),
            part: number("Number"),
            flags: number("Flags"),
            pose: self.pose(&pose.unwrap_or_default()),
            error: figures.and_then(|figures| figures.try_into().ok()),
            reason: text("Reason").expect("a reason"),
            message: text("Message").expect("a message"),
        }
    }

    fn reply_in_list(&self, line: &str) -> Reply {
        let inner = line
            .strip_prefix('(')
            .and_then(|line| line.strip_suffix(')'));
        let list = inner.expect("parentheses").split(", ");
        let list: Vec<f64> = list
            .map(|number| number.parse().expect("a number"))
            .collect();
        assert_eq!(list[0] as usize, list.len() - 1);
        let (error, pose) = match list.len() {
            11 => (&[][..], &[][..]),
            15 => (&list[11..], &[][..]),
            21 => (&list[11..15], &list[15..]),
            _ => panic!("{line}"),
        };
        Reply {
            verdict: list[1] as u32,
            part: list[7] as u32,
            flags: list[6] as u32,
            pose: self.pose(pose),
            error: error.try_into().ok(),
            reason: String::new(),
            message: String::new(),
        }
    }

    fn reply_in_frame(&mut self) -> Reply {
        let mut frame = [0; 256];
        self.stream.read_exact(&mut frame).expect("a frame");
        let is_big = self.protocol == "binary-be";
        let bytes = |at: usize, num: usize| {
            let mut bytes = frame[at..at + num].to_vec();
            if is_big {
                bytes.reverse();
            }
            bytes
        };
        let short = |at| u32::from(u16::from_le_bytes(bytes(at, 2).try_into().expect("two")));
        let real = |at| f64::from_le_bytes(bytes(at, 8).try_into().expect("eight"));
        let text = |at: usize, num| {
            let text = String::from_utf8(frame[at..at + num].to_vec()).expect("text");
            text.trim_end_matches('\0').to_owned()
        };
        assert_eq!((&frame[..4], short(8)), (&b"PSAN"[..], 6));
        let numbers: Vec<f64> = (0..short(40) as usize).map(|i| real(56 + 8 * i)).collect();
        let error = [216, 224, 232, 240].map(real);
        Reply {
            verdict: short(10),
            part: u32::from_le_bytes(bytes(28, 4).try_into().expect("four")),
            flags: short(26),
            pose: self.pose(&numbers),
            error: Some(error).filter(|error| error[0] > 0.0),
            reason: text(176, 24),
            message: text(200, 16),
        }
    }
}

/// A request as a binary frame.
fn frame(part: u32, is_start: bool, numbers: &[f64], is_big: bool) -> Vec<u8> {
    let mut frame = b"PSRQ".to_vec();
    let mut put = |mut little: Vec<u8>| {
        if is_big {
            little.reverse();
        }
        frame.extend(little);
    };
    for short in [1_u16, 76, 6, u16::from(is_start)] {
        put(short.to_le_bytes().to_vec());
    }
    put(part.to_le_bytes().to_vec());
    for i in 0..7 {
        let number = numbers.get(i).copied().unwrap_or(0.0);
        put(number.to_le_bytes().to_vec());
    }
    let mut crc = u32::MAX;
    for byte in &frame {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 {
                crc >> 1 ^ 0xedb8_8320
            } else {
                crc >> 1
            };
        }
    }
    let mut checksum = (!crc).to_le_bytes();
    if is_big {
        checksum.reverse();
    }
    frame.extend(checksum);
    frame
}

#[test]
fn a_robot_of_each_protocol_is_brought_to_its_target_move_by_move() {
    let settings = ServerSettings::default();
    let records = served(
        setup(Disturbance::None),
        |_| (),
        settings,
        |robots| {
            for index in 0..ALL.len() {
                lock(robots.world).flange = robots.start;
                let mut robot = robots.connect(index);
                let mut lefts = Vec::new();
                let done = loop {
                    let reply = robots.ask(&mut robot, robots.fender, false);
                    assert_eq!(
                        (reply.part, reply.flags & 4),
                        (robots.fender, 4),
                        "{reply:?}"
                    );
                    if reply.verdict != MOVE {
                        break reply;
                    }
                    let [left, _, bound, _] = reply.error.expect("an error");
                    assert!(left > 0.0 && bound == 0.0, "{reply:?}");
                    assert_eq!(reply.flags & 1, 1, "{reply:?}");
                    lefts.push(left);
                    assert!(lefts.len() < 15, "{lefts:?}");
                };
                assert_eq!(done.verdict, DONE, "{}: {done:?}", robot.protocol);
                let [left, turn, bound, bound_turn] = done.error.expect("an error");
                assert!(
                    left < 2.0 && turn < 0.2 && bound < 8.0 && bound_turn < 1.0,
                    "{done:?}"
                );
                assert!(bound > 0.0 && bound_turn > 0.0, "{done:?}");
                assert!(
                    lefts.len() > 1 && lefts[0] > lefts[lefts.len() - 1],
                    "{lefts:?}"
                );
                let world = lock(robots.world);
                let left = robots.cell.true_error(&world.flange, world.at);
                assert!(
                    left.shift.mm() < 2.0 && left.rotation.degrees() < 0.25,
                    "{left:?}"
                );
            }
        },
    );
    assert_eq!(records.len(), ALL.len());
    for ServoRecord { run, curve } in &records {
        assert_eq!((&*run.part, &*run.robot), ("fender", "serve"));
        assert_eq!((&run.stopped, run.speed_m_s), (&None, None));
        assert!(run.is_simulated && run.bounds_m > run.error_m, "{run:?}");
        assert_eq!((run.num_looks, run.num_looks % 3), (curve.len(), 0));
        let [first, last] = [0, curve.len() - 1].map(|at| curve[at].error_m);
        assert!(first > Some(0.05) && last == run.error_m, "{curve:?}");
    }
}

#[test]
fn a_nozzle_is_brought_to_the_start_of_a_path() {
    let to_path = CellSetup {
        target: SimulatedTarget::PathStart,
        part: CellPart::Simulated(PartKind::Grille),
        hand_eye: HandEyeError {
            shift: Metres::from_mm(1.0),
            turn: Radians::from_degrees(0.1),
        },
        ..setup(Disturbance::None)
    };
    served(
        to_path,
        |_| (),
        ServerSettings::default(),
        |robots| {
            let mut robot = robots.connect(1);
            let done = (0..30).find_map(|_| {
                let reply = robots.ask(&mut robot, robots.grille, false);
                (reply.verdict != MOVE).then_some(reply)
            });
            let done = done.expect("it ends");
            assert_eq!(done.verdict, DONE, "{done:?}");
            let world = lock(robots.world);
            let left = robots.cell.true_error(&world.flange, world.at);
            assert!(
                left.shift.mm() < 6.0 && left.rotation.degrees() < 0.6,
                "{left:?}"
            );
        },
    );
}

/// The first answer of a cell other than a move, over the lines for PLCs.
fn first_stay(
    setup: CellSetup,
    change: impl FnOnce(&mut ServoSetup),
    settings: ServerSettings,
    early: Duration,
) -> Reply {
    let found = Arc::new(Mutex::new(None));
    let theirs = Arc::clone(&found);
    served(setup, change, settings, move |robots| {
        let mut robot = robots.connect(0);
        lock(robots.world).early = early;
        let reply = (0..20).find_map(|_| {
            let reply = robots.ask(&mut robot, robots.fender, false);
            (reply.verdict != MOVE).then_some(reply)
        });
        *lock(&theirs) = reply;
    });
    let reply = lock(&found).take();
    reply.expect("it is told to stay")
}

#[test]
fn a_robot_is_told_to_stay_and_why() {
    let usual = ServerSettings::default();
    let stay = |disturbance, change: fn(&mut ServoSetup)| {
        first_stay(setup(disturbance), change, usual, Duration::ZERO)
    };
    let removed = stay(Disturbance::Removed, |_| ());
    assert_eq!(
        (removed.verdict, &*removed.reason),
        (STAY, "not_accepted"),
        "{removed:?}"
    );
    assert!(removed.message.contains("to do"), "{removed:?}");
    for disturbance in [Disturbance::Exchanged, Disturbance::Mirrored] {
        let other = stay(disturbance, |_| ());
        let reasons = ["not_accepted", "another_part"];
        assert_eq!(other.verdict, STAY, "{other:?}");
        assert!(reasons.contains(&&*other.reason), "{other:?}");
    }
    let far = stay(Disturbance::None, |setup| {
        setup.params.max_error.shift = Metres(0.02);
    });
    assert_eq!((far.verdict, &*far.reason), (STAY, "too_far"), "{far:?}");
    let outside = stay(Disturbance::None, |setup| {
        setup.volume = Some(OrientedBox {
            centre_m: [9.0, 0.0, 0.0],
            size_m: [1.0; 3],
            angles_rad: [0.0; 3],
        });
    });
    assert_eq!(
        (outside.verdict, &*outside.reason),
        (STAY, "outside_volume"),
        "{outside:?}"
    );
    let inexact = stay(Disturbance::None, |setup| {
        setup.params.tolerance.shift = Metres::from_mm(0.5);
    });
    assert_eq!(
        (inexact.verdict, &*inexact.reason),
        (STAY, "uncertain"),
        "{inexact:?}"
    );
    let early = Duration::from_secs(1);
    let dated = first_stay(setup(Disturbance::None), |_| (), usual, early);
    assert_eq!(
        (dated.verdict, &*dated.reason),
        (STAY, "frame_times"),
        "{dated:?}"
    );
    let impatient = ServerSettings {
        max_age: Duration::from_nanos(1),
        ..usual
    };
    let late = first_stay(setup(Disturbance::None), |_| (), impatient, Duration::ZERO);
    assert_eq!((late.verdict, &*late.reason), (4, "stale"), "{late:?}");
    let no_path = stay(Disturbance::None, |setup| {
        setup.target = ServoTarget::PathStart;
    });
    assert_eq!(
        (no_path.verdict, &*no_path.reason),
        (5, "no_path"),
        "{no_path:?}"
    );
}

#[test]
fn a_run_belongs_to_one_client_and_one_part_and_begins_anew_when_it_is_told_to() {
    let settings = ServerSettings::default();
    let records = served(
        setup(Disturbance::None),
        |_| (),
        settings,
        |robots| {
            let (fender, grille) = (robots.fender, robots.grille);
            let mut robot = robots.connect(0);
            // There, or back.
            let push = || {
                let mut world = lock(robots.world);
                let is_pushed = world.push != RigidTransform::identity();
                let y = if is_pushed { 0.0 } else { 0.04 };
                world.push = RigidTransform::translation(0.0, y, 0.0);
            };
            let push_at_start = || {
                push();
                lock(robots.world).flange = robots.start;
            };
            let ask = |robot: &mut Robot, part, is_start| {
                let reply = robots.ask(robot, part, is_start);
                (reply.verdict, reply.reason)
            };
            let moves = || (MOVE, String::new());
            let moved = || (STAY, "moved".to_owned());
            assert_eq!(ask(&mut robot, fender, false), moves());
            // It remembers where the part was, says once that it was pushed, and goes on.
            push();
            assert_eq!(ask(&mut robot, fender, false), moved());
            assert_eq!(ask(&mut robot, fender, false), moves());
            // A new start, another part, another client and a client that was lost know nothing of it.
            push_at_start();
            assert_eq!(ask(&mut robot, fender, true), moves());
            assert_eq!(ask(&mut robot, grille, false).0, STAY);
            push_at_start();
            assert_eq!(ask(&mut robot, fender, false), moves());
            push_at_start();
            let mut other = robots.connect(0);
            assert_eq!(ask(&mut other, fender, false), moves());
            push_at_start();
            drop(other);
            assert_eq!(ask(&mut robots.connect(0), fender, false), moves());
            // A robot that does not go where it is sent.
            lock(robots.world).flange = robots.start;
            let mut robot = robots.connect(0);
            assert_eq!(ask(&mut robot, fender, true), moves());
            lock(robots.world).flange = robots.start;
            let astray = (STAY, "arm_astray".to_owned());
            assert_eq!(ask(&mut robot, fender, false), astray);
            assert_eq!(ask(&mut robot, fender, false), astray);
            // A number that no part has, and none.
            let (verdict, reason) = ask(&mut robot, 999, false);
            assert_eq!((verdict, &*reason), (5, "unknown_number"));
            assert_eq!(ask(&mut robot, 0, false).1, "unknown_number");
        },
    );
    // Each run has a row, with the reason of its last answer.
    let ends = records.iter().map(|record| {
        let stopped = record.run.stopped.as_ref();
        (&*record.run.part, stopped.map_or("", StopReason::kind))
    });
    let ends: Vec<(&str, &str)> = ends.collect();
    let on_its_way = ("fender", "robot_stopped");
    let grille = ends[2];
    assert!(
        grille.0 == "grille" && grille.1 != "robot_stopped",
        "{ends:?}"
    );
    let rest = [on_its_way; 3];
    assert_eq!(ends[..2], [on_its_way; 2]);
    assert_eq!(ends[3..], [&rest[..], &[("fender", "arm_astray")]].concat());
}
