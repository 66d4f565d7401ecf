//! What the workspace's thread does: gets a scene, inspects it and prepares what the panels draw.

use std::sync::Arc;

use jiff::Timestamp;
use nalgebra::Point3;

use super::scene::{Ingredients, SceneFigure};
use crate::{
    app::{
        deviation::deviations,
        figures::Figures,
        shelf::{LibraryShown, Shelf},
        source::{Captured, Origin, SceneError, SceneSource},
    },
    error::Advice,
    files::FileWarning,
    library::LibraryError,
    pipeline::{self, Inspection, Recipe, Verdict, Watch},
    report::stand_off::{StandOff, StandOffError, stand_off},
    stages::scene::SceneCloud,
};

/// Get a scene and inspect it.
#[derive(Clone, Debug)]
pub struct InspectRequest {
    /// The scene.
    pub source: SceneSource,
    /// All parameters.
    pub recipe: Arc<Recipe>,
}

/// A scene with everything that was found in it.
#[derive(Debug)]
pub struct Inspected {
    /// Where the scene came from.
    pub origin: Origin,
    /// When it was inspected.
    pub at: Timestamp,
    /// The scene.
    pub scene: Arc<SceneCloud>,
    /// With which parameters.
    pub recipe: Arc<Recipe>,
    /// What was found.
    pub inspection: Inspection,
    /// What the panels draw.
    pub figures: Figures,
    /// The library it was compared with.
    pub library: Arc<LibraryShown>,
    /// What was odd about the file.
    pub warnings: Vec<FileWarning>,
    /// Middle of the best reference's extent, part space, metres.
    pub middle: Option<Point3<f64>>,
    /// Signed distance of every point of the scene to the best reference at its pose, metres; NaN where there is
    /// none, empty without a pose.
    pub deviations: Vec<f32>,
    /// The nozzle's stand-off over the best reference at its pose; `None` where none is accepted.
    pub stand_off: Option<Result<StandOff, StandOffError>>,
    /// What the 3-D view shows.
    pub view: SceneFigure,
}

/// Why a scene could not be inspected.
#[derive(Debug, thiserror::Error)]
pub enum InspectError {
    /// There is no scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// There is no library.
    #[error(transparent)]
    Library(#[from] LibraryError),
}

impl Advice for InspectError {
    fn advice(&self) -> String {
        match self {
            Self::Scene(error) => error.advice(),
            Self::Library(error) => error.advice(),
        }
    }
}

/// Gets the scene and inspects it; `None` when cancelled.
pub fn inspect(
    request: &InspectRequest,
    shelf: &Shelf,
    watch: &dyn Watch,
) -> Result<Option<Inspected>, InspectError> {
    let shelved = shelf.get()?;
    if watch.is_cancelled() {
        return Ok(None);
    }
    let Captured {
        scene,
        origin,
        warnings,
    } = request.source.read()?;
    let Some(fitted) = shelved.fitting(&request.recipe, watch) else {
        return Ok(None);
    };
    let library = &*fitted;
    let Ok(inspection) = pipeline::run(&scene, library, &request.recipe, watch) else {
        return Ok(None);
    };
    let best = inspection.ranking.entries.first();
    let best = best.and_then(|best| library.references.get(best.reference));
    let bounds = best.and_then(|reference| reference.cloud.bounds());
    let deviations = best.map_or_else(Vec::new, |reference| {
        deviations(&scene, &inspection, reference)
    });
    let middle = bounds.map(|(low, high)| nalgebra::center(&low, &high).cast());
    let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
    let is_accepted = matches!(inspection.verdict, Verdict::Part { rejected: None, .. });
    // Nothing is sprayed at what was not recognised.
    let sprayed = best.zip(pose).filter(|_| is_accepted);
    let stand_off = sprayed.map(|(reference, pose)| {
        stand_off(
            reference,
            &pose.camera_from_part(),
            &request.recipe.stand_off,
        )
    });
    let view = SceneFigure::of(&Ingredients {
        scene: &scene,
        inspection: &inspection,
        reference: best,
        middle,
        deviations: &deviations,
        stand_off: stand_off.as_ref().and_then(|found| found.as_ref().ok()),
    });
    let figures = Figures::of(&scene, &inspection, library, &shelved.shown);
    Ok(Some(Inspected {
        origin,
        at: Timestamp::now(),
        scene,
        recipe: Arc::clone(&request.recipe),
        inspection,
        figures,
        library: Arc::clone(&shelved.shown),
        warnings,
        middle,
        deviations,
        stand_off,
        view,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{app::source::CellChoice, pipeline::Unwatched};

    #[test]
    fn a_captured_frame_comes_back_inspected() {
        let request = InspectRequest {
            source: SceneSource::Cell {
                choice: CellChoice::InTurn,
                number: 1,
            },
            recipe: Arc::default(),
        };
        let inspected = inspect(&request, &Shelf::default(), &Unwatched).expect("inspected");
        let inspected = inspected.expect("not cancelled");
        let Verdict::Part { part, rejected, .. } = &inspected.inspection.verdict else {
            panic!("no part");
        };
        assert_eq!((part.as_str(), rejected), ("front_door", &None));
        let known = inspected.deviations.iter().filter(|d| d.is_finite());
        let mean = known.clone().sum::<f32>() / known.clone().count() as f32;
        assert!(known.count() > 10_000 && mean.abs() < 0.002, "{mean}");
    }
}
