//! `partsight-bench soak`: runs very many frames through everything that `inspect --source` does, and checks whether
//! memory, threads or handles keep growing.

use std::{
    path::PathBuf,
    sync::Arc,
    time::{Duration, Instant},
};

use anyhow::Context as _;
use clap::Args;
use jiff::{SignedDuration, Timestamp};
use serde::Serialize;

use super::{JsonFile, write_json};
use crate::process_usage::ProcessUsage;
use capture::{
    BackpressurePolicy, CaptureError, Captured, DepthSource, Feed, FeedItem, Image, NextCapture,
    SimulatedSpec, SourceSpec,
};
use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    statistics::quantile,
};
use inspection::{library::LibraryLoad, pipeline::NamedRecipe};
use partsight::cli::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table, advised_error},
};
use records::{
    history::{HistoryEvent, HungId, NewEntry, Traceability},
    report::{SizeCurve, curves_picture, segmentation_picture, write_png},
};
use simulate::{CellSetup, PartKind, Side, SimulatedObject, frame};
use station::{
    CameraScenes, Following, Inspected, LibraryNames, PartFollower, Recorder, SceneToInspect,
    Settled, Station, StationSetup, Subject,
};

/// Number of lines of the table.
const NUM_STRETCHES: u64 = 20;
/// Number of stretches until every part has hung there several times and every store has its full size.
const WARM_UP: usize = 4;
/// Largest allowed growth of the memory after the warm-up.
const MOST_GROWTH: f64 = 0.02;

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct SoakFile {
    schema: u32,
    simulated: bool,
    num_frames: u64,
    /// Growth from the end of the warm-up to the end, as a share; `null` where the system does not report memory.
    memory_growth: Option<f64>,
    stretches: Vec<Stretch>,
}

#[derive(Debug, Serialize)]
struct Stretch {
    until_frame: u64,
    until_s: f64,
    latency_p50_ms: f64,
    latency_p95_ms: f64,
    latency_longest_ms: f64,
    num_accepted: u64,
    num_in_history: u64,
    usage: Option<ProcessUsage>,
}

/// A camera with few pixels: every part hangs still for a while, then the cell is empty until the next one comes.
struct SmallCell {
    pictures: Arc<[Pictures]>,
    begun: Timestamp,
    num_given: u64,
    num_frames: u64,
}

/// The cell with a part and without one.
struct Pictures {
    with_part: DepthFrame,
    empty: DepthFrame,
}

impl SmallCell {
    /// Number of frames for which a part hangs there: enough for a verdict that counts.
    const HANGING: u64 = 30;
    /// Number of frames from one part to the next.
    const CYCLE: u64 = 120;
    const FRAMES_PER_SECOND: i64 = 30;
    /// Every how many of the Kinect's rows and columns one is kept.
    const STEP: usize = 4;

    /// Every how many rounds of the enrolled parts one that is not enrolled hangs there.
    const UNKNOWN_EVERY: u64 = 7;
    const NUM_ROUNDS: u64 = 28;

    /// Frames of the enrolled parts; a small library makes for cheap ones.
    fn pictures(load: &LibraryLoad) -> Arc<[Pictures]> {
        let is_enrolled = |kind: &PartKind| {
            load.parts
                .iter()
                .any(|part| part.name.as_str() == kind.name())
        };
        let (enrolled, others): (Vec<_>, Vec<_>) = PartKind::ALL.into_iter().partition(is_enrolled);
        let mut setups = Vec::new();
        for seed in 0..Self::NUM_ROUNDS {
            let other = others.get((seed / Self::UNKNOWN_EVERY) as usize);
            let other = other.filter(|_| seed % Self::UNKNOWN_EVERY == 0);
            let kinds = enrolled.iter().chain(other);
            setups.extend(kinds.map(|kind| CellSetup::with_part(*kind, Side::Left, 0, seed)));
        }
        let pictures = setups.iter().map(|setup| Pictures {
            with_part: smaller(&frame(setup).frame),
            empty: smaller(&frame(&CellSetup::new(SimulatedObject::Nothing, setup.seed)).frame),
        });
        pictures.collect()
    }
}

