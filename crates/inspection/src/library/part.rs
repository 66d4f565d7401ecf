//! Stored form of a part.

use image::RgbaImage;
use jiff::Timestamp;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};

use super::{entry::SPRAY_PREFIX, name::PartName, side::Side, surface_zones::SurfaceZones};
use files::{crc32, write_ply};
use geometry::{cloud::PointCloud, rigid::row_major};
use stages::{
    contour::ContourParams,
    project::ProjectParams,
    reference::{Coverage, Reference, ReferenceParams, ViewCut},
    signature::{LiteralSignature, SignatureParams},
};
use texts::{Described, Message};

/// Newest version of the files; this program also reads older ones.
pub const SCHEMA_VERSION: u32 = 2;
/// Version of parts seen from one side or all around, which older programs can read too.
pub(super) const PLAIN_VERSION: u32 = 1;
/// Version of parts seen from several sides: older programs do not know this coverage.
pub(super) const SCANNED_VERSION: u32 = 2;

/// An enrolled part with the content of its folder.
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

/// Content of `part.toml`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PartMeta {
    /// Version of the folder's files.
    pub schema_version: u32,
    /// Name of the part and of its folder.
    pub name: PartName,
    /// The part that this is another reference of, such as another view or another car model; `None` if it is the
    /// part's own. The verdict names that part, whichever of its references was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<PartName>,
    /// Title for people.
    #[serde(default)]
    pub title: String,
    /// Notes of the person who enrolled it.
    #[serde(default)]
    pub notes: String,
    /// Directions from which the cloud was seen.
    pub coverage: Coverage,
    /// True if the data do not come from a real camera.
    #[serde(default)]
    pub simulated: bool,
    /// The side that it is painted from; `None` if it was seen from that side alone, or the side is still to be chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<Side>,
    /// Size and checksum of the cloud.
    pub cloud: FileCheck,
    /// Where the field of view of its capture cut the part off; nothing if the file has no such entry.
    #[serde(default, skip_serializing_if = "ViewCut::is_nothing")]
    pub cut: ViewCut,
    /// How the part was enrolled.
    pub enrolled: Enrolment,
    /// The stored spray path, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spray: Option<FileCheck>,
    /// How its surface is checked; `None` if it is not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<SurfaceZones>,
}

impl PartMeta {
    /// Returns name, title and notes.
    pub fn words(&self) -> PartNaming {
        PartNaming {
            name: self.name.clone(),
            title: self.title.clone(),
            notes: self.notes.clone(),
        }
    }

    /// Returns the name of the part that a verdict gives.
    pub fn part_name(&self) -> &PartName {
        self.part.as_ref().unwrap_or(&self.name)
    }

    /// Returns the part that this is another reference of; `None` if it is the part's own.
    pub fn reference_of(&self) -> Option<&PartName> {
        self.part.as_ref().filter(|part| **part != self.name)
    }

    /// Returns the title, or the name if the title is empty.
    pub fn shown_title(&self) -> &str {
        if self.title.is_empty() {
            self.name.as_str()
        } else {
            &self.title
        }
    }
}

/// Name, title and notes of a part, all of which can be changed later.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartNaming {
    /// Name of the part.
    pub name: PartName,
    /// Title for people, at most [`MAX_TITLE`] characters; may be empty.
    pub title: String,
    /// Notes; may be empty.
    pub notes: String,
}

/// Maximum length of a title, characters: one line of a list.
pub const MAX_TITLE: usize = 80;

/// Size and checksum that identify a file of a part, its cloud or its spray path, byte for byte.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileCheck {
    /// Number of points.
    pub num_points: usize,
    /// CRC-32 of the file, eight hexadecimal digits.
    pub crc32: String,
}

impl FileCheck {
    /// Computes the check of a file with these bytes and this number of points.
    pub(super) fn from_bytes(bytes: &[u8], num_points: usize) -> Self {
        Self {
            num_points,
            crc32: format!("{:08x}", crc32(bytes)),
        }
    }

    /// Computes the check of the file that this cloud is written as.
    pub fn of_cloud(cloud: &PointCloud) -> Self {
        Self::from_bytes(&cloud_bytes(cloud), cloud.points.len())
    }

    /// Returns the name of the spray path's file in the part's folder; `None` if the checksum is malformed.
    pub(super) fn spray_file_name(&self) -> Option<String> {
        let is_checksum =
            self.crc32.len() == 8 && self.crc32.bytes().all(|c| c.is_ascii_hexdigit());
        is_checksum.then(|| format!("{SPRAY_PREFIX}{}.csv", self.crc32))
    }
}

/// How a part was enrolled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Enrolment {
    /// Time of enrolment.
    pub at: Timestamp,
    /// Name of the file or source.
    pub from: String,
    /// Kind of data it was enrolled from.
    pub how: EnrolMethod,
    /// Number of points of the part before thinning, or sampled from a mesh.
    pub num_points: usize,
    /// Number of shots used; `None` if it is not a scan.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub num_shots: Option<usize>,
    /// Edge of the voxels used for thinning, millimetres; `None` if the cloud was not thinned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub voxel_mm: Option<f64>,
    /// Width, height and depth of the cloud in part space, millimetres; `None` in files of older versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size_mm: Option<[f64; 3]>,
}

/// The kind of data that a part was enrolled from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EnrolMethod {
    /// The part found in a captured scene.
    Segmented,
    /// A cloud that contains only the part.
    WholeCloud,
    /// A triangle mesh.
    Mesh,
    /// Several fused captures; part space is the camera frame of the first one used.
    Scan,
}

impl Described for EnrolMethod {
    fn message(&self) -> Message {
        Message::new(match self {
            Self::Segmented => "enrolled-from-segmented",
            Self::WholeCloud => "enrolled-from-whole-cloud",
            Self::Mesh => "enrolled-from-mesh",
            Self::Scan => "enrolled-from-scan",
        })
    }
}

texts::display!(EnrolMethod);

/// Content of `signature.json`: the standard view for people and other programs. Rounded to 1 µm and µrad.
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
    /// Transform from part space to the view's plane space: a 4×4 matrix in row-major order.
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
    /// The signature in the paper's form.
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

/// Returns the bytes of `cloud.ply`.
pub(super) fn cloud_bytes(cloud: &PointCloud) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_ply(&mut bytes, cloud).expect("memory takes everything");
    bytes
}

impl StoredSignature {
    /// Computes the signature of a reference's standard view; `None` if the reference has no view.
    pub fn of(reference: &Reference, params: &ReferenceParams) -> Option<Self> {
        let view = reference.views.first()?;
        let contour = view.contour();
        let xy = |p: &Point2<f64>| [rounded(p.x), rounded(p.y)];
        let all = |values: &[f64]| values.iter().copied().map(rounded).collect();
        let signature = view.signature();
        let literal = LiteralSignature::of(&contour.outline_pixels);
        Some(Self {
            schema_version: PLAIN_VERSION,
            project: params.project.clone(),
            contour: params.contour.clone(),
            signature: params.signature.clone(),
            plane_from_part: row_major(&view.plane_from_part),
            outline_m: contour.outline.iter().map(xy).collect(),
            openings_m: contour
                .openings
                .iter()
                .map(|opening| opening.iter().map(xy).collect())
                .collect(),
            area_m2: rounded(contour.area),
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

    /// Returns whether both describe the same outline, to a tenth of a millimetre.
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
