//! Checks values against the JSON schemas of the published description. Knows only the keywords that occur there, and
//! fails on any other.

use serde_json::Value;

/// Checks a value against a schema. The error says what is wrong, and where in the value.
pub(crate) fn check(value: &Value, schema: &Value, document: &Value) -> Result<(), String> {
    let Some(keywords) = schema.as_object() else {
        let all = schema.as_bool().expect("a schema");
        return if all {
            Ok(())
        } else {
            Err("nothing fits".into())
        };
    };
    for (keyword, wanted) in keywords {
        let fits = match keyword.as_str() {
            "description" | "title" | "format" | "default" => Ok(()),
            "$ref" => {
                let place = wanted.as_str().and_then(|link| link.strip_prefix('#'));
                let schema = place.and_then(|place| document.pointer(place));
                check(value, schema.expect("a schema of the document"), document)
            }
            "type" => of_type(value, wanted),
            "const" => equal(value, wanted),
            "enum" => any(wanted, |one| equal(value, one)),
            "anyOf" => any(wanted, |one| check(value, one, document)),
            "oneOf" => {
                let fitting = list(wanted).iter();
                let fitting = fitting.filter(|one| check(value, one, document).is_ok());
                match fitting.count() {
                    1 => Ok(()),
                    other => Err(format!("{other} of oneOf fit {value}")),
                }
            }
            "minimum" => compared(value, wanted, f64::ge),
            "maximum" => compared(value, wanted, f64::le),
            "minItems" => compared(&length(value), wanted, f64::ge),
            "maxItems" => compared(&length(value), wanted, f64::le),
            "items" => {
                let mut items = value.as_array().into_iter().flatten();
                items.try_for_each(|item| check(item, wanted, document))
            }
            "required" => {
                let missing = list(wanted).iter().find(|name| {
                    let name = name.as_str().expect("a name");
                    value
                        .as_object()
                        .is_some_and(|object| !object.contains_key(name))
                });
                missing.map_or(Ok(()), |name| Err(format!("{name} is missing")))
            }
            "properties" => properties(
                value,
                wanted,
                keywords.contains_key("additionalProperties"),
                document,
            ),
            // Without `properties` this allows any object.
            "additionalProperties" => {
                assert_eq!(wanted, &Value::Bool(true));
                Ok(())
            }
            other => panic!("the keyword {other} is not known here"),
        };
        fits.map_err(|why| format!("{keyword}: {why}"))?;
    }
    Ok(())
}

fn properties(
    value: &Value,
    wanted: &Value,
    may_be_more: bool,
    document: &Value,
) -> Result<(), String> {
    for (name, value) in value.as_object().into_iter().flatten() {
        match wanted.get(name) {
            Some(schema) => {
                check(value, schema, document).map_err(|why| format!("{name}: {why}"))?;
            }
            None if may_be_more => {}
            None => return Err(format!("{name} is not in the description")),
        }
    }
    Ok(())
}

fn of_type(value: &Value, wanted: &Value) -> Result<(), String> {
    let is = |name: &Value| match name.as_str().expect("a type") {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("the type {other} is not known here"),
    };
    let fits = wanted
        .as_array()
        .map_or_else(|| is(wanted), |all| all.iter().any(is));
    if fits {
        Ok(())
    } else {
        Err(format!("{value} is not of {wanted}"))
    }
}

fn equal(value: &Value, wanted: &Value) -> Result<(), String> {
    if value == wanted {
        Ok(())
    } else {
        Err(format!("{value} is not {wanted}"))
    }
}

fn compared(
    value: &Value,
    wanted: &Value,
    holds: impl Fn(&f64, &f64) -> bool,
) -> Result<(), String> {
    let limit = wanted.as_f64().expect("a number");
    match value.as_f64() {
        Some(number) if !holds(&number, &limit) => Err(format!("{number} is beyond {limit}")),
        _ => Ok(()),
    }
}

/// The number of items; null for what is not a list.
fn length(value: &Value) -> Value {
    value
        .as_array()
        .map_or(Value::Null, |items| items.len().into())
}

fn any(schemas: &Value, fits: impl Fn(&Value) -> Result<(), String>) -> Result<(), String> {
    let mut reasons = Vec::new();
    for schema in list(schemas) {
        match fits(schema) {
            Ok(()) => return Ok(()),
            Err(why) => reasons.push(why),
        }
    }
    Err(reasons.join(", "))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}
