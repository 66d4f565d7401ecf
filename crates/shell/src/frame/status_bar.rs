//! The status bar at the foot of the window, the same in both views: source, calibration, robots, motion, age of the frame on the
//! screen, speed of this computer and, if a trend will refuse parts, drift. Each has a tooltip with the next step, and a click leads
//! to where it is done.

use std::{
    f32::consts::{FRAC_PI_4, PI},
    time::{Duration, SystemTime},
};

use egui::{
    Align2, Color32, Margin, Painter, Panel, Popup, Pos2, Rect, Role, Sense, Stroke, StrokeKind,
    Ui, Vec2, WidgetInfo, pos2, vec2,
};

use crate::{
    action::{Action, Event},
    cell::{
        RobotAction, RobotCell, RobotPage,
        answering::{clock, in_words},
        operators_warning,
    },
    language::drift_warning,
    session::{Session, UserRole, WorkspaceKind},
    source::{
        live::{self, LiveAction, SourceState},
        source_menu,
    },
    state::State,
};
use robot::calibration::Origin;
use station::Doubt;
use ui::{
    language::{advised, described, text},
    theme::{Theme, font, space},
    widgets::{Mark, fitted_middle, fixed_panel, focus_ring, mark, pad_entries, text_width},
};

/// Height of the bar with the line above it, logical pixels.
const HEIGHT_PX: f32 = space::TARGET + 2.0;
/// Margins of the bar.
const MARGIN: Margin = Margin::symmetric(14, 0);
/// Width of an icon with the space around it, logical pixels.
const ICON_WIDTH_PX: f32 = 30.0;
/// Least room for a word, logical pixels: with less, an item is its icon alone.
const MIN_WORD_PX: f32 = 40.0;
/// Half the side of an icon, logical pixels.
const ICON_RADIUS_PX: f32 = 7.5;
/// Radius of the mark beside the icon of what needs attention, logical pixels.
const MARK_RADIUS_PX: f32 = 5.0;

/// What an item of the bar is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Topic {
    Source,
    Calibration,
    Robots,
    Motion,
    Age,
    Speed,
    Drift,
}

impl Topic {
    /// Share of the bar's width, so that no item moves when the words of another change.
    fn share(self) -> f32 {
        match self {
            Self::Source => 1.6,
            Self::Robots => 1.3,
            Self::Calibration => 1.2,
            Self::Motion => 1.1,
            Self::Speed | Self::Drift => 0.8,
            Self::Age => 0.7,
        }
    }
}

/// An item of the bar.
#[derive(Clone, Debug)]
struct Item {
    topic: Topic,
    /// Good, known and runs: all is well; open: not known, or not in use.
    mark: Mark,
    /// A few letters beside the icon.
    word: String,
    /// The state as a sentence.
    says: String,
    /// Details and the next step, a line each; may be empty.
    next: Vec<String>,
    /// What a click does; nothing where nothing is to be done. A click on the source opens its menu.
    action: Option<Action>,
}

impl Item {
    fn new(topic: Topic, mark: Mark, word: String, says: String) -> Self {
        Self {
            topic,
            mark,
            word,
            says,
            next: Vec::new(),
            action: None,
        }
    }

    /// Adds a detail or the next step.
    fn then(mut self, line: String) -> Self {
        self.next.extend(Some(line).filter(|line| !line.is_empty()));
        self
    }

    fn leads_to(self, action: Option<Action>) -> Self {
        Self { action, ..self }
    }

    fn is_pressable(&self) -> bool {
        self.action.is_some() || self.topic == Topic::Source
    }

    fn tooltip(&self) -> String {
        let lines = [&self.says].into_iter().chain(&self.next);
        lines.map(String::as_str).collect::<Vec<_>>().join("\n")
    }
}

/// What the bar shows.
#[derive(Clone, Debug)]
struct StatusBar {
    items: Vec<Item>,
}

impl StatusBar {
    /// The state of everything at this moment.
    fn of(session: &Session, robot: &RobotCell) -> Self {
        let items = [
            Some(source(session)),
            Some(calibration(session, robot)),
            Some(robots(session, robot)),
            Some(motion(session)),
            Some(age(session)),
            Some(speed(session)),
            drift(session),
        ];
        Self {
            items: items.into_iter().flatten().collect(),
        }
    }
}

