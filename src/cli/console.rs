//! Where text goes: answers to standard output, messages to standard error, a progress bar between them.

use std::{
    fmt::{self, Display},
    io::{self, IsTerminal as _, Write},
    time::Duration,
};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

pub(super) use crate::report::TextTable as Table;
use crate::{error::Advice, files::visible};

/// Both outputs of a call. Nothing that stands in a file or in its name reaches the terminal as a command to it.
///
/// A reader that goes away (`| head`) does not end the work: the rest is not shown, and the exit code stays true.
pub(super) struct Console {
    out: io::Stdout,
    /// The first failure to write an answer, other than a reader that went away.
    failed: Option<io::Error>,
    is_read: bool,
    progress: ProgressBar,
}

/// An error as clap shows it: what is wrong with an argument, and what to do about it.
pub(super) fn with_advice<E: Display + Advice>(error: &E) -> String {
    format!("{error}\n  to do: {}", error.advice())
}

/// More inputs than this take long enough for a progress bar.
const MANY: usize = 5;
/// After this much silence a terminal shows that the command is still working.
const PATIENCE: Duration = Duration::from_secs(2);

impl Console {
    pub(super) fn new() -> Self {
        Self {
            out: io::stdout(),
            failed: None,
            is_read: true,
            progress: ProgressBar::hidden(),
        }
    }

    /// One of several things about the same: what it is and, in a column of its own, how it is.
    pub(super) fn entry(&mut self, what: &str, text: &dyn Display) {
        self.line(&format_args!("  {what:<9} {text}"));
    }

    /// One line of the answer, or several.
    pub(super) fn line(&mut self, text: &dyn Display) {
        if !self.is_read {
            return;
        }
        let text = text.to_string();
        let shown: Vec<_> = text.split('\n').map(visible).collect();
        let out = &mut self.out;
        let write = || writeln!(out, "{}", shown.join("\n")).and_then(|()| out.flush());
        match self.progress.suspend(write) {
            Ok(()) => {}
            Err(error) => {
                self.is_read = false;
                if error.kind() != io::ErrorKind::BrokenPipe {
                    self.failed = Some(error);
                }
            }
        }
    }

    /// A remark beside the answer, on one line.
    pub(super) fn note(&self, text: &dyn Display) {
        let text = text.to_string();
        // If stderr is gone, there is nobody to tell.
        self.progress
            .suspend(|| drop(writeln!(io::stderr(), "{}", visible(&text))));
    }

    /// Something odd, and what to do about it.
    pub(super) fn warn(&self, what: &dyn Display, advice: &dyn Advice) {
        self.note(&format_args!("warning: {what}"));
        self.note(&format_args!("  to do: {}", advice.advice()));
    }

    /// Why something could not be done, and what to do about it.
    pub(super) fn error(&self, error: &anyhow::Error) {
        self.note(&format_args!("error: {error:#}"));
        if let Some(advice) = advice_of(error) {
            self.note(&format_args!("  to do: {advice}"));
        }
    }

    /// Shows on a terminal that a call is at work, if it takes long and shows no bar.
    pub(super) fn start_waiting(&mut self) {
        if io::stderr().is_terminal() {
            let late = |state: &ProgressState, out: &mut dyn fmt::Write| {
                let text = waiting(state.elapsed()).unwrap_or_default();
                // If stderr is gone, there is nobody to tell.
                let _ = out.write_str(&text);
            };
            let style = ProgressStyle::with_template("{late}");
            let style = style.map(|style| style.with_key("late", late));
            self.progress = ProgressBar::no_length()
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
            self.progress.enable_steady_tick(Duration::from_millis(200));
        }
    }

    /// Shows how far a long call has come, on a terminal.
    pub(super) fn start_progress(&mut self, num_inputs: usize) {
        if num_inputs > MANY && io::stderr().is_terminal() {
            self.progress.finish_and_clear();
            let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}  {eta} left");
            self.progress = ProgressBar::new(num_inputs as u64)
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            self.progress.enable_steady_tick(Duration::from_millis(200));
        }
    }

    /// Counts on a terminal what comes, where nobody can say how much that will be.
    pub(super) fn start_counting(&mut self) {
        if io::stderr().is_terminal() {
            self.progress.finish_and_clear();
            let style = ProgressStyle::with_template("{spinner} {pos} {msg}");
            self.progress = ProgressBar::no_length()
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
            self.progress.enable_steady_tick(Duration::from_millis(200));
        }
    }

    /// One input more is done; `next` comes now.
    pub(super) fn begin(&self, next: &dyn Display) {
        self.progress
            .set_message(visible(&next.to_string()).into_owned());
    }

    /// The input begun last is done.
    pub(super) fn done(&self) {
        self.progress.inc(1);
    }

    /// Takes the progress bar away.
    pub(super) fn end_progress(&self) {
        self.progress.finish_and_clear();
    }

    /// Ends the progress bar; the first failure to write an answer, if there was one.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        self.progress.finish_and_clear();
        self.failed.take().map_or(Ok(()), Err)
    }
}

/// What is shown of a call that has been at work for so long; nothing of a short one.
fn waiting(elapsed: Duration) -> Option<String> {
    (elapsed >= PATIENCE).then(|| format!("Working, {} s", elapsed.as_secs()))
}

/// An error that brings its advice along.
#[derive(Debug)]
struct AdvisedError {
    message: String,
    advice: String,
}

impl Display for AdvisedError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for AdvisedError {}

fn advice_of(error: &anyhow::Error) -> Option<&str> {
    error
        .downcast_ref::<AdvisedError>()
        .map(|e| e.advice.as_str())
}

/// Keeps the advice of an error on its way up.
pub(super) trait Advised<T> {
    fn advised(self) -> anyhow::Result<T>;
}

impl<T, E: std::error::Error + Advice + Send + Sync + 'static> Advised<T> for Result<T, E> {
    fn advised(self) -> anyhow::Result<T> {
        self.map_err(|error| {
            anyhow::Error::new(AdvisedError {
                advice: error.advice(),
                // Our messages hold their causes in words already.
                message: error.to_string(),
            })
        })
    }
}

/// An error of the command line itself, with its advice.
pub(super) fn advised_error(
    message: impl Into<String>,
    advice: impl Into<String>,
) -> anyhow::Error {
    anyhow::Error::new(AdvisedError {
        message: message.into(),
        advice: advice.into(),
    })
}

/// The name of a scene, marked if no camera was read and the name does not say so itself.
pub(super) fn marked_simulated(name: &str, is_simulated: bool) -> String {
    if is_simulated && !name.to_lowercase().contains("simulated") {
        format!("{name}, simulated")
    } else {
        name.to_owned()
    }
}

/// Numbers in columns, each to the millionth.
pub(super) fn in_columns(numbers: &[f64]) -> String {
    // Adding zero takes the sign from a negative zero.
    let cells = numbers.iter().map(|x| format!("{:10.6}", x + 0.0));
    cells.collect::<Vec<_>>().join(" ")
}

impl Table {
    pub(super) fn show(&self, console: &mut Console) {
        for line in self.lines() {
            console.line(&line);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_call_that_takes_more_than_two_seconds_says_that_it_works() {
        assert_eq!(waiting(Duration::from_millis(1900)), None);
        let late = waiting(Duration::from_secs(62));
        assert_eq!(late.as_deref(), Some("Working, 62 s"));
    }
}
