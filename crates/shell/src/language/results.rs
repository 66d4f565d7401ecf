//! Texts about results in the language of the window. In English they equal those of the library itself, except where
//! those name a command.
//!
//! Each kind of result is matched exhaustively, so that a new one does not compile without its text.

use geometry::error::Advice as _;
use inspection::pipeline::{
    AS_IN_THE_PAPER, AcceptParams, RecipeLabel, Rejection, Unrecognisable, is_like,
};
use records::history::{KeepFrames, StoredVerdict};
use robot::cell_check::{CellFinding, CellViewError};
use simulate::ObjectKind;
use stages::{
    contour::ContourError,
    pose::{Axis, CloudRole, FreeMotion, OffScale, PoseError, PoseWarning, Stopped},
    project::ProjectError,
    scan::{Doubt, Excluded},
    segment::NoPart,
    signature::SignatureError,
    stand_off::StandOffError,
};
use ui::language::text;

/// Formats a number with a fixed number of decimals.
macro_rules! fixed {
    ($value:expr, $decimals:literal) => {
        format!("{:.*}", $decimals, $value)
    };
}

/// Says whether an inspection was accepted, for whatever reason it was not.
pub fn accepted_or_not(is_accepted: bool) -> String {
    if is_accepted {
        text!("results-accepted")
    } else {
        text!("results-not-accepted")
    }
}

/// Returns the name of a stored verdict.
pub fn stored_verdict(verdict: StoredVerdict) -> String {
    match verdict {
        StoredVerdict::Accepted => accepted_or_not(true),
        StoredVerdict::Rejected => accepted_or_not(false),
        StoredVerdict::Unknown => text!("results-unknown"),
        StoredVerdict::NoPart => text!("results-no-part"),
    }
}

/// Describes which frames are kept.
pub fn keep_frames(keep: KeepFrames) -> String {
    match keep {
        KeepFrames::All => text!("results-keep-all"),
        KeepFrames::NotAccepted => text!("results-keep-not-accepted"),
        KeepFrames::None => text!("results-keep-none"),
    }
}

/// True if score and margin show which part it is. Whatever else speaks against it, such as its pose, it is called by its name.
pub fn is_recognised([score, margin]: [f64; 2], accept: &AcceptParams) -> bool {
    score >= accept.min_score && margin >= accept.min_margin
}

