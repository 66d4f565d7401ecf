use super::*;
use geometry::{error::Advice as _, rigid::from_euler_zyx};

fn capsule(body: Body, from: [f64; 3], to: [f64; 3], radius: f64) -> Capsule {
    Capsule {
        body,
        axis: Segment {
            from: Point3::from(from),
            to: Point3::from(to),
        },
        radius,
    }
}

/// A box of 400 × 200 × 200 mm, 1 m ahead and turned about z by 90°.
fn one_box(name: &str) -> CellBox {
    let text = BoxText {
        name: name.into(),
        centre_mm: [1000.0, 0.0, 0.0],
        size_mm: [400.0, 200.0, 200.0],
        angles_deg: [0.0, 0.0, 90.0],
    };
    text.checked().expect("a box")
}

#[test]
fn a_body_is_too_near_within_its_radius_and_the_clearance() {
    let boxed = |names: [&str; 2]| Obstacles {
        boxes: names.map(one_box).to_vec(),
        ..Obstacles::default()
    };
    let obstacles = boxed(["post", "post"]);
    // Its face is at 900 mm; the gun hits it from 50 + 20 mm in front of it.
    for (x, is_hit) in [(0.829, false), (0.831, true), (1.0, true), (1.171, false)] {
        let gun = [capsule(Body::Gun, [x, -1.0, 0.0], [x, 1.0, 0.0], 0.05)];
        assert_eq!(obstacles.pairs(&gun).next().is_some(), is_hit, "{x}");
        let wanted = is_hit.then(|| (Body::Gun, Obstacle::Box("post".into())));
        assert_eq!(worst(obstacles.pairs(&gun)), wanted);
    }
    // Along y the box reaches to 200 mm.
    for (y, is_hit) in [(0.271, false), (0.269, true)] {
        let gun = [capsule(Body::Gun, [0.0, y, 0.0], [2.0, y, 0.0], 0.05)];
        assert_eq!(obstacles.pairs(&gun).next().is_some(), is_hit, "{y}");
    }
    // The worst pair is reported, in any order: the wrist is as near but thinner.
    let bodies = [
        capsule(Body::Wrist, [0.85, 0.0, 0.0], [0.85, 0.0, 0.0], 0.04),
        capsule(Body::Forearm, [0.85, 0.0, 0.0], [0.85, 0.0, 0.0], 0.05),
    ];
    let backwards = [bodies[1], bodies[0]];
    for obstacles in [boxed(["a", "b"]), boxed(["b", "a"])] {
        for bodies in [bodies, backwards] {
            let wanted = (Body::Forearm, Obstacle::Box("a".into()));
            assert_eq!(worst(obstacles.pairs(&bodies)), Some(wanted));
        }
    }
}

#[test]
fn a_floor_is_below_everything() {
    let obstacles = Obstacles {
        floor: Some(-0.5),
        ..Obstacles::default()
    };
    for (z, is_hit) in [(-0.39, false), (-0.41, true), (-9.0, true)] {
        let arm = [capsule(Body::Wrist, [7.0, 0.0, 1.0], [7.0, 3.0, z], 0.08)];
        let wanted = is_hit.then_some((Body::Wrist, Obstacle::Floor));
        assert_eq!(worst(obstacles.pairs(&arm)), wanted, "{z}");
    }
}

