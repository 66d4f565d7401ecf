//! State of the workspace: the fetched rows, the selected inspection, the last few inspections in memory.

use std::{
    cell::RefCell,
    collections::{BTreeMap, VecDeque},
    ops::Range,
    path::PathBuf,
    sync::Arc,
};

use super::{
    action::{HistoryAction, HistoryFile, HistoryJob},
    drift::Drift,
    filter::ListFilter,
    statistics::{self, Statistics, StatisticsView},
    work::{self, HistoryQuery, HistoryResult, OpenedInspection, RunsView, former_title},
};

use inspection::library::Truth;
use records::history::{Differences, HungId, Page, Retention, Summary, Usage, accepted_parts};
use shell::{
    file_dialog::FileDialog, inspection::inspected::Inspected, notice::Notice,
    workspace::ShellContext,
};
use ui::{
    language::text,
    task::{Task, TaskRunner},
    user_error::UserError,
};

/// Number of inspections kept whole in memory, about 15 MB each with points and pictures. Older ones are repeated.
const MAX_WHOLE: usize = 4;
/// Rows fetched beyond the visible ones, on either side.
const MARGIN: usize = 100;

/// State of the workspace.
#[derive(Debug)]
pub struct HistoryState {
    /// The filter of the list.
    pub filter: ListFilter,
    /// The fetched rows, and the number of all.
    pub page: Page,
    /// Index of the first fetched row in the list.
    pub first: usize,
    /// Number of the selected row and its index in the list, if it is not among the fetched rows.
    far_row: Option<(i64, usize)>,
    /// Names and titles of the parts in the history, once known.
    pub parts: Option<BTreeMap<String, String>>,
    /// The statistics shown in place of the list, if any.
    pub statistics: StatisticsView,
    /// The runs of servoing shown in place of the inspections, if they are.
    pub runs: Option<RunsView>,
    /// Number of all runs of servoing, as far as known.
    pub num_servo_runs: usize,
    /// The visible rows.
    pub(super) visible: Range<usize>,
    /// Number of the selected inspection.
    pub selected: Option<i64>,
    /// Whether the selection follows the newest inspection.
    selection: Selection,
    /// How often the program has selected the newest inspection; the list then shows that row.
    pub(super) num_reselected: u64,
    /// The part whose true label the operator set last, and its label before, until that is undone.
    pub(super) former_label: Option<(HungId, Option<Truth>)>,
    /// The selected inspection in full, once fetched.
    pub record: Option<Arc<OpenedInspection>>,
    /// The retention rule, and the space that kept frames take.
    pub kept: (Retention, Usage),
    /// The folder of the kept frames.
    pub(super) frames: Option<PathBuf>,
    /// Why the history cannot be written, while it cannot.
    pub problem: Option<UserError>,
    /// True once a person was told that the disk is too slow.
    pub(super) is_crowded: bool,
    /// The retention rule as edited, while its window is open.
    pub rule: Option<Retention>,
    /// Number of an inspection that was repeated, and its differences.
    pub differences: Option<(i64, Differences)>,
    /// Inspections queued for writing, by ticket.
    unwritten: BTreeMap<u64, Unwritten>,
    /// The part of the last inspection queued.
    last_hung: Option<HungId>,
    /// True if the selection is to move to the inspection that stands for the part.
    wants_part: bool,
    num_tickets: u64,
    /// Number of changes queued for writing.
    num_asked: usize,
    /// The newest inspections, whole.
    whole: VecDeque<(i64, Arc<Inspected>)>,
    /// True if the fetched rows may be out of date.
    pub(super) is_stale: bool,
    /// The inspection to repeat as soon as it is fetched.
    pub(super) then: Option<(i64, RemakeFor)>,
    /// The inspection being repeated.
    pub(super) remaking: Option<ReinspectionJob>,
    /// Jobs to hand to the writer thread.
    pub(super) jobs: Vec<HistoryJob>,
    /// The action to carry out once the engineer is in.
    pub(super) held: Option<HistoryAction>,
    pub(super) looking: Task<Box<HistoryResult>>,
    pub(super) counting: Task<Box<Statistics>>,
    pub(super) finding: Task<Box<RunsView>>,
    pub(super) exporting: Task<Notice>,
    pub(super) dialog: FileDialog<HistoryFile>,
}

