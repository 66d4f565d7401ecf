//! Status of following the source as text: on the verdict card, or in the bar while the card is not in front.

use egui::{Button, RichText, Ui, Vec2};

use super::{
    state::megabytes,
    work::{LiveStatus, SourceState},
};
use crate::session::{Session, Source};
use capture::SourceSpec;
use inspection::pipeline::live::{ConsensusVerdict, LiveVerdict, MotionState};
use ui::{
    language::text,
    theme::{Theme, font, space},
    widgets::{Mark, line_mark, status_label},
};

/// Height of the head of the card, logical pixels: constant, so that nothing below moves.
const HEIGHT: f32 = 64.0;

/// Draws the head of the verdict card while the source is followed. True if recording shall start or stop.
pub fn card(ui: &mut Ui, session: &Session) -> bool {
    let theme = Theme::of(ui);
    let (sign, words) = words(session);
    let small = |text: String| RichText::new(text).small().weak();
    let size = Vec2::new(ui.available_width(), HEIGHT);
    ui.allocate_ui(size, |ui| {
        ui.set_min_size(size);
        ui.spacing_mut().item_spacing.y = 3.0;
        ui.horizontal(|ui| {
            line_mark(ui, 16.0, 7.5, sign);
            status_label(ui, &words, font::body_strong(), theme.text);
        });
        let status = session.live.status.as_ref();
        ui.label(small(status.map_or_else(String::new, evidence_text)));
        ui.label(small(status.map_or_else(String::new, figures)));
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

/// Draws the status and the rates beside it, if there is room.
pub(crate) fn chip(ui: &mut Ui, session: &Session) {
    let theme = Theme::of(ui);
    let (sign, words) = words(session);
    ui.add_space(space::SMALL);
    line_mark(ui, 16.0, 7.5, sign);
    let rates = session.live.status.as_ref().map(figures);
    let text = match rates {
        Some(rates) if !rates.is_empty() && ui.available_width() > 320.0 => {
            format!("{words} · {rates}")
        }
        _ => words,
    };
    status_label(ui, &text, font::body(), theme.weak_text);
}

/// Returns the most important status, with its mark.
pub(crate) fn words(session: &Session) -> (Mark, String) {
    let name = match &session.source {
        Source::Camera(spec) if matches!(**spec, SourceSpec::Recording(_)) => text!("live-playing"),
        Source::Camera(spec) if matches!(**spec, SourceSpec::Watched(_)) => text!("live-watching"),
        Source::Camera(_) | Source::Cell(_) | Source::File(_) | Source::Scan(_) => {
            text!("shell-live")
        }
    };
    let Some(status) = &session.live.status else {
        let opening = text!("live-opening");
        return (Mark::Open, format!("{name} · {opening}"));
    };
    if status.held_up_by.is_some() && status.source == SourceState::Running {
        let what = text!("live-too-slow");
        return (Mark::Look, format!("{name} · {what}"));
    }
    let (sign, what) = match (&status.source, status.stillness) {
        (SourceState::Lost(_), _) => (Mark::Bad, text!("live-lost")),
        (SourceState::Opening, _) => (Mark::Open, text!("live-opening")),
        (SourceState::Running, None) => (Mark::Runs, text!("live-file-is-part")),
        (SourceState::Running, Some(MotionState::Watching)) => (Mark::Open, text!("live-looking")),
        (SourceState::Running, Some(MotionState::Moving)) => (Mark::Open, text!("live-moving")),
        (SourceState::Running, Some(MotionState::Steady { lasting, .. })) => (
            Mark::Runs,
            text!(
                "live-steady-for",
                seconds = format!("{:.1}", lasting.as_secs_f64())
            ),
        ),
    };
    (sign, format!("{name} · {what}"))
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
fn figures(status: &LiveStatus) -> String {
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
    use inspection::pipeline::live::InspectionRate;

    fn running(stillness: Option<MotionState>) -> LiveStatus {
        LiveStatus {
            source: SourceState::Running,
            stillness,
            standing: LiveVerdict::Open,
            rates: [Some(0.0); 2],
            latency: Some(Duration::from_millis(88)),
            held_up_by: None,
            num_inspected: 8,
            num_dropped: 0,
            num_averaged: 1,
            recorded: None,
        }
    }

    #[test]
    fn a_source_has_no_tick_because_that_would_be_a_verdict() {
        let steady = MotionState::Steady {
            since: Duration::ZERO,
            lasting: Duration::from_secs(9),
        };
        let all = [MotionState::Watching, MotionState::Moving, steady];
        for stillness in all.into_iter().map(Some).chain([None]) {
            let mut session = Session::default();
            session.live.status = Some(running(stillness));
            let (sign, words) = words(&session);
            assert_ne!(sign, Mark::Good, "{words}");
        }
    }

    #[test]
    fn while_a_verdict_waits_for_a_slow_computer_the_source_says_so() {
        let mut session = Session::default();
        let says = |session: &Session| {
            let (_, words) = words(session);
            words.contains("computer too slow")
        };
        let slow = LiveStatus {
            held_up_by: Some(InspectionRate {
                num_inspected: 2,
                num_frames: 30,
            }),
            ..running(Some(MotionState::Watching))
        };
        session.live.status = Some(slow.clone());
        assert!(says(&session), "{}", words(&session).1);
        session.live.status = Some(LiveStatus {
            source: SourceState::Opening,
            ..slow
        });
        assert!(!says(&session));
        session.live.status = Some(running(Some(MotionState::Watching)));
        assert!(!says(&session));
    }

    #[test]
    fn a_watched_folder_has_no_rates() {
        let mut status = running(None);
        assert_eq!(figures(&status), "88 ms");
        status.stillness = Some(MotionState::Watching);
        assert_eq!(figures(&status), "0 fps, 0 inspected · 88 ms");
    }
}
