//! Conversion of a camera's pixels into depths and points, according to its nodes.
//!
//! Source: GenICam Standard Features Naming Convention 2.7, chapter "3D Scan Control". A coordinate is
//! `Scan3dCoordinateScale` · value + `Scan3dCoordinateOffset`, in `Scan3dDistanceUnit`; the value `Scan3dInvalidDataValue`
//! means no reading if `Scan3dInvalidDataFlag` is set. Coordinate A is x, B is y, C is z.
//!
//! Only depth along the optical axis and points in the camera's own frame are accepted. Disparities, distances along a ray,
//! heights on a rectified grid, points in a user-defined frame, and mirrored depth images are errors, because parts would
//! appear with a wrong shape or in a wrong place.

use std::{ffi::CStr, fmt::Display};

use nalgebra::Point3;

use super::{
    aravis::{Device, Part},
    not_opened,
};
use crate::{
    camera_error::CameraError, camera_library::ARAVIS, error::CaptureWarning, source::Image,
    spec::GenicamFormat,
};
use files::{DepthCamera, StoredOrientation};
use geometry::{
    cloud::{Grid, PointCloud},
    depth_frame::Intrinsics,
    distortion::Distortion,
};

/// Converts the pixels of one format into an image.
pub(super) enum Decoder {
    /// A depth image.
    Depth {
        camera: DepthCamera,
        /// Depth for every pixel value, in the camera's units; 0 means no reading.
        units: Vec<u16>,
    },
    /// Points.
    Points {
        axes: [Axis; 3],
        /// True if the points keep the camera's rows and columns.
        is_organised: bool,
    },
}

/// Converts the values of one coordinate into metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    /// Metres per step.
    scale: f64,
    /// Metres at the value 0.
    offset: f64,
    /// The value that means no reading.
    invalid: Option<f64>,
}

/// Values of the camera's nodes; `None` without the node.
#[derive(Clone, Default)]
pub(super) struct Scan3d {
    output_mode: Option<String>,
    coordinate_system: Option<String>,
    reference: Option<String>,
    distance_unit: Option<String>,
    axes: [AxisNodes; 3],
    focal_length: Option<f64>,
    /// Focal length along rows divided by that along columns.
    aspect_ratio: Option<f64>,
    principal_point: [Option<f64>; 2],
    /// Columns and rows.
    size: [Option<f64>; 2],
    /// Number of columns and rows before the region.
    region_offset: [Option<f64>; 2],
    /// Whether columns, and rows, are in reverse order.
    is_reversed: [Option<bool>; 2],
}

#[derive(Clone, Default)]
struct AxisNodes {
    scale: Option<f64>,
    offset: Option<f64>,
    invalid: Option<f64>,
}

/// Node of the focal length, in pixels.
pub(super) const FOCAL_LENGTH: &CStr = c"Scan3dFocalLength";

impl Scan3d {
    /// Reads the nodes for the pixel format, which has to be set already.
    pub(super) fn read(device: &Device, format: GenicamFormat) -> Result<Self, String> {
        let axis = |selected: &CStr| -> Result<AxisNodes, String> {
            // A camera with one coordinate may lack the selector.
            if device.has(c"Scan3dCoordinateSelector")? {
                device.set(c"Scan3dCoordinateSelector", selected)?;
            }
            // A camera that has the value but no flag always uses the value.
            let is_flagged = device.flag(c"Scan3dInvalidDataFlag")?.unwrap_or(true);
            let invalid = device.number(c"Scan3dInvalidDataValue")?;
            Ok(AxisNodes {
                scale: device.number(c"Scan3dCoordinateScale")?,
                offset: device.number(c"Scan3dCoordinateOffset")?,
                invalid: invalid.filter(|_| is_flagged),
            })
        };
        let is_reversed = [device.flag(c"ReverseX")?, device.flag(c"ReverseY")?];
        let axes = match format {
            GenicamFormat::Coord3dC16 => [
                AxisNodes::default(),
                AxisNodes::default(),
                axis(c"CoordinateC")?,
            ],
            GenicamFormat::Coord3dAbc32f => [
                axis(c"CoordinateA")?,
                axis(c"CoordinateB")?,
                axis(c"CoordinateC")?,
            ],
            // Everything else comes from the file.
            GenicamFormat::Mono16 => {
                return Ok(Self {
                    is_reversed,
                    ..Self::default()
                });
            }
        };
        Ok(Self {
            output_mode: device.text(c"Scan3dOutputMode")?,
            coordinate_system: device.text(c"Scan3dCoordinateSystem")?,
            reference: device.text(c"Scan3dCoordinateSystemReference")?,
            distance_unit: device.text(c"Scan3dDistanceUnit")?,
            axes,
            focal_length: device.number(FOCAL_LENGTH)?,
            aspect_ratio: device.number(c"Scan3dAspectRatio")?,
            principal_point: [
                device.number(c"Scan3dPrincipalPointU")?,
                device.number(c"Scan3dPrincipalPointV")?,
            ],
            size: [device.number(c"Width")?, device.number(c"Height")?],
            region_offset: [device.number(c"OffsetX")?, device.number(c"OffsetY")?],
            is_reversed,
        })
    }

