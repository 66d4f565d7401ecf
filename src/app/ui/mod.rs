//! Building blocks of the panels: colours and sizes, widgets, parameter controls, plots, the 3-D view. Independent of sessions
//! and inspections.

pub mod parameter_control;
pub(in crate::app) mod plot;
pub(in crate::app) mod scrubber;
pub mod theme;
pub(in crate::app) mod tool_row;
pub mod viewport;
pub mod widgets;
