//! `partsight library path`: stores, shows and removes the spray path of a part.

use crate::cli::input::parse_name;
use std::path::PathBuf;

use clap::Args;

use super::{Console, LibraryChoice, Outcome};
use crate::cli::{console::Advised as _, read_part};
use geometry::units::counted;
use inspection::library::{PartName, SprayPath};
use robot::spray::{BandStatus, against_reference, off_the_part};
use stages::{reference::Reference, stand_off::StandOffParams};

/// Store the nozzle's path over a part, or show what is stored
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight library path front_door path.csv
  partsight library path front_door
  partsight library path front_door --remove

The path is a table in the part's own frame: that of its reference cloud, which was the camera's when the part was \
enrolled (x right, y down, z forward). Its heading names columns and units, in one of two ways:

  nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z
  12.0,-40.5,1141.0,0,0,1                      position of the nozzle, and its direction: towards the part

  x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,stand_off_mm
  12.0,-40.5,1291.0,0,0,-1,150                 a point of the surface, its normal towards the nozzle, the distance

Exit code 1 if the path does not aim at the part: it is stored, but programs of it \
are refused, and `serve` does not send it.")]
pub(super) struct PathArgs {
    /// Name of the part
    #[arg(value_parser = parse_name)]
    name: PartName,
    /// The path; without it, the stored one is shown
    #[arg(value_name = "FILE", conflicts_with = "remove")]
    file: Option<PathBuf>,
    /// Remove the stored path
    #[arg(long)]
    remove: bool,
}

pub(super) fn run(
    choice: &LibraryChoice,
    args: &PathArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let PathArgs { name, file, remove } = args;
    if *remove {
        choice
            .open_to_change()?
            .set_spray_path(name, None)
            .advised()?;
        console.line(&format_args!("{name} has no spray path now"));
        return Ok(Outcome::Accepted);
    }
    let place = choice.open(console)?;
    let reference = read_part(&place, name)?.reference;
    let Some(file) = file else {
        match place.spray_path(name.as_str()).advised()? {
            Some(path) => {
                tell(name, &path, &reference, console);
            }
            None => console.line(&format_args!("{name} has no spray path")),
        }
        return Ok(Outcome::Accepted);
    };
    let path = SprayPath::read_for(file, name).advised()?;
    choice
        .open_to_change()?
        .set_spray_path(name, Some(&path))
        .advised()?;
    console.line(&format_args!("Stored {} with {name}", file.display()));
    let is_off = tell(name, &path, &reference, console);
    Ok(Outcome::accepted_if(!is_off))
}

/// Shows how the path lies over the part as it was enrolled; returns true, and warns, if it does not aim at it.
fn tell(name: &PartName, path: &SprayPath, reference: &Reference, console: &mut Console) -> bool {
    let params = StandOffParams::default();
    let bands = against_reference(path, reference, &params);
    let count = |wanted: BandStatus| bands.iter().filter(|band| **band == wanted).count();
    let (num, inside, missed) = (
        bands.len(),
        count(BandStatus::Inside),
        count(BandStatus::NotSeen),
    );
    console.line(&format_args!(
        "  {} over {name} as it was enrolled: {inside} within {:.0} to {:.0} mm and square on, {} not, {missed} with no surface before {}",
        counted(num, "point", "points"),
        params.nearest.mm(),
        params.farthest.mm(),
        num - inside - missed,
        if missed == 1 { "it" } else { "them" }
    ));
    let off = off_the_part(path, reference);
    if let Some(off) = &off {
        console.warn(off, off);
    }
    off.is_some()
}
