use std::{fs, path::Path, thread::ScopedJoinHandle};

use super::*;
use crate::bundle::{
    BundleCheck, KeyFiles, PublishedVersion, SigningKey, StoreAddress, archive::pack, make_keys,
    publish, versions,
};
use files::file_name;
use geometry::error::Advice as _;
use inspection::library::{LibraryError, PathPoint, shipped_files};

/// A publisher's folder: a library of some shipped parts, a store and keys.
struct Plant {
    folder: tempfile::TempDir,
    keys: KeyFiles,
}

impl Plant {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["library", "store", "cell"] {
            fs::create_dir(folder.path().join(name)).expect("made");
        }
        let keys = make_keys(&folder.path().join("keys")).expect("made");
        Self { folder, keys }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn library(&self) -> LibraryFolder {
        LibraryFolder::open(&self.path("library")).expect("there")
    }

    fn cell(&self) -> LibraryFolder {
        LibraryFolder::open(&self.path("cell")).expect("there")
    }

    fn store(&self) -> BundleStore {
        BundleStore::open(StoreAddress::Folder(self.path("store"))).expect("opened")
    }

    fn key(&self) -> SigningKey {
        SigningKey::load(&self.keys.private).expect("read")
    }

    fn publish(&self, note: &str) -> Manifest {
        publish(&self.library(), &self.store(), &self.key(), note).expect("published")
    }

    fn take(&self, version: Option<u32>, local: LocalParts) -> Result<Installed, BundleError> {
        let asked = Take { version, local };
        take(&self.cell(), &self.store(), self.key().trusted(), asked)
    }

    fn take_newest(&self) -> Result<Installed, BundleError> {
        self.take(None, LocalParts::Keep)
    }

    /// Two versions: a fender and a grille, then the grille under another title and a radiator support.
    fn with_two_versions() -> Self {
        let plant = Self::new();
        for name in ["fender", "grille"] {
            copy_part(name, &plant.path("library"));
        }
        plant.publish("first");
        plant.library().remove(&part("fender")).expect("removed");
        retitle(&plant.path("library/grille"), "Grille of 2027");
        copy_part("radiator_support", &plant.path("library"));
        plant.publish("second");
        plant
    }
}

fn part(name: &str) -> PartName {
    name.parse().expect("a name")
}

/// Copies a shipped part.
fn copy_part(name: &str, library: &Path) {
    let to = library.join(name);
    fs::create_dir_all(&to).expect("made");
    for (file, content) in shipped_files(name).expect("shipped") {
        fs::write(to.join(file), content).expect("written");
    }
}

fn retitle(part: &Path, title: &str) {
    let meta = part.join("part.toml");
    let text = fs::read_to_string(&meta).expect("read");
    let lines = text.lines().map(|line| {
        if line.starts_with("title") {
            format!("title = {title:?}")
        } else {
            line.to_owned()
        }
    });
    let text = lines.collect::<Vec<_>>().join("\n");
    assert!(text.contains(title), "{text}");
    fs::write(meta, text).expect("written");
}

/// Names and bytes of all files of all parts, in order.
fn contents(library: &LibraryFolder) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for name in library.names().expect("listed") {
        for path in library.files_of(&part(&name)).expect("listed") {
            let content = fs::read(&path).expect("read");
            files.push((format!("{name}/{}", file_name(&path)), content));
        }
    }
    files
}

/// What a reader finds: the parts and the version.
fn state(library: &LibraryFolder) -> String {
    let load = library.load(&ReferenceParams::default()).expect("listed");
    assert!(load.problems.is_empty(), "{:?}", load.problems);
    let titles: Vec<_> = load.parts.iter().map(|part| part.title.as_str()).collect();
    let record = TakenBundle::read(library).expect("read");
    let version = record.map(|record| {
        let differences = record.differences(library).expect("compared");
        assert!(differences.is_empty(), "{differences:?}");
        record.manifest.version
    });
    format!("{}, version {version:?}", titles.join(", "))
}