/// Explains why a best match is not accepted.
#[expect(clippy::too_many_lines, reason = "one text for each reason")]
pub fn rejection(why: &Rejection) -> String {
    match why {
        Rejection::LowScore {
            part,
            score,
            threshold,
        } => text!(
            "results-low-score",
            part = part,
            score = fixed!(score, 2),
            threshold = fixed!(threshold, 2)
        ),
        Rejection::Piece {
            part,
            score,
            threshold,
            hidden,
            outside,
        } => text!(
            "results-piece",
            part = part,
            hidden = fixed!(hidden * 100.0, 0),
            outside = fixed!(outside * 100.0, 0),
            score = fixed!(score, 2),
            threshold = fixed!(threshold, 2)
        ),
        Rejection::HardlySeen { part, score: _ } => text!("results-hardly-seen", part = part),
        Rejection::AnotherModel {
            part,
            relief,
            outline,
            missing,
        } => text!(
            "results-another-model",
            part = part,
            relief = relief.to_string(),
            outline = outline.to_string(),
            missing = fixed!(missing * 100.0, 1)
        ),
        Rejection::AnotherMake { part, likeness: _ } => {
            text!("results-another-make", part = part)
        }
        Rejection::AmbiguousPose {
            part,
            margin,
            threshold,
        } => text!(
            "results-ambiguous-pose",
            part = part,
            margin = fixed!(margin, 2),
            threshold = fixed!(threshold, 2)
        ),
        Rejection::Unconstrained { part, freedom } => text!(
            "results-unconstrained",
            part = part,
            freedom = free_motion(*freedom)
        ),
        Rejection::Uncertain { part, shift, limit } => text!(
            "results-uncertain",
            part = part,
            shift = shift.to_string(),
            limit = limit.to_string()
        ),
        // Do not name a part that it almost certainly is not.
        Rejection::Unknown { score, .. } if !is_like(*score) => text!("results-unknown-alone"),
        Rejection::Unknown { nearest, score } => text!(
            "results-unknown-nearest",
            nearest = nearest,
            score = fixed!(score, 2)
        ),
        Rejection::Mirrored { part, score } => {
            text!("results-mirrored", part = part, score = fixed!(score, 2))
        }
        Rejection::MirroredImage { part, score } => text!(
            "results-mirrored-image",
            part = part,
            score = fixed!(score, 2)
        ),
        Rejection::SmallMargin {
            part,
            other,
            margin,
            threshold,
        } => text!(
            "results-small-margin",
            part = part,
            other = other,
            margin = fixed!(margin, 2),
            threshold = fixed!(threshold, 2)
        ),
        Rejection::Unconfirmed { part } => text!("results-unconfirmed", part = part),
        Rejection::OutOfRange { part, depth } => text!(
            "results-out-of-range",
            part = part,
            depth = fixed!(depth.0, 2)
        ),
        Rejection::BehindCamera { part, share } => text!(
            "results-behind-camera",
            part = part,
            share = fixed!(share * 100.0, 1)
        ),
        Rejection::SurplusBytes { part, num } => {
            text!("results-surplus-bytes", part = part, num = *num)
        }
        Rejection::NoPose(error) => text!("results-no-pose", why = pose_error(error)),
        Rejection::NotSteady { part } => text!("results-not-steady", part = part),
        Rejection::FewFrames {
            part,
            num_frames,
            needed,
        } => text!(
            "results-few-frames",
            part = part,
            num = *num_frames,
            needed = *needed
        ),
        Rejection::Undecided {
            part,
            num_agreeing,
            num_frames,
            needed,
        } => text!(
            "results-undecided",
            part = part,
            agreeing = *num_agreeing,
            num = *num_frames,
            needed = *needed
        ),
        Rejection::PosesApart {
            part,
            num_agreeing,
            num_frames,
            needed,
        } => text!(
            "results-poses-apart",
            part = part,
            agreeing = *num_agreeing,
            num = *num_frames,
            needed = *needed
        ),
    }
}

/// Advises what to do about a rejection.
pub fn rejection_advice(why: &Rejection) -> String {
    match why {
        Rejection::LowScore { .. } => text!("results-low-score-advice"),
        Rejection::SmallMargin { .. } => text!("results-small-margin-advice"),
        Rejection::Piece {
            hidden, outside, ..
        } => match (*hidden >= 0.005, *outside >= 0.005) {
            (true, false) => text!("results-hidden-piece-advice"),
            (false, true) => text!("results-outside-piece-advice"),
            _ => text!("results-piece-advice"),
        },
        Rejection::HardlySeen { .. } => text!("results-hardly-seen-advice"),
        Rejection::AmbiguousPose { .. }
        | Rejection::Unconstrained { .. }
        | Rejection::Uncertain { .. } => text!("results-see-an-edge-advice"),
        Rejection::AnotherModel { part, .. } | Rejection::AnotherMake { part, .. } => {
            text!("results-another-model-advice", part = part)
        }
        Rejection::Unknown { .. } => text!("results-unknown-advice"),
        Rejection::Mirrored { .. } => text!("results-mirrored-advice"),
        Rejection::MirroredImage { .. } => text!("results-mirrored-image-advice"),
        Rejection::Unconfirmed { .. } => text!("results-unconfirmed-advice"),
        Rejection::OutOfRange { .. } => text!("results-out-of-range-advice"),
        Rejection::BehindCamera { .. } => text!("results-behind-camera-advice"),
        Rejection::SurplusBytes { .. } => text!("results-surplus-bytes-advice"),
        Rejection::NoPose(error) => pose_error_advice(error),
        Rejection::NotSteady { .. } => text!("results-not-steady-advice"),
        Rejection::FewFrames { .. } => text!("results-few-frames-advice"),
        Rejection::Undecided { .. } => text!("results-undecided-advice"),
        Rejection::PosesApart { .. } => text!("results-poses-apart-advice"),
    }
}

