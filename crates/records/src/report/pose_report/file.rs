//! Writes the page as a PDF file: fonts with the glyphs in use, pictures, and the file's metadata.
//!
//! `pdf-writer` writes the objects (ISO 32000-1), `subsetter` cuts the fonts down.

use std::{collections::BTreeMap, io::Write as _};

use flate2::{Compression, write::ZlibEncoder};
use image::RgbImage;
use pdf_writer::{
    Content, Date, Filter, Finish as _, Name, Pdf, Rect, Ref, Str, TextStr,
    types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap},
};
use skrifa::{FontRef, GlyphId, Tag};
use subsetter::GlyphRemapper;

use crate::report::lettering::{BOLD, Lettering, REGULAR};
use files::crc32;

/// Codes of a font are glyphs of its subset, in the order of their first use.
const CODES: SystemInfo<'_> = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};
/// Units of a font in a PDF per text size.
const EM: f32 = 1000.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Bold,
}

impl Weight {
    pub(super) const ALL: [Self; 2] = [Self::Regular, Self::Bold];

    pub(super) fn font(self) -> &'static [u8] {
        match self {
            Self::Regular => REGULAR,
            Self::Bold => BOLD,
        }
    }

    /// Name of the font on the page.
    pub(super) fn resource(self) -> Name<'static> {
        Name(match self {
            Self::Regular => b"Regular",
            Self::Bold => b"Bold",
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Regular => "Inter-Regular",
            Self::Bold => "Inter-SemiBold",
        }
    }
}

/// The glyphs of a font that the page uses.
#[derive(Default)]
pub(super) struct UsedGlyphs {
    codes: GlyphRemapper,
    /// Character and width of each code, widths relative to the text size.
    letters: BTreeMap<u16, (char, f32)>,
}

impl UsedGlyphs {
    /// Returns the code of a glyph, and whether the code stands for this character: a box stands for all that the font lacks.
    pub(super) fn code(&mut self, glyph: GlyphId, width: f32, letter: char) -> (u16, bool) {
        let glyph = u16::try_from(glyph.to_u32()).expect("a font has at most 65 535 glyphs");
        let code = self.codes.remap(glyph);
        let (first, _) = *self.letters.entry(code).or_insert((letter, width));
        (code, first == letter)
    }

    /// Returns the tag before the name of a subset: six letters, others for other glyphs (ISO 32000-1, 9.6.4).
    fn tag(&self) -> String {
        let letters: String = self.letters.values().map(|(letter, _)| letter).collect();
        let mut rest = crc32(letters.as_bytes());
        let letter = |_| {
            let letter = char::from(b'A' + (rest % 26) as u8);
            rest /= 26;
            letter
        };
        (0..6).map(letter).collect()
    }
}

/// The file's metadata.
pub(super) struct About<'a> {
    pub(super) title: String,
    /// Program that made the report.
    pub(super) creator: &'a str,
    pub(super) created: Date,
}