#[test]
fn a_taken_library_is_the_published_one_to_the_byte() {
    let plant = Plant::with_two_versions();
    let taken = plant.take_newest().expect("taken");
    let Installed::New {
        manifest, trashed, ..
    } = taken
    else {
        panic!("{taken:?}");
    };
    assert_eq!((manifest.version, manifest.num_parts), (2, 2));
    assert_eq!((manifest.note.as_str(), trashed.len()), ("second", 0));
    assert_eq!(contents(&plant.cell()), contents(&plant.library()));
    let again = plant.take_newest().expect("nothing to do");
    assert_eq!(again, Installed::Already(manifest));
}

#[test]
fn cells_get_the_published_numbers_and_keep_those_that_they_have() {
    let plant = Plant::with_two_versions();
    let of = |library: &LibraryFolder, name: &str| {
        let numbers = library.numbers().expect("read");
        numbers.number_of(&part(name))
    };
    plant.take_newest().expect("taken");
    let names = ["fender", "grille", "radiator_support"];
    // The fender is in the first version only; its number stays with it.
    assert_eq!(
        names.map(|name| of(&plant.cell(), name)),
        [Some(1), Some(2), Some(3)]
    );
    let differences = TakenBundle::read(&plant.cell())
        .expect("read")
        .expect("taken");
    let differences = differences.differences(&plant.cell()).expect("compared");
    assert!(differences.is_empty(), "{differences:?}");

    // Another cell knows the grille by another number, and another part by the grille's.
    fs::write(
        plant.path("cell/numbers.toml"),
        "[parts]\ngrille = 1\ntrunk_lid = 2\n",
    )
    .expect("written");
    plant.take(Some(2), LocalParts::Keep).expect("taken");
    assert_eq!(
        names.map(|name| of(&plant.cell(), name)),
        [None, Some(1), Some(3)]
    );
    let before = contents(&plant.cell());
    fs::write(plant.path("cell/numbers.toml"), "[parts").expect("written");
    let refused = plant.take(Some(1), LocalParts::Keep).expect_err("damaged");
    assert!(
        matches!(
            refused,
            BundleError::Library(LibraryError::BadNumbers { .. })
        ),
        "{refused}"
    );
    assert_eq!(contents(&plant.cell()), before);
}

#[test]
fn the_same_library_gives_the_same_bundle() {
    let plant = Plant::with_two_versions();
    let third = plant.publish("third");
    let taken = plant.take(Some(2), LocalParts::Keep).expect("taken");
    let Installed::New { manifest, .. } = taken else {
        panic!("{taken:?}");
    };
    assert_eq!((third.version, &third.bundle), (3, &manifest.bundle));
    let bundles = fs::read_dir(plant.path("store/bundles")).expect("there");
    assert_eq!(bundles.count(), 2);
}

#[test]
fn an_older_version_is_taken_only_when_it_is_asked_for() {
    let plant = Plant::with_two_versions();
    plant.take_newest().expect("taken");
    // Whoever may write to the store takes the newest version away.
    let newest = plant.path("store").join(manifest_name(2));
    fs::rename(&newest, plant.path("hidden")).expect("moved");
    let older = plant.take_newest().expect_err("older");
    let reply = BundleError::Older {
        found: 1,
        installed: 2,
    };
    assert_eq!(older.to_string(), reply.to_string());
    assert!(older.advice().contains("--version 1"), "{}", older.advice());
    assert_eq!(contents(&plant.cell()), contents(&plant.library()));
    let back = plant.take(Some(1), LocalParts::Keep).expect("asked for");
    assert!(matches!(back, Installed::New { manifest, .. } if manifest.version == 1));
    assert_eq!(plant.cell().names().expect("listed"), ["fender", "grille"]);
    let missing = plant.take(Some(2), LocalParts::Keep).expect_err("hidden");
    assert!(
        matches!(
            missing,
            BundleError::NoSuchVersion {
                wanted: 2,
                newest: 1,
                ..
            }
        ),
        "{missing}"
    );
}

