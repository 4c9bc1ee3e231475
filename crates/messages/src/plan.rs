//! `plan`: where every task-space coordinate goes, from now until the robot stands again.
//!
//! A plan, not a sample: the controller samples it each cycle. If the planner falls silent, the controller goes on
//! with the plan it has, and every plan ends in a state that can be held.

use crate::{Header, record};
use curves::{Path, Polyline};

/// State of the walk (the outer states of thesis figure 4.5).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum GaitState {
    /// No plan yet: joints hold.
    Idle = 0,
    /// Both feet on the ground, at rest or coming to rest.
    Standing = 1,
    /// First step out of standing.
    Starting = 2,
    /// Periodic walking.
    Walking = 3,
    /// Last steps before standing.
    Stopping = 4,
    /// The robot has fallen: nothing is planned or walked until it is upright and the supply was off.
    Fallen = 5,
    /// A controlled stop: the joints are held, and nothing is planned or walked until the supply was off.
    Halted = 6,
}

impl GaitState {
    /// Whether the robot neither walks nor comes to a stand.
    pub const fn rests(self) -> bool {
        matches!(self, Self::Idle | Self::Standing | Self::Fallen | Self::Halted)
    }
}

impl From<u64> for GaitState {
    fn from(n: u64) -> Self {
        match n {
            1 => Self::Standing,
            2 => Self::Starting,
            3 => Self::Walking,
            4 => Self::Stopping,
            5 => Self::Fallen,
            6 => Self::Halted,
            _ => Self::Idle,
        }
    }
}

/// Point of the body that a plan leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum BodyPoint {
    /// Centre of gravity: balanced gaits.
    CentreOfGravity = 0,
    /// Origin of the torso's frame: patterns, which know of no masses.
    Torso = 1,
}

/// Gait phase of a foot (the inner states, thesis figure 4.4): five phases of stance, three of swing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Phase {
    /// Carries, and no step is being made.
    Standing = 0,
    /// IC: has just touched the ground.
    InitialContact = 1,
    /// LR: takes over the load.
    LoadingResponse = 2,
    /// MS: carries alone, the other foot comes up from behind.
    MidStance = 3,
    /// TS: carries alone, the other foot passes to the front.
    TerminalStance = 4,
    /// PSW: hands the load over.
    PreSwing = 5,
    /// ISW: lifts off.
    InitialSwing = 6,
    /// MSW: passes the other foot.
    MidSwing = 7,
    /// TSW: comes down.
    TerminalSwing = 8,
}

impl Phase {
    /// Shares of a double support, of a single support and of a swing at which one phase gives way to the next:
    /// a human's, with 2, 12, 31 and 50 % of the gait cycle for the phases of stance.
    const SHARES: (f64, f64, f64) = (1.0 / 6.0, 0.5, 1.0 / 3.0);

    /// Of a foot that is in the air.
    pub fn swings(self) -> bool {
        matches!(self, Self::InitialSwing | Self::MidSwing | Self::TerminalSwing)
    }
}

record! {
    /// One step: a double support from the former to the new stance foot, then a single support (thesis 4.3).
    part Step {
        /// \[1\] Foot that carries the single support: 0 right, 1 left (i_s).
        stance: u64,
        /// \[s\] Start of the double support, from the start of the plan.
        begin: f64,
        /// \[s\] End of the double support, start of the swing.
        lift: f64,
        /// \[s\] End of the swing, start of the next step.
        end: f64,
        /// \[m, m, rad\] @planning frame Pose (x, y, heading) of the stance sole.
        foothold: [f64; 3],
        /// \[m, m, rad\] @planning frame Where the swing foot lands.
        landing: [f64; 3],
    }
}

