//! Frames of a real paint shop, with the robot's poses.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::OnceLock,
};

use nalgebra::Point3;
use partsight::{
    files::{FileContent, open},
    geometry::{
        cloud::{PointCloud, is_finite},
        parallel::{map_each, num_cores},
        rigid::{RigidTransform, from_row_major, pose_error},
    },
    library::{
        EnrolError, EnrolParams, EnrolWarning, Library, PartDescription, PartName, enrol_captured,
        enrol_surface, likenesses, surfaces_to_enrol,
    },
    pipeline::{
        BUILT_IN_RECIPES, Inspection, PoseChoice, Recipe, Unwatched, Verdict, built_in_recipe,
        measure_surface, run,
    },
    robot::cell_check::{CellBaseline, CellFinding, CellLimits, CellView},
    stages::{
        deviation::DeviationParams,
        pose::{PoseEstimate, PoseMethod},
        scene::{SceneCloud, scene_from_cloud, scene_from_frame},
        segment::{PointLabel, SegmentParams, SegmentedPart, segment},
    },
};

use crate::{data_folder, kit::shipped_library};

/// Outlines of the part, drawn by hand in the depth pictures: column and row of each corner.
#[rustfmt::skip]
const MASKS: [(&str, &[[i32; 2]]); 8] = [
    (
        "left2_00",
        &[[88, 238], [161, 224], [222, 209], [234, 202], [239, 186], [246, 176], [254, 152], [275, 144], [287, 137], [301, 128], [308, 130], [323, 139], [344, 148], [349, 150], [340, 159], [334, 169], [330, 181], [328, 212], [325, 262], [323, 302], [321, 323], [323, 353], [328, 373], [333, 393], [338, 416], [328, 426], [302, 430], [297, 428], [282, 413], [262, 396], [237, 383], [212, 374], [186, 369], [156, 366], [121, 366], [83, 366], [86, 353], [87, 323], [88, 282]],
    ),
    (
        "left2_01",
        &[[77, 94], [83, 90], [108, 85], [151, 81], [222, 78], [302, 75], [373, 74], [413, 72], [428, 68], [443, 58], [454, 45], [461, 33], [479, 23], [491, 20], [511, 20], [524, 26], [535, 34], [538, 38], [529, 46], [522, 58], [515, 76], [509, 98], [501, 123], [494, 146], [486, 166], [479, 186], [469, 212], [460, 237], [451, 267], [446, 287], [441, 291], [436, 302], [402, 302], [404, 282], [401, 252], [393, 237], [378, 219], [360, 204], [338, 194], [307, 186], [272, 182], [237, 182], [207, 189], [181, 199], [164, 209], [151, 215], [144, 209], [136, 204], [121, 197], [108, 181], [96, 171], [80, 156], [83, 151], [96, 141], [108, 130], [112, 118], [108, 110], [96, 103], [81, 101]],
    ),
    (
        "left2_03",
        &[[82, 86], [98, 97], [108, 101], [151, 105], [202, 111], [237, 112], [348, 113], [350, 121], [393, 121], [396, 131], [393, 161], [391, 165], [353, 164], [323, 165], [292, 174], [267, 181], [252, 190], [232, 206], [217, 219], [204, 237], [194, 262], [186, 287], [180, 312], [178, 338], [180, 363], [186, 386], [197, 403], [209, 423], [218, 436], [117, 436], [115, 413], [111, 363], [107, 302], [104, 242], [103, 166], [101, 157], [93, 149], [85, 134], [78, 113], [76, 98]],
    ),
    (
        "left2_06",
        &[[220, 88], [227, 83], [252, 80], [302, 76], [378, 72], [454, 70], [554, 68], [599, 67], [600, 237], [592, 252], [580, 277], [572, 288], [562, 290], [552, 302], [517, 301], [529, 287], [537, 267], [537, 252], [529, 227], [514, 212], [494, 197], [464, 186], [438, 180], [403, 178], [373, 181], [343, 189], [323, 200], [302, 208], [290, 209], [280, 204], [267, 194], [254, 184], [242, 169], [227, 153], [237, 144], [252, 131], [265, 121], [268, 113], [265, 106], [252, 98], [232, 94], [219, 91]],
    ),
    (
        "left2_07",
        &[[302, 270], [312, 267], [353, 267], [428, 270], [504, 272], [554, 273], [597, 275], [598, 403], [590, 398], [564, 391], [534, 381], [504, 377], [474, 377], [438, 380], [413, 388], [393, 396], [373, 400], [358, 396], [348, 388], [340, 378], [328, 365], [315, 353], [306, 335], [323, 328], [343, 317], [355, 307], [355, 302], [350, 292], [328, 285], [310, 280]],
    ),
    (
        "right2_01",
        &[[189, 169], [197, 166], [262, 162], [265, 154], [302, 151], [403, 147], [504, 143], [599, 137], [599, 359], [554, 362], [454, 370], [353, 375], [282, 379], [277, 370], [275, 353], [267, 333], [252, 302], [237, 272], [222, 242], [209, 217], [199, 191], [189, 174]],
    ),
    (
        "right2_04",
        &[[91, 16], [146, 16], [227, 19], [438, 19], [446, 30], [451, 50], [456, 76], [460, 126], [458, 191], [454, 237], [449, 272], [443, 302], [436, 323], [431, 330], [353, 331], [277, 337], [202, 342], [121, 348], [78, 351], [81, 323], [83, 252], [86, 202], [88, 141], [90, 91]],
    ),
    (
        "right2_05",
        &[[85, 167], [151, 160], [323, 151], [364, 150], [358, 131], [348, 98], [340, 78], [353, 76], [383, 92], [418, 115], [441, 132], [447, 155], [479, 155], [486, 164], [496, 189], [501, 227], [500, 272], [493, 312], [481, 340], [459, 373], [403, 372], [302, 377], [202, 382], [101, 392], [88, 388], [76, 379], [80, 312], [82, 252], [85, 202]],
    ),
];

