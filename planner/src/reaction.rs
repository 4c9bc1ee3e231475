//! Reaction to pushes: inside a step, and out of standing, a plan from where the robot is, whose foot lands where it
//! catches the body ([`crate::step_adaptation`]). Where the stabilizer alone can compensate an error, nothing happens.

use crate::commands::Intent;
use crate::footsteps::StepDemand;
use crate::gait::{LEAD_MIN, Planner};
use crate::origin::{Measured, PlanOrigin};
use crate::pose::PlanarPose;
use crate::skills::{Script, Skill};
use crate::sole::{Hull, Sole};
use crate::step_adaptation::{self, Divergence, SwingFoot, Toppling};
use crate::steps::{Heights, ROUNDING, StepParameters, Stride};
use crate::verdict::PlanVerdict;
use messages::{ControllerState, Detail, EventCode, GaitState, LEFT, RIGHT};
use multibody::GRAVITY_ACCELERATION as GRAVITY;

/// \[s\] Time for which another step must be needed before it is made: a bent frame on the bus jolts the body for 20 ms.
const PERSISTS: f64 = 0.03;
/// \[s\] The same as long as the foot behind can bring the body back: what the impact of a foot that met the ground too soon
/// has left is smaller by then, what a push has left is larger.
const PERSISTS_HELD: f64 = 0.1;
/// \[rad\] Lean of a robot that no step catches.
const LOST: f64 = 0.35;
/// \[m\] Distance of the divergent component to the edge of the soles, at which a standing robot steps out.
const EDGE: f64 = 0.015;
/// \[s\] Time in which one foot takes all of the load, when the other one is to catch her.
const LOADING: f64 = 0.06;
/// \[m\] Distance from both soles at which a zero-moment point is that of a foot that bounces.
const REACH: f64 = 0.05;

/// The plan that catches the body.
struct Catch {
    from: PlanOrigin,
    /// Its first landing is enough.
    enough: bool,
    /// \[s\] Time for which it must be needed before it is made.
    persists: f64,
}

impl Planner {
    /// Plans on from inside the present step, or out of standing, if the body has to be caught; `true` if there is such a plan.
    pub(crate) fn react(&mut self, tick: u64, state: &ControllerState, gait: GaitState) -> bool {
        let start = tick + LEAD_MIN;
        let catch = match gait {
            GaitState::Starting | GaitState::Walking | GaitState::Stopping => {
                self.step_elsewhere(start, state)
            }
            GaitState::Standing => self.step_out(start, state),
            GaitState::Idle | GaitState::Fallen | GaitState::Halted => None,
        };
        let Some(Catch { from, enough, persists }) = catch else {
            self.calm = tick;
            return false;
        };
        // A jolt is over before another step is needed for so long.
        if tick.saturating_sub(self.calm) as f64 * self.builder.model.cycle_s < persists {
            return false;
        }
        self.calm = tick;
        let to = if self.intent == Intent::Walk { GaitState::Walking } else { GaitState::Stopping };
        if !self.walk_on(&from, to, enough) {
            return false;
        }
        let sound = enough && self.next.verdict == PlanVerdict::Sound;
        let code = if sound { EventCode::StepAdapted } else { EventCode::StepStretched };
        self.events.push(code, Detail::Plan(self.last_id + 1));
        self.publish(start, tick)
    }

    /// True if a plan from the tick `start` on can begin at `state`: that is one of the active plan, and no other plan is under
    /// way. A skill knows its steps, and knows of heights that others do not.
    fn may_react(&self, start: u64, state: &ControllerState) -> bool {
        let plan = &self.active.plan;
        let known = state.plan_id == plan.id && start > plan.start_tick && self.next.plan.id == 0;
        known && self.tasks.active == Skill::Walk && state.inclination_error.iter().all(|x| x.abs() < LOST)
    }

