//! `partsight library`: the enrolled parts.

mod spray_path;
mod surface;

use crate::cli::input::parse_name;
use clap::{Args, Subcommand};

use super::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table, advised_error, marked_simulated},
    plant, read_part,
};
use geometry::units::{Metres, counted};
use inspection::library::{
    EntryError, LibraryError, LibraryFolder, LibraryListing, LibraryPlace, PartMeta, PartName,
    PartNaming, PartNumbers, SharedTitle, StoredPart,
};
use stages::reference::{Coverage, ReferenceParams};
use texts::Message;

/// List, show, check, rename, remove and restore enrolled parts, and store their spray paths
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight library list
  partsight library show front_door --library /media/stick/parts
  partsight library verify
  partsight library rename front_door --title \"Front door, left\"
  partsight library remove front_door
  partsight library restore front_door
  partsight library path front_door path.csv
  partsight library surface front_door --check true --tolerance 2.5

A library is a folder with one folder per part. Copy it to take it along.")]
pub(super) struct LibraryArgs {
    #[command(flatten)]
    library: LibraryChoice,
    #[command(subcommand)]
    command: LibraryCommand,
}

#[derive(Debug, Subcommand)]
enum LibraryCommand {
    /// Show all enrolled parts
    List,
    /// Show everything about one part
    Show {
        /// Name of the part
        #[arg(value_parser = parse_name)]
        name: PartName,
    },
    /// Check every file of every part; exit code 1 if something is damaged
    Verify,
    /// Rename a part, or change its title or notes; what is not given is kept
    Rename(RenameArgs),
    /// Move a part to the library's .trash folder
    Remove {
        /// Name of the part
        #[arg(value_parser = parse_name)]
        name: PartName,
    },
    /// Restore the part that was last removed or replaced under this name
    Restore {
        /// Name of the part
        #[arg(value_parser = parse_name)]
        name: PartName,
    },
    Path(spray_path::PathArgs),
    Surface(surface::SurfaceArgs),
    #[command(flatten)]
    Plant(plant::LibraryCommand),
}

#[derive(Debug, Args)]
struct RenameArgs {
    /// Name of the part
    #[arg(value_parser = parse_name)]
    name: PartName,
    /// Its new name: lowercase letters, digits, _ and -
    #[arg(long, value_name = "NAME", value_parser = parse_name)]
    to: Option<PartName>,
    /// Title shown to people; at most 80 characters
    #[arg(long, value_name = "TEXT", value_parser = super::enrol::parse_title)]
    title: Option<String>,
    /// Anything worth remembering
    #[arg(long, value_name = "TEXT")]
    notes: Option<String>,
}

pub(super) fn run(args: &LibraryArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    match &args.command {
        LibraryCommand::List => list(&args.library, console),
        LibraryCommand::Show { name } => show(&args.library, name, console),
        LibraryCommand::Verify => verify(&args.library, console),
        LibraryCommand::Rename(asked) => rename(&args.library, asked, console),
        LibraryCommand::Remove { name } => remove(&args.library, name, console),
        LibraryCommand::Restore { name } => restore(&args.library, name, console),
        LibraryCommand::Path(asked) => spray_path::run(&args.library, asked, console),
        LibraryCommand::Surface(asked) => surface::run(&args.library, asked, console),
        LibraryCommand::Plant(command) => plant::library(command, &args.library, console),
    }
}

fn list(choice: &LibraryChoice, console: &mut Console) -> anyhow::Result<Outcome> {
    let place = choice.open(console)?;
    let LibraryListing { parts, problems } = place.list().advised()?;
    for problem in &problems {
        console.warn(&format_args!("set aside {problem}"), problem);
    }
    console.line(&format_args!(
        "{} ({}): {}",
        place.location(),
        place.describe(),
        counted(parts.len(), "part", "parts")
    ));
    if let Some(version) = plant::taken_version(&place, console) {
        console.line(&format_args!("  {version}"));
    }
    if parts.is_empty() {
        let hint = place.folder().and_then(super::hint);
        let hint = hint.unwrap_or_else(|| "Enrol one: partsight enrol FILE --name NAME".into());
        console.note(&format_args!("  to do: {hint}"));
        return Ok(Outcome::Accepted);
    }
    let mut table = Table::new(&[
        "NAME",
        "NUMBER",
        "TITLE",
        "W x H x D mm",
        "POINTS",
        "SEEN FROM",
        "ENROLLED",
        "FROM",
    ]);
    let numbers = numbers_of(&place, console);
    for meta in &parts {
        let name = match meta.reference_of() {
            Some(part) => format!("{} (reference of {part})", meta.name),
            None => meta.name.to_string(),
        };
        table.row([
            name,
            (numbers.number_of(&meta.name)).map_or_else(|| "-".into(), |number| number.to_string()),
            meta.title.clone(),
            meta.enrolled.size_mm.map_or_else(|| "-".into(), in_words),
            meta.cloud.num_points.to_string(),
            seen_from(meta.coverage).to_owned(),
            meta.enrolled.at.strftime("%Y-%m-%d").to_string(),
            marked_simulated(&meta.enrolled.from, meta.simulated),
        ]);
    }
    console.table(&table);
    Ok(Outcome::Accepted)
}

