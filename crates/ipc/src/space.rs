//! Everything one running robot shares.

use crate::bell::{self, Bell, Waiter};
use crate::error::{IpcError, because};
use crate::lock::Lock;
use crate::place::RunPlace;
use crate::queue::{Plane, QueueReceiver, QueueSender, QueueWaiter};
use crate::reader::Reader;
use crate::run_dir::RunDir;
use crate::slot::{self, RealTime, SlotService, writers};
use crate::writer::Writer;
use iceoryx2::prelude::*;
use messages::topics::{ForType, with_type};
use messages::{Process, Record, TOPICS, Topic};
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::cell::OnceCell;
use std::path::{Path as StdPath, PathBuf};
use std::time::Duration;

/// Name of the supervisor's lock and node.
const SUPERVISOR: &str = "supervisor";
/// Files that a reader of all topics may need open: more than the 1024 that many systems allow a process unasked.
const OPEN_FILES: u64 = 4096;
/// Room kept free in shared memory for queues, bells, rings of other programs \[B\]: those of a run take 1 MiB.
const SPARE: u64 = 8 << 20;
/// Timeout for somebody else who clears up after dead processes.
const CLEAR_PATIENCE: Duration = Duration::from_millis(200);

/// One running robot's shared memory. Ports are made from it before a process arms; afterwards it only has to live.
pub struct Space {
    place: RunPlace,
    node: Node<RealTime>,
    commands: OnceCell<Node<Plane>>,
    process: Option<Process>,
    /// The supervisor keeps all topics in being.
    _topics: Vec<SlotService>,
    // Dropped last: the place is free only when all of it is gone.
    _hold: Hold,
}

/// Process id of the supervisor of the run in `dir`; none: nobody runs there.
pub fn supervisor(dir: &StdPath) -> Option<u32> {
    Lock::owner(&RunPlace::of(dir).ok()?.dir, SUPERVISOR)
}

/// Process id of a process of the run in `dir`; none: it is not there.
pub fn owner(dir: &StdPath, process: Process) -> Option<u32> {
    Lock::owner(&RunPlace::of(dir).ok()?.dir, process.name())
}

/// Lock of a place.
struct Hold {
    place: RunPlace,
    process: Option<Process>,
    _lock: Option<Lock>,
}

impl Drop for Hold {
    fn drop(&mut self) {
        // The supervisor leaves nothing behind, unless somebody still lives there.
        let alone = || Process::ALL.iter().all(|p| Lock::owner(&self.place.dir, p.name()).is_none());
        if self.process.is_none() && alone() {
            let _ = self.place.wipe();
            let locks = Process::ALL.iter().map(|p| p.name()).chain([SUPERVISOR]);
            if let Ok(dir) = RunDir::open(&self.place.dir) {
                dir.clear(locks);
            }
        }
    }
}

impl Space {
    /// For the supervisor: takes `dir` for itself, clears away what a former run left there, makes all topics.
    ///
    /// `dir` is made with mode 0700 if it does not exist, must be this user's own, and is removed when the space is dropped
    /// and nothing else is in it. A second supervisor is refused, and
    /// so is a first one while processes of a former run are still alive.
    pub fn create(dir: &StdPath) -> Result<Self, IpcError> {
        Self::create_topics(dir, TOPICS)
    }

    fn create_topics(dir: &StdPath, topics: &[Topic]) -> Result<Self, IpcError> {
        RunDir::make(dir)?.refuse_others()?;
        let mut place = RunPlace::of(dir)?;
        // A run that is ending removes the directory under our feet: then it is made once more.
        let lock = Lock::take(&place.dir, SUPERVISOR).or_else(|e| {
            if place.dir.exists() {
                Err(e)
            } else {
                RunDir::make(dir).and_then(|_| Lock::take(&place.dir, SUPERVISOR))
            }
        })?;
        for process in Process::ALL {
            if let Some(pid) = Lock::owner(&place.dir, process.name()) {
                let dir = place.dir.display().to_string();
                return Err(IpcError::AlreadyRunning { who: process.name().into(), pid, dir });
            }
        }
        place.wipe()?;
        let needed = needed(topics);
        let free = RunPlace::free()?;
        if free < needed {
            return Err(IpcError::NoRoom { needed, free });
        }
        place.begin()?;
        place.make_root()?;
        let node = node::<RealTime>(&place, SUPERVISOR)?;
        place.close_to_others()?;
        let mut made = Vec::new();
        for topic in topics {
            made.extend(with_type(topic.name, Create { node: &node }).unwrap_or_else(|| Ok(Vec::new()))?);
        }
        for process in Process::ALL {
            bell::service(&node, process.name())?;
        }
        let hold = Hold { place: place.clone(), process: None, _lock: Some(lock) };
        Ok(Self { place, node, commands: OnceCell::new(), process: None, _topics: made, _hold: hold })
    }

