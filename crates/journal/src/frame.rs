//! Frames: pieces of a file that prove to be whole, each by itself.
//!
//! Knows lengths and checksums, and how to find the next whole frame behind a damaged one. Does not know what a frame
//! holds.
//!
//! A frame is sixteen bytes of head and its payload, numbers in little-endian order:
//!
//! | bytes | what |
//! |---|---|
//! | 0 to 3 | mark |
//! | 4 to 7 | length of the payload |
//! | 8 to 11 | CRC-32 of bytes 4 to 7, 12 to 15 and the payload |
//! | 12 to 15 | kind |

use std::fs::File;
use std::io;
use std::ops::Range;
#[cfg(unix)]
use std::os::unix::fs::FileExt;
use std::path::Path;

/// First bytes of a frame.
const MARK: [u8; 4] = *b"\xf1pj\n";
/// Bytes before the payload.
pub(super) const HEAD: usize = 16;
/// Longest payload.
pub const LONGEST: usize = 1 << 30;
/// Bytes that are read at a time where a frame is looked for.
const LOOK: usize = 1 << 16;

/// Appends a frame to bytes; none is longer than [`LONGEST`], which the caller has seen to.
pub(super) fn append(to: &mut Vec<u8>, kind: u32, payload: &[u8]) {
    let length = u32::try_from(payload.len()).unwrap_or(u32::MAX).to_le_bytes();
    let kind = kind.to_le_bytes();
    to.extend_from_slice(&MARK);
    to.extend_from_slice(&length);
    to.extend_from_slice(&checksum(length, kind, payload).to_le_bytes());
    to.extend_from_slice(&kind);
    to.extend_from_slice(payload);
}

fn checksum(length: [u8; 4], kind: [u8; 4], payload: &[u8]) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    crc.update(&length);
    crc.update(&kind);
    crc.update(payload);
    crc.finalize()
}

/// What Unix has under this name, for Windows: there a read moves the place where the file stands, on which nothing here hangs.
#[cfg(windows)]
trait FileExt {
    fn read_exact_at(&self, to: &mut [u8], at: u64) -> io::Result<()>;
}

#[cfg(windows)]
impl FileExt for File {
    fn read_exact_at(&self, mut to: &mut [u8], mut at: u64) -> io::Result<()> {
        while !to.is_empty() {
            match std::os::windows::fs::FileExt::seek_read(self, to, at) {
                Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
                Ok(read) => (to, at) = (&mut to[read..], at + read as u64),
                Err(cause) if cause.kind() == io::ErrorKind::Interrupted => {}
                Err(cause) => return Err(cause),
            }
        }
        Ok(())
    }
}

/// The head of a frame, as far as it can be judged without its payload.
struct FrameHead {
    length: usize,
    crc: u32,
    kind: [u8; 4],
}

fn head(bytes: &[u8; HEAD]) -> Option<FrameHead> {
    let four = |at: usize| [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
    let length = u32::from_le_bytes(four(4)) as usize;
    (four(0) == MARK && length <= LONGEST).then(|| FrameHead {
        length,
        crc: u32::from_le_bytes(four(8)),
        kind: four(12),
    })
}

/// A whole frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<'a> {
    /// Where its payload begins.
    pub at: u64,
    pub kind: u32,
    pub payload: &'a [u8],
}

/// Bytes of a file that belong to no whole frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Damage {
    /// First byte.
    pub from: u64,
    /// How many.
    pub bytes: u64,
    /// Whether they are the end of the file, as a process or machine leaves it that stops while writing.
    pub tail: bool,
    /// Whether all are zero.
    pub zero: bool,
}

/// Checksums of a file from its beginning to each of its blocks, from which that of any part follows.
struct PrefixSums(Vec<u32>);

impl PrefixSums {
    /// Bytes of a block.
    const BLOCK: usize = 256;

    /// Reads a file once.
    fn of(file: &File, length: u64) -> io::Result<Self> {
        let (mut sums, mut crc, mut at) = (vec![0], crc32fast::Hasher::new(), 0);
        let mut bytes = vec![0; LOOK];
        while at < length {
            let many = usize::try_from(length - at).map_or(LOOK, |left| left.min(LOOK));
            file.read_exact_at(&mut bytes[..many], at)?;
            for block in bytes[..many].chunks_exact(Self::BLOCK) {
                crc.update(block);
                sums.push(crc.clone().finalize());
            }
            at += many as u64;
        }
        Ok(Self(sums))
    }

