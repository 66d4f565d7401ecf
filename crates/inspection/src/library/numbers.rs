//! The numbers by which robots know the parts: `numbers.toml`, beside the parts.
//!
//! A part gets its number when one is first needed, and keeps it. It is one more than the greatest given, or the lowest free
//! one if there is no greater one. No number is ever given to another part, or a robot would run the wrong program: removed
//! parts keep their lines, and a number that lost its line is `retired`.
//!
//! The numbers are not in the parts' own folders because a folder copied from another library could bring a number that is
//! taken here, and because a part that was taken from a published version has to stay as it was published.

use std::{
    collections::{BTreeMap, BTreeSet},
    io,
    path::Path,
};

use serde::{Deserialize, Serialize};

use super::{error::LibraryError, name::PartName, store::LibraryFolder};
use files::{FileError, read_limited, replace_file};

/// Name of the file.
const NUMBERS: &str = "numbers.toml";
/// Greatest number: up to here a controller's 32-bit real holds whole numbers exactly.
const MAX_NUMBER: u32 = (1 << 24) - 1;
/// Size limit of the file, bytes: ten thousand parts.
const MAX_BYTES: u64 = 1 << 20;

const HEAD: &str = "\
# The numbers by which robots know the parts. Change them only together with the robots' programs.
# Keep the lines of removed parts, or their numbers are given to other parts.
";

/// The number of each part that ever got one.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartNumbers {
    /// Numbers of removed parts whose names other parts have taken.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    retired: BTreeSet<u32>,
    #[serde(default)]
    parts: BTreeMap<PartName, u32>,
}

/// The numbers of all parts, to be used now.
#[derive(Debug)]
pub struct GivenNumbers {
    /// The numbers.
    pub numbers: PartNumbers,
    /// Why new ones could not be stored, if so: they change when a part is added or removed.
    pub unstored: Option<LibraryError>,
}

impl PartNumbers {
    /// Returns the number of a part, from 1; `None` if it has none.
    pub fn number_of(&self, part: &PartName) -> Option<u32> {
        self.parts.get(part).copied()
    }

    /// True if no part has a number.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Returns the numbers in the order of the parts' names.
    pub fn all(&self) -> impl Iterator<Item = (&PartName, u32)> {
        self.parts.iter().map(|(part, number)| (part, *number))
    }

    /// Takes in the numbers that are published with a version of the library; `before` are those of the version taken
    /// before. Parts that have a number here keep it, also those that the publisher has renamed since. A part whose
    /// published number is another part's here is left out, and gets a new one when it is needed.
    pub fn add_published(&mut self, published: &Self, before: &Self) {
        let former = std::mem::take(&mut self.parts);
        for (part, number) in &published.parts {
            let mut names = before.parts.iter();
            let known_as = names.find(|(_, known)| *known == number);
            let known_as = known_as.map_or(part, |(name, _)| name);
            // In the version before, the name may have been another part's.
            let is_it = before
                .number_of(known_as)
                .is_none_or(|known| known == *number);
            if let Some(kept) = former.get(known_as).filter(|_| is_it) {
                self.insert_free(part, *kept);
            }
        }
        for (part, number) in &former {
            if self.is_free(*number) && published.parts.contains_key(part) {
                // Another part has this name now.
                self.retired.insert(*number);
            }
            self.insert_free(part, *number);
        }
        for (part, number) in &published.parts {
            self.insert_free(part, *number);
        }
        for number in &published.retired {
            if self.is_free(*number) {
                self.retired.insert(*number);
            }
        }
    }

