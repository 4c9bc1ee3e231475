//! External plant: another simulator behind a socket, in place of the simulated robot (docs/external_plant.md).
//!
//! The peer of these tests speaks the protocol from its page, with nothing of ours but, where a walk is walked, our own
//! simulated robot of type 1 behind it.

use harness::{Said, Site};
use messages::{BusFrames, Header, JointMode, JointTargets, Power, Sensors};
use recording::payload_hashes;
use serde_json::Value;
use sim_backend::SimBackend;
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;

const EXE: &str = harness::executable!();

/// One cycle as it crosses the socket.
struct Asked {
    tick: u64,
    powered: f64,
    push: Vec<f64>,
    angle: Vec<f64>,
    speed: Vec<f64>,
    task: Vec<f64>,
}

/// The other end of the socket.
struct Peer {
    stream: BufReader<UnixStream>,
    hello: Value,
}

impl Peer {
    fn accept(listener: &UnixListener) -> Self {
        let (stream, _) = listener.accept().unwrap();
        let mut stream = BufReader::new(stream);
        let mut line = String::new();
        stream.read_line(&mut line).unwrap();
        Self { stream, hello: serde_json::from_str(&line).unwrap() }
    }

    fn joints(&self) -> usize {
        self.hello["joints"].as_array().unwrap().len()
    }

    /// What it asks next; none: it has ended.
    fn asked(&mut self) -> Option<Asked> {
        let mut word = || {
            let mut bytes = [0; 8];
            self.stream.read_exact(&mut bytes).ok().map(|()| bytes)
        };
        let (tick, count) = (u64::from_le_bytes(word()?), u64::from_le_bytes(word()?));
        let mut numbers: Vec<f64> = (0..count).map(|_| f64::from_le_bytes(word().unwrap())).collect();
        let n = self.joints();
        assert_eq!(numbers.len(), 4 + 3 * n);
        let task = numbers.split_off(4 + 2 * n);
        let speed = numbers.split_off(4 + n);
        let angle = numbers.split_off(4);
        Some(Asked { tick, powered: numbers[0], push: numbers.split_off(1), angle, speed, task })
    }

    fn answer(&mut self, tick: u64, numbers: &[f64]) {
        let mut bytes = [tick, numbers.len() as u64].map(u64::to_le_bytes).as_flattened().to_vec();
        bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        let _ = self.stream.get_mut().write_all(&bytes); // the other end may be gone
    }
}

/// Runs a scene with `peer` behind the socket.
fn run(site: &Site, arguments: &[&str], peer: impl FnOnce(Peer) + Send) -> Said {
    let path = site.path("plant.sock");
    let listener = UnixListener::bind(&path).unwrap();
    let socket = path.display().to_string();
    std::thread::scope(|scope| {
        scope.spawn(|| peer(Peer::accept(&listener)));
        site.gangwerk(&[&["sim", "walk", "--json", "--plant", &socket], arguments].concat())
    })
}

/// Numbers of a robot that hangs in the air and follows its targets at once.
fn hanging(joints: usize, angle: &[f64]) -> Vec<f64> {
    let n = joints;
    let still = vec![0.0; n];
    let mut numbers = [angle, &still, angle, &still, &vec![f64::NAN; n]].concat();
    numbers.extend([0.0; 12]); // force sensors
    numbers.extend([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 9.81]); // inertial measurement unit
    numbers.extend([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]); // pose
    numbers.extend([0.0; 9 + 12 + 8 + 193]); // no contact point
    numbers
}