    /// The checksum of all bytes before a place.
    fn before(&self, file: &File, place: u64) -> io::Result<u32> {
        let block = usize::try_from(place).unwrap_or(usize::MAX) / Self::BLOCK;
        let from = (block * Self::BLOCK) as u64;
        let mut rest = [0; Self::BLOCK];
        let rest = &mut rest[..(place - from) as usize];
        file.read_exact_at(rest, from)?;
        let mut crc = crc32fast::Hasher::new_with_initial(self.0[block]);
        crc.update(rest);
        Ok(crc.finalize())
    }

    /// The checksum of a part, as one to be combined with others.
    fn of_range(&self, file: &File, part: Range<u64>) -> io::Result<crc32fast::Hasher> {
        let (before, whole) = (self.before(file, part.start)?, self.before(file, part.end)?);
        let many = part.end - part.start;
        let mut moved = crc32fast::Hasher::new_with_initial(before);
        moved.combine(&crc32fast::Hasher::new_with_initial_len(0, many));
        let own = whole ^ moved.finalize();
        Ok(crc32fast::Hasher::new_with_initial_len(own, many))
    }
}

/// The frames of a file, one after the other.
pub(super) struct Frames {
    file: File,
    length: u64,
    at: u64,
    payload: Vec<u8>,
    /// Bytes read ahead and where they begin.
    ahead: Vec<u8>,
    ahead_at: u64,
    /// What was passed over.
    pub damages: Vec<Damage>,
    /// Bytes read behind heads that proved to be none.
    wasted: u64,
    /// Bytes that were read in all.
    bytes_read: u64,
    /// Checksums of the file up to each block, once many heads were none.
    sums: Option<PrefixSums>,
}

impl Frames {
    /// The frames of a file from a place on where one begins.
    pub(super) fn open(path: &Path, from: u64) -> io::Result<Self> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        Ok(Self {
            file,
            length,
            at: from,
            payload: Vec::new(),
            ahead: Vec::new(),
            ahead_at: 0,
            damages: Vec::new(),
            wasted: 0,
            bytes_read: 0,
            sums: None,
        })
    }

    /// The next whole frame; what lies before it is noted as damaged.
    pub(super) fn next(&mut self) -> io::Result<Option<Frame<'_>>> {
        let from = self.at;
        let mut at = from;
        loop {
            if self.whole(at)? {
                break;
            }
            match self.mark_after(at)? {
                Some(next) => at = next,
                None => {
                    if from < self.length {
                        self.note(from, self.length, true)?;
                    }
                    self.at = self.length;
                    return Ok(None);
                }
            }
        }
        if at > from {
            self.note(from, at, false)?;
        }
        let mut bytes = [0; HEAD];
        self.read(at, &mut bytes)?;
        let kind = head(&bytes).map_or(0, |head| u32::from_le_bytes(head.kind));
        self.at = at + (HEAD + self.payload.len()) as u64;
        Ok(Some(Frame {
            at: at + HEAD as u64,
            kind,
            payload: &self.payload,
        }))
    }

    /// Whether a whole frame begins at a place; its payload is then at hand.
    fn whole(&mut self, at: u64) -> io::Result<bool> {
        let mut bytes = [0; HEAD];
        if at + HEAD as u64 > self.length {
            return Ok(false);
        }
        self.read(at, &mut bytes)?;
        let Some(FrameHead { length, crc, kind }) = head(&bytes) else {
            return Ok(false);
        };
        let from = at + HEAD as u64;
        if from + length as u64 > self.length {
            return Ok(false);
        }
        let length_le = u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes();
        // bytes that look like many long frames, one within the other, would be read once for each of them
        if self.wasted > self.length && self.summed(length_le, kind, from..from + length as u64)? != crc {
            return Ok(false);
        }
        let mut payload = std::mem::take(&mut self.payload);
        payload.resize(length, 0);
        let read = self.read(from, &mut payload);
        self.payload = payload;
        read?;
        let whole = checksum(length_le, kind, &self.payload) == crc;
        self.wasted += if whole { 0 } else { length as u64 };
        Ok(whole)
    }

    /// The checksum of a frame whose payload lies at a place, without reading it.
    fn summed(&mut self, length: [u8; 4], kind: [u8; 4], payload: Range<u64>) -> io::Result<u32> {
        let sums = match self.sums.take() {
            Some(sums) => sums,
            None => PrefixSums::of(&self.file, self.length)?,
        };
        let of_payload = sums.of_range(&self.file, payload);
        self.sums = Some(sums);
        let mut crc = crc32fast::Hasher::new();
        crc.update(&length);
        crc.update(&kind);
        crc.combine(&of_payload?);
        Ok(crc.finalize())
    }

    /// The next place behind `at` that a frame's mark stands at.
    fn mark_after(&mut self, at: u64) -> io::Result<Option<u64>> {
        let mut from = at + 1;
        while from + MARK.len() as u64 <= self.length {
            let end = self.ahead_at + self.ahead.len() as u64;
            if from < self.ahead_at || from + MARK.len() as u64 > end {
                self.read_ahead(from)?;
            }
            let bytes = &self.ahead[usize::try_from(from - self.ahead_at).unwrap_or(usize::MAX)..];
            if let Some(found) = bytes.windows(MARK.len()).position(|four| four == MARK) {
                return Ok(Some(from + found as u64));
            }
            // a mark may lie across two looks
            from += (bytes.len() - (MARK.len() - 1)) as u64;
        }
        Ok(None)
    }

    /// Reads ahead from a place in the file.
    fn read_ahead(&mut self, at: u64) -> io::Result<()> {
        let many = usize::try_from(self.length - at).map_or(LOOK, |left| left.min(LOOK));
        self.ahead.resize(many, 0);
        self.ahead_at = at;
        self.bytes_read += many as u64;
        self.file.read_exact_at(&mut self.ahead, at)
    }

    /// Reads bytes that are there, by way of those read ahead.
    fn read(&mut self, at: u64, to: &mut [u8]) -> io::Result<()> {
        if to.len() >= LOOK {
            self.bytes_read += to.len() as u64;
            return self.file.read_exact_at(to, at);
        }
        let end = self.ahead_at + self.ahead.len() as u64;
        if at < self.ahead_at || at + to.len() as u64 > end {
            self.read_ahead(at)?;
        }
        let from = usize::try_from(at - self.ahead_at).unwrap_or(usize::MAX);
        to.copy_from_slice(&self.ahead[from..from + to.len()]);
        Ok(())
    }

    fn note(&mut self, from: u64, end: u64, tail: bool) -> io::Result<()> {
        let mut bytes = vec![0; LOOK];
        let (mut at, mut zero) = (from, true);
        while at < end && zero {
            let many = usize::try_from(end - at).map_or(LOOK, |left| left.min(LOOK));
            self.file.read_exact_at(&mut bytes[..many], at)?;
            zero = bytes[..many].iter().all(|byte| *byte == 0);
            at += many as u64;
        }
        self.damages.push(Damage {
            from,
            bytes: end - from,
            tail,
            zero,
        });
        Ok(())
    }
}

