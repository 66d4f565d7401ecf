//! Doubts about a set of pairs, with advice.

use super::{
    CalibrationBounds, HandEyeSolution, Mount, PosePair, Poses, Residuals, Span, equations_of,
    mistake::{LikelyMistake, disagreement},
    suspects::suspects,
};
use geometry::{
    error::Advice,
    rigid::PoseDelta,
    units::{Metres, Radians},
};

/// A doubt about a calibration.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
pub enum HandEyeDoubt {
    /// A position is farther away than any cell is large: probably another unit.
    #[error("{pair}: {what} lies {:.0} m away", distance.0)]
    #[advice(CHECK_UNIT)]
    FarAway {
        /// Name of the pair.
        pair: String,
        /// The flange or the target.
        what: &'static str,
        /// Distance from its frame's origin.
        distance: Metres,
    },
    /// All positions are nearer than those of any cell: probably another unit.
    #[error("{what} never lies more than {:.1} mm from {origin}", distance.mm())]
    #[advice(CHECK_UNIT)]
    TooNear {
        /// The flange or the target.
        what: &'static str,
        /// The robot's base or the camera.
        origin: &'static str,
        /// Greatest distance from it.
        distance: Metres,
    },
    /// Robot and camera turned by different angles between the same two captures.
    #[error(
        "between the same captures robot and camera turned by angles that differ by {:.1}° (median): the poses do not belong together, or one of them is read in the wrong convention",
        apart.degrees()
    )]
    #[advice = "Check the convention of the robot's poses, and that each line holds both poses of one capture"]
    TurnsDisagree {
        /// Median of the differences.
        apart: Radians,
    },
    /// The pairs would agree if some of the poses were read differently.
    #[error(
        "the pairs do not agree ({:.1} mm and {:.2}° rms), but they would to {:.1} mm and {:.2}° if {mistake}",
        rms.shift.mm(), rms.rotation.degrees(), then.shift.mm(), then.rotation.degrees()
    )]
    #[advice(mistake.advice())]
    Mistaken {
        /// The probable mistake.
        mistake: LikelyMistake,
        /// Root mean square with the poses as given.
        rms: PoseDelta,
        /// Root mean square with the mistake undone.
        then: PoseDelta,
    },
    /// Camera or target would be too far from the flange that it is mounted on.
    #[error("{what} would sit {:.0} mm from the flange{}", distance.mm(), if_inverted(*inverted))]
    #[advice = "Check that the robot's poses are robot_from_flange and the camera's camera_from_target, and not both the other way round, \
               and that the unit of the lengths is right"]
    FarFromFlange {
        /// The camera, or the target.
        what: &'static str,
        /// Distance from the flange.
        distance: Metres,
        /// The same if the poses of robot and camera were both inverted, where that is more plausible.
        inverted: Option<Metres>,
    },
    /// The camera cannot have seen the target where it would be.
    #[error("the target would lie behind the camera in {behind} of {found} pairs")]
    #[advice = "Check that the camera's poses are camera_from_target, not the other way round, in a frame with x right, y down and z forward"]
    BehindCamera {
        /// Pairs whose target lies behind the camera.
        behind: usize,
        /// All pairs.
        found: usize,
    },
    /// All turns are half turns about axes at right angles, which leaves several solutions.
    #[error(
        "another place of the camera fits the pairs as well: the turns are half turns about axes at right angles"
    )]
    #[advice = "Take some pairs with turns of 30° to 90° between them"]
    SeveralAnswers,
    /// The pairs do not agree, for no known reason.
    #[error("the pairs do not agree: {:.1} mm and {:.2}° rms", rms.shift.mm(), rms.rotation.degrees())]
    #[advice = "Check that the target did not move, that the arm stood still at every capture, and that the controller shows the flange without a tool"]
    Disagree {
        /// Root mean square of all pairs that are not suspect.
        rms: PoseDelta,
    },
    /// The arm hardly turned.
    #[error("the flange turned by {:.1}° at most", span.largest_turn.degrees())]
    #[advice = "Take more pairs, turning the flange about two different axes by at least 30°"]
    SmallTurns {
        /// What the poses span.
        span: Span,
    },
    /// The arm turned about one axis only.
    #[error(
        "nearly all turns are about one axis, {}; about other axes the flange turned by {:.1}° (rms)",
        span.main_axis_in_words(), span.other_turn.degrees()
    )]
    #[advice = "Take more pairs, turning the flange about another axis by at least 30°"]
    OneAxis {
        /// What the poses span.
        span: Span,
    },
    /// A pair deviates far from what the others agree on.
    #[error(
        "{pair} is suspect: {:.1} mm and {:.2}° off the other pairs, which agree to {:.1} mm and {:.2}° rms",
        off.shift.mm(), off.rotation.degrees(), others.shift.mm(), others.rotation.degrees()
    )]
    #[advice = "Check this pair, or calculate without it"]
    Suspect {
        /// Name of the pair.
        pair: String,
        /// Its deviation.
        off: PoseDelta,
        /// Root mean square of the pairs that are not suspect.
        others: PoseDelta,
    },
    /// The pairs leave X too uncertain for painting.
    #[error("the camera's place may be off by {:.1} mm and {:.2}°", bounds.shift.mm(), bounds.turn.degrees())]
    #[advice = "Take more pairs, with larger turns about different axes and the target in all parts of the picture"]
    Loose {
        /// Bounds of the error of X.
        bounds: CalibrationBounds,
    },
    /// The target was always at about the same place in the camera frame.
    #[error("the camera saw the target within {:.0} mm of one place", span.travel.mm())]
    #[advice = "Take some pairs with the target 20 cm and more to the sides, nearer and farther"]
    LittleTravel {
        /// What the poses span.
        span: Span,
    },
    /// Too few pairs for meaningful residuals.
    #[error(
        "with {found} different pairs the residuals say little about how far off the result is"
    )]
    #[advice = "Take 8 to 15 pairs"]
    FewPairs {
        /// Pairs from different poses of the arm.
        found: usize,
    },
}

