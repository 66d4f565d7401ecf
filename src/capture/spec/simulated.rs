//! What the simulated cell shows.

use std::fmt;

use super::{SIMULATED, SpecError, options::Options};
use crate::{
    geometry::{rigid::RigidTransform, written_pose::parse_pose},
    simulate::{Clutter, ObjectKind, PartKind, PoseRange, Side},
};

/// What the simulated cell shows.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedSpec {
    /// What hangs there.
    pub scene: CellScene,
    /// The side of the car, where the part has one.
    pub side: Side,
    /// The car model; 0 is the standard car.
    pub model: u64,
    /// Where it hangs.
    pub pose: SimulatedPose,
    /// Noise of the camera: 1 is a Kinect's, 0 none; 0 to 5.
    pub noise: f64,
    /// What else is there.
    pub clutter: Clutter,
    /// Draws all that is drawn.
    pub seed: u64,
    /// Frames a second; 0.1 to 1000.
    pub frames_per_second: f64,
}

impl Default for SimulatedSpec {
    fn default() -> Self {
        Self {
            scene: CellScene::Line { every: EVERY },
            side: Side::Left,
            model: 0,
            pose: SimulatedPose::Facing,
            noise: 1.0,
            clutter: Clutter::None,
            seed: 1,
            frames_per_second: FRAMES_PER_SECOND,
        }
    }
}

/// What hangs in the simulated cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellScene {
    /// The line runs: the eight parts swing in one after the other, hang still, and swing out.
    Line {
        /// Seconds from one part to the next; 4 to 3600.
        every: f64,
    },
    /// One part, hanging still.
    Part(PartKind),
    /// Something that is no known part, hanging still.
    Object(ObjectKind),
    /// Nothing.
    Empty,
}

/// Seconds that a part of the line takes, unless said otherwise.
const EVERY: f64 = 8.0;
/// A Kinect's.
const FRAMES_PER_SECOND: f64 = 30.0;

/// Where a part of the simulated cell hangs.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SimulatedPose {
    /// Drawn: hung with care, up to 10 degrees off.
    #[default]
    Facing,
    /// Drawn: up to 30 degrees off, any roll.
    Placed,
    /// Drawn: up to 45 degrees off, any roll.
    Hard,
    /// Exactly here.
    Fixed(FixedPose),
}

/// A pose as a person wrote it.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedPose {
    written: String,
    camera_from_part: RigidTransform,
}

impl SimulatedPose {
    /// Reads six numbers, as [`parse_pose`] does.
    pub fn fixed(written: &str) -> Result<Self, String> {
        Ok(Self::Fixed(FixedPose {
            written: written.to_owned(),
            camera_from_part: parse_pose(written)?.pose,
        }))
    }

    /// What it is drawn from, or the pose itself.
    pub fn placement(&self) -> Result<PoseRange, RigidTransform> {
        match self {
            Self::Facing => Ok(PoseRange::facing()),
            Self::Placed => Ok(PoseRange::placed()),
            Self::Hard => Ok(PoseRange::hard()),
            Self::Fixed(fixed) => Err(fixed.camera_from_part),
        }
    }

    fn name(&self) -> &str {
        match self {
            Self::Facing => "facing",
            Self::Placed => "placed",
            Self::Hard => "hard",
            Self::Fixed(fixed) => &fixed.written,
        }
    }

    fn read(word: &str) -> Result<Self, String> {
        Ok(match word {
            "facing" => Self::Facing,
            "placed" => Self::Placed,
            "hard" => Self::Hard,
            numbers => return Self::fixed(numbers),
        })
    }
}

const CLUTTER: [(&str, Clutter); 3] = [
    ("none", Clutter::None),
    ("on-floor", Clutter::OnFloor),
    ("in-front", Clutter::InFront),
];

const LINE: &str = "line";
const EMPTY: &str = "empty";

impl CellScene {
    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Line { .. } => LINE,
            Self::Part(kind) => kind.name(),
            Self::Object(kind) => kind.name(),
            Self::Empty => EMPTY,
        }
    }

    fn read(what: Option<&str>, every: Option<f64>) -> Option<Self> {
        Some(match what {
            None | Some(LINE) => Self::Line {
                every: every.unwrap_or(EVERY),
            },
            Some(EMPTY) => Self::Empty,
            Some(name) => match PartKind::from_name(name) {
                Some(kind) => Self::Part(kind),
                None => Self::Object(ObjectKind::from_name(name)?),
            },
        })
    }
}

