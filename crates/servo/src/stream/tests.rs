use std::{collections::VecDeque, time::Duration};

use nalgebra::Point3;
use proptest::prelude::*;

use super::*;
use crate::{
    Fence, Look, SeenPart, Servo, ServoParams, Step, StopReason, Target, Task,
    simulated::{ArmDynamics, SimulatedArm, SimulatedController, StreamProtocol},
};
use geometry::{
    rigid::{PoseDelta, from_euler_zyx, pose_error},
    units::{Metres, Radians},
};
use robot::{
    arm::{Arm, GUN_RADIUS_M, Obstacles, PlacedArm},
    calibration::CameraPlace,
};

pub(crate) const START: Joints = [0.2, 0.3, 0.1, 0.3, 0.7, -0.2];

pub(crate) fn placed() -> PlacedArm {
    PlacedArm {
        arm: Arm::named("irb4600").expect("built in"),
        robot_from_base: RigidTransform::identity(),
        flange_from_nozzle: RigidTransform::translation(0.0, 0.0, 0.2),
        gun_radius: GUN_RADIUS_M,
        obstacles: Obstacles::default(),
    }
}

fn controller(protocol: StreamProtocol) -> SimulatedController {
    let arm = SimulatedArm::new(placed(), START, ArmDynamics::default()).expect("finite");
    SimulatedController::new(arm, placed(), protocol)
}

/// A controller, what drives it, and a camera on its flange without noise whose frames arrive late.
struct Rig {
    controller: SimulatedController,
    drive: Drive,
    task: Task,
    robot_from_part: RigidTransform,
    arriving: VecDeque<(Duration, Look)>,
    num_steps: u64,
}

impl Rig {
    fn new(protocol: StreamProtocol) -> Self {
        let controller = controller(protocol);
        let flange_from_camera = from_euler_zyx([0.1, 0.2, 0.3, 0.1, 0.0, 0.1]);
        let camera_from_part = from_euler_zyx([0.3, -0.2, 2.0, 0.0, 0.1, 1.2]);
        let moved = from_euler_zyx([0.04, -0.06, 0.05, 0.03, 0.05, -0.06]);
        let flange = controller.arm.true_flange();
        let task = Task {
            part: "door".into(),
            reference: "door".into(),
            middle: Point3::new(0.1, 0.2, 0.0),
            camera: CameraPlace::OnFlange {
                flange_from_camera,
                capture_pose: None,
            },
            target: Target::SeenAt {
                camera_from_part: camera_from_part * moved,
            },
        };
        let servo = Servo::new(task.clone(), ServoParams::default(), Fence::none());
        let stream = protocol.stream(&placed());
        let mut rig = Self {
            drive: Drive::new(stream, servo.expect("sound parameters")),
            robot_from_part: flange * flange_from_camera * camera_from_part,
            controller,
            task,
            arriving: VecDeque::new(),
            num_steps: 0,
        };
        let opening = rig.drive.opening();
        rig.exchange(opening, Duration::ZERO);
        rig
    }

    /// Sends this, and what is sent in return, until neither side has more to say.
    fn exchange(&mut self, mut send: Vec<u8>, at: Duration) {
        while !send.is_empty() {
            let answer = self.controller.take(&send).expect("read");
            send = if answer.is_empty() {
                answer
            } else {
                self.drive.take(&answer, at).send
            };
        }
    }

    /// A step of the arm with its frames; `change` may change or drop the report.
    fn step(&mut self, change: impl Fn(Vec<u8>) -> Option<Vec<u8>>) -> Option<Step> {
        self.controller.arm.advance();
        let at = self.controller.arm.state().at;
        if self.num_steps.is_multiple_of(8) {
            let camera = self.controller.arm.true_flange() * self.task.camera.mount_from_camera();
            let seen = SeenPart {
                camera_from_part: camera.inverse() * self.robot_from_part,
                bounds: PoseDelta {
                    shift: Metres(0.002),
                    rotation: Radians(0.003),
                },
                is_approximate: false,
            };
            let look = Look {
                taken_at: at,
                seen: Ok(seen),
            };
            self.arriving
                .push_back((at + Duration::from_millis(100), look));
        }
        self.num_steps += 1;
        if let Some((_, look)) = self.arriving.pop_front_if(|(due, _)| *due <= at) {
            self.drive.look(look);
        }
        let report = change(self.controller.report())?;
        let driven = self.drive.take(&report, at);
        assert_eq!(driven.problem, None);
        self.exchange(driven.send, at);
        driven.step
    }

    /// Runs until it arrives or stops.
    fn end(&mut self, change: impl Fn(u64, Vec<u8>) -> Option<Vec<u8>>) -> Step {
        for number in 0..3000 {
            match self.step(|report| change(number, report)) {
                Some(end @ (Step::Done(_) | Step::Stop(_))) => return end,
                Some(Step::Command(_)) | None => {}
            }
        }
        panic!("it runs on: {:?}", self.drive.servo().held());
    }
}

