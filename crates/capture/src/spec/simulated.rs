//! The options of the simulated cell.

use std::fmt;

use super::{SIMULATED, SpecError, options::Options};
use geometry::{rigid::RigidTransform, written_pose::parse_pose};
use simulate::{Clutter, ObjectKind, PartKind, PoseRange, Side};

/// Settings of the simulated cell.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedSpec {
    /// What hangs in the cell.
    pub scene: CellScene,
    /// The side of the car, for parts that have one.
    pub side: Side,
    /// The car model; 0 is the standard car.
    pub model: u64,
    /// Pose of the part.
    pub pose: SimulatedPose,
    /// Noise of the camera, 0 to 5; 1 is that of a Kinect, 0 none.
    pub noise: f64,
    /// Other objects in the cell.
    pub clutter: Clutter,
    /// Seed of everything random.
    pub seed: u64,
    /// Frames per second; 0.1 to 1000.
    pub frames_per_second: f64,
}

impl Default for SimulatedSpec {
    fn default() -> Self {
        Self {
            scene: CellScene::Line {
                every: DEFAULT_INTERVAL_S,
            },
            side: Side::Left,
            model: 0,
            pose: SimulatedPose::Facing,
            noise: 1.0,
            clutter: Clutter::None,
            seed: 1,
            frames_per_second: DEFAULT_FPS,
        }
    }
}

/// What hangs in the simulated cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellScene {
    /// A conveyor line: the eight parts swing in one after the other, hang still, and swing out.
    Line {
        /// Seconds from one part to the next; 4 to 3600.
        every: f64,
    },
    /// A conveyor line with racks of [`NUM_ON_RACK`] different parts, which swing in one after the other, hang still, and swing
    /// out. The parts are of the left side, and the racks hang with care.
    Rack {
        /// Seconds from one rack to the next; 4 to 3600.
        every: f64,
    },
    /// A conveyor line that runs without a stop: the eight parts pass one behind the other.
    Conveyor {
        /// Speed, m/s; 0.005 to 1.
        speed: f64,
    },
    /// One part, hanging still.
    Part(PartKind),
    /// An object that is not an enrolled part, hanging still.
    Object(ObjectKind),
    /// Nothing.
    Empty,
}

/// Parts on each rack of the line.
pub const NUM_ON_RACK: usize = 3;
/// Default time from one part or rack of the line to the next, seconds.
const DEFAULT_INTERVAL_S: f64 = 8.0;
/// Default speed of the line that runs without a stop, m/s.
const DEFAULT_SPEED_M_S: f64 = 0.1;
/// Frame rate of a Kinect.
const DEFAULT_FPS: f64 = 30.0;

/// Pose of a part in the simulated cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SimulatedPose {
    /// Random: carefully hung, up to 10 degrees off.
    #[default]
    Facing,
    /// Random: up to 30 degrees off, any roll.
    Placed,
    /// Random: up to 45 degrees off, any roll.
    Hard,
    /// This pose exactly.
    Fixed(FixedPose),
}

/// A pose as a person wrote it.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedPose {
    written: String,
    camera_from_part: RigidTransform,
}

impl SimulatedPose {
    /// Parses six numbers, like [`parse_pose`].
    pub fn fixed(written: &str) -> Result<Self, String> {
        Ok(Self::Fixed(FixedPose {
            written: written.to_owned(),
            camera_from_part: parse_pose(written)?.pose,
        }))
    }

    /// The range from which the pose is drawn; the error is the fixed pose.
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
const RACK: &str = "rack";
const CONVEYOR: &str = "conveyor";
const EMPTY: &str = "empty";

impl CellScene {
    /// The name in a specification.
    pub fn name(self) -> &'static str {
        match self {
            Self::Line { .. } => LINE,
            Self::Rack { .. } => RACK,
            Self::Conveyor { .. } => CONVEYOR,
            Self::Part(kind) => kind.name(),
            Self::Object(kind) => kind.name(),
            Self::Empty => EMPTY,
        }
    }

    fn read(what: Option<&str>, every: Option<f64>, speed: Option<f64>) -> Option<Self> {
        let every = every.unwrap_or(DEFAULT_INTERVAL_S);
        let speed = speed.unwrap_or(DEFAULT_SPEED_M_S);
        Some(match what {
            None | Some(LINE) => Self::Line { every },
            Some(RACK) => Self::Rack { every },
            Some(CONVEYOR) => Self::Conveyor { speed },
            Some(EMPTY) => Self::Empty,
            Some(name) => match PartKind::from_name(name) {
                Some(kind) => Self::Part(kind),
                None => Self::Object(ObjectKind::from_name(name)?),
            },
        })
    }
}

impl SimulatedSpec {
    pub(super) const OPTIONS: &str = "side model pose noise clutter seed fps every speed";

    /// Title to show to the operator.
    pub fn title(&self) -> String {
        let hung = match self.scene {
            CellScene::Line { .. } => "the line runs".into(),
            CellScene::Rack { .. } => "the line runs, with racks".into(),
            CellScene::Conveyor { speed } => {
                format!("the line runs without a stop at {:.0} mm/s", 1000.0 * speed)
            }
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
        let speed = options.value("speed", "mm/s, from 5 to 1000", within(5.0, 1000.0))?;
        let speed = speed.map(|speed| speed / 1000.0);
        let clutter = |word: &str| {
            let named = CLUTTER.iter().find(|(name, _)| *name == word);
            named.map(|(_, clutter)| *clutter)
        };
        let scene = CellScene::read(what, every, speed).ok_or_else(|| SpecError::BadValue {
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
        let is_default = |every: f64| every.to_bits() == DEFAULT_INTERVAL_S.to_bits();
        match self.scene {
            CellScene::Line { every } if is_default(every) => Ok(()),
            CellScene::Line { every } | CellScene::Rack { every } if !is_default(every) => {
                write!(f, ",every={every}:{}", self.scene.name())
            }
            CellScene::Conveyor { speed } if speed.to_bits() != DEFAULT_SPEED_M_S.to_bits() => {
                write!(f, ",speed={}:{CONVEYOR}", 1000.0 * speed)
            }
            scene => write!(f, ":{}", scene.name()),
        }
    }
}

/// All names of a scene.
fn hung_names() -> String {
    let parts = PartKind::ALL.map(PartKind::name);
    let objects = ObjectKind::ALL.map(ObjectKind::name);
    [&[LINE, RACK, CONVEYOR, EMPTY], &parts[..], &objects[..]]
        .concat()
        .join(", ")
}
