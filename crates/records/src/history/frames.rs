//! Kept frames, next to the database and in a folder of cases: each as the camera delivered it, so that the same recipe
//! reproduces the result.
//!
//! A depth image is stored as a 16-bit PNG with its camera in the folder's `intrinsics.json`, as in recordings;
//! anything else (bare points, depth averaged over frames) as a PCD. The database row holds format, size, checksum, and
//! what the image alone does not contain. The empty cell is stored once for all frames inspected with it.

use std::{
    borrow::Cow,
    fs, io,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicU32, Ordering},
    },
};

use jiff::Timestamp;
use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::shots::ShotRecord;
use capture::Image;
use files::{
    DepthCamera, FileContent, FileError, StoredOrientation, advice_on, crc32,
    depth_png::{FOLDER_CAMERA, write_camera, write_depths},
    disk, open_bytes, read_bytes, read_depths, replace_file, words_of, write_pcd,
};
use geometry::{
    cloud::{Grid, PointCloud},
    depth_frame::{DepthFrame, Intrinsics},
    error::Advice,
};
use stages::scene::{EmptyCell, PictureEdge, SceneCloud, full_scene, reduced_scene};
use texts::{Described, Message};

/// Database record of a kept frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameRecord {
    /// Name of the file in the folder of frames.
    pub file: String,
    /// Size of the file.
    pub bytes: u64,
    /// CRC-32 (IEEE 802.3) of the file.
    pub crc32: u32,
    /// Meaning of the picture's edge.
    pub edge: PictureEdge,
    /// Intrinsics, if a pinhole camera explains the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<Intrinsics>,
    /// For a depth image: metres per unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub metres_per_unit: Option<f64>,
    /// For a reduced image: number of readings along the side of a block.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub block_side: Option<usize>,
    /// True if the frame does not come from a camera.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_simulated: bool,
    /// True if it is kept only while it is one of the newest accepted ones.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_only_recent: bool,
    /// File of the empty cell, if one was known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub empty_cell: Option<String>,
    /// CRC-32 of that file; `None` for frames written by earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub empty_cell_crc32: Option<u32>,
    /// For a scan: all its shots, including this frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shots: Vec<ShotRecord>,
}

/// Why the frame of an inspection is not kept although the rule keeps it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrameLoss {
    /// The disk was full.
    DiskFull,
    /// The frame, or the whole history for a while, could not be written.
    NotWritable,
    /// The disk was too slow.
    SlowDisk,
}

impl Described for FrameLoss {
    fn message(&self) -> Message {
        Message::new(match self {
            Self::DiskFull => "frame-loss-disk-full",
            Self::NotWritable => "frame-loss-not-writable",
            Self::SlowDisk => "frame-loss-slow-disk",
        })
    }
}

texts::display!(FrameLoss);

/// What the database has in place of the record of a frame that was lost.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct LostFrame {
    pub(super) lost: FrameLoss,
}

/// Depth units of common cameras, metres.
const UNITS: [f64; 5] = [0.001, 0.0002, 0.0001, 0.00025, 0.000_125];

/// Counts this program's frames, which keeps the names of simultaneous ones distinct.
static COUNT: AtomicU32 = AtomicU32::new(0);

/// Why a frame cannot be written or read.
#[derive(Debug, thiserror::Error, Advice)]
pub enum FrameError {
    /// A file cannot be written or read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The folder cannot be written to.
    #[error("{}: the frame cannot be written: {}", path.display(), words_of(source))]
    #[advice(advice_on(source))]
    Unwritable {
        /// The folder or file.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// The kept frame is damaged.
    #[error("{}: the kept frame is damaged: {what}", path.display())]
    #[advice = "Inspect the part again: this frame cannot be used"]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
}

impl FrameError {
    pub(super) fn io(path: &Path, source: io::Error) -> Self {
        Self::Unwritable {
            path: path.to_owned(),
            source,
        }
    }

