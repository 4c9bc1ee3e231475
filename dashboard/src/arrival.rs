//! Arrival of messages: since when each of them may have waited for this server to read it.
//!
//! A server that stood still, or had no processor, finds what came meanwhile, and no message says when. What the page that sent it
//! wanted then is not what it wants now, so its age counts from before the standstill: the thread of the sockets beats, and has looked
//! at all of them between two beats. What came later than a look came after the beat before the last one. What is read without
//! waiting may have come with the message before it.
//!
//! This is the time in the server. What a message lost on its way here (a tunnel that stalled) nobody knows.

use std::future::poll_fn;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;

use futures_util::{Stream, StreamExt};
use messages::command_stamp::MAX_AGE;
use realtime::clock::now;
use tokio::task::unconstrained;

/// Between two beats: with two of them a message is still far from too old.
const BEAT: Duration = Duration::from_millis(20);

/// Times of the last two beats \[ns\].
#[derive(Debug)]
pub struct Beats {
    last: AtomicU64,
    before: AtomicU64,
}

impl Beats {
    /// Of a thread that has read nothing yet.
    pub fn new(now: u64) -> Self {
        Self { last: now.into(), before: now.into() }
    }

    /// Beats for ever. Each beat waits, and while it waits the sockets are looked at.
    pub async fn keep(&self) {
        loop {
            tokio::time::sleep(BEAT).await;
            self.beat(now());
        }
    }

    fn beat(&self, now: u64) {
        self.before.store(self.last.swap(now, Relaxed), Relaxed);
    }

    /// Time before which nothing came that is found now \[ns\].
    fn since(&self) -> u64 {
        self.before.load(Relaxed)
    }
}

/// Messages of a socket.
pub(crate) struct Arrivals<S> {
    stream: S,
    beats: Arc<Beats>,
    since: u64,
}

impl<S: Stream + Unpin> Arrivals<S> {
    /// Of a socket that has just been opened.
    pub(crate) fn new(stream: S, beats: Arc<Beats>) -> Self {
        let since = beats.since();
        Self { stream, beats, since }
    }

    /// The next message, and since when it may have waited \[ns\].
    pub(crate) async fn next(&mut self) -> Option<(S::Item, u64)> {
        let mut waited = false;
        let message = poll_fn(|context| {
            let polled = self.stream.poll_next_unpin(context);
            waited |= polled.is_pending();
            polled
        });
        // Unconstrained: who has to wait does so because nothing is there, and not because it is another one's turn.
        let message = unconstrained(message).await?;
        if waited {
            self.since = self.beats.since();
        }
        Some((message, self.since))
    }
}

/// Why something that may have waited since then is not done any more; none: it is young enough.
pub(crate) fn too_old(since: u64) -> Option<String> {
    let age = now().saturating_sub(since);
    let ms = |ns: u64| ns / 1_000_000;
    (age > MAX_AGE).then(|| {
        format!(
            "it may be {} ms old, and nothing older than {} ms moves her: the dashboard's server stood still; give it again",
            ms(age),
            ms(MAX_AGE)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tokio::sync::mpsc::unbounded_channel;

    /// The server stands still from 40 on; meanwhile three messages come.
    #[tokio::test]
    async fn what_came_while_the_server_stood_still_is_as_old_as_that() {
        let beats = Arc::new(Beats::new(0));
        let (way, mut fed) = unbounded_channel();
        let stream = futures_util::stream::poll_fn(move |context| fed.poll_recv(context));
        let mut arrivals = Arrivals::new(stream, beats.clone());
        [20, 40].iter().for_each(|now| beats.beat(*now));
        let stands = async {
            (1..=3).for_each(|message| way.send(message).unwrap());
            beats.beat(5000);
        };
        let (first, ()) = tokio::join!(arrivals.next(), stands);
        assert_eq!(first, Some((1, 40)), "waited for; the beat of 5000 came after it");
        // The server beats again before it has read all.
        [5020, 5040].iter().for_each(|now| beats.beat(*now));
        assert_eq!(arrivals.next().await, Some((2, 40)));
        assert_eq!(arrivals.next().await, Some((3, 40)));
        // What is waited for now was not there before.
        let (next, ()) = tokio::join!(arrivals.next(), async { way.send(4).unwrap() });
        assert_eq!(next, Some((4, 5020)));
    }

    /// However many are there: tokio lets a task wait now and then, which does not mean that nothing is left.
    #[tokio::test]
    async fn many_messages_are_as_old_as_the_first_one() {
        let beats = Arc::new(Beats::new(0));
        let (way, mut fed) = unbounded_channel();
        (0..1000).for_each(|message| way.send(message).unwrap());
        let stream = futures_util::stream::poll_fn(move |context| fed.poll_recv(context));
        let mut arrivals = Arrivals::new(stream, beats.clone());
        [5000, 5020].iter().for_each(|now| beats.beat(*now));
        for message in 0..1000 {
            assert_eq!(arrivals.next().await, Some((message, 0)));
        }
    }

    #[tokio::test(start_paused = true)]
    async fn it_beats_while_it_runs() {
        let beats = Arc::new(Beats::new(0));
        let keeping = beats.clone();
        tokio::spawn(async move { keeping.keep().await });
        let begun = now();
        while beats.since() < begun {
            tokio::time::sleep(BEAT).await;
        }
    }

    #[test]
    fn age_counts() {
        assert_eq!(too_old(now() + MAX_AGE), None);
        assert!(too_old(0).unwrap().contains("stood still"));
    }
}
