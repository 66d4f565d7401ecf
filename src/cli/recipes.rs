//! `partsight recipe`: manages recipes.

use crate::cli::input::parse_name;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, builder::NonEmptyStringValueParser};
use serde::Serialize;

use super::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table, advised_error},
    rack::RackFileChoice,
    recipe::{RecipeChoice, open_named},
};
use geometry::units::counted;
use inspection::{
    library::PartName,
    pipeline::{
        BUILT_IN, Expected, ExpectedError, ExpectedPart, MAX_NOTES, Recipe, RecipeError,
        RecipeFile, RecipeFolder, Replace,
        parameters::{PARAMETERS, Parameter, num_changed},
    },
};

/// List, show, save, rename, remove, export and import recipes: named sets of parameters
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight recipe save glossy --set accept.min_score=0.85 --notes \"clear coat\"
  partsight recipe save glossy_2 --recipe glossy --set segment.plane_distance=12
  partsight recipe save shift_a --expect \"left hook=fender,right hook=grille\"
  partsight recipe show shift_a --rack rack_a.toml
  partsight recipe list
  partsight recipe show glossy
  partsight recipe show glossy_2 --against glossy
  partsight recipe default glossy
  partsight recipe rename glossy shiny
  partsight recipe export glossy /media/stick/glossy.toml
  partsight recipe import /media/stick/glossy.toml
  partsight inspect door.pcd --recipe glossy

A recipe is a file with the parameters that differ from their defaults, and maybe the parts that should hang there. Yours are in your data folder, beside the
library; the window saves and opens the same ones. built-in is the program's own recipe: every parameter at its default.
A plain word is taken as a recipe's name; give a file with its folder or ending: ./glossy or glossy.toml.")]
pub(super) struct RecipeArgs {
    #[command(subcommand)]
    command: RecipeCommand,
}

#[derive(Debug, Subcommand)]
enum RecipeCommand {
    /// Show all recipes
    List {
        /// Write a line of JSON per recipe
        #[arg(long)]
        json: bool,
    },
    Show(ShowArgs),
    Save(SaveArgs),
    /// Rename a recipe; if it is the default, it stays the default
    Rename {
        /// Name of the recipe
        #[arg(value_parser = parse_name)]
        name: PartName,
        /// Its new name
        #[arg(value_parser = parse_name)]
        to: PartName,
    },
    /// Remove a recipe
    Remove {
        /// Name of the recipe
        #[arg(value_parser = parse_name)]
        name: PartName,
    },
    /// Show or choose the recipe that is used without --recipe
    Default {
        /// Name of the recipe
        #[arg(value_parser = parse_name)]
        name: Option<PartName>,
    },
    /// Add a recipe file to your recipes
    Import {
        /// The file
        file: PathBuf,
        /// Name to save it under; default: the one in the file
        #[arg(long, value_parser = parse_name)]
        name: Option<PartName>,
        /// Replace a recipe of the same name
        #[arg(long)]
        replace: bool,
    },
    /// Write a recipe to a file, to take it along
    Export {
        /// Name of the recipe
        #[arg(value_parser = parse_name)]
        name: PartName,
        /// The file
        file: PathBuf,
    },
}

/// Show the parameters that differ from their defaults, or from another recipe, and the parts that it expects
#[derive(Debug, Args)]
struct ShowArgs {
    /// The recipe, by its name or as a file
    #[arg(value_name = "NAME|FILE")]
    recipe: String,
    /// Compare with this recipe
    #[arg(long, value_name = "NAME|FILE", default_value = BUILT_IN)]
    against: String,
    /// Write one line of JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    rack: RackFileChoice,
}

/// Save a recipe: the one named by --recipe, or your default, with the changes given
#[derive(Debug, Args)]
struct SaveArgs {
    /// Name of the recipe: lowercase letters, digits, _ and -
    #[arg(value_parser = parse_name)]
    name: PartName,
    #[command(flatten)]
    recipe: RecipeChoice,
    /// The parts that should hang there, as in inspect --expect; default: those of the recipe that it is based on
    #[arg(long, value_name = "[PLACE=]PART,...", value_delimiter = ',', value_parser = NonEmptyStringValueParser::new())]
    expect: Vec<String>,
    /// Anything worth remembering; default: the notes of the recipe that it is based on
    #[arg(long, value_name = "TEXT", value_parser = parse_notes)]
    notes: Option<String>,
    /// Replace a recipe of the same name
    #[arg(long)]
    replace: bool,
}

