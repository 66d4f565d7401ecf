//! A simulated frame with its truth.

use serde::{Deserialize, Serialize};

use super::cell::{Cell, CellSetup, SimulatedObject, is_in_frame};
use super::part::PartKind;
use super::rasteriser::{Rendering, SurfaceLabel};
use geometry::depth_frame::{DepthFrame, Intrinsics};
use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;
use geometry::sixteen_numbers;

/// The truth about a simulated frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameTruth {
    /// The object in front of the camera.
    pub subject: SimulatedObject,
    /// Transform from the model's own coordinates to the camera's; written as `camera_from_model`, 16 numbers in row-major
    /// order. An enrolled part has other coordinates: those of the camera that captured it.
    #[serde(rename = "camera_from_model", with = "sixteen_numbers")]
    pub camera_from_part: RigidTransform,
    /// True if the whole part lies within the field of view. Something may still hide it.
    pub fully_visible: bool,
    /// Share of the part's camera-facing surface that is visible: its pixels in the field of view, divided by those it
    /// would have with nothing in front of it and in an unlimited picture.
    pub visible_share: f64,
    /// The surface that each pixel shows, row by row from the top left, before any noise: a pixel without a reading still has
    /// its label.
    #[serde(skip)]
    pub labels: Vec<SurfaceLabel>,
}

impl FrameTruth {
    /// Returns the kind of part, if the object is one of the eight.
    pub fn part(&self) -> Option<PartKind> {
        match self.subject {
            SimulatedObject::Part { kind, .. } => Some(kind),
            SimulatedObject::Object(_) | SimulatedObject::Nothing => None,
        }
    }
}

/// A frame as the sensor delivers it, with its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedFrame {
    /// The camera's frame.
    pub frame: DepthFrame,
    /// The truth about the frame.
    pub truth: FrameTruth,
}

/// Builds the subject, arranges the cell, and takes one frame of it.
pub fn frame(setup: &CellSetup) -> SimulatedFrame {
    frame_of_mesh(setup, &setup.subject.mesh())
}

/// Like [`frame`], with the subject's mesh already built, for many frames of one subject.
pub fn frame_of_mesh(setup: &CellSetup, mesh: &TriangleMesh) -> SimulatedFrame {
    let cell = Cell::arrange(setup, mesh);
    let mut rendering = Rendering::new(setup.intrinsics);
    cell.draw_part(&mut rendering);
    let alone = Unhidden::count(
        &rendering,
        &cell,
        mesh,
        &cell.camera_from_part,
        SurfaceLabel::Part,
    );
    cell.draw_rest(&mut rendering);
    let mut truth = alone.truth(setup.subject, &cell, &rendering);
    let frame = cell.sensor.sense(&rendering, &setup.noise);
    truth.labels = rendering.labels;
    SimulatedFrame { frame, truth }
}

/// How much of a part the camera would see if nothing hid it.
pub(super) struct Unhidden {
    label: SurfaceLabel,
    camera_from_part: RigidTransform,
    /// In an unlimited picture.
    num_pixels: usize,
    fully_visible: bool,
}

impl Unhidden {
    /// Counts the pixels of a part that is alone in `rendering`, with this label.
    pub(super) fn count(
        rendering: &Rendering,
        cell: &Cell<'_>,
        part: &TriangleMesh,
        camera_from_part: &RigidTransform,
        label: SurfaceLabel,
    ) -> Self {
        let camera = &rendering.intrinsics;
        let num_in_frame = rendering.num_pixels(label);
        let fits_frame = is_in_frame(part, camera_from_part, camera);
        Self {
            label,
            camera_from_part: *camera_from_part,
            num_pixels: if fits_frame {
                num_in_frame
            } else {
                num_pixels_without_edges(part, camera_from_part, camera)
            },
            fully_visible: fits_frame
                && cell.sensor.num_pixels_in_view(rendering, label) == num_in_frame,
        }
    }

    /// Returns the truth, without labels, about the part in the finished rendering.
    pub(super) fn truth(
        &self,
        subject: SimulatedObject,
        cell: &Cell<'_>,
        rendering: &Rendering,
    ) -> FrameTruth {
        let num_visible = cell.sensor.num_pixels_in_view(rendering, self.label);
        FrameTruth {
            subject,
            camera_from_part: self.camera_from_part,
            fully_visible: self.fully_visible,
            visible_share: num_visible as f64 / self.num_pixels.max(1) as f64,
            labels: Vec::new(),
        }
    }
}

/// Counts the part's pixels in a picture three times as wide and high, which holds the part unless it is very near.
fn num_pixels_without_edges(
    part: &TriangleMesh,
    camera_from_part: &RigidTransform,
    camera: &Intrinsics,
) -> usize {
    let mut rendering = Rendering::new(Intrinsics {
        width: 3 * camera.width,
        height: 3 * camera.height,
        cx: camera.cx + camera.width as f64,
        cy: camera.cy + camera.height as f64,
        ..*camera
    });
    rendering.draw_mesh(part, camera_from_part, SurfaceLabel::Part);
    rendering.num_pixels(SurfaceLabel::Part)
}

#[cfg(test)]
mod tests;
