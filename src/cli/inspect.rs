//! `partsight inspect`: recognises the part and estimates its pose.

mod carried_path;
mod scan;
mod session;

use std::{
    ops::ControlFlow,
    path::{Path, PathBuf},
};

use clap::Args;

use self::session::{InspectSession, KeptInspection};
use super::{
    LibraryChoice, Outcome,
    calibrate::{CalibrationChoice, LineChoice, no_calibration},
    console::{Advised as _, Console},
    expect::ExpectChoice,
    follow::{follow_started, parse_source, start_source},
    input::{EmptyCellChoice, ImportChoice, Scenes, open_ahead, scene_of},
    output::{Columns, OutputFormat},
    plant::{ChosenPublisher, PublishArgs},
    rack::RackFileChoice,
    recipe::RecipeChoice,
    record::RecordingChoice,
    scan::PosesChoice,
    trace::TraceChoice,
};
use capture::{Captured, FeedItem, FeedStatus, SourceSpec};
use inspection::pipeline::{CheckedParts, MirrorTally};
use records::report::ReportFolder;
use station::{
    CameraScenes, Following, LineTracker, MotionWatch, NewFrame, PartFollower, SceneToInspect,
    Station, StationSetup, Subject,
};

/// Recognise the part in captured scenes and say where it is
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight inspect door.pcd
  partsight inspect captures/*.png --library /media/stick/reference_parts
  partsight inspect door.pcd --json | jq .part
  partsight inspect misread.pcd --report why/
  partsight inspect scan.ply --units mm --up z
  partsight inspect door.pcd --empty-cell cell.pcd
  partsight inspect rack.pcd --expect fender,front_door
  partsight inspect rack.pcd --orders orders.csv --order 4711
  partsight inspect rack.pcd --rack rack_a.toml
  partsight inspect door.pcd --surface
  partsight inspect still_1.png still_2.png still_3.png --surface --average 3
  partsight inspect door.pcd --matcher paper --pose icp-ga
  partsight inspect door.pcd --json --calibration cell.toml
  partsight inspect last-week/*.png --json --calibration cell.toml --force
  partsight inspect door.pcd --calibration cell.toml --spray path.csv --spray-as kuka
  partsight inspect door.pcd --calibration cell.toml --program paint.src --tool 3
  partsight inspect --scan frames/ --poses poses.json --json
  partsight inspect --source simulated
  partsight inspect --source watch:/mnt/scanner --json
  partsight inspect --source kinect --line line.toml

Files: PCD, PLY, XYZ or CSV text, or a 16-bit depth PNG with its intrinsics in a JSON beside it. \
Clouds are in metres, unless --units says otherwise. The JSON has width, height, fx, fy, cx, cy and metres_per_unit, and \
may have k1 k2 p1 p2 k3 k4 k5 k6 (OpenCV's lens distortion), \"mirrored\": true (left and right are swapped in the image) \
and \"rotated\": 90, 180 or 270 (degrees clockwise to turn the image by). All of these refer to the image as it is stored.
Exit codes: 0 every input accepted, 1 something was not accepted, 2 something could not be read.
A robot must not act on an old capture, an ambiguous pose or a scan that contradicts itself: there is no pose for it then, and \
robot_doubts in the JSON says why. --force gives it nevertheless, of files and scans, with its doubts. \
If the library is empty or cannot be loaded, nothing is inspected: one error, no line of JSON, exit code 2. \
With --source: follows a camera, a recording or a folder until it ends, until --frames were inspected, or until Ctrl-C. \
A live camera gives its newest frame, and those in between are dropped; every frame of a recording or folder is inspected. \
A frame of a part that moves is not accepted. At the start of a source, a frame is shown up to 0.9 s later, once another \
one shows whether its part hangs still. With --line, parts pass without a stop: a part is accepted once several frames show it \
where the line carried it, and is recorded once.
Exit codes as with files; 1 also if no frame came. Possible sources: partsight capture --help
With --scan: one verdict on all frames together; partsight help scan explains how to give their poses. camera_from_part \
is then the pose in the camera's frame of the first used shot, and base_from_part the pose in the robot's base frame. \
Every inspection is written to the history (partsight history --help) after its verdict is shown; if that fails, there is \
a warning, and the exit code stays the same. A followed source gives one inspection for each part that hung there: the \
verdict that the frames agree on once it hangs still. Each file, and each capture of a watched folder or of a folder of \
single captures, counts as a part of its own.")]
pub(super) struct InspectArgs {
    /// Captured scenes
    #[arg(required_unless_present_any = ["source", "scan"], value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Instead of files: several frames of one part, each with the pose of its camera, for one verdict and one pose; a
    /// folder, a recording or files
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["files", "source", "empty_cell", "rack", "report"])]
    scan: Vec<PathBuf>,
    #[command(flatten)]
    import: ImportChoice,
    #[command(flatten)]
    poses: PosesChoice,
    /// Instead of files: the frames of a camera, a recording or a watched folder as they arrive
    #[arg(long, value_name = "SOURCE", value_parser = parse_source, conflicts_with = "files")]
    source: Option<SourceSpec>,
    /// With --source: number of captures to inspect; default: until Ctrl-C or the end of the source
    #[arg(long, value_name = "N", requires = "source", value_parser = clap::value_parser!(u64).range(1..))]
    frames: Option<u64>,
    #[command(flatten)]
    library: LibraryChoice,
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
    #[command(flatten)]
    carried: carried_path::CarriedPathChoice,
    /// Check the surface of each accepted part: dents, bumps and what is missing. Without it, only parts are checked whose zones
    /// ask for it
    #[arg(long, conflicts_with = "scan")]
    surface: bool,
    /// With --surface: every N files in a row are frames of one part that stands still; the first is inspected, and the surface is
    /// averaged over all
    #[arg(long, value_name = "N", default_value_t = 1, requires = "surface", conflicts_with_all = ["source", "scan"], value_parser = clap::value_parser!(u16).range(1..=64))]
    average: u16,
    /// Write one line of JSON per file, and nothing else, to standard output
    #[arg(long)]
    json: bool,
    /// Write the JSON line and a picture of every stage of each file, and of each part in it, to this folder
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    #[command(flatten)]
    trace: TraceChoice,
    #[command(flatten)]
    recording: RecordingChoice,
    #[command(flatten)]
    publish: PublishArgs,
}

pub(super) fn run(mut args: InspectArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    // Before anything that can fail.
    args.carried.remove_previous()?;
    (args.carried).check(!args.scan.is_empty(), args.source.is_some())?;
    args.import.write_behind(&mut args.files);
    let args = &args;
    args.publish.check(args.source.as_ref())?;
    if !args.scan.is_empty() {
        return scan::inspect(args, console);
    }
    open_ahead(&args.files, |scenes| inspect(args, scenes, console))
}

fn inspect(
    args: &InspectArgs,
    scenes: Scenes<'_>,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let recipe = args.recipe.recipe()?;
    let num_parts = args.files.len().div_ceil(args.average.into());
    let num_parts = args.source.is_none().then_some(num_parts);
    let trace = args.trace.of_parts(num_parts)?;
    let database = args.recording.database(console)?;
    let (place, load) = (args.library).load_placed(&recipe.reference_params(), console)?;
    let robot = args.calibration.frame(console)?;
    let recipe = args.rack.before(recipe, &load.library, robot.as_ref())?;
    let recipe = (args.expect).applied(&recipe, &load.library, Some(&recipe.rack), &trace)?;
    if args.carried.is_forced() && robot.is_none() {
        return Err(no_calibration("--force"));
    }
    let publisher = ChosenPublisher::new(&args.publish, &place, &load, robot.as_ref(), console)?;
    let carried = (args.carried).start(&args.files, robot.as_ref(), place, &load)?;
    let format = match (args.json, args.files.as_slice()) {
        (true, _) => OutputFormat::Json,
        (false, []) => OutputFormat::Rows(Columns::for_captures(&load.library)),
        (false, files) if files.len() <= usize::from(args.average) => OutputFormat::Card,
        (false, files) => OutputFormat::Rows(Columns::for_files(files, &load.library)),
    };
    let report = args.report.as_deref().map(ReportFolder::make);
    let report = report.transpose().advised()?;
    let empty_cell = args.empty_cell.open(console)?;
    let line = args.line.load()?;
    let publisher = publisher
        .map(|publisher| publisher.start(&load, &trace, console))
        .transpose()?;
    let recording = (args.recording).start(&load, &trace, database, console)?;
    format.head(console);
    let following = match (line, &args.source) {
        (Some(line), _) => Following::Line(Box::new(LineTracker::new(line))),
        (None, Some(source)) if source.is_followed() => {
            Following::Hanging(Box::new(PartFollower::default()))
        }
        (None, _) => Following::Independent,
    };
    let setup = StationSetup {
        library: load.library,
        recipe,
        robot,
        is_forced: args.carried.is_forced(),
        checked: if args.surface {
            CheckedParts::All
        } else {
            CheckedParts::OfZones
        },
    };
    let mut one = InspectSession {
        station: Station::new(setup, following),
        trace,
        scenes: match &args.source {
            Some(source) if !source.is_followed() => CameraScenes::independent(empty_cell.clone()),
            _ => CameraScenes::new(empty_cell.clone()),
        },
        empty_cell,
        carried,
        format,
        report,
        recording,
        publisher,
        mirrored: MirrorTally::default(),
        num_unchecked: 0,
    };
    let outcome = match &args.source {
        Some(source) => inspect_source(source, args.frames, &mut one, console),
        None => inspect_files(args, scenes, &mut one, console),
    };
    if let Some(suspicion) = one.mirrored.suspicion() {
        console.warn(&suspicion, &suspicion);
    }
    // Before the publisher, which may wait for the broker.
    if let Some(recording) = one.recording {
        recording.finish(console);
    }
    if let Some(publisher) = one.publisher {
        publisher.end(console);
    }
    let is_reported = one.report.is_some_and(|folder| folder.has_reports());
    if let Some(folder) = args.report.as_ref().filter(|_| is_reported) {
        console.note(&format_args!("The reports are in {}", folder.display()));
    }
    outcome
}

fn inspect_files(
    args: &InspectArgs,
    mut scenes: Scenes<'_>,
    one: &mut InspectSession,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    console.start_progress(args.files.len());
    let mut outcome = Outcome::Accepted;
    let num_more = usize::from(args.average) - 1;
    while let Some((path, opened)) = scenes.next() {
        console.begin(&path.display());
        let mut more = Vec::with_capacity(num_more);
        for (path, opened) in scenes.by_ref().take(num_more) {
            match opened {
                Ok((scene, _)) => more.push(scene),
                Err(error) => {
                    outcome = outcome.max(one.unreadable(path, &error, &error, console)?);
                }
            }
            console.done();
        }
        outcome = outcome.max(one.inspect(path, opened, more, console)?);
        console.done();
    }
    Ok(outcome)
}

/// Inspects the captures of a source as they come.
fn inspect_source(
    source: &SourceSpec,
    frames: Option<u64>,
    inspector: &mut InspectSession,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let mut outcome = Outcome::Accepted;
    let mut num_inspected = 0;
    let feed = start_source(source)?;
    let needs_motion = inspector.station.needs_motion();
    let motion_watch = needs_motion.then(|| MotionWatch::of_source(source, &feed));
    let motion_watch = motion_watch.transpose().advised()?.flatten();
    let motion_watch = motion_watch.as_ref();
    let mut is_slow = false;
    let followed = follow_started(source, &feed, console, |item, status, console| {
        let is_enough = frames.is_some_and(|frames| num_inspected >= frames);
        if let Some(publisher) = &mut inspector.publisher {
            publisher.look(&status.state, console);
            if let Some(FeedItem::Skipped(skipped)) = &item
                && !is_enough
            {
                publisher.skipped(skipped);
            }
        }
        let one = match item {
            None => return Ok(ControlFlow::Continue(())),
            Some(FeedItem::Captured(captured)) if is_enough => {
                let scenes = &mut inspector.scenes;
                let scene = to_inspect(captured, motion_watch, source, status, scenes, console);
                inspector.check(scene, console)?
            }
            Some(FeedItem::Skipped(_)) if is_enough => Outcome::Accepted,
            Some(FeedItem::Skipped(skipped)) => {
                let name = Path::new(&skipped.name);
                inspector.unreadable(name, &*skipped.error, &skipped.error, console)?
            }
            Some(FeedItem::Captured(captured)) => {
                if num_inspected == 0 && captured.is_simulated {
                    console.note(&"Simulated: no camera is read.");
                }
                num_inspected += 1;
                let path = Path::new(&captured.name).to_owned();
                inspector.frame(&path, console, |one, console| {
                    let scenes = &mut one.scenes;
                    let scene = to_inspect(captured, motion_watch, source, status, scenes, console);
                    one.next(scene, console)
                })?
            }
        };
        outcome = outcome.max(one);
        is_slow = warn_if_slow(&inspector.station, is_slow, console);
        Ok(match frames {
            Some(frames) if num_inspected >= frames && !inspector.station.is_waiting() => {
                ControlFlow::Break(())
            }
            _ => ControlFlow::Continue(()),
        })
    });
    let is_shown = console.is_writable();
    // Also if the source has failed: its last parts are recorded.
    let waiting = inspector.end(source.is_replayed(), console);
    let status = followed?;
    let waiting = waiting?;
    if is_shown {
        outcome = outcome.max(waiting);
    }
    let (dropped, skipped) = (status.num_dropped, status.num_skipped);
    console.note(&format_args!(
        "{num_inspected} inspected, {dropped} dropped, {skipped} could not be read"
    ));
    if inspector.num_unchecked > 0 {
        console.note(&format_args!(
            "{} accepted without a check whether the part hangs still: no later frame of the source shows it",
            inspector.num_unchecked
        ));
    }
    // Nothing was inspected, so nothing was accepted.
    Ok(if num_inspected == 0 {
        outcome.max(Outcome::NotAccepted)
    } else {
        outcome
    })
}

/// Warns once verdicts wait because the computer inspects too few frames; `is_known` says whether that was so before. Returns
/// whether it is.
fn warn_if_slow(station: &Station<KeptInspection>, is_known: bool, console: &Console) -> bool {
    let rate = station.held_up_by();
    if let Some(rate) = rate.filter(|_| !is_known) {
        let why = rate.refusal(String::new());
        console.warn(&why, &why);
    }
    rate.is_some()
}

/// The scene of a capture from a source.
fn to_inspect(
    captured: Captured,
    motion_watch: Option<&MotionWatch>,
    source: &SourceSpec,
    status: &FeedStatus,
    scenes: &mut CameraScenes,
    console: &Console,
) -> SceneToInspect {
    let (taken_at, arrived) = (captured.taken_at, captured.arrived);
    SceneToInspect {
        path: Path::new(&captured.name).to_owned(),
        subject: Subject::of_capture(&captured, source, status.num_dropped),
        captured_at: Some(NewFrame::of_source(source).captured_at(&captured)),
        more: Vec::new(),
        scene: scene_of(captured, scenes, console),
        // Last, as it may wait.
        watched: motion_watch.map(|motion| motion.motion_of(taken_at, arrived, || false)),
    }
}
