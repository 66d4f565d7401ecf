//! What the operator's banner says: which part, OK or not, and what to do next.

use std::sync::Arc;

use egui::Color32;

use super::{
    frame_parts::numbered,
    headline::{Headline, HeadlineState, surface_complaint},
    hold::{Hold, inspect_current},
    operator_words::{in_short, next_step, why_not},
};
use crate::workspaces::inspect::frame_parts::FrameExpectation;
use capture::SourceSpec;
use inspection::pipeline::{SurfaceVerdict, Unrecognisable, Verdict};
use records::history::StoredVerdict;
use shell::{
    inspection::{inspected::Inspected, source::Origin},
    session::{Session, Source, UserRole},
    source::live::SourceState,
};
use station::Doubt;
use ui::{
    language::{library_text, text},
    theme::Theme,
    widgets::{Mark, sentence},
};

/// State that the banner shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    /// An accepted part that a robot may act on.
    Ok,
    /// An accepted part that no robot may act on.
    Recognised,
    /// A part that is not accepted.
    NotOk,
    /// There is no verdict, or not yet.
    Open,
    /// There is no result, and somebody has to fix it.
    Problem,
}

impl Tone {
    pub(super) fn word(self) -> String {
        match self {
            Self::Ok => text!("operator-ok"),
            Self::Recognised => text!("inspect-recognised"),
            Self::NotOk => text!("operator-not-ok"),
            Self::Open | Self::Problem => String::new(),
        }
    }

    pub(super) fn mark(self) -> Mark {
        match self {
            Self::Ok => Mark::Good,
            Self::Recognised => Mark::Known,
            Self::NotOk => Mark::Bad,
            Self::Open => Mark::Open,
            Self::Problem => Mark::Look,
        }
    }

    /// Colours of the word and of its background.
    pub(super) fn colours(self, theme: &Theme) -> [Color32; 2] {
        match self {
            Self::Ok => [theme.accepted, theme.accepted_back],
            Self::Recognised => [theme.text, theme.panel],
            Self::NotOk => [theme.rejected, theme.rejected_back],
            Self::Open => [theme.weak_text, theme.panel],
            Self::Problem => [theme.warning, theme.panel],
        }
    }
}

/// The verdict, its reason and the next step, in the operator's words.
#[derive(Debug)]
pub(super) struct Banner {
    pub(super) tone: Tone,
    pub(super) title: String,
    pub(super) reason: String,
    pub(super) next: String,
    /// What else the operator should know about the part; may be empty.
    pub(super) caution: String,
    /// True if the picture shows what hangs there now.
    pub(super) is_current: bool,
}

impl Banner {
    pub(super) fn new(
        tone: Tone,
        title: impl Into<String>,
        reason: impl Into<String>,
        next: impl Into<String>,
    ) -> Self {
        Self {
            tone,
            title: title.into(),
            reason: reason.into(),
            next: next.into(),
            caution: String::new(),
            is_current: false,
        }
    }

    pub(super) fn of(session: &Session) -> Self {
        let wait = text!("shell-wait");
        if session.is_live() {
            match session.live.status.as_ref().map(|status| &status.source) {
                None | Some(SourceState::Opening) => {
                    return Self::new(Tone::Open, text!("operator-opening-camera"), "", wait);
                }
                Some(SourceState::Lost(_)) => return Self::of_lost(&session.source),
                Some(SourceState::Running) => {}
            }
        } else if let Some(run) = &session.inspecting {
            if run.is_waiting {
                return Self::waiting_for_file();
            }
            return Self::new(Tone::Open, text!("operator-inspecting"), &run.title, wait);
        }
        if let Some(problem) = &session.failed {
            // A watched folder has no Capture: the next file comes by itself.
            let next = if session.is_watching() {
                problem.advice.clone()
            } else {
                text!("operator-no-result-next")
            };
            return Self::new(
                Tone::Problem,
                text!("operator-no-result"),
                sentence(&problem.what),
                next,
            );
        }
        if let Some(library) = &session.library {
            let ask = text!("operator-ask-to-enrol");
            if let Some(problem) = &library.unloaded {
                return Self::new(
                    Tone::Problem,
                    text!("shell-no-library"),
                    sentence(&problem.what),
                    ask,
                );
            }
            if library.parts.is_empty() {
                let why = library_text("short-no-parts-why");
                return Self::new(Tone::Problem, text!("operator-no-parts"), why, ask);
            }
        }
        // What is shown may be of another source, or from before this one was followed. After Live, the line may have gone on;
        // a frame without a verdict already says that Live was stopped.
        let shown = session.shown.as_ref().filter(|shown| {
            let is_current = session.currency(&shown.inspected) != Some(Doubt::Superseded);
            let says_itself = shown.is_past || shown.inspected.is_open();
            is_current || says_itself && !shown.is_outdated
        });
        let Some(shown) = shown else {
            return Self::without_current(session);
        };
        let inspected = &shown.inspected;
        let mut verdict = Self {
            is_current: true,
            ..Self::of_parts(&shown.parts, session)
        };
        let serial = session.trace.of_part(inspected).serial;
        // While the next part swings in, a frame may still belong to the one before.
        let is_part = inspected.entry.record.summary.verdict != StoredVerdict::NoPart;
        if shown.parts.len() == 1 && is_part && !inspected.is_open() && !serial.is_empty() {
            verdict.reason = format!("{} · {serial}", verdict.reason);
        }
        if shown.is_past {
            return Self {
                tone: Tone::Open,
                reason: text!("inspect-from-history"),
                next: inspect_current(session, UserRole::Operator),
                caution: String::new(),
                ..verdict
            };
        }
        verdict
    }

