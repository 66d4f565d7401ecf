//! Keeping the case in front, or saying in words why it cannot be kept.

use std::sync::Arc;

use jiff::Timestamp;

use super::{
    state::{CompareState, Front},
    study::CameraKind,
    work::CaseChange,
};
use crate::{
    app::{
        language::text,
        shell::{context::ShellContext, notice::Notice},
    },
    cases::CaseDescription,
};

impl CompareState {
    /// Keeps the case in front.
    pub(super) fn keep(&mut self, cx: &mut ShellContext<'_>) {
        let study = self.study.as_ref().filter(|_| !self.is_study_old());
        let Some(study) = study else {
            return cx.notify(Notice::look(
                text!("compare-nothing-to-keep"),
                text!("compare-nothing-to-keep-advice"),
            ));
        };
        if matches!(self.front, Front::Kept(_)) {
            return cx.notify(Notice::look(
                text!("compare-kept-already"),
                text!("compare-kept-already-advice"),
            ));
        }
        let Some(truth) = self.truth.clone() else {
            return cx.notify(Notice::look(
                text!("compare-no-truth"),
                text!("compare-keep-case-first"),
            ));
        };
        let about = CaseDescription {
            origin: study.title.clone(),
            simulated: study.camera == CameraKind::Simulated,
            kept_at: Timestamp::now(),
            remark: self.remark.trim().to_owned(),
            difficulty: None,
            truth,
            found: study.found.clone(),
            pose: None,
        };
        let change = CaseChange::Keep {
            scene: Arc::clone(&study.scene),
            about: Box::new(about),
        };
        self.change_cases(text!("compare-keeping-case"), change);
    }
}
