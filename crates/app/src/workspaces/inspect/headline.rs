//! The headline of the verdict card: which part, accepted or not, and why.

use egui::{Color32, FontId, RichText, Ui};

use super::hold::Hold;
use crate::shared::truth_title;
use inspection::pipeline::{
    Identification, Inspection, SurfaceVerdict, Verdict, live::MotionState,
};
use records::history::StoredVerdict;
use shell::{inspection::inspected::Inspected, language::accepted_or_not, session::Session};
use station::Doubt;
use texts::Described as _;
use ui::{
    language::{Language, Message, advised, described, text},
    theme::{Theme, font, space},
    widgets::{Mark, line_mark, sentence, wrapped},
};

/// State that the headline shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum HeadlineState {
    /// Accepted, and a robot may act on it: only this is green.
    Go,
    /// Accepted, but no robot may act on it.
    Recognised,
    /// Too early for a verdict.
    Open,
    /// Nothing hangs there: an empty cell is not a bad part.
    NoPart,
    /// Not accepted.
    #[default]
    Refused,
}

impl HeadlineState {
    pub(super) fn is_accepted(self) -> bool {
        matches!(self, Self::Go | Self::Recognised)
    }
}

/// Texts of the headline.
#[derive(Default)]
pub(super) struct Headline {
    pub(super) title: String,
    /// The nearest part, where none is accepted.
    nearest: Option<String>,
    pub(super) state: HeadlineState,
    /// Title of what really hung there, if the acceptance was reported as wrong.
    pub(super) actual: Option<String>,
    /// Why it is not accepted, or why no robot may act on it, and what to do.
    pub(super) complaint: Option<(String, String)>,
}

impl Headline {
    /// True if the part is accepted, and nobody has reported it as wrong.
    pub(super) fn is_accepted(&self) -> bool {
        self.state.is_accepted() && self.actual.is_none()
    }

    /// Sign, word and colour of the verdict.
    pub(super) fn verdict(&self, theme: &Theme) -> (Mark, String, Color32) {
        if self.actual.is_some() {
            let word = text!("operator-reported-wrong");
            return (Mark::Bad, word, theme.rejected);
        }
        match self.state {
            HeadlineState::Go => (Mark::Good, accepted_or_not(true), theme.accepted),
            HeadlineState::Recognised => (Mark::Known, text!("inspect-recognised"), theme.text),
            HeadlineState::Open => (Mark::Look, text!("inspect-not-accepted-yet"), theme.warning),
            HeadlineState::NoPart | HeadlineState::Refused => {
                (Mark::Bad, accepted_or_not(false), theme.rejected)
            }
        }
    }

    pub(super) fn of(inspected: &Inspected, session: &Session) -> Self {
        let verdict = Self::of_verdict(inspected, session);
        let actual = session.shift.reported_as(inspected);
        let actual = actual.filter(|_| verdict.state.is_accepted());
        let Some(truth) = actual else {
            return verdict;
        };
        let actual = truth_title(Some(truth), &inspected.library);
        Self {
            complaint: Some((
                text!("shell-actual-part", part = &actual),
                verdict
                    .complaint
                    .map_or_else(String::new, |(_, advice)| advice),
            )),
            actual: Some(actual),
            ..verdict
        }
    }

