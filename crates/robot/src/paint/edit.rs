//! Manual corrections of a path: a stroke or a point moved, or the gun turned.
//!
//! A correction at one point fades out over its neighbours on the same stroke, so that the gun does not jerk.

use nalgebra::{Unit, Vector3};

use inspection::library::{PathPoint, SprayPath};

/// Points on each side of a corrected one that move along, less with distance.
const NUM_FADING_POINTS: usize = 3;

/// A manual correction of a path. Strokes and points are given by their index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathEdit {
    /// Moves a stroke with its lead-in and lead-out.
    Stroke {
        /// Index of the stroke.
        stroke: usize,
        /// Shift, metres; its component along the jet is ignored.
        by: Vector3<f64>,
    },
    /// Moves a point of a stroke.
    Point {
        /// Index of the point.
        point: usize,
        /// Shift, metres; its component along the jet is ignored.
        by: Vector3<f64>,
    },
    /// Turns the gun about the point at which it aims.
    Turn {
        /// Index of the point.
        point: usize,
        /// Shift of the nozzle, metres.
        by: Vector3<f64>,
    },
}

/// Applies corrections one after the other; those of a stroke or point that does not exist are ignored. `stand_off`, in
/// metres, is the distance of the aim for points without one of their own.
#[must_use]
pub fn edited(path: SprayPath, edits: &[PathEdit], stand_off: f64) -> SprayPath {
    let strokes = path.strokes();
    let mut points = path.points().to_vec();
    for edit in edits {
        match *edit {
            PathEdit::Stroke { stroke, by } => {
                for i in with_leads(&strokes, stroke, points.len()) {
                    shift(&mut points[i], by);
                }
            }
            PathEdit::Point { point, by } => {
                for (i, weight) in faded(&strokes, point) {
                    shift(&mut points[i], by * weight);
                }
            }
            PathEdit::Turn { point, by } => {
                for (i, weight) in faded(&strokes, point) {
                    turn(&mut points[i], by * weight, stand_off);
                }
            }
        }
    }
    let coat = path.coat().map(str::to_owned);
    SprayPath::new(points).map_or(path, |edited| edited.with_coat(coat))
}

/// The points of a stroke, and the nearer halves of the ways with the gun off on both sides.
fn with_leads(strokes: &[[usize; 2]], stroke: usize, num: usize) -> std::ops::Range<usize> {
    let Some([first, last]) = strokes.get(stroke).copied() else {
        return 0..0;
    };
    let before = stroke.checked_sub(1).and_then(|i| strokes.get(i));
    let from = before.map_or(0, |[_, end]| usize::midpoint(*end, first) + 1);
    let behind = strokes.get(stroke + 1);
    let to = behind.map_or(num, |[begin, _]| usize::midpoint(last, *begin) + 1);
    from.min(first)..to.max(last + 1).min(num)
}

/// A point and its neighbours on the stroke, each with its weight.
fn faded(strokes: &[[usize; 2]], point: usize) -> Vec<(usize, f64)> {
    let own = strokes
        .iter()
        .find(|[first, last]| (*first..=*last).contains(&point));
    let Some([first, last]) = own else {
        return Vec::new();
    };
    let from = point.saturating_sub(NUM_FADING_POINTS).max(*first);
    let to = (point + NUM_FADING_POINTS).min(*last);
    let share = |i: usize| {
        let off = i.abs_diff(point) as f64 / (NUM_FADING_POINTS + 1) as f64;
        0.5 + 0.5 * (std::f64::consts::PI * off).cos()
    };
    (from..=to).map(|i| (i, share(i))).collect()
}

fn shift(point: &mut PathPoint, by: Vector3<f64>) {
    let jet = point.direction.into_inner();
    point.nozzle += by - jet * jet.dot(&by);
}

/// Moves the nozzle on a sphere around the point at which it aims.
fn turn(point: &mut PathPoint, by: Vector3<f64>, stand_off: f64) {
    let distance = point.stand_off.map_or(stand_off, |d| d.0);
    let aim = point.nozzle + point.direction.into_inner() * distance;
    let Some(direction) = Unit::try_new(aim - (point.nozzle + by), 1e-9) else {
        return;
    };
    point.direction = direction;
    point.nozzle = aim - direction.into_inner() * distance;
    if let Some(fan) = point.fan {
        let across = fan.into_inner() - direction.into_inner() * direction.dot(&fan);
        point.fan = Unit::try_new(across, 1e-9);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use geometry::units::Metres;

    /// Two rows of nine points along x, 150 mm above z = 0, with the gun on between the second and the last but one.
    fn path() -> SprayPath {
        let rows = [0.0, 0.1].into_iter().flat_map(|y| {
            (0..9).map(move |i| PathPoint {
                nozzle: Point3::new(0.05 * f64::from(i), y, 0.15),
                direction: -Vector3::z_axis(),
                stand_off: Some(Metres(0.15)),
                is_gun_on: (1..7).contains(&i),
                speed: Some(0.4),
                fan: Some(Vector3::y_axis()),
            })
        });
        SprayPath::new(rows.collect()).expect("a path")
    }

    #[test]
    fn a_moved_stroke_takes_its_leads_along_and_leaves_the_others() {
        let by = Vector3::new(0.0, 0.02, 0.5);
        let moved = edited(path(), &[PathEdit::Stroke { stroke: 0, by }], 0.15);
        for (i, (before, after)) in path().points().iter().zip(moved.points()).enumerate() {
            let expected = if i < 9 { 0.02 } else { 0.0 };
            let off = after.nozzle - before.nozzle;
            assert!(
                (off - Vector3::new(0.0, expected, 0.0)).norm() < 1e-12,
                "{i}: {off}"
            );
        }
    }

    #[test]
    fn a_moved_point_takes_its_neighbours_along_less_and_less() {
        let by = Vector3::new(0.0, 0.02, 0.0);
        let moved = edited(path(), &[PathEdit::Point { point: 4, by }], 0.15);
        let off: Vec<f64> = (path().points().iter().zip(moved.points()))
            .map(|(before, after)| after.nozzle.y - before.nozzle.y)
            .collect();
        assert!((off[4] - 0.02).abs() < 1e-12);
        assert!(off[1] < off[2] && off[2] < off[3] && off[3] < off[4] && off[1] > 0.0);
        assert!(off[0].abs() < 1e-12 && off[8..].iter().all(|off| off.abs() < 1e-12));
    }

    #[test]
    fn a_turned_gun_aims_at_the_same_place_from_the_same_distance() {
        let by = Vector3::new(0.04, 0.0, 0.0);
        let turned = edited(path(), &[PathEdit::Turn { point: 4, by }], 0.15);
        for (before, after) in path().points().iter().zip(turned.points()) {
            let aim = |p: &PathPoint| p.nozzle + p.direction.into_inner() * 0.15;
            assert!((aim(before) - aim(after)).norm() < 1e-12);
            let fan = after.fan.expect("a fan");
            assert!(fan.dot(&after.direction).abs() < 1e-12);
        }
        let angle = turned.points()[4].direction.angle(&-Vector3::z_axis());
        assert!((angle - (0.04_f64 / 0.15).atan()).abs() < 1e-9);
    }

    #[test]
    fn what_is_not_there_changes_nothing() {
        let by = Vector3::new(0.0, 0.02, 0.0);
        let edits = [
            PathEdit::Stroke { stroke: 9, by },
            PathEdit::Point { point: 0, by },
            PathEdit::Turn { point: 99, by },
        ];
        assert_eq!(edited(path(), &edits, 0.15), path());
    }
}
