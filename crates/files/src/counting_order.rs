//! Sorting of names by the numbers in them.

/// Returns a sort key that compares runs of digits by value, so that frame 10 comes after frame 9.
pub fn in_counting_order(name: &str) -> Vec<(String, u64)> {
    let mut pieces = vec![(String::new(), 0_u64)];
    let mut is_in_number = false;
    for letter in name.chars() {
        let Some((_, number)) = pieces.last_mut() else {
            break;
        };
        match letter.to_digit(10) {
            Some(digit) => {
                is_in_number = true;
                *number = number.saturating_mul(10).saturating_add(u64::from(digit));
            }
            None if is_in_number => {
                is_in_number = false;
                pieces.push((letter.to_string(), 0));
            }
            None => {
                if let Some((text, _)) = pieces.last_mut() {
                    text.push(letter);
                }
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::in_counting_order;

    #[test]
    fn frames_are_counted_from_0_and_10_comes_after_9() {
        let mut names = [
            "left2_10.png",
            "left2_01.png",
            "left2_9.png",
            "left2_00.png",
            "left10_00.png",
        ];
        names.sort_by_key(|name| in_counting_order(name));
        let counted = [
            "left2_00.png",
            "left2_01.png",
            "left2_9.png",
            "left2_10.png",
            "left10_00.png",
        ];
        assert_eq!(names, counted);
    }
}
