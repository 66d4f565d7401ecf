//! Checks that every text of the code exists in every language with the same variables, and that every text of the files is
//! used.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use fluent_bundle::{FluentResource, concurrent::FluentBundle};
use skrifa::{FontRef, MetadataProvider as _};

use super::{Language, catalogue::files, keys, parameters};
use crate::task::{Task, TaskRunner};
use texts::{Files, LIBRARY};

/// Names of a message's variables.
type Variables = BTreeSet<String>;

/// Reads the messages of the files with their variables; checks that their ids are unique and begin with the area.
fn messages(files: Files) -> BTreeMap<String, Variables> {
    let mut messages: BTreeMap<String, Variables> = BTreeMap::new();
    for (area, file) in files {
        let mut id = String::new();
        for line in file.lines() {
            if line.starts_with(|c: char| c.is_ascii_alphabetic()) {
                let (name, _) = line.split_once(" =").expect("a message");
                id = name.to_owned();
                assert!(id.starts_with(&format!("{area}-")), "{id} in {area}.ftl");
                assert_eq!(messages.insert(id.clone(), Variables::new()), None, "{id}");
            }
            let names = line.split('$').skip(1).map(|rest| {
                let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
                let end = rest.find(|c| !is_of_name(c)).unwrap_or(rest.len());
                rest[..end].to_owned()
            });
            if let Some(variables) = messages.get_mut(&id) {
                variables.extend(names);
            }
        }
    }
    messages
}

/// Collects the messages that the code uses by name. It reads the source: no compiler knows a message that nothing uses, and
/// what finds those finds misspelt ones as well.
fn asked_for() -> BTreeMap<String, Variables> {
    let mut sources = Vec::new();
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for window in ["ui", "shell", "app"] {
        rust_files(&crates.join(window).join("src"), &mut sources);
    }
    let mut asked: BTreeMap<String, Variables> = BTreeMap::new();
    for path in sources {
        let code = fs::read_to_string(&path).expect("read");
        let lines = code
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        let code = lines.collect::<Vec<_>>().join("\n");
        for call in code.split("text!(").skip(1) {
            let Some((id, variables)) = call_of(call) else {
                continue;
            };
            let known = asked.entry(id.clone()).or_insert_with(|| variables.clone());
            assert_eq!(*known, variables, "{id} in {}", path.display());
        }
    }
    asked
}

/// Parses a call after its opening bracket into message id and variables; `None` if it does not name a message.
fn call_of(call: &str) -> Option<(String, Variables)> {
    let (id, rest) = call.trim_start().strip_prefix('"')?.split_once('"')?;
    let mut variables = Variables::new();
    let (mut depth, mut is_text, mut argument) = (1, false, String::new());
    let mut before = ' ';
    for letter in rest.chars() {
        match letter {
            '"' if before != '\\' => is_text = !is_text,
            _ if is_text => {}
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 1 => argument.clear(),
            '=' if depth == 1 && !argument.trim().is_empty() => {
                let name = argument.trim();
                if name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
                    variables.insert(name.to_owned());
                }
                argument.push(letter);
            }
            _ => argument.push(letter),
        }
        if depth == 0 {
            break;
        }
        before = letter;
    }
    Some((id.to_owned(), variables))
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs")
            // This file mentions calls without making them.
            && !path.ends_with("language/tests.rs")
        {
            found.push(path);
        }
    }
}

#[test]
fn every_text_of_the_code_is_in_every_language_and_none_is_left_over() {
    let asked = asked_for();
    assert!(asked.len() > 300, "{} found", asked.len());
    let of_parameters = parameters::message_ids().into_iter();
    let of_parameters: Vec<_> = of_parameters.map(|id| (id, Variables::new())).collect();
    for language in Language::ALL {
        let mut asked = asked.clone();
        if language != Language::English {
            asked.extend(of_parameters.iter().cloned());
        }
        let messages = messages(files(language));
        for (id, variables) in &asked {
            assert_eq!(Some(variables), messages.get(id), "{id} in {language:?}");
        }
        let unused: Vec<&String> = messages
            .keys()
            .filter(|id| !asked.contains_key(*id))
            .collect();
        assert!(
            unused.is_empty(),
            "in {language:?}, and nowhere used: {unused:?}"
        );
    }
}

