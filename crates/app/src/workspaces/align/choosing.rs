//! Above the views: what is aligned to what, the start, and Run.

use egui::{
    Align, Align2, Button, DragValue, Label, Layout, Response, RichText, Role, TextEdit, TextStyle,
    Ui, Vec2, WidgetInfo, vec2,
};

use super::{
    start::Start,
    state::{AlignState, Pairing},
};
use crate::workspaces::align::state::{AlignAction, AlignFile};
use shell::{inspection::source::file_name, session::Session};
use ui::{
    language::text,
    theme::{Theme, font, space},
    viewport::ViewDirection,
    widgets::{
        button_width, fitted_middle, labelled, menu_button, menu_list, shortened, text_button,
    },
};

/// Longest file name shown, characters.
const NAME: usize = 22;

/// Height of a remark on a custom start, logical pixels.
const REMARK_HEIGHT_PX: f32 = 18.0;

/// Height of this panel's contents, logical pixels.
pub(super) fn height(align: &AlignState) -> f32 {
    let rows = 2.0 * space::TARGET + space::SMALL;
    if align.pairing != Pairing::MovedCopy || !align.custom.is_open {
        return rows;
    }
    let num_remarks = align.custom.remarks.len().max(1) as f32;
    rows + space::SMALL + space::TARGET + num_remarks * (space::SMALL + REMARK_HEIGHT_PX)
}

/// Draws the panel; returns the view direction if one was chosen.
pub(super) fn ui(
    ui: &mut Ui,
    align: &AlignState,
    session: &Session,
    actions: &mut Vec<AlignAction>,
) -> Option<ViewDirection> {
    let mut look = None;
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            run(ui, align, session, actions);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                for pairing in Pairing::ALL {
                    let is_chosen = align.pairing == pairing;
                    if choice(ui, is_chosen, &pairing.title()).clicked() {
                        actions.push(AlignAction::Choose(pairing));
                    }
                }
                if align.pairing != Pairing::Files {
                    ui.add_space(space::SMALL);
                    part_menu(ui, align, session, actions);
                }
            });
        });
    });
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            look = look_menu(ui);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                match align.pairing {
                    Pairing::MovedCopy => starts(ui, align, actions),
                    Pairing::Scene => scene(ui, align, session),
                    Pairing::Files => files(ui, align, actions),
                }
            });
        });
    });
    if align.pairing == Pairing::MovedCopy && align.custom.is_open {
        custom(ui, align, actions);
    }
    look
}

/// Menu of view directions, for all views at once.
fn look_menu(ui: &mut Ui) -> Option<ViewDirection> {
    let menu = menu_button(ui, format!("{} ▼", text!("shell-view")), |ui| {
        let mut choices = ViewDirection::choices().into_iter();
        let chosen = choices.find(|(text, _)| ui.button(text).clicked());
        if chosen.is_some() {
            ui.close();
        }
        chosen.map(|(_, look)| look)
    });
    menu.response.on_hover_text(text!("align-view-menu-hint"));
    menu.inner.flatten()
}

fn choice(ui: &mut Ui, is_chosen: bool, text: &str) -> Response {
    let button = Button::new(text).selected(is_chosen);
    ui.add(button.min_size(Vec2::splat(space::TARGET)))
}

fn run(ui: &mut Ui, align: &AlignState, session: &Session, actions: &mut Vec<AlignAction>) {
    let theme = Theme::of(ui);
    let missing = align.choice(session).err();
    let label = text!("align-run");
    let text = RichText::new(&label).font(font::body_strong());
    let key = RichText::new("R").small();
    let button = Button::new(text.color(theme.on_accent))
        .shortcut_text(key.color(theme.on_accent))
        .fill(theme.accent);
    let clicked = ui
        .add_enabled_ui(missing.is_none(), |ui| labelled(ui, button, &label))
        .inner;
    let clicked = match missing {
        Some(missing) => clicked.on_disabled_hover_text(missing),
        None => clicked.on_hover_text(text!("align-run-hint")),
    };
    if clicked.clicked() {
        actions.push(AlignAction::Run);
    }
}

fn part_menu(ui: &mut Ui, align: &AlignState, session: &Session, actions: &mut Vec<AlignAction>) {
    let Some(library) = &session.library else {
        ui.label(text!("shell-library-loading"));
        return;
    };
    if let Some(problem) = &library.unloaded {
        ui.label(text!("align-library-failed"))
            .on_hover_text(format!("{}. {}", problem.what, problem.advice));
        return;
    }
    let chosen = align.chosen_part(session);
    let title = chosen.map_or_else(
        || text!("shell-no-part"),
        |name| library.title_of(name).to_owned(),
    );
    let named = |title: &str| format!("{} · {title} ▼", text!("shell-part"));
    // The menu uses the width left by Run.
    let room = ui.available_width() - button_width(ui, &named(""));
    let font = TextStyle::Button.resolve(ui.style());
    let shown = fitted_middle(ui.painter(), &shortened(&title, 24), &font, room);
    let menu = menu_button(ui, named(&shown), |ui| {
        ui.set_min_width(200.0);
        menu_list(ui, |ui| {
            for part in &library.parts {
                let name = part.name.as_str();
                if ui
                    .selectable_label(chosen == Some(name), part.shown_title())
                    .clicked()
                {
                    actions.push(AlignAction::ChoosePart(name.to_owned()));
                    ui.close();
                }
            }
        });
    });
    let label = named(&title);
    menu.response
        .widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    let hint = text!("align-part-hint");
    menu.response.on_hover_text(format!("{title}\n{hint}"));
}

