//! The table of orders in use and its file, what is expected without one, and why that may not be known.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    thread,
    time::Duration,
};

use geometry::error::Advice as _;
use inspection::pipeline::{Expected, ExpectedError, ExpectedPart};
use records::orders::{OrderError, Orders, OrdersError, OrdersFile, TableRead};
use ui::{
    language::{advised, described, text},
    task::{Task, TaskContext, TaskError, TaskRunner},
    user_error::UserError,
    widgets::sentence,
};

/// What should hang before the camera.
#[derive(Debug, Default)]
pub struct Expecting {
    /// The parts that the user chose.
    pub(super) chosen: Vec<ExpectedPart>,
    /// The table in use, instead of them.
    pub(super) orders: Option<OrderTable>,
    /// What Live expects.
    pub(super) followed: Expected,
}

/// A table of orders in use.
#[derive(Debug)]
pub(super) struct OrderTable {
    pub(super) path: PathBuf,
    /// `None` until it is read.
    pub(super) content: Option<TableRead>,
}

/// An action on what is expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExpectAction {
    /// Expect these parts from the next inspection on; none to expect any. With a table of orders, nothing happens.
    Parts(Vec<ExpectedPart>),
    /// Close the table of orders, and expect any part.
    CloseOrders,
}

impl Expecting {
    /// Starts with the table of orders in this file, which is read at once: what starts with the program waits for nothing.
    pub fn starting(path: Option<PathBuf>) -> Self {
        let read = |path: PathBuf| OrderTable {
            content: Some(read(&path)),
            path,
        };
        Self {
            orders: path.map(read),
            ..Self::default()
        }
    }

    /// File of the table of orders in use.
    pub fn orders(&self) -> Option<&Path> {
        self.orders.as_ref().map(|table| &*table.path)
    }
}

impl OrderTable {
    pub(super) fn unread(path: PathBuf) -> Self {
        let content = None;
        Self { path, content }
    }
}

/// True if two readings of a table say the same.
fn is_same(one: &TableRead, other: &TableRead) -> bool {
    match (one, other) {
        (Ok(one), Ok(other)) => Arc::ptr_eq(one, other) || one == other,
        (Err(one), Err(other)) => one.to_string() == other.to_string(),
        _ => false,
    }
}

fn read(path: &Path) -> TableRead {
    Orders::read(path).map(Arc::new).map_err(Arc::new)
}

/// Why it is not known what should hang there.
#[derive(Clone, Debug)]
pub enum NotKnown {
    /// The table is not read yet.
    Unread {
        /// Name of its file.
        file: String,
    },
    /// The table cannot be read.
    Table(Arc<OrdersError>),
    /// The table does not say it.
    Order(OrderError),
    /// The user chose what cannot hang there.
    Chosen(ExpectedError),
    /// The recipe expects what cannot hang there.
    Recipe {
        /// Its name.
        name: String,
        /// Why not.
        error: ExpectedError,
    },
}

impl NotKnown {
    /// For a robot, whose programmer reads it.
    pub(crate) fn in_english(&self) -> UserError {
        match self {
            Self::Unread { file } => UserError {
                what: format!("the table of orders, {file}, is being read"),
                advice: "Send the trigger again in a second".into(),
            },
            Self::Table(error) => UserError::of(&**error),
            Self::Order(error) => UserError::of(error),
            Self::Chosen(error) => UserError::of(error),
            Self::Recipe { name, error } => UserError {
                what: error.of_recipe(name).to_string(),
                advice: error.advice(),
            },
        }
    }

    /// For the user.
    pub(crate) fn in_words(&self) -> UserError {
        let unusable = |error: String| text!("expect-table-unusable", error = error);
        let [what, advice] = match self {
            Self::Unread { file } => [text!("expect-reading", file = file), text!("shell-wait")],
            Self::Table(error) => [unusable(described(&**error)), advised(&**error)],
            Self::Chosen(error) => [described(error), advised(error)],
            Self::Recipe { name, error } => {
                [sentence(&described(&error.of_recipe(name))), advised(error)]
            }
            Self::Order(OrderError::Parts(cell)) => [unusable(described(cell)), advised(cell)],
            Self::Order(error) => [sentence(&described(error)), advised(error)],
        };
        UserError { what, advice }
    }
}

/// Time between two looks at whether to end.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Number of these between two looks at the file.
const NUM_POLLS: usize = 10;

/// Watches the file of the table in use.
#[derive(Debug)]
pub struct OrdersWatch {
    task: Task<TableRead>,
    path: Option<PathBuf>,
}

impl OrdersWatch {
    pub(crate) fn new(runner: &TaskRunner) -> Self {
        Self {
            task: Task::new("orders-watch", runner),
            path: None,
        }
    }

    /// Stops watching, so that the next table is read whatever its name is.
    pub(super) fn stop(&mut self) {
        self.task.cancel();
        self.path = None;
    }

    /// Watches this table from now on. Returns its content once it has changed.
    pub(super) fn poll(&mut self, table: Option<&OrderTable>) -> Option<TableRead> {
        let path = table.map(|table| &table.path);
        if self.path.as_ref() != path {
            self.path = path.cloned();
            self.task.cancel();
            if let Some(OrderTable { path, content }) = table {
                let (path, content) = (path.clone(), content.clone());
                let watch = move |context: &_| watch(&path, content, context);
                self.task.start(text!("expect-watching"), watch);
            }
        }
        self.task.poll()?.ok()
    }
}

fn watch(
    path: &Path,
    mut known: Option<TableRead>,
    context: &TaskContext<TableRead>,
) -> Result<TableRead, TaskError> {
    let mut file = OrdersFile::at(path);
    loop {
        let content = file.table();
        if !known.as_ref().is_some_and(|known| is_same(known, &content)) {
            known = Some(content.clone());
            context.latest(content);
        }
        for _ in 0..NUM_POLLS {
            context.check()?;
            thread::sleep(POLL_INTERVAL);
        }
    }
}
