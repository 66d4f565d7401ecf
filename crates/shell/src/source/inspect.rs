//! Takes scenes from the source, inspects them and shows the results, with the library that they are compared with.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{
    inspector::{InspectorResult, PartAtHand, run},
    live,
};
use crate::{
    action::{Action, Event},
    inspection::{
        inspected::{InspectJob, Inspected},
        library_cache::{LibraryCache, LibraryView},
        source::{Origin, ScanOrder, SceneOrScan, SceneSource, file_name},
    },
    notice::{Notice, NoticeTopic},
    session::{
        Inspecting, ReinspectionPurpose, RememberedCell, Shown, Source, UserRole, WorkspaceKind,
    },
    state::{State, notify, remove_notices},
    trace::{current_trace::CurrentTrace, expecting},
};
use capture::SourceSpec;
use inspection::pipeline::Expected;
use records::history::{HungId, Traceability};
use robot::RobotFrame;
use stages::{rack::Rack, scene::EmptyCell};
use ui::{language::text, user_error::UserError};

impl State {
    /// Opens a file or a scan, which becomes the source unless it cannot be read, or is to be enrolled: then the result in front
    /// is still of the source.
    pub fn open(&mut self, source: Source) -> Option<Action> {
        if self.session.workspace == WorkspaceKind::Enrol {
            let (scene, title) = self.next_of(&source);
            return Some(Action::Take(scene, title));
        }
        if !expecting::may_inspect(self) {
            return None;
        }
        let former = std::mem::replace(&mut self.session.source, source);
        self.inspector.former_source.get_or_insert(former);
        self.capture()
    }

    /// The next scene or scan of a source, and the title for taking it.
    fn next_of(&mut self, source: &Source) -> (SceneOrScan, String) {
        match source {
            Source::Cell(choice) => {
                self.inspector.num_captures += 1;
                let source = SceneSource::Cell {
                    choice: *choice,
                    number: self.inspector.num_captures,
                };
                (SceneOrScan::Scene(source), text!("shell-capturing"))
            }
            Source::File(path) => (
                SceneOrScan::Scene(SceneSource::File(path.clone())),
                text!("shell-opening", name = file_name(path)),
            ),
            Source::Scan(files) => {
                let order = ScanOrder::Open(files.clone());
                let title = order.title();
                (SceneOrScan::Scan(order), title)
            }
            Source::Camera(spec) => {
                let title = match **spec {
                    SourceSpec::Watched(_) => text!("shell-waiting-for-file"),
                    _ => text!("shell-capturing"),
                };
                let source = SceneSource::Camera(spec.clone());
                (SceneOrScan::Scene(source), title)
            }
        }
    }

    /// Takes a scene from the source, to be inspected, or to be enrolled if Enrol is in front. Capturing for inspection stops
    /// following the source.
    pub fn capture(&mut self) -> Option<Action> {
        let source = self.session.source.clone();
        let (source, title) = self.next_of(&source);
        if self.session.workspace == WorkspaceKind::Enrol {
            // A file of the folder goes either to Live or to Enrol.
            if self.session.is_watching() {
                live::give_way(self);
                let stopped = Notice::look(
                    text!("enrol-live-stopped"),
                    text!("enrol-live-stopped-advice"),
                );
                notify(self, stopped.about(NoticeTopic::Following));
            }
            if !self.session.is_live() && self.session.source.followed().is_some() {
                // Another part may hang there now.
                live::outdate_shown(self);
            }
            return Some(Action::Take(source, title));
        }
        if self.session.source.followed().is_some() && live::tell_if_lost(self) {
            // Live goes on trying.
            return None;
        }
        if self.session.is_watching() {
            notify(self, Notice::done(text!("live-inspects-each")));
            return None;
        }
        if !expecting::may_inspect(self) {
            return None;
        }
        let ends_live = self.session.role == UserRole::Operator && self.session.is_live();
        let source = match (source, &self.session.empty_cell) {
            (SceneOrScan::Scene(source), Some(cell)) => {
                let source = SceneSource::WithEmptyCell(Arc::clone(cell), Box::new(source));
                SceneOrScan::Scene(source)
            }
            (source, _) => source,
        };
        let expected = self.session.expected().unwrap_or_default();
        let rack = self.session.rack.in_camera();
        let job = self.session.inspect_job(source, rack, expected);
        self.inspect(title, job);
        if let Some(run) = &mut self.session.inspecting {
            run.is_waiting = self.session.source.is_watched();
        }
        self.inspector.has_ended_live = ends_live;
        None
    }

