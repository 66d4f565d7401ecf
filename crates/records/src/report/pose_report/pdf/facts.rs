//! The right column with the picture of the scene and the figures, and the foot of the page.

use super::{
    Anchor, Area, BLACK, BODY, GREY, HEADING, MARGIN, PAGE, PALE, PdfPictures, RED, RULE, SMALL,
    STRONG, Sheet, WIDTH, Weight, style, typeset,
};
use crate::report::{
    pose_report::{FitBlock, MiddleBlock, PoseBlock, PoseReport, SeenBy, StandOffBlock},
    surface_line::SurfaceLine,
};

const LINE: f32 = 12.0;
/// Rows that the stand-off takes, with its heading and note.
const STAND_OFF_ROWS: usize = 7;
/// Regions of a surface that are listed; the line of JSON has all.
const NUM_REGIONS: usize = 4;

/// Draws the picture, and the figures of the pose below it.
pub(super) fn column(
    sheet: &mut Sheet<'_>,
    report: &PoseReport,
    pose: &PoseBlock,
    pictures: &PdfPictures<'_>,
    area: Area,
) {
    let picture = Area {
        height: 150.0,
        ..area
    };
    let y = scene(sheet, pictures, picture) + 18.0;
    let mut rows = Rows { sheet, area, y };
    if let Some(middle) = &pose.middle {
        rows.middle(middle);
    }
    rows.fit(&pose.fit, pose);
    if let Some(surface) = &report.surface {
        rows.surface(surface);
    }
    // Below a checked surface it may have no room.
    let has_room = report.surface.is_none() || rows.num_left() >= STAND_OFF_ROWS;
    if let Some(found) = report.stand_off.as_ref().filter(|_| has_room) {
        rows.stand_off(found);
    }
}

/// Draws the page without a pose: a note that there is none, the most similar parts, and a large picture of the scene.
/// It has no numbers that somebody could type into a robot.
pub(super) fn without_pose(
    sheet: &mut Sheet<'_>,
    report: &PoseReport,
    pictures: &PdfPictures<'_>,
    area: Area,
) {
    const SIDE: f32 = 150.0;
    let mut y = area.top + 9.0;
    let heading = style(HEADING.size, Weight::Bold, RED);
    sheet.text("No pose is given", [area.left, y], heading, Anchor::Left);
    y += LINE + 2.0;
    let text = match (report.verdict.accepted, &report.refused_pose) {
        (true, _) => "The part was accepted by its outline alone: no pose was estimated.",
        (false, Some(_)) => {
            "Where the part would be is in the report's JSON, under refused_pose, to find out why it was refused. Nothing \
             may move by it."
        }
        (false, None) => "There is nothing to move to.",
    };
    y = sheet.paragraph(text, [area.left, y], area.width, BODY, 2) + 8.0;
    let picture = Area {
        top: y,
        width: area.width - SIDE - 20.0,
        height: (area.top + area.height - y - 20.0).min(300.0),
        ..area
    };
    scene(sheet, pictures, picture);
    if !report.ranking.is_empty() {
        let side = Area {
            left: area.left + area.width - SIDE,
            width: SIDE,
            ..area
        };
        let mut rows = Rows {
            sheet,
            area: side,
            y: y + 9.0,
        };
        rows.heading("Most like it");
        for entry in &report.ranking {
            rows.row(&entry.part, &format!("{:.2}", entry.score));
        }
        rows.note("Probability of each enrolled part, at the pose where it fits best.");
    }
}

/// Draws the view of the scene with its caption. Returns the caption's baseline.
fn scene(sheet: &mut Sheet<'_>, pictures: &PdfPictures<'_>, area: Area) -> f32 {
    let stage = pictures.stages.first();
    let shown = pictures
        .view
        .map(|view| (view, "3-D view"))
        .or(stage.map(|stage| (&stage.image, "What the camera saw, by segment")));
    let Some((picture, caption)) = shown else {
        return area.top - 9.0;
    };
    let covered = sheet.picture(picture, area);
    sheet.outline(covered, RULE);
    let y = area.top + covered.height + 9.0;
    sheet.text(caption, [area.left, y], SMALL, Anchor::Left);
    y
}

/// Rows of a name and a figure, from top to bottom.
struct Rows<'s, 'p> {
    sheet: &'s mut Sheet<'p>,
    area: Area,
    y: f32,
}

