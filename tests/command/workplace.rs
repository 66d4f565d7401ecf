//! Folders in which tests run the built program.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::{Arc, Mutex, OnceLock},
    time::SystemTime,
};

use serde_json::Value;

/// A folder to work in, with the program's data folder at `data`.
pub(crate) struct Workplace {
    folder: tempfile::TempDir,
}

/// Exit code and outputs of a run.
pub(crate) struct Ran {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Workplace {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a folder"),
        }
    }

    pub(crate) fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A command of this program, with this folder as the user's own.
    pub(crate) fn command_of(&self, program: &str, args: &[&str]) -> Command {
        let mut command = Command::new(program);
        command
            .args(args)
            .current_dir(self.folder.path())
            // No window, even on a desktop: these tests read the terminal.
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_DATA_HOME", self.path("data"))
            .env("HOME", self.folder.path());
        if cfg!(windows) {
            // Its folders are not those of these variables.
            command.env("PARTSIGHT_DATA", self.path("data/partsight"));
        }
        command
    }

    pub(crate) fn command(&self, args: &[&str]) -> Command {
        self.command_of(crate::PROGRAM, args)
    }

    pub(crate) fn run(&self, args: &[&str]) -> Ran {
        self.command(args).output().expect("starts").into()
    }

    /// True if the program was built with the interfaces of a plant.
    pub(crate) fn has_plant(&self) -> bool {
        let help = self.accepted(&["serve", "--help"]);
        help.out.contains("--http-token-file")
    }

    /// Runs a command that must end with this code.
    pub(crate) fn coded(&self, code: i32, args: &[&str]) -> Ran {
        let ran = self.run(args);
        assert_eq!(ran.code, code, "{args:?}\n{}\n{}", ran.out, ran.err);
        ran
    }

    /// Runs a command that must succeed.
    pub(crate) fn accepted(&self, args: &[&str]) -> Ran {
        self.coded(0, args)
    }

    /// Enrols a simulated part into `parts` and leaves another capture of it in `NAME.pcd`.
    pub(crate) fn with_part(&self, name: &str) {
        self.with_made(&["part", name], |place| {
            let reference = format!("{name}-reference.pcd");
            let facing = ["--pose", "0 0 0 0 0 1.4", "--out", &reference];
            place.accepted(&[&["simulate", "--part", name], &facing[..]].concat());
            place.accepted(&["enrol", &reference, "--name", name, "--library", "parts"]);
            let capture = format!("{name}.pcd");
            let placed = ["--placement", "facing", "--seed", "5", "--out", &capture];
            place.accepted(&[&["simulate", "--part", name], &placed[..]].concat());
        });
    }

    /// Leaves here what `partsight simulate` writes with these arguments.
    pub(crate) fn simulated(&self, args: &[&str]) {
        let args = [&["simulate"], args].concat();
        self.with_made(&args, |place| {
            place.accepted(&args);
        });
    }

    /// Leaves here what is made in a folder of its own for the first test that asks for this key. What is made must not
    /// depend on where its folder is.
    pub(crate) fn with_made(&self, key: &[&str], make: impl FnOnce(&Self)) {
        type Files = Vec<(PathBuf, Vec<u8>)>;
        static MADE: Mutex<BTreeMap<Vec<String>, Arc<OnceLock<Files>>>> =
            Mutex::new(BTreeMap::new());
        let key = key.iter().map(|word| (*word).to_owned()).collect();
        let files = Arc::clone(MADE.lock().expect("sound").entry(key).or_default());
        let files = files.get_or_init(|| {
            let place = Self::new();
            make(&place);
            place.files()
        });
        for (name, bytes) in files {
            let path = self.path(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, bytes).expect("written");
        }
    }

    /// All files in this folder, with their paths in it.
    fn files(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let mut folders = vec![self.folder.path().to_owned()];
        let mut files = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("listed") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let name = path.strip_prefix(self.folder.path()).expect("below it");
                    files.push((name.to_owned(), fs::read(&path).expect("read")));
                }
            }
        }
        files
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("written");
    }

    /// Sets when the file was last written.
    pub(crate) fn date(&self, name: &str, at: SystemTime) {
        let file = fs::File::options().write(true).open(self.path(name));
        file.and_then(|file| file.set_modified(at)).expect("dated");
    }

    pub(crate) fn read(&self, name: impl AsRef<Path>) -> String {
        let path = self.path(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    pub(crate) fn json(&self, name: impl AsRef<Path>) -> Value {
        serde_json::from_str(&self.read(name)).expect("JSON")
    }
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code().expect("ended by itself"),
            out: String::from_utf8(output.stdout).expect("text"),
            err: String::from_utf8(output.stderr).expect("text"),
        }
    }
}

impl Ran {
    /// The whole output as JSON.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(self.out.trim()).expect("JSON")
    }

    /// Every line of the output as JSON.
    pub(crate) fn lines(&self) -> Vec<Value> {
        let parse = |line| serde_json::from_str(line).expect("a line of JSON");
        self.out.lines().map(parse).collect()
    }
}

/// The numbers of a JSON array.
pub(crate) fn matrix(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().expect("numbers");
    let number = |n: &Value| n.as_f64().expect("a number");
    numbers.iter().map(number).collect()
}
