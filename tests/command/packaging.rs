//! The files of the Debian package exist, and the programs that read them accept them.
//!
//! Checks whose program is missing report that they are skipped; with `PARTSIGHT_REQUIRE_PACKAGING=1` they fail.

use std::{
    fs, io,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use toml::{Table, Value};

/// Path of a file in the checkout.
fn at(path: impl AsRef<Path>) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn read(path: impl AsRef<Path>) -> String {
    let path = at(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The table `[package.metadata.deb]` of `Cargo.toml`.
fn metadata() -> Table {
    let mut table: Table = read("Cargo.toml").parse().expect("TOML");
    for name in ["package", "metadata", "deb"] {
        let Some(Value::Table(inner)) = table.remove(name) else {
            panic!("there is no table {name}");
        };
        table = inner;
    }
    table
}

fn text(value: &Value) -> &str {
    value.as_str().expect("text")
}

/// The files that an asset's source names; a file name may have one `*`.
fn sources(source: &str) -> Vec<String> {
    let (folder, pattern) = source.rsplit_once('/').unwrap_or(("", source));
    let entries = fs::read_dir(at(folder)).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let files = entries.map(|entry| entry.expect("an entry").path());
    let names = files
        .filter(|path| path.is_file())
        .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    let is_named = |name: &String| match pattern.split_once('*') {
        Some((begin, end)) => name.starts_with(begin) && name.ends_with(end),
        None => name == pattern,
    };
    names.filter(is_named).collect()
}

/// Where the package puts the files that are not built, without the leading `/`.
fn installed() -> Vec<String> {
    let metadata = metadata();
    let assets = metadata["assets"].as_array().expect("a list");
    let assets = assets
        .iter()
        .map(|asset| [text(&asset[0]), text(&asset[1])]);
    let files = assets
        .filter(|[source, _]| !source.starts_with("target/"))
        .map(|[source, target]| {
            let names = sources(source);
            assert!(!names.is_empty(), "there is no {source}");
            assert!(target.ends_with('/'), "{source}: {target} is no folder");
            names.into_iter().map(move |name| format!("{target}{name}"))
        });
    files.flatten().collect()
}

/// The value of a line `key=value`.
fn value_of<'a>(text: &'a str, key: &str) -> &'a str {
    let values = text.lines().filter_map(|line| line.strip_prefix(key));
    let mut values = values.filter_map(|rest| rest.strip_prefix('='));
    values.next().unwrap_or_else(|| panic!("no {key}="))
}

#[test]
fn every_file_of_the_package_is_there() {
    let metadata = metadata();
    let installed = installed();
    let is_installed = |path: &str| installed.iter().any(|file| file == path);
    assert!(at(text(&metadata["license-file"][0])).is_file());
    for path in metadata["conf-files"].as_array().expect("a list") {
        let path = text(path);
        assert!(is_installed(path.trim_start_matches('/')), "{path}");
    }
    // cargo-deb finds these by name and silently leaves out missing ones.
    let folder = at(text(&metadata["maintainer-scripts"]));
    let unit = text(&metadata["systemd-units"]["unit-name"]);
    for name in [
        format!("{unit}.service"),
        format!("{unit}.tmpfile"),
        "partsight.sysusers".to_owned(),
    ] {
        assert!(folder.join(&name).is_file(), "{name}");
    }
    let entry = read("packaging/partsight.desktop");
    let icon = value_of(&entry, "Icon");
    let icon = format!("usr/share/icons/hicolor/scalable/apps/{icon}.svg");
    assert!(is_installed(&icon), "{icon}");
    let unit = read("packaging/partsight-serve.service");
    for (key, begin) in [("EnvironmentFile", "/"), ("Documentation", "file:///")] {
        let path = value_of(&unit, key);
        let path = path.strip_prefix(begin).expect("a path");
        assert!(is_installed(path), "{key}: {path}");
    }
}

#[test]
fn every_example_of_the_service_starts_once_there_is_a_calibration() {
    let unit = read("packaging/partsight-serve.service");
    let starts = value_of(&unit, "ExecStart");
    assert_eq!(starts, "/usr/bin/partsight serve $ARGS");
    let conf = read("packaging/serve.conf");
    let lines = conf.lines().filter(|line| line.contains("ARGS="));
    // All are comments: only the integrator knows the camera and the robot.
    let examples = lines.map(|line| {
        let args = line.strip_prefix("# ARGS=\"");
        let args = args.and_then(|args| args.strip_suffix('"'));
        args.unwrap_or_else(|| panic!("{line}"))
    });
    let examples: Vec<&str> = examples.collect();
    assert!(!examples.is_empty());
    for example in examples {
        let missing = "no_such_cell.toml";
        let output = Command::new(env!("CARGO_BIN_EXE_partsight"))
            .arg("serve")
            .args(example.split(' '))
            .args(["--library", "reference_parts", "--calibration", missing])
            .current_dir(at(""))
            .output()
            .expect("runs");
        // Options, addresses and conventions are checked before the missing file.
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{example}: {words}");
        assert!(words.contains(missing), "{example}: {words}");
    }
}

/// Runs a program; returns `None`, with a message, if it is not installed.
fn run(command: &mut Command) -> Option<Output> {
    match command.output() {
        Ok(output) => Some(output),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let program = command.get_program().display();
            let lacking = format_args!("{program} is not installed");
            geometry::fixtures::skipped("PARTSIGHT_REQUIRE_PACKAGING", lacking);
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Both outputs of a program, which must have succeeded.
fn said_by(output: &Output) -> String {
    let streams = [&output.stdout, &output.stderr];
    let words = streams.map(|stream| String::from_utf8_lossy(stream));
    let words = words.concat();
    assert!(output.status.success(), "{words}");
    words
}

#[test]
fn the_help_of_the_three_cells_starts_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let output_with = |option| {
        let mut script = Command::new(at("packaging/three_cells.sh"));
        script
            .arg(option)
            .current_dir(&folder)
            .output()
            .expect("runs")
    };
    let words = said_by(&output_with("--help"));
    assert!(
        words.contains("packaging/three_cells.sh [FOLDER]"),
        "{words}"
    );
    assert!(!words.contains("set -"), "{words}");
    let wrong = output_with("--unheard-of");
    let words = String::from_utf8_lossy(&wrong.stderr);
    assert!(words.contains("no option --unheard-of"), "{words}");
    let mut left = fs::read_dir(&folder).expect("a folder");
    assert!(left.next().is_none(), "it made a folder");
}

#[test]
fn systemd_accepts_the_unit() {
    let unit = read("packaging/partsight-serve.service");
    // The unit's program must exist.
    let built = env!("CARGO_BIN_EXE_partsight");
    let unit = unit.replace("/usr/bin/partsight", built);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("partsight-serve.service");
    fs::write(&path, unit).expect("written");
    let verify = ["--man=no", "verify"];
    let output = run(Command::new("systemd-analyze").args(verify).arg(&path));
    if let Some(output) = output {
        // Unknown settings give only a message; messages about other units do not count.
        let words = said_by(&output);
        assert!(!words.contains("partsight-serve"), "{words}");
    }
}

#[test]
fn the_desktop_entry_is_valid() {
    let entry = at("packaging/partsight.desktop");
    if let Some(output) = run(Command::new("desktop-file-validate").arg(entry)) {
        let words = said_by(&output);
        assert_eq!(words, "");
    }
}

/// First version of systemd whose udevadm checks rules.
const VERIFIES_RULES: u32 = 254;

#[test]
fn udev_accepts_the_rules() {
    let Some(output) = run(Command::new("udevadm").arg("--version")) else {
        return;
    };
    let words = said_by(&output);
    let version: u32 = words.split_whitespace().next().map_or(0, |word| {
        word.parse()
            .unwrap_or_else(|error| panic!("{words}: {error}"))
    });
    if version < VERIFIES_RULES {
        println!("skipped: udevadm {version} has no verify, which {VERIFIES_RULES} has");
        return;
    }
    // The group plugdev exists on Debian only.
    let verify = ["verify", "--resolve-names=never"];
    let rules = at("packaging/55-partsight-cameras.rules");
    if let Some(output) = run(Command::new("udevadm").args(verify).arg(rules)) {
        said_by(&output);
    }
}

#[test]
fn the_zip_for_windows_holds_the_program_and_the_documents() {
    let folder = tempfile::tempdir().expect("a folder");
    let exe = folder.path().join("built.exe");
    fs::write(&exe, "the program").expect("written");
    let pack = |exe: &Path| {
        let mut python = Command::new("python3");
        python
            .arg(at("packaging/windows_zip.py"))
            .args([exe, folder.path()]);
        run(&mut python)
    };
    let Some(output) = pack(&exe) else {
        return;
    };
    let zip = said_by(&output);
    let list = run(Command::new("python3").args(["-m", "zipfile", "-l", zip.trim()]));
    let list = said_by(&list.expect("it ran before"));
    let documents = installed();
    let documents = documents
        .iter()
        .filter_map(|path| path.strip_prefix("usr/share/doc/partsight/"));
    for name in documents.chain(["partsight.exe"]) {
        let inside = format!("-x86_64-windows/{name} ");
        assert!(list.contains(&inside), "{name} is not in the zip: {list}");
    }
    let missing = pack(&folder.path().join("missing.exe")).expect("it ran before");
    assert!(!missing.status.success());
    let words = String::from_utf8_lossy(&missing.stderr);
    assert!(
        words.contains("no such file") && words.contains("to do:"),
        "{words}"
    );
}
