//! Named recipes and their files.
//!
//! A recipe file is TOML and holds only the parameters that differ from the built-in recipe, with values as in
//! `--set`:
//!
//! ```toml
//! schema = 1
//! name = "glossy"
//! notes = "clear coat, booth 3"
//! expect = ["fender", "left hook=grille"]    # what should hang there, as in `--expect`
//!
//! [parameters]
//! accept.min_score = "0.85"
//! segment.plane_distance = "12 mm"
//! ```

use std::{
    fmt::{self, Write as _},
    ops::Deref,
    path::Path,
    sync::Arc,
};

use serde::{Deserialize, Serialize};

use super::{
    Expected, ExpectedPart, PoseChoice, Recipe,
    parameters::{Parameters, Setting, changed},
    recipe_error::RecipeError,
};
use crate::library::PartName;
use files::{parse_toml, read_text, toml_problem, write_text};
use stages::{pose::PoseMethod, rack::Rack, rank::Matcher, segment::MAX_PARTS};
use texts::Message;

/// Name of the built-in recipe, in which every parameter is at its default.
pub const BUILT_IN: &str = "built-in";
/// Name of the built-in recipe that ranks by the paper's Algorithm 2 and refines the pose by its Algorithm 3.
pub const AS_IN_THE_PAPER: &str = "as-in-the-paper";
/// Names of the built-in recipes; no file has one of them.
pub const BUILT_IN_RECIPES: [&str; 2] = [BUILT_IN, AS_IN_THE_PAPER];

/// Returns the built-in recipe of this name.
pub fn built_in_recipe(name: &str) -> Option<Recipe> {
    let mut recipe = Recipe::default();
    match name {
        BUILT_IN => {}
        AS_IN_THE_PAPER => {
            recipe.rank.matcher = Matcher::Paper;
            recipe.pose = PoseChoice::By(PoseMethod::IcpGa);
        }
        _ => return None,
    }
    Some(recipe)
}

/// Version of the file format.
pub(super) const SCHEMA: u32 = 1;
/// Maximum size of a recipe file.
const MAX_BYTES: u64 = 1 << 16;
/// Maximum length of the notes, characters.
pub const MAX_NOTES: usize = 1000;

/// Name of a recipe, and whether its parameters were changed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecipeLabel {
    /// Name that the recipe is saved under.
    pub name: String,
    /// True if its parameters are not those kept under the name.
    #[serde(default)]
    pub is_changed: bool,
}

impl Default for RecipeLabel {
    fn default() -> Self {
        Self {
            name: BUILT_IN.into(),
            is_changed: false,
        }
    }
}

impl fmt::Display for RecipeLabel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let changed = if self.is_changed { " (modified)" } else { "" };
        write!(f, "{}{changed}", self.name)
    }
}

/// Parameters of an inspection with the name of their recipe.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedRecipe {
    /// The name.
    pub label: RecipeLabel,
    /// The parameters.
    pub parameters: Arc<Recipe>,
}

impl NamedRecipe {
    /// The same recipe before this rack, in camera space.
    #[must_use]
    pub fn in_rack(&self, rack: Rack) -> Self {
        let mut recipe = self.clone();
        if recipe.rack != rack {
            Arc::make_mut(&mut recipe.parameters).rack = rack;
        }
        recipe
    }

    /// The same recipe that looks for as many parts as a frame can show.
    #[must_use]
    pub fn finding_all(&self) -> Self {
        let mut recipe = self.clone();
        if recipe.segment.max_parts < MAX_PARTS {
            Arc::make_mut(&mut recipe.parameters).segment.max_parts = MAX_PARTS;
            recipe.label.is_changed = true;
        }
        recipe
    }

    /// The same recipe that expects these parts; if there are none, those that it expects now.
    #[must_use]
    pub fn expecting(&self, expected: Expected) -> Self {
        let mut recipe = self.clone();
        if !expected.is_empty() {
            Arc::make_mut(&mut recipe.parameters).expected = expected;
        }
        recipe
    }
}

impl Deref for NamedRecipe {
    type Target = Recipe;

    fn deref(&self) -> &Recipe {
        &self.parameters
    }
}

impl From<Recipe> for NamedRecipe {
    fn from(recipe: Recipe) -> Self {
        Self {
            label: RecipeLabel {
                is_changed: recipe != Recipe::default(),
                ..RecipeLabel::default()
            },
            parameters: Arc::new(recipe),
        }
    }
}

