//! Why frames cannot be assembled into a scan, and what to do about it.

use geometry::{error::Advice, units::Metres};

/// The most shots of a scan: the set of shots that saw a point is kept in 64 bits.
pub(super) const MAX_SHOTS: usize = 64;

/// Why frames cannot be assembled into a scan.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
pub enum ScanError {
    /// There is one frame, or none.
    #[error("a scan needs at least 2 frames, found {found}")]
    #[advice(match found {
        1 => "Add frames from other sides, or use the one frame without --scan",
        _ => "Give the folder that holds the frames",
    })]
    TooFewShots {
        /// Frames given.
        found: usize,
    },
    /// There are more frames than `seen_by` has bits.
    #[error("a scan takes at most {MAX_SHOTS} frames, found {found}")]
    #[advice = "Leave out frames that show the same as others"]
    TooManyShots {
        /// Frames given.
        found: usize,
    },
    /// A cloud has no rows and columns.
    #[error(
        "{name}: the points have no rows and columns, so it is not known what the camera saw as empty"
    )]
    #[advice = "Record depth images, or clouds that keep the camera's rows and columns (organised PCD)"]
    NoPicture {
        /// The name of the frame.
        name: String,
    },
    /// A frame has too few readings to be registered.
    #[error("{name}: the frame has {found} usable readings, at least {needed} are needed")]
    #[advice = "Leave the frame out, or capture it again with the camera uncovered and 0.6 to 3 m from the part"]
    TooFewReadings {
        /// The name of the frame.
        name: String,
        /// Readings on a surface.
        found: usize,
        /// The fewest that are needed.
        needed: usize,
    },
    /// No two frames fit together.
    #[error("no two of the {found} frames agree: {}", names.join(", "))]
    #[advice = "Check that each pose belongs to its frame, that they are poses of the camera in metres (for poses of the flange give \
               base_from_flange), and that the part stood still"]
    NothingAgrees {
        /// Frames given.
        found: usize,
        /// Their names.
        names: Vec<String>,
    },
    /// Too few of the frames fit together to tell which of the poses are wrong.
    #[error(
        "the frames contradict one another: {} fit together, but {} do not fit them, and it needs two thirds of the frames \
         to tell which are wrong",
        agree.join(", "),
        others.join(", ")
    )]
    #[advice = "Check that each pose belongs to its frame and that all frames show the same part, which stood still; leave the wrong frames out, or capture them again"]
    NoMajority {
        /// Names of the frames that fit together.
        agree: Vec<String>,
        /// Names of the others.
        others: Vec<String>,
    },
    /// The frames show two surfaces that share nothing, such as the two faces of a sheet.
    #[error(
        "{} and {} show no surface in common, so their poses cannot be checked against each other",
        these.join(", "),
        others.join(", ")
    )]
    #[advice = "Add frames from between that show surface of both, or let the floor or the hanger be in view of all of them; or scan each side by itself"]
    Apart {
        /// Names of the frames that show one surface.
        these: Vec<String>,
        /// Names of the others.
        others: Vec<String>,
    },
    /// Two frames contradict each other, and no other frame tells which of them is wrong.
    #[error(
        "{} and {} contradict each other: one looks past {:.1} % of what both should see{}",
        names[0],
        names[1],
        share * 100.0,
        apart.map_or_else(String::new, |apart| format!("; they fit together if one is moved by {apart}"))
    )]
    #[advice = "Check that each pose belongs to its frame and that nothing moved between the frames; leave the wrong frame out, or add one \
               that shows the same edges and so tells which it is"]
    Contradiction {
        /// The two frames.
        names: [String; 2],
        /// Share of what both see that one of them looks past, 0..1.
        share: f64,
        /// Distance by which moving one of them resolves it, if that was found.
        apart: Option<Metres>,
    },
    /// No two frames see the same surface.
    #[error(
        "no two of the {found} frames overlap, so their poses cannot be checked: {}",
        names.join(", ")
    )]
    #[advice = "Check that each pose belongs to its frame and is a pose of the camera in metres, or add frames between these that show surface of both"]
    NothingOverlaps {
        /// Frames given.
        found: usize,
        /// Their names.
        names: Vec<String>,
    },
    /// The frames fit together if each pose is inverted.
    #[error(
        "the poses look inverted: the frames fit together if each is read as camera_from_world"
    )]
    #[advice = "Write the poses of the camera in the robot's base frame: invert each matrix of the file"]
    PosesInverted,
    /// Only one frame shows the part that is to be inspected.
    #[error("only one of the {found} frames shows the part: {name}")]
    #[advice = "Add frames that show the part from other sides, or inspect this frame by itself"]
    PartInOneFrame {
        /// Frames used.
        found: usize,
        /// The frame that shows it.
        name: String,
    },
    /// The caller cancelled.
    #[error("the scan was cancelled")]
    #[advice = "Start it again"]
    Cancelled,
}
