//! A line: parts hang from a conveyor and pass the camera without a stop, and an encoder counts the way.
//!
//! The camera exposes row after row, so a part that moves is drawn sheared: a frame is put together from bands, each with the
//! parts where they are at its time. The time of a frame is that of its middle row.

use std::f64::consts::TAU;

use nalgebra::{Point3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use super::cell::{Cell, CellSetup, SimulatedObject, is_in_frame};
use super::part::{PartKind, Side};
use super::rasteriser::{Rendering, SurfaceLabel};
use super::sensor::{Sensor, SensorNoise};
use geometry::depth_frame::{DepthFrame, Intrinsics};
use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;
use geometry::units::{Metres, Radians};

/// Everything that determines a line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LineSetup {
    /// Mean speed, m/s.
    pub speed: f64,
    /// Share by which the speed slowly rises and falls, 0 to 0.5.
    pub variation: f64,
    /// Amplitude of the parts that swing from their hooks, along the line.
    pub swing: Radians,
    /// Every so many parts, one swings; 0: none does.
    pub swinging_every: u64,
    /// The encoder of the line.
    pub encoder: LineEncoder,
    /// Time from the exposure of the first row of a frame to that of the last, seconds.
    pub readout: f64,
    /// Seed of the direction of the line, the order of its parts, and how each hangs.
    pub seed: u64,
}

/// An encoder whose wheel runs on the line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LineEncoder {
    /// Way of the line for one count while the wheel does not slip.
    pub way_per_count: Metres,
    /// Greatest share of the way that the wheel loses by slipping, 0 to 0.1. It loses now more, now less.
    pub slip: f64,
}

impl Default for LineSetup {
    fn default() -> Self {
        Self {
            speed: 0.1,
            variation: 0.0,
            swing: Radians(0.05),
            swinging_every: 0,
            encoder: LineEncoder {
                way_per_count: Metres(0.0001),
                slip: 0.0,
            },
            readout: 0.01,
            seed: 1,
        }
    }
}

/// Time in which the speed rises and falls once, seconds.
const VARIATION_PERIOD_S: f64 = 15.0;
/// Way over which the slip of the wheel rises and falls once, metres.
const SLIP_PERIOD_M: f64 = 1.7;
/// Time of one swing, seconds: a pendulum of 0.9 m.
const SWING_PERIOD_S: f64 = 1.9;
/// Height of the hook above the part's middle, metres.
const HOOK_HEIGHT_M: f64 = 0.8;
/// Clear gap between neighbours, metres.
const GAP_M: (f64, f64) = (0.3, 0.7);
/// Way on which the widest part is wholly in the picture, metres.
const CLEAR_WAY_M: f64 = 0.75;
/// Greatest angles of the line to the rows of the picture, in the picture and to the camera, degrees.
const LINE_TILT_DEG: [f64; 2] = [3.0, 8.0];
/// Greatest angle about each axis by which a part hangs off the square, degrees.
const PART_TILT_DEG: f64 = 8.0;
/// Distance by which a part hangs higher or lower, nearer or farther, metres.
const PART_SHIFT_M: f64 = 0.04;
/// Distance of the wall and depth of the floor, metres: behind and below every part.
const SURROUNDINGS_M: (f64, f64) = (2.9, 1.4);
/// Number of bands that a frame is put together from.
const NUM_BANDS: usize = 4;
/// Separates the line's random numbers from others with the same seed.
const STREAM: u64 = 0x11e0_11e0_11e0_11e0;

/// A part of the line at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePart {
    /// Its number on the line, from 0.
    pub number: u64,
    /// Its kind.
    pub kind: PartKind,
    /// From the model's coordinates to the camera's.
    pub camera_from_part: RigidTransform,
    /// True if the whole part lies within the picture.
    pub fully_visible: bool,
    /// True if it swings.
    pub swings: bool,
}

