//! An inspection in the history: before it is written, as a row of a list, and in full.

use std::{io::Cursor, iter, sync::Arc};

use image::{
    ImageFormat, RgbImage,
    imageops::{FilterType, resize},
};
use jiff::Timestamp;

use super::{
    frames::{FrameLoss, FrameRecord},
    hung::HungId,
    scene_title::SceneTitle,
    traceability::Traceability,
};
use geometry::{
    rigid::{PoseDelta, RigidTransform, row_major},
    units::{Metres, Radians},
};
use inspection::{
    library::Truth,
    pipeline::{
        Expected, ExpectedPart, Identification, Inspection, NamedRecipe, Recipe, RecipeLabel,
        Refusal, RefusalKind, Verdict,
    },
};
use stages::{pose::PoseEstimate, scan::Shot, scene::SceneCloud};
use texts::{Described, Language, Message};

/// Verdict of an inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoredVerdict {
    /// A part was found and accepted.
    Accepted,
    /// An enrolled part was the best match, and was not accepted. It is stored as `not_accepted`, and people read
    /// *Not accepted*; otherwise, *not accepted* also means [`Unknown`](Self::Unknown) and [`NoPart`](Self::NoPart).
    Rejected,
    /// The object is not an enrolled part.
    Unknown,
    /// No part was found.
    NoPart,
}

impl StoredVerdict {
    /// All verdicts.
    pub const ALL: [Self; 4] = [Self::Accepted, Self::Rejected, Self::Unknown, Self::NoPart];

    /// Returns the name in the file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::Rejected => "not_accepted",
            Self::Unknown => "unknown",
            Self::NoPart => "no_part",
        }
    }

    /// Returns the verdict with this name in the file.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| verdict.name() == name)
    }
}

impl Described for StoredVerdict {
    fn message(&self) -> Message {
        Message::new(format!("verdict-{}", self.name().replace('_', "-")))
    }
}

texts::display!(StoredVerdict);

impl From<&Verdict> for StoredVerdict {
    fn from(verdict: &Verdict) -> Self {
        match verdict {
            verdict if verdict.is_accepted() => Self::Accepted,
            verdict if verdict.is_unknown() => Self::Unknown,
            Verdict::Part { .. } => Self::Rejected,
            Verdict::NoPart(_) => Self::NoPart,
        }
    }
}

/// Returns true if a part counts as OK: it was accepted, and no true label says that it is another part, or none.
pub(super) fn is_ok(verdict: StoredVerdict, part: Option<&str>, label: Option<&Truth>) -> bool {
    verdict == StoredVerdict::Accepted && label.is_none_or(|label| label.part() == part)
}

/// Returns true if a part with this refusal, or none, is OK or not OK: too few frames are no verdict.
pub(super) fn is_judged(reason: Option<&RefusalKind>) -> bool {
    !reason.is_some_and(RefusalKind::is_unjudged)
}

/// An inspection as a row of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Counts from 1 and is never reused; negative while the inspection is not written yet.
    pub number: i64,
    /// Time of the inspection, to the microsecond.
    pub at: Timestamp,
    /// What the scene is called.
    pub scene: SceneTitle,
    /// Origin of the scene: a source that can be reopened, a file, or a description.
    pub source: String,
    /// True if the scene does not come from a camera.
    pub is_simulated: bool,
    /// The verdict.
    pub verdict: StoredVerdict,
    /// Name of the part found, accepted or not; `None` if it is unknown or there is none.
    pub part: Option<String>,
    /// Title that the best match had at that time, whether or not the verdict names it; empty if there is none.
    pub title: String,
    /// Kind of the refusal; `None` if it was accepted.
    pub reason: Option<RefusalKind>,
    /// What its line said, when it was inspected, about letting a robot act on the pose.
    pub noted: RobotMarks,
    /// Score (0..1) and margin of the best guess.
    pub score: Option<[f64; 2]>,
    /// Time from points to verdict, milliseconds.
    pub total_ms: f64,
    /// Remark by a person; may be empty.
    pub remark: String,
    /// True label, if one was set.
    pub label: Option<Truth>,
    /// Size of the kept frames; `None` if none are kept.
    pub frame_bytes: Option<u64>,
    /// Serial number, order and operator; a re-inspection inherits those of its part.
    pub trace: Traceability,
    /// The hung part that was inspected.
    pub hung: HungId,
    /// Number of the inspection that stands for the same part; `None` if this one does.
    pub parent: Option<i64>,
    /// Number of re-inspections below this one, if it stands for the part.
    pub num_below: usize,
    /// Name of the rack; `None` if there was none, or it had no name.
    pub rack: Option<String>,
}

