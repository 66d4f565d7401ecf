//! State shared by the workspaces. They read it; only the shell changes it.

use std::{path::PathBuf, ptr, sync::Arc};

use jiff::{Zoned, civil};
use serde::{Deserialize, Serialize};

use crate::{
    cell::{AnswerSetup, ProgramSetup, ServoSettings},
    inspection::{
        inspected::{InspectJob, InspectRequest, Inspected},
        library_cache::LibraryView,
        source::{CellChoice, ScanFiles, ScanOrder, ScanRequest, SceneOrScan},
    },
    language::UnitSystem,
    rack::{RackEditor, RackInUse},
    source::live::{LiveState, SourceState},
    trace::{current_trace::CurrentTrace, orders::Expecting},
};
use capture::SourceSpec;
use inspection::{
    library::Truth,
    pipeline::{Expected, NamedRecipe, live::MotionState},
};
use records::history::{DriftWarning, HungId, StoredVerdict, Summary};
use robot::{Convention, RobotFrame};
use stages::{rack::Rack, scene::EmptyCell};
use station::{Doubt, Subject, age_doubt};
use ui::{
    language::{Language, text},
    user_error::UserError,
    widgets::Mark,
};

pub use ui::theme::ThemeChoice;

/// State shared by the workspaces.
#[derive(Debug, Default)]
pub struct Session {
    /// Where Capture takes a scene from.
    pub source: Source,
    /// The empty cell, if one was captured.
    pub empty_cell: Option<Arc<EmptyCell>>,
    /// Recently opened scenes, newest first.
    pub recent: Vec<PathBuf>,
    /// The result in front.
    pub shown: Option<Shown>,
    /// What the inspector is working on.
    pub inspecting: Option<Inspecting>,
    /// Why the last run of the inspector failed.
    pub failed: Option<UserError>,
    /// State of the followed source.
    pub live: LiveState,
    /// The library in use, once loaded.
    pub library: Option<Arc<LibraryView>>,
    /// The library's folder, if the user chose one in the window.
    pub chosen_library: Option<PathBuf>,
    /// The recipe for inspections.
    pub recipe: Arc<NamedRecipe>,
    /// The convention in which poses are shown, copied and written; [`AnswerSetup`] has that of the answers to robots.
    pub convention: Convention,
    /// The arm and the gun of robot programs.
    pub program: ProgramSetup,
    /// What is servoed.
    pub servo: ServoSettings,
    /// The tab of Paint that is shown.
    pub paint_tab: PaintTab,
    /// Where parts may hang.
    pub rack: RackInUse,
    /// The window in which the rack is edited, while it is open: every part of a frame is found, so that each can get a place.
    pub rack_editor: Option<RackEditor>,
    /// The robot frame, with the camera's pose in the robot's base, if the cell is calibrated.
    pub robot: Option<Arc<RobotFrame>>,
    /// Whether and where robots are answered.
    pub answering: AnswerSetup,
    /// Which calibration of the robot's cell is used.
    pub cell: RememberedCell,
    /// File of the user's own calibration; `None` if there is no place for it, and then nothing is written.
    pub usual_cell: Option<PathBuf>,
    /// Units of shown lengths and angles.
    pub units: UnitSystem,
    /// The colour theme.
    pub theme: ThemeChoice,
    /// The language of the window.
    pub language: Language,
    /// The language that the user chose; `None` for the system's.
    pub chosen_language: Option<Language>,
    /// Role of the current user.
    pub role: UserRole,
    /// Traceability of the next inspection.
    pub trace: CurrentTrace,
    /// What should hang before the camera.
    pub expecting: Expecting,
    /// When shifts start.
    pub shift_starts: ShiftStarts,
    /// The parts of this shift, counted in the operator's view.
    pub shift: ShiftParts,
    /// True while the history cannot write inspections, which stay in memory.
    pub is_history_failing: bool,
    /// The workspace in front.
    pub workspace: WorkspaceKind,
}

impl Session {
    /// The recipe for results that are shown, before this rack, in which these parts are expected. While the rack is edited, any
    /// part may hang there.
    pub(crate) fn recipe_to_show(&self, rack: &Rack, expected: Expected) -> Arc<NamedRecipe> {
        if self.rack_editor.is_some() {
            let recipe = self.recipe_in_rack(rack, Expected::default());
            return Arc::new(recipe.finding_all());
        }
        self.recipe_in_rack(rack, expected)
    }

