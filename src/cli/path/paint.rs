//! `partsight path plan` and `path simulate`: a path over an enrolled part, and the resulting film.

use crate::cli::input::parse_name;
use std::path::PathBuf;

use clap::Args;
use nalgebra::Point3;
use serde_json::json;

use super::stored_path;
use crate::cli::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console},
    input::parse_side,
    read_part,
    recipe::parse_setting,
};
use files::write_text;
use geometry::units::counted;
use inspection::{
    library::{PartName, Side, SprayPath, StoredPart},
    pipeline::parameters::Setting,
};
use records::report::SCHEMA;
use robot::paint::{
    Coat, CoatFolder, Film, KeepOut, LEAST_WITHIN, PaintSurface, plan, propose, simulate,
};

/// Plan a spray path over the side of a part that was seen when it was enrolled, and simulate its film
#[derive(Debug, Args)]
pub(super) struct PlanArgs {
    /// Name of the part
    #[arg(value_parser = parse_name)]
    part: PartName,
    #[command(flatten)]
    coat: CoatChoice,
    /// Find the row spacing and the speed that bring the film to the coat's target
    #[arg(long)]
    propose: bool,
    /// Keep the paint out of a sphere, part frame, mm: "X Y Z RADIUS"; may be given several times
    #[arg(long, value_name = "SPHERE", value_parser = parse_sphere, allow_hyphen_values = true)]
    keep_out: Vec<KeepOut>,
    /// Side of the part to paint, as seen by a camera in front of it: front, back, left, right, top or bottom; stored
    /// with --store. Default: the one stored with the part, else the only one seen, or the outside
    #[arg(long, value_name = "SIDE", value_parser = parse_side)]
    side: Option<Side>,
    /// Write the path as a table, as library path reads it
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Store the path with the part
    #[arg(long)]
    store: bool,
    /// Write one line of JSON
    #[arg(long)]
    json: bool,
}

/// Simulate the film that a part's stored path leaves
#[derive(Debug, Args)]
pub(super) struct SimulateArgs {
    /// Name of the part
    #[arg(value_parser = parse_name)]
    part: PartName,
    #[command(flatten)]
    coat: CoatChoice,
    /// Side of the part to paint, as in path plan
    #[arg(long, value_name = "SIDE", value_parser = parse_side)]
    side: Option<Side>,
    /// File of the path; default: the path stored with the part
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,
    /// Write one line of JSON
    #[arg(long)]
    json: bool,
}

/// A coat, and parameters that are given another value.
#[derive(Debug, Args)]
pub(super) struct CoatChoice {
    /// The coat: `primer`, `base_coat`, `clear_coat`, one of your own, or a file
    #[arg(long, value_name = "NAME|FILE")]
    coat: String,
    /// Set a parameter of the coat, in its own unit, such as spacing=60; may be given several times.
    /// docs/guide/paint.md lists names, units and ranges
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse_setting::<Coat>)]
    set: Vec<Setting<Coat>>,
}

impl CoatChoice {
    pub(super) fn open(&self) -> anyhow::Result<Coat> {
        let mut coat = CoatFolder::of_user()
            .and_then(|folder| folder.open(&self.coat))
            .advised()?
            .recipe;
        for setting in &self.set {
            setting.apply(&mut coat);
        }
        Ok(coat)
    }
}

fn parse_sphere(text: &str) -> Result<KeepOut, String> {
    let metres: Option<Vec<f64>> = text
        .split_whitespace()
        .map(|number| number.parse::<f64>().ok().map(|mm| mm / 1000.0))
        .collect();
    let Some([x, y, z, radius]) = metres.as_deref() else {
        return Err("expected four numbers in mm: \"X Y Z RADIUS\"".into());
    };
    Ok(KeepOut::Sphere {
        centre: Point3::new(*x, *y, *z),
        radius: *radius,
    })
}

