//! What the workspace knows besides the result: what its view shows, and where a picture of it is to go.

use std::{collections::BTreeSet, path::PathBuf, sync::Arc};

use crate::app::{
    action::{Effect, notify},
    job::{Request, Trouble},
    shots::ShotsState,
    state::State,
    viewport::{Colouring, ViewShot},
    writing::WriteRequest,
};

/// What the view can show besides the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ViewPart {
    /// The axes of the part's middle.
    Axes,
    /// The depth camera and what it sees.
    Camera,
    /// The enrolled part's outline at the found pose.
    Outline,
    /// The taught nozzle over the middle of the part.
    NozzleMiddle,
    /// The taught nozzle that is furthest off its distance.
    NozzleWorst,
    /// The part's stored spray path, carried to where it hangs now.
    SprayPath,
    /// The axes of the robot's base.
    RobotBase,
    /// The cameras of a scan's shots.
    ShotCameras,
    /// What no shot of a scan shows.
    Unseen,
}

impl ViewPart {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 9] = [
        Self::Outline,
        Self::NozzleMiddle,
        Self::NozzleWorst,
        Self::SprayPath,
        Self::Axes,
        Self::Camera,
        Self::RobotBase,
        Self::ShotCameras,
        Self::Unseen,
    ];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Axes => "Axes of the part",
            Self::Camera => "Depth camera",
            Self::Outline => "Enrolled contour",
            Self::NozzleMiddle => "Nozzle over the middle",
            Self::NozzleWorst => "Nozzle at the worst spot",
            Self::SprayPath => "Spray path",
            Self::RobotBase => "Robot base",
            Self::ShotCameras => "Cameras of the shots",
            Self::Unseen => "Not seen by any shot",
        }
    }
}

/// The workspace's own part of the state.
#[derive(Debug)]
pub struct InspectState {
    /// What the view shows besides the points.
    pub parts: BTreeSet<ViewPart>,
    /// What a person chose to colour by; until then the deviation where there is one, else the segments.
    pub colouring: Option<Colouring>,
    /// Where a picture of the view is to go, until it is taken.
    pub picture_to: Option<PathBuf>,
    /// The folder that a report is to go to, until a picture of the view is taken for it.
    pub report_to: Option<PathBuf>,
    /// Of the scan that is shown, if it is one.
    pub shots: ShotsState,
}

impl Default for InspectState {
    fn default() -> Self {
        Self {
            parts: [
                ViewPart::Axes,
                ViewPart::Outline,
                ViewPart::NozzleMiddle,
                ViewPart::SprayPath,
                ViewPart::RobotBase,
                ViewPart::ShotCameras,
                ViewPart::Unseen,
            ]
            .into(),
            colouring: None,
            picture_to: None,
            report_to: None,
            shots: ShotsState::default(),
        }
    }
}

/// What can happen in the workspace.
#[derive(Clone, Debug)]
pub enum InspectAction {
    /// Show this in the view, or no longer.
    Toggle(ViewPart),
    /// Colour the points by this.
    Colour(Colouring),
    /// The view that [`InspectState::picture_to`] or [`InspectState::report_to`] waits for, or why there is none.
    Picture(Result<Box<ViewShot>, Trouble>),
}

/// Carries out an action.
pub(in crate::app) fn apply(state: &mut State, action: InspectAction) -> Option<Effect> {
    let own = &mut state.inspect;
    match action {
        InspectAction::Toggle(part) => {
            if !own.parts.remove(&part) {
                own.parts.insert(part);
            }
        }
        InspectAction::Colour(colouring) => own.colouring = Some(colouring),
        InspectAction::Picture(shot) => {
            if let Some(folder) = own.report_to.take() {
                // A report without the view is one all the same.
                return write_report(state, folder, shot.ok());
            }
            let mut path = own.picture_to.take()?;
            match shot {
                Ok(shot) => {
                    if path.extension().is_none() {
                        path.set_extension("png");
                    }
                    let request = Request::Write(WriteRequest::Picture { path, shot });
                    return Some(state.begin("Saving the picture", request));
                }
                Err(trouble) => notify(state, trouble.into()),
            }
        }
    }
    None
}

/// Writes the report of the inspection in front.
pub(in crate::app) fn write_report(
    state: &mut State,
    folder: PathBuf,
    shot: Option<Box<ViewShot>>,
) -> Option<Effect> {
    let inspected = Arc::clone(&state.shown.as_ref()?.inspected);
    let request = WriteRequest::Report {
        folder,
        robot: state.robot_of(&inspected).cloned(),
        inspected,
        convention: state.convention,
        shot,
    };
    Some(state.begin("Writing the report", Request::Write(request)))
}

/// Writes the spray path of the inspection in front for the robot; nothing without a path or a calibrated cell.
pub(in crate::app) fn write_spray_path(state: &mut State, path: PathBuf) -> Option<Effect> {
    let inspected = &state.shown.as_ref()?.inspected;
    inspected.spray.as_ref()?;
    let request = WriteRequest::SprayPath {
        path,
        inspected: Arc::clone(inspected),
        robot: state.robot_of(inspected)?.clone(),
        convention: state.convention,
    };
    Some(state.begin("Writing the spray path", Request::Write(request)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::action::{Action, DialogRequest, apply as apply_any};

    #[test]
    fn what_is_shown_is_hidden_and_shown_again() {
        let mut state = State::default();
        for is_shown in [false, true] {
            apply(&mut state, InspectAction::Toggle(ViewPart::Axes));
            assert_eq!(state.inspect.parts.contains(&ViewPart::Axes), is_shown);
        }
    }

    #[test]
    fn a_picture_waits_for_its_place_and_a_view_that_is_not_there_is_said_once() {
        let mut state = State::default();
        let trouble = || Trouble {
            what: "no view".into(),
            advice: "mend it".into(),
        };
        let none = || InspectAction::Picture(Err(trouble()));
        // Nobody asked.
        assert!(apply(&mut state, none()).is_none() && state.notices.is_empty());
        apply_any(
            &mut state,
            Action::Chosen(DialogRequest::Picture, "view".into()),
        );
        assert_eq!(state.inspect.picture_to, Some("view".into()));
        assert!(apply(&mut state, none()).is_none());
        assert_eq!((state.notices.len(), &state.inspect.picture_to), (1, &None));
    }
}
