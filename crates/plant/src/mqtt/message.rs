//! The published JSON messages.

use jiff::Timestamp;
use schemars::{JsonSchema, generate::SchemaSettings, json_schema};
use serde::Serialize;

use inspection::library::LibraryLoad;
use records::history::Traceability;
use robot::RobotPose;
use serve::{CameraStatus, FrameFacts, OnLineNow, PoseKind, Problem, RackPlace, VerdictCode};

/// Version of the messages; compatible changes only add fields.
pub const MESSAGE_SCHEMA: u32 = 1;

/// How the cell is: the retained message of `PREFIX/state`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StateMessage {
    /// Version of the messages.
    pub schema: u32,
    /// The program and its version.
    pub program: String,
    /// The number of this start of the program, 1..=16777215; the same as in its inspections.
    pub boot: u32,
    /// When the program was started, UTC (RFC 3339).
    #[schemars(with = "String")]
    pub since: Timestamp,
    /// False once the program has ended or cannot be reached by the broker; the rest is then as it was.
    pub online: bool,
    /// How the camera is; null while offline.
    pub camera: Option<CameraStatus>,
    /// The enrolled parts.
    pub library: LibraryMessage,
    /// How many inspections of this start were dropped because too many waited for the broker.
    pub num_dropped: u64,
}

/// Which parts are recognised.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LibraryMessage {
    /// Eight hexadecimal digits, the same for the same parts with the same clouds.
    pub identity: String,
    /// Number of enrolled parts.
    pub num_parts: usize,
}

impl LibraryMessage {
    /// Describes a loaded library.
    pub fn of(load: &LibraryLoad) -> Self {
        Self {
            identity: load.identity(),
            num_parts: load.parts.len(),
        }
    }
}

/// An inspection: a message of `PREFIX/inspection`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct InspectionMessage {
    /// Version of the messages.
    pub schema: u32,
    /// The number of this start of the program, 1..=16777215.
    pub boot: u32,
    /// The number of the inspection since then, 1..=16777215. A message that has the boot and sequence number of
    /// another is the same one again.
    pub sequence: u32,
    /// When the inspection ended, UTC (RFC 3339).
    #[schemars(with = "String")]
    pub inspected_at: Timestamp,
    /// When the frame was captured, UTC (RFC 3339); null without a frame.
    #[schemars(with = "Option<String>")]
    pub captured_at: Option<Timestamp>,
    /// Age of the frame when this message was written, milliseconds, at most 16777215; null without a frame.
    pub age_ms: Option<u32>,
    /// The verdict when this message was written: `stale` was accepted, but had become too old by then.
    pub verdict: VerdictCode,
    /// The number of the part in its frame, from 1, in the order of the sequence numbers; 0 if nothing recognisable hangs
    /// there. Each part of a frame has a message of its own.
    pub index: u32,
    /// How many parts hang in the frame, refused ones included.
    pub num_parts: u32,
    /// Name of the part; null if it is none of the library.
    pub part: Option<String>,
    /// The number by which robots know the part; null if it has none.
    pub number: Option<u32>,
    /// The place of the rack where it hangs or, if it is missing, is expected; left out if that is no place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<RackPlace>,
    /// True if the scene is simulated or replayed, or if no camera saw the part when it was enrolled.
    pub simulated: bool,
    /// True if the part may be another model; its pose is only about right.
    pub approximate: bool,
    /// True if it was checked that the part hung still, or there is no pose; false if the source does not show it.
    pub motion_checked: bool,
    /// The pose in the robot's base frame; null unless the verdict is `accepted`.
    pub pose: Option<PoseMessage>,
    /// Where the part is on the line of a camera beside one; left out without a pose, and without a line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on_line: Option<OnLineNow>,
    /// Why there is no pose; null with one.
    pub problem: Option<Problem>,
    /// Serial number, order and operator, as far as they are known.
    pub traceability: Traceability,
    /// What all parts of the frame show.
    #[serde(flatten)]
    pub facts: FrameFacts,
}

/// A pose in the robot's base frame.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PoseMessage {
    /// Which pose: where the part is (`robot_from_part`), or how far it is from its standard position (`robot_offset`).
    pub transform: PoseKind,
    /// Its numbers.
    pub in_convention: RobotPose,
}

impl StateMessage {
    /// Serialises the message.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("numbers and text have a JSON form")
    }

    /// Returns the same state for a cell that is offline.
    #[must_use]
    pub fn offline(&self) -> Self {
        Self {
            online: false,
            camera: None,
            ..self.clone()
        }
    }
}

impl InspectionMessage {
    /// Serialises the message.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("numbers and text have a JSON form")
    }
}

