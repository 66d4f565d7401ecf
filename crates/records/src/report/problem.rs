//! A problem report: what another person needs to see the same as the user, in one ZIP archive.

use std::{env::consts, fmt::Write as _, fs, path::Path};

use crate::history::{FrameError, write_frame};
use files::{FileError, file_name, folder_of, new_folder, read_bytes, write_atomically, write_zip};
use geometry::{error::Advice as _, parallel::num_cores};
use inspection::{
    library::{LibraryPlace, PartMeta, PartName},
    pipeline::{Inspection, NamedRecipe, RecipeFile},
};
use stages::scene::SceneCloud;

/// Name of the recipe in a report: that of a built-in recipe would be refused with other parameters.
const RECIPE: &str = "reported";

/// Name of the settings of the window in a report.
pub const SETTINGS_FILE: &str = "settings.toml";

/// The content of a problem report. No text in it may hold a token, a password or the address of a robot.
pub struct ProblemReport<'a> {
    /// The scene, if there is one.
    pub scene: Option<&'a SceneCloud>,
    /// Its [`InspectionLine`](super::InspectionLine).
    pub line: Option<&'a str>,
    /// The recipe that it was inspected with.
    pub recipe: &'a NamedRecipe,
    /// The library that it was compared with.
    pub library: Option<&'a LibraryPlace>,
    /// The entries of the library to enclose.
    pub entries: &'a [PartName],
    /// More lines about the computer, such as its graphics adapter.
    pub system: &'a [String],
    /// Other texts: names of the files, and contents.
    pub texts: &'a [(&'static str, String)],
}

/// The entries of the library for the part that the scene of an inspection is most like: it and its other references. `parts` are
/// those of the library, in its order.
pub fn compared_entries(inspection: &Inspection, parts: &[PartMeta]) -> Vec<PartName> {
    let best = inspection.ranking.entries.first();
    let Some(best) = best.and_then(|best| parts.get(best.reference)) else {
        return Vec::new();
    };
    let same = parts.iter();
    let same = same.filter(|part| part.part_name() == best.part_name());
    same.map(|part| part.name.clone()).collect()
}

impl ProblemReport<'_> {
    /// Writes the archive, whole or not at all. An entry of the library that cannot be read is named in the archive.
    pub fn write(&self, path: &Path) -> Result<(), FrameError> {
        let mut files = Vec::new();
        let mut not_enclosed = Vec::new();
        for name in self.entries {
            let Some(library) = self.library else {
                not_enclosed.push(format!(
                    "the library entry {name}: the library is not there"
                ));
                continue;
            };
            match library.contents_of(name) {
                Ok(contents) => {
                    let within = |(file, content): (String, Vec<u8>)| {
                        (format!("library/{name}/{file}"), content)
                    };
                    files.extend(contents.into_iter().map(within));
                }
                Err(error) => not_enclosed.push(format!("{error}; {}", error.advice())),
            }
        }
        if let Some(scene) = self.scene {
            files.extend(frame_files(scene, folder_of(path))?);
        }
        let mut texts = vec![
            ("read-me.txt", self.read_me(&files, &not_enclosed)),
            ("recipe.toml", recipe_text(self.recipe)),
            ("system.txt", self.system_text()),
        ];
        let line = self
            .line
            .map(|line| ("inspection.json", format!("{line}\n")));
        texts.extend(line);
        texts.extend_from_slice(self.texts);
        let texts = texts.into_iter();
        files.extend(texts.map(|(name, text)| (name.to_owned(), text.into_bytes())));
        write_atomically(path, |writer| write_zip(writer, &files))?;
        Ok(())
    }

    /// How to inspect the scene as the user did.
    fn read_me(&self, files: &[(String, Vec<u8>)], not_enclosed: &[String]) -> String {
        let mut text = "A problem report of Partsight.\n".to_owned();
        let is_json = |path: &str| Path::new(path).extension().is_some_and(|end| end == "json");
        let is_scene = |path: &str| path.starts_with("scene/scene.") && !is_json(path);
        let is_cell = |path: &str| path.starts_with("scene/empty-cell");
        let is_of_library = |path: &str| path.starts_with("library/");
        let path_of = |is_it: &dyn Fn(&str) -> bool| {
            let mut paths = files.iter().map(|(path, _)| path.as_str());
            paths.find(|path| is_it(path))
        };
        if let Some(scene) = path_of(&is_scene) {
            let library = path_of(&is_of_library).map_or("", |_| " --library library");
            let cell = path_of(&is_cell).map(|cell| format!(" --empty-cell {cell}"));
            let cell = cell.unwrap_or_default();
            // Writing to memory cannot fail.
            let _ = writeln!(
                text,
                "To inspect its scene again, unpack it and run there:\n\n    \
                 partsight inspect {scene}{library} --recipe recipe.toml{cell}\n"
            );
        }
        if !self.recipe.rack.is_empty() {
            let is_remembered = self.texts.iter().any(|(name, _)| *name == SETTINGS_FILE);
            text.push_str(if is_remembered {
                "The rack that it hung in is in settings.toml.\n"
            } else {
                "It hung in a rack, which is not enclosed: ask for its file, and add --rack FILE.\n"
            });
        }
        for reason in not_enclosed {
            let _ = writeln!(text, "Not enclosed: {reason}");
        }
        text
    }

    fn system_text(&self) -> String {
        let program = format!("Partsight {}", env!("CARGO_PKG_VERSION"));
        let system = format!("{} {}, {} cores", consts::OS, consts::ARCH, num_cores());
        let lines = [&[program, system][..], self.system].concat();
        lines.join("\n") + "\n"
    }
}

