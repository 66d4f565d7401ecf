//! The part of Markdown that the guide is written in: headings, paragraphs, lists, tables, code, emphasis and links.
//!
//! Source: John MacFarlane, *CommonMark Spec*, version 0.31.2, 2024, and GitHub's tables. Anchors of headings are those of
//! GitHub. Limits: no nested quotes, no HTML, no pictures (their text is shown).

use egui::{Align, Frame, Label, Layout, Margin, Response, RichText, Ui, vec2};

use ui::theme::{ROUNDING, Theme, font, space};

/// A block of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Block {
    /// A heading: its level, 1 for that of the page, and its text.
    Heading(usize, String),
    Paragraph(Vec<Span>),
    /// An item of a list: the number of lists around its own, its sign or number, and its text.
    Item(usize, String, Vec<Span>),
    Code(String),
    /// The cells of a table by row; the first row has the headings.
    Table(Vec<Vec<Vec<Span>>>),
}

/// A stretch of text with one look.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Span {
    text: String,
    style: SpanStyle,
    /// Where it leads.
    target: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SpanStyle {
    Plain,
    Strong,
    Emphasis,
    Code,
}

/// Reads the blocks of a page.
pub(super) fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut lines = page.lines().peekable();
    while let Some(line) = lines.next() {
        let bare = line.trim_start();
        if bare.is_empty() {
            continue;
        }
        let block = if bare.starts_with("```") {
            let code = lines.by_ref().take_while(|line| line.trim() != "```");
            Block::Code(code.collect::<Vec<_>>().join("\n"))
        } else if let Some((level, text)) = heading(bare) {
            Block::Heading(level, flat(&spans(text)))
        } else if bare.starts_with('|') {
            let mut rows = vec![line];
            while let Some(row) = lines.next_if(|next| next.starts_with('|')) {
                rows.push(row);
            }
            let is_ruler = |row: &&str| row.chars().all(|letter| "|-: ".contains(letter));
            let rows = rows.into_iter().filter(|row| !is_ruler(row));
            Block::Table(rows.map(cells).collect())
        } else {
            let (sign, first) = item(bare).unwrap_or(("", bare));
            let mut text = first.to_owned();
            while let Some(next) = lines.next_if(|next| continues(next)) {
                text = format!("{text} {}", next.trim());
            }
            if sign.is_empty() {
                Block::Paragraph(spans(&text))
            } else {
                let depth = (line.len() - bare.len()) / 2;
                Block::Item(depth, sign.to_owned(), spans(&text))
            }
        };
        blocks.push(block);
    }
    blocks
}

/// Level and text of a heading.
fn heading(line: &str) -> Option<(usize, &str)> {
    let text = line.trim_start_matches('#');
    let level = line.len() - text.len();
    (level > 0 && text.starts_with(' ')).then(|| (level, text.trim()))
}

/// Splits the sign or number off an item of a list.
fn item(line: &str) -> Option<(&str, &str)> {
    if let Some(text) = line.strip_prefix("- ") {
        return Some(("•", text));
    }
    let (number, text) = line.split_once(". ")?;
    let is_number = !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit());
    is_number.then(|| (&line[..=number.len()], text))
}

/// True for a line that belongs to the paragraph or item before it.
fn continues(line: &str) -> bool {
    let bare = line.trim_start();
    let begins_another = bare.is_empty() || bare.starts_with('|') || bare.starts_with("```");
    !begins_another && heading(bare).is_none() && item(bare).is_none()
}

/// The cells of a row.
fn cells(row: &str) -> Vec<Vec<Span>> {
    // A bar in a cell is written with a backslash.
    let row = row.trim().replace("\\|", "\0");
    let row = row.trim_start_matches('|').trim_end_matches('|');
    let cells = row.split('|').map(|cell| cell.trim().replace('\0', "|"));
    cells.map(|cell| spans(&cell)).collect()
}

/// Reads the text of a paragraph, an item or a cell.
fn spans(text: &str) -> Vec<Span> {
    let mut spans = Vec::new();
    add_spans(text, SpanStyle::Plain, None, &mut spans);
    spans
}

/// Reads a text with this look, and adds its spans.
fn add_spans(text: &str, style: SpanStyle, target: Option<&str>, spans: &mut Vec<Span>) {
    let mut rest = text;
    // Length of the text without markup, bytes.
    let mut plain = 0;
    while let Some(letter) = rest[plain..].chars().next() {
        let Some((inner, markup, after)) = markup(&rest[plain..]) else {
            plain += letter.len_utf8();
            continue;
        };
        add_plain(&rest[..plain], style, target, spans);
        match markup {
            Markup::Code => add_plain(inner, SpanStyle::Code, target, spans),
            Markup::Style(inner_style) => add_spans(inner, inner_style, target, spans),
            // Other documents are not in the program.
            Markup::Link(target) if target.starts_with("../") => {
                add_spans(inner, style, None, spans);
            }
            Markup::Link(target) => add_spans(inner, style, Some(target), spans),
        }
        (rest, plain) = (after, 0);
    }
    add_plain(rest, style, target, spans);
}

