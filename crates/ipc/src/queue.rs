//! Small byte messages between processes: many senders, one receiver, nobody waits for anybody.
//!
//! For the command plane only: sending allocates, so it has no place in a control cycle. A receiver that does not keep
//! up loses its oldest messages; each loss is counted by the gap in its sender's numbers.

use crate::bell::{Listening, Ringing};
use crate::error::{IpcError, because};
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::*;
use rustix::event::{EventfdFlags, eventfd};
use std::os::fd::{AsFd, OwnedFd};
use std::sync::Arc;
use std::time::Duration;

/// Longest message \[B\].
pub const MAX_MESSAGE: usize = 512;

/// Messages a queue holds for its receiver.
const DEPTH: usize = 256;
/// Senders a queue serves at once.
const MAX_SENDERS: usize = 64;

pub(crate) type Plane = ipc_threadsafe::Service;

/// One message on its way.
#[derive(Clone, Copy, Debug, ZeroCopySend)]
#[repr(C)]
struct Packet {
    /// Tells senders apart.
    sender: u64,
    /// Counts the sender's messages from 1.
    number: u64,
    len: u64,
    bytes: [u8; MAX_MESSAGE],
}

fn service(
    node: &Node<Plane>,
    name: &str,
) -> Result<iceoryx2::service::port_factory::publish_subscribe::PortFactory<Plane, Packet, ()>, IpcError> {
    let full: ServiceName = format!("queue/{name}").as_str().try_into().map_err(|e| because(name, e))?;
    // Opening may meet another process that is just making the same queue.
    let mut tries = 0;
    loop {
        let made = node
            .service_builder(&full)
            .publish_subscribe::<Packet>()
            .enable_safe_overflow(true)
            .max_publishers(MAX_SENDERS)
            .max_subscribers(4)
            .max_nodes(MAX_SENDERS)
            .subscriber_max_buffer_size(DEPTH)
            .subscriber_max_borrowed_samples(2)
            .history_size(0)
            .open_or_create();
        match made {
            Ok(service) => return Ok(service),
            Err(e) if tries >= 50 => return Err(because(format!("queue {name}"), e)),
            Err(_) => tries += 1,
        }
        rustix::thread::sched_yield();
    }
}

/// Sends into one queue and rings its receiver.
#[derive(Debug)]
pub struct QueueSender {
    publisher: Publisher<Plane, Packet, ()>,
    bell: Ringing<Plane>,
    sender: u64,
    number: u64,
}

impl QueueSender {
    pub(crate) fn new(node: &Node<Plane>, name: &str, wakes: &str) -> Result<Self, IpcError> {
        let publisher = service(node, name)?
            .publisher_builder()
            .max_loaned_samples(2)
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            .create()
            .map_err(|e| because(format!("sender of queue {name}"), e))?;
        let id = publisher.id().value();
        Ok(Self {
            publisher,
            bell: Ringing::new(node, wakes)?,
            sender: (id as u64) ^ ((id >> 64) as u64),
            number: 0,
        })
    }

    /// Sends one message of at most [`MAX_MESSAGE`] bytes, and wakes the receiver. Never waits.
    ///
    /// `false`: too long, or no receiver took it. The number of the message is used up either way, so the receiver
    /// counts it as lost when the next one arrives.
    pub fn send(&mut self, message: &[u8]) -> bool {
        self.number += 1;
        if message.len() > MAX_MESSAGE {
            return false;
        }
        let mut packet = Packet {
            sender: self.sender,
            number: self.number,
            len: message.len() as u64,
            bytes: [0; MAX_MESSAGE],
        };
        packet.bytes[..message.len()].copy_from_slice(message);
        let taken = self.publisher.send_copy(packet).is_ok_and(|receivers| receivers > 0);
        self.bell.ring();
        taken
    }
}

/// Receives from one queue.
#[derive(Debug)]
pub struct QueueReceiver {
    subscriber: Subscriber<Plane, Packet, ()>,
    /// (sender, last number seen)
    senders: Vec<(u64, u64)>,
    lost: u64,
    packet: Packet,
}

impl QueueReceiver {
    pub(crate) fn new(node: &Node<Plane>, name: &str) -> Result<Self, IpcError> {
        let subscriber = service(node, name)?
            .subscriber_builder()
            .buffer_size(DEPTH)
            .create()
            .map_err(|e| because(format!("receiver of queue {name}"), e))?;
        Ok(Self {
            subscriber,
            senders: Vec::with_capacity(MAX_SENDERS),
            lost: 0,
            packet: Packet { sender: 0, number: 0, len: 0, bytes: [0; MAX_MESSAGE] },
        })
    }

    /// The oldest message that waits; none: the queue is empty.
    pub fn receive(&mut self) -> Option<&[u8]> {
        // An error concerns the connection to one sender that died; the next call sees the others.
        let sample = self.subscriber.receive().ok().flatten()?;
        self.packet = *sample.payload();
        drop(sample);
        let Packet { sender, number, len, .. } = self.packet;
        match self.senders.iter_mut().find(|(s, _)| *s == sender) {
            Some((_, last)) => {
                self.lost += number.saturating_sub(*last + 1);
                *last = number;
            }
            None => {
                // A sender is known from its first message on: what it sent before this receiver came is not lost.
                if self.senders.len() == self.senders.capacity() {
                    self.senders.remove(0);
                }
                self.senders.push((sender, number));
            }
        }
        Some(&self.packet.bytes[..(len as usize).min(MAX_MESSAGE)])
    }

    /// Messages lost so far because this receiver did not keep up.
    pub fn lost(&self) -> u64 {
        self.lost
    }
}

/// Sleeps until one of the queues that ring `name` has something, or its doorbell rings, in any thread.
#[derive(Debug)]
pub struct QueueWaiter {
    bell: Listening<Plane>,
    door: Doorbell,
}

impl QueueWaiter {
    pub(crate) fn new(node: &Node<Plane>, name: &str) -> Result<Self, IpcError> {
        let flags = EventfdFlags::NONBLOCK | EventfdFlags::CLOEXEC;
        let door = eventfd(0, flags).map_err(|e| because(format!("doorbell of {name}"), e))?;
        Ok(Self { bell: Listening::new(node, name)?, door: Doorbell(Arc::new(door)) })
    }

    /// `true`: the bell or the doorbell rang; `false`: time is up.
    pub fn wait(&self, timeout: Duration) -> bool {
        let rang = self.bell.wait_also(timeout, 0, Some(self.door.0.as_fd()));
        // Reading sets the count back to zero, so that the next wait sleeps.
        rustix::io::read(&self.door.0, &mut [0; 8]).is_ok() || rang
    }

    /// Wake-up of this waiter from another thread of the same process.
    pub fn doorbell(&self) -> Doorbell {
        self.door.clone()
    }
}

/// Wakes the thread that sleeps in a [`QueueWaiter`] of this process. Fit for a control cycle: one system call that never
/// blocks, no allocation.
#[derive(Clone, Debug)]
pub struct Doorbell(Arc<OwnedFd>);

impl Doorbell {
    /// Rings; the waiter's present or next wait returns at once.
    pub fn ring(&self) {
        // It fails only if the count is full, which nobody reaches: then the waiter is woken anyway.
        let _ = rustix::io::write(&self.0, &1u64.to_ne_bytes());
    }
}
