//! The parameters of a [`Recipe`] as shown to a person: name, unit, range, default and effect of each.
//!
//! [`PARAMETERS`] is their only list. The sliders of the window, the option `--set` ([`Setting`]) and the tables of
//! `docs/guide/parameters.md` follow from it; defaults are those of `Recipe::default()`. Other kinds of recipe
//! implement [`Parameters`] with lists of their own and share settings and files.

mod table;

use std::str::FromStr;

pub use self::table::PARAMETERS;
use super::{ExpectedPart, Recipe};
use files::nearest_name;
use geometry::{
    error::Advice,
    units::{Metres, Radians},
};

/// A set of parameters, such as a [`Recipe`].
pub trait Parameters: Clone + Default + PartialEq + 'static {
    /// Groups of the parameters.
    type Group: Copy + std::fmt::Debug + 'static;
    /// All parameters, group by group.
    const ALL: &'static [Parameter<Self>];

    /// The parts that it expects; `None` if such a set expects none.
    fn expect(&mut self) -> Option<&mut Vec<ExpectedPart>> {
        None
    }
}

impl Parameters for Recipe {
    type Group = Group;
    const ALL: &'static [Parameter] = PARAMETERS;

    fn expect(&mut self) -> Option<&mut Vec<ExpectedPart>> {
        Some(&mut self.expect)
    }
}

/// Where in the flow a parameter acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Removal of wall and floor, and choice of one surface.
    Segmentation,
    /// Projection of the part to a binary image.
    BinaryImage,
    /// Outline, openings and rays.
    Contour,
    /// Ranking of the references.
    Match,
    /// Confirmation and pose of the best references.
    Pose,
    /// ICP with a genetic algorithm, Algorithm 3.
    IcpGa,
    /// Limits for accepting a verdict.
    Acceptance,
    /// Stand-off along the assumed path.
    StandOff,
}

impl Group {
    /// Every group, in the order of the flow.
    pub const ALL: [Self; 8] = [
        Self::Segmentation,
        Self::BinaryImage,
        Self::Contour,
        Self::Match,
        Self::Pose,
        Self::IcpGa,
        Self::Acceptance,
        Self::StandOff,
    ];

    /// Title shown to the user.
    pub fn title(self) -> &'static str {
        match self {
            Self::Segmentation => "Segmentation",
            Self::BinaryImage => "Binary image",
            Self::Contour => "Contour and rays",
            Self::Match => "Match",
            Self::Pose => "Pose",
            Self::IcpGa => "ICP-GA",
            Self::Acceptance => "Acceptance",
            Self::StandOff => "Stand-off",
        }
    }
}

/// Whether a parameter is always shown, or only in the unfolded group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Always shown.
    Front,
    /// Shown in the unfolded group.
    Fold,
    /// Not shown: set in a recipe file or by `--set`.
    Hidden,
}

/// The unit that a value is shown in; unless stated, it is stored in metres, square metres or radians.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayUnit {
    /// A plain number.
    None,
    /// Millimetres.
    Millimetres,
    /// Square centimetres.
    SquareCentimetres,
    /// Square millimetres.
    SquareMillimetres,
    /// Degrees.
    Degrees,
    /// Millimetres per second; stored in metres per second.
    MillimetresPerSecond,
    /// Metres per second squared.
    MetresPerSecondSquared,
    /// Millilitres per minute; stored in cubic metres per second.
    MillilitresPerMinute,
    /// Micrometres.
    Micrometres,
    /// Per cent; stored as a share of 1.
    Percent,
}

impl DisplayUnit {
    /// The sign to put after a number, with its space; empty for a plain number.
    pub fn sign(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Millimetres => " mm",
            Self::SquareCentimetres => " cm²",
            Self::SquareMillimetres => " mm²",
            Self::Degrees => "°",
            Self::MillimetresPerSecond => " mm/s",
            Self::MetresPerSecondSquared => " m/s²",
            Self::MillilitresPerMinute => " ml/min",
            Self::Micrometres => " µm",
            Self::Percent => " %",
        }
    }

    /// Factor from the stored unit to this one.
    pub fn per_inner(self) -> f64 {
        match self {
            Self::None | Self::MetresPerSecondSquared => 1.0,
            Self::Millimetres | Self::MillimetresPerSecond => 1000.0,
            Self::SquareCentimetres => 1e4,
            Self::SquareMillimetres | Self::Micrometres => 1e6,
            Self::MillilitresPerMinute => 6e7,
            Self::Percent => 100.0,
            Self::Degrees => 180.0 / std::f64::consts::PI,
        }
    }
}

