use super::*;
use crate::report::pose_report::tests::{Inspected, door, empty, old, refused, reported, robot};
use robot::{Convention, RobotFrame};

/// Returns every text of the page with its area.
fn texts(report: &PoseReport, pictures: &PdfPictures<'_>) -> Vec<(String, Area)> {
    let faces = Faces::new();
    let mut sheet = Sheet::new(PAGE, &faces);
    compose(&mut sheet, report, pictures);
    sheet.texts
}

fn text_of(report: &PoseReport, pictures: &PdfPictures<'_>) -> String {
    let texts: Vec<String> = texts(report, pictures)
        .into_iter()
        .map(|(text, _)| text)
        .collect();
    texts.join("\n")
}

/// Checks that nothing is off the page and no texts overlap.
fn is_tidy(report: &PoseReport, pictures: &PdfPictures<'_>, what: &str) {
    let texts = texts(report, pictures);
    for (i, (text, area)) in texts.iter().enumerate() {
        let inside = area.left >= MARGIN - 1.0
            && area.left + area.width <= MARGIN + WIDTH + 1.0
            && area.top >= 20.0
            && area.top + area.height <= PAGE[1] - 20.0;
        assert!(inside, "{what}: {text:?} at {area:?}");
        for (other, at) in &texts[..i] {
            assert!(
                !area.overlaps(*at),
                "{what}: {text:?} on {other:?}, {area:?} {at:?}"
            );
        }
    }
}

#[test]
fn a_part_that_was_reported_as_wrong_is_not_called_accepted() {
    let report = reported();
    let text = text_of(&report, &PdfPictures::default());
    assert!(text.contains("REPORTED AS WRONG"), "{text}");
    assert!(text.contains("really hung there: back door"), "{text}");
    assert!(!text.lines().any(|line| line == "Accepted"), "{text}");
    is_tidy(&report, &PdfPictures::default(), "reported as wrong");
}

#[test]
fn the_page_says_why_a_robot_must_not_move_by_the_pose() {
    let frame = robot();
    let inspection = &door().inspection;
    let why = old().what;
    for (for_robot, says) in [
        (None, "In the camera's frame, not in the robot's: "),
        (Some(&frame), "Given despite doubts, not to be moved by: "),
    ] {
        let doubts = [old()];
        let frames = [Some(&frame), for_robot];
        let report = door().doubted(inspection, frames, &doubts, Convention::Kuka);
        let text = text_of(&report, &PdfPictures::default());
        assert!(text.contains("RECOGNISED: do not move"), "{text}");
        assert!(!text.lines().any(|line| line == "Accepted"), "{text}");
        let text = text.replace('\n', " ");
        assert!(text.contains(&format!("{says}{why}")), "{text}");
        let gives = text.contains("robot_from_part: the pose");
        assert_eq!(gives, for_robot.is_some(), "{text}");
        is_tidy(&report, &PdfPictures::default(), says);
    }
}

#[test]
fn every_kind_of_report_fits_on_the_page() {
    let long = RobotFrame {
        name:
            "cell 12, after the camera was moved, checked by the second shift with the large board"
                .into(),
        ..robot()
    };
    let view = RgbImage::new(160, 90);
    let named: [(&str, &Inspected); 3] = [
        ("accepted", door()),
        ("refused", refused()),
        ("empty", empty()),
    ];
    for (what, inspected) in named {
        // Stages of the same shape that are drawn quickly.
        let mut stages = inspected.pictures();
        for Picture { image, .. } in &mut stages {
            *image = RgbImage::new(image.width().div_ceil(20), image.height().div_ceil(20));
        }
        for frame in [None, Some(&robot()), Some(&long)] {
            for convention in Convention::ALL {
                let mut report = inspected.report(frame, convention);
                for view in [None, Some(&view)] {
                    let pictures = PdfPictures {
                        view,
                        stages: &stages,
                        title: None,
                    };
                    is_tidy(&report, &pictures, &format!("{what} {convention:?}"));
                }
                report.scene = "/mnt/captures/".repeat(30) + "door.pcd";
                report.source = Some("recording:".to_owned() + &"long/".repeat(60));
                let title = "A door of a make with a very long name, ".repeat(4);
                let pictures = PdfPictures {
                    view: None,
                    stages: &stages,
                    title: Some(&title),
                };
                is_tidy(&report, &pictures, &format!("long {what} {convention:?}"));
            }
        }
    }
}

