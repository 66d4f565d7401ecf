//! What the workspace knows: the rows in sight, the inspection that is looked at, the last few in memory.

use std::{
    collections::{BTreeMap, VecDeque},
    ops::Range,
    path::PathBuf,
    sync::Arc,
};

use super::{
    apply::{HistoryAction, HistoryFile, HistoryJob},
    drift::Drift,
    filter::ListFilter,
    statistics::{self, Statistics, StatisticsView, most_accepted},
    work::{self, HistoryQuery, HistoryResult, OpenedInspection},
};
use jiff::Zoned;

use crate::{
    app::{
        inspection::inspected::Inspected,
        language::text,
        shell::{context::ShellContext, file_dialog::FileDialog},
        task::{Task, TaskRunner},
        user_error::UserError,
    },
    history::{Differences, HungId, Page, Retention, Summary, Usage},
};

/// Inspections kept whole, with their points and pictures: about 15 MB each. Older ones are inspected again.
const MAX_WHOLE: usize = 4;
/// Rows asked for beyond those in sight, on either side.
const MARGIN: usize = 100;

/// What the workspace knows.
#[derive(Debug)]
pub struct HistoryState {
    /// What is listed.
    pub filter: ListFilter,
    /// The rows that were fetched, and how many there are.
    pub page: Page,
    /// The place of the first fetched row in the list.
    pub first: usize,
    /// Statistics in place of the list.
    pub statistics: StatisticsView,
    /// The rows in sight.
    visible: Range<usize>,
    /// The inspection that is looked at.
    pub selected: Option<i64>,
    /// The same in full, once fetched.
    pub record: Option<Arc<OpenedInspection>>,
    /// The rule by which frames are kept, and how much is.
    pub kept: (Retention, Usage),
    /// The folder of the kept frames.
    pub(super) frames: Option<PathBuf>,
    /// Why it is not written, as long as it is not.
    pub trouble: Option<UserError>,
    /// It was said that the disk is too slow.
    pub(super) is_crowded: bool,
    /// The rule as it is being changed, while its window is open.
    pub rule: Option<Retention>,
    /// What changed since an inspection, once it was inspected again: its number, and what.
    pub differences: Option<(i64, Differences)>,
    /// Inspections handed over to be written, by their ticket.
    unwritten: BTreeMap<u64, Unwritten>,
    /// The part that was handed over last.
    last_hung: Option<HungId>,
    /// The inspection that is looked at is to be the one that stands for its part.
    wants_part: bool,
    num_tickets: u64,
    /// Changes handed over to be written.
    num_asked: usize,
    /// The newest, whole.
    whole: VecDeque<(i64, Arc<Inspected>)>,
    /// Fetched rows may not be those that are there now.
    is_stale: bool,
    /// What is to be made again as soon as it was fetched.
    pub(super) then: Option<(i64, RemakeFor)>,
    /// An inspection that is being made again.
    pub(super) remaking: Option<ReinspectionJob>,
    /// What the thread that writes is asked for next.
    pub(super) jobs: Vec<HistoryJob>,
    /// What is done once the engineer is in.
    pub(super) held: Option<HistoryAction>,
    pub(super) looking: Task<Box<HistoryResult>>,
    pub(super) counting: Task<Box<Statistics>>,
    pub(super) exporting: Task<String>,
    pub(super) dialog: FileDialog<HistoryFile>,
}

/// An inspection that is handed over to be written.
#[derive(Debug)]
struct Unwritten {
    whole: Option<Arc<Inspected>>,
    /// False of one more of a part that is counted already.
    is_part: bool,
}

/// A past inspection that is being made again.
#[derive(Clone, Debug)]
pub(super) struct ReinspectionJob {
    /// As it was.
    pub(super) past: Arc<OpenedInspection>,
    /// What for.
    pub(super) purpose: RemakeFor,
}

/// What a past inspection is made again for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RemakeFor {
    /// To be opened, with its own recipe.
    Open,
    /// To see what changed, with today's recipe.
    Compare,
}