impl Summary {
    /// Says what hung there.
    pub fn identification(&self) -> Identification {
        Identification::new(self.reason.as_ref(), self.score)
    }

    /// Returns the title of the part of which it is the mirror image, if it is one.
    pub fn mirror_of(&self) -> Option<&str> {
        let is_mirrored = self.identification() == Identification::MirrorImage;
        is_mirrored.then_some(self.title.as_str())
    }

    /// True if the part counts as OK.
    pub fn is_ok(&self) -> bool {
        is_ok(self.verdict, self.part.as_deref(), self.label.as_ref())
    }

    /// True unless it left before enough of its frames were inspected: then it is neither OK nor not OK.
    pub fn is_judged(&self) -> bool {
        is_judged(self.reason.as_ref())
    }

    /// True if it was accepted and its true label says that it is another part, or none.
    pub fn is_wrongly_accepted(&self) -> bool {
        self.verdict == StoredVerdict::Accepted && !self.is_ok()
    }

    /// Returns what is known about letting a robot act on the pose: what was noted when it was inspected, and whether a
    /// person has said since that the part is another one.
    pub fn robot_marks(&self) -> RobotMarks {
        let mut marks = self.noted.clone();
        let doubts = &mut marks.robot_doubts;
        let is_noted = doubts.iter().any(|kind| kind == RobotMarks::REPORTED_WRONG);
        if self.is_wrongly_accepted() && !is_noted {
            doubts.insert(0, RobotMarks::REPORTED_WRONG.into());
        }
        marks
    }

    /// Returns the lower-case text in which a filter looks for its words. What the row shows in words of its own begins
    /// with `=` here, see [`Filter::shown`](super::Filter::shown).
    pub(super) fn search(&self) -> String {
        let Self {
            scene,
            source,
            part,
            title,
            remark,
            label,
            trace,
            verdict,
            reason,
            rack,
            ..
        } = self;
        let part = part.as_deref().unwrap_or("");
        let label = label.as_ref().map_or("", Truth::name);
        let scene = scene.search();
        let mut text = format!("{title}\n{part}\n{scene}\n{source}\n{remark}\n{label}");
        if self.is_simulated {
            text.push_str("\n=simulated");
        }
        if *verdict != StoredVerdict::Accepted {
            let reason = reason.as_ref().map_or("", RefusalKind::name);
            for stored in [verdict.name(), reason] {
                text.push_str("\n=");
                text.push_str(stored);
            }
        }
        for known in trace.known().map(|(_, known)| known).chain(rack.as_deref()) {
            text.push('\n');
            text.push_str(known);
        }
        text.to_lowercase()
    }
}

/// The data of an inspection that are not in its row.
#[derive(Clone, Debug, PartialEq)]
pub struct InspectionDetail {
    /// Name of the best guess, whether or not the verdict names it.
    pub nearest: Option<String>,
    /// Why it was not accepted, with enrolled names of parts; `None` also if this program cannot read it.
    pub refusal: Option<Refusal>,
    /// The pose, if there is one.
    pub camera_from_part: Option<RigidTransform>,
    /// Name of the recipe.
    pub recipe_label: RecipeLabel,
    /// Identity of the recipe.
    pub recipe_identity: String,
    /// All parameters; `None` if this program cannot read them. Parameters missing in the file have their defaults.
    pub recipe: Option<Arc<Recipe>>,
    /// Identity of the library.
    pub library_identity: String,
    /// Version of the program that inspected.
    pub program: String,
    /// The line that `inspect --json` writes, including the stage times.
    pub line: String,
    /// Small picture of the segmentation as PNG; empty for a scene that is not organised.
    pub thumbnail: Vec<u8>,
    /// Where the program that wrote the row finds the scene again; meaningless to other programs.
    pub origin: Option<String>,
    /// The kept frame, if any.
    pub frame: Option<FrameRecord>,
    /// Why it is not kept although the rule keeps it.
    pub frame_loss: Option<FrameLoss>,
}

