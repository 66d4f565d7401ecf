//! The parameters of a [`Recipe`], as a person sees them: name, unit, range, default and what each does.
//!
//! [`PARAMETERS`] is their only list. The sliders of the window, the option `--set` ([`Setting`]) and the tables of
//! `docs/guide/parameters.md` follow from it; defaults are those of `Recipe::default()`. Other recipes have lists of their
//! own by [`Parameters`], and the same settings and files.

mod table;

use std::str::FromStr;

pub use self::table::PARAMETERS;
use super::Recipe;
use crate::{error::Advice, files::nearest_name};

/// What is made of parameters, such as a [`Recipe`].
pub trait Parameters: Clone + Default + PartialEq + 'static {
    /// What its parameters are grouped by.
    type Group: Copy + std::fmt::Debug + 'static;
    /// All of them, group by group.
    const ALL: &'static [Parameter<Self>];
}

impl Parameters for Recipe {
    type Group = Group;
    const ALL: &'static [Parameter] = PARAMETERS;
}

/// Where in the flow a parameter acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Wall and floor away, one surface left.
    Segmentation,
    /// The part in its plane.
    BinaryImage,
    /// Outline, openings and rays.
    Contour,
    /// Which parts are alike.
    Match,
    /// The best few put in their place.
    Pose,
    /// ICP with a genetic algorithm, Algorithm 3.
    IcpGa,
    /// When a verdict counts.
    Acceptance,
    /// How far the taught path would be off.
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

    /// What a person calls it.
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

/// Whether a parameter is in front or in the fold of its group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Always seen.
    Front,
    /// In the fold.
    Fold,
}

/// The unit that a value is shown in; inside it is metres, square metres or radians.
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
    /// Millimetres a second; inside it is metres a second.
    MillimetresPerSecond,
    /// Millilitres a minute; inside it is cubic metres a second.
    MillilitresPerMinute,
    /// Thousandths of a millimetre.
    Micrometres,
    /// Hundredths; inside it is a share of 1.
    Percent,
}

impl DisplayUnit {
    /// Its sign, after a number; empty for a plain one.
    pub fn sign(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Millimetres => " mm",
            Self::SquareCentimetres => " cm²",
            Self::SquareMillimetres => " mm²",
            Self::Degrees => "°",
            Self::MillimetresPerSecond => " mm/s",
            Self::MillilitresPerMinute => " ml/min",
            Self::Micrometres => " µm",
            Self::Percent => " %",
        }
    }

    /// How many of it are one of the unit used inside.
    pub fn per_inner(self) -> f64 {
        match self {
            Self::None => 1.0,
            Self::Millimetres | Self::MillimetresPerSecond => 1000.0,
            Self::SquareCentimetres => 1e4,
            Self::SquareMillimetres | Self::Micrometres => 1e6,
            Self::MillilitresPerMinute => 6e7,
            Self::Percent => 100.0,
            Self::Degrees => 180.0 / std::f64::consts::PI,
        }
    }
}

/// A number among the parameters, in the unit it is shown in.
#[derive(Debug)]
pub struct Number<R = Recipe> {
    /// The unit.
    pub unit: DisplayUnit,
    /// Least and greatest valid value.
    pub range: [f64; 2],
    /// Digits after the point.
    pub decimals: usize,
    /// Reads it, in the unit used inside.
    pub get: fn(&R) -> f64,
    /// Writes it, in the unit used inside.
    pub set: fn(&mut R, f64),
}

/// A choice among the parameters.
#[derive(Debug)]
pub struct Choice<R = Recipe> {
    /// The options, as a person reads them.
    pub options: &'static [&'static str],
    /// Reads the place of the option.
    pub get: fn(&R) -> usize,
    /// Takes the option at a place.
    pub set: fn(&mut R, usize),
}

/// What a parameter is.
#[derive(Debug)]
pub enum Kind<R = Recipe> {
    /// A number.
    Number(Number<R>),
    /// One of a few.
    Choice(Choice<R>),
}

/// A parameter of the recipe.
#[derive(Debug)]
pub struct Parameter<R: Parameters = Recipe> {
    /// Its path in the recipe as it is written, such as `segment.plane_distance`.
    pub key: &'static str,
    /// What a person calls it.
    pub name: &'static str,
    /// What it does, and what raising it costs.
    pub help: &'static str,
    /// Where it acts.
    pub group: R::Group,
    /// Where it is found.
    pub place: Place,
    /// What it is.
    pub kind: Kind<R>,
}

/// A value that a parameter cannot have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BadValue {
    /// Outside the valid range.
    #[error("{name} cannot be {found}: it goes from {range}")]
    OutOfRange {
        /// The parameter.
        name: String,
        /// The value given, with its unit.
        found: String,
        /// The valid range, in words.
        range: String,
    },
    /// There is no such option, or the parameter is of another kind.
    #[error("{name} has no such value")]
    NoSuchOption {
        /// The parameter.
        name: String,
    },
}

impl BadValue {
    /// The same of a parameter that was written by its key.
    fn written_as(mut self, key: &str) -> Self {
        let (Self::OutOfRange { name, .. } | Self::NoSuchOption { name }) = &mut self;
        *name = format!("{key} ({name})");
        self
    }
}

impl Advice for BadValue {
    fn advice(&self) -> String {
        "The value before it stays".into()
    }
}

