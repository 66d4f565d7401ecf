//! The language of the window: it can be chosen, and all texts fit in every language.

use app::{
    WindowOptions,
    workspaces::{
        enrol::{
            EnrolAction, EnrolWorkspace,
            draft::Field,
            meshes::{MeshAction, MeshOrder},
        },
        history::{HistoryAction, HistoryWorkspace, ListFilter},
    },
};
use egui::{
    Rect, Shape, Vec2,
    epaint::{ClippedShape, TextShape},
    vec2,
};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use records::history::{Retention, StoredVerdict};
use shell::{
    action::Action,
    cell::{CheckAction, RobotAction, RobotPage},
    rack::RackAction,
    roles::RoleAction,
    session::{PaintTab, WorkspaceKind},
    source::live::{LiveAction, SourceState},
};
use ui::{language::Language, theme::space};

use super::{
    enrol::meshes::write_car,
    live::{Step, sees, wired_options},
    set_up::{
        SMALL, USUAL, WindowHarness, act, act_in, drop_file, enrol_of, open_with, plain_options,
        press, settle, wait_until,
    },
};
use records::fixtures::{history_entry, low_score, refuse};

fn open_in(language: Language, size: Vec2) -> WindowHarness {
    let options = WindowOptions {
        language: Some(language),
        ..plain_options()
    };
    open_with(size, options)
}

#[test]
fn the_language_is_the_systems_until_one_is_chosen_and_is_remembered() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = || WindowOptions {
        settings: Some(folder.path().join("settings.toml")),
        language: Some(Language::Spanish),
        ..plain_options()
    };
    let mut harness = open_with(USUAL, options());
    harness.get_by_label("Capturar");
    press(&mut harness, "Idioma: Español");
    press(&mut harness, "Deutsch");
    // The change is immediate, with the same result in front.
    harness.get_by_label("Aufnehmen");
    harness.get_by_label("Erkannt");
    harness.get_by_label("Simuliertes Bild 1");
    harness.key_press(egui::Key::Space);
    settle(&mut harness);
    harness.get_by_label("Simuliertes Bild 2");
    drop(harness);
    let harness = open_with(USUAL, options());
    harness.get_by_label("Aufnehmen");
}

#[test]
fn what_enrol_says_follows_the_language_of_the_window() {
    let library = tempfile::tempdir().expect("a folder");
    let options = WindowOptions {
        library: Some(library.path().to_owned()),
        language: Some(Language::Chinese),
        ..WindowOptions::default()
    };
    let mut harness = open_with(SMALL, options);
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    act(&mut harness, Action::Capture);
    let write = |harness: &mut WindowHarness, field: Field| {
        act_in(harness, |enrol: &mut EnrolWorkspace, cx| {
            enrol.state.apply(EnrolAction::Write(field), cx);
        });
    };
    harness.get_by_label("零件, 保留");
    write(&mut harness, Field::Title("右前 涂装".into()));
    let draft = enrol_of(&harness).draft.as_ref().expect("a draft");
    assert_eq!(draft.form.name, "part");
    write(&mut harness, Field::Name("Part".into()));
    press(&mut harness, "语言：中文");
    press(&mut harness, "Deutsch");
    harness.get_by_label("Teil, behalten");
    harness.get_by_label("\"Part\" ist kein gültiger Name: er enthält 'P'");
    write(&mut harness, Field::Name(String::new()));
    harness.get_by_label("Der Name ist leer");
    write(&mut harness, Field::Name("part".into()));
    press(&mut harness, "Speichern");
    press(&mut harness, "Sprache: Deutsch");
    press(&mut harness, "English");
    let card = harness.get_by_label("Enrolled: 右前 涂装");
    let value = card.accesskit_node().value();
    assert!(value.is_some_and(|value| value.starts_with("Saved, ")));
}

#[test]
fn the_operator_chooses_a_language_too() {
    let mut harness = open_in(Language::English, SMALL);
    act(&mut harness, Action::Role(RoleAction::Switch));
    press(&mut harness, "Language: English");
    press(&mut harness, "中文");
    harness.get_by_label("采集");
    press(&mut harness, "语言：中文");
    press(&mut harness, "English");
    harness.get_by_label("Capture");
}

