//! Textures of the small pictures: those of the library, and that of the draft.

use std::sync::Arc;

use egui::{Context, TextureHandle};

use super::work::Checked;
use crate::shared::{self, thumbnail_texture};
use shell::inspection::library_cache::LibraryView;

/// The textures, and the source of the draft's.
#[derive(Default)]
pub(super) struct Thumbnails {
    library: shared::Thumbnails,
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
        if let Some(library) = library {
            self.library.make(ctx, library);
        }
        if let Some(checked) = checked
            && self
                .draft
                .as_ref()
                .is_none_or(|(of, _)| !Arc::ptr_eq(of, checked))
        {
            let made = thumbnail_texture(ctx, "draft", &checked.enrolled.part.thumbnail);
            self.draft = Some((Arc::clone(checked), made));
        }
    }

    /// Texture of the enrolled part at this index.
    pub(super) fn of_part(&self, index: usize) -> Option<&TextureHandle> {
        self.library.of_part(index)
    }

    /// Texture of the part that would be stored.
    pub(super) fn of_draft(&self) -> Option<&TextureHandle> {
        Some(&self.draft.as_ref()?.1)
    }
}
