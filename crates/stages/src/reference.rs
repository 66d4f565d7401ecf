//! Reference: an enrolled part, prepared once for comparison (the paper's offline stage, Algorithm 1).
//!
//! The paper keeps one signature per part, taken at right angles. The projection of a curved part changes with the side it
//! is seen from, so we keep several *views*: the reference cloud as a camera would see it from the front and from
//! directions about 20 to 25 degrees around it. A view goes through the same projection, contour and signature as a scene.

pub mod border;
mod sides;
mod symmetry;
mod view;
mod view_cut;
mod viewpoints;

use std::sync::{Arc, OnceLock};

use nalgebra::{Point3, Vector3};

use self::{
    border::{BorderPoint, ReferenceBorder},
    sides::ReferenceSide,
    view::ViewSource,
    viewpoints::{VIEW_DISTANCE_M, viewpoints},
};
pub use self::{view::ReferenceView, view_cut::ViewCut, viewpoints::seen_around};
use crate::{
    contour::{Contour, ContourParams, lift_oriented},
    correlation::RaySpectra,
    paper::LiteralReference,
    pose::{PoseError, PreparedTarget, edge_points::EdgePoints, refine::AlignmentTarget},
    project::{PlaneImage, ProjectParams},
    rank::EXHAUSTIVE_UP_TO,
    shape_summary::ShapeSummary,
    signature::{FanSignature, LiteralSignature, SignatureParams},
};
use geometry::{
    cloud::PointCloud, nearest::KdTree, nearest_field::NearestField, rigid::RigidTransform,
    units::Metres,
};

/// The sides from which the reference cloud was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coverage {
    /// One capture by a camera at the origin of part space: the far side is unknown.
    OneSide,
    /// All around, as with a mesh: the part can be recognised from both faces.
    AllAround,
    /// A scan of several captures: the part can be recognised from directions that show most of the captured surface.
    /// The normals point to the cameras.
    SeveralSides,
}

/// Parameters of [`Reference::prepare`]; those of the stages must be the same as for scenes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferenceParams {
    /// Parameters of the projection.
    pub project: ProjectParams,
    /// Parameters of the contour.
    pub contour: ContourParams,
    /// Parameters of the signature.
    pub signature: SignatureParams,
}

/// Reason why a cloud cannot be a reference.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize)]
#[serde(tag = "error", rename_all = "snake_case")]
pub enum ReferenceError {
    /// None of the views has an outline.
    NoOutline {
        /// Number of points in the cloud.
        num_points: usize,
    },
    /// The cloud is larger than any car part.
    TooLarge {
        /// The cloud's largest extent.
        found: Metres,
        /// The largest extent allowed.
        limit: Metres,
    },
}

texts::described!(ReferenceError: "reference" by "error");

/// Maximum extent of a car part, metres; anything larger is a file in millimetres or a whole scene.
const MAX_EXTENT_M: f64 = 5.0;

/// An enrolled part, prepared for ranking and pose.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The part's name.
    pub name: String,
    /// The name under which this reference is enrolled: a part may have several, each with its own coordinates.
    pub enrolled_as: String,
    /// The reference cloud in part space, with unit normals.
    pub cloud: Arc<PointCloud>,
    /// Search tree over `cloud`, built on first use: only the last steps of a pose search exactly.
    tree: OnceLock<KdTree>,
    /// Nearest-point field around `cloud`, built on first use.
    field: OnceLock<NearestField>,
    /// Front and back, if there are views of both; built when a pose is first tried.
    sides: OnceLock<Option<[ReferenceSide; 2]>>,
    /// Views from several sides; the first is the standard view.
    pub views: Vec<ReferenceView>,
    /// The views' signatures, transformed for the circular correlation.
    pub spectra: RaySpectra,
    /// Used only in large libraries, so built on first use.
    summaries: OnceLock<Vec<ShapeSummary>>,
    /// Used only by the paper's matcher, so built on first use.
    literal: OnceLock<LiteralReference>,
    /// See [`Self::own_turn`].
    own_turn: OnceLock<Option<RigidTransform>>,
    /// The cut-off by the field of view of the capture.
    pub cut: ViewCut,
    /// Oriented points and their pairs, for each side that the part can be seen from; built when a piece is first aligned.
    borders: OnceLock<Vec<ReferenceBorder>>,
    /// Built on first use: the default pose search starts from placements and does not need it.
    whole: OnceLock<Result<PreparedTarget, PoseError>>,
    /// What its views were made with; `None` if [`Self::prepare`] did not make them.
    prepared_with: Option<(Coverage, Arc<ReferenceParams>)>,
}

