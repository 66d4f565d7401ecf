//! The parts of this shift, counted in the history for the operator's view. The history's statistics count the same.
//!
//! They are the parts of the source that the window follows, or followed before a file or a scan was opened. Opened files and
//! scans, single frames of the simulated cell and captures taken in Enrol have other sources in the history.

use std::{cmp::Reverse, sync::Arc, time::Duration};

use jiff::{Timestamp, Zoned};

use crate::session::{DriftingPart, Session, ShiftParts, Source, UserRole};
use geometry::error::lock;
use records::history::{Filter, HistoryBuffer, HistoryError, HungId, PartOutcome, StoredVerdict};
use ui::{
    language::text,
    task::{Task, TaskRunner},
    user_error::UserError,
};

/// Seconds after which a failed count is repeated.
const RETRY_DELAY_S: f64 = 10.0;
/// Maximum number of parts listed.
const MAX_LISTED: usize = 12;
/// Number of the newest accepted parts, of any source, among which the last one of this source is looked for.
const MAX_ASKED: usize = 50;

/// What a count depends on.
#[derive(Debug, PartialEq)]
struct CountInputs {
    /// Revision of the history.
    num_events: u64,
    since: Timestamp,
    source: Option<Source>,
    latest: Vec<HungId>,
    role: UserRole,
}

/// Counts the parts whenever the history has changed.
#[derive(Debug)]
pub struct ShiftWatch {
    counting: Task<ShiftParts>,
    /// The inputs of the last count.
    counted: Option<CountInputs>,
    /// The source in use, or the one before, if that in use is a file or a scan.
    source: Option<Source>,
    /// When to repeat a failed count, seconds of egui's clock.
    retry_at: Option<f64>,
}

impl ShiftWatch {
    /// Makes a watch that has counted nothing yet.
    pub fn new(runner: &TaskRunner) -> Self {
        Self {
            counting: Task::new("shift", runner),
            counted: None,
            source: None,
            retry_at: None,
        }
    }

    /// True while nothing is being counted.
    pub fn is_idle(&self) -> bool {
        self.counting.running().is_none()
    }

    /// Takes over a finished count, and counts again if it is outdated. In the engineer's view only the true label of the latest part
    /// is looked up.
    pub fn update(
        &mut self,
        session: &mut Session,
        history: &Arc<HistoryBuffer>,
        ctx: &egui::Context,
    ) {
        let time = ctx.input(|input| input.time);
        match self.counting.poll() {
            Some(Ok(parts)) => {
                let counted = self.counted.as_ref();
                for part in counted.map_or(&[][..], |counted| &counted.latest) {
                    let label = parts.labelled.iter().find(|(known, _)| known == part);
                    // Whoever answers robots does not wait for the history.
                    lock(&session.live.parts).label(part, label.map(|(_, label)| label));
                }
                session.shift = parts;
            }
            // The History workspace reports why the history cannot be read.
            Some(Err(_)) => self.retry_at = Some(time + RETRY_DELAY_S),
            None => {}
        }
        if session.source.followed().is_some() {
            self.source = Some(session.source.clone());
        }
        let now = geometry::clock::zoned_now();
        let [Some(since), end] = session.shift_starts.around(&now) else {
            return;
        };
        if let Some(left) = end.and_then(|end| Duration::try_from(now.duration_until(&end)).ok()) {
            ctx.request_repaint_after(left + Duration::from_secs(1));
        }
        if let Some(at) = self.retry_at {
            ctx.request_repaint_after_secs((at - time).max(0.0) as f32);
        }
        let is_retry = self.retry_at.is_some_and(|at| at <= time);
        let source = self.source.clone();
        let role = session.role;
        let latest = session.latest_parts().iter();
        let latest: Vec<HungId> = latest.map(|part| part.hung().clone()).collect();
        let wanted = Some(CountInputs {
            num_events: history.num_events(),
            since: since.timestamp(),
            source: source.clone(),
            latest: latest.clone(),
            role,
        });
        if is_retry || self.counted != wanted {
            self.counted = wanted;
            self.retry_at = None;
            let history = Arc::clone(history);
            let former = session.shift.clone();
            let known = if former.source == source {
                former.drifting.clone()
            } else {
                Vec::new()
            };
            let count = move |_: &_| {
                let labelled = latest.iter().filter_map(|hung| {
                    let row = history.part(hung).transpose()?;
                    let label = row.map(|row| Some((hung.clone(), row.label?)));
                    label.transpose()
                });
                let labelled: Result<Vec<_>, HistoryError> = labelled.collect();
                let parts = if role == UserRole::Operator {
                    let none = ShiftParts {
                        source,
                        ..ShiftParts::default()
                    };
                    count(&history, since, none)
                } else if former.source == source {
                    Ok(former)
                } else {
                    Ok(ShiftParts {
                        source,
                        ..ShiftParts::default()
                    })
                };
                let parts = parts.and_then(|parts| {
                    Ok(ShiftParts {
                        labelled: labelled?,
                        drifting: drifting(&history, parts.source_name(), known)?,
                        ..parts
                    })
                });
                parts.map_err(|error| UserError::of(&error).into())
            };
            self.counting.start(text!("shell-counting-parts"), count);
        }
    }
}

