//! The operator's view: which part, OK or not, and what to do next, legible across the shop.

use egui::{
    Align, CentralPanel, Color32, FontId, Frame, Id, Label, Layout, Margin, Panel, RichText,
    ScrollArea, Sense, Ui, Vec2, style::ScrollStyle, vec2,
};

use super::{
    headline::{Headline, fitting_font},
    operator_words::{in_short, next_step, next_without_part, no_part_in_short},
};
use crate::{
    app::{
        inspection::{inspected::Inspected, source::Origin},
        language::{history::recognised_part, results::stored_verdict, text},
        shell::{
            current_trace,
            live::SourceState,
            operator_bars::column_width,
            session::{Session, Source},
        },
        ui::{
            theme::{Theme, font, space},
            widgets::{Mark, fitted_middle, line_mark, mark, sentence, wrapped, wrapped_rows},
        },
    },
    capture::SourceSpec,
    history::StoredVerdict,
    pipeline::{Unrecognisable, Verdict},
    stages::pose::PoseEstimate,
};

/// Height of the banner in a high and in a low window, logical pixels.
const BANNER: [f32; 2] = [190.0, 156.0];
/// Space above and below the column on the right in a high and in a low window, logical pixels.
const COLUMN_MARGIN: [i8; 2] = [20, 12];
/// Height of a line of the list of parts, logical pixels.
const LINE: f32 = 40.0;
/// Heights of the name and of a line below it, logical pixels.
const TWO_LINES: [f32; 2] = [28.0, 26.0];
/// Minimum height of the list of parts: two of them with their serial numbers, logical pixels.
const LEAST_LIST: f32 = 2.0 * (TWO_LINES[0] + TWO_LINES[1]) + space::SMALL;
/// Width of the sign before a warning, logical pixels.
const SIGN: f32 = 24.0;
/// Longest reason or advice that fits in the large type, characters.
const LONG: usize = 60;

/// State that the banner shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tone {
    /// An accepted part.
    Ok,
    /// A part that is not accepted.
    NotOk,
    /// There is no verdict, or not yet.
    Open,
    /// There is no result, and somebody has to fix it.
    Trouble,
}

impl Tone {
    fn word(self) -> String {
        match self {
            Self::Ok => text!("operator-ok"),
            Self::NotOk => text!("operator-not-ok"),
            Self::Open | Self::Trouble => String::new(),
        }
    }

    fn mark(self) -> Mark {
        match self {
            Self::Ok => Mark::Good,
            Self::NotOk => Mark::Bad,
            Self::Open => Mark::Open,
            Self::Trouble => Mark::Look,
        }
    }

    /// Colours of the word and of its background.
    fn colours(self, theme: &Theme) -> [Color32; 2] {
        match self {
            Self::Ok => [theme.accepted, theme.accepted_back],
            Self::NotOk => [theme.rejected, theme.rejected_back],
            Self::Open => [theme.weak_text, theme.panel],
            Self::Trouble => [theme.warning, theme.panel],
        }
    }
}

/// The verdict, its reason and the next step, in the operator's words.
#[derive(Debug)]
struct Banner {
    tone: Tone,
    title: String,
    reason: String,
    next: String,
    /// What else the operator should know about the part; may be empty.
    caution: String,
    /// True if the picture shows what hangs there now.
    is_current: bool,
}

impl Banner {
    fn new(
        tone: Tone,
        title: impl Into<String>,
        reason: impl Into<String>,
        next: impl Into<String>,
    ) -> Self {
        Self {
            tone,
            title: title.into(),
            reason: reason.into(),
            next: next.into(),
            caution: String::new(),
            is_current: false,
        }
    }

