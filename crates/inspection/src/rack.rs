//! Rack files: where parts may hang.
//!
//! ```toml
//! schema_version = 1
//! name = "rack A"
//! frame = "camera"                       # or "base": the robot's base frame, which takes a calibration
//!
//! [[volume]]                             # nothing outside these boxes is looked at; without them, everything is
//! centre_mm = [0, 100, 2200]
//! size_mm = [2400, 1800, 900]
//! angles_deg = [0, 0, 0]                 # about x, y and z of the frame, R = Rz·Ry·Rx; 0 without them
//!
//! [[place]]                              # without places, parts may hang anywhere in the volume
//! name = "left hook"
//! centre_mm = [-600, 0, 2200]            # where the middle of the part may be
//! size_mm = [300, 300, 300]
//! max_turn_deg = 20                      # or, about x, y and z of the place's box: [10, 180, 10]
//! parts = [                              # without them, each part may hang there, in any orientation
//!     { name = "fender", angles_deg = [180, 0, 5] },
//!     { name = "grille" },               # in any orientation
//! ]
//! ```

mod edit;

use std::path::{Path, PathBuf};

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use crate::{
    library::Library,
    pipeline::{Inspection, Rejection},
};
use files::{FileError, parse_toml, read_text, toml_problem, visible, write_text};
use geometry::{
    error::Advice,
    oriented_box::{BoxError, OrientedBox},
    rigid::RigidTransform,
    units::{Metres, Radians},
};
pub use stages::rack::{MaxTurn, Place, PlacedPart, Rack};
use stages::segment::MAX_PARTS;
use texts::{Described, Message};

/// Version of the file format.
const SCHEMA: u32 = 1;
/// Maximum size of a file, bytes.
const MAX_BYTES: u64 = 1 << 18;
/// Maximum number of boxes of the work volume.
pub const MAX_BOXES: usize = 20;
/// Maximum length of a name, characters.
pub const MAX_NAME: usize = 40;
/// Largest turn that a place can allow.
pub const MAX_TURN: Radians = Radians(std::f64::consts::PI);
/// Side of a new place: parts on hooks sway and shift by a few centimetres.
const NEW_PLACE_SIDE: Metres = Metres(0.3);
/// Turn that a new place allows.
const NEW_PLACE_TURN: MaxTurn = MaxTurn::Total(Radians(20.0_f64.to_radians()));
/// Room that a new work volume leaves around a part on each side.
const VOLUME_MARGIN: Metres = Metres(0.15);

/// A rack, as its file has it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub struct RackFile {
    /// The frame of all its coordinates.
    pub frame: RackFrame,
    /// Name, work volume and places, in that frame.
    pub rack: Rack,
}

/// The frame of a rack's coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RackFrame {
    /// Camera space: the rack stands still before a fixed camera.
    #[default]
    Camera,
    /// The robot's base frame.
    Base,
}

/// Why a rack cannot be read, written or used.
#[derive(Debug, thiserror::Error)]
pub enum RackError {
    /// The file cannot be read or written.
    File(#[from] FileError),
    /// Something in the file is wrong.
    Garbled {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: RackProblem,
    },
    /// A place is for a part that the library does not have.
    NotEnrolled {
        /// The place.
        place: String,
        /// The part.
        part: String,
    },
    /// Its coordinates are in the base frame, and the camera's position there is not known.
    NotCalibrated,
}

/// What is wrong with a rack.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum RackProblem {
    /// It is no TOML, or has other fields.
    Toml {
        /// The line and what is wrong, in English.
        what: String,
    },
    /// Too many boxes of the work volume.
    Boxes {
        /// Their number.
        found: usize,
        /// Largest number.
        limit: usize,
    },
    /// Too many places.
    Places {
        /// Their number.
        found: usize,
        /// Largest number.
        limit: usize,
    },
    /// Neither a volume nor a place.
    Empty,
    /// Its name or that of a place is empty, too long or not printable.
    Name {
        /// Maximum length, characters.
        limit: usize,
        /// True for the name of a place.
        is_place: bool,
    },
    /// Two places have this name.
    SameName {
        /// The name.
        place: String,
    },
    /// The centre of a place lies in another.
    Overlap {
        /// The place.
        place: String,
        /// The other place.
        over: String,
    },
    /// The turn that a place allows is out of range.
    MaxTurn {
        /// The place.
        place: String,
        /// The turn, degrees.
        found: String,
    },
    /// The numbers of a box or of an orientation are wrong.
    #[serde(untagged)]
    Box(BoxError),
}

