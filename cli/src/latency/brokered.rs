//! Commands from one client of the broker to another, and their answers.

use std::path::Path;
use std::process::Child;

use broker::Client;
use broker::daemon::{Tcp, serve};
use ipc::{Run, Space};
use latency::{Link, LinkEnd, Opened, spin};
use messages::command::PushCommand;
use messages::{Command, CommandSource, Process};
use realtime::Stop;

use super::Helper;

fn text(e: impl std::fmt::Display) -> String {
    e.to_string()
}

struct Commands {
    client: Client,
    end: LinkEnd,
    stamp: u64,
    _space: Space,
    _made: Option<(Helper, Space)>,
}

/// The near end commands and hears the answer, the far one takes commands and answers.
pub(super) fn commands(dir: &Path, end: LinkEnd, start: impl Fn(&str) -> Result<Child, String>) -> Opened {
    let mut made = None;
    if end == LinkEnd::Near {
        let space = Space::create(dir).map_err(text)?;
        Run::bare(dir).save().map_err(text)?;
        made = Some((Helper(start("broker")?), space));
    }
    let (process, name) = match end {
        LinkEnd::Near => (Process::Observer, "operator"),
        LinkEnd::Far => (Process::SimBackend, Process::SimBackend.name()),
    };
    let space = Space::open(dir, process).map_err(text)?;
    let client = Client::start(name, process.command_domains(), &space)?;
    spin(|| client.statistics().connected.then_some(()))?;
    Ok(Box::new(Commands { client, end, stamp: 0, _space: space, _made: made }))
}

/// The broker itself, a third process, until its parent ends.
pub(super) fn broker(dir: &Path) -> Result<(), String> {
    serve(&Run::bare(dir), &Tcp { address: None, keys: None }, &Stop::default())
}

impl Link for Commands {
    fn send(&mut self, stamp: u64) -> Result<(), String> {
        self.stamp = stamp;
        if self.end == LinkEnd::Near {
            let push = PushCommand { force: [0.0; 3], duration: 0.1 };
            self.client.publish(&Command::Push(push)).ok_or("the ring of commands is full")?;
        }
        Ok(())
    }

    fn receive(&mut self) -> Result<u64, String> {
        let Self { client, end, .. } = self;
        spin(|| {
            std::thread::yield_now();
            if *end == LinkEnd::Near {
                return client.answered().map(drop);
            }
            let live = client.next()?;
            client.answer(&live, Ok(()));
            Some(())
        })?;
        Ok(self.stamp)
    }
}
