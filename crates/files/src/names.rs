//! Checks of relative paths, and the names that errors suggest: those nearest to the requested one.

use std::path::{Component, Path};

/// Returns true for a path that stays inside its folder: a document or a list must not choose which other files of the
/// machine are read.
pub fn stays_inside(path: &Path) -> bool {
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    !path.as_os_str().is_empty() && path.components().all(is_inside)
}

/// The most names listed; a whole car has hundreds.
const MAX_SHOWN: usize = 10;

/// Lists the names, those nearest to `wanted` first.
pub(super) fn listed(names: &[String], wanted: &str) -> String {
    if names.is_empty() {
        return "no named meshes".into();
    }
    let nearest = nearest_first(names.iter().map(String::as_str), wanted);
    let shown: Vec<&str> = nearest.iter().take(MAX_SHOWN).copied().collect();
    match names.len() - shown.len() {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// Returns the name nearest to `wanted`, the first if several are equally near; `None` if more than half of the letters
/// differ, because it was probably not meant.
pub fn nearest_name<'a>(names: impl Iterator<Item = &'a str>, wanted: &str) -> Option<&'a str> {
    let nearest = nearest_first(names, wanted).first().copied()?;
    (2 * num_edits(nearest, wanted) <= letters_of(wanted).len()).then_some(nearest)
}

/// Counts the letters and digits by which two names differ.
pub(super) fn num_edits(a: &str, b: &str) -> usize {
    edits_between(&letters_of(a), &letters_of(b))
}

fn nearest_first<'a>(names: impl Iterator<Item = &'a str>, wanted: &str) -> Vec<&'a str> {
    let mut names: Vec<&str> = names.collect();
    if !wanted.is_empty() {
        let wanted = letters_of(wanted);
        names.sort_by_cached_key(|name| edits_between(&letters_of(name), &wanted));
    }
    names
}

/// Returns up to 64 letters and digits in lower case: people take `Door_FL`, `door-fl` and `DoorFL` for one name.
fn letters_of(name: &str) -> Vec<char> {
    let kept = name.chars().filter(|c| c.is_alphanumeric());
    kept.flat_map(char::to_lowercase).take(64).collect()
}

/// Counts the letters to insert, remove or replace (V. I. Levenshtein, 1966), row by row.
fn edits_between(a: &[char], b: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_comes_first_and_hundreds_are_not_shown() {
        let mut names: Vec<String> = (0..200).map(|i| format!("bolt_{i}")).collect();
        names.push("Door_FL".into());
        names.push("Door_FR".into());
        let list = listed(&names, "door-fl");
        assert!(list.starts_with("Door_FL, Door_FR, bolt_"), "{list}");
        assert!(list.ends_with(" and 192 more"), "{list}");
        let all = names.iter().map(String::as_str);
        assert_eq!(nearest_name(all.clone(), "doorfr"), Some("Door_FR"));
        assert_eq!(nearest_name(all.clone(), "dorfrt"), Some("Door_FR"));
        assert_eq!(nearest_name(all, "windscreen"), None);
        assert_eq!(listed(&names[..2], ""), "bolt_0, bolt_1");
        assert_eq!(listed(&[], "x"), "no named meshes");
    }

    #[test]
    fn edits_are_counted() {
        let letters = |text: &str| text.chars().collect::<Vec<_>>();
        for (a, b, edits) in [("kitten", "sitting", 3), ("", "abc", 3), ("abc", "abc", 0)] {
            assert_eq!(edits_between(&letters(a), &letters(b)), edits, "{a} {b}");
        }
    }
}