impl HandEyeDoubt {
    /// True if the result must not be used.
    pub fn is_grave(&self) -> bool {
        match self {
            Self::FarAway { .. }
            | Self::TooNear { .. }
            | Self::TurnsDisagree { .. }
            | Self::Mistaken { .. }
            | Self::FarFromFlange { .. }
            | Self::BehindCamera { .. }
            | Self::SeveralAnswers
            | Self::Disagree { .. }
            | Self::SmallTurns { .. }
            | Self::OneAxis { .. } => true,
            Self::Loose { bounds } => {
                !(bounds.shift <= FAR_TOO_LOOSE.shift && bounds.turn <= FAR_TOO_LOOSE.turn)
            }
            Self::Suspect { .. } | Self::LittleTravel { .. } | Self::FewPairs { .. } => false,
        }
    }
}

const CHECK_UNIT: &str =
    "Check the unit of the lengths: each convention has its own (partsight report --conventions)";

/// No cell is larger.
pub(super) const FARTHEST: Metres = Metres(20.0);
/// The same in metres that were read as millimetres. No arm moves within so little around its base, and no target is so near
/// to the camera.
pub(super) const NEAREST: Metres = Metres(0.02);
/// Least largest turn (15°), so that the camera's noise is small in comparison.
const LEAST_TURN: Radians = Radians(0.26);
const LEAST_OTHER_TURN: Radians = Radians(0.07);
const LEAST_TRAVEL: Metres = Metres(0.05);
/// Turns of [`LEAST_OTHER_TURN`] give a lead of about 0.002.
const LEAST_LEAD: f64 = 2e-4;
/// Allows for a camera on a boom, or for the middle of a bumper that the flange holds at its end.
const FARTHEST_ON_FLANGE: Metres = Metres(1.2);
/// ±5 mm: a tenth of the stand-off band.
const LOOSE: CalibrationBounds = CalibrationBounds {
    shift: Metres(0.005),
    turn: Radians(0.0087),
};
/// ±25 mm: half of the stand-off band.
const FAR_TOO_LOOSE: CalibrationBounds = CalibrationBounds {
    shift: Metres(0.025),
    turn: Radians(0.052),
};
/// With fewer pairs than this the residuals understate the error.
const ENOUGH_PAIRS: usize = 6;

/// Returns all doubts, the gravest first.
pub(super) fn doubts(
    pairs: &[PosePair],
    mount: Mount,
    residuals: &Residuals,
    span: &Span,
    bounds: CalibrationBounds,
    lead: f64,
    far: Option<HandEyeDoubt>,
) -> Vec<HandEyeDoubt> {
    let mut doubts: Vec<HandEyeDoubt> = far_away(pairs).into_iter().collect();
    if span.largest_turn < LEAST_TURN {
        doubts.push(HandEyeDoubt::SmallTurns { span: *span });
    } else if span.other_turn < LEAST_OTHER_TURN {
        doubts.push(HandEyeDoubt::OneAxis { span: *span });
    } else if lead < LEAST_LEAD {
        doubts.push(HandEyeDoubt::SeveralAnswers);
    }
    let poses: Vec<Poses> = pairs.iter().map(PosePair::poses).collect();
    let equations = equations_of(mount, poses.iter().copied());
    let suspects = suspects(&equations);
    // At most one pair in three can be a slip; more suspects mean a mistake in all pairs.
    let suspects = suspects.filter(|found| 3 * found.pairs.len() <= equations.len());
    let rms_of_most = suspects.as_ref().map_or(residuals.rms, |found| found.rms);
    doubts.extend(disagreement(mount, &poses, rms_of_most));
    doubts.extend(too_near(&poses));
    if !doubts.iter().any(HandEyeDoubt::is_grave) {
        doubts.extend(far.or_else(|| behind_camera(&poses)));
    }
    if let Some(found) = suspects {
        let suspect = |(i, off): (usize, PoseDelta)| HandEyeDoubt::Suspect {
            pair: pairs[i].name.clone(),
            off,
            others: found.rms,
        };
        doubts.extend(found.pairs.into_iter().map(suspect));
    }
    let is_tight = bounds.shift <= LOOSE.shift && bounds.turn <= LOOSE.turn;
    let is_grave = doubts.iter().any(HandEyeDoubt::is_grave);
    if !is_tight && !is_grave {
        doubts.push(HandEyeDoubt::Loose { bounds });
    }
    if span.travel < LEAST_TRAVEL {
        doubts.push(HandEyeDoubt::LittleTravel { span: *span });
    }
    if pairs.len() < ENOUGH_PAIRS {
        doubts.push(HandEyeDoubt::FewPairs { found: pairs.len() });
    }
    doubts.sort_by_key(|doubt| !doubt.is_grave());
    doubts
}

