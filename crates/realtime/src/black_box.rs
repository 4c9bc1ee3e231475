//! The last seconds of a process in memory that outlives it: what it leaves when it dies, by whatever cause. The memory is
//! that of whoever started it ([`memory`]), or, if nobody gave it any, a file.
//!
//! A ring of entries (kind, tick, bytes) behind [`LastWords`]. Writing is copying: no system call, no lock, no allocation.
//! The pages belong to the kernel as soon as they are written, so that who survives finds them; `tail` moves before what it
//! pointed at is written over, and `head` after the new entry is whole, so that a process killed between any two
//! instructions leaves whole entries.

use crate::last_words::LastWords;
use messages::Record;
use rustix::fs::{MemfdFlags, fallocate, memfd_create};
use rustix::mm::{MapFlags, ProtFlags, mmap, munmap};
use std::fs::File;
use std::io::{Error, ErrorKind, Result};
use std::os::fd::AsFd;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering::Acquire, Ordering::Relaxed, Ordering::Release};

/// Says that a file is one.
const MAGIC: u64 = u64::from_le_bytes(*b"gangbox1");
/// Room for what stands before the ring \[B\].
const FRONT: usize = 4096;
/// An entry begins with its length and kind (4 bytes each) and its tick (8 bytes).
const HEAD: usize = 16;

/// Header before the ring.
#[repr(C)]
struct Front {
    magic: u64,
    /// Size of the ring \[B\].
    size: u64,
    /// Bytes written so far, and where the oldest entry begins.
    head: AtomicU64,
    tail: AtomicU64,
    cycle: AtomicU64,
    begun_ns: AtomicU64,
    ended_ns: AtomicU64,
    words: LastWords,
}

const _: () = assert!(size_of::<Front>() <= FRONT);

/// The writer's side.
#[derive(Debug)]
pub struct BlackBox {
    map: Map,
    size: usize,
    head: u64,
    tail: u64,
}

/// One entry of a box that was left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlackBoxEntry {
    /// Kind, as the writer said.
    pub kind: u32,
    /// \[1\] Tick of the cycle.
    pub tick: u64,
    /// The bytes, without zeros at their end.
    pub bytes: Vec<u8>,
}

/// Content of a black box.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Left {
    /// The ring, oldest first.
    pub entries: Vec<BlackBoxEntry>,
    /// \[1\] Cycles begun.
    pub cycles: u64,
    /// \[ns\] CLOCK_MONOTONIC when the last one began, and when the last whole one ended.
    pub begun_ns: u64,
    /// See `begun_ns`.
    pub ended_ns: u64,
    /// Signal that was handled; 0: none.
    pub signal: u64,
    /// Address that was touched in vain.
    pub address: u64,
    /// Message of a panic.
    pub message: String,
    /// Return addresses, innermost first, as offsets from [`crate::last_words::anchor`] of the same program.
    pub frames: Vec<i64>,
}

/// Memory for the box of a process that is to be started, as its standard input: no part of `/dev/shm`, which is small in
/// containers.
///
/// # Errors
/// The kernel gives none.
pub fn memory() -> Result<File> {
    Ok(memfd_create("gangwerk-box", MemfdFlags::CLOEXEC)?.into())
}

/// Standard input, if it is such memory: empty, ours, and without a name.
fn given() -> Option<File> {
    let file = File::from(std::io::stdin().as_fd().try_clone_to_owned().ok()?);
    let seen = file.metadata().ok()?;
    let ours = seen.is_file() && seen.len() == 0 && seen.nlink() == 0;
    (ours && seen.uid() == rustix::process::getuid().as_raw()).then_some(file)
}

/// For a process without cycles: a box that holds its last words only.
///
/// # Errors
/// See [`BlackBox::create`].
pub fn say_last_words(path: &Path) -> Result<()> {
    let kept: &'static mut BlackBox = Box::leak(Box::new(BlackBox::create(path, 8)?));
    kept.last_words().listen();
    Ok(())
}

impl BlackBox {
    /// A ring of `size` bytes in the memory that came as standard input, or in a new file; touches all of it. Allocates
    /// nothing later.
    ///
    /// # Errors
    /// There is no room, or the file cannot be mapped.
    pub fn create(path: &Path, size: usize) -> Result<Self> {
        let size = size.next_multiple_of(8);
        let file = given().map_or_else(
            || {
                let _ = std::fs::remove_file(path);
                File::options().read(true).write(true).create_new(true).mode(0o600).open(path)
            },
            Ok,
        )?;
        // Now, and not when the page is first written: that would be SIGBUS on a full tmpfs.
        fallocate(&file, rustix::fs::FallocateFlags::empty(), 0, (FRONT + size) as u64)?;
        let map = Map::of(&file, FRONT + size)?;
        let front: *mut Front = map.at.cast();
        // SAFETY: the mapping is writable, page-aligned, longer than a `Front`, zeroed, and nobody else knows it yet.
        unsafe {
            (*front).magic = MAGIC;
            (*front).size = size as u64;
        }
        Ok(Self { map, size, head: 0, tail: 0 })
    }