    /// Says what ends Live, if a source is followed.
    fn tell_what_ends_live(&mut self, what: String) {
        if self.session.is_live() {
            notify(self, live_ended(what));
        }
    }

    /// Inspects a scene or a scan, as the part that Live sees if it follows the same source, else as a hung part of its own;
    /// stops following the source.
    fn inspect(&mut self, title: String, job: InspectJob) {
        if self.session.source.followed().is_some() {
            // Another part may hang there now, even if the capture fails.
            live::outdate_shown(self);
        }
        let trace = self.session.trace.clone();
        let part = if self.inspector.is_start {
            PartAtHand::MaybeSeen(CurrentTrace::default())
        } else if self.session.is_live() {
            PartAtHand::Followed(Arc::clone(&self.session.live.parts), trace)
        } else {
            PartAtHand::MaybeSeen(trace)
        };
        self.inspect_part(title, job, ReinspectionPurpose::New, part);
    }

    /// Inspects something again as an inspection of `hung`; without one, inspects it as something new. Stops following the
    /// source.
    pub fn inspect_again_as(
        &mut self,
        title: String,
        job: InspectJob,
        purpose: ReinspectionPurpose,
        hung: Option<HungId>,
        trace: Traceability,
    ) {
        let Some(hung) = hung else {
            return self.inspect(title, job);
        };
        if purpose == ReinspectionPurpose::Past {
            self.tell_what_ends_live(text!("live-ended-past"));
        }
        self.inspect_part(title, job, purpose, PartAtHand::Known(hung, trace));
    }

    fn inspect_part(
        &mut self,
        title: String,
        job: InspectJob,
        purpose: ReinspectionPurpose,
        part: PartAtHand,
    ) {
        live::give_way(self);
        let library_cache = self.begins(&title, purpose);
        let task = &mut self.inspector.task;
        task.start(title, move |context| {
            run(&job, part, &library_cache, context)
        });
    }

    /// Uses this calibration of the robot's cell. If the rack is moved by it, inspects the scene in front again.
    pub(crate) fn use_calibration(&mut self, cell: RememberedCell, robot: Option<Arc<RobotFrame>>) {
        self.inspector.library_cache.use_robot(robot.clone());
        let session = &mut self.session;
        let before = session.rack.clone();
        session.cell = cell;
        session.robot = robot;
        session.rack.follow(session.robot.as_deref());
        let is_moved = session.rack.in_camera() != before.in_camera();
        if is_moved && session.shown.is_some() {
            self.inspect_again();
        }
    }

    /// Cancels the running inspection. A file or a scan that was being opened does not become the source: the result in front is
    /// of the former one.
    pub(crate) fn cancel_inspection(&mut self) {
        self.inspector.task.cancel();
        self.session.inspecting = None;
        if let Some(former) = self.inspector.former_source.take() {
            self.session.source = former;
        }
    }

    /// Repeats the inspection of the scene in front because something that it depends on has changed.
    pub fn inspect_again(&mut self) {
        if self.session.is_live() {
            live::restart_consensus(self);
        } else {
            self.inspect_shown(
                &text!("shell-inspecting-again"),
                ReinspectionPurpose::Repeated,
            );
        }
    }

    /// Inspects the scene in front again with the current settings: another verdict on the same hung part. The part of a scene
    /// from the history hangs there no longer, nor may that of an outdated one: its inspection is only repeated, not new. One from
    /// the history is held against the rack of then.
    pub fn inspect_shown(&mut self, title: &str, purpose: ReinspectionPurpose) {
        live::show_unseen(self);
        if let Some(shown) = &self.session.shown {
            let purpose = if shown.is_past || shown.is_outdated {
                ReinspectionPurpose::Repeated
            } else {
                purpose
            };
            let part = PartAtHand::InFront(shown.parts.clone());
            let of_then = &shown.inspected.recipe;
            let rack = if shown.is_past {
                &of_then.rack
            } else {
                self.session.rack.in_camera()
            };
            let expected = of_then.expected.clone();
            let job = (self.session).inspect_job(shown.inspected.again(), rack, expected);
            self.inspect_part(title.to_owned(), job, purpose, part);
        }
    }

