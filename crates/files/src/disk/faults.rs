//! Makes every single call of a writer fail, one after the other, as `SQLite` does in its own tests. However a call fails,
//! the disk must hold the old or the new state afterwards, the message must fit, and the next try must succeed.

use std::{
    cell::Cell,
    env, io,
    panic::resume_unwind,
    path::Path,
    process::{self, Command},
    thread::{self, ScopedJoinHandle},
};

use geometry::error::Advice;

/// How a call fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// ENOSPC; a write stores half of its bytes first.
    Full,
    /// EIO.
    Broken,
    /// EACCES.
    Denied,
    /// The program ends; a write stores half of its bytes first.
    Killed,
}

/// Which calls of this thread fail, and how.
#[derive(Clone, Copy, Debug)]
struct Plan {
    fault: Fault,
    /// Calls that still succeed.
    left: u32,
    /// True if every later call fails too.
    stays: bool,
    has_struck: bool,
}

thread_local! {
    static PLAN: Cell<Option<Plan>> = const { Cell::new(None) };
}

/// Runs before every call.
pub(super) fn inject(part_of_it: impl FnOnce()) -> io::Result<()> {
    let Some(mut plan) = PLAN.get() else {
        return Ok(());
    };
    let strikes = plan.left == 0 && (plan.stays || !plan.has_struck);
    plan.left = plan.left.saturating_sub(1);
    plan.has_struck |= strikes;
    PLAN.set(Some(plan));
    if !strikes {
        return Ok(());
    }
    match plan.fault {
        Fault::Full => {
            part_of_it();
            Err(io::Error::from_raw_os_error(28))
        }
        Fault::Broken => Err(io::Error::from_raw_os_error(5)),
        Fault::Denied => Err(io::Error::from_raw_os_error(13)),
        Fault::Killed => {
            part_of_it();
            process::abort()
        }
    }
}

/// Runs a writer under a plan; the second result is true if a call failed.
fn with_fault<T>(plan: Plan, write: impl FnOnce() -> T) -> (T, bool) {
    PLAN.set(Some(plan));
    let written = write();
    let has_struck = PLAN.take().is_some_and(|plan| plan.has_struck);
    (written, has_struck)
}

impl Fault {
    /// Returns true if message and advice describe the fault.
    fn is_described_by(self, message: &str) -> bool {
        let says = |words: &[&str]| words.iter().any(|words| message.contains(words));
        match self {
            Self::Full => says(&["the disk is full"]) && says(&["room"]),
            Self::Broken => says(&["Input/output error"]) && says(&["disk"]) && !says(&["room"]),
            Self::Denied => says(&["permission denied"]) && says(&["access", "writable"]),
            Self::Killed => false,
        }
    }
}

/// Returns an error with its advice, as [`Writer::write`] reports it.
pub fn with_advice(error: &(impl std::error::Error + Advice)) -> String {
    format!("{error}; {}", error.advice())
}

/// Environment variable for the child process to be killed: the number of the call, and the folder.
const KILLED: &str = "PARTSIGHT_TEST_KILLED_AT";

/// More calls than any writer makes.
const MOST_CALLS: u32 = 1000;

/// Number of child processes at once.
const NUM_CHILDREN: u32 = 4;

/// The first of these calls, counted from 0, that a writer does not make; `makes` returns whether it makes one.
fn first_without(mut calls: impl Iterator<Item = u32>, makes: impl Fn(u32) -> bool) -> u32 {
    calls.find(|&at| !makes(at)).expect("it ends")
}

/// A writer under test.
pub struct Writer<'a> {
    /// The full name of the test. It runs again in a child process, which is killed.
    pub test: &'a str,
    /// Creates the old state in an empty folder.
    pub prepare: &'a (dyn Fn(&Path) + Sync),
    /// Changes the old state into the new one; on failure returns the error with its advice.
    pub write: &'a (dyn Fn(&Path) -> Result<(), String> + Sync),
    /// Describes the state that a reader of this program finds.
    pub state: &'a (dyn Fn(&Path) -> String + Sync),
    /// States between old and new that count as whole.
    pub between: &'a [&'a str],
}

