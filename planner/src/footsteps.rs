//! Step sequence planning: footholds and their times (thesis 4.3), over obstacles (4.3.3) and as a skill wants it
//! (4.3.4).

use crate::obstacles::KnownObstacles;
use crate::origin::PlanOrigin;
use crate::pose::{PlanarPose, rotate};
use crate::reactive::Reactive;
use crate::skills::{Script, Skill};
use crate::steps::{Heights, MAX_STEPS, ROUNDING, StepParameters, Stride, next_foothold, next_width, nu};
use crate::told_boxes::ToldBoxes;
use crate::verdict::Blocked;
use crate::walking_model::WalkingModel;
use config::Gait;
use messages::GaitState;

/// Demand on the steps of one plan.
#[derive(Clone, Copy, Debug)]
pub struct StepDemand<'a> {
    /// Origin of the plan.
    pub from: &'a PlanOrigin,
    /// Starting, walking or stopping.
    pub state: GaitState,
    /// Parameters that the steps are to reach.
    pub wish: StepParameters,
    /// \[1\] Share of the largest change from step to step that is used.
    pub share: f64,
    /// Active skill.
    pub skill: Skill,
    /// Steps that it prescribes.
    pub script: Script,
}

/// Steps of one plan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepSequence {
    pub(crate) strides: [Stride; MAX_STEPS],
    pub(crate) count: usize,
    /// First obstacle in the way, if there is one.
    pub(crate) blocked: Option<Blocked>,
}

impl StepSequence {
    pub(crate) fn steps(&self) -> &[Stride] {
        &self.strides[..self.count]
    }
}

/// Planner of the step sequence.
#[derive(Clone)]
pub(crate) struct Footsteps {
    /// Obstacles, if the gait can step over them.
    reactive: Option<Reactive>,
    /// \[1\] @I_0 Rise of the ground per metre along x and y.
    pub(crate) slope: [f64; 2],
}

/// Start of a step: what the steps before have left.
struct Foothold {
    stance: usize,
    /// Poses of the stance foot and of the foot that is going to swing.
    at: PlanarPose,
    takeoff: PlanarPose,
    heights: Heights,
    /// Parameters and width of the step before.
    parameters: StepParameters,
    width: f64,
    /// Its end in cycles from the start of the plan.
    end_cycle: u64,
}

impl Footsteps {
    /// For a gait; nothing is known of obstacles yet.
    pub(crate) fn new(gait: &Gait) -> Self {
        let longest = gait.limits.length[1];
        let reactive =
            gait.obstacles.map(|rules| Reactive { known: KnownObstacles::default(), rules, longest });
        Self { reactive, slope: [0.0; 2] }
    }

    /// Nothing is known to lie on the ground.
    pub(crate) fn sees_nothing(&self) -> bool {
        self.reactive.as_ref().is_none_or(|reactive| reactive.known.is_empty())
    }

    /// Obstacles that are known from now on; a gait without steps over obstacles knows of none.
    pub(crate) fn see(&mut self, known: KnownObstacles) {
        if let Some(reactive) = &mut self.reactive {
            reactive.known = known;
        }
    }

    /// Boxes that are told while she walks; none of a gait without steps over obstacles.
    pub(crate) fn told(&mut self) -> Option<&mut ToldBoxes> {
        self.reactive.as_mut().map(|reactive| &mut reactive.known.told)
    }

    /// Steps from `demand.from`, with the heights of the skill, lifted over obstacles.
    pub(crate) fn plan(&self, model: &WalkingModel, demand: &StepDemand<'_>) -> StepSequence {
        let mut sequence = self.sequence(model, demand);
        let strides = &mut sequence.strides[..sequence.count];
        demand.skill.after(demand.from, strides);
        let touched = self.reactive.as_ref().and_then(|r| r.lift_over(model, demand.from, strides));
        sequence.blocked = touched.or(sequence.blocked);
        sequence
    }

