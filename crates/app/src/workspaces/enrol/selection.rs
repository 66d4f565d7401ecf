//! The corrections of a person, and the points that they leave.

use image::{Rgb, RgbImage};
use serde::{Deserialize, Serialize};

use super::{
    outline::DrawnOutline,
    segments::{PointAction, SegmentKind, Segments},
    subject::{EnrolInput, InitialSelection},
};
use files::crc32;
use geometry::cloud::is_finite;
use stages::segment::PointLabel;
use ui::{
    language::text,
    viewport::{PointSet, Role, ViewColours},
};

/// All corrections, in order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Corrections {
    /// The selection that they start from.
    pub taking: InitialSelection,
    /// The corrections, the first one first.
    pub edits: Vec<Edit>,
}

impl Corrections {
    /// No corrections to this selection.
    pub fn none(taking: InitialSelection) -> Self {
        Self {
            taking,
            edits: Vec::new(),
        }
    }
}

/// One correction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edit {
    /// Keep or drop a segment, given its index.
    Segment(usize, PointAction),
    /// Keep or drop points by a box or lasso.
    Outline(OutlineMode, DrawnOutline),
}

/// What a drawn box or lasso does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutlineMode {
    /// Drops everything outside.
    #[default]
    Keep,
    /// Drops everything inside.
    Drop,
    /// Keeps everything inside, background included.
    Add,
}

impl OutlineMode {
    /// Every mode, in the order of the buttons.
    pub const ALL: [Self; 3] = [Self::Keep, Self::Drop, Self::Add];

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::Keep => text!("enrol-keep"),
            Self::Drop => text!("enrol-drop"),
            Self::Add => text!("enrol-add"),
        }
    }

    /// Describes what it does.
    pub fn explanation(self) -> String {
        match self {
            Self::Keep => text!("enrol-keep-hint"),
            Self::Drop => text!("enrol-drop-hint"),
            Self::Add => text!("enrol-add-hint"),
        }
    }
}

/// The points of an input that are kept, and how they are drawn.
#[derive(Debug)]
pub struct Selection {
    /// Indices of the kept points, ascending.
    pub indices: Vec<u32>,
    /// Number of kept points of each segment.
    pub kept_of: Vec<usize>,
    /// The points for a 3-D view: kept points as part, the rest by their kind.
    pub points: PointSet,
    /// The input as the camera sees it, kept points bright.
    pub picture: RgbImage,
    /// For each pixel of the picture the index of the segment seen there, or [`Segments::NONE`].
    pub segment_at: Vec<u16>,
}

impl Selection {
    /// Applies the corrections and prepares what is drawn.
    pub(super) fn of(subject: &EnrolInput, corrections: &Corrections) -> Self {
        let segments = subject.segments(corrections.taking);
        let kept = kept(subject, corrections);
        let mut kept_of = vec![0; segments.list.len()];
        let of_kept = segments.of_point.iter().zip(&kept);
        for (of, _) in of_kept.filter(|(_, is_kept)| **is_kept) {
            kept_of[usize::from(*of)] += 1;
        }
        let labels = labels(segments, &kept);
        let (picture, segment_at) = picture(subject, segments, &labels);
        let indices = (0..kept.len()).filter(|i| kept[*i]);
        Self {
            indices: indices.map(|i| i as u32).collect(),
            kept_of,
            points: PointSet::segmented(subject.positions.clone(), &labels),
            picture,
            segment_at,
        }
    }

    /// Checksum of the indices of the kept points.
    pub(super) fn checksum(&self) -> u32 {
        crc32(bytemuck::cast_slice(&self.indices))
    }
}