/// A payload at a place, checked again: what was whole when it was found may not be any more.
pub(super) fn read_at(file: &File, at: u64, length: u32) -> io::Result<Vec<u8>> {
    let mut bytes = [0; HEAD];
    let damaged = || io::Error::new(io::ErrorKind::InvalidData, format!("damaged at byte {at}"));
    file.read_exact_at(&mut bytes, at - HEAD as u64)?;
    let found = head(&bytes)
        .filter(|head| head.length == length as usize)
        .ok_or_else(damaged)?;
    let mut payload = vec![0; found.length];
    file.read_exact_at(&mut payload, at)?;
    if checksum(length.to_le_bytes(), found.kind, &payload) == found.crc {
        Ok(payload)
    } else {
        Err(damaged())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn written(payloads: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (kind, payload) in (0..).zip(payloads) {
            append(&mut bytes, kind, payload);
        }
        bytes
    }

    /// Kinds and payloads read from bytes, and what was passed over.
    fn read(bytes: &[u8]) -> (Vec<(u32, Vec<u8>)>, Vec<Damage>) {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        let mut frames = Frames::open(file.path(), 0).unwrap();
        let mut found = Vec::new();
        while let Some(frame) = frames.next().unwrap() {
            found.push((frame.kind, frame.payload.to_vec()));
        }
        (found, frames.damages)
    }

    #[test]
    fn heads_of_frames_that_are_none_are_read_a_few_times_and_not_each_to_the_end() {
        let last = written(&[b"last".to_vec()]);
        for (heads, between) in [(4000, 16), (400, 1000), (60, 70_000)] {
            let whole = heads * (HEAD + between) + last.len();
            let mut bytes = Vec::new();
            for _ in 0..heads {
                // to the end of the file, and a checksum that is none
                let length = u32::try_from(whole - bytes.len() - HEAD).unwrap();
                bytes.extend_from_slice(&MARK);
                bytes.extend_from_slice(&length.to_le_bytes());
                bytes.extend_from_slice(&[7; 8]);
                bytes.resize(bytes.len() + between, b'.');
            }
            bytes.extend_from_slice(&last);
            let file = tempfile::NamedTempFile::new().unwrap();
            std::fs::write(file.path(), &bytes).unwrap();
            let mut frames = Frames::open(file.path(), 0).unwrap();
            let found = frames.next().unwrap().map(|frame| frame.payload.to_vec());
            assert_eq!(found.as_deref(), Some(&b"last"[..]));
            assert!(frames.next().unwrap().is_none());
            let times = frames.bytes_read as f64 / bytes.len() as f64;
            assert!(times < 8.0, "{heads} heads: the file was read {times} times");
        }
    }

    /// A frame that is whole is found among heads that are none, by the sums of the file too.
    #[test]
    fn a_whole_frame_among_many_that_are_none_is_found() {
        let mut bytes = Vec::new();
        for round in 0..50_u32 {
            for _ in 0..20 {
                bytes.extend_from_slice(&MARK);
                bytes.extend_from_slice(&5000_u32.to_le_bytes());
                bytes.extend_from_slice(&[1; 8]);
            }
            append(&mut bytes, round, &vec![round as u8; 700]);
        }
        bytes.resize(bytes.len() + 6000, 0);
        let (found, _) = read(&bytes);
        let expected: Vec<(u32, Vec<u8>)> = (0..50).map(|round| (round, vec![round as u8; 700])).collect();
        assert_eq!(found, expected);
    }

    fn payloads() -> impl Strategy<Value = Vec<Vec<u8>>> {
        let small = proptest::collection::vec(any::<u8>(), 0..40);
        let marks = Just(MARK.repeat(3));
        let long = (any::<u8>(), 60_000..140_000_usize).prop_map(|(byte, many)| vec![byte; many]);
        proptest::collection::vec(prop_oneof![8 => small, 2 => marks, 1 => long], 1..8)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn frames_come_back(payloads in payloads()) {
            let (found, damages) = read(&written(&payloads));
            prop_assert_eq!(damages, Vec::new());
            let expected: Vec<(u32, Vec<u8>)> = (0..).zip(payloads).collect();
            prop_assert_eq!(found, expected);
        }

        #[test]
        fn a_flipped_bit_costs_its_own_frame_alone(payloads in payloads(), place in any::<prop::sample::Index>(), bit in 0..8_u32) {
            let mut bytes = written(&payloads);
            let at = place.index(bytes.len());
            bytes[at] ^= 1_u8 << bit;
            let (found, damages) = read(&bytes);
            let mut end = 0;
            let hit = payloads.iter().position(|p| { end += HEAD + p.len(); at < end }).unwrap();
            let expected: Vec<(u32, Vec<u8>)> =
                (0..).zip(payloads).enumerate().filter(|(i, _)| *i != hit).map(|(_, f)| f).collect();
            prop_assert_eq!(found, expected);
            prop_assert_eq!(damages.len(), 1);
        }

        #[test]
        fn a_torn_or_zeroed_end_costs_the_last_frames_alone(payloads in payloads(), place in any::<prop::sample::Index>(), zeros in 0..100_usize) {
            let whole = written(&payloads);
            let keep = place.index(whole.len());
            let mut bytes = whole[..keep].to_vec();
            bytes.extend(vec![0; zeros]);
            let (found, damages) = read(&bytes);
            let (mut end, mut kept) = (0, 0);
            for p in &payloads {
                end += HEAD + p.len();
                // zeros behind a cut may be just what was cut off
                if end <= keep || (end <= bytes.len() && whole[keep..end].iter().all(|byte| *byte == 0)) { kept += 1; } else { break; }
            }
            prop_assert_eq!(found.len(), kept);
            prop_assert!(damages.iter().all(|d| d.tail));
        }
    }

    #[test]
    fn what_is_read_again_is_checked_again() {
        let mut bytes = written(&[vec![1, 2, 3]]);
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), &bytes).unwrap();
        let at = HEAD as u64;
        assert_eq!(read_at(&File::open(file.path()).unwrap(), at, 3).unwrap(), [1, 2, 3]);
        bytes[HEAD + 1] ^= 1;
        std::fs::write(file.path(), &bytes).unwrap();
        assert!(read_at(&File::open(file.path()).unwrap(), at, 3).is_err());
    }
}
