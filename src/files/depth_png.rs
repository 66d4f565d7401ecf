//! A depth image as a 16-bit greyscale PNG, with its camera in a JSON beside it.
//!
//! The image's numbers are depth along the optical axis in units of `metres_per_unit`, 0 where there is no reading,
//! as the Kinect tools and the RGB-D data sets store it. For `frame.png` the camera stands in `frame.json`:
//!
//! ```json
//! {"width":640,"height":480,"fx":525.0,"fy":525.0,"cx":319.5,"cy":239.5,"metres_per_unit":0.001}
//! ```
//!
//! The fields are those of [`Intrinsics`] and [`DepthFrame`]; others are read over.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::codecs::png::{PngDecoder, PngEncoder};
use image::{ExtendedColorType, ImageDecoder as _, ImageEncoder as _, ImageError, Limits};
use serde::{Deserialize, Serialize};

use super::error::FileError;
use super::source::{Source, read_bytes};
use super::write::write_atomically;
use crate::capture::frame::{DepthFrame, Intrinsics};

/// The JSON beside a depth image.
#[derive(Serialize, Deserialize)]
struct Sidecar {
    #[serde(flatten)]
    intrinsics: Intrinsics,
    metres_per_unit: f64,
}

/// Where the camera of a depth image stands: the same name ending in `.json`.
pub fn intrinsics_path(image: &Path) -> PathBuf {
    image.with_extension("json")
}

/// Writes a depth image as PNG with its camera in the JSON beside it.
///
/// The JSON is there first, so that whoever waits for the image finds both.
///
/// # Panics
/// If the frame has not as many depths as its camera has pixels.
pub fn write_depth_png(path: &Path, frame: &DepthFrame) -> Result<(), FileError> {
    let DepthFrame {
        intrinsics,
        metres_per_unit,
        depth,
    } = frame;
    let Intrinsics { width, height, .. } = *intrinsics;
    assert_eq!(depth.len(), width * height, "a depth for every pixel");
    let sidecar = Sidecar {
        intrinsics: *intrinsics,
        metres_per_unit: *metres_per_unit,
    };
    let json = intrinsics_path(path);
    // Whatever else lies there is somebody's data.
    if std::fs::read(&json).is_ok_and(|bytes| !is_intrinsics(&bytes)) {
        return Err(FileError::ForeignSidecar {
            path: json,
            image: path.to_owned(),
        });
    }
    write_atomically(&json, |writer| {
        serde_json::to_writer_pretty(&mut *writer, &sidecar)?;
        writer.write_all(b"\n")
    })?;
    // The encoder takes the bytes in this machine's order and stores them in the PNG's.
    let bytes: Vec<u8> = depth.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
    write_atomically(path, |writer| {
        let encoder = PngEncoder::new(&mut *writer);
        let written =
            encoder.write_image(&bytes, width as u32, height as u32, ExtendedColorType::L16);
        written.map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => std::io::Error::other(other),
        })
    })
}

/// True for the JSON that describes a depth image's camera.
pub(super) fn is_intrinsics(bytes: &[u8]) -> bool {
    serde_json::from_slice::<Sidecar>(bytes).is_ok()
}

pub(super) fn read(source: Source<'_>) -> Result<DepthFrame, FileError> {
    let (size, depth) = decode(source)?;
    let json = intrinsics_path(source.path);
    let Sidecar {
        intrinsics,
        metres_per_unit,
    } = read_sidecar(source.path, &json)?;
    let bad = |found: String| FileError::BadIntrinsics {
        path: json.clone(),
        found,
    };
    if (intrinsics.width, intrinsics.height) != size {
        return Err(bad(format!(
            "{}×{} pixels, where the image has {}×{}",
            intrinsics.width, intrinsics.height, size.0, size.1
        )));
    }
    if !(intrinsics.fx > 0.0 && intrinsics.fy > 0.0 && metres_per_unit > 0.0) {
        return Err(bad("fx, fy and metres_per_unit must be above 0".into()));
    }
    if !(intrinsics.fx + intrinsics.fy + intrinsics.cx + intrinsics.cy + metres_per_unit)
        .is_finite()
    {
        return Err(bad("a number is not finite".into()));
    }
    if depth.iter().all(|&depth| depth == 0) {
        return Err(FileError::NoPoints {
            path: source.path.to_owned(),
            found: depth.len(),
        });
    }
    Ok(DepthFrame {
        intrinsics,
        metres_per_unit,
        depth,
    })
}

