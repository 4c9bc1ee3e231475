//! Motion of a few joints to a target that may move itself: jumps and smooth pursuit (thesis 4.7.2).
//!
//! Both start from position, velocity and acceleration of the present cycle, and are computed anew in every cycle, so
//! that the target may be another one at any time.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | p, v, a | angle, speed, acceleration of a joint, commanded | rad, rad/s, rad/s^2 |
//! | T | time left of a jump | s |
//! | w | cut-off of the low pass of pursuit, damping 1 | rad/s |
//!
//! A jump is a quintic from the present (p, v, a) to the target's (p, v, 0). Where the thesis gives the target's present
//! position as the end, here it is the position that the target will have reached by then.

use curves::quintic;

/// Most joints that move together: pan, tilt, vergence.
pub const AXES: usize = 3;

/// Commanded motion of a joint in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisState {
    /// \[rad\]
    pub p: f64,
    /// \[rad/s\]
    pub v: f64,
    /// \[rad/s^2\]
    pub a: f64,
}

/// Target of a joint at some instant, and its speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Target {
    /// \[rad\]
    pub p: f64,
    /// \[rad/s\]
    pub v: f64,
}

/// AxisLimits of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimits {
    /// \[rad/s\]
    pub speed: f64,
    /// \[rad/s^2\]
    pub acceleration: f64,
}

/// Instants at which a quintic is held against its limits.
const INSTANTS: u32 = 24;
/// Ratio of durations that are tried one after the other, and how many.
const LONGER: (f64, u32) = (1.1, 80);
/// A jump that goes on may pass its limits by this share, because target and joint are never quite where they were
/// foreseen: without it a jump would grow longer in every cycle.
const GRACE: f64 = 1.02;

/// By how much a jump of `time` \[s\] would pass its limits: largest ratio over all joints and instants.
fn excess(from: &[AxisState; AXES], to: &[Target; AXES], time: f64, limits: &AxisLimits) -> f64 {
    let mut most = 0.0f64;
    for (s, target) in from.iter().zip(to) {
        let c = quintic((s.p, s.v, s.a), (target.p + target.v * time, target.v, 0.0), time);
        for i in 1..=INSTANTS {
            let t = time * f64::from(i) / f64::from(INSTANTS);
            let (v, a) = rates(&c, t);
            most = most.max(v.abs() / limits.speed).max(a.abs() / limits.acceleration);
        }
    }
    most
}

fn rates(c: &[f64; 6], t: f64) -> (f64, f64) {
    (
        c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5]))),
        2.0 * c[2] + t * (6.0 * c[3] + t * (12.0 * c[4] + t * 20.0 * c[5])),
    )
}

/// \[s\] Shortest duration from `least` on in which the jump keeps to its limits, by trial; the one that passes them
/// least if there is none, as for a target that runs away.
pub fn duration(from: &[AxisState; AXES], to: &[Target; AXES], least: f64, limits: &AxisLimits) -> f64 {
    if excess(from, to, least, limits) <= GRACE {
        return least;
    }
    // No motion is faster than its fastest instant.
    let way = |(s, t): (&AxisState, &Target)| (t.p - s.p).abs() / (limits.speed + t.v.abs());
    let least = from.iter().zip(to).map(way).fold(least, f64::max);
    let (mut best, mut time) = ((f64::INFINITY, least), least / LONGER.0);
    for _ in 0..LONGER.1 {
        time *= LONGER.0;
        let e = excess(from, to, time, limits);
        if e <= 1.0 {
            return refined(from, to, time, limits);
        }
        if e < best.0 {
            best = (e, time);
        }
    }
    best.1
}

/// `time` keeps to the limits, one step less does not: bisection to a thousandth.
fn refined(from: &[AxisState; AXES], to: &[Target; AXES], time: f64, limits: &AxisLimits) -> f64 {
    let (mut short, mut long) = (time / LONGER.0, time);
    for _ in 0..7 {
        let middle = 0.5 * (short + long);
        if excess(from, to, middle, limits) <= 1.0 { long = middle } else { short = middle }
    }
    long
}

/// Speed and acceleration after `dt` \[s\] of a jump that takes `time` \[s\].
pub fn jump(from: &AxisState, to: &Target, time: f64, dt: f64) -> (f64, f64) {
    let c = quintic((from.p, from.v, from.a), (to.p + to.v * time, to.v, 0.0), time);
    rates(&c, dt)
}