    /// From inside the step that runs at the tick `start`, to another landing than its own.
    fn step_elsewhere(&self, start: u64, state: &ControllerState) -> Option<Catch> {
        let rules = self.gait.reaction.as_ref()?;
        let (walk, model) = (&self.active, &self.builder.model);
        if !self.may_react(start, state) {
            return None;
        }
        let t = (start - walk.plan.start_tick) as f64 * model.cycle_s;
        let k = walk.steps().iter().position(|s| t < s.end)?;
        let s = &walk.strides[k];
        // Where nothing is known to lie it may land elsewhere.
        if s.is_high(&model.step) && !self.builder.footsteps.sees_nothing() {
            return None;
        }
        // From where she will be when the plan begins.
        let ahead = (start - state.header.tick) as f64 * model.cycle_s;
        let [x, y, ..] = state.feet[1 - s.stance];
        let sole = &model.soles[s.stance];
        let (place, w) = ([x, y], pendulum(state, s.heights.foothold));
        if t >= s.lift {
            let zmp = zmp_within(state, &s.foothold, sole);
            let body = divergence(state, zmp, w, ahead)?;
            let foot = SwingFoot { place, loaded: 0.0 };
            let landing = step_adaptation::adapt(rules, walk, (k, t), &body, &foot, sole)?;
            let cycles = (model.cycles(landing.rest), model.cycle_s);
            let measured = Measured { state, zmp, ahead };
            let from = PlanOrigin::inside(walk, (k, t), measured, &landing.pose, cycles);
            return Some(Catch { from, enough: landing.catches, persists: PERSISTS });
        }

        // Both feet carry: the one that is about to swing hands its load over sooner.
        let lift = model.cycles((s.lift - t).min(LOADING));
        let foot = SwingFoot { place, loaded: lift as f64 * model.cycle_s };
        let zmp = zmp_between(state, [&s.foothold, &s.takeoff], [sole, &model.soles[1 - s.stance]]);
        let body = divergence(state, zmp, w, ahead)?;
        let landing = step_adaptation::adapt(rules, walk, (k, t), &body, &foot, sole)?;
        let [x, y, z, heading] = walk.soles(t)[s.stance];
        let frame = PlanarPose::new(x, y, heading);
        let end_cycle = model.cycles(landing.rest);
        let step = Stride {
            begin: 0.0,
            lift: foot.loaded,
            end: end_cycle as f64 * model.cycle_s,
            end_cycle,
            landing: frame.relative(&landing.pose),
            ..s.seen(&frame, z)
        };
        let from = PlanOrigin::on_both_feet(walk, t, Measured { state, zmp, ahead }, &step, sole);
        let persists = if landing.held { PERSISTS_HELD } else { PERSISTS };
        Some(Catch { from, enough: landing.catches, persists })
    }

    /// Out of standing, if her divergent component leaves the soles: neither ankles nor hips could bring it back.
    fn step_out(&self, start: u64, state: &ControllerState) -> Option<Catch> {
        let rules = self.gait.reaction.as_ref()?;
        let (walk, model) = (&self.active, &self.builder.model);
        let stands = start >= walk.plan.start_tick + walk.end_cycle && state.contact == [1; 2];
        if !stands || !self.may_react(start, state) {
            return None;
        }
        // Both soles as one, seen from the right foot.
        let t = walk.end_cycle as f64 * model.cycle_s;
        let soles = walk.soles(t);
        let feet = soles.map(|p| PlanarPose::new(p[0], p[1], p[3]));
        let apart = feet[RIGHT].relative(&feet[LEFT]).y;
        let mut both = model.soles[RIGHT];
        both.center[1] += 0.5 * apart;
        both.half[1] += 0.5 * apart;
        let at = &feet[RIGHT];
        let w = pendulum(state, soles[RIGHT][2]);
        let xi = [0, 1].map(|d| state.com[d] + state.com_velocity[d] / w);
        let level = (soles[LEFT][2] - soles[RIGHT][2]).abs() < ROUNDING;
        if !(level && both.margin(at, xi) < EDGE) {
            return None;
        }
        // The foot on whose side the body is carries it, and takes its load with the zero-moment point at the edge.
        let stance = if at.local(xi)[1] > 0.5 * apart { LEFT } else { RIGHT };
        let sole = &model.soles[stance];
        let edge = both.nearest(at, xi);
        let loaded = sole.nearest(&feet[stance], edge);
        let growth = (w * LOADING).exp();
        let toppling = [0, 1].map(|d| {
            let p = 0.5 * (edge[d] + loaded[d]);
            p + (xi[d] - p) * growth
        });
        let body = Toppling { w, xi: toppling, ahead: model.model.com_forward };
        let parameters = StepParameters::on_the_spot(self.parameters.duration);
        let swing = parameters.duration * (1.0 - model.step.double_support);
        let [foothold, takeoff] = [&feet[stance], &feet[1 - stance]];
        let carried = (stance, sole);
        let width = model.step.width;
        let landing = step_adaptation::step_out(rules, &body, carried, [foothold, takeoff], (width, swing));
        // The step, seen from its stance foot.
        let lift = model.cycles(LOADING);
        let end_cycle = lift + model.cycles(landing.rest);
        let step = Stride {
            parameters,
            stance,
            width,
            begin: 0.0,
            lift: lift as f64 * model.cycle_s,
            end: end_cycle as f64 * model.cycle_s,
            end_cycle,
            foothold: PlanarPose::default(),
            takeoff: foothold.relative(takeoff),
            landing: foothold.relative(&landing.pose),
            heights: Heights { lift: model.step.swing_height, ..Heights::default() },
        };
        let ahead = (start - state.header.tick) as f64 * model.cycle_s;
        let measured = Measured { state, zmp: zmp_within(state, at, &both), ahead };
        let from = PlanOrigin::on_both_feet(walk, t, measured, &step, sole);
        Some(Catch { from, enough: landing.catches, persists: PERSISTS })
    }

