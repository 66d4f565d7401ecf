//! The operator's view: which part, OK or not, and what to do next, legible across the shop.

use std::sync::Arc;

use egui::{
    Align, CentralPanel, Color32, FontId, Frame, Galley, Id, Label, Layout, Margin, Panel, Rect,
    RichText, Role, ScrollArea, Sense, Ui, Vec2, WidgetInfo, style::ScrollStyle, vec2,
};

use super::{
    banner::{Banner, Tone},
    frame_parts, hold,
};
use crate::workspaces::inspect::state::InspectAction;
use records::history::StoredVerdict;
use shell::{
    cell::operators_warning,
    session::{Session, past_mark},
    trace::{entry, expecting},
};
use ui::{
    language::{Language, described, text},
    theme::{Theme, font, space},
    widgets::{
        Mark, fitted_middle, line_mark, mark, side_panel, title_rows, wrapped, wrapped_rows,
    },
};

/// Height of the banner in a high and in a low window, logical pixels.
const BANNER: [f32; 2] = [190.0, 156.0];
/// Space between the name in the banner and the line below it, logical pixels.
const BELOW_NAME: f32 = 4.0;
/// Width of the column on the right in a wide and in a narrow window, logical pixels.
const COLUMN: [f32; 2] = [400.0, 320.0];
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

/// Draws the operator's view; `picture` draws the part once there is an inspection. Returns the place of the picture.
pub(super) fn ui(
    ui: &mut Ui,
    session: &Session,
    actions: &mut Vec<InspectAction>,
    picture: impl FnOnce(&mut Ui),
) -> Rect {
    let theme = Theme::of(ui);
    let banner = Banner::of(session);
    let size = ui.available_size();
    let [_, back] = banner.tone.colours(theme);
    hold::look_again(ui);
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
    let margin = Margin::symmetric(24, COLUMN_MARGIN[is_low]);
    side_panel(ui, "next step", COLUMN, margin, |ui| {
        column(ui, &banner, session, actions);
    });
    // The parts of an earlier frame no longer count.
    let shown = session.shown.as_ref().filter(|_| banner.is_current);
    if let Some(shown) = shown {
        frame_parts::operators_panel(ui, shown, session, actions);
    }
    let rect = ui.available_rect_before_wrap();
    CentralPanel::default().frame(Frame::new()).show(ui, |ui| {
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
    rect
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
                let word = banner.tone.word();
                // A long reason takes two lines, so the name gets a smaller font.
                let is_long = word.is_empty() && banner.reason.chars().count() > LONG;
                let (names, reason_font) = if is_long {
                    (&font::banner_names()[2..], font::far_list())
                } else {
                    (&font::banner_names()[..], font::banner_reason())
                };
                let (painter, width) = (ui.painter(), ui.available_width());
                let drawn = painter.layout_no_wrap(word.clone(), font::banner_word(), colour);
                let beside = if word.is_empty() {
                    0.0
                } else {
                    drawn.size().x + ui.spacing().item_spacing.x + space::MEDIUM
                };
                let reason = &banner.reason;
                let rows = wrapped_rows(painter, reason, &reason_font, theme.text, width - beside);
                // The title gets what the word and the reason leave.
                let word_font = font::banner_word();
                let word_line = ui.ctx().fonts_mut(|fonts| fonts.row_height(&word_font));
                let room = height - word_line.max(rows.size().y) - BELOW_NAME;
                let text = ui.visuals().text_color();
                let name = title_rows(painter, &banner.title, names, text, vec2(width, room));
                ui.add_space(((room - name.size().y) / 2.0).max(0.0));
                title_label(ui, &banner.title, name);
                ui.add_space(BELOW_NAME);
                ui.horizontal(|ui| {
                    ui.set_min_height(word_line);
                    if !word.is_empty() {
                        ui.label(RichText::new(word).font(font::banner_word()).color(colour));
                        ui.add_space(space::MEDIUM);
                    }
                    wrapped(ui, reason, &reason_font, theme.text);
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
            Tone::Recognised | Tone::Open | Tone::Problem => theme.edge,
        },
    );
}

/// Draws the rows of a title, of which the middle may be cut out; hovering shows all of it.
fn title_label(ui: &mut Ui, title: &str, rows: Arc<Galley>) {
    let is_cut = rows.text().replace('\n', "") != title;
    let label = ui.add(Label::new(rows));
    label.widget_info(|| WidgetInfo::labeled(Role::Label, ui.is_enabled(), title));
    if is_cut {
        label.on_hover_text(title);
    }
}

/// Warns that robots are to be answered, but get no pose or no frames: the line stands until somebody acts.
fn robots_without_answer(ui: &mut Ui, session: &Session) {
    if let Some(says) = operators_warning(session) {
        warn(ui, &says, &font::far_reason());
    }
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
    let fitting = (usize::from(is_long)..smallest).find(|index| height(&types[*index]) <= room);
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
fn column(ui: &mut Ui, banner: &Banner, session: &Session, actions: &mut Vec<InspectAction>) {
    let theme = Theme::of(ui);
    let shift = &session.shift;
    ui.spacing_mut().interact_size.y = 0.0;
    // The scroll bars are beside the text, not over it.
    ui.spacing_mut().scroll = ScrollStyle::solid();
    ui.weak(text!("operator-next"));
    // What follows keeps its height, as it was last drawn.
    let id = Id::unique("below the next step");
    let below: f32 = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let room = ui.available_height() - below - LEAST_LIST;
    next_ui(ui, banner, room);
    let top = ui.cursor().top();
    ui.add_space(space::SMALL);
    entry::fields(ui, session);
    let expects_any = session.expected().is_ok_and(|expected| expected.is_empty());
    // A caution and the last parts are worth more than a menu that is not in use.
    if !expects_any || banner.caution.is_empty() {
        let mut of_shell = Vec::new();
        expecting::ui(ui, session, &mut of_shell);
        actions.extend(of_shell.into_iter().map(InspectAction::Act));
    }
    robots_without_answer(ui, session);
    ui.add_space(space::SMALL);
    ui.weak(text!("operator-last-parts"));
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
            let sign = past_mark(row);
            // The nearest part is only of interest to the engineer.
            let found = row.identification();
            let mut named = found.heading(&row.title, Language::current());
            // Beside the sign there is no room for what a mirror image is of, nor for the 17 letters of a vehicle's number.
            let image_of = named.take_if(|_| !found.is_of_type());
            let name = named.unwrap_or_else(|| match row.verdict {
                StoredVerdict::Rejected => text!("inspect-not-recognised"),
                verdict => described(&verdict),
            });
            let at = row.at.to_zoned(jiff::tz::TimeZone::system());
            let at = at.strftime("%H:%M").to_string();
            let serial = Some(row.trace.serial.clone()).filter(|serial| !serial.is_empty());
            let is_wrong = row.is_wrongly_accepted();
            let wrong = is_wrong.then(|| text!("operator-reported-wrong"));
            let below: [(_, LineDrawer); 3] = [
                (
                    wrong.or_else(|| row.noted.past_doubts(Language::current())),
                    |ui, text| {
                        wrapped(ui, text, &font::body(), Theme::of(ui).text);
                    },
                ),
                (image_of, |ui, text| {
                    fitted_label(ui, text, font::body(), Theme::of(ui).text);
                }),
                (serial, |ui, text| {
                    fitted_label(ui, text, font::far_list(), Theme::of(ui).text);
                }),
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
                        fitted_label(ui, &name, font::far_list(), sign.colour(theme));
                    });
                });
                from
            });
            let mut rect = line.response.rect;
            for (text, draw) in below {
                let Some(text) = text else {
                    continue;
                };
                let drawn = ui.horizontal(|ui| {
                    ui.set_min_height(line_below);
                    ui.add_space(line.inner - ui.cursor().left());
                    draw(ui, &text);
                });
                rect = rect.union(drawn.response.rect);
            }
            ui.painter()
                .hline(rect.x_range(), rect.bottom(), theme.edge_stroke());
        }
    });
}

