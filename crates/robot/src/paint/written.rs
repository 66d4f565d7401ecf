//! The film that a program leaves as it is written: with its stops, accelerations and blends.
//!
//! The motion of the program ([`Program::motion`]) is carried back to the part and simulated like a path, whose speed is
//! that of each short piece. A robot that stops with the gun open, or accelerates more slowly than planned, leaves more
//! paint there.

use nalgebra::{Point3, Unit, Vector3};

use super::{
    coat::Coat,
    film::{Film, simulate},
    surface::PaintSurface,
};
use crate::program::{MotionPiece, Program, RobotLanguage};
use geometry::cloud::PointCloud;
use inspection::library::{PathPoint, Side, SprayPath};
use stages::reference::Coverage;
use texts::{Described, Message};

/// Least share of the paintable surface within the tolerance for a film to be good.
pub const LEAST_WITHIN: f64 = 0.9;
/// Largest loss of that share which is no reason for a doubt about a program of a path that is below the limit itself.
const MAX_LOST_SHARE: f64 = 0.05;

/// The films of a path and of a program of it.
#[derive(Clone, Debug)]
pub struct WrittenFilm {
    /// The coat that the path was planned with.
    pub coat: Coat,
    /// Film of the path at its own speeds.
    pub planned: Film,
    /// Film of the program.
    pub written: Film,
    /// Number of stops where the gun sprays, opens or closes.
    pub num_stops: usize,
}

impl WrittenFilm {
    /// Simulates the film of a program of a path over the part that was enrolled with this cloud, seen from a
    /// chosen side or from its own; `None` if the path names
    /// no coat, never sprays, or cannot be written as a program, which saving it reports.
    pub fn of(
        program: &Program<'_>,
        language: &'static RobotLanguage,
        path: &SprayPath,
        enrolled: &PointCloud,
        coverage: Coverage,
        side: Option<Side>,
    ) -> Option<Self> {
        let coat = Coat::of_path(path)?;
        let surface = PaintSurface::of_cloud(enrolled, coverage, side).ok()?;
        let pieces = program.motion(language).ok()?;
        let moved = moved(&pieces, path, program, &coat)?;
        Some(Self {
            coat,
            planned: simulate(&surface, path, &coat, &[]).ok()?,
            written: simulate(&surface, &moved, &coat, &[]).ok()?,
            num_stops: pieces
                .windows(2)
                .filter(|pair| pair[1].is_from_stop)
                .filter(|pair| pair.iter().any(|piece| piece.is_gun_on))
                .count(),
        })
    }

    /// Figures of the program's film, and of the path's, for the header of the program.
    pub fn line(&self) -> String {
        let [written, planned] = [&self.written, &self.planned].map(|film| {
            format!(
                "{:.1} % of the surface within {:.0} % of {:.1} µm, {:.1} µm on average, {:.0} s",
                100.0 * film.figures.within,
                100.0 * self.coat.tolerance,
                1e6 * self.coat.target,
                1e6 * film.figures.mean,
                film.path.time
            )
        });
        format!("{written} (planned: {planned})")
    }

    /// The reason against a program whose film is below the limit, or worse than planned if the path is below it.
    pub fn doubt(&self) -> Option<FilmOffPlan> {
        let [written, planned] = [&self.written, &self.planned].map(|film| &film.figures);
        let least = if planned.within >= LEAST_WITHIN {
            LEAST_WITHIN
        } else {
            planned.within - MAX_LOST_SHARE
        };
        (written.within < least).then_some(FilmOffPlan {
            within: [planned.within, written.within],
            mean: [planned.mean, written.mean],
            tolerance: self.coat.tolerance,
            num_stops: self.num_stops,
        })
    }
}

/// A program that leaves another film than its path was planned for.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub struct FilmOffPlan {
    /// Shares of the surface within the tolerance: planned, and of the program.
    pub within: [f64; 2],
    /// Mean thicknesses, metres: planned, and of the program.
    pub mean: [f64; 2],
    /// Accepted deviation from the target, as a share of it.
    pub tolerance: f64,
    /// Stops where the gun sprays, opens or closes.
    pub num_stops: usize,
}

impl Described for FilmOffPlan {
    fn message(&self) -> Message {
        let ([planned, written], [planned_m, written_m]) = (self.within, self.mean);
        Message::new("doubt-film-off-plan")
            .with("planned", planned)
            .with("written", written)
            .with("planned_m", planned_m)
            .with("written_m", written_m)
            .with("tolerance", self.tolerance)
            .with("num_stops", self.num_stops as f64)
    }
}

texts::display!(FilmOffPlan);

/// The motion as a path over the part.
fn moved(
    pieces: &[MotionPiece],
    path: &SprayPath,
    program: &Program<'_>,
    coat: &Coat,
) -> Option<SprayPath> {
    let part_from_robot = program.robot_from_part.inverse();
    let last = path.points().len() - 1;
    let point = |piece: &MotionPiece, end: usize, speed: Option<f64>| {
        let planned = &path.points()[piece.point.unwrap_or(0).min(last)];
        let part_from_nozzle = part_from_robot * piece.robot_from_nozzle[end];
        PathPoint {
            nozzle: Point3::from(part_from_nozzle.translation.vector),
            direction: Unit::new_normalize(part_from_nozzle * Vector3::z()),
            stand_off: planned.stand_off,
            is_gun_on: piece.is_gun_on && end == 0,
            speed,
            fan: planned
                .fan
                .map(|_| Unit::new_normalize(part_from_nozzle * Vector3::x())),
        }
    };
    let mut points = Vec::with_capacity(pieces.len() + 1);
    for piece in pieces {
        let speed = if piece.seconds > 0.0 {
            piece.length() / piece.seconds
        } else {
            coat.speed
        };
        points.push(point(piece, 0, Some(speed)));
    }
    points.extend(pieces.last().map(|piece| point(piece, 1, None)));
    SprayPath::new(points)
}