    /// The banner while no result counts for the part that hangs there now.
    fn without_current(session: &Session) -> Self {
        if session.is_watching() {
            return Self::waiting_for_file();
        }
        let [title, reason, next] = if session.is_live() {
            [
                text!("inspect-looking"),
                text!("operator-nothing-captured"),
                text!("shell-wait"),
            ]
        } else if session.shown.is_some() {
            [
                text!("inspect-no-verdict"),
                text!("operator-counts-no-longer"),
                inspect_current(session, UserRole::Operator),
            ]
        } else {
            [
                text!("operator-ready"),
                text!("operator-nothing-inspected"),
                text!("operator-hang-and-capture"),
            ]
        };
        Self::new(Tone::Open, title, reason, next)
    }

    fn waiting_for_file() -> Self {
        Self::new(
            Tone::Open,
            text!("shell-waiting-for-file"),
            text!("operator-no-new-file"),
            text!("operator-save-capture"),
        )
    }

    /// The exact error is for the engineer.
    fn of_lost(source: &Source) -> Self {
        let (title, next) = if is_folder(source) {
            (
                text!("operator-no-folder"),
                text!("operator-no-folder-next"),
            )
        } else {
            (
                text!("operator-no-camera"),
                text!("operator-no-camera-next"),
            )
        };
        Self::new(Tone::Problem, title, text!("operator-lost"), next)
    }

    /// The banner of all parts of a frame: of several, how many are accepted, and what is to be done about the first that is
    /// not, or that no robot may act on. In Live, the first one without a verdict that counts keeps the others waiting.
    fn of_parts(parts: &[Arc<Inspected>], session: &Session) -> Self {
        let expectation = FrameExpectation::of(parts, session);
        // What is not enrolled may hang beside the expected parts.
        let is_known = |part: &Arc<Inspected>| !part.inspection.verdict.is_unknown();
        let skips_unknown = expectation.is_some() && parts.iter().any(is_known);
        let counted = parts.iter().enumerate();
        let counted = counted.filter(|(_, part)| !skips_unknown || is_known(part));
        let (indices, mut all): (Vec<usize>, Vec<Self>) = counted
            .map(|(index, part)| {
                let result = Self::of_result(part, session);
                let caution = caution(part, result.tone);
                (index, Self { caution, ..result })
            })
            .unzip();
        if let Some(index) = indices.iter().position(|index| parts[*index].is_open()) {
            return all.swap_remove(index);
        }
        let num = |tone| all.iter().filter(|part| part.tone == tone).count();
        let (num_ok, num_recognised) = (num(Tone::Ok), num(Tone::Recognised));
        let (num_accepted, num_parts) = (num_ok + num_recognised, all.len());
        let is_to_do = |part: &Self| match part.tone {
            Tone::Ok => false,
            Tone::Recognised => num_accepted == num_parts,
            Tone::NotOk | Tone::Open | Tone::Problem => true,
        };
        let index = (all.iter().position(is_to_do))
            .or_else(|| all.iter().position(|part| !part.caution.is_empty()))
            .unwrap_or_default();
        let mut first = all.swap_remove(index);
        if num_parts > 1 {
            let name = numbered(indices[index], &first.title);
            if num_accepted < num_parts {
                first.tone = Tone::NotOk;
                first.reason = format!("{name}: {}", first.reason);
            }
            if !first.caution.is_empty() {
                first.caution = format!("{name}: {}", first.caution);
            }
            first.title = if num_recognised == 0 {
                text!("operator-parts-ok", num = num_ok, all = num_parts)
            } else {
                text!(
                    "operator-parts-recognised",
                    num = num_accepted,
                    all = num_parts
                )
            };
        }
        match &expectation {
            Some(expectation) => first.expecting(expectation),
            None => first,
        }
    }

