use std::{collections::VecDeque, time::Duration};

use nalgebra::{Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
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

/// The bytes of a text in hexadecimal.
fn bytes(text: &str) -> Vec<u8> {
    let digits = (0..text.len()).step_by(2).map(|at| &text[at..at + 2]);
    let bytes = digits.map(|byte| u8::from_str_radix(byte, 16).expect("hexadecimal"));
    bytes.collect()
}

/// A message `EgmRobot` with every kind of field, number 4711, written by `abb-robot-client` 0.4.0 for Python (its `egm_pb2`, with
/// protobuf 7.36.2).
const EGM_ROBOT: &str = "\
    0a0908e7241087ad4b180212b5010a3609000000000000e03f09000000000000244009000000000000344009\
    000000000000d0bf090000000000003e4009000000000080564012600a1b090000000000448f401100000000\
    000869c0190000000080c09240122409000000000000e03f11000000000000e0bf19000000000000e03f2100\
    0000000000e03f1a1b09000000000000f03f1100000000000000401900000000000008401a12090000000000\
    001c400900000000000020402205080c10d9021a6212600a1b090000000000448f401100000000000869c019\
    0000000080c09240122409000000000000e03f11000000000000e0bf19000000000000e03f21000000000000\
    e03f1a1b09000000000000f03f110000000000000040190000000000000840220208012a02080330013a1209\
    000000000000f83f09000000000000044042020802\
    ";
/// The answer to it that the same program writes, a message `EgmSensor`: number 1, the flange at 500, -250, 1125 mm and not turned.
const EGM_SENSOR: &str = "\
    0a0808011087ad4b1803124512430a1b090000000000407f40110000000000406fc019000000000094914012\
    2409000000000000f03f110000000000000000190000000000000000210000000000000000\
    ";

#[test]
fn messages_of_egm_are_those_of_a_program_by_others() {
    let robot = bytes(EGM_ROBOT);
    let mut stream = Egm::default();
    let read = stream.receive(&robot).expect("read").expect("a report");
    let rotation = Quaternion::new(0.5, -0.5, 0.5, 0.5);
    let pose = RigidTransform::from_parts(
        Translation3::new(1.0005, -0.20025, 1.200_125),
        UnitQuaternion::from_quaternion(rotation),
    );
    let off = pose_error(&read.robot_from_flange, &pose, &Point3::origin());
    assert!(off.shift.0 < 1e-12 && off.rotation.0 < 1e-7, "{off:?}");
    let joints = [0.5, 10.0, 20.0, -0.25, 30.0, 90.0_f64].map(f64::to_radians);
    assert_eq!(read.joints, Some(joints));
    assert!(read.is_following);
    let answer = stream.answer(&RigidTransform::translation(0.5, -0.25, 1.125), false);
    assert_eq!(answer, bytes(EGM_SENSOR));
    assert!(matches!(
        stream.receive(&robot),
        Err(StreamError::OutOfOrder { number: 4711, .. })
    ));
    // The last byte says that RAPID runs; here it has stopped.
    let mut stopped = robot;
    let last = stopped.len() - 1;
    stopped[last] = 1;
    let read = Egm::default().receive(&stopped).expect("read");
    assert!(!read.expect("a report").is_following);
}

/// What Universal Robots' RTDE client library for Python (`RTDE_Python_Client_Library`, `serialize.py` of 2022) sends to open a connection for the values
/// that are read and written here; `ur-rtde` 1.6.5 sends the same, but for a comma behind the last name.
const RTDE_REQUESTS: [&[u8]; 4] = [
    b"\x00\x05V\x00\x02",
    b"\x00\x56O\x40\x5f\x40\x00\x00\x00\x00\x00actual_TCP_pose,actual_q,runtime_state,safety_status,output_int_register_24",
    b"\x00\xc4Iinput_int_register_24,input_int_register_25,input_double_register_24,input_double_register_25,\
      input_double_register_26,input_double_register_27,input_double_register_28,input_double_register_29",
    b"\x00\x03S",
];
/// A report that `ur-rtde` 1.6.5 reads as the values of the test.
const RTDE_REPORT: &str = "\
    007055013fdc000000000000bfcc0000000000003ff20000000000003fd0000000000000bff8000000000000\
    3fb00000000000003fe0000000000000bff40000000000003ffc000000000000bfc000000000000040040000\
    00000000c008000000000000000000020000000100000001\
    ";
/// The pose that the client library by Universal Robots sends with these registers.
const RTDE_POSE: &str = "\
    003c550200000001000000003fdc000000000000bfcc0000000000003ff20000000000000000000000000000\
    00000000000000000000000000000000\
    ";

#[test]
fn packages_of_rtde_are_those_of_programs_by_others() {
    let mut stream = Rtde::default();
    let answers: [(u8, &[u8]); 4] = [
        (b'V', &[1]),
        (b'O', b"\x01VECTOR6D,VECTOR6D,UINT32,INT32,INT32"),
        (
            b'I',
            b"\x02INT32,INT32,DOUBLE,DOUBLE,DOUBLE,DOUBLE,DOUBLE,DOUBLE",
        ),
        (b'S', &[1]),
    ];
    for (request, (kind, payload)) in RTDE_REQUESTS.into_iter().zip(answers) {
        assert_eq!(stream.requests(), request);
        assert_eq!(stream.receive(&rtde::package(kind, payload)), Ok(None));
    }
    let read = stream.receive(&bytes(RTDE_REPORT)).expect("read");
    let read = read.expect("a report");
    let turn = Vector3::new(0.25, -1.5, 0.0625);
    let pose = RigidTransform::from_parts(
        Translation3::new(0.4375, -0.21875, 1.125),
        UnitQuaternion::from_scaled_axis(turn),
    );
    let off = pose_error(&read.robot_from_flange, &pose, &Point3::origin());
    assert!(off.shift.0 < 1e-12 && off.rotation.0 < 1e-7, "{off:?}");
    assert_eq!(read.joints, Some([0.5, -1.25, 1.75, -0.125, 2.5, -3.0]));
    assert!(read.is_following);
    let goal = RigidTransform::translation(0.4375, -0.21875, 1.125);
    assert_eq!(stream.answer(&goal, false), bytes(RTDE_POSE));
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

#[test]
fn a_simulated_controller_refuses_what_is_no_answer() {
    let refuses = |protocol, bytes: &[u8]| controller(protocol).take(bytes).is_err();
    for package in [
        vec![0, 0, b'U'],
        vec![0, 2, b'U'],
        rtde::package(b'U', &[]),
        rtde::package(b'U', &[2; 56]),
        // A pose of no numbers.
        rtde::package(b'U', &[0xff; 57]),
    ] {
        assert!(refuses(StreamProtocol::Rtde, &package), "{package:?}");
    }
    assert!(refuses(StreamProtocol::Egm, b"hello"));
    assert!(refuses(StreamProtocol::Rsi, b"<Sen><IPOC>7</IPOC></Sen>"));
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