impl From<RecipeFile> for NamedRecipe {
    fn from(file: RecipeFile) -> Self {
        Self {
            label: RecipeLabel {
                name: file.name.into(),
                is_changed: false,
            },
            parameters: Arc::new(file.recipe),
        }
    }
}

/// By which recipe something was inspected, as reports and JSON lines have it.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct RecipeBlock {
    /// Eight hexadecimal digits, the same for the same parameters.
    pub identity: String,
    /// True if these are the program's own parameters.
    pub is_default: bool,
    /// The name; `built-in` and `as-in-the-paper` are the program's own recipes.
    pub name: String,
    /// True if its parameters are not those kept under the name.
    pub is_changed: bool,
}

impl From<&NamedRecipe> for RecipeBlock {
    fn from(recipe: &NamedRecipe) -> Self {
        let RecipeLabel { name, is_changed } = recipe.label.clone();
        Self {
            identity: recipe.identity(),
            is_default: recipe.identity() == Recipe::default().identity(),
            name,
            is_changed,
        }
    }
}

/// Contents of a recipe file.
#[derive(Clone, Debug, PartialEq)]
pub struct RecipeFile<R = Recipe> {
    /// The name.
    pub name: PartName,
    /// Remarks of the user; may be empty.
    pub notes: String,
    /// All parameters.
    pub recipe: R,
}

/// The file, before its parameters are checked.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    #[serde(rename = "schema")]
    _schema: u32,
    name: PartName,
    #[serde(default)]
    notes: String,
    #[serde(default)]
    expect: Vec<ExpectedPart>,
    #[serde(default)]
    parameters: toml::Table,
}

impl RecipeFile {
    /// The recipe in which every parameter is at its default, as if read from a file.
    pub fn built_in() -> Self {
        Self {
            name: PartName::new(BUILT_IN).expect("it keeps the rules of names"),
            notes: String::new(),
            recipe: Recipe::default(),
        }
    }

    /// The built-in recipe of this name, as if read from a file.
    pub fn built_in_named(name: &PartName) -> Option<Self> {
        let notes = match name.as_str() {
            AS_IN_THE_PAPER => Message::new("recipe-as-in-the-paper").to_string(),
            _ => String::new(),
        };
        Some(Self {
            recipe: built_in_recipe(name.as_str())?,
            name: name.clone(),
            notes,
        })
    }

    /// All built-in recipes, as if read from files.
    pub fn all_built_in() -> Vec<Self> {
        let names = BUILT_IN_RECIPES.iter();
        let names = names.filter_map(|name| PartName::new(name).ok());
        names
            .filter_map(|name| Self::built_in_named(&name))
            .collect()
    }
}

impl<R: Parameters> RecipeFile<R> {
    /// Reads a file. A single bad parameter makes the whole file an error.
    pub fn read(path: &Path) -> Result<Self, RecipeError> {
        Self::parse(path, &read_text(path, MAX_BYTES)?)
    }

    /// Parses a recipe from text; errors name `path` as its file.
    pub fn parse(path: &Path, text: &str) -> Result<Self, RecipeError> {
        let garbled = |error: toml::de::Error| RecipeError::Garbled {
            path: path.to_owned(),
            reason: toml_problem(text, &error),
        };
        let written: Written = parse_toml(path, text, SCHEMA, garbled)?;
        let found = written.notes.chars().count();
        if found > MAX_NOTES {
            return Err(RecipeError::LongNotes { found });
        }
        let mut settings = Vec::new();
        flatten(&written.parameters, "", &mut settings);
        let mut recipe = R::default();
        for setting in settings {
            let setting = setting.parse::<Setting<R>>();
            let setting = setting.map_err(|source| RecipeError::BadParameter {
                path: path.to_owned(),
                source,
            })?;
            setting.apply(&mut recipe);
        }
        if let Some(expect) = recipe.expect() {
            *expect = written.expect;
        } else if !written.expect.is_empty() {
            return Err(RecipeError::Garbled {
                path: path.to_owned(),
                reason: "unknown field `expect`".into(),
            });
        }
        Ok(Self {
            name: written.name,
            notes: written.notes,
            recipe,
        })
    }

