//! Small widgets and helpers that several panels use.

use std::sync::Arc;

use egui::{
    Align, Align2, Area, Button, Color32, ColorImage, ComboBox, Context, Event, FontId, Frame,
    Galley, Id, InnerResponse, IntoAtoms, Key, Label, Layout, Margin, Modal, ModalResponse,
    Painter, Panel, Pos2, Rect, Response, RichText, ScrollArea, Sense, Stroke, StrokeKind,
    TextEdit, TextStyle, TextWrapMode, TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, pos2,
    style::{ScrollStyle, StyleModifier},
    text::LayoutJob,
    vec2,
};
use image::RgbImage;

use super::{
    theme::{ROUNDING, Theme, font, space},
    user_error::UserError,
};

/// Width of the window, logical pixels, below which panels are narrow and bars have no room for keys.
pub const NARROW: f32 = 1100.0;
/// Height of a workspace, logical pixels, up to which its panels are low.
const LOW: f32 = 760.0;

/// Returns the width for a wide or for a narrow window.
pub fn by_width(window: f32, [wide, narrow]: [f32; 2]) -> f32 {
    if window > NARROW { wide } else { narrow }
}

/// Returns the height for a high or for a low workspace.
pub fn by_height(workspace: f32, [high, low]: [f32; 2]) -> f32 {
    if workspace > LOW { high } else { low }
}

/// Draws a panel that cannot be resized at an edge of a workspace.
pub fn fixed_panel<R>(
    ui: &mut Ui,
    panel: Panel,
    margin: Margin,
    add: impl FnOnce(&mut Ui) -> R,
) -> R {
    let frame = Frame::new().fill(Theme::of(ui).panel).inner_margin(margin);
    panel.resizable(false).frame(frame).show(ui, add).inner
}

/// Draws the panel on the right of a workspace, before its other panels, with its width for a wide or for a narrow window.
pub fn side_panel<R>(
    ui: &mut Ui,
    id: &'static str,
    widths: [f32; 2],
    margin: Margin,
    add: impl FnOnce(&mut Ui) -> R,
) -> R {
    let width = by_width(ui.available_width(), widths);
    fixed_panel(ui, Panel::right(id).exact_size(width), margin, add)
}

/// The sign of a mark, which repeats what its colour means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A tick.
    Good,
    /// A tick without its colour: recognised, but a robot must not act on it.
    Known,
    /// A cross.
    Bad,
    /// An exclamation mark.
    Look,
    /// Three dots: not known yet.
    Open,
    /// A plain dot: something runs, and nothing is said about a part.
    Runs,
}

impl Mark {
    /// Returns the colour of the disc, and of words with the same meaning.
    pub fn colour(self, theme: &Theme) -> Color32 {
        match self {
            Self::Good => theme.accepted,
            Self::Bad => theme.rejected,
            Self::Look => theme.warning,
            Self::Known | Self::Open | Self::Runs => theme.weak_text,
        }
    }
}

/// Draws a filled disc with a sign in it.
pub fn mark(painter: &Painter, centre: Pos2, radius: f32, mark: Mark, theme: &Theme) {
    painter.circle_filled(centre, radius, mark.colour(theme));
    let at = |x: f32, y: f32| centre + vec2(x, y) * radius;
    let stroke = Stroke::new(radius * 0.24, theme.panel);
    match mark {
        Mark::Good | Mark::Known => {
            painter.line(
                vec![at(-0.45, 0.02), at(-0.12, 0.36), at(0.46, -0.34)],
                stroke,
            );
        }
        Mark::Bad => {
            painter.line_segment([at(-0.36, -0.36), at(0.36, 0.36)], stroke);
            painter.line_segment([at(-0.36, 0.36), at(0.36, -0.36)], stroke);
        }
        Mark::Look => {
            painter.line_segment([at(0.0, -0.52), at(0.0, 0.14)], stroke);
            painter.circle_filled(at(0.0, 0.44), radius * 0.14, theme.panel);
        }
        Mark::Open => {
            for x in [-0.42, 0.0, 0.42] {
                painter.circle_filled(at(x, 0.0), radius * 0.13, theme.panel);
            }
        }
        Mark::Runs => {}
    }
}

