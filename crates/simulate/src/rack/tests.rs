use std::{collections::BTreeMap, sync::LazyLock};

use nalgebra::{Point3, UnitQuaternion, Vector3};

use super::*;
use crate::Clutter;

fn drawn(kind: RackKind, num_places: usize, seed: u64) -> RackSetup {
    RackSetup::drawn(kind, num_places, 0, seed).expect("in range")
}

fn taken(setup: &RackSetup) -> RackFrame {
    rack_frame(setup).expect("in range")
}

/// The truth, which is the same whatever the noise of the frame.
fn truth_of(setup: &RackSetup) -> RackTruth {
    let mut quiet = setup.clone();
    quiet.cell.noise = SensorNoise::none();
    taken(&quiet).truth
}

/// The racks of pairs with their truths: hanging pairs takes longest, and several tests look at them.
static PAIRS: LazyLock<Vec<(RackSetup, RackTruth)>> = LazyLock::new(|| {
    let with_truth = |setup: RackSetup| {
        let truth = truth_of(&setup);
        (setup, truth)
    };
    racks(RackKind::Overlapping).map(with_truth).collect()
});

/// Racks of this kind with every number of places, each with several seeds.
fn racks(kind: RackKind) -> impl Iterator<Item = RackSetup> {
    (2..=5).flat_map(move |num| (0..5).map(move |seed| drawn(kind, num, seed)))
}

/// Sorts points into horizontal lines of 12 mm, a little more than vertices are apart.
fn lines(points: &[Point3<f64>]) -> BTreeMap<i64, Vec<Point3<f64>>> {
    let mut lines: BTreeMap<i64, Vec<Point3<f64>>> = BTreeMap::new();
    for p in points {
        let line = (p.y / 0.012).round() as i64;
        lines.entry(line).or_default().push(*p);
    }
    lines
}

/// Hangs the rack so that it faces the camera squarely.
fn squared(setup: &RackSetup) -> Vec<Hung> {
    let mut squared = setup.clone();
    let PartPose::Drawn(range) = setup.cell.pose else {
        panic!("the pose is drawn");
    };
    let zero = Radians(0.0);
    squared.cell.pose = PartPose::Drawn(PoseRange {
        yaw: zero,
        pitch: zero,
        roll: zero,
        ..range
    });
    hang(&squared)
}

/// Returns the vertices of the parts on a rack that faces the camera squarely.
fn front_view(setup: &RackSetup) -> Vec<Vec<Point3<f64>>> {
    squared(setup).iter().map(Hung::vertices).collect()
}

/// Returns the left and right end of every millimetre of a part's height, from points every millimetre along its edges.
fn ends(part: &Hung) -> BTreeMap<i64, (f64, f64)> {
    let points = part.vertices();
    let line_of = |p: &Point3<f64>| (p.y / 0.001).round() as i64;
    let lines = || points.iter().map(line_of);
    let (first, last) = lines().min().zip(lines().max()).expect("vertices");
    let mut ends = vec![(f64::INFINITY, f64::NEG_INFINITY); (last - first + 1) as usize];
    for corners in &part.mesh.triangles {
        let [a, b, c] = corners.map(|corner| points[corner as usize]);
        for (a, b) in [(a, b), (b, c), (c, a)] {
            let num_steps = ((b - a).norm() / 0.001).ceil().max(1.0);
            for step in 0..num_steps as usize {
                let p = a + (b - a) * (step as f64 / num_steps);
                let (left, right) = &mut ends[(line_of(&p) - first) as usize];
                *left = left.min(p.x);
                *right = right.max(p.x);
            }
        }
    }
    let ends = (first..).zip(ends);
    ends.filter(|(_, (left, right))| left <= right).collect()
}

/// Returns the least distance along the rack from the parts on the left to each part but the first.
fn gaps(rack: &[Hung]) -> Vec<f64> {
    let all: Vec<_> = rack.iter().map(ends).collect();
    let gap_to = |number: usize| {
        let from = all[..number].iter().flatten();
        let gaps = from.filter_map(|(line, (_, end))| {
            let (start, _) = all[number].get(line)?;
            Some(start - end)
        });
        gaps.fold(f64::INFINITY, f64::min)
    };
    (1..rack.len()).map(gap_to).collect()
}

