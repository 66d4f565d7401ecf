//! XYZ and CSV text: one point per line, three numbers or more, in metres.
//!
//! There is no standard; this is what scanners, spreadsheets and `CloudCompare` write. Numbers are separated by spaces, tabs,
//! commas or semicolons; a file with semicolons may have decimal commas, as spreadsheets write them in much of Europe. Lines
//! that begin with `#` or `//` are comments. One line without coordinates may come first: names (`x`, `y` and `z` among them
//! select the columns) or the number of points. Further columns are ignored.

use std::io::{self, Write};

use nalgebra::Point3;

use super::cells::{MAX_COLUMNS, Row};
use super::error::FileError;
use super::readings::tidy;
use super::source::{ONE_COLUMN_EACH, Source};
use geometry::cloud::PointCloud;

/// Indices of the columns that hold x, y and z.
type Columns = [usize; 3];

/// Returns true if one of the first two lines with content is a point or names the columns.
pub(super) fn is_xyz(source: Source<'_>) -> bool {
    content(source).take(2).any(|(_, line)| {
        let row = Row::new(&line);
        point_of(row, [0, 1, 2]).is_some() || Heading::parse(row).is_some()
    })
}

pub(super) fn read(source: Source<'_>) -> Result<PointCloud, FileError> {
    let mut columns = [0, 1, 2];
    let mut points = Vec::new();
    for (i, (number, line)) in content(source).enumerate() {
        let row = Row::new(&line).limited(source, number)?;
        match point_of(row, columns) {
            Some(point) => points.push(point),
            None if i == 0 && is_heading(row) => match Heading::parse(row) {
                Some(Heading::Columns(named)) => columns = named,
                Some(Heading::Ambiguous) => {
                    return Err(source.malformed(number, &line, ONE_COLUMN_EACH));
                }
                None => {}
            },
            None => return Err(source.malformed(number, &line, "three numbers")),
        }
        source.limited("points", points.len())?;
    }
    tidy(
        PointCloud {
            points,
            is_simulated: source.says_simulated(),
            ..PointCloud::default()
        },
        source,
    )
}

/// Writes the finite points as text, one per line, in metres, with enough digits to restore the same numbers.
pub fn write_xyz(writer: &mut dyn Write, cloud: &PointCloud) -> io::Result<()> {
    if cloud.is_simulated {
        writeln!(writer, "# simulated")?;
    }
    for (_, p) in cloud.finite() {
        writeln!(writer, "{} {} {}", p.x, p.y, p.z)?;
    }
    Ok(())
}

/// Returns the lines that are neither empty nor comments.
fn content(source: Source<'_>) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, str>)> {
    source
        .lines()
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#') && !line.starts_with("//"))
}

fn point_of(row: Row<'_>, columns: Columns) -> Option<Point3<f32>> {
    let mut point = [None; 3];
    for (i, cell) in row.cells().enumerate() {
        for (coordinate, &column) in point.iter_mut().zip(&columns) {
            if column == i {
                *coordinate = Some(number_of(row, cell)?);
            }
        }
        if point.iter().all(Option::is_some) {
            break;
        }
    }
    let [x, y, z] = point;
    Some(Point3::new(x?, y?, z?))
}

fn number_of(row: Row<'_>, cell: &str) -> Option<f32> {
    // An empty cell of a spreadsheet means no reading.
    if cell.is_empty() {
        return Some(f32::NAN);
    }
    row.number(cell).map(|real| real as f32)
}

/// Returns true for names or the number of points. A first line that mixes numbers and names is a damaged point.
fn is_heading(row: Row<'_>) -> bool {
    let is_name = |cell: &str| number_of(row, cell).is_none();
    row.cells().all(is_name) || row.cells().count() == 1
}

/// What a line says about the columns.
enum Heading {
    Columns(Columns),
    /// Several columns are called x, y or z, and their case does not tell them apart.
    Ambiguous,
}

impl Heading {
    /// `None` if the line does not name x, y and z.
    fn parse(row: Row<'_>) -> Option<Self> {
        let names: Vec<&str> = row.cells().take(MAX_COLUMNS).map(column_name).collect();
        let column = |is: &dyn Fn(&str) -> bool| {
            let mut columns = (0..names.len()).filter(|i| is(names[*i]));
            (columns.next(), columns.next().is_none())
        };
        let columns = |wanted: [&str; 3], is_same: fn(&str, &str) -> bool| {
            let found = wanted.map(|wanted| column(&|name| is_same(name, wanted)));
            let [(x, is_x_once), (y, is_y_once), (z, is_z_once)] = found;
            Some(([x?, y?, z?], is_x_once && is_y_once && is_z_once))
        };
        let (any, is_once) = columns(["x", "y", "z"], str::eq_ignore_ascii_case)?;
        if is_once {
            return Some(Self::Columns(any));
        }
        // Pixels are often called x and y beside metres X, Y and Z.
        let by_case =
            [["x", "y", "z"], ["X", "Y", "Z"]].map(|wanted| columns(wanted, |a, b| a == b));
        Some(match by_case {
            [Some((columns, true)), None] | [None, Some((columns, true))] => Self::Columns(columns),
            _ => Self::Ambiguous,
        })
    }
}

