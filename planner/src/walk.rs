//! Builds plans: footholds → feet → ZMP reference → centre of gravity → load, heading: the stages of figure 4.1.
//!
//! A walking plan is three problems. The *periodic* one, two steps with the parameters of step 1, gives the state in
//! which step 2 begins (4.31). The *head*, steps 0 and 1, leads there from where the robot is (4.32). The *tail* leads
//! from there to rest, so that a plan that is never replaced ends standing. A stopping plan is a tail alone.

use crate::com::{ComSolver, GroundPath, HeightPath};
use crate::feet::{self, FootPath};
use crate::load::{self, DoubleSupport};
use crate::marks::Marks;
use crate::obstacles::Obstacles;
use crate::pose::{Pose, rotate};
use crate::reactive::{Blocked, Reactive};
use crate::roll::Roll;
use crate::skills::{Script, Skill};
use crate::sole::Sole;
use crate::steps::{MAX_STEPS, Parameters, Stride};
use crate::torso;
use crate::verdict::Verdict;
use crate::zmp::{Chain, Shape};
use config::{Gait, gait};
use curves::Sample;
use messages::{GaitState, LEFT, Plan, Record, Step};
use std::f64::consts::FRAC_PI_2;

/// Where a plan begins, in its own planning frame.
#[derive(Clone, Copy, Debug)]
pub struct Origin {
    /// Planning frame in I_0.
    pub frame: Pose,
    /// \[m\] Its height there.
    pub height: f64,
    /// Foot that carries the first single support; the planning frame lies below it.
    pub stance: usize,
    /// Sole frames.
    pub feet: [Pose; 2],
    /// \[m\] Heights of the soles, right, left: that of the stance foot is zero.
    pub heights: [f64; 2],
    /// Centre of gravity.
    pub com: Sample<3>,
    /// Zero-moment point.
    pub zmp: [f64; 2],
    /// Upper body: inclinations and heading.
    pub torso: Sample<3>,
    /// Pitch of the soles.
    pub pitch: [Sample<1>; 2],
    /// Toe joints.
    pub toes: [Sample<1>; 2],
    /// Load factor of the left foot.
    pub load_left: f64,
    /// Parameters of the step before.
    pub previous: Parameters,
    /// \[m\] Width with which the stance foot was placed.
    pub width: f64,
    /// \[s, m\] By how much the stance foot has touched early, and where the zero-moment point shall be then: the first
    /// double support is that much longer.
    pub early: Option<(f64, [f64; 2])>,
}

/// A plan and what the planner must remember of it.
#[derive(Clone)]
pub struct Walk {
    /// The plan as the controller gets it.
    pub plan: Box<Plan>,
    /// Its steps.
    pub strides: [Stride; MAX_STEPS],
    /// Its length in cycles.
    pub end_cycle: u64,
    /// Why it does not go where it should: obstacles.
    pub(crate) blocked: Option<Blocked>,
    /// \[m\] Least distance of the modified zero-moment point from the edge of the support polygon.
    pub margin: f64,
    /// What is wrong with it, if anything.
    pub verdict: Verdict,
    /// It meets the periodic solution in its divergent component only (thesis 4.6.2).
    pub divergent: bool,
}

impl Default for Walk {
    fn default() -> Self {
        Self::new()
    }
}

impl Walk {
    /// An empty plan.
    pub fn new() -> Self {
        Self {
            plan: Box::new(Plan::empty()),
            strides: [Stride::NONE; MAX_STEPS],
            end_cycle: 0,
            margin: 0.0,
            verdict: Verdict::Sound,
            divergent: false,
            blocked: None,
        }
    }

    /// The steps in use.
    pub fn steps(&self) -> &[Stride] {
        &self.strides[..self.plan.step_count as usize]
    }
}

/// Share of a step down by which the body is lowered when the foot lands: the ankle left behind bends no farther, and the
/// leg in front is just long enough.
const DESCENT: f64 = 0.35;

/// Builds plans. All scratch is made with it.
#[derive(Clone)]
pub struct Builder {
    pub(crate) step: gait::Step,
    pub(crate) model: gait::Model,
    /// \[m\] Longest step.
    pub(crate) longest: f64,
    /// Obstacles, if the gait can step over them.
    pub(crate) reactive: Option<Reactive>,
    /// What is being done, and the steps it wants.
    pub(crate) skill: Skill,
    pub(crate) script: Script,
    pub(crate) soles: [Sole; 2],
    pub(crate) shrunk: [Sole; 2],
    pub(crate) roll: Roll,
    pub(crate) cycle_s: f64,
    pub(crate) com: ComSolver,
    pub(crate) height: HeightPath,
    /// The same on level ground.
    pub(crate) level: HeightPath,
    pub(crate) periodic_feet: Box<[FootPath; 2]>,
    pub(crate) chain: Chain,
    pub(crate) marks: Marks,
}

