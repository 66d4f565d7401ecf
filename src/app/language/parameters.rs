//! Texts of the parameters of recipes and coats. In English they equal those of the tables ([`Parameters::ALL`]), which the
//! command line shows. No two tables share a key.

use crate::{
    paint::CoatGroup,
    pipeline::parameters::{Group, Kind, Parameter, Parameters},
};

/// Returns the title of a group of recipe parameters.
pub(in crate::app) fn group(group: Group) -> String {
    match group {
        Group::Segmentation => text!("results-group-segmentation"),
        Group::BinaryImage => text!("results-group-binary-image"),
        Group::Contour => text!("results-group-contour"),
        Group::Match => text!("results-group-match"),
        Group::Pose => text!("results-group-pose"),
        Group::IcpGa => text!("results-group-icp-ga"),
        Group::Acceptance => text!("results-group-acceptance"),
        Group::StandOff => text!("results-group-stand-off"),
    }
}

/// Returns the title of a group of coat parameters.
pub(in crate::app) fn coat_group(group: CoatGroup) -> String {
    match group {
        CoatGroup::Gun => text!("coat-group-gun"),
        CoatGroup::Path => text!("coat-group-path"),
        CoatGroup::Film => text!("coat-group-film"),
    }
}

/// Returns the name of a parameter.
pub(in crate::app) fn name<R: Parameters>(parameter: &Parameter<R>) -> String {
    match parameter.key {
        "segment.plane_distance" => text!("results-segment-plane-distance"),
        "segment.noise_at_1m" => text!("results-segment-noise-at-1m"),
        "segment.noise_factor" => text!("results-segment-noise-factor"),
        "segment.good_sample_probability" => text!("results-segment-good-sample-probability"),
        "segment.max_planes" => text!("results-segment-max-planes"),
        "segment.link_distance" => text!("results-segment-link-distance"),
        "segment.min_part_area" => text!("results-segment-min-part-area"),
        "segment.seed" => text!("results-segment-seed"),
        "project.pixel" => text!("results-project-pixel"),
        "project.closed_gap" => text!("results-project-closed-gap"),
        "contour.min_opening_area" => text!("results-contour-min-opening-area"),
        "signature.num_rays" => text!("results-signature-num-rays"),
        "signature.smoothing" => text!("results-signature-smoothing"),
        "rank.matcher" => text!("results-rank-matcher"),
        "rank.num_overlaid" => text!("results-rank-num-overlaid"),
        "rank.outline_tolerance" => text!("results-rank-outline-tolerance"),
        "rank.parallel_from" => text!("results-rank-parallel-from"),
        "pose" => text!("results-pose"),
        "confirm.num_references" => text!("results-confirm-num-references"),
        "confirm.tolerance" => text!("results-confirm-tolerance"),
        "confirm.seed" => text!("results-confirm-seed"),
        "icp.max_iterations" => text!("results-icp-max-iterations"),
        "icp.target_e_m2" => text!("results-icp-target-e-m2"),
        "icp.max_source_points" => text!("results-icp-max-source-points"),
        "icp.shift_tolerance" => text!("results-icp-shift-tolerance"),
        "icp.turn_tolerance" => text!("results-icp-turn-tolerance"),
        "icp_ga.target_e_m2" => text!("results-icp-ga-target-e-m2"),
        "icp_ga.max_rounds" => text!("results-icp-ga-max-rounds"),
        "icp_ga.patience" => text!("results-icp-ga-patience"),
        "icp_ga.least_progress" => text!("results-icp-ga-least-progress"),
        "icp_ga.vicinity_range" => text!("results-icp-ga-vicinity-range"),
        "icp_ga.turn_range" => text!("results-icp-ga-turn-range"),
        "icp_ga.shift_range" => text!("results-icp-ga-shift-range"),
        "icp_ga.num_fine_points" => text!("results-icp-ga-num-fine-points"),
        "icp_ga.num_coarse_points" => text!("results-icp-ga-num-coarse-points"),
        "icp_ga.seed" => text!("results-icp-ga-seed"),
        "icp_ga.icp.max_iterations" => text!("results-icp-ga-icp-max-iterations"),
        "icp_ga.icp.target_e_m2" => text!("results-icp-ga-icp-target-e-m2"),
        "icp_ga.icp.max_source_points" => text!("results-icp-ga-icp-max-source-points"),
        "icp_ga.icp.shift_tolerance" => text!("results-icp-ga-icp-shift-tolerance"),
        "icp_ga.icp.turn_tolerance" => text!("results-icp-ga-icp-turn-tolerance"),
        "icp_ga.vicinity.population" => text!("results-icp-ga-vicinity-population"),
        "icp_ga.vicinity.generations" => text!("results-icp-ga-vicinity-generations"),
        "icp_ga.vicinity.tournament" => text!("results-icp-ga-vicinity-tournament"),
        "icp_ga.vicinity.crossover_rate" => text!("results-icp-ga-vicinity-crossover-rate"),
        "icp_ga.vicinity.mutation_rate" => text!("results-icp-ga-vicinity-mutation-rate"),
        "icp_ga.vicinity.mutation_decades" => text!("results-icp-ga-vicinity-mutation-decades"),
        "icp_ga.vicinity.half_turn_rate" => text!("results-icp-ga-vicinity-half-turn-rate"),
        "icp_ga.elsewhere.population" => text!("results-icp-ga-elsewhere-population"),
        "icp_ga.elsewhere.generations" => text!("results-icp-ga-elsewhere-generations"),
        "icp_ga.elsewhere.tournament" => text!("results-icp-ga-elsewhere-tournament"),
        "icp_ga.elsewhere.crossover_rate" => text!("results-icp-ga-elsewhere-crossover-rate"),
        "icp_ga.elsewhere.mutation_rate" => text!("results-icp-ga-elsewhere-mutation-rate"),
        "icp_ga.elsewhere.mutation_decades" => text!("results-icp-ga-elsewhere-mutation-decades"),
        "icp_ga.elsewhere.half_turn_rate" => text!("results-icp-ga-elsewhere-half-turn-rate"),
        "accept.min_score" => text!("results-accept-min-score"),
        "accept.min_likeness" => text!("results-accept-min-likeness"),
        "accept.min_margin" => text!("results-accept-min-margin"),
        "accept.unknown_below" => text!("results-accept-unknown-below"),
        "accept.max_relief" => text!("results-accept-max-relief"),
        "accept.max_missing" => text!("results-accept-max-missing"),
        "accept.max_outline_shift" => text!("results-accept-max-outline-shift"),
        "accept.max_uncertainty" => text!("results-accept-max-uncertainty"),
        "stand_off.taught" => text!("results-stand-off-taught"),
        "stand_off.nearest" => text!("results-stand-off-nearest"),
        "stand_off.farthest" => text!("results-stand-off-farthest"),
        "stand_off.num_rays" => text!("results-stand-off-num-rays"),
        key => coat_name(key).unwrap_or_else(|| parameter.name.to_owned()),
    }
}

