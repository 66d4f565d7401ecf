//! `partsight inspect`: recognises the part and estimates its pose.

pub(in crate::cli) mod hung;
mod program;
#[cfg(feature = "plant")]
mod publish;
mod scan;
mod spray;

use std::{
    fmt::Display,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::Arc,
};

use clap::Args;

use self::hung::{FollowedFrame, FollowedParts};
use super::{
    LibraryChoice, Outcome,
    calibrate::CalibrationChoice,
    console::{Advised as _, Console, marked_simulated},
    follow::{follow, parse_source},
    input::{FileAdvice, ImportChoice, OpenedScene, Scenes, before, open_ahead, open_empty_cell},
    output::{Columns, OutputFormat},
    recipe::{RecipeChoice, show_recipe},
    record::{HistoryChoice, HistoryRecorder, SceneOrigin},
    scan::PosesChoice,
    trace::TraceChoice,
    verdict::{outcome_of, show_in_robot},
};
#[cfg(feature = "plant")]
use super::{database::HistoryToChoice, mqtt::MqttChoice, numbers::NumbersChoice};
use crate::{
    capture::{FeedItem, SourceSpec},
    error::{Advice, guarded},
    history::{HungId, NewEntry, Traceability},
    library::Library,
    pipeline::{self, Inspection, MirrorTally, NamedRecipe, Unwatched},
    report::{CaptureLine, InspectionLine, Picture, ReportFolder, stage_pictures},
    robot::RobotFrame,
    stages::{
        reference::Reference,
        scene::{EmptyCell, SceneCloud, scene_from_image},
    },
};

#[cfg(feature = "plant")]
use crate::serve::Found;

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
  partsight inspect door.pcd --matcher paper --pose icp-ga
  partsight inspect door.pcd --json --calibration cell.toml
  partsight inspect door.pcd --calibration cell.toml --spray path.csv --spray-as kuka
  partsight inspect door.pcd --calibration cell.toml --program paint.src --tool 3
  partsight inspect --scan frames/ --poses poses.json --json
  partsight inspect --source simulated
  partsight inspect --source watch:/mnt/scanner --json

Files: PCD, PLY, XYZ or CSV text, or a 16-bit depth PNG with its intrinsics in a JSON beside it.
Clouds are in metres, unless --units says otherwise. The JSON has width, height, fx, fy, cx, cy and metres_per_unit, and
may have k1 k2 p1 p2 k3 k4 k5 k6 (OpenCV's lens distortion), \"mirrored\": true (left and right are swapped in the image)
and \"rotated\": 90, 180 or 270 (degrees clockwise to turn the image by). All of these refer to the image as it is stored.
Exit codes: 0 every input accepted, 1 something was not accepted, 2 something could not be read.
If the library is empty or cannot be loaded, nothing is inspected: one error, no line of JSON, exit code 2.
With --source: follows a camera, a recording or a folder until it ends, until --frames were inspected, or until Ctrl-C.
A live camera gives its newest frame, and those in between are dropped; every frame of a recording or folder is inspected.
Exit codes as with files; 1 also if no frame came. Possible sources: partsight capture --help
With --scan: one verdict on all frames together; partsight help scan explains how to give their poses. camera_from_part
is then the pose in the camera's frame of the first used shot, and base_from_part the pose in the robot's base frame.
Every inspection is written to the history (partsight history --help) after its verdict is shown; if that fails, there is
a warning, and the exit code stays the same. A followed source gives one inspection for each part that hung there: the
verdict that the frames agree on once it hangs still. Each file, and each capture of a watched folder or of a folder of
single captures, counts as a part of its own.")]
pub(super) struct InspectArgs {
    /// Captured scenes
    #[arg(required_unless_present_any = ["source", "scan"], value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Instead of files: several frames of one part, each with the pose of its camera, for one verdict and one pose; a
    /// folder, a recording or files
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["files", "source", "empty_cell", "spray", "program", "report"])]
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
    /// Capture of the empty cell by the same camera: nothing in it is taken for a part
    #[arg(long, value_name = "FILE")]
    empty_cell: Option<PathBuf>,
    #[command(flatten)]
    calibration: CalibrationChoice,
    #[command(flatten)]
    spray: spray::SprayChoice,
    #[command(flatten)]
    program: program::ProgramChoice,
    /// Write one line of JSON per file, and nothing else, to standard output
    #[arg(long)]
    json: bool,
    /// Write the JSON line and a picture of every stage of each file to this folder
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    #[command(flatten)]
    trace: TraceChoice,
    #[command(flatten)]
    history: HistoryChoice,
    /// Do not write to the history
    #[arg(long, conflicts_with = "history")]
    no_history: bool,
    #[cfg(feature = "plant")]
    #[command(flatten)]
    mqtt: MqttChoice,
    #[cfg(feature = "plant")]
    #[command(flatten)]
    numbers: NumbersChoice,
    #[cfg(feature = "plant")]
    #[command(flatten)]
    history_to: HistoryToChoice,
}