fn source(session: &Session) -> Item {
    let name = source_menu::now(&session.source);
    let says = text!("shell-source-button", source = &name);
    let with = |mark, what: String| {
        let says = format!("{says}: {what}");
        Item::new(Topic::Source, mark, what, says)
    };
    let item = match live::source_state(session) {
        // An operator reads in the banner what to do.
        Some(SourceState::Lost(error)) if session.role == UserRole::Engineer => {
            with(Mark::Bad, text!("live-lost"))
                .then(error.what.clone())
                .then(error.advice.clone())
        }
        Some(SourceState::Lost(_)) => with(Mark::Bad, text!("live-lost")),
        Some(SourceState::Opening) => with(Mark::Open, text!("live-opening")),
        Some(SourceState::Running) => Item::new(Topic::Source, Mark::Runs, name, says),
        None => Item::new(Topic::Source, Mark::Open, name, says),
    };
    item.then(text!("shell-source-says"))
}

fn calibration(session: &Session, robot: &RobotCell) -> Item {
    let new = |mark, word, says| Item::new(Topic::Calibration, mark, word, says);
    let item = match (&session.robot, robot.in_use()) {
        (Some(frame), Some(in_use)) => {
            let calibration = &in_use.calibration;
            let kind = match calibration.origin {
                Origin::ByHand => text!("robot-entered-by-hand"),
                Origin::HandEye(_) => text!("shell-status-from-pairs"),
            };
            let age = written_age(age_of(calibration.made_at.into()));
            let name = match calibration.name.as_str() {
                "" => kind.as_str(),
                name => name,
            };
            let says = text!("shell-calibrated-by", name = described(&frame.name));
            let made = text!("shell-status-made-ago", kind = &kind, age = &age);
            new(Mark::Runs, format!("{name} · {age}"), says).then(made)
        }
        (Some(frame), None) => {
            let name = described(&frame.name);
            let says = text!("shell-calibrated-by", name = &name);
            new(Mark::Runs, name, says)
        }
        (None, Some(in_use)) if in_use.is_edited => new(
            Mark::Look,
            text!("shell-status-edited"),
            text!("shell-calibration-edited"),
        )
        .then(text!("robot-edited-advice")),
        (None, Some(_)) => new(
            Mark::Look,
            text!("shell-status-no-flange-pose"),
            text!("shell-no-flange-pose"),
        ),
        (None, None) => new(
            Mark::Open,
            text!("shell-status-not-calibrated"),
            text!("shell-not-calibrated"),
        ),
    };
    item.leads_to(Some(Action::Robot(RobotAction::Show(RobotPage::InUse))))
}

fn robots(session: &Session, robot: &RobotCell) -> Item {
    let answering = robot.answering();
    let item = match answering.words(session) {
        None => Item::new(
            Topic::Robots,
            Mark::Open,
            text!("shell-status-robots-off"),
            text!("shell-status-robots-off-says"),
        ),
        Some((mark, words)) => {
            let last = answering.status().and_then(|status| status.last.as_ref());
            let word = match (mark, last) {
                (Mark::Bad, _) => text!("shell-status-not-answered"),
                (Mark::Look, _) => text!("shell-status-no-frames"),
                (Mark::Open, _) => text!("shell-status-robots-start"),
                (_, Some(last)) => format!("{} {}", clock(last.at), last.answer.verdict.name()),
                (_, None) => text!("shell-status-listens"),
            };
            // The operator's view shows the same words in large letters.
            let warning = operators_warning(session).filter(|_| session.role == UserRole::Operator);
            let (says, advice) = match warning {
                Some(warning) => (warning, String::new()),
                None => (words, answering.advice(session)),
            };
            let item = Item::new(Topic::Robots, mark, word, says);
            let problem = answering.problem().map(|problem| problem.what.clone());
            let last = match (answering.status(), last) {
                (None, _) => String::new(),
                (Some(_), None) => text!("robot-no-trigger"),
                (Some(_), Some(last)) => {
                    text!("shell-status-last-answer", answer = in_words(last))
                }
            };
            item.then(problem.unwrap_or_default())
                .then(advice)
                .then(last)
        }
    };
    item.leads_to(Some(Action::Robot(RobotAction::Show(RobotPage::Answer))))
}