    /// For a process: enters the space in `dir`. Each process but the observer may enter once at a time.
    pub fn open(dir: &StdPath, process: Process) -> Result<Self, IpcError> {
        let _private = RunDir::open(dir)?;
        let mut place = RunPlace::of(dir)?;
        if Lock::owner(&place.dir, SUPERVISOR).is_none() {
            let dir = place.dir.display();
            return Err(IpcError::Other(format!("no run in {dir}: start one with `gangwerk run SCENE`")));
        }
        let lock = match process {
            Process::Observer => None,
            _ => Some(Lock::take(&place.dir, process.name())?),
        };
        place.join()?;
        allow_files();
        let node = node::<RealTime>(&place, process.name())?;
        if process == Process::Observer {
            // Observers end by Ctrl-C, without a farewell, and a topic bears only so many: each clears up after the last ones.
            node.blocking_cleanup_dead_nodes(CLEAR_PATIENCE);
        }
        let process = Some(process);
        let hold = Hold { place: place.clone(), process, _lock: lock };
        Ok(Self { place, node, commands: OnceCell::new(), process, _topics: Vec::new(), _hold: hold })
    }

    /// The run directory.
    pub fn dir(&self) -> &StdPath {
        &self.place.dir
    }

    /// Black box of a process, with its last seconds. In shared memory, and gone with it.
    pub fn box_of(&self, process: Process) -> PathBuf {
        self.place.box_of(process)
    }

    /// The writer of a topic. Only the process named in the table may have it.
    pub fn writer<T: Record>(&self, topic: &Topic) -> Result<Writer<T>, IpcError> {
        right_type::<T>(topic)?;
        match self.process {
            Some(p) if p != topic.writer => Err(IpcError::Other(format!(
                "topic {} is written by {}, not by {}",
                topic.name,
                topic.writer.name(),
                p.name()
            ))),
            _ => Writer::new(&self.node, topic),
        }
    }

    /// A reader of a topic.
    pub fn reader<T: Record>(&self, topic: &Topic) -> Result<Reader<T>, IpcError> {
        right_type::<T>(topic)?;
        Reader::new(&self.node, topic)
    }

    /// Rings the processes that a topic wakes.
    pub fn bell(&self, topic: &Topic) -> Result<Bell, IpcError> {
        let names: Vec<&str> = topic.wakes.iter().map(|p| p.name()).collect();
        Bell::new(&self.node, &names)
    }

    /// Sleeps until somebody rings this process.
    pub fn waiter(&self, process: Process) -> Result<Waiter, IpcError> {
        Waiter::new(&self.node, process.name())
    }

    /// Sends into the queue `name`; every message wakes the [`Space::queue_waiter`] called `wakes`.
    pub fn queue_sender(&self, name: &str, wakes: &str) -> Result<QueueSender, IpcError> {
        QueueSender::new(self.commands()?, name, wakes)
    }

    /// Receives from the queue `name`.
    pub fn queue_receiver(&self, name: &str) -> Result<QueueReceiver, IpcError> {
        QueueReceiver::new(self.commands()?, name)
    }

    /// Sleeps until a queue that wakes `name` has something.
    pub fn queue_waiter(&self, name: &str) -> Result<QueueWaiter, IpcError> {
        QueueWaiter::new(self.commands()?, name)
    }

    /// For the supervisor, now and then, and before it starts a process again: clears away the ports of killed processes. Returns how
    /// many were cleared.
    pub fn clear_dead(&self) -> u64 {
        self.node.blocking_cleanup_dead_nodes(CLEAR_PATIENCE).cleanups
    }

    fn commands(&self) -> Result<&Node<Plane>, IpcError> {
        if self.commands.get().is_none() {
            let name = self.process.map_or(SUPERVISOR, Process::name);
            let _ = self.commands.set(node::<Plane>(&self.place, name)?);
        }
        Ok(self.commands.get().expect("set above"))
    }
}

