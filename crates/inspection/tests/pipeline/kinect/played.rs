//! A recorded session, played by the fakenect build.

use std::{ffi::OsStr, fs, path::Path, sync::mpsc, time::Duration};

use capture::{
    BackpressurePolicy, CameraErrorKind, CaptureWarning, Captured, Feed, FeedState, Image,
    KinectSpec, NextCapture, SourceSpec,
};
use geometry::{depth_frame::DepthFrame, error::Advice as _};
use inspection::pipeline::{Recipe, Unwatched, Verdict, run};
use stages::scene::scene_from_frame;

use inspection::fixtures::shipped_library;

use crate::{
    kinect::{
        fakenect, open_error, open_kinect,
        session::{self, CAMERA, step_width},
    },
    own_process::{self, is_own},
    played_camera::{PATIENCE, next_capture},
};

/// Runs a test's body with a session that `write` makes in an empty folder.
fn with_session(test: &str, write: impl FnOnce(&Path), body: impl FnOnce()) {
    if is_own(test) {
        return body();
    }
    let Some(library) = fakenect() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path());
    let environment: [(&str, &OsStr); 2] = [
        ("PARTSIGHT_FREENECT", library.as_os_str()),
        ("FAKENECT_PATH", folder.path().as_os_str()),
    ];
    own_process::run(test, &environment);
}

fn depth_of(captured: &Captured) -> &DepthFrame {
    match &captured.image {
        Image::Depth(frame) => frame,
        Image::Cloud(_) => panic!("a Kinect gives depth images"),
    }
}

#[test]
fn frames_arrive_with_the_depth_that_was_seen_and_the_session_ends() {
    let write = |folder: &Path| session::write(folder, &session::frames(), 0.01);
    with_session(
        "kinect::played::frames_arrive_with_the_depth_that_was_seen_and_the_session_ends",
        write,
        || {
            let mut kinect = open_kinect().expect("a session");
            assert_eq!(kinect.title(), "Kinect, a recorded session");
            assert!(!kinect.is_simulated());
            for (k, seen) in session::frames().iter().enumerate() {
                let captured = next_capture(kinect.as_mut())
                    .expect("no problem")
                    .expect("a frame");
                assert_eq!(captured.number, k as u64 + 1);
                assert!(
                    captured
                        .warnings
                        .contains(&CaptureWarning::AssumedDepthScale)
                );
                compare(depth_of(&captured), seen);
            }
            for _ in 0..3 {
                let next = kinect.next(Duration::ZERO).expect("an end");
                assert!(matches!(next, NextCapture::End), "{next:?}");
            }
        },
    );
}

/// Checks that the two differ only by rounding: to steps of disparity in the session, and to millimetres here.
#[expect(clippy::print_stdout, reason = "figures to be read")]
fn compare(found: &DepthFrame, seen: &DepthFrame) {
    let camera = found.intrinsics;
    assert_eq!((camera.width, camera.height), (640, 480));
    assert!((camera.fx - CAMERA.fx).abs() < 0.01 && (camera.fy - CAMERA.fy).abs() < 0.01);
    assert_eq!((camera.cx, camera.cy), (CAMERA.cx, CAMERA.cy));
    let (mut num_readings, mut furthest_off) = (0, 0.0_f64);
    for (&found_units, &seen_units) in found.depth.iter().zip(&seen.depth) {
        assert_eq!(found_units == 0, seen_units == 0);
        if seen_units == 0 {
            continue;
        }
        let found_mm = f64::from(found_units) * found.metres_per_unit * 1000.0;
        let seen_mm = f64::from(seen_units) * seen.metres_per_unit * 1000.0;
        // Half a step, which is slightly wider behind the reading than before it, and half a millimetre.
        let rounding = 0.505 * step_width(seen_mm) + 0.5;
        let off = (found_mm - seen_mm).abs();
        assert!(off <= rounding, "{found_mm} mm for {seen_mm:.1} mm");
        furthest_off = furthest_off.max(off);
        num_readings += 1;
    }
    assert_eq!(found.depth.len(), 640 * 480);
    println!("figures: {num_readings} readings, at most {furthest_off:.2} mm off");
    assert!(num_readings > 150_000, "{num_readings}");
}