/// Reports the farthest position, if it is too far.
fn far_away(pairs: &[PosePair]) -> Option<HandEyeDoubt> {
    let positions = pairs.iter().flat_map(|pair| {
        [
            (pair, "the robot's flange", &pair.robot_from_flange),
            (pair, "the target", &pair.camera_from_target),
        ]
    });
    let distances =
        positions.map(|(pair, what, pose)| (pair, what, pose.translation.vector.norm()));
    let (pair, what, distance) = distances.max_by(|a, b| a.2.total_cmp(&b.2))?;
    (distance > FARTHEST.0).then(|| HandEyeDoubt::FarAway {
        pair: pair.name.clone(),
        what,
        distance: Metres(distance),
    })
}

/// Reports the flange or the target, if it never is far from its origin.
fn too_near(poses: &[Poses]) -> Option<HandEyeDoubt> {
    let [flange, target] = farthest(poses);
    let all = [
        ("the robot's flange", "the robot's base", flange),
        ("the target", "the camera", target),
    ];
    let near = all.into_iter().find(|(_, _, distance)| *distance < NEAREST);
    near.map(|(what, origin, distance)| HandEyeDoubt::TooNear {
        what,
        origin,
        distance,
    })
}

/// Greatest distances of the robot's and of the camera's positions from their origins.
pub(super) fn farthest(poses: &[Poses]) -> [Metres; 2] {
    [0, 1].map(|i: usize| {
        let distances = poses.iter().map(|pair| pair[i].translation.vector.norm());
        Metres(distances.fold(0.0, f64::max))
    })
}

/// The end of the message about a thing far from the flange.
fn if_inverted(inverted: Option<Metres>) -> String {
    inverted.map_or_else(String::new, |near| {
        format!(
            ", but {:.0} mm from it if {}, which fits the pairs as well",
            near.mm(),
            LikelyMistake::BothInverted
        )
    })
}

/// Reports the camera or target on the flange, if it is implausibly far from it.
///
/// The equation Gᵢ X Bᵢ = Z is also Gᵢ⁻¹ Z Bᵢ⁻¹ = X: with the poses of robot *and* camera inverted, X and Z change
/// places and every residual stays the same. So only the lengths show which way the poses go: what is on the flange
/// lies nearer to it than the camera or the target in the cell to the robot's base. If the inverted poses put the
/// target behind the camera, they are no explanation.
pub(super) fn far_from_flange(
    mount: Mount,
    poses: &[Poses],
    unknowns: &HandEyeSolution,
) -> Option<HandEyeDoubt> {
    let camera = unknowns.mount_from_camera.translation.vector.norm();
    let target = unknowns.anchor_from_target.translation.vector.norm();
    let (what, on_flange, in_cell) = match mount {
        Mount::EyeInHand => ("the camera", camera, target),
        Mount::EyeToHand => ("the target", target, camera),
    };
    let inverted: Vec<Poses> = poses
        .iter()
        .map(|[robot, camera]| [robot.inverse(), camera.inverse()])
        .collect();
    let inverted = (in_cell < on_flange && behind_camera(&inverted).is_none()).then_some(in_cell);
    let is_far = on_flange > FARTHEST_ON_FLANGE.0 || inverted.is_some();
    is_far.then_some(HandEyeDoubt::FarFromFlange {
        what,
        distance: Metres(on_flange),
        inverted: inverted.map(Metres),
    })
}

/// Reports that the target lies behind the camera in more pairs than can be slips.
fn behind_camera(poses: &[Poses]) -> Option<HandEyeDoubt> {
    let behind = poses
        .iter()
        .filter(|[_, camera]| camera.translation.z <= 0.0);
    let (behind, found) = (behind.count(), poses.len());
    (3 * behind > found).then_some(HandEyeDoubt::BehindCamera { behind, found })
}
