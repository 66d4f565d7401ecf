//! Registration of clouds that share no point: how often the pose is right, its uncertainty and its time.
//!
//! The paper's protocol aligns copies of the same points, which two starts along the principal axes solve. Here every
//! cloud is sampled anew from the part's surface, with noise, and moved to an arbitrary pose, like a second capture of
//! a part.

mod clouds;

use std::time::{Duration, Instant};

use nalgebra::{Point3, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use self::clouds::{hide, noisy_sample, random_sample, seen_from_outside, stray, view};
use super::bounds::{PoseAgainstTruth, hung};
use geometry::{
    cloud::PointCloud, mesh::TriangleMesh, principal::principal_axes, rigid::RigidTransform,
    units::Metres,
};
use simulate::{PartKind, PartModel, Side};
use stages::pose::{
    AlignParams, PoseError, PoseMethod, PreparedTarget, align_to, displacements::displacements,
};

/// Number of points of every target, and the most of a source.
pub const NUM_POINTS: usize = 20_000;
/// Standard deviation of each coordinate of a point, unless the condition sets another.
const NOISE: Metres = Metres(0.001);
/// Largest shift of a source, metres.
const FARTHEST: f64 = 0.8;

/// How the sources are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// The whole part at an arbitrary pose.
    Whole,
    /// One view by the simulated camera, from within 60° of the front, with a Kinect's noise.
    View,
    /// As [`Whole`](Self::Whole), without the 30 % of the part beyond a plane.
    Hidden,
    /// As [`Whole`](Self::Whole), with three times the noise.
    Noisy,
    /// As [`Whole`](Self::Whole), with one point in ten replaced by a stray one.
    Stray,
    /// As [`Whole`](Self::Whole), from T1..T5 (eq. 15) and then from random starts.
    Starts,
    /// Both clouds are random samples of 1 500 to 20 000 points, with 0.5 to 4 mm of noise along and across the
    /// surface.
    Resampled,
    /// What is visible from within 75° of the outside, sampled likewise, onto the whole part.
    Outside,
}

impl Condition {
    /// All conditions.
    pub const ALL: [Self; 8] = [
        Self::Whole,
        Self::View,
        Self::Hidden,
        Self::Noisy,
        Self::Stray,
        Self::Starts,
        Self::Resampled,
        Self::Outside,
    ];

    /// Returns whether every source has its own target.
    fn has_targets_of_its_own(self) -> bool {
        matches!(self, Self::Resampled | Self::Outside)
    }

    /// Describes the condition for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Whole => "whole, 1 mm noise, any turn, shifts to 0.8 m",
            Self::View => "one view within 60° of the front, Kinect noise",
            Self::Hidden => "30 % hidden",
            Self::Noisy => "3 mm noise",
            Self::Stray => "10 % stray points",
            Self::Starts => "from T1..T5 and from random starts",
            Self::Resampled => "both at random places, 1 500 to 20 000 points, 0.5 to 4 mm noise",
            Self::Outside => {
                "seen from within 75° of the outside, drawn likewise, onto the whole part"
            }
        }
    }
}

/// A part that is registered with itself.
#[derive(Clone, Debug, PartialEq)]
pub struct RegistrationPart {
    /// Name of the part.
    pub name: String,
    /// Surface mesh, centred, the outside towards -z.
    pub mesh: TriangleMesh,
}

impl RegistrationPart {
    /// Returns the eight parts of the simulator.
    pub fn simulated() -> Vec<Self> {
        let part = |kind: PartKind| Self {
            name: kind.name().to_owned(),
            mesh: PartModel::new(kind, Side::Left, 0).into_mesh(),
        };
        PartKind::ALL.map(part).into()
    }

    /// Creates a part from any mesh in metres.
    pub fn of_mesh(name: String, mesh: TriangleMesh) -> Self {
        let (mesh, _) = hung(mesh);
        Self { name, mesh }
    }
}