pub(super) fn run(mut args: InspectArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    args.import.write_behind(&mut args.files);
    let args = &args;
    #[cfg(feature = "plant")]
    publish::check(args)?;
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
    let num_parts = args.source.is_none().then_some(args.files.len());
    let trace = args.trace.of_parts(num_parts)?;
    #[cfg(feature = "plant")]
    let database = args.history_to.chosen(console)?;
    let (place, load) = (args.library).load_placed(&recipe.reference_params(), console)?;
    let robot = args.calibration.frame(console)?;
    #[cfg(feature = "plant")]
    let publisher = publish::ChosenPublisher::of(args, &place, &load, robot.as_ref(), console)?;
    let (files, frame) = (&args.files, robot.as_ref());
    let (spray, program) = if args.program.is_wanted() {
        (None, args.program.start(files, frame, place, &load)?)
    } else {
        (args.spray.start(files, frame, place, &load)?, None)
    };
    let format = match (args.json, args.files.as_slice()) {
        (true, _) => OutputFormat::Json,
        (false, []) => OutputFormat::Rows(Columns::for_captures(&load.library)),
        (false, [_]) => OutputFormat::Card,
        (false, files) => OutputFormat::Rows(Columns::for_files(files, &load.library)),
    };
    let report = args.report.as_deref().map(ReportFolder::make);
    let report = report.transpose().advised()?;
    let empty_cell = args
        .empty_cell
        .as_deref()
        .map(|path| open_empty_cell(path, console));
    let empty_cell = empty_cell.transpose()?;
    let recording = (!args.no_history)
        .then(|| HistoryRecorder::start(&args.history, &load, &recipe, &trace, console))
        .flatten();
    #[cfg(feature = "plant")]
    let publisher = publisher
        .zip(args.source.as_ref())
        .map(|(publisher, source)| publisher.start(source, &load, &trace, console))
        .transpose()?;
    #[cfg(feature = "plant")]
    let recording = recording
        .map(|recording| recording.sent_to(database))
        .transpose()?;
    format.head(console);
    let mut one = InspectSession {
        library: load.library,
        recipe,
        trace,
        empty_cell,
        robot,
        spray,
        program,
        format,
        report,
        recording,
        followed: (args.source.as_ref())
            .filter(|source| source.is_followed())
            .map(|_| FollowedParts::new()),
        #[cfg(feature = "plant")]
        publisher,
        mirrored: MirrorTally::default(),
    };
    let outcome = match &args.source {
        Some(source) => inspect_source(source, args.frames, &mut one, console),
        None => inspect_files(args.files.len(), scenes, &mut one, console),
    };
    if let Some(suspicion) = one.mirrored.suspicion() {
        console.warn(&suspicion, &suspicion);
    }
    if let Some(kept) = one.followed.take().and_then(FollowedParts::end) {
        one.keep(kept, console);
    }
    // Before the publisher, which may wait for the broker.
    if let Some(recording) = one.recording {
        recording.finish(console);
    }
    #[cfg(feature = "plant")]
    if let Some(publisher) = one.publisher {
        publisher.end(console);
    }
    if let Some(folder) = &args.report {
        console.note(&format_args!("The reports are in {}", folder.display()));
    }
    outcome
}

