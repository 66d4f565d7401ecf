//! Why servoing holds or stops.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use inspection::pipeline::Refusal;
use robot::arm::{Obstacle, PointProblem};
use texts::{Described, Message};

/// Why the robot stops. `Display` gives the reason, `Advice` what to do next.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum StopReason {
    /// The inspection accepted no part.
    NotAccepted {
        /// Why not.
        why: Refusal,
    },
    /// Another part hangs there, or one that looks like another reference of it.
    AnotherPart {
        /// The part to servo to.
        part: String,
        /// The part, or reference, that was recognised.
        other: String,
    },
    /// The pose is ambiguous: another one fits nearly as well, or its size does not match.
    Ambiguous {
        /// The part.
        part: String,
    },
    /// The inspection gives no bounds of the pose.
    NoBounds {
        /// The part.
        part: String,
    },
    /// The part's measured pose changed by more than is plausible.
    Moved {
        /// By how far, metres.
        shift_m: f64,
        /// By what angle.
        turn_rad: f64,
    },
    /// There was no accepted pose for this long.
    Lost {
        /// Time since the last accepted frame was taken.
        age_s: f64,
    },
    /// A pose arrived too late.
    Stale {
        /// Age of its frame.
        age_s: f64,
    },
    /// A frame is dated later than now, or not later than the one before it.
    FrameTimes {
        /// By how much.
        off_s: f64,
    },
    /// The times of two states of the arm are too far apart, or not in order.
    ArmTimes {
        /// Time from one to the other.
        gap_s: f64,
    },
    /// The arm is not where it was sent.
    ArmAstray {
        /// How far off.
        shift_m: f64,
        /// By what angle.
        turn_rad: f64,
    },
    /// The target is farther away than servoing may move.
    TooFar {
        /// How far.
        shift_m: f64,
        /// By what angle.
        turn_rad: f64,
    },
    /// The robot would leave the work volume.
    OutsideVolume {
        /// By how far.
        beyond_m: f64,
    },
    /// Tool or arm would come too near to something.
    TooNear {
        /// What of the robot: `tool`, `gun`, `wrist`, `forearm` or `upper_arm`.
        body: Cow<'static, str>,
        /// To what: `part`, `other_part`, `floor`, `box`, `upper_arm`, `forearm` or `base_column`.
        obstacle: Cow<'static, str>,
        /// Name of a box; empty for others.
        name: String,
    },
    /// The arm does not reach a pose on the way.
    OutOfReach,
    /// A joint would have to go beyond its limit.
    JointLimit {
        /// The joint, from 1.
        joint: usize,
    },
    /// The arm would come too near to a singularity.
    Singular,
    /// At the end, error and bounds together exceed the tolerance.
    Uncertain {
        /// Shift, with its bound.
        shift_m: f64,
        /// Tolerance of it.
        most_m: f64,
        /// Angle, with its bound.
        turn_rad: f64,
        /// Tolerance of it.
        most_rad: f64,
    },
    /// The error at rest does not become small enough.
    NotSettling {
        /// Number of corrections made.
        num_rounds: usize,
        /// The error that is left.
        shift_m: f64,
        /// Its angle.
        turn_rad: f64,
    },
    /// It takes too long.
    TimeOver {
        /// Longest time allowed.
        limit_s: f64,
    },
    /// The controller's program has stopped, or no longer follows.
    RobotStopped,
    /// A person or a program stopped it.
    ByPerson,
}

impl StopReason {
    /// A name for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NotAccepted { .. } => "not_accepted",
            Self::AnotherPart { .. } => "another_part",
            Self::Ambiguous { .. } => "ambiguous",
            Self::NoBounds { .. } => "no_bounds",
            Self::Moved { .. } => "moved",
            Self::Lost { .. } => "lost",
            Self::Stale { .. } => "stale",
            Self::FrameTimes { .. } => "frame_times",
            Self::ArmTimes { .. } => "arm_times",
            Self::ArmAstray { .. } => "arm_astray",
            Self::TooFar { .. } => "too_far",
            Self::OutsideVolume { .. } => "outside_volume",
            Self::TooNear { .. } => "too_near",
            Self::OutOfReach => "out_of_reach",
            Self::JointLimit { .. } => "joint_limit",
            Self::Singular => "singular",
            Self::Uncertain { .. } => "uncertain",
            Self::NotSettling { .. } => "not_settling",
            Self::TimeOver { .. } => "time_over",
            Self::RobotStopped => "robot_stopped",
            Self::ByPerson => "by_person",
        }
    }

    /// Why a tool must not be near this obstacle.
    pub(crate) fn too_near(body: &'static str, obstacle: Obstacle) -> Self {
        let (obstacle, name) = match obstacle {
            Obstacle::Part => ("part", String::new()),
            Obstacle::OtherPart => ("other_part", String::new()),
            Obstacle::Floor => ("floor", String::new()),
            Obstacle::Box(name) => ("box", name),
            Obstacle::UpperArm => ("upper_arm", String::new()),
            Obstacle::Forearm => ("forearm", String::new()),
            Obstacle::BaseColumn => ("base_column", String::new()),
        };
        Self::TooNear {
            body: body.into(),
            obstacle: obstacle.into(),
            name,
        }
    }
}

