//! The table of orders: which parts hang there for which production order and serial number.
//!
//! The table is a CSV file, as spreadsheets and planning systems write it. Its first line names the columns, in any order:
//! `order`, `serial` (may be left out, and its cells may be empty) and `parts`. Further columns are ignored. Cells are
//! separated by commas, semicolons or tabs, and parts within a cell, `PART` or `PLACE=PART`, by commas, semicolons or `|`:
//!
//! ```csv
//! order;serial;parts
//! 4711;;front_door|fender
//! 4711;TL-0042;front_door
//! ```

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, SystemTime},
};

use csv::{ReaderBuilder, StringRecord};
use thiserror::Error;

use crate::history::Traceability;
use files::{FileError, read_text};
use geometry::error::Advice as _;
use inspection::pipeline::{Expected, ExpectedError, ExpectedPart};
use stages::{rack::Rack, segment::MAX_PARTS};
use texts::{Described, Message};

/// Maximum size of a table: some 100 000 rows.
const MAX_BYTES: u64 = 8 << 20;
/// What may separate cells. Of those in the first line, the first of this list does.
const SEPARATORS: [char; 3] = [';', '\t', ','];
/// What may separate parts in a cell.
const PART_SEPARATORS: [char; 3] = [';', ',', '|'];

/// A column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrderColumn {
    /// The production order.
    Order,
    /// The serial number of a hung part; empty for the other parts of the order.
    Serial,
    /// The parts that should hang there.
    Parts,
}

impl OrderColumn {
    /// Its name in the first line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Order => "order",
            Self::Serial => "serial",
            Self::Parts => "parts",
        }
    }
}

/// Why a table cannot be read.
#[derive(Debug, Error)]
pub enum OrdersError {
    /// The file cannot be read.
    File(#[from] FileError),
    /// A column is missing, or there twice.
    Column {
        /// The file.
        path: PathBuf,
        /// The column.
        column: OrderColumn,
        /// Their number.
        found: usize,
    },
    /// A cell has no valid content.
    Cell(BadCell),
    /// There is no order below the first line.
    NoOrders {
        /// The file.
        path: PathBuf,
    },
}

/// A cell of a table that has no valid content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadCell {
    /// The file.
    pub path: PathBuf,
    /// Number of the line in the file, from 1.
    pub line: u64,
    /// The column.
    pub column: OrderColumn,
    /// What is wrong.
    pub problem: CellProblem,
}

/// What is wrong with a cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CellProblem {
    /// It is empty.
    Empty,
    /// No order or serial number is so long, or has line breaks.
    NotOneLine,
    /// The same order and serial number again.
    Again {
        /// Number of the line that has them too, from 1.
        first: u64,
    },
    /// The parts cannot be expected.
    Parts(ExpectedError),
}

impl Described for OrdersError {
    fn message(&self) -> Message {
        let of_file = |id, path: &Path| Message::new(id).with("path", &*path.display().to_string());
        match self {
            Self::File(error) => Message::new("orders-file")
                .with("what", &*error.to_string())
                .with("to_do", &*error.advice())
                .with("is_damaged", matches!(error, FileError::Damaged { .. })),
            Self::Column {
                path,
                column,
                found,
            } => of_file("orders-column", path)
                .with("column", column.name())
                .with("found", *found as f64),
            Self::Cell(cell) => cell.message(),
            Self::NoOrders { path } => of_file("orders-none", path),
        }
    }
}

impl Described for BadCell {
    fn message(&self) -> Message {
        let problem = match &self.problem {
            CellProblem::Empty => Message::new("orders-empty"),
            CellProblem::NotOneLine => {
                Message::new("orders-not-one-line").with("limit", Traceability::MAX_LETTERS as f64)
            }
            CellProblem::Again { first } => {
                Message::new("orders-again").with("first", &*first.to_string())
            }
            CellProblem::Parts(error) => error.message(),
        };
        Message::new("orders-cell")
            .with("path", &*self.path.display().to_string())
            .with("line", &*self.line.to_string())
            .with("column", self.column.name())
            .caused_by(problem)
    }
}

