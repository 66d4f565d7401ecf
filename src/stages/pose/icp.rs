//! ICP.
