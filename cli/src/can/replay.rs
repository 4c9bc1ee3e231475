//! `gangwerk can replay FILE`: recorded frames on the lines of this machine.
//!
//! | how | when a frame is sent |
//! |---|---|
//! | original timing | its time after the first one, slept absolutely: lateness does not add up; none across a step of the clock |
//! | `--speed X` | the same, X times as fast |
//! | `--as-fast-as-consumed` | the answers to a cycle as soon as the peer's SYNC of this cycle was seen on the line |

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Duration;

use fieldbus::Capture;
use fieldbus::capture::Captured;
use fieldbus::cycles::{Cycles, Unwrapped, counter};
use fieldbus::interface::InterfaceError;
use fieldbus::tap::{Player, Tap};
use realtime::{Stop, clock};

use super::decoder::FrameDecoder;
use super::{Only, file};

/// Between two looks whether to end.
const LOOK: Duration = Duration::from_millis(50);
/// A peer that consumes sends its next SYNC within this time \[ns\].
const PATIENCE: u64 = 10 * clock::SECOND;

/// Replay options.
#[derive(clap::Args)]
pub struct ReplayOptions {
    /// A candump log, ASC, TRC or an MCAP file.
    pub file: PathBuf,
    /// Play what was recorded on A on the interface B; without it every frame goes to the interface of its name.
    #[arg(long, value_name = "A=B")]
    pub map: Vec<String>,
    /// So many times as fast as it was.
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = speed, conflicts_with = "as_fast_as_consumed")]
    pub speed: f64,
    /// The drives' recorded answers, cycle by cycle, as the peer's SYNC frames ask for them; for a joint loop in lockstep.
    #[arg(long, requires = "robot")]
    pub as_fast_as_consumed: bool,
    /// Only one direction; needs --robot.
    #[arg(long, requires = "robot", conflicts_with = "as_fast_as_consumed")]
    pub only: Option<Only>,
    /// Robot whose frames these are.
    #[arg(long, value_name = "NAME")]
    pub robot: Option<String>,
    /// Begin when the first frame of somebody else is heard.
    #[arg(long)]
    pub wait: bool,
    /// Leave broken lines out, and tell how many.
    #[arg(long)]
    pub lenient: bool,
}

fn speed(text: &str) -> Result<f64, String> {
    let speed: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    let sensible = (1e-3..=1e3).contains(&speed);
    sensible.then_some(speed).ok_or_else(|| format!("{speed}: 0.001 to 1000 times as fast"))
}

/// Replays to the end of the recording, or until Ctrl-C.
///
/// # Errors
/// The recording is broken, an interface cannot be used, nobody consumes.
pub fn run(config: &Path, order: &ReplayOptions) -> Result<(), Box<dyn Error>> {
    let capture = file::read(&order.file, order.lenient)?;
    let mut decoder = order.robot.as_deref().map(|name| FrameDecoder::load(config, name)).transpose()?;
    if let Some(decoder) = &mut decoder {
        capture.frames.iter().for_each(|frame| decoder.learn(frame));
    }
    let goes = |frame: &Captured| decoder.as_ref().is_none_or(|decoder| decoder.goes(frame, order.only));
    let frames: Vec<(&Captured, u64)> =
        capture.frames.iter().zip(capture.elapsed()).filter(|(frame, _)| goes(frame)).collect();
    if frames.is_empty() {
        return Err(format!("{}: no frame of it goes that way", order.file.display()).into());
    }
    let names = mapped(&capture, &order.map)?;
    let stop = Stop::on_signals()?;
    let tap = (order.wait || order.as_fast_as_consumed).then(|| Tap::open(&names)).transpose()?;
    let player = Player::open(&names)?;
    if order.as_fast_as_consumed
        && let (Some(decoder), Some(tap)) = (&decoder, &tap)
    {
        let send = |frame: &Captured| player.send(frame.line as usize, frame);
        return Answering::new(decoder, &capture, send).run(tap, &stop);
    }
    if let Some(tap) = tap {
        eprintln!("waiting for a frame on {}", names.join(", "));
        while tap.next(LOOK)?.is_none() {
            if stop.asked() {
                return Ok(());
            }
        }
    }
    timed(&frames, &player, order.speed, &stop)
}

/// The interface of this machine for every line of the recording.
fn mapped(capture: &Capture, map: &[String]) -> Result<Vec<String>, Box<dyn Error>> {
    let mut names = capture.lines.clone();
    for pair in map {
        let (from, to) = pair
            .split_once('=')
            .filter(|(from, to)| !from.is_empty() && !to.is_empty())
            .ok_or_else(|| format!("--map {pair}: it must be RECORDED=INTERFACE"))?;
        let line = capture.lines.iter().position(|line| line == from).ok_or_else(|| {
            format!("--map {pair}: nothing was recorded on {from}; there is {}", capture.lines.join(", "))
        })?;
        names[line] = to.to_owned();
    }
    Ok(names)
}