    /// True if this is the scene in front.
    fn is_in_front(&self, saved: &SceneOrScan) -> bool {
        let Some(Shown { inspected, .. }) = &self.session.shown else {
            return false;
        };
        match (saved, &inspected.scan) {
            (SceneOrScan::Scene(SceneSource::AtHand(scene, _)), None) => {
                Arc::ptr_eq(scene, &inspected.scene)
            }
            (SceneOrScan::Scan(ScanOrder::Known(choice)), Some(scan)) => {
                Arc::ptr_eq(&choice.set, &scan.fused.choice.set)
            }
            _ => false,
        }
    }

    /// Uses the changed library, and inspects with it what hangs there now: if Live is on, what the source shows, else the
    /// capture that was saved, if it is the newest, else the scene in front.
    pub fn library_changed(&mut self, library: &Arc<LibraryView>, saved: Option<SceneOrScan>) {
        if self.session.is_live() {
            self.use_library(library);
            return live::restart_consensus(self);
        }
        // It brings the library that it was inspected with.
        live::show_unseen(self);
        self.use_library(library);
        let (title, purpose) = (text!("shell-inspecting-again"), ReinspectionPurpose::New);
        let is_saved = saved.is_some();
        if let Some(saved) = saved.filter(|saved| !self.is_in_front(saved)) {
            // An enrolled part belongs to no order, and need not hang in the rack.
            let part = PartAtHand::Past(Traceability::default());
            let job = (self.session).inspect_job(saved, Rack::ANYWHERE, Expected::default());
            self.inspect_part(title, job, purpose, part);
        } else if is_saved || self.inspector.running().is_none() {
            self.inspect_shown(&title, purpose);
        }
    }

    /// Loads the library in this folder, or the one found when none is chosen. If that fails, the old library stays in use and
    /// the choice is not remembered.
    pub(crate) fn open_library(&mut self, chosen: Option<PathBuf>) {
        let title = text!("shell-opening-library");
        let library_cache = self.begins(&title, ReinspectionPurpose::Repeated);
        self.inspector.task.start(title, move |_| {
            let loaded = library_cache.choose(chosen.clone());
            let loaded = loaded.map_err(|error| UserError::of(&error))?;
            let shown = Arc::clone(&loaded.shown);
            Ok(InspectorResult::Library(shown, chosen))
        });
    }

    /// Records the start of a run; returns the shared data that it works with.
    fn begins(&mut self, title: &str, purpose: ReinspectionPurpose) -> LibraryCache {
        self.session.failed = None;
        self.session.inspecting = Some(Inspecting {
            title: title.to_owned(),
            purpose,
            is_waiting: false,
        });
        let inspector = &mut self.inspector;
        inspector.purpose = purpose;
        inspector.has_ended_live = false;
        inspector.library_cache.clone()
    }

    /// Shows another part of the frame in front.
    pub(crate) fn select_part(&mut self, index: usize) {
        if let Some(shown) = &mut self.session.shown
            && index != shown.selected()
            && let Some(part) = shown.parts.get(index)
        {
            self.generation += 1;
            shown.generation = self.generation;
            shown.inspected = Arc::clone(part);
        }
    }

    /// Shows a past inspection that is still in memory.
    pub fn show_past(&mut self, inspected: Arc<Inspected>) {
        self.tell_what_ends_live(text!("live-ended-past"));
        self.generation += 1;
        self.session.live.unseen.clear();
        self.session.shown = Some(Shown {
            is_past: true,
            ..Shown::new(self.generation, inspected)
        });
        self.session.workspace = WorkspaceKind::Inspect;
        self.session.failed = None;
        live::give_way(self);
    }

    /// Takes the scene in front as the empty cell.
    pub(crate) fn take_empty_cell(&mut self) {
        let Some(shown) = &self.session.shown else {
            return;
        };
        let stands_there = shown.inspected.inspection.segmentation.part.is_ok();
        let mut parts = shown.parts.iter();
        let cell = match EmptyCell::from_scene(&shown.inspected.scene) {
            _ if parts.any(|part| part.inspection.verdict.is_accepted()) => {
                let hangs_there = Notice::look(
                    text!("shell-cell-not-empty"),
                    text!("shell-cell-not-empty-advice"),
                );
                return notify(self, hangs_there);
            }
            Err(error) => return notify(self, UserError::of(&error).into()),
            Ok(cell) => cell,
        };
        self.session.empty_cell = Some(Arc::new(cell));
        let taken = if stands_there {
            Notice::look(
                text!("shell-empty-cell-doubt"),
                text!("shell-empty-cell-doubt-advice"),
            )
        } else {
            Notice::done(text!("shell-empty-cell-captured"))
        };
        notify(self, taken);
        live::restart_consensus(self);
    }

