//! Removes what was there in the empty cell.

use nalgebra::Point3;

use super::{PointLabel, SegmentParams};
use crate::scene::{EmptyCell, SceneCloud};
use geometry::{plane::Plane, units::Metres};

/// Minimum share of a plane's points that must be no nearer than the empty cell for the plane to belong to the cell.
const LEAST_KNOWN: f64 = 0.5;

impl EmptyCell {
    /// Returns true if a reading is no nearer than the empty cell at that pixel, within the tolerance.
    fn holds(&self, pixel: usize, z: f32, base: f32, noise: f32) -> bool {
        z > self.nearest(pixel) - base - noise * z * z
    }

    /// Returns true if a plane of the scene was there in the empty cell.
    pub(super) fn knows(
        &self,
        plane: &Plane,
        scene: &SceneCloud,
        noise_at_1m: Metres,
        params: &SegmentParams,
    ) -> bool {
        /// Step between the readings that are tested.
        const STEP: usize = 37;
        let (base, noise) = reach(noise_at_1m, params);
        let on_plane = scene.cloud.finite().step_by(STEP).filter(|(_, p)| {
            let off = plane.signed_distance(&p.cast()).abs();
            off < f64::from(base + noise * p.z * p.z)
        });
        let (mut num_known, mut num) = (0.0, 0.0_f64);
        for (i, p) in on_plane {
            num += 1.0;
            num_known += f64::from(u8::from(self.holds(i, p.z, base, noise)));
        }
        num_known >= LEAST_KNOWN * num
    }

    /// Labels the points that were there in the empty cell with `label`.
    pub(super) fn mark(
        &self,
        points: &[Point3<f32>],
        labels: &mut [PointLabel],
        label: PointLabel,
        noise_at_1m: Metres,
        params: &SegmentParams,
    ) {
        let (base, noise) = reach(noise_at_1m, params);
        for (i, (p, known)) in points.iter().zip(labels).enumerate() {
            if *known == PointLabel::Rest && self.holds(i, p.z, base, noise) {
                *known = label;
            }
        }
    }
}

/// Returns the tolerance for a reading nearer than the empty cell: a base and a noise term. Both captures are noisy.
fn reach(noise_at_1m: Metres, params: &SegmentParams) -> (f32, f32) {
    let noise = params.noise_factor * noise_at_1m.0 * std::f64::consts::SQRT_2;
    (params.plane_distance.0 as f32, noise as f32)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{scene::scene_from_frame, segment::segment};
    use simulate::{CellSetup, Clutter, PartKind, SensorNoise, Side, SurfaceLabel, frame};

    #[test]
    fn what_stood_in_the_empty_cell_is_not_the_part() {
        let mut setup = CellSetup::with_part(PartKind::Grille, Side::Left, 0, 4);
        setup.clutter = Clutter::OnFloor;
        let shot = frame(&setup);
        // The same cell without the part: pixels that showed the part have no reading.
        setup.noise = SensorNoise::kinect(99);
        let mut empty = frame(&setup);
        for (depth, label) in empty.frame.depth.iter_mut().zip(&empty.truth.labels) {
            if *label == SurfaceLabel::Part {
                *depth = 12_000;
            }
        }
        let mut scene = scene_from_frame(&shot.frame);
        let empty = EmptyCell::from_scene(&scene_from_frame(&empty.frame)).expect("a picture");
        scene.empty_cell = Some(Arc::new(empty));
        let found = segment(&scene, &SegmentParams::default());
        let num_clutter = found
            .labels
            .iter()
            .zip(&shot.truth.labels)
            .filter(|(found, truth)| {
                **truth == SurfaceLabel::Clutter
                    && matches!(found, PointLabel::Rest | PointLabel::Part)
            })
            .count();
        let num_cluttered = shot
            .truth
            .labels
            .iter()
            .filter(|l| **l == SurfaceLabel::Clutter);
        assert!(
            num_clutter * 50 < num_cluttered.count(),
            "{num_clutter} points of the clutter are left"
        );
        assert!(found.part.is_ok());
    }

    #[test]
    fn a_flat_part_that_fills_the_picture_is_no_wall_where_the_cell_is_known() {
        let scene_at = |z: u16| {
            let mut shot =
                frame(&CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 4)).frame;
            shot.depth.fill(z);
            scene_from_frame(&shot)
        };
        let mut scene = scene_at(6_000);
        let alone = segment(&scene, &SegmentParams::default());
        assert!(alone.part.is_err(), "without knowing the cell it is a wall");
        let empty = EmptyCell::from_scene(&scene_at(12_000)).expect("a picture");
        scene.empty_cell = Some(Arc::new(empty));
        let found = segment(&scene, &SegmentParams::default());
        assert_eq!(found.part.expect("a part").indices.len(), 640 * 480);
    }
}