/// Explains why nothing could be recognised. A fault of the program keeps its own message.
pub fn unrecognisable(why: &Unrecognisable) -> String {
    match why {
        Unrecognisable::NoPart(NoPart::TooFewPoints { found, needed }) => {
            text!("results-too-few-readings", found = *found, needed = *needed)
        }
        Unrecognisable::NoPart(NoPart::TooWide { extent }) => {
            text!("results-too-wide", extent = fixed!(extent, 0))
        }
        Unrecognisable::NoPart(NoPart::OnlyBackground {
            planes,
            found,
            needed,
            knows_cell: _,
        }) => text!(
            "results-only-background",
            planes = *planes,
            found = fixed!(found, 3),
            needed = fixed!(needed, 3)
        ),
        Unrecognisable::Project(ProjectError::NoPlane { num_points, width }) => text!(
            "results-no-plane",
            num = *num_points,
            width = fixed!(width, 4)
        ),
        Unrecognisable::Project(ProjectError::TooLarge { found, limit }) => text!(
            "results-too-large",
            found = fixed!(found, 1),
            limit = fixed!(limit, 1)
        ),
        Unrecognisable::Contour(ContourError::NoShape { num_set }) => {
            text!("results-no-shape", num = *num_set)
        }
        Unrecognisable::Signature(SignatureError::NoOutline { num_points }) => {
            text!("results-no-outline", num = *num_points)
        }
        Unrecognisable::EmptyLibrary => text!("results-empty-library"),
        Unrecognisable::Fault(fault) => fault.to_string(),
    }
}

/// Advises what to do when nothing could be recognised.
pub fn unrecognisable_advice(why: &Unrecognisable) -> String {
    match why {
        Unrecognisable::NoPart(NoPart::TooFewPoints { .. }) => {
            text!("results-too-few-readings-advice")
        }
        Unrecognisable::NoPart(NoPart::TooWide { .. }) => text!("results-too-wide-advice"),
        Unrecognisable::NoPart(NoPart::OnlyBackground {
            knows_cell: true, ..
        }) => text!("results-known-cell-advice"),
        Unrecognisable::NoPart(NoPart::OnlyBackground { .. }) => {
            text!("results-only-background-advice")
        }
        Unrecognisable::Project(ProjectError::NoPlane { .. }) => text!("results-no-plane-advice"),
        Unrecognisable::Project(ProjectError::TooLarge { .. }) => {
            text!("results-too-large-advice")
        }
        Unrecognisable::Contour(ContourError::NoShape { .. }) => text!("results-no-shape-advice"),
        Unrecognisable::Signature(SignatureError::NoOutline { .. }) => {
            text!("results-no-outline-advice")
        }
        Unrecognisable::EmptyLibrary => text!("results-empty-library-advice"),
        Unrecognisable::Fault(fault) => fault.advice(),
    }
}

/// Describes how a part could move and still fit.
pub fn free_motion(freedom: FreeMotion) -> String {
    match freedom {
        FreeMotion::Slide(Axis::Long) => text!("results-slide-long"),
        FreeMotion::Slide(Axis::Short) => text!("results-slide-short"),
        FreeMotion::Slide(Axis::Normal) => text!("results-slide-normal"),
        FreeMotion::Turn(Axis::Long) => text!("results-turn-long"),
        FreeMotion::Turn(Axis::Short) => text!("results-turn-short"),
        FreeMotion::Turn(Axis::Normal) => text!("results-turn-normal"),
        FreeMotion::Anyhow => text!("results-anyhow"),
    }
}

/// Explains why no pose could be estimated.
pub fn pose_error(error: &PoseError) -> String {
    let cloud = |which: &CloudRole| match which {
        CloudRole::Source => text!("results-source"),
        CloudRole::Target => text!("results-target"),
    };
    match error {
        PoseError::TooFewPoints {
            which,
            found,
            needed,
        } => text!(
            "results-few-points",
            which = cloud(which),
            found = *found,
            needed = *needed
        ),
        PoseError::Degenerate { which, width } => text!(
            "results-degenerate",
            which = cloud(which),
            width = fixed!(width, 5)
        ),
        PoseError::OneSidedPairs { num_pairs, rms } => text!(
            "results-one-sided-pairs",
            num = *num_pairs,
            rms = rms.to_string()
        ),
        PoseError::NoOverlap {
            found,
            needed,
            reach,
        } => text!(
            "results-no-overlap",
            found = *found,
            needed = *needed,
            reach = reach.to_string()
        ),
        PoseError::SizesDiffer { ratio } => {
            text!("results-sizes-differ", ratio = fixed!(ratio, 0))
        }
        PoseError::TooFarOut { which, distance } => text!(
            "results-too-far-out",
            which = cloud(which),
            distance = fixed!(distance.0, 0)
        ),
        PoseError::NoReferenceCloud => text!("results-no-reference-cloud"),
        PoseError::Cancelled => text!("results-pose-cancelled"),
    }
}

