use std::fs;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::*;
use crate::{FileContent, open};
use geometry::error::Advice as _;

/// Three corners and the indices 0 1 2 as bytes, both at odd strides and offsets.
fn triangle_bytes() -> Vec<u8> {
    let mut bytes = vec![0; 4];
    for corner in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]] {
        bytes.extend(corner.iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0xEE; 4]);
    }
    bytes.truncate(bytes.len() - 4);
    bytes.extend([0, 0, 1, 0, 2, 0]);
    bytes
}

/// Two nodes place one triangle each: `Left` a quarter turn about z and 10 m along x, `Right` mirrored by its scale.
fn document(buffer: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],
        "nodes":[{{"translation":[10,0,0],"children":[2]}},{{"name":"Right","mesh":1,"scale":[-1,1,1]}},
                 {{"name":"Left","mesh":0,"rotation":[0,0,0.70710678,0.70710678]}}],
        "meshes":[{{"name":"Panel","primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}},
                  {{"primitives":[{{"attributes":{{"POSITION":0}}}},{{"attributes":{{"POSITION":0}},"mode":1}}]}}],
        "accessors":[{{"bufferView":0,"byteOffset":4,"componentType":5126,"count":3,"type":"VEC3",
                       "min":[0,0,0],"max":[1,2,0]}},
                     {{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":48,"byteStride":16}},
                       {{"buffer":0,"byteOffset":48,"byteLength":6}}],
        "buffers":[{{"byteLength":54{buffer}}}]}}"#
    )
}

pub(crate) fn embedded() -> String {
    let data = STANDARD.encode(triangle_bytes());
    document(&format!(
        r#","uri":"data:application/octet-stream;base64,{data}""#
    ))
}

