//! Every shader is parsed and validated without a GPU, and its structs compared in size with those of Rust.

use naga::valid::{Capabilities, ValidationFlags, Validator};

use super::{composite, eye_dome, lines, points, uniform::ViewUniform};

fn parse(name: &str, source: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
    module
}

fn uniform_size(module: &naga::Module, name: &str) -> u32 {
    let variable = module
        .global_variables
        .iter()
        .find(|(_, variable)| variable.name.as_deref() == Some(name));
    let (_, variable) = variable.expect("a uniform of that name");
    module.types[variable.ty].inner.size(module.to_ctx())
}

#[test]
fn every_shader_is_valid_and_has_both_stages() {
    let all = [
        ("points", points::SHADER),
        ("lines", lines::SHADER),
        ("eye_dome", eye_dome::SHADER),
        ("composite", composite::SHADER),
    ];
    for (name, source) in all {
        let module = parse(name, source);
        let stages: Vec<&str> = module
            .entry_points
            .iter()
            .map(|entry| entry.name.as_str())
            .collect();
        assert_eq!(stages, ["vertex_main", "fragment_main"], "{name}");
    }
}

#[test]
fn uniforms_have_the_size_that_rust_writes() {
    let points = parse("points", points::SHADER);
    assert_eq!(
        uniform_size(&points, "view") as usize,
        size_of::<ViewUniform>()
    );
    assert_eq!(
        uniform_size(&points, "points") as usize,
        size_of::<points::PointsUniform>()
    );
    let lines = parse("lines", lines::SHADER);
    assert_eq!(
        uniform_size(&lines, "lines") as usize,
        size_of::<lines::LinesUniform>()
    );
    let composite = parse("composite", composite::SHADER);
    assert_eq!(
        uniform_size(&composite, "placement") as usize,
        composite::PLACEMENT_SIZE
    );
}
