//! Gait coordination: standing, starting, walking, stopping (thesis 4.2, figure 4.5), and the planner itself.

use crate::commands::{self, Wish};
use crate::obstacles::Obstacles;
use crate::pose::{Pose, rotate};
use crate::roll::Roll;
use crate::skills::{Skill, Task, Tasks};
use crate::sole::Sole;
use crate::steps::Parameters;
use crate::touchdown::{found, lowered};
use crate::verdict::Verdict;
use crate::walk::{Builder, Origin, Walk};
use config::{Gait, Robot};
use curves::Sample;
use messages::{Command, ControllerState, EventCode, GaitState, LEFT, Plan, RIGHT, Reason};
use std::f64::consts::FRAC_PI_2;

/// Cycles between the publication of a plan and its start.
pub const LEAD: u64 = 10;
/// Fewest cycles before its start at which a plan can still reach the controller.
const LEAD_MIN: u64 = 3;
/// Most events of one cycle.
const MAX_EVENTS: usize = 16;
/// Most commands of one cycle.
pub const MAX_COMMANDS: usize = 16;

/// What one cycle of the planner puts out.
pub struct Output<'a> {
    /// A new plan, in the cycle in which it was made.
    pub plan: Option<&'a Plan>,
    /// What happened: code and detail.
    pub events: &'a [(EventCode, u64)],
    /// What became of the commands, in their order.
    pub answers: &'a [Result<(), Reason>],
}

/// What to plan next.
enum Move {
    Nothing,
    Stand,
    Start,
    Step(GaitState),
}

/// The planner: walking commands to plans.
#[derive(Clone)]
pub struct Planner {
    gait: Gait,
    pub(crate) builder: Builder,
    wish: Wish,
    parameters: Parameters,
    tasks: Tasks,
    /// The plan being executed, as the controller says.
    pub(crate) active: Walk,
    /// The plan that was published and has not been confirmed yet; its id is 0 if there is none.
    pub(crate) next: Walk,
    last_id: u64,
    /// Start of the step for which no plan could be walked.
    given_up: u64,
    /// Plan and step whose early contact was looked at.
    pub(crate) tried: (u64, usize),
    events: Vec<(EventCode, u64)>,
    answers: Vec<Result<(), Reason>>,
}

impl Planner {
    /// A planner for feet with these support rectangles (`config::robot::Foot::support`): right, left.
    pub fn new(gait: &Gait, support: [[f64; 4]; 2]) -> Self {
        let duration = gait.step.by_speed.first().map_or(1.0, |row| row[2]);
        Self {
            gait: gait.clone(),
            builder: Builder::new(gait, support.map(Sole::new)),
            wish: Wish::Rest,
            parameters: Parameters::on_the_spot(duration),
            tasks: Tasks::default(),
            active: Walk::new(),
            next: Walk::new(),
            last_id: 0,
            given_up: 0,
            tried: (0, 0),
            events: Vec::with_capacity(MAX_EVENTS),
            answers: Vec::with_capacity(MAX_COMMANDS),
        }
    }

    /// A planner for this robot.
    pub fn of(gait: &Gait, robot: &Robot) -> Self {
        let toe = |i: usize| robot.feet[i].toe.map(|joint| robot.joints[joint].range);
        Self::new(gait, [0, 1].map(|i| robot.feet[i].support)).with_toes([0, 1].map(toe))
    }

    /// The same with toe joints of these ranges \[rad\]: right, left.
    pub fn with_toes(mut self, ranges: [Option<[f64; 2]>; 2]) -> Self {
        self.builder.roll = Roll::new(&self.gait, ranges);
        self
    }

    /// Obstacles that are known from now on \[m\] @I_0; a gait without steps over obstacles knows of none.
    pub fn see(&mut self, known: Obstacles) {
        if let Some(reactive) = &mut self.builder.reactive {
            reactive.known = known;
        }
    }

