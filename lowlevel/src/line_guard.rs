//! Guard of the lines: sensor data that the joint loop believes, node by node, and its reaction to missing frames.
//!
//! | cycles without all frames of a node | reaction |
//! |---|---|
//! | 1 to `carried_on` | its joints are taken to move on at their last speed, inside of their ranges |
//! | to `missed` | its joints are taken to stand; other readings are kept |
//! | more | controlled stop, [`EventCode::NodeSilent`]; none for a node that the robot can walk without |
//!
//! Late and repeated frames, wrong lengths and unknown identifiers never reach the readings: they are as good as lost, and
//! counted. A reading that cannot be ([`crate::reading`]) makes its node missing for the cycle. A controller that left the
//! bus is a stop and no power ([`EventCode::BusOff`]), until it takes part again.

use std::hash::{Hash, Hasher};

use codec::frames::Received;
use codec::layout::{Carries, FrameLayout};
use config::{Robot, System};
use drives::cia402::{DriveState, REFERENCED, state_of};
use fieldbus::{ErrorFrame, ErrorState};
use messages::{BusCounters, BusFrames, Detail, EventCode, EventQueue, RefusedFrame, Sensors};

use crate::reading::{ReadingBounds, Readings, copy_joint};

/// One local controller, with the line it is on.
#[derive(Clone, Debug, Default)]
struct GuardedNode {
    reads: Readings,
    /// Cycles in a row in which not all came.
    missed: u32,
    /// The robot can walk without it: it is held, and nobody stops.
    spare: bool,
    /// Something came since the start.
    known: bool,
    /// State of lowlevel's controller on its line.
    line: ErrorState,
}

/// Guards the readings of one robot.
#[derive(Clone, Debug)]
pub(crate) struct LineGuard {
    bounds: ReadingBounds,
    carried_on: u32,
    missed: u32,
    nodes: Vec<GuardedNode>,
    /// Node that reads each joint.
    node_of: [usize; messages::MAX_JOINTS],
    /// Drives that said once that they are not enabled.
    doubted: [bool; messages::MAX_JOINTS],
    /// Joints that said once that they found out where they are, or that they no longer know.
    referenced: [bool; messages::MAX_JOINTS],
    /// Sensor data expected in this cycle, before its frames are read.
    believed: Sensors,
    counters: BusCounters,
    /// Frames of a whole cycle.
    frames: u64,
    /// Number of times a node went missing.
    gaps: u64,
    /// Number of times frames were refused, by [`RefusedFrame`].
    refused: [u64; 6],
    layout: FrameLayout,
    events: EventQueue,
}

impl LineGuard {
    pub(crate) fn new(robot: &Robot, system: &System, dt: f64) -> Self {
        // Nodes by what they read; each joint is read by one of them.
        let spare = |i: usize| robot.spare.contains(&i);
        let nodes = Readings::of(robot).into_iter().enumerate();
        let nodes: Vec<GuardedNode> = nodes
            .map(|(i, reads)| GuardedNode { reads, spare: spare(i), ..GuardedNode::default() })
            .collect();
        let mut node_of = [0; messages::MAX_JOINTS];
        for (i, node) in nodes.iter().enumerate() {
            node.reads.joints.iter().for_each(|&j| node_of[j] = i);
        }
        Self {
            bounds: ReadingBounds::new(robot, system.bus, dt),
            carried_on: system.bus.carried_on,
            missed: system.bus.missed,
            nodes,
            node_of,
            doubted: [false; messages::MAX_JOINTS],
            referenced: [false; messages::MAX_JOINTS],
            believed: Sensors::default(),
            counters: BusCounters::default(),
            frames: robot.layout.sent(false).count() as u64,
            gaps: 0,
            refused: [0; 6],
            layout: robot.layout.clone(),
            events: EventQueue::default(),
        }
    }

    /// Before the frames of a cycle are read: expects its sensor data without them.
    pub(crate) fn expect(&mut self, sensors: &mut Sensors) {
        for node in self.nodes.iter().filter(|node| node.known) {
            self.bounds.carry_on(&node.reads, node.missed < self.carried_on, sensors);
        }
        self.believed = *sensors;
    }

