//! Shares of a study's jobs, for machines that work on it together.
//!
//! Knows what a job costs, roughly, and deals jobs out so that shares cost the same and few bridges are prepared twice. The
//! same study and number of shares make the same shares, wherever they are asked for. Does not know who takes a share.

use super::Job;
use super::plan::{SECONDS_A_BRIDGE, cost_s};
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};
use std::str::FromStr;
use thiserror::Error;

/// Share `number`, from 0, of `of`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Shard {
    /// Which.
    pub number: usize,
    /// Of how many.
    pub of: usize,
}

/// Most shares.
const MOST: usize = 100_000;

/// Pieces that a share is made of at least, where the jobs allow it.
const PIECES: f64 = 8.0;

/// A text that names no share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("K/N, where K counts from 0 to N - 1 and N is at most {MOST}")]
pub struct NoShard;

impl FromStr for Shard {
    type Err = NoShard;

    fn from_str(text: &str) -> Result<Self, NoShard> {
        let parts = text
            .split_once('/')
            .and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        match parts {
            Some((number, of)) if number < of && of <= MOST => Ok(Self { number, of }),
            _ => Err(NoShard),
        }
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl Shard {
    /// Numbers of the jobs of this share, in order.
    ///
    /// Jobs of one bridge stay together in pieces of at most an eighth of a share's cost; pieces go, the dearest first, to the
    /// share that has cost least so far.
    pub fn deal(self, jobs: &[Job]) -> Vec<usize> {
        let mut bridges: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (at, job) in jobs.iter().enumerate() {
            bridges.entry(&job.shared.bridge.operator_key).or_default().push(at);
        }
        let total: f64 = jobs.iter().map(cost_s).sum::<f64>() + SECONDS_A_BRIDGE * bridges.len() as f64;
        let most = total / (PIECES * self.of as f64);
        let mut pieces: Vec<(f64, Vec<usize>)> = Vec::new();
        for of_bridge in bridges.into_values() {
            // what a bridge costs is borne by its jobs
            let bridge = SECONDS_A_BRIDGE / of_bridge.len() as f64;
            let (mut cost, mut piece) = (0.0, Vec::new());
            for at in of_bridge {
                let own = cost_s(&jobs[at]) + bridge;
                if !piece.is_empty() && cost + own > most {
                    pieces.push((cost, std::mem::take(&mut piece)));
                    cost = 0.0;
                }
                cost += own;
                piece.push(at);
            }
            pieces.push((cost, piece));
        }
        pieces.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut shares: BinaryHeap<Reverse<(u64, usize)>> = (0..self.of).map(|share| Reverse((0, share))).collect();
        let mut own = Vec::new();
        for (cost, piece) in pieces {
            let Some(Reverse((sum, share))) = shares.pop() else {
                break;
            };
            // in whole microseconds, so that sums do not hang on rounding
            shares.push(Reverse((sum + (cost * 1e6) as u64, share)));
            if share == self.number {
                own.extend(piece);
            }
        }
        own.sort_unstable();
        own
    }
}
