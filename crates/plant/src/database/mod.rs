//! The history of many cells in PostgreSQL.
//!
//! ```text
//! history.sqlite ─► HistorySender: a thread ─► Database::send ─► PostgreSQL: partsight.inspection, detail, recipe
//!  unsent rows ◄─ noted as sent ◄─ committed                                 │
//!                                                 history list --from ◄──────┘
//! ```
//!
//! The SQLite file remains the history: programs read and write only it, and none waits for the network. A row is sent
//! when it is added and whenever it changes, in batches of one transaction each. A row is marked as sent in the file only
//! after its batch is committed; if the program is killed in between, it is sent again, which changes nothing. Frames stay
//! at their cell.
//!
//! A cell's name belongs to one history; another history of the same name is refused until a person lets it take over. A
//! transaction locks the cell's row before it reads the file and until it ends, so that rows read by two senders of the
//! same history never arrive in the wrong order.

mod access;
mod address;
mod cell;
mod client;
mod error;
mod overview;
mod schema;
mod send;
mod sender;

pub use self::{
    access::{DatabaseAccess, DatabaseAccessError, UnencryptedDatabase},
    address::{DatabaseAddress, DatabaseAddressError},
    cell::{BadCellName, CellHistory, CellName},
    client::Database,
    error::{DatabaseError, TransferError},
    overview::{CellCount, CellPage, CellRecord},
    send::BATCH,
    sender::{HistorySender, SendNews, SendProblem, SenderError, Unsent},
};