    /// Returns what the row says of a frame that could not be written.
    pub(super) fn loss(&self) -> FrameLoss {
        let (Self::File(FileError::Write { source, .. }) | Self::Unwritable { source, .. }) = self
        else {
            return FrameLoss::NotWritable;
        };
        match source.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => FrameLoss::DiskFull,
            _ => FrameLoss::NotWritable,
        }
    }
}

impl From<FrameError> for io::Error {
    /// Returns the underlying I/O error if there is one.
    fn from(error: FrameError) -> Self {
        match error {
            FrameError::File(FileError::Write { source, .. })
            | FrameError::Unwritable { source, .. } => source,
            error => Self::other(error),
        }
    }
}

/// Writes a scene into the folder of frames, all of it or nothing; returns `None` for a scene without a single reading.
pub(super) fn write(
    folder: &Path,
    scene: &SceneCloud,
    at: Timestamp,
) -> Result<Option<FrameRecord>, FrameError> {
    if scene.cloud.finite().next().is_none() {
        return Ok(None);
    }
    disk::create_dir_all(folder).map_err(|error| FrameError::io(folder, error))?;
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let stem = format!(
        "{}-{}-{number}",
        at.strftime("%Y%m%dT%H%M%S%3f"),
        std::process::id()
    );
    let written = write_as(folder, &stem, scene);
    if written.is_err() {
        // Without its empty cell, the frame takes room for nothing.
        for ending in ["png", "pcd", "json"] {
            let _ = remove(&folder.join(format!("{stem}.{ending}")));
        }
    }
    written.map(Some)
}

/// Writes a scene into a folder under this stem; the extension depends on the content. An error may leave some of it.
pub fn write_as(folder: &Path, stem: &str, scene: &SceneCloud) -> Result<FrameRecord, FrameError> {
    let (depth, cloud) = content_of(scene);
    let ending = if depth.is_some() { "png" } else { "pcd" };
    let file = format!("{stem}.{ending}");
    let path = folder.join(&file);
    let mut content = Vec::new();
    let packed = match &depth {
        Some(frame) => {
            write_its_camera(&path, &DepthCamera::from_frame(frame))?;
            write_depths(&mut content, frame)
        }
        None => write_pcd(&mut content, cloud),
    };
    packed.map_err(|error| FrameError::io(&path, error))?;
    replace_file(&path, &content).map_err(|source| FileError::writing(&path, source))?;
    let empty_cell = scene.empty_cell.as_deref();
    let empty_cell = empty_cell
        .map(|cell| write_cell(folder, cell))
        .transpose()?;
    let (empty_cell, empty_cell_crc32) = empty_cell.unzip();
    Ok(FrameRecord {
        file,
        bytes: content.len() as u64,
        crc32: crc32(&content),
        edge: scene.edge,
        camera: depth
            .as_ref()
            .map_or(scene.intrinsics, |frame| Some(frame.intrinsics)),
        metres_per_unit: depth.map(|frame| frame.metres_per_unit),
        block_side: scene.reduced.as_ref().map(|reduced| reduced.block_side),
        is_simulated: scene.cloud.is_simulated,
        is_only_recent: false,
        empty_cell,
        empty_cell_crc32,
        shots: Vec::new(),
    })
}

/// Writes the camera for people and other programs; the row holds it too. The first camera becomes that of the folder,
/// a different one gets a file next to its frame.
fn write_its_camera(path: &Path, camera: &DepthCamera) -> Result<(), FrameError> {
    let shared = path.with_file_name(FOLDER_CAMERA);
    match DepthCamera::read(&shared) {
        Ok(known) if known == *camera => {}
        Ok(_) => write_camera(&path.with_extension("json"), camera)?,
        Err(_) => write_camera(&shared, camera)?,
    }
    Ok(())
}

