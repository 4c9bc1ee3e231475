//! A log that is read at any instant: an index of its chunks, and those that were read last.
//!
//! The index comes from the heads of the file's records, whether the file has one of its own or not: of a log that was cut, or
//! is still being written, everything up to its end is there. An hour is some 36,000 chunks of 24 bytes each.

use std::collections::{HashMap, VecDeque};
use std::fs::File;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mcap::records::{Record as Entry, op};
use messages::topics::{ForType, with_type};
use messages::{Record, TOPICS, Topic};

use crate::chunk::{self, HEAD};
use crate::composer::channel_name;
use crate::definition::definition;
use crate::error::RecordingError;
use crate::lengths;
use crate::log::{LONGEST_RECORD, Log};

/// \[B\] Of a record as much as the index needs: head and, of the index of a chunk, the number of its channel.
const PEEK: usize = HEAD + 2;
/// \[B\] Memory for chunks that were read; one is kept, however long.
const KEPT: usize = 24 << 20;
/// Topics of a chunk of which the file does not say what is in it.
const UNKNOWN: u64 = u64::MAX;

const _: () = assert!(TOPICS.len() < 64, "topics of a chunk are bits of one number");

/// Chunk as the index knows it.
#[derive(Clone, Copy, Debug)]
struct ChunkPlace {
    /// Place of its record in the file, and length \[B\].
    begin: u64,
    length: usize,
    /// Topics that it holds, one bit each in the order of [`TOPICS`].
    topics: u64,
}

/// Records of our topics in one chunk, in the order of the file.
#[derive(Debug, Default)]
pub struct LogChunk {
    bytes: Vec<u8>,
    /// Topic, and where its payload is.
    messages: Vec<(u8, u32, u32)>,
}

impl LogChunk {
    /// Payloads of a topic, each with the tick in its header.
    pub fn payloads(&self, topic: &Topic) -> impl DoubleEndedIterator<Item = (u64, &[u8])> {
        let wanted = number(topic);
        let of_topic = self.messages.iter().filter(move |(topic, ..)| Some(*topic) == wanted);
        of_topic.filter_map(|&(_, begin, end)| {
            let payload = self.bytes.get(begin as usize..end as usize)?;
            Some((tick(payload)?, payload))
        })
    }
}

/// Tick of a record: the first number behind the encapsulation header.
fn tick(payload: &[u8]) -> Option<u64> {
    payload.get(4..)?.first_chunk().map(|bytes| u64::from_le_bytes(*bytes))
}

fn number(topic: &Topic) -> Option<u8> {
    TOPICS.iter().position(|other| other.name == topic.name).map(|at| at as u8)
}

/// A log on disk, and where its chunks are.
#[derive(Debug)]
pub struct IndexedLog {
    about: Log,
    path: PathBuf,
    file: File,
    chunks: Vec<ChunkPlace>,
    /// Topics of the newest chunk as far as its indexes have been read; none: none was.
    counted: Option<u64>,
    /// \[B\] Where the next record begins.
    scanned: u64,
    complete: bool,
    /// Topic of each channel; none: it is no topic of ours, or has another layout.
    channels: HashMap<u16, Option<u8>>,
    schemas: HashMap<u16, Vec<u8>>,
    other_layouts: Vec<&'static Topic>,
    kept: VecDeque<(usize, Arc<LogChunk>)>,
    /// First tick of the chunks that were asked for it.
    pub(crate) firsts: HashMap<usize, Option<u64>>,
}