/// Writes a file of one page; `size` is in points. Equal pages give identical bytes.
pub(super) fn write(
    about: &About<'_>,
    size: [f32; 2],
    content: Content,
    fonts: &[UsedGlyphs; 2],
    pictures: &[RgbImage],
) -> Vec<u8> {
    let mut pdf = Pdf::new();
    let mut refs = (1..).map(Ref::new);
    let mut next = || refs.next().expect("there are more numbers");
    let [catalog, pages, page_ref, content_ref, info] = std::array::from_fn(|_| next());
    pdf.catalog(catalog)
        .pages(pages)
        .lang(TextStr("en"))
        .viewer_preferences()
        .display_doc_title(true);
    pdf.document_info(info)
        .title(TextStr(&about.title))
        .creator(TextStr(about.creator))
        .creation_date(about.created);
    pdf.pages(pages).kids([page_ref]).count(1);

    let font_refs = fonts.each_ref().map(|_| next());
    let picture_refs: Vec<Ref> = pictures.iter().map(|_| next()).collect();
    let mut page = pdf.page(page_ref);
    page.parent(pages)
        .media_box(Rect::new(0.0, 0.0, size[0], size[1]))
        .contents(content_ref);
    let mut resources = page.resources();
    let mut named = resources.fonts();
    for (weight, font) in Weight::ALL.into_iter().zip(font_refs) {
        named.pair(weight.resource(), font);
    }
    named.finish();
    let mut named = resources.x_objects();
    for (number, picture) in picture_refs.iter().enumerate() {
        named.pair(Name(picture_name(number).as_bytes()), *picture);
    }
    named.finish();
    resources.finish();
    page.finish();

    pdf.stream(content_ref, &deflated(&content.finish()))
        .filter(Filter::FlateDecode);
    for (picture, at) in pictures.iter().zip(picture_refs) {
        let pixels = deflated(picture.as_raw());
        let mut image = pdf.image_xobject(at, &pixels);
        image.filter(Filter::FlateDecode);
        image.width(picture.width() as i32);
        image.height(picture.height() as i32);
        image.color_space().device_rgb();
        image.bits_per_component(8);
    }
    for ((weight, used), font) in Weight::ALL.into_iter().zip(fonts).zip(font_refs) {
        write_font(&mut pdf, weight, used, font, &mut next);
    }
    pdf.finish()
}

/// Name of a picture on the page.
pub(super) fn picture_name(number: usize) -> String {
    format!("Picture{number}")
}

/// Writes a font with the glyphs in use: a CID font with CFF outlines (ISO 32000-1, 9.7).
fn write_font(
    pdf: &mut Pdf,
    weight: Weight,
    used: &UsedGlyphs,
    font: Ref,
    next: &mut impl FnMut() -> Ref,
) {
    let [cid_font, descriptor, to_unicode, outlines] = std::array::from_fn(|_| next());
    let name = format!("{}+{}", used.tag(), weight.name());
    let name = Name(name.as_bytes());
    pdf.type0_font(font)
        .base_font(name)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(cid_font)
        .to_unicode(to_unicode);
    let mut cid = pdf.cid_font(cid_font);
    cid.subtype(CidFontType::Type0)
        .base_font(name)
        .system_info(CODES)
        .font_descriptor(descriptor)
        .default_width(0.0);
    let mut widths = cid.widths();
    for (code, (_, width)) in &used.letters {
        widths.same(*code, *code, width * EM);
    }
    widths.finish();
    cid.finish();

    let metrics = Lettering::of(weight.font()).metrics(EM);
    let bounds = metrics.bounds.unwrap_or_default();
    pdf.font_descriptor(descriptor)
        .name(name)
        .flags(FontFlags::SYMBOLIC)
        .bbox(Rect::new(
            bounds.x_min,
            bounds.y_min,
            bounds.x_max,
            bounds.y_max,
        ))
        .italic_angle(metrics.italic_angle)
        .ascent(metrics.ascent)
        .descent(metrics.descent)
        .cap_height(metrics.cap_height.unwrap_or(metrics.ascent))
        .stem_v(if weight == Weight::Bold { 140.0 } else { 90.0 })
        .font_file3(outlines);

    let mut letters = UnicodeCmap::new(Name(b"Letters"), CODES);
    for (code, (letter, _)) in &used.letters {
        letters.pair(*code, *letter);
    }
    pdf.cmap(to_unicode, &deflated(&letters.finish()))
        .filter(Filter::FlateDecode);

    let subset = subsetter::subset(weight.font(), 0, &used.codes).expect("our own font");
    let tables = FontRef::new(&subset).expect("a font");
    let cff = tables.table_data(Tag::new(b"CFF ")).expect("CFF outlines");
    pdf.stream(outlines, &deflated(cff.as_bytes()))
        .filter(Filter::FlateDecode)
        .pair(Name(b"Subtype"), Name(b"CIDFontType0C"));
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.expect("writing to memory cannot fail")
}
