//! The list of shots: what each contributes, how far its pose was corrected, and whether it is used; and the section about the scan
//! on the card of a workspace.

use std::sync::Arc;

use egui::{
    Align, Button, Checkbox, Color32, ColorImage, Frame, Label, Layout, Margin, Rect, RichText,
    ScrollArea, Sense, Stroke, StrokeKind, TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo,
    pos2, vec2,
};

use crate::shots::{
    overlay::percent,
    state::{ShotsAction, ShotsFile, ShotsState, StripTab},
};
use shell::{
    inspection::{
        scan::{FusedShots, ShotFate, ShotRow},
        source::ShotChoice,
    },
    language::UnitSystem,
    session::{Session, WorkspaceKind},
};
use ui::{
    language::{self, advised, attribute, described, library_text, text, what_and_advice},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Mark, focus_ring, grouped, heading, labelled, line_mark, row, sentence, shortened},
};

/// Width of a shot in the list, logical pixels.
const CARD_WIDTH_PX: f32 = 240.0;
/// Size of its picture, logical pixels.
const PICTURE: Vec2 = Vec2::new(80.0, 60.0);
/// Maximum number of letters of its name.
const LETTERS: usize = 22;

/// The scan in front, with the state that its workspace keeps for it.
#[derive(Clone, Copy)]
pub(crate) struct ShownShots<'a> {
    pub(crate) fused: &'a Arc<FusedShots>,
    /// The shots that the user wants to use.
    pub(crate) choice: &'a ShotChoice,
    pub(crate) shots: &'a ShotsState,
    pub(crate) session: &'a Session,
}

/// The list, with the textures of its pictures.
#[derive(Default)]
pub(crate) struct ShotList {
    made: Option<(Arc<FusedShots>, Vec<TextureHandle>)>,
}

impl ShotList {
    /// Height of the list with its row of tabs, logical pixels.
    pub(crate) const HEIGHT: f32 = 162.0;

    /// Draws the row above the strip, which switches the strip and changes the shots. True if the strip shows the list.
    pub(crate) fn tabs(
        ui: &mut Ui,
        scan: ShownShots<'_>,
        usual: &str,
        actions: &mut Vec<ShotsAction>,
    ) -> bool {
        let ShownShots {
            fused,
            shots,
            session,
            ..
        } = scan;
        let shown = shots.strip;
        let shots_title = text!("shots-shots");
        ui.horizontal(|ui| {
            ui.spacing_mut().button_padding.x = 9.0;
            for (tab, text) in [(StripTab::Shots, &*shots_title), (StripTab::Usual, usual)] {
                let is_shown = shown == tab;
                let button =
                    Button::selectable(is_shown, text).min_size(Vec2::splat(space::TARGET));
                if ui.add(button).clicked() {
                    actions.push(ShotsAction::Strip(tab));
                }
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let key = |text: &str| RichText::new(text).small();
                let add = text!("shots-add");
                if labelled(ui, Button::new(key(&add)), &add)
                    .on_hover_text(text!("shots-add-says"))
                    .clicked()
                {
                    actions.push(ShotsAction::Ask(ShotsFile::Shot));
                }
                // Enrol has its own buttons, for corrections and shots alike.
                if session.workspace != WorkspaceKind::Enrol {
                    for (text, label, can, action) in [
                        (
                            text!("shell-redo"),
                            text!("shots-redo-label"),
                            shots.can_redo(),
                            ShotsAction::Redo,
                        ),
                        (
                            text!("shell-undo"),
                            text!("shots-undo-label"),
                            shots.can_undo(),
                            ShotsAction::Undo,
                        ),
                    ] {
                        let button = Button::new(key(&text)).min_size(Vec2::splat(space::TARGET));
                        let response = ui.add_enabled(can, button);
                        response
                            .widget_info(|| WidgetInfo::labeled(egui::Role::Button, can, &label));
                        if response.clicked() {
                            actions.push(action);
                        }
                    }
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let text = RichText::new(caption(fused, session.units)).small();
                    ui.add(Label::new(text.weak()).truncate());
                });
            });
        });
        shown == StripTab::Shots
    }

    /// Draws the list of shots.
    pub(crate) fn ui(&mut self, ui: &mut Ui, scan: ShownShots<'_>, actions: &mut Vec<ShotsAction>) {
        self.make(ui.ctx(), scan.fused);
        let textures = self.made.as_ref().map_or(&[][..], |(_, textures)| textures);
        // Let a vertical wheel scroll it, too.
        ui.style_mut().always_scroll_the_only_direction = true;
        ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                let rows = scan.fused.rows.iter().zip(textures).enumerate();
                for (index, (row, texture)) in rows {
                    card(ui, index, row, texture, scan, actions);
                }
            });
        });
    }

    /// Uploads the pictures of another scan, once.
    fn make(&mut self, ctx: &egui::Context, fused: &Arc<FusedShots>) {
        let made = self.made.as_ref();
        if made.is_some_and(|(of, _)| Arc::ptr_eq(of, fused)) {
            return;
        }
        let texture = |row: &ShotRow| {
            let size = [row.picture.width() as usize, row.picture.height() as usize];
            let image = ColorImage::from_rgb(size, row.picture.as_raw());
            ctx.load_texture("shot", image, TextureOptions::LINEAR)
        };
        let textures = fused.rows.iter().map(texture).collect();
        self.made = Some((Arc::clone(fused), textures));
    }
}

