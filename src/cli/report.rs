//! `partsight report`: writes the pose report of captured scenes for people, programs and robots.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    sync::Arc,
};

use clap::{
    Args, ValueEnum,
    builder::{PossibleValue, PossibleValuesParser},
};

use super::{
    LibraryChoice, Outcome,
    calibrate::CalibrationChoice,
    console::{Advised as _, Console, Table},
    expect::ExpectChoice,
    input::{EmptyCellChoice, OpenedScene, Scenes, before, open_ahead, parse_convention, warn_of},
    plant,
    rack::RackFileChoice,
    recipe::RecipeChoice,
    trace::TraceChoice,
    verdict::accepted_or_not,
};
use geometry::error::Advice as _;
use inspection::{
    library::{LibraryLoad, PartMeta, PartName, open_library},
    pipeline::{Inspection, NamedRecipe, Unwatched, run_all},
};
use records::{
    history::Traceability,
    report::{
        ProblemReport, ReportError, ReportFolder, WrittenPose, compared_entries,
        pose_report::{PdfPictures, PoseReport, ReportSubject, SeenBy, pose_pdf},
        stage_pictures,
    },
};
use robot::{Convention, RobotFrame};
use stages::{
    scene::{EmptyCell, SceneCloud},
    stand_off::stand_off,
};
use station::{Inspected, Subject, robot_file::file_of_part};

