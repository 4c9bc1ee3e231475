//! Steps of thesis 6.1.2, each with its rule as printed and as corrected (errata 3), and a placement by model.
//!
//! The unit of the printed gains cannot be what stands there: 45 V s/rad at the motor is a bandwidth of 10^5 rad/s. The step
//! response printed beside them belongs to 386 rad/s (errata 3, 2.9), which gives the unit of K_p; K_I/K_p has none.

use std::f64::consts::TAU;

use ::drives::{CascadeOutput, CascadePi, Sampling};

use crate::Error;
use crate::joint_bench::ServoBench;

use super::measures::Measures;
use super::{Trial, trial};

/// K_p \[V s/rad\], K_I \[V/rad\] that 6.1.2 ends with.
pub(super) const PRINTED: [f64; 2] = [45.0, 6800.0];
/// \[rad/s\] Bandwidth for a printed K_p of 1.
const UNIT: f64 = 386.0 / PRINTED[0];
/// Gains of the first trial, and factor from one to the next.
const FIRST: [f64; 2] = [1.0, 3.0];
const RAISE: f64 = 1.5;
/// Factor of K_I from trial to trial.
const INTEGRAL: f64 = 1.3;
/// Share by which gains are changed in the end.
const FINE: f64 = 1.1;
/// Overshoots that end the first climb and the second, and the one that is printed of the best gains.
const CLIMBED: f64 = 0.2;
const OVERSHOT: f64 = 0.3;
const BEST: f64 = 0.25;
/// Trials after which a climb is given up.
const TRIALS: i32 = 40;

/// Trials of the procedure, by step, and the gains that it ends with.
pub(super) struct Steps {
    pub(super) trials: Vec<Vec<Trial>>,
    pub(super) position: CascadePi,
}

/// The procedure with a step of the speed of `step` \[rad/s\].
///
/// # Errors
/// As of the bench.
pub(super) fn of_thesis(bench: &ServoBench, step: f64, tell: &dyn Fn(&str)) -> Result<Steps, Error> {
    let law = |[k_p, k_i]: [f64; 2]| CascadePi {
        speed_bandwidth: UNIT * k_p,
        speed_integral: k_i / k_p,
        ..bench.law()
    };
    let attempt = |what: &str, gains: [f64; 2]| {
        let printed = format!("{:.1}, {:.0}", gains[0], gains[1]);
        trial(bench, what, printed, law(gains), step)
    };
    let climb = |what: &str, gains: &dyn Fn(i32) -> [f64; 2], until: f64| {
        let mut trials = Vec::new();
        for n in 0..TRIALS {
            tell(what);
            trials.push((gains(n), attempt(&format!("{what}, trial {}", n + 1), gains(n))?));
            // Overshoot, resonance, or a current that cannot rise with the gains any more.
            let ends = |m: &Measures| m.overshoot >= until || m.oscillates || m.saturates;
            if trials.last().is_some_and(|(_, t)| ends(&t.measures)) {
                break;
            }
        }
        Ok::<_, Error>(trials)
    };
    // Figures 6.3, 6.4: both gains by half of themselves, to 20 % of overshoot.
    let raised = climb("1. raised by 50 %", &|n| FIRST.map(|gain| gain * RAISE.powi(n)), CLIMBED)?;
    let last = raised.last().map_or(FIRST, |(gains, _)| *gains);
    // Figure 6.5: K_p divided by 3 as printed, which 40 to 30 is not, or by 1.333; K_I by 1.3 to 30 %.
    let mut ends = Vec::new();
    for (rule, by) in [("2. K_p / 3 as printed", 3.0), ("2. K_p / 1.333", 4.0 / 3.0)] {
        let k_p = last[0] / by;
        ends.push(climb(rule, &|n| [k_p, INTEGRAL.powi(n + 1) * k_p], OVERSHOT)?);
    }
    let mut best = ends[1].last().map_or(last, |(gains, _)| *gains);
    // Figure 6.6: changes of 10 %, each kept if it rises faster, or overshoots less where that is too much.
    let cost = |t: &Trial| {
        let m = &t.measures;
        let swings = if m.oscillates { f64::INFINITY } else { 1.0 };
        m.rise_s * (1.0 + 20.0 * (m.overshoot - BEST).max(0.0)) * swings
    };
    let mut tuned = attempt("3. changed by 10 %", best)?;
    for _ in 0..TRIALS {
        tell("3. changed by 10 %");
        let [p, i] = best;
        let around = [[p * FINE, i], [p / FINE, i], [p, i * FINE], [p, i / FINE]];
        let tried: Vec<Trial> =
            around.iter().map(|gains| attempt("3. changed by 10 %", *gains)).collect::<Result<_, _>>()?;
        let better = (0..4).min_by(|a, b| cost(&tried[*a]).total_cmp(&cost(&tried[*b])));
        let Some(k) = better.filter(|k| cost(&tried[*k]) < 0.999 * cost(&tuned)) else { break };
        (best, tuned) = (around[k], tried[k].clone());
    }
    let published = attempt("printed, as 386 rad/s", PRINTED)?;
    // Figure 6.7: half of K_I, position gain 0.5/dT (6-3).
    let position = CascadePi {
        speed_integral: 0.5 * best[1] / best[0],
        position_gain: 0.5 / tuned.measures.rise_s,
        ..law(best)
    };
    let literal = trial(bench, "printed, at the motor", "45.0, 6800".into(), literal(bench), step)?;
    let halved = trial(bench, "4. K_I halved, K_x = 0.5/dT", String::new(), position, step)?;
    let few = |trials: Vec<(_, Trial)>| {
        let count = trials.len();
        let shown = |k: usize| k == 0 || k + 4 > count;
        trials.into_iter().enumerate().filter(|(k, _)| shown(*k)).map(|(_, (_, t))| t).collect::<Vec<_>>()
    };
    let mut trials = vec![few(raised)];
    trials.extend(ends.into_iter().map(few));
    trials.push(vec![tuned, published, halved, literal]);
    Ok(Steps { trials, position })
}

