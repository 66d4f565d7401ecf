//! Reads shots with their poses and puts them together, in a task, with the data drawn for the scan: one row per shot, and the
//! figure of the 3-D view.

use std::{
    cell::Cell,
    collections::BTreeSet,
    ops::ControlFlow,
    panic::resume_unwind,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    thread,
    time::{Duration, SystemTime},
};

use glam::Vec3;
use image::{Rgb, RgbImage};
use nalgebra::Point3;

use crate::inspection::source::{Origin, ScanFiles, ScanOrder, ScanRequest, ShotChoice, ShotSet};
use files::file_name;
use geometry::{
    cloud::is_finite,
    error::Advice,
    rigid::{PoseDelta, RigidTransform},
    units::Metres,
};
use inspection::pipeline::{ProgressObserver, Stage};
use records::history::{FrameError, read_shots};
use robot::{
    calibration::CellCalibration,
    frame_poses::FramePosesError,
    scan_frames::{
        FrameNews, ScanFramesError, first_captured_at, poses_beside, read_frames, with_poses,
    },
};
use stages::{
    scan::{
        Excluded, Scan, ScanError, ScanObserver, ScanParams, ScanStep, ScannedShot, Shot, assemble,
        unseen::{open_share, outline},
    },
    segment::PointLabel,
};
use ui::{
    language::{Message, described},
    user_error::UserError,
    viewport::{Colouring, LineSet, PointSet, Role, ViewColours, furniture},
};

/// Shots put together.
#[derive(Debug)]
pub struct FusedShots {
    /// The shots, and which of them were dropped.
    pub choice: ShotChoice,
    /// The result for the shots that were not dropped.
    pub scan: Scan,
    /// One row per shot of the choice, in its order.
    pub rows: Vec<ShotRow>,
    /// Data of the 3-D view.
    pub figure: ScanFigure,
    /// Problems found in the files.
    pub warnings: Vec<UserError>,
}

impl FusedShots {
    /// Number of shots that the result is based on.
    pub fn num_used(&self) -> usize {
        self.scan.used().count()
    }

    /// Pose, according to the robot, of the camera whose frame the figure uses.
    pub fn space(&self) -> Option<RigidTransform> {
        self.scan.used().next().map(|(_, shot)| shot.given)
    }

    /// Origin of the scan.
    pub fn origin(&self) -> Origin {
        Origin::Scan {
            name: self.choice.set.files.title(),
            num_shots: self.num_used(),
            is_simulated: self.scan.cloud.cloud.is_simulated,
            files: self.choice.files(),
        }
    }

    /// Returns the name shown to the user.
    pub fn title(&self) -> String {
        let title = self.choice.set.files.title();
        format!("{title} · {} shots", self.num_used())
    }
}

/// Why shots cannot be put together.
#[derive(Debug, thiserror::Error, Advice)]
pub enum FuseError {
    /// The frames or their poses cannot be read.
    #[error(transparent)]
    #[advice(match _0 {
        ScanFramesError::NoPoses => {
            "Choose the file of the poses; its form is described by partsight help scan".into()
        }
        ScanFramesError::Poses(FramePosesError::Missing { .. }) => {
            "Choose a file that has them, or add them to this one and open the scan again".into()
        }
        ScanFramesError::Poses(FramePosesError::NoCalibration { .. } | FramePosesError::CameraIsFixed { .. }) => {
            "Load the calibration of the camera on the flange (Robot…, B), then open the scan again".into()
        }
        other => other.advice(),
    })]
    Frames(#[from] ScanFramesError),
    /// The shots in the history cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    Kept(#[from] FrameError),
    /// The shots do not fit together.
    #[error(transparent)]
    #[advice(match _0 {
        ScanError::TooFewShots { found: 1 } => {
            "Open a folder with frames from other sides too, or open this frame by itself (Ctrl O)".into()
        }
        ScanError::TooFewShots { .. } => "Open the folder that holds the frames".into(),
        other => other.advice(),
    })]
    Scan(#[from] ScanError),
    /// Another shot has the same name.
    #[error("{name} is among the shots already")]
    #[advice = "Rename the file and its entry among the poses"]
    NameTaken {
        /// Name of both shots.
        name: String,
    },
}