#[test]
fn what_is_changed_in_the_store_is_refused_and_the_library_stays() {
    let plant = Plant::with_two_versions();
    plant.take(Some(1), LocalParts::Keep).expect("taken");
    let before = state(&plant.cell());
    let manifest = plant.path("store").join(manifest_name(2));
    let signed = fs::read_to_string(&manifest).expect("read");
    let sha256 = Manifest::verified("2", signed.as_bytes(), plant.key().trusted());
    let sha256 = sha256.expect("signed").bundle.sha256;
    let bundle = plant.path("store").join(bundle_name(&sha256));
    let packed = fs::read(&bundle).expect("read");
    let changed = |at: usize| {
        let mut changed = packed.clone();
        changed[at] ^= 1;
        changed
    };
    let long = [&packed[..], &[0; 512]].concat();
    for wrong in [
        changed(0),
        changed(packed.len() / 2),
        packed[..packed.len() - 512].to_vec(),
        long,
        b"x".to_vec(),
    ] {
        fs::write(&bundle, wrong).expect("written");
        let refused = plant.take_newest().expect_err("changed");
        assert!(
            matches!(refused, BundleError::BadBundle { .. }),
            "{refused}"
        );
        assert_eq!(state(&plant.cell()), before);
    }
    fs::remove_file(&bundle).expect("removed");
    let refused = plant.take_newest().expect_err("missing");
    assert!(
        matches!(refused, BundleError::BadBundle { .. }),
        "{refused}"
    );
    fs::write(&bundle, &packed).expect("written");
    let first = fs::read(plant.path("store").join(manifest_name(1))).expect("read");
    for wrong in [
        signed
            .replace("\"version\":2", "\"version\":3")
            .into_bytes(),
        signed.replace("second", "Second").into_bytes(),
        signed.as_bytes()[..100].to_vec(),
        // A true manifest under another number.
        first,
    ] {
        fs::write(&manifest, wrong).expect("written");
        let refused = plant.take_newest().expect_err("changed");
        assert!(
            matches!(refused, BundleError::BadManifest { .. }),
            "{refused}"
        );
        assert_eq!(state(&plant.cell()), before);
    }
    fs::write(&manifest, vec![b' '; 1 << 19]).expect("written");
    let refused = plant.take_newest().expect_err("too large");
    assert!(matches!(refused, BundleError::TooLarge { .. }), "{refused}");
    fs::write(&manifest, signed).expect("written");
    plant.take_newest().expect("whole again");
}

#[test]
fn another_key_is_not_trusted() {
    let plant = Plant::with_two_versions();
    let other = make_keys(&plant.path("others")).expect("made");
    let other = TrustedKey::load(&other.public).expect("read");
    let asked = Take {
        version: None,
        local: LocalParts::Keep,
    };
    let refused = take(&plant.cell(), &plant.store(), other, asked).expect_err("another key");
    assert!(matches!(refused, BundleError::OtherKey { .. }), "{refused}");
    assert_eq!(plant.cell().names().expect("listed"), Vec::<String>::new());
}

/// Publishes a bundle as it is, whatever is in it, with a sound signature.
fn publish_as_it_is(plant: &Plant, version: u32, bundle: Vec<u8>, num_parts: usize) {
    let check = BundleCheck {
        sha256: sha256(&bundle),
        bytes: bundle.len() as u64,
    };
    let store = plant.store();
    store.put_bundle(&check.sha256, bundle).expect("written");
    let manifest = Manifest::new(
        version,
        Timestamp::UNIX_EPOCH,
        num_parts,
        check,
        "",
        PartNumbers::default(),
    );
    let text = manifest.signed(&plant.key());
    assert!(store.put_manifest(version, &text).expect("written"));
}

