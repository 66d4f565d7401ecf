//! The options of a source: `name=value`, with commas between them.

use super::SpecError;

/// The options as given, each name known.
pub(super) struct Options {
    given: Vec<(String, String)>,
}

impl Options {
    /// `known` holds the names there are, with spaces between them.
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

    /// The value of an option, the last one where it is given twice.
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

/// The marks that part options, and how they are written in a value. The escape's own mark comes first.
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
