//! GenICam cameras, played on the loopback network by the fake camera of aravis.
//!
//! They stand here although they run no command: aravis waits for most of a minute, in which the other tests compute.
//! Without it (`apt-get install aravis-tools libaravis-0.8-0`) the tests report that they are skipped; with
//! `PARTSIGHT_REQUIRE_GENICAM=1` they fail.

use std::{
    fs, io,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use capture::{
    ARAVIS, BackpressurePolicy, CameraError, CameraErrorKind, CaptureError, Captured, DepthSource,
    Feed, FeedItem, FeedState, GenicamSpec, Image, NextCapture, Recovery, SourceSpec,
    fixtures::{camera_error, listed_by},
    open,
};
use geometry::{cloud::Grid, depth_frame::DepthFrame, error::Advice as _, fixtures::skipped};

/// Timeout longer than any step of a test, so that it ends only one that hangs.
const PATIENCE: Duration = Duration::from_mins(1);
/// The description of a 3-D camera, with placeholders for its `Scan3dOutputMode` and its `ReverseX`.
const DEPTH_CAMERA: &str = include_str!("camera.xml");
const MODE: &str = "THE_MODE";
const REVERSE: &str = "THE_REVERSE";
const ID: &str = "Aravis-Fake-PS01";

/// A camera that runs until it is dropped.
struct FakeCamera(Child);

impl FakeCamera {
    /// Starts a camera; `None`, with a message, if the program or aravis is missing.
    fn start(description: Option<&Path>) -> Option<Self> {
        let mut command = Command::new("arv-fake-gv-camera-0.8");
        command.args(["-i", "127.0.0.1", "-s", "PS01"]);
        if let Some(path) = description {
            command.arg("-g").arg(path);
        }
        // It writes a message for every frame whose pixel format it cannot paint.
        let started = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn();
        let camera = match started {
            Ok(child) => Self(child),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                skipped(
                    "PARTSIGHT_REQUIRE_GENICAM",
                    "arv-fake-gv-camera-0.8 is not installed (apt-get install aravis-tools)",
                );
                return None;
            }
            Err(error) => panic!("{error}"),
        };
        let until = Instant::now() + PATIENCE;
        while Instant::now() < until {
            for listed in listed_by(&ARAVIS, |spec| matches!(spec, SourceSpec::Genicam(_))) {
                if listed.title == format!("GenICam {ID}") {
                    return Some(camera);
                }
                let kind = listed.error.map(|error| error.kind);
                if kind == Some(CameraErrorKind::LibraryMissing { path: None }) {
                    skipped(
                        "PARTSIGHT_REQUIRE_GENICAM",
                        "aravis is not installed (apt-get install libaravis-0.8-0)",
                    );
                    return None;
                }
            }
        }
        panic!("it does not answer");
    }
}

impl Drop for FakeCamera {
    fn drop(&mut self) {
        // Killing it acts like a pulled cable; it may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn spec(text: &str) -> SourceSpec {
    text.parse().expect(text)
}

/// A source that takes the fake camera's grey values for depth in steps of 0.1 mm.
fn grey_as_depth(folder: &Path) -> SourceSpec {
    let path = folder.join("camera.json");
    let camera = r#"{"width":512,"height":512,"fx":500,"fy":500,"cx":255.5,"cy":255.5,"metres_per_unit":0.0001}"#;
    fs::write(&path, camera).expect("written");
    spec(&format!(
        "genicam,format=Mono16,camera={}:{ID}",
        path.display()
    ))
}

/// Writes the description of a 3-D camera.
fn describe(path: &Path, mode: &str, reverse: &str) {
    let text = DEPTH_CAMERA.replace(MODE, mode).replace(REVERSE, reverse);
    fs::write(path, text).expect("written");
}

fn open_error(text: &str) -> CameraError {
    camera_error(open(&spec(text)).err().expect("does not open"))
}

fn next_capture(source: &mut dyn DepthSource) -> Captured {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        match source.next(Duration::from_millis(50)).expect("no problem") {
            NextCapture::Captured(captured) => return captured,
            NextCapture::NotYet => {}
            // A busy machine loses packets.
            NextCapture::Skipped(skipped) => assert!(!skipped.name.is_empty()),
            NextCapture::End => panic!("it ended"),
        }
    }
    panic!("nothing came");
}

fn depth_of(captured: Captured) -> DepthFrame {
    match captured.image {
        Image::Depth(frame) => frame,
        Image::Cloud(_) => panic!("a cloud"),
    }
}

/// Checks that the frame is the fake camera's pattern: constant along every diagonal, and 256 more from one diagonal
/// to the next until it wraps.
fn check_pattern(frame: &DepthFrame) {
    let width = frame.intrinsics.width;
    assert_eq!(frame.depth.len(), 512 * 512);
    let at = |row: usize, column: usize| u32::from(frame.depth[row * width + column]);
    for row in 1..512 {
        for column in 0..511 {
            assert_eq!(at(row, column), at(row - 1, column + 1), "{row} {column}");
        }
    }
    let num_steps = (1..512).filter(|&column| at(0, column) == at(0, column - 1) + 256);
    assert!(num_steps.count() >= 508, "it begins again at most thrice");
}

/// One after the other in one test, because all cameras have the same address and every step waits.
#[test]
fn a_camera_is_read_refused_lost_and_found_again() {
    let Some(camera) = FakeCamera::start(None) else {
        return;
    };
    every_pixel_of_a_depth_image_arrives();
    grey_values_are_no_depth_and_another_camera_is_not_taken();
    a_camera_that_is_gone_is_lost_and_found_again(camera);
    a_3d_camera_says_itself_what_its_values_stand_for();
}