/// Whether the selection follows the newest inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Selection {
    /// The newest inspection is selected, and the next one replaces it.
    Newest,
    /// The user chose the selected inspection: it stays selected.
    Chosen,
}

/// An inspection queued for writing.
#[derive(Debug)]
struct Unwritten {
    whole: Option<Arc<Inspected>>,
    /// False for another inspection of a part that is counted already.
    is_part: bool,
}

/// A past inspection being repeated.
#[derive(Clone, Debug)]
pub(super) struct ReinspectionJob {
    /// The past inspection.
    pub(super) past: Arc<OpenedInspection>,
    pub(super) purpose: RemakeFor,
}

/// Purpose of repeating a past inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RemakeFor {
    /// Open it; uses its own recipe.
    Open,
    /// Compare it; uses the recipe in use.
    Compare,
}

impl HistoryState {
    /// Creates the state before the first query.
    pub fn new(runner: &TaskRunner) -> Self {
        Self {
            filter: ListFilter::default(),
            page: Page::default(),
            first: 0,
            far_row: None,
            parts: None,
            statistics: StatisticsView::Closed,
            runs: None,
            num_servo_runs: 0,
            visible: 0..0,
            selected: None,
            selection: Selection::Newest,
            num_reselected: 0,
            former_label: None,
            record: None,
            kept: Default::default(),
            frames: None,
            problem: None,
            is_crowded: false,
            rule: None,
            differences: None,
            unwritten: BTreeMap::new(),
            last_hung: None,
            wants_part: false,
            num_tickets: 0,
            num_asked: 0,
            whole: VecDeque::new(),
            is_stale: false,
            then: None,
            remaking: None,
            jobs: Vec::new(),
            held: None,
            looking: Task::new("look", runner),
            counting: Task::new("statistics", runner),
            finding: Task::new("servo-runs", runner),
            exporting: Task::new("history-write", runner),
            dialog: FileDialog::default(),
        }
    }

    /// Number of all rows, as far as known.
    pub fn num_rows(&self) -> usize {
        self.page.num_all
    }

    /// Returns the row at this index of the list, if fetched.
    pub fn row(&self, index: usize) -> Option<&Summary> {
        self.page.rows.get(index.checked_sub(self.first)?)
    }

    /// Index of an inspection in the list, if its row is fetched.
    pub fn index_of(&self, number: i64) -> Option<usize> {
        let mut rows = self.page.rows.iter();
        Some(self.first + rows.position(|row| row.number == number)?)
    }

    /// Index of the selected row in the list, once known.
    pub(super) fn index_of_listed(&self) -> Option<usize> {
        let listed = self.listed()?;
        let far = self.far_row.filter(|(number, _)| *number == listed);
        self.index_of(listed).or(far.map(|(_, index)| index))
    }

    /// The inspection in full, if it is the one fetched last.
    pub(super) fn looked_at_as(&self, number: i64) -> Option<&Arc<OpenedInspection>> {
        let looked_at = self.record.as_ref()?;
        (looked_at.record.summary.number == number).then_some(looked_at)
    }

    /// The whole inspection, if kept in memory.
    pub fn whole(&self, number: i64) -> Option<&Arc<Inspected>> {
        let mut whole = self.whole.iter();
        whole.find(|(of, _)| *of == number).map(|(_, whole)| whole)
    }

    /// True once everything queued is written and the list shows it.
    pub fn is_settled(&self) -> bool {
        let is_written = self.unwritten.is_empty() && self.num_asked == 0;
        let is_at_work = self.looking.running().is_some()
            || self.counting.running().is_some()
            || self.finding.running().is_some()
            || self.exporting.running().is_some();
        is_written && !self.is_stale && !is_at_work
    }

