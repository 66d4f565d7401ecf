//! `partsight path check`: checks that an arm reaches a part's path in its standard position.

use crate::cli::input::parse_name;
use std::{cell::RefCell, cmp::Ordering};

use clap::Args;
use nalgebra::Translation3;
use serde_json::json;

use super::stored_path;
use crate::cli::{
    LibraryChoice, Outcome,
    calibrate::{CalibrationChoice, no_calibration},
    console::{Advised as _, Console},
    input::parse_nozzle_pose,
    program::{CellChoice, ParamOptions},
    read_part,
};
use geometry::{rigid::RigidTransform, units::counted};
use inspection::library::{PartName, StoredPart};
use records::report::SCHEMA;
use robot::{
    Convention, WrittenPose,
    arm::{
        Arm, CheckParams, FilmRoom, PathCheck, PlaceSuggestion, PlacedArm, PointCheck,
        PointProblem, Way, check_path, suggest_base, suggest_rail,
    },
    program::arm_points,
    spray::carry,
};
use stages::stand_off::StandOffParams;
use station::robot_file::Unchecked;
use texts::Message;

/// Check that an arm reaches the stored path of a part in its standard position without collisions
#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// Name of the part
    #[arg(value_parser = parse_name)]
    part: PartName,
    /// The arm: kr6-r900, m-20ia, irb2600, irb4600, gp25, or a TOML file
    #[arg(long, value_name = "ARM")]
    arm: String,
    /// Pose of the nozzle on the flange, with z in its direction: `kuka X Y Z A B C`, or the 16 numbers of a matrix
    #[arg(long, value_name = "POSE", value_parser = parse_nozzle_pose, allow_hyphen_values = true)]
    nozzle: WrittenPose,
    #[command(flatten)]
    cell: CellChoice,
    #[command(flatten)]
    params: ParamOptions<false>,
    /// Write one line of JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    calibration: CalibrationChoice,
}

pub(super) fn run(
    choice: &LibraryChoice,
    args: &CheckArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let name = &args.part;
    let arm = Arm::named(&args.arm).advised()?;
    let Some(frame) = args.calibration.frame(console)? else {
        return Err(no_calibration("the check"));
    };
    let place = choice.open(console)?;
    let path = stored_path(&place, name)?;
    let StoredPart {
        reference, meta, ..
    } = read_part(&place, name)?;
    let standard = RigidTransform::identity();
    let carried = carry(
        &path,
        &standard,
        &reference.cloud,
        &StandOffParams::default(),
    );
    let params = &args.params.0;
    let points = arm_points(&carried, &frame, params.speed);
    let placed = args
        .cell
        .place(arm, args.nozzle.pose, params)?
        .with_part(&reference.cloud.points, &frame.robot_from_part(&standard));
    let film = FilmRoom::of_path(&path, &reference.cloud, meta.coverage, meta.side);
    let params = CheckParams {
        film: film.as_ref(),
        ..params.check_params()
    };
    let found = check_path(&placed, &points, &params).advised()?;
    let (num, all) = (found.num_reached(), points.len());
    let (mut base, mut rail) = (None, None);
    if num < all {
        let progress = progress_on(console);
        // Ctrl-C ends the command.
        let is_cancelled = || false;
        rail = suggest_rail(&placed, &points, &params, num, &progress, &is_cancelled).advised()?;
        base = suggest_base(&placed, &points, &params, num, &progress, &is_cancelled).advised()?;
        drop(progress);
        console.end_progress();
    }
    if args.json {
        let moving = placed.arm.moving_rail();
        let range = moving.map(|_| found.rail_range().map(|at| 1000.0 * at));
        let listed = found.points.iter().enumerate().map(|(i, point)| {
            let joints = point.joints.map(|joints| {
                let shown = placed.arm.on_pendant(&joints);
                shown.map(f64::to_degrees)
            });
            json!({
                "index": i + 1,
                "joints_deg": joints,
                "turn_deg": point.turn.to_degrees(),
                "tilt_deg": point.tilt.to_degrees(),
                "slower_mm_s": match point.way {
                    Way::Slower(speed) | Way::SlowerSpraying(speed) => Some(1000.0 * speed),
                    Way::Planned | Way::Joints => None,
                },
                "joint_move": point.way == Way::Joints,
                "rail_mm": moving.map(|_| 1000.0 * point.rail),
                "problem": point.problem.as_ref().map(ToString::to_string),
                "problem_kind": point.problem.as_ref().map(PointProblem::kind),
            })
        });
        let unchecked = Unchecked::of_arm(Some(&placed)).into_iter();
        let unchecked: Vec<String> = unchecked.map(|unchecked| unchecked.to_string()).collect();
        let line = json!({
            "schema": SCHEMA,
            "part": name.as_str(),
            "arm": placed.arm.name,
            "num_points": all,
            "num_reached": num,
            "num_collisions": found.num_collisions(),
            "unchecked_accelerations": placed.arm.unchecked_accelerations(),
            "not_checked": unchecked,
            "base_shift_mm": base.map(|place| place.shift.map(|x| 1000.0 * x)),
            "rail_mm": rail.map(|place| 1000.0 * place.shift[0]),
            "rail_range_mm": range,
            "points": listed.collect::<Vec<_>>(),
        });
        console.line(&line);
    } else {
        show(&placed, &found, console);
        let written = args.cell.base.map(|base| base.convention);
        let written = written.unwrap_or(Convention::Kuka);
        for line in better_places(&placed, all, [base, rail], written) {
            console.line(&line);
        }
    }
    Ok(Outcome::accepted_if(num == all))
}

