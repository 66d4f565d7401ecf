//! Everything a person or the worker can cause, and the one function that makes it so.

use std::{path::PathBuf, sync::Arc};

use super::{
    state::{HelpPage, Notice, Shown, Source, StagePanel, State, Work, Workspace},
    work::{CellChoice, Inspected, Request, Trouble, file_name},
    worker::News,
};

/// Something that happened.
#[derive(Debug)]
pub enum Action {
    /// Take a scene from the source and inspect it.
    Capture,
    /// Capture from the simulated cell, with this in it.
    UseCell(CellChoice),
    /// Ask for a file.
    ChooseFile,
    /// Open this file and inspect it.
    Open(PathBuf),
    /// Give up what is at work.
    Cancel,
    /// Bring a workspace to the front.
    GoTo(Workspace),
    /// Fill the middle with a stage.
    Enlarge(StagePanel),
    /// Compare contour and signature with the part at this place of the ranking.
    Compare(usize),
    /// Close what lies on top: the shortcuts, then an enlarged stage.
    CloseTop,
    /// Change the units.
    SwitchUnits,
    /// Change the colours.
    SwitchTheme,
    /// Open or close the list of shortcuts.
    ToggleHelp,
    /// Take a notice away.
    Dismiss(usize),
    /// Show a notice.
    Notify(Notice),
    /// Put the pose on the clipboard, row after row.
    CopyPose,
    /// The worker has news.
    Hear(News<Result<Arc<Inspected>, Trouble>>),
}

/// What is to be done outside the state.
#[derive(Clone, Debug)]
pub enum Effect {
    /// Post this request to the worker.
    Post {
        /// Its generation.
        generation: u64,
        /// The request.
        request: Request,
    },
    /// Have the worker give up.
    CancelWork,
    /// Show the file dialog.
    ShowFileDialog,
    /// Put this on the clipboard.
    CopyText(String),
}

/// More notices than this push the oldest out.
const MAX_NOTICES: usize = 4;

/// Makes it so.
pub fn apply(state: &mut State, action: Action) -> Option<Effect> {
    match action {
        Action::Capture => return Some(capture(state)),
        Action::UseCell(choice) => {
            state.source = Source::Cell(choice);
            return Some(capture(state));
        }
        Action::ChooseFile => return Some(Effect::ShowFileDialog),
        Action::Open(path) => {
            state.source = Source::File(path);
            return Some(capture(state));
        }
        Action::Cancel => {
            state.work = None;
            return Some(Effect::CancelWork);
        }
        Action::GoTo(workspace) => state.workspace = workspace,
        Action::Enlarge(panel) => state.enlarged = Some(panel),
        Action::Compare(place) => state.candidate = place,
        Action::CloseTop => {
            if state.help == HelpPage::Open {
                state.help = HelpPage::Closed;
            } else {
                state.enlarged = None;
            }
        }
        Action::SwitchUnits => state.units = state.units.other(),
        Action::SwitchTheme => state.theme = state.theme.other(),
        Action::ToggleHelp => {
            state.help = match state.help {
                HelpPage::Closed => HelpPage::Open,
                HelpPage::Open => HelpPage::Closed,
            }
        }
        Action::Dismiss(place) => {
            if place < state.notices.len() {
                state.notices.remove(place);
            }
        }
        Action::Notify(notice) => notify(state, notice),
        Action::CopyPose => return pose_text(state).map(Effect::CopyText),
        Action::Hear(news) => hear(state, news),
    }
    None
}

/// Asks for a scene from the source.
fn capture(state: &mut State) -> Effect {
    let (request, what) = match &state.source {
        Source::Cell(choice) => {
            state.num_captures += 1;
            let request = Request::Capture {
                choice: *choice,
                number: state.num_captures,
            };
            (request, "Capturing".to_owned())
        }
        Source::File(path) => (
            Request::Open(path.clone()),
            format!("Opening {}", file_name(path)),
        ),
    };
    state.generation += 1;
    state.work = Some(Work {
        generation: state.generation,
        what,
        stage: None,
    });
    Effect::Post {
        generation: state.generation,
        request,
    }
}

/// Takes in what the worker tells, unless it is about something that nobody waits for any more.
fn hear(state: &mut State, news: News<Result<Arc<Inspected>, Trouble>>) {
    let of = match &news {
        News::Begins { generation, .. }
        | News::Done { generation, .. }
        | News::Panicked { generation, .. } => *generation,
    };
    let Some(work) = state.work.as_mut().filter(|work| work.generation == of) else {
        return;
    };
    match news {
        News::Begins { stage, .. } => work.stage = Some(stage),
        News::Done { outcome, .. } => {
            state.work = None;
            match outcome {
                Ok(inspected) => show(state, of, inspected),
                Err(Trouble { what, advice }) => notify(state, Notice { what, advice }),
            }
        }
        News::Panicked { message, .. } => {
            state.work = None;
            notify(
                state,
                Notice {
                    what: format!("The inspection broke off inside the program: {message}"),
                    advice: "Capture again; if it happens again, keep the file and report it"
                        .into(),
                },
            );
        }
    }
}

