//! Test fixtures: scenes, frames, clouds, libraries, inspections of a history.
//!
//! Shared by the unit tests (`crate::kit`) and the tests of this folder.

#![allow(dead_code, reason = "every test program uses some of it")]

use std::{env, ffi::OsString, fs, path::Path, process::Command, sync::Arc, time::Instant};

use image::RgbImage;
use jiff::{SignedDuration, Timestamp};
use nalgebra::{Point3, Vector3};
use partsight::{
    Advice as _,
    capture::{Captured, Image},
    files::save_cloud,
    geometry::{
        cloud::PointCloud,
        depth_frame::{DepthFrame, Intrinsics},
        mesh::TriangleMesh,
        rigid::{RigidTransform, from_euler_zyx, row_major},
    },
    history::{
        History, HungId, InspectionDetail, NewEntry, Record, StoredRefusal, StoredVerdict, Summary,
        Traceability,
    },
    library::{Library, LibraryFolder},
    pipeline::{Recipe, RecipeLabel, Refusal, Rejection, Unrecognisable},
    simulate::{CellSetup, PartKind, PartPose, PoseRange, SensorNoise, Side, frame, frame_of_mesh},
    stages::{
        contour::ContourError,
        pose::{Axis, CloudRole, FreeMotion, PoseError},
        project::ProjectError,
        reference::{Coverage, Reference, ReferenceParams},
        scene::{SceneCloud, scene_from_frame},
        segment::NoPart,
        signature::SignatureError,
    },
    units::Metres,
};
use proptest::prelude::*;

/// Loads the eight shipped parts.
pub(crate) fn shipped_library() -> Library {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference_parts");
    let folder = LibraryFolder::open(&path).expect("the shipped parts");
    let load = folder.load(&ReferenceParams::default()).expect("loaded");
    load.library
}

/// Copies the shipped parts into a new folder, for a test to change.
pub(crate) fn copy_library(to: &Path) {
    for part in fs::read_dir("reference_parts").expect("the shipped parts") {
        let from = part.expect("a part").path();
        if from.is_dir() {
            let to = to.join(from.file_name().expect("a name"));
            fs::create_dir_all(&to).expect("made");
            for file in fs::read_dir(from).expect("listed") {
                let file = file.expect("a file").path();
                fs::copy(&file, to.join(file.file_name().expect("a name"))).expect("copied");
            }
        }
    }
}

/// Enrols a copy of a part of this library as another reference of it, without a title.
pub(crate) fn add_reference(library: &Path, part: &str, name: &str) {
    let (from, to) = (library.join(part), library.join(name));
    fs::create_dir(&to).expect("made");
    for file in ["cloud.ply", "signature.json", "thumbnail.png"] {
        fs::copy(from.join(file), to.join(file)).expect("copied");
    }
    let meta = fs::read_to_string(from.join("part.toml")).expect("read");
    let lines = meta.lines().map(|line| match line.split_once(" = ") {
        Some(("name", _)) => format!("name = \"{name}\"\npart = \"{part}\"\n"),
        Some(("title", _)) => String::new(),
        _ => format!("{line}\n"),
    });
    let lines: Vec<String> = lines.collect();
    fs::write(to.join("part.toml"), lines.concat()).expect("written");
}

/// The scene of a simulated frame.
pub(crate) fn scene_of(setup: &CellSetup) -> SceneCloud {
    scene_from_frame(&frame(setup).frame)
}

/// The scene of a part that faces the camera.
pub(crate) fn facing_part(kind: PartKind, side: Side, seed: u64) -> SceneCloud {
    let mut setup = CellSetup::with_part(kind, side, 0, seed);
    setup.pose = PartPose::Drawn(PoseRange::facing());
    scene_of(&setup)
}

/// Writes the view of a still fender from a camera moved back by `back` metres, with the noise of this seed.
pub(crate) fn save_fender_view(path: &Path, noise: u64, back: f64) {
    let mut setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 4);
    let standing = frame(&setup).truth.camera_from_part;
    setup.pose = PartPose::Fixed(RigidTransform::translation(0.0, 0.0, back) * standing);
    setup.wall = Metres(setup.wall.0 + back);
    setup.noise = SensorNoise::kinect(noise);
    save_cloud(path, &scene_of(&setup).cloud).expect("written");
}

