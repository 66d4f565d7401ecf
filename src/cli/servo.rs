//! `partsight servo`: moves a robot by what the camera sees of a part.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, with_advice},
    follow::parse_source,
    input::{EmptyCellChoice, from_to, parse_name, within},
    interrupt::Interrupt,
    recipe::RecipeChoice,
    record::{HistoryChoice, HistoryRecorder},
    servo_choice::{ServoChoice, TrialChoice},
};
use capture::{BackpressurePolicy, Feed, SourceSpec};
use geometry::{error::Advice as _, rigid::PoseDelta};
use inspection::{
    library::{LibraryPlace, PartName},
    pipeline::NamedRecipe,
};
use records::{history::Traceability, report::SCHEMA};
use servo::{Arrival, ServoParams, Step, simulated::StreamProtocol};
use station::servoing::{
    RealRobot, RobotAddress, ServoJob, ServoNews, ServoOrder, ServoOutcome, check_source,
    reference_of, servo_real, servo_simulated,
};
use texts::Message;

/// Move a robot until the part stands where it should in front of the camera
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight servo fender --simulated                                       a simulated robot, to see how it works
  partsight servo fender --simulated --delay 150 --hand-eye 10,1           a late camera, a smaller error of calibration
  partsight servo fender --source kinect --robot egm=192.168.1.10:6510
  partsight servo fender --source kinect --robot ur=192.168.1.20 --speed 100
  partsight servo fender --source kinect --robot rsi=192.168.1.10:49152 --arm kr16.toml --nozzle \"kuka 0 0 200 0 0 0\"
  partsight servo fender --source kinect --robot egm=6510 --seen-as ready_1.png --seen-as ready_2.png
  partsight servo fender --source kinect --robot egm=6510 --target path-start --nozzle \"kuka 0 0 200 0 0 0\"

Robots:
  egm=IP:PORT   ABB's Externally Guided Motion; this computer listens there
  rsi=IP:PORT   KUKA's RobotSensorInterface; this computer listens there
  ur=IP         Universal Robots, over RTDE; the program is sent to the robot
docs/guide/servo.md has the programs for the controllers.

It is no safety function: people are protected by the robot's own safety controller. Untested on controllers: try it slowly first.
The robot moves only on accepted frames. It stops, and says why, on anything else, and on Ctrl-C.
Exit codes: 0 the target is reached, 1 stopped before, 2 could not run.")]
pub(super) struct ServoArgs {
    /// Name of the part
    #[arg(value_name = "PART", value_parser = parse_name)]
    part: PartName,
    /// The robot's controller
    #[arg(long, value_name = "PROTOCOL=ADDRESS", value_parser = parse_robot, required_unless_present = "simulated", requires = "source", conflicts_with = "trial")]
    robot: Option<RobotAddress>,
    /// Move a simulated robot with a camera instead, in this protocol
    #[arg(long, value_name = "PROTOCOL", value_parser = parse_protocol, num_args = 0..=1, default_missing_value = "egm", conflicts_with_all = ["robot", "source", "target", "seen_as", "arm", "nozzle", "volume"])]
    simulated: Option<StreamProtocol>,
    #[command(flatten)]
    trial: TrialChoice,
    /// The camera (partsight capture --help)
    #[arg(long, value_name = "SOURCE", value_parser = parse_source, conflicts_with = "trial")]
    source: Option<SourceSpec>,
    /// Where the camera sits, as written by `calibrate`; default: your own calibration
    #[arg(long, value_name = "FILE", conflicts_with = "simulated")]
    calibration: Option<PathBuf>,
    #[command(flatten)]
    choice: ServoChoice,
    #[arg(
        long, value_name = "MM/S",
        help = format!("Greatest speed of flange, camera and nozzle, mm/s ({})", from_to(&ServoParams::SPEEDS_MM_S)),
        default_value_t = 1000.0 * ServoParams::default().limits.speed,
        value_parser = |text: &str| within(text, &ServoParams::SPEEDS_MM_S),
    )]
    speed: f64,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    recipe: RecipeChoice,
    #[command(flatten)]
    empty_cell: EmptyCellChoice,
    #[command(flatten)]
    history: HistoryChoice,
    /// Do not write the run to the history
    #[arg(long, conflicts_with = "history")]
    no_history: bool,
    /// Write one line of JSON per frame and one for the end, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

pub(super) fn parse_robot(text: &str) -> Result<RobotAddress, String> {
    text.parse::<RobotAddress>()
        .map_err(|error| with_advice(&error))
}

fn parse_protocol(text: &str) -> Result<StreamProtocol, String> {
    StreamProtocol::named(text).ok_or_else(|| "expected egm, rsi or ur".into())
}

pub(super) fn run(args: &ServoArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    if let Some(source) = &args.source {
        check_source(source).advised()?;
    }
    let recipe = args.recipe.recipe()?;
    let (place, load) = (args.library).load_placed(&recipe.reference_params(), console)?;
    let interrupt = Interrupt::listen()?;
    let part = load.parts.iter().find(|part| part.name == args.part);
    let job = ServoJob {
        part: args.part.as_str(),
        title: part.map_or(args.part.as_str(), |part| part.shown_title()),
        library: &load.library,
        longest_step: None,
    };
    let outcome = if let (Some(robot), Some(source)) = (&args.robot, &args.source) {
        let part = (&job, &place);
        real(args, part, (*robot, source), &recipe, &interrupt, console)?
    } else {
        let protocol = args.simulated.unwrap_or(StreamProtocol::Egm);
        args.trial.announce(console);
        let params = args.choice.params(args.speed)?;
        let trial = args.trial.trial();
        let outcome = servo_simulated(&job, &params, protocol, &trial, |news| {
            show_news(news, args, console);
            order(&interrupt, console)
        });
        outcome.advised()?
    };
    if !args.no_history
        && let Some(record) = outcome.record
    {
        let trace = Traceability::default();
        let recorder = HistoryRecorder::start(&args.history, &load, &trace, None, console)?;
        if let Some(recorder) = recorder {
            recorder.add_servo_run(record);
            recorder.finish(console);
        }
    }
    let end = outcome.end.advised()?;
    if let Some(left) = &outcome.true_error {
        console.note(&format_args!("True error at the end: {}", words(left)));
    }
    Ok(shown(&end, args, console))
}

