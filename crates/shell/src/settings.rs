//! Settings kept from one start of the window to the next, in a text file that people can read and edit.

use std::{
    io,
    path::{Path, PathBuf},
    sync::{Arc, Mutex},
};

use serde::{Deserialize, Deserializer, Serialize, de::IntoDeserializer as _};
use toml::{Table, Value};

use crate::{
    cell::{AnswerSetup, ProgramSetup, ServoSettings},
    inspection::library_cache::LibraryCache,
    language::UnitSystem,
    notice::Notice,
    rack::RackInUse,
    roles::{LOCK_AFTER, Pin, RoleState, is_operators},
    session::{
        PaintTab, RememberedCell, Session, ShiftStarts, Source, ThemeChoice, UserRole,
        WorkspaceKind,
    },
    source::live::LiveState,
    state::State,
    trace::{current_trace::CurrentTrace, orders::Expecting},
};
use capture::SourceSpec;
use files::{FileError, advice_on, disk, user_settings, write_text};
use geometry::error::{Advice as _, lock};
use inspection::pipeline::{NamedRecipe, Recipe, RecipeLabel, parameters::is_valid};
use records::history::Traceability;
use robot::Convention;
use ui::{
    language::{Language, text},
    task::{Task, TaskRunner},
    user_error::UserError,
};

/// Version of the file format.
const SCHEMA: u32 = 1;
/// Maximum size of the file, bytes.
const MAX_BYTES: u64 = 1 << 20;
/// Valid sides of a window, logical pixels: other values come from a broken file or another desktop.
const SIDES: std::ops::RangeInclusive<f32> = 320.0..=16_384.0;

/// The remembered settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Version of the file format; a newer one is not read.
    pub schema: u32,
    /// The colour theme.
    pub theme: ThemeChoice,
    /// Units that are shown.
    pub units: UnitSystem,
    /// The language chosen in the window; `None` for the system's.
    #[serde(deserialize_with = "language")]
    pub language: Option<Language>,
    /// The convention in which poses are shown, copied and written.
    pub convention: Convention,
    /// The arm and the gun of robot programs.
    pub program: ProgramSetup,
    /// What is servoed.
    pub servo: ServoSettings,
    /// The tab of Paint that is shown.
    pub paint_tab: PaintTab,
    /// The workspace in front.
    pub workspace: WorkspaceKind,
    /// The library chosen in the window; `None` for the one that the command line would find.
    pub library: Option<PathBuf>,
    /// Recently opened scenes, newest first.
    pub recent: Vec<PathBuf>,
    /// Inner width and height of the window, logical pixels.
    pub window: Option<[f32; 2]>,
    /// Where Capture takes a scene from.
    pub source: Source,
    /// Whether the source was followed.
    pub live: bool,
    /// Parameters of the inspection; `None` for the defaults of the running version.
    pub recipe: Option<Recipe>,
    /// The name of the recipe.
    pub recipe_label: RecipeLabel,
    /// Number of frames that depth is averaged over while a source is followed.
    pub average: usize,
    /// Minutes without input after which the window returns to the operator's view.
    pub lock_after: u32,
    /// PIN of the engineer's view, if one is set.
    pub pin: Option<Pin>,
    /// The last role; with a PIN the window starts in the operator's view regardless.
    pub role: UserRole,
    /// Starts of the shifts, such as 06:00; the operator's view counts the parts since the last one.
    pub shifts: ShiftStarts,
    /// The calibration of the robot's cell in use.
    pub cell: RememberedCell,
    /// Whether and where robots are answered.
    pub answering: AnswerSetup,
    /// Production order and operator; the serial number is not kept.
    pub traceability: Traceability,
    /// Where parts may hang.
    pub rack: RackInUse,
    /// The table of orders in use.
    pub orders: Option<PathBuf>,
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
            servo: ServoSettings::default(),
            paint_tab: PaintTab::default(),
            workspace: WorkspaceKind::default(),
            library: None,
            recent: Vec::new(),
            window: None,
            source: Source::default(),
            live: false,
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
            rack: RackInUse::default(),
            orders: None,
        }
    }
}