/// Printed gains taken for what stands beside them: volts at the motor.
fn literal(bench: &ServoBench) -> CascadePi {
    let motor = &bench.drive.motor;
    CascadePi {
        speed_bandwidth: PRINTED[0] / motor.resistance * motor.torque_constant / bench.inertia(),
        speed_integral: PRINTED[1] / PRINTED[0],
        output: CascadeOutput::Voltage,
        ..bench.law()
    }
}

/// \[rad\] Phase margin of the speed loop, and share of its bandwidth that integral and position gain take.
const MARGIN: f64 = std::f64::consts::FRAC_PI_3;
const SHARE: f64 = 0.2;

/// Gains from a model: the speed loop's phase margin is left by its delays (current loop, hold, difference, filter) and by its
/// integral, with the rotor alone behind the resonance of an elastic gear. A shaft of `speed` \[rad/s\] tells its speed by
/// edges that are half a count old.
pub(super) fn by_model(bench: &ServoBench, speed: f64) -> CascadePi {
    let law = bench.law();
    let period = match bench.drive.control.sampling {
        Sampling::Period(periods) => periods.speed,
        _ => f64::NAN,
    };
    let current = match law.output {
        CascadeOutput::Current(bandwidth) => 1.0 / bandwidth,
        CascadeOutput::Voltage => bench.drive.motor.time_constant(),
    };
    let count = bench.drive.control.resolution.encoder_counts.map_or(0.0, |counts| TAU / f64::from(counts));
    let delay = current + period + law.speed_filter + 0.5 * count / speed;
    let crossing = (std::f64::consts::FRAC_PI_2 - MARGIN - SHARE.atan()) / delay;
    // Gains are counted with rotor and limb; above its resonance an elastic gear leaves the rotor alone.
    let felt =
        if bench.drive.elasticity.is_some() { bench.drive.rotor_inertia / bench.inertia() } else { 1.0 };
    CascadePi {
        speed_bandwidth: crossing * felt,
        speed_integral: SHARE * crossing * felt,
        position_gain: SHARE * crossing * felt,
        ..law
    }
}
