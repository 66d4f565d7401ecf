//! Ranking of real silhouettes: the first shape of each MPEG-7 class is enrolled, and queried again rotated, with
//! both principal axes flipped, or drawn at another resolution; and hundreds of them are.

use std::{path::Path, sync::OnceLock};

use nalgebra::Point2;
use partsight::{
    geometry::raster::BinaryImage,
    stages::{
        contour::{Contour, ContourParams, find_contour},
        project::PlaneImage,
        rank::{EXHAUSTIVE_UP_TO, Query, RankParams, rank, rank_by},
        reference::Reference,
        signature::{FanSignature, SignatureParams, describe},
    },
    units::Metres,
};

use crate::data_folder;

/// A white shape on black, as a binary image.
struct Silhouette {
    class: String,
    image: BinaryImage,
    /// Number of set pixels above each row and left of each column.
    sums: Vec<u32>,
    centre: Point2<f64>,
    longest_side: f64,
}

impl Silhouette {
    /// Number of set pixels in these columns and rows, each from the first to the last, and of all of them.
    fn num_set(&self, columns: [i64; 2], rows: [i64; 2]) -> [u32; 2] {
        let clip = |[first, last]: [i64; 2], size: usize| {
            [first, last + 1].map(|end| end.clamp(0, size as i64) as usize)
        };
        let [left, right] = clip(columns, self.image.width);
        let [top, bottom] = clip(rows, self.image.height);
        let sum = |row: usize, column: usize| self.sums[row * (self.image.width + 1) + column];
        let set = sum(bottom, right) + sum(top, left) - (sum(top, right) + sum(bottom, left));
        let all = [columns, rows].map(|[first, last]| (last + 1 - first) as u32);
        [set, all[0] * all[1]]
    }
}

/// A shape as it is enrolled: upright, 200 pixels long.
struct Upright {
    shape: Silhouette,
    plane: PlaneImage,
    contour: Contour,
    signature: FanSignature,
}

impl Upright {
    fn reference(&self) -> Reference {
        let Self {
            shape,
            plane,
            contour,
            signature,
        } = self;
        Reference::from_plane(&shape.class, plane, contour, signature.clone())
    }
}

/// All shapes by class and number, drawn once: that takes longer than what the tests do with them.
fn all_shapes(data: &Path) -> &'static [Upright] {
    static ALL: OnceLock<Vec<Upright>> = OnceLock::new();
    ALL.get_or_init(|| {
        let folder = data.join("silhouettes");
        let upright = |name: &String| {
            let shape = silhouette(&folder, name);
            let plane = drawn(&shape, 0.0, 200);
            let (contour, signature) = described(&plane);
            Upright {
                shape,
                plane,
                contour,
                signature,
            }
        };
        shape_names(&folder).iter().map(upright).collect()
    })
}

/// The first shape of each class.
fn first_of_each_class(data: &Path) -> Vec<&'static Upright> {
    let mut shapes: Vec<&Upright> = all_shapes(data).iter().collect();
    shapes.dedup_by(|a, b| a.shape.class == b.shape.class);
    shapes
}

fn class_of(name: &str) -> &str {
    &name[..name.rfind('-').expect("CLASS-N.png")]
}

/// Names of the files by class and number.
fn shape_names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .expect("a folder of silhouettes")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    let number = |name: &str| -> u32 {
        let digits = name[class_of(name).len() + 1..].trim_end_matches(".png");
        digits.parse().expect("a number")
    };
    names.sort_by_key(|name| (class_of(name).to_owned(), number(name)));
    names
}

fn silhouette(folder: &Path, name: &str) -> Silhouette {
    let grey = image::open(folder.join(name)).expect("a PNG").to_luma8();
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    let image = BinaryImage {
        width,
        height,
        pixels: grey.pixels().map(|p| u8::from(p.0[0] > 127)).collect(),
    };
    let set = |i: &usize| image.pixels[*i] == 1;
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    for i in (0..width * height).filter(set) {
        for (axis, x) in [i % width, i / width].into_iter().enumerate() {
            low[axis] = low[axis].min(x);
            high[axis] = high[axis].max(x);
        }
    }
    let mut sums = vec![0; (width + 1) * (height + 1)];
    for row in 0..height {
        let mut along = 0;
        for column in 0..width {
            along += u32::from(image.pixels[row * width + column]);
            let above = sums[row * (width + 1) + column + 1];
            sums[(row + 1) * (width + 1) + column + 1] = above + along;
        }
    }
    Silhouette {
        class: class_of(name).to_owned(),
        sums,
        centre: Point2::new(
            (low[0] + high[0]) as f64 / 2.0,
            (low[1] + high[1]) as f64 / 2.0,
        ),
        longest_side: (high[0] - low[0]).max(high[1] - low[1]) as f64 + 1.0,
        image,
    }
}

