//! Frames that agree, and frames that do not.

use super::*;
use geometry::rigid::from_euler_zyx;
use stages::pose::PoseError;

fn part(name: &str, score: f64, rejected: Option<Rejection>) -> Verdict {
    Verdict::Part {
        part: name.into(),
        score,
        margin: 0.9,
        rejected,
        is_approximate: false,
    }
}

fn unlike(name: &str) -> Rejection {
    Rejection::Unknown {
        nearest: name.into(),
        score: 0.2,
    }
}

fn consensus(frames: impl IntoIterator<Item = (Verdict, f64)>) -> Consensus {
    consensus_every(33, frames)
}

/// The same, with this many milliseconds from frame to frame.
fn consensus_every(ms: u64, frames: impl IntoIterator<Item = (Verdict, f64)>) -> Consensus {
    let mut all = Consensus::new(ConsensusParams::default());
    for (number, (verdict, x)) in frames.into_iter().enumerate() {
        all.frames.push_back(FrameVerdict {
            at: Duration::from_millis(ms * number as u64),
            verdict,
            reference: Some("door".into()),
            camera_from_part: Some(from_euler_zyx([0.0, 0.0, 0.0, x, 0.0, 1.2])),
            middle: Point3::origin(),
        });
    }
    all
}

fn agreed(frames: impl IntoIterator<Item = (Verdict, f64)>) -> Option<ConsensusVerdict> {
    consensus(frames).agreed(Duration::ZERO, Duration::ZERO, &AcceptParams::default())
}

#[test]
fn frames_that_agree_are_accepted_with_the_median_score_and_the_mean_pose() {
    let frames = (0..10).map(|i| {
        (
            part("door", 0.95 + 0.001 * f64::from(i), None),
            0.0005 * f64::from(i % 3),
        )
    });
    let found = agreed(frames).expect("enough frames");
    assert_eq!((found.num_frames, found.num_agreeing), (10, 10));
    let Verdict::Part {
        score,
        rejected: None,
        ..
    } = found.verdict
    else {
        panic!("{:?}", found.verdict);
    };
    assert!((score - 0.954).abs() < 1e-9);
    let pose = found.pose.expect("a pose");
    assert!((pose.camera_from_part.translation.x - 0.000_45).abs() < 1e-9);
}

#[test]
fn too_few_frames_say_nothing_and_those_from_before_do_not_count() {
    let frames = || (0..4).map(|_| (part("door", 0.99, None), 0.0));
    assert_eq!(agreed(frames()), None);
    let seven = consensus((0..7).map(|_| (part("door", 0.99, None), 0.0)));
    let since = Duration::from_millis(33 * 3);
    assert_eq!(seven.agreed(since, since, &AcceptParams::default()), None);
    assert_eq!(seven.gathered(since), (4, 5));
}

#[test]
fn few_frames_are_enough_if_they_are_far_apart_and_all_say_the_same() {
    let frames = |scores: &[Option<f64>], away: f64| {
        let frames = scores.iter().enumerate().map(|(i, score)| {
            let verdict = match score {
                Some(score) => part("door", *score, None),
                None => part("door", 0.2, Some(unlike("door"))),
            };
            (verdict, away * i as f64)
        });
        frames.collect::<Vec<_>>()
    };
    let agreed = |ms, frames: Vec<(Verdict, f64)>| {
        let all = consensus_every(ms, frames);
        all.agreed(Duration::ZERO, Duration::ZERO, &AcceptParams::default())
    };
    let accepted = agreed(500, frames(&[Some(0.99); 3], 0.0)).expect("1 s apart");
    assert!(accepted.verdict.is_accepted() && accepted.num_frames == 3);
    assert!(agreed(1000, frames(&[Some(0.99); 2], 0.0)).is_some());
    let refused = agreed(1000, frames(&[None; 2], 0.0)).expect("both refuse it");
    assert_eq!(refused.verdict.rejected(), Some(&unlike("door")));
    // One alone, two in quick succession, frames that differ, and poses that do.
    assert_eq!(agreed(1000, frames(&[Some(0.99)], 0.0)), None);
    assert_eq!(agreed(500, frames(&[Some(0.99); 2], 0.0)), None);
    let split = [Some(0.99), None, Some(0.99)];
    assert_eq!(agreed(500, frames(&split, 0.0)), None);
    assert_eq!(agreed(500, frames(&[Some(0.99); 3], 0.02)), None);
    // One that accepts the part, or refuses it for another reason, and one for which it fits another part almost as well.
    let alike = Rejection::SmallMargin {
        part: "door".into(),
        other: "door_copy".into(),
        margin: 0.02,
        threshold: 0.05,
    };
    for rejected in [None, Some(unlike("door"))] {
        let mut two = frames(&[Some(0.99); 2], 0.0);
        two[0].0 = part("door", 0.97, rejected);
        two[1].0 = part("door", 0.97, Some(alike.clone()));
        assert_eq!(agreed(1000, two), None);
    }
}

