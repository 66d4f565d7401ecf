//! The functions of the fuzz targets. `cargo test` runs them on the seeds, so that they keep building.

use std::{
    fs::{self, File},
    path::Path,
    sync::OnceLock,
    time::SystemTime,
};

use nalgebra::Point3;
use partsight::{
    Grid, Image, Library, LibraryFolder, PointCloud, Recipe, RigidTransform, Unwatched, Verdict,
    capture::Replay,
    files::{DepthCamera, FileError, open_bytes},
    geometry::rigid::is_finite,
    library::SprayPath,
    orders::Orders,
    paint::{Coat, read_stripe},
    pipeline::{RecipeFile, Unrecognisable},
    rack::RackFile,
    robot::{
        Convention,
        arm::{Arm, GUN_RADIUS_M, Obstacles, PlacedArm},
        calibration::CellCalibration,
        frame_poses::read_frame_poses,
        line::LineCalibration,
        pairs::{PairConventions, read_arm_poses, read_counts, read_pairs},
    },
    run, scene_from_image,
};
use serve::{Protocol, Request};
use servo::simulated::StreamProtocol;

/// Runs the readers of clouds, meshes and depth images; the content decides which.
pub(crate) fn open(bytes: &[u8]) {
    let opened = open_bytes(Path::new("fuzzed"), bytes);
    if let Err(FileError::Fault { fault, .. }) = opened {
        panic!("{fault}");
    }
}

/// Runs the readers of all other text files: cameras, calibrations, poses, spray paths, recipes, coats, arms,
/// obstacles, racks, lines, orders, lists of recordings and sequences.
pub(crate) fn texts(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    // A recording's list begins with JSON; the other readers ignore the file name.
    let list = if bytes.starts_with(b"{\"partsight") {
        "recording.jsonl"
    } else {
        "depth.txt"
    };
    let path = folder.path().join(list);
    fs::write(&path, bytes).expect("written");
    // An old time keeps readers from waiting until the file has settled.
    let file = File::options().write(true).open(&path).expect("there");
    file.set_modified(SystemTime::UNIX_EPOCH).expect("set");
    let _ = DepthCamera::read(&path);
    let _ = CellCalibration::load(&path);
    let _ = read_pairs(&path, PairConventions::default());
    let _ = read_arm_poses(&path, None);
    let _ = SprayPath::read(&path);
    let _ = read_frame_poses(&path, &["a.png".into(), "b.png".into()]);
    let _ = RecipeFile::<Recipe>::read(&path);
    let _ = RecipeFile::<Coat>::read(&path);
    let _ = read_stripe(&path);
    let _ = Arm::read(&path);
    let _ = Obstacles::read(&path);
    let _ = RackFile::read(&path);
    let _ = LineCalibration::load(&path);
    let _ = read_counts(&path);
    let _ = Orders::read(&path);
    let spec = format!("recording:{}", folder.path().display());
    if let Ok(partsight::SourceSpec::Recording(spec)) = spec.parse() {
        let _ = Replay::open(&spec);
    }
}

/// Reads requests of robots one after the other, in every protocol and convention, as the server does.
pub(crate) fn requests(bytes: &[u8]) {
    for (protocol, convention) in Protocol::ALL
        .into_iter()
        .flat_map(|protocol| Convention::ALL.map(|convention| (protocol, convention)))
    {
        let mut rest = bytes;
        loop {
            let parsed = protocol.parse(rest, convention);
            match parsed.request {
                Some(Ok(request)) => {
                    assert!(parsed.used > 0, "{request:?}");
                    if let Request::Servo(servo) = request {
                        let shift = servo.robot_from_flange.translation.vector.norm();
                        assert!((0.02..=20.0).contains(&shift), "{servo:?}");
                    }
                }
                Some(Err(_)) => break,
                None if parsed.used == 0 => break,
                None => {}
            }
            rest = &rest[parsed.used..];
        }
    }
}

static ARM: OnceLock<PlacedArm> = OnceLock::new();

fn arm() -> PlacedArm {
    PlacedArm {
        arm: Arm::named("irb4600").expect("built in"),
        robot_from_base: RigidTransform::identity(),
        flange_from_nozzle: RigidTransform::translation(0.0, 0.0, 0.2),
        gun_radius: GUN_RADIUS_M,
        obstacles: Obstacles::default(),
    }
}

/// Takes what robots report that take a stream of poses, in every protocol, in one piece and in many, and answers each report.
pub(crate) fn streams(bytes: &[u8]) {
    let arm = ARM.get_or_init(arm);
    for (protocol, size) in StreamProtocol::ALL
        .into_iter()
        .flat_map(|protocol| [bytes.len().max(1), 13].map(|size| (protocol, size)))
    {
        let mut stream = protocol.stream(arm);
        for piece in bytes.chunks(size) {
            let _ = stream.requests();
            let report = match stream.receive(piece) {
                Ok(Some(report)) => report,
                // The connection is closed; packets are independent of each other.
                Err(_) if protocol == StreamProtocol::Rtde => break,
                Ok(None) | Err(_) => continue,
            };
            assert!(is_finite(&report.robot_from_flange), "{report:?}");
            let mut angles = report.joints.iter().flatten();
            assert!(angles.all(|angle| angle.is_finite()), "{report:?}");
            assert!(!stream.answer(&report.robot_from_flange, false).is_empty());
        }
    }
}

static LIBRARY: OnceLock<Library> = OnceLock::new();

/// The shipped parts; needs the repository as the working folder.
fn library() -> Library {
    let folder = LibraryFolder::open("reference_parts".as_ref()).expect("the shipped parts");
    folder.load(&Default::default()).expect("loaded").library
}

/// Runs a whole inspection of a small cloud.
pub(crate) fn inspect(bytes: &[u8]) {
    let Some((&width, coordinates)) = bytes.split_first() else {
        return;
    };
    let metres = |cell: &[u8]| f32::from(i16::from_le_bytes([cell[0], cell[1]])) / 10_000.0;
    let mut points: Vec<Point3<f32>> = coordinates
        .chunks_exact(6)
        .map(|row| Point3::new(metres(row), metres(&row[2..]), metres(&row[4..])))
        .collect();
    let width = usize::from(width);
    let grid = (width > 1).then(|| Grid {
        width,
        height: points.len() / width,
    });
    if let Some(grid) = grid {
        points.truncate(grid.num_cells());
    }
    let cloud = PointCloud {
        points,
        grid: grid.filter(|grid| grid.height > 1),
        ..PointCloud::default()
    };
    let scene = scene_from_image(Image::Cloud(cloud));
    let library = LIBRARY.get_or_init(library);
    let inspection = run(&scene, library, &Recipe::default(), &Unwatched).expect("not cancelled");
    if let Verdict::NoPart(Unrecognisable::Fault(fault)) = inspection.verdict {
        panic!("{fault}");
    }
}
