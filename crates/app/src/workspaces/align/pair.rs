//! The two clouds to be aligned, prepared once for searching and drawing, with the truth where it is known.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use nalgebra::Point3;

use super::start::Start;
use geometry::{
    cloud::PointCloud,
    nearest::KdTree,
    rigid::{self, RigidTransform},
};
use shell::inspection::{
    inspected::Inspected,
    library_cache::{LibraryCache, LoadedLibrary},
    source::{Origin, file_name},
};
use stages::{
    pose::{PoseError, PreparedTarget},
    reference::Reference,
    scene::cloud_of,
};
use ui::{
    language::{Message, described, text, what_and_advice},
    user_error::UserError,
    viewport::{PointSet, Role},
};

/// Where the two clouds come from.
#[derive(Clone, Debug)]
pub enum PairSource {
    /// An enrolled part moved by a known transform, and the same part unmoved: the protocol of Table I.
    MovedCopy {
        /// Name of the enrolled part.
        part: String,
        /// The transform that moves it.
        start: Start,
    },
    /// The part found in an inspected scene, and an enrolled part.
    Scene {
        /// The scene.
        inspected: Arc<Inspected>,
        /// Name of the enrolled part.
        part: String,
    },
    /// Two files.
    Files {
        /// The file that is moved onto the target.
        source: PathBuf,
        /// The file that the source is moved onto.
        target: PathBuf,
    },
}

/// What the title of a pair names.
#[derive(Debug)]
enum PairNames {
    /// The title of a part, and the start of its copy.
    MovedCopy { part: String, start: Start },
    /// A scene, and the title of a part.
    Scene { scene: Origin, part: String },
    /// Two files.
    Files { source: String, target: String },
}

/// Two clouds, ready to be aligned and drawn. Methods begin with the source where it lies.
#[derive(Debug)]
pub struct Pair {
    names: PairNames,
    /// The cloud that is moved onto the target.
    pub source: PointCloud,
    /// The points of the source over which E is measured, thinned as for the estimate's own figures.
    pub sample: Vec<Point3<f32>>,
    /// The target prepared for the methods, or why it cannot be.
    pub prepared: Result<PreparedTarget, PoseError>,
    /// Search tree over the target's finite points.
    pub target_tree: KdTree,
    /// The source as drawn, in its own frame.
    pub source_points: PointSet,
    /// The target as drawn.
    pub target_points: PointSet,
    /// The pose that maps the source exactly onto the target, where it is known.
    pub truth: Option<RigidTransform>,
    /// Centroid of the source, where shifts are compared; source frame.
    pub middle: Point3<f64>,
    /// Warnings about the files.
    pub warnings: Vec<UserError>,
}

/// E is measured over this many to twice as many points of the source, or over all if there are fewer.
const SAMPLE: usize = 4_000;

impl Pair {
    /// Reads and prepares both clouds.
    pub fn load(source: &PairSource, library_cache: &LibraryCache) -> Result<Self, UserError> {
        match source {
            PairSource::MovedCopy { part, start } => {
                let loaded = library_cache.get();
                let (reference, title) = find(&loaded, part)?;
                Ok(Self::moved_copy(reference, title, *start))
            }
            PairSource::Scene { inspected, part } => {
                let loaded = library_cache.get();
                let (reference, title) = find(&loaded, part)?;
                let found = inspected.inspection.segmentation.part.as_ref();
                let found = found.map_err(UserError::of)?;
                let names = PairNames::Scene {
                    scene: inspected.origin.clone(),
                    part: title.to_owned(),
                };
                let prepared = reference.whole().cloned();
                let (source, target) = (found.cloud.clone(), &reference.cloud);
                Ok(Self::new(names, source, target, prepared, None))
            }
            PairSource::Files { source, target } => {
                let names = PairNames::Files {
                    source: file_name(source),
                    target: file_name(target),
                };
                let mut warnings = Vec::new();
                let mut source = open(source, &mut warnings)?;
                let mut target = open(target, &mut warnings)?;
                // Far from the origin, `f32` resolves the points too coarsely for drawing and for E.
                if let Some((low, high)) = target.bounds() {
                    let middle = nalgebra::center(&low.cast::<f64>(), &high.cast::<f64>()).coords;
                    for point in source.points.iter_mut().chain(&mut target.points) {
                        *point = (point.cast::<f64>() - middle).cast();
                    }
                }
                let prepared = PreparedTarget::new(&target);
                Ok(Self {
                    warnings,
                    ..Self::new(names, source, &target, prepared, None)
                })
            }
        }
    }

