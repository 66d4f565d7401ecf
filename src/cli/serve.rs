//! `partsight serve`: lets robots and PLCs request an inspection over TCP.

mod session;

use std::{
    collections::BTreeMap,
    net::{Ipv4Addr, SocketAddr, SocketAddrV4},
    sync::{
        Arc,
        mpsc::{self, Receiver},
    },
    time::Duration,
};

use clap::Args;

use self::session::ServeSession;
use super::{
    LibraryChoice, Outcome,
    calibrate::{CalibrationChoice, LineChoice, no_calibration},
    console::{Advised as _, Console, with_advice},
    expect::ExpectChoice,
    input::{EmptyCellChoice, parse_name, within},
    interrupt::Interrupt,
    numbers::NumbersChoice,
    output::{Columns, OutputFormat},
    plant::{ChosenServices, HttpArgs, MqttChoice, TakeArgs, taken_version},
    rack::RackFileChoice,
    recipe::RecipeChoice,
    record::RecordingChoice,
    servo_choice::{ServoChoice, TrialChoice},
    trace::TraceChoice,
};
use capture::{OpenNiSpec, Pace, RealsenseSpec, RecordingSpec, SourceSpec};
use geometry::units::Metres;
use inspection::{
    library::{Library, LibraryLoad, PartName},
    pipeline::MirrorTally,
};
use robot::{Convention, RobotFrame, RobotValue};
use serve::{ClientEvent, ListenAddress, Listener, Protocol, Server, ServerSettings};
use station::{
    Camera, CameraScenes, LineFollower, NumberedPart, PartFinder,
    servoing::{CarriedCamera, ServoSetup, SetupError, SingleMoves, check_source},
};

/// Answer robots and PLCs that ask over TCP for an inspection and a pose
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight serve --source kinect --as fanuc
  partsight serve --source kinect --listen eki=192.168.1.10:54600
  partsight serve --source kinect --listen ascii=30100 --listen urscript=192.168.1.10:30102 --as abb
  partsight serve --source simulated:fender --as kuka --calibration cell.toml --json
  partsight serve --source kinect --as kuka --calibration cell.toml --line line.toml
  partsight serve --simulated fender --as kuka     a camera on a simulated arm, to try a program that servoes
  printf 'TRIGGER\\n' | nc 127.0.0.1 30100

Protocols, each on its own port; docs/guide/robots_that_ask.md describes them in full:
  ascii                lines of fields between semicolons, for PLCs
  binary, binary-be    frames of 256 bytes with a checksum, little- or big-endian, for PLCs
  eki                  XML for KUKA's option package Ethernet KRL; poses as kuka
  urscript             lists of numbers for Universal Robots; poses as universal-robots
Requests:
  TRIGGER              inspects a frame captured from then on; --expect, or --orders and --order,
                       name the expected parts
  TRIGGER 3 5          these parts should hang there
  TRIGGER 1=3 2=5      the same at the first and the second place of the --rack
  TRIGGER ORDER=4711 SERIAL=TL-0042
                       the parts of this order in the table of --orders should hang there; one of
                       order and serial number suffices
  TRIGGER ENC=123456   gives the poses at this count of the encoder of the --line; ENC=123456@40 if it
                       was read 40 ms ago
  PART 2               the second part of that frame
  LAST                 the first answer again
  STATUS               the state of the camera
  PATH                 the points of the spray path of the part that the same client triggered, for
                       where it hangs
  SERVO 3 1450 -310 890 10 20 30
                       where the robot, whose flange rests there, should go next until part 3 is
                       where it should be (docs/guide/servo.md)

