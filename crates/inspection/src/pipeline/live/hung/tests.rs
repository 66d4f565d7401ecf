//! Sequences of frames of the simulated cell, each inspected once, as parts hung one after the other would give them.

use std::sync::Arc;

use nalgebra::Translation3;

use super::*;
use crate::{
    fixtures::shipped_library,
    library::Library,
    pipeline::{Recipe, Unwatched, live::MeanPose, run},
};
use simulate::{
    CellSetup, ObjectKind, PartKind, PartPose, PoseRange, SensorNoise, Side, SimulatedObject,
};
use stages::fixtures::scene_of;

/// A frame with its own inspection.
struct Seen {
    scene: Arc<SceneCloud>,
    inspection: Inspection,
}

fn seen(library: &Library, subject: SimulatedObject, aside: f64) -> Seen {
    let mut setup = CellSetup::new(subject, 3);
    setup.noise = SensorNoise::kinect((aside * 1000.0) as u64 + 5);
    if subject != SimulatedObject::Nothing {
        let placed = PoseRange::facing().draw(&subject.mesh(), &setup.intrinsics, 3);
        let moved = Translation3::new(aside, 0.0, 0.0) * placed.camera_from_part;
        setup.pose = PartPose::Fixed(moved);
    }
    let scene = scene_of(&setup);
    Seen {
        inspection: run(&scene, library, &Recipe::default(), &Unwatched).expect("not cancelled"),
        scene: Arc::new(scene),
    }
}

fn part(kind: PartKind) -> SimulatedObject {
    SimulatedObject::Part {
        kind,
        side: Side::Left,
        model_seed: 0,
    }
}

/// Follows such frames at four per second.
#[derive(Default)]
struct Line {
    parts: HungParts,
    num_frames: u32,
}

impl Line {
    fn open(&mut self, seen: &Seen) -> (Left, FrameRole) {
        self.see(seen, &LiveVerdict::Open, "")
    }

    /// A frame whose own verdict counts at once.
    fn counted(&mut self, seen: &Seen, inputs: &str) -> (Left, FrameRole) {
        let pose = seen.inspection.found_pose();
        let agreed = ConsensusVerdict {
            verdict: seen.inspection.verdict.clone(),
            num_frames: 5,
            num_agreeing: 5,
            pose: pose.map(|pose| MeanPose {
                camera_from_part: pose.camera_from_part(),
                num_agreeing: 5,
            }),
        };
        self.see(seen, &LiveVerdict::Counted(Box::new(agreed)), inputs)
    }

    fn see(&mut self, seen: &Seen, verdict: &LiveVerdict, inputs: &str) -> (Left, FrameRole) {
        self.num_frames += 1;
        self.parts.see(&HungFrame {
            scene: &seen.scene,
            at: Duration::from_millis(250) * self.num_frames,
            inspection: &seen.inspection,
            verdict,
            middle: None,
            inputs,
        })
    }
}

const NOTHING: (Left, FrameRole) = (Left::Nothing, FrameRole::Nothing);
const FIRST: (Left, FrameRole) = (Left::Nothing, FrameRole::First);
const AGAIN: (Left, FrameRole) = (Left::Nothing, FrameRole::Again);

#[test]
fn one_part_after_the_other_is_one_inspection_each_also_at_the_same_place() {
    let library = shipped_library();
    let fender = seen(&library, part(PartKind::Fender), 0.0);
    let empty = seen(&library, SimulatedObject::Nothing, 0.0);
    assert!(fender.inspection.verdict.is_accepted());
    let mut line = Line::default();
    for visit in 1..=3 {
        assert_eq!(line.open(&fender).1, FrameRole::Best);
        assert_eq!(line.open(&fender), NOTHING);
        assert_eq!(line.counted(&fender, ""), FIRST);
        for _ in 0..20 {
            assert_eq!(line.counted(&fender, ""), NOTHING);
        }
        assert_eq!(line.parts.visit(), visit);
        for _ in 0..3 {
            assert_eq!(line.open(&empty), NOTHING);
        }
    }
    // The next part hangs in the same place at once: one empty frame between them is enough.
    assert_eq!(line.counted(&fender, ""), FIRST);
    assert_eq!(line.open(&empty), NOTHING);
    assert_eq!(line.open(&fender), NOTHING);
    assert_eq!(line.counted(&fender, ""), FIRST);
    assert_eq!(line.parts.visit(), 5);
}

