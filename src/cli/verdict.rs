//! Verdicts for people: as a card or a row.

use super::{console::Console, recipe::show_recipe};
use files::visible;
use geometry::{
    error::Advice as _,
    units::{Metres, Radians},
};
use inspection::{
    library::Library,
    pipeline::{Identification, Inspection, Verdict},
};
use stages::pose::{Stopped, Uncertainty};
use station::Inspected;

/// Returns the part's position, the middle of its reference's extent (x, y, z in mm), and its rotation (rx, ry, rz in
/// degrees).
pub(super) fn place_of(inspection: &Inspection, library: &Library) -> Option<([f64; 3], [f64; 3])> {
    let pose = inspection.found_pose()?.camera_from_part();
    let middle = pose * inspection.middle(library)?;
    // nalgebra's angles are those of Rz·Ry·Rx.
    let (rx, ry, rz) = pose.rotation.euler_angles();
    Some((
        [middle.x, middle.y, middle.z].map(|m| Metres(m).mm()),
        [rx, ry, rz].map(f64::to_degrees),
    ))
}

/// Returns in words where the middle of an accepted part is in the robot's base frame, and why a robot must not act on it.
/// Nothing without a calibration.
pub(super) fn in_robot_words(
    inspected: &Inspected<'_>,
    library: &Library,
) -> Vec<(&'static str, String)> {
    let inspection = inspected.inspection;
    if inspected.robot.is_none() || !inspection.verdict.is_accepted() {
        return Vec::new();
    }
    let doubts = inspected.doubts();
    let mut words = Vec::new();
    let place = place_of(inspection, library);
    if let Some((robot, ([x, y, z], _))) = inspected.frame_for_robot().zip(place) {
        let middle = nalgebra::Point3::new(x, y, z).map(|mm| mm / 1000.0);
        let middle = robot.robot_from_camera * middle;
        let [x, y, z] = [middle.x, middle.y, middle.z].map(|m| Metres(m).mm());
        let name = &robot.name;
        words.push((
            "robot",
            format!(
                "middle at x {x:.1}  y {y:.1}  z {z:.1} mm in the robot's base frame, by {name}"
            ),
        ));
        words.extend(
            doubts
                .iter()
                .map(|doubt| ("doubt", format!("given by --force: {doubt}"))),
        );
    } else if let Some((first, rest)) = doubts.split_first() {
        words.push(("robot", format!("no pose: {first}")));
        words.extend(rest.iter().map(|doubt| ("also", doubt.to_string())));
        words.push(("to do", first.advice()));
    }
    words
}

fn bounds_in_words(bounds: &Uncertainty) -> String {
    match bounds.freedom {
        None => format!(
            "off by less than {:.1} mm and {:.2} degrees in 95 of 100 cases",
            bounds.shift.mm(),
            bounds.turn.degrees()
        ),
        Some(freedom) => format!("unconstrained: {freedom}"),
    }
}

/// The verdict in the words of a card or a row.
pub(super) fn accepted_or_not(verdict: &Verdict) -> &'static str {
    if verdict.is_accepted() {
        "accepted"
    } else {
        "NOT ACCEPTED"
    }
}

/// Says what hangs there in a narrow column beside the verdict.
pub(super) fn in_column(found: Identification, part: &str) -> String {
    match found {
        Identification::Part => part.to_owned(),
        Identification::AnotherMake | Identification::AnotherModel => format!("like {part}"),
        Identification::MirrorImage | Identification::OtherHalf => format!("mirrored {part}"),
        Identification::NoPart => "-".to_owned(),
        found if found.names_nearest() => format!("nearest {part}"),
        _ => "unknown".to_owned(),
    }
}