/// Returns the name of a coat parameter; `None` for another key.
fn coat_name(key: &str) -> Option<String> {
    Some(match key {
        "gun.profile" => text!("coat-gun-profile"),
        "gun.width" => text!("coat-gun-width"),
        "gun.depth" => text!("coat-gun-depth"),
        "gun.beta" => text!("coat-gun-beta"),
        "gun.distance" => text!("coat-gun-distance"),
        "gun.flow" => text!("coat-gun-flow"),
        "gun.transfer" => text!("coat-gun-transfer"),
        "gun.solids" => text!("coat-gun-solids"),
        "pattern" => text!("coat-pattern"),
        "direction" => text!("coat-direction"),
        "angle" => text!("coat-angle"),
        "spacing" => text!("coat-spacing"),
        "stand_off" => text!("coat-stand-off"),
        "speed" => text!("coat-speed"),
        "overrun" => text!("coat-overrun"),
        "lead" => text!("coat-lead"),
        "opening" => text!("coat-opening"),
        "margin" => text!("coat-margin"),
        "smoothing" => text!("coat-smoothing"),
        "tilt_limit" => text!("coat-tilt-limit"),
        "point_spacing" => text!("coat-point-spacing"),
        "target" => text!("coat-target"),
        "tolerance" => text!("coat-tolerance"),
        _ => return None,
    })
}

