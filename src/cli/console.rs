//! Console output: answers to standard output, messages to standard error, and a progress bar in between.

use std::{
    fmt::{self, Display},
    io::{self, IsTerminal as _, Write},
    time::Duration,
};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

pub(super) use crate::report::TextTable as Table;
use crate::{error::Advice, files::visible};

/// Both outputs of a call. Control characters in files and their names are shown as text, so that the terminal does not
/// interpret them.
///
/// A reader that goes away (`| head`) does not stop the work: the rest is not shown, and the exit code stays the same.
pub(super) struct Console {
    out: io::Stdout,
    /// The first failure to write an answer, other than a closed pipe.
    failed: Option<io::Error>,
    is_read: bool,
    progress: ProgressBar,
}

/// Formats an error of an argument for clap, with its advice.
pub(super) fn with_advice<E: Display + Advice>(error: &E) -> String {
    format!("{error}\n  to do: {}", error.advice())
}

/// Number of inputs above which a progress bar is shown.
const MANY: usize = 5;
/// Time without output after which a terminal shows that the command is still working.
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

    /// Writes a label and, in its own column, a text.
    pub(super) fn entry(&mut self, what: &str, text: &dyn Display) {
        self.line(&format_args!("  {what:<9} {text}"));
    }

    /// Writes one or several lines of the answer.
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

    /// Writes a message next to the answer, on one line.
    pub(super) fn note(&self, text: &dyn Display) {
        let text = text.to_string();
        // Ignore a closed stderr.
        self.progress
            .suspend(|| drop(writeln!(io::stderr(), "{}", visible(&text))));
    }

    /// Writes a warning and its advice.
    pub(super) fn warn(&self, what: &dyn Display, advice: &dyn Advice) {
        self.advise(&format_args!("warning: {what}"), &advice.advice());
    }

    /// Writes a message next to the answer, and what to do about it.
    pub(super) fn advise(&self, text: &dyn Display, to_do: &dyn Display) {
        self.note(text);
        self.note(&format_args!("  to do: {to_do}"));
    }

    /// Writes an error and its advice.
    pub(super) fn error(&self, error: &anyhow::Error) {
        self.note(&format_args!("error: {error:#}"));
        if let Some(advice) = advice_of(error) {
            self.note(&format_args!("  to do: {advice}"));
        }
    }

    /// Shows on a terminal that a call is working, if it takes long and has no progress bar.
    pub(super) fn start_waiting(&mut self) {
        if io::stderr().is_terminal() {
            let late = |state: &ProgressState, out: &mut dyn fmt::Write| {
                let text = waiting(state.elapsed()).unwrap_or_default();
                // Ignore a closed stderr.
                let _ = out.write_str(&text);
            };
            let style = ProgressStyle::with_template("{late}");
            let style = style.map(|style| style.with_key("late", late));
            self.progress = ProgressBar::no_length()
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
            self.progress.enable_steady_tick(Duration::from_millis(200));
        }
    }

    /// Starts a progress bar, on a terminal.
    pub(super) fn start_progress(&mut self, num_inputs: usize) {
        if num_inputs > MANY && io::stderr().is_terminal() {
            self.progress.finish_and_clear();
            let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}  {eta} left");
            self.progress = ProgressBar::new(num_inputs as u64)
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            self.progress.enable_steady_tick(Duration::from_millis(200));
        }
    }

    /// Starts a counter on a terminal, for an unknown number of inputs.
    pub(super) fn start_counting(&mut self) {
        if io::stderr().is_terminal() {
            self.progress.finish_and_clear();
            let style = ProgressStyle::with_template("{spinner} {pos} {msg}");
            self.progress = ProgressBar::no_length()
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
            self.progress.enable_steady_tick(Duration::from_millis(200));
        }
    }

    /// Shows the input that begins now.
    pub(super) fn begin(&self, next: &dyn Display) {
        self.progress
            .set_message(visible(&next.to_string()).into_owned());
    }

    /// Counts an input as done.
    pub(super) fn done(&self) {
        self.progress.inc(1);
    }

    /// Removes the progress bar.
    pub(super) fn end_progress(&self) {
        self.progress.finish_and_clear();
    }

    /// Removes the progress bar. Returns the first failure to write an answer, if any.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        self.progress.finish_and_clear();
        self.failed.take().map_or(Ok(()), Err)
    }
}

/// Returns the message for a call that has been working this long; `None` for a short one.
fn waiting(elapsed: Duration) -> Option<String> {
    (elapsed >= PATIENCE).then(|| format!("Working, {} s", elapsed.as_secs()))
}

/// An error with its advice.
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

pub(super) fn advice_of(error: &anyhow::Error) -> Option<&str> {
    error
        .downcast_ref::<AdvisedError>()
        .map(|e| e.advice.as_str())
}

/// Attaches the advice of an error for its way up.
pub(super) trait Advised<T> {
    fn advised(self) -> anyhow::Result<T>;
}

impl<T, E: std::error::Error + Advice + Send + Sync + 'static> Advised<T> for Result<T, E> {
    fn advised(self) -> anyhow::Result<T> {
        self.map_err(|error| {
            anyhow::Error::new(AdvisedError {
                advice: error.advice(),
                // Our messages already contain their causes.
                message: error.to_string(),
            })
        })
    }
}

/// Creates an error of the command line, with its advice.
pub(super) fn advised_error(
    message: impl Into<String>,
    advice: impl Into<String>,
) -> anyhow::Error {
    anyhow::Error::new(AdvisedError {
        message: message.into(),
        advice: advice.into(),
    })
}

/// Returns the advice for a part without a spray path.
pub(super) fn store_a_path(part: &str) -> String {
    format!(
        "To store one: partsight path plan {part} --coat primer --propose --store, or partsight library path {part} \
         YOUR_PATH.csv"
    )
}

/// Returns the name of a scene, marked as simulated if it is and the name does not already contain the mark.
pub(super) fn marked_simulated(name: &str, is_simulated: bool) -> String {
    if is_simulated && !name.to_lowercase().contains("simulated") {
        format!("{name}, simulated")
    } else {
        name.to_owned()
    }
}

/// Formats numbers in columns, with six decimals.
pub(super) fn in_columns(numbers: &[f64]) -> String {
    // Adding zero removes the sign of a negative zero.
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
