//! Damaged and hostile files, each inspected by the built program in a process of its own: none is accepted, crashes
//! the program, keeps it busy, or takes more than a gigabyte.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::mpsc,
    thread,
    time::Duration,
};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use crate::data_folder;

/// Address space of the process, in KiB.
const MAX_KIB: u64 = 1 << 20;
/// Seconds of processor time after which it counts as hanging.
const MAX_SECONDS: u64 = 10;
/// Wall time after which it counts as blocked.
const PATIENCE: Duration = Duration::from_mins(2);

/// Runs `partsight inspect` with these arguments under the limits; `None` if this build has no program.
fn inspect(arguments: &[&str]) -> Option<Output> {
    let program = option_env!("CARGO_BIN_EXE_partsight")?;
    let limits =
        format!("ulimit -v {MAX_KIB}; ulimit -t {MAX_SECONDS}; exec \"$0\" inspect \"$@\"");
    let child = Command::new("sh")
        .args(["-c", &limits, program])
        .args(arguments)
        .args(["--json", "--no-history", "--library", "reference_parts"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    let id = child.id();
    let (sender, ended) = mpsc::channel();
    thread::spawn(move || sender.send(child.wait_with_output()));
    if let Ok(output) = ended.recv_timeout(PATIENCE) {
        return Some(output.expect("its output"));
    }

    let _ = Command::new("kill").args(["-9", &id.to_string()]).status();
    panic!("{arguments:?} did not end");
}

/// The lines of JSON of a run, which must end by itself.
fn lines_of(arguments: &[&str]) -> Option<Vec<serde_json::Value>> {
    let output = inspect(arguments)?;
    let reply = String::from_utf8_lossy(&output.stderr);
    assert!(
        matches!(output.status.code(), Some(0..=2)) && !reply.contains("panicked"),
        "{arguments:?}: {:?}\n{reply}",
        output.status
    );
    let shown = String::from_utf8(output.stdout).expect("text");
    let lines = shown
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"));
    Some(lines.collect())
}

fn hostile_files() -> Option<Vec<PathBuf>> {
    let folder = data_folder()?.join("hostile");
    let listed = fs::read_dir(folder).expect("the folder of hostile files");
    let mut files: Vec<PathBuf> = listed
        .map(|entry| entry.expect("listed").path())
        .filter(|path| path.is_file() && path.extension().is_some_and(|ending| ending != "md"))
        .collect();
    files.sort();
    assert!(files.len() >= 13, "{files:?}");
    Some(files)
}

#[test]
fn no_hostile_file_is_accepted_or_breaks_anything() {
    let Some(files) = hostile_files() else {
        return;
    };
    for file in &files {
        let file = file.to_str().expect("a plain name");
        let Some(lines) = lines_of(&[file]) else {
            return;
        };
        let [line] = lines.as_slice() else {
            panic!("{file}: {lines:?}");
        };
        assert_eq!(line["accepted"], false, "{file}: {line}");
        assert!(
            line["reason"]
                .as_str()
                .is_some_and(|reason| !reason.is_empty()),
            "{file}: {line}"
        );
    }
}

#[test]
fn a_watched_folder_goes_on_behind_a_scene_that_once_ended_it() {
    let Some(files) = hostile_files() else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let tiny = files
        .iter()
        .filter(|file| file.to_string_lossy().contains("panic_tiny"));
    for file in tiny {
        fs::copy(file, folder.path().join(file.file_name().expect("a name"))).expect("copied");
    }
    let source = format!("watch,from=all:{}", folder.path().display());
    let Some(lines) = lines_of(&["--source", &source, "--frames", "2"]) else {
        return;
    };
    assert_eq!(lines.len(), 2);
}

#[test]
fn a_recording_with_a_mistyped_path_ends_and_its_sound_frame_is_inspected() {
    let Some(folder) = data_folder() else {
        return;
    };
    let source = format!(
        "recording:{}",
        folder.join("hostile/recording_hang").display()
    );
    let Some(lines) = lines_of(&["--source", &source]) else {
        return;
    };
    let [missing, sound] = lines.as_slice() else {
        panic!("{lines:?}");
    };
    assert_eq!(missing["status"], "unreadable");
    assert!(
        missing["reason"].to_string().contains("no such file"),
        "{missing}"
    );
    assert_ne!(sound["status"], "unreadable", "{sound}");
}

/// Writes a PCD of `num_points` zeros in a packed block; each point has an additional field of `more` bytes.
fn packed_zeros(path: &Path, num_points: usize, more: usize) {
    let row = 12 + more;
    let mut bytes = format!(
        "VERSION 0.7\nFIELDS x y z _\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 {more}\nWIDTH {num_points}\n\
         HEIGHT 1\nPOINTS {num_points}\nDATA binary_compressed\n"
    )
    .into_bytes();
    let size = num_points * row;
    // One literal byte, then references of 264 bytes to the byte before.
    let mut packed = vec![0, 0];
    let num_references = (size - 1) / 264;
    packed.extend([0xE0, 0xFF, 0x00].repeat(num_references));
    for _ in 0..(size - 1) % 264 {
        packed.extend([0, 0]);
    }
    bytes.extend((packed.len() as u32).to_le_bytes());
    bytes.extend((size as u32).to_le_bytes());
    bytes.extend(packed);
    fs::write(path, bytes).expect("written");
}

#[test]
fn small_files_that_unpack_to_gigabytes_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    packed_zeros(&at("points.pcd"), 49_000_000, 1);
    packed_zeros(&at("fields.pcd"), 4_000_000, 1000);
    let png = PngEncoder::new_with_quality(
        fs::File::create(at("line.png")).expect("made"),
        CompressionType::Fast,
        FilterType::NoFilter,
    );
    let pixels = vec![0_u8; 100_000_000];
    image::ImageEncoder::write_image(png, &pixels, 1, 50_000_000, image::ExtendedColorType::L16)
        .expect("written");
    drop(pixels);
    fs::write(
        at("intrinsics.json"),
        r#"{"width":1,"height":50000000,"fx":500,"fy":500,"cx":0,"cy":0,"metres_per_unit":0.001}"#,
    )
    .expect("written");
    for name in ["points.pcd", "fields.pcd", "line.png"] {
        let path = at(name);
        let Some(lines) = lines_of(&[path.to_str().expect("a plain name")]) else {
            return;
        };
        assert_eq!(lines[0]["status"], "unreadable", "{}", lines[0]);
        assert!(
            lines[0]["reason"].to_string().contains("at most"),
            "{}",
            lines[0]
        );
    }
}