/// Advises what to do about a failed estimation of the pose.
pub fn pose_error_advice(error: &PoseError) -> String {
    match error {
        PoseError::TooFewPoints { .. } => text!("results-few-points-advice"),
        PoseError::Degenerate { .. } => text!("results-degenerate-advice"),
        PoseError::OneSidedPairs { .. } | PoseError::NoOverlap { .. } => {
            text!("results-no-overlap-advice")
        }
        PoseError::SizesDiffer { .. } => text!("results-sizes-differ-advice"),
        PoseError::TooFarOut { .. } => text!("results-too-far-out-advice"),
        PoseError::NoReferenceCloud => text!("results-no-reference-cloud-advice"),
        PoseError::Cancelled => text!("results-pose-cancelled-advice"),
    }
}

/// States how much larger or smaller a part is than its reference.
pub(super) fn off_scale(off: &OffScale) -> String {
    let percent = fixed!((off.scale - 1.0).abs() * 100.0, 0);
    if off.scale > 1.0 {
        text!("results-larger", percent = percent)
    } else {
        text!("results-smaller", percent = percent)
    }
}

/// Explains why a pose is not reliable.
pub fn pose_warning(warning: &PoseWarning) -> String {
    match warning {
        PoseWarning::LittleOverlap { overlap, needed } => text!(
            "results-little-overlap",
            overlap = fixed!(overlap * 100.0, 0),
            needed = fixed!(needed * 100.0, 0)
        ),
        PoseWarning::Ambiguous { ratio } => {
            text!("results-another-pose", ratio = fixed!(ratio, 2))
        }
        PoseWarning::Loose { freedom } => {
            text!("results-loose", freedom = free_motion(*freedom))
        }
        PoseWarning::OffScale(off) => off_scale(off),
        PoseWarning::Unsettled { num_iterations } => {
            text!("results-unsettled", num = *num_iterations)
        }
    }
}

/// Explains why an estimation ended.
pub fn stopped(stopped: Stopped) -> String {
    match stopped {
        Stopped::Converged => text!("results-converged"),
        Stopped::BelowTarget => text!("results-below-target"),
        Stopped::IterationLimit => text!("results-iteration-limit"),
        Stopped::NoProgress => text!("results-no-progress"),
    }
}

/// Explains why there is no stand-off.
pub fn stand_off_error(error: &StandOffError) -> String {
    match error {
        StandOffError::NoSurface => text!("inspect-no-surface"),
        StandOffError::NoneMeets { num_taught } => {
            text!("inspect-none-meets", num = *num_taught)
        }
    }
}

/// Describes the finding of a check of the cell.
pub(crate) fn cell_finding(finding: CellFinding) -> String {
    match finding {
        CellFinding::InPlace => text!("results-cell-in-place"),
        CellFinding::PartMoved => text!("results-cell-part-moved"),
        CellFinding::CameraMoved => text!("results-cell-camera-moved"),
        CellFinding::PartOrCameraMoved => text!("results-cell-part-or-camera-moved"),
        CellFinding::Noisier => text!("results-cell-noisier"),
    }
}

/// Advises what to do about a finding.
pub(crate) fn cell_finding_advice(finding: CellFinding) -> String {
    match finding {
        CellFinding::InPlace => text!("results-cell-in-place-advice"),
        CellFinding::PartMoved => text!("results-cell-part-moved-advice"),
        CellFinding::CameraMoved => text!("results-cell-camera-moved-advice"),
        CellFinding::PartOrCameraMoved => text!("results-cell-part-or-camera-moved-advice"),
        CellFinding::Noisier => text!("results-cell-noisier-advice"),
    }
}

