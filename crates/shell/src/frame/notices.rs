//! What lies over the workspaces: the notices, the question before the window closes with unsaved data or while it answers robots,
//! and what the window's own file dialogs ask for.
//!
//! Notices lie over the view of the workspace, where they cover no control; nothing moves when they come and go. The operator's
//! view shows the newest two.

use egui::{
    Align, Area, Context, Frame, Id, Layout, Margin, Order, Rect, RichText, ScrollArea, Sense, Ui,
    pos2, vec2,
};

use crate::{
    action::{Action, DialogRequest, Event},
    file_dialog::{FileChoice, FileFilter, FileRequest, all_files, points},
    notice::{Notice, NoticeKind},
    state::{Closing, State},
};
use files::SCENE_ENDINGS;
use ui::{
    language::text,
    theme::{ROUNDING, Theme, space},
    widgets::{self, Mark, line_mark, sentence, text_button},
};

/// Margin around the notices and between them, logical pixels.
const EDGE: f32 = 6.0;
/// Number of notices that are dismissed one by one, and that the operator's view shows.
const FEW: usize = 2;
/// Time without motion and click after which the pointer is at rest, seconds.
const REST: f32 = 0.6;

/// How long a notice is shown, seconds; `None` for one that stays until it is dismissed.
fn display_seconds(kind: NoticeKind) -> Option<f64> {
    match kind {
        NoticeKind::Look => None,
        NoticeKind::Done => Some(8.0),
        NoticeKind::Undoable(_) => Some(12.0),
    }
}

/// Draws the notices at the bottom of this room, and dismisses expired ones.
pub fn ui(ctx: &Context, room: Rect, state: &State, actions: &mut Vec<Action>) {
    let room = room.shrink(EDGE);
    let id = Id::unique("notices");
    // The height of the notices when they were last drawn, and that of the room that they hold.
    let [height, held]: [f32; 2] = ctx.data(|data| data.get_temp(id)).unwrap_or_default();
    let place = room.with_min_y(room.bottom() - held.max(height));
    expire(ctx, place, &state.notices, actions);
    if !state.notices.is_empty() && ctx.memory(|memory| memory.top_modal_layer().is_some()) {
        return over_dialog(ctx, room, state, actions);
    }
    let drawn = if state.notices.is_empty() && held == 0.0 {
        0.0
    } else {
        // Below menus.
        let area = Area::new(id).order(Order::Middle).fixed_pos(place.min);
        let drawn = area.show(ctx, |ui| {
            ui.set_width(place.width());
            // Otherwise, an area is as high as it was, and a list in it would never grow.
            ui.set_height(place.height());
            ui.interact(place, id.with("held"), Sense::click_and_drag());
            ui.add_space(place.height() - height);
            list(ui, height, state, actions).min(room.height())
        });
        drawn.inner
    };
    let held = if drawn >= held || is_at_rest(ctx) {
        drawn
    } else {
        ctx.request_repaint_after_secs(REST);
        held
    };
    ctx.data_mut(|data| data.insert_temp(id, [drawn, held]));
    if (drawn - height).abs() > 0.5 {
        ctx.request_discard("the notices have another height");
    }
}

/// True if the pointer is not in use: a press meant for a notice that has just gone must not reach what lies under it.
fn is_at_rest(ctx: &Context) -> bool {
    ctx.input(|input| {
        let pointer = &input.pointer;
        let since = (pointer.time_since_last_movement()).min(pointer.time_since_last_click());
        !pointer.any_down() && since > REST
    })
}

