//! Jobs of the workspace: plan a path, simulate its film, store it; and the gun at a time on the path.

use std::{
    path::Path,
    sync::{Arc, Mutex},
};

use glam::Vec3;
use nalgebra::{Point3, Unit, Vector3};

use crate::workspaces::paint::state::ShownPath;
use files::write_text;
use geometry::{
    cloud::PointCloud,
    error::lock,
    nearest::{KdTree, median_spacing},
};
use inspection::library::{FileCheck, PartMeta, PartName, Side, SprayPath};
use robot::paint::{
    Coat, Film, KeepOut, PaintError, PaintSurface, PathEdit, edited, plan, propose, simulate,
};
use shell::inspection::library_cache::{LibraryCache, LibraryView, LoadedLibrary};
use stages::reference::{Coverage, Reference};
use ui::{
    language::{library_text, text},
    task::{TaskContext, TaskError},
    user_error::UserError,
    viewport::{Colouring, Line, LineSet, PointSet, Role, vec3},
    widgets::sentence,
};

/// Input of planning.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Request {
    pub(super) part: PartName,
    /// Its cloud.
    pub(super) cloud: FileCheck,
    /// The library of the part.
    pub(super) library: String,
    /// The side that it is painted from, if it is stored with the part.
    pub(super) side: Option<Side>,
    /// The path stored with the part.
    pub(super) stored: Option<FileCheck>,
    pub(super) coat: Coat,
    pub(super) regions: Vec<KeepOut>,
    pub(super) edits: Vec<PathEdit>,
    pub(super) shown: ShownPath,
}

/// A path and its film, and what the view shows of them.
#[derive(Debug)]
pub struct Planned {
    /// Name of the part.
    pub part: PartName,
    /// The surface to paint.
    pub surface: Arc<PaintSurface>,
    /// The spray path.
    pub path: Arc<SprayPath>,
    /// The simulated film.
    pub film: Arc<Film>,
    /// Times along the path.
    pub course: GunCourse,
    /// The coat; for a proposal, the one found.
    pub coat: Coat,
    /// True if the same path was stored with the part when it was planned.
    pub is_stored: bool,
    /// The surface coloured by its film.
    pub(super) points: PointSet,
    /// Strokes as lines, and the moves between them dashed.
    pub(super) lines: LineSet,
    /// The points where the gun is switched on, and off.
    pub(super) marks: [PointSet; 2],
}

/// A part as the view shows it until its first path is planned.
#[derive(Debug)]
pub(super) struct UnpaintedPart {
    /// Name of the part.
    pub(super) part: PartName,
    /// Distance between neighbouring points, metres.
    pub(super) spacing: f64,
    pub(super) points: PointSet,
}

/// A result of a task.
#[derive(Debug)]
pub(super) enum PaintResult {
    /// A part whose path is being planned.
    Unpainted(Arc<UnpaintedPart>),
    /// A path and its film.
    Planned(Arc<Planned>),
    /// A path and its film for a coat whose spacing and speed were found.
    Proposed(Arc<Planned>),
    /// The side that a part is painted from was stored with it.
    SideChosen(Arc<LibraryView>),
    /// A path was stored with a part or removed; holds the former path.
    Stored {
        part: PartName,
        former: Option<SprayPath>,
        num_points: Option<usize>,
        library: Arc<LibraryView>,
    },
}

/// Finds a part of the library, and its index.
pub(super) fn enrolled<'a>(
    loaded: &'a LoadedLibrary,
    part: &PartName,
) -> Result<(usize, &'a Reference), UserError> {
    let index = loaded.shown.index_of(part.as_str());
    let found = index.and_then(|index| Some((index, loaded.library.references.get(index)?)));
    found.ok_or_else(|| UserError {
        what: text!("paint-no-such-part", part = part.as_str()),
        advice: text!("shell-choose-another-part"),
    })
}

