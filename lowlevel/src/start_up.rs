//! The way from a robot without power to one that may walk. Pure: sensor data of a cycle and commands in, demands on
//! the drives out.
//!
//! ```text
//!  Off ──supply on──► NotHomed ──joint/home──► Homing ──► Enabling ──► Hanging ──joint/zero_force──► Zeroed
//!   ▲                     (only if a joint does not know its angle) │                                │ the feet
//!   │                   the feet carried already, or feel nothing   ▼                                ▼ carry
//!   └────────── supply off, from everywhere ◄────────────────────── Standing ◄───────────────────────┘
//! ```
//!
//! From everywhere to Stopped, while a controlled stop is latched.
//!
//! Nothing is followed before every drive is in Operation enabled. No drive is switched on while a joint does not know its
//! angle, but to find it out.

use std::hash::{Hash, Hasher};

use drives::cia402::{DriveState, REFERENCED, Wanted, state_of};
use messages::{Command, Detail, EventCode, EventQueue, Reason, Sensors, StartUp, Verdict, Wrench};

/// Share of the weight on a foot up to which it counts as unloaded: nothing but what hangs on its sensor, and its offset.
const UNLOADED: f64 = 0.15;
/// Share of the weight on both feet, at any time since the supply is on, from which a robot that was not hung up stands.
const STOOD: f64 = 0.5;
/// Share of the weight on both feet, for [`StartUpTiming::landed`], from which a robot that was lowered stands.
const LANDED: f64 = 0.9;
/// Cycles for switching all drives on; after these it is reported.
const ENABLE_CYCLES: u32 = 100;

/// Lengths of what is counted \[1\].
#[derive(Clone, Copy, Debug)]
pub struct StartUpTiming {
    /// Cycles in which the feet carry before the robot stands.
    pub landed: u32,
    /// Readings of which the zero of a force sensor is the mean.
    pub zero: u32,
    /// Cycles for which a reset is passed on to drives with a fault.
    pub reset: u32,
}

impl Default for StartUpTiming {
    fn default() -> Self {
        Self { landed: 100, zero: 100, reset: 100 }
    }
}

/// Force sensors that are set to zero.
#[derive(Clone, Debug, Default)]
struct ForceZero {
    /// Offsets that are taken away; right, left.
    offset: [Wrench; 2],
    sum: [[f64; 6]; 2],
    /// Readings still to come; 0: none is asked for.
    left: u32,
}

/// The start-up of one robot.
#[derive(Clone, Debug)]
pub(crate) struct StartUpSequence {
    state: StartUp,
    timing: StartUpTiming,
    joints: usize,
    /// Forces of the feet are measured; a robot without stands as soon as its drives hold it.
    feels: bool,
    /// \[N\]
    weight: f64,
    /// \[N\] Most that both feet carried since the supply is on.
    most_load: f64,
    zero: ForceZero,
    /// Raw readings of the force sensors; right, left.
    raw: [Wrench; 2],
    /// Cycles in this state, and cycles in which the feet carried.
    cycles: u32,
    landed: u32,
    reset: u32,
    events: EventQueue,
}

impl StartUpSequence {
    /// The start-up of a robot of this weight \[N\] that feels the ground, or not.
    pub(crate) fn new(joints: usize, weight: f64, feels: bool) -> Self {
        Self {
            state: StartUp::Off,
            timing: StartUpTiming::default(),
            joints,
            feels,
            weight,
            most_load: 0.0,
            zero: ForceZero::default(),
            raw: Default::default(),
            cycles: 0,
            landed: 0,
            reset: 0,
            events: EventQueue::default(),
        }
    }

    pub(crate) fn set_timing(&mut self, timing: StartUpTiming) {
        self.timing = timing;
    }

    /// Hashes what decides what comes next.
    pub(crate) fn hash_state(&self, h: &mut impl Hasher) {
        let landed = self.landed.min(self.timing.landed);
        (self.state as u64, self.most_load.to_bits(), landed, self.reset, self.zero.left).hash(h);
        for wrench in self.zero.offset.iter().chain(&self.raw) {
            wrench.force.iter().chain(&wrench.moment).for_each(|x| x.to_bits().hash(h));
        }
        if self.zero.left > 0 {
            self.zero.sum.as_flattened().iter().for_each(|x| x.to_bits().hash(h));
        }
    }

    /// The state.
    pub(crate) fn state(&self) -> StartUp {
        self.state
    }