fn inspect_files(
    num_files: usize,
    scenes: Scenes<'_>,
    one: &mut InspectSession,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    console.start_progress(num_files);
    let mut outcome = Outcome::Accepted;
    for (path, opened) in scenes {
        console.begin(&path.display());
        outcome = outcome.max(one.inspect(path, opened, console)?);
        console.done();
    }
    Ok(outcome)
}

/// State shared by all files or frames of a call.
struct InspectSession {
    library: Library,
    recipe: NamedRecipe,
    trace: Traceability,
    empty_cell: Option<Arc<EmptyCell>>,
    robot: Option<RobotFrame>,
    spray: Option<spray::SprayFile>,
    program: Option<program::CapturedProgram>,
    format: OutputFormat,
    report: Option<ReportFolder>,
    recording: Option<HistoryRecorder>,
    /// Set for a source whose frames show one part after the other.
    followed: Option<FollowedParts<KeptInspection>>,
    #[cfg(feature = "plant")]
    publisher: Option<publish::Publisher>,
    mirrored: MirrorTally,
}

/// An inspection to store and publish once its verdict counts.
struct KeptInspection {
    /// Entry for the history.
    entry: Option<NewEntry>,
    /// Result for the broker.
    #[cfg(feature = "plant")]
    found: Option<Found>,
}

impl InspectSession {
    fn inspect(
        &mut self,
        path: &Path,
        opened: OpenedScene,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let name = path.display().to_string();
        match opened {
            Ok((scene, warnings)) => {
                for warning in &warnings {
                    console.warn(&format_args!("{name}: {warning}"), &FileAdvice(warning));
                }
                self.frame(path, console, |one, console| {
                    one.inspect_scene(path, scene, None, console)
                })
            }
            // The message names the file.
            Err(error) => self.unreadable(path, &error, &error, console),
        }
    }

    /// Inspects one of many frames: a fault of the program there becomes an error of that frame, and the next one
    /// follows.
    fn frame(
        &mut self,
        path: &Path,
        console: &mut Console,
        inspect: impl FnOnce(&mut Self, &mut Console) -> anyhow::Result<Outcome>,
    ) -> anyhow::Result<Outcome> {
        guarded(|| inspect(self, console)).unwrap_or_else(|fault| {
            #[cfg(feature = "plant")]
            if let Some(publisher) = &mut self.publisher {
                publisher.failed(&fault);
            }
            let shown = format!("{}: {fault}", path.display());
            self.unreadable(path, &fault, &shown, console)
        })
    }

    /// Reports an input that is not a scene; `shown` is the error as text for people.
    fn unreadable(
        &mut self,
        path: &Path,
        error: &impl Advice,
        shown: &dyn Display,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let name = path.display().to_string();
        let line = InspectionLine::unreadable(&name, shown).to_json();
        self.format.unreadable(&name, &line, console);
        console.note(&format_args!("error: {shown}"));
        console.note(&format_args!("  to do: {}", error.advice()));
        if let Some(report) = &mut self.report {
            report.write(path, &line, &[]).advised()?;
        }
        Ok(Outcome::CouldNotRun)
    }