    /// Returns the decoder for a format; for depth images, a file takes precedence over the camera's nodes.
    pub(super) fn decoder(
        &self,
        format: GenicamFormat,
        file: Option<DepthCamera>,
    ) -> Result<(Decoder, Vec<CaptureWarning>), CameraError> {
        match (format, file) {
            (GenicamFormat::Coord3dAbc32f, _) => self.points(),
            (GenicamFormat::Coord3dC16, file) => self.depth(file),
            (GenicamFormat::Mono16, Some(camera)) => {
                self.check_order(&camera)?;
                let units = (0..=u16::MAX).collect();
                Ok((Decoder::Depth { camera, units }, Vec::new()))
            }
            (GenicamFormat::Mono16, None) => Err(not_reported("Scan3dCoordinateScale")),
        }
    }

    fn depth(
        &self,
        file: Option<DepthCamera>,
    ) -> Result<(Decoder, Vec<CaptureWarning>), CameraError> {
        self.check_frame("CalibratedC", &["CalibratedC", "CalibratedABC_Grid"])?;
        let [.., nodes] = &self.axes;
        let (camera, axis, warnings) = if let Some(camera) = file {
            self.check_order(&camera)?;
            // The file has no offset, so that of the camera is used.
            let (unit, warnings) = match nodes.offset {
                None | Some(0.0) => (1.0, Vec::new()),
                Some(_) => self.unit()?,
            };
            let axis = nodes.axis(camera.metres_per_unit / unit, unit);
            (camera, axis, warnings)
        } else {
            let (unit, warnings) = self.unit()?;
            let scale = reported(nodes.scale, "Scan3dCoordinateScale")?;
            let camera = self.camera()?;
            self.check_order(&camera)?;
            self.check_region()?;
            (camera, nodes.axis(scale, unit), warnings)
        };
        let (units, metres_per_unit) = depth_table(&axis)?;
        let camera = DepthCamera {
            metres_per_unit,
            ..camera
        };
        let camera = camera
            .checked()
            .map_err(|what| not_opened(format!("its numbers are no camera's: {what}")))?;
        Ok((Decoder::Depth { camera, units }, warnings))
    }

    fn points(&self) -> Result<(Decoder, Vec<CaptureWarning>), CameraError> {
        self.check_frame("CalibratedABC_Grid", &["CalibratedABC_Grid", POINT_CLOUD])?;
        let (unit, warnings) = self.unit()?;
        // Floating-point coordinates need no scale, and not every camera has one for them.
        let axis = |nodes: &AxisNodes| nodes.axis(nodes.scale.unwrap_or(1.0), unit);
        let decoder = Decoder::Points {
            axes: self.axes.each_ref().map(axis),
            is_organised: self.output_mode.as_deref() != Some(POINT_CLOUD),
        };
        Ok((decoder, warnings))
    }

    /// Fails unless the output mode is one of `modes` and the coordinates are x, y, z in the camera's own frame. `advised`
    /// is the mode named in the error.
    fn check_frame(&self, advised: &'static str, modes: &[&str]) -> Result<(), CameraError> {
        let checks = [
            ("Scan3dOutputMode", &self.output_mode, advised, modes),
            (
                "Scan3dCoordinateSystem",
                &self.coordinate_system,
                "Cartesian",
                &["Cartesian"],
            ),
            (
                "Scan3dCoordinateSystemReference",
                &self.reference,
                "Anchor",
                &["Anchor"],
            ),
        ];
        for (node, found, expected, readable) in checks {
            if let Some(found) = found
                && !readable.contains(&found.as_str())
            {
                return Err(wrong_setting(node, found, expected));
            }
        }
        Ok(())
    }

