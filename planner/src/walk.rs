//! Builds plans: footholds → feet → ZMP reference → centre of gravity → load, heading: the stages of figure 4.1.

use crate::balance::Balance;
use crate::com::GroundPath;
use crate::feet::FootTrajectories;
use crate::foot_rollover::FootRollover;
use crate::footsteps::{Footsteps, StepDemand};
use crate::load;
use crate::origin::PlanOrigin;
use crate::pattern::PatternTrajectories;
use crate::planned_walk::{Margins, PlannedWalk};
use crate::segment::Horizon;
use crate::sole::Sole;
use crate::steps::Stride;
use crate::torso;
use crate::verdict::PlanVerdict;
use crate::walking_model::WalkingModel;
use config::Gait;
use curves::Sample;
use messages::{BodyPoint, GaitState, Plan, Step};
use multibody::GRAVITY_ACCELERATION as GRAVITY;
use std::f64::consts::FRAC_PI_2;

/// \[s\] Time for raising or lowering the body while standing.
const STAND_TIME: f64 = 2.0;

/// Builds plans. All scratch is made with it.
#[derive(Clone)]
pub struct Builder {
    pub(crate) model: WalkingModel,
    pub(crate) footsteps: Footsteps,
    pub(crate) trajectories: Trajectories,
}

/// Courses of feet and body over a sequence of steps.
#[derive(Clone)]
pub(crate) enum Trajectories {
    /// The centre of gravity over a zero-moment point that stays in its support (thesis 4.6).
    Balanced(Box<BalancedTrajectories>),
    /// Fixed parameters.
    Pattern(Box<PatternTrajectories>),
}

/// Parts of a balanced walk.
#[derive(Clone)]
pub(crate) struct BalancedTrajectories {
    pub(crate) feet: FootTrajectories,
    balance: Balance,
}

impl Builder {
    /// A builder for feet with these support rectangles.
    pub fn new(gait: &Gait, soles: [Sole; 2]) -> Self {
        let model = WalkingModel::new(gait, soles);
        Self {
            footsteps: Footsteps::new(gait),
            trajectories: Trajectories::Balanced(Box::new(BalancedTrajectories {
                feet: FootTrajectories { rollover: FootRollover::new(gait, [None; 2]) },
                balance: Balance::new(&model),
            })),
            model,
        }
    }

    /// The same with a pattern, whose torso stands over the middle of the soles.
    pub(crate) fn with_pattern(mut self, pattern: PatternTrajectories) -> Self {
        self.model.model.com_forward = self.model.soles[0].center[0];
        self.model.closes_at_once = true;
        self.trajectories = Trajectories::Pattern(Box::new(pattern));
        self
    }

    /// Point of the body that the plans lead.
    pub(crate) fn body_point(&self) -> BodyPoint {
        match self.trajectories {
            Trajectories::Balanced(_) => BodyPoint::CentreOfGravity,
            Trajectories::Pattern(_) => BodyPoint::Torso,
        }
    }

    /// What plans need besides their own cycles.
    pub(crate) fn margins(&self) -> Margins {
        match &self.trajectories {
            Trajectories::Balanced(_) => Margins::default(),
            Trajectories::Pattern(pattern) => pattern.margins(self.model.cycle_s),
        }
    }

    /// Steps as demanded and, after the second one, to rest.
    pub fn walk(&mut self, demand: &StepDemand<'_>, out: &mut PlannedWalk) {
        let leads = self.body_point();
        let (model, from, state) = (&self.model, demand.from, demand.state);
        let plan = &mut *out.plan;
        begin(plan, from, state, leads);

        // Step sequence; a head is followed by a tail of at least one step.
        let sequence = self.footsteps.plan(model, demand);
        let strides = sequence.steps();
        let last = strides[sequence.count - 1];
        out.end_cycle = last.end_cycle + model.cycles(model.step.start_time);
        let end = out.end_cycle as f64 * model.cycle_s;
        let head = if state == GaitState::Stopping || sequence.count < 3 { 0 } else { 2 };
        (out.strides, out.blocked) = (sequence.strides, sequence.blocked);
        plan.step_count = sequence.count as u64;
        for (to, s) in plan.steps.iter_mut().zip(strides) {
            *to = record(s);
        }

        lay_ground(from, strides, end, &mut plan.zmp_height);
        let horizon = Horizon { from, state, strides, head, end };
        match &mut self.trajectories {
            Trajectories::Pattern(pattern) => {
                pattern.lay(model, &horizon, plan);
                let reached = pattern.is_in_reach(&horizon, plan);
                out.verdict = if reached { PlanVerdict::Sound } else { PlanVerdict::OutOfReach };
                (out.margin, out.divergent) = (0.0, false);
            }
            Trajectories::Balanced(parts) => {
                // Feet and upper body.
                let BalancedTrajectories { feet, balance } = &mut **parts;
                feet.lay(model, from, strides, plan);
                torso::follow(&mut plan.torso, &from.torso, strides, end);
                // Zero-moment point and centre of gravity.
                let given = (&plan.feet, &plan.zmp_height);
                let balanced = balance.lay(model, &horizon, given, (&mut plan.body, &mut plan.zmp));
                (out.margin, out.verdict, out.divergent) =
                    (balanced.margin, balanced.verdict, balanced.divergent);
                // Contact forces: what each foot carries.
                if load::lay(&model.soles, &horizon, &plan.zmp, &mut plan.load_left) < -1e-9 {
                    out.verdict = out.verdict.and(PlanVerdict::OverloadsSole);
                }
            }
        }
    }

