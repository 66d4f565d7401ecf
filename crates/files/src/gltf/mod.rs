//! glTF and GLB: one mesh of a scene, placed as in the scene.
//!
//! Source: Khronos, *glTF 2.0 Specification* (2021). The crate `gltf` parses and validates the document. This module splits
//! GLB, finds buffers and reads accessors itself: the crate's own reader computes and slices with unchecked numbers from the
//! file, panics on hostile ones, and loads every picture and buffer of the file.
//!
//! glTF is in metres with y up; the coordinates are kept as they are. A mesh is selected by the name of a node that places
//! it, else by its own name; all meshes of that name are joined. Positions and indices are read, and the transforms of the
//! node and of its ancestors applied. A mirroring transform reverses the order of the triangles' vertices, so that they
//! still face outwards.
//!
//! Limits: compressed geometry is refused; skins and morph targets are ignored.

mod buffers;

use std::collections::{HashMap, HashSet};

use ::gltf::json::Root;
use ::gltf::mesh::Mode;
use ::gltf::{Document, Mesh, Node, Primitive, Semantic};
use nalgebra::{Matrix4, Point3};

use super::error::FileError;
use super::named_meshes::NamedMesh;
use super::source::Source;
use super::surface::{checked_mesh, push_fan};
use geometry::mesh::TriangleMesh;

use self::buffers::Buffers;

/// Returns true for the four bytes that begin a GLB.
pub(super) fn is_glb(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF")
}

/// Returns true for a JSON object with the word "asset", a key that every glTF has.
pub(super) fn is_json(bytes: &[u8]) -> bool {
    let text = bytes
        .strip_prefix(b"\xef\xbb\xbf")
        .unwrap_or(bytes)
        .trim_ascii_start();
    text.starts_with(b"{") && text.windows(7).any(|window| window == b"\"asset\"")
}

pub(super) fn read(source: Source<'_>, wanted: Option<&str>) -> Result<TriangleMesh, FileError> {
    let (document, blob) = document_of(source)?;
    let placed = placed_meshes(source, &document)?;
    let chosen = choose(source, placed, wanted)?;
    joined(source, &mut buffers_of(source, &document, blob), &chosen)
}

