//! Requests that are wrong, endless, many or none.

use super::{client::*, *};

/// Sets the flag when dropped, to end the threads that watch it.
struct EndAtLast<'a>(&'a AtomicBool);

impl Drop for EndAtLast<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

#[test]
fn hostile_clients_do_not_disturb_a_good_one() {
    let settings = ServerSettings {
        max_clients: 24,
        request_timeout: Duration::from_millis(200),
        ..ServerSettings::default()
    };
    let service = Service::start(&ALL, settings, accepted);
    // They connect before any other client does.
    let mut good: Vec<Robot> = (0..ALL.len()).map(|index| service.robot(index)).collect();
    for robot in &mut good {
        assert_eq!(robot.ask("STATUS").verdict, 0);
    }
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        for (i, address) in service.addresses.iter().enumerate() {
            let address = *address;
            let is_over = &is_over;
            // The server may do anything with a hostile client: it continues with a new connection.
            let attack = move |bytes: &[u8], num: usize| {
                while !is_over.load(Ordering::SeqCst) {
                    thread::sleep(Duration::from_millis(1));
                    let Ok(mut stream) = TcpStream::connect(address) else {
                        continue;
                    };
                    let _ = stream.set_write_timeout(Some(Duration::from_millis(50)));
                    let _ = stream.set_read_timeout(Some(Duration::from_millis(50)));
                    for _ in 0..num {
                        if stream.write_all(bytes).is_err() {
                            break;
                        }
                    }
                    let mut answer = [0; 64];
                    let _ = stream.read(&mut answer);
                }
            };
            let protocol = ALL[i].split('=').next().expect("a protocol");
            let half = request(protocol, "LAST", 0)[..3].to_vec();
            // Half a request, meaningless bytes, and a gigabyte without a line end.
            scope.spawn(move || attack(&half, 1));
            scope.spawn(move || attack(&[0xff, 0x00, 0x80, b'<', b'R', b'\n'], 100));
            scope.spawn(move || attack(&vec![b'A'; 65_536], 16_384));
        }
        // Ends the attacks even if a good client fails.
        let _end = EndAtLast(&is_over);
        for round in 0..40 {
            for robot in &mut good {
                let reply = robot.ask("TRIGGER");
                assert_eq!(reply.verdict, 1, "round {round}: {reply:?}");
                assert_at(&reply, [f64::from(reply.sequence), 250.0, 1500.0]);
            }
        }
    });
    assert_eq!(service.server.num_inspected(), 200);
    // The places of the hostile clients become free again.
    for index in 0..ALL.len() {
        wait_until(|| {
            let mut robot = service.robot(index);
            robot.ask("STATUS").verdict != 6
        });
    }
}

#[test]
fn a_thousand_connections_leave_the_good_one_alone_and_get_an_answer() {
    let settings = ServerSettings {
        max_clients: 2,
        ..ServerSettings::default()
    };
    let service = Service::start(&ALL, settings, accepted);
    let mut good = service.robot(0);
    let mut other = service.robot(1);
    assert_eq!(good.ask("TRIGGER").sequence, 1);
    assert_eq!(other.ask("LAST").sequence, 1);
    for i in 0..1000 {
        let mut robot = service.robot(i % ALL.len());
        if i % 100 < ALL.len() {
            let reply = robot.reply();
            assert_eq!(
                (reply.verdict, reply.sequence),
                (6, 0),
                "{}",
                robot.protocol
            );
            assert_no_numbers(&reply);
            assert!(robot.is_let_go());
        }
    }
    assert_eq!(good.ask("TRIGGER").sequence, 2);
    service.wait_for(|news| *news == ClientNews::TurnedAway);
    drop(other);
    wait_until(|| {
        let mut robot = service.robot(0);
        robot.ask("LAST").sequence == 2
    });
}

#[test]
fn of_a_gigabyte_without_an_end_hardly_anything_is_read() {
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    for index in 0..ALL.len() {
        let mut robot = service.robot(index);
        let stream = robot.stream.get_mut();
        let chunk = vec![b'A'; 65_536];
        let chunks = (0..16_384).take_while(|_| stream.write_all(&chunk).is_ok());
        let num_taken = chunks.count();
        // What both sides of the connection buffer, and what the server discards so that the client can read why.
        assert!(num_taken < 1024, "{}: {num_taken}", robot.protocol);
        assert_eq!(service.robot(index).ask("TRIGGER").verdict, 1);
    }
}