#[test]
fn a_signed_bundle_with_a_damaged_part_or_a_path_out_of_the_library_is_refused() {
    let plant = Plant::with_two_versions();
    plant.take_newest().expect("taken");
    let before = state(&plant.cell());
    let names = [part("grille"), part("radiator_support")];
    let sound = pack(&plant.library(), &names).expect("packed");
    publish_as_it_is(&plant, 3, sound.clone(), 3);
    let refused = plant.take_newest().expect_err("one part less");
    assert!(
        matches!(refused, BundleError::BadBundle { .. }),
        "{refused}"
    );

    let place = |text: &[u8]| sound.windows(text.len()).position(|found| found == text);
    let mut damaged = sound.clone();
    let points = place(b"end_header").expect("a cloud") + 2000;
    damaged[points] ^= 1;
    publish_as_it_is(&plant, 4, damaged, 2);
    let refused = plant.take_newest().expect_err("a damaged cloud");
    assert!(
        matches!(&refused, BundleError::UnreadablePart { version: 4, problem } if problem.entry == "grille"),
        "{refused}"
    );

    let mut leading_out = tar::Builder::new(Vec::new());
    let mut header = tar::Header::new_ustar();
    let path = b"../outside/cloud.ply";
    header.as_mut_bytes()[..path.len()].copy_from_slice(path);
    header.set_entry_type(tar::EntryType::Regular);
    header.set_size(1);
    header.set_cksum();
    leading_out.append(&header, &b"x"[..]).expect("in memory");
    publish_as_it_is(&plant, 5, leading_out.into_inner().expect("in memory"), 1);
    let refused = plant.take_newest().expect_err("a path out of the library");
    assert!(
        matches!(refused, BundleError::BadBundle { .. }),
        "{refused}"
    );
    assert!(!plant.path("outside").exists() && !plant.path("cell/outside").exists());
    assert_eq!(state(&plant.cell()), before);
}

#[test]
fn what_claims_to_be_too_large_is_refused_before_it_is_read() {
    let plant = Plant::new();
    let check = BundleCheck {
        sha256: "0f".repeat(32),
        bytes: MAX_BUNDLE_BYTES + 1,
    };
    let manifest = Manifest::new(
        1,
        Timestamp::UNIX_EPOCH,
        1,
        check,
        "",
        PartNumbers::default(),
    );
    let text = manifest.signed(&plant.key());
    assert!(plant.store().put_manifest(1, &text).expect("written"));
    let refused = plant.take_newest().expect_err("too large");
    assert!(matches!(refused, BundleError::TooLarge { .. }), "{refused}");
}

#[test]
fn parts_that_are_in_no_version_are_kept_unless_they_may_go_to_the_trash() {
    let plant = Plant::with_two_versions();
    // Those that the program brings along are nobody's own.
    copy_part("trunk_lid", &plant.path("cell"));
    plant.take(Some(1), LocalParts::Keep).expect("taken");
    retitle(&plant.path("cell/fender"), "My fender");
    copy_part("front_door", &plant.path("cell"));
    retitle(&plant.path("cell/front_door"), "My door");
    let cell = plant.cell();
    let local = [
        LocalPart::Changed("fender".into()),
        LocalPart::Enrolled("front_door".into()),
    ];
    let record = TakenBundle::read(&cell).expect("read").expect("taken");
    assert_eq!(record.differences(&cell).expect("compared"), local);
    let before = contents(&cell);
    let refused = plant.take_newest().expect_err("local parts");
    assert!(
        matches!(&refused, BundleError::LocalParts { parts } if *parts == local),
        "{refused}"
    );
    assert!(
        refused.advice().contains("--replace"),
        "{}",
        refused.advice()
    );
    assert_eq!(contents(&cell), before);
    let taken = plant.take(None, LocalParts::Trash).expect("taken");
    let Installed::New { trashed, .. } = taken else {
        panic!("{taken:?}");
    };
    // And the grille, which has another title now.
    assert_eq!(trashed.len(), 3, "{trashed:?}");
    let in_trash = cell.trashed().expect("listed");
    let mut in_trash = in_trash.iter();
    let door = in_trash.find(|kept| kept.name == part("front_door"));
    cell.restore(&door.expect("kept").kept).expect("restored");
    let text = fs::read_to_string(plant.path("cell/front_door/part.toml"));
    assert!(text.expect("there").contains("My door"));
    let record = TakenBundle::read(&cell).expect("read").expect("taken");
    assert_eq!(
        record.differences(&cell).expect("compared"),
        [LocalPart::Enrolled("front_door".into())]
    );
    cell.remove(&part("grille")).expect("removed");
    let differences = record.differences(&cell).expect("compared");
    assert!(differences.contains(&LocalPart::Removed(part("grille"))));
}

