//! The scenes of one camera's frames.

use std::sync::Arc;

use capture::{CaptureWarning, Captured, Image};
use stages::{
    field_of_view::FieldOfView,
    scene::{EmptyCell, EmptyCellError, SceneCloud, scene_from_image},
};

/// Makes scenes of the frames of one camera: with the empty cell, and with what earlier frames have shown of the field of
/// view. Warnings that concern the camera are given once.
#[derive(Debug, Default)]
pub struct CameraScenes {
    empty_cell: Option<Arc<EmptyCell>>,
    known_view: Option<Arc<FieldOfView>>,
    is_independent: bool,
    given: Vec<CaptureWarning>,
    is_misfit_given: bool,
}

impl CameraScenes {
    /// Makes scenes in front of this empty cell.
    pub fn new(empty_cell: Option<Arc<EmptyCell>>) -> Self {
        Self {
            empty_cell,
            ..Self::default()
        }
    }

    /// As [`Self::new`], for captures that are independent: none shows another one's field of view.
    pub fn independent(empty_cell: Option<Arc<EmptyCell>>) -> Self {
        Self {
            is_independent: true,
            ..Self::new(empty_cell)
        }
    }

    /// Makes the scene of the next frame.
    pub fn next(&mut self, image: Image) -> SceneCloud {
        let mut scene = scene_from_image(image);
        scene.empty_cell.clone_from(&self.empty_cell);
        if !self.is_independent {
            let known = self.known_view.take();
            scene.set_known_view(known.clone());
            self.known_view = FieldOfView::remembered(known, scene.field_of_view());
        }
        scene
    }

    /// Returns an error for the first scene whose camera is not that of the empty cell.
    pub fn misfit(&mut self, scene: &SceneCloud) -> Option<EmptyCellError> {
        let misfit = scene.fitting_empty_cell().err();
        misfit.filter(|_| !std::mem::replace(&mut self.is_misfit_given, true))
    }

    /// Returns the warnings about a frame, except those about the camera that were given before.
    pub fn warnings<'a>(&mut self, captured: &'a Captured) -> Vec<&'a CaptureWarning> {
        let warnings = captured.warnings.iter();
        let new = warnings.filter(|warning| {
            let is_known = warning.is_about_source() && self.given.contains(warning);
            if warning.is_about_source() && !is_known {
                self.given.push((*warning).clone());
            }
            !is_known
        });
        new.collect()
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use capture::fixtures::captured;
    use files::FileWarning;

    #[test]
    fn a_warning_about_the_camera_is_given_once_and_one_about_a_frame_each_time() {
        let of_camera = CaptureWarning::CutOff { num_frames: 3 };
        let of_frame = CaptureWarning::File(FileWarning::SurplusBytes { num: 8 });
        assert!(of_camera.is_about_source() && !of_frame.is_about_source());
        let frame = Captured {
            warnings: vec![of_camera.clone(), of_frame.clone()],
            ..captured(1, Timestamp::UNIX_EPOCH)
        };
        let mut scenes = CameraScenes::default();
        assert_eq!(scenes.warnings(&frame), [&of_camera, &of_frame]);
        assert_eq!(scenes.warnings(&frame), [&of_frame]);
    }
}