impl From<PointProblem> for StopReason {
    fn from(problem: PointProblem) -> Self {
        use robot::arm::Body;
        match problem {
            PointProblem::JointLimit { joint, .. } => Self::JointLimit { joint },
            PointProblem::NearSingularity { .. } => Self::Singular,
            PointProblem::Collision { body, obstacle } => {
                let body = match body {
                    Body::Gun => "gun",
                    Body::Wrist => "wrist",
                    Body::Forearm => "forearm",
                    Body::UpperArm => "upper_arm",
                };
                Self::too_near(body, obstacle)
            }
            // The others concern moves, which are not checked here.
            _ => Self::OutOfReach,
        }
    }
}

impl Described for StopReason {
    fn message(&self) -> Message {
        match self {
            Self::NotAccepted { why } => {
                Message::new("servo-not-accepted").caused_by(why.message())
            }
            _ => Message::tagged("servo", "kind", self),
        }
    }
}

texts::display!(StopReason);

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use inspection::pipeline::Rejection;
    use texts::{LIBRARY, Language};

    fn examples() -> Vec<StopReason> {
        let part = || "door".to_owned();
        let (shift_m, turn_rad) = (0.05, 0.1);
        vec![
            StopReason::NotAccepted {
                why: Refusal::Rejected(Rejection::HardlySeen {
                    part: part(),
                    score: 0.4,
                }),
            },
            StopReason::AnotherPart {
                part: part(),
                other: "grille".into(),
            },
            StopReason::Ambiguous { part: part() },
            StopReason::NoBounds { part: part() },
            StopReason::Moved { shift_m, turn_rad },
            StopReason::Lost { age_s: 0.7 },
            StopReason::Stale { age_s: 0.7 },
            StopReason::FrameTimes { off_s: 0.7 },
            StopReason::ArmTimes { gap_s: 0.2 },
            StopReason::ArmAstray { shift_m, turn_rad },
            StopReason::TooFar { shift_m, turn_rad },
            StopReason::OutsideVolume { beyond_m: 0.1 },
            StopReason::too_near("gun", Obstacle::Box("post".into())),
            StopReason::OutOfReach,
            StopReason::JointLimit { joint: 5 },
            StopReason::Singular,
            StopReason::Uncertain {
                shift_m,
                most_m: 0.01,
                turn_rad,
                most_rad: 0.02,
            },
            StopReason::NotSettling {
                num_rounds: 8,
                shift_m,
                turn_rad,
            },
            StopReason::TimeOver { limit_s: 60.0 },
            StopReason::RobotStopped,
            StopReason::ByPerson,
        ]
    }

    #[test]
    fn every_reason_has_its_text_and_advice_in_every_language_and_every_text_its_reason() {
        let ids: BTreeSet<String> = (examples().iter())
            .map(|reason| format!("servo-{}", reason.kind().replace('_', "-")))
            .collect();
        for language in Language::ALL {
            let files = LIBRARY.files(language).iter();
            let texts: BTreeSet<String> = files
                .flat_map(|(_, text)| text.lines())
                .filter(|line| line.starts_with("servo-"))
                .filter_map(|line| Some(line.split_once(" =")?.0.to_owned()))
                // What is no reason to stop.
                .filter(|id| !["servo-not-simulated", "servo-waits-for-robot"].contains(&&**id))
                .collect();
            assert_eq!(texts, ids, "{language:?}");
            for reason in examples() {
                let message = reason.message();
                assert!(!message.text(language).starts_with("servo-"));
                assert!(!message.advice(language).is_empty(), "{reason:?}");
            }
        }
    }

    #[test]
    fn a_reason_that_was_stored_is_read_as_it_was() {
        for reason in examples() {
            let stored = serde_json::to_string(&reason).expect("numbers and text");
            assert!(stored.contains(reason.kind()), "{stored}");
            let read: StopReason = serde_json::from_str(&stored).expect(&stored);
            assert_eq!(read, reason);
        }
    }

    #[test]
    fn texts_have_the_figures() {
        let texts = examples()
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>();
        for part in [
            "no part is accepted: what may be door",
            "grille hangs there instead of door",
            "moved by 50 mm and 5.7°",
            "its gun would come too near to the box post",
            "50.0 mm and 5.73° with the bounds, allowed 10.0 mm and 1.15°",
        ] {
            assert!(
                texts.iter().any(|text| text.contains(part)),
                "{part}: {texts:#?}"
            );
        }
    }
}