/// Our own robot of type 1: what it is asked goes to it as frames, what it answers comes back as numbers.
fn type_1(site: &Site, mut peer: Peer) {
    let setup = config::Setup::load(&site.config(""), "walk").unwrap();
    let (robot, layout) = (&setup.robot, &setup.robot.layout);
    let mut scene = setup.scene.clone();
    scene.pushes.clear(); // they come over the socket
    let mut sim = SimBackend::new(robot, &scene).unwrap().with_relay(setup.system.toggle_missed);
    let mut frames = BusFrames::default();
    while let Some(asked) = peer.asked() {
        let mut command = codec::frames::DriveCommand::default();
        let header = Header { tick: asked.tick, ..Header::default() };
        let JointTargets { header: of, mode, angle, speed } = &mut command.targets;
        (*of, *mode) = (header, JointMode::Track as u64);
        angle[..asked.angle.len()].copy_from_slice(&asked.angle);
        speed[..asked.speed.len()].copy_from_slice(&asked.speed);
        for (word, task) in command.control.iter_mut().zip(&asked.task) {
            let follows = *task == 1.0;
            *word =
                u32::from(if follows { drives::cia402::ENABLE_OPERATION } else { drives::cia402::SHUTDOWN });
        }
        codec::frames::encode_targets(layout, &command, &mut frames);
        let on = u64::from(asked.powered == 1.0);
        let power = Power { header, toggle: asked.tick, on, arming: on, ..Power::default() };
        if asked.push.iter().any(|f| *f != 0.0) {
            let force = asked.push.try_into().unwrap();
            sim.push(&messages::command::PushCommand { force, duration: 0.9 * scene.cycle });
        }
        let told = asked.tick > 0;
        let (answer, truth) = sim.step(told.then_some(&frames), told.then_some(&power));
        let mut s = Sensors::default();
        codec::frames::decode_sensors(layout, answer, &mut s);
        let n = peer.joints();
        let mut numbers = [&truth.joint_angle[..n], &s.joint_speed[..n]].concat();
        numbers.extend([&truth.motor_angle[..n], &s.motor_speed[..n], &s.motor_current[..n]].concat());
        let wrenches =
            |w: &[messages::Wrench; 2]| w.map(|w| [w.force, w.moment]).as_flattened().as_flattened().to_vec();
        numbers.extend(wrenches(&s.foot_wrench));
        numbers.extend([&s.imu.orientation[..], &s.imu.angular_velocity, &s.imu.acceleration].concat());
        numbers.extend([&truth.position[..], &truth.orientation, &truth.velocity].concat());
        numbers.extend([&truth.angular_velocity[..], &truth.com].concat());
        numbers.extend(wrenches(&truth.foot_wrench));
        numbers.extend(truth.feet.as_flattened());
        numbers.push(truth.contacts as f64);
        numbers.extend(truth.contact.iter().flat_map(|c| [c.place, c.normal].concat()));
        peer.answer(asked.tick, &numbers);
    }
}

/// Stands up, walks, is pushed; with our own robot behind the socket every record is the same, bit for bit.
#[test]
fn a_walk_across_the_socket_is_the_walk() {
    let site = Site::new(EXE);
    let push = "[[push]]\ntime = 4.5\nduration = 0.1\nforce = [0.0, 20.0, 0.0]\n";
    site.scene("walk", 6.0, &format!("{}{push}", harness::WALK));
    let log = |name: &str| site.path(name).display().to_string();
    site.gangwerk(&["sim", "walk", "--json", "--log", &log("own.mcap")]).well();
    run(&site, &["--log", &log("plant.mcap")], |peer| type_1(&site, peer)).well();
    let hashes = |name: &str| -> BTreeMap<String, u64> {
        payload_hashes(Path::new(&log(name)), |_| true).unwrap().into_iter().collect()
    };
    let (own, plant) = (hashes("own.mcap"), hashes("plant.mcap"));
    assert!(own.len() > 8, "{own:?}");
    let differ: Vec<_> = own.iter().filter(|(channel, hash)| plant.get(*channel) != Some(hash)).collect();
    assert!(differ.is_empty() && own.len() == plant.len(), "{differ:?}");
}

