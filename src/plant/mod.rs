//! What the cell tells the other systems of the plant.

pub mod mqtt;