#[derive(serde::Deserialize)]
pub(super) struct Truth {
    reference: BTreeMap<String, String>,
    pub(super) frames: BTreeMap<String, FrameTruth>,
}

#[derive(serde::Deserialize)]
pub(super) struct FrameTruth {
    pub(super) part: String,
    world_from_camera: [f64; 16],
    seen_of_reference: f64,
}

impl Truth {
    pub(super) fn read(booth: &Path) -> Self {
        let truth = std::fs::read(booth.join("truth.json")).expect("the robot's poses");
        serde_json::from_slice(&truth).expect("the robot's poses")
    }

    /// The reference frame of a frame's series.
    fn reference(&self, file: &str) -> &str {
        &self.reference[&file[..file.find('_').expect("a series")]]
    }

    /// The true pose of the part that was enrolled from the reference frame, off by a few millimetres and about 0.3 degrees.
    pub(super) fn camera_from_part(&self, file: &str) -> RigidTransform {
        let reference = &self.frames[self.reference(file)];
        self.frames[file].world_from_camera().inverse() * reference.world_from_camera()
    }
}

impl FrameTruth {
    fn world_from_camera(&self) -> RigidTransform {
        from_row_major(&self.world_from_camera, 1e-3).expect("a rigid transform")
    }
}

/// True within a closed outline (even-odd rule).
fn contains(outline: &[[i32; 2]], u: f64, v: f64) -> bool {
    let corners = outline.iter().map(|corner| corner.map(f64::from));
    let next = corners.clone().cycle().skip(1);
    let is_crossed = |([ax, ay], [bx, by]): &([f64; 2], [f64; 2])| {
        (*ay > v) != (*by > v) && u < ax + (v - ay) / (by - ay) * (bx - ax)
    };
    corners.zip(next).filter(is_crossed).count() % 2 == 1
}

fn scene(path: &Path) -> SceneCloud {
    match open(path) {
        Ok(FileContent::Depth(frame)) => scene_from_frame(&frame),
        other => panic!("{}: {other:?}", path.display()),
    }
}

