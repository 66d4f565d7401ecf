//! Why a part was not accepted, or nothing could be recognised, and what to do about it.
//!
//! In JSON each is an object with its `kind`. Histories store it, so a kind and its fields must keep their names and
//! units.

use super::{mirror::PUT_RIGHT, unsound::CAMERA_RANGE};
use geometry::{
    error::{Advice, Fault},
    units::Metres,
};
use stages::{
    contour::ContourError,
    pose::{FreeMotion, PoseError},
    project::ProjectError,
    segment::NoPart,
    signature::SignatureError,
};

/// Score below which an unknown part is like no enrolled one, and the best match is not named.
const MIN_LIKE_SCORE: f64 = 0.05;

/// Returns whether the best match of an unknown part, with this score, is worth naming.
pub fn is_like(score: f64) -> bool {
    score >= MIN_LIKE_SCORE
}

fn nearest_words(nearest: &str, score: f64) -> String {
    if is_like(score) {
        format!("; the nearest, {nearest}, scores {score:.2}")
    } else {
        String::new()
    }
}

/// Returns how another model differs, without figures that round to zero, and with a semicolon behind; empty if it does
/// not differ visibly.
fn model_differences(relief: Metres, outline: Metres, missing: f64) -> String {
    let is_shown = |length: Metres| length.mm() >= 0.05;
    let mut found = Vec::new();
    if is_shown(relief) {
        found.push(format!("its surface is off by {relief}"));
    }
    if is_shown(outline) {
        let is = if found.is_empty() { "is off " } else { "" };
        found.push(format!("its outline {is}by {outline}"));
    }
    if missing >= 0.0005 {
        found.push(format!("{:.1} % of it is missing", missing * 100.0));
    }
    match found.as_slice() {
        [] => String::new(),
        [one] => format!("{one}; "),
        [one, two] => format!("{one}, and {two}; "),
        [first @ .., last] => format!("{}, and {last}; ", first.join(", ")),
    }
}