/// Draws the notices in a list of this height, the newest last; returns the height that shows all of them.
fn list(ui: &mut Ui, height: f32, state: &State, actions: &mut Vec<Action>) -> f32 {
    let newest = state.notices.len().saturating_sub(1);
    let num_hidden = if state.session.is_operator_view() {
        state.notices.len().saturating_sub(FEW)
    } else {
        0
    };
    let area = ScrollArea::vertical()
        .max_height(height)
        .min_scrolled_height(0.0)
        .stick_to_bottom(true);
    let drawn = area.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = EDGE;
        for (index, notice) in state.notices.iter().enumerate().skip(num_hidden) {
            let with_all = index == newest && newest >= FEW;
            plate(ui, index, notice, with_all, actions);
        }
    });
    drawn.content_size.y
}

/// Draws the newest notice on top of the bar and a dialog: dialogs are tall, and the notice that one causes must be readable
/// and dismissible.
fn over_dialog(ctx: &Context, room: Rect, state: &State, actions: &mut Vec<Action>) {
    let Some((index, notice)) = state.notices.iter().enumerate().next_back() else {
        return;
    };
    Area::new(Id::unique("notice over a dialog"))
        .order(Order::Tooltip)
        .fixed_pos(pos2(room.left(), ctx.content_rect().top() + 2.0))
        .show(ctx, |ui| {
            ui.set_width(room.width());
            plate(ui, index, notice, false, actions);
        });
}

/// Draws a notice; `with_all` adds a button that dismisses all of them.
fn plate(ui: &mut Ui, index: usize, notice: &Notice, with_all: bool, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    Frame::new()
        .fill(theme.control)
        .stroke(theme.edge_stroke())
        .corner_radius(ROUNDING)
        .inner_margin(Margin::symmetric(14, 4))
        .show(ui, |ui| line(ui, index, notice, with_all, actions));
}

fn line(ui: &mut Ui, index: usize, notice: &Notice, with_all: bool, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    ui.horizontal(|ui| {
        ui.set_min_height(space::TARGET);
        let sign = match notice.kind {
            NoticeKind::Look => Mark::Look,
            NoticeKind::Done | NoticeKind::Undoable(_) => Mark::Good,
        };
        line_mark(ui, 20.0, 9.0, sign);
        // A layout without a size would take all the height that is free.
        let size = vec2(ui.available_width(), space::TARGET);
        ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
            if text_button(ui, &text!("shell-dismiss")).clicked() {
                actions.push(Action::Dismiss(index));
            }
            if with_all && text_button(ui, &text!("shell-dismiss-all")).clicked() {
                actions.push(Action::DismissAll);
            }
            let is_offered = notice.in_millimetres.is_some();
            if is_offered && text_button(ui, &text!("shell-read-in-millimetres")).clicked() {
                actions.push(Action::Reread(index));
            }
            if let NoticeKind::Undoable(by) = notice.kind
                && text_button(ui, &text!("shell-undo")).clicked()
            {
                actions.push(Action::Tell(Event::Undo(by)));
            }
            let words = Layout::left_to_right(Align::Center).with_main_wrap(true);
            ui.with_layout(words, |ui| {
                if notice.advice.is_empty() {
                    ui.label(sentence(&notice.what));
                } else {
                    let what = sentence(notice.what.trim_end_matches(['.', '。']));
                    let what = text!("shell-sentence", text = what);
                    ui.label(what);
                    ui.label(RichText::new(&notice.advice).color(theme.warning));
                }
                if notice.num_more > 0 {
                    ui.weak(text!("shell-more-like-it", num = notice.num_more));
                }
            });
        });
    });
}

/// Notices with the time when they appeared, seconds of egui's clock.
type TimedNotice = Vec<(Notice, f64)>;