/// Describes what a parameter does, and what raising it costs.
pub(in crate::app) fn help<R: Parameters>(parameter: &Parameter<R>) -> String {
    match parameter.key {
        "segment.plane_distance" => text!("results-segment-plane-distance-help"),
        "segment.noise_at_1m" => text!("results-segment-noise-at-1m-help"),
        "segment.noise_factor" => text!("results-segment-noise-factor-help"),
        "segment.good_sample_probability" => text!("results-segment-good-sample-probability-help"),
        "segment.max_planes" => text!("results-segment-max-planes-help"),
        "segment.link_distance" => text!("results-segment-link-distance-help"),
        "segment.min_part_area" => text!("results-segment-min-part-area-help"),
        "segment.seed" => text!("results-segment-seed-help"),
        "project.pixel" => text!("results-project-pixel-help"),
        "project.closed_gap" => text!("results-project-closed-gap-help"),
        "contour.min_opening_area" => text!("results-contour-min-opening-area-help"),
        "signature.num_rays" => text!("results-signature-num-rays-help"),
        "signature.smoothing" => text!("results-signature-smoothing-help"),
        "rank.matcher" => text!("results-rank-matcher-help"),
        "rank.num_overlaid" => text!("results-rank-num-overlaid-help"),
        "rank.outline_tolerance" => text!("results-rank-outline-tolerance-help"),
        "rank.parallel_from" => text!("results-rank-parallel-from-help"),
        "pose" => text!("results-pose-help"),
        "confirm.num_references" => text!("results-confirm-num-references-help"),
        "confirm.tolerance" => text!("results-confirm-tolerance-help"),
        "confirm.seed" => text!("results-confirm-seed-help"),
        "icp.max_iterations" => text!("results-icp-max-iterations-help"),
        "icp.target_e_m2" => text!("results-icp-target-e-m2-help"),
        "icp.max_source_points" => text!("results-icp-max-source-points-help"),
        "icp.shift_tolerance" => text!("results-icp-shift-tolerance-help"),
        "icp.turn_tolerance" => text!("results-icp-turn-tolerance-help"),
        "icp_ga.target_e_m2" => text!("results-icp-ga-target-e-m2-help"),
        "icp_ga.max_rounds" => text!("results-icp-ga-max-rounds-help"),
        "icp_ga.patience" => text!("results-icp-ga-patience-help"),
        "icp_ga.least_progress" => text!("results-icp-ga-least-progress-help"),
        "icp_ga.vicinity_range" => text!("results-icp-ga-vicinity-range-help"),
        "icp_ga.turn_range" => text!("results-icp-ga-turn-range-help"),
        "icp_ga.shift_range" => text!("results-icp-ga-shift-range-help"),
        "icp_ga.num_fine_points" => text!("results-icp-ga-num-fine-points-help"),
        "icp_ga.num_coarse_points" => text!("results-icp-ga-num-coarse-points-help"),
        "icp_ga.seed" => text!("results-icp-ga-seed-help"),
        "icp_ga.icp.max_iterations" => text!("results-icp-ga-icp-max-iterations-help"),
        "icp_ga.icp.target_e_m2" => text!("results-icp-ga-icp-target-e-m2-help"),
        "icp_ga.icp.max_source_points" => text!("results-icp-ga-icp-max-source-points-help"),
        "icp_ga.icp.shift_tolerance" => text!("results-icp-ga-icp-shift-tolerance-help"),
        "icp_ga.icp.turn_tolerance" => text!("results-icp-ga-icp-turn-tolerance-help"),
        "icp_ga.vicinity.population" | "icp_ga.elsewhere.population" => {
            text!("results-icp-ga-vicinity-population-help")
        }
        "icp_ga.vicinity.generations" | "icp_ga.elsewhere.generations" => {
            text!("results-icp-ga-vicinity-generations-help")
        }
        "icp_ga.vicinity.tournament" | "icp_ga.elsewhere.tournament" => {
            text!("results-icp-ga-vicinity-tournament-help")
        }
        "icp_ga.vicinity.crossover_rate" | "icp_ga.elsewhere.crossover_rate" => {
            text!("results-icp-ga-vicinity-crossover-rate-help")
        }
        "icp_ga.vicinity.mutation_rate" | "icp_ga.elsewhere.mutation_rate" => {
            text!("results-icp-ga-vicinity-mutation-rate-help")
        }
        "icp_ga.vicinity.mutation_decades" | "icp_ga.elsewhere.mutation_decades" => {
            text!("results-icp-ga-vicinity-mutation-decades-help")
        }
        "icp_ga.vicinity.half_turn_rate" | "icp_ga.elsewhere.half_turn_rate" => {
            text!("results-icp-ga-vicinity-half-turn-rate-help")
        }
        "accept.min_score" => text!("results-accept-min-score-help"),
        "accept.min_likeness" => text!("results-accept-min-likeness-help"),
        "accept.min_margin" => text!("results-accept-min-margin-help"),
        "accept.unknown_below" => text!("results-accept-unknown-below-help"),
        "accept.max_relief" => text!("results-accept-max-relief-help"),
        "accept.max_missing" => text!("results-accept-max-missing-help"),
        "accept.max_outline_shift" => text!("results-accept-max-outline-shift-help"),
        "accept.max_uncertainty" => text!("results-accept-max-uncertainty-help"),
        "stand_off.taught" => text!("results-stand-off-taught-help"),
        "stand_off.nearest" => text!("results-stand-off-nearest-help"),
        "stand_off.farthest" => text!("results-stand-off-farthest-help"),
        "stand_off.num_rays" => text!("results-stand-off-num-rays-help"),
        key => coat_help(key).unwrap_or_else(|| parameter.help.to_owned()),
    }
}

