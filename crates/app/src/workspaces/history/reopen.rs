//! Repeats past inspections: to open them with every stage, or to compare them with today's result.

use std::sync::Arc;

use super::{
    state::{HistoryState, ReinspectionJob, RemakeFor},
    work::OpenedInspection,
};
use records::history::{Differences, InspectionSummary, Record};
use shell::{
    action::Action,
    inspection::{
        inspected::{InspectJob, InspectRequest, Inspected},
        source::{HistoryFrame, Origin, ScanOrder, ScanRequest, SceneOrScan, SceneSource},
    },
    language::scene_title,
    notice::Notice,
    session::{ReinspectionPurpose, WorkspaceKind},
    workspace::ShellContext,
};
use ui::language::text;

impl HistoryState {
    /// Shows an inspection with every stage: from memory, or repeated with its own recipe.
    pub(super) fn open(&mut self, number: i64, cx: &mut ShellContext<'_>) {
        match self.whole(number) {
            Some(inspected) => cx.send(Action::ShowPast(Arc::clone(inspected))),
            None => self.reinspect(number, RemakeFor::Open, cx),
        }
    }

    /// Inspects its scene again with the recipe and library in use.
    pub(super) fn inspect_again(&mut self, number: i64, cx: &mut ShellContext<'_>) {
        // It stays in front, where the differences are shown.
        self.select(number, cx);
        self.reinspect(number, RemakeFor::Compare, cx);
    }

    /// Repeats the inspection that was waiting to be fetched.
    pub(super) fn go_on(&mut self, cx: &mut ShellContext<'_>) {
        if let Some((number, purpose)) = self.then.take()
            && self.looked_at_as(number).is_some()
        {
            self.reinspect(number, purpose, cx);
        }
    }

    fn reinspect(&mut self, number: i64, purpose: RemakeFor, cx: &mut ShellContext<'_>) {
        let Some(past) = self.looked_at_as(number).cloned() else {
            // Not fetched yet: fetch it first.
            self.selects(number);
            self.then = Some((number, purpose));
            return self.look(cx);
        };
        let scene = scene_of(&past.record);
        let Some(source) = self.source_of(&past.record) else {
            let why = self.why_no_scene(&past.record);
            let [what, advice] = why.unwrap_or_default();
            return cx.notify(Notice::look(what, advice));
        };
        let (title, recipe) = match purpose {
            RemakeFor::Compare => (
                text!("history-inspecting-again", scene = &scene),
                Some(Arc::new(past.record.detail.again_with(&cx.session.recipe))),
            ),
            RemakeFor::Open => (
                text!("shell-opening", name = &scene),
                past.record.detail.named_recipe().map(Arc::new),
            ),
        };
        let Some(recipe) = recipe else {
            return cx.notify(Notice::look(
                text!("history-other-version", scene = &scene),
                text!("history-other-version-advice"),
            ));
        };
        if purpose == RemakeFor::Open {
            cx.send(Action::GoTo(WorkspaceKind::Inspect));
        }
        cx.send(Action::Inspect {
            title,
            job: match source {
                SceneOrScan::Scene(source) => InspectJob::Scene(InspectRequest { source, recipe }),
                SceneOrScan::Scan(order) => InspectJob::Scan(ScanRequest {
                    recipe,
                    ..cx.session.scan_request(order)
                }),
            },
            purpose: ReinspectionPurpose::Past,
            hung: Some(past.record.summary.hung.clone()),
            trace: past.record.summary.trace.clone(),
        });
        self.remaking = Some(ReinspectionJob { past, purpose });
    }

    /// If the scene cannot be obtained, returns why the inspection cannot be repeated, and what to do.
    pub(super) fn why_no_scene(&self, record: &Record) -> Option<[String; 2]> {
        let is_there = self.source_of(record).is_some();
        (!is_there).then(|| {
            [
                text!("history-frame-gone", scene = scene_of(record)),
                text!("history-frame-gone-advice"),
            ]
        })
    }

    /// Where its scene can be obtained: in memory, among the kept frames, or at its origin.
    fn source_of(&self, record: &Record) -> Option<SceneOrScan> {
        if let Some(whole) = self.whole(record.summary.number) {
            return Some(whole.again());
        }
        let origin = origin_of(record);
        if let (Some(frame), Some(folder)) = (&record.detail.frame, &self.frames) {
            let kept = Box::new(HistoryFrame {
                folder: folder.clone(),
                frame: frame.clone(),
                origin,
            });
            return Some(if frame.shots.is_empty() {
                SceneOrScan::Scene(SceneSource::Kept(kept))
            } else {
                SceneOrScan::Scan(ScanOrder::Kept(kept))
            });
        }
        origin.source()
    }

    /// Takes in a past inspection that was repeated.
    pub(super) fn remade(&mut self, inspected: &Arc<Inspected>, cx: &mut ShellContext<'_>) {
        let Some(ReinspectionJob { past, purpose }) = self.remaking.take() else {
            return;
        };
        let differences = differences(&past, inspected);
        match purpose {
            RemakeFor::Compare => {
                let number = past.record.summary.number;
                self.differences = Some((number, differences));
            }
            RemakeFor::Open if differences.has_same_outcome() => {}
            RemakeFor::Open => cx.notify(other_result(&past.record, &differences)),
        }
    }
}

/// Title of its scene, in the language of the window.
fn scene_of(record: &Record) -> String {
    scene_title(&record.summary.scene, record.summary.is_simulated)
}

/// The origin that the window stored; a command stores none.
fn origin_of(record: &Record) -> Origin {
    let written = record.detail.origin.as_deref();
    let written = written.and_then(|origin| serde_json::from_str(origin).ok());
    written.unwrap_or_else(|| Origin::Frame {
        name: record.summary.scene.to_string(),
        is_simulated: record.summary.is_simulated,
        capture: None,
    })
}

fn differences(past: &OpenedInspection, inspected: &Inspected) -> Differences {
    let now = InspectionSummary::of(
        &inspected.inspection,
        &inspected.recipe.parameters,
        &inspected.library.identity,
    );
    Differences::between(InspectionSummary::from(&past.record), now, inspected.middle)
}

fn other_result(record: &Record, differences: &Differences) -> Notice {
    let changed = differences
        .changed_inputs()
        .into_iter()
        .map(|input| match input {
            "recipe" => text!("history-changed-recipe"),
            "library" => text!("history-changed-library"),
            _ => text!("history-changed-program"),
        });
    let changed = changed
        .reduce(|first, second| text!("history-changed-both", first = first, second = second))
        .unwrap_or_else(|| text!("history-changed-frame"));
    Notice::look(
        text!(
            "history-other-result",
            scene = scene_of(record),
            changed = changed
        ),
        text!("history-other-result-advice"),
    )
}
