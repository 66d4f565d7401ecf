//! How much thicker the film of a path may become before it leaves the tolerance of its coat.

use super::{
    coat::Coat,
    film::{are_paintable, deposits},
    surface::PaintSurface,
};
use crate::arm::FilmRoom;
use geometry::cloud::PointCloud;
use inspection::library::{Side, SprayPath};
use stages::reference::Coverage;

/// What a point that is too thick anyway may gain, as a share of the target.
const THICK_ROOM_SHARE: f64 = 0.05;
/// Deposits are rounded: a film within the tolerance keeps this share of the target free.
const ROUNDING_SHARE: f64 = 0.001;

impl FilmRoom {
    /// The room of a path over the part that was enrolled with this cloud, seen from a chosen side or from its own; `None`
    /// if the path names no coat.
    pub fn of_path(
        path: &SprayPath,
        enrolled: &PointCloud,
        coverage: Coverage,
        side: Option<Side>,
    ) -> Option<Self> {
        let coat = Coat::of_path(path)?;
        let surface = PaintSurface::of_cloud(enrolled, coverage, side).ok()?;
        Some(room_of(path, &surface, &coat))
    }
}

fn room_of(path: &SprayPath, surface: &PaintSurface, coat: &Coat) -> FilmRoom {
    let mut sprayed = deposits(surface, path.points(), coat).into_iter();
    let ways = path.points().windows(2).map(|pair| {
        let is_sprayed = pair[0].is_gun_on && pair[1].nozzle != pair[0].nozzle;
        let deposit = is_sprayed.then(|| sprayed.next());
        deposit.flatten().unwrap_or_default()
    });
    let ways: Vec<_> = ways.collect();
    let mut film = vec![0.0; surface.points.len()];
    for (point, thickness) in ways.iter().flatten() {
        film[*point as usize] += f64::from(*thickness);
    }
    let most = coat.target * (1.0 + coat.tolerance);
    let room = film.iter().zip(are_paintable(surface, coat, &[]));
    let room = room.map(|(thickness, is_paintable)| match most - thickness {
        _ if !is_paintable => f64::INFINITY,
        left if left < 0.0 => coat.target * THICK_ROOM_SHARE,
        left => (left - coat.target * ROUNDING_SHARE).max(0.0),
    });
    FilmRoom::new(ways, room.collect())
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::*;
    use crate::paint::{plan, simulate, surface::tests::grid};

    #[test]
    fn a_path_that_takes_longer_within_its_room_leaves_no_more_of_the_part_outside_the_tolerance() {
        let surface = grid(61, 61, Coverage::OneSide, |i, j| {
            let (x, angle) = (0.8 * i - 0.4, 1.2 * (j - 0.5));
            let normal = Vector3::new(0.0, angle.sin(), angle.cos());
            (Point3::from(normal * 0.4 + Vector3::x() * x), normal)
        });
        let coat = Coat::default();
        let path = plan(&surface, &coat, &[]).expect("planned");
        let before = simulate(&surface, &path, &coat, &[]).expect("simulated");
        let room = room_of(&path, &surface, &coat);
        let slowed = |which: &dyn Fn(usize) -> bool| {
            let asked = (0..path.points().len() - 1).map(|i| if which(i) { 2.0 } else { 0.0 });
            let mut longer: Vec<f64> = asked.collect();
            room.limit(&mut longer);
            let mut points = path.points().to_vec();
            for (point, longer) in points.iter_mut().zip(&longer) {
                point.speed = point.speed.map(|speed| speed / (1.0 + longer));
            }
            let path = SprayPath::new(points).expect("points");
            let film = simulate(&surface, &path, &coat, &[]).expect("simulated");
            let added = film.path.time - before.path.time;
            (film.figures.within, longer, added)
        };
        let is_on = |i: usize| path.points()[i].is_gun_on;
        for (step, phase) in [(1, 0), (9, 3), (17, 5)] {
            let (within, longer, added) = slowed(&|i| is_on(i) && i % step == phase);
            assert!(within >= before.figures.within - 1e-9, "{step}: {within}");
            assert!(added > 0.05, "{step}: {added}");
            let more = longer.iter().filter(|longer| **longer > 0.1).count();
            assert!(more > 3, "{step}: {more}");
        }
    }
}
