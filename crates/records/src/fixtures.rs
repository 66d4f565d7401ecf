//! What tests of this crate and of those above it build.

use std::{path::Path, sync::Arc};

use capture::fixtures::moment;
use geometry::rigid::{from_euler_zyx, row_major};
use image::RgbImage;
use inspection::pipeline::{Recipe, RecipeLabel, Refusal, Rejection, Unrecognisable};
use servo::{ServoState, StopReason};
use stages::{fixtures::small_scene, segment::NoPart};

use crate::history::{
    History, HungId, InspectionDetail, NewEntry, Record, RobotMarks, SceneTitle, ServoRecord,
    ServoRun, ServoSample, ServoTargetKind, StoredVerdict, Summary, Traceability,
};

/// A history entry for an inspection at that time.
pub fn history_entry(seconds: i64, verdict: StoredVerdict, part: &str) -> NewEntry {
    let is_named = matches!(verdict, StoredVerdict::Accepted | StoredVerdict::Rejected);
    let recipe = Recipe::default();
    let camera_from_part = from_euler_zyx([0.1, 0.2, 0.3, 0.01, 0.02, 1.4]);
    let line = format!(
        r#"{{"schema":1,"pose":{{"reference":"{part}","camera_from_part":{:?},"rms_m":{}}},"timings_ms":{{"pose":20.5,"total":31.5,"segment":8.0}}}}"#,
        row_major(&camera_from_part),
        0.001 + 1e-4 * seconds as f64,
    );
    let refusal = match verdict {
        StoredVerdict::Accepted => None,
        StoredVerdict::Rejected => Some(low_score(part, 0.81)),
        StoredVerdict::Unknown => Some(unknown(part, 0.81)),
        StoredVerdict::NoPart => Some(no_part()),
    };
    NewEntry {
        record: Record {
            summary: Summary {
                number: 0,
                at: moment(seconds),
                scene: SceneTitle::Named(format!("frame {seconds}")),
                source: "simulated".into(),
                is_simulated: true,
                verdict,
                part: is_named.then(|| part.to_owned()),
                title: part.replace('_', " "),
                reason: refusal.as_ref().map(Refusal::kind),
                noted: RobotMarks::default(),
                score: (verdict != StoredVerdict::NoPart).then_some([0.97, 0.25]),
                total_ms: 31.5,
                remark: String::new(),
                label: None,
                frame_bytes: None,
                trace: Traceability::default(),
                hung: HungId::new(),
                parent: None,
                num_below: 0,
                rack: None,
            },
            detail: InspectionDetail {
                nearest: Some(part.to_owned()),
                refusal,
                camera_from_part: Some(camera_from_part),
                recipe_label: RecipeLabel::default(),
                recipe_identity: recipe.identity(),
                recipe: Some(Arc::new(recipe)),
                library_identity: "0badcafe".into(),
                program: "0.1.0".into(),
                line,
                thumbnail: Vec::new(),
                origin: Some("{}".into()),
                frame: None,
                frame_loss: None,
            },
        },
        picture: Some(RgbImage::from_pixel(16, 12, image::Rgb([200, 150, 40]))),
        scene: Some(small_scene(seconds as u16)),
        shots: Vec::new(),
        stands_for_part: false,
    }
}

/// A run of servoing at that time: one that reached its target, or stopped for this reason.
pub fn servo_record(seconds: i64, part: &str, stopped: Option<StopReason>) -> ServoRecord {
    let sample = |at: u8, error: Option<f64>, state, held: Option<&StopReason>| ServoSample {
        at_s: 0.1 * f64::from(at),
        error_m: error,
        error_rad: error.map(|error| 1.5 * error),
        state,
        held: held.map(|reason| reason.kind().to_owned()),
    };
    let mut curve: Vec<ServoSample> = (0..3)
        .map(|at| sample(at, None, ServoState::Looking, None))
        .collect();
    let falling = |at: u8| 0.26 * (-0.12 * f64::from(at)).exp();
    curve.extend((3..45).map(|at| sample(at, Some(falling(at)), ServoState::Moving, None)));
    let end = match &stopped {
        None => ServoState::Checking,
        Some(_) => ServoState::Holding,
    };
    curve.extend((45..52).map(|at| sample(at, Some(0.0009), end, stopped.as_ref())));
    let bounds = stopped.is_none().then_some([0.0021, 0.0031]);
    ServoRecord {
        run: ServoRun {
            number: 0,
            at: moment(seconds),
            part: part.into(),
            title: part.replace('_', " "),
            target: ServoTargetKind::StandardPosition,
            robot: "egm".into(),
            source: "simulated".into(),
            is_simulated: true,
            stopped,
            error_m: Some(0.0009),
            error_rad: Some(0.00135),
            bounds_m: bounds.map(|[shift, _]| shift),
            bounds_rad: bounds.map(|[_, turn]| turn),
            is_approximate: false,
            took_s: 5.2,
            num_looks: 52,
            speed_m_s: Some(0.2),
            tolerance_m: 0.008,
            tolerance_rad: 0.0175,
            program: "0.1.0".into(),
        },
        curve,
    }
}

