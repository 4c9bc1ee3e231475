//! Gait coordination: standing, starting, walking, stopping (thesis 4.2, figure 4.5), and the planner itself.

use crate::commands::{self, Intent, Taken};
use crate::foot_rollover::FootRollover;
use crate::footsteps::StepDemand;
use crate::obstacles::KnownObstacles;
use crate::origin::PlanOrigin;
use crate::pattern::PatternTrajectories;
use crate::pattern_check::{self, PatternFault};
use crate::planned_walk::{LEAD, Margins, PlannedWalk};
use crate::skills::{Skill, SkillTask, Tasks};
use crate::sole::Sole;
use crate::steps::StepParameters;
use crate::touchdown::{Touchdown, at_boundary, at_contact, is_early, touched};
use crate::verdict::PlanVerdict;
use crate::walk::{Builder, Trajectories};
use config::{Gait, Robot};
use messages::{
    Command, ControllerState, Detail, EventCode, EventQueue, GaitState, LEFT, Plan, RIGHT, Reason,
};

/// Fewest cycles before its start at which a plan can still reach the controller.
pub(crate) const LEAD_MIN: u64 = 3;
/// Most commands of one cycle.
pub const MAX_COMMANDS: usize = 16;

/// Output of one cycle of the planner.
pub struct PlannerOutput<'a> {
    /// A new plan, in the cycle in which it was made.
    pub plan: Option<&'a Plan>,
    /// Events of the cycle.
    pub events: &'a mut EventQueue,
    /// Answers to the commands, in their order.
    pub answers: &'a [Result<(), Reason>],
}

/// Plan that is due.
enum Move {
    Nothing,
    Stand,
    Start,
    Step(GaitState),
}

/// The planner: walking commands to plans.
#[derive(Clone)]
pub struct Planner {
    pub(crate) gait: Gait,
    pub(crate) builder: Builder,
    pub(crate) intent: Intent,
    pub(crate) parameters: StepParameters,
    pub(crate) tasks: Tasks,
    /// The plan being executed, as the controller reports.
    pub(crate) active: PlannedWalk,
    /// The plan that was published and has not been confirmed yet; its id is 0 if there is none.
    pub(crate) next: PlannedWalk,
    pub(crate) last_id: u64,
    /// Cycles from publication to start, and rest after a plan.
    margins: Margins,
    /// Start of the step for which no plan could be walked.
    given_up: u64,
    /// Plan and step whose early contact was looked at.
    tried: (u64, usize),
    /// Last tick in which no step had to be changed, or in which one was.
    pub(crate) calm: u64,
    pub(crate) events: EventQueue,
    answers: Vec<Result<(), Reason>>,
}

impl Planner {
    /// A planner for feet with these support rectangles (`config::robot::Foot::support`): right, left.
    pub fn new(gait: &Gait, support: [[f64; 4]; 2]) -> Self {
        let duration = gait.step.by_speed.first().map_or(1.0, |row| row[2]);
        Self {
            gait: gait.clone(),
            builder: Builder::new(gait, support.map(Sole::new)),
            intent: Intent::Rest,
            parameters: StepParameters::on_the_spot(duration),
            tasks: Tasks::default(),
            active: PlannedWalk::new(),
            next: PlannedWalk::new(),
            last_id: 0,
            margins: Margins::default(),
            given_up: 0,
            tried: (0, 0),
            calm: 0,
            events: EventQueue::default(),
            answers: Vec::with_capacity(MAX_COMMANDS),
        }
    }

    /// A planner for this robot.
    ///
    /// # Errors
    /// The gait is a pattern that this robot cannot walk.
    pub fn of(gait: &Gait, robot: &Robot) -> Result<Self, PatternFault> {
        let toe = |i: usize| robot.feet[i].toe.map(|joint| robot.joints[joint].range);
        let mut planner = Self::new(gait, [0, 1].map(|i| robot.feet[i].support)).with_toes([0, 1].map(toe));
        if let Some(pattern) = &gait.pattern {
            let trajectories = PatternTrajectories::new(pattern, robot);
            planner.builder = planner.builder.with_pattern(trajectories);
            pattern_check::check(&mut planner.builder, pattern, robot)?;
        }
        Ok(planner)
    }

