//! Storage of spray paths in a library, and of what `part.toml` says of painting and checking a surface.
//!
//! The file of a path is named after its checksum, which `part.toml` contains: a new path is written next to the old
//! one and becomes valid when `part.toml` names it; then the old one is deleted. At any moment one of them is complete. A
//! path that is stored again has the same name, so that its file is replaced as a whole.

use std::{fs, io};

use super::{
    entry::{SPRAY_PREFIX, rewrite_meta},
    error::LibraryError,
    name::PartName,
    part::{FileCheck, PartMeta},
    side::Side,
    spray_path::{SprayPath, SprayPathError},
    store::LibraryFolder,
    stored_part::read_spray_path,
    surface_zones::SurfaceZones,
};
use files::{disk, replace_file, sync_folder};

impl LibraryFolder {
    /// Reads the stored spray path of a part; `None` if none is stored.
    pub fn spray_path(&self, name: &str) -> Result<Option<SprayPath>, SprayPathError> {
        let (entry, meta) = self.entry_with_meta(name).map_err(Box::new)?;
        read_spray_path(&entry.path, &meta)
    }

    /// Stores the spray path of a part, or deletes it.
    pub fn set_spray_path(
        &self,
        name: &PartName,
        path: Option<&SprayPath>,
    ) -> Result<(), LibraryError> {
        self.entry(name.as_str())?;
        self.writing(|| {
            self.finish_interrupted_write()?;
            self.write_spray_path(name, path)
        })?
    }

    /// Sets the side that a part is painted from.
    pub fn set_side(&self, name: &PartName, side: Side) -> Result<(), LibraryError> {
        let side = Some(side);
        self.change_meta(name, |meta| PartMeta { side, ..meta })
    }

    /// Sets how the surface of a part is checked; `None` for not at all.
    pub fn set_surface(
        &self,
        name: &PartName,
        surface: Option<SurfaceZones>,
    ) -> Result<(), LibraryError> {
        if let Some(found) = surface.as_ref().and_then(SurfaceZones::problem) {
            let name = name.clone();
            return Err(LibraryError::BadZones { name, found });
        }
        self.change_meta(name, |meta| PartMeta { surface, ..meta })
    }

    /// Replaces the `part.toml` of a part.
    fn change_meta(
        &self,
        name: &PartName,
        change: impl FnOnce(PartMeta) -> PartMeta,
    ) -> Result<(), LibraryError> {
        self.entry(name.as_str())?;
        self.writing(|| {
            self.finish_interrupted_write()?;
            let meta = match self.entry_with_meta(name.as_str()) {
                Ok((_, meta)) => meta,
                Err(error) => return Ok(Err(error)),
            };
            rewrite_meta(&self.path().join(name.as_str()), &change(meta))?;
            Ok(Ok(()))
        })?
    }

