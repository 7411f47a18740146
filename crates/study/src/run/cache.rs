//! Operators on disk, so that a bridge's modes are found once.
//!
//! Knows a folder, names made of what an operator depends on, and how a file proves to be whole. Does not know how an
//! operator is built. Whatever is wrong with a file, the operator is built again and the file replaced.

use etcetera::BaseStrategy;
use pontoon_core::bridge::Bridge;
use pontoon_core::operator::{BridgeOperator, OperatorParts, SOURCES};
use pontoon_journal::place::HiddenFile;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// First bytes of a file, the last of them the version of its form.
const MAGIC: &[u8; 16] = b"pontoon-operator";
const FORM: u64 = 1;

/// Files that are kept; the ones not used for longest go first.
const KEPT: usize = 32;

/// A folder of operators.
#[derive(Debug, Clone)]
pub struct Cache {
    folder: PathBuf,
}

/// What came of a look into the cache.
#[derive(Debug)]
pub(super) enum CacheLookup {
    /// The operator.
    Whole(Box<BridgeOperator>),
    /// No file of that name.
    Nothing,
    /// A file that is damaged or not of this form.
    Refused,
}

impl Cache {
    /// The cache in a folder, which is made when first written to.
    pub fn at(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
        }
    }

    /// The user's: `$PONTOON_CACHE_DIR`, none where that is empty; else `pontoon` in the folder of the user's caches, which on
    /// Linux is `$XDG_CACHE_HOME`, else `~/.cache`. What is empty or no absolute path counts as not set.
    pub fn of_user() -> Option<Self> {
        if let Some(stated) = std::env::var_os("PONTOON_CACHE_DIR").map(PathBuf::from) {
            return (!stated.as_os_str().is_empty()).then_some(Self { folder: stated });
        }
        let base = etcetera::choose_base_strategy().ok()?.cache_dir();
        base.is_absolute().then(|| Self {
            folder: base.join("pontoon"),
        })
    }

    /// The name of what depends on `text` and on the program's mechanics.
    pub(super) fn name(text: &str) -> String {
        blake3::hash(format!("{FORM} {SOURCES} {text}").as_bytes())
            .to_hex()
            .to_string()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.operator"))
    }

    /// The operator of a name.
    pub(super) fn read(&self, name: &str, bridge: &Bridge) -> CacheLookup {
        let path = self.path(name);
        let Ok(bytes) = fs::read(&path) else {
            return CacheLookup::Nothing;
        };
        match decode(name, &bytes).and_then(|parts| parts.operator(bridge)) {
            Some(operator) => {
                // used now; where that cannot be noted, it goes earlier than it might
                let now = fs::File::options().append(true).open(&path);
                let _ = now.and_then(|file| file.set_modified(std::time::SystemTime::now()));
                CacheLookup::Whole(Box::new(operator))
            }
            None => CacheLookup::Refused,
        }
    }

    /// Keeps an operator. A cache that cannot be written costs time, no result: the error is for whoever wants to know.
    pub(super) fn write(&self, name: &str, operator: &BridgeOperator) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let hidden = HiddenFile::begin_among_others(&self.path(name))?;
        hidden.file().write_all(&encode(name, &OperatorParts::of(operator)))?;
        hidden.file().sync_all()?;
        hidden.put()?;
        self.thin_out()
    }

    fn thin_out(&self) -> io::Result<()> {
        let mut files = Vec::new();
        for entry in fs::read_dir(&self.folder)?.filter_map(Result::ok) {
            let path = entry.path();
            if path.extension().is_some_and(|e| e == "operator") {
                files.push((entry.metadata()?.modified()?, path));
            }
        }
        files.sort();
        for (_, path) in files.iter().rev().skip(KEPT) {
            fs::remove_file(path)?;
        }
        Ok(())
    }
}

/// Magic, form, name, counts, numbers, and the hash of all before it.
fn encode(name: &str, parts: &OperatorParts) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    let mut number = |n: u64| bytes.extend(n.to_le_bytes());
    number(FORM);
    number(name.len() as u64);
    number(parts.counts.len() as u64);
    number(parts.numbers.len() as u64);
    bytes.extend(name.as_bytes());
    bytes.extend(parts.counts.iter().flat_map(|n| n.to_le_bytes()));
    bytes.extend(parts.numbers.iter().flat_map(|x| x.to_le_bytes()));
    let hash = blake3::hash(&bytes);
    bytes.extend(hash.as_bytes());
    bytes
}

/// The parts, where the bytes are whole, of this form and of this name.
fn decode(name: &str, bytes: &[u8]) -> Option<OperatorParts> {
    let (content, told) = bytes.split_at_checked(bytes.len().checked_sub(blake3::OUT_LEN)?)?;
    if blake3::hash(content).as_bytes() != told {
        return None;
    }
    let rest = content.strip_prefix(MAGIC)?;
    let (head, rest) = rest.split_at_checked(32)?;
    let head: Vec<u64> = head.as_chunks::<8>().0.iter().map(|b| u64::from_le_bytes(*b)).collect();
    let sizes = head[1..]
        .iter()
        .map(|&n| usize::try_from(n).ok())
        .collect::<Option<Vec<_>>>()?;
    let (own, rest) = rest.split_at_checked(sizes[0])?;
    let (counts, numbers) = rest.split_at_checked(sizes[1].checked_mul(8)?)?;
    let whole = head[0] == FORM && own == name.as_bytes() && numbers.len() == sizes[2].checked_mul(8)?;
    whole.then(|| OperatorParts {
        counts: counts
            .as_chunks::<8>()
            .0
            .iter()
            .map(|b| u64::from_le_bytes(*b))
            .collect(),
        numbers: numbers
            .as_chunks::<8>()
            .0
            .iter()
            .map(|b| f64::from_le_bytes(*b))
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts() -> OperatorParts {
        OperatorParts {
            counts: vec![3, 0, 7],
            numbers: vec![1.0, -0.0, f64::MIN_POSITIVE, 0.1 + 0.2],
        }
    }

    #[test]
    fn parts_are_read_back_to_the_last_bit() {
        let bytes = encode("n", &parts());
        let found = decode("n", &bytes).unwrap();
        assert_eq!(found, parts());
        assert!(found.numbers[1].is_sign_negative());
    }

    #[test]
    fn every_flipped_or_missing_byte_and_another_name_are_refused() {
        let bytes = encode("n", &parts());
        for i in 0..bytes.len() {
            let mut flipped = bytes.clone();
            flipped[i] ^= 1;
            assert_eq!(decode("n", &flipped), None, "byte {i} flipped");
            assert_eq!(decode("n", &bytes[..i]), None, "cut at {i}");
        }
        assert_eq!(decode("m", &bytes), None);
    }
}
