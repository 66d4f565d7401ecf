mod damage;
mod interrupted;
mod rename;
mod replace_all;

use std::sync::{Arc, Mutex};

use jiff::Timestamp;
use nalgebra::Point3;

use super::{super::trash::TRASH, *};
use crate::library::{
    EnrolParams, EntryError, EntryIssue, LibraryLoad, PartDescription, enrol_whole,
};
use geometry::{
    cloud::PointCloud,
    error::{Advice as _, lock},
};
use stages::reference::ReferenceParams;

/// Creates an L-shaped plate in front of the camera; `width` in metres distinguishes one from another. Each is enrolled once,
/// and then gets its name.
fn part(name: &str, width: f32) -> Part {
    static ENROLLED: Mutex<Vec<(f32, Part)>> = Mutex::new(Vec::new());
    let mut all = lock(&ENROLLED);
    let is_this = |(of, _): &(f32, Part)| of.to_bits() == width.to_bits();
    let place = all.iter().position(is_this);
    let place = place.unwrap_or_else(|| {
        all.push((width, enrolled(width)));
        all.len() - 1
    });
    let mut part = all[place].1.clone();
    part.meta.name = part_name(name);
    part
}

fn enrolled(width: f32) -> Part {
    let across = (width / 0.005) as usize;
    let points = (0..across * 80).filter_map(|i| {
        let (x, y) = ((i % across) as f32 * 0.005, (i / across) as f32 * 0.005);
        (x < 0.15 || y < 0.2).then(|| Point3::new(x, y, 1.2))
    });
    let about = PartDescription {
        name: part_name("plate"),
        title: "Plate".into(),
        notes: "hung by two hooks\n\"left\"".into(),
        from: "a test".into(),
        at: Timestamp::UNIX_EPOCH,
        simulated: true,
    };
    enrol_whole(
        &PointCloud::from_points(points),
        &about,
        &EnrolParams::default(),
    )
    .expect("an outline")
    .part
}

fn part_name(text: &str) -> PartName {
    PartName::new(text).expect("a name")
}

fn library() -> (tempfile::TempDir, LibraryFolder) {
    let folder = tempfile::tempdir().expect("a folder");
    let library = LibraryFolder::open(folder.path()).expect("there");
    (folder, library)
}

fn load(library: &LibraryFolder) -> LibraryLoad {
    library.load(&ReferenceParams::default()).expect("listed")
}

/// Creates a library with the parts `damaged` and `sound`; also returns the folder of the first.
fn two_parts() -> (tempfile::TempDir, LibraryFolder, PathBuf) {
    let (guard, library) = library();
    library.save(&part("sound", 0.5)).expect("saved");
    let damaged = library.save(&part("damaged", 0.4)).expect("saved").folder;
    (guard, library, damaged)
}

#[test]
fn a_saved_part_comes_back_as_it_was() {
    let (_guard, library) = library();
    for (name, width) in [("b", 0.5), ("a", 0.4), ("c", 0.6)] {
        assert_eq!(
            library.save(&part(name, width)).expect("saved").replaced,
            None
        );
    }
    let load = library.verify(&ReferenceParams::default()).expect("listed");
    assert!(load.problems.is_empty(), "{:?}", load.problems);
    assert!(load.warnings.is_empty(), "{:?}", load.warnings);
    let names: Vec<_> = load.parts.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "c"]);
    let saved = part("b", 0.5);
    assert_eq!(load.parts[1], saved.meta);
    assert_eq!(load.library.references[1].name, "b");
    assert_eq!(*load.library.references[1].cloud, saved.cloud);
}

