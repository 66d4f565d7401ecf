use super::*;
use geometry::{
    rigid::RigidTransform,
    units::{Metres, Radians},
};
use inspection::{fixtures::shipped_library, library::Library};
use servo::{
    Servo, ServoParams, ServoState,
    simulated::{
        ArmDynamics, CellPart, CellSetup, Disturbance, HandEyeError, SimulatedCell,
        SimulatedTarget, StreamProtocol,
    },
};
use simulate::PartKind;

/// A start near the target, so that it takes few seconds.
fn setup() -> CellSetup {
    CellSetup {
        part: CellPart::Simulated(PartKind::Fender),
        target: SimulatedTarget::Standard,
        noise: 1.0,
        start: (Metres(0.04), Radians::from_degrees(4.0)),
        hand_eye: HandEyeError {
            shift: Metres::from_mm(20.0),
            turn: Radians::from_degrees(2.0),
        },
        frame_period: Duration::from_millis(100),
        delay: Duration::ZERO,
        dynamics: ArmDynamics::default(),
        disturbance: Disturbance::None,
        seed: 5,
    }
}

/// Runs over a protocol; `on_news` gets the number of looks.
fn run(
    library: &Library,
    protocol: StreamProtocol,
    mut on_news: impl FnMut(usize) -> ServoOrder,
) -> (Step, PoseDelta) {
    let cell = SimulatedCell::arrange(setup(), library).expect("a start");
    let (robot, mut link) =
        SimulatedRobot::start(cell.controller(protocol), protocol).expect("loopback");
    let servo = Servo::new(
        cell.task.clone(),
        ServoParams::default(),
        cell.fence.clone(),
    )
    .expect("sound");
    let mut drive = Drive::new(cell.stream(protocol), servo);
    let mut number = 0;
    let next_look = |is_over: &AtomicBool| {
        number += 1;
        let look = |flange: &RigidTransform, at| cell.look(flange, at, number);
        robot.look(Duration::ZERO, is_over, look)
    };
    let mut num_looks = 0;
    let now = || robot.now().0;
    let end = super::servo(&mut link, &mut drive, &now, next_look, |news| {
        num_looks += usize::from(matches!(news, Some(ServoNews::Looked { .. })));
        on_news(num_looks)
    });
    let (at, flange) = robot.now();
    (end.expect("connected"), cell.true_error(&flange, at))
}

#[test]
fn a_simulated_robot_is_brought_to_its_target_over_the_network_in_each_protocol() {
    let library = shipped_library();
    // They sleep most of the time.
    thread::scope(|scope| {
        for protocol in StreamProtocol::ALL {
            let library = &library;
            scope.spawn(move || {
                let (end, error) = run(library, protocol, |_| ServoOrder::GoOn);
                assert!(matches!(end, Step::Done(_)), "{protocol:?}: {end:?}");
                assert!(
                    error.shift.mm() < 2.0 && error.rotation.degrees() < 0.2,
                    "{protocol:?}: {error:?}"
                );
            });
        }
    });
}

#[test]
fn a_person_who_stops_it_stops_it() {
    let stop_at_third = |num| match num {
        3.. => ServoOrder::Stop,
        _ => ServoOrder::GoOn,
    };
    let (end, _) = run(&shipped_library(), StreamProtocol::Egm, stop_at_third);
    assert_eq!(end, Step::Stop(StopReason::ByPerson));
}

