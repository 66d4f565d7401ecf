//! The left column with the pose in numbers.

use super::{
    AMBER, Anchor, Area, BLACK, BODY, GREY, HEADING, RULE, SMALL, STRONG, Sheet, Weight, style,
    typeset,
};
use crate::report::pose_report::{PoseBlock, PoseReport, TransformBlock};
use robot::Convention;

const LINE: f32 = 12.5;

/// Draws all numbers of the pose.
pub(super) fn column(sheet: &mut Sheet<'_>, report: &PoseReport, pose: &PoseBlock, area: Area) {
    let y = robot(sheet, report, pose, area);
    let robot = &report.robot;
    let is_shown = robot.robot_from_part.is_none() && robot.convention == Convention::Matrix;
    camera(
        sheet,
        pose,
        is_shown,
        Area {
            top: y + 12.0,
            ..area
        },
    );
}

/// Draws the pose in the convention, in each frame in which it is known. Returns the next baseline.
fn robot(sheet: &mut Sheet<'_>, report: &PoseReport, pose: &PoseBlock, area: Area) -> f32 {
    let robot = &report.robot;
    let in_robot: Vec<&TransformBlock> = [&robot.robot_from_part, &robot.robot_offset]
        .into_iter()
        .flatten()
        .collect();
    let shown: Vec<&TransformBlock> = if in_robot.is_empty() {
        vec![&pose.camera_from_part]
    } else {
        in_robot
    };
    let mut y = area.top + 9.0;
    sheet.text(
        &robot.convention_title,
        [area.left, y],
        HEADING,
        Anchor::Left,
    );
    if let Some(calibration) = &robot.calibration {
        let style = SMALL;
        let text = format!("calibration: {calibration}");
        let beside = sheet.faces.width(&robot.convention_title, HEADING) + 12.0;
        let text = sheet.faces.fitted(&text, area.width - beside, style);
        sheet.text(&text, [area.left + area.width, y], style, Anchor::Right);
    }
    y += 6.0;
    let doubts: Vec<&str> = robot.doubts.iter().map(|doubt| &*doubt.what).collect();
    let caution = match &robot.unavailable {
        Some(why) => Some(format!("In the camera's frame, not in the robot's: {why}.")),
        None if doubts.is_empty() => None,
        None => Some(format!(
            "Given despite doubts, not to be moved by: {}.",
            doubts.join("; ")
        )),
    };
    if let Some(text) = caution {
        // Before the numbers, where it cannot be overlooked.
        let at = [area.left, y + 7.0];
        y = sheet.paragraph(&text, at, area.width, style(8.5, Weight::Bold, AMBER), 3) - 4.0;
    }
    if robot.convention == Convention::Matrix {
        for block in &shown {
            sheet.text(block.name, [area.left, y + LINE], STRONG, Anchor::Left);
            y = matrix(
                sheet,
                block,
                Area {
                    top: y + LINE + 4.0,
                    ..area
                },
            ) + 2.0;
        }
    } else {
        y = table(sheet, &shown, Area { top: y, ..area });
    }
    y += LINE;
    y = sheet.paragraph(
        &format!("{}.", robot.convention_meaning),
        [area.left, y],
        area.width,
        SMALL,
        4,
    );
    for block in &shown {
        let text = format!("{}: {}.", block.name, block.meaning);
        y = sheet.paragraph(&text, [area.left, y + 2.0], area.width, SMALL, 3);
        if let Some(note) = &block.in_convention.gimbal_note {
            let text = format!("{}, {note}", block.name);
            y = sheet.paragraph(
                &text,
                [area.left, y + 2.0],
                area.width,
                style(8.0, Weight::Bold, AMBER),
                2,
            );
        }
    }
    y
}

