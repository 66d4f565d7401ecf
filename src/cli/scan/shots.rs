//! Reading the frames and poses of a scan, and fusing them.

use std::{ops::ControlFlow, path::PathBuf};

use super::{PosesChoice, warn_of_excluded};
use crate::{
    cli::{
        calibrate::scan_calibration,
        console::{Advised as _, Console},
    },
    robot::scan_frames::{FrameNews, read_frames, with_poses},
    scan::{Scan, ScanParams, Unwatched, assemble},
    stages::segment::SegmentParams,
};

/// Reads frames with their poses and fuses them, each segmented with these parameters; warns of frames left out.
pub(in crate::cli) fn open_scan(
    paths: &[PathBuf],
    given: &PosesChoice,
    segment: &SegmentParams,
    console: &mut Console,
) -> anyhow::Result<Scan> {
    let frames = read_frames(paths, &mut |news| {
        match news {
            FrameNews::Total(num) => console.start_progress(num),
            FrameNews::Read(name, warnings) => {
                console.begin(&name);
                for warning in warnings {
                    console.warn(&format_args!("{name}: {warning}"), warning);
                }
                console.done();
            }
            FrameNews::Skipped(skipped) => console.warn(
                &format_args!("{} is left out: {}", skipped.name, skipped.error),
                &*skipped.error,
            ),
        }
        ControlFlow::Continue(())
    })
    .advised()?;
    let calibration = scan_calibration(given.calibration.as_deref(), console)?;
    let shots = with_poses(paths, given.poses.as_deref(), frames, calibration);
    let params = ScanParams {
        segment: segment.clone(),
        ..ScanParams::default()
    };
    let scan = assemble(&shots.advised()?, &params, &Unwatched).advised()?;
    console.end_progress();
    warn_of_excluded(&scan, console);
    Ok(scan)
}
