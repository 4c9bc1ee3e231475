//! Readers of bytes from outside, each behind a function that takes any bytes: what libFuzzer calls, and
//! `tests/seeds.rs` with a few thousand bytes of its own. None panics, hangs or asks for memory that the bytes do not pay.

mod datagram;
mod files;
mod frame;
mod pages;
mod telegram;
mod text;

use std::path::PathBuf;

/// One reader.
pub struct Target {
    /// Its name, also that of its libFuzzer target.
    pub name: &'static str,
    /// Reads any bytes, and looks at what came out.
    pub read: fn(&[u8]),
    /// Bytes to begin with.
    pub seeds: fn() -> Vec<Vec<u8>>,
}

/// All of them.
pub const TARGETS: [Target; 12] = [
    Target { name: "command", read: text::command, seeds: text::command_seeds },
    Target { name: "command_text", read: text::command_text, seeds: text::command_text_seeds },
    Target { name: "frame", read: frame::frame, seeds: frame::seeds },
    Target { name: "candump", read: text::candump, seeds: text::candump_seeds },
    Target { name: "mcap", read: files::mcap, seeds: files::mcap_seeds },
    Target { name: "dbc", read: text::dbc, seeds: text::dbc_seeds },
    Target { name: "telegram", read: telegram::telegram, seeds: telegram::seeds },
    Target { name: "datagram", read: datagram::datagram, seeds: datagram::seeds },
    Target { name: "run_file", read: text::run_file, seeds: text::run_file_seeds },
    Target { name: "page", read: pages::page, seeds: pages::page_seeds },
    Target { name: "viewer", read: pages::viewer, seeds: pages::viewer_seeds },
    Target { name: "scene", read: files::scene, seeds: files::scene_seeds },
];

/// Reads `bytes` as the target of this name does.
///
/// # Panics
/// There is no such target, or it has an error.
pub fn read(name: &str, bytes: &[u8]) {
    let target = TARGETS.iter().find(|t| t.name == name);
    (target.unwrap_or_else(|| panic!("there is no target {name}")).read)(bytes);
}

/// The next byte of `bytes`.
fn byte(bytes: &mut &[u8]) -> Option<u8> {
    let (first, rest) = bytes.split_first()?;
    *bytes = rest;
    Some(*first)
}

/// As many bytes as the next byte, times `unit`, says, and are there.
fn chunk<'a>(bytes: &mut &'a [u8], unit: usize) -> &'a [u8] {
    let wanted = unit * usize::from(byte(bytes).unwrap_or(0));
    let (chunk, rest) = bytes.split_at(wanted.min(bytes.len()));
    *bytes = rest;
    chunk
}

/// A directory of this process, in memory; whoever reads with these targets removes it.
pub fn own_directory() -> PathBuf {
    let path = PathBuf::from(format!("/dev/shm/gangwerk-fuzz-{}", std::process::id()));
    let _ = std::fs::create_dir_all(&path);
    path
}
