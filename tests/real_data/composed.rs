//! Two parts in one real frame: what a frame of the booth shows of its part, put into another one beside its own.
//!
//! The part is moved away from the camera and aside, and projected again; of two readings at one pixel, the nearer one counts.
//! So both parts are as the camera saw them, but the one that was moved casts no shadow, and its noise is that of nearer
//! readings.

use nalgebra::{Point3, Translation3, Vector3};
use partsight::{
    files::{FileContent, open},
    geometry::{
        depth_frame::DepthFrame,
        parallel::{map_each, num_cores},
        rigid::{RigidTransform, pose_error},
    },
    pipeline::{Inspection, Recipe, Unwatched, run_all},
    stages::{pose::PoseEstimate, scene::scene_from_frame},
};

use super::booth::Booth;

/// A frame whose part is accepted.
struct Shown {
    file: String,
    /// Name of the part in the library.
    part: String,
    frame: DepthFrame,
    /// The readings of the part, metres, camera space.
    points: Vec<Point3<f64>>,
    /// Of the points, those at the end of the readings, beyond which the part may go on.
    cut: Vec<Point3<f64>>,
    /// True where the camera has readings: between the first and the last one of a row.
    view: Vec<bool>,
    camera_from_part: RigidTransform,
}

/// Distance from the end of the readings up to which a part counts as cut, pixels.
const CUT_PIXELS: usize = 4;

impl Shown {
    /// Reads a frame; `None` if its part is not accepted.
    fn read(booth: &Booth, file: &str) -> Option<Self> {
        let (scene, found) = &booth.inspected[file];
        if !found.verdict.is_accepted() {
            return None;
        }
        let Ok(FileContent::Depth(frame)) = open(&booth.folder.join(file)) else {
            panic!("{file}: no depth image");
        };
        let width = frame.intrinsics.width;
        let mut view = vec![false; frame.depth.len()];
        for (readings, view) in frame.depth.chunks(width).zip(view.chunks_mut(width)) {
            let first = readings.iter().position(|depth| *depth > 0);
            let last = readings.iter().rposition(|depth| *depth > 0);
            if let Some((first, last)) = first.zip(last) {
                view[first..=last].fill(true);
            }
        }
        let is_inside = |i: usize, by: usize| {
            let up_and_down = [i.checked_sub(by * width), Some(i + by * width)];
            let mut around = up_and_down
                .into_iter()
                .chain([i.checked_sub(by), Some(i + by)]);
            around.all(|i| i.is_some_and(|i| view.get(i) == Some(&true)))
        };
        let part = found.segmentation.part.as_ref().expect("a part");
        let point = |i: &u32| scene.cloud.points[*i as usize].cast();
        let is_cut = |i: &&u32| !is_inside(**i as usize, CUT_PIXELS);
        Some(Self {
            file: file.to_owned(),
            part: format!("booth_{}", booth.truth.frames[file].part),
            points: part.indices.iter().map(point).collect(),
            cut: part.indices.iter().filter(is_cut).map(point).collect(),
            view,
            camera_from_part: booth.truth.camera_from_part(file),
            frame,
        })
    }

    /// The depth unit at a pixel of this frame, and its index, at which a point is seen.
    fn reading(&self, point: &Point3<f64>) -> Option<(usize, u16)> {
        let camera = &self.frame.intrinsics;
        let (u, v) = camera.pixel_of(point)?;
        let (u, v) = (u.round(), v.round());
        let is_inside = u >= 0.0 && v >= 0.0 && u < camera.width as f64 && v < camera.height as f64;
        let depth = (point.z / self.frame.metres_per_unit).round() as u16;
        is_inside.then(|| (v as usize * camera.width + u as usize, depth))
    }

