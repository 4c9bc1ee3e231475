//! Queue of events, from the place in a cycle that sees them to the process that publishes them.

use crate::event::EventCode;
use crate::event_detail::Detail;

/// Room for events that were not published yet.
const ROOM: usize = 32;

/// Events in the order in which they happened; nothing is overwritten. Where there is no more room, the newest are left out
/// and counted, and [`EventCode::EventsLost`] says how many.
#[derive(Clone, Copy, Debug)]
pub struct EventQueue {
    events: [(EventCode, Detail); ROOM],
    first: usize,
    count: usize,
    lost: u64,
}

impl Default for EventQueue {
    fn default() -> Self {
        Self { events: [(EventCode::None, Detail::Nothing); ROOM], first: 0, count: 0, lost: 0 }
    }
}

impl EventQueue {
    /// Adds an event behind all others.
    ///
    /// # Panics
    /// In a debug build: the detail is of another kind than the event's.
    pub fn push(&mut self, code: EventCode, detail: Detail) {
        debug_assert!(detail.is_of(code.kind()), "{code:?} with {detail:?}");
        if self.count == ROOM {
            self.lost += 1;
            return;
        }
        self.events[(self.first + self.count) % ROOM] = (code, detail);
        self.count += 1;
    }

    /// Takes the oldest event; after the last one, how many were lost.
    pub fn pop(&mut self) -> Option<(EventCode, Detail)> {
        if self.count == 0 {
            let lost = std::mem::take(&mut self.lost);
            return (lost > 0).then_some((EventCode::EventsLost, Detail::Count(lost)));
        }
        let event = self.events[self.first];
        self.first = (self.first + 1) % ROOM;
        self.count -= 1;
        Some(event)
    }

    /// Takes all events, the oldest one first.
    pub fn drain(&mut self) -> impl Iterator<Item = (EventCode, Detail)> + '_ {
        std::iter::from_fn(|| self.pop())
    }

    /// Moves all events of another queue behind those of this one.
    pub fn append(&mut self, other: &mut Self) {
        self.lost += std::mem::take(&mut other.lost);
        while let Some((code, detail)) = other.pop() {
            self.push(code, detail);
        }
    }

    /// Number of events.
    pub fn len(&self) -> usize {
        self.count
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Keeps, of the events from place `first` on, those for which `keep` is true.
    pub fn retain_from(&mut self, first: usize, keep: impl Fn(EventCode) -> bool) {
        let all = self.count;
        self.count = first.min(all);
        for place in first..all {
            let event = self.events[(self.first + place) % ROOM];
            if keep(event.0) {
                self.events[(self.first + self.count) % ROOM] = event;
                self.count += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event_detail::{ControlLimit, RefusedFrame};

    #[test]
    fn a_full_queue_keeps_what_came_first_and_says_what_it_lost() {
        let mut queue = EventQueue::default();
        for round in 0..3 {
            let pushed = ROOM + 7 * round;
            (0..pushed).for_each(|i| queue.push(EventCode::PlanActive, Detail::Plan(i as u64)));
            let popped: Vec<_> = queue.drain().collect();
            let kept = (0..ROOM).map(|i| (EventCode::PlanActive, Detail::Plan(i as u64)));
            let lost = (round > 0).then_some((EventCode::EventsLost, Detail::Count(7 * round as u64)));
            assert_eq!(popped, kept.chain(lost).collect::<Vec<_>>());
            assert_eq!(queue.pop(), None, "lost ones are reported once");
            // The ring begins elsewhere in the next round.
            queue.push(EventCode::Lifted, Detail::Nothing);
            queue.pop();
        }
    }

    #[test]
    fn appending_keeps_the_order_and_the_losses() {
        let (mut a, mut b) = (EventQueue::default(), EventQueue::default());
        a.push(EventCode::Lifted, Detail::Nothing);
        (0..=ROOM).for_each(|i| b.push(EventCode::NotHomed, Detail::Joint(i)));
        a.append(&mut b);
        assert!(b.is_empty() && b.pop().is_none());
        let all: Vec<_> = a.drain().collect();
        assert_eq!(all[..2], [(EventCode::Lifted, Detail::Nothing), (EventCode::NotHomed, Detail::Joint(0))]);
        assert_eq!(all.last(), Some(&(EventCode::EventsLost, Detail::Count(2))));
    }

    #[test]
    fn only_what_came_since_is_left_out() {
        let mut queue = EventQueue::default();
        for code in [EventCode::Lifted, EventCode::Fallen, EventCode::Lifted, EventCode::SupplyLost] {
            queue.push(code, Detail::Nothing);
        }
        queue.retain_from(1, |code| code != EventCode::Lifted);
        let left: Vec<_> = queue.drain().map(|(code, _)| code).collect();
        assert_eq!(left, [EventCode::Lifted, EventCode::Fallen, EventCode::SupplyLost]);
    }

    /// Packed by hand, as logs of earlier versions have them.
    #[test]
    fn details_are_packed_as_in_every_log() {
        let packed = [
            (EventCode::PowerOff, Detail::Cause(EventCode::EmergencyStop), 18),
            (EventCode::NodeSilent, Detail::NodeCycles(12, 4), 12_004),
            (EventCode::EmergencyStop, Detail::Caller { user: 1000, process: 77 }, 4_294_967_296_077),
            (EventCode::ControlLimited, Detail::Limit(ControlLimit::Joints), 3),
            (EventCode::FrameRefused, Detail::Frame(RefusedFrame::Jump), 5),
            (EventCode::RingBroken, Detail::Stations(7, 12), 458_764),
            (EventCode::DriveTripped, Detail::Drive { joint: 5, error: 0x4310 }, 1_125_122_053),
            (EventCode::NoFoothold, Detail::Millimetres(350), 350),
            (EventCode::FollowingError, Detail::Joint(5), 5),
        ];
        for (code, detail, number) in packed {
            assert_eq!(detail.pack(), number, "{code:?}");
            assert_eq!(code.detail(number), detail, "{code:?}");
        }
        assert_eq!(Detail::NodeCycles(3, 70_000).pack(), 3999);
    }

    #[test]
    #[should_panic(expected = "FollowingError with Plan(3)")]
    #[cfg(debug_assertions)]
    fn a_detail_of_another_kind_is_found() {
        EventQueue::default().push(EventCode::FollowingError, Detail::Plan(3));
    }

    /// Whatever number stands in a log, it comes back from its detail, but for what a detail has no room for.
    #[test]
    fn no_number_of_a_log_changes() {
        for code in EventCode::ALL {
            for number in [0, 1, 5, 66, 1999, 12_345, 0x4310_0007] {
                let detail = code.detail(number);
                assert!(
                    detail.pack() == number || detail == Detail::Nothing,
                    "{code:?} {number}: {detail:?}"
                );
            }
        }
    }
}