/// Draws a shape a metre long, rotated counter-clockwise about its centre, with `raster` pixels per metre.
fn drawn(shape: &Silhouette, turn_degrees: f64, raster: usize) -> PlaneImage {
    // Room for the diagonal at any rotation, and an empty margin.
    let side = raster * 3 / 2 + 8;
    let (sin, cos) = turn_degrees.to_radians().sin_cos();
    let per_pixel = shape.longest_side / raster as f64;
    let mut image = BinaryImage::new(side, side);
    let at = |column: f64, row: f64| {
        let [x, y] = [column, row].map(|n| (n - side as f64 / 2.0) * per_pixel);
        let u = shape.centre.x + cos * x - sin * y;
        [u, shape.centre.y + sin * x + cos * y]
    };
    // So far from the middle of a pixel are its samples at most, and the pixels that they fall into.
    let reach = 0.5 * per_pixel + 1.0;
    for row in 0..side {
        for column in 0..side {
            let [u, v] = at(column as f64, row as f64);
            let around = |x: f64| [(x - reach).floor() as i64, (x + reach).ceil() as i64];
            let [num_set, num] = shape.num_set(around(u), around(v));
            if num_set == 0 || num_set == num {
                image.pixels[row * side + column] = u8::from(num_set > 0);
                continue;
            }
            // The majority of nine samples per pixel.
            let set = (0..9).filter(|k| {
                let [across, down] = [k % 3 - 1, k / 3 - 1].map(|n| f64::from(n) / 3.0);
                let [u, v] = at(column as f64 + across, row as f64 + down);
                shape.image.is_set(u.round() as i64, v.round() as i64)
            });
            image.pixels[row * side + column] = u8::from(set.count() >= 5);
        }
    }
    PlaneImage::from_image(image, Metres(1.0 / raster as f64))
}

fn described(plane: &PlaneImage) -> (Contour, FanSignature) {
    let contour = find_contour(plane, &ContourParams::default()).expect("a shape");
    let signature = describe(&contour, &SignatureParams::default()).expect("an outline");
    (contour, signature)
}

fn num_right(shapes: &[&Upright], references: &[Reference], turn: f64, raster: usize) -> usize {
    let is_right = |Upright { shape, .. }: &&&Upright| {
        let plane = drawn(shape, turn, raster);
        let (contour, signature) = described(&plane);
        let query = Query {
            plane: &plane,
            contour: &contour,
            signature: &signature,
        };
        let ranking = rank(&query, references, &RankParams::default());
        ranking.entries[0].part == shape.class
    };
    shapes.iter().filter(is_right).count()
}

#[test]
fn a_shape_is_found_again_turned_flipped_and_at_another_resolution() {
    let Some(data) = data_folder() else { return };
    let shapes = first_of_each_class(&data);
    assert_eq!(shapes.len(), 35, "one shape of each class");
    let references: Vec<Reference> = shapes.iter().map(|one| one.reference()).collect();
    for (what, turn, raster) in [
        ("as enrolled", 0.0, 200),
        ("turned by 37°", 37.0, 200),
        ("both axes flipped", 180.0, 200),
        ("160 pixels instead of 200", 0.0, 160),
    ] {
        let num_right = num_right(&shapes, &references, turn, raster);
        assert!(num_right >= 34, "{what}: only {num_right} of 35");
    }
}

/// Number of shapes that are also ranked by three workers.
const NUM_BY_THREE: usize = 20;

/// All shapes are enrolled: too many to compare each in full.
#[test]
fn a_library_of_hundreds_ranks_the_same_sixteen_first_as_all_compared_in_full() {
    let Some(data) = data_folder() else { return };
    let shapes = all_shapes(&data);
    let references: Vec<Reference> = shapes.iter().map(Upright::reference).collect();
    assert!(references.len() > EXHAUSTIVE_UP_TO, "{}", references.len());
    let params = RankParams::default();
    let (mut num, mut num_first, mut num_16, mut num_compared) = (0, 0, 0, 0);
    for Upright { shape, .. } in shapes.iter().step_by(5) {
        let plane = drawn(shape, 37.0, 160);
        let (contour, signature) = described(&plane);
        let query = Query {
            plane: &plane,
            contour: &contour,
            signature: &signature,
        };
        let ranking = rank_by(1, &query, &references, &params);
        if num < NUM_BY_THREE {
            assert_eq!(ranking, rank_by(3, &query, &references, &params));
        }
        let some = references.chunks(EXHAUSTIVE_UP_TO);
        let parts = some.flat_map(|some| rank(&query, some, &params).entries);
        let mut scores: Vec<f64> = parts.map(|entry| entry.score).collect();
        scores.sort_by(|a, b| b.total_cmp(a));
        let found = ranking.entries.iter().map(|entry| entry.score);
        let num_same = found.zip(&scores).take_while(|(a, b)| a >= *b).count();
        num += 1;
        num_first += usize::from(num_same > 0);
        num_16 += usize::from(num_same >= 16);
        num_compared += ranking.entries.len();
    }
    eprintln!(
        "{num} shapes: the same first {num_first}, the same 16 {num_16}, compared on average {} of {}",
        num_compared / num,
        references.len()
    );
    assert_eq!([num_first, num_16], [num; 2]);
}

/// The other shapes of a class are other objects of its kind: another bat, another camel. One of each class is
/// enrolled.
#[test]
fn other_shapes_of_a_class_rank_their_class_among_the_first() {
    let Some(data) = data_folder() else { return };
    let exemplars = first_of_each_class(&data);
    let references: Vec<Reference> = exemplars.iter().map(|one| one.reference()).collect();
    let params = RankParams::default();
    let (mut num, mut first, mut among_five) = (0, 0, 0);
    for Upright {
        shape,
        plane,
        contour,
        signature,
    } in all_shapes(&data)
    {
        let query = Query {
            plane,
            contour,
            signature,
        };
        let ranking = rank(&query, &references, &params);
        let index = ranking.entries.iter().position(|e| e.part == shape.class);
        num += 1;
        first += usize::from(index == Some(0));
        among_five += usize::from(index.is_some_and(|index| index < 5));
    }
    // The enrolled shapes themselves rank first and are not counted.
    let own = references.len();
    (num, first, among_five) = (num - own, first - own, among_five - own);
    let share = |n: usize| 100.0 * n as f64 / num as f64;
    eprintln!(
        "{num} other shapes: first {first} ({:.1} %), among five {among_five} ({:.1} %)",
        share(first),
        share(among_five)
    );
    assert!(share(first) > 60.0 && share(among_five) > 75.0);
}