#[test]
fn of_few_frames_none_counts_that_may_show_the_part_coming_to_rest() {
    // At the first, it is 5 mm from where it comes to rest.
    let of = |ms, num: usize| {
        let places = [0.005, 0.0, 0.0, 0.0, 0.0];
        let frames = places.iter().take(num);
        let all = consensus_every(ms, frames.map(|x| (part("door", 0.99, None), *x)));
        let rested = Duration::from_millis(300);
        all.agreed(Duration::ZERO, rested, &AcceptParams::default())
    };
    assert_eq!(of(1000, 2), None);
    let found = of(1000, 3).expect("two at rest");
    assert_eq!((found.num_frames, found.num_agreeing), (2, 2));
    let pose = found.pose.expect("a pose");
    assert!(pose.camera_from_part.translation.x.abs() < 1e-9);
    // Among many, it does little harm.
    assert_eq!(of(100, 5).expect("enough frames").num_frames, 5);
}

#[test]
fn one_frame_that_accepts_another_part_is_enough_to_reject() {
    let mut frames: Vec<_> = (0..10).map(|_| (part("door", 0.99, None), 0.0)).collect();
    frames[3].0 = part("fender", 0.93, None);
    let found = agreed(frames).expect("enough frames");
    let expected = Rejection::Undecided {
        part: "door".into(),
        num_agreeing: 9,
        num_frames: 10,
        needed: 8,
    };
    assert_eq!(found.verdict.rejected(), Some(&expected));
    // A frame that names another part without accepting it is only a bad frame among good ones.
    let mut frames: Vec<_> = (0..10).map(|_| (part("door", 0.99, None), 0.0)).collect();
    frames[3].0 = part("fender", 0.4, Some(unlike("fender")));
    assert!(agreed(frames).expect("enough frames").verdict.is_accepted());
}

#[test]
fn too_many_rejections_are_a_rejection_by_what_most_of_them_say() {
    let mix = |num_rejecting: usize| {
        (0..10).map(move |i| {
            let rejected = (i < num_rejecting).then(|| unlike("door"));
            (part("door", 0.97, rejected), 0.0)
        })
    };
    assert!(agreed(mix(2)).expect("enough").verdict.is_accepted());
    let split = agreed(mix(4)).expect("enough");
    assert!(matches!(
        split.verdict.rejected(),
        Some(Rejection::Undecided {
            num_agreeing: 6,
            ..
        })
    ));
    let most = agreed(mix(9)).expect("enough");
    assert_eq!(most.verdict.rejected(), Some(&unlike("door")));
}

#[test]
fn scattered_poses_are_not_accepted() {
    let frames = (0..10).map(|i| (part("door", 0.99, None), 0.01 * f64::from(i % 2)));
    let found = agreed(frames).expect("enough frames");
    assert!(matches!(
        found.verdict.rejected(),
        Some(Rejection::PosesApart {
            num_agreeing: 5,
            num_frames: 10,
            ..
        })
    ));
}

