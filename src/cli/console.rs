//! Console output: answers to standard output, messages to standard error, and a progress bar in between.

use std::{
    fmt::{self, Display},
    io::{self, IsTerminal as _, Write},
    time::Duration,
};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use files::{advice_on, visible, words_of};
use geometry::error::Advice;
pub use records::report::TextTable as Table;

/// Both outputs of a call. Control characters in files and their names are shown as text, so that the terminal does not
/// interpret them.
///
/// A reader that goes away (`| head`) does not stop the work on files: the rest is not shown, and the exit code stays the
/// same. After any other error, such as a full disk, the next line is tried again.
pub struct Console {
    out: io::Stdout,
    /// The rest of a line that was written only in part.
    rest: Vec<u8>,
    /// False once the reader has closed the pipe.
    is_read: bool,
    /// True if the last line could not be written, other than to a closed pipe.
    is_failing: bool,
    /// True if any line could not be written, other than to a closed pipe.
    has_failed: bool,
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
            rest: Vec::new(),
            is_read: true,
            is_failing: false,
            has_failed: false,
            progress: ProgressBar::hidden(),
        }
    }

    /// Writes a label and, in its own column, a text.
    pub(super) fn entry(&mut self, what: &str, text: &dyn Display) {
        self.line(&format_args!("  {what:<9} {text}"));
    }

    /// Writes one or several lines of the answer.
    pub fn line(&mut self, text: &dyn Display) {
        if !self.is_read {
            return;
        }
        let text = text.to_string();
        let shown: Vec<_> = text.split('\n').map(visible).collect();
        let line = shown.join("\n") + "\n";
        let (out, rest) = (&mut self.out, &mut self.rest);
        let written = self.progress.suspend(|| write_line(out, rest, &line));
        match written {
            Ok(()) => self.is_failing = false,
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => self.is_read = false,
            Err(error) => {
                // Once, and not for every line until it works again.
                if !self.is_failing {
                    self.error(&advised_error(
                        format!("the output could not be written: {}", words_of(&error)),
                        advice_on(&error),
                    ));
                }
                self.is_failing = true;
                self.has_failed = true;
            }
        }
    }

    /// Returns false once the reader has closed the pipe.
    pub(super) fn is_read(&self) -> bool {
        self.is_read
    }

    /// Returns false if the pipe is closed or the last line could not be written.
    pub(super) fn is_writable(&self) -> bool {
        self.is_read && !self.is_failing
    }

    /// Writes a message next to the answer, on one line.
    pub fn note(&self, text: &dyn Display) {
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
    pub fn start_progress(&mut self, num_inputs: usize) {
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
    pub fn begin(&self, next: &dyn Display) {
        self.progress
            .set_message(visible(&next.to_string()).into_owned());
    }

    /// Counts an input as done.
    pub fn done(&self) {
        self.progress.inc(1);
    }

    /// Removes the progress bar.
    pub fn end_progress(&self) {
        self.progress.finish_and_clear();
    }

    /// Removes the progress bar. Returns false if an answer could not be written, other than to a closed pipe.
    pub(super) fn finish(&self) -> bool {
        self.progress.finish_and_clear();
        !self.has_failed
    }
}

/// Writes the rest of the line before, then this line. Keeps in `rest` what could not be written, so that a full disk
/// leaves no line cut off in the middle of a file.
fn write_line(out: &mut impl Write, rest: &mut Vec<u8>, line: &str) -> io::Result<()> {
    write_rest(out, rest)?;
    rest.extend(line.as_bytes());
    write_rest(out, rest)
}

fn write_rest(out: &mut impl Write, rest: &mut Vec<u8>) -> io::Result<()> {
    while !rest.is_empty() {
        match out.write(rest) {
            Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
            Ok(num) => drop(rest.drain(..num)),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    out.flush()
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
pub trait Advised<T> {
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
pub fn advised_error(message: impl Into<String>, advice: impl Into<String>) -> anyhow::Error {
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

impl Console {
    /// Prints a table, line by line.
    pub fn table(&mut self, table: &Table) {
        for line in table.lines() {
            self.line(&line);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with room for this many more bytes.
    struct SmallDisk {
        content: Vec<u8>,
        room: usize,
    }

    impl Write for SmallDisk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let num = bytes.len().min(self.room);
            if num == 0 {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.content.extend(&bytes[..num]);
            self.room -= num;
            Ok(num)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_line_that_a_full_disk_cuts_off_is_completed_before_the_next_one() {
        let mut disk = SmallDisk {
            content: Vec::new(),
            room: 10,
        };
        let mut rest = Vec::new();
        let mut line = |disk: &mut SmallDisk, line: &str| write_line(disk, &mut rest, line);
        line(&mut disk, "first\n").expect("there is room");
        line(&mut disk, "second\n").expect_err("full");
        line(&mut disk, "third\n").expect_err("still full");
        assert_eq!(disk.content, b"first\nseco");
        disk.room = 100;
        line(&mut disk, "fourth\n").expect("there is room again");
        assert_eq!(disk.content, b"first\nsecond\nfourth\n");
    }

    #[test]
    fn a_call_that_takes_more_than_two_seconds_says_that_it_works() {
        assert_eq!(waiting(Duration::from_millis(1900)), None);
        let late = waiting(Duration::from_secs(62));
        assert_eq!(late.as_deref(), Some("Working, 62 s"));
    }
}
