//! Loads the library at the start, and again after another program has changed it.

use std::sync::Arc;

use crate::{
    inspection::{
        folder_watch::FolderWatch,
        library_cache::{LibraryCache, LibraryView},
    },
    notice::{Notice, NoticeTopic},
    session::UserRole,
    state::{State, notify, remove_notices},
};
use ui::{
    language::text,
    task::{Task, TaskRunner},
    user_error::UserError,
};

/// Keeps the library in use in step with its folder.
#[derive(Debug)]
pub struct LibraryLoader {
    loading: Task<Arc<LibraryView>>,
    reloading: Task<Option<Arc<LibraryView>>>,
    watch: FolderWatch,
    /// True if the folder has changed and the library is not reloaded yet.
    is_changed: bool,
    /// False while a part is being enrolled, so that the library does not change meanwhile.
    pub may_reload: bool,
    library_cache: LibraryCache,
}

impl LibraryLoader {
    /// Makes the loader without loading anything yet.
    pub(super) fn new(runner: &TaskRunner, library_cache: &LibraryCache) -> Self {
        Self {
            loading: Task::new("library", runner),
            reloading: Task::new("reload", runner),
            watch: FolderWatch::new("library-watch", runner),
            is_changed: false,
            may_reload: true,
            library_cache: library_cache.clone(),
        }
    }

    /// True while nothing is being loaded.
    pub(super) fn is_idle(&self) -> bool {
        self.loading.running().is_none() && self.reloading.running().is_none()
    }

    fn load(&mut self) {
        let library_cache = self.library_cache.clone();
        self.loading
            .start(text!("shell-loading-library"), move |_| {
                Ok(Arc::clone(&library_cache.get().shown))
            });
    }

    fn reload(&mut self) {
        self.is_changed = false;
        let library_cache = self.library_cache.clone();
        self.reloading
            .start(text!("shell-reloading-library"), move |_| {
                let changed = library_cache.refresh();
                let changed = changed.map_err(|error| UserError::of(&error))?;
                Ok(changed.map(|loaded| Arc::clone(&loaded.shown)))
            });
    }
}

impl State {
    /// Loads the library, independently of the workspace in front and of the first scene.
    pub fn load_library(&mut self) {
        self.inspector.loader.load();
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

/// Takes over a loaded library; after a reload, inspects the scene in front again.
pub(super) fn update(state: &mut State) {
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
