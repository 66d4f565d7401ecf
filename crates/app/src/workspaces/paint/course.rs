//! Times along a spray path, and the gun at a time.

use nalgebra::{Point3, Unit, Vector3};

use inspection::library::SprayPath;

/// Times along a path, from 0 at its first point.
#[derive(Clone, Debug, Default)]
pub struct GunCourse {
    /// Time at each point, seconds.
    pub seconds: Vec<f64>,
    /// Indices of the first and the last point of each stroke.
    pub strokes: Vec<[usize; 2]>,
}

/// The gun at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GunState {
    /// Position of the nozzle, part frame.
    pub nozzle: Point3<f64>,
    /// Direction of the jet.
    pub direction: Unit<Vector3<f64>>,
    /// True while it sprays.
    pub is_on: bool,
    /// Its speed, m/s.
    pub speed: f64,
    /// Index of the present or next stroke; the number of strokes after the last.
    pub stroke: usize,
}

impl GunCourse {
    /// Computes the times of a path; `speed` in m/s applies where the path sets none.
    pub fn of(path: &SprayPath, speed: f64) -> Self {
        let mut seconds = vec![0.0];
        let mut now = 0.0;
        for pair in path.points().windows(2) {
            now += (pair[1].nozzle - pair[0].nozzle).norm() / pair[0].speed.unwrap_or(speed);
            seconds.push(now);
        }
        Self {
            seconds,
            strokes: path.strokes(),
        }
    }

    /// Duration of the whole path, seconds.
    pub fn duration(&self) -> f64 {
        self.seconds.last().copied().unwrap_or(0.0)
    }

    /// Begin and end of a stroke, seconds.
    pub fn times(&self, stroke: [usize; 2]) -> [f64; 2] {
        stroke.map(|point| self.seconds[point])
    }

    /// Returns the gun at a time in seconds; `path` must be the path of this course.
    pub fn at(&self, path: &SprayPath, speed: f64, time: f64) -> GunState {
        let points = path.points();
        let behind = self.seconds.partition_point(|t| *t <= time);
        let i = behind.saturating_sub(1).min(points.len() - 1);
        let j = (i + 1).min(points.len() - 1);
        let (a, b) = (&points[i], &points[j]);
        let span = self.seconds[j] - self.seconds[i];
        let share = if span > 0.0 {
            ((time - self.seconds[i]) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let between = a.direction.lerp(&b.direction, share);
        GunState {
            nozzle: a.nozzle + (b.nozzle - a.nozzle) * share,
            direction: Unit::try_new(between, 1e-9).unwrap_or(a.direction),
            is_on: a.is_gun_on && j > i,
            speed: a.speed.unwrap_or(speed),
            stroke: self.strokes.partition_point(|[_, last]| *last <= i),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::library::PathPoint;

    #[test]
    fn the_gun_is_where_time_and_speed_put_it() {
        let at = |x: f64, is_gun_on, speed| PathPoint {
            nozzle: Point3::new(x, 0.0, 0.0),
            direction: Vector3::z_axis(),
            stand_off: None,
            is_gun_on,
            speed,
            fan: None,
        };
        // 0.5 s off, 1 s on, 0.5 s off, 2 s on.
        let points = vec![
            at(0.0, false, Some(0.2)),
            at(0.1, true, None),
            at(0.5, false, Some(0.2)),
            at(0.6, true, Some(0.2)),
            at(1.0, false, None),
        ];
        let path = SprayPath::new(points).expect("a path");
        let course = GunCourse::of(&path, 0.4);
        assert!((course.duration() - 4.0).abs() < 1e-9);
        let times: Vec<[f64; 2]> = course.strokes.iter().map(|s| course.times(*s)).collect();
        for (found, expected) in times.iter().zip([[0.5, 1.5], [2.0, 4.0]]) {
            assert!((found[0] - expected[0]).abs() < 1e-9 && (found[1] - expected[1]).abs() < 1e-9);
        }
        for (time, x, is_on, speed, stroke) in [
            (0.0, 0.0, false, 0.2, 0),
            (0.25, 0.05, false, 0.2, 0),
            (1.0, 0.3, true, 0.4, 0),
            (1.75, 0.55, false, 0.2, 1),
            (3.0, 0.8, true, 0.2, 1),
            (4.0, 1.0, false, 0.4, 2),
            (99.0, 1.0, false, 0.4, 2),
        ] {
            let gun = course.at(&path, 0.4, time);
            assert!((gun.nozzle.x - x).abs() < 1e-9, "{time}: {gun:?}");
            assert_eq!((gun.is_on, gun.stroke), (is_on, stroke), "{time}");
            assert!((gun.speed - speed).abs() < 1e-9, "{time}");
        }
    }
}