fn motion(session: &Session) -> Item {
    let new = |mark, word, says| Item::new(Topic::Motion, mark, word, says);
    if !session.is_live() {
        let can_follow = session.source.followed().is_some();
        let off = new(
            Mark::Open,
            text!("shell-status-live-off"),
            text!("shell-status-live-off-says"),
        );
        return off
            .then(text!("shell-live-says"))
            .leads_to(can_follow.then_some(Action::Live(LiveAction::Toggle)));
    }
    let is_elsewhere = session.workspace != WorkspaceKind::Inspect;
    let item = match live::motion(session) {
        Some((mark, what)) => {
            let says = format!("{} · {what}", live::name(&session.source));
            new(mark, what, says)
        }
        None => new(Mark::Open, "–".into(), text!("shell-status-motion-unknown")),
    };
    item.leads_to(is_elsewhere.then_some(Action::GoTo(WorkspaceKind::Inspect)))
}

fn age(session: &Session) -> Item {
    let new = |mark, word, says| Item::new(Topic::Age, mark, word, says);
    let capture = (!session.is_live()).then_some(Action::Capture);
    let Some(inspected) = session.latest(|_| true) else {
        return new(Mark::Open, "–".into(), text!("shell-status-no-frame")).leads_to(capture);
    };
    let age = written_age(age_of(inspected.captured_at));
    let says = text!("shell-status-frame-age", age = &age);
    let item = match session.currency(inspected) {
        Some(doubt @ (Doubt::Old | Doubt::ClockAhead(_) | Doubt::SourceLost)) => {
            new(Mark::Look, age, says)
                .then(described(&doubt))
                .then(advised(&doubt))
        }
        _ => new(Mark::Runs, age, says),
    };
    item.leads_to(capture)
}

fn speed(session: &Session) -> Item {
    let new = |mark, word, says| Item::new(Topic::Speed, mark, word, says);
    let status = session.live.status.as_ref().filter(|_| session.is_live());
    let Some((status, rate)) = status.and_then(|status| Some((status, status.inspection_rate?)))
    else {
        return new(Mark::Open, "–".into(), text!("shell-status-speed-unknown"));
    };
    let (inspected, frames) = (rate.num_inspected, rate.num_frames);
    let says = text!("shell-status-speed", inspected = inspected, frames = frames);
    let is_slow = rate.is_slow() || status.held_up_by.is_some();
    let mark = if is_slow { Mark::Look } else { Mark::Runs };
    let item = new(mark, format!("{inspected}/{frames}"), says).then(live::figures(status));
    if !is_slow {
        return item;
    }
    let to_recipes = Action::GoTo(WorkspaceKind::Compare);
    item.then(advised(&rate.refusal(String::new())))
        .leads_to(Some(to_recipes))
}

/// `None` unless a trend will refuse parts.
fn drift(session: &Session) -> Option<Item> {
    let all = session.shift.drifting.iter();
    let first = all.min_by_key(|part| part.warning.refuses_in)?;
    let warning = drift_warning(&first.title, &first.warning, session.units);
    let item = Item::new(
        Topic::Drift,
        Mark::Look,
        text!("shell-status-drift"),
        warning.what,
    );
    let to_statistics = Action::Tell(Event::Drift(first.part.clone()));
    Some(item.then(warning.advice).leads_to(Some(to_statistics)))
}

/// Time since then; zero for a moment that is still to come.
fn age_of(at: SystemTime) -> Duration {
    SystemTime::now().duration_since(at).unwrap_or_default()
}

/// Writes an age in the largest unit that it fills.
fn written_age(age: Duration) -> String {
    const MINUTE: u64 = 60;
    const HOUR: u64 = 60 * MINUTE;
    const DAY: u64 = 24 * HOUR;
    match age.as_secs() {
        0..10 => format!("{:.1} s", age.as_secs_f64()),
        seconds @ 10..MINUTE => format!("{seconds} s"),
        seconds @ MINUTE..HOUR => format!("{} min", seconds / MINUTE),
        seconds @ HOUR..DAY => format!("{} h", seconds / HOUR),
        seconds => text!("shell-days", num = seconds / DAY),
    }
}

