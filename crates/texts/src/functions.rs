//! What a text can do with its variables, beside choosing among variants.
//!
//! ```text
//! FIXED($score, 2)         0.81 with two decimals
//! PERCENT($share, 1)       0.123 as 12.3
//! MM($shift_m, 1)          0.0042 metres as 4.2
//! UM($film_m, 1)           0.0000385 metres as 38.5
//! DEGREES($turn_rad, 2)    radians as degrees
//! LIST(a, b, c, between: ", ", last: " and ", end: "; ")    those that are not empty; `end` only if one is not
//! ```
//!
//! The first five are numbers: a text can choose by them, as in `[0.0]`, written with as many decimals.

use fluent_bundle::{
    FluentArgs, FluentResource, FluentValue, concurrent::FluentBundle, types::FluentNumber,
};

pub(crate) fn add_to(bundle: &mut FluentBundle<FluentResource>) {
    let numbers = [
        ("FIXED", 1.0),
        ("PERCENT", 100.0),
        ("MM", 1000.0),
        ("UM", 1e6),
        ("DEGREES", 1_f64.to_degrees()),
    ];
    for (name, factor) in numbers {
        // It fails only for a name that is taken.
        let _ = bundle.add_function(name, move |given, _| rounded(given, factor));
    }
    let _ = bundle.add_function("LIST", list);
}

fn rounded<'a>(given: &[FluentValue<'a>], factor: f64) -> FluentValue<'a> {
    let [FluentValue::Number(value), FluentValue::Number(decimals)] = given else {
        return FluentValue::Error;
    };
    let text = format!("{:.*}", decimals.value as usize, value.value * factor);
    let number = text.parse::<FluentNumber>();
    number.map_or(FluentValue::Error, FluentValue::Number)
}

fn list<'a>(given: &[FluentValue<'a>], named: &FluentArgs<'_>) -> FluentValue<'a> {
    let word = |name| match named.get(name) {
        Some(FluentValue::String(word)) => word.clone().into_owned(),
        _ => String::new(),
    };
    let items = given.iter().filter_map(|item| match item {
        FluentValue::String(text) if !text.is_empty() => Some(text.as_ref()),
        _ => None,
    });
    let items: Vec<&str> = items.collect();
    let text = match items.as_slice() {
        [] => String::new(),
        [one] => format!("{one}{}", word("end")),
        [first @ .., last] => {
            let first = first.join(&word("between"));
            format!("{first}{}{last}{}", word("last"), word("end"))
        }
    };
    text.into()
}
