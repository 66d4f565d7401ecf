//! What the workspace's thread does: prepares a pair and runs the methods, one after the other.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use super::{
    pair::{Pair, PairSource},
    start::Start,
    table::{TableCell, TableRow},
    track::MethodRun,
};
use crate::{
    app::{
        job::{Answer, Outcome, Trouble},
        shelf::Shelf,
        worker::Desk,
    },
    stages::pose::PoseMethod,
};

/// What the workspace asks for.
#[derive(Clone, Debug)]
pub enum AlignRequest {
    /// Align a pair by every method.
    Pair(PairSource),
    /// Work out Table I.
    Table {
        /// Rows that are there already: name of the part and start.
        done: Vec<(String, usize)>,
    },
}

/// What comes back.
#[derive(Clone, Debug)]
pub enum AlignAnswer {
    /// The pair is ready; the methods follow.
    Prepared(Arc<Pair>),
    /// A method has run.
    Ran(Arc<MethodRun>),
    /// A row of Table I.
    Row {
        /// The row.
        row: Arc<TableRow>,
        /// Since the request's first row was begun.
        elapsed: Duration,
    },
    /// Everything asked for was handed over.
    Finished,
}

/// Does what is asked; `None` when cancelled.
pub(in crate::app) fn answer(
    request: AlignRequest,
    shelf: &Shelf,
    desk: &dyn Desk<Outcome>,
) -> Option<Outcome> {
    let answered = match request {
        AlignRequest::Pair(source) => pair(&source, shelf, desk),
        AlignRequest::Table { done } => table(&done, shelf, desk),
    };
    match answered {
        Ok(answer) => answer.map(|answer| Ok(Answer::Align(answer))),
        Err(trouble) => Some(Err(trouble)),
    }
}

fn pair(
    source: &PairSource,
    shelf: &Shelf,
    desk: &dyn Desk<Outcome>,
) -> Result<Option<AlignAnswer>, Trouble> {
    let pair = Arc::new(Pair::of(source, shelf)?);
    hand_over(desk, AlignAnswer::Prepared(Arc::clone(&pair)));
    for (place, method) in PoseMethod::ALL.into_iter().enumerate() {
        desk.progress(place, PoseMethod::ALL.len());
        if desk.is_cancelled() {
            return Ok(None);
        }
        let run = MethodRun::of(method, &pair, &|| desk.is_cancelled());
        if desk.is_cancelled() {
            return Ok(None);
        }
        hand_over(desk, AlignAnswer::Ran(Arc::new(run)));
    }
    Ok(Some(AlignAnswer::Finished))
}

fn table(
    done: &[(String, usize)],
    shelf: &Shelf,
    desk: &dyn Desk<Outcome>,
) -> Result<Option<AlignAnswer>, Trouble> {
    let shelved = shelf.get().map_err(|error| Trouble::of(&error))?;
    let references = &shelved.library.references;
    let total = references.len() * Start::NUM_PAPER;
    let clock = Instant::now();
    let mut num_done = done.len();
    desk.progress(num_done, total);
    for (place, reference) in references.iter().enumerate() {
        let title = shelved.shown.title(place);
        for start in 0..Start::NUM_PAPER {
            let is_done = |(part, of): &(String, usize)| *part == reference.name && *of == start;
            if done.iter().any(is_done) {
                continue;
            }
            let pair = Pair::moved_copy(reference, title, Start::Paper(start));
            let mut cells = Vec::new();
            for method in PoseMethod::ALL {
                if desk.is_cancelled() {
                    return Ok(None);
                }
                cells.push(TableCell::of(method, &pair, &|| desk.is_cancelled()));
            }
            if desk.is_cancelled() {
                return Ok(None);
            }
            let row = TableRow {
                part: reference.name.clone(),
                title: title.to_owned(),
                start,
                cells,
            };
            num_done += 1;
            let (row, elapsed) = (Arc::new(row), clock.elapsed());
            hand_over(desk, AlignAnswer::Row { row, elapsed });
            desk.progress(num_done, total);
        }
    }
    Ok(Some(AlignAnswer::Finished))
}

fn hand_over(desk: &dyn Desk<Outcome>, answer: AlignAnswer) {
    desk.partly(Ok(Answer::Align(answer)));
}