/// Shows the number of places examined by each search as a progress bar.
fn progress_on(console: &mut Console) -> impl Fn(usize, usize) {
    let console = RefCell::new(console);
    move |num_done, total| {
        if num_done == 0 {
            console.borrow_mut().start_progress(total);
            console.borrow().begin(&"places of the arm");
        } else {
            console.borrow().done();
        }
    }
}

/// Shows the result in words.
fn show(placed: &PlacedArm, found: &PathCheck, console: &mut Console) {
    let (num, all) = (found.num_reached(), found.points.len());
    console.line(&format_args!(
        "{} reaches {num} of {}",
        placed.arm.name,
        counted(all, "point", "points")
    ));
    if placed.arm.moving_rail().is_some() {
        let [low, high] = found.rail_range().map(|at| 1000.0 * at);
        console.line(&format_args!(
            "  its rail is between {low:.0} and {high:.0} mm"
        ));
    }
    if let Some((num, most)) = found.tilted() {
        console.line(&format_args!(
            "  the nozzle tilts at {num} of them, by up to {:.1} degrees",
            most.to_degrees()
        ));
    }
    for line in changed_moves_lines(found.changed_moves()) {
        console.line(&format_args!("  {line}"));
    }
    for unchecked in Unchecked::of_arm(Some(placed)) {
        let what = Message::new("not-checked").with("what", &*unchecked.to_string());
        console.line(&format_args!("  {what}"));
    }
    for line in problem_lines(&found.points) {
        console.line(&format_args!("  {line}"));
    }
    let problems = || {
        found
            .points
            .iter()
            .filter_map(|point| point.problem.as_ref())
    };
    if problems().any(PointProblem::is_of_joints) {
        console.line(
            &"  to do: try another angle of --nozzle, a --max-tilt up to 30, another --base, or a lower speed of the coat",
        );
    }
    if problems().any(PointProblem::is_acceleration) {
        console.line(
            &"  to do: lower the speed where it accelerates too slowly, round the corners in a larger radius, or plan the path with a lower gun.flow, which makes the gun slower",
        );
    }
}

/// Says how many of the moves with the gun off are slower, how many are joint moves, and how many are slower with the gun
/// on; empty if all are as in the path.
fn changed_moves_lines([num_slower, num_by_joints, num_spraying]: [usize; 3]) -> Vec<String> {
    let slower = |num| match num {
        0 => None,
        1 => Some("1 is slower than in the path".to_owned()),
        num => Some(format!("{num} are slower than in the path")),
    };
    let by_joints = match num_by_joints {
        0 => None,
        1 => Some("1 is a joint move".to_owned()),
        num => Some(format!("{num} are joint moves")),
    };
    let changed: Vec<String> = slower(num_slower).into_iter().chain(by_joints).collect();
    let with_gun_off = (!changed.is_empty())
        .then(|| format!("of the moves with the gun off, {}", changed.join(" and ")));
    let with_gun_on = slower(num_spraying).map(|slower| {
        format!(
            "of the moves with the gun on, {slower}, as far as the film stays within its tolerance"
        )
    });
    with_gun_off.into_iter().chain(with_gun_on).collect()
}

/// Lists the points that are not reached: the number for each reason, the most frequent first, unless one line says
/// everything; then each range of consecutive points with the same reason.
fn problem_lines(points: &[PointCheck]) -> Vec<String> {
    let reason = |point: &PointCheck| point.problem.as_ref().map(PointProblem::reason);
    let mut totals: Vec<(String, usize)> = Vec::new();
    let mut ranges = Vec::new();
    let mut first = 1;
    for range in points.chunk_by(|a, b| reason(a) == reason(b)) {
        let (num, last) = (range.len(), first + range.len() - 1);
        let problems = (first..).zip(range);
        let problems = problems.filter_map(|(i, point)| Some((i, point.problem.as_ref()?)));
        if let Some((at, worst)) = problems.max_by(|a, b| by_figure(a.1, b.1)) {
            let reason = worst.reason();
            ranges.push(if num == 1 {
                format!("point {first}: {worst}")
            } else if worst.figure().is_none() {
                format!("points {first}–{last}: {reason} ({num} points)")
            } else {
                format!("points {first}–{last}: {reason} ({num} points; worst at {at}: {worst})")
            });
            match totals.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, total)) => *total += num,
                None => totals.push((reason, num)),
            }
        }
        first += num;
    }
    totals.sort_by_key(|(_, num)| std::cmp::Reverse(*num));
    if ranges.len() == 1 {
        totals.clear();
    }
    let all = counted(points.len(), "point", "points");
    let totals = totals.into_iter();
    let totals = totals.map(|(reason, num)| format!("{reason}: {num} of {all}"));
    totals.chain(ranges).collect()
}