/// Draws the bar, below everything else.
pub fn ui(ui: &mut Ui, state: &State, robot: &RobotCell, actions: &mut Vec<Action>) {
    let bar = StatusBar::of(&state.session, robot);
    let panel = Panel::bottom("status bar").exact_size(HEIGHT_PX);
    fixed_panel(ui, panel, MARGIN, |ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.horizontal_centered(|ui| {
            let shares: f32 = bar.items.iter().map(|item| item.topic.share()).sum();
            let per_share = ui.available_width().max(0.0) / shares;
            for item in bar.items {
                let size = vec2(item.topic.share() * per_share, space::TARGET);
                let response = draw(ui, &item, size);
                if item.topic == Topic::Source {
                    Popup::menu(&response).show(|ui| {
                        pad_entries(ui);
                        source_menu::ui(ui, state, actions);
                    });
                }
                let is_pressed = response.clicked();
                response.on_hover_text(item.tooltip());
                actions.extend(item.action.filter(|_| is_pressed));
            }
        });
    });
    look_again(ui, &state.session);
}

/// Draws the window again when the age on it changes.
fn look_again(ui: &Ui, session: &Session) {
    let Some(inspected) = session.latest(|_| true) else {
        return;
    };
    let is_young = age_of(inspected.captured_at) < Duration::from_mins(1);
    let after = Duration::from_secs(if is_young { 1 } else { 15 });
    ui.ctx().request_repaint_after(after);
}

fn draw(ui: &mut Ui, item: &Item, size: Vec2) -> egui::Response {
    let theme = Theme::of(ui);
    let is_pressable = item.is_pressable();
    let sense = if is_pressable {
        Sense::click()
    } else {
        Sense::hover()
    };
    let (rect, response) = ui.allocate_exact_size(size, sense);
    let (role, says) = match item.topic {
        Topic::Source => (Role::Button, format!("{} ▼", item.says)),
        _ if is_pressable => (Role::Button, item.says.clone()),
        _ => (Role::Label, item.says.clone()),
    };
    response.widget_info(|| WidgetInfo::labeled(role, true, &says));
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    if is_pressable && response.hovered() {
        painter.rect_filled(rect, 0.0, theme.control_hovered);
    }
    let colour = colour(item.mark, theme);
    let centre = pos2(rect.left() + ICON_WIDTH_PX / 2.0, rect.center().y);
    icon(&painter, item.topic, centre, Stroke::new(1.5, colour));
    // Colour alone must not tell that something needs attention.
    if matches!(item.mark, Mark::Look | Mark::Bad) {
        let at = centre + Vec2::splat(ICON_RADIUS_PX - 1.0);
        painter.circle_filled(at, MARK_RADIUS_PX + 1.5, theme.panel);
        mark(&painter, at, MARK_RADIUS_PX, item.mark, theme);
    }
    let room = rect.width() - ICON_WIDTH_PX - space::SMALL;
    if room >= MIN_WORD_PX {
        let sign = match item.topic {
            Topic::Source => " ▼",
            _ => "",
        };
        let font = font::body();
        let room = room - text_width(&painter, sign, &font);
        let word = fitted_middle(&painter, &item.word, &font, room);
        let at = pos2(rect.left() + ICON_WIDTH_PX, rect.center().y);
        let word = format!("{word}{sign}");
        painter.text(at, Align2::LEFT_CENTER, word, font, colour);
    }
    focus_ring(ui, rect, &response);
    response
}

/// Green would be a verdict.
fn colour(mark: Mark, theme: &Theme) -> Color32 {
    match mark {
        Mark::Good | Mark::Known | Mark::Runs => theme.text,
        Mark::Open | Mark::Look | Mark::Bad => mark.colour(theme),
    }
}