/// Describes how many shots there are, and how well they agree.
fn caption(fused: &FusedShots, units: UnitSystem) -> String {
    let num = fused.rows.len();
    let used = match fused.num_used() {
        used if used == num => text!("shots-all-used", num = num),
        used => text!("shots-some-used", used = used, num = num),
    };
    match fused.scan.after.part.or(fused.scan.after.all) {
        Some(overlap) => text!(
            "shots-agree",
            used = used,
            rms = units.length(overlap.rms.0)
        ),
        None => used,
    }
}

fn card(
    ui: &mut Ui,
    index: usize,
    row: &ShotRow,
    texture: &TextureHandle,
    scan: ShownShots<'_>,
    actions: &mut Vec<ShotsAction>,
) {
    let is_taken = !scan.choice.dropped.contains(&index);
    Frame::new()
        .fill(Theme::of(ui).control)
        .corner_radius(ROUNDING)
        .inner_margin(Margin {
            left: 8,
            right: 8,
            top: 0,
            bottom: 6,
        })
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(8.0, 0.0);
            ui.vertical(|ui| {
                ui.set_width(CARD_WIDTH_PX - 16.0);
                let mut is_checked = is_taken;
                let text = format!("{} · {}", index + 1, shortened(&row.name, LETTERS));
                let text = RichText::new(text).font(font::body_strong());
                let response = ui.add(Checkbox::new(&mut is_checked, text));
                let label = text!("shots-use", name = &row.name);
                response.widget_info(|| {
                    WidgetInfo::selected(egui::Role::CheckBox, true, is_taken, label.clone())
                });
                if response.gained_focus() {
                    response.scroll_to_me(None);
                }
                let says = if is_taken {
                    text!("shots-drop-says")
                } else {
                    text!("shots-take-back-says")
                };
                if response.on_hover_text(says).clicked() {
                    actions.push(ShotsAction::Toggle(index));
                }
                ui.horizontal_top(|ui| {
                    picture(ui, index, is_taken, texture, scan, actions);
                    ui.vertical(|ui| words(ui, row, is_taken, scan.session.units));
                });
            });
        });
}

/// Draws the picture; a press marks in the view what only this shot sees.
fn picture(
    ui: &mut Ui,
    index: usize,
    is_taken: bool,
    texture: &TextureHandle,
    scan: ShownShots<'_>,
    actions: &mut Vec<ShotsAction>,
) {
    let theme = Theme::of(ui);
    let (rect, response) = ui.allocate_exact_size(PICTURE, Sense::click());
    let is_marked = scan.shots.looked_at == Some(index);
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let shade = if is_taken { 1.0 } else { 0.45 };
    let tint = Color32::WHITE.gamma_multiply(shade);
    ui.painter().rect_filled(rect, 0.0, theme.canvas);
    ui.painter().image(texture.id(), rect, whole, tint);
    if is_marked {
        let stroke = Stroke::new(2.0, theme.reference_series);
        ui.painter()
            .rect_stroke(rect, 0.0, stroke, StrokeKind::Inside);
    }
    focus_ring(ui, rect, &response);
    let label = text!("shots-mark", shot = index + 1);
    response
        .widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_marked, label.clone()));
    if response.on_hover_text(&label).clicked() {
        actions.push(ShotsAction::LookAt(index));
    }
}