/// Stores a spray path whose first point is at `x` metres.
fn store_path(library: &LibraryFolder, name: &str, x: f64) -> SprayPath {
    let point = PathPoint {
        nozzle: nalgebra::Point3::new(x, 0.0, 1.0),
        direction: nalgebra::Vector3::z_axis(),
        stand_off: None,
        is_gun_on: true,
        speed: None,
        fan: None,
    };
    let path = SprayPath::new(vec![point; 3]).expect("points");
    let stored = library.set_spray_path(&part(name), Some(&path));
    stored.expect("stored");
    path
}

#[test]
fn a_spray_path_of_this_cell_stays_with_its_part_in_every_version_that_has_none() {
    let plant = Plant::with_two_versions();
    plant.take(Some(1), LocalParts::Keep).expect("taken");
    let cell = plant.cell();
    let path = store_path(&cell, "grille", 0.1);
    for (version, local) in [(2, LocalParts::Keep), (3, LocalParts::Trash)] {
        if version == 3 {
            plant.publish("third");
        }
        let taken = plant.take(None, local).expect("taken");
        let Installed::New {
            manifest,
            kept_paths,
            ..
        } = taken
        else {
            panic!("{taken:?}");
        };
        assert_eq!(manifest.version, version);
        assert_eq!(kept_paths, [part("grille")]);
        assert_eq!(
            cell.spray_path("grille").expect("read").as_ref(),
            Some(&path)
        );
        let words = cell.words(&part("grille")).expect("there");
        assert_eq!(words.title, "Grille of 2027");
        let record = TakenBundle::read(&cell).expect("read").expect("taken");
        assert_eq!(
            record.differences(&cell).expect("compared"),
            [LocalPart::SprayPath("grille".into())]
        );
    }
    // Without the path the part is again as it was published.
    cell.set_spray_path(&part("grille"), None).expect("removed");
    let record = TakenBundle::read(&cell).expect("read").expect("taken");
    assert!(record.differences(&cell).expect("compared").is_empty());
}

#[test]
fn a_spray_path_that_does_not_fit_the_new_version_stops_it_unless_it_may_go_to_the_trash() {
    /// Replaces the shape of a part of the library by that of a fender.
    fn reshape(plant: &Plant) {
        let grille = plant.path("library/grille");
        fs::remove_dir_all(&grille).expect("removed");
        copy_part("fender", &plant.path("library"));
        fs::rename(plant.path("library/fender"), &grille).expect("moved");
        let meta = grille.join("part.toml");
        let text = fs::read_to_string(&meta).expect("read");
        let text = text.replace("name = \"fender\"", "name = \"grille\"");
        fs::write(meta, text).expect("written");
    }
    let changes: [fn(&Plant); 3] = [
        reshape,
        |plant| drop(plant.library().remove(&part("grille")).expect("removed")),
        |plant| drop(store_path(&plant.library(), "grille", 0.2)),
    ];
    for change in changes {
        let plant = Plant::with_two_versions();
        plant.take_newest().expect("taken");
        let cell = plant.cell();
        let path = store_path(&cell, "grille", 0.1);
        change(&plant);
        plant.publish("third");
        let before = contents(&cell);
        let refused = plant.take_newest().expect_err("the path would be lost");
        let local = [LocalPart::SprayPath("grille".into())];
        assert!(
            matches!(&refused, BundleError::LocalParts { parts } if *parts == local),
            "{refused}"
        );
        assert!(refused.advice().contains("--replace"), "{refused}");
        assert_eq!(contents(&cell), before);
        let taken = plant.take(None, LocalParts::Trash).expect("taken");
        let Installed::New { trashed, .. } = taken else {
            panic!("{taken:?}");
        };
        assert_eq!(trashed.len(), 1, "{trashed:?}");
        cell.restore(&trashed[0]).expect("restored");
        assert_eq!(cell.spray_path("grille").expect("read"), Some(path));
    }
}

