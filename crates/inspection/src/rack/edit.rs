//! Changes of a rack file's text that leave the rest of it as it is: comments, order, and how numbers are written.

use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, Value};

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

/// Keeps the elements that stay, with their comments, and puts new ones below them.
fn change_array(array: &mut Array, before: &[Value], after: Vec<Value>) {
    let known: Vec<Value> = array.iter().cloned().collect();
    let mut changed = array.clone();
    changed.clear();
    for wanted in after {
        let index = before.iter().position(|was| is_same(was, &wanted));
        if let Some(kept) = index.and_then(|index| known.get(index)) {
            changed.push_formatted(kept.clone());
            continue;
        }
        let first = changed.get(0).and_then(|first| first.decor().prefix());
        let first = first.and_then(|prefix| prefix.as_str()).unwrap_or_default();
        let indent = first.rsplit_once('\n').map(|(_, indent)| indent);
        let mut wanted = wanted;
        let prefix = match indent {
            // What is written behind the last element stays there.
            Some(indent) => {
                let trailing = changed.trailing().as_str().unwrap_or_default();
                let behind = trailing.trim_end().to_owned();
                format!("{behind}\n{indent}")
            }
            None if changed.is_empty() => String::new(),
            None => " ".into(),
        };
        if indent.is_some() {
            changed.set_trailing("\n");
            changed.set_trailing_comma(true);
        }
        wanted.decor_mut().set_prefix(prefix);
        wanted.decor_mut().set_suffix("");
        changed.push_formatted(wanted);
    }
    *array = changed;
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