#[test]
fn poses_of_two_references_are_not_one_pose_though_they_lie_together() {
    let of_last = |num_of_other: usize, last: &str| {
        let mut all = consensus((0..10).map(|_| (part("door", 0.99, None), 0.0)));
        for frame in all.frames.iter_mut().take(num_of_other) {
            frame.reference = Some("door_b".into());
        }
        all.frames[9].reference = Some(last.into());
        all.agreed(Duration::ZERO, Duration::ZERO, &AcceptParams::default())
            .expect("enough frames")
    };
    assert!(of_last(2, "door").verdict.is_accepted());
    // Most frames agree, but the poses of the last frame's reference are too few.
    for (num_of_other, last, num_agreeing) in [(0, "door_b", 1), (3, "door", 7)] {
        let found = of_last(num_of_other, last);
        let complaint = found.verdict.rejected();
        assert!(
            matches!(complaint, Some(Rejection::PosesApart { num_agreeing: num, .. }) if *num == num_agreeing),
            "{complaint:?}"
        );
    }
}

#[test]
fn a_median_below_the_threshold_is_not_accepted_though_frames_were() {
    // This happens when the threshold is raised between two frames.
    let frames = (0..10).map(|_| (part("door", 0.85, None), 0.0));
    assert!(!agreed(frames).expect("enough frames").verdict.is_accepted());
}

#[test]
fn an_empty_cell_stays_one_and_a_part_beside_it_is_undecided() {
    let no_part = || Verdict::NoPart(crate::pipeline::Unrecognisable::EmptyLibrary);
    let found = agreed((0..6).map(|_| (no_part(), 0.0))).expect("enough frames");
    assert_eq!((found.verdict.clone(), found.num_agreeing), (no_part(), 6));
    let half = |i: usize| {
        if i < 5 {
            no_part()
        } else {
            part("door", 0.99, None)
        }
    };
    let found = agreed((0..10).map(|i| (half(i), 0.0))).expect("enough frames");
    assert!(!found.verdict.is_accepted());
}

#[test]
fn no_pose_where_none_was_found_rejects_as_the_frames_do() {
    let no_pose = Rejection::NoPose(PoseError::NoReferenceCloud);
    let frames = (0..6).map(|_| (part("door", 0.99, Some(no_pose.clone())), 0.0));
    let mut all = consensus(frames);
    all.frames
        .iter_mut()
        .for_each(|frame| frame.camera_from_part = None);
    let found = all
        .agreed(Duration::ZERO, Duration::ZERO, &AcceptParams::default())
        .expect("enough");
    assert_eq!(
        (found.verdict.rejected(), found.pose),
        (Some(&no_pose), None)
    );
}

#[test]
fn frames_that_take_it_for_one_of_two_parts_by_turns_name_both_as_a_single_frame_does() {
    let alike = |part: &str, other: &str| Rejection::SmallMargin {
        part: part.into(),
        other: other.into(),
        margin: 0.02,
        threshold: 0.05,
    };
    let by_turns = |i: usize| match i % 3 {
        0 => part("door", 0.97, Some(alike("door", "door_copy"))),
        1 => part("door_copy", 0.97, Some(alike("door_copy", "door"))),
        // In a few frames the lead is large enough.
        _ if i == 5 => part("door_copy", 0.97, None),
        _ => part("door", 0.97, None),
    };
    let found = agreed((0..10).map(|i| (by_turns(i), 0.0))).expect("enough frames");
    assert_eq!(
        found.verdict.rejected(),
        Some(&alike("door", "door_copy")),
        "{found:?}"
    );
    // With a third part among them, the frames are undecided.
    let mut frames: Vec<_> = (0..10).map(|i| (by_turns(i), 0.0)).collect();
    for frame in &mut frames[..3] {
        frame.0 = part("fender", 0.97, None);
    }
    let found = agreed(frames).expect("enough frames");
    assert!(
        matches!(found.verdict.rejected(), Some(Rejection::Undecided { .. })),
        "{found:?}"
    );
}
