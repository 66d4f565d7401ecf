//! Texts of the parameters of recipes, coats and programs. In English, they are those of the tables ([`Parameters::ALL`]) and
//! of the program's coats, which the command line shows too.

use std::sync::LazyLock;

use super::catalogue::translated;
use inspection::pipeline::{
    Recipe,
    parameters::{Group, Kind, Parameter, Parameters},
};
use robot::{
    paint::{BUILT_IN_COATS, Coat, CoatGroup, built_in_coat},
    program::ProgramParams,
};

/// Returns the title of a group of recipe parameters.
pub fn group(group: Group) -> String {
    translated(group_id(group), group.title())
}

fn group_id(group: Group) -> &'static str {
    match group {
        Group::Segmentation => "results-group-segmentation",
        Group::BinaryImage => "results-group-binary-image",
        Group::Contour => "results-group-contour",
        Group::Match => "results-group-match",
        Group::Pose => "results-group-pose",
        Group::IcpGa => "results-group-icp-ga",
        Group::Acceptance => "results-group-acceptance",
        Group::StandOff => "results-group-stand-off",
    }
}

/// Returns the title of a group of coat parameters.
pub fn coat_group(group: CoatGroup) -> String {
    translated(coat_group_id(group), group.title())
}

fn coat_group_id(group: CoatGroup) -> &'static str {
    match group {
        CoatGroup::Gun => "coat-group-gun",
        CoatGroup::Path => "coat-group-path",
        CoatGroup::Film => "coat-group-film",
    }
}

/// Returns the title of one of the program's coats; the name of any other.
pub fn coat_title(name: &str) -> String {
    if BUILT_IN_COATS.contains(&name) {
        translated(&coat_title_id(name), &name.replace('_', " "))
    } else {
        name.to_owned()
    }
}

/// The message with the title of the program's coat of this name.
fn coat_title_id(name: &str) -> String {
    format!("coat-title-{}", name.replace('_', "-"))
}

/// Translates the notes of the program's coats, which coats made from them keep; returns any others unchanged.
pub fn coat_notes(notes: &str) -> String {
    static KNOWN: LazyLock<Vec<(&str, String)>> = LazyLock::new(|| {
        let coats = BUILT_IN_COATS.into_iter();
        let coats = coats.filter_map(|name| Some((name, built_in_coat(name)?.notes)));
        coats.collect()
    });
    match KNOWN.iter().find(|(_, known)| known == notes) {
        Some((name, _)) => translated(&coat_notes_id(name), notes),
        None => notes.to_owned(),
    }
}

/// The message with the notes of the program's coat of this name.
fn coat_notes_id(name: &str) -> String {
    format!("coat-notes-{}", name.replace('_', "-"))
}

/// Parameters whose texts are in the files of the window's languages.
pub trait TranslatedParameters: Parameters {
    /// The area of the texts.
    const AREA: &'static str;
}

impl TranslatedParameters for Recipe {
    const AREA: &'static str = "results";
}

impl TranslatedParameters for Coat {
    const AREA: &'static str = "coat";
}

impl TranslatedParameters for ProgramParams {
    const AREA: &'static str = "program";
}

/// Returns the name of a parameter.
pub fn name<R: TranslatedParameters>(parameter: &Parameter<R>) -> String {
    translated(&name_id(parameter), parameter.name)
}

/// Describes what a parameter does, and what raising it costs.
pub fn help<R: TranslatedParameters>(parameter: &Parameter<R>) -> String {
    translated(&help_id(parameter), parameter.help)
}

/// The message with the name of a parameter: that of `segment.plane_distance` is `results-segment-plane-distance`.
fn name_id<R: TranslatedParameters>(parameter: &Parameter<R>) -> String {
    format!("{}-{}", R::AREA, parameter.key.replace(['.', '_'], "-"))
}

/// The message with the help of a parameter that the window shows.
fn help_id<R: TranslatedParameters>(parameter: &Parameter<R>) -> String {
    format!("{}-help", name_id(parameter))
}

