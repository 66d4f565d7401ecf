mod foreign;

use std::{fs, io::Write as _, path::Path, time::Duration};

use nalgebra::Point3;

use super::*;
use crate::{
    error::{CaptureError, CaptureWarning},
    open::open,
    source::{Captured, DepthSource, Image, NextCapture},
    spec::{Pace, SourceSpec},
};
use files::FileContent;
use geometry::{
    cloud::{Grid, PointCloud},
    depth_frame::{DepthFrame, Intrinsics},
    error::Advice as _,
};

fn spec(kind: &str, folder: &Path) -> SourceSpec {
    format!("{kind}:{}", folder.display()).parse().unwrap()
}

/// Reads a source to its end; names of skipped frames begin with `!`.
fn all_of(source: &mut dyn DepthSource) -> (Vec<Captured>, Vec<String>) {
    let (mut captured, mut names) = (Vec::new(), Vec::new());
    loop {
        match source.next(Duration::from_secs(1)).unwrap() {
            NextCapture::Captured(next) => {
                names.push(next.name.clone());
                captured.push(next);
            }
            NextCapture::Skipped(skipped) => names.push(format!("!{}", skipped.name)),
            NextCapture::NotYet => {}
            NextCapture::End => return (captured, names),
        }
    }
}

fn replayed(folder: &Path) -> (Vec<Captured>, Vec<String>) {
    all_of(open(&spec("recording,pace=step", folder)).unwrap().as_mut())
}

fn simulated(num: usize) -> Vec<Captured> {
    let spec: SourceSpec = "simulated,fps=1000,every=4:line".parse().unwrap();
    let mut cell = open(&spec).unwrap();
    let mut frames = Vec::new();
    while frames.len() < num {
        if let NextCapture::Captured(frame) = cell.next(Duration::from_secs(1)).unwrap() {
            frames.push(frame);
        }
    }
    frames
}

fn record(folder: &Path, frames: &[Captured]) {
    let mut recorder = Recorder::create(folder, "Test", "simulated", true).unwrap();
    for frame in frames {
        recorder.write(frame).unwrap();
    }
    assert_eq!(recorder.num_frames(), frames.len() as u64);
}

fn assert_same(found: &[Captured], expected: &[Captured]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.image == expected.image, "{}", expected.name);
        assert_eq!(found.name, expected.name);
        assert_eq!(found.taken_at, expected.taken_at);
        assert_eq!(found.truth, expected.truth, "to the last bit");
        assert_eq!(found.is_simulated, expected.is_simulated);
    }
}

#[test]
fn what_was_recorded_is_replayed_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let frames = simulated(4);
    record(folder.path(), &frames);
    let (found, _) = replayed(folder.path());
    assert_same(&found, &frames);
    assert!(
        found
            .iter()
            .all(|frame| frame.is_simulated && frame.warnings.is_empty())
    );
    let source = open(&spec("recording", folder.path())).unwrap();
    assert!(source.is_simulated());
    // Other programs, and inspect, read the images too.
    let path = folder.path().join("frame-000002.png");
    let FileContent::Depth(opened) = files::open(&path).unwrap() else {
        panic!("a depth image");
    };
    assert!(Image::Depth(opened) == frames[1].image);
}

#[test]
fn every_kind_of_image_survives() {
    let awkward = Intrinsics {
        width: 2,
        height: 2,
        fx: 594.214_342_119_232_5,
        fy: 1.0 / 3.0,
        cx: -0.1,
        cy: 1e-300,
        distortion: geometry::distortion::Distortion {
            k1: -1e-9 / 3.0,
            p2: 1e-200,
            k6: 1e-300,
            ..geometry::distortion::Distortion::NONE
        },
    };
    let dark = DepthFrame {
        intrinsics: awkward,
        metres_per_unit: 0.1 + 0.2,
        depth: vec![0; 4],
        is_simulated: false,
    };
    let mut other = dark.clone();
    other.intrinsics.fx = 600.0;
    other.depth = vec![1, 2, 0, u16::MAX];
    let (seen, hole) = (
        Point3::new(0.1, 0.2, 0.3),
        Point3::new(f32::NAN, f32::NAN, f32::NAN),
    );
    let holey = PointCloud {
        points: vec![seen, hole, hole, seen],
        grid: Some(Grid {
            width: 2,
            height: 2,
        }),
        colours: Some(vec![[1, 2, 3], [0, 0, 0], [0, 0, 0], [4, 5, 6]]),
        ..PointCloud::default()
    };
    let template = simulated(1).remove(0);
    let images = [
        Image::Depth(dark.clone()),
        Image::Depth(other),
        Image::Cloud(holey),
        Image::Cloud(PointCloud::default()),
        Image::Depth(dark),
    ];
    let frames = images.map(|image| Captured {
        image,
        truth: None,
        robot_from_flange: None,
        ..template.clone()
    });
    let folder = tempfile::tempdir().unwrap();
    record(folder.path(), &frames);
    let (found, _) = replayed(folder.path());
    let text = |frame: &Captured| format!("{:?}", frame.image);
    let (found, expected): (Vec<_>, Vec<_>) = (
        found.iter().map(text).collect(),
        frames.iter().map(text).collect(),
    );
    // As text, since NaN is not equal to itself.
    assert_eq!(found, expected);
}

