//! One library for many cells: the built program publishes versions to a folder and to S3, and takes them from there.
//!
//! The S3 server is moto (`pip install "moto[server]"`), started by each test at a free port. Without it those tests
//! report that they are skipped; with `PARTSIGHT_REQUIRE_S3=1` they fail. Encrypted connections are not tested here.

mod s3;

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    thread,
    time::Duration,
};

use partsight::{
    library::LibraryFolder,
    plant::bundle::{LocalPart, TakenBundle},
    stages::reference::ReferenceParams,
};
use rand::{RngExt as _, SeedableRng as _};

use self::s3::{Fault, FaultyServer, S3Server};

/// A secret that no message may contain.
const SECRET: &str = "Zk3-secret-of-the-bucket";

/// A folder with the library `parts` and the publisher's keys.
struct Plant {
    folder: tempfile::TempDir,
    /// Address of the S3 server.
    endpoint: Option<String>,
}

impl Plant {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let plant = Self {
            folder,
            endpoint: None,
        };
        crate::kit::copy_library(&plant.path("parts"));
        for name in [
            "back_bumper",
            "back_door",
            "front_bumper",
            "front_door",
            "trunk_lid",
        ] {
            fs::remove_dir_all(plant.path("parts").join(name)).expect("removed");
        }
        plant.accepted(&["keys", "keys"]);
        plant
    }

    fn at(endpoint: String) -> Self {
        Self {
            endpoint: Some(endpoint),
            ..Self::new()
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_partsight"));
        command
            .arg("library")
            .args(args)
            .current_dir(self.folder.path())
            .env("XDG_DATA_HOME", self.path("data"))
            .env("HOME", self.folder.path())
            .env_remove("AWS_SESSION_TOKEN")
            .env("AWS_REGION", "us-east-1")
            .env("AWS_ACCESS_KEY_ID", "cell")
            .env("AWS_SECRET_ACCESS_KEY", SECRET)
            .env("AWS_ALLOW_HTTP", "true");
        if let Some(endpoint) = &self.endpoint {
            command.env("AWS_ENDPOINT", endpoint);
        }
        command
    }

    /// Runs a command; returns its exit code and output, which never contain a secret.
    fn run(&self, args: &[&str]) -> (Option<i32>, String) {
        words(&self.command(args).output().expect("ran"))
    }

    fn accepted(&self, args: &[&str]) -> String {
        let (code, text) = self.run(args);
        assert_eq!(code, Some(0), "{args:?}: {text}");
        text
    }

    fn refused(&self, args: &[&str]) -> String {
        let (code, text) = self.run(args);
        assert_eq!(code, Some(2), "{args:?}: {text}");
        assert!(
            text.contains("error: ") && text.contains("to do: "),
            "{text}"
        );
        text
    }

    fn publish(&self, store: &str) -> String {
        let key = ["--key", "keys/library.key", "--library", "parts"];
        self.accepted(&[&["publish", "--to", store, "--note", "tried"][..], &key].concat())
    }
}

/// Arguments that take the newest version from this store into `cell`.
fn take_from(store: &str) -> Vec<&str> {
    let trust = ["--trust", "keys/library.pub", "--library", "cell"];
    [&["take", "--from", store][..], &trust].concat()
}

fn words(output: &Output) -> (Option<i32>, String) {
    let text = [&output.stdout[..], &output.stderr].concat();
    let text = String::from_utf8(text).expect("text");
    assert!(!text.contains(SECRET), "{text}");
    (output.status.code(), text)
}

/// Names and bytes of all files of all parts.
fn contents(library: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let folder = LibraryFolder::open(library).expect("there");
    let mut files = BTreeMap::new();
    for name in folder.names().expect("listed") {
        let name = name.parse().expect("a name");
        for path in folder.files_of(&name).expect("listed") {
            let inside = path.strip_prefix(library).expect("inside").to_owned();
            files.insert(inside, fs::read(&path).expect("read"));
        }
    }
    files
}