impl HistoryState {
    /// Before the first look.
    pub fn new(runner: &TaskRunner) -> Self {
        Self {
            filter: ListFilter::default(),
            page: Page::default(),
            first: 0,
            statistics: StatisticsView::Closed,
            visible: 0..0,
            selected: None,
            record: None,
            kept: Default::default(),
            frames: None,
            trouble: None,
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
            exporting: Task::new("history-write", runner),
            dialog: FileDialog::default(),
        }
    }

    /// True before the first inspection.
    pub fn is_empty(&self) -> bool {
        self.num_rows() == 0
    }

    /// How many there are, as far as it is known.
    pub fn num_rows(&self) -> usize {
        self.page.num_all
    }

    /// How many the filter lets through.
    pub fn num_matching(&self) -> usize {
        self.page.num_matching
    }

    /// The row at this place of the list, if it was fetched.
    pub fn row(&self, place: usize) -> Option<&Summary> {
        self.page.rows.get(place.checked_sub(self.first)?)
    }

    /// The place of an inspection in the list, if its row was fetched.
    pub fn place_of(&self, number: i64) -> Option<usize> {
        let mut rows = self.page.rows.iter();
        Some(self.first + rows.position(|row| row.number == number)?)
    }

    /// This inspection in full, if it is the one that was fetched last.
    pub(super) fn looked_at_as(&self, number: i64) -> Option<&Arc<OpenedInspection>> {
        let looked_at = self.record.as_ref()?;
        (looked_at.record.summary.number == number).then_some(looked_at)
    }

    /// All of an inspection, if it is kept in memory.
    pub fn whole(&self, number: i64) -> Option<&Arc<Inspected>> {
        let mut whole = self.whole.iter();
        whole.find(|(of, _)| *of == number).map(|(_, whole)| whole)
    }

    /// True once everything is written that was handed over, and the list shows it.
    pub fn is_settled(&self) -> bool {
        let is_written = self.unwritten.is_empty() && self.num_asked == 0;
        let is_at_work = self.looking.running().is_some()
            || self.counting.running().is_some()
            || self.exporting.running().is_some();
        is_written && !self.is_stale && !is_at_work
    }

    /// Takes a ticket for an inspection of this part that is handed over to be written.
    pub(super) fn ticket(&mut self, hung: &HungId, whole: Option<&Arc<Inspected>>) -> u64 {
        self.num_tickets += 1;
        let ticket = self.num_tickets;
        let last = self.last_hung.replace(hung.clone());
        let is_part = last.as_ref() != Some(hung);
        let whole = whole.map(Arc::clone);
        self.unwritten.insert(ticket, Unwritten { whole, is_part });
        // However slow the disk: only the newest are held whole.
        let old = ticket.checked_sub(MAX_WHOLE as u64);
        if let Some(old) = old.and_then(|old| self.unwritten.get_mut(&old)) {
            old.whole = None;
        }
        self.page.num_all += usize::from(is_part);
        self.is_stale = true;
        ticket
    }

    /// An inspection is in the list.
    pub(super) fn added(&mut self, ticket: u64, number: i64) {
        if let Some(whole) = self.unwritten.remove(&ticket).and_then(|known| known.whole) {
            self.whole.push_front((number, whole));
            self.whole.truncate(MAX_WHOLE);
        }
        // Who looks at the newest goes on looking at the newest: the part, if this is one more of it.
        let newest = self.row(0).map(|row| row.number);
        if self.selected.is_none() || self.selected == newest {
            self.selected = Some(number);
            self.wants_part = true;
        }
        self.is_stale = true;
    }

    /// The oldest of those that were handed over were too many, and are lost.
    pub(super) fn lost(&mut self, num: usize) {
        for _ in 0..num {
            self.unwritten.pop_first();
        }
        self.is_stale = true;
    }

    /// Those that waited have other numbers now.
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

    /// A change is handed over to be written.
    pub(super) fn asked(&mut self) {
        self.num_asked += 1;
    }

    /// A change was written, or could not be.
    pub(super) fn answered(&mut self) {
        self.num_asked = self.num_asked.saturating_sub(1);
        self.is_stale = true;
    }

    pub(super) fn stale(&mut self) {
        self.is_stale = true;
    }