A part that moves is refused with the reason moving: the scene must have been still for 0.9 s, and a second frame, 150 ms \
later, must show the part in the same place.
With --line, parts pass without a stop: each is followed and recorded once.
Every answer has a verdict, the age of its frame and a sequence number. Poses are given only for an accepted part whose \
frame is not older than --max-age. Triggers are answered in the order in which they come, each with a frame of its own. \
Poses are in the robot's base frame, so a calibration is needed: partsight calibrate --help
Every inspection is written to the history, one row for each part of a trigger's frame. Ctrl-C ends the service. \
Connections are neither encrypted nor authenticated. Without an address, only programs on this computer can connect.
Exit codes: 0 ended by Ctrl-C, 2 could not run.")]
pub(super) struct ServeArgs {
    /// The camera, recording or watched folder whose frames are inspected (partsight capture --help)
    #[arg(long, value_name = "SOURCE", value_parser = parse_running_source, required_unless_present = "simulated", conflicts_with = "trial")]
    source: Option<SourceSpec>,
    /// Protocol and port, or IP address and port; may be given several times; default: ascii=30100, unless --http is given
    #[arg(long, value_name = "PROTOCOL=PORT", value_parser = parse_listen)]
    listen: Vec<ListenAddress>,
    #[command(flatten)]
    numbers: NumbersChoice,
    /// Maximum age of a frame whose pose is given, seconds (0.1 to 3600)
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0, value_parser = |text: &str| within(text, &(0.1..=3600.0)))]
    max_age: f64,
    /// How long a trigger waits for its frame, seconds (0.1 to 600)
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0, value_parser = |text: &str| within(text, &(0.1..=600.0)))]
    frame_timeout: f64,
    /// Maximum number of connections at a time, on all ports together (1 to 256)
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u16).range(1..=256))]
    max_clients: u16,
    /// Time without a request after which a connection is closed, seconds (1 to 86400)
    #[arg(long, value_name = "SECONDS", default_value_t = 600.0, value_parser = |text: &str| within(text, &(1.0..=86_400.0)))]
    idle_timeout: f64,
    #[command(flatten)]
    http: HttpArgs,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    take: TakeArgs,
    #[command(flatten)]
    recipe: RecipeChoice,
    #[command(flatten)]
    expect: ExpectChoice,
    #[command(flatten)]
    rack: RackFileChoice,
    #[command(flatten)]
    empty_cell: EmptyCellChoice,
    #[command(flatten)]
    calibration: CalibrationChoice,
    #[command(flatten)]
    line: LineChoice,
    /// Write one line of JSON per trigger, and nothing else, to standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    trace: TraceChoice,
    #[command(flatten)]
    recording: RecordingChoice,
    #[command(flatten)]
    mqtt: MqttChoice,
    /// Longest move of a robot that servoes, mm (10 to 300); it turns by up to a tenth of a degree for each
    #[arg(long, value_name = "MM", default_value_t = SingleMoves::USUAL_LONGEST.mm(), value_parser = |text: &str| within(text, &SingleMoves::LONGEST_MOVES_MM), help_heading = SERVOING)]
    longest_move: f64,
    /// A camera on a simulated arm instead, which looks at this part from where a robot says with SERVO that it stands
    #[arg(long, value_name = "PART", value_parser = parse_name, conflicts_with_all = ["source", "calibration", "robot_pose", "empty_cell", "seen_as", "arm", "nozzle", "volume"], help_heading = SERVOING)]
    simulated: Option<PartName>,
    #[command(flatten, next_help_heading = SERVOING)]
    trial: TrialChoice,
    #[command(flatten, next_help_heading = SERVOING)]
    servo: ServoChoice,
}

/// Heading of the options for robots that servo.
const SERVOING: &str = "Servoing (SERVO)";

/// Where to listen if no protocol is asked for.
const DEFAULT_ADDRESS: ListenAddress = ListenAddress {
    protocol: Protocol::Ascii,
    address: SocketAddr::V4(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 30100)),
};

impl ServeArgs {
    /// The addresses of the line and frame protocols.
    fn addresses(&self) -> Vec<ListenAddress> {
        if self.listen.is_empty() && !self.http.is_wanted() {
            vec![DEFAULT_ADDRESS]
        } else {
            self.listen.clone()
        }
    }

    /// The camera, with what follows from its place.
    fn camera(&self, library: &Library, console: &Console) -> anyhow::Result<ServiceCamera> {
        let Some(part) = &self.simulated else {
            let robot = self.calibration.frame(console)?;
            let (Some(source), Some(robot)) = (&self.source, robot) else {
                return Err(no_calibration("serve"));
            };
            return Ok(ServiceCamera {
                robot,
                servoing: self.servoing(source, console)?,
                source: source.clone(),
                carried: None,
            });
        };
        let trial = self.trial.trial();
        let carried = CarriedCamera::arrange(part.as_str(), library, trial).advised()?;
        let (target, params) = (self.servo.target(console)?, self.servo.default_params()?);
        let source = carried.source();
        Ok(ServiceCamera {
            robot: carried.frame(),
            servoing: Ok(self.moves(carried.setup(target, params), &source)?),
            source,
            carried: Some(carried),
        })
    }

    /// What robots that servo are answered with, or why they are not.
    fn servoing(
        &self,
        source: &SourceSpec,
        console: &Console,
    ) -> anyhow::Result<Result<SingleMoves, SetupError>> {
        if let Err(why) = check_source(source) {
            return Ok(Err(why));
        }
        let setup = self.servo.setup(self.calibration.path(), console)?;
        self.moves(setup, source).map(Ok)
    }

