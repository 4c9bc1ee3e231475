//! One boundary value problem of a plan: zero-moment point reference, kinks, shapes of its modification (thesis 4.6.4,
//! (4.49)), and how far the modified zero-moment point stays inside the support polygons.

use crate::boundary::EndConditions;
use crate::com::pieces;
use crate::marks::Marks;
use crate::origin::PlanOrigin;
use crate::sole::{Hull, Sole};
use crate::steps::Stride;
use crate::walking_model::WalkingModel;
use crate::zmp::{Trapezoid, ZmpProblem};
use config::gait;
use messages::GaitState;

/// Pieces of the centre of gravity that a plan has room for.
const COM_PIECES: usize = 96;

/// Shares of what is left of a single support in which a modification rises and falls.
const RUNNING: [f64; 2] = [0.1, 0.2];

/// Steps of a plan, split into the two problems that bring it to rest.
#[derive(Clone, Copy)]
pub(crate) struct Horizon<'a> {
    pub(crate) from: &'a PlanOrigin,
    pub(crate) state: GaitState,
    pub(crate) strides: &'a [Stride],
    /// Steps of the head, which ends in the periodic solution; the tail has the others.
    pub(crate) head: usize,
    /// \[s\] End of the plan, at rest.
    pub(crate) end: f64,
}

impl Horizon<'_> {
    pub(crate) fn last(&self) -> &Stride {
        &self.strides[self.strides.len() - 1]
    }

    /// Double support in which the robot comes to rest.
    fn settling(&self) -> Trapezoid {
        standing_shape(self.last().end, self.end)
    }
}

/// A boundary value problem over some steps.
pub(crate) struct WalkSegment<'a> {
    pub(crate) strides: &'a [Stride],
    pub(crate) reference: ZmpProblem,
    pub(crate) marks: Marks,
    pub(crate) shapes: [Trapezoid; 2],
}

impl<'a> WalkSegment<'a> {
    /// The head: from the present zero-moment point to `to` \[m\], that of the periodic solution.
    pub(crate) fn head(
        step: &gait::StepSettings,
        shrunk: &[Sole; 2],
        horizon: &Horizon<'a>,
        to: [f64; 2],
    ) -> Self {
        let strides = &horizon.strides[..2];
        let mut reference = begin(horizon.from, 0.0, horizon.from.zmp, true);
        hold(&mut reference, shrunk, &strides[0], true);
        hold(&mut reference, shrunk, &strides[1], false);
        reference.fix(strides[1].end, to);
        let first = first_shape(step, horizon, &strides[0]);
        let mut marks = Marks::from(0.0);
        mark(&mut marks, step, strides);
        marks.add(&first.corners());
        mark_early(&mut marks, horizon.from);
        Self { strides, reference, marks, shapes: [first, shape(step, &strides[1])] }
    }

    /// The tail: from `from` \[m\] to rest at `goal` \[m\].
    pub(crate) fn tail(
        step: &gait::StepSettings,
        shrunk: &[Sole; 2],
        horizon: &Horizon<'a>,
        from: [f64; 2],
        goal: [f64; 2],
    ) -> Self {
        let whole = horizon.head == 0; // the plan begins with it
        let strides = &horizon.strides[horizon.head..];
        let start = strides[0].begin.max(0.0);
        let mut reference = begin(horizon.from, start, from, whole);
        for s in strides {
            hold(&mut reference, shrunk, s, true);
        }
        reference.fix(horizon.end, goal);
        // Only a plan's own first step can be one out of standing, or running.
        let first = if whole { first_shape(step, horizon, &strides[0]) } else { shape(step, &strides[0]) };
        let settling = horizon.settling();
        let mut marks = Marks::from(start);
        mark(&mut marks, step, strides);
        if whole {
            mark_early(&mut marks, horizon.from);
        }
        marks.add(&settling.corners());
        marks.add(&first.corners());
        Self { strides, reference, marks, shapes: [first, settling] }
    }

    /// The modified zero-moment point (4.49).
    pub(crate) fn zmp(&self, t: f64, ends: &EndConditions) -> [f64; 2] {
        let p = self.reference.at(t);
        let s = self.shapes.map(|s| s.at(t));
        [0, 1].map(|d| p[d] + ends.gamma[0][d] * s[0] + ends.gamma[1][d] * s[1])
    }

    /// Least distance of the modified zero-moment point from the edge of the support polygon. It moves in straight
    /// lines between marks, and polygons are convex and change at marks only: no other instant can be worse.
    pub(crate) fn least_margin(&self, soles: &[Sole; 2], ends: &EndConditions) -> f64 {
        let strides = self.strides;
        let mut margin = f64::INFINITY;
        let mut both: Option<(usize, Hull)> = None;
        for &t in self.marks.as_slice() {
            let p = self.zmp(t, ends);
            let k = strides.iter().position(|s| t <= s.end + 1e-9).unwrap_or(strides.len());
            let here = match strides.get(k) {
                Some(s) if t >= s.lift - 1e-9 => soles[s.stance].margin(&s.foothold, p),
                _ => {
                    // One hull for all marks of a double support.
                    if both.as_ref().is_none_or(|b| b.0 != k) {
                        both = Some((k, hull(soles, strides, k)));
                    }
                    both.as_ref().map_or(f64::NAN, |b| b.1.margin(p))
                }
            };
            // Not `min`, which forgets a NaN.
            margin = if here >= margin { margin } else { here };
        }
        margin
    }
}

