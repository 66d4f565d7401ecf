use jiff::Timestamp;
use nalgebra::Point3;

use super::{super::trash::TRASH, *};
use crate::{
    error::Advice as _,
    geometry::cloud::PointCloud,
    library::{EnrolParams, EntryError, EntryIssue, LibraryLoad, PartDescription, enrol_whole},
    stages::reference::ReferenceParams,
};

/// Creates an L-shaped plate in front of the camera; `width` in metres distinguishes one from another.
fn part(name: &str, width: f32) -> Part {
    let across = (width / 0.005) as usize;
    let points = (0..across * 80).filter_map(|i| {
        let (x, y) = ((i % across) as f32 * 0.005, (i / across) as f32 * 0.005);
        (x < 0.15 || y < 0.2).then(|| Point3::new(x, y, 1.2))
    });
    let about = PartDescription {
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
    assert_eq!(loaded.warnings[0].trouble, EntryIssue::LeftAside);
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
    fs::write(damaged.join(META), "schema_version = 3\ncolour = \"red\"\n").expect("written");
    let loaded = load(&library);
    assert!(matches!(
        problem(&loaded),
        EntryError::Newer { found: 3, known: 2 }
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
            &EntryIssue::Stale { file: SIGNATURE },
            &EntryIssue::Stale { file: THUMBNAIL }
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

fn words(name: &str, title: &str) -> PartNaming {
    PartNaming {
        name: PartName::new(name).expect("a name"),
        title: title.into(),
        notes: "seen again".into(),
    }
}

#[test]
fn a_part_with_another_title_is_otherwise_the_same() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.4)).expect("saved").folder;
    let before = load(&library).parts[0].words();
    let renamed = library.rename(&before.name, &words("plate", "Sheet"));
    let expected = Renamed {
        before: before.clone(),
        former: None,
        num_references: 0,
    };
    assert_eq!(renamed.expect("renamed"), expected);
    let loaded = load(&library);
    assert_eq!(loaded.parts[0].words(), words("plate", "Sheet"));
    assert!(loaded.problems.is_empty() && loaded.warnings.is_empty());
    assert_eq!(fs::read_dir(&folder).expect("listed").count(), 4);
    library.rename(&before.name, &before).expect("renamed back");
    assert_eq!(load(&library).parts[0], part("plate", 0.4).meta);
}

#[test]
fn a_part_with_another_name_keeps_every_file_and_the_former_one_lies_in_the_trash() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.4)).expect("saved").folder;
    fs::write(folder.join("drawing.txt"), "no. 7").expect("written");
    let name = PartName::new("plate").expect("a name");
    let renamed = library.rename(&name, &words("sheet", "Sheet"));
    let former = renamed.expect("renamed").former.expect("kept");
    let loaded = load(&library);
    assert_eq!(loaded.parts[0].words(), words("sheet", "Sheet"));
    assert_eq!(loaded.library.references[0].cloud, part("plate", 0.4).cloud);
    assert!(loaded.warnings.is_empty());
    let drawing = library.path().join("sheet").join("drawing.txt");
    assert_eq!(fs::read_to_string(drawing).expect("copied"), "no. 7");
    let trashed = library.trashed().expect("listed");
    assert_eq!(
        (trashed[0].name.as_str(), &trashed[0].kept),
        ("plate", &former)
    );
}

#[test]
fn a_name_that_is_taken_a_damaged_description_and_a_missing_part_are_refused() {
    let (_guard, library, damaged) = two_parts();
    let name = |name| PartName::new(name).expect("a name");
    let taken = library.rename(&name("sound"), &words("damaged", ""));
    assert!(
        matches!(taken, Err(LibraryError::NameTaken { .. })),
        "{taken:?}"
    );
    fs::write(damaged.join(META), "schema_version = 1").expect("written");
    for to in ["damaged", "other"] {
        let refused = library
            .rename(&name("damaged"), &words(to, ""))
            .expect_err("refused");
        assert!(matches!(refused, LibraryError::Damaged(_)) && !refused.advice().is_empty());
    }
    let missing = library.rename(&name("door"), &words("gate", ""));
    assert!(matches!(missing, Err(LibraryError::NoSuchPart { .. })));
    assert_eq!(library.names().expect("listed"), ["damaged", "sound"]);
}

#[test]
fn a_writer_killed_while_it_renames_leaves_one_of_the_two_names() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.4)).expect("saved").folder;
    let aside = library.path().join(".old-plate+sheet");
    fs::rename(&folder, &aside).expect("aside");
    assert_eq!(library.names().expect("listed"), ["plate"]);
    assert_eq!(load(&library).warnings[0].trouble, EntryIssue::LeftAside);
    library.save(&part("other", 0.5)).expect("saved");
    assert_eq!(library.names().expect("listed"), ["other", "plate"]);
    fs::rename(&folder, &aside).expect("aside");
    fs::rename(library.path().join("other"), library.path().join("sheet")).expect("in place");
    assert_eq!(library.names().expect("listed"), ["sheet"]);
    library.save(&part("third", 0.6)).expect("saved");
    assert_eq!(library.trashed().expect("listed")[0].name.as_str(), "plate");
}

/// Saves a plate as another reference of the part `of`.
fn save_reference(library: &LibraryFolder, name: &str, of: &str) {
    let mut reference = part(name, 0.5);
    reference.meta.part = Some(part_name(of));
    library.save(&reference).expect("saved");
}

fn part_name(text: &str) -> PartName {
    PartName::new(text).expect("a name")
}

