//! `partsight rack`: files that say where parts may hang.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, builder::NonEmptyStringValueParser};

use super::{
    LibraryChoice, Outcome,
    calibrate::CalibrationChoice,
    console::{Advised as _, Console, Table, advised_error},
    input::{EmptyCellChoice, before, open_scene, warn_of},
    recipe::RecipeChoice,
};
use geometry::units::counted;
use inspection::{
    library::Library,
    pipeline::{NamedRecipe, Recipe, Unwatched, run as inspect, run_all},
    rack::{MaxTurn, RackError, RackFile, RackFrame, ambiguity},
};
use robot::RobotFrame;
use stages::segment::MAX_PARTS;

/// Where parts may hang.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct RackFileChoice {
    /// Where parts may hang: a file with a work volume, and places with the parts and orientations allowed there
    /// (partsight rack --help)
    #[arg(long, value_name = "FILE")]
    rack: Option<PathBuf>,
}

impl RackFileChoice {
    /// Reads the file, if one is given.
    pub(super) fn read(&self) -> anyhow::Result<Option<RackFile>> {
        let read = self.rack.as_deref().map(RackFile::read);
        read.transpose().advised()
    }

    /// Returns the recipe before this rack; `robot` is where the camera is, if that is known.
    pub(super) fn before(
        &self,
        recipe: NamedRecipe,
        library: &Library,
        robot: Option<&RobotFrame>,
    ) -> anyhow::Result<NamedRecipe> {
        let Some(file) = self.read()? else {
            return Ok(recipe);
        };
        let base_from_camera = robot.map(|robot| &robot.robot_from_camera);
        let rack = file.for_library(library, base_from_camera).advised()?;
        Ok(recipe.in_rack(rack))
    }
}

/// Say where parts may hang: the work volume, and the places of a rack
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight rack add rack_a.toml left.pcd --place \"left hook\"      # a part hangs there as it may hang
  partsight rack add rack_a.toml full.pcd --each                   # a place for each part of a full rack
  partsight rack add rack_a.toml left.pcd --volume                 # nothing outside is looked at
  partsight rack show rack_a.toml
  partsight inspect next.pcd --rack rack_a.toml

The file is text (docs/guide/racks.md). Nothing outside its boxes of volume is looked at; a part that hangs at none of its \
places, at the place of another or in an orientation that is not allowed is not accepted. Of two poses of a symmetric part, the \
allowed one is found. Coordinates are in the camera's frame or, with --base, in the robot's base frame, which takes a \
calibration.")]
pub(super) struct RackArgs {
    #[command(subcommand)]
    command: RackCommand,
}

#[derive(Debug, Subcommand)]
enum RackCommand {
    /// Add a place, or a box of the work volume, from a part that hangs there; makes the file if there is none
    Add(Box<AddArgs>),
    /// Check a file, and show its boxes, places and parts
    Show(ShowArgs),
}

#[derive(Debug, Args)]
struct AddArgs {
    /// The file
    #[arg(value_name = "RACK")]
    rack: PathBuf,
    /// A captured scene of the part as it may hang there
    #[arg(value_name = "FILE")]
    scene: PathBuf,
    /// Add a place of this name around the part's middle, for this part in this orientation; of a known place, move it, and
    /// allow this part too
    #[arg(long, value_name = "NAME", value_parser = NonEmptyStringValueParser::new(), required_unless_present_any = ["volume", "each"])]
    place: Option<String>,
    /// Add a place for every accepted part of the scene, from left to right: 1, 2, ...
    #[arg(long, conflicts_with = "place")]
    each: bool,
    /// Add a box around each of these parts to the work volume
    #[arg(long)]
    volume: bool,
    /// Of a new file: give coordinates in the robot's base frame instead of the camera's
    #[arg(long)]
    base: bool,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    recipe: RecipeChoice,
    #[command(flatten)]
    empty_cell: EmptyCellChoice,
    #[command(flatten)]
    calibration: CalibrationChoice,
}

#[derive(Debug, Args)]
struct ShowArgs {
    /// The file
    #[arg(value_name = "RACK")]
    rack: PathBuf,
    #[command(flatten)]
    library: LibraryChoice,
}

pub(super) fn run(args: &RackArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    match &args.command {
        RackCommand::Add(args) => add(args, console),
        RackCommand::Show(args) => show(args, console),
    }
}