impl Described for RackProblem {
    fn message(&self) -> Message {
        match self {
            Self::Box(error) => error.message(),
            _ => Message::tagged("rack", "kind", self),
        }
    }
}

impl Described for RackError {
    fn message(&self) -> Message {
        match self {
            Self::File(error) => Message::new("rack-file")
                .with("what", &*error.to_string())
                .with("to_do", &*error.advice()),
            Self::Garbled { path, problem } => Message::new("rack-garbled")
                .with("path", &*path.display().to_string())
                .caused_by(problem.message()),
            Self::NotEnrolled { place, part } => Message::new("rack-not-enrolled")
                .with("place", &**place)
                .with("name", &**part),
            Self::NotCalibrated => Message::new("rack-not-calibrated"),
        }
    }
}

texts::display!(RackError, RackProblem);

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    schema_version: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    frame: RackFrame,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    volume: Vec<WrittenBox>,
    #[serde(default, rename = "place", skip_serializing_if = "Vec::is_empty")]
    places: Vec<WrittenPlace>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenBox {
    centre_mm: [f64; 3],
    size_mm: [f64; 3],
    #[serde(default, skip_serializing_if = "are_zero")]
    angles_deg: [f64; 3],
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenPlace {
    name: String,
    centre_mm: [f64; 3],
    size_mm: [f64; 3],
    #[serde(default, skip_serializing_if = "are_zero")]
    angles_deg: [f64; 3],
    #[serde(default = "new_place_turn_deg")]
    max_turn_deg: WrittenTurn,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    parts: Vec<WrittenPart>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenPart {
    name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    angles_deg: Option<[f64; 3]>,
}

#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number, or three of them, for x, y and z"
)]
enum WrittenTurn {
    Total(f64),
    EachAxis([f64; 3]),
}

impl WrittenTurn {
    fn of(turn: MaxTurn) -> Self {
        match turn {
            MaxTurn::Total(limit) => Self::Total(written_deg(limit.0)),
            MaxTurn::EachAxis(limits) => Self::EachAxis(limits.map(|limit| written_deg(limit.0))),
        }
    }

    fn read(self) -> MaxTurn {
        match self {
            Self::Total(limit) => MaxTurn::Total(Radians::from_degrees(limit)),
            Self::EachAxis(limits) => MaxTurn::EachAxis(limits.map(Radians::from_degrees)),
        }
    }
}

fn are_zero(numbers: &[f64; 3]) -> bool {
    numbers
        .iter()
        .all(|number| number.abs() < f64::MIN_POSITIVE)
}

fn new_place_turn_deg() -> WrittenTurn {
    WrittenTurn::of(NEW_PLACE_TURN)
}

impl RackFile {
    /// An empty rack that has the name of this file, if it is a valid one.
    pub fn named_after(path: &Path) -> Self {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let mut file = Self::default();
        if is_name(&name) {
            file.rack.name = name.into_owned();
        }
        file
    }

    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self, RackError> {
        Self::parse(path, &read_text(path, MAX_BYTES)?)
    }

    /// Parses a rack from text; errors name `path` as its file.
    pub fn parse(path: &Path, text: &str) -> Result<Self, RackError> {
        let garbled = |problem| RackError::Garbled {
            path: path.to_owned(),
            problem,
        };
        let bad = |error: toml::de::Error| {
            let what = toml_problem(text, &error);
            garbled(RackProblem::Toml { what })
        };
        let written: Written = parse_toml(path, text, SCHEMA, bad)?;
        Self::try_from(written).map_err(garbled)
    }
}

