//! Fusion of the readings of all shots into one cloud.
//!
//! Readings are averaged per voxel, weighted by their inverse variance. Each mean is then looked up in every shot: the shots
//! that see the surface there pull it along its normal, so that shots that disagree by millimetres leave one layer and not
//! two. A mean is dropped, as a flying pixel or something that moved, if the shots that look through it number more than half
//! of those that see it.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};

use super::{
    ScannedShot,
    surface::Use,
    visibility::{Visibility, visibility_at},
};
use crate::segment::PointLabel;
use geometry::{cloud::PointCloud, parallel::map_each, rigid::RigidTransform, units::Metres};

/// The points of a scan, in the robot's base frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FusedCloud {
    /// Unorganised points with unit normals towards the cameras that saw them.
    pub cloud: PointCloud,
    /// The shots that saw each point: bit k stands for the k-th of all shots of the scan.
    pub seen_by: Vec<u64>,
    /// True for the points of the part.
    pub is_part: Vec<bool>,
    /// The number of shots whose segmentation takes each point for the part.
    pub part_votes: Vec<u16>,
}

impl FusedCloud {
    /// Returns the points of the part.
    #[must_use]
    pub fn part(&self) -> Self {
        self.kept(&self.is_part)
    }

    /// Returns the mean of the part's points; `None` if there is no part.
    #[must_use]
    pub fn middle_of_part(&self) -> Option<Point3<f64>> {
        let points = self.cloud.points.iter().zip(&self.is_part);
        let of_part = points.filter(|(_, is)| **is).map(|(p, _)| p.coords.cast());
        let (sum, num) = of_part.fold((Vector3::zeros(), 0_usize), |(sum, num), p| {
            (sum + p, num + 1)
        });
        (num > 0).then(|| Point3::from(sum / num as f64))
    }

    /// Returns the cubes of 1 cm that hold points of the part.
    pub(super) fn part_cells(&self) -> PartCells {
        let points = self.cloud.points.iter().zip(&self.is_part);
        let cells = points
            .filter(|(_, is)| **is)
            .map(|(p, _)| PartCells::cell(&p.cast()));
        let mut cells: Vec<u64> = cells.collect();
        cells.sort_unstable();
        cells.dedup();
        PartCells { cells }
    }

    /// Returns the points whose mark is true.
    #[must_use]
    pub fn kept(&self, marks: &[bool]) -> Self {
        fn pick<T: Copy>(all: &[T], marks: &[bool]) -> Vec<T> {
            let marked = all.iter().zip(marks).filter(|(_, mark)| **mark);
            marked.map(|(one, _)| *one).collect()
        }
        let normals = self.cloud.normals.as_ref();
        Self {
            cloud: PointCloud {
                points: pick(&self.cloud.points, marks),
                normals: normals.map(|all| pick(all, marks)),
                is_simulated: self.cloud.is_simulated,
                ..PointCloud::default()
            },
            seen_by: pick(&self.seen_by, marks),
            is_part: pick(&self.is_part, marks),
            part_votes: pick(&self.part_votes, marks),
        }
    }
}

/// The cubes of space that hold points of the part, 1 cm wide.
pub(super) struct PartCells {
    /// Their indices, ascending.
    cells: Vec<u64>,
}

impl PartCells {
    fn cell(point: &Point3<f64>) -> u64 {
        voxel_of(point, 100.0)
    }

    pub(super) fn holds(&self, point: &Point3<f64>) -> bool {
        self.cells.binary_search(&Self::cell(point)).is_ok()
    }
}

/// A fused point, before and after it is pulled to the surface.
#[derive(Clone, Copy)]
struct Voxel {
    point: Point3<f64>,
    normal: Vector3<f64>,
    weight: f64,
    seen_by: u64,
    /// Sum of the shots' votes; above 0 for the part.
    votes: i32,
    /// The number of shots that take it for the part.
    part_votes: u16,
}

