//! `partsight capture`: records the frames of a source.

mod arm;

use std::{
    ops::ControlFlow,
    path::{Path, PathBuf},
};

use clap::Args;

use self::arm::{ArmChoice, ArmPoseSource, FramePoseResult};
use super::{
    Outcome,
    console::{Advised as _, Console, Table, advised_error},
    follow::{follow, parse_source},
};
use capture::{
    CameraLibrary, CaptureWarning, FeedItem, OPENNI, REALSENSE, Recorder, SourceSpec, list,
};
use geometry::error::Advice as _;

/// Record the frames of a camera, a folder or the simulated cell, to be replayed and inspected later
#[derive(Debug, Args)]
#[command(after_help = super::follow::SOURCES)]
pub(super) struct CaptureArgs {
    /// What to record; see below
    #[arg(long, value_name = "SOURCE", value_parser = parse_source, required_unless_present = "list")]
    source: Option<SourceSpec>,
    /// Number of frames to record; default: until Ctrl-C or the end of the source
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    frames: Option<u64>,
    /// Folder of the recording; must be empty or not exist yet
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    out: Option<PathBuf>,
    #[command(flatten)]
    arm: ArmChoice,
    /// List the sources that can be opened now
    #[arg(long, conflicts_with_all = ["source", "frames", "out"])]
    list: bool,
}

pub(super) fn run(args: &CaptureArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    match (&args.source, &args.out) {
        (Some(source), Some(out)) => {
            let arm = ArmPoseSource::of(&args.arm)?;
            record(source, out, (args.frames, arm), console)
        }
        _ => Ok(show_list(console)),
    }
}

fn record(
    source: &SourceSpec,
    out: &Path,
    (frames, mut arm): (Option<u64>, ArmPoseSource),
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let frames = frames.or(arm.num_left());
    let mut recorder: Option<Recorder> = None;
    let mut outcome = Outcome::Accepted;
    let mut shown: Vec<CaptureWarning> = Vec::new();
    match frames {
        Some(frames) => console.start_progress(usize::try_from(frames).unwrap_or(usize::MAX)),
        None => console.start_counting(),
    }
    let status = follow(source, console, |item, status, console| {
        let mut captured = match item {
            None => return Ok(ControlFlow::Continue(())),
            Some(FeedItem::Captured(captured)) => captured,
            Some(FeedItem::Skipped(skipped)) => {
                console.warn(&skipped, &*skipped.error);
                outcome = Outcome::CouldNotRun;
                return Ok(ControlFlow::Continue(()));
            }
        };
        match arm.pose_for(&captured, source.is_live(), console)? {
            // A replayed frame may have its own pose.
            FramePoseResult::Record(None) => {}
            FramePoseResult::Record(pose) => captured.robot_from_flange = pose.map(Box::new),
            FramePoseResult::TooEarly => return Ok(ControlFlow::Continue(())),
            FramePoseResult::End => return Ok(ControlFlow::Break(())),
        }
        for warning in &captured.warnings {
            if shown.contains(warning) {
                continue;
            }
            console.warn(&format_args!("{}: {warning}", captured.name), warning);
            if warning.is_about_source() {
                shown.push(warning.clone());
            }
        }
        let recorder = match &mut recorder {
            Some(recorder) => recorder,
            none => {
                let title = status.title.clone().unwrap_or_else(|| source.title());
                let begun =
                    Recorder::create(out, &title, &source.to_string(), captured.is_simulated);
                none.insert(begun.advised()?)
            }
        };
        console.begin(&captured.name);
        recorder.write(&captured).advised()?;
        console.done();
        Ok(match frames {
            Some(frames) if recorder.num_frames() >= frames => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        })
    })?;
    console.end_progress();
    let Some(recorder) = recorder else {
        return Err(advised_error(
            format!("{} gave no frame", source.title()),
            "Check that the camera sees something, and record again",
        ));
    };
    let simulated = if status.is_simulated == Some(true) {
        ", simulated"
    } else {
        ""
    };
    let num = recorder.num_frames();
    console.line(&format_args!(
        "{num} {}{simulated} in {}",
        if num == 1 { "frame" } else { "frames" },
        out.display()
    ));
    if status.num_dropped > 0 {
        console.note(&format_args!(
            "{} frames were dropped: they arrived faster than they could be written",
            status.num_dropped
        ));
    }
    if let Some(wanted) = frames.filter(|&wanted| num < wanted) {
        console.note(&format_args!("{wanted} frames were requested"));
    }
    Ok(outcome)
}

fn show_list(console: &mut Console) -> Outcome {
    let mut table = Table::new(&["SOURCE", "WHAT"]);
    let found = list();
    for listed in &found {
        if let Some(spec) = &listed.spec {
            table.row([spec.to_string(), listed.title.clone()]);
        }
    }
    // A file needs the library of its camera, but no camera.
    let plays_files = |library: &CameraLibrary| {
        let mut errors = found.iter().filter_map(|listed| listed.error.as_ref());
        !errors.any(|error| error.library == library && error.is_about_library())
    };
    for (is_usable, pattern, what) in [
        (
            true,
            "recording:DIR",
            "A recording, an RGB-D sequence, or a folder of clouds",
        ),
        (
            true,
            "watch:DIR",
            "A folder that another program saves captures into",
        ),
        (
            plays_files(&OPENNI),
            "openni:FILE.oni",
            "A file that OpenNI 2 recorded",
        ),
        (
            plays_files(&REALSENSE),
            "realsense:FILE.db3",
            "A file that librealsense recorded, or FILE.bag",
        ),
    ] {
        if is_usable {
            table.row([pattern.to_owned(), what.to_owned()]);
        }
    }
    console.table(&table);
    for listed in &found {
        if let Some(error) = &listed.error {
            console.advise(&format_args!("{}: {error}", listed.title), &error.advice());
        }
    }
    Outcome::Accepted
}
