//! Samples of a stretch of a log: chunk by chunk through the plots of a running robot, so that nobody waits for a long one.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

use messages::{Record, Topic};
use recording::cdr::decode;
use recording::{LogChunk, RecordingError};

use crate::plotting::{Follow, Numbers, Opened, Plot, Source, Taps};
use crate::replay::film::Film;

/// Most rows of one stretch; of a longer one fewer rows per second are sent.
const MOST_ROWS: u64 = 60_000;
/// Chunks before the stretch from which topics that are written less often have their first value.
const BEFORE: usize = 2;

/// The chunk that is played to all followers.
#[derive(Clone, Default)]
struct Reel(Rc<RefCell<Option<Arc<LogChunk>>>>);

impl Source for Reel {
    fn open<T: Record>(&self, topic: &'static Topic) -> Opened {
        Ok((Box::new(Unwound { topic, reel: self.clone(), _record: std::marker::PhantomData::<T> }), 0))
    }
}

/// One topic of the reel.
struct Unwound<T> {
    topic: &'static Topic,
    reel: Reel,
    _record: std::marker::PhantomData<T>,
}

impl<T: Record> Follow for Unwound<T> {
    fn follow(&mut self, places: &[usize], every: u64, new: &mut Numbers) {
        let chunk = self.reel.0.borrow();
        let payloads = chunk.iter().flat_map(|chunk| chunk.payloads(self.topic));
        // The newest record counts whether its numbers are asked for or not.
        for record in payloads.filter_map(|(_, payload)| decode::<T>(payload)) {
            new.take(&record, places, every);
        }
    }
}

/// A stretch that is on its way to a page.
pub(super) struct Window {
    /// As it was asked for \[s\].
    pub(super) asked: [f64; 2],
    /// Rows that were sent.
    pub(super) rows: usize,
    plot: Plot,
    taps: Taps,
    reel: Reel,
    /// The next chunk, and the last one; none: it has not been looked for.
    chunks: Option<(usize, usize)>,
    ticks: (u64, u64),
}

impl Window {
    /// Of these fields, as far as the log has them, at `rate` \[1/s\].
    ///
    /// # Errors
    /// No topic of them can be read.
    pub(super) fn new(film: &Film, asked: [f64; 2], fields: &[String], rate: f64) -> Result<Self, String> {
        let ticks = (film.tick(asked[0]), film.tick(asked[1] - film.cycle()));
        let plot = Plot::new(fields.to_vec(), rate, film.cycle(), &film.fields)?;
        let plot = plot.within(ticks.0, ticks.1, MOST_ROWS);
        let (mut taps, reel) = (Taps::default(), Reel::default());
        taps.follow(&reel, std::iter::once(&plot)).map_err(|e| e.to_string())?;
        Ok(Self { asked, rows: 0, plot, taps, reel, chunks: None, ticks })
    }

    /// Plays one more chunk: content of a frame and tick of its last row, if there are rows; `Err(None)`: it is done.
    ///
    /// # Errors
    /// The file has become shorter, or is damaged there.
    #[allow(clippy::type_complexity)]
    pub(super) fn step(&mut self, film: &mut Film) -> Result<Option<(u64, Vec<u8>)>, Option<RecordingError>> {
        let (next, last) = match self.chunks {
            Some(chunks) => chunks,
            None => {
                let begin = film.chunk_at(self.ticks.0).saturating_sub(BEFORE);
                // One more: rows wait for topics that are late.
                (begin, (film.chunk_at(self.ticks.1) + 1).min(film.chunks().saturating_sub(1)))
            }
        };
        self.chunks = Some((next + 1, last));
        let frame = if next <= last {
            *self.reel.0.borrow_mut() = Some(film.chunk(next)?);
            self.taps.look();
            self.taps.samples(&mut self.plot, film.cycle())
        } else {
            // What is left, at once; then nothing.
            Some(self.taps.rest(&mut self.plot, film.cycle()).ok_or(None)?)
        };
        self.rows +=
            frame.as_ref().map_or(0, |(_, bytes)| usize::from(u16::from_le_bytes([bytes[2], bytes[3]])));
        Ok(frame)
    }
}