record! {
    /// Trajectories of the whole task space (thesis table 4.2) in the planning frame of the plan. Written by planner.
    ///
    /// Times count from the start of cycle `start_tick`. All curves are C2 and end at rest. Arrays of feet: right, left.
    record Plan {
        /// Tick in which the plan was made; it is made ahead of `start_tick`.
        header: Header,
        /// \[1\] Number of this plan, ascending; 0 is no plan.
        id: u64,
        /// \[1\] The cycle in which the controller switches to this plan.
        start_tick: u64,
        /// \[1\] A [`GaitState`]: what the first step of the plan does.
        state: u64,
        /// \[m, m, rad\] @I_0 Planning frame I of this plan in the frame of the first one (odometry).
        origin: [f64; 3],
        /// \[m\] @I_0 Height of that frame: the ground under the stance foot.
        height: f64,
        /// \[1\] Number of entries of `steps` in use; 0 while standing.
        step_count: u64,
        /// The steps of the plan, the running one first.
        steps: [Step; 8],
        /// \[1\] 1 if the plan begins at the measured pose of the robot, inside a step or leaning: body, torso and feet do not go on
        /// from where the plan before wanted them.
        measured: u64,
        /// \[1\] A [`BodyPoint`]: what `body` leads.
        leads: u64,
        /// \[m\] That point of the body (x, y, z).
        body: Path<3, 96>,
        /// \[rad\] Upper body: inclinations phi_x, phi_y (pi/2 is upright) and heading alpha (4.11)-(4.13).
        torso: Path<3, 16>,
        /// \[m, rad\] Footprint of each foot, the sole frame of a flat foot: x, y, z and heading.
        feet: [Path<4, 32>; 2],
        /// \[m\] Height over the sole of the point about which a swinging foot pitches; 0: it pitches about its edges.
        pitch_height: f64,
        /// \[rad\] Pitch of each sole. On the ground about an edge of its footprint: positive is toe down, about the front
        /// edge, negative is toe up, about the rear edge; about these it passes zero at rest. In the swing about the
        /// point at `pitch_height`, where that is not 0: the footprint then lies that far under the point.
        pitch: [Path<1, 24>; 2],
        /// \[rad\] Toe joints.
        toes: [Path<1, 16>; 2],
        /// \[m\] Zero-moment point (x, y) after modification (4.49).
        zmp: Polyline<2, 64>,
        /// \[m\] Height of that point: on the stance sole, in double support between both soles.
        zmp_height: Polyline<1, 24>,
        /// \[1\] Load factor rho of the left foot (4.62); the right one carries the rest.
        load_left: Path<1, 40>,
    }
}

impl Plan {
    /// Gait phase of `foot` at plan time `t` \[s\], by the clock.
    pub fn phase(&self, foot: usize, t: f64) -> Phase {
        let steps = &self.steps[..(self.step_count as usize).min(self.steps.len())];
        let Some(s) = steps.iter().find(|s| t < s.end) else { return Phase::Standing };
        let (contact, middle, third) = Phase::SHARES;
        let share = |from: f64, to: f64| (t - from) / (to - from);
        let (doubled, single) = (share(s.begin, s.lift), share(s.lift, s.end));
        match (foot as u64 == s.stance, t < s.lift) {
            (true, true) if doubled < contact && self.begins_with_contact(s) => Phase::InitialContact,
            (true, true) => Phase::LoadingResponse,
            (true, false) if single < middle => Phase::MidStance,
            (true, false) => Phase::TerminalStance,
            (false, true) => Phase::PreSwing,
            (false, false) if single < third => Phase::InitialSwing,
            (false, false) if single < 2.0 * third => Phase::MidSwing,
            (false, false) => Phase::TerminalSwing,
        }
    }

    /// The first step out of standing begins with both feet on the ground.
    fn begins_with_contact(&self, s: &Step) -> bool {
        s.begin > 0.0 || self.state != GaitState::Starting as u64
    }

    /// True if `foot` swings at plan time `t` \[s\], by the clock.
    pub fn swings(&self, foot: usize, t: f64) -> bool {
        let steps = &self.steps[..(self.step_count as usize).min(self.steps.len())];
        steps.iter().any(|s| s.stance != foot as u64 && t >= s.lift && t < s.end)
    }

    /// Length of the plan \[s\]: from here on the robot rests.
    pub fn end(&self) -> f64 {
        let steps = self.steps[..self.step_count as usize].last().map_or(0.0, |s| s.end);
        self.body.end().max(self.torso.end()).max(steps)
    }
}
