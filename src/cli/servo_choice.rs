//! What servoing needs to know besides the part, as options of `servo` and `serve`.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use clap::Args;

use super::{
    calibrate::cell_calibration,
    console::{Advised as _, Console, with_advice},
    input::{Choice, choice, from_to, open_scene, parse_nozzle_pose, warn_of, within},
    program::CellChoice,
};
use geometry::{
    oriented_box::OrientedBox,
    units::{Metres, Radians},
};
use robot::{
    WrittenPose,
    arm::{Arm, PlacedArm},
    program::ProgramParams,
};
use servo::{ServoParams, simulated::HandEyeError};
use station::servoing::{ServoSetup, ServoTarget, SimulatedTrial};

/// Where the part should be, and what the robot is kept clear of.
#[derive(Debug, Args)]
pub(super) struct ServoChoice {
    /// Where the part should be; default: at its standard position
    #[arg(long, value_parser = choice(&TARGETS), conflicts_with = "seen_as")]
    target: Option<NamedTarget>,
    /// Frames of the part, taken where the camera should stand, instead of its standard position; may be given several times
    #[arg(long, value_name = "FILE")]
    seen_as: Vec<PathBuf>,
    /// The arm, which is then kept within its reach and clear of part and obstacles: a name, or a TOML file
    #[arg(long, value_name = "ARM", requires = "nozzle")]
    arm: Option<String>,
    /// Pose of the nozzle on the flange, as `kuka X Y Z A B C`, or the 16 numbers of a matrix: it is kept clear of the part
    #[arg(long, value_name = "POSE", value_parser = parse_nozzle_pose, allow_hyphen_values = true)]
    nozzle: Option<WrittenPose>,
    #[command(flatten)]
    cell: CellChoice,
    #[arg(
        long, value_name = "MM",
        help = format!("Least distance from part and obstacles, mm ({})", from_to(&ServoParams::CLEARANCES_MM)),
        default_value_t = ServoParams::default().clearance.mm(),
        value_parser = |text: &str| within(text, &ServoParams::CLEARANCES_MM),
    )]
    clearance: f64,
    /// Box of the base frame that flange, camera and nozzle never leave: two opposite corners, mm
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = parse_volume, allow_hyphen_values = true)]
    volume: Option<OrientedBox>,
    #[arg(
        long, value_name = "MM",
        help = format!("Greatest error at the end with its bounds, mm ({})", from_to(&ServoParams::TOLERANCES_MM)),
        default_value_t = ServoParams::default().tolerance.shift.mm(),
        value_parser = |text: &str| within(text, &ServoParams::TOLERANCES_MM),
    )]
    tolerance: f64,
}

#[derive(Clone, Copy, Debug)]
enum NamedTarget {
    StandardPosition,
    PathStart,
}

#[rustfmt::skip]
const TARGETS: [Choice<NamedTarget>; 2] = [
    ("standard-position", "The camera where it was when the part was enrolled", NamedTarget::StandardPosition),
    ("path-start", "The nozzle at the first point of the part's spray path; needs --nozzle, and a calibration from pairs", NamedTarget::PathStart),
];

/// A simulated robot that is tried, from a start that is drawn.
#[derive(Debug, Args)]
pub(super) struct TrialChoice {
    /// Seed of the simulated start
    #[arg(long, value_name = "N", default_value_t = SimulatedTrial::default().seed, requires = "simulated", conflicts_with = "source")]
    seed: u64,
    #[command(flatten)]
    robot: SimulatedRobotChoice,
}

/// How a simulated robot moves, and how its camera is calibrated. The commands that have it call the option that asks for the
/// robot `simulated`.
#[derive(Debug, Args)]
#[group(id = "trial", requires = "simulated")]
pub(super) struct SimulatedRobotChoice {
    #[arg(
        long, value_name = "MS",
        help = format!("How much later than it was taken a simulated frame counts, at least, ms ({})", from_to(&SimulatedTrial::DELAYS_MS)),
        default_value_t = 1000.0 * SimulatedTrial::default().delay.as_secs_f64(),
        value_parser = |text: &str| within(text, &SimulatedTrial::DELAYS_MS),
    )]
    delay: f64,
    #[arg(
        long, value_name = "MM,DEG", value_parser = parse_hand_eye,
        help = format!("By how much the calibration of the simulated camera is wrong at most: mm and degrees; default: {}", default_hand_eye()),
    )]
    hand_eye: Option<HandEyeError>,
    #[arg(
        long, value_name = "DEG",
        help = format!("Play of each joint of the simulated arm, degrees ({}); default: {}", from_to(&SimulatedTrial::PLAYS_DEG), rounded(SimulatedTrial::default().play.degrees())),
        value_parser = |text: &str| within(text, &SimulatedTrial::PLAYS_DEG),
    )]
    backlash: Option<f64>,
    #[arg(
        long, value_name = "MS",
        help = format!("Time between two reports of the simulated arm, ms ({})", from_to(&SimulatedTrial::CYCLES_MS)),
        default_value_t = 1000.0 * SimulatedTrial::default().cycle.as_secs_f64(),
        value_parser = |text: &str| within(text, &SimulatedTrial::CYCLES_MS),
    )]
    cycle: f64,
}

