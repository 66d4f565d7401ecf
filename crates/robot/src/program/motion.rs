//! The motion of a program as its controller runs it: where the nozzle is, how long it takes, and whether the gun sprays.
//!
//! A blend cuts its corner along a parabola between two points at the blend's radius from it. Along this way the speed
//! is as high as each move allows, and changes no faster than the program's acceleration. It is zero where the robot
//! stops; in a blend the acceleration also limits it on the parabola's tightest curve. The gun switches where the
//! language switches it ([`RobotLanguage::switches_at`]).
//!
//! Known limits: LS and JBI name no radius of a blend, and their accelerations are those of the arm; the blends and the
//! acceleration of the other languages are assumed. Turns of the nozzle, jerk and the delay of valves are ignored, as
//! are the stops between the parts of a split program, where the gun is off.

use super::{
    Program, ProgramError, RobotLanguage,
    language::{Line, Motion, Step},
    steps::steps_of,
};
use geometry::rigid::RigidTransform;

/// A short straight way of the nozzle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionPiece {
    /// Index of the last point of the path that was passed; `None` on the way to the first.
    pub point: Option<usize>,
    /// Pose of the nozzle at both ends, in the robot's base frame.
    pub robot_from_nozzle: [RigidTransform; 2],
    /// True if the gun sprays.
    pub is_gun_on: bool,
    /// True if the robot stops before it.
    pub is_from_stop: bool,
    /// Duration, seconds.
    pub seconds: f64,
}

impl MotionPiece {
    /// Length, metres.
    pub fn length(&self) -> f64 {
        let [from, to] = self.robot_from_nozzle.map(|pose| pose.translation.vector);
        (to - from).norm()
    }
}

/// Longest piece, metres: short compared with a jet, within which the speed may change.
const MAX_PIECE_LENGTH_M: f64 = 0.004;
/// Fewest pieces of a way: a single one from stop to stop would never end.
const MIN_PIECES: f64 = 2.0;
/// Shares of a blend at which its pieces meet.
const BLEND_SHARES: [f64; 3] = [0.25, 0.5, 0.75];

/// Rounds in which the speeds of moves are found.
const NUM_ROUNDS: usize = 8;

impl Program<'_> {
    /// Returns the motion along the linear moves of the program in this language. Joint moves, with the gun off, are left
    /// out: their duration depends on the arm.
    pub fn motion(
        &self,
        language: &'static RobotLanguage,
    ) -> Result<Vec<MotionPiece>, ProgramError> {
        self.check_path(language)?;
        let steps = self.steps(language);
        Ok(pieces_of(&steps, language, self.line_acceleration()))
    }

    /// The steps of the program. If the path's acceleration is known, the speeds with the gun on are those at which the
    /// moves take about the planned time: a robot changes its speed within the faster of two moves, while a path is planned
    /// with half of the change on either side of the point.
    pub(super) fn steps(&self, language: &RobotLanguage) -> Vec<Step> {
        let mut steps = steps_of(self, language);
        if let Some(acceleration) = self.acceleration {
            keep_times(&mut steps, language, acceleration);
        }
        steps
    }
}

/// Raises the speeds with the gun on until each move takes its planned time together with its two neighbours, which
/// paint much of the same surface, or until it would be faster than planned half-way to a neighbour.
fn keep_times(steps: &mut [Step], language: &RobotLanguage, acceleration: f64) {
    let [_, fastest] = language.speeds;
    let speed_to = |step: &Step| line_to(step).map(|line| line.speed);
    let planned: Vec<Option<f64>> = steps.iter().map(speed_to).collect();
    let squared = |step: usize| Some(planned.get(step).copied()??.powi(2));
    for _ in 0..NUM_ROUNDS {
        // Seconds of each move with the gun on: as planned, and as the robot moves.
        let mut seconds = vec![[0.0; 2]; steps.len()];
        for piece in pieces_of(steps, language, acceleration) {
            let step = piece.point.map_or(1, |point| point + 2);
            if let (true, Some(speed)) = (piece.is_gun_on, planned[step]) {
                seconds[step][0] += piece.length() / speed;
                seconds[step][1] += piece.seconds;
            }
        }
        for i in 1..steps.len() - 1 {
            let around = &seconds[i - 1..=i + 1];
            let [wanted, found] = [0, 1].map(|which| around.iter().map(|s| s[which]).sum::<f64>());
            let is_on = seconds[i][0] > 0.0;
            if let (true, Some(own), Motion::Line(line)) = (is_on, squared(i), &mut steps[i].motion)
            {
                let neighbours = [i - 1, i + 1].map(|other| squared(other).unwrap_or(own));
                let half_way = neighbours.map(|other| f64::midpoint(own, other));
                let most = half_way.into_iter().fold(own, f64::max).sqrt();
                let most = most.min(fastest).max(own.sqrt());
                line.speed = (line.speed * found / wanted).clamp(own.sqrt(), most);
            }
        }
    }
}

