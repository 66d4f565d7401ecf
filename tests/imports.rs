//! Imports run down the list of layers in docs/ARCHITECTURE.md, and only the window and the command line use their
//! crates.
//!
//! Reads the `crate::…` paths, and the `super::…` paths that lead to the root, in all of `src` except its tests,
//! which may use any layer.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// Crates that only these folders may name.
const RESERVED: [(&str, &[&str]); 10] = [
    ("egui", &["app"]),
    ("eframe", &["app"]),
    ("rfd", &["app"]),
    ("clap", &["cli", "main"]),
    ("anyhow", &["cli"]),
    ("indicatif", &["cli"]),
    ("axum", &["plant"]),
    ("object_store", &["plant"]),
    ("tokio", &["plant"]),
    ("tokio_postgres", &["plant"]),
];

#[test]
fn imports_run_down_the_layers_of_the_architecture() {
    check_layers(&layers(0), &sources(&[]));
}

#[test]
fn imports_of_the_window_run_down_its_layers() {
    check_layers(&layers(1), &sources(&["app"]));
}

#[test]
fn no_workspace_imports_another() {
    for file in sources(&["app", "workspaces"]) {
        let imports = file.imports();
        assert!(imports.is_empty(), "{}: {imports:?}", file.path.display());
    }
}

#[test]
fn only_the_libraries_of_cameras_are_called_by_unsafe_code() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    let manifest = fs::read_to_string(manifest).expect("read");
    assert!(manifest.contains("\nunsafe_code = \"deny\"\n"));
    let allowing = sources(&[]).into_iter();
    let allowing = allowing.filter(|file| file.text.contains("unsafe_code"));
    let allowing: BTreeSet<PathBuf> = allowing.map(|file| file.path).collect();
    let known = [
        "capture/genicam/aravis.rs",
        "capture/kinect/freenect.rs",
        "capture/openni/oni.rs",
        "capture/realsense/librealsense.rs",
    ];
    assert_eq!(allowing, BTreeSet::from(known.map(PathBuf::from)));
}

fn check_layers(layers: &[Vec<String>], sources: &[Source]) {
    let rank = |name: &str| {
        layers
            .iter()
            .position(|layer| layer.contains(&name.to_owned()))
    };
    let mut uphill = Vec::new();
    let mut named = BTreeSet::new();
    for file in sources {
        let from = file.folder().to_owned();
        if matches!(from.as_str(), "lib" | "main" | "mod") {
            continue;
        }
        let Some(own) = rank(&from) else {
            panic!("src/{from} is not among the layers of docs/ARCHITECTURE.md");
        };
        named.insert(from.clone());
        for to in file.imports() {
            let Some(other) = rank(&to) else {
                panic!("{}: {to} is not among the layers", file.path.display());
            };
            // Modules of one layer, such as units and error, may use each other.
            if other > own {
                uphill.push(format!("{}: {from} -> {to}", file.path.display()));
            }
        }
    }
    assert!(
        uphill.is_empty(),
        "imports that run up:\n{}",
        uphill.join("\n")
    );
    let listed: BTreeSet<String> = layers.iter().flatten().cloned().collect();
    assert_eq!(named, listed, "folders of src and layers");
}

#[test]
fn crates_of_the_window_and_the_command_line_stay_there() {
    for file in sources(&[]) {
        for (name, folders) in RESERVED {
            let is_named = file.text.contains(&format!("{name}::"));
            assert!(
                !is_named || folders.contains(&file.folder()),
                "{} names {name}",
                file.path.display()
            );
        }
    }
}

#[test]
fn paths_in_all_their_forms_are_found() {
    let imports = |path: &str, text: &str| {
        let source = Source {
            module: &[],
            path: path.into(),
            text: code_of(text),
        };
        source.imports().into_iter().collect::<Vec<_>>().join(" ")
    };
    let nested = "use crate::{\n    a::{x, y},\n    b::C as D,\n    e,\n};\n// crate::comment\nfn f(_: crate::g::H) {}";
    assert_eq!(imports("files/open.rs", nested), "a b e g");
    assert_eq!(imports("files/open.rs", "use super::super::h::I;"), "h");
    assert_eq!(imports("files/open.rs", "use super::open;"), "");
    assert_eq!(imports("files/mod.rs", "use super::{i, j::K};"), "i j");
    assert_eq!(
        imports(
            "files.rs",
            "use super::l::M; #[cfg(test)]\nmod tests { use crate::n; }"
        ),
        "l"
    );
    let within = |path: &str, text: &str| {
        let source = Source {
            module: &["app"],
            path: path.into(),
            text: code_of(text),
        };
        source.imports().into_iter().collect::<Vec<_>>().join(" ")
    };
    let nested = "use crate::{a::b, app::{c::d, e::{F, g}}, h};\nuse crate::app::i::J;";
    assert_eq!(within("k/mod.rs", nested), "c e i");
    assert_eq!(
        within("k/l.rs", "use super::super::m::N; use super::o;"),
        "m"
    );
}

