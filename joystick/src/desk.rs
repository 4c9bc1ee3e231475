//! Link to the broker of one robot after the other: deeds of the pilot out, answers and news of the robot back.
//!
//! One thread does all of it, and heartbeats as well: a program that stands still or is gone loses the lease, and she stands.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

use broker::identity::is_own;
use broker::stream_client::{Answer, IDLE, News};
use broker::{Awaited, StreamClient};
use config::Setup;
use config::joystick::{ButtonFunction, Joystick};
use ipc::Run;
use messages::command::Domain;
use messages::command_answer::code;
use messages::{Command, GaitState, StartUp};
use realtime::clock::{SECOND, now, sleep_until};

use crate::pad::Hands;
use crate::pilot::{Ability, Deed, Pilot};
use crate::source::PadNews;
use crate::start_up::{RobotState, next_step};

/// Name at the broker.
const NAME: &str = "gangwerk joystick";
/// Between two looks for a robot \[ns\].
const SEARCH: u64 = SECOND / 4;
/// Longest silence towards the broker while the hands steer \[ns\].
const PING: u64 = SECOND / 10;
/// Time that this program may stand still while the hands steer \[ns\]: the lease lasts for 500 ms.
const STILL: u64 = SECOND * 4 / 10;
/// Between two commands of one step of the start-up \[ns\]: two edges in two cycles.
const EDGE: u64 = SECOND * 15 / 100;
/// States per second.
const RATE: u16 = 10;
/// Answers of the protocol after which a velocity is sent again: no answer in time, too old, from the future.
const AGAIN: [u8; 3] = [code::NO_ANSWER, code::TOO_OLD, code::FROM_THE_FUTURE];

/// Sink of lines for the operator.
pub type Say = fn(&str);

/// A robot that is connected.
struct Robot {
    client: StreamClient,
    pilot: Pilot,
    simulated: bool,
    /// Places of supply, start-up and gait among the numbers of a STATE.
    places: [usize; 3],
    state: RobotState,
    /// True if the broker has said that this program holds the lease.
    mine: bool,
    /// Names of what is not answered yet.
    awaited: Awaited<&'static str>,
}

/// The desk.
pub(crate) struct Desk<'a> {
    dir: PathBuf,
    layout: &'a Joystick,
    take_over: bool,
    say: Say,
    /// Last line about each matter.
    said: BTreeMap<&'static str, String>,
    robot: Option<Robot>,
    hands: Hands,
    next_search: u64,
    /// Time of the last look \[ns\].
    looked: u64,
}

impl<'a> Desk<'a> {
    pub(crate) fn new(dir: PathBuf, layout: &'a Joystick, take_over: bool, say: Say) -> Self {
        let (said, hands) = (BTreeMap::new(), Hands::default());
        Self { dir, layout, take_over, say, said, robot: None, hands, next_search: 0, looked: now() }
    }

    /// Longest time until the next look.
    pub(crate) fn wait(&self) -> Duration {
        let steers = self.robot.as_ref().is_some_and(|robot| robot.pilot.steers());
        Duration::from_millis(if steers { 5 } else { 50 })
    }

    /// A line about a matter, if it is another one than last time.
    fn tell(&mut self, matter: &'static str, line: String) {
        if self.said.get(matter) != Some(&line) {
            (self.say)(&line);
            self.said.insert(matter, line);
        }
    }

    /// News of the gamepad.
    pub(crate) fn hear(&mut self, news: PadNews) {
        self.check_time();
        let deeds = match news {
            PadNews::Here(line) => {
                self.tell("gamepad", line);
                if let Some(robot) = &mut self.robot {
                    robot.pilot.arrived(now());
                }
                Vec::new()
            }
            PadNews::Missing(line) => {
                self.tell("gamepad", line);
                Vec::new()
            }
            PadNews::Gone(line) => {
                self.tell("gamepad", line);
                // Nothing is held of one that is not there; she stops as after a release.
                self.hands = Hands::default();
                self.robot.as_mut().map_or(Vec::new(), |robot| robot.pilot.let_go())
            }
            PadNews::Hands(hands, pressed, at) => {
                self.hands = hands;
                match &mut self.robot {
                    Some(robot) => robot.pilot.hands(hands, &pressed, at, now()),
                    None => Vec::new(),
                }
            }
        };
        self.all(deeds);
    }

    /// One look: at the time, the robot, what is due.
    pub(crate) fn look(&mut self) {
        self.check_time();
        if self.robot.is_none() && now() >= self.next_search {
            self.search();
            self.next_search = now() + SEARCH;
            // Connecting takes its time, and nothing was held in it.
            self.looked = now();
        }
        if let Err(why) = self.listen() {
            self.lose(why);
        }
        let deed = self.robot.as_mut().and_then(|robot| robot.pilot.due(now()));
        self.all(deed);
        if let Err(why) = self.live() {
            self.lose(why);
        }
    }