/// A parameter that is a number.
#[derive(Debug)]
pub struct Number<R = Recipe> {
    /// Unit that it is shown in.
    pub unit: DisplayUnit,
    /// Least and greatest valid value, in the unit shown.
    pub range: [f64; 2],
    /// Digits shown after the point.
    pub decimals: usize,
    /// Reads it, in the stored unit.
    pub get: fn(&R) -> f64,
    /// Writes it, in the stored unit.
    pub set: fn(&mut R, f64),
}

/// A parameter that is one of several options.
#[derive(Debug)]
pub struct Choice<R = Recipe> {
    /// The options, as shown and as written in settings.
    pub options: &'static [&'static str],
    /// Reads the index of the chosen option.
    pub get: fn(&R) -> usize,
    /// Chooses the option at this index.
    pub set: fn(&mut R, usize),
}

/// The kind of a parameter, with its unit and range, or its options.
#[derive(Debug)]
pub enum Kind<R = Recipe> {
    /// A number.
    Number(Number<R>),
    /// One of several options.
    Choice(Choice<R>),
}

/// A value as a set of parameters stores it.
pub trait StoredValue {
    /// The number that it stands for.
    fn read(&self) -> f64;
    /// Stores the number; a count is rounded.
    fn write(&mut self, number: f64);
}

impl StoredValue for f64 {
    fn read(&self) -> f64 {
        *self
    }

    fn write(&mut self, number: f64) {
        *self = number;
    }
}

macro_rules! stored_as_length_or_angle {
    ($($kind:ident)+) => {$(
        impl StoredValue for $kind {
            fn read(&self) -> f64 {
                self.0
            }

            fn write(&mut self, number: f64) {
                self.0 = number;
            }
        }
    )+};
}
stored_as_length_or_angle!(Metres Radians);

macro_rules! stored_as_count {
    ($($kind:ident)+) => {$(
        impl StoredValue for $kind {
            #[allow(clippy::cast_lossless, reason = "only those of small counts are lossless")]
            fn read(&self) -> f64 {
                *self as f64
            }

            fn write(&mut self, number: f64) {
                *self = number.round() as Self;
            }
        }
    )+};
}
stored_as_count!(usize u64 u16);

/// The row of a number in a table of parameters: path of the field, which is the key, too; name, group, place, unit, range
/// and decimals as shown, and help.
#[macro_export]
macro_rules! number_parameter {
    ($first:ident $(. $rest:ident)*, $name:literal, $group:path, $place:ident, $unit:ident, $range:expr, $decimals:literal, $help:literal) => {
        $crate::pipeline::parameters::Parameter {
            key: concat!(stringify!($first) $(, ".", stringify!($rest))*),
            name: $name,
            help: $help,
            group: $group,
            place: $crate::pipeline::parameters::Place::$place,
            kind: $crate::pipeline::parameters::Kind::Number($crate::pipeline::parameters::Number {
                unit: $crate::pipeline::parameters::DisplayUnit::$unit,
                range: $range,
                decimals: $decimals,
                get: |set| $crate::pipeline::parameters::StoredValue::read(&set.$first$(.$rest)*),
                set: |set, number| {
                    $crate::pipeline::parameters::StoredValue::write(&mut set.$first$(.$rest)*, number);
                },
            }),
        }
    };
}

/// A parameter of the recipe.
#[derive(Debug)]
pub struct Parameter<R: Parameters = Recipe> {
    /// Path in the recipe as written in settings and files, such as `segment.plane_distance`.
    pub key: &'static str,
    /// Name shown to the user.
    pub name: &'static str,
    /// What it does, and what raising it costs.
    pub help: &'static str,
    /// Group in which it is shown.
    pub group: R::Group,
    /// Place in its group.
    pub place: Place,
    /// Number or choice.
    pub kind: Kind<R>,
}

/// A value that a parameter cannot have.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
#[advice = "The previous value stays"]
pub enum BadValue {
    /// Outside the valid range.
    #[error("{name} cannot be {found}: it ranges from {range}")]
    OutOfRange {
        /// The parameter.
        name: String,
        /// The value given, with its unit.
        found: String,
        /// The valid range, in words.
        range: String,
    },
    /// There is no option at this index.
    #[error("{name} has no such value")]
    NoSuchOption {
        /// The parameter.
        name: String,
    },
}