    /// Events that were not taken yet.
    pub(crate) fn events(&mut self) -> &mut EventQueue {
        &mut self.events
    }

    /// Before new sensor data are decoded: what is missing among them stays as it was read.
    pub(crate) fn restore(&self, sensors: &mut Sensors) {
        sensors.foot_wrench = self.raw;
    }

    /// Takes the offsets of the force sensors away from what they read, and says where the start-up is.
    pub(crate) fn receive(&mut self, sensors: &mut Sensors) {
        let begins = self.state == StartUp::Off && sensors.power == 1;
        sensors.start_up = if begins { StartUp::Enabling } else { self.state } as u64;
        self.raw = sensors.foot_wrench;
        self.average(sensors);
        for (wrench, offset) in sensors.foot_wrench.iter_mut().zip(&self.zero.offset) {
            for k in 0..3 {
                wrench.force[k] -= offset.force[k];
                wrench.moment[k] -= offset.moment[k];
            }
        }
    }

    /// Takes `system/reset`, `joint/home` and `joint/zero_force`; `sensors` as [`Self::receive`] left them.
    ///
    /// # Errors
    /// Why it is refused.
    pub(crate) fn command(&mut self, command: &Command, sensors: &Sensors) -> Verdict {
        match command {
            Command::Reset => self.reset = self.timing.reset,
            Command::Home if self.state == StartUp::NotHomed => self.enter(StartUp::Homing),
            Command::Home if self.state == StartUp::Homing => {}
            Command::Home => {
                self.events.push(EventCode::CommandRefused, Detail::Message(command.address().1.into()));
                return Err(Reason::NotNow);
            }
            Command::ZeroForce => return self.begin_zero(sensors),
            _ => {}
        }
        Ok(())
    }

    /// One cycle: `stopped` while a controlled stop is latched; a robot that stands goes on without the joints that it
    /// `spares`.
    pub(crate) fn step(&mut self, sensors: &Sensors, stopped: bool, spares: impl Fn(usize) -> bool) {
        self.cycles = self.cycles.saturating_add(1);
        self.reset = self.reset.saturating_sub(1);
        // Drives: the first that does not know its angle, and the first that does not follow.
        let unknown = (0..self.joints).find(|&j| !knows_angle(sensors, j));
        let stands = self.state == StartUp::Standing;
        let off = (0..self.joints).find(|&j| !(is_enabled(sensors, j) || stands && spares(j)));
        let load: f64 = sensors.foot_wrench.iter().map(|w| w.force[2]).sum();
        // A robot that settles while its supply comes on may leave its soles for a moment.
        self.most_load = if sensors.power == 1 { self.most_load.max(load) } else { 0.0 };
        let carried = load > LANDED * self.weight;
        self.landed = if carried { self.landed.saturating_add(1) } else { 0 };
        // The drawing above, from the strongest reason to the weakest.
        let next = match self.state {
            _ if sensors.power != 1 => StartUp::Off,
            _ if stopped => StartUp::Stopped,
            StartUp::Stopped => StartUp::Enabling,
            StartUp::Homing if unknown.is_some() => StartUp::Homing,
            StartUp::Standing if off.is_none() => StartUp::Standing,
            _ if unknown.is_some() => StartUp::NotHomed,
            _ if off.is_some() => StartUp::Enabling,
            _ if !self.feels => StartUp::Standing,
            StartUp::Hanging => StartUp::Hanging,
            StartUp::Zeroed if self.landed >= self.timing.landed => StartUp::Standing,
            StartUp::Zeroed => StartUp::Zeroed,
            _ if self.most_load > STOOD * self.weight => StartUp::Standing,
            _ => StartUp::Hanging,
        };
        match (self.state, next) {
            (StartUp::NotHomed, StartUp::NotHomed) => {}
            (_, StartUp::NotHomed) => {
                self.events.push(EventCode::NotHomed, Detail::Joint(unknown.unwrap_or(0)));
            }
            (StartUp::Homing, StartUp::Enabling) => {
                self.events.push(EventCode::Homed, Detail::Cycles(self.cycles.into()));
            }
            (StartUp::Enabling, StartUp::Enabling) if self.cycles == ENABLE_CYCLES => {
                self.events.push(EventCode::DriveNotEnabled, Detail::Joint(off.unwrap_or(0)));
            }
            _ => {}
        }
        self.enter(next);
    }

