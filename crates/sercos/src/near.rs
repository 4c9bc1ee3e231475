//! The master on real interfaces: one cycle is [`Near::send`] and [`Near::receive`].

use crate::header::MAX_FRAME;
use crate::master::{Master, MasterSetup, Stage};
use crate::socket::{Socket, SocketError};
use crate::trouble::StartTrouble;
use std::fmt;

/// A frame longer than any telegram is seen as such, not cut to one.
const ROOM: usize = MAX_FRAME + 8;
/// Frames that are taken in one go, so that a storm of them does not hold a cycle up.
const BURST: usize = 64;

/// A master with its ports.
pub struct Near {
    master: Master,
    ports: [Option<Socket>; 2],
    buffer: Box<[u8; ROOM]>,
    refused: u64,
}

/// Error of making a master.
#[derive(Debug)]
pub enum OpenError {
    /// An interface.
    Socket(SocketError),
    /// Data to send.
    Setup(StartTrouble),
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Socket(error) => error.fmt(f),
            Self::Setup(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for OpenError {}

impl Near {
    /// A master on one interface, or on the two ends of a ring. The addresses in `setup` become those of the interfaces.
    ///
    /// # Errors
    /// An interface that cannot be used, or a set-up that Sercos III does not know.
    pub fn open(first: &str, second: Option<&str>, mut setup: MasterSetup) -> Result<Self, OpenError> {
        let first = Socket::open(first).map_err(OpenError::Socket)?;
        let second = second.map(Socket::open).transpose().map_err(OpenError::Socket)?;
        setup.ports = [Some(first.mac()), second.as_ref().map(Socket::mac)];
        let master = Master::new(setup).map_err(OpenError::Setup)?;
        Ok(Self { master, ports: [Some(first), second], buffer: Box::new([0; ROOM]), refused: 0 })
    }

    /// The master.
    pub fn master(&self) -> &Master {
        &self.master
    }

    /// The master.
    pub fn master_mut(&mut self) -> &mut Master {
        &mut self.master
    }

    /// Telegrams that the kernel did not take: the interface is down, or its queue full.
    pub fn refused(&self) -> u64 {
        self.refused
    }

    /// Begins a cycle: all telegrams out of both ports.
    pub fn send(&mut self) {
        self.master.begin();
        for (port, socket) in self.ports.iter().enumerate() {
            if let Some(socket) = socket {
                for frame in self.master.telegrams(port) {
                    self.refused += u64::from(!socket.send(frame));
                }
            }
        }
    }

    /// Ends a cycle with what has come in so far.
    pub fn receive(&mut self) -> Stage {
        self.drain();
        self.end()
    }

    /// Ends a cycle with what was taken.
    pub fn end(&mut self) -> Stage {
        self.master.end()
    }

    /// Ends a cycle when all has come in that came in the cycle before, or after `patience` \[ns\] without a frame.
    pub fn receive_all(&mut self, patience: u64) -> Stage {
        self.drain();
        while !self.master.is_complete() && self.wait(patience) {
            self.drain();
        }
        self.master.end()
    }

    /// Waits until there is a frame, for at most so long \[ns\]; whether there is one.
    pub fn wait(&self, nanoseconds: u64) -> bool {
        Socket::wait(self.ports.each_ref().map(Option::as_ref), nanoseconds)
    }

    /// Takes what has come in, without ending the cycle; whether all is there that was there in the cycle before.
    pub fn drain(&mut self) -> bool {
        for (port, socket) in self.ports.iter().enumerate() {
            let Some(socket) = socket else { continue };
            for _ in 0..BURST {
                let Some(frame) = socket.receive(&mut self.buffer[..]) else { break };
                self.master.take(port, frame);
            }
        }
        self.master.is_complete()
    }
}
