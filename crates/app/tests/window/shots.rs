//! Scans in the window: the list of shots in Inspect and Enrol. Needs no graphics adapter.

use std::{
    fs,
    ops::ControlFlow,
    path::{Path, PathBuf},
};

use app::{WindowOptions, shots::ShotsFile, workspaces::inspect::InspectFile};
use egui::{Key, Modifiers, Vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use files::write_depth_png;
use geometry::{
    depth_frame::DepthFrame,
    rigid::{RigidTransform, row_major},
    units::{Metres, Radians},
};
use inspection::library::{EnrolParams, LibraryFolder, PartDescription, PartName, enrol_scan};
use robot::scan_frames::{read_frames, with_poses};
use serde_json::{Value, json};
use shell::{
    action::Action,
    inspection::scan::{FusedShots, ShotFate},
    session::{Source, WorkspaceKind},
    state::State,
};
use simulate::{PartKind, ScanSetup, Side, SimulatedObject, SimulatedScan};

use stages::scan::{ScanParams, Unwatched, assemble_all};

use super::set_up::{
    SMALL, USUAL, WindowHarness, act, choose_in_inspect, drop_file, enrol_of, inspect_of,
    open_with, plain_options, press, settle,
};

/// A folder with a simulated scan of a fender: `num` shots and their poses, and one more that the poses do not name.
pub(crate) struct ScanFolder {
    folder: tempfile::TempDir,
}

impl ScanFolder {
    pub(crate) fn new(num: usize) -> Self {
        let made = Self {
            folder: tempfile::tempdir().expect("a folder"),
        };
        let scan = SimulatedScan::new(ScanSetup {
            subject: SimulatedObject::Part {
                kind: PartKind::Fender,
                side: Side::Left,
                model_seed: 0,
            },
            num_shots: num + 1,
            place_error: Metres::from_mm(3.0),
            turn_error: Radians(0.005),
            noise: 0.5,
            seed: 3,
        });
        fs::create_dir_all(made.scan()).expect("made");
        let mut poses = serde_json::Map::new();
        for (index, shot) in scan.shots().iter().enumerate() {
            let frame = coarse(&shot.frame);
            if index == num {
                let path = made.path("spare/shot-9.png");
                fs::create_dir_all(made.path("spare")).expect("made");
                write_depth_png(&path, &frame).expect("written");
                let poses = json!({"frames": {"shot-9.png": entry(&shot.given)}});
                fs::write(made.path("spare/poses.json"), poses.to_string()).expect("written");
                continue;
            }
            let name = format!("shot-{}.png", index + 1);
            write_depth_png(&made.scan().join(&name), &frame).expect("written");
            poses.insert(name, entry(&shot.given));
        }
        made.write_poses(&json!({ "frames": poses }));
        made
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn scan(&self) -> PathBuf {
        self.path("fender")
    }

    fn write_poses(&self, poses: &Value) {
        fs::write(self.scan().join("poses.json"), poses.to_string()).expect("written");
    }

    fn change_poses(&self, change: impl FnOnce(&mut Value)) {
        let text = fs::read_to_string(self.scan().join("poses.json")).expect("written");
        let mut poses: Value = serde_json::from_str(&text).expect("JSON");
        change(&mut poses["frames"]);
        self.write_poses(&poses);
    }
}

fn entry(pose: &RigidTransform) -> Value {
    json!({ "world_from_camera": row_major(pose) })
}

/// Keeps every other row and column, to be four times as fast.
fn coarse(frame: &DepthFrame) -> DepthFrame {
    let mut intrinsics = frame.intrinsics;
    let width = intrinsics.width;
    intrinsics.width /= 2;
    intrinsics.height /= 2;
    for number in [
        &mut intrinsics.fx,
        &mut intrinsics.fy,
        &mut intrinsics.cx,
        &mut intrinsics.cy,
    ] {
        *number /= 2.0;
    }
    let rows = frame.depth.chunks(width).step_by(2);
    DepthFrame {
        intrinsics,
        depth: rows
            .flat_map(|row| row.iter().step_by(2).copied())
            .collect(),
        ..frame.clone()
    }
}

fn open_at(size: Vec2, scene: &Path, library: Option<&Path>) -> WindowHarness {
    let options = WindowOptions {
        scene: Some(scene.to_owned()),
        library: Some(
            library
                .unwrap_or(Path::new(::inspection::fixtures::SHIPPED_PARTS))
                .to_owned(),
        ),
        ..plain_options()
    };
    open_with(size, options)
}

fn state(harness: &WindowHarness) -> &State {
    harness.state().state()
}

/// The scan in front.
fn fused(harness: &WindowHarness) -> &FusedShots {
    let fused = if state(harness).session.workspace == WorkspaceKind::Enrol {
        let draft = enrol_of(harness).draft.as_ref();
        draft.expect("a draft").subject.scan()
    } else {
        let shown = state(harness).session.shown.as_ref().expect("a result");
        shown.inspected.scan.as_ref().map(|scan| &scan.fused)
    };
    fused.expect("a scan")
}

/// Indices of the shots that the result rests on.
fn used(harness: &WindowHarness) -> Vec<usize> {
    let rows = fused(harness).rows.iter().enumerate();
    rows.filter(|(_, row)| matches!(row.fate, ShotFate::Used { .. }))
        .map(|(index, _)| index)
        .collect()
}

fn press_keys(harness: &mut WindowHarness, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    settle(harness);
}

/// Contents of the files of an enrolled part, without the time of enrolment.
fn stored(part: &Path) -> (String, [Vec<u8>; 3]) {
    let toml = fs::read_to_string(part.join("part.toml")).expect("a part");
    let lines = toml.lines().filter(|line| !line.starts_with("at = "));
    let files = ["cloud.ply", "signature.json", "thumbnail.png"];
    (
        lines.collect::<Vec<_>>().join("\n"),
        files.map(|file| fs::read(part.join(file)).expect("a file")),
    )
}

#[test]
fn a_scan_is_listed_shots_are_dropped_and_taken_back_and_it_is_inspected_as_one() {
    let scan = ScanFolder::new(3);
    let mut harness = open_at(USUAL, &scan.scan(), None);
    // The verdict from all shots, and the contribution of each.
    harness.get_by_label("Fender, left");
    harness.get_by_label_contains("3 shots · they agree to");
    assert_eq!(used(&harness), [0, 1, 2]);
    for row in &fused(&harness).rows {
        assert!(row.seen > 0.2 && row.only < row.seen, "{row:?}");
        let ShotFate::Used { moved, rms, .. } = row.fate else {
            panic!("{row:?}");
        };
        assert!(moved.shift.mm() < 20.0 && rms.is_some_and(|rms| rms.mm() < 10.0));
    }
    let all_three = fused(&harness).scan.cloud.cloud.points.len();
    press(&mut harness, "Mark what shot 2 alone sees");
    assert_eq!(inspect_of(&harness).shots.looked_at, Some(1));

    let hung = |harness: &WindowHarness| {
        let shown = state(harness).session.shown.as_ref().expect("a result");
        shown.inspected.entry.record.summary.hung.clone()
    };
    let before = hung(&harness);
    press(&mut harness, "Use shot-2.png");
    assert_eq!(used(&harness), [0, 2]);
    assert_eq!(hung(&harness), before, "it is the same part");
    assert!(fused(&harness).scan.cloud.cloud.points.len() < all_three);
    harness.get_by_label_contains("2 of 3 shots used");
    // The result stays if too few shots are left for a scan.
    press(&mut harness, "Use shot-1.png");
    harness.get_by_label_contains("A scan needs at least 2 shots");
    assert_eq!(used(&harness), [0, 2]);

    press_keys(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(used(&harness), [0, 1, 2]);
    assert_eq!(fused(&harness).scan.cloud.cloud.points.len(), all_three);
    // A cancelled change leaves the shot as before.
    harness.get_by_label("Use shot-3.png").click();
    harness.run_steps(2);
    let is_dropped = |harness: &WindowHarness| {
        let choice = inspect_of(harness).shot_choice(&state(harness).session);
        let choice = choice.expect("a scan");
        choice.dropped.contains(&2)
    };
    assert!(is_dropped(&harness));
    press(&mut harness, "Cancel");
    assert!(!is_dropped(&harness));
    assert_eq!(used(&harness), [0, 1, 2]);
    press(&mut harness, "Redo the change of the shots");
    assert_eq!(used(&harness), [0, 2]);
    // Dropped shots are stored with the source until they are restored.
    let Source::Scan(files) = &state(&harness).session.source else {
        panic!("{:?}", state(&harness).session.source);
    };
    assert!(files.dropped.contains("shot-2.png"));

    // Add a shot whose pose is in a file beside it.
    let spare = scan.path("spare/shot-9.png");
    choose_in_inspect(
        &mut harness,
        InspectFile::Shots(ShotsFile::Shot),
        spare.clone(),
    );
    assert_eq!(used(&harness), [0, 2, 3]);
    assert_eq!(hung(&harness), before);
    choose_in_inspect(&mut harness, InspectFile::Shots(ShotsFile::Shot), spare);
    harness.get_by_label_contains("shot-9.png is among the shots already");
    assert_eq!(used(&harness), [0, 2, 3]);
    press(&mut harness, "Stages");
    harness.get_by_label("Enlarge ranking");
}

/// Enrols the fender from the frames of a scan.
fn enrol(paths: &[PathBuf], library: &Path) {
    let frames = read_frames(paths, &mut |_| ControlFlow::Continue(())).expect("frames");
    let shots = with_poses(paths, None, frames, || Ok(None)).expect("poses");
    let scan = assemble_all(shots, &ScanParams::default(), &Unwatched).expect("a scan");
    let about = PartDescription {
        name: PartName::new("fender").expect("a name"),
        title: "Fender".into(),
        notes: String::new(),
        from: "fender".into(),
        at: geometry::clock::now(),
        simulated: scan.cloud.cloud.is_simulated,
    };
    let enrolled = enrol_scan(&scan, &about, &EnrolParams::default()).expect("a part");
    let folder = LibraryFolder::open_or_create(library).expect("a library");
    folder.save(&enrolled.part).expect("stored");
}

#[test]
fn what_is_enrolled_from_a_scan_is_what_the_library_makes_of_it() {
    let scan = ScanFolder::new(3);
    let library = scan.path("window");
    fs::create_dir(&library).expect("made");
    let mut harness = open_at(USUAL, &scan.scan(), Some(&library));
    press(&mut harness, "Enrol");
    press(&mut harness, "Use the inspected scene");
    assert_eq!(used(&harness), [0, 1, 2]);
    harness.get_by_label("Seen from several sides");
    // Dropping a shot is a step that can be undone, like the corrections.
    harness.get_by_label("Use shot-1.png").click();
    harness.run_steps(2);
    let words = harness.get_by_label("To be dropped…").rect();
    assert!(words.max.y <= USUAL.y - 10.0, "cut off: {words:?}");
    settle(&mut harness);
    assert_eq!(used(&harness), [1, 2]);
    press_keys(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(used(&harness), [0, 1, 2]);

    let draft = |harness: &WindowHarness| {
        let draft = enrol_of(harness).draft.as_ref();
        draft.expect("a draft").selection.indices.len()
    };
    let kept = draft(&harness);
    press(&mut harness, "Part, kept");
    assert_eq!(draft(&harness), 0);
    press(&mut harness, "Undo the last step");
    assert_eq!(draft(&harness), kept);

    let field = harness.get_by_role_and_label(egui::Role::TextInput, "Title");
    field.focus();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(egui::Role::TextInput, "Title")
        .type_text("Fender");
    harness.run_steps(3);
    press(&mut harness, "Save");
    let by_library = scan.path("library");
    enrol(&[scan.scan()], &by_library);
    let toml = stored(&library.join("fender"));
    assert!(toml.0.contains("coverage = \"several_sides\"") && toml.0.contains("num_shots = 3"));
    assert_eq!(toml, stored(&by_library.join("fender")));
    assert!(enrol_of(&harness).draft.is_none());
}

#[test]
fn a_scan_that_cannot_be_put_together_is_said_and_the_former_result_stays() {
    let scan = ScanFolder::new(2);
    let mut harness = open_at(USUAL, &scan.scan(), None);
    assert_eq!(used(&harness), [0, 1]);
    let refused = |harness: &mut WindowHarness, expected: &str| {
        act(harness, Action::Open(scan.scan()));
        let notice = state(harness).notices.last().expect("said").clone();
        assert!(notice.what.contains(expected), "{notice:?}");
        assert!(!notice.advice.is_empty());
        assert_eq!(used(harness), [0, 1], "{expected}");
    };
    scan.change_poses(|poses| {
        let across = &mut poses["shot-2.png"]["world_from_camera"][3];
        *across = json!(across.as_f64().expect("a number") + 0.3);
    });
    refused(&mut harness, "no two of the 2 frames agree");
    scan.change_poses(|poses| {
        poses["shot-2.png"]["world_from_camera"][11] = json!(11.0);
    });
    refused(&mut harness, "no two of the 2 frames overlap");
    scan.change_poses(|poses| poses["shot-2.png"]["world_from_camera"][0] = json!(3.0));
    refused(&mut harness, "shot-2.png: the matrix is not rigid");
    scan.change_poses(|poses| poses["shot-2.png"]["world_from_camera"] = json!([1, 2]));
    refused(&mut harness, "2 numbers, expected the 16");
    fs::write(
        scan.scan().join("poses.json"),
        "{\"frames\": {\"shot-1.png\": NaN}}",
    )
    .expect("written");
    refused(&mut harness, "expected {\"frames\"");
    fs::remove_file(scan.scan().join("shot-2.png")).expect("removed");
    let spare = fs::read_to_string(scan.path("spare/poses.json")).expect("written");
    let spare: Value = serde_json::from_str(&spare).expect("JSON");
    scan.write_poses(&json!({"frames": {"shot-1.png": spare["frames"]["shot-9.png"].clone()}}));
    refused(&mut harness, "at least 2 frames, found 1");
    fs::remove_file(scan.scan().join("shot-1.png")).expect("removed");
    refused(&mut harness, "neither a recording nor a camera's file");
}

#[test]
fn in_a_small_window_every_control_of_a_scan_is_large_enough_and_has_a_name() {
    let scan = ScanFolder::new(2);
    let mut harness = open_at(SMALL, &scan.scan(), None);
    // Open the scan by a drop, as well as by the command line.
    press(&mut harness, "Enrol");
    drop_file(&mut harness, &scan.scan());
    assert_eq!(used(&harness), [0, 1]);
    for workspace in [WorkspaceKind::Enrol, WorkspaceKind::Inspect] {
        act(&mut harness, Action::GoTo(workspace));
        for role in [egui::Role::Button, egui::Role::Tab, egui::Role::CheckBox] {
            for node in harness.query_all_by_role(role) {
                let label = node.accesskit_node().label().unwrap_or_default();
                let rect = node.rect();
                assert!(!label.is_empty(), "a control at {rect:?} has no name");
                assert!(
                    rect.width() >= 35.9 && rect.height() >= 35.9,
                    "{label}: {rect:?}"
                );
                // The card scrolls, so its controls may lie further below.
                assert!(rect.min.x >= 0.0 && rect.min.y >= 0.0, "{label}: {rect:?}");
            }
        }
        for shot in ["Use shot-1.png", "Use shot-2.png", "Add a shot…"] {
            let rect = harness.get_by_label(shot).rect();
            assert!(
                rect.max.x <= SMALL.x && rect.max.y <= SMALL.y,
                "{shot}: {rect:?}"
            );
        }
    }
}