/// Keeps every fourth row and column.
fn smaller(frame: &DepthFrame) -> DepthFrame {
    let old = frame.intrinsics;
    let step = SmallCell::STEP;
    let part = |number: f64| number / step as f64;
    let rows = frame.depth.chunks(old.width).step_by(step);
    DepthFrame {
        intrinsics: Intrinsics {
            width: old.width.div_ceil(step),
            height: old.height.div_ceil(step),
            fx: part(old.fx),
            fy: part(old.fy),
            cx: part(old.cx),
            cy: part(old.cy),
            ..old
        },
        depth: rows
            .flat_map(|row| row.iter().step_by(step).copied())
            .collect(),
        ..*frame
    }
}

impl DepthSource for SmallCell {
    fn title(&self) -> String {
        "Simulated cell, few pixels".into()
    }

    fn is_simulated(&self) -> bool {
        true
    }

    fn next(&mut self, _wait: Duration) -> Result<NextCapture, CaptureError> {
        if self.num_given == self.num_frames {
            return Ok(NextCapture::End);
        }
        let cycle = (self.num_given / Self::CYCLE) as usize;
        let pictures = &self.pictures[cycle % self.pictures.len()];
        let is_hanging = self.num_given % Self::CYCLE < Self::HANGING;
        let nanoseconds = self.num_given as i64 * (1_000_000_000 / Self::FRAMES_PER_SECOND);
        self.num_given += 1;
        let name = format!("simulated frame {}", self.num_given);
        let picture = if is_hanging {
            &pictures.with_part
        } else {
            &pictures.empty
        };
        let image = Image::Depth(picture.clone());
        Ok(NextCapture::Captured(Captured {
            taken_at: self.begun + SignedDuration::from_nanos(nanoseconds),
            ..Captured::now(self.num_given, name, image)
        }))
    }
}

/// Inspects and records the frames.
struct Follower {
    station: Station<NewEntry>,
    identity: String,
    scenes: CameraScenes,
    recorder: Recorder,
    source: SourceSpec,
    num_accepted: u64,
    num_in_history: u64,
}

impl Follower {
    /// Takes in a frame as `inspect --source` does, without printing. Returns the latency.
    fn take(&mut self, captured: Captured) -> anyhow::Result<Duration> {
        let arrived = captured.arrived;
        let scene = SceneToInspect {
            path: (&captured.name).into(),
            subject: Subject::of_capture(&captured, &self.source, 0),
            captured_at: None,
            more: Vec::new(),
            watched: None,
            scene: self.scenes.next(captured.image),
        };
        let identity = &self.identity;
        let entry = |part: &Inspected<'_>, hung, _| entry_of(part, hung, identity);
        let settled = self.station.next(scene, entry);
        self.settled(settled);
        check(&self.recorder)?;
        Ok(arrived.elapsed())
    }

    fn settled(&mut self, settled: Settled<NewEntry>) {
        for scene in &settled.scenes {
            self.num_accepted += u64::from(scene.parts[0].verdict.is_accepted());
            // Not printed, but formatting it is part of the work.
            let parts = self.station.parts(scene);
            drop(Inspected::line_of_all(&parts, &Traceability::default()));
        }
        for entry in settled.recorded {
            self.num_in_history += 1;
            self.recorder.add(entry);
        }
    }

    /// Records the last part.
    fn end(&mut self) {
        let identity = &self.identity;
        let entry = |part: &Inspected<'_>, hung, _| entry_of(part, hung, identity);
        let settled = self.station.end(false, entry);
        self.settled(settled);
    }
}

fn entry_of(part: &Inspected<'_>, hung: HungId, identity: &str) -> NewEntry {
    let names = LibraryNames {
        identity,
        title_of: &str::to_owned,
    };
    let picture = segmentation_picture(part.scene, &part.inspection.segmentation);
    part.entry(hung, Traceability::default(), names, picture.as_ref())
}