/// Returns the camera's original data: a depth image, or otherwise a cloud.
fn content_of(scene: &SceneCloud) -> (Option<Cow<'_, DepthFrame>>, &PointCloud) {
    match scene.reduced.as_ref().map(|reduced| &*reduced.original) {
        Some(Image::Depth(frame)) => (Some(Cow::Borrowed(frame)), &scene.cloud),
        Some(Image::Cloud(cloud)) => (None, cloud),
        None => (as_depth(scene).map(Cow::Owned), &scene.cloud),
    }
}

/// Returns the depth image that a scene was made from, if it reproduces exactly the same points.
fn as_depth(scene: &SceneCloud) -> Option<DepthFrame> {
    let intrinsics = scene.intrinsics?;
    let Grid { width, height } = scene.cloud.grid?;
    let is_bare = scene.cloud.colours.is_none()
        && scene.cloud.normals.is_none()
        && scene.cloud.labels.is_none();
    if !is_bare || scene.edge != PictureEdge::View {
        return None;
    }
    if (intrinsics.width, intrinsics.height) != (width, height) {
        return None;
    }
    let points = &scene.cloud.points;
    // A cloud may have been made of a depth image elsewhere.
    let mut units = scene.metres_per_unit.into_iter().chain(UNITS);
    units.find_map(|metres_per_unit| {
        let depths = points.iter().map(|p| units_of(p, metres_per_unit));
        let frame = DepthFrame {
            intrinsics,
            metres_per_unit,
            depth: depths.collect::<Option<_>>()?,
            is_simulated: scene.cloud.is_simulated,
        };
        let again = full_scene(&frame).cloud.points;
        let same = points.iter().zip(&again).all(|(a, b)| is_same(a, b));
        same.then_some(frame)
    })
}

/// Returns a point's depth in whole units, 0 without a reading; `None` if it is not a whole number of units.
fn units_of(point: &Point3<f32>, metres_per_unit: f64) -> Option<u16> {
    if point.z.is_nan() {
        return Some(0);
    }
    let units = (f64::from(point.z) / metres_per_unit).round();
    let is_kept = (1.0..=f64::from(u16::MAX)).contains(&units)
        && (units as f32 * metres_per_unit as f32).to_bits() == point.z.to_bits();
    is_kept.then_some(units as u16)
}

fn is_same(a: &Point3<f32>, b: &Point3<f32>) -> bool {
    let bits = |p: &Point3<f32>| [p.x, p.y, p.z].map(f32::to_bits);
    bits(a) == bits(b) || [a, b].iter().all(|p| p.iter().all(|x| x.is_nan()))
}

/// Writes the empty cell unless it is there already. Returns its file name and checksum.
fn write_cell(folder: &Path, cell: &EmptyCell) -> Result<(String, u32), FrameError> {
    let mut content = Vec::new();
    write_pcd(&mut content, &cell.to_cloud()).map_err(|error| FrameError::io(folder, error))?;
    let checksum = crc32(&content);
    let file = format!("empty-cell-{checksum:08x}.pcd");
    let path = folder.join(&file);
    // The name contains the checksum, but the file may have been damaged since: all frames to come depend on it.
    if read_bytes(&path).ok().as_ref() != Some(&content) {
        replace_file(&path, &content).map_err(|source| FileError::writing(&path, source))?;
    }
    Ok((file, checksum))
}

/// Reads the scene of a kept frame, as it was inspected.
pub fn read(folder: &Path, frame: &FrameRecord) -> Result<SceneCloud, FrameError> {
    read_by(folder, frame, &read_bytes)
}

