//! Arms from files, and rails as options.

use nalgebra::Unit;

use super::*;

const TEXT: &str = "name = \"Cell 3\"\n\
    lengths_mm = [150, -200, 0, 505, 760, 795, 100]\n\
    offsets_deg = [0, 0, -90, 0, 0, 180]\n\
    signs = [1, 1, -1, -1, -1, -1]\n\
    limits_deg = [[-180, 180], [-105, 155], [-86, 160], [-200, 200], [-155, 150], [-455, 455]]\n\
    speeds_deg_s = [210, 210, 265, 420, 420, 885]\n\
    base_height_mm = 505\n\
    radii_mm = [140, 125, 80]\n";
const RAIL: &str = "[rail]\ndirection = [0, 2, 0]\nfrom_mm = -2000\nto_mm = 1500\n";

fn read(text: &str) -> Result<Arm, ArmError> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.toml");
    std::fs::write(&path, text).expect("written");
    Arm::named(path.to_str().expect("a path"))
}

#[test]
fn an_arm_of_a_file_is_the_same() {
    let listed = Arm::named("gp25").expect("listed");
    let found = read(TEXT).expect("an arm");
    // Nobody says whose controller counts its joints.
    assert_eq!(found.maker, None);
    assert_eq!(
        Arm {
            name: listed.name.clone(),
            maker: listed.maker,
            ..found
        },
        listed
    );
    // Without radii those of the reach count: 0.76 m and 0.795 m with a step of 0.2 m.
    let bare = read(&TEXT.replace("radii_mm = [140, 125, 80]\n", "")).expect("an arm");
    let wanted = [0.158, 0.1422, 0.0948];
    let off = bare.radii.iter().zip(wanted).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-3, "{:?}", bare.radii);
}

#[test]
fn a_rail_is_read_from_files_and_options() {
    let found = read(&format!("{TEXT}{RAIL}")).expect("an arm").rail;
    let wanted = Rail {
        direction: Vector3::y_axis(),
        range: [-2.0, 1.5],
        speed: None,
        acceleration: None,
    };
    assert_eq!(found, Some(wanted));
    // The same rail as an option, and one that moves.
    assert_eq!("y,-2000,1500".parse::<Rail>().expect("a rail"), wanted);
    let moving = Rail {
        direction: Unit::new_normalize(-Vector3::x()),
        range: [-2.0, 1.5],
        speed: Some(0.8),
        acceleration: None,
    };
    let found: Rail = " -x, -2000, 1500, 800 ".parse().expect("a rail");
    assert_eq!(found, moving);
    let text_of = RAIL.replace("[0, 2, 0]", "[-3, 0, 0]");
    let found = read(&format!("{TEXT}{text_of}speed_mm_s = 800\n"));
    assert_eq!(found.expect("an arm").rail, Some(moving));
    let strong = Rail {
        acceleration: Some(2.5),
        ..moving
    };
    let found: Rail = "-x,-2000,1500,800,2500".parse().expect("a rail");
    assert_eq!(found, strong);
    let numbers = "speed_mm_s = 800\nacceleration_mm_s2 = 2500\n";
    let found = read(&format!("{TEXT}{text_of}{numbers}"));
    assert_eq!(found.expect("an arm").rail, Some(strong));
    for (option, wanted) in [
        ("", "not a rail"),
        ("y", "not a rail"),
        ("y,1", "not a rail"),
        ("w,0,1", "not a rail"),
        ("y,0,1,2,3,4", "not a rail"),
        ("y,0,one", "not a rail"),
        ("y,5,-5", "runs from 5 to -5 mm"),
        ("y,nan,5", "runs from"),
        ("y,0,inf", "runs from"),
        ("y,0,900000", "runs from"),
        // In metres.
        ("y,-2,2", "runs from -2 to 2 mm"),
        ("y,-2,2,1", "runs from -2 to 2 mm"),
        ("y,0,5,0", "speed"),
        ("y,0,5,-1", "speed"),
        ("y,0,5,nan", "speed"),
        ("y,0,5,0.9", "speed"),
        ("y,0,5,10001", "speed"),
        ("y,0,5,100,0", "acceleration"),
        ("y,0,5,100,nan", "acceleration"),
        ("y,0,5,100,-3", "acceleration"),
        ("y,0,5,100,100001", "acceleration"),
        ("y,0,5,100,fast", "not a rail"),
    ] {
        let error = option.parse::<Rail>().expect_err(option);
        assert!(!error.advice().is_empty());
        assert!(error.to_string().contains(wanted), "{option}: {error}");
    }
}

