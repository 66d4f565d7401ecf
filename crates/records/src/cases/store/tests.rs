use std::sync::Arc;

use super::*;
use crate::cases::{FoundVerdict, Truth};
use geometry::{error::Advice as _, fixtures::small_frame};
use inspection::{
    fixtures::shipped_library,
    pipeline::{Recipe, Unwatched, run},
};
use simulate::{CellSetup, PartKind, Side, SimulatedObject};
use stages::{
    fixtures::{facing_part, scene_of},
    scene::{EmptyCell, PictureEdge, scene_from_cloud, scene_from_frame},
};

/// The file of such a scene.
const CRUMB: &str = "scene.pcd";

/// A scene small enough to be written many times.
fn crumb() -> SceneCloud {
    let points = (0..12).map(|i| nalgebra::Point3::new(i as f32 * 0.1, 0.2, 1.0));
    scene_from_cloud(geometry::cloud::PointCloud::from_points(points))
}

fn about(origin: &str) -> CaseDescription {
    CaseDescription {
        origin: origin.into(),
        simulated: true,
        kept_at: "2026-11-20T14:07:31Z".parse().expect("a time"),
        remark: "after lunch".into(),
        difficulty: None,
        truth: Truth::Part("front_door".into()),
        found: FoundVerdict::default(),
        pose: None,
        one_of_several: None,
    }
}

fn bits(scene: &SceneCloud) -> Vec<[u32; 3]> {
    let points = scene.cloud.points.iter();
    let bits = points.map(|p| [p.x, p.y, p.z].map(f32::to_bits));
    // Treat all NaNs as equal.
    bits.map(|cell| cell.map(|x| if f32::from_bits(x).is_nan() { 1 } else { x }))
        .collect()
}

#[test]
fn the_lens_of_a_kept_scene_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path().join("cases"));
    let mut frame = small_frame(8, 1000..1048);
    let lens = &mut frame.intrinsics.distortion;
    (lens.k1, lens.p2) = (-0.1 / 3.0, 1e-4);
    let scene = scene_from_frame(&frame);
    let kept = cases.keep(&scene, about("lens")).expect("kept");
    let again = cases.read_scene(&kept).expect("read");
    assert_eq!(
        (bits(&again), again.intrinsics),
        (bits(&scene), Some(frame.intrinsics))
    );
}

#[test]
fn a_kept_scene_opens_again_bit_for_bit_with_the_same_verdict() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path().join("cases"));
    let mut scene = facing_part(PartKind::FrontDoor, Side::Left, 4);
    scene.edge = PictureEdge::Points;
    let empty = scene_of(&CellSetup::new(SimulatedObject::Nothing, 4));
    let cell = EmptyCell::from_scene(&empty).expect("a picture");
    scene.empty_cell = Some(Arc::new(cell));
    let library = shipped_library();
    let found_in = |scene: &SceneCloud| {
        let inspection = run(scene, &library, &Recipe::default(), &Unwatched);
        FoundVerdict::from(&inspection.expect("not cancelled").verdict)
    };
    let before = found_in(&scene);
    assert!(before.accepted);
    let mut problems = about("Simulated frame 4");
    problems.found = before.clone();
    let kept = cases.keep(&scene, problems).expect("kept");
    assert_eq!(kept.name, "simulated_frame_4");
    // The readings end inside the picture, which a depth image cannot express.
    assert_eq!(kept.meta.scene.file, "scene.pcd");

    let list = cases.list().expect("listed");
    assert!(list.problems.is_empty());
    assert_eq!(list.cases, [kept]);
    let again = cases.read_scene(&list.cases[0]).expect("read");
    assert_eq!(bits(&again), bits(&scene));
    assert_eq!(
        (again.intrinsics, again.edge, again.cloud.grid),
        (scene.intrinsics, scene.edge, scene.cloud.grid)
    );
    assert!(again.empty_cell.is_some() && again.empty_cell == scene.empty_cell);
    let after = found_in(&again);
    assert_eq!(after, before);
    assert_eq!(list.cases[0].meta.about.found, before);

    let empty_cell = list.cases[0].meta.scene.empty_cell.clone().expect("kept");
    let cell = cases.path().join("simulated_frame_4").join(&empty_cell);
    let mut bytes = fs::read(&cell).expect("there");
    *bytes.last_mut().expect("bytes") ^= 1;
    fs::write(cell, bytes).expect("damaged");
    let refused = cases.read_scene(&list.cases[0]).expect_err("damaged");
    assert!(refused.to_string().contains(&empty_cell), "{refused}");
}

