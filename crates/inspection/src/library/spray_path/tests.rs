use super::*;
use geometry::error::Advice as _;

fn parse(text: &str) -> Result<SprayPath, SprayPathError> {
    SprayPath::parse(text, Path::new("path.csv"))
}

#[test]
fn a_nozzle_is_read_and_written() {
    let text = "# taught on Monday\nindex;nozzle_x_mm;nozzle_y_mm;nozzle_z_mm;direction_x;direction_y;direction_z\n\
                1;12,5;-40;1141;0;0;2\n2;13;-40;1141;0,6;0;0,8\n";
    let path = parse(text).expect("a path");
    let [first, second] = path.points() else {
        panic!("two points");
    };
    assert!((first.nozzle - Point3::new(0.0125, -0.04, 1.141)).norm() < 1e-12);
    assert!((first.direction.into_inner() - Vector3::z()).norm() < 1e-12);
    assert_eq!(first.stand_off, None);
    assert!((second.direction.x - 0.6).abs() < 1e-12);
    let again = parse(&path.to_text()).expect("its own text");
    for (a, b) in path.points().iter().zip(again.points()) {
        assert!((a.nozzle - b.nozzle).norm() < 1e-6);
        assert!((a.direction.into_inner() - b.direction.into_inner()).norm() < 1e-7);
    }
    assert_eq!(again.to_text(), path.to_text());
}

#[test]
fn a_surface_point_is_a_nozzle_before_it() {
    let text = "x_m,y_m,z_m,normal_x,normal_y,normal_z,stand_off_mm\n0.1,0.2,1.3,0,0,-1,120\n0.1,0.2,1.3,0,0,-1,\n";
    let path = parse(text).expect("a path");
    let [first, second] = path.points() else {
        panic!("two points");
    };
    assert!((first.nozzle - Point3::new(0.1, 0.2, 1.18)).norm() < 1e-12);
    assert!((first.direction.into_inner() - Vector3::z()).norm() < 1e-12);
    assert_eq!(first.stand_off, Some(Metres(0.12)));
    // Without a stand-off: the middle of the band.
    assert!((second.nozzle.z - 1.15).abs() < 1e-12);
}

#[test]
fn the_gun_and_its_speed_are_read_and_written() {
    let text = "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z,speed_mm_s,gun_on\n\
                1,2,3,0,0,1,250,1\n1,2,3,0,0,1,,0\n1,2,3,0,0,1,5000,\n";
    let path = parse(text).expect("a path");
    let state = |path: &SprayPath| -> Vec<(bool, Option<f64>)> {
        let points = path.points().iter();
        points.map(|p| (p.is_gun_on, p.speed)).collect()
    };
    let expected = [(true, Some(0.25)), (false, None), (true, Some(5.0))];
    assert_eq!(state(&path), expected);
    assert_eq!(
        state(&parse(&path.to_text()).expect("its own text")),
        expected
    );
    // In metres, in a path over the surface; a file without these columns sprays everywhere.
    let surface = "x_m,y_m,z_m,normal_x,normal_y,normal_z,speed_m_s,gun_on\n0,0,1,0,0,-1,0.4,0\n";
    let path = parse(surface).expect("a path");
    assert_eq!(state(&path), [(false, Some(0.4))]);
    let path = parse("x_m,y_m,z_m,normal_x,normal_y,normal_z\n0,0,1,0,0,-1\n").expect("a path");
    assert_eq!(state(&path), [(true, None)]);
}

#[test]
fn the_long_side_of_the_fan_is_read_and_squared_up() {
    let text = "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z,fan_x,fan_y,fan_z\n\
                1,2,3,0,0,1,0,2,0.1\n1,2,3,0,0,1,,,\n";
    let path = parse(text).expect("a path");
    let fans: Vec<_> = path.points().iter().map(|p| p.fan).collect();
    assert_eq!(fans, [Some(Vector3::y_axis()), None]);
    let again = parse(&path.to_text()).expect("its own text");
    assert_eq!(again.points()[0].fan, fans[0]);
    assert_eq!(again.points()[1].fan, None);
}