    /// Like [`Self::set_spray_path`], but takes no lock: for a library that is still being built.
    pub fn write_spray_path(
        &self,
        name: &PartName,
        path: Option<&SprayPath>,
    ) -> io::Result<Result<(), LibraryError>> {
        let meta = match self.entry_with_meta(name.as_str()) {
            Ok((_, meta)) => meta,
            Err(error) => return Ok(Err(error)),
        };
        let folder = self.path().join(name.as_str());
        let text = path.map(SprayPath::to_text);
        let check = path.zip(text.as_ref());
        let check =
            check.map(|(path, text)| FileCheck::from_bytes(text.as_bytes(), path.points().len()));
        let file_name = check.as_ref().and_then(FileCheck::spray_file_name);
        if let (Some(text), Some(file_name)) = (&text, &file_name) {
            replace_file(&folder.join(file_name), text.as_bytes())?;
        }
        rewrite_meta(
            &folder,
            &PartMeta {
                spray: check,
                ..meta
            },
        )?;
        for found in fs::read_dir(&folder)? {
            let found = found?.path();
            let other = found
                .file_name()
                .and_then(|n| n.to_str())
                .filter(|n| n.starts_with(SPRAY_PREFIX) && Some(*n) != file_name.as_deref());
            if other.is_some() {
                disk::remove_file(&found)?;
            }
        }
        sync_folder(&folder)?;
        Ok(Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use nalgebra::{Point3, Vector3};

    use super::*;
    use crate::library::{
        PartNaming, PathPoint,
        place::open_library,
        shipped::{shipped_files, write_shipped},
    };

    fn path(x: f64) -> SprayPath {
        let point = PathPoint {
            nozzle: Point3::new(x, 0.0, 1.0),
            direction: Vector3::z_axis(),
            stand_off: None,
            is_gun_on: true,
            speed: None,
            fan: None,
        };
        SprayPath::new(vec![point; 3]).expect("points")
    }

    fn library() -> (tempfile::TempDir, LibraryFolder) {
        let folder = tempfile::tempdir().expect("a folder");
        write_shipped(folder.path()).expect("written");
        let library = LibraryFolder::open(folder.path()).expect("a library");
        (folder, library)
    }

    fn name(text: &str) -> PartName {
        PartName::new(text).expect("a name")
    }

    fn files_of_paths(folder: &Path) -> usize {
        let listed = fs::read_dir(folder).expect("listed");
        let names = listed.map(|found| found.expect("an entry").file_name());
        names
            .filter(|n| n.to_string_lossy().starts_with(SPRAY_PREFIX))
            .count()
    }

    #[test]
    fn a_path_is_stored_replaced_and_taken_away() {
        let (folder, library) = library();
        let fender = name("fender");
        assert_eq!(library.spray_path("fender").expect("read"), None);
        for x in [0.1, 0.25, 0.25] {
            library
                .set_spray_path(&fender, Some(&path(x)))
                .expect("stored");
            assert_eq!(library.spray_path("fender").expect("read"), Some(path(x)));
            assert_eq!(files_of_paths(&folder.path().join("fender")), 1);
        }
        library.set_spray_path(&fender, None).expect("taken away");
        assert_eq!(library.spray_path("fender").expect("read"), None);
        assert_eq!(files_of_paths(&folder.path().join("fender")), 0);
        assert!(matches!(
            library.set_spray_path(&name("no_such"), None),
            Err(LibraryError::NoSuchPart { .. })
        ));
    }

    #[test]
    fn a_path_that_is_stored_again_mends_its_damaged_file() {
        let (folder, library) = library();
        let fender = name("fender");
        let store = || library.set_spray_path(&fender, Some(&path(0.1)));
        store().expect("stored");
        let files = fs::read_dir(folder.path().join("fender")).expect("listed");
        let mut files = files.map(|found| found.expect("an entry").path());
        let file = files.find(|file| file.extension().is_some_and(|ending| ending == "csv"));
        let file = file.expect("a path");
        fs::write(&file, "x,y,z").expect("written");
        assert!(library.spray_path("fender").is_err());
        store().expect("stored");
        assert_eq!(library.spray_path("fender").expect("read"), Some(path(0.1)));
    }

    /// Makes each call of a change fail in turn; the fender's path must be the old or the new one.
    #[cfg(unix)]
    fn fails_at_every_call(
        test: &str,
        change: &(dyn Fn(&LibraryFolder) -> Result<(), LibraryError> + Sync),
    ) {
        use files::disk::faults::{Writer, with_advice};

        let open = |folder: &Path| LibraryFolder::open(folder).expect("a library");
        Writer {
            test,
            prepare: &|folder| {
                let to = folder.join("fender");
                fs::create_dir(&to).expect("made");
                for (file, content) in shipped_files("fender").expect("shipped") {
                    fs::write(to.join(file), content).expect("written");
                }
                let stored = open(folder).set_spray_path(&name("fender"), Some(&path(0.1)));
                stored.expect("stored");
            },
            write: &|folder| change(&open(folder)).map_err(|error| with_advice(&error)),
            state: &|folder| {
                let library = open(folder);
                let stored = library.spray_path("fender").expect("read").expect("a path");
                let words = library.words(&name("fender")).expect("read");
                format!("{} from {}", words.title, stored.points()[0].nozzle.x)
            },
            between: &[],
        }
        .fails_at_every_call();
    }

    #[cfg(unix)]
    #[test]
    fn whichever_call_fails_a_path_is_the_old_or_the_new() {
        fails_at_every_call(
            "library::spray_store::tests::whichever_call_fails_a_path_is_the_old_or_the_new",
            &|library| library.set_spray_path(&name("fender"), Some(&path(0.25))),
        );
    }

    #[cfg(unix)]
    #[test]
    fn whichever_call_fails_a_path_that_is_stored_again_is_there() {
        fails_at_every_call(
            "library::spray_store::tests::whichever_call_fails_a_path_that_is_stored_again_is_there",
            &|library| {
                library.set_spray_path(&name("fender"), Some(&path(0.1)))?;
                // A change that shows.
                let words = PartNaming {
                    title: "Left fender".into(),
                    ..library.words(&name("fender"))?
                };
                library.rename(&name("fender"), &words).map(|_| ())
            },
        );
    }

    #[test]
    fn zones_are_stored_with_their_part_and_bad_ones_change_nothing() {
        let (_folder, library) = library();
        let fender = name("fender");
        let params = stages::reference::ReferenceParams::default();
        let load = || library.load(&params).expect("loaded");
        let mut zones = SurfaceZones {
            check: true,
            ..SurfaceZones::default()
        };
        zones.rest().tolerance_mm = Some(2.0);
        let store = |zones: &SurfaceZones| library.set_surface(&fender, Some(zones.clone()));
        store(&zones).expect("stored");
        let mut bad = zones.clone();
        bad.rest().scrap_mm = Some(0.5);
        assert!(matches!(store(&bad), Err(LibraryError::BadZones { .. })));
        let loaded = load();
        assert!(loaded.problems.is_empty(), "{:?}", loaded.problems);
        assert_eq!(loaded.library.surface_zones.len(), 1);
        assert_eq!(loaded.library.surface_zones.get("fender"), Some(&zones));
        library.set_surface(&fender, None).expect("removed");
        assert!(load().library.surface_zones.is_empty());
    }

    #[test]
    fn a_path_goes_with_its_part() {
        let (folder, library) = library();
        let fender = name("fender");
        library
            .set_spray_path(&fender, Some(&path(0.1)))
            .expect("stored");
        let words = PartNaming {
            name: name("mudguard"),
            title: "Mudguard".into(),
            notes: String::new(),
        };
        library.rename(&fender, &words).expect("renamed");
        assert_eq!(
            library.spray_path("mudguard").expect("read"),
            Some(path(0.1))
        );
        let kept = library.remove(&words.name).expect("removed");
        library.restore(&kept).expect("restored");
        assert_eq!(
            library.spray_path("mudguard").expect("read"),
            Some(path(0.1))
        );
        // Copied the way people copy a library.
        let stick = tempfile::tempdir().expect("a stick");
        let copy = stick.path().join("mudguard");
        fs::create_dir(&copy).expect("made");
        for found in fs::read_dir(folder.path().join("mudguard")).expect("listed") {
            let from = found.expect("an entry").path();
            fs::copy(&from, copy.join(from.file_name().expect("a name"))).expect("copied");
        }
        let copied = open_library(Some(stick.path())).expect("a library");
        assert_eq!(
            copied.spray_path("mudguard").expect("read"),
            Some(path(0.1))
        );
    }

    #[test]
    fn a_part_that_is_enrolled_anew_has_no_path_and_its_former_one_keeps_it() {
        let (_folder, library) = library();
        let params = stages::reference::ReferenceParams::default();
        let stored = library
            .read("fender", &params)
            .expect("listed")
            .expect("read");
        let about = crate::library::PartDescription {
            name: name("fender"),
            title: String::new(),
            notes: String::new(),
            simulated: true,
            at: stored.meta.enrolled.at,
            from: "test".into(),
        };
        let anew = crate::library::enrol_whole(
            &stored.reference.cloud,
            &about,
            &crate::library::EnrolParams::default(),
        )
        .expect("enrolled");
        assert!(!library.save(&anew.part).expect("saved").left_path);
        library
            .set_spray_path(&name("fender"), Some(&path(0.1)))
            .expect("stored");
        let saved = library.save(&anew.part).expect("saved");
        assert!(saved.left_path);
        assert_eq!(library.spray_path("fender").expect("read"), None);
        library
            .restore(&saved.replaced.expect("kept"))
            .expect("restored");
        assert_eq!(library.spray_path("fender").expect("read"), Some(path(0.1)));
    }

    #[test]
    fn a_changed_path_is_refused_and_verify_names_it() {
        let (folder, library) = library();
        let fender = name("fender");
        library
            .set_spray_path(&fender, Some(&path(0.1)))
            .expect("stored");
        let params = stages::reference::ReferenceParams::default();
        assert!(
            library
                .verify(&params)
                .expect("verified")
                .warnings
                .is_empty()
        );
        let part = folder.path().join("fender");
        let listed = fs::read_dir(&part).expect("listed");
        let mut files = listed.map(|found| found.expect("an entry").path());
        let file = files
            .find(|path| path.extension().is_some_and(|e| e == "csv"))
            .expect("a path");
        let text = fs::read_to_string(&file).expect("text");
        fs::write(&file, text.replacen("100.000", "100.001", 1)).expect("written");
        assert!(matches!(
            library.spray_path("fender"),
            Err(SprayPathError::Changed { .. })
        ));
        let load = library.verify(&params).expect("verified");
        assert_eq!(load.library.references.len(), 8);
        assert!(
            load.warnings[0].to_string().contains("spray path"),
            "{}",
            load.warnings[0]
        );
        fs::remove_file(&file).expect("removed");
        assert!(matches!(
            library.spray_path("fender"),
            Err(SprayPathError::File(_))
        ));
    }
}
