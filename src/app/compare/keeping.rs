//! Keeping the case in front, or saying in words why it cannot be kept.

use std::sync::Arc;

use jiff::Timestamp;

use super::{errands::change_cases, state::Front, study::CameraKind, work::CaseChange};
use crate::{
    app::{
        action::notify,
        state::{Notice, NoticeKind, State},
    },
    cases::CaseAbout,
};

/// Keeps the case in front.
pub(super) fn keep(state: &mut State) {
    let refuse = |state: &mut State, what: &str, advice: &str| {
        let notice = Notice {
            kind: NoticeKind::Look,
            what: what.into(),
            advice: advice.into(),
        };
        notify(state, notice);
    };
    let Some(study) = state
        .compare
        .study
        .clone()
        .filter(|_| !state.is_study_old())
    else {
        return refuse(
            state,
            "There is no case to keep yet",
            "Capture or open a scene, and wait until it was inspected",
        );
    };
    if matches!(state.compare.front, Front::Kept(_)) {
        return refuse(
            state,
            "This case is kept already",
            "Capture or open another scene",
        );
    }
    let Some(truth) = state.compare.truth.clone() else {
        return refuse(
            state,
            "A case without a truth teaches nothing",
            "Choose first what it is",
        );
    };
    let about = CaseAbout {
        origin: study.title.clone(),
        simulated: study.camera == CameraKind::Simulated,
        kept_at: Timestamp::now(),
        remark: state.compare.remark.trim().to_owned(),
        difficulty: None,
        truth,
        found: study.found.clone(),
        pose: None,
    };
    let change = CaseChange::Keep {
        scene: Arc::clone(&study.scene),
        about: Box::new(about),
    };
    change_cases(state, "Keeping the case", change);
}