    /// One cycle: takes commands, follows what the controller does, and makes a plan when one is due.
    pub fn step(
        &mut self,
        tick: u64,
        cycle_s: f64,
        state: Option<&ControllerState>,
        commands: &[Command],
    ) -> Output<'_> {
        self.events.clear();
        self.answers.clear();
        self.builder.set_cycle(cycle_s);
        if let Some(state) = state {
            if state.not_standing == 1 || state.plan_id == 0 && self.active.plan.id > 0 {
                self.forget();
            }
            self.confirm(state);
        }
        let gait = self.gait_state(tick, state);
        let down = state.filter(|s| s.not_standing == 1).and_then(|_| not_standing(gait));
        for command in commands.iter().take(MAX_COMMANDS) {
            let answer = match down.filter(|_| walks(command)) {
                Some(reason) => {
                    self.event(EventCode::NotStanding, u64::from(command.address().1));
                    Err(reason)
                }
                None => self.take(command, gait),
            };
            self.answers.push(answer);
        }
        let made = match (state, self.due(tick, gait)) {
            (Some(state), due) => self.make(tick, gait, state, due),
            (None, _) => false,
        };
        Output { plan: made.then_some(&*self.next.plan), events: &self.events, answers: &self.answers }
    }

    /// Without power, or a controller that knows of no plan: whatever was planned, wished and begun is over. What comes
    /// next begins from the measured joints, and with a command.
    fn forget(&mut self) {
        self.wish = Wish::Rest;
        self.parameters = Parameters::on_the_spot(self.parameters.duration);
        self.tasks = Tasks::default();
        (self.active.plan.id, self.next.plan.id) = (0, 0);
    }

    /// A plan counts as active when the controller says so; one it did not take at its start is forgotten.
    fn confirm(&mut self, state: &ControllerState) {
        self.last_id = self.last_id.max(state.plan_id);
        let next = &mut self.next.plan;
        if next.id == 0 {
            return;
        }
        if state.plan_id == next.id {
            std::mem::swap(&mut self.active, &mut self.next);
            self.next.plan.id = 0;
            if self.active.plan.state == GaitState::Standing as u64 && self.wish == Wish::Stand {
                self.wish = Wish::Rest;
            }
        } else if state.header.tick >= next.start_tick {
            self.event(EventCode::PlanRefused, self.next.plan.id);
            self.next.plan.id = 0;
        }
    }

    /// Where in a walk the robot is (figure 4.5).
    fn gait_state(&self, tick: u64, state: Option<&ControllerState>) -> GaitState {
        let plan = &self.active.plan;
        let known = state.is_none_or(|s| s.plan_id == plan.id);
        if plan.id == 0 || !known {
            // A plan of a planner before this one: its end is seen by the controller only.
            return state.map_or(GaitState::Idle, |s| match GaitState::from(s.gait) {
                GaitState::Starting | GaitState::Walking | GaitState::Stopping => GaitState::Walking,
                GaitState::Idle | GaitState::Standing => GaitState::Idle,
                down @ (GaitState::Fallen | GaitState::Halted) => down,
            });
        }
        if tick >= plan.start_tick + self.active.end_cycle {
            return GaitState::Standing;
        }
        GaitState::from(plan.state)
    }

    /// The transition table.
    fn due(&self, tick: u64, gait: GaitState) -> Move {
        use GaitState::{Idle, Standing, Starting, Stopping, Walking};
        let at_rest = tick + LEAD >= self.active.plan.start_tick + self.active.end_cycle;
        match (gait, self.wish) {
            _ if self.next.plan.id != 0 => Move::Nothing,
            (Idle, Wish::Stand) => Move::Stand,
            (Standing, Wish::Stand) if at_rest => Move::Stand,
            (Standing, Wish::Walk) if at_rest => Move::Start,
            (Standing, Wish::Rest) if at_rest && self.tasks.next.is_some() => Move::Start,
            (Starting | Walking | Stopping, Wish::Walk) => Move::Step(Walking),
            (Starting | Walking, Wish::Rest | Wish::Stand) => Move::Step(Stopping),
            _ => Move::Nothing,
        }
    }

    /// Takes a command, or refuses it with an event that names it.
    fn take(&mut self, command: &Command, gait: GaitState) -> Result<(), Reason> {
        let taken = match command {
            Command::Stand if matches!(gait, GaitState::Idle | GaitState::Standing) => {
                Ok((Wish::Stand, None))
            }
            Command::Start if gait != GaitState::Idle || self.wish == Wish::Stand => Ok((Wish::Walk, None)),
            Command::Stop | Command::End => {
                self.tasks.stop();
                Ok((if self.wish == Wish::Stand { Wish::Stand } else { Wish::Rest }, None))
            }
            Command::Step(step) => commands::from_step(step, &self.gait).map(|p| (self.wish, Some(p))),
            Command::Velocity(v) => commands::from_velocity(v, &self.gait).and_then(|p| match p {
                None => Ok((Wish::Rest, None)),
                Some(_) if gait == GaitState::Idle => Err(Reason::NotNow),
                Some(p) => Ok((Wish::Walk, Some(p))),
            }),
            Command::Stand | Command::Start => Err(Reason::NotNow),
            Command::Distance(c) => self.give(Task::Distance(*c), gait),
            Command::Platform(c) => self.give(Task::Platform(*c), gait),
            Command::WalkParameter(change) => self.set(change).map(|()| (self.wish, None)),
            Command::EmergencyStop
            | Command::Reset
            | Command::Enable
            | Command::Push(_)
            | Command::Parameter(_)
            | Command::Fixate(_)
            | Command::HeadJoints(_)
            | Command::HeadRest
            | Command::Home
            | Command::ZeroForce
            | Command::Lower(_) => return Ok(()),
        };
        let taken = match taken {
            // Half on a platform nobody walks as he likes.
            Ok((Wish::Walk, Some(_))) if !self.tasks.walk(gait == GaitState::Standing) => Err(Reason::NotNow),
            taken => taken,
        };
        match taken {
            Ok((wish, parameters)) => {
                self.wish = wish;
                self.parameters = parameters.unwrap_or(self.parameters);
                Ok(())
            }
            Err(reason) => {
                self.event(EventCode::CommandRefused, u64::from(command.address().1));
                Err(reason)
            }
        }
    }

    /// A skill comes next: at once from standing, otherwise after a stop.
    fn give(&mut self, task: Task, gait: GaitState) -> Result<(Wish, Option<Parameters>), Reason> {
        if gait == GaitState::Idle && self.wish != Wish::Stand {
            return Err(Reason::NotNow);
        }
        if let Err((code, detail)) = task.check(&self.gait, &self.builder.soles[RIGHT]) {
            self.event(code, detail);
            return Err(Reason::Event { code, detail });
        }
        self.tasks.next = Some(task);
        let still = matches!(gait, GaitState::Idle | GaitState::Standing);
        let busy = self.tasks.active != Skill::Walk && !self.tasks.aborted;
        let wish = if busy { self.wish } else { Wish::Rest };
        Ok((if still { Wish::Walk } else { wish }, None))
    }

    fn make(&mut self, tick: u64, gait: GaitState, state: &ControllerState, due: Move) -> bool {
        match due {
            Move::Nothing => false,
            Move::Stand => {
                let from = if gait == GaitState::Idle { measured(state) } else { Some(self.at_rest(RIGHT)) };
                let Some((from, heights)) = from else { return false };
                self.builder.stand(&from, heights, &mut self.next);
                self.publish(tick + LEAD, tick)
            }
            Move::Start => {
                // The foot on the side to which the robot goes or turns swings first.
                let p = self.parameters;
                let left_first = if p.side == 0.0 { p.turn >= 0.0 } else { p.side > 0.0 };
                let (from, _) = self.at_rest(if left_first { RIGHT } else { LEFT });
                self.wish = Wish::Walk;
                if !self.tasks.begin(&from, &self.gait, &self.builder.soles[from.stance])
                    || !self.walk(&from, GaitState::Starting)
                {
                    self.wish = Wish::Rest;
                    self.event(EventCode::PlanKept, self.active.plan.id);
                    return false;
                }
                let rest = self.active.plan.start_tick + self.active.end_cycle;
                self.publish((tick + LEAD).max(rest), tick)
            }
            Move::Step(to) => {
                // A skill knows the heights it steps on.
                let blind = self.tasks.active == Skill::Walk;
                let touched = self.touched(tick, state).filter(|_| blind);
                if touched.is_some_and(|(k, foot)| self.end_early(tick, k, foot, state, to)) {
                    self.event(EventCode::EarlyContact, self.last_id + 1);
                    return self.publish(tick + LEAD, tick);
                }
                let Some(k) = self.boundary(tick) else { return false };
                let start = self.active.plan.start_tick + self.active.strides[k].end_cycle;
                if start > tick + LEAD || start == self.given_up {
                    return false;
                }
                let foot = touched.filter(|t| t.0 == k).map(|t| t.1);
                let from = self.at_boundary(k, foot, state);
                if !self.walk(&from, to) {
                    // The active plan goes on: it can be walked, and ends standing.
                    self.given_up = start;
                    if self.tasks.active != Skill::Walk {
                        self.tasks.stop();
                        self.wish = Wish::Rest;
                    }
                    self.event(EventCode::PlanKept, self.active.plan.id);
                    return false;
                }
                self.publish(start, tick)
            }
        }
    }

    /// The next step boundary of the active plan at which another step follows.
    fn boundary(&self, tick: u64) -> Option<usize> {
        let steps = self.active.steps();
        let k = steps.iter().position(|s| self.active.plan.start_tick + s.end_cycle >= tick + LEAD_MIN)?;
        // A stopping plan goes on to its end once nothing but closing is left.
        (k + 1 < steps.len()).then_some(k)
    }

    /// Plans with the full change of parameters or, if that cannot be walked, with less; whether any can, and where
    /// obstacles leave no way, whether a stop can.
    pub(crate) fn walk(&mut self, from: &Origin, state: GaitState) -> bool {
        let mut wish = self.parameters;
        let starting = state == GaitState::Starting;
        let script = self.tasks.before(from, starting, self.builder.step.first_length, &mut wish);
        let told = self.wish == Wish::Walk;
        let ends = state == GaitState::Walking && script.left().is_some_and(|n| n < 2);
        let state = if ends { GaitState::Stopping } else { state };
        if ends {
            self.wish = Wish::Rest;
        }
        (self.builder.skill, self.builder.script) = (self.tasks.active, script);
        for share in [1.0, 0.5, 0.25, 0.0] {
            self.builder.walk(from, state, &wish, share, &mut self.next);
            if self.next.verdict == Verdict::Sound || state == GaitState::Stopping {
                break;
            }
        }
        let Some((code, detail)) = self.next.blocked else { return self.next.verdict == Verdict::Sound };
        if told {
            self.event(code, detail);
            self.tasks.stop();
        }
        self.wish = Wish::Rest;
        state == GaitState::Walking && self.walk(from, GaitState::Stopping)
    }

    fn publish(&mut self, start_tick: u64, tick: u64) -> bool {
        self.last_id += 1;
        let plan = &mut self.next.plan;
        plan.header.tick = tick;
        plan.id = self.last_id;
        plan.start_tick = start_tick;
        true
    }

    /// Standing on the feet of the active plan.
    fn at_rest(&self, stance: usize) -> (Origin, [f64; 2]) {
        let t = self.active.end_cycle as f64 * self.builder.cycle();
        let previous = Parameters::on_the_spot(self.parameters.duration);
        let from = self.origin(t, self.soles(t), stance, previous, None);
        (from, from.heights)
    }

    /// The active plan at the end of its step `k`, on the ground as it was found.
    fn at_boundary(&self, k: usize, touched: Option<usize>, state: &ControllerState) -> Origin {
        let s = &self.active.strides[k];
        let mut soles = self.soles(s.end);
        if let Some(foot) = touched {
            soles[foot][2] = found(state, foot, soles[foot][2]);
        }
        let lower = lowered(state, s.stance);
        for sole in &mut soles {
            sole[2] += lower;
        }
        self.origin(s.end, soles, 1 - s.stance, s.parameters, Some(s.width))
    }

    /// Sole frames of the active plan at `t`: x, y, z, heading.
    pub(crate) fn soles(&self, t: f64) -> [[f64; 4]; 2] {
        [0, 1].map(|i| self.active.plan.feet[i].sample(t).position)
    }

    /// The active plan at `t` with the feet at `soles`, seen from the planning frame below the new stance foot (gap 5).
    pub(crate) fn origin(
        &self,
        t: f64,
        soles: [[f64; 4]; 2],
        stance: usize,
        previous: Parameters,
        width: Option<f64>,
    ) -> Origin {
        let plan = &*self.active.plan;
        let feet = soles.map(|p| Pose::new(p[0], p[1], p[3]));
        let (frame, ground) = (feet[stance], soles[stance][2]);
        let feet = feet.map(|f| frame.relative(&f));
        let mut com = plan.com.sample(t);
        let at = frame.local([com.position[0], com.position[1]]);
        let v = rotate(-frame.heading, [com.velocity[0], com.velocity[1]]);
        let a = rotate(-frame.heading, [com.acceleration[0], com.acceleration[1]]);
        com.position = [at[0], at[1], com.position[2] - ground];
        com.velocity[..2].copy_from_slice(&v);
        com.acceleration[..2].copy_from_slice(&a);
        let mut torso = plan.torso.sample(t);
        torso.position[2] -= frame.heading;
        let [x, y, heading] = plan.origin;
        Origin {
            frame: Pose::new(x, y, heading).compose(&frame),
            height: plan.height + ground,
            stance,
            feet,
            heights: soles.map(|p| p[2] - ground),
            com,
            zmp: frame.local(plan.zmp.sample(t).0),
            torso,
            pitch: [0, 1].map(|i| plan.pitch[i].sample(t)),
            toes: [0, 1].map(|i| plan.toes[i].sample(t)),
            load_left: plan.load_left.sample(t).position[0],
            previous,
            width: width.unwrap_or(feet[1 - stance].y.abs()),
            early: None,
        }
    }

    pub(crate) fn event(&mut self, code: EventCode, detail: u64) {
        if self.events.len() < MAX_EVENTS {
            self.events.push((code, detail));
        }
    }
}