/// Draws the starts of a moved copy.
fn starts(ui: &mut Ui, align: &AlignState, actions: &mut Vec<AlignAction>) {
    let start = align.start;
    ui.weak(text!("align-start"));
    for index in 0..Start::NUM_PAPER {
        let paper = Start::Paper(index);
        let button = choice(ui, start == paper, &paper.title());
        if button.on_hover_text(numbers(paper)).clicked() {
            actions.push(AlignAction::ChooseStart(paper));
        }
    }
    let is_custom = matches!(start, Start::Custom(_));
    let button = choice(ui, is_custom, &text!("align-custom"));
    let button = match start {
        Start::Custom(_) => button.on_hover_text(numbers(start)),
        Start::Paper(_) | Start::Random(_) => button,
    };
    if button.clicked() {
        actions.push(AlignAction::ToggleCustom);
    }
    let is_random = matches!(start, Start::Random(_));
    let button = choice(ui, is_random, &text!("align-random"));
    let button = button.on_hover_text(text!("align-random-hint"));
    if button.clicked() {
        actions.push(AlignAction::DrawStart);
    }
    if let Start::Random(seed) = start {
        let mut number = seed;
        let prefix = text!("align-random-prefix") + " ";
        let field = DragValue::new(&mut number).prefix(prefix).speed(0.05);
        let field = ui.add_sized(vec2(76.0, space::TARGET), field);
        let label = text!("align-random-number", number = seed);
        ui.accesskit_node_builder(field.id, |node| node.set_label(label));
        if field.on_hover_text(numbers(start)).changed() {
            let start = Start::Random(number);
            actions.push(AlignAction::ChooseStart(start));
        }
    }
}

/// Formats the six numbers of a start.
fn numbers(start: Start) -> String {
    let transform = start.transform();
    let (rx, ry, rz) = transform.rotation.euler_angles();
    let [rx, ry, rz] = [rx, ry, rz].map(|radians| format!("{:.1}", radians.to_degrees()));
    let shift: [f64; 3] = transform.translation.vector.into();
    let [x, y, z] = shift.map(|metres| format!("{:.0}", metres * 1000.0));
    let numbers = text!(
        "align-numbers",
        rx = rx,
        ry = ry,
        rz = rz,
        x = x,
        y = y,
        z = z
    );
    format!("{numbers}\nR = Rz·Ry·Rx")
}

/// Draws the form of a custom start.
fn custom(ui: &mut Ui, align: &AlignState, actions: &mut Vec<AlignAction>) {
    let theme = Theme::of(ui);
    let custom = &align.custom;
    ui.horizontal(|ui| {
        let mut text = custom.text.clone();
        let field = TextEdit::singleline(&mut text)
            .hint_text(text!("align-custom-hint"))
            .align(Align2::LEFT_CENTER);
        let width = (ui.available_width() - 150.0).min(420.0);
        let field = ui.add_sized(vec2(width, space::TARGET), field);
        let label = text!("align-custom-label");
        ui.accesskit_node_builder(field.id, |node| node.set_label(label));
        let is_entered =
            field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if field.changed() {
            actions.push(AlignAction::WriteCustom(text));
        }
        let use_it = ui
            .add_enabled_ui(custom.transform.is_some(), |ui| {
                text_button(ui, &text!("align-use-start"))
            })
            .inner;
        if use_it.clicked() || is_entered {
            actions.push(AlignAction::UseCustom);
        }
    });
    let plain = text!("align-custom-units");
    ui.spacing_mut().interact_size.y = REMARK_HEIGHT_PX;
    let mut line = |text: &str, colour| {
        ui.horizontal(|ui| {
            let text = RichText::new(text).small().color(colour);
            ui.add(Label::new(text).truncate());
        });
    };
    if custom.remarks.is_empty() {
        line(&plain, theme.weak_text);
    }
    for remark in &custom.remarks {
        line(remark, theme.warning);
    }
}

/// Draws which scene is aligned.
fn scene(ui: &mut Ui, align: &AlignState, session: &Session) {
    ui.set_min_height(space::TARGET);
    let text = match (&session.shown, align.choice(session)) {
        (Some(shown), Ok(_)) => {
            let inspected = &shown.inspected;
            let num = inspected.figures.num_part;
            let scene = inspected.origin.shown_title();
            text!("align-scene-part", scene = scene, count = num)
        }
        (_, Err(missing)) => missing,
        (None, Ok(_)) => String::new(),
    };
    ui.weak(text);
}

/// Draws which files are aligned.
fn files(ui: &mut Ui, align: &AlignState, actions: &mut Vec<AlignAction>) {
    for (role, path, file) in [
        (text!("align-source"), &align.source, AlignFile::Source),
        (text!("align-target"), &align.target, AlignFile::Target),
    ] {
        let text = match path {
            Some(path) => format!("{role} · {}", shortened(&file_name(path), NAME)),
            None => format!("{role}…"),
        };
        let hover = match file {
            AlignFile::Source => text!("align-source-hint"),
            AlignFile::Target | AlignFile::TableFile => text!("align-target-hint"),
        };
        let button = labelled(ui, Button::new(&text), &format!("{role}…"));
        if button.on_hover_text(hover).clicked() {
            actions.push(AlignAction::Ask(file));
        }
    }
}