    /// The contents of the file as text.
    pub fn text(&self) -> String {
        let string = |text: &str| toml::Value::String(text.to_owned()).to_string();
        let mut text = format!(
            "# A recipe of Partsight: the parameters that differ from the program's own.\n\
             schema = {SCHEMA}\nname = {}\nnotes = {}\n",
            string(self.name.as_str()),
            string(&self.notes)
        );
        let mut recipe = self.recipe.clone();
        if let Some(expect) = recipe.expect().filter(|expect| !expect.is_empty()) {
            let parts = expect.iter().cloned();
            let parts: Vec<String> = parts.map(|part| string(&String::from(part))).collect();
            // Writing to memory cannot fail.
            let _ = writeln!(text, "expect = [{}]", parts.join(", "));
        }
        text.push_str("\n[parameters]\n");
        for parameter in changed(&self.recipe) {
            let value = string(&parameter.setting_text(&self.recipe));
            // Writing to memory cannot fail.
            let _ = writeln!(text, "{} = {value}", parameter.key);
        }
        text
    }

    /// Writes the file atomically, and returns the recipe as the file holds it.
    pub fn write(&self, path: &Path) -> Result<Self, RecipeError> {
        let found = self.notes.chars().count();
        if found > MAX_NOTES {
            return Err(RecipeError::LongNotes { found });
        }
        let text = self.text();
        let as_read = Self::parse(path, &text)?;
        write_text(path, &text)?;
        Ok(as_read)
    }
}

