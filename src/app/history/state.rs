//! What was inspected since the window was opened, and what can be done with it.

use std::{collections::VecDeque, sync::Arc};

use jiff::{Timestamp, tz::TimeZone};

use crate::{
    app::{
        action::{Effect, notify},
        inspect::work::{InspectRequest, Inspected},
        job::Request,
        live,
        source::{Origin, SceneSource, file_name},
        state::{Notice, NoticeKind, Shown, State, Workspace},
        writing::WriteRequest,
    },
    error::Advice as _,
    geometry::rigid::row_major,
    pipeline::{Recipe, Verdict},
};

/// Rows kept; the oldest go first.
const MAX_ROWS: usize = 2000;
/// Inspections kept whole, with their points and pictures: about 15 MB each. Older ones are inspected again.
const MAX_WHOLE: usize = 6;

/// What the workspace knows.
#[derive(Debug, Default)]
pub struct HistoryState {
    /// The newest first.
    rows: VecDeque<PastInspection>,
    /// Inspections so far.
    count: u64,
    /// What is listed.
    pub filter: HistoryFilter,
    /// Numbers of the rows that the filter lets through, the newest first.
    listed: Vec<u64>,
    /// Number of the row that is looked at.
    pub selected: Option<u64>,
    /// The request whose result is no inspection of its own: the scene in front with something else changed.
    pub(in crate::app) repeated: Option<u64>,
    /// A row that is being inspected again to be opened: generation of the request, number of the row.
    reopening: Option<(u64, u64)>,
}

/// What the list shows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HistoryFilter {
    /// Part of the name of part or scene; case does not matter.
    pub text: String,
    /// Only these verdicts.
    pub verdict: Option<PastVerdict>,
}

/// How an inspection ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PastVerdict {
    /// A part, accepted.
    Accepted,
    /// A part, not accepted.
    NotAccepted,
    /// No part.
    NoPart,
}

impl PastVerdict {
    /// Every verdict.
    pub const ALL: [Self; 3] = [Self::Accepted, Self::NotAccepted, Self::NoPart];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Accepted => "Accepted",
            Self::NotAccepted => "Not accepted",
            Self::NoPart => "No part",
        }
    }
}

/// An inspection that was.
#[derive(Debug)]
pub struct PastInspection {
    /// Counted from 1.
    pub number: u64,
    /// When.
    pub at: Timestamp,
    /// The same for people: day and time of day, as the clocks here go.
    pub when: [String; 2],
    /// Of what.
    pub origin: Origin,
    /// The scene's name for people.
    pub scene: String,
    /// How it ended.
    pub verdict: PastVerdict,
    /// The best part's name for people; `No part` where there is none.
    pub title: String,
    /// The best part's name.
    pub part: Option<String>,
    /// Why it was not accepted and what to do, if it was not.
    pub complaint: Option<(String, String)>,
    /// The best part's score and its lead.
    pub score: Option<[f64; 2]>,
    /// The score for people; empty where there is none.
    pub score_text: String,
    /// `camera_from_part`, row-major, metres.
    pub pose: Option<[f64; 16]>,
    /// From points to verdict, milliseconds.
    pub total_ms: f64,
    /// The same for people, without its unit.
    pub time_text: String,
    /// With which parameters.
    pub recipe: Arc<Recipe>,
    /// All of it, as long as it is kept.
    pub whole: Option<Arc<Inspected>>,
}

impl PastInspection {
    fn of(number: u64, inspected: &Arc<Inspected>) -> Self {
        let inspection = &inspected.inspection;
        let (verdict, part, score, complaint) = match &inspection.verdict {
            Verdict::Part {
                part,
                score,
                margin,
                rejected,
                ..
            } => {
                let verdict = match rejected {
                    None => PastVerdict::Accepted,
                    Some(_) => PastVerdict::NotAccepted,
                };
                let complaint = rejected.as_ref().map(|r| (r.to_string(), r.advice()));
                let score = Some([*score, *margin]);
                (verdict, Some(part.clone()), score, complaint)
            }
            Verdict::NoPart(reason) => {
                let complaint = Some((reason.to_string(), reason.advice()));
                (PastVerdict::NoPart, None, None, complaint)
            }
        };
        let best = inspected.figures.candidates.first();
        let total_ms = inspection.timings.total.as_secs_f64() * 1000.0;
        let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
        Self {
            number,
            at: inspected.at,
            when: when(inspected.at),
            origin: inspected.origin.clone(),
            scene: inspected.origin.title(),
            verdict,
            title: match (verdict, best) {
                (PastVerdict::Accepted, Some(best)) => best.title.clone(),
                (PastVerdict::NotAccepted, Some(best)) => {
                    format!("Not recognised · nearest {}", best.title)
                }
                (PastVerdict::NoPart, _) => "No part".into(),
                (_, None) => part.clone().unwrap_or_default(),
            },
            part,
            complaint,
            score,
            score_text: score.map_or_else(String::new, |[score, _]| format!("{score:.2}")),
            pose: pose.map(|pose| row_major(&pose.camera_from_part())),
            total_ms,
            time_text: format!("{total_ms:.1}"),
            recipe: Arc::clone(&inspected.recipe),
            whole: Some(Arc::clone(inspected)),
        }
    }

