//! Obstacles for gun and arm: the part, boxes of the cell, its floor, and the arm itself.
//!
//! Upper arm, forearm, wrist and gun are capsules: all points within a radius of a straight segment. The part is its
//! enrolled points, each standing for the surface around it up to the points' spacing. Boxes and floor stay in place in
//! the robot's base frame:
//!
//! ```toml
//! floor_mm = -600                  # height of the floor; none without it
//! [[box]]
//! name = "hanger"
//! centre_mm = [1200, 0, 1900]
//! size_mm = [1500, 100, 100]
//! angles_deg = [0, 0, 30]          # about x, y and z of the base, R = Rz·Ry·Rx; 0 without them
//! ```
//!
//! The gun must stay clear of the upper arm, the forearm and the base column of the arm itself, the wrist of the upper
//! arm and the column, and the forearm of the column. The column reaches from the foot to the height of joint 2; its
//! radius is that of the upper arm, or the distance of joint 2 from joint 1 if larger. Bodies that share a joint are
//! not compared: wrist and forearm, forearm and upper arm, upper arm and column. The gun begins at the end of a short
//! wrist, so near the middle of the wrist it is always near the forearm. The parts of both that are there, within the
//! radii and the clearance, are ignored: a gun ahead of the wrist is clear, one folded back along the forearm is not.
//!
//! Known limits: only the limits of joint 5 keep wrist and forearm apart. Hoses, cables, counterweights and anything
//! that the arm carries besides the gun are not modelled. Part, boxes and floor are not compared with the base column,
//! which stands still or runs along its rail. The side of the part that was not enrolled is missing, and so is a stand
//! or a wall without a box.

use std::{path::Path, sync::Arc};

use nalgebra::{Point3, Translation3, Vector3};
use serde::{Deserialize, Serialize};

use super::ArmError;
use files::{file_name, read_text};
use geometry::{
    cloud::PointCloud,
    nearest::{KdTree, median_spacing},
    oriented_box::{MAX_COORDINATE_MM, OrientedBox},
    rigid::RigidTransform,
    segment::Segment,
};

/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 1 << 20;
/// Most boxes: a candidate may be tested against all of them, and no cell has as many.
const MAX_BOXES: usize = 200;
/// Most letters of a box's name.
const MAX_NAME: usize = 60;

/// A body of gun or arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// From the flange to the nozzle's mouth.
    Gun,
    /// From the middle of the wrist to the flange.
    Wrist,
    /// From joint 3 to the middle of the wrist.
    Forearm,
    /// From joint 2 to joint 3.
    UpperArm,
}

/// An obstacle.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(tag = "obstacle", content = "name", rename_all = "snake_case")]
pub enum Obstacle {
    /// The part to be painted.
    Part,
    /// Another part that hangs there.
    OtherPart,
    /// The floor of the cell.
    Floor,
    /// A box of the cell, by name.
    Box(String),
    /// The upper arm, from joint 2 to joint 3.
    UpperArm,
    /// The forearm, from joint 3 to the middle of the wrist.
    Forearm,
    /// The base column, from the foot upwards around joint 1.
    BaseColumn,
}

/// The room between body and obstacle less the clearance, metres, below 0, and the two.
pub(super) type Nearness = (f64, Body, Obstacle);

/// All points within `radius` metres of the axis, in the frame of the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Capsule {
    pub(super) body: Body,
    pub(super) axis: Segment,
    pub(super) radius: f64,
}

/// Obstacles for gun and arm, in the frame of the path.
#[derive(Clone, Debug)]
pub struct Obstacles {
    /// Least distance from an obstacle, metres, 0..1.
    pub clearance: f64,
    boxes: Vec<CellBox>,
    /// Height of the floor, metres.
    pub(super) floor: Option<f64>,
    /// Name of the file of boxes and floor.
    file: Option<String>,
    part: Option<Arc<PartPoints>>,
    others: Vec<Arc<PartPoints>>,
}

#[derive(Clone, Debug)]
struct CellBox {
    name: String,
    region: OrientedBox,
    /// Its inverse transform and half its sides, which every test needs.
    box_from_robot: RigidTransform,
    half: Vector3<f64>,
}

/// The points of the part, relative to the middle of their bounding box.
#[derive(Debug)]
struct PartPoints {
    tree: KdTree,
    half: Vector3<f64>,
    spacing: f64,
    middle_from_robot: RigidTransform,
}

/// Content of the file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Text {
    floor_mm: Option<f64>,
    #[serde(default, rename = "box")]
    boxes: Vec<BoxText>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct BoxText {
    name: String,
    centre_mm: [f64; 3],
    size_mm: [f64; 3],
    #[serde(default)]
    angles_deg: [f64; 3],
}

impl Default for Obstacles {
    /// No obstacles, with a clearance of 20 mm.
    fn default() -> Self {
        Self {
            clearance: 0.02,
            boxes: Vec::new(),
            floor: None,
            file: None,
            part: None,
            others: Vec::new(),
        }
    }
}

