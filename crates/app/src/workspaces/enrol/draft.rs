//! The part that is about to be enrolled, and the form that describes it.

use std::sync::{Arc, Weak};

use serde::{Deserialize, Serialize};

use super::{
    meshes::ChosenMesh,
    selection::{Corrections, Selection},
    subject::EnrolInput,
    work::Checked,
};
use inspection::library::{
    BadName, EnrolError, MAX_TITLE, PartMeta, PartName, PartNaming, SharedTitle, Similarity,
};
use shell::inspection::library_cache::LibraryView;
use stages::scene::SceneCloud;

/// The part that is about to be enrolled.
#[derive(Clone, Debug)]
pub struct Draft {
    /// Number of the draft, counted from 1; undo steps refer to it.
    pub number: u64,
    /// The input that it is enrolled from.
    pub subject: Arc<EnrolInput>,
    /// The corrections made to the input's segments.
    pub corrections: Corrections,
    /// The points kept.
    pub selection: Arc<Selection>,
    /// The part that would be stored, or why none can be; `None` until known.
    pub checked: Option<Result<Arc<Checked>, EnrolError>>,
    /// The form that describes the part.
    pub form: Form,
    /// The form as it was until that of a part to replace took its place.
    pub(super) form_before: Option<Form>,
    /// The mesh that it is, if it was chosen among those of a file.
    pub chosen: Option<ChosenMesh>,
    /// The scene that Inspect showed when the draft was taken, if any.
    pub(super) in_front: Weak<SceneCloud>,
}

impl Draft {
    /// The part that would be stored, if known and possible.
    pub fn ready(&self) -> Option<&Arc<Checked>> {
        self.checked.as_ref()?.as_ref().ok()
    }

    /// The mesh to be taken once this draft is saved or skipped.
    pub(super) fn following(&self) -> Option<ChosenMesh> {
        self.chosen.as_ref()?.following()
    }

    /// The enrolled reference hardest to tell from the draft, other than the one that it replaces and those of its own part.
    pub fn hardest(&self, library: Option<&LibraryView>) -> Option<&Similarity> {
        let name = self.form.name.as_str();
        let of = self.form.reference_of.as_ref();
        let of = of.map_or(name, PartName::as_str);
        let part_of = |entry: &str| {
            let library = library?;
            Some(library.parts.get(library.index_of(entry)?)?.part_name())
        };
        let mut all = self.ready()?.likenesses.iter();
        all.find(|likeness| {
            let other = likeness.other.as_str();
            // References of one part are alike.
            other != name && part_of(other).map_or(other, PartName::as_str) != of
        })
    }
}

/// The form of a part.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Form {
    /// Title: the name shown to people.
    pub title: String,
    /// Name as entered, valid or not.
    pub name: String,
    /// Notes as entered.
    pub notes: String,
    /// Who wrote the name.
    pub named_by: NamedBy,
    /// The part of which this is another reference; `None` for a part of its own.
    pub reference_of: Option<PartName>,
}

/// Where a name came from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NamedBy {
    /// It is derived from the title.
    #[default]
    Title,
    /// It was entered by a person.
    Person,
}

/// A field of a form with its new content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Field {
    /// The title.
    Title(String),
    /// The name.
    Name(String),
    /// Notes.
    Notes(String),
    /// The part of which this is another reference.
    ReferenceOf(Option<PartName>),
}

impl Form {
    /// Returns the form of an enrolled part.
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

    /// Returns the form of a part with this title.
    pub(super) fn titled(title: &str, library: Option<&LibraryView>) -> Self {
        let mut form = Self::default();
        form.write(Field::Title(title.to_owned()), library);
        form
    }

    /// Fills in a field; until a name is entered, it follows the title.
    pub fn write(&mut self, field: Field, library: Option<&LibraryView>) {
        match field {
            Field::Title(title) => {
                self.title = title.chars().take(MAX_TITLE).collect();
                self.propose_name(library);
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
            Field::ReferenceOf(part) => {
                self.reference_of = part;
                self.propose_name(library);
            }
        }
    }

    /// Proposes a name, unless a person has entered one.
    fn propose_name(&mut self, library: Option<&LibraryView>) {
        if self.named_by == NamedBy::Title {
            self.name = proposed_name(&self.title, self.reference_of.as_ref(), library);
        }
    }

    /// Returns name, title and notes, if the name is valid.
    pub fn words(&self) -> Result<PartNaming, BadName> {
        Ok(PartNaming {
            name: PartName::new(&self.name)?,
            title: self.title.trim().to_owned(),
            notes: self.notes.trim().to_owned(),
        })
    }

    /// Finds a part with the same title, other than the one enrolled as `name`.
    pub fn shared_title(&self, name: &str, library: &LibraryView) -> Option<SharedTitle> {
        let of = self.reference_of.as_ref().map(PartName::as_str);
        let of = of.unwrap_or(name);
        SharedTitle::among(&self.title, name, of, &library.parts)
    }

    /// Title of the enrolled part of this name.
    pub fn namesake<'a>(&self, library: &'a LibraryView) -> Option<&'a str> {
        let index = library.index_of(&self.name)?;
        Some(library.title(index))
    }
}

