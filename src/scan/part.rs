//! Which fused points are the part: the shots' vote, then the largest connected piece.

use std::collections::BTreeMap;

use super::FusedCloud;
use crate::units::Metres;

/// Points of the part further apart than this are of two pieces. Segmentation links at the same distance.
const LINK: Metres = Metres(0.02);

/// Leaves only the largest connected piece of what the shots voted to be the part.
pub(super) fn keep_largest_piece(cloud: &mut FusedCloud) {
    let cell = |i: usize| -> [i32; 3] {
        let p = &cloud.cloud.points[i];
        [p.x, p.y, p.z].map(|x| (x / LINK.0 as f32).floor() as i32)
    };
    let mut cells: BTreeMap<[i32; 3], Vec<u32>> = BTreeMap::new();
    for (i, _) in cloud.is_part.iter().enumerate().filter(|(_, is)| **is) {
        cells.entry(cell(i)).or_default().push(i as u32);
    }
    let mut largest: Vec<u32> = Vec::new();
    while let Some((start, members)) = cells.pop_first() {
        let mut piece = members;
        let mut open = vec![start];
        while let Some([x, y, z]) = open.pop() {
            for dz in -1..=1 {
                for dy in -1..=1 {
                    for dx in -1..=1 {
                        let next = [x + dx, y + dy, z + dz];
                        if let Some(members) = cells.remove(&next) {
                            piece.extend(members);
                            open.push(next);
                        }
                    }
                }
            }
        }
        if piece.len() > largest.len() {
            largest = piece;
        }
    }
    cloud.is_part.fill(false);
    for i in largest {
        cloud.is_part[i as usize] = true;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::geometry::cloud::PointCloud;

    #[test]
    fn the_largest_of_two_pieces_stays() {
        let row = |at: f32, n: usize| (0..n).map(move |i| Point3::new(i as f32 * 0.01, at, 0.0));
        let points: Vec<_> = row(0.0, 30)
            .chain(row(0.1, 50))
            .chain(row(0.2, 90))
            .collect();
        let mut cloud = FusedCloud {
            seen_by: vec![1; points.len()],
            // The last row is the longest, and no part.
            is_part: (0..points.len()).map(|i| i < 80).collect(),
            cloud: PointCloud::from_points(points),
        };
        keep_largest_piece(&mut cloud);
        assert!(
            cloud
                .is_part
                .iter()
                .enumerate()
                .all(|(i, is)| *is == (30..80).contains(&i))
        );
        assert_eq!(cloud.part().cloud.points.len(), 50);
    }
}