/// Why a best guess was not accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Rejection {
    /// The score is too low.
    #[error("the best match, {part}, scores {score:.2}, below the threshold of {threshold:.2}")]
    LowScore {
        /// Best match.
        part: String,
        /// Its score.
        score: f64,
        /// Least score.
        threshold: f64,
    },
    /// Only a piece of it is in sight, and that is too little.
    #[error(
        "only a piece of {part} is in sight ({:.0} % of it hidden, {:.0} % beyond the picture); it scores {score:.2}, below the threshold of {threshold:.2}",
        hidden * 100.0,
        outside * 100.0
    )]
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
    #[error("what may be {part} is hardly in sight: seen nearly edge-on, or cut off on most sides")]
    HardlySeen {
        /// Best match.
        part: String,
        /// Its score.
        score: f64,
    },
    /// A part of the same type, but of another car model.
    #[error(
        "it is like {part}, but not the same: {}another model, the pose is approximate",
        model_differences(*relief, *outline, *missing)
    )]
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
    #[error("it resembles {part}, but is of another make, with other dimensions or another shape")]
    AnotherMake {
        /// The enrolled part of the same type.
        part: String,
        /// Probability that it is of this type, 0..1.
        likeness: f64,
    },
    /// The piece in sight fits nearly as well at another place of the same part.
    #[error(
        "the piece of {part} in sight fits almost equally well at another place of it (lead over that place {margin:.2}, needed \
         {threshold:.2})"
    )]
    AmbiguousPose {
        /// Best match.
        part: String,
        /// Lead of the best pose over the next.
        margin: f64,
        /// Least lead.
        threshold: f64,
    },
    /// What is in sight also fits with the part moved.
    #[error("the pose of {part} is unconstrained by what is in sight: {freedom}")]
    Unconstrained {
        /// Best match.
        part: String,
        /// How the part can move and still fit.
        freedom: FreeMotion,
    },
    /// The pose is too uncertain.
    #[error("the pose of {part} is uncertain by {shift}, and {limit} is allowed")]
    Uncertain {
        /// Best match.
        part: String,
        /// 95 % bound of the translation error.
        #[serde(rename = "shift_m")]
        shift: Metres,
        /// Largest bound that is accepted.
        #[serde(rename = "limit_m")]
        limit: Metres,
    },
    /// Nothing enrolled is like it.
    #[error("unknown: no enrolled part is like it{}", nearest_words(nearest, *score))]
    Unknown {
        /// Best match.
        nearest: String,
        /// Its score.
        score: f64,
    },
    /// Its mirror image is enrolled.
    #[error(
        "it looks like the mirror image of {part} (which scores {score:.2}): the part from the other side of the car"
    )]
    Mirrored {
        /// The part whose mirror image it looks like.
        part: String,
        /// How well the mirror image fits.
        score: f64,
    },
    /// It is enrolled, and the image shows it mirrored.
    #[error(
        "it fits {part} only as its mirror image (which scores {score:.2}), and {part} has no other side: left and \
         right are probably swapped in the image"
    )]
    MirroredImage {
        /// The part that the mirrored image shows.
        part: String,
        /// How well the mirror image fits.
        score: f64,
    },
    /// Another part fits nearly as well.
    #[error(
        "{part} and {other} fit almost equally well (margin {margin:.2}, needed {threshold:.2})"
    )]
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
    /// The paper's matcher ran alone, without a pose.
    #[error(
        "{part} is the nearest outline; the paper's matcher alone cannot tell it from an unknown part"
    )]
    Unconfirmed {
        /// Best match.
        part: String,
    },
    /// It lies outside the range of depth cameras.
    #[error(
        "what may be {part} is {:.2} m from the camera: depth cameras read from {} to {} m",
        depth.0,
        CAMERA_RANGE[0].0,
        CAMERA_RANGE[1].0
    )]
    OutOfRange {
        /// Best match.
        part: String,
        /// Median depth of its points.
        #[serde(rename = "depth_m")]
        depth: Metres,
    },
    /// The points are not in the space of a camera.
    #[error("{:.1} % of the points lie behind the camera, so it is not known where {part} is", share * 100.0)]
    BehindCamera {
        /// Best match.
        part: String,
        /// Share of the scene's points.
        share: f64,
    },
    /// The file is longer than its header announces.
    #[error(
        "{num} bytes follow the last point of the file: it is damaged, and with it what may be {part}"
    )]
    SurplusBytes {
        /// Best match.
        part: String,
        /// Bytes after the last point.
        num: u64,
    },
    /// The pose could not be estimated.
    #[error("no pose was found: {0}")]
    NoPose(#[from] PoseError),
    /// It moves, or moved a moment ago.
    #[error("{part} is not hanging still yet")]
    NotSteady {
        /// Best match.
        part: String,
    },
    /// It hangs still, and too few frames were seen since.
    #[error("{part} hangs still, but only {num_frames} of {needed} frames were inspected since")]
    FewFrames {
        /// Best match.
        part: String,
        /// Frames so far.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
    /// Frames of a scene that does not move have different verdicts.
    #[error("{num_agreeing} of {num_frames} frames accept {part}, but {needed} are needed")]
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
    #[error(
        "the poses of {part} agree in {num_agreeing} of {num_frames} frames, but {needed} are needed"
    )]
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

impl Rejection {
    /// Replaces the names of the parts, for instance by their titles.
    #[must_use]
    pub fn renamed(mut self, word_of: impl Fn(&str) -> String) -> Self {
        let [first, second] = self.names_mut();
        for name in first.into_iter().chain(second) {
            *name = word_of(name);
        }
        self
    }

    fn names_mut(&mut self) -> [Option<&mut String>; 2] {
        match self {
            Self::LowScore { part, .. }
            | Self::Piece { part, .. }
            | Self::HardlySeen { part, .. }
            | Self::AnotherModel { part, .. }
            | Self::AnotherMake { part, .. }
            | Self::AmbiguousPose { part, .. }
            | Self::Unconstrained { part, .. }
            | Self::Uncertain { part, .. }
            | Self::Unknown { nearest: part, .. }
            | Self::Mirrored { part, .. }
            | Self::MirroredImage { part, .. }
            | Self::Unconfirmed { part }
            | Self::OutOfRange { part, .. }
            | Self::BehindCamera { part, .. }
            | Self::SurplusBytes { part, .. }
            | Self::NotSteady { part }
            | Self::FewFrames { part, .. }
            | Self::Undecided { part, .. }
            | Self::PosesApart { part, .. } => [Some(part), None],
            Self::SmallMargin { part, other, .. } => [Some(part), Some(other)],
            Self::NoPose(_) => [None, None],
        }
    }
}