#[test]
fn a_refusal_of_the_history_is_read_in_the_language_of_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    for (seconds, score) in [(1, 0.81), (2, 0.75)] {
        let mut entry = history_entry(seconds, StoredVerdict::Rejected, "fender");
        entry.record.summary.title = "Fender, left".into();
        refuse(&mut entry, low_score("fender", score));
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let options = WindowOptions {
        history: Some(folder.path().to_owned()),
        language: Some(Language::German),
        ..plain_options()
    };
    let mut harness = open_with(USUAL, options);
    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    press(
        &mut harness,
        "Prüfung 1: Nicht erkannt · am nächsten Fender, left, Nicht akzeptiert",
    );
    harness.get_by_label("Nicht erkannt · am nächsten Fender, left");
    harness.get_by_label_contains("Fender, left, hat den Score 0.81 ");
    harness.get_by_label_contains("Teil eingelernt");
    press(&mut harness, "Statistik");
    // In English this is "below the threshold".
    harness.get_by_label_contains("2 × Score u");
    // The counts stay; only the language changes.
    press(&mut harness, "Sprache: Deutsch");
    press(&mut harness, "Español");
    harness.get_by_label_contains("2 × Puntuación ");
}

#[test]
fn where_a_scene_came_from_is_read_and_found_in_the_language_of_the_window() {
    let mut harness = open_in(Language::German, USUAL);
    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    // Once in the list, which is painted, and once in the details.
    let drawn = texts(&harness);
    let titles = drawn
        .iter()
        .filter(|drawn| drawn.text == "Simuliertes Bild 1");
    assert_eq!(titles.count(), 2, "{drawn:?}");
    assert!(drawn.iter().all(|drawn| !drawn.text.contains("imulated")));
    harness.get_by_label("Simulierte Zelle");
    for (text, found) in [
        ("bild 1", "1 von 1 Eintrag"),
        ("bild 2", "0 von 1 Eintrag"),
        ("simulated", "1 von 1 Eintrag"),
    ] {
        let filter = ListFilter {
            text: text.into(),
            ..ListFilter::default()
        };
        act_in(&mut harness, |history: &mut HistoryWorkspace, cx| {
            history.apply(HistoryAction::Filter(filter), cx);
        });
        harness.get_by_label(found);
    }
}

/// A drawn text, in logical pixels.
#[derive(Clone, Debug)]
struct Drawn {
    text: String,
    /// Bounds of its letters.
    rect: Rect,
    /// Bounds of its lines.
    lines: Vec<Rect>,
    /// The visible region.
    clip: Rect,
    is_elided: bool,
    is_word_broken: bool,
}

/// A text that does not fit, and how.
#[derive(Clone, Debug)]
struct Misfit {
    what: &'static str,
    text: String,
    rect: Rect,
}

