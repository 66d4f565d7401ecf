//! Textures of the small pictures, made once per library and once per draft.

use std::sync::Arc;

use egui::{Color32, ColorImage, Context, Painter, Rect, TextureHandle, TextureOptions, pos2};
use image::RgbaImage;

use super::work::Checked;
use shell::inspection::library_cache::LibraryView;
use ui::widgets::fitted;

/// The textures, and their sources.
#[derive(Default)]
pub(super) struct Thumbnails {
    library: Option<(Arc<LibraryView>, Vec<Option<TextureHandle>>)>,
    draft: Option<(Arc<Checked>, TextureHandle)>,
}

impl Thumbnails {
    /// Uploads new pictures.
    pub(super) fn make(
        &mut self,
        ctx: &Context,
        library: Option<&Arc<LibraryView>>,
        checked: Option<&Arc<Checked>>,
    ) {
        if let Some(library) = library
            && self
                .library
                .as_ref()
                .is_none_or(|(of, _)| !Arc::ptr_eq(of, library))
        {
            let all = library.thumbnails.iter().map(|thumbnail| {
                let thumbnail = thumbnail.as_ref()?;
                Some(texture(ctx, "enrolled part", thumbnail))
            });
            self.library = Some((Arc::clone(library), all.collect()));
        }
        if let Some(checked) = checked
            && self
                .draft
                .as_ref()
                .is_none_or(|(of, _)| !Arc::ptr_eq(of, checked))
        {
            let made = texture(ctx, "draft", &checked.enrolled.part.thumbnail);
            self.draft = Some((Arc::clone(checked), made));
        }
    }

    /// Texture of the enrolled part at this index.
    pub(super) fn of_part(&self, index: usize) -> Option<&TextureHandle> {
        self.library.as_ref()?.1.get(index)?.as_ref()
    }

    /// Texture of the part that would be stored.
    pub(super) fn of_draft(&self) -> Option<&TextureHandle> {
        Some(&self.draft.as_ref()?.1)
    }
}

/// Draws a picture as large as the rectangle allows.
pub(super) fn paint_fitted(painter: &Painter, texture: &TextureHandle, rect: Rect) {
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let at = fitted(rect, texture.aspect_ratio());
    painter.image(texture.id(), at, whole, Color32::WHITE);
}

/// Uploads a picture.
pub(super) fn texture(ctx: &Context, name: &str, image: &RgbaImage) -> TextureHandle {
    let size = [image.width() as usize, image.height() as usize];
    let image = ColorImage::from_rgba_unmultiplied(size, image.as_raw());
    ctx.load_texture(name, image, TextureOptions::LINEAR)
}
