//! Pairs as JSON.

use std::path::Path;

use serde::Deserialize;

use super::{LineProblem, PairConventions, Pairs, PairsError};
use crate::robot::{Convention, hand_eye::PosePair};

#[derive(Deserialize)]
struct File {
    robot: Option<Convention>,
    camera: Option<Convention>,
    pairs: Vec<Pair>,
}

#[derive(Deserialize)]
struct Pair {
    name: Option<String>,
    robot: Vec<f64>,
    camera: Vec<f64>,
}

pub(super) fn is_json(text: &str) -> bool {
    text.trim_start().starts_with('{')
}

pub(super) fn pairs(text: &str, path: &Path, given: PairConventions) -> Result<Pairs, PairsError> {
    let file: File = serde_json::from_str(text).map_err(|error| PairsError::BadJson {
        path: path.to_owned(),
        found: error.to_string(),
    })?;
    let robot = given.robot.or(file.robot);
    let robot = robot.ok_or_else(|| PairsError::NoConvention {
        path: path.to_owned(),
    })?;
    let camera = given.camera.or(file.camera).unwrap_or(Convention::Matrix);
    if file.pairs.is_empty() {
        return Err(PairsError::NoPoses {
            path: path.to_owned(),
        });
    }
    let pairs = file.pairs.into_iter().enumerate().map(|(i, pair)| {
        let place = format!("pair {}", i + 1);
        let pose = |convention: Convention, numbers: &[f64]| {
            convention.read(numbers).map_err(|error| PairsError::Line {
                path: path.to_owned(),
                place: place.clone(),
                problem: LineProblem::Pose(error),
            })
        };
        Ok(PosePair {
            robot_from_flange: pose(robot, &pair.robot)?,
            camera_from_target: pose(camera, &pair.camera)?,
            name: match pair.name {
                Some(name) => format!("{name} ({place})"),
                None => place,
            },
        })
    });
    Ok(Pairs {
        pairs: pairs.collect::<Result<_, PairsError>>()?,
        robot,
        camera,
    })
}
