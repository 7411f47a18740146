//! Which jobs there were before, kept as fingerprints.
//!
//! Knows that equal jobs hash alike. Does not know what a job is. Keeps 128 bits a job, with the table about it some 30
//! bytes: among ten million jobs two different ones have the same fingerprint once in 10^24 studies.

use std::collections::HashSet;
use std::hash::{BuildHasherDefault, DefaultHasher, Hash, Hasher};

/// The jobs seen so far.
#[derive(Debug)]
pub(super) struct SeenJobs {
    fingerprints: HashSet<u128, BuildHasherDefault<Itself>>,
    /// What tells the job at hand apart.
    bytes: Bytes,
}

/// The fingerprint of what tells a job apart.
pub(super) fn fingerprint(identity: &impl Hash) -> u128 {
    let mut bytes = Bytes::default();
    identity.hash(&mut bytes);
    bytes.fingerprint()
}

impl SeenJobs {
    /// None yet, with room for so many: a table that grows would for a while be there twice.
    pub(super) fn with_room_for(jobs: usize) -> Self {
        Self {
            fingerprints: HashSet::with_capacity_and_hasher(jobs, BuildHasherDefault::default()),
            bytes: Bytes::default(),
        }
    }

    /// Number of different jobs.
    pub(super) fn len(&self) -> usize {
        self.fingerprints.len()
    }

    /// Adds a job by what tells it apart; whether it was not there before.
    pub(super) fn insert(&mut self, identity: &impl Hash) -> bool {
        self.bytes.0.clear();
        identity.hash(&mut self.bytes);
        self.fingerprints.insert(self.bytes.fingerprint())
    }
}

/// The bytes that a value would be hashed by.
#[derive(Debug, Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn fingerprint(&self) -> u128 {
        let half = |first: u8| {
            let mut hasher = DefaultHasher::new();
            hasher.write_u8(first);
            hasher.write(&self.0);
            u128::from(hasher.finish())
        };
        half(0) << 64 | half(1)
    }
}

impl Hasher for Bytes {
    fn write(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    fn finish(&self) -> u64 {
        self.fingerprint() as u64
    }
}

/// The hash of a fingerprint: its own last bits.
#[derive(Debug, Default)]
struct Itself(u64);

impl Hasher for Itself {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.0 ^= u64::from_le_bytes(word);
        }
    }

    fn write_u128(&mut self, fingerprint: u128) {
        self.0 = fingerprint as u64;
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_seen_is_not_new_and_everything_else_is() {
        let mut seen = SeenJobs::with_room_for(2);
        for round in 0..2 {
            for a in 0..100_u64 {
                for text in ["x", "y"] {
                    assert_eq!(seen.insert(&(a, text, Some([a, 1]))), round == 0, "{a} {text}");
                }
            }
        }
        assert_eq!(seen.len(), 200);
    }

    #[test]
    fn the_two_halves_of_a_fingerprint_are_not_the_same_number() {
        for a in 0..1000_u64 {
            let mut bytes = Bytes::default();
            a.hash(&mut bytes);
            let fingerprint = bytes.fingerprint();
            assert_ne!(fingerprint as u64, (fingerprint >> 64) as u64);
        }
    }
}