/// The frames of the booth with the robot's poses, read and inspected once.
pub(super) struct Booth {
    pub(super) folder: PathBuf,
    pub(super) truth: Truth,
    /// The shipped parts, and the fender and the door of the booth, each enrolled from its reference frame.
    pub(super) library: Library,
    /// By the name of the file: the frame, and what the default recipe finds in it.
    pub(super) inspected: BTreeMap<String, (SceneCloud, Inspection)>,
}

impl Booth {
    /// `None`, with a message, without the data.
    pub(super) fn read() -> Option<&'static Self> {
        static READ: OnceLock<Booth> = OnceLock::new();
        let folder = data_folder()?.join("booth");
        Some(READ.get_or_init(|| {
            let truth = Truth::read(&folder);
            let mut library = shipped_library();
            for file in truth.reference.values() {
                let about = about(&format!("booth_{}", truth.frames[file].part));
                let enrolled =
                    enrol_captured(&scene(&folder.join(file)), &about, &EnrolParams::default());
                library.references.push(enrolled.expect("a part").reference);
            }
            let files: Vec<&String> = truth.frames.keys().collect();
            let inspected = map_each(files.len(), num_cores(), |i| {
                let scene = scene(&folder.join(files[i]));
                let found = run(&scene, &library, &Recipe::default(), &Unwatched);
                (files[i].clone(), (scene, found.expect("not cancelled")))
            });
            let inspected = inspected.into_iter().collect();
            Self {
                folder,
                truth,
                library,
                inspected,
            }
        }))
    }
}

#[test]
fn the_part_is_cut_out_of_a_booth_as_a_hand_would() {
    let Some(data) = data_folder() else { return };
    for (name, corners) in MASKS {
        let scene = scene(&data.join(format!("booth/{name}.png")));
        let found = segment(&scene, &SegmentParams::default());
        let width = scene.cloud.grid.expect("a picture").width;
        let (mut both, mut either) = (0.0, 0.0_f64);
        for (i, (point, label)) in scene.cloud.points.iter().zip(&found.labels).enumerate() {
            let is_drawn =
                is_finite(point) && contains(corners, (i % width) as f64, (i / width) as f64);
            let is_found = *label == PointLabel::Part;
            both += f64::from(u8::from(is_drawn && is_found));
            either += f64::from(u8::from(is_drawn || is_found));
        }
        let overlap = both / either;
        assert!(overlap >= 0.95, "{name}: {overlap:.3}");
    }
}

fn about(name: &str) -> PartDescription {
    PartDescription {
        name: PartName::new(name).expect("a name"),
        title: String::new(),
        notes: String::new(),
        from: "booth".into(),
        at: jiff::Timestamp::UNIX_EPOCH,
        simulated: false,
    }
}

#[test]
fn a_curtain_that_hides_nothing_is_not_enrolled_unless_somebody_says_so() {
    let Some(data) = data_folder() else { return };
    let scene = scene(&data.join("booth/left2_05.png"));
    let params = EnrolParams::default();
    let refused = enrol_captured(&scene, &about("curtain"), &params);
    assert!(
        matches!(refused, Err(EnrolError::Background(_))),
        "{:?}",
        refused.err()
    );
    let surfaces = surfaces_to_enrol(&scene, &params).expect("surfaces");
    let mean_depth = |part: &SegmentedPart| {
        let points = &part.cloud.points;
        points.iter().map(|p| f64::from(p.z)).sum::<f64>() / points.len() as f64
    };
    let near = |part: &SegmentedPart| mean_depth(part) < 1.3;
    let fender = surfaces.iter().position(near).expect("the fender");
    let enrolled = enrol_surface(&scene, fender + 1, &about("fender"), &params);
    let warned = enrolled.expect("a part").warnings;
    assert!(
        !warned
            .iter()
            .any(|w| matches!(w, EnrolWarning::Background(_))),
        "{warned:?}"
    );
}

