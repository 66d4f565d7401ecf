//! Reference: what an enrolled part is compared by, prepared once (the paper's offline stage, Algorithm 1).
//!
//! The paper keeps one signature per part, taken square on. The projection of a curved part changes with the side it
//! is seen from, so we keep several *views*: the reference cloud as a camera would see it from in front and from
//! some 20 to 25 degrees around. A view goes through the same projection, contour and signature as a scene.

mod viewpoints;

use std::sync::OnceLock;

use nalgebra::{Isometry2, Point2, Point3};

pub use self::viewpoints::seen_around;
use self::viewpoints::{VIEW_DISTANCE, viewpoints, visible_from};
use crate::{
    error::Advice,
    geometry::{
        cloud::PointCloud, nearest::KdTree, nearest_field::NearestField,
        outline_field::OutlineField, raster::PackedImage, rigid::RigidTransform,
    },
    stages::{
        contour::{Contour, ContourParams, find_contour},
        correlation::{LiteralReference, RaySpectra},
        pose::{PoseError, PreparedTarget, edge_points::EdgePoints, refine::Target},
        project::{PlaneImage, ProjectParams, project_weighted},
        signature::{FanSignature, LiteralSignature, SignatureParams, describe},
    },
    units::{Metres, Radians},
};

/// From where the reference cloud was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coverage {
    /// One capture by a camera at the origin of part space: the far side is unknown.
    OneSide,
    /// All around, as from a mesh: it can be recognised from both of its faces.
    AllAround,
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
    /// Likewise: the default pose begins from placements and needs none of it.
    whole: OnceLock<Result<PreparedTarget, PoseError>>,
}

/// The reference as seen from one side.
#[derive(Clone, Debug)]
pub struct ReferenceView {
    /// Where from, part space.
    viewpoint: Point3<f64>,
    /// Takes part space into this view's plane space.
    pub plane_from_part: RigidTransform,
    /// The binary image.
    pub plane: PlaneImage,
    /// Its pixels alone, no finer than a centimetre.
    pub pixels: PackedImage,
    /// Area of its set pixels, square metres.
    pub image_area: f64,
    /// Its outline and openings.
    pub contour: Contour,
    /// The outline's signature.
    pub signature: FanSignature,
    /// Outline and openings on the surface, part space; made when a pose is first tried from this view.
    edges: OnceLock<EdgePoints>,
    /// Field of nearest points around outline and openings; made when the first piece of a part is laid onto it.
    outline_field: OnceLock<OutlineField>,
}

/// Side of a pixel of the packed image, metres: finer than the spacing of the points that are looked up in it, and a
/// quarter of the memory that every inspection reads.
const PACKED_PIXEL: f64 = 0.01;
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
        Ok(Self {
            name: name.to_owned(),
            enrolled_as: name.to_owned(),
            tree: OnceLock::new(),
            field: NearestField::new(&cloud.points, FIELD_CELL, FIELD_BAND),
            cloud,
            spectra: spectra_of(&views),
            views,
            literal: OnceLock::new(),
            whole: OnceLock::new(),
        })
    }

    /// The reference as the target of a pose, with the edges of one of its views; `None` for a flat shape.
    pub fn target(&self, view: usize) -> Option<Target<'_>> {
        let Self {
            cloud, tree, field, ..
        } = self;
        let view = self.views.get(view)?;
        (!cloud.points.is_empty()).then_some(Target {
            cloud,
            tree,
            field,
            edges: view.edges.get_or_init(|| {
                let edges = sheet_edges(view, cloud, field);
                EdgePoints::new(&edges, NUM_EDGES)
            }),
            spacing: SPACING,
        })
    }

    /// Makes now what is otherwise made when it is first asked for, a millisecond or two: for who measures what an
    /// inspection takes once all is made.
    pub fn make_ready(&self) {
        self.tree();
        self.literal();
        for view in 0..self.views.len() {
            self.target(view);
        }
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
        Self {
            name: name.to_owned(),
            enrolled_as: name.to_owned(),
            tree: OnceLock::new(),
            field: NearestField::new(&cloud.points, FIELD_CELL, FIELD_BAND),
            cloud,
            spectra: spectra_of(&views),
            views,
            literal: OnceLock::new(),
            whole: OnceLock::new(),
        }
    }
}