fn decode(source: Source<'_>) -> Result<((usize, usize), Vec<u16>), FileError> {
    let wrong = |error: ImageError| match error {
        ImageError::IoError(_) => source.cut_before("the end of the image", "PNG"),
        other => source.damaged(other.to_string()),
    };
    let header = Header::of(source.bytes)
        .ok_or_else(|| source.cut_before("the end of the header", "PNG"))?;
    // Before the decoder, which refuses large sizes in words of its own.
    source.limited("pixels", header.width.saturating_mul(header.height))?;
    if header.colour_type == PALETTE {
        return Err(FileError::WrongPngKind {
            path: source.path.to_owned(),
            found: match header.bits {
                8 => "an 8-bit PNG with a palette".into(),
                bits => format!("a {bits}-bit PNG with a palette"),
            },
        });
    }
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_ANCILLARY_BYTES);
    let decoder = PngDecoder::with_limits(Cursor::new(source.bytes), limits).map_err(wrong)?;
    let kind = decoder.original_color_type();
    if kind != ExtendedColorType::L16 {
        return Err(FileError::WrongPngKind {
            path: source.path.to_owned(),
            found: kind_in_words(kind),
        });
    }
    let (width, height) = decoder.dimensions();
    let (width, height) = (width as usize, height as usize);
    let num_pixels = source.limited("pixels", width.saturating_mul(height))?;
    let num_bytes = num_pixels.saturating_mul(2);
    // No PNG packs better than deflate, and that not better than this.
    let most = source.bytes.len().saturating_mul(MAX_DEFLATE_RATIO);
    if num_bytes > most {
        return Err(source.truncated("PNG", source.bytes.len(), num_bytes / MAX_DEFLATE_RATIO));
    }
    let mut bytes = vec![0; num_bytes];
    decoder.read_image(&mut bytes).map_err(wrong)?;
    let pairs = bytes.chunks_exact(2).filter_map(|pair| pair.first_chunk());
    let depth = pairs.map(|pair| u16::from_ne_bytes(*pair)).collect();
    Ok(((width, height), depth))
}

/// What the first chunk of a PNG says, as far as it matters here.
struct Header {
    width: usize,
    height: usize,
    bits: u8,
    colour_type: u8,
}

/// The colour type of a PNG whose pixels are numbers of colours in a table.
const PALETTE: u8 = 3;

impl Header {
    /// `None` if the bytes end before it does.
    fn of(bytes: &[u8]) -> Option<Self> {
        // Eight bytes of magic, then the chunk's length and name.
        let [w0, w1, w2, w3, h0, h1, h2, h3, bits, colour_type] =
            *bytes.get(16..)?.first_chunk()?;
        Some(Self {
            width: u32::from_be_bytes([w0, w1, w2, w3]) as usize,
            height: u32::from_be_bytes([h0, h1, h2, h3]) as usize,
            bits,
            colour_type,
        })
    }
}

/// What the decoder may take for itself: rows and text chunks, far above any camera's.
const MAX_ANCILLARY_BYTES: u64 = 64 << 20;

/// Deflate's best: 258 bytes from two bits, about 1032 to 1.
const MAX_DEFLATE_RATIO: usize = 1040;

fn kind_in_words(kind: ExtendedColorType) -> String {
    match kind {
        ExtendedColorType::L1
        | ExtendedColorType::L2
        | ExtendedColorType::L4
        | ExtendedColorType::L8 => "a greyscale PNG of 8 bits or less".into(),
        ExtendedColorType::La8 | ExtendedColorType::La16 => {
            "a greyscale PNG with transparency".into()
        }
        ExtendedColorType::Rgb8 => "a colour PNG".into(),
        ExtendedColorType::Rgba8 => "a colour PNG with transparency".into(),
        ExtendedColorType::Rgb16 | ExtendedColorType::Rgba16 => "a 16-bit colour PNG".into(),
        other => format!("a PNG of {other:?}"),
    }
}

