//! A fixed cell for many frames: everything that does not move is drawn once.

use super::cell::{Cell, CellSetup, SimulatedObject, is_in_frame};
use super::rasteriser::{Rendering, SurfaceLabel};
use super::sensor::{Sensor, SensorNoise};
use super::shot::{FrameTruth, SimulatedFrame};
use geometry::depth_frame::Intrinsics;
use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;

/// A fixed cell in which only the part moves and the sensor's noise changes.
pub struct StandingCell {
    subject: SimulatedObject,
    mesh: TriangleMesh,
    intrinsics: Intrinsics,
    camera_from_part: RigidTransform,
    /// Everything but the part.
    backdrop: Rendering,
    sensor: Box<dyn Sensor>,
}

impl StandingCell {
    /// Arranges the cell around the part at rest. `mesh` is the subject's mesh.
    pub fn arrange(setup: &CellSetup, mesh: TriangleMesh) -> Self {
        let cell = Cell::arrange(setup, &mesh);
        let mut backdrop = Rendering::new(setup.intrinsics);
        cell.draw_rest(&mut backdrop);
        let (camera_from_part, sensor) = (cell.camera_from_part, cell.sensor);
        Self {
            subject: setup.subject,
            mesh,
            intrinsics: setup.intrinsics,
            camera_from_part,
            backdrop,
            sensor,
        }
    }

    /// Returns the part's pose at rest, `camera_from_part`.
    pub fn rest_pose(&self) -> RigidTransform {
        self.camera_from_part
    }

    /// Takes a frame with the part at this pose. If no pixel shows the part, the truth is
    /// [`SimulatedObject::Nothing`].
    pub fn frame(&self, camera_from_part: &RigidTransform, noise: &SensorNoise) -> SimulatedFrame {
        let mut rendering = Rendering::new(self.intrinsics);
        rendering.draw_mesh(&self.mesh, camera_from_part, SurfaceLabel::Part);
        let num_in_frame = rendering.num_pixels(SurfaceLabel::Part);
        let num_in_view = self
            .sensor
            .num_pixels_in_view(&rendering, SurfaceLabel::Part);
        let fully_visible = is_in_frame(&self.mesh, camera_from_part, &self.intrinsics);
        let num_alone = if fully_visible || num_in_frame == 0 {
            num_in_frame
        } else {
            // The coarse count may fall below the exact number of pixels in the picture.
            num_in_frame.max(self.num_pixels_without_edges(camera_from_part))
        };
        rendering.draw_behind(&self.backdrop);
        let num_visible = self
            .sensor
            .num_pixels_in_view(&rendering, SurfaceLabel::Part);
        SimulatedFrame {
            frame: self.sensor.sense(&rendering, noise),
            truth: FrameTruth {
                subject: if num_in_frame == 0 {
                    SimulatedObject::Nothing
                } else {
                    self.subject
                },
                camera_from_part: *camera_from_part,
                fully_visible: fully_visible && num_in_view == num_in_frame,
                visible_share: num_visible as f64 / num_alone.max(1) as f64,
                labels: rendering.labels,
            },
        }
    }

    /// Estimates the part's pixels in an unlimited picture, from one that shows three times as much at a third of the
    /// resolution: it must keep up with the camera while a part moves in.
    fn num_pixels_without_edges(&self, camera_from_part: &RigidTransform) -> usize {
        const COARSER: usize = 3;
        let camera = self.intrinsics;
        let coarser = COARSER as f64;
        let mut rendering = Rendering::new(Intrinsics {
            fx: camera.fx / coarser,
            fy: camera.fy / coarser,
            cx: (camera.cx + camera.width as f64) / coarser,
            cy: (camera.cy + camera.height as f64) / coarser,
            ..camera
        });
        rendering.draw_mesh(&self.mesh, camera_from_part, SurfaceLabel::Part);
        COARSER * COARSER * rendering.num_pixels(SurfaceLabel::Part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Clutter, PartKind, Side, frame};

    #[test]
    fn at_rest_it_gives_the_same_frame_as_drawing_all_of_it() {
        for (seed, clutter) in [
            (1, Clutter::None),
            (2, Clutter::OnFloor),
            (3, Clutter::InFront),
        ] {
            let kind = PartKind::ALL[seed as usize];
            let mut setup = CellSetup::with_part(kind, Side::Left, 0, seed);
            setup.clutter = clutter;
            let cell = StandingCell::arrange(&setup, setup.subject.mesh());
            let found = cell.frame(&cell.rest_pose(), &setup.noise);
            assert!(found == frame(&setup), "seed {seed}");
        }
        let booth = CellSetup::booth(
            SimulatedObject::Part {
                kind: PartKind::Fender,
                side: Side::Left,
                model_seed: 0,
            },
            7,
        );
        let cell = StandingCell::arrange(&booth, booth.subject.mesh());
        let found = cell.frame(&cell.rest_pose(), &booth.noise);
        assert!(found.frame == frame(&booth).frame);
    }

    #[test]
    fn what_is_out_of_the_picture_is_not_there() {
        let setup = CellSetup::with_part(PartKind::Grille, Side::Left, 0, 5);
        let cell = StandingCell::arrange(&setup, setup.subject.mesh());
        let mut aside = cell.rest_pose();
        aside.translation.x += 5.0;
        let SimulatedFrame { frame: seen, truth } = cell.frame(&aside, &setup.noise);
        assert_eq!(truth.subject, SimulatedObject::Nothing);
        assert!(!truth.labels.contains(&SurfaceLabel::Part));
        assert!(seen.depth.iter().any(|&depth| depth > 0));
        let mut half = cell.rest_pose();
        half.translation.x += 0.8;
        let truth = cell.frame(&half, &setup.noise).truth;
        assert_eq!(truth.subject, setup.subject);
        assert!(!truth.fully_visible && truth.visible_share < 0.9);
        // For this single frame the pixels are counted exactly.
        let cut = CellSetup {
            pose: crate::PartPose::Fixed(half),
            ..setup
        };
        let exact = frame(&cut).truth.visible_share;
        let off = (truth.visible_share - exact).abs();
        assert!(off < 0.02, "{} is {exact}", truth.visible_share);
    }
}