/// Largest distance along the normal between a fused point and its readings, in metres, beyond three standard deviations
/// of the noise; refined poses agree better than that.
const TOLERANCE_M: f64 = 0.006;
/// Votes of a shot on whether a point is the part. A rest label weighs half as much as a background label.
const PART_VOTE: i32 = 2;
const BACKGROUND_VOTE: i32 = -2;
const REST_VOTE: i32 = -1;
/// Voxels per job.
const PIECE: usize = 4096;
/// Readings that are fused at once, approximately; a reading takes up to 200 bytes meanwhile.
const SLAB: usize = 300_000;
/// Layers of voxels by which a point is drawn at most. One that is drawn further leaves a second point in its new voxel.
const MOST_MOVED: u64 = 30;
/// Bits of a voxel's index along each axis.
const BITS: u32 = 21;

/// Fuses the readings of the shots, each with its index among all shots of the scan, and lets the shots vote on which
/// points are the part.
pub(super) fn fuse(
    shots: &[(usize, &ScannedShot)],
    voxel: Metres,
    num_workers: usize,
) -> FusedCloud {
    let per_metre = 1.0 / voxel.0;
    let cameras: Vec<RigidTransform> = shots
        .iter()
        .map(|(_, shot)| shot.base_from_camera.inverse())
        .collect();
    let slabs = slabs_of_readings(shots, per_metre);
    let num_slabs = slabs.len();
    // No more points than readings. Memory is only taken up where points are written; growing or shrinking would copy them.
    let most = slabs.iter().map(|(_, readings)| readings.len()).sum();
    let mut normals = Vec::with_capacity(most);
    let mut fused = FusedCloud {
        cloud: PointCloud {
            points: Vec::with_capacity(most),
            ..PointCloud::default()
        },
        seen_by: Vec::with_capacity(most),
        is_part: Vec::with_capacity(most),
        part_votes: Vec::with_capacity(most),
    };
    let mut waiting: Vec<Vec<Voxel>> = Vec::new();
    for (number, (top, readings)) in slabs.into_iter().enumerate() {
        let readings = by_voxel(shots, &readings, per_metre);
        let starts: Vec<&[(u64, u32)]> = readings.chunk_by(|a, b| a.0 == b.0).collect();
        let pieces: Vec<&[&[(u64, u32)]]> = starts.chunks(PIECE).collect();
        let drawn = map_each(pieces.len(), num_workers, |piece| {
            let means = pieces[piece]
                .iter()
                .map(|readings| mean_of(shots, readings));
            let mut drawn = Vec::with_capacity(pieces[piece].len());
            drawn.extend(means.filter_map(|mean| drawn_to_surface(&mean, shots, &cameras)));
            drawn
        });
        waiting.extend(drawn);
        // Those near the top may be merged with some of the next slab.
        let is_settled = |voxel: u64| number + 1 == num_slabs || layer_of(voxel) + MOST_MOVED < top;
        each_merged(&waiting, per_metre, is_settled, |one| {
            fused.cloud.points.push(one.point.cast());
            normals.push(one.normal.cast());
            fused.seen_by.push(one.seen_by);
            fused.is_part.push(one.votes > 0);
            fused.part_votes.push(one.part_votes);
        });
        for piece in &mut waiting {
            piece.retain(|v| !is_settled(voxel_of(&v.point, per_metre)));
            piece.shrink_to_fit();
        }
        waiting.retain(|piece| !piece.is_empty());
    }
    fused.cloud.normals = Some(normals);
    fused
}

/// Returns the index of the voxel that contains a point.
fn voxel_of(point: &Point3<f64>, per_metre: f64) -> u64 {
    let along = |x: f64| {
        // A robot's cell is metres wide; points kilometres away fall into the outermost voxel.
        let half = f64::from(1_u32 << (BITS - 1));
        ((x * per_metre).floor() + half).clamp(0.0, 2.0 * half - 1.0) as u64
    };
    (along(point.z) << (2 * BITS)) | (along(point.y) << BITS) | along(point.x)
}

/// Bits of a voxel's index within its strip: a quarter of a metre of a layer, since the floor of a cell may lie in one layer.
const STRIP_BITS: u32 = BITS + 6;