/// Draws what an item is about.
fn icon(painter: &Painter, topic: Topic, centre: Pos2, stroke: Stroke) {
    let at = |x: f32, y: f32| centre + vec2(x, y) * ICON_RADIUS_PX;
    let line = |points: &[[f32; 2]]| {
        let points = points.iter().map(|[x, y]| at(*x, *y));
        painter.line(points.collect(), stroke);
    };
    match topic {
        // A camera.
        Topic::Source => {
            let body = Rect::from_min_max(at(-1.0, -0.65), at(1.0, 0.75));
            painter.rect_stroke(body, 1.5, stroke, StrokeKind::Middle);
            painter.circle_stroke(at(0.0, 0.05), 0.4 * ICON_RADIUS_PX, stroke);
        }
        // The axes of a frame.
        Topic::Calibration => {
            line(&[[-0.5, -1.0], [-0.5, 0.5], [1.0, 0.5]]);
            line(&[[-0.5, 0.5], [-1.0, 1.0]]);
        }
        // An arm.
        Topic::Robots => {
            line(&[[-0.8, 0.9], [-0.4, -0.5], [0.6, -0.8], [0.9, 0.1]]);
            line(&[[-1.0, 0.95], [-0.3, 0.95]]);
            painter.circle_filled(at(-0.4, -0.5), 2.2, stroke.color);
            painter.circle_filled(at(0.6, -0.8), 2.2, stroke.color);
        }
        // To and fro.
        Topic::Motion => {
            line(&[[-1.0, 0.0], [1.0, 0.0]]);
            line(&[[-0.5, -0.5], [-1.0, 0.0], [-0.5, 0.5]]);
            line(&[[0.5, -0.5], [1.0, 0.0], [0.5, 0.5]]);
        }
        // A clock.
        Topic::Age => {
            painter.circle_stroke(centre, ICON_RADIUS_PX, stroke);
            line(&[[0.0, -0.6], [0.0, 0.0], [0.45, 0.25]]);
        }
        // A gauge.
        Topic::Speed => {
            let rim = (0_u8..=12).map(|step| {
                let turn = PI - FRAC_PI_4 + f32::from(step) / 12.0 * 1.5 * PI;
                [turn.cos(), turn.sin()]
            });
            line(&rim.collect::<Vec<_>>());
            line(&[[0.0, 0.1], [0.5, -0.45]]);
        }
        // A value that falls.
        Topic::Drift => {
            line(&[[-1.0, -0.7], [-0.3, -0.2], [0.1, -0.3], [0.9, 0.7]]);
            line(&[[0.25, 0.75], [0.9, 0.7], [0.9, 0.1]]);
        }
    }
}

#[cfg(test)]
mod tests {
    use egui::{RawInput, Shape};

    use super::*;
    use crate::{session::DriftingPart, source::live::LiveStatus};
    use inspection::pipeline::live::{InspectionRate, LiveVerdict};
    use records::history::{DriftQuantity, DriftWarning};
    use ui::{language::Language, task::TaskRunner, theme::ThemeChoice};

    fn robot() -> RobotCell {
        RobotCell::new(None, &TaskRunner::without_threads())
    }

    fn item(session: &Session, topic: Topic) -> Item {
        let bar = StatusBar::of(session, &robot());
        let found = bar.items.into_iter().find(|item| item.topic == topic);
        found.expect("in the bar")
    }

    /// A session that follows a source, of which so many frames in a second are inspected.
    fn inspecting(num_inspected: usize) -> Session {
        let mut session = Session::default();
        session.live.is_on = true;
        session.live.status = Some(LiveStatus {
            source: SourceState::Running,
            stillness: None,
            standing: LiveVerdict::Open,
            rates: [None; 2],
            latency: Some(Duration::from_millis(480)),
            inspection_rate: Some(InspectionRate {
                num_inspected,
                num_frames: 30,
            }),
            held_up_by: None,
            num_inspected: 8,
            num_dropped: 0,
            num_averaged: 1,
            recorded: None,
        });
        session
    }

    #[test]
    fn a_slow_computer_is_named_with_its_rate_what_to_do_and_where() {
        let slow = item(&inspecting(2), Topic::Speed);
        assert_eq!((slow.mark, &*slow.word), (Mark::Look, "2/30"));
        let tooltip = slow.tooltip();
        for part in ["2 of 30 frames", "480 ms", "another recipe"] {
            assert!(tooltip.contains(part), "{tooltip}");
        }
        let leads_to = &slow.action;
        assert!(matches!(
            leads_to,
            Some(Action::GoTo(WorkspaceKind::Compare))
        ));
        let fast = item(&inspecting(20), Topic::Speed);
        assert_eq!((fast.mark, &*fast.word), (Mark::Runs, "20/30"));
        assert!(!fast.is_pressable());
        let off = item(&Session::default(), Topic::Speed);
        assert_eq!((off.mark, &*off.word), (Mark::Open, "–"));
    }

