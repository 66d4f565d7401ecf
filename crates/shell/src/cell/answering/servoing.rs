//! Robots that ask with `SERVO`: answered as `partsight serve` answers them, with target, limits, nozzle and arm of the page *Servo*.

use std::{path::PathBuf, sync::Arc, time::Instant};

use super::work::AnswerInputs;
use crate::{
    cell::{ProgramSetup, ServoSettings, not_calibrated, servo_setup},
    inspection::library_cache::LoadedLibrary,
    session::Session,
};
use capture::SourceSpec;
use inspection::pipeline::NamedRecipe;
use records::history::HistoryBuffer;
use robot::RobotFrame;
use serve::{Problem, ServoRequest};
use station::servoing::{SingleMoves, check_source};
use ui::user_error::UserError;

/// What the page *Servo* sets.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ServoInputs {
    settings: ServoSettings,
    program: ProgramSetup,
    /// File of the calibration.
    calibration: Option<PathBuf>,
}

impl ServoInputs {
    pub(super) fn of(session: &Session) -> Self {
        Self {
            settings: session.servo.clone(),
            program: session.program.clone(),
            calibration: session.calibration_path(),
        }
    }
}

/// What a run rests upon. If any of it changes, the run ends: the robot must not be sent on by what it no longer holds.
struct Basis {
    inputs: ServoInputs,
    robot: Arc<RobotFrame>,
    recipe: Arc<NamedRecipe>,
    source: SourceSpec,
    library: Arc<LoadedLibrary>,
}

impl Basis {
    fn is_of(&self, now: &AnswerInputs, source: &SourceSpec, library: &Arc<LoadedLibrary>) -> bool {
        self.inputs == now.servo
            && self.robot == now.robot
            && self.recipe == now.recipe
            && self.source == *source
            && Arc::ptr_eq(&self.library, library)
    }
}

/// Robots that servo.
#[derive(Default)]
pub(super) struct Servoing {
    running: Option<(Basis, SingleMoves)>,
    /// Why they cannot be, in the window's language.
    pub(super) problem: Option<UserError>,
}

impl Servoing {
    /// Returns the run that this request continues or starts, or why the robot must stay. A run ends when its inputs change. A new
    /// one reads the files named on the page again, because their contents may have changed.
    pub(super) fn moves(
        &mut self,
        (request, client): (&ServoRequest, u64),
        now: &AnswerInputs,
        source: &SourceSpec,
        library: &Arc<LoadedLibrary>,
        history: &HistoryBuffer,
    ) -> Result<SingleMoves, Problem> {
        let goes_on = |(basis, moves): &mut (Basis, SingleMoves)| {
            moves.goes_on(request, client) && basis.is_of(now, source, library)
        };
        if let Some((_, moves)) = self.running.take_if(goes_on) {
            return Ok(moves);
        }
        self.end(history);
        check_source(source).map_err(|why| Problem::of(why.kind(), &why))?;
        let set_up = || -> Result<SingleMoves, UserError> {
            let calibration = now.servo.calibration.as_deref();
            let calibration = calibration.ok_or_else(not_calibrated)?;
            let program = now.servo.program.target()?;
            let setup = servo_setup(&now.servo.settings, &program, calibration)?;
            SingleMoves::new(setup, SingleMoves::USUAL_LONGEST, source.to_string())
                .map_err(|error| UserError::of(&error))
        };
        self.problem = None;
        set_up().map_err(|problem| {
            self.problem = Some(problem);
            Problem::new(
                "no_setup",
                "target, limits, arm or nozzle of the page Servo cannot be used",
                "See the page of the window about answering robots: it says why",
            )
        })
    }

    /// Keeps the moves for the next request, and writes the runs that have ended.
    pub(super) fn keep(
        &mut self,
        mut moves: SingleMoves,
        now: AnswerInputs,
        source: SourceSpec,
        library: Arc<LoadedLibrary>,
        history: &HistoryBuffer,
    ) {
        write_ended(&mut moves, &library, history);
        let basis = Basis {
            inputs: now.servo,
            robot: now.robot,
            recipe: now.recipe,
            source,
            library,
        };
        self.running = Some((basis, moves));
    }

    /// Ends the run, and writes it.
    pub(super) fn end(&mut self, history: &HistoryBuffer) {
        if let Some((basis, mut moves)) = self.running.take() {
            moves.end_run();
            write_ended(&mut moves, &basis.library, history);
        }
    }
}

fn write_ended(moves: &mut SingleMoves, library: &LoadedLibrary, history: &HistoryBuffer) {
    for mut record in moves.take_ended() {
        let title = library.shown.title_of(&record.run.part);
        title.clone_into(&mut record.run.title);
        history.add_servo_run(record, Instant::now());
    }
}
