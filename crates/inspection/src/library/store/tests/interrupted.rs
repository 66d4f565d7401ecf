//! Writers that are killed, and writers of which a call fails.

use super::*;

#[test]
fn a_writer_killed_half_way_leaves_nothing_that_is_read_and_the_next_one_clears_up() {
    let (_guard, library) = library();
    library.save(&part("plate", 0.4)).expect("saved");
    let half = library.path().join(".new-plate-abc");
    fs::create_dir(&half).expect("made");
    fs::write(half.join(META), "schema_version = 1\nna").expect("written");
    let loaded = load(&library);
    assert_eq!((loaded.parts.len(), loaded.problems.len()), (1, 0));
    library.save(&part("other", 0.5)).expect("saved");
    assert!(!half.exists());
}

#[test]
fn a_writer_killed_between_the_renames_loses_no_part() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.4)).expect("saved").folder;
    fs::rename(&folder, library.path().join(".old-plate")).expect("aside");
    let loaded = load(&library);
    assert_eq!(
        *loaded.library.references[0].cloud,
        part("plate", 0.4).cloud
    );
    assert_eq!(loaded.warnings[0].issue, EntryIssue::LeftAside);
    library.save(&part("other", 0.5)).expect("saved");
    assert!(folder.join(META).exists());
    assert!(load(&library).warnings.is_empty());
}

#[test]
fn a_writer_killed_before_the_trash_leaves_the_new_part() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.4)).expect("saved").folder;
    let aside = library.path().join(".old-plate");
    fs::rename(&folder, &aside).expect("aside");
    library.save(&part("unrelated", 0.5)).expect("saved");
    fs::rename(&folder, &aside).expect("aside");
    fs::rename(library.path().join("unrelated"), &folder).expect("a new one");
    assert_eq!(library.names().expect("listed"), ["plate"]);
    library.save(&part("other", 0.5)).expect("saved");
    assert!(!aside.exists());
    assert_eq!(
        fs::read_dir(library.path().join(TRASH))
            .expect("there")
            .count(),
        1
    );
}

#[test]
fn a_writer_killed_while_it_renames_leaves_one_of_the_two_names() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.4)).expect("saved").folder;
    let aside = library.path().join(".old-plate+sheet");
    fs::rename(&folder, &aside).expect("aside");
    assert_eq!(library.names().expect("listed"), ["plate"]);
    assert_eq!(load(&library).warnings[0].issue, EntryIssue::LeftAside);
    library.save(&part("other", 0.5)).expect("saved");
    assert_eq!(library.names().expect("listed"), ["other", "plate"]);
    fs::rename(&folder, &aside).expect("aside");
    fs::rename(library.path().join("other"), library.path().join("sheet")).expect("in place");
    assert_eq!(library.names().expect("listed"), ["sheet"]);
    library.save(&part("third", 0.6)).expect("saved");
    assert_eq!(library.trashed().expect("listed")[0].name.as_str(), "plate");
}

/// Makes each call of a change fail in turn; the library must stay intact and the plate must never be lost.
#[cfg(unix)]
fn fails_at_every_call(
    test: &str,
    change: &(dyn Fn(&LibraryFolder) -> Result<(), LibraryError> + Sync),
    between: &[&str],
) {
    use files::disk::faults::{Writer, with_advice};

    let plate = part("plate", 0.4);
    let open = |folder: &Path| LibraryFolder::open(folder).expect("there");
    Writer {
        test,
        prepare: &|folder| {
            open(folder).save(&plate).expect("saved");
        },
        write: &|folder| change(&open(folder)).map_err(|error| with_advice(&error)),
        state: &|folder| {
            let library = open(folder);
            let load = library.verify(&ReferenceParams::default()).expect("listed");
            assert!(load.problems.is_empty(), "{:?}", load.problems);
            let is_plate = |folder: &Path| {
                let cloud = fs::read(folder.join(CLOUD));
                cloud.is_ok_and(|bytes| bytes == crate::library::part::cloud_bytes(&plate.cloud))
            };
            let inside = |folder: PathBuf| fs::read_dir(folder).into_iter().flatten().flatten();
            let mut kept = inside(folder.to_owned()).chain(inside(folder.join(TRASH)));
            assert!(
                kept.any(|found| is_plate(&found.path())),
                "the plate is lost"
            );
            let parts = load.parts.iter().zip(&load.library.references);
            let parts = parts.map(|(meta, reference)| {
                format!("{} of {} points", meta.title, reference.cloud.points.len())
            });
            parts.collect::<Vec<_>>().join(", ")
        },
        between,
    }
    .fails_at_every_call();
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_part_is_replaced_or_not() {
    let new = part("plate", 0.5);
    fails_at_every_call(
        "library::store::tests::interrupted::whichever_call_fails_a_part_is_replaced_or_not",
        &|library| library.save(&new).map(|_| ()),
        &[],
    );
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_part_is_renamed_or_not() {
    fails_at_every_call(
        "library::store::tests::interrupted::whichever_call_fails_a_part_is_renamed_or_not",
        &|library| {
            let words = PartNaming {
                name: part_name("sheet"),
                title: "Sheet".into(),
                notes: String::new(),
            };
            library.rename(&part_name("plate"), &words).map(|_| ())
        },
        &[],
    );
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_part_is_removed_or_not() {
    fails_at_every_call(
        "library::store::tests::interrupted::whichever_call_fails_a_part_is_removed_or_not",
        &|library| library.remove(&part_name("plate")).map(|_| ()),
        &[],
    );
}
