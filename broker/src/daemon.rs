//! The broker process: `gangwerk broker --run DIR`.
//!
//! Not a real-time process, in either way to run: it sleeps until a queue or a stream rings.

use std::error::Error;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use config::{Setup, System};
use ipc::{Reader, Run, Space, Writer};
use messages::{CommandTaken, Detail, Event, EventCode, Header, Live, Process, Sensors, topics};
use realtime::{Stop, ThreadSchedule, clock, prepare_thread};

use crate::exchange::{BrokerEvent, Exchange};
use crate::observation::Observation;
use crate::{doors, inlet, keys};

/// Between two looks whether to end, and at what is a matter of time.
const LOOK: Duration = Duration::from_millis(10);

/// Whether and how TCP is served.
#[derive(Clone, Debug, Default)]
pub struct Tcp {
    /// Where; none: not at all. Port 0 lets the system choose one.
    pub address: Option<SocketAddr>,
    /// File of keys; none: no keys.
    pub keys: Option<PathBuf>,
}

impl Tcp {
    /// Broker section of `system.toml`; a relative path of the keys counts from the configuration directory.
    pub fn of(system: &System, config: &Path) -> Self {
        let keys = (!system.tcp_keys.is_empty()).then(|| config.join(&system.tcp_keys));
        Self { address: system.tcp_listen, keys }
    }
}

/// Runs until asked to end.
///
/// # Errors
/// The process cannot start.
pub fn main(dir: &Path) -> Result<(), Box<dyn Error>> {
    let stop = Stop::on_signals()?;
    let run = Run::load(dir)?;
    let system = System::load(&run.config.join("system.toml"))?;
    let row = system.process(Process::Broker);
    let granted = prepare_thread(&ThreadSchedule { priority: 0, core: row.and_then(|row| row.core) });
    for missing in &granted.missing {
        tracing::warn!("broker degraded: {missing}");
    }
    Ok(serve(&run, &Tcp::of(&system, &run.config), &stop)?)
}

/// Forwards messages until `stop`.
///
/// # Errors
/// Another broker serves this run, a queue or the socket cannot be made, the keys are not in order, or the port is taken.
pub fn serve(run: &Run, tcp: &Tcp, stop: &Stop) -> Result<(), String> {
    let space = run.enter(Process::Broker).map_err(|e| e.to_string())?;
    let (gate, inlet) = inlet::gate();
    // A bare run, of nothing but a broker, has no configuration.
    let setup = run.config.exists().then(|| Setup::load(&run.config, &run.scene)).transpose();
    let setup = setup.inspect_err(|e| tracing::warn!("no parameters can be listed: {e}")).unwrap_or(None);
    let robot = Observation::open(&space, setup.as_ref()).map_err(|e| e.to_string())?;
    let exchange = Exchange::new(&space, inlet, clock::now()).map_err(|e| e.to_string())?;
    let mut exchange = exchange.showing(robot);
    let mut events = Events::open(&space).map_err(|e| e.to_string())?;
    let gate = gate.ringing(exchange.doorbell());
    if let Some(address) = tcp.address {
        let keys = tcp.keys.as_deref().map_or_else(|| Ok(Vec::new()), keys::load)?;
        let listener = doors::bind_tcp(address, &keys)?;
        doors::publish_address(&run.dir, &listener)?;
        doors::serve_tcp(listener, keys, gate.clone())?;
    }
    let (socket, owner) = doors::bind_socket(&run.dir)?;
    doors::serve_socket(socket, owner, gate)?;
    events.write(EventCode::Started, Detail::Nothing);
    while !stop.asked() {
        let busy = exchange.turn_by(&clock::now, &mut |report| match report {
            BrokerEvent::Refused(address) => {
                events.write(EventCode::CommandRefused, Detail::Message(address.into()));
            }
            BrokerEvent::Denied(live, code) => events.denied(&live, code),
            BrokerEvent::Lost(messages) => events.write(EventCode::MessagesLost, Detail::Count(messages)),
        });
        if !busy {
            exchange.wait(LOOK);
        }
    }
    events.write(EventCode::Ended, Detail::Nothing);
    Ok(())
}

/// Writes `events/broker` and `commands/broker`, stamped with the newest tick.
struct Events {
    writer: Writer<Event>,
    commands: Writer<CommandTaken>,
    sensors: Reader<Sensors>,
}

impl Events {
    fn open(space: &Space) -> Result<Self, ipc::IpcError> {
        Ok(Self {
            writer: space.writer(&topics::EVENTS_BROKER)?,
            commands: space.writer(&topics::COMMANDS_BROKER)?,
            sensors: space.reader(&topics::SENSORS)?,
        })
    }

    fn write(&mut self, code: EventCode, detail: Detail) {
        let header = self.now();
        self.writer.write(&Event::new(header, code, detail));
    }

    /// A command that went no further than here.
    fn denied(&mut self, live: &Live, code: u8) {
        let taken = CommandTaken::new(self.now(), 0, live, &Ok(()), false);
        self.commands.write(&CommandTaken { refused: code.into(), ..taken });
    }

    fn now(&mut self) -> Header {
        self.sensors.latest().map_or(Header::default(), |s| s.header)
    }
}