impl FuseError {
    /// True if the user can help by choosing a file of poses.
    pub fn wants_poses(&self) -> bool {
        matches!(
            self,
            Self::Frames(
                ScanFramesError::NoPoses | ScanFramesError::Poses(FramePosesError::Missing { .. })
            )
        )
    }

    fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Frames(ScanFramesError::Cancelled) | Self::Scan(ScanError::Cancelled)
        )
    }
}

/// Counts the steps of a request.
pub struct Steps<'a> {
    watch: &'a dyn ProgressObserver,
    /// Called with the steps done and the total steps.
    report: &'a dyn Fn(usize, usize),
    done: Cell<usize>,
    total: Cell<usize>,
}

impl<'a> Steps<'a> {
    pub fn new(watch: &'a dyn ProgressObserver, report: &'a dyn Fn(usize, usize)) -> Self {
        Self {
            watch,
            report,
            done: Cell::new(0),
            total: Cell::new(0),
        }
    }

    fn expect(&self, num: usize) {
        self.total.set(self.total.get() + num);
    }

    fn step(&self) {
        self.done.set(self.done.get() + 1);
        let total = self.total.get().max(self.done.get());
        (self.report)(self.done.get(), total);
    }
}

/// The inspection of each shot begins with its segmentation, which counts as one step.
impl ProgressObserver for Steps<'_> {
    fn begins(&self, stage: Stage) {
        if stage == Stage::Segment {
            self.step();
        }
    }

    fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }
}

/// What follows the fusion; decides the number of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Then {
    /// Every shot is inspected.
    Inspect,
    /// A part is enrolled.
    Enrol,
}

/// Reads the shots and puts them together; `None` if cancelled.
pub fn fuse(
    request: &ScanRequest,
    then: Then,
    steps: &Steps<'_>,
) -> Result<Option<FusedShots>, FuseError> {
    let mut warnings = Vec::new();
    let fused = read(request, steps, &mut warnings).and_then(|choice| {
        let num = choice.num_taken();
        steps.expect(match then {
            Then::Inspect => 2 * num + 2,
            Then::Enrol => num + 2,
        });
        let shots = choice.set.shots.iter().enumerate();
        let taken = shots.filter(|(place, _)| !choice.dropped.contains(place));
        let taken: Vec<Shot> = taken.map(|(_, shot)| shot.clone()).collect();
        let params = ScanParams {
            segment: request.recipe.segment.clone(),
            ..ScanParams::default()
        };
        let scan = assembled(&taken, &params, steps)?;
        let rows = rows(&choice, &scan);
        let figure = ScanFigure::of(&choice, &scan);
        Ok(FusedShots {
            choice,
            scan,
            rows,
            figure,
            warnings,
        })
    });
    match fused {
        Err(error) if error.is_cancelled() => Ok(None),
        fused => fused.map(Some),
    }
}

fn read(
    request: &ScanRequest,
    steps: &Steps<'_>,
    warnings: &mut Vec<UserError>,
) -> Result<ShotChoice, FuseError> {
    let calibration = || {
        let path = request.calibration.as_deref();
        path.map_or(Ok(None), CellCalibration::load_if_there)
    };
    let mut frames_of = |paths: &[PathBuf], poses: Option<&Path>| {
        let frames = read_frames(paths, &mut |news| {
            match news {
                FrameNews::Total(num) => steps.expect(num),
                FrameNews::Read(name, odd) => {
                    steps.step();
                    warnings.extend(odd.iter().map(|warning| UserError {
                        what: format!("{name}: {warning}"),
                        advice: warning.advice(),
                    }));
                }
                FrameNews::Skipped(skipped) => {
                    steps.step();
                    let left_out = Message::new("left-out")
                        .with("name", &*skipped.name)
                        .with("why", &*skipped.error.to_string());
                    warnings.push(UserError {
                        what: described(&left_out),
                        advice: skipped.error.advice(),
                    });
                }
            }
            if steps.is_cancelled() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })?;
        let captured_at = first_captured_at(&frames);
        let shots = with_poses(paths, poses, frames, calibration);
        shots.map(|shots| (shots, captured_at))
    };
    match &request.order {
        ScanOrder::Known(choice) => Ok(choice.clone()),
        // The history keeps only shots that were not dropped.
        ScanOrder::Kept(kept) => Ok(ShotChoice {
            dropped: BTreeSet::new(),
            set: Arc::new(ShotSet {
                files: ScanFiles::of_past(&kept.origin),
                shots: read_shots(&kept.folder, &kept.frame)?,
                captured_at: SystemTime::UNIX_EPOCH,
            }),
        }),
        ScanOrder::Open(files) => {
            let (mut shots, mut captured_at) = frames_of(&files.frames, files.poses.as_deref())?;
            for (frame, poses) in &files.added {
                let (added, at) = frames_of(std::slice::from_ref(frame), Some(poses))?;
                shots.extend(added);
                captured_at = captured_at.min(at);
            }
            let is_dropped = |shot: &Shot| files.dropped.contains(&shot.name);
            let dropped = (0..shots.len()).filter(|place| is_dropped(&shots[*place]));
            Ok(ShotChoice {
                dropped: dropped.collect(),
                set: Arc::new(ShotSet {
                    files: files.clone(),
                    shots,
                    captured_at,
                }),
            })
        }
        ScanOrder::Add(choice, frame, given) => {
            add_frame(choice, frame, given.as_deref(), |paths, poses| {
                frames_of(paths, Some(poses))
            })
        }
    }
}

