//! Servoing in single moves, for robots that ask: a run of one client after the other, and its answers.

use std::{
    ops::RangeInclusive,
    sync::Arc,
    time::{Duration, Instant},
};

use super::{PreparedTask, ServoJob, ServoSetup, SetupError, run::Log};
use crate::{Camera, NoFrame, PartFinder};
use capture::Captured;
use geometry::{
    rigid::{PoseDelta, RigidTransform},
    units::{Metres, Radians},
};
use inspection::{
    library::Library,
    pipeline::{Inspection, NamedRecipe, Unwatched, run as inspect},
};
use records::history::{ServoRecord, ServoRun, ServoSample};
use serve::{Answer, Asked, Found, Problem, RemainingError, ServoRequest, VerdictCode};
use servo::{
    ArmState, Look, OnePose, OnePoseAnswer, SeenPart, ServoError, ServoState, Step, StopReason,
};
use stages::scene::SceneCloud;

/// Moves robots at rest, one move at a time, by what the camera sees in between.
pub struct SingleMoves {
    setup: ServoSetup,
    max_move: PoseDelta,
    /// The camera, as the history names it.
    source: String,
    /// All looks and poses are dated from here.
    since: Instant,
    run: Option<Run>,
    /// Rows of the history that were not taken yet.
    ended: Vec<ServoRecord>,
}

/// What the history calls a robot that asks over the server.
const ROBOT: &str = "serve";
/// Most looks of a run that its curve shows: those of half an hour. A robot may ask for ever, and a run that it does not end grows.
const MAX_SAMPLES: usize = 10_000;

/// A run of a client.
struct Run {
    client: u64,
    part: u32,
    prepared: PreparedTask,
    moves: OnePose,
    row: ServoRun,
    log: Log,
    /// How it ends if nothing more is asked, and when it was answered last.
    end: (Step, Duration),
}

impl Run {
    /// Notes an answer, and what it rests upon. Without another request, the robot has stopped on its way.
    fn note(&mut self, looks: &[Look], answer: &OnePoseAnswer, began: Duration, now: Duration) {
        let (error, held, end) = match answer {
            OnePoseAnswer::Move { error, .. } => {
                (Some(*error), None, Step::Stop(StopReason::RobotStopped))
            }
            OnePoseAnswer::Done(arrival) => {
                (Some(arrival.error), None, Step::Done(arrival.clone()))
            }
            OnePoseAnswer::Stay(reason) => (None, Some(reason), Step::Stop(reason.clone())),
        };
        self.end = (end, now);
        let state = held.map_or(ServoState::Checking, |_| ServoState::Holding);
        let room = MAX_SAMPLES.saturating_sub(self.log.curve.len());
        let samples = looks.iter().take(room).map(|look| ServoSample {
            at_s: look.taken_at.saturating_sub(began).as_secs_f64(),
            error_m: error.map(|error| error.shift.0),
            error_rad: error.map(|error| error.rotation.0),
            state,
            held: held.map(|reason| reason.kind().to_owned()),
        });
        self.log.curve.extend(samples);
    }

    /// Its row in the history.
    fn record(self) -> Option<ServoRecord> {
        let error = self.log.curve.iter().rev().find_map(|sample| {
            Some(PoseDelta {
                shift: Metres(sample.error_m?),
                rotation: Radians(sample.error_rad?),
            })
        });
        let (end, now) = self.end;
        self.log.record(self.row, &Ok(end), error, now)
    }
}

/// What the frames show that were taken while a robot stood still.
pub struct RestFrames {
    /// When each arrived, and what it shows of the part.
    pub looks: Vec<(Instant, Result<SeenPart, StopReason>)>,
    /// When the first was captured.
    pub captured: Instant,
    /// Any of [`Answer::SIMULATED`] and [`Answer::MOTION_UNCHECKED`].
    pub marks: u16,
    /// The last of them and its inspection, if they are at hand.
    pub last: Option<(Arc<SceneCloud>, Inspection)>,
}

/// A camera that looks at a part while a robot stands still.
pub struct RestWatch<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The library, prepared for the recipe.
    pub library: &'a Library,
    /// How long each frame is waited for.
    pub at_most: Duration,
    /// Returns true once the service is ending.
    pub is_ending: &'a dyn Fn() -> bool,
}

