//! The history of many cells in PostgreSQL.
//!
//! ```text
//! history.sqlite ─► HistorySender: a thread ─► Database::send ─► PostgreSQL: partsight.inspection, detail, recipe
//!  unsent rows ◄─ noted as sent ◄─ committed                                 │
//!                                                 history list --from ◄──────┘
//! ```
//!
//! The SQLite file stays the history: programs write and read it alone, and nobody waits for the network. A row goes over
//! when it is added and whenever it changes, in batches of one transaction each. Only once a batch is committed does the
//! file note it as sent; a kill between the two sends it again, which changes nothing. Frames stay at their cell.
//!
//! A cell's name belongs to one history: another one of the same name is refused until a person lets it take over. A
//! transaction holds the cell's row from before the file is read until its end, so that what two senders of the same
//! history read never arrives in the wrong order.

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
    overview::{CellCount, CellPage},
    send::BATCH,
    sender::{HistorySender, SendNews, SendTrouble, SenderError, Unsent},
};
