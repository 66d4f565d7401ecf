//! A part as it is stored.

use image::RgbaImage;
use jiff::Timestamp;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};

use super::{entry::SPRAY_PREFIX, name::PartName};
use crate::{
    files::{crc32, write_ply},
    geometry::{cloud::PointCloud, rigid::row_major},
    stages::{
        contour::ContourParams,
        project::ProjectParams,
        reference::{Coverage, Reference, ReferenceParams, ViewCut},
        signature::{LiteralSignature, SignatureParams},
    },
};

/// The version of the files that this program writes. It reads this one and older ones.
pub const SCHEMA_VERSION: u32 = 2;
/// What a part is written as unless it was scanned: older programs read that too.
pub(super) const PLAIN_VERSION: u32 = 1;
/// Of a part that was enrolled from a scan: older programs do not know its coverage.
pub(super) const SCANNED_VERSION: u32 = 2;

/// An enrolled part with everything its folder holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// `part.toml`.
    pub meta: PartMeta,
    /// `cloud.ply`: the reference cloud with unit normals, part space.
    pub cloud: PointCloud,
    /// `signature.json`.
    pub signature: StoredSignature,
    /// `thumbnail.png`.
    pub thumbnail: RgbaImage,
}

/// What `part.toml` says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PartMeta {
    /// Version of the folder's files.
    pub schema_version: u32,
    /// The part's name, which is that of its folder.
    pub name: PartName,
    /// The part that this is one more reference of, such as another view or another car model; none if it is the
    /// part's own. A verdict names the part, whichever of its references was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<PartName>,
    /// The name for people.
    #[serde(default)]
    pub title: String,
    /// Whatever the person who enrolled it wants to remember.
    #[serde(default)]
    pub notes: String,
    /// From where the cloud was seen.
    pub coverage: Coverage,
    /// True if no real camera saw the part.
    #[serde(default)]
    pub simulated: bool,
    /// The cloud that belongs to it.
    pub cloud: CloudCheck,
    /// Where the view that it was captured from cut it off; nothing of an entry that says nothing of it.
    #[serde(default, skip_serializing_if = "ViewCut::is_nothing")]
    pub cut: ViewCut,
    /// How it came into the library.
    pub enrolled: Enrolment,
    /// The nozzle's path over it, if one was stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spray: Option<SprayCheck>,
}

impl PartMeta {
    /// What it is called.
    pub fn words(&self) -> PartNaming {
        PartNaming {
            name: self.name.clone(),
            title: self.title.clone(),
            notes: self.notes.clone(),
        }
    }

    /// The name of the part that a verdict gives.
    pub fn part_name(&self) -> &PartName {
        self.part.as_ref().unwrap_or(&self.name)
    }

    /// The part that it is one more reference of; none if it is the part's own.
    pub fn reference_of(&self) -> Option<&PartName> {
        self.part.as_ref().filter(|part| **part != self.name)
    }

    /// Its title, or its name where it has none.
    pub fn shown_title(&self) -> &str {
        if self.title.is_empty() {
            self.name.as_str()
        } else {
            &self.title
        }
    }
}

/// What a person calls a part, and may call otherwise later.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartNaming {
    /// Its name.
    pub name: PartName,
    /// Its name for people; may be empty. At most [`MAX_TITLE`] characters.
    pub title: String,
    /// Notes; may be empty.
    pub notes: String,
}

/// The longest title, in characters: one line of a list.
pub const MAX_TITLE: usize = 80;

/// By what `cloud.ply` is known to be the one that was enrolled, every byte of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CloudCheck {
    /// Its points.
    pub num_points: usize,
    /// The CRC-32 of the file, in eight hexadecimal digits.
    pub crc32: String,
}

/// By what a stored spray path is known to be the one that was stored.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SprayCheck {
    /// Its points.
    pub num_points: usize,
    /// The CRC-32 of the file, in eight hexadecimal digits; the file is named after it.
    pub crc32: String,
}

impl SprayCheck {
    /// Of a path that is written as this text.
    pub(super) fn of(text: &str, num_points: usize) -> Self {
        Self {
            num_points,
            crc32: format!("{:08x}", crc32(text.as_bytes())),
        }
    }

    /// The name of its file in the part's folder; `None` if the checksum is none.
    pub(super) fn file_name(&self) -> Option<String> {
        let is_checksum =
            self.crc32.len() == 8 && self.crc32.bytes().all(|c| c.is_ascii_hexdigit());
        is_checksum.then(|| format!("{SPRAY_PREFIX}{}.csv", self.crc32))
    }
}

impl CloudCheck {
    /// Of a file with these bytes and so many points.
    pub(super) fn of(bytes: &[u8], num_points: usize) -> Self {
        Self {
            num_points,
            crc32: format!("{:08x}", crc32(bytes)),
        }
    }

