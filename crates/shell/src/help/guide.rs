//! The guide inside the program: its pages, and the search in them.

use std::{
    ops::Range,
    sync::{Arc, LazyLock},
};

use egui::{
    Align, Id, Layout, OpenUrl, Rect, RichText, Ui,
    cache::{ComputerMut, FrameCache},
    vec2,
};

use super::{
    markdown::{self, Block},
    scrolled,
    state::GuidePlace,
};
use ui::{
    language::{Language, text},
    theme::{Theme, space},
    widgets::{by_width, shortened},
};

macro_rules! pages {
    ($($name:literal)+) => {
        [$(($name, include_str!(concat!("../../../../docs/guide/", $name, ".md")))),+]
    };
}

/// Names and texts of the pages, in the order in which they are listed.
const PAGES: [(&str, &str); 17] = pages!(
    "quick-start" "install" "inspect" "cameras" "enrol" "racks" "robot" "robots_that_ask" "line" "servo" "paint" "parameters"
    "files" "limits" "python" "http" "plant"
);

static GUIDE: LazyLock<Vec<Page>> = LazyLock::new(|| PAGES.map(Page::of).into());

/// Most letters of a result's text.
const MAX_EXCERPT: usize = 110;
/// Most results that are shown.
const MAX_RESULTS: usize = 40;
/// Width of the list of pages in a wide and in a narrow window, logical pixels.
const LIST_WIDTHS: [f32; 2] = [230.0, 190.0];

/// A page of the guide.
struct Page {
    name: &'static str,
    blocks: Vec<Block>,
    sections: Vec<Section>,
}

/// A heading with the text below it, up to the next one.
struct Section {
    title: String,
    anchor: String,
    /// Its blocks, the heading first.
    blocks: Range<usize>,
    text: String,
    /// Title and text in lower case.
    folded: [String; 2],
}

/// A place in the guide that has the words that were searched for.
pub(super) struct GuideResult {
    pub(super) title: String,
    pub(super) excerpt: String,
    pub(super) place: GuidePlace,
}