/// Every way in which a plant can go wrong ends the run with one sentence that names it.
#[test]
fn a_plant_that_goes_wrong_ends_the_run() {
    type Fault = fn(&mut Peer, u64, Vec<f64>) -> bool;
    let nan = |peer: &mut Peer, tick, mut numbers: Vec<f64>| {
        numbers[7] = f64::NAN;
        peer.answer(tick, &numbers);
        true
    };
    let infinite_current = |peer: &mut Peer, tick, mut numbers: Vec<f64>| {
        let n = peer.joints();
        numbers[4 * n] = f64::INFINITY;
        peer.answer(tick, &numbers);
        true
    };
    let no_orientation = |peer: &mut Peer, tick, mut numbers: Vec<f64>| {
        let n = peer.joints();
        numbers[5 * n + 15] = 0.0;
        peer.answer(tick, &numbers);
        true
    };
    let short = |peer: &mut Peer, tick, mut numbers: Vec<f64>| {
        numbers.pop();
        peer.answer(tick, &numbers);
        true
    };
    let of_yesterday = |peer: &mut Peer, tick: u64, numbers: Vec<f64>| {
        peer.answer(tick - 1, &numbers);
        true
    };
    let half = |peer: &mut Peer, tick: u64, _| {
        let _ = peer.stream.get_mut().write_all(&tick.to_le_bytes());
        false
    };
    let gone = |_: &mut Peer, _, _| false;
    let silent = |_: &mut Peer, _, _| true;
    let absurd = |peer: &mut Peer, tick, mut numbers: Vec<f64>| {
        numbers[5 * peer.joints() + 2] = 1e300;
        peer.answer(tick, &numbers);
        true
    };
    // A byte now and then is no answer.
    let slow = |peer: &mut Peer, _, _| {
        while peer.stream.get_mut().write_all(&[0]).is_ok() {
            harness::doze(0.05);
        }
        false
    };
    let table: [(Fault, &str); 10] = [
        (nan, "joint_angle[7] is NaN, which no robot has, in cycle 50"),
        (infinite_current, "motor_current[0] is inf, which no robot has, in cycle 50"),
        (absurd, "foot_wrench[2] is 1e300, which no robot has, in cycle 50"),
        (slow, "did not answer within 0.5 s, in cycle 50"),
        (no_orientation, "an orientation has the norm 0, in cycle 50"),
        (short, "370 numbers instead of 371, in cycle 50"),
        (of_yesterday, "answered cycle 49, in cycle 50"),
        (half, "closed the connection, in cycle 50"),
        (gone, "closed the connection, in cycle 50"),
        (silent, "did not answer within 0.5 s, in cycle 50"),
    ];
    for (fault, expected) in table {
        let site = Site::new(EXE);
        site.edit("system.toml", "peer_timeout = 5.0", "peer_timeout = 0.5");
        site.scene("walk", 1.0, "");
        let said = run(&site, &[], |mut peer| {
            while let Some(asked) = peer.asked() {
                let numbers = hanging(peer.joints(), &asked.angle);
                if asked.tick < 50 {
                    peer.answer(asked.tick, &numbers);
                } else if !fault(&mut peer, asked.tick, numbers) {
                    return;
                }
            }
        });
        check(&said, expected);
    }
}

/// A plant that is not there, and scenes that are not for one.
#[test]
fn what_no_plant_can_do_is_refused_at_the_start() {
    let site = Site::new(EXE);
    site.scene("walk", 1.0, "");
    check(&site.gangwerk(&["sim", "walk", "--plant", "/nowhere.sock"]), "/nowhere.sock: cannot be reached");
    let fault = "[[bus_fault]]\ntime = 0.5\nduration = 0.1\nkind = \"lost\"\nshare = 0.02\n";
    for (key, tables) in
        [("bus_fault", fault), ("plant_mismatch", "[plant_mismatch]\ncontact_stiffness = 0.5\n")]
    {
        site.scene("walk", 1.0, tables);
        check(&site.gangwerk(&["sim", "walk", "--plant", "/nowhere.sock"]), &format!("scene walk: `{key}`"));
    }
}

#[track_caller]
fn check(said: &Said, expected: &str) {
    assert_eq!(said.code, Some(1), "{expected}: {said:#?}");
    let errors: Vec<&str> = said.err.lines().collect();
    assert!(errors.len() == 1 && errors[0].contains(expected), "{expected}: {said:#?}");
}

/// The page's example, which is all that it takes to stand behind the socket.
#[test]
fn the_example_of_the_page_stands() {
    let site = Site::new(EXE);
    site.scene("walk", 1.0, "[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n");
    let page = include_str!("../docs/external_plant.md");
    let code = page.split("```python\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let socket = site.path("plant.sock").display().to_string();
    let mut python = std::process::Command::new("python3").args(["-c", code, &socket]).spawn().unwrap();
    while !Path::new(&socket).exists() {
        harness::doze(0.01);
    }
    let said = site.gangwerk(&["sim", "walk", "--json", "--plant", &socket]).well();
    let figures: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!((&figures["ended_by"], &figures["depth"]), (&"done".into(), &"external plant".into()));
    assert!(python.wait().unwrap().success());
}