    fn of_verdict(inspected: &Inspected, session: &Session) -> Self {
        if let Some(followed) = &inspected.followed {
            let is_moving = session.currency(inspected) == Some(Doubt::Moving);
            if is_moving || inspected.is_open() {
                // What moves now may have hung still in the frame that is shown.
                let status = session.live.status.as_ref().filter(|_| is_moving);
                let stillness = match status.and_then(|status| status.stillness) {
                    Some(MotionState::Steady { .. }) | None => followed.stillness,
                    Some(now) => now,
                };
                let headline = Self::not_yet(inspected, stillness, is_moving);
                let Some(rate) = status.and_then(|status| status.held_up_by) else {
                    return headline;
                };
                let part = headline.nearest.clone().unwrap_or_default();
                let why = rate.refusal(part);
                return Self {
                    title: text!("inspect-looking"),
                    complaint: Some((described(&why), advised(&why))),
                    ..headline
                };
            }
        }
        let verdict = &inspected.inspection.verdict;
        let rejected = match verdict {
            Verdict::Part { rejected, .. } => rejected,
            Verdict::NoPart(reason) => {
                return Self {
                    title: described(&StoredVerdict::NoPart),
                    state: HeadlineState::NoPart,
                    complaint: Some((described(reason), advised(reason))),
                    ..Self::default()
                };
            }
        };
        let nearest = inspected.part_title().unwrap_or_default().to_owned();
        let Some(reason) = rejected else {
            let hold = Hold::of(session, inspected, session.role);
            let surface = surface_complaint(&inspected.inspection);
            let state = match (&hold, &surface) {
                (None, None) => HeadlineState::Go,
                (Some(_), _) | (_, Some(_)) => HeadlineState::Recognised,
            };
            // The card already says above why it is old.
            let is_said =
                session.is_old() || session.shown.as_ref().is_some_and(|shown| shown.is_past);
            let hold = hold.filter(|_| !is_said);
            let hold = hold.map(|hold| (hold.reason, hold.advice));
            return Self {
                title: nearest,
                state,
                complaint: surface.or(hold),
                ..Self::default()
            };
        };
        let found = verdict.identification();
        // Do not show an uncertain name in large letters.
        let title = found.heading(&nearest, Language::current());
        let title = title.unwrap_or_else(|| match found {
            Identification::NotRecognised => text!("inspect-not-recognised"),
            _ => text!("inspect-unknown-part"),
        });
        let title_of = |name: &str| inspected.library.title_of(name).to_owned();
        let why = reason.message().with_titles(title_of);
        Self {
            title,
            nearest: found.names_nearest().then_some(nearest),
            complaint: Some((described(&why), advised(&why))),
            ..Self::default()
        }
    }

    /// Headline of a frame whose verdict does not count.
    fn not_yet(inspected: &Inspected, stillness: MotionState, is_live: bool) -> Self {
        let (title, why, advice) = match stillness {
            MotionState::Moving if !is_live => (
                text!("inspect-no-verdict"),
                text!("inspect-stopped-moving"),
                text!("inspect-press-capture"),
            ),
            _ if !is_live => (
                text!("inspect-no-verdict"),
                text!("inspect-live-stopped"),
                text!("inspect-press-capture"),
            ),
            MotionState::Moving => (
                sentence(&text!("live-moving")),
                text!("inspect-something-moves"),
                advised(&Message::new("refusal-not-steady")),
            ),
            MotionState::Watching => (
                text!("inspect-looking"),
                text!("inspect-not-long-enough"),
                text!("shell-wait"),
            ),
            MotionState::Steady { .. } => (
                text!("inspect-looking"),
                text!("inspect-it-is-steady"),
                text!("shell-wait"),
            ),
        };
        Self {
            title,
            nearest: inspected.part_title().map(str::to_owned),
            state: HeadlineState::Open,
            complaint: Some((why, advice)),
            ..Self::default()
        }
    }
}

/// What is wrong with the surface of an accepted part, and what to do; `None` if nothing is, or if it was not checked.
pub(super) fn surface_complaint(inspection: &Inspection) -> Option<(String, String)> {
    let check = inspection.surface.as_ref()?;
    let advice = match check.verdict {
        SurfaceVerdict::Ok => return None,
        SurfaceVerdict::NotJudged => check.not_judged.as_ref().map_or_else(String::new, advised),
        SurfaceVerdict::Rework | SurfaceVerdict::Scrap => text!("inspect-surface-advice"),
    };
    let verdict = described(&check.verdict);
    Some((text!("inspect-surface-is", verdict = verdict), advice))
}

