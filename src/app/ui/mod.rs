//! What every panel is drawn with: colours and sizes, widgets, the control of a parameter, plots, the 3-D view. It
//! knows nothing of sessions and inspections.

pub mod parameter_control;
pub(in crate::app) mod plot;
pub(in crate::app) mod scrubber;
pub mod theme;
pub(in crate::app) mod tool_row;
pub mod viewport;
pub mod widgets;
