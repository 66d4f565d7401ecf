//! The verdict card: which part, accepted or not, where, how certain, the stand-off against its band, and what to do next.

use egui::{
    Align, Align2, Button, Frame, Label, Layout, Panel, Rect, RichText, ScrollArea, Sense, Ui,
    pos2, style::ScrollStyle, vec2,
};

use crate::{
    shots::summary,
    workspaces::inspect::{
        frame_parts,
        headline::{self, Headline, HeadlineState},
        hold::{self, Hold},
        robot_numbers,
        state::{InspectAction, InspectFile},
        surface,
    },
};
use inspection::pipeline::{Rejection, Unrecognisable, Verdict};
use robot::spray::{BandStatus, CarriedPath, MOST_TILT, SurfaceHit};
use shell::{
    action::Action,
    cell::RobotAction,
    inspection::inspected::Inspected,
    language::{UnitSystem, recipe_label, traced},
    session::{Session, UserRole, WorkspaceKind},
    source::live::{self, LiveAction},
    trace::{entry, expecting},
};
use stages::{
    pose::PoseEstimate,
    stand_off::{StandOff, StandOffParams},
};
use station::Doubt;
use ui::{
    language::{described, text},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Scale, focus_ring, heading, row, sentence, shortened},
};

/// Draws the card; with the stand-off of an assumed path only if its nozzle is shown.
pub(super) fn ui(
    ui: &mut Ui,
    inspected: &Inspected,
    session: &Session,
    shows_nozzle: bool,
    actions: &mut Vec<InspectAction>,
) {
    let theme = Theme::of(ui);
    if session.is_old() {
        let text = match &session.inspecting {
            Some(_) => text!("inspect-previous-result"),
            None => text!("inspect-outdated"),
        };
        let text = RichText::new(text).font(font::body_strong());
        ui.label(text.color(theme.warning));
        ui.multiply_opacity(0.55);
    }
    if session.shown.as_ref().is_some_and(|shown| shown.is_past) {
        let text = text!("inspect-from-history");
        let text = RichText::new(text).font(font::body_strong());
        ui.label(text.color(theme.warning));
    }
    expecting(ui, session, actions);
    if session.is_live() && live::card(ui, session) {
        let toggle = Action::Live(LiveAction::ToggleRecording);
        actions.push(InspectAction::Act(toggle));
    }
    let inspection = &inspected.inspection;
    // Without the part's name, the figures of its pose are of no use.
    let pose = inspection.found_pose();
    let pose = pose.filter(|_| inspection.verdict.is_named());
    // Keep the buttons visible, however low the window.
    let pose_to_copy = pose.filter(|_| inspection.verdict.is_accepted());
    let headline = Headline::of(inspected, session);
    let next = next_step(inspected, session, &headline);
    let rows = if next.is_some() { 2.0 } else { 1.0 };
    Panel::bottom("ways on")
        .exact_size(rows * (space::TARGET + space::SMALL) + space::SMALL)
        .resizable(false)
        .show_separator_line(false)
        .frame(Frame::new())
        .show(ui, |ui| {
            let copying = pose_to_copy.map(|_| Hold::robot_of_files(session, inspected).map(drop));
            action_buttons(ui, copying, next, &headline, actions);
        });
    hold::look_again(ui);
    // Lines of text need less height than controls.
    ui.spacing_mut().interact_size.y = 20.0;
    ui.spacing_mut().item_spacing.y = 3.0;
    ui.spacing_mut().scroll = ScrollStyle::thin();
    // The bar is beside the figures, not over them.
    ui.spacing_mut().scroll.floating_allocated_width = space::SMALL;
    frame_parts::ui(ui, session, actions);
    // Keep the verdict visible when the rest is scrolled.
    headline::ui(ui, &headline);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        if inspection.touches_edge() && inspected.scan.is_none() {
            ui.colored_label(theme.warning, text!("inspect-touches-edge"));
        }
        if inspected.scene.fitting_empty_cell().is_err() {
            ui.colored_label(theme.warning, text!("inspect-other-empty-cell"));
        }
        if inspection.leaves_volume {
            ui.colored_label(theme.warning, text!("rack-leaves-volume"));
        }
        as_part(ui, inspected, &headline);
        score(ui, inspected, &headline);
        if let Some(pose) = pose {
            offset(ui, inspected, pose, session.units);
            fit(ui, pose, session.units);
            if pose.is_ambiguous() && !inspection.verdict.is_unknown() {
                ui.colored_label(theme.warning, text!("inspect-ambiguous"));
            }
            if inspection.verdict.is_approximate() && !inspection.verdict.is_unknown() {
                ui.colored_label(theme.warning, text!("inspect-approximate"));
            }
            // The figures of a path that was never stored would look like a defect beside an accepted part.
            if shows_nozzle || inspected.spray.is_some() {
                stand_off(ui, inspected, session.units);
            }
            surface::ui(ui, inspection, session.units);
            robot_numbers::ui(ui, inspected, session, actions);
        }
        if let Some(scan) = &inspected.scan {
            summary(ui, &scan.fused, session.units);
        }
        footer(ui, inspected, session);
    });
}

