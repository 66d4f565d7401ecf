//! A simulated frame with its truth.

use serde::{Deserialize, Serialize};

use super::cell::{Cell, CellSetup, SimulatedObject};
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
    let num_in_frame = rendering.num_pixels(SurfaceLabel::Part);
    let num_in_view = cell.sensor.num_part_pixels(&rendering);
    let num_alone = if cell.fits_frame {
        num_in_frame
    } else {
        num_pixels_without_edges(mesh, &cell.camera_from_part, &setup.intrinsics)
    };
    cell.draw_rest(&mut rendering);
    let num_visible = cell.sensor.num_part_pixels(&rendering);
    SimulatedFrame {
        frame: cell.sensor.sense(&rendering, &setup.noise),
        truth: FrameTruth {
            subject: setup.subject,
            camera_from_part: cell.camera_from_part,
            fully_visible: cell.fits_frame && num_in_view == num_in_frame,
            visible_share: num_visible as f64 / num_alone.max(1) as f64,
            labels: rendering.labels,
        },
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
