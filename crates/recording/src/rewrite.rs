//! A log once more, message by message: with an index if it had none, because its writer died; without what is damaged.

use crate::claim;
use crate::error::RecordingError;
use crate::log::{LogContent, LogEnd, walk};
use crate::recorder::{Sink, options};
use crate::salvage::salvage;
use mcap::records::{MessageHeader, Metadata};
use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Outcome of repairing a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Repaired {
    /// Messages that are in it now.
    pub messages: u64,
    /// Reason for its being incomplete, and what is left out of it; none: it was complete, and nothing was done.
    pub found: Option<String>,
    /// Path of the original, if the log was damaged.
    pub original: Option<PathBuf>,
}

/// Gives a log its end and index, if it lacks them: everything up to the cut is kept. Of a damaged one every chunk is kept
/// that is whole, and the file as it was beside it as `LOG.damaged`.
///
/// # Errors
/// The file is no log, it is being written, or there is no room beside it for the new one; then it stays as it was.
pub fn repair(path: &Path) -> Result<Repaired, RecordingError> {
    let log = File::open(path).map_err(|e| RecordingError::Read(path.into(), e))?;
    // Held until the new one has its name: a writer would go on in a file that nobody finds.
    claim::claim(&log, path)?;
    let new = beside(path, ".repair");
    let done = repaired(path, &new);
    if !matches!(done, Ok(Repaired { found: Some(_), .. })) {
        let removed = std::fs::remove_file(&new);
        return done.and_then(|done| removed.map(|()| done).map_err(|e| RecordingError::Create(new, e)));
    }
    let done = done?;
    if let Some(original) = &done.original {
        // A second name first, where there are such: the log is then never without its own.
        std::fs::hard_link(path, original)
            .or_else(|_| std::fs::rename(path, original))
            .map_err(|e| RecordingError::Create(original.clone(), e))?;
    }
    std::fs::rename(&new, path).map_err(|e| RecordingError::Create(path.into(), e))?;
    Ok(done)
}

/// Copy of all that is whole of a log, as `new`: its fault, and the place where it is to go.
fn repaired(path: &Path, new: &Path) -> Result<Repaired, RecordingError> {
    match rewrite(path, new, |_, _| true) {
        Ok((LogEnd::Complete, messages)) => Ok(Repaired { messages, found: None, original: None }),
        Ok((LogEnd::Truncated(_), messages)) => {
            Ok(Repaired { messages, found: Some("it ended in the middle".into()), original: None })
        }
        Err(RecordingError::Damaged(..)) => {
            let original = beside(path, ".damaged");
            if original.exists() {
                return Err(RecordingError::OriginalKept(original));
            }
            let (left_out, messages) = copy(new, |_, _| true, |see| salvage(path, see))?;
            Ok(Repaired { messages, found: Some(left_out.to_string()), original: Some(original) })
        }
        Err(e) => Err(e),
    }
}

/// The file of that name with this behind it.
fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// Copies a log; `edit` sees name of the channel and payload of each message, may change the payload, and
/// says whether the message is kept. What stands before
/// a damage is written, too, before that is an error. Returns how `from` ended, and the number of messages.
///
/// # Errors
/// `from` is no log or damaged, or `to` cannot be written.
pub fn rewrite(
    from: &Path,
    to: &Path,
    edit: impl FnMut(&str, &mut Vec<u8>) -> bool,
) -> Result<(LogEnd, u64), RecordingError> {
    copy(to, edit, |see| walk(from, see))
}

/// Writes what `read` shows of a log; what it returns, and the number of messages.
fn copy<T>(
    to: &Path,
    mut edit: impl FnMut(&str, &mut Vec<u8>) -> bool,
    read: impl FnOnce(&mut dyn FnMut(LogContent<'_>) -> ControlFlow<()>) -> Result<T, RecordingError>,
) -> Result<(T, u64), RecordingError> {
    let sink: Box<dyn Sink> = Box::new(BufWriter::new(claim::create(to)?));
    let mut mcap = options().create(sink).map_err(RecordingError::write)?;
    let mut schemas = HashMap::new();
    let mut channels: HashMap<String, u16> = HashMap::new();
    let (mut payload, mut messages, mut failed) = (Vec::new(), 0, None);
    let done = read(&mut |seen: LogContent<'_>| {
        let written = match seen {
            LogContent::Metadata(name, map) => {
                mcap.write_metadata(&Metadata { name: name.into(), metadata: map.clone() })
            }
            LogContent::Attachment(name, bytes) => mcap.attach(&mcap::Attachment {
                log_time: 0,
                create_time: 0,
                name: name.into(),
                media_type: "text/plain".into(),
                data: bytes.into(),
            }),
            // Numbers of schemas and channels are given anew by the writer.
            LogContent::Schema(header, data) => mcap
                .add_schema(&header.name, &header.encoding, data)
                .map(|id| _ = schemas.insert(header.id, id)),
            LogContent::Channel(channel) => {
                let schema = schemas.get(&channel.schema_id).copied().unwrap_or(0);
                let metadata: &BTreeMap<String, String> = &channel.metadata;
                mcap.add_channel(schema, &channel.topic, &channel.message_encoding, metadata)
                    .map(|id| _ = channels.insert(channel.topic.clone(), id))
            }
            LogContent::Message(message) => {
                messages += 1;
                payload.clear();
                payload.extend_from_slice(message.payload);
                if !edit(message.channel, &mut payload) {
                    return ControlFlow::Continue(());
                }
                let header = MessageHeader {
                    channel_id: channels.get(message.channel).copied().unwrap_or(0),
                    sequence: message.number,
                    log_time: message.log_time_ns,
                    publish_time: message.log_time_ns,
                };
                mcap.write_to_known_channel(&header, &payload)
            }
        };
        // The first failed write ends the walk; its error is kept, since the walk reports only its own.
        failed = written.err();
        if failed.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    if let Some(error) = failed {
        return Err(RecordingError::write(error));
    }
    mcap.finish().map_err(RecordingError::write)?;
    mcap.into_inner().flush().map_err(RecordingError::write)?;
    Ok((done?, messages))
}
