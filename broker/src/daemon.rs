//! The broker process: `gangwerk broker --run DIR`.
//!
//! Not a real-time process, in either way to run: it sleeps until a queue rings, and looks after TCP connections, if it
//! serves any, a thousand times a second.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use config::System;
use ipc::{Reader, Run, Space, Writer};
use messages::{Event, EventCode, Process, Sensors, topics};
use realtime::{Schedule, Stop, prepare_thread};

use crate::exchange::{Exchange, Report};
use crate::tcp;

/// Longest time a message of a TCP connection waits while nothing else happens.
const POLL: Duration = Duration::from_millis(1);
/// Without TCP, between two looks whether to end.
const LOOK: Duration = Duration::from_millis(20);

/// Runs until asked to end. `tcp_port`: another port than that of `system.toml`; 0: no TCP.
///
/// # Errors
/// The process cannot start.
pub fn main(dir: &Path, tcp_port: Option<u16>) -> Result<(), Box<dyn Error>> {
    let stop = Stop::on_signals()?;
    let run = Run::load(dir)?;
    let system = System::load(&run.config.join("system.toml"))?;
    let row = system.process(Process::Broker);
    let granted = prepare_thread(&Schedule { priority: 0, core: row.and_then(|row| row.core) });
    for missing in &granted.missing {
        tracing::warn!("broker degraded: {missing}");
    }
    Ok(serve(&run, tcp_port.unwrap_or(system.tcp_port), &stop)?)
}

/// Forwards messages until `stop`. `tcp_port` 0: no TCP.
///
/// # Errors
/// Another broker serves this run, a queue cannot be made, or the port is taken.
pub fn serve(run: &Run, tcp_port: u16, stop: &Stop) -> Result<(), String> {
    let space = run.enter(Process::Broker).map_err(|e| e.to_string())?;
    let (gate, inlet) = tcp::gate();
    let mut exchange = Exchange::new(&space, inlet).map_err(|e| e.to_string())?;
    let mut events = Events::open(&space).map_err(|e| e.to_string())?;
    if tcp_port != 0 {
        tcp::serve(tcp::bind(tcp_port)?, gate)?;
    }
    let nap = if tcp_port == 0 { LOOK } else { POLL };
    events.write(EventCode::Started, 0);
    while !stop.asked() {
        let busy = exchange.turn(&mut |report| match report {
            Report::Refused(address) => events.write(EventCode::CommandRefused, address.into()),
            Report::Lost(messages) => events.write(EventCode::MessagesLost, messages),
        });
        if !busy {
            exchange.wait(nap);
        }
    }
    events.write(EventCode::Ended, 0);
    Ok(())
}

/// Writes `events/broker`, stamped with the newest tick.
struct Events {
    writer: Writer<Event>,
    sensors: Reader<Sensors>,
}

impl Events {
    fn open(space: &Space) -> Result<Self, ipc::IpcError> {
        Ok(Self { writer: space.writer(&topics::EVENTS_BROKER)?, sensors: space.reader(&topics::SENSORS)? })
    }

    fn write(&mut self, code: EventCode, detail: u64) {
        let header = self.sensors.latest().map_or(Event::default().header, |s| s.header);
        self.writer.write(&Event { header, code: code as u64, detail });
    }
}