#[test]
fn a_spray_path_that_came_with_a_version_goes_with_it() {
    let plant = Plant::with_two_versions();
    let path = store_path(&plant.library(), "grille", 0.1);
    plant.publish("with a path");
    plant.take_newest().expect("taken");
    let cell = plant.cell();
    assert_eq!(cell.spray_path("grille").expect("read"), Some(path));
    let grille = part("grille");
    plant
        .library()
        .set_spray_path(&grille, None)
        .expect("removed");
    plant.publish("without");
    plant.take_newest().expect("taken");
    assert_eq!(cell.spray_path("grille").expect("read"), None);
    // The same path, stored at both places, is in nobody's way.
    for library in [&cell, &plant.library()] {
        store_path(library, "grille", 0.3);
    }
    retitle(&plant.path("library/grille"), "Grille of 2028");
    plant.publish("the same path");
    plant.take_newest().expect("taken");
    assert_eq!(contents(&cell), contents(&plant.library()));
}

#[test]
fn all_versions_of_a_store_are_listed_whoever_signed_them() {
    let plant = Plant::with_two_versions();
    plant.take(Some(1), LocalParts::Keep).expect("taken");
    let record = TakenBundle::read(&plant.cell())
        .expect("read")
        .expect("taken");
    let store = plant.store();
    let others = make_keys(&plant.path("others")).expect("made");
    let others = SigningKey::load(&others.private).expect("read");
    let check = BundleCheck {
        sha256: "0f".repeat(32),
        bytes: 1,
    };
    let theirs = Manifest::new(
        3,
        Timestamp::UNIX_EPOCH,
        5,
        check,
        "theirs",
        PartNumbers::default(),
    );
    assert!(
        store
            .put_manifest(3, &theirs.signed(&others))
            .expect("written")
    );
    // A version under another number, and no manifest at all.
    assert!(
        store
            .put_manifest(4, &theirs.signed(&others))
            .expect("written")
    );
    assert!(store.put_manifest(5, "nothing").expect("written"));
    let mut found = Vec::new();
    for PublishedVersion { version, manifest } in versions(&store).expect("listed") {
        let shown = manifest.ok().map(|(manifest, key)| {
            assert_eq!(manifest.version, version);
            (manifest.num_parts, key, record.is_of(&manifest, key))
        });
        found.push((version, shown));
    }
    let (own, other) = (plant.key().trusted(), others.trusted());
    let expected = [
        (5, None),
        (4, None),
        (3, Some((5, other, false))),
        (2, Some((2, own, false))),
        (1, Some((2, own, true))),
    ];
    assert_eq!(found, expected);
    let empty = tempfile::tempdir().expect("a folder");
    let empty = BundleStore::open(StoreAddress::Folder(empty.path().to_owned()));
    assert!(
        versions(&empty.expect("opened"))
            .expect("listed")
            .is_empty()
    );
}