    /// The same with toe joints of these ranges \[rad\]: right, left.
    pub fn with_toes(mut self, ranges: [Option<[f64; 2]>; 2]) -> Self {
        if let Trajectories::Balanced(parts) = &mut self.builder.trajectories {
            parts.feet.rollover = FootRollover::new(&self.gait, ranges);
        }
        self
    }

    /// Obstacles that are known from now on \[m\] @I_0; a gait without steps over obstacles knows of none.
    pub fn see(&mut self, known: KnownObstacles) {
        self.builder.footsteps.see(known);
    }

    /// One cycle: takes commands, follows what the controller does, and makes a plan when one is due.
    pub fn step(
        &mut self,
        tick: u64,
        cycle_s: f64,
        state: Option<&ControllerState>,
        commands: &[Command],
    ) -> PlannerOutput<'_> {
        self.answers.clear();
        self.builder.model.cycle_s = cycle_s;
        self.margins = self.builder.margins();
        // The controller is the one that knows which plan is executed.
        if let Some(state) = state {
            if state.not_standing == 1 || state.plan_id == 0 && self.active.plan.id > 0 {
                self.forget();
            }
            self.confirm(state);
            // A skill is over when the robot stands again.
            if tick >= self.rest() && self.next.plan.id == 0 {
                (self.tasks.active, self.tasks.aborted) = (Skill::Walk, false);
            }
            // It knows the heights of its ground.
            let walks = self.tasks.active == Skill::Walk;
            self.builder.footsteps.slope = if walks { state.ground_slope } else { [0.0; 2] };
        }
        if let Some(told) = self.builder.footsteps.told() {
            told.forget(tick);
        }
        // Commands are answered one by one; a robot that does not stand refuses those that would move it.
        let gait = self.gait_state(tick, state);
        let down = state.filter(|s| s.not_standing == 1).and_then(|_| not_standing(gait));
        for command in commands.iter().take(MAX_COMMANDS) {
            let answer = match down.filter(|_| commands::walks(command)) {
                Some(reason) => {
                    self.events.push(EventCode::NotStanding, Detail::Message(command.address().1.into()));
                    Err(reason)
                }
                None => match command {
                    Command::Box(_) | Command::Gone(_) => self.hear(command, tick),
                    _ => self.take(command, gait),
                },
            };
            self.answers.push(answer);
        }
        let made = match (state, self.due(tick, gait)) {
            (Some(state), _) if self.react(tick, state, gait) => true,
            (Some(state), due) => self.make(tick, gait, state, due),
            (None, _) => false,
        };
        PlannerOutput {
            plan: made.then_some(&*self.next.plan),
            events: &mut self.events,
            answers: &self.answers,
        }
    }

    /// Without power, or a controller that knows of no plan: whatever was planned, wanted and begun is over. What comes
    /// next begins from the measured joints, and with a command.
    fn forget(&mut self) {
        self.intent = Intent::Rest;
        self.parameters = StepParameters::on_the_spot(self.parameters.duration);
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
            if self.active.plan.state == GaitState::Standing as u64 {
                self.intent = self.intent.after_standing();
            }
        } else if state.header.tick >= next.start_tick {
            self.events.push(EventCode::PlanRefused, Detail::Plan(self.next.plan.id));
            self.next.plan.id = 0;
        }
    }

    /// Gait state of the robot (figure 4.5).
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
        let at_rest = tick + self.margins.lead >= self.rest();
        match (gait, self.intent) {
            _ if self.next.plan.id != 0 => Move::Nothing,
            (Idle, Intent::Stand | Intent::StandThenWalk) => Move::Stand,
            (Standing, Intent::Stand | Intent::StandThenWalk) if at_rest => Move::Stand,
            (Standing, Intent::Walk) if at_rest => Move::Start,
            (Standing, Intent::Rest) if at_rest && self.tasks.next.is_some() => Move::Start,
            (Starting | Walking | Stopping, Intent::Walk) => Move::Step(Walking),
            (Starting | Walking, _) => Move::Step(Stopping),
            _ => Move::Nothing,
        }
    }

    /// Takes a command, or refuses it with an event that names it.
    fn take(&mut self, command: &Command, gait: GaitState) -> Result<(), Reason> {
        let taken = match command {
            Command::Stand if matches!(gait, GaitState::Idle | GaitState::Standing) => {
                Ok((Intent::Stand, None))
            }
            Command::Start => self.intent.walking(gait).and_then(|intent| self.free(intent, gait, None)),
            Command::Stop | Command::End => Ok((self.stop(), None)),
            // Steps may be commanded at any time; a velocity also starts and stops the walk.
            Command::Step(step) => commands::from_step(step, &self.gait).map(|p| (self.intent, Some(p))),
            Command::Velocity(v) => commands::from_velocity(v, &self.gait).and_then(|p| match p {
                None => Ok((self.stop(), None)),
                Some(p) => self.intent.walking(gait).and_then(|intent| self.free(intent, gait, Some(p))),
            }),
            Command::Stand => Err(Reason::NotNow),
            Command::Distance(c) => self.give(SkillTask::Distance(*c), gait),
            Command::Platform(c) => self.give(SkillTask::Platform(*c), gait),
            Command::WalkParameter(change) => self.set(change).map(|()| (self.intent, None)),
            // Not for here, and commands of other processes.
            Command::Box(_)
            | Command::Gone(_)
            | Command::EmergencyStop
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
        // A refusal changes nothing.
        match taken {
            Ok((intent, parameters)) => {
                self.intent = intent;
                if let Some(asked) = parameters {
                    let before = self.parameters;
                    self.parameters = commands::shortened(&asked, &self.gait);
                    // A repeated command is not reported again.
                    if self.parameters != asked && self.parameters != before {
                        self.events.push(EventCode::CommandShortened, self.parameters.detail());
                    }
                }
                Ok(())
            }
            Err(reason) => {
                self.events.push(EventCode::CommandRefused, Detail::Message(command.address().1.into()));
                Err(reason)
            }
        }
    }

    /// Free walking, which ends the active skill; refused half-way onto a platform.
    fn free(&mut self, to: Intent, gait: GaitState, with: Option<StepParameters>) -> Result<Taken, Reason> {
        self.tasks.walk(gait == GaitState::Standing).then_some((to, with)).ok_or(Reason::NotNow)
    }

    /// A stop, by whatever command: no skill is done to its end, and none waits any more.
    fn stop(&mut self) -> Intent {
        self.tasks.stop();
        self.intent.stopped()
    }

    /// A box that somebody sees, or does not see any more: the next step is planned with it.
    fn hear(&mut self, command: &Command, tick: u64) -> Result<(), Reason> {
        let cycle_s = self.builder.model.cycle_s;
        self.builder.footsteps.told().ok_or(Reason::NotNow)?.take(command, tick, cycle_s)
    }

    /// A skill comes next: at once from standing, otherwise after a stop.
    fn give(&mut self, task: SkillTask, gait: GaitState) -> Result<Taken, Reason> {
        let begin = self.intent.walking(gait)?;
        // One waits at most: who was told that it was accepted finds it done.
        if self.tasks.next.is_some() {
            return Err(Reason::NotNow);
        }
        task.check_speed(&self.gait)?;
        if let Err((code, detail)) = task.check(&self.gait, &self.builder.model.soles[RIGHT]) {
            self.events.push(code, detail);
            return Err(Reason::Event { code, detail });
        }
        self.tasks.next = Some(task);
        // A plan that is about to begin may be that of a walk.
        let still = matches!(gait, GaitState::Idle | GaitState::Standing) && self.next.plan.id == 0;
        let busy = self.tasks.active != Skill::Walk && !self.tasks.aborted;
        let intent = if busy { self.intent } else { Intent::Rest };
        Ok((if still { begin } else { intent }, None))
    }

    /// Makes the plan that is due; `false` if none is, or none can be walked.
    fn make(&mut self, tick: u64, gait: GaitState, state: &ControllerState, due: Move) -> bool {
        match due {
            Move::Nothing => false,
            Move::Stand => self.make_stand(tick, gait, state),
            Move::Start => self.make_start(tick),
            Move::Step(to) => self.make_step(tick, state, to),
        }
    }

    /// Takes the standing pose.
    fn make_stand(&mut self, tick: u64, gait: GaitState, state: &ControllerState) -> bool {
        // From the measured joints, or from where the last plan has left the robot.
        let from = if gait == GaitState::Idle {
            PlanOrigin::measured(state, self.builder.body_point())
        } else {
            let from = self.at_rest(RIGHT);
            Some((from, from.heights))
        };
        let Some((from, heights)) = from else { return false };
        self.builder.stand(&from, heights, &mut self.next);
        self.publish(tick + self.margins.lead, tick)
    }

    /// Walks out of standing.
    fn make_start(&mut self, tick: u64) -> bool {
        // The foot on the side to which the robot goes or turns swings first.
        let p = self.parameters;
        let left_first = if p.side == 0.0 { p.turn >= 0.0 } else { p.side > 0.0 };
        let mut from = self.at_rest(if left_first { RIGHT } else { LEFT });
        if let Some(pattern) = &self.gait.pattern {
            // From a narrow stand the first foot lands w_s beside the other one too: otherwise the next step would be wider than
            // those of the walk that was checked.
            from.width = from.width.max(pattern.width);
        }
        self.intent = Intent::Walk;
        if !self.tasks.begin(&from, &self.gait, &self.builder.model.soles[from.stance])
            || !self.walk(&from, GaitState::Starting)
        {
            self.intent = Intent::Rest;
            self.events.push(EventCode::PlanKept, Detail::Plan(self.active.plan.id));
            return false;
        }
        self.publish((tick + self.margins.lead).max(self.rest()), tick)
    }

    /// Goes on from a step of the active plan: from an early contact of its foot, or from its end.
    fn make_step(&mut self, tick: u64, state: &ControllerState, to: GaitState) -> bool {
        // A skill knows the heights it steps on.
        let blind = self.tasks.active == Skill::Walk;
        let touched = touched(&self.active, state, tick, self.builder.model.cycle_s).filter(|_| blind);
        if touched.is_some_and(|touchdown| self.end_early(&touchdown, tick, state, to)) {
            self.events.push(EventCode::EarlyContact, Detail::Plan(self.last_id + 1));
            return self.publish(tick + LEAD, tick);
        }
        // By the clock: a plan from the next step boundary, as late as it can be made.
        let Some(k) = self.boundary(tick) else { return false };
        let start = self.active.plan.start_tick + self.active.strides[k].end_cycle;
        if start > tick + self.margins.lead || start == self.given_up {
            return false;
        }
        let from = at_boundary(&self.active, k, touched.filter(|t| t.step == k), state);
        if !self.walk(&from, to) {
            // The active plan goes on: it can be walked, and ends standing.
            self.given_up = start;
            if self.tasks.active != Skill::Walk {
                self.tasks.stop();
                self.intent = Intent::Rest;
            }
            self.events.push(EventCode::PlanKept, Detail::Plan(self.active.plan.id));
            return false;
        }
        self.publish(start, tick)
    }

    /// The next step boundary of the active plan at which another step follows.
    fn boundary(&self, tick: u64) -> Option<usize> {
        let steps = self.active.steps();
        let least = self.margins.lead - LEAD + LEAD_MIN;
        let k = steps.iter().position(|s| self.active.plan.start_tick + s.end_cycle >= tick + least)?;
        // A stopping plan goes on to its end once nothing but closing is left.
        (k + 1 < steps.len()).then_some(k)
    }

    /// Plans with the full change of parameters or, if that cannot be walked, with less; `true` if any can, or, where
    /// obstacles leave no way, a stop can.
    fn walk(&mut self, from: &PlanOrigin, state: GaitState) -> bool {
        let mut wish = self.parameters;
        let starting = state == GaitState::Starting;
        let first = self.builder.model.step.first_length;
        let script = self.tasks.before(from, starting, first, &mut wish);
        let commanded = self.intent == Intent::Walk;
        // A skill that ends with this step or the next one needs a plan that stops.
        let ends = state == GaitState::Walking && script.left().is_some_and(|n| n < 2);
        let state = if ends { GaitState::Stopping } else { state };
        if ends {
            self.intent = Intent::Rest;
        }
        let mut used = 1.0;
        for share in [1.0, 0.5, 0.25, 0.0] {
            used = share;
            let demand = StepDemand { from, state, wish, share, skill: self.tasks.active, script };
            self.builder.walk(&demand, &mut self.next);
            if self.next.verdict == PlanVerdict::Sound || state == GaitState::Stopping {
                break;
            }
        }
        let asked = [wish.length, wish.side, wish.turn]
            != [from.previous.length, from.previous.side, from.previous.turn];
        if used == 0.0 && asked && self.next.verdict == PlanVerdict::Sound {
            self.events.push(EventCode::StepsUnchanged, Detail::Plan(self.last_id + 1));
        }
        // An obstacle in the way ends the walk, and is reported to who wanted it.
        let Some((code, detail)) = self.next.blocked else { return self.next.verdict == PlanVerdict::Sound };
        if commanded {
            self.events.push(code, detail);
            self.tasks.stop();
        }
        self.intent = Intent::Rest;
        state == GaitState::Walking && self.walk(from, GaitState::Stopping)
    }

    pub(crate) fn publish(&mut self, start_tick: u64, tick: u64) -> bool {
        self.last_id += 1;
        let plan = &mut self.next.plan;
        plan.header.tick = tick;
        plan.id = self.last_id;
        plan.start_tick = start_tick;
        true
    }

    /// Plans on from an early touchdown, once per step; `true` if that plan can be walked.
    fn end_early(
        &mut self,
        touchdown: &Touchdown,
        tick: u64,
        state: &ControllerState,
        to: GaitState,
    ) -> bool {
        let step = (self.active.plan.id, touchdown.step);
        if !is_early(&self.active, touchdown, tick) || std::mem::replace(&mut self.tried, step) == step {
            return false;
        }
        let from = at_contact(&self.active, touchdown, state, tick, self.builder.model.cycle_s);
        from.is_some_and(|from| self.walk(&from, to))
    }

    /// First cycle in which nothing of the active plan is played any more.
    fn rest(&self) -> u64 {
        self.active.plan.start_tick + self.active.end_cycle + self.margins.tail
    }

    /// Standing on the feet of the active plan.
    fn at_rest(&self, stance: usize) -> PlanOrigin {
        PlanOrigin::at_rest(&self.active, self.builder.model.cycle_s, stance, self.parameters.duration)
    }
}

/// Reason why no walking command is taken in this state from a robot that does not stand.
fn not_standing(gait: GaitState) -> Option<Reason> {
    let event = |code| Some(Reason::Event { code, detail: Detail::Nothing });
    match gait {
        GaitState::Idle => Some(Reason::NotStanding),
        GaitState::Fallen => event(EventCode::Fallen),
        GaitState::Halted => event(EventCode::SafeStop),
        GaitState::Standing | GaitState::Starting | GaitState::Walking | GaitState::Stopping => None,
    }
}
