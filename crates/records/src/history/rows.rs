//! Conversion between an inspection and the rows of the tables.

use std::sync::Arc;

use jiff::Timestamp;
use rusqlite::{Connection, OptionalExtension as _, Row, TransactionBehavior, params};

use super::{
    entry::{InspectionDetail, NewEntry, Record, RobotMarks, StoredVerdict, Summary, png_of},
    frames::{FrameLoss, FrameRecord, LostFrame},
    hung::HungId,
    scene_title::SceneTitle,
    traceability::{TraceChange, Traceability},
};
use geometry::sixteen_numbers;
use inspection::pipeline::{Recipe, RecipeLabel, RefusalKind};

/// The columns of a list row.
pub(super) const COLUMNS: &str = "number, at, scene, simulated_frame, num_shots, source, simulated, verdict, part, title, \
    reason_kind, robot_doubts, motion_checked, rack, score, margin, total_ms, remark, label, frame_bytes, hung, parent, serial, job_order, operator, \
    (SELECT count(*) FROM inspection AS other WHERE other.parent = inspection.number) AS num_below";

/// The columns of the rest of an inspection, with its recipe.
pub(super) const DETAIL_SELECTED: &str = "nearest, refusal, camera_from_part, recipe.identity, recipe.json, recipe_name, \
    recipe_changed, library, program, line, thumbnail, origin, frame";

/// Returns the inspection that stands for a part.
pub(super) fn head_of(file: &Connection, hung: &HungId) -> rusqlite::Result<Option<Summary>> {
    let asked = format!("SELECT {COLUMNS} FROM inspection WHERE hung = ? AND parent IS NULL");
    file.query_row(&asked, [&hung.0], summary_of).optional()
}

/// Writes both rows of an inspection, with its kept frame or why there is none, and returns its number.
pub(super) fn insert(
    file: &Connection,
    entry: &NewEntry,
    frame: Option<&FrameRecord>,
    lost: Option<FrameLoss>,
) -> rusqlite::Result<i64> {
    let Record { summary, detail } = &entry.record;
    let head = head_of(file, &summary.hung)?;
    let (parent, gives_way) = match &head {
        Some(head) if entry.takes_over_from(head) => (None, Some(head)),
        Some(head) => {
            trace_row(file, head, head.trace.clone().or(&summary.trace))?;
            (Some(head.number), None)
        }
        None => (None, None),
    };
    // The part keeps its remark, label, traceability and source.
    let mut summary = summary.clone();
    if let Some(head) = &head {
        summary.trace = summary.trace.or(&head.trace);
    }
    if let Some(head) = gives_way {
        // A repeated inspection is named after its scene.
        summary.source.clone_from(&head.source);
        // They may have been set while this inspection waited to be written.
        if summary.remark.is_empty() {
            summary.remark.clone_from(&head.remark);
        }
        summary.label = summary.label.or_else(|| head.label.clone());
    }
    let [score, margin] = summary.score.map_or([None; 2], |both| both.map(Some));
    let (scene, simulated_frame, num_shots) = match &summary.scene {
        SceneTitle::Named(name) => (name.as_str(), None, None),
        SceneTitle::SimulatedFrame(number) => ("", Some(*number as i64), None),
        SceneTitle::Scan { name, num_shots } => (name.as_str(), None, Some(*num_shots as i64)),
    };
    let recipe = recipe_key(file, &detail.recipe_identity, detail.recipe.as_deref())?;
    file.execute(
        "INSERT INTO inspection (at, scene, simulated_frame, num_shots, source, simulated, verdict, part, title, score,
            margin, total_ms, remark, label, frame_bytes, search, hung, parent, serial, job_order, operator, reason_kind,
            robot_doubts, motion_checked, rack)
            VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        params![
            summary.at.as_microsecond(),
            scene,
            simulated_frame,
            num_shots,
            summary.source,
            summary.is_simulated,
            summary.verdict.name(),
            summary.part,
            summary.title,
            score,
            margin,
            summary.total_ms,
            summary.remark,
            summary.label.as_ref().and_then(json),
            frame.map(|frame| frame.all_bytes() as i64),
            summary.search(),
            summary.hung.0,
            parent,
            summary.trace.serial,
            summary.trace.order,
            summary.trace.operator,
            summary.reason.as_ref().map(RefusalKind::name),
            summary.noted.robot_doubts.join(" "),
            summary.noted.motion_checked,
            summary.rack,
        ],
    )?;
    let number = file.last_insert_rowid();
    if gives_way.is_some() {
        file.execute(
            "UPDATE inspection SET parent = ?1 WHERE hung = ?2 AND number <> ?1",
            params![number, summary.hung.0],
        )?;
    }
    file.execute(
        "INSERT INTO detail (number, nearest, refusal, camera_from_part, recipe, recipe_name, recipe_changed, library,
            program, line, thumbnail, origin, frame)
            VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        params![
            number,
            detail.nearest,
            detail.refusal.as_ref().and_then(json),
            entry.record.matrix().as_ref().and_then(json),
            recipe,
            detail.recipe_label.name,
            detail.recipe_label.is_changed,
            detail.library_identity,
            detail.program,
            detail.line,
            entry.picture.as_ref().map(png_of),
            detail.origin,
            match (frame, lost) {
                (Some(frame), _) => json(frame),
                (None, lost) => lost.and_then(|lost| json(&LostFrame { lost })),
            },
        ],
    )?;
    Ok(number)
}

