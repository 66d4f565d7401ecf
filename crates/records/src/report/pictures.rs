//! Pictures of every stage of an inspection, which show where it went wrong.

use std::{io, path::Path};

use image::{
    ImageFormat, Rgb, RgbImage,
    imageops::{FilterType, replace, resize},
};
use nalgebra::Point2;

use super::canvas::Canvas;
use files::{FileError, write_atomically};
use inspection::pipeline::Inspection;
use stages::{
    contour::Contour,
    project::PlaneImage,
    scene::SceneCloud,
    segment::{PointLabel, Segmentation},
    signature::FanSignature,
};

/// A picture of a stage.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Number of the part in its frame, from 1; `None` for the part that the report is about.
    pub part: Option<usize>,
    /// Name of the stage, usable in file names.
    pub stage: &'static str,
    /// The picture.
    pub image: RgbImage,
}

/// Names of the stages.
pub(super) const STAGES: [&str; 4] = ["segmentation", "binary", "contour", "signature"];

pub(super) const DARK: Rgb<u8> = Rgb([24, 27, 32]);
pub(super) const LIGHT: Rgb<u8> = Rgb([232, 234, 238]);
pub(super) const DIM: Rgb<u8> = Rgb([96, 104, 116]);
pub(super) const FAINT: Rgb<u8> = Rgb([52, 60, 72]);
/// Distinct in brightness as well as in hue, for people with colour vision deficiency.
pub(super) const PART: Rgb<u8> = Rgb([255, 196, 61]);
/// Colours for pictures that are also printed: dark on white.
const PAPER: Rgb<u8> = Rgb([255; 3]);
const INK: Rgb<u8> = Rgb([24, 27, 32]);
const PAPER_OUTLINE: Rgb<u8> = Rgb([170, 96, 0]);
const PAPER_OPENING: Rgb<u8> = Rgb([16, 88, 176]);
const PAPER_RAY: Rgb<u8> = Rgb([176, 182, 190]);
const PAPER_RULE: Rgb<u8> = Rgb([222, 226, 231]);
pub(super) const OPENING: Rgb<u8> = Rgb([96, 176, 255]);

/// Colours of a picture of the segmentation.
struct Palette {
    no_reading: Rgb<u8>,
    planes: [Rgb<u8>; 4],
    rest: Rgb<u8>,
    part: Rgb<u8>,
    /// Brightness of the farthest point relative to the nearest, 0..1.
    farthest: f32,
}

const ON_SCREEN: Palette = Palette {
    no_reading: Rgb([0; 3]),
    planes: [
        Rgb([44, 82, 130]),
        Rgb([40, 108, 96]),
        Rgb([104, 70, 120]),
        Rgb([120, 84, 60]),
    ],
    rest: Rgb([190; 3]),
    part: PART,
    farthest: 0.55,
};

/// Large areas are pale, which saves ink and makes the part stand out.
const ON_PAPER: Palette = Palette {
    no_reading: PAPER,
    planes: [
        Rgb([206, 219, 237]),
        Rgb([204, 229, 222]),
        Rgb([228, 216, 234]),
        Rgb([236, 224, 212]),
    ],
    rest: Rgb([160; 3]),
    part: Rgb([222, 140, 0]),
    farthest: 0.8,
};

/// Writes a picture atomically.
pub fn write_png(path: &Path, picture: &RgbImage) -> Result<(), FileError> {
    write_atomically(path, |writer| {
        let mut png = io::Cursor::new(Vec::new());
        picture
            .write_to(&mut png, ImageFormat::Png)
            .map_err(io::Error::other)?;
        writer.write_all(png.get_ref())
    })
}

/// Draws the stages that ran, in colours for print: segmentation (of an organised scene), binary image, contour,
/// signature.
pub fn stage_pictures(scene: &SceneCloud, inspection: &Inspection) -> Vec<Picture> {
    let plane = inspection.plane.as_ref();
    let (contour, signature) = (inspection.contour.as_ref(), inspection.signature.as_ref());
    let images = [
        coloured(scene, &inspection.segmentation, &ON_PAPER),
        plane.map(binary_picture),
        plane
            .zip(contour)
            .map(|(plane, contour)| fan(plane, contour, signature)),
        signature.map(curves),
    ];
    let pictures = STAGES.into_iter().zip(images);
    let pictures = pictures.filter_map(|(stage, image)| {
        Some(Picture {
            part: None,
            stage,
            image: image?,
        })
    });
    pictures.collect()
}

