//! Lines of a program, and their numbers.

use crate::{Convention, RobotValue};
use geometry::rigid::RigidTransform;

pub(super) use crate::robot_pose::fixed;

/// The growing text of a program, and its number of instructions.
#[derive(Debug, Default)]
pub(super) struct Lines {
    text: String,
    num_instructions: usize,
}

impl Lines {
    /// Adds a line that is not an instruction.
    pub(super) fn add(&mut self, line: impl AsRef<str>) {
        self.text.push_str(line.as_ref());
        self.text.push('\n');
    }

    /// Adds an instruction.
    pub(super) fn instruct(&mut self, line: impl AsRef<str>) {
        self.num_instructions += 1;
        self.add(line);
    }

    /// Appends all lines of `other`.
    pub(super) fn append(&mut self, other: &Self) {
        self.text.push_str(&other.text);
        self.num_instructions += other.num_instructions;
    }

    pub(super) fn num_instructions(&self) -> usize {
        self.num_instructions
    }

    /// Returns the text, with the controller's line ends.
    pub(super) fn finish(self, line_end: &str) -> String {
        self.text.replace('\n', line_end)
    }
}

/// True for a letter followed by letters, digits and _, all ASCII.
pub(super) fn is_identifier(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_')
}

/// Breaks the header into comments of at most `width` letters. ASCII only: controllers refuse or garble the rest.
pub(super) fn comments(header: &[String], width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    for text in header {
        let ascii: String = text.chars().map(ascii_of).collect();
        let mut line = String::new();
        for word in ascii.split_whitespace() {
            let mut word = word;
            if !line.is_empty() && line.len() + 1 + word.len() > width {
                lines.push(std::mem::take(&mut line));
            }
            while word.len() > width {
                let (head, rest) = word.split_at(width);
                lines.push(head.to_owned());
                word = rest;
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
    }
    lines
}

/// Replaces what is not ASCII, and characters that end a comment or a line in some language.
fn ascii_of(c: char) -> char {
    match c {
        '°' => 'd',
        'µ' => 'u',
        ';' | '"' | '\'' | '{' | '}' => '_',
        c if c.is_ascii_graphic() || c == ' ' => c,
        c if c.is_whitespace() => ' ',
        _ => '_',
    }
}

/// Formats a rail's position in millimetres.
pub(super) fn rail_mm(metres: f64) -> String {
    fixed(1000.0 * metres, 3)
}

/// Formats a pose in a convention: to a micrometre, and 1e-4° or 1e-6 rad.
pub(super) fn numbers(convention: Convention, pose: &RigidTransform) -> Vec<String> {
    let values = convention.write(pose).values;
    values.iter().map(RobotValue::rounded).collect()
}
