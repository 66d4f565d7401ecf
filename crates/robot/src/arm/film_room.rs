//! How much longer a gun may take for the ways of a path before its film leaves the tolerance.
//!
//! What a way leaves grows with the time that the gun takes for it. If way j leaves aᵢⱼ at point i of the surface and
//! takes the share eⱼ longer than planned, the film grows by Σⱼ aᵢⱼ eⱼ there, which must not exceed the room of that
//! point. Where it would, all ways that paint the point are given the same part of what they ask for.

/// What each way of a path leaves on a surface, and how much thicker the film may become.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmRoom {
    /// For each way from one point of the path to the next, the points of the surface that it paints, and the thickness
    /// at each at the planned speed, metres.
    ways: Vec<Vec<(u32, f32)>>,
    /// Thickness that each point of the surface may gain, metres, 0 or more.
    room: Vec<f64>,
}

impl FilmRoom {
    pub(crate) fn new(ways: Vec<Vec<(u32, f32)>>, room: Vec<f64>) -> Self {
        Self { ways, room }
    }

    /// Reduces the times that ways take longer, as shares of their planned times, to what the film allows. The first
    /// belongs to the way from the first point of the path; those beyond the last way stay.
    pub(crate) fn limit(&self, longer: &mut [f64]) {
        let mut gain = vec![0.0; self.room.len()];
        let asked = self.ways.iter().zip(longer.iter());
        for (way, longer) in asked.filter(|(_, longer)| **longer > 0.0) {
            for (point, thickness) in way {
                gain[*point as usize] += longer * f64::from(*thickness);
            }
        }
        let granted = |point: u32| {
            let (gain, room) = (gain[point as usize], self.room[point as usize]);
            if gain > room { room / gain } else { 1.0 }
        };
        let asked = self.ways.iter().zip(longer.iter_mut());
        for (way, longer) in asked.filter(|(_, longer)| **longer > 0.0) {
            let shares = way.iter().map(|(point, _)| granted(*point));
            *longer *= shares.fold(1.0, f64::min);
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;

    #[test]
    fn whatever_is_asked_for_no_point_gains_more_than_its_room_and_none_gives_up_more_than_needed()
    {
        let mut random = Pcg64::seed_from_u64(3);
        for _ in 0..50 {
            let ways: Vec<Vec<(u32, f32)>> = (0..20)
                .map(|way| {
                    let first = 2 * way;
                    (first..first + 6)
                        .map(|point| (point, random.random_range(0.0..1e-5)))
                        .collect()
                })
                .collect();
            let room: Vec<f64> = (0..44).map(|_| random.random_range(0.0..1e-5)).collect();
            let film = FilmRoom::new(ways.clone(), room.clone());
            let asked: Vec<f64> = (0..21)
                .map(|_| random.random_range(-1.0..2.0_f64).max(0.0))
                .collect();
            let mut longer = asked.clone();
            film.limit(&mut longer);
            let gain = |longer: &[f64], point: u32| -> f64 {
                let each = ways.iter().zip(longer).map(|(way, longer)| {
                    let here = way.iter().find(|(at, _)| *at == point);
                    here.map_or(0.0, |(_, thickness)| longer * f64::from(*thickness))
                });
                each.sum()
            };
            for (point, room) in (0..).zip(&room) {
                assert!(gain(&longer, point) <= room * (1.0 + 1e-9));
            }
            for ((way, asked_for), granted) in ways.iter().zip(&asked).zip(&longer) {
                let is_needed = way
                    .iter()
                    .any(|(point, _)| gain(&asked, *point) > room[*point as usize]);
                assert!((0.0..=*asked_for).contains(granted));
                assert_eq!(granted < asked_for, is_needed && *asked_for > 0.0);
            }
            // There is no way from the last point.
            assert_eq!(longer[20].to_bits(), asked[20].to_bits());
        }
    }
}
