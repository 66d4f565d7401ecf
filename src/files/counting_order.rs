//! Names in the order that a person counts them.

/// A key to sort by, so that frame 10 comes after frame 9: every run of digits by its value.
pub(crate) fn in_counting_order(name: &str) -> Vec<(String, u64)> {
    let mut pieces = vec![(String::new(), 0_u64)];
    for letter in name.chars() {
        let Some((_, number)) = pieces.last_mut() else {
            break;
        };
        match letter.to_digit(10) {
            Some(digit) => {
                *number = number.saturating_mul(10).saturating_add(u64::from(digit));
            }
            None if *number > 0 => pieces.push((letter.to_string(), 0)),
            None => {
                if let Some((text, _)) = pieces.last_mut() {
                    text.push(letter);
                }
            }
        }
    }
    pieces
}