    /// Issues a ticket for an inspection of this part that is queued for writing.
    pub(super) fn ticket(&mut self, hung: &HungId, whole: Option<&Arc<Inspected>>) -> u64 {
        self.num_tickets += 1;
        let ticket = self.num_tickets;
        let last = self.last_hung.replace(hung.clone());
        let is_part = last.as_ref() != Some(hung);
        let whole = whole.map(Arc::clone);
        self.unwritten.insert(ticket, Unwritten { whole, is_part });
        // Hold only the newest whole, however slow the disk.
        let old = ticket.checked_sub(MAX_WHOLE as u64);
        if let Some(old) = old.and_then(|old| self.unwritten.get_mut(&old)) {
            old.whole = None;
        }
        self.page.num_all += usize::from(is_part);
        self.is_stale = true;
        ticket
    }

    /// Takes in that an inspection was written.
    pub(super) fn added(&mut self, ticket: u64, number: i64) {
        if let Some(whole) = self.unwritten.remove(&ticket).and_then(|known| known.whole) {
            self.whole.push_front((number, whole));
            self.whole.truncate(MAX_WHOLE);
        }
        // Unless the user chose a row, select the new one, or its part if this is a re-inspection.
        if self.selection == Selection::Newest {
            self.selected = Some(number);
            self.wants_part = true;
        }
        self.is_stale = true;
    }

    /// Removes the oldest queued inspections, which were lost.
    pub(super) fn lost(&mut self, num: usize) {
        for _ in 0..num {
            self.unwritten.pop_first();
        }
        self.is_stale = true;
    }

    /// Applies new numbers to inspections that waited to be written.
    pub(super) fn renumber(&mut self, numbers: &[(i64, i64)]) {
        let now = |number: &mut i64| {
            if let Some((_, now)) = numbers.iter().find(|(before, _)| before == number) {
                *number = *now;
            }
        };
        self.whole.iter_mut().for_each(|(number, _)| now(number));
        self.selected.iter_mut().for_each(now);
        self.is_stale = true;
    }

    /// Queues a change, until it is written or fails.
    pub(super) fn queue(&mut self, change: HistoryJob) {
        self.num_asked += 1;
        self.jobs.push(change);
    }

    /// Counts a change as written or failed.
    pub(super) fn answered(&mut self) {
        self.num_asked = self.num_asked.saturating_sub(1);
        self.is_stale = true;
    }

    /// Records the visible rows; returns true if some are not fetched.
    pub(super) fn sees(&mut self, visible: Range<usize>) -> bool {
        let fetched = self.first..self.first + self.page.rows.len();
        let end = visible.end.min(self.page.num_matching);
        let has_all = fetched.contains(&visible.start) && end <= fetched.end;
        self.visible = visible;
        !has_all && end > self.visible.start
    }

    fn wanted(&self) -> HistoryQuery {
        let Range { start, end } = self.visible;
        HistoryQuery {
            filter: self.filter.clone(),
            rows: start.saturating_sub(MARGIN)..end + MARGIN,
            selected: self.selected,
            with_parts: self.parts.is_none(),
        }
    }

    pub(super) fn take(&mut self, looked: HistoryResult) {
        let HistoryResult {
            asked,
            page,
            far_row,
            record,
            is_listed,
            kept,
            frames,
            parts,
            num_servo_runs,
        } = looked;
        self.num_servo_runs = num_servo_runs;
        // The newest of the list is shown instead, unless the hidden one is about to be repeated.
        let is_hidden = !is_listed && self.selected == asked.selected && self.then.is_none();
        // Count those still being written.
        let unwritten = self.unwritten.values();
        let num_unwritten = unwritten.filter(|known| known.is_part).count();
        self.page = Page {
            num_all: page.num_all + num_unwritten,
            ..page
        };
        self.first = asked.rows.start;
        self.far_row = far_row;
        self.kept = kept;
        self.frames = frames;
        self.record = record.filter(|_| !is_hidden);
        self.parts = parts.or_else(|| self.parts.take());
        if let Some(known) = &mut self.parts {
            // Parts that were first inspected since.
            for part in self.page.rows.iter().filter_map(|row| row.part.as_ref()) {
                known.entry(part.clone()).or_insert_with(|| part.clone());
            }
        }
        if is_hidden {
            self.selection = Selection::Newest;
        }
        if self.selected.is_none() || is_hidden {
            self.selected = self.page.rows.first().map(|row| row.number);
        }
    }

    /// True if the user chose the selected inspection, which therefore stays selected.
    pub(super) fn is_chosen(&self) -> bool {
        self.selection == Selection::Chosen
    }

