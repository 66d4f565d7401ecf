//! Tests that operator, engineer, copies, exports and answers agree on whether a robot may act, in every state of the session.

use std::{
    sync::{Arc, OnceLock},
    time::{Duration, SystemTime},
};

use jiff::Timestamp;
use nalgebra::{Point3, Vector3};

use super::{
    InspectAction, InspectFile, InspectState,
    banner::{Banner, Tone},
    headline::{Headline, HeadlineState},
    hold::Hold,
    robot_numbers::numbered,
};
use geometry::{rigid::RigidTransform, units::Metres};
use inspection::{
    library::{PathPoint, SprayPath, Truth},
    pipeline::live::{ConsensusVerdict, LiveVerdict, MotionState},
};
use records::history::Traceability;
use robot::{RobotFrame, spray::carry};
use shell::{
    action::Action,
    inspection::{
        inspected::{Inspected, LiveFrameContext, inspected_cell},
        source::{CellChoice, Origin},
    },
    session::{Inspecting, ReinspectionPurpose, Session, Shown, Source, UserRole},
    source::live::{LiveStatus, SourceState},
    workspace::TestShell,
};
use stages::{pose::RunnerUp, scan};
use station::{CaptureFacts, ScanFacts};
use ui::{task::TaskRunner, user_error::UserError};

/// What a robot may do in a state of the session, if the cell is calibrated and the pose is the only one that fits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum May {
    /// Act on the result.
    Act,
    /// Have the numbers, marked as those of a part that hangs nowhere.
    Rehearse,
    /// Nothing.
    Wait,
}

