//! Every parameter of a [`Recipe`](crate::pipeline::Recipe): one table drives the whole panel.

use super::parameters::{Choice, Group, Kind, Number, Parameter, Place, Unit};
use crate::{
    pipeline::PoseChoice,
    stages::{pose::PoseMethod, rank::Matcher},
    units::{Metres, Radians},
};

/// Numbers of rays: the transforms want powers of two.
const NUM_RAYS: [usize; 6] = [64, 128, 256, 512, 1024, 2048];

/// Ways to the pose, as the options name them.
const POSES: [PoseChoice; 3] = [
    PoseChoice::By(PoseMethod::Global),
    PoseChoice::By(PoseMethod::Icp),
    PoseChoice::Skip,
];

/// A number stored as it is shown but for the unit.
macro_rules! number {
    ($key:literal, $name:literal, $group:ident, $place:ident, $unit:ident, $range:expr, $decimals:literal,
     $get:expr, $set:expr, $help:literal) => {
        Parameter {
            key: $key,
            name: $name,
            help: $help,
            group: Group::$group,
            place: Place::$place,
            kind: Kind::Number(Number {
                unit: Unit::$unit,
                range: $range,
                decimals: $decimals,
                get: $get,
                set: $set,
            }),
        }
    };
}

/// All parameters, group by group in the order of the flow.
#[rustfmt::skip]
pub const PARAMETERS: [Parameter; 31] = [
    number!("segment.plane_distance", "Plane distance", Segmentation, Front, Millimetres, [1.0, 50.0], 1,
        |r| r.segment.plane_distance.0, |r, v| r.segment.plane_distance = Metres(v),
        "The paper's d_t: a point closer than this (plus the noise) to a background plane belongs to it. Raising it eats what is near the wall."),
    number!("segment.noise_at_1m", "Depth noise at 1 m", Segmentation, Fold, Millimetres, [0.0, 20.0], 2,
        |r| r.segment.noise_at_1m.0, |r, v| r.segment.noise_at_1m = Metres(v),
        "Standard deviation of the depth at 1 m; it grows with the depth squared. Used until a plane shows the real one."),
    number!("segment.noise_factor", "Noise factor", Segmentation, Fold, None, [2.0, 6.0], 1,
        |r| r.segment.noise_factor, |r, v| r.segment.noise_factor = v,
        "How many standard deviations of noise still belong to a plane. Raising it eats what is near the wall, lowering it leaves specks of the wall."),
    number!("segment.good_sample_probability", "Good-sample probability", Segmentation, Fold, None, [0.9, 0.9999], 4,
        |r| r.segment.good_sample_probability, |r, v| r.segment.good_sample_probability = v,
        "The paper's p in eq. 1: the probability that at least one random sample is good. Raising it costs time."),
    number!("segment.max_planes", "Planes at most", Segmentation, Fold, None, [0.0, 4.0], 0,
        |r| r.segment.max_planes as f64, |r, v| r.segment.max_planes = v.round() as usize,
        "Most background planes to take away: wall, floor and one more. Raising it costs time, and may take away a flat part."),
    number!("segment.link_distance", "Link distance", Segmentation, Front, Millimetres, [5.0, 100.0], 1,
        |r| r.segment.link_distance.0, |r, v| r.segment.link_distance = Metres(v),
        "Neighbouring points further apart than this (plus the noise) are not connected. Raising it joins what hangs close to the part, lowering it tears the part."),
    number!("segment.min_part_area", "Least part area", Segmentation, Fold, SquareCentimetres, [10.0, 10_000.0], 0,
        |r| r.segment.min_part_area, |r, v| r.segment.min_part_area = v,
        "Less surface than this, seen from the camera, is no part. Raising it refuses small parts, lowering it takes clutter for parts."),
    number!("segment.seed", "Seed of the planes", Segmentation, Fold, None, [0.0, 999_999.0], 0,
        |r| r.segment.seed as f64, |r, v| r.segment.seed = v.round() as u64,
        "Seed of the random samples. Another seed draws other samples and costs nothing: a verdict that changes with it stands on weak ground."),
    number!("project.pixel", "Pixel", BinaryImage, Front, Millimetres, [1.0, 20.0], 1,
        |r| r.project.pixel.0, |r, v| r.project.pixel = Metres(v),
        "Side of a pixel of the binary image. Below the spacing of the points gaps appear; raising it blurs the outline."),
    number!("project.closed_gap", "Gap closed up to", BinaryImage, Front, Millimetres, [0.0, 50.0], 1,
        |r| r.project.closed_gap.0, |r, v| r.project.closed_gap = Metres(v),
        "Gaps up to this width are closed. Raising it fills narrow real openings."),
    number!("contour.min_opening_area", "Least opening", Contour, Fold, SquareCentimetres, [0.0, 1000.0], 0,
        |r| r.contour.min_opening_area, |r, v| r.contour.min_opening_area = v,
        "Openings smaller than this are dropouts of the sensor and are left out. Raising it loses real openings."),
    Parameter {
        key: "signature.num_rays",
        name: "Rays",
        help: "Rays around the outline. More cost ranking time and resolve smaller detail.",
        group: Group::Contour,
        place: Place::Front,
        kind: Kind::Choice(Choice {
            options: &["64", "128", "256", "512", "1024", "2048"],
            get: |r| NUM_RAYS.iter().position(|n| *n >= r.signature.num_rays).unwrap_or(NUM_RAYS.len() - 1),
            set: |r, place| r.signature.num_rays = NUM_RAYS[place],
        }),
    },
    number!("signature.smoothing", "Smoothing", Contour, Fold, Millimetres, [0.0, 100.0], 1,
        |r| r.signature.smoothing.0, |r, v| r.signature.smoothing = Metres(v),
        "The outline is averaged over this length before the rays are drawn. Raising it forgives ragged edges and rounds corners."),
    Parameter {
        key: "rank.matcher",
        name: "Matcher",
        help: "Default: circular correlation of the rays as complex numbers, then overlap of the images. Paper: Algorithm 2, literally; it has no threshold of its own.",
        group: Group::Match,
        place: Place::Front,
        kind: Kind::Choice(Choice {
            options: &["Default", "Paper"],
            get: |r| match r.rank.matcher { Matcher::Default => 0, Matcher::Paper => 1 },
            set: |r, place| r.rank.matcher = if place == 0 { Matcher::Default } else { Matcher::Paper },
        }),
    },
    number!("rank.num_overlaid", "Placements laid over", Match, Fold, None, [1.0, 20.0], 0,
        |r| r.rank.num_overlaid as f64, |r, v| r.rank.num_overlaid = v.round() as usize,
        "Placements of each enrolled part that are laid over the scene's image. Raising it costs time and helps near-symmetric parts."),
    number!("rank.outline_tolerance", "Outline tolerance", Match, Fold, Millimetres, [10.0, 200.0], 0,
        |r| r.rank.outline_tolerance.0, |r, v| r.rank.outline_tolerance = Metres(v),
        "Distance of the outlines at which the score has dropped to 1/e. Raising it forgives outlines that differ."),
    Parameter {
        key: "pose",
        name: "Pose by",
        help: "Global: the best few parts are put in their place and looked for there. ICP: the paper's, from one start. None: the verdict rests on the outline alone and is quicker.",
        group: Group::Pose,
        place: Place::Front,
        kind: Kind::Choice(Choice {
            options: &["Global", "ICP", "None"],
            get: |r| POSES.iter().position(|pose| *pose == r.pose).unwrap_or_default(),
            set: |r, place| r.pose = POSES[place],
        }),
    },
    number!("confirm.num_references", "Parts looked for", Pose, Fold, None, [1.0, 20.0], 0,
        |r| r.confirm.num_references as f64, |r, v| r.confirm.num_references = v.round() as usize,
        "How many of the best-ranked parts are looked for in the scene. Raising it costs about 1.5 ms each and helps parts half hidden."),
    number!("confirm.tolerance", "Surface tolerance", Pose, Fold, Millimetres, [2.0, 50.0], 1,
        |r| r.confirm.tolerance.0, |r, v| r.confirm.tolerance = Metres(v),
        "Distance from an enrolled part at which a point without noise still lies on it. Raising it forgives dents, and parts that are alike."),
    number!("confirm.seed", "Seed of the thinning", Pose, Fold, None, [0.0, 999_999.0], 0,
        |r| r.confirm.seed as f64, |r, v| r.confirm.seed = v.round() as u64,
        "Seed for thinning the points. Another seed takes other points and costs nothing."),
    number!("icp.max_iterations", "ICP iterations at most", Pose, Fold, None, [1.0, 1000.0], 0,
        |r| r.icp.max_iterations as f64, |r, v| r.icp.max_iterations = v.round() as usize,
        "Most iterations of ICP. Raising it costs time in proportion."),
    number!("icp.target_e_m2", "ICP is content below", Pose, Fold, SquareMillimetres, [0.0, 1000.0], 2,
        |r| r.icp.target_e_m2, |r, v| r.icp.target_e_m2 = v,
        "E at which Algorithm 3 is content; the paper's 1e-6 m² is 1 mm². Raising it ends the search earlier and coarser."),
    number!("icp.max_source_points", "ICP points at most", Pose, Fold, None, [100.0, 1_000_000.0], 0,
        |r| r.icp.max_source_points as f64, |r, v| r.icp.max_source_points = v.round() as usize,
        "Points of the scene's part that ICP uses, thinned evenly. Raising it costs time in proportion."),
    number!("icp.shift_tolerance", "ICP least shift", Pose, Fold, Millimetres, [0.0, 10.0], 3,
        |r| r.icp.shift_tolerance.0, |r, v| r.icp.shift_tolerance = Metres(v),
        "A step that shifts by less than this (and turns little) ends the search. Raising it ends the search earlier."),
    number!("icp.turn_tolerance", "ICP least turn", Pose, Fold, Degrees, [0.0, 5.0], 4,
        |r| r.icp.turn_tolerance.0, |r, v| r.icp.turn_tolerance = Radians(v),
        "A step that turns by less than this (and shifts little) ends the search. Raising it ends the search earlier."),
    number!("accept.min_score", "Accept from", Acceptance, Front, None, [0.0, 1.0], 2,
        |r| r.accept.min_score, |r, v| r.accept.min_score = v,
        "Least score. Raising it turns wrong verdicts into rejections, and some right ones too."),
    number!("accept.min_margin", "Margin at least", Acceptance, Front, None, [0.0, 1.0], 2,
        |r| r.accept.min_margin, |r, v| r.accept.min_margin = v,
        "Least lead over the next part. Raising it rejects parts that are alike."),
    number!("stand_off.taught", "Taught distance", StandOff, Fold, Millimetres, [20.0, 1000.0], 0,
        |r| r.stand_off.taught.0, |r, v| r.stand_off.taught = Metres(v),
        "Distance of the nozzle from the part when its path was taught (the paper's standard d)."),
    // The ranges of the two ends do not overlap: the band is never empty.
    number!("stand_off.nearest", "Band from", StandOff, Fold, Millimetres, [10.0, 150.0], 0,
        |r| r.stand_off.nearest.0, |r, v| r.stand_off.nearest = Metres(v),
        "Nearest distance that still coats well. Raising it calls more of the path too near."),
    number!("stand_off.farthest", "Band to", StandOff, Fold, Millimetres, [160.0, 1000.0], 0,
        |r| r.stand_off.farthest.0, |r, v| r.stand_off.farthest = Metres(v),
        "Farthest distance that still coats well. Raising it forgives more of the path."),
    number!("stand_off.num_rays", "Rays of the path", StandOff, Fold, None, [10.0, 10_000.0], 0,
        |r| r.stand_off.num_rays as f64, |r, v| r.stand_off.num_rays = v as usize,
        "Places of the taught path that are looked at. Raising it costs about 2 µs each and finds a smaller worst spot."),
];