    /// The recipe in use, before this rack, in which these parts are expected.
    pub(crate) fn recipe_in_rack(&self, rack: &Rack, expected: Expected) -> Arc<NamedRecipe> {
        if rack.is_empty() && expected.is_empty() {
            return Arc::clone(&self.recipe);
        }
        Arc::new(self.recipe.in_rack(rack.clone()).expecting(expected))
    }

    /// Makes a job to inspect something with the recipe and the calibration in use, before this rack, in which these parts are
    /// expected; a scan takes no rack.
    pub(crate) fn inspect_job(
        &self,
        source: SceneOrScan,
        rack: &Rack,
        expected: Expected,
    ) -> InspectJob {
        match source {
            SceneOrScan::Scene(source) => InspectJob::Scene(InspectRequest {
                source,
                recipe: self.recipe_to_show(rack, expected),
            }),
            SceneOrScan::Scan(order) => InspectJob::Scan(ScanRequest {
                recipe: Arc::new(self.recipe.expecting(expected.anywhere())),
                ..self.scan_request(order)
            }),
        }
    }

    /// Makes a request to put shots together with the recipe and the calibration in use.
    pub fn scan_request(&self, order: ScanOrder) -> ScanRequest {
        ScanRequest {
            order,
            calibration: self.calibration_path(),
            recipe: Arc::clone(&self.recipe),
        }
    }

    /// True while a source is followed.
    pub fn is_live(&self) -> bool {
        self.live.is_on
    }

    /// True while a folder is followed, in which every capture is of another part.
    pub fn is_watching(&self) -> bool {
        self.is_live() && self.source.is_watched()
    }

    /// True while the operator's view replaces the bars, the rail and the panels of Inspect.
    pub fn is_operator_view(&self) -> bool {
        self.role == UserRole::Operator && self.workspace == WorkspaceKind::Inspect
    }

    /// True while a newer result than the one shown is on its way or awaited.
    pub fn is_old(&self) -> bool {
        let shown = self.shown.as_ref();
        shown.is_some_and(|shown| self.inspecting.is_some() || shown.is_outdated)
    }

    /// The latest inspection: what Live inspected behind another workspace, else the result in front if it is wanted.
    pub fn latest(&self, is_wanted: impl FnOnce(&Shown) -> bool) -> Option<&Arc<Inspected>> {
        let shown = self.shown.as_ref().filter(|shown| is_wanted(shown));
        let unseen = self.live.unseen.first();
        unseen.or_else(|| shown.map(|shown| &shown.inspected))
    }

    /// The latest inspection with the other parts of its frame.
    pub fn latest_parts(&self) -> &[Arc<Inspected>] {
        match (&self.live.unseen[..], &self.shown) {
            ([], Some(shown)) => &shown.parts,
            (unseen, _) => unseen,
        }
    }

    /// True if Live inspected the latest result and was switched off or has ended since: the line may have gone on, so another
    /// part may hang there now. Whoever looks at the result still may, so it is not outdated.
    fn is_after_live(&self) -> bool {
        let shown = self.shown.as_ref();
        let is_of_live = shown.is_some_and(|shown| shown.session.is_some());
        !self.is_live() && (is_of_live || !self.live.unseen.is_empty())
    }

    /// The latest result while its verdict counts: not while the part moves or is only looked at, nor for a past inspection,
    /// nor once it is outdated, nor that of Live once Live is off, nor while another inspection runs or after one has failed. In
    /// the history it is the newest one.
    pub(crate) fn current_result(&self) -> Option<&Inspected> {
        let inspected = &**self.latest(|_| true)?;
        let counts = match self.currency(inspected) {
            Some(Doubt::Moving | Doubt::SourceLost | Doubt::Superseded) => false,
            // However old it is, it is the newest one.
            _ => !inspected.is_open(),
        };
        // An empty cell that is followed is not recorded.
        let is_recorded = inspected.followed.is_none()
            || inspected.entry.record.summary.verdict != StoredVerdict::NoPart;
        (counts && is_recorded).then_some(inspected)
    }