impl IndexedLog {
    /// Opens a log and finds its chunks.
    ///
    /// # Errors
    /// The file cannot be read, is no log, or is damaged.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let about = Log::open(path)?;
        let file = File::open(path).map_err(|e| RecordingError::Read(path.into(), e))?;
        let mut log = Self {
            about,
            path: path.into(),
            file,
            chunks: Vec::new(),
            counted: None,
            scanned: mcap::MAGIC.len() as u64,
            complete: false,
            channels: HashMap::new(),
            schemas: HashMap::new(),
            other_layouts: Vec::new(),
            kept: VecDeque::new(),
            firsts: HashMap::new(),
        };
        log.grow()?;
        Ok(log)
    }

    /// Overview of the log: its description of itself.
    pub fn about(&self) -> &Log {
        &self.about
    }

    /// True if it has its end; if not, it was cut or is still being written.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// Topics that were written with another layout than this program's, and are left out.
    pub fn other_layouts(&self) -> &[&'static Topic] {
        &self.other_layouts
    }

    /// Number of chunks.
    pub fn len(&self) -> usize {
        self.chunks.len()
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.chunks.is_empty()
    }

    /// True if a chunk holds records of a topic, or does not say so.
    pub fn holds(&self, chunk: usize, topic: &Topic) -> bool {
        let bit = number(topic).map_or(0, |number| 1 << number);
        self.chunks.get(chunk).is_some_and(|place| place.topics & bit != 0)
    }

    /// Finds the chunks that were written since the last call; whether there are any.
    ///
    /// # Errors
    /// The file cannot be read, or a record is longer than any of ours.
    pub fn grow(&mut self) -> Result<bool, RecordingError> {
        let read = |e| RecordingError::Read(self.path.clone(), e);
        let length = self.file.metadata().map_err(read)?.len();
        let before = self.chunks.len();
        let mut peek = [0; PEEK];
        while !self.complete && self.scanned + PEEK as u64 <= length {
            self.file
                .read_exact_at(&mut peek, self.scanned)
                .map_err(|e| RecordingError::Read(self.path.clone(), e))?;
            let (opcode, size) = (peek[0], u64::from_le_bytes(peek[1..HEAD].try_into().unwrap_or_default()));
            // A record that has not been written to its end is looked at the next time.
            if size > LONGEST_RECORD as u64 {
                return Err(self.damaged(self.scanned, format!("a record claims to be {size} bytes long")));
            }
            let (begin, whole) = (self.scanned, HEAD as u64 + size);
            if begin + whole > length {
                break;
            }
            self.scanned += whole;
            match opcode {
                op::MESSAGE_INDEX => self.count(u16::from_le_bytes([peek[HEAD], peek[HEAD + 1]]))?,
                op::CHUNK => {
                    self.settle()?;
                    self.chunks.push(ChunkPlace { begin, length: whole as usize, topics: UNKNOWN });
                }
                _ => self.settle()?,
            }
            self.complete |= matches!(opcode, op::DATA_END | op::FOOTER);
        }
        Ok(self.chunks.len() > before)
    }

    /// A channel of the newest chunk.
    fn count(&mut self, channel: u16) -> Result<(), RecordingError> {
        if !self.channels.contains_key(&channel) {
            // Channels are described in the first chunk that uses them, if not in one before it.
            self.chunk(self.chunks.len().saturating_sub(1))?;
        }
        let topic = self.channels.get(&channel).copied().flatten();
        *self.counted.get_or_insert(0) |= topic.map_or(0, |topic| 1 << topic);
        Ok(())
    }

    /// The newest chunk has no more indexes. One without any is read: it may be the one that describes the channels.
    fn settle(&mut self) -> Result<(), RecordingError> {
        let newest = self.chunks.len().checked_sub(1);
        let Some(newest) = newest.filter(|&newest| self.chunks[newest].topics == UNKNOWN) else {
            return Ok(());
        };
        let topics = match self.counted.take() {
            Some(topics) => topics,
            None => self.chunk(newest)?.messages.iter().fold(0, |all, (topic, ..)| all | 1 << topic),
        };
        self.chunks[newest].topics = topics;
        Ok(())
    }

    /// A chunk's records.
    ///
    /// # Errors
    /// The file has become shorter, or is damaged.
    pub fn chunk(&mut self, chunk: usize) -> Result<Arc<LogChunk>, RecordingError> {
        if let Some(at) = self.kept.iter().position(|(number, _)| *number == chunk) {
            // Used last, and so given up last.
            let found = self.kept.remove(at);
            self.kept.extend(found);
        } else {
            let read = Arc::new(self.read(chunk)?);
            let mut memory: usize = self.kept.iter().map(|(_, chunk)| chunk.bytes.len()).sum();
            while memory + read.bytes.len() > KEPT
                && let Some((_, oldest)) = self.kept.pop_front()
            {
                memory -= oldest.bytes.len();
            }
            self.kept.push_back((chunk, read));
        }
        self.kept
            .back()
            .map(|(_, chunk)| chunk.clone())
            .ok_or_else(|| self.damaged(self.scanned, "there is no such chunk"))
    }

    /// A chunk from the file.
    fn read(&mut self, chunk: usize) -> Result<LogChunk, RecordingError> {
        let place = self.chunks.get(chunk).copied();
        let place = place.ok_or_else(|| self.damaged(self.scanned, "there is no such chunk"))?;
        let mut bytes = vec![0; place.length];
        let read = self.file.read_exact_at(&mut bytes, place.begin);
        read.map_err(|e| self.damaged(place.begin, format!("{e}, and it was whole when it was opened")))?;
        let mut found = LogChunk::default();
        let taken = chunk::each_record(&bytes, |opcode, data| self.take(opcode, data, &mut found));
        taken.map_err(|why| self.damaged(place.begin, why))?;
        Ok(found)
    }

    /// A record inside of a chunk.
    fn take(&mut self, opcode: u8, data: &[u8], found: &mut LogChunk) -> Result<(), String> {
        if !lengths::is_read(opcode) {
            return Ok(());
        }
        if !lengths::fit(opcode, data) {
            return Err(lengths::LONG_STRING.into());
        }
        match mcap::parse_record(opcode, data).map_err(|e| e.to_string())? {
            Entry::Schema { header, data } => _ = self.schemas.insert(header.id, data.into_owned()),
            Entry::Channel(channel) if !self.channels.contains_key(&channel.id) => {
                let topic = TOPICS.iter().position(|topic| channel_name(topic.name) == channel.topic);
                let theirs = self.schemas.get(&channel.schema_id).map_or(&[][..], Vec::as_slice);
                let fits = |at: &usize| {
                    with_type(TOPICS[*at].name, Definition).is_some_and(|ours| ours.as_bytes() == theirs)
                };
                // The same name with other fields: told, and left out.
                if let Some(at) = topic.filter(|at| !fits(at)) {
                    self.other_layouts.push(&TOPICS[at]);
                }
                self.channels.insert(channel.id, topic.filter(fits).map(|at| at as u8));
            }
            Entry::Message { header, data } => {
                if let Some(Some(topic)) = self.channels.get(&header.channel_id) {
                    let begin = found.bytes.len() as u32;
                    found.bytes.extend_from_slice(&data);
                    found.messages.push((*topic, begin, found.bytes.len() as u32));
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn damaged(&self, byte: u64, why: impl std::fmt::Display) -> RecordingError {
        RecordingError::DamagedAt(self.path.clone(), byte, why.to_string())
    }
}

struct Definition;

impl ForType<String> for Definition {
    fn call<T: Record>(self, _: &'static Topic) -> String {
        definition::<T>()
    }
}
