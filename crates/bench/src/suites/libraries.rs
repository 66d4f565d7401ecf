//! The libraries that the suites are inspected against: simulated parts, each enrolled from one capture.

use super::Suite;
use inspection::library::{EnrolError, EnrolParams, Library, enrol_part, enrol_standard_parts};
use simulate::{PartKind, Side};

/// The libraries that the suites are inspected against: standard parts, each enrolled from one frontal capture.
#[derive(Clone, Debug)]
pub struct SuiteLibraries {
    /// The eight parts, the left one where there are two sides.
    pub left: Library,
    /// The same and their right-hand counterparts.
    pub both_sides: Library,
}

impl SuiteLibraries {
    /// Enrols the parts.
    pub fn enrol(params: &EnrolParams) -> Result<Self, EnrolError> {
        let left = enrol_standard_parts(params)?;
        let mut both_sides = left.clone();
        for kind in PartKind::ALL.into_iter().filter(|kind| kind.is_sided()) {
            let right = enrol_part(kind, Side::Right, 0, params)?;
            both_sides.references.push(right);
        }
        Ok(Self { left, both_sides })
    }

    /// Those of the tests, enrolled once.
    #[cfg(test)]
    pub(crate) fn shared() -> &'static Self {
        static ENROLLED: std::sync::LazyLock<SuiteLibraries> = std::sync::LazyLock::new(|| {
            SuiteLibraries::enrol(&EnrolParams::default()).expect("eight parts")
        });
        &ENROLLED
    }

    /// Returns the library that a suite is inspected against.
    pub fn for_suite(&self, suite: Suite) -> &Library {
        match suite {
            Suite::BothSides => &self.both_sides,
            _ => &self.left,
        }
    }
}
