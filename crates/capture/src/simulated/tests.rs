use super::*;
use crate::spec::SourceSpec;

fn cell(text: &str) -> SimulatedCell {
    match text.parse() {
        Ok(SourceSpec::Simulated(spec)) => SimulatedCell::new(spec),
        other => panic!("{text}: {other:?}"),
    }
}

fn kind_of(truth: Option<&FrameTruth>) -> Option<PartKind> {
    truth.expect("of one part").part()
}

#[test]
fn a_frame_follows_from_the_settings_and_its_number() {
    let mut forwards = cell("simulated,fps=2,every=4:line");
    let frames: Vec<_> = (1..=9).map(|number| forwards.frame(number)).collect();
    let mut again = cell("simulated,fps=2,every=4:line");
    for number in [9, 2, 5] {
        assert!(
            again.frame(number) == frames[number as usize - 1],
            "{number}"
        );
    }
    assert!(
        frames[3].0 != frames[4].0,
        "the noise of a frame is its own"
    );
    let mut other = cell("simulated,fps=2,every=4,seed=2:line");
    assert!(other.frame(5) != frames[4]);
}

#[test]
fn the_line_shows_every_part_in_turn_and_the_empty_cell_between_them() {
    let mut line = cell("simulated,noise=0,fps=1,every=4:line");
    let mut seen = std::collections::BTreeSet::new();
    for visit in 0..8 {
        assert_eq!(
            kind_of(line.frame(4 * visit + 1).1.as_ref()),
            None,
            "visit {visit}"
        );
        let (_, truth) = line.frame(4 * visit + 4);
        assert!(truth.as_ref().is_some_and(|truth| truth.fully_visible));
        seen.insert(kind_of(truth.as_ref()).expect("a part"));
        if visit == 0 {
            assert_eq!(kind_of(truth.as_ref()), Some(PartKind::FrontDoor));
        }
    }
    assert_eq!(seen.len(), 8);
}

#[test]
fn what_was_asked_for_hangs_there() {
    let (_, right) = cell("simulated,side=right:fender").frame(1);
    assert_eq!(
        right.expect("of one part").subject,
        SimulatedObject::Part {
            kind: PartKind::Fender,
            side: simulate::Side::Right,
            model_seed: 0
        }
    );
    let (_, fixed) = cell("simulated,pose=0 0 15deg 0.1 0 1.2:grille").frame(3);
    let fixed = fixed.expect("of one part");
    assert!((fixed.camera_from_part.translation.z - 1.2).abs() < 1e-12);
    assert!((fixed.camera_from_part.rotation.angle().to_degrees() - 15.0).abs() < 1e-9);
    let (_, empty) = cell("simulated:empty").frame(1);
    assert_eq!(kind_of(empty.as_ref()), None);
    let (Image::Depth(clear), _) = cell("simulated,noise=0:hood").frame(1) else {
        panic!("a depth image")
    };
    let (Image::Depth(noisy), _) = cell("simulated,noise=3:hood").frame(1) else {
        panic!("a depth image")
    };
    let num_lost = |depth: &[u16]| depth.iter().filter(|&&depth| depth == 0).count();
    assert!(num_lost(&noisy.depth) > num_lost(&clear.depth) + 1000);
}

#[test]
fn frames_that_could_not_be_taken_in_time_are_left_out() {
    let mut cell = cell("simulated,fps=10:fender");
    let start = Instant::now();
    assert_eq!(cell.due(start), (1, Duration::ZERO));
    cell.number = 1;
    let (number, left) = cell.due(start + Duration::from_millis(40));
    assert_eq!((number, left.as_millis()), (2, 60));
    // A little late: nothing is lost.
    assert_eq!(
        cell.due(start + Duration::from_millis(190)),
        (2, Duration::ZERO)
    );
    // A second late: the camera has gone on.
    assert_eq!(
        cell.due(start + Duration::from_millis(1150)),
        (11, Duration::ZERO)
    );
}

#[test]
fn racks_come_in_from_outside_hang_still_and_leave() {
    let mut line = cell("simulated,noise=0,fps=10,every=6:rack");
    let mut depths = |seconds: f64| {
        let (Image::Depth(image), truth) = line.frame((10.0 * seconds) as u64 + 1) else {
            panic!("a depth image")
        };
        assert!(truth.is_none(), "of one part");
        image.depth
    };
    let (empty, here, later) = (depths(0.0), depths(3.0), depths(5.0));
    let differing = |a: &[u16], b: &[u16]| {
        a.iter()
            .zip(b)
            .filter(|(a, b)| a.abs_diff(**b) > 20)
            .count()
    };
    assert!(
        differing(&here, &later) < 100,
        "less than 0.1 mm of the swing remains"
    );
    assert!(differing(&empty, &here) > 20_000);
    assert!(differing(&depths(6.0), &depths(9.0)) > 20_000);
}

#[test]
fn the_line_without_a_stop_shows_other_depths_in_every_frame_and_the_same_again() {
    let mut line = cell("simulated,noise=0,fps=1,speed=200:conveyor");
    let mut frame = |number| line.frame(number).0;
    let (first, later) = (frame(12), frame(13));
    assert!(first != later && frame(12) == first);
}
