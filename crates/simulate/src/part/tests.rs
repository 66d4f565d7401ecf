use std::sync::OnceLock;

use nalgebra::Point3;

use super::*;
use crate::FIRST_OTHER_MAKE;

/// Number of models of every part that several tests look at.
const NUM_MODELS: usize = 24;

/// The left part of one of the first models.
fn model(kind: PartKind, model_seed: usize) -> &'static PartModel {
    static MADE: [[OnceLock<PartModel>; NUM_MODELS]; PartKind::ALL.len()] =
        [const { [const { OnceLock::new() }; NUM_MODELS] }; PartKind::ALL.len()];
    let made = || PartModel::new(kind, Side::Left, model_seed as u64);
    MADE[kind as usize][model_seed].get_or_init(made)
}

fn extents(mesh: &TriangleMesh) -> [f32; 3] {
    let first = mesh.vertices[0];
    let (low, high) = mesh
        .vertices
        .iter()
        .fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    (high - low).into()
}

fn num_vertices_apart(a: &TriangleMesh, b: &TriangleMesh, apart: f32) -> usize {
    let far = |p: &&Point3<f32>| b.vertices.iter().all(|q| (*p - q).norm() > apart);
    a.vertices.iter().step_by(97).filter(far).count()
}

#[test]
fn every_model_of_every_part_is_a_sound_mesh() {
    for kind in PartKind::ALL {
        for model_seed in [0, 1, 2, 77, FIRST_OTHER_MAKE, u64::MAX] {
            let mesh = PartModel::new(kind, Side::Left, model_seed).into_mesh();
            assert!(mesh.triangles.len() < 40_000, "{kind}");
            assert!(
                mesh.vertices
                    .iter()
                    .all(|p| p.coords.iter().all(|c| c.is_finite()))
            );
            let mut is_used = vec![false; mesh.vertices.len()];
            for corners in &mesh.triangles {
                let [a, b, c] = corners.map(|i| mesh.vertices[i as usize].cast::<f64>());
                let double_area = (b - a).cross(&(c - a)).norm();
                assert!(
                    double_area > 0.0 && double_area < 0.01,
                    "{kind}: {double_area}"
                );
                for &i in corners {
                    is_used[i as usize] = true;
                }
            }
            assert!(
                is_used.iter().all(|&used| used),
                "{kind} has loose vertices"
            );
        }
    }
}

#[test]
fn no_model_loses_a_web_or_closes_an_opening() {
    // Vertices - edges + triangles is the number of pieces minus that of openings.
    let euler = |mesh: &TriangleMesh| {
        let mut edges: Vec<(u32, u32)> = mesh
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        (mesh.vertices.len() + mesh.triangles.len()) as i64 - edges.len() as i64
    };
    for kind in PartKind::ALL {
        let standard = euler(model(kind, 0).mesh());
        for model_seed in 1..NUM_MODELS {
            let other = euler(model(kind, model_seed).mesh());
            assert_eq!(other, standard, "{kind} model {model_seed}");
        }
    }
}

#[test]
fn parts_have_the_size_of_a_small_cars() {
    let ranges = [
        (PartKind::FrontBumper, (1.40, 1.50), (0.42, 0.52)),
        (PartKind::TrunkLid, (1.02, 1.09), (0.49, 0.58)),
        (PartKind::BackBumper, (1.40, 1.50), (0.42, 0.52)),
        (PartKind::BackDoor, (0.97, 1.05), (1.00, 1.08)),
        (PartKind::FrontDoor, (1.02, 1.10), (1.01, 1.10)),
        (PartKind::RadiatorSupport, (1.11, 1.19), (0.48, 0.54)),
        (PartKind::Grille, (0.84, 0.93), (0.26, 0.31)),
        (PartKind::Fender, (0.86, 0.95), (0.59, 0.67)),
    ];
    for (kind, width, height) in ranges {
        for model_seed in 0..12 {
            let [x, y, _] = extents(model(kind, model_seed).mesh());
            assert!(
                (width.0..width.1).contains(&x),
                "{kind} {model_seed} is {x} wide"
            );
            assert!(
                (height.0..height.1).contains(&y),
                "{kind} {model_seed} is {y} high"
            );
        }
    }
}

#[test]
fn the_paint_side_faces_the_viewer() {
    for kind in PartKind::ALL {
        let mesh = PartModel::new(kind, Side::Right, 3).into_mesh();
        let towards_viewer: f64 = mesh
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|i| mesh.vertices[i as usize].cast::<f64>());
                -(b - a).cross(&(c - a)).z / 2.0
            })
            .sum();
        // The slats of the grille are closed bars, which contribute nothing.
        assert!(towards_viewer > 0.03, "{kind}: {towards_viewer} m²");
    }
}

#[test]
fn right_is_the_mirror_image_of_left_for_sided_parts_and_the_same_for_others() {
    for kind in PartKind::ALL {
        let left = PartModel::new(kind, Side::Left, 5);
        let right = PartModel::new(kind, Side::Right, 5);
        if kind.is_sided() {
            assert_eq!(
                (left.side(), right.side()),
                (Some(Side::Left), Some(Side::Right))
            );
            for (l, r) in left.mesh().vertices.iter().zip(&right.mesh().vertices) {
                assert_eq!(Point3::new(-l.x, l.y, l.z), *r);
            }
            // A part that equals its mirror image would not need sides.
            assert!(
                num_vertices_apart(left.mesh(), right.mesh(), 0.02) > 5,
                "{kind}"
            );
        } else {
            assert_eq!(left.side(), None);
            assert_eq!(left.mesh(), right.mesh());
        }
    }
}

#[test]
fn another_model_seed_is_another_car_of_the_same_class() {
    for kind in PartKind::ALL {
        let standard = model(kind, 0);
        assert_eq!(standard.mesh(), PartModel::new(kind, Side::Left, 0).mesh());
        for model_seed in 1..5 {
            let other = model(kind, model_seed);
            assert!(
                num_vertices_apart(standard.mesh(), other.mesh(), 0.004) > 3,
                "{kind}"
            );
            assert_eq!(
                num_vertices_apart(standard.mesh(), other.mesh(), 0.12),
                0,
                "{kind}"
            );
        }
    }
}

#[test]
fn another_make_differs_more_than_another_model() {
    for kind in PartKind::ALL {
        let num_apart =
            |other: &PartModel| num_vertices_apart(model(kind, 0).mesh(), other.mesh(), 0.012);
        let makes = FIRST_OTHER_MAKE..FIRST_OTHER_MAKE + 6;
        let makes = makes.map(|make| PartModel::new(kind, Side::Left, make));
        let of_makes: usize = makes.map(|make| num_apart(&make)).sum();
        let of_models: usize = (1..7).map(|seed| num_apart(model(kind, seed))).sum();
        assert!(of_makes > 2 * of_models, "{kind}: {of_makes}, {of_models}");
    }
}

#[test]
fn a_name_leads_back_to_its_kind() {
    for kind in PartKind::ALL {
        assert_eq!(PartKind::from_name(kind.name()), Some(kind));
    }
    assert_eq!(PartKind::from_name("roof"), None);
    assert_eq!(Side::from_name("right"), Some(Side::Right));
}
