//! What every panel is drawn with: colours and sizes, widgets, plots, the 3-D view. It knows nothing of sessions and inspections.

pub(in crate::app) mod plot;
pub mod theme;
pub mod viewport;
pub mod widgets;
