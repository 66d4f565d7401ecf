//! Triggers of several clients, and servers, cameras and clients that come and go.

use super::{client::*, *};

#[test]
fn of_ten_thousand_triggers_by_several_clients_none_is_lost_or_answered_twice() {
    const CLIENTS: usize = 8;
    const EACH: usize = 1250;
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    let reply: Vec<Reply> = thread::scope(|scope| {
        let service = &service;
        let clients = (0..CLIENTS).map(|client| {
            scope.spawn(move || {
                let mut robot = service.robot(client % ALL.len());
                (0..EACH).map(|_| robot.ask("TRIGGER")).collect::<Vec<_>>()
            })
        });
        // Start all of them before waiting for the first.
        let clients: Vec<_> = clients.collect();
        let reply = clients
            .into_iter()
            .map(|client| client.join().expect("served"));
        let reply: Vec<Vec<Reply>> = reply.collect();
        for of_one in &reply {
            assert!(of_one.is_sorted_by(|a, b| a.sequence < b.sequence));
        }
        reply.into_iter().flatten().collect()
    });
    for reply in &reply {
        assert_eq!(reply.verdict, 1);
        assert_at(reply, [f64::from(reply.sequence), 250.0, 1500.0]);
    }
    let sequences: BTreeSet<u32> = reply.iter().map(|reply| reply.sequence).collect();
    assert!(sequences.into_iter().eq(1..=10_000));
    assert_eq!(service.server.num_inspected(), 10_000);
}

#[test]
fn triggers_wait_in_their_order_and_a_status_does_not() {
    let (begun, has_begun) = mpsc::channel();
    let (go_on, may_go_on) = mpsc::channel::<()>();
    let find = move |number| {
        begun.send(number).expect("awaited");
        may_go_on.recv().expect("released");
        accepted(number)
    };
    let service = Service::start(&["ascii=0"], ServerSettings::default(), find);
    let [mut first, mut second, mut other] = [0; 3].map(|index| service.robot(index));
    first.send(b"TRIGGER\n");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(1));
    second.send(b"TRIGGER\n");
    let status = other.ask("STATUS");
    assert_eq!((status.verdict, status.sequence, status.age_ms), (0, 0, -1));
    go_on.send(()).expect("awaited");
    assert_eq!(first.reply().sequence, 1);
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(2));
    assert_eq!(other.ask("LAST").sequence, 1);
    go_on.send(()).expect("awaited");
    assert_eq!(second.reply().sequence, 2);
}

#[test]
fn a_camera_that_is_lost_is_an_error_and_the_next_trigger_may_succeed() {
    let problem = Problem {
        reason: "camera_lost".into(),
        message: "the camera is gone (to do: Plug it in)".into(),
    };
    let lost = problem.clone();
    let find = move |number| match number {
        2 => Found::error(lost.clone()),
        3 => panic!("no ray for this pixel"),
        _ => accepted(number),
    };
    let service = Service::start(&["ascii=0"], ServerSettings::default(), find);
    let mut robot = service.robot(0);
    assert_eq!(robot.ask("TRIGGER").verdict, 1);
    *service.camera.lock().expect("whole") = CameraStatus {
        state: CameraState::Lost,
        problem: Some(problem),
    };
    let status = robot.ask("STATUS");
    assert_eq!((status.verdict, status.camera), (1, 2));
    assert_eq!(status.reason, "camera_lost");
    for (sequence, reason) in [(2, "camera_lost"), (3, "fault")] {
        let reply = robot.ask("TRIGGER");
        assert_eq!(
            (reply.verdict, reply.sequence, reply.age_ms),
            (5, sequence, -1)
        );
        assert_eq!(reply.reason, reason);
        assert_no_numbers(&reply);
        assert_eq!(robot.ask("LAST").verdict, 5);
    }
    *service.camera.lock().expect("whole") = CameraStatus {
        state: CameraState::Running,
        problem: None,
    };
    let reply = robot.ask("TRIGGER");
    assert_eq!((reply.verdict, reply.sequence, reply.camera), (1, 4, 1));
}

#[test]
fn whichever_side_starts_again_the_other_goes_on() {
    let mut service = Service::start(&["ascii=0"], ServerSettings::default(), accepted);
    let mut robot = service.robot(0);
    let reply = robot.ask("TRIGGER");
    // The robot restarts before it has read the answer.
    robot.send(b"TRIGGER\n");
    wait_until(|| service.server.num_inspected() == 2);
    drop(robot);
    let mut robot = service.robot(0);
    let last = robot.ask("LAST");
    assert_eq!(last.boot, reply.boot);
    assert!((1..=2).contains(&last.sequence));
    // The server restarts at the same port.
    let address = format!("ascii={}", service.addresses[0]);
    service.server.end();
    assert!(robot.is_let_go());
    let service = Service::start(&[address.as_str()], ServerSettings::default(), accepted);
    let mut robot = service.robot(0);
    let none = robot.ask("LAST");
    assert_eq!((none.verdict, none.sequence), (0, 0));
    assert_no_numbers(&none);
    assert_eq!(robot.ask("TRIGGER").sequence, 1);
}

#[test]
fn who_waits_when_the_service_ends_is_told_so() {
    let (begun, has_begun) = mpsc::channel();
    let (go_on, may_go_on) = mpsc::channel::<()>();
    let find = move |number| {
        begun.send(number).expect("awaited");
        may_go_on.recv().expect("released");
        accepted(number)
    };
    let mut service = Service::start(&["ascii=0"], ServerSettings::default(), find);
    let [mut first, mut second] = [0; 2].map(|index| service.robot(index));
    first.send(b"TRIGGER\n");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(1));
    second.send(b"TRIGGER\n");
    service.server.ask_to_end();
    go_on.send(()).expect("awaited");
    // Its inspection had begun.
    assert_eq!(first.reply().sequence, 1);
    // There is no line if the server ended before it read the request.
    let mut line = String::new();
    let _ = second.stream.read_line(&mut line);
    assert!(line.is_empty() || line.contains(";stopping;"), "{line}");
    service.server.end();
}

#[test]
fn triggers_of_clients_that_have_gone_are_not_inspected() {
    let (begun, has_begun) = mpsc::channel();
    let (go_on, may_go_on) = mpsc::channel::<()>();
    let find = move |number| {
        begun.send(number).expect("awaited");
        may_go_on.recv().expect("released");
        accepted(number)
    };
    let service = Service::start(&ALL, ServerSettings::default(), find);
    let [mut first, mut second, mut half] = [0; 3].map(|index| service.robot(index));
    first.send(b"TRIGGER\n");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(1));
    for i in 0..10 {
        let mut gone = service.robot(i % ALL.len());
        let bytes = request(&gone.protocol, "TRIGGER", 0);
        gone.send(&bytes);
    }
    // It has ended its side only, and learns why it gets no pose.
    half.send(b"TRIGGER\n");
    let ended = half.stream.get_ref().shutdown(std::net::Shutdown::Write);
    ended.expect("shut down");
    second.send(b"TRIGGER\n");
    for _ in 0..2 {
        go_on.send(()).expect("awaited");
    }
    assert_eq!(first.reply().sequence, 1);
    assert_eq!(second.reply().sequence, 2);
    let reply = half.reply();
    assert_eq!(
        (reply.verdict, &*reply.reason),
        (5, "withdrawn"),
        "{reply:?}"
    );
    assert_no_numbers(&reply);
    let mut last = service.robot(0);
    go_on.send(()).expect("awaited");
    assert_eq!(last.ask("TRIGGER").sequence, 3);
    assert_eq!(service.server.num_inspected(), 3);
}