impl SimulatedSpec {
    pub(super) const OPTIONS: &str = "side model pose noise clutter seed fps every";

    /// What a person calls it.
    pub fn title(&self) -> String {
        let hung = match self.scene {
            CellScene::Line { .. } => "the line runs".into(),
            CellScene::Part(kind) if kind.is_sided() => {
                format!("{}, {}", kind.title(), self.side.name())
            }
            CellScene::Part(kind) => kind.title().to_owned(),
            CellScene::Object(kind) => format!("not enrolled, {}", kind.name()),
            CellScene::Empty => "empty".into(),
        };
        format!("Simulated cell, {hung}")
    }

    pub(super) fn read(what: Option<&str>, options: &Options) -> Result<Self, SpecError> {
        let default = Self::default();
        let within = |low: f64, high: f64| {
            move |word: &str| {
                let number = word.parse::<f64>().ok();
                number.filter(|number| (low..=high).contains(number))
            }
        };
        let whole = |word: &str| word.parse::<u64>().ok();
        let every = options.value("every", "seconds, from 4 to 3600", within(4.0, 3600.0))?;
        let clutter = |word: &str| {
            let named = CLUTTER.iter().find(|(name, _)| *name == word);
            named.map(|(_, clutter)| *clutter)
        };
        let scene = CellScene::read(what, every).ok_or_else(|| SpecError::BadValue {
            what: "what hangs in the cell",
            found: what.unwrap_or_default().to_owned(),
            expected: hung_names(),
        })?;
        let pose = options.value("pose", "a pose", |word| Some(word.to_owned()))?;
        let pose = pose.map(|word| {
            SimulatedPose::read(&word).map_err(|expected| SpecError::BadValue {
                what: "pose",
                found: word,
                expected: format!("facing, placed, hard, or six numbers: {expected}"),
            })
        });
        Ok(Self {
            scene,
            side: options
                .value("side", "left or right", Side::from_name)?
                .unwrap_or_default(),
            model: options
                .value("model", "a whole number", whole)?
                .unwrap_or_default(),
            pose: pose.transpose()?.unwrap_or_default(),
            noise: options
                .value("noise", "a number from 0 to 5", within(0.0, 5.0))?
                .unwrap_or(default.noise),
            clutter: options
                .value("clutter", "none, on-floor or in-front", clutter)?
                .unwrap_or_default(),
            seed: options
                .value("seed", "a whole number", whole)?
                .unwrap_or(default.seed),
            frames_per_second: options
                .value(
                    "fps",
                    "frames a second, from 0.1 to 1000",
                    within(0.1, 1000.0),
                )?
                .unwrap_or(default.frames_per_second),
        })
    }

    pub(super) fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let default = Self::default();
        f.write_str(SIMULATED)?;
        if self.side != default.side {
            write!(f, ",side={}", self.side.name())?;
        }
        if self.model != default.model {
            write!(f, ",model={}", self.model)?;
        }
        if self.pose != default.pose {
            write!(f, ",pose={}", super::escaped(self.pose.name()))?;
        }
        if self.noise.to_bits() != default.noise.to_bits() {
            write!(f, ",noise={}", self.noise)?;
        }
        for (name, clutter) in CLUTTER.iter().skip(1) {
            if self.clutter == *clutter {
                write!(f, ",clutter={name}")?;
            }
        }
        if self.seed != default.seed {
            write!(f, ",seed={}", self.seed)?;
        }
        if self.frames_per_second.to_bits() != default.frames_per_second.to_bits() {
            write!(f, ",fps={}", self.frames_per_second)?;
        }
        match self.scene {
            CellScene::Line { every } if every.to_bits() == EVERY.to_bits() => Ok(()),
            CellScene::Line { every } => write!(f, ",every={every}:{LINE}"),
            scene => write!(f, ":{}", scene.name()),
        }
    }
}

/// Everything that can be asked for.
fn hung_names() -> String {
    let parts = PartKind::ALL.map(PartKind::name);
    let objects = ObjectKind::ALL.map(ObjectKind::name);
    [&[LINE, EMPTY], &parts[..], &objects[..]]
        .concat()
        .join(", ")
}