/// Returns for each point whether it is kept.
fn kept(subject: &EnrolInput, corrections: &Corrections) -> Vec<bool> {
    let segments = subject.segments(corrections.taking);
    let of_point = &segments.of_point;
    let usual: Vec<bool> = segments
        .list
        .iter()
        .map(|s| s.usual == PointAction::Kept)
        .collect();
    let is_usual = |of: &u16| usual.get(usize::from(*of)).copied().unwrap_or(false);
    let mut kept: Vec<bool> = of_point.iter().map(is_usual).collect();
    for edit in &corrections.edits {
        match edit {
            Edit::Segment(segment, fate) => {
                let of_it = of_point.iter().zip(&mut kept);
                for (_, kept) in of_it.filter(|(of, _)| usize::from(**of) == *segment) {
                    *kept = *fate == PointAction::Kept;
                }
            }
            Edit::Outline(mode, outline) => {
                let enclosed = outline.encloses(subject);
                let readings = of_point.iter().zip(enclosed).zip(&mut kept);
                for ((_, is_inside), kept) in readings.filter(|((of, _), _)| **of != Segments::NONE)
                {
                    *kept = match mode {
                        OutlineMode::Keep => *kept && is_inside,
                        OutlineMode::Drop => *kept && !is_inside,
                        OutlineMode::Add => *kept || is_inside,
                    };
                }
            }
        }
    }
    kept
}

fn labels(segments: &Segments, kept: &[bool]) -> Vec<PointLabel> {
    let label = |(of, is_kept): (&u16, &bool)| match segments.list.get(usize::from(*of)) {
        None => PointLabel::NoReading,
        Some(_) if *is_kept => PointLabel::Part,
        Some(segment) => match segment.kind {
            SegmentKind::Plane(plane) => PointLabel::Background(plane),
            SegmentKind::Surface | SegmentKind::Specks => PointLabel::Rest,
        },
    };
    segments.of_point.iter().zip(kept).map(label).collect()
}