impl Builder {
    /// A builder for feet with these support rectangles.
    pub fn new(gait: &Gait, soles: [Sole; 2]) -> Self {
        Self {
            step: gait.step.clone(),
            model: gait.model,
            longest: gait.limits.length[1],
            reactive: gait.obstacles.map(|rules| Reactive { known: Obstacles::default(), rules }),
            skill: Skill::Walk,
            script: Script::NONE,
            soles,
            shrunk: soles.map(|s| s.shrunk(gait.model.zmp_margin)),
            roll: Roll::new(gait, [None; 2]),
            cycle_s: 1e-3,
            com: ComSolver::new(&gait.model),
            height: HeightPath::resting(0.0, [0.0]),
            level: HeightPath::resting(0.0, [0.0]),
            periodic_feet: Box::new([FootPath::resting(0.0, [0.0; 4]); 2]),
            chain: Chain::new(),
            marks: Marks::new(),
        }
    }

    /// Length of a cycle \[s\]; phases end on whole cycles.
    pub fn set_cycle(&mut self, cycle_s: f64) {
        self.cycle_s = cycle_s;
    }

    /// Length of a cycle \[s\].
    pub fn cycle(&self) -> f64 {
        self.cycle_s
    }

    pub(crate) fn cycles(&self, t: f64) -> u64 {
        (t / self.cycle_s).round().max(1.0) as u64
    }

    /// Where the centre of gravity stands between two feet.
    pub(crate) fn standing_point(&self, feet: &[Pose; 2]) -> [f64; 2] {
        let heading = 0.5 * (feet[0].heading + feet[1].heading);
        let ahead = rotate(heading, [self.model.com_forward, 0.0]);
        [0.5 * (feet[0].x + feet[1].x) + ahead[0], 0.5 * (feet[0].y + feet[1].y) + ahead[1]]
    }

    /// Raises or lowers the body and brings the centre of gravity between the feet.
    pub fn stand(&mut self, from: &Origin, heights: [f64; 2], out: &mut Walk) {
        let end_cycle = self.cycles(self.model.stand_time);
        let end = end_cycle as f64 * self.cycle_s;
        let plan = &mut *out.plan;
        begin(plan, from, GaitState::Standing);
        let target = self.standing_point(&from.feet);
        let last = Sample::rest([target[0], target[1], self.model.com_height]);
        plan.com.restart(0.0, from.com.position);
        plan.com.push(&from.com, &last, end);
        for (i, z) in heights.into_iter().enumerate() {
            let p = from.feet[i];
            plan.feet[i].restart(0.0, [p.x, p.y, z, p.heading]);
            let rest = |z: f64| Sample::rest([p.x, p.y, z, p.heading]);
            plan.feet[i].push(&rest(z), &rest(from.heights[i]), end);
        }
        let heading = 0.5 * (from.feet[0].heading + from.feet[1].heading);
        plan.torso.restart(0.0, from.torso.position);
        plan.torso.push(&from.torso, &Sample::rest([FRAC_PI_2, FRAC_PI_2, heading]), end);
        plan.load_left.restart(0.0, [from.load_left]);
        plan.load_left.push(&Sample::rest([from.load_left]), &Sample::rest([0.5]), end);
        const POINTS: usize = 24;
        for k in 0..=POINTS {
            let t = end * k as f64 / POINTS as f64;
            let c = plan.com.sample(t);
            let over = c.position[2] / (c.acceleration[2] + crate::com::GRAVITY);
            plan.zmp.push(t, [0, 1].map(|d| c.position[d] - over * c.acceleration[d]));
        }
        out.end_cycle = end_cycle;
        (out.margin, out.verdict, out.divergent) = (0.0, Verdict::Sound, false);
        out.blocked = None;
    }

    /// Steps towards `wish` and, after the second one, to rest. `share` of the largest change per step is used.
    pub fn walk(&mut self, from: &Origin, state: GaitState, wish: &Parameters, share: f64, out: &mut Walk) {
        begin(&mut out.plan, from, state);
        let (count, blocked) = self.sequence(from, state, wish, share, &mut out.strides);
        self.skill.after(from, &mut out.strides[..count]);
        out.blocked = self.lift_over(from, &mut out.strides[..count]).or(blocked);
        // A head is followed by a tail of at least one step.
        let head = if state == GaitState::Stopping || count < 3 { 0 } else { 2 };
        out.plan.step_count = count as u64;
        let strides = out.strides;
        let strides = &strides[..count];
        let last = strides[count - 1];
        out.end_cycle = last.end_cycle + self.cycles(self.step.start_time);
        let end = out.end_cycle as f64 * self.cycle_s;
        let plan = &mut *out.plan;
        for (k, s) in strides.iter().enumerate() {
            plan.steps[k] = record(s);
        }
        self.lay_feet(from, strides, &mut plan.feet);
        self.roll.lay(from, strides, self.step.start_time, plan);
        self.tilt(strides, &mut plan.pitch);
        torso::follow(&mut plan.torso, &from.torso, strides, end);
        self.lay_height(from, strides, &plan.feet);
        lay_ground(from, strides, end, &mut plan.zmp_height);
        let balance = self.lay_com(from, state, strides, head, end, plan);
        (out.margin, out.verdict, out.divergent) = (balance.margin, balance.verdict, balance.divergent);
        if self.lay_load(from, strides, end, plan) < -1e-9 {
            out.verdict = out.verdict.and(Verdict::OverloadsSole);
        }
    }