/// As [`read`], with each file's content from `content`. Errors name the files by their paths in `folder`.
pub fn read_by(
    folder: &Path,
    frame: &FrameRecord,
    content: &dyn Fn(&Path) -> Result<Vec<u8>, FileError>,
) -> Result<SceneCloud, FrameError> {
    let path = folder.join(&frame.file);
    let damaged = |what: &str| FrameError::Damaged {
        path: path.clone(),
        what: what.to_owned(),
    };
    let bytes = content(&path)?;
    if crc32(&bytes) != frame.crc32 {
        return Err(damaged("its checksum does not match"));
    }
    let original = match (frame.metres_per_unit, frame.camera) {
        (Some(metres_per_unit), Some(intrinsics)) => {
            let (size, depth) = read_depths(&path, &bytes)?;
            let camera = DepthCamera {
                intrinsics,
                metres_per_unit,
                is_simulated: frame.is_simulated,
                stored: StoredOrientation::default(),
            };
            let camera = camera.checked().map_err(|what| damaged(&what))?;
            Image::Depth(camera.frame(size, depth).map_err(|what| damaged(&what))?)
        }
        (None, _) => Image::Cloud(cloud_of(&path, &bytes)?),
        (Some(_), None) => return Err(damaged("its camera is missing")),
    };
    let mut scene = match (frame.block_side, original) {
        (Some(side), original) => reduced_scene(Arc::new(original), side.max(1)),
        (None, Image::Depth(depth)) => full_scene(&depth),
        (None, Image::Cloud(cloud)) => SceneCloud::new(cloud, frame.camera),
    };
    scene.edge = frame.edge;
    if let Some(file) = &frame.empty_cell {
        let path = folder.join(file);
        let cell = cell_of(&path, &content(&path)?, frame.empty_cell_crc32)?;
        scene.empty_cell = Some(Arc::new(cell));
    }
    Ok(scene)
}

fn cloud_of(path: &Path, bytes: &[u8]) -> Result<PointCloud, FrameError> {
    match open_bytes(path, bytes)? {
        FileContent::Cloud(cloud) => Ok(cloud),
        _ => Err(FrameError::Damaged {
            path: path.to_owned(),
            what: "it holds no cloud".into(),
        }),
    }
}

fn cell_of(path: &Path, bytes: &[u8], checksum: Option<u32>) -> Result<EmptyCell, FrameError> {
    let damaged = |what: &str| FrameError::Damaged {
        path: path.to_owned(),
        what: what.to_owned(),
    };
    if checksum.is_some_and(|checksum| checksum != crc32(bytes)) {
        return Err(damaged("its checksum does not match"));
    }
    let cell = EmptyCell::of_cloud(&cloud_of(path, bytes)?);
    cell.ok_or_else(|| damaged("the empty cell has no rows and columns"))
}

/// Removes the files of the folder that no row refers to, and returns their number. Call it only while nobody else
/// writes: a frame is written before its row.
pub(super) fn remove_strays(folder: &Path, is_known: &dyn Fn(&str) -> bool) -> io::Result<usize> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(0),
        entries => entries?,
    };
    let mut num_removed = 0;
    for entry in entries {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let owner = name.strip_suffix(".json").map(|stem| format!("{stem}.png"));
        let stays = name == FOLDER_CAMERA || is_known(owner.as_deref().unwrap_or(&name));
        if !stays && is_ours(&name) {
            remove(&entry.path())?;
            num_removed += 1;
        }
    }
    Ok(num_removed)
}

/// Returns whether the name is that of a frame or of a temporary file; any other file is left alone.
fn is_ours(name: &str) -> bool {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    let is_frame = stem.split('-').count() == 3
        && stem.starts_with(|first: char| first.is_ascii_digit())
        && matches!(ending, "png" | "pcd" | "json");
    is_frame
        || (stem.starts_with("empty-cell-") && ending == "pcd")
        || (name.starts_with(".partsight-") && ending == "part")
}