/// Reads the points of a part that has no path yet.
pub(super) fn unpainted(
    part: &PartName,
    library_cache: &LibraryCache,
) -> Result<PaintResult, UserError> {
    let loaded = library_cache.get();
    let (_, reference) = enrolled(&loaded, part)?;
    let points = &reference.cloud.points;
    let positions: Vec<[f32; 3]> = points.iter().map(|p| [p.x, p.y, p.z]).collect();
    Ok(PaintResult::Unpainted(Arc::new(UnpaintedPart {
        part: part.clone(),
        spacing: median_spacing(points, &KdTree::new(points)),
        points: PointSet::new(positions, Role::Part).packed(),
    })))
}

/// Plans or reads a path, and simulates its film.
pub(super) fn planned(
    request: &Request,
    is_proposal: bool,
    library_cache: &LibraryCache,
    context: &TaskContext<PaintResult>,
) -> Result<PaintResult, TaskError> {
    let loaded = library_cache.get();
    let (index, reference) = enrolled(&loaded, &request.part)?;
    let PartMeta { coverage, side, .. } = loaded.shown.parts[index];
    let stored = loaded.shown.spray_paths.get(index).and_then(Option::as_ref);
    let shown = stored.filter(|_| request.shown == ShownPath::Stored);
    let job = PaintJob {
        cloud: Arc::clone(&reference.cloud),
        coverage,
        side,
        stored: shown.map(|stored| stored.path.clone()),
        coat: request.coat,
        regions: request.regions.clone(),
        edits: request.edits.clone(),
        is_proposal,
    };
    let Painted {
        surface,
        coat,
        path,
        film,
    } = remembered(&DONE, job, |job| job.paint(context))?;
    context.check()?;
    let course = GunCourse::of(&path, coat.speed);
    let planned = Planned {
        part: request.part.clone(),
        points: coloured(&surface, &film, &coat),
        lines: lines(&path, &course, &coat),
        marks: marks(&path, &course, &coat),
        is_stored: stored.is_some_and(|stored| path.is_as_written(&stored.path)),
        surface,
        path,
        film,
        course,
        coat,
    };
    let planned = Arc::new(planned);
    Ok(if is_proposal {
        PaintResult::Proposed(planned)
    } else {
        PaintResult::Planned(planned)
    })
}

/// What path and film are computed from.
#[derive(PartialEq)]
struct PaintJob {
    cloud: Arc<PointCloud>,
    coverage: Coverage,
    side: Option<Side>,
    /// The path, if it is not planned.
    stored: Option<SprayPath>,
    coat: Coat,
    regions: Vec<KeepOut>,
    edits: Vec<PathEdit>,
    is_proposal: bool,
}

/// A path with its film.
#[derive(Clone)]
struct Painted {
    surface: Arc<PaintSurface>,
    coat: Coat,
    path: Arc<SprayPath>,
    film: Arc<Film>,
}

/// The jobs done last, most recently first: after a step back or forth, and when a part is chosen again, its path is there
/// at once. While a slider is dragged, each job that is done in time is kept like any other: only when the slider is let go it
/// is known which of them was the last.
static DONE: Mutex<Vec<(PaintJob, Painted)>> = Mutex::new(Vec::new());
/// How many are kept; each takes a megabyte or two.
const MAX_DONE: usize = 16;

/// Does a job, unless it was among the last.
fn remembered<J: PartialEq, R: Clone, E>(
    done: &Mutex<Vec<(J, R)>>,
    job: J,
    work: impl FnOnce(&J) -> Result<R, E>,
) -> Result<R, E> {
    let earlier = known(&mut lock(done), &job);
    if let Some(result) = earlier {
        return Ok(result);
    }
    let result = work(&job)?;
    let mut done = lock(done);
    // Another thread may have done it meanwhile.
    if let Some(result) = known(&mut done, &job) {
        return Ok(result);
    }
    done.truncate(MAX_DONE - 1);
    done.insert(0, (job, result.clone()));
    Ok(result)
}

/// The result of a job that was done, which becomes the first.
fn known<J: PartialEq, R: Clone>(done: &mut [(J, R)], job: &J) -> Option<R> {
    let index = done.iter().position(|(of, _)| of == job)?;
    done[..=index].rotate_right(1);
    Some(done[0].1.clone())
}