#[test]
fn what_is_no_path_is_named() {
    const HEAD: &str = "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n";
    for (text, expected) in [
        (String::new(), "no heading"),
        ("1,2,3,4,5,6\n".into(), "no heading"),
        (
            "x,y,z,normal_x,normal_y,normal_z\n1,2,3,0,0,1\n".into(),
            "does not name all columns",
        ),
        (
            "x_mm,x_mm,y_mm,z_mm,normal_x,normal_y,normal_z\n1,2,3,4,0,0,1\n".into(),
            "a second column for the same number, \"x_mm\"",
        ),
        (
            format!("{}1,2,3,0,0,1,1\n", HEAD.replace('\n', ",nozzle_z_m\n")),
            "\"nozzle_z_m\"",
        ),
        (HEAD.into(), "no points"),
        (
            format!("{HEAD}1,2,3,0,0,1\n1,2,3,0,0\n"),
            "line 3: fewer numbers",
        ),
        (
            format!("{HEAD}1,two,3,0,0,1\n"),
            "line 2: \"two\" in column 2",
        ),
        (
            format!("{HEAD}1,nan,3,0,0,1\n"),
            "line 2: \"nan\" in column 2",
        ),
        (format!("{HEAD}1,2,3,0,0,0\n"), "no length"),
        (format!("{HEAD}1,2,30000,0,0,1\n"), "30 m from"),
        (
            "x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,stand_off_m\n1,2,3,0,0,1,150\n".into(),
            "150000.0 mm",
        ),
        (
            "x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,stand_off_mm\n1,2,3,0,0,1,0.15\n".into(),
            "expected 20 to 1000 mm",
        ),
        (
            format!("{}1,2,3,0,0,1,2\n", HEAD.replace('\n', ",gun_on\n")),
            "\"2\" under gun_on",
        ),
        (
            format!("{}1,2,3,0,0,1,0\n", HEAD.replace('\n', ",speed_mm_s\n")),
            "a speed of 0 mm/s",
        ),
        (
            format!("{}1,2,3,0,0,1,350\n", HEAD.replace('\n', ",speed_m_s\n")),
            "a speed of 350000 mm/s",
        ),
        (
            format!("{}1,2,3,0,0,1,-inf\n", HEAD.replace('\n', ",speed_m_s\n")),
            "is not a number",
        ),
        (
            format!(
                "{}1,2,3,0,0,1,0,1,3\n",
                HEAD.replace('\n', ",fan_x,fan_y,fan_z\n")
            ),
            "the fan's long side",
        ),
        (
            format!("{HEAD}{}", "1,2,3,0,0,1\n".repeat(MAX_PATH_POINTS + 1)),
            "more than",
        ),
    ] {
        let error = parse(&text).expect_err(expected);
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!error.advice().is_empty());
    }
}

#[test]
fn a_path_that_names_another_part_is_refused() {
    let [fender, hood] = ["fender", "hood"].map(|name| PartName::new(name).expect("a name"));
    let text = "x_m,y_m,z_m,normal_x,normal_y,normal_z\n0.1,0.2,1.3,0,0,-1\n";
    let path = parse(text).expect("a path");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("path.csv");
    let read = |text: &str, part: &PartName| {
        std::fs::write(&file, text).expect("written");
        SprayPath::read_for(&file, part)
    };
    let written = path.to_text_of(&fender);
    assert!(
        read(&written, &fender)
            .expect("its own")
            .is_as_written(&path)
    );
    let by_a_spreadsheet = written.replace("# part: fender", "\"# part: fender\",,,,,");
    for text in [&written, &by_a_spreadsheet] {
        let error = read(text, &hood).expect_err("a path of the fender");
        assert!(
            error.to_string().ends_with("a path of fender, not of hood"),
            "{error}"
        );
        assert!(
            error.advice().contains("a path of hood"),
            "{}",
            error.advice()
        );
    }
    // Most tables name no part.
    assert_eq!(read(text, &hood).expect("a path"), path);
}

#[test]
fn the_coat_of_a_planned_path_stays_with_it() {
    let text = "x_m,y_m,z_m,normal_x,normal_y,normal_z\n0.1,0.2,1.3,0,0,-1\n";
    let path = parse(text).expect("a path");
    assert_eq!(path.coat(), None);
    assert!(!path.to_text().contains("# coat"));
    let path = path.with_coat(Some("{\"speed\":0.4}".into()));
    let fender = PartName::new("fender").expect("a name");
    for text in [path.to_text(), path.to_text_of(&fender)] {
        let again = parse(&text).expect("its own text");
        assert_eq!(again.coat(), Some("{\"speed\":0.4}"), "{text}");
    }
    let crlf = path.to_text().replace('\n', "\r\n");
    assert_eq!(parse(&crlf).expect("read").coat(), path.coat());
}
