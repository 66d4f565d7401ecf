//! Shortcuts, and the list of them.

use egui::{Event, Id, Key, KeyboardShortcut, Modifiers, RichText, ScrollArea, vec2};

use crate::{
    action::{self, Action, DialogRequest},
    cell::RobotAction,
    roles::{self, RoleAction},
    session::WorkspaceKind,
    source::live::LiveAction,
    state::State,
};
use ui::{
    key_binding::{CTRL_SHIFT, KeyBinding, Shortcut},
    language::{keys, text},
    theme::{font, space},
    widgets,
};

/// The shortcuts of the whole window.
#[rustfmt::skip]
const SHORTCUTS: [Shortcut<Action>; 13] = [
    Shortcut::new(Modifiers::NONE, Key::Space, || text!("shell-does-capture"), || Action::Capture),
    Shortcut::new(Modifiers::NONE, Key::L, || text!("shell-does-live"), || Action::Live(LiveAction::Toggle)),
    Shortcut::new(Modifiers::COMMAND, Key::L, || text!("shell-does-record"), || Action::Live(LiveAction::ToggleRecording)),
    // Before Ctrl O, which would match it too.
    Shortcut::new(CTRL_SHIFT, Key::O, || text!("shell-does-open-scan"), || Action::Ask(DialogRequest::Scan)),
    Shortcut::new(Modifiers::COMMAND, Key::O, || text!("shell-open-scene"), || Action::Ask(DialogRequest::Scene)),
    Shortcut::new(Modifiers::COMMAND, Key::E, || text!("shell-does-export"), || Action::Tell(action::Event::Export)),
    Shortcut::new(Modifiers::NONE, Key::B, || text!("shell-does-robot"), || Action::Robot(RobotAction::Toggle)),
    Shortcut::new(Modifiers::NONE, Key::U, || text!("shell-does-units"), || Action::SwitchUnits),
    Shortcut::new(Modifiers::NONE, Key::T, || text!("shell-does-theme"), || Action::SwitchTheme),
    Shortcut::new(Modifiers::COMMAND, Key::K, || text!("shell-does-role"), || Action::Role(RoleAction::Switch)),
    Shortcut::new(Modifiers::COMMAND, Key::Q, || text!("shell-does-quit"), || Action::Close),
    Shortcut::new(Modifiers::NONE, Key::F1, || text!("shell-does-help"), || Action::ToggleHelp),
    Shortcut::new(Modifiers::NONE, Key::Escape, || text!("shell-does-escape"), || Action::CloseTop),
];

/// Keys of the 3-D view and of the focus, only for the list; the last one is only the engineer's.
fn other_keys() -> [[String; 2]; 8] {
    [
        [keys("Ctrl + − 0"), text!("shell-does-size")],
        [text!("shell-keys-tab"), text!("shell-does-tab")],
        [text!("shell-keys-turn"), text!("shell-does-turn")],
        [text!("shell-keys-shift"), text!("shell-does-shift")],
        [text!("shell-keys-zoom"), text!("shell-does-zoom")],
        [text!("shell-keys-fit"), text!("shell-does-fit")],
        ["Z, Y, X".to_owned(), text!("shell-does-look")],
        ["M".to_owned(), text!("shell-does-measure")],
    ]
}

/// Keys of the picture and the 3-D view for correcting a part, only for the list.
fn picture_keys() -> [[String; 2]; 3] {
    [
        [text!("shell-keys-drawing"), text!("shell-does-drawing")],
        [text!("shell-keys-box"), text!("shell-does-box")],
        [text!("shell-keys-resize"), text!("shell-does-resize")],
    ]
}

/// Keys of the workspaces, in the order of the rail.
const RAIL_KEYS: [Key; 7] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
];

/// Part of the window's height that the list leaves free, for heading, button, edges, and a notice above it, logical pixels.
const HELP_MARGIN: f32 = 230.0;

/// True for the window's keys that act in the operator's view, where a PIN protects the source.
fn is_operators(binding: &KeyBinding, has_pin: bool) -> bool {
    let is_with_ctrl = binding.modifiers.command;
    match binding.key {
        Key::Space | Key::T | Key::F1 => true,
        Key::L => !is_with_ctrl,
        Key::E | Key::K | Key::Q => is_with_ctrl,
        Key::O => is_with_ctrl && !has_pin,
        _ => false,
    }
}

