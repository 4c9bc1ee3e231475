//! Shared memory between the processes: the only crate that names iceoryx2.
//!
//! - [`Space`]: everything one running robot shares, under one directory. `create` for the supervisor, `open` for the
//!   processes. Two robots, or two tests, have two spaces and never meet.
//! - [`Writer`], [`Reader`]: the records of [`messages::TOPICS`]. A write allocates nothing, takes no lock and makes no
//!   system call; a reader gets the newest record or follows every one of them.
//! - [`Bell`], [`Waiter`]: wake a process that sleeps until its input is there.
//! - [`QueueSender`], [`QueueReceiver`], [`QueueWaiter`]: small byte messages of the command plane, not for control cycles;
//!   [`Doorbell`]: how a control cycle wakes the thread that moves them.
//! - [`StopLine`], [`StopButton`]: the emergency stop's own socket, which needs nothing of all this.
//! - [`Run`]: what a process started with `gangwerk PROCESS --run DIR` needs to know.
//! - [`find_robot`]: search for the robot that runs, for programs beside it.
//!
//! Why it is built this way: `docs/decisions/0002-data-plane.md`.

mod bell;
mod error;
mod lock;
mod place;
mod queue;
mod reader;
mod run;
mod run_dir;
mod search;
mod slot;
mod space;
mod stop_line;
mod writer;

pub use bell::{Bell, Waiter, Woken};
pub use error::IpcError;
pub use queue::{Doorbell, MAX_MESSAGE, QueueReceiver, QueueSender, QueueWaiter};
pub use reader::Reader;
pub use run::{Mode, Run};
pub use run_dir::{CONFIG, default_dir, publish_file, withdraw_file, wrong_dir};
pub use search::{NoRobot, find_robot};
pub use slot::writers;
pub use space::{Space, owner, supervisor};
pub use stop_line::{Asker, Datagram, StopAnswer, StopButton, StopLine, StopName};
pub use writer::Writer;
