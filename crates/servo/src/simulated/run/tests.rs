use super::*;
use crate::simulated::{
    ArmDynamics, CellPart, CellSetup, Disturbance, HandEyeError, SimulatedTarget,
};
use inspection::fixtures::shipped_library;
use simulate::PartKind;

fn setup(disturbance: Disturbance) -> CellSetup {
    CellSetup {
        part: CellPart::Simulated(PartKind::Fender),
        target: SimulatedTarget::Standard,
        noise: 1.0,
        start: (Metres(0.25), Radians::from_degrees(25.0)),
        hand_eye: HandEyeError {
            shift: Metres::from_mm(20.0),
            turn: Radians::from_degrees(2.0),
        },
        frame_period: Duration::from_millis(100),
        delay: Duration::from_millis(150),
        dynamics: ArmDynamics::default(),
        disturbance,
        seed: 3_000_007,
    }
}

#[test]
fn a_part_is_servoed_to_although_the_calibration_is_wrong_and_frames_are_late() {
    let library = shipped_library();
    let cell = SimulatedCell::arrange(setup(Disturbance::None), &library).expect("a start");
    let params = ServoParams::default();
    let result = run(&cell, &params).expect("sound parameters");
    assert!(matches!(result.end, Step::Done(_)), "{:?}", result.end);
    let [start, end] = result.errors().expect("steps");
    assert!(start.shift.mm() > 50.0);
    assert!(
        end.shift.mm() < 2.0 && end.rotation.degrees() < 0.2,
        "{end:?}"
    );
    let limits = params.limits;
    let most = result.most();
    let limits = [
        limits.speed,
        limits.acceleration,
        limits.turn_speed,
        limits.turn_acceleration,
    ];
    assert!(most.iter().zip(limits).all(|(most, limit)| *most <= limit));
    assert_eq!((result.num_moved_blindly(), result.num_unreachable), (0, 0));
    assert!(result.least_distance > 0.3);
}

#[test]
fn a_part_that_is_taken_away_stops_it_on_the_way() {
    let library = shipped_library();
    let cell = SimulatedCell::arrange(setup(Disturbance::Removed), &library).expect("a start");
    let result = run(&cell, &ServoParams::default()).expect("sound parameters");
    let Step::Stop(reason) = &result.end else {
        panic!("{:?}", result.end);
    };
    assert_eq!(reason.kind(), "not_accepted");
    assert!(!result.hangs);
    assert_eq!(result.num_moved_blindly(), 0);
    let [_, end] = result.errors().expect("steps");
    assert!(end.shift.mm() > 5.0, "it was gone before: {end:?}");
}