#[test]
fn a_run_leaves_its_row_with_its_curve() {
    let library = shipped_library();
    let job = ServoJob {
        part: "fender",
        title: "Fender, left",
        library: &library,
        longest_step: None,
    };
    let mut news = Vec::new();
    let outcome = servo_simulated(
        &job,
        &ServoParams::default(),
        StreamProtocol::Egm,
        &SimulatedTrial::default(),
        |said| {
            news.extend(said);
            ServoOrder::GoOn
        },
    );
    let outcome = outcome.expect("a start");
    assert!(matches!(news.first(), Some(ServoNews::Begins { .. })));
    let Ok(Step::Done(arrival)) = outcome.end else {
        panic!("{:?}", outcome.end);
    };
    let record = outcome.record.expect("a row");
    let run = &record.run;
    assert_eq!(
        (run.title.as_str(), run.target.name()),
        ("Fender, left", "standard_position")
    );
    assert!(run.stopped.is_none() && run.is_simulated, "{run:?}");
    assert_eq!(run.error_m, Some(arrival.error.shift.0));
    assert_eq!(run.bounds_rad, Some(arrival.bounds.rotation.0));
    assert_eq!(
        (run.took_s, run.num_looks),
        (arrival.took.as_secs_f64(), record.curve.len())
    );
    let states: Vec<ServoState> = record.curve.iter().map(|sample| sample.state).collect();
    assert_eq!(states[0], ServoState::Looking);
    assert!(states.contains(&ServoState::Moving) && states.contains(&ServoState::Checking));
    let errors: Vec<f64> = record
        .curve
        .iter()
        .filter_map(|sample| sample.error_m)
        .collect();
    assert!(
        errors[0] > 0.05 && errors[errors.len() - 1] < 0.003,
        "{errors:?}"
    );
    assert!(record.curve.is_sorted_by_key(|sample| sample.at_s));
}

#[test]
fn a_trial_has_the_delay_the_calibration_and_the_play_that_were_asked_for() {
    let library = shipped_library();
    let job = ServoJob {
        part: "fender",
        title: "Fender, left",
        library: &library,
        longest_step: None,
    };
    let late = SimulatedTrial {
        delay: Duration::from_millis(150),
        hand_eye: HandEyeError {
            shift: Metres::from_mm(5.0),
            turn: Radians::from_degrees(1.0),
        },
        play: Radians::from_degrees(0.01),
        seed: 2,
        ..SimulatedTrial::default()
    };
    let (mut delays, mut tasks) = (Vec::new(), Vec::new());
    let params = ServoParams::default();
    let outcome = servo_simulated(&job, &params, StreamProtocol::Egm, &late, |news| {
        match news {
            Some(ServoNews::Looked { delay, .. }) => delays.push(delay),
            Some(ServoNews::Begins { task, .. }) => tasks.push(task),
            _ => {}
        }
        ServoOrder::GoOn
    });
    let outcome = outcome.expect("a start");
    assert!(
        matches!(outcome.end, Ok(Step::Done(_))),
        "{:?}",
        outcome.end
    );
    assert!(!delays.is_empty() && delays.iter().all(|delay| *delay >= late.delay));
    // The calibration is wrong, but by no more than was asked for.
    let exact = SimulatedTrial {
        hand_eye: HandEyeError {
            shift: Metres(0.0),
            turn: Radians(0.0),
        },
        ..late
    };
    let cell = exact.arrange("fender", &library).expect("a start");
    let camera = tasks[0].camera.mount_from_camera();
    let wrong = geometry::rigid::pose_error(
        camera,
        cell.task.camera.mount_from_camera(),
        &nalgebra::Point3::origin(),
    );
    assert!(
        wrong.shift.mm() > 0.01 && wrong.shift.mm() < 5.001,
        "{wrong:?}"
    );
    assert!(wrong.rotation.degrees() < 1.001, "{wrong:?}");
    // With play, the flange is not where its motors are.
    let away = |play| {
        let trial = SimulatedTrial { play, ..late };
        let cell = trial.arrange("fender", &library).expect("a start");
        let mut arm = cell.arm();
        let goal = RigidTransform::translation(0.0, 0.0, 0.02) * arm.state().robot_from_flange;
        arm.go(&goal).expect("within reach");
        let is = arm.true_flange();
        (is.translation.vector - goal.translation.vector).norm()
    };
    assert!(away(Radians(0.0)) < 1e-6);
    assert!(away(Radians::from_degrees(0.05)) > 1e-5);
}

