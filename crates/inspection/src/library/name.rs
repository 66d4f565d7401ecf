//! Names of parts, which are also the names of their folders. Recipe names follow the same rules.

use std::fmt;

use serde::{Deserialize, Serialize};

use texts::{Described, Message};

/// A name of 1 to 64 lowercase letters, digits, `_` and `-`, beginning with a letter or digit; device names of Windows
/// are excluded.
///
/// So it is a valid folder name on every system, also on those that ignore case, and never a path.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct PartName(String);

/// Device names that Windows reserves in every folder.
const RESERVED: [&str; 22] = [
    "con", "prn", "aux", "nul", "com1", "com2", "com3", "com4", "com5", "com6", "com7", "com8",
    "com9", "lpt1", "lpt2", "lpt3", "lpt4", "lpt5", "lpt6", "lpt7", "lpt8", "lpt9",
];

/// Why a text is not a valid name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Serialize)]
#[serde(tag = "fault", rename_all = "snake_case")]
pub enum BadName {
    /// The name is empty.
    Empty,
    /// The name is too long.
    TooLong {
        /// Number of characters given.
        found: usize,
        /// Number of characters allowed.
        limit: usize,
    },
    /// The name contains a character that is not allowed.
    BadCharacter {
        /// The name given.
        name: String,
        /// The first such character.
        character: char,
    },
    /// The name begins with a character that is not allowed there.
    BadBeginning {
        /// The name given.
        name: String,
        /// Its first character.
        character: char,
    },
    /// The name is a device name of Windows.
    Reserved {
        /// The name given.
        name: String,
    },
}

impl BadName {
    /// Returns a valid name, as similar to the bad one as possible.
    pub fn example(&self) -> String {
        let alike = match self {
            Self::BadCharacter { name, .. } | Self::BadBeginning { name, .. } => {
                PartName::proposed(name).map(String::from)
            }
            Self::Reserved { name } => Some(format!("{name}_part")),
            Self::Empty | Self::TooLong { .. } => None,
        };
        alike.unwrap_or_else(|| "front_door".to_owned())
    }
}

impl Described for BadName {
    fn message(&self) -> Message {
        let message = Message::tagged("name", "fault", self)
            .with("most", PartName::MAX_LENGTH as f64)
            .with("example", self.example().as_str());
        // Quoted, with letters that cannot be seen spelled out.
        match self {
            Self::BadCharacter { name, character } | Self::BadBeginning { name, character } => {
                message
                    .with("name", format!("{name:?}").as_str())
                    .with("character", format!("{character:?}").as_str())
            }
            Self::Reserved { name } => message.with("name", format!("{name:?}").as_str()),
            Self::Empty | Self::TooLong { .. } => message,
        }
    }
}

texts::display!(BadName);

fn is_allowed(character: char) -> bool {
    matches!(character, 'a'..='z' | '0'..='9' | '_' | '-')
}

/// Spells an accented letter with letters that are allowed; `None` for any other character.
fn unaccented(letter: char) -> Option<&'static str> {
    Some(match letter {
        'ä' | 'æ' => "ae",
        'ö' | 'œ' => "oe",
        'ü' => "ue",
        'ß' => "ss",
        'á' | 'à' | 'â' | 'ã' | 'å' => "a",
        'ç' => "c",
        'é' | 'è' | 'ê' | 'ë' => "e",
        'í' | 'ì' | 'î' | 'ï' => "i",
        'ñ' => "n",
        'ó' | 'ò' | 'ô' | 'õ' | 'ø' => "o",
        'ú' | 'ù' | 'û' => "u",
        'ý' | 'ÿ' => "y",
        _ => return None,
    })
}

impl PartName {
    /// Maximum length, characters.
    pub const MAX_LENGTH: usize = 64;

