//! Every target reads its seeds, each cut short and with wrong bytes: the same as libFuzzer does, for a moment only.
//!
//! With `GANGWERK_FUZZ_CORPUS=DIR` it also reads everything in `DIR/TARGET`, and leaves the seeds there.

use fuzzing::TARGETS;
use std::path::PathBuf;

/// Broken variants of each seed.
const VARIANTS: u64 = 200;

/// xorshift
fn next(state: &mut u64) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state as usize
}

/// Cut at any place, with up to four bytes that are others.
fn broken(seed: &[u8], random: &mut u64) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    if next(random).is_multiple_of(4) {
        bytes.truncate(next(random) % (bytes.len() + 1));
    }
    for _ in 0..next(random) % 5 {
        if !bytes.is_empty() {
            let at = next(random) % bytes.len();
            bytes[at] = [next(random) as u8, 0, 0xff, b'9', b'"'][next(random) % 5];
        }
    }
    bytes
}

#[test]
fn seeds_whole_and_broken_are_read_without_a_panic() {
    let corpus = std::env::var_os("GANGWERK_FUZZ_CORPUS").map(PathBuf::from);
    for target in &TARGETS {
        let mut random = 0x9e37_79b9_7f4a_7c15;
        for (n, seed) in (target.seeds)().iter().enumerate() {
            (target.read)(seed);
            // Long ones take long.
            for _ in 0..VARIANTS.min(4_000_000 / (seed.len() as u64 + 1)) {
                (target.read)(&broken(seed, &mut random));
            }
            if let Some(corpus) = &corpus {
                let directory = corpus.join(target.name);
                std::fs::create_dir_all(&directory).unwrap();
                std::fs::write(directory.join(format!("seed_{n}")), seed).unwrap();
            }
        }
        let files = corpus.iter().flat_map(|corpus| std::fs::read_dir(corpus.join(target.name)).unwrap());
        files.for_each(|file| (target.read)(&std::fs::read(file.unwrap().path()).unwrap()));
    }
    let _ = std::fs::remove_dir_all(fuzzing::own_directory());
}
