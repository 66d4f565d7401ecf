//! What may be odd about an enrolled part, and why nothing could be enrolled.

use crate::{
    error::Advice,
    stages::{
        pose::FreeMotion,
        reference::ReferenceError,
        segment::{BackgroundSign, NoPart},
    },
};

/// Something odd about an enrolled part.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EnrolWarning {
    /// The part reaches the border of the field of view.
    #[error("the part reaches the border of the view, so some of it may be missing")]
    TouchesEdge,
    /// What a person chose may be background.
    #[error("this may be background: {0}")]
    Background(BackgroundSign),
    /// Some of what a person kept lies on a plane that was removed.
    #[error(
        "{percent} % of what is kept lies on the wall, the floor or another plane that was removed"
    )]
    OnBackground {
        /// Share of the points kept, rounded.
        percent: u8,
    },
    /// What a person kept is in pieces that do not touch.
    #[error("{percent} % of what is kept lies apart from the rest")]
    Apart {
        /// Share of the points kept that are not in the largest piece, rounded.
        percent: u8,
    },
    /// The shape does not fix the pose.
    #[error("the shape does not fix the pose: {0}")]
    Unconstrained(FreeMotion),
    /// The part looks the same in another pose.
    #[error(
        "the part looks the same turned by {degrees}°, so its pose cannot be told from that one"
    )]
    Symmetric {
        /// Between the two poses, rounded.
        degrees: u16,
    },
    /// The surface of a scan goes on where no frame looked.
    #[error(
        "{percent} % of the scanned surface's outline is where the view of every frame ends: the part may go on there"
    )]
    GoesOnUnseen {
        /// Share of the outline, rounded.
        percent: u8,
    },
}

impl Advice for EnrolWarning {
    fn advice(&self) -> String {
        match self {
            Self::TouchesEdge => "Move the camera back or centre the part, then enrol it again",
            Self::Background(_) => "Check the picture, and take the part instead if it is not",
            Self::OnBackground { .. } => {
                "Drop what is background: an inspection removes it and compares the rest"
            }
            Self::Apart { .. } => "Drop what does not belong to the part",
            Self::Unconstrained(_) => {
                "Enrol more of the part, so that corners or openings constrain its pose"
            }
            Self::Symmetric { .. } => {
                "Paint it with a path that suits both poses, or hang it so that it cannot be turned"
            }
            Self::GoesOnUnseen { .. } => {
                "Add frames that show the missing sides, then enrol it again"
            }
        }
        .into()
    }
}

/// Why nothing could be enrolled.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EnrolError {
    /// No part in the scene.
    #[error(transparent)]
    NoPart(#[from] NoPart),
    /// The surface that would be taken is more likely background.
    #[error("the surface found may be background: {0}")]
    Background(BackgroundSign),
    /// There are not that many surfaces.
    #[error("the scene has no surface {wanted}; {found} were found")]
    NoSuchSurface {
        /// Number asked for, from 1.
        wanted: usize,
        /// Surfaces found.
        found: usize,
    },
    /// The cloud is no reference.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// Too few points.
    #[error("the cloud has {found} points, at least {needed} are needed")]
    TooFewPoints {
        /// Finite points.
        found: usize,
        /// Least number of points.
        needed: usize,
    },
    /// Too few points are left of what was corrected.
    #[error("{found} points are kept, at least {needed} are needed")]
    TooFewKept {
        /// Points kept.
        found: usize,
        /// Least number of points.
        needed: usize,
    },
    /// No frame of a scan shows a part.
    #[error("no part was found in any of the {num_frames} frames")]
    NoPartInScan {
        /// Frames that were used.
        num_frames: usize,
    },
    /// A mesh without a surface.
    #[error("the mesh of {num_triangles} triangles has no area")]
    NoArea {
        /// Triangles of the mesh.
        num_triangles: usize,
    },
}

impl Advice for EnrolError {
    fn advice(&self) -> String {
        match self {
            Self::NoPart(error) => error.advice(),
            Self::Reference(error) => error.advice(),
            Self::Background(_) => {
                "Say which surface is the part with --segment N, or choose it in the window's Enrol workspace".into()
            }
            Self::NoSuchSurface { .. } => "Choose one of those found".into(),
            Self::TooFewPoints { .. } => {
                "Capture the part from nearer, or export the cloud with more points".into()
            }
            Self::TooFewKept { .. } => "Take back what was dropped: Undo, Reset, or Add".into(),
            Self::NoPartInScan { .. } => {
                "Look at what was put together, partsight scan DIR --out scan.ply, and capture the part at least 10 cm before the background".into()
            }
            Self::NoArea { .. } => "Export the mesh again with its faces".into(),
        }
    }
}
