//! What `#[derive(Advice)]` makes of errors like those of the program.

extern crate self as geometry;

use std::{
    fmt::{Debug, Display},
    io,
    path::PathBuf,
};

use crate::error::Advice;

/// Stands for the module of the same name in `geometry`, which the derived code names.
pub mod error {
    pub use derive::Advice;

    pub trait Advice {
        fn advice(&self) -> String;
    }
}

const EXAMPLE: &str = "{\"width\": 640}";
const MOST: usize = 8;

#[derive(Debug, thiserror::Error, Advice)]
enum FileError {
    #[error("{path} is not there")]
    #[advice = "Check the name and that the drive is connected"]
    NotFound { path: PathBuf },

    #[error("line {line} of {path} is no number")]
    #[advice("Correct line {line} of {} in a text editor", path.display())]
    Malformed { path: PathBuf, line: usize },

    #[error("{json} is missing")]
    #[advice = "Write it, \
              for example {EXAMPLE}, with up to {MOST} numbers in {{}}"]
    MissingIntrinsics { json: String },

    #[error("cannot write {path}")]
    #[advice(advice_on(source))]
    Write { path: PathBuf, source: io::Error },

    #[error("no parts")]
    #[advice(EXAMPLE)]
    NoParts,

    #[error("no places")]
    #[advice(EXAMPLE)]
    NoPlaces,

    #[error("{0} is none of {1:?}")]
    #[advice("The nearest name is {}", nearest(_0, _1))]
    NoSuchName(String, Vec<&'static str>),

    #[error("{found} frames")]
    #[advice(if *found == 1 { "Add frames from other sides" } else { "Give the folder" })]
    TooFew { found: usize },

    #[error("nothing")]
    #[advice(self.of_nothing())]
    Nothing {},
}

impl FileError {
    fn of_nothing(&self) -> String {
        format!("With {self}, nothing can be done")
    }
}

fn advice_on(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::StorageFull => "Make room on the disk",
        _ => "Check the disk",
    }
}

fn nearest<'a>(name: &str, available: &[&'a str]) -> &'a str {
    let same = |known: &&&str| known.starts_with(&name[..1]);
    available.iter().find(same).copied().unwrap_or("none")
}

#[derive(Debug, thiserror::Error, Advice)]
enum OuterError {
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),

    #[error(transparent)]
    #[advice(transparent)]
    Boxed(Box<WrittenError>),

    #[error("{name} is damaged")]
    #[advice(error.advice())]
    Damaged { name: String, error: FileError },

    #[error("{0}, for parts")]
    #[advice(match _0 {
        FileError::NotFound { .. } => "Enrol a part first".into(),
        FileError::TooFew { .. } | FileError::Nothing {} => format!("Not with {self}"),
        other => other.advice(),
    })]
    OfParts(FileError),

    #[error("cancelled by {0}")]
    #[advice = "Run it again"]
    Cancelled(String),
}

#[derive(Debug, thiserror::Error, Advice)]
#[advice = "Correct the line: {self}"]
enum LineError {
    #[error("{0} columns")]
    Columns(usize),

    #[error("a blank")]
    Blank,

    #[error("a heading")]
    #[advice = "Leave the heading out"]
    Heading,
}

#[derive(Clone, Copy, Debug, thiserror::Error, Advice)]
#[error("{what} lies outside of {low} to {high}")]
#[advice = "Set {what} to {low:.1} to {high:.1}"]
struct WrittenError {
    what: &'static str,
    low: f64,
    high: f64,
}

#[derive(Debug, thiserror::Error, Advice)]
#[error("no thread")]
#[advice = "Close other programs and start again"]
struct NoThread;

#[derive(Debug, thiserror::Error, Advice)]
#[error("{0} is not known")]
#[advice = "Use another than {_0}"]
struct Unknown<'a, T: Display + Debug>(&'a T);

#[track_caller]
fn check(error: &(impl Advice + Display), message: &str, advice: &str) {
    assert_eq!(error.to_string(), message);
    assert_eq!(error.advice(), advice);
}

#[test]
fn a_sentence_may_have_fields_constants_and_arguments() {
    let path = PathBuf::from("a.ply");
    let error = FileError::NotFound { path: path.clone() };
    let advice = "Check the name and that the drive is connected";
    check(&error, "a.ply is not there", advice);
    let error = FileError::Malformed { path, line: 3 };
    let advice = "Correct line 3 of a.ply in a text editor";
    check(&error, "line 3 of a.ply is no number", advice);
    let json = "a.json".into();
    let advice = "Write it, for example {\"width\": 640}, with up to 8 numbers in {}";
    let error = FileError::MissingIntrinsics { json };
    check(&error, "a.json is missing", advice);
}

#[test]
fn an_expression_may_be_a_text_a_function_a_condition_or_a_method() {
    check(&FileError::NoParts, "no parts", EXAMPLE);
    check(&FileError::NoPlaces, "no places", EXAMPLE);
    for (kind, advice) in [
        (io::ErrorKind::StorageFull, "Make room on the disk"),
        (io::ErrorKind::TimedOut, "Check the disk"),
    ] {
        let source = kind.into();
        let path = "a.ply".into();
        let error = FileError::Write { path, source };
        check(&error, "cannot write a.ply", advice);
    }
    let error = FileError::NoSuchName("fander".into(), vec!["door", "fender"]);
    let message = r#"fander is none of ["door", "fender"]"#;
    check(&error, message, "The nearest name is fender");
    let error = FileError::TooFew { found: 1 };
    check(&error, "1 frames", "Add frames from other sides");
    let error = FileError::TooFew { found: 0 };
    check(&error, "0 frames", "Give the folder");
    let advice = "With nothing, nothing can be done";
    check(&FileError::Nothing {}, "nothing", advice);
}

#[test]
fn the_advice_of_an_inner_error_is_handed_on() {
    let error = OuterError::from(FileError::NoParts);
    check(&error, "no parts", EXAMPLE);
    let written = WrittenError {
        what: "gain",
        low: 0.25,
        high: 1.0,
    };
    let (message, advice) = ("gain lies outside of 0.25 to 1", "Set gain to 0.2 to 1.0");
    check(&written, message, advice);
    check(&OuterError::Boxed(written.into()), message, advice);
    let (name, error) = ("door".into(), FileError::NoParts);
    let error = OuterError::Damaged { name, error };
    check(&error, "door is damaged", EXAMPLE);
    let error = OuterError::OfParts(FileError::NoParts);
    check(&error, "no parts, for parts", EXAMPLE);
    let error = OuterError::OfParts(FileError::Nothing {});
    check(&error, "nothing, for parts", "Not with nothing, for parts");
    let path = "parts".into();
    let error = OuterError::OfParts(FileError::NotFound { path });
    let advice = "Enrol a part first";
    check(&error, "parts is not there, for parts", advice);
    let error = OuterError::Cancelled("the user".into());
    check(&error, "cancelled by the user", "Run it again");
}

#[test]
fn a_struct_has_its_advice_at_its_head() {
    let advice = "Close other programs and start again";
    check(&NoThread, "no thread", advice);
    check(&Unknown(&7), "7 is not known", "Use another than 7");
}

#[test]
fn the_advice_of_an_enum_is_for_variants_without_one() {
    check(
        &LineError::Columns(2),
        "2 columns",
        "Correct the line: 2 columns",
    );
    check(&LineError::Blank, "a blank", "Correct the line: a blank");
    check(&LineError::Heading, "a heading", "Leave the heading out");
}