/// Returns the pixels of every part.
fn num_pixels(truth: &RackTruth) -> Vec<usize> {
    let mut counts = vec![0; truth.parts.len()];
    for label in &truth.labels {
        if let SurfaceLabel::RackPart(number) = label {
            counts[usize::from(*number)] += 1;
        }
    }
    counts
}

#[test]
fn parts_are_in_sight_from_left_to_right_whatever_the_rack() {
    // Pairs with all five seeds; of every other kind and number of places two of them, in turn.
    let single = RackKind::ALL.into_iter().enumerate();
    let single = single.filter(|(_, kind)| *kind != RackKind::Overlapping);
    let single = single.flat_map(|(k, kind)| {
        let seeds = [k as u64 % 5, (k as u64 + 2) % 5];
        (2..=5).flat_map(move |num| seeds.map(|seed| (kind, drawn(kind, num, seed))))
    });
    let single = single.map(|(kind, setup)| (kind, truth_of(&setup), setup));
    let pairs = PAIRS.iter().cloned();
    let pairs = pairs.map(|(setup, truth)| (RackKind::Overlapping, truth, setup));
    for (kind, truth, setup) in single.chain(pairs) {
        let width = setup.cell.intrinsics.width;
        let mut columns = vec![0; truth.parts.len()];
        for (pixel, label) in truth.labels.iter().enumerate() {
            if let SurfaceLabel::RackPart(number) = label {
                columns[usize::from(*number)] += pixel % width;
            }
        }
        let counts = num_pixels(&truth);
        let middles: Vec<usize> = columns.iter().zip(&counts).map(|(c, n)| c / n).collect();
        assert!(middles.is_sorted(), "{kind:?}: {middles:?}");
        for (part, count) in truth.parts.iter().zip(counts) {
            assert!(part.fully_visible, "{kind:?} {part:?}");
            assert!(
                (0.6..=1.0).contains(&part.visible_share),
                "{kind:?} {part:?}"
            );
            assert!(count > 800, "{kind:?} {part:?}: {count}");
            assert!(part.camera_from_part.translation.z < 3.7);
        }
    }
}

#[test]
fn the_visible_share_is_that_of_the_labels() {
    for (setup, truth) in PAIRS.iter().step_by(3) {
        for (number, count) in num_pixels(truth).into_iter().enumerate() {
            // Alone, the part hangs where it hung, and the rack is only it.
            let part = &truth.parts[number];
            let mut alone = setup.clone();
            alone.cell.noise = SensorNoise::none();
            alone.cell.subject = part.subject;
            alone.cell.pose = PartPose::Fixed(part.camera_from_part);
            let unhidden = crate::frame(&alone.cell).truth;
            let num_unhidden = unhidden.labels.iter();
            let num_unhidden = num_unhidden.filter(|l| **l == SurfaceLabel::Part).count();
            let share = count as f64 / num_unhidden as f64;
            assert!(
                (share - part.visible_share).abs() < 1e-9,
                "{part:?}: {share}"
            );
        }
    }
}

#[test]
fn gaps_are_as_wide_as_asked_for() {
    let apart = 0.037..0.155;
    for (kind, range) in [
        (RackKind::Apart, apart.clone()),
        (RackKind::Equal, apart.clone()),
        (RackKind::Mirrored, apart),
        (RackKind::Touching, -0.003..0.015),
    ] {
        for setup in racks(kind).step_by(2) {
            let gaps = gaps(&squared(&setup));
            let (num, places) = (setup.places.len(), &setup.places);
            assert_eq!(gaps.len(), num - 1);
            let is_as_asked = gaps.iter().all(|gap| range.contains(gap));
            assert!(is_as_asked, "{kind:?} {places:?}: {gaps:?} m");
        }
    }
}

#[test]
fn parts_that_touch_come_within_ten_millimetres_in_space() {
    for setup in racks(RackKind::Touching) {
        let parts = front_view(&setup);
        for number in 1..parts.len() {
            let left = parts[..number].concat();
            let start = parts[number]
                .iter()
                .map(|p| p.x)
                .fold(f64::INFINITY, f64::min);
            let left: Vec<_> = left.into_iter().filter(|p| p.x > start - 0.03).collect();
            let distances = parts[number]
                .iter()
                .flat_map(|p| left.iter().map(move |q| (p - q).norm()));
            let nearest = distances.fold(f64::INFINITY, f64::min);
            // The vertices are up to 10 mm apart.
            assert!(nearest < 0.02, "{:?}: {nearest} m", setup.places);
        }
    }
}