    /// After they were read: finds the nodes that are complete, and puts back readings that cannot be, `skipped` cycles of
    /// the joint loop's own after the last one.
    pub(crate) fn judge(
        &mut self,
        frames: Option<&BusFrames>,
        received: &Received,
        skipped: u32,
        sensors: &mut Sensors,
    ) {
        let powered = self.believed.power == 1;
        // Frames as such: error frames, counters. The supply is one bit, so a change of it goes by the vote of all nodes,
        // and first, for what follows depends on it.
        match frames {
            Some(frames) => {
                self.read_errors(frames);
                self.count(received);
                if sensors.power != self.believed.power {
                    sensors.power = u64::from(self.most_say_powered(frames));
                }
            }
            None => self.counters.lost += self.frames,
        }
        // Readings, node by node. A joint that has just found its reference may jump, so these are known before any jump
        // is judged.
        let found = if powered { self.doubt_references(sensors) } else { [false; messages::MAX_JOINTS] };
        for i in 0..self.nodes.len() {
            let node = &self.nodes[i];
            let mut complete = frames.is_some() && received.complete(i);
            // Without power a joint may be moved by hand, and nobody acts on what is read.
            let check = powered && node.known;
            let cycles = node.missed.saturating_add(skipped).saturating_add(1);
            // One reading that cannot be makes the whole node doubtful: its frames have one source.
            if check && !self.bounds.believes(&node.reads, &self.believed, sensors, cycles, &found) {
                node.reads.copy(&self.believed, sensors);
                for &j in node.reads.joints.iter().filter(|j| found[**j]) {
                    sensors.drive_status[j] ^= u32::from(REFERENCED);
                    self.referenced[j] = true;
                }
                self.refuse(RefusedFrame::Jump, 1);
                complete = false;
            }
            self.note(i, complete, sensors.power == 1);
        }
        // States last: of the statuswords that were not put back.
        self.doubt_states(sensors);
    }

    /// A drive that is no longer enabled is believed the second time it says so: a bent bit says it once. Without supply it is
    /// believed at once, so that nothing of before is left when the supply comes back.
    fn doubt_states(&mut self, sensors: &mut Sensors) {
        let powered = sensors.power == 1;
        let is_enabled = |status: u32| state_of(status as u16) == Some(DriveState::OperationEnabled);
        for (j, doubted) in self.doubted.iter_mut().enumerate() {
            let (before, now) = (self.believed.drive_status[j], &mut sensors.drive_status[j]);
            let falls = powered && is_enabled(before) && !is_enabled(*now);
            if falls && !*doubted {
                // All but what the joint says of its reference, which is doubted on its own.
                let reference = u32::from(REFERENCED);
                *now = before & !reference | *now & reference;
            }
            // What was doubted stays so over a cycle in which nothing was heard.
            let heard = self.nodes[self.node_of[j]].missed == 0;
            *doubted = if falls { !*doubted } else { *doubted && !heard };
        }
    }

    /// A joint that has found out where it is reads another angle from one cycle to the next. It is believed the second time
    /// it says so, as a bent bit says it once; until then its angle is carried on. Returns the joints that are believed now.
    fn doubt_references(&mut self, sensors: &mut Sensors) -> [bool; messages::MAX_JOINTS] {
        let mut found = [false; messages::MAX_JOINTS];
        let known = self.nodes.iter().filter(|node| node.known);
        for &j in known.flat_map(|node| &node.reads.joints) {
            let referenced = &mut self.referenced[j];
            let turned = (self.believed.drive_status[j] ^ sensors.drive_status[j]) & u32::from(REFERENCED);
            found[j] = turned != 0 && *referenced;
            *referenced = turned != 0 && !*referenced;
            if *referenced {
                sensors.drive_status[j] ^= turned;
                copy_joint(j, &self.believed, sensors);
            }
        }
        found
    }

    /// Why the joints must come to rest.
    pub(crate) fn cause(&self) -> Option<(EventCode, Detail)> {
        if let Some(line) = self.off() {
            return Some((EventCode::BusOff, Detail::Number(line as u64)));
        }
        let silent = |node: &GuardedNode| node.missed > self.missed;
        let i = self.nodes.iter().position(|node| silent(node) && !node.spare)?;
        let cycles = self.nodes[i].missed;
        match self.nodes.iter().all(silent) {
            true => Some((EventCode::BusSilent, Detail::Cycles(cycles.into()))),
            false => Some((EventCode::NodeSilent, Detail::NodeCycles(i, cycles))),
        }
    }

    /// A line whose controller is off the bus.
    pub(crate) fn off(&self) -> Option<usize> {
        self.nodes.iter().position(|node| node.line == ErrorState::Off)
    }

    /// True if the robot can walk without the node of a joint.
    pub(crate) fn spares(&self, joint: usize) -> bool {
        self.nodes[self.node_of[joint]].spare
    }

    /// True if a joint was read in this cycle.
    pub(crate) fn reads(&self, joint: usize) -> bool {
        self.nodes[self.node_of[joint]].missed == 0
    }

