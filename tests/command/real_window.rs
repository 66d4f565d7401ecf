//! The built program in a real window on a virtual display: it is opened, keys are pressed, the screen is compared,
//! it is closed.
//!
//! Needs Xvfb, a display without a screen, and xdotool, which presses keys. If one of them is missing, the test
//! reports that it is skipped; `PARTSIGHT_REQUIRE_WINDOW=1` makes that a failure. `PARTSIGHT_WINDOW_PICTURES` names a
//! folder in which to keep the pictures.

use std::{
    env, fs,
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use crate::kit::facing_part;
use image::RgbImage;
use partsight::{
    files::save_cloud,
    simulate::{PartKind, Side},
};

const SIZE: (u32, u32) = (1440, 900);
/// Timeout with room for software rendering on a busy machine.
const PATIENCE: Duration = Duration::from_secs(90);

/// A virtual display, whose frame buffer is a file.
struct Display {
    server: Child,
    name: String,
    frame_buffer: PathBuf,
}

impl Display {
    fn start(folder: &Path) -> std::io::Result<Self> {
        let (width, height) = SIZE;
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0"])
            .arg(format!("{width}x{height}x24"))
            .arg("-fbdir")
            .arg(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let mut number = String::new();
        let out = server.stdout.take().expect("piped");
        BufReader::new(out).read_line(&mut number)?;
        assert!(!number.trim().is_empty(), "Xvfb did not start");
        Ok(Self {
            server,
            name: format!(":{}", number.trim()),
            frame_buffer: folder.join("Xvfb_screen0"),
        })
    }

    /// The present picture of the screen, from the X window dump that Xvfb keeps.
    fn picture(&self) -> RgbImage {
        let bytes = fs::read(&self.frame_buffer).expect("the frame buffer");
        let field = |index: usize| {
            let bytes = bytes[index * 4..index * 4 + 4].try_into();
            u32::from_be_bytes(bytes.expect("four bytes")) as usize
        };
        let (header, width, height) = (field(0), field(4), field(5));
        let (is_big_endian, bits, line, num_colours) =
            (field(7) == 1, field(11), field(12), field(19));
        assert_eq!(bits, 32, "bits per pixel");
        let pixels = &bytes[header + num_colours * 12..];
        RgbImage::from_fn(width as u32, height as u32, |x, y| {
            let at = y as usize * line + x as usize * 4;
            let [a, b, c, d] = [pixels[at], pixels[at + 1], pixels[at + 2], pixels[at + 3]];
            image::Rgb(if is_big_endian { [b, c, d] } else { [c, b, a] })
        })
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// The program, killed when dropped.
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn xdotool(display: &Display, words: &[&str]) -> String {
    let output = Command::new("xdotool")
        .args(words)
        .env("DISPLAY", &display.name)
        .output()
        .expect("xdotool");
    assert!(
        output.status.success(),
        "xdotool {words:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

/// Number of pixels that clearly differ.
fn num_different(a: &RgbImage, b: &RgbImage) -> usize {
    // Most pictures are of a screen that stands still.
    if a == b {
        return 0;
    }
    let differ = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 24)
    };
    a.pixels().zip(b.pixels()).filter(differ).count()
}

/// Waits until the screen does not change for a second, and keeps its picture.
fn still_picture(
    display: &Display,
    name: &str,
    is_awaited: impl Fn(&RgbImage) -> bool,
) -> RgbImage {
    let until = Instant::now() + PATIENCE;
    let mut last = display.picture();
    let mut since = Instant::now();
    loop {
        thread::sleep(Duration::from_millis(200));
        let now = display.picture();
        if num_different(&now, &last) > 20 {
            since = Instant::now();
        }
        last = now;
        let is_still = since.elapsed() > Duration::from_secs(1);
        if is_still && is_awaited(&last) {
            break;
        }
        assert!(
            Instant::now() < until,
            "{name} never came or never stood still"
        );
    }
    if let Some(folder) = env::var_os("PARTSIGHT_WINDOW_PICTURES") {
        let folder = PathBuf::from(folder);
        fs::create_dir_all(&folder).expect("a folder");
        last.save(folder.join(format!("{name}.png"))).expect("kept");
    }
    last
}

/// Number of colours: a window with its 3-D view has many, an empty screen few.
fn num_colours(picture: &RgbImage) -> usize {
    let colours: std::collections::HashSet<_> = picture.pixels().map(|p| p.0).collect();
    colours.len()
}

fn is_there(program: &str) -> bool {
    let paths = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&paths).any(|folder| folder.join(program).is_file())
}

#[test]
fn the_program_opens_a_file_shows_every_workspace_and_closes_with_code_0() {
    let missing: Vec<&str> = ["Xvfb", "xdotool"]
        .into_iter()
        .filter(|program| !is_there(program))
        .collect();
    if !missing.is_empty() {
        let lacking = format_args!("{} not installed", missing.join(" and "));
        return geometry::fixtures::skipped("PARTSIGHT_REQUIRE_WINDOW", lacking);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let scene_path = folder.path().join("captured.pcd");
    let scene = facing_part(PartKind::Fender, Side::Left, 5);
    save_cloud(&scene_path, &scene.cloud).expect("written");

    let display = Display::start(folder.path()).expect("Xvfb");
    let empty = display.picture();
    let program = Command::new(env!("CARGO_BIN_EXE_partsight"))
        .arg("--open")
        .arg(&scene_path)
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        // Use the test's own settings, cases and library, not the user's.
        .env("HOME", folder.path())
        .env("XDG_CONFIG_HOME", folder.path().join("config"))
        .env("XDG_DATA_HOME", folder.path().join("data"))
        .env("XDG_RUNTIME_DIR", folder.path())
        .current_dir(folder.path())
        .stderr(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("started");
    let mut program = Program(program);

    let first = still_picture(&display, "1_inspect", |picture| num_colours(picture) > 2000);
    assert!(num_different(&first, &empty) > 100_000, "no window");
    let window = xdotool(
        &display,
        &["search", "--onlyvisible", "--name", "Partsight"],
    );
    let window = window.lines().next().expect("a window").to_owned();
    xdotool(&display, &["windowfocus", "--sync", &window]);

    let mut last = first.clone();
    for (key, name) in [
        ("2", "2_enrol"),
        ("3", "3_compare"),
        ("4", "4_align"),
        ("5", "5_history"),
    ] {
        xdotool(&display, &["key", key]);
        let before = last.clone();
        last = still_picture(&display, name, |now| num_different(now, &before) > 10_000);
    }
    xdotool(&display, &["key", "1"]);
    let again = still_picture(&display, "6_inspect_again", |now| {
        num_different(now, &last) > 10_000
    });
    // The same result as at first, except for the pointer.
    assert!(num_different(&again, &first) < 20_000);

    xdotool(&display, &["key", "ctrl+q"]);
    let until = Instant::now() + PATIENCE;
    let status = loop {
        if let Some(status) = program.0.try_wait().expect("asked") {
            break status;
        }
        assert!(Instant::now() < until, "the window does not close");
        thread::sleep(Duration::from_millis(50));
    };
    let mut words = String::new();
    if let Some(mut errors) = program.0.stderr.take() {
        std::io::Read::read_to_string(&mut errors, &mut words).expect("read");
    }
    assert_eq!(status.code(), Some(0), "{words}");
    assert!(!words.contains("panicked"), "{words}");
    let settings = folder.path().join("config/partsight/settings.toml");
    assert!(settings.is_file(), "the settings are not remembered");
}