    /// Uses this library, and reports its problems once.
    pub(crate) fn use_library(&mut self, library: &Arc<LibraryView>) {
        let is_other = |known: &Arc<_>| !Arc::ptr_eq(known, library);
        if self.session.library.as_ref().is_none_or(is_other) {
            self.session.library = Some(Arc::clone(library));
            // The operator's view only shows problems that make recognition impossible.
            if self.session.role == UserRole::Engineer {
                self.report_library();
            }
        }
    }

    /// Reports entries of the library that were set aside, and other oddities.
    pub(crate) fn report_library(&mut self) {
        let library = self.session.library.clone();
        for problem in library.iter().flat_map(|library| &library.problems) {
            notify(self, problem.clone().into());
        }
    }
}

/// A notice of what ended Live.
fn live_ended(what: String) -> Notice {
    Notice::look(what, text!("live-ended-advice")).about(NoticeTopic::LiveEnded)
}

/// Polls the tasks; returns the event for all workspaces.
pub fn update(state: &mut State) -> Option<Event> {
    update_library(state);
    let event = state.inspector.task.poll();
    match state.inspector.running() {
        None => state.session.inspecting = None,
        Some(running) => {
            if let Some(run) = &mut state.session.inspecting {
                run.is_waiting &= running.stage.is_none();
            }
        }
    }
    match event? {
        Ok(result) => match result {
            InspectorResult::Inspected(parts) => {
                let event = show(state, parts);
                if std::mem::take(&mut state.inspector.has_ended_live) {
                    notify(state, live_ended(text!("live-ended")));
                }
                return Some(event);
            }
            InspectorResult::PosesWanted(order, error) => {
                notify(state, Notice::from(error).about(NoticeTopic::Scene));
                return Some(Event::PosesWanted(*order));
            }
            InspectorResult::Library(library, chosen) => {
                state.session.chosen_library = chosen;
                state.use_library(&library);
                state.inspect_again();
            }
        },
        Err(error) => {
            state.session.failed = Some(error.clone());
            let topic = match state.inspector.purpose {
                ReinspectionPurpose::New | ReinspectionPurpose::Past => NoticeTopic::Scene,
                ReinspectionPurpose::Repeated | ReinspectionPurpose::Shots => NoticeTopic::Other,
            };
            notify(state, Notice::from(error).about(topic));
            // A file that could not be inspected does not count as recent.
            let session = &mut state.session;
            if let Source::File(path) = &session.source {
                session.recent.retain(|known| known != path);
            }
            if let Some(former) = state.inspector.former_source.take() {
                session.source = former;
            }
        }
    }
    None
}

/// Shows a result made elsewhere as a new inspection; cancels a running one.
pub fn show_made(state: &mut State, inspected: Arc<Inspected>) -> Event {
    state.inspector.purpose = ReinspectionPurpose::New;
    state.cancel_inspection();
    show(state, vec![inspected])
}

