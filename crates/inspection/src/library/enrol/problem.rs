//! Warnings about an enrolled part, and errors of enrolling.

use crate::library::Side;
use geometry::error::Advice;
use stages::{
    pose::FreeMotion,
    reference::ReferenceError,
    segment::{BackgroundSign, NoPart},
};

/// A warning about an enrolled part.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EnrolWarning {
    /// The part reaches the border of the field of view.
    #[error("the part reaches the border of the view, so some of it may be missing")]
    TouchesEdge,
    /// The chosen surface may be background.
    #[error("this may be background: {0}")]
    Background(BackgroundSign),
    /// Some of the selected points lie on a plane that segmentation removed.
    #[error(
        "{percent} % of what is kept lies on the wall, the floor or another plane that was removed"
    )]
    OnBackground {
        /// Share of the selected points, rounded.
        percent: u8,
    },
    /// The selected points are in separate pieces.
    #[error("{percent} % of what is kept lies apart from the rest")]
    Apart {
        /// Share of the selected points outside the largest piece, rounded.
        percent: u8,
    },
    /// Not even an inspection of this same view would accept it.
    #[error(
        "there is too little of the part to recognise it by: this same view would score {score:.2}, and {needed:.2} is \
         needed"
    )]
    TooLittle {
        /// Score of the reference in its own standard view, 0..1.
        score: f64,
        /// Score that inspections need.
        needed: f64,
    },
    /// The shape does not fix the pose.
    #[error("the shape does not fix the pose: {0}")]
    Unconstrained(FreeMotion),
    /// The part looks the same in another pose.
    #[error(
        "the part looks the same turned by {degrees}°, so its pose cannot be told from that one"
    )]
    Symmetric {
        /// Angle between the two poses, rounded.
        degrees: u16,
    },
    /// The part is as open from both sides, or bulges against the winding of an open sheet.
    #[error("it is not clear which side of the part is the outside")]
    SideUnclear {
        /// The two sides of its thinnest extent.
        sides: [Side; 2],
    },
    /// The surface of a scan continues beyond the view of every frame.
    #[error(
        "{percent} % of the scanned surface's outline is where the view of every frame ends: the part may continue \
         there"
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
            Self::TooLittle { .. } => {
                "Enrol more of the part: move the camera back, or enrol several frames as a scan"
            }
            Self::Unconstrained(_) => {
                "Enrol more of the part, so that corners or openings constrain its pose"
            }
            Self::Symmetric { .. } => {
                "Paint it with a path that suits both poses, or hang it so that it cannot be turned"
            }
            Self::SideUnclear { sides } => {
                let [one, other] = sides.map(Side::name);
                return format!("Give the side to be painted: --side {one} or --side {other}");
            }
            Self::GoesOnUnseen { .. } => {
                "Add frames that show the missing sides, then enrol it again"
            }
        }
        .into()
    }
}

/// Why a part could not be enrolled.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EnrolError {
    /// There is no part in the scene.
    #[error(transparent)]
    NoPart(#[from] NoPart),
    /// The surface found is more likely background.
    #[error("the surface found may be background: {0}")]
    Background(BackgroundSign),
    /// There is no surface with this number.
    #[error("the scene has no surface {wanted}; {found} were found")]
    NoSuchSurface {
        /// The number asked for, from 1.
        wanted: usize,
        /// Number of surfaces found.
        found: usize,
    },
    /// The cloud cannot be used as a reference.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// The cloud has too few points.
    #[error("the cloud has {found} points, at least {needed} are needed")]
    TooFewPoints {
        /// Number of finite points.
        found: usize,
        /// Minimum number of points.
        needed: usize,
    },
    /// Too few points were selected.
    #[error("{found} points are kept, at least {needed} are needed")]
    TooFewKept {
        /// Number of selected points.
        found: usize,
        /// Minimum number of points.
        needed: usize,
    },
    /// No frame of a scan shows a part.
    #[error("no part was found in any of the {num_frames} frames")]
    NoPartInScan {
        /// Number of frames used.
        num_frames: usize,
    },
    /// The mesh has no surface.
    #[error("the mesh of {num_triangles} triangles has no area")]
    NoArea {
        /// Number of triangles.
        num_triangles: usize,
    },
}

impl Advice for EnrolError {
    fn advice(&self) -> String {
        match self {
            Self::NoPart(error) => error.advice(),
            Self::Reference(error) => error.advice(),
            Self::Background(_) => {
                "Select the surface that is the part with --segment N, or choose it in the window's Enrol \
                 workspace".into()
            }
            Self::NoSuchSurface { .. } => "Choose one of those found".into(),
            Self::TooFewPoints { .. } => {
                "Capture the part from closer, or export the cloud with more points".into()
            }
            Self::TooFewKept { .. } => "Take back what was dropped: Undo, Reset, or Add".into(),
            Self::NoPartInScan { .. } => {
                "Look at the fused cloud (partsight scan DIR --out scan.ply), and capture the part at least 10 cm in \
                 front of the background".into()
            }
            Self::NoArea { .. } => "Export the mesh again with its faces".into(),
        }
    }
}