impl Writer<'_> {
    /// Makes every call fail in every way, and checks the state afterwards.
    #[allow(clippy::print_stderr, reason = "figures of a test are to be read")]
    pub fn fails_at_every_call(&self) {
        if let Ok(at_and_folder) = env::var(KILLED) {
            let (at, folder) = at_and_folder
                .split_once(' ')
                .expect("a number and a folder");
            let plan = Plan {
                fault: Fault::Killed,
                left: at.parse().expect("a number"),
                stays: false,
                has_struck: false,
            };
            let (written, _) = with_fault(plan, || (self.write)(Path::new(folder)));
            written.expect("written");
            return;
        }
        let (old, new) = self.both();
        assert_ne!(old, new, "the writer changes nothing");
        let faults = [Fault::Full, Fault::Broken, Fault::Denied];
        let plans = faults.map(|fault| [(fault, false), (fault, true)]);
        // At once, because most of the time goes by waiting for the disk. A plan is of its thread alone.
        let num_calls: Vec<u32> = thread::scope(|scope| {
            let fails = plans.as_flattened().iter().map(|&(fault, stays)| {
                let plan = move |left| Plan {
                    fault,
                    left,
                    stays,
                    has_struck: false,
                };
                let (old, new) = (&old, &new);
                let survives = move |at| self.survives(plan(at), old, new);
                scope.spawn(move || first_without(0..MOST_CALLS, survives))
            });
            let fails: Vec<_> = fails.collect();
            let kills = (0..NUM_CHILDREN).map(|first| {
                let calls = (first..MOST_CALLS).step_by(NUM_CHILDREN as usize);
                let survives = |at| self.survives_being_killed(at, &old, &new);
                scope.spawn(move || first_without(calls, survives))
            });
            let kills: Vec<_> = kills.collect();
            let joined = |thread: ScopedJoinHandle<'_, u32>| {
                let failed = thread.join();
                failed.unwrap_or_else(|panic| resume_unwind(panic))
            };
            let killed = kills.into_iter().map(joined).min();
            fails.into_iter().map(joined).chain(killed).collect()
        });
        assert!(num_calls.iter().all(|&num| num > 0), "{num_calls:?}");
        eprintln!("{}: calls that failed: {num_calls:?}", self.test);
    }

    fn both(&self) -> (String, String) {
        let folder = tempfile::tempdir().expect("a folder");
        (self.prepare)(folder.path());
        let old = (self.state)(folder.path());
        (self.write)(folder.path()).expect("written");
        (old, (self.state)(folder.path()))
    }

    /// Returns false if the writer makes fewer calls, so that none failed.
    fn survives(&self, plan: Plan, old: &str, new: &str) -> bool {
        let folder = tempfile::tempdir().expect("a folder");
        (self.prepare)(folder.path());
        let (written, has_struck) = with_fault(plan, || (self.write)(folder.path()));
        let found = (self.state)(folder.path());
        match written {
            Ok(()) => assert_eq!(found, new, "{plan:?} was not reported"),
            Err(message) => {
                assert!(has_struck, "{message}");
                assert!(plan.fault.is_described_by(&message), "{plan:?}: {message}");
                self.is_whole(&found, old, new, &format!("{plan:?}: {message}"));
            }
        }
        self.goes_on(folder.path(), &found, old, new, &format!("{plan:?}"));
        has_struck
    }

    fn survives_being_killed(&self, at: u32, old: &str, new: &str) -> bool {
        let folder = tempfile::tempdir().expect("a folder");
        (self.prepare)(folder.path());
        let ran = Command::new(env::current_exe().expect("this program"))
            .args(["--exact", self.test, "--test-threads=1"])
            .env(KILLED, format!("{at} {}", folder.path().display()))
            .output()
            .expect("ran");
        let output = String::from_utf8_lossy(&ran.stdout);
        assert!(
            output.contains("running 1 test"),
            "{} is no test",
            self.test
        );
        let found = (self.state)(folder.path());
        if ran.status.success() {
            assert_eq!(found, new);
            return false;
        }
        assert!(ran.status.code().is_none(), "not killed: {output}");
        self.is_whole(&found, old, new, &format!("killed at call {at}"));
        self.goes_on(folder.path(), &found, old, new, &format!("killed at {at}"));
        true
    }

    fn is_whole(&self, found: &str, old: &str, new: &str, when: &str) {
        let is_whole = found == old || found == new || self.between.contains(&found);
        assert!(is_whole, "{when}: neither {old} nor {new}: {found}");
    }

    /// A failed write succeeds on the next try.
    fn goes_on(&self, folder: &Path, found: &str, old: &str, new: &str, when: &str) {
        if found == old {
            let again = (self.write)(folder);
            again.unwrap_or_else(|message| panic!("{when}, and then: {message}"));
            assert_eq!((self.state)(folder), new, "{when}, and again");
        }
    }
}
