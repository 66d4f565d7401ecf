//! What every panel is drawn with: colours and sizes, widgets, the 3-D view. It knows nothing of sessions and inspections.

pub mod theme;
pub mod viewport;
pub mod widgets;