/// Publishes, takes, changes, publishes and takes again.
fn goes_round(plant: &Plant, store: &str) {
    let published = plant.publish(store);
    assert!(
        published.starts_with("Published version 1: parts: 3\n"),
        "{published}"
    );
    let taken = plant.accepted(&take_from(store));
    assert!(taken.starts_with("Took version 1: parts: 3\n"), "{taken}");
    let [parts, cell] = ["parts", "cell"].map(|name| plant.path(name));
    assert_eq!(contents(&cell), contents(&parts));
    assert_eq!(contents(&cell).len(), 12);
    let listed = plant.accepted(&["list", "--library", "cell"]);
    assert!(
        listed.contains(&format!("  version 1 of {store}\n")),
        "{listed}"
    );
    let again = plant.accepted(&take_from(store));
    assert_eq!(again, "Version 1 is installed already\n");

    plant.accepted(&[
        "rename",
        "grille",
        "--title",
        "Grille 2",
        "--library",
        "parts",
    ]);
    plant.accepted(&["remove", "fender", "--library", "parts"]);
    plant.publish(store);
    let taken = plant.accepted(&take_from(store));
    assert!(taken.contains("Took version 2: parts: 2\n"), "{taken}");
    assert!(taken.contains("  in .trash fender-"), "{taken}");
    assert_eq!(contents(&cell), contents(&parts));
    let version = plant.accepted(&["version", "--library", "cell"]);
    for line in [
        "Version 2\n".to_owned(),
        format!("  store     {store}\n"),
        "  note      tried\n".to_owned(),
        "  parts     2\n".to_owned(),
    ] {
        assert!(version.contains(&line), "{version}");
    }
    let back = [&take_from(store)[..], &["--version", "1"]].concat();
    plant.accepted(&back);
    assert_eq!(contents(&cell).len(), 12);
}

#[test]
fn a_library_goes_by_a_folder_to_the_byte() {
    let plant = Plant::new();
    fs::create_dir(plant.path("store")).expect("made");
    goes_round(&plant, "store");
}

#[test]
fn a_library_goes_by_s3_to_the_byte() {
    let Some(server) = S3Server::start() else {
        return;
    };
    let plant = Plant::at(server.endpoint());
    goes_round(&plant, "s3://parts/hall-3");
}

#[test]
fn of_two_programs_that_publish_to_s3_at_once_none_writes_over_the_other() {
    let Some(server) = S3Server::start() else {
        return;
    };
    let plant = Plant::at(server.endpoint());
    let publish = [
        "publish",
        "--to",
        "s3://parts",
        "--key",
        "keys/library.key",
        "--library",
        "parts",
    ];
    let start = || {
        let mut command = plant.command(&publish);
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().expect("starts")
    };
    let programs = [start(), start(), start()];
    let mut versions = Vec::new();
    for program in programs {
        let (code, text) = words(&program.wait_with_output().expect("ended"));
        if code == Some(0) {
            let number = text.strip_prefix("Published version ");
            let number = number.and_then(|rest| rest.split_once(':'));
            let (number, _) = number.unwrap_or_else(|| panic!("{text}"));
            versions.push(number.parse::<usize>().expect("a number"));
        } else {
            assert!(text.contains("somebody else has published"), "{text}");
        }
    }
    versions.sort_unstable();
    let expected: Vec<usize> = (1..=versions.len()).collect();
    assert!(!versions.is_empty() && versions == expected, "{versions:?}");
    let taken = plant.accepted(&take_from("s3://parts"));
    let newest = format!("Took version {}: parts: 3\n", versions.len());
    assert!(taken.starts_with(&newest), "{taken}");
}

#[test]
fn a_store_that_writes_over_what_is_there_is_not_published_to() {
    let server = FaultyServer::start(Fault::WritesOver);
    let plant = Plant::at(server.endpoint());
    let publish = ["publish", "--to", "s3://parts", "--key", "keys/library.key"];
    let text = plant.refused(&[&publish[..], &["--library", "parts"]].concat());
    assert!(text.contains("ignores If-None-Match"), "{text}");
    let written = server.written();
    assert!(!written.is_empty(), "it was tried");
    assert!(
        written.iter().all(|name| !name.contains("manifests")),
        "{written:?}"
    );
}

#[test]
fn a_version_counts_though_the_answer_of_the_store_was_lost() {
    let server = FaultyServer::start(Fault::LosesAnswers);
    let plant = Plant::at(server.endpoint());
    let published = plant.publish("s3://parts");
    assert!(
        published.starts_with("Published version 1: parts: 3\n"),
        "{published}"
    );
    let written = server.written();
    assert!(
        written.iter().any(|name| name.contains("manifests")),
        "{written:?}"
    );
}

#[test]
fn what_a_store_refuses_is_said_in_words_with_what_to_do() {
    for (status, code, words) in [
        ("404 Not Found", "NoSuchBucket", "there is no such bucket"),
        ("403 Forbidden", "InvalidAccessKeyId", "AWS_ACCESS_KEY_ID"),
        (
            "403 Forbidden",
            "AccessDenied",
            "permission to list and read",
        ),
        ("301 Moved Permanently", "PermanentRedirect", "AWS_REGION"),
        (
            "503 Service Unavailable",
            "SlowDown",
            "503 Service Unavailable, SlowDown",
        ),
    ] {
        let server = FaultyServer::start(Fault::Refuses(status, code));
        let plant = Plant::at(server.endpoint());
        let text = plant.refused(&take_from("s3://parts"));
        assert!(
            text.contains("error: s3://parts: cannot list the versions: "),
            "{text}"
        );
        assert!(text.contains(words), "{text}");
        for internal in ["<?xml", "Generic", "retries", "http://"] {
            assert!(!text.contains(internal), "{text}");
        }
    }
}