    /// What was held or pressed while this program stood still does not count.
    fn check_time(&mut self) {
        let stood = now() - std::mem::replace(&mut self.looked, now());
        if stood <= STILL {
            return;
        }
        if self.robot.as_mut().is_some_and(|robot| robot.pilot.stood(now())) {
            self.lapsed(&format!("this program stood still for {} ms", stood / 1_000_000));
        }
    }

    /// The program ends: as a release.
    pub(crate) fn end(mut self) {
        let deeds = self.robot.as_mut().map_or(Vec::new(), |robot| robot.pilot.let_go());
        self.all(deeds);
        let until = now() + SECOND;
        while self.robot.as_ref().is_some_and(|robot| !robot.awaited.is_empty()) && now() < until {
            if let Err(why) = self.listen() {
                self.lose(why);
            }
        }
    }

    /// Connects to the robot, if there is one.
    fn search(&mut self) {
        match ipc::find_robot(&self.dir, |_, run| self.connect(run)) {
            Ok((mut robot, about)) => {
                // What is held already does not count.
                let deeds = robot.pilot.hands(self.hands, &[], 0, now());
                self.robot = Some(robot);
                self.tell("robot", about);
                self.all(deeds);
            }
            Err(why) => self.tell("robot", why.to_string()),
        }
    }

    fn connect(&self, run: &Run) -> Result<(Robot, String), String> {
        let setup = Setup::load(&run.config, &run.scene).map_err(|e| e.to_string())?;
        let mut client = StreamClient::connect(&self.dir, NAME)?;
        client.subscribe(&[Domain::Walk, Domain::System])?;
        let lines = client.watch(RATE, true)?;
        // Numbers of a STATE stand where its description says.
        let place = |name: &str| {
            let mut at = 0;
            for line in &lines {
                let mut words = line.split(' ');
                if words.next() == Some(name) {
                    return Ok(at);
                }
                at += words.next().and_then(|count| count.parse::<usize>().ok()).unwrap_or(1);
            }
            Err(format!("its state has no {name}"))
        };
        let places = [place("supply")?, place("start_up")?, place("gait")?];
        let velocities = setup.gait.velocities();
        let [[back, ahead], [right, left], [clockwise, anticlockwise]] = velocities;
        let held: Vec<&str> = self.layout.button(ButtonFunction::DeadMan).iter().map(|c| c.name).collect();
        let about = format!(
            "robot: {}, scene {}; hold {} to steer: forward {back:.2} to {ahead:.2} m/s, left {right:.2} to {left:.2} m/s, turn \
             {clockwise:.2} to {anticlockwise:.2} rad/s",
            setup.robot.name,
            run.scene,
            held.join(" or "),
        );
        // Until the first STATE nothing is known of her.
        let state = RobotState { supply: false, start_up: StartUp::Off, gait: GaitState::Idle };
        let pilot = Pilot::new(Ability { velocities, on_the_spot: setup.gait.on_the_spot() });
        let (simulated, awaited) = (run.robot, Awaited::default());
        Ok((Robot { client, pilot, simulated, places, state, mine: false, awaited }, about))
    }

    /// Does what the pilot wants.
    fn all(&mut self, deeds: impl IntoIterator<Item = Deed>) {
        for deed in deeds {
            if let Err(why) = self.one(deed) {
                self.lose(why);
            }
        }
    }

    fn one(&mut self, deed: Deed) -> Result<(), String> {
        let Some(robot) = &mut self.robot else { return Ok(()) };
        match deed {
            Deed::Take => {
                let over = self.take_over;
                let sequence = robot.client.ask_lease(over)?;
                robot.await_answer("lease", sequence);
                // The answers of this time are news, whatever they were the last time.
                self.said.retain(|matter, _| ["robot", "gamepad"].contains(matter));
                self.tell("dead man", "dead-man button held".into());
            }
            Deed::Give => {
                // Given back when the stop is accepted: without a lease she would stop for want of it.
                robot.mine = false;
                self.tell("dead man", "dead-man button released: she comes to a stand".into());
            }
            Deed::Send(command) => robot.send(&command)?,
            Deed::Next => match next_step(robot.state, robot.simulated) {
                Ok(commands) => {
                    for (i, command) in commands.iter().enumerate() {
                        if i > 0 {
                            sleep_until(now() + EDGE);
                        }
                        robot.send(command)?;
                    }
                }
                Err(why) => self.tell("next", format!("next step of the start-up: {why}")),
            },
            Deed::NeedsRelease => {
                self.tell("dead man", "release the dead-man button, and hold it again".into());
            }
            Deed::NeedsDeadMan(function) => {
                (self.say)(&format!("{}: hold the dead-man button first", function.name()));
            }
        }
        Ok(())
    }

    /// The hands do not steer any more until the dead-man button was released.
    fn lapse(&mut self, why: &str) {
        if self.robot.as_mut().is_some_and(|robot| robot.pilot.lapse()) {
            self.lapsed(why);
        }
    }