fn show(choice: &LibraryChoice, name: &PartName, console: &mut Console) -> anyhow::Result<Outcome> {
    let place = choice.open(console)?;
    let StoredPart {
        meta,
        reference,
        warnings,
    } = read_part(&place, name)?;
    for warning in &warnings {
        console.warn(warning, warning);
    }
    let numbers = numbers_of(&place, console);
    let mut table = Table::default();
    let mut row = |what: &str, text: String| {
        if !text.is_empty() {
            table.row([what.to_owned(), text]);
        }
    };
    row("name", meta.name.to_string());
    row(
        "reference of",
        meta.reference_of()
            .map(PartName::to_string)
            .unwrap_or_default(),
    );
    if let Some(number) = numbers.number_of(&meta.name) {
        row("number", format!("{number}, by which robots know it"));
    }
    row("title", meta.title);
    row("notes", meta.notes);
    row(
        "size",
        format!(
            "{} mm, width x height x depth as enrolled",
            reference
                .size()
                .map_or_else(|| "-".into(), |sides| in_words(sides.map(Metres::mm)))
        ),
    );
    row("points", reference.cloud.points.len().to_string());
    row("seen from", seen_from(meta.coverage).to_owned());
    if let Some(side) = meta.side {
        row("painted from", format!("the {}", side.name()));
    }
    if let Some(view) = reference.views.first() {
        let outline = view.signature().perimeter;
        row(
            "outline",
            format!(
                "{:.0} mm long; openings: {}",
                outline.mm(),
                view.contour().openings.len()
            ),
        );
        row("views", format!("{} prepared", reference.views.len()));
    }
    if let Some(spray) = &meta.spray {
        let points = counted(spray.num_points, "point", "points");
        row("path", format!("spray path of {points}"));
    }
    row(
        "enrolled",
        meta.enrolled.at.strftime("%Y-%m-%d %H:%M UTC").to_string(),
    );
    row(
        "from",
        format!(
            "{} ({})",
            marked_simulated(&meta.enrolled.from, meta.simulated),
            meta.enrolled.how
        ),
    );
    row(
        "folder",
        match place.folder() {
            Some(folder) => folder.path().join(name.as_str()).display().to_string(),
            None => place.location(),
        },
    );
    if let Some(picture) = place.folder().and_then(|f| f.thumbnail(name.as_str())) {
        row("picture", picture.display().to_string());
    }
    console.table(&table);
    Ok(Outcome::Accepted)
}

fn verify(choice: &LibraryChoice, console: &mut Console) -> anyhow::Result<Outcome> {
    let place = choice.open(console)?;
    let load = place.verify(&ReferenceParams::default()).advised()?;
    for meta in &load.parts {
        let is_odd = load.warnings.iter().any(|w| w.entry == meta.name.as_str());
        if !is_odd {
            console.line(&format_args!("OK       {}", meta.name));
        }
    }
    for warning in &load.warnings {
        console.line(&format_args!("odd      {warning}"));
    }
    for problem in &load.problems {
        let word = match problem.reason {
            EntryError::Newer(_) => "NEWER  ",
            _ => "DAMAGED",
        };
        console.line(&format_args!("{word}  {problem}"));
    }
    let skipped = place
        .folder()
        .map_or(Ok(Vec::new()), LibraryFolder::skipped);
    for name in skipped.advised()? {
        console.line(&format_args!(
            "skipped  {name}: not the name of a part (lowercase letters, digits, _ and -)"
        ));
    }
    for problem in &load.problems {
        console.warn(problem, problem);
    }
    for warning in &load.warnings {
        console.warn(warning, warning);
    }
    let numbers = place.numbers();
    if let Err(error) = &numbers {
        console.warn(error, error);
    }
    let is_sound = load.problems.is_empty() && load.warnings.is_empty() && numbers.is_ok();
    Ok(Outcome::accepted_if(is_sound))
}