/// Adds a frame to the shots. `read` reads it with its pose from a file: the one given, else that of the scan or one beside
/// the frame.
fn add_frame(
    choice: &ShotChoice,
    frame: &Path,
    given: Option<&Path>,
    mut read: impl FnMut(&[PathBuf], &Path) -> Result<(Vec<Shot>, SystemTime), ScanFramesError>,
) -> Result<ShotChoice, FuseError> {
    let name = file_name(frame);
    let mut shots = choice.set.shots.clone();
    if shots.iter().any(|shot| shot.name == name) {
        return Err(FuseError::NameTaken { name });
    }
    let mut files = choice.set.files.clone();
    let paths = [frame.to_owned()];
    let candidates = if let Some(given) = given {
        vec![given.to_owned()]
    } else {
        // The file may have got a pose for this frame since the scan was read.
        let of_scan = files.poses.clone().or_else(|| poses_beside(&files.frames));
        of_scan.into_iter().chain(poses_beside(&paths)).collect()
    };
    let mut found = Err(ScanFramesError::NoPoses);
    for file in candidates {
        found = read(&paths, &file).map(|read| (read, file));
        if found.is_ok() {
            break;
        }
    }
    let ((added, at), file) = found?;
    shots.extend(added);
    let [frame] = paths;
    files.added.push((frame, file));
    Ok(ShotChoice {
        dropped: choice.dropped.clone(),
        set: Arc::new(ShotSet {
            files,
            shots,
            captured_at: choice.set.captured_at.min(at),
        }),
    })
}

/// Carries progress and cancellation between the threads of a fusion.
#[derive(Default)]
struct Relay {
    num_begun: AtomicUsize,
    is_cancelled: AtomicBool,
}

