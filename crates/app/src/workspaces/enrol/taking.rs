//! Gets another draft: from a scene, a file, or the shots of a scan.

use std::{
    path::{Path, PathBuf},
    sync::{Arc, Weak},
};

use super::{
    draft::{Draft, Field, Form},
    kept::KeptDraft,
    meshes::{ChosenMesh, MeshAction},
    selection::{Corrections, Selection},
    state::{DraftJob, EnrolState, form_of},
    subject::EnrolInput,
    undo::{UndoStep, scene_in_front},
    work::{self, DraftEvent},
};
use crate::{
    shots::{Asked, ShotsAction, ShotsFile, source_of},
    workspaces::enrol::state::{EnrolAction, EnrolFile},
};
use inspection::pipeline::Recipe;
use shell::{
    action::Action,
    inspection::{
        library_cache::LibraryCache,
        source::{Origin, ScanOrder, SceneOrScan, SceneSource},
    },
    notice::{Notice, NoticeTopic},
    workspace::ShellContext,
};
use ui::{
    language::text,
    task::{TaskContext, TaskError},
    user_error::UserError,
};

impl EnrolState {
    /// Makes a scene or a scan the draft.
    pub fn take(&mut self, scene: SceneOrScan, title: String, cx: &ShellContext<'_>) {
        match scene {
            SceneOrScan::Scene(SceneSource::File(path)) => self.open_file(path, title, cx),
            SceneOrScan::Scene(source) => self.take_scene(source, title, cx),
            SceneOrScan::Scan(order) => self.take_scan(order, title, Some(Asked::first()), cx),
        }
    }

    fn take_scene(&mut self, source: SceneSource, title: String, cx: &ShellContext<'_>) {
        self.take_by(title, cx, move |recipe, library_cache, context| {
            work::take_scene(&source, recipe, library_cache, context)
        });
    }

    /// Makes a file the draft, or lists its meshes.
    fn open_file(&mut self, path: PathBuf, title: String, cx: &ShellContext<'_>) {
        self.take_by(title, cx, move |recipe, library_cache, context| {
            work::open_file(&path, recipe, library_cache, context)
        });
    }

    /// Makes this mesh the draft.
    fn take_mesh(&mut self, chosen: ChosenMesh, cx: &ShellContext<'_>) {
        let title = text!("shell-opening", name = chosen.name());
        self.take_by(title, cx, move |recipe, library_cache, context| {
            work::take_mesh(chosen, recipe, library_cache, context)
        });
    }

    /// Makes the next of several chosen meshes the draft, unless something else is about to be it.
    pub(super) fn take_following(&mut self, following: Option<ChosenMesh>, cx: &ShellContext<'_>) {
        if let Some(next) = following.filter(|_| !self.is_taking_another()) {
            self.take_mesh(next, cx);
        }
    }

    fn take_by(
        &mut self,
        title: String,
        cx: &ShellContext<'_>,
        work: impl FnOnce(
            &Recipe,
            &LibraryCache,
            &TaskContext<DraftEvent>,
        ) -> Result<DraftEvent, TaskError>
        + Send
        + 'static,
    ) {
        self.open = None;
        self.close_meshes();
        let (recipe, library_cache) = (
            Arc::clone(&cx.session.recipe),
            cx.services.library_cache.clone(),
        );
        self.start(title, DraftJob::Take, None, move |context| {
            work(&recipe, &library_cache, context)
        });
    }

    /// Carries out an action in the list of meshes.
    pub(super) fn choose_meshes(&mut self, action: MeshAction, cx: &ShellContext<'_>) {
        let Some(list) = &mut self.mesh_list else {
            return;
        };
        match action {
            MeshAction::Close => self.close_meshes(),
            MeshAction::EnrolWhole => {
                let path = list.whole();
                let title = text!("shell-opening", name = list.title());
                self.take_scene(SceneSource::File(path), title, cx);
            }
            MeshAction::Enrol(row) => {
                if let Some(first) = list.chosen(row) {
                    self.take_mesh(first, cx);
                }
            }
            MeshAction::Tick(_) | MeshAction::TickTo(_) | MeshAction::GoTo(_) => list.apply(action),
            MeshAction::Search(_)
            | MeshAction::Order(_)
            | MeshAction::Unit(_)
            | MeshAction::Visible(_) => {
                list.apply(action);
                self.draw_meshes(cx);
            }
        }
    }