impl BadValue {
    /// The same error with the parameter's key before its name.
    fn written_as(mut self, key: &str) -> Self {
        let (Self::OutOfRange { name, .. } | Self::NoSuchOption { name }) = &mut self;
        *name = format!("{key} ({name})");
        self
    }
}

impl<R: Parameters> Parameter<R> {
    /// The parameter of this key.
    pub fn of_key(key: &str) -> Option<&'static Self> {
        R::ALL.iter().find(|parameter| parameter.key == key)
    }

    /// The value in the unit shown, or the index of the option.
    pub fn value(&self, recipe: &R) -> f64 {
        match &self.kind {
            // Shows 0.01 as 10 mm, not as 10.000000000000002.
            Kind::Number(number) => {
                round_to_12_digits((number.get)(recipe) * number.unit.per_inner())
            }
            Kind::Choice(choice) => (choice.get)(recipe) as f64,
        }
    }

    /// Sets a number in the unit shown, or an option by its index; fails if the value is not valid.
    pub fn set(&self, recipe: &mut R, value: f64) -> Result<(), BadValue> {
        match &self.kind {
            Kind::Number(number) => {
                let [least, most] = number.range;
                if !(value >= least && value <= most) {
                    return Err(BadValue::OutOfRange {
                        name: self.name.to_owned(),
                        found: format!("{value}{}", number.unit.sign()),
                        range: self.range_text(),
                    });
                }
                (number.set)(recipe, value / number.unit.per_inner());
            }
            Kind::Choice(choice) => {
                if !(value >= 0.0 && value < choice.options.len() as f64) {
                    return Err(BadValue::NoSuchOption {
                        name: self.name.to_owned(),
                    });
                }
                (choice.set)(recipe, value as usize);
            }
        }
        Ok(())
    }

    /// Copies its value from one recipe to another.
    pub fn copy(&self, from: &R, to: &mut R) {
        match &self.kind {
            Kind::Number(number) => (number.set)(to, (number.get)(from)),
            Kind::Choice(choice) => (choice.set)(to, (choice.get)(from)),
        }
    }

    /// True if the two recipes differ in this parameter.
    pub fn differs(&self, a: &R, b: &R) -> bool {
        self.value(a).to_bits() != self.value(b).to_bits()
    }

    /// The valid range in words, or all options.
    pub fn range_text(&self) -> String {
        match &self.kind {
            Kind::Number(number) => {
                let [least, most] = number.range;
                format!("{least} to {most}{}", number.unit.sign())
            }
            Kind::Choice(choice) => choice.options.join(", "),
        }
    }

    /// The value as shown, with its unit.
    pub fn text(&self, recipe: &R) -> String {
        let value = self.value(recipe);
        match &self.kind {
            Kind::Number(number) => number.text(value),
            Kind::Choice(choice) => {
                let option = choice.options.get(value as usize);
                option.copied().unwrap_or_default().to_owned()
            }
        }
    }

    /// The value as in a [`Setting`], with all digits.
    pub fn setting_text(&self, recipe: &R) -> String {
        match &self.kind {
            Kind::Number(number) => format!("{}{}", self.value(recipe), number.unit.sign()),
            Kind::Choice(_) => self.text(recipe),
        }
    }
}

impl<R> Number<R> {
    /// Formats a value with its unit.
    pub fn text(&self, value: f64) -> String {
        format!("{value:.*}{}", self.decimals, self.unit.sign())
    }
}

/// Rounds to twelve digits, which removes the errors of a conversion of units.
fn round_to_12_digits(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// The parameters in which a recipe differs from the default one.
pub fn changed<R: Parameters>(recipe: &R) -> impl Iterator<Item = &'static Parameter<R>> {
    let default = R::default();
    R::ALL.iter().filter(move |p| p.differs(recipe, &default))
}

/// The parameters of [`changed`] except those of these keys, as `--set` takes them.
pub fn changed_settings(recipe: &Recipe, left_out: &[&str]) -> Vec<String> {
    let listed = changed(recipe).filter(|parameter| !left_out.contains(&parameter.key));
    listed
        .map(|parameter| format!("{}={}", parameter.key, parameter.setting_text(recipe)))
        .collect()
}

