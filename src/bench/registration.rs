//! Registration where no two clouds share a point: how often the pose is right, how sure it is, how long it takes.
//!
//! The paper's protocol aligns copies of the same points, which two starts along the principal axes solve. Here every
//! cloud is sampled anew from the part's surface, with noise, and brought anywhere: what a second capture of a part is.

mod clouds;

use std::time::{Duration, Instant};

use nalgebra::{Point3, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use self::clouds::{hide, noisy_sample, stray, view};
use crate::{
    geometry::{
        cloud::PointCloud,
        principal::principal_axes,
        rigid::{self, RigidTransform, pose_error},
    },
    simulate::{PartKind, PartModel, Side},
    stages::pose::{
        AlignParams, PoseError, PoseMethod, PoseWarning, PreparedTarget, Uncertainty, align_to,
        displacements::displacements,
    },
    units::Metres,
};

/// Points of every target, and of a source at most.
pub const NUM_POINTS: usize = 20_000;
/// Standard deviation of every coordinate of every point, unless it is said otherwise.
const NOISE: Metres = Metres(0.001);
/// How far a source is shifted at most.
const FARTHEST: f64 = 0.8;

/// What a source is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// The whole part, turned and shifted anyhow.
    Whole,
    /// One view by the simulated camera, from within 60° of the front, with a Kinect's noise.
    View,
    /// As whole, but for 30 % of the part beyond a plane.
    Hidden,
    /// As whole, with three times the noise.
    Noisy,
    /// As whole, with one point in ten anywhere around.
    Stray,
    /// As whole, from T1..T5 (eq. 15) and then from starts drawn anyhow.
    Starts,
}

impl Condition {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Whole,
        Self::View,
        Self::Hidden,
        Self::Noisy,
        Self::Stray,
        Self::Starts,
    ];

    /// In words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Whole => "whole, 1 mm noise, any turn, shifts to 0.8 m",
            Self::View => "one view within 60° of the front, Kinect noise",
            Self::Hidden => "30 % hidden",
            Self::Noisy => "3 mm noise",
            Self::Stray => "10 % stray points",
            Self::Starts => "from T1..T5 and from random starts",
        }
    }
}

/// What is registered, and how often.
#[derive(Clone, Debug, PartialEq)]
pub struct RegistrationSetup {
    /// What the sources are.
    pub condition: Condition,
    /// Sources of each part.
    pub num_sources: usize,
    /// Draws everything.
    pub seed: u64,
    /// The methods, each with its name and parameters.
    pub methods: Vec<(String, AlignParams)>,
}

/// One method on one source.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// The method's name.
    pub method: String,
    /// The part.
    pub part: PartKind,
    /// Place of the source among those of the part.
    pub source: usize,
    /// Time of the estimation without preparing the target.
    pub time: Duration,
    /// The pose found, or why there is none.
    pub found: Result<PoseAgainstTruth, PoseError>,
}

/// A pose beside the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseAgainstTruth {
    /// How far off the truth; the shift is that of the source's middle.
    pub error: rigid::PoseDelta,
    /// Why the pose says that it should not be relied upon.
    pub doubt: Option<PoseWarning>,
    /// How far off the pose says that it may be.
    pub uncertainty: Option<Uncertainty>,
}

impl Attempt {
    /// Within 2° and 1 cm of the truth.
    pub fn is_right(&self) -> bool {
        self.found
            .as_ref()
            .is_ok_and(|f| f.error.rotation.degrees() <= 2.0 && f.error.shift.mm() <= 10.0)
    }

    /// Within the bounds that the pose names.
    pub fn is_within_bounds(&self) -> bool {
        self.found.as_ref().is_ok_and(|f| {
            f.uncertainty
                .is_some_and(|u| f.error.rotation.0 <= u.turn.0 && f.error.shift.0 <= u.shift.0)
        })
    }

    /// No pose, or one with a doubt.
    pub fn is_doubted(&self) -> bool {
        self.found.as_ref().map_or(true, |f| f.doubt.is_some())
    }
}

/// All attempts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Registration {
    /// One per part, source and method, in that order.
    pub attempts: Vec<Attempt>,
    /// How long each part's target took to prepare.
    pub preparations: Vec<Duration>,
}

