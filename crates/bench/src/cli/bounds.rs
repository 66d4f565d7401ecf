//! `partsight-bench bounds` and `partsight-bench sheets`: measure whether pose errors stay within their bounds.

use std::{
    borrow::Borrow,
    path::{Path, PathBuf},
};

use clap::Args;
use serde::Serialize;

use super::{FrameChoice, JsonFile, NUM_POSES, write_results};
use crate::{
    bounds::{
        BoundsCase, BoundsLibrary, Condition, PoseAgainstTruth, SheetForm, THICKNESSES, View,
        bounds_cases,
    },
    suites::MEASURING_SEED,
};
use files::{FileContent, open};
use geometry::{mesh::TriangleMesh, statistics::quantile};
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table, advised_error},
};

#[derive(Debug, Serialize)]
struct CaseLine {
    enrolled: String,
    part: String,
    noise: Condition,
    view: View,
    seed: u64,
    named: bool,
    accepted: bool,
    refused: Option<String>,
    turn_error_deg: Option<f64>,
    shift_error_mm: Option<f64>,
    /// Null if the pose is unconstrained.
    turn_bound_deg: Option<f64>,
    shift_bound_mm: Option<f64>,
    doubt: Option<String>,
}

#[derive(Debug, Args)]
pub(super) struct BoundsArgs {
    #[command(flatten)]
    frames: FrameChoice,
    /// Take this mesh instead of the simulated parts, with its outside towards the camera; may be given several times
    #[arg(long, value_name = "FILE#NAME")]
    mesh: Vec<PathBuf>,
}

pub(super) fn run(args: &BoundsArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let first_seed = args.frames.seed.unwrap_or(MEASURING_SEED);
    let num_poses = args.frames.poses.unwrap_or(NUM_POSES);
    let libraries = if args.mesh.is_empty() {
        // A different car model for each first seed, and never the standard one.
        let model_seed = first_seed / 10_000;
        vec![
            BoundsLibrary::captured(model_seed).advised()?,
            BoundsLibrary::simulated_meshes(model_seed).advised()?,
        ]
    } else {
        let meshes = args.mesh.iter().map(|path| opened(path));
        let meshes = meshes.collect::<anyhow::Result<Vec<_>>>()?;
        vec![BoundsLibrary::of_meshes(meshes).advised()?]
    };
    let num_subjects: usize = libraries.iter().map(|library| library.subjects.len()).sum();
    let num_views: usize = Condition::ALL
        .map(|condition| condition.views().len())
        .iter()
        .sum();
    console.start_progress(num_subjects * num_views * num_poses as usize);
    let mut done = Vec::new();
    for library in &libraries {
        let cases = Condition::ALL.map(|condition| {
            let views = condition.views();
            bounds_cases(library, condition, views, num_poses, first_seed, || {
                console.done();
            })
        });
        done.push((library, cases.concat()));
    }
    console.end_progress();
    console.line(&format_args!(
        "Simulated: {num_subjects} parts, {num_poses} poses of each view, ±30°, any roll, 1 to 2 m; cut: 20 to 50 % beyond the picture; hidden: behind a plank; booth: as its suite. Errors at the middle of what was seen, of accepted poses within 5° and 40 mm; right poses are within 2° and 10 mm."
    ));
    for (library, cases) in &done {
        console.line(&"");
        console.line(&format_args!("enrolled: {}", library.title));
        let mut table = table("noise");
        for condition in Condition::ALL {
            for view in condition.views() {
                let is_in = |case: &&BoundsCase| case.condition == condition && case.view == *view;
                let cases: Vec<&BoundsCase> = cases.iter().filter(is_in).collect();
                table.row(row(condition.name(), *view, &cases));
            }
        }
        console.table(&table);
    }
    write_lines(&args.frames.file, &done)?;
    Ok(Outcome::Accepted)
}

fn write_lines<L: Borrow<BoundsLibrary>>(
    file: &JsonFile,
    done: &[(L, Vec<BoundsCase>)],
) -> anyhow::Result<()> {
    let Some(path) = &file.json else {
        return Ok(());
    };
    let of_library = |(library, cases): &(L, Vec<BoundsCase>)| -> Vec<CaseLine> {
        cases
            .iter()
            .map(|case| line(library.borrow(), case))
            .collect()
    };
    let lines: Vec<CaseLine> = done.iter().flat_map(of_library).collect();
    write_results(path, "cases", &lines)
}

/// Opens a mesh, named by the text after `#` or by its file.
pub(super) fn opened(path: &Path) -> anyhow::Result<(String, TriangleMesh)> {
    let FileContent::Mesh(mesh) = open(path).advised()? else {
        return Err(advised_error(
            format!("{} is no mesh", path.display()),
            "Name an STL, OBJ, PLY or glTF file with faces",
        ));
    };
    let text = path.display().to_string();
    let name = match text.rsplit_once('#') {
        Some((_, name)) => name.to_owned(),
        None => path
            .file_stem()
            .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned()),
    };
    Ok((name, mesh))
}

/// Poses of each panel, side and view.
const NUM_SHEET_POSES: u64 = 3;
const SHEET_VIEWS: [View; 2] = [View::Whole, View::Cut];

