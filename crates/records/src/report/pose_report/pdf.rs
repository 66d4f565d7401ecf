//! A pose report as one A4 page.

mod facts;
mod numbers;

use image::RgbImage;
use jiff::tz::TimeZone;
use pdf_writer::Date;

use super::{
    PoseReport, SeenBy,
    file::{About, Weight},
    sheet::{Area, Faces, Ink, Sheet, Style},
};
use crate::report::{Picture, lettering::Anchor};
use inspection::pipeline::Identification;
use texts::Language;

/// A4, points.
const PAGE: [f32; 2] = [595.28, 841.89];
const MARGIN: f32 = 40.0;
const WIDTH: f32 = PAGE[0] - 2.0 * MARGIN;
/// Widths of the left column with numbers, and of the right one with pictures and figures.
const LEFT: f32 = 296.0;
const GAP: f32 = 20.0;
const RIGHT: f32 = WIDTH - LEFT - GAP;

const BLACK: Ink = [24, 27, 32];
const GREY: Ink = [72, 80, 92];
const RULE: Ink = [205, 210, 217];
const PALE: Ink = [241, 243, 246];
const GREEN: Ink = [22, 120, 62];
const RED: Ink = [186, 28, 28];
const AMBER: Ink = [166, 92, 0];
const WHITE: Ink = [255, 255, 255];

const fn style(size: f32, weight: Weight, ink: Ink) -> Style {
    Style { size, weight, ink }
}

const SMALL: Style = style(8.0, Weight::Regular, GREY);
const BODY: Style = style(9.0, Weight::Regular, BLACK);
const STRONG: Style = style(9.0, Weight::Bold, BLACK);
const HEADING: Style = style(10.5, Weight::Bold, BLACK);

/// Replaces hyphens by true minus signs: the page is for people, machines read JSON or CSV.
fn typeset(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// The pictures of a report.
#[derive(Clone, Copy, Debug, Default)]
pub struct PdfPictures<'a> {
    /// The 3-D view; without one, the picture of the segmentation is used.
    pub view: Option<&'a RgbImage>,
    /// Pictures of the stages.
    pub stages: &'a [Picture],
    /// Title of the part; without one, its name is used.
    pub title: Option<&'a str>,
}

/// Creates the report as a PDF of one page. Equal reports with equal pictures give identical bytes.
pub fn pose_pdf(report: &PoseReport, pictures: &PdfPictures<'_>) -> Vec<u8> {
    let faces = Faces::new();
    let mut sheet = Sheet::new(PAGE, &faces);
    compose(&mut sheet, report, pictures);
    let at = report.inspected_at.to_zoned(TimeZone::UTC);
    let created = Date::new(at.year().unsigned_abs())
        .month(at.month().unsigned_abs())
        .day(at.day().unsigned_abs())
        .hour(at.hour().unsigned_abs())
        .minute(at.minute().unsigned_abs())
        .second(at.second().unsigned_abs())
        .utc_offset_hour(0);
    sheet.finish(&About {
        title: format!(
            "Pose report: {}, {}",
            headline(report, pictures),
            report.scene
        ),
        creator: &report.program,
        created,
    })
}

/// Draws the whole page from top to bottom.
fn compose(sheet: &mut Sheet<'_>, report: &PoseReport, pictures: &PdfPictures<'_>) {
    let y = head(sheet, report);
    let y = verdict(sheet, report, pictures, y) + 8.0;
    let bottom = facts::foot(sheet, report);
    let stages = shown_stages(pictures);
    let bottom = strip(sheet, &stages, bottom);
    let columns = Area {
        left: MARGIN,
        top: y,
        width: LEFT,
        height: bottom - y,
    };
    match &report.pose {
        Some(pose) => {
            numbers::column(sheet, report, pose, columns);
            let right = Area {
                left: MARGIN + LEFT + GAP,
                width: RIGHT,
                ..columns
            };
            facts::column(sheet, report, pose, pictures, right);
        }
        None => facts::without_pose(
            sheet,
            report,
            pictures,
            Area {
                width: WIDTH,
                ..columns
            },
        ),
    }
}

