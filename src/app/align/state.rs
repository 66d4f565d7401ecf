//! What the workspace knows, and what changes it.

use std::{path::PathBuf, sync::Arc, time::Duration};

use super::{
    AlignAnswer, AlignRequest,
    custom::{CustomStart, Form},
    pair::{Pair, PairSource},
    playback::{Comparison, Playback},
    start::Start,
    table::{self, TableShown},
};
use crate::{
    app::{
        action::{Effect, notify},
        job::{Request, Trouble},
        lane::Lane,
        source::file_name,
        state::{Notice, State},
        writing::WriteRequest,
    },
    geometry::written_pose::parse_pose,
};

/// What the workspace knows.
#[derive(Debug, Default)]
pub struct AlignState {
    /// What is aligned to what.
    pub pairing: Pairing,
    /// Name of the enrolled part; without one the library's first.
    pub part: Option<String>,
    /// How far off a moved copy begins.
    pub start: Start,
    /// The custom start as it is being written.
    pub custom: CustomStart,
    /// The file that is moved.
    pub source: Option<PathBuf>,
    /// The file that stays.
    pub target: Option<PathBuf>,
    /// The last result; methods are added as they come.
    pub shown: Option<Comparison>,
    /// The pair being aligned, until its first method has run: then it is shown.
    pub coming: Option<Arc<Pair>>,
    /// Place on the scrubber, iterations.
    pub place: f32,
    /// Whether the scrubber moves by itself.
    pub playback: Playback,
    /// Table I as far as it is there.
    pub table: TableShown,
}

/// What is aligned to what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pairing {
    /// An enrolled part, moved by a known transform, to itself.
    #[default]
    MovedCopy,
    /// The part of the inspected scene to an enrolled one.
    Scene,
    /// A file to another.
    Files,
}

impl Pairing {
    /// Every pairing, in the order of the buttons.
    pub const ALL: [Self; 3] = [Self::MovedCopy, Self::Scene, Self::Files];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::MovedCopy => "Moved copy",
            Self::Scene => "Scene",
            Self::Files => "Two files",
        }
    }
}

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum AlignAction {
    /// Align something else.
    Choose(Pairing),
    /// Take this enrolled part.
    ChoosePart(String),
    /// Begin here.
    ChooseStart(Start),
    /// Begin at the next random start.
    DrawStart,
    /// Write a start, or stop writing.
    ToggleCustom,
    /// The custom start now reads so.
    WriteCustom(String),
    /// Begin at the custom start.
    UseCustom,
    /// A person chose a file.
    Chosen(AlignAsk, PathBuf),
    /// Align.
    Run,
    /// Go on with Table I.
    RunTable,
    /// Work out Table I from its first row.
    RestartTable,
    /// Take part and start of this row of Table I, and align.
    OpenRow(usize),
    /// Show this iteration.
    Scrub(f32),
    /// Show another iteration, so many on or back.
    Step(f32),
    /// Play or pause.
    TogglePlay,
    /// So many seconds passed while playing.
    Advance(f32),
    /// Put Table I on the clipboard.
    CopyTable,
}

/// What a person is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlignAsk {
    /// The file that is moved.
    Source,
    /// The file that stays.
    Target,
    /// Where Table I is written to.
    TableFile,
}

impl AlignState {
    /// True while rows are being added to Table I.
    pub fn is_table_at_work(state: &State) -> bool {
        let work = state.works.get(&Lane::Align);
        work.is_some_and(|work| state.align.table.generation == Some(work.generation))
    }

    /// True while a pair is being aligned.
    pub fn is_pair_at_work(state: &State) -> bool {
        state.works.contains_key(&Lane::Align) && !Self::is_table_at_work(state)
    }

    /// The part that is chosen, if the library has any.
    pub fn chosen_part(state: &State) -> Option<&str> {
        let parts = &state.library.as_ref()?.parts;
        let is_there = |name: &&str| parts.iter().any(|part| part.name.as_str() == *name);
        let chosen = state.align.part.as_deref().filter(is_there);
        chosen.or_else(|| parts.first().map(|part| part.name.as_str()))
    }

