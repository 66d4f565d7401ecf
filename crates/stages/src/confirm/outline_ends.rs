//! Where the outline is the part's own, and where only the view of it ends.
//!
//! A part behind a plank, or half out of the picture, has an outline that is partly the plank's or the picture's. Such
//! points say nothing about the part. Each outline point is followed outwards in the picture: to the picture's edge,
//! to something nearer (it hides the part), or to something farther (the part ends there). Pixels without a reading
//! are passed over, because a structured-light sensor has none in the shadow of what is nearer. If the gap is wider than a
//! surface may span and the next reading is about as far away, the end of the part was not seen: a glossy strip or tape may
//! cut it in two.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::Scene;
use crate::{contour::lift_oriented, segment::BRIDGED_PIXELS};
use geometry::cloud::is_finite;

/// How far outwards a reading is looked for, pixels: a shadow beside something half a metre nearer is 15 wide.
const WALK: i64 = 32;
/// Pixels along the border of the field of view without readings.
const MARGIN: i64 = 4;
/// An outline that ends so many pixels before that edge ends at it.
const AT_EDGE: i64 = 4;
/// What hides is nearer than the part by at least this, metres, plus the noise.
const STEP_NEARER_M: f64 = 0.04;
/// Outline points on either side that fix the outwards direction.
const TANGENT: usize = 4;

/// The outline of a scene's part, in plane space.
pub(super) struct Outline {
    /// Points where the part ends, openings included.
    pub(super) own: Vec<Point3<f64>>,
    /// Unit vectors along the border at each of them, the surface to their left.
    pub(super) along: Vec<Vector3<f64>>,
    /// Share of the outline where only the view ends, 0..1.
    pub(super) cut_share: f64,
}

/// Sorts the outline's points; without a camera all count as the part's own.
pub(super) fn outline_of(scene: &Scene<'_>) -> Outline {
    let query = &scene.query;
    let outline = &query.contour.outline;
    let camera_from_plane = query.plane.plane_from_camera.inverse();
    let (mut num_cut, mut num) = (0.0_f64, 0.0_f64);
    let n = outline.len();
    let is_part = PartMask::new(scene);
    let mut own: Vec<(Point3<f64>, Vector3<f64>)> = Vec::with_capacity(n);
    let mut borders = query.contour.borders();
    let lifted = borders.next().map_or_else(Vec::new, lift_oriented);
    for (i, oriented) in lifted.into_iter().enumerate() {
        let Some((lifted, along)) = oriented else {
            continue;
        };
        num += 1.0;
        let (before, after) = (
            outline[(i + n - TANGENT % n.max(1)) % n],
            outline[(i + TANGENT) % n],
        );
        // The outline runs counter-clockwise: outwards is to the right.
        let beside: Vector2<f64> = after - before;
        let outwards = Vector2::new(beside.y, -beside.x);
        let is_cut = is_part.as_ref().is_some_and(|mask| {
            mask.is_cut(&(camera_from_plane * lifted), || {
                let out = outwards.try_normalize(1e-9)? * 0.02;
                Some(camera_from_plane * (lifted + Vector3::new(out.x, out.y, 0.0)))
            })
        });
        if is_cut {
            num_cut += 1.0;
        } else {
            own.push((lifted, along));
        }
    }
    for opening in borders {
        own.extend(lift_oriented(opening).into_iter().flatten());
    }
    let (own, along) = own.into_iter().unzip();
    Outline {
        own,
        along,
        cut_share: num_cut / num.max(1.0),
    }
}

/// Which pixels show the part, and which the stand that was taken off it.
struct PartMask<'a> {
    scene: &'a Scene<'a>,
    camera: geometry::depth_frame::Intrinsics,
    is_part: Vec<bool>,
    is_stand: Vec<bool>,
}