    /// Reads the content of the file.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let wrong = |error: toml::de::Error| error.message().to_owned();
        let read: Self = toml::from_str(text).map_err(wrong)?;
        let mut checked = Self {
            retired: read.retired,
            ..Self::default()
        };
        for (part, number) in read.parts {
            if !checked.is_free(number) {
                return Err(format!(
                    "the number {number} of {part} is another part's, or not from 1 to {MAX_NUMBER}"
                ));
            }
            checked.parts.insert(part, number);
        }
        Ok(checked)
    }

    /// Replaces the file in this folder atomically. In a library only under its lock.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        let lines = toml::to_string(self).map_err(io::Error::other)?;
        replace_file(&folder.join(NUMBERS), [HEAD, &lines].concat().as_bytes())
    }

    /// Gives the next numbers to those of these parts that have none.
    fn number_rest(&mut self, parts: impl Iterator<Item = PartName>) {
        let given: BTreeSet<u32> = self.parts.values().chain(&self.retired).copied().collect();
        let last = given.last().copied().unwrap_or(0);
        let lower = (1..last).filter(|number| !given.contains(number));
        let mut free = (last + 1..=MAX_NUMBER).chain(lower);
        for part in parts {
            if !self.parts.contains_key(&part)
                && let Some(number) = free.next()
            {
                self.parts.insert(part, number);
            }
        }
    }

    /// Moves the number of a part to its new name.
    fn rename(&mut self, from: &PartName, to: &PartName) {
        // Of a removed part of that name.
        self.retired.extend(self.parts.remove(to));
        if let Some(number) = self.parts.remove(from) {
            self.parts.insert(to.clone(), number);
        }
    }

    /// Gives a part this number, unless the part has one or the number was given before.
    fn insert_free(&mut self, part: &PartName, number: u32) {
        if self.is_free(number) && !self.parts.contains_key(part) {
            self.parts.insert(part.clone(), number);
        }
    }

    fn is_free(&self, number: u32) -> bool {
        let is_given =
            self.retired.contains(&number) || self.parts.values().any(|given| *given == number);
        (1..=MAX_NUMBER).contains(&number) && !is_given
    }
}

impl LibraryFolder {
    /// Returns the stored numbers.
    pub fn numbers(&self) -> Result<PartNumbers, LibraryError> {
        let path = self.file_beside_parts(NUMBERS);
        let read = match read_limited(&path, MAX_BYTES) {
            Err(FileError::NotFound { .. }) => return Ok(PartNumbers::default()),
            Err(error) => Err(error.to_string()),
            Ok(bytes) => match str::from_utf8(&bytes) {
                Ok(text) => PartNumbers::parse(text),
                Err(_) => Err("it is not text".into()),
            },
        };
        read.map_err(|reason| LibraryError::BadNumbers { path, reason })
    }

    /// Returns the stored numbers and, for the other parts, the ones that they would get now.
    pub(super) fn numbers_to_give(&self) -> Result<PartNumbers, LibraryError> {
        let mut numbers = self.numbers()?;
        let names = self.names()?.into_iter();
        numbers.number_rest(names.filter_map(|name| PartName::new(&name).ok()));
        Ok(numbers)
    }

    /// Gives a number to every part that has none, damaged parts included, and stores it. Returns all numbers.
    pub fn give_numbers(&self) -> Result<PartNumbers, LibraryError> {
        let stored = self.numbers()?;
        if self.numbers_to_give()? == stored {
            return Ok(stored);
        }
        self.writing(|| {
            self.finish_interrupted_write()?;
            // Again, because another program may have given some meanwhile.
            let given = self.numbers_to_give();
            if let Ok(numbers) = &given {
                numbers.write(self.path())?;
            }
            Ok(given)
        })?
    }