#[test]
fn a_part_is_recognised_in_what_the_library_gives() {
    let write = |folder: &Path| session::write(folder, &session::frames()[..1], 0.0);
    with_session(
        "kinect::played::a_part_is_recognised_in_what_the_library_gives",
        write,
        || {
            let mut kinect = open_kinect().expect("a session");
            let captured = next_capture(kinect.as_mut())
                .expect("no problem")
                .expect("a frame");
            let scene = scene_from_frame(depth_of(&captured));
            let found = run(&scene, &shipped_library(), &Recipe::default(), &Unwatched)
                .expect("not cancelled");
            let Verdict::Part {
                part,
                score,
                rejected,
                ..
            } = found.verdict
            else {
                panic!("{:?}", found.verdict)
            };
            println!("figures: {part}, score {score:.2}, rejected {rejected:?}");
            assert_eq!(part, "fender");
            assert!(rejected.is_none(), "{rejected:?}");
        },
    );
}

#[test]
fn stopping_works_from_any_state() {
    let write = |folder: &Path| session::write_endless(folder, &session::frames()[1]);
    with_session(
        "kinect::played::stopping_works_from_any_state",
        write,
        || {
            // Opened, but no frame requested.
            drop(open_kinect().expect("a session"));
            // Running; it cannot be opened twice.
            let mut kinect = open_kinect().expect("opened again");
            next_capture(kinect.as_mut())
                .expect("no problem")
                .expect("a frame");
            let error = open_error();
            assert_eq!(error.kind, CameraErrorKind::InUse, "{error}");
            next_capture(kinect.as_mut())
                .expect("no problem")
                .expect("the first is not disturbed");
            drop(kinect);
            // On the camera's own thread: before the first frame, between frames, and after its end.
            let spec = || SourceSpec::Kinect(KinectSpec::default());
            for num_before in [0, 3] {
                let feed =
                    Feed::start(spec(), BackpressurePolicy::Newest, || {}).expect("a thread");
                for _ in 0..num_before {
                    feed.wait(PATIENCE).expect("a frame");
                }
                drop(feed);
            }
            drop(open_kinect().expect("the camera was let go"));
        },
    );
}

#[test]
fn a_session_that_is_over_ends_the_feed_and_stays_over() {
    let write = |folder: &Path| session::write(folder, &session::frames()[1..2], 0.0);
    with_session(
        "kinect::played::a_session_that_is_over_ends_the_feed_and_stays_over",
        write,
        || {
            let (sender, receiver) = mpsc::channel();
            let spec = SourceSpec::Kinect(KinectSpec::default());
            let on_news = move || sender.send(()).unwrap_or(());
            let feed = Feed::start(spec, BackpressurePolicy::Every, on_news).expect("a thread");
            let mut num_frames = 0;
            while !feed.status().state.is_over() {
                receiver.recv_timeout(PATIENCE).expect("news");
                num_frames += usize::from(feed.wait(Duration::ZERO).is_some());
            }
            assert!(
                matches!(feed.status().state, FeedState::Ended),
                "{:?}",
                feed.status().state
            );
            num_frames += usize::from(feed.wait(Duration::ZERO).is_some());
            assert_eq!(num_frames, 1);
            drop(feed);
            let mut again = open_kinect().expect("opens");
            assert!(
                next_capture(again.as_mut()).expect("no problem").is_none(),
                "the library has no way back to the start"
            );
        },
    );
}

#[test]
fn a_session_that_would_end_the_program_is_refused_and_a_repaired_one_opens() {
    let write = |folder: &Path| session::write(folder, &session::frames()[1..2], 0.0);
    with_session(
        "kinect::played::a_session_that_would_end_the_program_is_refused_and_a_repaired_one_opens",
        write,
        || {
            let folder = std::env::var_os("FAKENECT_PATH").expect("a session");
            let index = Path::new(&folder).join("INDEX.txt");
            let whole = fs::read_to_string(&index).expect("an index");
            fs::write(&index, format!("{whole}d-1290000001.000000-7.pgm\n")).expect("written");
            let error = open_error();
            assert!(
                error.to_string().contains("d-1290000001.000000-7.pgm"),
                "{error}"
            );
            assert!(error.advice().contains("INDEX.txt"), "{}", error.advice());
            fs::write(&index, whole).expect("written");
            let mut kinect = open_kinect().expect("repaired");
            next_capture(kinect.as_mut())
                .expect("no problem")
                .expect("a frame");
        },
    );
}

#[test]
fn without_a_session_there_is_a_word_about_it() {
    let test = "kinect::played::without_a_session_there_is_a_word_about_it";
    if is_own(test) {
        let error = open_error();
        let text = error.to_string();
        assert!(text.contains("FAKENECT_PATH names none"), "{text}");
        assert!(
            matches!(error.kind, CameraErrorKind::Unsuitable { .. }),
            "{text}"
        );
        return;
    }
    let Some(library) = fakenect() else { return };
    own_process::run(test, &[("PARTSIGHT_FREENECT", library.as_os_str())]);
}
