//! Inspects the frames of a suite and counts what came of them.

use nalgebra::Point3;
use serde::Serialize;

use super::{Suite, SuiteFrame, enrolled_name};
use crate::{
    bench::speed::quantile,
    geometry::rigid::{RigidTransform, pose_error},
    library::{About, EnrolError, EnrolParams, Library, PartName, enrol_captured},
    pipeline::{Cancelled, Inspection, Recipe, Verdict, Watch, run},
    simulate::{CellSetup, PartKind, PartPose, Side, Truth, frame, frame_of_mesh},
    stages::{
        confirm::Evidence,
        rank::MatchEntry,
        reference::Reference,
        scene::{SceneCloud, scene_from_frame},
    },
};

/// The libraries that the suites are inspected against: standard parts, each enrolled from one frontal capture.
#[derive(Clone, Debug)]
pub struct SuiteLibraries {
    /// The eight, left where there are sides.
    pub left: Library,
    /// The same and the right-hand ones.
    pub both_sides: Library,
}

impl SuiteLibraries {
    /// Enrols the parts.
    pub fn enrol(params: &EnrolParams) -> Result<Self, EnrolError> {
        let enrol = |kind, side| enrol_part(kind, side, 0, params);
        let left = PartKind::ALL
            .into_iter()
            .map(|kind| enrol(kind, Side::Left))
            .collect::<Result<Vec<_>, _>>()?;
        let right = PartKind::ALL
            .into_iter()
            .filter(|kind| kind.is_sided())
            .map(|kind| enrol(kind, Side::Right))
            .collect::<Result<Vec<_>, _>>()?;
        let both = left.iter().cloned().chain(right).collect();
        Ok(Self {
            left: Library { references: left },
            both_sides: Library { references: both },
        })
    }

    /// The one that a suite is inspected against.
    pub fn of(&self, suite: Suite) -> &Library {
        match suite {
            Suite::BothSides => &self.both_sides,
            _ => &self.left,
        }
    }
}

/// Where the standard parts hang when they are enrolled: square on, 1.3 m before the camera.
pub(in crate::bench) fn enrolment_pose() -> RigidTransform {
    RigidTransform::translation(0.0, 0.0, 1.3)
}

/// A part of a model of the car, enrolled from one capture; 0 is the standard one.
pub(in crate::bench) fn enrol_part(
    kind: PartKind,
    side: Side,
    model_seed: u64,
    params: &EnrolParams,
) -> Result<Reference, EnrolError> {
    let mut setup = CellSetup::with_part(kind, side, model_seed, 1);
    setup.pose = PartPose::Fixed(enrolment_pose());
    let shot = frame(&setup);
    let about = About {
        name: PartName::new(&enrolled_name(kind, side)).expect("our own names are valid"),
        title: kind.title().to_owned(),
        notes: String::new(),
        from: "simulated cell".to_owned(),
        at: jiff::Timestamp::UNIX_EPOCH,
        simulated: true,
    };
    Ok(enrol_captured(&scene_from_frame(&shot.frame), &about, params)?.reference)
}

/// What one frame came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SuiteCase {
    /// What hung there.
    pub subject: String,
    /// The name that is right; `None` if nothing may be accepted.
    pub expected: Option<String>,
    /// The frame's seed.
    pub seed: u64,
    /// The best guess; `None` if nothing was recognised.
    pub found: Option<String>,
    /// Its score.
    pub score: f64,
    /// Its lead.
    pub margin: f64,
    /// Whether it was accepted.
    pub accepted: bool,
    /// Whether it was called unknown, or the mirror image of what is enrolled.
    pub is_unknown: bool,
    /// Why not.
    pub reason: Option<String>,
    /// Time of the whole inspection, milliseconds.
    pub total_ms: f64,
    /// The first few of the ranking that were put in their place.
    pub contenders: Vec<Contender>,
}

/// One reference at the pose that was found for it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contender {
    /// Its name.
    pub part: String,
    /// Its score.
    pub score: f64,
    /// What the score is made of.
    pub evidence: Evidence,
    /// For the part that hangs there: how far the pose is off, degrees and millimetres at the part's middle.
    pub pose_off: Option<[f64; 2]>,
}

/// Contenders written per frame.
const NUM_CONTENDERS: usize = 3;

