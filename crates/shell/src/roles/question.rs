//! What the roles keep, ask and do.

use serde::{Deserialize, Serialize};

use crate::{action::Action, session::UserRole};

/// Choices for the minutes without input until the window locks.
pub const LOCK_AFTER: [u32; 4] = [1, 5, 15, 60];

/// PIN, lock and open question of the roles.
#[derive(Debug)]
pub struct RoleState {
    /// PIN of the engineer's view, if one is set.
    pub pin: Option<Pin>,
    /// Minutes without input until the window returns to the operator's view; only with a PIN.
    pub lock_after: u32,
    /// The open question, if any.
    pub asked: Option<OpenQuestion>,
}

impl Default for RoleState {
    fn default() -> Self {
        Self::starting(None, LOCK_AFTER[1])
    }
}

impl RoleState {
    /// Makes the state at the start of the window.
    pub fn starting(pin: Option<Pin>, lock_after: u32) -> Self {
        Self {
            pin,
            lock_after: lock_after.clamp(LOCK_AFTER[0], LOCK_AFTER[3]),
            asked: None,
        }
    }

    /// Role at the start: the operator with a PIN, else the last role.
    pub fn first_role(&self, last: UserRole) -> UserRole {
        match self.pin {
            Some(_) => UserRole::Operator,
            None => last,
        }
    }

    /// Seconds without input until the window locks in this role; `None` if it does not.
    pub fn lock_timeout(&self, role: UserRole) -> Option<f64> {
        let locks = role == UserRole::Engineer && self.pin.is_some();
        locks.then_some(f64::from(self.lock_after) * 60.0)
    }

    /// True if the PIN is asked for and what was typed as quickly as by a scanner can be one.
    pub fn may_be_pin(&self, code: &str) -> bool {
        let is_short = code.len() <= MOST_DIGITS;
        let is_asked = self.asked.is_some() && self.pin.is_some();
        is_asked && is_short && code.bytes().all(|letter| letter.is_ascii_digit())
    }
}

/// A question on top of the window.
#[derive(Debug)]
pub struct OpenQuestion {
    /// What is asked for.
    pub question: RoleQuestion,
    /// The digits typed so far.
    pub digits: String,
    /// What was wrong with the previous digits.
    pub wrong: Option<String>,
}

impl OpenQuestion {
    pub(super) fn about(question: RoleQuestion) -> Self {
        Self {
            question,
            digits: String::new(),
            wrong: None,
        }
    }
}

/// Kind of a question.
#[derive(Debug)]
pub enum RoleQuestion {
    /// The PIN, or a confirmation if none is set, to enter the engineer's view and then carry out this action.
    MayI(Option<Box<Action>>),
    /// A new PIN.
    NewPin,
    /// The new PIN again, to confirm it.
    NewPinAgain(String),
    /// Whether to remove the PIN.
    RemovePin,
}

/// Actions on the roles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoleAction {
    /// Switch to the other role; to the engineer's only after the PIN.
    Switch,
    /// Lock the window after a long time without input.
    Lock,
    /// Ask for a new PIN.
    SetPin,
    /// Ask whether to remove the PIN.
    RemovePin,
    /// Lock after this many minutes.
    LockAfter(u32),
    /// Add a digit to the PIN.
    Digit(char),
    /// Erase the last digit.
    Erase,
    /// Confirm the digits.
    Enter,
    /// Close the dialog.
    Close,
}

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