/// \[s\] Knot spacings of head and tail with which the plan's centre of gravity has room for all pieces.
pub(crate) fn knot_spacing(model: &WalkingModel, horizon: &Horizon<'_>) -> [f64; 2] {
    let Horizon { strides, head, .. } = *horizon;
    let count =
        |marks: &Marks, spacing: f64| marks.windows().map(|w| pieces(w[1] - w[0], spacing)).sum::<usize>();
    let mut first = Marks::from(0.0);
    mark(&mut first, &model.step, &strides[..head]);
    first.add(&standing_shape(0.0, strides[0].lift).corners());
    if horizon.from.swinging().is_some() {
        first.add(&running_shape(strides[0].end).corners());
    }
    let mut rest = Marks::from(strides[head].begin.max(0.0));
    mark(&mut rest, &model.step, &strides[head..]);
    rest.add(&horizon.settling().corners());
    // The tail is mostly replaced before it is walked: it becomes coarse first, down to a third.
    let (mut spacing, mut tail_spacing) = (model.model.spacing, model.model.spacing);
    loop {
        let of_head = if head > 0 { count(&first, spacing) } else { 0 };
        if of_head + count(&rest, tail_spacing) <= COM_PIECES || tail_spacing > 10.0 {
            return [spacing, tail_spacing];
        }
        tail_spacing *= 1.1;
        if tail_spacing > 3.0 * spacing {
            spacing *= 1.1;
        }
    }
}

/// Shape of a modification in a double support between `begin` and `end` \[s\] in which both feet stand.
pub(crate) fn standing_shape(begin: f64, end: f64) -> Trapezoid {
    let third = (end - begin) / 3.0;
    Trapezoid { rise: (begin, begin + third), fall: (end - third, end) }
}

/// Shape of a modification during a step: from its double support to its landing.
fn shape(step: &gait::StepSettings, s: &Stride) -> Trapezoid {
    Trapezoid { rise: (s.begin, s.lift), fall: (s.swing(step).lowering(), s.end) }
}

/// Shape during the first step; one out of standing modifies its double support only, one that is running what is left
/// of it.
fn first_shape(step: &gait::StepSettings, horizon: &Horizon<'_>, s: &Stride) -> Trapezoid {
    if horizon.from.swinging().is_some() {
        return running_shape(s.end);
    }
    if horizon.state == GaitState::Starting { standing_shape(0.0, s.lift) } else { shape(step, s) }
}

/// Shape of a modification in the rest of a single support, until `end` \[s\].
fn running_shape(end: f64) -> Trapezoid {
    let [rise, fall] = RUNNING.map(|share| share * end);
    Trapezoid { rise: (0.0, rise), fall: (end - fall, end) }
}

/// A reference that begins at `t` \[s\] in `p` \[m\]. After an early contact, in the first segment, it stays where it would
/// have been until the step would have ended.
fn begin(from: &PlanOrigin, t: f64, p: [f64; 2], first: bool) -> ZmpProblem {
    let mut reference = ZmpProblem::new();
    reference.fix(t, p);
    if let Some((t, p)) = from.early.filter(|_| first) {
        reference.fix(t, p);
    }
    reference
}

/// The stance foot holds the zero-moment point at the begin of the single support, or at both ends.
fn hold(reference: &mut ZmpProblem, shrunk: &[Sole; 2], s: &Stride, both: bool) {
    let sole = &shrunk[s.stance].between(&s.foothold, [&s.takeoff, &s.landing]);
    // A step that is running holds it at its end only.
    if s.lift > 0.0 {
        reference.hold(s.lift, sole, &s.foothold);
    }
    if both {
        reference.hold(s.end, sole, &s.foothold);
    }
}

fn mark(marks: &mut Marks, step: &gait::StepSettings, strides: &[Stride]) {
    for s in strides {
        marks.add(&[s.begin]);
        marks.add(&s.swing(step).marks());
    }
}

fn mark_early(marks: &mut Marks, from: &PlanOrigin) {
    marks.add(from.early.as_ref().map_or(&[], |e| std::slice::from_ref(&e.0)));
}

/// Support polygon of the double support before step `k`, or after the last one.
fn hull(soles: &[Sole; 2], strides: &[Stride], k: usize) -> Hull {
    let (s, other) = match strides.get(k) {
        Some(s) => (s, s.takeoff),
        None => (&strides[k - 1], strides[k - 1].landing),
    };
    Hull::of((&soles[s.stance], &s.foothold), (&soles[1 - s.stance], &other))
}
