//! Reference: what an enrolled part is compared by, prepared once (the paper's offline stage, Algorithm 1).
//!
//! The paper keeps one signature per part, taken square on. The projection of a curved part changes with the side it
//! is seen from, so we keep several *views*: the reference cloud as a camera would see it from in front and from
//! some 20 to 25 degrees around. A view goes through the same projection, contour and signature as a scene.

pub mod border;
mod view;
mod view_cut;
mod viewpoints;

use std::sync::OnceLock;

use nalgebra::{Point3, Vector3};

use self::{
    border::{BorderPoint, ReferenceBorder},
    viewpoints::{VIEW_DISTANCE, viewpoints},
};
pub use self::{view::ReferenceView, view_cut::ViewCut, viewpoints::seen_around};
use crate::{
    error::Advice,
    geometry::{cloud::PointCloud, nearest::KdTree, nearest_field::NearestField},
    stages::{
        contour::{Contour, ContourParams, lift_oriented},
        correlation::{LiteralReference, RaySpectra},
        pose::{PoseError, PreparedTarget, edge_points::EdgePoints, refine::AlignmentTarget},
        project::{PlaneImage, ProjectParams},
        signature::{FanSignature, LiteralSignature, SignatureParams},
    },
    units::Metres,
};

/// From where the reference cloud was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coverage {
    /// One capture by a camera at the origin of part space: the far side is unknown.
    OneSide,
    /// All around, as from a mesh: it can be recognised from both of its faces.
    AllAround,
    /// A scan of several captures: it can be recognised from where most of its surface was seen. The normals point to
    /// the cameras.
    SeveralSides,
}

/// Parameters of [`Reference::prepare`]; those of the stages must be the ones used on scenes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferenceParams {
    /// Projection.
    pub project: ProjectParams,
    /// Contour.
    pub contour: ContourParams,
    /// Signature.
    pub signature: SignatureParams,
}

/// Why a cloud cannot be a reference.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReferenceError {
    /// No view of it has an outline.
    #[error("the cloud of {num_points} points has no outline from any side")]
    NoOutline {
        /// Points given.
        num_points: usize,
    },
    /// Larger than any car part.
    #[error("the part spans {:.1} m, expected at most {:.0} m", found.0, limit.0)]
    TooLarge {
        /// Its largest extent.
        found: Metres,
        /// The largest extent of a part.
        limit: Metres,
    },
}

impl Advice for ReferenceError {
    fn advice(&self) -> String {
        match self {
            Self::NoOutline { .. } => "Check that the cloud shows the surface of one part and is in metres".into(),
            Self::TooLarge { .. } => {
                "Export it in metres (these look like millimetres), or cut the one part out of its scene".into()
            }
        }
    }
}

/// No car part is longer than this, metres; what is, is a file in millimetres or a whole scene.
const MAX_EXTENT: f64 = 5.0;

/// An enrolled part, prepared for ranking and pose.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The part's name.
    pub name: String,
    /// The name that this reference is enrolled under: several may stand for one part, each in coordinates of its own.
    pub enrolled_as: String,
    /// The reference cloud in part space, with unit normals.
    pub cloud: PointCloud,
    /// Search tree over `cloud`, made when it is first asked for: only the last steps towards a pose search exactly.
    tree: OnceLock<KdTree>,
    /// Field of nearest points around `cloud`.
    pub field: NearestField,
    /// The reference from several sides; the first is its standard view.
    pub views: Vec<ReferenceView>,
    /// The views' signatures, for the circular correlation.
    pub spectra: RaySpectra,
    /// What only the paper's matcher looks at, and so made when it is first asked for.
    literal: OnceLock<LiteralReference>,
    /// Where the view that it was captured from cut it off.
    pub cut: ViewCut,
    /// Oriented points and their pairs, from each side that it can be seen from; made when the first piece of a part is
    /// laid onto it.
    borders: OnceLock<Vec<ReferenceBorder>>,
    /// Likewise: the default pose begins from placements and needs none of it.
    whole: OnceLock<Result<PreparedTarget, PoseError>>,
}

/// Points kept of a view's outline and openings: about one per centimetre and a half around a door.
const NUM_EDGES: usize = 256;
/// Cells of the field of nearest points, metres: two to three spacings of a reference cloud.
const FIELD_CELL: f32 = 0.02;
/// How far off the part the field answers, metres: further than the outline's placement is off.
const FIELD_BAND: f32 = 0.06;

/// Distance between neighbouring points of a reference cloud, metres: enrolment thins to this.
pub const SPACING: f64 = 0.008;

impl Reference {
    /// Middle of its extent, part space, metres; `None` of a cloud without points.
    pub fn middle(&self) -> Option<Point3<f64>> {
        let (low, high) = self.cloud.bounds()?;
        Some(nalgebra::center(&low, &high).cast())
    }

    /// Prepares a reference cloud (part space, with normals).
    pub fn prepare(
        name: &str,
        cloud: PointCloud,
        coverage: Coverage,
        params: &ReferenceParams,
    ) -> Result<Self, ReferenceError> {
        let num_points = cloud.points.len();
        let no_outline = ReferenceError::NoOutline { num_points };
        let (low, high) = cloud.bounds().ok_or(no_outline)?;
        let extent = f64::from((high - low).amax());
        if !(extent <= MAX_EXTENT) {
            return Err(ReferenceError::TooLarge {
                found: Metres(extent),
                limit: Metres(MAX_EXTENT),
            });
        }
        let views: Vec<ReferenceView> = viewpoints(&cloud, coverage)
            .ok_or(no_outline)?
            .iter()
            .filter_map(|viewpoint| {
                ReferenceView::from_viewpoint(&cloud, (low, high), viewpoint, params)
            })
            .collect();
        if views.is_empty() {
            return Err(no_outline);
        }
        Ok(Self::of_views(name, cloud, views))
    }