#[test]
fn a_robot_of_each_protocol_is_driven_to_the_target_also_if_reports_are_lost() {
    for protocol in StreamProtocol::ALL {
        for lost in [u64::MAX, 10] {
            let mut rig = Rig::new(protocol);
            let end = rig.end(|number, report| (number % lost != lost - 1).then_some(report));
            assert!(matches!(end, Step::Done(_)), "{protocol:?}: {end:?}");
            let Target::SeenAt { camera_from_part } = rig.task.target else {
                panic!("the camera has a target");
            };
            let camera = rig.controller.arm.true_flange() * rig.task.camera.mount_from_camera();
            let seen = camera.inverse() * rig.robot_from_part;
            let left = pose_error(&seen, &camera_from_part, &rig.task.middle);
            let is_there = left.shift.mm() < 0.6 && left.rotation.degrees() < 0.06;
            assert!(is_there, "{protocol:?}: {left:?}");
            // It is held there.
            let before = rig.controller.arm.state().robot_from_flange;
            for _ in 0..20 {
                rig.step(Some);
            }
            let after = rig.controller.arm.state().robot_from_flange;
            assert!(pose_error(&before, &after, &Point3::origin()).shift.mm() < 1e-3);
        }
    }
}

#[test]
fn a_program_that_ends_on_the_way_stops_it_and_one_that_has_not_begun_is_waited_for() {
    for protocol in [StreamProtocol::Egm, StreamProtocol::Rtde] {
        let mut rig = Rig::new(protocol);
        rig.controller.is_running = false;
        for _ in 0..100 {
            assert!(matches!(rig.step(Some), Some(Step::Command(_))));
        }
        let start = rig.controller.arm.state().robot_from_flange;
        rig.controller.is_running = true;
        for _ in 0..80 {
            rig.step(Some);
        }
        let moved = rig.controller.arm.state().robot_from_flange;
        assert!(pose_error(&start, &moved, &Point3::origin()).shift.mm() > 5.0);
        rig.controller.is_running = false;
        assert_eq!(
            rig.end(|_, report| Some(report)),
            Step::Stop(StopReason::RobotStopped)
        );
    }
}

#[test]
fn reports_that_end_stop_it_and_repeated_ones_have_no_answer() {
    for protocol in [StreamProtocol::Egm, StreamProtocol::Rsi] {
        let mut rig = Rig::new(protocol);
        let silent = |number: u64, report| (!(50..70).contains(&number)).then_some(report);
        let Step::Stop(reason) = rig.end(silent) else {
            panic!("it goes on");
        };
        assert_eq!(reason.kind(), "arm_times");

        let mut rig = Rig::new(protocol);
        let report = rig.controller.report();
        let first = rig.drive.take(&report, Duration::from_millis(12));
        assert!(!first.send.is_empty());
        let again = rig.drive.take(&report, Duration::from_millis(13));
        let problem = again.problem.expect("refused");
        assert!(
            matches!(problem, StreamError::OutOfOrder { .. }),
            "{problem}"
        );
        assert!(again.send.is_empty() && again.step.is_none());
    }
}

#[test]
fn a_report_is_read_as_it_was_written_and_answered_in_kind() {
    for protocol in StreamProtocol::ALL {
        let mut rig = Rig::new(protocol);
        let state = rig.controller.arm.state();
        let report = rig.controller.report();
        let mut stream = protocol.stream(&placed());
        let mut send = stream.requests();
        while !send.is_empty() {
            let answer = rig.controller.take(&send).expect("read");
            assert_eq!(stream.receive(&answer), Ok(None));
            send = stream.requests();
        }
        // In one piece, and for a stream of bytes in several.
        let cut = if protocol == StreamProtocol::Rtde {
            7
        } else {
            report.len()
        };
        let (start, end) = report.split_at(cut);
        let mut read = stream.receive(start).expect("read");
        if !end.is_empty() {
            assert_eq!(read, None);
            read = stream.receive(end).expect("read");
        }
        let read = read.expect("whole");
        let off = pose_error(
            &read.robot_from_flange,
            &state.robot_from_flange,
            &Point3::origin(),
        );
        assert!(
            off.shift.mm() < 1e-3 && off.rotation.degrees() < 1e-4,
            "{off:?}"
        );
        let (joints, reported) = (state.joints.expect("known"), read.joints.expect("reported"));
        assert!(
            joints
                .iter()
                .zip(reported)
                .all(|(a, b)| (a - b).abs() < 1e-7)
        );
        assert!(read.is_following);

        let goal = RigidTransform::translation(0.01, 0.0, -0.02) * state.robot_from_flange;
        let answer = stream.answer(&goal, false);
        rig.controller.take(&answer).expect("an answer");
        for _ in 0..200 {
            rig.controller.arm.advance();
        }
        let off = pose_error(
            &rig.controller.arm.state().robot_from_flange,
            &goal,
            &Point3::origin(),
        );
        assert!(off.shift.mm() < 0.01, "{protocol:?}: {off:?}");
    }
}

