//! The number blocks of a pose report, each with its order, units and frame.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use super::{ReportSubject, SeenBy, StandOff, StandOffParams};
use geometry::rigid::RigidTransform;
use inspection::pipeline::Inspection;
use robot::{Convention, RobotPose};
use stages::pose::PoseEstimate;

/// The frames, spelt out.
const CAMERA: &str = "camera: x right, y down, z forward";
const PART: &str = "part: the part's own frame, as it was enrolled; the camera's frame with the part at its standard position";
const ROBOT: &str = "robot: the robot's base frame";

/// Numbers in one order.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct NumberBlock {
    /// Order and units, in full.
    pub meaning: String,
    /// The name of each number.
    pub names: &'static [&'static str],
    /// The numbers.
    pub values: Vec<f64>,
}

impl NumberBlock {
    fn of(convention: Convention, transform: &RigidTransform) -> Self {
        Self {
            meaning: convention.meaning(),
            names: convention.names(),
            values: convention.write(transform).numbers(),
        }
    }
}

/// A transform from one frame to another, three times in different numbers.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TransformBlock {
    /// Its name: `TO_from_FROM`, but for the offset.
    pub name: &'static str,
    /// What it does, in full.
    pub meaning: &'static str,
    /// The frame that it takes points from.
    pub from_frame: &'static str,
    /// The frame that it takes them to.
    pub to_frame: &'static str,
    /// As a 4×4 matrix.
    pub matrix: NumberBlock,
    /// As position and quaternion.
    pub quaternion: NumberBlock,
    /// In the convention that was asked for.
    pub in_convention: RobotPose,
}

impl TransformBlock {
    fn of(
        [name, meaning]: [&'static str; 2],
        [from_frame, to_frame]: [&'static str; 2],
        transform: &RigidTransform,
        convention: Convention,
    ) -> Self {
        Self {
            name,
            meaning,
            from_frame,
            to_frame,
            matrix: NumberBlock::of(Convention::Matrix, transform),
            quaternion: NumberBlock::of(Convention::QuaternionXyzw, transform),
            in_convention: convention.write(transform),
        }
    }
}

/// Where the part is before the camera, and how well that is known.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PoseBlock {
    /// True if a robot may act on it: the part was accepted, and there is no doubt.
    pub usable: bool,
    /// What to mind before using it.
    pub cautions: Vec<String>,
    /// The enrolled reference whose coordinates the part's frame is, and whose standard position is meant below. Another
    /// than the part's own name where several are enrolled for one part: each has coordinates of its own.
    pub reference: Option<String>,
    /// The pose.
    pub camera_from_part: TransformBlock,
    /// Its inverse, the paper's T.
    pub part_from_camera: TransformBlock,
    /// How far the part's middle moved, for people; null if the reference has no extent.
    pub middle: Option<MiddleBlock>,
    /// How well the part lies on its reference.
    pub fit: FitBlock,
    /// How far off the pose may be; null if nothing holds it, or it was not worked out.
    pub bounds: Option<BoundsBlock>,
}

/// How far the part's middle is off its standard position, for people.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MiddleBlock {
    /// What it is, in full.
    pub meaning: &'static str,
    /// x y z of the part's middle at its standard position, metres.
    pub standard_m: [f64; 3],
    /// x y z of the part's middle now, metres.
    pub now_m: [f64; 3],
    /// How far it moved along x y z, metres.
    pub moved_m: [f64; 3],
    /// rx ry rz by which the part is turned, degrees, with R = Rz(rz)·Ry(ry)·Rx(rx) about the camera's fixed axes.
    pub turned_deg: [f64; 3],
    /// The one angle about one axis that this comes to, degrees, 0..180.
    pub turned_in_all_deg: f64,
}

/// How well the part lies on its reference.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FitBlock {
    /// How the pose was found: `global`, `icp` or `icp-ga`.
    pub method: &'static str,
    /// Why the search ended.
    pub stopped: &'static str,
    /// Its steps.
    pub num_iterations: usize,
    /// Root mean square distance of what lies on the reference to its surface, metres.
    pub rms_m: f64,
    /// Mean squared distance to the closest points (the paper's eq. 12), square metres.
    pub e_m2: f64,
    /// Share of what was seen that lies on the reference, 0..1.
    pub overlap: f64,
    /// True if another pose fits as well.
    pub ambiguous: bool,
    /// Cost of the next best pose over this one's, at least 1; null if no other was tried.
    pub runner_up_ratio: Option<f64>,
    /// Size of the part divided by that of its reference, if it is certainly another: the camera's numbers are probably
    /// wrong.
    pub off_scale: Option<f64>,
}