/// A line that runs: the parts at every time, and the frames of the camera.
pub struct SimulatedLine {
    setup: LineSetup,
    intrinsics: Intrinsics,
    direction: Unit<Vector3<f64>>,
    /// The kinds in the order in which they pass, again and again, each with its mesh and its distance from the first.
    cycle: Vec<(PartKind, TriangleMesh, f64)>,
    /// Length of the cycle, metres.
    length: f64,
    /// Distance of the first part from the middle of the picture at the start, metres.
    lead: f64,
    /// Depth at which the parts pass, metres.
    depth: f64,
    /// Everything but the parts.
    backdrop: Rendering,
    sensor: Box<dyn Sensor>,
}

impl SimulatedLine {
    /// Arranges the line. At the start, the first part is still outside the picture.
    pub fn arrange(setup: &LineSetup) -> Self {
        let mut random = Pcg64::seed_from_u64(setup.seed ^ STREAM);
        let intrinsics = Intrinsics::KINECT;
        let mut kinds = PartKind::ALL.to_vec();
        kinds.shuffle(&mut random);
        let (mut cycle, mut end, mut widest) = (Vec::new(), 0.0, 0.0_f64);
        for kind in kinds {
            let subject = SimulatedObject::Part {
                kind,
                side: Side::Left,
                model_seed: 0,
            };
            let mesh = subject.mesh();
            let half = half_width(&mesh);
            widest = widest.max(2.0 * half);
            cycle.push((kind, mesh, end + half));
            end += 2.0 * half + random.random_range(GAP_M.0..GAP_M.1);
        }
        let first = cycle[0].2;
        for (_, _, at) in &mut cycle {
            *at -= first;
        }
        let view = intrinsics.width as f64 / intrinsics.fx;
        let depth = (widest + CLEAR_WAY_M) / view;
        let [slope, yaw] = LINE_TILT_DEG.map(|limit| random.random_range(-limit..limit));
        let turned = Rotation3::from_axis_angle(&Vector3::y_axis(), yaw.to_radians())
            * Rotation3::from_axis_angle(&Vector3::z_axis(), slope.to_radians());
        let along = if random.random::<bool>() { 1.0 } else { -1.0 };
        let direction = Unit::new_normalize(turned * Vector3::new(along, 0.0, 0.0));
        let mut cell = CellSetup::new(SimulatedObject::Nothing, setup.seed);
        (cell.wall, cell.floor) = (Metres(SURROUNDINGS_M.0), Metres(SURROUNDINGS_M.1));
        let nothing = TriangleMesh::default();
        let cell = Cell::arrange(&cell, &nothing);
        let mut backdrop = Rendering::new(intrinsics);
        cell.draw_rest(&mut backdrop);
        let sensor = cell.sensor;
        Self {
            setup: *setup,
            intrinsics,
            direction,
            cycle,
            length: end,
            lead: 0.5 * (view * depth + widest) + 0.3,
            depth,
            backdrop,
            sensor,
        }
    }

    /// The direction of the line, camera space.
    pub fn direction(&self) -> Unit<Vector3<f64>> {
        self.direction
    }

    /// The way of the line from the start until then, metres.
    pub fn way(&self, seconds: f64) -> f64 {
        let LineSetup {
            speed, variation, ..
        } = self.setup;
        let varied = VARIATION_PERIOD_S / TAU * (1.0 - (TAU * seconds / VARIATION_PERIOD_S).cos());
        speed * (seconds + variation * varied)
    }