#[test]
fn a_renamed_part_takes_its_references_along_and_back() {
    let (_guard, library) = library();
    library.save(&part("plate", 0.4)).expect("saved");
    library.save(&part("other", 0.6)).expect("saved");
    save_reference(&library, "plate_b", "plate");
    save_reference(&library, "plate_c", "plate");
    save_reference(&library, "other_b", "other");
    let parts = || {
        let loaded = load(&library);
        assert!(loaded.problems.is_empty() && loaded.warnings.is_empty());
        let parts = loaded.parts.iter();
        parts
            .map(|meta| meta.part_name().to_string())
            .collect::<Vec<_>>()
    };
    let before = library.words(&part_name("plate")).expect("there");
    let renamed = library
        .rename(&before.name, &words("sheet", ""))
        .expect("renamed");
    assert_eq!(renamed.num_references, 2);
    assert_eq!(parts(), ["other", "other", "sheet", "sheet", "sheet"]);
    let sheet = part_name("sheet");
    let references = library.references_of(&sheet).expect("listed");
    assert_eq!(references, [part_name("plate_b"), part_name("plate_c")]);
    assert_eq!(library.part_of(&references[0]).expect("there"), sheet);
    let back = library.rename(&sheet, &before).expect("renamed back");
    assert_eq!(back.num_references, 2);
    assert_eq!(parts(), ["other", "other", "plate", "plate", "plate"]);
    let kept = library.remove(&before.name).expect("removed");
    library.restore(&kept).expect("restored");
    assert_eq!(parts(), ["other", "other", "plate", "plate", "plate"]);
    let renamed = library.rename(&part_name("plate_b"), &words("plate_d", ""));
    assert_eq!(renamed.expect("renamed").num_references, 0);
    assert_eq!(parts(), ["other", "other", "plate", "plate", "plate"]);
}

#[test]
fn references_left_behind_by_a_killed_rename_are_carried_along_by_the_next_writer() {
    let (_guard, library) = library();
    let folder = library.save(&part("plate", 0.4)).expect("saved").folder;
    save_reference(&library, "plate_b", "plate");
    library.save(&part("sheet", 0.4)).expect("saved");
    fs::rename(&folder, library.path().join(".old-plate+sheet")).expect("aside");
    assert!(load(&library).problems.is_empty());
    library.save(&part("third", 0.6)).expect("saved");
    let part = library.part_of(&part_name("plate_b")).expect("there");
    assert_eq!(part.as_str(), "sheet");
    assert_eq!(library.trashed().expect("listed")[0].name.as_str(), "plate");
}

#[test]
fn what_was_removed_or_replaced_is_restored_and_nothing_is_lost_by_it() {
    let (_guard, library) = library();
    library.save(&part("plate-2", 0.4)).expect("saved");
    let replaced = library.save(&part("plate-2", 0.5)).expect("saved").replaced;
    let restored = library.restore(&replaced.expect("kept")).expect("restored");
    assert_eq!(restored.name.as_str(), "plate-2");
    let width = |library: &LibraryFolder| load(library).library.references[0].cloud.clone();
    assert_eq!(width(&library), part("plate-2", 0.4).cloud);
    library
        .restore(&restored.replaced.expect("kept"))
        .expect("and back");
    assert_eq!(width(&library), part("plate-2", 0.5).cloud);
    let removed = library.remove(&restored.name).expect("removed");
    assert_eq!(library.restore(&removed).expect("restored").replaced, None);
    assert_eq!(width(&library), part("plate-2", 0.5).cloud);
}

#[test]
fn a_damaged_part_comes_back_as_it_was() {
    let (_guard, library, damaged) = two_parts();
    fs::write(damaged.join(META), "schema_version = ").expect("written");
    let kept = library.remove(&PartName::new("damaged").expect("a name"));
    library.restore(&kept.expect("removed")).expect("restored");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::BadMeta { .. }
    ));
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

/// Makes each call of a change fail in turn; the library must stay intact and the plate must never be lost.
#[cfg(unix)]
fn fails_at_every_call(
    test: &str,
    change: &dyn Fn(&LibraryFolder) -> Result<(), LibraryError>,
    between: &[&str],
) {
    use crate::files::disk::faults::{Writer, told};

    let plate = part("plate", 0.4);
    let open = |folder: &Path| LibraryFolder::open(folder).expect("there");
    Writer {
        test,
        prepare: &|folder| {
            open(folder).save(&plate).expect("saved");
        },
        write: &|folder| change(&open(folder)).map_err(|error| told(&error)),
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
        "library::store::tests::whichever_call_fails_a_part_is_replaced_or_not",
        &|library| library.save(&new).map(|_| ()),
        &[],
    );
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_part_is_renamed_or_not() {
    fails_at_every_call(
        "library::store::tests::whichever_call_fails_a_part_is_renamed_or_not",
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
        "library::store::tests::whichever_call_fails_a_part_is_removed_or_not",
        &|library| library.remove(&part_name("plate")).map(|_| ()),
        &[],
    );
}

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
    let names: Vec<_> = trashed
        .iter()
        .map(|kept| crate::files::file_name(kept))
        .collect();
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

#[cfg(unix)]
#[test]
fn whichever_call_fails_all_parts_are_replaced_or_none() {
    use crate::files::disk::faults::{Writer, told};

    let open = |folder: &Path| LibraryFolder::open(folder).expect("there");
    let before = [part("same", 0.4), part("changed", 0.5), part("gone", 0.6)];
    let after = [part("same", 0.4), part("changed", 0.6), part("new", 0.5)];
    Writer {
        test: "library::store::tests::whichever_call_fails_all_parts_are_replaced_or_none",
        prepare: &|folder| {
            for part in &before {
                open(folder).save(part).expect("saved");
            }
            fs::write(folder.join("version"), "1").expect("written");
        },
        write: &|folder| {
            let replaced = replace_all(&open(folder), &after);
            replaced.map(|_| ()).map_err(|error| told(&error))
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
