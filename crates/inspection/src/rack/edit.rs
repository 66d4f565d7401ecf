//! Edits the text of a rack file, and leaves the rest as it is: comments, order, and how numbers are written.

use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, RawString, Table, Value};

use super::RackFile;

/// The text of a file with `before`, changed to `after`; `None` if its form allows no such change.
pub(super) fn changed(text: &str, before: &RackFile, after: &RackFile) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    let before: DocumentMut = before.text().parse().ok()?;
    let after: DocumentMut = after.text().parse().ok()?;
    for (key, item) in after.iter() {
        if item.is_array_of_tables() {
            let none = || Item::ArrayOfTables(ArrayOfTables::new());
            document.entry(key).or_insert_with(none);
        }
    }
    change(document.as_table_mut(), &before, &after)?;
    Some(document.to_string())
}

fn change(table: &mut Table, before: &Table, after: &Table) -> Option<()> {
    for (key, _) in before {
        if !after.contains_key(key) {
            table.remove(key);
        }
    }
    for (key, wanted) in after {
        let was = before.get(key);
        if was.is_some_and(|was| plain(was) == plain(wanted)) {
            continue;
        }
        match (table.get_mut(key), wanted) {
            (Some(Item::ArrayOfTables(tables)), Item::ArrayOfTables(wanted)) => {
                let none = ArrayOfTables::new();
                let was = was.and_then(Item::as_array_of_tables).unwrap_or(&none);
                change_tables(tables, was, wanted)?;
            }
            (Some(Item::Value(Value::Array(array))), Item::ArrayOfTables(_)) => {
                let was = was.map(values_of).unwrap_or_default();
                change_array(array, &was, values_of(wanted));
            }
            (Some(Item::Value(value)), Item::Value(wanted)) => {
                let decor = value.decor().clone();
                *value = wanted.clone();
                *value.decor_mut() = decor;
            }
            (None, wanted) => {
                table.insert(key, Item::Value(wanted.clone().into_value().ok()?));
            }
            _ => return None,
        }
    }
    Some(())
}

/// Tables with a name keep it, others their place in the order.
fn change_tables(
    tables: &mut ArrayOfTables,
    before: &ArrayOfTables,
    after: &ArrayOfTables,
) -> Option<()> {
    let mut known: Vec<Option<Table>> = std::mem::take(tables).into_iter().map(Some).collect();
    for (index, wanted) in after.iter().enumerate() {
        let mut former = before.iter().enumerate();
        let former = former.find(|(at, table)| match name_of(wanted) {
            Some(name) => name_of(table) == Some(name),
            None => *at == index,
        });
        let table = former.and_then(|(at, was)| Some((known.get_mut(at)?.take()?, was)));
        tables.push(match table {
            Some((mut table, was)) => {
                change(&mut table, was, wanted)?;
                table
            }
            None => new_table(wanted)?,
        });
    }
    Some(())
}

fn name_of(table: &Table) -> Option<&str> {
    table.get("name")?.as_str()
}

fn new_table(wanted: &Table) -> Option<Table> {
    let mut table = Table::new();
    for (key, item) in wanted {
        table.insert(key, Item::Value(item.clone().into_value().ok()?));
    }
    Some(table)
}

/// An element of an array, and what is written around it.
struct Element {
    value: Value,
    /// From the end of the line before it.
    before: String,
    /// Up to the end of its own line, behind the comma.
    behind: String,
}

/// Keeps the elements that stay, with the comments before and behind them, and puts new ones below them.
fn change_array(array: &mut Array, before: &[Value], after: Vec<Value>) {
    let (opening, known, closing) = elements_of(array);
    let first = known.first().map_or("", |first| &*first.before);
    let new_line = first.rfind('\n').map(|at| first[at..].to_owned());
    let elements = after.into_iter().enumerate().map(|(number, value)| {
        let index = before.iter().position(|was| is_same(was, &value));
        if let Some(Element {
            value,
            before,
            behind,
        }) = index.and_then(|index| known.get(index))
        {
            return (value.clone(), before.clone(), behind.clone());
        }
        let beside = if number == 0 { "" } else { " " };
        let before = new_line.clone().unwrap_or_else(|| beside.to_owned());
        (value, before, String::new())
    });
    let mut changed = array.clone();
    changed.clear();
    let mut behind = opening;
    for (mut value, before, behind_it) in elements {
        value.decor_mut().set_prefix(format!("{behind}{before}"));
        value.decor_mut().set_suffix("");
        changed.push_formatted(value);
        behind = behind_it;
    }
    changed.set_trailing(format!("{behind}{closing}"));
    changed.set_trailing_comma(array.trailing_comma() || closing.contains('\n'));
    *array = changed;
}

/// What is written behind the opening bracket, the elements, and what is written from the last one's line on.
fn elements_of(array: &Array) -> (String, Vec<Element>, String) {
    let text = |raw: Option<&RawString>| {
        raw.and_then(RawString::as_str)
            .unwrap_or_default()
            .to_owned()
    };
    let split = |text: String| match text.find('\n') {
        Some(at) => (text[..at].to_owned(), text[at..].to_owned()),
        None => (String::new(), text),
    };
    let mut between = String::new();
    let mut opening = None;
    let mut elements: Vec<Element> = Vec::new();
    for value in array {
        let prefix = text(value.decor().prefix());
        let (behind, before) = split(between + &prefix);
        match elements.last_mut() {
            Some(last) => last.behind = behind,
            None => opening = Some(behind),
        }
        between = text(value.decor().suffix());
        elements.push(Element {
            value: value.clone(),
            before,
            behind: String::new(),
        });
    }
    let (behind, closing) = split(between + &text(Some(array.trailing())));
    match elements.last_mut() {
        Some(last) => last.behind = behind,
        None => opening = Some(behind),
    }
    (opening.unwrap_or_default(), elements, closing)
}

fn values_of(item: &Item) -> Vec<Value> {
    let value = item.clone().into_value().ok();
    let array = value.as_ref().and_then(Value::as_array);
    array.into_iter().flatten().cloned().collect()
}

fn is_same(one: &Value, other: &Value) -> bool {
    one.to_string().trim() == other.to_string().trim()
}

fn plain(item: &Item) -> String {
    item.clone()
        .into_value()
        .map_or_else(|_| String::new(), |value| value.to_string())
}
