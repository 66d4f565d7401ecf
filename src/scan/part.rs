//! Selection of the part's points: the shots vote on each point, then the connected piece with the most votes is kept. A
//! piece that few shots take for the part, however large, is something else.

use std::collections::BTreeMap;

use super::FusedCloud;
use crate::{geometry::voxel::connected_pieces, units::Metres};

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
    use crate::geometry::cloud::PointCloud;

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
