//! What gun and arm must not run into: the part, boxes of the cell, its floor, and the arm itself.
//!
//! Upper arm, forearm, wrist and gun are capsules: all points within a radius of a straight segment. The part is the points
//! that it was enrolled with, each standing for the surface up to their spacing around it. Boxes and floor stay where they
//! are in the robot's base frame:
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
//! Of the arm itself gun and wrist must not run into the upper arm, gun, wrist and forearm not into the base column, and the
//! gun not into the forearm. The column reaches from the foot up to the height of joint 2; its radius is that of the upper arm,
//! or the distance of joint 2 from joint 1 if that is more. Bodies that share a joint are not held against each other: wrist and
//! forearm, forearm and upper arm, upper arm and column. The gun begins at the end of a short wrist, so near the middle of the
//! wrist it is always near to the forearm. What of either lies there within the radii and the clearance does not count: a gun
//! ahead of the wrist is clear, one that is folded back along the forearm is not.
//!
//! Known limits: the limits of joint 5 have to keep wrist and forearm apart. Hoses, cables and what the arm carries besides the
//! gun are no bodies, nor are its counterweights. Part, boxes and floor are not held
//! against the base column, which stands still or runs along its rail. The side of the part that was not enrolled is not
//! there, and neither is a stand or a wall unless a box stands for it.

use std::{path::Path, sync::Arc};

use nalgebra::{Point3, Translation3, Vector3};
use serde::Deserialize;

use super::ArmError;
use crate::{
    files::read_text,
    geometry::{
        cloud::PointCloud,
        nearest::{KdTree, median_spacing},
        rigid::{RigidTransform, from_euler_zyx},
        segment::Segment,
    },
};

/// A larger file lists no boxes of a cell.
const MAX_BYTES: u64 = 1 << 20;
/// Every candidate may be tested against all boxes; no cell has as many.
const MAX_BOXES: usize = 200;
/// Letters of a box's name.
const MAX_NAME: usize = 60;
/// No cell is as large, millimetres.
const LARGEST: f64 = 100_000.0;

/// A body of gun or arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
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

impl Body {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gun => "gun",
            Self::Wrist => "wrist",
            Self::Forearm => "forearm",
            Self::UpperArm => "upper arm",
        }
    }
}

/// Something that is in the way.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Obstacle {
    /// The part that is painted.
    Part,
    /// The floor of the cell.
    Floor,
    /// A box of the cell, by its name.
    Box(String),
    /// The upper arm, from joint 2 to joint 3.
    UpperArm,
    /// The forearm, from joint 3 to the middle of the wrist.
    Forearm,
    /// The base column, from the foot up around joint 1.
    BaseColumn,
}

/// A body that is too near to something, and by how much: the room between them less the clearance, metres, below 0.
pub(super) type Nearness = (f64, Body, Obstacle);

/// All points within `radius` metres of the axis, in the frame of the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Capsule {
    pub(super) body: Body,
    pub(super) axis: Segment,
    pub(super) radius: f64,
}

/// What gun and arm must not run into, in the frame of the path.
#[derive(Clone, Debug)]
pub struct Obstacles {
    /// Nearer than this is too near, metres, 0..1.
    pub clearance: f64,
    boxes: Vec<CellBox>,
    /// Height of the floor, metres.
    floor: Option<f64>,
    part: Option<Arc<PartPoints>>,
}

#[derive(Clone, Debug)]
struct CellBox {
    name: String,
    box_from_robot: RigidTransform,
    half: Vector3<f64>,
}

/// The points of the part, from the middle of their extent.
#[derive(Debug)]
struct PartPoints {
    tree: KdTree,
    half: Vector3<f64>,
    spacing: f64,
    middle_from_robot: RigidTransform,
}

/// The file's content.
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
    /// None, with a clearance of 20 mm.
    fn default() -> Self {
        Self {
            clearance: 0.02,
            boxes: Vec::new(),
            floor: None,
            part: None,
        }
    }
}