    /// Selects this inspection, as the user's choice.
    pub(super) fn selects(&mut self, number: i64) {
        self.selected = Some(number);
        self.selection = Selection::Chosen;
        self.wants_part = false;
    }

    /// Selects the newest inspection and has its row fetched, wherever the list is scrolled to.
    pub(super) fn select_newest(&mut self) {
        self.selected = None;
        self.selection = Selection::Newest;
        self.num_reselected += 1;
        self.visible = 0..self.visible.len();
    }

    /// Moves the selection to the inspection that stands for the part, where that is wanted.
    pub(super) fn look_at_part(&mut self) {
        let Some(past) = self.selected.and_then(|number| self.looked_at_as(number)) else {
            return;
        };
        let parent = past.record.summary.parent;
        if std::mem::take(&mut self.wants_part) && parent.is_some() {
            self.selected = parent;
        }
    }

    /// The selected row: for a part with several inspections, the one that stands for it.
    pub fn listed(&self) -> Option<i64> {
        let number = self.selected?;
        let past = self.looked_at_as(number);
        Some(
            past.and_then(|past| past.record.summary.parent)
                .unwrap_or(number),
        )
    }

    /// Fetches everything shown.
    pub(super) fn look(&mut self, cx: &ShellContext<'_>) {
        self.is_stale = false;
        let request = self.wanted();
        let keeper = Arc::clone(cx.services.library_cache.history());
        self.looking.start(text!("history-looking"), move |_| {
            let found = work::look(&request, &keeper);
            Ok(Box::new(found.map_err(|error| UserError::of(&error))?))
        });
        self.count(cx);
        self.look_at_run(None, cx);
    }

    /// Counts the parts that match the filter, while statistics are shown.
    fn count(&mut self, cx: &ShellContext<'_>) {
        if !self.statistics.is_open() {
            return;
        }
        let filter = self.filter.clone();
        let keeper = Arc::clone(cx.services.library_cache.history());
        let (starts, library) = (cx.session.shift_starts.clone(), cx.session.library.clone());
        let libraries = cx.services.library_cache.clone();
        let shift = &cx.session.shift;
        let (source, name) = (shift.source.clone(), shift.source_name());
        self.counting
            .start(text!("shell-counting-parts"), move |_| {
                let now = geometry::clock::zoned_now();
                let mut counted = filter.at(&now);
                let outcomes = work::outcomes(&mut counted, name, &keeper);
                let (outcomes, num_left_out) = outcomes.map_err(|error| UserError::of(&error))?;
                let former_titles = RefCell::new(BTreeMap::new());
                let title_of = |name: &str| {
                    let library = library.as_deref();
                    let library = library.filter(|library| library.index_of(name).is_some());
                    if let Some(library) = library {
                        return library.title_of(name).to_owned();
                    }
                    let mut titles = former_titles.borrow_mut();
                    let title = titles.entry(name.to_owned());
                    title.or_insert_with(|| former_title(&keeper, name)).clone()
                };
                let mut found = statistics::count(&outcomes, &starts, now.time_zone(), title_of);
                found.num_left_out = num_left_out;
                found.source = source.filter(|_| counted.source.is_some());
                let accepted = accepted_parts(&outcomes);
                let warnings = work::drift_warnings(&accepted, &counted, &keeper);
                let warnings = warnings.map_err(|error| UserError::of(&error))?.into_iter();
                found.warnings = warnings
                    .map(|(part, warning)| (title_of(&part), warning))
                    .collect();
                let most = accepted.first().map(|(part, _)| part);
                if let Some(part) = filter.part.as_ref().or(most) {
                    let drift = work::drift(part, counted, &keeper, &libraries.get().library);
                    let drift = drift.map_err(|error| UserError::of(&error))?;
                    found.drift =
                        drift.map(|drift| Drift::new(title_of(part), drift, now.time_zone()));
                }
                Ok(Box::new(found))
            });
    }

    /// Fetches everything shown, if it is out of date.
    pub(super) fn refresh_if_stale(&mut self, cx: &ShellContext<'_>) {
        if self.is_stale {
            self.look(cx);
        }
    }
}

#[cfg(test)]
mod tests;