impl PaintJob {
    fn paint(&self, context: &TaskContext<PaintResult>) -> Result<Painted, TaskError> {
        let (coat, regions) = (&self.coat, &self.regions);
        let is_to_plan = self.stored.is_none() && !self.is_proposal;
        let num_steps = if is_to_plan { 3 } else { 2 };
        context.progress(1, num_steps);
        let surface = PaintSurface::of_cloud(&self.cloud, self.coverage, self.side);
        let surface = surface.map_err(|error| match error {
            PaintError::SideUnclear { .. } => UserError {
                what: sentence(&library_text("enrol-side-unclear")),
                advice: text!("paint-side-unclear-advice"),
            },
            error => UserError::of(&error),
        })?;
        context.check()?;
        context.progress(2, num_steps);
        let failed = |error| UserError::of(&error);
        let (coat, path, film) = if let Some(path) = &self.stored {
            let film = simulate(&surface, path, coat, regions).map_err(failed)?;
            (*coat, path.clone(), film)
        } else if self.is_proposal {
            let found = propose(&surface, coat, regions).map_err(failed)?;
            (found.coat, found.path, found.film)
        } else {
            let path = plan(&surface, coat, regions).map_err(failed)?;
            let path = edited(path, &self.edits, coat.stand_off);
            context.check()?;
            context.progress(3, num_steps);
            let film = simulate(&surface, &path, coat, regions).map_err(failed)?;
            (*coat, path, film)
        };
        Ok(Painted {
            surface: Arc::new(surface),
            coat,
            path: Arc::new(path),
            film: Arc::new(film),
        })
    }
}

/// Scale of the film's deviations: a view keeps whole micrometres, and films are only some micrometres thick.
pub(super) const MAGNIFIED: f64 = 1000.0;

/// Returns the surface with the film's deviation from its target; keep-outs and what is not paintable have none.
fn coloured(surface: &PaintSurface, film: &Film, coat: &Coat) -> PointSet {
    let positions: Vec<[f32; 3]> = surface.points.iter().map(|p| vec3(p).to_array()).collect();
    let each = film.thickness.iter().zip(&film.is_paintable);
    let off: Vec<f32> = each
        .map(|(thickness, is_paintable)| {
            if *is_paintable {
                (MAGNIFIED * (thickness - coat.target)) as f32
            } else {
                f32::NAN
            }
        })
        .collect();
    PointSet::new(positions, Role::Part)
        .with_deviations(off)
        .packed()
}

/// Distance of lines from the surface, metres, as points have a size.
const BEFORE: f64 = 0.008;

/// The point at which the gun aims at a point of the path, moved a little off the surface.
pub(super) fn aim(path: &SprayPath, point: usize, coat: &Coat) -> Vec3 {
    let point = &path.points()[point];
    let stand_off = point.stand_off.map_or(coat.stand_off, |d| d.0);
    vec3(&(point.nozzle + point.direction.into_inner() * (stand_off - BEFORE)))
}

fn lines(path: &SprayPath, course: &GunCourse, coat: &Coat) -> LineSet {
    let stretch = |first: usize, last: usize| -> Vec<Vec3> {
        (first..=last).map(|i| aim(path, i, coat)).collect()
    };
    let move_along = |first: usize, last: usize| {
        let line = Line::new(stretch(first, last), Role::Contour);
        line.dashed().with_width(1.0)
    };
    let mut lines = Vec::new();
    let mut from = 0;
    for stroke in &course.strokes {
        let [first, last] = *stroke;
        if first > from {
            lines.push(move_along(from, first));
        }
        let spraying = Line::new(stretch(first, last), Role::Contour);
        lines.push(spraying.with_width(1.6));
        from = last;
    }
    let last = path.points().len() - 1;
    if last > from {
        lines.push(move_along(from, last));
    }
    LineSet::new(lines)
}

