//! The part that is about to be enrolled, as far as it is.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{
    selection::{Corrections, Selection},
    subject::EnrolInput,
    work::Checked,
};
use crate::{
    app::{inspection::library_cache::LibraryView, user_error::UserError},
    library::{BadName, MAX_TITLE, PartMeta, PartName, PartNaming, SharedTitle, Similarity},
};

/// The part that is about to be enrolled.
#[derive(Clone, Debug)]
pub struct Draft {
    /// By which number what belongs to it is known.
    pub number: u64,
    /// What it is enrolled from.
    pub subject: Arc<EnrolInput>,
    /// What was corrected.
    pub corrections: Corrections,
    /// What is kept.
    pub selection: Arc<Selection>,
    /// What would be stored; `None` until it is known.
    pub checked: Option<Result<Arc<Checked>, UserError>>,
    /// What it shall be called.
    pub form: Form,
}

impl Draft {
    /// What would be stored, once it is known and can be.
    pub fn ready(&self) -> Option<&Arc<Checked>> {
        self.checked.as_ref()?.as_ref().ok()
    }

    /// The enrolled part that it is hardest to tell from, the one that it replaces left out.
    pub fn hardest(&self) -> Option<&Similarity> {
        let mut all = self.ready()?.likenesses.iter();
        let of = self.form.reference_of.as_ref().map(PartName::as_str);
        // References of one part are alike.
        all.find(|likeness| likeness.other != self.form.name && Some(likeness.other.as_str()) != of)
    }
}

/// What a person writes about a part.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Form {
    /// Its name for people.
    pub title: String,
    /// Its name, right or wrong.
    pub name: String,
    /// Notes.
    pub notes: String,
    /// Who wrote the name.
    pub named_by: NamedBy,
    /// The part that it is one more reference of, if it is none of its own.
    pub reference_of: Option<PartName>,
}

/// Who wrote a name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NamedBy {
    /// It follows the title.
    #[default]
    Title,
    /// A person.
    Person,
}

/// A line of a form.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Field {
    /// The name for people.
    Title(String),
    /// The name.
    Name(String),
    /// Notes.
    Notes(String),
    /// The part that it is one more reference of.
    ReferenceOf(Option<PartName>),
}

impl Form {
    /// What an enrolled part is called.
    pub fn of(part: &PartMeta) -> Self {
        let words = part.words();
        Self {
            reference_of: part.reference_of().cloned(),
            title: words.title,
            name: words.name.to_string(),
            notes: words.notes,
            named_by: NamedBy::Person,
        }
    }

    /// Writes a line; while nobody wrote a name, it follows the title.
    pub fn write(&mut self, field: Field) {
        match field {
            Field::Title(title) => {
                if self.named_by == NamedBy::Title {
                    let proposed = PartName::proposed(&title);
                    self.name = proposed.map_or_else(String::new, String::from);
                }
                self.title = title.chars().take(MAX_TITLE).collect();
            }
            Field::Name(name) => {
                // An emptied name follows the title again.
                self.named_by = if name.is_empty() {
                    NamedBy::Title
                } else {
                    NamedBy::Person
                };
                self.name = name;
            }
            Field::Notes(notes) => self.notes = notes,
            Field::ReferenceOf(part) => self.reference_of = part,
        }
    }

    /// The words, if the name is one.
    pub fn words(&self) -> Result<PartNaming, BadName> {
        Ok(PartNaming {
            name: PartName::new(&self.name)?,
            title: self.title.trim().to_owned(),
            notes: self.notes.trim().to_owned(),
        })
    }

    /// Another part that has the title.
    pub fn shared_title(&self, library: &LibraryView) -> Option<SharedTitle> {
        let of = self.reference_of.as_ref().map(PartName::as_str);
        let of = of.unwrap_or(&self.name);
        SharedTitle::among(&self.title, &self.name, of, &library.parts)
    }

    /// The enrolled part of this name.
    pub fn namesake<'a>(&self, library: &'a LibraryView) -> Option<&'a str> {
        let place = library.place_of(&self.name)?;
        Some(library.title(place))
    }
}

/// An enrolled part that is looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenedPart {
    /// The part.
    pub name: PartName,
    /// What it is called, as a person writes it.
    pub form: Form,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_follows_the_title_until_a_person_writes_one() {
        let mut form = Form::default();
        form.write(Field::Title("Front door, left".into()));
        assert_eq!(form.name, "front_door_left");
        form.write(Field::Name("door 7".into()));
        form.write(Field::Title("Door 7".into()));
        assert_eq!(form.name, "door 7");
        assert!(matches!(form.words(), Err(BadName::BadCharacter { .. })));
        form.write(Field::Name(String::new()));
        form.write(Field::Title(" Door 8 ".into()));
        let words = form.words().expect("a name");
        assert_eq!(
            (words.name.as_str(), words.title.as_str()),
            ("door_8", "Door 8")
        );
    }
}
