//! Faults that must not matter to a walking robot: broker, logger, observers, operators, strangers. One walk bears them all, then
//! the emergency stop ends it: F5, F6, F10 to F14, F20, F21, F26, F29, F30, F38.

use std::io::{Read as _, Write as _};
use std::net::{Ipv4Addr, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use harness::{Running, Signal, doze};
use messages::{EventCode, Process};

use super::lab::{FaultObservation, Found, Lab};
use super::robot::RobotUnderTest;
use super::scene::WALK;

/// Observers that are killed, and connections that say nothing.
const OBSERVERS: usize = 20;
const IDLE: usize = 100;
/// \[ms\] In which an operator has his answer.
const ANSWERED: f64 = 1000.0;
/// \[ms\] In which another broker and another logger are there: the first pause of the supervisor, and a start.
const BACK: f64 = 3000.0;
/// \[cycle\] From a request to the robot's power line, with the start of `gangwerk estop`.
const STOPPED: u64 = 100;
/// Times that the broker is killed, and how long that is watched \[s\].
const DEATHS: usize = 4;
const WATCHED: f64 = 8.0;

type Trial = fn(&mut RobotUnderTest, &Lab) -> Result<FaultObservation, String>;

/// In this order while it walks.
const WALKING: [Trial; 9] =
    [nan, out_of_range, second_instance, garbage, idle, flood, observers_killed, observer_stopped, no_broker];

pub(super) fn all(lab: &mut Lab) -> Found {
    let mut robot = lab.walking(lab.patient(), &[])?;
    let mut found = Vec::new();
    for trial in WALKING {
        robot.mark();
        let seen = trial(&mut robot, lab)?;
        robot.watch(0.2);
        found.push(seen.walks(&robot));
    }
    robot.mark();
    let seen = no_logger(&mut robot)?;
    found.push(seen.walks(&robot));
    let disturbed = robot.disturbance();
    found.extend(stop_under_flood(&mut robot)?);
    Ok((found, disturbed))
}

/// A command with a number that is none to be taken.
fn refused(robot: &RobotUnderTest, fault: &'static str, field: &str) -> Result<FaultObservation, String> {
    let code = robot.publish(&["walk/velocity", field])?.code;
    let seen = FaultObservation::new(fault, "refused").after_ms(robot.wall_ms());
    Ok(seen.demand(code == Some(1), format!("exit code 1, not {code:?}")))
}

fn nan(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    refused(robot, "F20", "forward=NaN")
}

fn out_of_range(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    refused(robot, "F21", "forward=9")
}

fn second_instance(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    let code = robot.site.run("fault", &["--no-log"]).try_end()?.code;
    let seen = FaultObservation::new("F26", "refused").after_ms(robot.wall_ms());
    Ok(seen.demand(code == Some(1), format!("exit code 1, not {code:?}")))
}

fn connect(robot: &RobotUnderTest) -> Result<TcpStream, String> {
    TcpStream::connect((Ipv4Addr::LOCALHOST, robot.site.port())).map_err(|e| e.to_string())
}

fn garbage(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    let mut stream = connect(robot)?;
    let sent = stream.write_all(b"GET / HTTP/1.1\r\nHost: lola\r\n\r\n");
    let limited = stream.set_read_timeout(Some(Duration::from_secs(3)));
    let closed = sent.and(limited).and_then(|()| stream.read_to_end(&mut Vec::new())).is_ok();
    let seen = FaultObservation::new("F13", "connection closed").after_ms(robot.wall_ms());
    Ok(seen.demand(closed, "closed within 3 s"))
}

/// An operator asks for something harmless and is answered.
fn answered(robot: &RobotUnderTest, seen: FaultObservation) -> Result<FaultObservation, String> {
    let begun = robot.wall_ms();
    let code = robot.publish(&["head/rest"])?.code;
    let took = robot.wall_ms() - begun;
    let seen = seen.after_ms(took).demand(code == Some(0), "an operator is answered");
    Ok(seen.demand(took < ANSWERED, format!("answered within {ANSWERED} ms")))
}

fn idle(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    let _connections: Vec<_> = (0..IDLE).map_while(|_| connect(robot).ok()).collect();
    answered(robot, FaultObservation::new("F14", "an operator is answered"))
}

/// Connections, and frames on them, as fast as a thread makes them, until it is dropped.
struct Flood(Arc<AtomicBool>, Option<std::thread::JoinHandle<()>>);

impl Flood {
    fn on(port: u16) -> Self {
        let going = Arc::new(AtomicBool::new(true));
        let on = going.clone();
        let work = move || {
            while on.load(Relaxed) {
                if let Ok(mut stream) = TcpStream::connect((Ipv4Addr::LOCALHOST, port)) {
                    let _ = stream.write_all(&[16, 0, 0, 0]).and_then(|()| stream.write_all(&[0x55; 16]));
                }
                doze(0.0004);
            }
        };
        Self(going, Some(std::thread::spawn(work)))
    }
}

impl Drop for Flood {
    fn drop(&mut self) {
        self.0.store(false, Relaxed);
        self.1.take().map(std::thread::JoinHandle::join);
    }
}

fn flood(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    let _flood = Flood::on(robot.site.port());
    robot.watch(0.3);
    answered(robot, FaultObservation::new("F12", "an operator is answered"))
}

fn observer(robot: &RobotUnderTest) -> Running {
    let dir = robot.site.run_dir().display().to_string();
    robot.site.start(&["topic", "echo", "sensors", "--dir", &dir])
}

fn observers_killed(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    for _ in 0..OBSERVERS {
        let observer = observer(robot);
        robot.watch(0.03);
        observer.signal_supervisor(Signal::KILL);
        observer.try_end()?;
    }
    let dir = robot.site.run_dir().display().to_string();
    let next = robot.site.start(&["topic", "echo", "sensors", "--once", "--dir", &dir]).try_end()?;
    let seen = FaultObservation::new("F10", "the next one reads").after_ms(robot.wall_ms());
    Ok(seen.demand(next.code == Some(0), "the next one reads"))
}

fn observer_stopped(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    let observer = observer(robot);
    robot.watch(0.2);
    let before = robot.late_cycles()[2];
    observer.signal_supervisor(Signal::STOP);
    robot.watch(1.0);
    let late = robot.late_cycles()[2] - before;
    observer.signal_supervisor(Signal::KILL);
    let seen = FaultObservation::new("F11", format!("{late} late cycles"));
    Ok(seen.demand(late == 0, "no cycle of the joint loop is late"))
}

/// Kills it, and waits until the supervisor has started it again.
fn again(robot: &mut RobotUnderTest, process: Process) -> bool {
    let before = robot.pid(process);
    robot.run.kill(process);
    robot.wait(BACK * 1e-3, |robot| robot.pid(process).is_some_and(|pid| Some(pid) != before))
}

fn no_broker(robot: &mut RobotUnderTest, _: &Lab) -> Result<FaultObservation, String> {
    let back = again(robot, Process::Broker);
    let ms = robot.wall_ms();
    let answers = answers(robot)?;
    let seen = FaultObservation::new("F5", "another one started").after_ms(ms).demand(back, "another broker");
    Ok(seen.demand(answers, "it answers an operator"))
}

/// Answer to an operator by a broker that was started again, before long.
fn answers(robot: &mut RobotUnderTest) -> Result<bool, String> {
    for _ in 0..10 {
        if robot.publish(&["head/rest"])?.code == Some(0) {
            return Ok(true);
        }
        robot.watch(0.2);
    }
    Ok(false)
}

fn no_logger(robot: &mut RobotUnderTest) -> Result<FaultObservation, String> {
    let back = again(robot, Process::Logger);
    let ms = robot.wall_ms();
    let part = robot.site.path("fault.2.mcap");
    robot.wait(3.0, |_| part.exists());
    let seen = FaultObservation::new("F6", "another one started").after_ms(ms).demand(back, "another logger");
    Ok(seen.demand(part.exists(), "a second part of the log"))
}

/// F30, then F29.
fn stop_under_flood(robot: &mut RobotUnderTest) -> Result<[FaultObservation; 2], String> {
    let load = Flood::on(robot.site.port());
    robot.watch(0.2);
    robot.mark();
    let dir = robot.site.run_dir().display().to_string();
    let code = robot.site.start(&["estop", "--dir", &dir]).try_end()?.code;
    robot.watch(0.2);
    drop(load);
    let stopped = FaultObservation::new("F30", "answered, supply off")
        .after(robot.power_off(), robot)
        .within(STOPPED)
        .demand(code == Some(0), "answered")
        .demand(robot.told(Process::Watchdog, EventCode::EmergencyStop).is_some(), "told who asked");
    robot.mark();
    robot.publish(&["system/enable"])?;
    robot.watch(0.6);
    let early = robot.after().iter().any(|s| s.power == 1);
    robot.publish(&["system/reset"])?;
    robot.watch(0.3);
    robot.mark();
    robot.publish(&["system/enable"])?;
    let on = robot.wait(2.0, |robot| robot.after().last().is_some_and(|s| s.power == 1));
    let again = FaultObservation::new("F29", "off until reset and enable")
        .demand(!early, "an enable alone is none")
        .demand(on, "on again after both");
    Ok([stopped, again])
}

/// The broker dies again and again: later and later it is there again, and the robot walks on. That a process is there is not
/// enough: once the fifth found no room for its topics, and took no command.
pub(super) fn dying_broker(lab: &mut Lab) -> Found {
    let mut robot = RobotUnderTest::start(lab.patient(), WALK, &["--no-log"])?;
    robot.until(1.0)?;
    robot.mark();
    let mut back = Vec::new();
    for _ in 0..DEATHS {
        let before = robot.pid(Process::Broker);
        let begun = robot.wall_ms();
        robot.run.kill(Process::Broker);
        if !robot.wait(WATCHED, |robot| robot.pid(Process::Broker).is_some_and(|pid| Some(pid) != before)) {
            break;
        }
        back.push(robot.wall_ms() - begun);
        robot.watch(0.05);
    }
    let later = back.windows(2).all(|w| w[1] > w[0]) && back.len() == DEATHS;
    let times: Vec<String> = back.iter().map(|ms| format!("{:.1} s", ms * 1e-3)).collect();
    let answers = answers(&mut robot)?;
    let last = if answers { "the last one answers" } else { "the last one does not answer" };
    let seen = FaultObservation::new("F38", format!("started again after {}; {last}", times.join(", ")))
        .demand(later, "later and later")
        .demand(answers, "the last one answers an operator")
        .demand(!robot.fell() && robot.power_off().is_none(), "on its feet, supply on");
    let disturbed = robot.disturbance();
    Ok((vec![seen], disturbed))
}