/// Servos a real robot.
fn real(
    args: &ServoArgs,
    (job, place): (&ServoJob<'_>, &LibraryPlace),
    (address, source): (RobotAddress, &SourceSpec),
    recipe: &NamedRecipe,
    interrupt: &Interrupt,
    console: &mut Console,
) -> anyhow::Result<ServoOutcome> {
    reference_of(job.library, job.part).advised()?;
    let path = place.spray_path(job.part).advised()?;
    let mut setup = (args.choice).setup(args.calibration.as_deref(), console)?;
    setup.params = args.choice.params(args.speed)?;
    let robot = RealRobot {
        address,
        source,
        feed: Feed::start(source.clone(), BackpressurePolicy::Newest, || ()).advised()?,
        setup: &setup,
        path: path.as_ref(),
        empty_cell: args.empty_cell.open(console)?,
        recipe,
    };
    let outcome = servo_real(job, robot, |news| {
        show_news(news, args, console);
        order(interrupt, console)
    });
    outcome.advised()
}

fn order(interrupt: &Interrupt, console: &Console) -> ServoOrder {
    if interrupt.came() || !console.is_writable() {
        ServoOrder::Stop
    } else {
        ServoOrder::GoOn
    }
}

fn words(error: &PoseDelta) -> String {
    format!(
        "{:.2} mm, {:.3}°",
        error.shift.mm(),
        error.rotation.degrees()
    )
}

fn show_news(news: Option<ServoNews>, args: &ServoArgs, console: &mut Console) {
    match news {
        Some(ServoNews::TargetFrame { name, reason }) => {
            console.advise(&format_args!("{name}: {reason}"), &reason.advice());
        }
        Some(ServoNews::Begins { robot, .. }) if args.robot.is_some() => {
            console.note(&Message::new("servo-waits-for-robot").with("robot", &*robot.to_string()));
        }
        None | Some(ServoNews::Begins { .. }) => {}
        Some(ServoNews::Camera(error)) => console.warn(&error, &*error),
        Some(ServoNews::Connected(peer)) => console.note(&format_args!("Robot: {peer}")),
        Some(ServoNews::Problem(problem)) => console.warn(&problem, &problem),
        Some(ServoNews::Looked {
            look, error, held, ..
        }) => {
            let why = look.seen.as_ref().err().or(held.as_ref());
            if args.json {
                console.line(&json!({
                    "schema": SCHEMA,
                    "frame_s": look.taken_at.as_secs_f64(),
                    "error_m": error.map(|error| error.shift.0),
                    "error_rad": error.map(|error| error.rotation.0),
                    "held": why.map(servo::StopReason::kind),
                }));
                return;
            }
            let at = look.taken_at.as_secs_f64();
            let error = error.map_or_else(|| "looking".to_owned(), |error| words(&error));
            let why = why.map(|why| format!("   held: {why}")).unwrap_or_default();
            console.line(&format_args!("{at:7.2} s   {error}{why}"));
        }
    }
}

/// Shows how it ended.
fn shown(end: &Step, args: &ServoArgs, console: &mut Console) -> Outcome {
    let (arrival, reason) = match end {
        Step::Done(arrival) => (Some(&**arrival), None),
        Step::Stop(reason) => (None, Some(reason)),
        Step::Command(_) => (None, None),
    };
    if args.json {
        console.line(&json!({
            "schema": SCHEMA,
            "arrived": arrival.is_some(),
            "error_m": arrival.map(|end| end.error.shift.0),
            "error_rad": arrival.map(|end| end.error.rotation.0),
            "bounds_m": arrival.map(|end| end.bounds.shift.0),
            "bounds_rad": arrival.map(|end| end.bounds.rotation.0),
            "approximate": arrival.map(|end| end.is_approximate),
            "took_s": arrival.map(|end| end.took.as_secs_f64()),
            "stopped": reason.map(servo::StopReason::kind),
            "message": reason.map(ToString::to_string),
            "advice": reason.map(geometry::error::Advice::advice),
        }));
    } else if let Some(arrival) = arrival {
        show_arrival(arrival, console);
    } else if let Some(reason) = reason {
        console.line(&format_args!("Stopped: {reason}"));
        console.entry("to do", &reason.advice());
    }
    Outcome::accepted_if(arrival.is_some())
}

fn show_arrival(arrival: &Arrival, console: &mut Console) {
    let approximate = if arrival.is_approximate {
        ", approximate: it may be another model"
    } else {
        ""
    };
    console.line(&format_args!("The target is reached{approximate}"));
    console.entry("error", &words(&arrival.error));
    let (shift, turn) = (&arrival.bounds.shift, &arrival.bounds.rotation);
    let bounds = format!("{:.1} mm, {:.2}° (95 %)", shift.mm(), turn.degrees());
    console.entry("bounds", &bounds);
    let took = format!(
        "{:.1} s, {} frames at the end",
        arrival.took.as_secs_f64(),
        arrival.num_frames
    );
    console.entry("took", &took);
}