/// Draws what is expected of the next part; with a table of orders, also the fields that it depends on.
pub(super) fn expecting(ui: &mut Ui, session: &Session, actions: &mut Vec<InspectAction>) {
    if session.expecting.orders().is_some() {
        entry::fields_of_order(ui, session);
    }
    let mut of_shell = Vec::new();
    expecting::ui(ui, session, &mut of_shell);
    actions.extend(of_shell.into_iter().map(InspectAction::Act));
}

/// What the advice comes to, if a button does it: its label and action.
fn next_step(
    inspected: &Inspected,
    session: &Session,
    headline: &Headline,
) -> Option<(String, InspectAction)> {
    let calibrate = || {
        let open = Action::Robot(RobotAction::Toggle);
        (text!("inspect-calibrate"), InspectAction::Act(open))
    };
    let enrol = || (text!("inspect-enrol-this"), InspectAction::Enrol);
    let verdict = &inspected.inspection.verdict;
    match (headline.state, verdict) {
        (HeadlineState::Recognised, _) => {
            let doubts = session.robot_doubts(inspected);
            let is_first = doubts.first() == Some(&Doubt::NotCalibrated);
            (is_first && !inspected.subject.is_staged()).then(calibrate)
        }
        (_, Verdict::NoPart(Unrecognisable::EmptyLibrary)) => Some(enrol()),
        (HeadlineState::Refused, _) => match verdict.rejected()? {
            Rejection::Unknown { .. } | Rejection::Mirrored { .. } => Some(enrol()),
            Rejection::AnotherModel { .. }
            | Rejection::AnotherMake { .. }
            | Rejection::OtherHalf { .. } => {
                Some((text!("inspect-add-reference"), InspectAction::Enrol))
            }
            _ => None,
        },
        _ => None,
    }
}

