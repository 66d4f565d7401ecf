//! `partsight simulate --cases DIR`: writes frames with their truth as cases for `partsight evaluate`.

use std::path::Path;

use jiff::Timestamp;

use super::SimulateArgs;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, advised_error},
    input::open_case_folder,
};
use inspection::library::shipped_enrolled_at;
use records::cases::{CaseDescription, FoundVerdict, TruePose, Truth};
use simulate::{PartPose, Side, SimulatedFrame, SimulatedObject, frame};
use stages::scene::scene_from_frame;

/// Writes `--num` cases that cycle through the objects, then through the placements, each with its own seed.
pub(super) fn run(
    folder: &Path,
    args: &SimulateArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let folder = open_case_folder(folder)?;
    let subjects = args.subjects();
    let num = args.num as usize;
    console.start_progress(num);
    for index in 0..num {
        let subject = subjects[index % subjects.len()];
        let (placement, pose_range) =
            args.placement[(index / subjects.len()) % args.placement.len()];
        let seed = args.seed.checked_add(index as u64).ok_or_else(|| {
            advised_error(
                "the seeds go beyond the largest number",
                "Begin with a smaller one, such as --seed 1",
            )
        })?;
        let mut setup = args.cell(subject, seed);
        setup.pose = PartPose::Drawn(pose_range());
        let shot = frame(&setup);
        let difficulty = match &args.difficulty {
            Some(words) => words.clone(),
            None if args.booth => "booth".to_owned(),
            None => placement.to_owned(),
        };
        let origin = format!("{} {difficulty} {seed}", name_of(subject));
        console.begin(&origin);
        let scene = scene_from_frame(&shot.frame);
        let about = about(&shot, origin, difficulty);
        folder.keep(&scene, about).advised()?;
        console.done();
    }
    console.end_progress();
    console.line(&format_args!(
        "{}: {num} simulated cases. Now: partsight evaluate {0}",
        folder.path().display()
    ));
    Ok(Outcome::Accepted)
}

fn name_of(subject: SimulatedObject) -> &'static str {
    match subject {
        SimulatedObject::Part { kind, .. } => kind.name(),
        SimulatedObject::Object(kind) => kind.name(),
        SimulatedObject::Nothing => "empty",
    }
}

/// Describes a frame in terms of the shipped parts, since those are in every new library.
fn about(shot: &SimulatedFrame, origin: String, difficulty: String) -> CaseDescription {
    let truth = &shot.truth;
    let enrolled_at = match truth.subject {
        // Where there are two sides, the left part is shipped.
        SimulatedObject::Part { kind, side, .. } if side == Side::Left || !kind.is_sided() => {
            shipped_enrolled_at(kind.name())
        }
        _ => None,
    };
    let is = match truth.subject {
        SimulatedObject::Nothing => Truth::Nothing,
        SimulatedObject::Part { kind, .. } if enrolled_at.is_some() => {
            Truth::Part(kind.name().into())
        }
        SimulatedObject::Part { .. } | SimulatedObject::Object(_) => Truth::NotEnrolled,
    };
    // A part of another car model hangs only about where the enrolled one would be.
    let is_same_model = matches!(truth.subject, SimulatedObject::Part { model_seed: 0, .. });
    let enrolled_at = enrolled_at.filter(|_| is_same_model);
    CaseDescription {
        origin,
        simulated: true,
        // A fixed time, so that the same arguments give the same files.
        kept_at: Timestamp::UNIX_EPOCH,
        remark: match truth.subject {
            SimulatedObject::Nothing => String::new(),
            _ => format!("{:.0} % of it in sight", truth.visible_share * 100.0),
        },
        difficulty: Some(difficulty),
        truth: is,
        // Not inspected yet.
        found: FoundVerdict::default(),
        pose: enrolled_at.map(|at| TruePose {
            camera_from_part: truth.camera_from_part * at.part_from_model.inverse(),
            cloud_crc32: Some(at.cloud.crc32),
        }),
        one_of_several: None,
    }
}