impl<R: Parameters> Parameter<R> {
    /// The parameter of this key.
    pub fn of_key(key: &str) -> Option<&'static Self> {
        R::ALL.iter().find(|parameter| parameter.key == key)
    }

    /// Its number in the unit shown, or the place of its option.
    pub fn value(&self, recipe: &R) -> f64 {
        match &self.kind {
            // 0.01 is 10 mm, not 10.000000000000002.
            Kind::Number(number) => {
                round_to_12_digits((number.get)(recipe) * number.unit.per_inner())
            }
            Kind::Choice(choice) => (choice.get)(recipe) as f64,
        }
    }

    /// Gives it a number in the unit shown, or an option by its place; what is not valid is refused.
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

    /// Gives it the value that it has in another recipe.
    pub fn copy(&self, from: &R, to: &mut R) {
        match &self.kind {
            Kind::Number(number) => (number.set)(to, (number.get)(from)),
            Kind::Choice(choice) => (choice.set)(to, (choice.get)(from)),
        }
    }

    /// True if the two recipes differ in it.
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

    /// Its value in words.
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
}

impl<R: Parameters> Parameter<R> {
    /// Its value as a [`Setting`] takes it, with all digits.
    pub fn setting_text(&self, recipe: &R) -> String {
        match &self.kind {
            Kind::Number(number) => format!("{}{}", self.value(recipe), number.unit.sign()),
            Kind::Choice(_) => self.text(recipe),
        }
    }
}

impl<R> Number<R> {
    /// A value with its unit.
    pub fn text(&self, value: f64) -> String {
        format!("{value:.*}{}", self.decimals, self.unit.sign())
    }
}

/// Twelve digits: what a change of units leaves behind is gone.
fn round_to_12_digits(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// The parameters in which a recipe differs from the default one.
pub fn changed<R: Parameters>(recipe: &R) -> impl Iterator<Item = &'static Parameter<R>> {
    let default = R::default();
    R::ALL.iter().filter(move |p| p.differs(recipe, &default))
}

/// The parameters of [`changed`] but those of these keys, as `--set` takes them.
pub fn changed_settings(recipe: &Recipe, left_out: &[&str]) -> Vec<String> {
    let listed = changed(recipe).filter(|parameter| !left_out.contains(&parameter.key));
    listed
        .map(|parameter| format!("{}={}", parameter.key, parameter.setting_text(recipe)))
        .collect()
}

/// How many there are.
pub fn num_changed<R: Parameters>(recipe: &R) -> usize {
    changed(recipe).count()
}

/// A parameter with a valid value for it, written as `segment.plane_distance=12`: the value in the unit of the
/// parameter, which may follow it, or the name of an option.
#[derive(Clone, Debug)]
pub struct Setting<R: Parameters = Recipe> {
    parameter: &'static Parameter<R>,
    /// As [`Parameter::set`] takes it.
    value: f64,
}

impl<R: Parameters> Setting<R> {
    /// Gives the recipe this value.
    pub fn apply(&self, recipe: &mut R) {
        let is_set = self.parameter.set(recipe, self.value);
        assert!(is_set.is_ok(), "checked when it was read");
    }
}

/// Why a text is no [`Setting`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SettingError {
    /// No equals sign.
    #[error("there is no = between name and value")]
    NoEquals,
    /// No parameter of this name.
    #[error("there is no parameter {name}; the nearest is {nearest}")]
    UnknownName {
        /// The name given.
        name: String,
        /// The name that is most like it.
        nearest: &'static str,
    },
    /// Neither a number, nor an option of the parameter.
    #[error("{found} is no value of {key}, which goes from {range}")]
    NotANumber {
        /// The parameter.
        key: &'static str,
        /// The value given.
        found: String,
        /// The valid range, in words.
        range: String,
    },
    /// Not one of the options.
    #[error("{found} is no value of {key}, which is one of {options}")]
    NotAnOption {
        /// The parameter.
        key: &'static str,
        /// The value given.
        found: String,
        /// All options.
        options: String,
    },
    /// A fraction of what is counted.
    #[error("{found} is no value of {key}, which takes whole numbers")]
    NotWhole {
        /// The parameter.
        key: &'static str,
        /// The value given.
        found: String,
    },
    /// Outside the valid range.
    #[error(transparent)]
    BadValue(#[from] BadValue),
}

impl Advice for SettingError {
    fn advice(&self) -> String {
        "Write NAME=VALUE; docs/guide/parameters.md and docs/guide/paint.md list names, units and ranges".into()
    }
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
                let place = options.position(|option| option.eq_ignore_ascii_case(written));
                place.ok_or_else(|| SettingError::NotAnOption {
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

/// The key that is most like a name, or ends with it.
fn nearest_key<R: Parameters>(name: &str) -> &'static str {
    let keys = || R::ALL.iter().map(|parameter| parameter.key);
    let ends_so = keys().find(|key| key.rsplit('.').next() == Some(name));
    ends_so
        .or_else(|| nearest_name(keys(), name))
        .expect("there are parameters")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::Value;

    use super::*;
    use crate::{pipeline::PoseChoice, stages::pose::PoseMethod};

    /// The paths of all numbers and words; an object of further ones is gone into.
    fn leaves(value: &Value, path: &str, found: &mut BTreeSet<String>) {
        // The pose is one choice, however it is written.
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
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/guide/parameters.md");
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
                        Place::Fold => p.name.to_owned(),
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
    }
}
