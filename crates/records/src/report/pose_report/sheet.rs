//! A page to draw on: selectable text in the font of the window, lines, and pictures.
//!
//! Lengths are points, 72 to the inch; y goes down.
//!
//! Known limits: text from left to right, no kerning; a missing glyph is an empty box on paper, but its character is
//! kept when the text is copied.

use image::{RgbImage, imageops::FilterType};
use pdf_writer::{Content, Finish as _, Name, Str, TextStr};

use super::file::{self, About, UsedGlyphs, Weight};
use crate::report::lettering::{Anchor, Lettering};

/// Colour on paper: red, green, blue.
pub(super) type Ink = [u8; 3];

/// Text style.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    /// Text size, points; about the line spacing.
    pub(super) size: f32,
    pub(super) weight: Weight,
    pub(super) ink: Ink,
}

/// A rectangle on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: f32,
    pub(super) top: f32,
    pub(super) width: f32,
    pub(super) height: f32,
}

#[cfg(test)]
impl Area {
    pub(super) fn overlaps(self, other: Self) -> bool {
        self.left < other.left + other.width
            && other.left < self.left + self.width
            && self.top < other.top + other.height
            && other.top < self.top + self.height
    }
}

/// The fonts, in the order of [`Weight::ALL`].
pub(super) struct Faces([Lettering; 2]);

impl Faces {
    pub(super) fn new() -> Self {
        Self(Weight::ALL.map(|weight| Lettering::of(weight.font())))
    }

    fn lettering(&self, weight: Weight) -> &Lettering {
        &self.0[weight as usize]
    }

    /// Returns the width of a text.
    pub(super) fn width(&self, text: &str, style: Style) -> f32 {
        self.lettering(style.weight).width(text, style.size)
    }

    /// Truncates a text in its middle to fit the width: both ends of a path matter more than its middle.
    pub(super) fn fitted(&self, text: &str, width: f32, style: Style) -> String {
        if self.width(text, style) <= width {
            return text.to_owned();
        }
        let letters: Vec<char> = text.chars().collect();
        let cut = |kept: usize| {
            let (head, tail) = (kept / 2, kept - kept / 2);
            let ends = letters[..head]
                .iter()
                .chain(&['…'])
                .chain(&letters[letters.len() - tail..]);
            ends.collect::<String>()
        };
        let kept = (0..letters.len())
            .rev()
            .find(|kept| self.width(&cut(*kept), style) <= width);
        cut(kept.unwrap_or(0))
    }

    /// Breaks a text into at most `most` lines of this width; the last one is truncated if needed.
    pub(super) fn lines(&self, text: &str, width: f32, style: Style, most: usize) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        let mut words = text.split_whitespace().peekable();
        while let Some(word) = words.next() {
            let longer = lines.last().map(|line| format!("{line} {word}"));
            match longer.filter(|line| self.width(line, style) <= width) {
                Some(longer) => {
                    lines.pop();
                    lines.push(longer);
                }
                None if lines.len() < most => lines.push(self.fitted(word, width, style)),
                None => {
                    if let Some(last) = lines.last_mut() {
                        let rest = words
                            .by_ref()
                            .fold(word.to_owned(), |rest, word| rest + " " + word);
                        *last = self.ending(&format!("{last} {rest}"), width, style);
                    }
                    break;
                }
            }
        }
        lines
    }

    /// Truncates a text at its end to fit the width, with an ellipsis.
    fn ending(&self, text: &str, width: f32, style: Style) -> String {
        let mut kept: String = text.to_owned();
        while !kept.is_empty() && self.width(&format!("{kept}…"), style) > width {
            kept.pop();
        }
        kept.trim_end().to_owned() + "…"
    }
}