#[test]
fn a_number_that_is_missing_is_not_zero() {
    let mut pose = egm::Pose::new(&RigidTransform::translation(0.3, 0.4, 0.5));
    pose.position.as_mut().expect("written").y = None;
    let report = egm::Robot {
        header: Some(egm::Header {
            number: Some(7),
            ..Default::default()
        }),
        feedback: Some(egm::Position {
            joints: None,
            pose: Some(pose),
        }),
        ..Default::default()
    };
    let bytes = prost::Message::encode_to_vec(&report);
    let lacks = StreamError::Lacks {
        protocol: "EGM",
        what: "the pose of the flange",
    };
    assert_eq!(Egm::default().receive(&bytes), Err(lacks));

    let packet = "<Rob><AIPos A1=\"0\" A2=\"0\" A3=\"0\" A4=\"0\" A6=\"0\"/><IPOC>1</IPOC></Rob>";
    let lacks = StreamError::Lacks {
        protocol: "RSI",
        what: "AIPos with A1 to A6",
    };
    assert_eq!(Rsi::new(placed()).receive(packet.as_bytes()), Err(lacks));
}

#[test]
fn joints_that_are_no_numbers_are_not_known() {
    let flange = RigidTransform::translation(0.3, 0.4, 0.5);
    let reported = |first: f64| {
        let report = egm::Robot {
            header: Some(egm::Header {
                number: Some(7),
                ..Default::default()
            }),
            feedback: Some(egm::Position {
                joints: Some(egm::Angles {
                    values: vec![first, 10.0, 20.0, 0.0, 30.0, 0.0],
                }),
                pose: Some(egm::Pose::new(&flange)),
            }),
            ..Default::default()
        };
        let bytes = prost::Message::encode_to_vec(&report);
        let read = Egm::default().receive(&bytes).expect("read");
        read.expect("a report").joints.is_some()
    };
    assert!(reported(0.0) && !reported(f64::NAN) && !reported(f64::INFINITY));
}

#[test]
fn a_controller_that_lacks_a_register_or_has_it_in_use_is_refused() {
    for (kind, wanted) in [
        ("NOT_FOUND", "actual_TCP_pose"),
        ("IN_USE", "input_int_register_24"),
    ] {
        let mut stream = Rtde::default();
        assert_eq!(stream.requests(), [0, 5, b'V', 0, 2]);
        let mut take = |kind, payload: &[u8]| stream.receive(&rtde::package(kind, payload));
        assert_eq!(take(b'V', &[1]), Ok(None));
        let outputs = b"\x01VECTOR6D,VECTOR6D,UINT32,INT32,INT32";
        let first = if kind == "NOT_FOUND" {
            take(b'O', b"\x01NOT_FOUND,VECTOR6D,UINT32,INT32,INT32")
        } else {
            assert_eq!(take(b'O', outputs), Ok(None));
            take(
                b'I',
                b"\x02IN_USE,INT32,DOUBLE,DOUBLE,DOUBLE,DOUBLE,DOUBLE,DOUBLE",
            )
        };
        let what = format!("{wanted} ({kind})");
        assert_eq!(first, Err(StreamError::Refused { what }));
    }
}

proptest! {
    /// For any bytes: no panic, nothing kept beyond a package, and no report of numbers that are not finite.
    #[test]
    fn any_bytes_are_a_report_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..600)) {
        for protocol in StreamProtocol::ALL {
            let mut stream = protocol.stream(&placed());
            if let Ok(Some(report)) = stream.receive(&bytes) {
                prop_assert!(geometry::rigid::is_finite(&report.robot_from_flange));
            }
        }
    }

    /// A report with changed bytes.
    #[test]
    fn a_damaged_report_is_read_as_finite_or_refused(
        at in 0_usize..400,
        with in any::<u8>(),
        cut in 0_usize..400,
    ) {
        for protocol in StreamProtocol::ALL {
            let mut rig = Rig::new(protocol);
            let mut report = rig.controller.report();
            let length = report.len();
            report[at % length] = with;
            if with % 2 == 0 {
                report.truncate(cut % length);
            }
            let driven = rig.drive.take(&report, Duration::from_millis(12));
            if let Some(Step::Command(pose)) = driven.step {
                prop_assert!(geometry::rigid::is_finite(&pose));
            }
        }
    }
}