#[derive(Debug, Args)]
pub(super) struct SoakArgs {
    #[command(flatten)]
    file: JsonFile,
    /// Number of frames, at least 100000, so that every part hangs there and the history's cache fills in the first fifth, the warm-up. A library with few parts makes it quicker
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(100_000..=1_000_000_000))]
    frames: u64,
    /// Draw the figures into this file
    #[arg(long, value_name = "PNG")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    library: LibraryChoice,
}

pub(super) fn run(args: &SoakArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let recipe = NamedRecipe::default();
    let load = args
        .library
        .load_some(&recipe.reference_params(), console)?;
    let folder = tempfile::tempdir()?;
    let recorder = Recorder::start(folder.path().to_owned())?;
    let setup = StationSetup {
        library: load.library.clone(),
        recipe,
        ..StationSetup::default()
    };
    let following = Following::Hanging(Box::new(PartFollower::default()));
    let mut follower = Follower {
        station: Station::new(setup, following),
        scenes: CameraScenes::default(),
        recorder,
        identity: load.identity(),
        source: SourceSpec::Simulated(SimulatedSpec::default()),
        num_accepted: 0,
        num_in_history: 0,
    };
    let (pictures, num_frames) = (SmallCell::pictures(&load), args.frames);
    console.line(&format_args!(
        "Simulated: {num_frames} frames of {} by {} pixels, the history in {}.",
        pictures[0].empty.intrinsics.width,
        pictures[0].empty.intrinsics.height,
        folder.path().display()
    ));
    let open = move || {
        Ok(Box::new(SmallCell {
            pictures: Arc::clone(&pictures),
            begun: Timestamp::UNIX_EPOCH,
            num_given: 0,
            num_frames,
        }) as Box<dyn DepthSource>)
    };
    let feed = Feed::start_with(open, BackpressurePolicy::Every, || ()).advised()?;
    let stretches = stretches(&feed, &mut follower, num_frames, console)?;
    end(follower, console)?;
    show(&stretches, console);
    let memory_growth = growth(&stretches);
    if let Some(path) = &args.plot {
        write_png(path, &picture(&stretches))
            .advised()
            .with_context(|| format!("{} was not written", path.display()))?;
    }
    if let Some(path) = &args.file.json {
        let file = SoakFile {
            schema: 1,
            simulated: true,
            num_frames,
            memory_growth,
            stretches,
        };
        write_json(path, &file)?;
    }
    let Some(grown) = memory_growth else {
        console.note(&"This system does not tell how much memory the program uses.");
        return Ok(Outcome::Accepted);
    };
    console.line(&format_args!(
        "Memory after the warm-up of {} %: {:+.1} %, at most +{:.0} % expected.",
        100 * WARM_UP / NUM_STRETCHES as usize,
        100.0 * grown,
        100.0 * MOST_GROWTH
    ));
    Ok(Outcome::accepted_if(grown <= MOST_GROWTH))
}

/// Takes the news of the history, which would pile up; an error if it cannot be written.
fn check(recorder: &Recorder) -> anyhow::Result<()> {
    for news in recorder.take_news() {
        if let HistoryEvent::Failed { what, advice } = news {
            return Err(advised_error(what, advice));
        }
    }
    Ok(())
}

/// Records the last part, and waits until everything is written.
fn end(mut follower: Follower, console: &Console) -> anyhow::Result<()> {
    follower.end();
    let Follower { recorder, .. } = follower;
    recorder.finish();
    check(&recorder)?;
    let losses = recorder.losses();
    let num = losses.num_unwritten + losses.num_slow + losses.num_bare;
    if num > 0 {
        console.note(&format_args!(
            "warning: {num} inspections are not, or without frames, in the history: the disk is too slow"
        ));
    }
    Ok(())
}