#[test]
fn of_two_publishers_at_once_one_is_refused() {
    let plant = Plant::new();
    copy_part("grille", &plant.path("library"));
    let num = 4;
    let results: Vec<_> = std::thread::scope(|scope| {
        let publishers: Vec<_> = (0..num)
            .map(|i| {
                let plant = &plant;
                scope.spawn(move || {
                    let note = format!("publisher {i}");
                    publish(&plant.library(), &plant.store(), &plant.key(), &note)
                })
            })
            .collect();
        let joined = publishers.into_iter().map(ScopedJoinHandle::join);
        joined.map(|result| result.expect("no panic")).collect()
    });
    let mut published = Vec::new();
    for result in results {
        match result {
            Ok(manifest) => published.push(manifest),
            Err(BundleError::VersionTaken { .. }) => {}
            Err(error) => panic!("{error}"),
        }
    }
    assert!(!published.is_empty());
    published.sort_by_key(|manifest| manifest.version);
    let versions: Vec<u32> = published.iter().map(|manifest| manifest.version).collect();
    let expected: Vec<u32> = (1..).take(published.len()).collect();
    assert_eq!(versions, expected, "each number once");
    for manifest in published {
        let bytes = plant.store().manifest(manifest.version).expect("read");
        let found = Manifest::verified("", &bytes.expect("there"), plant.key().trusted());
        assert_eq!(found.expect("signed"), manifest);
    }
}

#[test]
fn a_version_that_another_has_published_meanwhile_is_not_written_over() {
    let plant = Plant::with_two_versions();
    let store = plant.store();
    let theirs = store.manifest(2).expect("read").expect("there");
    assert!(!store.put_manifest(2, "mine").expect("asked"));
    assert_eq!(store.manifest(2).expect("read"), Some(theirs));
}

#[test]
fn a_library_with_a_damaged_part_or_path_or_no_part_is_not_published() {
    let plant = Plant::new();
    let publish = || publish(&plant.library(), &plant.store(), &plant.key(), "");
    let refused = publish().expect_err("no parts");
    assert!(matches!(refused, BundleError::NoParts { .. }), "{refused}");
    copy_part("grille", &plant.path("library"));
    let cloud = plant.path("library/grille/cloud.ply");
    let mut bytes = fs::read(&cloud).expect("read");
    let sound = bytes.clone();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    fs::write(&cloud, bytes).expect("written");
    let refused = publish().expect_err("a damaged part");
    assert!(matches!(refused, BundleError::Problem(_)), "{refused}");
    fs::write(&cloud, sound).expect("written");
    let meta = plant.path("library/grille/part.toml");
    let text = fs::read_to_string(&meta).expect("read");
    let named = format!("{text}\n[spray]\nnum_points = 3\ncrc32 = \"0badcafe\"\n");
    fs::write(&meta, named).expect("written");
    let refused = publish().expect_err("a path that is not there");
    assert!(matches!(refused, BundleError::SprayPath(_)), "{refused}");
    assert!(!plant.path("store/manifests").exists());
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_the_library_is_the_former_version_or_the_new_one() {
    use files::disk::faults::{Writer, with_advice};

    let plant = Plant::with_two_versions();
    let trusted = plant.key().trusted();
    // The process that is killed makes a plant of its own: it takes version 2 of that into the folder that it is told.
    let install = |folder: &Path, version: u32| {
        let asked = Take {
            version: Some(version),
            local: LocalParts::Trash,
        };
        let library = LibraryFolder::open(folder).expect("there");
        take(&library, &plant.store(), trusted, asked)
    };
    Writer {
        test: "bundle::take::tests::whichever_call_fails_the_library_is_the_former_version_or_the_new_one",
        prepare: &|folder| drop(install(folder, 1).expect("taken")),
        write: &|folder| install(folder, 2).map(|_| ()).map_err(|error| with_advice(&error)),
        state: &|folder| state(&LibraryFolder::open(folder).expect("there")),
        between: &[],
    }
    .fails_at_every_call();
}