/// Describes what a coat parameter does; `None` for another key.
fn coat_help(key: &str) -> Option<String> {
    Some(match key {
        "gun.profile" => text!("coat-gun-profile-help"),
        "gun.width" => text!("coat-gun-width-help"),
        "gun.depth" => text!("coat-gun-depth-help"),
        "gun.beta" => text!("coat-gun-beta-help"),
        "gun.distance" => text!("coat-gun-distance-help"),
        "gun.flow" => text!("coat-gun-flow-help"),
        "gun.transfer" => text!("coat-gun-transfer-help"),
        "gun.solids" => text!("coat-gun-solids-help"),
        "pattern" => text!("coat-pattern-help"),
        "direction" => text!("coat-direction-help"),
        "angle" => text!("coat-angle-help"),
        "spacing" => text!("coat-spacing-help"),
        "stand_off" => text!("coat-stand-off-help"),
        "speed" => text!("coat-speed-help"),
        "overrun" => text!("coat-overrun-help"),
        "lead" => text!("coat-lead-help"),
        "opening" => text!("coat-opening-help"),
        "margin" => text!("coat-margin-help"),
        "smoothing" => text!("coat-smoothing-help"),
        "tilt_limit" => text!("coat-tilt-limit-help"),
        "point_spacing" => text!("coat-point-spacing-help"),
        "target" => text!("coat-target-help"),
        "tolerance" => text!("coat-tolerance-help"),
        _ => return None,
    })
}

/// Returns the options of a choice, in order; none for a number.
pub(in crate::app) fn options<R: Parameters>(parameter: &Parameter<R>) -> Vec<String> {
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
pub(in crate::app) fn value<R: Parameters>(parameter: &Parameter<R>, recipe: &R) -> String {
    let mut option = options(parameter).into_iter();
    let option = option.nth(parameter.value(recipe) as usize);
    option.unwrap_or_else(|| parameter.text(recipe))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{paint::Coat, pipeline::Recipe};

    fn check_table<R: Parameters>() {
        let (source, _) = include_str!("parameters.rs")
            .split_once("mod tests")
            .expect("the code");
        for parameter in R::ALL {
            let quoted = format!("\"{}\"", parameter.key);
            assert_eq!(source.matches(&quoted).count(), 2, "{}", parameter.key);
            assert_eq!(name(parameter), parameter.name);
            assert_eq!(help(parameter), parameter.help);
            if let Kind::Choice(choice) = &parameter.kind {
                assert_eq!(options(parameter), choice.options);
            }
        }
    }

    #[test]
    fn every_parameter_is_translated_from_what_the_command_line_shows() {
        check_table::<Recipe>();
        check_table::<Coat>();
        for of in Group::ALL {
            assert_eq!(group(of), of.title());
        }
        for of in CoatGroup::ALL {
            assert_eq!(coat_group(of), of.title());
        }
        // A key has a single text, whichever table it is in.
        for parameter in Coat::ALL {
            let of_recipe = Parameter::<Recipe>::of_key(parameter.key);
            assert!(of_recipe.is_none(), "{}", parameter.key);
        }
    }
}
