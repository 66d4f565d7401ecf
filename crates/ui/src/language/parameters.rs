//! Texts of the parameters of recipes, coats and programs. In English, names and helps are those of the tables
//! ([`Parameters::ALL`]), which the command line shows too.

use super::catalogue::translated;
use inspection::pipeline::{
    Recipe,
    parameters::{Group, Kind, Parameter, Parameters},
};
use robot::{
    paint::{Coat, CoatGroup},
    program::ProgramParams,
};

/// Returns the title of a group of recipe parameters.
pub fn group(group: Group) -> String {
    match group {
        Group::Segmentation => text!("results-group-segmentation"),
        Group::BinaryImage => text!("results-group-binary-image"),
        Group::Contour => text!("results-group-contour"),
        Group::Match => text!("results-group-match"),
        Group::Pose => text!("shell-pose"),
        Group::IcpGa => text!("results-group-icp-ga"),
        Group::Acceptance => text!("results-group-acceptance"),
        Group::StandOff => text!("results-group-stand-off"),
    }
}

/// Returns the title of a group of coat parameters.
pub fn coat_group(group: CoatGroup) -> String {
    match group {
        CoatGroup::Gun => text!("coat-group-gun"),
        CoatGroup::Path => text!("coat-group-path"),
        CoatGroup::Film => text!("coat-group-film"),
    }
}

/// Notes of the program's coats.
const PRIMER: &str = "Two-component primer filler: thick, high solids, slow enough to fill.";
const BASE_COAT: &str = "Water-borne base coat: thin, low solids, colour and effect; rows close together against clouds.";
const CLEAR_COAT: &str = "Two-component clear coat: thick and wet, gloss comes from an even film.";

/// Translates the notes of the program's coats, which coats made from them keep; returns any others unchanged.
pub fn coat_notes(notes: &str) -> String {
    match notes {
        PRIMER => text!("coat-notes-primer"),
        BASE_COAT => text!("coat-notes-base-coat"),
        CLEAR_COAT => text!("coat-notes-clear-coat"),
        own => own.to_owned(),
    }
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
    let option = |option: &&str| match *option {
        "Default" => text!("results-option-default"),
        "Paper" => text!("results-option-paper"),
        "Global" => text!("results-option-global"),
        "None" => text!("results-option-none"),
        "Gaussian" => text!("coat-option-gaussian"),
        "Beta" => text!("coat-option-beta"),
        "Raster" => text!("coat-option-raster"),
        "Cross-hatch" => text!("coat-option-cross-hatch"),
        "Contour" => text!("coat-option-contour"),
        "Principal axis" => text!("coat-option-principal-axis"),
        "Angle" => text!("coat-option-angle"),
        number_or_method => number_or_method.to_owned(),
    };
    choice.options.iter().map(option).collect()
}

/// Formats a parameter's value as text.
pub fn value<R: Parameters>(parameter: &Parameter<R>, recipe: &R) -> String {
    let mut option = options(parameter).into_iter();
    let option = option.nth(parameter.value(recipe) as usize);
    option.unwrap_or_else(|| parameter.text(recipe))
}

/// The messages with the names of all parameters, and the helps of those that the window shows, in all languages
/// but English.
#[cfg(test)]
pub(super) fn message_ids() -> Vec<String> {
    use inspection::pipeline::parameters::Place;

    fn of_table<R: TranslatedParameters>() -> impl Iterator<Item = String> {
        R::ALL.iter().flat_map(|parameter| {
            let is_shown = parameter.place != Place::Hidden;
            let help = is_shown.then(|| help_id(parameter));
            [name_id(parameter)].into_iter().chain(help)
        })
    }
    let of_inspection = of_table::<Recipe>();
    let of_paint = of_table::<Coat>().chain(of_table::<ProgramParams>());
    of_inspection.chain(of_paint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Language;
    use inspection::pipeline::parameters::Place;
    use robot::paint::{BUILT_IN_COATS, built_in_coat};

    fn check_table<R: TranslatedParameters>() {
        for parameter in R::ALL {
            assert_eq!(name(parameter), parameter.name);
            if parameter.place != Place::Hidden {
                assert_eq!(help(parameter), parameter.help);
                Language::Chinese.make_current();
                assert_ne!(help(parameter), parameter.help);
                Language::English.make_current();
            }
            if let Kind::Choice(choice) = &parameter.kind {
                assert_eq!(options(parameter), choice.options);
            }
        }
    }

    #[test]
    fn the_notes_of_the_programs_coats_are_translated() {
        let coats = BUILT_IN_COATS.map(|name| built_in_coat(name).expect("a coat"));
        for coat in &coats {
            assert_eq!(coat_notes(&coat.notes), coat.notes);
        }
        Language::Spanish.make_current();
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
        for of in Group::ALL {
            assert_eq!(group(of), of.title());
        }
        for of in CoatGroup::ALL {
            assert_eq!(coat_group(of), of.title());
        }
    }
}
