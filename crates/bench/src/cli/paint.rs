//! `partsight-bench paint`: spray paths and films of the library's parts, and of parts enrolled from frames.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::{JsonFile, write_json};
use crate::paint::{PaintedPart, paint_part, seen_from_side};
use files::disk;
use inspection::library::{EnrolParams, PartDescription, PartName, Side, enrol_captured};
use partsight::cli::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table},
    input::open_scene,
};
use records::report::{FilmPicture, film_picture, write_png};
use robot::paint::{Coat, CoatFolder, PaintSurface};
use stages::reference::{Coverage, Reference, ReferenceParams};

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct PaintFile {
    schema: u32,
    coat: Coat,
    parts: Vec<PaintedPart>,
}

#[derive(Debug, Args)]
pub(super) struct PaintArgs {
    #[command(flatten)]
    file: JsonFile,
    /// Enrol a part from each of these scenes and paint it too
    #[arg(long, value_name = "FILE", num_args = 1..)]
    files: Vec<PathBuf>,
    /// The coat, by name or file, instead of the default one
    #[arg(long, value_name = "NAME|FILE")]
    coat: Option<String>,
    /// Draw the film of each part into this folder
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    #[command(flatten)]
    library: LibraryChoice,
}

pub(super) fn run(args: &PaintArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let coat = match &args.coat {
        Some(name) => {
            let folder = CoatFolder::of_user().advised()?;
            folder.open(name).advised()?.recipe
        }
        None => Coat::default(),
    };
    let load = (args.library).load_some(&ReferenceParams::default(), console)?;
    let sides = load.parts.iter().map(|part| (part.coverage, part.side));
    let mut subjects: Vec<(Reference, (Coverage, Option<Side>))> =
        load.library.references.iter().cloned().zip(sides).collect();
    for file in &args.files {
        subjects.push((enrolled(file)?, (Coverage::OneSide, None)));
    }
    console.start_progress(subjects.len());
    let mut parts = Vec::new();
    for (reference, (coverage, side)) in &subjects {
        let surface = PaintSurface::of(reference, *coverage, *side).advised()?;
        parts.push(paint_part(reference, surface, &coat).advised()?);
        console.done();
    }
    console.end_progress();
    show(&parts, &coat, console);
    if let Some(folder) = &args.plots {
        disk::create_dir_all(folder)?;
        for part in &parts {
            draw(part, &coat, folder)?;
        }
    }
    if let Some(path) = &args.file.json {
        write_json(
            path,
            &PaintFile {
                schema: 1,
                coat,
                parts,
            },
        )?;
    }
    Ok(Outcome::Accepted)
}

/// Enrols a part from a frame, named after the file.
fn enrolled(file: &Path) -> anyhow::Result<Reference> {
    let (scene, _) = open_scene(file).advised()?;
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let about = PartDescription {
        name: PartName::new(&stem).advised()?,
        title: String::new(),
        notes: String::new(),
        from: file.display().to_string(),
        at: geometry::clock::now(),
        simulated: false,
    };
    let found = enrol_captured(&scene, &about, &EnrolParams::default());
    Ok(found.advised()?.reference)
}

fn show(parts: &[PaintedPart], coat: &Coat, console: &mut Console) {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    console.line(&format_args!(
        "One gun for all; each path at the speed that brings most of the surface within {:.0} % of {:.0} µm.",
        100.0 * coat.tolerance,
        1e6 * coat.target
    ));
    console.line(&"");
    let mut table = Table::new(&[
        "part",
        "path",
        "planned in",
        "points",
        "rows",
        "length",
        "time",
        "paint",
        "paintable",
        "within",
        "missed",
        "double",
        "least",
        "most",
    ]);
    for part in parts {
        for trial in &part.trials {
            let film = &trial.film;
            table.row([
                part.name.clone(),
                trial.way.to_owned(),
                format!("{:.2} s", trial.seconds),
                trial.num_points.to_string(),
                trial.num_rows.to_string(),
                format!("{:.1} m", trial.path.length),
                format!("{:.0} s", trial.path.time),
                format!("{:.0} ml", 1e6 * trial.path.paint),
                percent(film.paintable),
                percent(film.within),
                percent(film.missed),
                percent(film.double),
                format!("{:.1} µm", 1e6 * film.min),
                format!("{:.1} µm", 1e6 * film.max),
            ]);
        }
    }
    console.table(&table);
    console.line(&"");
    console.line(&"The planned path: carried to the part hung 15° and 10 cm off; with an error of the pose, the worst of three axes; with the nozzle tilted everywhere as far as a robot program may tilt it, the worst of four directions.");
    let mut table = Table::new(&[
        "part", "hung", "error", "within", "mean by", "95 % by", "most by",
    ]);
    for part in parts {
        let errors = part.pose_costs.iter().map(|cost| {
            let error = format!("{}° and {:.0} mm", cost.turn_deg, 1000.0 * cost.shift_m);
            (error, &cost.film)
        });
        for (error, film) in errors.chain([("tilt".to_owned(), &part.tilt_cost)]) {
            table.row([
                part.name.clone(),
                format!("{:.3} %", 100.0 * part.hung_change),
                error,
                percent(film.least_within),
                percent(film.mean_change),
                percent(film.change_95),
                percent(film.most_change),
            ]);
        }
    }
    console.table(&table);
}

fn draw(part: &PaintedPart, coat: &Coat, folder: &Path) -> anyhow::Result<()> {
    let shares: Vec<f64> = part
        .film
        .thickness
        .iter()
        .map(|t| t / coat.target)
        .collect();
    let figures = &part.film.figures;
    let title = format!(
        "{}: {:.1} % within {:.0} % of {:.0} µm, {:.1} % missed, {:.1} % double",
        part.name,
        100.0 * figures.within,
        100.0 * coat.tolerance,
        1e6 * coat.target,
        100.0 * figures.missed,
        100.0 * figures.double
    );
    let picture = film_picture(&FilmPicture {
        title: &title,
        places: &seen_from_side(&part.surface),
        shares: &shares,
        is_paintable: &part.film.is_paintable,
        spacing: part.surface.spacing,
        histogram: &figures.histogram,
    });
    let file = folder.join(format!("{}.film.png", part.name));
    write_png(&file, &picture).advised()
}