/// The files of a scene as the history keeps it, exact to the bit; `beside` is a folder that can be written to.
fn frame_files(scene: &SceneCloud, beside: &Path) -> Result<Vec<(String, Vec<u8>)>, FrameError> {
    let folder =
        new_folder(beside, ".report-").map_err(|error| FileError::writing(beside, error))?;
    write_frame(folder.path(), "scene", scene)?;
    let listed = fs::read_dir(folder.path()).and_then(|entries| {
        let paths = entries.map(|entry| Ok(entry?.path()));
        paths.collect::<Result<Vec<_>, _>>()
    });
    let mut paths = listed.map_err(|error| FileError::reading(folder.path(), error))?;
    paths.sort();
    let files = paths.into_iter().map(|path| {
        let content = read_bytes(&path)?;
        Ok((format!("scene/{}", file_name(&path)), content))
    });
    files.collect()
}

/// The recipe as a file, which says its name in its notes.
fn recipe_text(recipe: &NamedRecipe) -> String {
    let file = RecipeFile {
        name: PartName::new(RECIPE).expect("it keeps the rules of names"),
        notes: recipe.label.to_string(),
        recipe: (*recipe.parameters).clone(),
    };
    file.text()
}

#[cfg(test)]
mod tests {
    use super::*;
    use capture::read_image;
    use files::read_zip;
    use inspection::{fixtures::SHIPPED_PARTS, library::LibraryFolder, pipeline::Recipe};
    use stages::{fixtures::small_scene, scene::scene_from_image};

    /// Writes a report of a scene that was compared with an entry that is there and with one that is not.
    fn write(path: &Path) -> Result<(), FrameError> {
        let library = LibraryFolder::open(Path::new(SHIPPED_PARTS)).expect("there");
        ProblemReport {
            scene: Some(&*small_scene(1)),
            line: Some("{}"),
            recipe: &NamedRecipe::default(),
            library: Some(&LibraryPlace::Given(library)),
            entries: &["fender", "gone"].map(|name| PartName::new(name).expect("a name")),
            system: &["Graphics: llvmpipe".to_owned()],
            texts: &[("log.txt", "nothing".into())],
        }
        .write(path)
    }

    #[test]
    fn a_report_has_all_that_an_inspection_needs_and_names_what_it_lacks() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("problem.zip");
        write(&path).expect("written");
        let files = read_zip(&read_bytes(&path).expect("there"));
        let content = |name: &str| {
            let found = files.iter().find(|(path, _)| path == name);
            let (_, content) = found.unwrap_or_else(|| panic!("no {name}"));
            String::from_utf8_lossy(content).into_owned()
        };
        let read_me = content("read-me.txt");
        let command = "inspect scene/scene.png --library library --recipe recipe.toml\n";
        assert!(read_me.contains(command), "{read_me}");
        assert!(read_me.contains("no part named gone"), "{read_me}");
        assert!(content("system.txt").ends_with("\nGraphics: llvmpipe\n"));
        assert_eq!(content("log.txt"), "nothing");
        let recipe = RecipeFile::<Recipe>::parse(Path::new("recipe.toml"), &content("recipe.toml"));
        assert_eq!(recipe.expect("a recipe").recipe, Recipe::default());
        // Unpacked, they are a library and a scene.
        for (name, bytes) in &files {
            let path = folder.path().join("unpacked").join(name);
            fs::create_dir_all(folder_of(&path)).expect("made");
            fs::write(path, bytes).expect("written");
        }
        let unpacked = folder.path().join("unpacked");
        let library = LibraryFolder::open(&unpacked.join("library")).expect("there");
        let listing = library.list().expect("listed");
        assert_eq!((listing.parts.len(), listing.problems.len()), (1, 0));
        let (image, _) = read_image(&unpacked.join("scene/scene.png")).expect("a depth image");
        // As text, because missing readings are not equal.
        let points = |scene: &SceneCloud| format!("{:?}", scene.cloud.points);
        assert_eq!(points(&scene_from_image(image)), points(&small_scene(1)));
    }

    #[cfg(unix)]
    #[test]
    fn whichever_call_fails_a_report_is_there_whole_or_not_at_all() {
        use files::disk::faults::{Writer, with_advice};

        Writer {
            test: "report::problem::tests::whichever_call_fails_a_report_is_there_whole_or_not_at_all",
            prepare: &|_| (),
            write: &|folder| {
                write(&folder.join("problem.zip")).map_err(|error| with_advice(&error))
            },
            state: &|folder| match read_bytes(&folder.join("problem.zip")) {
                Ok(archive) => format!("{} files", read_zip(&archive).len()),
                Err(_) => "none".to_owned(),
            },
            between: &[],
        }
        .fails_at_every_call();
    }
}
