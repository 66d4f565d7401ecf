//! The left half of the paper's Table I: the time to recognise a part, ours beside other systems, and how often right.
//!
//! The paper compares its recogniser with four "major 3-D object detection systems" by time alone, and gives the
//! others as numbers of its bibliography. So the other systems here are our own choice: the major descriptors of
//! point clouds, each with a nearest-neighbour search. Every system gets the same segmented part of the same
//! simulated frame and names one of the same references; nobody may refuse. The time is the processor's, for
//! describing the part and matching it; segmentation, which all share, and preparing the references are left out.

use std::time::{Duration, Instant};

use nalgebra::Point3;

use super::recognition::{EnrolledStandard, RecognitionSetup};
use crate::{
    app::headless::thread_seconds,
    library::Library,
    pipeline::Recipe,
    simulate::{CellSetup, PartKind, PartModel, PartPose, Side, frame_of_mesh},
    stages::{
        confirm::{Scene, confirm},
        contour::find_contour,
        descriptors::{
            Descriptors,
            local::{LocalParams, describe_reference, describe_scene},
            matching::{DescriptorBank, rank_by_rows},
            surface::{SurfaceError, SurfaceParams, take_surface},
            vfh::{ViewHistogram, describe_vfh, describe_views, nearest_reference},
        },
        project::project,
        rank::{MatchRanking, Matcher, Query, rank},
        reference::{Coverage, Reference, ReferenceError, ReferenceParams},
        scene::{SceneCloud, scene_from_frame},
        segment::{SegmentedPart, segment},
        signature::describe,
    },
};

/// Columns of the paper's Table I: four systems by their numbers in its bibliography, and its own.
pub const PAPER_COLUMNS: [&str; 5] = ["[22]", "[44]", "[45]", "[46]", "proposed"];

/// The paper's Table I, seconds, for each of [`PartKind::ALL`] and each of [`PAPER_COLUMNS`].
pub const PAPER_SECONDS: [[f64; 5]; 8] = [
    [45.4, 159.9, 128.1, 26.7, 0.084],
    [57.9, 154.4, 136.5, 32.1, 0.0554],
    [53.1, 168.0, 135.5, 32.0, 0.0514],
    [54.6, 144.6, 138.3, 34.6, 0.05113],
    [54.0, 158.9, 142.6, 32.5, 0.0515],
    [33.4, 87.8, 120.7, 19.7, 0.0598],
    [34.0, 92.7, 121.0, 20.0, 0.0601],
    [35.3, 96.0, 121.0, 23.0, 0.05101],
];

/// What the paper's text gives as the mean of the four, seconds.
pub const PAPER_MEAN_OF_OTHERS: f64 = 84.2161;

/// What the paper's text gives as the mean of its own, seconds; its Table I has 0.058.
pub const PAPER_MEAN_OF_OWN: f64 = 0.0890;

/// A way of recognising a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum System {
    /// The paper's recogniser.
    Paper,
    /// Our ranking by outline and overlap.
    Rank,
    /// Our ranking, its best few confirmed by their poses: the default.
    Confirmed,
    /// Viewpoint feature histogram, nearest view.
    Vfh,
    /// Spin images.
    SpinImages,
    /// Fast point feature histograms.
    Fpfh,
    /// Signatures of histograms of orientations.
    Shot,
}

impl System {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 7] = [
        Self::Paper,
        Self::Rank,
        Self::Confirmed,
        Self::Vfh,
        Self::SpinImages,
        Self::Fpfh,
        Self::Shot,
    ];

    /// Its name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Paper => "the paper's matcher",
            Self::Rank => "ours, ranking only",
            Self::Confirmed => "ours, with confirmation",
            Self::Vfh => "VFH",
            Self::SpinImages => "spin images",
            Self::Fpfh => "FPFH",
            Self::Shot => "SHOT",
        }
    }

    /// Who described it first.
    pub fn source(self) -> &'static str {
        match self {
            Self::Paper => "the paper, Algorithm 2",
            Self::Rank | Self::Confirmed => "Partsight",
            Self::Vfh => "Rusu et al. 2010",
            Self::SpinImages => "Johnson and Hebert 1999",
            Self::Fpfh => "Rusu et al. 2009",
            Self::Shot => "Tombari et al. 2010",
        }
    }

    /// The parameters of a local descriptor; `None` for the other systems.
    fn local(self) -> Option<LocalParams> {
        match self {
            Self::SpinImages => Some(LocalParams::spin_images()),
            Self::Fpfh => Some(LocalParams::fpfh()),
            Self::Shot => Some(LocalParams::shot()),
            Self::Paper | Self::Rank | Self::Confirmed | Self::Vfh => None,
        }
    }
}

/// What a system made of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The reference it names; `None` if it could not describe the part.
    pub found: Option<String>,
    /// Describing the part and matching it with all references.
    pub time: Duration,
    /// Of a descriptor: what it was taken from.
    pub size: Option<Size>,
}