    /// The banner of a frame in which parts are expected: missing ones are as bad as wrong ones.
    fn expecting(mut self, expectation: &FrameExpectation) -> Self {
        let is_empty_cell = self.tone == Tone::Open;
        let is_accepted = matches!(self.tone, Tone::Ok | Tone::Recognised);
        if expectation.num_expected > 1 && !is_empty_cell && self.tone != Tone::Problem {
            self.title.clone_from(&expectation.title);
        }
        if !expectation.missing.is_empty() && (is_accepted || is_empty_cell) {
            self.reason.clone_from(&expectation.complaint);
            self.next = text!("expect-hang-missing");
            if is_accepted {
                self.tone = Tone::NotOk;
                self.caution.clear();
            }
        } else if expectation.is_met && self.tone == Tone::Ok {
            self.reason = text!("expect-is-met-and-posed");
        }
        self
    }

    fn of_result(inspected: &Inspected, session: &Session) -> Self {
        let Headline {
            title,
            state,
            actual,
            complaint,
            ..
        } = Headline::of(inspected, session);
        if actual.is_some() {
            let next = text!("operator-reported-wrong-next");
            return Self::new(Tone::NotOk, title, text!("operator-reported-wrong"), next);
        }
        if state.is_accepted() {
            let surface = &inspected.inspection.surface;
            let verdict = surface.as_ref().map(|check| check.verdict);
            if let Some((reason, advice)) = surface_complaint(&inspected.inspection) {
                let tone = if verdict.is_some_and(SurfaceVerdict::is_bad) {
                    Tone::NotOk
                } else {
                    Tone::Recognised
                };
                return Self::new(tone, title, reason, advice);
            }
            if let Some(hold) = Hold::of(session, inspected, UserRole::Operator) {
                return Self::new(Tone::Recognised, title, hold.reason, hold.advice);
            }
            let is_file = matches!(inspected.origin, Origin::File { .. } | Origin::Scan { .. });
            let next = if is_file {
                text!("operator-file-next")
            } else if caution(inspected, Tone::Ok).is_empty() {
                text!("operator-start-robot")
            } else {
                text!("operator-check-part-next")
            };
            return Self::new(Tone::Ok, title, text!("operator-recognised"), next);
        }
        let (reason, advice) = complaint.unwrap_or_default();
        if state == HeadlineState::Open {
            return Self::new(Tone::Open, title, sentence(&reason), advice);
        }
        let Some(why) = why_not(inspected) else {
            return Self::new(Tone::NotOk, title, sentence(&reason), advice);
        };
        let (tone, title, next) = match &inspected.inspection.verdict {
            Verdict::NoPart(Unrecognisable::EmptyLibrary) => (
                Tone::Problem,
                text!("operator-no-parts"),
                text!("operator-ask-to-enrol"),
            ),
            // An empty cell is not a bad part.
            Verdict::NoPart(_) => (Tone::Open, title, next_step(&why, session)),
            Verdict::Part { .. } => (Tone::NotOk, title, next_step(&why, session)),
        };
        Self::new(tone, title, in_short(&why), next)
    }
}

/// Says that some of a part is outside the picture, or that an accepted one may be another model.
fn caution(inspected: &Inspected, tone: Tone) -> String {
    let is_cut = inspected.inspection.touches_edge() && inspected.scan.is_none();
    match tone {
        Tone::NotOk if is_cut => text!("operator-reaches-edge"),
        Tone::Ok | Tone::Recognised => {
            let is_approximate = inspected.inspection.verdict.is_approximate();
            let cautions = [
                is_cut.then(|| text!("operator-reaches-edge-ok")),
                is_approximate.then(|| text!("operator-approximate-ok")),
            ];
            let cautions: Vec<String> = cautions.into_iter().flatten().collect();
            cautions.join("\n")
        }
        Tone::NotOk | Tone::Open | Tone::Problem => String::new(),
    }
}