/// A state of the session, and the change that leads to it from a part that was captured just now by a camera.
type State = (&'static str, May, fn(&mut Session, &mut Inspected));

const STATES: [State; 22] = [
    ("captured", May::Act, |_, _| ()),
    ("captured 11 minutes ago", May::Wait, |_, inspected| {
        age(inspected, 11);
    }),
    ("captured in an hour", May::Wait, |_, inspected| {
        inspected.captured_at = SystemTime::now() + Duration::from_hours(1);
    }),
    ("hangs still", May::Act, |session, inspected| {
        follow(session, inspected, STEADY);
    }),
    ("hangs still for long", May::Act, |session, inspected| {
        follow(session, inspected, STEADY);
        age(inspected, 11);
    }),
    // The frame in front is older than the status.
    ("moves", May::Wait, |session, inspected| {
        follow(session, inspected, MotionState::Moving);
    }),
    (
        "moves, in this frame too",
        May::Wait,
        |session, inspected| {
            follow(session, inspected, MotionState::Moving);
            open(inspected, MotionState::Moving, LiveVerdict::Open);
        },
    ),
    ("is looked at", May::Wait, |session, inspected| {
        follow(session, inspected, MotionState::Watching);
    }),
    ("too few frames yet", May::Wait, |session, inspected| {
        follow(session, inspected, STEADY);
        let gathering = LiveVerdict::Gathering {
            num_frames: 3,
            needed: 5,
        };
        open(inspected, STEADY, gathering);
    }),
    (
        "the camera is being opened",
        May::Wait,
        |session, inspected| {
            follow(session, inspected, STEADY);
            session.live.status = None;
        },
    ),
    ("lost", May::Wait, |session, inspected| {
        follow(session, inspected, STEADY);
        let lost = SourceState::Lost(UserError {
            what: "unplugged".into(),
            advice: "plug it in".into(),
        });
        session.live.status.as_mut().expect("followed").source = lost;
    }),
    ("Live was stopped", May::Wait, |session, inspected| {
        follow(session, inspected, STEADY);
        session.live.is_on = false;
        session.live.status = None;
    }),
    ("a newer part is unseen", May::Wait, |session, inspected| {
        follow(session, inspected, STEADY);
        let newer = inspected_cell(CellChoice::InTurn, 2);
        session.live.unseen = vec![Arc::new(newer)];
    }),
    ("past", May::Wait, |session, _| {
        mark(session, |shown| shown.is_past = true);
    }),
    ("outdated", May::Wait, |session, _| {
        mark(session, |shown| shown.is_outdated = true);
    }),
    ("another inspection runs", May::Wait, |session, _| {
        session.inspecting = Some(Inspecting {
            title: "Capturing".into(),
            purpose: ReinspectionPurpose::New,
            is_waiting: false,
        });
    }),
    ("another inspection failed", May::Wait, |session, _| {
        session.failed = Some(UserError {
            what: "no frame".into(),
            advice: "try again".into(),
        });
    }),
    ("reported as wrong", May::Wait, |session, inspected| {
        session.shift.labelled = vec![(inspected.hung().clone(), Truth::NotEnrolled)];
    }),
    ("simulated", May::Rehearse, |_, inspected| {
        inspected.set_origin(Origin::Simulated {
            choice: CellChoice::InTurn,
            number: 1,
        });
    }),
    ("replayed", May::Rehearse, |_, inspected| {
        inspected.set_origin(Origin::Frame {
            name: "kinect frame 1".into(),
            is_simulated: false,
            capture: Some(CaptureFacts {
                source: "openni:monday.oni".into(),
                number: 1,
                taken_at: Timestamp::UNIX_EPOCH,
                num_dropped: 0,
                is_replayed: true,
                is_alone: false,
            }),
        });
    }),
    (
        "the poses of a scan are apart",
        May::Wait,
        |_, inspected| {
            inspected.subject.scan = Some(ScanFacts {
                reference_frame: "a.png".into(),
                shots: Vec::new(),
                num_used: 2,
                doubt: Some(scan::Doubt::PosesApart {
                    names: ["a.png".into(), "b.png".into()],
                    apart: Metres::from_mm(30.0),
                }),
            });
        },
    ),
    ("from a fresh file", May::Act, |_, inspected| {
        inspected.set_origin(Origin::File {
            path: "/data/door.png".into(),
            is_simulated: false,
        });
    }),
];

const STEADY: MotionState = MotionState::Steady {
    since: Duration::ZERO,
    lasting: Duration::from_secs(2),
};

fn age(inspected: &mut Inspected, minutes: u64) {
    inspected.captured_at = SystemTime::now() - Duration::from_secs(60 * minutes);
}

fn open(inspected: &mut Inspected, stillness: MotionState, standing: LiveVerdict) {
    inspected.followed = Some(LiveFrameContext {
        stillness,
        standing,
    });
}

/// Live follows the camera, this is the stillness by now, and the frame's own verdict counts.
fn follow(session: &mut Session, inspected: &mut Inspected, stillness: MotionState) {
    let counted = ConsensusVerdict {
        verdict: inspected.inspection.verdict.clone(),
        pose: None,
        num_frames: 5,
        num_agreeing: 5,
    };
    open(
        inspected,
        STEADY,
        LiveVerdict::Counted(Box::new(counted.clone())),
    );
    session.live.is_on = true;
    session.live.status = Some(LiveStatus {
        source: SourceState::Running,
        stillness: Some(stillness),
        standing: LiveVerdict::Counted(Box::new(counted)),
        rates: [None; 2],
        inspection_rate: None,
        latency: None,
        held_up_by: None,
        num_inspected: 9,
        num_dropped: 0,
        num_averaged: 1,
        recorded: None,
    });
    mark(session, |shown| shown.session = Some(1));
}

/// Changes what the session shows; its inspection is put there later.
fn mark(session: &mut Session, change: impl FnOnce(&mut Shown)) {
    change(session.shown.as_mut().expect("shown"));
}

/// A part with a spray path that was captured just now by a camera.
fn captured() -> Inspected {
    let mut inspected = inspected_cell(CellChoice::InTurn, 1);
    inspected.set_origin(Origin::Frame {
        name: "kinect frame 1".into(),
        is_simulated: false,
        capture: None,
    });
    let path = SprayPath::new(vec![PathPoint {
        nozzle: Point3::new(0.0, 0.1, 1.05),
        direction: Vector3::z_axis(),
        stand_off: None,
        is_gun_on: true,
        speed: None,
        fan: None,
    }]);
    let part = &inspected.inspection.segmentation.part;
    let seen = &part.as_ref().expect("a part").cloud;
    let hangs = RigidTransform::identity();
    let params = &inspected.recipe.stand_off;
    inspected.spray = Some(carry(&path.expect("a point"), &hangs, seen, params));
    inspected
}

/// A window in this state, without a calibration.
fn shell_in(change: fn(&mut Session, &mut Inspected), is_ambiguous: bool) -> TestShell {
    static PLACE: OnceLock<Arc<Inspected>> = OnceLock::new();
    let mut inspected = captured();
    if is_ambiguous && let Some(Ok(pose)) = &mut inspected.inspection.pose {
        pose.runner_up = Some(RunnerUp {
            target_from_source: pose.target_from_source,
            ratio: 1.01,
        });
    }
    let mut shell = TestShell::default();
    let session = &mut shell.session;
    session.source = Source::Camera(Box::new("kinect".parse().expect("a source")));
    // In place of the result, which the change may still alter.
    let place = PLACE.get_or_init(|| Arc::new(inspected_cell(CellChoice::Empty, 1)));
    session.shown = Some(Shown::new(1, Arc::clone(place)));
    change(session, &mut inspected);
    mark(session, |shown| {
        *shown = Shown {
            is_past: shown.is_past,
            session: shown.session,
            is_outdated: shown.is_outdated,
            ..Shown::new(shown.generation, Arc::new(inspected))
        }
    });
    shell
}

fn calibrate(session: &mut Session) {
    session.robot = Some(Arc::new(RobotFrame {
        robot_from_camera: RigidTransform::translation(1.0, 0.0, 0.5),
        name: "cell 1".into(),
    }));
}

#[test]
fn operator_engineer_copies_exports_and_robots_agree_in_every_state() {
    for (name, may, change) in STATES {
        for is_ambiguous in [false, true] {
            let mut shell = shell_in(change, is_ambiguous);
            let state = format!("{name}, ambiguous: {is_ambiguous}");
            agree(&mut shell, May::Wait, &format!("{state}, not calibrated"));
            calibrate(&mut shell.session);
            agree(
                &mut shell,
                if is_ambiguous { May::Wait } else { may },
                &state,
            );
        }
    }
}

/// Checks that all agree that a robot may do this.
fn agree(shell: &mut TestShell, may: May, state: &str) {
    let (has_numbers, is_go) = (may != May::Wait, may == May::Act);
    let session = &shell.session;
    let inspected = Arc::clone(&session.shown.as_ref().expect("shown").inspected);
    let doubts = session.robot_doubts(&inspected);
    assert_eq!(doubts.is_empty(), has_numbers, "{state}: {doubts:?}");
    assert_eq!(session.is_go(&inspected), is_go, "{state}");
    // The operator.
    let banner = Banner::of(session);
    assert_eq!(banner.tone == Tone::Ok, is_go, "{state}: {banner:?}");
    let starts = banner.next.to_lowercase().replace("do not start", "");
    let is_start = starts.contains("start the robot");
    assert_eq!(is_start, is_go, "{state}: {banner:?}");
    assert!(!banner.next.is_empty(), "{state}: {banner:?}");
    // The engineer.
    assert_eq!(
        Headline::of(&inspected, session).state == HeadlineState::Go,
        is_go,
        "{state}"
    );
    let pose = numbered(session, &inspected);
    let is_of_robot = pose.is_some_and(|pose| pose.name == "robot_from_part");
    assert_eq!(is_of_robot, has_numbers, "{state}");
    // Both have the same reason.
    let [operator, engineer] = [UserRole::Operator, UserRole::Engineer]
        .map(|role| Hold::of(session, &inspected, role).map(|hold| hold.reason));
    assert_eq!(operator, engineer, "{state}");
    assert_eq!(operator.is_none(), is_go, "{state}");
    if banner.tone == Tone::Recognised {
        assert_eq!(Some(banner.reason), operator, "{state}");
    }
    // The line of JSON of a report.
    let subject = session.subject_now(&inspected);
    let robot = session.robot_of(&inspected).map(|robot| &**robot);
    let recorded = inspected.as_recorded(&subject, robot);
    let line = recorded.line(&Traceability::default());
    assert_eq!(
        line.contains("robot_from_part"),
        has_numbers,
        "{state}: {line}"
    );
    // What is copied, and what is written in place of the file of an earlier part.
    let mut inspect = InspectState::new(&TaskRunner::without_threads());
    shell.sent.clear();
    inspect.apply(InspectAction::CopyPose, &mut shell.context());
    let copied = shell.sent.iter().find_map(|message| match message {
        Action::CopyText(text) => Some(text.starts_with("robot_from_part")),
        _ => None,
    });
    assert_eq!(copied, has_numbers.then_some(true), "{state}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("path.csv");
    std::fs::write(&path, "# Partsight spray path").expect("written");
    let chosen = InspectAction::Chosen(InspectFile::SprayPath, path.clone());
    inspect.apply(chosen, &mut shell.context());
    assert!(inspect.run_waiting(), "{state}");
    inspect.update(&mut shell.context());
    let notices = shell.notices();
    assert_eq!(path.exists(), has_numbers, "{state}: {notices:?}");
}

#[test]
fn a_part_that_moves_by_now_is_called_moving_though_its_last_verdict_was_accepted() {
    let moves: fn(&mut Session, &mut Inspected) =
        |session, inspected| follow(session, inspected, MotionState::Moving);
    let mut shell = shell_in(moves, false);
    calibrate(&mut shell.session);
    let session = &shell.session;
    assert_eq!(Banner::of(session).title, "Moving");
    let inspected = &session.shown.as_ref().expect("shown").inspected;
    assert!(inspected.inspection.verdict.is_accepted());
    let headline = Headline::of(inspected, session);
    assert_eq!(
        (headline.title.as_str(), headline.state.is_accepted()),
        ("Moving", false)
    );
}

#[test]
fn without_a_calibration_both_are_told_what_is_missing() {
    let shell = shell_in(|_, _| (), false);
    let session = &shell.session;
    let banner = Banner::of(session);
    assert_eq!(banner.tone, Tone::Recognised);
    let reason = "Not calibrated: the robot gets no pose";
    assert_eq!(banner.reason, reason);
    assert!(banner.next.contains("call the engineer"), "{banner:?}");
    let inspected = &session.shown.as_ref().expect("shown").inspected;
    let complaint = Headline::of(inspected, session)
        .complaint
        .expect("a reason");
    assert_eq!(complaint.0, reason);
    assert!(complaint.1.contains("Robot…"), "{complaint:?}");
}