#[test]
fn a_pair_hides_up_to_a_third_and_hangs_clear() {
    let mut num_hidden = 0;
    for (setup, truth) in &*PAIRS {
        for part in &truth.parts {
            assert!(part.visible_share > 1.0 - 1.0 / 3.0, "{part:?}");
            num_hidden += usize::from(part.visible_share < 0.92);
        }
        let parts = front_view(setup);
        for neighbours in parts.windows(2) {
            let [left, right] = neighbours else { continue };
            let (left, right) = (lines(left), lines(right));
            // Where both are seen in the front view, one is at least 0.1 m behind the other.
            for (line, left) in &left {
                for (p, q) in left
                    .iter()
                    .flat_map(|p| right.get(line).into_iter().flatten().map(move |q| (p, q)))
                {
                    let is_clear = (p.z - q.z).abs() > 0.09 || (p.x - q.x).abs() > 0.012;
                    assert!(is_clear, "{:?}: {p} {q}", setup.places);
                }
            }
        }
    }
    // One pair for 2 and 3 places, two for 4 and 5.
    let num_pairs = PAIRS.len() * 3 / 2;
    assert!(
        num_hidden * 5 >= num_pairs * 3,
        "{num_hidden} of {num_pairs}"
    );
}

#[test]
fn a_kind_draws_the_set_that_it_names() {
    for seed in 0..20 {
        for num_places in 2..=5 {
            for kind in RackKind::ALL {
                let places = drawn(kind, num_places, seed).places;
                assert_eq!(places.len(), num_places);
                let num = |wanted: &dyn Fn(&SimulatedObject) -> bool| {
                    places.iter().filter(|object| wanted(object)).count()
                };
                let num_right = num(&|object| {
                    matches!(
                        object,
                        SimulatedObject::Part {
                            side: Side::Right,
                            ..
                        }
                    )
                });
                let num_pairs = places
                    .iter()
                    .enumerate()
                    .flat_map(|(k, a)| places[..k].iter().map(move |b| (a, b)));
                let (mut num_equal, mut num_mirrored) = (0, 0);
                for (a, b) in num_pairs {
                    num_equal += usize::from(a == b);
                    if let (
                        SimulatedObject::Part {
                            kind: a, side: s, ..
                        },
                        SimulatedObject::Part {
                            kind: b, side: t, ..
                        },
                    ) = (a, b)
                    {
                        num_mirrored += usize::from(a == b && s != t && a.is_sided());
                    }
                }
                let is = |wanted| usize::from(kind == wanted);
                assert_eq!(num_equal, is(RackKind::Equal), "{places:?}");
                assert_eq!(num_mirrored, is(RackKind::Mirrored), "{places:?}");
                assert_eq!(num_right, is(RackKind::Mirrored), "{places:?}");
                assert_eq!(
                    num(&|o| matches!(o, SimulatedObject::Object(_))),
                    is(RackKind::Foreign)
                );
                assert_eq!(
                    num(&|o| *o == SimulatedObject::Nothing),
                    is(RackKind::Empty)
                );
            }
        }
    }
}

#[test]
fn an_empty_place_leaves_a_gap_and_is_no_part() {
    let mut setup = drawn(RackKind::Apart, 3, 2);
    setup.places[1] = SimulatedObject::Nothing;
    let truth = taken(&setup).truth;
    let subjects: Vec<_> = truth.parts.iter().map(|part| part.subject).collect();
    assert_eq!(subjects, [setup.places[0], setup.places[2]]);
    let gaps = gaps(&squared(&setup));
    assert!(
        matches!(gaps[..], [gap] if (0.5..1.1).contains(&gap)),
        "{gaps:?}"
    );
    setup.places = vec![SimulatedObject::Nothing; 2];
    let empty = taken(&setup);
    assert!(empty.truth.parts.is_empty());
    assert!(empty.frame.depth.iter().any(|&depth| depth > 0));
}

