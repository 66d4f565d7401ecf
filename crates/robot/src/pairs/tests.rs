use super::*;
use geometry::{error::Advice as _, rigid::from_euler_zyx};

fn in_file<T>(text: &str, read: impl FnOnce(&Path) -> T) -> T {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pairs.csv");
    std::fs::write(&path, text).expect("written");
    read(&path)
}

fn pairs(text: &str) -> Result<Pairs, PairsError> {
    in_file(text, |path| read_pairs(path, PairConventions::default()))
}

fn is_near(a: &RigidTransform, b: &RigidTransform) -> bool {
    (a.to_homogeneous() - b.to_homogeneous()).amax() < 1e-9
}

#[test]
fn every_way_to_write_a_table_says_the_same() {
    let arm = from_euler_zyx([
        30_f64.to_radians(),
        20_f64.to_radians(),
        10_f64.to_radians(),
        1.4505,
        -0.31,
        0.8905,
    ]);
    let seen = from_euler_zyx([0.0, 0.0, 0.5, 0.1, -0.03, 1.2]);
    for text in [
        "# robot: kuka\n# camera: rotation-vector\n1450.5,-310,890.5,10,20,30,0.1,-0.03,1.2,0,0,0.5\n",
        "\u{feff}# convention: KUKA  X Y Z mm, A B C degrees\n# camera convention: rotation-vector\r\nname X Y Z A B C x y z rx ry rz\r\np1 1450.5 -310 890.5 10 20 30 0.1 -0.03 1.2 0 0 0.5\r\n",
        "# robot: kuka\n# camera: rotation-vector\n\"p1\";1450,5;-310;890,5;10;20;30;0,1;-0,03;1,2;0;0;0,5;;\n# the end\n",
    ] {
        let read = pairs(text).expect(text);
        assert_eq!(
            (read.robot, read.camera),
            (Convention::Kuka, Convention::RotationVector)
        );
        assert_eq!(read.pairs.len(), 1, "{text}");
        assert!(is_near(&read.pairs[0].robot_from_flange, &arm), "{text}");
        assert!(is_near(&read.pairs[0].camera_from_target, &seen), "{text}");
    }
    let json = r#"{"robot":"kuka","camera":"rotation-vector","pairs":[
        {"name":"p1","robot":[1450.5,-310,890.5,10,20,30],"camera":[0.1,-0.03,1.2,0,0,0.5]}]}"#;
    let read = pairs(json).expect("JSON");
    assert!(is_near(&read.pairs[0].robot_from_flange, &arm));
    assert_eq!(read.pairs[0].name, "p1 (pair 1)");
}

#[test]
fn the_camera_writes_matrices_where_nothing_is_said_and_the_caller_may_say_otherwise() {
    let text = "# robot: kuka\n0 0 0 0 0 0  1 0 0 0.1  0 1 0 0.2  0 0 1 1.2  0 0 0 1\n";
    let read = pairs(text).expect("a matrix");
    assert_eq!(read.camera, Convention::Matrix);
    let seen = read.pairs[0].camera_from_target.translation.vector;
    assert!((seen.z - 1.2).abs() < 1e-12);
    let given = PairConventions {
        robot: Some(Convention::UniversalRobots),
        camera: None,
    };
    let read = in_file(text, |path| read_pairs(path, given)).expect("named by the caller");
    assert_eq!(read.robot, Convention::UniversalRobots);
}

#[test]
fn poses_of_the_arm_name_their_captures() {
    let text = "# robot: fanuc\ncapture, X, Y, Z, W, P, R\na.pcd, 1000, 0, 0, 0, 0, 90\n1000, 0, 0, 0, 0, 90\n";
    let (poses, robot) = in_file(text, |path| read_arm_poses(path, None)).expect("poses");
    assert_eq!(robot, Convention::Fanuc);
    assert_eq!(poses[0].capture.as_deref(), Some("a.pcd"));
    assert_eq!(poses[0].place, "a.pcd (line 3)");
    assert_eq!(
        (poses[1].capture.as_deref(), poses[1].place.as_str()),
        (None, "line 4")
    );
    assert!(
        (poses[0].robot_from_flange.rotation.angle() - std::f64::consts::FRAC_PI_2).abs() < 1e-9
    );
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    for (text, expected) in [
        ("1 2 3\n", "convention of the robot's poses is not given"),
        (
            "# robot: kukka\n1 2 3\n",
            "line 1: no convention is named \"kukka\"",
        ),
        (
            "# robot: kuka\n# camera: kuka\n1 2 3 4 5 6 7 8 9 10 11\n",
            "line 3: 11 numbers, expected 12",
        ),
        (
            "# robot: kuka\n# camera: kuka\n\np1 1 2 3 4 5 6 7 8 nine 10 11 12\n",
            "line 4: \"nine\" in column 10",
        ),
        (
            "# robot: kuka\n# camera: abb\n1 2 3 4 5 6 7 8 9 1 1 0 0\n",
            "line 3: the quaternion's length is 1.4142",
        ),
        ("# robot: kuka\n# nothing\n", "no poses"),
        (
            "{\"robot\": \"kuka\"}",
            "not a JSON file of pairs: missing field `pairs`",
        ),
        ("{\"robot\": \"kuka\", \"pairs\": []}", "no poses"),
        (
            "{\"robot\": \"kuka\", \"pairs\": [{\"robot\": [1], \"camera\": []}]}",
            "pair 1: KUKA A B C has 6 numbers",
        ),
    ] {
        let error = pairs(text).expect_err(text);
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!error.advice().is_empty());
    }
    let error = pairs("1 2 3\n").expect_err("no convention");
    assert!(
        error.advice().contains("# robot: kuka"),
        "{}",
        error.advice()
    );
}
