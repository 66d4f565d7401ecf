//! Following the source as text: whether the scene moves, what the verdict rests on, and figures.

use egui::{Button, RichText, Ui, Vec2};

use super::{state::megabytes, work::LiveStatus};
use crate::{
    session::{Session, Source},
    source::live::SourceState,
};
use capture::SourceSpec;
use inspection::pipeline::live::{ConsensusVerdict, LiveVerdict, MotionState};
use ui::{language::text, theme::space, widgets::Mark};

/// Height of the line above the button, logical pixels: constant, so that nothing below moves.
const HEIGHT: f32 = 20.0;

/// Draws the head of the verdict card while the source is followed: what the verdict rests on, and the recording. True if
/// recording shall start or stop.
pub fn card(ui: &mut Ui, session: &Session) -> bool {
    let size = Vec2::new(ui.available_width(), HEIGHT);
    ui.allocate_ui(size, |ui| {
        ui.set_min_size(size);
        let status = session.live.status.as_ref();
        let evidence = status.map_or_else(String::new, evidence_text);
        ui.label(RichText::new(evidence).small().weak());
    });
    let is_toggled = record(ui, session);
    ui.separator();
    ui.add_space(space::SMALL);
    is_toggled
}

/// Draws the button that starts and stops a recording and shows what was recorded. True if it was pressed.
fn record(ui: &mut Ui, session: &Session) -> bool {
    let size = Vec2::new(ui.available_width(), space::TARGET);
    if session.live.recording.is_none() {
        let text = RichText::new(text!("live-record")).small();
        let says = text!("live-record-says");
        let button = ui.add(Button::new(text).min_size(size));
        return button.on_hover_text(says).clicked();
    }
    let recorded = session.live.status.as_ref();
    let recorded = recorded.and_then(|status| status.recorded.as_ref());
    let name = match recorded {
        Some(recorded) => text!(
            "live-stop-recording-so-far",
            num = recorded.num_frames,
            size = megabytes(recorded.num_bytes)
        ),
        None => text!("live-stop-recording"),
    };
    let text = RichText::new(&name).small();
    let button = Button::selectable(true, text).min_size(size);
    let response = ui.add(button);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
    response.clicked()
}

/// The state of the followed source; `None` while none is followed.
pub(crate) fn source_state(session: &Session) -> Option<&SourceState> {
    let status = session.live.status.as_ref();
    let state = status.map_or(&SourceState::Opening, |status| &status.source);
    session.is_live().then_some(state)
}

/// Returns whether the scene before the followed source moves, with its mark; `None` while no frames arrive.
pub(crate) fn motion(session: &Session) -> Option<(Mark, String)> {
    let status = session.live.status.as_ref();
    let status = status.filter(|status| status.source == SourceState::Running)?;
    Some(match status.stillness {
        None => (Mark::Runs, text!("live-file-is-part")),
        Some(MotionState::Watching) => (Mark::Open, text!("live-looking")),
        Some(MotionState::Moving) => (Mark::Open, text!("live-moving")),
        Some(MotionState::Steady { lasting, .. }) => {
            let seconds = format!("{:.1}", lasting.as_secs_f64());
            (Mark::Runs, text!("live-steady-for", seconds = seconds))
        }
    })
}

/// Returns what following this source is called.
pub(crate) fn name(source: &Source) -> String {
    match source {
        Source::Camera(spec) if matches!(**spec, SourceSpec::Recording(_)) => text!("live-playing"),
        Source::Camera(spec) if matches!(**spec, SourceSpec::Watched(_)) => text!("live-watching"),
        Source::Camera(_) | Source::Cell(_) | Source::File(_) | Source::Scan(_) => {
            text!("shell-live")
        }
    }
}

/// Describes what the verdict is based on.
fn evidence_text(status: &LiveStatus) -> String {
    let averaged = |evidence: String| match status.num_averaged {
        0 | 1 => evidence,
        num => text!("live-averaged", evidence = evidence, num = num),
    };
    match (&status.standing, status.stillness) {
        (_, None) => text!("live-file-by-file"),
        (LiveVerdict::Open, _) => text!("live-no-verdict"),
        (LiveVerdict::Gathering { num_frames, needed }, _) => {
            averaged(text!("live-frames-of", num = *num_frames, needed = *needed))
        }
        (LiveVerdict::Counted(agreed), _) => {
            let ConsensusVerdict {
                num_frames,
                num_agreeing,
                ..
            } = **agreed;
            averaged(text!(
                "live-frames-agree",
                agreeing = num_agreeing,
                num = num_frames
            ))
        }
    }
}

/// Formats rates, latency and dropped frames. Captures of a watched folder come one by one, without a rate.
pub(crate) fn figures(status: &LiveStatus) -> String {
    let [captured, inspected] = status
        .rates
        .map(|rate| rate.map_or_else(|| "–".to_owned(), |rate| format!("{rate:.0}")));
    let latency = status
        .latency
        .map(|latency| format!("{:.0} ms", latency.as_secs_f64() * 1000.0));
    let dropped = (status.num_dropped > 0).then(|| text!("live-dropped", num = status.num_dropped));
    let has_rates = status.stillness.is_some();
    let rates = || text!("live-rates", captured = captured, inspected = inspected);
    let rates = has_rates.then(rates);
    let all: Vec<String> = [rates, latency, dropped].into_iter().flatten().collect();
    all.join(" · ")
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn running(stillness: Option<MotionState>) -> LiveStatus {
        LiveStatus {
            source: SourceState::Running,
            stillness,
            standing: LiveVerdict::Open,
            rates: [Some(0.0); 2],
            inspection_rate: None,
            latency: Some(Duration::from_millis(88)),
            held_up_by: None,
            num_inspected: 8,
            num_dropped: 0,
            num_averaged: 1,
            recorded: None,
        }
    }

    #[test]
    fn a_scene_at_rest_has_no_tick_because_that_would_be_a_verdict() {
        let steady = MotionState::Steady {
            since: Duration::ZERO,
            lasting: Duration::from_secs(9),
        };
        let all = [MotionState::Watching, MotionState::Moving, steady];
        let mut session = Session::default();
        for stillness in all.into_iter().map(Some).chain([None]) {
            session.live.status = Some(running(stillness));
            let (mark, words) = motion(&session).expect("frames arrive");
            assert_ne!(mark, Mark::Good, "{words}");
        }
        session.live.status = Some(LiveStatus {
            source: SourceState::Opening,
            ..running(Some(steady))
        });
        assert_eq!(motion(&session), None);
    }

    #[test]
    fn a_watched_folder_has_no_rates() {
        let mut status = running(None);
        assert_eq!(figures(&status), "88 ms");
        status.stillness = Some(MotionState::Watching);
        assert_eq!(figures(&status), "0 fps, 0 inspected · 88 ms");
    }
}