    /// True if targets may be followed.
    pub(crate) fn ready(&self) -> bool {
        matches!(self.state, StartUp::Hanging | StartUp::Zeroed | StartUp::Standing)
    }

    /// True if drives are still being switched on, or find their angles.
    pub(crate) fn begins(&self) -> bool {
        matches!(self.state, StartUp::Off | StartUp::NotHomed | StartUp::Homing | StartUp::Enabling)
    }

    /// Demand on the drive of joint `j`.
    ///
    /// A robot that is stopped, or stands without a joint that it spares, may have joints that do not know their angles. Those
    /// are held by their own drives, which may have found out meanwhile and would take a target for another angle than is
    /// meant. No further drive is switched on.
    pub(crate) fn wanted(&self, j: usize, sensors: &Sensors) -> Wanted {
        let unknown = |j: usize| !knows_angle(sensors, j);
        match self.state {
            StartUp::Off if self.reset > 0 => Wanted::Reset,
            StartUp::Off | StartUp::NotHomed => Wanted::Ready,
            StartUp::Homing if !unknown(j) => Wanted::Ready,
            StartUp::Homing => Wanted::Operation,
            _ if !has_torque(sensors, j) && (0..self.joints).any(unknown) => Wanted::Ready,
            _ if unknown(j) => Wanted::Stop,
            _ => Wanted::Operation,
        }
    }

    fn enter(&mut self, state: StartUp) {
        if state != self.state {
            (self.state, self.cycles) = (state, 0);
            self.zero.left = 0;
        }
    }

    fn begin_zero(&mut self, sensors: &Sensors) -> Verdict {
        let (load, most) = (heaviest(sensors), UNLOADED * self.weight);
        let verdict = match self.state {
            StartUp::Hanging | StartUp::Zeroed if load < most => Ok(()),
            StartUp::Hanging | StartUp::Zeroed | StartUp::Standing => Err(Reason::Loaded { load, most }),
            _ => Err(Reason::NotNow),
        };
        if verdict.is_ok() {
            self.zero.sum = [[0.0; 6]; 2];
            self.zero.left = self.timing.zero;
        } else {
            self.events.push(EventCode::ZeroRefused, Detail::Newtons(load as u64));
        }
        verdict
    }

    /// Adds a reading, without any offset, to the mean; a load meanwhile ends it.
    fn average(&mut self, sensors: &Sensors) {
        if self.zero.left == 0 {
            return;
        }
        let load = heaviest(sensors);
        if !(load < UNLOADED * self.weight) {
            self.zero.left = 0;
            return self.events.push(EventCode::ZeroRefused, Detail::Newtons(load as u64));
        }
        for (sum, w) in self.zero.sum.iter_mut().zip(&sensors.foot_wrench) {
            for (sum, x) in sum.iter_mut().zip(w.force.iter().chain(&w.moment)) {
                *sum += x;
            }
        }
        self.zero.left -= 1;
        if self.zero.left == 0 {
            let mean = self.zero.sum.map(|sum| sum.map(|x| x / f64::from(self.timing.zero)));
            self.zero.offset = mean.map(|[a, b, c, d, e, f]| Wrench { force: [a, b, c], moment: [d, e, f] });
            let most = mean.iter().flat_map(|m| &m[..3]).fold(0.0f64, |most, x| most.max(x.abs()));
            self.events.push(EventCode::ForceZeroed, Detail::Newtons(most.round() as u64));
            self.enter(StartUp::Zeroed);
        }
    }
}

/// True if the drive of joint `j` follows its targets.
pub(crate) fn is_enabled(sensors: &Sensors, j: usize) -> bool {
    state_of(sensors.drive_status[j] as u16) == Some(DriveState::OperationEnabled)
}

/// True if joint `j` knows its angle.
pub(crate) fn knows_angle(sensors: &Sensors, j: usize) -> bool {
    sensors.drive_status[j] & u32::from(REFERENCED) != 0
}

/// True if the drive of joint `j` holds it.
fn has_torque(sensors: &Sensors, j: usize) -> bool {
    matches!(
        state_of(sensors.drive_status[j] as u16),
        Some(DriveState::OperationEnabled | DriveState::QuickStop)
    )
}

/// \[N\] Larger normal force of both feet, without its sign.
fn heaviest(sensors: &Sensors) -> f64 {
    sensors.foot_wrench.iter().map(|w| w.force[2].abs()).fold(0.0, f64::max)
}
