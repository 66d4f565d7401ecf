//! Following a source from a command until it ends, enough frames came, the output cannot be written, or Ctrl-C.

use std::{ops::ControlFlow, time::Duration};

use super::{
    console::{Advised as _, Console, advised_error, with_advice},
    interrupt::Interrupt,
};
use capture::{BackpressurePolicy, Feed, FeedItem, FeedState, FeedStatus, Pace, SourceSpec};
use geometry::error::Advice as _;

/// Interval between checks for Ctrl-C while nothing comes.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// Parses a source for clap.
pub(super) fn parse_source(text: &str) -> Result<SourceSpec, String> {
    let spec = text.parse::<SourceSpec>();
    // Unless it names a pace, a recording delivers each frame as soon as the last one is taken, so that a replay is
    // exact.
    spec.map(|spec| spec.paced(Pace::Step))
        .map_err(|error| with_advice(&error))
}

/// Starts a source.
pub(super) fn start_source(spec: &SourceSpec) -> anyhow::Result<Feed> {
    Feed::start(spec.clone(), BackpressurePolicy::for_source(spec), || ()).advised()
}

/// Starts a source, and passes what it gives to `each`, as [`follow_started`].
pub(super) fn follow(
    spec: &SourceSpec,
    console: &mut Console,
    each: impl FnMut(Option<FeedItem>, &FeedStatus, &mut Console) -> anyhow::Result<ControlFlow<()>>,
) -> anyhow::Result<FeedStatus> {
    follow_started(spec, &start_source(spec)?, console, each)
}

/// Passes what a source gives to `each` until that breaks, the source ends, the output cannot be written, or Ctrl-C.
/// While nothing comes, `each` gets `None` about ten times a second. It always gets the status of the feed too, whose last
/// value is returned.
pub(super) fn follow_started(
    spec: &SourceSpec,
    feed: &Feed,
    console: &mut Console,
    mut each: impl FnMut(Option<FeedItem>, &FeedStatus, &mut Console) -> anyhow::Result<ControlFlow<()>>,
) -> anyhow::Result<FeedStatus> {
    let interrupt = Interrupt::listen()?;
    let mut lost: Option<String> = None;
    while console.is_writable() && !interrupt.came() {
        // Read before waiting, so that items queued before the end are still taken.
        let status = feed.status();
        if let Some(item) = feed.wait(POLL_INTERVAL) {
            if lost.take().is_some() {
                console.note(&format_args!("{} is back", spec.title()));
            }
            if each(Some(item), &feed.status(), console)?.is_break() {
                break;
            }
            continue;
        }
        if each(None, &status, console)?.is_break() {
            break;
        }
        match status.state {
            FeedState::Failed(error) => {
                return Err(advised_error(error.to_string(), error.advice()));
            }
            FeedState::Lost { error, .. } => {
                // Report each cause once, not each retry.
                let words = error.to_string();
                if lost.as_ref() != Some(&words) {
                    console.warn(&format_args!("{words}; retrying until Ctrl-C"), &*error);
                    lost = Some(words);
                }
            }
            state if state.is_over() => break,
            _ => {}
        }
    }
    Ok(feed.status())
}

/// Help text on sources.
pub(super) const SOURCES: &str = "\
Sources:
  simulated                 the simulated cell, where the eight parts come one after the other
  simulated:fender          one part hanging still; also hood, wheel, box, ... and empty
  simulated:rack            racks of three parts come one after the other
                            options: side=right model=3 pose=facing|placed|hard|\"rx ry rz x y z\" noise=2
                            clutter=none|on-floor|in-front seed=7 fps=30; for line and rack, every=8 (seconds); for conveyor, speed=100 (mm/s)
  simulated-robot:IP:PORT   the camera of a simulated robot (partsight simulate --robot)
  recording:DIR             a recording; an RGB-D sequence with its depth.txt; a folder of clouds or depth images
                            options: pace=step|as-taken|10 (frames a second) camera=intrinsics.json
  watch:DIR                 new files in a folder, each once it is complete; option: from=all to include earlier ones
  kinect   kinect:SERIAL    a Kinect
  genicam  genicam:ID       a 3-D camera of GigE Vision or USB3 Vision; ID as --list shows it, or its IP address
                            options: camera=intrinsics.json (if the camera does not report its own)
                            format=Coord3D_C16|Coord3D_ABC32f|Mono16
  openni   openni:URI       an Asus Xtion, PrimeSense or Orbbec Astra, through OpenNI 2
  openni:FILE.oni           a file that OpenNI 2 recorded; option: pace, as above
  realsense                 a RealSense camera; realsense:SERIAL is one of several; option: preset=High Accuracy
  realsense:FILE.db3        a file that librealsense recorded, or FILE.bag; option: pace, as above
Options go before the colon: simulated,side=right,noise=2:fender

Examples:
  partsight capture --list
  partsight capture --source simulated --frames 300 --out tried
  partsight capture --source kinect --out monday
  partsight inspect --source recording:monday
  partsight inspect --source watch:/mnt/scanner --json >> verdicts.jsonl

A recording is complete after every frame: Ctrl-C ends it, and one that was cut off opens up to its last complete frame.";
