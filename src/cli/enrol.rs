//! `partsight enrol`: makes a reference from a file.

use crate::cli::input::parse_name;
use std::path::{Path, PathBuf};

use clap::Args;

use super::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, advised_error},
    input::{ImportChoice, parse_side, warn_of},
    library::seen_from,
    recipe::RecipeSource,
    scan::{PosesChoice, open_scan},
};
use capture::CaptureWarning;
use files::{self, FileContent, FileError, NamedMesh, OpenedFile};
use geometry::{cloud::Grid, error::Advice as _, units::counted};
use inspection::library::{
    EnrolError, EnrolParams, EnrolWarning, Enrolled, LibraryError, LibraryFolder, MAX_TITLE,
    PartDescription, PartName, SharedTitle, Side, enrol_captured, enrol_mesh, enrol_scan,
    enrol_surface, enrol_whole, likenesses, surfaces_to_enrol,
};
use stages::{
    reference::ReferenceParams,
    scan::part::background_sign,
    scene::{SceneCloud, scene_from_cloud, scene_from_frame},
};

/// Enrol a part: make a reference from a captured scene, a cloud or a mesh
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight enrol capture.pcd --name front_door
  partsight enrol scan.ply --name grille --whole --notes \"spare, with badge\"
  partsight enrol other_make.pcd --name front_door_b --as front_door
  partsight enrol booth.png --name fender --segment 2
  partsight enrol --scan frames/ --poses poses.json --name fender
  partsight enrol door.stl --name door_left --units mm --up z
  partsight enrol car.gltf#Door_FL --name door_left --library /media/stick/parts

An organised cloud or a depth image is a captured scene: the part in front of the wall is cut out of it. Anything \
else is taken whole. A part of the same name is replaced; the previous version is kept in the library's .trash folder.
With --scan the frames are fused as by partsight scan. The part's frame is then the camera's frame of the first used shot, \
and the part can be recognised from every side from which most of its surface was seen.")]
pub(super) struct EnrolArgs {
    /// A captured scene, a cloud, or a mesh (FILE#NAME for one mesh of a glTF file)
    #[arg(value_name = "FILE", required_unless_present = "scan")]
    file: Option<PathBuf>,
    /// Instead of a file: several frames of the part, each with the pose of its camera; a folder, a recording or files
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["file", "whole", "segment"])]
    scan: Vec<PathBuf>,
    #[command(flatten)]
    import: ImportChoice,
    #[command(flatten)]
    poses: PosesChoice,
    /// Name of the part: lowercase letters, digits, _ and -
    #[arg(long, value_parser = parse_name)]
    name: PartName,
    /// Enrol as one more reference of this part, such as another view or car model; verdicts name that part
    #[arg(long = "as", value_name = "PART", value_parser = parse_name)]
    part: Option<PartName>,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    recipe: RecipeSource,
    /// Take everything in the file
    #[arg(long, conflicts_with = "segment")]
    whole: bool,
    /// Take the part in front of the background; with a number, take that one of the surfaces found, counted from the
    /// likeliest
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "0")]
    segment: Option<usize>,
    /// Title shown to people, such as "Front door, left"; at most 80 characters
    #[arg(long, value_name = "TEXT", default_value = "", value_parser = parse_title)]
    title: String,
    /// Anything worth remembering
    #[arg(long, value_name = "TEXT", default_value = "")]
    notes: String,
    /// Side of a part known all around that is painted, as seen by a camera in front of it: front, back, left, right, top
    /// or bottom; default: its outside, if that is clear
    #[arg(long, value_name = "SIDE", value_parser = parse_side)]
    side: Option<Side>,
    /// Mark the part as simulated; files of partsight simulate are marked already
    #[arg(long)]
    simulated: bool,
}

