//! The system's file dialogs, asked without waiting for them.

use std::{
    path::{Path, PathBuf},
    pin::Pin,
    sync::{Arc, Mutex, PoisonError},
    task::{Context, Poll, Wake, Waker},
    time::{Duration, Instant},
};

use super::{
    action::{Action, Ask},
    align::AlignAsk,
    state::{Notice, NoticeKind},
};

/// A dialog that is open.
pub(super) struct Dialog {
    ask: Ask,
    answer: Pin<Box<dyn Future<Output = Option<PathBuf>>>>,
    news: Arc<News>,
    /// When it was asked for first: only then does it open.
    opened: Option<Instant>,
}

/// What a person chose, once they have.
type Answer = Pin<Box<dyn Future<Output = Option<rfd::FileHandle>>>>;

/// Nobody closes a dialog as quickly as this: it never opened.
const TOO_QUICK: Duration = Duration::from_millis(250);

/// Woken by the dialog's own thread as soon as it has closed, however much later the next frame comes.
struct News {
    ctx: egui::Context,
    came: Mutex<Option<Instant>>,
}

impl News {
    fn came(&self) -> Option<Instant> {
        *self.came.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Wake for News {
    fn wake(self: Arc<Self>) {
        *self.came.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
        self.ctx.request_repaint();
    }
}

impl Dialog {
    pub(super) fn open(ask: Ask, ctx: &egui::Context) -> Self {
        let dialog = rfd::AsyncFileDialog::new();
        let answer: Answer = match ask {
            Ask::Scene => Box::pin(
                dialog
                    .set_title("Open a captured scene")
                    .add_filter(
                        "Captured scenes",
                        &["pcd", "ply", "xyz", "txt", "csv", "png"],
                    )
                    .add_filter("All files", &["*"])
                    .pick_file(),
            ),
            Ask::ReportFolder => Box::pin(
                dialog
                    .set_title("Folder for the report of this inspection")
                    .pick_folder(),
            ),
            Ask::HistoryCsv => Box::pin(
                dialog
                    .set_title("Export the listed inspections")
                    .set_file_name("inspections.csv")
                    .add_filter("Comma-separated values", &["csv"])
                    .save_file(),
            ),
            Ask::HistoryCases => Box::pin(
                dialog
                    .set_title("Folder for the cases of the listed inspections")
                    .pick_folder(),
            ),
            Ask::Library => Box::pin(dialog.set_title("Use another library").pick_folder()),
            Ask::Picture => Box::pin(
                dialog
                    .set_title("Save a picture of the view")
                    .set_file_name("view.png")
                    .add_filter("Pictures", &["png"])
                    .save_file(),
            ),
            Ask::Recording => Box::pin(dialog.set_title("Play a recording").pick_folder()),
            Ask::RecordTo => Box::pin(
                dialog
                    .set_title("Folder to record the source in")
                    .pick_folder(),
            ),
            Ask::WatchedFolder => Box::pin(
                dialog
                    .set_title("Folder that captures are saved to")
                    .pick_folder(),
            ),
            Ask::CasesFolder => Box::pin(dialog.set_title("Folder of kept cases").pick_folder()),
            Ask::EarlierRun => Box::pin(
                dialog
                    .set_title("What partsight evaluate --json has written")
                    .add_filter("Evaluations", &["json"])
                    .pick_file(),
            ),
            Ask::Align(AlignAsk::TableFile) => Box::pin(
                dialog
                    .set_title("Export Table I")
                    .set_file_name("table1.csv")
                    .add_filter("Comma-separated values", &["csv"])
                    .save_file(),
            ),
            Ask::Align(AlignAsk::Source | AlignAsk::Target) => Box::pin(
                anything_with_points(dialog)
                    .set_title("Open a cloud or a mesh")
                    .pick_file(),
            ),
            Ask::Calibration | Ask::SprayPath | Ask::PartPath | Ask::Pairs => of_robot(ask, dialog),
            Ask::Part => Box::pin(
                anything_with_points(dialog)
                    .set_title("Open a scene, a cloud or a mesh to enrol")
                    .pick_file(),
            ),
        };
        let answer = async move { Some(answer.await?.path().to_owned()) };
        Self::of(ask, answer, ctx)
    }

    fn of(
        ask: Ask,
        answer: impl Future<Output = Option<PathBuf>> + 'static,
        ctx: &egui::Context,
    ) -> Self {
        Self {
            ask,
            answer: Box::pin(answer),
            news: Arc::new(News {
                ctx: ctx.clone(),
                came: Mutex::new(None),
            }),
            opened: None,
        }
    }

    /// Ready once it was closed, with what follows from it, if anything.
    pub(super) fn poll(&mut self) -> Poll<Option<Action>> {
        let opened = *self.opened.get_or_insert_with(Instant::now);
        let waker = Waker::from(Arc::clone(&self.news));
        let answer = self.answer.as_mut();
        answer
            .poll(&mut Context::from_waker(&waker))
            .map(|path| match path {
                Some(path) => Some(Action::Chosen(self.ask, path)),
                None if self.stood_since(opened) < TOO_QUICK => Some(without_dialog(self.ask)),
                None => None,
            })
    }

    /// How long it stood. The clock of frames would not tell: behind Live, one may take longer than failing does.
    fn stood_since(&self, opened: Instant) -> Duration {
        let closed = self.news.came().unwrap_or_else(Instant::now);
        closed.saturating_duration_since(opened)
    }
}

/// What is asked about the robot's cell and spray paths.
fn of_robot(ask: Ask, dialog: rfd::AsyncFileDialog) -> Answer {
    let all: [&str; 1] = ["*"];
    match ask {
        Ask::Calibration => Box::pin(
            dialog
                .set_title("Load the calibration of the robot's cell")
                .add_filter("Calibrations", &["toml"])
                .add_filter("All files", &all)
                .pick_file(),
        ),
        Ask::SprayPath => Box::pin(
            dialog
                .set_title("Export the spray path for the robot")
                .set_file_name("spray-path.csv")
                .add_filter("Comma-separated values", &["csv"])
                .add_filter("JSON", &["json"])
                .save_file(),
        ),
        Ask::PartPath => Box::pin(
            dialog
                .set_title("The nozzle's path over this part")
                .add_filter("Tables", &["csv", "txt"])
                .add_filter("All files", &all)
                .pick_file(),
        ),
        _ => Box::pin(
            dialog
                .set_title("Pairs of robot and camera poses")
                .add_filter("Tables and JSON", &["csv", "txt", "json"])
                .add_filter("All files", &all)
                .pick_file(),
        ),
    }
}

fn anything_with_points(dialog: rfd::AsyncFileDialog) -> rfd::AsyncFileDialog {
    let endings = [
        "pcd", "ply", "xyz", "txt", "csv", "png", "stl", "obj", "gltf", "glb",
    ];
    dialog
        .add_filter("Scenes, clouds and meshes", &endings)
        .add_filter("All files", &["*"])
}

/// Where nothing can be asked: files to write go to a folder of their own, files to open can be dropped.
fn without_dialog(ask: Ask) -> Action {
    let name = match ask {
        Ask::ReportFolder | Ask::RecordTo | Ask::HistoryCases => "",
        Ask::HistoryCsv => "inspections.csv",
        Ask::Picture => "view.png",
        Ask::SprayPath => "spray-path.csv",
        Ask::Align(AlignAsk::TableFile) => "table1.csv",
        Ask::Scene
        | Ask::Recording
        | Ask::WatchedFolder
        | Ask::Library
        | Ask::CasesFolder
        | Ask::EarlierRun
        | Ask::Part
        | Ask::Calibration
        | Ask::Pairs
        | Ask::PartPath
        | Ask::Align(AlignAsk::Source | AlignAsk::Target) => return Action::Notify(never_opened()),
    };
    let folders = directories::UserDirs::new();
    let folder = folders.as_ref().map(|folders| {
        let documents = folders.document_dir();
        documents.unwrap_or(folders.home_dir()).join("Partsight")
    });
    // The folder is made here: what writes a file does not.
    match folder.map(|folder| std::fs::create_dir_all(&folder).map(|()| folder)) {
        Some(Ok(folder)) if name.is_empty() => Action::Chosen(ask, folder),
        Some(Ok(folder)) => Action::Chosen(ask, free(&folder, name)),
        Some(Err(_)) | None => Action::Notify(never_opened()),
    }
}

/// A path of this name in the folder that nothing has yet.
fn free(folder: &Path, name: &str) -> PathBuf {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    let numbered = (2..1000).map(|number| folder.join(format!("{stem}-{number}.{ending}")));
    std::iter::once(folder.join(name))
        .chain(numbered)
        .find(|path| !path.exists())
        .unwrap_or_else(|| folder.join(name))
}

fn never_opened() -> Notice {
    Notice {
        kind: NoticeKind::Look,
        what: "The desktop offers no file dialog".into(),
        advice:
            "Drop the file onto the window, or install the package xdg-desktop-portal-gtk or zenity"
                .into(),
    }
}

#[cfg(test)]
mod tests {
    use std::{future::poll_fn, thread};

    use super::*;

    /// A dialog that closes by itself after so long, with nothing chosen.
    fn closing_after(stands: Duration) -> Dialog {
        let mut thread = None;
        let answer = poll_fn(move |context| {
            if thread.is_some() {
                return Poll::Ready(None);
            }
            let waker = context.waker().clone();
            thread = Some(thread::spawn(move || {
                thread::sleep(stands);
                waker.wake();
            }));
            Poll::Pending
        });
        Dialog::of(Ask::Scene, answer, &egui::Context::default())
    }

    /// What follows where the next frame comes only once the dialog has long closed.
    fn after_a_slow_frame(mut dialog: Dialog) -> Poll<Option<Action>> {
        thread::sleep(TOO_QUICK);
        assert!(dialog.poll().is_pending());
        while dialog.news.came().is_none() {
            thread::sleep(Duration::from_millis(1));
        }
        thread::sleep(2 * TOO_QUICK);
        dialog.poll()
    }

    #[test]
    fn a_dialog_that_never_opened_is_told_from_a_cancelled_one_in_slow_frames_too() {
        let failed = after_a_slow_frame(closing_after(Duration::ZERO));
        assert!(matches!(failed, Poll::Ready(Some(Action::Notify(_)))));
        let cancelled = after_a_slow_frame(closing_after(2 * TOO_QUICK));
        assert!(matches!(cancelled, Poll::Ready(None)));
    }
}
