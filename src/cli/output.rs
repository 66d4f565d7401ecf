//! Output of `inspect`: JSON, a card, or rows under a heading.

use std::path::PathBuf;

use super::{
    console::Console,
    surface::surface_words,
    verdict::{accepted_or_not, in_column, in_robot_words, place_of, show_card},
};
use files::visible;
use inspection::{
    library::Library,
    pipeline::{Identification, Inspection},
};
use station::Inspected;

/// Form of the results.
pub(super) enum OutputFormat {
    Json,
    Card,
    Rows(Columns),
}

impl OutputFormat {
    pub(super) fn head(&self, console: &mut Console) {
        if let Self::Rows(columns) = self {
            columns.head(console);
        }
    }

    pub(super) fn unreadable(&self, scene: &str, line: &str, console: &mut Console) {
        match self {
            Self::Json => console.line(&line),
            Self::Card => {}
            Self::Rows(columns) => columns.row(scene, "-", "unreadable", "", console),
        }
    }

    /// Shows the parts of a scene; `line` is that of all.
    pub(super) fn inspected(
        &self,
        scene: &str,
        line: &str,
        parts: &[Inspected<'_>],
        library: &Library,
        console: &mut Console,
    ) {
        if matches!(self, Self::Json) {
            console.line(&line);
            return;
        }
        for (number, part) in (1..).zip(parts) {
            let shown = match parts.len() {
                1 => scene.to_owned(),
                num => format!("{scene}, {number} of {num}"),
            };
            match self {
                Self::Json => {}
                Self::Card => {
                    show_card(&shown, part, library, console);
                    for (what, text) in surface_words(part.inspection) {
                        console.entry(what, &text);
                    }
                }
                Self::Rows(columns) => columns.inspected(&shown, part, library, console),
            }
        }
        if matches!(self, Self::Card) {
            for place in Inspected::empty_places(parts) {
                console.entry("place", &format_args!("{place}: empty"));
            }
        }
        self.expected(parts, console);
    }

    /// Shows whether the parts of a scene are those that are expected.
    fn expected(&self, parts: &[Inspected<'_>], console: &mut Console) {
        let all: Vec<&Inspection> = parts.iter().map(|part| part.inspection).collect();
        let Some(expected) = parts.first().map(|part| &part.recipe.expected) else {
            return;
        };
        let missing = expected.missing(&all);
        match self {
            Self::Card if expected.is_empty() => {}
            Self::Card if !missing.is_empty() => {
                let missing: Vec<String> = missing.iter().map(ToString::to_string).collect();
                console.entry("missing", &missing.join(", "));
            }
            Self::Card if expected.is_met(&all) => console.entry("parts", &"as expected"),
            Self::Rows(columns) => {
                for part in missing {
                    columns.row("", &part.to_string(), "missing", "", console);
                }
            }
            Self::Card | Self::Json => {}
        }
    }
}

/// Widths of the first two columns. Rows are written as they come, so the widths must be known beforehand.
pub(super) struct Columns {
    scene: usize,
    part: usize,
}

impl Columns {
    pub(super) fn for_files(files: &[PathBuf], library: &Library) -> Self {
        let scenes = files
            .iter()
            .map(|f| f.display().to_string().chars().count());
        // The longest that may hang there in place of each.
        let parts = library.references.iter().map(|reference| {
            let longest = in_column(Identification::MirrorImage, &reference.name);
            longest.chars().count()
        });
        Self {
            scene: scenes.max().unwrap_or(0).max("SCENE".len()),
            part: parts.max().unwrap_or(0).max("unknown".len()),
        }
    }

    /// Uses a typical width, since the names of captures are not known beforehand.
    pub(super) fn for_captures(library: &Library) -> Self {
        Self {
            scene: "simulated frame 12345".len(),
            ..Self::for_files(&[], library)
        }
    }

    pub(super) fn head(&self, console: &mut Console) {
        let figures = format!(
            "{:>5} {:>6}  {:>23}  {:>23}  {:>5} {:>7}",
            "SCORE", "MARGIN", "MIDDLE X Y Z mm", "TURN X Y Z degrees", "RMS", "TIME ms"
        );
        self.row("SCENE", "PART", "VERDICT", &figures, console);
    }

    fn row(&self, scene: &str, part: &str, verdict: &str, figures: &str, console: &mut Console) {
        let Self {
            scene: scene_width,
            part: part_width,
        } = *self;
        let scene = visible(scene);
        let row = format!("{scene:<scene_width$}  {part:<part_width$}  {verdict:<12}  {figures}");
        console.line(&row.trim_end());
    }

    pub(super) fn inspected(
        &self,
        scene: &str,
        inspected: &Inspected<'_>,
        library: &Library,
        console: &mut Console,
    ) {
        let inspection = inspected.inspection;
        let time_ms = inspection.timings.total.as_secs_f64() * 1000.0;
        let verdict = &inspection.verdict;
        let figures = verdict.score().map_or_else(String::new, |[score, margin]| {
            let triple = |[a, b, c]: [f64; 3]| format!("{a:7.1} {b:7.1} {c:7.1}");
            let is_named = verdict.is_named();
            let (middle, turn) = place_of(inspection, library)
                .filter(|_| is_named)
                .map_or_else(Default::default, |(middle, turn)| {
                    (triple(middle), triple(turn))
                });
            let rms = match &inspection.pose {
                Some(Ok(pose)) if is_named => format!("{:.1}", pose.fit.rms_m * 1000.0),
                _ => String::new(),
            };
            format!("{score:5.2} {margin:6.2}  {middle:>23}  {turn:>23}  {rms:>5} {time_ms:7.1}")
        });
        let found = verdict.identification();
        let part = in_column(found, verdict.guess().unwrap_or_default());
        self.row(scene, &part, accepted_or_not(verdict), &figures, console);
        if let Some([why, what_to_do]) = inspection.verdict.complaint() {
            console.line(&format_args!("    why not  {why}"));
            console.line(&format_args!("    to do    {what_to_do}"));
        }
        for (what, text) in surface_words(inspection) {
            console.line(&format_args!("    {what:<8} {text}"));
        }
        // A row has the camera's numbers, and room to say why a robot gets none.
        if !inspected.doubts().is_empty() {
            for (what, text) in in_robot_words(inspected, library) {
                console.line(&format_args!("    {what:<8} {text}"));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::fixtures::shipped_library;

    #[test]
    fn the_column_of_parts_holds_whatever_may_hang_there() {
        let library = shipped_library();
        let columns = Columns::for_files(&[], &library);
        for found in [
            Identification::Part,
            Identification::AnotherMake,
            Identification::AnotherModel,
            Identification::MirrorImage,
            Identification::OtherHalf,
            Identification::NotRecognised,
            Identification::Unknown { is_like: true },
            Identification::Unknown { is_like: false },
            Identification::NoPart,
        ] {
            for reference in &library.references {
                let named = in_column(found, &reference.name);
                assert!(named.chars().count() <= columns.part, "{named}");
            }
        }
    }
}
