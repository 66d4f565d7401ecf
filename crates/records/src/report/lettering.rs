//! Fonts of the window for reports: widths and outlines of text, by `skrifa`.
//!
//! Known limits: one line of text from left to right, no kerning; a missing glyph is an empty box.

use skrifa::{
    FontRef, GlyphId, MetadataProvider as _,
    instance::{LocationRef, Size},
    metrics::Metrics,
    outline::{DrawSettings, OutlinePen},
};
use vello_cpu::kurbo::{BezPath, Point};

/// Inter, under the licence in `assets/fonts`.
pub(super) const REGULAR: &[u8] = include_bytes!("../../../../assets/fonts/Inter-Regular.otf");
/// Inter in semi-bold.
pub(super) const BOLD: &[u8] = include_bytes!("../../../../assets/fonts/Inter-SemiBold.otf");

/// Alignment of a text with its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// Begins at the position.
    Left,
    /// Centred on the position.
    Middle,
    /// Ends at the position.
    Right,
}

impl Anchor {
    /// Returns the offset from the position to the beginning of a text of this width.
    pub(super) fn offset(self, width: f32) -> f32 {
        match self {
            Self::Left => 0.0,
            Self::Middle => -width / 2.0,
            Self::Right => -width,
        }
    }
}

/// A font.
pub(super) struct Lettering(FontRef<'static>);

impl Lettering {
    pub(super) fn of(font: &'static [u8]) -> Self {
        Self(FontRef::new(font).expect("our own font is one"))
    }

    /// Returns the measures of the font at a text size.
    pub(super) fn metrics(&self, size: f32) -> Metrics {
        self.0.metrics(Size::new(size), LocationRef::default())
    }

    /// Returns the glyph of each character and its width relative to the text size.
    pub(super) fn glyphs(&self, text: &str) -> impl Iterator<Item = (GlyphId, f32)> {
        let metrics = self.0.glyph_metrics(Size::new(1.0), LocationRef::default());
        let charmap = self.0.charmap();
        text.chars().map(move |letter| {
            let glyph = charmap.map(letter).unwrap_or_default();
            (glyph, metrics.advance_width(glyph).unwrap_or(0.0))
        })
    }

    /// Returns the width of a text of this size; `size` is about the line spacing.
    pub(super) fn width(&self, text: &str, size: f32) -> f32 {
        self.glyphs(text).map(|(_, width)| width).sum::<f32>() * size
    }

    /// Returns the outlines of a text that begins at the origin, y down.
    pub(super) fn outline(&self, text: &str, size: f32) -> BezPath {
        let outlines = self.0.outline_glyphs();
        let mut pen = Pen::default();
        for (glyph, width) in self.glyphs(text) {
            if let Some(outline) = outlines.get(glyph) {
                let settings = DrawSettings::unhinted(Size::new(size), LocationRef::default());
                // A glyph that cannot be drawn leaves a gap.
                let _ = outline.draw(settings, &mut pen);
            }
            pen.left += width * size;
        }
        pen.path
    }
}

/// Collects the outlines of glyphs; the font's y is up.
#[derive(Default)]
struct Pen {
    path: BezPath,
    /// Position of the present glyph.
    left: f32,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> Point {
        Point::new(f64::from(self.left + x), f64::from(-y))
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.at(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.at(x, y));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.path.quad_to(self.at(cx, cy), self.at(x, y));
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.path
            .curve_to(self.at(cx0, cy0), self.at(cx1, cy1), self.at(x, y));
    }

    fn close(&mut self) {
        self.path.close_path();
    }
}