    /// The robot frame of an inspection: from the scan itself, else from the calibration of the cell.
    pub fn robot_of<'a>(&'a self, inspected: &'a Inspected) -> Option<&'a Arc<RobotFrame>> {
        match &inspected.scan {
            Some(scan) => Some(&scan.robot),
            None => self.robot.as_ref(),
        }
    }

    /// File of the calibration in use, even while it is still being loaded; the user's own may not exist.
    pub fn calibration_path(&self) -> Option<PathBuf> {
        match &self.cell {
            RememberedCell::Usual => self.usual_cell.clone(),
            RememberedCell::Forgotten => None,
            RememberedCell::File(path) => Some(path.clone()),
        }
    }
}

/// The calibration that the window starts with.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RememberedCell {
    /// The user's own, if it exists.
    #[default]
    Usual,
    /// None, because the user discarded it.
    Forgotten,
    /// The one in this file.
    File(PathBuf),
}

/// What the inspector is working on.
#[derive(Clone, Debug)]
pub struct Inspecting {
    /// Description for the user.
    pub title: String,
    /// Purpose of the inspection.
    pub purpose: ReinspectionPurpose,
    /// True while it waits for a new file in a watched folder.
    pub is_waiting: bool,
}

/// Purpose of an inspection, returned with its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReinspectionPurpose {
    /// A new inspection.
    New,
    /// Repeats the inspection of the scene in front because something that it depends on has changed.
    Repeated,
    /// Repeats a past inspection.
    Past,
    /// Uses other shots of the scan that Inspect shows.
    Shots,
}

/// Where Capture takes a scene from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// The simulated cell.
    Cell(CellChoice),
    /// A file, read again at each capture.
    File(PathBuf),
    /// The shots of a scan, read again at each capture.
    Scan(ScanFiles),
    /// A camera, a recording, a watched folder, or a simulated cell with settings of its own.
    Camera(Box<SourceSpec>),
}

impl Source {
    /// The part of the source that can be followed; `None` for a single file or a scan.
    pub fn followed(&self) -> Option<SourceSpec> {
        match self {
            Self::Cell(choice) => Some(SourceSpec::Simulated(choice.followed())),
            Self::File(_) | Self::Scan(_) => None,
            Self::Camera(spec) => Some((**spec).clone()),
        }
    }

    /// True for a watched folder, which has no frame until a file is saved to it.
    pub fn is_watched(&self) -> bool {
        matches!(self, Self::Camera(spec) if matches!(**spec, SourceSpec::Watched(_)))
    }
}

impl Default for Source {
    fn default() -> Self {
        Self::Cell(CellChoice::default())
    }
}

/// The result in front, with its generation.
#[derive(Clone, Debug)]
pub struct Shown {
    /// A number that differs for each result, so that data derived from it can be matched.
    pub generation: u64,
    /// The result; of several parts in a frame, the selected one.
    pub inspected: Arc<Inspected>,
    /// All parts of the frame with that one, first those that are accepted.
    pub parts: Vec<Arc<Inspected>>,
    /// True if it comes from the history.
    pub is_past: bool,
    /// The session of following that it belongs to, if it is a frame of a followed source, also when that was inspected again.
    pub session: Option<u64>,
    /// True once the source was changed, lost, followed anew or captured from: another part may hang there now.
    pub is_outdated: bool,
}

impl Shown {
    /// A new result of one part.
    pub fn new(generation: u64, inspected: Arc<Inspected>) -> Self {
        Self::of_parts(generation, vec![inspected], 0)
    }

    /// A new result of the parts of a frame, of which one is selected.
    pub fn of_parts(generation: u64, parts: Vec<Arc<Inspected>>, selected: usize) -> Self {
        Self {
            generation,
            inspected: Arc::clone(&parts[selected]),
            parts,
            is_past: false,
            session: None,
            is_outdated: false,
        }
    }

    /// True if this is a part of its frame, selected or not.
    pub fn includes(&self, inspected: &Inspected) -> bool {
        let mut parts = self.parts.iter();
        parts.any(|part| ptr::eq(Arc::as_ptr(part), inspected))
    }

    /// Index of the selected part in the frame.
    pub fn selected(&self) -> usize {
        let place = self
            .parts
            .iter()
            .position(|part| Arc::ptr_eq(part, &self.inspected));
        place.unwrap_or_default()
    }
}