/// Draws the stages of every part of a frame: those of the part that the report is about, then those of the others, with their
/// numbers.
pub fn frame_pictures(scene: &SceneCloud, parts: &[&Inspection], about: usize) -> Vec<Picture> {
    let others = (parts.iter().enumerate()).filter(|(index, _)| *index != about);
    let others = others.flat_map(|(index, part)| {
        let part_number = Some(index + 1);
        let pictures = stage_pictures(scene, part).into_iter();
        pictures.map(move |picture| Picture {
            part: part_number,
            ..picture
        })
    });
    let about = parts.get(about).map(|part| stage_pictures(scene, part));
    about.into_iter().flatten().chain(others).collect()
}

/// Combines the pictures side by side at one height.
pub(super) fn strip(pictures: &[Picture]) -> RgbImage {
    const HEIGHT: u32 = 360;
    const GAP: u32 = 8;
    let scaled: Vec<RgbImage> = pictures
        .iter()
        .map(|p| {
            let width = (p.image.width() * HEIGHT).div_ceil(p.image.height().max(1));
            resize(&p.image, width, HEIGHT, FilterType::Triangle)
        })
        .collect();
    let width = scaled
        .iter()
        .map(|s| s.width() + GAP)
        .sum::<u32>()
        .saturating_sub(GAP);
    let mut strip = RgbImage::from_pixel(width, HEIGHT, PAPER);
    let mut left = 0;
    for picture in &scaled {
        replace(&mut strip, picture, i64::from(left), 0);
        left += picture.width() + GAP;
    }
    strip
}

/// Draws the label of every pixel; nearer is brighter. `None` for a scene that is not organised.
pub fn segmentation_picture(scene: &SceneCloud, segmentation: &Segmentation) -> Option<RgbImage> {
    coloured(scene, segmentation, &ON_SCREEN)
}

fn coloured(
    scene: &SceneCloud,
    segmentation: &Segmentation,
    palette: &Palette,
) -> Option<RgbImage> {
    let grid = scene.cloud.grid?;
    let depths = || scene.cloud.finite().map(|(_, p)| p.z);
    let (nearest, farthest) = (
        depths().fold(f32::INFINITY, f32::min),
        depths().fold(f32::NEG_INFINITY, f32::max),
    );
    let range = (farthest - nearest).max(1e-3);
    let colour_of = |i: usize| {
        let Rgb(base) = match segmentation.labels.get(i)? {
            PointLabel::NoReading => return None,
            PointLabel::Background(plane) => {
                palette.planes[usize::from(*plane) % palette.planes.len()]
            }
            PointLabel::Rest => palette.rest,
            PointLabel::Part => palette.part,
        };
        let nearness = 1.0 - (scene.cloud.points[i].z - nearest) / range;
        let brightness = palette.farthest + (1.0 - palette.farthest) * nearness;
        Some(Rgb(base.map(|c| (f32::from(c) * brightness) as u8)))
    };
    Some(RgbImage::from_fn(
        grid.width as u32,
        grid.height as u32,
        |u, v| colour_of(v as usize * grid.width + u as usize).unwrap_or(palette.no_reading),
    ))
}

/// Draws the binary image as in the paper: black on white.
pub fn binary_picture(plane: &PlaneImage) -> RgbImage {
    let scale = scale_of(plane) as u32;
    let image = &plane.image;
    RgbImage::from_fn(
        image.width as u32 * scale,
        image.height as u32 * scale,
        |u, v| {
            if image.is_set(i64::from(u / scale), i64::from(v / scale)) {
                Rgb([0; 3])
            } else {
                Rgb([255; 3])
            }
        },
    )
}

/// Returns the integer scale of the picture at which its longer side has at least 600 pixels.
fn scale_of(plane: &PlaneImage) -> usize {
    let longer = plane.image.width.max(plane.image.height).max(1);
    600_usize.div_ceil(longer).max(1)
}