/// Draws the buttons for what can be done with the result, above them the next step. `copying` is `None` without a pose to copy,
/// and holds why it must not be copied.
fn action_buttons(
    ui: &mut Ui,
    copying: Option<Result<(), Hold>>,
    next: Option<(String, InspectAction)>,
    headline: &Headline,
    actions: &mut Vec<InspectAction>,
) {
    /// Left and right of a button's text, logical pixels.
    const PADDING: f32 = 4.0;
    let theme = Theme::of(ui);
    let [why, why_says] = if headline.state == HeadlineState::Refused {
        [text!("inspect-why"), text!("inspect-why-says")]
    } else {
        [
            text!("inspect-wrong-part"),
            text!("inspect-wrong-part-says"),
        ]
    };
    let ways = [
        (
            text!("inspect-export"),
            text!("inspect-export-says"),
            InspectAction::Ask(InspectFile::Report),
        ),
        (
            why,
            why_says,
            InspectAction::Act(Action::GoTo(WorkspaceKind::Compare)),
        ),
        (
            text!("inspect-copy-pose"),
            text!("inspect-copy-pose-says"),
            InspectAction::CopyPose,
        ),
    ];
    let num = if copying.is_some() { 3 } else { 2 };
    let hold = copying.and_then(Result::err);
    ui.with_layout(Layout::bottom_up(Align::Min), |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().button_padding.x = PADDING;
            let gaps = ui.spacing().item_spacing.x * (num - 1) as f32;
            let room = ui.available_width() - gaps;
            let needed = |(label, ..): &(String, String, InspectAction)| {
                let colour = theme.text;
                let galley = ui
                    .painter()
                    .layout_no_wrap(label.clone(), font::small(), colour);
                galley.size().x + 2.0 * PADDING
            };
            let mut widths: Vec<f32> = ways.iter().take(num).map(needed).collect();
            let even = room / num as f32;
            // Equal widths, unless a text needs more.
            if widths.iter().all(|width| *width <= even) {
                widths.fill(even);
            }
            let spare = (room - widths.iter().sum::<f32>()) / num as f32;
            for ((label, says, action), width) in ways.into_iter().zip(widths) {
                let text = RichText::new(label).small();
                let size = vec2(width + spare, space::TARGET);
                let hold = hold
                    .as_ref()
                    .filter(|_| matches!(action, InspectAction::CopyPose));
                let button = ui.add_enabled_ui(hold.is_none(), |ui| {
                    ui.add_sized(size, Button::new(text).truncate())
                });
                let button = button.inner;
                focus_ring(ui, button.rect, &button);
                let why_not = hold.map_or_else(String::new, Hold::in_words);
                let button = button.on_hover_text(says).on_disabled_hover_text(why_not);
                if button.clicked() {
                    actions.push(action);
                }
            }
        });
        if let Some((label, action)) = next {
            let text = RichText::new(&label).font(font::body_strong());
            let button = Button::new(text.color(theme.on_accent)).fill(theme.accent);
            let size = vec2(ui.available_width(), space::TARGET);
            let button = ui.add_sized(size, button);
            focus_ring(ui, button.rect, &button);
            if button.clicked() {
                actions.push(action);
            }
        }
    });
}

/// Heads the figures with the part that they belong to, if the headline does not call what hangs there by its name.
fn as_part(ui: &mut Ui, inspected: &Inspected, headline: &Headline) {
    let verdict = &inspected.inspection.verdict;
    let Some(guess) = verdict.guess().filter(|_| verdict.is_named()) else {
        return;
    };
    let found = verdict.identification();
    if headline.state != HeadlineState::Open && !found.is_of_type() {
        let part = inspected.library.title_of(guess);
        heading(ui, &text!("inspect-as-part", part = part));
    }
}

/// Draws the score as a bar against the threshold, and the margin.
fn score(ui: &mut Ui, inspected: &Inspected, headline: &Headline) {
    let theme = Theme::of(ui);
    let Verdict::Part { score, margin, .. } = inspected.inspection.verdict else {
        return;
    };
    // A mirror image is called the image of a part that need not score more than the next one.
    let is_mirrored = inspected.inspection.verdict.is_mirrored();
    // Another reference of the same part is no other part.
    let next = inspected.inspection.ranking.runner_up();
    let next = next.filter(|_| !is_mirrored);
    ui.add_space(space::MEDIUM);
    let name = if is_mirrored {
        text!("inspect-score-itself")
    } else {
        sentence(&text!("history-figure-score"))
    };
    row(ui, &name, &format!("{score:.2}"));
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 12.0), Sense::hover());
    let painter = ui.painter();
    let bar = Rect::from_min_max(rect.min + vec2(0.0, 2.0), rect.max - vec2(0.0, 2.0));
    painter.rect_filled(bar, ROUNDING, theme.track);
    let width = bar.width() * score.clamp(0.0, 1.0) as f32;
    let (.., fill) = headline.verdict(theme);
    painter.rect_filled(
        Rect::from_min_size(bar.min, vec2(width, bar.height())),
        ROUNDING,
        fill,
    );
    let tick = bar.left() + bar.width() * inspected.recipe.accept.min_score as f32;
    let tick = Rect::from_min_max(
        pos2(tick - 1.0, rect.top()),
        pos2(tick + 1.0, rect.bottom()),
    );
    painter.rect_filled(tick, 0.0, theme.text);
    let caption = |text: String| RichText::new(text).small().weak();
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(caption(text!(
                "inspect-threshold",
                score = format!("{:.2}", inspected.recipe.accept.min_score)
            )));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if let Some(next) = next {
                    let next = caption(text!(
                        "inspect-next",
                        part = inspected.library.title_of(&next.part),
                        score = format!("{:.2}", next.score)
                    ));
                    ui.add(Label::new(next).truncate());
                }
            });
        });
    });
    if next.is_some() {
        let lead = ui.label(caption(text!(
            "inspect-margin",
            margin = format!("{margin:.2}")
        )));
        lead.on_hover_text(text!("inspect-margin-says"));
    }
}

