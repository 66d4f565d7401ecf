//! `partsight library surface`: how the surface of a part is checked.

use clap::Args;

use super::{Console, LibraryChoice, Outcome};
use crate::cli::{
    console::Advised as _,
    input::{parse_name, within},
    read_part,
};
use inspection::library::{PartName, SurfaceZone, SurfaceZones};

/// Say how far the surface of a part may deviate, or show it
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight library surface front_door
  partsight library surface front_door --check true --tolerance 2.5 --scrap 8
  partsight library surface front_door --check false
  partsight library surface front_door --remove

With --check true, every inspection of the part checks its surface. The tolerances are those of what no other zone contains; other \
zones are written into part.toml. Without a tolerance, whatever certainly deviates is to be reworked.")]
pub(super) struct SurfaceArgs {
    /// Name of the part
    #[arg(value_parser = parse_name)]
    name: PartName,
    /// Whether every inspection of the part checks its surface
    #[arg(long, value_name = "BOOL")]
    check: Option<bool>,
    /// Deviation up to which the part is good, millimetres
    #[arg(long, value_name = "MM", value_parser = parse_mm)]
    tolerance: Option<f64>,
    /// Deviation beyond which it cannot be repaired, millimetres
    #[arg(long, value_name = "MM", value_parser = parse_mm)]
    scrap: Option<f64>,
    /// Remove all zones; no inspection checks the surface
    #[arg(long, conflicts_with_all = ["check", "tolerance", "scrap"])]
    remove: bool,
}

fn parse_mm(text: &str) -> Result<f64, String> {
    within(text, &(0.1..=100.0))
}

pub(super) fn run(
    choice: &LibraryChoice,
    args: &SurfaceArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let SurfaceArgs {
        name,
        check,
        tolerance,
        scrap,
        remove,
    } = args;
    let place = choice.open(console)?;
    let stored = read_part(&place, name)?.meta.surface;
    if *remove {
        choice.open_to_change()?.set_surface(name, None).advised()?;
        console.line(&format_args!("The surface of {name} is not checked now"));
        return Ok(Outcome::Accepted);
    }
    if check.is_none() && tolerance.is_none() && scrap.is_none() {
        show(name, stored.as_ref(), console);
        return Ok(Outcome::Accepted);
    }
    let mut zones = stored.unwrap_or_default();
    zones.check = check.unwrap_or(zones.check);
    if tolerance.is_some() || scrap.is_some() {
        let rest = zones.rest();
        rest.tolerance_mm = tolerance.or(rest.tolerance_mm);
        rest.scrap_mm = scrap.or(rest.scrap_mm);
    }
    choice
        .open_to_change()?
        .set_surface(name, Some(zones.clone()))
        .advised()?;
    show(name, Some(&zones), console);
    Ok(Outcome::Accepted)
}

fn show(name: &PartName, zones: Option<&SurfaceZones>, console: &mut Console) {
    let is_checked = zones.is_some_and(|zones| zones.check);
    let when = if is_checked {
        "is checked in every inspection"
    } else {
        "is checked only with inspect --surface"
    };
    console.line(&format_args!("The surface of {name} {when}"));
    for zone in zones.iter().flat_map(|zones| &zones.zones) {
        console.line(&format_args!("  {}", in_words(zone)));
    }
}

fn in_words(zone: &SurfaceZone) -> String {
    let name = match (zone.name.as_str(), zone.balls_mm.len()) {
        ("", 0) => "the rest of the part".to_owned(),
        ("", num) => format!("a zone of {num} balls"),
        (name, _) => files::visible(name).into_owned(),
    };
    if zone.is_ignored {
        return format!("{name}: nothing is judged");
    }
    let good = zone.tolerance_mm.map_or_else(
        || "by the noise".to_owned(),
        |mm| format!("good up to {mm} mm"),
    );
    let scrap = zone
        .scrap_mm
        .map_or_else(String::new, |mm| format!(", scrap beyond {mm} mm"));
    format!("{name}: {good}{scrap}")
}
