//! Builds plans: footholds → feet → ZMP reference → centre of gravity → load, heading: the stages of figure 4.1.
//!
//! A walking plan is three problems. The *periodic* one, two steps with the parameters of step 1, gives the state in
//! which step 2 begins (4.31). The *head*, steps 0 and 1, leads there from where the robot is (4.32). The *tail* leads
//! from there to rest, so that a plan that is never replaced ends standing. A stopping plan is a tail alone.

use crate::collocation::{MAX_KNOTS, State};
use crate::com::{ComSolver, Drive, HeightPath, pieces};
use crate::feet::{self, FootPath, Swing};
use crate::load::{self, DoubleSupport};
use crate::pose::{Pose, rotate};
use crate::sole::{Sole, double_support_margin};
use crate::steps::{MAX_STEPS, Parameters, Stride, next_foothold, next_width, nu};
use crate::torso;
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
    /// Foot that carries the first single support; the planning frame lies below it.
    pub stance: usize,
    /// Sole frames.
    pub feet: [Pose; 2],
    /// Centre of gravity.
    pub com: Sample<3>,
    /// Zero-moment point.
    pub zmp: [f64; 2],
    /// Upper body: inclinations and heading.
    pub torso: Sample<3>,
    /// Load factor of the left foot.
    pub load_left: f64,
    /// Parameters of the step before.
    pub previous: Parameters,
    /// \[m\] Width with which the stance foot was placed.
    pub width: f64,
}

/// A plan and what the planner must remember of it.
pub struct Walk {
    /// The plan as the controller gets it.
    pub plan: Box<Plan>,
    /// Its steps.
    pub strides: [Stride; MAX_STEPS],
    /// Its length in cycles.
    pub end_cycle: u64,
    /// \[m\] Least distance of the modified zero-moment point from the edge of the support polygon.
    pub margin: f64,
}

impl Default for Walk {
    fn default() -> Self {
        Self::new()
    }
}

impl Walk {
    /// An empty plan.
    pub fn new() -> Self {
        Self { plan: Box::new(Plan::empty()), strides: [Stride::NONE; MAX_STEPS], end_cycle: 0, margin: 0.0 }
    }

    /// The steps in use.
    pub fn steps(&self) -> &[Stride] {
        &self.strides[..self.plan.step_count as usize]
    }
}

/// Builds plans. All scratch is made with it.
pub struct Builder {
    step: gait::Step,
    model: gait::Model,
    soles: [Sole; 2],
    shrunk: [Sole; 2],
    cycle_s: f64,
    com: ComSolver,
    height: HeightPath,
    periodic_feet: Box<[FootPath; 2]>,
    chain: Chain,
    marks: Marks,
}