/// Explains why frames cannot serve as a baseline of the cell or be compared with it.
pub(crate) fn cell_view_error(error: &CellViewError) -> String {
    match error {
        CellViewError::NoFrame => text!("results-cell-no-frame"),
        CellViewError::Moving { frame, moved } => text!(
            "results-cell-moving",
            frame = *frame,
            shift = moved.shift.to_string(),
            turn = moved.rotation.to_string()
        ),
        CellViewError::OtherPart { frame, overlap } => text!(
            "results-cell-other-part",
            frame = *frame,
            overlap = fixed!(overlap * 100.0, 0)
        ),
        CellViewError::Pose { frame, error } => {
            text!(
                "results-cell-pose",
                frame = *frame,
                error = pose_error(error)
            )
        }
    }
}

/// Advises what to do about such frames.
pub(crate) fn cell_view_error_advice(error: &CellViewError) -> String {
    match error {
        CellViewError::NoFrame => text!("results-cell-no-frame-advice"),
        CellViewError::Moving { .. } => text!("results-cell-moving-advice"),
        CellViewError::OtherPart { .. } => text!("results-cell-other-part-advice"),
        CellViewError::Pose { error, .. } => pose_error_advice(error),
    }
}

/// Explains in a few words why a shot was left out.
pub fn excluded_in_short(why: &Excluded) -> String {
    match why {
        Excluded::WrongPose { .. } => text!("shots-wrong-pose"),
        Excluded::Contradicts { .. } | Excluded::LookedPast { .. } => text!("shots-contradicts"),
        Excluded::OverlapsNone => text!("shots-overlaps-none"),
        Excluded::PartMoved { .. } => text!("shots-part-moved"),
    }
}

/// Explains why a shot was left out.
pub fn excluded(why: &Excluded) -> String {
    match why {
        Excluded::WrongPose { moved } => text!(
            "shots-wrong-pose-by",
            shift = moved.shift.to_string(),
            turn = moved.rotation.to_string()
        ),
        Excluded::Contradicts { share } => {
            text!("shots-contradicts-by", share = fixed!(share * 100.0, 0))
        }
        Excluded::LookedPast { share } => {
            text!("shots-looked-past-by", share = fixed!(share * 100.0, 1))
        }
        Excluded::OverlapsNone => text!("shots-overlaps-none-says"),
        Excluded::PartMoved { share } => {
            text!("shots-part-moved-by", share = fixed!(share * 100.0, 0))
        }
    }
}

/// Warns of shots that were used and do not agree, and advises what to do.
pub fn doubt(doubt: &Doubt) -> [String; 2] {
    match doubt {
        Doubt::PoorAgreement { name, share } => [
            text!(
                "shots-poor-agreement",
                shot = name.as_str(),
                share = fixed!((1.0 - share) * 100.0, 1)
            ),
            text!("shots-poor-agreement-advice"),
        ],
        Doubt::PosesApart {
            names: [a, b],
            apart,
        } => [
            text!(
                "shots-poses-apart",
                a = a.as_str(),
                b = b.as_str(),
                apart = apart.to_string()
            ),
            text!("shots-poses-apart-advice"),
        ],
    }
}

/// Advises what to do about an excluded shot.
pub fn excluded_advice(why: &Excluded) -> String {
    match why {
        Excluded::WrongPose { .. } | Excluded::Contradicts { .. } | Excluded::LookedPast { .. } => {
            text!("shots-excluded-advice")
        }
        Excluded::OverlapsNone => text!("shots-overlaps-none-advice"),
        Excluded::PartMoved { .. } => text!("shots-part-moved-advice"),
    }
}

/// Returns the label of a traceability field.
pub fn traced(name: &str) -> String {
    match name {
        "serial" => text!("inspect-serial"),
        "order" => text!("inspect-order"),
        "operator" => text!("inspect-operator"),
        name => name.to_owned(),
    }
}

/// Returns the name of a recipe, marked if it was modified; the name itself is not translated.
pub fn recipe_label(label: &RecipeLabel) -> String {
    let name = recipe_name(&label.name);
    if label.is_changed {
        text!("results-recipe-modified", name = name)
    } else {
        name
    }
}

/// Returns the name of a recipe: a text for the paper's, else what the user named it.
pub fn recipe_name(name: &str) -> String {
    match name {
        AS_IN_THE_PAPER => text!("results-recipe-as-in-the-paper"),
        name => name.to_owned(),
    }
}