    fn passes(&self, filter: &HistoryFilter) -> bool {
        let text = filter.text.trim().to_lowercase();
        let is_meant = |name: &str| name.to_lowercase().contains(&text);
        filter.verdict.is_none_or(|verdict| verdict == self.verdict)
            && (is_meant(&self.title) || is_meant(&self.scene))
    }
}

fn when(at: Timestamp) -> [String; 2] {
    let here = at.to_zoned(TimeZone::system());
    ["%Y-%m-%d", "%H:%M:%S"].map(|format| here.strftime(format).to_string())
}

impl HistoryState {
    /// True before the first inspection.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// How many are remembered.
    pub fn num_rows(&self) -> usize {
        self.rows.len()
    }

    /// Numbers of the rows that the filter lets through, the newest first.
    pub fn listed(&self) -> &[u64] {
        &self.listed
    }

    /// The row of this number.
    pub fn row(&self, number: u64) -> Option<&PastInspection> {
        let newest = self.rows.front()?.number;
        self.rows
            .get(usize::try_from(newest.checked_sub(number)?).ok()?)
    }

    /// The row that is looked at.
    pub fn selected(&self) -> Option<&PastInspection> {
        self.row(self.selected?)
    }

    fn row_mut(&mut self, number: u64) -> Option<&mut PastInspection> {
        let newest = self.rows.front()?.number;
        self.rows
            .get_mut(usize::try_from(newest.checked_sub(number)?).ok()?)
    }

    fn add(&mut self, inspected: &Arc<Inspected>) {
        self.count += 1;
        let row = PastInspection::of(self.count, inspected);
        // Who looks at the newest goes on looking at the newest.
        let follows = self.selected.is_none_or(|number| number + 1 == self.count);
        if follows {
            self.selected = Some(row.number);
        }
        if row.passes(&self.filter) {
            self.listed.insert(0, row.number);
        }
        self.rows.push_front(row);
        self.rows.truncate(MAX_ROWS);
        let oldest = self.rows.back().map_or(0, |row| row.number);
        self.listed.retain(|number| *number >= oldest);
        self.thin();
    }

    /// Keeps the newest whole, and the one looked at.
    fn thin(&mut self) {
        let selected = self.selected;
        for row in self.rows.iter_mut().skip(MAX_WHOLE) {
            if Some(row.number) != selected {
                row.whole = None;
            }
        }
    }

    fn list(&mut self) {
        let filter = &self.filter;
        let passing = self.rows.iter().filter(|row| row.passes(filter));
        self.listed = passing.map(|row| row.number).collect();
    }
}

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum HistoryAction {
    /// List only these.
    Filter(HistoryFilter),
    /// Look at this row.
    Select(u64),
    /// Look at the row above (the newer one) or below.
    Step(Direction),
    /// Show the inspection with all its stages.
    Open(u64),
    /// Show the row that is looked at.
    OpenSelected,
    /// Inspect its scene again with the recipe now in use.
    InspectAgain(u64),
}

/// Which way to go in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// To newer ones.
    Up,
    /// To older ones.
    Down,
}

/// Makes it so.
pub fn apply(state: &mut State, action: HistoryAction) -> Option<Effect> {
    let history = &mut state.history;
    match action {
        HistoryAction::Filter(filter) => {
            history.filter = filter;
            history.list();
        }
        HistoryAction::Select(number) => {
            history.selected = Some(number);
            history.thin();
        }
        HistoryAction::Step(direction) => {
            let listed = &history.listed;
            let at = listed.iter().position(|n| Some(*n) == history.selected);
            let to = match (at, direction) {
                (None, _) => 0,
                (Some(at), Direction::Up) => at.saturating_sub(1),
                (Some(at), Direction::Down) => at + 1,
            };
            if let Some(number) = listed.get(to) {
                history.selected = Some(*number);
            }
        }
        HistoryAction::OpenSelected => {
            let number = history.selected?;
            return open(state, number);
        }
        HistoryAction::Open(number) => return open(state, number),
        HistoryAction::InspectAgain(number) => return inspect_again(state, number),
    }
    None
}

