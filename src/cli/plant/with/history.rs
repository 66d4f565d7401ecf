//! `partsight history send`, and `list`, `show`, `export` and `drift` over the cells of a plant.

use std::collections::{BTreeMap, VecDeque};

use clap::{Args, Subcommand};

use super::database::{DatabaseFiles, parse_cell};
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, advised_error},
    history::{
        CellRow, Command, ExportArgs, ListArgs, ShowArgs,
        drift::{self, DriftArgs, PartPoses},
        here, note_counts,
        show::{ReadFrom, card, record_line},
        show_rows,
    },
};
use plant::database::{BATCH, CellHistory, CellName, Database, DatabaseError, TransferError};
use records::history::{
    History, HistoryError, MAX_POSES, PoseRecord, Record, StoredVerdict, write_cells_table,
};

/// Which database is read instead of the history here.
#[derive(Debug, Args)]
pub(crate) struct FromChoice {
    /// Inspections of all cells that send their histories to this PostgreSQL database, instead of the history here
    #[arg(long, value_name = "postgres://USER@HOST[:PORT]/DATABASE")]
    from: Option<String>,
    /// With --from: only inspections of this cell
    #[arg(long, value_name = "NAME", requires = "from", value_parser = parse_cell)]
    cell: Option<CellName>,
    #[command(flatten)]
    files: DatabaseFiles,
}

impl FromChoice {
    /// Opens the database, if one is to be read.
    fn database(&self, console: &Console) -> anyhow::Result<Option<Database>> {
        let Some(address) = &self.from else {
            self.files.refuse_without("--from")?;
            return Ok(None);
        };
        let access = self.files.access(address, console)?;
        Ok(Some(Database::open_to_read(&access).advised()?))
    }
}

/// Subcommands of `history`.
#[derive(Debug, Subcommand)]
pub(crate) enum HistoryCommand {
    /// Send the plant's PostgreSQL database the inspections that it does not have yet
    Send(SendArgs),
}

#[derive(Debug, Args)]
pub(crate) struct SendArgs {
    /// The PostgreSQL database
    #[arg(long, value_name = "postgres://USER@HOST[:PORT]/DATABASE")]
    to: String,
    /// The name of this cell there
    #[arg(long, value_name = "NAME", value_parser = parse_cell)]
    cell: CellName,
    #[command(flatten)]
    files: DatabaseFiles,
    /// Take over the cell's name from another history whose computer or disk is gone; what that history sent stays
    #[arg(long)]
    take_over: bool,
    /// Send every inspection again: the database is a new one, or was restored from a backup
    #[arg(long)]
    all: bool,
}

/// Runs the subcommand.
pub(crate) fn run(
    HistoryCommand::Send(asked): &HistoryCommand,
    history: &mut History,
    console: &Console,
) -> anyhow::Result<Outcome> {
    let access = asked.files.access(&asked.to, console)?;
    let whose = CellHistory {
        cell: asked.cell.clone(),
        history: history.note_changes().advised()?,
    };
    let mut database = Database::open(&access).advised()?;
    if asked.take_over {
        database.take_over(&whose).advised()?;
    }
    if asked.all {
        history.note_all().advised()?;
    }
    let mut num = 0;
    loop {
        let sent = database.send(&whose, || Ok(history.unsent(BATCH)?));
        let rows = sent.advised()?;
        history.note_sent(&rows).advised()?;
        num += rows.num();
        if rows.num() < BATCH {
            break;
        }
    }
    console.note(&format_args!(
        "{num} inspections sent to {} as {}",
        access.address, asked.cell
    ));
    Ok(Outcome::Accepted)
}

/// Runs `list`, `show`, `export` or `drift` on a database; returns `None` if they are to use the local history.
pub(crate) fn overview(
    command: &Command,
    console: &mut Console,
) -> anyhow::Result<Option<Outcome>> {
    match command {
        Command::List(asked) => match asked.from.database(console)? {
            Some(database) => list(&database, asked, console).map(Some),
            None => Ok(None),
        },
        Command::Show(asked) => match asked.from.database(console)? {
            Some(database) => show(&database, asked, console).map(Some),
            None => Ok(None),
        },
        Command::Export(asked) => match asked.from.database(console)? {
            Some(database) => export(&database, asked, console).map(Some),
            None => Ok(None),
        },
        Command::Drift(asked) => match asked.from.database(console)? {
            Some(database) => drift(&database, asked, console).map(Some),
            None => Ok(None),
        },
        _ => Ok(None),
    }
}

