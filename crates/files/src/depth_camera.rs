//! The camera of a depth image, read from the JSON file beside it.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize, de::IgnoredAny};

use super::error::FileError;
use super::import::file_of;
use super::names::num_edits;
use super::source::read_limited;
use geometry::error::Advice;
use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    distortion::Distortion,
};

/// Returns the path of a depth image's camera: the same name with the ending `.json`.
pub fn intrinsics_path(image: &Path) -> PathBuf {
    image.with_extension("json")
}

/// The file with the camera of all depth images in a folder that have no JSON of their own.
pub const FOLDER_CAMERA: &str = "intrinsics.json";

/// The largest camera file that is read, in bytes.
pub(super) const MAX_CAMERA_BYTES: u64 = 1 << 20;

/// The camera of a depth image, read from the JSON file beside it. All numbers refer to the image as stored.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written")]
pub struct DepthCamera {
    /// Size of the image, focal lengths, principal point and lens distortion.
    #[serde(flatten)]
    pub intrinsics: Intrinsics,
    /// Metres per unit of the image, above 0.
    pub metres_per_unit: f64,
    /// True for a simulated camera.
    #[serde(rename = "simulated", skip_serializing_if = "std::ops::Not::not")]
    pub is_simulated: bool,
    /// How the stored image differs from the camera's own view.
    #[serde(flatten)]
    pub stored: StoredOrientation,
}

/// How a stored image differs from the camera's own view. Loading corrects it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct StoredOrientation {
    /// True if left and right are swapped. This is corrected first.
    #[serde(rename = "mirrored", skip_serializing_if = "std::ops::Not::not")]
    pub is_mirrored: bool,
    /// The clockwise turn that the image then needs.
    #[serde(rename = "rotated", skip_serializing_if = "Turn::is_none")]
    pub turn: Turn,
}

/// A clockwise turn of an image, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "i64", into = "i64")]
pub enum Turn {
    /// No turn.
    #[default]
    None,
    /// 90°: the left edge comes to the top.
    Quarter,
    /// 180°.
    Half,
    /// 270°: the right edge comes to the top.
    ThreeQuarters,
}

impl Turn {
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands over a reference"
    )]
    fn is_none(&self) -> bool {
        *self == Self::None
    }
}

impl TryFrom<i64> for Turn {
    type Error = String;

    fn try_from(degrees: i64) -> Result<Self, String> {
        Ok(match degrees {
            0 => Self::None,
            90 => Self::Quarter,
            180 => Self::Half,
            270 => Self::ThreeQuarters,
            _ => return Err(format!("rotated is {degrees}, expected 0, 90, 180 or 270")),
        })
    }
}

impl From<Turn> for i64 {
    fn from(turn: Turn) -> Self {
        match turn {
            Turn::None => 0,
            Turn::Quarter => 90,
            Turn::Half => 180,
            Turn::ThreeQuarters => 270,
        }
    }
}

/// The JSON as people and other programs write it.
#[derive(Deserialize)]
struct Written {
    #[serde(flatten)]
    intrinsics: Intrinsics,
    metres_per_unit: Option<f64>,
    /// Metres per unit or units per metre: programs differ.
    depth_scale: Option<f64>,
    #[serde(default)]
    simulated: bool,
    #[serde(flatten)]
    stored: StoredOrientation,
    distortion: Option<WrittenDistortion>,
}

/// Distortion coefficients under a key of their own.
#[derive(Deserialize)]
#[serde(untagged)]
enum WrittenDistortion {
    Named(Distortion),
    Listed(Vec<f64>),
    Other(IgnoredAny),
}

/// Tells the two meanings of `depth_scale` apart: below this it is metres per unit, above 1 / this units per metre.
const LONGEST_UNIT: f64 = 0.1;

