//! Depth images: 16-bit greyscale PNG with the camera in a JSON file beside it.
//!
//! The pixels are depth along the optical axis in units of `metres_per_unit`, 0 for no reading, as in the Kinect tools
//! and the RGB-D data sets. The camera of `frame.png` is in `frame.json`:
//!
//! ```json
//! {"width":640,"height":480,"fx":525.0,"fy":525.0,"cx":319.5,"cy":239.5,"metres_per_unit":0.001}
//! ```
//!
//! The fields are those of [`Intrinsics`] and [`DepthFrame`] and refer to the image as stored; a simulated camera also has
//! `"simulated":true`. Optional fields: OpenCV's coefficients of the lens distortion by name (`k1` to `k6`, `p1`, `p2`) or
//! in its order as `distortion`; how the stored image differs from the camera's own view
//! ([`StoredOrientation`](super::StoredOrientation)), which loading corrects; `depth_scale` instead of `metres_per_unit`.
//! Unknown fields are ignored. Images of one camera may share an `intrinsics.json` in their folder: it applies to every
//! image without a JSON of its own.

use std::io::{self, Cursor, Write};
use std::path::Path;

use image::codecs::png::{PngDecoder, PngEncoder};
use image::{
    DynamicImage, ExtendedColorType, ImageDecoder as _, ImageEncoder as _, ImageError, Limits,
};

use super::depth_camera::{DepthCamera, MAX_CAMERA_BYTES};
pub use super::depth_camera::{FOLDER_CAMERA, intrinsics_path};
use super::disk;
use super::error::FileError;
use super::source::{Source, read_limited};
use super::write::{replace_file, write_atomically};
use geometry::depth_frame::{DepthFrame, Intrinsics};
use geometry::error::guarded;

/// Writes a depth image as PNG, with its camera in the JSON beside it.
///
/// The JSON is written first, so that a program that waits for the image finds both.
///
/// # Panics
/// If the number of depths is not the number of the camera's pixels.
pub fn write_depth_png(path: &Path, frame: &DepthFrame) -> Result<(), FileError> {
    let json = intrinsics_path(path);
    // Do not overwrite a file that is not a camera.
    let camera = DepthCamera::from_frame(frame);
    match read_limited(&json, MAX_CAMERA_BYTES) {
        Ok(bytes) if is_intrinsics(&bytes) => {
            // Remove the old image first, so that nobody reads it with the new camera.
            if path.is_file() && !DepthCamera::read(&json).is_ok_and(|known| known == camera) {
                disk::remove_file(path).map_err(|error| FileError::writing(path, error))?;
            }
        }
        Err(FileError::NotFound { .. }) => {}
        _ => {
            return Err(FileError::ForeignSidecar {
                path: json,
                image: path.to_owned(),
            });
        }
    }
    write_camera(&json, &camera)?;
    write_atomically(path, |writer| write_depths(writer, frame))
}

/// Writes the camera of one depth image, or of all in a folder, as JSON.
pub fn write_camera(path: &Path, camera: &DepthCamera) -> Result<(), FileError> {
    let written = serde_json::to_vec_pretty(camera).map_err(io::Error::from);
    let written = written.and_then(|json| replace_file(path, &[&json[..], b"\n"].concat()));
    written.map_err(|source| FileError::writing(path, source))
}

/// Writes the depths of a frame as a 16-bit PNG, without its camera.
///
/// # Panics
/// If the number of depths is not the number of the camera's pixels.
pub fn write_depths(writer: &mut dyn Write, frame: &DepthFrame) -> io::Result<()> {
    let DepthFrame {
        intrinsics: Intrinsics { width, height, .. },
        depth,
        ..
    } = frame;
    assert_eq!(depth.len(), width * height, "a depth for every pixel");
    // The encoder takes bytes in native order and stores them big-endian.
    let bytes: Vec<u8> = depth.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
    let (width, height) = (*width as u32, *height as u32);
    PngEncoder::new(writer)
        .write_image(&bytes, width, height, ExtendedColorType::L16)
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })
}

/// Returns true for JSON that describes the camera of a depth image.
pub(super) fn is_intrinsics(bytes: &[u8]) -> bool {
    bytes.len() as u64 <= MAX_CAMERA_BYTES && serde_json::from_slice::<DepthCamera>(bytes).is_ok()
}

/// Returns true for the eight bytes that begin a PNG.
pub(super) fn is_png(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89PNG\r\n\x1a\n")
}

