//! Everything that can happen in the workspace, and the one function that makes it so.

use std::{ops::Range, path::PathBuf, sync::Arc};

use jiff::Zoned;

use super::{
    filter::ListFilter,
    reopen::{go_on, inspect_again, open},
    state::{look, look_if_stale},
    work::Looked,
};
use crate::{
    app::{
        action::{Effect, notify},
        inspect::work::Inspected,
        job::{Request, Trouble},
        source::file_name,
        state::{Notice, NoticeKind, State},
        writing::{PastExport, WriteRequest},
    },
    history::{HistoryNews, NewEntry, Retention, SetAside, Swept},
    library::Truth,
};

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum HistoryAction {
    /// List only these.
    Filter(ListFilter),
    /// These rows of the list are in sight.
    Visible(Range<usize>),
    /// Look at this inspection.
    Select(i64),
    /// Look at the row above (the newer one) or below.
    Step(Direction),
    /// Show the inspection with all its stages.
    Open(i64),
    /// Show the inspection that is looked at.
    OpenSelected,
    /// Inspect its scene again with the recipe and the library now in use, and say what changed.
    InspectAgain(i64),
    /// The same with the inspection that is looked at.
    AgainSelected,
    /// A person remarks this.
    Remark(i64, String),
    /// A person says what it truly is, or that nobody knows.
    Label(i64, Option<Truth>),
    /// Open the window of the rule by which frames are kept, change the rule in it, or close it.
    Rule(Option<Retention>),
    /// Keep frames by this rule.
    Keep(Retention),
    /// The thread that writes has news.
    Hear(HistoryNews),
    /// The disk is too slow: of so many inspections the frame was not kept, and so many are lost.
    Crowded([usize; 2]),
}

/// Which way to go in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// To newer ones.
    Up,
    /// To older ones.
    Down,
}

/// What the thread that writes is asked for.
#[derive(Clone, Debug)]
pub enum HistoryJob {
    /// Write an inspection; the ticket comes back with its number.
    Add(u64, Box<NewEntry>),
    /// Write down a remark.
    Remark(i64, String),
    /// Write down what it truly is.
    Label(i64, Option<Truth>),
    /// Keep frames by this rule.
    Keep(Retention),
}

/// Makes it so.
pub fn apply(state: &mut State, action: HistoryAction) -> Option<Effect> {
    let history = &mut state.history;
    match action {
        HistoryAction::Filter(filter) => {
            history.filter = filter;
            Some(look(state))
        }
        HistoryAction::Visible(rows) => history.sees(rows).then(|| look(state)),
        HistoryAction::Select(number) => select(state, number),
        HistoryAction::Step(direction) => {
            let at = history.selected.and_then(|number| history.place_of(number));
            let to = match (at, direction) {
                (None, _) => 0,
                (Some(at), Direction::Up) => at.saturating_sub(1),
                (Some(at), Direction::Down) => at + 1,
            };
            let number = history.row(to)?.number;
            select(state, number)
        }
        HistoryAction::OpenSelected => {
            let number = history.selected?;
            open(state, number)
        }
        HistoryAction::Open(number) => open(state, number),
        HistoryAction::InspectAgain(number) => inspect_again(state, number),
        HistoryAction::AgainSelected => {
            let number = history.selected?;
            inspect_again(state, number)
        }
        HistoryAction::Remark(number, remark) => {
            history.asked();
            Some(Effect::History(HistoryJob::Remark(number, remark)))
        }
        HistoryAction::Label(number, label) => {
            history.asked();
            Some(Effect::History(HistoryJob::Label(number, label)))
        }
        HistoryAction::Rule(rule) => {
            history.rule = rule;
            None
        }
        HistoryAction::Keep(rule) => {
            history.rule = None;
            history.asked();
            Some(Effect::History(HistoryJob::Keep(rule.sensible())))
        }
        HistoryAction::Hear(news) => hear(state, news),
        HistoryAction::Crowded([_, num_lost]) => {
            history.lost(num_lost);
            // Once is enough: it will not become quicker by being said again.
            if !std::mem::replace(&mut history.is_crowded, true) {
                let notice = Notice {
                    kind: NoticeKind::Look,
                    what: "The history cannot keep up: the frames of some inspections are not kept"
                        .into(),
                    advice: "Keep fewer frames (Frames… in History), or use a quicker disk".into(),
                };
                notify(state, notice);
            }
            look_if_stale(state)
        }
    }
}

