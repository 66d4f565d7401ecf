//! A page to draw on: selectable text in the font of the window, lines, and pictures.
//!
//! `krilla` makes the PDF. Lengths are points, 72 to the inch; y goes down.
//!
//! Known limits: text from left to right, no kerning; a missing glyph is an empty box on paper, but its character is
//! kept when the text is copied.

use image::{DynamicImage, RgbImage, imageops::FilterType};
use krilla::{
    color::rgb,
    geom::{PathBuilder, Point, Rect, Size, Transform},
    image::Image,
    paint::{Fill, Stroke},
    surface::Surface,
    text::{Font, GlyphId, KrillaGlyph},
};

use crate::report::lettering::{Anchor, BOLD, Lettering, REGULAR};

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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Bold,
}

/// A rectangle on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: f32,
    pub(super) top: f32,
    pub(super) width: f32,
    pub(super) height: f32,
}

impl Area {
    fn rect(self) -> Option<Rect> {
        Rect::from_xywh(self.left, self.top, self.width, self.height)
    }

    #[cfg(test)]
    pub(super) fn overlaps(self, other: Self) -> bool {
        self.left < other.left + other.width
            && other.left < self.left + self.width
            && self.top < other.top + other.height
            && other.top < self.top + self.height
    }
}

/// A font for measuring and writing.
pub(super) struct Face {
    measured: Lettering,
    written: Font,
}

impl Face {
    pub(super) fn of(weight: Weight) -> Self {
        let bytes = match weight {
            Weight::Regular => REGULAR,
            Weight::Bold => BOLD,
        };
        Self {
            measured: Lettering::of(bytes),
            written: Font::new(bytes.into(), 0).expect("our own font is one"),
        }
    }

    fn glyphs(&self, text: &str) -> Vec<KrillaGlyph> {
        let places = text.char_indices();
        let glyphs = places.zip(self.measured.glyphs(text));
        let glyph = |((at, letter), (glyph, width)): ((usize, char), (skrifa::GlyphId, f32))| {
            let (glyph, range) = (GlyphId::new(glyph.to_u32()), at..at + letter.len_utf8());
            KrillaGlyph::new(glyph, width, 0.0, 0.0, 0.0, range, None)
        };
        glyphs.map(glyph).collect()
    }
}

/// Both font weights.
pub(super) struct Faces {
    regular: Face,
    bold: Face,
}

impl Faces {
    pub(super) fn new() -> Self {
        Self {
            regular: Face::of(Weight::Regular),
            bold: Face::of(Weight::Bold),
        }
    }

    fn of(&self, weight: Weight) -> &Face {
        match weight {
            Weight::Regular => &self.regular,
            Weight::Bold => &self.bold,
        }
    }

    /// Returns the width of a text.
    pub(super) fn width(&self, text: &str, style: Style) -> f32 {
        self.of(style.weight).measured.width(text, style.size)
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
    surface: Surface<'a>,
    pub(super) faces: &'a Faces,
    /// All texts and their areas, for tests of the layout.
    #[cfg(test)]
    pub(super) texts: Vec<(String, Area)>,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(surface: Surface<'a>, faces: &'a Faces) -> Self {
        Self {
            surface,
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
        let face = self.faces.of(style.weight);
        self.surface.set_fill(Some(filled(style.ink)));
        self.surface.set_stroke(None);
        let start = Point::from_xy(left, at[1]);
        self.surface.draw_glyphs(
            start,
            &face.glyphs(text),
            face.written.clone(),
            text,
            style.size,
            false,
        );
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
        let mut path = PathBuilder::new();
        if let Some(rect) = area.rect() {
            path.push_rect(rect);
        }
        if let Some(path) = path.finish() {
            self.surface.set_fill(Some(filled(ink)));
            self.surface.set_stroke(None);
            self.surface.draw_path(&path);
        }
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
        let mut path = PathBuilder::new();
        for (i, [x, y]) in points.iter().enumerate() {
            if i == 0 {
                path.move_to(*x, *y);
            } else {
                path.line_to(*x, *y);
            }
        }
        if let Some(path) = path.finish() {
            self.surface.set_fill(None);
            self.surface.set_stroke(Some(Stroke {
                paint: colour(ink).into(),
                width,
                ..Stroke::default()
            }));
            self.surface.draw_path(&path);
        }
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
        let Some(size) = Size::from_wh(covered.width, covered.height) else {
            return covered;
        };
        // More pixels than the paper shows would only enlarge the file.
        let shrunk = (scale * DENSITY < 1.0).then(|| {
            let side = |side: f32| (side * scale * DENSITY).ceil().max(1.0) as u32;
            image::imageops::resize(picture, side(width), side(height), FilterType::Triangle)
        });
        let shown = shrunk.unwrap_or_else(|| picture.clone());
        let (columns, rows) = shown.dimensions();
        let image = Image::from_rgba8(
            DynamicImage::from(shown).into_rgba8().into_raw(),
            columns,
            rows,
        );
        self.surface
            .push_transform(&Transform::from_translate(covered.left, covered.top));
        self.surface.draw_image(image, size);
        self.surface.pop();
        covered
    }

    /// Ends the page.
    pub(super) fn finish(self) {
        self.surface.finish();
    }
}

fn colour([red, green, blue]: Ink) -> rgb::Color {
    rgb::Color::new(red, green, blue)
}

fn filled(ink: Ink) -> Fill {
    Fill {
        paint: colour(ink).into(),
        ..Fill::default()
    }
}