/// A left part in front of the camera, which moves from the rest pose that its seed draws.
pub(crate) struct HangingPart {
    pub(crate) setup: CellSetup,
    mesh: TriangleMesh,
    rest_pose: RigidTransform,
}

impl HangingPart {
    pub(crate) fn new(kind: PartKind, seed: u64) -> Self {
        let setup = CellSetup::with_part(kind, Side::Left, 0, seed);
        let mesh = setup.subject.mesh();
        let placed = PoseRange::facing().draw(&mesh, &setup.intrinsics, seed);
        Self {
            setup,
            mesh,
            rest_pose: placed.camera_from_part,
        }
    }

    /// A frame of the part, moved by this from its rest pose.
    pub(crate) fn frame(&self, noise: SensorNoise, moved: &RigidTransform) -> DepthFrame {
        let mut setup = self.setup;
        setup.pose = PartPose::Fixed(moved * self.rest_pose);
        setup.noise = noise;
        frame_of_mesh(&setup, &self.mesh).frame
    }
}

/// A small captured frame with these depths in millimetres.
pub(crate) fn small_frame(width: usize, depth: impl IntoIterator<Item = u16>) -> DepthFrame {
    let depth: Vec<u16> = depth.into_iter().collect();
    DepthFrame {
        intrinsics: Intrinsics {
            width,
            height: depth.len() / width,
            ..Intrinsics::KINECT
        },
        metres_per_unit: 0.001,
        depth,
        is_simulated: false,
    }
}

/// A plate of 0.8 by 0.48 m, square to the camera at a distance of 1.2 m.
pub(crate) fn plate() -> Reference {
    let points: Vec<Point3<f32>> = (0..101 * 61)
        .map(|i| {
            let (column, row) = ((i % 101) as f32, (i / 101) as f32);
            Point3::new(column * 0.008 - 0.4, row * 0.008 - 0.24, 1.2)
        })
        .collect();
    let cloud = PointCloud {
        normals: Some(vec![-Vector3::z(); points.len()]),
        points,
        ..PointCloud::default()
    };
    let params = ReferenceParams::default();
    Reference::prepare("plate", cloud, Coverage::OneSide, &params).expect("an outline")
}

/// The cloud's points, transformed.
pub(crate) fn moved(cloud: &PointCloud, by: &RigidTransform) -> PointCloud {
    PointCloud::from_points(cloud.points.iter().map(|p| (by * p.cast::<f64>()).cast()))
}

/// Generates points at most 1 m from the origin along each axis.
pub(crate) fn any_point() -> impl Strategy<Value = Point3<f32>> {
    prop::array::uniform3(-1.0_f32..1.0).prop_map(Point3::from)
}

/// The time this many seconds after a fixed one.
pub(crate) fn moment(seconds: i64) -> Timestamp {
    let first: Timestamp = "2026-03-01T06:00:00Z".parse().expect("a time");
    first + SignedDuration::from_secs(seconds)
}

/// A scene small enough to be written many times, different for every seed.
pub(crate) fn small_scene(seed: u16) -> Arc<SceneCloud> {
    let depth = (0..32 * 24_u32).map(|i| (900 + (i * 7 + u32::from(seed) * 13) % 400) as u16);
    Arc::new(scene_from_frame(&small_frame(32, depth)))
}

/// A capture of one pixel, arriving now.
pub(crate) fn captured(number: u64, taken_at: Timestamp) -> Captured {
    Captured {
        number,
        name: format!("frame {number}"),
        taken_at,
        arrived: Instant::now(),
        image: Image::Depth(small_frame(1, [1])),
        is_simulated: false,
        truth: None,
        robot_from_flange: None,
        warnings: Vec::new(),
    }
}