    fn of(session: &Session) -> Self {
        let wait = text!("operator-wait");
        if session.is_live() {
            match session.live.status.as_ref().map(|status| &status.source) {
                None | Some(SourceState::Opening) => {
                    return Self::new(Tone::Open, text!("operator-opening-camera"), "", wait);
                }
                Some(SourceState::Lost(_)) => return Self::of_lost(&session.source),
                Some(SourceState::Running) => {}
            }
        } else if let Some(run) = &session.inspecting {
            return Self::new(Tone::Open, text!("operator-inspecting"), &run.title, wait);
        }
        if let Some(trouble) = &session.failed {
            // A watched folder has no Capture: the next file comes by itself.
            let next = if session.is_watching() {
                trouble.advice.clone()
            } else {
                text!("operator-no-result-next")
            };
            return Self::new(
                Tone::Trouble,
                text!("operator-no-result"),
                sentence(&trouble.what),
                next,
            );
        }
        if let Some(library) = &session.library {
            let ask = text!("operator-ask-to-enrol");
            if let Some(trouble) = &library.unloaded {
                return Self::new(
                    Tone::Trouble,
                    text!("operator-no-library"),
                    sentence(&trouble.what),
                    ask,
                );
            }
            if library.parts.is_empty() {
                let why = text!("operator-no-parts-why");
                return Self::new(Tone::Trouble, text!("operator-no-parts"), why, ask);
            }
        }
        // What is shown may be of another source, or from before this one was followed.
        let shown = session.shown.as_ref().filter(|shown| !shown.is_outdated);
        let Some(shown) = shown else {
            return if session.is_watching() {
                Self::new(
                    Tone::Open,
                    text!("shell-waiting-for-file"),
                    text!("operator-no-new-file"),
                    text!("operator-save-capture"),
                )
            } else if session.is_live() {
                Self::new(
                    Tone::Open,
                    text!("operator-looking"),
                    text!("operator-nothing-captured"),
                    wait,
                )
            } else {
                let next = text!("operator-hang-and-capture");
                Self::new(
                    Tone::Open,
                    text!("operator-ready"),
                    text!("operator-nothing-inspected"),
                    next,
                )
            };
        };
        let inspected = &shown.inspected;
        let result = Self::of_result(inspected, session);
        let mut verdict = Self {
            caution: caution(inspected, result.tone),
            is_current: true,
            ..result
        };
        let serial = session.trace.of_part(inspected).serial;
        // While the next part swings in, a frame may still belong to the one before.
        let is_part = inspected.entry.record.summary.verdict != StoredVerdict::NoPart;
        if is_part && !inspected.is_open() && !serial.is_empty() {
            verdict.reason = format!("{} · {serial}", verdict.reason);
        }
        if shown.is_past {
            let next = match session.source.followed() {
                Some(_) => text!("operator-follow-current"),
                None => text!("operator-capture-current"),
            };
            return Self {
                tone: Tone::Open,
                reason: text!("operator-from-history"),
                next,
                caution: String::new(),
                ..verdict
            };
        }
        verdict
    }

    /// The exact error is for the engineer.
    fn of_lost(source: &Source) -> Self {
        let (title, next) = if is_folder(source) {
            (
                text!("operator-no-folder"),
                text!("operator-no-folder-next"),
            )
        } else {
            (
                text!("operator-no-camera"),
                text!("operator-no-camera-next"),
            )
        };
        Self::new(Tone::Trouble, title, text!("operator-lost"), next)
    }