fn open(state: &mut State, number: u64) -> Option<Effect> {
    let row = state.history.row(number)?;
    if let Some(inspected) = row.whole.clone() {
        state.generation += 1;
        state.candidate = 0;
        state.shown = Some(Shown {
            generation: state.generation,
            inspected,
            is_past: true,
            session: None,
        });
        state.workspace = Workspace::Inspect;
        return live::give_way(state);
    }
    let Some(source) = row.origin.source() else {
        let notice = not_kept(row);
        notify(state, notice);
        return None;
    };
    let request = InspectRequest {
        source,
        recipe: Arc::clone(&row.recipe),
    };
    let what = format!("Opening {}", row.origin.title());
    state.workspace = Workspace::Inspect;
    let effect = state.begin(what, Request::Inspect(request));
    state.history.reopening = Some((state.generation, number));
    Some(effect)
}

/// What a camera saw once is gone once its points were let go of.
fn not_kept(row: &PastInspection) -> Notice {
    Notice {
        kind: NoticeKind::Look,
        what: format!(
            "The points of {} are not kept any more: those of the last {MAX_WHOLE} inspections are",
            row.origin.title()
        ),
        advice: "Record the source (Source menu) to inspect any of its frames again".into(),
    }
}

fn inspect_again(state: &mut State, number: u64) -> Option<Effect> {
    let row = state.history.row(number)?;
    let at_hand = row
        .whole
        .as_ref()
        .map(|whole| SceneSource::AtHand(Arc::clone(&whole.scene), whole.origin.clone()));
    let Some(source) = at_hand.or_else(|| row.origin.source()) else {
        let notice = not_kept(row);
        notify(state, notice);
        return None;
    };
    let what = format!("Inspecting {} again", row.origin.title());
    let recipe = Arc::clone(&state.recipe);
    state.workspace = Workspace::Inspect;
    Some(state.begin(what, Request::Inspect(InspectRequest { source, recipe })))
}

/// Takes in a verdict that counts, of a source that is followed.
pub fn keep(state: &mut State, inspected: &Arc<Inspected>) {
    state.history.add(inspected);
}

/// Takes in a new result; true if it is a past one that was asked for again.
pub fn take_in(state: &mut State, generation: u64, inspected: &Arc<Inspected>) -> bool {
    let history = &mut state.history;
    if history.repeated == Some(generation) {
        history.repeated = None;
        return false;
    }
    let reopened = history.reopening.filter(|(of, _)| *of == generation);
    let Some((_, number)) = reopened else {
        history.add(inspected);
        return false;
    };
    history.reopening = None;
    let Some(row) = history.row_mut(number) else {
        return false;
    };
    let again = PastInspection::of(number, inspected);
    let is_same = (&row.verdict, &row.part, &row.score, &row.pose)
        == (&again.verdict, &again.part, &again.score, &again.pose);
    if !is_same {
        let notice = Notice {
            kind: NoticeKind::Look,
            what: format!(
                "{} gives another result than it did: the file or the library has changed since",
                row.origin.title()
            ),
            advice: "The list keeps the first result".into(),
        };
        notify(state, notice);
    }
    true
}

/// The first line of [`csv`].
const CSV_HEAD: &str = "number,time,scene,simulated,verdict,part,score,margin,reason,total_ms,\
    m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23,m30,m31,m32,m33";

/// The listed rows as comma-separated values, the oldest first; m00..m33 are `camera_from_part`, metres.
pub fn csv(history: &HistoryState) -> String {
    let rows = history.listed.iter().rev();
    let lines = rows.filter_map(|number| history.row(*number)).map(|row| {
        let [score, margin] = row
            .score
            .map_or_else(Default::default, |both| both.map(|x| format!("{x:.4}")));
        let scene = match &row.origin {
            Origin::File(path) => path.display().to_string(),
            frame @ (Origin::Simulated { .. } | Origin::Frame { .. }) => frame.title(),
        };
        let reason = row.complaint.as_ref().map_or("", |(reason, _)| reason);
        let pose: Vec<String> = match &row.pose {
            Some(numbers) => numbers.iter().map(|x| format!("{x:.9}")).collect(),
            None => vec![String::new(); 16],
        };
        format!(
            "{},{},{},{},{},{},{score},{margin},{},{:.3},{}",
            row.number,
            row.at,
            quoted(&scene),
            row.origin.is_simulated(),
            quoted(row.verdict.title()),
            row.part.as_deref().unwrap_or(""),
            quoted(reason),
            row.total_ms,
            pose.join(","),
        )
    });
    let mut text = String::from(CSV_HEAD);
    for line in lines {
        text.push('\n');
        text.push_str(&line);
    }
    text.push('\n');
    text
}

