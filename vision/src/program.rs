//! `gangwerk explore`: the pilot at a running robot's vision interface.

use std::collections::VecDeque;
use std::net::{SocketAddr, UdpSocket};
use std::path::{Path, PathBuf};
use std::time::Duration;

use config::Setup;
use gateway::owner;
use gateway::trigger::{Trigger, flag};
use ipc::{Reader, Run, Space};
use messages::topics::SIM_STATE;
use messages::{Process, SimState};
use realtime::Stop;
use realtime::clock::{SECOND, now};
use sim_backend::eye::{Eye, Lens};

use crate::Line;
use crate::pilot::{Pilot, Speeds};

/// Longest wait for a trigger \[ns\], and the silence of a gateway that is worth a line.
const LOOK: u64 = SECOND / 100;
const SILENCE: u64 = 2 * SECOND;
/// Age of a trigger from which on the cameras, which look when it is read, no longer see what it tells of \[ns\].
const STALE: u64 = SECOND / 10;
/// Longest datagram that is read.
const LONGEST: usize = 512;

/// Options of the program.
#[derive(Clone, Debug)]
pub struct Options {
    /// Run directory of the simulated robot, whose world its cameras see.
    pub dir: PathBuf,
    /// Address to which the gateway sends triggers.
    pub listen: SocketAddr,
    /// Greatest velocities.
    pub speeds: Speeds,
    /// \[ns\] From a trigger to its answer: what pictures take to be understood.
    pub delay: u64,
    /// \[ns\] Time after which it stops her and ends; none: until it is asked to.
    pub time: Option<u64>,
    /// Seed of the cameras' errors.
    pub seed: u64,
}

/// Why the program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Asked to, or its time was over; she was told to stop.
    Asked,
    /// Somebody else has stopped her or taken her over.
    Held,
}

/// Trigger with what the cameras saw at it.
type Sight = (Trigger, Vec<[f64; 3]>);

/// Cameras of a simulated robot.
struct Cameras {
    eye: Eye,
    truth: Reader<SimState>,
    // Dropped last, after its reader.
    _space: Space,
}

impl Cameras {
    fn open(dir: &Path, seed: u64) -> Result<Self, String> {
        let run = Run::load(dir).map_err(|e| format!("no robot runs in {}: {e}", dir.display()))?;
        let setup = Setup::load(&run.config, &run.scene).map_err(|e| e.to_string())?;
        let eye = Eye::new(&setup.robot, &setup.scene, Lens::default(), seed).map_err(|e| e.to_string())?;
        let space = Space::open(dir, Process::Observer).map_err(|e| e.to_string())?;
        let truth = space.reader(&SIM_STATE).map_err(|e| e.to_string())?;
        Ok(Self { eye, truth, _space: space })
    }

    fn look(&mut self) -> Option<Vec<[f64; 3]>> {
        let truth = *self.truth.latest()?;
        Some(self.eye.look(&truth))
    }
}

/// Explores until `stop` or the end of its time; lines for the operator go to `say`.
///
/// # Errors
/// No simulated robot runs there, or the address cannot be listened on.
pub fn run(options: &Options, stop: &Stop, say: fn(&str)) -> Result<End, String> {
    let listen = options.listen;
    let refused =
        |e| format!("cannot listen on {listen}: {e}; another address: --listen, and --to of the gateway");
    let socket = UdpSocket::bind(listen).map_err(refused)?;
    socket.set_read_timeout(Some(Duration::from_nanos(LOOK))).map_err(refused)?;
    let mut cameras = Cameras::open(&options.dir, options.seed)?;
    let (mut pilot, mut line) = (Pilot::new(options.speeds), Line::new(std::process::id().into()));
    let (begin, mut heard, mut told) = (now(), now(), false);
    let (mut seen, mut last, mut may) = (VecDeque::<Sight>::new(), None, false);
    let mut bytes = [0; LONGEST];
    // A trigger is when the cameras look; its answer goes back some time later.
    while !stop.asked() && options.time.is_none_or(|time| now() - begin < time) {
        if let Ok((length, from)) = socket.recv_from(&mut bytes)
            && owner::is_trusted(from)
            && let Ok(trigger) = Trigger::decode(&bytes[..length])
        {
            (heard, told) = (now(), false);
            // Starting this program ends an earlier stop, and none that comes later.
            match trigger.flags & flag::HELD != 0 {
                true if may => return Ok(End::Held),
                true => drop(socket.send_to(&line.stop(&trigger), from)),
                false => may = true,
            }
            let fresh = now().saturating_sub(trigger.stamp) < STALE;
            if trigger.flags & flag::ROBOT != 0
                && fresh
                && let Some(points) = cameras.look()
            {
                seen.push_back((trigger, points));
                last = Some((trigger, from));
            }
        }
        if !told && now() - heard > SILENCE {
            say(&format!("no trigger on {listen}: gangwerk gateway --to {listen} sends them"));
            told = true;
        }
        while let Some((trigger, _)) = seen.front()
            && let Some((_, to)) = last
            && now() - trigger.stamp >= options.delay
            && let Some((trigger, points)) = seen.pop_front()
        {
            let answer = pilot.answer(&trigger, &points);
            for datagram in answer.iter().flat_map(|answer| line.datagrams(&trigger, answer)) {
                // One that is lost is as one of a camera that saw nothing: the next one comes.
                let _ = socket.send_to(&datagram, to);
            }
        }
    }
    if let Some((trigger, to)) = last {
        let _ = socket.send_to(&line.stop(&trigger), to);
    }
    Ok(End::Asked)
}