/// How far off the pose may be.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BoundsBlock {
    /// What it is, in full.
    pub meaning: &'static str,
    /// Of the part's middle, metres.
    pub shift_m: f64,
    /// Of the rotation, degrees.
    pub turn_deg: f64,
}

/// The pose in the robot's base frame.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RobotBlock {
    /// The convention that was asked for.
    pub convention: Convention,
    /// Its name for people.
    pub convention_title: String,
    /// Order, axes and units of its numbers.
    pub convention_meaning: String,
    /// Which cell calibration; null if there is none.
    pub calibration: Option<String>,
    /// Where the camera stands in the robot's base frame; null without a calibration.
    pub robot_from_camera: Option<TransformBlock>,
    /// Why the two below are null; null if they are not.
    pub unavailable: Option<String>,
    /// The pose in the robot's base frame.
    pub robot_from_part: Option<TransformBlock>,
    /// What moves a path that was taught in the robot's base frame with the part at its standard position.
    pub robot_offset: Option<TransformBlock>,
    /// Why a robot must not act on the result, but for a missing calibration; with `--force`, the poses are given
    /// nevertheless.
    pub doubts: Vec<DoubtBlock>,
}

/// A reason against letting a robot act on a result.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DoubtBlock {
    /// A word that stays the same in later versions, as in `robot_doubts` of the JSON line.
    pub kind: &'static str,
    /// What is wrong.
    pub what: String,
    /// What to do about it.
    pub advice: String,
}

/// The nozzle's stand-off.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StandOffBlock {
    /// What it is, in full.
    pub meaning: &'static str,
    /// Distance at which the path was taught, metres.
    pub taught_m: f64,
    /// Nearest distance that still coats well, metres.
    pub nearest_m: f64,
    /// Farthest distance that still coats well, metres.
    pub farthest_m: f64,
    /// Mean distance as the part hangs now, metres.
    pub mean_m: f64,
    /// The distance that is furthest from the taught one, metres; below 0 with the nozzle in or behind the part.
    pub worst_m: f64,
    /// Share of the path whose distance is between nearest and farthest, 0..1.
    pub in_band: f64,
    /// Mean angle between nozzle and surface normal, degrees.
    pub mean_angle_deg: f64,
    /// Largest angle between nozzle and surface normal, degrees.
    pub worst_angle_deg: f64,
    /// True if the path can run as it was taught.
    pub keeps_the_band: bool,
}

impl PoseBlock {
    pub(super) fn of(
        pose: &PoseEstimate,
        inspection: &Inspection,
        subject: &ReportSubject<'_>,
    ) -> Self {
        let camera_from_part = pose.camera_from_part();
        Self {
            usable: inspection.verdict.is_accepted() && subject.doubts.is_empty(),
            cautions: cautions(pose, inspection, subject),
            reference: inspection.reference().map(ToOwned::to_owned),
            camera_from_part: TransformBlock::of(
                ["camera_from_part", "takes a point of the enrolled part to where it is before the camera now"],
                [PART, CAMERA],
                &camera_from_part,
                subject.convention,
            ),
            part_from_camera: TransformBlock::of(
                [
                    "part_from_camera",
                    "the inverse of camera_from_part, the paper's T (eq. 13): lays what the camera sees onto the enrolled \
                     part",
                ],
                [CAMERA, PART],
                &camera_from_part.inverse(),
                subject.convention,
            ),
            middle: subject.middle.map(|middle| {
                let now = camera_from_part * middle;
                let array = |v: Vector3<f64>| [v.x, v.y, v.z];
                // nalgebra's angles are those of Rz·Ry·Rx.
                let (rx, ry, rz) = camera_from_part.rotation.euler_angles();
                MiddleBlock {
                    meaning: "for people, not for a robot: the middle of the part's extent before the camera (x right, y \
                              down, z forward), its displacement from the standard position, and how the part is turned",
                    standard_m: array(middle.coords),
                    now_m: array(now.coords),
                    moved_m: array(now - middle),
                    turned_deg: [rx, ry, rz].map(f64::to_degrees),
                    turned_in_all_deg: camera_from_part.rotation.angle().to_degrees(),
                }
            }),
            fit: FitBlock {
                method: pose.method.name(),
                stopped: pose.stopped.name(),
                num_iterations: pose.iterations.len(),
                rms_m: pose.fit.rms_m,
                e_m2: pose.fit.e_m2,
                overlap: pose.fit.overlap,
                ambiguous: pose.is_ambiguous(),
                // JSON has no infinity: if the best pose costs nothing, the ratio is meaningless.
                runner_up_ratio: pose.runner_up.map(|next| next.ratio).filter(|ratio| ratio.is_finite()),
                off_scale: pose.off_scale().map(|off| off.scale()),
            },
            bounds: pose.bounds().map(|bounds| BoundsBlock {
                meaning: "the pose is off by less than each of these in 95 of 100 cases, as far as the scatter of the \
                          distances tells; an error that all points share, such as the camera's scale, is not in it",
                shift_m: bounds.shift.0,
                turn_deg: bounds.turn.degrees(),
            }),
        }
    }
}