impl Page {
    fn of((name, text): (&'static str, &str)) -> Self {
        let blocks = markdown::blocks(text);
        let is_heading = |block: &Block| matches!(block, Block::Heading(..));
        let begins = blocks.iter().enumerate();
        let begins = begins.filter(|(_, block)| is_heading(block));
        let begins: Vec<usize> = begins.map(|(index, _)| index).collect();
        let ends = begins.iter().skip(1).copied().chain([blocks.len()]);
        let sections = begins.iter().zip(ends);
        let sections = sections.map(|(&begin, end)| {
            let title = markdown::text_of(&blocks[begin]);
            let texts = blocks[begin + 1..end].iter().map(markdown::text_of);
            let text = texts.collect::<Vec<_>>().join(" ");
            Section {
                anchor: markdown::anchor(&title),
                blocks: begin..end,
                folded: [title.to_lowercase(), text.to_lowercase()],
                title,
                text,
            }
        });
        Self {
            name,
            sections: sections.collect(),
            blocks,
        }
    }

    fn title(&self) -> &str {
        self.sections
            .first()
            .map_or(self.name, |section| section.title.as_str())
    }
}

/// Searches once for each text, not in every frame.
#[derive(Default)]
struct Finder;

impl ComputerMut<&str, Arc<[GuideResult]>> for Finder {
    fn compute(&mut self, search: &str) -> Arc<[GuideResult]> {
        find(search).into()
    }
}

/// The sections with all these words; those with all of them in their headings come first.
pub(super) fn found(ui: &Ui, search: &str) -> Arc<[GuideResult]> {
    type Cache = FrameCache<Arc<[GuideResult]>, Finder>;
    ui.memory_mut(|memory| Arc::clone(memory.caches.cache::<Cache>().get(search)))
}

fn find(search: &str) -> Vec<GuideResult> {
    let folded = search.to_lowercase();
    let words: Vec<&str> = folded.split_whitespace().collect();
    let mut found = [Vec::new(), Vec::new()];
    for (index, page) in GUIDE.iter().enumerate() {
        for section in &page.sections {
            let [title, text] = &section.folded;
            let is_in_title = words.iter().all(|word| title.contains(word));
            let is_in_any = |word: &&str| title.contains(*word) || text.contains(*word);
            if !words.iter().all(is_in_any) {
                continue;
            }
            let of_page = section.blocks.start == page.sections[0].blocks.start;
            found[usize::from(!is_in_title)].push(GuideResult {
                title: if of_page {
                    section.title.clone()
                } else {
                    format!("{} › {}", page.title(), section.title)
                },
                excerpt: section.excerpt(&words),
                place: GuidePlace {
                    page: index,
                    block: section.blocks.start,
                    is_new: true,
                },
            });
        }
    }
    let mut found: Vec<GuideResult> = found.into_iter().flatten().collect();
    found.truncate(MAX_RESULTS);
    found
}

impl Section {
    /// A stretch of the text around the first of these words, in whole words.
    fn excerpt(&self, words: &[&str]) -> String {
        let before = MAX_EXCERPT / 4;
        let mut begin = 0;
        let mut kept: Vec<&str> = Vec::new();
        let has_word = |text: &str| {
            let text = text.to_lowercase();
            words.iter().any(|word| text.contains(word))
        };
        let all: Vec<&str> = self.text.split_whitespace().collect();
        if let Some(found) = all.iter().position(|text| has_word(text)) {
            let mut length = 0;
            let near = all[..found].iter().rev().take_while(|text| {
                length += text.chars().count() + 1;
                length <= before
            });
            begin = found - near.count();
        }
        let mut length = 0;
        for text in &all[begin..] {
            length += text.chars().count() + 1;
            if length > MAX_EXCERPT {
                break;
            }
            kept.push(text);
        }
        let [from, to] =
            [begin > 0, begin + kept.len() < all.len()].map(|is_cut| if is_cut { "…" } else { "" });
        format!("{from}{}{to}", kept.join(" "))
    }
}

/// The place in the guide to which a link on this page leads; `None` if it leads elsewhere.
fn place_of(page: usize, target: &str) -> Option<GuidePlace> {
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let page = if file.is_empty() {
        page
    } else {
        let name = file.strip_suffix(".md")?;
        GUIDE.iter().position(|page| page.name == name)?
    };
    let sections = &GUIDE[page].sections;
    let section = sections.iter().find(|section| section.anchor == anchor);
    if section.is_none() && !anchor.is_empty() {
        return None;
    }
    Some(GuidePlace {
        page,
        block: section.map_or(0, |section| section.blocks.start),
        is_new: true,
    })
}

/// Draws the list of pages beside the page in front.
pub(super) fn ui(ui: &mut Ui, place: &mut GuidePlace) {
    let height = ui.available_height();
    let width = by_width(ui.ctx().content_rect().width(), LIST_WIDTHS);
    ui.horizontal_top(|ui| {
        let room = vec2(width, height);
        ui.allocate_ui_with_layout(room, Layout::top_down_justified(Align::Min), |ui| {
            scrolled(ui, "pages", |ui| {
                for (index, page) in GUIDE.iter().enumerate() {
                    let is_shown = index == place.page;
                    let entry = ui.selectable_label(is_shown, shortened(page.title(), 36));
                    if entry.clicked() {
                        *place = GuidePlace {
                            page: index,
                            block: 0,
                            is_new: true,
                        };
                    }
                }
            });
        });
        ui.separator();
        ui.vertical(|ui| {
            let name = GUIDE.get(place.page).map_or("", |page| page.name);
            scrolled(ui, name, |ui| {
                if Language::current() != Language::English {
                    ui.weak(text!("help-guide-in-english"));
                }
                draw_page(ui, place);
            });
        });
    });
}

/// Draws the blocks of the page in front that are in sight.
fn draw_page(ui: &mut Ui, place: &mut GuidePlace) {
    let index = place.page.min(GUIDE.len() - 1);
    let page = &GUIDE[index];
    let width = ui.available_width();
    // Heights of the blocks as they were last drawn at this width.
    let id = Id::unique(("heights of the guide", index, width.to_bits()));
    let known: Option<Vec<f32>> = ui.data(|data| data.get_temp(id));
    let mut heights = known.unwrap_or_else(|| vec![f32::NAN; page.blocks.len()]);
    let mut target = None;
    for (number, (block, height)) in page.blocks.iter().zip(&mut heights).enumerate() {
        let is_wanted = place.is_new && number == place.block;
        let rect = Rect::from_min_size(ui.cursor().min, vec2(width, *height));
        if height.is_finite() && !is_wanted && !ui.is_rect_visible(rect) {
            ui.allocate_space(rect.size());
            continue;
        }
        let (drawn, pressed) = markdown::draw(ui, block);
        *height = drawn.rect.height();
        if is_wanted {
            drawn.scroll_to_me(Some(Align::TOP));
            place.is_new = false;
        }
        target = target.or(pressed);
    }
    ui.data_mut(|data| data.insert_temp(id, heights));
    let Some(target) = target else {
        return;
    };
    match place_of(index, &target) {
        Some(other) => *place = other,
        None => ui.ctx().open_url(OpenUrl::new_tab(target)),
    }
}

/// Draws the sections that were found; returns the one that was pressed.
pub(super) fn results(ui: &mut Ui, found: &[GuideResult]) -> Option<GuidePlace> {
    let theme = Theme::of(ui);
    let mut pressed = None;
    for result in found {
        if ui.link(&result.title).clicked() {
            pressed = Some(result.place);
        }
        ui.label(
            RichText::new(&result.excerpt)
                .small()
                .color(theme.weak_text),
        );
        ui.add_space(space::SMALL);
    }
    pressed
}

#[cfg(test)]
mod tests {
    use std::{collections::BTreeSet, path::Path};