fn parse_notes(text: &str) -> Result<String, String> {
    match text.chars().count() {
        0..=MAX_NOTES => Ok(text.to_owned()),
        found => Err(RecipeError::LongNotes { found }.to_string()),
    }
}

pub(super) fn run(args: &RecipeArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    match &args.command {
        RecipeCommand::List { json } => list(*json, console),
        RecipeCommand::Show(asked) => return show(asked, console),
        RecipeCommand::Save(asked) => save(asked, console),
        RecipeCommand::Rename { name, to } => rename(name, to, console),
        RecipeCommand::Remove { name } => remove(name, console),
        RecipeCommand::Default { name } => default(name.as_ref(), console),
        RecipeCommand::Import {
            file,
            name,
            replace,
        } => import(file, name.as_ref(), *replace, console),
        RecipeCommand::Export { name, file } => export(name, file, console),
    }?;
    Ok(Outcome::Accepted)
}

fn folder() -> anyhow::Result<RecipeFolder> {
    RecipeFolder::of_user().advised()
}

/// A recipe of the list, as `--json` writes it.
#[derive(Serialize)]
struct ListLine<'a> {
    name: &'a str,
    identity: String,
    is_default: bool,
    num_changed: usize,
    notes: &'a str,
}

fn list(json: bool, console: &mut Console) -> anyhow::Result<()> {
    let mut list = folder()?.list().advised()?;
    for problem in &list.problems {
        console.warn(problem, problem);
    }
    list.recipes.splice(0..0, RecipeFile::all_built_in());
    let mut table = Table::new(&["NAME", "IDENTITY", "CHANGED", "DEFAULT", "NOTES"]);
    for file in &list.recipes {
        let line = ListLine {
            name: file.name.as_str(),
            identity: file.recipe.identity(),
            is_default: list.default == file.name.as_str(),
            num_changed: num_changed(&file.recipe),
            notes: &file.notes,
        };
        if json {
            console.line(&serde_json::to_string(&line)?);
            continue;
        }
        table.row([
            line.name.to_owned(),
            line.identity,
            line.num_changed.to_string(),
            if line.is_default { "default" } else { "" }.to_owned(),
            line.notes.to_owned(),
        ]);
    }
    if !json {
        console.table(&table);
    }
    Ok(())
}

/// A recipe, as `show --json` writes it.
#[derive(Serialize)]
struct ShowLine<'a> {
    name: &'a str,
    identity: String,
    notes: &'a str,
    against: &'a str,
    changed: Vec<ChangeLine>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    expect: &'a [ExpectedPart],
}

/// A parameter that differs, as text.
#[derive(Serialize)]
struct ChangeLine {
    parameter: &'static str,
    value: String,
    against: String,
}

fn show(asked: &ShowArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let file = open_named(Some(&asked.recipe))?;
    show_file(
        &file,
        &open_named(Some(&asked.against))?,
        asked.json,
        console,
    );
    let expect = &file.recipe.expect;
    if expect.is_empty() {
        return Ok(Outcome::Accepted);
    }
    let rack = asked.rack.read()?;
    let load = (asked.library).load_some(&file.recipe.reference_params(), console)?;
    let check = |parts: &[ExpectedPart]| {
        let rack = rack.as_ref().map(|file| &file.rack);
        Expected::new(parts.to_vec(), rack, |name| load.library.has_part(name)).err()
    };
    // What is wrong with each part, and only if that is nothing, with all of them.
    let mut problems: Vec<ExpectedError> = expect.chunks(1).filter_map(check).collect();
    if problems.is_empty() {
        problems.extend(check(expect));
    }
    problems.dedup();
    for problem in &problems {
        console.warn(problem, problem);
    }
    Ok(if problems.is_empty() {
        Outcome::Accepted
    } else {
        Outcome::NotAccepted
    })
}