fn cautions(
    pose: &PoseEstimate,
    inspection: &Inspection,
    subject: &ReportSubject<'_>,
) -> Vec<String> {
    let mut cautions = Vec::new();
    if !inspection.verdict.is_accepted() {
        cautions.push("not accepted: do not move on this pose".to_owned());
    }
    if subject.seen_by == SeenBy::Simulation {
        cautions.push("simulated: no camera was read".to_owned());
    }
    // Further cautions qualify the pose, and the pose of something unknown is of no use.
    if inspection.verdict.is_unknown() {
        return cautions;
    }
    if inspection.verdict.is_approximate() {
        cautions.push("approximate: this may be another model of the part".to_owned());
    }
    if let (Some(reference), Some(best)) = (
        inspection.other_reference(),
        inspection.ranking.entries.first(),
    ) {
        let part = &best.part;
        cautions.push(format!(
            "of {reference}, one more reference of {part}: it has a standard position of its own, a path taught over {part} \
             does not fit"
        ));
    }
    if inspection.touches_edge() {
        cautions.push(
            "what was found reaches the picture's edge: some of it may be missing".to_owned(),
        );
    }
    cautions.extend(pose.doubt().map(|doubt| doubt.to_string()));
    cautions
}

impl RobotBlock {
    pub(super) fn of(
        camera_from_part: Option<&RigidTransform>,
        accepted: bool,
        subject: &ReportSubject<'_>,
    ) -> Self {
        let convention = subject.convention;
        let robot = subject.robot;
        let usable = camera_from_part.zip(subject.for_robot);
        let whats = || subject.doubts.iter().map(|doubt| doubt.what.as_str());
        let unavailable = match usable {
            Some(_) => None,
            None if accepted => Some(whats().collect::<Vec<_>>().join("; ")),
            None => Some("the part was not accepted: there is nothing to move by".to_owned()),
        };
        Self {
            convention,
            convention_title: convention.title(),
            convention_meaning: convention.meaning(),
            calibration: robot.map(|robot| robot.name.to_string()),
            robot_from_camera: robot.map(|robot| {
                TransformBlock::of(
                    ["robot_from_camera", "where the camera stands, by the cell's calibration"],
                    [CAMERA, ROBOT],
                    &robot.robot_from_camera,
                    convention,
                )
            }),
            unavailable,
            robot_from_part: usable.map(|(pose, robot)| {
                TransformBlock::of(
                    [
                        "robot_from_part",
                        "the pose of the part's own frame in the robot's base frame, for a path written in the part's frame",
                    ],
                    [PART, ROBOT],
                    &robot.robot_from_part(pose),
                    convention,
                )
            }),
            robot_offset: usable.map(|(pose, robot)| {
                TransformBlock::of(
                    [
                        "robot_offset",
                        "the offset from the standard position, in the robot's base frame: multiplied from the left, it \
                         moves a path that was taught there with the part at its standard position to where it belongs now",
                    ],
                    [ROBOT, ROBOT],
                    &robot.robot_offset(pose),
                    convention,
                )
            }),
            doubts: subject.doubts.to_vec(),
        }
    }
}

impl StandOffBlock {
    pub(super) fn of(found: &StandOff, params: &StandOffParams) -> Self {
        Self {
            meaning: "distance of a nozzle to the part as it hangs now, if its path ran as it was taught over the part at \
                      its standard position",
            taught_m: params.taught.0,
            nearest_m: params.nearest.0,
            farthest_m: params.farthest.0,
            mean_m: found.mean.0,
            worst_m: found.worst.distance.0,
            in_band: found.in_band,
            mean_angle_deg: found.mean_angle.degrees(),
            worst_angle_deg: found.worst_angle.degrees(),
            keeps_the_band: found.keeps_the_band(),
        }
    }
}