impl TryFrom<Written> for DepthCamera {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        let metres_per_unit = match (written.metres_per_unit, written.depth_scale) {
            (None, Some(scale)) => metres_of_scale(scale)?,
            // A scale that is no unit, such as 1, is another program's own.
            (Some(metres), Some(scale))
                if metres_of_scale(scale).is_ok_and(|other| !is_same(metres, other)) =>
            {
                return Err(format!(
                    "metres_per_unit is {metres} and depth_scale {scale}, which are different units: remove the wrong one"
                ));
            }
            (Some(metres), _) => metres,
            (None, None) => return Err("missing field `metres_per_unit`".into()),
        };
        let mut intrinsics = written.intrinsics;
        let listed = match written.distortion {
            Some(WrittenDistortion::Named(distortion)) => Some(distortion),
            Some(WrittenDistortion::Listed(list)) => {
                Some(Distortion::from_list(&list).ok_or_else(|| {
                    "distortion has more coefficients than k1 k2 p1 p2 k3 k4 k5 k6".to_owned()
                })?)
            }
            Some(WrittenDistortion::Other(_)) | None => None,
        };
        if let Some(listed) = listed {
            if !intrinsics.distortion.is_none() && intrinsics.distortion != listed {
                return Err(
                    "the coefficients in distortion differ from those beside it, such as k1: remove the wrong ones"
                        .into(),
                );
            }
            intrinsics.distortion = listed;
        }
        Ok(Self {
            intrinsics,
            metres_per_unit,
            is_simulated: written.simulated,
            stored: written.stored,
        })
    }
}

fn metres_of_scale(scale: f64) -> Result<f64, String> {
    if scale < LONGEST_UNIT {
        Ok(scale)
    } else if scale > 1.0 / LONGEST_UNIT {
        Ok(1.0 / scale)
    } else {
        Err(format!(
            "depth_scale is {scale}, expected metres per unit such as 0.001, or units per metre such as 1000"
        ))
    }
}

/// True for one unit written in two ways, with the rounding of a decimal.
fn is_same(metres: f64, other: f64) -> bool {
    (metres - other).abs() <= 1e-6 * metres.abs()
}

/// A field of the JSON that is not read, and is spelt nearly like one that is.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Advice)]
#[error("{}: the field {written} is not read, probably {known} is meant", path.display())]
#[advice = "Rename the field to {known}, or remove it"]
pub struct MisspeltField {
    path: PathBuf,
    written: String,
    known: &'static str,
}

/// The fields that may be missing; without one of the others there is an error anyway.
const OPTIONAL: [&str; 14] = [
    "metres_per_unit",
    "depth_scale",
    "simulated",
    "mirrored",
    "rotated",
    "distortion",
    "k1",
    "k2",
    "k3",
    "k4",
    "k5",
    "k6",
    "p1",
    "p2",
];
/// Shorter words are too easily another program's own.
const LEAST_LETTERS: usize = 7;
/// Most letters that are added, missing or exchanged in a misspelt word.
const MOST_WRONG: usize = 2;

/// True if the word differs from the field's name by its case or by a letter or two.
fn is_nearly(written: &str, known: &str) -> bool {
    if written == known {
        return false;
    }
    written.eq_ignore_ascii_case(known)
        || known.len() >= LEAST_LETTERS && num_edits(written, known) <= MOST_WRONG
}

/// Returns the misspelt fields of a camera's JSON.
fn misspelt(path: &Path, json: &[u8]) -> Vec<MisspeltField> {
    let fields: serde_json::Map<String, serde_json::Value> =
        serde_json::from_slice(json).unwrap_or_default();
    let misspelt = |written: &String| {
        // A word longer than any field's name needs no comparison.
        let known = OPTIONAL.into_iter().filter(|_| written.len() < 20);
        let mut known = known.filter(|known| is_nearly(written, known));
        Some(MisspeltField {
            path: path.to_owned(),
            written: written.clone(),
            known: known.find(|known| !fields.contains_key(*known))?,
        })
    };
    let others = fields
        .keys()
        .filter(|key| !OPTIONAL.contains(&key.as_str()));
    others.filter_map(misspelt).collect()
}

/// The error of a camera of which some pixels have no ray of their own.
const FOLDS: &str = "the distortion folds back inside the picture";