/// Returns the strip of a voxel, along y of its layer. Strips are in the order of their voxels.
fn strip_of(voxel: u64) -> u64 {
    voxel >> STRIP_BITS
}

/// Returns the layer of a voxel, along z.
fn layer_of(voxel: u64) -> u64 {
    voxel >> (2 * BITS)
}

/// Bits of a reading's index within its shot; the bits above them number the shot.
const READING_BITS: u32 = 26;

/// Returns the shot and the index of a reading.
fn shot_and_index(reading: u32) -> (usize, usize) {
    let index = reading & ((1 << READING_BITS) - 1);
    ((reading >> READING_BITS) as usize, index as usize)
}

/// Calls `visit` with each reading good enough for fusion, and its voxel.
fn each_reading(shots: &[(usize, &ScannedShot)], per_metre: f64, mut visit: impl FnMut(u32, u64)) {
    for (k, (_, shot)) in shots.iter().enumerate() {
        for (i, used) in shot.surface.uses.iter().enumerate() {
            if *used != Use::None {
                let at = shot.base_from_camera * shot.surface.points()[i].cast::<f64>();
                let reading = ((k as u32) << READING_BITS) | i as u32;
                visit(reading, voxel_of(&at, per_metre));
            }
        }
    }
}

/// Divides the readings into slabs of whole strips of layers from the bottom, so that few are fused at once. Returns each
/// slab's readings with the first layer that is not complete yet.
fn slabs_of_readings(shots: &[(usize, &ScannedShot)], per_metre: f64) -> Vec<(u64, Vec<u32>)> {
    let mut strips: BTreeMap<u64, usize> = BTreeMap::new();
    each_reading(shots, per_metre, |_, voxel| {
        *strips.entry(strip_of(voxel)).or_default() += 1;
    });
    let mut slabs: Vec<(u64, usize)> = Vec::new();
    for (strip, num) in strips {
        match slabs.last_mut() {
            Some((end, sum)) if *sum + num <= SLAB => (*end, *sum) = (strip + 1, *sum + num),
            _ => slabs.push((strip + 1, num)),
        }
    }
    let mut filled: Vec<(u64, Vec<u32>)> = slabs
        .into_iter()
        .map(|(end, num)| (end, Vec::with_capacity(num)))
        .collect();
    each_reading(shots, per_metre, |reading, voxel| {
        let slab = filled.partition_point(|(end, _)| *end <= strip_of(voxel));
        filled[slab].1.push(reading);
    });
    let layers = filled
        .into_iter()
        .map(|(end, readings)| (layer_of(end << STRIP_BITS), readings));
    layers.collect()
}

/// Returns the readings with their voxels, ordered by voxel.
fn by_voxel(shots: &[(usize, &ScannedShot)], readings: &[u32], per_metre: f64) -> Vec<(u64, u32)> {
    let readings = readings.iter().map(|&reading| {
        let (k, i) = shot_and_index(reading);
        let shot = shots[k].1;
        let at = shot.base_from_camera * shot.surface.points()[i].cast::<f64>();
        (voxel_of(&at, per_metre), reading)
    });
    let mut readings: Vec<(u64, u32)> = readings.collect();
    // The readings' numbers make the order unique.
    readings.sort_unstable();
    readings
}

/// Returns the mean of the readings in one voxel.
fn mean_of(shots: &[(usize, &ScannedShot)], readings: &[(u64, u32)]) -> Voxel {
    let (mut point, mut normal, mut weight) = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for &(_, reading) in readings {
        let (k, i) = shot_and_index(reading);
        let shot = shots[k].1;
        let one = 1.0 / shot.surface.sigma(i).powi(2);
        let at = shot.base_from_camera * shot.surface.points()[i].cast::<f64>();
        let facing = shot.base_from_camera.rotation * shot.surface.normal(i).cast::<f64>();
        point += at.coords * one;
        normal += facing * one;
        weight += one;
    }
    Voxel {
        point: Point3::from(point / weight),
        normal: normal.try_normalize(1e-12).unwrap_or(normal),
        weight,
        seen_by: 0,
        votes: 0,
        part_votes: 0,
    }
}