/// Why nothing could be recognised.
#[derive(Clone, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Unrecognisable {
    /// Nothing is enrolled.
    #[error("no part is enrolled in the library")]
    EmptyLibrary,
    /// The program failed at this scene.
    #[error(transparent)]
    Fault(Fault),
    /// Segmentation found no part.
    #[error(transparent)]
    #[serde(untagged)]
    NoPart(#[from] NoPart),
    /// The projection failed.
    #[error(transparent)]
    #[serde(untagged)]
    Project(#[from] ProjectError),
    /// No contour was found.
    #[error(transparent)]
    #[serde(untagged)]
    Contour(#[from] ContourError),
    /// The signature could not be computed.
    #[error(transparent)]
    #[serde(untagged)]
    Signature(#[from] SignatureError),
}

impl Advice for Rejection {
    fn advice(&self) -> String {
        match self {
            Self::LowScore { .. } => {
                "Check that this part is enrolled and that nothing covers it, then capture again".into()
            }
            Self::SmallMargin { .. } => {
                "Turn the part to face the camera and capture again; if both names stand for the same part, \
                 remove one of them from the library"
                    .into()
            }
            Self::Piece {
                hidden, outside, ..
            } => {
                let (is_hidden, is_outside) = (*hidden >= 0.005, *outside >= 0.005);
                let what = match (is_hidden, is_outside) {
                    (true, false) => "Take away what stands in front of the part",
                    (false, true) => "Hang the part further inside the picture",
                    _ => {
                        "Take away what stands in front of the part, or hang it further inside the picture,"
                    }
                };
                format!("{what} and capture again")
            }
            Self::HardlySeen { .. } => {
                "Turn the part to face the camera, all of it inside the picture, and capture again".into()
            }
            Self::AmbiguousPose { .. } | Self::Unconstrained { .. } | Self::Uncertain { .. } => {
                "Move the camera so that it sees a corner or another edge of the part, and capture again".into()
            }
            Self::AnotherModel { part, .. } | Self::AnotherMake { part, .. } => format!(
                "If this one is to be painted too, enrol it as one more reference of {part}"
            ),
            Self::Unknown { .. } => {
                "Enrol the part if it is to be painted; if it is enrolled, turn its face to the camera and capture again".into()
            }
            Self::Mirrored { .. } => {
                "Enrol the part of this side under a name of its own, and do not paint it with the other side's path".into()
            }
            Self::MirroredImage { .. } => format!("Do not move the robot by this image: {PUT_RIGHT}"),
            Self::Unconfirmed { .. } => "Have the pose estimated too, with --pose global".into(),
            Self::OutOfRange { .. } => {
                "Check the unit of the file or of the camera's JSON: lengths are metres; then capture again".into()
            }
            Self::BehindCamera { .. } => {
                "Export the capture in the camera's own frame: x right, y down, z forward".into()
            }
            Self::SurplusBytes { .. } => {
                "Copy or export the file again from the program that made it".into()
            }
            Self::NoPose(error) => error.advice(),
            Self::NotSteady { .. } => "Let the part hang still for a second".into(),
            Self::FewFrames { .. } => "Wait a moment".into(),
            Self::Undecided { .. } => {
                "Wait a moment; if it persists, turn the part's face to the camera and take away what stands \
                 in front of it".into()
            }
            Self::PosesApart { .. } => {
                "Hang the part so that nothing can swing, and wait a moment; if it persists, turn its face to \
                 the camera".into()
            }
        }
    }
}

impl Advice for Unrecognisable {
    fn advice(&self) -> String {
        match self {
            Self::NoPart(error) => error.advice(),
            Self::Project(error) => error.advice(),
            Self::Contour(error) => error.advice(),
            Self::Signature(error) => error.advice(),
            Self::Fault(fault) => fault.advice(),
            Self::EmptyLibrary => "Enrol a part first, in the Enrol workspace or with partsight enrol FILE --name NAME".into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
