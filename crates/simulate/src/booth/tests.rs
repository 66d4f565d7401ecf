use std::sync::LazyLock;

use nalgebra::Point3;

use crate::{
    CellSetup, ObjectKind, PartKind, SensorNoise, Side, SimulatedFrame, SimulatedObject,
    SurfaceLabel, frame,
};

fn booth(kind: PartKind, seed: u64) -> CellSetup {
    let subject = SimulatedObject::Part {
        kind,
        side: Side::Left,
        model_seed: 0,
    };
    CellSetup::booth(subject, seed)
}

/// Shots of all kinds in turn, each with another seed.
static SHOTS: LazyLock<Vec<SimulatedFrame>> = LazyLock::new(|| {
    let kinds = PartKind::ALL.into_iter().cycle();
    let shots = kinds.zip(0..48);
    shots
        .map(|(kind, seed)| frame(&booth(kind, seed)))
        .collect()
});

#[test]
fn the_same_seed_gives_the_same_bits_and_another_one_another_booth() {
    let setup = booth(PartKind::Fender, 3);
    let first = frame(&setup);
    assert!(first == frame(&setup));
    let other = frame(&booth(PartKind::Fender, 4));
    assert_ne!(first.truth.camera_from_part, other.truth.camera_from_part);
    let again = frame(&CellSetup {
        noise: SensorNoise::kinect(99),
        ..setup
    });
    assert!(first.truth == again.truth && first.frame != again.frame);
}

#[test]
fn a_quarter_of_the_part_or_more_is_in_sight_and_often_not_all_of_it() {
    let shares: Vec<f64> = SHOTS.iter().map(|shot| shot.truth.visible_share).collect();
    assert!(
        shares.iter().all(|share| (0.2..=1.0).contains(share)),
        "{shares:?}"
    );
    let num_cut = shares.iter().filter(|share| **share < 0.8).count();
    assert!((16..=40).contains(&num_cut), "{num_cut}: {shares:?}");
    let num_small = shares.iter().filter(|share| **share < 0.45).count();
    assert!(num_small >= 3, "{shares:?}");
}

#[test]
fn what_is_in_sight_is_what_the_picture_shows() {
    for SimulatedFrame { frame, truth } in &SHOTS[..8] {
        let shown = truth.labels.iter().zip(&frame.depth);
        let is_part = |label: &SurfaceLabel| *label == SurfaceLabel::Part;
        let num_read = shown.filter(|(l, d)| is_part(l) && **d > 0).count();
        assert!(
            num_read > 5_000,
            "{num_read} readings of {:?}",
            truth.subject
        );
        assert!(!truth.fully_visible || truth.visible_share > 0.6);
    }
}

#[test]
fn the_stand_touches_the_part() {
    // In most frames, enough pixels for a clamp have a pixel of the stand next to one of the part, within 2 cm.
    let num_touching = SHOTS[..24]
        .iter()
        .filter(|SimulatedFrame { frame, truth }| {
            let width = frame.intrinsics.width;
            let depth = |pixel: usize| f64::from(frame.depth[pixel]) * frame.metres_per_unit;
            let touches = |pixel: &usize| {
                let is = |at: usize, label| truth.labels[at] == label && frame.depth[at] > 0;
                is(*pixel, SurfaceLabel::Part)
                    && [pixel + 1, pixel + width].into_iter().any(|next| {
                        next < truth.labels.len()
                            && is(next, SurfaceLabel::Stand)
                            && (depth(next) - depth(*pixel)).abs() < 0.02
                    })
            };
            (0..truth.labels.len()).filter(touches).count() >= 8
        })
        .count();
    assert!(num_touching >= 18, "{num_touching} of 24");
}

#[test]
fn an_empty_booth_has_a_stand_and_no_part() {
    for seed in 0..6 {
        let shot = frame(&CellSetup::booth(SimulatedObject::Nothing, seed));
        let has = |label| shot.truth.labels.contains(&label);
        assert!(has(SurfaceLabel::Stand) && !has(SurfaceLabel::Part));
        assert!(shot.truth.visible_share == 0.0);
    }
}

#[test]
fn a_thing_that_nobody_enrolled_lies_on_the_stand_too() {
    for (kind, seed) in ObjectKind::ALL.into_iter().zip(10..) {
        let shot = frame(&CellSetup::booth(SimulatedObject::Object(kind), seed));
        let share = shot.truth.visible_share;
        assert!(share > 0.15, "{kind:?}: {share}");
    }
}

#[test]
fn without_noise_every_reading_of_the_part_lies_on_it() {
    let setup = CellSetup {
        noise: SensorNoise::none(),
        ..booth(PartKind::TrunkLid, 5)
    };
    let SimulatedFrame { frame, truth } = frame(&setup);
    let mesh = setup.subject.mesh();
    let part_from_camera = truth.camera_from_part.inverse();
    let seen = (0..truth.labels.len())
        .filter(|&pixel| truth.labels[pixel] == SurfaceLabel::Part && frame.depth[pixel] > 0);
    for pixel in seen.step_by(997) {
        let (u, v) = (pixel % 640, pixel / 640);
        let z = f64::from(frame.depth[pixel]) * frame.metres_per_unit;
        let point: Point3<f32> =
            (part_from_camera * frame.intrinsics.point_at(u as f64, v as f64, z)).cast();
        // The mesh's vertices are a centimetre apart.
        let near = mesh.vertices.iter().map(|p| (p - point).norm());
        let nearest = near.fold(f32::INFINITY, f32::min);
        assert!(nearest < 0.012, "{nearest} m at ({u}, {v})");
    }
}