    /// The hands steered until now.
    fn lapsed(&mut self, why: &str) {
        let Some(robot) = &mut self.robot else { return };
        // A stop could be that of somebody else's walk; who gives the lease back leaves his own walk to stop.
        let given = robot.client.give_lease().map(drop);
        robot.mine = false;
        self.tell("dead man", format!("{why}: release the dead-man button, and hold it again"));
        if let Err(why) = given {
            self.lose(why);
        }
    }

    /// The connection is over; with it went the lease.
    fn lose(&mut self, why: String) {
        if self.robot.take().is_some() {
            self.tell("robot", format!("{why}; the robot is waited for"));
            self.next_search = now() + SEARCH;
        }
    }

    /// Heartbeats, and answers that are overdue.
    fn live(&mut self) -> Result<(), String> {
        let Some(robot) = &mut self.robot else { return Ok(()) };
        robot.client.keep_alive(if robot.pilot.steers() { PING } else { IDLE })?;
        robot.awaited.check(now())
    }

    /// Takes what the broker says.
    fn listen(&mut self) -> Result<(), String> {
        loop {
            let Some(robot) = &mut self.robot else { return Ok(()) };
            // A millisecond, in which this client says nothing by itself.
            let Some(news) = robot.client.news(Duration::from_millis(1))? else { return Ok(()) };
            match news {
                News::Answer(answer) => self.answered(answer)?,
                News::Command(by @ (Command::Stop | Command::End | Command::EmergencyStop)) => {
                    // A velocity of the hands may have come to her behind that stop: this one comes behind it.
                    if robot.pilot.steers() {
                        robot.send(&Command::Stop)?;
                    }
                    self.lapse(&format!("stopped by somebody else ({})", by.name()));
                }
                News::Lease(_, holder) => self.held_by(&holder),
                News::Event(_, name, _) if name == "planner LeaseLost" => {
                    self.lapse("the robot has not heard of this program for 500 ms and comes to a stand");
                }
                News::State(_, _, numbers) => self.seen(&numbers),
                _ => {}
            }
        }
    }

    fn answered(&mut self, answer: Answer) -> Result<(), String> {
        let Some(robot) = &mut self.robot else { return Ok(()) };
        let Some(name) = robot.awaited.take(&answer) else { return Ok(()) };
        let code = answer.code;
        if name == "walk/velocity" && AGAIN.contains(&code) {
            robot.pilot.forget();
        }
        if name == "walk/stop" && !robot.pilot.steers() {
            robot.client.give_lease()?;
        }
        match answer.accepted() {
            Ok(_) if name == "lease" => self.tell(name, "you steer".into()),
            Ok(by) => self.tell(name, format!("{name} accepted by {by}")),
            Err(why) if name == "lease" && code == code::LEASE_HELD => {
                self.lapse(&format!("{why}; --take-over takes the lease"));
            }
            Err(why) if name == "lease" => self.lapse(&why),
            Err(why) => self.tell(name, format!("{name} refused: {why}")),
        }
        Ok(())
    }

    /// The command lease has changed hands.
    fn held_by(&mut self, holder: &str) {
        let Some(robot) = &mut self.robot else { return };
        let mine = is_own(holder, NAME);
        let lost = std::mem::replace(&mut robot.mine, mine) && !mine;
        if lost {
            let by = if holder.is_empty() { "nobody holds it" } else { holder };
            self.lapse(&format!("the command lease is lost ({by})"));
        }
    }

    /// State of the robot.
    fn seen(&mut self, numbers: &[f32]) {
        let Some(robot) = &mut self.robot else { return };
        let [supply, start_up, gait] = robot.places.map(|at| numbers.get(at).copied().unwrap_or(0.0));
        let state = RobotState {
            supply: supply == 1.0,
            // Numbers that are not known yet become zero.
            start_up: StartUp::from_number(start_up as u64),
            gait: GaitState::from(gait as u64),
        };
        let before = std::mem::replace(&mut robot.state, state);
        if before.supply && !state.supply {
            self.lapse("the motor supply is off");
        } else if before.gait != state.gait && matches!(state.gait, GaitState::Fallen | GaitState::Halted) {
            self.lapse(if state.gait == GaitState::Fallen {
                "she has fallen"
            } else {
                "her joints were stopped"
            });
        }
    }
}

impl Robot {
    fn send(&mut self, command: &Command) -> Result<(), String> {
        let sequence = self.client.send(command)?;
        self.await_answer(command.name(), sequence);
        Ok(())
    }

    fn await_answer(&mut self, name: &'static str, sequence: u64) {
        self.awaited.insert(sequence, name, now());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Reason;

    /// The hands still hold it: a velocity is not forgotten because of when it came to the broker.
    #[test]
    fn a_velocity_of_the_wrong_time_is_sent_again() {
        for reason in [Reason::TooOld { age_ns: 0 }, Reason::FromTheFuture { lead_ns: 0 }] {
            assert!(AGAIN.contains(&reason.code()), "{reason:?}");
        }
        assert!(AGAIN.contains(&broker::Refusal::NoAnswer("planner").code()));
    }
}
