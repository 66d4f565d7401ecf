//! What is remembered from one start of the window to the next: a text file that a person can read and mend.

use std::{
    io::{self, Read as _},
    path::{Path, PathBuf},
    sync::Arc,
};

use serde::{Deserialize, Serialize};

use super::{
    current_trace::CurrentTrace,
    live::LiveState,
    program_setup::ProgramSetup,
    robot::AnswerSetup,
    roles::{LOCK_AFTER, Pin, RoleState, is_operators},
    session::{RememberedCell, Session, Source, ThemeChoice, UserRole, WorkspaceKind},
    shift::ShiftStarts,
    state::State,
};
use crate::{
    app::{
        inspection::{
            library_cache::LibraryCache, scan_choice::ScanFiles, source::CellChoice,
            unit_system::UnitSystem,
        },
        language::{Language, text},
        task::TaskRunner,
        user_error::UserError,
    },
    capture::SourceSpec,
    error::Advice as _,
    files::{advice_on, disk, open_regular, user_folders, write_atomically},
    history::Traceability,
    pipeline::{NamedRecipe, Recipe, RecipeLabel},
    robot::Convention,
};

/// The version of the file.
const SCHEMA: u32 = 1;
/// A larger file is no settings.
const MAX_BYTES: u64 = 1 << 20;
/// Sides of a window, logical pixels: beyond these a broken file or another desktop speaks.
const SIDES: std::ops::RangeInclusive<f32> = 320.0..=16_384.0;

/// What is remembered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Version of the file; a newer one is not read.
    pub schema: u32,
    /// Colours.
    pub theme: ThemeChoice,
    /// Units that are shown.
    pub units: UnitSystem,
    /// The language chosen in the window; none: the system's.
    pub language: Option<Language>,
    /// In which numbers the robot is told a pose.
    pub convention: Convention,
    /// The arm and the gun of robot programs.
    pub program: ProgramSetup,
    /// The workspace in front.
    pub workspace: WorkspaceKind,
    /// The library chosen in the window; none: the one found as on the command line.
    pub library: Option<PathBuf>,
    /// Scenes opened last, the newest first.
    pub recent: Vec<PathBuf>,
    /// Inner width and height of the window, logical pixels.
    pub window: Option<[f32; 2]>,
    /// What Capture takes a scene from.
    pub source: RememberedSource,
    /// Parameters of the inspection; none: the program's own, whatever they are in its version.
    pub recipe: Option<Recipe>,
    /// By which name the parameters go.
    pub recipe_label: RecipeLabel,
    /// Frames that depth is averaged over while a source is followed.
    pub average: usize,
    /// Minutes without a hand on the window until it is the operator's again.
    pub lock_after: u32,
    /// What the engineer's view asks for; none: nothing.
    pub pin: Option<Pin>,
    /// Whose the window was last; with a PIN it starts as the operator's all the same.
    pub role: UserRole,
    /// When shifts start, such as 06:00; the operator's view counts the parts since.
    pub shifts: ShiftStarts,
    /// Which calibration of the robot's cell is used.
    pub cell: RememberedCell,
    /// Whether robots that ask are answered, and where.
    pub answering: AnswerSetup,
    /// The order that is worked on, and the operator.
    pub traceability: Traceability,
}

/// A source, as the file has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RememberedSource {
    /// The simulated cell.
    Cell(CellChoice),
    /// A file.
    File(PathBuf),
    /// The shots of a scan.
    Scan(ScanFiles),
    /// A camera, a recording, a watched folder, or the simulated cell as somebody has set it up.
    Camera(SourceSpec),
}

impl Default for RememberedSource {
    fn default() -> Self {
        Self::Cell(CellChoice::default())
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            schema: SCHEMA,
            theme: ThemeChoice::default(),
            units: UnitSystem::default(),
            language: None,
            convention: Convention::default(),
            program: ProgramSetup::default(),
            workspace: WorkspaceKind::default(),
            library: None,
            recent: Vec::new(),
            window: None,
            source: RememberedSource::default(),
            recipe: None,
            recipe_label: RecipeLabel::default(),
            average: 1,
            lock_after: LOCK_AFTER[1],
            pin: None,
            role: UserRole::default(),
            shifts: ShiftStarts::default(),
            cell: RememberedCell::default(),
            answering: AnswerSetup::default(),
            traceability: Traceability::default(),
        }
    }
}