/// Draws a row for each number and a column for each transform. Returns the last baseline.
fn table(sheet: &mut Sheet<'_>, shown: &[&TransformBlock], area: Area) -> f32 {
    let wide = (area.width - 56.0) / shown.len().max(1) as f32;
    let right = |column: usize| area.left + 56.0 + (column + 1) as f32 * wide;
    let mut y = area.top + LINE;
    for (column, block) in shown.iter().enumerate() {
        sheet.text(
            block.name,
            [right(column), y],
            style(8.5, Weight::Bold, BLACK),
            Anchor::Right,
        );
    }
    let Some(first) = shown.first() else {
        return y;
    };
    for (row, value) in first.in_convention.values.iter().enumerate() {
        sheet.line(
            &[[area.left, y + 3.5], [area.left + area.width, y + 3.5]],
            0.5,
            RULE,
        );
        y += LINE + 0.8;
        sheet.text(value.name, [area.left, y], STRONG, Anchor::Left);
        sheet.text(
            value.unit.symbol(),
            [area.left + 30.0, y],
            style(9.0, Weight::Regular, GREY),
            Anchor::Left,
        );
        for (column, block) in shown.iter().enumerate() {
            if let Some(value) = block.in_convention.values.get(row) {
                sheet.text(
                    &typeset(&value.rounded()),
                    [right(column), y],
                    style(10.0, Weight::Regular, BLACK),
                    Anchor::Right,
                );
            }
        }
    }
    y
}

/// Draws the pose in the camera frame, without the matrix if that is shown above.
fn camera(sheet: &mut Sheet<'_>, pose: &PoseBlock, is_shown: bool, area: Area) {
    let block = &pose.camera_from_part;
    let mut y = area.top;
    if is_shown {
        let text = "x right, y down, z forward. The same as a quaternion:";
        y = sheet.paragraph(text, [area.left, y - 10.0], area.width, SMALL, 1) + 4.0;
    } else {
        sheet.text(block.name, [area.left, y], HEADING, Anchor::Left);
        y = matrix(
            sheet,
            block,
            Area {
                top: y + 6.0,
                ..area
            },
        ) + LINE
            + 1.0;
        let text = "4×4, row after row; x y z in metres in the fourth column. Takes a point of the enrolled part to where it is \
                    before the camera now: x right, y down, z forward.";
        y = sheet.paragraph(text, [area.left, y], area.width, SMALL, 3) + 4.0;
    }
    let values = &block.quaternion.values;
    let line = |names: &[&str], values: &[f64], decimals: usize| {
        let parts = names
            .iter()
            .zip(values)
            .map(|(name, value)| typeset(&format!("{name} {value:.decimals$}")));
        parts.collect::<Vec<_>>().join("   ")
    };
    if let ([names_at @ .., _, _, _, _], [at @ .., _, _, _, _]) =
        (block.quaternion.names, values.as_slice())
    {
        sheet.text(
            &(line(names_at, at, 6) + "   m"),
            [area.left, y],
            BODY,
            Anchor::Left,
        );
    }
    if let ([_, _, _, names @ ..], [_, _, _, turn @ ..]) =
        (block.quaternion.names, values.as_slice())
    {
        sheet.text(
            &line(names, turn, 6),
            [area.left, y + LINE],
            BODY,
            Anchor::Left,
        );
    }
    let text = "Quaternion with the scalar qw last. Its inverse, part_from_camera, is the paper's T (eq. 13).";
    sheet.paragraph(
        text,
        [area.left, y + 2.0 * LINE - 1.0],
        area.width,
        SMALL,
        2,
    );
}

/// Draws the 4×4 matrix. Returns the last baseline.
fn matrix(sheet: &mut Sheet<'_>, block: &TransformBlock, area: Area) -> f32 {
    let mut y = area.top;
    for row in block.matrix.values.chunks(4) {
        y += LINE;
        for (column, value) in row.iter().enumerate() {
            let right = area.left + (column + 1) as f32 * area.width / 4.0;
            let number = typeset(&format!("{value:.6}"));
            sheet.text(&number, [right, y], BODY, Anchor::Right);
        }
    }
    y
}