texts::display!(OrdersError, BadCell);

/// Why it is not known what to expect.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum OrderError {
    /// The order or the serial number is longer than any in a table, or has line breaks.
    TooLong,
    /// Neither an order nor a serial number is given.
    NotGiven,
    /// The table does not have the order.
    UnknownOrder {
        /// The order.
        order: String,
    },
    /// No row has the serial number, and the order has no row for other serial numbers.
    UnknownSerial {
        /// The serial number.
        serial: String,
    },
    /// The order has rows with serial numbers only, and none is given.
    SerialNotGiven {
        /// The order.
        order: String,
    },
    /// The serial number is that of another order.
    OtherOrder {
        /// The serial number.
        serial: String,
        /// The order that is given.
        order: String,
        /// The order that has it.
        other: String,
    },
    /// Several orders have the serial number, and no order is given.
    SeveralOrders {
        /// The serial number.
        serial: String,
    },
    /// The parts of the row cannot be expected.
    Parts(BadCell),
}

impl Described for OrderError {
    fn message(&self) -> Message {
        match self {
            Self::TooLong => {
                Message::new("order-too-long").with("limit", Traceability::MAX_LETTERS as f64)
            }
            Self::NotGiven => Message::new("order-not-given"),
            Self::UnknownOrder { order } => {
                Message::new("order-unknown-order").with("order", &**order)
            }
            Self::UnknownSerial { serial } => {
                Message::new("order-unknown-serial").with("serial", &**serial)
            }
            Self::SerialNotGiven { order } => {
                Message::new("order-serial-not-given").with("order", &**order)
            }
            Self::OtherOrder {
                serial,
                order,
                other,
            } => Message::new("order-other-order")
                .with("serial", &**serial)
                .with("order", &**order)
                .with("other", &**other),
            Self::SeveralOrders { serial } => {
                Message::new("order-several").with("serial", &**serial)
            }
            Self::Parts(cell) => cell.message(),
        }
    }
}

texts::display!(OrderError);

/// The table of orders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Orders {
    path: PathBuf,
    /// The rows of each order by serial number; that of the other serial numbers is empty.
    rows: BTreeMap<String, BTreeMap<String, Row>>,
    /// The orders that have a row for a serial number.
    of_serial: BTreeMap<String, BTreeSet<String>>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    /// Number of the line in the file, from 1.
    line: u64,
    /// One at least.
    parts: Vec<ExpectedPart>,
}

impl Orders {
    /// Reads a table. A single bad row makes the whole table an error, but for the names of its parts and places: those count
    /// once the order is asked for.
    pub fn read(path: &Path) -> Result<Self, OrdersError> {
        Self::parse(path, &read_text(path, MAX_BYTES)?)
    }