impl Obstacles {
    /// Reads the boxes of a cell and its floor from a TOML file.
    pub fn read(path: &Path) -> Result<Self, ArmError> {
        let wrong = |message: String| ArmError::Obstacles {
            path: path.to_owned(),
            message,
        };
        let text: Text = toml::from_str(&read_text(path, MAX_BYTES)?)
            .map_err(|error| wrong(error.message().to_owned()))?;
        if text.boxes.len() > MAX_BOXES {
            let num = text.boxes.len();
            return Err(wrong(format!("{num} boxes, expected at most {MAX_BOXES}")));
        }
        if text.boxes.is_empty() && text.floor_mm.is_none() {
            return Err(wrong("neither a box nor a floor".into()));
        }
        if let Some(floor) = text.floor_mm
            && !(floor.abs() <= MAX_COORDINATE_MM)
        {
            return Err(wrong(format!("floor_mm is {floor}")));
        }
        let boxes = text.boxes.into_iter().enumerate().map(|(i, text)| {
            text.checked()
                .map_err(|message| wrong(format!("box {}: {message}", i + 1)))
        });
        Ok(Self {
            boxes: boxes.collect::<Result<_, _>>()?,
            floor: text.floor_mm.map(|floor| floor / 1000.0),
            file: Some(file_name(path)),
            ..Self::default()
        })
    }

    /// Name of the file that its boxes and its floor were read from; `None` without one.
    pub fn file(&self) -> Option<&str> {
        self.file.as_deref()
    }

    /// Adds a part by its points in the part's frame; points that are not finite are ignored.
    #[must_use]
    pub fn with_part(self, points: &[Point3<f32>], robot_from_part: &RigidTransform) -> Self {
        Self {
            part: PartPoints::new(points, robot_from_part).map(Arc::new),
            ..self
        }
    }

    /// Adds what else hangs there, by its points in the camera's frame; points that are not finite are ignored.
    #[must_use]
    pub fn with_other_part(
        mut self,
        points: &[Point3<f32>],
        robot_from_camera: &RigidTransform,
    ) -> Self {
        let other = PartPoints::new(points, robot_from_camera);
        self.others.extend(other.map(Arc::new));
        self
    }

    /// The corners of each box; two are joined by an edge if their indices differ in one bit.
    pub fn boxes(&self) -> impl Iterator<Item = [Point3<f64>; 8]> {
        self.boxes.iter().map(|one| one.region.corners())
    }

    /// The obstacle that a tool is nearest to, if it is nearer than the clearance. The tool fills `radius` metres around its
    /// axis, in the frame of the path.
    pub fn nearest_to_tool(&self, axis: &Segment, radius: f64) -> Option<Obstacle> {
        let tool = Capsule {
            body: Body::Gun,
            axis: *axis,
            radius,
        };
        worst(self.pairs(&[tool])).map(|(_, obstacle)| obstacle)
    }

    /// All pairs of these bodies and obstacles of the cell that are too near.
    pub(super) fn pairs(&self, bodies: &[Capsule]) -> impl Iterator<Item = Nearness> {
        bodies.iter().flat_map(move |capsule| {
            let Capsule { body, axis, radius } = *capsule;
            let within = radius + self.clearance;
            let part = self.part.iter().map(|part| (part, Obstacle::Part));
            let others = self.others.iter().map(|part| (part, Obstacle::OtherPart));
            let parts = part.chain(others).filter_map(move |(part, obstacle)| {
                let distance = part.distance(&axis, within)?;
                Some((distance - within, body, obstacle))
            });
            parts.chain(self.pairs_besides_part(*capsule))
        })
    }

    /// Whether one of these bodies is too near to an obstacle of the cell; faster than [`Self::pairs`], which finds the
    /// distances.
    pub(super) fn are_hit_by(&self, bodies: &[Capsule]) -> bool {
        bodies.iter().any(|capsule| {
            let within = capsule.radius + self.clearance;
            let mut parts = self.part.iter().chain(&self.others);
            parts.any(|part| part.is_near(&capsule.axis, within))
                || self.pairs_besides_part(*capsule).next().is_some()
        })
    }

    fn pairs_besides_part(&self, capsule: Capsule) -> impl Iterator<Item = Nearness> {
        let Capsule { body, axis, radius } = capsule;
        let within = radius + self.clearance;
        let floor = self.floor.iter().filter_map(move |floor| {
            let room = axis.from.z.min(axis.to.z) - floor - within;
            (room < 0.0).then_some((room, body, Obstacle::Floor))
        });
        let boxes = self.boxes.iter().filter_map(move |one| {
            let distance = one.distance(&axis, within)?;
            Some((distance - within, body, Obstacle::Box(one.name.clone())))
        });
        floor.chain(boxes)
    }