#[test]
fn another_verdict_recipe_or_place_is_the_same_part_again() {
    let library = shipped_library();
    let fender = seen(&library, part(PartKind::Fender), 0.0);
    let mut refused = Seen {
        scene: Arc::clone(&fender.scene),
        inspection: fender.inspection.clone(),
    };
    if let Verdict::Part { part, rejected, .. } = &mut refused.inspection.verdict {
        let part = part.clone();
        *rejected = Some(crate::pipeline::Rejection::NotSteady { part });
    }
    let aside = seen(&library, part(PartKind::Fender), 0.05);
    let mut line = Line::default();
    assert_eq!(
        line.counted(&refused, "a"),
        (Left::Nothing, FrameRole::First)
    );
    assert_eq!(line.counted(&fender, "a"), AGAIN);
    // Each verdict is reported once, however often it changes.
    assert_eq!(line.counted(&refused, "a"), NOTHING);
    assert_eq!(line.counted(&fender, "a"), NOTHING);
    assert_eq!(line.counted(&fender, "b"), AGAIN);
    // A person walks by.
    assert_eq!(line.open(&fender), NOTHING);
    assert_eq!(line.counted(&fender, "b"), NOTHING);
    // A person pushes it.
    assert_eq!(line.open(&aside), NOTHING);
    assert_eq!(line.counted(&aside, "b"), AGAIN);
    assert_eq!(line.parts.visit(), 1);
}

#[test]
fn another_accepted_part_after_seconds_without_frames_is_a_part_of_its_own() {
    let library = shipped_library();
    let fender = seen(&library, part(PartKind::Fender), 0.0);
    let door = seen(&library, part(PartKind::FrontDoor), 0.0);
    assert!(door.inspection.verdict.is_accepted());
    let mut line = Line::default();
    assert_eq!(line.counted(&fender, ""), FIRST);
    line.num_frames += 20;
    assert_eq!(line.counted(&fender, ""), NOTHING);
    line.num_frames += 20;
    assert_eq!(line.open(&door).1, FrameRole::Best);
    assert_eq!(line.counted(&door, ""), FIRST);
    assert_eq!(line.parts.visit(), 2);
}

#[test]
fn what_leaves_before_its_verdict_counts_is_told_once_it_has_left_if_it_looked_like_a_part() {
    let library = shipped_library();
    let fender = seen(&library, part(PartKind::Fender), 0.0);
    let wheel = seen(&library, SimulatedObject::Object(ObjectKind::Wheel), 0.0);
    let empty = seen(&library, SimulatedObject::Nothing, 0.0);
    assert!(wheel.inspection.verdict.is_unknown());
    let mut line = Line::default();
    assert_eq!(line.open(&wheel).1, FrameRole::Best);
    // A frame that looks like a part is better than one that does not.
    assert_eq!(line.open(&fender).1, FrameRole::Best);
    assert_eq!(line.open(&wheel), NOTHING);
    assert_eq!(line.open(&empty), NOTHING, "one frame may miss it");
    assert_eq!(line.open(&empty), NOTHING);
    assert_eq!(line.open(&empty), (Left::Part, FrameRole::Nothing));
    assert_eq!(line.open(&empty), NOTHING);
    assert_eq!(line.open(&wheel).1, FrameRole::Best);
    let left: Vec<Left> = (0..4).map(|_| line.open(&empty).0).collect();
    assert_eq!(left.iter().filter(|left| **left == Left::Other).count(), 1);
    // Captures seconds apart of different parts.
    let door = seen(&library, part(PartKind::FrontDoor), 0.0);
    line.num_frames += 20;
    assert_eq!(line.open(&fender), (Left::Nothing, FrameRole::Best));
    line.num_frames += 20;
    assert_eq!(line.open(&door), (Left::Part, FrameRole::Best));
    line.num_frames += 20;
    assert_eq!(line.counted(&door, ""), FIRST);
    // After a long time without a frame it may be another part.
    line.num_frames += 100;
    assert_eq!(line.counted(&door, ""), FIRST);
}