pub(super) fn run_plan(
    choice: &LibraryChoice,
    args: &PlanArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let name = &args.part;
    let coat = args.coat.open()?;
    let part = read_part(&choice.open(console)?, name)?;
    let surface = surface_of(&part, args.side)?;
    let (coat, path, film) = if args.propose {
        let found = propose(&surface, &coat, &args.keep_out).advised()?;
        (found.coat, found.path, found.film)
    } else {
        let path = plan(&surface, &coat, &args.keep_out).advised()?;
        let film = simulate(&surface, &path, &coat, &args.keep_out).advised()?;
        (coat, path, film)
    };
    warn_of_idle(&args.keep_out, &surface, console);
    if let Some(file) = &args.output {
        let text = path.to_text_of(name);
        write_text(file, &text).advised()?;
    }
    if args.store {
        let folder = choice.open_to_change()?;
        if let Some(side) = args.side {
            folder.set_side(name, side).advised()?;
        }
        folder.set_spray_path(name, Some(&path)).advised()?;
    }
    if !args.json {
        console.line(&format_args!(
            "{name}: {} on {}; rows {:.0} mm apart at {:.0} mm/s",
            counted(path.points().len(), "point", "points"),
            surface.scope(),
            1000.0 * coat.spacing,
            1000.0 * coat.speed
        ));
        if let Some(file) = &args.output {
            console.line(&format_args!("  written to {}", file.display()));
        }
        if args.store {
            console.line(&format_args!("  stored with {name}"));
        }
    }
    let outcome = show(name, &surface, &coat, &path, &film, args.json, console);
    if !args.json && args.output.is_none() && !args.store {
        console.line(
            &"  not kept: write the path with --output FILE, or store it with the part: --store",
        );
    }
    Ok(outcome)
}

/// Warns of each sphere that reaches no surface, as in the wrong unit.
fn warn_of_idle(keep_out: &[KeepOut], surface: &PaintSurface, console: &Console) {
    let idle = keep_out.iter().filter(|region| !region.touches(surface));
    for region in idle {
        if let KeepOut::Sphere { centre, radius } = region {
            let mm = |metres: f64| (1e6 * metres).round() / 1000.0;
            let [x, y, z, radius] = [centre.x, centre.y, centre.z, *radius].map(mm);
            let sphere = format!("{x} {y} {z} {radius}");
            console.advise(
                &format_args!(
                    "warning: --keep-out {sphere:?} touches no point of the surface, so nothing is kept out"
                ),
                &"Give centre and radius in millimetres, in the part's frame",
            );
        }
    }
}

pub(super) fn run_simulate(
    choice: &LibraryChoice,
    args: &SimulateArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let name = &args.part;
    let coat = args.coat.open()?;
    let part = read_part(&choice.open(console)?, name)?;
    let path = match &args.path {
        Some(file) => SprayPath::read_for(file, name).advised()?,
        None => stored_path(&choice.open(console)?, name)?,
    };
    let surface = surface_of(&part, args.side)?;
    let film = simulate(&surface, &path, &coat, &[]).advised()?;
    Ok(show(
        name, &surface, &coat, &path, &film, args.json, console,
    ))
}

fn surface_of(part: &StoredPart, side: Option<Side>) -> anyhow::Result<PaintSurface> {
    let StoredPart {
        reference, meta, ..
    } = part;
    PaintSurface::of(reference, meta.coverage, side.or(meta.side)).advised()
}

fn show(
    name: &PartName,
    surface: &PaintSurface,
    coat: &Coat,
    path: &SprayPath,
    film: &Film,
    is_json: bool,
    console: &mut Console,
) -> Outcome {
    let (figures, takes) = (&film.figures, &film.path);
    let micrometres = |metres: f64| 1e6 * metres;
    if is_json {
        console.line(&json!({
            "schema": SCHEMA,
            "part": name.as_str(),
            "scope": surface.scope(),
            "num_points": path.points().len(),
            "spacing_mm": 1000.0 * coat.spacing,
            "speed_mm_s": 1000.0 * coat.speed,
            "target_um": micrometres(coat.target),
            "reachable": figures.paintable,
            "within": figures.within,
            "missed": figures.missed,
            "double": figures.double,
            "mean_um": micrometres(figures.mean),
            "min_um": micrometres(figures.min),
            "max_um": micrometres(figures.max),
            "histogram": figures.histogram,
            "paint_ml": 1e6 * takes.paint,
            "landed": takes.landed,
            "time_s": takes.time,
            "length_m": takes.length,
            "side": surface.painted_side().name(),
        }));
    } else {
        console.line(&format_args!(
            "  film {:.1} µm on average, {:.1} to {:.1} µm, wanted {:.1} µm; {:.1} % within {:.0} %, {:.1} % missed, {:.1} % double",
            micrometres(figures.mean),
            micrometres(figures.min),
            micrometres(figures.max),
            micrometres(coat.target),
            100.0 * figures.within,
            100.0 * coat.tolerance,
            100.0 * figures.missed,
            100.0 * figures.double
        ));
        console.line(&format_args!(
            "  {:.1} m in {:.0} s, {:.0} ml of paint, {:.0} % of its solids on the part; {:.1} % of the surface is paintable",
            takes.length,
            takes.time,
            1e6 * takes.paint,
            100.0 * takes.landed,
            100.0 * figures.paintable
        ));
    }
    Outcome::accepted_if(figures.within >= LEAST_WITHIN)
}