    fn of_result(inspected: &Inspected, session: &Session) -> Self {
        let Headline {
            title,
            is_accepted,
            is_open,
            actual,
            complaint,
            ..
        } = Headline::of(inspected, session);
        let inspection = &inspected.inspection;
        if actual.is_some() {
            let next = text!("operator-reported-wrong-next");
            return Self::new(Tone::NotOk, title, text!("operator-reported-wrong"), next);
        }
        if is_accepted {
            let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
            let next = if inspected.origin.is_simulated() {
                text!("operator-simulated-next")
            } else if pose.is_some_and(PoseEstimate::is_ambiguous) {
                text!("operator-ambiguous-next")
            } else if matches!(inspected.origin, Origin::File { .. }) {
                text!("operator-file-next")
            } else if caution(inspected, Tone::Ok).is_empty() {
                text!("operator-start-robot")
            } else {
                text!("operator-check-part-next")
            };
            return Self::new(Tone::Ok, title, text!("operator-recognised"), next);
        }
        let (reason, advice) = complaint.unwrap_or_default();
        if is_open {
            return Self::new(Tone::Open, title, sentence(&reason), advice);
        }
        let nearest = inspection.verdict.guess().map_or_else(
            || text!("operator-an-enrolled-part"),
            |part| inspected.library.title_of(part).to_owned(),
        );
        match &inspection.verdict {
            Verdict::NoPart(why @ Unrecognisable::EmptyLibrary) => Self::new(
                Tone::Trouble,
                text!("operator-no-parts"),
                no_part_in_short(why),
                text!("operator-ask-to-enrol"),
            ),
            // An empty cell is not a bad part.
            Verdict::NoPart(why) => {
                let next = next_without_part(why, session);
                Self::new(Tone::Open, title, no_part_in_short(why), next)
            }
            Verdict::Part {
                rejected: Some(why),
                ..
            } => {
                let next = next_step(why, &nearest, session);
                Self::new(Tone::NotOk, title, in_short(why, &nearest), next)
            }
            Verdict::Part { rejected: None, .. } => {
                Self::new(Tone::NotOk, title, sentence(&reason), advice)
            }
        }
    }
}

/// Says that some of a part is outside the picture, or that an accepted one may be another model.
fn caution(inspected: &Inspected, tone: Tone) -> String {
    let is_cut = inspected.inspection.touches_edge() && inspected.scan.is_none();
    match tone {
        Tone::NotOk if is_cut => text!("operator-reaches-edge"),
        Tone::Ok => {
            let is_approximate = inspected.inspection.verdict.is_approximate();
            let cautions = [
                is_cut.then(|| text!("operator-reaches-edge-ok")),
                is_approximate.then(|| text!("operator-approximate-ok")),
            ];
            let cautions: Vec<String> = cautions.into_iter().flatten().collect();
            cautions.join("\n")
        }
        Tone::NotOk | Tone::Open | Tone::Trouble => String::new(),
    }
}

/// True for a watched folder or a recording.
fn is_folder(source: &Source) -> bool {
    matches!(source, Source::Camera(spec)
        if matches!(**spec, SourceSpec::Watched(_) | SourceSpec::Recording(_)))
}

/// Draws the operator's view; `picture` draws the part once there is an inspection.
pub(super) fn ui(ui: &mut Ui, session: &Session, picture: impl FnOnce(&mut Ui)) {
    let theme = Theme::of(ui);
    let banner = Banner::of(session);
    let size = ui.available_size();
    let [_, back] = banner.tone.colours(theme);
    let is_low = usize::from(size.y <= 700.0);
    Panel::top("banner")
        .exact_size(BANNER[is_low])
        .resizable(false)
        .frame(
            Frame::new()
                .fill(back)
                .inner_margin(Margin::symmetric(36, 0)),
        )
        .show(ui, |ui| banner_ui(ui, &banner));
    Panel::right("next step")
        .exact_size(column_width(size.x))
        .resizable(false)
        .frame(
            Frame::new()
                .fill(theme.panel)
                .inner_margin(Margin::symmetric(24, COLUMN_MARGIN[is_low])),
        )
        .show(ui, |ui| column(ui, &banner, session));
    CentralPanel::default().frame(Frame::new()).show(ui, |ui| {
        let rect = ui.max_rect();
        if session.shown.is_none() {
            ui.painter().rect_filled(rect, 0.0, theme.canvas);
            return;
        }
        picture(ui);
        if !banner.is_current {
            let veil = theme.canvas.gamma_multiply(0.7);
            ui.painter().rect_filled(rect, 0.0, veil);
        }
    });
}

