//! Balance of a plan: height of the body, zero-moment point and centre of gravity (thesis 4.6), from three boundary value
//! problems.
//!
//! The *periodic* one, two steps with the parameters of step 1, gives the state in which step 2 begins (4.31). The *head*,
//! steps 0 and 1, leads there from where the robot is (4.32). The *tail* leads from there to rest, so that a plan that is
//! never replaced ends standing. A stopping plan is a tail alone.

use crate::boundary::{EndConditions, PlanarState};
use crate::com::{Forcing, GroundDemand, GroundPath, HeightPath, ThreeMassModel};
use crate::feet::{self, FootPath, Swing};
use crate::marks::Marks;
use crate::segment::{Horizon, WalkSegment, knot_spacing};
use crate::sole::Sole;
use crate::steps::{Heights, Stride, next_foothold, next_width, nu};
use crate::verdict::PlanVerdict;
use crate::walking_model::WalkingModel;
use crate::zmp::{Trapezoid, ZmpProblem};
use curves::{Path, Polyline, Sample};

/// Share of a step down by which the body is lowered when the foot lands: the ankle left behind bends no farther, and the
/// leg in front is just long enough.
const DESCENT: f64 = 0.35;

/// Planner of the centre of gravity and the zero-moment point.
#[derive(Clone)]
pub(crate) struct Balance {
    /// Soles that the reference keeps to: drawn in by the margin of the gait.
    shrunk: [Sole; 2],
    com: ThreeMassModel,
    /// Scratch: feet of the periodic problem.
    periodic_feet: Box<[FootPath; 2]>,
}

/// Balance that a plan has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balanced {
    pub(crate) verdict: PlanVerdict,
    /// \[m\] Least distance of the modified zero-moment point from the edge of the support polygon.
    pub(crate) margin: f64,
    /// Only the divergent component of the periodic solution is met (thesis 4.6.2).
    pub(crate) divergent: bool,
}

impl Balanced {
    fn add(&mut self, verdict: PlanVerdict) {
        self.verdict = self.verdict.and(verdict);
    }
}

/// Condition at the end of a boundary value problem.
#[derive(Clone, Copy, PartialEq)]
enum Meet {
    /// Position and velocity (4.32).
    State,
    /// The same or, where that leaves the support, the divergent component.
    StateOrDivergent,
}

/// Motions that the centre of gravity must follow.
#[derive(Clone, Copy)]
struct GivenMotion<'a> {
    feet: &'a [FootPath; 2],
    height: &'a HeightPath,
    ground: &'a GroundPath,
}

/// Start of the periodic solution.
struct PeriodicStart {
    state: PlanarState,
    zmp: [f64; 2],
    verdict: PlanVerdict,
}

/// Heights of the body mass point: over the steps of the plan, and on level ground.
struct BodyHeights {
    walking: HeightPath,
    level: HeightPath,
}

impl Balance {
    pub(crate) fn new(model: &WalkingModel) -> Self {
        Self {
            shrunk: model.soles.map(|s| s.shrunk(model.model.zmp_margin)),
            com: ThreeMassModel::new(&model.model),
            periodic_feet: Box::new([FootPath::resting(0.0, [0.0; 4]); 2]),
        }
    }