/// Returns the fields below this heading of a CSV table without line breaks in its fields.
pub(crate) fn csv_column(table: &str, heading: &str) -> Vec<String> {
    let mut rows = table.lines().map(csv_fields);
    let headings = rows.next().expect("a heading");
    let place = headings.iter().position(|name| name == heading);
    let place = place.unwrap_or_else(|| panic!("no {heading} among {headings:?}"));
    rows.map(|mut fields| fields.swap_remove(place)).collect()
}

/// Splits a line at the commas outside of quotation marks.
fn csv_fields(line: &str) -> Vec<String> {
    let pieces: Vec<&str> = line.split('"').collect();
    let (mut fields, mut field) = (Vec::new(), String::new());
    for (place, piece) in pieces.iter().enumerate() {
        if place % 2 == 1 {
            // Within quotation marks.
            field.push_str(piece);
        } else if piece.is_empty() && place > 0 && place + 1 < pieces.len() {
            // Two quotation marks within a field stand for one.
            field.push('"');
        } else {
            for (number, text) in piece.split(',').enumerate() {
                if number > 0 {
                    fields.push(std::mem::take(&mut field));
                }
                field.push_str(text);
            }
        }
    }
    fields.push(field);
    fields
}

/// A history entry for an inspection at that time.
pub(crate) fn history_entry(seconds: i64, verdict: StoredVerdict, part: &str) -> NewEntry {
    let is_named = matches!(verdict, StoredVerdict::Accepted | StoredVerdict::Rejected);
    let recipe = Recipe::default();
    let camera_from_part = from_euler_zyx([0.1, 0.2, 0.3, 0.01, 0.02, 1.4]);
    let line = format!(
        r#"{{"schema":1,"pose":{{"reference":"{part}","camera_from_part":{:?},"rms_m":{}}},"timings_ms":{{"pose":20.5,"total":31.5,"segment":8.0}}}}"#,
        row_major(&camera_from_part),
        0.001 + 1e-4 * seconds as f64,
    );
    NewEntry {
        record: Record {
            summary: Summary {
                number: 0,
                at: moment(seconds),
                scene: format!("frame {seconds}"),
                source: "simulated".into(),
                is_simulated: true,
                verdict,
                part: is_named.then(|| part.to_owned()),
                title: part.replace('_', " "),
                score: (verdict != StoredVerdict::NoPart).then_some([0.97, 0.25]),
                total_ms: 31.5,
                remark: String::new(),
                label: None,
                frame_bytes: None,
                trace: Traceability::default(),
                hung: HungId::new(),
                parent: None,
                num_below: 0,
            },
            detail: InspectionDetail {
                nearest: Some(part.to_owned()),
                // As written by an earlier version of the program.
                refusal: Some(StoredRefusal {
                    reason: "too low".into(),
                    advice: "look again".into(),
                    why: None,
                })
                .filter(|_| verdict != StoredVerdict::Accepted),
                camera_from_part: Some(camera_from_part),
                recipe_label: Some(RecipeLabel::default()),
                recipe_identity: recipe.identity(),
                recipe: Some(Arc::new(recipe)),
                library_identity: "0badcafe".into(),
                program: "0.1.0".into(),
                line,
                thumbnail: Vec::new(),
                origin: Some("{}".into()),
                frame: None,
            },
        },
        picture: Some(RgbImage::from_pixel(16, 12, image::Rgb([200, 150, 40]))),
        scene: Some(small_scene(seconds as u16)),
        shots: Vec::new(),
        stands_for_part: false,
    }
}

/// The reason for a refusal as the history stores it.
pub(crate) fn refusal(why: impl Into<Refusal>) -> StoredRefusal {
    let why = why.into();
    StoredRefusal {
        reason: why.to_string(),
        advice: why.advice(),
        why: Some(why),
    }
}

/// The refusal of a part whose score is too low.
pub(crate) fn low_score(part: &str, score: f64) -> StoredRefusal {
    refusal(Rejection::LowScore {
        part: part.to_owned(),
        score,
        threshold: 0.9,
    })
}

/// Opens the history in this folder, and checks that it is undamaged.
pub(crate) fn open_history(folder: &Path) -> History {
    let opened = History::open(folder).expect("opened");
    assert_eq!(opened.set_aside, None);
    opened.history
}