#[test]
fn in_steps_the_robot_waits_for_each_order_and_a_stopped_run_has_its_row_too() {
    let library = shipped_library();
    let job = ServoJob {
        part: "fender",
        title: "Fender, left",
        library: &library,
        longest_step: Some(PoseDelta {
            shift: Metres(0.05),
            rotation: Radians::from_degrees(5.0),
        }),
    };
    let (mut num_waiting, mut num_moving) = (0, 0);
    let outcome = servo_simulated(
        &job,
        &ServoParams::default(),
        StreamProtocol::Egm,
        &SimulatedTrial::default(),
        |news| {
            let Some(ServoNews::Looked {
                standing: Some(standing),
                ..
            }) = news
            else {
                return ServoOrder::GoOn;
            };
            match standing.state {
                ServoState::Moving => num_moving += 1,
                ServoState::Waiting => num_waiting += 1,
                _ => {}
            }
            match num_waiting {
                5 => ServoOrder::Step,
                10 => ServoOrder::Stop,
                _ => ServoOrder::GoOn,
            }
        },
    );
    let outcome = outcome.expect("a start");
    assert_eq!(
        outcome.end.expect("connected"),
        Step::Stop(StopReason::ByPerson)
    );
    assert!(
        num_moving > 0 && num_waiting >= 10,
        "{num_moving} {num_waiting}"
    );
    let record = outcome.record.expect("a row");
    assert_eq!(record.run.stopped, Some(StopReason::ByPerson));
    assert!(record.run.error_m.expect("known") > 0.01 && record.run.bounds_m.is_none());
}

#[test]
fn a_robot_that_does_not_answer_and_an_address_that_is_none_are_said() {
    let unused: RobotAddress = "ur=127.0.0.1:9".parse().expect("an address");
    let error = RobotLink::open(&unused).err().expect("refused");
    assert!(matches!(error, LinkError::Connect { .. }), "{error}");
    for text in ["egm", "egm=", "abb=6510", "ur=robot", "rsi=127.0.0.1"] {
        let error = text.parse::<RobotAddress>().expect_err(text);
        assert!(
            matches!(error, LinkError::Address { .. }),
            "{text}: {error}"
        );
    }
    let ur: RobotAddress = "ur=192.168.1.20".parse().expect("an address");
    assert_eq!(ur.to_string(), "ur=192.168.1.20:30004");
    let rsi: RobotAddress = "rsi=49152".parse().expect("a port");
    assert!(matches!(rsi.stream(None).err(), Some(LinkError::NoArm)));
}

#[test]
fn packets_of_others_are_ignored_once_the_robot_has_reported() {
    let mut link = RobotLink::open(&"egm=0".parse().expect("any port")).expect("loopback");
    let [robot, other] = [(); 2].map(|()| {
        let socket = std::net::UdpSocket::bind("127.0.0.1:0").expect("bound");
        socket.connect(link.address()).expect("loopback");
        socket
    });
    let received = |link: &mut RobotLink| link.receive(Duration::from_secs(5)).expect("open");
    other.send(b"hello").expect("sent");
    assert_eq!(received(&mut link).as_deref(), Some(&b"hello"[..]));
    robot.send(b"first").expect("sent");
    assert_eq!(received(&mut link).as_deref(), Some(&b"first"[..]));
    let at = robot.local_addr().expect("bound");
    link.expect_simulated(at.ip());
    assert_eq!(link.reported().expect("the simulated one"), at);
    other.send(b"hostile").expect("sent");
    assert_eq!(received(&mut link), None);
    robot.send(b"second").expect("sent");
    assert_eq!(received(&mut link).as_deref(), Some(&b"second"[..]));
    // An address that no computer has.
    link.expect_simulated([192, 0, 2, 1].into());
    let error = link.reported().expect_err("a real robot");
    assert!(matches!(error, LinkError::OtherRobot { .. }), "{error}");
}
