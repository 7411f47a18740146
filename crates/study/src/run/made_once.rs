//! Things that jobs share: each made once, in parallel, by keys.
//!
//! Knows that what could not be made is a failure of all who need it. Does not know what things are.

use super::cancel::CancelToken;
use super::failure::JobFailure;
use super::guard::guarded;
use pontoon_results::{Failure, FailureKind};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A thing that jobs share, or why it could not be made.
pub(super) type SharedResult<T> = Result<Arc<T>, JobFailure>;

/// Makes one thing for each distinct key that is not known, in parallel; the first job with a key stands for the others.
pub(super) fn each<J: Sync, K: Ord + Send, T: Send + Sync>(
    cancel: &CancelToken,
    jobs: &[J],
    known: &BTreeMap<K, SharedResult<T>>,
    key: impl Fn(&J) -> Option<K>,
    make: impl Fn(&J) -> Result<T, JobFailure> + Sync,
) -> BTreeMap<K, SharedResult<T>> {
    let mut first: BTreeMap<K, &J> = BTreeMap::new();
    for job in jobs {
        if let Some(key) = key(job) {
            first.entry(key).or_insert(job);
        }
    }
    let (mut list, mut made) = (Vec::new(), BTreeMap::new());
    for (key, job) in first {
        match known.get(&key) {
            Some(old) => {
                made.insert(key, old.clone());
            }
            None => list.push((key, job)),
        }
    }
    let new: Vec<(K, SharedResult<T>)> = list
        .into_par_iter()
        .with_max_len(1)
        .map(|(key, job)| {
            let stopped = || Failure::new(FailureKind::Stopped, "not prepared: the run was stopped").into();
            let made = match cancel.is_asked() {
                true => Err(stopped()),
                // what is under way gives up at a stop
                false => guarded(|| make(job)).map_err(|failure| if cancel.is_asked() { stopped() } else { failure }),
            };
            (key, made.map(Arc::new))
        })
        .collect();
    made.extend(new);
    made
}

/// What was made for a key.
pub(super) fn shared<K: Ord, T>(map: &BTreeMap<K, SharedResult<T>>, key: &K) -> SharedResult<T> {
    map.get(key).cloned().unwrap_or_else(|| Err(not_prepared()))
}

/// Why what nobody made is not there.
pub(super) fn not_prepared() -> JobFailure {
    JobFailure::of_program("not prepared")
}