/// The motion along the linear moves of these steps.
fn pieces_of(steps: &[Step], language: &RobotLanguage, acceleration: f64) -> Vec<MotionPiece> {
    let (mut pieces, mut is_on) = (Vec::new(), false);
    // The robot stops before and after a joint move.
    let is_joint_move = |step: &Step| matches!(step.motion, Motion::Joints(_));
    let mut first = 0;
    while first < steps.len() {
        let others = steps[first + 1..].iter();
        let num = others.take_while(|step| !is_joint_move(step)).count();
        is_on = steps[first].gun().unwrap_or(is_on);
        let mut run = Run::new(language, acceleration, is_on);
        for step in first + 1..=first + num {
            run.add_move(steps, step);
        }
        is_on = run.is_on;
        pieces.extend(run.pieces());
        first += num + 1;
    }
    pieces
}

/// A pose that the nozzle passes, and what holds from there to the next.
struct Node {
    at: RigidTransform,
    /// Speed limit here, m/s.
    limit: f64,
    /// Speed of the move from here to the next node, m/s.
    speed: f64,
    is_on: bool,
    point: Option<usize>,
}

/// Linear moves without a joint move in between.
struct Run {
    /// Where in a blend the gun switches.
    switches_at: f64,
    acceleration: f64,
    is_on: bool,
    nodes: Vec<Node>,
    /// Pose at the end of the last move.
    end: Option<RigidTransform>,
}

impl Run {
    fn new(language: &RobotLanguage, acceleration: f64, is_on: bool) -> Self {
        Self {
            switches_at: language.switches_at,
            acceleration,
            is_on,
            nodes: Vec::new(),
            end: None,
        }
    }

    /// Adds the start of a piece of the move to a step.
    fn add(&mut self, at: RigidTransform, limit: f64, line: &Line, step: usize) {
        self.nodes.push(Node {
            at,
            limit,
            speed: line.speed,
            is_on: self.is_on,
            // Before the points of the path there is the approach point.
            point: step.checked_sub(2),
        });
    }

    /// Adds the linear move to a step, and the blend at its end.
    fn add_move(&mut self, steps: &[Step], step: usize) {
        let (from, to) = (&steps[step - 1], &steps[step]);
        let Some(line) = line_to(to) else { return };
        let way = Way::new(&from.to, &to.to);
        let begin = line_to(from).map_or(0.0, |line| line.blend);
        let straight = (way.length - begin - line.blend).max(0.0);
        let num = (straight / MAX_PIECE_LENGTH_M).ceil().max(MIN_PIECES);
        for k in 0..num as usize {
            let is_stop = k == 0 && begin <= 0.0;
            let limit = if is_stop { 0.0 } else { f64::INFINITY };
            let at = way.at(begin + straight * k as f64 / num);
            self.add(at, limit, &line, step);
        }
        self.end = Some(to.to);
        let blended = steps.get(step + 1).filter(|_| line.blend > 0.0);
        if let Some((next, onwards)) = blended.and_then(|next| Some((next, line_to(next)?))) {
            let ways = [way, Way::new(&to.to, &next.to)];
            self.add_blend(&ways, [&line, &onwards], step);
        }
        self.is_on = line.gun.unwrap_or(self.is_on);
    }

    /// Adds the blend between the moves to a step and to the next one.
    fn add_blend(&mut self, ways: &[Way; 2], lines: [&Line; 2], step: usize) {
        let blend = lines[0].blend;
        for share in std::iter::once(0.0).chain(BLEND_SHARES) {
            if share >= self.switches_at {
                self.is_on = lines[0].gun.unwrap_or(self.is_on);
            }
            let is_middle = (share - 0.5).abs() < f64::EPSILON;
            let limit = if is_middle {
                (self.acceleration * tightest_radius(ways, blend)).sqrt()
            } else {
                f64::INFINITY
            };
            let behind = usize::from(share >= 0.5);
            let at = pose_in_blend(ways, blend, share);
            self.add(at, limit, lines[behind], step + behind);
        }
    }

