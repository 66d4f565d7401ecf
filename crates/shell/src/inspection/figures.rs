//! Data of the stage pictures, prepared once per inspection in its task: plain numbers, ready to be scaled.

use image::RgbImage;
use nalgebra::{Isometry2, Point2};

use super::library_cache::LibraryView;
use inspection::{
    library::Library,
    pipeline::{Inspection, Stage, parameters::Group},
};
use records::report::{binary_picture, segmentation_picture};
use stages::{
    confirm::ConfirmedMatch, contour::Contour, rank::ImagePlacement, reference::ReferenceView,
    scene::SceneCloud, signature::FanSignature,
};
use ui::language::{parameters, text};

/// The pictures of the stages, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StagePanel {
    /// The label of every point.
    Segmentation,
    /// The part projected into its own plane.
    BinaryImage,
    /// Outline, openings, centroid and rays.
    Contour,
    /// Lengths and angles of the rays.
    Signature,
    /// The enrolled parts, best first.
    Ranking,
    /// E per iteration.
    Alignment,
}

impl StagePanel {
    /// All pictures, in order.
    pub const ALL: [Self; 6] = [
        Self::Segmentation,
        Self::BinaryImage,
        Self::Contour,
        Self::Signature,
        Self::Ranking,
        Self::Alignment,
    ];

    /// Returns the name shown to the user.
    pub fn title(self) -> String {
        match self {
            Self::Segmentation => parameters::group(Group::Segmentation),
            Self::BinaryImage => parameters::group(Group::BinaryImage),
            Self::Contour => text!("inspect-contour"),
            Self::Signature => text!("inspect-signatures"),
            Self::Ranking => text!("inspect-ranking"),
            Self::Alignment => text!("inspect-alignment"),
        }
    }

    /// Returns the picture of a pipeline stage.
    pub fn of(stage: Stage) -> Self {
        match stage {
            Stage::Segment => Self::Segmentation,
            Stage::Project => Self::BinaryImage,
            Stage::Contour => Self::Contour,
            Stage::Signature => Self::Signature,
            Stage::Rank => Self::Ranking,
            Stage::Pose => Self::Alignment,
        }
    }
}

/// A closed or open line in the plane frame, metres, y up.
pub type PlaneLine = Vec<[f32; 2]>;

/// Data drawn for an inspection; `None` or empty for what its stages did not produce.
#[derive(Clone, Debug, Default)]
pub struct StageFigures {
    /// The label of every point, as the camera sees it.
    pub segmentation: Option<RgbImage>,
    /// The binary image, black on white.
    pub binary: Option<RgbImage>,
    /// Outline, openings and rays.
    pub contour: Option<ContourFigure>,
    /// Ray lengths and ray angles.
    pub signature: Option<SignatureCurves>,
    /// One per entry of the ranking, in its order.
    pub candidates: Vec<RankedPartFigure>,
    /// Number of points of the part.
    pub num_part: usize,
    /// Number of points of the scene with a reading.
    pub num_points: usize,
}

/// Outline and rays of the part in its plane.
#[derive(Clone, Debug)]
pub struct ContourFigure {
    /// The outline first, then the openings; each closed.
    pub borders: Vec<PlaneLine>,
    /// Ends of every fourth ray; all rays start at the centroid.
    pub ray_ends: PlaneLine,
    /// Start of all rays.
    pub centroid: [f32; 2],
    /// Smallest and largest coordinates.
    pub bounds: [[f32; 2]; 2],
}

/// The two curves of a fan signature.
#[derive(Clone, Debug)]
pub struct SignatureCurves {
    /// Ray lengths L, metres.
    pub lengths: Vec<f32>,
    /// Ray angles Θ, radians, continuous.
    pub angles: Vec<f32>,
}

/// An enrolled part in the ranking.
#[derive(Clone, Debug)]
pub struct RankedPartFigure {
    /// Title of the part.
    pub title: String,
    /// Title for a small picture, with the side as one letter.
    pub short_title: String,
    /// Score, 0..1; 0 if the part was not examined.
    pub score: f32,
    /// False if the part was not examined because its outline is too unlike.
    pub is_examined: bool,
    /// Its outline placed over the scene's, closed; empty if the matcher gives no placement.
    pub outline: PlaneLine,
    /// Its signature at the best lag.
    pub curves: Option<SignatureCurves>,
    /// Result of aligning it with the scene.
    pub alignment: Alignment,
}

/// Result of aligning an enrolled part with the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Alignment {
    /// The part was aligned.
    Done {
        /// Base-10 logarithm of E, square metres, per iteration.
        log_e: Vec<f32>,
        /// Root mean square distance at the end, metres.
        rms_m: f64,
    },
    /// The part was not aligned.
    None(NotAligned),
}

/// Why a part was not aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotAligned {
    /// No pose was requested.
    NotAskedFor,
    /// The reference has no cloud.
    FlatShape,
    /// No pose was found.
    NoPose,
    /// Other parts were examined first.
    LowScore,
}