impl TryFrom<Written> for RackFile {
    type Error = RackProblem;

    fn try_from(written: Written) -> Result<Self, RackProblem> {
        let volume = (1..).zip(written.volume).map(|(number, one)| {
            let name = format!("[[volume]] {number}");
            let region = OrientedBox::of_file(&name, one.centre_mm, one.size_mm, one.angles_deg);
            region.map_err(RackProblem::Box)
        });
        let places = written.places.into_iter().map(WrittenPlace::read);
        let file = Self {
            rack: Rack {
                name: written.name,
                volume: volume.collect::<Result<_, _>>()?,
                places: places.collect::<Result<_, _>>()?,
            },
            frame: written.frame,
        };
        file.check()?;
        Ok(file)
    }
}

impl From<RackFile> for Written {
    fn from(file: RackFile) -> Self {
        Self {
            schema_version: SCHEMA,
            name: file.rack.name,
            frame: file.frame,
            volume: file.rack.volume.iter().map(WrittenBox::of).collect(),
            places: file.rack.places.iter().map(WrittenPlace::of).collect(),
        }
    }
}

impl RackFile {
    /// Returns what is wrong with names and numbers of boxes and places.
    pub fn check(&self) -> Result<(), RackProblem> {
        let Rack {
            name,
            volume,
            places,
        } = &self.rack;
        if volume.len() > MAX_BOXES {
            let found = volume.len();
            let limit = MAX_BOXES;
            return Err(RackProblem::Boxes { found, limit });
        }
        if places.len() > MAX_PARTS {
            let found = places.len();
            let limit = MAX_PARTS;
            return Err(RackProblem::Places { found, limit });
        }
        if self.rack.is_empty() {
            return Err(RackProblem::Empty);
        }
        if !name.is_empty() && !is_name(name) {
            return Err(RackProblem::Name {
                limit: MAX_NAME,
                is_place: false,
            });
        }
        for (index, place) in places.iter().enumerate() {
            let name = &place.name;
            if !is_name(name) {
                return Err(RackProblem::Name {
                    limit: MAX_NAME,
                    is_place: true,
                });
            }
            let others = &places[..index];
            if others.iter().any(|other| other.name == *name) {
                let place = name.clone();
                return Err(RackProblem::SameName { place });
            }
            let centre = |one: &Place| Point3::from(one.region.centre_m);
            let within = |one: &Place, other: &Place| other.region.distance(&centre(one)) <= 0.0;
            let overlapping =
                (others.iter()).find(|other| within(place, other) || within(other, place));
            if let Some(other) = overlapping {
                return Err(RackProblem::Overlap {
                    place: name.clone(),
                    over: other.name.clone(),
                });
            }
            let limits = place.max_turn.limits();
            if !limits.iter().all(|turn| turn.0 > 0.0 && *turn <= MAX_TURN) {
                let found = limits.iter().map(|turn| turn.degrees().to_string());
                return Err(RackProblem::MaxTurn {
                    place: name.clone(),
                    found: found.collect::<Vec<_>>().join(", "),
                });
            }
        }
        Ok(())
    }

    /// Returns an error if a part of a place is not enrolled under that name.
    pub fn check_parts(&self, is_enrolled: impl Fn(&str) -> bool) -> Result<(), RackError> {
        let parts = self.rack.places.iter().flat_map(|place| {
            let parts = place.parts.iter();
            parts.map(move |part| (&place.name, &part.name))
        });
        match parts.into_iter().find(|(_, part)| !is_enrolled(part)) {
            Some((place, part)) => Err(RackError::NotEnrolled {
                place: place.clone(),
                part: part.clone(),
            }),
            None => Ok(()),
        }
    }

    /// The contents of the file as text.
    pub fn text(&self) -> String {
        let text = toml::to_string(&Written::from(self.clone()))
            .expect("names and numbers have a TOML form");
        format!("# A rack of Partsight: where parts may hang. Millimetres and degrees.\n{text}")
    }

