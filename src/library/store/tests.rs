use jiff::Timestamp;
use nalgebra::Point3;

use super::*;
use crate::{
    geometry::cloud::PointCloud,
    library::{About, EnrolParams, EntryError, LibraryLoad, Trouble, enrol_whole},
    stages::reference::ReferenceParams,
};

/// An L-shaped plate before the camera; `width` in metres tells one from another.
fn part(name: &str, width: f32) -> Part {
    let across = (width / 0.005) as usize;
    let points = (0..across * 80).filter_map(|i| {
        let (x, y) = ((i % across) as f32 * 0.005, (i / across) as f32 * 0.005);
        (x < 0.15 || y < 0.2).then(|| Point3::new(x, y, 1.2))
    });
    let about = About {
        name: PartName::new(name).expect("a name"),
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

fn library() -> (tempfile::TempDir, LibraryFolder) {
    let folder = tempfile::tempdir().expect("a folder");
    let library = LibraryFolder::open(folder.path()).expect("there");
    (folder, library)
}

fn load(library: &LibraryFolder) -> LibraryLoad {
    library.load(&ReferenceParams::default()).expect("listed")
}

fn problem(load: &LibraryLoad) -> &EntryError {
    assert_eq!(load.problems.len(), 1, "{:?}", load.problems);
    assert_eq!(load.problems[0].entry, "damaged");
    assert!(!load.problems[0].advice().is_empty());
    let loaded: Vec<_> = load.library.references.iter().map(|r| &r.name).collect();
    assert_eq!(loaded, ["sound"]);
    &load.problems[0].reason
}

/// A library with the parts `damaged` and `sound`, and the folder of the first.
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
    assert_eq!(load.library.references[1].cloud, saved.cloud);
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
    let name = PartName::new("plate").expect("a name");
    let removed = library.remove(&name).expect("removed");
    assert!(load(&library).parts.is_empty());
    for (trash, width) in [(replaced.expect("one was there"), 0.4), (removed, 0.5)] {
        fs::rename(&trash, library.path().join("plate")).expect("moved back by hand");
        assert_eq!(
            load(&library).library.references[0].cloud,
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
    assert_eq!(loaded.library.references[0].cloud, part("plate", 0.4).cloud);
    assert_eq!(loaded.warnings[0].trouble, Trouble::LeftAside);
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
fn a_damaged_description_is_named_and_the_others_load() {
    let (_guard, library, damaged) = two_parts();
    for text in [
        "",
        "schema_version = ",
        "schema_version = 1\nname = \"../sound\"",
        "\u{0}",
    ] {
        fs::write(damaged.join(META), text).expect("written");
        assert!(
            matches!(problem(&load(&library)), EntryError::BadMeta { .. }),
            "{text:?}"
        );
    }
    fs::write(damaged.join(META), [0xff, 0xfe, 0x00]).expect("written");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::BadMeta { .. }
    ));
    fs::remove_file(damaged.join(META)).expect("removed");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::Missing { file: META }
    ));
    assert!(damaged.join(CLOUD).exists(), "nothing was touched");
}

#[test]
fn a_newer_schema_is_refused_in_words_whatever_else_it_says() {
    let (_guard, library, damaged) = two_parts();
    fs::write(damaged.join(META), "schema_version = 2\ncolour = \"red\"\n").expect("written");
    let loaded = load(&library);
    assert!(matches!(
        problem(&loaded),
        EntryError::Newer { found: 2, known: 1 }
    ));
    assert!(loaded.problems[0].to_string().contains("newer version"));
}

#[test]
fn a_folder_renamed_by_hand_is_named() {
    let (_guard, library, damaged) = two_parts();
    let text = fs::read_to_string(damaged.join(META)).expect("text");
    fs::write(damaged.join(META), text.replace("\"damaged\"", "\"door\"")).expect("written");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::NameMismatch { .. }
    ));
}

#[test]
fn a_cut_foreign_or_missing_cloud_is_named_and_the_others_load() {
    let (_guard, library, damaged) = two_parts();
    let cloud = damaged.join(CLOUD);
    let whole = fs::read(&cloud).expect("bytes");
    for length in [0, 10, whole.len() / 2, whole.len() - 1] {
        fs::write(&cloud, &whole[..length]).expect("written");
        assert!(
            matches!(problem(&load(&library)), EntryError::BadCloud(_)),
            "{length} bytes"
        );
    }
    fs::remove_file(&cloud).expect("removed");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::Missing { file: CLOUD }
    ));
    let line = PointCloud::from_points((0..300).map(|i| Point3::new(i as f32, 0.0, 1.0)));
    crate::files::save_cloud(&cloud, &line).expect("written");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::ChangedCloud { .. }
    ));
    let meta = fs::read_to_string(damaged.join(META)).expect("text");
    let mut meta: PartMeta = toml::from_str(&meta).expect("TOML");
    meta.cloud = crate::library::CloudCheck::of(&fs::read(&cloud).expect("bytes"), 300);
    fs::write(damaged.join(META), meta_text(&meta).expect("TOML")).expect("written");
    assert!(matches!(problem(&load(&library)), EntryError::Reference(_)));
}

#[test]
fn a_flipped_bit_of_the_cloud_is_found_and_named() {
    let (_guard, library, damaged) = two_parts();
    let cloud = damaged.join(CLOUD);
    let mut bytes = fs::read(&cloud).expect("bytes");
    let at = bytes.len() - 1000;
    bytes[at] ^= 1;
    fs::write(&cloud, bytes).expect("written");
    let loaded = load(&library);
    let problem = problem(&loaded);
    assert!(matches!(problem, EntryError::ChangedCloud { .. }));
    assert!(
        problem.to_string().starts_with("cloud.ply is damaged"),
        "{problem}"
    );
}

#[test]
fn a_part_without_its_checksum_is_damaged() {
    let (_guard, library, damaged) = two_parts();
    let text = fs::read_to_string(damaged.join(META)).expect("text");
    let without: Vec<_> = text.lines().filter(|l| !l.starts_with("crc32")).collect();
    fs::write(damaged.join(META), without.join("\n")).expect("written");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::BadMeta { found } if found.contains("crc32")
    ));
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
fn signature_and_thumbnail_can_be_missed_and_a_thorough_look_finds_them_damaged() {
    let (_guard, library, damaged) = two_parts();
    fs::write(damaged.join(SIGNATURE), "{}").expect("written");
    fs::write(damaged.join(THUMBNAIL), "no picture").expect("written");
    assert!(load(&library).warnings.is_empty());
    let verified = library.verify(&ReferenceParams::default()).expect("listed");
    let troubles: Vec<_> = verified.warnings.iter().map(|w| &w.trouble).collect();
    assert_eq!(
        troubles,
        [
            &Trouble::Stale { file: SIGNATURE },
            &Trouble::Stale { file: THUMBNAIL }
        ]
    );
    fs::remove_file(damaged.join(SIGNATURE)).expect("removed");
    fs::remove_file(damaged.join(THUMBNAIL)).expect("removed");
    let loaded = load(&library);
    assert_eq!((loaded.parts.len(), loaded.problems.len()), (2, 0));
    assert_eq!(loaded.warnings.len(), 2);
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
    // Nobody, not even root, makes files there.
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