/// What the line of an inspection says about letting a robot act on the pose.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(default)]
pub struct RobotMarks {
    /// Why it must not, in words for programs.
    pub robot_doubts: Vec<String>,
    /// False if the part was accepted and no other frame shows whether it hung still.
    pub motion_checked: Option<bool>,
}

impl RobotMarks {
    /// The word for a part that a person has reported as wrong.
    pub const REPORTED_WRONG: &str = "reported_wrong";

    /// Says why a robot must not act on the pose; `None` if nothing is against it.
    pub fn past_doubts(&self, language: Language) -> Option<String> {
        let kinds = self.robot_doubts.iter();
        let whys = kinds.map(|kind| {
            let message = Message::new(format!("doubt-{}", kind.replace('_', "-")));
            // Files of later versions may have further words.
            let past = message.attribute(language, "past");
            past.unwrap_or_else(|| kind.clone())
        });
        let whys: Vec<String> = whys.collect();
        let message = Message::new("doubt-past").with("why", &*whys.join("; "));
        (!whys.is_empty()).then(|| message.text(language))
    }
}

/// An inspection in full.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The row for lists.
    pub summary: Summary,
    /// All other data.
    pub detail: InspectionDetail,
}

/// Maximum width and height of a thumbnail, pixels.
const THUMBNAIL: [u32; 2] = [160, 120];

/// An inspection to be written.
#[derive(Clone, Debug)]
pub struct NewEntry {
    /// The record, without the number and the fields that writing fills in.
    pub record: Record,
    /// The thumbnail, not yet encoded as PNG.
    pub picture: Option<RgbImage>,
    /// The inspected scene; `None` if it is not to be kept.
    pub scene: Option<Arc<SceneCloud>>,
    /// Shots of a scan with their camera poses from the robot; the scene is one of them. Empty otherwise.
    pub shots: Vec<Shot>,
    /// True if it stands for its part also where another inspection of it was written before, unless that one alone
    /// accepts it.
    pub stands_for_part: bool,
}

/// Facts about an inspection that [`Inspection`] does not contain.
pub struct InspectionContext<'a> {
    /// Time of the inspection.
    pub at: Timestamp,
    /// What the scene is called.
    pub scene: SceneTitle,
    /// Origin of the scene.
    pub source: String,
    /// True if the scene does not come from a camera.
    pub is_simulated: bool,
    /// Returns the title of the part enrolled under a name.
    pub title_of: &'a dyn Fn(&str) -> String,
    /// The line that `inspect --json` writes.
    pub line: String,
    /// Identity of the library.
    pub library: String,
    /// Where the program that writes the row finds the scene again.
    pub origin: Option<String>,
    /// Picture of the segmentation, of any size.
    pub picture: Option<&'a RgbImage>,
    /// The hung part that was inspected.
    pub hung: HungId,
}