/// Draws title and time. Returns where the next block begins.
fn head(sheet: &mut Sheet<'_>, report: &PoseReport) -> f32 {
    sheet.text(
        "Partsight pose report",
        [MARGIN, 46.0],
        HEADING,
        Anchor::Left,
    );
    let at = report
        .inspected_at
        .strftime("%Y-%m-%d %H:%M:%S UTC")
        .to_string();
    sheet.text(&at, [MARGIN + WIDTH, 46.0], BODY, Anchor::Right);
    sheet.line(&[[MARGIN, 54.0], [MARGIN + WIDTH, 54.0]], 0.75, RULE);
    if report.seen_by != SeenBy::Simulation {
        return 66.0;
    }
    let band = Area {
        left: MARGIN,
        top: 60.0,
        width: WIDTH,
        height: 18.0,
    };
    sheet.fill(band, AMBER);
    let text = "SIMULATED: no camera was read. This report does not describe a real part.";
    sheet.text(
        text,
        [MARGIN + 8.0, 72.5],
        style(10.0, Weight::Bold, WHITE),
        Anchor::Left,
    );
    90.0
}

/// Returns the title or the name of the part that the verdict is about, if any.
fn part_of<'a>(report: &'a PoseReport, pictures: &PdfPictures<'a>) -> Option<&'a str> {
    let verdict = &report.verdict;
    let part = verdict.part.as_deref().or(verdict.nearest.as_deref());
    pictures.title.or(part)
}

/// Returns the headline of the report.
fn headline(report: &PoseReport, pictures: &PdfPictures<'_>) -> String {
    let found = report.verdict.identification;
    let part = part_of(report, pictures).unwrap_or_default();
    let heading = found.heading(part, Language::English);
    heading.unwrap_or_else(|| match found {
        Identification::NoPart => "No part".into(),
        Identification::Unknown { .. } => "Unknown part".into(),
        // An uncertain name must not be the headline.
        _ => "Part not accepted".into(),
    })
}

/// Draws the verdict. Returns where the next block begins.
fn verdict(
    sheet: &mut Sheet<'_>,
    report: &PoseReport,
    pictures: &PdfPictures<'_>,
    top: f32,
) -> f32 {
    const INDENT: f32 = 16.0;
    let verdict = &report.verdict;
    let is_right = verdict.accepted && verdict.reported_as.is_none();
    let robot = &report.robot;
    // As in the window: green only if a robot may move on it.
    let ink = match is_right {
        true if robot.doubts.is_empty() => GREEN,
        true => AMBER,
        false => RED,
    };
    let title = headline(report, pictures);
    let wide = WIDTH - INDENT - 120.0;
    // As large as fits; only the smallest size is truncated.
    let large = |size: f32| style(size, Weight::Bold, BLACK);
    let sizes = [26.0, 22.0, 18.0, 15.0];
    let size = sizes
        .into_iter()
        .find(|size| sheet.faces.width(&title, large(*size)) <= wide);
    let title_style = large(size.unwrap_or(15.0));
    let title = sheet.faces.fitted(&title, wide, title_style);
    let mut y = top + 21.0;
    sheet.text(&title, [MARGIN + INDENT, y], title_style, Anchor::Left);
    y += 21.0;
    let words = match (verdict.accepted, &report.refused_pose) {
        (true, _) if !is_right => "REPORTED AS WRONG: do not move on this pose",
        (true, _) if !robot.doubts.is_empty() => "RECOGNISED: do not move on this pose",
        (true, _) => "Accepted",
        (false, Some(_)) => "NOT ACCEPTED: do not move on this pose",
        (false, None) => "NOT ACCEPTED: there is no pose",
    };
    mark(sheet, [MARGIN + INDENT + 5.0, y - 5.0], ink);
    sheet.text(
        words,
        [MARGIN + INDENT + 18.0, y],
        style(14.0, Weight::Bold, ink),
        Anchor::Left,
    );
    if let Some(score) = verdict.score {
        let right = MARGIN + WIDTH;
        sheet.text(
            &format!("{score:.2}"),
            [right, top + 21.0],
            large(22.0),
            Anchor::Right,
        );
        let margin = verdict
            .margin
            .map_or(String::new(), |margin| format!(", margin {margin:.2}"));
        let below = format!("score, threshold {:.2}{margin}", verdict.threshold);
        sheet.text(&below, [right, y], SMALL, Anchor::Right);
    }
    y += 15.0;
    let text = |sheet: &mut Sheet<'_>, text: &str, style, y| {
        sheet.paragraph(text, [MARGIN + INDENT, y], WIDTH - INDENT, style, 3)
    };
    let nearest = part_of(report, pictures);
    if let Some(nearest) = nearest.filter(|_| verdict.identification.names_nearest()) {
        y = text(sheet, &format!("Nearest enrolled part: {nearest}"), BODY, y);
    }
    if let Some(actual) = &verdict.reported_as {
        let actual = actual.replace('_', " ");
        let says =
            format!("It was accepted, but a person reported what really hung there: {actual}");
        y = text(sheet, &says, STRONG, y);
    }
    if let Some(reason) = &verdict.reason {
        y = text(sheet, &facts::sentence(reason), BODY, y);
    }
    if let Some(advice) = &verdict.advice {
        y = text(
            sheet,
            &facts::sentence(&format!("What to do: {advice}")),
            STRONG,
            y,
        );
    }
    for caution in report.pose.iter().flat_map(|pose| &pose.cautions) {
        // The headline band shows this already.
        if !caution.starts_with("simulated") {
            y = text(
                sheet,
                &facts::sentence(caution),
                style(9.0, Weight::Bold, AMBER),
                y,
            );
        }
    }
    let bar = Area {
        left: MARGIN,
        top,
        width: 5.0,
        height: y - 8.0 - top,
    };
    sheet.fill(bar, ink);
    y
}

