//! A parameter of a [`Recipe`], as a person sees it: what it is called, its unit, its range, and how it is set.

pub use super::parameter_table::PARAMETERS;
use crate::pipeline::Recipe;

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
pub enum Unit {
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
}

impl Unit {
    /// Its sign, after a number; empty for a plain one.
    pub fn sign(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Millimetres => " mm",
            Self::SquareCentimetres => " cm²",
            Self::SquareMillimetres => " mm²",
            Self::Degrees => "°",
        }
    }

    /// How many of it are one of the unit used inside.
    pub fn per_inner(self) -> f64 {
        match self {
            Self::None => 1.0,
            Self::Millimetres => 1000.0,
            Self::SquareCentimetres => 1e4,
            Self::SquareMillimetres => 1e6,
            Self::Degrees => 180.0 / std::f64::consts::PI,
        }
    }
}

/// A number among the parameters, in the unit it is shown in.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// The unit.
    pub unit: Unit,
    /// Least and greatest valid value.
    pub range: [f64; 2],
    /// Digits after the point.
    pub decimals: usize,
    pub(super) get: fn(&Recipe) -> f64,
    pub(super) set: fn(&mut Recipe, f64),
}

/// A choice among the parameters.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// The options, as a person reads them.
    pub options: &'static [&'static str],
    pub(super) get: fn(&Recipe) -> usize,
    pub(super) set: fn(&mut Recipe, usize),
}

/// What a parameter is.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A number.
    Number(Number),
    /// One of a few.
    Choice(Choice),
}

/// A parameter of the recipe.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its path in the recipe as it is written, such as `segment.plane_distance`.
    pub key: &'static str,
    /// What a person calls it.
    pub name: &'static str,
    /// What it does, and what raising it costs.
    pub help: &'static str,
    /// Where it acts.
    pub group: Group,
    /// Where it is found.
    pub place: Place,
    /// What it is.
    pub kind: Kind,
}

/// A value that a parameter cannot have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BadValue {
    /// Outside the valid range.
    #[error("{name} cannot be {found}: it goes {range}")]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// The value given, with its unit.
        found: String,
        /// The valid range, in words.
        range: String,
    },
    /// There is no such option, or the parameter is of another kind.
    #[error("{name} has no such value")]
    NoSuchOption {
        /// The parameter.
        name: &'static str,
    },
}

impl crate::error::Advice for BadValue {
    fn advice(&self) -> String {
        "The value before it stays".into()
    }
}

impl Parameter {
    /// The parameter of this key.
    pub fn of_key(key: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.key == key)
    }

    /// Its number in the unit shown, or the place of its option.
    pub fn value(&self, recipe: &Recipe) -> f64 {
        match &self.kind {
            // 0.01 is 10 mm, not 10.000000000000002.
            Kind::Number(number) => tidy((number.get)(recipe) * number.unit.per_inner()),
            Kind::Choice(choice) => (choice.get)(recipe) as f64,
        }
    }

    /// Gives it a number in the unit shown, or an option by its place; what is not valid is refused.
    pub fn set(&self, recipe: &mut Recipe, value: f64) -> Result<(), BadValue> {
        match &self.kind {
            Kind::Number(number) => {
                let [least, most] = number.range;
                if !(value >= least && value <= most) {
                    return Err(BadValue::OutOfRange {
                        name: self.name,
                        found: format!("{value}{}", number.unit.sign()),
                        range: number.range_text(),
                    });
                }
                (number.set)(recipe, value / number.unit.per_inner());
            }
            Kind::Choice(choice) => {
                if !(value >= 0.0 && value < choice.options.len() as f64) {
                    return Err(BadValue::NoSuchOption { name: self.name });
                }
                (choice.set)(recipe, value as usize);
            }
        }
        Ok(())
    }

    /// Gives it the value that it has in another recipe.
    pub fn copy(&self, from: &Recipe, to: &mut Recipe) {
        match &self.kind {
            Kind::Number(number) => (number.set)(to, (number.get)(from)),
            Kind::Choice(choice) => (choice.set)(to, (choice.get)(from)),
        }
    }

    /// True if the two recipes differ in it.
    pub fn differs(&self, a: &Recipe, b: &Recipe) -> bool {
        self.value(a).to_bits() != self.value(b).to_bits()
    }

    /// Its value in words.
    pub fn text(&self, recipe: &Recipe) -> String {
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

impl Number {
    /// A value with its unit.
    pub fn text(&self, value: f64) -> String {
        format!("{value:.*}{}", self.decimals, self.unit.sign())
    }

    /// The valid range in words.
    pub fn range_text(&self) -> String {
        let [least, most] = self.range;
        format!("from {least} to {most}{}", self.unit.sign())
    }
}

/// Twelve digits: what a change of units leaves behind is gone.
fn tidy(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// How many parameters differ from the default recipe.
pub fn num_changed(recipe: &Recipe) -> usize {
    let default = Recipe::default();
    let changed = PARAMETERS.iter().filter(|p| p.differs(recipe, &default));
    changed.count()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::Value;

    use super::*;

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
        for parameter in &PARAMETERS {
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
        for parameter in &PARAMETERS {
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
        for parameter in &PARAMETERS {
            assert!(parameter.help.len() > 40 && !parameter.name.is_empty());
            assert!(Group::ALL.contains(&parameter.group));
            assert!(!parameter.text(&Recipe::default()).is_empty());
        }
        let key = Parameter::of_key("segment.plane_distance").expect("there");
        assert_eq!(key.text(&Recipe::default()), "8.0 mm");
    }
}
