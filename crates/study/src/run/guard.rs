//! A panic inside a job is that job's failure and nobody else's.

use super::failure::JobFailure;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `f`; a panic becomes an error with its message. What `f` touched is either its own or read-only, so nothing
/// half-done is seen afterwards.
pub(super) fn guarded<T>(f: impl FnOnce() -> Result<T, JobFailure>) -> Result<T, JobFailure> {
    catch_unwind(AssertUnwindSafe(f)).unwrap_or_else(|panic| Err(JobFailure::of_program(message(panic.as_ref()))))
}

fn message(panic: &(dyn Any + Send)) -> &str {
    match (panic.downcast_ref::<&str>(), panic.downcast_ref::<String>()) {
        (Some(text), _) => text,
        (None, Some(text)) => text,
        _ => "no message",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_reason_and_a_result_passes() {
        assert_eq!(guarded(|| Ok(3)), Ok(3));
        let list: Vec<usize> = Vec::new();
        let reason = guarded(|| Ok(list[list.len()])).unwrap_err().failure.text;
        assert!(reason.starts_with("program error: index out of bounds"), "{reason}");
    }
}