    fn of_views(name: &str, cloud: PointCloud, views: Vec<ReferenceView>) -> Self {
        Self {
            name: name.to_owned(),
            enrolled_as: name.to_owned(),
            tree: OnceLock::new(),
            field: NearestField::new(&cloud.points, FIELD_CELL, FIELD_BAND),
            cloud,
            spectra: spectra_of(&views),
            views,
            literal: OnceLock::new(),
            cut: ViewCut::default(),
            borders: OnceLock::new(),
            whole: OnceLock::new(),
        }
    }

    /// The reference as the target of a pose, with the edges of one of its views; `None` for a flat shape.
    pub fn target(&self, view: usize) -> Option<AlignmentTarget<'_>> {
        let Self {
            cloud, tree, field, ..
        } = self;
        let view = self.views.get(view)?;
        (!cloud.points.is_empty()).then_some(AlignmentTarget {
            cloud,
            tree,
            field,
            edges: view.edges.get_or_init(|| {
                let outline = self.outline_of(view);
                let is_edge = |point: &&BorderPoint| {
                    let towards = view.viewpoint - point.at.cast();
                    point.normal.cast().dot(&towards) >= LEAST_FACING_AT_EDGE * towards.norm()
                };
                let edges = outline.iter().filter(is_edge);
                let edges: Vec<Point3<f32>> = edges.map(|edge| edge.at).collect();
                EdgePoints::new(&edges, NUM_EDGES)
            }),
            spacing: SPACING,
        })
    }

    /// Makes now what is otherwise made when it is first asked for, a millisecond or two: for who measures what an
    /// inspection takes once all is made.
    pub fn prefetch(&self) {
        self.tree();
        self.literal();
        for view in 0..self.views.len() {
            self.target(view);
        }
    }

    /// The same part, captured in a view that cut it off so.
    #[must_use]
    pub fn with_cut(self, cut: ViewCut) -> Self {
        Self { cut, ..self }
    }

    /// Its border from each side that it can be seen from. Where a rounded surface turns away its outline wanders with the
    /// viewpoint, so the outlines of all views of a side belong to it: a piece seen at an angle ends at one of them.
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

    /// Outline and openings from one side, part space, without what the view that it was captured from cut off.
    fn outline_of(&self, view: &ReferenceView) -> Vec<BorderPoint> {
        let part_from_plane = view.plane_from_part.inverse();
        let point = |(at, along): (Point3<f64>, Vector3<f64>)| {
            let at = part_from_plane * at;
            if self.cut.depth_inside(&at) < AT_CUT {
                return None;
            }
            let nearest = self.field.nearest(&at.cast());
            let normal = nearest.zip(self.cloud.normals.as_ref()).map_or_else(
                || (view.viewpoint - at).normalize().cast(),
                |(nearest, normals)| normals[nearest.index],
            );
            Some(BorderPoint {
                at: at.cast(),
                along: (part_from_plane * along).cast(),
                normal,
            })
        };
        let borders = std::iter::once(&view.contour.outline).chain(&view.contour.openings);
        borders
            .flat_map(|border| lift_oriented(border, &view.plane))
            .flatten()
            .filter_map(point)
            .collect()
    }

    /// Search tree over the cloud.
    pub fn tree(&self) -> &KdTree {
        self.tree.get_or_init(|| KdTree::new(&self.cloud.points))
    }

    /// The paper's auto-correlation of the standard view.
    pub fn literal(&self) -> &LiteralReference {
        self.literal.get_or_init(|| {
            let pixels = self
                .views
                .first()
                .map(|view| &view.contour.outline_pixels[..]);
            LiteralReference::new(LiteralSignature::of(pixels.unwrap_or_default()))
        })
    }

    /// Another one, for references that are simulated as signatures alone.
    #[must_use]
    pub fn with_literal(self, literal: LiteralReference) -> Self {
        Self {
            literal: literal.into(),
            ..self
        }
    }

    /// The reference as a target that is searched from anywhere.
    pub fn whole(&self) -> Result<&PreparedTarget, PoseError> {
        let prepared = self.whole.get_or_init(|| PreparedTarget::new(&self.cloud));
        prepared.as_ref().map_err(|error| *error)
    }

    /// A reference that is only a flat shape, such as a silhouette: it can be ranked, but has no cloud for a pose.
    pub fn from_plane(
        name: &str,
        plane: PlaneImage,
        contour: Contour,
        signature: FanSignature,
    ) -> Self {
        let cloud = PointCloud::default();
        let from_the_front = Point3::new(0.0, 0.0, VIEW_DISTANCE);
        let views = vec![ReferenceView::new(
            from_the_front,
            plane,
            contour,
            signature,
        )];
        Self::of_views(name, cloud, views)
    }
}

/// The views' signatures, for the circular correlation.
pub fn spectra_of(views: &[ReferenceView]) -> RaySpectra {
    RaySpectra::of(views.iter().map(|view| &view.signature.rays[..]))
}

/// The surface at an edge of the sheet is seen at a cosine of at least this; less is where a rounded surface turns
/// away, and that outline wanders over the surface as the viewpoint moves.
const LEAST_FACING_AT_EDGE: f64 = 0.5;

/// A border this close to where the view cut the part off is the view's, metres.
const AT_CUT: f64 = 0.02;