/// Draws a mark of this radius in a line of text, in a square with this side.
pub fn line_mark(ui: &mut Ui, side: f32, radius: f32, sign: Mark) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(side), Sense::hover());
    mark(ui.painter(), rect.center(), radius, sign, Theme::of(ui));
    response
}

/// Returns the width of a text in one line.
pub fn text_width(painter: &Painter, text: &str, font: &FontId) -> f32 {
    let galley = painter.layout_no_wrap(text.to_owned(), font.clone(), Color32::PLACEHOLDER);
    galley.size().x
}

/// Draws a name on the left and its value on the right, or below it if there is no room for both.
pub fn row(ui: &mut Ui, name: &str, value: &str) {
    let font = TextStyle::Body.resolve(ui.style());
    let width = |text: &str| text_width(ui.painter(), text, &font);
    let needed = width(name) + ui.spacing().item_spacing.x + width(value);
    if needed > ui.available_width() {
        ui.weak(name);
        ui.with_layout(Layout::top_down(Align::Max), |ui| ui.label(value));
        return;
    }
    ui.horizontal(|ui| {
        // Nothing here can be pressed, so rows need no minimum height.
        ui.spacing_mut().interact_size.y = 0.0;
        ui.weak(name);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(value);
        });
    });
}

/// Draws a name on the left and a path on the right, shortened to the room; hovering shows all of it.
pub fn path_row(ui: &mut Ui, name: &str, path: &str) {
    ui.horizontal(|ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        ui.weak(name);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let font = TextStyle::Body.resolve(ui.style());
            let shown = fitted_path(ui.painter(), path, &font, ui.available_width());
            let label = ui.add(Label::new(shown).truncate());
            label.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, path));
            label.on_hover_text(path);
        });
    });
}

/// Leaves out the first folders of a path that is wider than the room: the name of the file is at its end. Keeps what stands
/// before the path, up to the last dot between words.
pub fn fitted_path(painter: &Painter, text: &str, font: &FontId, room: f32) -> String {
    let begin = text.rfind(" · ").map_or(0, |at| at + " · ".len());
    let (before, mut path) = text.split_at(begin);
    let mut shown = text.to_owned();
    while text_width(painter, &shown, font) > room {
        let Some((_, rest)) = path.split_once(['/', '\\']) else {
            break;
        };
        path = rest;
        shown = format!("{before}…/{path}");
    }
    shown
}

/// Draws the heading of a group.
pub fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(space::MEDIUM);
    ui.label(RichText::new(text).font(font::heading()).weak());
}

/// Capitalises the first letter, unless the text begins with the name of a file or of a parameter.
pub fn sentence(text: &str) -> String {
    let first = text.split_whitespace().next().unwrap_or_default();
    let is_word = |c: char| c.is_alphabetic() || matches!(c, '\'' | '’' | '-' | ',' | ':');
    if !first.chars().all(is_word) {
        return text.to_owned();
    }
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().collect::<String>() + letters.as_str()
    })
}

/// Returns the largest rectangle with this aspect ratio (width over height), centred in another.
pub fn fitted(outer: Rect, aspect: f32) -> Rect {
    let width = outer.width().min(outer.height() * aspect);
    Rect::from_center_size(outer.center(), vec2(width, width / aspect.max(1e-3)))
}

/// A linear map from a range of values to screen coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    from: [f32; 2],
    to: [f32; 2],
}

impl Scale {
    pub fn new(from: [f32; 2], to: [f32; 2]) -> Self {
        Self { from, to }
    }