#[test]
fn frames_of_one_part_are_not_told_apart_and_those_of_another_part_are() {
    let Some(data) = data_folder() else { return };
    let frame = |name: &str| {
        let scene = scene(&data.join(format!("booth/{name}.png")));
        let enrolled = enrol_captured(&scene, &about(name), &EnrolParams::default());
        (enrolled.expect("a part"), scene)
    };
    let mut library = shipped_library();
    library.references.push(frame("left2_01").0.reference);
    for name in ["left2_00", "left2_02", "left2_03", "left2_06", "left2_07"] {
        let (enrolled, scene) = frame(name);
        let found = &likenesses(&enrolled, Some(&scene), &library)[0];
        assert!(
            found.other == "left2_01" && !found.is_distinguishable(),
            "{name}: {found:?}"
        );
    }
    for name in ["right2_01", "right2_02", "right2_04", "right2_05"] {
        let (enrolled, scene) = frame(name);
        let found = &likenesses(&enrolled, Some(&scene), &library)[0];
        assert!(found.is_distinguishable(), "{name}: {found:?}");
    }
}

#[test]
fn a_frame_that_shows_too_little_to_be_recognised_in_it_is_warned_of() {
    let Some(data) = data_folder() else { return };
    for (name, is_little) in [("right2_05", false), ("right2_06", true)] {
        let scene = scene(&data.join(format!("booth/{name}.png")));
        let enrolled = enrol_captured(&scene, &about(name), &EnrolParams::default());
        let enrolled = enrolled.expect("a part");
        let is_warned = |warning: &EnrolWarning| matches!(warning, EnrolWarning::TooLittle { .. });
        assert_eq!(enrolled.warnings.iter().any(is_warned), is_little, "{name}");
        let library = Library {
            references: vec![enrolled.reference],
            ..Library::default()
        };
        let found = run(&scene, &library, &Recipe::default(), &Unwatched).expect("not cancelled");
        assert_eq!(found.verdict.is_accepted(), !is_little, "{name}");
    }
}

#[test]
fn a_list_of_points_is_accepted_in_spite_of_stray_points_and_copies() {
    let Some(data) = data_folder() else { return };
    let frame = scene(&data.join("booth/left2_01.png"));
    let enrolled = enrol_captured(&frame, &about("fender"), &EnrolParams::default());
    let mut library = Library::default();
    library.references.push(enrolled.expect("a part").reference);
    let points: Vec<Point3<f32>> = frame.cloud.finite().map(|(_, p)| *p).collect();
    let of_lists = [
        vec![],
        vec![Point3::origin()],
        vec![Point3::origin(); 100_000],
        vec![Point3::new(3.0, 0.0, 0.5)],
        vec![Point3::new(0.0, 0.0, -0.5)],
        points.clone(),
    ];
    for others in of_lists {
        let num = others.len();
        let all = points.iter().copied().chain(others);
        let scene = scene_from_cloud(PointCloud::from_points(all));
        let found = run(&scene, &library, &Recipe::default(), &Unwatched).expect("not cancelled");
        assert!(found.verdict.is_accepted(), "{num}: {:?}", found.verdict);
    }
}

#[test]
fn parts_of_a_booth_are_named_and_placed_where_the_robot_says() {
    let Some(booth) = Booth::read() else { return };
    let truth = &booth.truth;
    let (mut num_named, mut num_accepted, mut num_approximate) = (0, 0, 0);
    for (file, frame) in &truth.frames {
        let (_, inspection) = &booth.inspected[file];
        let expected = format!("booth_{}", frame.part);
        let is_named =
            matches!(&inspection.verdict, Verdict::Part { part, .. } if *part == expected);
        if inspection.verdict.is_accepted() {
            assert!(is_named, "{file} is accepted as {:?}", inspection.verdict);
            let camera_from_part = truth.camera_from_part(file);
            let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
            let pose = pose.expect("a pose");
            let middle = Point3::new(0.0, 0.0, 1.2);
            let off = pose_error(&pose.camera_from_part(), &camera_from_part, &middle);
            let (turn, shift) = (off.rotation.degrees(), off.shift.mm());
            assert!(
                turn < 1.0 && shift < 10.0,
                "{file}: {turn:.2}°, {shift:.1} mm"
            );
        }
        if frame.seen_of_reference >= 0.4 && file != truth.reference(file) {
            num_named += usize::from(is_named);
            let is_accepted = is_named && inspection.verdict.is_accepted();
            num_accepted += usize::from(is_accepted);
            num_approximate += usize::from(is_accepted && inspection.verdict.is_approximate());
        }
    }
    // They are the same parts that were enrolled, not other models.
    assert!(
        num_named >= 9 && num_accepted >= 7 && num_approximate <= 2,
        "{num_named} named, {num_accepted} accepted, {num_approximate} approximate"
    );
}

