//! `partsight bench bounds` and `bench sheets`: measure whether pose errors stay within their bounds.

use std::{borrow::Borrow, path::Path};

use serde::Serialize;

use super::{BenchArgs, NUM_POSES, write_results};
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, Table, advised_error},
};
use bench::{
    bounds::{
        BoundsCase, BoundsLibrary, PoseAgainstTruth, SheetForm, THICKNESSES, View, bounds_cases,
    },
    suites::MEASURING_SEED,
};
use files::{FileContent, open};
use geometry::{mesh::TriangleMesh, statistics::quantile};

#[derive(Debug, Serialize)]
struct CaseLine {
    enrolled: String,
    part: String,
    view: View,
    seed: u64,
    named: bool,
    accepted: bool,
    turn_error_deg: Option<f64>,
    shift_error_mm: Option<f64>,
    /// Null if the pose is unconstrained.
    turn_bound_deg: Option<f64>,
    shift_bound_mm: Option<f64>,
    doubt: Option<String>,
}

pub(super) fn run(args: &BenchArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let first_seed = args.seed.unwrap_or(MEASURING_SEED);
    let num_poses = args.poses.unwrap_or(NUM_POSES);
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
    console.start_progress(num_subjects * View::ALL.len() * num_poses as usize);
    let mut done = Vec::new();
    for library in &libraries {
        let cases = bounds_cases(library, num_poses, first_seed, || console.done());
        done.push((library, cases));
    }
    console.end_progress();
    console.line(&format_args!(
        "Simulated: {num_subjects} parts, {num_poses} poses of each view, ±30°, any roll, 1 to 2 m; cut: 20 to 50 % beyond the picture. Errors at the middle of what was seen, of poses within 5° and 40 mm."
    ));
    for (library, cases) in &done {
        show(library, cases, console);
    }
    write_lines(args, &done)?;
    Ok(Outcome::Accepted)
}

fn write_lines<L: Borrow<BoundsLibrary>>(
    args: &BenchArgs,
    done: &[(L, Vec<BoundsCase>)],
) -> anyhow::Result<()> {
    let Some(path) = &args.json else {
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

/// Runs `partsight bench sheets`: panels of every thickness, enrolled in every form that they may be stored in.
pub(super) fn run_sheets(args: &BenchArgs, console: &mut Console) -> anyhow::Result<Outcome> {
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
        let cases = bounds_cases(&library, num_poses, first_seed, || {});
        done.push((library, cases));
        console.done();
    }
    console.end_progress();
    console.line(&format_args!(
        "Simulated: three panels, hung with either side to the camera, {num_poses} poses of each view, ±30°, any roll, 1 to 2 m; cut: 20 to 50 % beyond the picture."
    ));
    let mut table = table();
    for view in View::ALL {
        for (library, cases) in &done {
            let cases: Vec<&BoundsCase> = cases.iter().filter(|case| case.view == view).collect();
            table.row(row(&library.title, view, &cases));
        }
    }
    console.table(&table);
    write_lines(args, &done)?;
    Ok(Outcome::Accepted)
}

fn table() -> Table {
    Table::new(&[
        "part",
        "view",
        "named",
        "accepted",
        "another pose",
        "unconstrained",
        "turn within bound",
        "shift within bound",
        "turn: median, 95 %",
        "its bound",
        "shift: median, 95 %",
        "its bound",
    ])
}

fn show(library: &BoundsLibrary, cases: &[BoundsCase], console: &mut Console) {
    console.line(&"");
    console.line(&format_args!("enrolled: {}", library.title));
    let mut table = table();
    for view in View::ALL {
        let of_view = |case: &&BoundsCase| case.view == view;
        for subject in &library.subjects {
            let cases: Vec<&BoundsCase> = cases
                .iter()
                .filter(of_view)
                .filter(|case| case.part == subject.name)
                .collect();
            table.row(row(&subject.name, view, &cases));
        }
        let cases: Vec<&BoundsCase> = cases.iter().filter(of_view).collect();
        table.row(row("all", view, &cases));
    }
    console.table(&table);
}

fn row(name: &str, view: View, cases: &[&BoundsCase]) -> [String; 12] {
    let num = cases.len();
    let accepted: Vec<PoseAgainstTruth> = cases
        .iter()
        .filter(|case| case.is_accepted)
        .filter_map(|case| case.found)
        .collect();
    let near: Vec<PoseAgainstTruth> = accepted
        .iter()
        .copied()
        .filter(PoseAgainstTruth::is_near)
        .collect();
    let held: Vec<_> = near
        .iter()
        .filter_map(|found| Some((found.error, found.held()?)))
        .collect();
    let num_turns = held
        .iter()
        .filter(|(e, b)| e.rotation.0 <= b.turn.0)
        .count();
    let num_shifts = held.iter().filter(|(e, b)| e.shift.0 <= b.shift.0).count();
    let degrees = |values: Vec<f64>, share| {
        quantile(values.into_iter(), share).map_or_else(String::new, |x| format!("{x:.2}°"))
    };
    let millimetres = |values: Vec<f64>, share| {
        quantile(values.into_iter(), share).map_or_else(String::new, |x| format!("{x:.1}"))
    };
    let turns = || {
        near.iter()
            .map(|found| found.error.rotation.degrees())
            .collect()
    };
    let shifts = || near.iter().map(|found| found.error.shift.mm()).collect();
    [
        name.to_owned(),
        view.name().to_owned(),
        format!(
            "{}/{num}",
            cases.iter().filter(|case| case.is_named).count()
        ),
        accepted.len().to_string(),
        (accepted.len() - near.len()).to_string(),
        (near.len() - held.len()).to_string(),
        format!("{num_turns}/{}", held.len()),
        format!("{num_shifts}/{}", held.len()),
        format!("{}, {}", degrees(turns(), 0.5), degrees(turns(), 0.95)),
        degrees(held.iter().map(|(_, b)| b.turn.degrees()).collect(), 0.5),
        format!(
            "{}, {} mm",
            millimetres(shifts(), 0.5),
            millimetres(shifts(), 0.95)
        ),
        millimetres(held.iter().map(|(_, b)| b.shift.mm()).collect(), 0.5),
    ]
}

fn line(library: &BoundsLibrary, case: &BoundsCase) -> CaseLine {
    let found = case.found.as_ref();
    let held = found.and_then(PoseAgainstTruth::held);
    CaseLine {
        enrolled: library.title.clone(),
        part: case.part.clone(),
        view: case.view,
        seed: case.seed,
        named: case.is_named,
        accepted: case.is_accepted,
        turn_error_deg: found.map(|found| found.error.rotation.degrees()),
        shift_error_mm: found.map(|found| found.error.shift.mm()),
        turn_bound_deg: held.map(|bounds| bounds.turn.degrees()),
        shift_bound_mm: held.map(|bounds| bounds.shift.mm()),
        doubt: found
            .and_then(|found| found.doubt)
            .map(|doubt| doubt.to_string()),
    }
}