fn by_figure(a: &PointProblem, b: &PointProblem) -> Ordering {
    let figure = |problem: &PointProblem| problem.figure().unwrap_or_default();
    figure(a).total_cmp(&figure(b))
}

/// Describes the places of base and rail that reach more, with the `--base` in this convention that checks them: an arm
/// on a rail that stands still is one whose base was moved along it.
fn better_places(
    placed: &PlacedArm,
    all: usize,
    [base, rail]: [Option<PlaceSuggestion>; 2],
    convention: Convention,
) -> Vec<String> {
    let option = |shift: Translation3<f64>| {
        let pose = convention.write(&(shift * placed.robot_from_base));
        let numbers = pose.values.iter().map(|value| {
            let text = value.rounded();
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        });
        let numbers: Vec<String> = numbers.collect();
        format!("--base \"{} {}\"", convention.name(), numbers.join(" "))
    };
    // The search goes no farther than a metre.
    let is_step = base.is_some_and(|place| place.num_reached < all);
    let further =
        is_step.then(|| "  check again with it: a further step may reach more".to_owned());
    let base = base.map(|place| {
        let [x, y, z] = place.shift.map(|x| 1000.0 * x);
        format!(
            "  with its base moved by {x:.0} {y:.0} {z:.0} mm it would reach {} of {all}: {}",
            place.num_reached,
            option(Translation3::from(place.shift))
        )
    });
    let rail = rail.zip(placed.arm.rail).map(|(place, rail)| {
        let [at, ..] = place.shift;
        format!(
            "  at {:.0} mm on its rail it would reach {} of {all}: {}",
            1000.0 * at,
            place.num_reached,
            option(Translation3::from(rail.direction.into_inner() * at))
        )
    });
    base.into_iter().chain(further).chain(rail).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use robot::arm::Obstacles;

    fn point(problem: Option<PointProblem>) -> PointCheck {
        PointCheck {
            problem,
            ..PointCheck::default()
        }
    }

    #[test]
    fn a_base_from_which_some_points_are_still_missed_is_to_be_checked_again() {
        let placed = PlacedArm {
            arm: Arm::named("irb4600").expect("known"),
            robot_from_base: RigidTransform::identity(),
            flange_from_nozzle: RigidTransform::identity(),
            gun_radius: 0.05,
            obstacles: Obstacles::default(),
        };
        let words = |num_reached| {
            let place = PlaceSuggestion {
                shift: [0.5, 0.0, 0.0],
                num_reached,
            };
            better_places(&placed, 10, [Some(place), None], Convention::Kuka).join("\n")
        };
        assert!(
            words(7).ends_with("a further step may reach more"),
            "{}",
            words(7)
        );
        assert!(!words(10).contains("further"), "{}", words(10));
    }

    #[test]
    fn one_changed_move_is_singular_and_none_is_not_told() {
        let lines = changed_moves_lines;
        assert!(lines([0, 0, 0]).is_empty());
        let off = "of the moves with the gun off,";
        assert_eq!(
            lines([1, 1, 0]),
            [format!(
                "{off} 1 is slower than in the path and 1 is a joint move"
            )]
        );
        assert_eq!(
            lines([2, 0, 0]),
            [format!("{off} 2 are slower than in the path")]
        );
        assert_eq!(
            lines([0, 3, 2]),
            [
                format!("{off} 3 are joint moves"),
                "of the moves with the gun on, 2 are slower than in the path, as far as the film stays within its tolerance".into()
            ]
        );
    }

    #[test]
    fn consecutive_points_with_the_same_reason_are_one_line() {
        let fast = |speed: f64| {
            let speed = speed.to_radians();
            Some(PointProblem::TooFast { joint: 5, speed })
        };
        let far = || Some(PointProblem::OutOfReach);
        let problems = [
            None,
            far(),
            far(),
            far(),
            fast(200.0),
            fast(310.0),
            fast(250.0),
            None,
            fast(190.0),
            None,
        ];
        let points = problems.map(point);
        let wanted = [
            "joint 5 too fast: 4 of 10 points",
            "out of reach: 3 of 10 points",
            "points 2–4: out of reach (3 points)",
            "points 5–7: joint 5 too fast (3 points; worst at 6: joint 5 would need 310°/s)",
            "point 9: joint 5 would need 190°/s",
        ];
        assert_eq!(problem_lines(&points), wanted);
        // One range needs no totals.
        assert_eq!(problem_lines(&points[..4]), [wanted[2]]);
        assert!(problem_lines(&points[..1]).is_empty());
    }
}