impl RestWatch<'_> {
    /// Takes frames and inspects them; `scene_of` makes scenes of them.
    pub fn looks(
        &self,
        prepared: &PreparedTask,
        asked: &Asked,
        num: usize,
        mut scene_of: impl FnMut(Captured) -> Arc<SceneCloud>,
    ) -> Result<RestFrames, NoFrame> {
        let (task, recipe) = (&prepared.task, &prepared.recipe);
        let (mut looks, mut first, mut is_simulated) = (Vec::new(), None, false);
        let mut last = None;
        let (at_most, is_ending) = (self.at_most, self.is_ending);
        let is_checked =
            (self.camera).frames_after(asked, num, at_most, is_ending, |captured| {
                let arrived = captured.arrived;
                first.get_or_insert(self.camera.captured_at(&captured));
                is_simulated |= captured.is_simulated;
                let scene = scene_of(captured);
                let inspection = inspect(&scene, self.library, recipe, &Unwatched);
                let inspection = inspection.expect("never cancelled");
                looks.push((arrived, Look::new(task, &inspection, Duration::ZERO).seen));
                last = Some((scene, inspection));
            })?;
        let mark = |is: bool, mark| if is { mark } else { 0 };
        Ok(RestFrames {
            looks,
            captured: first.unwrap_or(asked.at),
            marks: mark(is_simulated, Answer::SIMULATED)
                | mark(!is_checked, Answer::MOTION_UNCHECKED),
            last,
        })
    }
}

/// The parts that robots name by their numbers.
#[derive(Clone, Copy)]
pub struct ServoParts<'a> {
    /// Numbers and paths.
    pub finder: &'a PartFinder,
    /// The library, prepared for the recipe.
    pub library: &'a Library,
    /// The recipe.
    pub recipe: &'a NamedRecipe,
}

/// Degrees that a longest move of a millimetre may turn.
const DEGREES_PER_MM: f64 = 0.1;

impl SingleMoves {
    /// Valid longest moves, mm.
    pub const LONGEST_MOVES_MM: RangeInclusive<f64> = 10.0..=300.0;
    /// The longest move if no other is asked for.
    pub const USUAL_LONGEST: Metres = Metres(0.1);

    /// Moves are at most `longest` long, and turn by a tenth of a degree for each millimetre; the history names the camera `source`.
    pub fn new(setup: ServoSetup, longest: Metres, source: String) -> Result<Self, ServoError> {
        setup.params().checked()?;
        let max_move = PoseDelta {
            shift: longest,
            rotation: Radians::from_degrees(DEGREES_PER_MM * longest.mm()),
        };
        OnePose::check_longest(&max_move)?;
        Ok(Self {
            setup,
            max_move,
            source,
            since: Instant::now(),
            run: None,
            ended: Vec::new(),
        })
    }

    /// True if this request goes on with the run, and begins none.
    pub fn goes_on(&self, request: &ServoRequest, client: u64) -> bool {
        let run = self.run.as_ref().filter(|_| !request.is_start);
        run.is_some_and(|run| run.client == client && run.part == request.part)
    }

    /// Ends the run: the library is another one, or the service ends.
    pub fn end_run(&mut self) {
        self.ended.extend(self.run.take().and_then(Run::record));
    }

    /// Takes the rows of the runs that have ended since the last call.
    pub fn take_ended(&mut self) -> Vec<ServoRecord> {
        std::mem::take(&mut self.ended)
    }

    /// Answers a robot at rest. `look` takes as many frames as it is told, captured after this time, or one if the source gives
    /// one alone for a trigger, and inspects them with the recipe of the task.
    pub fn answer(
        &mut self,
        request: &ServoRequest,
        client: u64,
        asked: &Asked,
        parts: ServoParts<'_>,
        look: impl FnOnce(&PreparedTask, &Asked, usize) -> Result<RestFrames, NoFrame>,
    ) -> Found {
        let params = self.setup.params();
        let since = self.since;
        let run = match self.run_of(request, client, parts) {
            Ok(run) => run,
            Err(problem) => return Found::error(problem),
        };
        let dated = |at: Instant| at.saturating_duration_since(since);
        let begins = || (asked.by_clock, dated(asked.at));
        let (_, began) = *run.log.began.get_or_insert_with(begins);
        // Arm and camera swing on for a moment.
        let at_rest = Asked {
            at: asked.at + params.settle,
            by_clock: asked.by_clock + params.settle,
            ..asked.clone()
        };
        let frames = match look(&run.prepared, &at_rest, params.num_final) {
            Ok(frames) => frames,
            Err(why) => return Found::error((&why).into()),
        };
        let looks = frames.looks.into_iter();
        let looks = looks.map(|(arrived, seen)| Look {
            taken_at: dated(arrived),
            seen,
        });
        let looks: Vec<Look> = looks.collect();
        let stands = |at: Duration| state(&request.robot_from_flange, at);
        let states = [dated(at_rest.at), dated(Instant::now())].map(stands);
        let answer = run.moves.answer(&looks, [&states[0], &states[1]]);
        run.row.is_simulated |= frames.marks & Answer::SIMULATED != 0;
        run.note(&looks, &answer, began, states[1].at);
        let found = Found {
            captured: Some(frames.captured),
            part: run.prepared.task.part.clone(),
            number: run.part,
            marks: frames.marks,
            ..Found::default()
        };
        let (found, is_over) = with_answer(found, answer);
        if is_over {
            self.end_run();
        }
        found
    }