/// Draws the headline, legible from three metres.
pub(super) fn ui(ui: &mut Ui, headline: &Headline) {
    let theme = Theme::of(ui);
    ui.label(RichText::new(&headline.title).font(fitting_font(
        ui,
        &headline.title,
        &font::far_names(),
        2,
    )));
    let (sign, word, colour) = headline.verdict(theme);
    if headline.state != HeadlineState::NoPart {
        ui.horizontal(|ui| {
            line_mark(ui, 32.0, 14.0, sign);
            let fonts = [font::far_verdict(), font::far_reason()];
            wrapped(ui, &word, &fitting_font(ui, &word, &fonts, 1), colour);
        });
    }
    if let Some(nearest) = &headline.nearest {
        ui.weak(text!("inspect-nearest", part = nearest));
    }
    if let Some((reason, advice)) = &headline.complaint {
        ui.add_space(space::SMALL);
        wrapped(ui, &sentence(reason), &font::far_reason(), theme.text);
        if !advice.is_empty() {
            wrapped(ui, advice, &font::body_strong(), theme.warning);
        }
    }
    ui.add_space(space::SMALL);
}

/// Returns the first font in which the name fits into `max_lines` without breaking a word, or the last font.
fn fitting_font(ui: &Ui, name: &str, fonts: &[FontId], max_lines: usize) -> FontId {
    let (width, colour) = (ui.available_width(), ui.visuals().text_color());
    let fits = |font: &FontId| {
        let size = |text: &str, width: f32| {
            let painter = ui.painter();
            let galley = painter.layout(text.to_owned(), font.clone(), colour, width);
            (galley.rows.len(), galley.size().x)
        };
        let mut words = name.split_whitespace();
        words.all(|word| size(word, f32::INFINITY).1 <= width) && size(name, width).0 <= max_lines
    };
    let fitting = fonts.iter().find(|font| fits(font)).or(fonts.last());
    fitting.cloned().unwrap_or_else(font::title)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use inspection::{
        library::Truth,
        pipeline::{
            Rejection,
            live::{InspectionRate, LiveVerdict},
        },
    };
    use shell::{
        inspection::{
            inspected::{LiveFrameContext, inspected_cell},
            source::CellChoice,
        },
        session::Shown,
        source::live::{LiveStatus, SourceState},
    };

    #[test]
    fn a_part_that_was_reported_as_wrong_is_called_so_with_what_it_is() {
        let found = inspected_cell(CellChoice::InTurn, 1);
        let mut session = Session::default();
        assert_eq!(Headline::of(&found, &session).actual, None);
        session.shift.labelled = vec![(found.hung().clone(), Truth::NotEnrolled)];
        let headline = Headline::of(&found, &session);
        assert_eq!(headline.actual.as_deref(), Some("Not enrolled"));
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let output = ctx.run_ui(egui::RawInput::default(), |root| ui(root, &headline));
        let written = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
            egui::Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        });
        let written: Vec<String> = written.collect();
        output.drop_without_applying_deltas();
        for text in ["Reported as wrong", "Actual part: Not enrolled"] {
            assert!(written.iter().any(|drawn| drawn == text), "{written:?}");
        }
        assert!(!written.iter().any(|drawn| drawn == "Accepted"));
    }

    #[test]
    fn the_part_is_named_not_the_reference_that_was_found() {
        let mut found = inspected_cell(CellChoice::InTurn, 1);
        let session = Session::default();
        "front_door_b".clone_into(&mut found.inspection.ranking.entries[0].enrolled_as);
        "front_door_b".clone_into(&mut found.figures.candidates[0].title);
        let headline = Headline::of(&found, &session);
        assert_eq!(headline.title, "Front door, left");
        found.followed = Some(LiveFrameContext {
            stillness: MotionState::Moving,
            standing: LiveVerdict::Open,
        });
        let headline = Headline::of(&found, &session);
        assert_eq!(headline.nearest.as_deref(), Some("Front door, left"));
        found.followed = None;
        found.inspection.verdict = Verdict::Part {
            part: "front_door".into(),
            score: 0.85,
            margin: 0.97,
            rejected: Some(Rejection::NotSteady {
                part: "front_door".into(),
            }),
            is_approximate: false,
        };
        let headline = Headline::of(&found, &session);
        assert_eq!(headline.nearest.as_deref(), Some("Front door, left"));
    }

    #[test]
    fn a_part_that_waits_for_a_slow_computer_is_not_blamed() {
        let mut found = inspected_cell(CellChoice::InTurn, 1);
        found.followed = Some(LiveFrameContext {
            stillness: MotionState::Watching,
            standing: LiveVerdict::Open,
        });
        let found = Arc::new(found);
        let mut session = Session {
            shown: Some(Shown {
                session: Some(1),
                ..Shown::new(1, Arc::clone(&found))
            }),
            ..Session::default()
        };
        session.live.is_on = true;
        let mut headline = |held_up_by| {
            session.live.status = Some(LiveStatus {
                source: SourceState::Running,
                stillness: Some(MotionState::Watching),
                standing: LiveVerdict::Open,
                rates: [None; 2],
                inspection_rate: None,
                latency: None,
                held_up_by,
                num_inspected: 9,
                num_dropped: 99,
                num_averaged: 1,
                recorded: None,
            });
            let headline = Headline::of(&found, &session);
            assert_eq!(headline.state, HeadlineState::Open);
            headline.complaint.expect("said")
        };
        let slow = InspectionRate {
            num_inspected: 2,
            num_frames: 30,
        };
        let (why, advice) = headline(Some(slow));
        assert!(
            why.ends_with("too slow (2 of 30 frames inspected)"),
            "{why}"
        );
        assert!(advice.contains("max_parts"), "{advice}");
        let (why, _) = headline(None);
        assert!(!why.contains("slow"), "{why}");
    }

    #[test]
    fn a_mirror_image_is_called_so_even_if_the_part_itself_fits_nearly_as_well() {
        let mut found = inspected_cell(CellChoice::InTurn, 1);
        let part = || "front_door".to_owned();
        found.inspection.verdict = Verdict::Part {
            part: part(),
            score: 0.97,
            margin: 0.97,
            rejected: Some(Rejection::MirroredImage {
                part: part(),
                score: 0.99,
            }),
            is_approximate: false,
        };
        let headline = Headline::of(&found, &Session::default());
        assert_eq!(headline.title, "Mirror image of Front door, left");
        assert_eq!(headline.nearest, None);
    }

    #[test]
    fn an_empty_cell_is_not_called_not_accepted() {
        let session = Session::default();
        for (choice, is_no_part) in [(CellChoice::Empty, true), (CellChoice::InTurn, false)] {
            let found = inspected_cell(choice, 1);
            let state = Headline::of(&found, &session).state;
            assert_eq!(state == HeadlineState::NoPart, is_no_part);
        }
    }

    #[test]
    fn a_part_that_is_only_in_doubt_where_it_is_is_called_by_its_name() {
        let mut found = inspected_cell(CellChoice::InTurn, 1);
        let session = Session::default();
        let title = Headline::of(&found, &session).title;
        for (score, is_recognised) in [(0.97, true), (0.85, false)] {
            found.inspection.verdict = Verdict::Part {
                part: "front_door".into(),
                score,
                margin: 0.97,
                rejected: Some(Rejection::AmbiguousPose {
                    part: "front_door".into(),
                    margin: 0.43,
                    threshold: 0.6,
                }),
                is_approximate: false,
            };
            let headline = Headline::of(&found, &session);
            assert!(!headline.state.is_accepted() && headline.complaint.is_some());
            assert_eq!(headline.nearest.is_none(), is_recognised);
            let expected = if is_recognised {
                title.as_str()
            } else {
                "Not recognised"
            };
            assert_eq!(headline.title, expected);
        }
    }
}