/// Reads every mesh for itself, in the file's order; none if the file is opened without a name.
pub(super) fn read_each(source: Source<'_>) -> Result<Vec<NamedMesh>, FileError> {
    let (document, blob) = document_of(source)?;
    let placed = placed_meshes(source, &document)?;
    if placed.len() < 2 {
        return Ok(Vec::new());
    }
    let mut indices = HashMap::new();
    let mut named: Vec<(String, Vec<PlacedMesh<'_>>)> = Vec::new();
    for mesh in placed {
        let next = named.len();
        let index = *indices.entry(mesh.name.clone()).or_insert(next);
        if index == next {
            named.push((mesh.name.clone(), Vec::new()));
        }
        named[index].1.push(mesh);
    }
    let mut buffers = buffers_of(source, &document, blob);
    let mut num_read = 0;
    let mut meshes = Vec::with_capacity(named.len());
    for (name, placed) in named {
        let mesh = joined(source, &mut buffers, &placed);
        if let Ok(mesh) = &mesh {
            num_read += mesh.vertices.len() + mesh.triangles.len();
            source.affordable(num_read, size_of::<[u32; 3]>())?;
        }
        meshes.push(NamedMesh { name, mesh });
    }
    Ok(meshes)
}

/// Returns the document, and the binary chunk of a GLB.
fn document_of(source: Source<'_>) -> Result<(Document, Option<&[u8]>), FileError> {
    let (json, blob) = if is_glb(source.bytes) {
        split_glb(source)?
    } else {
        (source.bytes, None)
    };
    Ok((parse(source, json)?, blob))
}

fn buffers_of<'a>(source: Source<'a>, document: &Document, blob: Option<&'a [u8]>) -> Buffers<'a> {
    let mut extensions = document.extensions_used();
    let is_quantised = extensions.any(|name| name == "KHR_mesh_quantization");
    Buffers::new(source, blob, is_quantised)
}

/// Reads these meshes as one.
fn joined(
    source: Source<'_>,
    buffers: &mut Buffers<'_>,
    chosen: &[PlacedMesh<'_>],
) -> Result<TriangleMesh, FileError> {
    let mut whole = TriangleMesh::default();
    for PlacedMesh {
        mesh,
        scene_from_mesh,
        ..
    } in chosen
    {
        for primitive in mesh.primitives() {
            let Some(part) = read_primitive(source, buffers, &primitive, scene_from_mesh)? else {
                continue;
            };
            let num_vertices = whole.vertices.len() + part.vertices.len();
            let num_triangles = whole.triangles.len() + part.triangles.len();
            source.limited("points", num_vertices)?;
            source.limited("triangles", num_triangles)?;
            source.affordable(num_vertices + num_triangles, size_of::<[u32; 3]>())?;
            whole.append(&part);
        }
    }
    checked_mesh(source, whole.vertices, whole.triangles)
}

/// Returns the JSON of a GLB and its binary chunk, if it has one.
fn split_glb(source: Source<'_>) -> Result<(&[u8], Option<&[u8]>), FileError> {
    match word_at(source.bytes, 4) {
        Some(2) => {}
        Some(version) => {
            return Err(source.unsupported(format!("GLB version {version}"), "glTF 2.0"));
        }
        None => return Err(source.truncated("GLB header", source.bytes.len(), 12)),
    }
    let (kind, json, rest) = split_chunk(source, source.bytes.get(12..).unwrap_or_default())?;
    if kind.to_le_bytes() != *b"JSON" {
        return Err(source.bad_header(format!("a first chunk of kind {kind:08x}"), "a JSON chunk"));
    }
    if rest.is_empty() {
        return Ok((json, None));
    }
    let (kind, blob, _) = split_chunk(source, rest)?;
    Ok((json, (kind.to_le_bytes() == *b"BIN\0").then_some(blob)))
}

/// Splits off the chunk at the start of `bytes`; returns its kind, its content and the remaining bytes.
fn split_chunk<'a>(
    source: Source<'_>,
    bytes: &'a [u8],
) -> Result<(u32, &'a [u8], &'a [u8]), FileError> {
    let (Some(length), Some(kind)) = (word_at(bytes, 0), word_at(bytes, 4)) else {
        return Err(source.truncated("GLB chunk header", bytes.len(), 8));
    };
    let content = bytes.get(8..).unwrap_or_default();
    match content.split_at_checked(length as usize) {
        Some((content, rest)) => Ok((kind, content, rest)),
        None => Err(source.truncated("GLB chunk", content.len(), length as usize)),
    }
}

fn word_at(bytes: &[u8], at: usize) -> Option<u32> {
    let word = bytes.get(at..).and_then(<[u8]>::first_chunk);
    word.map(|word| u32::from_le_bytes(*word))
}

/// Estimated memory per object of the document, in bytes: even "{}" in a list of nodes takes this much.
const OBJECT_BYTES: usize = 1000;

fn parse(source: Source<'_>, json: &[u8]) -> Result<Document, FileError> {
    /// Extensions that change how positions or indices are stored.
    const GEOMETRY_EXTENSIONS: [&str; 3] = [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "KHR_meshopt_compression",
    ];
    let text = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    let num_objects = text.split(|byte| *byte == b'{').count();
    source.affordable(num_objects, OBJECT_BYTES)?;
    let mut root = Root::from_slice(text).map_err(|error| {
        if error.is_eof() {
            source.cut_before("the end of the JSON", "JSON")
        } else {
            source.damaged(format!("its JSON: {error}"))
        }
    })?;
    let mut required = root.extensions_required.iter();
    if let Some(name) = required.find(|name| GEOMETRY_EXTENSIONS.contains(&name.as_str())) {
        return Err(source.unsupported(
            format!("geometry stored by {name}"),
            "glTF without mesh compression",
        ));
    }
    // Other required extensions concern materials, lights and motion, which are not read.
    root.extensions_required.clear();
    // The crate's validation looks these indices up before it checks them.
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut attributes = primitives.flat_map(|primitive| primitive.attributes.values());
    if attributes.any(|index| index.value() >= root.accessors.len()) {
        return Err(source.damaged("a mesh of numbers that are not there"));
    }
    Document::from_json(root).map_err(|error| source.damaged(error.to_string()))
}

/// A mesh with the transform of the node that places it.
struct PlacedMesh<'a> {
    /// The node's name, else the mesh's, else `mesh_` and its index.
    name: String,
    mesh: Mesh<'a>,
    scene_from_mesh: Matrix4<f64>,
}

