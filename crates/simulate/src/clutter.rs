//! Clutter in the plain cell.

use nalgebra::{Point3, Rotation3, Vector3};
use rand::RngExt as _;
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use super::assembly::Assembly;
use super::beam::block;
use super::object::ObjectKind;
use super::rasteriser::{Plane, Rendering, SurfaceLabel};
use geometry::depth_frame::Intrinsics;

/// Things in the cell besides the part and its stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Clutter {
    /// Nothing.
    #[default]
    None,
    /// Two or three things on the floor, beside and behind the part.
    OnFloor,
    /// Like `OnFloor`, plus a plank between camera and part that hides 10 to 25 % of it.
    InFront,
}

/// Places two or three things on the floor that do not touch the part.
pub(super) fn on_floor(
    hung: &[Point3<f64>],
    floor: &Plane,
    wall: &Plane,
    random: &mut Pcg64,
) -> Assembly {
    const KINDS: [ObjectKind; 4] = [
        ObjectKind::Box,
        ObjectKind::Stool,
        ObjectKind::Chair,
        ObjectKind::Bucket,
    ];
    let mut clutter = Assembly::default();
    let num_things = random.random_range(2..=3);
    let mut num_placed = 0;
    for _ in 0..20 {
        let mesh = KINDS[random.random_range(0..KINDS.len())].mesh();
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), random.random_range(-1.5..1.5));
        let (x, z) = (
            random.random_range(-1.1..1.1),
            random.random_range(1.5..2.2),
        );
        let turned = mesh.placed_vertices(|p| turn * p);
        let foot = turned.iter().map(|p| p.y).fold(0.0, f64::max);
        let shift = Vector3::new(x, floor.height_at(x, z) - foot, z);
        let is_before_wall = turned
            .iter()
            .all(|p| wall.normal.dot(&(p + shift).coords) < wall.offset);
        let radius = turned.iter().map(|p| p.coords.norm()).fold(0.0, f64::max);
        let is_clear = hung
            .iter()
            .all(|p| (p.coords - shift).norm() > radius + 0.08);
        if is_before_wall && is_clear {
            clutter.add(&mesh, |p| turn * p + shift);
            num_placed += 1;
        }
        if num_placed == num_things {
            break;
        }
    }
    clutter
}

/// Adds an upright or horizontal plank in front of the part that hides 12 to 22 % of its visible surface.
///
/// `draw_part` draws the part into a small picture, whose pixels are counted line by line to find out how far the plank
/// has to reach.
pub(super) fn plank(
    clutter: &mut Assembly,
    hung: &[Point3<f64>],
    camera: &Intrinsics,
    draw_part: impl FnOnce(&mut Rendering),
    random: &mut Pcg64,
) {
    let axis = random.random_range(0..2_usize);
    let from_low_side = random.random_range(0..2) == 0;
    let hidden_share = random.random_range(0.12..0.22);
    let overhang = random.random_range(0.02..0.10);

    let mut rendering = Rendering::new(quartered(camera));
    draw_part(&mut rendering);
    let small = rendering.intrinsics;
    let (num_lines, principal, focal) = match axis {
        0 => (small.width, small.cx, small.fx),
        _ => (small.height, small.cy, small.fy),
    };
    let mut part_pixels = vec![0; num_lines];
    for (pixel, _) in
        (rendering.labels.iter().enumerate()).filter(|(_, l)| **l == SurfaceLabel::Part)
    {
        let pixel = [pixel % small.width, pixel / small.width];
        part_pixels[pixel[axis]] += 1;
    }
    let lines: Vec<usize> = if from_low_side {
        (0..num_lines).collect()
    } else {
        (0..num_lines).rev().collect()
    };
    let num_to_hide = hidden_share * part_pixels.iter().sum::<usize>() as f64;
    let Some(&outer) = lines.iter().find(|&&line| part_pixels[line] > 0) else {
        return;
    };
    let mut num_hidden = 0;
    let inner = lines.iter().copied().find(|&line| {
        num_hidden += part_pixels[line];
        num_hidden as f64 >= num_to_hide
    });
    // The plank's near face, 15 cm in front of the part where the camera leaves room.
    let nearest = hung.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let z = (nearest - 0.15).max(0.55);
    let outwards = if from_low_side { -1.0 } else { 1.0 };
    let at = |line: usize| (line as f64 - principal) / focal * z;
    let inner = at(inner.unwrap_or(outer));
    let outer = at(outer) + outwards * overhang;
    let (middle, width) = (0.5 * (inner + outer), (inner - outer).abs());
    let thickness = 0.018;
    let length = 1.4;
    let centre_z = z + 0.5 * thickness;
    if axis == 0 {
        block(
            clutter,
            Point3::new(middle, 0.0, centre_z),
            Vector3::new(width, length, thickness),
        );
    } else {
        block(
            clutter,
            Point3::new(0.0, middle, centre_z),
            Vector3::new(length, width, thickness),
        );
    }
}

/// Returns the same view with a quarter of the pixels in each direction.
pub(super) fn quartered(camera: &Intrinsics) -> Intrinsics {
    // Pixel centres are at whole numbers, so the corner of the picture is at -½.
    let shrink = |c: f64| (c + 0.5) / 4.0 - 0.5;
    Intrinsics {
        width: camera.width.div_ceil(4),
        height: camera.height.div_ceil(4),
        fx: camera.fx / 4.0,
        fy: camera.fy / 4.0,
        cx: shrink(camera.cx),
        cy: shrink(camera.cy),
        distortion: camera.distortion,
    }
}
