//! `partsight path fit`: fits a gun to a measured stripe.

use std::path::PathBuf;

use clap::Args;

use super::paint::CoatChoice;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, advised_error},
};
use inspection::{library::PartName, pipeline::RecipeFile};
use robot::paint::{Coat, Profile, fit_stripe, read_stripe};

/// Fit the gun of a coat to a measured stripe: pattern width, transfer efficiency, and Gaussian or beta profile
#[derive(Debug, Args)]
pub(super) struct FitArgs {
    /// Thicknesses across one straight stripe: a table with a heading, `offset_mm,thickness_um`
    stripe: PathBuf,
    #[command(flatten)]
    coat: CoatChoice,
    /// Speed at which the stripe was sprayed, mm/s; default: the coat's
    #[arg(long, value_name = "MM/S", allow_negative_numbers = true)]
    speed: Option<f64>,
    /// Distance from the nozzle's mouth to the plate, mm; default: the coat's stand-off
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    distance: Option<f64>,
    /// Write the coat with this gun, named like the file
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace a file of that name
    #[arg(long, requires = "output")]
    force: bool,
}

pub(super) fn run(args: &FitArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let coat = args.coat.open()?;
    let samples = read_stripe(&args.stripe).advised()?;
    let speed = args.speed.map_or(coat.speed, |speed| speed / 1000.0);
    let distance = args.distance.map_or(coat.stand_off, |mm| mm / 1000.0);
    let found = fit_stripe(&samples, &coat, speed, distance).advised()?;
    let gun = found.gun;
    let profile = match gun.profile {
        Profile::Gaussian => "Gaussian".to_owned(),
        Profile::Beta => format!("beta profile with β = {:.2}", gun.beta),
    };
    console.line(&format_args!(
        "{} places: {profile}, {:.1} mm wide at {:.0} mm, {:.1} % of the paint on the plate",
        samples.len(),
        1000.0 * gun.width,
        1000.0 * gun.distance,
        100.0 * gun.transfer
    ));
    console.line(&format_args!(
        "  residual {:.2} µm rms, {:.2} µm with the other profile; middle of the stripe at {:.1} mm",
        1e6 * found.residual,
        1e6 * found.other_residual,
        1000.0 * found.middle
    ));
    console.line(&"  A stripe does not show the pattern's depth, which stays as in the coat");
    if let Some(file) = &args.output {
        if file.exists() && !args.force {
            return Err(advised_error(
                format!("{} exists already", file.display()),
                "Give another file, or replace it with --force",
            ));
        }
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        let named = PartName::new(&stem).advised()?;
        let coat = RecipeFile {
            name: named,
            notes: format!("Gun fitted to {} places of a stripe", samples.len()),
            recipe: Coat { gun, ..coat },
        };
        coat.write(file).advised()?;
        console.line(&format_args!("  written to {}", file.display()));
    }
    Ok(Outcome::Accepted)
}