    /// The pieces between the nodes, each with its duration.
    fn pieces(mut self) -> Vec<MotionPiece> {
        let (Some(end), Some(last)) = (self.end, self.nodes.last()) else {
            return Vec::new();
        };
        let stop = Node {
            at: end,
            limit: 0.0,
            ..*last
        };
        self.nodes.push(stop);
        let nodes = &self.nodes;
        let length = |i: usize| {
            let [a, b] = [i, i + 1].map(|i| nodes[i].at.translation.vector);
            (b - a).norm()
        };
        let mut squared: Vec<f64> = (0..nodes.len())
            .map(|i| {
                let before = nodes[i.saturating_sub(1)].speed;
                let most = nodes[i].limit.min(nodes[i].speed).min(before);
                most * most
            })
            .collect();
        let gain = |i: usize| 2.0 * self.acceleration * length(i);
        for i in 1..nodes.len() {
            squared[i] = squared[i].min(squared[i - 1] + gain(i - 1));
        }
        for i in (1..nodes.len()).rev() {
            squared[i - 1] = squared[i - 1].min(squared[i] + gain(i - 1));
        }
        let pieces = nodes.windows(2).enumerate().map(|(i, pair)| {
            let length = length(i);
            let mean = f64::midpoint(squared[i].sqrt(), squared[i + 1].sqrt());
            MotionPiece {
                point: pair[0].point,
                robot_from_nozzle: [pair[0].at, pair[1].at],
                is_gun_on: pair[0].is_on,
                is_from_stop: pair[0].limit <= 0.0,
                seconds: if length > 0.0 { length / mean } else { 0.0 },
            }
        });
        pieces.collect()
    }
}

/// The linear move to a step; none for a joint move.
fn line_to(step: &Step) -> Option<Line> {
    match step.motion {
        Motion::Joints(_) => None,
        Motion::Line(line) => Some(line),
    }
}

/// A straight way from one pose to another.
struct Way {
    from: RigidTransform,
    to: RigidTransform,
    length: f64,
}

impl Way {
    fn new(from: &RigidTransform, to: &RigidTransform) -> Self {
        let (from, to) = (*from, *to);
        let length = (to.translation.vector - from.translation.vector).norm();
        Self { from, to, length }
    }

    /// The pose at a distance from the beginning.
    fn at(&self, distance: f64) -> RigidTransform {
        if self.length <= 0.0 {
            return self.from;
        }
        let share = (distance / self.length).clamp(0.0, 1.0);
        // Half a turn has no shortest way.
        let between = self.from.try_lerp_slerp(&self.to, share, 1e-9);
        between.unwrap_or(self.from)
    }
}

/// The pose at a share of a blend. The parabola's control points are both ends of the blend, and the corner.
fn pose_in_blend([way, onwards]: &[Way; 2], blend: f64, share: f64) -> RigidTransform {
    let (enter, leave) = (way.at(way.length - blend), onwards.at(blend));
    let corner = way.to.translation.vector;
    let [a, b] = [&enter, &leave].map(|pose| pose.translation.vector);
    let left = 1.0 - share;
    let at = a * (left * left) + corner * (2.0 * left * share) + b * (share * share);
    let off = blend * (2.0 * share - 1.0);
    let mut pose = if off < 0.0 {
        way.at(way.length + off)
    } else {
        onwards.at(off)
    };
    pose.translation.vector = at;
    pose
}

/// Radius of curvature in the middle of a blend's parabola, metres; infinite if it is straight.
fn tightest_radius([way, onwards]: &[Way; 2], blend: f64) -> f64 {
    let [before, after] = [way, onwards].map(|way| {
        let along = way.to.translation.vector - way.from.translation.vector;
        along / way.length
    });
    let cosine = before.dot(&after).clamp(-1.0, 1.0);
    // Of half the angle between the ways.
    let (cosine_sq, sine) = (f64::midpoint(1.0, cosine), ((1.0 - cosine) / 2.0).sqrt());
    blend * cosine_sq / sine
}