pub(super) fn read(source: Source<'_>) -> Result<DepthFrame, FileError> {
    let (size, depth) = decode(source)?;
    let own = intrinsics_path(source.path);
    let shared = own.with_file_name(FOLDER_CAMERA);
    let json = if shared.is_file() && !own.exists() {
        shared
    } else {
        own
    };
    let camera = DepthCamera::read(&json).map_err(|error| match error {
        FileError::NotFound { .. } => FileError::MissingIntrinsics {
            path: source.path.to_owned(),
            json: json.clone(),
        },
        other => other,
    })?;
    let num_pixels = depth.len();
    let is_empty = depth.iter().all(|&depth| depth == 0);
    let frame = camera.frame(size, depth);
    let frame = frame.map_err(|found| FileError::BadIntrinsics { path: json, found })?;
    if is_empty {
        return Err(FileError::NoPoints {
            path: source.path.to_owned(),
            found: num_pixels,
        });
    }
    Ok(frame)
}

/// Limits of a small picture: bytes of the file, and pixels along a side.
const MAX_PICTURE_BYTES: u64 = 16 << 20;
const MAX_PICTURE_SIDE: u32 = 4096;

/// Reads a small picture meant for people, such as a part's thumbnail.
pub fn read_picture(path: &Path) -> Result<DynamicImage, FileError> {
    let bytes = read_limited(path, MAX_PICTURE_BYTES)?;
    let damaged = |what: String| FileError::Damaged {
        path: path.to_owned(),
        what,
    };
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_PICTURE_SIDE);
    limits.max_image_height = Some(MAX_PICTURE_SIDE);
    let decoded = guarded(|| {
        let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits)?;
        DynamicImage::from_decoder(decoder)
    });
    let decoded = decoded.map_err(|fault| damaged(fault.to_string()))?;
    decoded.map_err(|error| damaged(error.to_string()))
}

/// Returns width, height and depths of a 16-bit PNG; all depths may be 0.
pub(super) fn decode(source: Source<'_>) -> Result<((usize, usize), Vec<u16>), FileError> {
    let wrong = |error: ImageError| match error {
        ImageError::IoError(_) => source.cut_before("the end of the image", "PNG"),
        other => source.damaged(other.to_string()),
    };
    let header = Header::parse(source.bytes)
        .ok_or_else(|| source.cut_before("the end of the header", "PNG"))?;
    // Check this before the decoder does, which refuses large sizes in words of its own.
    source.limited("pixels", header.width.saturating_mul(header.height))?;
    let longest = header.width.max(header.height);
    if longest > MAX_SIDE {
        return Err(FileError::TooLarge {
            path: source.path.to_owned(),
            what: "pixels along one side",
            found: longest as u64,
            limit: MAX_SIDE as u64,
        });
    }
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
    // PNG compresses with deflate, which cannot exceed this ratio.
    let most = source.bytes.len().saturating_mul(MAX_DEFLATE_RATIO);
    if num_bytes > most {
        return Err(source.truncated("PNG", source.bytes.len(), num_bytes / MAX_DEFLATE_RATIO));
    }
    match DynamicImage::from_decoder(decoder).map_err(wrong)? {
        DynamicImage::ImageLuma16(image) => Ok(((width, height), image.into_raw())),
        // The kind was checked above.
        _ => Err(source.damaged("it is no 16-bit greyscale image")),
    }
}

/// The fields of a PNG's first chunk that are needed here.
struct Header {
    width: usize,
    height: usize,
    bits: u8,
    colour_type: u8,
}

/// The colour type of a PNG with a palette.
const PALETTE: u8 = 3;

impl Header {
    /// Returns `None` if the bytes end before the header does.
    fn parse(bytes: &[u8]) -> Option<Self> {
        // Skip eight bytes of magic, and the chunk's length and name.
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

/// The longest side of a depth image, in pixels: four times that of the finest depth camera. A single row of pixels
/// compresses to nearly nothing, so the size of the file does not bound it.
const MAX_SIDE: usize = 16_384;

/// Memory that the decoder may allocate for itself (rows and text chunks), in bytes; far more than any camera's PNG needs.
const MAX_ANCILLARY_BYTES: u64 = 64 << 20;

/// An upper limit of deflate's compression ratio. Its best is 258 bytes from two bits, about 1032 to 1.
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

#[cfg(test)]
mod tests;