fn marks(path: &SprayPath, course: &GunCourse, coat: &Coat) -> [PointSet; 2] {
    let at = |point: usize| aim(path, point, coat).to_array();
    let on: Vec<[f32; 3]> = course.strokes.iter().map(|[first, _]| at(*first)).collect();
    let off: Vec<[f32; 3]> = course.strokes.iter().map(|[_, last]| at(*last)).collect();
    [
        PointSet::new(on, Role::AxisY).coloured(Colouring::Segment),
        PointSet::new(off, Role::AxisX).coloured(Colouring::Segment),
    ]
}

/// Stores a path with a part or removes it, and reloads the library.
pub(super) fn store(
    part: &PartName,
    path: Option<&SprayPath>,
    library_cache: &LibraryCache,
) -> Result<PaintResult, UserError> {
    let loaded = library_cache.get();
    let folder = loaded.folder_to_change()?;
    // A damaged path cannot be brought back.
    let former = folder.spray_path(part.as_str()).ok().flatten();
    folder
        .set_spray_path(part, path)
        .map_err(|error| UserError::of(&error))?;
    let library = library_cache
        .reload()
        .map_err(|error| UserError::of(&error))?;
    Ok(PaintResult::Stored {
        part: part.clone(),
        former,
        num_points: path.map(|path| path.points().len()),
        library: Arc::clone(&library.shown),
    })
}

/// Stores the side that a part is painted from with it, and reloads the library.
pub(super) fn choose_side(
    part: &PartName,
    side: Side,
    library_cache: &LibraryCache,
) -> Result<PaintResult, UserError> {
    let folder = library_cache.get();
    let folder = folder.folder_to_change()?;
    folder
        .set_side(part, side)
        .map_err(|error| UserError::of(&error))?;
    let library = library_cache
        .reload()
        .map_err(|error| UserError::of(&error))?;
    Ok(PaintResult::SideChosen(Arc::clone(&library.shown)))
}

/// Writes a path as a table, atomically; describes what was written.
pub(super) fn write(file: &Path, part: &PartName, path: &SprayPath) -> Result<String, UserError> {
    write_text(file, &path.to_text_of(part)).map_err(|error| UserError::of(&error))?;
    Ok(text!("shell-wrote", path = file.display().to_string()))
}

/// Times along a path, from 0 at its first point.
#[derive(Clone, Debug, Default)]
pub struct GunCourse {
    /// Time at each point, seconds.
    pub seconds: Vec<f64>,
    /// Indices of the first and the last point of each stroke.
    pub strokes: Vec<[usize; 2]>,
}

/// The gun at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GunState {
    /// Position of the nozzle, part frame.
    pub nozzle: Point3<f64>,
    /// Direction of the jet.
    pub direction: Unit<Vector3<f64>>,
    /// True while it sprays.
    pub is_on: bool,
    /// Its speed, m/s.
    pub speed: f64,
    /// Index of the present or next stroke; the number of strokes after the last.
    pub stroke: usize,
}

impl GunCourse {
    /// Computes the times of a path; `speed` in m/s applies where the path sets none.
    pub fn of(path: &SprayPath, speed: f64) -> Self {
        let mut seconds = vec![0.0];
        let mut now = 0.0;
        for pair in path.points().windows(2) {
            now += (pair[1].nozzle - pair[0].nozzle).norm() / pair[0].speed.unwrap_or(speed);
            seconds.push(now);
        }
        Self {
            seconds,
            strokes: path.strokes(),
        }
    }

    /// Duration of the whole path, seconds.
    pub fn duration(&self) -> f64 {
        self.seconds.last().copied().unwrap_or(0.0)
    }

    /// Begin and end of a stroke, seconds.
    pub fn times(&self, stroke: [usize; 2]) -> [f64; 2] {
        stroke.map(|point| self.seconds[point])
    }

