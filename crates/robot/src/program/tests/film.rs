//! The film that the written files leave, integrated from what a reader of its own finds in them.

use nalgebra::{Point3, Unit};

use super::*;
use crate::{
    RobotFrame,
    paint::{Coat, LEAST_WITHIN, PaintSurface, Proposal, WrittenFilm, proposed, simulate},
    spray::carry,
};
use inspection::library::{PathPoint, SprayPath, StoredPart};
use stages::stand_off::StandOffParams;

/// Metres between the moments at which the speed is found.
const STEP: f64 = 0.001;
/// Steps that are sprayed together.
const TOGETHER: usize = 5;

/// A place on the way: the move that it belongs to, the metres left of it, the metres to the next place, and the square
/// of the speed.
struct Place {
    to: usize,
    left: f64,
    step: f64,
    squared: f64,
}

/// The path that the nozzle follows if the robot does what the file says: straight from pose to pose, at each move's
/// speed, with this acceleration where the file states none. Only stops make it slower.
fn followed(moves: &[read::Move], part_from_robot: &RigidTransform, usual: f64) -> SprayPath {
    let at = |index: usize| moves[index].to.translation.vector;
    let mut places = Vec::new();
    for to in 1..moves.len() {
        let length = (at(to) - at(to - 1)).norm();
        let speed = moves[to].speed.expect("a linear move");
        let num = (length / STEP).ceil() as usize;
        for k in 0..num {
            let is_stop = k == 0 && moves[to - 1].is_exact;
            places.push(Place {
                to,
                left: length * (1.0 - k as f64 / num as f64),
                step: length / num as f64,
                squared: if is_stop { 0.0 } else { speed * speed },
            });
        }
    }
    places.last_mut().expect("a way").squared = 0.0;
    let gain = |place: &Place| 2.0 * place.step * moves[place.to].acceleration.unwrap_or(usual);
    for i in 1..places.len() {
        let most = places[i - 1].squared + gain(&places[i - 1]);
        places[i].squared = places[i].squared.min(most);
    }
    for i in (1..places.len()).rev() {
        let most = places[i].squared + gain(&places[i - 1]);
        places[i - 1].squared = places[i - 1].squared.min(most);
    }
    let mut points = Vec::new();
    let mut first = 0;
    while first + 1 < places.len() {
        let here = &places[first];
        let is_on = |place: &Place| {
            let is_early = place.left <= moves[place.to].switches_before;
            moves[(place.to + usize::from(is_early)).min(moves.len() - 1)].is_gun_on
        };
        let alike = places[first..].iter().take(TOGETHER);
        let alike = alike.take_while(|place| place.to == here.to && is_on(place) == is_on(here));
        let end = (first + alike.count()).min(places.len() - 1);
        let steps = places[first..=end].windows(2);
        let steps = steps.map(|pair| {
            let mean = f64::midpoint(pair[0].squared.sqrt(), pair[1].squared.sqrt());
            pair[0].step / mean
        });
        let seconds: f64 = steps.sum();
        let [from, to] = [here.to - 1, here.to].map(|index| moves[index].to);
        let length = (to.translation.vector - from.translation.vector).norm();
        let pose = part_from_robot * from.lerp_slerp(&to, 1.0 - here.left / length);
        points.push(PathPoint {
            nozzle: Point3::from(pose.translation.vector),
            direction: Unit::new_normalize(pose * Vector3::z()),
            stand_off: None,
            is_gun_on: is_on(here),
            speed: Some((end - first) as f64 * here.step / seconds),
            fan: Some(Unit::new_normalize(pose * Vector3::x())),
        });
        first = end;
    }
    SprayPath::new(points).expect("points")
}

/// The films of the programs of a part's proposed path.
struct Painted {
    planned: &'static Proposal,
    /// Share within the tolerance and mean thickness, as integrated here from each file.
    read: Vec<(&'static RobotLanguage, [f64; 2])>,
    /// As the export states them, for one language of each kind: moved on, switched early, stopped.
    stated: [WrittenFilm; 3],
}

fn painted(name: &str) -> Painted {
    let (part, planned) = proposed(name);
    let StoredPart {
        reference, meta, ..
    } = part;
    let surface = PaintSurface::of(reference, meta.coverage, meta.side).expect("a surface");
    let frame = RobotFrame {
        robot_from_camera: from_euler_zyx([0.4, -0.2, 1.3, 1.2, -0.4, 1.9]),
        name: "cell".into(),
    };
    let standard = RigidTransform::identity();
    let params = StandOffParams::default();
    let carried = carry(&planned.path, &standard, &reference.cloud, &params);
    let points = program_points(&carried, &frame, None);
    let settings = ProgramSettings::default();
    let program = Program {
        acceleration: Coat::acceleration_of(&planned.path),
        robot_from_part: frame.robot_from_part(&standard),
        ..program(&points, &settings)
    };
    let part_from_robot = program.robot_from_part.inverse();
    let read = RobotLanguage::ALL.map(|language| {
        let moves = (language.reader.read)(&text_of(&program, language)).moves;
        let path = followed(&moves, &part_from_robot, planned.coat.acceleration);
        let film = simulate(&surface, &path, &planned.coat, &[]).expect("simulated");
        (language, [film.figures.within, film.figures.mean])
    });
    let kinds = [&KRL, &URSCRIPT, &DRL];
    let stated = kinds.map(|language| {
        let enrolled = &reference.cloud;
        let film = WrittenFilm::of(
            &program,
            language,
            &planned.path,
            enrolled,
            meta.coverage,
            meta.side,
        );
        film.expect("a film")
    });
    Painted {
        planned,
        read: read.into(),
        stated,
    }
}

#[test]
fn written_programs_leave_the_film_that_was_planned_except_where_the_robot_has_to_stop() {
    for (name, may_stop) in [
        ("fender", true),
        ("radiator_support", false),
        ("grille", false),
    ] {
        let Painted {
            planned,
            read,
            stated,
        } = painted(name);
        let planned = &planned.film.figures;
        for (language, [within, mean]) in &read {
            let is_as_planned =
                *within > planned.within - 0.02 && (mean / planned.mean - 1.0).abs() < 0.04;
            let has_to_stop = language.reader.stops;
            assert_eq!(
                is_as_planned,
                may_stop || !has_to_stop,
                "{name} {language:?}: {within} {mean}"
            );
        }
        let [krl, urscript, drl] = &stated;
        for film in [krl, urscript] {
            assert_eq!(film.num_stops, 0, "{name}");
            assert_eq!(film.doubt(), None, "{name}");
            assert!(film.written.figures.within >= LEAST_WITHIN, "{name}");
        }
        assert!(drl.num_stops > 20, "{name}");
        assert_eq!(drl.doubt().is_none(), may_stop, "{name}");
        // The export also slows down in corners, and states more stops' worth of paint rather than less.
        for (film, index) in stated.iter().zip([0, 3, 5]) {
            let (language, [within, mean]) = read[index];
            let figures = &film.written.figures;
            assert!(
                (figures.within - within).abs() < 0.07,
                "{name} {language:?}"
            );
            assert!(
                (figures.mean / mean - 1.0).abs() < 0.06,
                "{name} {language:?}"
            );
        }
    }
}