/// Every frame at its time \[ns\] after the first one.
fn timed(
    frames: &[(&Captured, u64)],
    player: &Player,
    speed: f64,
    stop: &Stop,
) -> Result<(), Box<dyn Error>> {
    let begun = clock::now();
    let (mut sent, mut latest) = (0u64, 0u64);
    let first = frames.first().map_or(0, |(_, elapsed)| *elapsed);
    for (frame, elapsed) in frames {
        let due = begun + ((elapsed - first) as f64 / speed) as u64;
        if !sleep_until(due, stop) {
            break;
        }
        player.send(frame.line as usize, frame)?;
        latest = latest.max(clock::now().saturating_sub(due));
        sent += 1;
    }
    let seconds = (clock::now() - begun) as f64 * 1e-9;
    println!("{sent} frames in {seconds:.3} s, at most {:.3} ms late", latest as f64 * 1e-6);
    Ok(())
}

/// `false` if somebody asked to end meanwhile.
fn sleep_until(due_ns: u64, stop: &Stop) -> bool {
    loop {
        if stop.asked() {
            return false;
        }
        let now = clock::now();
        if now >= due_ns {
            return true;
        }
        clock::sleep_until(due_ns.min(now + LOOK.as_nanos() as u64));
    }
}

/// Answers the SYNC frames of a peer with what the drives answered in the recording.
struct Answering<'a, S> {
    decoder: &'a FrameDecoder,
    capture: &'a Capture,
    cycles: Cycles,
    send: S,
    /// By node: tick of its newest SYNC.
    ticks: Vec<Unwrapped>,
    answered: Vec<Option<u64>>,
    sent: u64,
}

impl<'a, S: FnMut(&Captured) -> Result<(), InterfaceError>> Answering<'a, S> {
    fn new(decoder: &'a FrameDecoder, capture: &'a Capture, send: S) -> Self {
        let nodes = decoder.layout().nodes.len();
        let cycles = Cycles::of(decoder.layout(), &decoder.owners, capture);
        let (ticks, answered) = (vec![Unwrapped::default(); nodes], vec![None; nodes]);
        Self { decoder, capture, cycles, send, ticks, answered, sent: 0 }
    }

    fn run(mut self, tap: &Tap, stop: &Stop) -> Result<(), Box<dyn Error>> {
        let (first, ticks) = (self.cycles.first(), self.cycles.ticks());
        if ticks == 0 {
            return Err(
                "there is no SYNC frame of this robot in the recording: its cycles cannot be told apart; \
                        replay it in its original timing, or record both directions"
                    .into(),
            );
        }
        eprintln!("ready: cycles {first} to {} wait for the peer's SYNC frames", ticks - 1);
        let mut heard = clock::now();
        while !stop.asked() && !self.done() {
            match tap.next(LOOK)? {
                Some(frame) if self.answer(&frame)? => heard = clock::now(),
                Some(_) => {}
                // Before its first SYNC the peer may take as long as it likes.
                None if self.sent > 0 && clock::now() > heard + PATIENCE => {
                    return Err(self.silence(ticks).into());
                }
                None => {}
            }
        }
        let last = self.answered.iter().flatten().max().copied().unwrap_or(0);
        println!("{} frames; cycles {first} to {last} of {}", self.sent, ticks - 1);
        Ok(())
    }

    fn silence(&self, ticks: u64) -> String {
        let last = self.answered.iter().flatten().max().copied().unwrap_or(0);
        format!(
            "the peer sent no SYNC for 10 s: it was answered up to cycle {last} of {}; its own messages say why it ended",
            ticks - 1
        )
    }

    /// Whether every node was answered to the end of the recording.
    fn done(&self) -> bool {
        let last = self.cycles.ticks() - 1;
        let over = |(node, answered): (usize, &Option<u64>)| {
            self.cycles.exchange(node, last).is_none() || answered.is_some_and(|tick| tick >= last)
        };
        self.answered.iter().enumerate().all(over)
    }