    /// Puts the moved part of another frame into this one; `None` if less than [`LEAST_IN_SIGHT`] of either part is then in
    /// sight, if the other part ends where its frame ended, or if it is not clear of all that is behind it.
    fn with(&self, other: &Self, shift: Vector3<f64>) -> Option<DepthFrame> {
        let in_view = |point: &Point3<f64>| {
            let reading = self.reading(&(point + shift));
            reading.filter(|(pixel, _)| self.view[*pixel])
        };
        let num_cut_in_view = other.cut.iter().filter_map(in_view).count();
        let num_cut_allowed = other.cut.len() as f64 * (1.0 - LEAST_CUT_OUT_OF_VIEW);
        if num_cut_in_view as f64 > num_cut_allowed {
            return None;
        }
        let unit = self.frame.metres_per_unit;
        let mut frame = self.frame.clone();
        let (mut num_in_sight, mut num_touching) = (0, 0);
        for (pixel, depth) in other.points.iter().filter_map(in_view) {
            let behind = self.frame.depth[pixel];
            if behind > 0 && f64::from(behind.abs_diff(depth)) * unit < CLEAR_DEPTH {
                num_touching += 1;
            }
            if behind == 0 || depth < behind {
                num_in_sight += 1;
                let nearest = &mut frame.depth[pixel];
                if *nearest == 0 || depth < *nearest {
                    *nearest = depth;
                }
            }
        }
        let num_all = other.points.len() as f64;
        let is_unhidden = |point: &&Point3<f64>| {
            let reading = self.reading(point);
            reading.is_some_and(|(pixel, _)| frame.depth[pixel] == self.frame.depth[pixel])
        };
        let num_own = self.points.iter().filter(is_unhidden).count();
        let is_enough = f64::from(num_in_sight) >= LEAST_IN_SIGHT * num_all
            && num_own as f64 >= LEAST_IN_SIGHT * self.points.len() as f64
            && f64::from(num_touching) <= MOST_TOUCHING * num_all;
        is_enough.then_some(frame)
    }
}

/// Share of what a frame shows of its part that must be in sight in the composed one.
const LEAST_IN_SIGHT: f64 = 0.8;
/// Share of the points where a part is cut that must be out of view in the composed frame.
const LEAST_CUT_OUT_OF_VIEW: f64 = 0.98;
/// Distance along the optical axis between surfaces that do not touch, metres.
const CLEAR_DEPTH: f64 = 0.06;
/// Share of a part's points that may be nearer than that to what the frame shows at their pixels.
const MOST_TOUCHING: f64 = 0.01;

/// A frame, the frame whose part is put into it, and how far that is moved to the right, down and away, decimetres. Drawn at
/// random from all that [`Shown::with`] allows without moving the part further up or down than needed; only parts of which
/// their own frame shows 40 % or more are moved.
#[rustfmt::skip]
const PAIRS: [(&str, &str, [i32; 3]); 50] = [
    ("left2_00", "left2_02", [4, 2, 3]),
    ("left2_00", "left2_06", [4, -1, 6]),
    ("left2_00", "right2_04", [-4, -3, 6]),
    ("left2_00", "right2_05", [-4, -5, 6]),
    ("left2_01", "left2_02", [-4, 3, 2]),
    ("left2_01", "left2_04", [12, -1, 2]),
    ("left2_01", "left2_05", [9, -1, 2]),
    ("left2_01", "left2_06", [2, 6, 2]),
    ("left2_01", "right2_05", [-3, 0, 4]),
    ("left2_02", "left2_01", [-4, -2, 4]),
    ("left2_02", "left2_05", [8, -2, 4]),
    ("left2_03", "left2_02", [0, 3, 6]),
    ("left2_03", "left2_04", [9, -2, 4]),
    ("left2_03", "left2_05", [6, -3, 6]),
    ("left2_03", "left2_07", [2, 1, 2]),
    ("left2_04", "left2_00", [-2, 1, 2]),
    ("left2_04", "left2_05", [-2, -2, 3]),
    ("left2_04", "left2_07", [2, 0, 2]),
    ("left2_04", "right2_05", [-3, 3, 2]),
    ("left2_05", "left2_00", [-3, 0, 4]),
    ("left2_05", "left2_02", [-5, 2, 3]),
    ("left2_05", "left2_03", [-3, 2, 4]),
    ("left2_05", "right2_05", [-2, 3, 2]),
    ("left2_06", "left2_02", [-4, 2, 2]),
    ("left2_06", "left2_04", [0, -2, 3]),
    ("left2_06", "left2_07", [2, 0, 2]),
    ("left2_06", "right2_04", [-4, -3, 6]),
    ("left2_06", "right2_05", [-5, 0, 7]),
    ("left2_07", "left2_02", [-3, 2, 2]),
    ("left2_07", "left2_04", [7, -2, 4]),
    ("left2_07", "left2_05", [3, -2, 2]),
    ("left2_07", "left2_06", [3, -1, 3]),
    ("left2_07", "right2_04", [-2, -1, 2]),
    ("left2_07", "right2_05", [-4, 1, 5]),
    ("right2_04", "left2_04", [11, -2, 2]),
    ("right2_04", "left2_05", [8, -2, 3]),
    ("right2_04", "left2_07", [6, 0, 8]),
    ("right2_05", "left2_01", [-3, -3, 4]),
    ("right2_05", "left2_04", [12, -1, 2]),
    ("right2_05", "left2_05", [-2, -2, 3]),
    ("right2_05", "left2_06", [2, -2, 2]),
    ("right2_05", "left2_07", [5, 3, 7]),
    ("right2_06", "left2_00", [-6, 0, 9]),
    ("right2_06", "left2_01", [-3, -2, 2]),
    ("right2_06", "left2_02", [5, 2, 2]),
    ("right2_06", "left2_04", [8, -2, 2]),
    ("right2_06", "left2_05", [4, -1, 2]),
    ("right2_06", "left2_06", [3, 1, 3]),
    ("right2_06", "left2_07", [4, -1, 5]),
    ("right2_06", "right2_04", [-3, -2, 4]),
];

