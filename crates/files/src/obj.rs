//! OBJ: vertices and polygons as text.
//!
//! Source: Wavefront's *Advanced Visualizer Manual*, appendix B1. `v` and `f` of all objects and groups are read together, or
//! those of the object (`o`) that is asked for; polygons are split into triangles. An OBJ without faces is a cloud. Texture coordinates, normals,
//! materials, lines and curves are ignored.

use std::collections::HashMap;

use nalgebra::Point3;

use super::content::FileContent;
use super::error::FileError;
use super::named_meshes::NamedMesh;
use super::readings::tidy;
use super::source::Source;
use super::surface::{Triangulation, checked_mesh, point_of};
use geometry::cloud::PointCloud;

/// Returns true if the first line that is neither empty nor a comment begins with a keyword of the format.
pub(super) fn is_obj(source: Source<'_>) -> bool {
    const KEYWORDS: [&str; 12] = [
        "v", "vn", "vt", "vp", "f", "l", "o", "g", "s", "mtllib", "usemtl", "mg",
    ];
    let first = source
        .lines()
        .map(|(_, line)| line)
        .find(|line| !line.is_empty() && !line.starts_with('#'));
    first.is_some_and(|line| {
        let keyword = line.split_whitespace().next();
        keyword.is_some_and(|word| KEYWORDS.contains(&word))
    })
}

pub(super) fn read(source: Source<'_>, wanted: Option<&str>) -> Result<FileContent, FileError> {
    let Statements {
        points,
        mut triangles,
        objects,
        ..
    } = parse(source, wanted)?;
    if let Some(wanted) = wanted {
        if !objects.iter().any(|name| name == wanted) {
            return Err(FileError::NoSuchMesh {
                path: source.path.to_owned(),
                wanted: wanted.to_owned(),
                available: objects,
            });
        }
        let points = keep_used(&points, &mut triangles);
        return checked_mesh(source, points, triangles).map(FileContent::Mesh);
    }
    if triangles.is_empty() {
        tidy(
            PointCloud {
                points,
                ..PointCloud::default()
            },
            source,
        )
        .map(FileContent::Cloud)
    } else {
        checked_mesh(source, points, triangles).map(FileContent::Mesh)
    }
}

/// Reads every object for itself, in the file's order; none if fewer than two have a surface.
pub(super) fn read_each(source: Source<'_>) -> Result<Vec<NamedMesh>, FileError> {
    let begins_object = |line: &str| line.split_whitespace().next() == Some("o");
    let begun = source.lines().filter(|(_, line)| begins_object(line));
    if begun.count() < 2 {
        return Ok(Vec::new());
    }
    let Statements {
        points,
        triangles,
        objects,
        stretches,
    } = parse(source, None)?;
    let mut of_object: Vec<Vec<[u32; 3]>> = vec![Vec::new(); objects.len()];
    let begins = stretches.iter().skip(1).map(|(_, first)| *first);
    let ends = begins.chain([triangles.len()]);
    for ((object, first), end) in stretches.iter().zip(ends) {
        of_object[*object].extend_from_slice(&triangles[*first..end]);
    }
    let with_surface = of_object.iter().filter(|triangles| !triangles.is_empty());
    if with_surface.count() < 2 {
        return Ok(Vec::new());
    }
    let meshes = objects.into_iter().zip(of_object);
    let meshes = meshes.map(|(name, mut triangles)| {
        let points = keep_used(&points, &mut triangles);
        let mesh = checked_mesh(source, points, triangles);
        NamedMesh { name, mesh }
    });
    Ok(meshes.collect())
}

/// What the statements of a file say.
#[derive(Default)]
struct Statements {
    points: Vec<Point3<f32>>,
    /// Only those of the object that is asked for, if one is.
    triangles: Vec<[u32; 3]>,
    /// The names of the objects, each once.
    objects: Vec<String>,
    /// Object and first triangle of what follows each `o`.
    stretches: Vec<(usize, usize)>,
}

fn parse(source: Source<'_>, wanted: Option<&str>) -> Result<Statements, FileError> {
    let mut all = Statements::default();
    let Statements {
        points,
        triangles,
        objects,
        stretches,
    } = &mut all;
    let mut indices: HashMap<String, usize> = HashMap::new();
    let mut is_wanted = wanted.is_none();
    let mut triangulation = Triangulation::default();
    let mut statement = String::new();
    for (number, line) in source.lines() {
        // A backslash at the end continues a line on the next one.
        if let Some(begun) = line.strip_suffix('\\') {
            statement.push_str(begun);
            statement.push(' ');
            continue;
        }
        statement.push_str(&line);
        let mut words = statement.split_whitespace();
        match words.next() {
            Some("v") => {
                let point = point_of(words);
                points.push(
                    point.ok_or_else(|| {
                        source.malformed(number, &statement, "v and three numbers")
                    })?,
                );
                source.limited("points", points.len())?;
            }
            Some("f") => {
                let polygon: Option<Vec<u32>> =
                    words.map(|corner| index_of(corner, points.len())).collect();
                let polygon = polygon.filter(|polygon| polygon.len() >= 3);
                let polygon = polygon.ok_or_else(|| {
                    source.malformed(
                        number,
                        &statement,
                        "f and three vertices or more that come before it",
                    )
                })?;
                if is_wanted {
                    triangulation.push(source, &polygon, points, triangles)?;
                    source.limited("triangles", triangles.len())?;
                }
            }
            Some("o") => {
                let name = statement.trim_start().trim_start_matches('o').trim();
                is_wanted = wanted.is_none_or(|wanted| wanted == name);
                let next = objects.len();
                let index = *indices.entry(name.to_owned()).or_insert(next);
                if index == next {
                    objects.push(name.to_owned());
                }
                stretches.push((index, triangles.len()));
            }
            _ => {}
        }
        statement.clear();
    }
    Ok(all)
}