    pub fn at(&self, value: f32) -> f32 {
        let range = self.from[1] - self.from[0];
        let share = if range.abs() < 1e-12 {
            0.5
        } else {
            (value - self.from[0]) / range
        };
        self.to[0] + share * (self.to[1] - self.to[0])
    }
}

/// Returns a map from plane coordinates (y up) to the screen that fits `bounds` centred into `rect`.
pub fn plane_in(rect: Rect, [low, high]: [[f32; 2]; 2]) -> impl Fn(&[f32; 2]) -> Pos2 {
    let (wide, tall) = ((high[0] - low[0]).max(1e-3), (high[1] - low[1]).max(1e-3));
    let place = fitted(rect, wide / tall);
    let across = Scale::new([low[0], high[0]], [place.left(), place.right()]);
    let up = Scale::new([low[1], high[1]], [place.bottom(), place.top()]);
    move |p| pos2(across.at(p[0]), up.at(p[1]))
}

/// Outlines a hand-drawn control that has the focus.
pub fn focus_ring(ui: &Ui, rect: Rect, response: &egui::Response) {
    let theme = Theme::of(ui);
    if response.has_focus() {
        let stroke = Stroke::new(2.0, theme.accent);
        ui.painter()
            .rect_stroke(rect.shrink(1.0), ROUNDING, stroke, StrokeKind::Inside);
    }
}

/// Draws a button.
pub fn text_button(ui: &mut Ui, text: &str) -> egui::Response {
    labelled(ui, Button::new(text), text)
}

/// Draws a button that can only be pressed if `can`. In a wrapped row it moves to the next line before its text breaks.
pub fn button_if(ui: &mut Ui, can: bool, text: &str) -> egui::Response {
    let button = Button::new(text).wrap_mode(TextWrapMode::Extend);
    let response = ui.add_enabled(can, button.min_size(Vec2::splat(space::TARGET)));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, can, text));
    response
}

/// Draws a button that chooses one of several values.
pub fn value_button<T: PartialEq>(ui: &mut Ui, value: &mut T, this: T, text: String) {
    let is_chosen = *value == this;
    let button = Button::selectable(is_chosen, text)
        .frame_when_inactive(true)
        .min_size(vec2(space::TARGET, space::TARGET));
    if ui.add(button).clicked() {
        *value = this;
    }
}

/// Draws an error or a doubt, with a sign before it and the advice below.
pub fn error_row(ui: &mut Ui, sign: Mark, error: &UserError) {
    ui.horizontal_top(|ui| {
        line_mark(ui, 18.0, 7.0, sign);
        ui.vertical(|ui| {
            ui.label(sentence(&error.what));
            ui.weak(&error.advice);
        });
    });
}

/// Draws a button whose accessible name is `label` alone, whatever shortcut it shows.
pub fn labelled(ui: &mut Ui, button: Button<'_>, label: &str) -> egui::Response {
    let response = ui.add(button.min_size(Vec2::splat(space::TARGET)));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, label));
    response
}

/// A text field of one line, as high as a button.
pub fn line_edit(text: &mut String, hint: String, width: f32) -> TextEdit<'_> {
    TextEdit::singleline(text)
        .hint_text(hint)
        .align(Align2::LEFT_CENTER)
        .desired_width(width)
        .min_size(vec2(0.0, space::TARGET))
}

/// Returns the width of a button with this text.
pub fn button_width(ui: &Ui, text: &str) -> f32 {
    let font = TextStyle::Button.resolve(ui.style());
    text_width(ui.painter(), text, &font) + 2.0 * ui.spacing().button_padding.x
}

/// Opening brackets and quotation marks of Chinese, which may not end a row.
const OPENING: [char; 8] = ['“', '‘', '（', '《', '〈', '「', '『', '【'];

