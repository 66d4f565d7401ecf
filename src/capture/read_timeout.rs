//! Detects a camera that no longer sends anything.

use std::time::Duration;

/// Default silence after which a camera is lost. Some take more than a second from the start to their first frame.
const USUAL: Duration = Duration::from_secs(5);

/// How long a camera has sent nothing while being waited for. Pauses in which nobody waited do not count.
pub(super) struct ReadTimeout {
    limit: Duration,
    silent_for: Duration,
}

impl Default for ReadTimeout {
    fn default() -> Self {
        Self::of(USUAL)
    }
}

impl ReadTimeout {
    pub(super) fn of(limit: Duration) -> Self {
        Self {
            limit,
            silent_for: Duration::ZERO,
        }
    }

    /// Resets the silence after a frame.
    pub(super) fn restart(&mut self) {
        self.silent_for = Duration::ZERO;
    }

    /// Adds `turn` to the silence. Returns its whole seconds once it reaches the limit.
    pub(super) fn goes_on(&mut self, turn: Duration) -> Option<u64> {
        self.silent_for += turn;
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
        assert_eq!(silence.goes_on(Duration::ZERO), None);
        assert_eq!(silence.goes_on(Duration::from_millis(4_999)), None);
        assert_eq!(silence.seconds(), 4);
        assert_eq!(silence.goes_on(Duration::from_millis(1)), Some(5));
        silence.restart();
        assert_eq!(silence.goes_on(Duration::from_secs(4)), None);
        assert_eq!(
            ReadTimeout::of(Duration::from_secs(8)).goes_on(Duration::from_secs(9)),
            Some(9)
        );
    }
}
