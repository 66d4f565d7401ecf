use std::{fs, sync::OnceLock};

use nalgebra::{Isometry3, Vector3};

use super::*;
use geometry::error::Advice as _;
use simulate::{CellSetup, PartKind, PartPose, SensorNoise, Side, frame};
use stages::{fixtures::scene_of, segment::SegmentParams};

/// Frames of a part at rest, each with its own noise; `moved` is how the part moved beforehand.
fn views(kind: PartKind, noise: [u64; 3], moved: &RigidTransform) -> Vec<CellView> {
    let mut setup = CellSetup::with_part(kind, Side::Left, 0, 4);
    setup.noise = SensorNoise::none();
    let standing = frame(&setup).truth.camera_from_part;
    let view = |seed| {
        let mut setup = setup;
        setup.pose = PartPose::Fixed(moved * standing);
        setup.noise = SensorNoise::kinect(seed);
        CellView::from_scene(&scene_of(&setup), &SegmentParams::default()).expect("a part")
    };
    noise.map(view).into()
}

const NUM_KINDS: usize = PartKind::ALL.len();

fn still(kind: PartKind, noise: [u64; 3]) -> Vec<CellView> {
    static SEEN: [[OnceLock<Vec<CellView>>; 2]; NUM_KINDS] =
        [const { [const { OnceLock::new() }; 2] }; NUM_KINDS];
    let seen = || views(kind, noise, &RigidTransform::identity());
    // The frames of baselines, and those that most tests compare with one.
    let usual = [[1, 2, 3], [11, 12, 13]];
    match usual.iter().position(|usual| *usual == noise) {
        Some(place) => SEEN[kind as usize][place].get_or_init(seen).clone(),
        None => seen(),
    }
}

fn baseline(kind: PartKind) -> CellBaseline {
    static MADE: [OnceLock<CellBaseline>; NUM_KINDS] = [const { OnceLock::new() }; NUM_KINDS];
    let made = || {
        let views = still(kind, [1, 2, 3]);
        CellBaseline::new(&views, CellLimits::default(), true, Timestamp::UNIX_EPOCH).expect("one")
    };
    MADE[kind as usize].get_or_init(made).clone()
}

fn check(baseline: &CellBaseline, views: &[CellView]) -> CellCheck {
    let at = Timestamp::UNIX_EPOCH;
    baseline.check(views, true, at).expect("comparable")
}

/// The views after the camera moved: everything moves the opposite way.
fn seen_from_elsewhere(views: &[CellView], moved: &RigidTransform) -> Vec<CellView> {
    let view = |view: &CellView| CellView {
        part: PointCloud::from_points(
            view.part
                .points
                .iter()
                .map(|p| (moved * p.cast::<f64>()).cast()),
        ),
        background: view
            .background
            .iter()
            .map(|patch| patch.carried(moved))
            .collect(),
        noise_at_1m: view.noise_at_1m,
    };
    views.iter().map(view).collect()
}

fn moved(shift_mm: [f64; 3], turn_degrees: f64) -> RigidTransform {
    let axis = Vector3::new(0.6, 0.64, 0.48);
    Isometry3::new(
        Vector3::from(shift_mm) / 1000.0,
        axis * turn_degrees.to_radians(),
    )
}

#[test]
fn what_stands_still_is_in_place_whatever_the_noise() {
    for kind in PartKind::ALL {
        let baseline = baseline(kind);
        let found = check(&baseline, &still(kind, [11, 12, 13]));
        assert_eq!(found.finding, CellFinding::InPlace, "{kind:?}: {found:?}");
        assert!(found.shift() < Metres::from_mm(3.0), "{kind:?}: {found:?}");
        assert!(
            found.background_shift_m.expect("a wall") < 0.001,
            "{kind:?}: {found:?}"
        );
        assert!(
            (0.8..1.25).contains(&found.noise_ratio),
            "{kind:?}: {found:?}"
        );
    }
}

#[test]
fn a_part_that_hangs_elsewhere_is_told_from_a_camera_that_moved() {
    for kind in [PartKind::Fender, PartKind::FrontDoor, PartKind::BackBumper] {
        let baseline = baseline(kind);
        let middle = baseline.middle();
        // About the middle of the part, so that the shift is the one stated.
        let about_middle = |moved: &RigidTransform| {
            let to_middle = Isometry3::from(middle.coords);
            to_middle * moved * to_middle.inverse()
        };
        let away = about_middle(&moved([8.0, -4.0, 12.0], 1.5));
        let part = check(&baseline, &views(kind, [11, 12, 13], &away));
        assert_eq!(part.finding, CellFinding::PartMoved, "{kind:?}: {part:?}");
        let off = (Vector3::from(part.shift_m) * 1000.0 - Vector3::new(8.0, -4.0, 12.0)).norm();
        assert!(off < 4.0, "{kind:?}: {part:?}");
        let views = seen_from_elsewhere(&still(kind, [11, 12, 13]), &away);
        let camera = check(&baseline, &views);
        assert_eq!(
            camera.finding,
            CellFinding::CameraMoved,
            "{kind:?}: {camera:?}"
        );
        assert!(
            (camera.turn().degrees() - 1.5).abs() < 0.4,
            "{kind:?}: {camera:?}"
        );
    }
}

