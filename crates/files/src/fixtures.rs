//! What tests of this crate and of those above it build.

use std::fmt::Write as _;

use geometry::mesh::TriangleMesh;

/// Returns an OBJ with these objects.
pub fn obj_of(objects: &[(&str, &TriangleMesh)]) -> String {
    let mut text = String::new();
    let mut num_before = 1;
    for (name, mesh) in objects {
        writeln!(text, "o {name}").expect("written");
        for vertex in &mesh.vertices {
            writeln!(text, "v {} {} {}", vertex.x, vertex.y, vertex.z).expect("written");
        }
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|corner| corner + num_before);
            writeln!(text, "f {a} {b} {c}").expect("written");
        }
        num_before += mesh.vertices.len() as u32;
    }
    text
}

/// Returns the fields below this heading of a CSV table without line breaks in its fields.
pub fn csv_column(table: &str, heading: &str) -> Vec<String> {
    let mut rows = table.lines().map(csv_fields);
    let headings = rows.next().expect("a heading");
    let index = headings.iter().position(|name| name == heading);
    let index = index.unwrap_or_else(|| panic!("no {heading} among {headings:?}"));
    rows.map(|mut fields| fields.swap_remove(index)).collect()
}

/// Splits a line at the commas outside of quotation marks.
fn csv_fields(line: &str) -> Vec<String> {
    let pieces: Vec<&str> = line.split('"').collect();
    let (mut fields, mut field) = (Vec::new(), String::new());
    for (index, piece) in pieces.iter().enumerate() {
        if index % 2 == 1 {
            // Within quotation marks.
            field.push_str(piece);
        } else if piece.is_empty() && index > 0 && index + 1 < pieces.len() {
            // Two quotation marks within a field stand for one.
            field.push('"');
        } else {
            for (number, text) in piece.split(',').enumerate() {
                if number > 0 {
                    fields.push(std::mem::take(&mut field));
                }
                field.push_str(text);
            }
        }
    }
    fields.push(field);
    fields
}