/// Draws what the shot contributes, or why it does not.
fn words(ui: &mut Ui, row: &ShotRow, is_taken: bool, units: UnitSystem) {
    let theme = Theme::of(ui);
    ui.spacing_mut().interact_size.y = 0.0;
    ui.spacing_mut().item_spacing.y = 1.0;
    let small = |ui: &mut Ui, text: String, colour: Color32| {
        let text = RichText::new(text).small().color(colour);
        ui.add(Label::new(text).truncate())
    };
    let remark = |ui: &mut Ui, text: String, hint: &str| {
        ui.horizontal_top(|ui| {
            line_mark(ui, 14.0, 6.5, Mark::Look);
            let text = RichText::new(text).small().color(theme.warning);
            ui.add(Label::new(text).wrap()).on_hover_text(hint);
        });
    };
    match row.fate {
        ShotFate::Dropped => {
            small(ui, text!("shots-dropped"), theme.weak_text);
        }
        ShotFate::Excluded(why) => {
            let all = text!(
                "shots-left-out-says",
                why = sentence(&described(&why)),
                advice = advised(&why)
            );
            // The card of the workspace shows the details.
            let short = text!("shots-left-out", why = attribute(&why, "short"));
            remark(ui, short, &all);
        }
        ShotFate::Used {
            moved,
            rms,
            has_part,
        } => {
            let seen = text!("shots-seen", share = format!("{:.0}", row.seen * 100.0));
            let all = text!("shots-seen-says", num = grouped(row.num_points));
            small(ui, seen, theme.text).on_hover_text(all);
            if has_part {
                let alone = text!("shots-alone", share = percent(row.only));
                small(ui, alone, theme.weak_text);
            } else {
                let says = text!("shots-no-part-says");
                small(ui, library_text("no-part-in-frame"), theme.warning).on_hover_text(says);
            }
            let moved = text!(
                "shots-moved",
                shift = units.length(moved.shift.0),
                turn = units.angle(moved.rotation.0)
            );
            small(ui, moved, theme.weak_text);
            if let Some(rms) = rms {
                small(
                    ui,
                    text!("shots-rms", rms = units.length(rms.0)),
                    theme.weak_text,
                );
            }
        }
    }
    if !is_taken && row.fate != ShotFate::Dropped {
        small(ui, text!("shots-to-be-dropped"), theme.weak_text);
    }
}

/// Draws the section.
pub(crate) fn summary(ui: &mut Ui, fused: &FusedShots, units: UnitSystem) {
    heading(ui, &text!("shots-scan"));
    // Rows of text may be closer together than controls.
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 20.0;
        ui.spacing_mut().item_spacing.y = 3.0;
        figures(ui, fused, units);
    });
}

fn figures(ui: &mut Ui, fused: &FusedShots, units: UnitSystem) {
    let theme = Theme::of(ui);
    let num_all = fused.rows.len();
    row(
        ui,
        &text!("shots-used"),
        &text!("shots-num-used", used = fused.num_used(), num = num_all),
    );
    let moved = fused.rows.iter().filter_map(|row| match row.fate {
        ShotFate::Used { moved, .. } => Some([moved.shift.0, moved.rotation.0]),
        _ => None,
    });
    let [shift, turn] = moved.fold([0.0_f64; 2], |most, one| {
        [most[0].max(one[0]), most[1].max(one[1])]
    });
    let moved = format!("{} · {}", units.length(shift), units.angle(turn));
    row(ui, &text!("shots-refined-by"), &moved);
    if let Some(overlap) = fused.scan.after.part.or(fused.scan.after.all) {
        row(ui, &text!("shots-agree-to"), &units.length(overlap.rms.0));
    }
    let num_part = fused.scan.cloud.is_part.iter().filter(|is| **is).count();
    row(ui, &text!("shots-points"), &grouped(num_part));
    let open = format!("{:.0} %", fused.figure.open_share * 100.0);
    row(ui, &text!("shots-outline-open"), &open);
    let advised = |ui: &mut Ui, text: &str, advice: String| {
        ui.add_space(space::SMALL);
        ui.label(sentence(text));
        ui.label(
            RichText::new(advice)
                .font(font::body_strong())
                .color(theme.warning),
        );
    };
    for (index, shot) in fused.rows.iter().enumerate() {
        if let ShotFate::Excluded(why) = shot.fate {
            let text = text!(
                "shots-shot-left-out",
                shot = index + 1,
                why = described(&why)
            );
            advised(ui, &text, language::advised(&why));
        }
    }
    if let Some(found) = &fused.scan.doubt {
        let [what, advice] = what_and_advice(found);
        advised(ui, &sentence(&what), advice);
    }
}