/// What to register, and how often.
#[derive(Clone, Debug, PartialEq)]
pub struct RegistrationSetup {
    /// The parts.
    pub parts: Vec<RegistrationPart>,
    /// How the sources are made.
    pub condition: Condition,
    /// Number of sources per part.
    pub num_sources: usize,
    /// Seed of all random draws.
    pub seed: u64,
    /// The methods, each with its name and parameters.
    pub methods: Vec<(String, AlignParams)>,
}

/// Result of one method on one source.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// Name of the method.
    pub method: String,
    /// Name of the part.
    pub part: String,
    /// Index of the source within the part.
    pub source: usize,
    /// Time of the estimation, without preparing the target.
    pub time: Duration,
    /// The pose found, with the error's shift at the source's centroid, or why there is none.
    pub found: Result<PoseAgainstTruth, PoseError>,
}

impl Attempt {
    /// Returns whether the pose is within 2° and 1 cm of the truth.
    pub fn is_right(&self) -> bool {
        self.found
            .as_ref()
            .is_ok_and(|f| f.error.rotation.degrees() <= 2.0 && f.error.shift.mm() <= 10.0)
    }

    /// Returns whether the error is within the reported bounds.
    pub fn is_within_bounds(&self) -> bool {
        self.found.as_ref().is_ok_and(|f| {
            f.bounds
                .is_some_and(|u| f.error.rotation.0 <= u.turn.0 && f.error.shift.0 <= u.shift.0)
        })
    }

    /// Returns whether there is no pose, or one with a warning.
    pub fn is_doubted(&self) -> bool {
        self.found.as_ref().map_or(true, |f| f.doubt.is_some())
    }
}

/// Results of all registrations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Registration {
    /// One per part, source and method, in that order.
    pub attempts: Vec<Attempt>,
    /// Time to prepare each target.
    pub preparations: Vec<Duration>,
}

/// Registers all sources, and calls `after_each` after every attempt.
pub fn register_all(setup: &RegistrationSetup, after_each: impl Fn()) -> Registration {
    let mut registration = Registration::default();
    for (k, part) in setup.parts.iter().enumerate() {
        let shared = noisy_sample(&part.mesh, NOISE, setup.seed ^ 0x7a6e);
        let mut prepared = registration.prepared(&shared);
        for source in 0..setup.num_sources {
            let seed = setup.seed + (source * setup.parts.len() + k) as u64;
            if setup.condition.has_targets_of_its_own() {
                let target = random_sample(&part.mesh, &mut Pcg64::seed_from_u64(seed ^ 0x7a6e));
                prepared = registration.prepared(&target);
            }
            let (cloud, target_from_source) = drawn_source(setup.condition, part, source, seed);
            let middle = principal_axes(cloud.points.iter().map(|p| (p.cast(), 1.0)))
                .map_or(Point3::origin(), |axes| axes.mean);
            for (method, params) in &setup.methods {
                let clock = Instant::now();
                let aligned = align_to(&cloud, &prepared, params, None, &|| false);
                let time = clock.elapsed();
                registration.attempts.push(Attempt {
                    method: method.clone(),
                    part: part.name.clone(),
                    source,
                    time,
                    found: aligned
                        .map(|pose| PoseAgainstTruth::of(&pose, &target_from_source, &middle)),
                });
                after_each();
            }
        }
    }
    registration
}

impl Registration {
    fn prepared(&mut self, target: &PointCloud) -> PreparedTarget {
        let clock = Instant::now();
        let prepared = PreparedTarget::new(target).expect("a part spans three dimensions");
        self.preparations.push(clock.elapsed());
        prepared
    }
}

