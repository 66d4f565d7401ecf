//! The left half of the paper's Table I as printed.
//!
//! It names the four other systems only by the numbers of its bibliography; which systems they are is unknown.

/// Columns of the paper's Table I: four systems by their numbers in its bibliography, and its own.
pub const PAPER_COLUMNS: [&str; 5] = ["[22]", "[44]", "[45]", "[46]", "proposed"];

/// The paper's Table I, seconds, for each of [`PartKind::ALL`](simulate::PartKind::ALL) and each of [`PAPER_COLUMNS`].
pub const PAPER_SECONDS: [[f64; 5]; 8] = [
    [45.4, 159.9, 128.1, 26.7, 0.084],
    [57.9, 154.4, 136.5, 32.1, 0.0554],
    [53.1, 168.0, 135.5, 32.0, 0.0514],
    [54.6, 144.6, 138.3, 34.6, 0.05113],
    [54.0, 158.9, 142.6, 32.5, 0.0515],
    [33.4, 87.8, 120.7, 19.7, 0.0598],
    [34.0, 92.7, 121.0, 20.0, 0.0601],
    [35.3, 96.0, 121.0, 23.0, 0.05101],
];

/// Mean of the four other systems according to the paper's text, seconds.
pub const PAPER_MEAN_OF_OTHERS: f64 = 84.2161;

/// Mean of the paper's own system according to its text, seconds; its Table I gives 0.058.
pub const PAPER_MEAN_OF_OWN: f64 = 0.0890;

/// Returns the mean of each column.
pub fn paper_means() -> [f64; 5] {
    let num = PAPER_SECONDS.len() as f64;
    std::array::from_fn(|column| PAPER_SECONDS.iter().map(|s| s[column]).sum::<f64>() / num)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_s_columns_have_the_means_it_states() {
        let means = paper_means();
        let others = means[..4].iter().sum::<f64>() / 4.0;
        assert!((others - PAPER_MEAN_OF_OTHERS).abs() < 0.05, "{others}");
        // The figures of its own column disagree: 58 ms by the table, 89 ms by the text.
        assert!((means[4] - 0.058).abs() < 0.001, "{}", means[4]);
    }
}