    /// Writes centre of gravity and zero-moment point for the `feet` of a plan on the `ground`.
    pub(crate) fn lay<const C: usize, const Z: usize>(
        &mut self,
        model: &WalkingModel,
        horizon: &Horizon<'_>,
        (feet, ground): (&[FootPath; 2], &GroundPath),
        (com, zmp): (&mut Path<3, C>, &mut Polyline<2, Z>),
    ) -> Balanced {
        let (from, step) = (horizon.from, &model.step);
        // What both problems share: the height of the body, and knots for which the plan has room.
        let heights = self.heights(model, horizon, feet);
        let given = GivenMotion { feet, height: &heights.walking, ground };
        let [spacing, tail_spacing] = knot_spacing(model, horizon);
        let mut balanced = Balanced { verdict: PlanVerdict::Sound, margin: f64::INFINITY, divergent: false };
        com.restart(0.0, from.body.position);
        let mut now = PlanarState::of(&self.com.body(&from.body, feet, 0.0));
        let mut p = from.zmp;

        // Head: into the periodic solution of the steps that are wanted.
        if horizon.head > 0 {
            let (s, stance) = (&horizon.strides[1], horizon.strides[0].stance);
            let target = self.periodic(model, s, stance, &heights.level, spacing);
            balanced.add(target.verdict);
            let mut head = WalkSegment::head(step, &self.shrunk, horizon, target.zmp);
            balanced.add(head.reference.solve());
            let states = [&now, &target.state];
            let ends =
                self.connect(model, &head, states, Meet::StateOrDivergent, spacing, &given, &mut balanced);
            now = self.write(model, &head, &ends, com, zmp, &mut balanced);
            p = target.zmp;
        }

        // Tail: to rest between the feet.
        let last = horizon.last();
        let mut at = [last.foothold; 2];
        at[1 - last.stance] = last.landing;
        let goal = model.standing_point(&at);
        let rest = self.com.body(&Sample::rest([goal[0], goal[1], 0.0]), feet, horizon.end);
        let mut tail = WalkSegment::tail(step, &self.shrunk, horizon, p, goal);
        balanced.add(tail.reference.solve());
        let states = [&now, &PlanarState::of(&rest)];
        let ends = self.connect(model, &tail, states, Meet::State, tail_spacing, &given, &mut balanced);
        self.write(model, &tail, &ends, com, zmp, &mut balanced);
        balanced
    }

    /// Height of the body: from where it is to where it is when the robot stands, within the first step, and from then
    /// on with the mean height of the feet.
    fn heights(&self, model: &WalkingModel, horizon: &Horizon<'_>, feet: &[FootPath; 2]) -> BodyHeights {
        let from = horizon.from;
        let axis = |s: Sample<3>| Sample {
            position: [s.position[2]],
            velocity: [s.velocity[2]],
            acceleration: [s.acceleration[2]],
        };
        let first = axis(self.com.body(&from.body, feet, 0.0));
        let mean = 0.5 * (from.heights[0] + from.heights[1]);
        let standing = Sample::rest([0.0, 0.0, model.model.com_height + mean]);
        let standing = self.com.body(&standing, feet, 0.0).position[2] - mean;
        let mut walking = HeightPath::resting(0.0, first.position);
        let mut last = first;
        for s in horizon.strides {
            let (from, to) = (s.heights.foothold, s.heights.landing);
            let share = if to < from { DESCENT } else { 0.5 };
            let next = Sample::rest([standing + from + share * (to - from)]);
            walking.push(&last, &next, s.end);
            last = next;
        }
        BodyHeights { walking, level: HeightPath::resting(0.0, [standing]) }
    }