#[test]
fn a_recording_that_was_cut_off_opens_up_to_its_last_whole_frame() {
    let folder = tempfile::tempdir().unwrap();
    let frames = simulated(3);
    record(folder.path(), &frames);
    let list = folder.path().join("recording.jsonl");
    let whole = fs::read(&list).unwrap();
    let ends: Vec<usize> = (0..whole.len()).filter(|&i| whole[i] == b'\n').collect();
    let expect = |num: usize, what: &str| {
        let (found, names) = replayed(folder.path());
        assert_same(&found, &frames[..num]);
        assert_eq!(names.len(), num, "{what}");
        let warned = found[0]
            .warnings
            .contains(&CaptureWarning::CutOff { num_frames: num });
        assert_eq!(warned, num < 3 || what.contains("after"), "{what}");
    };
    expect(3, "whole");
    for cut in [ends[2] + 1, ends[2] + 2, ends[2] + 40, ends[3] - 1, ends[3]] {
        fs::write(&list, &whole[..cut]).unwrap();
        let what = format!("cut at {cut}");
        let (found, _) = replayed(folder.path());
        assert_same(&found, &frames[..2]);
        assert_eq!(found[0].warnings.is_empty(), cut == ends[2] + 1, "{what}");
    }
    let mut zeros = whole.clone();
    zeros.extend([0; 100]);
    fs::write(&list, &zeros).unwrap();
    expect(3, "zeros after the end");
    fs::write(&list, &whole).unwrap();
    // The last line's image did not reach the disk.
    let last = folder.path().join("frame-000003.png");
    let bytes = fs::read(&last).unwrap();
    fs::write(&last, &bytes[..bytes.len() / 2]).unwrap();
    expect(2, "half an image");
    // Damaged in the middle: reported, and the others are there.
    fs::write(&last, &bytes).unwrap();
    let middle = folder.path().join("frame-000002.png");
    let mut bytes = fs::read(&middle).unwrap();
    let at = bytes.len() / 2;
    bytes[at] ^= 1;
    fs::write(&middle, &bytes).unwrap();
    let (found, names) = replayed(folder.path());
    assert_eq!(found.len(), 2);
    assert_eq!(names[1], format!("!{}", frames[1].name));
    // With only its first line, a recording has no frames.
    fs::write(&list, &whole[..=ends[0]]).unwrap();
    assert!(matches!(
        Replay::open(&recording_of(folder.path())),
        Err(CaptureError::NoFrames { .. })
    ));
}

fn recording_of(folder: &Path) -> crate::RecordingSpec {
    match spec("recording", folder) {
        SourceSpec::Recording(spec) => spec,
        other => panic!("{other}"),
    }
}

#[test]
fn recordings_that_cannot_be_are_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let list = folder.path().join("recording.jsonl");
    let refused = || match Replay::open(&recording_of(folder.path())) {
        Ok(_) => panic!("it was opened"),
        Err(error) => {
            assert!(!error.advice().is_empty());
            error.to_string()
        }
    };
    assert!(refused().contains("neither a recording"));
    fs::write(&list, "{\"partsight_recording\":9}\n").unwrap();
    assert!(refused().contains("newer version"));
    fs::write(&list, "{\"partsight_recording\":1}\n").unwrap();
    assert!(refused().contains("damaged"));
    fs::write(&list, "{\"partsight_rec").unwrap();
    assert!(refused().contains("damaged"));
    let missing = Replay::open(&recording_of(&folder.path().join("missing")));
    assert!(matches!(
        missing,
        Err(CaptureError::FolderGone {
            may_come: false,
            ..
        })
    ));
}

#[test]
fn a_list_cannot_lead_out_of_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    record(folder.path(), &simulated(1));
    let list = folder.path().join("recording.jsonl");
    let text = fs::read_to_string(&list).unwrap();
    fs::write(
        &list,
        text.replace("frame-000001.png", "../frame-000001.png"),
    )
    .unwrap();
    assert!(matches!(
        Replay::open(&recording_of(folder.path())),
        Err(CaptureError::NoFrames { .. })
    ));
}