fn add_plain(text: &str, style: SpanStyle, target: Option<&str>, spans: &mut Vec<Span>) {
    if !text.is_empty() {
        spans.push(Span {
            text: text.to_owned(),
            style,
            target: target.map(str::to_owned),
        });
    }
}

/// The meaning of markup around a text.
enum Markup<'a> {
    Code,
    Style(SpanStyle),
    /// A link to this place.
    Link(&'a str),
}

/// The text in the markup with which this one begins, its meaning, and what follows.
fn markup(text: &str) -> Option<(&str, Markup<'_>, &str)> {
    let between = |mark: &str| {
        let (inner, after) = text.strip_prefix(mark)?.split_once(mark)?;
        let is_tight = !inner.is_empty() && inner.trim() == inner;
        is_tight.then_some((inner, after))
    };
    if let Some((inner, after)) = between("`") {
        return Some((inner, Markup::Code, after));
    }
    if let Some((inner, after)) = between("**") {
        return Some((inner, Markup::Style(SpanStyle::Strong), after));
    }
    if let Some((inner, after)) = between("*") {
        return Some((inner, Markup::Style(SpanStyle::Emphasis), after));
    }
    if let Some(picture) = text.strip_prefix("![") {
        let (inner, after) = picture.split_once("](")?;
        let (_, after) = after.split_once(')')?;
        return Some((inner, Markup::Style(SpanStyle::Emphasis), after));
    }
    let (inner, after) = text.strip_prefix('[')?.split_once("](")?;
    let (target, after) = after.split_once(')')?;
    (!inner.contains('[')).then_some((inner, Markup::Link(target), after))
}

/// The text without its looks.
fn flat(spans: &[Span]) -> String {
    spans.iter().map(|span| span.text.as_str()).collect()
}

/// The text of a block without its looks, for the search.
pub(super) fn text_of(block: &Block) -> String {
    match block {
        Block::Heading(_, text) | Block::Code(text) => text.clone(),
        Block::Paragraph(spans) | Block::Item(_, _, spans) => flat(spans),
        Block::Table(rows) => {
            let cells = rows.iter().flatten().map(|cell| flat(cell));
            cells.collect::<Vec<_>>().join(" · ")
        }
    }
}

/// Where the links of a block lead.
#[cfg(test)]
pub(super) fn targets(block: &Block) -> Vec<&str> {
    let spans: Vec<&Span> = match block {
        Block::Heading(..) | Block::Code(_) => Vec::new(),
        Block::Paragraph(spans) | Block::Item(_, _, spans) => spans.iter().collect(),
        Block::Table(rows) => rows.iter().flatten().flatten().collect(),
    };
    spans
        .into_iter()
        .filter_map(|span| span.target.as_deref())
        .collect()
}

/// The anchor of a heading.
pub(super) fn anchor(heading: &str) -> String {
    let letters = heading.to_lowercase();
    let letters = letters.chars().filter_map(|letter| match letter {
        ' ' => Some('-'),
        '-' | '_' => Some(letter),
        _ => letter.is_alphanumeric().then_some(letter),
    });
    letters.collect()
}

/// Draws a block; returns its response, and the target of the link that was pressed.
pub(super) fn draw(ui: &mut Ui, block: &Block) -> (Response, Option<String>) {
    let theme = Theme::of(ui);
    let drawn = ui.scope(|ui| {
        // Nothing here but links can be pressed, so rows need no minimum height.
        ui.spacing_mut().interact_size.y = 0.0;
        match block {
            Block::Heading(level, text) => {
                let size = match level {
                    1 => font::title(),
                    2 => font::verdict(),
                    _ => font::body_strong(),
                };
                ui.add_space(space::MEDIUM);
                ui.label(RichText::new(text).font(size));
                None
            }
            Block::Paragraph(spans) => draw_spans(ui, spans),
            Block::Item(depth, sign, spans) => {
                let row = ui.horizontal_top(|ui| {
                    ui.add_space(space::LARGE * (*depth as f32 + 0.5));
                    ui.label(sign);
                    ui.vertical(|ui| draw_spans(ui, spans)).inner
                });
                row.inner
            }
            Block::Code(code) => {
                let frame = Frame::new().fill(theme.canvas).corner_radius(ROUNDING);
                frame.inner_margin(Margin::same(8)).show(ui, |ui| {
                    ui.set_width(ui.available_width());
                    ui.add(Label::new(RichText::new(code).monospace()).wrap());
                });
                None
            }
            Block::Table(rows) => draw_table(ui, rows),
        }
    });
    (drawn.response, drawn.inner)
}