/// A page being drawn.
pub(super) struct Sheet<'a> {
    size: [f32; 2],
    content: Content,
    fonts: [UsedGlyphs; 2],
    pictures: Vec<RgbImage>,
    pub(super) faces: &'a Faces,
    /// All texts and their areas, for tests of the layout.
    #[cfg(test)]
    pub(super) texts: Vec<(String, Area)>,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(size: [f32; 2], faces: &'a Faces) -> Self {
        let mut content = Content::new();
        // In PDF, y goes up from the lower left corner.
        content.transform([1.0, 0.0, 0.0, -1.0, 0.0, size[1]]);
        Self {
            size,
            content,
            fonts: Default::default(),
            pictures: Vec::new(),
            faces,
            #[cfg(test)]
            texts: Vec::new(),
        }
    }

    /// Writes one line; `at` is on its baseline.
    pub(super) fn text(&mut self, text: &str, at: [f32; 2], style: Style, anchor: Anchor) {
        if text.is_empty() {
            return;
        }
        let width = self.faces.width(text, style);
        let left = at[0] + anchor.offset(width);
        #[cfg(test)]
        self.texts.push((
            text.to_owned(),
            Area {
                left,
                top: at[1] - 0.7 * style.size,
                width,
                height: 0.9 * style.size,
            },
        ));
        let glyphs = self.faces.lettering(style.weight).glyphs(text);
        let used = &mut self.fonts[style.weight as usize];
        let (mut codes, mut is_plain) = (Vec::new(), true);
        for (letter, (glyph, width)) in text.chars().zip(glyphs) {
            let (code, is_letter) = used.code(glyph, width, letter);
            codes.extend(code.to_be_bytes());
            is_plain &= is_letter;
        }
        if !is_plain {
            let mut span = self
                .content
                .begin_marked_content_with_properties(Name(b"Span"));
            span.properties().actual_text(TextStr(text));
            span.finish();
        }
        let [red, green, blue] = colour(style.ink);
        self.content
            .set_fill_rgb(red, green, blue)
            .begin_text()
            .set_font(style.weight.resource(), style.size)
            .set_text_matrix([1.0, 0.0, 0.0, -1.0, left, at[1]])
            .show(Str(&codes))
            .end_text();
        if !is_plain {
            self.content.end_marked_content();
        }
    }

    /// Writes lines from `at` downwards. Returns the baseline after the last one.
    pub(super) fn paragraph(
        &mut self,
        text: &str,
        at: [f32; 2],
        width: f32,
        style: Style,
        most: usize,
    ) -> f32 {
        let mut y = at[1];
        for line in self.faces.lines(text, width, style, most) {
            self.text(&line, [at[0], y], style, Anchor::Left);
            y += style.size * 1.3;
        }
        y
    }

    /// Fills an area.
    pub(super) fn fill(&mut self, area: Area, ink: Ink) {
        let [red, green, blue] = colour(ink);
        self.content
            .set_fill_rgb(red, green, blue)
            .rect(area.left, area.top, area.width, area.height)
            .fill_nonzero();
    }

    /// Draws the border of an area.
    pub(super) fn outline(&mut self, area: Area, ink: Ink) {
        let [left, top] = [area.left, area.top];
        let [right, bottom] = [left + area.width, top + area.height];
        let corners = [
            [left, top],
            [right, top],
            [right, bottom],
            [left, bottom],
            [left, top],
        ];
        self.line(&corners, 0.5, ink);
    }

    /// Draws a line through points.
    pub(super) fn line(&mut self, points: &[[f32; 2]], width: f32, ink: Ink) {
        let [red, green, blue] = colour(ink);
        self.content
            .set_line_width(width)
            .set_stroke_rgb(red, green, blue);
        for (i, [x, y]) in points.iter().enumerate() {
            match i {
                0 => self.content.move_to(*x, *y),
                _ => self.content.line_to(*x, *y),
            };
        }
        self.content.stroke();
    }

    /// Draws a picture in the upper left of the area, as large as it fits. Returns the area covered.
    pub(super) fn picture(&mut self, picture: &RgbImage, area: Area) -> Area {
        /// Pixels per point on paper: 300 to the inch.
        const DENSITY: f32 = 4.2;
        let (width, height) = (
            picture.width().max(1) as f32,
            picture.height().max(1) as f32,
        );
        let scale = (area.width / width).min(area.height / height);
        let covered = Area {
            width: width * scale,
            height: height * scale,
            ..area
        };
        // More pixels than the paper shows would only enlarge the file.
        let shrunk = (scale * DENSITY < 1.0).then(|| {
            let side = |side: f32| (side * scale * DENSITY).ceil().max(1.0) as u32;
            image::imageops::resize(picture, side(width), side(height), FilterType::Triangle)
        });
        let shown = shrunk.unwrap_or_else(|| picture.clone());
        let name = file::picture_name(self.pictures.len());
        self.pictures.push(shown);
        // A picture is a unit square with its upper side up.
        let Area { left, top, .. } = covered;
        let place = [
            covered.width,
            0.0,
            0.0,
            -covered.height,
            left,
            top + covered.height,
        ];
        self.content
            .save_state()
            .transform(place)
            .x_object(Name(name.as_bytes()))
            .restore_state();
        covered
    }

    /// Returns the page as a PDF file.
    pub(super) fn finish(self, about: &About<'_>) -> Vec<u8> {
        file::write(about, self.size, self.content, &self.fonts, &self.pictures)
    }
}

fn colour(ink: Ink) -> [f32; 3] {
    ink.map(|value| f32::from(value) / 255.0)
}