/// Returns the JSON schema of both messages, each under `$defs`, with a final newline; `assets/mqtt.schema.json` is a copy.
pub fn messages_schema() -> String {
    // The schema of serialised messages: every field is present, null or not.
    let mut generator = SchemaSettings::default().for_serialize().into_generator();
    let state = generator.subschema_for::<StateMessage>();
    let inspection = generator.subschema_for::<InspectionMessage>();
    let schema = json_schema!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "MQTT messages",
        "description": "StateMessage is the retained message of PREFIX/state, InspectionMessage one of PREFIX/inspection.",
        "anyOf": [state, inspection],
        "$defs": generator.take_definitions(true),
    });
    let mut json = serde_json::to_string_pretty(&schema).expect("a schema is JSON");
    json.push('\n');
    json
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use capture::fixtures::moment;
    use geometry::rigid::from_euler_zyx;
    use records::fixtures::conforms;
    use robot::Convention;
    use serve::{CameraState, MissingPart};

    fn state() -> StateMessage {
        StateMessage {
            schema: MESSAGE_SCHEMA,
            program: "Partsight 0".into(),
            boot: 7,
            since: moment(0),
            online: true,
            camera: Some(CameraStatus {
                state: CameraState::Lost,
                problem: Some(Problem {
                    reason: "camera_lost".into(),
                    message: "gone (to do: Plug it in)".into(),
                }),
            }),
            library: LibraryMessage {
                identity: "0123abcd".into(),
                num_parts: 8,
            },
            num_dropped: 3,
        }
    }

    fn accepted() -> InspectionMessage {
        let pose = from_euler_zyx([0.1, -0.2, 0.3, 1.2, -0.4, 1.9]);
        InspectionMessage {
            schema: MESSAGE_SCHEMA,
            boot: 7,
            sequence: 1,
            inspected_at: moment(5),
            captured_at: Some(moment(4)),
            age_ms: Some(1000),
            verdict: VerdictCode::Accepted,
            index: 1,
            num_parts: 2,
            part: Some("fender".into()),
            number: Some(3),
            place: None,
            simulated: true,
            motion_checked: true,
            approximate: false,
            pose: Some(PoseMessage {
                transform: PoseKind::RobotFromPart,
                in_convention: Convention::Kuka.write(&pose),
            }),
            on_line: None,
            problem: None,
            traceability: Traceability {
                order: "A-17".into(),
                ..Traceability::default()
            },
            facts: FrameFacts::default(),
        }
    }

    fn value(json: &str) -> Value {
        serde_json::from_str(json).expect("JSON")
    }

    #[test]
    fn messages_conform_to_the_schema() {
        let schema = value(&messages_schema());
        let holds = |name: &str, message: &Value| {
            let of_type = &schema["$defs"][name];
            assert!(of_type.is_object(), "{name} is in the schema");
            conforms(message, of_type, &schema)
        };
        for state in [state(), state().offline()] {
            let message = value(&state.to_json());
            assert_eq!(holds("StateMessage", &message), Ok(()));
            assert_eq!(conforms(&message, &schema, &schema), Ok(()));
        }
        let refused = InspectionMessage {
            verdict: VerdictCode::Error,
            captured_at: None,
            age_ms: None,
            part: None,
            number: None,
            pose: None,
            problem: Some(Problem::default()),
            traceability: Traceability::default(),
            ..accepted()
        };
        let left_hook = RackPlace {
            number: 1,
            name: "left hook".into(),
        };
        let in_rack = InspectionMessage {
            place: Some(left_hook.clone()),
            facts: FrameFacts {
                rack: Some("rack A".into()),
                empty_places: Some(vec![left_hook.clone()]),
                missing: Some(vec![MissingPart {
                    part: "grille".into(),
                    number: None,
                    place: Some(left_hook),
                }]),
            },
            ..accepted()
        };
        for message in [accepted(), refused, in_rack] {
            let message = value(&message.to_json());
            assert_eq!(holds("InspectionMessage", &message), Ok(()));
            assert_eq!(conforms(&message, &schema, &schema), Ok(()));
        }
        // Make sure that the check can fail.
        let mut broken = value(&accepted().to_json());
        broken["verdict"] = "good".into();
        assert!(holds("InspectionMessage", &broken).is_err());
        broken["verdict"] = "accepted".into();
        broken.as_object_mut().expect("fields").remove("pose");
        assert!(holds("InspectionMessage", &broken).is_err());
    }

    #[test]
    fn the_published_schema_is_that_of_the_types() {
        let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
            .join("assets/mqtt.schema.json");
        let made = messages_schema();
        if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
            std::fs::write(&path, &made).expect("written");
        }
        let published = std::fs::read_to_string(&path).expect("the schema");
        assert!(
            published == made,
            "assets/mqtt.schema.json is not what the types give: UPDATE_SNAPSHOTS=1 rewrites it"
        );
    }
}