#[test]
fn a_camera_that_moved_so_far_that_the_wall_is_another_plane_is_told() {
    let baseline = baseline(PartKind::Fender);
    let away = moved([60.0, 0.0, 450.0], 3.0);
    let views = seen_from_elsewhere(&still(PartKind::Fender, [11, 12, 13]), &away);
    let found = check(&baseline, &views);
    assert_eq!(found.finding, CellFinding::CameraMoved, "{found:?}");
    assert_eq!(found.background_shift_m, None);
}

#[test]
fn without_a_wall_nobody_says_who_moved() {
    let baseline = baseline(PartKind::Fender);
    let mut views = views(
        PartKind::Fender,
        [11, 12, 13],
        &moved([0.0, 0.0, 20.0], 0.0),
    );
    for view in &mut views {
        view.background.clear();
    }
    let found = check(&baseline, &views);
    assert_eq!(found.finding, CellFinding::PartOrCameraMoved, "{found:?}");
    assert_eq!(found.background_shift_m, None);
}

#[test]
fn noise_that_grew_is_found_though_nothing_moved() {
    let baseline = baseline(PartKind::Fender);
    let mut views = still(PartKind::Fender, [11, 12, 13]);
    for view in &mut views {
        view.noise_at_1m = Metres(view.noise_at_1m.0 * 2.0);
    }
    let found = check(&baseline, &views);
    assert_eq!(found.finding, CellFinding::Noisier, "{found:?}");
}

#[test]
fn another_part_is_no_check_of_the_cell() {
    let baseline = baseline(PartKind::Fender);
    let views = still(PartKind::FrontDoor, [11, 12, 13]);
    let error = baseline
        .check(&views, true, Timestamp::UNIX_EPOCH)
        .expect_err("another part");
    assert!(
        matches!(error, CellViewError::OtherPart { frame: 1, overlap } if overlap < 0.9),
        "{error}"
    );
}

#[test]
fn frames_of_a_part_that_swings_are_no_baseline() {
    let mut frames = still(PartKind::Fender, [1, 2, 3]);
    frames[2] = views(PartKind::Fender, [3, 3, 3], &moved([0.0, 0.0, 15.0], 0.0)).remove(0);
    let error = CellBaseline::new(&frames, CellLimits::default(), true, Timestamp::UNIX_EPOCH)
        .expect_err("it moves");
    assert!(
        matches!(error, CellViewError::Moving { frame: 3, .. }),
        "{error}"
    );
}

#[test]
fn baseline_and_checks_come_back_from_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let folder = CellCheckFolder::at(folder.path().join("cell"));
    assert!(matches!(
        folder.baseline(),
        Err(CellCheckError::NoBaseline { .. })
    ));
    assert_eq!(folder.checks().unwrap(), []);
    let first = baseline(PartKind::Fender);
    folder.save(&first).unwrap();
    let again = folder.baseline().unwrap();
    let seen = still(PartKind::Fender, [11, 12, 13]);
    let found = check(&first, &seen);
    assert_eq!(check(&again, &seen), found);
    folder.add(&found).unwrap();
    folder.add(&found).unwrap();
    assert_eq!(folder.checks().unwrap(), [found.clone(), found]);
    // The points of the previous baseline are removed.
    folder.save(&baseline(PartKind::Grille)).unwrap();
    let points = fs::read_dir(folder.path()).unwrap().flatten();
    let points = points.filter(|file| file.path().extension().is_some_and(|e| e == "pcd"));
    assert_eq!(points.count(), 1);
    assert!(
        check(
            &folder.baseline().unwrap(),
            &still(PartKind::Grille, [5, 6, 7])
        )
        .turn_rad
            < 0.01
    );
}

#[test]
fn a_damaged_baseline_or_list_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let folder = CellCheckFolder::at(folder.path());
    folder.save(&baseline(PartKind::Fender)).unwrap();
    let file = folder.path().join("baseline.toml");
    let text = fs::read_to_string(&file).unwrap();
    for (before, after) in [
        ("schema_version = 1", "schema_version = 9"),
        ("part = \"", "part = \"../"),
        ("max_shift_m = 0.005", "max_shift_m = nan"),
        ("simulated = true", "simulated = 3"),
    ] {
        assert!(text.contains(before), "{text}");
        fs::write(&file, text.replace(before, after)).unwrap();
        let error = folder.baseline().expect_err(after);
        assert!(!error.advice().is_empty(), "{error}");
    }
    fs::write(folder.path().join("checks.jsonl"), "{\"at\":").unwrap();
    let error = folder.checks().expect_err("half a line");
    assert!(error.to_string().contains("line 1"), "{error}");
    assert!(error.advice().contains("Move"), "{}", error.advice());
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_baseline_is_the_old_one_or_the_new() {
    use std::path::Path;

    use files::disk::faults::{Writer, with_advice};

    let of_frames = |num_frames| CellBaseline {
        num_frames,
        ..baseline(PartKind::Grille)
    };
    let (old, new) = (of_frames(1), of_frames(2));
    let place = |folder: &Path| CellCheckFolder::at(folder.join("deep"));
    Writer {
        test: "cell_check::tests::whichever_call_fails_a_baseline_is_the_old_one_or_the_new",
        prepare: &|folder| place(folder).save(&old).expect("written"),
        write: &|folder| {
            place(folder)
                .save(&new)
                .map_err(|error| with_advice(&error))
        },
        state: &|folder| {
            place(folder)
                .baseline()
                .expect("read")
                .num_frames
                .to_string()
        },
        between: &[],
    }
    .fails_at_every_call();
}
