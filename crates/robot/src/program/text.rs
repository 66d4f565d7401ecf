//! Lines of a program, and their numbers.

use super::ProgramFormat;
use crate::RobotValue;
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
    pub(super) fn finish(self, format: ProgramFormat) -> String {
        match format {
            ProgramFormat::UrScript | ProgramFormat::Drl => self.text,
            _ => self.text.replace('\n', "\r\n"),
        }
    }
}

/// True for a letter followed by letters, digits and _, all ASCII.
pub(super) fn is_identifier(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_')
}

const KRL_WORDS: &str = "AND ANIN ANOUT BOOL BRAKE B_AND B_EXOR B_NOT B_OR CASE CHANNEL CHAR CIRC CIRC_REL CONFIRM \
    CONST CONTINUE DECL DEF DEFAULT DEFDAT DEFFCT DELAY DIGIN DISTANCE DO ELSE END ENDDAT ENDFCT ENDFOR ENDIF ENDLOOP \
    ENDSPLINE ENDSWITCH ENDWHILE ENUM EXIT EXOR EXT EXTFCT FALSE FOR GLOBAL GOTO HALT IF IMPORT INT INTERRUPT IS LIN \
    LIN_REL LOOP MAXIMUM MINIMUM NOT OR PRIO PTP PTP_REL PUBLIC PULSE REAL REPEAT RESUME RETURN SCIRC SIGNAL SLIN \
    SPLINE SPTP STEP STRUC SWITCH THEN TO TRIGGER TRUE UNTIL WAIT WHEN WHILE";
const RAPID_WORDS: &str = "ALIAS AND BACKWARD CASE CONNECT CONST DEFAULT DIV DO ELSE ELSEIF ENDFOR ENDFUNC ENDIF \
    ENDMODULE ENDPROC ENDRECORD ENDTEST ENDTRAP ENDWHILE ERROR EXIT FALSE FOR FROM FUNC GOTO IF INOUT LOCAL MOD MODULE \
    NOSTEPIN NOT NOVIEW OR PERS PROC RAISE READONLY RECORD RETRY RETURN STEP SYSMODULE TASK TEST THEN TO TRAP TRUE \
    TRYNEXT UNDO VAR VIEWONLY WHILE WITH XOR";
/// Names that a controller's own module or the routine at which it starts already has.
const RAPID_NAMES: &str = "BASE MAIN USER";
/// Also the functions that a program calls: it would call itself instead.
const URSCRIPT_WORDS: &str = "False True and break continue def elif else end global halt if join kill local not or \
    return run sec thread while xor movej movel set_standard_digital_out set_tcp";

/// True for a reserved word of the language, and for a name that every controller already has. The formats of LS and JBI have a field for the name, and DRL programs
/// contain none.
pub(super) fn is_reserved(format: ProgramFormat, name: &str) -> bool {
    let is_in = |words: &str| words.split(' ').any(|word| word.eq_ignore_ascii_case(name));
    match format {
        ProgramFormat::Krl => is_in(KRL_WORDS),
        ProgramFormat::Rapid => is_in(RAPID_WORDS) || is_in(RAPID_NAMES),
        // Case matters here.
        ProgramFormat::UrScript => URSCRIPT_WORDS.split(' ').any(|word| word == name),
        ProgramFormat::Ls | ProgramFormat::Jbi | ProgramFormat::Drl => false,
    }
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

/// Formats a pose in the language's convention: to a micrometre, and 1e-4° or 1e-6 rad.
pub(super) fn numbers(format: ProgramFormat, pose: &RigidTransform) -> Vec<String> {
    let values = format.convention().write(pose).values;
    values.iter().map(RobotValue::rounded).collect()
}