/// Returns the mean moved to the surface that the shots see there; `None` if too many of them look through it.
fn drawn_to_surface(
    mean: &Voxel,
    shots: &[(usize, &ScannedShot)],
    cameras: &[RigidTransform],
) -> Option<Voxel> {
    let (mut num_here, mut num_through) = (0_u32, 0_u32);
    let (mut off_sum, mut weight_sum) = (0.0, 0.0);
    let (mut seen_by, mut votes, mut part_votes) = (0_u64, 0, 0);
    for ((number, shot), camera_from_base) in shots.iter().zip(cameras) {
        let at = camera_from_base * mean.point;
        let normal = camera_from_base.rotation * mean.normal;
        // A sheet seen from behind is another surface.
        if normal.dot(&at.coords) > 0.0 {
            continue;
        }
        let surface = &shot.surface;
        let noise = surface.noise_at_1m.0 * at.z * at.z;
        match visibility_at(surface, &at, &normal, TOLERANCE_M + 3.0 * noise) {
            Visibility::Here(i) => {
                num_here += 1;
                seen_by |= 1 << *number;
                let weight = 1.0 / surface.sigma(i).powi(2);
                off_sum += weight * normal.dot(&(surface.points()[i].cast::<f64>() - at));
                weight_sum += weight;
                let labels = Some(&shot.segmentation.labels).filter(|_| shot.finds_part);
                let label = labels.and_then(|labels| labels.get(i));
                part_votes += u16::from(label == Some(&PointLabel::Part));
                votes += match label {
                    Some(PointLabel::Part) => PART_VOTE,
                    Some(PointLabel::Background(_)) => BACKGROUND_VOTE,
                    Some(PointLabel::Rest) => REST_VOTE,
                    Some(PointLabel::NoReading) | None => 0,
                };
            }
            Visibility::Through => num_through += 1,
            Visibility::Hidden | Visibility::NoReading | Visibility::Outside => {}
        }
    }
    if num_here == 0 || 2 * num_through > num_here {
        return None;
    }
    Some(Voxel {
        point: mean.point + mean.normal * (off_sum / weight_sum),
        weight: weight_sum,
        seen_by,
        votes,
        part_votes,
        ..*mean
    })
}

/// Merges the points that were moved into the same settled voxel, and calls `visit` with each, ordered by voxel. A piece
/// has at most [`PIECE`] points.
fn each_merged(
    pieces: &[Vec<Voxel>],
    per_metre: f64,
    is_settled: impl Fn(u64) -> bool,
    mut visit: impl FnMut(Voxel),
) {
    let mut order: Vec<(u64, u32)> = Vec::new();
    for (number, piece) in pieces.iter().enumerate() {
        let first = number * PIECE;
        let voxels = piece.iter().map(|v| voxel_of(&v.point, per_metre));
        let numbered = voxels.zip(first as u32..);
        order.extend(numbered.filter(|(voxel, _)| is_settled(*voxel)));
    }
    order.sort_unstable();
    let point_of = |i: u32| &pieces[i as usize / PIECE][i as usize % PIECE];
    for members in order.chunk_by(|a, b| a.0 == b.0) {
        let first = point_of(members[0].1);
        let (mut point, mut normal, mut weight) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        let (mut seen_by, mut votes, mut part_votes) = (0, 0, 0);
        for &(_, i) in members {
            let one = point_of(i);
            point += one.point.coords * one.weight;
            normal += one.normal * one.weight;
            weight += one.weight;
            seen_by |= one.seen_by;
            votes += one.votes;
            part_votes = one.part_votes.max(part_votes);
        }
        visit(Voxel {
            point: Point3::from(point / weight),
            normal: normal.try_normalize(1e-12).unwrap_or(first.normal),
            weight,
            seen_by,
            votes,
            part_votes,
        });
    }
}
