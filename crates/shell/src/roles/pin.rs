//! The PIN as it is stored: not readable at a glance, but no stronger than that.

use serde::{Deserialize, Serialize};

/// Minimum number of digits.
pub(super) const LEAST_DIGITS: usize = 4;
/// Maximum number of digits.
pub(super) const MOST_DIGITS: usize = 8;

/// A PIN stored as a salt and a checksum.
///
/// Ten thousand guesses find it: it prevents accidental access, not an attack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pin {
    /// Makes the checksum of the same digits differ between files.
    salt: u32,
    /// CRC-32 of the salt and the digits.
    check: u32,
}

impl Pin {
    /// Makes a PIN of these digits.
    pub fn of(digits: &str) -> Self {
        let salt = geometry::clock::now().subsec_nanosecond().unsigned_abs();
        Self {
            salt,
            check: check(salt, digits),
        }
    }

    /// True if the digits match.
    pub fn is(&self, digits: &str) -> bool {
        check(self.salt, digits) == self.check
    }
}

fn check(salt: u32, digits: &str) -> u32 {
    files::crc32(format!("{salt}:{digits}").as_bytes())
}
