//! `partsight serve --take`: takes new versions of the library while the service runs.

use std::{
    path::PathBuf,
    sync::mpsc::{self, Receiver, SyncSender},
    thread,
    time::Duration,
};

use clap::Args;

use super::bundle::open_store;
use crate::cli::{
    console::{Advised as _, Console, advice_of, advised_error},
    input::within,
    numbers::NumbersChoice,
};
use geometry::error::guarded;
use inspection::library::{LibraryFolder, LibraryLoad, LibraryPlace};
use plant::bundle::{
    self, BundleError, BundleStore, Installed, LocalParts, Manifest, Take, TakenBundle, TrustedKey,
};
use serve::{LibraryStatus, Problem, ServeError, ServerHandle};
use stages::reference::ReferenceParams;
use station::NumberedPart;

/// The reason in the status if a version could not be taken.
const NOT_TAKEN: &str = "library_not_taken";

#[derive(Debug, Args)]
pub(crate) struct TakeArgs {
    /// Take new versions of the library from this store while running (partsight library take --help)
    #[arg(long, value_name = "STORE", requires = "trust")]
    take: Option<String>,
    /// The public key of whoever publishes the versions
    #[arg(long, value_name = "FILE", requires = "take")]
    trust: Option<PathBuf>,
    /// Pause between two looks into the store, seconds (1 to 86400)
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = |text: &str| within(text, &(1.0..=86_400.0)))]
    take_every: f64,
}

/// A store to take versions from.
pub(super) struct ChosenStore {
    store: BundleStore,
    trusted: TrustedKey,
    pause: Duration,
}

impl TakeArgs {
    /// Returns the store, if one is given; reads the key.
    pub(super) fn chosen(&self) -> anyhow::Result<Option<ChosenStore>> {
        let Some((address, trust)) = self.take.as_ref().zip(self.trust.as_ref()) else {
            return Ok(None);
        };
        Ok(Some(ChosenStore {
            store: open_store(address)?,
            trusted: TrustedKey::load(trust).advised()?,
            pause: Duration::from_secs_f64(self.take_every),
        }))
    }
}

/// A version to use from now on.
struct NewVersion {
    version: u32,
    load: LibraryLoad,
}

/// A new version, nothing new, or why it is not known.
type Look = Result<Option<NewVersion>, Problem>;

/// Looks into the store on a thread of its own, since a store may take minutes to answer.
struct StoreWatch {
    folder: LibraryFolder,
    chosen: ChosenStore,
    params: ReferenceParams,
    /// The version that was loaded last.
    in_use: Option<Manifest>,
}

impl StoreWatch {
    fn run(mut self, looks: &SyncSender<Look>) {
        loop {
            let look = guarded(|| self.look().map_err(|error| Problem::of(NOT_TAKEN, &error)));
            let look = look.unwrap_or_else(|fault| Err(Problem::of(NOT_TAKEN, &fault)));
            if looks.send(look).is_err() {
                return;
            }
            thread::sleep(self.chosen.pause);
        }
    }

    fn look(&mut self) -> Result<Option<NewVersion>, BundleError> {
        let ChosenStore { store, trusted, .. } = &self.chosen;
        let newest = Take {
            version: None,
            local: LocalParts::Keep,
        };
        let (Installed::Already(manifest) | Installed::New { manifest, .. }) =
            bundle::take(&self.folder, store, *trusted, newest)?;
        // Another program may have taken it, too.
        if self.in_use.as_ref() == Some(&manifest) {
            return Ok(None);
        }
        let mut load = self.folder.load(&self.params)?;
        if let Some(problem) = load.problems.pop() {
            return Err(Box::new(problem).into());
        }
        let version = manifest.version;
        self.in_use = Some(manifest);
        Ok(Some(NewVersion { version, load }))
    }
}

/// Takes versions for a service.
pub(super) struct LibraryTaker<'a> {
    looks: Receiver<Look>,
    place: &'a LibraryPlace,
    numbers: &'a NumbersChoice,
    server: ServerHandle,
    /// Why the newest version cannot be used, although it was taken.
    unusable: Option<Problem>,
}

/// A library and its parts for robots, to be used in place of the present ones.
pub(crate) struct TakenLibrary {
    pub(crate) load: LibraryLoad,
    pub(crate) parts: Vec<NumberedPart>,
}

impl<'a> LibraryTaker<'a> {
    /// Starts to look into the store.
    pub(super) fn start(
        chosen: ChosenStore,
        place: &'a LibraryPlace,
        params: ReferenceParams,
        numbers: &'a NumbersChoice,
        server: ServerHandle,
    ) -> anyhow::Result<Self> {
        let Some(folder) = place.folder() else {
            return Err(advised_error(
                "--take replaces the parts of a library in a folder, but the library is inside the program",
                "Name a folder with --library",
            ));
        };
        let taken = TakenBundle::read(folder).advised()?;
        server.set_library(LibraryStatus {
            version: taken.map(|taken| taken.manifest.version),
            problem: None,
        });
        let watch = StoreWatch {
            folder: folder.clone(),
            chosen,
            params,
            // Another program may have taken a version since the library was loaded: the first look loads it again.
            in_use: None,
        };
        let (tell, looks) = mpsc::sync_channel(1);
        // It is not joined: what it asks of a store cannot be interrupted, and the library is whole wherever it ends.
        thread::Builder::new()
            .name("library take".into())
            .spawn(move || watch.run(&tell))
            .map_err(|source| ServeError::NoThread { source })
            .advised()?;
        Ok(Self {
            looks,
            place,
            numbers,
            server,
            unusable: None,
        })
    }

    /// Returns a version that was taken since the last call. Reports a failure when it begins and when it is over.
    pub(super) fn taken(&mut self, console: &Console) -> Option<TakenLibrary> {
        let look = self.looks.try_recv().ok()?;
        let before = self.server.library().unwrap_or_default();
        let mut version = before.version;
        let (taken, problem) = match look {
            Err(problem) => (None, Some(problem)),
            Ok(None) => (None, self.unusable.clone()),
            Ok(Some(new)) => match self.numbers.parts(self.place, &new.load, console) {
                Ok(parts) => {
                    console.note(&format_args!(
                        "Library: version {} from now on",
                        new.version
                    ));
                    version = Some(new.version);
                    self.unusable = None;
                    let load = new.load;
                    (Some(TakenLibrary { load, parts }), None)
                }
                Err(error) => {
                    self.unusable = Some(unusable(new.version, &error));
                    (None, self.unusable.clone())
                }
            },
        };
        if problem != before.problem {
            match &problem {
                Some(Problem { message, .. }) => console.note(&format_args!(
                    "warning: the present library stays in use: {message}"
                )),
                None => console.note(&"New versions of the library can be taken again"),
            }
        }
        self.server.set_library(LibraryStatus { version, problem });
        taken
    }
}

fn unusable(version: u32, error: &anyhow::Error) -> Problem {
    let advice = advice_of(error).unwrap_or("Start the service again with other options");
    Problem {
        reason: NOT_TAKEN.into(),
        message: format!("version {version} cannot be used: {error:#} (to do: {advice})"),
    }
}
