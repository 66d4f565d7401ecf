//! What robots get to know.

use super::{client::*, *};

#[test]
fn every_protocol_triggers_asks_again_and_fetches_the_path() {
    let service = Service::start(&ALL, ServerSettings::default(), accepted);
    for index in 0..ALL.len() {
        let mut robot = service.robot(index);
        let has_texts = robot.protocol != "urscript";
        let triggered = robot.ask("TRIGGER");
        let sequence = index as u32 + 1;
        assert_eq!(
            (triggered.verdict, triggered.sequence, triggered.camera),
            (1, sequence, 1)
        );
        assert_at(&triggered, [f64::from(sequence), 250.0, 1500.0]);
        assert_eq!((triggered.number, triggered.points), (4, 2));
        assert_eq!(triggered.flags, u32::from(Answer::POSE | Answer::SIMULATED));
        assert_eq!(triggered.part, if has_texts { "fender" } else { "" });
        assert!((0..600_000).contains(&triggered.age_ms));
        let again = robot.ask("LAST");
        assert_eq!(again.numbers, triggered.numbers);
        assert_eq!(
            (again.sequence, again.boot),
            (triggered.sequence, triggered.boot)
        );
        assert!(again.boot > 0 && again.age_ms >= triggered.age_ms);
        let status = robot.ask("STATUS");
        assert_eq!((status.verdict, status.sequence), (1, sequence));
        assert!(status.numbers.is_empty());
        let count = robot.ask_point("PATH", 0);
        assert_eq!((count.points, count.point), (2, 0));
        assert!(count.numbers.is_empty());
        let first = robot.ask_point("PATH", 1);
        assert_at(&first, [7.0, 250.0, 1500.0]);
        assert_eq!(
            (first.point, first.points, first.sequence),
            (1, 2, sequence)
        );
        assert!((first.speed_mm_s - 250.0).abs() < 1e-9);
        assert_eq!(first.flags & u32::from(Answer::GUN_ON), 8);
        let second = robot.ask_point("PATH", 2);
        assert_at(&second, [8.0, 250.0, 1500.0]);
        assert_eq!(second.flags & u32::from(Answer::GUN_ON), 0);
        let beyond = robot.ask_point("PATH", 3);
        assert_eq!((beyond.verdict, beyond.flags & 1), (7, 0));
        assert!(beyond.numbers.is_empty());
    }
    assert_eq!(service.server.num_inspected(), 5);
}

#[test]
fn a_refused_part_and_a_stale_pose_have_no_numbers() {
    let service = Service::start(&ALL, ServerSettings::default(), refused);
    let never_fresh = ServerSettings {
        max_age: Duration::ZERO,
        ..ServerSettings::default()
    };
    let old = |number| Found {
        captured: Instant::now().checked_sub(Duration::from_secs(1)),
        ..accepted(number)
    };
    let stale = Service::start(&ALL, never_fresh, old);
    for (service, verdict, reason) in [(&service, 2, "low_score"), (&stale, 4, "stale")] {
        for index in 0..ALL.len() {
            let mut robot = service.robot(index);
            for (word, point) in [
                ("TRIGGER", 0),
                ("LAST", 0),
                ("STATUS", 0),
                ("PATH", 0),
                ("PATH", 1),
            ] {
                let reply = robot.ask_point(word, point);
                assert_eq!(reply.verdict, verdict, "{} {word}", robot.protocol);
                assert_eq!(reply.sequence, index as u32 + 1);
                assert_no_numbers(&reply);
                if robot.protocol != "urscript" {
                    assert_eq!(reply.reason, reason);
                }
            }
        }
    }
}

/// The parts of the frame with this number: 2, 8, none, and an accepted one beside a refused one.
fn several(frame: u32) -> FrameParts {
    let all = |num| (1..=num).map(|part| accepted(1000 * frame + part));
    let parts: Vec<Found> = match frame % 4 {
        1 => all(2).collect(),
        2 => all(8).collect(),
        3 => vec![Found {
            verdict: VerdictCode::NoPart,
            part: String::new(),
            ..refused(0)
        }],
        _ => vec![accepted(1000 * frame + 1), refused(2)],
    };
    let mut parts = parts.into_iter();
    FrameParts {
        first: parts.next().expect("one at least"),
        others: parts.collect(),
        ..FrameParts::default()
    }
}