    /// Parses a table; errors name `path` as its file.
    pub fn parse(path: &Path, text: &str) -> Result<Self, OrdersError> {
        // The hint that Excel reads its separator from. Empty lines are skipped, and the numbers of the others stay.
        let first = text.lines().next().unwrap_or_default();
        let text = if first.to_ascii_lowercase().starts_with("sep=") {
            &text[first.len()..]
        } else {
            text
        };
        let head = text.trim_start().lines().next().unwrap_or_default();
        let mut separators = SEPARATORS.iter();
        let separator = separators.find(|separator| head.contains(**separator));
        let mut reader = ReaderBuilder::new()
            .delimiter(separator.map_or(b',', |separator| *separator as u8))
            .flexible(true)
            .has_headers(false)
            .from_reader(text.as_bytes());
        let mut rows = reader.records().map_while(Result::ok);
        let head = rows.next().unwrap_or_default();
        let place = |column| place_of(path, &head, column);
        let order = required(path, OrderColumn::Order, place(OrderColumn::Order)?)?;
        let parts = required(path, OrderColumn::Parts, place(OrderColumn::Parts)?)?;
        let serial = place(OrderColumn::Serial)?;
        let mut table = Self {
            path: path.to_owned(),
            rows: BTreeMap::new(),
            of_serial: BTreeMap::new(),
        };
        let mut lines = LineCount::default();
        for row in rows {
            let line = lines.line_of(&row, text);
            if row.iter().all(|cell| cell.trim().is_empty()) {
                continue;
            }
            let wrong = |column, problem| {
                OrdersError::Cell(BadCell {
                    path: path.to_owned(),
                    line,
                    column,
                    problem,
                })
            };
            let cell = |place: Option<usize>| place.and_then(|place| row.get(place)).unwrap_or("");
            let key = |column, place| {
                let key = cell(place).trim();
                match Traceability::cleaned(key) {
                    cleaned if cleaned == key => Ok(cleaned),
                    _ => Err(wrong(column, CellProblem::NotOneLine)),
                }
            };
            let of_order = key(OrderColumn::Order, Some(order))?;
            if of_order.is_empty() {
                return Err(wrong(OrderColumn::Order, CellProblem::Empty));
            }
            let of_serial = key(OrderColumn::Serial, serial)?;
            let names = cell(Some(parts)).split(PART_SEPARATORS).map(str::trim);
            let names = names.filter(|name| !name.is_empty());
            let parts_of_row: Vec<ExpectedPart> = names.map(Into::into).collect();
            let problem = match parts_of_row.len() {
                0 => Some(CellProblem::Empty),
                found if found > MAX_PARTS => {
                    Some(CellProblem::Parts(ExpectedError::TooMany { found }))
                }
                _ => None,
            };
            if let Some(problem) = problem {
                return Err(wrong(OrderColumn::Parts, problem));
            }
            if !of_serial.is_empty() {
                let orders = table.of_serial.entry(of_serial.clone()).or_default();
                orders.insert(of_order.clone());
            }
            let rows = table.rows.entry(of_order).or_default();
            if let Some(Row { line: first, .. }) = rows.get(&of_serial) {
                let again = CellProblem::Again { first: *first };
                return Err(wrong(OrderColumn::Order, again));
            }
            rows.insert(
                of_serial,
                Row {
                    line,
                    parts: parts_of_row,
                },
            );
        }
        if table.rows.is_empty() {
            let path = path.to_owned();
            return Err(OrdersError::NoOrders { path });
        }
        Ok(table)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The parts that should hang there, in this rack or wherever they hang, for an order and a serial number: those of the row with both; else those of the
    /// order's row without a serial number. Without an order, those of the one row with the serial number.
    pub fn expected(
        &self,
        trace: &Traceability,
        rack: Option<&Rack>,
        is_enrolled: impl Fn(&str) -> bool,
    ) -> Result<Expected, OrderError> {
        let [order, serial] = [&trace.order, &trace.serial].map(|text| text.trim());
        if [order, serial]
            .iter()
            .any(|text| Traceability::cleaned(text) != *text)
        {
            return Err(OrderError::TooLong);
        }
        let Row { line, parts } = self.row(order, serial)?;
        Expected::new(parts.clone(), rack, is_enrolled).map_err(|error| {
            OrderError::Parts(BadCell {
                path: self.path.clone(),
                line: *line,
                column: OrderColumn::Parts,
                problem: CellProblem::Parts(error),
            })
        })
    }

    fn row(&self, order: &str, serial: &str) -> Result<&Row, OrderError> {
        let unknown_serial = || OrderError::UnknownSerial {
            serial: serial.to_owned(),
        };
        let mut with_serial = self.of_serial.get(serial).into_iter().flatten();
        let row_of = |order: &String| self.rows.get(order)?.get(serial);
        if order.is_empty() {
            if serial.is_empty() {
                return Err(OrderError::NotGiven);
            }
            let row = with_serial.next().and_then(row_of);
            let row = row.ok_or_else(unknown_serial)?;
            return match with_serial.next() {
                None => Ok(row),
                Some(_) => Err(OrderError::SeveralOrders {
                    serial: serial.to_owned(),
                }),
            };
        }
        let order = order.to_owned();
        let Some(rows) = self.rows.get(&order) else {
            return Err(OrderError::UnknownOrder { order });
        };
        if let Some(row) = rows.get(serial) {
            return Ok(row);
        }
        if let Some(other) = with_serial.next() {
            return Err(OrderError::OtherOrder {
                serial: serial.to_owned(),
                order,
                other: other.clone(),
            });
        }
        rows.get("").ok_or_else(|| {
            if serial.is_empty() {
                OrderError::SerialNotGiven { order }
            } else {
                unknown_serial()
            }
        })
    }
}

/// A table that is read again once its file has changed: a large one takes seconds.
#[derive(Debug)]
pub struct OrdersFile {
    path: PathBuf,
    /// The table, and what the file was like before it was read.
    read: Option<(FileState, TableRead)>,
}

/// A table, or why it cannot be read.
pub type TableRead = Result<Arc<Orders>, Arc<OrdersError>>;

/// Length of a file, and when it was changed.
type FileState = (u64, SystemTime);

/// Some disks date their files in steps of 2 s: a younger file may have changed again.
const SETTLED: Duration = Duration::from_secs(3);

impl OrdersFile {
    /// Refers to the table in this file, which need not exist. Reads nothing yet.
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            read: None,
        }
    }

    /// The table as its file has it now. Without a change, it is the same in memory.
    pub fn table(&mut self) -> TableRead {
        let found = fs::metadata(&self.path).ok();
        let now = found.and_then(|found| Some((found.len(), found.modified().ok()?)));
        if let (Some((before, table)), Some(now)) = (&self.read, &now)
            && before == now
        {
            return table.clone();
        }
        let table = Orders::read(&self.path).map(Arc::new).map_err(Arc::new);
        let is_settled =
            |(_, changed): &FileState| changed.elapsed().is_ok_and(|age| age > SETTLED);
        // What could not be read for a moment, as on a share, is tried again.
        let is_read = !matches!(&table, Err(error) if matches!(**error, OrdersError::File(_)));
        let settled = now.filter(|now| is_read && is_settled(now));
        self.read = settled.map(|state| (state, table.clone()));
        table
    }
}