    /// Hashes what decides what comes next; what was believed in this cycle is no part of it.
    pub(crate) fn hash_state(&self, h: &mut impl Hasher) {
        for node in &self.nodes {
            let missed = node.missed.min(self.missed.max(self.carried_on) + 1);
            (missed, node.known, node.line as u8).hash(h);
        }
        (self.doubted, self.referenced).hash(h);
    }

    pub(crate) fn counters(&self) -> BusCounters {
        self.counters
    }

    /// Events that were not taken yet.
    pub(crate) fn events(&mut self) -> &mut EventQueue {
        &mut self.events
    }

    /// Notes that all frames of a node came in this cycle, or not.
    fn note(&mut self, i: usize, complete: bool, powered: bool) {
        let node = &mut self.nodes[i];
        let (was, known) = (node.missed, node.known);
        node.known |= complete;
        node.missed = if complete { 0 } else { was.saturating_add(1) };
        let missed = node.missed;
        if complete && node.line == ErrorState::Off && !powered {
            node.line = ErrorState::Active; // it sends while the supply is off: its controller was started again
            self.events.push(EventCode::BusActive, Detail::Number(i as u64));
        }
        if !known {
            return;
        }
        // Gaps at a falling rate, so that a bad line does not fill the log; what the joints notice, each time.
        if missed == 1 {
            self.gaps += 1;
            if self.gaps.is_power_of_two() {
                self.events.push(EventCode::FramesLost, Detail::Node(i));
            }
        }
        if missed == self.carried_on + 1 {
            self.events.push(EventCode::NodeHeld, Detail::NodeCycles(i, missed));
        } else if complete && was > self.carried_on {
            self.events.push(EventCode::NodeBack, Detail::NodeCycles(i, was));
        }
    }

    fn count(&mut self, received: &Received) {
        self.counters.lost += u64::from(received.missed());
        self.counters.late += u64::from(received.stale);
        self.counters.duplicated += u64::from(received.repeated);
        self.refuse(RefusedFrame::Late, received.stale);
        self.refuse(RefusedFrame::Twice, received.repeated);
        self.refuse(RefusedFrame::Length, received.wrong_length);
        self.refuse(RefusedFrame::Unknown, received.unknown);
    }

    /// Counts frames or readings that are not used; reported at the first, second, fourth, eighth ... time.
    fn refuse(&mut self, why: RefusedFrame, frames: u32) {
        if frames == 0 {
            return;
        }
        if !matches!(why, RefusedFrame::Late | RefusedFrame::Twice) {
            self.counters.refused += u64::from(frames);
        }
        let times = &mut self.refused[why as usize];
        *times += 1;
        if times.is_power_of_two() {
            self.events.push(EventCode::FrameRefused, Detail::Frame(why));
        }
    }

    /// Error frames of lowlevel's own bus controllers.
    fn read_errors(&mut self, frames: &BusFrames) {
        for frame in frames.as_slice() {
            let Some(error) = ErrorFrame::read(frame) else { continue };
            self.counters.error_frames += 1;
            let restarted = error.restarted.then_some(ErrorState::Active);
            let Some(state) = error.state.or(restarted) else { continue };
            let Some(node) = self.nodes.get_mut(frame.line as usize) else { continue };
            if std::mem::replace(&mut node.line, state) == state {
                continue;
            }
            self.counters.bus_off += u64::from(state == ErrorState::Off);
            let code = match state {
                ErrorState::Active => EventCode::BusActive,
                ErrorState::Warning => EventCode::BusWarning,
                ErrorState::Passive => EventCode::BusPassive,
                ErrorState::Off => EventCode::BusOff,
            };
            self.events.push(code, Detail::Number(frame.line.into()));
        }
    }

    /// Vote of the nodes on the supply: one flipped bit neither stops the robot nor wakes it, even if there are but two of them;
    /// then it stays as it was believed.
    fn most_say_powered(&self, frames: &BusFrames) -> bool {
        let mut votes = 0;
        for frame in frames.as_slice() {
            let Some(message) = self.layout.find(frame.line, frame.id).map(|i| &self.layout.messages[i])
            else {
                continue;
            };
            let supply = message.signals.iter().find(|s| s.carries == Carries::Supply);
            if let Some(signal) = supply.filter(|_| !message.to_drives && frame.len == message.len) {
                votes += if signal.get(&frame.data) == 1 { 1 } else { -1 };
            }
        }
        votes > 0 || votes == 0 && self.believed.power == 1
    }
}
