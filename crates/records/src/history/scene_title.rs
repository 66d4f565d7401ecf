//! What a scene is called, without words of a language.

use std::fmt;

use serde::{Deserialize, Serialize};

use texts::Message;

/// What a scene is called: a name that somebody gave it, or numbers for which whoever shows them has words.
///
/// Whether it is simulated is stored beside it. [`Display`](fmt::Display) writes it in English.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SceneTitle {
    /// Name of a file, or of a frame of a camera or recording.
    Named(String),
    /// Number of a frame of the simulated cell.
    SimulatedFrame(u64),
    /// A scan.
    Scan {
        /// Name of its folder or files.
        name: String,
        /// Number of shots that it was put together from.
        num_shots: usize,
    },
}

impl SceneTitle {
    /// Title of a frame that a source delivered under this name.
    pub fn of_frame(name: &str, is_simulated: bool) -> Self {
        let number = capture::simulated_frame_number(name).filter(|_| is_simulated);
        number.map_or_else(|| Self::Named(name.to_owned()), Self::SimulatedFrame)
    }

    /// The message with the title of the frame of the simulated cell with this number.
    pub fn numbered(number: &str) -> Message {
        Message::new("simulated-frame").with("number", number)
    }

    /// Returns what a filter looks for its words in.
    pub(super) fn search(&self) -> String {
        match self {
            Self::Named(name) => name.clone(),
            Self::SimulatedFrame(number) => format!("=simulated_frame {number}"),
            Self::Scan { name, num_shots } => format!("{name} =shots {num_shots}"),
        }
    }
}

impl fmt::Display for SceneTitle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named(name) => f.write_str(name),
            Self::SimulatedFrame(number) => write!(f, "{}", Self::numbered(&number.to_string())),
            Self::Scan { name, num_shots } => write!(f, "{name} · {num_shots} shots"),
        }
    }
}