/// The workspaces that the rail lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WorkspaceKind {
    /// Which part hangs there, and whether it is accepted; for the operator.
    #[default]
    Inspect,
    /// Enrols new parts.
    Enrol,
    /// Shows why a scene was recognised as it was; for the engineer.
    Compare,
    /// Compares methods of pose estimation.
    Align,
    /// Spray paths over enrolled parts, and their film.
    Paint,
    /// Moves a robot by what the camera sees of a part.
    Servo,
    /// Past inspections.
    History,
}

impl WorkspaceKind {
    /// All workspaces, in the order of the rail and of the number keys.
    pub const ALL: [Self; 7] = [
        Self::Inspect,
        Self::Enrol,
        Self::Compare,
        Self::Align,
        Self::Paint,
        Self::Servo,
        Self::History,
    ];

    /// Returns the name shown to the user.
    pub fn title(self) -> String {
        match self {
            Self::Inspect => text!("shell-inspect"),
            Self::Enrol => text!("shell-enrol"),
            Self::Compare => text!("shell-compare"),
            Self::Align => text!("shell-align"),
            Self::Paint => text!("shell-paint"),
            Self::Servo => text!("shell-servo"),
            Self::History => text!("shell-history"),
        }
    }
}

/// A tab of Paint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PaintTab {
    /// The coat: gun, path and film as they are wanted.
    #[default]
    Coat,
    /// What gets paint, and corrections of the path by hand.
    Regions,
    /// The arm, and how much of the path it reaches.
    Robot,
    /// The simulated film.
    Film,
}

impl PaintTab {
    /// All tabs, in the order of their row.
    pub const ALL: [Self; 4] = [Self::Coat, Self::Regions, Self::Robot, Self::Film];
}

/// Role of the user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UserRole {
    /// Watches verdicts, captures and exports.
    Operator,
    /// May change everything.
    #[default]
    Engineer,
}

impl UserRole {
    /// Returns the name shown to the user.
    pub fn title(self) -> String {
        match self {
            Self::Operator => text!("shell-operator"),
            Self::Engineer => text!("shell-engineer"),
        }
    }
}

/// The local times of day at which shifts start; without any, a shift is a day.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Vec<String>", into = "Vec<String>")]
pub struct ShiftStarts(Vec<civil::Time>);

impl Default for ShiftStarts {
    fn default() -> Self {
        Self([6, 14, 22].map(|hour| civil::time(hour, 0, 0, 0)).into())
    }
}

impl TryFrom<Vec<String>> for ShiftStarts {
    type Error = String;

    fn try_from(written: Vec<String>) -> Result<Self, String> {
        let times = written.iter().map(|text| {
            civil::Time::strptime("%H:%M", text)
                .map_err(|_no_time| format!("\"{text}\" is no time of day such as 06:00"))
        });
        times.collect::<Result<_, _>>().map(Self)
    }
}

impl From<ShiftStarts> for Vec<String> {
    fn from(starts: ShiftStarts) -> Self {
        let times = starts.0.iter();
        times
            .map(|time| time.strftime("%H:%M").to_string())
            .collect()
    }
}

impl ShiftStarts {
    /// Returns start and end of the shift at this moment. A start that the clock skips (summer time) is delayed by the skipped
    /// time.
    pub fn around(&self, now: &Zoned) -> [Option<Zoned>; 2] {
        let midnight = [civil::Time::midnight()];
        let times = if self.0.is_empty() {
            &midnight[..]
        } else {
            &self.0
        };
        let today = now.date();
        let days = [today.yesterday().ok(), Some(today), today.tomorrow().ok()];
        let starts = days.into_iter().flatten().flat_map(|day| {
            let zone = now.time_zone();
            times
                .iter()
                .filter_map(move |time| day.to_datetime(*time).to_zoned(zone.clone()).ok())
        });
        let (past, coming): (Vec<Zoned>, Vec<Zoned>) = starts.partition(|start| start <= now);
        [past.into_iter().max(), coming.into_iter().min()]
    }
}