fn texts(harness: &WindowHarness) -> Vec<Drawn> {
    fn collect(shape: &Shape, clip: Rect, found: &mut Vec<Drawn>) {
        match shape {
            Shape::Text(text) if !text.galley.text().trim().is_empty() => found.push(Drawn {
                text: text.galley.text().to_owned(),
                rect: text.visual_bounding_rect(),
                lines: lines_of(text),
                clip,
                is_elided: text.galley.elided,
                is_word_broken: breaks_a_word(text),
            }),
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect(shape, clip, found)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    for ClippedShape {
        clip_rect, shape, ..
    } in &harness.output().shapes
    {
        collect(shape, *clip_rect, &mut found);
    }
    // Ignore texts that are scrolled out of view.
    found.retain(|drawn| drawn.rect.intersects(drawn.clip));
    found
}

/// Bounds of the lines of a text; the space between them is free.
fn lines_of(text: &TextShape) -> Vec<Rect> {
    let rows = text.galley.rows.iter();
    let lines = rows.map(|row| {
        row.rect_without_leading_space()
            .translate(text.pos.to_vec2())
    });
    lines
        .map(|line| line.shrink2(vec2(0.0, 0.2 * line.height())))
        .collect()
}

/// True if a line ends within a word of an alphabet.
fn breaks_a_word(text: &TextShape) -> bool {
    let lines: Vec<String> = text.galley.rows.iter().map(|row| row.text()).collect();
    let is_letter =
        |letter: Option<char>| letter.is_some_and(|c| c.is_alphabetic() && c < '\u{2e80}');
    let mut pairs = lines.windows(2);
    pairs.any(|pair| is_letter(pair[0].chars().last()) && is_letter(pair[1].chars().next()))
}

/// Bounds of the controls in the top bar that overlap one another.
fn overlapping_controls(harness: &WindowHarness) -> Vec<Rect> {
    let buttons = harness.query_all_by_role(egui::Role::Button);
    let rects: Vec<Rect> = buttons
        .map(|node| node.rect())
        .filter(|rect| rect.bottom() < 60.0)
        .collect();
    let pairs = (0..rects.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let both = pairs.map(|(i, j)| rects[i].intersect(rects[j]));
    both.filter(|both| both.width() > 1.0 && both.height() > 1.0)
        .collect()
}

/// Texts that end in an ellipsis, break within a word, are cut off at a side, or overlap each other.
fn misfits(harness: &WindowHarness) -> Vec<Misfit> {
    let texts = texts(harness);
    let mut found = Vec::new();
    let window = harness.ctx.content_rect();
    for (index, drawn) in texts.iter().enumerate() {
        let Drawn {
            text, rect, clip, ..
        } = drawn;
        let mut report = |what| {
            found.push(Misfit {
                what,
                text: text.clone(),
                rect: *rect,
            });
        };
        if drawn.is_elided {
            report("ends in an ellipsis");
        }
        if drawn.is_word_broken {
            report("breaks within a word");
        }
        let seen = clip.intersect(window);
        if rect.left() < seen.left() - 2.0 || rect.right() > seen.right() + 2.0 {
            report("is cut at a side");
        }
        if rect.top() < window.top() - 2.0 || rect.bottom() > window.bottom() + 2.0 {
            report("leaves the window");
        }
        let runs_into = |other: &&Drawn| {
            let overlaps = |own: &Rect, other: &Rect| {
                let both = own.intersect(*other).intersect(*clip);
                both.width() > 3.0 && both.height() > 3.0
            };
            // Texts of another clip region, such as a dialog's, have a background of their own.
            let mut lines = drawn.lines.iter();
            other.clip == *clip
                && lines.any(|own| other.lines.iter().any(|line| overlaps(own, line)))
        };
        if let Some(other) = texts[..index].iter().find(runs_into) {
            found.push(Misfit {
                what: "runs into another text",
                text: format!("{text} | {}", other.text),
                rect: *rect,
            });
        }
    }
    found.extend(
        overlapping_controls(harness)
            .into_iter()
            .map(|rect| Misfit {
                what: "is a control over another",
                text: String::new(),
                rect,
            }),
    );
    found
}

/// A view of the window to be checked.
#[derive(Clone, Copy, Debug)]
enum Scenery {
    Workspace(WorkspaceKind),
    PaintTab(PaintTab),
    Draft,
    Live,
    Operator,
    WrongPart,
    Help,
    Robot,
    RealRobot,
    Cell,
    Source,
    Library,
    Rack,
}

/// In this order in one window: a draft and Live change what the others show.
const SCENERIES: [Scenery; 21] = [
    Scenery::Workspace(WorkspaceKind::Enrol),
    Scenery::Workspace(WorkspaceKind::Compare),
    Scenery::Workspace(WorkspaceKind::Align),
    Scenery::Workspace(WorkspaceKind::Paint),
    Scenery::PaintTab(PaintTab::Regions),
    Scenery::PaintTab(PaintTab::Robot),
    Scenery::PaintTab(PaintTab::Film),
    Scenery::Workspace(WorkspaceKind::Servo),
    Scenery::RealRobot,
    Scenery::Workspace(WorkspaceKind::History),
    Scenery::Workspace(WorkspaceKind::Inspect),
    Scenery::Operator,
    Scenery::WrongPart,
    Scenery::Help,
    Scenery::Robot,
    Scenery::Cell,
    Scenery::Source,
    Scenery::Library,
    Scenery::Rack,
    Scenery::Draft,
    Scenery::Live,
];

/// Brings a view to the front.
fn arrange(harness: &mut WindowHarness, scenery: Scenery) {
    let go = |harness: &mut WindowHarness, to| act(harness, Action::GoTo(to));
    let menu = |harness: &mut WindowHarness, index: usize| {
        let menus = harness.query_all_by_label_contains("▼");
        menus.into_iter().nth(index).expect("a menu").click();
        harness.run_steps(8);
    };
    match scenery {
        Scenery::Workspace(workspace) => go(harness, workspace),
        Scenery::PaintTab(tab) => {
            go(harness, WorkspaceKind::Paint);
            act(harness, Action::ShowPaintTab(tab));
        }
        Scenery::Draft => {
            go(harness, WorkspaceKind::Enrol);
            act(harness, Action::Capture);
        }
        Scenery::Live => {
            let context = harness.ctx.clone();
            let toggle = Action::Live(LiveAction::Toggle);
            harness.state_mut().act(toggle, &context);
            for _ in 0..40 {
                std::thread::sleep(std::time::Duration::from_millis(10));
                harness.step();
            }
        }
        Scenery::Operator => act(harness, Action::Role(RoleAction::Switch)),
        Scenery::WrongPart => {
            act(harness, Action::Role(RoleAction::Switch));
            act(harness, Action::WrongPart);
        }
        Scenery::Help => act(harness, Action::ToggleHelp),
        Scenery::Robot => act(harness, Action::Robot(RobotAction::Toggle)),
        Scenery::RealRobot => {
            go(harness, WorkspaceKind::Servo);
            press(harness, "KUKA");
        }
        Scenery::Cell => {
            let spec = capture::SimulatedSpec::default();
            act(harness, Action::Live(LiveAction::SetUp(Some(spec))));
        }
        Scenery::Source => menu(harness, 0),
        Scenery::Library => menu(harness, 1),
        Scenery::Rack => act(harness, Action::Rack(RackAction::Toggle)),
    }
}

/// Closes what [`arrange`] opened over the window, and returns to Inspect.
fn leave(harness: &mut WindowHarness, scenery: Scenery) {
    match scenery {
        Scenery::Operator | Scenery::WrongPart => {
            act(harness, Action::Role(RoleAction::Switch));
            // Yes, to the engineer's view.
            harness.key_press(egui::Key::Enter);
            settle(harness);
        }
        Scenery::Help | Scenery::Robot | Scenery::Rack => arrange(harness, scenery),
        Scenery::Cell => act(harness, Action::Live(LiveAction::SetUp(None))),
        Scenery::Source | Scenery::Library => {
            harness.key_press(egui::Key::Escape);
            settle(harness);
        }
        Scenery::Workspace(_)
        | Scenery::PaintTab(_)
        | Scenery::RealRobot
        | Scenery::Draft
        | Scenery::Live => {
            act(harness, Action::GoTo(WorkspaceKind::Inspect));
        }
    }
}

/// Descriptions of the misfits that are not near one of the English window.
fn only_here(mut found: Vec<Misfit>, usual: &[Misfit]) -> Vec<String> {
    found.retain(|misfit| {
        let is_it = |known: &Misfit| {
            known.what == misfit.what && known.rect.expand(24.0).intersects(misfit.rect)
        };
        !usual.iter().any(is_it)
    });
    let in_words = |Misfit { what, text, rect }| format!("{text:?} {what} at {rect:?}");
    found.into_iter().map(in_words).collect()
}

#[test]
fn in_every_language_everything_fits_where_it_does_in_english() {
    let misfits_in = |language: Language| {
        let mut harness = open_in(language, SMALL);
        SCENERIES.map(|scenery| {
            arrange(&mut harness, scenery);
            let found = misfits(&harness);
            // Live never settles.
            if !matches!(scenery, Scenery::Live) {
                leave(&mut harness, scenery);
            }
            found
        })
    };
    let usual = misfits_in(Language::English);
    let mut wrong = Vec::new();
    for language in [Language::German, Language::Spanish, Language::Chinese] {
        let found = misfits_in(language).into_iter();
        for ((found, usual), scenery) in found.zip(&usual).zip(SCENERIES) {
            let found = only_here(found, usual).into_iter();
            wrong.extend(found.map(|misfit| format!("{language:?}, {scenery:?}: {misfit}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn in_no_language_do_the_buttons_of_the_top_bar_touch() {
    for language in Language::ALL {
        let harness = open_in(language, SMALL);
        let buttons = harness.query_all_by_role(egui::Role::Button);
        let rects = buttons.map(|node| node.rect());
        let mut rects: Vec<Rect> = rects.filter(|rect| rect.bottom() < 60.0).collect();
        rects.sort_by(|a, b| a.left().total_cmp(&b.left()));
        for (left, right) in rects.iter().zip(rects.iter().skip(1)) {
            assert!(
                right.left() - left.right() > 3.0,
                "{language:?}: {left} {right}"
            );
        }
    }
}

#[test]
fn in_every_language_the_status_bar_shows_the_whole_status_of_live() {
    /// Checks the text in the status bar that contains these words.
    fn check(harness: &WindowHarness, words: &str) {
        let drawn = texts(harness);
        let in_bar = |drawn: &&Drawn| drawn.rect.top() > SMALL.y - space::TARGET;
        let mut in_bar = drawn.iter().filter(in_bar);
        let is_whole = in_bar.any(|drawn| drawn.text.contains(words));
        assert!(is_whole, "no {words} in {drawn:?}");
    }
    for (language, lost) in [
        (Language::English, "lost, reconnecting"),
        (Language::German, "getrennt, neuer Versuch"),
        (Language::Spanish, "reconectando"),
        (Language::Chinese, "已断开"),
    ] {
        let (options, wire) = wired_options();
        let options = WindowOptions {
            language: Some(language),
            ..options
        };
        let mut harness = open_with(SMALL, options);
        act(&mut harness, Action::GoTo(WorkspaceKind::History));
        let context = harness.ctx.clone();
        let toggle = Action::Live(LiveAction::Toggle);
        harness.state_mut().act(toggle, &context);
        if language == Language::German {
            sees(&mut harness, &wire, [0.0; 16]);
            check(&harness, "ruhig seit");
        }
        wire.send(Step::Unplugged).expect("the camera is open");
        wait_until(&mut harness, |state| {
            let status = state.session.live.status.as_ref();
            status.is_some_and(|status| matches!(status.source, SourceState::Lost(_)))
        });
        harness.run_steps(2);
        check(&harness, lost);
    }
}

#[test]
fn in_every_language_the_check_of_the_cell_fits_where_it_does_in_english() {
    let folder = tempfile::tempdir().expect("a folder");
    let checked = |language: Language| {
        let options = WindowOptions {
            language: Some(language),
            cell_checks: Some(folder.path().to_owned()),
            ..plain_options()
        };
        let mut harness = open_with(SMALL, options);
        act(&mut harness, Action::Robot(RobotAction::Toggle));
        let mut dialog = harness.state().robot().dialog().expect("open").clone();
        dialog.page = RobotPage::Check;
        let turned = RobotAction::Edit(Box::new(dialog));
        act(&mut harness, Action::Robot(turned));
        if !harness.state().robot().checks().content().has_baseline {
            let take = RobotAction::Check(CheckAction::TakeBaseline);
            act(&mut harness, Action::Robot(take));
        }
        let check = RobotAction::Check(CheckAction::Check);
        act(&mut harness, Action::Robot(check));
        assert!(harness.state().robot().checks().latest().is_some());
        misfits(&harness)
    };
    let usual = checked(Language::English);
    for language in [Language::German, Language::Spanish, Language::Chinese] {
        let wrong = only_here(checked(language), &usual);
        assert!(wrong.is_empty(), "{language:?}: {}", wrong.join("\n"));
    }
}

#[test]
fn in_every_language_the_page_of_robots_that_ask_fits_where_it_does_in_english() {
    let shown = |language: Language| {
        let mut harness = open_in(language, SMALL);
        act(&mut harness, Action::Robot(RobotAction::Toggle));
        let mut dialog = harness.state().robot().dialog().expect("open").clone();
        dialog.page = RobotPage::Answer;
        // Show the warning about the address, and the one about the missing calibration.
        dialog.address = "0.0.0.0:30100".into();
        let turned = RobotAction::Edit(Box::new(dialog));
        act(&mut harness, Action::Robot(turned));
        misfits(&harness)
    };
    let usual = shown(Language::English);
    for language in [Language::German, Language::Spanish, Language::Chinese] {
        let wrong = only_here(shown(language), &usual);
        assert!(wrong.is_empty(), "{language:?}: {}", wrong.join("\n"));
    }
}

#[test]
fn in_every_language_the_list_of_meshes_and_a_draft_of_several_fit_where_they_do_in_english() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("car.obj");
    write_car(&path);
    let shown = |language: Language| {
        let mut harness = open_in(language, SMALL);
        act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
        drop_file(&mut harness, &path);
        let list = misfits(&harness);
        for action in [
            MeshAction::Order(MeshOrder::Name),
            MeshAction::Tick(0),
            MeshAction::Tick(1),
            MeshAction::Enrol(None),
        ] {
            act_in(&mut harness, |enrol: &mut EnrolWorkspace, cx| {
                enrol.state.apply(EnrolAction::Meshes(action), cx);
            });
        }
        assert!(enrol_of(&harness).draft.is_some());
        [list, misfits(&harness)]
    };
    let usual = shown(Language::English);
    for language in [Language::German, Language::Spanish, Language::Chinese] {
        for (found, usual) in shown(language).into_iter().zip(&usual) {
            let wrong = only_here(found, usual);
            assert!(wrong.is_empty(), "{language:?}: {}", wrong.join("\n"));
        }
    }
}

#[test]
fn what_does_not_fit_is_found() {
    let narrow = Vec2::new(560.0, 768.0);
    let found = misfits(&open_in(Language::German, narrow));
    let is_found = |what: &str| found.iter().any(|misfit| misfit.what == what);
    assert!(
        is_found("is cut at a side") || is_found("runs into another text"),
        "{found:?}"
    );
    assert!(is_found("ends in an ellipsis"), "{found:?}");
}