#[test]
fn a_bar_carries_the_parts_and_things_may_lie_around_them() {
    let mut setup = drawn(RackKind::Mirrored, 3, 1);
    setup.cell.stand = Stand::Post;
    setup.cell.clutter = Clutter::OnFloor;
    let truth = taken(&setup).truth;
    let shows = |label| truth.labels.contains(&label);
    assert!(shows(SurfaceLabel::Stand) && shows(SurfaceLabel::Wall));
    assert!(!shows(SurfaceLabel::Part) && !shows(SurfaceLabel::Background));
    let columns = truth.labels.iter().enumerate();
    let columns = columns.filter(|(_, label)| **label == SurfaceLabel::Stand);
    let columns: Vec<usize> = columns.map(|(pixel, _)| pixel % 640).collect();
    let span = columns
        .iter()
        .max()
        .zip(columns.iter().min())
        .map(|(a, b)| a - b);
    assert!(span > Some(500), "the bar is over all parts: {span:?}");
}

#[test]
fn a_given_pose_is_that_of_the_middle_of_the_rack() {
    let mut setup = drawn(RackKind::Apart, 2, 6);
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.3);
    let pose =
        geometry::rigid::RigidTransform::from_parts(Vector3::new(0.1, 0.0, 2.2).into(), turn);
    setup.cell.pose = PartPose::Fixed(pose);
    let in_rack: Vec<_> = hang(&setup).iter().flat_map(Hung::vertices).collect();
    let in_rack: Vec<_> = in_rack.iter().map(|p| pose.inverse() * p).collect();
    let middle = crate::assembly::middle_of_box(&in_rack);
    assert!(middle.coords.norm() < 1e-6, "{middle}");
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_other_ones() {
    for kind in RackKind::ALL {
        let first = taken(&drawn(kind, 4, 7));
        assert_eq!(first, taken(&drawn(kind, 4, 7)));
        assert_ne!(first.frame, taken(&drawn(kind, 4, 8)).frame);
        let json = serde_json::to_value(&first.truth).unwrap();
        let back: RackTruth = serde_json::from_value(json).unwrap();
        assert_eq!(back.parts.len(), first.truth.parts.len());
        assert!(back.labels.is_empty());
    }
}

#[test]
fn what_is_out_of_range_is_refused_with_advice() {
    for num_places in [0, 1, 6, usize::MAX] {
        let refused = RackSetup::drawn(RackKind::Apart, num_places, 0, 1);
        assert_eq!(refused, Err(RackError::NumPlaces { num_places }));
    }
    let mut setup = drawn(RackKind::Apart, 2, 1);
    setup.places.truncate(1);
    let refused = rack_frame(&setup).unwrap_err();
    assert_eq!(refused.to_string(), "a rack has 2 to 5 places, not 1");
    assert!(refused.advice().contains("single part"));
    let mut booth = drawn(RackKind::Apart, 2, 1);
    booth.cell.surroundings = Surroundings::Booth;
    assert_eq!(rack_frame(&booth), Err(RackError::Booth));
}

#[test]
fn a_standing_rack_gives_the_same_frame_as_drawing_all_of_it_and_any_part_may_be_away() {
    let mut setup = drawn(RackKind::Apart, 3, 2);
    setup.cell.clutter = Clutter::OnFloor;
    let rack = StandingRack::arrange(&setup).expect("in range");
    let noise = &setup.cell.noise;
    let all = rack.frame(|_| Some(RigidTransform::identity()), noise);
    let RackFrame { frame, truth } = taken(&setup);
    assert!(all == frame);
    let without = rack.frame(|part| (part != 1).then(RigidTransform::identity), noise);
    let shows = |part: u8| {
        truth
            .labels
            .iter()
            .map(move |l| *l == SurfaceLabel::RackPart(part))
    };
    let readings = |part: u8, frame: &DepthFrame| {
        let depths = frame.depth.iter().zip(shows(part));
        let depths = depths.filter(|(depth, shown)| *shown && **depth > 0);
        depths.map(|(depth, _)| f64::from(*depth)).sum::<f64>()
    };
    // The camera looks at what is farther away.
    assert!(readings(1, &without) > 1.05 * readings(1, &frame));
    assert!((readings(0, &without) / readings(0, &frame) - 1.0).abs() < 0.01);
}
