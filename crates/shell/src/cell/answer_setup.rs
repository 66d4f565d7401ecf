//! Whether and where robots are answered from the window.

use serde::{Deserialize, Serialize};

use robot::Convention;
use serve::{ListenAddress, ListenError, Listener, PoseKind, Protocol};

/// The default port, as in `partsight serve`.
const PORT: u16 = 30100;

/// Whether and where robots are answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct AnswerSetup {
    /// Whether robots are answered.
    pub is_on: bool,
    /// Protocol and address to listen on.
    pub at: ListenAddress,
    /// Which pose the robots get.
    pub pose: PoseKind,
    /// The convention of the poses, where the protocol does not fix it.
    pub convention: Convention,
}

impl AnswerSetup {
    /// Where a server with these settings listens, and in which convention it answers.
    pub fn listener(&self) -> Result<Listener, ListenError> {
        Listener::new(self.at, Some(self.convention))
    }

    /// True if robots would read other numbers from these settings than from `other`.
    pub(super) fn changes_poses(&self, other: &Self) -> bool {
        let convention = |setup: &Self| setup.listener().ok().map(|listener| listener.convention);
        self.pose != other.pose || convention(self) != convention(other)
    }
}

impl Default for AnswerSetup {
    fn default() -> Self {
        Self {
            is_on: false,
            at: ListenAddress {
                protocol: Protocol::Ascii,
                address: ([127, 0, 0, 1], PORT).into(),
            },
            pose: PoseKind::default(),
            convention: Convention::default(),
        }
    }
}