    /// Footholds and times (thesis 4.3); what makes a step before the last ones shorter than it should be.
    fn sequence(&self, model: &WalkingModel, demand: &StepDemand<'_>) -> StepSequence {
        let (from, state, step) = (demand.from, demand.state, &model.step);
        let mut sequence = StepSequence { strides: [Stride::NONE; MAX_STEPS], count: 0, blocked: None };
        let mut last = Foothold::first(from, step.swing_height);
        let slope = rotate(-from.frame.heading, self.slope);
        if let Some(inside) = &from.inside {
            sequence.strides[0] = inside.stride;
            sequence.count = 1;
            last = Foothold::after(&inside.stride);
        }
        loop {
            let n = sequence.count;
            let (stance, nu, sole) = (last.stance, nu(last.stance), &model.soles[last.stance]);
            let closing = closes(demand, n, &last.parameters, model);
            let (parameters, width, landing) = if closing {
                // The swing foot is put beside the stance foot.
                let parameters = StepParameters::on_the_spot(last.parameters.duration);
                (parameters, step.width, last.at.compose(&PlanarPose::new(0.0, nu * step.width, 0.0)))
            } else {
                let (parameters, why) = self.parameters(model, demand, n, &last);
                sequence.blocked = sequence.blocked.or(why);
                let width = next_width(&parameters, last.width, nu, step, sole);
                let next = next_foothold(&parameters, last.width, width, nu, sole);
                (parameters, width, last.at.compose(&next))
            };

            // Phases: the share of the double support, but for the first step out of standing. A foot that touched early
            // stands in a longer one, in which the weight moves when it would have.
            let begin = last.end_cycle as f64 * model.cycle_s;
            let support = step.double_support * parameters.duration;
            let swing = parameters.duration - support;
            let support = if n == 0 && state == GaitState::Starting { step.start_time } else { support };
            let support = if n == 0 { support + from.early.map_or(0.0, |e| e.0) } else { support };
            let end_cycle = last.end_cycle + model.cycles(support + swing);
            let rise = slope[0] * (landing.x - last.at.x) + slope[1] * (landing.y - last.at.y);
            let stride = Stride {
                parameters,
                stance,
                width,
                begin,
                lift: begin + support,
                end: end_cycle as f64 * model.cycle_s,
                end_cycle,
                foothold: last.at,
                takeoff: last.takeoff,
                landing,
                heights: Heights { landing: last.heights.foothold + rise, ..last.heights },
            };
            sequence.strides[n] = stride;
            sequence.count += 1;
            if closing {
                // A robot that stops anyway is not made to stop by an obstacle.
                sequence.blocked = sequence.blocked.filter(|_| state != GaitState::Stopping);
                return sequence;
            }
            last = Foothold::after(&stride);
        }
    }

    /// Parameters of step `n`, which does not close the feet, and why it is shorter than it should be, if it is.
    fn parameters(
        &self,
        model: &WalkingModel,
        demand: &StepDemand<'_>,
        n: usize,
        last: &Foothold,
    ) -> (StepParameters, Option<Blocked>) {
        let step = &model.step;
        // From the third step on, and when stopping, a plan comes to rest by itself.
        let ending = demand.state == GaitState::Stopping || n >= 2;
        let rest = StepParameters::on_the_spot(last.parameters.duration);
        let (wish, share) = if ending { (&rest, 1.0) } else { (&demand.wish, demand.share) };
        let mut parameters = last.parameters.towards(wish, step, share);
        if model.limits.used(parameters.way(), parameters.duration) > 1.0 + ROUNDING {
            parameters = last.parameters.straight_towards(wish, step, share);
        }
        if n == 0 && demand.state == GaitState::Starting {
            // Feet that stand side by side have no step before: a step that ends a walk may be as long.
            let most = step.first_length * demand.share;
            parameters.length = demand.wish.length.clamp(-most, most);
        }
        match demand.script.length(n) {
            Some(length) => (StepParameters { length, ..parameters }, None),
            None => self.clear(model, demand, last, &parameters, wish),
        }
    }

    /// The step `p`, made so that it does not end on an obstacle or at the wall of a skill, and why if it is shorter for
    /// that.
    fn clear(
        &self,
        model: &WalkingModel,
        demand: &StepDemand<'_>,
        last: &Foothold,
        p: &StepParameters,
        wish: &StepParameters,
    ) -> (StepParameters, Option<Blocked>) {
        let from = demand.from;
        let room = demand.script.wall - last.at.x;
        let mut free = StepParameters { length: p.length.min(room.max(0.0)), ..*p };
        let Some(reactive) = &self.reactive else { return (free, None) };
        let at = from.frame.compose(&last.at);
        let adapted = reactive.adapt(model, at, from.height, last.stance, &free, wish);
        free.length = adapted.length;
        if adapted.near {
            let slower = reactive.rules.duration.min(last.parameters.duration + model.step.change_duration);
            free.duration = free.duration.max(slower);
        }
        (free, adapted.blocked)
    }
}

/// Does step `n` close the feet? `previous` are the parameters of the step before.
fn closes(demand: &StepDemand<'_>, n: usize, previous: &StepParameters, model: &WalkingModel) -> bool {
    let stops = demand.state == GaitState::Stopping;
    let short = previous.length.abs() <= model.step.first_length;
    let may = match (model.closes_at_once, stops) {
        (true, true) => true,
        (true, false) => n > 1,
        (false, true) => n > 0 && short,
        (false, false) => n > 2 && short,
    };
    let closing = match demand.script.length(n) {
        Some(_) => false,
        None => demand.script.closes(n) || may,
    };
    closing || n + 1 == MAX_STEPS
}

impl Foothold {
    /// Start of the first step of a plan.
    fn first(from: &PlanOrigin, swing_height: f64) -> Self {
        let stance = from.stance;
        Self {
            stance,
            at: from.feet[stance],
            takeoff: from.feet[1 - stance],
            heights: Heights { takeoff: from.heights[1 - stance], lift: swing_height, ..Heights::default() },
            parameters: from.previous,
            width: from.width,
            end_cycle: 0,
        }
    }

    /// The foot that has landed carries the next step.
    fn after(s: &Stride) -> Self {
        let heights = Heights { foothold: s.heights.landing, takeoff: s.heights.foothold, ..s.heights };
        Self {
            stance: 1 - s.stance,
            at: s.landing,
            takeoff: s.foothold,
            heights,
            parameters: s.parameters,
            width: s.width,
            end_cycle: s.end_cycle,
        }
    }
}