/// Returns the name in a heading's cell: `"X [m]"` is X.
fn column_name(cell: &str) -> &str {
    let unquoted = cell.trim_matches(['"', '\'']).trim_start();
    let word = unquoted.split(|c: char| !c.is_alphanumeric()).next();
    word.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn read_text(text: &str) -> Result<PointCloud, FileError> {
        let source = Source {
            path: Path::new("test.xyz"),
            bytes: text.as_bytes(),
        };
        assert!(is_xyz(source), "{text:?} is not recognised");
        read(source)
    }

    #[test]
    fn pixels_beside_metres_are_told_apart_by_their_case_or_refused() {
        let expected = PointCloud::from_points([Point3::new(-1.0, 0.5, 1.8)]);
        for heading in ["x,y,depth,X,Y,Z", "X,Y,depth,x,y,z", "u,v,depth,x,Y,z"] {
            let read = read_text(&format!("{heading}\n3,4,1.8,-1.0,0.5,1.8\n"));
            assert_eq!(read.expect("a cloud"), expected, "{heading}");
        }
        for heading in ["x,y,z,X,Y,Z", "x,y,depth,x,y,z", "x,y,z,x,a,b"] {
            let read = read_text(&format!("{heading}\n3,4,1.8,-1.0,0.5,1.8\n"));
            let error = read.expect_err("ambiguous").to_string();
            assert!(error.contains("one column each"), "{heading}: {error}");
        }
    }

    #[test]
    fn every_separator_is_read() {
        let expected =
            PointCloud::from_points([Point3::new(1.5, -2.0, 3e-3), Point3::new(4.0, 5.0, 6.0)]);
        for text in [
            "1.5 -2 3e-3\n4 5 6\n",
            "1.5\t-2\t3e-3\r\n4\t5\t6",
            "1.5,-2,3e-3\n4, 5, 6\n",
            "1.5;-2;3e-3\n4;5;6\n",
            "1,5;-2,0;0,003\n4;5;6\n",
            "# made by a scanner\n\n  1.5   -2 3e-3 17 0.5 \n// more\n4 5 6 1 2\n",
            "2\n1.5 -2 3e-3\n4 5 6\n",
            "x,y,z\n1.5,-2,3e-3\n4,5,6\n",
            "\u{feff}time;\"Z [m]\";\"Y [m]\";\"X [m]\"\n9;0,003;-2;1,5\n9;6;5;4\n",
        ] {
            assert_eq!(read_text(text).unwrap(), expected, "{text:?}");
        }
    }

    #[test]
    fn points_without_a_reading_are_dropped() {
        let cloud = read_text("1,2,3\n,,\n4,nan,6\n7,inf,9\n1e30,0,0\n").unwrap();
        assert_eq!(cloud.points, [Point3::new(1.0, 2.0, 3.0)]);
        assert!(matches!(
            read_text("nan nan nan\n"),
            Err(FileError::NoPoints { found: 1, .. })
        ));
    }

    #[test]
    fn a_bad_line_is_named_by_its_number() {
        for (text, bad) in [
            ("1 2 3\n\n4 5\n", 3),
            ("x y z\n1 2 3\n# no\n1 two 3\n", 4),
            ("1 2 3\nx y z\n", 2),
            ("1 two 3\n1 2 3\n", 1),
        ] {
            let error = read_text(text).unwrap_err();
            assert!(
                matches!(error, FileError::Malformed { line, .. } if line == bad),
                "{error}"
            );
        }
    }

    #[test]
    fn what_is_written_reads_back_to_the_same_bits() {
        let cloud = PointCloud::from_points([
            Point3::new(0.1, -1.0e-7, 123_456.7),
            Point3::new(1.0 / 3.0, 0.0, 2.0),
        ]);
        let mut text = Vec::new();
        write_xyz(&mut text, &cloud).unwrap();
        assert_eq!(read_text(&String::from_utf8(text).unwrap()).unwrap(), cloud);
    }
}
