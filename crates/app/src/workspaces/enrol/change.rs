//! Changes of the library, each with the change that reverts it.

use std::{path::PathBuf, sync::Arc};

use inspection::library::{
    Enrolled, LibraryError, LibraryFolder, Part, PartMeta, PartName, PartNaming, Saved, SprayPath,
};
use shell::inspection::library_cache::{LibraryCache, LibraryView};
use ui::{
    language::{self, Message, text},
    user_error::UserError,
};

/// A change of the library.
#[derive(Clone, Debug)]
pub enum LibraryChange {
    /// Save a prepared part, as another reference of the given part if any; replaces a part of the same name.
    Save(Arc<Enrolled>, PartNaming, Option<PartName>),
    /// Change name, title and notes of a part.
    Rename(PartName, PartNaming),
    /// Move a part to the trash.
    Remove(PartName),
    /// Restore a part from this place in the trash.
    Restore(PathBuf),
    /// Read a spray path from this file and store it with a part.
    ReadPath(PartName, PathBuf),
    /// Store this spray path with a part; `None` removes the present one.
    SetPath(PartName, Option<SprayPath>),
}

/// A change that was made.
#[derive(Clone, Debug)]
pub struct Changed {
    /// Description of the change.
    pub what: ChangeText,
    /// The change that reverts it.
    pub back: LibraryChange,
    /// The changed part as it is now.
    pub left: PartVersion,
    /// The changed part, if it is in the library now.
    pub name: Option<PartName>,
    /// The library after the change.
    pub library: Arc<LibraryView>,
}

/// A part as a change left it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartVersion {
    name: PartName,
    /// [`LibraryFolder::version_of`]; `None` if the part was removed.
    version: Option<String>,
}

impl PartVersion {
    fn current(name: PartName, folder: &LibraryFolder) -> Self {
        Self {
            version: folder.version_of(&name),
            name,
        }
    }
}

/// Description of a change.
#[derive(Clone, Debug, Default)]
pub struct ChangeText {
    /// The change only.
    pub brief: String,
    /// The change and what a person should know about it.
    pub whole: String,
}

impl From<String> for ChangeText {
    fn from(text: String) -> Self {
        Self {
            brief: text.clone(),
            whole: text,
        }
    }
}

/// Changes the library in use and reloads it. An undo or redo is refused if the part is not as the previous change left it,
/// because it would discard what somebody else did.
pub(super) fn change(
    change: LibraryChange,
    left: Option<&PartVersion>,
    library_cache: &LibraryCache,
) -> Result<Changed, UserError> {
    let loaded = library_cache.get();
    let folder = loaded.folder_to_change()?;
    let title_of = |name: &PartName| loaded.shown.title_of(name.as_str()).to_owned();
    if let Some(left) = left
        && PartVersion::current(left.name.clone(), folder) != *left
    {
        return Err(UserError {
            what: text!("enrol-changed-since", part = title_of(&left.name)),
            advice: text!("enrol-changed-since-advice"),
        });
    }
    if let LibraryChange::Save(_, words, _) = &change
        && loaded.shown.index_of(words.name.as_str()).is_none()
        && folder.path().join(words.name.as_str()).exists()
    {
        let reloaded = library_cache.reload();
        reloaded.map_err(|error| UserError::of(&error))?;
        return Err(UserError {
            what: text!("enrol-other-program", name = words.name.as_str()),
            advice: text!("enrol-other-program-advice"),
        });
    }
    let change = match change {
        LibraryChange::ReadPath(name, file) => {
            let path = SprayPath::read_for(&file, &name).map_err(|error| UserError::of(&error))?;
            LibraryChange::SetPath(name, Some(path))
        }
        other => other,
    };
    let done = make(&change, folder, &title_of).map_err(|error| UserError::of(&error))?;
    let (what, back, name) = done;
    let left = PartVersion::current(name.clone(), folder);
    let is_there = !matches!(change, LibraryChange::Remove(_));
    let library = library_cache
        .reload()
        .map_err(|error| UserError::of(&error))?;
    Ok(Changed {
        what,
        back,
        left,
        name: is_there.then_some(name),
        library: Arc::clone(&library.shown),
    })
}

/// Makes the change; returns its description, its inverse, and the name of the part now.
fn make(
    change: &LibraryChange,
    folder: &LibraryFolder,
    title_of: &dyn Fn(&PartName) -> String,
) -> Result<(ChangeText, LibraryChange, PartName), LibraryError> {
    Ok(match change {
        LibraryChange::Save(enrolled, words, of) => {
            let part = described(&enrolled.part, words, of.as_ref());
            let Saved {
                replaced,
                left_path,
                ..
            } = folder.save(&part)?;
            let title = part.meta.shown_title();
            let brief = text!("enrol-saved", part = title);
            let whole = match &replaced {
                Some(_) if left_path => text!("enrol-saved-over-path", part = title),
                Some(_) => text!("enrol-saved-over", part = title),
                None => brief.clone(),
            };
            let name = words.name.clone();
            let back = LibraryChange::Remove(name.clone());
            (
                ChangeText { brief, whole },
                replaced.map_or(back, LibraryChange::Restore),
                name,
            )
        }
        LibraryChange::Rename(name, words) => {
            let before = folder.rename(name, words)?.before;
            let what = if before.name == words.name {
                text!("enrol-title-changed", part = name.as_str())
            } else {
                let [before, now] = [&before.name, &words.name].map(PartName::as_str);
                language::described(
                    &Message::new("renamed")
                        .with("before", before)
                        .with("now", now),
                )
            };
            let back = LibraryChange::Rename(words.name.clone(), before);
            (what.into(), back, words.name.clone())
        }
        LibraryChange::Remove(name) => {
            let kept = folder.remove(name)?;
            let what = text!("enrol-removed", part = title_of(name));
            (what.into(), LibraryChange::Restore(kept), name.clone())
        }
        LibraryChange::Restore(kept) => {
            let restored = folder.restore(kept)?;
            let name = restored.name;
            let what = text!("enrol-brought-back", part = title_of(&name));
            let back = LibraryChange::Remove(name.clone());
            let back = restored.replaced.map_or(back, LibraryChange::Restore);
            (what.into(), back, name)
        }
        LibraryChange::SetPath(name, path) => {
            // A damaged path cannot be brought back.
            let former = folder.spray_path(name.as_str()).ok().flatten();
            folder.set_spray_path(name, path.as_ref())?;
            let title = title_of(name);
            let what = match path {
                Some(path) => {
                    let count = path.points().len();
                    text!("enrol-stored-path", count = count, part = title)
                }
                None => text!("enrol-removed-path", part = title),
            };
            let back = LibraryChange::SetPath(name.clone(), former);
            (what.into(), back, name.clone())
        }
        LibraryChange::ReadPath(..) => unreachable!("it was read before"),
    })
}

/// Returns the part with the naming that a person gave it.
fn described(part: &Part, words: &PartNaming, of: Option<&PartName>) -> Part {
    Part {
        meta: PartMeta {
            name: words.name.clone(),
            title: words.title.clone(),
            notes: words.notes.clone(),
            // A part that replaces the part's own reference remains that part's own.
            part: of.filter(|of| **of != words.name).cloned(),
            ..part.meta.clone()
        },
        ..part.clone()
    }
}