pub(super) fn run(mut args: EnrolArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    args.import.write_behind(&mut args.file);
    let args = &args;
    let of = part_of(args)?;
    let (mut enrolled, scene) = enrolled_from(args, console)?;
    enrolled.part.meta.part = of;
    enrolled.reference.name = enrolled.part.meta.part_name().to_string();
    if args.side.is_some() {
        let is_open = |warning: &EnrolWarning| !matches!(warning, EnrolWarning::SideUnclear { .. });
        enrolled.part.meta.side = args.side;
        enrolled.warnings.retain(is_open);
    }
    for finding in &enrolled.findings {
        console.note(finding);
    }
    for warning in &enrolled.warnings {
        console.warn(warning, warning);
    }
    let folder = args.library.open_or_create()?;
    let saved = folder.save(&enrolled.part).advised()?;
    let part = &enrolled.part;
    let of = part.meta.reference_of();
    let of = of.map_or_else(String::new, |of| format!(" as one more reference of {of}"));
    console.line(&format_args!(
        "Enrolled {}{of} from {}, seen from {}: {} points, outline of {:.0} mm, openings: {}",
        args.name,
        part.meta.enrolled.how,
        seen_from(part.meta.coverage),
        part.cloud.points.len(),
        part.signature.perimeter_m * 1000.0,
        part.signature.openings_m.len(),
    ));
    if let Some(side) = part.meta.side {
        console.line(&format_args!("  painted from       the {}", side.name()));
    }
    console.line(&format_args!(
        "  stored in          {}",
        saved.folder.display()
    ));
    if let Some(former) = saved.replaced {
        console.line(&format_args!("  previous version in {}", former.display()));
        if saved.left_path {
            console.note(&format_args!(
                "note: the spray path stays with the previous version, since it is in that version's frame. To store \
                 a new one: partsight library path {} YOUR_PATH.csv",
                args.name
            ));
        }
    }
    let load = folder.load(&ReferenceParams::default()).advised()?;
    let name = part.meta.name.as_str();
    let of = part.meta.part_name().as_str();
    if let Some(shared) = SharedTitle::among(&part.meta.title, name, of, &load.parts) {
        console.warn(&shared, &shared);
    }
    let hardest = likenesses(&enrolled, scene.as_ref(), &load.library);
    if let Some(likeness) = hardest.first().filter(|first| !first.is_distinguishable()) {
        console.warn(likeness, likeness);
    }
    Ok(Outcome::Accepted)
}

/// Returns the part that the new reference belongs to. An unknown name is an error, since verdicts would treat it as a
/// part of its own.
fn part_of(args: &EnrolArgs) -> anyhow::Result<Option<PartName>> {
    let Some(named) = &args.part else {
        return Ok(None);
    };
    let folder = match &args.library.library {
        Some(path) => match LibraryFolder::open(path) {
            // Enrolling would create the folder, and it would be empty.
            Err(LibraryError::NotFound { path }) => Err(LibraryError::NoSuchPart {
                path,
                name: named.to_string(),
                available: Vec::new(),
            }),
            opened => opened,
        }
        .advised()?,
        None => args.library.open_to_change()?,
    };
    let part = folder.part_of(named).advised()?;
    // A reference that replaces the part's own is not an additional one.
    Ok(Some(part).filter(|part| *part != args.name))
}

pub(super) fn parse_title(text: &str) -> Result<String, String> {
    match text.chars().count() {
        0..=MAX_TITLE => Ok(text.to_owned()),
        found => Err(format!(
            "{found} characters, but at most {MAX_TITLE} are allowed; put the rest into --notes"
        )),
    }
}

/// Creates the description of a part; `simulated` is the mark in its file.
fn about(args: &EnrolArgs, from: &Path, simulated: bool) -> anyhow::Result<PartDescription> {
    let file_name = from.file_name().unwrap_or(from.as_os_str());
    Ok(PartDescription {
        name: args.name.clone(),
        title: args.title.clone(),
        notes: args.notes.clone(),
        from: file_name.to_string_lossy().into_owned(),
        // Whole seconds are enough for people.
        at: jiff::Timestamp::from_second(geometry::clock::now().as_second())?,
        simulated: args.simulated || simulated,
    })
}