#[test]
fn the_page_says_the_pose_in_the_robots_numbers() {
    let report = door().report(Some(&robot()), Convention::Fanuc);
    let text = text_of(
        &report,
        &PdfPictures {
            title: Some("Front door, left"),
            ..PdfPictures::default()
        },
    );
    let block = report.robot.robot_from_part.as_ref().expect("a pose");
    for value in &block.in_convention.values {
        assert!(text.contains(&value.rounded()), "{value:?}\n{text}");
    }
    for words in [
        "Front door, left",
        "Accepted",
        "robot_from_part",
        "robot_offset",
        "SIMULATED",
        "2026-03-04 05:06:07 UTC",
        "FANUC W P R",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    assert!(!text.contains("NOT ACCEPTED"));
}

#[test]
fn a_refused_part_has_no_number_on_the_page_that_a_robot_takes() {
    let report = refused().report(Some(&robot()), Convention::Kuka);
    let text = text_of(&report, &PdfPictures::default());
    assert!(
        text.contains("NOT ACCEPTED: do not move on this pose")
            && text.contains("No pose is given")
    );
    assert!(text.contains("Mirror image of fender") && !text.contains("\nAccepted"));
    assert!(text.contains("Source\na simulation"), "{text}");
    assert!(
        text.contains(", margin ") && !text.contains("ahead of"),
        "{text}"
    );
    let refused = report.refused_pose.as_ref().expect("a pose");
    for value in &refused.camera_from_part.in_convention.values {
        assert!(!text.contains(&value.rounded()), "{value:?}\n{text}");
    }
    assert!(!text.contains("robot_from_part"));
}

#[test]
fn the_page_names_no_part_that_is_not_like_it() {
    let mut report = refused().report(None, Convention::Kuka);
    (report.verdict.part, report.verdict.nearest) = (None, Some("grille".into()));
    for is_like in [true, false] {
        report.verdict.identification = Identification::Unknown { is_like };
        let text = text_of(&report, &PdfPictures::default());
        assert_eq!(text.contains("Nearest enrolled part: grille"), is_like);
        assert!(text.contains("Unknown part"));
    }
}

#[test]
fn a_refused_part_that_was_recognised_is_called_by_its_title() {
    let mut report = refused().report(None, Convention::Kuka);
    let verdict = &mut report.verdict;
    (verdict.status, verdict.part, verdict.nearest) = ("ok", Some("door_real".into()), None);
    let pictures = PdfPictures {
        title: Some("Real door"),
        ..PdfPictures::default()
    };
    for (found, headline) in [
        (Identification::Part, "Real door"),
        (Identification::AnotherModel, "Real door, another model"),
        (Identification::NotRecognised, "Part not accepted"),
    ] {
        report.verdict.identification = found;
        let text = text_of(&report, &pictures);
        assert!(text.contains(headline) && text.contains("NOT ACCEPTED"));
        let is_below = text.contains("Nearest enrolled part: Real door");
        assert_eq!(is_below, found == Identification::NotRecognised, "{text}");
    }
}

#[test]
fn usual_texts_are_not_cut() {
    let mut report = door().report(Some(&robot()), Convention::Kuka);
    report.seen_by = SeenBy::NotKnown;
    let calibration = "an unnamed calibration (3b2f68d5)";
    report.robot.calibration = Some(calibration.into());
    let text = text_of(&report, &PdfPictures::default());
    for words in [
        SeenBy::NotKnown.describe(),
        "calibration: an unnamed calibration (3b2f68d5)",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    assert_eq!(text.matches(calibration).count(), 2);
}

#[test]
fn the_same_report_is_the_same_file() {
    let report = door().report(None, Convention::Doosan);
    let stages = door().pictures();
    let pictures = PdfPictures {
        view: None,
        stages: &stages,
        title: None,
    };
    let pdf = pose_pdf(&report, &pictures);
    assert!(
        pdf.starts_with(b"%PDF-1.") && pdf.len() < 2_000_000,
        "{} bytes",
        pdf.len()
    );
    assert!(pdf == pose_pdf(&report, &pictures));
}

#[test]
fn long_texts_are_cut_to_their_width() {
    let faces = Faces::new();
    let path = "captures/".repeat(20) + "door.pcd";
    let cut = faces.fitted(&path, 120.0, BODY);
    assert!(faces.width(&cut, BODY) <= 120.0);
    assert!(
        cut.starts_with("captures") && cut.contains('…') && cut.ends_with("door.pcd"),
        "{cut}"
    );
    assert_eq!(faces.fitted("door.pcd", 120.0, BODY), "door.pcd");
    let lines = faces.lines(&"a few words ".repeat(40), 120.0, BODY, 3);
    assert_eq!(lines.len(), 3);
    assert!(lines[2].ends_with('…') && lines.iter().all(|line| faces.width(line, BODY) <= 120.0));
    let lines = faces.lines("one line", 120.0, BODY, 3);
    assert_eq!(lines, ["one line"]);
}
