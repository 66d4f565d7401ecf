//! How well a pose fits.

/// Figures of a fit.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Fit {
    /// Mean squared distance of all source points to their closest target points (eq. 12), square metres.
    pub e_m2: f64,
    /// Root mean square distance of the inliers, metres.
    pub rms_m: f64,
    /// Share of the source points that lie on the target within tolerance, 0..1.
    pub overlap: f64,
    /// What the camera says of the target at this pose; `None` without a camera.
    pub sight: Option<Sight>,
}

/// What a camera sees of the target where it should be, as shares of the points that face the camera in the picture.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sight {
    /// The surface is where it should be.
    pub confirmed: f64,
    /// The camera sees through it to something behind: the surface is not there.
    pub missing: f64,
    /// Something else is before it.
    pub hidden: f64,
    /// No reading there.
    pub unknown: f64,
}