    /// True if it is not known that these rows are in sight.
    pub(super) fn is_news(&self, visible: &Range<usize>) -> bool {
        self.visible != *visible
    }

    /// Takes note of the rows in sight; true if some were not fetched.
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
        }
    }

    pub(super) fn take(&mut self, looked: HistoryResult) {
        let HistoryResult {
            asked,
            page,
            record,
            kept,
            frames,
        } = looked;
        // Those that are on their way are counted already.
        let unwritten = self.unwritten.values();
        let num_unwritten = unwritten.filter(|known| known.is_part).count();
        self.page = Page {
            num_all: page.num_all + num_unwritten,
            ..page
        };
        self.first = asked.rows.start;
        self.kept = kept;
        self.frames = frames;
        self.record = record;
        if self.selected.is_none() {
            self.selected = self.page.rows.first().map(|row| row.number);
        }
    }

    /// A person looks at this inspection.
    pub(super) fn selects(&mut self, number: i64) {
        self.selected = Some(number);
        self.wants_part = false;
    }

    /// A person will look for the newest inspection: its row is fetched, wherever the list was scrolled to.
    pub(super) fn select_newest(&mut self) {
        self.selected = None;
        self.visible = 0..self.visible.len();
    }

    /// Goes on to the inspection that stands for the part, where that is wanted.
    pub(super) fn look_at_part(&mut self) {
        let Some(past) = self.selected.and_then(|number| self.looked_at_as(number)) else {
            return;
        };
        let parent = past.record.summary.parent;
        if std::mem::take(&mut self.wants_part) && parent.is_some() {
            self.selected = parent;
        }
    }

    /// The row of the list that is looked at: of a part that was inspected more than once the one that stands for it.
    pub fn listed(&self) -> Option<i64> {
        let number = self.selected?;
        let past = self.looked_at_as(number);
        Some(
            past.and_then(|past| past.record.summary.parent)
                .unwrap_or(number),
        )
    }

    /// Has everything fetched that is shown.
    pub(super) fn look(&mut self, cx: &ShellContext<'_>) {
        self.is_stale = false;
        let request = self.wanted();
        let keeper = Arc::clone(cx.services.library_cache.history());
        self.looking.start(text!("history-looking"), move |_| {
            Ok(Box::new(work::look(&request, &keeper)?))
        });
        self.count(cx);
    }

    /// Counts the parts that the filter lets through, while that is shown.
    fn count(&mut self, cx: &ShellContext<'_>) {
        if !self.statistics.is_open() {
            return;
        }
        let filter = self.filter.clone();
        let keeper = Arc::clone(cx.services.library_cache.history());
        let (starts, library) = (cx.session.shift_starts.clone(), cx.session.library.clone());
        let libraries = cx.services.library_cache.clone();
        self.counting
            .start(text!("history-counting-parts"), move |_| {
                let now = Zoned::now();
                let outcomes = keeper.outcomes(&filter.at(&now));
                let outcomes = outcomes.map_err(|error| UserError::of(&error))?;
                let title_of = |name: &str| match &library {
                    Some(library) => library.title_of(name).to_owned(),
                    None => name.to_owned(),
                };
                let mut found = statistics::count(&outcomes, &starts, now.time_zone(), title_of);
                let part = filter.part.clone().or_else(|| most_accepted(&outcomes));
                if let Some(part) = part {
                    let mut of_part = filter.at(&now);
                    of_part.part = Some(part.clone());
                    let poses = keeper.poses(&of_part);
                    let poses = poses.map_err(|error| UserError::of(&error))?;
                    let loaded = libraries.get();
                    let middle_of = |name: &str| {
                        let mut references = loaded.library.references.iter();
                        references.find(|of| of.enrolled_as == name)?.middle()
                    };
                    found.drift = Drift::new(title_of(&part), &poses, now.time_zone(), middle_of);
                }
                Ok(Box::new(found))
            });
    }

    /// The same, if it is not up to date.
    pub(super) fn refresh_if_stale(&mut self, cx: &ShellContext<'_>) {
        if self.is_stale {
            self.look(cx);
        }
    }
}

#[cfg(test)]
mod tests;