/// Draws a source; also returns its true pose.
fn drawn_source(
    condition: Condition,
    part: &RegistrationPart,
    index: usize,
    seed: u64,
) -> (PointCloud, RigidTransform) {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut cloud = match condition {
        Condition::View => return view(&part.mesh, seed),
        Condition::Resampled => random_sample(&part.mesh, &mut rng),
        Condition::Outside => seen_from_outside(&part.mesh, &mut rng),
        Condition::Noisy => noisy_sample(&part.mesh, Metres(3.0 * NOISE.0), seed),
        _ => noisy_sample(&part.mesh, NOISE, seed),
    };
    match condition {
        Condition::Hidden => hide(&mut cloud, 0.3, seed),
        Condition::Stray => stray(&mut cloud, 0.1, seed),
        _ => {}
    }
    let paper = displacements();
    let source_from_target = match condition {
        Condition::Starts if index < paper.len() => paper[index],
        _ => anywhere(&mut Pcg64::seed_from_u64(seed ^ 0x905e)),
    };
    for p in &mut cloud.points {
        *p = (source_from_target * p.cast::<f64>()).cast();
    }
    (cloud, source_from_target.inverse())
}

/// Draws a uniformly random rotation, and a shift in a random direction.
fn anywhere(rng: &mut Pcg64) -> RigidTransform {
    // A unit quaternion drawn uniformly on its sphere, by rejection from the cube around it.
    let turn = loop {
        let q = nalgebra::Vector4::from([(); 4].map(|()| rng.random_range(-1.0..=1.0)));
        if (0.01..=1.0).contains(&q.norm_squared()) {
            break UnitQuaternion::from_quaternion(nalgebra::Quaternion::from(q));
        }
    };
    let shift = loop {
        let s = Vector3::from([(); 3].map(|()| rng.random_range(-1.0..=1.0)));
        if s.norm_squared() <= 1.0 {
            break s * FARTHEST;
        }
    };
    RigidTransform::from_parts(shift.into(), turn)
}

/// Returns Algorithm 3 and its variants with one component removed, to show the contribution of each.
pub fn ablation() -> Vec<(String, AlignParams)> {
    type Change = fn(&mut AlignParams);
    let full = AlignParams::from(PoseMethod::IcpGa);
    let changes: [(&str, Change); 7] = [
        ("icp-ga", |_| {}),
        ("no crossover", |p| {
            p.icp_ga.vicinity.crossover_rate = 0.0;
            p.icp_ga.elsewhere.crossover_rate = 0.0;
        }),
        ("no selection", |p| {
            p.icp_ga.vicinity.tournament = 1;
            p.icp_ga.elsewhere.tournament = 1;
        }),
        ("large mutations only", |p| {
            p.icp_ga.vicinity.mutation_decades = 0.0;
            p.icp_ga.elsewhere.mutation_decades = 0.0;
        }),
        ("no half turns", |p| p.icp_ga.elsewhere.half_turn_rate = 0.0),
        ("as many random poses", |p| {
            for genetic in [&mut p.icp_ga.vicinity, &mut p.icp_ga.elsewhere] {
                genetic.population *= genetic.generations + 1;
                genetic.generations = 0;
            }
        }),
        ("ICP from random poses", |p| {
            for genetic in [&mut p.icp_ga.vicinity, &mut p.icp_ga.elsewhere] {
                genetic.population = 0;
                genetic.generations = 0;
            }
        }),
    ];
    changes
        .into_iter()
        .map(|(name, change)| {
            let mut params = full.clone();
            change(&mut params);
            (name.to_owned(), params)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_parts_are_found_from_anywhere_and_hidden_ones_mostly() {
        let setup = |condition| RegistrationSetup {
            parts: RegistrationPart::simulated(),
            condition,
            num_sources: 1,
            seed: 500,
            methods: vec![("global".to_owned(), PoseMethod::Global.into())],
        };
        let right = |condition| {
            let done = register_all(&setup(condition), || ());
            assert_eq!(done.attempts.len(), 8);
            done.attempts.iter().filter(|a| a.is_right()).count()
        };
        assert_eq!(right(Condition::Whole), 8);
        assert!(right(Condition::Hidden) >= 7);
        assert!(right(Condition::View) >= 7);
        assert_eq!(right(Condition::Resampled), 8);
        assert!(right(Condition::Outside) >= 7);
    }
}
