//! `partsight cell`: checks that camera and cell have not moved.

use std::{ops::ControlFlow, path::PathBuf};

use clap::{Args, Subcommand};
use jiff::tz::TimeZone;
use serde::Serialize;

use super::{
    Outcome,
    console::{Advised as _, Console, Table, advised_error, marked_simulated},
    follow::{follow, parse_source},
    input::{from_to, open_scene, warn_of, within},
    recipe::RecipeSource,
};
use capture::{FeedItem, SourceSpec};
use files::write_atomically;
use geometry::{
    error::Advice as _,
    units::{Metres, Radians},
};
use records::report::SCHEMA;
use robot::cell_check::{
    CellBaseline, CellCheck, CellCheckFolder, CellFinding, CellLimits, CellViews, MAX_FRAMES,
    USUAL_FRAMES, write_csv,
};
use stages::scene::{SceneCloud, scene_from_image};

/// Check that camera and cell have not moved, with one part hung in the same place every day
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight cell baseline --source kinect       # once, when the cell is calibrated
  partsight cell check --source kinect          # every morning, with the same part in the same place
  partsight cell check morning.pcd --json
  partsight cell list --csv drift.csv

Any rigid thing with edges in all directions serves as the part; it need not be enrolled. Wall and floor tell whether the \
camera moved or the part hangs elsewhere: leave some of them in the picture.
Exit codes of check: 0 in place, 1 something moved or the readings are noisier, 2 the comparison was not possible.")]
pub(super) struct CellArgs {
    /// Folder of the baseline and the checks; default: cell-check in your data folder
    #[arg(long, value_name = "DIR", global = true)]
    folder: Option<PathBuf>,
    #[command(subcommand)]
    command: CellCommand,
}

#[derive(Debug, Subcommand)]
enum CellCommand {
    /// Take the baseline: what the camera sees of the part while the cell is right
    Baseline(BaselineArgs),
    /// Compare what the camera sees now with the baseline
    Check(CheckArgs),
    /// Show all checks, the oldest first: the drift of the cell
    List(ListArgs),
}

/// Frames of the part, from files or from a camera.
#[derive(Debug, Args)]
struct Views {
    /// Captured scenes of the part as it hangs; several lower the noise
    #[arg(value_name = "FILE", required_unless_present = "source")]
    files: Vec<PathBuf>,
    /// Take the frames from a camera or another source (partsight capture --help)
    #[arg(long, value_name = "SOURCE", value_parser = parse_source, conflicts_with = "files")]
    source: Option<SourceSpec>,
    /// Frames to take from the source
    #[arg(long, value_name = "N", default_value_t = USUAL_FRAMES as u8, value_parser = clap::value_parser!(u8).range(1..=MAX_FRAMES as i64))]
    frames: u8,
    #[command(flatten)]
    recipe: RecipeSource,
}

#[derive(Debug, Args)]
struct BaselineArgs {
    #[command(flatten)]
    views: Views,
    #[arg(
        long,
        value_name = "MM",
        default_value_t = CellLimits::default().shift.mm(),
        value_parser = |text: &str| within(text, &CellLimits::SHIFT_MM),
        help = format!(
            "How far the part's middle, the wall and the floor may move, in millimetres ({})",
            from_to(&CellLimits::SHIFT_MM)
        )
    )]
    max_shift: f64,
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = CellLimits::default().turn.degrees(),
        value_parser = |text: &str| within(text, &CellLimits::TURN_DEGREES),
        help = format!(
            "How far the part may turn, in degrees ({})",
            from_to(&CellLimits::TURN_DEGREES)
        )
    )]
    max_turn: f64,
}

#[derive(Debug, Args)]
struct CheckArgs {
    #[command(flatten)]
    views: Views,
    /// Do not add the check to the list
    #[arg(long)]
    no_list: bool,
    /// Write one line of JSON, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct ListArgs {
    /// Write the checks to this table instead
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write a line of JSON for each, and nothing else, to standard output
    #[arg(long, conflicts_with = "csv")]
    json: bool,
}

pub(super) fn run(args: &CellArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let folder = match &args.folder {
        Some(folder) => CellCheckFolder::at(folder),
        None => CellCheckFolder::of_user().advised()?,
    };
    match &args.command {
        CellCommand::Baseline(args) => baseline(args, &folder, console),
        CellCommand::Check(args) => check(args, &folder, console),
        CellCommand::List(args) => list(args, &folder, console),
    }
}

fn baseline(
    args: &BaselineArgs,
    folder: &CellCheckFolder,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let CellViews {
        views,
        is_simulated,
        ..
    } = views(&args.views, console)?;
    let limits = CellLimits {
        shift: Metres::from_mm(args.max_shift),
        turn: Radians::from_degrees(args.max_turn),
    };
    let baseline =
        CellBaseline::new(&views, limits, is_simulated, geometry::clock::now()).advised()?;
    folder.save(&baseline).advised()?;
    let simulated = if is_simulated { "simulated " } else { "" };
    let frames = if views.len() == 1 { "frame" } else { "frames" };
    console.line(&format_args!(
        "Baseline of {} {simulated}{frames} written to {}",
        views.len(),
        folder.path().display()
    ));
    console.entry(
        "limits",
        &format_args!("{} and {}", limits.shift, limits.turn),
    );
    if baseline.num_planes() == 0 {
        console.note(
            &"note: neither wall nor floor is in the picture: a check cannot tell whether the camera moved or the part",
        );
    }
    Ok(Outcome::Accepted)
}

