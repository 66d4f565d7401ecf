//! Selection of the part's points: the shots vote on each point, then the connected piece with the most votes is kept. A
//! piece that few shots take for the part, however large, is something else.
//!
//! Where the surface that a shot takes for the part looks like background, the shot votes only if others take that surface
//! for the part, too: shots that do not see a wall or a pillar cannot outvote one that takes it for the part.

use std::collections::BTreeMap;

use super::{
    FusedCloud, Scan, ScanError, ScannedShot,
    unseen::unseen_share,
    visibility::{Visibility, visibility_at},
};
use crate::segment::{BackgroundSign, PointLabel};
use geometry::{units::Metres, voxel::connected_pieces};

impl ScannedShot {
    /// Returns the reason why what it takes for the part looks like background, if there is one.
    fn background_sign(&self) -> Option<BackgroundSign> {
        self.segmentation.part.as_ref()?.background_sign
    }
}

/// Returns the indices of the used shots that vote. Those whose part looks like background do if it does in all shots.
pub(super) fn voters(shots: &[ScannedShot]) -> Vec<usize> {
    let finds_part = |i: &usize| {
        let shot = &shots[*i];
        shot.excluded.is_none() && shot.segmentation.part.is_some()
    };
    let (mut voters, mut others): (Vec<usize>, Vec<usize>) = (0..shots.len())
        .filter(finds_part)
        .partition(|&i| shots[i].background_sign().is_none());
    if voters.is_empty() {
        return others;
    }
    // A shot that is confirmed may confirm another.
    while let Some(index) = (others.iter()).position(|&i| is_confirmed(i, &voters, shots)) {
        voters.push(others.remove(index));
    }
    voters
}

/// Readings of a shot's part that are looked up in other shots, approximately.
const NUM_LOOKED_UP: usize = 2000;
/// Largest distance of the same surface in two shots, metres, beyond three standard deviations of the noise.
const TOLERANCE_M: f64 = 0.006;

/// Returns whether the voters take most of what they see of a shot's part for the part.
fn is_confirmed(which: usize, voters: &[usize], shots: &[ScannedShot]) -> bool {
    let shot = &shots[which];
    let Some(part) = &shot.segmentation.part else {
        return false;
    };
    let step = (part.indices.len() / NUM_LOOKED_UP).max(1);
    let (mut num_part, mut num_other) = (0, 0);
    for voter in voters.iter().map(|&i| &shots[i]) {
        let to_voter = voter.base_from_camera.inverse() * shot.base_from_camera;
        for &i in part.indices.iter().step_by(step) {
            let at = to_voter * shot.surface.points()[i as usize].cast::<f64>();
            let normal = to_voter.rotation * shot.surface.normal(i as usize).cast::<f64>();
            let tolerance = TOLERANCE_M + 3.0 * voter.surface.noise_at_1m.0 * at.z * at.z;
            let seen = visibility_at(&voter.surface, &at, &normal, tolerance);
            let Visibility::Here(seen) = seen else {
                continue;
            };
            match voter.segmentation.labels.get(seen) {
                Some(PointLabel::Part) => num_part += 1,
                _ => num_other += 1,
            }
        }
    }
    num_part > num_other
}

/// Points of the part that a frame must see to show it.
const LEAST_POINTS: usize = 50;

/// Refuses a scan of which only one frame shows the part: it says no more about the part than that frame, and the pose of the
/// other is checked against the cell alone.
pub fn require_two_to_show_part(scan: &Scan) -> Result<(), ScanError> {
    let part = scan.cloud.part();
    let shows_part = |(number, _): &(usize, &ScannedShot)| {
        let seen = part
            .seen_by
            .iter()
            .filter(|mask| (*mask >> number) & 1 == 1);
        seen.count() >= LEAST_POINTS
    };
    let mut showing = scan.used().filter(shows_part);
    match (showing.next(), showing.next()) {
        (Some((_, only)), None) => Err(ScanError::PartInOneFrame {
            found: scan.used().count(),
            name: only.name.clone(),
        }),
        _ => Ok(()),
    }
}

/// A part cut off by the view of each frame is whole if no more of its outline than this is outside all views.
const MOST_OPEN: f64 = 0.1;

/// Returns the reason why the part of a scan looks like background, if it does in every frame that shows it.
pub fn background_sign(scan: &Scan) -> Option<BackgroundSign> {
    let voters = scan.used().filter(|(_, shot)| shot.finds_part);
    let signs: Option<Vec<BackgroundSign>> =
        voters.map(|(_, shot)| shot.background_sign()).collect();
    let sign = *signs?.first()?;
    let is_whole = || unseen_share(scan) <= MOST_OPEN;
    let is_cut = matches!(sign, BackgroundSign::Cut { .. });
    (!is_cut || !is_whole()).then_some(sign)
}

/// Points of the part further apart than this belong to different pieces. Segmentation links at the same distance.
const LINK: Metres = Metres(0.02);

/// Keeps of the points voted to be the part only the connected piece with the most votes.
pub(super) fn keep_best_piece(cloud: &mut FusedCloud) {
    let cell = |i: usize| -> [i32; 3] {
        let p = &cloud.cloud.points[i];
        [p.x, p.y, p.z].map(|x| (x / LINK.0 as f32).floor() as i32)
    };
    let mut cells: BTreeMap<[i32; 3], Vec<u32>> = BTreeMap::new();
    for (i, _) in cloud.is_part.iter().enumerate().filter(|(_, is)| **is) {
        cells.entry(cell(i)).or_default().push(i as u32);
    }
    let (mut best, mut most) = (Vec::new(), 0);
    for piece in connected_pieces(cells) {
        let piece: Vec<u32> = piece.concat();
        let votes = piece
            .iter()
            .map(|&i| u64::from(cloud.part_votes[i as usize]));
        let votes = votes.sum();
        if votes > most {
            (best, most) = (piece, votes);
        }
    }
    cloud.is_part.fill(false);
    for i in best {
        cloud.is_part[i as usize] = true;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use geometry::cloud::PointCloud;

    #[test]
    fn the_piece_that_most_votes_are_for_stays() {
        let row = |at: f32, n: usize| (0..n).map(move |i| Point3::new(i as f32 * 0.01, at, 0.0));
        let points: Vec<_> = row(0.0, 60)
            .chain(row(0.1, 50))
            .chain(row(0.2, 90))
            .collect();
        let of_row = |i: usize| {
            [(0..60), (60..110), (110..200)]
                .iter()
                .position(|r| r.contains(&i))
        };
        let votes = |i: usize| [1, 3, 9][of_row(i).expect("a row")];
        let mut cloud = FusedCloud {
            seen_by: vec![1; points.len()],
            // The last row is the longest, and not the part.
            is_part: (0..points.len()).map(|i| i < 110).collect(),
            part_votes: (0..points.len()).map(votes).collect(),
            cloud: PointCloud::from_points(points),
        };
        keep_best_piece(&mut cloud);
        let kept = cloud.is_part.iter().enumerate();
        assert!(
            kept.into_iter()
                .all(|(i, is)| *is == (60..110).contains(&i))
        );
        assert_eq!(cloud.part().cloud.points.len(), 50);
    }
}
