//! A panic inside a job is that job's failure and nobody else's.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `f`; a panic becomes an error with its message. What `f` touched is either its own or read-only, so nothing
/// half-done is seen afterwards.
pub(super) fn guarded<T, E: From<String>>(f: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    catch_unwind(AssertUnwindSafe(f))
        .unwrap_or_else(|panic| Err(format!("program error: {}", message(panic.as_ref())).into()))
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
        assert_eq!(guarded(|| Ok::<_, String>(3)), Ok(3));
        let list: Vec<usize> = Vec::new();
        let reason: String = guarded(|| Ok::<_, String>(list[list.len()])).unwrap_err();
        assert!(reason.starts_with("program error: index out of bounds"), "{reason}");
    }
}