#[test]
fn an_endpoint_without_encryption_needs_permission_and_a_wrong_one_is_named() {
    let mut plant = Plant::new();
    plant.endpoint = Some(s3::closed_endpoint());
    let mut command = plant.command(&take_from("s3://parts"));
    let (code, text) = words(&command.env_remove("AWS_ALLOW_HTTP").output().expect("ran"));
    assert_eq!(code, Some(2), "{text}");
    assert!(
        text.contains("nothing would be encrypted") && text.contains("https://"),
        "{text}"
    );
    plant.endpoint = Some("minio:9000".into());
    let text = plant.refused(&take_from("s3://parts"));
    assert!(text.contains("AWS_ENDPOINT is \"minio:9000\""), "{text}");
}

#[test]
fn the_versions_of_a_store_are_listed_with_the_one_that_is_here() {
    let plant = Plant::new();
    fs::create_dir(plant.path("store")).expect("made");
    plant.publish("store");
    plant.accepted(&take_from("store"));
    plant.accepted(&["remove", "fender", "--library", "parts"]);
    plant.publish("store");
    let versions = ["versions", "store", "--library", "cell"];
    let listed = plant.accepted(&versions);
    let lines: Vec<&str> = listed.lines().collect();
    let [heading, second, first] = lines[..] else {
        panic!("{listed}");
    };
    assert!(heading.starts_with("VERSION  PUBLISHED"), "{listed}");
    assert!(
        second.starts_with("2 ") && !second.contains("taken"),
        "{listed}"
    );
    assert!(
        first.starts_with("1 ") && first.contains("taken"),
        "{listed}"
    );
    let json = plant.accepted(&[&versions[..], &["--json"]].concat());
    let lines = json
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"));
    let lines: Vec<serde_json::Value> = lines.collect();
    let fields = lines.iter().map(|line| {
        assert_eq!(line["note"], "tried");
        let number = |name: &str| line[name].as_u64().expect("a number");
        (
            number("version"),
            number("num_parts"),
            line["taken"] == true,
        )
    });
    let fields: Vec<_> = fields.collect();
    assert_eq!(fields, [(2, 2, false), (1, 3, true)]);

    fs::write(plant.path("store/manifests/0000000002.txt"), "x").expect("written");
    let (code, text) = plant.run(&versions);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("the manifest is damaged"), "{text}");
    // The publisher took nothing.
    let version = plant.accepted(&["version", "--library", "parts"]);
    assert!(
        version.contains("no version was taken into this library")
            && version.contains("partsight library versions STORE"),
        "{version}"
    );
}

#[test]
fn a_spray_path_of_a_cell_is_no_obstacle_and_stays() {
    let plant = Plant::new();
    fs::create_dir(plant.path("store")).expect("made");
    plant.publish("store");
    plant.accepted(&take_from("store"));
    let table =
        "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n0,0,1150,0,0,1\n";
    fs::write(plant.path("path.csv"), table).expect("written");
    // Wherever it lies over the part, it is stored.
    let (_, text) = plant.run(&["path", "grille", "path.csv", "--library", "cell"]);
    assert!(text.contains("Stored path.csv with grille"), "{text}");
    plant.publish("store");
    let taken = plant.accepted(&take_from("store"));
    assert!(taken.contains("  kept path grille\n"), "{taken}");
    let version = plant.accepted(&["version", "--library", "cell"]);
    assert!(
        version.contains("  changed   grille (spray path stored here)\n"),
        "{version}"
    );
}

#[test]
fn without_the_store_there_is_an_error_and_the_library_works_as_before() {
    let mut plant = Plant::new();
    fs::create_dir(plant.path("store")).expect("made");
    plant.publish("store");
    plant.accepted(&take_from("store"));
    let before = contents(&plant.path("cell"));
    fs::rename(plant.path("store"), plant.path("gone")).expect("moved");
    let text = plant.refused(&take_from("store"));
    assert!(text.contains("store: cannot be used"), "{text}");
    assert!(!plant.path("store").exists());

    // No server listens at a port that was just free.
    plant.endpoint = Some(s3::closed_endpoint());
    let text = plant.refused(&take_from("s3://parts"));
    assert!(
        text.contains("s3://parts: cannot list the versions"),
        "{text}"
    );
    assert!(text.to_lowercase().contains("connection refused"), "{text}");
    let text = plant.refused(&take_from(&format!("s3://cell:{SECRET}@parts")));
    assert!(
        text.contains("credentials come from the environment"),
        "{text}"
    );

    assert_eq!(contents(&plant.path("cell")), before);
    let listed = plant.accepted(&["list", "--library", "cell"]);
    assert!(
        listed.contains("3 parts") && listed.contains("version 1 of store"),
        "{listed}"
    );
}

