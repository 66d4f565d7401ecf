//! Another draft: from a scene, from a file, or from the shots of a scan.

use std::{path::Path, sync::Arc};

use super::{
    action::{EnrolAction, EnrolFile},
    draft::{Draft, Form},
    selection::{Corrections, Selection},
    state::{DraftJob, EnrolState, form_of},
    subject::EnrolInput,
    undo::UndoStep,
    work,
};
use crate::app::{
    inspection::{
        inspected::SceneOrScan,
        scan_choice::ScanOrder,
        source::{Origin, SceneSource},
    },
    language::text,
    shell::{context::ShellContext, message::Message, notice::Notice, session::Source},
    shots::{Asked, ShotsAction, ShotsFile, source_of},
    user_error::UserError,
};

impl EnrolState {
    /// Gets something to enrol.
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

    /// Puts the shots of a scan together to enrol what they show.
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

    /// Takes what Inspect shows.
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

    /// Takes a file that was dropped, if one like it is waited for.
    pub fn take_file(&mut self, path: &Path, cx: &mut ShellContext<'_>) -> bool {
        let is_wanted = self.shots.wants(path);
        if is_wanted {
            let poses = EnrolFile::Scan(ShotsFile::Poses);
            self.apply(EnrolAction::Chosen(poses, path.to_owned()), cx);
        }
        is_wanted
    }

    /// Has the draft made of other shots.
    pub(super) fn choose_shots(&mut self, action: ShotsAction, cx: &mut ShellContext<'_>) {
        let used = self.shot_choice().cloned();
        match self.shots.apply(action, used) {
            Ok(None) => {}
            Ok(Some((order, asked))) => {
                if let ScanOrder::Open(files) = &order {
                    cx.send(Message::UseSource(Source::Scan(files.clone())));
                }
                let title = order.title();
                self.take_scan(order, title, Some(asked), cx);
            }
            Err(notice) => cx.notify(notice),
        }
    }

    /// The former draft can be brought back; what was written about it is kept, for it may be the same part again.
    pub(super) fn taken(
        &mut self,
        subject: Arc<EnrolInput>,
        selection: Arc<Selection>,
        cx: &mut ShellContext<'_>,
    ) {
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
        let library = cx.session.library.as_deref();
        let replaced = self.replacing.as_ref();
        let replaced = replaced.and_then(|name| form_of(name, library));
        let form = match (replaced, &former) {
            (Some(form), _) => form,
            (None, Some(former)) => former.form.clone(),
            (None, None) => Form::default(),
        };
        if let Some(former) = former {
            self.did(UndoStep::Draft(Some(Box::new(former))), cx);
        }
        let files = subject.scan().map(|fused| fused.choice.files());
        // The next start opens the same shots.
        if let Some(files) = &files
            && let Some(source) = source_of(files, &cx.session.source)
        {
            cx.send(Message::UseSource(source));
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
        });
    }
}
