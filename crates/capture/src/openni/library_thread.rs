//! The one thread that calls libOpenNI2.
//!
//! The library remembers every thread that calls it, and asks the system about each of them whenever a further thread calls
//! it. To ask about a thread that has ended is undefined, and ends the program now and then. The only thread that it knows
//! is therefore this one, which lasts as long as the program.

use std::{
    any::Any,
    io,
    panic::{AssertUnwindSafe, catch_unwind, resume_unwind},
    sync::{
        Mutex,
        mpsc::{self, Sender},
    },
    thread,
};

use super::OpenNi;
use geometry::error::lock;

/// Work for the thread, with the camera or file that is open there, if any.
type Job = Box<dyn FnOnce(&mut Option<OpenNi>) + Send>;

/// Runs a job on the thread and waits for its result. A panic of the job closes the camera and goes on here. Fails if the
/// thread cannot be started.
pub(super) fn run<T: Send + 'static>(
    job: impl FnOnce(&mut Option<OpenNi>) -> T + Send + 'static,
) -> io::Result<T> {
    let (sender, receiver) = mpsc::sync_channel::<Result<T, Box<dyn Any + Send>>>(1);
    let job: Job = Box::new(move |opened| {
        let result = catch_unwind(AssertUnwindSafe(|| job(opened)));
        if result.is_err() {
            *opened = None;
        }
        // The caller waits.
        let _ = sender.send(result);
    });
    // If the thread were gone, nothing would be received either.
    let _ = jobs()?.send(job);
    let result = receiver.recv().map_err(io::Error::other)?;
    Ok(result.unwrap_or_else(|panic| resume_unwind(panic)))
}

/// Starts the thread at the first call.
fn jobs() -> io::Result<Sender<Job>> {
    static JOBS: Mutex<Option<Sender<Job>>> = Mutex::new(None);
    let mut jobs = lock(&JOBS);
    if let Some(jobs) = &*jobs {
        return Ok(jobs.clone());
    }
    let (sender, receiver) = mpsc::channel::<Job>();
    thread::Builder::new()
        .name("OpenNI".into())
        .spawn(move || {
            super::oni::use_own_working_folder();
            let mut opened = None;
            for job in receiver {
                job(&mut opened);
            }
        })?;
    *jobs = Some(sender.clone());
    Ok(sender)
}
