//! The check of a part's surface as a part of the line of JSON.

use serde::{Deserialize, Serialize};

use inspection::pipeline::{JudgedRegion, SurfaceCheck, SurfaceVerdict};
use stages::deviation::RegionKind;

/// The check of a part's surface. Later versions only add fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceLine {
    /// The verdict.
    pub verdict: SurfaceVerdict,
    /// Why it is not judged.
    #[serde(default)]
    pub reason: Option<String>,
    /// The same in a form for programs.
    #[serde(default)]
    pub reason_kind: Option<String>,
    /// What was measured; `None` if it could not be.
    #[serde(default)]
    pub measured: Option<MeasuredLine>,
    /// The regions that deviate, the clearest first.
    #[serde(default)]
    pub regions: Vec<RegionLine>,
}

/// Figures of a measured surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredLine {
    /// Number of frames averaged.
    pub frames: usize,
    /// Share of the side of the part that was judged.
    pub seen: f64,
    /// Noise of the average over a patch, metres.
    pub noise_m: f64,
    /// What of it differs between frames, metres.
    pub noise_between_m: Option<f64>,
    /// How many times its noise an average must exceed.
    pub limit_factor: f64,
    /// Width and depth of dents that are found in 95 of 100 cases, metres.
    pub smallest_m: Vec<[f64; 2]>,
}

/// A region that deviates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionLine {
    /// What it is.
    pub kind: RegionKind,
    /// What follows from it.
    pub verdict: SurfaceVerdict,
    /// Name of its zone.
    pub zone: Option<String>,
    /// Area, square metres.
    pub area_m2: f64,
    /// How far outside of the reference the surface lies where that is most, metres; below 0 for a dent.
    pub deviation_m: Option<f64>,
    /// What such a deviation may be, metres.
    pub limit_m: f64,
    /// Its standard deviation, metres.
    pub noise_m: f64,
    /// Middle, part space, metres.
    pub centre_m: [f64; 3],
}

impl SurfaceLine {
    /// The line of a check.
    pub fn of(check: &SurfaceCheck) -> Self {
        let measured = check.deviation.as_ref().map(|deviation| MeasuredLine {
            frames: deviation.num_frames,
            seen: deviation.seen,
            noise_m: deviation.noise.0,
            noise_between_m: deviation.noise_between.map(|noise| noise.0),
            limit_factor: deviation.limit_factor,
            smallest_m: (deviation.smallest.iter())
                .map(|dent| [dent.width.0, dent.depth.0])
                .collect(),
        });
        Self {
            verdict: check.verdict,
            reason: check.not_judged.map(|why| why.to_string()),
            reason_kind: check.not_judged.map(|why| why.kind().to_owned()),
            measured,
            regions: check.regions.iter().map(RegionLine::of).collect(),
        }
    }
}

impl RegionLine {
    fn of(judged: &JudgedRegion) -> Self {
        let region = &judged.region;
        Self {
            kind: region.kind,
            verdict: judged.verdict,
            zone: judged.zone.clone(),
            area_m2: region.area_m2,
            deviation_m: region.off.map(|off| off.0),
            limit_m: judged.limit.0,
            noise_m: region.noise.0,
            centre_m: region.centre.coords.into(),
        }
    }
}