    use super::*;

    #[test]
    fn every_page_is_there_and_every_link_between_pages_leads_somewhere() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide");
        let listed = folder.read_dir().expect("a folder");
        let names = listed.map(|entry| entry.expect("an entry").file_name());
        let names = names.map(|name| name.to_string_lossy().into_owned());
        let names: BTreeSet<String> = names.collect();
        let pages = PAGES.map(|(name, _)| format!("{name}.md"));
        assert_eq!(names, BTreeSet::from(pages));
        for (index, page) in GUIDE.iter().enumerate() {
            assert!(
                page.title().len() > 3 && !page.sections.is_empty(),
                "{}",
                page.name
            );
            for block in &page.blocks {
                let text = markdown::text_of(block);
                let is_code = matches!(block, Block::Code(_));
                assert!(is_code || !text.contains("]("), "{}: {text}", page.name);
                for target in markdown::targets(block) {
                    let is_elsewhere = target.starts_with("https://");
                    let place = place_of(index, target);
                    assert!(is_elsewhere != place.is_some(), "{}: {target}", page.name);
                }
            }
        }
    }

    #[test]
    fn a_search_finds_headings_first_and_shows_the_words() {
        let found = find("hand-eye  CALIBRATION");
        assert!(!found.is_empty() && found.len() <= MAX_RESULTS);
        for result in &found {
            let shown = format!("{} {}", result.title, result.excerpt).to_lowercase();
            assert!(
                shown.contains("hand-eye") || shown.contains("calibration"),
                "{shown}"
            );
            assert!(result.excerpt.chars().count() <= MAX_EXCERPT + 2);
        }
        let found = find("where your data is");
        assert_eq!(found[0].title, "Quick start › Where your data is");
        assert!(find("no such words xyzzy").is_empty());
    }
}