#[test]
fn a_damaged_case_is_named_and_the_others_load() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path());
    let names = [
        "cut", "garbled", "gone", "newer", "no_scene", "sound", "swapped",
    ];
    for name in names {
        cases.keep(&crumb(), about(name)).expect("kept");
    }
    let at = |name: &str, file: &str| folder.path().join(name).join(file);
    let scene = fs::read(at("cut", CRUMB)).expect("read");
    fs::write(at("cut", CRUMB), &scene[..scene.len() - 5]).expect("cut");
    fs::write(at("garbled", META), "schema_version = 1\ntruth = 7\n").expect("garbled");
    fs::remove_file(at("gone", META)).expect("removed");
    let text = fs::read_to_string(at("newer", META)).expect("read");
    let newer = text.replace("schema_version = 2", "schema_version = 3");
    fs::write(at("newer", META), newer).expect("written");
    fs::remove_file(at("no_scene", CRUMB)).expect("removed");
    let mut other = scene.clone();
    *other.last_mut().expect("bytes") ^= 1;
    fs::write(at("swapped", CRUMB), other).expect("written");
    fs::create_dir(folder.path().join("holiday pictures")).expect("made");

    let list = cases.list().expect("listed");
    let sound: Vec<_> = list.cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(sound, ["sound", "swapped"]);
    let problems: Vec<String> = list.problems.iter().map(ToString::to_string).collect();
    for (problems, name) in problems.iter().zip(names) {
        assert!(problems.contains(name), "{problems}");
    }
    assert_eq!(problems.len(), 5);
    assert!(
        problems[4].ends_with("scene.pcd is missing"),
        "{}",
        problems[4]
    );
    assert!(
        list.problems
            .iter()
            .all(|problem| !problem.advice().is_empty())
    );
    cases.read_scene(&list.cases[0]).expect("sound");
    let refused = cases.read_scene(&list.cases[1]).expect_err("refused");
    assert!(refused.to_string().contains("checksum"));
}

#[test]
fn writing_that_stops_half_way_leaves_no_case_and_is_cleared_up() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path());
    cases.keep(&crumb(), about("whole")).expect("kept");
    // Wherever the writer stops before the rename, all files are in the hidden folder.
    let whole = folder.path().join("whole");
    for (index, files) in [&[][..], &[CRUMB], &[CRUMB, META]].into_iter().enumerate() {
        let half = folder.path().join(format!("{NEW_PREFIX}{index}"));
        fs::create_dir(&half).expect("made");
        for file in files {
            fs::copy(whole.join(file), half.join(file)).expect("copied");
        }
    }
    let list = cases.list().expect("listed");
    assert_eq!((list.cases.len(), list.problems.len()), (1, 0));
    cases.keep(&crumb(), about("whole")).expect("kept");
    let names = cases.names().expect("listed");
    assert_eq!(names, ["whole", "whole_2"]);
    let hidden = fs::read_dir(folder.path()).expect("listed").count();
    // The two cases and the lock.
    assert_eq!(hidden, 3);
}

#[test]
fn a_write_that_fails_leaves_what_was_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cases");
    fs::write(&path, "not a folder").expect("written");
    let cases = CaseFolder::at(&path);
    let failed = cases.keep(&crumb(), about("x")).expect_err("refused");
    assert!(matches!(failed, CaseError::Unwritable { .. }) && !failed.advice().is_empty());
    assert!(matches!(cases.list(), Err(CaseError::Unreadable { .. })));
    assert_eq!(fs::read(&path).expect("read"), b"not a folder");
}

#[test]
fn a_removed_case_can_be_put_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path());
    let kept = cases.keep(&crumb(), about("frame 1")).expect("kept");
    let trash = cases.remove(&kept.name).expect("removed");
    assert!(cases.list().expect("listed").cases.is_empty());
    cases.restore(&kept.name, &trash).expect("put back");
    assert_eq!(cases.list().expect("listed").cases, [kept]);
    for name in ["", "..", "../cases", ".trash", "missing"] {
        let refused = cases.remove(name).expect_err("refused");
        assert!(matches!(refused, CaseError::NoSuchCase { .. }), "{name}");
    }
}

#[test]
fn a_case_whose_folder_is_gone_is_not_damaged() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path());
    let kept = cases.keep(&crumb(), about("frame 1")).expect("kept");
    fs::remove_dir_all(folder.path().join(&kept.name)).expect("removed");
    for gone in [
        cases.read_scene(&kept).map(|_| ()),
        cases.pack(&kept).map(|_| ()),
        cases.set_truth(&kept.name, Truth::Nothing).map(|_| ()),
    ] {
        assert!(
            matches!(gone, Err(CaseError::NoSuchCase { .. })),
            "{gone:?}"
        );
    }
}

