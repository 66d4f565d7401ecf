//! Pictures of the two likeliest parts at their poses, which show why one was nearly or wrongly taken for the other.

use image::{Rgb, RgbImage, imageops::replace};
use nalgebra::Point3;

use super::{
    canvas::Canvas,
    chart::DIM_TEXT,
    lettering::Anchor,
    pictures::{DARK, LIGHT, OPENING, PART, Picture},
};
use geometry::{depth_frame::Intrinsics, units::Metres};
use inspection::{library::Library, pipeline::Inspection};
use stages::{
    confirm::ConfirmedMatch, pose::PoseEstimate, reference::Reference, scene::SceneCloud,
};

/// Distance from which a point is shown as off, in addition to three standard deviations of the noise.
const OFF: Metres = Metres(0.01);
/// Pixels of the picture per pixel of the camera.
const SCALE: f64 = 2.0;
/// Margin around the part, camera pixels.
const MARGIN: f64 = 14.0;
/// Space above and below a panel, pixels.
const HEAD: f64 = 34.0;
/// Every how many reference points one is tested.
const STEP: usize = 3;
/// Minimum width of a panel, pixels: narrower ones have no room for the text.
const LEAST_WIDTH: f64 = 420.0;
/// Colour of points on the reference.
const ON: Rgb<u8> = Rgb([84, 92, 104]);

/// Draws the two likeliest parts of different names side by side, as the camera sees them: where the scene is off the
/// reference, and where the reference is missing in the scene. `None` without a camera, or without any pose.
pub fn runner_up_picture(
    scene: &SceneCloud,
    inspection: &Inspection,
    library: &Library,
) -> Option<Picture> {
    let camera = scene.intrinsics?;
    let view = View::around(scene, inspection, camera)?;
    let placed = inspection.ranking.by_part().filter_map(|entry| {
        let reference = library.references.get(entry.reference)?;
        Some(view.panel(entry, entry.pose.as_ref()?, reference))
    });
    let panels: Vec<RgbImage> = placed.take(2).collect();
    let width = panels.iter().map(RgbImage::width).sum::<u32>();
    let height = panels.first()?.height();
    let mut image = RgbImage::from_pixel(width, height, DARK);
    let mut left = 0;
    for panel in &panels {
        replace(&mut image, panel, i64::from(left), 0);
        left += panel.width();
    }
    Some(Picture {
        part: None,
        stage: "contenders",
        image,
    })
}

/// The region of the camera's picture that shows the part.
struct View<'a> {
    scene: &'a SceneCloud,
    /// Indices of the part's points in the scene.
    part: &'a [u32],
    noise_at_1m: f64,
    camera: Intrinsics,
    /// Upper left and lower right corner, camera pixels.
    corners: [[f64; 2]; 2],
}

impl<'a> View<'a> {
    fn around(
        scene: &'a SceneCloud,
        inspection: &'a Inspection,
        camera: Intrinsics,
    ) -> Option<Self> {
        let part = inspection.segmentation.part.as_ref().ok()?;
        let mut corners = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for p in &part.cloud.points {
            let (u, v) = camera.pixel_of(&p.cast())?;
            for (axis, x) in [u, v].into_iter().enumerate() {
                corners[0][axis] = corners[0][axis].min(x - MARGIN);
                corners[1][axis] = corners[1][axis].max(x + MARGIN);
            }
        }
        let is_some = corners.iter().flatten().all(|x| x.is_finite());
        is_some.then_some(Self {
            scene,
            part: &part.indices,
            noise_at_1m: part.noise_at_1m.0,
            camera,
            corners,
        })
    }

    fn place(&self, p: &Point3<f64>) -> Option<[f64; 2]> {
        let (u, v) = self.camera.pixel_of(p)?;
        let [from, to] = self.corners;
        let is_inside = u >= from[0] && v >= from[1] && u < to[0] && v < to[1];
        is_inside.then(|| [(u - from[0]) * SCALE, (v - from[1]) * SCALE + HEAD].map(f64::round))
    }

    /// Returns the distance from which a point at this depth counts as off, metres.
    fn tolerance(&self, depth: f64) -> f64 {
        OFF.0 + 3.0 * self.noise_at_1m * depth * depth
    }

