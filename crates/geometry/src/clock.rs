//! This computer's clock and the times of its files.
//!
//! Both may be set to any year, but [`Timestamp`] and the calendar end with the year 9999. Later times become [`LAST`], so
//! that a wrong clock stops no inspection. Clippy denies `Timestamp::now` and
//! `Zoned::now`, which panic then.

use std::time::SystemTime;

use jiff::{Timestamp, Zoned, tz::TimeZone};

/// The latest time: the beginning of 9999, so that days and shifts around it have dates too.
pub const LAST: Timestamp = Timestamp::constant(253_370_764_800, 0);

/// Returns the time of this computer's clock.
pub fn now() -> Timestamp {
    timestamp(SystemTime::now())
}

/// Returns the same as [`now`], in the time zone of this computer.
pub fn zoned_now() -> Zoned {
    now().to_zoned(TimeZone::system())
}

/// Converts the time of a clock or a file.
pub fn timestamp(time: SystemTime) -> Timestamp {
    let beyond = if time < SystemTime::UNIX_EPOCH {
        Timestamp::MIN
    } else {
        LAST
    };
    Timestamp::try_from(time).unwrap_or(beyond).min(LAST)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_time_of_any_year_is_a_timestamp() {
        let after = |seconds| SystemTime::UNIX_EPOCH + Duration::from_secs(seconds);
        let before = |seconds| SystemTime::UNIX_EPOCH - Duration::from_secs(seconds);
        for (time, expected) in [
            (after(0), "1970-01-01T00:00:00Z"),
            (before(1), "1969-12-31T23:59:59Z"),
            (after(1_800_000_000), "2027-01-15T08:00:00Z"),
            (after(253_370_764_799), "9998-12-31T23:59:59Z"),
            // Within the last year, beyond it, and as late as a system can be.
            (after(253_380_000_000), "9999-01-01T00:00:00Z"),
            (after(300_000_000_000), "9999-01-01T00:00:00Z"),
            (after(i64::MAX as u64), "9999-01-01T00:00:00Z"),
            (before(i64::MAX as u64), "-009999-01-02T01:59:59Z"),
        ] {
            assert_eq!(timestamp(time).to_string(), expected, "{time:?}");
        }
        assert_eq!(LAST.to_string(), "9999-01-01T00:00:00Z");
    }
}