/// What a descriptor was taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Size {
    /// Points of the thinned surface.
    pub num_points: usize,
    /// Rows that describe it.
    pub num_rows: usize,
}

/// One frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The part in it.
    pub truth: PartKind,
    /// Its seed.
    pub seed: u64,
    /// Points of the segmented part; `None` if segmentation found none.
    pub num_points: Option<usize>,
    /// For each of [`System::ALL`]; empty without a part.
    pub answers: Vec<Answer>,
}

impl Frame {
    /// True if the system of this place in [`System::ALL`] named the part in the frame.
    pub fn is_right(&self, system: usize) -> bool {
        let found = self.answers.get(system).and_then(|a| a.found.as_deref());
        found == Some(self.truth.name())
    }
}

/// What was prepared of the references for one system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preparation {
    /// For all references together.
    pub time: Duration,
    /// Rows of a descriptor, of all references together; `None` for ours and the paper's.
    pub num_rows: Option<usize>,
}

/// All systems on all frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The frames.
    pub frames: Vec<Frame>,
    /// For each of [`System::ALL`].
    pub preparations: Vec<Preparation>,
}

/// Why there is no comparison.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CompareError {
    /// A reference cannot be described.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A reference cannot be prepared.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
}

impl crate::error::Advice for CompareError {
    fn advice(&self) -> String {
        match self {
            Self::Surface(error) => error.advice(),
            Self::Reference(error) => error.advice(),
        }
    }
}

/// Shows every system the frames of a setup; `after_each` is told how many are done, of how many.
pub fn compare_systems(
    setup: &RecognitionSetup,
    enrolled: &EnrolledStandard,
    mut after_each: impl FnMut(usize, usize),
) -> Result<Comparison, CompareError> {
    let recipe = Recipe::default();
    let library = &enrolled.library;
    let contestants = System::ALL
        .iter()
        .map(|system| Contestant::prepare(*system, library))
        .collect::<Result<Vec<_>, _>>()?;
    let mut frames = Vec::new();
    let total = setup.num_poses as usize * PartKind::ALL.len();
    for (k, kind) in PartKind::ALL.into_iter().enumerate() {
        let model = PartModel::new(kind, Side::Left, setup.model_seed);
        for pose in 0..setup.num_poses {
            let seed = setup.first_seed + pose * PartKind::ALL.len() as u64 + k as u64;
            let mut cell = CellSetup::with_part(kind, Side::Left, setup.model_seed, seed);
            cell.pose = PartPose::Drawn(setup.placement);
            let scene = scene_from_frame(&frame_of_mesh(&cell, model.mesh()).frame);
            let part = segment(&scene, &recipe.segment).part.ok();
            let answer = |contestant: &Contestant| {
                let part = part.as_ref()?;
                Some(contestant.answer(part, &scene, library, &recipe))
            };
            frames.push(Frame {
                truth: kind,
                seed,
                num_points: part.as_ref().map(|p| p.cloud.points.len()),
                answers: contestants.iter().filter_map(answer).collect(),
            });
            after_each(frames.len(), total);
        }
    }
    Ok(Comparison {
        frames,
        preparations: contestants.into_iter().map(|c| c.preparation).collect(),
    })
}

/// A system with its references ready.
struct Contestant {
    method: Method,
    preparation: Preparation,
}

/// How a contestant recognises.
enum Method {
    Outline(Matcher),
    Confirmed,
    Views(SurfaceParams, Vec<Vec<ViewHistogram>>),
    Local(LocalParams, DescriptorBank),
}

impl Contestant {
    fn prepare(system: System, library: &Library) -> Result<Self, CompareError> {
        let references = &library.references;
        let (start, processor) = (Instant::now(), thread_seconds());
        // Ours come prepared; that is done once more for its time.
        let (method, num_rows) = match (system, system.local()) {
            (_, Some(params)) => {
                let bank = described_locally(references, &params)?;
                let num_rows = bank.len();
                (Method::Local(params, bank), Some(num_rows))
            }
            (System::Vfh, _) => {
                let params = SurfaceParams::default();
                let views = references
                    .iter()
                    .map(|r| describe_views(&r.cloud, Coverage::OneSide, &params))
                    .collect::<Result<Vec<_>, _>>()?;
                let num_rows = views.iter().map(Vec::len).sum();
                (Method::Views(params, views), Some(num_rows))
            }
            (System::Paper, _) => {
                prepare_again(references)?;
                (Method::Outline(Matcher::Paper), None)
            }
            (System::Confirmed, _) => {
                prepare_again(references)?;
                (Method::Confirmed, None)
            }
            _ => {
                prepare_again(references)?;
                (Method::Outline(Matcher::Default), None)
            }
        };
        Ok(Self {
            method,
            preparation: Preparation {
                time: since(start, processor),
                num_rows,
            },
        })
    }

