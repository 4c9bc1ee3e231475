//! The boundary value problems of a plan: ZMP reference and centre of gravity of head, tail and periodic gait
//! (thesis 4.6).

use crate::collocation::{Ends, State};
use crate::com::{Drive, Ground, GroundPath, pieces};
use crate::feet::{self, Swing};
use crate::marks::Marks;
use crate::sole::Hull;
use crate::steps::{Heights, Stride, next_foothold, next_width, nu};
use crate::verdict::Verdict;
use crate::walk::{Builder, Origin, rest_shape};
use crate::zmp::Shape;
use curves::Sample;
use messages::{GaitState, Plan};

/// Pieces of the centre of gravity that a plan has room for.
const COM_PIECES: usize = 96;

/// How a plan keeps its balance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balance {
    /// What is wrong with it.
    pub(crate) verdict: Verdict,
    /// \[m\] Least distance of the modified zero-moment point from the edge of the support polygon.
    pub(crate) margin: f64,
    /// Only the divergent component of the periodic solution is met (thesis 4.6.2).
    pub(crate) divergent: bool,
}

/// What the end of a boundary value problem must meet.
#[derive(Clone, Copy, PartialEq)]
enum Meet {
    /// Position and velocity (4.32).
    State,
    /// The same or, where that leaves the support, the divergent component.
    StateOrDivergent,
}

impl Balance {
    const BEGUN: Self = Self { verdict: Verdict::Sound, margin: f64::INFINITY, divergent: false };

    fn add(&mut self, verdict: Verdict) {
        self.verdict = self.verdict.and(verdict);
    }
}

impl Builder {
    /// The three boundary value problems.
    pub(crate) fn lay_com(
        &mut self,
        from: &Origin,
        state: GaitState,
        strides: &[Stride],
        head: usize,
        end: f64,
        plan: &mut Plan,
    ) -> Balance {
        let mut balance = Balance::BEGUN;
        let (spacing, tail_spacing) = self.spacing(strides, head, end);
        plan.com.restart(0.0, from.com.position);
        let body = self.com.body(&from.com, &plan.feet, 0.0);
        let mut now = State::of(&body);
        let mut p = from.zmp;
        if head > 0 {
            let (target, p_target, verdict) = self.periodic(&strides[1], strides[0].stance, spacing);
            balance.add(verdict);
            self.chain.clear();
            self.chain.fix(0.0, p);
            self.touch_early(from);
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
            self.mark_early(from);
            let meet = Meet::StateOrDivergent;
            now = self.solve([&now, &target], meet, shapes, &strides[..2], spacing, plan, &mut balance);
            p = p_target;
        }
        let tail = &strides[head..];
        let last = &strides[strides.len() - 1];
        let begin = tail[0].begin;
        self.chain.clear();
        self.chain.fix(begin, p);
        if head == 0 {
            self.touch_early(from);
        }
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
        if head == 0 {
            self.mark_early(from);
        }
        self.marks.add(&settle.corners());
        let first = if head == 0 && state == GaitState::Starting {
            rest_shape(0.0, tail[0].lift)
        } else {
            self.shape(&tail[0])
        };
        self.marks.add(&first.corners());
        let shapes = [first, settle];
        self.solve([&now, &target], Meet::State, shapes, tail, tail_spacing, plan, &mut balance);
        balance
    }

    /// After an early contact the zero-moment point stays where it would have been until the step would have ended.
    fn touch_early(&mut self, from: &Origin) {
        if let Some((t, p)) = from.early {
            self.chain.fix(t, p);
        }
    }

