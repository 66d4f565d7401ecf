//! `partsight simulate --rack N`: writes a frame of several parts side by side.

use std::path::Path;

use super::{SimulateArgs, check_outputs_differ, write_frame};
use crate::cli::{
    Outcome,
    console::{Advised as _, Console},
    write_json,
};
use simulate::{RackSetup, SimulatedObject, rack_frame};

pub(super) fn run(
    num_places: usize,
    out: &Path,
    args: &SimulateArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    check_outputs_differ(args, out)?;
    let mut setup =
        RackSetup::drawn(args.rack_kind, num_places, args.model, args.seed).advised()?;
    args.equip(&mut setup.cell);
    let rack = rack_frame(&setup).advised()?;
    write_frame(out, &rack.frame)?;
    if let Some(path) = &args.truth {
        write_json(path, &rack.truth)?;
    }
    let parts = &rack.truth.parts;
    console.line(&format_args!(
        "{}: a simulated rack of {num_places} places, {} of them taken; from left to right:",
        out.display(),
        parts.len()
    ));
    for part in parts {
        let what = match part.subject {
            SimulatedObject::Part { kind, side, .. } if kind.is_sided() => {
                format!("{} {}", side.name(), kind.title().to_lowercase())
            }
            SimulatedObject::Part { kind, .. } => kind.title().to_lowercase(),
            SimulatedObject::Object(kind) => kind.name().to_owned(),
            SimulatedObject::Nothing => continue,
        };
        let [x, y, z] = [0, 1, 2].map(|i| part.camera_from_part.translation.vector[i] * 1000.0);
        console.line(&format_args!(
            "  {what}, {:.0} % of it in sight; the origin of its model at x {x:.0}  y {y:.0}  z {z:.0} mm",
            part.visible_share * 100.0
        ));
    }
    Ok(Outcome::Accepted)
}