impl Settings {
    /// What of the state is remembered.
    pub fn of(state: &State, window: Option<[f32; 2]>) -> Self {
        Self {
            schema: SCHEMA,
            theme: state.session.theme,
            units: state.session.units,
            language: state.session.chosen_language,
            convention: state.session.convention,
            program: state.session.program.clone(),
            workspace: state.session.workspace,
            library: state.session.chosen_library.clone(),
            recent: state.session.recent.clone(),
            window,
            source: match &state.session.source {
                Source::Cell(choice) => RememberedSource::Cell(*choice),
                Source::File(path) => RememberedSource::File(path.clone()),
                Source::Scan(files) => RememberedSource::Scan(files.clone()),
                Source::Camera(spec) => RememberedSource::Camera((**spec).clone()),
            },
            recipe: (**state.session.recipe != Recipe::default())
                .then(|| Recipe::clone(&state.session.recipe)),
            recipe_label: state.session.recipe.label.clone(),
            average: state.session.live.params.average,
            lock_after: state.roles.lock_after,
            pin: state.roles.pin.clone(),
            role: state.session.role,
            shifts: state.session.shift_starts.clone(),
            cell: state.session.cell.clone(),
            answering: state.session.answering,
            traceability: state.session.trace.remembered(),
        }
    }

    /// True if nothing of this has changed.
    pub fn is_of(&self, state: &State, window: Option<[f32; 2]>) -> bool {
        let has_source = match (&self.source, &state.session.source) {
            (RememberedSource::Cell(a), Source::Cell(b)) => a == b,
            (RememberedSource::File(a), Source::File(b)) => a == b,
            (RememberedSource::Scan(a), Source::Scan(b)) => a == b,
            (RememberedSource::Camera(a), Source::Camera(b)) => *a == **b,
            _ => false,
        };
        let has_recipe = match &self.recipe {
            Some(recipe) => *recipe == **state.session.recipe,
            None => **state.session.recipe == Recipe::default(),
        } && self.recipe_label == state.session.recipe.label;
        has_source
            && has_recipe
            && self.theme == state.session.theme
            && self.units == state.session.units
            && self.language == state.session.chosen_language
            && self.convention == state.session.convention
            && self.program == state.session.program
            && self.workspace == state.session.workspace
            && self.library == state.session.chosen_library
            && self.recent == state.session.recent
            && self.average == state.session.live.params.average
            && self.lock_after == state.roles.lock_after
            && self.pin == state.roles.pin
            && self.role == state.session.role
            && self.shifts == state.session.shift_starts
            && self.cell == state.session.cell
            && self.answering == state.session.answering
            && self.traceability == state.session.trace.remembered()
            && self.window == window
    }

    /// The state to start in; its tasks are run by `runner` and share `library_cache`.
    pub fn into_state(self, runner: &TaskRunner, library_cache: &LibraryCache) -> State {
        let roles = RoleState::starting(self.pin.clone(), self.lock_after);
        let role = roles.first_role(self.role);
        let session = Session {
            theme: self.theme,
            units: self.units,
            language: self.language.unwrap_or_default(),
            chosen_language: self.language,
            workspace: match role {
                UserRole::Operator if !is_operators(self.workspace) => WorkspaceKind::Inspect,
                _ => self.workspace,
            },
            convention: self.convention,
            program: self.program,
            chosen_library: self.library,
            recent: self.recent,
            source: match self.source {
                RememberedSource::Cell(choice) => Source::Cell(choice),
                RememberedSource::File(path) => Source::File(path),
                RememberedSource::Scan(files) => Source::Scan(files),
                RememberedSource::Camera(spec) => Source::Camera(Box::new(spec)),
            },
            recipe: Arc::new(NamedRecipe {
                label: self.recipe_label,
                parameters: Arc::new(self.recipe.unwrap_or_default()),
            }),
            role,
            cell: self.cell,
            answering: self.answering,
            trace: CurrentTrace::starting(self.traceability),
            shift_starts: self.shifts,
            live: LiveState::averaging(self.average),
            ..Session::default()
        };
        State {
            session,
            roles,
            ..State::new(runner, library_cache)
        }
    }
}

/// The file of the user's settings, if the system has a place for it.
pub fn users_file() -> Option<PathBuf> {
    Some(user_folders()?.config_dir().join("settings.toml"))
}