impl Rows<'_, '_> {
    fn heading(&mut self, text: &str) {
        self.sheet
            .text(text, [self.area.left, self.y], HEADING, Anchor::Left);
        self.y += LINE + 1.5;
    }

    fn row(&mut self, name: &str, value: &str) {
        self.sheet
            .text(name, [self.area.left, self.y], BODY, Anchor::Left);
        let right = self.area.left + self.area.width;
        self.sheet
            .text(value, [right, self.y], STRONG, Anchor::Right);
        self.y += LINE;
    }

    fn note(&mut self, text: &str) {
        let at = [self.area.left, self.y - 1.0];
        self.y = self.sheet.paragraph(text, at, self.area.width, SMALL, 3) + 8.0;
    }

    fn middle(&mut self, middle: &MiddleBlock) {
        self.heading("Shift from the standard position");
        let axes = ["x, to the right", "y, down", "z, away"];
        for (axis, metres) in axes.into_iter().zip(middle.moved_m) {
            self.row(axis, &typeset(&format!("{:+.1} mm", metres * 1000.0)));
        }
        self.row("turned", &format!("{:.2}°", middle.turned_in_all_deg));
        self.note("The part's middle as the camera sees it; for people, not for a robot.");
    }

    fn fit(&mut self, fit: &FitBlock, pose: &PoseBlock) {
        self.heading("Fit");
        self.row("rms", &format!("{:.2} mm", fit.rms_m * 1000.0));
        self.row("on the reference", &format!("{:.0} %", fit.overlap * 100.0));
        match &pose.bounds {
            Some(bounds) => {
                let text = format!(
                    "< {:.1} mm, {:.2}°",
                    bounds.shift_m * 1000.0,
                    bounds.turn_deg
                );
                self.row("bounds (95 of 100 cases)", &text);
            }
            None => self.row("bounds", "unconstrained, or not computed"),
        }
        if let Some(ratio) = fit.runner_up_ratio {
            // What rounds to 1.0 times is not worse.
            let words = if ratio < 1.05 {
                "as good".to_owned()
            } else {
                format!("{ratio:.1}× worse")
            };
            self.row("next best pose", &words);
        }
        let stopped = fit.stopped.replace('_', " ");
        self.row("found by", &format!("{}, {stopped}", fit.method));
        self.y += 8.0;
    }

    /// Number of rows for which there is room below.
    fn num_left(&self) -> usize {
        let left = self.area.top + self.area.height - self.y;
        (left / LINE).max(0.0) as usize
    }

    fn surface(&mut self, surface: &SurfaceLine) {
        self.heading("Surface");
        self.row("verdict", &surface.verdict.to_string());
        for region in surface.regions.iter().take(NUM_REGIONS) {
            let off = region.deviation_m.map_or_else(String::new, |metres| {
                format!("{:+.1} mm, ", 1000.0 * metres)
            });
            let name = format!("{}: {}", region.kind, region.verdict);
            let area = format!("{off}{:.1} cm²", 1e4 * region.area_m2);
            self.row(&name, &typeset(&area));
        }
        let num_more = surface.regions.len().saturating_sub(NUM_REGIONS);
        if num_more > 0 {
            self.row("more regions", &num_more.to_string());
        }
        if let Some(measured) = &surface.measured {
            self.row("frames averaged", &measured.frames.to_string());
            self.row("noise", &format!("{:.2} mm", 1000.0 * measured.noise_m));
            if let Some([width, depth]) = measured.smallest_m.get(1) {
                let name = format!("found in 95 %: dents {:.0} mm wide", 1000.0 * width);
                self.row(&name, &format!("from {:.1} mm", 1000.0 * depth));
            }
        }
        if let Some(reason) = &surface.reason {
            self.note(reason);
        }
        self.y += 8.0;
    }