impl Settings {
    /// Extracts the settings from the state.
    pub fn of(state: &State, window: Option<[f32; 2]>) -> Self {
        Self {
            schema: SCHEMA,
            theme: state.session.theme,
            units: state.session.units,
            language: state.session.chosen_language,
            convention: state.session.convention,
            program: state.session.program.clone(),
            servo: state.session.servo.clone(),
            paint_tab: state.session.paint_tab,
            workspace: state.session.workspace,
            library: state.session.chosen_library.clone(),
            recent: state.session.recent.clone(),
            window,
            source: state.session.source.clone(),
            live: state.session.is_live(),
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
            rack: state.session.rack.clone(),
            orders: state.session.expecting.orders().map(Path::to_owned),
        }
    }

    /// The settings without PIN, addresses of robots and cameras, order, and name of the operator.
    pub(crate) fn without_secrets(mut self) -> Self {
        if let Source::Camera(spec) = &mut self.source
            && let SourceSpec::Genicam(spec) = &mut **spec
        {
            spec.device = None;
        }
        self.pin = None;
        self.servo.address.clear();
        self.answering.at.address = AnswerSetup::default().at.address;
        self.traceability = Traceability::default();
        self
    }

    /// Makes the state to start with; its tasks run on `runner` and share `library_cache`.
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
            servo: self.servo,
            paint_tab: self.paint_tab,
            chosen_library: self.library,
            recent: self.recent,
            source: self.source,
            recipe: Arc::new(NamedRecipe {
                label: self.recipe_label,
                parameters: Arc::new(self.recipe.unwrap_or_default()),
            }),
            role,
            cell: self.cell,
            answering: self.answering,
            trace: CurrentTrace::starting(self.traceability),
            expecting: Expecting::starting(self.orders),
            shift_starts: self.shifts,
            rack: self.rack,
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

/// Path of the user's settings, if the system has a place for them.
pub fn users_file() -> Option<PathBuf> {
    user_settings()
}

/// The settings of a file, and the keys whose values cannot be used.
struct ReadSettings {
    settings: Settings,
    bad_keys: Vec<String>,
}

/// Reads a language by its name or its code, such as `en`.
fn language<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Language>, D::Error> {
    let Some(name) = Option::<String>::deserialize(from)? else {
        return Ok(None);
    };
    if let Some(language) = Language::from_locale(&name) {
        return Ok(Some(language));
    }
    Language::deserialize(name.into_deserializer()).map(Some)
}

/// Reads the file. A missing one is no error. An unusable one is set aside, which frees its name; one with unusable values
/// too, and the rest of it is written and used.
pub fn load(path: &Path) -> (Settings, Option<UserError>) {
    match read(path) {
        Ok(ReadSettings { settings, bad_keys }) => {
            let problem =
                (!bad_keys.is_empty()).then(|| values_not_used(path, &settings, &bad_keys));
            (settings, problem)
        }
        Err(FileError::NotFound { .. }) => (Settings::default(), None),
        Err(bad) => {
            let what = text!("shell-settings-not-used", why = bad.to_string());
            let advice = match set_aside(path) {
                Ok(aside) => text!(
                    "shell-settings-set-aside",
                    path = aside.display().to_string()
                ),
                Err(error) => move_away(&error),
            };
            (Settings::default(), Some(UserError { what, advice }))
        }
    }
}

/// Keeps a file with unusable values beside, and writes the others to its place.
fn values_not_used(path: &Path, settings: &Settings, bad_keys: &[String]) -> UserError {
    let advice = match set_aside(path) {
        Ok(aside) => {
            // If this fails, writing the next change reports it.
            let _ = save(path, settings);
            text!(
                "shell-settings-kept-beside",
                path = aside.display().to_string()
            )
        }
        Err(error) => move_away(&error),
    };
    UserError {
        what: text!(
            "shell-settings-values-not-used",
            keys = bad_keys.join(", "),
            num = bad_keys.len(),
            path = path.display().to_string()
        ),
        advice,
    }
}

fn move_away(error: &io::Error) -> String {
    text!("shell-settings-move-away", why = files::words_of(error))
}

/// Returns the last size of the window, without reporting problems with the file.
pub fn window_size(path: &Path) -> Option<[f32; 2]> {
    read(path).ok()?.settings.window
}

fn read(path: &Path) -> Result<ReadSettings, FileError> {
    let text = files::read_text(path, MAX_BYTES)?;
    let garbled = |error: toml::de::Error| FileError::Damaged {
        path: path.to_owned(),
        what: files::toml_problem(&text, &error),
    };
    let table: Table = files::parse_toml(path, &text, SCHEMA, garbled)?;
    let (table, mut bad_keys) = usable(table);
    let has_live = table.contains_key("live");
    let mut settings: Settings = table.try_into().map_err(garbled)?;
    if !has_live {
        // Formerly, the window always started to follow a watched folder.
        settings.live = settings.source.is_watched();
    }
    let is_sensible = |size: &[f32; 2]| size.iter().all(|side| SIDES.contains(side));
    settings.window = settings.window.filter(is_sensible);
    if bad_keys.iter().any(|key| key == "rack") {
        // Without the rack, parts would be accepted wherever they hang.
        settings.live = false;
        settings.answering.is_on = false;
    }
    let replaced = settings.program.replace_unusable().into_iter();
    bad_keys.extend(replaced.map(|key| format!("program.{key}")));
    let replaced = settings.servo.replace_unusable().into_iter();
    bad_keys.extend(replaced.map(|key| format!("servo.{key}")));
    Ok(ReadSettings { settings, bad_keys })
}

/// Removes the keys whose values cannot be used, and returns their names. Tables stay whole or go: half of a recipe, or
/// half of a robot's set-up, would be another one.
fn usable(mut table: Table) -> (Table, Vec<String>) {
    let is_bad = |(key, value): (&String, &Value)| {
        let alone = Table::from_iter([(key.clone(), value.clone())]);
        let read = alone.try_into::<Settings>();
        let is_usable = read.is_ok_and(|read| read.recipe.is_none_or(|recipe| is_valid(&recipe)));
        (!is_usable).then(|| key.clone())
    };
    let bad_keys: Vec<String> = table.iter().filter_map(is_bad).collect();
    table.retain(|key, _| !bad_keys.iter().any(|bad| bad == key));
    if bad_keys.iter().any(|key| key == "recipe") {
        table.remove("recipe_label");
    }
    (table, bad_keys)
}

/// Renames a file to a free name beside it.
pub fn set_aside(path: &Path) -> io::Result<PathBuf> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    for number in 1..1000 {
        let aside = path.with_extension(format!("broken-{number}.{ending}"));
        if !aside.exists() {
            disk::rename(path, &aside)?;
            return Ok(aside);
        }
    }
    Err(io::Error::other(
        "a thousand files have already been set aside",
    ))
}