/// Allows this process the files that its readers take, as far as it may.
fn allow_files() {
    let limit = getrlimit(Resource::Nofile);
    let wanted = limit.maximum.map_or(OPEN_FILES, |most| most.min(OPEN_FILES));
    if limit.current.is_some_and(|now| now < wanted) {
        let _ = setrlimit(Resource::Nofile, Rlimit { current: Some(wanted), ..limit });
    }
}

/// A node of one process, which touches no signal handler and prints errors only.
pub(crate) fn node<S: Service>(place: &RunPlace, name: &str) -> Result<Node<S>, IpcError> {
    set_log_level(LogLevel::Error);
    NodeBuilder::new()
        .name(&name.try_into().map_err(|e| because(name, e))?)
        .signal_handling_mode(SignalHandlingMode::Disabled)
        .config(&place.config()?)
        .create::<S>()
        .map_err(|e| because(format!("shared memory of {}", place.dir.display()), e))
}

fn right_type<T: Record>(topic: &Topic) -> Result<(), IpcError> {
    if topic.type_name == T::NAME {
        return Ok(());
    }
    Err(IpcError::Other(format!("topic {} holds {}, not {}", topic.name, topic.type_name, T::NAME)))
}

/// Shared memory that a space with these topics needs \[B\].
fn needed(topics: &[Topic]) -> u64 {
    topics.iter().filter_map(|t| with_type(t.name, Bytes)).sum::<u64>() + SPARE
}

struct Bytes;
impl ForType<u64> for Bytes {
    fn call<T: Record>(self, topic: &'static Topic) -> u64 {
        slot::bytes::<T>(topic)
    }
}

/// Makes all slots of a topic.
struct Create<'a> {
    node: &'a Node<RealTime>,
}
impl ForType<Result<Vec<SlotService>, IpcError>> for Create<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<Vec<SlotService>, IpcError> {
        (0..writers(topic.writer)).map(|k| slot::create::<T>(self.node, topic, k)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Sensors;
    use messages::topics::SENSORS;

    fn left(place: &RunPlace) -> usize {
        let names = std::fs::read_dir("/dev/shm").unwrap().map(|e| e.unwrap().file_name());
        names.filter(|name| name.to_string_lossy().starts_with(&place.prefix)).count()
    }

    /// Another user could cut one of them to nothing, and the supervisor hung when it cleared up after an observer.
    #[test]
    fn nobody_else_may_open_what_is_shared() {
        use std::os::unix::fs::MetadataExt;
        let dir = std::env::temp_dir().join(format!("gangwerk-ipc-{}-closed", std::process::id()));
        let system = Space::create(&dir).unwrap();
        let lowlevel = Space::open(&dir, Process::Lowlevel).unwrap();
        let _queue = lowlevel.queue_receiver("x").unwrap();
        let files = std::fs::read_dir("/dev/shm").unwrap().map(Result::unwrap);
        let own = files.filter(|f| f.file_name().to_string_lossy().starts_with(&system.place.prefix));
        let open: Vec<_> = own.filter(|f| f.metadata().is_ok_and(|m| m.mode() & 0o077 != 0)).collect();
        assert!(open.is_empty(), "{open:?}");
    }

    /// Memory the objects really take \[B\].
    fn size(place: &RunPlace) -> u64 {
        use std::os::unix::fs::MetadataExt;
        let files = std::fs::read_dir("/dev/shm").unwrap().map(Result::unwrap);
        let own = files.filter(|f| f.file_name().to_string_lossy().starts_with(&place.prefix));
        own.map(|f| f.metadata().unwrap().blocks() * 512).sum()
    }

    #[test]
    fn nothing_is_left_behind() {
        let dir = std::env::temp_dir().join(format!("gangwerk-ipc-{}-left", std::process::id()));
        let system = Space::create(&dir).unwrap();
        let place = system.place.clone();
        let observer = Space::open(&dir, Process::Observer).unwrap();
        let reader = observer.reader::<Sensors>(&SENSORS).unwrap();
        drop(observer.queue_receiver("x").unwrap());
        assert!(left(&place) > TOPICS.iter().map(|topic| writers(topic.writer)).sum());
        assert!(size(&place) <= needed(TOPICS), "{} > {}", size(&place), needed(TOPICS));
        drop((reader, observer));
        drop(system);
        assert_eq!(left(&place), 0);
        assert!(!dir.exists());
    }
}
