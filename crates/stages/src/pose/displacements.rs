//! The displacements that the paper tries its pose estimation on (eq. 15).

use std::f64::consts::PI;

use geometry::rigid::{RigidTransform, from_euler_zyx};

/// T1..T5 of eq. 15 as `[θx θy θz x y z]`, radians and metres; the angles are read as R = Rz·Ry·Rx.
pub const DISPLACEMENTS: [[f64; 6]; 5] = [
    [0.5 * PI, 0.0, 0.0, 0.8, 0.0, 0.5],
    [0.5 * PI, 0.0, 0.1 * PI, 0.8, 0.1, 0.5],
    [0.5 * PI, 0.2 * PI, 0.3 * PI, 0.1, 0.3, 0.1],
    [0.6 * PI, 0.3 * PI, 0.4 * PI, 0.3, 0.2, 0.4],
    [0.3 * PI, 0.1 * PI, 0.6 * PI, 0.4, 0.6, 0.3],
];

/// T1..T5 of eq. 15 as transforms.
pub fn displacements() -> [RigidTransform; 5] {
    DISPLACEMENTS.map(from_euler_zyx)
}