/// Counts the parts of the source of `none` since a moment: all inspections of a hung part are one part, and an empty cell is
/// none.
fn count(
    history: &HistoryBuffer,
    since: Zoned,
    none: ShiftParts,
) -> Result<ShiftParts, HistoryError> {
    let all = Filter {
        since: Some(since.timestamp()),
        source: Some(none.source_name().unwrap_or_default()),
        ..Filter::default()
    };
    let mut outcomes = history.outcomes(&all)?;
    outcomes.retain(|part| part.verdict != StoredVerdict::NoPart);
    let num_parts = outcomes.len();
    outcomes.retain(PartOutcome::is_judged);
    let num_ok = outcomes.iter().filter(|part| part.is_ok).count();
    let mut last = Vec::new();
    for verdict in StoredVerdict::ALL {
        if verdict != StoredVerdict::NoPart {
            let filter = Filter {
                verdict: Some(verdict.into()),
                ..all.clone()
            };
            last.extend(history.newest(&filter, MAX_LISTED)?);
        }
    }
    last.sort_by_key(|row| Reverse(row.at));
    last.truncate(MAX_LISTED);
    Ok(ShiftParts {
        since: Some(since),
        num_ok,
        num_not_ok: outcomes.len() - num_ok,
        num_not_judged: num_parts - outcomes.len(),
        last,
        ..none
    })
}