    /// Memory for the last words of a dying process: of a box that is leaked, and lives as long as the process.
    pub fn last_words(self: &&'static mut Self) -> &'static LastWords {
        // SAFETY: as in `front`; the box is leaked, so its mapping stays.
        unsafe { &(*self.map.at.cast::<Front>()).words }
    }

    fn front(&self) -> &Front {
        // SAFETY: `create` made it there; all that is changed later are atomics.
        unsafe { &*self.map.at.cast::<Front>() }
    }

    /// A cycle begins.
    pub fn begin(&mut self, now_ns: u64) {
        self.front().begun_ns.store(now_ns, Relaxed);
        self.front().cycle.fetch_add(1, Relaxed);
    }

    /// It ended.
    pub fn end(&mut self, now_ns: u64) {
        self.front().ended_ns.store(now_ns, Relaxed);
    }

    /// Appends an entry; zeros at its end are left out. One that is longer than the ring is dropped.
    pub fn keep<T: Copy>(&mut self, kind: u32, tick: u64, value: &T) {
        // SAFETY: `value` is valid for its size; bytes of padding, which records do not have, would only be copied.
        let bytes = unsafe { std::slice::from_raw_parts((&raw const *value).cast::<u8>(), size_of::<T>()) };
        let used = bytes.rchunks(8).position(|chunk| chunk.iter().any(|b| *b != 0));
        let bytes = &bytes[..used.map_or(0, |zeros| bytes.len() - 8 * zeros)];
        let len = (HEAD + bytes.len()).next_multiple_of(8);
        if len > self.size {
            return;
        }
        while self.head + len as u64 - self.tail > self.size as u64 {
            let mut head = [0; 8];
            self.map.read(self.size, self.tail, &mut head);
            let [a, b, c, d, ..] = head;
            self.tail += (HEAD as u64 + u64::from(u32::from_le_bytes([a, b, c, d]))).next_multiple_of(8);
        }
        // Release: what is written next must not be seen before the tail has moved.
        self.front().tail.store(self.tail, Release);
        std::sync::atomic::fence(std::sync::atomic::Ordering::SeqCst);
        let mut head = [0; HEAD];
        head[..4].copy_from_slice(&(bytes.len() as u32).to_le_bytes());
        head[4..8].copy_from_slice(&kind.to_le_bytes());
        head[8..].copy_from_slice(&tick.to_le_bytes());
        self.map.write(self.size, self.head, &head);
        self.map.write(self.size, self.head + HEAD as u64, bytes);
        self.head += len as u64;
        self.front().head.store(self.head, Release);
    }
}

impl BlackBoxEntry {
    /// The record that was kept; zeros at its end were left out.
    pub fn record<T: Record>(&self) -> T {
        let mut record = T::empty();
        let len = self.bytes.len().min(size_of::<T>());
        // SAFETY: the record is writable and at least `len` bytes long; records are made of numbers and arrays of numbers,
        // for which any bytes are a value.
        unsafe { (&raw mut record).cast::<u8>().copy_from_nonoverlapping(self.bytes.as_ptr(), len) };
        record
    }
}

impl Left {
    /// Reads what a process left in a file, alive or dead.
    ///
    /// # Errors
    /// There is no such file, or it is none.
    pub fn read(path: &Path) -> Result<Self> {
        Self::of(&File::options().read(true).write(true).open(path)?)
    }