/// Writes the file atomically.
pub fn save(path: &Path, settings: &Settings) -> Result<(), UserError> {
    let not_kept = |why: String, advice: &str| UserError {
        what: text!("shell-settings-not-kept", why = why),
        advice: text!("shell-settings-not-kept-advice", advice = advice),
    };
    let text = toml::to_string(settings)
        .map_err(|error| not_kept(error.to_string(), &text!("shell-report-settings")))?;
    let folder = path.parent().unwrap_or(Path::new("."));
    disk::create_dir_all(folder).map_err(|error| {
        let words = files::words_of(&error);
        not_kept(format!("{}: {words}", folder.display()), advice_on(&error))
    })?;
    write_text(path, &text).map_err(|error| not_kept(error.to_string(), &error.advice()))
}

/// Writes the settings whenever they change, in a task.
pub struct Memory {
    path: Option<PathBuf>,
    writing: Task<()>,
    /// Prevents an older write from finishing after a newer one.
    turn: Arc<Mutex<()>>,
    kept: Settings,
    has_changed: bool,
}

impl Memory {
    /// Without a path nothing is kept.
    pub fn new(path: Option<PathBuf>, kept: Settings, runner: &TaskRunner) -> Self {
        Self {
            path,
            writing: Task::new("settings", runner),
            turn: Arc::default(),
            kept,
            has_changed: false,
        }
    }

