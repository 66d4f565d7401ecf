//! All parameters of a [`Coat`], a row each; `--set`, files of coats and the guide are derived from it.

use super::{Coat, Pattern, Profile, RowDirection};
use inspection::{
    number_parameter as number,
    pipeline::parameters::{Choice, Kind, Parameter, Parameters, Place},
};

/// Range of β.
pub(crate) const BETA_RANGE: [f64; 2] = [1.0, 10.0];
/// Range of the pattern's width, millimetres.
pub(crate) const WIDTH_RANGE_MM: [f64; 2] = [10.0, 1000.0];
/// Range of the transfer efficiency, per cent.
pub(crate) const TRANSFER_RANGE_PERCENT: [f64; 2] = [1.0, 100.0];

/// Group of a coat's parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoatGroup {
    /// Gun and paint.
    Gun,
    /// Path.
    Path,
    /// Target film.
    Film,
}

impl CoatGroup {
    /// Every group.
    pub const ALL: [Self; 3] = [Self::Gun, Self::Path, Self::Film];

    /// Title shown to people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Gun => "Gun and paint",
            Self::Path => "Path",
            Self::Film => "Film",
        }
    }
}

macro_rules! choice {
    ($key:literal, $name:literal, $group:ident, $($field:ident).+, [$($option:literal => $value:path),+], $help:literal) => {
        Parameter {
            key: $key,
            name: $name,
            help: $help,
            group: CoatGroup::$group,
            place: Place::Front,
            kind: Kind::Choice(Choice {
                options: &[$($option),+],
                get: |c| [$($value),+].iter().position(|value| *value == c.$($field).+).unwrap_or(0),
                set: |c, index| c.$($field).+ = [$($value),+][index],
            }),
        }
    };
}

impl Parameters for Coat {
    type Group = CoatGroup;
    const ALL: &'static [Parameter<Self>] = TABLE;
}