/// Why no walking command is taken in this state from a robot that does not stand.
fn not_standing(gait: GaitState) -> Option<Reason> {
    let event = |code| Some(Reason::Event { code, detail: 0 });
    match gait {
        GaitState::Idle => Some(Reason::NotStanding),
        GaitState::Fallen => event(EventCode::Fallen),
        GaitState::Halted => event(EventCode::SafeStop),
        GaitState::Standing | GaitState::Starting | GaitState::Walking | GaitState::Stopping => None,
    }
}

/// Whether a command moves the robot.
fn walks(command: &Command) -> bool {
    use Command::{Distance, Platform, Stand, Start, Velocity};
    matches!(command, Stand | Start | Velocity(_) | Distance(_) | Platform(_))
}

/// Where the robot stands before its first plan, and the heights of its soles over their mean; `None` if the
/// measurement is not finite.
fn measured(state: &ControllerState) -> Option<(Origin, [f64; 2])> {
    let all = state.feet.iter().flatten().chain(&state.com).chain(&state.origin);
    if !all.into_iter().all(|x| x.is_finite()) {
        return None;
    }
    let feet = state.feet.map(|f| Pose::new(f[0], f[1], f[3]));
    let ground = 0.5 * (state.feet[0][2] + state.feet[1][2]);
    let frame = feet[RIGHT];
    let [x, y, heading] = state.origin;
    let at = frame.local([state.com[0], state.com[1]]);
    let feet = feet.map(|f| frame.relative(&f));
    let mean = 0.5 * (feet[0].heading + feet[1].heading);
    let from = Origin {
        frame: Pose::new(x, y, heading).compose(&frame),
        height: 0.0,
        stance: RIGHT,
        feet,
        heights: [0.0; 2],
        com: Sample::rest([at[0], at[1], state.com[2] - ground]),
        zmp: at,
        torso: Sample::rest([FRAC_PI_2, FRAC_PI_2, mean]),
        pitch: [Sample::rest([0.0]); 2],
        toes: [Sample::rest([0.0]); 2],
        load_left: 0.5,
        previous: Parameters::on_the_spot(1.0),
        width: feet[LEFT].y.abs(),
        early: None,
    };
    Some((from, state.feet.map(|f| f[2] - ground)))
}
