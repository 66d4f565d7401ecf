//! The library prepared for a recipe: a reference can only be compared with scenes that were projected, outlined and described
//! with the same parameters.

use std::{
    ops::Deref,
    sync::{Arc, Mutex},
};

use super::library_cache::LoadedLibrary;
use geometry::error::lock;
use inspection::{
    library::Library,
    pipeline::{ProgressObserver, Recipe},
};
use stages::reference::{Reference, ReferenceParams};

/// The library prepared last with parameters other than the default.
#[derive(Debug, Default)]
pub struct PreparedLibraryCache(Mutex<Option<(ReferenceParams, Arc<Library>)>>);

/// A library prepared for a recipe.
#[derive(Debug)]
pub enum PreparedLibrary<'a> {
    /// The library as it was loaded.
    AsLoaded(&'a Library),
    /// Prepared again with other parameters.
    Anew(Arc<Library>),
}

impl Deref for PreparedLibrary<'_> {
    type Target = Library;

    fn deref(&self) -> &Library {
        match self {
            Self::AsLoaded(library) => library,
            Self::Anew(library) => library,
        }
    }
}

impl LoadedLibrary {
    /// Returns the references prepared with the recipe's parameters. Takes as long as loading the library unless the
    /// parameters are the default or those of the last call; `None` if cancelled.
    pub fn fitting(
        &self,
        recipe: &Recipe,
        watch: &dyn ProgressObserver,
    ) -> Option<PreparedLibrary<'_>> {
        let params = recipe.reference_params();
        if params == ReferenceParams::default() {
            return Some(PreparedLibrary::AsLoaded(&self.library));
        }
        let lock = || lock(&self.fitted.0);
        if let Some((known, library)) = &*lock()
            && *known == params
        {
            return Some(PreparedLibrary::Anew(Arc::clone(library)));
        }
        let num = self.library.references.len();
        let references = self.library.references.iter().zip(&self.shown.parts);
        let references = references.map(|(loaded, meta)| {
            if watch.is_cancelled() {
                return None;
            }
            // Without an outline at these parameters it keeps the one it was loaded with, and its index.
            let cloud = Arc::clone(&loaded.cloud);
            let prepared = Reference::prepare(&loaded.name, cloud, meta.coverage, &params);
            Some(prepared.map_or_else(
                |_| loaded.clone(),
                |prepared| prepared.with_cut(loaded.cut).for_library_of(num),
            ))
        });
        let library = Arc::new(Library {
            references: references.collect::<Option<_>>()?,
        });
        *lock() = Some((params, Arc::clone(&library)));
        Some(PreparedLibrary::Anew(library))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspection::library_cache::LibraryCache;
    use inspection::pipeline::Unwatched;

    struct CancellableProgress;
    impl ProgressObserver for CancellableProgress {
        fn is_cancelled(&self) -> bool {
            true
        }
    }

    #[test]
    fn references_have_as_many_rays_as_the_recipe_gives_scenes() {
        let loaded = LibraryCache::default().get();
        let mut recipe = Recipe::default();
        let as_loaded = loaded.fitting(&recipe, &Unwatched).expect("loaded");
        assert!(matches!(as_loaded, PreparedLibrary::AsLoaded(_)));
        recipe.signature.num_rays = 128;
        let fitted = loaded.fitting(&recipe, &Unwatched).expect("prepared");
        let names = |library: &Library| -> Vec<String> {
            let references = library.references.iter();
            references.map(|r| r.name.clone()).collect()
        };
        assert_eq!(names(&fitted), names(&as_loaded));
        for view in fitted.references.iter().flat_map(|r| &r.views) {
            assert_eq!(view.signature().rays.len(), 128);
        }
        let again = loaded.fitting(&recipe, &Unwatched).expect("known");
        let (PreparedLibrary::Anew(first), PreparedLibrary::Anew(again)) = (fitted, again) else {
            panic!("prepared anew");
        };
        assert!(Arc::ptr_eq(&first, &again));

        recipe.signature.num_rays = 64;
        assert!(loaded.fitting(&recipe, &CancellableProgress).is_none());
    }
}