/// Returns the points that the triangles use, and renumbers the triangles.
fn keep_used(points: &[Point3<f32>], triangles: &mut [[u32; 3]]) -> Vec<Point3<f32>> {
    let mut indices: HashMap<u32, u32> = HashMap::new();
    let mut used = Vec::new();
    for corner in triangles.iter_mut().flatten() {
        *corner = *indices.entry(*corner).or_insert_with(|| {
            used.push(points[*corner as usize]);
            used.len() as u32 - 1
        });
    }
    used
}

/// Returns the vertex named by `7/1/2` or `-1//3`, from 0; `None` if there is no such vertex yet.
fn index_of(corner: &str, num_points: usize) -> Option<u32> {
    let number: i64 = corner.split('/').next()?.parse().ok()?;
    // Positive numbers count from 1, negative ones back from the latest vertex.
    let index = if number > 0 {
        number - 1
    } else {
        num_points as i64 + number
    };
    let is_known = number != 0 && (0..num_points as i64).contains(&index);
    is_known.then(|| u32::try_from(index).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn read_text(text: &str) -> Result<FileContent, FileError> {
        read_object(text, None)
    }

    fn read_object(text: &str, wanted: Option<&str>) -> Result<FileContent, FileError> {
        let source = Source {
            path: Path::new("test.obj"),
            bytes: text.as_bytes(),
        };
        assert!(is_obj(source), "{text:?} is not recognised");
        read(source, wanted)
    }

    #[test]
    fn one_object_is_read_alone_by_its_name() {
        let text = "o Left door\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no Hood\nv 9 0 0\nv 8 0 0\nv 9 1 0\n\
                    f 4 5 6\nf -3 -1 -2\n";
        for (wanted, num, x) in [("Left door", 1, 1.0), ("Hood", 2, 9.0)] {
            let FileContent::Mesh(mesh) = read_object(text, Some(wanted)).unwrap() else {
                panic!("expected a mesh");
            };
            assert_eq!((mesh.triangles.len(), mesh.vertices.len()), (num, 3));
            let most = mesh.bounds().expect("some").1.x;
            assert!((most - x).abs() < 1e-6, "{most}");
        }
        let error = read_object(text, Some("Door")).unwrap_err();
        let FileError::NoSuchMesh { available, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!(available[..], ["Left door", "Hood"]);
        let FileContent::Mesh(whole) = read_text(text).unwrap() else {
            panic!("expected a mesh");
        };
        assert_eq!(whole.triangles.len(), 3);
    }

    #[test]
    fn each_of_several_objects_is_read_as_by_its_name() {
        let each = |text: &str| {
            let source = Source {
                path: Path::new("test.obj"),
                bytes: text.as_bytes(),
            };
            read_each(source).unwrap()
        };
        // The second stretch of the door comes after the hood.
        let text = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\no Door\nf 1 2 3\no Hood\nf 1 2 4\no Door\nf 1 3 4\n\
                    o Axis\nl 1 2\n";
        let several = each(text);
        let names: Vec<&str> = several.iter().map(|named| named.name.as_str()).collect();
        assert_eq!(names, ["Door", "Hood", "Axis"]);
        for named in &several[..2] {
            let alone = read_object(text, Some(&named.name)).unwrap();
            assert_eq!(
                alone,
                FileContent::Mesh(named.mesh.as_ref().unwrap().clone())
            );
        }
        let counted: Vec<usize> = several.iter().map(NamedMesh::num_triangles).collect();
        assert_eq!(counted, [2, 1, 0]);
        assert!(matches!(
            several[2].mesh,
            Err(FileError::NoTriangles { .. })
        ));
        let one_part = text.replace("f 1 2 4", "l 1 4");
        assert!(each(&one_part).is_empty());
    }

    #[test]
    fn polygons_become_triangles_and_indices_count_from_either_end() {
        let text = "# a comment\nmtllib none.mtl\no square\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 0.5 0.5 0.5\nvn 0 0 1\n\
                    v 0 1 0\ns off\nusemtl paint\nf 1//1 2//1 \\\n 3//1 4//1\nf -4 -3 -2\n";
        let FileContent::Mesh(mesh) = read_text(text).unwrap() else {
            panic!("expected a mesh");
        };
        assert_eq!(mesh.vertices.len(), 4);
        assert_eq!((mesh.triangles.len(), mesh.triangles[2]), (3, [0, 1, 2]));
        let all = mesh.sample_evenly(300, 1).expect("an area");
        assert!((mesh.area() - 1.5).abs() < 1e-9);
        assert!(all.normals.expect("normals").iter().all(|n| n.z > 0.99));
    }

    #[test]
    fn without_faces_it_is_a_cloud() {
        let opened = read_text("v 0 1 0\nv 1 2 3\nv 0 0 0\nv nan 0 0\n").unwrap();
        let expected =
            PointCloud::from_points([Point3::new(0.0, 1.0, 0.0), Point3::new(1.0, 2.0, 3.0)]);
        assert_eq!(opened, FileContent::Cloud(expected));
    }

    #[test]
    fn vertices_that_do_not_exist_are_named_by_line() {
        for face in [
            "f 1 2 4",
            "f 0 1 2",
            "f -4 1 2",
            "f 1 2",
            "f 1 2 x",
            "f 1 2 99999999999999999999",
        ] {
            let error = read_text(&format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{face}\n")).unwrap_err();
            assert!(
                matches!(error, FileError::Malformed { line: 4, .. }),
                "{face}: {error}"
            );
        }
        assert!(matches!(
            read_text("v 0 0\n"),
            Err(FileError::Malformed { line: 1, .. })
        ));
    }
}
