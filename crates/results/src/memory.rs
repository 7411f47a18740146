//! Memory that is free, so that what would not fit is refused before it is read: a system that runs out of it ends some process
//! without a word.
//!
//! Knows what Linux says of it: what is available, the limit of a control group, the limit of the process. Does not know what
//! memory is for.

use std::fs;

/// Bytes that this process may still take; none where the system does not say.
fn free_bytes() -> Option<u64> {
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let group = |name: &str| read(&format!("/sys/fs/cgroup/memory.{name}"));
    let limits = [
        available(&read("/proc/meminfo")),
        beyond(number(&group("max")), number(&group("current"))),
        beyond(
            address_space(&read("/proc/self/limits")),
            pages(&read("/proc/self/statm")),
        ),
    ];
    limits.into_iter().flatten().min()
}

/// A refusal of so many bytes in words: what they need and what is free; none where they fit.
pub fn too_large(needed: u64) -> Option<String> {
    let free = free_bytes().filter(|free| needed > *free)?;
    let gigabytes = |bytes: u64| (bytes as f64 / 1e9 * 100.0).ceil() / 100.0;
    let (needed, free) = (gigabytes(needed), gigabytes(free));
    Some(format!(
        "about {needed} GB of memory to be read, of which {free} GB are free"
    ))
}

/// `MemAvailable` of `/proc/meminfo`.
fn available(told: &str) -> Option<u64> {
    let line = told.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes << 10)
}

/// The soft limit of the address space in `/proc/self/limits`; none where there is none.
fn address_space(told: &str) -> Option<u64> {
    let line = told.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    number(line.split_whitespace().next()?)
}

/// The pages of `/proc/self/statm` as bytes: pages of 4 kB, as they are at least.
fn pages(told: &str) -> Option<u64> {
    Some(number(told.split_whitespace().next()?)? << 12)
}

/// A number; none of a word such as `max`.
fn number(told: &str) -> Option<u64> {
    told.trim().parse().ok()
}

fn beyond(limit: Option<u64>, taken: Option<u64>) -> Option<u64> {
    Some(limit?.saturating_sub(taken.unwrap_or(0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_says_is_read() {
        let meminfo = "MemTotal:       24737000 kB\nMemFree:   1 kB\nMemAvailable:    2048 kB\n";
        assert_eq!(available(meminfo), Some(2 << 20));
        let limits = "Limit  Soft Limit  Hard Limit  Units\nMax address space         716800000            unlimited            bytes\n";
        assert_eq!(address_space(limits), Some(716_800_000));
        assert_eq!(address_space(&limits.replace("716800000", "unlimited")), None);
        assert_eq!(pages("25 10 5 1 0 9 0\n"), Some(25 << 12));
        assert_eq!((number("max\n"), number("4096\n")), (None, Some(4096)));
        assert_eq!((beyond(Some(5), Some(9)), beyond(None, Some(1))), (Some(0), None));
        assert!(
            [available, address_space, pages, number]
                .iter()
                .all(|read| read("").is_none())
        );
    }

    #[test]
    fn what_does_not_fit_is_said_with_both_numbers() {
        assert_eq!(too_large(1), None);
        if let Some(free) = free_bytes() {
            let said = too_large(free.saturating_add(10_000_000_000)).unwrap();
            assert!(said.contains("GB of memory to be read, of which "), "{said}");
        }
    }
}