    /// Inspects a scene; `capture` is known if a source captured it. The report is named after the path.
    fn inspect_scene(
        &mut self,
        path: &Path,
        mut scene: SceneCloud,
        capture: Option<CaptureLine<'_>>,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let Self {
            library,
            recipe,
            trace,
            empty_cell,
            robot,
            format,
            report,
            recording,
            followed,
            #[cfg(feature = "plant")]
            publisher,
            mirrored,
            ..
        } = self;
        let name = path.display().to_string();
        before(&mut scene, empty_cell.as_ref(), &name, console);
        if let Some(followed) = followed {
            scene.set_known_view(followed.known_view());
        }
        let scene = Arc::new(scene);
        let inspection = pipeline::run(&scene, library, recipe, &Unwatched)?;
        mirrored.add(&inspection.verdict);
        let file_says_simulated = capture.is_none() && scene.cloud.is_simulated;
        let taken = SceneOrigin {
            scene: &name,
            source: capture.as_ref().map_or("file", CaptureLine::source),
            is_simulated: capture.map_or(file_says_simulated, |c| c.is_simulated()),
        };
        let robot = robot.as_ref();
        let line_of = |inspection: &Inspection| {
            let mut line = InspectionLine::of(&name, inspection)
                .by(recipe)
                .traced(trace)
                .captured(capture);
            if file_says_simulated {
                line = line.of_simulated_file();
            }
            line.in_robot(robot, inspection).to_json()
        };
        let line = line_of(&inspection);
        // The table has no room for the mark; reports and history have it.
        let shown = match format {
            OutputFormat::Card => marked_simulated(&name, file_says_simulated),
            _ => name.clone(),
        };
        format.inspected(&shown, &line, &inspection, library, console);
        if let OutputFormat::Card = format {
            show_recipe(recipe, console);
        }
        if let (OutputFormat::Card, Some(robot)) = (format, robot) {
            show_in_robot(robot, &inspection, library, console);
        }
        let outcome = outcome_of(&inspection);
        let pictures = report.as_ref().map(|_| stage_pictures(&scene, &inspection));
        // After the verdict is shown, which must not wait for it, and before the exports, any of which may fail.
        let is_kept = recording.is_some();
        #[cfg(feature = "plant")]
        let is_kept = is_kept || publisher.is_some();
        let kept = |inspection: &Inspection, hung: HungId| KeptInspection {
            entry: recording.as_ref().map(|recording| {
                recording.entry(taken, &scene, inspection, &line_of(inspection), hung)
            }),
            #[cfg(feature = "plant")]
            found: (publisher.as_ref()).and_then(|publisher| publisher.found(inspection, recipe)),
        };
        if let (true, Some(followed), Some(capture)) = (is_kept, followed, capture) {
            let frame = FollowedFrame {
                scene: &scene,
                taken_at: capture.taken_at(),
                middle: inspection
                    .best_reference(library)
                    .and_then(Reference::middle),
                accept: &recipe.accept,
            };
            let kept = followed.take(&frame, inspection, kept);
            for kept in kept.into_iter().flatten() {
                self.keep(kept, console);
            }
            // Paths and programs are only written for files.
            self.write_report(path, &line, pictures)?;
            return Ok(outcome);
        }
        if is_kept {
            let kept = kept(&inspection, HungId::new());
            self.keep(kept, console);
        }
        let seen = spray::SprayResult {
            scene: &name,
            inspection: &inspection,
            library: &self.library,
            params: &self.recipe.stand_off,
        };
        Ok(match (&self.spray, &self.program, &self.robot) {
            (Some(spray), _, Some(robot)) => outcome.max(spray.write(&seen, robot, console)?),
            // A refused part keeps its outcome even if its program was forced.
            (_, Some(program), Some(robot)) => {
                outcome.max(program.write(&seen, file_says_simulated, robot, console)?)
            }
            _ => {
                self.write_report(path, &line, pictures)?;
                outcome
            }
        })
    }

    /// Writes line and pictures of an inspection, if there is a folder for them.
    fn write_report(
        &mut self,
        path: &Path,
        line: &str,
        pictures: Option<Vec<Picture>>,
    ) -> anyhow::Result<()> {
        if let (Some(report), Some(pictures)) = (&mut self.report, pictures) {
            report.write(path, line, &pictures).advised()?;
        }
        Ok(())
    }

    /// Passes an inspection to the history and to the publisher.
    fn keep(&mut self, kept: KeptInspection, console: &Console) {
        if let (Some(recording), Some(entry)) = (&mut self.recording, kept.entry) {
            recording.add(entry, console);
        }
        #[cfg(feature = "plant")]
        if let (Some(publisher), Some(found)) = (&mut self.publisher, kept.found) {
            publisher.publish(found);
        }
    }
}