/// Number of parameters in which a recipe differs from the default one.
pub fn num_changed<R: Parameters>(recipe: &R) -> usize {
    changed(recipe).count()
}

/// True if every parameter has a value that it can be set to. Recipe files are checked as they are read; a recipe from
/// elsewhere may hold any value.
pub fn is_valid<R: Parameters>(recipe: &R) -> bool {
    let (mut set, mut copied) = (R::default(), R::default());
    let is_each_valid = R::ALL.iter().all(|parameter| {
        parameter.copy(recipe, &mut copied);
        parameter.set(&mut set, parameter.value(recipe)).is_ok()
    });
    if let Some((from, to)) = recipe.clone().expect().zip(copied.expect()) {
        to.clone_from(from);
    }
    // A choice only copies options that exist.
    is_each_valid && copied == *recipe
}

/// A parameter with a valid value, written as `segment.plane_distance=12`. The value is the name of an option, or a
/// number in the parameter's unit, which may follow it.
#[derive(Clone, Debug)]
pub struct Setting<R: Parameters = Recipe> {
    parameter: &'static Parameter<R>,
    /// Value for [`Parameter::set`].
    value: f64,
}

impl<R: Parameters> Setting<R> {
    /// Sets the value in a recipe.
    pub fn apply(&self, recipe: &mut R) {
        let is_set = self.parameter.set(recipe, self.value);
        assert!(is_set.is_ok(), "checked when it was read");
    }
}

/// Why a text is not a [`Setting`].
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
#[advice = "Write NAME=VALUE; docs/guide/parameters.md and docs/guide/paint.md list names, units and ranges"]
pub enum SettingError {
    /// The text has no equals sign.
    #[error("there is no = between name and value")]
    NoEquals,
    /// There is no parameter of this name.
    #[error("there is no parameter {name}{}", nearest.map(|nearest| format!("; the nearest is {nearest}")).unwrap_or_default())]
    UnknownName {
        /// The name given.
        name: String,
        /// The most similar name, if one is similar.
        nearest: Option<&'static str>,
    },
    /// Neither a number, nor an option of the parameter.
    #[error("{found} is not a value of {key}, which ranges from {range}")]
    NotANumber {
        /// The parameter.
        key: &'static str,
        /// The value given.
        found: String,
        /// The valid range, in words.
        range: String,
    },
    /// Not one of the options.
    #[error("{found} is not a value of {key}, which is one of {options}")]
    NotAnOption {
        /// The parameter.
        key: &'static str,
        /// The value given.
        found: String,
        /// All options.
        options: String,
    },
    /// A fraction of what is counted.
    #[error("{found} is not a value of {key}, which takes whole numbers")]
    NotWhole {
        /// The parameter.
        key: &'static str,
        /// The value given.
        found: String,
    },
    /// The value is outside the valid range.
    #[error(transparent)]
    BadValue(#[from] BadValue),
}

impl<R: Parameters> FromStr for Setting<R> {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let (name, written) = text.split_once('=').ok_or(SettingError::NoEquals)?;
        let (name, written) = (name.trim(), written.trim());
        let unknown = || SettingError::UnknownName {
            name: name.to_owned(),
            nearest: nearest_key::<R>(name),
        };
        let parameter = Parameter::of_key(name).ok_or_else(unknown)?;
        let (key, found) = (parameter.key, written.to_owned());
        let value = match &parameter.kind {
            Kind::Number(number) => {
                let digits = written.trim_end_matches(number.unit.sign().trim()).trim();
                let Ok(value) = digits.parse() else {
                    let range = parameter.range_text();
                    return Err(SettingError::NotANumber { key, found, range });
                };
                value
            }
            Kind::Choice(choice) => {
                let mut options = choice.options.iter();
                let index = options.position(|option| option.eq_ignore_ascii_case(written));
                index.ok_or_else(|| SettingError::NotAnOption {
                    key,
                    found: found.clone(),
                    options: parameter.range_text(),
                })? as f64
            }
        };
        let mut recipe = R::default();
        let set = parameter.set(&mut recipe, value);
        set.map_err(|error| error.written_as(key))?;
        let is_kept = (parameter.value(&recipe) - value).abs() <= 1e-9 * value.abs();
        if is_kept {
            Ok(Self { parameter, value })
        } else {
            Err(SettingError::NotWhole { key, found })
        }
    }
}