    /// Writes the file atomically, and returns the rack as the file holds it. Of a rack that is there, comments and all that
    /// stays the same are kept.
    pub fn write(&self, path: &Path) -> Result<Self, RackError> {
        let text = self.text();
        let as_read = Self::parse(path, &text)?;
        let changed = self.changed_text(path).and_then(|changed| {
            let read = Self::parse(path, &changed).ok()?;
            (read.text() == text).then_some((changed, read))
        });
        let (text, as_read) = changed.unwrap_or((text, as_read));
        write_text(path, &text)?;
        Ok(as_read)
    }

    /// The text of the rack that is in this file, changed to this one.
    fn changed_text(&self, path: &Path) -> Option<String> {
        let text = read_text(path, MAX_BYTES).ok()?;
        edit::changed(&text, &Self::parse(path, &text).ok()?, self)
    }

    /// The rack in camera space. `base_from_camera` is where the camera is, if that is known.
    pub fn in_camera(&self, base_from_camera: Option<&RigidTransform>) -> Result<Rack, RackError> {
        let frame_from_camera = self.frame_from_camera(base_from_camera)?;
        Ok(self.rack.moved(&frame_from_camera.inverse()))
    }

    /// As [`in_camera`](Self::in_camera), for parts of this library.
    pub fn for_library(
        &self,
        library: &Library,
        base_from_camera: Option<&RigidTransform>,
    ) -> Result<Rack, RackError> {
        self.check_parts(|name| library.has_reference(name))?;
        self.in_camera(base_from_camera)
    }

    fn frame_from_camera(
        &self,
        base_from_camera: Option<&RigidTransform>,
    ) -> Result<RigidTransform, RackError> {
        match self.frame {
            RackFrame::Camera => Ok(RigidTransform::identity()),
            RackFrame::Base => base_from_camera.copied().ok_or(RackError::NotCalibrated),
        }
    }

    /// Adds a place, or changes the one of this name, so that the part of an inspection may hang there as it does; `middle` is
    /// that of its reference. Returns false if no place can be made of it, see [`may_be_taken`].
    pub fn take_place(
        &mut self,
        name: &str,
        inspection: &Inspection,
        middle: Option<Point3<f64>>,
        base_from_camera: Option<&RigidTransform>,
    ) -> Result<bool, RackError> {
        let frame_from_camera = self.frame_from_camera(base_from_camera)?;
        let named = (inspection.reference()).filter(|_| may_be_taken(inspection));
        let found = named.zip(inspection.found_pose()).zip(middle);
        let Some(((reference, pose), middle)) = found else {
            return Ok(false);
        };
        let frame_from_part = frame_from_camera * pose.camera_from_part();
        let part = PlacedPart {
            name: reference.to_owned(),
            angles_rad: Some(frame_from_part.rotation.euler_angles().into()),
        };
        let places = &mut self.rack.places;
        match places.iter_mut().find(|place| place.name == name) {
            Some(place) => {
                place.region.centre_m = (frame_from_part * middle).coords.into();
                place.parts.retain(|other| other.name != part.name);
                place.parts.push(part);
            }
            None => places.push(Place {
                name: name.to_owned(),
                region: OrientedBox {
                    centre_m: (frame_from_part * middle).coords.into(),
                    size_m: [NEW_PLACE_SIDE.0; 3],
                    angles_rad: [0.0; 3],
                },
                max_turn: NEW_PLACE_TURN,
                parts: vec![part],
            }),
        }
        Ok(true)
    }

    /// The lowest number that is the name of no place.
    pub fn new_place_name(&self) -> String {
        let mut numbers = (1..).map(|number: usize| number.to_string());
        let is_new = |name: &String| self.rack.places.iter().all(|place| place.name != *name);
        numbers.find(is_new).expect("one of endless numbers")
    }