/// The parts of this shift.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShiftParts {
    /// Start of the shift; `None` until the parts were counted.
    pub since: Option<Zoned>,
    /// The source that they hung in front of; `None` while there was only a file or a scan. Known in both views.
    pub source: Option<Source>,
    /// Accepted parts, except those that were reported as wrong.
    pub num_ok: usize,
    /// All other parts that were judged.
    pub num_not_ok: usize,
    /// Parts that left before enough of their frames were inspected.
    pub num_not_judged: usize,
    /// The last parts, accepted or not, newest first.
    pub last: Vec<Summary>,
    /// True labels of the latest parts that have one; known in both views.
    pub labelled: Vec<(HungId, Truth)>,
    /// The parts that a trend will refuse, as far as they were inspected since the window was opened; known in both views.
    pub drifting: Vec<DriftingPart>,
}

/// A part that a trend will refuse.
#[derive(Clone, Debug, PartialEq)]
pub struct DriftingPart {
    /// Its name.
    pub part: String,
    /// Its title.
    pub title: String,
    /// When, and by which limit.
    pub warning: DriftWarning,
}

impl ShiftParts {
    /// Name in the history of the source that they hung in front of.
    pub fn source_name(&self) -> Option<String> {
        let followed = self.source.as_ref()?.followed()?;
        Some(followed.to_string())
    }

    /// What really hung there, if the part was accepted as another one and a person has reported that.
    pub fn reported_as(&self, inspected: &Inspected) -> Option<&Truth> {
        let (_, truth) = (self.labelled.iter()).find(|(part, _)| part == inspected.hung())?;
        let summary = Summary {
            label: Some(truth.clone()),
            ..inspected.entry.record.summary.clone()
        };
        summary.is_wrongly_accepted().then_some(truth)
    }
}

/// Returns the mark of a verdict that is not about what hangs there now: green only without doubts. `is_ok` is `None` where
/// no part was found or none was judged, because an empty cell is not a bad part.
pub fn verdict_mark(is_ok: Option<bool>, has_doubts: bool) -> Mark {
    match is_ok {
        None => Mark::Open,
        Some(false) => Mark::Bad,
        Some(true) if has_doubts => Mark::Look,
        Some(true) => Mark::Good,
    }
}

/// Returns the mark of an inspection in the history.
pub fn past_mark(past: &Summary) -> Mark {
    let is_verdict = past.verdict != StoredVerdict::NoPart && past.is_judged();
    let is_ok = is_verdict.then(|| past.is_ok());
    verdict_mark(is_ok, !past.noted.robot_doubts.is_empty())
}

impl Session {
    /// Why another part may hang before the source now, or this one elsewhere; `None` if it hangs there as captured.
    pub fn currency(&self, inspected: &Inspected) -> Option<Doubt> {
        let shown = self.shown.as_ref();
        let shown = shown.filter(|shown| shown.includes(inspected));
        let is_past = shown.is_some_and(|shown| shown.is_past);
        let status = self.live.status.as_ref().filter(|_| self.is_live());
        if !is_past && status.is_some_and(|status| matches!(status.source, SourceState::Lost(_))) {
            return Some(Doubt::SourceLost);
        }
        let mut unseen = self.live.unseen.iter();
        let is_newest = if self.live.unseen.is_empty() {
            shown.is_some()
        } else {
            unseen.any(|unseen| ptr::eq(Arc::as_ptr(unseen), inspected))
        };
        // The rack was changed since, or moved with another calibration.
        let is_of_other_rack =
            inspected.scan.is_none() && inspected.recipe.rack != *self.rack.in_camera();
        let is_left_behind = self.inspecting.is_some() || self.failed.is_some() || is_of_other_rack;
        if !is_newest
            || is_left_behind
            || shown.is_some_and(|shown| shown.is_past || shown.is_outdated)
        {
            return Some(Doubt::Superseded);
        }
        if !self.is_live() {
            return if self.is_after_live() {
                Some(Doubt::Superseded)
            } else {
                age_doubt(inspected.captured_at)
            };
        }
        match status {
            Some(status) if status.source == SourceState::Running && status.num_inspected > 0 => {
                // The status may be of a newer frame than the one in front.
                match status.stillness {
                    Some(MotionState::Moving | MotionState::Watching) => Some(Doubt::Moving),
                    _ if inspected.is_open() => Some(Doubt::Moving),
                    Some(MotionState::Steady { .. }) => None,
                    None => age_doubt(inspected.captured_at),
                }
            }
            _ => Some(Doubt::Superseded),
        }
    }