/// Draws a text wrapped so that no row ends with an opening bracket or quotation mark.
///
/// epaint 0.37 breaks a row before any Chinese character, even after such a mark and whatever joiner stands between them: it
/// only knows which characters may not begin a row.
pub fn wrapped(ui: &mut Ui, text: &str, font: &FontId, colour: Color32) -> Response {
    let rows = wrapped_rows(ui.painter(), text, font, colour, ui.available_width());
    let label = ui.add(Label::new(rows));
    // The inserted line breaks are not part of the name.
    label.widget_info(|| WidgetInfo::labeled(egui::Role::Label, ui.is_enabled(), text));
    label
}

/// Draws a status in one line or, if it is too wide for that, in two small ones.
pub fn status_label(ui: &mut Ui, text: &str, font: FontId, colour: Color32) {
    let (room, painter) = (ui.available_width(), ui.painter());
    let mut rows = painter.layout_no_wrap(text.to_owned(), font, colour);
    if rows.size().x > room {
        let mut job = LayoutJob::simple(text.to_owned(), font::small(), colour, room);
        job.wrap.max_rows = 2;
        rows = painter.layout_job(job);
    }
    ui.add(Label::new(rows));
}

/// Lays out the rows of such a text.
pub fn wrapped_rows(
    painter: &Painter,
    text: &str,
    font: &FontId,
    colour: Color32,
    width: f32,
) -> Arc<Galley> {
    let mut broken = text.to_owned();
    loop {
        let rows = painter.layout(broken.clone(), font.clone(), colour, width);
        match marks_at_end(&rows) {
            Some(offset) => broken.insert(offset, '\n'),
            None => return rows,
        }
    }
}

/// Returns the byte offset of the first opening marks that end a row although the text goes on. Skips rows of nothing but
/// marks.
fn marks_at_end(rows: &Galley) -> Option<usize> {
    let letters: Vec<(usize, char)> = rows.text().char_indices().collect();
    let mut begin = 0;
    for row in &rows.rows {
        // Every character has a glyph.
        let end = begin + row.glyphs.len();
        let in_row = letters.get(begin..end)?;
        let is_mark = |(_, letter): &&(usize, char)| OPENING.contains(letter);
        let num_marks = in_row.iter().rev().take_while(is_mark).count();
        let is_broken = !row.ends_with_newline && end < letters.len();
        if is_broken && 0 < num_marks && num_marks < in_row.len() {
            let (offset, _) = in_row.get(in_row.len() - num_marks)?;
            return Some(*offset);
        }
        begin = end + usize::from(row.ends_with_newline);
    }
    None
}

/// Cuts the middle out of a text longer than `most` characters.
pub fn shortened(text: &str, most: usize) -> String {
    let letters: Vec<char> = text.chars().collect();
    if letters.len() <= most {
        return text.to_owned();
    }
    let half = most / 2;
    let (head, tail) = (&letters[..half], &letters[letters.len() - half..]);
    format!(
        "{}…{}",
        head.iter().collect::<String>(),
        tail.iter().collect::<String>()
    )
}

/// Cuts the middle out of a text wider than this room: serial numbers differ at their end.
pub fn fitted_middle(painter: &Painter, text: &str, font: &FontId, room: f32) -> String {
    let fits = |most: &usize| text_width(painter, &shortened(text, *most), font) <= room;
    let lengths: Vec<usize> = (2..=text.chars().count()).collect();
    if lengths.last().is_none_or(fits) {
        return text.to_owned();
    }
    // Halved every time: lists do this for every row of every frame.
    match lengths.partition_point(fits).checked_sub(1) {
        Some(longest) => shortened(text, lengths[longest]),
        None => text.to_owned(),
    }
}