    /// Of the file that this cloud is written as.
    pub fn of_cloud(cloud: &PointCloud) -> Self {
        Self::of(&cloud_bytes(cloud), cloud.points.len())
    }
}

/// How a part came into the library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Enrolment {
    /// When.
    pub at: Timestamp,
    /// From what: the name of a file or a source.
    pub from: String,
    /// In which way.
    pub how: EnrolMethod,
    /// Points of the part before thinning; those sampled of a mesh.
    pub num_points: usize,
    /// Captures that a scan was put together from; none if it was no scan.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub num_shots: Option<usize>,
    /// The cloud was thinned to one point per cube with edges of so many millimetres; none if it was not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub voxel_mm: Option<f64>,
}

/// What a part was enrolled from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EnrolMethod {
    /// The part found in a captured scene.
    Segmented,
    /// A cloud that holds nothing but the part.
    WholeCloud,
    /// A triangle mesh.
    Mesh,
    /// Several captures put together; part space is the camera's frame of the first that was used.
    Scan,
}

impl EnrolMethod {
    /// In words, for people.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Segmented => "the part found in a captured scene",
            Self::WholeCloud => "a whole cloud",
            Self::Mesh => "a mesh",
            Self::Scan => "a scan",
        }
    }
}

/// What `signature.json` says: the standard view, to be read by people and other programs. Rounded to 1 µm and µrad.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredSignature {
    /// Version of the file.
    pub schema_version: u32,
    /// Parameters of the projection.
    pub project: ProjectParams,
    /// Parameters of the contour.
    pub contour: ContourParams,
    /// Parameters of the signature.
    pub signature: SignatureParams,
    /// Takes part space into the view's plane space: a 4×4 matrix, row after row.
    pub plane_from_part: [f64; 16],
    /// The outline in plane space, metres, counter-clockwise, closed, first point not repeated.
    pub outline_m: Vec<[f64; 2]>,
    /// The openings, clockwise, largest first.
    pub openings_m: Vec<Vec<[f64; 2]>>,
    /// Area of the outline less its openings, square metres.
    pub area_m2: f64,
    /// Length of the smoothed outline, metres.
    pub perimeter_m: f64,
    /// Mean of the outline's samples (eq. 10), plane space, metres.
    pub centroid_m: [f64; 2],
    /// Ray lengths L (eq. 8), metres.
    pub lengths_m: Vec<f64>,
    /// Ray angles Θ over the full circle, radians.
    pub angles_rad: Vec<f64>,
    /// The signature as the paper writes it.
    pub literal: StoredLiteral,
}

/// The paper's own signature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredLiteral {
    /// Ray lengths (eq. 8), pixels.
    pub lengths_px: Vec<f64>,
    /// Folded ray angles (eq. 9), radians.
    pub angles_rad: Vec<f64>,
}

/// The bytes of `cloud.ply`.
pub(super) fn cloud_bytes(cloud: &PointCloud) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_ply(&mut bytes, cloud).expect("memory takes everything");
    bytes
}

impl StoredSignature {
    /// The signature of a reference's standard view; `None` if the reference has no view.
    pub fn of(reference: &Reference, params: &ReferenceParams) -> Option<Self> {
        let view = reference.views.first()?;
        let xy = |p: &Point2<f64>| [rounded(p.x), rounded(p.y)];
        let all = |values: &[f64]| values.iter().copied().map(rounded).collect();
        let signature = &view.signature;
        let literal = LiteralSignature::of(&view.contour.outline_pixels);
        Some(Self {
            schema_version: PLAIN_VERSION,
            project: params.project.clone(),
            contour: params.contour.clone(),
            signature: params.signature.clone(),
            plane_from_part: row_major(&view.plane_from_part),
            outline_m: view.contour.outline.iter().map(xy).collect(),
            openings_m: view
                .contour
                .openings
                .iter()
                .map(|opening| opening.iter().map(xy).collect())
                .collect(),
            area_m2: rounded(view.contour.area),
            perimeter_m: rounded(signature.perimeter.0),
            centroid_m: xy(&signature.centroid),
            lengths_m: all(&signature.lengths()),
            angles_rad: all(&signature.angles()),
            literal: StoredLiteral {
                lengths_px: all(&literal.lengths),
                angles_rad: all(&literal.angles),
            },
        })
    }

    /// True if this describes the same outline, to a tenth of a millimetre.
    pub fn agrees_with(&self, other: &Self) -> bool {
        let close = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(x, y)| (x - y).abs() <= 1e-4)
        };
        close(&self.lengths_m, &other.lengths_m)
            && self.outline_m.len() == other.outline_m.len()
            && self.openings_m.len() == other.openings_m.len()
    }
}

fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