/// Proposes a name for a title. If none of its letters may be in a name, it is `part` or `part_2`…; that of one more reference
/// of `door` is then `door_2`…, even without a title. Otherwise there is none for an empty title.
fn proposed_name(
    title: &str,
    reference_of: Option<&PartName>,
    library: Option<&LibraryView>,
) -> String {
    let named = PartName::proposed(title);
    if let Some(name) = named.filter(|name| Some(name) != reference_of) {
        return name.into();
    }
    let stem = match reference_of {
        Some(of) => of.as_str(),
        None if title.trim().is_empty() => return String::new(),
        None => "part",
    };
    let is_taken = |name: &str| {
        reference_of.is_some_and(|of| of.as_str() == name)
            || library.is_some_and(|library| {
                let mut damaged = library.damaged.iter();
                library.index_of(name).is_some() || damaged.any(|damaged| damaged.entry == name)
            })
    };
    // Cut off so that there is room for the number.
    let numbered = (2..).map(|number: u32| format!("{stem:.58}_{number}"));
    let mut names = std::iter::once(stem.to_owned()).chain(numbered);
    names.find(|name| !is_taken(name)).unwrap_or_default()
}

/// An enrolled part whose card is open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenedPart {
    /// Name of the part.
    pub name: PartName,
    /// Its form.
    pub form: Form,
}

#[cfg(test)]
mod tests {
    use super::*;
    use shell::inspection::library_cache::Damaged;
    use ui::user_error::UserError;

    #[test]
    fn the_name_follows_the_title_until_a_person_writes_one() {
        let mut form = Form::default();
        let write = |form: &mut Form, field| form.write(field, None);
        write(&mut form, Field::Title("Front door, left".into()));
        assert_eq!(form.name, "front_door_left");
        write(&mut form, Field::Name("door 7".into()));
        write(&mut form, Field::Title("Door 7".into()));
        assert_eq!(form.name, "door 7");
        assert!(matches!(form.words(), Err(BadName::BadCharacter { .. })));
        write(&mut form, Field::Name(String::new()));
        write(&mut form, Field::Title(" Door 8 ".into()));
        let words = form.words().expect("a name");
        assert_eq!(
            (words.name.as_str(), words.title.as_str()),
            ("door_8", "Door 8")
        );
    }

    #[test]
    fn a_title_without_a_letter_that_a_name_may_have_is_named_part() {
        let named = |title: &str, taken: &[&str]| {
            let damaged = taken.iter().map(|entry| Damaged {
                entry: (*entry).to_owned(),
                problem: UserError {
                    what: String::new(),
                    advice: String::new(),
                },
            });
            let library = LibraryView {
                damaged: damaged.collect(),
                ..LibraryView::default()
            };
            let mut form = Form::default();
            form.write(Field::Title(title.into()), Some(&library));
            form.name
        };
        assert_eq!(named("右前 涂装", &[]), "part");
        assert_eq!(named("右前 涂装", &["part", "part_2"]), "part_3");
        assert_eq!(named("右前 2", &[]), "2");
        assert_eq!(named(" ", &[]), "");
    }

    #[test]
    fn one_more_reference_is_named_after_its_part_unless_it_has_a_title() {
        let mut form = Form::default();
        let mut write = |field| {
            form.write(field, None);
            form.name.clone()
        };
        let of = |name: &str| Field::ReferenceOf(Some(name.parse().expect("a name")));
        assert_eq!(write(of("door")), "door_2");
        assert_eq!(write(Field::Title("Door".into())), "door_2", "not its own");
        assert_eq!(write(Field::Title("Door, open".into())), "door_open");
        write(Field::Title(String::new()));
        let long = write(of(&"d".repeat(PartName::MAX_LENGTH)));
        assert!(PartName::new(&long).is_ok(), "{long}");
        assert_eq!(write(Field::ReferenceOf(None)), "");
    }
}