/// Returns the name of an object that is not enrolled but may hang in the simulated cell.
pub(crate) fn object(kind: ObjectKind) -> String {
    match kind {
        ObjectKind::Hood => text!("results-object-hood"),
        ObjectKind::Wheel => text!("results-object-wheel"),
        ObjectKind::Box => text!("results-object-box"),
        ObjectKind::Chair => text!("results-object-chair"),
        ObjectKind::Board => text!("results-object-board"),
        ObjectKind::Ladder => text!("results-object-ladder"),
        ObjectKind::Stool => text!("results-object-stool"),
        ObjectKind::Bucket => text!("results-object-bucket"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{
        rigid::PoseDelta,
        units::{Metres, Radians},
    };
    use inspection::fixtures::{rejections, unrecognisables};
    use stages::fixtures::{FREEDOMS, pose_errors};

    /// Checks that the window gives the library's advice, or advice of its own for the library's command.
    fn check_advice(own: &str, of_library: &str) {
        let names_command = |advice: &str| advice.contains("--") || advice.contains("partsight");
        assert!(!names_command(own), "{own}");
        if !names_command(of_library) {
            assert_eq!(own, of_library);
        }
    }

    #[test]
    fn in_english_the_window_says_what_the_library_says() {
        for why in rejections() {
            assert_eq!(rejection(&why), why.to_string());
            check_advice(&rejection_advice(&why), &why.advice());
        }
        for why in unrecognisables() {
            assert_eq!(unrecognisable(&why), why.to_string());
            check_advice(&unrecognisable_advice(&why), &why.advice());
        }
        for error in pose_errors() {
            assert_eq!(pose_error(&error), error.to_string());
            assert_eq!(pose_error_advice(&error), error.advice());
        }
        for finding in [
            CellFinding::InPlace,
            CellFinding::PartMoved,
            CellFinding::CameraMoved,
            CellFinding::PartOrCameraMoved,
            CellFinding::Noisier,
        ] {
            assert_eq!(cell_finding(finding), finding.describe());
            assert_eq!(cell_finding_advice(finding), finding.advice());
        }
        let mut cell_errors = vec![
            CellViewError::NoFrame,
            CellViewError::Moving {
                frame: 3,
                moved: PoseDelta {
                    shift: Metres(0.0154),
                    rotation: Radians(0.02),
                },
            },
            CellViewError::OtherPart {
                frame: 1,
                overlap: 0.618,
            },
        ];
        let of_pose = |error| CellViewError::Pose { frame: 2, error };
        cell_errors.extend(pose_errors().into_iter().map(of_pose));
        for error in cell_errors {
            assert_eq!(cell_view_error(&error), error.to_string());
            assert_eq!(cell_view_error_advice(&error), error.advice());
        }
        let mut warnings = vec![
            PoseWarning::LittleOverlap {
                overlap: 0.1234,
                needed: 0.25,
            },
            PoseWarning::Ambiguous { ratio: 1.056 },
            PoseWarning::OffScale(OffScale { scale: 1.0512 }),
            PoseWarning::OffScale(OffScale { scale: 0.9512 }),
            PoseWarning::Unsettled { num_iterations: 30 },
        ];
        warnings.extend(FREEDOMS.map(|freedom| PoseWarning::Loose { freedom }));
        for warning in warnings {
            assert_eq!(pose_warning(&warning), warning.to_string());
        }
        for verdict in StoredVerdict::ALL {
            assert_eq!(stored_verdict(verdict), verdict.title());
        }
        for keep in KeepFrames::ALL {
            assert_eq!(keep_frames(keep), keep.title());
        }
        for kind in ObjectKind::ALL {
            assert_eq!(object(kind), kind.name());
        }
        let name = |why: Stopped| why.name().replace('_', " ");
        for why in [
            Stopped::Converged,
            Stopped::BelowTarget,
            Stopped::IterationLimit,
            Stopped::NoProgress,
        ] {
            assert_eq!(stopped(why), name(why));
        }
    }

    #[test]
    fn a_part_that_certainly_does_not_hang_there_is_not_named() {
        let says = |score: f64| {
            rejection(&Rejection::Unknown {
                nearest: "Fender".to_owned(),
                score,
            })
        };
        assert!(!says(0.004).contains("Fender"));
        assert!(says(0.3).contains("Fender"));
    }
}
