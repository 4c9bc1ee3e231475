//! Layout of the telegrams of CP3 and CP4: computed once by the master, sent to the slaves in CP2.
//!
//! MDT0 and AT0 begin with the hot-plug field. Then follow, each in the order of the stations, and in the next telegram
//! when one is full: all service channels, all device controls or states, all connections.

use crate::header::{MAX_DATA, MIN_DATA, TELEGRAMS, TelegramKind};
use std::fmt;

/// Hot-plug field at the begin of MDT0 and AT0 \[B\].
pub(crate) const HOT_PLUG: usize = 8;
/// Service channel \[B\].
pub const SERVICE: usize = 6;
/// Device control or status \[B\].
pub const DEVICE: usize = 2;
/// Connection control in front of the data of a connection \[B\].
pub(crate) const CONNECTION: usize = 2;
/// Most stations.
pub(crate) const STATIONS: usize = crate::telegram::cp0::SLAVES;

/// A slave as the master expects it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Station {
    /// @range 1..511 Sercos address.
    pub address: u16,
    /// Data for the slave in each cycle \[B\].
    pub command: usize,
    /// Data of the slave in each cycle \[B\].
    pub feedback: usize,
}

/// A place in the data of a telegram.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DataPlace {
    /// @range 0..3 Number of the telegram.
    pub telegram: usize,
    /// \[B\] @range 0..1493 Behind the headers.
    pub offset: usize,
}

impl DataPlace {
    /// The word that names the place: bits 13-12 telegram, bit 11 kind (1 MDT), bits 10-0 offset.
    pub fn word(self, kind: TelegramKind) -> u16 {
        (self.telegram as u16 & 3) << 12
            | u16::from(kind == TelegramKind::Mdt) << 11
            | self.offset as u16 & 0x7FF
    }

    /// The place that a word names, and in which kind of telegram.
    pub fn read(word: u16) -> (TelegramKind, Self) {
        let kind = if word & 1 << 11 == 0 { TelegramKind::At } else { TelegramKind::Mdt };
        (kind, Self { telegram: usize::from(word >> 12 & 3), offset: usize::from(word & 0x7FF) })
    }
}

/// Places of one station.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StationPlaces {
    /// Service channel in the MDT.
    pub mdt_service: DataPlace,
    /// Service channel in the AT.
    pub at_service: DataPlace,
    /// Device control.
    pub control: DataPlace,
    /// Device status.
    pub status: DataPlace,
    /// Connection with the data for the slave.
    pub command: DataPlace,
    /// Connection with the data of the slave.
    pub feedback: DataPlace,
}

/// Places of all stations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TelegramLayout {
    /// In the order of the stations.
    pub places: Vec<StationPlaces>,
    /// Data of each MDT \[B\]; 0: not sent.
    pub mdt: [usize; TELEGRAMS],
    /// Data of each AT \[B\]; 0: not sent.
    pub at: [usize; TELEGRAMS],
}

/// Reason why stations cannot be served.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutError {
    /// So many stations.
    Stations(usize),
    /// An address out of range.
    Address(u16),
    /// The address of two stations.
    Twice(u16),
    /// More data than four telegrams hold.
    Full(TelegramKind),
}

impl fmt::Display for LayoutError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Stations(count) => write!(f, "sercos: {count} stations; 1 to {STATIONS} can be served"),
            Self::Address(address) => {
                write!(f, "sercos: a station has the address {address}; give it one of 1 to 511")
            }
            Self::Twice(address) => {
                write!(f, "sercos: two stations have the address {address}; give each its own")
            }
            Self::Full(kind) => {
                let kind = if *kind == TelegramKind::Mdt { "commands" } else { "feedback" };
                write!(
                    f,
                    "sercos: the {kind} of all stations do not fit into {TELEGRAMS} telegrams of {MAX_DATA} bytes; \
                     take fewer stations or smaller frames"
                )
            }
        }
    }
}

impl std::error::Error for LayoutError {}

/// Fills telegrams from the begin.
struct TelegramFilling {
    kind: TelegramKind,
    lengths: [usize; TELEGRAMS],
    telegram: usize,
}

impl TelegramFilling {
    fn new(kind: TelegramKind) -> Self {
        Self { kind, lengths: [HOT_PLUG, 0, 0, 0], telegram: 0 }
    }

    fn take(&mut self, len: usize) -> Result<DataPlace, LayoutError> {
        if self.lengths[self.telegram] + len > MAX_DATA {
            self.telegram += 1;
        }
        if self.telegram >= TELEGRAMS || len > MAX_DATA {
            return Err(LayoutError::Full(self.kind));
        }
        let place = DataPlace { telegram: self.telegram, offset: self.lengths[self.telegram] };
        self.lengths[self.telegram] += len;
        Ok(place)
    }

    fn lengths(&self) -> [usize; TELEGRAMS] {
        self.lengths.map(|len| if len == 0 { 0 } else { len.max(MIN_DATA) })
    }
}

impl TelegramLayout {
    /// Places for these stations.
    ///
    /// # Errors
    /// Addresses out of range or twice, too many stations, too many data.
    pub fn new(stations: &[Station]) -> Result<Self, LayoutError> {
        if stations.is_empty() || stations.len() > STATIONS {
            return Err(LayoutError::Stations(stations.len()));
        }
        for (i, station) in stations.iter().enumerate() {
            if !(1..=511).contains(&station.address) {
                return Err(LayoutError::Address(station.address));
            }
            if stations[..i].iter().any(|other| other.address == station.address) {
                return Err(LayoutError::Twice(station.address));
            }
        }
        let (mut mdt, mut at) =
            (TelegramFilling::new(TelegramKind::Mdt), TelegramFilling::new(TelegramKind::At));
        let mut places = vec![StationPlaces::default(); stations.len()];
        // Service channels first, then device words, then connections.
        for place in &mut places {
            place.mdt_service = mdt.take(SERVICE)?;
            place.at_service = at.take(SERVICE)?;
        }
        for place in &mut places {
            place.control = mdt.take(DEVICE)?;
            place.status = at.take(DEVICE)?;
        }
        for (place, station) in places.iter_mut().zip(stations) {
            place.command = mdt.take(CONNECTION + station.command)?;
            place.feedback = at.take(CONNECTION + station.feedback)?;
        }
        Ok(Self { places, mdt: mdt.lengths(), at: at.lengths() })
    }
}