/// Number of points kept of a view's outline and openings: about one per 1.5 cm around a door.
const NUM_EDGES: usize = 256;
/// Cell size of the nearest-point field, metres: two to three times the spacing of a reference cloud.
const FIELD_CELL_M: f32 = 0.02;
/// Distance from the part up to which the field answers, metres: more than the error of a placement by outline.
const FIELD_BAND_M: f32 = 0.06;

/// Spacing of the points of a reference cloud, metres; enrolment thins to this.
pub const SPACING_M: f64 = 0.008;

impl Reference {
    /// Returns the middle of the extent, part space, metres; `None` for a cloud without points.
    pub fn middle(&self) -> Option<Point3<f64>> {
        let (low, high) = self.cloud.bounds()?;
        Some(nalgebra::center(&low, &high).cast())
    }

    /// Returns width, height and depth of the cloud in part space; `None` for a cloud without points.
    pub fn size(&self) -> Option<[Metres; 3]> {
        let (low, high) = self.cloud.bounds()?;
        let sides: [f32; 3] = (high - low).into();
        Some(sides.map(|side| Metres(side.into())))
    }

    /// Prepares a reference cloud (part space, with normals).
    pub fn prepare(
        name: &str,
        cloud: impl Into<Arc<PointCloud>>,
        coverage: Coverage,
        params: &ReferenceParams,
    ) -> Result<Self, ReferenceError> {
        let cloud = cloud.into();
        let num_points = cloud.points.len();
        let no_outline = ReferenceError::NoOutline { num_points };
        let (low, high) = cloud.bounds().ok_or(no_outline)?;
        let extent = f64::from((high - low).amax());
        if !(extent <= MAX_EXTENT_M) {
            return Err(ReferenceError::TooLarge {
                found: Metres(extent),
                limit: Metres(MAX_EXTENT_M),
            });
        }
        let viewpoints = viewpoints(&cloud, coverage).ok_or(no_outline)?;
        let params = Arc::new(params.clone());
        let source = ViewSource {
            cloud: Arc::clone(&cloud),
            params: Arc::clone(&params),
        };
        let views: Vec<ReferenceView> = viewpoints
            .iter()
            .filter_map(|at| ReferenceView::from_viewpoint(&source, (low, high), at))
            .collect();
        if views.is_empty() {
            return Err(no_outline);
        }
        Ok(Self {
            prepared_with: Some((coverage, params)),
            ..Self::of_views(name, cloud, views)
        })
    }

    /// True if [`Self::prepare`] would make the same of this.
    pub fn is_prepared_from(
        &self,
        cloud: &PointCloud,
        coverage: Coverage,
        params: &ReferenceParams,
    ) -> bool {
        let with = self.prepared_with.as_ref();
        with.is_some_and(|(of, by)| *of == coverage && **by == *params) && *self.cloud == *cloud
    }

    fn of_views(name: &str, cloud: Arc<PointCloud>, views: Vec<ReferenceView>) -> Self {
        Self {
            name: name.to_owned(),
            enrolled_as: name.to_owned(),
            tree: OnceLock::new(),
            field: OnceLock::new(),
            sides: OnceLock::new(),
            cloud,
            spectra: RaySpectra::default(),
            summaries: OnceLock::new(),
            views: Vec::new(),
            literal: OnceLock::new(),
            own_turn: OnceLock::new(),
            cut: ViewCut::default(),
            borders: OnceLock::new(),
            whole: OnceLock::new(),
            prepared_with: None,
        }
        .with_views(views)
    }

