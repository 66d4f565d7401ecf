//! An inspection as the history has it: before it is written, as a row of a list, and in full.

use std::{io::Cursor, sync::Arc};

use image::{
    ImageFormat, RgbImage,
    imageops::{FilterType, resize},
};
use jiff::Timestamp;

use super::{frames::FrameRecord, hung::HungId, traceability::Traceability};
use crate::{
    error::Advice as _,
    geometry::rigid::{RigidTransform, row_major},
    library::Truth,
    pipeline::{Inspection, NamedRecipe, Recipe, RecipeLabel, Refusal, RefusalKind, Verdict},
    scan::Shot,
    stages::{pose::PoseEstimate, scene::SceneCloud},
};

/// How an inspection ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoredVerdict {
    /// A part, accepted.
    Accepted,
    /// A part, not accepted.
    NotAccepted,
    /// Something that is nothing enrolled.
    Unknown,
    /// No part.
    NoPart,
}

impl StoredVerdict {
    /// Every verdict.
    pub const ALL: [Self; 4] = [
        Self::Accepted,
        Self::NotAccepted,
        Self::Unknown,
        Self::NoPart,
    ];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Accepted => "Accepted",
            Self::NotAccepted => "Not accepted",
            Self::Unknown => "Unknown",
            Self::NoPart => "No part",
        }
    }

    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::NotAccepted => "not_accepted",
            Self::Unknown => "unknown",
            Self::NoPart => "no_part",
        }
    }

    /// The verdict that is written so.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| verdict.name() == name)
    }
}

impl From<&Verdict> for StoredVerdict {
    fn from(verdict: &Verdict) -> Self {
        match verdict {
            verdict if verdict.is_accepted() => Self::Accepted,
            verdict if verdict.is_unknown() => Self::Unknown,
            Verdict::Part { .. } => Self::NotAccepted,
            Verdict::NoPart(_) => Self::NoPart,
        }
    }
}

/// A row of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Counted from 1 and never used again; below 0 as long as it is not written.
    pub number: i64,
    /// When it was inspected, to the microsecond.
    pub at: Timestamp,
    /// The scene's name for people.
    pub scene: String,
    /// Where the scene came from: a source as it can be opened again, a file, or words.
    pub source: String,
    /// True if no camera was read.
    pub is_simulated: bool,
    /// How it ended.
    pub verdict: StoredVerdict,
    /// What it was recognised as, accepted or not; nothing where it is unknown.
    pub part: Option<String>,
    /// The same for people.
    pub title: String,
    /// The best guess's score, 0..1, and its lead.
    pub score: Option<[f64; 2]>,
    /// From points to verdict, milliseconds.
    pub total_ms: f64,
    /// What a person remarks; may be empty.
    pub remark: String,
    /// What it truly is, if somebody said so.
    pub label: Option<Truth>,
    /// Size of what is kept of its frames; `None` if nothing is.
    pub frame_bytes: Option<u64>,
    /// Serial number, order and operator; a re-inspection has those of its part.
    pub trace: Traceability,
    /// Which part it is as it hung there.
    pub hung: HungId,
    /// The inspection that stands for the same part; `None` of the one that does.
    pub parent: Option<i64>,
    /// Of the one that stands for the part: how many others there are.
    pub num_below: usize,
}

impl Summary {
    /// What a filter's words are looked for in, in lower case.
    pub(super) fn search(&self) -> String {
        let Self {
            scene,
            source,
            part,
            title,
            remark,
            label,
            trace,
            ..
        } = self;
        let part = part.as_deref().unwrap_or("");
        let label = label.as_ref().map_or("", Truth::name);
        let mut text = format!("{title}\n{part}\n{scene}\n{source}\n{remark}\n{label}");
        for (_, known) in trace.known() {
            text.push('\n');
            text.push_str(known);
        }
        text.to_lowercase()
    }
}

/// Why an inspection was not accepted.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredRefusal {
    /// In English, with the titles that the parts had.
    pub reason: String,
    /// What to do about it, in English.
    pub advice: String,
    /// The same with its figures and enrolled names; `None` where an earlier program wrote it, or this one cannot
    /// read it.
    pub why: Option<Refusal>,
}