/// Why a settings file was not used.
#[derive(Debug, thiserror::Error)]
enum BadSettings {
    #[error("it cannot be read: {}", crate::files::words_of(.0))]
    Unreadable(#[from] io::Error),
    #[error("it is larger than {MAX_BYTES} bytes")]
    TooLarge,
    #[error("it is not what Partsight writes ({0})")]
    Garbled(String),
    #[error("it was written by a newer version of Partsight ({found}, this one knows {SCHEMA})")]
    Newer { found: u32 },
}

/// All that every version of the file has.
#[derive(Deserialize)]
struct Versioned {
    #[serde(default)]
    schema: u32,
}

/// Reads the file. One that is not there is no trouble; a bad one is set aside, its place is free for the next.
pub fn load(path: &Path) -> (Settings, Option<UserError>) {
    match read(path) {
        Ok(settings) => (settings, None),
        Err(BadSettings::Unreadable(error)) if error.kind() == io::ErrorKind::NotFound => {
            (Settings::default(), None)
        }
        Err(bad) => {
            let what = text!(
                "shell-settings-not-used",
                path = path.display().to_string(),
                why = bad.to_string()
            );
            let advice = match set_aside(path) {
                Ok(aside) => text!(
                    "shell-settings-set-aside",
                    path = aside.display().to_string()
                ),
                Err(error) => text!(
                    "shell-settings-move-away",
                    why = crate::files::words_of(&error)
                ),
            };
            (Settings::default(), Some(UserError { what, advice }))
        }
    }
}

/// The size that the window had last, without judging the file.
pub(in crate::app) fn window_size(path: &Path) -> Option<[f32; 2]> {
    read(path).ok()?.window
}

fn read(path: &Path) -> Result<Settings, BadSettings> {
    let mut text = String::new();
    let file = open_regular(path)?;
    let num_read = file.take(MAX_BYTES + 1).read_to_string(&mut text)?;
    if num_read as u64 > MAX_BYTES {
        return Err(BadSettings::TooLarge);
    }
    let garbled = |error: toml::de::Error| {
        let message = error.message();
        BadSettings::Garbled(message.lines().next().unwrap_or(message).to_owned())
    };
    let Versioned { schema: found } = toml::from_str(&text).map_err(garbled)?;
    if found > SCHEMA {
        return Err(BadSettings::Newer { found });
    }
    let mut settings: Settings = toml::from_str(&text).map_err(garbled)?;
    let is_sensible = |size: &[f32; 2]| size.iter().all(|side| SIDES.contains(side));
    settings.window = settings.window.filter(is_sensible);
    settings.program = settings.program.checked();
    Ok(settings)
}

/// Moves a file to a free name beside it.
pub(in crate::app) fn set_aside(path: &Path) -> io::Result<PathBuf> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    for number in 1..1000 {
        let aside = path.with_extension(format!("broken-{number}.{ending}"));
        if !aside.exists() {
            disk::rename(path, &aside)?;
            return Ok(aside);
        }
    }
    Err(io::Error::other("a thousand were set aside before"))
}