#[test]
fn a_recording_is_never_mixed_with_what_is_there() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("photo.png"), "somebody's").unwrap();
    let refused = Recorder::create(folder.path(), "Test", "simulated", true).unwrap_err();
    assert!(matches!(refused, CaptureError::FolderInUse { .. }));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_frame_that_cannot_be_written_leaves_the_ones_before() {
    let folder = tempfile::tempdir().unwrap();
    let frames = simulated(3);
    let mut recorder = Recorder::create(folder.path(), "Test", "simulated", true).unwrap();
    recorder.write(&frames[0]).unwrap();
    // An obstacle for the next frame, as a full disk would be.
    let next = folder.path().join("frame-000002.png");
    fs::create_dir(&next).unwrap();
    let failed = recorder.write(&frames[1]).unwrap_err();
    assert!(matches!(
        failed,
        CaptureError::Unwritable { num_kept: 1, .. }
    ));
    assert!(failed.to_string().contains("1 frame"), "{failed}");
    assert_same(&replayed(folder.path()).0, &frames[..1]);
    fs::remove_dir(&next).unwrap();
    recorder.write(&frames[2]).unwrap();
    let (found, _) = replayed(folder.path());
    assert_same(&found, &[frames[0].clone(), frames[2].clone()]);
    assert!(found[0].warnings.is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said_in_words() {
    let full = || -> std::io::Result<()> {
        fs::File::options()
            .write(true)
            .open("/dev/full")?
            .write_all(b"x")
    };
    let error = CaptureError::Unwritable {
        path: "frame-000007.png".into(),
        num_kept: 6,
        source: full().expect_err("/dev/full is"),
    };
    assert_eq!(
        error.to_string(),
        "frame-000007.png: cannot record: the disk is full; 6 frames are kept"
    );
    assert!(error.advice().contains("room"));
}

#[test]
fn replays_keep_the_pauses_and_cut_long_ones() {
    let template = simulated(1).remove(0);
    let at = |seconds: f64| Captured {
        taken_at: jiff::Timestamp::from_nanosecond((seconds * 1e9) as i128).unwrap(),
        ..template.clone()
    };
    let folder = tempfile::tempdir().unwrap();
    record(
        folder.path(),
        &[at(100.0), at(100.25), at(5000.0), at(4000.0), at(4000.5)],
    );
    let due = |pace: Option<Pace>| {
        let mut spec = recording_of(folder.path());
        spec.pace = pace;
        let replay = Replay::open(&spec).unwrap();
        replay
            .due
            .iter()
            .map(Duration::as_secs_f64)
            .collect::<Vec<_>>()
    };
    assert_eq!(due(None), [0.0, 0.25, 10.25, 10.25, 10.75]);
    assert_eq!(due(Some(Pace::Step)), [0.0; 5]);
    assert_eq!(due(Some(Pace::PerSecond(4.0))), [0.0, 0.25, 0.5, 0.75, 1.0]);
}

#[test]
fn a_drive_that_is_pulled_out_is_waited_for() {
    let place = tempfile::tempdir().unwrap();
    let (here, away) = (place.path().join("stick"), place.path().join("pulled"));
    record(&here, &simulated(2));
    let mut source = open(&spec("recording,pace=step", &here)).unwrap();
    assert!(matches!(
        source.next(Duration::ZERO),
        Ok(NextCapture::Captured(_))
    ));
    fs::rename(&here, &away).unwrap();
    let gone = source.next(Duration::ZERO).expect_err("it is not there");
    assert_eq!(gone.recovery(), crate::Recovery::AskAgain);
    fs::rename(&away, &here).unwrap();
    assert!(
        matches!(source.next(Duration::ZERO), Ok(NextCapture::Captured(frame)) if frame.number == 2)
    );
    assert!(matches!(source.next(Duration::ZERO), Ok(NextCapture::End)));
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_recording_holds_whole_frames_alone() {
    use files::disk::faults::{Writer, with_advice};
    use geometry::fixtures::small_frame;

    let template = simulated(1).remove(0);
    let frames = [900, 1900].map(|depth| Captured {
        image: Image::Depth(small_frame(6, depth..depth + 24)),
        // The same in the process that is killed.
        taken_at: jiff::Timestamp::UNIX_EPOCH,
        truth: None,
        ..template.clone()
    });
    Writer {
        test: "recording::tests::whichever_call_fails_a_recording_holds_whole_frames_alone",
        prepare: &|_| (),
        write: &|folder| {
            let create = |name| Recorder::create(&folder.join(name), "Test", "simulated", true);
            let recorder = match create("new") {
                // As the advice says.
                Err(CaptureError::FolderInUse { .. }) => create("another"),
                created => created,
            };
            let mut recorder = recorder.map_err(|error| with_advice(&error))?;
            for frame in &frames {
                recorder.write(frame).map_err(|error| with_advice(&error))?;
            }
            Ok(())
        },
        state: &|folder| {
            let names = ["another", "new"].into_iter();
            let mut opened = names.map(|name| Replay::open(&recording_of(&folder.join(name))));
            let Some(mut replay) = opened.find_map(Result::ok) else {
                return "no recording".into();
            };
            let (found, names) = all_of(&mut replay);
            assert!(names.iter().all(|name| !name.starts_with('!')), "{names:?}");
            assert_same(&found, &frames[..found.len()]);
            format!("{} frames", found.len())
        },
        between: &["0 frames", "1 frames"],
    }
    .fails_at_every_call();
}