    /// Fails if the camera reverses rows or columns of its depth images, unless the file specifies how they are stored:
    /// otherwise a left part would be taken for a right one.
    fn check_order(&self, camera: &DepthCamera) -> Result<(), CameraError> {
        let is_specified = camera.stored != StoredOrientation::default();
        for (node, is_reversed) in ["ReverseX", "ReverseY"].into_iter().zip(self.is_reversed) {
            if is_reversed == Some(true) && !is_specified {
                return Err(wrong_setting(node, "true", "false"));
            }
        }
        Ok(())
    }

    /// Fails if the region does not begin at the first pixel: manufacturers disagree on whether the principal point is
    /// relative to the region.
    fn check_region(&self) -> Result<(), CameraError> {
        for (node, offset) in ["OffsetX", "OffsetY"].into_iter().zip(self.region_offset) {
            if let Some(found) = offset.filter(|offset| offset.abs() > 0.0) {
                return Err(wrong_setting(node, found, "0"));
            }
        }
        Ok(())
    }

    /// Metres per unit of length of the camera.
    fn unit(&self) -> Result<(f64, Vec<CaptureWarning>), CameraError> {
        match self.distance_unit.as_deref() {
            None => Ok((0.001, vec![CaptureWarning::AssumedUnit])),
            Some("Millimeter") => Ok((0.001, Vec::new())),
            Some("Inch") => Ok((0.0254, Vec::new())),
            Some(found) => Err(wrong_setting("Scan3dDistanceUnit", found, "Millimeter")),
        }
    }

    fn camera(&self) -> Result<DepthCamera, CameraError> {
        let focal = reported(self.focal_length, "Scan3dFocalLength")?;
        let [u, v] = self.principal_point;
        let [width, height] = self.size;
        Ok(DepthCamera {
            intrinsics: Intrinsics {
                width: reported(width, "Width")? as usize,
                height: reported(height, "Height")? as usize,
                fx: focal,
                fy: focal * self.aspect_ratio.unwrap_or(1.0),
                cx: reported(u, "Scan3dPrincipalPointU")?,
                cy: reported(v, "Scan3dPrincipalPointV")?,
                distortion: Distortion::NONE,
            },
            metres_per_unit: 1.0,
            is_simulated: false,
            stored: StoredOrientation::default(),
        })
    }
}

/// Output mode: points without the camera's rows and columns.
const POINT_CLOUD: &str = "CalibratedABC_PointCloud";

impl AxisNodes {
    fn axis(&self, scale: f64, unit: f64) -> Axis {
        Axis {
            scale: scale * unit,
            offset: self.offset.unwrap_or(0.0) * unit,
            invalid: self.invalid,
        }
    }
}

fn reported(value: Option<f64>, node: &str) -> Result<f64, CameraError> {
    value.ok_or_else(|| not_reported(node))
}

/// The camera lacks a value that is needed to convert its pixels into lengths.
fn not_reported(node: &str) -> CameraError {
    ARAVIS.unsuitable(
        format!("the camera does not report its {node}, which its depth images need"),
        "Give the camera's numbers as they stand beside a depth PNG: genicam,camera=FILE",
    )
}

/// The camera is set to something other than depth along the optical axis, or points in its own frame.
fn wrong_setting(node: &str, found: impl Display, expected: &str) -> CameraError {
    ARAVIS.unsuitable(
        format!("{node} of the camera is {found}, expected {expected}"),
        format!("Set {node} to {expected} with the camera's own program"),
    )
}

