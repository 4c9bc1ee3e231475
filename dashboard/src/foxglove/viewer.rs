//! One viewer as the watcher sees it: subscriptions, parameters that it follows, and settings that are not answered yet.

use std::collections::{BTreeMap, BTreeSet};

use axum::extract::ws::Utf8Bytes;

use crate::foxglove::replies::{self, StatusLevel};
use crate::subscribers::{Outbox, Subscriber};

/// Message at its time, for all viewers.
#[derive(Clone, Debug)]
pub struct TimedMessage {
    /// \[ns\] Time of the log.
    pub time: u64,
    /// Place of its channel.
    pub channel: usize,
    /// CDR with encapsulation header.
    pub payload: Vec<u8>,
}

/// Parameters that one request sets, until all of them are decided on.
#[derive(Clone, Debug, Default)]
pub struct Setting {
    /// Number of the request.
    pub id: Option<String>,
    /// Names of all of them.
    pub names: Vec<String>,
    /// Orders without an answer, each with its parameter and value.
    pub orders: BTreeMap<u64, (String, f64)>,
    /// Values that were accepted.
    pub accepted: BTreeMap<String, f64>,
}

/// A viewer.
#[derive(Debug)]
pub struct Viewer {
    subscriber: Subscriber<()>,
    /// Number of the subscription, by channel.
    subscriptions: BTreeMap<usize, u32>,
    /// \[ns\] Time that it was told last.
    told: u64,
    /// Parameters of which it is told changes.
    pub follows: BTreeSet<String>,
    settings: Vec<Setting>,
}

impl Viewer {
    /// A viewer that has just come.
    pub fn new(number: u64, outbox: Outbox) -> Self {
        let (subscriptions, follows) = (BTreeMap::new(), BTreeSet::new());
        Self {
            subscriber: Subscriber::new(number, outbox),
            subscriptions,
            told: 0,
            follows,
            settings: Vec::new(),
        }
    }

    /// Its number.
    pub fn number(&self) -> u64 {
        self.subscriber.number
    }

    /// True if its connection ends.
    pub fn is_gone(&self) -> bool {
        self.subscriber.is_gone()
    }

    /// Channels that it has subscribed to.
    pub fn channels(&self) -> impl Iterator<Item = usize> {
        self.subscriptions.keys().copied()
    }

    /// A text for it.
    pub fn text(&mut self, text: impl Into<Utf8Bytes>) {
        self.subscriber.text(&text.into());
    }

    /// A sentence for whoever sits in front of it.
    pub fn status(&mut self, level: StatusLevel, message: &str) {
        self.text(replies::status(level, message));
    }

    /// Subscribes to a channel out of so many.
    ///
    /// # Errors
    /// There is no such channel, it is subscribed to, or the number is in use.
    pub fn subscribe(&mut self, id: u32, channel: u32, channels: usize) -> Result<usize, String> {
        let place = usize::try_from(channel).ok().filter(|place| *place < channels);
        let place = place.ok_or_else(|| {
            format!(
                "subscribe: channelId {channel}: none of those that were advertised, 0 to {}",
                channels - 1
            )
        })?;
        if self.subscriptions.contains_key(&place) {
            return Err(format!("subscribe: channelId {channel}: subscribed to already; unsubscribe first"));
        }
        if self.subscriptions.values().any(|known| *known == id) {
            return Err(format!("subscribe: id {id}: in use; unsubscribe it first, or take another one"));
        }
        self.subscriptions.insert(place, id);
        Ok(place)
    }

    /// Ends subscriptions; those that do not exist have ended.
    pub fn unsubscribe(&mut self, ids: &[u32]) {
        self.subscriptions.retain(|_, id| !ids.contains(id));
    }

    /// A message, if its channel is subscribed to and the viewer has room; `now` \[ns\].
    pub fn show(&mut self, message: &TimedMessage, now: u64) {
        let Some(&subscription) = self.subscriptions.get(&message.channel) else { return };
        // A viewer takes the last time that it was told for the one of its messages; a time that goes back makes it begin anew.
        if message.time > self.told && self.subscriber.bytes(replies::time(message.time), now) {
            self.told = message.time;
        }
        self.subscriber.bytes(replies::message(subscription, message.time, &message.payload), now);
    }

