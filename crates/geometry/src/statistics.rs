//! Quantiles that are values of the list themselves, and even samples of lists and directions.

use nalgebra::Vector3;

/// Returns the value below which a share (0..1) of the values lies; `None` without values.
pub fn quantile(values: impl Iterator<Item = f64>, share: f64) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        return None;
    }
    let position = ((values.len() - 1) as f64 * share).round() as usize;
    Some(*values.select_nth_unstable_by(position, f64::total_cmp).1)
}

/// Returns the median, of an even number the upper middle value; `None` without values.
pub fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    quantile(values, 0.5)
}

/// Returns the median, of an even number the lower middle value; `None` without values.
pub fn lower_median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    let position = values.len().checked_sub(1)? / 2;
    Some(*values.select_nth_unstable_by(position, f64::total_cmp).1)
}

/// Returns directions that are even over the sphere, from z to -z: a Fibonacci spiral.
pub fn even_directions(num: usize) -> impl Iterator<Item = Vector3<f64>> {
    (0..num).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / num as f64;
        let turn = i as f64 * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * turn.cos(), r * turn.sin(), z)
    })
}

/// Returns at most `most` of the items, evenly spread over their order.
pub fn sample_evenly<T>(items: &[T], most: usize) -> impl ExactSizeIterator<Item = &T> + Clone {
    let step = items.len().div_ceil(most.max(1)).max(1);
    items.iter().step_by(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_of_the_list() {
        let values = || [5.0, 1.0, 4.0, 2.0, 3.0].into_iter();
        assert_eq!(quantile(values(), 0.5), Some(3.0));
        assert_eq!(quantile(values(), 0.0), Some(1.0));
        assert_eq!(quantile(values(), 1.0), Some(5.0));
        assert_eq!(quantile(std::iter::empty(), 0.5), None);
    }

    #[test]
    fn samples_are_as_many_as_fit() {
        let of = |num: usize, most| sample_evenly(&[0; 20][..num], most).len();
        assert_eq!([of(20, 20), of(20, 7), of(20, 0), of(0, 5)], [20, 7, 1, 0]);
        let kept: Vec<i32> = sample_evenly(&[5, 6, 7, 8, 9], 3).copied().collect();
        assert_eq!(kept, [5, 7, 9]);
    }

    #[test]
    fn the_medians_of_an_even_number_are_its_middle_values() {
        for num in [2, 4, 6, 100] {
            let values = || (0..num).rev().map(f64::from);
            assert_eq!(median(values()), Some(f64::from(num / 2)));
            assert_eq!(lower_median(values()), Some(f64::from(num / 2 - 1)));
        }
        assert_eq!(median([7.0].into_iter()), Some(7.0));
        assert_eq!(lower_median([7.0].into_iter()), Some(7.0));
        assert_eq!(lower_median(std::iter::empty()), None);
    }
}
