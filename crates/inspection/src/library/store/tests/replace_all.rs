//! Replacing all parts at once.

use super::*;

/// Writes parts where they replace all others, as another program's version of this library would be.
fn write_all_parts(building: &Path, parts: &[Part]) -> io::Result<()> {
    for part in parts {
        let folder = building.join(part.meta.name.as_str());
        disk::create_dir(&folder)?;
        write_part(&folder, part)?;
    }
    write_file(&building.join("version"), b"2")
}

fn replace_all(library: &LibraryFolder, parts: &[Part]) -> Result<Vec<PathBuf>, LibraryError> {
    let replaced = library.replace_all::<()>(|building| {
        write_all_parts(building, parts)?;
        Ok(Ok(()))
    });
    replaced.map(|replaced| replaced.expect("not refused"))
}

#[test]
fn all_parts_are_replaced_and_what_differs_is_in_the_trash() {
    let (folder, library) = library();
    let same = part("same", 0.5);
    for part in [&same, &part("changed", 0.4), &part("gone", 0.6)] {
        library.save(part).expect("saved");
    }
    fs::write(folder.path().join("readme.txt"), "by hand").expect("written");
    let trashed = replace_all(&library, &[same, part("changed", 0.6), part("new", 0.4)]);
    let mut trashed = trashed.expect("replaced");
    trashed.sort();
    let names: Vec<_> = trashed.iter().map(|kept| files::file_name(kept)).collect();
    assert!(
        matches!(&names[..], [a, b] if a.starts_with("changed-") && b.starts_with("gone-")),
        "{names:?}"
    );
    assert_eq!(library.names().expect("listed"), ["changed", "new", "same"]);
    assert!(load(&library).problems.is_empty());
    let mut left: Vec<String> = fs::read_dir(folder.path())
        .expect("listed")
        .map(|found| {
            found
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    left.sort();
    assert_eq!(
        left,
        [
            ".lock",
            ".trash",
            "changed",
            "new",
            "readme.txt",
            "same",
            "version"
        ]
    );
    library.restore(&trashed[1]).expect("restored");
    assert!(
        library
            .names()
            .expect("listed")
            .contains(&"gone".to_owned())
    );
}

#[test]
fn a_refused_replacement_leaves_everything_as_it_is() {
    let (folder, library) = library();
    library.save(&part("plate", 0.5)).expect("saved");
    let refused = library.replace_all(|building| {
        write_all_parts(building, &[part("other", 0.4)])?;
        Ok(Err("not this one"))
    });
    assert_eq!(refused.expect("written"), Err("not this one"));
    assert_eq!(library.names().expect("listed"), ["plate"]);
    assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 2);
}

#[test]
fn what_lies_where_a_new_part_goes_is_moved_to_the_trash() {
    let (folder, library) = library();
    fs::write(folder.path().join("plate"), "a file").expect("written");
    let trashed = replace_all(&library, &[part("plate", 0.5)]).expect("replaced");
    assert_eq!(fs::read(&trashed[0]).expect("kept"), b"a file");
    assert_eq!(library.names().expect("listed"), ["plate"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_former_part_that_cannot_be_read_is_moved_to_the_trash_and_stops_no_writer() {
    let (folder, library) = library();
    // Not even root can read all of these files.
    let unreadable = Path::new("/proc/sys/vm");
    std::os::unix::fs::symlink(unreadable, folder.path().join("plate")).expect("linked");
    let trashed = replace_all(&library, &[part("plate", 0.5)]).expect("replaced");
    assert_eq!(fs::read_link(&trashed[0]).expect("kept"), unreadable);
    assert_eq!(load(&library).parts.len(), 1);
    library.save(&part("other", 0.4)).expect("saved");
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_all_parts_are_replaced_or_none() {
    use files::disk::faults::{Writer, with_advice};

    let open = |folder: &Path| LibraryFolder::open(folder).expect("there");
    let before = [part("same", 0.4), part("changed", 0.5), part("gone", 0.6)];
    let after = [part("same", 0.4), part("changed", 0.6), part("new", 0.5)];
    Writer {
        test: "library::store::tests::replace_all::whichever_call_fails_all_parts_are_replaced_or_none",
        prepare: &|folder| {
            for part in &before {
                open(folder).save(part).expect("saved");
            }
            fs::write(folder.join("version"), "1").expect("written");
        },
        write: &|folder| {
            let replaced = replace_all(&open(folder), &after);
            replaced.map(|_| ()).map_err(|error| with_advice(&error))
        },
        state: &|folder| {
            let library = open(folder);
            let load = load(&library);
            assert!(load.problems.is_empty(), "{:?}", load.problems);
            let clouds = |folder: PathBuf| -> Vec<Vec<u8>> {
                let found = fs::read_dir(folder).into_iter().flatten().flatten();
                found
                    .filter_map(|found| fs::read(found.path().join(CLOUD)).ok())
                    .collect()
            };
            let places = ["", ".replacement", ".remainder", TRASH];
            let kept = places.map(|place| clouds(folder.join(place))).concat();
            for part in &before {
                let cloud = crate::library::part::cloud_bytes(&part.cloud);
                assert!(kept.contains(&cloud), "{} is lost", part.meta.name);
            }
            let version = fs::read_to_string(library.file_beside_parts("version"));
            let parts = load.parts.iter().zip(&load.library.references);
            let parts = parts.map(|(meta, reference)| {
                format!("{} of {} points", meta.name, reference.cloud.points.len())
            });
            let parts = parts.collect::<Vec<_>>().join(", ");
            format!("{parts}, version {}", version.expect("there"))
        },
        between: &[],
    }
    .fails_at_every_call();
}