impl ScanObserver for Relay {
    fn begins(&self, _step: ScanStep) {
        self.num_begun.fetch_add(1, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

/// Interval for checking cancellation.
const LOOKS: Duration = Duration::from_millis(10);

/// Puts the shots together on a separate thread, because `steps` can only be used on this one.
fn assembled(shots: &[Shot], params: &ScanParams, steps: &Steps<'_>) -> Result<Scan, ScanError> {
    let relay = Relay::default();
    thread::scope(|scope| {
        let work = scope.spawn(|| assemble(shots, params, &relay));
        let mut num_told = 0;
        loop {
            let is_done = work.is_finished();
            relay
                .is_cancelled
                .store(steps.is_cancelled(), Ordering::Relaxed);
            while num_told < relay.num_begun.load(Ordering::Relaxed) {
                num_told += 1;
                steps.step();
            }
            if is_done {
                break;
            }
            thread::sleep(LOOKS);
        }
        work.join().unwrap_or_else(|panic| resume_unwind(panic))
    })
}

/// A shot in the list.
#[derive(Debug)]
pub struct ShotRow {
    /// Name of the frame.
    pub name: String,
    /// Depth picture with the part highlighted.
    pub picture: RgbImage,
    /// Whether and how it was used.
    pub fate: ShotFate,
    /// Number of the part's points that it sees.
    pub num_points: usize,
    /// Share of the part's points that it sees, 0..1.
    pub seen: f64,
    /// Share of the part's points that no other shot sees, 0..1.
    pub only: f64,
}

/// Whether and how a shot was used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShotFate {
    /// The shot is part of the result.
    Used {
        /// Correction of its pose by the refinement.
        moved: PoseDelta,
        /// Distance to what other shots see of the same surface, on the part if they overlap there; `None` if too few of its
        /// readings meet others.
        rms: Option<Metres>,
        /// False if segmentation found no part in it, or something that looks like background.
        has_part: bool,
    },
    /// The shot does not fit and was left out.
    Excluded(Excluded),
    /// The user dropped the shot.
    Dropped,
}

/// Makes one row per shot of the choice, in its order.
pub fn rows(choice: &ShotChoice, scan: &Scan) -> Vec<ShotRow> {
    let part: Vec<u64> = part_masks(scan).collect();
    let num_part = part.len().max(1) as f64;
    let mut scanned = scan.shots.iter().enumerate();
    let shots = choice.set.shots.iter().enumerate();
    let row = |(place, shot): (usize, &Shot)| {
        let known = if choice.dropped.contains(&place) {
            None
        } else {
            scanned.next()
        };
        let count = |is_counted: &dyn Fn(u64) -> bool| {
            part.iter().filter(|mask| is_counted(**mask)).count()
        };
        let bit = known.map_or(0, |(number, _)| 1_u64 << number);
        let num_points = count(&|mask| mask & bit != 0);
        ShotRow {
            name: shot.name.clone(),
            picture: picture(shot, known.map(|(_, shot)| shot)),
            fate: known.map_or(ShotFate::Dropped, |(_, shot)| fate(shot)),
            num_points,
            seen: num_points as f64 / num_part,
            only: count(&|mask| bit != 0 && mask == bit) as f64 / num_part,
        }
    };
    shots.map(row).collect()
}

fn fate(shot: &ScannedShot) -> ShotFate {
    match shot.excluded {
        Some(why) => ShotFate::Excluded(why),
        None => ShotFate::Used {
            moved: shot.moved,
            rms: shot.after_on_part.or(shot.after).map(|overlap| overlap.rms),
            has_part: shot.finds_part,
        },
    }
}

/// Returns for each point of the part a bit mask of the shots that see it.
fn part_masks(scan: &Scan) -> impl Iterator<Item = u64> {
    let points = scan.cloud.seen_by.iter().zip(&scan.cloud.is_part);
    points.filter(|(_, is)| **is).map(|(mask, _)| *mask)
}

/// Width and height of a shot's picture, pixels.
const PICTURE: [u32; 2] = [176, 132];

/// Draws the depths, nearer is brighter; highlights the part if the shot was segmented.
fn picture(shot: &Shot, scanned: Option<&ScannedShot>) -> RgbImage {
    let cloud = &shot.scene.cloud;
    let Some(grid) = cloud.grid else {
        return RgbImage::new(PICTURE[0], PICTURE[1]);
    };
    let depths = cloud.finite().map(|(_, point)| point.z);
    let (nearest, farthest) = depths.fold((f32::INFINITY, 0.0_f32), |(least, most), z| {
        (least.min(z), most.max(z))
    });
    let range = (farthest - nearest).max(1e-3);
    let colours = ViewColours::dark();
    let labels = scanned.map(|shot| shot.segmentation.labels.as_slice());
    RgbImage::from_fn(PICTURE[0], PICTURE[1], |u, v| {
        let column = u as usize * grid.width / PICTURE[0] as usize;
        let row = v as usize * grid.height / PICTURE[1] as usize;
        let place = row * grid.width + column;
        let point = cloud.points.get(place).filter(|point| is_finite(point));
        let Some(point) = point else {
            return Rgb([0; 3]);
        };
        let is_part = labels.and_then(|labels| labels.get(place)) == Some(&PointLabel::Part);
        let role = if is_part { Role::Part } else { Role::Rest };
        let nearness = 1.0 - (point.z - nearest) / range;
        let brightness = if is_part {
            0.7 + 0.3 * nearness
        } else {
            0.25 + 0.45 * nearness
        };
        let colour = colours.role(role).colour;
        let channel = |c: u8| (f32::from(c) * brightness).min(255.0) as u8;
        Rgb([colour.r(), colour.g(), colour.b()].map(channel))
    })
}

/// Data of the 3-D view of a scan, in the camera frame of the first used shot.
#[derive(Debug)]
pub struct ScanFigure {
    /// Transform from the robot's base to the frame of the view.
    pub camera_from_base: RigidTransform,
    /// All points, in the order of the scan's cloud.
    pub positions: Arc<[[f32; 3]]>,
    /// Part or background, per point.
    pub labels: Vec<PointLabel>,
    /// The camera of every shot that was not dropped.
    pub cameras: Vec<CameraFigure>,
    /// Per shot: the points of the part that only it sees, slightly in front of the surface.
    pub only: Vec<Option<PointSet>>,
    /// A band beyond the part's outline where no shot shows that the part ends.
    pub open_band: Option<PointSet>,
    /// Share of the outline where no shot shows that the part ends, 0..1.
    pub open_share: f64,
}

/// The camera of a shot.
#[derive(Debug)]
pub struct CameraFigure {
    /// Index of the shot.
    pub place: usize,
    /// Frustum of the camera.
    pub lines: LineSet,
    /// Centre of the camera.
    pub at: Vec3,
}

/// Offset of marked points from the surface, metres, so that they cover those beneath.
const BEFORE: f32 = 0.002;
/// Length of a drawn camera, metres.
const CAMERA: Metres = Metres(0.1);
/// Distances from the outline of the points of the band, metres.
const BAND: [f32; 5] = [0.006, 0.013, 0.02, 0.027, 0.034];
/// Offsets along the outline of the points of the band, metres, because the outline is thinned.
const ASIDE: [f32; 3] = [-0.007, 0.0, 0.007];

impl ScanFigure {
    pub fn of(choice: &ShotChoice, scan: &Scan) -> Self {
        let first = scan.used().next();
        let camera_from_base = first.map_or_else(RigidTransform::identity, |(_, shot)| {
            shot.base_from_camera.inverse()
        });
        let to_view = camera_from_base.cast::<f32>();
        let seen = |point: Point3<f32>| {
            let point = to_view * point;
            [point.x, point.y, point.z]
        };
        let cloud = &scan.cloud;
        let label = |is_part: &bool| {
            if *is_part {
                PointLabel::Part
            } else {
                PointLabel::Background(0)
            }
        };
        // Indices of the shots that were not dropped, in the scan's order.
        let places: Vec<usize> = (0..choice.set.shots.len())
            .filter(|place| !choice.dropped.contains(place))
            .collect();
        let mut only: Vec<Vec<[f32; 3]>> = vec![Vec::new(); choice.set.shots.len()];
        let normals = cloud.cloud.normals.as_deref().unwrap_or_default();
        for (index, mask) in cloud.seen_by.iter().enumerate() {
            if mask.is_power_of_two()
                && cloud.is_part[index]
                && let Some(place) = places.get(mask.trailing_zeros() as usize)
                && let Some(normal) = normals.get(index)
            {
                only[*place].push(seen(cloud.cloud.points[index] + normal * BEFORE));
            }
        }
        let outline = outline(scan);
        let open = outline.iter().filter(|point| point.is_open);
        let band = open.flat_map(|at| {
            ASIDE.map(|aside| BAND.map(|far| seen(at.point + at.outwards * far + at.along * aside)))
        });
        let band = band.flatten();
        let cameras = scan.shots.iter().zip(&places).filter_map(|(shot, place)| {
            let pose = camera_from_base * shot.base_from_camera;
            let intrinsics = shot.scene.intrinsics.as_ref()?;
            let at = pose.translation.vector.cast::<f32>();
            Some(CameraFigure {
                place: *place,
                lines: furniture::frustum(intrinsics, CAMERA).at(&pose),
                at: Vec3::new(at.x, at.y, at.z),
            })
        });
        Self {
            positions: cloud.cloud.points.iter().map(|p| seen(*p)).collect(),
            labels: cloud.is_part.iter().map(label).collect(),
            cameras: cameras.collect(),
            only: only
                .into_iter()
                .map(|points| marked(points, Role::SeenOnce))
                .collect(),
            open_share: open_share(&outline),
            open_band: marked(band.collect(), Role::Unseen),
            camera_from_base,
        }
    }
}

/// Makes points that keep the colour of their role whatever the view's colouring.
pub fn marked(points: Vec<[f32; 3]>, role: Role) -> Option<PointSet> {
    (!points.is_empty()).then(|| {
        let set = PointSet::new(points, role);
        set.coloured(Colouring::Segment).packed()
    })
}