    /// The time at which the line has come so far, seconds: the inverse of [`way`](Self::way).
    pub fn seconds_at(&self, way: f64) -> f64 {
        let spread = self.setup.variation * VARIATION_PERIOD_S;
        let (mut low, mut high) = (
            way / self.setup.speed - spread,
            way / self.setup.speed + spread,
        );
        // The way grows with the time; 60 halvings resolve it to the last digit.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.way(middle) < way {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// What the encoder has counted until then.
    pub fn count(&self, seconds: f64) -> i64 {
        let LineEncoder {
            way_per_count,
            slip,
        } = self.setup.encoder;
        let way = self.way(seconds);
        let turns = SLIP_PERIOD_M / TAU * (TAU * way / SLIP_PERIOD_M).sin();
        let lost = 0.5 * slip * (way - turns);
        ((way - lost) / way_per_count.0).floor() as i64
    }

    /// The parts that are in the picture then, wholly or not, those in front first.
    pub fn parts(&self, seconds: f64) -> Vec<LinePart> {
        let way = self.way(seconds);
        let num = self.cycle.len() as u64;
        let past = ((way - 2.0 * self.lead - self.length) / self.length).max(0.0) as u64;
        let mut parts = Vec::new();
        for number in past * num.. {
            let (kind, mesh, _) = &self.cycle[(number % num) as usize];
            let from_middle = way - self.way_to(number);
            if from_middle < -self.lead {
                break;
            }
            if from_middle > self.lead {
                continue;
            }
            let camera_from_part = self.pose(number, from_middle, seconds);
            parts.push(LinePart {
                number,
                kind: *kind,
                camera_from_part,
                fully_visible: is_in_frame(mesh, &camera_from_part, &self.intrinsics),
                swings: self.swings(number),
            });
        }
        parts
    }

    /// The pose of a part at a time at which it is in the picture or not.
    pub fn pose_of(&self, number: u64, seconds: f64) -> RigidTransform {
        self.pose(number, self.way(seconds) - self.way_to(number), seconds)
    }

    /// The pose of a part that is so far behind the middle of the picture.
    fn pose(&self, number: u64, from_middle: f64, seconds: f64) -> RigidTransform {
        let mut random = Pcg64::seed_from_u64(self.setup.seed ^ STREAM ^ (number + 1));
        let mut within = |limit: f64| random.random_range(-limit..limit);
        let [x, y, z] = std::array::from_fn(|_| within(PART_TILT_DEG).to_radians());
        let hung = Point3::new(0.0, within(PART_SHIFT_M), self.depth + within(PART_SHIFT_M));
        let phase = within(0.5 * TAU);
        let middle = hung + self.direction.into_inner() * from_middle;
        let swing = if self.swings(number) {
            self.setup.swing.0 * (TAU * seconds / SWING_PERIOD_S + phase).sin()
        } else {
            0.0
        };
        let hook = middle - Vector3::y() * HOOK_HEIGHT_M;
        Translation3::from(hook.coords)
            * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), swing)
            * Translation3::new(0.0, HOOK_HEIGHT_M, 0.0)
            * UnitQuaternion::from_euler_angles(x, y, z)
    }

    /// The kind of a part.
    pub fn kind_of(&self, number: u64) -> PartKind {
        self.cycle[(number % self.cycle.len() as u64) as usize].0
    }

    /// The way of the line at which a part passes the middle of the picture, metres.
    pub fn way_to(&self, number: u64) -> f64 {
        let num = self.cycle.len() as u64;
        let at = self.cycle[(number % num) as usize].2;
        self.lead + at + (number / num) as f64 * self.length
    }

    /// Whether a part swings.
    pub fn swings(&self, number: u64) -> bool {
        let every = self.setup.swinging_every;
        every > 0 && number % every == every - 1
    }

    /// Takes a frame whose middle row is exposed at this time.
    pub fn frame(&self, seconds: f64, noise: &SensorNoise) -> DepthFrame {
        let height = self.intrinsics.height;
        let mut rendering = Rendering::new(self.intrinsics);
        let num_bands = if self.setup.readout > 0.0 {
            NUM_BANDS
        } else {
            1
        };
        for band in 0..num_bands {
            let share = (band as f64 + 0.5) / num_bands as f64 - 0.5;
            rendering.rows = band * height / num_bands..(band + 1) * height / num_bands;
            self.draw_parts(&mut rendering, seconds + share * self.setup.readout);
        }
        rendering.draw_behind(&self.backdrop);
        self.sensor.sense(&rendering, noise)
    }

    /// Draws the parts as they are at this time.
    fn draw_parts(&self, rendering: &mut Rendering, seconds: f64) {
        for part in self.parts(seconds) {
            let (_, mesh, _) = &self.cycle[(part.number % self.cycle.len() as u64) as usize];
            rendering.draw_mesh(mesh, &part.camera_from_part, SurfaceLabel::Part);
        }
    }
}

