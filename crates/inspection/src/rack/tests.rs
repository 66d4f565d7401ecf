use super::*;

const FILE: &str = r#"
schema_version = 1
name = "rack A"
frame = "base"
[[volume]]
centre_mm = [0, 100, 2200]
size_mm = [2400, 1800, 900]
[[place]]
name = "left hook"
centre_mm = [-600, 0, 2200]
size_mm = [300, 300, 300]
max_turn_deg = 15
parts = [{ name = "fender", angles_deg = [180, 0, 5] }, { name = "grille" }]
[[place]]
name = "right hook"
centre_mm = [600, 0, 2200]
size_mm = [300, 300, 300]
angles_deg = [0, 0, 45]
max_turn_deg = [10, 180, 7.5]
"#;

fn parsed(text: &str) -> Result<RackFile, RackError> {
    RackFile::parse(Path::new("rack.toml"), text)
}

#[test]
fn a_file_reads_as_it_is_written() {
    let file = parsed(FILE).expect("a rack");
    assert_eq!((&*file.rack.name, file.frame), ("rack A", RackFrame::Base));
    let [left, right] = &file.rack.places[..] else {
        panic!("two places");
    };
    assert_eq!(left.max_turn, MaxTurn::Total(Radians::from_degrees(15.0)));
    assert_eq!(left.parts.len(), 2);
    assert_eq!(left.parts[1].angles_rad, None);
    let each = [10.0, 180.0, 7.5].map(Radians::from_degrees);
    assert_eq!(
        (right.max_turn, right.parts.len()),
        (MaxTurn::EachAxis(each), 0)
    );
    let plain = parsed(&FILE.replace("max_turn_deg = [10, 180, 7.5]", "")).expect("a rack");
    assert_eq!(plain.rack.places[1].max_turn, NEW_PLACE_TURN);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rack.toml");
    let written = file.write(&path).expect("written");
    assert_eq!(RackFile::read(&path).expect("read"), written);
    assert_eq!(written.write(&path).expect("written"), written);
    assert_eq!(parsed(&written.text()).expect("read").text(), file.text());
}

#[test]
fn a_recipe_keeps_its_rack_and_has_another_identity_with_it() {
    use crate::pipeline::{NamedRecipe, Recipe};
    let plain = NamedRecipe::default();
    let rack = parsed(FILE).expect("a rack").rack;
    let hung = plain.in_rack(rack.clone());
    assert_ne!(hung.identity(), plain.identity());
    let json = serde_json::to_string(&*hung.parameters).expect("JSON");
    let read: Recipe = serde_json::from_str(&json).expect("a recipe");
    assert_eq!((read.rack, hung.label), (rack, plain.label));
}

#[test]
fn a_file_that_is_no_rack_is_refused_with_what_is_wrong_and_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let one = "schema_version = 1\n[[volume]]\ncentre_mm = [0, 0, 2000]\nsize_mm = [9, 9, 900]\n";
    assert!(parsed(one).is_ok());
    let place = |name: &str, x: f64, more: &str| {
        format!(
            "[[place]]\nname = \"{name}\"\ncentre_mm = [{x}, 0, 0]\nsize_mm = [300, 300, 300]\n{more}\n"
        )
    };
    let many = |num: usize| {
        let places = (0..num).map(|i| place(&i.to_string(), 400.0 * i as f64, ""));
        format!("schema_version = 1\n{}", places.collect::<String>())
    };
    assert!(parsed(&many(MAX_PARTS)).is_ok());
    let boxes = "[[volume]]\ncentre_mm = [0, 0, 0]\nsize_mm = [99, 99, 99]\n".repeat(MAX_BOXES + 1);
    let with = |text: &str| format!("schema_version = 1\n{text}");
    for (text, what) in [
        ("", "schema_version"),
        ("schema_version = 1", "neither a volume nor a place"),
        ("schema_version = 2\nnew = 1", "made by a newer version"),
        (&with("frame = \"flange\""), "unknown variant"),
        (&with("places = 3"), "line 2: unknown field"),
        (&many(MAX_PARTS + 1), "9 places"),
        (&with(&boxes), "21 boxes"),
        (&one.replace("2000", "nan"), "centre_mm of [[volume]] 1"),
        (&one.replace("2000", "1e9"), "centre_mm of [[volume]] 1"),
        (&one.replace("900", "-900"), "size_mm of [[volume]] 1"),
        (&one.replace("900", "0.9"), "no side of [[volume]] 1"),
        (&with(&place("", 0.0, "")), "a place's name"),
        (&with(&place("a\\u001bb", 0.0, "")), "a place's name"),
        (&with(&place(&"n".repeat(41), 0.0, "")), "a place's name"),
        (
            &with(&place("a", 0.0, "max_turn_deg = 0")),
            "max_turn_deg of place \"a\"",
        ),
        (
            &with(&place("a", 0.0, "max_turn_deg = nan")),
            "max_turn_deg of place \"a\"",
        ),
        (
            &with(&place("a", 0.0, "max_turn_deg = 181")),
            "max_turn_deg of place \"a\"",
        ),
        (
            &with(&place("a", 0.0, "max_turn_deg = [10, 180, 0]")),
            "max_turn_deg of place \"a\"",
        ),
        (
            &with(&place("a", 0.0, "max_turn_deg = [10, 180]")),
            "expected a number, or three of them",
        ),
        (
            &with(&place(
                "a",
                0.0,
                "parts = [{ name = \"hood\", angles_deg = [0, 0, inf] }]",
            )),
            "angles_deg of [[place]] a, hood",
        ),
        (
            &with(&(place("a", 0.0, "") + &place("a", 900.0, ""))),
            "two places are called \"a\"",
        ),
        (
            &with(&(place("a", 0.0, "") + &place("b", 100.0, ""))),
            "places \"b\" and \"a\" overlap",
        ),
    ] {
        let error = parsed(text).expect_err(text);
        assert!(error.to_string().contains(what), "{text}: {error}");
        assert!(!error.advice().is_empty());
    }
    assert!(RackFile::read(folder.path()).is_err());
    assert!(RackFile::read(&folder.path().join("missing.toml")).is_err());
}