/// Draws a text below the name of one of the last parts.
type LineDrawer = fn(&mut Ui, &str);

/// A text whose middle is cut out if there is no room for it; hovering then shows all of it.
fn fitted_label(ui: &mut Ui, text: &str, font: FontId, colour: Color32) {
    let fitted = fitted_middle(ui.painter(), text, &font, ui.available_width());
    let is_cut = fitted != text;
    let label = ui.label(RichText::new(fitted).font(font).color(colour));
    if is_cut {
        label.on_hover_text(text);
    }
}

#[cfg(test)]
mod tests {
    use egui::{Pos2, RawInput, Rect, Shape};

    use super::*;
    use shell::inspection::{inspected::inspected_cell, source::CellChoice};
    use ui::theme::ThemeChoice;

    #[test]
    fn two_of_the_last_parts_stay_visible_with_the_ends_of_their_titles_below_a_long_advice() {
        let mut session = Session::default();
        session.shift.since = Some(geometry::clock::zoned_now());
        for serial in ["S-1", "S-2"] {
            let mut row = inspected_cell(CellChoice::InTurn, 1).entry.record.summary;
            row.trace.serial = serial.into();
            row.title = format!("Vordertür links mit Aussparung für die Zierleiste {serial}");
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
            let output = ctx.run_ui(input, |ui| column(ui, &banner, &session, &mut Vec::new()));
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
        // Titles that are alike up to their end are told apart.
        for end in ["leiste S-1", "leiste S-2"] {
            assert!(
                visible.iter().any(|drawn| drawn.ends_with(end)),
                "{visible:?}"
            );
        }
    }

    /// The column beside the picture, before any inspection.
    fn drawn_column(session: &Session) -> (egui::FullOutput, &'static Theme) {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        Theme::install(ThemeChoice::default(), &ctx);
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(COLUMN[1], 600.0))),
            ..RawInput::default()
        };
        let mut theme = None;
        let banner = Banner::new(Tone::Open, "", "", "");
        let output = ctx.run_ui(input, |ui| {
            theme = Some(Theme::of(ui));
            column(ui, &banner, session, &mut Vec::new());
        });
        (output, theme.expect("drawn"))
    }

    #[test]
    fn of_the_last_parts_one_that_no_robot_was_to_act_on_is_not_green() {
        let mut session = Session::default();
        session.shift.since = Some(geometry::clock::zoned_now());
        for doubts in [&[][..], &["moving".to_owned()]] {
            let mut row = inspected_cell(CellChoice::InTurn, 1).entry.record.summary;
            row.title = format!("Door with {} doubts", doubts.len());
            row.noted.robot_doubts = doubts.to_vec();
            session.shift.last.push(row);
        }
        let (output, theme) = drawn_column(&session);
        let colour_of = |words: &str| {
            let mut texts = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
                Shape::Text(text) if text.galley.text().starts_with(words) => {
                    Some(text.galley.job.sections[0].format.color)
                }
                _ => None,
            });
            texts.next_back()
        };
        assert_eq!(colour_of("Door with 0"), Some(theme.accepted));
        assert_eq!(colour_of("Door with 1"), Some(theme.warning));
        assert!(colour_of("Not for robots: the part was moving").is_some());
        output.drop_without_applying_deltas();
    }

    #[test]
    fn that_robots_get_no_pose_is_written_for_the_distance() {
        let mut session = Session::default();
        session.answering.is_on = true;
        let (output, _) = drawn_column(&session);
        let warning = operators_warning(&session).expect("no pose");
        let is_large = output.shapes.iter().any(|drawn| {
            matches!(&drawn.shape, Shape::Text(text) if text.galley.text() == warning
                && text.galley.job.sections[0].format.font_id == font::far_reason())
        });
        output.drop_without_applying_deltas();
        assert!(is_large, "{warning}");
    }

    /// The texts of a banner of this size and their numbers of rows. None may be cut off or overlap another.
    fn in_banner(banner: &Banner, size: Vec2) -> Vec<(String, usize)> {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        Theme::install(ThemeChoice::default(), &ctx);
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            ..RawInput::default()
        };
        let output = ctx.run_ui(input, |ui| banner_ui(ui, banner));
        let mut drawn: Vec<Rect> = Vec::new();
        let mut texts = Vec::new();
        for shape in &output.shapes {
            let Shape::Text(text) = &shape.shape else {
                continue;
            };
            let (rect, words) = (text.visual_bounding_rect(), text.galley.text());
            assert!(shape.clip_rect.contains_rect(rect), "{words}: {rect:?}");
            let is_free = drawn.iter().all(|other| !other.intersects(rect));
            assert!(is_free, "{words}: {rect:?} over {drawn:?}");
            drawn.push(rect);
            texts.push((words.to_owned(), text.galley.rows.len()));
        }
        output.drop_without_applying_deltas();
        texts
    }

    /// The sizes of the banner inside its margins, in windows of 1024 × 768 and 1440 × 900.
    const BANNERS: [Vec2; 2] = [
        vec2(1024.0 - 72.0, BANNER[1]),
        vec2(1440.0 - 72.0, BANNER[0]),
    ];

    #[test]
    fn a_long_title_takes_two_rows_of_the_banner_and_keeps_its_end() {
        let [with, without] = ["with", "without"].map(|word| {
            format!("Front door, left, {word} mirror hole and side impact sensor, model 2024")
        });
        for size in BANNERS {
            for title in [&with, &without] {
                let reason = format!("It does not match {title} well enough");
                let banner = Banner::new(Tone::NotOk, title, reason, "");
                let texts = in_banner(&banner, size);
                assert!(texts.contains(&(title.clone(), 2)), "{texts:?}");
            }
        }
    }

    #[test]
    fn of_a_title_that_is_too_wide_for_two_rows_the_middle_is_cut_out() {
        let title = format!("A{}Z", "W".repeat(78));
        let banner = Banner::new(Tone::Ok, title, "Recognised", "");
        let texts = in_banner(&banner, BANNERS[0]);
        let is_cut = texts.iter().any(|(text, num_rows)| {
            *num_rows == 2 && text.starts_with('A') && text.contains('…') && text.ends_with('Z')
        });
        assert!(is_cut, "{texts:?}");
    }

    const CHINESE: [&str; 4] = [
        include_str!("../../../../../assets/language/zh/inspect.ftl"),
        include_str!("../../../../../assets/language/zh/operator.ftl"),
        include_str!("../../../../../assets/language/zh/results.ftl"),
        include_str!("../../../../texts/language/zh/result.ftl"),
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
            let german = include_str!("../../../../../assets/language/de/operator.ftl");
            for text in texts(&[german], "Front door, left") {
                let (font, width) = (font::next_step(), COLUMN[1] - 2.0 * 24.0);
                let rows = wrapped_rows(ui.painter(), &text, &font, Color32::WHITE, width);
                assert_eq!(rows.text(), text);
            }
        });
        output.drop_without_applying_deltas();
    }
}