/// Speed and acceleration after `dt` \[s\] of smooth pursuit: low pass of second order with damping 1, which carries the
/// target's speed on and so has no lag behind an even motion; held to its limits. Implicit, so that no step is too long;
/// `to` is the target at the end of the step.
pub(crate) fn pursue(from: &AxisState, to: &Target, w: f64, dt: f64, limits: &AxisLimits) -> (f64, f64) {
    let error = to.p - from.p - 0.5 * dt * from.v;
    let v = (from.v + dt * (w * w * error + 2.0 * w * to.v)) / (1.0 + 2.0 * w * dt + 0.5 * w * w * dt * dt);
    let v = v.clamp(-limits.speed, limits.speed);
    let most = limits.acceleration * dt;
    let v = v.clamp(from.v - most, from.v + most);
    (v, (v - from.v) / dt)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: AxisLimits = AxisLimits { speed: 2.5, acceleration: 20.0 };
    const DT: f64 = 1e-3;

    fn at(p: f64) -> [AxisState; AXES] {
        [AxisState { p, ..AxisState::default() }; AXES]
    }

    fn to(p: f64, v: f64) -> [Target; AXES] {
        [Target { p, v }; AXES]
    }

    /// From rest to rest over D in T the peaks are 15/8 D/T and 10/sqrt(3) D/T^2: closed form of the quintic.
    #[test]
    fn the_shortest_jump_is_that_of_the_closed_form() {
        for d in [0.06, 0.3, 1.0, 3.0] {
            let wanted =
                (15.0 / 8.0 * d / LIMITS.speed).max((10.0 / 3f64.sqrt() * d / LIMITS.acceleration).sqrt());
            let found = duration(&at(0.2), &to(0.2 - d, 0.0), DT, &LIMITS);
            // Accelerations are looked at in 24 instants, which may miss 1 % of the peak.
            assert!((found / wanted - 1.0).abs() < 0.01, "{d}: {found} instead of {wanted}");
        }
    }

    /// Every cycle anew, and still the same curve: the shortest jump is repeated by what remains of it.
    #[test]
    fn computed_anew_in_every_cycle_it_is_one_quintic() {
        let (mut s, target) = (at(0.0), to(1.0, 0.3));
        let total = duration(&s, &target, DT, &LIMITS);
        let whole = quintic((0.0, 0.0, 0.0), (1.0 + 0.3 * total, 0.3, 0.0), total);
        let (mut left, mut t, mut worst) = (total, 0.0, 0.0f64);
        let mut moving = target;
        while left > 1.5 * DT {
            left = duration(&s, &moving, left, &LIMITS);
            let (v, a) = jump(&s[0], &moving[0], left, DT);
            s = [AxisState { p: s[0].p + 0.5 * DT * (s[0].v + v), v, a }; AXES];
            (left, t) = (left - DT, t + DT);
            moving = to(1.0 + 0.3 * t, 0.3);
            worst = worst.max((v - rates(&whole, t).0).abs());
        }
        assert!(worst < 1e-3, "{worst} rad/s beside the curve");
        assert!((t / total - 1.0).abs() < 0.01 && (s[0].p - moving[0].p).abs() < 1e-4);
    }

    #[test]
    fn another_target_on_the_way_is_taken_within_the_limits() {
        let (mut s, mut left, mut peak, mut hardest) = (at(0.0), DT, 0.0f64, 0.0f64);
        for k in 0..3000 {
            let target = to(if k < 200 { 1.2 } else { -0.8 }, 0.0);
            left = duration(&s, &target, left.max(2.0 * DT), &LIMITS);
            let (v, a) = jump(&s[0], &target[0], left, DT);
            (peak, hardest) = (peak.max(v.abs()), hardest.max((v - s[0].v).abs() / DT));
            s = [AxisState { p: s[0].p + 0.5 * DT * (s[0].v + v), v, a }; AXES];
            left -= DT;
        }
        assert!(peak <= GRACE * LIMITS.speed, "{peak} rad/s");
        assert!(hardest <= 1.05 * LIMITS.acceleration, "{hardest} rad/s^2");
        assert!((s[0].p + 0.8).abs() < 1e-4, "{}", s[0].p);
    }

    /// A target that runs away is not reached, and nothing breaks.
    #[test]
    fn a_target_faster_than_the_limit_has_no_duration_within_it() {
        let t = duration(&at(0.0), &to(1.0, 2.0 * LIMITS.speed), DT, &LIMITS);
        assert!(t.is_finite() && excess(&at(0.0), &to(1.0, 2.0 * LIMITS.speed), t, &LIMITS) > 1.0);
    }

    fn pursued(w: f64, dt: f64, target: impl Fn(f64) -> Target) -> AxisState {
        let mut s = AxisState::default();
        for k in 1..=(2.0 / dt) as u32 {
            let (v, a) = pursue(&s, &target(f64::from(k) * dt), w, dt, &LIMITS);
            s = AxisState { p: s.p + 0.5 * dt * (s.v + v), v, a };
        }
        s
    }

    #[test]
    fn pursuit_has_no_lag_behind_an_even_motion_and_little_behind_a_sway() {
        let s = pursued(40.0, DT, |t| Target { p: 0.4 * t, v: 0.4 });
        assert!((s.p - 0.8).abs() < 1e-6 && (s.v - 0.4).abs() < 1e-6, "{s:?}");
        // Closed form: the error of this filter to a sine of f is f^2/(f^2 + w^2) of it.
        let (f, w, sway) = (7.0, 40.0, 0.1);
        let mut worst = 0.0f64;
        let mut s = AxisState::default();
        for k in 1..4000 {
            let t = f64::from(k) * DT;
            let to = Target { p: sway * (f * t).sin(), v: sway * f * (f * t).cos() };
            let (v, a) = pursue(&s, &to, w, DT, &LIMITS);
            s = AxisState { p: s.p + 0.5 * DT * (s.v + v), v, a };
            if t > 1.0 {
                worst = worst.max((s.p - to.p).abs());
            }
        }
        let wanted = sway * f * f / (f * f + w * w);
        assert!((worst / wanted - 1.0).abs() < 0.05, "{worst} instead of {wanted}");
    }

    /// Explicit steps would be unstable from w dt = 2 on.
    #[test]
    fn pursuit_bears_missed_cycles_and_its_limits() {
        let s = pursued(200.0, 0.035, |_| Target { p: 0.5, v: 0.0 });
        assert!((s.p - 0.5).abs() < 1e-3, "{s:?}");
        let (v, _) = pursue(&AxisState::default(), &Target { p: 9.0, v: 9.0 }, 40.0, DT, &LIMITS);
        assert!((v - LIMITS.acceleration * DT).abs() < 1e-12);
        let fast = AxisState { v: 2.5, ..AxisState::default() };
        assert!(pursue(&fast, &Target { p: 9.0, v: 9.0 }, 40.0, DT, &LIMITS).0 <= 2.5);
    }
}
