//! What the tests write.

use std::{path::Path, sync::Arc};

use image::RgbImage;
use jiff::{SignedDuration, Timestamp};

use super::{History, HungId, InspectionDetail, NewEntry, Record, StoredVerdict, Summary};
use crate::{
    geometry::{
        depth_frame::{DepthFrame, Intrinsics},
        distortion::Distortion,
        rigid::from_euler_zyx,
    },
    pipeline::{Recipe, RecipeLabel},
    stages::scene::{SceneCloud, scene_from_frame},
};

/// A moment, counted in seconds from the first.
pub(super) fn moment(seconds: i64) -> Timestamp {
    let first: Timestamp = "2026-03-01T06:00:00Z".parse().expect("a time");
    first + SignedDuration::from_secs(seconds)
}

/// A small scene, another for every seed.
pub(super) fn scene(seed: u16) -> Arc<SceneCloud> {
    let camera = Intrinsics {
        width: 32,
        height: 24,
        fx: 26.0,
        fy: 26.0,
        cx: 15.5,
        cy: 11.5,
        distortion: Distortion::NONE,
    };
    let depth = (0..32 * 24_u32).map(|i| (900 + (i * 7 + u32::from(seed) * 13) % 400) as u16);
    Arc::new(scene_from_frame(&DepthFrame {
        intrinsics: camera,
        metres_per_unit: 0.001,
        depth: depth.collect(),
        is_simulated: false,
    }))
}

/// An inspection of that moment.
pub(super) fn entry(seconds: i64, verdict: StoredVerdict, part: &str) -> NewEntry {
    let is_named = matches!(
        verdict,
        StoredVerdict::Accepted | StoredVerdict::NotAccepted
    );
    let recipe = Recipe::default();
    NewEntry {
        record: Record {
            summary: Summary {
                number: 0,
                at: moment(seconds),
                scene: format!("frame {seconds}"),
                source: "simulated".into(),
                is_simulated: true,
                verdict,
                part: is_named.then(|| part.to_owned()),
                title: part.replace('_', " "),
                score: (verdict != StoredVerdict::NoPart).then_some([0.97, 0.25]),
                total_ms: 31.5,
                remark: String::new(),
                label: None,
                frame_bytes: None,
                hung: HungId::new(),
                parent: None,
                num_below: 0,
            },
            detail: InspectionDetail {
                nearest: Some(part.to_owned()),
                complaint: Some(["too low".into(), "look again".into()])
                    .filter(|_| verdict != StoredVerdict::Accepted),
                camera_from_part: Some(from_euler_zyx([0.1, 0.2, 0.3, 0.01, 0.02, 1.4])),
                recipe_label: Some(RecipeLabel::default()),
                recipe_identity: recipe.identity(),
                recipe: Some(Arc::new(recipe)),
                library_identity: "0badcafe".into(),
                program: "0.1.0".into(),
                line: r#"{"schema":1,"timings_ms":{"pose":20.5,"total":31.5,"segment":8.0}}"#
                    .into(),
                thumbnail: Vec::new(),
                origin: Some("{}".into()),
                frame: None,
            },
        },
        picture: Some(RgbImage::from_pixel(16, 12, image::Rgb([200, 150, 40]))),
        scene: Some(scene(seconds as u16)),
        shots: Vec::new(),
    }
}

/// A history in a new folder.
pub(super) fn opened() -> (tempfile::TempDir, History) {
    let folder = tempfile::tempdir().expect("a folder");
    let history = open(folder.path());
    (folder, history)
}

pub(super) fn open(folder: &Path) -> History {
    let opened = History::open(folder).expect("opened");
    assert_eq!(opened.set_aside, None);
    opened.history
}