    /// Raises or lowers the body and brings the centre of gravity between the feet, whose soles are at `heights` \[m\] now.
    pub fn stand(&mut self, from: &PlanOrigin, heights: [f64; 2], out: &mut PlannedWalk) {
        let model = &self.model;
        let end_cycle = model.cycles(STAND_TIME);
        let end = end_cycle as f64 * model.cycle_s;
        let plan = &mut *out.plan;
        begin(plan, from, GaitState::Standing, self.body_point());
        let target = model.standing_point(&from.feet);
        let last = Sample::rest([target[0], target[1], model.model.com_height]);
        plan.body.restart(0.0, from.body.position);
        plan.body.push(&from.body, &last, end);
        // Soles that hang at different heights come to stand beside one another.
        for (i, z) in heights.into_iter().enumerate() {
            let p = from.feet[i];
            plan.feet[i].restart(0.0, [p.x, p.y, z, p.heading]);
            let rest = |z: f64| Sample::rest([p.x, p.y, z, p.heading]);
            plan.feet[i].push(&rest(z), &rest(from.heights[i]), end);
        }
        let heading = 0.5 * (from.feet[0].heading + from.feet[1].heading);
        plan.torso.restart(0.0, from.torso.position);
        plan.torso.push(&from.torso, &Sample::rest([FRAC_PI_2, FRAC_PI_2, heading]), end);
        // A leaning robot is led on from its measured lean.
        plan.measured = u64::from(from.torso.position[..2] != [FRAC_PI_2; 2]);
        plan.load_left.restart(0.0, [from.load_left]);
        plan.load_left.push(&Sample::rest([from.load_left]), &Sample::rest([0.5]), end);
        // The zero-moment point that belongs to this motion of one mass.
        const POINTS: usize = 24;
        for k in 0..=POINTS {
            let t = end * k as f64 / POINTS as f64;
            let c = plan.body.sample(t);
            let over = c.position[2] / (c.acceleration[2] + GRAVITY);
            plan.zmp.push(t, [0, 1].map(|d| c.position[d] - over * c.acceleration[d]));
        }
        out.end_cycle = end_cycle;
        (out.margin, out.verdict, out.divergent) = (0.0, PlanVerdict::Sound, false);
        out.blocked = None;
    }
}

/// Height of the zero-moment point: with the load from one sole to the other.
fn lay_ground(from: &PlanOrigin, strides: &[Stride], end: f64, path: &mut GroundPath) {
    let [r, l] = from.heights;
    path.push(0.0, [(1.0 - from.load_left) * r + from.load_left * l]);
    for s in strides {
        path.push(s.lift, [s.heights.foothold]);
        path.push(s.end, [s.heights.foothold]);
    }
    let last = &strides[strides.len() - 1].heights;
    path.push(end, [0.5 * (last.foothold + last.landing)]);
}

fn begin(plan: &mut Plan, from: &PlanOrigin, state: GaitState, leads: BodyPoint) {
    plan.state = state as u64;
    plan.origin = from.frame.array();
    plan.step_count = 0;
    plan.zmp.clear();
    plan.zmp_height.clear();
    plan.height = from.height;
    (plan.leads, plan.pitch_height) = (leads as u64, 0.0);
    plan.measured = u64::from(from.inside.is_some());
    for foot in 0..2 {
        plan.toes[foot].restart(0.0, from.toes[foot].position);
        plan.pitch[foot].restart(0.0, from.pitch[foot].position);
    }
}

fn record(s: &Stride) -> Step {
    Step {
        stance: s.stance as u64,
        begin: s.begin,
        lift: s.lift,
        end: s.end,
        foothold: s.foothold.array(),
        landing: s.landing.array(),
    }
}