#[test]
fn hardly_a_good_part_of_a_booth_has_a_dent() {
    let Some(booth) = Booth::read() else { return };
    let frames: Vec<_> = booth.inspected.iter().collect();
    let measured = map_each(frames.len(), num_cores(), |i| {
        let (_, (scene, found)) = frames[i];
        measure_surface(found, &booth.library, &[scene], &DeviationParams::default())
    });
    let (mut num_measured, mut num_with_regions) = (0, 0);
    for ((file, _), measured) in frames.iter().zip(measured) {
        match measured {
            None => println!("{file}: not accepted"),
            Some(Err(error)) => println!("{file}: {error}"),
            Some(Ok(found)) => {
                num_measured += 1;
                num_with_regions += usize::from(!found.regions.is_empty());
                let regions = found.regions.iter();
                let regions: Vec<_> = regions
                    .map(|region| (region.kind, region.off, region.area_m2, region.centre))
                    .collect();
                println!(
                    "{file}: {:.0} % judged, noise {:.2} mm, limit {:.2} mm, found {regions:?}",
                    100.0 * found.seen,
                    found.noise.mm(),
                    found.limit_factor * found.noise.mm()
                );
            }
        }
    }
    assert!(num_measured >= 7, "{num_measured} measured");
    assert!(
        10 * num_with_regions <= num_measured,
        "{num_with_regions} of {num_measured}"
    );
}

/// A strip of 16 or 32 mm without readings runs across the part.
#[test]
fn a_part_that_a_strip_without_readings_cuts_in_two_is_found_in_its_place() {
    let Some(data) = data_folder() else { return };
    let folder = data.join("reported/stripe_without_depth");
    let enrolled = enrol_captured(
        &scene(&folder.join("enrol.png")),
        &about("plate"),
        &EnrolParams::default(),
    );
    let mut library = Library::default();
    library.references.push(enrolled.expect("a part").reference);
    let inspected = [4, 12].map(|pixels| {
        let scene = scene(&folder.join(format!("stripe_{pixels}_pixels.png")));
        run(&scene, &library, &Recipe::default(), &Unwatched).expect("not cancelled")
    });
    let [whole, cut] = inspected.each_ref().map(|inspection| {
        assert!(inspection.verdict.is_accepted(), "{:?}", inspection.verdict);
        inspection.found_pose().expect("a pose").camera_from_part()
    });
    // Both frames show the part in one place.
    let off = pose_error(&cut, &whole, &Point3::new(0.0, 0.0, 1.2));
    assert!(
        off.rotation.degrees() < 0.7 && off.shift.mm() < 5.5,
        "{off:?}"
    );
}

/// In this frame of a fender, each of these doors fits as well at another place.
#[test]
fn a_part_whose_pose_is_ambiguous_is_accepted_by_no_pose_method() {
    let Some(data) = data_folder() else { return };
    let scene_of = |name: &str| scene(&data.join(format!("booth/{name}.png")));
    let enrolled = |frame: &str, name: &str| {
        let enrolled = enrol_captured(&scene_of(frame), &about(name), &EnrolParams::default());
        enrolled.expect("a part").reference
    };
    let fender = scene_of("left2_07");
    for door in ["right2_03", "right2_04"] {
        let library = Library {
            references: vec![enrolled("left2_01", "fender"), enrolled(door, "door")],
            ..Library::default()
        };
        for name in BUILT_IN_RECIPES {
            for method in PoseMethod::ALL {
                let mut recipe = built_in_recipe(name).expect("a recipe");
                recipe.pose = PoseChoice::By(method);
                let found = run(&fender, &library, &recipe, &Unwatched).expect("not cancelled");
                let is_fender = found.verdict.guess() == Some("fender");
                assert!(
                    is_fender || !found.verdict.is_accepted(),
                    "{door} {name} {method:?}: {:?}",
                    found.verdict
                );
            }
        }
    }
}