    /// Reads what a process left in its memory.
    ///
    /// # Errors
    /// It has not made its box yet.
    pub fn of(file: &File) -> Result<Self> {
        let len = file.metadata()?.len() as usize;
        let broken = |what| Error::new(ErrorKind::InvalidData, what);
        if len < FRONT {
            return Err(broken("too short"));
        }
        let map = Map::of(file, len)?;
        // SAFETY: the mapping is at least as long as a `Front`, page-aligned, and any bytes are one: integers.
        let front = unsafe { &*map.at.cast::<Front>() };
        if front.magic != MAGIC || front.size as usize != len - FRONT {
            return Err(broken("not one of these files"));
        }
        let (size, head) = (len - FRONT, front.head.load(Acquire));
        let mut at = front.tail.load(Acquire);
        let mut entries = Vec::new();
        while at < head {
            let mut start = [0; HEAD];
            map.read(size, at, &mut start);
            let [a, b, c, d, e, f, g, h, tick @ ..] = start;
            let n = u32::from_le_bytes([a, b, c, d]) as usize;
            if HEAD + n > size {
                return Err(broken("an entry is longer than the ring"));
            }
            let mut bytes = vec![0; n];
            map.read(size, at + HEAD as u64, &mut bytes);
            entries.push(BlackBoxEntry {
                kind: u32::from_le_bytes([e, f, g, h]),
                tick: u64::from_le_bytes(tick),
                bytes,
            });
            at += (HEAD + n).next_multiple_of(8) as u64;
        }
        let words = &front.words;
        Ok(Self {
            entries,
            cycles: front.cycle.load(Relaxed),
            begun_ns: front.begun_ns.load(Relaxed),
            ended_ns: front.ended_ns.load(Relaxed),
            signal: words.signal(),
            address: words.address(),
            message: words.message(),
            frames: words.frames(),
        })
    }
}

/// A shared mapping of a file.
#[derive(Debug)]
struct Map {
    at: *mut u8,
    len: usize,
}

// SAFETY: the pointer is to memory of this mapping only, which any thread may touch; writing takes `&mut BlackBox`.
unsafe impl Send for Map {}

impl Map {
    fn of(file: &File, len: usize) -> Result<Self> {
        // SAFETY: a new mapping at an address of the kernel's choice touches no other memory.
        let at = unsafe {
            mmap(
                std::ptr::null_mut(),
                len,
                ProtFlags::READ | ProtFlags::WRITE,
                MapFlags::SHARED | MapFlags::POPULATE,
                file,
                0,
            )?
        };
        Ok(Self { at: at.cast(), len })
    }

    /// Writes at place `at` of the endless ring.
    fn write(&self, size: usize, at: u64, bytes: &[u8]) {
        let at = (at % size as u64) as usize;
        let first = bytes.len().min(size - at);
        // SAFETY: `at < size` and `bytes.len() <= size`, so both parts lie in the ring, which lies behind the front in the
        // mapping; the source is no part of it.
        unsafe {
            self.at.add(FRONT + at).copy_from_nonoverlapping(bytes.as_ptr(), first);
            self.at.add(FRONT).copy_from_nonoverlapping(bytes[first..].as_ptr(), bytes.len() - first);
        }
    }

    fn read(&self, size: usize, at: u64, bytes: &mut [u8]) {
        let at = (at % size as u64) as usize;
        let first = bytes.len().min(size - at);
        // SAFETY: as in `write`, the other way round.
        unsafe {
            bytes.as_mut_ptr().copy_from_nonoverlapping(self.at.add(FRONT + at), first);
            bytes[first..].as_mut_ptr().copy_from_nonoverlapping(self.at.add(FRONT), bytes.len() - first);
        }
    }
}

impl Drop for Map {
    fn drop(&mut self) {
        // SAFETY: this mapping was made in `of` and its pointer goes with it.
        let _ = unsafe { munmap(self.at.cast(), self.len) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(name: &str) -> std::path::PathBuf {
        std::env::temp_dir().join(format!("gangwerk-box-{name}-{}", std::process::id()))
    }

    #[test]
    fn the_newest_entries_are_left_whole_and_in_order() {
        let path = path("ring");
        let mut ring = BlackBox::create(&path, 1000).unwrap();
        for tick in 1..=500u64 {
            let value = [tick, tick << 32, if tick.is_multiple_of(3) { 7 } else { 0 }, 0];
            ring.keep(tick as u32 % 4, tick, &value);
            let left = Left::read(&path).unwrap().entries;
            let last = left.last().unwrap();
            assert_eq!((last.tick, last.kind), (tick, tick as u32 % 4));
            assert!(left.windows(2).all(|w| w[1].tick == w[0].tick + 1), "{tick}");
            assert!(left.len() as u64 >= tick.min(20), "{} entries at {tick}", left.len());
            for entry in left {
                let mut bytes = [0; 32];
                bytes[..entry.bytes.len()].copy_from_slice(&entry.bytes);
                assert_eq!(bytes[..8], entry.tick.to_le_bytes());
                assert_eq!(bytes[8..16], (entry.tick << 32).to_le_bytes());
                assert_eq!(entry.bytes.len(), if entry.tick.is_multiple_of(3) { 24 } else { 16 });
            }
        }
        ring.keep(1, 501, &[1u8; 2000]); // has no room, and does no harm
        assert_eq!(Left::read(&path).unwrap().entries.last().unwrap().tick, 500);
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn another_file_is_refused() {
        let path = path("other");
        std::fs::write(&path, vec![1; 9000]).unwrap();
        assert!(Left::read(&path).is_err());
        std::fs::write(&path, b"short").unwrap();
        assert!(Left::read(&path).is_err());
        std::fs::remove_file(path).unwrap();
    }
}
