//! What the verdict card says first: which part, accepted or not, and why.

use egui::{FontId, RichText, Sense, Ui, Vec2};

use crate::{
    app::{
        inspection::inspected::{Inspected, LiveFrameContext},
        shell::session::Session,
        ui::{
            theme::{Theme, font, space},
            widgets::{Mark, mark, sentence},
        },
    },
    error::Advice as _,
    pipeline::{Rejection, Verdict, live::MotionState},
};

/// What the card says first.
pub(super) struct Headline {
    pub(super) title: String,
    /// The part that comes nearest, where none is accepted.
    nearest: Option<String>,
    pub(super) is_accepted: bool,
    /// True if it is too early to say.
    pub(super) is_open: bool,
    /// Why not, and what to do.
    pub(super) complaint: Option<(String, String)>,
}

impl Headline {
    pub(super) fn of(inspected: &Inspected, session: &Session) -> Self {
        if let Some(followed) = &inspected.followed
            && followed.standing.counted().is_none()
        {
            return Self::not_yet(inspected, followed, session.is_live());
        }
        match &inspected.inspection.verdict {
            Verdict::Part { part, rejected, .. } => {
                let best = inspected.figures.candidates.first();
                let nearest = best.map_or_else(|| part.clone(), |best| best.title.clone());
                let title_of = |name: &str| inspected.library.title_of(name).to_owned();
                let rejected = rejected.clone().map(|reason| reason.renamed(title_of));
                match &rejected {
                    None => Self {
                        title: nearest,
                        nearest: None,
                        is_accepted: true,
                        is_open: false,
                        complaint: None,
                    },
                    // Of its type beyond doubt.
                    Some(
                        reason @ (Rejection::AnotherModel { .. } | Rejection::AnotherMake { .. }),
                    ) => Self {
                        title: match reason {
                            Rejection::AnotherMake { .. } => format!("{nearest}, another make"),
                            _ => format!("{nearest}, another model"),
                        },
                        nearest: None,
                        is_accepted: false,
                        is_open: false,
                        complaint: Some((reason.to_string(), reason.advice())),
                    },
                    // No name in large letters that is not certain.
                    Some(reason) => Self {
                        title: if inspected.inspection.verdict.is_unknown() {
                            "Unknown part".into()
                        } else {
                            "Not recognised".into()
                        },
                        nearest: Some(nearest),
                        is_accepted: false,
                        is_open: false,
                        complaint: Some((reason.to_string(), reason.advice())),
                    },
                }
            }
            Verdict::NoPart(reason) => Self {
                title: "No part".into(),
                nearest: None,
                is_accepted: false,
                is_open: false,
                complaint: Some((reason.to_string(), reason.advice())),
            },
        }
    }

    /// Of a frame whose verdict does not count.
    fn not_yet(inspected: &Inspected, followed: &LiveFrameContext, is_live: bool) -> Self {
        let is_part = matches!(inspected.inspection.verdict, Verdict::Part { .. });
        let nearest = inspected.figures.candidates.first();
        let (title, complaint) = match followed.stillness {
            _ if !is_live => (
                "No verdict",
                ("Live was stopped before a verdict counted", "Press Capture"),
            ),
            MotionState::Moving => (
                "Moving",
                (
                    "something is moving in front of the camera",
                    "Let the part hang still for a second",
                ),
            ),
            MotionState::Watching => (
                "Looking",
                ("it was not seen for long enough", "Wait a moment"),
            ),
            MotionState::Steady { .. } => ("Looking", ("it is steady", "Wait a moment")),
        };
        Self {
            title: title.into(),
            nearest: nearest.filter(|_| is_part).map(|best| best.title.clone()),
            is_accepted: false,
            is_open: true,
            complaint: Some((complaint.0.into(), complaint.1.into())),
        }
    }
}

/// Draws it, to be read from three metres.
pub(super) fn ui(ui: &mut Ui, headline: &Headline, theme: &Theme) {
    ui.label(
        RichText::new(&headline.title)
            .font(fitting_font(ui, &headline.title, &font::far_names(), 2))
            .color(theme.text),
    );
    let (sign, word, colour) = if headline.is_accepted {
        (Mark::Good, "Accepted", theme.accepted)
    } else if headline.is_open {
        (Mark::Look, "Not accepted yet", theme.warning)
    } else {
        (Mark::Bad, "Not accepted", theme.rejected)
    };
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(32.0), Sense::hover());
        mark(ui.painter(), rect.center(), 14.0, sign, theme);
        ui.label(RichText::new(word).font(font::far_verdict()).color(colour));
    });
    if let Some(nearest) = &headline.nearest {
        ui.label(RichText::new(format!("Nearest: {nearest}")).color(theme.weak_text));
    }
    if let Some((reason, advice)) = &headline.complaint {
        ui.add_space(space::SMALL);
        let reason = RichText::new(sentence(reason)).font(font::far_reason());
        ui.label(reason.color(theme.text));
        ui.label(
            RichText::new(advice)
                .font(font::body_strong())
                .color(theme.warning),
        );
    }
    ui.add_space(space::SMALL);
}

/// The first font in which the name fits into `max_lines` without breaking a word; the last one if none does.
pub(super) fn fitting_font(ui: &Ui, name: &str, fonts: &[FontId], max_lines: usize) -> FontId {
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
