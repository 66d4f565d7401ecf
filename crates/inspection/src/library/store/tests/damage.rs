//! Damaged parts: each is named, and the others load.

use super::*;
use files::FileError;

fn problem(load: &LibraryLoad) -> &EntryError {
    assert_eq!(load.problems.len(), 1, "{:?}", load.problems);
    assert_eq!(load.problems[0].entry, "damaged");
    assert!(!load.problems[0].advice().is_empty());
    let loaded: Vec<_> = load.library.references.iter().map(|r| &r.name).collect();
    assert_eq!(loaded, ["sound"]);
    &load.problems[0].reason
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
    let EntryError::Newer(newer) = problem(&loaded) else {
        panic!("{:?}", loaded.problems);
    };
    assert!(matches!(
        **newer,
        FileError::Newer {
            found: 3,
            known: 2,
            ..
        }
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
    files::save_cloud(&cloud, &line).expect("written");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::ChangedCloud { .. }
    ));
    let meta = fs::read_to_string(damaged.join(META)).expect("text");
    let mut meta: PartMeta = toml::from_str(&meta).expect("TOML");
    meta.cloud = crate::library::FileCheck::from_bytes(&fs::read(&cloud).expect("bytes"), 300);
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
fn signature_and_thumbnail_can_be_missed_and_a_thorough_look_finds_them_damaged() {
    let (_guard, library, damaged) = two_parts();
    fs::write(damaged.join(SIGNATURE), "{}").expect("written");
    fs::write(damaged.join(THUMBNAIL), "no picture").expect("written");
    assert!(load(&library).warnings.is_empty());
    let verified = library.verify(&ReferenceParams::default()).expect("listed");
    let issues: Vec<_> = verified.warnings.iter().map(|w| &w.issue).collect();
    assert_eq!(
        issues,
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
fn a_damaged_part_comes_back_as_it_was() {
    let (_guard, library, damaged) = two_parts();
    fs::write(damaged.join(META), "schema_version = ").expect("written");
    let kept = library.remove(&part_name("damaged"));
    library.restore(&kept.expect("removed")).expect("restored");
    assert!(matches!(
        problem(&load(&library)),
        EntryError::BadMeta { .. }
    ));
}

#[test]
fn a_damaged_part_in_the_trash_does_not_replace_a_sound_one() {
    let (_guard, library, damaged) = two_parts();
    fs::write(damaged.join(CLOUD), "x").expect("written");
    let name = part_name("damaged");
    let kept = library.remove(&name).expect("removed");
    library.save(&part("damaged", 0.6)).expect("saved");
    let before = library.version_of(&name).expect("there");
    let error = library.restore(&kept).expect_err("damaged");
    assert!(
        matches!(error, LibraryError::DamagedInTrash { .. }),
        "{error:?}"
    );
    assert!(error.to_string().contains(CLOUD) && error.advice().contains(".trash"));
    assert_eq!(library.version_of(&name), Some(before));
    // Without a sound one nothing is lost.
    library.remove(&name).expect("removed");
    library.restore(&kept).expect("restored");
    assert_eq!(load(&library).problems.len(), 1);
}