    /// Adds a box around the segmented part of an inspection to the work volume; returns false if there is none.
    pub fn take_volume(
        &mut self,
        inspection: &Inspection,
        base_from_camera: Option<&RigidTransform>,
    ) -> Result<bool, RackError> {
        let frame_from_camera = self.frame_from_camera(base_from_camera)?;
        let Ok(part) = &inspection.segmentation.part else {
            return Ok(false);
        };
        let points = part.cloud.points.iter();
        let mut points = points.map(|p| (frame_from_camera * p.cast::<f64>()).coords);
        let Some(first) = points.next() else {
            return Ok(false);
        };
        let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
        self.rack.volume.push(OrientedBox {
            centre_m: ((low + high) / 2.0).into(),
            size_m: (high - low).add_scalar(2.0 * VOLUME_MARGIN.0).into(),
            angles_rad: [0.0; 3],
        });
        Ok(true)
    }
}

/// True if a place can be made of the part of an inspection: it is accepted, or only another rack speaks against it.
pub fn may_be_taken(inspection: &Inspection) -> bool {
    let verdict = &inspection.verdict;
    verdict.is_accepted() || verdict.rejected().is_some_and(Rejection::is_by_rack)
}

/// The warning before a place is made of this part, if another pose fits as well: the one that was found becomes the one that
/// is allowed.
pub fn ambiguity(inspection: &Inspection) -> Option<String> {
    let pose = inspection.found_pose()?;
    let part = inspection.verdict.guess()?;
    pose.is_ambiguous().then(|| {
        format!("another pose of {part} fits as well: from now on, only the one that was found is allowed at this place")
    })
}

fn is_name(name: &str) -> bool {
    let is_seen = !name.trim().is_empty() && visible(name) == name;
    is_seen && name.chars().count() <= MAX_NAME
}

/// Rounds to what a file holds: hundredths of a millimetre.
fn written_mm(metres: f64) -> f64 {
    (metres * 1e5).round() / 100.0
}

/// Rounds to what a file holds: thousandths of a degree.
fn written_deg(radians: f64) -> f64 {
    (radians.to_degrees() * 1e3).round() / 1e3
}

impl WrittenBox {
    fn of(region: &OrientedBox) -> Self {
        Self {
            centre_mm: region.centre_m.map(written_mm),
            size_mm: region.size_m.map(written_mm),
            angles_deg: region.angles_rad.map(written_deg),
        }
    }
}

impl WrittenPlace {
    fn of(place: &Place) -> Self {
        let WrittenBox {
            centre_mm,
            size_mm,
            angles_deg,
        } = WrittenBox::of(&place.region);
        let parts = place.parts.iter().map(|part| WrittenPart {
            name: part.name.clone(),
            angles_deg: part.angles_rad.map(|angles| angles.map(written_deg)),
        });
        Self {
            name: place.name.clone(),
            centre_mm,
            size_mm,
            angles_deg,
            max_turn_deg: WrittenTurn::of(place.max_turn),
            parts: parts.collect(),
        }
    }

    fn read(self) -> Result<Place, RackProblem> {
        let Self {
            name,
            centre_mm,
            size_mm,
            angles_deg,
            max_turn_deg,
            parts,
        } = self;
        let parts = parts.into_iter().map(|part| {
            let angles = part.angles_deg;
            if angles.is_some_and(|angles| !angles.iter().all(|x| x.abs() <= 360.0)) {
                return Err(RackProblem::Box(BoxError::Number {
                    field: "angles_deg",
                    name: format!("[[place]] {name}, {}", part.name),
                    found: format!("{:?}", angles.unwrap_or_default()),
                }));
            }
            Ok(PlacedPart {
                name: part.name,
                angles_rad: angles.map(|angles| angles.map(f64::to_radians)),
            })
        });
        Ok(Place {
            region: OrientedBox::of_file(
                &format!("[[place]] {name}"),
                centre_mm,
                size_mm,
                angles_deg,
            )
            .map_err(RackProblem::Box)?,
            max_turn: max_turn_deg.read(),
            parts: parts.collect::<Result<_, _>>()?,
            name,
        })
    }
}

#[cfg(test)]
mod tests;