impl Builder {
    /// A builder for feet with these support rectangles.
    pub fn new(gait: &Gait, soles: [Sole; 2]) -> Self {
        Self {
            step: gait.step.clone(),
            model: gait.model,
            soles,
            shrunk: soles.map(|s| s.shrunk(gait.model.zmp_margin)),
            cycle_s: 1e-3,
            com: ComSolver::new(&gait.model),
            height: HeightPath::resting(0.0, [0.0]),
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

    fn cycles(&self, t: f64) -> u64 {
        (t / self.cycle_s).round().max(1.0) as u64
    }

    /// Where the centre of gravity stands between two feet.
    fn standing_point(&self, feet: &[Pose; 2]) -> [f64; 2] {
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
            plan.feet[i].push(&rest(z), &rest(0.0), end);
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
        out.margin = 0.0;
    }

    /// Steps towards `wish` and, after the second one, to rest. `share` of the largest change per step is used.
    pub fn walk(&mut self, from: &Origin, state: GaitState, wish: &Parameters, share: f64, out: &mut Walk) {
        begin(&mut out.plan, from, state);
        let head = if state == GaitState::Stopping { 0 } else { 2 };
        let count = self.sequence(from, state, wish, share, &mut out.strides);
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
        torso::follow(&mut plan.torso, &from.torso, strides, end);
        self.lay_height(from, strides[0].end, &plan.feet);
        out.margin = self.lay_com(from, state, strides, head, end, plan);
        self.lay_load(from, strides, end, plan);
    }

    /// Footholds and times (thesis 4.3).
    fn sequence(
        &self,
        from: &Origin,
        state: GaitState,
        wish: &Parameters,
        share: f64,
        strides: &mut [Stride; MAX_STEPS],
    ) -> usize {
        let mut last = Stride::NONE;
        let mut stance = from.stance;
        let mut foothold = from.feet[stance];
        let mut takeoff = from.feet[1 - stance];
        let mut parameters = from.previous;
        let mut width = from.width;
        let mut n = 0;
        let most = self.step.first_length;
        loop {
            let closing = if state == GaitState::Stopping { n > 0 } else { n > 2 };
            let closing = (closing && parameters.length.abs() <= most) || n + 1 == MAX_STEPS;
            let ending = state == GaitState::Stopping || n >= 2;
            let nu = nu(stance);
            let landing = if closing {
                parameters = Parameters::on_the_spot(parameters.duration);
                width = self.step.width;
                foothold.compose(&Pose::new(0.0, nu * width, 0.0))
            } else {
                let rest = Parameters::on_the_spot(parameters.duration);
                parameters = if ending {
                    parameters.towards(&rest, &self.step, 1.0)
                } else {
                    parameters.towards(wish, &self.step, share)
                };
                if n == 0 && state == GaitState::Starting {
                    parameters.length = parameters.length.clamp(-most, most);
                }
                let w_n = next_width(&parameters, width, nu, &self.step, &self.soles[stance]);
                let landing =
                    foothold.compose(&next_foothold(&parameters, width, w_n, nu, &self.soles[stance]));
                width = w_n;
                landing
            };
            let begin = last.end_cycle as f64 * self.cycle_s;
            let support = self.step.double_support * parameters.duration;
            let swing = parameters.duration - support;
            let support = if n == 0 && state == GaitState::Starting { self.step.start_time } else { support };
            let end_cycle = last.end_cycle + self.cycles(support + swing);
            last = Stride {
                parameters,
                stance,
                width,
                begin,
                lift: begin + support,
                end: end_cycle as f64 * self.cycle_s,
                end_cycle,
                foothold,
                takeoff,
                landing,
            };
            strides[n] = last;
            n += 1;
            if closing {
                return n;
            }
            takeoff = foothold;
            foothold = landing;
            stance = 1 - stance;
        }
    }

    fn lay_feet(&self, from: &Origin, strides: &[Stride], paths: &mut [FootPath; 2]) {
        for i in 0..2 {
            feet::stand(&mut paths[i], 0.0, &from.feet[i]);
        }
        for s in strides {
            let swing = Swing::new(s.lift, s.end, &self.step);
            feet::swing(&mut paths[1 - s.stance], &swing, &s.takeoff, &s.landing, self.step.swing_height);
        }
    }

    /// Height of the body: from where it is to where it is when the robot stands, within the first step.
    fn lay_height(&mut self, from: &Origin, end: f64, feet: &[FootPath; 2]) {
        let axis = |s: Sample<3>| Sample {
            position: [s.position[2]],
            velocity: [s.velocity[2]],
            acceleration: [s.acceleration[2]],
        };
        let first = axis(self.com.body(&from.com, feet, 0.0));
        let standing = Sample::rest([0.0, 0.0, self.model.com_height]);
        let last = axis(self.com.body(&standing, feet, 0.0));
        self.height.restart(0.0, first.position);
        self.height.push(&first, &last, end);
    }

    /// The three boundary value problems; returns the least margin of the modified zero-moment point.
    fn lay_com(
        &mut self,
        from: &Origin,
        state: GaitState,
        strides: &[Stride],
        head: usize,
        end: f64,
        plan: &mut Plan,
    ) -> f64 {
        let (spacing, tail_spacing) = self.spacing(strides, head, end);
        plan.com.restart(0.0, from.com.position);
        let body = self.com.body(&from.com, &plan.feet, 0.0);
        let mut now = State::of(&body);
        let mut p = from.zmp;
        let mut margin = f64::INFINITY;
        if head > 0 {
            let (target, p_target) = self.periodic(&strides[1], strides[0].stance, spacing);
            self.chain.clear();
            self.chain.fix(0.0, p);
            self.hold(&strides[0], true);
            self.hold(&strides[1], false);
            self.chain.fix(strides[1].end, p_target);
            let first = if state == GaitState::Starting {
                rest_shape(0.0, strides[0].lift)
            } else {
                self.shape(&strides[0])
            };
            let shapes = [first, self.shape(&strides[1])];
            self.marks.clear(0.0);
            self.mark(&strides[..2]);
            self.marks.add(&first.corners());
            margin = margin.min(self.solve(&now, &target, shapes, &strides[..2], spacing, plan));
            now = target;
            p = p_target;
        }
        let tail = &strides[head..];
        let last = &strides[strides.len() - 1];
        let begin = tail[0].begin;
        self.chain.clear();
        self.chain.fix(begin, p);
        for s in tail {
            self.hold(s, true);
        }
        let mut feet = [last.foothold; 2];
        feet[1 - last.stance] = last.landing;
        let goal = self.standing_point(&feet);
        self.chain.fix(end, goal);
        let target = State::of(&self.com.body(&Sample::rest([goal[0], goal[1], 0.0]), &plan.feet, end));
        let settle = rest_shape(last.end, end);
        self.marks.clear(begin);
        self.mark(tail);
        self.marks.add(&settle.corners());
        let shapes = [self.shape(&tail[0]), settle];
        margin.min(self.solve(&now, &target, shapes, tail, tail_spacing, plan))
    }

    /// Load factors, with the zero-moment point (thesis 4.8).
    fn lay_load(&self, from: &Origin, strides: &[Stride], end: f64, plan: &mut Plan) {
        let Plan { zmp, load_left: path, .. } = plan;
        path.restart(0.0, [from.load_left]);
        let mut load = from.load_left;
        let mut lay = |begin: f64, end: f64, until: f64, feet: [Pose; 2], to: f64| {
            let times = rest_shape(begin, end).corners();
            let kinks = times.map(|t| (t, zmp.sample(t).0));
            let straight = [kinks[0], kinks[3]];
            let leaves = |k: usize| {
                let s = (kinks[k].0 - begin) / (end - begin);
                (0..2).any(|d| (kinks[k].1[d] - (1.0 - s) * kinks[0].1[d] - s * kinks[3].1[d]).abs() > 1e-9)
            };
            let kinks = if leaves(1) || leaves(2) { &kinks[..] } else { &straight[..] };
            DoubleSupport { kinks, feet, soles: &self.soles, ends: [load, to] }.lay(path);
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
    }

    /// Knot spacings of head and tail with which the plan's centre of gravity has room for all pieces.
    fn spacing(&mut self, strides: &[Stride], head: usize, end: f64) -> (f64, f64) {
        let count = |marks: &Marks, spacing: f64| {
            marks.windows().map(|w| pieces(w[1] - w[0], spacing)).sum::<usize>()
        };
        let (mut spacing, mut tail_spacing) = (self.model.spacing, self.model.spacing);
        loop {
            self.marks.clear(0.0);
            self.mark(&strides[..head]);
            self.marks.add(&rest_shape(0.0, strides[0].lift).corners());
            let first = if head > 0 { count(&self.marks, spacing) } else { 0 };
            self.marks.clear(strides[head].begin);
            self.mark(&strides[head..]);
            self.marks.add(&rest_shape(strides[strides.len() - 1].end, end).corners());
            if first + count(&self.marks, tail_spacing) < MAX_KNOTS || tail_spacing > 10.0 {
                return (spacing, tail_spacing);
            }
            tail_spacing *= 1.1;
            if tail_spacing > 3.0 * spacing {
                spacing *= 1.1;
            }
        }
    }

    fn shape(&self, s: &Stride) -> Shape {
        Shape { rise: (s.begin, s.lift), fall: (Swing::new(s.lift, s.end, &self.step).lowering(), s.end) }
    }

    fn mark(&mut self, strides: &[Stride]) {
        for s in strides {
            self.marks.add(&[s.begin]);
            self.marks.add(&Swing::new(s.lift, s.end, &self.step).marks());
        }
    }

    /// The stance foot holds the zero-moment point at both ends of the single support.
    fn hold(&mut self, s: &Stride, both: bool) {
        let sole = &self.shrunk[s.stance];
        self.chain.hold(s.lift, sole, &s.foothold);
        if both {
            self.chain.hold(s.end, sole, &s.foothold);
        }
    }

    /// Solves one boundary value problem and appends its centre of gravity and zero-moment point to the plan.
    fn solve(
        &mut self,
        begin: &State,
        end: &State,
        shapes: [Shape; 2],
        strides: &[Stride],
        spacing: f64,
        plan: &mut Plan,
    ) -> f64 {
        self.chain.solve();
        let drive = Drive { feet: &plan.feet, height: &self.height, zmp: &self.chain, shapes };
        self.com.solve(&drive, self.marks.as_slice(), spacing);
        let gamma = self.com.problem().amplitudes(begin, end);
        self.com.write(begin, end, &gamma, &self.height, &mut plan.com);
        let zmp = |t: f64| {
            let p = self.chain.at(t);
            let s = shapes.map(|s| s.at(t));
            [0, 1].map(|d| p[d] + gamma[0][d] * s[0] + gamma[1][d] * s[1])
        };
        let mut margin = f64::INFINITY;
        for &t in self.marks.as_slice() {
            let p = zmp(t);
            plan.zmp.push(t, p);
            margin = margin.min(self.support_margin(strides, t, p));
        }
        margin
    }

    /// Distance of `p` from the edge of the support polygon at `t`.
    fn support_margin(&self, strides: &[Stride], t: f64, p: [f64; 2]) -> f64 {
        let s = strides.iter().find(|s| t <= s.end + 1e-9);
        match s {
            Some(s) if t >= s.lift - 1e-9 => self.soles[s.stance].margin(&s.foothold, p),
            Some(s) => {
                let other = (&self.soles[1 - s.stance], &s.takeoff);
                double_support_margin((&self.soles[s.stance], &s.foothold), other, p)
            }
            None => {
                let s = &strides[strides.len() - 1];
                let other = (&self.soles[1 - s.stance], &s.landing);
                double_support_margin((&self.soles[s.stance], &s.foothold), other, p)
            }
        }
    }

    /// State of the body and zero-moment point at the start of the periodic solution (4.31) after step `s`; `stance`
    /// carries its first step.
    fn periodic(&mut self, s: &Stride, stance: usize, spacing: f64) -> (State, [f64; 2]) {
        let (f1, f2) = (s.foothold, s.landing);
        let nu = nu(stance);
        let sole = self.soles[stance];
        let w_n = next_width(&s.parameters, s.width, nu, &self.step, &sole);
        let f3 = f2.compose(&next_foothold(&s.parameters, s.width, w_n, nu, &sole));
        let f4 = f3.compose(&f1.relative(&f2)); // errata 2.9: the second step repeats the one before
        let duration = s.end_cycle as f64 * self.cycle_s - s.begin;
        let support = s.lift - s.begin;
        let t = [s.end, s.end + duration, s.end + 2.0 * duration];
        let swings = [0, 1].map(|k| Swing::new(t[k] + support, t[k + 1], &self.step));
        let paths = &mut self.periodic_feet;
        feet::stand(&mut paths[stance], t[0], &f2);
        feet::stand(&mut paths[1 - stance], t[0], &f1);
        feet::swing(&mut paths[1 - stance], &swings[0], &f1, &f3, self.step.swing_height);
        feet::swing(&mut paths[stance], &swings[1], &f2, &f4, self.step.swing_height);
        self.chain.clear();
        self.chain.hold(t[0], &self.shrunk[1 - stance], &f1);
        self.chain.hold(swings[0].lift, &self.shrunk[stance], &f2);
        self.chain.hold(t[1], &self.shrunk[stance], &f2);
        self.chain.hold(swings[1].lift, &self.shrunk[1 - stance], &f3);
        self.chain.fix(t[2], [0.0; 2]);
        self.chain.solve_periodic(&f1, &f3);
        self.marks.clear(t[0]);
        self.marks.add(&swings[0].marks());
        self.marks.add(&swings[1].marks());
        let none = Shape { rise: (-2.0, -1.9), fall: (-1.1, -1.0) };
        let drive =
            Drive { feet: &self.periodic_feet, height: &self.height, zmp: &self.chain, shapes: [none, none] };
        self.com.solve(&drive, self.marks.as_slice(), spacing);
        (self.com.problem().periodic_state(&f1, &f3), self.chain.nodes()[0].p)
    }
}

/// Where the zero-moment point may leave its reference while both feet stand.
fn rest_shape(begin: f64, end: f64) -> Shape {
    let third = (end - begin) / 3.0;
    Shape { rise: (begin, begin + third), fall: (end - third, end) }
}

fn begin(plan: &mut Plan, from: &Origin, state: GaitState) {
    plan.state = state as u64;
    plan.origin = from.frame.array();
    plan.step_count = 0;
    plan.zmp.clear();
    for toe in &mut plan.toes {
        toe.restart(0.0, [0.0]);
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

/// Instants at which a trajectory has a kink, ascending.
struct Marks {
    len: usize,
    times: [f64; 64],
}

impl Marks {
    fn new() -> Self {
        Self { len: 0, times: [0.0; 64] }
    }

    fn clear(&mut self, begin: f64) {
        self.times[0] = begin;
        self.len = 1;
    }

    /// Inserts instants that are not there yet and not before the first one.
    fn add(&mut self, times: &[f64]) {
        for &t in times {
            let i = self.times[..self.len].partition_point(|&x| x < t - 1e-9);
            if i > 0
                && self.len < self.times.len()
                && !self.times[..self.len].get(i).is_some_and(|x| x - t < 1e-9)
            {
                self.times.copy_within(i..self.len, i + 1);
                self.times[i] = t;
                self.len += 1;
            }
        }
    }

    fn as_slice(&self) -> &[f64] {
        &self.times[..self.len]
    }

    fn windows(&self) -> std::slice::Windows<'_, f64> {
        self.as_slice().windows(2)
    }
}