/// Draws how far the part's middle is from its standard position, and how the part is rotated.
fn offset(ui: &mut Ui, inspected: &Inspected, pose: &PoseEstimate, units: UnitSystem) {
    let camera_from_part = pose.camera_from_part();
    heading(ui, &text!("inspect-offset"));
    let rows = |ui: &mut Ui, rows: [(&str, String); 3]| {
        for (axis, value) in rows {
            row(ui, axis, &value);
        }
    };
    // nalgebra's Euler angles are those of Rz·Ry·Rx.
    let (rx, ry, rz) = camera_from_part.rotation.euler_angles();
    let turns = [("rx", rx), ("ry", ry), ("rz", rz)];
    let turns = turns.map(|(axis, radians)| (axis, units.signed_angle(radians)));
    if let Some(middle) = inspected.middle {
        let shift = camera_from_part * middle - middle;
        let shifts = [("x", shift.x), ("y", shift.y), ("z", shift.z)];
        let shifts = shifts.map(|(axis, metres)| (axis, units.signed_length(metres)));
        ui.spacing_mut().item_spacing.x = space::LARGE;
        ui.columns(2, |columns| {
            if let [left, right] = columns {
                rows(left, shifts);
                rows(right, turns);
            }
        });
        ui.spacing_mut().item_spacing.x = space::SMALL;
    } else {
        rows(ui, turns);
    }
    if let Some(other) = inspected.inspection.other_reference() {
        let other = inspected.library.title_of(other);
        ui.weak(text!("inspect-measured-from", part = other));
    }
    if let Some(turn) = inspected.inspection.turn_at_place {
        let [found, limit] = [turn.found, turn.limit].map(|angle| units.angle(angle.0));
        let allowed = text!("rack-turn-of", found = found, limit = limit);
        row(ui, &text!("rack-turn"), &allowed);
    }
    let note = text!("inspect-offset-note");
    ui.label(RichText::new(note).small().weak());
}

fn fit(ui: &mut Ui, pose: &PoseEstimate, units: UnitSystem) {
    let theme = Theme::of(ui);
    heading(ui, &text!("inspect-fit"));
    row(ui, &text!("inspect-rms"), &units.length(pose.fit.rms_m));
    row(
        ui,
        &text!("inspect-overlap"),
        &format!("{:.0} %", pose.fit.overlap * 100.0),
    );
    if let Some(bounds) = pose.uncertainty {
        if let Some(freedom) = bounds.freedom {
            let text = text!("inspect-unconstrained", freedom = described(&freedom));
            ui.colored_label(theme.warning, text);
        } else {
            let (shift, turn) = (units.length(bounds.shift.0), units.angle(bounds.turn.0));
            let value = format!("{shift} · {turn}");
            let names = [
                text!("inspect-pose-uncertainty"),
                text!("robot-uncertainty"),
                "95 %".to_owned(),
            ];
            let width = |text: &str| {
                let laid_out = ui
                    .painter()
                    .layout_no_wrap(text.into(), font::body(), theme.text);
                laid_out.size().x
            };
            let room = ui.available_width() - width(&value) - 2.0 * space::SMALL;
            let fits = |name: &&String| width(name) <= room;
            let name = names.iter().find(fits).unwrap_or(&names[2]);
            row(ui, name, &value);
        }
    }
    if let Some(runner_up) = pose.runner_up {
        // What rounds to 1.0 times is not worse.
        let words = if runner_up.ratio < 1.05 {
            text!("inspect-as-good")
        } else {
            let ratio = format!("{:.1}", runner_up.ratio);
            text!("inspect-times-worse", ratio = ratio)
        };
        row(ui, &text!("inspect-runner-up"), &words);
    }
    let by = format!("{} · {}", described(&pose.stopped), pose.method.name());
    row(
        ui,
        &text!("inspect-iterations", num = pose.iterations.len()),
        &by,
    );
}