fn show(state: &mut State, mut parts: Vec<Arc<Inspected>>) -> Event {
    state.inspector.former_source = None;
    let mut selected = 0;
    if let Some(former) = &state.session.shown {
        let former = &former.inspected;
        for (index, part) in parts.iter_mut().enumerate() {
            if part.hung() == former.hung() {
                selected = index;
            }
            // Inspected again, a scene is no newer than it was.
            if Arc::ptr_eq(&former.scene, &part.scene)
                && let Some(again) = Arc::get_mut(part)
            {
                again.set_captured_at(former.captured_at);
            }
        }
    }
    let inspected = Arc::clone(&parts[selected]);
    if let ReinspectionPurpose::New | ReinspectionPurpose::Past = state.inspector.purpose {
        remove_notices(state, NoticeTopic::Scene);
        remove_notices(state, NoticeTopic::Following);
    }
    for warning in &inspected.warnings {
        notify(state, Notice::of_scene(&inspected.origin, warning));
    }
    // An engineer inspects a file again on purpose.
    if state.inspector.purpose == ReinspectionPurpose::New
        && state.session.role == UserRole::Operator
        && let Some(former) = &state.session.shown
        && former.inspected.origin == inspected.origin
        && former.inspected.captured_at == inspected.captured_at
    {
        let what = text!("shell-same-capture", scene = inspected.origin.shown_title());
        let advice = text!("inspect-hold-choose-camera-operator");
        notify(state, Notice::look(what, advice).about(NoticeTopic::Scene));
    }
    state.use_library(&inspected.library);
    let shots = inspected.scan.as_ref();
    if let Origin::File { path, .. } = &inspected.origin {
        remember(&mut state.session.recent, path);
    } else if let Some(folder) = shots.and_then(|scan| scan.fused.choice.set.files.folder())
        && state.inspector.purpose != ReinspectionPurpose::Past
    {
        remember(&mut state.session.recent, folder);
    }
    for warning in shots.map_or(&[][..], |scan| &scan.fused.warnings) {
        let warning = Notice::from(warning.clone());
        notify(state, warning.about(NoticeTopic::Scene));
    }
    let purpose = state.inspector.purpose;
    state.generation += 1;
    state.session.failed = None;
    state.session.live.unseen.clear();
    // A result from the history stays past and an outdated one outdated, with whatever recipe or library it is inspected again.
    let former = state.session.shown.as_ref();
    let marks = |former: &Shown| (former.is_past, former.is_outdated);
    let (is_past, is_outdated) = match purpose {
        ReinspectionPurpose::Past => (true, false),
        ReinspectionPurpose::Repeated | ReinspectionPurpose::Shots => {
            former.map_or((false, false), marks)
        }
        ReinspectionPurpose::New => (false, false),
    };
    // Inspected again, a frame of Live is no newer than it was.
    let same_scene =
        former.filter(|former| !is_past && Arc::ptr_eq(&former.inspected.scene, &inspected.scene));
    let session = same_scene.and_then(|former| former.session);
    state.session.shown = Some(Shown {
        generation: state.generation,
        inspected,
        parts: parts.clone(),
        is_past,
        session,
        is_outdated,
    });
    Event::Inspected { parts, purpose }
}

/// Maximum number of recent files.
const MAX_RECENT: usize = 8;

/// Moves a file to the front of the recent ones.
fn remember(recent: &mut Vec<PathBuf>, path: &Path) {
    recent.retain(|known| known != path);
    recent.insert(0, path.to_owned());
    recent.truncate(MAX_RECENT);
}

