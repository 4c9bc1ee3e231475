//! Requests to the broker that wait for their answers, for clients that do other things meanwhile.

use std::collections::BTreeMap;

use realtime::clock::SECOND;

use crate::stream_client::Answer;

/// Time that the broker has for an answer \[ns\]; a process that decides has less.
pub const PATIENCE: u64 = 3 * SECOND;

/// Requests on their way, each with what its sender knows of it.
#[derive(Clone, Debug)]
pub struct Awaited<T> {
    /// By the number of their frame, and when their answer is given up \[ns\].
    requests: BTreeMap<u64, (T, u64)>,
}

impl<T> Default for Awaited<T> {
    /// None.
    fn default() -> Self {
        Self { requests: BTreeMap::new() }
    }
}

impl<T> Awaited<T> {
    /// Adds the request that was sent as the frame `sequence` at `now` \[ns\].
    pub fn insert(&mut self, sequence: u64, request: T, now: u64) {
        self.requests.insert(sequence, (request, now + PATIENCE));
    }

    /// The request that this is the answer to; it waits no longer.
    pub fn take(&mut self, answer: &Answer) -> Option<T> {
        self.requests.remove(&answer.sequence).map(|(request, _)| request)
    }

    /// True if none waits.
    pub fn is_empty(&self) -> bool {
        self.requests.is_empty()
    }

    /// All that wait, in the order in which they were sent.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.requests.values().map(|(request, _)| request)
    }

    /// The same, when nobody answers them any more.
    pub fn into_requests(self) -> impl Iterator<Item = T> {
        self.requests.into_values().map(|(request, _)| request)
    }

    /// Looks whether an answer is overdue at `now` \[ns\].
    ///
    /// # Errors
    /// One is: sentence for the operator.
    pub fn check(&self, now: u64) -> Result<(), String> {
        match self.requests.values().any(|(_, until)| now > *until) {
            true => Err("the broker does not answer; it may have to be started again".into()),
            false => Ok(()),
        }
    }
}