#[rustfmt::skip]
const TABLE: &[Parameter<Coat>] = &[
    choice!("gun.profile", "Profile", Gun, gun.profile, ["Gaussian" => Profile::Gaussian, "Beta" => Profile::Beta],
        "How the paint is spread over the jet: an elliptical Gaussian, or a beta profile that ends at its edge."),
    number!(gun.width, "Pattern width", CoatGroup::Gun, Front, Millimetres, WIDTH_RANGE_MM, 0,
        "Width of the pattern across the direction of travel at the measured distance: 4σ of a Gaussian, all of a \
         beta profile. Wider needs fewer rows and loses more paint at edges."),
    number!(gun.depth, "Pattern depth", CoatGroup::Gun, Front, Millimetres, [5.0, 1000.0], 0,
        "Depth of the pattern along the direction of travel at the measured distance, defined like the width. Deeper \
         blurs the ends of rows."),
    number!(gun.beta, "Beta", CoatGroup::Gun, Fold, None, BETA_RANGE, 1,
        "β of a beta profile (1 - r²)^(β-1): 1 is even up to the edge, higher values gather the paint in the middle. A Gaussian does not use it."),
    number!(gun.distance, "Measured at", CoatGroup::Gun, Fold, Millimetres, [30.0, 1000.0], 0,
        "Distance from the mouth at which width and depth were measured. The jet widens in proportion to the distance."),
    number!(gun.flow, "Paint flow", CoatGroup::Gun, Front, MillilitresPerMinute, [1.0, 5000.0], 0,
        "Paint through the gun while it sprays. The film is thicker in proportion to the flow."),
    number!(gun.transfer, "Transfer efficiency", CoatGroup::Gun, Front, Percent, TRANSFER_RANGE_PERCENT, 0,
        "Share of the sprayed paint that flies to the part; the rest is mist. What passes beyond the part's edges is \
         counted separately."),
    number!(gun.solids, "Solids", CoatGroup::Gun, Front, Percent, [1.0, 100.0], 0,
        "Share of the paint's volume that stays as dry film. The paint's data sheet gives it."),
    choice!("pattern", "Pattern", Path, pattern,
        ["Raster" => Pattern::Raster, "Cross-hatch" => Pattern::CrossHatch, "Contour" => Pattern::Contour],
        "Raster: rows side by side. Cross-hatch: a second raster across the first, so twice the film. Contour: closed rings along the outline and around wide openings, from the outside in."),
    choice!("direction", "Rows along", Path, direction, ["Principal axis" => RowDirection::Principal, "Angle" => RowDirection::Angle],
        "Principal axis: rows along the part's longest extent, the fewest turns. Angle: at the angle below."),
    number!(angle, "Angle of the rows", CoatGroup::Path, Fold, Degrees, [-90.0, 90.0], 0,
        "Angle of the rows from the part's x axis, turning towards its y axis. Used only if the rows run at an angle."),
    number!(spacing, "Row spacing", CoatGroup::Path, Front, Millimetres, [5.0, 500.0], 0,
        "Distance between rows, measured along the curved surface. At two thirds of the pattern's width, rows overlap by a third. Closer rows are more even and take longer."),
    number!(stand_off, "Stand-off", CoatGroup::Path, Front, Millimetres, [30.0, 600.0], 0,
        "From the gun's mouth to the surface along the jet. Farther spreads the jet wider and evens out corners."),
    number!(speed, "Speed", CoatGroup::Path, Front, MillimetresPerSecond, [10.0, 3000.0], 0,
        "Speed of the jet over the surface; the gun itself runs faster around outer curves. The film is thinner in \
         proportion to the speed."),
    number!(overrun, "Overrun", CoatGroup::Path, Front, Millimetres, [0.0, 400.0], 0,
        "How far beyond the edge the gun still sprays. Raising it evens out the edges and wastes paint; half the pattern's width loses nothing at the edge."),
    number!(lead, "Lead-in and lead-out", CoatGroup::Path, Fold, Millimetres, [0.0, 500.0], 0,
        "Extra travel with the gun off at both ends of a row, so that the gun sprays at full speed. Raising it costs \
         time."),
    number!(opening, "Openings crossed below", CoatGroup::Path, Fold, Millimetres, [0.0, 2000.0], 0,
        "Where a row crosses an opening narrower than this, the gun stays on. Wider openings are crossed with the gun off, beyond the overrun."),
    number!(margin, "Margin of keep-outs", CoatGroup::Path, Fold, Millimetres, [0.0, 400.0], 0,
        "The gun is off within keep-out regions and this far around them. Half the pattern's width keeps nearly all paint out."),
    number!(smoothing, "Smoothing", CoatGroup::Path, Fold, Millimetres, [10.0, 300.0], 0,
        "Width over which the surface is smoothed before the gun follows it. Raising it calms the gun over ribs and steps and cuts corners."),
    number!(tilt_limit, "Tilt limit", CoatGroup::Path, Front, Degrees, [0.0, 80.0], 0,
        "How far the gun may lean from the direction in which the part is painted. Raising it follows steep flanks \
         and swings the wrist at corners."),
    number!(acceleration, "Acceleration", CoatGroup::Path, Fold, MetresPerSecondSquared, [0.0, 20.0], 1,
        "Largest acceleration of the gun along a stroke, where its speed varies to even out the film. Raising it follows smaller details; 0 keeps the speed constant."),
    number!(flank_lean, "Lean to flanks", CoatGroup::Path, Fold, Degrees, [0.0, 60.0], 0,
        "How far the gun leans towards steep flanks in short strokes that are added if less than 95 % of the surface would be within the tolerance. They take much of the path's time; 0 adds none."),
    number!(point_spacing, "Point spacing", CoatGroup::Path, Fold, Millimetres, [5.0, 200.0], 0,
        "Distance between the points of the path. Closer follows curves better and makes longer robot programs."),
    number!(target, "Target thickness", CoatGroup::Film, Front, Micrometres, [0.5, 2000.0], 1,
        "Wanted thickness of the dry film after this coat. A proposed speed brings the film to it."),
    number!(tolerance, "Tolerance", CoatGroup::Film, Front, Percent, [1.0, 90.0], 0,
        "How far from the target the film may be and still count as right."),
];

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::pipeline::parameters::num_changed;

    fn written(coat: &Coat) -> serde_json::Value {
        serde_json::to_value(coat).expect("written")
    }

    #[test]
    fn every_parameter_changes_its_own_field_and_no_other() {
        let count = |value: &serde_json::Value| match value {
            serde_json::Value::Object(fields) => fields
                .values()
                .map(|v| v.as_object().map_or(1, serde_json::Map::len))
                .sum(),
            _ => 0,
        };
        assert_eq!(count(&written(&Coat::default())), Coat::ALL.len());
        for parameter in Coat::ALL {
            let default = Coat::default();
            let mut coat = default;
            let value = match &parameter.kind {
                Kind::Number(number) => {
                    let [least, most] = number.range;
                    let value = parameter.value(&default);
                    assert!((least..=most).contains(&value), "{}", parameter.key);
                    assert!(parameter.set(&mut coat, most + 1.0).is_err());
                    assert!(parameter.set(&mut coat, f64::NAN).is_err());
                    if value.to_bits() == most.to_bits() {
                        least
                    } else {
                        most
                    }
                }
                Kind::Choice(choice) => {
                    ((parameter.value(&default) as usize + 1) % choice.options.len()) as f64
                }
            };
            parameter.set(&mut coat, value).expect("valid");
            let pointer = format!("/{}", parameter.key.replace('.', "/"));
            let (before, mut after) = (written(&default), written(&coat));
            assert_ne!(before.pointer(&pointer), after.pointer(&pointer));
            *after.pointer_mut(&pointer).expect("there") =
                before.pointer(&pointer).expect("there").clone();
            assert_eq!(after, before, "{}", parameter.key);
            assert_eq!(num_changed(&coat), 1);
            assert!(parameter.help.len() > 40);
        }
    }

    #[test]
    fn the_guide_lists_every_parameter_as_the_table_has_it() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guide/paint.md");
        let guide = std::fs::read_to_string(path).expect("the guide");
        let default = Coat::default();
        for group in CoatGroup::ALL {
            let title = group.title();
            let (_, section) = guide.split_once(&format!("\n### {title}\n")).expect(title);
            let section = section.split("\n#").next().unwrap_or_default();
            let rows = section.lines().filter(|line| line.starts_with("| `"));
            let expected = Coat::ALL.iter().filter(|p| p.group == group).map(|p| {
                let name = match p.place {
                    Place::Front => format!("**{}**", p.name),
                    Place::Fold | Place::Hidden => p.name.to_owned(),
                };
                let (text, range) = (p.text(&default), p.range_text());
                format!("| `{}` | {name} | {text} | {range} | {} |", p.key, p.help)
            });
            assert_eq!(rows.collect::<Vec<_>>(), expected.collect::<Vec<_>>());
        }
    }
}