fn every_pixel_of_a_depth_image_arrives() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = grey_as_depth(folder.path());
    let mut source = open(&spec).expect("opens");
    assert_eq!(source.title(), format!("GenICam {ID}"));
    let first = next_capture(source.as_mut());
    assert_eq!(first.warnings, []);
    assert!(!first.is_simulated);
    let second = next_capture(source.as_mut());
    assert!(second.number > first.number && second.taken_at > first.taken_at);
    let [first, second] = [first, second].map(depth_of);
    assert!((first.metres_per_unit - 0.0001).abs() < 1e-12);
    check_pattern(&first);
    check_pattern(&second);
    assert_ne!(first.depth, second.depth, "the pattern moves");

    let error = camera_error(open(&spec).err().expect("opened twice"));
    assert_eq!(error.kind, CameraErrorKind::Busy, "{error}");
    check_pattern(&depth_of(next_capture(source.as_mut())));
    drop(source);
    let mut again = open(&spec).expect("opens again");
    check_pattern(&depth_of(next_capture(again.as_mut())));
}

fn grey_values_are_no_depth_and_another_camera_is_not_taken() {
    for (source, words, advice) in [
        (
            "genicam",
            ["offers no depth, only ", "Mono8"],
            "format=Mono16",
        ),
        (
            "genicam,format=Coord3D_C16:127.0.0.1",
            ["does not offer Coord3D_C16, only ", "Mono8"],
            "format option out",
        ),
        (
            "genicam,format=Mono16",
            ["does not report its Scan3dCoordinateScale", "depth images"],
            "camera=FILE",
        ),
    ] {
        let error = open_error(source);
        assert!(
            matches!(error.kind, CameraErrorKind::Unsuitable { .. }),
            "{error}"
        );
        let text = error.to_string();
        assert!(words.iter().all(|words| text.contains(words)), "{text}");
        assert!(error.advice().contains(advice), "{}", error.advice());
    }
    let error = open_error("genicam:Other-3D-1");
    assert!(error.to_string().contains(&format!("only {ID}")), "{error}");
    assert_eq!(error.recovery(), Recovery::Reopen);
}

fn a_3d_camera_says_itself_what_its_values_stand_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("camera.xml");
    describe(&path, "1", "0");
    let camera = FakeCamera::start(Some(&path)).expect("one was there before");
    let mut source = open(&spec("genicam")).expect("opens");
    let captured = next_capture(source.as_mut());
    assert_eq!(captured.warnings, []);
    let frame = depth_of(captured);
    let lens = frame.intrinsics;
    assert_eq!((lens.width, lens.height), (512, 512));
    let reported = [lens.fx, lens.fy, lens.cx, lens.cy];
    for (reported, expected) in reported.into_iter().zip([500.5, 500.5, 255.5, 250.0]) {
        assert!((reported - expected).abs() < 1e-9, "{reported}");
    }
    // A step of 0.25 mm, plus 100 mm spread over 65535 steps.
    let expected = 0.000_25 + 0.1 / 65_535.0;
    assert!((frame.metres_per_unit - expected).abs() < 1e-12);
    // The fake camera does not paint pixels of this format.
    assert!(frame.depth.iter().all(|&depth| depth == 0));
    drop(source);

    let mut source = open(&spec("genicam,format=Coord3D_ABC32f")).expect("opens");
    let Image::Cloud(cloud) = next_capture(source.as_mut()).image else {
        panic!("a depth image")
    };
    let grid = Grid {
        width: 512,
        height: 512,
    };
    assert_eq!((cloud.grid, cloud.num_finite()), (Some(grid), 0));
    drop(source);
    drop(camera);

    for (mode, reverse, words, advice) in [
        ("2", "0", "DisparityC", "CalibratedC"),
        ("1", "1", "ReverseX", "false"),
    ] {
        describe(&path, mode, reverse);
        let _camera = FakeCamera::start(Some(&path)).expect("one was there before");
        let error = open_error("genicam");
        assert!(error.to_string().contains(words), "{error}");
        assert!(error.advice().contains(advice), "{}", error.advice());
    }
}

fn a_camera_that_is_gone_is_lost_and_found_again(camera: FakeCamera) {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = grey_as_depth(folder.path());
    let feed = Feed::start(spec, BackpressurePolicy::Newest, || {}).expect("a thread");
    let captured = |feed: &Feed| {
        let until = Instant::now() + PATIENCE;
        while Instant::now() < until {
            if let Some(FeedItem::Captured(captured)) = feed.wait(Duration::from_millis(50)) {
                return captured;
            }
        }
        panic!("nothing came: {:?}", feed.status());
    };
    check_pattern(&depth_of(captured(&feed)));
    drop(camera);
    let until = Instant::now() + PATIENCE;
    let error = loop {
        if let FeedState::Lost { error } = feed.status().state {
            break error;
        }
        assert!(Instant::now() < until, "{:?}", feed.status());
        thread::sleep(Duration::from_millis(10));
    };
    assert!(
        matches!(&*error, CaptureError::Camera(error) if error.kind == CameraErrorKind::Disconnected),
        "{error}"
    );
    // Discard the frames captured before.
    while feed.wait(Duration::ZERO).is_some() {}
    let _camera = FakeCamera::start(None).expect("one was there before");
    check_pattern(&depth_of(captured(&feed)));
    // Before the camera: closing one that no longer answers takes many seconds.
    drop(feed);
}

#[test]
fn a_place_without_the_library_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = GenicamSpec {
        library: Some(folder.path().to_path_buf()),
        ..GenicamSpec::default()
    };
    let error = open(&SourceSpec::Genicam(spec)).err().expect("no library");
    let place = folder.path().display().to_string();
    assert!(error.to_string().contains(&place), "{error}");
    assert!(error.advice().contains("PARTSIGHT_ARAVIS"));
}