    fn lay_feet(&self, from: &Origin, strides: &[Stride], paths: &mut [FootPath; 2]) {
        for i in 0..2 {
            feet::stand(&mut paths[i], 0.0, &from.feet[i], from.heights[i]);
        }
        for s in strides {
            let swing = s.swing(&self.step);
            feet::swing(&mut paths[1 - s.stance], &swing, &s.takeoff, &s.landing, &s.heights);
        }
    }

    /// Height of the body: from where it is to where it is when the robot stands, within the first step, and from then
    /// on with the mean height of the feet.
    fn lay_height(&mut self, from: &Origin, strides: &[Stride], feet: &[FootPath; 2]) {
        let axis = |s: Sample<3>| Sample {
            position: [s.position[2]],
            velocity: [s.velocity[2]],
            acceleration: [s.acceleration[2]],
        };
        let first = axis(self.com.body(&from.com, feet, 0.0));
        let mean = 0.5 * (from.heights[0] + from.heights[1]);
        let standing = Sample::rest([0.0, 0.0, self.model.com_height + mean]);
        let standing = self.com.body(&standing, feet, 0.0).position[2] - mean;
        self.level.restart(0.0, [standing]);
        self.height.restart(0.0, first.position);
        let mut last = first;
        for s in strides {
            let (from, to) = (s.heights.foothold, s.heights.landing);
            let share = if to < from { DESCENT } else { 0.5 };
            let next = Sample::rest([standing + from + share * (to - from)]);
            self.height.push(&last, &next, s.end);
            last = next;
        }
    }

    /// Load factors, with the zero-moment point (thesis 4.8). Returns the least distance \[m\] of the zero-moment point from
    /// the edge of what both soles can carry.
    fn lay_load(&self, from: &Origin, strides: &[Stride], end: f64, plan: &mut Plan) -> f64 {
        let Plan { zmp, load_left: path, .. } = plan;
        path.restart(0.0, [from.load_left]);
        let mut load = from.load_left;
        let mut least = f64::INFINITY;
        let mut lay = |begin: f64, end: f64, until: f64, feet: [Pose; 2], to: f64| {
            let times = rest_shape(begin, end).corners();
            let kinks = times.map(|t| (t, zmp.sample(t).0));
            let straight = [kinks[0], kinks[3]];
            let leaves = |k: usize| {
                let s = (kinks[k].0 - begin) / (end - begin);
                (0..2).any(|d| (kinks[k].1[d] - (1.0 - s) * kinks[0].1[d] - s * kinks[3].1[d]).abs() > 1e-9)
            };
            let kinks = if leaves(1) || leaves(2) { &kinks[..] } else { &straight[..] };
            let support = DoubleSupport { kinks, feet, soles: &self.soles, ends: [load, to] };
            least = least.min(support.lay(path));
            load::hold(path, to, until);
            load = to;
        };
        for s in strides {
            let mut feet = [s.foothold; 2];
            feet[1 - s.stance] = s.takeoff;
            lay(s.begin, s.lift, s.end, feet, if s.stance == LEFT { 1.0 } else { 0.0 });
        }
        let last = &strides[strides.len() - 1];
        let mut feet = [last.foothold; 2];
        feet[1 - last.stance] = last.landing;
        lay(last.end, end, end, feet, 0.5);
        least
    }
}

/// Height of the zero-moment point: with the load from one sole to the other.
fn lay_ground(from: &Origin, strides: &[Stride], end: f64, path: &mut GroundPath) {
    let [r, l] = from.heights;
    path.push(0.0, [(1.0 - from.load_left) * r + from.load_left * l]);
    for s in strides {
        path.push(s.lift, [s.heights.foothold]);
        path.push(s.end, [s.heights.foothold]);
    }
    let last = &strides[strides.len() - 1].heights;
    path.push(end, [0.5 * (last.foothold + last.landing)]);
}

/// Where the zero-moment point may leave its reference while both feet stand.
pub(crate) fn rest_shape(begin: f64, end: f64) -> Shape {
    let third = (end - begin) / 3.0;
    Shape { rise: (begin, begin + third), fall: (end - third, end) }
}

fn begin(plan: &mut Plan, from: &Origin, state: GaitState) {
    plan.state = state as u64;
    plan.origin = from.frame.array();
    plan.step_count = 0;
    plan.zmp.clear();
    plan.zmp_height.clear();
    plan.height = from.height;
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