fn show_file(file: &RecipeFile, against: &RecipeFile, json: bool, console: &mut Console) {
    let differ = |a: &Recipe, b: &Recipe| {
        let all = PARAMETERS.iter().filter(|p| p.differs(a, b));
        let change = |p: &Parameter| ChangeLine {
            parameter: p.key,
            value: p.setting_text(a),
            against: p.setting_text(b),
        };
        all.map(change).collect::<Vec<_>>()
    };
    let line = ShowLine {
        name: file.name.as_str(),
        identity: file.recipe.identity(),
        notes: &file.notes,
        against: against.name.as_str(),
        changed: differ(&file.recipe, &against.recipe),
        expect: &file.recipe.expect,
    };
    if json {
        let line = serde_json::to_string(&line).expect("texts have a JSON form");
        return console.line(&line);
    }
    console.entry("recipe", &format_args!("{}, {}", line.name, line.identity));
    if !line.notes.is_empty() {
        console.entry("notes", &line.notes);
    }
    if line.expect != against.recipe.expect {
        let parts = line.expect.iter().cloned().map(String::from);
        let parts = parts.collect::<Vec<_>>().join(", ");
        let parts = if parts.is_empty() { "any part" } else { &parts };
        console.entry("expects", &parts);
    } else if line.changed.is_empty() {
        return console.entry("same as", &line.against);
    }
    if line.changed.is_empty() {
        return;
    }
    let num = counted(line.changed.len(), "parameter", "parameters");
    console.entry("differs", &format_args!("in {num} from {}", line.against));
    let mut table = Table::new(&["PARAMETER", "VALUE", &line.against.to_uppercase()]);
    for change in &line.changed {
        table.row([
            change.parameter.to_owned(),
            change.value.clone(),
            change.against.clone(),
        ]);
    }
    console.table(&table);
}

/// Saves a recipe; if the name is taken, the error gives advice.
fn keep(file: &RecipeFile, replace: bool, console: &mut Console) -> anyhow::Result<()> {
    let folder = folder()?;
    let replace = if replace { Replace::Yes } else { Replace::No };
    let kept = match folder.save(file, replace) {
        Err(error @ RecipeError::Exists { .. }) => Err(advised_error(
            error.to_string(),
            "Give another name, or add --replace",
        )),
        kept => kept.advised(),
    }?;
    console.line(&format_args!(
        "Saved {}, {}: {} changed from default",
        kept.name,
        kept.recipe.identity(),
        num_changed(&kept.recipe)
    ));
    console.line(&format_args!(
        "  stored in   {}",
        folder.file(&kept.name).display()
    ));
    Ok(())
}

fn save(asked: &SaveArgs, console: &mut Console) -> anyhow::Result<()> {
    let (from, recipe) = asked.recipe.file()?;
    let mut recipe = Recipe::clone(&recipe);
    if !asked.expect.is_empty() {
        let parts = asked.expect.iter().map(|text| text.as_str().into());
        recipe.expect = parts.collect();
    }
    let file = RecipeFile {
        name: asked.name.clone(),
        notes: asked.notes.clone().unwrap_or(from.notes),
        recipe,
    };
    keep(&file, asked.replace, console)
}

fn rename(name: &PartName, to: &PartName, console: &mut Console) -> anyhow::Result<()> {
    let folder = folder()?;
    folder.rename(name, to).advised()?;
    console.line(&format_args!("Recipe {name} is now named {to}"));
    if folder.is_default(to) {
        console.note(&"It stays the default recipe");
    }
    Ok(())
}

fn remove(name: &PartName, console: &mut Console) -> anyhow::Result<()> {
    let folder = folder()?;
    let was_default = folder.is_default(name);
    folder.remove(name).advised()?;
    console.line(&format_args!("Removed {name}"));
    if was_default {
        console.note(&format_args!("The default recipe is {BUILT_IN} again"));
    }
    Ok(())
}

fn default(name: Option<&PartName>, console: &mut Console) -> anyhow::Result<()> {
    let folder = folder()?;
    if let Some(name) = name {
        folder.set_default(name).advised()?;
        console.line(&format_args!("Commands without --recipe now use {name}"));
    } else {
        let text = folder.default_name().advised()?;
        console.line(&text);
    }
    Ok(())
}

fn import(
    path: &Path,
    name: Option<&PartName>,
    replace: bool,
    console: &mut Console,
) -> anyhow::Result<()> {
    let file = RecipeFile::read(path).advised()?;
    let name = name.unwrap_or(&file.name).clone();
    keep(&RecipeFile { name, ..file }, replace, console)
}

fn export(name: &PartName, path: &Path, console: &mut Console) -> anyhow::Result<()> {
    let file = open_named(Some(name.as_str()))?;
    file.write(path).advised()?;
    console.line(&format_args!("Wrote {}", path.display()));
    Ok(())
}
