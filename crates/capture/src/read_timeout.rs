//! Detects a camera that is still there but sends nothing any more. Its library does not report this: each wait for a frame
//! just ends without one.

use std::time::Duration;

/// Some cameras take more than a second from the start to their first frame.
const DEFAULT_TIMEOUT: Duration = Duration::from_secs(5);

/// Sums up the waits in which a camera sent nothing; time in which nobody waited for a frame does not count.
pub(super) struct ReadTimeout {
    limit: Duration,
    silent_for: Duration,
}

impl Default for ReadTimeout {
    fn default() -> Self {
        Self::with_limit(DEFAULT_TIMEOUT)
    }
}

impl ReadTimeout {
    /// A camera is lost after `limit`.
    pub(super) fn with_limit(limit: Duration) -> Self {
        Self {
            limit,
            silent_for: Duration::ZERO,
        }
    }

    /// Resets the silence after a frame.
    pub(super) fn restart(&mut self) {
        self.silent_for = Duration::ZERO;
    }

    /// Adds a wait without a frame. Returns the whole seconds of the silence once it reaches the limit.
    pub(super) fn add(&mut self, wait: Duration) -> Option<u64> {
        self.silent_for += wait;
        (self.silent_for >= self.limit).then_some(self.seconds())
    }

    /// Whole seconds of the silence so far.
    pub(super) fn seconds(&self) -> u64 {
        self.silent_for.as_secs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_is_silent_for_too_long_only_after_its_time() {
        let mut silence = ReadTimeout::default();
        assert_eq!(silence.add(Duration::ZERO), None);
        assert_eq!(silence.add(Duration::from_millis(4_999)), None);
        assert_eq!(silence.seconds(), 4);
        assert_eq!(silence.add(Duration::from_millis(1)), Some(5));
        silence.restart();
        assert_eq!(silence.add(Duration::from_secs(4)), None);
        assert_eq!(
            ReadTimeout::with_limit(Duration::from_secs(8)).add(Duration::from_secs(9)),
            Some(9)
        );
    }
}