/// Lays out a title in the first of these fonts in which it takes one row, or two for which there is room, without a broken word.
/// Cuts the middle out of what does not fit even in the last font: titles differ at their end.
pub fn title_rows(
    painter: &Painter,
    title: &str,
    fonts: &[FontId],
    colour: Color32,
    room: Vec2,
) -> Arc<Galley> {
    let laid_out = |text: &str, font: &FontId| wrapped_rows(painter, text, font, colour, room.x);
    let fits = |rows: &Arc<Galley>| match rows.rows.len() {
        0 | 1 => true,
        2 => rows.size().y <= room.y,
        _ => false,
    };
    let keeps_words = |font: &FontId| {
        let mut words = title.split_whitespace();
        words.all(|word| text_width(painter, word, font) <= room.x)
    };
    let whole = fonts.iter().filter(|font| keeps_words(font));
    let mut whole = whole.map(|font| laid_out(title, font));
    if let Some(rows) = whole.find(fits) {
        return rows;
    }
    let smallest = fonts.last().cloned().unwrap_or_else(font::title);
    let lengths = (2..=title.chars().count()).rev();
    let mut cut = lengths.map(|most| laid_out(&shortened(title, most), &smallest));
    cut.find(fits).unwrap_or_else(|| laid_out(title, &smallest))
}

/// Style of a scroll bar that stays in sight, beside the entries of a menu.
fn bar_of_menu() -> ScrollStyle {
    ScrollStyle {
        foreground_color: true,
        floating_width: 4.0,
        dormant_handle_opacity: 0.5,
        active_handle_opacity: 0.6,
        ..ScrollStyle::thin()
    }
}

/// Shows the scroll bar of a menu even without the pointer: it is the only sign of further entries.
pub fn show_scroll_bar(ui: &mut Ui) {
    ui.spacing_mut().scroll = bar_of_menu();
}

/// Draws a button that opens a menu; within a menu, an entry that opens one beside it.
pub fn menu_button<'a, R>(
    ui: &mut Ui,
    title: impl IntoAtoms<'a>,
    entries: impl FnOnce(&mut Ui) -> R,
) -> InnerResponse<Option<R>> {
    ui.menu_button(title, |ui| {
        pad_entries(ui);
        entries(ui)
    })
}

/// Gives the entries of a menu room around their text: egui leaves them none.
pub fn pad_entries(ui: &mut Ui) {
    ui.spacing_mut().button_padding = vec2(space::MEDIUM, space::SMALL);
}

/// Draws the entries of a menu, which scroll if there are many.
pub fn menu_list(ui: &mut Ui, entries: impl FnOnce(&mut Ui)) {
    show_scroll_bar(ui);
    ScrollArea::vertical().max_height(420.0).show(ui, entries);
}

/// Draws a list that drops down below a button with the chosen entry. `label` is its accessible name.
pub fn drop_down(
    ui: &mut Ui,
    label: &str,
    chosen: &str,
    width: f32,
    entries: impl FnOnce(&mut Ui),
) -> Response {
    let shown = ComboBox::from_id_salt("drop-down")
        .selected_text(chosen.to_owned())
        .width(width)
        .popup_style(StyleModifier::new(|style| {
            style.spacing.scroll = bar_of_menu();
        }))
        .show_ui(ui, |ui| {
            // A click within one frame brings the dialog it is in to the front, over the list that it opens.
            ui.ctx().move_to_top(ui.layer_id());
            entries(ui);
        });
    let response = shown.response;
    response.widget_info(|| WidgetInfo::labeled(egui::Role::ComboBox, true, label));
    response
}

/// Shows a modal dialog in the middle of the window.
pub fn dialog<R>(
    ctx: &Context,
    name: &str,
    content: impl FnOnce(&mut Ui) -> R,
) -> ModalResponse<R> {
    let id = Id::unique(name);
    dialog_in(ctx, id, Modal::default_area(id), content)
}

/// Shows a modal dialog whose upper edge stays, however high its pages are.
pub fn dialog_below<R>(
    ctx: &Context,
    name: &str,
    top: f32,
    content: impl FnOnce(&mut Ui) -> R,
) -> ModalResponse<R> {
    let id = Id::unique(name);
    let area = Modal::default_area(id).anchor(Align2::CENTER_TOP, vec2(0.0, top));
    dialog_in(ctx, id, area, content)
}

