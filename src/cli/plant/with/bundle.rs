//! `partsight library keys`, `publish`, `take`, `version` and `versions`: one library for many cells.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use jiff::Timestamp;
use serde::Serialize;

use crate::cli::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table},
};
use files::file_name;
use geometry::error::Advice as _;
use inspection::library::{LibraryFolder, LibraryPlace, PartName, PartNumbers, TakenVersion};
use plant::bundle::{
    self, BundleError, BundleStore, Installed, KeyFiles, LocalPart, LocalParts, Manifest,
    PublishedVersion, SigningKey, StoreAddress, Take, TakenBundle, TrustedKey, make_keys,
};

/// Make the keys that sign and verify versions of a library
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight library keys keys

Writes library.key, the private key, which stays with the publisher and which only its owner can read, and library.pub, \
the public key, which every cell gets. Existing keys are never replaced.")]
pub(crate) struct KeysArgs {
    /// The folder for both; created if missing
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Publish the library as the next version
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight library publish --to /mnt/plant/library --key keys/library.key --note \"New doors\"
  partsight library publish --to s3://parts/hall-3 --key keys/library.key --library parts

A store is an existing folder, or s3://BUCKET/PREFIX. S3 takes endpoint, region and credentials from AWS_ENDPOINT, \
AWS_REGION, AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY; over plain HTTP only with AWS_ALLOW_HTTP=true.
Every part is loaded first, so that only a library that can be taken is published.")]
pub(crate) struct PublishArgs {
    /// The store
    #[arg(long, value_name = "STORE")]
    to: String,
    /// The private key, which signs the version
    #[arg(long, value_name = "FILE")]
    key: PathBuf,
    /// What is new, for people; at most 2000 characters
    #[arg(long, value_name = "TEXT", default_value = "")]
    note: String,
}

/// Replace all parts of the library by a published version: whole or not at all
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight library take --from /mnt/plant/library --trust library.pub
  partsight library take --from s3://parts/hall-3 --trust library.pub --library parts
  partsight library take --from s3://parts/hall-3 --trust library.pub --version 6

Signature, digest and every part are checked before anything is changed. Parts that the version replaces are moved to the \
library's .trash. A spray path that was stored here stays with its part if the version has the same reference of the part \
and no path for it. Inspections do not need the store: they use the installed library. A running program keeps the library \
that it read at its start; only the window, and serve --take, notice the change by themselves.")]
pub(crate) struct TakeArgs {
    /// The store, as for publish (partsight library publish --help)
    #[arg(long, value_name = "STORE")]
    from: String,
    /// The public key of whoever publishes
    #[arg(long, value_name = "FILE")]
    trust: PathBuf,
    /// Take this version, even an older one; default: the newest, if it is newer than the installed one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    version: Option<u32>,
    /// Also move parts to the library's .trash that were enrolled or changed here, or whose spray path does not fit the version
    #[arg(long)]
    replace: bool,
}

/// List the versions in a store, the newest first; exit code 1 if one of them is damaged
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight library versions /mnt/plant/library
  partsight library versions s3://parts/hall-3 --json

KEY is the beginning of the public key's SHA-256, as library keys shows it: only library take checks it against the key \
that you trust. HERE marks the version that the library was taken from.")]
pub(crate) struct VersionsArgs {
    /// The store, as for publish (partsight library publish --help)
    #[arg(value_name = "STORE")]
    store: String,
    /// Write a line of JSON per version
    #[arg(long)]
    json: bool,
}

/// Subcommands of `library`.
#[derive(Debug, Subcommand)]
pub(crate) enum LibraryCommand {
    Keys(KeysArgs),
    Publish(PublishArgs),
    Take(TakeArgs),
    /// Show which published version the library was taken from, and what has changed since
    Version,
    Versions(VersionsArgs),
}

/// Runs the subcommand.
pub(crate) fn run(
    command: &LibraryCommand,
    library: &LibraryChoice,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    match command {
        LibraryCommand::Keys(asked) => make(asked, console),
        LibraryCommand::Publish(asked) => publish(library, asked, console),
        LibraryCommand::Take(asked) => take(library, asked, console),
        LibraryCommand::Version => version(library, console),
        LibraryCommand::Versions(asked) => versions(library, asked, console),
    }
}

fn make(args: &KeysArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let KeyFiles { private, public } = make_keys(&args.folder).advised()?;
    let key = TrustedKey::load(&public).advised()?;
    console.line(&format_args!("Made the key {key}"));
    let private = private.display();
    console.line(&format_args!(
        "  {private}  to publish with: keep it secret, and keep a copy in a safe place"
    ));
    console.line(&format_args!("  {}  for every cell", public.display()));
    Ok(Outcome::Accepted)
}

fn publish(
    choice: &LibraryChoice,
    args: &PublishArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let store = open_store(&args.to)?;
    let key = SigningKey::load(&args.key).advised()?;
    let library = choice.open(console)?.into_folder().advised()?;
    let manifest = bundle::publish(&library, &store, &key, &args.note).advised()?;
    let Manifest {
        version, num_parts, ..
    } = manifest;
    console.line(&format_args!(
        "Published version {version}: parts: {num_parts}"
    ));
    console.line(&format_args!(
        "  to {}, signed with the key {}",
        store.address(),
        key.trusted()
    ));
    Ok(Outcome::Accepted)
}

fn take(choice: &LibraryChoice, args: &TakeArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let store = open_store(&args.from)?;
    let trusted = TrustedKey::load(&args.trust).advised()?;
    let library = choice.open_or_create()?;
    let asked = Take {
        version: args.version,
        local: if args.replace {
            LocalParts::Trash
        } else {
            LocalParts::Keep
        },
    };
    match bundle::take(&library, &store, trusted, asked).advised()? {
        Installed::Already(manifest) => {
            console.line(&format_args!(
                "Version {} is installed already",
                manifest.version
            ));
        }
        Installed::New {
            manifest,
            trashed,
            kept_paths,
        } => {
            let Manifest {
                version, num_parts, ..
            } = manifest;
            console.line(&format_args!("Took version {version}: parts: {num_parts}"));
            console.entry("from", store.address());
            console.entry("published", &manifest.published_at.strftime(MINUTE));
            if !manifest.note.is_empty() {
                console.entry("note", &manifest.note);
            }
            for kept in trashed {
                console.entry("in .trash", &file_name(&kept));
            }
            for part in kept_paths {
                console.entry("kept path", &part);
            }
            note_other_numbers(&library, &manifest.numbers, console)?;
        }
    }
    Ok(Outcome::Accepted)
}

/// Reports the parts that robots of this cell know by another number than the published one.
fn note_other_numbers(
    library: &LibraryFolder,
    published: &PartNumbers,
    console: &mut Console,
) -> anyhow::Result<()> {
    let numbers = library.numbers().advised()?;
    let names = library.names().advised()?;
    let is_here = |part: &PartName| names.iter().any(|name| name == part.as_str());
    for (part, theirs) in published.all().filter(|(part, _)| is_here(part)) {
        match numbers.number_of(part) {
            Some(here) if here != theirs => console.entry(
                "number",
                &format_args!("{part} keeps {here}, the version has {theirs}"),
            ),
            Some(_) => {}
            None => console.entry(
                "number",
                &format_args!("{part} gets a new one: another part has {theirs} here"),
            ),
        }
    }
    Ok(())
}

fn version(choice: &LibraryChoice, console: &mut Console) -> anyhow::Result<Outcome> {
    let place = choice.open(console)?;
    let taken = place
        .folder()
        .map(TakenBundle::read)
        .transpose()
        .advised()?;
    let (Some(folder), Some(taken)) = (place.folder(), taken.flatten()) else {
        console.line(&format_args!(
            "{}: no version was taken into this library",
            place.location()
        ));
        console.note(&"  to do: See which versions a store has: partsight library versions STORE");
        return Ok(Outcome::Accepted);
    };
    let manifest = &taken.manifest;
    console.line(&format_args!("Version {}", manifest.version));
    console.entry("store", &taken.store);
    console.entry("published", &manifest.published_at.strftime(MINUTE));
    console.entry("taken", &taken.taken_at.strftime(MINUTE));
    if !manifest.note.is_empty() {
        console.entry("note", &manifest.note);
    }
    console.entry("parts", &manifest.num_parts);
    let differences = taken.differences(folder).advised()?;
    if !differences.is_empty() {
        let names: Vec<String> = differences.iter().map(LocalPart::to_string).collect();
        console.entry("changed", &names.join(", "));
    }
    Ok(Outcome::Accepted)
}

/// A version of a store, as `versions --json` writes it.
#[derive(Serialize)]
struct VersionLine<'a> {
    version: u32,
    /// Null in a version that cannot be read, as all that follows but `taken` and `damage`.
    published_at: Option<Timestamp>,
    num_parts: Option<usize>,
    bytes: Option<u64>,
    note: Option<&'a str>,
    /// As messages show it.
    key: Option<String>,
    /// Whether the library was taken from it.
    taken: bool,
    /// Why it cannot be read; null if it can.
    damage: Option<String>,
}