    /// What Run would align, or what is missing for it, in words.
    pub fn choice(state: &State) -> Result<PairSource, String> {
        let align = &state.align;
        let part = || {
            let part = Self::chosen_part(state).map(str::to_owned);
            part.ok_or_else(|| {
                "The library has no part: enrol one in the Enrol workspace".to_owned()
            })
        };
        match align.pairing {
            Pairing::MovedCopy => Ok(PairSource::MovedCopy {
                part: part()?,
                start: align.start,
            }),
            Pairing::Scene => {
                let shown = state.shown.as_ref();
                let inspected = &shown
                    .ok_or("Nothing inspected yet: press Capture")?
                    .inspected;
                if inspected.inspection.segmentation.part.is_err() {
                    return Err("No part was found in the scene: capture another".into());
                }
                Ok(PairSource::Scene {
                    inspected: Arc::clone(inspected),
                    part: part()?,
                })
            }
            Pairing::Files => Ok(PairSource::Files {
                source: align
                    .source
                    .clone()
                    .ok_or("Choose the file that is moved: Source…")?,
                target: align
                    .target
                    .clone()
                    .ok_or("Choose the file that stays: Target…")?,
            }),
        }
    }
}

/// Makes it so.
pub fn apply(state: &mut State, action: AlignAction) -> Option<Effect> {
    let align = &mut state.align;
    match action {
        AlignAction::Choose(pairing) => align.pairing = pairing,
        AlignAction::ChoosePart(part) => align.part = Some(part),
        AlignAction::ChooseStart(start) => align.start = start,
        AlignAction::DrawStart => {
            let seed = match align.start {
                Start::Random(seed) => seed + 1,
                Start::Paper(_) | Start::Custom(_) => 1,
            };
            align.start = Start::Random(seed);
        }
        AlignAction::ToggleCustom => {
            align.custom.form = match align.custom.form {
                Form::Closed => Form::Open,
                Form::Open => Form::Closed,
            }
        }
        AlignAction::WriteCustom(text) => align.custom.write(text),
        AlignAction::UseCustom => {
            if let Ok(given) = parse_pose(&align.custom.text) {
                align.start = Start::Custom(given.pose);
                align.custom.form = Form::Closed;
            }
        }
        AlignAction::Chosen(AlignAsk::Source, path) => align.source = Some(path),
        AlignAction::Chosen(AlignAsk::Target, path) => align.target = Some(path),
        AlignAction::Chosen(AlignAsk::TableFile, path) => {
            let what = format!("Writing {}", file_name(&path));
            let text = table::text(&align.table.rows, ',');
            return Some(state.begin(what, Request::Write(WriteRequest::Text { path, text })));
        }
        AlignAction::Run => return run(state),
        AlignAction::RunTable => return Some(run_table(state)),
        AlignAction::RestartTable => {
            align.table.rows.clear();
            return Some(run_table(state));
        }
        AlignAction::OpenRow(row) => {
            let row = Arc::clone(align.table.rows.get(row)?);
            align.pairing = Pairing::MovedCopy;
            align.part = Some(row.part.clone());
            align.start = Start::Paper(row.start);
            // Table I goes on; a second look must not end it.
            if !AlignState::is_table_at_work(state) {
                return run(state);
            }
        }
        AlignAction::Scrub(place) => {
            align.playback = Playback::Paused;
            align.go_to(place);
        }
        AlignAction::Step(places) => {
            align.playback = Playback::Paused;
            align.go_to(align.place.round() + places);
        }
        AlignAction::TogglePlay => align.toggle_play(),
        AlignAction::Advance(seconds) => align.advance(seconds),
        AlignAction::CopyTable => {
            let text = table::text(&align.table.rows, '\t');
            notify(state, Notice::done("Copied Table I"));
            return Some(Effect::CopyText(text));
        }
    }
    None
}

fn run(state: &mut State) -> Option<Effect> {
    let source = AlignState::choice(state).ok()?;
    state.align.coming = None;
    Some(state.begin("Aligning", Request::Align(AlignRequest::Pair(source))))
}

fn run_table(state: &mut State) -> Effect {
    let table = &mut state.align.table;
    let done: Vec<_> = table
        .rows
        .iter()
        .map(|row| (row.part.clone(), row.start))
        .collect();
    table.num_before = done.len();
    table.elapsed = Duration::ZERO;
    let effect = state.begin("Table I", Request::Align(AlignRequest::Table { done }));
    state.align.table.generation = Some(state.generation);
    effect
}

/// Takes in what the thread answers.
pub fn hear(state: &mut State, outcome: Result<AlignAnswer, Trouble>) -> Option<Effect> {
    let align = &mut state.align;
    match outcome {
        Ok(AlignAnswer::Prepared(pair)) => {
            align.coming = Some(Arc::clone(&pair));
            for warning in &pair.warnings {
                notify(state, warning.clone().into());
            }
        }
        Ok(AlignAnswer::Ran(run)) => align.take_in(run),
        Ok(AlignAnswer::Row { row, elapsed }) => {
            align.table.rows.push(row);
            align.table.elapsed = elapsed;
        }
        Ok(AlignAnswer::Finished) => {}
        Err(_) => align.coming = None,
    }
    None
}

#[cfg(test)]
mod tests;