fn list(database: &Database, asked: &ListArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let filter = asked.filter.filter();
    let page = database.page(&filter, asked.from.cell.as_ref(), asked.most());
    let page = page.advised()?;
    let rows = page.rows.iter();
    let rows: Vec<CellRow<'_>> = rows.map(|(cell, row)| (Some(cell.as_str()), row)).collect();
    show_rows(&rows, asked, console);
    if asked.json {
        return Ok(Outcome::Accepted);
    }
    let num_matching = page.cells.iter().map(|count| count.num_matching).sum();
    note_counts(&rows, [num_matching, page.num_all], asked, console);
    for count in &page.cells {
        console.note(&format_args!(
            "  {}: {}, {} of them accepted; last sent at {}",
            count.cell,
            count.num_matching,
            count.num_accepted,
            here(count.sent)
        ));
    }
    Ok(Outcome::Accepted)
}

/// Shows the inspections with this number: those of several cells may have the same.
fn show(database: &Database, asked: &ShowArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let number = asked.number;
    if asked.again {
        return Err(advised_error(
            "--again needs the frame, which stays at its cell",
            "Run it there, without --from",
        ));
    }
    let cell = asked.from.cell.as_ref();
    let found = database.numbered(number, cell).advised()?;
    if found.is_empty() {
        return Err(HistoryError::NoSuchInspection { number }).advised();
    }
    for (index, of_cell) in found.iter().enumerate() {
        let below = database.below(of_cell).advised()?.into_iter();
        let below: Vec<Record> = below.map(|other| other.record).collect();
        let record = &of_cell.record;
        let from = ReadFrom {
            cell: Some(&of_cell.cell),
            frames: None,
        };
        if asked.json {
            console.line(&record_line(from, record, &below, None));
        } else {
            if index > 0 {
                console.line(&"");
            }
            card(from, record, &below, console);
        }
    }
    Ok(Outcome::Accepted)
}

fn export(database: &Database, asked: &ExportArgs, console: &Console) -> anyhow::Result<Outcome> {
    let Some(path) = asked.csv.as_ref().filter(|_| asked.cases.is_none()) else {
        return Err(advised_error(
            "cases need the frames, which stay at their cell",
            "Export them there, without --from, or give --csv alone",
        ));
    };
    let filter = asked.filter.filter();
    let num = write_cells_table::<TransferError>(path, |row| {
        database.each(&filter, asked.from.cell.as_ref(), row)
    });
    console.note(&format_args!(
        "{} inspections written to {}",
        num.advised()?,
        path.display()
    ));
    Ok(Outcome::Accepted)
}

/// Shows the drift of each part at each cell: the same part at another cell is no drift.
fn drift(database: &Database, asked: &DriftArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let mut filter = asked.filter.filter();
    filter.verdict.get_or_insert(StoredVerdict::Accepted.into());
    let mut newest: BTreeMap<(String, String), VecDeque<PoseRecord>> = BTreeMap::new();
    let read = database.each::<DatabaseError>(&filter, asked.from.cell.as_ref(), |cell, record| {
        let pose = PoseRecord::of_record(&record);
        if let (Some(part), Some(pose)) = (record.summary.part, pose) {
            let poses = newest.entry((cell.to_owned(), part)).or_default();
            poses.push_back(pose);
            if poses.len() > MAX_POSES {
                poses.pop_front();
            }
        }
        Ok(())
    });
    read.advised()?;
    let all = newest.into_iter().map(|((cell, part), poses)| PartPoses {
        cell: Some(cell),
        part,
        poses: poses.into(),
    });
    let all: Vec<PartPoses> = all.collect();
    Ok(drift::answer(&all, asked, console))
}