/// A part in a composed frame.
struct Hung<'a> {
    part: &'a str,
    camera_from_part: RigidTransform,
    found: Option<&'a Inspection>,
}

impl Hung<'_> {
    /// Turn and shift of a pose from the true one, degrees and millimetres.
    fn off(&self, pose: &PoseEstimate) -> [f64; 2] {
        let middle = Point3::new(0.0, 0.0, 1.2);
        let off = pose_error(&pose.camera_from_part(), &self.camera_from_part, &middle);
        [off.rotation.degrees(), off.shift.mm()]
    }
}

/// Finds the inspection of each part: an accepted one must be of the part that is nearest.
fn assign<'a>(parts: &mut [Hung<'a>; 2], found: &'a [Inspection], what: &str) {
    for inspection in found.iter().filter(|i| i.verdict.is_accepted()) {
        let pose = inspection.found_pose().expect("a pose");
        let [a, b] = parts.each_ref().map(|part| part.off(pose)[1]);
        let nearest = &mut parts[usize::from(b < a)];
        assert_eq!(inspection.verdict.guess(), Some(nearest.part), "{what}");
        assert!(nearest.found.is_none(), "{what}: {} twice", nearest.part);
        // The robot's poses are off by a few millimetres and about 0.3 degrees.
        let [turn, shift] = nearest.off(pose);
        assert!(
            turn < 1.0 && shift < 15.0,
            "{what}: {turn:.2}°, {shift:.1} mm"
        );
        nearest.found = Some(inspection);
    }
    for inspection in found.iter().filter(|i| !i.verdict.is_accepted()) {
        let name = inspection.verdict.guess();
        let is_named = inspection.verdict.is_named();
        let part = parts
            .iter_mut()
            .find(|part| part.found.is_none() && name == Some(part.part));
        if let Some(part) = part.filter(|_| is_named) {
            part.found = Some(inspection);
        }
    }
}

#[test]
fn both_parts_of_a_composed_frame_are_named_and_none_is_accepted_where_it_is_not() {
    let Some(booth) = Booth::read() else { return };
    let files = booth.inspected.keys();
    let shown: Vec<Shown> = files.filter_map(|file| Shown::read(booth, file)).collect();
    let shown_in = |name: &str| {
        let file = format!("{name}.png");
        let found = shown.iter().find(|shown| shown.file == file);
        found.unwrap_or_else(|| panic!("the part in {file} is not accepted"))
    };
    let mut recipe = Recipe::default();
    recipe.segment.max_parts = 2;
    let inspected = map_each(PAIRS.len(), num_cores(), |i| {
        let (into, of, decimetres) = PAIRS[i];
        let (into, of) = (shown_in(into), shown_in(of));
        let shift = Vector3::from(decimetres.map(f64::from)) * 0.1;
        let frame = into.with(of, shift);
        let frame = frame.unwrap_or_else(|| panic!("{:?} cannot be composed", PAIRS[i]));
        let scene = scene_from_frame(&frame);
        let found = run_all(&scene, &booth.library, &recipe, &Unwatched).expect("not cancelled");
        (into, of, shift, found)
    });
    let (mut num_named, mut num_accepted) = (0, 0);
    let mut misses = Vec::new();
    for (pair, (into, of, shift, found)) in PAIRS.iter().zip(&inspected) {
        let mut parts = [(into, Vector3::zeros()), (of, *shift)].map(|(shown, shift)| Hung {
            part: &shown.part,
            camera_from_part: Translation3::from(shift) * shown.camera_from_part,
            found: None,
        });
        assign(&mut parts, found, &format!("{pair:?}"));
        for part in parts {
            num_named += usize::from(part.found.is_some());
            let is_accepted = part.found.is_some_and(|found| found.verdict.is_accepted());
            num_accepted += usize::from(is_accepted);
            if !is_accepted {
                let why = part.found.and_then(|found| found.verdict.complaint());
                misses.push(format!("{pair:?}: {} {why:?}", part.part));
            }
        }
    }
    let misses = misses.join("\n");
    assert!(
        num_named >= 95 && num_accepted >= 75,
        "{num_named} named, {num_accepted} accepted of {}\n{misses}",
        2 * PAIRS.len()
    );
}