#[test]
fn a_thousand_silent_connections_make_room_for_others() {
    /// Connections that are open at a time: systems allow a program about a thousand.
    const HELD: usize = 500;
    let settings = ServerSettings {
        max_clients: 4,
        request_timeout: PATIENCE,
        ..ServerSettings::default()
    };
    let service = Service::start(&ALL, settings, accepted);
    let mut kept = service.robot(0);
    assert_eq!(kept.ask("TRIGGER").sequence, 1);
    let mut silent = VecDeque::new();
    for i in 0..1000 {
        let mut robot = service.robot(i % ALL.len());
        // Every second one sends half a request.
        if i % 2 == 0 {
            let half = request(&robot.protocol, "TRIGGER", 0)[..3].to_vec();
            robot.send(&half);
        }
        silent.push_back(robot);
        if silent.len() > HELD {
            silent.pop_front();
        }
        if i % 100 == 99 {
            assert_eq!(kept.ask("LAST").verdict, 1);
        }
    }
    // Until the silent connections have been there for a moment, there is no place.
    let connected = |index| {
        let until = Instant::now() + PATIENCE;
        loop {
            let mut robot = service.robot(index);
            if robot.ask("LAST").verdict != 6 {
                return robot;
            }
            assert!(Instant::now() < until, "there is no place");
            thread::sleep(Duration::from_millis(20));
        }
    };
    for index in 0..ALL.len() {
        let reply = connected(index).ask("TRIGGER");
        assert_eq!((reply.verdict, reply.sequence), (1, index as u32 + 2));
    }
    assert_eq!(kept.ask("TRIGGER").sequence, ALL.len() as u32 + 2);
    // Whoever has sent a request keeps its place.
    let others = [1, 2, 3].map(connected);
    assert_eq!(service.robot(4).reply().verdict, 6);
    assert_eq!(others.map(|mut robot| robot.ask("LAST").verdict), [1; 3]);
    assert_eq!(kept.ask("LAST").verdict, 1);
}

#[test]
fn a_bad_request_is_answered_with_its_reason_and_the_connection_closed() {
    let settings = ServerSettings {
        request_timeout: Duration::from_millis(50),
        ..ServerSettings::default()
    };
    let service = Service::start(&ALL, settings, accepted);
    let mut version = request("binary", "TRIGGER", 0);
    version[4] = 9;
    let mut checksum = request("binary-be", "TRIGGER", 0);
    checksum[19] ^= 1;
    for (index, bytes, reason) in [
        (0, b"START\n".to_vec(), "unknown_request"),
        (0, vec![b'A'; 5000], "too_long"),
        (0, b"TRIG".to_vec(), "incomplete"),
        (1, b"GET / HTTP/1.1\r\n\r\n".to_vec(), "magic"),
        (1, version, "version"),
        (2, checksum, "checksum"),
        (
            2,
            request("binary-be", "TRIGGER", 0)[..19].to_vec(),
            "incomplete",
        ),
        (3, b"TRIGGER\n".to_vec(), "not_xml"),
        (
            3,
            b"<Robot><Request>TRIGGER</Request>".to_vec(),
            "incomplete",
        ),
        (4, b"PATH x\n".to_vec(), "no_point"),
        (0, b"SERVO 3 1200 -400\n".to_vec(), "bad_pose"),
        (0, [b"SERVO 3", &[b' '; 600][..]].concat(), "too_long"),
        (0, b"SERVO 3 1200 -400 1900 0".to_vec(), "incomplete"),
        (1, frame("binary", "SERVO", &[3]), "length"),
        (1, frame("binary", "SERVO", &[3; 15]), "bad_pose"),
        (2, frame("binary-be", "SERVO", &[u32::MAX; 15]), "bad_pose"),
        (
            3,
            b"<Robot><Request>SERVO</Request><Expected>3</Expected></Robot>".to_vec(),
            "bad_pose",
        ),
        (4, b"SERVO 3 p[nan,0,0,0,0,0]\n".to_vec(), "bad_pose"),
    ] {
        let mut robot = service.robot(index);
        robot.send(&bytes);
        let reply = robot.reply();
        assert_eq!(reply.verdict, 7, "{reason}");
        assert_no_numbers(&reply);
        if robot.protocol != "urscript" {
            assert_eq!(reply.reason, reason);
        }
        assert!(robot.is_let_go(), "{reason}");
        // The client may connect again.
        assert_eq!(service.robot(index).ask("LAST").verdict, 0);
    }
    assert_eq!(service.server.num_inspected(), 0);
    service.wait_for(|news| matches!(news, ClientNews::BadRequest(_)));
}

#[test]
fn a_server_that_moves_no_robot_says_so_and_the_connection_stays_open() {
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    let mut robot = service.robot(0);
    robot.send(b"SERVO 3 1200 -400 1900 0 0 0\n");
    let mut line = String::new();
    robot.stream.read_line(&mut line).expect("a line");
    assert!(line.starts_with("SERVO;error;1;"), "{line}");
    assert!(line.contains(";no_servoing;"), "{line}");
    assert_eq!(line.matches(';').count(), 23, "{line}");
    // It is no inspection that anyone asks for.
    assert_eq!(robot.ask("LAST").verdict, 0);
    let triggered = robot.ask("TRIGGER");
    assert_eq!((triggered.verdict, triggered.sequence), (1, 2));
}

#[test]
fn a_request_in_pieces_and_several_at_once_are_answered_one_by_one() {
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    for index in 0..ALL.len() {
        let mut robot = service.robot(index);
        let protocol = robot.protocol.clone();
        let before = robot.ask("LAST").sequence;
        for byte in request(&protocol, "TRIGGER", 0) {
            robot.send(&[byte]);
        }
        assert_eq!(robot.reply().sequence, before + 1);
        let three = request(&protocol, "TRIGGER", 0).repeat(3);
        robot.send(&three);
        for i in 2..=4 {
            assert_eq!(robot.reply().sequence, before + i);
        }
    }
}

#[test]
fn a_client_that_asks_for_nothing_is_let_go() {
    let settings = ServerSettings {
        idle_timeout: Duration::from_millis(50),
        ..ServerSettings::default()
    };
    let service = Service::start(&["ascii=0"], settings, accepted);
    assert!(service.robot(0).is_let_go());
    service.wait_for(|news| *news == ClientNews::Left);
}