#[test]
fn only_the_changed_parts_of_a_library_are_prepared_again() {
    let (_guard, library) = library();
    for i in 0..20 {
        let name = format!("part_{i}");
        library.save(&part(&name, 0.5)).expect("saved");
    }
    let former = load(&library).library;
    let prepared_again = |params: &ReferenceParams| -> Vec<String> {
        let load = library.load_after(params, &former).expect("listed");
        let both = load.library.references.iter().zip(&former.references);
        let again = both.filter(|(now, before)| !Arc::ptr_eq(&now.cloud, &before.cloud));
        again.map(|(now, _)| now.enrolled_as.clone()).collect()
    };
    let mut params = ReferenceParams::default();
    assert_eq!(prepared_again(&params), [""; 0]);
    library.save(&part("part_7", 0.4)).expect("saved");
    assert_eq!(prepared_again(&params), ["part_7"]);
    let mut cut = part("part_3", 0.5);
    cut.meta.cut.left = Some(-0.1);
    library.save(&cut).expect("saved");
    assert_eq!(prepared_again(&params), ["part_3", "part_7"]);
    let mut second = part("part_5", 0.5);
    second.meta.part = Some(part_name("part_1"));
    library.save(&second).expect("saved");
    let load = library.load_after(&params, &former).expect("listed");
    let second = load
        .library
        .references
        .iter()
        .find(|one| one.enrolled_as == "part_5");
    let before = former.references.iter().find(|one| one.name == "part_5");
    let (second, before) = (second.expect("there"), before.expect("there"));
    assert!(second.name == "part_1" && Arc::ptr_eq(&second.cloud, &before.cloud));
    params.signature.num_rays = 128;
    assert_eq!(prepared_again(&params).len(), 20);
}

#[test]
fn a_part_is_a_few_small_files_that_a_person_can_read() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.5)).expect("saved").folder;
    let mut files: Vec<_> = fs::read_dir(&folder)
        .expect("listed")
        .map(|f| f.expect("a file").file_name().into_string().expect("text"))
        .collect();
    files.sort();
    assert_eq!(files, [CLOUD, META, SIGNATURE, THUMBNAIL]);
    let meta = fs::read_to_string(folder.join(META)).expect("text");
    assert!(
        meta.contains("schema_version = 1\nname = \"plate\"\n"),
        "{meta}"
    );
    let thumbnail = image::open(folder.join(THUMBNAIL))
        .expect("a picture")
        .to_rgba8();
    assert_eq!(thumbnail.dimensions(), (160, 120));
    let num_drawn = thumbnail.pixels().filter(|p| p.0[3] > 200).count();
    assert!(num_drawn > 2000, "{num_drawn} pixels show the part");
}

#[test]
fn a_replaced_and_a_removed_part_lie_in_the_trash_whole() {
    let (_guard, library) = library();
    library.save(&part("plate", 0.4)).expect("saved");
    let replaced = library.save(&part("plate", 0.5)).expect("saved").replaced;
    let name = part_name("plate");
    let removed = library.remove(&name).expect("removed");
    assert!(load(&library).parts.is_empty());
    for (trash, width) in [(replaced.expect("one was there"), 0.4), (removed, 0.5)] {
        fs::rename(&trash, library.path().join("plate")).expect("moved back by hand");
        assert_eq!(
            *load(&library).library.references[0].cloud,
            part("plate", width).cloud
        );
        fs::rename(library.path().join("plate"), &trash).expect("and away");
    }
    assert!(matches!(
        library.remove(&name),
        Err(LibraryError::NoSuchPart { .. })
    ));
}

#[test]
fn a_part_with_references_of_its_own_does_not_become_one_of_another_part() {
    let (_guard, library) = library();
    let save = |name: &str, of: Option<&str>| {
        let mut part = part(name, 0.4);
        part.meta.part = of.map(part_name);
        library.save(&part)
    };
    for (name, of) in [("door", None), ("gate", None), ("gate_b", Some("gate"))] {
        save(name, of).expect("saved");
    }
    let error = save("gate", Some("door")).expect_err("gate_b would have no part");
    assert!(error.to_string().contains("gate_b"), "{error}");
    assert!(error.advice().contains("library rename gate"));
    save("gate", None).expect("still a part of its own");
    save("gate_b", Some("door")).expect("has none");
    save("gate", Some("door")).expect("has none any more");
}

