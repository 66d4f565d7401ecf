//! End-to-end tests on frames of the simulated cell with the shipped parts.

use super::*;
use crate::{
    fixtures::shipped_library,
    pipeline::{Recipe, Unwatched, run},
};
use geometry::{depth_frame::DepthFrame, rigid::RigidTransform};
use simulate::{PartKind, SensorNoise, fixtures::HangingPart};
use stages::scene::scene_from_frame;

const FRAME: Duration = Duration::from_micros(33_333);

fn scene(part: &HangingPart, number: u64, x: f64) -> Arc<SceneCloud> {
    let noise = SensorNoise::kinect(part.setup.seed * 1000 + number);
    let moved = RigidTransform::translation(x, 0.0, 0.0);
    Arc::new(scene_from_frame(&part.frame(noise, &moved)))
}

/// The frame of a camera without noise.
fn truth(part: &HangingPart) -> DepthFrame {
    part.frame(SensorNoise::none(), &RigidTransform::identity())
}

#[test]
fn a_part_is_accepted_once_it_hangs_still_and_no_longer_when_it_moves() {
    let library = shipped_library();
    let recipe = Recipe::default();
    let part = HangingPart::new(PartKind::Fender, 3);
    let follow = || {
        let mut watch = LiveTracker::new(&LiveParams::default());
        let states = (0..52_u64).map(|number| {
            // Still, then moving away at 20 cm/s.
            let x = if number < 40 {
                0.0
            } else {
                0.2 / 30.0 * (number - 39) as f64
            };
            let scene = watch.look(scene(&part, number, x), FRAME * number as u32, None);
            // Every frame is looked at, but not every one can be inspected in time.
            if number % 4 != 0 && number < 40 {
                return None;
            }
            let mut inspection = run(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
            let own = inspection.verdict.is_accepted();
            let standing = watch.judge(0, &mut inspection, None, &recipe.accept);
            Some((number, own, standing, inspection.verdict))
        });
        states.flatten().collect::<Vec<_>>()
    };
    let states = follow();
    for (number, own, standing, verdict) in &states {
        match number {
            0..=23 => {
                assert!(*own, "frame {number} by itself");
                assert!(!verdict.is_accepted(), "{number}: {standing:?}");
            }
            36..=39 => {
                let agreed = standing.counted().expect("counted");
                assert!(
                    agreed.num_frames >= 5 && verdict.is_accepted(),
                    "{standing:?}"
                );
            }
            41.. => assert!(!verdict.is_accepted(), "{number}: {standing:?}"),
            // The frames just before the verdict counts, and the first frame of the motion.
            24..=35 | 40 => {}
        }
    }
    // The same frames give the same verdicts, bit for bit.
    assert_eq!(follow(), states);
}

#[test]
fn a_frame_that_names_another_part_than_the_verdict_that_counts_gives_no_pose() {
    let part = HangingPart::new(PartKind::Fender, 3);
    let scene = scene(&part, 1, 0.0);
    let seen = run(&scene, &shipped_library(), &Recipe::default(), &Unwatched);
    let seen = seen.expect("not cancelled");
    for (name, has_pose) in [("fender", true), ("grille", false)] {
        let mut inspection = seen.clone();
        let agreed = ConsensusVerdict {
            verdict: Verdict::Part {
                part: name.into(),
                score: 0.1,
                margin: 0.0,
                rejected: Some(Rejection::Mirrored {
                    part: name.into(),
                    score: 0.97,
                }),
                is_approximate: false,
            },
            num_frames: 10,
            num_agreeing: 9,
            pose: None,
        };
        LiveVerdict::Counted(Box::new(agreed)).overwrite_verdict(&mut inspection);
        assert!(inspection.verdict.is_mirrored());
        assert_eq!(inspection.pose.is_some(), has_pose, "{name}");
    }
}

#[test]
fn the_field_of_view_that_earlier_frames_showed_is_known_of_a_part_alone() {
    let part = HangingPart::new(PartKind::FrontDoor, 4);
    let within = |margins: [usize; 2]| {
        let mut frame = truth(&part);
        let [width, height] = [frame.intrinsics.width, frame.intrinsics.height];
        for (i, depth) in frame.depth.iter_mut().enumerate() {
            let (u, v) = (i % width, i / width);
            let is_inside =
                |at: usize, size: usize, margin: usize| (margin..size - margin).contains(&at);
            if !(is_inside(u, width, margins[0]) && is_inside(v, height, margins[1])) {
                *depth = 0;
            } else if *depth == 0 {
                *depth = 1500;
            }
        }
        Arc::new(scene_from_frame(&frame))
    };
    let is_inner = |scene: &SceneCloud| scene.field_of_view().is_some_and(FieldOfView::is_inner);
    let mut watch = LiveTracker::new(&LiveParams::default());
    let (whole, alone) = (within([60, 40]), within([230, 150]));
    assert!(is_inner(&whole) && !is_inner(&alone));
    watch.look(whole, FRAME, None);
    assert!(is_inner(&watch.look(alone, FRAME * 2, None)));
}

#[test]
fn an_averaged_depth_is_nearer_to_the_truth_and_has_nothing_between_surfaces() {
    let part = HangingPart::new(PartKind::FrontDoor, 4);
    let truth = truth(&part);
    let errors = |num: usize| depth_errors(&part, &truth, num);
    let [one, four, sixteen] = [1, 4, 16].map(errors);
    // Independent errors fall with the root of their number, to 0.5 and 0.25; the limits leave a margin.
    assert!(four.rms < 0.62 * one.rms, "{four:?} of {one:?}");
    assert!(sixteen.rms < 0.40 * one.rms, "{sixteen:?} of {one:?}");
    // Flying pixels at the outline and holes are no more frequent than in a single frame.
    assert!(
        sixteen.share_between <= one.share_between,
        "{sixteen:?} of {one:?}"
    );
    assert!(
        sixteen.share_read >= one.share_read,
        "{sixteen:?} of {one:?}"
    );
}

#[test]
fn no_frame_from_before_the_rest_is_averaged() {
    let part = HangingPart::new(PartKind::FrontDoor, 4);
    let mut watch = LiveTracker::new(&LiveParams {
        average: 4,
        ..LiveParams::default()
    });
    // One run: it moved at the first frame, and has hung still since the second.
    let of = |state| Some(SceneMotion { state, run: 1 });
    let since = FRAME;
    let still = |number: u32| {
        of(MotionState::Steady {
            since,
            lasting: FRAME * (number - 1),
        })
    };
    watch.look(
        scene(&part, 0, 0.1),
        Duration::ZERO,
        of(MotionState::Moving),
    );
    for number in 1..=2 {
        let looked = scene(&part, u64::from(number), 0.0);
        watch.look(looked, FRAME * number, still(number));
        assert_eq!(watch.num_averaged(), number as usize);
    }
}

/// Prints the effect of averaging, for the documentation.
#[test]
#[ignore = "a table"]
fn table_of_averages() {
    for kind in [PartKind::FrontDoor, PartKind::Grille] {
        let part = HangingPart::new(kind, 4);
        let truth = truth(&part);
        for num in [1, 2, 4, 8, 16] {
            println!("{kind} {num:>2} {:?}", depth_errors(&part, &truth, num));
        }
    }
}

#[derive(Debug)]
struct DepthErrors {
    /// Noise of the readings on their surface, metres.
    rms: f64,
    /// Share of the readings off their surface.
    share_between: f64,
    /// Share of the pixels with a reading.
    share_read: f64,
}

fn depth_errors(part: &HangingPart, truth: &DepthFrame, num_frames: usize) -> DepthErrors {
    /// A reading further off than this is not on its surface, metres at 1 m.
    const OFF: f64 = 0.012;
    let mut average = DepthAverage::over(num_frames);
    for number in 0..num_frames as u64 {
        average.add(&scene(part, number, 0.0), FRAME * number as u32);
    }
    let mean = average.mean().expect("frames");
    let (mut sum_sq, mut num_on, mut num_off) = (0.0, 0.0, 0.0_f64);
    for (p, units) in mean.cloud.points.iter().zip(&truth.depth) {
        let true_z = f64::from(*units) * truth.metres_per_unit;
        if p.z > 0.0 && true_z > 0.0 {
            let off = f64::from(p.z) - true_z;
            if off.abs() < OFF * true_z * true_z {
                sum_sq += off * off;
                num_on += 1.0;
            } else {
                num_off += 1.0;
            }
        }
    }
    DepthErrors {
        rms: f64::sqrt(sum_sq / num_on),
        share_between: num_off / (num_on + num_off),
        share_read: (num_on + num_off) / truth.depth.len() as f64,
    }
}
