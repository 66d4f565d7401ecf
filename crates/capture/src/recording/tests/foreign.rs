//! Folders of frames made by other programs.

use super::*;
use files::{
    DepthCamera, StoredOrientation,
    depth_png::{FOLDER_CAMERA, write_camera, write_depths},
    save_cloud,
};

#[test]
fn a_sequence_of_depth_images_is_read_with_its_times_and_its_camera() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("depth")).unwrap();
    let camera = DepthCamera {
        intrinsics: Intrinsics {
            width: 3,
            height: 1,
            fx: 3.0,
            fy: 3.0,
            cx: 1.0,
            cy: 0.0,
            ..Intrinsics::KINECT
        },
        metres_per_unit: 0.0002,
        is_simulated: false,
        stored: StoredOrientation::default(),
    };
    let mut list = vec!["# depth maps".to_owned(), "# timestamp filename".into()];
    for k in 0..3_u16 {
        let frame = DepthFrame {
            intrinsics: camera.intrinsics,
            metres_per_unit: camera.metres_per_unit,
            depth: vec![5000 + k, 0, 6000],
            is_simulated: false,
        };
        let mut png = Vec::new();
        write_depths(&mut png, &frame).unwrap();
        fs::write(folder.path().join(format!("depth/{k}.png")), png).unwrap();
        list.push(format!("1305031102.16040{k} depth/{k}.png"));
    }
    list.push("1305031103.0 depth/missing.png".into());
    fs::write(folder.path().join("depth.txt"), list.join("\n")).unwrap();
    // The assumed camera has another size: every image is reported.
    let (_, names) = replayed(folder.path());
    assert!(names.iter().all(|name| name.starts_with('!')), "{names:?}");
    write_camera(&folder.path().join(FOLDER_CAMERA), &camera).unwrap();
    let (found, names) = replayed(folder.path());
    assert_eq!(
        names,
        [
            "depth/0.png",
            "depth/1.png",
            "depth/2.png",
            "!depth/missing.png"
        ]
    );
    assert!(!found[0].is_simulated && found[0].warnings.is_empty());
    assert_eq!(found[1].taken_at.as_nanosecond(), 1_305_031_102_160_401_000);
    let Image::Depth(frame) = &found[2].image else {
        panic!("a depth image");
    };
    assert_eq!(
        (frame.depth[0], DepthCamera::from_frame(frame)),
        (5002, camera)
    );
    // A camera given by name takes precedence over the one in the folder.
    let mut given = camera;
    given.intrinsics.fx = 580.0;
    let file = folder.path().join("mine.json");
    write_camera(&file, &given).unwrap();
    let kind = format!("recording,pace=step,camera={}", file.display());
    let (found, _) = all_of(open(&spec(&kind, folder.path())).unwrap().as_mut());
    assert!(
        matches!(&found[0].image, Image::Depth(frame) if DepthCamera::from_frame(frame) == given)
    );
    fs::write(folder.path().join("depth.txt"), "1305031102.160401\n").unwrap();
    let error = Replay::open(&recording_of(folder.path()))
        .err()
        .expect("no file named");
    assert!(error.to_string().contains("line 1"), "{error}");
}

#[test]
fn the_camera_of_a_sequence_without_one_is_assumed_and_said_once() {
    let folder = tempfile::tempdir().unwrap();
    let Image::Depth(mut frame) = simulated(1).remove(0).image else {
        panic!("a depth image");
    };
    // Such a sequence cannot say that it is simulated.
    frame.is_simulated = false;
    let mut png = Vec::new();
    write_depths(&mut png, &frame).unwrap();
    fs::write(folder.path().join("a.png"), png).unwrap();
    fs::write(folder.path().join("depth.txt"), "1 a.png\n2 a.png\n").unwrap();
    let (found, _) = replayed(folder.path());
    let [CaptureWarning::AssumedCamera { missing }] = &found[0].warnings[..] else {
        panic!("{:?}", found[0].warnings);
    };
    assert!(missing.ends_with(FOLDER_CAMERA));
    assert!(found[1].warnings.is_empty());
    // The simulated cell has the same unit and camera as such sequences.
    assert!(found[0].image == Image::Depth(frame));
}

#[test]
fn a_folder_of_clouds_is_read_in_counting_order() {
    let folder = tempfile::tempdir().unwrap();
    for (name, x) in [("scan10.pcd", 10.0), ("scan9.ply", 9.0), ("scan1.xyz", 1.0)] {
        let cloud = PointCloud::from_points([Point3::new(x, 0.0, 1.0)]);
        save_cloud(&folder.path().join(name), &cloud).unwrap();
    }
    fs::write(folder.path().join("scan2.pcd"), "nothing of use").unwrap();
    fs::write(folder.path().join("readme.txt"), "not a scan").unwrap();
    let (found, names) = replayed(folder.path());
    assert_eq!(
        names,
        ["scan1.xyz", "!scan2.pcd", "scan9.ply", "scan10.pcd"]
    );
    let xs: Vec<f32> = found
        .iter()
        .map(|frame| match &frame.image {
            Image::Cloud(cloud) => cloud.points[0].x,
            Image::Depth(_) => panic!("a cloud"),
        })
        .collect();
    assert_eq!(xs, [1.0, 9.0, 10.0]);
}

#[test]
fn a_mistyped_path_in_a_list_is_one_missing_frame_and_one_that_leads_out_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let Image::Depth(frame) = simulated(1).remove(0).image else {
        panic!("a depth image");
    };
    let mut png = Vec::new();
    write_depths(&mut png, &frame).unwrap();
    fs::create_dir(folder.path().join("depth")).unwrap();
    fs::write(folder.path().join("depth/1.png"), png).unwrap();
    fs::write(folder.path().join("depth/2.png"), "1 2 3\n").unwrap();
    let list = folder.path().join("depth.txt");
    fs::write(&list, "1 depht/1.png\n2 depth/1.png\n3 depth/2.png\n").unwrap();
    let (_, names) = replayed(folder.path());
    assert_eq!(names, ["!depht/1.png", "depth/1.png", "!depth/2.png"]);
    for outside in ["../other/1.png", "/etc/passwd", "depth/../../1.png"] {
        fs::write(&list, format!("1 depth/1.png\n2 {outside}\n")).unwrap();
        let error = Replay::open(&recording_of(folder.path())).err();
        let error = error.expect("it leads out").to_string();
        assert!(
            error.contains("line 2") && error.contains("own folder"),
            "{error}"
        );
    }
}