impl StoredRefusal {
    fn of(why: Refusal, title_of: impl Fn(&str) -> String) -> Self {
        let told = why.clone().renamed(title_of);
        Self {
            reason: told.to_string(),
            advice: told.advice(),
            why: Some(why),
        }
    }

    /// What refusals are counted by.
    pub fn kind(&self) -> Option<RefusalKind> {
        self.why.as_ref().map(Refusal::kind)
    }
}

/// What is known of an inspection beside its row.
#[derive(Clone, Debug, PartialEq)]
pub struct InspectionDetail {
    /// The best guess, named or not.
    pub nearest: Option<String>,
    /// Why it was not accepted, if it was not.
    pub refusal: Option<StoredRefusal>,
    /// The pose, if there is one.
    pub camera_from_part: Option<RigidTransform>,
    /// By which name the recipe went; `None` of an inspection that an earlier program wrote.
    pub recipe_label: Option<RecipeLabel>,
    /// Tells recipes apart.
    pub recipe_identity: String,
    /// All parameters; `None` if this program cannot read them. Those that it has more are its own.
    pub recipe: Option<Arc<Recipe>>,
    /// Tells libraries apart.
    pub library_identity: String,
    /// Version of the program.
    pub program: String,
    /// As `inspect --json` writes it, the times of the stages among the rest.
    pub line: String,
    /// A small picture of the segmentation, PNG; empty for a scene without rows and columns.
    pub thumbnail: Vec<u8>,
    /// How whoever wrote it can have the scene again; for nobody else.
    pub origin: Option<String>,
    /// The kept frame.
    pub frame: Option<FrameRecord>,
}

/// An inspection in full.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// What lists show.
    pub summary: Summary,
    /// The rest.
    pub detail: InspectionDetail,
}

/// Width and height of a thumbnail at most, pixels.
const THUMBNAIL: [u32; 2] = [160, 120];

/// An inspection that is to be written.
#[derive(Clone, Debug)]
pub struct NewEntry {
    /// Without a number, and without what writing finds out.
    pub record: Record,
    /// The small picture, before it is a PNG.
    pub picture: Option<RgbImage>,
    /// The scene as it was inspected; `None` if it is not to be kept.
    pub scene: Option<Arc<SceneCloud>>,
    /// Of a scan: its shots, where the robot says that they were taken; the scene is one of them.
    pub shots: Vec<Shot>,
}

/// What an inspection itself does not know.
pub struct InspectionContext<'a> {
    /// When it was inspected.
    pub at: Timestamp,
    /// The scene's name for people.
    pub scene: String,
    /// Where the scene came from.
    pub source: String,
    /// True if no camera was read.
    pub is_simulated: bool,
    /// The name for people of the part that is enrolled under this name.
    pub title_of: &'a dyn Fn(&str) -> String,
    /// As `inspect --json` writes it.
    pub line: String,
    /// The library's identity.
    pub library: String,
    /// How whoever writes it can have the scene again.
    pub origin: Option<String>,
    /// A picture of the segmentation, of any size.
    pub picture: Option<&'a RgbImage>,
    /// Which part it is as it hung there.
    pub hung: HungId,
}

