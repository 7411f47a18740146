//! A moment of wall time.
//!
//! Knows the clock. Tables hold no moment; manifests, journals and messages do.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// A moment of wall time.
#[derive(Debug, Clone, Copy)]
pub struct Moment(SystemTime);

impl Moment {
    /// Now.
    pub fn now() -> Self {
        Self(SystemTime::now())
    }

    /// A number of milliseconds since 1970.
    pub fn of_unix_ms(unix_ms: u64) -> Self {
        Self(UNIX_EPOCH + Duration::from_millis(unix_ms))
    }

    /// As `2005-01-31T12:00:00Z`.
    pub fn text(self) -> String {
        // a clock that stands before 1970 or after 9999 is told as their ends
        let end = UNIX_EPOCH + Duration::from_secs(LAST_S);
        humantime::format_rfc3339_seconds(self.0.clamp(UNIX_EPOCH, end)).to_string()
    }
}

/// The last second of the year 9999, since 1970 `[s]`.
const LAST_S: u64 = 253_402_300_799;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_written_in_the_calendar() {
        let text = |seconds| Moment(UNIX_EPOCH + Duration::from_secs(seconds)).text();
        assert_eq!(text(0), "1970-01-01T00:00:00Z");
        assert_eq!(text(951_826_154), "2000-02-29T12:09:14Z");
        assert_eq!(text(4_107_542_400), "2100-03-01T00:00:00Z");
        assert_eq!(text(u64::from(u32::MAX) * 1000), "9999-12-31T23:59:59Z");
        assert_eq!(
            Moment(UNIX_EPOCH - Duration::from_secs(1)).text(),
            "1970-01-01T00:00:00Z"
        );
    }
}