/// Write a pose report for captured scenes: which part it is, and its pose in the robot's convention
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight report door.pcd --out reports
  partsight report door.pcd --out reports --format json,pdf --convention kuka
  partsight report captures/*.png --out reports --format csv
  partsight report door.pcd --out reports --convention fanuc --calibration cell.toml
  partsight report door.pcd --out reports --format problem
  partsight report last-week.pcd --out reports --calibration cell.toml --force
  partsight report --conventions
  partsight report --schema > pose-report.schema.json

Writes FILE.pose.json and FILE.pose.pdf for each file; of several parts of a frame FILE_1, FILE_2 and so on. csv appends a row for \
each part to poses.CONVENTION.csv; problem writes FILE.problem.zip. A part that is not \
accepted, or about which there are doubts, is reported too, without numbers that a robot could move by.
Files: PCD, PLY, XYZ or CSV text, or a 16-bit depth PNG with its intrinsics in a JSON beside it; metres.
Exit codes: 0 every input accepted, 1 something was not accepted, 2 something could not be read or written.")]
pub(super) struct ReportArgs {
    /// Captured scenes
    #[arg(required_unless_present_any = ["schema", "conventions"], value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Output folder; created if missing
    #[arg(long, value_name = "DIR", required_unless_present_any = ["schema", "conventions"])]
    out: Option<PathBuf>,
    /// What to write
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [Format::Json, Format::Pdf])]
    format: Vec<Format>,
    /// Robot convention of the pose; --conventions explains all of them
    #[arg(long, value_name = "NAME", default_value = "matrix", value_parser = parse_convention)]
    convention: Convention,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    recipe: RecipeChoice,
    #[command(flatten)]
    rack: RackFileChoice,
    #[command(flatten)]
    empty_cell: EmptyCellChoice,
    #[command(flatten)]
    calibration: CalibrationChoice,
    #[command(flatten)]
    trace: TraceChoice,
    /// Give the pose of an accepted part in the robot's base frame despite doubts, such as that the capture is more than
    /// 10 minutes old; the report names them
    #[arg(long)]
    force: bool,
    /// Mark the scenes as simulated in the reports; files of partsight simulate are marked already
    #[arg(long)]
    simulated: bool,
    /// Print a JSON schema, and nothing else; default: that of a report
    #[arg(long, value_name = "NAME", num_args = 0..=1, require_equals = true, default_missing_value = "pose-report", exclusive = true, value_parser = schema_names())]
    schema: Option<String>,
    /// Print what each convention's numbers mean, and nothing else
    #[arg(long, exclusive = true)]
    conventions: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Everything, for programs
    Json,
    /// A row appended to a table
    Csv,
    /// A page for people
    Pdf,
    /// A ZIP archive of scene, library entry and recipe, with which somebody else sees the same
    Problem,
}

/// A JSON schema that can be printed.
pub(super) struct Schema {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
    pub(super) json: fn() -> String,
}

const POSE_REPORT: Schema = Schema {
    name: "pose-report",
    help: "A pose report",
    json: PoseReport::json_schema,
};

fn schemas() -> impl Iterator<Item = &'static Schema> {
    [&POSE_REPORT].into_iter().chain(plant::SCHEMAS)
}

fn schema_names() -> PossibleValuesParser {
    schemas()
        .map(|schema| PossibleValue::new(schema.name).help(schema.help))
        .into()
}

pub(super) fn run(args: &ReportArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let mut known = schemas();
    if let Some(schema) =
        (args.schema.as_ref()).and_then(|name| known.find(|schema| schema.name == name))
    {
        console.line(&(schema.json)().trim_end());
        return Ok(Outcome::Accepted);
    }
    if args.conventions {
        show_conventions(console);
        return Ok(Outcome::Accepted);
    }
    open_ahead(&args.files, |scenes| report(args, scenes, console))
}

fn report(args: &ReportArgs, scenes: Scenes<'_>, console: &mut Console) -> anyhow::Result<Outcome> {
    let recipe = args.recipe.recipe()?;
    let load = (args.library).load_some(&recipe.reference_params(), console)?;
    let empty_cell = args.empty_cell.open(console)?;
    let trace = args.trace.of_parts(Some(args.files.len()))?;
    let out = args.out.as_deref().unwrap_or(Path::new("."));
    let robot = args.calibration.frame(console)?;
    let recipe = (args.rack).before(recipe, &load.library, robot.as_ref())?;
    let expect = ExpectChoice::default();
    let recipe = expect.applied(&recipe, &load.library, Some(&recipe.rack), &trace)?;
    let mut one = Reporter {
        recipe,
        library_identity: load.identity(),
        load,
        empty_cell,
        robot,
        folder: ReportFolder::make(out).advised()?,
        trace,
        args,
    };
    console.start_progress(args.files.len());
    let mut outcome = Outcome::Accepted;
    for (path, opened) in scenes {
        console.begin(&path.display());
        outcome = outcome.max(one.report(path, opened, console)?);
        console.done();
    }
    Ok(outcome)
}

fn show_conventions(console: &mut Console) {
    let mut table = Table::new(&["NAME", "NUMBERS"]);
    for convention in Convention::ALL {
        let meaning = format!("{}: {}", convention.title(), convention.meaning());
        table.row([convention.name().to_owned(), meaning]);
    }
    console.table(&table);
}

/// State shared by all files of a call.
struct Reporter<'a> {
    args: &'a ReportArgs,
    load: LibraryLoad,
    library_identity: String,
    trace: Traceability,
    recipe: NamedRecipe,
    empty_cell: Option<Arc<EmptyCell>>,
    robot: Option<RobotFrame>,
    folder: ReportFolder,
}

impl Reporter<'_> {
    fn report(
        &mut self,
        path: &Path,
        opened: OpenedScene,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let name = path.display().to_string();
        let (mut scene, warnings) = match opened.advised() {
            Ok(opened) => opened,
            Err(error) => {
                console.error(&error);
                return Ok(Outcome::CouldNotRun);
            }
        };
        warn_of(path, &warnings, console);
        before(&mut scene, self.empty_cell.as_ref(), &name, console);
        let found = run_all(&scene, &self.load.library, &self.recipe, &Unwatched)?;
        let scene = Arc::new(scene);
        // Go on after an error: the next report may fit on the disk, or the stick may be back.
        let mut errors = Vec::new();
        for (number, inspection) in (1..).zip(&found) {
            let of_part = (found.len() > 1).then(|| file_of_part(path, number));
            errors.extend(self.report_part(&scene, inspection, (path, of_part), console));
        }
        if self.args.format.contains(&Format::Problem) {
            match self.write_problem(path, &scene, &found) {
                Ok(written) => console.line(&format_args!("{name}: {}", written.display())),
                Err(error) => errors.push(error),
            }
        }
        for error in &errors {
            console.advise(&format_args!("error: {error}"), &error.advice());
        }
        Ok(if errors.is_empty() {
            Outcome::accepted_if(self.recipe.is_met(&found))
        } else {
            Outcome::CouldNotRun
        })
    }

    /// Reports one part of the scene of a file; `of_part` names its report if there are several. Returns what could not be
    /// written.
    fn report_part(
        &mut self,
        scene: &Arc<SceneCloud>,
        inspection: &Inspection,
        (path, of_part): (&Path, Option<PathBuf>),
        console: &mut Console,
    ) -> Vec<ReportError> {
        let subject = self.subject(path, scene);
        let report = self.report_of(&self.inspected(&subject, scene, inspection));
        let of_part = of_part.as_deref().unwrap_or(path);
        let WrittenPose {
            pages,
            table,
            aside,
            errors,
        } = self.write(of_part, scene, inspection, &report);
        if let (Some(table), Some(aside)) = (&table, aside) {
            console.note(&format_args!(
                "note: the last row of {} was incomplete; it was set aside in {}",
                table.display(),
                aside.display()
            ));
        }
        let files = pages.iter().chain(&table);
        let files: Vec<String> = files.map(|path| path.display().to_string()).collect();
        if files.is_empty() {
            return errors;
        }
        let verdict = &inspection.verdict;
        let found = verdict.identification();
        console.line(&format_args!(
            "{}: {}, {}: {}",
            path.display(),
            found.in_english(verdict.guess().unwrap_or_default()),
            accepted_or_not(verdict),
            files.join(", ")
        ));
        errors
    }

    fn subject(&self, path: &Path, scene: &SceneCloud) -> Subject {
        Subject::of_file(path, self.args.simulated || scene.cloud.is_simulated)
    }

    fn inspected<'a>(
        &'a self,
        subject: &'a Subject,
        scene: &'a Arc<SceneCloud>,
        inspection: &'a Inspection,
    ) -> Inspected<'a> {
        Inspected {
            subject,
            scene,
            inspection,
            recipe: &self.recipe,
            robot: self.robot.as_ref(),
            is_forced: self.args.force,
            on_line: None,
        }
    }

    /// Writes the problem report of a scene, and returns its path.
    fn write_problem(
        &mut self,
        path: &Path,
        scene: &Arc<SceneCloud>,
        found: &[Inspection],
    ) -> Result<PathBuf, ReportError> {
        let subject = self.subject(path, scene);
        let line = {
            let parts = found.iter();
            let parts = parts.map(|inspection| self.inspected(&subject, scene, inspection));
            let parts: Vec<Inspected<'_>> = parts.collect();
            Inspected::line_of_all(&parts, &Traceability::default())
        };
        let entries = found.iter();
        let entries = entries.flat_map(|found| compared_entries(found, &self.load.parts));
        let entries: BTreeSet<PartName> = entries.collect();
        let entries: Vec<PartName> = entries.into_iter().collect();
        let library = open_library(self.args.library.library.as_deref());
        let report = ProblemReport {
            scene: Some(&**scene),
            line: Some(&line),
            recipe: &self.recipe,
            library: library.as_ref().ok(),
            entries: &entries,
            system: &[],
            texts: &[],
        };
        self.folder.write_problem(path, &report)
    }

    fn report_of(&self, inspected: &Inspected<'_>) -> PoseReport {
        let (subject, inspection) = (inspected.subject, inspected.inspection);
        let reference = inspection.best_reference(&self.load.library);
        let pose = inspection.found_pose();
        let stand_off = reference
            .zip(pose)
            .filter(|_| inspection.verdict.is_accepted())
            .map(|(reference, pose)| {
                stand_off(reference, &pose.camera_from_part(), &self.recipe.stand_off)
            });
        PoseReport::of(&ReportSubject {
            inspected_at: geometry::clock::now(),
            scene: &subject.scene,
            source: None,
            seen_by: if subject.is_simulated {
                SeenBy::Simulation
            } else {
                SeenBy::NotKnown
            },
            trace: &self.trace,
            inspection,
            middle: inspection.middle(&self.load.library),
            stand_off: stand_off.as_ref(),
            recipe: &self.recipe,
            library_identity: &self.library_identity,
            num_references: self.load.library.references.len(),
            robot: inspected.robot,
            for_robot: inspected.frame_for_robot(),
            doubts: &inspected.doubt_blocks(),
            convention: self.args.convention,
        })
    }

    /// Writes all formats.
    fn write(
        &mut self,
        path: &Path,
        scene: &SceneCloud,
        inspection: &Inspection,
        report: &PoseReport,
    ) -> WrittenPose {
        let asked = |format| self.args.format.contains(&format);
        let mut pages = Vec::new();
        if asked(Format::Json) {
            pages.push(("json", report.to_json().into_bytes()));
        }
        if asked(Format::Pdf) {
            let best = inspection.ranking.entries.first();
            let title = best.and_then(|best| self.load.parts.get(best.reference));
            let pictures = PdfPictures {
                view: None,
                stages: &stage_pictures(scene, inspection),
                title: title.map(PartMeta::shown_title),
            };
            pages.push(("pdf", pose_pdf(report, &pictures)));
        }
        self.folder
            .write_pose(path, report, asked(Format::Csv), &pages)
    }
}
