//! Writing a PCD file.

use std::io::{self, Write};

use geometry::cloud::{Grid, PointCloud};

/// Writes a whole cloud as binary PCD 0.7: x y z and, where it has them, `normal_x/y/z`, `rgb` (as an unsigned number) and
/// `label`; the grid becomes WIDTH and HEIGHT.
///
/// A cloud without points is written with 0 points, and [`open`](crate::open()) refuses such a file.
pub fn write_pcd(writer: &mut dyn Write, cloud: &PointCloud) -> io::Result<()> {
    let PointCloud {
        points,
        normals,
        colours,
        labels,
        grid,
        is_simulated,
        surplus_bytes: _,
    } = cloud;
    let mut fields: Vec<(&str, &str)> = vec![("x", "F"), ("y", "F"), ("z", "F")];
    if normals.is_some() {
        fields.extend([("normal_x", "F"), ("normal_y", "F"), ("normal_z", "F")]);
    }
    if colours.is_some() {
        fields.push(("rgb", "U"));
    }
    if labels.is_some() {
        fields.push(("label", "U"));
    }
    let (names, types): (Vec<_>, Vec<_>) = fields.iter().copied().unzip();
    let each = |word: &str| vec![word; fields.len()].join(" ");
    let Grid { width, height } = grid.unwrap_or(Grid {
        width: points.len(),
        height: 1,
    });
    write!(
        writer,
        "# .PCD v0.7 - Point Cloud Data file format\n{}VERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\n\
         WIDTH {width}\nHEIGHT {height}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
        if *is_simulated { "# simulated\n" } else { "" },
        names.join(" "),
        each("4"),
        types.join(" "),
        each("1"),
        points.len(),
    )?;
    for (i, point) in points.iter().enumerate() {
        for coordinate in point.iter() {
            writer.write_all(&coordinate.to_le_bytes())?;
        }
        if let Some(normals) = normals {
            for coordinate in normals[i].iter() {
                writer.write_all(&coordinate.to_le_bytes())?;
            }
        }
        if let Some(colours) = colours {
            let [red, green, blue] = colours[i];
            writer.write_all(&[blue, green, red, 255])?;
        }
        if let Some(labels) = labels {
            writer.write_all(&labels[i].to_le_bytes())?;
        }
    }
    Ok(())
}