    /// Ends and amplitudes with which the centre of gravity leads over the segment from one state to the other.
    #[expect(
        clippy::too_many_arguments,
        reason = "a problem has two ends, a condition, and motions that are given"
    )]
    fn connect(
        &mut self,
        model: &WalkingModel,
        segment: &WalkSegment<'_>,
        [begin, end]: [&PlanarState; 2],
        meet: Meet,
        spacing: f64,
        given: &GivenMotion<'_>,
        balanced: &mut Balanced,
    ) -> EndConditions {
        let GivenMotion { feet, height, ground } = *given;
        let forcing = Forcing { feet, height, ground, zmp: &segment.reference, shapes: segment.shapes };
        balanced.add(self.com.solve(&forcing, segment.marks.as_slice(), spacing));
        // Two amplitudes per axis, and position and velocity at two ends.
        let slopes = self.com.ends();
        let mut ends = EndConditions { begin: begin.r, end: end.r, gamma: slopes.amplitudes(begin, end) };
        let mut margin = segment.least_margin(&model.soles, &ends);
        // Where the full state would leave the support, what converges by itself need not be met (thesis 4.6.2).
        if meet == Meet::StateOrDivergent && !(margin >= 0.0) {
            let divergent = slopes.divergent_ends(begin, end);
            let wider = segment.least_margin(&model.soles, &divergent);
            if wider > margin {
                (ends, margin) = (divergent, wider);
                balanced.divergent = true;
            }
        }
        balanced.margin = balanced.margin.min(margin);
        if margin.is_nan() {
            balanced.add(PlanVerdict::NotFinite);
        } else if margin < 0.0 {
            balanced.add(PlanVerdict::LeavesSupport);
        }
        ends
    }

    /// Appends the centre of gravity and the zero-moment point of the segment that was connected last. Returns the state
    /// in which it ends.
    fn write<const C: usize, const Z: usize>(
        &self,
        model: &WalkingModel,
        segment: &WalkSegment<'_>,
        ends: &EndConditions,
        com: &mut Path<3, C>,
        zmp: &mut Polyline<2, Z>,
        balanced: &mut Balanced,
    ) -> PlanarState {
        for &t in segment.marks.as_slice() {
            zmp.push(t, segment.zmp(t, ends));
        }
        balanced.add(bearable(&self.com.write(ends, com), model.model.friction));
        self.com.end(ends)
    }

    /// State of the body and zero-moment point at the start of the periodic solution (4.31) after step `s`; `stance`
    /// carries its first step.
    fn periodic(
        &mut self,
        model: &WalkingModel,
        s: &Stride,
        stance: usize,
        height: &HeightPath,
        spacing: f64,
    ) -> PeriodicStart {
        // Footholds of two more steps like `s`, and their times.
        let (step, shrunk) = (&model.step, &self.shrunk);
        let (f1, f2) = (s.foothold, s.landing);
        let nu = nu(stance);
        let sole = model.soles[stance];
        let w_n = next_width(&s.parameters, s.width, nu, step, &sole);
        let f3 = f2.compose(&next_foothold(&s.parameters, s.width, w_n, nu, &sole));
        let f4 = f3.compose(&f1.relative(&f2)); // errata 2.9: the second step repeats the one before
        let duration = s.end_cycle as f64 * model.cycle_s - s.begin;
        let support = s.lift - s.begin;
        let t = [s.end, s.end + duration, s.end + 2.0 * duration];
        let swings = [0, 1].map(|k| Swing::new(t[k] + support, t[k + 1], step));

        // Feet on level ground, whatever the steps of the plan climb.
        let paths = &mut self.periodic_feet;
        let heights = Heights { lift: step.swing_height, ..Heights::default() };
        feet::stand(&mut paths[stance], t[0], &f2, 0.0);
        feet::stand(&mut paths[1 - stance], t[0], &f1, 0.0);
        feet::swing(&mut paths[1 - stance], &swings[0], &f1, &f3, &heights);
        feet::swing(&mut paths[stance], &swings[1], &f2, &f4, &heights);

        // Reference without modification, whose end is its start, moved on by two steps.
        let mut reference = ZmpProblem::new();
        let first = shrunk[1 - stance].between(&f1, [&f2, &f2]);
        let second = shrunk[stance].between(&f2, [&f1, &f3]);
        let third = shrunk[1 - stance].between(&f3, [&f2, &f4]);
        reference.hold(t[0], &first, &f1);
        reference.hold(swings[0].lift, &second, &f2);
        reference.hold(t[1], &second, &f2);
        reference.hold(swings[1].lift, &third, &f3);
        reference.fix(t[2], [0.0; 2]);
        let found = reference.solve_periodic(&f1, &f3);
        let mut marks = Marks::from(t[0]);
        marks.add(&swings[0].marks());
        marks.add(&swings[1].marks());
        let none = Trapezoid { rise: (-2.0, -1.9), fall: (-1.1, -1.0) };
        let forcing = Forcing {
            feet: &self.periodic_feet,
            height,
            ground: &GroundPath::empty(),
            zmp: &reference,
            shapes: [none, none],
        };
        let verdict = found.and(self.com.solve(&forcing, marks.as_slice(), spacing));
        let state = self.com.ends().periodic_state(&f1, &f3);
        PeriodicStart { state, zmp: reference.nodes()[0].p, verdict }
    }
}

/// Can the ground do what a motion asks of it?
fn bearable(ground: &GroundDemand, friction: f64) -> PlanVerdict {
    if ground.least_force.is_nan() || ground.friction.is_nan() {
        PlanVerdict::NotFinite
    } else if ground.least_force <= 0.0 {
        PlanVerdict::Falling
    } else if ground.friction > friction {
        PlanVerdict::Slips
    } else {
        PlanVerdict::Sound
    }
}