/// Takes over a loaded library; after a reload, inspects the scene in front again.
fn update_library(state: &mut State) {
    match state.inspector.loader.loading.poll() {
        // A library that came with a result or that the user chose is newer.
        Some(Ok(library)) if state.session.library.is_none() => {
            state.use_library(&library);
        }
        Some(Err(error)) => notify(state, error.into()),
        _ => {}
    }
    let library = state.session.library.as_ref();
    let is_loaded = library.is_some_and(|library| library.unloaded.is_none());
    let reloaded = match state.inspector.loader.reloading.poll() {
        Some(Ok(library)) => {
            remove_notices(state, NoticeTopic::Library);
            library
        }
        // A library that was never there is reported already.
        Some(Err(_)) if !is_loaded => None,
        Some(Err(UserError { what, advice })) => {
            remove_notices(state, NoticeTopic::Library);
            let what = text!("shell-library-still-in-use", error = what);
            notify(
                state,
                Notice::look(what, advice).about(NoticeTopic::Library),
            );
            None
        }
        None => None,
    };
    if let Some(library) = reloaded
        // Otherwise another library was chosen meanwhile.
        && let Some(known) = &state.session.library
        && known.path == library.path
    {
        let num = library.parts.len();
        let cache = &state.inspector.loader.library_cache;
        let is_own = cache.is_own_change(known, &library);
        state.use_library(&library);
        if state.session.role == UserRole::Engineer && !is_own {
            let what = text!("shell-library-reloaded", num = num);
            notify(state, Notice::done(what));
        }
        let is_past = state
            .session
            .shown
            .as_ref()
            .is_some_and(|shown| shown.is_past);
        if (state.session.is_live() || !is_past) && !is_own {
            state.inspect_again();
        }
    }
    // A running inspection uses the former library and would bring that back.
    let is_free = state.inspector.running().is_none();
    let library = state.session.library.as_ref();
    let loader = &mut state.inspector.loader;
    if let Some(library) = library {
        loader.watch.watch(&library.path);
        loader.is_changed |= loader.watch.has_changed();
    }
    if loader.is_changed && loader.may_reload && is_free && loader.reloading.running().is_none() {
        loader.reload();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspection::{inspected::inspected_cell, source::CellChoice};
    use crate::{action::DialogRequest, apply::apply};
    use files::write_depth_png;
    use geometry::{fixtures::small_frame, oriented_box::OrientedBox};

    #[test]
    fn a_result_stays_and_is_old_until_the_next_is_there() {
        let mut state = State::default();
        apply(&mut state, Action::Capture);
        assert!(!state.session.is_old() && state.inspector.running().is_some());
        assert!(state.inspector.run_waiting());
        assert!(update(&mut state).is_some());
        assert!(state.session.shown.is_some() && state.inspector.running().is_none());
        apply(&mut state, Action::TakeEmptyCell);
        assert!(state.session.empty_cell.is_none(), "a part hangs there");
        let notice = state.notices.last().map(|notice| notice.what.clone());
        assert!(notice.is_some_and(|notice| notice.contains("not empty")));

        apply(&mut state, Action::Capture);
        assert!(state.session.is_old());
        update(&mut state);
        assert!(state.session.is_old(), "nothing has come yet");
        apply(&mut state, Action::CancelInspection);
        // Another part may hang there now.
        assert!(state.session.is_old() && state.session.shown.is_some());
        assert!(state.session.current_result().is_none());
        apply(&mut state, Action::Capture);
        assert!(state.inspector.run_waiting());
        update(&mut state);
        assert!(state.session.current_result().is_some());
    }

    #[test]
    fn a_past_result_is_inspected_again_before_its_own_rack() {
        let volume = OrientedBox {
            centre_m: [0.0, 0.0, 1.5],
            size_m: [6.0; 3],
            angles_rad: [0.0; 3],
        };
        let rack = Rack {
            volume: vec![volume],
            places: Vec::new(),
            ..Rack::default()
        };
        let mut past = inspected_cell(CellChoice::InTurn, 1);
        past.recipe = Arc::new(past.recipe.in_rack(rack.clone()));
        let mut state = State::default();
        state.show_past(Arc::new(past));
        for _ in 0..2 {
            state.inspect_again();
            assert!(state.inspector.run_waiting());
            update(&mut state);
            let shown = state.session.shown.as_ref().expect("a result");
            assert!(shown.is_past);
            assert_eq!(shown.inspected.recipe.rack, rack);
        }
    }

    #[test]
    fn an_outdated_result_stays_outdated_when_its_scene_is_inspected_again() {
        let mut state = State::default();
        apply(&mut state, Action::Capture);
        assert!(state.inspector.run_waiting());
        update(&mut state);
        live::outdate_shown(&mut state);
        let library = state.session.library.clone().expect("loaded");
        for step in 0..5 {
            match step {
                0 => state.inspect_again(),
                1 => state.inspect_shown("Again", ReinspectionPurpose::New),
                2 => state.library_changed(&library, None),
                3 => {
                    // It was enrolled from the scene in front.
                    let shown = state.session.shown.as_ref();
                    let saved = shown.map(|shown| shown.inspected.again());
                    state.library_changed(&library, saved);
                }
                // It is loaded, and then the scene is inspected again.
                _ => {
                    let chosen = Action::Chosen(
                        DialogRequest::Library,
                        ::inspection::fixtures::SHIPPED_PARTS.into(),
                    );
                    apply(&mut state, chosen);
                    assert!(state.inspector.run_waiting());
                    assert!(update(&mut state).is_none());
                }
            }
            assert!(state.inspector.run_waiting());
            let event = update(&mut state);
            // The history keeps only new inspections.
            let Some(Event::Inspected { purpose, .. }) = event else {
                panic!("{step}: {event:?}");
            };
            assert_eq!(purpose, ReinspectionPurpose::Repeated);
            assert!(state.session.is_old(), "{step}");
            assert!(state.session.current_result().is_none(), "{step}");
        }
    }

    #[test]
    fn after_a_file_that_cannot_be_read_the_former_source_is_used_and_its_notice_goes_with_the_next_scene()
     {
        let mut state = State::default();
        let former = state.session.source.clone();
        apply(&mut state, Action::Open("a.pcd".into()));
        apply(&mut state, Action::CancelInspection);
        assert_eq!(state.session.source, former, "given up");
        apply(&mut state, Action::Open("a.pcd".into()));
        apply(&mut state, Action::Open("b.pcd".into()));
        assert!(state.inspector.run_waiting());
        update(&mut state);
        assert_eq!(state.session.source, former);
        assert!(state.session.failed.is_some() && state.notices.len() == 1);
        apply(&mut state, Action::Capture);
        assert!(state.inspector.run_waiting());
        update(&mut state);
        assert!(state.notices.is_empty(), "{:?}", state.notices);
    }

    #[test]
    fn a_file_that_is_opened_in_enrol_leaves_the_source_and_its_result_as_they_are() {
        let mut state = State::default();
        apply(&mut state, Action::Capture);
        assert!(state.inspector.run_waiting());
        update(&mut state);
        let former = state.session.source.clone();
        apply(&mut state, Action::GoTo(WorkspaceKind::Enrol));
        let taken = apply(&mut state, Action::Open("door.pcd".into()));
        let Some(Action::Take(SceneOrScan::Scene(SceneSource::File(path)), _)) = taken else {
            panic!("{taken:?}");
        };
        assert!(path.ends_with("door.pcd"));
        assert_eq!(state.session.source, former);
        assert!(state.session.current_result().is_some());
        // It can be captured from at once, even if the file cannot be read.
        apply(&mut state, Action::GoTo(WorkspaceKind::Inspect));
        apply(&mut state, Action::Capture);
        let running = state.inspector.running().expect("at work");
        assert_eq!(running.title, "Capturing");
    }

    #[test]
    fn of_two_requests_the_newer_is_answered() {
        let mut state = State::default();
        apply(&mut state, Action::Open("a.pcd".into()));
        apply(&mut state, Action::Open("b.pcd".into()));
        assert!(state.inspector.run_waiting() && !state.inspector.run_waiting());
        update(&mut state);
        assert_eq!(state.notices.len(), 1);
        assert!(
            state.notices[0].what.contains("b.pcd"),
            "{:?}",
            state.notices
        );
        assert!(state.inspector.running().is_none() && state.session.shown.is_none());
    }

    #[test]
    fn an_operator_who_captures_from_a_file_is_told_that_it_is_the_same_capture() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        write_depth_png(&path, &small_frame(8, [900; 48])).expect("written");
        let mut state = State::default();
        apply(&mut state, Action::Open(path.clone()));
        assert!(state.inspector.run_waiting());
        update(&mut state);
        let mut again = |role| {
            state.session.role = role;
            apply(&mut state, Action::Capture);
            assert!(state.inspector.run_waiting());
            update(&mut state);
            let notices = state.notices.iter();
            let mut same = notices.filter(|notice| notice.what.contains("inspected again"));
            same.next().map(|notice| notice.advice.clone())
        };
        assert_eq!(again(UserRole::Engineer), None);
        let advice = "Ask the engineer to choose a camera".to_owned();
        assert_eq!(again(UserRole::Operator), Some(advice));
        // What was saved since then is another capture.
        let file = std::fs::File::options().write(true).open(&path);
        let later = std::time::SystemTime::now() + std::time::Duration::from_secs(1);
        file.expect("there").set_modified(later).expect("dated");
        assert_eq!(again(UserRole::Operator), None);
        // Nor is there a source menu for Live.
        for (role, advice) in [
            (UserRole::Operator, "Ask the engineer to choose a camera"),
            (
                UserRole::Engineer,
                "Choose a camera, a recording or a folder in the source menu",
            ),
        ] {
            state.session.role = role;
            apply(&mut state, Action::Live(live::LiveAction::Toggle));
            let notice = state.notices.last().expect("a notice");
            assert_eq!(notice.advice, advice);
        }
    }

    #[test]
    fn a_scan_without_poses_asks_for_their_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let frame = small_frame(8, [900; 48]);
        for name in ["a.png", "b.png"] {
            write_depth_png(&folder.path().join(name), &frame).expect("written");
        }
        let mut state = State::default();
        apply(&mut state, Action::Open(folder.path().to_owned()));
        assert!(state.inspector.run_waiting());
        let event = update(&mut state);
        let Some(Event::PosesWanted(ScanOrder::Open(files))) = event else {
            panic!("{event:?}");
        };
        assert_eq!(files.frames, [folder.path()]);
        assert!(state.inspector.running().is_none());
        let notice = state.notices.last().expect("said");
        assert!(notice.what.contains("no poses"), "{notice:?}");
        assert!(notice.advice.contains("Choose the file"), "{notice:?}");
    }
}