    /// Draws the pictures of the visible meshes that have none yet, and no others any more.
    fn draw_meshes(&mut self, cx: &ShellContext<'_>) {
        self.picture_task.cancel();
        let Some(list) = &self.mesh_list else {
            return;
        };
        let wanted = list.without_picture();
        if wanted.is_empty() {
            return;
        }
        let (listing, unit) = (Arc::clone(list.listing()), list.unit());
        let recipe = Arc::clone(&cx.session.recipe);
        self.picture_task
            .start(text!("enrol-examining-part"), move |context| {
                work::draw_meshes(&listing.file, unit, &wanted, &recipe, context)
            });
    }

    /// Closes the list of meshes.
    fn close_meshes(&mut self) {
        self.picture_task.cancel();
        self.mesh_list = None;
    }

    /// Fuses the shots of a scan and makes them the draft.
    fn take_scan(
        &mut self,
        order: ScanOrder,
        title: String,
        asked: Option<Asked>,
        cx: &ShellContext<'_>,
    ) {
        self.open = None;
        self.close_meshes();
        let request = cx.session.scan_request(order);
        let library_cache = cx.services.library_cache.clone();
        self.start(title, DraftJob::Take, asked, move |context| {
            work::take_scan(&request, &library_cache, context)
        });
    }

    /// Makes what Inspect shows the draft.
    pub(super) fn take_shown(&mut self, cx: &ShellContext<'_>) {
        let Some(shown) = &cx.session.shown else {
            return;
        };
        let inspected = &shown.inspected;
        if let Some(scan) = &inspected.scan {
            let order = ScanOrder::Known(scan.fused.choice.clone());
            self.take_scan(order, text!("enrol-taking-scan"), None, cx);
        } else {
            let (scene, origin) = (Arc::clone(&inspected.scene), inspected.origin.clone());
            let source = SceneSource::AtHand(scene, origin);
            self.take_scene(source, text!("enrol-taking-scene"), cx);
        }
    }

    /// Takes a dropped file if the list of shots is waiting for one like it; returns whether it did.
    pub fn take_file(&mut self, path: &Path, cx: &mut ShellContext<'_>) -> bool {
        let is_wanted = self.shots.wants(path);
        if is_wanted {
            let poses = EnrolFile::Scan(ShotsFile::Poses);
            self.apply(EnrolAction::Chosen(poses, path.to_owned()), cx);
        }
        is_wanted
    }

    /// Makes the draft of other shots.
    pub(super) fn choose_shots(&mut self, action: ShotsAction, cx: &mut ShellContext<'_>) {
        let used = self.shot_choice().cloned();
        match self.shots.apply(action, used) {
            Ok(None) => {}
            Ok(Some((order, asked))) => {
                let title = order.title();
                self.take_scan(order, title, Some(asked), cx);
            }
            Err(notice) => cx.notify(notice),
        }
    }

