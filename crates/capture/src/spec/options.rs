//! Options of a source: `name=value`, separated by commas.

use super::SpecError;

/// The given options; all names are known.
pub(super) struct Options {
    given: Vec<(String, String)>,
}

impl Options {
    /// Parses options; `known` contains the valid names, separated by spaces.
    pub(super) fn split(
        kind: &'static str,
        text: &str,
        known: &'static str,
    ) -> Result<Self, SpecError> {
        let mut given = Vec::new();
        for option in text.split(',').filter(|option| !option.is_empty()) {
            let (name, value) = option.split_once('=').unwrap_or((option, ""));
            if !known.split(' ').any(|known| known == name) {
                return Err(SpecError::UnknownOption {
                    kind,
                    found: name.to_owned(),
                    expected: known,
                });
            }
            given.push((name.to_owned(), unescaped(value)));
        }
        Ok(Self { given })
    }

    /// Parses the value of an option; if it is given twice, the last one.
    pub(super) fn value<T>(
        &self,
        name: &'static str,
        expected: &str,
        read: impl Fn(&str) -> Option<T>,
    ) -> Result<Option<T>, SpecError> {
        let Some((_, found)) = self.given.iter().rev().find(|(given, _)| given == name) else {
            return Ok(None);
        };
        read(found).map(Some).ok_or_else(|| SpecError::BadValue {
            what: name,
            found: found.clone(),
            expected: expected.to_owned(),
        })
    }
}

/// Characters that separate options, and their escapes in a value. The escape character itself comes first.
const ESCAPES: [(char, &str); 3] = [('%', "%25"), (',', "%2C"), (':', "%3A")];

pub(super) fn escaped(value: &str) -> String {
    ESCAPES
        .iter()
        .fold(value.to_owned(), |text, (mark, written)| {
            text.replace(*mark, written)
        })
}

fn unescaped(value: &str) -> String {
    ESCAPES
        .iter()
        .rev()
        .fold(value.to_owned(), |text, (mark, written)| {
            text.replace(written, &mark.to_string())
        })
}