fn versions(
    choice: &LibraryChoice,
    args: &VersionsArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let store = open_store(&args.store)?;
    let place = choice.open(console)?;
    let taken = match place.folder().map(TakenBundle::read).transpose() {
        Ok(taken) => taken.flatten(),
        Err(error) => {
            console.warn(&error, &error);
            None
        }
    };
    let versions = bundle::versions(&store).advised()?;
    if versions.is_empty() && !args.json {
        console.line(&format_args!(
            "{}: no version was published",
            store.address()
        ));
    }
    let mut table = Table::new(&["VERSION", "PUBLISHED", "PARTS", "KEY", "HERE", "NOTE"]);
    let mut outcome = Outcome::Accepted;
    for PublishedVersion { version, manifest } in &versions {
        let damage = manifest.as_ref().err();
        if let Some(error) = damage {
            outcome = Outcome::NotAccepted;
            console.warn(error, error);
        }
        let known = manifest.as_ref().ok();
        let line = VersionLine {
            version: *version,
            published_at: known.map(|(manifest, _)| manifest.published_at),
            num_parts: known.map(|(manifest, _)| manifest.num_parts),
            bytes: known.map(|(manifest, _)| manifest.bundle.bytes),
            note: known.map(|(manifest, _)| manifest.note.as_str()),
            key: known.map(|(_, key)| key.to_string()),
            taken: (taken.as_ref().zip(known))
                .is_some_and(|(taken, (manifest, key))| taken.is_of(manifest, *key)),
            damage: damage.map(ToString::to_string),
        };
        if args.json {
            console.line(&serde_json::to_string(&line)?);
            continue;
        }
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".into());
        let published = (line.published_at).map(|at| at.strftime(MINUTE).to_string());
        table.row([
            version.to_string(),
            or_dash(published),
            or_dash(line.num_parts.map(|num| num.to_string())),
            or_dash(line.key),
            if line.taken { "taken" } else { "" }.to_owned(),
            line.note.map_or("cannot be read", first_line).to_owned(),
        ]);
    }
    if !versions.is_empty() && !args.json {
        console.table(&table);
    }
    Ok(outcome)
}