fn dialog_in<R>(
    ctx: &Context,
    id: Id,
    area: Area,
    content: impl FnOnce(&mut Ui) -> R,
) -> ModalResponse<R> {
    let modal = Modal::new(id)
        .area(area)
        .frame(Frame::window(&ctx.global_style()).inner_margin(Margin::same(18)))
        .show(ctx, content);
    let size = modal.response.rect.size();
    let before = ctx.data_mut(|data| {
        let before = data.get_temp::<Vec2>(id);
        data.insert_temp(id, size);
        before
    });
    // egui positions and clips a dialog by its size in the previous frame.
    if before.is_some_and(|before| before != size) {
        ctx.request_discard("a dialog has another size");
    }
    modal
}

/// Draws the button that Enter presses in a dialog while no control has the focus. Ignores the Enter that ends text input or
/// that opened the dialog.
pub fn default_button(ui: &mut Ui, label: &str, can: bool) -> bool {
    let theme = Theme::of(ui);
    let button = Button::new(RichText::new(label).color(theme.on_accent)).fill(theme.accent);
    let is_clicked = ui
        .add_enabled_ui(can, |ui| labelled(ui, button, label).clicked())
        .inner;
    let id = Id::unique(("default button", label));
    let frame: u64 = ui.ctx().cumulative_frame_nr();
    let has_focus = ui.memory(|memory| memory.focused().is_some());
    // Use the focus of the previous frame: a single-line text field loses it in the same frame in which Enter is pressed.
    let was_free = ui.data_mut(|data| {
        let (of, was_free, is_free) = data.get_temp(id).unwrap_or((0, false, false));
        let was_free = match frame.saturating_sub(of) {
            // Drawn again in the same frame, because a size changed.
            0 => was_free,
            1 => is_free,
            _ => false,
        };
        data.insert_temp::<(u64, bool, bool)>(id, (frame, was_free, !has_focus));
        was_free
    });
    let is_enter = |event: &Event| {
        matches!(
            event,
            Event::Key {
                key: Key::Enter,
                pressed: true,
                repeat: false,
                ..
            }
        )
    };
    let is_entered = was_free && !has_focus && ui.input(|input| input.events.iter().any(is_enter));
    is_clicked || can && is_entered
}

/// Uploads a picture.
pub fn texture(ctx: &egui::Context, name: &str, image: Option<&RgbImage>) -> Option<TextureHandle> {
    let image = image?;
    let size = [image.width() as usize, image.height() as usize];
    let options = TextureOptions {
        mipmap_mode: Some(egui::TextureFilter::Linear),
        ..TextureOptions::LINEAR
    };
    Some(ctx.load_texture(name, ColorImage::from_rgb(size, image.as_raw()), options))
}

