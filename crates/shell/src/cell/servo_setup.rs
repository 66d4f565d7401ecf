//! What servoing has to know besides the part, from the window's settings and their files: once for the page that servoes a robot and
//! for robots that ask.

use std::path::Path;

use super::{setup::ServoSettings, state::edited};
use crate::inspection::report_files::ProgramTarget;
use capture::read_image;
use records::history::ServoTargetKind;
use robot::calibration::CellCalibration;
use stages::scene::{SceneCloud, scene_from_image};
use station::servoing::{ServoSetup, ServoTarget};
use ui::{language::text, user_error::UserError};

/// There is no calibration to servo by.
pub fn not_calibrated() -> UserError {
    UserError {
        what: text!("servoing-not-calibrated"),
        advice: text!("servoing-not-calibrated-advice"),
    }
}

/// Reads calibration and target.
pub fn servo_setup(
    settings: &ServoSettings,
    program: &ProgramTarget,
    calibration: &Path,
) -> Result<ServoSetup, UserError> {
    if !calibration.exists() {
        return Err(not_calibrated());
    }
    let read = CellCalibration::read(calibration).map_err(|error| UserError::of(&error))?;
    if read.is_edited {
        return Err(edited());
    }
    let target = match settings.target {
        ServoTargetKind::StandardPosition => ServoTarget::StandardPosition,
        ServoTargetKind::PathStart => ServoTarget::PathStart,
        ServoTargetKind::CameraPose => {
            let scenes = settings.seen_as.iter().map(|path| scene_of(path));
            ServoTarget::SeenAs(scenes.collect::<Result<Vec<_>, UserError>>()?)
        }
    };
    Ok(ServoSetup {
        camera: read.calibration.camera,
        calibration: read.calibration.bounds(),
        target,
        flange_from_nozzle: program.settings.flange_from_nozzle,
        placed: program.arm.clone(),
        volume: settings.volume,
        params: settings.params().map_err(|error| UserError::of(&error))?,
    })
}

fn scene_of(path: &Path) -> Result<(String, SceneCloud), UserError> {
    let (image, _) = read_image(path).map_err(|error| UserError::of(&error))?;
    Ok((files::file_name(path), scene_from_image(image)))
}
