//! Conversion from and to numpy arrays. Everything is copied, so later changes by the caller affect no result.

use nalgebra::Point3;
use numpy::{
    Element, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods as _, PyUntypedArray,
    PyUntypedArrayMethods as _, ndarray::IxDyn,
};
use partsight::{Grid, PointCloud, RigidTransform, geometry::rigid};
use pyo3::{prelude::*, types::PyAny};

use crate::error::refused;

/// How far the rotation of a given matrix may deviate from a true one; allows for numbers rounded to six digits.
const ROUNDING: f64 = 1e-5;

/// Converts anything that numpy accepts to an array that is contiguous in memory, row by row.
fn contiguous<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyUntypedArray>> {
    let py = given.py();
    let wanted = (given, py.None(), ["C_CONTIGUOUS", "ALIGNED"]);
    let array = py.import("numpy")?.call_method1("require", wanted)?;
    Ok(array.cast_into::<PyUntypedArray>()?)
}

/// Copies the elements, if they are of this type.
fn elements<T: Element + Copy>(array: &Bound<'_, PyUntypedArray>) -> Option<PyResult<Vec<T>>> {
    let array = array.cast::<PyArrayDyn<T>>().ok()?;
    let copied = || -> PyResult<Vec<T>> { Ok(array.try_readonly()?.as_slice()?.to_vec()) };
    Some(copied())
}

/// Copies the elements of an array of float32 or float64.
fn floats(array: &Bound<'_, PyUntypedArray>) -> Option<PyResult<Vec<f32>>> {
    elements::<f32>(array).or_else(|| {
        let doubles = elements::<f64>(array)?;
        Some(doubles.map(|doubles| doubles.iter().map(|x| *x as f32).collect()))
    })
}

fn wrong_type(what: &str, array: &Bound<'_, PyUntypedArray>, expected: &str) -> PyErr {
    let message = format!("the {what} are of type {}, not {expected}", array.dtype());
    refused(message, "Convert the array with astype")
}

fn wrong_shape(what: &str, array: &Bound<'_, PyUntypedArray>, expected: &str) -> PyErr {
    let message = format!(
        "the {what} have the shape {:?}, not {expected}",
        array.shape()
    );
    refused(
        message,
        "Reshape the array, or take the part of it that is meant",
    )
}

/// Reads points of the shape (N, 3), without those that are not finite, or (H, W, 3) as an organised cloud.
pub(crate) fn cloud_of(given: &Bound<'_, PyAny>) -> PyResult<PointCloud> {
    const SHAPE: &str = "(N, 3), or (H, W, 3) with rows and columns";
    let array = contiguous(given)?;
    let grid = match *array.shape() {
        [_, 3] => None,
        [height, width, 3] if height > 0 && width > 0 => Some(Grid { width, height }),
        _ => return Err(wrong_shape("points", &array, SHAPE)),
    };
    let numbers = floats(&array).ok_or_else(|| wrong_type("points", &array, "float"))??;
    let points = numbers
        .chunks_exact(3)
        .map(|p| Point3::new(p[0], p[1], p[2]));
    let is_finite = |p: &Point3<f32>| p.iter().all(|x| x.is_finite());
    Ok(match grid {
        None => PointCloud::from_points(points),
        Some(_) => PointCloud {
            points: points
                .map(|p| if is_finite(&p) { p } else { NO_POINT })
                .collect(),
            grid,
            ..PointCloud::default()
        },
    })
}

/// The point of a pixel without a reading.
pub(crate) const NO_POINT: Point3<f32> = Point3::new(f32::NAN, f32::NAN, f32::NAN);

/// Depths of the shape (H, W).
pub(crate) enum Depths {
    /// Whole units, as from a sensor; 0 is no reading.
    Units(Vec<u16>),
    /// Units with fractions.
    Floats(Vec<f32>),
}

/// Reads depths, and the size of their grid.
pub(crate) fn depths_of(given: &Bound<'_, PyAny>) -> PyResult<(Depths, Grid)> {
    let array = contiguous(given)?;
    let grid = match *array.shape() {
        [height, width] if height > 0 && width > 0 => Grid { width, height },
        _ => return Err(wrong_shape("depths", &array, "(H, W)")),
    };
    let depths = match elements::<u16>(&array) {
        Some(units) => Depths::Units(units?),
        None => Depths::Floats(
            floats(&array).ok_or_else(|| wrong_type("depths", &array, "uint16 or float"))??,
        ),
    };
    Ok((depths, grid))
}

/// Reads a rigid transform from a 4×4 matrix.
pub(crate) fn transform_of(given: &Bound<'_, PyAny>) -> PyResult<RigidTransform> {
    let array = contiguous(given)?;
    let wrong = || wrong_type("numbers of the transform", &array, "float64");
    let numbers = elements::<f64>(&array).ok_or_else(wrong)??;
    let numbers: Result<[f64; 16], _> = numbers.try_into();
    let ([4, 4], Ok(numbers)) = (array.shape(), numbers) else {
        return Err(wrong_shape("numbers of the transform", &array, "(4, 4)"));
    };
    rigid::from_row_major(&numbers, ROUNDING).ok_or_else(|| {
        refused(
            "the matrix is no rigid transform",
            "Give a rotation without scale or mirroring, a shift in metres, and 0 0 0 1 as the last row",
        )
    })
}

/// Converts a transform to a 4×4 matrix.
pub(crate) fn matrix_of<'py>(
    py: Python<'py>,
    transform: &RigidTransform,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_slice(py, &rigid::row_major(transform)).reshape([4, 4])
}

/// Converts the points of a cloud to an array of the shape (N, 3), or (H, W, 3) for an organised cloud.
pub(crate) fn points_of<'py>(
    py: Python<'py>,
    cloud: &PointCloud,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let numbers = cloud.points.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let mut shape = shape_of(cloud);
    shape.push(3);
    PyArray1::from_vec(py, numbers).reshape(IxDyn(&shape))
}

/// Shape of an array with one value per point.
pub(crate) fn shape_of(cloud: &PointCloud) -> Vec<usize> {
    cloud.grid.map_or_else(
        || vec![cloud.points.len()],
        |grid| vec![grid.height, grid.width],
    )
}