/// Takes in all frames of the feed, and measures each twentieth of them.
fn stretches(
    feed: &Feed,
    follower: &mut Follower,
    num_frames: u64,
    console: &mut Console,
) -> anyhow::Result<Vec<Stretch>> {
    let begun = Instant::now();
    console.start_progress(NUM_STRETCHES as usize);
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut latencies = Vec::new();
    let mut num_taken = 0;
    while let Some(FeedItem::Captured(captured)) = feed.wait(Duration::from_mins(1)) {
        let latency = follower.take(captured)?;
        latencies.push(latency.as_secs_f64() * 1e3);
        num_taken += 1;
        if num_taken < num_frames * (stretches.len() as u64 + 1) / NUM_STRETCHES {
            continue;
        }
        let share = |share| quantile(latencies.iter().copied(), share).unwrap_or(0.0);
        stretches.push(Stretch {
            until_frame: num_taken,
            until_s: begun.elapsed().as_secs_f64(),
            latency_p50_ms: share(0.5),
            latency_p95_ms: share(0.95),
            latency_longest_ms: share(1.0),
            num_accepted: follower.num_accepted,
            num_in_history: follower.num_in_history,
            usage: ProcessUsage::now(),
        });
        latencies.clear();
        console.done();
    }
    console.end_progress();
    Ok(stretches)
}

/// Returns the relative growth of the memory from the end of the warm-up to the last stretches.
fn growth(stretches: &[Stretch]) -> Option<f64> {
    let memory = |stretches: &[Stretch]| {
        let memory = stretches
            .iter()
            .filter_map(|stretch| Some(stretch.usage?.memory_mb));
        // The median ignores memory that is taken and returned within moments.
        quantile(memory, 0.5)
    };
    let (first, rest) = stretches.get(WARM_UP..)?.split_at_checked(3)?;
    let last = rest.get(rest.len().checked_sub(3)?..)?;
    Some(memory(last)? / memory(first)? - 1.0)
}

/// Draws what must stay constant over the frames.
fn picture(stretches: &[Stretch]) -> image::RgbImage {
    let curve = |name: &str, of: &dyn Fn(&Stretch) -> Option<f64>| {
        let points = stretches.iter();
        let points = points.filter_map(|stretch| Some([stretch.until_frame as f64, of(stretch)?]));
        SizeCurve {
            name: name.into(),
            points: points.collect(),
        }
    };
    let usage = |of: fn(ProcessUsage) -> f64| move |stretch: &Stretch| stretch.usage.map(of);
    let curves = [
        curve("memory, MB", &usage(|usage| usage.memory_mb)),
        curve("95 %, ms", &|stretch| Some(stretch.latency_p95_ms)),
        curve("median, ms", &|stretch| Some(stretch.latency_p50_ms)),
        curve("handles", &usage(|usage| usage.num_handles as f64)),
    ];
    curves_picture(
        "Soak, simulated",
        ["frames", "MB, ms, number"],
        &curves,
        None,
    )
}

fn show(stretches: &[Stretch], console: &mut Console) {
    let mut table = Table::new(&[
        "frames", "until", "median", "95 %", "longest", "accepted", "history", "memory", "threads",
        "handles",
    ]);
    for stretch in stretches {
        let of = |words: &dyn Fn(ProcessUsage) -> String| {
            stretch.usage.map_or_else(|| "-".to_owned(), words)
        };
        table.row([
            stretch.until_frame.to_string(),
            format!("{:.0} s", stretch.until_s),
            format!("{:.1} ms", stretch.latency_p50_ms),
            format!("{:.1} ms", stretch.latency_p95_ms),
            format!("{:.0} ms", stretch.latency_longest_ms),
            stretch.num_accepted.to_string(),
            stretch.num_in_history.to_string(),
            of(&|usage| format!("{:.1} MB", usage.memory_mb)),
            of(&|usage| usage.num_threads.to_string()),
            of(&|usage| usage.num_handles.to_string()),
        ]);
    }
    console.table(&table);
}
