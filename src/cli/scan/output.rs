//! Output of a scan: a table of its frames, or one line of JSON.

use serde::Serialize;

use crate::cli::console::{Console, Table};
use geometry::rigid::row_major;
use records::report::SCHEMA;
use stages::scan::{Excluded, FusedCloud, Overlap, Scan, ScannedShot};
use texts::Message;

/// JSON line of `scan --json`; metres and radians.
#[derive(Debug, Serialize)]
pub(super) struct ScanLine<'a> {
    schema: u32,
    out: &'a str,
    frames: Vec<FrameLine<'a>>,
    before: Option<OverlapLine>,
    after: Option<OverlapLine>,
    /// As `before` and `after`, on the part only.
    part_before: Option<OverlapLine>,
    part_after: Option<OverlapLine>,
    num_points: usize,
    num_part_points: usize,
}

#[derive(Debug, Serialize)]
struct FrameLine<'a> {
    frame: &'a str,
    used: bool,
    /// Why the frame was left out, as an identifier and in words.
    excluded: Option<&'static str>,
    reason: Option<String>,
    moved_m: f64,
    moved_rad: f64,
    before: Option<OverlapLine>,
    after: Option<OverlapLine>,
    new_points: usize,
    base_from_camera: [f64; 16],
}

/// Distances along the normals between readings of the same surface in two frames.
#[derive(Debug, Serialize)]
struct OverlapLine {
    rms_m: f64,
    median_m: f64,
    num_pairs: usize,
}

impl OverlapLine {
    fn of(overlap: &Overlap) -> Self {
        Self {
            rms_m: overlap.rms.0,
            median_m: overlap.median.0,
            num_pairs: overlap.num_pairs,
        }
    }
}

impl<'a> ScanLine<'a> {
    pub(super) fn of(scan: &'a Scan, part: &FusedCloud, out: &'a str) -> Self {
        Self {
            schema: SCHEMA,
            out,
            frames: scan.shots.iter().map(FrameLine::of).collect(),
            before: scan.before.all.as_ref().map(OverlapLine::of),
            after: scan.after.all.as_ref().map(OverlapLine::of),
            part_before: scan.before.part.as_ref().map(OverlapLine::of),
            part_after: scan.after.part.as_ref().map(OverlapLine::of),
            num_points: scan.cloud.cloud.points.len(),
            num_part_points: part.cloud.points.len(),
        }
    }
}

impl<'a> FrameLine<'a> {
    fn of(shot: &'a ScannedShot) -> Self {
        Self {
            frame: &shot.name,
            used: shot.excluded.is_none(),
            excluded: shot.excluded.as_ref().map(Excluded::name),
            reason: shot.excluded.as_ref().map(ToString::to_string),
            moved_m: shot.moved.shift.0,
            moved_rad: shot.moved.rotation.0,
            before: shot.before.as_ref().map(OverlapLine::of),
            after: shot.after.as_ref().map(OverlapLine::of),
            new_points: shot.num_new,
            base_from_camera: row_major(&shot.base_from_camera),
        }
    }
}

/// Shows the frames, their agreement and the resulting cloud.
pub(super) fn show(scan: &Scan, part: &FusedCloud, console: &mut Console) {
    let mut table = Table::new(&[
        "FRAME",
        "MOVED mm",
        "deg",
        "RMS BEFORE mm",
        "AFTER",
        "NEW POINTS",
        "",
    ]);
    for shot in &scan.shots {
        let rms = |overlap: &Option<Overlap>| {
            overlap.map_or_else(|| "-".to_owned(), |o| format!("{:.2}", o.rms.mm()))
        };
        let remark = match &shot.excluded {
            Some(_) => "LEFT OUT".to_owned(),
            None if !shot.finds_part => Message::new("no-part-in-frame").to_string(),
            None => String::new(),
        };
        table.row([
            shot.name.clone(),
            format!("{:.1}", shot.moved.shift.mm()),
            format!("{:.2}", shot.moved.rotation.degrees()),
            rms(&shot.before),
            rms(&shot.after),
            shot.num_new.to_string(),
            remark,
        ]);
    }
    console.table(&table);
    for (what, before, after) in [
        ("all surfaces", scan.before.all, scan.after.all),
        ("the part", scan.before.part, scan.after.part),
    ] {
        if let Some((before, after)) = before.zip(after) {
            console.line(&format_args!(
                "Where several frames see {what}, they agree to {:.2} mm rms, median {:.2} mm (at the robot's poses \
                 {:.2} mm, {:.2} mm)",
                after.rms.mm(),
                after.median.mm(),
                before.rms.mm(),
                before.median.mm()
            ));
        }
    }
    let num_part = part.cloud.points.len();
    let by = |least: u32| {
        let seen = part
            .seen_by
            .iter()
            .filter(|mask| mask.count_ones() >= least);
        100.0 * seen.count() as f64 / num_part.max(1) as f64
    };
    console.line(&format_args!(
        "{} points; the part has {num_part}, {:.0} % of them seen by two frames or more",
        scan.cloud.cloud.points.len(),
        by(2)
    ));
}
