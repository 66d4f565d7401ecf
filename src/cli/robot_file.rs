//! Writing a file for a robot, and what the commands print about it.

use super::{
    Outcome,
    console::{Advised as _, Console},
};
use geometry::{error::Advice as _, units::counted};
use robot::spray::{BandStatus, CarriedPath, MOST_TILT};
use station::{
    Doubt, Inspected,
    robot_file::{RobotFile, RobotFileContent, RobotFileError, WrittenRobotFile},
};
use texts::Message;

/// Writes the file and prints what it contains, which doubts it was written despite, and what was not checked. Returns
/// `None` if there are doubts and it is not forced.
pub(super) fn write(
    file: &RobotFile<'_>,
    console: &Console,
) -> anyhow::Result<Option<WrittenRobotFile>> {
    let written = match file.write() {
        Ok(written) => written,
        Err(RobotFileError::Doubts(doubts)) => {
            refuse(file, &doubts, console);
            return Ok(None);
        }
        error => error.advised()?,
    };
    let title = match file.content {
        RobotFileContent::Poses { convention, .. } => convention.title(),
        RobotFileContent::Program { language, .. } => language.title.to_owned(),
    };
    console.note(&format_args!(
        "{}: {} as {title}; {}",
        file.file.display(),
        counted(file.carried.points.len(), "point", "points"),
        against_seen(file.carried)
    ));
    if written.num_called > 0 {
        console.note(&format_args!(
            "  it calls {} programs that lie beside it; the controller needs all of them",
            written.num_called
        ));
    }
    if let Some(film) = &written.film {
        console.note(&format_args!("  film: {film}"));
    }
    for doubt in &written.doubts {
        console.note(&format_args!("warning: written by --force: {doubt}"));
    }
    for unchecked in &written.unchecked {
        let what = Message::new("not-checked").with("what", &*unchecked.to_string());
        console.warn(&what, unchecked);
    }
    Ok(Some(written))
}

/// Prints why nothing is written after this inspection, before its path is looked at.
pub(super) fn refuse_inspection(what: &str, seen: &Inspected<'_>, console: &Console) -> Outcome {
    if let Some(doubt) = seen.doubts().first() {
        console.advise(
            &format_args!("no {what} was written: {doubt}"),
            &doubt.advice(),
        );
    }
    Outcome::NotAccepted
}

/// Prints why nothing was written, and what to do about the first doubt.
fn refuse(file: &RobotFile<'_>, doubts: &[Doubt], console: &Console) {
    let Some((first, rest)) = doubts.split_first() else {
        return;
    };
    let what = match file.content {
        RobotFileContent::Poses { .. } => "spray path",
        RobotFileContent::Program { .. } => "program",
    };
    console.note(&format_args!("no {what} was written: {first}"));
    for doubt in rest {
        console.note(&format_args!("  also: {doubt}"));
    }
    let part = file.part;
    let advice = match first {
        Doubt::OffThePart(off) => format!(
            "{} (partsight library path {part} shows it), or plan a new one",
            off.advice()
        ),
        Doubt::NotReached(_) if file.capture.is_none() => format!(
            "Run partsight path check {part} with the same options to see why, and whether another --base reaches more, or change the path"
        ),
        doubt => doubt.advice(),
    };
    let forced = if doubts.iter().all(Doubt::may_be_forced) {
        "; --force writes it anyway"
    } else {
        ""
    };
    console.note(&format_args!("  to do: {advice}{forced}"));
}

/// Describes how many points of a carried path are within the band, of those that could be checked against the capture.
fn against_seen(carried: &CarriedPath) -> String {
    let num_seen = carried.num_seen();
    let verb = |num: usize, one: &'static str, many| if num == 1 { one } else { many };
    let num_inside = carried.num_inside();
    let mut words = format!(
        "of {num_seen} that {} at what was seen of the part, {num_inside} {} within the band",
        verb(num_seen, "aims", "aim"),
        verb(num_inside, "is", "are")
    );
    let num_flat = carried.count(BandStatus::TooFlat);
    if num_flat > 0 {
        words = format!(
            "{words}, {num_flat} {} it at more than {:.0}°, as strokes that lean towards flanks may",
            verb(num_flat, "meets", "meet"),
            MOST_TILT.degrees()
        );
    }
    words
}
