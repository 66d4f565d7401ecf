//! Data drawn for a scan, prepared in the task: one row per shot, and the figure of the 3-D view.

use std::sync::Arc;

use glam::Vec3;
use image::{Rgb, RgbImage};
use nalgebra::Point3;

use super::scan_choice::ShotChoice;
use geometry::{
    cloud::is_finite,
    rigid::{PoseDelta, RigidTransform},
    units::Metres,
};
use stages::{
    scan::{
        Excluded, Scan, ScannedShot, Shot,
        unseen::{open_share, outline},
    },
    segment::PointLabel,
};
use ui::viewport::{Colouring, LineSet, PointSet, Role, ViewColours, furniture};

/// A shot in the list.
#[derive(Debug)]
pub struct ShotRow {
    /// Name of the frame.
    pub name: String,
    /// Depth picture with the part highlighted.
    pub picture: RgbImage,
    /// Whether and how it was used.
    pub fate: ShotFate,
    /// Number of the part's points that it sees.
    pub num_points: usize,
    /// Share of the part's points that it sees, 0..1.
    pub seen: f64,
    /// Share of the part's points that no other shot sees, 0..1.
    pub only: f64,
}

/// Whether and how a shot was used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShotFate {
    /// The shot is part of the result.
    Used {
        /// Correction of its pose by the refinement.
        moved: PoseDelta,
        /// Distance to what other shots see of the same surface, on the part if they overlap there; `None` if too few of its
        /// readings meet others.
        rms: Option<Metres>,
        /// False if segmentation found no part in it, or something that looks like background.
        has_part: bool,
    },
    /// The shot does not fit and was left out.
    Excluded(Excluded),
    /// The user dropped the shot.
    Dropped,
}

/// Makes one row per shot of the choice, in its order.
pub fn rows(choice: &ShotChoice, scan: &Scan) -> Vec<ShotRow> {
    let part: Vec<u64> = part_masks(scan).collect();
    let num_part = part.len().max(1) as f64;
    let mut scanned = scan.shots.iter().enumerate();
    let shots = choice.set.shots.iter().enumerate();
    let row = |(place, shot): (usize, &Shot)| {
        let known = if choice.dropped.contains(&place) {
            None
        } else {
            scanned.next()
        };
        let count = |is_counted: &dyn Fn(u64) -> bool| {
            part.iter().filter(|mask| is_counted(**mask)).count()
        };
        let bit = known.map_or(0, |(number, _)| 1_u64 << number);
        let num_points = count(&|mask| mask & bit != 0);
        ShotRow {
            name: shot.name.clone(),
            picture: picture(shot, known.map(|(_, shot)| shot)),
            fate: known.map_or(ShotFate::Dropped, |(_, shot)| fate(shot)),
            num_points,
            seen: num_points as f64 / num_part,
            only: count(&|mask| bit != 0 && mask == bit) as f64 / num_part,
        }
    };
    shots.map(row).collect()
}

fn fate(shot: &ScannedShot) -> ShotFate {
    match shot.excluded {
        Some(why) => ShotFate::Excluded(why),
        None => ShotFate::Used {
            moved: shot.moved,
            rms: shot.after_on_part.or(shot.after).map(|overlap| overlap.rms),
            has_part: shot.finds_part,
        },
    }
}

/// Returns for each point of the part a bit mask of the shots that see it.
fn part_masks(scan: &Scan) -> impl Iterator<Item = u64> {
    let points = scan.cloud.seen_by.iter().zip(&scan.cloud.is_part);
    points.filter(|(_, is)| **is).map(|(mask, _)| *mask)
}

/// Width and height of a shot's picture, pixels.
const PICTURE: [u32; 2] = [176, 132];

/// Draws the depths, nearer is brighter; highlights the part if the shot was segmented.
fn picture(shot: &Shot, scanned: Option<&ScannedShot>) -> RgbImage {
    let cloud = &shot.scene.cloud;
    let Some(grid) = cloud.grid else {
        return RgbImage::new(PICTURE[0], PICTURE[1]);
    };
    let depths = cloud.finite().map(|(_, point)| point.z);
    let (nearest, farthest) = depths.fold((f32::INFINITY, 0.0_f32), |(least, most), z| {
        (least.min(z), most.max(z))
    });
    let range = (farthest - nearest).max(1e-3);
    let colours = ViewColours::dark();
    let labels = scanned.map(|shot| shot.segmentation.labels.as_slice());
    RgbImage::from_fn(PICTURE[0], PICTURE[1], |u, v| {
        let column = u as usize * grid.width / PICTURE[0] as usize;
        let row = v as usize * grid.height / PICTURE[1] as usize;
        let place = row * grid.width + column;
        let point = cloud.points.get(place).filter(|point| is_finite(point));
        let Some(point) = point else {
            return Rgb([0; 3]);
        };
        let is_part = labels.and_then(|labels| labels.get(place)) == Some(&PointLabel::Part);
        let role = if is_part { Role::Part } else { Role::Rest };
        let nearness = 1.0 - (point.z - nearest) / range;
        let brightness = if is_part {
            0.7 + 0.3 * nearness
        } else {
            0.25 + 0.45 * nearness
        };
        let colour = colours.role(role).colour;
        let channel = |c: u8| (f32::from(c) * brightness).min(255.0) as u8;
        Rgb([colour.r(), colour.g(), colour.b()].map(channel))
    })
}