/// The parts that a trend will refuse: those known before, with what is now known of the part accepted last.
fn drifting(
    history: &HistoryBuffer,
    source: Option<String>,
    mut known: Vec<DriftingPart>,
) -> Result<Vec<DriftingPart>, HistoryError> {
    let Some(source) = source else {
        return Ok(known);
    };
    let accepted = Filter {
        verdict: Some(StoredVerdict::Accepted.into()),
        ..Filter::default()
    };
    // The source is not in the index: of a long history, all rows would be read for one that another source has made.
    let mut newest = history.newest(&accepted, MAX_ASKED)?.into_iter();
    let newest = newest.find(|row| row.source == source);
    let Some((part, title)) = newest.and_then(|row| Some((row.part?, row.title))) else {
        return Ok(known);
    };
    known.retain(|of| of.part != part);
    let of_part = Filter {
        part: Some(part.clone()),
        source: Some(source),
        ..accepted
    };
    let warning = history.drift_warning(&of_part)?;
    known.extend(warning.map(|warning| DriftingPart {
        part,
        title,
        warning,
    }));
    Ok(known)
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::{
        inspection::{inspected::inspected_cell, source::CellChoice},
        session::{Shown, past_mark},
        state::State,
    };
    use capture::fixtures::moment;
    use inspection::{library::Truth, pipeline::RefusalKind};
    use records::fixtures::history_entry;
    use ui::widgets::Mark;

    #[test]
    fn a_part_that_was_reported_as_wrong_is_not_ok_and_both_views_know_it() {
        for role in [UserRole::Operator, UserRole::Engineer] {
            let mut state = State::default();
            state.session.role = role;
            let (history, ctx) = (Arc::new(HistoryBuffer::new(None)), egui::Context::default());
            let inspected = Arc::new(inspected_cell(CellChoice::InTurn, 1));
            let followed = state.session.source.followed().expect("the cell");
            let mut entry = inspected.entry.clone();
            entry.record.summary.source = followed.to_string();
            history.add(1, entry, Instant::now());
            history.set_label(-1, Some(&Truth::NotEnrolled));
            state.session.shown = Some(Shown::new(1, Arc::clone(&inspected)));
            state.shift_watch.update(&mut state.session, &history, &ctx);
            assert!(state.shift_watch.counting.run_waiting());
            state.shift_watch.update(&mut state.session, &history, &ctx);
            let shift = &state.session.shift;
            assert_eq!(shift.reported_as(&inspected), Some(&Truth::NotEnrolled));
            let num = usize::from(role == UserRole::Operator);
            assert_eq!((shift.num_ok, shift.num_not_ok), (0, num), "{role:?}");

            // So does whoever answers robots.
            let name = inspected.entry.record.summary.part.as_deref();
            let is_reported = |state: &State| {
                let parts = lock(&state.session.live.parts);
                parts
                    .reported_as(inspected.hung(), name.expect("a part"))
                    .is_some()
            };
            assert!(is_reported(&state));
            history.set_label(-1, None);
            state.shift_watch.update(&mut state.session, &history, &ctx);
            assert!(state.shift_watch.counting.run_waiting());
            state.shift_watch.update(&mut state.session, &history, &ctx);
            assert!(!is_reported(&state));
        }
    }

    #[test]
    fn only_parts_of_the_source_that_is_followed_are_counted() {
        let history = HistoryBuffer::new(None);
        // The last three: a start of the window, an opened file and a scene that was enrolled.
        let sources = [
            "kinect",
            "kinect",
            "simulated cell",
            "/data/door.pcd",
            "Kinect frame 12",
        ];
        for (seconds, source) in (1..).zip(sources) {
            let mut entry = history_entry(seconds, StoredVerdict::Accepted, "fender");
            entry.record.summary.source = source.into();
            history.add(seconds as u64, entry, Instant::now());
        }
        let counted = |source| {
            let since = moment(0).to_zoned(jiff::tz::TimeZone::UTC);
            let none = ShiftParts {
                source,
                ..ShiftParts::default()
            };
            let parts = count(&history, since, none).expect("counted");
            assert_eq!(parts.last.len(), parts.num_ok);
            parts.num_ok
        };
        let kinect = Source::Camera(Box::new("kinect".parse().expect("a source")));
        let sources = [Some(kinect), Some(Source::default()), None];
        assert_eq!(sources.map(counted), [2, 0, 0]);
    }

    #[test]
    fn a_part_that_drifts_is_known_until_it_is_inspected_without_a_trend() {
        let history = HistoryBuffer::new(None);
        let add = |seconds: u8, part, log_odds: f64| {
            let mut entry = history_entry(seconds.into(), StoredVerdict::Accepted, part);
            entry.record.summary.score = Some([1.0 / (1.0 + (-log_odds).exp()), 0.8]);
            history.add(seconds.into(), entry, Instant::now());
        };
        let known = |known| {
            let found = drifting(&history, Some("simulated".into()), known).expect("asked");
            let parts = found.iter().map(|of| of.part.as_str());
            (parts.collect::<Vec<_>>().join(" "), found)
        };
        for seconds in 0..60 {
            add(seconds, "fender", 4.0 - 0.02 * f64::from(seconds));
        }
        let (parts, found) = known(Vec::new());
        assert_eq!(parts, "fender");
        add(60, "grille", 4.0);
        assert_eq!(known(found.clone()).0, "fender");
        // The cause was found.
        for seconds in 61..121 {
            add(seconds, "fender", 4.0);
        }
        assert_eq!(known(found).0, "");
    }

    #[test]
    fn a_part_that_a_slow_computer_did_not_judge_is_neither_ok_nor_not_ok() {
        let history = HistoryBuffer::new(None);
        for (seconds, reason) in (1..).zip(["low_score", "too_slow", "few_frames"]) {
            let mut entry = history_entry(seconds, StoredVerdict::Rejected, "fender");
            entry.record.summary.source = "kinect".into();
            entry.record.summary.reason = Some(RefusalKind::named(reason));
            history.add(seconds as u64, entry, Instant::now());
        }
        let none = ShiftParts {
            source: Some(Source::Camera(Box::new(
                "kinect".parse().expect("a source"),
            ))),
            ..ShiftParts::default()
        };
        let since = moment(0).to_zoned(jiff::tz::TimeZone::UTC);
        let shift = count(&history, since, none).expect("counted");
        let counts = [shift.num_ok, shift.num_not_ok, shift.num_not_judged];
        assert_eq!(counts, [0, 1, 2]);
        let marks = shift.last.iter().map(past_mark);
        assert_eq!(
            marks.collect::<Vec<_>>(),
            [Mark::Open, Mark::Open, Mark::Bad]
        );
    }

    #[test]
    fn an_opened_file_does_not_change_what_is_counted_and_the_source_is_named() {
        let mut state = State::default();
        state.session.role = UserRole::Operator;
        let (history, ctx) = (Arc::new(HistoryBuffer::new(None)), egui::Context::default());
        let mut entry = history_entry(1, StoredVerdict::Accepted, "fender");
        entry.record.summary.at = geometry::clock::now();
        history.add(1, entry, Instant::now());
        let cell = state.session.source.clone();
        for source in [cell.clone(), Source::File("/data/door.pcd".into())] {
            state.session.source = source;
            state.shift_watch.update(&mut state.session, &history, &ctx);
            state.shift_watch.counting.run_waiting();
            state.shift_watch.update(&mut state.session, &history, &ctx);
            let shift = &state.session.shift;
            assert_eq!((shift.num_ok, shift.source.as_ref()), (1, Some(&cell)));
        }
    }

    #[test]
    fn a_failed_count_is_repeated_after_a_while() {
        let mut state = State::default();
        state.session.role = UserRole::Operator;
        let (history, ctx) = (Arc::new(HistoryBuffer::new(None)), egui::Context::default());
        state.shift_watch.update(&mut state.session, &history, &ctx);
        let counting = &mut state.shift_watch.counting;
        assert!(counting.running().is_some());
        let failed = UserError {
            what: "the history cannot be read".into(),
            advice: String::new(),
        };
        counting.start("fails", move |_| Err(failed.into()));
        assert!(counting.run_waiting());
        for _ in 0..2 {
            state.shift_watch.update(&mut state.session, &history, &ctx);
            assert!(state.shift_watch.is_idle(), "not in every frame");
        }
        ctx.input_mut(|input| input.time += RETRY_DELAY_S);
        state.shift_watch.update(&mut state.session, &history, &ctx);
        assert!(state.shift_watch.counting.run_waiting());
        state.shift_watch.update(&mut state.session, &history, &ctx);
        assert!(state.session.shift.since.is_some());
    }
}
