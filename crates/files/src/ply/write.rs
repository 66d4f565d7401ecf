//! Writing a PLY file.

use std::io::{self, Write};

use geometry::cloud::PointCloud;

/// Writes a cloud as binary little-endian PLY: x y z and, where it has them, `nx ny nz`, `red green blue` and `label`.
///
/// PLY has no grid: cells without a reading are left out, and the cloud is unorganised when read again.
pub fn write_ply(writer: &mut dyn Write, cloud: &PointCloud) -> io::Result<()> {
    write_ply_with(writer, cloud, &[])
}

/// A whole number for each point of a cloud, by its index, under a name.
pub type PointProperty<'a> = (&'a str, &'a dyn Fn(usize) -> u32);

/// Like [`write_ply`], with further named whole numbers per point, which other programs may show.
pub fn write_ply_with(
    writer: &mut dyn Write,
    cloud: &PointCloud,
    properties: &[PointProperty<'_>],
) -> io::Result<()> {
    write!(
        writer,
        "ply\nformat binary_little_endian 1.0\ncomment metres\n{}element vertex {}\n\
         property float x\nproperty float y\nproperty float z\n",
        if cloud.is_simulated {
            "comment simulated\n"
        } else {
            ""
        },
        cloud.num_finite()
    )?;
    if cloud.normals.is_some() {
        writer.write_all(b"property float nx\nproperty float ny\nproperty float nz\n")?;
    }
    if cloud.colours.is_some() {
        writer.write_all(b"property uchar red\nproperty uchar green\nproperty uchar blue\n")?;
    }
    if cloud.labels.is_some() {
        writer.write_all(b"property uint label\n")?;
    }
    for (name, _) in properties {
        writeln!(writer, "property uint {name}")?;
    }
    writer.write_all(b"end_header\n")?;
    for (i, point) in cloud.finite() {
        for coordinate in point.iter() {
            writer.write_all(&coordinate.to_le_bytes())?;
        }
        if let Some(normals) = &cloud.normals {
            for coordinate in normals[i].iter() {
                writer.write_all(&coordinate.to_le_bytes())?;
            }
        }
        if let Some(colours) = &cloud.colours {
            writer.write_all(&colours[i])?;
        }
        if let Some(labels) = &cloud.labels {
            writer.write_all(&labels[i].to_le_bytes())?;
        }
        for (_, value_at) in properties {
            writer.write_all(&value_at(i).to_le_bytes())?;
        }
    }
    Ok(())
}