    fn mark_early(&mut self, from: &Origin) {
        self.marks.add(from.early.as_ref().map_or(&[], |e| std::slice::from_ref(&e.0)));
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
            if first + count(&self.marks, tail_spacing) <= COM_PIECES || tail_spacing > 10.0 {
                return (spacing, tail_spacing);
            }
            tail_spacing *= 1.1;
            if tail_spacing > 3.0 * spacing {
                spacing *= 1.1;
            }
        }
    }

    fn shape(&self, s: &Stride) -> Shape {
        Shape { rise: (s.begin, s.lift), fall: (s.swing(&self.step).lowering(), s.end) }
    }

    fn mark(&mut self, strides: &[Stride]) {
        for s in strides {
            self.marks.add(&[s.begin]);
            self.marks.add(&s.swing(&self.step).marks());
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

    /// Solves one boundary value problem and appends its centre of gravity and zero-moment point to the plan. Returns
    /// the state in which it ends.
    #[expect(clippy::too_many_arguments, reason = "a problem has two ends, two shapes and a place to go to")]
    fn solve(
        &mut self,
        [begin, end]: [&State; 2],
        meet: Meet,
        shapes: [Shape; 2],
        strides: &[Stride],
        spacing: f64,
        plan: &mut Plan,
        balance: &mut Balance,
    ) -> State {
        balance.add(self.chain.solve());
        let drive = Drive {
            feet: &plan.feet,
            height: &self.height,
            ground: &plan.zmp_height,
            zmp: &self.chain,
            shapes,
        };
        balance.add(self.com.solve(&drive, self.marks.as_slice(), spacing));
        let problem = self.com.problem();
        let mut ends = Ends { begin: begin.r, end: end.r, gamma: problem.amplitudes(begin, end) };
        let mut margin = self.least_margin(strides, &shapes, &ends);
        if meet == Meet::StateOrDivergent && !(margin >= 0.0) {
            let divergent = problem.divergent_ends(begin, end);
            let wider = self.least_margin(strides, &shapes, &divergent);
            if wider > margin {
                (ends, margin) = (divergent, wider);
                balance.divergent = true;
            }
        }
        balance.margin = balance.margin.min(margin);
        if margin.is_nan() {
            balance.add(Verdict::NotFinite);
        } else if margin < 0.0 {
            balance.add(Verdict::LeavesSupport);
        }
        for &t in self.marks.as_slice() {
            plan.zmp.push(t, self.zmp(t, &shapes, &ends));
        }
        balance.add(self.ground(self.com.write(&ends, &mut plan.com)));
        let [r, v, _] = self.com.problem().motion(self.com.problem().n - 1, &ends);
        State { r, v }
    }

    /// Whether the ground can do what a motion asks of it.
    fn ground(&self, ground: Ground) -> Verdict {
        if ground.least_force.is_nan() || ground.friction.is_nan() {
            Verdict::NotFinite
        } else if ground.least_force <= 0.0 {
            Verdict::Falling
        } else if ground.friction > self.model.friction {
            Verdict::Slips
        } else {
            Verdict::Sound
        }
    }

    /// The modified zero-moment point (4.49).
    fn zmp(&self, t: f64, shapes: &[Shape; 2], ends: &Ends) -> [f64; 2] {
        let p = self.chain.at(t);
        let s = shapes.map(|s| s.at(t));
        [0, 1].map(|d| p[d] + ends.gamma[0][d] * s[0] + ends.gamma[1][d] * s[1])
    }

    /// Least distance of the modified zero-moment point from the edge of the support polygon. It moves in straight
    /// lines between marks, and polygons are convex and change at marks only: no other instant can be worse.
    fn least_margin(&self, strides: &[Stride], shapes: &[Shape; 2], ends: &Ends) -> f64 {
        let mut margin = f64::INFINITY;
        let mut both: Option<(usize, Hull)> = None;
        for &t in self.marks.as_slice() {
            let p = self.zmp(t, shapes, ends);
            let k = strides.iter().position(|s| t <= s.end + 1e-9).unwrap_or(strides.len());
            let here = match strides.get(k) {
                Some(s) if t >= s.lift - 1e-9 => self.soles[s.stance].margin(&s.foothold, p),
                _ => {
                    if both.as_ref().is_none_or(|b| b.0 != k) {
                        both = Some((k, self.hull(strides, k)));
                    }
                    both.as_ref().map_or(f64::NAN, |b| b.1.margin(p))
                }
            };
            // Not `min`, which forgets what is not a number.
            margin = if here >= margin { margin } else { here };
        }
        margin
    }

    /// Support polygon of the double support before step `k`, or after the last one.
    fn hull(&self, strides: &[Stride], k: usize) -> Hull {
        let (s, other) = match strides.get(k) {
            Some(s) => (s, s.takeoff),
            None => (&strides[k - 1], strides[k - 1].landing),
        };
        Hull::of((&self.soles[s.stance], &s.foothold), (&self.soles[1 - s.stance], &other))
    }

    /// State of the body and zero-moment point at the start of the periodic solution (4.31) after step `s`; `stance`
    /// carries its first step.
    fn periodic(&mut self, s: &Stride, stance: usize, spacing: f64) -> (State, [f64; 2], Verdict) {
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
        // On level ground, whatever the steps of the plan climb.
        let heights = Heights { lift: self.step.swing_height, ..Heights::default() };
        feet::stand(&mut paths[stance], t[0], &f2, 0.0);
        feet::stand(&mut paths[1 - stance], t[0], &f1, 0.0);
        feet::swing(&mut paths[1 - stance], &swings[0], &f1, &f3, &heights);
        feet::swing(&mut paths[stance], &swings[1], &f2, &f4, &heights);
        self.chain.clear();
        self.chain.hold(t[0], &self.shrunk[1 - stance], &f1);
        self.chain.hold(swings[0].lift, &self.shrunk[stance], &f2);
        self.chain.hold(t[1], &self.shrunk[stance], &f2);
        self.chain.hold(swings[1].lift, &self.shrunk[1 - stance], &f3);
        self.chain.fix(t[2], [0.0; 2]);
        let found = self.chain.solve_periodic(&f1, &f3);
        self.marks.clear(t[0]);
        self.marks.add(&swings[0].marks());
        self.marks.add(&swings[1].marks());
        let none = Shape { rise: (-2.0, -1.9), fall: (-1.1, -1.0) };
        let drive = Drive {
            feet: &self.periodic_feet,
            height: &self.level,
            ground: &GroundPath::empty(),
            zmp: &self.chain,
            shapes: [none, none],
        };
        let found = found.and(self.com.solve(&drive, self.marks.as_slice(), spacing));
        (self.com.problem().periodic_state(&f1, &f3), self.chain.nodes()[0].p, found)
    }
}