/// Appends every value of nested tables as `NAME=VALUE`.
fn flatten(table: &toml::Table, prefix: &str, settings: &mut Vec<String>) {
    for (key, value) in table {
        let name = format!("{prefix}{key}");
        match value {
            toml::Value::Table(inner) => flatten(inner, &format!("{name}."), settings),
            toml::Value::String(text) => settings.push(format!("{name}={text}")),
            value => settings.push(format!("{name}={value}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::parameters::{Kind, PARAMETERS, num_changed};
    use geometry::error::Advice as _;

    fn parsed(text: &str) -> Result<RecipeFile, RecipeError> {
        RecipeFile::parse(Path::new("r.toml"), text)
    }

    fn named(recipe: Recipe) -> RecipeFile {
        RecipeFile {
            name: PartName::new("glossy").expect("a name"),
            notes: "two\nlines, \"quoted\", # none".into(),
            recipe,
        }
    }

    #[test]
    fn what_is_written_reads_the_same_for_every_parameter_at_both_ends_of_its_range() {
        for at_the_end in [false, true] {
            let mut recipe = Recipe::default();
            if at_the_end {
                recipe.expect = vec!["fender".into(), "hook \"A = 1\"=grille".into()];
            }
            for parameter in PARAMETERS {
                let value = match &parameter.kind {
                    Kind::Number(number) => number.range[usize::from(at_the_end)],
                    Kind::Choice(choice) if at_the_end => choice.options.len() as f64 - 1.0,
                    Kind::Choice(_) => 0.0,
                };
                parameter.set(&mut recipe, value).expect("in range");
            }
            let file = named(recipe);
            assert!(num_changed(&file.recipe) > 40);
            let read = parsed(&file.text()).expect("read");
            assert_eq!(read, file);
            assert_eq!(read.recipe.identity(), file.recipe.identity());
        }
    }

    #[test]
    fn digits_that_a_file_does_not_keep_are_gone_after_the_first_writing() {
        let mut recipe = Recipe::default();
        recipe.segment.plane_distance.0 = 0.012_345_678_901_234_567;
        recipe.accept.min_score = 1.0 / 3.0;
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("glossy.toml");
        let first = named(recipe).write(&path).expect("written");
        assert_eq!(RecipeFile::read(&path).expect("read"), first);
        assert_eq!(first.write(&path).expect("written"), first);
        assert!((first.recipe.accept.min_score - 1.0 / 3.0).abs() < 1e-11);
    }

    #[test]
    fn a_file_by_hand_may_use_numbers_tables_and_units() {
        let file = parsed(
            "schema = 1\nname = \"by_hand\"\n[parameters]\npose = \"icp-ga\"\n\"accept.min_score\" = 1\n\
             [parameters.segment]\nplane_distance = 12.5\nlink_distance = \"7 mm\"\n",
        )
        .expect("read");
        assert_eq!(file.recipe.pose, PoseChoice::By(PoseMethod::IcpGa));
        assert!((file.recipe.segment.plane_distance.mm() - 12.5).abs() < 1e-12);
        assert!((file.recipe.segment.link_distance.mm() - 7.0).abs() < 1e-12);
        assert_eq!((num_changed(&file.recipe), file.notes.as_str()), (4, ""));
        let bare = parsed("schema = 1\nname = \"bare\"").expect("read");
        assert_eq!(bare.recipe, Recipe::default());
    }

    #[test]
    fn a_file_expects_parts_until_the_caller_expects_others() {
        let text = "schema = 1\nname = \"x\"\nexpect = [\"fender\", \"left hook = grille\"]";
        let recipe = NamedRecipe::from(parsed(text).expect("read"));
        assert_ne!(recipe.identity(), Recipe::default().identity());
        assert!(recipe.expected.is_empty(), "not checked yet");
        let own = |enrolled: &'static str| {
            recipe.expected_or_own(Expected::default(), None, |name| enrolled.contains(name))
        };
        let names = |expected: &Expected| {
            let parts = expected.parts().iter();
            parts.map(|part| part.name.clone()).collect::<Vec<_>>()
        };
        assert_eq!(
            names(&own("fender grille").expect("both")),
            ["fender", "grille"]
        );
        let missing = own("fender").expect_err("no grille");
        assert!(missing.to_string().contains("grille"), "{missing}");
        let no_rack = recipe.expected_or_own(Expected::default(), Some(Rack::ANYWHERE), |_| true);
        let no_rack = no_rack.expect_err("no such place");
        assert!(no_rack.to_string().contains("left hook"), "{no_rack}");
        let given = Expected::new(vec!["hood".into()], None, |_| true).expect("one");
        let given = recipe.expected_or_own(given, Some(Rack::ANYWHERE), |_| false);
        assert_eq!(names(&given.expect("the caller's")), ["hood"]);
    }

    #[test]
    fn a_file_that_is_no_recipe_is_refused_with_what_is_wrong_and_what_to_do() {
        let with = |line: &str| format!("schema = 1\nname = \"x\"\n[parameters]\n{line}\n");
        let long = "x".repeat(MAX_NOTES + 1);
        for (text, expected) in [
            ("schema = 1", "missing field `name`"),
            ("name = \"x\"", "missing field `schema`"),
            ("schema = 2\nname = \"x\"\nnew = 1", "schema 2"),
            ("schema = 1\nname = \"../x\"", "it contains"),
            ("schema = 1\nname = \"x\"\nparameter = {}", "unknown field"),
            ("schema = [", "r.toml"),
            ("schema = 1\nname = \"x\"\nexpect = \"fender\"", "line 3"),
            (&with("accept.min_scor = 1"), "nearest is accept.min_score"),
            (&with("accept.min_score = 1.5"), "from 0 to 1"),
            (&with("accept.min_score = nan"), "from 0 to 1"),
            (&with("accept.min_score = true"), "not a value of"),
            (&with("accept.min_score = [1]"), "not a value of"),
            (&with("accept = 1"), "no parameter accept"),
            (&with("icp.max_iterations = 1.5"), "whole numbers"),
            (
                &format!("schema = 1\nname = \"x\"\nnotes = \"{long}\""),
                "1001 characters",
            ),
        ] {
            let error = parsed(text).expect_err(text);
            assert!(error.to_string().contains(expected), "{text}: {error}");
            assert!(!error.advice().is_empty());
        }
    }

    #[test]
    fn a_file_that_is_none_or_too_large_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        assert!(RecipeFile::<Recipe>::read(&at("missing.toml")).is_err());
        assert!(RecipeFile::<Recipe>::read(folder.path()).is_err());
        let valid = named(Recipe::default()).text();
        let padded = format!("{valid}#{}", " ".repeat(MAX_BYTES as usize));
        std::fs::write(at("large.toml"), padded).expect("written");
        let error = RecipeFile::<Recipe>::read(&at("large.toml")).expect_err("too large");
        assert!(error.to_string().contains("large.toml"), "{error}");
        std::fs::write(at("bytes.toml"), [0xff, 0xfe, 0]).expect("written");
        assert!(RecipeFile::<Recipe>::read(&at("bytes.toml")).is_err());
    }

    #[test]
    fn a_label_marks_what_was_changed() {
        let mut label = RecipeLabel::default();
        assert_eq!(label.to_string(), "built-in");
        label.is_changed = true;
        assert_eq!(label.to_string(), "built-in (modified)");
    }
}