/// Reported: a depth that is 5 % too long is accepted, 65 mm off.
#[test]
fn most_parts_accepted_with_a_camera_5_percent_wrong_are_warned_of_and_none_with_a_right_one() {
    let Some(booth) = Booth::read() else { return };
    let inspected = |file: &str, depth: f64, focal: f64| {
        let Ok(FileContent::Depth(mut frame)) = open(&booth.folder.join(file)) else {
            panic!("{file}");
        };
        frame.metres_per_unit *= depth;
        frame.intrinsics.fx *= focal;
        frame.intrinsics.fy *= focal;
        let scene = scene_from_frame(&frame);
        run(&scene, &booth.library, &Recipe::default(), &Unwatched).expect("not cancelled")
    };
    let (mut num_accepted, mut num_warned) = (0, 0);
    for (file, (_, right)) in &booth.inspected {
        let off = right.found_pose().and_then(PoseEstimate::off_scale);
        assert_eq!(off, None, "{file}");
        for (depth, focal) in [(1.05, 1.0), (1.0, 0.95)] {
            let wrong = inspected(file, depth, focal);
            let pose = wrong.found_pose().filter(|_| wrong.verdict.is_accepted());
            num_accepted += usize::from(pose.is_some());
            let Some(off) = pose.and_then(PoseEstimate::off_scale) else {
                continue;
            };
            num_warned += 1;
            let what = format!("{file}, depth {depth}, focal length {focal}: {off}");
            assert!((off.scale() - 1.05).abs() < 0.025, "{what}");
            // The operator reads it, too.
            assert!(pose.and_then(PoseEstimate::doubt).is_some(), "{what}");
        }
    }
    assert!(
        num_accepted >= 10 && num_warned + 1 >= num_accepted,
        "{num_warned} of {num_accepted}"
    );
}

/// Between these frames the camera moved by decimetres and the part did not; this must never be reported as a moved
/// part.
#[test]
fn a_camera_that_moves_before_a_part_is_never_told_as_a_part_that_moved() {
    let Some(booth) = Booth::read() else { return };
    let at = jiff::Timestamp::UNIX_EPOCH;
    let views = booth.inspected.iter().filter_map(|(file, (scene, _))| {
        let view = CellView::from_scene(scene, &SegmentParams::default());
        Some((&booth.truth.frames[file], view.ok()?))
    });
    let views: Vec<_> = views.collect();
    let compared = map_each(views.len(), num_cores(), |i| {
        let (before, before_view) = &views[i];
        let one = std::slice::from_ref(before_view);
        let baseline =
            CellBaseline::new(one, CellLimits::default(), false, at).expect("a baseline");
        let (mut num_compared, mut num_told) = (0, 0);
        for (now, now_view) in views.iter().filter(|(now, _)| now.part == before.part) {
            let Ok(found) = baseline.check(std::slice::from_ref(now_view), false, at) else {
                continue;
            };
            if std::ptr::eq(*now, *before) {
                assert_eq!(found.finding, CellFinding::InPlace, "{found:?}");
                continue;
            }
            let [before, now] = [before, now].map(|frame| frame.world_from_camera());
            let turned = before.rotation.angle_to(&now.rotation);
            assert!(
                (found.turn_rad - turned).abs() < 0.01,
                "{found:?}, {turned}"
            );
            num_compared += 1;
            match found.finding {
                CellFinding::CameraMoved => num_told += 1,
                finding => assert_eq!(finding, CellFinding::PartOrCameraMoved, "{found:?}"),
            }
        }
        [num_compared, num_told]
    });
    let sum = |which: usize| compared.iter().map(|nums| nums[which]).sum::<usize>();
    let [num_compared, num_told] = [sum(0), sum(1)];
    println!("{num_compared} pairs compared, {num_told} told as a camera that moved");
    assert!(num_compared >= 4 && num_told >= 2);
}