impl<'a> PartMask<'a> {
    fn new(scene: &'a Scene<'a>) -> Option<Self> {
        let camera = scene.scene.intrinsics?;
        scene.scene.cloud.grid?;
        let mark = |indices: &[u32]| {
            let mut is_marked = vec![false; scene.scene.cloud.points.len()];
            for &i in indices {
                *is_marked.get_mut(i as usize)? = true;
            }
            Some(is_marked)
        };
        Some(Self {
            scene,
            camera,
            is_part: mark(&scene.part.indices)?,
            is_stand: mark(&scene.part.stand)?,
        })
    }

    fn is_cut(&self, at: &Point3<f64>, outwards: impl FnOnce() -> Option<Point3<f64>>) -> bool {
        let camera = &self.camera;
        let pixels = camera
            .pixel_of(at)
            .zip(outwards().and_then(|p| camera.pixel_of(&p)));
        let Some((from, towards)) = pixels else {
            return false;
        };
        let (from, towards) = (
            Point2::from(<[f64; 2]>::from(from)),
            <[f64; 2]>::from(towards),
        );
        let Some(step) = (Point2::from(towards) - from).try_normalize(1e-6) else {
            return false;
        };
        let noise = 3.0 * self.scene.part.noise_at_1m.0 * at.z * at.z;
        let width = camera.width as i64;
        let view = self.scene.scene.field_of_view();
        let is_inside = |u: i64, v: i64| match view {
            Some(view) => {
                view.contains(u - MARGIN, v)
                    && view.contains(u + MARGIN, v)
                    && view.contains(u, v - MARGIN)
                    && view.contains(u, v + MARGIN)
            }
            None => u >= 0 && v >= 0 && u < width && v < camera.height as i64,
        };
        // Where registered depth ends, a near surface ends further inside than a far one.
        let at_edge = match view {
            Some(view) if view.is_inner() => WALK,
            _ => AT_EDGE,
        };
        let points = &self.scene.scene.cloud.points;
        let mut num_without_reading = 0;
        for walked in 1..=WALK {
            let p = from + step * walked as f64;
            let (u, v) = (p.x.round() as i64, p.y.round() as i64);
            if !is_inside(u, v) {
                // Further out there is the wall, or its shadow.
                return walked <= at_edge && view.is_some();
            }
            let i = (v * width + u) as usize;
            if !is_finite(&points[i]) {
                num_without_reading += 1;
            } else if !self.is_part[i] {
                let beyond = f64::from(points[i].z) - at.z;
                let reach = STEP_NEARER_M + noise;
                // The end is not seen either where a stand was removed from the part.
                let may_go_on = self.is_stand[i] || num_without_reading > BRIDGED_PIXELS;
                return beyond < if may_go_on { reach } else { -reach };
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        contour::{ContourParams, find_contour},
        fixtures::scene_of,
        project::{ProjectParams, project},
        rack::Rack,
        rank::Query,
        segment::{SegmentParams, segment},
        signature::{SignatureParams, describe},
    };
    use simulate::{CellSetup, Clutter, PartKind, PoseRange, Side};

    fn cut_share(clutter: Clutter) -> f64 {
        let mut setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 12);
        setup.pose = simulate::PartPose::Drawn(PoseRange {
            nearest: geometry::units::Metres(1.5),
            ..PoseRange::facing()
        });
        setup.clutter = clutter;
        let scene = scene_of(&setup);
        let part = segment(&scene, &SegmentParams::default()).part;
        let part = part.expect("a part");
        let plane = project(&part, &ProjectParams::default()).expect("a plane");
        let contour = find_contour(&plane, &ContourParams::default()).expect("an outline");
        let signature = describe(&contour, &SignatureParams::default()).expect("rays");
        let query = Query {
            plane: &plane,
            contour: &contour,
            signature: &signature,
        };
        let scene = Scene {
            scene: &scene,
            part: &part,
            query,
            rack: Rack::ANYWHERE,
            expected: &[],
        };
        outline_of(&scene).cut_share
    }

    #[test]
    fn a_plank_cuts_the_outline_and_things_behind_do_not() {
        assert!(cut_share(Clutter::None) < 0.01);
        assert!(cut_share(Clutter::OnFloor) < 0.01);
        assert!(cut_share(Clutter::InFront) > 0.08);
    }
}
