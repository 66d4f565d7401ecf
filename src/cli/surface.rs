//! The surface of a part in words.

use inspection::pipeline::{Inspection, JudgedRegion, SurfaceCheck};
use stages::deviation::PATCH_RADIUS_M;
use texts::Described as _;

/// What is said of the surface, each with a word for the margin; nothing if it was not checked.
pub(super) fn surface_words(inspection: &Inspection) -> Vec<(&'static str, String)> {
    let Some(check) = &inspection.surface else {
        return Vec::new();
    };
    let mut words = vec![("surface", verdict_words(check))];
    if let Some(deviation) = &check.deviation {
        let of_smallest = deviation.smallest.iter().map(|dent| {
            let (width, depth) = (dent.width.mm(), dent.depth.mm());
            format!("{width:.0} mm wide from {depth:.1} mm")
        });
        let of_smallest: Vec<String> = of_smallest.collect();
        let between = deviation.noise_between.map_or_else(String::new, |noise| {
            format!(" ({:.2} mm of it from frame to frame)", noise.mm())
        });
        words.push((
            "noise",
            format!(
                "{:.2} mm of the average over {:.0} mm{between}; found in 95 of 100 cases: dents {}",
                deviation.noise.mm(),
                2000.0 * PATCH_RADIUS_M,
                of_smallest.join(", ")
            ),
        ));
    }
    words.extend(
        check
            .regions
            .iter()
            .map(|region| ("region", region_words(region))),
    );
    if let Some(why) = check.not_judged {
        words.push(("why not", why.to_string()));
        words.push(("to do", why.message().command_advice()));
    }
    words
}

fn verdict_words(check: &SurfaceCheck) -> String {
    let verdict = check.verdict;
    match &check.deviation {
        None => verdict.to_string(),
        Some(deviation) => {
            let frames = match deviation.num_frames {
                1 => "one frame".to_owned(),
                num => format!("{num} frames averaged"),
            };
            let seen = 100.0 * deviation.seen;
            format!("{verdict}; {frames}, {seen:.0} % of this side judged")
        }
    }
}

fn region_words(judged: &JudgedRegion) -> String {
    let region = &judged.region;
    let off = region.off.map_or_else(String::new, |off| {
        format!(" of {:.1} mm (limit {:.1} mm)", off.mm(), judged.limit.mm())
    });
    let [x, y, z] = [region.centre.x, region.centre.y, region.centre.z].map(|m| 1000.0 * m);
    let zone = judged.zone.as_ref().map_or_else(String::new, |zone| {
        format!(", zone {}", files::visible(zone))
    });
    format!(
        "{}{off}, {:.1} cm², at x {x:.0}  y {y:.0}  z {z:.0} mm of the part{zone}: {}",
        region.kind,
        1e4 * region.area_m2,
        judged.verdict
    )
}