    fn moves(&self, setup: ServoSetup, source: &SourceSpec) -> anyhow::Result<SingleMoves> {
        let longest = Metres::from_mm(self.longest_move);
        SingleMoves::new(setup, longest, source.to_string()).advised()
    }
}

/// The camera of a service, with what follows from its place.
struct ServiceCamera {
    source: SourceSpec,
    robot: RobotFrame,
    servoing: Result<SingleMoves, SetupError>,
    /// The camera on a simulated arm, if that is it.
    carried: Option<CarriedCamera>,
}

impl ServiceCamera {
    fn start(&self) -> anyhow::Result<Camera> {
        match &self.carried {
            Some(carried) => carried.start(),
            None => Camera::start(&self.source),
        }
        .advised()
    }
}

fn parse_listen(text: &str) -> Result<ListenAddress, String> {
    text.parse::<ListenAddress>()
        .map_err(|error| with_advice(&error))
}

/// Parses a source that keeps delivering frames, so that there is one after each trigger.
fn parse_running_source(text: &str) -> Result<SourceSpec, String> {
    let spec = text.parse::<SourceSpec>();
    let spec = spec.map_err(|error| with_advice(&error))?;
    match spec.paced(Pace::AsTaken) {
        SourceSpec::Recording(RecordingSpec {
            pace: Some(Pace::Step),
            ..
        })
        | SourceSpec::OpenNi(OpenNiSpec {
            pace: Some(Pace::Step),
            ..
        })
        | SourceSpec::Realsense(RealsenseSpec {
            pace: Some(Pace::Step),
            ..
        }) => Err(
            "a recording without its pauses has no frame that is captured after a trigger\n  to do: Leave pace=step \
             out, or give frames per second such as pace=10"
                .into(),
        ),
        spec => Ok(spec),
    }
}

/// Maximum number of messages about clients waiting to be shown; further ones are dropped.
const MAX_EVENTS: usize = 64;

pub(super) fn run(args: &ServeArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let listeners = args.addresses().into_iter();
    let listeners = listeners.map(|at| Listener::new(at, args.numbers.convention));
    let listeners = listeners.collect::<Result<Vec<_>, _>>().advised()?;
    let services = ChosenServices::new(&args.numbers, &args.http, &args.mqtt, &args.take)?;
    let recipe = args.recipe.recipe()?;
    let trace = args.trace.of_parts(None)?;
    let database = args.recording.database(console)?;
    let (place, load) = (args.library).load_placed(&recipe.reference_params(), console)?;
    let chosen = args.camera(&load.library, console)?;
    let recipe = (args.rack).before(recipe, &load.library, Some(&chosen.robot))?;
    let orders = args.expect.orders()?;
    let recipe = if orders.is_some() && trace.order.is_empty() {
        // Each trigger has to name its order.
        recipe
    } else {
        (args.expect).applied(&recipe, &load.library, Some(&recipe.rack), &trace)?
    };
    let parts = args.numbers.parts(&place, &load, console)?;
    let empty_cell = args.empty_cell.open(console)?;
    let line = args.line.load()?;
    let camera = Arc::new(chosen.start()?);
    let interrupt = Interrupt::listen()?;
    let (mut server, events) = start(args, &listeners, &camera)?;
    let recording = (args.recording).start(&load, &trace, database, console)?;
    announce(&server, &listeners, &chosen.source, &parts, &load, console);
    if let Some(carried) = &chosen.carried {
        args.trial.announce(console);
        announce_flange(carried, &listeners, console);
    }
    for (number, place) in (1..).zip(&recipe.rack.places) {
        console.note(&format_args!("  place {number}: {}", place.name));
    }
    if let Some(version) = taken_version(&place, console) {
        console.note(&format_args!("Library: {version}"));
    }
    let params = recipe.reference_params();
    let services = services.start(&server, &place, &load, params, console)?;
    let format = if args.json {
        OutputFormat::Json
    } else {
        OutputFormat::Rows(Columns::for_captures(&load.library))
    };
    format.head(console);
    let mut session = ServeSession {
        camera,
        interrupt,
        events,
        library: load.library,
        recipe,
        finder: PartFinder {
            parts,
            robot: chosen.robot,
            kind: args.numbers.kind(),
        },
        servoing: chosen.servoing,
        carried: chosen.carried,
        orders,
        traced: trace.clone(),
        trace,
        scenes: CameraScenes::new(empty_cell),
        source: chosen.source,
        line: line.map(LineFollower::new),
        frame_timeout: Duration::from_secs_f64(args.frame_timeout),
        format,
        recording,
        mirrored: MirrorTally::default(),
        console,
        last: None,
        problem: None,
        has_run: false,
        has_told_closed: false,
        failure: None,
        num_inspected: 0,
        services,
    };
    server.run(&mut session);
    session.finish()
}