    fn panel(
        &self,
        entry: &ConfirmedMatch,
        pose: &PoseEstimate,
        reference: &Reference,
    ) -> RgbImage {
        let [from, to] = self.corners;
        let size = [0, 1].map(|axis| (to[axis] - from[axis]) * SCALE);
        let (width, height) = (size[0].max(LEAST_WIDTH), size[1] + 2.0 * HEAD);
        let mut canvas = Canvas::new(width as usize, height as usize, DARK);
        let (num_off, num_part) = self.draw_part(&mut canvas, pose, reference);
        let (num_missing, num_looked_for) = self.draw_missing(&mut canvas, pose, reference);
        let percent = |num: usize, of: usize| 100.0 * num as f64 / of.max(1) as f64;
        let title = format!("{} {:.3}", entry.part, entry.score);
        let at = [8.0, HEAD - 12.0];
        canvas.write(&title, 16.0, at, Anchor::Left, LIGHT);
        let words = format!(
            "dots: {:.1} % of the scene off it · crosses: {:.1} % of it missing",
            percent(num_off, num_part),
            percent(num_missing, num_looked_for)
        );
        let at = [8.0, height - 12.0];
        canvas.write(&words, 13.0, at, Anchor::Left, DIM_TEXT);
        canvas.finish()
    }

    /// Draws the part's points. Returns how many are off the reference, and how many there are.
    fn draw_part(
        &self,
        canvas: &mut Canvas,
        pose: &PoseEstimate,
        reference: &Reference,
    ) -> (usize, usize) {
        let part_from_camera = pose.target_from_source.cast::<f32>();
        let field = reference.field();
        let mut num_off = 0;
        for index in self.part {
            let Some(p) = self.scene.cloud.points.get(*index as usize) else {
                continue;
            };
            let nearest = field.nearest(&(part_from_camera * p));
            let off = nearest.map_or(f64::INFINITY, |n| f64::from(n.distance_sq).sqrt());
            let is_off = off > self.tolerance(f64::from(p.z));
            num_off += usize::from(is_off);
            if let Some(at) = self.place(&p.cast()) {
                canvas.dot(at, 1.25, if is_off { PART } else { ON });
            }
        }
        (num_off, self.part.len())
    }

    /// Draws the reference points that are missing in the scene. Returns how many are missing, and how many were
    /// tested.
    fn draw_missing(
        &self,
        canvas: &mut Canvas,
        pose: &PoseEstimate,
        reference: &Reference,
    ) -> (usize, usize) {
        let camera_from_part = pose.camera_from_part();
        let (mut num_missing, mut num_looked_for) = (0, 0);
        for p in reference.cloud.points.iter().step_by(STEP) {
            let p = camera_from_part * p.cast::<f64>();
            let Some(seen) = self.depth_at(&p) else {
                continue;
            };
            num_looked_for += 1;
            if seen > p.z + 2.0 * self.tolerance(p.z) {
                num_missing += 1;
                if let Some([u, v]) = self.place(&p) {
                    canvas.line([u - 2.0, v], [u + 2.0, v], OPENING);
                    canvas.line([u, v - 2.0], [u, v + 2.0], OPENING);
                }
            }
        }
        (num_missing, num_looked_for)
    }

    /// Returns the depth that the camera reads in the direction of a point.
    fn depth_at(&self, p: &Point3<f64>) -> Option<f64> {
        let (u, v) = self.camera.pixel_of(p)?;
        let (u, v) = (u.round(), v.round());
        let (width, height) = (self.camera.width, self.camera.height);
        let is_inside = u >= 0.0 && v >= 0.0 && u < width as f64 && v < height as f64;
        let index = is_inside.then(|| v as usize * width + u as usize)?;
        let depth = f64::from(self.scene.cloud.points.get(index)?.z);
        depth.is_finite().then_some(depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::{
        library::{EnrolParams, enrol_standard_parts},
        pipeline::{Recipe, Unwatched, run},
    };
    use simulate::{CellSetup, PartKind, Side};
    use stages::fixtures::scene_of;

    #[test]
    fn the_part_that_hangs_there_is_hardly_off_and_the_other_one_is() {
        let library = enrol_standard_parts(&EnrolParams::default()).expect("eight parts");
        let setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 3);
        let scene = scene_of(&setup);
        let inspection =
            run(&scene, &library, &Recipe::default(), &Unwatched).expect("not cancelled");
        let picture = runner_up_picture(&scene, &inspection, &library).expect("two contenders");
        let half = picture.image.width() / 2;
        let num = |is_left: bool| {
            let marks = picture.image.enumerate_pixels();
            let is_mark = |p: &Rgb<u8>| *p == PART || *p == OPENING;
            marks
                .filter(|(u, _, p)| (*u < half) == is_left && is_mark(p))
                .count()
        };
        assert!(num(true) * 4 < num(false), "{} {}", num(true), num(false));
        let empty = scene_of(&CellSetup::new(simulate::SimulatedObject::Nothing, 3));
        let inspection =
            run(&empty, &library, &Recipe::default(), &Unwatched).expect("not cancelled");
        assert!(runner_up_picture(&empty, &inspection, &library).is_none());
    }
}
