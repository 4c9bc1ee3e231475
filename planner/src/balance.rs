//! The boundary value problems of a plan: ZMP reference and centre of gravity of head, tail and periodic gait
//! (thesis 4.6).

use crate::collocation::{MAX_KNOTS, State};
use crate::com::{Drive, pieces};
use crate::feet::{self, Swing};
use crate::marks::Marks;
use crate::sole::double_support_margin;
use crate::steps::{Stride, next_foothold, next_width, nu};
use crate::walk::{Builder, Origin, rest_shape};
use crate::zmp::Shape;
use curves::Sample;
use messages::{GaitState, Plan};

impl Builder {
    /// The three boundary value problems; returns the least margin of the modified zero-moment point.
    pub(crate) fn lay_com(
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