    /// Makes a pair by the protocol of Table I: the same points, moved.
    pub fn moved_copy(reference: &Reference, title: &str, start: Start) -> Self {
        let moved = start.transform();
        let points = reference.cloud.points.iter();
        let source = PointCloud::from_points(points.map(|p| (moved * p.cast::<f64>()).cast()));
        let names = PairNames::MovedCopy {
            part: title.to_owned(),
            start,
        };
        let prepared = reference.whole().cloned();
        let truth = Some(moved.inverse());
        Self::new(names, source, &reference.cloud, prepared, truth)
    }

    /// Title shown to a person.
    pub fn title(&self) -> String {
        match &self.names {
            PairNames::MovedCopy { part, start } => {
                text!("align-from", part = part, start = start.title())
            }
            PairNames::Scene { scene, part } => onto(&scene.shown_title(), part),
            PairNames::Files { source, target } => onto(source, target),
        }
    }

    fn new(
        names: PairNames,
        source: PointCloud,
        target: &PointCloud,
        prepared: Result<PreparedTarget, PoseError>,
        truth: Option<RigidTransform>,
    ) -> Self {
        let finite: Vec<Point3<f32>> = source.finite().map(|(_, p)| *p).collect();
        let step = (finite.len() / SAMPLE).max(1);
        let sum = finite.iter().fold(nalgebra::Vector3::zeros(), |sum, p| {
            sum + p.coords.cast::<f64>()
        });
        let middle = Point3::from(sum / finite.len().max(1) as f64);
        let sample = finite.into_iter().step_by(step).collect();
        let of_target: Vec<Point3<f32>> = target.finite().map(|(_, p)| *p).collect();
        Self {
            names,
            sample,
            prepared,
            target_tree: KdTree::new(&of_target),
            source_points: drawn(&source, Role::Moving),
            target_points: drawn(target, Role::Reference),
            truth,
            middle,
            warnings: Vec::new(),
            source,
        }
    }

    /// Returns the error of a pose where the truth is known.
    pub fn true_error(&self, target_from_source: &RigidTransform) -> Option<rigid::PoseDelta> {
        let truth = self.truth.as_ref()?;
        Some(rigid::pose_error(target_from_source, truth, &self.middle))
    }

    /// Returns E(R, t) of eq. 12 at a pose, square metres, over [`sample`](Self::sample): the mean squared distance to
    /// the closest points of the target, at any distance. Infinite without points.
    pub fn e_m2(&self, target_from_source: &RigidTransform) -> f64 {
        self.e_m2_over(target_from_source, 1)
    }

    /// Returns E over every `step`-th point of the sample.
    pub(super) fn e_m2_over(&self, target_from_source: &RigidTransform, step: usize) -> f64 {
        let moved = target_from_source.cast::<f32>();
        let nearest = |p| self.target_tree.nearest(&(moved * p), f32::INFINITY);
        let (mut sum_sq, mut num) = (0.0, 0.0);
        for neighbour in self.sample.iter().step_by(step).filter_map(nearest) {
            sum_sq += f64::from(neighbour.distance_sq);
            num += 1.0;
        }
        if num > 0.0 {
            sum_sq / num
        } else {
            f64::INFINITY
        }
    }
}

fn drawn(cloud: &PointCloud, role: Role) -> PointSet {
    let points: Vec<[f32; 3]> = cloud.finite().map(|(_, p)| [p.x, p.y, p.z]).collect();
    PointSet::new(points, role)
}

fn onto(source: &str, target: &str) -> String {
    let message = Message::new("pose-onto");
    described(&message.with("source", source).with("target", target))
}

/// Finds the enrolled part of this name, and its title.
fn find<'a>(loaded: &'a LoadedLibrary, part: &str) -> Result<(&'a Reference, &'a str), UserError> {
    let index = loaded.shown.index_of(part);
    let found = index.and_then(|index| {
        let reference = loaded.library.references.get(index)?;
        Some((reference, loaded.shown.title(index)))
    });
    found.ok_or_else(|| UserError {
        what: described(&Message::new("no-such-part").with("name", part)),
        advice: text!("shell-choose-another-part"),
    })
}

fn open(path: &Path, warnings: &mut Vec<UserError>) -> Result<PointCloud, UserError> {
    let opened = files::open(path).map_err(|error| UserError::of(&error))?;
    warnings.extend(opened.warnings().iter().map(UserError::of));
    let cloud = cloud_of(opened).ok_or_else(|| {
        let message = Message::new("mesh-no-area").with("path", &*path.display().to_string());
        UserError::from(what_and_advice(&message))
    })?;
    Ok(PointCloud::from_points(cloud.points))
}