/// Returns the key that ends with the name, else the most similar one, if any is similar.
fn nearest_key<R: Parameters>(name: &str) -> Option<&'static str> {
    let keys = || R::ALL.iter().map(|parameter| parameter.key);
    let ends_so = keys().find(|key| key.rsplit('.').next() == Some(name));
    ends_so.or_else(|| nearest_name(keys(), name))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::Value;

    use super::*;
    use crate::pipeline::PoseChoice;
    use stages::pose::PoseMethod;

    /// Collects the paths of all values, descending into objects.
    fn leaves(value: &Value, path: &str, found: &mut BTreeSet<String>) {
        // The pose is one choice, even where it is written as an object.
        match value {
            Value::Object(fields) if path != "pose" => {
                for (name, value) in fields {
                    let path = if path.is_empty() {
                        name.clone()
                    } else {
                        format!("{path}.{name}")
                    };
                    leaves(value, &path, found);
                }
            }
            _ => {
                found.insert(path.to_owned());
            }
        }
    }

    #[test]
    fn every_parameter_of_the_recipe_is_in_the_table_once() {
        let written = serde_json::to_value(Recipe::default()).expect("written");
        let mut expected = BTreeSet::new();
        leaves(&written, "", &mut expected);
        let found: BTreeSet<String> = PARAMETERS.iter().map(|p| p.key.to_owned()).collect();
        assert_eq!(found, expected);
        assert_eq!(found.len(), PARAMETERS.len());
    }

    #[test]
    fn setting_a_parameter_changes_its_own_field_and_no_other() {
        for parameter in PARAMETERS {
            let default = Recipe::default();
            let mut changed = default.clone();
            let value = match &parameter.kind {
                Kind::Number(number) => {
                    let [least, most] = number.range;
                    assert!(parameter.value(&default) >= least, "{}", parameter.key);
                    assert!(parameter.value(&default) <= most, "{}", parameter.key);
                    if parameter.value(&default).to_bits() == most.to_bits() {
                        least
                    } else {
                        most
                    }
                }
                Kind::Choice(choice) => {
                    let next = parameter.value(&default) as usize + 1;
                    (next % choice.options.len()) as f64
                }
            };
            parameter.set(&mut changed, value).expect("valid");
            assert!((parameter.value(&changed) - value).abs() < 1e-9 * value.abs().max(1.0));
            let (before, after) = (
                serde_json::to_value(&default).expect("written"),
                serde_json::to_value(&changed).expect("written"),
            );
            let pointer = format!("/{}", parameter.key.replace('.', "/"));
            assert_ne!(before.pointer(&pointer), after.pointer(&pointer));
            let mut mended = after.clone();
            *mended.pointer_mut(&pointer).expect("there") =
                before.pointer(&pointer).expect("there").clone();
            assert_eq!(mended, before, "{} changes another", parameter.key);
            assert_eq!(num_changed(&changed), 1);
            parameter.copy(&default, &mut changed);
            assert_eq!(changed, default);
        }
    }

    #[test]
    fn what_is_out_of_range_is_refused_and_changes_nothing() {
        for parameter in PARAMETERS {
            let mut recipe = Recipe::default();
            let bad = match &parameter.kind {
                Kind::Number(number) => {
                    let [least, most] = number.range;
                    vec![least - 0.1, most + 0.1, f64::NAN, f64::INFINITY]
                }
                Kind::Choice(choice) => vec![choice.options.len() as f64, -1.0, f64::NAN],
            };
            for value in bad {
                let refused = parameter.set(&mut recipe, value).expect_err(parameter.key);
                assert!(refused.to_string().contains(parameter.name));
            }
            assert_eq!(recipe, Recipe::default());
        }
    }

    #[test]
    fn a_recipe_is_valid_if_all_its_values_are() {
        assert!(is_valid(&Recipe::default()));
        for parameter in PARAMETERS {
            let Kind::Number(number) = &parameter.kind else {
                continue;
            };
            let [least, most] = number.range;
            let with = |shown: f64| {
                let mut recipe = Recipe::default();
                (number.set)(&mut recipe, shown / number.unit.per_inner());
                recipe
            };
            assert!(is_valid(&with(least)) && is_valid(&with(most)));
            assert!(!is_valid(&with(most + 1.0)), "{}", parameter.key);
        }
        let mut recipe = Recipe {
            expect: vec!["fender".into()],
            ..Recipe::default()
        };
        assert!(is_valid(&recipe));
        recipe.accept.min_score = f64::NAN;
        assert!(!is_valid(&recipe));
        let mut recipe = Recipe::default();
        recipe.signature.num_rays = 300;
        assert!(!is_valid(&recipe));
    }

    #[test]
    fn every_parameter_explains_itself() {
        for parameter in PARAMETERS {
            assert!(parameter.help.len() > 40 && !parameter.name.is_empty());
            assert!(Group::ALL.contains(&parameter.group));
            assert!(!parameter.text(&Recipe::default()).is_empty());
        }
        let key = Parameter::of_key("segment.plane_distance").expect("there");
        assert_eq!(key.text(&Recipe::default()), "8.0 mm");
    }

    #[test]
    fn the_guide_lists_every_parameter_as_the_table_has_it() {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../docs/guide/parameters.md"
        );
        let guide = std::fs::read_to_string(path).expect("the guide");
        let default = Recipe::default();
        for group in Group::ALL {
            let title = group.title();
            let (_, section) = guide.split_once(&format!("\n## {title}\n")).expect(title);
            let section = section.split("\n## ").next().unwrap_or_default();
            let is_row = |line: &&str| line.starts_with("| `");
            let written: Vec<&str> = section.lines().filter(is_row).collect();
            let of_group = PARAMETERS.iter().filter(|p| p.group == group);
            let expected: Vec<String> = of_group
                .map(|p| {
                    let name = match p.place {
                        Place::Front => format!("**{}**", p.name),
                        Place::Fold | Place::Hidden => p.name.to_owned(),
                    };
                    let (text, range) = (p.text(&default), p.range_text());
                    format!("| `{}` | {name} | {text} | {range} | {} |", p.key, p.help)
                })
                .collect();
            assert_eq!(written, expected, "{title}");
        }
    }

    #[test]
    fn a_setting_is_read_in_the_unit_of_its_parameter() {
        let set = |text: &str| {
            let mut recipe = Recipe::default();
            let setting: Setting = text.parse().expect(text);
            setting.apply(&mut recipe);
            recipe
        };
        for text in [
            "segment.plane_distance=12",
            " segment.plane_distance = 12 mm ",
        ] {
            assert!((set(text).segment.plane_distance.mm() - 12.0).abs() < 1e-12);
        }
        assert!((set("icp_ga.turn_range=90°").icp_ga.turn_range.degrees() - 90.0).abs() < 1e-9);
        assert!((set("segment.min_part_area=100 cm²").segment.min_part_area - 0.01).abs() < 1e-12);
        assert_eq!(set("signature.num_rays=512").signature.num_rays, 512);
        assert_eq!(set("pose=icp-ga").pose, PoseChoice::By(PoseMethod::IcpGa));
        assert_eq!(set("icp.max_iterations=7").icp.max_iterations, 7);
        for parameter in PARAMETERS {
            let text = format!("{}={}", parameter.key, parameter.text(&Recipe::default()));
            assert_eq!(num_changed(&set(&text)), 0, "{text}");
        }
    }

    #[test]
    fn a_setting_that_is_none_names_the_range_or_the_nearest_name() {
        let refused = |text: &str| text.parse::<Setting>().expect_err(text).to_string();
        for (text, expected) in [
            ("segment.plane_distance", "no ="),
            ("plane_distance=8", "nearest is segment.plane_distance"),
            (
                "segment.plane_distances=8",
                "nearest is segment.plane_distance",
            ),
            ("icp_ga.sed=8", "nearest is icp_ga.seed"),
            ("segment.plane_distance=90", "from 1 to 50 mm"),
            ("segment.plane_distance=90", "segment.plane_distance ("),
            ("segment.plane_distance=8 cm", "from 1 to 50 mm"),
            ("segment.plane_distance=nan", "from 1 to 50 mm"),
            ("icp.max_iterations=1.5", "whole numbers"),
            ("rank.matcher=best", "one of Default, Paper"),
            ("signature.num_rays=300", "one of 64, 128"),
        ] {
            let message = refused(text);
            assert!(message.contains(expected), "{text}: {message}");
        }
        assert_eq!(refused("nosuch=8"), "there is no parameter nosuch");
    }
}
