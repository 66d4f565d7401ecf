//! Zones of a part's surface and how far it may deviate there: the `[surface]` table of `part.toml`.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use geometry::units::Metres;

/// How the surface of a part is checked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SurfaceZones {
    /// True if every inspection of the part checks its surface.
    pub check: bool,
    /// The zones; of several that contain a place, the first counts. What is in none of them is judged by the noise measured
    /// there.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub zones: Vec<SurfaceZone>,
}

/// A zone with its tolerances.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SurfaceZone {
    /// Its name for people.
    pub name: String,
    /// True if nothing is judged there.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_ignored: bool,
    /// Deviation up to which a part is good, millimetres, above 0; `None` to judge by the noise alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance_mm: Option<f64>,
    /// Deviation beyond which it cannot be repaired, millimetres, at least the tolerance; `None` if it always can.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scrap_mm: Option<f64>,
    /// The places in it: x, y, z and radius of balls, part space, millimetres. A zone without balls is the whole part.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub balls_mm: Vec<[f64; 4]>,
}

/// Maximum number of balls of all zones: a part of 2 m² covered at every 15 mm.
const MAX_BALLS: usize = 10_000;

impl SurfaceZones {
    /// Returns the zone that a point of part space lies in.
    pub fn zone_at(&self, at: &Point3<f64>) -> Option<&SurfaceZone> {
        self.zones.iter().find(|zone| zone.contains(at))
    }

    /// Returns the zone of what no other zone contains, which is added if there is none.
    pub fn rest(&mut self) -> &mut SurfaceZone {
        let is_rest = |zone: &SurfaceZone| zone.balls_mm.is_empty();
        let index = self.zones.iter().position(is_rest);
        let index = index.unwrap_or_else(|| {
            self.zones.push(SurfaceZone::default());
            self.zones.len() - 1
        });
        &mut self.zones[index]
    }

    /// Returns what is wrong with the zones; `None` if nothing is.
    pub fn problem(&self) -> Option<String> {
        let num_balls: usize = self.zones.iter().map(|zone| zone.balls_mm.len()).sum();
        if num_balls > MAX_BALLS {
            return Some(format!(
                "{num_balls} balls of zones, at most {MAX_BALLS} are allowed"
            ));
        }
        self.zones.iter().find_map(|zone| {
            let what = zone.problem()?;
            Some(format!(
                "the zone {:?} of the surface has {what}",
                zone.name
            ))
        })
    }
}

impl SurfaceZone {
    /// True if a point of part space lies in it.
    pub fn contains(&self, at: &Point3<f64>) -> bool {
        let is_in = |[x, y, z, radius]: &[f64; 4]| {
            (at * 1000.0 - Point3::new(*x, *y, *z)).norm() <= *radius
        };
        self.balls_mm.is_empty() || self.balls_mm.iter().any(is_in)
    }

    /// Deviation up to which a part is good.
    pub fn tolerance(&self) -> Option<Metres> {
        self.tolerance_mm.map(Metres::from_mm)
    }

    /// Deviation beyond which it cannot be repaired.
    pub fn scrap(&self) -> Option<Metres> {
        self.scrap_mm.map(Metres::from_mm)
    }

    fn problem(&self) -> Option<&'static str> {
        let is_length = |mm: f64| mm > 0.0 && mm.is_finite();
        let limits = [self.tolerance_mm, self.scrap_mm];
        if !limits.into_iter().flatten().all(is_length) {
            return Some("a tolerance that is no length");
        }
        if let [Some(tolerance), Some(scrap)] = limits
            && scrap < tolerance
        {
            return Some("a limit of scrap below its tolerance");
        }
        let is_ball = |ball: &[f64; 4]| ball.iter().all(|x| x.is_finite()) && ball[3] > 0.0;
        (!self.balls_mm.iter().all(is_ball)).then_some("a ball without a radius")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zones() -> SurfaceZones {
        let zone = |name: &str, balls_mm: Vec<[f64; 4]>| SurfaceZone {
            name: name.to_owned(),
            tolerance_mm: Some(2.0),
            balls_mm,
            ..SurfaceZone::default()
        };
        SurfaceZones {
            check: true,
            zones: vec![
                zone("handle", vec![[100.0, 0.0, 1300.0, 50.0]]),
                zone("skin", Vec::new()),
            ],
        }
    }

    #[test]
    fn a_place_is_in_the_first_zone_that_contains_it() {
        let zones = zones();
        let name = |x: f64| {
            let zone = zones.zone_at(&Point3::new(x, 0.0, 1.3)).expect("a zone");
            zone.name.as_str()
        };
        assert_eq!(
            [name(0.1), name(0.149), name(0.151)],
            ["handle", "handle", "skin"]
        );
        assert_eq!(SurfaceZones::default().zone_at(&Point3::origin()), None);
    }

    #[test]
    fn zones_are_read_as_they_were_written_and_bad_ones_are_named() {
        type Change = fn(&mut SurfaceZone);
        let text = toml::to_string(&zones()).expect("written");
        assert_eq!(
            toml::from_str::<SurfaceZones>(&text).expect("read"),
            zones()
        );
        assert_eq!(zones().problem(), None);
        let changes: [(Change, &str); 4] = [
            (|zone| zone.tolerance_mm = Some(f64::NAN), "no length"),
            (|zone| zone.tolerance_mm = Some(0.0), "no length"),
            (|zone| zone.scrap_mm = Some(1.0), "below its tolerance"),
            (|zone| zone.balls_mm[0][3] = -1.0, "without a radius"),
        ];
        for (change, what) in changes {
            let mut bad = zones();
            change(&mut bad.zones[0]);
            let problem = bad.problem().expect("a problem");
            assert!(
                problem.contains(what) && problem.contains("handle"),
                "{problem}"
            );
        }
    }
}
