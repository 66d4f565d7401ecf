//! One system with its references prepared: describes a segmented part and names the nearest reference, timed.

use std::sync::Arc;

use nalgebra::Point3;

use super::{Preparation, Size, System, SystemOutcome, SystemsError};
use crate::processor_time::ProcessorWatch;
use inspection::{library::Library, pipeline::Recipe};
use stages::{
    confirm::{Scene, confirm},
    contour::find_contour,
    descriptors::{
        Descriptors,
        local::{LocalParams, describe_reference, describe_scene},
        matching::{DescriptorBank, rank_by_rows},
        surface::{SurfaceError, SurfaceParams, prepare_surface},
        vfh::{ViewHistogram, describe_vfh, describe_views, nearest_reference},
    },
    project::project,
    rack::Rack,
    rank::{Matcher, Query, rank},
    reference::{Coverage, Reference, ReferenceError, ReferenceParams},
    scene::SceneCloud,
    segment::SegmentedPart,
    signature::describe,
};

/// A system with its references prepared.
pub(super) struct PreparedSystem {
    method: Method,
    pub(super) preparation: Preparation,
}

/// How a system recognises.
enum Method {
    Outline(Matcher),
    Confirmed,
    Views(SurfaceParams, Vec<Vec<ViewHistogram>>),
    Local(LocalParams, DescriptorBank),
}

impl PreparedSystem {
    pub(super) fn prepare(system: System, library: &Library) -> Result<Self, SystemsError> {
        let references = &library.references;
        let watch = ProcessorWatch::start();
        // Our references come prepared; preparing them again measures its time.
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
            _ => {
                prepare_again(references)?;
                let method = match system {
                    System::Paper => Method::Outline(Matcher::Paper),
                    System::Confirmed => Method::Confirmed,
                    _ => Method::Outline(Matcher::Default),
                };
                (method, None)
            }
        };
        Ok(Self {
            method,
            preparation: Preparation {
                time: watch.elapsed(),
                num_rows,
            },
        })
    }

    pub(super) fn answer(
        &self,
        part: &SegmentedPart,
        scene: &SceneCloud,
        library: &Library,
        recipe: &Recipe,
    ) -> SystemOutcome {
        let references = &library.references;
        let watch = ProcessorWatch::start();
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
        let time = watch.elapsed();
        SystemOutcome {
            found: found.map(|reference| references[reference].name.clone()),
            time,
            size,
        }
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
        Reference::prepare(&r.name, Arc::clone(&r.cloud), Coverage::OneSide, &params)?.prefetch();
    }
    Ok(())
}

/// Runs our stages from the projection to the ranking and, given a scene, the confirmation.
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
    let ranking = rank(&query, references, &recipe.rank);
    let Some(scene) = confirm_in else {
        return ranking.entries.first().map(|entry| entry.reference);
    };
    let rack = Rack::ANYWHERE;
    let scene = Scene {
        scene,
        part,
        query,
        rack,
        expected: &[],
    };
    let (confirmed, _) = confirm(&scene, references, &ranking, &recipe.confirm, 0.0);
    confirmed.entries.first().map(|entry| entry.reference)
}

fn by_views(
    part: &SegmentedPart,
    params: &SurfaceParams,
    views: &[Vec<ViewHistogram>],
) -> Option<(usize, Size)> {
    let camera = Point3::origin();
    let surface = prepare_surface(&part.cloud, &camera, params).ok()?;
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