/// Reads the list of layers of this number in docs/ARCHITECTURE.md, from the bottom up; the modules of one layer
/// stand between two arrows.
fn layers(number: usize) -> Vec<Vec<String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/ARCHITECTURE.md");
    let text = fs::read_to_string(path).expect("the architecture");
    let mut lists = text.lines().filter(|line| line.contains(" ◄ "));
    let list = lists.nth(number).expect("the list");
    let names = |layer: &str| {
        layer
            .split(',')
            .map(|name| name.trim().to_owned())
            .collect()
    };
    list.split(" ◄ ").map(names).collect()
}

/// A file of `src` without comments and tests.
struct Source {
    /// The module whose parts are checked.
    module: &'static [&'static str],
    /// Path within the module's folder.
    path: PathBuf,
    text: String,
}

impl Source {
    /// The top-level folder or file of the module that the source belongs to.
    fn folder(&self) -> &str {
        let first = self.path.iter().next().and_then(|name| name.to_str());
        let first = first.expect("a name");
        first.strip_suffix(".rs").unwrap_or(first)
    }

    /// Number of `super` that lead from this file to the module.
    fn depth(&self) -> usize {
        let depth = self.path.iter().count();
        depth - usize::from(self.path.ends_with("mod.rs"))
    }

    /// The other folders and files of the module that it names.
    fn imports(&self) -> BTreeSet<String> {
        if self.depth() == 0 {
            // The module itself names its own parts.
            return BTreeSet::new();
        }
        let root = "super::".repeat(self.depth());
        let after = |start: &str| {
            let found = self.text.match_indices(start);
            // Skip `super::x` within `super::super::x`, and `$crate`.
            let is_whole = |at: &usize| {
                let before = self.text[..*at].chars().next_back();
                before.is_none_or(|c| !c.is_alphanumeric() && !matches!(c, '_' | ':' | '$'))
            };
            let places = found.map(|(at, _)| at).filter(is_whole);
            places
                .map(|at| &self.text[at + start.len()..])
                .collect::<Vec<_>>()
        };
        let mut names = BTreeSet::new();
        for rest in after("crate::") {
            names.extend(names_under(self.module, rest));
        }
        for rest in after(&root) {
            names.extend(names_under(&[], rest));
        }
        names.remove(self.folder());
        names
    }
}

/// The names that follow a module in a path; several if braces list them.
fn names_under(module: &[&str], path: &str) -> Vec<String> {
    let mut names = Vec::new();
    for item in items(path) {
        let is_letter = |c: char| c.is_alphanumeric() || c == '_';
        let end = item.find(|c| !is_letter(c)).unwrap_or(item.len());
        let (name, rest) = item.split_at(end);
        match module {
            [] if !name.is_empty() && name != "self" => names.push(name.to_owned()),
            [first, module @ ..] if name == *first => {
                if let Some(rest) = rest.strip_prefix("::") {
                    names.extend(names_under(module, rest));
                }
            }
            _ => {}
        }
    }
    names
}

/// The items of a path that begins with a list in braces, or the path itself.
fn items(path: &str) -> Vec<&str> {
    let Some(list) = path.strip_prefix('{') else {
        return vec![path];
    };
    let mut items = Vec::new();
    let (mut depth, mut start) = (0, 0);
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                items.push(list[start..at].trim());
                start = at + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    items
}

/// The text without comments, up to the first module of tests.
fn code_of(text: &str) -> String {
    let lines = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default());
    let code = lines.collect::<Vec<_>>().join("\n");
    let tests = code.find("#[cfg(test)]\nmod tests {");
    code[..tests.unwrap_or(code.len())].to_owned()
}

fn sources(module: &'static [&'static str]) -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let root = module.iter().fold(root, |folder, name| folder.join(name));
    let mut sources = Vec::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("listed") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let within = path.strip_prefix(&root).expect("within").to_owned();
            // Modules of tests in files of their own.
            let is_test = within
                .iter()
                .any(|name| name == "tests" || name == "tests.rs");
            if path.extension().is_some_and(|ending| ending == "rs") && !is_test {
                let text = code_of(&fs::read_to_string(&path).expect("text"));
                sources.push(Source {
                    module,
                    path: within,
                    text,
                });
            }
        }
    }
    let least = if module.is_empty() { 300 } else { 50 };
    assert!(sources.len() > least, "only {} files", sources.len());
    sources
}
