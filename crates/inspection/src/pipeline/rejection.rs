//! Why a part was not accepted, or nothing could be recognised, and what to do about it.
//!
//! In JSON each is an object with its `kind`. Histories store it, so a kind and its fields must keep their names and
//! units. The texts of a kind are in `language/*/refusal.ftl` of the crate `texts`, with the fields as variables.

use geometry::{
    error::Fault,
    units::{Metres, Radians},
};
use stages::{
    contour::ContourError,
    pose::{FreeMotion, OffScale, PoseError},
    project::ProjectError,
    segment::NoPart,
    signature::SignatureError,
};
use texts::{Described, Message};

/// Range of depth cameras. A part outside it results from a wrong unit or damaged numbers.
pub(super) const CAMERA_RANGE: [Metres; 2] = [Metres(0.1), Metres(20.0)];

/// Score below which an unknown part is like no enrolled one, and the best match is not named.
const MIN_LIKE_SCORE: f64 = 0.05;

/// Returns whether the best match of an unknown part, with this score, is worth naming.
pub(super) fn is_like(score: f64) -> bool {
    score >= MIN_LIKE_SCORE
}

/// Why a best guess was not accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Rejection {
    /// The score is too low.
    LowScore {
        /// Best match.
        part: String,
        /// Its score.
        score: f64,
        /// Least score.
        threshold: f64,
    },
    /// Only a piece of it is in sight, and that is too little.
    Piece {
        /// Best match.
        part: String,
        /// Its score.
        score: f64,
        /// Least score.
        threshold: f64,
        /// Share hidden by something nearer.
        hidden: f64,
        /// Share beyond the picture.
        outside: f64,
    },
    /// Too little of it would be in sight to tell it from something else.
    HardlySeen {
        /// Best match.
        part: String,
        /// Its score.
        score: f64,
    },
    /// A part of the same type, but of another car model.
    AnotherModel {
        /// Best match.
        part: String,
        /// Root mean square deviation of patches of the surface.
        #[serde(rename = "relief_m")]
        relief: Metres,
        /// Root mean square deviation of stretches of the outline.
        #[serde(rename = "outline_m")]
        outline: Metres,
        /// Share of the reference that is missing, 0..1.
        missing: f64,
    },
    /// Of its type, but of another make: its dimensions or its shape differ.
    AnotherMake {
        /// The enrolled part of the same type.
        part: String,
        /// Probability that it is of this type, 0..1.
        likeness: f64,
    },
    /// The piece in sight fits nearly as well at another place of the same part.
    AmbiguousPose {
        /// Best match.
        part: String,
        /// Lead of the best pose over the next.
        margin: f64,
        /// Least lead.
        threshold: f64,
    },
    /// What is in sight also fits with the part moved.
    Unconstrained {
        /// Best match.
        part: String,
        /// How the part can move and still fit.
        freedom: FreeMotion,
    },
    /// It fits badly and has another size than its reference: the camera's numbers are wrong, or it is another make.
    OffScale {
        /// Best match.
        part: String,
        /// How much larger or smaller.
        #[serde(flatten)]
        off: OffScale,
    },
    /// The pose is too uncertain.
    Uncertain {
        /// Best match.
        part: String,
        /// 95 % bound of the translation error.
        #[serde(rename = "shift_m")]
        shift: Metres,
        /// Largest bound that is accepted.
        #[serde(rename = "limit_m")]
        limit: Metres,
        /// True if most of it is how far the frames of a scan disagree about where the part is.
        #[serde(default)]
        frames_disagree: bool,
    },
    /// Nothing enrolled is like it.
    Unknown {
        /// Best match.
        nearest: String,
        /// Its score.
        score: f64,
    },
    /// Its mirror image is enrolled.
    Mirrored {
        /// The part whose mirror image it looks like.
        part: String,
        /// How well the mirror image fits.
        score: f64,
    },
    /// It is enrolled, and the image shows it mirrored.
    MirroredImage {
        /// The part that the mirrored image shows.
        part: String,
        /// How well the mirror image fits.
        score: f64,
    },
    /// Only one half of it is enrolled, and this may be the other one.
    OtherHalf {
        /// The part whose enrolled half looks like its mirror image.
        part: String,
        /// How well the mirror image fits.
        score: f64,
    },
    /// Another part fits nearly as well.
    SmallMargin {
        /// Best match.
        part: String,
        /// Next match.
        other: String,
        /// Lead.
        margin: f64,
        /// Least lead.
        threshold: f64,
    },
    /// It hangs in place of another part.
    WrongPart {
        /// What hangs there.
        part: String,
        /// What should hang there.
        expected: String,
    },
    /// It hangs beside all the parts that are expected.
    NotExpected {
        /// What hangs there.
        part: String,
    },
    /// It hangs at a place where it is not expected, and not where it is.
    ExpectedElsewhere {
        /// What hangs there.
        part: String,
        /// The place where it hangs.
        place: String,
        /// The place where it is expected.
        expected_at: String,
    },
    /// It may not hang at the place where it hangs.
    WrongPlace {
        /// What hangs there.
        part: String,
        /// The place.
        place: String,
    },
    /// It hangs at no place of the rack.
    BesidePlaces {
        /// What hangs there.
        part: String,
        /// The nearest place.
        place: String,
        /// Distance of its middle from there.
        #[serde(rename = "distance_m")]
        distance: Metres,
    },
    /// It hangs at its place otherwise than it may.
    Turned {
        /// What hangs there.
        part: String,
        /// The place.
        place: String,
        /// Turn from the nearest orientation that it may have.
        #[serde(rename = "turn_rad")]
        turn: Radians,
        /// Largest turn that is allowed.
        #[serde(rename = "limit_rad")]
        limit: Radians,
    },
    /// It is refused for its shape, and goes on outside the work volume, where nothing is looked at.
    CutByVolume {
        /// Best match.
        part: String,
    },
    /// The paper's matcher ran alone, without a pose.
    Unconfirmed {
        /// Best match.
        part: String,
    },
    /// It lies outside the range of depth cameras.
    OutOfRange {
        /// Best match.
        part: String,
        /// Median depth of its points.
        #[serde(rename = "depth_m")]
        depth: Metres,
    },
    /// The points are not in the space of a camera.
    BehindCamera {
        /// Best match.
        part: String,
        /// Share of the scene's points.
        share: f64,
    },
    /// The file is longer than its header announces.
    SurplusBytes {
        /// Best match.
        part: String,
        /// Bytes after the last point.
        num: u64,
    },
    /// The pose could not be estimated.
    NoPose(#[from] PoseError),
    /// It moves, or moved a moment ago.
    NotSteady {
        /// Best match.
        part: String,
    },
    /// A line carries it, and too few frames have shown the whole of it so far.
    Passing {
        /// Best match.
        part: String,
        /// Frames so far.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
    /// The line is too fast for the camera's exposure.
    Smeared {
        /// Best match.
        part: String,
        /// Way of the part during an exposure.
        #[serde(rename = "smear_m")]
        smear: Metres,
        /// Greatest way that is accepted.
        #[serde(rename = "limit_m")]
        limit: Metres,
    },
    /// It hangs still, and too few frames were seen since.
    FewFrames {
        /// Best match.
        part: String,
        /// Frames so far.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
    /// It is not judged: the computer inspects too few of the camera's frames.
    TooSlow {
        /// Best match.
        part: String,
        /// Frames inspected in about a second.
        num_inspected: usize,
        /// Frames that the camera delivered in that time.
        num_frames: usize,
    },
    /// Frames of a scene that does not move have different verdicts.
    Undecided {
        /// The part that most frames name.
        part: String,
        /// Frames that accept it.
        num_agreeing: usize,
        /// Frames in all.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
    /// Frames of a still scene put the part in different places.
    PosesApart {
        /// The part.
        part: String,
        /// Frames whose poses lie together.
        num_agreeing: usize,
        /// Frames in all.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
}

/// Why nothing could be recognised.
#[derive(Clone, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Unrecognisable {
    /// Nothing is enrolled.
    EmptyLibrary,
    /// The program failed at this scene.
    Fault(Fault),
    /// Segmentation found no part.
    #[serde(untagged)]
    NoPart(#[from] NoPart),
    /// The projection failed.
    #[serde(untagged)]
    Project(#[from] ProjectError),
    /// No contour was found.
    #[serde(untagged)]
    Contour(#[from] ContourError),
    /// The signature could not be computed.
    #[serde(untagged)]
    Signature(#[from] SignatureError),
}

impl Rejection {
    /// The part of which it is the mirror image, if it is one.
    pub(super) fn image_of(&self) -> Option<&str> {
        match self {
            Self::Mirrored { part, .. }
            | Self::MirroredImage { part, .. }
            | Self::OtherHalf { part, .. } => Some(part),
            _ => None,
        }
    }

    /// True if only the rack speaks against the part.
    pub fn is_by_rack(&self) -> bool {
        matches!(
            self,
            Self::WrongPlace { .. } | Self::BesidePlaces { .. } | Self::Turned { .. }
        )
    }
}

impl Described for Rejection {
    fn message(&self) -> Message {
        let message = Message::tagged("refusal", "kind", self);
        match self {
            Self::NoPose(error) => message.caused_by(error.message()),
            Self::Unknown { score, .. } => message.with("like", is_like(*score)),
            Self::OutOfRange { .. } => message
                .with("from", CAMERA_RANGE[0].0)
                .with("to", CAMERA_RANGE[1].0),
            _ => message,
        }
    }
}

texts::display!(Rejection);
texts::described!(Unrecognisable: "refusal" by "kind");

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::error::Advice as _;

    #[test]
    fn the_best_match_of_something_unknown_is_named_only_if_it_is_like_it() {
        let why = |score| {
            let unknown = Rejection::Unknown {
                nearest: "back_bumper".into(),
                score,
            };
            unknown.to_string()
        };
        assert_eq!(why(0.004), "unknown: no enrolled part is like it");
        assert_eq!(
            why(0.3),
            "unknown: no enrolled part is like it; the nearest, back_bumper, scores 0.30"
        );
    }

    #[test]
    fn figures_that_round_to_zero_are_no_reasons() {
        let other = |relief, outline, missing| {
            let model = Rejection::AnotherModel {
                part: "door".into(),
                relief: Metres::from_mm(relief),
                outline: Metres::from_mm(outline),
                missing,
            };
            let why = model.to_string();
            let why = why.strip_prefix("it is like door, but not the same: ");
            why.expect("the part").to_owned()
        };
        let end = "another model, the pose is approximate";
        assert_eq!(
            other(4.2, 11.9, 0.0123),
            format!(
                "its surface is off by 4.2 mm, its outline by 11.9 mm, and 1.2 % of it is missing; {end}"
            )
        );
        assert_eq!(
            other(4.2, 11.9, 0.0),
            format!("its surface is off by 4.2 mm, and its outline by 11.9 mm; {end}")
        );
        assert_eq!(
            other(0.01, 11.9, 0.0004),
            format!("its outline is off by 11.9 mm; {end}")
        );
        assert_eq!(other(0.0, 0.0, 0.0), end);
    }

    #[test]
    fn a_piece_that_nothing_hides_is_not_said_to_stand_behind_something() {
        let advice = |hidden, outside| {
            let piece = Rejection::Piece {
                part: "door".into(),
                score: 0.7,
                threshold: 0.9,
                hidden,
                outside,
            };
            piece.advice()
        };
        assert_eq!(
            advice(0.0, 0.4),
            "Hang the part further inside the picture and capture again"
        );
        assert_eq!(
            advice(0.4, 0.0),
            "Take away what stands in front of the part and capture again"
        );
        assert!(advice(0.2, 0.2).contains("or hang it further inside"));
    }
}