impl NewEntry {
    /// Of an inspection.
    pub fn of(
        about: InspectionContext<'_>,
        scene: &Arc<SceneCloud>,
        inspection: &Inspection,
        recipe: &NamedRecipe,
    ) -> Self {
        let verdict = StoredVerdict::from(&inspection.verdict);
        let nearest = inspection.verdict.guess().map(str::to_owned);
        let name = nearest.as_deref().map(about.title_of).unwrap_or_default();
        let title = match verdict {
            StoredVerdict::Accepted => name,
            StoredVerdict::NotAccepted => format!("Not recognised · nearest {name}"),
            _ if inspection.verdict.is_mirrored() => format!("Mirror image of {name}"),
            StoredVerdict::Unknown => format!("Unknown · nearest {name}"),
            StoredVerdict::NoPart => "No part".to_owned(),
        };
        let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
        let is_named = !matches!(verdict, StoredVerdict::Unknown | StoredVerdict::NoPart);
        let micro = about.at.as_microsecond();
        let summary = Summary {
            number: 0,
            // As the file has it, so that a row reads the same before and after.
            at: Timestamp::from_microsecond(micro).unwrap_or(about.at),
            scene: about.scene,
            source: about.source,
            is_simulated: about.is_simulated,
            verdict,
            part: nearest.clone().filter(|_| is_named),
            title,
            score: inspection.verdict.score(),
            total_ms: inspection.timings.total.as_secs_f64() * 1e3,
            remark: String::new(),
            label: None,
            frame_bytes: None,
            trace: Traceability::default(),
            hung: about.hung,
            parent: None,
            num_below: 0,
        };
        let detail = InspectionDetail {
            nearest,
            refusal: inspection
                .verdict
                .refusal()
                .map(|why| StoredRefusal::of(why, about.title_of)),
            camera_from_part: pose.map(PoseEstimate::camera_from_part),
            recipe_label: Some(recipe.label.clone()),
            recipe_identity: recipe.identity(),
            recipe: Some(Arc::clone(&recipe.parameters)),
            library_identity: about.library,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            line: about.line,
            thumbnail: Vec::new(),
            origin: about.origin,
            frame: None,
        };
        Self {
            record: Record { summary, detail },
            picture: about.picture.map(small),
            scene: Some(Arc::clone(scene)),
            shots: Vec::new(),
        }
    }

    /// The same, of a scan of these shots.
    #[must_use]
    pub fn of_scan(self, shots: Vec<Shot>) -> Self {
        Self { shots, ..self }
    }

    /// Lets go of what its frames are written from.
    pub(super) fn drop_frames(&mut self) {
        self.scene = None;
        self.shots = Vec::new();
    }
}

impl Summary {
    /// True if an inspection of the same part that is written later stands for it in its place: a part that was refused
    /// and is accepted as it still hangs there is an accepted part. An acceptance stands for good, since a robot may
    /// have acted on it. Neither verdict is changed.
    pub(super) fn gives_way_to(&self, later: &Self) -> bool {
        self.verdict != StoredVerdict::Accepted && later.verdict == StoredVerdict::Accepted
    }
}

/// Every so many pixels one: flat colours stay flat, and the PNG small.
fn small(picture: &RgbImage) -> RgbImage {
    let [width, height] = THUMBNAIL;
    let share = (f64::from(width) / f64::from(picture.width().max(1)))
        .min(f64::from(height) / f64::from(picture.height().max(1)))
        .min(1.0);
    let side = |length: u32| ((f64::from(length) * share).round() as u32).max(1);
    let (width, height) = (side(picture.width()), side(picture.height()));
    resize(picture, width, height, FilterType::Nearest)
}

/// A picture as a PNG.
pub(super) fn png_of(picture: &RgbImage) -> Vec<u8> {
    let mut png = Cursor::new(Vec::new());
    // Into memory, and of a size that every PNG can have.
    let written = picture.write_to(&mut png, ImageFormat::Png);
    written.map_or_else(|_| Vec::new(), |()| png.into_inner())
}

impl InspectionDetail {
    /// The recipe, if this program can read it. One whose name was not written down goes by its identity.
    pub fn named_recipe(&self) -> Option<NamedRecipe> {
        let parameters = Arc::clone(self.recipe.as_ref()?);
        let label = self.recipe_label.clone();
        Some(NamedRecipe {
            label: label.unwrap_or_else(|| RecipeLabel {
                name: self.recipe_identity.clone(),
                is_changed: false,
            }),
            parameters,
        })
    }

    /// The recipe for people: its name, if it is known, and its identity.
    pub fn recipe_text(&self) -> String {
        let identity = &self.recipe_identity;
        match &self.recipe_label {
            Some(label) => format!("{label}, {identity}"),
            None => identity.clone(),
        }
    }
}

impl Record {
    /// The pose's 16 numbers, row after row, metres.
    pub fn matrix(&self) -> Option<[f64; 16]> {
        self.detail.camera_from_part.as_ref().map(row_major)
    }

    /// The times of the stages, milliseconds, in the order in which they ran; empty where the line has none.
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
        // A JSON object has no order of its own.
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