/// Returns the actions of pressed keys, in the order in which they were pressed. Called after the panels, so that a focused
/// control gets its keys first.
///
/// The space bar presses a focused control; `space_is_free` means that the focused one does not use it. While the user types
/// text, only keys with Ctrl are shortcuts; the Enter that ends typing belongs to the text, too. Behind a dialog there are no
/// shortcuts: the dialog gets the keys.
pub fn shortcuts(
    ctx: &egui::Context,
    state: &State,
    own: &[KeyBinding],
    space_is_free: bool,
    is_behind_dialog: bool,
) -> Vec<Action> {
    let is_writing = ctx.text_edit_focused();
    let was_writing = remember_writing(ctx, is_writing);
    if is_behind_dialog {
        return Vec::new();
    }
    let pressed = ctx.input(|input| {
        let events = input.events.iter().filter_map(|event| match event {
            Event::Key {
                key,
                pressed: true,
                modifiers,
                ..
            } => Some((*key, *modifiers)),
            _ => None,
        });
        events.collect::<Vec<_>>()
    });
    let place = |key: Key, modifiers: Modifiers| {
        let is_it =
            |(other, with): &(Key, Modifiers)| *other == key && with.matches_logically(modifiers);
        pressed.iter().position(is_it)
    };
    let mut found = Vec::new();
    let is_pressing = !space_is_free && ctx.memory(|memory| memory.focused().is_some());
    let workspace = state.session.workspace;
    let own = own.iter().copied().enumerate();
    let own = own.map(|(index, binding)| (binding, Action::Press(workspace, index)));
    let named = SHORTCUTS
        .iter()
        .map(|shortcut| (shortcut.binding, (shortcut.action)()));
    for (binding, action) in own.chain(named) {
        let is_plain = binding.modifiers.is_none();
        // In a text field, Ctrl Z undoes typing.
        let is_of_text = is_plain || binding.key == Key::Z;
        let presses = matches!(binding.key, Key::Space | Key::Enter);
        // Escape does nothing in a text field but leave it, so that the same press may also close what is open.
        let is_taken = is_writing || was_writing && binding.key != Key::Escape;
        if presses && is_pressing || is_of_text && is_taken {
            continue;
        }
        let keys = KeyboardShortcut::new(binding.modifiers, binding.key);
        if ctx.input_mut(|input| input.consume_shortcut(&keys)) {
            found.push((place(binding.key, binding.modifiers), action));
        }
    }
    let of_rail = RAIL_KEYS.into_iter().zip(WorkspaceKind::ALL);
    for (key, workspace) in of_rail.filter(|_| !is_writing && !was_writing) {
        if ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key)) {
            found.push((place(key, Modifiers::NONE), Action::GoTo(workspace)));
        }
    }
    found.sort_by_key(|(place, _)| *place);
    found.into_iter().map(|(_, action)| action).collect()
}

/// Returns whether a text field had the focus when this frame began, and remembers whether one has it now.
///
/// A single-line text field loses the focus in the same frame in which Enter is pressed.
fn remember_writing(ctx: &egui::Context, is_writing: bool) -> bool {
    let id = Id::unique("a text is being written");
    ctx.data_mut(|data| {
        let was_writing = data.get_temp(id).unwrap_or(false);
        data.insert_temp(id, is_writing);
        was_writing
    })
}

/// Texts of the shortcuts, each before the one with Shift, which is matched first.
fn listed(bindings: impl Iterator<Item = KeyBinding>) -> impl Iterator<Item = [String; 2]> {
    let mut all: Vec<KeyBinding> = Vec::new();
    for binding in bindings {
        let with_shift = all.pop_if(|last| last.key == binding.key && last.modifiers.shift);
        all.push(binding);
        all.extend(with_shift);
    }
    all.into_iter()
        .map(|binding| [binding.keys(), (binding.does)()])
}

/// Draws the list of shortcuts.
pub fn help(ctx: &egui::Context, state: &State, own: &[KeyBinding], actions: &mut Vec<Action>) {
    if !state.is_help_open {
        return;
    }
    let modal = widgets::dialog(ctx, "help", |ui| {
        ui.set_max_width(640.0);
        let height = ui.spacing().interact_size.y;
        ui.spacing_mut().interact_size.y = 24.0;
        ui.heading(text!("shell-shortcuts"));
        ui.add_space(space::SMALL);
        let room = ctx.content_rect().height() - HELP_MARGIN;
        let list = egui::Grid::new("shortcuts")
            .num_columns(2)
            .spacing(vec2(24.0, 6.0));
        let is_operator = state.session.is_operator_view();
        let has_pin = state.roles.pin.is_some();
        // The scroll bar is beside the list, not over it.
        ui.spacing_mut().scroll.floating_allocated_width = space::MEDIUM;
        let list_area = ScrollArea::vertical().max_height(room);
        list_area.min_scrolled_height(room).show(ui, |ui| {
            list.show(ui, |ui| {
                let own = if is_operator { &[][..] } else { own };
                let own = listed(own.iter().copied());
                let named = SHORTCUTS.iter().map(|shortcut| shortcut.binding);
                let named = listed(named.filter(|key| !is_operator || is_operators(key, has_pin)));
                let of_rail = RAIL_KEYS.into_iter().zip(WorkspaceKind::ALL);
                let of_rail =
                    of_rail.filter(|(_, kind)| !is_operator || roles::is_operators(*kind));
                let of_rail =
                    of_rail.map(|(key, workspace)| [key.name().to_owned(), workspace.title()]);
                let is_enrolling = state.session.workspace == WorkspaceKind::Enrol;
                let of_picture = is_enrolling.then(picture_keys).into_iter().flatten();
                // Only the engineer measures.
                let num = other_keys().len() - usize::from(is_operator);
                let others = of_picture.chain(other_keys().into_iter().take(num));
                for [keys, does] in named.chain(own).chain(of_rail).chain(others) {
                    ui.label(RichText::new(keys).font(font::body_strong()));
                    ui.weak(does);
                    ui.end_row();
                }
            });
        });
        ui.spacing_mut().interact_size.y = height;
        ui.add_space(space::MEDIUM);
        widgets::default_button(ui, &text!("shell-close"), true)
    });
    let is_pressed_again = || ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F1));
    if modal.inner || modal.should_close() || is_pressed_again() {
        actions.push(Action::ToggleHelp);
    }
}