/// The views' signatures, for the circular correlation.
pub fn spectra_of(views: &[ReferenceView]) -> RaySpectra {
    RaySpectra::of(views.iter().map(|view| &view.signature.rays[..]))
}

impl ReferenceView {
    fn new(
        viewpoint: Point3<f64>,
        plane: PlaneImage,
        contour: Contour,
        signature: FanSignature,
    ) -> Self {
        Self {
            viewpoint,
            edges: OnceLock::new(),
            pixels: plane
                .image
                .packed((PACKED_PIXEL / plane.pixel.0).round() as usize),
            image_area: plane.image.num_set() as f64 * plane.pixel.0.powi(2),
            outline_field: OnceLock::new(),
            plane_from_part: plane.plane_from_camera,
            plane,
            contour,
            signature,
        }
    }

    fn from_viewpoint(
        cloud: &PointCloud,
        bounds: (Point3<f32>, Point3<f32>),
        viewpoint: &Point3<f64>,
        params: &ReferenceParams,
    ) -> Option<Self> {
        let visible = visible_from(cloud, bounds, viewpoint);
        let points: Vec<Point3<f32>> = visible.iter().map(|v| cloud.points[v.0]).collect();
        // The cloud is even on the surface; a camera sees a tilted surface with fewer pixels.
        let weight = |i: usize, _: &Point3<f32>| visible[i].1;
        let plane = project_weighted(&points, weight, viewpoint, &params.project).ok()?;
        let contour = find_contour(&plane, &params.contour).ok()?;
        let signature = describe(&contour, &params.signature).ok()?;
        Some(Self::new(*viewpoint, plane, contour, signature))
    }

    /// The nearest points of outline and openings, in the view's plane space.
    pub fn outline_field(&self) -> &OutlineField {
        self.outline_field.get_or_init(|| {
            let borders = std::iter::once(&self.contour.outline).chain(&self.contour.openings);
            OutlineField::new(borders.flatten().copied().collect())
        })
    }

    /// The transform of view-plane space into a scene's plane space, in the plane, that turns by `turn` and carries
    /// the view's centroid to the scene's.
    pub fn scene_plane_from_view_plane(
        &self,
        turn: Radians,
        scene_centroid: &Point2<f64>,
    ) -> Isometry2<f64> {
        let rotation = nalgebra::UnitComplex::new(turn.0);
        let shift = scene_centroid - rotation * self.signature.centroid;
        Isometry2::from_parts(shift.into(), rotation)
    }
}

/// The surface at an edge of the sheet is seen at a cosine of at least this; less is where a rounded surface turns
/// away, and that outline wanders over the surface as the viewpoint moves.
const LEAST_FACING_AT_EDGE: f64 = 0.5;

/// The points of outline and openings, in the cloud's space, where the sheet itself ends.
fn sheet_edges(view: &ReferenceView, cloud: &PointCloud, field: &NearestField) -> Vec<Point3<f32>> {
    let cloud_from_plane = view.plane_from_part.inverse();
    let is_sheet_edge = |p: &Point3<f32>| {
        let Some((nearest, normals)) = field.nearest(p).zip(cloud.normals.as_ref()) else {
            return true;
        };
        let towards = (view.viewpoint - p.cast::<f64>()).normalize();
        normals[nearest.index].cast::<f64>().dot(&towards) >= LEAST_FACING_AT_EDGE
    };
    view.contour
        .lifted(&view.plane)
        .iter()
        .map(|p| (cloud_from_plane * p).cast())
        .filter(is_sheet_edge)
        .collect()
}