/// Shows the addresses of the service, a warning about a replayed source, and the part numbers for robots.
fn announce(
    server: &Server,
    listeners: &[Listener],
    source: &SourceSpec,
    parts: &[NumberedPart],
    load: &LibraryLoad,
    console: &Console,
) {
    console.end_progress();
    for (at, listener) in server.addresses().iter().zip(listeners) {
        let convention = listener.convention.title();
        console.note(&format_args!("Listening: {at}, poses as {convention}"));
        if let Some(doubt) = listener.doubt() {
            console.warn(&doubt, &doubt);
        }
    }
    if source.is_replayed() {
        console.advise(
            &format_args!(
                "warning: {source} is replayed: the poses are of parts that hung there when it was recorded"
            ),
            &"Use it for trials only; to move a robot, give a camera or a watched folder as --source. Its answers have flag 4",
        );
    }
    show_numbers(parts, load, console);
}

/// Shows where the flange of a simulated arm stands, once in each convention that is spoken, in the numbers of a SERVO request.
fn announce_flange(carried: &CarriedCamera, listeners: &[Listener], console: &Console) {
    let flange = carried.flange();
    let conventions: BTreeMap<&str, Convention> = (listeners.iter())
        .map(|listener| (listener.convention.name(), listener.convention))
        .collect();
    for convention in conventions.into_values() {
        let written = convention.write(&flange);
        let numbers: Vec<String> = written.values.iter().map(RobotValue::rounded).collect();
        let (numbers, convention) = (numbers.join(" "), convention.title());
        console.note(&format_args!("Flange: {numbers}, as {convention}"));
    }
}

/// Shows the part numbers for robots, in their order.
fn show_numbers(parts: &[NumberedPart], load: &LibraryLoad, console: &Console) {
    let mut numbers: Vec<_> = parts.iter().zip(&load.parts).collect();
    numbers.sort_by_key(|(part, _)| part.number);
    for (part, meta) in numbers {
        console.note(&format_args!("  number {}: {}", part.number, meta.name));
    }
}

/// Starts the server; also returns the events of its clients.
fn start(
    args: &ServeArgs,
    listeners: &[Listener],
    camera: &Arc<Camera>,
) -> anyhow::Result<(Server, Receiver<ClientEvent>)> {
    let settings = ServerSettings {
        max_age: Duration::from_secs_f64(args.max_age),
        max_clients: usize::from(args.max_clients),
        idle_timeout: Duration::from_secs_f64(args.idle_timeout),
        ..ServerSettings::default()
    };
    let (tell, events) = mpsc::sync_channel(MAX_EVENTS);
    let camera = Arc::clone(camera);
    let on_event = move |event| {
        // Drop the event if the queue is full: nobody could read that many lines.
        let _ = tell.try_send(event);
    };
    let server = Server::start(listeners, settings, move || camera.status(), on_event);
    Ok((server.advised()?, events))
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;

    #[derive(clap::Parser)]
    struct Parsed {
        #[command(flatten)]
        serve: ServeArgs,
    }

    #[test]
    fn only_what_is_asked_for_is_listened_at() {
        let addresses = |args: &[&str]| {
            let all = [&["serve", "--source", "simulated:fender"][..], args].concat();
            let parsed = Parsed::try_parse_from(all).expect("parsed");
            let addresses = parsed.serve.addresses().into_iter();
            addresses.map(|at| at.to_string()).collect::<Vec<_>>()
        };
        assert_eq!(addresses(&[]), ["ascii=127.0.0.1:30100"]);
        assert_eq!(addresses(&["--listen", "eki=5"]), ["eki=127.0.0.1:5"]);
        assert!(addresses(&["--http", "0"]).is_empty());
        let both = addresses(&["--http", "0", "--listen", "ascii=7"]);
        assert_eq!(both, ["ascii=127.0.0.1:7"]);
    }

    #[test]
    fn a_recording_is_replayed_with_its_pauses() {
        let read = parse_running_source("recording:monday").expect("read");
        assert_eq!(read.to_string(), "recording,pace=as-taken:monday");
        assert!(parse_running_source("recording,pace=5:monday").is_ok());
        assert!(parse_running_source("watch:scans").is_ok());
        let error = parse_running_source("recording,pace=step:monday").expect_err("no time");
        assert!(error.contains("to do"), "{error}");
        assert!(parse_running_source("camera").is_err());
    }
}
