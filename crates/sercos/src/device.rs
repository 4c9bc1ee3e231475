//! Control and status words: of a device, and of a connection.

/// Forwarding of telegrams by a slave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topology {
    /// Both channels go through.
    Through,
    /// The end of a line of P telegrams: sent back, and out of the idle port as well.
    LoopP,
    /// The end of a line of S telegrams.
    LoopS,
}

impl Topology {
    fn bits(self) -> u16 {
        (self as u16) << 12
    }

    fn read(word: u16) -> Option<Self> {
        [Self::Through, Self::LoopP, Self::LoopS].get(usize::from(word >> 12 & 3)).copied()
    }
}

/// Traffic at the port that a loop leaves idle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Idle {
    /// Nobody is plugged in.
    NoLink,
    /// Somebody is there and sends nothing.
    Link,
    /// P telegrams.
    P,
    /// S telegrams.
    S,
}

/// Device control, C-DEV: a word for each slave in an MDT.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DeviceControl(pub u16);

impl DeviceControl {
    const TOGGLE: u16 = 1 << 14;
    const RING: u16 = 1 << 11;
    const VALID: u16 = 1 << 8;

    /// Bit 8: the master's data are valid.
    pub fn valid(self) -> bool {
        self.0 & Self::VALID != 0
    }

    /// Bit 11: the ring is closed.
    pub fn ring_closed(self) -> bool {
        self.0 & Self::RING != 0
    }

    /// Bit 14: changes its value with every command to change the topology.
    pub fn toggle(self) -> bool {
        self.0 & Self::TOGGLE != 0
    }

    /// Bits 13-12: the topology that is commanded; none for the reserved value.
    pub fn topology(self) -> Option<Topology> {
        Topology::read(self.0)
    }

    /// With these bits 8 and 11.
    pub fn with(self, valid: bool, ring_closed: bool) -> Self {
        let kept = self.0 & !(Self::VALID | Self::RING);
        Self(kept | if valid { Self::VALID } else { 0 } | if ring_closed { Self::RING } else { 0 })
    }

    /// Commands another topology.
    pub fn command(self, topology: Topology) -> Self {
        Self(self.0 & !(3 << 12) ^ Self::TOGGLE | topology.bits())
    }
}

/// Device status, S-DEV: a word of each slave in an AT.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status(pub u16);

impl Status {
    /// The word of a slave: acknowledged toggle, topology, what its idle port sees, whether its data are valid.
    pub fn new(toggle: bool, topology: Topology, idle: Idle, valid: bool) -> Self {
        Self(u16::from(toggle) << 14 | topology.bits() | (idle as u16) << 10 | u16::from(valid) << 8)
    }

    /// Bit 8: the slave's data are valid.
    pub fn valid(self) -> bool {
        self.0 & 1 << 8 != 0
    }

    /// With bit 9.
    pub(crate) fn with_connection_error(self, error: bool) -> Self {
        Self(self.0 & !(1 << 9) | u16::from(error) << 9)
    }

    /// Bit 14: acknowledges [`DeviceControl::toggle`].
    pub fn toggle(self) -> bool {
        self.0 & 1 << 14 != 0
    }

    /// Bits 13-12; none for the reserved value.
    pub fn topology(self) -> Option<Topology> {
        Topology::read(self.0)
    }

    /// Bits 11-10.
    pub fn idle(self) -> Idle {
        [Idle::NoLink, Idle::Link, Idle::P, Idle::S][usize::from(self.0 >> 10 & 3)]
    }
}

/// Connection control, C-CON: the word in front of the data of a connection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Connection(pub u16);

impl Connection {
    /// Bit 0: the producer is ready.
    pub fn ready(self) -> bool {
        self.0 & 1 != 0
    }

    /// Bit 1: changes its value with new data.
    pub fn toggle(self) -> bool {
        self.0 & 2 != 0
    }

    /// Bits 15-12: counts new data.
    pub fn counter(self) -> u16 {
        self.0 >> 12
    }

    /// The word in front of the next data.
    pub fn next(self) -> Self {
        Self((self.0 & 0x0FFD | 1) | (self.0 & 2 ^ 2) | self.0.wrapping_add(1 << 12) & 0xF000)
    }
}