    /// What was inspected, as it stands now: with what a person reported since, and whether the part still hangs there.
    pub fn subject_now(&self, inspected: &Inspected) -> Subject {
        let reported_as = self.shift.reported_as(inspected).map(Truth::name);
        let is_of_other_order = self.is_of_other_order(inspected);
        let other_order = || is_of_other_order.then_some(Doubt::OtherOrder);
        Subject {
            currency: self.currency(inspected).or_else(other_order),
            reported_as: reported_as.map(str::to_owned),
            ..inspected.subject.clone()
        }
    }

    /// Why a robot must not act on a result, the reason to show first; empty if it may.
    pub fn robot_doubts(&self, inspected: &Inspected) -> Vec<Doubt> {
        let robot = self.robot_of(inspected).map(|robot| &**robot);
        let subject = self.subject_now(inspected);
        inspected.as_recorded(&subject, robot).doubts()
    }

    /// True if a robot may act on a result, and the part hangs there: only then it is shown in green.
    pub fn is_go(&self, inspected: &Inspected) -> bool {
        !inspected.subject.is_staged() && self.robot_doubts(inspected).is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use records::fixtures::history_entry;

    fn around(starts: &[&str], now: &str) -> [String; 2] {
        let starts: Vec<String> = starts.iter().map(|time| (*time).to_owned()).collect();
        let starts = ShiftStarts::try_from(starts).expect("times of day");
        let now: Zoned = now.parse().expect("a moment");
        starts.around(&now).map(|at| {
            let at = at.expect("a start").timestamp();
            at.to_string()
        })
    }

    #[test]
    fn a_shift_lasts_from_one_start_to_the_next() {
        let three = ["14:00", "22:00", "06:00"];
        let at = |time: &str| around(&three, &format!("2026-11-21T{time}+01:00[Europe/Berlin]"));
        let early = ["2026-11-21T05:00:00Z", "2026-11-21T13:00:00Z"];
        assert_eq!(at("06:00:00"), early);
        assert_eq!(at("13:59:59"), early);
        let late = ["2026-11-20T21:00:00Z", "2026-11-21T05:00:00Z"];
        assert_eq!(at("05:59:59"), late, "it began yesterday");
        assert_eq!(
            at("22:30:00"),
            ["2026-11-21T21:00:00Z", "2026-11-22T05:00:00Z"]
        );
        // Without starts, a shift is a day.
        let day = around(&[], "2026-11-21T15:00:00+01:00[Europe/Berlin]");
        assert_eq!(day, ["2026-11-20T23:00:00Z", "2026-11-21T23:00:00Z"]);
    }

    #[test]
    fn a_start_that_the_clock_skips_comes_later_that_day() {
        let night = around(&["02:30"], "2026-03-29T12:00:00+02:00[Europe/Berlin]");
        assert_eq!(night, ["2026-03-29T01:30:00Z", "2026-03-30T00:30:00Z"]);
    }

    #[test]
    fn starts_are_written_as_times_of_day() {
        let written: Vec<String> = ShiftStarts::default().into();
        assert_eq!(written, ["06:00", "14:00", "22:00"]);
        for bad in ["25:00", "noon", ""] {
            let refused = ShiftStarts::try_from(vec![bad.to_owned()]);
            assert!(refused.is_err_and(|why| why.contains("06:00")), "{bad}");
        }
    }

    #[test]
    fn a_past_inspection_is_green_only_if_it_was_accepted_without_doubts() {
        let past = |verdict, doubts: &[&str], label: Option<Truth>| {
            let mut past = history_entry(1, verdict, "fender").record.summary;
            past.noted.robot_doubts = doubts.iter().map(|kind| (*kind).to_owned()).collect();
            past.label = label;
            past_mark(&past)
        };
        let accepted = StoredVerdict::Accepted;
        assert_eq!(past(accepted, &[], None), Mark::Good);
        assert_eq!(past(accepted, &["old"], None), Mark::Look);
        let wrong = Some(Truth::NotEnrolled);
        assert_eq!(past(accepted, &["old"], wrong), Mark::Bad);
        assert_eq!(past(StoredVerdict::Rejected, &[], None), Mark::Bad);
        assert_eq!(past(StoredVerdict::NoPart, &[], None), Mark::Open);
    }
}
