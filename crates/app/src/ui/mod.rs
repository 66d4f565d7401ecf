//! Building blocks of the panels: colours and sizes, widgets, parameter controls, plots, the 3-D view. Independent of sessions
//! and inspections.

pub mod parameter_control;
pub(crate) mod plot;
pub(crate) mod scrubber;
pub mod theme;
pub(crate) mod tool_row;
pub mod viewport;
pub mod widgets;