impl NotAligned {
    /// Returns the text shown to the user.
    pub fn title(self) -> String {
        match self {
            Self::NotAskedFor => text!("inspect-not-asked-for"),
            Self::FlatShape => text!("inspect-flat-shape"),
            Self::NoPose => text!("inspect-no-pose-found"),
            Self::LowScore => text!("inspect-score-too-low"),
        }
    }
}

impl Alignment {
    fn of(entry: &ConfirmedMatch, inspection: &Inspection, library: &Library) -> Self {
        let reference = library.references.get(entry.reference);
        let is_flat = reference.is_none_or(|reference| reference.cloud.points.is_empty());
        let mut entries = inspection.ranking.entries.iter();
        let is_any_examined = entries.any(|entry| entry.is_examined);
        match (&entry.pose, &inspection.pose) {
            (Some(pose), _) => Self::Done {
                log_e: pose
                    .iterations
                    .iter()
                    .map(|step| step.e_m2)
                    .filter(|e| *e > 0.0 && e.is_finite())
                    .map(|e| e.log10() as f32)
                    .collect(),
                rms_m: pose.fit.rms_m,
            },
            (None, None) if !is_any_examined => Self::None(NotAligned::NotAskedFor),
            (None, _) if is_flat => Self::None(NotAligned::FlatShape),
            (None, Some(Err(_))) => Self::None(NotAligned::NoPose),
            (None, Some(Ok(_)) | None) => Self::None(NotAligned::LowScore),
        }
    }
}

/// Maximum number of corners of a drawn border; more would not be visible.
const MAX_CORNERS: usize = 400;

impl StageFigures {
    /// Prepares the data; `shown` has the titles of the references.
    pub fn of(
        scene: &SceneCloud,
        inspection: &Inspection,
        library: &Library,
        shown: &LibraryView,
    ) -> Self {
        let mut figures = Self {
            segmentation: segmentation_picture(scene, &inspection.segmentation),
            binary: inspection.plane.as_ref().map(binary_picture),
            num_points: scene.cloud.num_finite(),
            ..Self::default()
        };
        if let Ok(part) = &inspection.segmentation.part {
            figures.num_part = part.cloud.points.len();
        }
        if let (Some(contour), Some(signature)) = (&inspection.contour, &inspection.signature) {
            figures.contour = Some(ContourFigure::of(contour, signature));
            figures.signature = Some(SignatureCurves::of(
                &signature.lengths(),
                &signature.angles(),
            ));
            let entries = inspection.ranking.entries.iter();
            figures.candidates = entries
                .map(|entry| RankedPartFigure::of(entry, inspection, signature, library, shown))
                .collect();
        }
        figures
    }
}

impl ContourFigure {
    fn of(contour: &Contour, signature: &FanSignature) -> Self {
        let mut borders = vec![closed(&contour.outline, &Isometry2::identity())];
        let openings = contour.openings.iter();
        borders.extend(openings.map(|opening| closed(opening, &Isometry2::identity())));
        let rays = signature.rays.iter().step_by(4);
        let mut bounds = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];
        for [x, y] in borders.iter().flatten().copied() {
            bounds[0] = [bounds[0][0].min(x), bounds[0][1].min(y)];
            bounds[1] = [bounds[1][0].max(x), bounds[1][1].max(y)];
        }
        Self {
            ray_ends: rays.map(|ray| plain(&(signature.centroid + ray))).collect(),
            centroid: plain(&signature.centroid),
            borders,
            bounds,
        }
    }
}

impl SignatureCurves {
    pub fn of(lengths: &[f64], angles: &[f64]) -> Self {
        let narrow = |values: &[f64]| values.iter().map(|value| *value as f32).collect();
        Self {
            lengths: narrow(lengths),
            angles: narrow(angles),
        }
    }

    /// Shifts the signature of a view by the lag of its placement and turns it, to be drawn beside the scene's.
    pub fn placed(
        view: &ReferenceView,
        placement: &ImagePlacement,
        scene: &FanSignature,
    ) -> Option<Self> {
        let signature = view.signature();
        let (lengths, angles) = (signature.lengths(), signature.angles());
        let num = lengths.len();
        if num == 0 || num != scene.rays.len() {
            return None;
        }
        let lag = placement.lag % num;
        let at = |ray: usize| (ray + num - lag) % num;
        let whole = std::f64::consts::TAU;
        let turned: Vec<f64> = (0..num)
            .map(|ray| {
                // After the view's last ray its first follows, a full turn further.
                let again = if ray >= lag { whole } else { 0.0 };
                angles[at(ray)] + placement.turn.0 + again
            })
            .collect();
        let apart = turned.iter().zip(scene.angles()).map(|(a, b)| a - b);
        let circles = (apart.sum::<f64>() / num as f64 / whole).round() * whole;
        let turned: Vec<f64> = turned.iter().map(|angle| angle - circles).collect();
        let shifted: Vec<f64> = (0..num).map(|ray| lengths[at(ray)]).collect();
        Some(Self::of(&shifted, &turned))
    }
}