/// True for a watched folder or a recording.
fn is_folder(source: &Source) -> bool {
    matches!(source, Source::Camera(spec)
        if matches!(**spec, SourceSpec::Watched(_) | SourceSpec::Recording(_)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::rigid::RigidTransform;
    use inspection::pipeline::{
        Rejection, SurfaceCheck,
        live::{InspectionRate, LiveVerdict, MotionState},
    };
    use robot::RobotFrame;
    use shell::{
        inspection::{
            inspected::{LiveFrameContext, inspected_cell},
            source::CellChoice,
        },
        session::{Inspecting, ReinspectionPurpose, Shown},
        source::live::LiveStatus,
    };
    use ui::{language::Language, user_error::UserError};

    fn showing(inspected: Inspected, is_past: bool) -> Session {
        Session {
            shown: Some(Shown {
                is_past,
                ..Shown::new(1, Arc::new(inspected))
            }),
            robot: Some(Arc::new(RobotFrame {
                robot_from_camera: RigidTransform::identity(),
                name: "cell 1".into(),
            })),
            ..Session::default()
        }
    }

    #[test]
    fn a_part_at_the_edge_another_model_and_a_file_are_said_and_only_what_is_certain() {
        let banner = |change: fn(&mut Inspected), is_past| {
            let mut inspected = inspected_cell(CellChoice::InTurn, 1);
            change(&mut inspected);
            Banner::of(&showing(inspected, is_past))
        };
        let beside_shadow: fn(&mut Inspected) = |inspected| {
            if let Ok(part) = &mut inspected.inspection.segmentation.part {
                part.touches_edge = true;
            }
            inspected.set_origin(camera());
        };
        let cut: fn(&mut Inspected) = |inspected| {
            if let Some(Ok(pose)) = &mut inspected.inspection.pose
                && let Some(sight) = &mut pose.fit.sight
            {
                sight.outside = 0.1;
            }
            inspected.set_origin(camera());
        };
        let approximate: fn(&mut Inspected) = |inspected| {
            if let Verdict::Part { is_approximate, .. } = &mut inspected.inspection.verdict {
                *is_approximate = true;
            }
            inspected.set_origin(camera());
        };
        let refused: fn(&mut Inspected) = |inspected| {
            if let Ok(part) = &mut inspected.inspection.segmentation.part {
                part.touches_edge = true;
            }
            if let Verdict::Part { rejected, part, .. } = &mut inspected.inspection.verdict {
                *rejected = Some(Rejection::NotSteady { part: part.clone() });
            }
        };
        assert_eq!(banner(|_| (), false).caution, "");
        let inside = banner(beside_shadow, false);
        assert_eq!((inside.tone, &*inside.caution), (Tone::Ok, ""));
        let plain = banner(|inspected| inspected.set_origin(camera()), false);
        assert_eq!((&*plain.next, &*plain.caution), ("Start the robot", ""));
        for (change, caution) in [(cut, "Not all of it"), (approximate, "another model")] {
            let good = banner(change, false);
            assert_eq!(good.tone, Tone::Ok);
            assert!(good.caution.contains(caution), "{}", good.caution);
            assert_eq!(good.next, "Check the part, then start the robot");
        }
        let bad = banner(refused, false);
        assert_eq!(bad.tone, Tone::NotOk);
        assert!(bad.caution.contains("all of it"), "{}", bad.caution);
        assert_eq!(banner(cut, true).caution, "");
        let file: fn(&mut Inspected) = |inspected| {
            inspected.set_origin(Origin::File {
                path: "/data/door.png".into(),
                is_simulated: false,
            });
        };
        // It may show what hung there days ago.
        let next = banner(file, false).next;
        assert!(next.starts_with("From a file"), "{next}");
    }

    #[test]
    fn a_part_whose_surface_is_not_good_is_not_ok_and_starts_no_robot() {
        let banner = |verdict| {
            let mut inspected = inspected_cell(CellChoice::InTurn, 1);
            inspected.set_origin(camera());
            inspected.inspection.surface = Some(Arc::new(SurfaceCheck {
                verdict,
                not_judged: None,
                deviation: None,
                regions: Vec::new(),
            }));
            Banner::of(&showing(inspected, false))
        };
        let good = banner(SurfaceVerdict::Ok);
        assert_eq!((good.tone, &*good.next), (Tone::Ok, "Start the robot"));
        for (verdict, tone, reason) in [
            (
                SurfaceVerdict::NotJudged,
                Tone::Recognised,
                "Surface: not judged",
            ),
            (SurfaceVerdict::Rework, Tone::NotOk, "Surface: rework"),
            (SurfaceVerdict::Scrap, Tone::NotOk, "Surface: scrap"),
        ] {
            let bad = banner(verdict);
            assert_eq!((bad.tone, &*bad.reason), (tone, reason));
            assert_ne!(bad.next, "Start the robot");
        }
    }

    #[test]
    fn several_parts_are_ok_only_together() {
        let banner = |changes: &[fn(&mut Inspected)]| {
            let parts = changes.iter().map(|change| {
                let mut part = inspected_cell(CellChoice::InTurn, 1);
                part.set_origin(camera());
                change(&mut part);
                Arc::new(part)
            });
            let parts: Vec<_> = parts.collect();
            let first = inspected_cell(CellChoice::InTurn, 1);
            let mut session = showing(first, false);
            if let Some(shown) = &mut session.shown {
                shown.inspected = Arc::clone(&parts[0]);
                shown.parts = parts;
            }
            Banner::of(&session)
        };
        let good: fn(&mut Inspected) = |_| ();
        let refused: fn(&mut Inspected) = |part| {
            if let Verdict::Part { rejected, part, .. } = &mut part.inspection.verdict {
                *rejected = Some(Rejection::NotSteady { part: part.clone() });
            }
        };
        let approximate: fn(&mut Inspected) = |part| {
            if let Verdict::Part { is_approximate, .. } = &mut part.inspection.verdict {
                *is_approximate = true;
            }
        };
        let simulated: fn(&mut Inspected) = |part| {
            *part = inspected_cell(CellChoice::InTurn, 1);
        };
        let all = banner(&[good, good]);
        assert_eq!((all.tone, &*all.title), (Tone::Ok, "2 of 2 OK"));
        assert_eq!((&*all.next, &*all.caution), ("Start the robot", ""));
        let some = banner(&[good, refused, good]);
        assert_eq!((some.tone, &*some.title), (Tone::NotOk, "2 of 3 OK"));
        let reason = "2 · Front door, left: It is not hanging still yet";
        assert_eq!(some.reason, reason);
        // In Live, there is no count before every verdict counts.
        let moving: fn(&mut Inspected) = |part| {
            part.followed = Some(LiveFrameContext {
                stillness: MotionState::Moving,
                standing: LiveVerdict::Open,
            });
        };
        let waiting = banner(&[good, moving]);
        assert_eq!((waiting.tone, waiting.is_current), (Tone::Open, true));
        assert!(!waiting.title.contains("OK"), "{waiting:?}");
        let doubtful = banner(&[good, approximate]);
        assert_eq!(doubtful.tone, Tone::Ok);
        assert_eq!(
            doubtful.caution,
            "2 · Front door, left: Maybe another model"
        );
        assert_eq!(doubtful.next, "Check the part, then start the robot");
        let held = banner(&[good, simulated]);
        assert_eq!(
            (held.tone, &*held.title),
            (Tone::Recognised, "2 of 2 recognised")
        );
        assert!(held.reason.contains("Simulated"), "{}", held.reason);
    }

    #[test]
    fn an_acceptance_by_live_does_not_stand_once_live_is_off() {
        let banner = |is_live: bool, is_past: bool| {
            let mut inspected = inspected_cell(CellChoice::InTurn, 1);
            inspected.set_origin(camera());
            let mut session = showing(inspected, is_past);
            session.live.is_on = is_live;
            session.live.status = is_live.then(|| status(SourceState::Running));
            if let Some(shown) = &mut session.shown {
                shown.session = Some(1);
            }
            Banner::of(&session)
        };
        assert_eq!(banner(true, false).tone, Tone::Ok);
        let off = banner(false, false);
        assert_eq!((off.tone, off.is_current), (Tone::Open, false));
        assert_eq!(off.reason, "The last verdict no longer counts");
        let past = banner(false, true);
        assert!(past.reason.starts_with("From the history"), "{past:?}");
    }

    #[test]
    fn a_capture_that_waits_for_a_file_tells_the_operator_to_save_one() {
        let banner = |is_waiting| {
            let mut session = showing(inspected_cell(CellChoice::InTurn, 1), false);
            session.inspecting = Some(Inspecting {
                title: text!("shell-waiting-for-file"),
                purpose: ReinspectionPurpose::New,
                is_waiting,
            });
            let banner = Banner::of(&session);
            assert_eq!((banner.tone, banner.is_current), (Tone::Open, false));
            [banner.title, banner.next]
        };
        let [title, next] = banner(true);
        assert_eq!(title, "Waiting for a new file");
        assert!(next.starts_with("Save a capture to the folder"), "{next}");
        assert_eq!(banner(false), ["Inspecting…", "Wait a moment"]);
    }

    #[test]
    fn only_a_steady_part_is_shown_with_its_serial_number() {
        let reason = |choice, moves: bool| {
            let mut inspected = inspected_cell(choice, 1);
            inspected.entry.record.summary.trace.serial = "4711".into();
            inspected.followed = moves.then_some(LiveFrameContext {
                stillness: MotionState::Moving,
                standing: LiveVerdict::Open,
            });
            Banner::of(&showing(inspected, false)).reason
        };
        assert!(reason(CellChoice::InTurn, false).contains("4711"));
        for (choice, moves) in [(CellChoice::InTurn, true), (CellChoice::Empty, false)] {
            let reason = reason(choice, moves);
            assert!(!reason.contains("4711"), "{reason}");
        }
    }

    #[test]
    fn a_part_that_waits_for_a_slow_computer_is_not_nok_and_the_operator_knows_why() {
        let mut inspected = inspected_cell(CellChoice::InTurn, 1);
        inspected.followed = Some(LiveFrameContext {
            stillness: MotionState::Watching,
            standing: LiveVerdict::Open,
        });
        let mut session = showing(inspected, false);
        session.live.is_on = true;
        session.live.status = Some(LiveStatus {
            stillness: Some(MotionState::Watching),
            held_up_by: Some(InspectionRate {
                num_inspected: 2,
                num_frames: 30,
            }),
            ..status(SourceState::Running)
        });
        let banner = Banner::of(&session);
        assert_eq!(banner.tone, Tone::Open);
        assert!(banner.reason.contains("2 of 30 frames"), "{banner:?}");
        assert!(banner.next.contains("close other programs"), "{banner:?}");
    }

    #[test]
    fn a_lost_source_is_named_by_its_kind_in_the_language_of_the_window() {
        let lost = |source| {
            let mut session = Session {
                source,
                ..Session::default()
            };
            session.live.is_on = true;
            session.live.status = Some(status(SourceState::Lost(UserError {
                what: "the folder does not exist".into(),
                advice: "Connect the drive".into(),
            })));
            Banner::of(&session)
        };
        let folder = Source::Camera(Box::new("watch:captures".parse().expect("a source")));
        Language::German.make_current();
        let banners = [lost(folder), lost(Source::default())];
        Language::English.make_current();
        let expected = [
            ("Ordner nicht erreichbar", "Netzlaufwerk"),
            ("Keine Kamera", "Stecker"),
        ];
        for (banner, (title, next)) in banners.iter().zip(expected) {
            assert_eq!(banner.title, title);
            assert!(banner.next.starts_with(next), "{banner:?}");
            assert!(banner.next.contains("Instandhaltung"), "{banner:?}");
            assert!(!banner.reason.contains("folder"), "{banner:?}");
        }
    }

    fn status(source: SourceState) -> LiveStatus {
        LiveStatus {
            source,
            stillness: None,
            standing: LiveVerdict::Open,
            rates: [None; 2],
            inspection_rate: None,
            latency: None,
            held_up_by: None,
            num_inspected: 1,
            num_dropped: 0,
            num_averaged: 1,
            recorded: None,
        }
    }

    /// A frame of a camera that is not simulated.
    fn camera() -> Origin {
        Origin::Frame {
            name: "kinect frame 1".into(),
            is_simulated: false,
            capture: None,
        }
    }
}