/// A note may have several lines, a row of a table has one.
fn first_line(note: &str) -> &str {
    note.lines().next().unwrap_or_default()
}

/// Which published version a library was taken from, in words. Without one that can be read, it is not shown.
pub(crate) fn taken_version(place: &LibraryPlace, console: &Console) -> Option<String> {
    let version = read_version(place).unwrap_or_else(|error| {
        console.warn(&error, &error);
        None
    })?;
    let TakenVersion {
        version,
        store,
        is_changed,
    } = version;
    let changed = if is_changed {
        ", changed here since"
    } else {
        ""
    };
    Some(format!("version {version} of {store}{changed}"))
}

/// The published version that a library was taken from; the error and its advice.
pub(crate) fn version_of(place: &LibraryPlace) -> Result<Option<TakenVersion>, [String; 2]> {
    read_version(place).map_err(|error| [error.to_string(), error.advice()])
}

fn read_version(place: &LibraryPlace) -> Result<Option<TakenVersion>, BundleError> {
    let Some(folder) = place.folder() else {
        return Ok(None);
    };
    let Some(taken) = TakenBundle::read(folder)? else {
        return Ok(None);
    };
    Ok(Some(TakenVersion {
        version: taken.manifest.version,
        is_changed: !taken.differences(folder)?.is_empty(),
        store: taken.store,
    }))
}

/// To the minute, in UTC.
const MINUTE: &str = "%Y-%m-%d %H:%M UTC";

/// Not parsed by clap, whose message would show a password in the address.
pub(super) fn open_store(address: &str) -> anyhow::Result<BundleStore> {
    let address: StoreAddress = address.parse().advised()?;
    BundleStore::open(address).advised()
}