/// Data of the 3-D view of a scan, in the camera frame of the first used shot.
#[derive(Debug)]
pub struct ScanFigure {
    /// Transform from the robot's base to the frame of the view.
    pub camera_from_base: RigidTransform,
    /// All points, in the order of the scan's cloud.
    pub positions: Arc<[[f32; 3]]>,
    /// Part or background, per point.
    pub labels: Vec<PointLabel>,
    /// The camera of every shot that was not dropped.
    pub cameras: Vec<CameraFigure>,
    /// Per shot: the points of the part that only it sees, slightly in front of the surface.
    pub only: Vec<Option<PointSet>>,
    /// A band beyond the part's outline where no shot shows that the part ends.
    pub open_band: Option<PointSet>,
    /// Share of the outline where no shot shows that the part ends, 0..1.
    pub open_share: f64,
}

/// The camera of a shot.
#[derive(Debug)]
pub struct CameraFigure {
    /// Index of the shot.
    pub place: usize,
    /// Frustum of the camera.
    pub lines: LineSet,
    /// Centre of the camera.
    pub at: Vec3,
}

/// Offset of marked points from the surface, metres, so that they cover those beneath.
const BEFORE: f32 = 0.002;
/// Length of a drawn camera, metres.
const CAMERA: Metres = Metres(0.1);
/// Distances from the outline of the points of the band, metres.
const BAND: [f32; 5] = [0.006, 0.013, 0.02, 0.027, 0.034];
/// Offsets along the outline of the points of the band, metres, because the outline is thinned.
const ASIDE: [f32; 3] = [-0.007, 0.0, 0.007];

impl ScanFigure {
    pub fn of(choice: &ShotChoice, scan: &Scan) -> Self {
        let first = scan.used().next();
        let camera_from_base = first.map_or_else(RigidTransform::identity, |(_, shot)| {
            shot.base_from_camera.inverse()
        });
        let to_view = camera_from_base.cast::<f32>();
        let seen = |point: Point3<f32>| {
            let point = to_view * point;
            [point.x, point.y, point.z]
        };
        let cloud = &scan.cloud;
        let label = |is_part: &bool| {
            if *is_part {
                PointLabel::Part
            } else {
                PointLabel::Background(0)
            }
        };
        // Indices of the shots that were not dropped, in the scan's order.
        let places: Vec<usize> = (0..choice.set.shots.len())
            .filter(|place| !choice.dropped.contains(place))
            .collect();
        let mut only: Vec<Vec<[f32; 3]>> = vec![Vec::new(); choice.set.shots.len()];
        let normals = cloud.cloud.normals.as_deref().unwrap_or_default();
        for (index, mask) in cloud.seen_by.iter().enumerate() {
            if mask.is_power_of_two()
                && cloud.is_part[index]
                && let Some(place) = places.get(mask.trailing_zeros() as usize)
                && let Some(normal) = normals.get(index)
            {
                only[*place].push(seen(cloud.cloud.points[index] + normal * BEFORE));
            }
        }
        let outline = outline(scan);
        let open = outline.iter().filter(|point| point.is_open);
        let band = open.flat_map(|at| {
            ASIDE.map(|aside| BAND.map(|far| seen(at.point + at.outwards * far + at.along * aside)))
        });
        let band = band.flatten();
        let cameras = scan.shots.iter().zip(&places).filter_map(|(shot, place)| {
            let pose = camera_from_base * shot.base_from_camera;
            let intrinsics = shot.scene.intrinsics.as_ref()?;
            let at = pose.translation.vector.cast::<f32>();
            Some(CameraFigure {
                place: *place,
                lines: furniture::frustum(intrinsics, CAMERA).at(&pose),
                at: Vec3::new(at.x, at.y, at.z),
            })
        });
        Self {
            positions: cloud.cloud.points.iter().map(|p| seen(*p)).collect(),
            labels: cloud.is_part.iter().map(label).collect(),
            cameras: cameras.collect(),
            only: only
                .into_iter()
                .map(|points| marked(points, Role::SeenOnce))
                .collect(),
            open_share: open_share(&outline),
            open_band: marked(band.collect(), Role::Unseen),
            camera_from_base,
        }
    }
}

/// Makes points that keep the colour of their role whatever the view's colouring.
pub fn marked(points: Vec<[f32; 3]>, role: Role) -> Option<PointSet> {
    (!points.is_empty()).then(|| {
        let set = PointSet::new(points, role);
        set.coloured(Colouring::Segment).packed()
    })
}