    /// Writes changed settings; returns a notice if writing failed.
    pub fn keep(&mut self, state: &State, ctx: &egui::Context) -> Option<Notice> {
        let path = self.path.as_ref()?;
        let window = ctx.input(|input| input.viewport().inner_rect.map(|rect| rect.size()));
        let window = window.map_or(self.kept.window, |size| Some([size.x, size.y]));
        let settings = Settings::of(state, window);
        if settings != self.kept {
            self.kept = settings.clone();
            self.has_changed = true;
            let path = path.clone();
            let turn = Arc::clone(&self.turn);
            self.writing
                .start(text!("shell-writing-settings"), move |context| {
                    let _turn = lock(&turn);
                    context.check()?;
                    save(&path, &settings).map_err(Into::into)
                });
        }
        self.writing.poll()?.err().map(Notice::from)
    }

    /// Writes what may not have been written yet.
    pub fn finish(&mut self) {
        if let Some(path) = &self.path
            && self.has_changed
        {
            self.writing.cancel();
            let _turn = lock(&self.turn);
            // The window is closing, so that an error can no longer be shown.
            let _ = save(path, &self.kept);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::inspection::source::ScanFiles;
    use geometry::units::Metres;
    use robot::program::ProgramParams;
    use serve::PoseKind;

    fn unusual() -> Settings {
        let mut recipe = Recipe::default();
        recipe.accept.min_score = 0.91;
        Settings {
            theme: ThemeChoice::Light,
            units: UnitSystem::MetresRadians,
            language: Some(Language::Spanish),
            convention: Convention::Staubli,
            paint_tab: PaintTab::Film,
            library: Some("/media/stick/reference_parts".into()),
            recent: vec!["a.pcd".into(), "b c.ply".into()],
            window: Some([1024.0, 768.0]),
            source: Source::Camera(Box::new(
                "recording,pace=step:a b".parse().expect("a source"),
            )),
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
                convention: Convention::Doosan,
            },
            ..Settings::default()
        }
    }

    #[test]
    fn what_is_saved_comes_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new").join("settings.toml");
        let scan = Settings {
            source: Source::Scan(ScanFiles {
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
    fn a_missing_file_is_no_problem() {
        let folder = tempfile::tempdir().expect("a folder");
        let (settings, problem) = load(&folder.path().join("settings.toml"));
        assert_eq!((settings, problem), (Settings::default(), None));
    }

    #[test]
    fn a_bad_file_is_set_aside_and_never_lost() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        let bad: [&[u8]; 3] = [b"theme = [", b"schema = 99\nnew = 1", b"\xff\xfe\x00"];
        for (number, contents) in bad.into_iter().enumerate() {
            fs::write(&path, contents).expect("written");
            let (settings, problem) = load(&path);
            assert_eq!(settings, Settings::default());
            let problem = problem.expect("said");
            let aside = folder
                .path()
                .join(format!("settings.broken-{}.toml", number + 1));
            assert!(problem.advice.contains(&aside.display().to_string()));
            assert_eq!(fs::read(&aside).expect("kept"), contents);
            assert!(!path.exists());
        }
    }

    #[test]
    fn only_the_values_that_cannot_be_used_go_back_to_their_defaults() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        let bad = [
            ("theme = \"Purple\"", "theme"),
            ("window = [\"wide\", 3]", "window"),
            ("shifts = [\"six\"]", "shifts"),
            ("language = \"klingon\"", "language"),
            (
                "[answering]\nis_on = true\nat = \"ascii=robot\"",
                "answering",
            ),
            ("[recipe.accept]\nmin_score = \"high\"", "recipe"),
            ("[recipe.accept]\nmin_score = -5.0", "recipe"),
            ("[recipe.accept]\nmin_score = nan", "recipe"),
            ("[recipe.project]\npixel = 0.0", "recipe"),
            ("[recipe.signature]\nnum_rays = 300", "recipe"),
            ("[program]\nspeed = -1.0", "program.speed"),
        ];
        for (number, (line, key)) in bad.into_iter().enumerate() {
            let text = format!("average = 4\nlock_after = 15\n{line}\n");
            fs::write(&path, &text).expect("written");
            let (settings, problem) = load(&path);
            let kept = Settings {
                average: 4,
                lock_after: 15,
                ..Settings::default()
            };
            assert_eq!(settings, kept, "{line}");
            let problem = problem.expect("said");
            assert!(
                problem.what.starts_with(&format!("{key} in ")),
                "{problem:?}"
            );
            let aside = folder
                .path()
                .join(format!("settings.broken-{}.toml", number + 1));
            assert!(problem.advice.contains(&aside.display().to_string()));
            assert_eq!(fs::read_to_string(&aside).expect("kept"), text);
            // The next start has nothing to complain about.
            assert_eq!(load(&path), (kept, None), "{line}");
        }
    }

    #[test]
    fn a_language_may_be_given_by_its_code() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        for (name, language) in [
            ("en", Language::English),
            ("de", Language::German),
            ("es", Language::Spanish),
            ("zh", Language::Chinese),
            ("german", Language::German),
        ] {
            fs::write(&path, format!("language = \"{name}\"\n")).expect("written");
            let wanted = Settings {
                language: Some(language),
                ..Settings::default()
            };
            assert_eq!(load(&path), (wanted, None), "{name}");
        }
    }

    #[test]
    fn numbers_of_a_robot_program_that_cannot_be_are_named_and_the_usual_ones() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        let text = "[program]\narm = \"gp25\"\nspeed = nan\nblend = inf\nclearance = 0.03\n\
                    base = [nan, -800.0, 0.0, 500.0, 0.0, 90.0]\n";
        fs::write(&path, text).expect("written");
        let (settings, problem) = load(&path);
        let named = "program.speed, program.blend, program.base in ";
        let problem = problem.expect("said");
        assert!(problem.what.starts_with(named), "{problem:?}");
        let wanted = ProgramSetup {
            arm: Some("gp25".into()),
            base: [0.0, -800.0, 0.0, 0.0, 0.0, 90.0],
            params: ProgramParams {
                clearance: Metres(0.03),
                ..ProgramParams::default()
            },
            ..ProgramSetup::default()
        };
        assert_eq!(settings.program, wanted);
    }