#[test]
fn folders_that_are_no_parts_by_their_name_are_told() {
    let (_guard, library) = library();
    library.save(&part("plate", 0.4)).expect("saved");
    fs::create_dir(library.path().join("My Door")).expect("made");
    assert_eq!(library.skipped().expect("listed"), ["My Door"]);
    assert!(!library.is_itself_a_part());
    let inner = LibraryFolder::open(&library.path().join("plate")).expect("there");
    assert!(inner.is_itself_a_part());
}

#[test]
fn other_things_on_the_stick_are_no_parts() {
    let (_guard, library) = library();
    library.save(&part("plate", 0.4)).expect("saved");
    fs::create_dir(library.path().join("System Volume Information")).expect("made");
    fs::write(library.path().join("README.md"), "hello").expect("written");
    assert_eq!(library.names().expect("listed"), ["plate"]);
}

#[test]
fn a_missing_folder_and_a_file_are_named_errors() {
    let guard = tempfile::tempdir().expect("a folder");
    let path = guard.path().join("library");
    assert!(matches!(
        LibraryFolder::open(&path),
        Err(LibraryError::NotFound { .. })
    ));
    fs::write(&path, "x").expect("written");
    assert!(matches!(
        LibraryFolder::open(&path),
        Err(LibraryError::NotAFolder { .. })
    ));
    assert!(matches!(
        LibraryFolder::open_or_create(&path.join("deeper")),
        Err(LibraryError::Unreadable { .. } | LibraryError::Unwritable { .. })
    ));
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_written_is_a_named_error() {
    // Not even root can create files there.
    let library = LibraryFolder::open(Path::new("/proc/self/fdinfo")).expect("there");
    let failed = library.save(&part("plate", 0.4));
    assert!(
        matches!(failed, Err(LibraryError::Unwritable { .. })),
        "{failed:?}"
    );
}

#[test]
fn two_writers_at_once_both_succeed() {
    let (_guard, library) = library();
    std::thread::scope(|scope| {
        for name in ["a", "b", "a", "b"] {
            let library = &library;
            scope.spawn(move || library.save(&part(name, 0.4)).expect("saved"));
        }
    });
    assert_eq!(library.names().expect("listed"), ["a", "b"]);
    assert!(load(&library).problems.is_empty());
}

#[test]
fn what_was_removed_or_replaced_is_restored_and_nothing_is_lost_by_it() {
    let (_guard, library) = library();
    library.save(&part("plate-2", 0.4)).expect("saved");
    let replaced = library.save(&part("plate-2", 0.5)).expect("saved").replaced;
    let restored = library.restore(&replaced.expect("kept")).expect("restored");
    assert_eq!(restored.name.as_str(), "plate-2");
    let width = |library: &LibraryFolder| load(library).library.references[0].cloud.clone();
    assert_eq!(*width(&library), part("plate-2", 0.4).cloud);
    library
        .restore(&restored.replaced.expect("kept"))
        .expect("and back");
    assert_eq!(*width(&library), part("plate-2", 0.5).cloud);
    let removed = library.remove(&restored.name).expect("removed");
    assert_eq!(library.restore(&removed).expect("restored").replaced, None);
    assert_eq!(*width(&library), part("plate-2", 0.5).cloud);
}

#[test]
fn only_what_lies_in_the_trash_is_restored() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.4)).expect("saved").folder;
    let trash = library.path().join(TRASH);
    fs::create_dir_all(trash.join("notes")).expect("made");
    let outside = tempfile::tempdir().expect("a folder");
    let elsewhere = outside.path().join("plate-20260102T030405Z");
    fs::create_dir(&elsewhere).expect("made");
    let missing = trash.join("plate-20260102T030405Z");
    for kept in [&folder, &trash.join("notes"), &elsewhere, &missing] {
        let refused = library.restore(kept).expect_err("refused");
        assert!(
            matches!(refused, LibraryError::NotInTrash { .. }),
            "{kept:?}: {refused}"
        );
    }
    assert!(library.trashed().expect("listed").is_empty() && folder.exists());
}