    fn stand_off(&mut self, found: &StandOffBlock) {
        let mm = |metres: f64| typeset(&format!("{:.0}", metres * 1000.0));
        self.heading("Stand-off of an assumed path");
        self.row(
            "mean, worst",
            &format!("{}, {} mm", mm(found.mean_m), mm(found.worst_m)),
        );
        let band = format!("in {} to {} mm", mm(found.nearest_m), mm(found.farthest_m));
        self.row(
            &band,
            &format!("{:.0} % of the path", found.in_band * 100.0),
        );
        let angles = format!(
            "{:.1}°, {:.1}°",
            found.mean_angle_deg, found.worst_angle_deg
        );
        self.row("angle, worst", &angles);
        self.note(if found.keeps_the_band {
            "The path fits without the pose."
        } else {
            "The path has to be moved by the pose first."
        });
    }
}

/// Draws the facts that identify the inspection. Returns where the foot begins.
pub(super) fn foot(sheet: &mut Sheet<'_>, report: &PoseReport) -> f32 {
    let bottom = PAGE[1] - 34.0;
    let trace: Vec<String> = report
        .traceability
        .known()
        .map(|(name, text)| format!("{name} {text}"))
        .collect();
    let height = if trace.is_empty() { 58.0 } else { 70.0 };
    let top = bottom - height;
    let area = Area {
        left: MARGIN,
        top,
        width: WIDTH,
        height: bottom - top,
    };
    sheet.fill(area, PALE);
    let recipe = &report.recipe;
    let changed = if recipe.is_changed { " (modified)" } else { "" };
    let library = &report.library;
    let timings = &report.timings_ms;
    let facts = [
        [
            ("Scene", report.scene.clone()),
            (
                "Source",
                report.source.clone().unwrap_or_else(|| source_of(report)),
            ),
            ("Seen by", report.seen_by.describe().into()),
            (
                "Inspected in",
                format!(
                    "{:.1} ms, {:.1} ms of it for the pose",
                    timings.total, timings.pose
                ),
            ),
        ],
        [
            (
                "Recipe",
                // The name comes last, since a long text is cut where there is no room.
                format!("{}, {}{changed}", recipe.identity, recipe.name),
            ),
            (
                "Library",
                format!(
                    "{}, {} references",
                    library.identity, library.num_references
                ),
            ),
            (
                "Calibration",
                report
                    .robot
                    .calibration
                    .clone()
                    .unwrap_or_else(|| "none".into()),
            ),
            (
                "Program",
                format!("{}, report schema {}", report.program, report.schema),
            ),
        ],
    ];
    for (column, facts) in facts.iter().enumerate() {
        let left = MARGIN + 8.0 + column as f32 * (WIDTH / 2.0 + 4.0);
        let mut y = top + 14.0;
        for (name, value) in facts {
            let style = style(8.0, Weight::Regular, BLACK);
            sheet.text(name, [left, y], SMALL, Anchor::Left);
            let value = sheet.faces.fitted(value, WIDTH / 2.0 - 76.0, style);
            sheet.text(&value, [left + 58.0, y], style, Anchor::Left);
            y += 12.0;
        }
    }
    if !trace.is_empty() {
        let style = style(8.0, Weight::Regular, BLACK);
        let y = top + 14.0 + 4.0 * 12.0;
        sheet.text("Part", [MARGIN + 8.0, y], SMALL, Anchor::Left);
        let trace = sheet.faces.fitted(&trace.join(" · "), WIDTH - 72.0, style);
        sheet.text(&trace, [MARGIN + 66.0, y], style, Anchor::Left);
    }
    sheet.line(&[[MARGIN, top], [MARGIN + WIDTH, top]], 0.75, RULE);
    let y = top - 10.0;
    for (name, left, right) in [("Checked by", 0.0, 300.0), ("Date", 316.0, WIDTH)] {
        sheet.text(name, [MARGIN + left, y], SMALL, Anchor::Left);
        let begin = left + sheet.faces.width(name, SMALL) + 6.0;
        let line = [[MARGIN + begin, y + 2.0], [MARGIN + right, y + 2.0]];
        sheet.line(&line, 0.5, GREY);
    }
    y - 26.0
}

/// Describes the source if the report does not name it.
fn source_of(report: &PoseReport) -> String {
    match report.seen_by {
        SeenBy::NotKnown => "a file",
        SeenBy::Camera => "a camera",
        SeenBy::Simulation => "a simulation",
    }
    .into()
}

/// Adds a capital letter and a full stop.
pub(super) fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    let mut sentence: String = first.into_iter().flatten().chain(letters).collect();
    if !sentence.ends_with('.') {
        sentence.push('.');
    }
    sentence
}