    /// All pairs of the arm's bodies, and of these and the base column, given by its axis and radius, that are too
    /// near. `bodies` are gun, wrist, forearm, its step behind the elbow, and upper arm.
    pub(super) fn pairs_of_arm(
        &self,
        bodies: &[Capsule; 5],
        column: (Segment, f64),
    ) -> impl Iterator<Item = Nearness> {
        let [gun, wrist, forearm, step, upper_arm] = *bodies;
        let arm = (upper_arm.axis, upper_arm.radius);
        let clearance = self.clearance;
        let pairs = [
            (gun, Obstacle::BaseColumn, column),
            (wrist, Obstacle::BaseColumn, column),
            (forearm, Obstacle::BaseColumn, column),
            (step, Obstacle::BaseColumn, column),
            (gun, Obstacle::UpperArm, arm),
            (wrist, Obstacle::UpperArm, arm),
        ];
        let pairs = pairs.into_iter().filter_map(move |(one, obstacle, other)| {
            let room = room(&one.axis, &other.0, one.radius + other.1 + clearance)?;
            Some((room, one.body, obstacle))
        });
        let at_forearm = [forearm, step].into_iter().filter_map(move |one| {
            let within = gun.radius + one.radius + clearance;
            let middle = wrist.axis.from;
            let gun_axis = gun.axis.beyond(&middle, within)?;
            let axis = one.axis.reversed().beyond(&middle, within)?;
            Some((room(&gun_axis, &axis, within)?, gun.body, Obstacle::Forearm))
        });
        pairs.chain(at_forearm)
    }
}

/// Distance of two axes less `within`, metres, if below 0.
fn room(axis: &Segment, other: &Segment, within: f64) -> Option<f64> {
    let room = axis.distance_to_segment(other) - within;
    (room < 0.0).then_some(room)
}

/// The pair with the least room; independent of the pairs' order.
pub(super) fn worst(pairs: impl Iterator<Item = Nearness>) -> Option<(Body, Obstacle)> {
    let worst = pairs.min_by(|a, b| {
        let room = a.0.total_cmp(&b.0);
        room.then_with(|| (a.1, &a.2).cmp(&(b.1, &b.2)))
    });
    worst.map(|(_, body, obstacle)| (body, obstacle))
}

impl BoxText {
    fn checked(self) -> Result<CellBox, String> {
        let name = self.name.trim();
        let is_name = !name.is_empty() && !name.contains(char::is_control);
        if !is_name || name.chars().count() > MAX_NAME {
            return Err(format!("its name has not 1 to {MAX_NAME} letters"));
        }
        let region = OrientedBox::of_file(name, self.centre_mm, self.size_mm, self.angles_deg)
            .map_err(|error| error.to_string())?;
        Ok(CellBox {
            name: name.to_owned(),
            region,
            box_from_robot: region.box_from_frame(),
            half: region.half(),
        })
    }
}

impl CellBox {
    /// Distance of a segment from its surface, if below `within`; 0 inside.
    fn distance(&self, axis: &Segment, within: f64) -> Option<f64> {
        let axis = axis.moved(&self.box_from_robot);
        // Skip if the spheres around both are apart: most boxes of a cell are far from most bodies.
        let middle = nalgebra::center(&axis.from, &axis.to).coords.norm();
        if middle - self.half.norm() - axis.length() / 2.0 >= within {
            return None;
        }
        let distance = axis.distance_to_box(&self.half);
        (distance < within).then_some(distance)
    }
}

impl PartPoints {
    fn new(points: &[Point3<f32>], robot_from_part: &RigidTransform) -> Option<Self> {
        let cloud = PointCloud::from_points(points.iter().copied());
        let (low, high) = cloud.bounds()?;
        let middle = nalgebra::center(&low, &high);
        let about_middle: Vec<Point3<f32>> =
            cloud.points.iter().map(|p| p - middle.coords).collect();
        let tree = KdTree::new(&about_middle);
        let part_from_middle = Translation3::from(middle.coords.cast::<f64>());
        Some(Self {
            spacing: median_spacing(&about_middle, &tree),
            tree,
            half: (high - low).cast::<f64>() / 2.0,
            middle_from_robot: (robot_from_part * part_from_middle).inverse(),
        })
    }

    /// Distance of a segment from its surface, if below `within`: that from the nearest point less the points' spacing.
    fn distance(&self, axis: &Segment, within: f64) -> Option<f64> {
        let axis = axis.moved(&self.middle_from_robot);
        let within = within + self.spacing;
        // Outside of the box around all points no search is needed.
        if axis.distance_to_box(&self.half) >= within {
            return None;
        }
        let distance = axis.distance_to_cloud(&self.tree, within)?;
        Some(distance - self.spacing)
    }

    /// Whether the distance is below `within`. The outer end of gun or arm, where its axis ends, is usually the nearest
    /// to the part: testing it first saves the search along the axis.
    fn is_near(&self, axis: &Segment, within: f64) -> bool {
        let end = Segment {
            from: axis.to,
            to: axis.to,
        };
        self.distance(&end, within).is_some() || self.distance(axis, within).is_some()
    }
}

#[cfg(test)]
mod tests;