/// A sheet of points every 10 mm, 2 m ahead of the robot and perpendicular to its x axis.
fn sheet() -> Obstacles {
    let side = |i: u16| 0.01 * f32::from(i) - 0.3;
    let points = (0..=60).flat_map(|i| (0..=60).map(move |k| [side(i), side(k)]));
    let mut points: Vec<Point3<f32>> = points.map(|[y, z]| Point3::new(0.0, y, z)).collect();
    points.push(Point3::new(f32::NAN, 0.0, 0.0));
    let robot_from_part = from_euler_zyx([0.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    Obstacles::default().with_part(&points, &robot_from_part)
}

#[test]
fn a_gun_through_the_points_of_a_part_is_found_and_one_before_them_is_free() {
    let obstacles = sheet();
    let wanted = Some((Body::Gun, Obstacle::Part));
    let gun = |from: f64, to: f64| {
        // Between the points.
        let at = |x: f64| [x, 0.005, 0.005];
        worst(obstacles.pairs(&[capsule(Body::Gun, at(from), at(to), 0.05)]))
    };
    // 50 mm of the gun, 20 of clearance, 10 of spacing.
    assert_eq!(gun(1.0, 1.9), None);
    assert_eq!(gun(1.0, 1.93), wanted);
    assert_eq!(gun(1.0, 3.0), wanted);
    assert_eq!(gun(3.0, 1.0), wanted);
    assert_eq!(gun(2.1, 3.0), None);
    let beside = capsule(Body::Gun, [1.0, 0.385, 0.0], [3.0, 0.385, 0.0], 0.05);
    assert_eq!(worst(obstacles.pairs(&[beside])), None);
    let nothing = Obstacles::default().with_part(&[], &RigidTransform::identity());
    assert!(nothing.part.is_none() && obstacles.part.is_some());
}

#[test]
fn the_corners_of_a_box_are_where_it_is() {
    let obstacles = Obstacles {
        boxes: vec![one_box("post")],
        ..Obstacles::default()
    };
    let corners = obstacles.boxes().next().expect("a box");
    for (i, corner) in corners.iter().enumerate() {
        let off = (corner - Point3::new(1.0, 0.0, 0.0)).abs();
        assert!((off - Vector3::new(0.1, 0.2, 0.1)).norm() < 1e-12);
        let edges = [1, 2, 4].map(|bit| (corner - corners[i ^ bit]).norm());
        assert!((edges.iter().sum::<f64>() - 0.8).abs() < 1e-12);
    }
}

#[test]
fn a_file_of_boxes_is_read_and_a_bad_one_refused_with_advice() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("boxes.toml");
    let read = |text: &str| {
        std::fs::write(&path, text).expect("written");
        Obstacles::read(&path)
    };
    let text = "floor_mm = -600\n\
        [[box]]\nname = \"post\"\ncentre_mm = [1000, 0, 0]\nsize_mm = [400, 200, 200.0]\n\
        angles_deg = [0, 0, 90]\n\
        [[box]]\nname = \"cabin\"\ncentre_mm = [0, -2000, 0]\nsize_mm = [9, 9, 10]\n";
    let found = read(text).expect("boxes");
    assert_eq!((found.floor, found.boxes.len()), (Some(-0.6), 2));
    assert_eq!(found.file(), Some("boxes.toml"));
    let gun = [capsule(Body::Gun, [0.84, 0.0, 0.0], [0.84, 0.0, 0.0], 0.05)];
    assert_eq!(
        worst(found.pairs(&gun)),
        Some((Body::Gun, Obstacle::Box("post".into())))
    );
    let refused = |error: ArmError| {
        assert!(error.advice().contains("centre_mm"), "{}", error.advice());
        error.to_string()
    };
    for (old, new, wanted) in [
        ("-600", "nan", "floor_mm"),
        ("-600", "1e9", "floor_mm"),
        ("[1000, 0, 0]", "[nan, 0, 0]", "box 1: centre_mm of post"),
        ("[1000, 0, 0]", "[0, inf, 0]", "box 1: centre_mm of post"),
        ("[9, 9, 10]", "[9, 0, 9]", "box 2: size_mm of cabin"),
        ("[9, 9, 10]", "[9, -9, 9]", "box 2: size_mm of cabin"),
        ("[9, 9, 10]", "[9, 9]", "3"),
        ("[9, 9, 10]", "[0.4, 1.5, 9]", "no side of cabin is 10 mm"),
        ("[0, 0, 90]", "[0, 0, 9000]", "box 1: angles_deg"),
        ("\"cabin\"", "\" \"", "box 2: its name"),
        ("\"cabin\"", "\"a\\u001b[2J\"", "box 2: its name"),
        ("angles_deg", "angles", "angles"),
        ("[[box]]", "[[boxes]]", "boxes"),
        ("[[box]]", "[[", ""),
    ] {
        let error = refused(read(&text.replace(old, new)).expect_err(new));
        assert!(error.contains(wanted), "{new}: {error}");
    }
    read("").expect_err("an empty file");
    let nothing = refused(read("# nothing\n").expect_err("nothing"));
    assert!(nothing.contains("neither a box nor a floor"), "{nothing}");
    let many = "[[box]]\nname = \"a\"\ncentre_mm = [1, 2, 3]\nsize_mm = [1, 2, 3]\n";
    let many = refused(read(&many.repeat(10_000)).expect_err("too many"));
    assert!(many.contains("10000 boxes, expected at most 200"), "{many}");
    assert!(Obstacles::read(&folder.path().join("none.toml")).is_err());
}