fn remove(
    choice: &LibraryChoice,
    name: &PartName,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let folder = choice.open_to_change()?;
    let trash = folder.remove(name).advised()?;
    console.line(&format_args!(
        "Removed {name}. It is kept in {}",
        trash.display()
    ));
    console.line(&format_args!(
        "To restore it: partsight library restore {name}, or move that folder back to {}",
        folder.path().join(name.as_str()).display()
    ));
    for reference in folder.references_of(name).advised()? {
        console.line(&format_args!(
            "{reference} is still a reference of {name}, and keeps that name"
        ));
    }
    Ok(Outcome::Accepted)
}

fn rename(
    choice: &LibraryChoice,
    asked: &RenameArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let RenameArgs {
        name,
        to,
        title,
        notes,
    } = asked;
    if (to, title, notes) == (&None, &None, &None) {
        return Err(advised_error(
            format!("nothing to change about {name}"),
            "Give --to NAME, --title TEXT or --notes TEXT",
        ));
    }
    let folder = choice.open_to_change()?;
    let before = folder.words(name).advised()?;
    let words = PartNaming {
        name: to.clone().unwrap_or(before.name),
        title: title.clone().unwrap_or(before.title),
        notes: notes.clone().unwrap_or(before.notes),
    };
    let renamed = folder.rename(name, &words).advised()?;
    if words.name != *name {
        console.line(
            &Message::new("renamed")
                .with("before", name.as_str())
                .with("now", words.name.as_str()),
        );
    } else if to.is_some() {
        console.line(&format_args!("{name} already has this name"));
    }
    match title.as_deref() {
        Some("") => console.line(&format_args!("{} has no title now", words.name)),
        Some(title) => console.line(&format_args!("The title of {} is now: {title}", words.name)),
        None => {}
    }
    if let Some(title) = &title {
        let parts = folder.list().advised()?.parts;
        let renamed = parts.iter().find(|part| part.name == words.name);
        let of = renamed.map_or(&words.name, PartMeta::part_name).as_str();
        if let Some(shared) = SharedTitle::among(title, words.name.as_str(), of, &parts) {
            console.warn(&shared, &shared);
        }
    }
    if notes.is_some() {
        console.line(&format_args!("The notes of {} were changed", words.name));
    }
    match renamed.num_references {
        0 => {}
        1 => console.line(&"  1 more reference of it was renamed along"),
        n => console.line(&format_args!(
            "  {n} more references of it were renamed along"
        )),
    }
    if let Some(former) = renamed.former {
        console.line(&format_args!(
            "  the previous version is kept in {}",
            former.display()
        ));
    }
    Ok(Outcome::Accepted)
}

fn restore(
    choice: &LibraryChoice,
    name: &PartName,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let folder = choice.open_to_change()?;
    let trashed = folder.trashed().advised()?;
    let Some(newest) = trashed.iter().find(|trashed| trashed.name == *name) else {
        let kept = folder.path().join(".trash").join(name.as_str());
        return Err(LibraryError::NotInTrash { kept }).advised();
    };
    let restored = folder.restore(&newest.kept).advised()?;
    console.line(&format_args!("Restored {name}"));
    if let Some(former) = restored.replaced {
        console.line(&format_args!(
            "  the part that it replaced is kept in {}",
            former.display()
        ));
    }
    Ok(Outcome::Accepted)
}

/// The numbers by which robots know the parts; none if they cannot be read.
fn numbers_of(place: &LibraryPlace, console: &Console) -> PartNumbers {
    place.numbers().unwrap_or_else(|error| {
        console.warn(&error, &error);
        PartNumbers::default()
    })
}

pub(super) fn seen_from(coverage: Coverage) -> &'static str {
    match coverage {
        Coverage::OneSide => "one side",
        Coverage::AllAround => "all around",
        Coverage::SeveralSides => "several sides",
    }
}

/// Formats width, height and depth of the reference as enrolled, millimetres.
fn in_words([width, height, depth]: [f64; 3]) -> String {
    format!("{width:.0} x {height:.0} x {depth:.0}")
}