/// Creates a history in a new folder.
pub(crate) fn new_history() -> (tempfile::TempDir, History) {
    let folder = tempfile::tempdir().expect("a folder");
    let history = open_history(folder.path());
    (folder, history)
}

/// All free motions of a pose.
pub(crate) const FREEDOMS: [FreeMotion; 7] = [
    FreeMotion::Slide(Axis::Long),
    FreeMotion::Slide(Axis::Short),
    FreeMotion::Slide(Axis::Normal),
    FreeMotion::Turn(Axis::Long),
    FreeMotion::Turn(Axis::Short),
    FreeMotion::Turn(Axis::Normal),
    FreeMotion::Anyhow,
];

/// Every kind of pose error.
pub(crate) fn pose_errors() -> Vec<PoseError> {
    let [found, needed] = [3, 12];
    let which = CloudRole::Source;
    vec![
        PoseError::TooFewPoints {
            which: CloudRole::Target,
            found,
            needed,
        },
        PoseError::Degenerate {
            which,
            width: 0.000_125,
        },
        PoseError::OneSidedPairs {
            num_pairs: 40,
            rms: Metres(0.0123),
        },
        PoseError::NoOverlap {
            found,
            needed,
            reach: Metres(0.05),
        },
        PoseError::SizesDiffer { ratio: 999.6 },
        PoseError::TooFarOut {
            which,
            distance: Metres(123_456.7),
        },
        PoseError::NoReferenceCloud,
        PoseError::Cancelled,
    ]
}

/// Every rejection; those with several texts more than once.
pub(crate) fn rejections() -> Vec<Rejection> {
    let part = "Fender, left".to_owned();
    let (score, threshold, margin) = (0.456, 0.9, 0.125);
    let [num_agreeing, num_frames, needed] = [2, 5, 4];
    let piece = |hidden, outside| Rejection::Piece {
        part: "Fender, left".into(),
        score,
        threshold,
        hidden,
        outside,
    };
    let mut all = vec![
        Rejection::LowScore {
            part: part.clone(),
            score,
            threshold,
        },
        piece(0.4, 0.0),
        piece(0.0, 0.4),
        piece(0.2, 0.2),
        Rejection::HardlySeen {
            part: part.clone(),
            score,
        },
        Rejection::AnotherModel {
            part: part.clone(),
            relief: Metres(0.0042),
            outline: Metres(0.0119),
            missing: 0.0123,
        },
        Rejection::AnotherMake {
            part: part.clone(),
            likeness: 0.7,
        },
        Rejection::AmbiguousPose {
            part: part.clone(),
            margin,
            threshold,
        },
        Rejection::Uncertain {
            part: part.clone(),
            shift: Metres(0.0213),
            limit: Metres(0.015),
        },
        Rejection::Unknown {
            nearest: part.clone(),
            score,
        },
        Rejection::Mirrored {
            part: part.clone(),
            score,
        },
        Rejection::MirroredImage {
            part: part.clone(),
            score,
        },
        Rejection::SmallMargin {
            part: part.clone(),
            other: "Grille".into(),
            margin,
            threshold,
        },
        Rejection::Unconfirmed { part: part.clone() },
        Rejection::OutOfRange {
            part: part.clone(),
            depth: Metres(31.456),
        },
        Rejection::BehindCamera {
            part: part.clone(),
            share: 0.0321,
        },
        Rejection::SurplusBytes {
            part: part.clone(),
            num: 4096,
        },
        Rejection::NotSteady { part: part.clone() },
        Rejection::FewFrames {
            part: part.clone(),
            num_frames,
            needed,
        },
        Rejection::Undecided {
            part: part.clone(),
            num_agreeing,
            num_frames,
            needed,
        },
        Rejection::PosesApart {
            part: part.clone(),
            num_agreeing,
            num_frames,
            needed,
        },
    ];
    all.extend(FREEDOMS.map(|freedom| Rejection::Unconstrained {
        part: part.clone(),
        freedom,
    }));
    all.extend(pose_errors().into_iter().map(Rejection::NoPose));
    all
}

