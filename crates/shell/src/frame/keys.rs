//! Shortcuts, and the list of them.

use egui::{Event, Id, Key, KeyboardShortcut, Modifiers};

use crate::{
    action::{self, Action, DialogRequest},
    cell::RobotAction,
    rack::RackAction,
    roles::{self, RoleAction},
    session::WorkspaceKind,
    source::{live::LiveAction, source_menu},
    state::State,
};
use ui::{
    key_binding::{CTRL_SHIFT, KeyBinding, Shortcut},
    language::{Language, keys, text},
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

/// A line of the list of keys.
pub(crate) struct KeyLine {
    /// The keys; empty for an action without one.
    pub keys: String,
    /// What they do.
    pub does: String,
    /// The action, if it can be started from the list.
    pub action: Option<Action>,
}

impl KeyLine {
    fn only_listed([keys, does]: [String; 2]) -> Self {
        Self {
            keys,
            does,
            action: None,
        }
    }
}

/// The lines of these shortcuts, each before the one with Shift, which is matched first.
fn listed(bindings: impl Iterator<Item = (KeyBinding, Action)>) -> impl Iterator<Item = KeyLine> {
    let mut all: Vec<(KeyBinding, Action)> = Vec::new();
    for (binding, action) in bindings {
        let with_shift = all.pop_if(|(last, _)| last.key == binding.key && last.modifiers.shift);
        all.push((binding, action));
        all.extend(with_shift);
    }
    all.into_iter().map(|(binding, action)| KeyLine {
        keys: binding.keys(),
        does: (binding.does)(),
        // Help is open, and nothing else is on top.
        action: Some(action)
            .filter(|action| !matches!(action, Action::ToggleHelp | Action::CloseTop)),
    })
}

/// The keys that act in the view in front; `own` are those of the workspace.
pub(crate) fn lines(state: &State, own: &[KeyBinding]) -> Vec<KeyLine> {
    let is_operator = state.session.is_operator_view();
    let has_pin = state.roles.pin.is_some();
    let workspace = state.session.workspace;
    let own = if is_operator { &[][..] } else { own };
    let own = own.iter().copied().enumerate();
    let own = listed(own.map(|(index, binding)| (binding, Action::Press(workspace, index))));
    let named = SHORTCUTS.iter();
    let named = named.map(|shortcut| (shortcut.binding, (shortcut.action)()));
    let named = listed(named.filter(|(key, _)| !is_operator || is_operators(key, has_pin)));
    let of_rail = RAIL_KEYS.into_iter().zip(WorkspaceKind::ALL);
    let of_rail = of_rail.filter(|(_, kind)| !is_operator || roles::is_operators(*kind));
    let of_rail = of_rail.map(|(key, workspace)| KeyLine {
        keys: key.name().to_owned(),
        does: workspace.title(),
        action: Some(Action::GoTo(workspace)),
    });
    let of_picture = (workspace == WorkspaceKind::Enrol).then(picture_keys);
    // Only the engineer measures.
    let num = other_keys().len() - usize::from(is_operator);
    let others = other_keys().into_iter().take(num);
    let others = of_picture.into_iter().flatten().chain(others);
    let others = others.map(KeyLine::only_listed);
    named.chain(own).chain(of_rail).chain(others).collect()
}

/// Actions without a key, which the search finds.
pub(crate) fn without_keys(state: &State) -> Vec<KeyLine> {
    let languages = Language::ALL.map(|language| {
        let does = text!("shell-language-of", language = language.own_name());
        (does, Action::Speak(language))
    });
    let of_engineer = [
        (
            text!("shell-play-recording"),
            Action::Ask(DialogRequest::Recording),
        ),
        (
            text!("shell-watch-folder"),
            Action::Ask(DialogRequest::WatchedFolder),
        ),
        (
            text!("shell-use-another-library"),
            Action::Ask(DialogRequest::Library),
        ),
        (text!("expect-orders"), Action::Ask(DialogRequest::Orders)),
        (text!("rack-says"), Action::Rack(RackAction::Toggle)),
        (
            text!("shell-set-up-cell"),
            Action::Live(LiveAction::SetUp(Some(source_menu::cell_in_use(
                &state.session.source,
            )))),
        ),
    ];
    let of_engineer = of_engineer.into_iter();
    let of_engineer = of_engineer.filter(|_| !state.session.is_operator_view());
    let all = of_engineer.chain(languages);
    all.map(|(does, action)| KeyLine {
        keys: String::new(),
        does,
        action: Some(action),
    })
    .collect()
}