/// The default error of the calibration, as it is given.
fn default_hand_eye() -> String {
    let HandEyeError { shift, turn } = SimulatedTrial::default().hand_eye;
    format!("{},{}", rounded(shift.mm()), rounded(turn.degrees()))
}

/// To three decimals: a default that is converted ends in many.
fn rounded(number: f64) -> f64 {
    (1000.0 * number).round() / 1000.0
}

fn parse_hand_eye(text: &str) -> Result<HandEyeError, String> {
    let (shifts, turns) = (SimulatedTrial::SHIFTS_MM, SimulatedTrial::TURNS_DEG);
    let numbers = text
        .split_once(',')
        .and_then(|(shift, turn)| Some((within(shift, &shifts).ok()?, within(turn, &turns).ok()?)));
    let (shift, turn) = numbers.ok_or_else(|| {
        let (shifts, turns) = (from_to(&shifts), from_to(&turns));
        let example = default_hand_eye();
        format!("expected MM,DEG: {shifts} mm and {turns} degrees, such as {example}")
    })?;
    Ok(HandEyeError {
        shift: Metres::from_mm(shift),
        turn: Radians::from_degrees(turn),
    })
}

impl TrialChoice {
    pub(super) fn trial(&self) -> SimulatedTrial {
        self.robot.trial(self.seed)
    }

    /// Says what is simulated.
    pub(super) fn announce(&self, console: &Console) {
        self.robot.announce(console);
    }
}

impl SimulatedRobotChoice {
    pub(super) fn trial(&self, seed: u64) -> SimulatedTrial {
        let default = SimulatedTrial::default();
        SimulatedTrial {
            seed,
            delay: Duration::from_secs_f64(self.delay / 1000.0),
            hand_eye: self.hand_eye.unwrap_or(default.hand_eye),
            play: self.backlash.map_or(default.play, Radians::from_degrees),
            cycle: Duration::from_secs_f64(self.cycle / 1000.0),
        }
    }

    /// Says what is simulated.
    pub(super) fn announce(&self, console: &Console) {
        let HandEyeError { shift, turn } = self.trial(0).hand_eye;
        let (mm, degrees) = (shift.mm(), turn.degrees());
        console.note(&format_args!(
            "Simulated: an arm carries the camera; its calibration is wrong by up to {mm:.1} mm and {degrees:.1}°"
        ));
    }
}

fn parse_volume(text: &str) -> Result<OrientedBox, String> {
    let numbers = text.split([',', ' ']).filter(|number| !number.is_empty());
    let numbers: Option<Vec<f64>> = numbers.map(|number| number.parse().ok()).collect();
    let Some([a, b, c, d, e, f]) = numbers.and_then(|numbers| <[f64; 6]>::try_from(numbers).ok())
    else {
        return Err("expected X,Y,Z,X,Y,Z: two opposite corners, mm".into());
    };
    let sides = [[a, d], [b, e], [c, f]];
    let centre = sides.map(|[from, to]| f64::midpoint(from, to));
    let size = sides.map(|[from, to]| (to - from).abs());
    OrientedBox::of_file("volume", centre, size, [0.0; 3]).map_err(|error| with_advice(&error))
}

impl ServoChoice {
    /// Reads the files that the options name.
    pub(super) fn setup(
        &self,
        calibration: Option<&Path>,
        console: &Console,
    ) -> anyhow::Result<ServoSetup> {
        let calibration = cell_calibration(calibration)?;
        Ok(ServoSetup {
            camera: calibration.camera,
            calibration: calibration.bounds(),
            target: self.target(console)?,
            flange_from_nozzle: self.nozzle.as_ref().map(|nozzle| nozzle.pose),
            placed: self.placed()?,
            volume: self.volume,
            params: self.default_params()?,
        })
    }

    /// The parameters with the default speed.
    pub(super) fn default_params(&self) -> anyhow::Result<ServoParams> {
        self.params(1000.0 * ServoParams::default().limits.speed)
    }

    /// The parameters with this speed.
    pub(super) fn params(&self, speed_mm_s: f64) -> anyhow::Result<ServoParams> {
        let tolerance = Metres::from_mm(self.tolerance);
        ServoParams::limited(speed_mm_s, tolerance, Metres::from_mm(self.clearance)).advised()
    }

    fn placed(&self) -> anyhow::Result<Option<PlacedArm>> {
        let (Some(arm), Some(nozzle)) = (&self.arm, &self.nozzle) else {
            return Ok(None);
        };
        let arm = Arm::named(arm).advised()?;
        let placed = (self.cell).place(arm, nozzle.pose, &ProgramParams::default());
        placed.map(Some)
    }

    pub(super) fn target(&self, console: &Console) -> anyhow::Result<ServoTarget> {
        if self.seen_as.is_empty() {
            return Ok(match self.target {
                Some(NamedTarget::PathStart) => ServoTarget::PathStart,
                Some(NamedTarget::StandardPosition) | None => ServoTarget::StandardPosition,
            });
        }
        let scenes = self.seen_as.iter().map(|path| {
            let (scene, warnings) = open_scene(path).advised()?;
            warn_of(path, &warnings, console);
            Ok((path.display().to_string(), scene))
        });
        let scenes: anyhow::Result<Vec<_>> = scenes.collect();
        Ok(ServoTarget::SeenAs(scenes?))
    }
}