    /// Another run begins, whose time may be an earlier one.
    pub fn begin(&mut self) {
        self.told = 0;
    }

    /// Keeps a request that sets parameters.
    pub fn set(&mut self, setting: Setting) {
        self.settings.push(setting);
    }

    /// Takes the answer to an order; a refusal is told.
    pub fn answered(&mut self, order: u64, result: Result<String, String>) {
        let setting = self.settings.iter_mut().find(|setting| setting.orders.contains_key(&order));
        if let Some(setting) = setting
            && let Some((name, value)) = setting.orders.remove(&order)
            && result.is_ok()
        {
            setting.accepted.insert(name, value);
        }
        if let Err(why) = result {
            self.status(StatusLevel::Error, &why);
        }
    }

    /// Requests that are decided on.
    pub fn settled(&mut self) -> Vec<Setting> {
        self.settings.extract_if(.., |setting| setting.orders.is_empty()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::extract::ws::Message;

    fn binary(fed: &mut tokio::sync::mpsc::Receiver<Message>) -> Vec<Vec<u8>> {
        let all = std::iter::from_fn(|| fed.try_recv().ok());
        all.filter_map(|message| if let Message::Binary(b) = message { Some(b.to_vec()) } else { None })
            .collect()
    }

    #[test]
    fn time_goes_before_its_messages_and_never_back() {
        let (outbox, mut fed) = Outbox::new();
        let mut viewer = Viewer::new(1, outbox);
        assert_eq!(viewer.subscribe(40, 3, 5), Ok(3));
        for (time, channel) in [(10, 3), (10, 3), (11, 2), (9, 3), (12, 3)] {
            viewer.show(&TimedMessage { time, channel, payload: vec![7] }, 0);
        }
        let m = |time| replies::message(40, time, &[7]);
        let t = replies::time;
        assert_eq!(binary(&mut fed), [t(10), m(10), m(10), m(9), t(12), m(12)]);
        viewer.begin();
        viewer.show(&TimedMessage { time: 1, channel: 3, payload: vec![7] }, 0);
        assert_eq!(binary(&mut fed), [t(1), m(1)]);
        viewer.unsubscribe(&[40]);
        viewer.show(&TimedMessage { time: 2, channel: 3, payload: vec![7] }, 0);
        assert!(binary(&mut fed).is_empty());
    }

    #[test]
    fn a_subscription_that_cannot_be_is_refused() {
        let (outbox, _fed) = Outbox::new();
        let mut viewer = Viewer::new(1, outbox);
        viewer.subscribe(1, 4, 5).unwrap();
        for (id, channel, named) in [(2, 5, "0 to 4"), (2, 4, "already"), (1, 3, "in use")] {
            let error = viewer.subscribe(id, channel, 5).unwrap_err();
            assert!(error.contains(named), "{error}");
        }
        assert_eq!(viewer.channels().collect::<Vec<_>>(), [4]);
    }

    #[test]
    fn a_request_is_answered_when_all_of_it_is_decided_on() {
        let (outbox, mut fed) = Outbox::new();
        let mut viewer = Viewer::new(1, outbox);
        let orders = BTreeMap::from([(7, ("a".to_owned(), 1.0)), (8, ("b".to_owned(), 2.0))]);
        viewer.set(Setting { orders, ..Setting::default() });
        viewer.answered(7, Ok("planner".into()));
        viewer.answered(9, Ok("planner".into()));
        assert!(viewer.settled().is_empty() && fed.try_recv().is_err());
        viewer.answered(8, Err("b = 2 is outside of [0, 1]".into()));
        let Ok(Message::Text(status)) = fed.try_recv() else { panic!("a status") };
        assert!(status.contains("outside of [0, 1]") && status.contains(r#""level":2"#), "{status}");
        let settled = viewer.settled();
        assert_eq!(settled[0].accepted, BTreeMap::from([("a".to_owned(), 1.0)]));
        assert!(viewer.settled().is_empty());
    }
}