#[test]
fn every_file_is_read_without_a_fault() {
    for language in Language::ALL {
        let mut bundle = FluentBundle::new_concurrent(Vec::new());
        for (area, file) in files(language) {
            let resource = FluentResource::try_new((*file).to_owned());
            let resource =
                resource.unwrap_or_else(|(_, faults)| panic!("{language:?}, {area}: {faults:?}"));
            let added = bundle.add_resource(resource);
            added.unwrap_or_else(|faults| panic!("{language:?}, {area}: {faults:?}"));
        }
    }
}

#[test]
fn a_call_is_read_with_its_variables() {
    let call = |code: &str| {
        let (id, variables) = call_of(code).expect("a call");
        (id, variables.into_iter().collect::<Vec<_>>().join(" "))
    };
    assert_eq!(call("\"a-b\"), \"x = 1\""), ("a-b".into(), String::new()));
    let nested =
        "\n  \"a-b\",\n  num = f(x, y == z),\n  name = format!(\"{q}, c = {}\", r),\n), d = 2";
    assert_eq!(call(nested), ("a-b".into(), "name num".into()));
    assert_eq!(call_of("$id)"), None);
}

#[test]
fn the_typefaces_have_every_letter_of_every_language() {
    let faces: [&[u8]; 2] = [
        include_bytes!("../../../../assets/fonts/Inter-Regular.otf"),
        include_bytes!("../../../../assets/fonts/NotoSansSC-Subset.otf"),
    ];
    let faces = faces.map(|face| FontRef::new(face).expect("a typeface"));
    for language in Language::ALL {
        let files = files(language).iter().chain(LIBRARY.files(language));
        let texts = files.map(|(_, file)| *file);
        let names = Language::ALL.map(Language::own_name);
        for letter in texts.chain(names).flat_map(str::chars) {
            let is_there = faces
                .iter()
                .any(|face| face.charmap().map(letter).is_some());
            assert!(is_there || letter == '\n', "{letter:?} in {language:?}");
        }
    }
}

#[test]
fn a_thread_speaks_one_language_and_a_task_that_of_its_starter() {
    assert_eq!(text!("shell-cancel"), "Cancel");
    Language::German.make_current();
    assert_eq!(text!("shell-cancel"), "Abbrechen");
    assert_eq!(keys("Ctrl Shift O"), "Strg Umschalt O");
    let mut task = Task::new("test", &TaskRunner::new(|| {}));
    task.start("", |_| Ok(text!("shell-cancel")));
    let label = loop {
        if let Some(event) = task.poll() {
            break event;
        }
    };
    assert_eq!(label, Ok("Abbrechen".to_owned()));
    let elsewhere = std::thread::spawn(|| text!("shell-cancel"));
    assert_eq!(elsewhere.join().expect("ended"), "Cancel");
}

#[test]
fn counts_choose_the_words_of_their_language() {
    let label = |num: usize| text!("shell-num-parts", num = num);
    for (language, one, many) in [
        (Language::English, "1 part", "2000 parts"),
        (Language::German, "1 Teil", "2000 Teile"),
        (Language::Spanish, "1 pieza", "2000 piezas"),
        (Language::Chinese, "1 个零件", "2000 个零件"),
    ] {
        language.make_current();
        assert_eq!([label(1), label(2000)], [one, many]);
    }
}

#[test]
fn a_percent_sign_stays_with_its_number() {
    for language in Language::ALL {
        language.make_current();
        let label = text!("enrol-most-similar", part = "Fender", percent = 2);
        assert!(label.contains("2\u{a0}%"), "{label}");
        let label = text!("enrol-most-similar-mirrored", part = "Fender", percent = 2);
        assert!(label.contains("2\u{a0}%"), "{label}");
    }
}
