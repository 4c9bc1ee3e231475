//! `gangwerk topic pub`: a command, its answer, and the operator's presence for as long as the robot walks by it.
//!
//! Whoever moves the robot holds the command lease, and a walk without an end ends with the lease. So this program stays
//! while the robot walks, gives heartbeats ten times a second, and stops the walk when it ends; if it is killed, or its
//! terminal hangs, the lease runs out and the robot stops by itself.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use broker::StreamClient;
use broker::identity::is_own;
use broker::stream_client::News;
use ipc::{Reader, Space};
use messages::command::Domain;
use messages::command_answer::code;
use messages::topics::CONTROLLER_STATE;
use messages::{Command, ControllerState, GaitState, Process};
use realtime::{Stop, clock};

/// Command to send, and options.
#[derive(Clone, Debug)]
pub struct OperatorRequest {
    /// Name of the command.
    pub command: String,
    /// `field=number`.
    pub fields: Vec<String>,
    /// A walk without an end: stop after so many seconds.
    pub seconds: Option<f64>,
    /// Send it again so often \[1/s\].
    pub rate: Option<f64>,
    /// Send it so many times.
    pub times: Option<u64>,
    /// Take the command lease from whoever holds it.
    pub take_over: bool,
}

/// Name at the broker.
const NAME: &str = "gangwerk topic pub";
/// Tries of a command that became too old on its way, as on a machine that is busy starting up.
const TRIES: u32 = 5;
/// Longest time until a skill begins to move the robot \[ns\].
const BEGIN: u64 = 5 * clock::SECOND;
/// Most commands per second; the broker refuses what is far more.
const MOST_PER_SECOND: f64 = 100.0;
/// Between two looks at what the robot does, and between two heartbeats.
const LOOK: Duration = Duration::from_millis(50);

/// Sends a command and waits for its answer: the process that accepted it.
///
/// # Errors
/// The reason of the refusal.
pub fn give(client: &mut StreamClient, command: &Command, take_over: bool) -> Result<String, String> {
    if take_over && command.needs_lease() {
        accepted(client, |client| client.ask_lease(true))?;
    }
    accepted(client, |client| client.send(command))
}

/// Who accepted a request, which is made again if it became too old on its way: it was not carried out then, and whoever waits
/// here still wants it.
fn accepted(
    client: &mut StreamClient,
    request: impl Fn(&mut StreamClient) -> Result<u64, String>,
) -> Result<String, String> {
    let mut tries = TRIES;
    loop {
        let sequence = request(client)?;
        let answer = client.answer(sequence)?;
        tries -= 1;
        if answer.code != code::TOO_OLD || tries == 0 {
            return answer.accepted();
        }
    }
}

/// Sends a command through the broker of the run in `dir`, tells who accepted it, and stays while the robot walks by it.
///
/// # Errors
/// The command is refused, there is no broker, or the link or the lease is lost while the robot walks.
pub fn publish(dir: &Path, order: &OperatorRequest) -> Result<(), Box<dyn Error>> {
    let command = Command::parse(&order.command, &order.fields.join(" "))?;
    if order.seconds.is_some_and(|s| !(s.is_finite() && s > 0.0)) {
        return Err("--for: a number of seconds above 0 is needed".into());
    }
    if order.rate.is_some_and(|hz| !(hz > 0.0 && hz <= MOST_PER_SECOND)) {
        return Err(
            format!("--rate: a number above 0 and up to {MOST_PER_SECOND} per second is needed").into()
        );
    }
    let mut client = StreamClient::connect(dir, NAME)?;
    if matches!(command, Command::EmergencyStop) {
        // Nothing else comes first.
        println!("{} accepted by {}", command.name(), give(&mut client, &command, false)?);
        return Ok(());
    }
    let stop = Stop::on_signals()?;
    client.subscribe(&[Domain::Walk, Domain::System])?;
    let process = give(&mut client, &command, order.take_over)?;
    println!("{} accepted by {process}", command.name());
    if order.rate.is_some() || order.times.is_some() {
        return repeat(&mut client, &stop, order, &command);
    }
    if command.is_unbounded() {
        let end = match order.seconds {
            Some(seconds) => format!("stops after {seconds} s or at Ctrl-C"),
            None => "stops at Ctrl-C, or when this program ends".into(),
        };
        println!("the robot walks while this program runs: it {end}");
        accompany(&mut client, &stop, order.seconds, || false)?;
    } else if matches!(command, Command::Distance(_) | Command::Platform(_)) {
        println!("the robot is on its way: this program stays until it stands; Ctrl-C stops it");
        let mut skill = SkillProgress::watch(dir)?;
        accompany(&mut client, &stop, order.seconds, || skill.is_done())?;
    }
    Ok(())
}

