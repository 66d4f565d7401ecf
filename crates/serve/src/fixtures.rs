//! A server with an inspector that needs no camera, for the tests of every interface.

use std::{
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU32, Ordering},
    },
    thread::{self, JoinHandle},
    time::Instant,
};

use crate::{
    Answer, Asked, Found, FrameParts, InspectionRecord, Inspector, Problem, Server, VerdictCode,
};
use geometry::rigid::RigidTransform;

/// An accepted part, `number` millimetres from the robot, so that answers cannot be mixed up.
pub fn accepted(number: u32) -> Found {
    let x = f64::from(number) / 1000.0;
    Found {
        verdict: VerdictCode::Accepted,
        captured: Some(Instant::now()),
        part: "fender".into(),
        number: 4,
        marks: Answer::SIMULATED,
        pose: Some(RigidTransform::translation(x, 0.25, 1.5)),
        ..Found::default()
    }
}

/// The same part, refused. The server must not send its numbers.
pub fn refused(accepted: Found) -> Found {
    Found {
        verdict: VerdictCode::Refused,
        problem: Problem {
            reason: "low_score".into(),
            message: "too low (to do: Look again)".into(),
        },
        ..accepted
    }
}

/// A server that runs on a thread of its own until it is dropped.
pub struct RunningServer {
    num_inspected: Arc<AtomicU32>,
    is_ending: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Returns what `find` finds, and counts the inspections.
struct FakeInspector<F, R> {
    find: F,
    recorded: R,
    num_inspected: Arc<AtomicU32>,
    is_ending: Arc<AtomicBool>,
}

impl<F, R> Inspector for FakeInspector<F, R>
where
    F: FnMut(u32, &Asked) -> FrameParts,
    R: FnMut(InspectionRecord),
{
    fn inspect(&mut self, asked: &Asked) -> FrameParts {
        let number = self.num_inspected.fetch_add(1, Ordering::SeqCst) + 1;
        (self.find)(number, asked)
    }

    fn recorded(&mut self, record: InspectionRecord) {
        (self.recorded)(record);
    }

    fn answered(&mut self) {}

    fn turn(&mut self) -> ControlFlow<()> {
        if self.is_ending.load(Ordering::SeqCst) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

impl RunningServer {
    /// Runs the server. `find` gets the number of the inspection, from 1, and what was asked for; `recorded` gets each record.
    pub fn start(
        mut server: Server,
        find: impl FnMut(u32, &Asked) -> FrameParts + Send + 'static,
        recorded: impl FnMut(InspectionRecord) + Send + 'static,
    ) -> Self {
        let num_inspected = Arc::new(AtomicU32::new(0));
        let is_ending = Arc::new(AtomicBool::new(false));
        let mut inspector = FakeInspector {
            find,
            recorded,
            num_inspected: Arc::clone(&num_inspected),
            is_ending: Arc::clone(&is_ending),
        };
        Self {
            num_inspected,
            is_ending,
            thread: Some(thread::spawn(move || server.run(&mut inspector))),
        }
    }

    /// Number of inspections so far.
    pub fn num_inspected(&self) -> u32 {
        self.num_inspected.load(Ordering::SeqCst)
    }

    /// Lets the server end, without waiting for it.
    pub fn ask_to_end(&self) {
        self.is_ending.store(true, Ordering::SeqCst);
    }

    /// Ends the server.
    pub fn end(&mut self) {
        self.ask_to_end();
        if let Some(thread) = self.thread.take() {
            thread.join().expect("ended");
        }
    }
}

impl Drop for RunningServer {
    fn drop(&mut self) {
        self.end();
    }
}