/// Removes a file; one that is gone already is no error.
pub(super) fn remove(path: &Path) -> io::Result<()> {
    match disk::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::distortion::Distortion;
    use simulate::{CellSetup, PartKind, Side};
    use stages::{
        fixtures::scene_of,
        scene::{scene_from_cloud, scene_from_frame},
    };

    fn captured() -> SceneCloud {
        let setup = CellSetup::with_part(PartKind::Grille, Side::Left, 0, 3);
        scene_of(&setup)
    }

    fn ending(record: &FrameRecord) -> Option<&str> {
        Path::new(&record.file).extension()?.to_str()
    }

    fn assert_same(a: &SceneCloud, b: &SceneCloud) {
        let both = a.cloud.points.iter().zip(&b.cloud.points);
        assert!(both.clone().count() == a.cloud.points.len());
        assert!(both.into_iter().all(|(a, b)| is_same(a, b)));
        assert_eq!(a.cloud.grid, b.cloud.grid);
        assert_eq!((a.intrinsics, a.edge), (b.intrinsics, b.edge));
        assert!(a.empty_cell == b.empty_cell, "another empty cell");
    }

    #[test]
    fn a_depth_image_comes_back_to_the_bit_and_other_programs_can_open_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut scene = captured();
        scene.empty_cell = Some(Arc::new(EmptyCell::from_scene(&scene).expect("a picture")));
        let at = Timestamp::UNIX_EPOCH;
        let record = write(folder.path(), &scene, at).expect("written");
        let record = record.expect("kept");
        assert_eq!(ending(&record), Some("png"));
        assert_same(&scene, &read(folder.path(), &record).expect("read"));
        let opened = files::open(&folder.path().join(&record.file)).expect("opened");
        assert!(matches!(opened, FileContent::Depth(_)));
    }

    #[test]
    fn a_damaged_empty_cell_is_written_again_with_the_next_frame() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut scene = captured();
        scene.empty_cell = Some(Arc::new(EmptyCell::from_scene(&scene).expect("a picture")));
        let write = || write(folder.path(), &scene, Timestamp::UNIX_EPOCH).expect("written");
        let first = write().expect("kept");
        let cell = folder
            .path()
            .join(first.empty_cell.as_deref().expect("kept"));
        let num_bytes = fs::metadata(&cell).expect("there").len();
        // The power failed before its content was on the disk.
        fs::write(&cell, vec![0; num_bytes as usize]).expect("written");
        assert!(read(folder.path(), &first).is_err());
        let second = write().expect("kept");
        for record in [first, second] {
            assert_same(&scene, &read(folder.path(), &record).expect("read"));
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_in_place_of_a_file_beside_the_frames_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let pipe = folder.path().join(FOLDER_CAMERA);
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.is_ok_and(|made| made.success()), "mkfifo");
        let record = write(folder.path(), &captured(), Timestamp::UNIX_EPOCH).expect("written");
        assert!(pipe.is_file());
        let record = record.expect("kept");
        assert_same(&captured(), &read(folder.path(), &record).expect("read"));
    }

    #[test]
    fn a_depth_image_of_any_unit_stays_one_and_names_its_unit() {
        let folder = tempfile::tempdir().expect("a folder");
        let setup = CellSetup::with_part(PartKind::Grille, Side::Left, 0, 3);
        let mut frame = simulate::frame(&setup).frame;
        frame.metres_per_unit = 0.001_010_5;
        let scene = scene_from_frame(&frame);
        let record = write(folder.path(), &scene, Timestamp::UNIX_EPOCH).expect("written");
        let record = record.expect("kept");
        assert_eq!(record.metres_per_unit, Some(frame.metres_per_unit));
        assert_same(&scene, &read(folder.path(), &record).expect("read"));
        let opened = files::open(&folder.path().join(&record.file)).expect("opened");
        assert_eq!(opened, FileContent::Depth(frame));
    }

    #[test]
    fn what_is_no_depth_image_is_kept_as_a_cloud_to_the_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut averaged = captured();
        for point in &mut averaged.cloud.points {
            *point *= 1.000_1;
        }
        let bare = captured()
            .cloud
            .finite()
            .map(|(_, p)| *p)
            .collect::<Vec<_>>();
        let bare = scene_from_cloud(PointCloud::from_points(bare));
        for scene in [averaged, bare] {
            let record = write(folder.path(), &scene, Timestamp::UNIX_EPOCH).expect("written");
            let record = record.expect("kept");
            assert_eq!(ending(&record), Some("pcd"));
            assert_same(&scene, &read(folder.path(), &record).expect("read"));
        }
    }

    #[test]
    fn of_a_reduced_picture_every_reading_is_kept_and_the_same_scene_comes_back() {
        let width = 1280;
        let depth = (0..width * 960).map(|i| (6000 + i % width * 2 + i / width * 3) as u16);
        let frame = DepthFrame {
            intrinsics: Intrinsics {
                width,
                height: 960,
                fx: 1050.0,
                fy: 1050.0,
                cx: 639.5,
                cy: 479.5,
                distortion: Distortion {
                    k1: -0.1,
                    ..Distortion::NONE
                },
            },
            metres_per_unit: 0.0002,
            depth: depth.collect(),
            is_simulated: false,
        };
        let folder = tempfile::tempdir().expect("a folder");
        let scene = scene_from_frame(&frame);
        assert_eq!(scene.cloud.points.len(), 640 * 480);
        let record = write(folder.path(), &scene, Timestamp::UNIX_EPOCH).expect("written");
        let record = record.expect("kept");
        assert_same(&scene, &read(folder.path(), &record).expect("read"));
        let opened = files::open(&folder.path().join(&record.file)).expect("opened");
        assert_eq!(opened, FileContent::Depth(frame.clone()));
        // An organised cloud.
        let scene = scene_from_cloud(full_scene(&frame).cloud);
        assert_eq!(scene.cloud.points.len(), 640 * 480);
        let record = write(folder.path(), &scene, Timestamp::UNIX_EPOCH).expect("written");
        let record = record.expect("kept");
        assert_eq!(ending(&record), Some("pcd"));
        assert_same(&scene, &read(folder.path(), &record).expect("read"));
        let opened = files::open(&folder.path().join(&record.file)).expect("opened");
        assert!(matches!(opened, FileContent::Cloud(cloud) if cloud.points.len() == width * 960));
    }

    #[test]
    fn a_frame_that_was_changed_is_refused_in_words() {
        let folder = tempfile::tempdir().expect("a folder");
        let record = write(folder.path(), &captured(), Timestamp::UNIX_EPOCH).expect("written");
        let record = record.expect("kept");
        let path = folder.path().join(&record.file);
        let mut bytes = fs::read(&path).expect("there");
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(&path, bytes).expect("written");
        let refused = read(folder.path(), &record).expect_err("refused");
        assert!(refused.to_string().contains("checksum"), "{refused}");
        fs::remove_file(&path).expect("removed");
        read(folder.path(), &record).expect_err("gone");
    }

    #[test]
    fn nothing_is_kept_of_a_covered_camera() {
        let folder = tempfile::tempdir().expect("a folder");
        let scene = SceneCloud::default();
        let kept = write(folder.path(), &scene, Timestamp::UNIX_EPOCH).expect("nothing to do");
        assert_eq!(kept, None);
    }

    #[test]
    fn strays_go_and_strangers_stay() {
        let folder = tempfile::tempdir().expect("a folder");
        let record = write(folder.path(), &captured(), Timestamp::UNIX_EPOCH).expect("written");
        let kept = record.expect("kept").file;
        for stray in [
            "20260101T000000000-7-1.png",
            ".partsight-xyz.part",
            "note.txt",
        ] {
            fs::write(folder.path().join(stray), "x").expect("written");
        }
        let num = remove_strays(folder.path(), &|name| name == kept).expect("looked");
        assert_eq!(num, 2);
        assert!(folder.path().join("note.txt").exists() && folder.path().join(kept).exists());
        assert!(folder.path().join(FOLDER_CAMERA).exists());
    }
}
