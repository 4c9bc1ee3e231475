//! One exploration of one room: the whole way from the truth through camera, pilot, datagrams, network and gate to a command.

use std::collections::VecDeque;
use std::net::SocketAddr;

use chain::Chain;
use chain::ending::{Ending, WalkEnd};
use config::Setup;
use gateway::gate::Gate;
use gateway::sight::{Sight, Witness};
use gateway::trigger::{Trigger, flag};
use messages::command::{Command, VelocityCommand};
use messages::{GaitState, SimState};
use sim_backend::eye::{Eye, Lens};
use sim_backend::terrain::environment;
use vision::{Line, Pilot, Speeds};

use super::floor::Floor;
use super::network::{Faults, Network};
use super::outline::Outline;
use super::room::Room;
use crate::Error;
use crate::random::Random;

/// \[1/s\] Triggers.
const RATE: f64 = 10.0;
/// \[s\] When the robot has stood up and the pilot begins, and \[s\] how long it may take to stand once the vision system is dead.
const STANDS: f64 = 4.0;
const STOPS: f64 = 8.0;
/// \[s\] Between two looks at the outline, and \[m\] between two points of the way that is drawn.
const TOUCH: f64 = 0.05;
const DRAWN: f64 = 0.05;
/// Where its datagrams come from.
const ADDRESS: ([u8; 4], u16) = ([127, 0, 0, 1], 47201);

/// What an exploration is.
pub(super) struct Case<'a> {
    pub(super) setup: &'a Setup,
    pub(super) room: &'a Room,
    pub(super) faults: Faults,
    /// \[s\]
    pub(super) time: f64,
    pub(super) speeds: Speeds,
    /// \[s\] From a trigger to its answer: least and most.
    pub(super) delay: [f64; 2],
    pub(super) seed: u64,
}

/// How it ended.
pub(super) struct Explored {
    pub(super) end: WalkEnd,
    /// \[s\]
    pub(super) time: f64,
    pub(super) touched: Option<Touch>,
    /// \[1\] Share of the floor that the robot got to.
    pub(super) share: f64,
    /// \[m\] @world Way of the torso.
    pub(super) way: Vec<[f64; 2]>,
    /// She stood after the vision system was gone.
    pub(super) stood: bool,
    /// Datagrams accepted and refused, and velocities that the planner refused.
    pub(super) datagrams: [u64; 3],
}

/// What touched first.
pub(super) struct Touch {
    pub(super) object: String,
    pub(super) link: String,
    /// \[s\]
    pub(super) time: f64,
    /// \[m\] @world Place of the torso.
    pub(super) at: [f64; 2],
}

/// Robot and vision system, with a network between them.
struct Session {
    chain: Chain,
    witness: Witness,
    /// As the newest trigger told.
    sight: Option<Sight>,
    gate: Gate,
    eye: Eye,
    pilot: Pilot,
    line: Line,
    triggers: Network,
    answers: Network,
    delay: [f64; 2],
    random: Random,
    /// Due time \[s\], trigger, and what was seen at it.
    seen: VecDeque<(f64, Trigger, Vec<[f64; 3]>)>,
    /// \[s\] Time of the last velocity that moved her.
    walks: Option<f64>,
    sequence: u64,
    refused: u64,
}

/// Explores a room.
///
/// # Errors
/// The robot cannot be built.
pub(super) fn explore(case: &Case<'_>) -> Result<Explored, Error> {
    let mut session = Session::new(case)?;
    let (mut floor, mut outline) = (Floor::new(case.room), Outline::new(&case.setup.robot)?);
    let mut world = environment(&case.setup.scene)?;
    let (mut ending, mut touched, mut way) = (Ending::default(), None, Vec::<[f64; 2]>::new());
    let (mut time, mut looked) = (0.0, 0.0);
    let cycle = session.chain.cycle();
    let end = STANDS + case.time;
    while time < end + STOPS {
        time += cycle;
        session.step(time, time < end);
        let c = session.chain.last();
        ending.follow(time, c);
        if ending.end().0 != WalkEnd::Done {
            break;
        }
        // Seldom, for it costs as much as many cycles: what does she touch, and where has she been?
        if time - looked > TOUCH {
            looked = time;
            let truth: &SimState = &c.sim_state;
            world.place_at(truth.time, &truth.object_delay);
            let at = [truth.position[0], truth.position[1]];
            touched = touched.or_else(|| {
                outline.touched(truth, &world).map(|(object, link)| Touch { object, link, time, at })
            });
            if way.last().is_none_or(|last| (last[0] - at[0]).hypot(last[1] - at[1]) > DRAWN) {
                floor.visit(at);
                way.push(at);
            }
        }
    }
    let stood = GaitState::from(session.chain.last().controller_state.gait) == GaitState::Standing;
    let refused = session.gate.refused.iter().sum();
    Ok(Explored {
        end: ending.end().0,
        time: time.min(ending.end().1),
        touched,
        share: floor.share(),
        way,
        stood,
        datagrams: [session.gate.accepted, refused, session.refused],
    })
}

