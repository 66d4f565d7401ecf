//! Parses and validates every shader without a GPU, and compares the sizes of its structs with those in Rust.

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

/// `Some(true)` if a value depends on a uniform, `Some(false)` if it is constant, `None` if it varies between vertices or
/// pixels.
fn is_of_uniforms(
    module: &naga::Module,
    function: &naga::Function,
    value: naga::Handle<naga::Expression>,
) -> Option<bool> {
    use naga::Expression as E;
    let of = |value| is_of_uniforms(module, function, value);
    // `None` if any of the values varies.
    let all = |values: &[naga::Handle<naga::Expression>]| {
        values
            .iter()
            .try_fold(false, |any, &value| Some(of(value)? || any))
    };
    match &function.expressions[value] {
        E::Literal(_) | E::Constant(_) | E::Override(_) | E::ZeroValue(_) => Some(false),
        E::GlobalVariable(global) => {
            let space = module.global_variables[*global].space;
            (space == naga::AddressSpace::Uniform).then_some(true)
        }
        E::Load { pointer: value }
        | E::AccessIndex { base: value, .. }
        | E::Splat { value, .. }
        | E::Swizzle { vector: value, .. }
        | E::Unary { expr: value, .. }
        | E::As { expr: value, .. } => of(*value),
        E::Binary { left, right, .. }
        | E::Access {
            base: left,
            index: right,
        } => all(&[*left, *right]),
        E::Compose { components, .. } => all(components),
        E::Select {
            condition,
            accept,
            reject,
        } => all(&[*condition, *accept, *reject]),
        E::Math {
            arg,
            arg1,
            arg2,
            arg3,
            ..
        } => {
            let args: Vec<_> = [Some(*arg), *arg1, *arg2, *arg3]
                .into_iter()
                .flatten()
                .collect();
            all(&args)
        }
        _ => None,
    }
}

fn deciders(block: &naga::Block, found: &mut Vec<naga::Handle<naga::Expression>>) {
    for statement in block {
        match statement {
            naga::Statement::Block(inner) => deciders(inner, found),
            naga::Statement::If {
                condition,
                accept,
                reject,
            } => {
                found.push(*condition);
                deciders(accept, found);
                deciders(reject, found);
            }
            naga::Statement::Switch { selector, cases } => {
                found.push(*selector);
                for case in cases {
                    deciders(&case.body, found);
                }
            }
            naga::Statement::Loop {
                body, continuing, ..
            } => {
                deciders(body, found);
                deciders(continuing, found);
            }
            _ => {}
        }
    }
}

#[test]
fn no_branch_hangs_on_a_uniform_alone() {
    // Mesa 22's software Vulkan recompiles such a shader for every picture and keeps each copy: 45 MB a minute.
    let all = [
        ("points", points::SHADER, 5),
        ("lines", lines::SHADER, 5),
        ("eye_dome", eye_dome::SHADER, 4),
        ("composite", composite::SHADER, 1),
    ];
    for (name, source, least) in all {
        let module = parse(name, source);
        let functions = module.functions.iter().map(|(_, function)| function);
        let stages = module.entry_points.iter().map(|entry| &entry.function);
        let mut num_deciders = 0;
        for function in functions.chain(stages) {
            let mut found = Vec::new();
            deciders(&function.body, &mut found);
            num_deciders += found.len();
            for value in found {
                let is_of = is_of_uniforms(&module, function, value);
                assert_ne!(is_of, Some(true), "{name}: {:?}", function.name);
            }
        }
        assert!(num_deciders >= least, "{name}: {num_deciders}");
    }
}