    #[test]
    fn secrets_are_left_out_and_the_rest_stays() {
        let mut settings = unusual();
        settings.servo.address = "192.168.1.20".into();
        settings.traceability.operator = "Ada".into();
        let source = "genicam:192.168.1.30".parse().expect("a source");
        settings.source = Source::Camera(Box::new(source));
        let known = ["[pin]", "192.168.1", "Ada"];
        let text = toml::to_string(&settings).expect("text");
        assert!(known.iter().all(|secret| text.contains(secret)), "{text}");
        let text = toml::to_string(&settings.without_secrets()).expect("text");
        assert!(!known.iter().any(|secret| text.contains(secret)), "{text}");
        for kept in ["genicam", "eki=", "min_score = 0.91", "glossy"] {
            assert!(text.contains(kept), "{kept} in {text}");
        }
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
        files::disk::faults::Writer {
            test: "settings::tests::whichever_call_fails_the_settings_are_the_old_ones_or_the_new",
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

    #[test]
    fn an_older_write_does_not_replace_what_was_written_at_the_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        let runner = TaskRunner::without_threads();
        let mut memory = Memory::new(Some(path.clone()), Settings::default(), &runner);
        let mut state = State::default();
        state.session.live.params.average = 2;
        let none = memory.keep(&state, &egui::Context::default());
        assert!(none.is_none() && memory.writing.running().is_some());
        memory.kept.average = 5;
        memory.finish();
        // The job of the older settings comes to its turn only now.
        memory.writing.run_waiting();
        assert_eq!(load(&path).0.average, 5);
    }
}