fn show(state: &mut State, generation: u64, inspected: Arc<Inspected>) {
    for warning in &inspected.warnings {
        let Trouble { what, advice } = Trouble::of(warning);
        notify(state, Notice { what, advice });
    }
    let is_other = |known: &Arc<_>| !Arc::ptr_eq(known, &inspected.library);
    if state.library.as_ref().is_none_or(is_other) {
        for Trouble { what, advice } in inspected.library.troubles.clone() {
            notify(state, Notice { what, advice });
        }
        state.library = Some(Arc::clone(&inspected.library));
    }
    state.candidate = 0;
    state.shown = Some(Shown {
        generation,
        inspected,
    });
}

fn notify(state: &mut State, notice: Notice) {
    // The same again says nothing new.
    state.notices.retain(|known| *known != notice);
    state.notices.push(notice);
    let num_over = state.notices.len().saturating_sub(MAX_NOTICES);
    state.notices.drain(..num_over);
}

/// `camera_from_part` as four rows of numbers, metres.
fn pose_text(state: &State) -> Option<String> {
    let inspection = &state.shown.as_ref()?.inspected.inspection;
    let pose = inspection.pose.as_ref()?.as_ref().ok()?;
    let numbers = crate::geometry::rigid::row_major(&pose.camera_from_part());
    let rows = numbers.chunks(4).map(|row| {
        let cells: Vec<String> = row.iter().map(|x| format!("{x:.6}")).collect();
        cells.join(" ")
    });
    Some(rows.collect::<Vec<_>>().join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        app::work::Inspector,
        pipeline::{Stage, Unwatched},
    };

    fn posted(effect: Option<Effect>) -> (u64, Request) {
        match effect {
            Some(Effect::Post {
                generation,
                request,
            }) => (generation, request),
            other => panic!("expected a request, found {other:?}"),
        }
    }

    fn done(generation: u64, outcome: Result<Arc<Inspected>, Trouble>) -> Action {
        Action::Hear(News::Done {
            generation,
            outcome,
        })
    }

    fn trouble() -> Trouble {
        Trouble {
            what: "broken".into(),
            advice: "mend it".into(),
        }
    }

    #[test]
    fn a_result_stays_and_is_old_until_the_next_is_there() {
        let mut state = State::default();
        let mut inspector = Inspector::new(None);
        let (generation, request) = posted(apply(&mut state, Action::Capture));
        assert!(!state.is_old() && state.work.is_some());
        let first = inspector.answer(request, &Unwatched).expect("answered");
        apply(&mut state, done(generation, first));
        assert!(state.shown.is_some() && state.work.is_none());
        assert!(matches!(
            apply(&mut state, Action::CopyPose),
            Some(Effect::CopyText(_))
        ));

        apply(&mut state, Action::Capture);
        assert!(state.is_old());
        assert!(matches!(
            apply(&mut state, Action::Cancel),
            Some(Effect::CancelWork)
        ));
        assert!(!state.is_old() && state.shown.is_some());
    }

    #[test]
    fn news_of_an_older_request_are_thrown_away() {
        let mut state = State::default();
        let (older, _) = posted(apply(&mut state, Action::Capture));
        let (newer, _) = posted(apply(&mut state, Action::Open("b.pcd".into())));
        apply(&mut state, done(older, Err(trouble())));
        assert!(state.notices.is_empty() && state.work.is_some());
        let begins = News::Begins {
            generation: newer,
            stage: Stage::Contour,
        };
        apply(&mut state, Action::Hear(begins));
        assert_eq!(
            state.work.as_ref().and_then(|w| w.stage),
            Some(Stage::Contour)
        );
        apply(&mut state, done(newer, Err(trouble())));
        assert_eq!(state.notices.len(), 1);
        assert!(state.work.is_none());
    }

    #[test]
    fn escape_closes_the_shortcuts_before_the_enlarged_stage() {
        let mut state = State::default();
        apply(&mut state, Action::Enlarge(StagePanel::Contour));
        apply(&mut state, Action::ToggleHelp);
        apply(&mut state, Action::CloseTop);
        assert_eq!(
            (state.help, state.enlarged),
            (HelpPage::Closed, Some(StagePanel::Contour))
        );
        apply(&mut state, Action::CloseTop);
        assert_eq!(state.enlarged, None);
    }

    #[test]
    fn only_the_latest_notices_stay_and_none_twice() {
        let mut state = State::default();
        for number in [0, 1, 2, 3, 4, 5, 5] {
            let notice = Notice {
                what: number.to_string(),
                advice: String::new(),
            };
            apply(&mut state, Action::Notify(notice));
        }
        let what: Vec<_> = state.notices.iter().map(|n| n.what.as_str()).collect();
        assert_eq!(what, ["2", "3", "4", "5"]);
        apply(&mut state, Action::Dismiss(0));
        apply(&mut state, Action::Dismiss(9));
        assert_eq!(state.notices.len(), 3);
    }
}