/// Half the width of a part that hangs square to the camera.
fn half_width(mesh: &TriangleMesh) -> f64 {
    let reach = mesh.vertices.iter().map(|p| f64::from(p.x.abs()));
    reach.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(change: impl FnOnce(&mut LineSetup)) -> SimulatedLine {
        let mut setup = LineSetup::default();
        change(&mut setup);
        SimulatedLine::arrange(&setup)
    }

    #[test]
    fn parts_pass_one_behind_the_other_and_each_is_wholly_in_the_picture_for_a_while() {
        let line = line(|setup| setup.speed = 0.2);
        assert!(line.parts(0.0).iter().all(|part| !part.fully_visible));
        let mut clear = [0_u32; 9];
        let mut before: Vec<LinePart> = Vec::new();
        for tenth in 0..1000 {
            let seconds = f64::from(tenth) / 10.0;
            let parts = line.parts(seconds);
            for part in &parts {
                if let Some(clear) = clear.get_mut(part.number as usize) {
                    *clear += u32::from(part.fully_visible);
                }
                let same = before.iter().find(|other| other.number == part.number);
                let Some(same) = same else { continue };
                let moved = part.camera_from_part.translation.vector
                    - same.camera_from_part.translation.vector;
                let along = moved.dot(&line.direction());
                assert!((along - 0.02).abs() < 1e-9 && (moved.norm() - along).abs() < 1e-9);
                assert_eq!(part.kind, same.kind);
                assert_eq!(line.pose_of(part.number, seconds), part.camera_from_part);
            }
            before = parts;
        }
        // At least 0.5 m at 20 mm each.
        assert!(clear.iter().all(|num| *num >= 25), "{clear:?}");
    }

    #[test]
    fn the_encoder_counts_the_way_and_loses_as_much_as_it_slips() {
        let even = line(|setup| setup.variation = 0.2);
        let slipping = line(|setup| {
            setup.variation = 0.2;
            setup.encoder.slip = 0.02;
        });
        for seconds in [0.0, 3.3, 20.0, 71.0] {
            let way = even.way(seconds);
            assert!((even.count(seconds) as f64 * 1e-4 - way).abs() < 1.1e-4);
            assert!((even.seconds_at(way) - seconds).abs() < 1e-6);
            let lost = way - slipping.count(seconds) as f64 * 1e-4;
            assert!(
                (-1e-4..0.02 * way + 2e-4).contains(&lost),
                "{lost} of {way}"
            );
        }
        let (slow, fast) = (
            even.way(12.0) - even.way(11.0),
            even.way(4.0) - even.way(3.0),
        );
        assert!(fast > 1.2 * slow, "{fast} and {slow} m/s");
    }

    #[test]
    fn a_part_that_swings_leaves_its_place_on_the_line_and_the_others_do_not() {
        let line = line(|setup| setup.swinging_every = 2);
        let off = |number: u64| {
            let mut most = 0.0_f64;
            for k in 0..40 {
                let seconds = 20.0 + f64::from(k) / 20.0;
                let (here, start) = (line.pose_of(number, seconds), line.pose_of(number, 20.0));
                let way = line.way(seconds) - line.way(20.0);
                let carried = start.translation.vector + line.direction().into_inner() * way;
                most = most.max((here.translation.vector - carried).norm());
            }
            most
        };
        assert!(off(0) < 1e-9 && off(2) < 1e-9);
        assert!(off(1) > 0.03, "{}", off(1));
    }

    #[test]
    fn a_frame_is_sheared_by_the_time_between_its_rows() {
        let count = |readout: f64| {
            let line = line(|setup| (setup.speed, setup.readout) = (0.3, readout));
            let seconds = line.seconds_at(line.lead);
            line.frame(seconds, &SensorNoise::none())
        };
        let (at_once, again, sheared) = (count(0.0), count(0.0), count(0.03));
        assert!(at_once == again);
        let changed = at_once.depth.iter().zip(&sheared.depth);
        let num = changed.filter(|(a, b)| a.abs_diff(**b) > 500).count();
        assert!(num > 100, "{num} pixels along the outline");
    }
}