#[test]
fn the_truth_of_a_case_is_changed_and_nothing_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path());
    let mut kept = cases.keep(&crumb(), about("frame 1")).expect("kept");
    let before = cases.set_truth(&kept.name, Truth::NotEnrolled);
    assert_eq!(before.expect("changed"), Truth::Part("front_door".into()));
    kept.meta.about.truth = Truth::NotEnrolled;
    assert_eq!(cases.list().expect("listed").cases, [kept.clone()]);
    fs::remove_file(folder.path().join(&kept.name).join(CRUMB)).expect("removed");
    let refused = cases.set_truth(&kept.name, Truth::Nothing);
    assert!(matches!(refused, Err(CaseError::Damaged { .. })));
    for name in ["..", ".trash", "missing"] {
        let refused = cases.set_truth(name, Truth::Nothing);
        assert!(
            matches!(refused, Err(CaseError::NoSuchCase { .. })),
            "{name}"
        );
    }
}

#[test]
fn names_follow_from_the_origin_and_count_on() {
    assert_eq!(plain_name("Simulated frame 7"), "simulated_frame_7");
    assert_eq!(plain_name("Türe (2).pcd"), "t_re_2");
    assert_eq!(plain_name("…"), "case");
    let mut names = ["frame_10", "frame_9", "door", "frame_9_2"].map(str::to_owned);
    names.sort_by_key(|name| in_counting_order(name));
    assert_eq!(names, ["door", "frame_9", "frame_9_2", "frame_10"]);
}

#[test]
fn a_scene_is_kept_as_the_history_keeps_it_and_takes_little_room() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path());
    let scene = facing_part(PartKind::FrontDoor, Side::Left, 4);
    let kept = cases.keep(&scene, about("door")).expect("kept");
    assert_eq!(kept.meta.scene.file, "scene.png");
    let as_cloud = scene.cloud.points.len() as u64 * 12;
    assert!(
        kept.meta.scene.bytes < as_cloud / 5,
        "{}",
        kept.meta.scene.bytes
    );
    let again = cases.read_scene(&kept).expect("read");
    assert_eq!(bits(&again), bits(&scene));
    assert_eq!(again.intrinsics, scene.intrinsics);
}

#[test]
fn a_case_of_the_first_version_is_read_with_its_empty_cell() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = folder.path().join("old");
    fs::create_dir(&case).expect("made");
    let scene = facing_part(PartKind::FrontDoor, Side::Left, 4);
    let cell = EmptyCell::from_scene(&scene).expect("a picture");
    let packed = |cloud: &geometry::cloud::PointCloud| {
        let mut bytes = Vec::new();
        files::write_pcd(&mut bytes, cloud).expect("written");
        bytes
    };
    let (points, empty) = (packed(&scene.cloud), packed(&cell.to_cloud()));
    fs::write(case.join("scene.pcd"), &points).expect("written");
    fs::write(case.join("empty-cell.pcd"), &empty).expect("written");
    let camera = toml::to_string(&scene.intrinsics.expect("a camera")).expect("text");
    let camera = camera.replace("[distortion]", "[scene.camera.distortion]");
    let text = format!(
        "schema_version = 1\norigin = \"frame 4\"\nsimulated = true\nkept_at = \"2026-11-20T14:07:31Z\"\n\
        [truth]\nis = \"part\"\npart = \"front_door\"\n[found]\naccepted = true\n\
        [scene]\nbytes = {}\ncrc32 = {}\npicture_edge = \"view\"\nempty_cell_crc32 = {}\n[scene.camera]\n{camera}",
        points.len(),
        files::crc32(&points),
        files::crc32(&empty),
    );
    fs::write(case.join(META), text).expect("written");
    let cases = CaseFolder::at(folder.path());
    let list = cases.list().expect("listed");
    assert!(list.problems.is_empty(), "{:?}", list.problems);
    let again = cases.read_scene(&list.cases[0]).expect("read");
    assert_eq!(bits(&again), bits(&scene));
    assert_eq!(again.intrinsics, scene.intrinsics);
    assert!(again.empty_cell.as_deref() == Some(&cell));
    // A new truth is written in the newest schema.
    cases.set_truth("old", Truth::Nothing).expect("changed");
    let list = cases.list().expect("listed");
    assert_eq!(list.cases[0].meta.schema_version, SCHEMA_VERSION);
    let again = cases.read_scene(&list.cases[0]).expect("read");
    assert_eq!(bits(&again), bits(&scene));
    fs::write(case.join("empty-cell.pcd"), &points).expect("another");
    cases.read_scene(&list.cases[0]).expect_err("another cell");
}