impl Obstacles {
    /// Reads the boxes of a cell and its floor.
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
            && !(floor.abs() <= LARGEST)
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
            ..Self::default()
        })
    }

    /// The same with the part's points, in the part's frame; those that are not finite do not count.
    #[must_use]
    pub fn with_part(self, points: &[Point3<f32>], robot_from_part: &RigidTransform) -> Self {
        Self {
            part: PartPoints::new(points, robot_from_part).map(Arc::new),
            ..self
        }
    }

    /// The corners of each box. Two are joined by an edge if their numbers differ in one bit.
    pub fn boxes(&self) -> impl Iterator<Item = [Point3<f64>; 8]> {
        self.boxes.iter().map(|one| {
            let robot_from_box = one.box_from_robot.inverse();
            std::array::from_fn(|i| {
                let sides = [0, 1, 2].map(|axis| if (i >> axis) & 1 == 0 { -1.0 } else { 1.0 });
                let corner = Vector3::from(sides).component_mul(&one.half);
                robot_from_box * Point3::from(corner)
            })
        })
    }

    /// Every body that is too near to something.
    pub(super) fn pairs(&self, bodies: &[Capsule]) -> impl Iterator<Item = Nearness> {
        bodies.iter().flat_map(move |capsule| {
            let Capsule { body, axis, radius } = *capsule;
            let within = radius + self.clearance;
            let part = self.part.iter().filter_map(move |part| {
                let distance = part.distance(&axis, within)?;
                Some((distance - within, body, Obstacle::Part))
            });
            let floor = self.floor.iter().filter_map(move |floor| {
                let room = axis.from.z.min(axis.to.z) - floor - within;
                (room < 0.0).then_some((room, body, Obstacle::Floor))
            });
            let boxes = self.boxes.iter().filter_map(move |one| {
                let distance = one.distance(&axis, within)?;
                Some((distance - within, body, Obstacle::Box(one.name.clone())))
            });
            part.chain(floor).chain(boxes)
        })
    }

    /// Bodies of the arm that are too near to another one or to the base column, which is given by its axis and radius.
    /// `bodies` are gun, wrist, forearm, its step behind the elbow, and upper arm.
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

/// How much nearer than `within` two axes are, metres, below 0; none if they are not.
fn room(axis: &Segment, other: &Segment, within: f64) -> Option<f64> {
    let room = axis.distance_to_segment(other) - within;
    (room < 0.0).then_some(room)
}

/// The body that is too near to something, and to what: of several the pair with the least room, whatever their order.
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
        let wrong = |what: &str, values: [f64; 3]| Err(format!("{what} of {name} is {values:?}"));
        if !self.centre_mm.iter().all(|x| x.abs() <= LARGEST) {
            return wrong("centre_mm", self.centre_mm);
        }
        if !self.size_mm.iter().all(|x| *x > 0.0 && *x <= LARGEST) {
            return wrong("size_mm", self.size_mm);
        }
        if !self.angles_deg.iter().all(|x| x.abs() <= 360.0) {
            return wrong("angles_deg", self.angles_deg);
        }
        let [x, y, z] = self.centre_mm.map(|x| x / 1000.0);
        let [rx, ry, rz] = self.angles_deg.map(f64::to_radians);
        Ok(CellBox {
            name: name.to_owned(),
            box_from_robot: from_euler_zyx([rx, ry, rz, x, y, z]).inverse(),
            half: Vector3::from(self.size_mm) / 2000.0,
        })
    }
}

impl CellBox {
    /// The distance of a segment to its surface, if below `within`; 0 inside.
    fn distance(&self, axis: &Segment, within: f64) -> Option<f64> {
        let axis = axis.moved(&self.box_from_robot);
        // The spheres around both are apart: most boxes of a cell are far from most bodies.
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

    /// The distance of a segment to its surface, if below `within`: that to the nearest point less the points' spacing.
    fn distance(&self, axis: &Segment, within: f64) -> Option<f64> {
        let axis = axis.moved(&self.middle_from_robot);
        let within = within + self.spacing;
        // Beside the box around all points no point needs to be looked for.
        if axis.distance_to_box(&self.half) >= within {
            return None;
        }
        let distance = axis.distance_to_cloud(&self.tree, within)?;
        Some(distance - self.spacing)
    }
}

#[cfg(test)]
mod tests;
