//! Gets another draft: from a scene, a file, or the shots of a scan.

use std::{
    path::Path,
    sync::{Arc, Weak},
};

use super::{
    draft::{Draft, Field},
    kept::KeptDraft,
    selection::{Corrections, Selection},
    state::{DraftJob, EnrolState, form_of},
    subject::EnrolInput,
    undo::{UndoStep, scene_in_front},
    work,
};
use crate::{
    shots::{Asked, ShotsAction, ShotsFile, source_of},
    workspaces::enrol::state::{EnrolAction, EnrolFile},
};
use shell::{
    action::Action,
    inspection::source::{Origin, ScanOrder, SceneOrScan, SceneSource},
    notice::{Notice, NoticeTopic},
    workspace::ShellContext,
};
use ui::{language::text, user_error::UserError};

impl EnrolState {
    /// Makes a scene or a scan the draft.
    pub fn take(&mut self, scene: SceneOrScan, title: String, cx: &ShellContext<'_>) {
        match scene {
            SceneOrScan::Scene(source) => self.take_scene(source, title, cx),
            SceneOrScan::Scan(order) => self.take_scan(order, title, Some(Asked::first()), cx),
        }
    }

    fn take_scene(&mut self, source: SceneSource, title: String, cx: &ShellContext<'_>) {
        self.open = None;
        let (recipe, library_cache) = (
            Arc::clone(&cx.session.recipe),
            cx.services.library_cache.clone(),
        );
        self.start(title, DraftJob::Take, None, move |context| {
            work::take_scene(&source, &recipe, &library_cache, context)
        });
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

    /// Installs a new draft. The former one can be brought back; its form is kept, as it may describe the same part. Of the
    /// form of an earlier start, what a person wrote is kept.
    pub(super) fn taken(
        &mut self,
        subject: Arc<EnrolInput>,
        selection: Arc<Selection>,
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
        let written = former.as_ref().map(|former| former.form.clone());
        let written = written.or_else(|| {
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
                    Some(former) if former.form.name == form.name => former.form_before.clone(),
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