/// Renders the input, and the segment seen at each pixel. Kept points differ in brightness and hue; nearer is brighter.
/// The colours are the same in every theme.
fn picture(
    subject: &EnrolInput,
    segments: &Segments,
    labels: &[PointLabel],
) -> (RgbImage, Vec<u16>) {
    let [width, height] = subject.picture.size();
    let spread = subject.picture.spread();
    let cloud = subject.cloud();
    let mut seen: Vec<Option<u32>> = vec![None; width * height];
    let (mut nearest, mut farthest) = (f32::INFINITY, f32::NEG_INFINITY);
    for (index, point) in cloud.finite() {
        (nearest, farthest) = (nearest.min(point.z), farthest.max(point.z));
        let [column, row] = subject.picture.pixel(index, point);
        let about = |at: usize, end: usize| at.saturating_sub(spread)..=(at + spread).min(end - 1);
        for row in about(row, height) {
            for column in about(column, width) {
                let slot = &mut seen[row * width + column];
                if slot.is_none_or(|other| point.z < cloud.points[other as usize].z) {
                    *slot = Some(index as u32);
                }
            }
        }
    }
    let range = (farthest - nearest).max(1e-3);
    let colours = ViewColours::dark();
    let colour_at = |pixel: usize| -> Option<Rgb<u8>> {
        let index = seen[pixel]? as usize;
        let role = Role::of(*labels.get(index)?);
        let colour = colours.role(role).colour;
        let nearness = 1.0 - (cloud.points[index].z - nearest) / range;
        // The 3-D view shades these colours by its light; here nearness does.
        let brightness = match role {
            Role::Part => 0.75 + 0.25 * nearness,
            Role::Rest => 0.35 + 0.2 * nearness,
            _ => 0.8 + 0.4 * nearness,
        };
        let channel = |c: u8| (f32::from(c) * brightness).min(255.0) as u8;
        Some(Rgb([colour.r(), colour.g(), colour.b()].map(channel)))
    };
    let image = RgbImage::from_fn(width as u32, height as u32, |u, v| {
        colour_at(v as usize * width + u as usize).unwrap_or(Rgb([0; 3]))
    });
    let is_read = |index: &u32| is_finite(&cloud.points[*index as usize]);
    let segment = |slot: &Option<u32>| {
        let index = slot.filter(is_read);
        index.map_or(Segments::NONE, |index| segments.of_point[index as usize])
    };
    (image, seen.iter().map(segment).collect())
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::workspaces::enrol::outline::DrawnOver;
    use inspection::library::EnrolParams;
    use shell::inspection::source::{CellChoice, SceneSource};
    use simulate::{PartKind, Side};

    fn captured() -> EnrolInput {
        let source = SceneSource::Cell {
            choice: CellChoice::Part(PartKind::BackDoor, Side::Right),
            number: 5,
        };
        let read = EnrolInput::read(
            &source,
            &EnrolParams::default(),
            &shell::inspection::camera::Camera::default(),
            &|| false,
        )
        .expect("a frame");
        read.expect("a subject")
    }

    fn with(subject: &EnrolInput, edits: &[Edit]) -> Selection {
        let corrections = Corrections {
            taking: InitialSelection::Segmented,
            edits: edits.to_vec(),
        };
        Selection::of(subject, &corrections)
    }

    /// The left half of the picture.
    fn left(mode: OutlineMode) -> Edit {
        let corners = [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]];
        let outline = DrawnOutline {
            corners: corners.map(Vec2::from).into(),
            over: DrawnOver::Picture,
        };
        Edit::Outline(mode, outline)
    }

    #[test]
    fn a_kept_box_and_the_same_box_dropped_share_the_part_between_them() {
        let subject = captured();
        let all = with(&subject, &[]).indices;
        let kept = with(&subject, &[left(OutlineMode::Keep)]).indices;
        let dropped = with(&subject, &[left(OutlineMode::Drop)]).indices;
        assert!(kept.iter().all(|i| i % 640 < 320) && dropped.iter().all(|i| i % 640 >= 320));
        let mut both = [kept, dropped].concat();
        both.sort_unstable();
        assert_eq!(both, all);
    }

    #[test]
    fn a_box_adds_the_background_too_and_never_what_was_not_read() {
        let subject = captured();
        let added = with(&subject, &[left(OutlineMode::Add)]);
        let cloud = subject.cloud();
        let inside = cloud.finite().filter(|(i, _)| i % 640 < 320).count();
        let kept_inside = added.indices.iter().filter(|i| *i % 640 < 320).count();
        assert_eq!(kept_inside, inside);
        let is_read = |i: &u32| is_finite(&cloud.points[*i as usize]);
        assert!(added.indices.iter().all(is_read));
    }

    #[test]
    fn a_dropped_segment_comes_back_whole_and_the_last_word_counts() {
        let subject = captured();
        let untouched = with(&subject, &[]);
        let dropped = with(&subject, &[Edit::Segment(0, PointAction::Dropped)]);
        assert_eq!((dropped.indices.len(), dropped.kept_of[0]), (0, 0));
        let edits = [
            left(OutlineMode::Drop),
            Edit::Segment(0, PointAction::Dropped),
            Edit::Segment(0, PointAction::Kept),
        ];
        assert_eq!(with(&subject, &edits).indices, untouched.indices);
    }

    #[test]
    fn kept_pixels_are_brighter_than_dropped_ones_and_know_their_segment() {
        let subject = captured();
        let selection = with(&subject, &[]);
        let brightness = |index: u32| {
            let pixel = selection.picture.get_pixel(index % 640, index / 640);
            pixel.0.iter().map(|c| u32::from(*c)).sum::<u32>()
        };
        let is_kept = |i: &u32| selection.indices.binary_search(i).is_ok();
        let read = subject.cloud().finite().map(|(i, _)| i as u32);
        let (kept, dropped): (Vec<u32>, Vec<u32>) = read.partition(is_kept);
        let mean = |all: &[u32]| {
            let sum: u32 = all.iter().step_by(50).map(|i| brightness(*i)).sum();
            sum / all.len().div_ceil(50) as u32
        };
        assert!(mean(&kept) > 2 * mean(&dropped));
        assert!(kept.iter().all(|i| selection.segment_at[*i as usize] == 0));
    }
}