/// Changes the traceability of all inspections of a part.
pub(super) fn trace_part(
    file: &mut Connection,
    hung: &HungId,
    change: &TraceChange,
) -> rusqlite::Result<()> {
    let file = file.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let asked = format!("SELECT {COLUMNS} FROM inspection WHERE hung = ?");
    let mut asked = file.prepare(&asked)?;
    let rows = asked.query_map([&hung.0], summary_of)?;
    let rows = rows.collect::<rusqlite::Result<Vec<Summary>>>()?;
    drop(asked);
    for row in &rows {
        trace_row(&file, row, row.trace.clone().changed(change))?;
    }
    file.commit()
}

/// Writes another traceability of an inspection.
fn trace_row(file: &Connection, row: &Summary, trace: Traceability) -> rusqlite::Result<()> {
    if trace == row.trace {
        return Ok(());
    }
    let row = Summary {
        trace,
        ..row.clone()
    };
    file.execute(
        "UPDATE inspection SET serial = ?, job_order = ?, operator = ?, search = ? WHERE number = ?",
        params![
            row.trace.serial,
            row.trace.order,
            row.trace.operator,
            row.search(),
            row.number
        ],
    )?;
    Ok(())
}

/// Where a recipe is written: under its identity, unless another has that by chance.
fn recipe_key(
    file: &Connection,
    identity: &str,
    recipe: Option<&Recipe>,
) -> rusqlite::Result<String> {
    let written = recipe.and_then(json).unwrap_or_default();
    let mut key = identity.to_owned();
    for number in 2.. {
        file.execute(
            "INSERT INTO recipe (identity, json) VALUES (?, ?) ON CONFLICT DO NOTHING",
            [&key, &written],
        )?;
        let asked = "SELECT json FROM recipe WHERE identity = ?";
        let known: String = file.query_row(asked, [&key], |row| row.get(0))?;
        if known == written {
            break;
        }
        key = format!("{identity}-{number}");
    }
    Ok(key)
}

pub(super) fn json(value: &impl serde::Serialize) -> Option<String> {
    serde_json::to_string(value).ok()
}

pub(super) fn summary_of(row: &Row<'_>) -> rusqlite::Result<Summary> {
    let score: Option<f64> = row.get("score")?;
    let margin: Option<f64> = row.get("margin")?;
    let label: Option<String> = row.get("label")?;
    let verdict: String = row.get("verdict")?;
    let at = Timestamp::from_microsecond(row.get("at")?);
    let bytes: Option<i64> = row.get("frame_bytes")?;
    let reason: Option<String> = row.get("reason_kind")?;
    let doubts: String = row.get("robot_doubts")?;
    let name: String = row.get("scene")?;
    let frame: Option<i64> = row.get("simulated_frame")?;
    let shots: Option<i64> = row.get("num_shots")?;
    let scene = match (frame, shots) {
        (Some(number), _) => SceneTitle::SimulatedFrame(number as u64),
        (None, Some(num)) => SceneTitle::Scan {
            name,
            num_shots: num as usize,
        },
        (None, None) => SceneTitle::Named(name),
    };
    Ok(Summary {
        number: row.get("number")?,
        at: at.unwrap_or(Timestamp::UNIX_EPOCH),
        scene,
        source: row.get("source")?,
        is_simulated: row.get("simulated")?,
        // An unreadable verdict is not an acceptance.
        verdict: StoredVerdict::named(&verdict).unwrap_or(StoredVerdict::Rejected),
        part: row.get("part")?,
        title: row.get("title")?,
        reason: reason.map(RefusalKind::named),
        noted: RobotMarks {
            robot_doubts: doubts.split_whitespace().map(str::to_owned).collect(),
            motion_checked: row.get("motion_checked")?,
        },
        score: score.zip(margin).map(|(score, margin)| [score, margin]),
        total_ms: row.get("total_ms")?,
        remark: row.get("remark")?,
        label: label.and_then(|label| serde_json::from_str(&label).ok()),
        frame_bytes: bytes.map(|bytes| bytes as u64),
        trace: Traceability {
            serial: row.get("serial")?,
            order: row.get("job_order")?,
            operator: row.get("operator")?,
        },
        hung: HungId(row.get("hung")?),
        parent: row.get("parent")?,
        num_below: row.get::<_, i64>("num_below")? as usize,
        rack: row.get("rack")?,
    })
}

pub(super) fn record_of(row: &Row<'_>) -> rusqlite::Result<Record> {
    let text = |name| row.get::<_, Option<String>>(name);
    let (pose, frame, why) = (text("camera_from_part")?, text("frame")?, text("refusal")?);
    let pose = pose.and_then(|pose| {
        let mut numbers = serde_json::Deserializer::from_str(&pose);
        sixteen_numbers::deserialize(&mut numbers).ok()
    });
    let recipe: String = row.get("json")?;
    let thumbnail: Option<Vec<u8>> = row.get("thumbnail")?;
    Ok(Record {
        summary: summary_of(row)?,
        detail: InspectionDetail {
            nearest: row.get("nearest")?,
            refusal: why.and_then(|why| serde_json::from_str(&why).ok()),
            camera_from_part: pose,
            recipe_label: RecipeLabel {
                name: row.get("recipe_name")?,
                is_changed: row.get("recipe_changed")?,
            },
            recipe_identity: row.get("identity")?,
            recipe: serde_json::from_str(&recipe).ok().map(Arc::new),
            library_identity: row.get("library")?,
            program: row.get("program")?,
            line: row.get("line")?,
            thumbnail: thumbnail.unwrap_or_default(),
            origin: row.get("origin")?,
            frame: frame
                .as_deref()
                .and_then(|frame| serde_json::from_str(frame).ok()),
            frame_loss: frame
                .and_then(|frame| serde_json::from_str::<LostFrame>(&frame).ok())
                .map(|LostFrame { lost }| lost),
        },
    })
}