#[test]
fn every_protocol_gives_the_parts_of_a_frame_one_by_one_and_a_trigger_the_first() {
    let service = Service::start(&ALL, ServerSettings::default(), several);
    let mut frame = 0;
    let mut next_sequence = 1;
    for index in 0..ALL.len() {
        let mut robot = service.robot(index);
        let none = robot.ask_point("PART", 1);
        assert_eq!((none.verdict, none.numbers.len()), (7, 0), "not triggered");
        for num_parts in [2, 8, 0, 2] {
            frame += 1;
            let triggered = robot.ask("TRIGGER");
            assert_eq!(triggered.sequence, next_sequence);
            let count = robot.ask_point("PART", 0);
            assert_eq!((count.point, count.points), (0, num_parts));
            assert_eq!(count.verdict, triggered.verdict);
            assert!(count.numbers.is_empty());
            for part in 1..=num_parts {
                let sequence = next_sequence + part - 1;
                let own = robot.ask_point("PART", part);
                assert_eq!((own.point, own.points), (part, num_parts));
                assert_eq!(own.sequence, sequence);
                // As from any of the numbers of its frame.
                let named = robot.ask_of(next_sequence + num_parts - 1, "PART", part);
                assert_eq!(named.numbers, own.numbers);
                let point = robot.ask_of(sequence, "PATH", 1);
                assert_eq!(point.sequence, sequence);
                if frame % 4 == 0 && part == 2 {
                    assert_eq!((own.verdict, own.numbers.len()), (2, 0), "refused");
                    assert_eq!((point.verdict, point.numbers.len()), (2, 0));
                } else {
                    let x = f64::from(1000 * frame + part);
                    assert_at(&own, [x, 250.0, 1500.0]);
                    assert_at(&point, [7.0, 250.0, 1500.0]);
                }
            }
            if num_parts > 0 {
                assert_at(&triggered, [f64::from(1000 * frame + 1), 250.0, 1500.0]);
            }
            let beyond = robot.ask_point("PART", num_parts + 1);
            assert_eq!((beyond.verdict, beyond.numbers.len()), (7, 0));
            assert_eq!(beyond.sequence, next_sequence);
            if robot.protocol != "urscript" {
                assert_eq!(beyond.reason, "no_such_part");
            }
            assert_eq!(robot.ask("LAST").numbers, triggered.numbers);
            next_sequence += num_parts.max(1);
        }
    }
}

#[test]
fn a_client_reads_the_path_of_its_own_trigger_or_of_one_that_it_names() {
    // The path of each inspection is another one.
    let find = |number| {
        let mut found = accepted(number);
        found.path[0].robot_from_nozzle =
            RigidTransform::translation(f64::from(number) / 100.0, 0.25, 1.5);
        found
    };
    let service = Service::start(&ALL, ServerSettings::default(), find);
    let assert_of = |reply: &Reply, sequence: u32| {
        assert_eq!((reply.verdict, reply.sequence), (1, sequence), "{reply:?}");
        assert_at(reply, [f64::from(sequence) * 10.0, 250.0, 1500.0]);
    };
    for index in 0..ALL.len() {
        let [mut first, mut second, mut third] = [0; 3].map(|_| service.robot(index));
        let own = first.ask("TRIGGER").sequence;
        let others = second.ask("TRIGGER").sequence;
        assert_eq!(others, own + 1);
        assert_of(&first.ask_point("PATH", 1), own);
        assert_of(&second.ask_point("PATH", 1), others);
        assert_of(&first.ask_of(others, "PATH", 1), others);
        // One that has not triggered, or that has connected again, has to say which one it means.
        for point in [0, 1] {
            let reply = third.ask_point("PATH", point);
            assert_eq!((reply.verdict, reply.sequence), (7, 0), "{reply:?}");
            assert_no_numbers(&reply);
            if third.protocol != "urscript" {
                assert_eq!((&*reply.reason, &*reply.part), ("no_trigger", ""));
            }
        }
        drop(first);
        assert_of(&third.ask_of(own, "PATH", 1), own);
        assert_eq!(third.ask_of(own, "PATH", 0).points, 2);
        let never = third.ask_of(1000, "PATH", 1);
        assert_eq!(never.verdict, 7, "{never:?}");
        assert_no_numbers(&never);
        if third.protocol != "urscript" {
            assert_eq!(never.reason, "no_such_inspection");
        }
        // The connection stays open, and the next trigger's path is another one.
        let next = third.ask("TRIGGER").sequence;
        assert_of(&third.ask_point("PATH", 1), next);
        assert_of(&second.ask_point("PATH", 1), others);
    }
}
