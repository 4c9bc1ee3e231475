//! The joint loop over a field bus that is only in this test: no shared memory, no interface, no process.

use std::cell::Cell;
use std::error::Error;

use codec::frames::{DriveCommand, decode_targets, encode_sensors};
use codec::layout::FrameLayout;
use config::{Robot, System};
use drives::cia402::{self, REFERENCED, status_of};
use lowlevel::joint_loop::LoopState;
use lowlevel::{Fieldbus, JointLoop, RunControl};
use messages::{BusFrames, EventCode, JointMode, JointTargets, Sensors};

const DT: f64 = 1e-3;

/// Drives at the far end, which are at once where they are commanded to be.
struct Loopback {
    layout: FrameLayout,
    joints: usize,
    command: DriveCommand,
    drives: Sensors,
    answer: BusFrames,
    /// An answer that was not taken yet.
    new: bool,
    /// Answers no more from this tick on.
    silent_from: u64,
}

impl Fieldbus for Loopback {
    fn send(&mut self, frames: &BusFrames) {
        decode_targets(&self.layout, frames, &mut self.command);
        for j in 0..self.joints {
            self.drives.joint_angle[j] = self.command.targets.angle[j];
            self.drives.joint_speed[j] = self.command.targets.speed[j];
        }
    }

    fn receive(&mut self) -> Option<&BusFrames> {
        std::mem::take(&mut self.new).then_some(&self.answer)
    }

    fn wait(&mut self, run: &dyn RunControl, tick: u64) -> Result<bool, Box<dyn Error>> {
        self.drives.header.tick = tick;
        encode_sensors(&self.layout, &self.drives, &mut self.answer);
        self.new = run.wait_for("drives", &mut || tick < self.silent_from)?;
        Ok(self.new)
    }
}

/// A run in which a peer that is not ready at once fell silent.
#[derive(Default)]
struct Impatient {
    ending: Cell<bool>,
}

impl RunControl for Impatient {
    fn is_ending(&self) -> bool {
        self.ending.get()
    }

    fn wait_for(&self, peer: &str, ready: &mut dyn FnMut() -> bool) -> Result<bool, Box<dyn Error>> {
        if self.is_ending() {
            return Ok(false);
        }
        if ready() { Ok(true) } else { Err(format!("{peer} did not answer").into()) }
    }
}

/// One cycle as the process has it in lockstep; false when it was asked to end.
fn cycle(
    bus: &mut dyn Fieldbus,
    run: &dyn RunControl,
    joints: &mut JointLoop,
    tick: u64,
    targets: &mut JointTargets,
) -> Result<bool, Box<dyn Error>> {
    joints.receive(tick, tick * 1_000_000, bus.receive());
    targets.header.tick = tick;
    let (frames, _) = joints.send(Some(targets), None);
    bus.send(frames);
    bus.wait(run, tick)
}

#[test]
fn the_joint_loop_leads_drives_over_a_bus_without_shared_memory() {
    let root = config::root(None);
    let robot = Robot::load(&root.join("robots/lola")).unwrap();
    let system = System::load(&root.join("system.toml")).unwrap();
    let mut drives = Sensors { power: 1, ..Sensors::default() };
    drives.drive_status.fill(u32::from(status_of(cia402::DriveState::OperationEnabled) | REFERENCED));
    let stand = &robot.poses["stand"];
    drives.joint_angle[..stand.len()].copy_from_slice(stand);
    let mut bus = Loopback {
        layout: robot.layout.clone(),
        joints: robot.joints.len(),
        command: DriveCommand::default(),
        drives,
        answer: BusFrames::default(),
        new: false,
        silent_from: 200,
    };
    let (run, mut joints) = (Impatient::default(), JointLoop::new(&robot, &system, DT));
    assert!(bus.start(&run).unwrap() && bus.wait(&run, 0).unwrap());

    // A knee bends by 0.02 rad within 0.1 s, and all others stay.
    const KNEE: usize = 5;
    let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
    targets.angle[..stand.len()].copy_from_slice(stand);
    for tick in 1..200 {
        let moves = (50..150).contains(&tick);
        targets.speed[KNEE] = if moves { 0.2 } else { 0.0 };
        targets.angle[KNEE] += if moves { 0.2 * DT } else { 0.0 };
        assert!(cycle(&mut bus, &run, &mut joints, tick, &mut targets).unwrap());
    }
    assert_eq!(joints.state(), LoopState::Track);
    for (j, q) in stand.iter().enumerate() {
        let there = q + if j == KNEE { 0.02 } else { 0.0 };
        assert!((bus.drives.joint_angle[j] - there).abs() < 1e-6, "joint {j}");
    }

    // Then the drives fall silent: an error in lockstep, and a controlled stop of a joint loop that goes on.
    let error = cycle(&mut bus, &run, &mut joints, 200, &mut targets).unwrap_err();
    assert_eq!(error.to_string(), "drives did not answer");
    for tick in 201..300 {
        _ = cycle(&mut bus, &run, &mut joints, tick, &mut targets);
    }
    assert_eq!(joints.state(), LoopState::Stop(EventCode::BusSilent));
    run.ending.set(true);
    assert!(!cycle(&mut bus, &run, &mut joints, 300, &mut targets).unwrap());
}