    /// Replaces the views and what ranking needs of them.
    #[must_use]
    pub fn with_views(self, mut views: Vec<ReferenceView>) -> Self {
        views.shrink_to_fit();
        Self {
            spectra: RaySpectra::of(views.iter().map(|view| &view.signature().rays[..])),
            summaries: OnceLock::new(),
            sides: OnceLock::new(),
            prepared_with: None,
            views,
            ..self
        }
    }

    /// Returns what a view shows of the reference as a target for a pose, with the edges of the view; `None` for a flat shape.
    pub fn target(&self, view: usize) -> Option<AlignmentTarget<'_>> {
        let whole = self.whole_target(view)?;
        let Some(side) = self.side_of(&self.views[view]) else {
            return Some(whole);
        };
        Some(AlignmentTarget {
            cloud: &side.cloud,
            tree: &side.tree,
            field: side.field(),
            ..whole
        })
    }

    /// Returns what some views show together, with other edges; `None` for a flat shape.
    pub fn joint_target<'a>(
        &'a self,
        views: &[usize],
        edges: &'a EdgePoints,
    ) -> Option<AlignmentTarget<'a>> {
        let first = *views.first()?;
        let is_one_side = views.iter().all(|view| self.are_of_one_side(first, *view));
        let target = if is_one_side {
            self.target(first)
        } else {
            self.whole_target(first)
        };
        Some(AlignmentTarget { edges, ..target? })
    }

    /// Returns the whole reference as a target for a pose, with the edges of one of its views; `None` for a flat shape.
    pub fn whole_target(&self, view: usize) -> Option<AlignmentTarget<'_>> {
        let Self { cloud, tree, .. } = self;
        let view = self.views.get(view)?;
        (!cloud.points.is_empty()).then_some(AlignmentTarget {
            cloud,
            tree,
            field: self.field(),
            edges: view.edges.get_or_init(|| {
                let outline = self.outline_of(view);
                let is_edge = |point: &&BorderPoint| {
                    let towards = view.viewpoint - point.at.cast();
                    point.normal.cast().dot(&towards) >= EDGE_MIN_COSINE * towards.norm()
                };
                let edges = outline.iter().filter(is_edge);
                let edges: Vec<Point3<f32>> = edges.map(|edge| edge.at).collect();
                EdgePoints::new(&edges, NUM_EDGES)
            }),
            spacing: SPACING_M,
        })
    }

    /// Builds the tree, nearest-point field, auto-correlation and edges, which are otherwise built on first use, in a millisecond or two;
    /// for measuring the time of an inspection without them.
    pub fn prefetch(&self) {
        self.tree();
        self.field();
        self.literal();
        for view in 0..self.views.len() {
            self.target(view);
        }
    }

    /// Sets the cut-off by the field of view of the capture.
    #[must_use]
    pub fn with_cut(self, cut: ViewCut) -> Self {
        Self { cut, ..self }
    }

    /// Returns the border for each side that the part can be seen from. Where a rounded surface turns away, its outline moves
    /// with the viewpoint, so the outlines of all views of a side are included: a piece seen at an angle ends at one of them.
    pub fn borders(&self) -> &[ReferenceBorder] {
        self.borders.get_or_init(|| {
            let Some(front) = self.views.first() else {
                return Vec::new();
            };
            let normal = |view: &ReferenceView| view.plane_from_part.inverse() * Vector3::z();
            let turned = |view: &&ReferenceView| normal(view).dot(&normal(front));
            let back = self
                .views
                .iter()
                .min_by(|a, b| turned(a).total_cmp(&turned(b)))
                .filter(|view| turned(view) < -0.9);
            let of_side = |side: &ReferenceView| {
                let same_side = self
                    .views
                    .iter()
                    .filter(|view| normal(view).dot(&normal(side)) > 0.0);
                let outlines: Vec<Point3<f32>> = same_side
                    .flat_map(|view| self.outline_of(view))
                    .map(|point| point.at)
                    .collect();
                ReferenceBorder::new(&self.outline_of(side), &outlines)
            };
            std::iter::once(front).chain(back).map(of_side).collect()
        })
    }

    /// Returns outline and openings from one side, part space, without points at the cut-off by the field of view.
    fn outline_of(&self, view: &ReferenceView) -> Vec<BorderPoint> {
        let part_from_plane = view.plane_from_part.inverse();
        let (cloud, field) = match self.side_of(view) {
            Some(side) => (&side.cloud, side.field()),
            None => (&*self.cloud, self.field()),
        };
        let point = |(at, along): (Point3<f64>, Vector3<f64>)| {
            let at = part_from_plane * at;
            if self.cut.depth_inside(&at) < AT_CUT_M {
                return None;
            }
            let nearest = field.nearest(&at.cast());
            let normal = nearest.zip(cloud.normals.as_ref()).map_or_else(
                || (view.viewpoint - at).normalize().cast(),
                |(nearest, normals)| normals[nearest.index],
            );
            Some(BorderPoint {
                at: at.cast(),
                along: (part_from_plane * along).cast(),
                normal,
            })
        };
        let contour = view.contour();
        contour
            .borders()
            .flat_map(lift_oriented)
            .flatten()
            .filter_map(point)
            .collect()
    }

    /// Returns the search tree over the cloud.
    pub fn tree(&self) -> &KdTree {
        self.tree.get_or_init(|| KdTree::new(&self.cloud.points))
    }

    /// Returns the nearest-point field around the cloud.
    pub fn field(&self) -> &NearestField {
        let new = || NearestField::new(&self.cloud.points, FIELD_CELL_M, FIELD_BAND_M);
        self.field.get_or_init(new)
    }

    /// Drops the cloud and all that is built from it, for references that are only ranked.
    #[must_use]
    pub fn without_cloud(mut self) -> Self {
        self.views.iter_mut().for_each(ReferenceView::drop_source);
        Self {
            cloud: Arc::default(),
            tree: OnceLock::new(),
            field: OnceLock::new(),
            sides: OnceLock::new(),
            ..self
        }
    }

    /// Prepares it for a library of this many references. In a large one, it gets the summaries, for which the first
    /// inspection would otherwise wait, and drops what ranking does not use, which is made again when first needed.
    #[must_use]
    pub fn for_library_of(mut self, num_references: usize) -> Self {
        if num_references > EXHAUSTIVE_UP_TO {
            self.summaries();
            self.views.iter_mut().for_each(ReferenceView::drop_details);
        }
        self
    }

    /// Returns the views' summaries.
    pub fn summaries(&self) -> &[ShapeSummary] {
        self.summaries.get_or_init(|| {
            let views = self.views.iter();
            views
                .map(|view| ShapeSummary::of(&view.plane(), view.signature()))
                .collect()
        })
    }

    /// Returns the paper's auto-correlation of the standard view.
    pub fn literal(&self) -> &LiteralReference {
        self.literal.get_or_init(|| {
            let view = self.views.first();
            let pixels = view.map_or_else(Vec::new, |view| view.contour().outline_pixels);
            LiteralReference::new(LiteralSignature::of(&pixels))
        })
    }

    /// Replaces the auto-correlation, for references that are simulated as signatures only.
    #[must_use]
    pub fn with_literal(self, literal: LiteralReference) -> Self {
        Self {
            literal: literal.into(),
            ..self
        }
    }

    /// Returns the reference as a target that can be searched from any start.
    pub fn whole(&self) -> Result<&PreparedTarget, PoseError> {
        let prepared = self.whole.get_or_init(|| PreparedTarget::new(&self.cloud));
        prepared.as_ref().map_err(|error| *error)
    }

    /// Creates a reference from a flat shape, such as a silhouette: it can be ranked, but has no cloud for a pose.
    pub fn from_plane(
        name: &str,
        plane: &PlaneImage,
        contour: &Contour,
        signature: FanSignature,
    ) -> Self {
        let from_the_front = Point3::new(0.0, 0.0, VIEW_DISTANCE_M);
        let view = ReferenceView::flat(from_the_front, plane, contour, signature);
        Self::of_views(name, Arc::default(), vec![view])
    }
}

/// Minimum cosine at which the surface is seen at a true edge; below it a rounded surface turns away, and its outline
/// moves over the surface with the viewpoint.
const EDGE_MIN_COSINE: f64 = 0.5;

/// A border this close to the cut-off is due to the field of view, metres.
const AT_CUT_M: f64 = 0.02;