/// Draws the outline, the openings, the centroid and every fourth ray.
fn fan(plane: &PlaneImage, contour: &Contour, signature: Option<&FanSignature>) -> RgbImage {
    let scale = scale_of(plane);
    let mut canvas = Canvas::new(plane.image.width * scale, plane.image.height * scale, PAPER);
    let place = |p: &Point2<f64>| {
        let (u, v) = plane.pixel_of(p);
        [(u + 0.5) * scale as f64, (v + 0.5) * scale as f64]
    };
    if let Some(signature) = signature {
        let centroid = place(&signature.centroid);
        for ray in signature.rays.iter().step_by(4) {
            canvas.line(centroid, place(&(signature.centroid + ray)), PAPER_RAY);
        }
    }
    let closed = |border: &[Point2<f64>]| {
        let again = border.first().copied();
        border.iter().copied().chain(again).collect::<Vec<_>>()
    };
    for opening in &contour.openings {
        canvas.polyline(closed(opening).iter().map(place), (1.5, &[]), PAPER_OPENING);
    }
    canvas.polyline(
        closed(&contour.outline).iter().map(place),
        (2.0, &[]),
        PAPER_OUTLINE,
    );
    if let Some(signature) = signature {
        canvas.dot(place(&signature.centroid), 5.0, INK);
        if let Some(first) = signature.rays.first() {
            canvas.dot(place(&(signature.centroid + first)), 4.0, INK);
        }
    }
    canvas.finish()
}

/// Size of each curve's half of the picture, pixels.
const CURVE: [usize; 2] = [800, 200];

/// Draws L above and Θ below, each over the rays in order; the faint lines are quarters of the range.
fn curves(signature: &FanSignature) -> RgbImage {
    let [width, height] = CURVE;
    let mut canvas = Canvas::new(width, 2 * height, PAPER);
    let halves = [
        (0, signature.lengths(), true),
        (1, signature.angles(), false),
    ];
    for (half, values, from_zero) in halves {
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = if from_zero {
            0.0
        } else {
            values.iter().copied().fold(f64::INFINITY, f64::min)
        };
        let range = (high - low).max(1e-9);
        let top = (half * height) as f64 + 8.0;
        let room = height as f64 - 16.0;
        for quarter in 0..=4 {
            let y = top + room * f64::from(quarter) / 4.0;
            canvas.line([0.0, y], [width as f64, y], PAPER_RULE);
        }
        let last = values.len().saturating_sub(1).max(1) as f64;
        let place = |(i, value): (usize, &f64)| {
            [
                i as f64 / last * (width as f64 - 1.0),
                top + room * (1.0 - (value - low) / range),
            ]
        };
        let colour = if from_zero {
            PAPER_OUTLINE
        } else {
            PAPER_OPENING
        };
        canvas.polyline(values.iter().enumerate().map(place), (2.0, &[]), colour);
    }
    canvas.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::{
        library::Library,
        pipeline::{Recipe, Unwatched, run},
    };
    use simulate::{CellSetup, PartKind, Side};
    use stages::fixtures::scene_of;

    fn pictures_of(scene: &SceneCloud) -> Vec<Picture> {
        let library = Library::default();
        let inspection = run(scene, &library, &Recipe::default(), &Unwatched).expect("run");
        stage_pictures(scene, &inspection)
    }

    #[test]
    fn every_stage_that_ran_has_a_picture_that_shows_something() {
        let setup = CellSetup::with_part(PartKind::BackDoor, Side::Left, 0, 2);
        let pictures = pictures_of(&scene_of(&setup));
        let stages: Vec<_> = pictures.iter().map(|p| p.stage).collect();
        assert_eq!(stages, ["segmentation", "binary", "contour", "signature"]);
        for picture in &pictures {
            let first = picture.image.get_pixel(0, 0);
            let num_other = picture.image.pixels().filter(|p| *p != first).count();
            assert!(num_other > 500, "{}: {num_other} pixels", picture.stage);
        }
    }

    #[test]
    fn an_empty_scene_has_no_picture() {
        assert!(pictures_of(&SceneCloud::default()).is_empty());
    }
}