#[test]
fn what_somebody_changed_in_the_store_is_refused_with_what_to_do() {
    let plant = Plant::new();
    fs::create_dir(plant.path("store")).expect("made");
    plant.publish("store");
    let found = fs::read_dir(plant.path("store/bundles")).expect("there");
    let bundle = found.last().expect("one").expect("an entry").path();
    let mut bytes = fs::read(&bundle).expect("read");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&bundle, bytes).expect("written");
    let text = plant.refused(&take_from("store"));
    assert!(
        text.contains("the bundle is damaged or was changed"),
        "{text}"
    );
    plant.accepted(&["keys", "others"]);
    let mut other = take_from("store");
    other[4] = "others/library.pub";
    let text = plant.refused(&other);
    assert!(text.contains("signed with the key"), "{text}");
    let another = ["--key", "others/library.key", "--library", "parts"];
    let text = plant.refused(&[&["publish", "--to", "store"][..], &another].concat());
    assert!(text.contains("but your key is"), "{text}");
    // No key is ever replaced.
    plant.refused(&["keys", "keys"]);
}

#[test]
fn parts_enrolled_here_are_kept_until_they_may_be_replaced() {
    let plant = Plant::new();
    fs::create_dir(plant.path("store")).expect("made");
    plant.publish("store");
    plant.accepted(&take_from("store"));
    plant.accepted(&["rename", "grille", "--to", "my_grille", "--library", "cell"]);
    plant.publish("store");
    let text = plant.refused(&take_from("store"));
    assert!(
        text.contains("my_grille (enrolled here)") && text.contains("--replace"),
        "{text}"
    );
    let version = plant.accepted(&["version", "--library", "cell"]);
    let changed = "  changed   my_grille (enrolled here), grille (removed here)\n";
    assert!(version.contains(changed), "{version}");
    let taken = plant.accepted(&[&take_from("store")[..], &["--replace"]].concat());
    assert!(taken.contains("  in .trash my_grille-"), "{taken}");
    assert_eq!(
        contents(&plant.path("cell")),
        contents(&plant.path("parts"))
    );
    plant.accepted(&["restore", "my_grille", "--library", "cell"]);
    let listed = plant.accepted(&["list", "--library", "cell"]);
    assert!(
        listed.contains("version 2 of store, changed here since"),
        "{listed}"
    );
}

#[test]
fn a_program_that_is_killed_while_it_takes_leaves_one_version_whole() {
    const NUM_KILLS: usize = 40;
    let plant = Plant::new();
    fs::create_dir(plant.path("store")).expect("made");
    plant.publish("store");
    let first = contents(&plant.path("parts"));
    plant.accepted(&[
        "rename",
        "grille",
        "--title",
        "Grille 2",
        "--library",
        "parts",
    ]);
    plant.accepted(&["rename", "fender", "--to", "mudguard", "--library", "parts"]);
    plant.publish("store");
    let second = contents(&plant.path("parts"));
    plant.accepted(&take_from("store"));
    let cell = plant.path("cell");
    let library = LibraryFolder::open(&cell).expect("there");
    let mut random = rand_pcg::Pcg64::seed_from_u64(2_027);
    for kill in 0..NUM_KILLS {
        let version = ["1", "2"][kill % 2];
        let mut child = plant
            .command(&[&take_from("store")[..], &["--version", version]].concat())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("starts");
        thread::sleep(Duration::from_micros(random.random_range(0..400_000)));
        // SIGKILL, if it still runs: the process cannot clean up.
        let _ = child.kill();
        child.wait().expect("ended");
        let load = library.load(&ReferenceParams::default()).expect("listed");
        assert!(load.problems.is_empty(), "kill {kill}: {:?}", load.problems);
        let record = TakenBundle::read(&library).expect("read").expect("taken");
        let differences = record.differences(&library).expect("compared");
        assert_eq!(differences, Vec::<LocalPart>::new(), "kill {kill}");
    }
    for (version, expected) in [("1", &first), ("2", &second)] {
        plant.accepted(&[&take_from("store")[..], &["--version", version]].concat());
        assert_eq!(contents(&cell), *expected);
    }
}