fn check(
    args: &CheckArgs,
    folder: &CellCheckFolder,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let baseline = folder.baseline().advised()?;
    let taken = views(&args.views, console)?;
    let check = baseline
        .check(&taken.views, taken.is_simulated, geometry::clock::now())
        .advised()?;
    if args.json {
        console.line(&json_line(&check)?);
    } else {
        show(&check, &baseline, console);
    }
    // Writing to the list comes last, since it may fail.
    if !args.no_list {
        folder.add(&check).advised()?;
    }
    Ok(Outcome::accepted_if(check.finding == CellFinding::InPlace))
}

fn json_line(check: &CellCheck) -> serde_json::Result<String> {
    #[derive(Serialize)]
    struct Line<'a> {
        schema: u32,
        #[serde(flatten)]
        check: &'a CellCheck,
    }
    let schema = SCHEMA;
    serde_json::to_string(&Line { schema, check })
}

fn show(check: &CellCheck, baseline: &CellBaseline, console: &mut Console) {
    let [x, y, z] = check.shift_m.map(|shift| shift * 1000.0);
    let limits = baseline.limits;
    console.entry(
        "cell",
        &marked_simulated(&check.finding.to_string(), check.is_simulated),
    );
    console.entry(
        "part",
        &format_args!(
            "x {x:+.1}  y {y:+.1}  z {z:+.1} mm in the camera's frame, {} in all, turned by {}; allowed {} and {}",
            check.shift(),
            check.turn(),
            limits.shift,
            limits.turn
        ),
    );
    let background = check.background_shift_m.map_or_else(
        || "neither wall nor floor was found again".to_owned(),
        |shift| {
            format!(
                "wall and floor moved by up to {} where they are seen",
                Metres(shift)
            )
        },
    );
    console.entry("wall", &background);
    console.entry(
        "readings",
        &format_args!(
            "{:.1} mm rms against the baseline, {:.1} times its noise",
            check.rms_m * 1000.0,
            check.noise_ratio
        ),
    );
    let since = baseline.made_at.to_zoned(TimeZone::system());
    console.entry("baseline", &since.strftime("%Y-%m-%d %H:%M"));
    if check.finding != CellFinding::InPlace {
        console.entry("to do", &check.finding.advice());
    }
}

fn list(
    args: &ListArgs,
    folder: &CellCheckFolder,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let checks = folder.checks().advised()?;
    if args.json {
        for check in &checks {
            console.line(&json_line(check)?);
        }
        return Ok(Outcome::Accepted);
    }
    if let Some(path) = &args.csv {
        write_atomically(path, |writer| write_csv(writer, &checks)).advised()?;
        console.line(&format_args!(
            "{} checks written to {}",
            checks.len(),
            path.display()
        ));
        return Ok(Outcome::Accepted);
    }
    if checks.is_empty() {
        console.line(&"No check yet: partsight cell check FILE, or --source kinect");
        return Ok(Outcome::Accepted);
    }
    let mut table = Table::new(&[
        "TIME", "CELL", "SHIFT", "X", "Y", "Z", "TURN", "RMS", "NOISE",
    ]);
    for check in &checks {
        let [x, y, z] = check.shift_m.map(|shift| format!("{:+.1}", shift * 1000.0));
        let at = check.at.to_zoned(TimeZone::system());
        table.row([
            at.strftime("%Y-%m-%d %H:%M").to_string(),
            marked_simulated(&check.finding.to_string(), check.is_simulated),
            check.shift().to_string(),
            x,
            y,
            z,
            check.turn().to_string(),
            Metres(check.rms_m).to_string(),
            format!("{:.1}", check.noise_ratio),
        ]);
    }
    console.table(&table);
    Ok(Outcome::Accepted)
}

/// Reads what the frames show.
fn views(args: &Views, console: &mut Console) -> anyhow::Result<CellViews> {
    let mut taken = CellViews::new(&args.recipe.recipe()?.segment);
    let mut look = |scene: &SceneCloud, name: &str| {
        let added = taken.add(scene);
        added.map_err(|none| advised_error(format!("{name}: {none}"), none.advice()))?;
        anyhow::Ok(taken.views.len())
    };
    if let Some(source) = &args.source {
        let wanted = usize::from(args.frames);
        let mut num = 0;
        console.start_progress(wanted);
        follow(source, console, |item, _, console| {
            let captured = match item {
                None => return Ok(ControlFlow::Continue(())),
                Some(FeedItem::Captured(captured)) => captured,
                Some(FeedItem::Skipped(skipped)) => {
                    console.warn(&skipped, &*skipped.error);
                    return Ok(ControlFlow::Continue(()));
                }
            };
            console.begin(&captured.name);
            num = look(&scene_from_image(captured.image), &captured.name)?;
            console.done();
            Ok(if num < wanted {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            })
        })?;
        console.end_progress();
        if num < wanted {
            return Err(advised_error(
                format!("{} gave {num} of {wanted} frames", source.title()),
                "Check that the camera keeps taking pictures, or request fewer with --frames",
            ));
        }
    }
    if args.files.len() > MAX_FRAMES {
        return Err(advised_error(
            format!("{} frames are too many", args.files.len()),
            format!("Give up to {MAX_FRAMES}"),
        ));
    }
    for path in &args.files {
        let (scene, warnings) = open_scene(path).advised()?;
        warn_of(path, &warnings, console);
        look(&scene, &path.display().to_string())?;
    }
    Ok(taken)
}