/// Returns the options of a choice, in order; none for a number.
pub fn options<R: Parameters>(parameter: &Parameter<R>) -> Vec<String> {
    let Kind::Choice(choice) = &parameter.kind else {
        return Vec::new();
    };
    choice.options.iter().copied().map(option).collect()
}

/// Returns the name of an option; numbers and names of methods are not translated.
pub fn option(option: &str) -> String {
    match option_id(option) {
        Some(id) => translated(id, option),
        None => option.to_owned(),
    }
}

fn option_id(option: &str) -> Option<&'static str> {
    Some(match option {
        "Default" => "results-option-default",
        "Paper" => "results-option-paper",
        "Global" => "results-option-global",
        "None" => "results-option-none",
        "Gaussian" => "coat-option-gaussian",
        "Beta" => "coat-option-beta",
        "Raster" => "coat-option-raster",
        "Cross-hatch" => "coat-option-cross-hatch",
        "Contour" => "coat-option-contour",
        "Principal axis" => "coat-option-principal-axis",
        "Angle" => "coat-option-angle",
        _ => return None,
    })
}

/// Formats a parameter's value as text.
pub fn value<R: Parameters>(parameter: &Parameter<R>, recipe: &R) -> String {
    let mut option = options(parameter).into_iter();
    let option = option.nth(parameter.value(recipe) as usize);
    option.unwrap_or_else(|| parameter.text(recipe))
}

/// The messages with what the tables and the program's coats have in English, in all other languages: of helps, those that
/// the window shows.
#[cfg(test)]
pub(super) fn message_ids() -> Vec<String> {
    use inspection::pipeline::parameters::Place;

    fn of_table<R: TranslatedParameters>() -> impl Iterator<Item = String> {
        R::ALL.iter().flat_map(|parameter| {
            let is_shown = parameter.place != Place::Hidden;
            let help = is_shown.then(|| help_id(parameter));
            let options = match &parameter.kind {
                Kind::Choice(choice) => choice.options,
                Kind::Number(_) => &[],
            };
            let options = options.iter().filter_map(|option| option_id(option));
            let options = options.map(str::to_owned);
            [name_id(parameter)].into_iter().chain(help).chain(options)
        })
    }
    let of_inspection = of_table::<Recipe>();
    let of_paint = of_table::<Coat>().chain(of_table::<ProgramParams>());
    let groups = Group::ALL.map(group_id).into_iter();
    let groups = groups.chain(CoatGroup::ALL.map(coat_group_id));
    let titles = BUILT_IN_COATS.map(coat_title_id);
    let notes = BUILT_IN_COATS.map(coat_notes_id);
    of_inspection
        .chain(of_paint)
        .chain(groups.map(str::to_owned))
        .chain(titles)
        .chain(notes)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Language;
    use inspection::pipeline::parameters::Place;

    fn check_table<R: TranslatedParameters>() {
        for parameter in R::ALL {
            assert_eq!(name(parameter), parameter.name);
            if parameter.place != Place::Hidden {
                assert_eq!(help(parameter), parameter.help);
                Language::Chinese.make_current();
                assert_ne!(help(parameter), parameter.help);
                Language::English.make_current();
            }
        }
    }

    #[test]
    fn titles_and_notes_of_the_programs_coats_are_translated() {
        let coats = BUILT_IN_COATS.map(|name| built_in_coat(name).expect("a coat"));
        for coat in &coats {
            assert_eq!(coat_notes(&coat.notes), coat.notes);
        }
        assert_eq!(coat_title("base_coat"), "base coat");
        Language::Spanish.make_current();
        assert_eq!(coat_title("base_coat"), "base de color");
        assert_eq!(coat_title("roof_coat"), "roof_coat");
        for coat in &coats {
            assert_ne!(coat_notes(&coat.notes), coat.notes);
        }
        assert_eq!(coat_notes("For the roof"), "For the roof");
    }

    #[test]
    fn every_parameter_is_translated_from_what_the_command_line_shows() {
        check_table::<Recipe>();
        check_table::<Coat>();
        check_table::<ProgramParams>();
    }
}