fn expire(ctx: &Context, place: Rect, notices: &[Notice], actions: &mut Vec<Action>) {
    let now = ctx.input(|input| input.time);
    // No notice disappears under the pointer.
    let pointer = ctx.pointer_latest_pos();
    let is_pointed_at = pointer.is_some_and(|at| place.contains(at));
    let id = Id::unique("notices since");
    let since: TimedNotice = ctx.data_mut(|data| {
        let since = data.get_temp_mut_or_default::<TimedNotice>(id);
        since.retain(|(known, _)| notices.contains(known));
        for notice in notices {
            if !since.iter().any(|(known, _)| known == notice) {
                since.push((notice.clone(), now));
            }
        }
        since.clone()
    });
    // From last to first, so that the indices stay valid.
    for (index, notice) in notices.iter().enumerate().rev() {
        let begun = since.iter().find(|(known, _)| known == notice);
        let (Some(display_seconds), Some((_, begun))) = (display_seconds(notice.kind), begun)
        else {
            continue;
        };
        let left = begun + display_seconds - now;
        if left <= 0.0 && is_pointed_at {
            ctx.request_repaint_after_secs(REST);
        } else if left <= 0.0 {
            actions.push(Action::Dismiss(index));
        } else {
            ctx.request_repaint_after_secs(left as f32);
        }
    }
}

/// Returns the request for a choice.
pub fn request(ask: DialogRequest) -> FileRequest {
    let (title, choice): (_, FileChoice) = match ask {
        DialogRequest::Scene => (text!("shell-open-scene"), FileChoice::File),
        DialogRequest::Scan => (text!("shell-scan-folder"), FileChoice::Folder),
        DialogRequest::Library => (text!("shell-another-library"), FileChoice::Folder),
        DialogRequest::Recording => (text!("shell-a-recording"), FileChoice::Folder),
        DialogRequest::RecordTo => (text!("shell-record-to"), FileChoice::FolderToWrite),
        DialogRequest::WatchedFolder => (text!("shell-watched-folder"), FileChoice::Folder),
        DialogRequest::Part => (text!("shell-open-part"), FileChoice::File),
        DialogRequest::Rack => (text!("shell-open"), FileChoice::File),
        DialogRequest::SaveRack => (
            text!("shell-save-as"),
            FileChoice::NewFile("rack.toml".into()),
        ),
        DialogRequest::Orders => (text!("expect-table"), FileChoice::File),
        DialogRequest::ProblemReport => (
            text!("help-report"),
            FileChoice::NewFile("partsight-problem.zip".into()),
        ),
    };
    FileRequest {
        title,
        filters: filters(ask),
        choice,
    }
}

fn filters(ask: DialogRequest) -> Vec<FileFilter> {
    match ask {
        DialogRequest::Scene => vec![(text!("shell-captured-scenes"), SCENE_ENDINGS), all_files()],
        DialogRequest::Part => vec![points(), all_files()],
        DialogRequest::Rack | DialogRequest::SaveRack => {
            vec![(text!("rack-files"), &["toml"]), all_files()]
        }
        DialogRequest::Orders => vec![(text!("shell-csv-files"), &["csv"]), all_files()],
        DialogRequest::ProblemReport => vec![(text!("help-zip-files"), &["zip"]), all_files()],
        DialogRequest::Scan
        | DialogRequest::Library
        | DialogRequest::Recording
        | DialogRequest::RecordTo
        | DialogRequest::WatchedFolder => Vec::new(),
    }
}

/// Draws the question while it is open.
pub fn closing(ctx: &Context, state: &State, actions: &mut Vec<Action>) {
    let Closing::Asked { what, is_unsaved } = &state.closing else {
        return;
    };
    let (question, close) = if *is_unsaved {
        (
            text!("shell-close-without-saving"),
            text!("shell-close-anyway"),
        )
    } else {
        (
            text!("shell-stop-answering"),
            text!("shell-close-and-stop-answering"),
        )
    };
    let modal = widgets::dialog(ctx, "closing", |ui| {
        ui.set_max_width(420.0);
        ui.heading(question);
        ui.weak(what);
        ui.add_space(space::MEDIUM);
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &text!("shell-keep-open"), true) {
                actions.push(Action::StayOpen);
            }
            if text_button(ui, &close).clicked() {
                actions.push(Action::CloseAnyway);
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::StayOpen);
    }
}