/// Returns the depth for every 16-bit value, and the metres per unit of these depths; 0 means no reading.
///
/// Without an offset the depths are the values themselves. With an offset some might exceed 16 bits, so the unit is chosen
/// such that the largest value just fits; the rounding error is at most half a unit. The value 0 never is a reading:
/// cameras without `Scan3dInvalidDataFlag` send it where they have none.
fn depth_table(axis: &Axis) -> Result<(Vec<u16>, f64), CameraError> {
    let largest = f64::from(u16::MAX);
    let metres_per_unit = axis.scale.max(0.0) + axis.offset / largest;
    let is_scale = axis.scale.abs() > 0.0 && axis.scale.is_finite();
    if !(is_scale && metres_per_unit > 0.0 && metres_per_unit.is_finite()) {
        return Err(wrong_setting(
            "Scan3dCoordinateScale",
            format_args!("{} m with an offset of {} m", axis.scale, axis.offset),
            "depths in front of the camera",
        ));
    }
    let depth = |value: u16| {
        let value = f64::from(value);
        let units = ((value * axis.scale + axis.offset) / metres_per_unit).round();
        let is_reading = value > 0.0 && !axis.is_invalid(value) && units >= 1.0 && units <= largest;
        if is_reading { units as u16 } else { 0 }
    };
    Ok(((0..=u16::MAX).map(depth).collect(), metres_per_unit))
}

impl Axis {
    fn is_invalid(&self, value: f64) -> bool {
        // Both numbers come from the camera; compare them in the narrower type, that of the pixels.
        self.invalid
            .is_some_and(|invalid| (invalid as f32).to_bits() == (value as f32).to_bits())
    }

    fn metres(&self, value: f32) -> f32 {
        (f64::from(value) * self.scale + self.offset) as f32
    }
}

impl Decoder {
    /// True if the file marks the camera as simulated.
    pub(super) fn is_simulated(&self) -> bool {
        matches!(self, Self::Depth { camera, .. } if camera.is_simulated)
    }

    /// Decodes an image in this format; the error describes what is wrong with it.
    pub(super) fn image(&self, part: Part<'_>) -> Result<Image, String> {
        match self {
            Self::Depth { camera, units, .. } => {
                let depth = pixels(part, |&pixel: &[u8; 2]| {
                    let value = usize::from(u16::from_le_bytes(pixel));
                    units.get(value).copied().unwrap_or(0)
                })?;
                let frame = camera.frame((part.width, part.height), depth)?;
                Ok(Image::Depth(frame))
            }
            Self::Points {
                axes, is_organised, ..
            } => {
                let points = pixels(part, |pixel: &[u8; 12]| point(pixel, axes))?;
                if !is_organised {
                    return Ok(Image::Cloud(PointCloud::from_points(points)));
                }
                Ok(Image::Cloud(PointCloud {
                    points,
                    grid: Some(Grid {
                        width: part.width,
                        height: part.height,
                    }),
                    ..PointCloud::default()
                }))
            }
        }
    }
}

/// Decodes pixels of N bytes each, row by row without the padding.
fn pixels<const N: usize, T>(
    part: Part<'_>,
    read: impl Fn(&[u8; N]) -> T,
) -> Result<Vec<T>, String> {
    let Part {
        width,
        height,
        row_padding,
        bytes,
    } = part;
    let row = width.saturating_mul(N);
    let stride = row.saturating_add(row_padding);
    let needed = stride
        .saturating_mul(height.saturating_sub(1))
        .saturating_add(row);
    if width == 0 || height == 0 || bytes.len() < needed {
        let num = bytes.len();
        return Err(format!("{num} bytes of {width}×{height} pixels"));
    }
    let rows = bytes.chunks(stride).take(height);
    let rows = rows.filter_map(|bytes| bytes.get(..row));
    Ok(rows
        .flat_map(|row| row.as_chunks::<N>().0)
        .map(read)
        .collect())
}

/// Decodes a point, in metres; three NaN if there is no reading.
fn point(pixel: &[u8; 12], axes: &[Axis; 3]) -> Point3<f32> {
    let &[a0, a1, a2, a3, b0, b1, b2, b3, c0, c1, c2, c3] = pixel;
    let values = [[a0, a1, a2, a3], [b0, b1, b2, b3], [c0, c1, c2, c3]].map(f32::from_le_bytes);
    let [a, b, c] = values;
    let [x_axis, y_axis, z_axis] = axes;
    let is_reading = values.iter().all(|value| value.is_finite())
        && values.iter().any(|value| value.abs() > 0.0)
        && !z_axis.is_invalid(f64::from(c));
    if is_reading {
        Point3::new(x_axis.metres(a), y_axis.metres(b), z_axis.metres(c))
    } else {
        Point3::new(f32::NAN, f32::NAN, f32::NAN)
    }
}

#[cfg(test)]
mod tests;