/// Enrols the part, and returns the scene that it was cut out of, if any.
fn enrolled_from(
    args: &EnrolArgs,
    console: &mut Console,
) -> anyhow::Result<(Enrolled, Option<SceneCloud>)> {
    let params = EnrolParams {
        segment: args.recipe.recipe()?.segment.clone(),
        ..EnrolParams::default()
    };
    if let [first, ..] = args.scan.as_slice() {
        let (scan, _) = open_scan(&args.scan, &args.poses, &params.segment, console)?;
        if let Some(sign) = background_sign(&scan) {
            return Err(advised_error(
                format!("the surface found may be background: {sign}"),
                "Add frames that show more of the part, or select it in the window's Enrol workspace",
            ));
        }
        let about = about(args, first, scan.cloud.cloud.is_simulated)?;
        return Ok((enrol_scan(&scan, &about, &params).advised()?, None));
    }
    let file = args.file.as_deref().expect("required without --scan");
    let opened = files::open(file).inspect_err(|error| {
        if let FileError::NeedsMeshName { .. } = error {
            list_meshes(file, console);
        }
    });
    let opened = opened.advised()?;
    let warnings: Vec<CaptureWarning> = opened.warnings().into_iter().map(Into::into).collect();
    warn_of(file, &warnings, console);
    let about = about(args, file, opened.is_simulated())?;
    let path = file.display();
    let captured = |scene: SceneCloud| {
        let enrolled = match args.segment.filter(|number| *number > 0) {
            Some(number) => enrol_surface(&scene, number, &about, &params),
            None => enrol_captured(&scene, &about, &params).inspect_err(|error| {
                if let EnrolError::Background(_) = error {
                    list_surfaces(&scene, &params, console);
                }
            }),
        };
        enrolled.map(|enrolled| (enrolled, Some(scene)))
    };
    let alone = |enrolled| (enrolled, None);
    let enrolled = match opened {
        FileContent::Mesh(_) if args.segment.is_some() => {
            return Err(advised_error(
                format!("{path}: a mesh has no background to cut the part out of"),
                "Leave --segment out",
            ));
        }
        FileContent::Mesh(mesh) => match enrol_mesh(&mesh, &about, &params) {
            Err(error) if let Some(name) = list_meshes(file, console) => {
                let advice = error.advice();
                return Err(advised_error(
                    format!("{path}: {error}"),
                    format!(
                        "{advice}; if its meshes are parts, enrol one of them, such as {path}#{name}"
                    ),
                ));
            }
            enrolled => enrolled.map(alone),
        },
        FileContent::Depth(frame) if args.whole => {
            enrol_whole(&scene_from_frame(&frame).cloud, &about, &params).map(alone)
        }
        FileContent::Depth(frame) => captured(scene_from_frame(&frame)),
        FileContent::Cloud(cloud)
            if args.segment.is_some() || (cloud.grid.is_some() && !args.whole) =>
        {
            captured(scene_from_cloud(cloud))
        }
        FileContent::Cloud(cloud) => enrol_whole(&cloud, &about, &params).map(alone),
    };
    // The error is about the cloud and does not name the file.
    enrolled.map_err(|error| advised_error(format!("{path}: {error}"), error.advice()))
}

/// Lists the surfaces to choose from, with their positions in the picture.
fn list_surfaces(scene: &SceneCloud, params: &EnrolParams, console: &Console) {
    let Some(Grid { width, .. }) = scene.cloud.grid else {
        return;
    };
    for (part, number) in surfaces_to_enrol(scene, params)
        .into_iter()
        .flatten()
        .zip(1..)
    {
        let (columns, rows) = (
            part.indices.iter().map(|i| *i as usize % width),
            part.indices.iter().map(|i| *i as usize / width),
        );
        let between = |least: Option<usize>, most: Option<usize>| {
            format!("{} to {}", least.unwrap_or(0), most.unwrap_or(0))
        };
        let depth: f64 = part.cloud.points.iter().map(|p| f64::from(p.z)).sum();
        console.note(&format_args!(
            "surface {number}: {:.2} m² at {:.2} m, columns {}, rows {}",
            part.surface.map_or(0.0, |surface| surface.area),
            depth / part.indices.len().max(1) as f64,
            between(columns.clone().min(), columns.max()),
            between(rows.clone().min(), rows.max()),
        ));
    }
}

/// The most meshes listed: a whole car has thousands, and its body parts come first.
const MAX_LISTED: usize = 30;

/// Lists the meshes to choose from, with their sizes, the longest first. Returns the name of that; `None` unless there are several.
fn list_meshes(file: &Path, console: &Console) -> Option<String> {
    let Ok(OpenedFile::Several(listed)) = files::open_each(file) else {
        return None;
    };
    let mm = 1000.0 * listed.options.unit.metres();
    let mut meshes: Vec<&NamedMesh> = listed.meshes.iter().collect();
    meshes.sort_by(|a, b| b.longest_side().total_cmp(&a.longest_side()));
    for named in meshes.iter().take(MAX_LISTED) {
        let name = &named.name;
        match (named.size(), &named.mesh) {
            (_, Err(error)) => console.note(&format_args!("mesh {name}: {error}")),
            (None, Ok(_)) => {}
            (Some(sides), Ok(_)) => {
                let [width, height, depth] = <[f32; 3]>::from(sides * mm);
                let triangles = counted(named.num_triangles(), "triangle", "triangles");
                console.note(&format_args!(
                    "mesh {name}: {width:.0} x {height:.0} x {depth:.0} mm, {triangles}"
                ));
            }
        }
    }
    let num_more = meshes.len().saturating_sub(MAX_LISTED);
    if num_more > 0 {
        console.note(&format_args!("and {num_more} more; the window lists all"));
    }
    meshes.first().map(|named| named.name.clone())
}