/// Returns every mesh of the scene in the file's order. A file without scenes counts as one scene of all its nodes; without
/// placed meshes, all meshes are taken untransformed.
fn placed_meshes<'a>(
    source: Source<'_>,
    document: &'a Document,
) -> Result<Vec<PlacedMesh<'a>>, FileError> {
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    let roots: Vec<_> = if let Some(scene) = scene {
        scene.nodes().collect()
    } else {
        let nodes = document.nodes();
        let children: HashSet<usize> = nodes
            .flat_map(|node| node.children().map(|child| child.index()))
            .collect();
        let is_root = |node: &Node<'_>| !children.contains(&node.index());
        document.nodes().filter(is_root).collect()
    };
    let mut placed = Vec::new();
    let mut seen = HashSet::new();
    let mut open: Vec<_> = roots
        .into_iter()
        .map(|node| (node, Matrix4::identity()))
        .collect();
    open.reverse();
    while let Some((node, scene_from_parent)) = open.pop() {
        // The specification demands trees; anything else could loop for ever.
        if !seen.insert(node.index()) {
            return Err(source.damaged(format!("node {} is placed twice", node.index())));
        }
        let columns = node.transform().matrix();
        let parent_from_node =
            Matrix4::from_columns(&columns.map(|column| column.map(f64::from).into()));
        let scene_from_mesh = scene_from_parent * parent_from_node;
        if let Some(mesh) = node.mesh() {
            let name = node.name().map_or_else(|| mesh_name(&mesh), str::to_owned);
            placed.push(PlacedMesh {
                name,
                mesh,
                scene_from_mesh,
            });
        }
        let children: Vec<_> = node.children().collect();
        open.extend(
            children
                .into_iter()
                .rev()
                .map(|child| (child, scene_from_mesh)),
        );
    }
    if placed.is_empty() {
        let lone = document.meshes().map(|mesh| PlacedMesh {
            name: mesh_name(&mesh),
            mesh,
            scene_from_mesh: Matrix4::identity(),
        });
        placed.extend(lone);
    }
    placed.sort_by_key(|placed| placed.mesh.index());
    Ok(placed)
}

fn mesh_name(mesh: &Mesh<'_>) -> String {
    mesh.name()
        .map_or_else(|| format!("mesh_{}", mesh.index()), str::to_owned)
}

fn choose<'a>(
    source: Source<'_>,
    placed: Vec<PlacedMesh<'a>>,
    wanted: Option<&str>,
) -> Result<Vec<PlacedMesh<'a>>, FileError> {
    let mut listed = HashSet::new();
    let names = placed.iter().map(|placed| placed.name.clone());
    let available: Vec<String> = names.filter(|name| listed.insert(name.clone())).collect();
    let path = source.path.to_owned();
    let Some(wanted) = wanted else {
        return match placed.len() {
            0 => Err(FileError::NoTriangles { path }),
            1 => Ok(placed),
            _ => Err(FileError::NeedsMeshName { path, available }),
        };
    };
    let (by_node, others): (Vec<_>, Vec<_>) =
        placed.into_iter().partition(|placed| placed.name == wanted);
    let chosen = if by_node.is_empty() {
        others
            .into_iter()
            .filter(|placed| mesh_name(&placed.mesh) == wanted)
            .collect()
    } else {
        by_node
    };
    if chosen.is_empty() {
        let wanted = wanted.to_owned();
        return Err(FileError::NoSuchMesh {
            path,
            wanted,
            available,
        });
    }
    Ok(chosen)
}

/// Returns the triangles of a primitive in scene space; `None` for points and lines.
fn read_primitive(
    source: Source<'_>,
    buffers: &mut Buffers<'_>,
    primitive: &Primitive<'_>,
    scene_from_mesh: &Matrix4<f64>,
) -> Result<Option<TriangleMesh>, FileError> {
    let mode = primitive.mode();
    if !matches!(
        mode,
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
    ) {
        return Ok(None);
    }
    let positions = primitive.get(&Semantic::Positions);
    let positions = positions.ok_or_else(|| source.damaged("a mesh without positions"))?;
    let vertices: Vec<_> = buffers
        .positions(&positions)?
        .into_iter()
        .map(|p| {
            scene_from_mesh
                .transform_point(&Point3::from(p).cast::<f64>())
                .cast::<f32>()
        })
        .collect();
    let indices = match primitive.indices() {
        Some(indices) => buffers.indices(&indices)?,
        None => (0..vertices.len() as u32).collect(),
    };
    if let Some(beyond) = indices
        .iter()
        .find(|&&index| index as usize >= vertices.len())
    {
        return Err(source.damaged(format!("vertex {beyond} of {}", vertices.len())));
    }
    let mut triangles = triangles_of(mode, &indices);
    if scene_from_mesh.fixed_view::<3, 3>(0, 0).determinant() < 0.0 {
        for [_, second, third] in &mut triangles {
            std::mem::swap(second, third);
        }
    }
    Ok(Some(TriangleMesh {
        vertices,
        triangles,
    }))
}

fn triangles_of(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    let three = |window: &[u32]| window.first_chunk::<3>().copied();
    match mode {
        Mode::TriangleStrip => indices
            .windows(3)
            .filter_map(three)
            .enumerate()
            // Every other triangle of a strip has the opposite winding.
            .map(|(i, [a, b, c])| if i % 2 == 0 { [a, b, c] } else { [b, a, c] })
            .collect(),
        Mode::TriangleFan => {
            let mut triangles = Vec::new();
            push_fan(indices, &mut triangles);
            triangles
        }
        _ => indices.chunks_exact(3).filter_map(three).collect(),
    }
}

#[cfg(test)]
pub(super) mod tests;