/// Writes the file, whole or not at all.
pub fn save(path: &Path, settings: &Settings) -> Result<(), UserError> {
    let not_kept = |why: String, advice: &str| UserError {
        what: text!("shell-settings-not-kept", why = why),
        advice: text!("shell-settings-not-kept-advice", advice = advice),
    };
    let text = toml::to_string(settings)
        .map_err(|error| not_kept(error.to_string(), &text!("shell-report-settings")))?;
    let folder = path.parent().unwrap_or(Path::new("."));
    disk::create_dir_all(folder).map_err(|error| {
        let words = crate::files::words_of(&error);
        not_kept(format!("{}: {words}", folder.display()), advice_on(&error))
    })?;
    write_atomically(path, |writer| writer.write_all(text.as_bytes()))
        .map_err(|error| not_kept(error.to_string(), &error.advice()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::serve::PoseKind;

    fn unusual() -> Settings {
        let mut recipe = Recipe::default();
        recipe.accept.min_score = 0.91;
        Settings {
            theme: ThemeChoice::Light,
            units: UnitSystem::MetresRadians,
            language: Some(Language::Spanish),
            convention: Convention::Staubli,
            library: Some("/media/stick/reference_parts".into()),
            recent: vec!["a.pcd".into(), "b c.ply".into()],
            window: Some([1024.0, 768.0]),
            source: RememberedSource::Camera("recording,pace=step:a b".parse().expect("a source")),
            recipe: Some(recipe),
            recipe_label: RecipeLabel {
                name: "glossy".into(),
                is_changed: true,
            },
            average: 4,
            lock_after: 15,
            pin: Some(Pin::of("4711")),
            role: UserRole::Operator,
            shifts: ["05:30".to_owned(), "17:30".to_owned()]
                .to_vec()
                .try_into()
                .expect("times of day"),
            cell: RememberedCell::File("/media/stick/cell.toml".into()),
            answering: AnswerSetup {
                is_on: true,
                at: "eki=192.168.1.10:54600".parse().expect("an address"),
                pose: PoseKind::RobotOffset,
            },
            ..Settings::default()
        }
    }

    #[test]
    fn what_is_saved_comes_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new").join("settings.toml");
        let scan = Settings {
            source: RememberedSource::Scan(ScanFiles {
                frames: vec!["a b".into()],
                poses: Some("truth.json".into()),
                added: vec![("c.png".into(), "c.json".into())],
                dropped: ["d.png".into()].into(),
            }),
            ..Settings::default()
        };
        for settings in [Settings::default(), unusual(), scan] {
            save(&path, &settings).expect("saved");
            assert_eq!(load(&path), (settings.clone(), None));
            let runner = TaskRunner::without_threads();
            let state = settings
                .clone()
                .into_state(&runner, &LibraryCache::default());
            assert_eq!(Settings::of(&state, settings.window), settings);
        }
    }

    #[test]
    fn a_missing_file_is_no_trouble() {
        let folder = tempfile::tempdir().expect("a folder");
        let (settings, trouble) = load(&folder.path().join("settings.toml"));
        assert_eq!((settings, trouble), (Settings::default(), None));
    }

    #[test]
    fn a_bad_file_is_set_aside_and_never_lost() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        let bad: [&[u8]; 7] = [
            b"theme = [",
            b"theme = \"Purple\"",
            b"schema = 99\nnew = 1",
            b"\xff\xfe\x00",
            b"window = [\"wide\", 3]",
            b"shifts = [\"six\"]",
            b"[answering]\nat = \"ascii=robot\"",
        ];
        for (number, contents) in bad.into_iter().enumerate() {
            fs::write(&path, contents).expect("written");
            let (settings, trouble) = load(&path);
            assert_eq!(settings, Settings::default());
            let trouble = trouble.expect("said");
            let aside = folder
                .path()
                .join(format!("settings.broken-{}.toml", number + 1));
            assert!(trouble.advice.contains(&aside.display().to_string()));
            assert_eq!(fs::read(&aside).expect("kept"), contents);
            assert!(!path.exists());
        }
    }

    #[test]
    fn numbers_of_a_robot_program_that_cannot_be_are_the_usual_ones() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        let text =
            "[program]\narm = \"gp25\"\nspeed_mm_s = nan\nblend_mm = inf\nclearance_mm = 30.0\n";
        fs::write(&path, text).expect("written");
        let (settings, trouble) = load(&path);
        assert_eq!(trouble, None);
        let wanted = ProgramSetup {
            arm: Some("gp25".into()),
            clearance_mm: 30.0,
            ..ProgramSetup::default()
        };
        assert_eq!(settings.program, wanted);
    }

    #[test]
    fn a_window_of_no_size_opens_as_usual() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        fs::write(&path, "window = [0.0, nan]").expect("written");
        assert_eq!(load(&path).0.window, None);
    }

    #[cfg(unix)]
    #[test]
    fn whichever_call_fails_the_settings_are_the_old_ones_or_the_new() {
        let place = |folder: &Path| folder.join("deep").join("settings.toml");
        let averaged = |average| Settings {
            average,
            ..Settings::default()
        };
        crate::files::disk::faults::Writer {
            test: "app::shell::settings::tests::whichever_call_fails_the_settings_are_the_old_ones_or_the_new",
            prepare: &|folder| save(&place(folder), &averaged(2)).expect("written"),
            write: &|folder| {
                let saved = save(&place(folder), &averaged(5));
                saved.map_err(|error| format!("{}; {}", error.what, error.advice))
            },
            state: &|folder| {
                let (settings, error) = load(&place(folder));
                assert_eq!(error, None);
                settings.average.to_string()
            },
            between: &[],
        }
        .fails_at_every_call();
    }
}