fn banner_ui(ui: &mut Ui, banner: &Banner) {
    let theme = Theme::of(ui);
    let [colour, _] = banner.tone.colours(theme);
    let height = ui.available_height();
    ui.horizontal_centered(|ui| {
        let radius = height * 0.33;
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(2.0 * radius), Sense::hover());
        mark(
            ui.painter(),
            rect.center(),
            radius,
            banner.tone.mark(),
            theme,
        );
        ui.add_space(32.0);
        let size = vec2(ui.available_width(), height);
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.vertical(|ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                ui.spacing_mut().interact_size.y = 0.0;
                let row_height = |font: &FontId| ui.ctx().fonts_mut(|fonts| fonts.row_height(font));
                // A long reason takes two lines, so the name gets a smaller font.
                let is_long = banner.tone.word().is_empty() && banner.reason.chars().count() > LONG;
                let (names, reason_font) = if is_long {
                    (&font::banner_names()[2..], font::far_list())
                } else {
                    (&font::banner_names()[..], font::banner_reason())
                };
                let name = fitting_font(ui, &banner.title, names, 1);
                let (line, word_line) = (row_height(&name), row_height(&font::banner_word()));
                ui.add_space(((height - line - word_line - 4.0) / 2.0).max(0.0));
                let title = RichText::new(&banner.title).font(name);
                ui.add(Label::new(title).truncate());
                ui.add_space(4.0);
                ui.horizontal(|ui| {
                    ui.set_min_height(word_line);
                    let word = banner.tone.word();
                    if !word.is_empty() {
                        ui.label(RichText::new(word).font(font::banner_word()).color(colour));
                        ui.add_space(space::MEDIUM);
                    }
                    wrapped(ui, &banner.reason, &reason_font, theme.text);
                });
            });
        });
    });
    let line = ui.max_rect().expand2(vec2(36.0, 0.0));
    ui.painter().rect_filled(
        line.with_min_y(line.bottom() - 3.0),
        0.0,
        match banner.tone {
            Tone::Ok | Tone::NotOk => colour,
            Tone::Open | Tone::Trouble => theme.edge,
        },
    );
}

/// Warns that robots are to be answered, but get no pose or no frames.
fn robots_without_answer(ui: &mut Ui, session: &Session) {
    if !session.answering.is_on {
        return;
    }
    let says = if session.robot.is_none() {
        text!("operator-robots-without-pose")
    } else if session.is_live() {
        return;
    } else if session.source.followed().is_some() {
        text!("operator-robots-without-frames")
    } else {
        text!("operator-robots-without-source")
    };
    warn(ui, &says, &font::far_reason());
}

fn warn(ui: &mut Ui, says: &str, font: &FontId) {
    let theme = Theme::of(ui);
    ui.add_space(space::SMALL);
    ui.horizontal_top(|ui| {
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(SIGN), Sense::hover());
        mark(ui.painter(), rect.center(), 10.0, Mark::Look, theme);
        wrapped(ui, says, font, theme.warning);
    });
}

/// Draws the next step and the caution in the largest type that fits into this height. If even the smallest does not, they can
/// be scrolled.
fn next_ui(ui: &mut Ui, banner: &Banner, room: f32) {
    let theme = Theme::of(ui);
    // Of the next step and of the caution.
    let types = [
        [font::next_step(), font::far_reason()],
        [font::far_reason(), font::far_reason()],
        [font::body_strong(), font::body_strong()],
    ];
    let width = ui.available_width();
    let height = |[next, caution]: &[FontId; 2]| {
        let rows = |text: &str, font: &FontId, width: f32| {
            let rows = wrapped_rows(ui.painter(), text, font, theme.text, width);
            rows.size().y
        };
        let below = if banner.caution.is_empty() {
            0.0
        } else {
            let width = width - SIGN - space::SMALL;
            2.0 * space::SMALL + rows(&banner.caution, caution, width).max(SIGN)
        };
        rows(&banner.next, next, width) + below
    };
    let is_long = banner.next.chars().count() > LONG;
    let smallest = types.len() - 1;
    let fitting = (usize::from(is_long)..smallest).find(|place| height(&types[*place]) <= room);
    let [next, caution] = &types[fitting.unwrap_or(smallest)];
    // A caution is worth more than the part before the last.
    let is_short = height(&types[smallest]) > room && !banner.caution.is_empty();
    let spare = if is_short {
        TWO_LINES[0] + TWO_LINES[1]
    } else {
        0.0
    };
    ScrollArea::vertical()
        .id_salt("next step")
        .max_height((room + spare).max(0.0))
        .auto_shrink([false, true])
        .show(ui, |ui| {
            wrapped(ui, &banner.next, next, theme.text);
            if !banner.caution.is_empty() {
                warn(ui, &banner.caution, caution);
            }
        });
}

