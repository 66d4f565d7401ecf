//! What the workspace knows, and what changes it.

use std::{path::PathBuf, sync::Arc, time::Duration};

use super::{
    AlignAnswer, AlignRequest,
    pair::{Pair, PairSource},
    start::Start,
    table::{self, TableRow},
    track::{MethodRun, Track},
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

/// A start as a person writes it.
#[derive(Debug, Default)]
pub struct CustomStart {
    /// Whether it is being written.
    pub form: Form,
    /// The text.
    pub text: String,
    /// What is wrong with it, and what is odd about it.
    pub remarks: Vec<String>,
}

/// Whether a form is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Not open.
    #[default]
    Closed,
    /// Open.
    Open,
}

/// Whether the scrubber moves by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Playback {
    /// It stands.
    #[default]
    Paused,
    /// It moves on.
    Playing,
}

/// A pair and what the methods made of it.
#[derive(Debug)]
pub struct Comparison {
    /// The pair.
    pub pair: Arc<Pair>,
    /// One per method that has run, in their order.
    pub runs: Vec<Arc<MethodRun>>,
}

impl Comparison {
    /// The longest way's last place.
    pub fn last_place(&self) -> usize {
        let tracks = self.tracks().map(|(_, track)| track.poses.len());
        tracks.max().unwrap_or(1).saturating_sub(1)
    }

    /// The ways of the methods that found a pose.
    pub fn tracks(&self) -> impl Iterator<Item = (&MethodRun, &Track)> {
        let found = |run: &'_ MethodRun| run.track.is_ok();
        let runs = self.runs.iter().map(Arc::as_ref);
        runs.filter(move |run| found(run))
            .filter_map(|run| Some((run, run.track.as_ref().ok()?)))
    }
}

/// Table I as far as it is there.
#[derive(Debug, Default)]
pub struct TableShown {
    /// The rows, part after part.
    pub rows: Vec<Arc<TableRow>>,
    /// The work that adds rows, or added the last.
    pub generation: Option<u64>,
    /// Rows that were there when it began.
    pub num_before: usize,
    /// How long it took for the rows that it added.
    pub elapsed: Duration,
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

/// The scrubber plays a whole way in so many seconds, short ones more quickly.
const PLAY_SECONDS: f32 = 6.0;
/// Slowest pace, iterations per second.
const LEAST_PACE: f32 = 10.0;

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

impl CustomStart {
    fn write(&mut self, text: String) {
        self.remarks = match parse_pose(&text) {
            Ok(given) => given.doubts.iter().map(ToString::to_string).collect(),
            Err(problem) => vec![problem],
        };
        self.text = text;
    }

    /// True if the text is a start.
    pub fn is_start(&self) -> bool {
        parse_pose(&self.text).is_ok()
    }
}

impl AlignState {
    /// The last place of the scrubber.
    pub fn last_place(&self) -> usize {
        self.shown.as_ref().map_or(0, Comparison::last_place)
    }

    fn go_to(&mut self, place: f32) {
        self.place = place.clamp(0.0, self.last_place() as f32);
    }

    fn toggle_play(&mut self) {
        self.playback = match self.playback {
            Playback::Playing => Playback::Paused,
            Playback::Paused if self.last_place() == 0 => Playback::Paused,
            Playback::Paused => {
                if self.place >= self.last_place() as f32 {
                    self.place = 0.0;
                }
                Playback::Playing
            }
        };
    }

    fn advance(&mut self, seconds: f32) {
        if self.playback == Playback::Paused {
            return;
        }
        let last = self.last_place() as f32;
        self.go_to(self.place + seconds * (last / PLAY_SECONDS).max(LEAST_PACE));
        if self.place >= last {
            self.playback = Playback::Paused;
        }
    }

    /// A method has run: the first of a pair brings the pair to the front.
    fn take_in(&mut self, run: Arc<MethodRun>) {
        match (self.coming.take(), &mut self.shown) {
            (Some(pair), shown) => {
                let runs = vec![run];
                *shown = Some(Comparison { pair, runs });
                self.playback = Playback::Paused;
            }
            (None, Some(shown)) => shown.runs.push(run),
            (None, None) => return,
        }
        // The end is what a person wants to see first.
        if self.playback == Playback::Paused {
            self.place = self.last_place() as f32;
        }
    }
}

/// Takes in what the thread answers.
pub fn hear(state: &mut State, outcome: Result<AlignAnswer, Trouble>) -> Option<Effect> {
    let align = &mut state.align;
    match outcome {
        Ok(AlignAnswer::Prepared(pair)) => align.coming = Some(pair),
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

impl TableShown {
    /// About how long the rest takes, from the rows that were added since the work began.
    pub fn remaining(&self, total: usize) -> Option<Duration> {
        let num_added = self.rows.len().saturating_sub(self.num_before);
        let num_left = total.saturating_sub(self.rows.len());
        (num_added > 0).then(|| self.elapsed.mul_f64(num_left as f64 / num_added as f64))
    }
}

#[cfg(test)]
mod tests;