/// Formats a whole number in groups of three digits.
pub fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use egui::{Color32, Context, FontId, RawInput, ScrollArea, Shape};

    use super::{
        fitted_middle, fitted_path, grouped, row, sentence, shortened, show_scroll_bar, text_width,
    };
    use crate::theme::Theme;

    #[test]
    fn a_long_path_keeps_the_name_of_its_file() {
        let ctx = Context::default();
        Theme::install_fonts(&ctx);
        let font = FontId::proportional(14.0);
        let output = ctx.run_ui(RawInput::default(), |ui| {
            let fitted = |text: &str, room| fitted_path(ui.painter(), text, &font, room);
            let path = "/data/2026-11-25/cell_3/booth/door.png";
            assert_eq!(fitted(path, 1000.0), path);
            let short = "…/booth/door.png".to_owned();
            let painter = ui.painter();
            let galley = painter.layout_no_wrap(short.clone(), font.clone(), Color32::PLACEHOLDER);
            assert_eq!(fitted(path, galley.size().x), short);
            assert_eq!(fitted(path, 1.0), "…/door.png");
            let with_remark = format!("bent · {path}");
            assert_eq!(fitted(&with_remark, 1.0), "bent · …/door.png");
            assert_eq!(fitted("Kinect frame 12", 1.0), "Kinect frame 12");
        });
        output.drop_without_applying_deltas();
    }

    #[test]
    fn a_value_without_room_beside_its_name_is_below_it() {
        let tops = |room: f32| {
            let ctx = Context::default();
            Theme::install_fonts(&ctx);
            let output = ctx.run_ui(RawInput::default(), |ui| {
                ui.set_max_width(room);
                row(ui, "17 iteraciones", "límite de iteraciones · ICP");
            });
            let texts = output.shapes.iter().filter_map(|shape| match &shape.shape {
                Shape::Text(text) => Some(text.visual_bounding_rect()),
                _ => None,
            });
            let texts: Vec<_> = texts.collect();
            output.drop_without_applying_deltas();
            assert_eq!(texts.len(), 2);
            assert!(!texts[0].intersects(texts[1]), "{texts:?}");
            texts[1].top() > texts[0].bottom()
        };
        assert!(!tops(400.0));
        assert!(tops(200.0));
    }

    #[test]
    fn a_sentence_begins_with_a_capital_letter_and_a_file_keeps_its_name() {
        assert_eq!(sentence("there is a recipe"), "There is a recipe");
        assert_eq!(
            sentence("unknown: nothing is like it"),
            "Unknown: nothing is like it"
        );
        assert_eq!(sentence("door.pcd: a mesh"), "door.pcd: a mesh");
        assert_eq!(sentence(""), "");
    }

    #[test]
    fn a_menu_shows_that_it_scrolls_only_where_it_does() {
        let num_bars = |num_entries: usize| {
            let ctx = Context::default();
            Theme::install_fonts(&ctx);
            let mut output = ctx.run_ui(RawInput::default(), |_| {});
            // The size of the entries is known from the second frame on.
            for _ in 0..2 {
                output.drop_without_applying_deltas();
                output = ctx.run_ui(RawInput::default(), |ui| {
                    show_scroll_bar(ui);
                    ScrollArea::vertical().max_height(100.0).show(ui, |ui| {
                        for entry in 0..num_entries {
                            ui.label(entry.to_string());
                        }
                    });
                });
            }
            let is_bar = |shape: &Shape| match shape {
                Shape::Rect(bar) => bar.fill.a() > 0 && bar.rect.width() < 5.0,
                _ => false,
            };
            let bars = output.shapes.iter().filter(|shape| is_bar(&shape.shape));
            let num = bars.count();
            output.drop_without_applying_deltas();
            num
        };
        assert_eq!(num_bars(3), 0);
        // The handle, and what it moves along.
        assert_eq!(num_bars(30), 2);
    }

    #[test]
    fn of_a_long_title_as_much_as_fits_is_kept_at_both_ends() {
        let ctx = Context::default();
        Theme::install_fonts(&ctx);
        let font = FontId::proportional(20.0);
        let output = ctx.run_ui(RawInput::default(), |ui| {
            let painter = ui.painter();
            let title = "Vordertür links mit Zierleiste, Ausf. B";
            let num = title.chars().count();
            for step in 0..60_u8 {
                let room = 10.0 * f32::from(step);
                let fits = |text: &String| text_width(painter, text, &font) <= room;
                let longest = (2..=num)
                    .rev()
                    .map(|most| shortened(title, most))
                    .find(fits);
                let expected = longest.unwrap_or_else(|| title.to_owned());
                assert_eq!(fitted_middle(painter, title, &font, room), expected);
            }
            for short in ["", "B"] {
                assert_eq!(fitted_middle(painter, short, &font, 0.0), short);
            }
        });
        output.drop_without_applying_deltas();
    }

    #[test]
    fn long_numbers_are_grouped() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(301_812), "301\u{202f}812");
        assert_eq!(grouped(1_000_000), "1\u{202f}000\u{202f}000");
    }
}
