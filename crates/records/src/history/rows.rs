//! Conversion between an inspection and the rows of the tables.

use std::sync::Arc;

use jiff::Timestamp;
use rusqlite::{Connection, OptionalExtension as _, Row, TransactionBehavior, params};

use super::{
    entry::{InspectionDetail, NewEntry, Record, StoredRefusal, StoredVerdict, Summary, png_of},
    frames::FrameRecord,
    hung::HungId,
    schema::{WITH_RECIPE_NAMES, WITH_REFUSALS, WITH_TRACEABILITY, version},
    traceability::{TraceChange, Traceability},
};
use geometry::sixteen_numbers;
use inspection::pipeline::{Recipe, RecipeLabel};

/// Returns the columns of a list row. A file that cannot be written is not migrated, so it may lack some.
pub(super) fn columns(file: &Connection) -> rusqlite::Result<String> {
    let trace = if version(file)? >= WITH_TRACEABILITY {
        "serial, job_order, operator"
    } else {
        "'' AS serial, '' AS job_order, '' AS operator"
    };
    Ok(format!("{COLUMNS_OF_EVERY_VERSION}, {trace}"))
}

/// Returns the columns of the rest of an inspection, with its recipe.
pub(super) fn detail_columns(file: &Connection) -> rusqlite::Result<String> {
    let found = version(file)?;
    let recipe = if found >= WITH_RECIPE_NAMES {
        "recipe_name, recipe_changed"
    } else {
        "NULL AS recipe_name, 0 AS recipe_changed"
    };
    let refusal = if found >= WITH_REFUSALS {
        "refusal"
    } else {
        "NULL AS refusal"
    };
    Ok(format!(
        "nearest, reason, advice, {refusal}, camera_from_part, recipe.identity, recipe.json, {recipe}, library, program, \
            line, thumbnail, origin, frame"
    ))
}

/// The columns of a list row that every file has, migrated or not. Those that were added later are in [`columns`].
const COLUMNS_OF_EVERY_VERSION: &str = "number, at, scene, source, simulated, verdict, part, title, score, margin, \
    total_ms, remark, label, frame_bytes, hung, parent, (SELECT count(*) FROM inspection AS other WHERE other.parent = inspection.number)
    AS num_below";

/// Returns the inspection that stands for a part.
pub(super) fn head_of(file: &Connection, hung: &HungId) -> rusqlite::Result<Option<Summary>> {
    let columns = columns(file)?;
    let asked = format!("SELECT {columns} FROM inspection WHERE hung = ? AND parent IS NULL");
    file.query_row(&asked, [&hung.0], summary_of).optional()
}

/// Writes both rows of an inspection, and returns its number.
pub(super) fn insert(
    file: &Connection,
    entry: &NewEntry,
    frame: Option<&FrameRecord>,
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
    let refusal = detail.refusal.as_ref();
    let recipe = recipe_key(file, &detail.recipe_identity, detail.recipe.as_deref())?;
    file.execute(
        "INSERT INTO inspection (at, scene, source, simulated, verdict, part, title, score, margin, total_ms,
            remark, label, frame_bytes, search, hung, parent, serial, job_order, operator, reason_kind)
            VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        params![
            summary.at.as_microsecond(),
            summary.scene,
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
            refusal.and_then(StoredRefusal::kind).map(|kind| kind.to_string()),
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
        "INSERT INTO detail (number, nearest, reason, advice, camera_from_part, recipe, library, program, line,
            thumbnail, origin, frame, recipe_name, recipe_changed, refusal)
            VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        params![
            number,
            detail.nearest,
            refusal.map(|refusal| &refusal.reason),
            refusal.map(|refusal| &refusal.advice),
            entry.record.matrix().as_ref().and_then(json),
            recipe,
            detail.library_identity,
            detail.program,
            detail.line,
            entry.picture.as_ref().map(png_of),
            detail.origin,
            frame.and_then(json),
            detail.recipe_label.as_ref().map(|label| &label.name),
            detail.recipe_label.as_ref().is_some_and(|label| label.is_changed),
            refusal.and_then(|refusal| json(refusal.why.as_ref()?)),
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
    let columns = columns(&file)?;
    let asked = format!("SELECT {columns} FROM inspection WHERE hung = ?");
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
    Ok(Summary {
        number: row.get("number")?,
        at: at.unwrap_or(Timestamp::UNIX_EPOCH),
        scene: row.get("scene")?,
        source: row.get("source")?,
        is_simulated: row.get("simulated")?,
        // An unreadable verdict is not an acceptance.
        verdict: StoredVerdict::named(&verdict).unwrap_or(StoredVerdict::Rejected),
        part: row.get("part")?,
        title: row.get("title")?,
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
    })
}

pub(super) fn record_of(row: &Row<'_>) -> rusqlite::Result<Record> {
    let text = |name| row.get::<_, Option<String>>(name);
    let (pose, frame, why) = (text("camera_from_part")?, text("frame")?, text("refusal")?);
    let (reason, advice) = (text("reason")?, text("advice")?);
    let pose = pose.and_then(|pose| {
        let mut numbers = serde_json::Deserializer::from_str(&pose);
        sixteen_numbers::deserialize(&mut numbers).ok()
    });
    let recipe: String = row.get("json")?;
    let recipe_name: Option<String> = row.get("recipe_name")?;
    let is_changed = row.get("recipe_changed")?;
    let thumbnail: Option<Vec<u8>> = row.get("thumbnail")?;
    Ok(Record {
        summary: summary_of(row)?,
        detail: InspectionDetail {
            nearest: row.get("nearest")?,
            refusal: reason.map(|reason| StoredRefusal {
                reason,
                advice: advice.unwrap_or_default(),
                why: why.and_then(|why| serde_json::from_str(&why).ok()),
            }),
            camera_from_part: pose,
            recipe_label: recipe_name.map(|name| RecipeLabel { name, is_changed }),
            recipe_identity: row.get("identity")?,
            recipe: serde_json::from_str(&recipe).ok().map(Arc::new),
            library_identity: row.get("library")?,
            program: row.get("program")?,
            line: row.get("line")?,
            thumbnail: thumbnail.unwrap_or_default(),
            origin: row.get("origin")?,
            frame: frame.and_then(|frame| serde_json::from_str(&frame).ok()),
        },
    })
}