    /// The client's run, or a new one if this is its first request, for another part, or for a new start.
    fn run_of(
        &mut self,
        request: &ServoRequest,
        client: u64,
        parts: ServoParts<'_>,
    ) -> Result<&mut Run, Problem> {
        let goes_on = self.goes_on(request, client);
        let run = if let Some(run) = self.run.take_if(|_| goes_on) {
            run
        } else {
            self.end_run();
            self.begun(request.part, client, parts)?
        };
        Ok(self.run.insert(run))
    }

    fn begun(&self, part: u32, client: u64, parts: ServoParts<'_>) -> Result<Run, Problem> {
        let ServoParts {
            finder,
            library,
            recipe,
        } = parts;
        let mut numbered = finder.parts.iter().zip(&library.references);
        let known = numbered.find(|(numbered, _)| part > 0 && numbered.number == part);
        let Some((numbered, reference)) = known else {
            return Err((&NoFrame::UnknownNumber { number: part }).into());
        };
        let (name, path) = (&reference.enrolled_as, numbered.path.as_ref());
        let prepared = self.setup.prepare(name, path, library, recipe);
        let problem = |error: SetupError| Problem::of(error.kind(), &error);
        let prepared = prepared.map_err(problem)?;
        let (task, fence) = (prepared.task.clone(), prepared.fence.clone());
        let params = self.setup.params();
        let job = ServoJob {
            part: name,
            title: name,
            library,
            longest_step: None,
        };
        let row = job.row(&task, &params, ROBOT.into(), self.source.clone());
        let moves = OnePose::new(task, params, self.max_move, fence);
        let moves = moves.map_err(|error| Problem::of("parameter", &error))?;
        Ok(Run {
            client,
            part,
            prepared,
            moves,
            row: ServoRun {
                speed_m_s: None,
                ..row
            },
            log: Log::default(),
            end: (Step::Stop(StopReason::RobotStopped), Duration::ZERO),
        })
    }
}

/// A robot that stands still with its flange here.
fn state(robot_from_flange: &RigidTransform, at: Duration) -> ArmState {
    ArmState {
        at,
        robot_from_flange: *robot_from_flange,
        joints: None,
    }
}

/// Puts an answer into the result for the client; also returns whether the run is over.
fn with_answer(found: Found, answer: OnePoseAnswer) -> (Found, bool) {
    match answer {
        OnePoseAnswer::Move {
            robot_from_flange,
            error,
        } => {
            let found = Found {
                verdict: VerdictCode::Move,
                pose: Some(robot_from_flange),
                servo_error: Some(RemainingError {
                    error,
                    bounds: None,
                }),
                ..found
            };
            (found, false)
        }
        OnePoseAnswer::Done(arrival) => {
            let approximate = if arrival.is_approximate {
                Answer::APPROXIMATE
            } else {
                0
            };
            let found = Found {
                verdict: VerdictCode::Done,
                marks: found.marks | approximate,
                servo_error: Some(RemainingError {
                    error: arrival.error,
                    bounds: Some(arrival.bounds),
                }),
                ..found
            };
            (found, true)
        }
        OnePoseAnswer::Stay(reason) => {
            let found = Found {
                verdict: VerdictCode::Stay,
                problem: Problem::of(reason.kind(), &reason),
                ..found
            };
            (found, false)
        }
    }
}

#[cfg(test)]
mod tests;