fn select(state: &mut State, number: i64) -> Option<Effect> {
    if state.history.selected == Some(number) {
        return None;
    }
    state.history.selected = Some(number);
    Some(look(state))
}

/// Hands an inspection over to be written.
pub fn keep(state: &mut State, inspected: &Arc<Inspected>) -> Effect {
    let ticket = state.history.ticket(inspected);
    let entry = Box::new(inspected.entry.clone());
    Effect::History(HistoryJob::Add(ticket, entry))
}

/// Takes in what the thread that writes has to tell.
fn hear(state: &mut State, news: HistoryNews) -> Option<Effect> {
    let history = &mut state.history;
    match news {
        HistoryNews::Added { ticket, number } => history.added(ticket, number),
        HistoryNews::SetAside(SetAside { what, aside }) => {
            let notice = Notice {
                kind: NoticeKind::Look,
                what: format!("The history: {what}"),
                advice: format!(
                    "It was set aside as {}; a new one is begun",
                    aside.display()
                ),
            };
            notify(state, notice);
        }
        HistoryNews::Failed { what, advice } => {
            let trouble = Trouble { what, advice };
            history.trouble = Some(trouble.clone());
            let mut notice = Notice::from(trouble);
            notice
                .advice
                .push_str("; inspections go on, and are kept in memory until then");
            notify(state, notice);
        }
        HistoryNews::Works { numbers, num_lost } => {
            history.trouble = None;
            history.renumber(&numbers);
            let mut what = format!(
                "The history is written again: {} that waited",
                inspections(numbers.len())
            );
            if num_lost > 0 {
                what = format!("{what}, {} were too many", inspections(num_lost));
            }
            notify(state, Notice::done(what));
        }
        HistoryNews::NotChanged { what, advice } => {
            history.answered();
            notify(state, Trouble { what, advice }.into());
        }
        HistoryNews::Swept(Swept {
            num_frames,
            num_bytes,
        }) => {
            let megabytes = num_bytes as f64 / 1e6;
            let what = format!(
                "The history let go of {}, {megabytes:.1} MB, by the rule for frames",
                frames(num_frames)
            );
            notify(state, Notice::done(what));
            state.history.stale();
        }
        HistoryNews::Changed { .. } | HistoryNews::RuleChanged => history.answered(),
    }
    look_if_stale(state)
}

/// So many inspections, in words.
pub(super) fn inspections(num: usize) -> String {
    match num {
        1 => "one inspection".into(),
        num => format!("{num} inspections"),
    }
}

/// So many frames, in words.
pub(super) fn frames(num: usize) -> String {
    match num {
        1 => "1 frame".into(),
        num => format!("{num} frames"),
    }
}

/// Takes in what was looked up.
pub fn take(state: &mut State, looked: Looked) -> Option<Effect> {
    let before = state.history.selected;
    state.history.take(looked);
    // The first look finds what there is to be looked at.
    if before != state.history.selected {
        return Some(look(state));
    }
    go_on(state)
}

/// Writes what is listed to where a person chose.
pub fn export(state: &mut State, to: PastExport) -> Effect {
    let path: &PathBuf = match &to {
        PastExport::Csv(path) | PastExport::Cases(path) => path,
    };
    let what = format!("Writing {}", file_name(path));
    let filter = state.history.filter.at(&Zoned::now());
    state.begin(what, Request::Write(WriteRequest::Past { filter, to }))
}