    fn answer(
        &self,
        part: &SegmentedPart,
        scene: &SceneCloud,
        library: &Library,
        recipe: &Recipe,
    ) -> Answer {
        let references = &library.references;
        let (start, processor) = (Instant::now(), thread_seconds());
        let (found, size) = match &self.method {
            Method::Outline(matcher) => {
                let mut recipe = recipe.clone();
                recipe.rank.matcher = *matcher;
                (by_outline(part, None, references, &recipe), None)
            }
            Method::Confirmed => (by_outline(part, Some(scene), references, recipe), None),
            Method::Views(params, views) => by_views(part, params, views).unzip(),
            Method::Local(params, bank) => by_rows(part, params, bank).unzip(),
        };
        let time = since(start, processor);
        Answer {
            found: found.map(|reference| references[reference].name.clone()),
            time,
            size,
        }
    }
}

/// Processor time of this thread since then, which others at work do not lengthen; the clock's where the system does
/// not tell.
fn since(start: Instant, processor: Option<f64>) -> Duration {
    match (processor, thread_seconds()) {
        (Some(before), Some(now)) => Duration::from_secs_f64((now - before).max(0.0)),
        _ => start.elapsed(),
    }
}

fn described_locally(
    references: &[Reference],
    params: &LocalParams,
) -> Result<DescriptorBank, SurfaceError> {
    let rows = references
        .iter()
        .map(|r| Ok(describe_reference(&r.cloud, params)?.rows))
        .collect::<Result<Vec<Descriptors>, SurfaceError>>()?;
    Ok(DescriptorBank::new(&rows))
}

fn prepare_again(references: &[Reference]) -> Result<(), ReferenceError> {
    let params = ReferenceParams::default();
    for r in references {
        Reference::prepare(&r.name, r.cloud.clone(), Coverage::OneSide, &params)?;
    }
    Ok(())
}

/// Our stages from the projection to the ranking, and with a scene to the confirmation.
fn by_outline(
    part: &SegmentedPart,
    confirm_in: Option<&SceneCloud>,
    references: &[Reference],
    recipe: &Recipe,
) -> Option<usize> {
    let plane = project(part, &recipe.project).ok()?;
    let contour = find_contour(&plane, &recipe.contour).ok()?;
    let signature = describe(&contour, &recipe.signature).ok()?;
    let query = Query {
        plane: &plane,
        contour: &contour,
        signature: &signature,
    };
    let mut ranking: MatchRanking = rank(&query, references, &recipe.rank);
    if let Some(scene) = confirm_in {
        let scene = Scene { scene, part, query };
        ranking = confirm(&scene, references, ranking, &recipe.confirm).0;
    }
    ranking.entries.first().map(|entry| entry.reference)
}

fn by_views(
    part: &SegmentedPart,
    params: &SurfaceParams,
    views: &[Vec<ViewHistogram>],
) -> Option<(usize, Size)> {
    let camera = Point3::origin();
    let surface = take_surface(&part.cloud, &camera, params).ok()?;
    let reference = nearest_reference(&describe_vfh(&surface, &camera), views)?;
    let size = Size {
        num_points: surface.points.len(),
        num_rows: 1,
    };
    Some((reference, size))
}

fn by_rows(
    part: &SegmentedPart,
    params: &LocalParams,
    bank: &DescriptorBank,
) -> Option<(usize, Size)> {
    let described = describe_scene(&part.cloud, params).ok()?;
    let size = Size {
        num_points: described.num_points,
        num_rows: described.rows.len(),
    };
    let nearest = rank_by_rows(&described.rows, bank).first()?.reference;
    Some((nearest, size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{bench::enrol_standard_parts, library::EnrolParams, simulate::Placement};

    #[test]
    fn every_system_tells_the_parts_apart_when_they_face_the_camera() {
        let enrolled = enrol_standard_parts(&EnrolParams::default()).expect("eight parts");
        let setup = RecognitionSetup {
            num_poses: 1,
            first_seed: 3_000_000,
            placement: Placement::facing(),
            ..RecognitionSetup::default()
        };
        let mut told = Vec::new();
        let compared = compare_systems(&setup, &enrolled, |done, of| told.push((done, of)));
        let Comparison {
            frames,
            preparations,
        } = compared.expect("references that can be described");
        assert_eq!((frames.len(), told.last()), (8, Some(&(8, 8))));
        assert_eq!(preparations.len(), System::ALL.len());
        for (place, system) in System::ALL.iter().enumerate() {
            let num_right = frames.iter().filter(|f| f.is_right(place)).count();
            // The paper's matcher is what it is: about two of three.
            let least = if *system == System::Paper { 3 } else { 7 };
            assert!(num_right >= least, "{system:?}: {num_right} of 8");
            let is_descriptor = preparations[place].num_rows.is_some();
            for frame in &frames {
                assert_eq!(frame.answers[place].size.is_some(), is_descriptor);
            }
        }
    }

    #[test]
    fn a_frame_without_a_part_is_right_for_nobody() {
        let frame = Frame {
            truth: PartKind::Grille,
            seed: 1,
            num_points: None,
            answers: Vec::new(),
        };
        assert!((0..System::ALL.len()).all(|system| !frame.is_right(system)));
    }
}