/// Runs `partsight-bench sheets`: panels of every thickness, enrolled in every form that they may be stored in.
pub(super) fn run_sheets(args: &FrameChoice, console: &mut Console) -> anyhow::Result<Outcome> {
    let first_seed = args.seed.unwrap_or(MEASURING_SEED);
    let num_poses = args.poses.unwrap_or(NUM_SHEET_POSES);
    let pairs = THICKNESSES.iter().flat_map(|thickness| {
        let forms = SheetForm::ALL.into_iter();
        let forms = forms.filter(|form| form.is_possible(*thickness));
        forms.map(|form| (*thickness, form))
    });
    console.start_progress(pairs.clone().count());
    let mut done = Vec::new();
    for (thickness, form) in pairs {
        let library = BoundsLibrary::sheets(thickness, form).advised()?;
        let cases = bounds_cases(
            &library,
            Condition::Kinect,
            &SHEET_VIEWS,
            num_poses,
            first_seed,
            || {},
        );
        done.push((library, cases));
        console.done();
    }
    console.end_progress();
    console.line(&format_args!(
        "Simulated: three panels, hung with either side to the camera, {num_poses} poses of each view, ±30°, any roll, 1 to 2 m; cut: 20 to 50 % beyond the picture."
    ));
    let mut table = table("part");
    for view in SHEET_VIEWS {
        for (library, cases) in &done {
            let cases: Vec<&BoundsCase> = cases.iter().filter(|case| case.view == view).collect();
            table.row(row(&library.title, view, &cases));
        }
    }
    console.table(&table);
    write_lines(&args.file, &done)?;
    Ok(Outcome::Accepted)
}
fn table(first: &str) -> Table {
    Table::new(&[
        first,
        "view",
        "named",
        "accepted",
        "of right poses",
        "another pose",
        "turn within bound",
        "shift within bound",
        "turn/bound at 95 %",
        "shift/bound at 95 %",
        "turn: median, 95 %",
        "its bound",
        "shift: median, 95 %",
        "its bound",
    ])
}

fn row(name: &str, view: View, cases: &[&BoundsCase]) -> [String; 14] {
    let num = cases.len();
    let num_named = cases.iter().filter(|case| case.is_named).count();
    let found = |case: &&&BoundsCase| case.found.is_some_and(|found| found.is_right());
    let right: Vec<&&BoundsCase> = cases.iter().filter(found).collect();
    let num_right_accepted = right.iter().filter(|case| case.is_accepted).count();
    let accepted: Vec<PoseAgainstTruth> = cases
        .iter()
        .filter(|case| case.is_accepted)
        .filter_map(|case| case.found)
        .collect();
    let near = accepted.iter().filter(|found| found.is_near());
    let held: Vec<_> = near
        .clone()
        .filter_map(|found| Some((found.error, found.held()?)))
        .collect();
    // Errors and bounds, of turns in degrees and of shifts in millimetres.
    let turns: Vec<_> = held
        .iter()
        .map(|(e, b)| (e.rotation.degrees(), b.turn.degrees()))
        .collect();
    let shifts: Vec<_> = held
        .iter()
        .map(|(e, b)| (e.shift.mm(), b.shift.mm()))
        .collect();
    let within = |of: &[(f64, f64)]| {
        let num = of.iter().filter(|(error, bound)| error <= bound).count();
        format!("{num}/{}", of.len())
    };
    let at = |share: f64, values: Vec<f64>, decimals: usize| {
        quantile(values.into_iter(), share).map_or_else(String::new, |x| format!("{x:.decimals$}"))
    };
    let ratio = |of: &[(f64, f64)]| at(0.95, of.iter().map(|(e, b)| e / b).collect(), 2);
    let errors = |of: &[(f64, f64)], decimals| {
        [0.5, 0.95]
            .map(|share| at(share, of.iter().map(|(e, _)| *e).collect(), decimals))
            .join(", ")
    };
    let bound =
        |of: &[(f64, f64)], decimals| at(0.5, of.iter().map(|(_, b)| *b).collect(), decimals);
    [
        name.to_owned(),
        view.name().to_owned(),
        format!("{num_named}/{num}"),
        accepted.len().to_string(),
        format!("{num_right_accepted}/{}", right.len()),
        (accepted.len() - near.count()).to_string(),
        within(&turns),
        within(&shifts),
        ratio(&turns),
        ratio(&shifts),
        errors(&turns, 2) + "°",
        bound(&turns, 2) + "°",
        errors(&shifts, 1) + " mm",
        bound(&shifts, 1) + " mm",
    ]
}

fn line(library: &BoundsLibrary, case: &BoundsCase) -> CaseLine {
    let found = case.found.as_ref();
    let held = found.and_then(PoseAgainstTruth::held);
    CaseLine {
        enrolled: library.title.clone(),
        part: case.part.clone(),
        noise: case.condition,
        view: case.view,
        seed: case.seed,
        named: case.is_named,
        accepted: case.is_accepted,
        refused: case.refused.clone(),
        turn_error_deg: found.map(|found| found.error.rotation.degrees()),
        shift_error_mm: found.map(|found| found.error.shift.mm()),
        turn_bound_deg: held.map(|bounds| bounds.turn.degrees()),
        shift_bound_mm: held.map(|bounds| bounds.shift.mm()),
        doubt: found
            .and_then(|found| found.doubt)
            .map(|doubt| doubt.to_string()),
    }
}
