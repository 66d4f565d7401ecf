//! The PIN as it is remembered: so that nobody reads it in passing, and no more than that.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

/// Fewest digits of a PIN.
pub(super) const LEAST_DIGITS: usize = 4;
/// Most digits of a PIN.
pub(super) const MOST_DIGITS: usize = 8;

/// A few digits, remembered by a checksum of them and a number of their own.
///
/// Ten thousand guesses find it: it keeps hands off, not burglars out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pin {
    /// Makes the same digits look different in each file.
    salt: u32,
    /// CRC-32 of the salt and the digits.
    check: u32,
}

impl Pin {
    /// Of these digits.
    pub fn of(digits: &str) -> Self {
        let salt = Timestamp::now().subsec_nanosecond().unsigned_abs();
        Self {
            salt,
            check: check(salt, digits),
        }
    }

    /// True if it is these.
    pub fn is(&self, digits: &str) -> bool {
        check(self.salt, digits) == self.check
    }
}

fn check(salt: u32, digits: &str) -> u32 {
    crate::files::crc32(format!("{salt}:{digits}").as_bytes())
}
