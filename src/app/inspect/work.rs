//! What the workspace's thread does: gets a scene, inspects it and prepares what the panels draw.

use std::sync::Arc;

use jiff::Timestamp;
use nalgebra::Point3;

use super::scene::{Ingredients, SceneFigure};
use crate::{
    app::{
        camera::CameraError,
        deviation::deviations,
        figures::Figures,
        shelf::{LibraryShown, Shelf},
        source::{Captured, Origin, SceneError, SceneSource},
    },
    capture::CaptureWarning,
    error::Advice,
    history::{About, NewEntry},
    library::{Library, LibraryError},
    pipeline::{
        self, Inspection, Recipe, Watch,
        live::{Standing, Stillness},
    },
    report::InspectionLine,
    robot::spray::{CarriedPath, carry},
    stages::{
        scene::SceneCloud,
        stand_off::{StandOff, StandOffError, stand_off},
    },
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
    pub warnings: Vec<CaptureWarning>,
    /// Middle of the best reference's extent, part space, metres.
    pub middle: Option<Point3<f64>>,
    /// Signed distance of every point of the scene to the best reference at its pose, metres; NaN where there is
    /// none, empty without a pose.
    pub deviations: Vec<f32>,
    /// The nozzle's stand-off over the best reference at its pose; `None` where none is accepted.
    pub stand_off: Option<Result<StandOff, StandOffError>>,
    /// The part's stored spray path, carried to where it hangs now; `None` where none is stored or nothing accepted.
    pub spray: Option<CarriedPath>,
    /// What the 3-D view shows.
    pub view: SceneFigure,
    /// Of a frame among others: what they say together.
    pub followed: Option<Followed>,
    /// The same for the history.
    pub entry: NewEntry,
}

/// What a frame stands for that is one of many.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Whether the scene moves.
    pub stillness: Stillness,
    /// What counts.
    pub standing: Standing,
    /// Frames that its depth is averaged over.
    pub num_averaged: usize,
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
    let taken = request
        .source
        .take(shelf.camera(), &|| watch.is_cancelled());
    let Captured {
        scene,
        origin,
        warnings,
    } = match taken {
        Err(SceneError::Camera(CameraError::Cancelled)) => return Ok(None),
        taken => taken?,
    };
    let Some(fitted) = shelved.fitting(&request.recipe, watch) else {
        return Ok(None);
    };
    let Ok(inspection) = pipeline::run(&scene, &fitted, &request.recipe, watch) else {
        return Ok(None);
    };
    let found = Found {
        scene,
        origin,
        warnings,
        recipe: Arc::clone(&request.recipe),
        inspection,
        followed: None,
        source: request.source.in_words(),
    };
    Ok(Some(found.prepared(&fitted, &shelved.shown)))
}

/// An inspection, before what the panels draw of it is made.
pub(in crate::app) struct Found {
    pub(in crate::app) scene: Arc<SceneCloud>,
    pub(in crate::app) origin: Origin,
    pub(in crate::app) warnings: Vec<CaptureWarning>,
    pub(in crate::app) recipe: Arc<Recipe>,
    pub(in crate::app) inspection: Inspection,
    pub(in crate::app) followed: Option<Followed>,
    /// Where the scene came from, as the history has it.
    pub(in crate::app) source: String,
}

impl Found {
    /// Middle of the best reference's extent, part space, metres.
    pub(in crate::app) fn middle(
        inspection: &Inspection,
        library: &Library,
    ) -> Option<Point3<f64>> {
        inspection.best_reference(library)?.middle()
    }

    /// Makes what the panels draw: goes through every point.
    pub(in crate::app) fn prepared(
        self,
        library: &Library,
        shown: &Arc<LibraryShown>,
    ) -> Inspected {
        let Self {
            scene,
            origin,
            warnings,
            recipe,
            inspection,
            followed,
            source,
        } = self;
        let best = inspection.best_reference(library);
        let deviations = best.map_or_else(Vec::new, |reference| {
            deviations(&scene, &inspection, reference)
        });
        let middle = Self::middle(&inspection, library);
        let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
        // Nothing is sprayed at what was not recognised.
        let sprayed = best.zip(pose).filter(|_| inspection.verdict.is_accepted());
        let stand_off = sprayed.map(|(reference, pose)| {
            stand_off(reference, &pose.camera_from_part(), &recipe.stand_off)
        });
        let spray = sprayed.and_then(|(_, pose)| {
            let first = inspection.ranking.entries.first()?;
            let path = shown.spray_paths.get(first.reference)?.as_ref()?;
            let seen = &inspection.segmentation.part.as_ref().ok()?.cloud;
            Some(carry(
                path,
                &pose.camera_from_part(),
                seen,
                &recipe.stand_off,
            ))
        });
        let view = SceneFigure::of(&Ingredients {
            scene: &scene,
            inspection: &inspection,
            reference: best,
            middle,
            deviations: &deviations,
            stand_off: stand_off.as_ref().and_then(|found| found.as_ref().ok()),
            spray: spray.as_ref(),
        });
        let figures = Figures::of(&scene, &inspection, library, shown);
        let at = Timestamp::now();
        let title = origin.title();
        let about = About {
            at,
            line: InspectionLine::of(&title, &inspection).to_json(),
            is_simulated: origin.is_simulated(),
            title: figures.candidates.first().map(|best| best.title.as_str()),
            library: shown.identity.clone(),
            // What has no JSON form cannot be had again either.
            origin: serde_json::to_string(&origin).ok(),
            picture: figures.segmentation.as_ref(),
            scene: title,
            source,
        };
        let entry = NewEntry::of(about, &scene, &inspection, &recipe);
        Inspected {
            origin,
            at,
            scene,
            recipe,
            inspection,
            figures,
            library: Arc::clone(shown),
            warnings,
            middle,
            deviations,
            stand_off,
            spray,
            view,
            followed,
            entry,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        app::source::CellChoice,
        pipeline::{Unwatched, Verdict},
    };

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