impl NewEntry {
    /// Creates the entry of an inspection.
    pub fn of(
        about: InspectionContext<'_>,
        scene: &Arc<SceneCloud>,
        inspection: &Inspection,
        recipe: &NamedRecipe,
    ) -> Self {
        let verdict = StoredVerdict::from(&inspection.verdict);
        let nearest = inspection.verdict.guess().map(str::to_owned);
        let refusal = inspection.verdict.refusal();
        let pose = inspection.found_pose();
        let is_named = !matches!(verdict, StoredVerdict::Unknown | StoredVerdict::NoPart);
        let micro = about.at.as_microsecond();
        let summary = Summary {
            number: 0,
            // Rounded as in the file, so that a row is the same before and after writing.
            at: Timestamp::from_microsecond(micro).unwrap_or(about.at),
            scene: about.scene,
            source: about.source,
            is_simulated: about.is_simulated,
            verdict,
            part: nearest.clone().filter(|_| is_named),
            title: nearest.as_deref().map(about.title_of).unwrap_or_default(),
            reason: refusal.as_ref().map(Refusal::kind),
            noted: serde_json::from_str(&about.line).unwrap_or_default(),
            score: inspection.verdict.score(),
            total_ms: inspection.timings.total.as_secs_f64() * 1e3,
            remark: String::new(),
            label: None,
            frame_bytes: None,
            trace: Traceability::default(),
            hung: about.hung,
            parent: None,
            num_below: 0,
            rack: text_of(&about.line, "rack"),
        };
        let detail = InspectionDetail {
            nearest,
            refusal,
            camera_from_part: pose.map(PoseEstimate::camera_from_part),
            recipe_label: recipe.label.clone(),
            recipe_identity: recipe.identity(),
            recipe: Some(Arc::clone(&recipe.parameters)),
            library_identity: about.library,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            line: about.line,
            thumbnail: Vec::new(),
            origin: about.origin,
            frame: None,
            frame_loss: None,
        };
        Self {
            record: Record { summary, detail },
            picture: about.picture.map(small),
            scene: Some(Arc::clone(scene)),
            shots: Vec::new(),
            stands_for_part: false,
        }
    }

    /// Adds the shots of a scan.
    #[must_use]
    pub fn of_scan(self, shots: Vec<Shot>) -> Self {
        Self { shots, ..self }
    }

    /// Drops the scenes from which the frames would be written, and notes why, if that is a loss.
    pub(super) fn drop_frames(&mut self, loss: Option<FrameLoss>) {
        self.shots = Vec::new();
        if self.scene.take().is_some() {
            self.record.detail.frame_loss = loss;
        }
    }

    /// True if it stands for its part in place of `head`, which was written before: a part that was refused and is
    /// accepted as it still hangs there is an accepted part. The part stays accepted for good, since a robot may have
    /// acted on it. Neither verdict is changed.
    pub(super) fn takes_over_from(&self, head: &Summary) -> bool {
        let is_accepted = |row: &Summary| row.verdict == StoredVerdict::Accepted;
        match (is_accepted(head), is_accepted(&self.record.summary)) {
            (false, true) => true,
            (true, false) => false,
            (true, true) | (false, false) => self.stands_for_part,
        }
    }
}

/// Returns a text of a line of JSON.
fn text_of(line: &str, field: &str) -> Option<String> {
    let line: serde_json::Value = serde_json::from_str(line).ok()?;
    line.get(field)?.as_str().map(str::to_owned)
}

/// Shrinks a picture by nearest neighbour, which keeps flat colours flat and the PNG small.
fn small(picture: &RgbImage) -> RgbImage {
    let [width, height] = THUMBNAIL;
    let share = (f64::from(width) / f64::from(picture.width().max(1)))
        .min(f64::from(height) / f64::from(picture.height().max(1)))
        .min(1.0);
    let side = |length: u32| ((f64::from(length) * share).round() as u32).max(1);
    let (width, height) = (side(picture.width()), side(picture.height()));
    resize(picture, width, height, FilterType::Nearest)
}

/// Encodes a picture as PNG.
pub(super) fn png_of(picture: &RgbImage) -> Vec<u8> {
    let mut png = Cursor::new(Vec::new());
    // Writing to memory does not fail, and PNG allows any size that a picture has here.
    let written = picture.write_to(&mut png, ImageFormat::Png);
    written.map_or_else(|_| Vec::new(), |()| png.into_inner())
}

impl InspectionDetail {
    /// Returns the recipe with what was expected, if this program can read it.
    pub fn named_recipe(&self) -> Option<NamedRecipe> {
        let recipe = NamedRecipe {
            label: self.recipe_label.clone(),
            parameters: Arc::clone(self.recipe.as_ref()?),
        };
        Some(recipe.expecting(self.expected()))
    }

    /// Returns this recipe as the frame is inspected again with it: it expects what was expected then, before the same rack, and
    /// looks for as many parts at least.
    pub fn again_with(&self, recipe: &NamedRecipe) -> NamedRecipe {
        let mut again = recipe.clone();
        let parameters = Arc::make_mut(&mut again.parameters);
        parameters.expected = self.expected();
        if let Some(then) = &self.recipe {
            let max_parts = &mut parameters.segment.max_parts;
            *max_parts = (*max_parts).max(then.segment.max_parts);
            parameters.rack = then.rack.clone();
        }
        again
    }