    /// The plan from there: as commanded or, if that leaves the support or one step is not enough, with steps on the spot.
    /// Of two that leave it, the one that leaves it less. `false`: there is none at all.
    fn walk_on(&mut self, from: &PlanOrigin, state: GaitState, catches: bool) -> bool {
        let rest = StepParameters::on_the_spot(self.parameters.duration);
        let wishes = [self.parameters, rest];
        let mut demand =
            StepDemand { from, state, wish: wishes[0], share: 1.0, skill: Skill::Walk, script: Script::NONE };
        let mut margins = [f64::NEG_INFINITY; 2];
        for (wish, margin) in wishes.into_iter().zip(&mut margins).skip(usize::from(!catches)) {
            demand.wish = wish;
            self.builder.walk(&demand, &mut self.next);
            if self.next.verdict == PlanVerdict::Sound {
                return true;
            }
            *margin = self.next.margin;
        }
        if margins[0] > margins[1] {
            demand.wish = wishes[0];
            self.builder.walk(&demand, &mut self.next);
        }
        use PlanVerdict::{LeavesSupport, OverloadsSole, Slips, Sound};
        matches!(self.next.verdict, Sound | LeavesSupport | OverloadsSole | Slips)
    }
}

/// \[m\] Measured zero-moment point, or the nearest place in the sole at `foothold`: that of a foot which bounces, and does not
/// press for a cycle, is metres away. The desired one without a measurement.
fn zmp_within(state: &ControllerState, foothold: &PlanarPose, sole: &Sole) -> [f64; 2] {
    if state.zmp.iter().all(|x| x.is_finite()) {
        sole.nearest(foothold, state.zmp)
    } else {
        state.zmp_desired
    }
}

/// \[m\] Measured zero-moment point, if it is within reach of two feet on the ground; otherwise the desired one.
fn zmp_between(state: &ControllerState, feet: [&PlanarPose; 2], soles: [&Sole; 2]) -> [f64; 2] {
    let within = Hull::of((soles[0], feet[0]), (soles[1], feet[1])).margin(state.zmp) > -REACH;
    if within { state.zmp } else { state.zmp_desired }
}

/// \[1/s\] Rate of a pendulum as high over the ground as the measured centre of gravity.
fn pendulum(state: &ControllerState, ground: f64) -> f64 {
    (GRAVITY / (state.com[2] - ground)).sqrt()
}

/// Divergent component `ahead` \[s\] after the measurement, the zero-moment point staying at `zmp`; none without a measurement.
fn divergence(state: &ControllerState, zmp: [f64; 2], w: f64, ahead: f64) -> Option<Divergence> {
    let growth = w * ahead;
    let error = [0, 1].map(|d| {
        let shift = zmp[d] - state.zmp_desired[d];
        -state.dcm_error[d] + growth * (-state.dcm_error[d] - shift)
    });
    (w.is_finite() && error.iter().all(|e| e.is_finite())).then_some(Divergence { w, error })
}