impl DepthCamera {
    /// Returns the camera that took a frame.
    pub fn from_frame(frame: &DepthFrame) -> Self {
        Self {
            intrinsics: frame.intrinsics,
            metres_per_unit: frame.metres_per_unit,
            is_simulated: frame.is_simulated,
            stored: StoredOrientation::default(),
        }
    }

    /// Reads the JSON and checks its numbers.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let bad = |found: String| FileError::BadIntrinsics {
            path: path.to_owned(),
            found,
        };
        let camera: Self = serde_json::from_slice(&read_limited(path, MAX_CAMERA_BYTES)?)
            .map_err(|error| bad(error.to_string()))?;
        camera.checked().map_err(|found| match found {
            found if found == FOLDS => FileError::FoldingDistortion {
                path: path.to_owned(),
            },
            found => bad(found),
        })
    }

    /// Returns the misspelt fields of the camera that a depth image is read with; none for other files.
    pub fn misspelt_fields(image: &Path) -> Vec<MisspeltField> {
        let image = file_of(image);
        let is_png = image
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        let own = intrinsics_path(&image);
        let json = if own.exists() {
            own
        } else {
            own.with_file_name(FOLDER_CAMERA)
        };
        let bytes = is_png.then(|| read_limited(&json, MAX_CAMERA_BYTES).ok());
        bytes
            .flatten()
            .map_or_else(Vec::new, |bytes| misspelt(&json, &bytes))
    }

    /// Returns the camera if its numbers are possible, else what is wrong with them.
    pub fn checked(self) -> Result<Self, String> {
        let Self {
            intrinsics,
            metres_per_unit,
            ..
        } = self;
        if !(intrinsics.fx > 0.0 && intrinsics.fy > 0.0 && metres_per_unit > 0.0) {
            return Err("fx, fy and metres_per_unit must be above 0".into());
        }
        let sum = intrinsics.fx + intrinsics.fy + intrinsics.cx + intrinsics.cy + metres_per_unit;
        if !(sum.is_finite() && intrinsics.distortion.is_finite()) {
            return Err("a number is not finite".into());
        }
        if !intrinsics.is_invertible() {
            return Err(FOLDS.into());
        }
        Ok(self)
    }

    /// Builds the frame as the camera saw it from stored depths of a picture of `size` pixels. The error describes what is wrong.
    pub fn frame(self, size: (usize, usize), depth: Vec<u16>) -> Result<DepthFrame, String> {
        let Intrinsics { width, height, .. } = self.intrinsics;
        if (width, height) != size {
            return Err(format!(
                "{width}×{height} pixels, where the image has {}×{}",
                size.0, size.1
            ));
        }
        let stored = DepthFrame {
            intrinsics: self.intrinsics,
            metres_per_unit: self.metres_per_unit,
            depth,
            is_simulated: self.is_simulated,
        };
        Ok(self.stored.put_right(stored))
    }
}

impl StoredOrientation {
    /// Undoes mirroring and turning.
    fn put_right(self, mut frame: DepthFrame) -> DepthFrame {
        if self.is_mirrored {
            let width = frame.intrinsics.width.max(1);
            frame.depth.chunks_mut(width).for_each(<[u16]>::reverse);
            frame.intrinsics = frame.intrinsics.mirrored();
        }
        let turned = frame.intrinsics.turned_clockwise();
        match self.turn {
            Turn::None => {}
            Turn::Quarter => {
                frame.depth = turned_clockwise(&frame);
                frame.intrinsics = turned;
            }
            Turn::Half => {
                frame.depth.reverse();
                frame.intrinsics = turned.turned_clockwise();
            }
            Turn::ThreeQuarters => {
                frame.depth = turned_clockwise(&frame);
                frame.depth.reverse();
                frame.intrinsics = turned.turned_clockwise().turned_clockwise();
            }
        }
        frame
    }
}