/// A field as RFC 4180 has it.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// Writes what is listed to the file that a person chose.
pub fn export(state: &mut State, path: std::path::PathBuf) -> Effect {
    let text = csv(&state.history);
    let what = format!("Writing {}", file_name(&path));
    state.begin(what, Request::Write(WriteRequest::Text { path, text }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        app::{inspect::work::inspect, shelf::Shelf, source::CellChoice},
        pipeline::{PoseChoice, Unwatched},
        simulate::ObjectKind,
    };

    fn inspected(shelf: &Shelf, choice: CellChoice, number: u64) -> Arc<Inspected> {
        // Without a pose it is quick, and no part is accepted by its outline alone less surely.
        let recipe = Recipe {
            pose: PoseChoice::Skip,
            ..Recipe::default()
        };
        let request = InspectRequest {
            source: SceneSource::Cell { choice, number },
            recipe: Arc::new(recipe),
        };
        let inspected = inspect(&request, shelf, &Unwatched).expect("inspected");
        Arc::new(inspected.expect("not cancelled"))
    }

    fn filled() -> State {
        let shelf = Shelf::default();
        let mut state = State::default();
        let choices = [
            CellChoice::InTurn,
            CellChoice::Empty,
            CellChoice::Foreign(ObjectKind::Wheel),
        ];
        for (number, choice) in (1..).zip(choices) {
            let found = inspected(&shelf, choice, number);
            assert!(!take_in(&mut state, number, &found));
        }
        state
    }

    #[test]
    fn the_newest_comes_first_and_filters_leave_what_they_say() {
        let mut state = filled();
        assert_eq!(state.history.listed(), [3, 2, 1]);
        let filter = |text: &str, verdict| {
            HistoryAction::Filter(HistoryFilter {
                text: text.into(),
                verdict,
            })
        };
        apply(&mut state, filter("", Some(PastVerdict::NoPart)));
        assert_eq!(state.history.listed(), [2]);
        apply(&mut state, filter(" FRONT door", None));
        assert_eq!(state.history.listed(), [1]);
        apply(&mut state, filter("frame 3", None));
        assert_eq!(state.history.listed(), [3]);
        apply(&mut state, filter("no such thing", None));
        assert!(state.history.listed().is_empty());
        assert!(state.history.selected().is_some());
    }

    #[test]
    fn the_arrows_stop_at_the_ends() {
        let mut state = filled();
        assert_eq!(state.history.selected, Some(3));
        for expected in [2, 1, 1] {
            apply(&mut state, HistoryAction::Step(Direction::Down));
            assert_eq!(state.history.selected, Some(expected));
        }
        apply(&mut state, HistoryAction::Step(Direction::Up));
        assert_eq!(state.history.selected, Some(2));
    }

    #[test]
    fn an_inspection_kept_whole_opens_at_once_and_an_older_one_is_made_again() {
        let mut state = filled();
        assert!(apply(&mut state, HistoryAction::Open(1)).is_none());
        let shown = state.shown.as_ref().expect("shown");
        assert!(shown.is_past && state.workspace == Workspace::Inspect);

        state.history.row_mut(1).expect("there").whole = None;
        let effect = apply(&mut state, HistoryAction::Open(1));
        let Some(Effect::Post {
            generation,
            request: Request::Inspect(request),
        }) = effect
        else {
            panic!("expected a request, found {effect:?}");
        };
        let again = inspect(&request, &Shelf::default(), &Unwatched).expect("inspected");
        let again = Arc::new(again.expect("not cancelled"));
        assert!(take_in(&mut state, generation, &again));
        assert_eq!(state.history.num_rows(), 3);
        // The very same result: nothing to remark on.
        assert!(state.notices.is_empty(), "{:?}", state.notices);
    }

    #[test]
    fn only_so_many_are_kept_whole_and_the_one_looked_at_is() {
        let shelf = Shelf::default();
        let found = inspected(&shelf, CellChoice::Empty, 1);
        let mut state = State::default();
        take_in(&mut state, 1, &found);
        apply(&mut state, HistoryAction::Select(1));
        state.history.selected = Some(1);
        for generation in 2..40 {
            // Another row is looked at than the newest, so that it stays.
            state.history.selected = Some(1);
            take_in(&mut state, generation, &found);
        }
        let whole = state.history.rows.iter().filter(|row| row.whole.is_some());
        let numbers: Vec<u64> = whole.map(|row| row.number).collect();
        assert!(numbers.len() <= MAX_WHOLE + 1, "{numbers:?}");
        assert_eq!(state.history.num_rows(), 39);
    }

    #[test]
    fn the_table_has_a_head_and_a_line_for_each_listed_row() {
        let state = filled();
        let text = csv(&state.history);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4);
        let num_fields = lines[0].split(',').count();
        assert!(lines[1].starts_with("1,") && lines[3].starts_with("3,"));
        assert!(lines[2].contains(",No part,"));
        // No field here holds a comma, but for the quoted reasons.
        assert!(lines[1].split(',').count() >= num_fields);
        assert_eq!(quoted("a \"b\", c"), "\"a \"\"b\"\", c\"");
    }
}