/// The caller cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the registration was cancelled")]
pub struct Cancelled;

/// Registers all sources; `after_each` is shown every attempt as it comes.
pub fn register_all(
    setup: &RegistrationSetup,
    mut after_each: impl FnMut(&Attempt),
    is_cancelled: &dyn Fn() -> bool,
) -> Result<Registration, Cancelled> {
    let mut registration = Registration::default();
    for (k, part) in PartKind::ALL.into_iter().enumerate() {
        let model = PartModel::new(part, Side::Left, 0);
        let target = noisy_target(&model, setup.seed);
        let clock = Instant::now();
        let prepared = PreparedTarget::new(&target).expect("a part spans three dimensions");
        registration.preparations.push(clock.elapsed());
        for source in 0..setup.num_sources {
            let seed = setup.seed + (source * PartKind::ALL.len() + k) as u64;
            let (cloud, target_from_source) = drawn_source(setup.condition, &model, source, seed);
            let middle = principal_axes(cloud.points.iter().map(|p| (p.cast(), 1.0)))
                .map_or(Point3::origin(), |axes| axes.mean);
            for (method, params) in &setup.methods {
                let clock = Instant::now();
                let aligned = align_to(&cloud, &prepared, params, None, is_cancelled);
                let time = clock.elapsed();
                if is_cancelled() {
                    return Err(Cancelled);
                }
                let attempt = Attempt {
                    method: method.clone(),
                    part,
                    source,
                    time,
                    found: aligned.map(|pose| PoseAgainstTruth {
                        error: pose_error(&pose.target_from_source, &target_from_source, &middle),
                        doubt: pose.doubt(),
                        uncertainty: pose.uncertainty,
                    }),
                };
                after_each(&attempt);
                registration.attempts.push(attempt);
            }
        }
    }
    Ok(registration)
}

/// What the sources of a part are registered to.
pub fn noisy_target(model: &PartModel, seed: u64) -> PointCloud {
    noisy_sample(model.mesh(), NOISE, seed ^ 0x7a6e)
}

/// A source, and the pose that puts it back.
pub fn drawn_source(
    condition: Condition,
    model: &PartModel,
    place: usize,
    seed: u64,
) -> (PointCloud, RigidTransform) {
    if condition == Condition::View {
        return view(model, seed);
    }
    let noise = match condition {
        Condition::Noisy => Metres(3.0 * NOISE.0),
        _ => NOISE,
    };
    let mut cloud = noisy_sample(model.mesh(), noise, seed);
    match condition {
        Condition::Hidden => hide(&mut cloud, 0.3, seed),
        Condition::Stray => stray(&mut cloud, 0.1, seed),
        _ => {}
    }
    let paper = displacements();
    let source_from_target = match condition {
        Condition::Starts if place < paper.len() => paper[place],
        _ => anywhere(&mut Pcg64::seed_from_u64(seed ^ 0x905e)),
    };
    for p in &mut cloud.points {
        *p = (source_from_target * p.cast::<f64>()).cast();
    }
    (cloud, source_from_target.inverse())
}

/// Any turn, each as likely as any other, and a shift in any direction.
fn anywhere(rng: &mut Pcg64) -> RigidTransform {
    // A unit quaternion drawn evenly on its sphere, by rejection from the cube around it.
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

/// Algorithm 3 and what is left of it without each of its means: what pays?
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
            condition,
            num_sources: 1,
            seed: 500,
            methods: vec![("global".to_owned(), PoseMethod::Global.into())],
        };
        let right = |condition| {
            let done = register_all(&setup(condition), |_| (), &|| false).expect("to the end");
            assert_eq!(done.attempts.len(), 8);
            done.attempts.iter().filter(|a| a.is_right()).count()
        };
        assert_eq!(right(Condition::Whole), 8);
        assert!(right(Condition::Hidden) >= 7);
        assert!(right(Condition::View) >= 7);
    }

    #[test]
    fn cancelling_ends_it() {
        let setup = RegistrationSetup {
            condition: Condition::Whole,
            num_sources: 1,
            seed: 1,
            methods: vec![("global".to_owned(), PoseMethod::Global.into())],
        };
        assert_eq!(register_all(&setup, |_| (), &|| true), Err(Cancelled));
    }
}