/// Draws a tick or a cross, so that the verdict is readable without colour.
fn mark(sheet: &mut Sheet<'_>, [x, y]: [f32; 2], ink: Ink) {
    let at = |dx: f32, dy: f32| [x + dx, y + dy];
    match ink {
        GREEN => sheet.line(&[at(-5.0, 0.0), at(-1.5, 4.0), at(6.0, -5.0)], 2.2, ink),
        AMBER => {
            sheet.line(&[at(0.0, -5.5), at(0.0, 1.5)], 2.2, ink);
            sheet.line(&[at(0.0, 3.8), at(0.0, 5.5)], 2.2, ink);
        }
        _ => {
            sheet.line(&[at(-4.5, -4.5), at(4.5, 4.5)], 2.2, ink);
            sheet.line(&[at(4.5, -4.5), at(-4.5, 4.5)], 2.2, ink);
        }
    }
}

/// Returns the stages shown in the row; without a 3-D view the first one takes its place instead.
fn shown_stages<'a>(pictures: &PdfPictures<'a>) -> Vec<&'a Picture> {
    let num_above = usize::from(pictures.view.is_none());
    pictures.stages.iter().skip(num_above).collect()
}

/// Draws pictures of the stages side by side at one height, above `bottom`. Returns where they begin.
fn strip(sheet: &mut Sheet<'_>, stages: &[&Picture], bottom: f32) -> f32 {
    const BETWEEN: f32 = 8.0;
    const TALLEST: f32 = 120.0;
    let aspect = |stage: &Picture| stage.image.width() as f32 / stage.image.height().max(1) as f32;
    let aspects: f32 = stages.iter().map(|stage| aspect(stage)).sum();
    let Some(gaps) = stages.len().checked_sub(1) else {
        return bottom;
    };
    let height = ((WIDTH - BETWEEN * gaps as f32) / aspects.max(0.1)).min(TALLEST);
    let top = bottom - height - 16.0;
    let mut left = MARGIN;
    for stage in stages {
        let area = Area {
            left,
            top,
            width: aspect(stage) * height,
            height,
        };
        sheet.picture(&stage.image, area);
        sheet.outline(area, RULE);
        // Not wider than its picture, or it would run into the next.
        let caption = sheet
            .faces
            .fitted(stage_title(stage.stage), area.width, SMALL);
        sheet.text(&caption, [left, top + height + 9.0], SMALL, Anchor::Left);
        left += area.width + BETWEEN;
    }
    top - 10.0
}

fn stage_title(stage: &str) -> &str {
    match stage {
        "segmentation" => "Segmentation",
        "binary" => "Binary image",
        "contour" => "Contour and rays",
        "signature" => "Signature: lengths, angles",
        other => other,
    }
}

#[cfg(test)]
mod tests;