    #[test]
    fn a_lost_source_is_named_in_both_views_and_its_motion_is_not_known() {
        let mut session = inspecting(20);
        let status = session.live.status.as_mut().expect("live");
        status.source = SourceState::Lost(ui::user_error::UserError {
            what: "the cable is out".into(),
            advice: "Plug it in".into(),
        });
        for role in [UserRole::Engineer, UserRole::Operator] {
            session.role = role;
            let source = item(&session, Topic::Source);
            assert_eq!(
                (source.mark, &*source.word),
                (Mark::Bad, "lost, reconnecting")
            );
            let names_cause = source.tooltip().contains("the cable is out\nPlug it in");
            assert_eq!(names_cause, role == UserRole::Engineer);
            assert_eq!(item(&session, Topic::Motion).mark, Mark::Open);
        }
    }

    #[test]
    fn robots_that_get_no_pose_lead_to_their_page_in_both_views() {
        let mut session = Session::default();
        assert_eq!(item(&session, Topic::Robots).mark, Mark::Open);
        session.answering.is_on = true;
        for role in [UserRole::Engineer, UserRole::Operator] {
            session.role = role;
            let robots = item(&session, Topic::Robots);
            assert_eq!((robots.mark, &*robots.word), (Mark::Bad, "not answered"));
            assert!(robots.tooltip().to_lowercase().contains("calibrate"));
            let page = RobotPage::Answer;
            assert!(
                matches!(robots.action, Some(Action::Robot(RobotAction::Show(shown))) if shown == page)
            );
        }
    }

    #[test]
    fn of_several_drifts_the_one_that_refuses_first_is_told_and_leads_to_its_statistics() {
        let mut session = Session::default();
        for (part, refuses_in) in [("fender", 40), ("grille", 12), ("hood", 60)] {
            session.shift.drifting.push(DriftingPart {
                part: part.into(),
                title: part.to_uppercase(),
                warning: DriftWarning {
                    quantity: DriftQuantity::Score,
                    limit: 0.9,
                    refuses_in,
                },
            });
        }
        let drift = item(&session, Topic::Drift);
        assert_eq!(drift.mark, Mark::Look);
        assert!(drift.says.starts_with("GRILLE drifts"), "{}", drift.says);
        assert!(drift.says.contains("after 12 more"), "{}", drift.says);
        assert!(
            matches!(&drift.action, Some(Action::Tell(Event::Drift(part))) if part == "grille")
        );
    }

    /// The texts of the bar in a window of this width.
    fn words(width: f32) -> Vec<String> {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        Theme::install(ThemeChoice::default(), &ctx);
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(width, 768.0))),
            ..RawInput::default()
        };
        let state = State::default();
        let output = ctx.run_ui(input, |root| ui(root, &state, &robot(), &mut Vec::new()));
        let texts = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
            Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        });
        let texts = texts.collect();
        output.drop_without_applying_deltas();
        texts
    }

    #[test]
    fn every_word_fits_a_small_window_in_every_language_and_icons_outlast_words() {
        for language in Language::ALL {
            language.make_current();
            let shown = words(1024.0);
            let all = [
                "shell-status-not-calibrated",
                "shell-status-robots-off",
                "shell-status-live-off",
            ];
            let all = all.map(ui::language::plain);
            Language::English.make_current();
            for word in all {
                assert!(
                    shown.contains(&word),
                    "{language:?}: no {word} in {shown:?}"
                );
            }
            assert!(!shown.iter().any(|word| word.contains('…')), "{shown:?}");
        }
        assert!(words(300.0).is_empty());
    }

    #[test]
    fn an_age_is_written_in_the_largest_unit_that_it_fills() {
        let ages = [0.42, 12.9, 60.0, 7199.0, 86_400.0, 3e5];
        let written = ages.map(|seconds| written_age(Duration::from_secs_f64(seconds)));
        assert_eq!(
            written,
            ["0.4 s", "12 s", "1 min", "1 h", "1 day", "3 days"]
        );
    }
}