fn footer(ui: &mut Ui, inspected: &Inspected, session: &Session) {
    heading(ui, &text!("inspect-inspection"));
    let ms = inspected.inspection.timings.total.as_secs_f64() * 1000.0;
    row(ui, &text!("inspect-time"), &format!("{ms:.1} ms"));
    row(ui, &text!("inspect-scene"), &inspected.origin.shown_title());
    if inspected.origin.is_simulated() {
        row(ui, &text!("robot-camera"), &text!("inspect-simulated"));
    }
    for (name, text) in session.trace.of_part(inspected).known() {
        row(ui, &traced(name), &shortened(text, 28));
    }
    if session.role == UserRole::Engineer {
        let label = recipe_label(&inspected.recipe.label);
        row(ui, &text!("inspect-recipe"), &shortened(&label, 28));
    }
}

/// Draws the section; nothing without a stand-off.
fn stand_off(ui: &mut Ui, inspected: &Inspected, units: UnitSystem) {
    if let Some(path) = &inspected.spray {
        heading(ui, &text!("inspect-stand-off-stored"));
        return stored(ui, path, &inspected.recipe.stand_off, units);
    }
    let Some(found) = &inspected.stand_off else {
        return;
    };
    heading(ui, &text!("inspect-stand-off"));
    match found {
        Ok(found) => figures(ui, found, &inspected.recipe.stand_off, units),
        Err(error) => {
            ui.weak(sentence(&described(error)));
        }
    }
}

/// Draws the figures of the stored path, which has the part's pose, at the points where the camera sees the part.
fn stored(ui: &mut Ui, path: &CarriedPath, params: &StandOffParams, units: UnitSystem) {
    let met: Vec<SurfaceHit> = path.points.iter().filter_map(|point| point.meets).collect();
    let middle = f64::midpoint(params.nearest.0, params.farthest.0);
    let error = |distance: &f64| (distance - middle).abs();
    let distances = met.iter().map(|hit| hit.distance.0);
    let Some(worst) = distances.max_by(|a, b| error(a).total_cmp(&error(b))) else {
        ui.weak(text!("inspect-path-not-seen"));
        return;
    };
    let mean = |of: fn(&SurfaceHit) -> f64| met.iter().map(of).sum::<f64>() / met.len() as f64;
    distance_rows(ui, [mean(|hit| hit.distance.0), worst], params, units);
    let inside = text!(
        "inspect-points-in-band",
        inside = path.num_inside(),
        num = path.num_seen()
    );
    row(ui, &text!("inspect-in-band"), &inside);
    let num_unseen = path.count(BandStatus::NotSeen);
    if num_unseen > 0 {
        let text = text!(
            "inspect-points-not-seen",
            count = num_unseen,
            all = path.points.len()
        );
        ui.label(RichText::new(text).small().color(Theme::of(ui).warning));
    }
    let steepest = met.iter().map(|hit| hit.tilt.0).fold(0.0, f64::max);
    angle_row(ui, [mean(|hit| hit.tilt.0), steepest], units);
    let angle_counts = text!(
        "inspect-angle-counts",
        count = met.iter().filter(|hit| hit.tilt > MOST_TILT).count(),
        limit = units.angle(MOST_TILT.0)
    );
    ui.label(RichText::new(angle_counts).small().weak());
}

fn distance_rows(ui: &mut Ui, [mean, worst]: [f64; 2], params: &StandOffParams, units: UnitSystem) {
    bar(ui, [mean, worst], params, units);
    let pair = text!(
        "inspect-worst-of",
        value = units.length(mean),
        worst = units.length(worst)
    );
    row(ui, &text!("inspect-mean"), &pair);
}