/// Counts the lines of a text up to a row: the parser takes the end of a line, and empty lines, for the beginning of the next
/// row.
#[derive(Default)]
struct LineCount {
    counted: usize,
    num_ends: u64,
}

impl LineCount {
    /// The number of the line in which a row begins, from 1; of rows in their order.
    fn line_of(&mut self, row: &StringRecord, text: &str) -> u64 {
        let at = row.position().map_or(0, csv::Position::byte);
        let at = usize::try_from(at).unwrap_or(usize::MAX).min(text.len());
        let text = text.as_bytes();
        let is_end = |letter: &u8| matches!(letter, b'\r' | b'\n');
        let begins = at
            + text[at..]
                .iter()
                .take_while(|letter| is_end(letter))
                .count();
        let is_new_line = |at: &usize| match text[*at] {
            b'\n' => true,
            b'\r' => text.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        self.num_ends += (self.counted..begins).filter(is_new_line).count() as u64;
        self.counted = begins;
        self.num_ends + 1
    }
}

/// The place of a column in the first line; `None` if it is missing.
fn place_of(
    path: &Path,
    head: &StringRecord,
    column: OrderColumn,
) -> Result<Option<usize>, OrdersError> {
    let is_it = |(_, cell): &(usize, &str)| cell.trim().eq_ignore_ascii_case(column.name());
    let places: Vec<usize> = (head.iter().enumerate())
        .filter(is_it)
        .map(|(place, _)| place)
        .collect();
    match places[..] {
        [] => Ok(None),
        [place] => Ok(Some(place)),
        _ => Err(OrdersError::Column {
            path: path.to_owned(),
            column,
            found: places.len(),
        }),
    }
}

fn required(path: &Path, column: OrderColumn, place: Option<usize>) -> Result<usize, OrdersError> {
    place.ok_or_else(|| OrdersError::Column {
        path: path.to_owned(),
        column,
        found: 0,
    })
}

#[cfg(test)]
mod tests;