    /// Returns the gun at a time in seconds; `path` must be the path of this course.
    pub fn at(&self, path: &SprayPath, speed: f64, time: f64) -> GunState {
        let points = path.points();
        let behind = self.seconds.partition_point(|t| *t <= time);
        let i = behind.saturating_sub(1).min(points.len() - 1);
        let j = (i + 1).min(points.len() - 1);
        let (a, b) = (&points[i], &points[j]);
        let span = self.seconds[j] - self.seconds[i];
        let share = if span > 0.0 {
            ((time - self.seconds[i]) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let between = a.direction.lerp(&b.direction, share);
        GunState {
            nozzle: a.nozzle + (b.nozzle - a.nozzle) * share,
            direction: Unit::try_new(between, 1e-9).unwrap_or(a.direction),
            is_on: a.is_gun_on && j > i,
            speed: a.speed.unwrap_or(speed),
            stroke: self.strokes.partition_point(|[_, last]| *last <= i),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::library::PathPoint;

    #[test]
    fn the_result_of_a_job_done_before_is_the_very_same() {
        let done = Mutex::default();
        let do_job = |job: usize| remembered(&done, job, |job| Ok::<_, ()>(Arc::new(*job)));
        let first = do_job(0).expect("done");
        for other in 1..MAX_DONE {
            do_job(other).expect("done");
        }
        assert!(Arc::ptr_eq(&first, &do_job(0).expect("known")));
        // The one that was asked for longest ago makes room.
        let second = do_job(1).expect("known");
        do_job(MAX_DONE).expect("done");
        assert!(Arc::ptr_eq(&second, &do_job(1).expect("known")));
        assert!(lock(&done).iter().all(|(job, _)| *job != 2));
        assert_eq!(lock(&done).len(), MAX_DONE);
        // Another thread does the same job at the same time.
        let both = remembered(&done, 99, |job| do_job(*job).map(|_| Arc::new(*job)));
        assert!(Arc::ptr_eq(
            &both.expect("done"),
            &do_job(99).expect("known")
        ));
        assert_eq!(
            remembered(&done, 100, |_| Err("cancelled")),
            Err("cancelled")
        );
        assert!(lock(&done).iter().all(|(job, _)| *job != 100));
    }

    #[test]
    fn the_gun_is_where_time_and_speed_put_it() {
        let at = |x: f64, is_gun_on, speed| PathPoint {
            nozzle: Point3::new(x, 0.0, 0.0),
            direction: Vector3::z_axis(),
            stand_off: None,
            is_gun_on,
            speed,
            fan: None,
        };
        // 0.5 s off, 1 s on, 0.5 s off, 2 s on.
        let points = vec![
            at(0.0, false, Some(0.2)),
            at(0.1, true, None),
            at(0.5, false, Some(0.2)),
            at(0.6, true, Some(0.2)),
            at(1.0, false, None),
        ];
        let path = SprayPath::new(points).expect("a path");
        let course = GunCourse::of(&path, 0.4);
        assert!((course.duration() - 4.0).abs() < 1e-9);
        let times: Vec<[f64; 2]> = course.strokes.iter().map(|s| course.times(*s)).collect();
        for (found, expected) in times.iter().zip([[0.5, 1.5], [2.0, 4.0]]) {
            assert!((found[0] - expected[0]).abs() < 1e-9 && (found[1] - expected[1]).abs() < 1e-9);
        }
        for (time, x, is_on, speed, stroke) in [
            (0.0, 0.0, false, 0.2, 0),
            (0.25, 0.05, false, 0.2, 0),
            (1.0, 0.3, true, 0.4, 0),
            (1.75, 0.55, false, 0.2, 1),
            (3.0, 0.8, true, 0.2, 1),
            (4.0, 1.0, false, 0.4, 2),
            (99.0, 1.0, false, 0.4, 2),
        ] {
            let gun = course.at(&path, 0.4, time);
            assert!((gun.nozzle.x - x).abs() < 1e-9, "{time}: {gun:?}");
            assert_eq!((gun.is_on, gun.stroke), (is_on, stroke), "{time}");
            assert!((gun.speed - speed).abs() < 1e-9, "{time}");
        }
    }
}
