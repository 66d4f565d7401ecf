//! Runs a test's body in a process of its own.

use std::{
    env,
    ffi::{OsStr, OsString},
    process::Command,
};

/// Environment variable with the test whose body this process runs.
const BODY: &str = "PARTSIGHT_CAMERA_TEST";

/// True in the process that runs the body of that test.
pub(crate) fn is_own(test: &str) -> bool {
    env::var_os(BODY).is_some_and(|own| own == test)
}

/// Runs this test program again, for that one test and with this environment, and fails if its body does.
#[expect(
    clippy::print_stdout,
    reason = "figures and what was skipped are to be read"
)]
pub(crate) fn run(test: &str, environment: &[(&str, &OsStr)]) {
    let program = env::current_exe().expect("this program");
    let output = Command::new(program)
        .args([test, "--exact", "--nocapture", "--test-threads=1"])
        .env_remove("PARTSIGHT_FREENECT")
        .env_remove("PARTSIGHT_OPENNI")
        .env_remove("PARTSIGHT_REALSENSE")
        .env_remove("FAKENECT_PATH")
        // Listing would wait a second each time for GenICam cameras, which play no part in these tests.
        .env("PARTSIGHT_ARAVIS", "no library")
        .env(BODY, test)
        .envs(
            environment
                .iter()
                .map(|(name, value)| (*name, OsString::from(value))),
        )
        .output()
        .expect("started");
    let output_text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success(),
        "{}\n{output_text}\n{errors}",
        output.status
    );
    // A misspelt name would run no test.
    assert!(output_text.contains("1 passed"), "{output_text}");
    // The first of them follows the name of the test on its line.
    for line in output_text
        .lines()
        .filter_map(|line| Some(&line[line.find("figures: ")?..]))
    {
        println!("{line}");
    }
}