#[test]
fn wrong_numbers_of_an_arm_and_its_rail_are_named() {
    for (old, new, wanted) in [
        ("[-86, 160]", "[160, -86]", "joint 3"),
        ("210, 210", "210, 0", "speed of joint 2"),
        ("[1, 1, -1", "[1, 2, -1", "sign of joint 2"),
        ("760", "0", "c2"),
        ("505, 760", "nan, 760", "c1"),
        ("-90, 0", "-900, 0", "offset of joint 3"),
        ("signs", "sings", "sings"),
        ("140, 125", "140, -1", "radius of the forearm"),
        ("140, 125", "nan, 125", "radius of the upper arm"),
        ("[150, ", "[", "7"),
    ] {
        let error = read(&TEXT.replace(old, new)).expect_err(new);
        assert!(error.to_string().contains(wanted), "{new}: {error}");
        assert!(!error.advice().is_empty());
    }
    for rail in [
        RAIL.replace("2000", "nan"),
        RAIL.replace("-2000", "3000"),
        RAIL.replace("2, 0", "0, 0"),
        RAIL.replace("2, 0", "1e200, 0"),
        RAIL.replace("1500", "150000"),
        format!("{RAIL}speed_mm_s = 0\n"),
        format!("{RAIL}speed_mm_s = nan\n"),
        format!("{RAIL}speed_mm_s = 800\nacceleration_mm_s2 = 0\n"),
        format!("{RAIL}acceleration_mm_s2 = 2500\n"),
    ] {
        let error = read(&format!("{TEXT}{rail}")).expect_err("no rail");
        assert!(error.to_string().contains("rail"), "{error}");
    }
}

#[test]
fn accelerations_of_a_file_are_limits_and_without_them_it_says_what_is_not_checked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.toml");
    let arm = |accelerations: &str| {
        let text = format!(
            "name = \"Cell 3\"\nlengths_mm = [150, -200, 0, 505, 760, 795, 100]\n\
             offsets_deg = [0, 0, -90, 0, 0, 180]\nsigns = [1, 1, -1, -1, -1, -1]\n\
             limits_deg = [[-180, 180], [-105, 155], [-86, 160], [-200, 200], [-155, 150], [-455, 455]]\n\
             speeds_deg_s = [210, 210, 265, 420, 420, 885]\n{accelerations}"
        );
        std::fs::write(&path, text).expect("written");
        Arm::read(&path)
    };
    let mut known = arm("accelerations_deg_s2 = [180, 360, 540, 720, 900, 1080]\n").expect("arm");
    let wanted = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|half_turns| half_turns * PI);
    let limits = known.accelerations.expect("limits");
    let off = limits.iter().zip(wanted);
    let off = off.map(|(found, wanted)| (found - wanted).abs());
    assert!(off.fold(0.0, f64::max) < 1e-12);
    assert_eq!(known.unchecked_accelerations(), None);
    let mut plain = arm("").expect("arm");
    assert_eq!(plain.unchecked_accelerations(), Some("joints"));
    for (rail, with, without) in [
        ("y,0,500", None, Some("joints")),
        ("y,0,500,100", Some("rail"), Some("joints and rail")),
        ("y,0,500,100,300", None, Some("joints")),
    ] {
        known.rail = Some(rail.parse().expect("a rail"));
        plain.rail = known.rail;
        assert_eq!(known.unchecked_accelerations(), with, "{rail}");
        assert_eq!(plain.unchecked_accelerations(), without, "{rail}");
    }
    // No maker publishes them.
    for name in ARM_NAMES {
        let listed = Arm::named(name).expect("listed");
        assert_eq!(listed.unchecked_accelerations(), Some("joints"), "{name}");
    }
    for (bad, wanted) in [
        ("[1, 2, 3, 4, 5, 0]", "acceleration of joint 6"),
        ("[1, -2, 3, 4, 5, 6]", "acceleration of joint 2"),
        ("[1, 2, nan, 4, 5, 6]", "acceleration of joint 3"),
        ("[inf, 2, 3, 4, 5, 6]", "acceleration of joint 1"),
        ("[1, 2, 3]", "6"),
    ] {
        let error = arm(&format!("accelerations_deg_s2 = {bad}\n")).expect_err(bad);
        assert!(error.to_string().contains(wanted), "{bad}: {error}");
        assert!(!error.advice().is_empty());
    }
}