fn turned_clockwise(frame: &DepthFrame) -> Vec<u16> {
    let Intrinsics { width, height, .. } = frame.intrinsics;
    let mut turned = Vec::with_capacity(frame.depth.len());
    for u in 0..width {
        // From the bottom up: the left column becomes the top row.
        turned.extend((0..height).rev().map(|v| frame.depth[v * width + u]));
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(extra: &str) -> Result<DepthCamera, String> {
        let json =
            format!(r#"{{"width":4,"height":3,"fx":500,"fy":501.5,"cx":1.25,"cy":0.5{extra}}}"#);
        serde_json::from_str(&json).map_err(|error| error.to_string())
    }

    #[test]
    fn coefficients_stand_beside_the_other_numbers_or_in_a_field_of_their_own() {
        let expected = Distortion {
            k1: -0.1,
            k2: 0.02,
            p1: 0.003,
            k5: 4.0,
            ..Distortion::NONE
        };
        for extra in [
            r#""k1":-0.1,"k2":0.02,"p1":0.003,"k5":4"#,
            r#""distortion":{"k1":-0.1,"k2":0.02,"p1":0.003,"k5":4}"#,
            r#""distortion":[-0.1,0.02,0.003,0,0,0,4,0]"#,
        ] {
            let camera = camera(&format!(r#","metres_per_unit":0.001,{extra}"#)).expect(extra);
            assert_eq!(camera.intrinsics.distortion, expected, "{extra}");
            let json = serde_json::to_string(&camera).expect("JSON");
            assert_eq!(
                serde_json::from_str::<DepthCamera>(&json).expect("read again"),
                camera
            );
        }
        let plain = camera(r#","metres_per_unit":0.001,"distortion":"none","lens":7"#);
        let plain = plain.expect("other fields are read over");
        assert!(plain.intrinsics.distortion.is_none());
        let json = serde_json::to_string(&plain).expect("JSON");
        assert_eq!(
            json,
            r#"{"width":4,"height":3,"fx":500.0,"fy":501.5,"cx":1.25,"cy":0.5,"metres_per_unit":0.001}"#
        );
        let prism = camera(r#","metres_per_unit":0.001,"distortion":[0,0,0,0,0,0,0,0,0.1]"#);
        assert!(
            prism
                .expect_err("a thin prism")
                .contains("more coefficients")
        );
    }

    #[test]
    fn the_unit_has_more_than_one_name() {
        let unit = |extra: &str| camera(extra).map(|camera| camera.metres_per_unit);
        assert_eq!(unit(r#","metres_per_unit":0.25"#), Ok(0.25));
        assert_eq!(unit(r#","depth_scale":0.00025"#), Ok(0.00025));
        assert_eq!(unit(r#","depth_scale":4000"#), Ok(0.00025));
        assert_eq!(
            unit(r#","metres_per_unit":0.001,"depth_scale":1000"#),
            Ok(0.001)
        );
        assert!(unit(r#","depth_scale":1"#).is_err_and(|error| error.contains("depth_scale")));
        assert!(unit("").is_err_and(|error| error.contains("metres_per_unit")));
    }

    #[test]
    fn fields_that_contradict_each_other_are_refused() {
        let refused = |extra: &str| camera(extra).expect_err(extra);
        let units = refused(r#","metres_per_unit":0.001,"depth_scale":4000"#);
        assert!(units.contains("remove the wrong one"), "{units}");
        let other = camera(r#","metres_per_unit":0.001,"depth_scale":1"#).expect("no unit");
        assert!((other.metres_per_unit - 0.001).abs() < 1e-12);
        for listed in ["[0,0,0,0,0]", r#"{"k1":-0.2}"#] {
            let extra = format!(r#","metres_per_unit":0.001,"k1":0.1,"distortion":{listed}"#);
            let lens = refused(&extra);
            assert!(lens.contains("differ") && lens.contains("k1"), "{lens}");
        }
        let same = camera(r#","metres_per_unit":0.001,"k1":0.1,"distortion":[0.1]"#);
        let same = same.expect("the same twice");
        assert!((same.intrinsics.distortion.k1 - 0.1).abs() < 1e-12);
    }

    #[test]
    fn misspelt_fields_are_found_and_those_of_other_programs_are_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let image = folder.path().join("a.png");
        let found = |json: &str| {
            std::fs::write(folder.path().join(FOLDER_CAMERA), json).expect("written");
            let found = DepthCamera::misspelt_fields(&image).into_iter();
            found.map(|field| field.known).collect::<Vec<_>>()
        };
        assert_eq!(found(r#"{"mirror_ed":true}"#), ["mirrored"]);
        assert_eq!(found(r#"{"Mirrored":true,"K1":0.1}"#), ["k1", "mirrored"]);
        assert_eq!(found(r#"{"rotate":90}"#), ["rotated"]);
        assert_eq!(found(r#"{"mirrored":true,"Mirrored":true}"#), [""; 0]);
        let other = r#"{"width":4,"ppx":1,"K":[1],"model":"x","distortion_model":"none","scale":1,
            "rotation":[1],"depth_units":0.001,"p3":0,"serial":"1","mirrored":true}"#;
        assert_eq!(found(other), [""; 0]);
        assert_eq!(found("no JSON"), [""; 0]);
        let cloud = folder.path().join("a.pcd");
        std::fs::write(folder.path().join(FOLDER_CAMERA), r#"{"mirror_ed":true}"#)
            .expect("written");
        assert!(DepthCamera::misspelt_fields(&cloud).is_empty());
    }

    /// Builds a frame from a stored 4×3 image whose depths number its pixels.
    fn loaded(extra: &str) -> DepthFrame {
        let camera = camera(&format!(
            r#","metres_per_unit":0.001,"p1":0.02,"p2":0.05{extra}"#
        ));
        let camera = camera.and_then(DepthCamera::checked).expect(extra);
        camera.frame((4, 3), (0..12).collect()).expect("4×3")
    }

    #[test]
    fn a_flag_puts_the_stored_image_right() {
        let expected: [(&str, usize, [u16; 12]); 7] = [
            ("", 4, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]),
            (
                r#","mirrored":true"#,
                4,
                [3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8],
            ),
            (
                r#","rotated":90"#,
                3,
                [8, 4, 0, 9, 5, 1, 10, 6, 2, 11, 7, 3],
            ),
            (
                r#","rotated":180"#,
                4,
                [11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0],
            ),
            (
                r#","rotated":270"#,
                3,
                [3, 7, 11, 2, 6, 10, 1, 5, 9, 0, 4, 8],
            ),
            // Mirrored back first, then turned a quarter clockwise.
            (
                r#","mirrored":true,"rotated":90"#,
                3,
                [11, 7, 3, 10, 6, 2, 9, 5, 1, 8, 4, 0],
            ),
            (
                r#","mirrored":false,"rotated":0"#,
                4,
                [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11],
            ),
        ];
        for (extra, width, depth) in expected {
            let frame = loaded(extra);
            assert_eq!(
                (frame.intrinsics.width, &frame.depth[..]),
                (width, &depth[..]),
                "{extra}"
            );
        }
        assert!(camera(r#","metres_per_unit":0.001,"rotated":45"#).is_err());
    }

    #[test]
    fn the_rays_turn_with_the_image() {
        let stored = loaded("");
        for (extra, mirror, clockwise) in [
            (r#","mirrored":true"#, true, 0),
            (r#","rotated":90"#, false, 1),
            (r#","rotated":180"#, false, 2),
            (r#","rotated":270"#, false, 3),
            (r#","mirrored":true,"rotated":270"#, true, 3),
        ] {
            let frame = loaded(extra);
            let (camera, width) = (frame.intrinsics, frame.intrinsics.width);
            for (i, place) in frame.depth.iter().enumerate() {
                let found = camera.point_at((i % width) as f64, (i / width) as f64, 1.0);
                let (u, v) = (f64::from(place % 4), f64::from(place / 4));
                let mut expected = stored.intrinsics.point_at(u, v, 1.0);
                if mirror {
                    expected.x = -expected.x;
                }
                for _ in 0..clockwise {
                    // Right becomes down, down becomes left.
                    (expected.x, expected.y) = (-expected.y, expected.x);
                }
                assert!(
                    (found - expected).norm() < 1e-9,
                    "{extra}: {found} {expected}"
                );
            }
        }
    }
}
