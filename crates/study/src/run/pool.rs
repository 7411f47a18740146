//! The threads of a run.
//!
//! Knows how many there are. Does not know what runs on them.

use thiserror::Error;

/// Why a run could not begin.
#[derive(Debug, Error)]
#[error("no pool of {threads} threads: {cause}")]
pub struct PoolError {
    /// Threads asked for.
    threads: usize,
    /// What the system said.
    cause: rayon::ThreadPoolBuildError,
}

/// Runs `work` on a pool of `threads` threads, 0: as many as the machine has. Parallel work within it stays on that pool.
///
/// # Errors
/// [`PoolError`].
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, PoolError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|cause| PoolError { threads, cause })?;
    Ok(pool.install(work))
}