/// Shows everything about one inspection, one line per item.
pub(super) fn show_card(
    scene: &str,
    inspected: &Inspected<'_>,
    library: &Library,
    console: &mut Console,
) {
    let inspection = inspected.inspection;
    let mut line = |what: &str, text: String| console.entry(what, &text);
    line("scene", visible(scene).into_owned());
    let verdict = &inspection.verdict;
    let found = verdict.identification();
    let part = found.in_english(verdict.guess().unwrap_or_default());
    line("part", format!("{part}: {}", accepted_or_not(verdict)));
    if let Some([score, margin]) = verdict.score() {
        let next = inspection.ranking.runner_up().map(|next| &next.part);
        let next = next.filter(|_| !verdict.is_unknown());
        let margin = next.map_or(String::new(), |next| {
            format!(", margin {margin:.2} (the next part is {next})")
        });
        line("score", format!("{score:.2}{margin}"));
    }
    let is_named = inspection.verdict.is_named();
    let place = place_of(inspection, library).filter(|_| is_named);
    if let Some(([x, y, z], [rx, ry, rz])) = place {
        line(
            "middle",
            format!("x {x:.1}  y {y:.1}  z {z:.1} mm, in the camera's frame"),
        );
        line(
            "turn",
            format!(
                "rx {rx:.2}  ry {ry:.2}  rz {rz:.2} degrees from how it was enrolled (Rz·Ry·Rx)"
            ),
        );
    }
    // Without the part's name, the figures of its pose are of no use.
    let pose = inspection.found_pose();
    let pose = pose.filter(|_| is_named);
    if let Some(pose) = pose {
        if let Some(other) = inspection.other_reference() {
            let text = format!(
                "{other}, another reference of this part, with a standard position of its own"
            );
            line("reference", text);
        }
        // The pose of something unknown is of no use.
        let is_known = !inspection.verdict.is_unknown();
        let is_ambiguous = is_known && pose.is_ambiguous();
        let ambiguous = if is_ambiguous {
            "; another pose fits as well"
        } else {
            ""
        };
        let off_scale = pose.off_scale().filter(|_| is_known);
        let off_scale = off_scale.map_or_else(String::new, |off| format!("; {off}"));
        let approximate = if is_known && inspection.verdict.is_approximate() {
            "; approximate, since this may be another model of the part"
        } else {
            ""
        };
        line(
            "fit",
            format!(
                "{:.1} mm rms, {:.0} % of what was seen lies on the reference, {} by the method {}{ambiguous}{off_scale}{approximate}",
                pose.fit.rms_m * 1000.0,
                pose.fit.overlap * 100.0,
                stopped_words(pose.stopped),
                pose.method.name(),
            ),
        );
    }
    if let Some(bounds) = pose.and_then(|pose| pose.uncertainty) {
        line("bounds", bounds_in_words(&bounds));
    }
    if inspection.touches_edge() {
        let text = "what was found reaches the picture's edge: some of it may be missing";
        line("edge", text.to_owned());
    }
    if let Some(place) = &inspection.place {
        line("place", format!("{place}{}", turn_words(inspection)));
    }
    if inspection.leaves_volume {
        let text = "what was found goes on outside the work volume: some of it may be missing";
        line("volume", text.to_owned());
    }
    line(
        "time",
        format!("{:.1} ms", inspection.timings.total.as_secs_f64() * 1000.0),
    );
    if let Some([why, what_to_do]) = inspection.verdict.complaint() {
        line("why not", why);
        line("to do", what_to_do);
    }
    show_recipe(inspected.recipe, console);
    for (what, text) in in_robot_words(inspected, library) {
        console.entry(what, &text);
    }
}

fn turn_words(inspection: &Inspection) -> String {
    inspection.turn_at_place.map_or(String::new(), |turn| {
        let [found, limit] = [turn.found, turn.limit].map(Radians::degrees);
        format!(", turned by {found:.1} degrees of {limit:.1} allowed")
    })
}

fn stopped_words(stopped: Stopped) -> &'static str {
    match stopped {
        Stopped::Converged => "converged",
        Stopped::BelowThreshold => "below its threshold",
        Stopped::IterationLimit => "stopped at the iteration limit",
        Stopped::NoProgress => "stopped without progress",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_certainly_the_part_has_its_name_alone() {
        let unknown = |is_like| Identification::Unknown { is_like };
        for (found, words, column) in [
            (Identification::Part, "fender", "fender"),
            (
                Identification::AnotherMake,
                "fender, another make",
                "like fender",
            ),
            (
                Identification::OtherHalf,
                "mirror image of the enrolled piece of fender",
                "mirrored fender",
            ),
            (
                Identification::NotRecognised,
                "not recognised, nearest fender",
                "nearest fender",
            ),
            (unknown(true), "unknown, nearest fender", "nearest fender"),
            (unknown(false), "unknown", "unknown"),
            (Identification::NoPart, "none", "-"),
        ] {
            assert_eq!(found.in_english("fender"), words);
            assert_eq!(in_column(found, "fender"), column);
        }
    }
}