fn angle_row(ui: &mut Ui, [mean, worst]: [f64; 2], units: UnitSystem) {
    let pair = text!(
        "inspect-worst-of",
        value = units.angle(mean),
        worst = units.angle(worst)
    );
    row(ui, &text!("inspect-angle"), &pair);
}

fn figures(ui: &mut Ui, found: &StandOff, params: &StandOffParams, units: UnitSystem) {
    let distances = [found.mean.0, found.worst.distance.0];
    distance_rows(ui, distances, params, units);
    row(
        ui,
        &text!("inspect-in-band"),
        &format!("{:.0} %", found.in_band * 100.0),
    );
    angle_row(ui, [found.mean_angle.0, found.worst_angle.0], units);
    // Parts rarely hang as taught: that the path has to follow the pose is usual, and no fault of the part.
    let text = if found.keeps_the_band() {
        text!("inspect-path-fits")
    } else {
        text!("inspect-path-needs-pose")
    };
    ui.label(RichText::new(text).small().weak());
}

/// Draws a range of distances with the band in its middle third: a full tick for the mean, a short one for the worst.
fn bar(ui: &mut Ui, [mean, worst]: [f64; 2], params: &StandOffParams, units: UnitSystem) {
    const BAR: f32 = 14.0;
    const NUMBERS: f32 = 15.0;
    let theme = Theme::of(ui);
    let (near, far) = (params.nearest.0 as f32, params.farthest.0 as f32);
    let wide = (far - near).max(1e-3);
    let size = vec2(ui.available_width(), BAR + space::SMALL + NUMBERS);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let text = text!(
        "inspect-stand-off-of",
        mean = units.length(mean),
        nearest = units.length(params.nearest.0),
        farthest = units.length(params.farthest.0)
    );
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &text));
    let painter = ui.painter();
    let bar = Rect::from_min_size(rect.min + vec2(0.0, 3.0), vec2(rect.width(), BAR));
    let across = Scale::new([near - wide, far + wide], [bar.left(), bar.right()]);
    painter.rect_filled(bar, ROUNDING, theme.track);
    let band = Rect::from_x_y_ranges(across.at(near)..=across.at(far), bar.y_range());
    painter.rect_filled(band, 0.0, theme.accepted.gamma_multiply(0.45));
    // Clamp distances beyond the bar to its end.
    let tick = |distance: f64, width: f32, over: f32, colour| {
        let x = across.at(distance as f32);
        let x = x.clamp(bar.left() + width, bar.right() - width);
        let line = Rect::from_center_size(pos2(x, bar.center().y), vec2(width, BAR + over));
        painter.rect_filled(line, 0.0, colour);
    };
    tick(worst, 2.0, -4.0, theme.weak_text);
    tick(mean, 3.0, 5.0, theme.text);
    for end in [near, far] {
        let text = units.length(f64::from(end));
        let at = pos2(across.at(end), bar.bottom() + 4.0);
        painter.text(at, Align2::CENTER_TOP, text, font::small(), theme.weak_text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shell::inspection::{inspected::inspected_cell, source::CellChoice};

    #[test]
    fn the_next_part_is_not_another_reference_of_the_same_part() {
        let mut found = inspected_cell(CellChoice::InTurn, 1);
        let [first, second, third, ..] = &mut found.inspection.ranking.entries[..] else {
            panic!("few parts");
        };
        second.part.clone_from(&first.part);
        "front_door_b".clone_into(&mut second.enrolled_as);
        "front_door_b".clone_into(&mut found.figures.candidates[1].title);
        let next = found.library.title_of(&third.part);
        let expected = format!("Next: {next} {:.2}", third.score);
        let headline = Headline::of(&found, &Session::default());
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let output = ctx.run_ui(egui::RawInput::default(), |ui| score(ui, &found, &headline));
        let written = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
            egui::Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        });
        let written: Vec<String> = written.collect();
        output.drop_without_applying_deltas();
        assert!(written.contains(&expected), "{written:?}");
    }
}