    /// Returns what was expected in the frame.
    pub fn expected(&self) -> Expected {
        serde_json::from_str(&self.line).unwrap_or_default()
    }

    /// Returns the expected parts that were missing in the frame; `None` if that is not known, or another row of the frame says it.
    pub fn missing(&self) -> Option<Vec<ExpectedPart>> {
        #[derive(serde::Deserialize)]
        struct Missing {
            missing: Vec<String>,
            #[serde(default)]
            missing_places: Vec<Option<String>>,
        }
        let line = serde_json::from_str::<Missing>(&self.line).ok()?;
        let places = line.missing_places.into_iter().chain(iter::repeat(None));
        let parts = line.missing.into_iter().zip(places);
        let parts = parts.map(|(name, place)| ExpectedPart { name, place });
        Some(parts.collect())
    }

    /// Returns the place of the rack at which the part hung; `None` if it hung at none, or there was no rack.
    pub fn place(&self) -> Option<String> {
        text_of(&self.line, "place")
    }

    /// Returns the number of [that place](Self::place) in the rack, from 1.
    pub fn place_number(&self) -> Option<u32> {
        self.recipe.as_ref()?.rack.number_of(&self.place()?)
    }

    /// Returns how far off the pose may be; `None` if the line has no bounds or the pose is unconstrained.
    pub(super) fn pose_bounds(&self) -> Option<PoseDelta> {
        #[derive(serde::Deserialize)]
        struct Posed {
            pose: Option<Bounded>,
        }
        #[derive(serde::Deserialize)]
        struct Bounded {
            shift_bound_m: Option<f64>,
            turn_bound_rad: Option<f64>,
        }
        let line = serde_json::from_str::<Posed>(&self.line).ok()?;
        let pose = line.pose?;
        Some(PoseDelta {
            rotation: Radians(pose.turn_bound_rad?),
            shift: Metres(pose.shift_bound_m?),
        })
    }

    /// Returns the recipe's name and its identity.
    pub fn recipe_text(&self) -> String {
        format!("{}, {}", self.recipe_label, self.recipe_identity)
    }
}

impl Record {
    /// Returns the pose as 16 numbers in row-major order, metres.
    pub fn matrix(&self) -> Option<[f64; 16]> {
        self.detail.camera_from_part.as_ref().map(row_major)
    }

    /// Returns why it was not accepted, with titles of parts. The best match keeps the title that it had at that time: it
    /// may have been renamed since.
    pub fn titled_refusal(&self, title_of: impl Fn(&str) -> String) -> Option<Message> {
        let Self { summary, detail } = self;
        let why = detail.refusal.as_ref()?.message();
        Some(why.with_titles(|name| {
            if detail.nearest.as_deref() == Some(name) {
                summary.title.clone()
            } else {
                title_of(name)
            }
        }))
    }

    /// Returns the stage times in milliseconds, in the order of the stages; empty if the line has none.
    pub fn timings(&self) -> Vec<(String, f64)> {
        #[derive(serde::Deserialize)]
        struct Timed {
            timings_ms: Option<serde_json::Map<String, serde_json::Value>>,
        }
        let line = serde_json::from_str::<Timed>(&self.detail.line);
        let times = line.ok().and_then(|line| line.timings_ms);
        let mut times: Vec<(String, f64)> = times
            .into_iter()
            .flatten()
            .filter_map(|(stage, ms)| Some((stage, ms.as_f64()?)))
            .collect();
        // JSON objects are unordered.
        let place = |stage: &str| ORDER.iter().position(|known| *known == stage);
        times.sort_by_key(|(stage, _)| place(stage).unwrap_or(ORDER.len()));
        times
    }
}

/// The stages in the order in which they run.
const ORDER: [&str; 7] = [
    "segment",
    "project",
    "contour",
    "signature",
    "rank",
    "pose",
    "total",
];