#[test]
fn a_place_for_a_part_that_is_not_enrolled_is_refused() {
    let library = crate::fixtures::shipped_library();
    let mut file = parsed(FILE).expect("a rack");
    let names: Vec<&str> = library.references.iter().map(|one| &*one.name).collect();
    let is_enrolled = |name: &str| names.contains(&name);
    file.check_parts(is_enrolled).expect("fender and grille");
    file.rack.places[0].parts[1].name = "grill".into();
    let error = file.check_parts(is_enrolled).expect_err("no such part");
    assert!(error.to_string().contains("left hook") && error.to_string().contains("grill"));
}

#[test]
fn a_file_keeps_its_comments_and_what_stays_the_same() {
    let text = "# Booth 3
schema_version = 1
name = 'rack A'   # as on the sign

# Beside the door.
[[volume]]
centre_mm = [0, 100, 2_200.0]
size_mm = [2400, 1800, 900]

[[place]]   # the left one
name = \"left hook\"
centre_mm = [-600, 0, 2200]   # measured
size_mm = [300, 300, 300]
angles_deg = [0, 0, 0]
parts = [   # both sides
    { name = \"fender\", angles_deg = [180, 0, 5] },   # as hung
    { name = \"grille\" },   # either way
]
# The end.
";
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rack.toml");
    std::fs::write(&path, text).expect("written");
    let mut file = RackFile::read(&path).expect("a rack");
    let written = |file: &RackFile| {
        let as_read = file.write(&path).expect("written");
        assert_eq!(as_read.text(), file.text());
        std::fs::read_to_string(&path).expect("text")
    };
    assert_eq!(written(&file), text);
    let left = &mut file.rack.places[0];
    left.region.centre_m[0] = -0.65;
    left.parts.push(PlacedPart {
        name: "hood".into(),
        angles_rad: None,
    });
    let changed = text
        .replace("[-600, 0, 2200]   # m", "[-650.0, 0.0, 2200.0]   # m")
        .replace("# either way\n", "# either way\n    { name = \"hood\" },\n");
    assert_eq!(written(&file), changed);
    file.rack.places[0].parts.remove(1);
    let removed = changed.replace("    { name = \"grille\" },   # either way\n", "");
    assert_eq!(written(&file), removed);
    // Without a comma behind the last one.
    let bare = removed.replace("{ name = \"hood\" },\n", "{ name = \"hood\" }   # both\n");
    std::fs::write(&path, &bare).expect("written");
    file.rack.places[0].parts.push(PlacedPart {
        name: "grille".into(),
        angles_rad: None,
    });
    let longer = bare.replace(
        "{ name = \"hood\" }   # both\n",
        "{ name = \"hood\" },   # both\n    { name = \"grille\" },\n",
    );
    assert_eq!(written(&file), longer);
    let mut right = file.rack.places[0].clone();
    right.name = "right hook".into();
    right.region.centre_m[0] = 0.6;
    file.rack.places.push(right);
    file.rack.volume.push(file.rack.volume[0]);
    let added = written(&file);
    for kept in [
        "# Booth 3",
        "# Beside the door.",
        "2_200.0",
        "# the left one",
        "# measured",
        "# both sides",
    ] {
        assert!(added.contains(kept), "{kept}: {added}");
    }
    assert!(added.contains("name = \"right hook\"") && added.matches("[[volume]]").count() == 2);
    // Boxes in one line stay there.
    let inline = "schema_version = 1
volume = [{ centre_mm = [0, 0, 0], size_mm = [99, 99, 99] }]
";
    std::fs::write(&path, inline).expect("written");
    let inside = written(&file);
    assert!(inside.contains("volume = ["), "{inside}");
}
