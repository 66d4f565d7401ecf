//! Renaming parts, with their references.

use super::*;

fn words(name: &str, title: &str) -> PartNaming {
    PartNaming {
        name: PartName::new(name).expect("a name"),
        title: title.into(),
        notes: "seen again".into(),
    }
}

/// Saves a plate as another reference of the part `of`.
fn save_reference(library: &LibraryFolder, name: &str, of: &str) {
    let mut reference = part(name, 0.5);
    reference.meta.part = Some(part_name(of));
    library.save(&reference).expect("saved");
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
    let name = part_name("plate");
    let renamed = library.rename(&name, &words("sheet", "Sheet"));
    let former = renamed.expect("renamed").former.expect("kept");
    let loaded = load(&library);
    assert_eq!(loaded.parts[0].words(), words("sheet", "Sheet"));
    assert_eq!(
        *loaded.library.references[0].cloud,
        part("plate", 0.4).cloud
    );
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