/// Inspects the captures of a source as they come.
fn inspect_source(
    source: &SourceSpec,
    frames: Option<u64>,
    inspector: &mut InspectSession,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let text = source.to_string();
    let mut outcome = Outcome::Accepted;
    let mut num_inspected = 0;
    let status = follow(source, console, |item, status, console| {
        #[cfg(feature = "plant")]
        if let Some(publisher) = &mut inspector.publisher {
            publisher.look(&status.state, console);
            match &item {
                Some(FeedItem::Captured(captured)) => publisher.begin(captured),
                Some(FeedItem::Skipped(skipped)) => publisher.skipped(skipped),
                None => {}
            }
        }
        let one = match item {
            None => return Ok(ControlFlow::Continue(())),
            Some(FeedItem::Skipped(skipped)) => {
                let name = Path::new(&skipped.name);
                inspector.unreadable(name, &*skipped.error, &skipped.error, console)?
            }
            Some(FeedItem::Captured(captured)) => {
                if num_inspected == 0 && captured.is_simulated {
                    console.note(&"Simulated: no camera is read.");
                }
                for warning in &captured.warnings {
                    console.warn(&format_args!("{}: {warning}", captured.name), warning);
                }
                num_inspected += 1;
                let line = CaptureLine::of(&text, &captured, status.num_dropped);
                let path = Path::new(&captured.name);
                let image = captured.image;
                inspector.frame(path, console, |one, console| {
                    one.inspect_scene(path, scene_from_image(image), Some(line), console)
                })?
            }
        };
        outcome = outcome.max(one);
        Ok(match frames {
            Some(frames) if num_inspected >= frames => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        })
    })?;
    let (dropped, skipped) = (status.num_dropped, status.num_skipped);
    console.note(&format_args!(
        "{num_inspected} inspected, {dropped} dropped, {skipped} could not be read"
    ));
    // Nothing was inspected, so nothing was accepted.
    Ok(if num_inspected == 0 {
        outcome.max(Outcome::NotAccepted)
    } else {
        outcome
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_at_which_the_program_fails_is_unreadable_and_the_next_one_comes() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut session = InspectSession {
            library: Library::default(),
            recipe: NamedRecipe::default(),
            trace: Traceability::default(),
            empty_cell: None,
            robot: None,
            spray: None,
            program: None,
            format: OutputFormat::Card,
            report: Some(ReportFolder::make(folder.path()).expect("made")),
            recording: None,
            followed: None,
            #[cfg(feature = "plant")]
            publisher: None,
            mirrored: MirrorTally::default(),
        };
        let mut console = Console::new();
        let failed = session.frame(Path::new("a.pcd"), &mut console, |_, _| {
            panic!("no ray for this pixel")
        });
        assert_eq!(failed.expect("it goes on"), Outcome::CouldNotRun);
        let kept = std::fs::read_to_string(folder.path().join("a.report.json")).expect("its line");
        assert!(
            kept.contains("unreadable") && kept.contains("no ray for this pixel"),
            "{kept}"
        );
        let sound = session.frame(Path::new("b.pcd"), &mut console, |one, console| {
            one.inspect_scene(Path::new("b.pcd"), SceneCloud::default(), None, console)
        });
        assert_eq!(sound.expect("inspected"), Outcome::NotAccepted);
    }
}