impl RankedPartFigure {
    fn of(
        entry: &ConfirmedMatch,
        inspection: &Inspection,
        scene: &FanSignature,
        library: &Library,
        shown: &LibraryView,
    ) -> Self {
        let title = shown.title(entry.reference).to_owned();
        let placed = entry.placements.first().and_then(|placement| {
            let reference = library.references.get(entry.reference)?;
            Some((placement, reference.views.get(placement.view)?))
        });
        let outline = placed.map_or_else(Vec::new, |(placement, view)| {
            let moved = view.scene_plane_from_view_plane(placement.turn, &scene.centroid);
            closed(&view.contour().outline, &moved)
        });
        Self {
            short_title: shortened(&title),
            title,
            score: entry.score as f32,
            is_examined: inspection.ranking.score_of(entry).is_some(),
            outline,
            curves: placed
                .and_then(|(placement, view)| SignatureCurves::placed(view, placement, scene)),
            alignment: Alignment::of(entry, inspection, library),
        }
    }
}

/// Shortens "Front door, left" to "Front door L".
fn shortened(title: &str) -> String {
    let sides = [(", left", " L"), (", right", " R")];
    let short = sides
        .iter()
        .find_map(|(long, short)| Some(format!("{}{short}", title.strip_suffix(long)?)));
    short.unwrap_or_else(|| title.to_owned())
}

/// Moves and thins a border, and repeats its first corner at the end.
pub fn closed(border: &[Point2<f64>], moved: &Isometry2<f64>) -> PlaneLine {
    let step = border.len().div_ceil(MAX_CORNERS).max(1);
    let corners = border.iter().step_by(step).chain(border.first());
    corners.map(|corner| plain(&(moved * corner))).collect()
}

/// Converts a point for drawing.
pub fn plain(point: &Point2<f64>) -> [f32; 2] {
    [point.x as f32, point.y as f32]
}

#[cfg(test)]
mod tests {
    use super::{Alignment, NotAligned};
    use crate::inspection::{inspected::inspected_cell, source::CellChoice};
    use inspection::pipeline::Recipe;

    #[test]
    fn the_best_parts_outline_and_signature_lie_on_the_scenes() {
        let inspected = inspected_cell(CellChoice::InTurn, 1);
        let figures = &inspected.figures;
        let (contour, scene) = (
            figures.contour.as_ref().expect("a contour"),
            figures.signature.as_ref().expect("a signature"),
        );
        let best = &figures.candidates[0];
        let curves = best.curves.as_ref().expect("placed");
        let mean_apart = |a: &[f32], b: &[f32]| {
            a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f32>() / a.len() as f32
        };
        assert!(mean_apart(&curves.lengths, &scene.lengths) < 0.05);
        assert!(mean_apart(&curves.angles, &scene.angles) < 0.2);
        let [low, high] = contour.bounds;
        for [x, y] in &best.outline {
            assert!(*x > low[0] - 0.1 && *x < high[0] + 0.1);
            assert!(*y > low[1] - 0.1 && *y < high[1] + 0.1);
        }
        assert!(figures.segmentation.is_some() && figures.binary.is_some());
        let Alignment::Done { log_e, rms_m } = &best.alignment else {
            panic!("{:?}", best.alignment);
        };
        assert!(log_e.len() > 1 && *rms_m < 0.005);
    }

    #[test]
    fn a_short_name_keeps_its_side() {
        assert_eq!(super::shortened("Front door, left"), "Front door L");
        assert_eq!(super::shortened("Fender, right"), "Fender R");
        assert_eq!(super::shortened("Grille"), "Grille");
    }

    #[test]
    fn every_part_that_was_tried_shows_its_own_alignment_and_the_others_say_why_not() {
        let num_tried = Recipe::default().confirm.num_references;
        let inspected = inspected_cell(CellChoice::InTurn, 1);
        let candidates = &inspected.figures.candidates;
        let curves: Vec<&Vec<f32>> = candidates
            .iter()
            .filter_map(|candidate| match &candidate.alignment {
                Alignment::Done { log_e, .. } => Some(log_e),
                Alignment::None(_) => None,
            })
            .collect();
        assert_eq!(curves.len(), num_tried);
        assert!(curves.iter().all(|curve| curve.len() > 1));
        assert!(curves.windows(2).all(|pair| pair[0] != pair[1]));
        let why = Alignment::None(NotAligned::LowScore);
        assert!(candidates.len() > num_tried);
        assert!(candidates[num_tried..].iter().all(|c| c.alignment == why));
        // The alignment of the best one gives the reported pose.
        let entry = &inspected.inspection.ranking.entries[0];
        let pose = inspected.inspection.pose.as_ref().expect("a pose");
        assert_eq!(entry.pose.as_ref(), pose.as_ref().ok());
    }
}