fn read_sidecar(image: &Path, json: &Path) -> Result<Sidecar, FileError> {
    let bytes = read_bytes(json).map_err(|error| match error {
        FileError::NotFound { .. } => FileError::MissingIntrinsics {
            path: image.to_owned(),
            json: json.to_owned(),
        },
        other => other,
    })?;
    serde_json::from_slice(&bytes).map_err(|error| FileError::BadIntrinsics {
        path: json.to_owned(),
        found: error.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Advice as _;
    use crate::files::{Opened, crc32, open};

    fn frame() -> DepthFrame {
        DepthFrame {
            intrinsics: Intrinsics {
                width: 3,
                height: 2,
                fx: 500.0,
                fy: 501.5,
                cx: 1.0,
                cy: 0.5,
            },
            metres_per_unit: 0.001,
            depth: vec![0, 1, 256, 1000, 65_535, 700],
        }
    }

    #[test]
    fn a_frame_survives_being_written_and_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        write_depth_png(&path, &frame()).unwrap();
        assert_eq!(open(&path).unwrap(), Opened::Depth(frame()));
    }

    #[test]
    fn missing_intrinsics_are_asked_for_with_an_example_that_works() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        write_depth_png(&path, &frame()).unwrap();
        std::fs::remove_file(intrinsics_path(&path)).unwrap();
        let error = open(&path).unwrap_err();
        assert!(matches!(error, FileError::MissingIntrinsics { .. }));
        let advice = error.advice();
        let example = advice.get(advice.find('{').unwrap()..).unwrap();
        let parsed: Sidecar = serde_json::from_str(example).unwrap();
        assert_eq!(parsed.intrinsics, Intrinsics::KINECT);
    }

    #[test]
    fn intrinsics_that_cannot_be_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        write_depth_png(&path, &frame()).unwrap();
        let json = intrinsics_path(&path);
        let good = std::fs::read_to_string(&json).unwrap();
        for (from, to) in [
            ("500.0", "0.0"),
            ("501.5", "-1.0"),
            ("0.001", "0"),
            ("\"width\": 3", "\"width\": 4"),
            ("\"fx\"", "\"focal\""),
            ("0.5", "1e999"),
            ("{", ""),
        ] {
            let bad = good.replacen(from, to, 1);
            assert_ne!(bad, good);
            std::fs::write(&json, bad).unwrap();
            let error = open(&path).unwrap_err();
            assert!(
                matches!(error, FileError::BadIntrinsics { .. }),
                "{from} -> {to}: {error}"
            );
        }
    }

    #[test]
    fn other_kinds_of_png_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        for (kind, num_bytes, word) in [
            (ExtendedColorType::L8, 1, "8 bits"),
            (ExtendedColorType::Rgb8, 3, "colour"),
            (ExtendedColorType::Rgb16, 6, "16-bit colour"),
        ] {
            let mut png = Vec::new();
            PngEncoder::new(&mut png)
                .write_image(&vec![9; num_bytes], 1, 1, kind)
                .unwrap();
            std::fs::write(&path, png).unwrap();
            let error = open(&path).unwrap_err();
            assert!(
                matches!(&error, FileError::WrongPngKind { found, .. } if found.contains(word)),
                "{error}"
            );
        }
    }

    #[test]
    fn a_frame_without_a_reading_has_no_points() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        write_depth_png(
            &path,
            &DepthFrame {
                depth: vec![0; 6],
                ..frame()
            },
        )
        .unwrap();
        assert!(matches!(
            open(&path),
            Err(FileError::NoPoints { found: 6, .. })
        ));
    }

    #[test]
    fn an_image_larger_than_its_bytes_could_hold_takes_no_memory() {
        // A correct header of 7000×7000 pixels over the data of six.
        let png = with_header(|header| {
            header[..4].copy_from_slice(&7000_u32.to_be_bytes());
            header[4..8].copy_from_slice(&7000_u32.to_be_bytes());
        });
        assert!(matches!(decoded(&png), Err(FileError::Truncated { .. })));
    }

    /// A PNG of six pixels whose header was changed and made consistent again.
    fn with_header(change: impl FnOnce(&mut [u8])) -> Vec<u8> {
        let mut png = Vec::new();
        PngEncoder::new(&mut png)
            .write_image(&[0; 12], 3, 2, ExtendedColorType::L16)
            .unwrap();
        change(&mut png[16..29]);
        let checksum = crc32(&png[12..29]);
        png[29..33].copy_from_slice(&checksum.to_be_bytes());
        png
    }

    fn decoded(png: &[u8]) -> Result<((usize, usize), Vec<u16>), FileError> {
        decode(Source {
            path: Path::new("test.png"),
            bytes: png,
        })
    }

    #[test]
    fn a_size_beyond_all_cameras_is_too_large_as_in_other_formats() {
        let png = with_header(|header| {
            header[..4].copy_from_slice(&(1_u32 << 16).to_be_bytes());
            header[4..8].copy_from_slice(&(1_u32 << 15).to_be_bytes());
        });
        assert!(matches!(
            decoded(&png),
            Err(FileError::TooLarge { what: "pixels", found, .. }) if found == 1 << 31
        ));
    }

    #[test]
    fn a_palette_is_named_and_a_cut_image_invents_no_number() {
        let palette = with_header(|header| header[8..10].copy_from_slice(&[8, PALETTE]));
        let error = decoded(&palette).unwrap_err();
        assert!(
            error.to_string().contains("an 8-bit PNG with a palette"),
            "{error}"
        );
        let whole = with_header(|_| {});
        for length in [9, 20, whole.len() - 20] {
            let error = decoded(&whole[..length]).unwrap_err();
            assert!(
                error.to_string().contains("expected the end of the"),
                "{error}"
            );
        }
    }

    #[test]
    fn a_camera_is_no_capture_and_nothing_else_is_overwritten_by_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        write_depth_png(&path, &frame()).unwrap();
        let json = intrinsics_path(&path);
        let error = open(&json).unwrap_err();
        assert!(matches!(&error, FileError::IsIntrinsics { image, .. } if *image == path));
        write_depth_png(&path, &frame()).expect("a camera may be replaced by a camera");
        std::fs::write(&json, "{\"shift\": 3}").unwrap();
        let error = write_depth_png(&path, &frame()).unwrap_err();
        assert!(matches!(error, FileError::ForeignSidecar { .. }));
        assert_eq!(std::fs::read_to_string(&json).unwrap(), "{\"shift\": 3}");
    }
}