    /// Answers a frame if it is a SYNC; `true` if it was one.
    fn answer(&mut self, frame: &Captured) -> Result<bool, InterfaceError> {
        let layout = self.decoder.layout();
        let mut was_sync = false;
        for node in self.decoder.owners.nodes(layout, frame.line, frame.id) {
            let Some(m) = layout.find(node as u32, frame.id).map(|i| &layout.messages[i]) else { continue };
            let Some((counter, bits)) = m.is_sync().then(|| counter(m, frame)).flatten() else { continue };
            was_sync = true;
            let tick = self.ticks[node].next(counter, bits);
            if self.answered[node].replace(tick) == Some(tick) {
                continue; // one SYNC of several for the same cycle
            }
            for i in self.cycles.exchange(node, tick).map_or(&[][..], |exchange| &exchange.answered) {
                (self.send)(&self.capture.frames[*i as usize])?;
                self.sent += 1;
            }
        }
        Ok(was_sync)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chain::Chain;
    use config::Setup;
    use fieldbus::FrameType;
    use lowlevel::JointLoop;
    use messages::{BusFrames, Sensors};

    /// A walk's traffic on nine lines, what lowlevel made of it, and the targets it was given.
    fn recorded(setup: &Setup, ticks: u64) -> (Capture, Vec<Sensors>, Vec<messages::JointTargets>) {
        let mut chain = Chain::new(setup).unwrap();
        let mut capture = Capture::default();
        let mut add = |frames: &BusFrames| {
            for frame in frames.as_slice() {
                let mut one = Captured::of(frame, frames.header.stamp_ns, FrameType::Fd { flags: 5 });
                one.line = capture.line(&format!("vcan{}", frame.line));
                capture.frames.push(one);
            }
        };
        let (mut sensors, mut targets) = (Vec::new(), Vec::new());
        add(chain.answer());
        for _ in 0..ticks {
            let cycle = chain.step();
            sensors.push(cycle.sensors);
            targets.push(cycle.joint_targets);
            add(chain.told());
            add(chain.answer());
        }
        (capture, sensors, targets)
    }

    /// A joint loop whose far end is the replay reads the same sensor data and sends the same frames as in the recording.
    #[test]
    fn a_replay_as_fast_as_consumed_is_for_the_joint_loop_what_the_robot_was() {
        let root = config::root(None);
        let setup = Setup::load(&root, "walk_2kmh").unwrap().with_method(None).unwrap();
        let (capture, sensors, targets) = recorded(&setup, 300);
        let mut decoder = FrameDecoder::load(&root, "lola").unwrap();
        capture.frames.iter().for_each(|frame| decoder.learn(frame));
        let sent = std::cell::RefCell::new(Vec::new());
        let mut replay = Answering::new(&decoder, &capture, |frame: &Captured| {
            sent.borrow_mut().push(*frame);
            Ok(())
        });
        let mut joints = JointLoop::new(&setup.robot, &setup.system, setup.scene.cycle);
        // As on CAN the joint loop asks for the first state with a SYNC of tick 0: twice, as if it was impatient.
        let mut told = BusFrames::default();
        codec::frames::encode_targets(&setup.robot.layout, &Default::default(), &mut told);
        let mut ask = |told: &BusFrames| {
            for frame in told.as_slice() {
                replay.answer(&Captured::of(frame, 0, FrameType::Fd { flags: 5 })).unwrap();
            }
        };
        ask(&told);
        for tick in 1..=300u64 {
            ask(&told);
            let mut answers = BusFrames::default();
            answers.header.tick = tick - 1;
            for frame in sent.borrow_mut().drain(..) {
                assert!(answers.push(&frame.frame(frame.line)), "one answer to each question");
            }
            let logged = &sensors[tick as usize - 1];
            assert_eq!(joints.receive(tick, logged.header.stamp_ns, Some(&answers)), logged, "cycle {tick}");
            told = *joints.send(Some(&targets[tick as usize - 1]), None).0;
        }
        assert!(!replay.done(), "the answer to the last cycle was not asked for");
        for frame in told.as_slice() {
            replay.answer(&Captured::of(frame, 0, FrameType::Fd { flags: 5 })).unwrap();
        }
        assert!(replay.done());
        let silence = replay.silence(301);
        assert!(silence.contains("cycle 300 of 300"), "{silence}");
    }

    #[test]
    fn maps_of_interfaces_name_what_is_wrong() {
        let capture = Capture { lines: vec!["vcan0".into(), "vcan1".into()], ..Capture::default() };
        let names = |map: &[&str]| {
            mapped(&capture, &map.iter().map(|m| m.to_string()).collect::<Vec<_>>())
                .map_err(|e| e.to_string())
        };
        assert_eq!(names(&["vcan1=can3"]).unwrap(), ["vcan0", "can3"]);
        assert!(names(&["vcan2=can3"]).unwrap_err().contains("there is vcan0, vcan1"));
        assert!(names(&["vcan2"]).unwrap_err().contains("RECORDED=INTERFACE"));
    }
}