fn add(args: &AddArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let mut file = if args.rack.exists() {
        RackFile::read(&args.rack).advised()?
    } else {
        RackFile::named_after(&args.rack)
    };
    if args.base && file.rack.is_empty() {
        file.frame = RackFrame::Base;
    } else if args.base && file.frame != RackFrame::Base {
        return Err(advised_error(
            format!("{} is in the camera's frame", args.rack.display()),
            "Leave out --base, or begin another file",
        ));
    }
    let recipe = args.recipe.recipe()?;
    let load = (args.library).load_some(&recipe.reference_params(), console)?;
    let robot = args.calibration.frame(console)?;
    let camera = robot.as_ref().map(|robot| &robot.robot_from_camera);
    let (mut scene, warnings) = open_scene(&args.scene).advised()?;
    warn_of(&args.scene, &warnings, console);
    let empty_cell = args.empty_cell.open(console)?;
    let name = args.scene.display().to_string();
    before(&mut scene, empty_cell.as_ref(), &name, console);
    let mut found = if args.each {
        let mut parameters = Recipe::clone(&recipe);
        parameters.segment.max_parts = MAX_PARTS;
        run_all(&scene, &load.library, &parameters, &Unwatched)?
    } else {
        vec![inspect(&scene, &load.library, &recipe, &Unwatched)?]
    };
    if let Some([why, advice]) = found[0].verdict.complaint() {
        return Err(advised_error(format!("{name}: {why}"), advice));
    }
    let num_found = found.len();
    found.retain(|part| part.verdict.is_accepted());
    if found.len() < num_found {
        let num = num_found - found.len();
        console.note(&format_args!(
            "{} not accepted, and no place was made of it",
            counted(
                num,
                "thing that hangs there was",
                "things that hang there were"
            )
        ));
    }
    for part in &found {
        // Never that of another place, which would move.
        let numbered = args.each.then(|| file.new_place_name());
        if let Some(place) = args.place.as_deref().or(numbered.as_deref()) {
            let middle = part.middle(&load.library);
            if let Some(warning) = ambiguity(part) {
                console.advise(
                    &format_args!("warning: {name}: {warning}"),
                    &"Check that a robot can follow the part's path in this pose; if not, turn angles_deg in the file by half a turn",
                );
            }
            let taken = file.take_place(place.trim(), part, middle, camera);
            if !taken.advised()? {
                return Err(advised_error(
                    format!("{name}: the part has no pose"),
                    "Have the pose estimated: --pose global",
                ));
            }
        }
        if args.volume {
            file.take_volume(part, camera).advised()?;
        }
    }
    if let Err(what) = file.check() {
        return Err(advised_error(
            format!("the rack would not be valid: {what}"),
            "Hang the part elsewhere, or remove the other place from the file",
        ));
    }
    let file = file.write(&args.rack).advised()?;
    show_file(&file, &args.rack, console);
    Ok(Outcome::Accepted)
}

fn show(args: &ShowArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let file = RackFile::read(&args.rack).advised()?;
    show_file(&file, &args.rack, console);
    let load = (args.library).load_some(&NamedRecipe::default().reference_params(), console)?;
    match file.check_parts(|name| load.library.has_reference(name)) {
        Ok(()) => Ok(Outcome::Accepted),
        Err(error @ RackError::NotEnrolled { .. }) => {
            console.warn(&error, &error);
            Ok(Outcome::NotAccepted)
        }
        Err(error) => Err(error).advised(),
    }
}

fn show_file(file: &RackFile, path: &Path, console: &mut Console) {
    let frame = match file.frame {
        RackFrame::Camera => "the camera's frame",
        RackFrame::Base => "the robot's base frame",
    };
    console.line(&format_args!(
        "{}, in {frame}",
        if file.rack.name.is_empty() {
            path.display().to_string()
        } else {
            file.rack.name.clone()
        }
    ));
    let mut table = Table::new(&["BOX", "CENTRE, MM", "SIZE, MM", "TURN", "PARTS"]);
    let numbers = |metres: [f64; 3]| metres.map(|x| format!("{:.0}", x * 1e3)).join(" ");
    for region in &file.rack.volume {
        let (centre, size) = (numbers(region.centre_m), numbers(region.size_m));
        table.row(["volume".into(), centre, size, String::new(), String::new()]);
    }
    for place in &file.rack.places {
        let parts = place.parts.iter().map(|part| match part.angles_rad {
            Some(_) => part.name.clone(),
            None => format!("{} (in any orientation)", part.name),
        });
        let parts: Vec<String> = parts.collect();
        table.row([
            place.name.clone(),
            numbers(place.region.centre_m),
            numbers(place.region.size_m),
            up_to(&place.max_turn),
            if parts.is_empty() {
                "any".into()
            } else {
                parts.join(", ")
            },
        ]);
    }
    console.table(&table);
}

fn up_to(turn: &MaxTurn) -> String {
    let limits = turn.limits().iter();
    let limits = limits.map(|limit| format!("{:.0}°", limit.degrees()));
    format!("up to {}", limits.collect::<Vec<_>>().join(" "))
}