impl SuiteCase {
    fn of(frame: &SuiteFrame, truth: &Truth, inspection: &Inspection) -> Self {
        let (found, score, margin, reason) = match &inspection.verdict {
            Verdict::Part {
                part,
                score,
                margin,
                rejected,
            } => (
                Some(part.clone()),
                *score,
                *margin,
                rejected.as_ref().map(ToString::to_string),
            ),
            Verdict::NoPart(reason) => (None, 0.0, 0.0, Some(reason.to_string())),
        };
        Self {
            subject: frame.subject(),
            expected: frame.expected.clone(),
            seed: frame.setup.seed,
            found,
            score,
            margin,
            accepted: reason.is_none(),
            is_unknown: inspection.verdict.is_unknown(),
            reason,
            total_ms: inspection.timings.total.as_secs_f64() * 1e3,
            contenders: inspection
                .ranking
                .entries
                .iter()
                .take(NUM_CONTENDERS)
                .filter_map(|entry| contender(frame, truth, entry))
                .collect(),
        }
    }

    /// The right name; or, where there is none, not accepted.
    pub fn is_right(&self) -> bool {
        match &self.expected {
            Some(name) => self.found.as_ref() == Some(name),
            None => !self.accepted,
        }
    }

    /// Accepted as something that it is not: the robot would move.
    pub fn is_wrong_accepted(&self) -> bool {
        self.accepted && self.found != self.expected
    }
}

fn contender(frame: &SuiteFrame, truth: &Truth, entry: &MatchEntry) -> Option<Contender> {
    let is_there = frame.expected.as_ref() == Some(&entry.part);
    let pose_off = entry.pose.as_ref().filter(|_| is_there).map(|pose| {
        // The reference's space is the camera's when the part was enrolled.
        let camera_from_part = truth.camera_from_part * enrolment_pose().inverse();
        let middle = enrolment_pose() * Point3::origin();
        let off = pose_error(&pose.camera_from_part(), &camera_from_part, &middle);
        [off.rotation.degrees(), off.shift.mm()]
    });
    Some(Contender {
        part: entry.part.clone(),
        score: entry.score,
        evidence: entry.evidence?,
        pose_off,
    })
}

/// What a suite came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SuiteResult {
    /// The suite.
    pub suite: Suite,
    /// One case per frame.
    pub cases: Vec<SuiteCase>,
}

impl SuiteResult {
    /// How many cases are so.
    pub fn num(&self, is_so: impl Fn(&SuiteCase) -> bool) -> usize {
        self.cases.iter().filter(|case| is_so(case)).count()
    }

    /// Median time of an inspection, milliseconds.
    pub fn median_ms(&self) -> Option<f64> {
        quantile(self.cases.iter().map(|case| case.total_ms), 0.5)
    }

    /// What was taken for what, how often, and how often accepted, the worst first.
    pub fn confusions(&self) -> Vec<Confusion> {
        let mut confusions: Vec<Confusion> = Vec::new();
        let is_wrong = |case: &&SuiteCase| !case.is_right() || case.is_wrong_accepted();
        for case in self.cases.iter().filter(is_wrong) {
            let known = confusions
                .iter_mut()
                .find(|c| c.subject == case.subject && c.found == case.found);
            let accepted = usize::from(case.accepted);
            match known {
                Some(known) => {
                    known.num += 1;
                    known.num_accepted += accepted;
                }
                None => confusions.push(Confusion {
                    subject: case.subject.clone(),
                    found: case.found.clone(),
                    num: 1,
                    num_accepted: accepted,
                    first_seed: case.seed,
                }),
            }
        }
        confusions.sort_by_key(|c| std::cmp::Reverse((c.num_accepted, c.num)));
        confusions
    }
}

/// One thing taken for another.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Confusion {
    /// What hung there.
    pub subject: String,
    /// What it was taken for; `None` for nothing.
    pub found: Option<String>,
    /// How often.
    pub num: usize,
    /// How often it was accepted.
    pub num_accepted: usize,
    /// The seed of the first such frame.
    pub first_seed: u64,
}

/// Inspects the frames of a suite; `after_each` is called with every frame's outcome, its scene and what was found.
pub fn run_suite(
    suite: Suite,
    frames: &[SuiteFrame],
    library: &Library,
    recipe: &Recipe,
    watch: &dyn Watch,
    mut after_each: impl FnMut(&SuiteCase, &SceneCloud, &Inspection),
) -> Result<SuiteResult, Cancelled> {
    let mut cases = Vec::with_capacity(frames.len());
    for frame in frames {
        let shot = frame_of_mesh(&frame.setup, &frame.setup.subject.mesh());
        let scene = scene_from_frame(&shot.frame);
        let inspection = run(&scene, library, recipe, watch)?;
        let case = SuiteCase::of(frame, &shot.truth, &inspection);
        after_each(&case, &scene, &inspection);
        cases.push(case);
    }
    Ok(SuiteResult { suite, cases })
}