fn draw_spans(ui: &mut Ui, spans: &[Span]) -> Option<String> {
    let theme = Theme::of(ui);
    let row = ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        let mut pressed = None;
        for span in spans {
            let text = RichText::new(&span.text);
            let text = match span.style {
                SpanStyle::Plain => text,
                SpanStyle::Strong => text.font(font::body_strong()),
                SpanStyle::Emphasis => text.italics(),
                SpanStyle::Code => text.monospace().background_color(theme.canvas),
            };
            match &span.target {
                None => {
                    ui.label(text);
                }
                Some(target) => {
                    if ui.link(text).clicked() {
                        pressed = Some(target.clone());
                    }
                }
            }
        }
        pressed
    });
    row.inner
}

/// Letters of a column that make it wider: a longer text takes more rows.
const COLUMN_LETTERS: std::ops::RangeInclusive<usize> = 8..=60;

fn draw_table(ui: &mut Ui, rows: &[Vec<Vec<Span>>]) -> Option<String> {
    let num_columns = rows.iter().map(Vec::len).max().unwrap_or_default();
    let letters = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        let longest = cells.map(|cell| flat(cell).chars().count()).max();
        let longest = longest.unwrap_or_default();
        longest.clamp(*COLUMN_LETTERS.start(), *COLUMN_LETTERS.end()) as f32
    };
    let letters: Vec<f32> = (0..num_columns).map(letters).collect();
    let gap = space::MEDIUM;
    let gaps = gap * num_columns.saturating_sub(1) as f32;
    let room = (ui.available_width() - gaps).max(0.0);
    let total: f32 = letters.iter().sum();
    let mut pressed = None;
    for (index, row) in rows.iter().enumerate() {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = gap;
            for (cell, letters) in row.iter().zip(&letters) {
                let size = vec2(room * letters / total, 0.0);
                ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
                    ui.set_width(size.x);
                    if index == 0 {
                        ui.label(RichText::new(flat(cell)).font(font::heading()).weak());
                    } else if let Some(target) = draw_spans(ui, cell) {
                        pressed = Some(target);
                    }
                });
            }
        });
        ui.separator();
    }
    pressed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn span(text: &str, style: SpanStyle, target: Option<&str>) -> Span {
        Span {
            text: text.into(),
            style,
            target: target.map(str::to_owned),
        }
    }

    #[test]
    fn the_looks_of_a_text_are_read() {
        assert_eq!(
            spans("**A part** *or two* of `a*b*` in [the `library`](enrol.md#parts), 3 * 4"),
            [
                span("A part", SpanStyle::Strong, None),
                span(" ", SpanStyle::Plain, None),
                span("or two", SpanStyle::Emphasis, None),
                span(" of ", SpanStyle::Plain, None),
                span("a*b*", SpanStyle::Code, None),
                span(" in ", SpanStyle::Plain, None),
                span("the ", SpanStyle::Plain, Some("enrol.md#parts")),
                span("library", SpanStyle::Code, Some("enrol.md#parts")),
                span(", 3 * 4", SpanStyle::Plain, None),
            ]
        );
    }

    #[test]
    fn the_blocks_of_a_page_are_read() {
        let page = "# One, *two*\n\nA line\nand more.\n- an item\n  of two lines\n  1. first\n\n\
                    | A | B |\n| --- | :-: |\n| `x\\|y` | |\n```sh\n# no heading\n\n- no item\n```\nEnd";
        let plain = |text: &str| vec![span(text, SpanStyle::Plain, None)];
        assert_eq!(
            blocks(page),
            [
                Block::Heading(1, "One, two".into()),
                Block::Paragraph(plain("A line and more.")),
                Block::Item(0, "•".into(), plain("an item of two lines")),
                Block::Item(1, "1.".into(), plain("first")),
                Block::Table(vec![
                    vec![plain("A"), plain("B")],
                    vec![vec![span("x|y", SpanStyle::Code, None)], Vec::new()],
                ]),
                Block::Code("# no heading\n\n- no item".into()),
                Block::Paragraph(plain("End")),
            ]
        );
    }

    #[test]
    fn an_anchor_is_that_of_github() {
        assert_eq!(
            anchor("Frames for PLCs: `binary` and binary-be"),
            "frames-for-plcs-binary-and-binary-be"
        );
        assert_eq!(anchor("What is replaced?"), "what-is-replaced");
    }
}