/// Every unrecognisable scene except a fault of the program; those with several texts more than once.
pub(crate) fn unrecognisables() -> Vec<Unrecognisable> {
    let only_background = |knows_cell| {
        Unrecognisable::NoPart(NoPart::OnlyBackground {
            planes: 2,
            found: 0.0123,
            needed: 0.02,
            knows_cell,
        })
    };
    vec![
        NoPart::TooFewPoints {
            found: 12,
            needed: 200,
        }
        .into(),
        NoPart::TooWide { extent: 1234.5 }.into(),
        only_background(false),
        only_background(true),
        ProjectError::NoPlane {
            num_points: 5,
            width: 0.000_12,
        }
        .into(),
        ProjectError::TooLarge {
            found: 21.04,
            limit: 10.0,
        }
        .into(),
        ContourError::NoShape { num_set: 7 }.into(),
        SignatureError::NoOutline { num_points: 1 }.into(),
        Unrecognisable::EmptyLibrary,
    ]
}

/// Options of [`compile_c`] that make a shared library.
pub(crate) const SHARED: [&str; 2] = ["-shared", "-fPIC"];

/// Compiles a C file of this package to a program, or with [`SHARED`] to a library. The error says what this machine
/// lacks.
pub(crate) fn compile_c(source: &str, made: &Path, options: &[&str]) -> Result<(), String> {
    let compiler = env::var_os("CC").unwrap_or_else(|| OsString::from("cc"));
    let output = Command::new(compiler)
        .args(["-Wall", "-Wextra", "-Werror", "-pthread"])
        .args(options)
        .arg("-o")
        .arg(made)
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join(source))
        .arg("-ldl")
        .output()
        .map_err(|error| format!("no C compiler: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    // Missing headers of the C library are a fault of the machine; any other error is a fault of the file.
    assert!(said.contains("No such file or directory"), "{said}");
    Err("no C headers".into())
}

/// Checks a value against a JSON schema, as far as the published schemas use its keywords.
pub(crate) fn conforms(
    value: &serde_json::Value,
    schema: &serde_json::Value,
    root: &serde_json::Value,
) -> Result<(), String> {
    let wrong = |why: &str| Err(format!("{why}: {value} against {schema}"));
    if let Some(reference) = schema.get("$ref").and_then(|reference| reference.as_str()) {
        let pointer = reference.trim_start_matches('#');
        return conforms(
            value,
            root.pointer(pointer).ok_or("a dangling reference")?,
            root,
        );
    }
    for any in ["anyOf", "oneOf"] {
        if let Some(choices) = schema.get(any).and_then(|choices| choices.as_array()) {
            return if choices
                .iter()
                .any(|choice| conforms(value, choice, root).is_ok())
            {
                Ok(())
            } else {
                wrong(any)
            };
        }
    }
    if let Some(only) = schema.get("const") {
        return if only == value {
            Ok(())
        } else {
            wrong("const")
        };
    }
    if let Some(choices) = schema.get("enum").and_then(|choices| choices.as_array()) {
        return if choices.contains(value) {
            Ok(())
        } else {
            wrong("enum")
        };
    }
    let is = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        _ => false,
    };
    let fits = match schema.get("type") {
        Some(serde_json::Value::String(name)) => is(name),
        Some(serde_json::Value::Array(names)) => {
            names.iter().filter_map(|name| name.as_str()).any(is)
        }
        _ => true,
    };
    if !fits {
        return wrong("type");
    }
    if let (Some(fields), Some(properties)) = (
        value.as_object(),
        schema.get("properties").and_then(|p| p.as_object()),
    ) {
        for required in schema
            .get("required")
            .and_then(|r| r.as_array())
            .into_iter()
            .flatten()
        {
            let name = required.as_str().unwrap_or_default();
            if !fields.contains_key(name) {
                return wrong(name);
            }
        }
        for (name, field) in fields {
            let property = properties
                .get(name)
                .ok_or_else(|| format!("{name} is not in the schema"))?;
            conforms(field, property, root)?;
        }
    }
    if let (Some(items), Some(each)) = (value.as_array(), schema.get("items")) {
        for item in items {
            conforms(item, each, root)?;
        }
    }
    Ok(())
}