    /// Checks a name.
    pub fn new(name: &str) -> Result<Self, BadName> {
        let first = name.chars().next().ok_or(BadName::Empty)?;
        if let Some(character) = name.chars().find(|&c| !is_allowed(c)) {
            return Err(BadName::BadCharacter {
                name: name.to_owned(),
                character,
            });
        }
        if !first.is_ascii_alphanumeric() {
            return Err(BadName::BadBeginning {
                name: name.to_owned(),
                character: first,
            });
        }
        if name.len() > Self::MAX_LENGTH {
            return Err(BadName::TooLong {
                found: name.len(),
                limit: Self::MAX_LENGTH,
            });
        }
        if RESERVED.contains(&name) {
            return Err(BadName::Reserved {
                name: name.to_owned(),
            });
        }
        Ok(Self(name.to_owned()))
    }

    /// Returns the valid name closest to a text such as a title, if any characters remain.
    pub fn proposed(text: &str) -> Option<Self> {
        let mut kept = String::new();
        for c in text.to_lowercase().chars() {
            if is_allowed(c) {
                kept.push(c);
            } else if let Some(letters) = unaccented(c) {
                kept.push_str(letters);
            } else if !kept.ends_with('_') {
                // One underscore for each run of replaced characters.
                kept.push('_');
            }
        }
        let kept: String = kept
            .trim_matches(['_', '-'])
            .chars()
            .take(Self::MAX_LENGTH)
            .collect();
        Self::new(kept.trim_end_matches(['_', '-'])).ok()
    }

    /// Returns the name as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for PartName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.0)
    }
}

impl std::str::FromStr for PartName {
    type Err = BadName;

    fn from_str(name: &str) -> Result<Self, BadName> {
        Self::new(name)
    }
}

impl TryFrom<String> for PartName {
    type Error = BadName;

    fn try_from(name: String) -> Result<Self, BadName> {
        Self::new(&name)
    }
}

impl From<PartName> for String {
    fn from(name: PartName) -> Self {
        name.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::error::Advice as _;

    #[test]
    fn plain_names_are_taken() {
        let longest = "a".repeat(64);
        for name in ["front_door", "door-2", "7", longest.as_str(), "com10"] {
            assert_eq!(PartName::new(name).expect("allowed").as_str(), name);
        }
    }

    #[test]
    fn paths_capitals_blanks_and_device_names_are_refused() {
        let too_long = "a".repeat(65);
        for name in [
            "",
            ".",
            "..",
            "../door",
            "a/b",
            "a\\b",
            "C:",
            ".hidden",
            "-rf",
            "_x",
            "Door",
            "a b",
            "tür",
            "a.b",
            "a\n",
            "a\0",
            "con",
            "lpt1",
            too_long.as_str(),
        ] {
            assert!(PartName::new(name).is_err(), "{name:?}");
        }
    }

    #[test]
    fn a_title_proposes_a_name() {
        let proposed = |title| PartName::proposed(title).map(String::from);
        for (title, name) in [
            ("Front door, left", "front_door_left"),
            ("  Grille (2024) ", "grille_2024"),
            ("Tür", "tuer"),
            ("Kotflügel links (Booth)", "kotfluegel_links_booth"),
            ("Außen ÄÖ", "aussen_aeoe"),
            ("Capó, él", "capo_el"),
            ("右前 door", "door"),
            ("fender-2_b", "fender-2_b"),
        ] {
            assert_eq!(proposed(title).as_deref(), Some(name));
        }
        for nothing in [", !", "", "右前 涂装"] {
            assert_eq!(proposed(nothing), None, "{nothing:?}");
        }
        let long = proposed(&"door ".repeat(30)).expect("a name");
        assert!(
            long.len() <= PartName::MAX_LENGTH && long.ends_with("door"),
            "{long}"
        );
    }

    #[test]
    fn the_advice_suggests_a_name_that_is_allowed() {
        let error = PartName::new("Front Door").expect_err("capitals");
        assert!(error.advice().ends_with("front_door"), "{}", error.advice());
        let nothing_left = PartName::new("../..").expect_err("a path");
        assert!(nothing_left.advice().ends_with("front_door"));
        assert!(
            PartName::new("con")
                .expect_err("device")
                .advice()
                .ends_with("con_part")
        );
    }
}