    /// Installs a new draft. The former one can be brought back; its form is kept, as it may describe the same part, unless
    /// the new one is a mesh chosen by its name. Of the form of an earlier start, what a person wrote is kept.
    pub(super) fn taken(
        &mut self,
        subject: Arc<EnrolInput>,
        selection: Arc<Selection>,
        chosen: Option<ChosenMesh>,
        cx: &mut ShellContext<'_>,
    ) {
        cx.send(Action::RemoveNotices(NoticeTopic::Scene));
        for warning in &subject.warnings {
            cx.notify(match &subject.origin {
                Origin::File { path, .. } => Notice::of_file(path, warning),
                _ => UserError::of(warning).into(),
            });
        }
        for warning in subject.scan().map_or(&[][..], |fused| &fused.warnings) {
            cx.notify(warning.clone());
        }
        let former = self.draft.take();
        let coming = self.coming.take();
        let is_again = self.job == DraftJob::TakeAgain;
        let library = cx.session.library.as_deref();
        let replaced = self.replacing.as_ref().filter(|_| !is_again);
        let replaced = replaced.and_then(|name| form_of(name, library));
        let of_mesh = chosen.as_ref();
        let of_mesh = of_mesh.map(|mesh| Form::titled(mesh.name(), library));
        let written = || former.as_ref().map(|former| former.form.clone());
        let written = of_mesh.clone().or_else(written).or_else(|| {
            let mut form = coming.as_ref()?.form.clone();
            if !is_again {
                // This scene may be of another part.
                form.write(Field::ReferenceOf(None), library);
            }
            Some(form)
        });
        let (form, form_before) = match replaced {
            Some(form) => {
                let before = match &former {
                    // Its form was that of the part to replace, too.
                    Some(former) if of_mesh.is_none() && former.form.name == form.name => {
                        former.form_before.clone()
                    }
                    _ => written,
                };
                (form, before)
            }
            None => (written.unwrap_or_default(), None),
        };
        if let Some(former) = former {
            self.did(UndoStep::Draft(Some(Box::new(former))), cx);
        }
        let files = subject.scan().map(|fused| fused.choice.files());
        // Let the next start of the window open the same shots.
        if let Some(files) = &files
            && let Some(source) = source_of(files, &cx.session.source)
        {
            cx.send(Action::UseSource(source));
        }
        self.shots.settle(files.as_ref(), None);
        self.job = DraftJob::Look;
        self.num_drafts += 1;
        self.draft = Some(Draft {
            number: self.num_drafts,
            corrections: Corrections::none(subject.usual),
            subject,
            selection,
            checked: None,
            form,
            form_before,
            chosen,
            in_front: if is_again {
                Weak::new()
            } else {
                scene_in_front(cx.session)
            },
        });
        if let Some(coming) = coming.filter(|_| is_again) {
            self.correct_again(coming, cx);
        }
    }

    /// Brings back the draft of an earlier start of the window, as far as its scene can be obtained again.
    pub(super) fn bring_back(&mut self, kept: KeptDraft, cx: &mut ShellContext<'_>) {
        let (recipe, library_cache) = (
            Arc::clone(&cx.session.recipe),
            cx.services.library_cache.clone(),
        );
        let (source, usual) = (kept.origin.source(), kept.usual);
        self.coming = Some(kept);
        let title = text!("enrol-bringing-back");
        match source {
            Some(SceneOrScan::Scene(source)) => {
                self.start(title, DraftJob::TakeAgain, None, move |context| {
                    work::take_again(source, usual, &recipe, &library_cache, context)
                });
            }
            Some(SceneOrScan::Scan(order)) => {
                let request = cx.session.scan_request(order);
                let asked = Some(Asked::first());
                self.start(title, DraftJob::TakeAgain, asked, move |context| {
                    work::take_scan(&request, &library_cache, context)
                });
            }
            None => self.words_alone(cx),
        }
    }

    /// Handles a kept draft without its scene: its form waits for the next draft.
    pub(super) fn words_alone(&mut self, cx: &mut ShellContext<'_>) {
        self.job = DraftJob::Look;
        cx.notify(Notice::look(
            text!("enrol-draft-no-scene"),
            text!("enrol-draft-no-scene-advice"),
        ));
    }

    /// Applies the corrections of the kept draft.
    fn correct_again(&mut self, kept: KeptDraft, cx: &mut ShellContext<'_>) {
        let Some(draft) = &mut self.draft else {
            return;
        };
        let subject = &draft.subject;
        if subject.can_be_corrected() && subject.allows(kept.corrections.taking) {
            draft.corrections = kept.corrections;
        }
        self.expected = kept.checksum;
        cx.notify(Notice::done(text!("enrol-draft-back")));
        self.look(cx);
    }
}