    /// Lets a part keep its number under its new name. Only under the lock. If the numbers cannot be read, the part must
    /// not be renamed, or it would lose its number.
    pub(super) fn carry_number(
        &self,
        from: &PartName,
        to: &PartName,
    ) -> io::Result<Result<(), LibraryError>> {
        let before = match self.numbers() {
            Ok(before) => before,
            Err(error) => return Ok(Err(error)),
        };
        let mut numbers = before.clone();
        numbers.rename(from, to);
        if numbers != before {
            numbers.write(self.path())?;
        }
        Ok(Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use std::{fs, thread};

    use super::*;
    use crate::{fixtures::copy_library, library::PartNaming};
    use geometry::error::Advice as _;

    fn name(name: &str) -> PartName {
        name.parse().expect("a name")
    }

    /// A copy of the shipped parts without their numbers.
    fn library() -> (tempfile::TempDir, LibraryFolder) {
        let folder = tempfile::tempdir().expect("a folder");
        copy_library(folder.path());
        let library = LibraryFolder::open(folder.path()).expect("there");
        (folder, library)
    }

    fn number_of(library: &LibraryFolder, part: &str) -> Option<u32> {
        library.numbers().expect("read").number_of(&name(part))
    }

    fn rename(library: &LibraryFolder, from: &str, to: &str) {
        let words = PartNaming {
            name: name(to),
            ..library.words(&name(from)).expect("read")
        };
        library.rename(&name(from), &words).expect("renamed");
    }

    /// Copies a part to another name, as a person would by hand.
    fn copy_by_hand(library: &LibraryFolder, from: &str, to: &str) {
        let [from_path, to_path] = [from, to].map(|part| library.path().join(part));
        fs::create_dir(&to_path).expect("made");
        for file in library.files_of(&name(from)).expect("listed") {
            let to_file = to_path.join(file.file_name().expect("a name"));
            fs::copy(&file, to_file).expect("copied");
        }
        let meta = fs::read_to_string(from_path.join("part.toml")).expect("read");
        let meta = meta.replace(&format!("name = \"{from}\""), &format!("name = \"{to}\""));
        fs::write(to_path.join("part.toml"), meta).expect("written");
    }

    #[test]
    fn parts_that_come_and_go_move_no_other_number() {
        let (_guard, library) = library();
        assert!(library.numbers().expect("none yet").is_empty());
        let first = library.give_numbers().expect("given");
        let in_order: Vec<u32> = first.all().map(|(_, number)| number).collect();
        assert_eq!(in_order, [1, 2, 3, 4, 5, 6, 7, 8]);
        // The last one goes, others come: before it, and after it.
        let gone = library.remove(&name("trunk_lid")).expect("removed");
        copy_by_hand(&library, "fender", "a_new_one");
        copy_by_hand(&library, "fender", "zz_new_one");
        let second = library.give_numbers().expect("given");
        for (part, number) in first.all() {
            assert_eq!(second.number_of(part), Some(number), "{part}");
        }
        assert_eq!(number_of(&library, "a_new_one"), Some(9));
        assert_eq!(number_of(&library, "zz_new_one"), Some(10));
        library.restore(&gone).expect("restored");
        let third = library.give_numbers().expect("given");
        assert_eq!(third, second);
        assert_eq!(third.number_of(&name("trunk_lid")), Some(8));
    }

    #[test]
    fn a_renamed_part_takes_its_number_along_and_leaves_none_to_another() {
        let (_guard, library) = library();
        library.give_numbers().expect("given");
        library.remove(&name("grille")).expect("removed");
        rename(&library, "fender", "grille");
        assert_eq!(number_of(&library, "grille"), Some(3));
        assert_eq!(number_of(&library, "fender"), None);
        copy_by_hand(&library, "grille", "fender");
        copy_by_hand(&library, "grille", "hood");
        library.give_numbers().expect("given");
        // 6 was the grille's that was removed.
        assert_eq!(number_of(&library, "fender"), Some(9));
        assert_eq!(number_of(&library, "hood"), Some(10));
        // A part without a number does not get that of a removed one.
        library.remove(&name("hood")).expect("removed");
        copy_by_hand(&library, "grille", "lid");
        rename(&library, "lid", "hood");
        library.give_numbers().expect("given");
        assert_eq!(number_of(&library, "hood"), Some(11));
    }

    #[test]
    fn programs_that_need_numbers_at_the_same_time_get_the_same_ones() {
        let (_guard, library) = library();
        let given: Vec<PartNumbers> = thread::scope(|scope| {
            let threads = [(); 4].map(|()| scope.spawn(|| library.give_numbers().expect("given")));
            threads
                .map(|thread| thread.join().expect("no panic"))
                .into()
        });
        assert!(given.iter().all(|numbers| *numbers == given[0]));
        assert_eq!(given[0], library.numbers().expect("read"));
    }

    #[test]
    fn a_file_that_gives_one_number_twice_is_refused_and_left_alone() {
        let (_guard, library) = library();
        let path = library.path().join(NUMBERS);
        for text in [
            "[parts]\nfender = 1\ngrille = 1\n",
            "retired = [1]\n[parts]\nfender = 1\n",
            "[parts]\nfender = 0\n",
            "[parts]\nfender = 16777216\n",
            "[parts]\nfender = \"1\"\n",
            "[parts]\nThe Fender = 1\n",
            "[parts\n",
            "",
        ] {
            fs::write(&path, text).expect("written");
            let error = library.give_numbers().expect_err(text);
            assert!(
                matches!(error, LibraryError::BadNumbers { .. }),
                "{text}: {error}"
            );
            assert!(error.advice().contains("copy"), "{}", error.advice());
            let before = library.words(&name("fender")).expect("read");
            let words = PartNaming {
                name: name("door"),
                ..before.clone()
            };
            let refused = library.rename(&name("fender"), &words).expect_err(text);
            assert!(
                matches!(refused, LibraryError::BadNumbers { .. }),
                "{text}: {refused}"
            );
            assert_eq!(library.words(&name("fender")).expect("there"), before);
            assert!(!library.path().join("door").exists());
            // Everything else about the library works, such as another title.
            rename(&library, "fender", "fender");
            assert_eq!(fs::read_to_string(&path).expect("read"), text);
        }
        fs::write(&path, "[parts]\nhood = 10\nfender = 30\n").expect("written");
        let numbers = library.give_numbers().expect("given");
        assert_eq!(numbers.number_of(&name("fender")), Some(30));
        assert_eq!(numbers.number_of(&name("back_bumper")), Some(31));
        let text = fs::read_to_string(&path).expect("read");
        assert!(
            text.starts_with("# The numbers") && text.contains("hood = 10\n"),
            "{text}"
        );
    }

    #[test]
    fn once_the_greatest_number_is_given_the_lowest_free_ones_are() {
        let text = "retired = [2]\n[parts]\ndoor = 1\nfender = 16777214\ngone = 3\n";
        let mut numbers = PartNumbers::parse(text).expect("sound");
        numbers.number_rest(["door", "grille", "hood", "wheel"].map(name).into_iter());
        let given = ["door", "grille", "hood", "wheel"].map(|part| numbers.number_of(&name(part)));
        assert_eq!(given, [Some(1), Some(MAX_NUMBER), Some(4), Some(5)]);
    }

    #[test]
    fn published_numbers_change_none_that_was_given_here() {
        let parse = |text: &str| PartNumbers::parse(text).expect("sound");
        let published = parse("retired = [9]\n[parts]\ndoor = 1\nfender = 2\ngrille = 3\n");
        let mut fresh = PartNumbers::default();
        fresh.add_published(&published, &PartNumbers::default());
        assert_eq!(fresh, published);

        let mut here = parse("[parts]\nfender = 1\ngrille = 7\n");
        here.add_published(&published, &PartNumbers::default());
        let of = |part: &str| here.number_of(&name(part));
        assert_eq!(
            [of("fender"), of("grille"), of("door")],
            [Some(1), Some(7), None]
        );
        here.number_rest([name("door")].into_iter());
        assert_eq!(here.number_of(&name("door")), Some(10), "9 is retired");
    }

    #[test]
    fn parts_that_the_publisher_renames_keep_their_numbers_here() {
        let parse = |text: &str| PartNumbers::parse(text).expect("sound");
        let before = parse("[parts]\ndoor = 1\nfender = 2\ngrille = 3\n");
        let mut here = parse("[parts]\ndoor = 1\nfender = 7\ngrille = 3\nmine = 4\n");
        // Door and grille have changed their names; the fender is a wing, and another part is the fender.
        let published = parse("[parts]\nfender = 4\nwing = 2\ngrille = 1\ndoor = 3\n");
        here.add_published(&published, &before);
        let expected = parse("[parts]\ndoor = 3\ngrille = 1\nmine = 4\nwing = 7\n");
        assert_eq!(here, expected);
        here.number_rest([name("fender")].into_iter());
        assert_eq!(here.number_of(&name("fender")), Some(8));
    }
}