/// Draws what to do next, and the last parts.
fn column(ui: &mut Ui, banner: &Banner, session: &Session) {
    let theme = Theme::of(ui);
    let shift = &session.shift;
    ui.spacing_mut().interact_size.y = 0.0;
    let heading = |ui: &mut Ui, text: String| {
        ui.weak(text);
    };
    // The scroll bars are beside the text, not over it.
    ui.spacing_mut().scroll = ScrollStyle::solid();
    heading(ui, text!("operator-next"));
    // What follows keeps its height, as it was last drawn.
    let id = Id::unique("below the next step");
    let below: f32 = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let room = ui.available_height() - below - LEAST_LIST;
    next_ui(ui, banner, room);
    let top = ui.cursor().top();
    ui.add_space(space::SMALL);
    current_trace::fields(ui, session);
    robots_without_answer(ui, session);
    ui.add_space(space::SMALL);
    heading(ui, text!("operator-last-parts"));
    ui.add_space(space::SMALL);
    let drawn = ui.cursor().top() - top;
    if (drawn - below).abs() > 0.5 {
        ui.data_mut(|data| data.insert_temp(id, drawn));
        ui.ctx()
            .request_discard("what is below the next step has another height");
    }
    if shift.last.is_empty() {
        let text = match shift.since {
            Some(_) => text!("operator-none-yet"),
            None => text!("operator-counting"),
        };
        ui.label(RichText::new(text).font(font::far_list()).weak());
        return;
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for row in &shift.last {
            let (sign, colour) = if row.is_ok() {
                (Mark::Good, theme.accepted)
            } else {
                (Mark::Bad, theme.rejected)
            };
            // The nearest part is only of interest to the engineer.
            let name = match row.verdict {
                StoredVerdict::Accepted => row.title.clone(),
                StoredVerdict::Rejected => recognised_part(row)
                    .map_or_else(|| text!("inspect-not-recognised"), str::to_owned),
                StoredVerdict::Unknown | StoredVerdict::NoPart => stored_verdict(row.verdict),
            };
            let at = row.at.to_zoned(jiff::tz::TimeZone::system());
            let at = at.strftime("%H:%M").to_string();
            // Beside the name there is no room for what a mirror image is of, nor for the 17 letters of a vehicle's number.
            let mirrored = row.mirror_of();
            let mirrored = mirrored.map(|part| text!("results-title-mirrored", part = part));
            let serial = Some(row.trace.serial.clone()).filter(|serial| !serial.is_empty());
            let is_wrong = row.is_wrongly_accepted();
            let wrong = is_wrong.then(|| text!("operator-reported-wrong"));
            let below = [
                (wrong, font::body()),
                (mirrored, font::body()),
                (serial, font::far_list()),
            ];
            let [name_line, line_below] = TWO_LINES;
            let line = ui.horizontal(|ui| {
                let is_alone = below.iter().all(|(text, _)| text.is_none());
                ui.set_min_height(if is_alone { LINE } else { name_line });
                line_mark(ui, 20.0, 9.0, sign);
                ui.add_space(space::SMALL);
                let from = ui.cursor().left();
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let at = RichText::new(at).font(font::far_list());
                    ui.label(at.weak());
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                        let name = RichText::new(name).font(font::far_list()).color(colour);
                        ui.add(Label::new(name).truncate());
                    });
                });
                from
            });
            let mut rect = line.response.rect;
            for (text, font) in below {
                let Some(text) = text else {
                    continue;
                };
                let drawn = ui.horizontal(|ui| {
                    ui.set_min_height(line_below);
                    ui.add_space(line.inner - ui.cursor().left());
                    let fitted = fitted_middle(ui.painter(), &text, &font, ui.available_width());
                    let is_cut = fitted != text;
                    let label = ui.label(RichText::new(fitted).font(font));
                    if is_cut {
                        label.on_hover_text(text);
                    }
                });
                rect = rect.union(drawn.response.rect);
            }
            ui.painter()
                .hline(rect.x_range(), rect.bottom(), theme.edge_stroke());
        }
    });
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use egui::{Galley, Pos2, RawInput, Rect, Shape};

    use super::*;
    use crate::{
        app::{
            inspection::{
                inspected::{LiveFrameContext, inspected_cell},
                source::CellChoice,
            },
            language::Language,
            shell::{live::LiveStatus, operator_bars::COLUMN, session::Shown},
            ui::theme::ThemeChoice,
            user_error::UserError,
        },
        pipeline::{
            Rejection,
            live::{LiveVerdict, MotionState},
        },
    };

    #[test]
    fn two_of_the_last_parts_stay_visible_below_a_long_advice() {
        let mut session = Session::default();
        session.shift.since = Some(jiff::Zoned::now());
        for serial in ["S-1", "S-2"] {
            let mut row = inspected_cell(CellChoice::InTurn, 1).entry.record.summary;
            row.trace.serial = serial.into();
            session.shift.last.push(row);
        }
        let next = "Die Sichtseite zur Kamera drehen\nDie nächste Datei wird automatisch geprüft\n\
            Soll es lackiert werden, den Einrichter bitten, es einzulernen";
        let banner = Banner {
            caution: "Es reicht bis an den Bildrand: So aufhängen, dass es ganz im Bild ist".into(),
            ..Banner::new(Tone::NotOk, "Unbekanntes Teil", "", next)
        };
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        Theme::install(ThemeChoice::default(), &ctx);
        // The column in a window of 1024 × 768.
        let size = vec2(COLUMN[1] - 48.0, 460.0);
        let mut visible = Vec::new();
        for _ in 0..3 {
            let input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
                ..RawInput::default()
            };
            let output = ctx.run_ui(input, |ui| column(ui, &banner, &session));
            let texts = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
                Shape::Text(text) => {
                    let is_whole = drawn.clip_rect.contains_rect(text.visual_bounding_rect());
                    is_whole.then(|| text.galley.text().to_owned())
                }
                _ => None,
            });
            visible = texts.collect();
            output.drop_without_applying_deltas();
        }
        for text in [next, "S-1", "S-2"] {
            assert!(visible.iter().any(|drawn| drawn == text), "{visible:?}");
        }
    }

    #[test]
    fn a_part_at_the_edge_another_model_and_a_file_are_said_and_only_what_is_certain() {
        let banner = |change: fn(&mut Inspected), is_past| {
            let mut inspected = inspected_cell(CellChoice::InTurn, 1);
            change(&mut inspected);
            Banner::of(&Session {
                shown: Some(Shown {
                    generation: 1,
                    inspected: Arc::new(inspected),
                    is_past,
                    session: None,
                    is_outdated: false,
                }),
                ..Session::default()
            })
        };
        let beside_shadow: fn(&mut Inspected) = |inspected| {
            if let Ok(part) = &mut inspected.inspection.segmentation.part {
                part.touches_edge = true;
            }
        };
        let cut: fn(&mut Inspected) = |inspected| {
            if let Some(Ok(pose)) = &mut inspected.inspection.pose
                && let Some(sight) = &mut pose.fit.sight
            {
                sight.outside = 0.1;
            }
            inspected.origin = camera();
        };
        let approximate: fn(&mut Inspected) = |inspected| {
            if let Verdict::Part { is_approximate, .. } = &mut inspected.inspection.verdict {
                *is_approximate = true;
            }
            inspected.origin = camera();
        };
        let refused: fn(&mut Inspected) = |inspected| {
            if let Ok(part) = &mut inspected.inspection.segmentation.part {
                part.touches_edge = true;
            }
            if let Verdict::Part { rejected, part, .. } = &mut inspected.inspection.verdict {
                *rejected = Some(Rejection::NotSteady { part: part.clone() });
            }
        };
        assert_eq!(banner(|_| (), false).caution, "");
        let inside = banner(beside_shadow, false);
        assert_eq!((inside.tone, &*inside.caution), (Tone::Ok, ""));
        let plain = banner(|inspected| inspected.origin = camera(), false);
        assert_eq!((&*plain.next, &*plain.caution), ("Start the robot", ""));
        for (change, caution) in [(cut, "Not all of it"), (approximate, "another model")] {
            let good = banner(change, false);
            assert_eq!(good.tone, Tone::Ok);
            assert!(good.caution.contains(caution), "{}", good.caution);
            assert_eq!(good.next, "Check the part, then start the robot");
        }
        let bad = banner(refused, false);
        assert_eq!(bad.tone, Tone::NotOk);
        assert!(bad.caution.contains("all of it"), "{}", bad.caution);
        assert_eq!(banner(cut, true).caution, "");
        let file: fn(&mut Inspected) = |inspected| {
            inspected.origin = Origin::File {
                path: "/data/door.png".into(),
                is_simulated: false,
            };
        };
        // It may show what hung there days ago.
        let next = banner(file, false).next;
        assert!(next.starts_with("From a file"), "{next}");
    }

    #[test]
    fn only_a_steady_part_is_shown_with_its_serial_number() {
        let reason = |choice, moves: bool| {
            let mut inspected = inspected_cell(choice, 1);
            inspected.entry.record.summary.trace.serial = "4711".into();
            inspected.followed = moves.then_some(LiveFrameContext {
                stillness: MotionState::Moving,
                standing: LiveVerdict::Open,
            });
            let session = Session {
                shown: Some(Shown {
                    generation: 1,
                    inspected: Arc::new(inspected),
                    is_past: false,
                    session: None,
                    is_outdated: false,
                }),
                ..Session::default()
            };
            Banner::of(&session).reason
        };
        assert!(reason(CellChoice::InTurn, false).contains("4711"));
        for (choice, moves) in [(CellChoice::InTurn, true), (CellChoice::Empty, false)] {
            let reason = reason(choice, moves);
            assert!(!reason.contains("4711"), "{reason}");
        }
    }

    #[test]
    fn a_lost_source_is_named_by_its_kind_in_the_language_of_the_window() {
        let lost = |source| {
            let mut session = Session {
                source,
                ..Session::default()
            };
            session.live.is_on = true;
            session.live.status = Some(LiveStatus {
                source: SourceState::Lost(UserError {
                    what: "the folder does not exist".into(),
                    advice: "Connect the drive".into(),
                }),
                stillness: None,
                standing: LiveVerdict::Open,
                rates: [None; 2],
                latency: None,
                num_inspected: 0,
                num_dropped: 0,
                num_averaged: 1,
                recorded: None,
            });
            Banner::of(&session)
        };
        let folder = Source::Camera(Box::new("watch:captures".parse().expect("a source")));
        Language::German.make_current();
        let banners = [lost(folder), lost(Source::default())];
        Language::English.make_current();
        let expected = [
            ("Ordner nicht erreichbar", "Netzlaufwerk"),
            ("Keine Kamera", "Stecker"),
        ];
        for (banner, (title, next)) in banners.iter().zip(expected) {
            assert_eq!(banner.title, title);
            assert!(banner.next.starts_with(next), "{banner:?}");
            assert!(banner.next.contains("Instandhaltung"), "{banner:?}");
            assert!(!banner.reason.contains("folder"), "{banner:?}");
        }
    }

    /// A frame of a camera that is not simulated.
    fn camera() -> Origin {
        Origin::Frame {
            name: "kinect frame 1".into(),
            is_simulated: false,
        }
    }

    const CHINESE: [&str; 2] = [
        include_str!("../../../../assets/language/zh/operator.ftl"),
        include_str!("../../../../assets/language/zh/results.ftl"),
    ];

    /// The texts in these message files, with every variable replaced by `variable`.
    fn texts(files: &[&str], variable: &str) -> Vec<String> {
        let lines = files.iter().flat_map(|file| file.lines());
        let texts = lines.filter_map(|line| line.split_once(" = "));
        let filled = texts.map(|(_, text)| {
            let mut pieces = text.split("{ $");
            let mut filled = pieces.next().unwrap_or_default().to_owned();
            for piece in pieces {
                filled.push_str(variable);
                filled.push_str(piece.split_once('}').map_or("", |(_, rest)| rest));
            }
            filled
        });
        filled.collect()
    }

    /// Counts rows that end with an opening mark or begin with a closing one.
    fn num_bad_rows(galley: &Galley) -> usize {
        let rows: Vec<String> = galley.rows.iter().map(|row| row.text()).collect();
        let pairs = rows.windows(2);
        let bad = pairs.filter(|pair| {
            pair[0].ends_with(|letter: char| "“‘（《".contains(letter))
                || pair[1].starts_with(|letter: char| "”’）》，。；：、".contains(letter))
        });
        bad.count()
    }

    #[test]
    fn chinese_breaks_neither_behind_an_opening_mark_nor_before_a_closing_one() {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let mut num_bad = 0;
        let output = ctx.run_ui(RawInput::default(), |ui| {
            let texts = ["左前车门", "Front door, left"].map(|variable| texts(&CHINESE, variable));
            assert!(texts[0].len() > 60, "{} messages", texts[0].len());
            let fonts = [font::next_step(), font::far_reason()];
            let widths = COLUMN.map(|width| width - 2.0 * 24.0);
            let others = (0..20_u8).map(|step| 200.0 + 10.0 * f32::from(step));
            for width in widths.into_iter().chain(others) {
                let texts = texts.iter().flatten();
                let pairs = texts.flat_map(|text| fonts.iter().map(move |font| (text, font)));
                for (text, font) in pairs {
                    let painter = ui.painter();
                    let colour = Color32::WHITE;
                    let plain = painter.layout(text.clone(), font.clone(), colour, width);
                    num_bad += num_bad_rows(&plain);
                    let rows = wrapped_rows(painter, text, font, colour, width);
                    assert_eq!(num_bad_rows(&rows), 0, "{width}: {:?}", rows.text());
                    assert_eq!(rows.text().replace('\n', ""), *text);
                    assert!(rows.size().x < width + 1.0, "{text}");
                }
            }
        });
        output.drop_without_applying_deltas();
        assert!(num_bad > 10, "egui breaks {num_bad} rows so by itself");
    }

    #[test]
    fn other_languages_break_as_egui_breaks_them() {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let output = ctx.run_ui(RawInput::default(), |ui| {
            // In German, “ is a closing mark.
            let german = include_str!("../../../../assets/language/de/operator.ftl");
            for text in texts(&[german], "Front door, left") {
                let (font, width) = (font::next_step(), COLUMN[1] - 2.0 * 24.0);
                let rows = wrapped_rows(ui.painter(), &text, &font, Color32::WHITE, width);
                assert_eq!(rows.text(), text);
            }
        });
        output.drop_without_applying_deltas();
    }
}