/// Sends a command that was accepted once again and again, as often and as many times as is ordered; a walk without an end
/// that goes on until Ctrl-C is stopped then.
fn repeat(
    client: &mut StreamClient,
    stop: &Stop,
    order: &OperatorRequest,
    command: &Command,
) -> Result<(), Box<dyn Error>> {
    let period = (1e9 / order.rate.unwrap_or(1.0)) as u64;
    let (begun, times) = (clock::now(), order.times.unwrap_or(u64::MAX));
    for n in 1..times {
        // Heartbeats between two of them: the lease does not last for long.
        while clock::now() < begun + n * period && !stop.asked() {
            client.ping()?;
            let left = (begun + n * period).saturating_sub(clock::now());
            clock::sleep_until(clock::now() + left.min(LOOK.as_nanos() as u64));
        }
        if stop.asked() {
            if command.is_unbounded() {
                println!("walk/stop accepted by {}", give(client, &Command::Stop, false)?);
            }
            break;
        }
        println!("{} accepted by {}", command.name(), give(client, command, false)?);
    }
    Ok(())
}

/// Keeps the lease until `done`, or somebody ends it: then the robot is stopped and its answer awaited.
fn accompany(
    client: &mut StreamClient,
    stop: &Stop,
    seconds: Option<f64>,
    mut done: impl FnMut() -> bool,
) -> Result<(), Box<dyn Error>> {
    // News of the time before this client had the lease may still be on their way.
    let mut mine = false;
    let until = seconds.map_or(u64::MAX, |s| clock::now().saturating_add((s * 1e9) as u64));
    while !stop.asked() && clock::now() < until {
        if done() {
            println!("done: the robot stands");
            return Ok(());
        }
        client.ping()?;
        match client.news(LOOK)? {
            Some(News::Command(by @ (Command::Stop | Command::End | Command::EmergencyStop))) => {
                println!("stopped by somebody else: {}", by.name());
                return Ok(());
            }
            Some(News::Lease(_, holder)) if is_own(&holder, NAME) => mine = true,
            Some(News::Lease(_, holder)) if mine => {
                let now =
                    if holder.is_empty() { "nobody holds it".into() } else { format!("{holder} has it") };
                return Err(format!("the command lease is lost: {now}").into());
            }
            _ => {}
        }
    }
    let process = give(client, &Command::Stop, false)?;
    println!("walk/stop accepted by {process}");
    Ok(())
}

/// Whether a skill that was accepted has been done: the robot moves, and then stands.
struct SkillProgress {
    state: Reader<ControllerState>,
    _space: Space,
    begun: bool,
    since: u64,
}

impl SkillProgress {
    fn watch(dir: &Path) -> Result<Self, Box<dyn Error>> {
        let space = Space::open(dir, Process::Observer)?;
        Ok(Self { state: space.reader(&CONTROLLER_STATE)?, _space: space, begun: false, since: clock::now() })
    }

    fn is_done(&mut self) -> bool {
        let Some(state) = self.state.latest() else { return false };
        let moves = !GaitState::from(state.gait).rests();
        self.begun |= moves || clock::now() > self.since + BEGIN;
        self.begun && !moves
    }
}