pub(crate) fn glb() -> Vec<u8> {
    let mut json = document("").into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut blob = triangle_bytes();
    blob.resize(blob.len().next_multiple_of(4), 0);
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + blob.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", blob)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

fn read_bytes(bytes: &[u8], wanted: Option<&str>) -> Result<TriangleMesh, FileError> {
    read(
        Source {
            path: Path::new("test.gltf"),
            bytes,
        },
        wanted,
    )
}

fn is_near(mesh: &TriangleMesh, corners: [[f32; 3]; 3]) -> bool {
    let mut pairs = mesh.vertices.iter().zip(corners);
    mesh.vertices.len() == 3
        && pairs.all(|(vertex, corner)| (vertex - Point3::from(corner)).norm() < 1e-5)
}

#[test]
fn a_mesh_is_placed_by_all_the_nodes_above_it() {
    for bytes in [embedded().into_bytes(), glb()] {
        let left = read_bytes(&bytes, Some("Left")).unwrap();
        assert!(
            is_near(&left, [[10.0, 0.0, 0.0], [10.0, 1.0, 0.0], [8.0, 0.0, 0.0]]),
            "{left:?}"
        );
        assert_eq!(left.triangles, [[0, 1, 2]]);
        // The mesh's own name applies where no node has the name.
        assert_eq!(read_bytes(&bytes, Some("Panel")).unwrap(), left);
    }
}

#[test]
fn a_mirrored_mesh_still_faces_outwards_and_lines_are_no_surface() {
    let right = read_bytes(&glb(), Some("Right")).unwrap();
    assert!(is_near(
        &right,
        [[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 2.0, 0.0]]
    ));
    assert_eq!(right.triangles, [[0, 2, 1]]);
    let normals = right.sample_evenly(1, 0).unwrap().normals.unwrap();
    assert!(normals[0].z > 0.999);
}

#[test]
fn without_a_name_or_with_a_wrong_one_the_names_are_listed() {
    let error = read_bytes(&glb(), None).unwrap_err();
    assert!(
        matches!(&error, FileError::NeedsMeshName { available, .. } if *available == ["Left", "Right"])
    );
    assert!(error.advice().contains("test.gltf#Left"));
    let error = read_bytes(&glb(), Some("right_door")).unwrap_err();
    assert!(
        matches!(&error, FileError::NoSuchMesh { available, .. } if *available == ["Left", "Right"])
    );
    assert!(error.to_string().contains("Right, Left"), "{error}");
    assert!(error.advice().starts_with("Did you mean test.gltf#Right?"));
    // A single mesh needs no name.
    let lone = embedded().replace("[0,1]", "[1]");
    assert_eq!(
        read_bytes(lone.as_bytes(), None).unwrap().triangles.len(),
        1
    );
}

#[test]
fn each_of_several_meshes_is_read_as_by_its_name() {
    let each = |text: &str| {
        let source = Source {
            path: Path::new("test.gltf"),
            bytes: text.as_bytes(),
        };
        read_each(source).unwrap()
    };
    let several = each(&embedded());
    let names: Vec<&str> = several.iter().map(|named| named.name.as_str()).collect();
    assert_eq!(names, ["Left", "Right"]);
    for named in &several {
        let alone = read_bytes(embedded().as_bytes(), Some(&named.name)).unwrap();
        assert_eq!(*named.mesh.as_ref().unwrap(), alone, "{}", named.name);
    }
    // Meshes of one name are one.
    let twins = each(&embedded().replace("\"Right\"", "\"Left\""));
    assert_eq!((twins.len(), twins[0].num_triangles()), (1, 2));
    // One without a surface does not keep the others from being read.
    let bare = each(&embedded().replace(r#""indices":1}"#, r#""indices":1,"mode":1}"#));
    assert!(matches!(bare[0].mesh, Err(FileError::NoTriangles { .. })));
    assert_eq!((bare[0].size(), bare[0].num_triangles()), (None, 0));
    assert_eq!(bare[1].num_triangles(), 1);
    assert!(each(&embedded().replace("[0,1]", "[1]")).is_empty());
}

#[test]
fn a_buffer_beside_the_file_is_found_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).unwrap();
    let path = inner.join("car.gltf");
    let named = path.with_file_name("car.gltf#Left");
    fs::write(&path, document(r#","uri":"my%20car.bin""#)).unwrap();
    assert!(
        matches!(open(&named), Err(FileError::NotFound { path }) if path.ends_with("my car.bin"))
    );
    fs::write(inner.join("my car.bin"), triangle_bytes()).unwrap();
    assert!(matches!(open(&named), Ok(FileContent::Mesh(_))));
    fs::write(inner.join("my car.bin"), &triangle_bytes()[..53]).unwrap();
    assert!(matches!(open(&named), Err(FileError::Truncated { .. })));

    fs::write(folder.path().join("outside.bin"), triangle_bytes()).unwrap();
    let absolute = folder.path().join("outside.bin");
    for uri in [
        "../outside.bin",
        "http://localhost/outside.bin",
        absolute.to_str().unwrap(),
    ] {
        fs::write(&path, document(&format!(r#","uri":"{uri}""#))).unwrap();
        assert!(
            matches!(open(&named), Err(FileError::Unsupported { .. })),
            "{uri}"
        );
    }
}

#[test]
fn a_file_cut_anywhere_is_an_error_and_never_a_panic() {
    for bytes in [embedded().into_bytes(), glb()] {
        for length in 0..bytes.len() - 2 {
            assert!(
                read_bytes(&bytes[..length], Some("Left")).is_err(),
                "{length}"
            );
        }
    }
}

#[test]
fn numbers_that_reach_beyond_the_buffers_are_refused() {
    let good = embedded();
    for (from, to) in [
        (
            r#""count":3,"type":"VEC3""#,
            r#""count":4000000000,"type":"VEC3""#,
        ),
        (
            r#""count":3,"type":"VEC3""#,
            r#""count":40000000,"type":"VEC3""#,
        ),
        (r#""count":3,"type":"VEC3""#, r#""count":4,"type":"VEC3""#),
        (r#""count":3,"type":"VEC3""#, r#""count":2,"type":"VEC3""#),
        (r#""byteOffset":4"#, r#""byteOffset":18446744073709551615"#),
        (r#""byteOffset":4,"#, r#""byteOffset":8,"#),
        (r#""byteOffset":48"#, r#""byteOffset":18446744073709551615"#),
        (r#""byteStride":16"#, r#""byteStride":8"#),
        (r#""byteStride":16"#, r#""byteStride":0"#),
        (r#""byteLength":48"#, r#""byteLength":4000000000"#),
        (r#""byteLength":54"#, r#""byteLength":18446744073709551615"#),
        (r#""componentType":5126"#, r#""componentType":5123"#),
        (r#""componentType":5123"#, r#""componentType":5126"#),
        (r#""componentType":5123"#, r#""componentType":5125"#),
        (r#""type":"SCALAR""#, r#""type":"VEC2""#),
        (r#""bufferView":1"#, r#""bufferView":7"#),
        (r#""children":[2]"#, r#""children":[0]"#),
        (r#""children":[2]"#, r#""children":[2,2]"#),
        (r#""children":[2]"#, r#""children":[9]"#),
        (r#""rotation":[0"#, r#""rotation":[1e38"#),
        (r#""POSITION":0"#, r#""NORMAL":0"#),
        (r#""POSITION":0"#, r#""POSITION":7"#),
        (
            r#","scene":0"#,
            r#","extensionsRequired":["KHR_draco_mesh_compression"],"scene":0"#,
        ),
        ("base64,AAAA", "base64,A*AA"),
    ] {
        let bad = good.replacen(from, to, 1);
        assert_ne!(bad, good, "{from}");
        assert!(read_bytes(bad.as_bytes(), Some("Left")).is_err(), "{to}");
    }
    // Extensions for materials do not concern the shape.
    let paint = good.replacen(
        r#","scene":0"#,
        r#","extensionsRequired":["KHR_texture_transform"],"scene":0"#,
        1,
    );
    assert!(read_bytes(paint.as_bytes(), Some("Left")).is_ok());
}

#[test]
fn strips_and_fans_are_cut_into_triangles_that_face_one_way() {
    assert_eq!(
        triangles_of(Mode::TriangleStrip, &[0, 1, 2, 3]),
        [[0, 1, 2], [2, 1, 3]]
    );
    assert_eq!(
        triangles_of(Mode::TriangleFan, &[0, 1, 2, 3]),
        [[0, 1, 2], [0, 2, 3]]
    );
    assert_eq!(triangles_of(Mode::Triangles, &[0, 1, 2, 3]), [[0, 1, 2]]);
    assert_eq!(triangles_of(Mode::TriangleFan, &[]), [[0; 3]; 0]);
}

#[test]
fn a_document_of_nothing_but_braces_takes_no_memory() {
    let nodes = "{},".repeat(1_200_000);
    let text = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{nodes}{{}}]}}");
    let error = read_bytes(text.as_bytes(), None).unwrap_err();
    assert!(matches!(error, FileError::TooLarge { .. }), "{error}");
}