impl Session {
    fn new(case: &Case<'_>) -> Result<Self, Error> {
        let Case { setup, faults, seed, .. } = *case;
        Ok(Self {
            chain: Chain::new(setup)?,
            witness: Witness::new(setup)?,
            sight: None,
            gate: Gate::default(),
            eye: Eye::new(&setup.robot, &setup.scene, Lens::default(), seed)?,
            pilot: Pilot::new(case.speeds),
            line: Line::new(1),
            triggers: Network::new(faults, seed ^ 1),
            answers: Network::new(faults, seed ^ 2),
            delay: case.delay,
            random: Random(seed ^ 3),
            seen: VecDeque::new(),
            walks: None,
            sequence: 0,
            refused: 0,
        })
    }

    /// One bus cycle; with a vision system, or without.
    fn step(&mut self, time: f64, sees: bool) {
        let c = self.chain.step();
        let refused = c
            .answers
            .iter()
            .filter(|(command, verdict)| matches!(command, Command::Velocity(_)) && verdict.is_err());
        self.refused += refused.count() as u64;
        let stamp = (time * 1e9) as u64;
        if time * RATE >= self.sequence as f64 {
            self.trigger(stamp, time);
        }
        let triggers = self.triggers.arrived(time);
        if sees && time > STANDS {
            self.see(time, &triggers);
        }
        // The gateway's part, as `gateway::link` has it between processes.
        for datagram in self.answers.arrived(time) {
            let admitted = self.gate.admit(&datagram, SocketAddr::from(ADDRESS), stamp);
            let Ok(command) = admitted else { continue };
            self.gate.accepted += 1;
            if let Command::Velocity(VelocityCommand { forward, left, turn }) = command {
                self.walks = ([forward, left, turn] != [0.0; 3]).then_some(time);
            }
            self.chain.command(&self.sight.map_or(command, |sight| sight.command(&command)));
        }
        if self.walks.is_some_and(|last| time - last > gateway::SILENCE as f64 * 1e-9) {
            self.walks = None;
            self.chain.command(&Command::Stop);
        }
    }

    /// Sends a trigger.
    fn trigger(&mut self, stamp: u64, time: f64) {
        self.sequence += 1;
        let (c, height) = (self.chain.last(), self.chain.plan().height);
        let sight = self.witness.see(&c.sensors, &c.controller_state, height);
        self.sight = Some(sight);
        let trigger = Trigger {
            sender: 2,
            sequence: self.sequence,
            stamp,
            cycle: sight.cycle,
            flags: flag::ROBOT | flag::LEASE,
            gait: sight.gait,
            odometry: sight.odometry,
            frames: sight.frames,
            accepted: self.gate.accepted,
            refused: self.gate.refused,
        };
        self.gate.triggered(stamp);
        self.triggers.send(time, &trigger.encode());
    }

    /// The vision system's part: what has come in is seen now, and answered when it is understood.
    fn see(&mut self, time: f64, triggers: &[Vec<u8>]) {
        for trigger in triggers.iter().filter_map(|bytes| Trigger::decode(bytes).ok()) {
            let points = self.eye.look(&self.chain.last().sim_state);
            self.seen.push_back((time + self.random.within(self.delay), trigger, points));
        }
        while self.seen.front().is_some_and(|(due, ..)| *due <= time)
            && let Some((_, trigger, points)) = self.seen.pop_front()
        {
            let answer = self.pilot.answer(&trigger, &points);
            let datagrams = answer.map(|answer| self.line.datagrams(&trigger, &answer)).unwrap_or_default();
            datagrams.iter().for_each(|datagram| self.answers.send(time, datagram));
        }
    }
}