#[test]
fn a_packed_case_is_the_same_without_its_folder_and_its_damage_is_reported_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path());
    let mut scene = facing_part(PartKind::FrontDoor, Side::Left, 4);
    let cell = EmptyCell::from_scene(&scene).expect("a picture");
    scene.empty_cell = Some(Arc::new(cell));
    let kept = cases.keep(&scene, about("door")).expect("kept");
    let packed = cases.pack(&kept).expect("packed");
    let (case, again) = packed.clone().unpack().expect("unpacked");
    assert_eq!(case, kept);
    assert_eq!(bits(&again), bits(&scene));
    assert!(again.empty_cell.is_some() && again.empty_cell == scene.empty_cell);

    let mut damaged = packed.clone();
    damaged.scene[9000] ^= 1;
    fs::write(folder.path().join("door/scene.png"), &damaged.scene).expect("written");
    let of_folder = cases.read_scene(&kept).expect_err("damaged").to_string();
    let of_packed = damaged.unpack().expect_err("damaged").to_string();
    assert_eq!(of_folder, of_packed);
    assert!(of_folder.contains("set aside: scene.png: "), "{of_folder}");
    // The empty cell is missing too; the scene is named first, as it is read.
    let cell = kept.meta.scene.empty_cell.as_deref().expect("a cell");
    fs::remove_file(folder.path().join("door").join(cell)).expect("removed");
    let refused = cases.pack(&kept).expect_err("damaged").to_string();
    assert_eq!(refused, of_folder);

    let newer = packed
        .case_toml
        .replace("schema_version = 2", "schema_version = 3");
    let newer = PackedCase {
        case_toml: newer,
        ..packed.clone()
    };
    assert!(matches!(
        newer.unpack(),
        Err(CaseError::File(FileError::Newer { .. }))
    ));
    let outside = packed.case_toml.replace(cell, "../other.pcd");
    let outside = PackedCase {
        case_toml: outside,
        ..packed
    };
    assert!(matches!(outside.unpack(), Err(CaseError::Damaged { .. })));
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_case_is_kept_whole_or_not_at_all() {
    use files::disk::faults::{Writer, with_advice};

    let scene = crumb();
    let at = |folder: &Path| CaseFolder::at(folder.join("cases"));
    let state = |folder: &Path| {
        let list = at(folder).list().expect("listed");
        assert!(list.problems.is_empty(), "{:?}", list.problems);
        for case in &list.cases {
            assert_eq!(
                bits(&at(folder).read_scene(case).expect("read")),
                bits(&scene)
            );
        }
        list.cases
            .into_iter()
            .map(|case| case.name)
            .collect::<Vec<_>>()
            .join(", ")
    };
    Writer {
        test: "cases::store::tests::whichever_call_fails_a_case_is_kept_whole_or_not_at_all",
        prepare: &|folder| {
            at(folder).keep(&scene, about("door")).expect("kept");
        },
        write: &|folder| {
            let kept = at(folder).keep(&scene, about("fender"));
            kept.map(|_| ()).map_err(|error| with_advice(&error))
        },
        state: &state,
        between: &[],
    }
    .fails_at_every_call();
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_case_is_removed_whole_or_not_at_all() {
    use files::disk::faults::{Writer, with_advice};

    let scene = crumb();
    let at = |folder: &Path| CaseFolder::at(folder.join("cases"));
    Writer {
        test: "cases::store::tests::whichever_call_fails_a_case_is_removed_whole_or_not_at_all",
        prepare: &|folder| {
            at(folder).keep(&scene, about("door")).expect("kept");
        },
        write: &|folder| {
            let removed = at(folder).remove("door");
            removed.map(|_| ()).map_err(|error| with_advice(&error))
        },
        state: &|folder| {
            let list = at(folder).list().expect("listed");
            assert!(list.problems.is_empty(), "{:?}", list.problems);
            let in_trash = folder.join("cases").join(TRASH).join("door").join(CRUMB);
            assert!(
                !list.cases.is_empty() || in_trash.is_file(),
                "the case is lost"
            );
            list.cases.len().to_string()
        },
        between: &[],
    }
    .fails_at_every_call();
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_case_has_its_old_truth_or_the_new() {
    use files::disk::faults::{Writer, with_advice};

    let scene = crumb();
    let at = |folder: &Path| CaseFolder::at(folder.join("cases"));
    Writer {
        test: "cases::store::tests::whichever_call_fails_a_case_has_its_old_truth_or_the_new",
        prepare: &|folder| {
            at(folder).keep(&scene, about("door")).expect("kept");
        },
        write: &|folder| {
            let changed = at(folder).set_truth("door", Truth::NotEnrolled);
            changed.map(|_| ()).map_err(|error| with_advice(&error))
        },
        state: &|folder| {
            let list = at(folder).list().expect("listed");
            assert!(list.problems.is_empty(), "{:?}", list.problems);
            format!("{:?}", list.cases[0].meta.about.truth)
        },
        between: &[],
    }
    .fails_at_every_call();
}