/// Makes it the reason why the inspection was not accepted.
pub fn refuse(entry: &mut NewEntry, why: impl Into<Refusal>) {
    let Record { summary, detail } = &mut entry.record;
    let why = why.into();
    summary.reason = Some(why.kind());
    detail.refusal = Some(why);
}

/// The refusal of a part whose score is too low.
pub fn low_score(part: &str, score: f64) -> Refusal {
    let part = part.to_owned();
    let threshold = 0.9;
    Rejection::LowScore {
        part,
        score,
        threshold,
    }
    .into()
}

fn unknown(nearest: &str, score: f64) -> Refusal {
    let nearest = nearest.to_owned();
    Rejection::Unknown { nearest, score }.into()
}

fn no_part() -> Refusal {
    Unrecognisable::from(NoPart::TooFewPoints {
        found: 12,
        needed: 200,
    })
    .into()
}

/// Opens the history in this folder, and checks that it is undamaged.
pub fn open_history(folder: &Path) -> History {
    let opened = History::open(folder).expect("opened");
    assert_eq!(opened.set_aside, None);
    opened.history
}

/// Creates a history in a new folder.
pub fn new_history() -> (tempfile::TempDir, History) {
    let folder = tempfile::tempdir().expect("a folder");
    let history = open_history(folder.path());
    (folder, history)
}

/// Checks a value against a JSON schema, as far as the published schemas use its keywords.
pub fn conforms(
    value: &serde_json::Value,
    schema: &serde_json::Value,
    root: &serde_json::Value,
) -> Result<(), String> {
    let wrong = |why: &str| Err(format!("{why}: {value} against {schema}"));
    if let Some(reference) = schema.get("$ref").and_then(|reference| reference.as_str()) {
        let pointer = reference.trim_start_matches('#');
        return conforms(
            value,
            root.pointer(pointer).ok_or("a dangling reference")?,
            root,
        );
    }
    for any in ["anyOf", "oneOf"] {
        if let Some(choices) = schema.get(any).and_then(|choices| choices.as_array()) {
            return if choices
                .iter()
                .any(|choice| conforms(value, choice, root).is_ok())
            {
                Ok(())
            } else {
                wrong(any)
            };
        }
    }
    if let Some(only) = schema.get("const") {
        return if only == value {
            Ok(())
        } else {
            wrong("const")
        };
    }
    if let Some(choices) = schema.get("enum").and_then(|choices| choices.as_array()) {
        return if choices.contains(value) {
            Ok(())
        } else {
            wrong("enum")
        };
    }
    let is = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        _ => false,
    };
    let fits = match schema.get("type") {
        Some(serde_json::Value::String(name)) => is(name),
        Some(serde_json::Value::Array(names)) => {
            names.iter().filter_map(|name| name.as_str()).any(is)
        }
        _ => true,
    };
    if !fits {
        return wrong("type");
    }
    if let (Some(fields), Some(properties)) = (
        value.as_object(),
        schema.get("properties").and_then(|p| p.as_object()),
    ) {
        for required in schema
            .get("required")
            .and_then(|r| r.as_array())
            .into_iter()
            .flatten()
        {
            let name = required.as_str().unwrap_or_default();
            if !fields.contains_key(name) {
                return wrong(name);
            }
        }
        for (name, field) in fields {
            let property = properties
                .get(name)
                .ok_or_else(|| format!("{name} is not in the schema"))?;
            conforms(field, property, root)?;
        }
    }
    if let (Some(items), Some(each)) = (value.as_array(), schema.get("items")) {
        for item in items {
            conforms(item, each, root)?;
        }
    }
    Ok(())
}
