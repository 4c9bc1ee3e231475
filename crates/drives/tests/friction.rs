//! Friction against its own definition, the second law, and where it has no answer (F5, F6, F12 to F14 of the failure
//! studies).

use drives::fit::CubicFriction;
use drives::{Friction, HarmonicFriction, NoLoadTorque, ScrewFriction, Sliding};
use proptest::prelude::*;

/// Table C.1.
const TABLE_C1: [HarmonicFriction; 6] = [
    HarmonicFriction { starting: 7.75e-3, load: 0.0, viscous: 6.63e-6, coupled: 6.59e-4 },
    HarmonicFriction { starting: 1.21e-2, load: 0.0, viscous: 1.04e-5, coupled: 6.59e-4 },
    HarmonicFriction { starting: 3.72e-2, load: 0.0, viscous: 3.20e-5, coupled: 6.59e-4 },
    HarmonicFriction { starting: 6.20e-2, load: 0.0, viscous: 5.33e-5, coupled: 6.58e-4 },
    HarmonicFriction { starting: 1.04e-1, load: 0.0, viscous: 8.94e-5, coupled: 6.58e-4 },
    HarmonicFriction { starting: 2.46e-1, load: 5.49e-3, viscous: 1.52e-4, coupled: 6.21e-4 },
];

fn gears() -> impl Strategy<Value = HarmonicFriction> {
    (0.0..0.5, 0.0..0.9, 0.0..1e-3, 0.0..1e-3)
        .prop_map(|(starting, load, viscous, coupled)| HarmonicFriction { starting, load, viscous, coupled })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// (2.63) and (2.64) hold for what comes out; and friction never drives.
    #[test]
    fn load_torque_solves_its_equation(gear in gears(), w in -2000.0..2000.0, motor in -10.0..10.0, smooth in 0.0..5.0) {
        match gear.load_torque(w, motor, smooth) {
            Ok(load) => {
                let friction = gear.torque(w, load, smooth);
                prop_assert!((motor + friction - load).abs() < 1e-11 * (1.0 + load.abs()));
                prop_assert!(friction * w <= 0.0);
            }
            Err(NoLoadTorque { share }) => prop_assert!(share.abs() >= 1.0),
        }
    }

    /// F14: no drive of any kind gives energy, within the catalogue and beyond.
    #[test]
    fn passive(gear in gears(), w in -3000.0..3000.0, motor in -100.0..100.0, smooth in 0.0..5.0) {
        let screw = ScrewFriction { direct: 0.86, indirect: 0.858 };
        for friction in [Friction::Free, Friction::Harmonic(gear), Friction::Screw(screw)] {
            if let Ok(torque) = friction.torque(w, motor, smooth) {
                prop_assert!(torque * w <= 0.0);
            }
        }
    }

    /// A screw realises its efficiencies: load over motor torque when it drives, the inverse when it is driven.
    #[test]
    fn efficiency_of_screws(w in 1e-3..1000.0, motor in 1e-3..10.0, direct in 0.1..1.0, indirect in 0.1..1.0) {
        let screw = ScrewFriction { direct, indirect };
        let load = |w: f64, motor: f64| motor + screw.torque(w, motor, 0.0);
        prop_assert!((load(w, motor) / motor - direct).abs() < 1e-12);
        prop_assert!((load(-w, -motor) / -motor - direct).abs() < 1e-12);
        prop_assert!((-motor / load(w, -motor) - indirect).abs() < 1e-12);
    }

    /// While it slides, the law of dry and viscous friction is the friction torque.
    #[test]
    fn sliding_is_the_same_law(gear in gears(), w in -1000.0..1000.0, motor in -10.0..10.0) {
        let screw = ScrewFriction { direct: 0.86, indirect: 0.858 };
        for friction in [Friction::Harmonic(gear), Friction::Screw(screw)] {
            if let (Ok(torque), Ok(law)) = (friction.torque(w, motor, 0.0), friction.sliding(w, motor)) {
                let again = -w.signum() * law.dry - law.viscous * w;
                prop_assert!((torque - again).abs() < 1e-10 * (1.0 + torque.abs()));
            }
        }
    }

    #[test]
    fn never_nan(gear in gears(), w in any::<f64>(), motor in -1e6..1e6) {
        let load = gear.load_torque(w, motor, 1.0);
        prop_assert!(load.map_or(true, f64::is_finite));
    }
}

/// F12: the amplification of a load that is driven, 1/(1 - c), and the speed at which it ends.
#[test]
fn near_the_singularity() {
    let gear = HarmonicFriction { starting: 0.0, load: 0.0, viscous: 0.0, coupled: 1e-3 };
    assert!((gear.load_torque(990.0, -1.0, 0.0).unwrap() + 100.0).abs() < 1e-9);
    assert!((gear.load_torque(990.0, 1.0, 0.0).unwrap() - 1.0 / 1.99).abs() < 1e-12);
    assert_eq!(gear.load_torque(1000.0, 1.0, 0.0), Err(NoLoadTorque { share: 1.0 }));
    assert_eq!(gear.load_torque(-1600.0, 1.0, 0.0), Err(NoLoadTorque { share: -1.6 }));
    let limits = TABLE_C1.map(|gear| Friction::Harmonic(gear).speed_limit());
    let wanted = [1517.5, 1517.5, 1517.5, 1519.8, 1519.8, 1601.5];
    for ((gear, limit), wanted) in TABLE_C1.iter().zip(limits).zip(wanted) {
        assert!((limit - wanted).abs() < 0.05, "{limit} rad/s");
        assert!(gear.load_torque(limit * (1.0 - 1e-9), 1.0, 0.0).is_ok());
        assert!(gear.load_torque(limit * (1.0 + 1e-9), 1.0, 0.0).is_err());
    }
    let said = NoLoadTorque { share: 1.6 }.to_string();
    assert!(said.contains("1.600") && said.contains("speed") | said.contains("faster"), "{said}");
}

/// F13: why the cases are studied and the equation is not iterated: T <- A - c |T| takes ln tol/ln c rounds for A > 0 and
/// never ends beyond 1.
#[test]
fn fixed_point_iteration_is_slow_or_endless() {
    let rounds = |c: f64| {
        let (mut t, exact) = (0.0_f64, 1.0 / (1.0 + c));
        (1..10_000).find(|_| {
            t = 1.0 - c * t.abs();
            (t - exact).abs() <= 1e-12 * exact
        })
    };
    for (c, wanted) in [(0.24, 20), (0.5, 40), (0.9, 263), (0.99, 2750)] {
        assert_eq!(rounds(c), Some(wanted), "c = {c}");
    }
    assert_eq!(rounds(1.01), None);
}

/// F14: with g < 0, as least squares gave it, (2.60) drives the motor beyond the speeds it was fitted to.
#[test]
fn the_cubic_model_can_give_energy() {
    let gear = CubicFriction { starting: 0.1, load: 0.02, viscous: 2e-4, cubic: -1e-10 };
    let inside = 3500.0 * std::f64::consts::TAU / 60.0;
    assert!(gear.torque(inside, 0.7) * inside < 0.0 && gear.efficiency(inside, 0.7) < 1.0);
    let beyond = 2000.0;
    assert!(gear.torque(beyond, 0.7) * beyond > 0.0 && gear.efficiency(beyond, 0.7) > 1.0);
}

/// F6: a rotor under less than its starting torque, with steps of 1 ms. The sign chatters with an amplitude up to
/// h T_0/J, the implicit step rests exactly.
#[test]
fn implicit_step_rests() {
    let gear = HarmonicFriction { starting: 0.1, load: 0.0, viscous: 1e-5, coupled: 0.0 };
    let friction = Friction::Harmonic(gear);
    let (mobility, motor) = (1e-3 / 3e-4, 0.06);
    let (mut sign, mut implicit, mut chatter) = (0.5, 0.5, 0.0_f64);
    for i in 0..10_000 {
        sign += mobility * (motor + friction.torque(sign, motor, 0.0).unwrap());
        let law = friction.sliding(implicit, motor).unwrap();
        implicit = law.speed_after(implicit + mobility * motor, mobility);
        if i > 100 {
            assert_eq!(implicit, 0.0);
            chatter = chatter.max(sign.abs());
        }
    }
    let most = mobility * (gear.starting + motor);
    assert!(chatter > 0.1 * most && chatter < 1.01 * most, "chatter {chatter} rad/s, predicted up to {most}");
}

/// Above the starting torque the implicit step ends at the speed of balance, (T - T_0)/b.
#[test]
fn implicit_step_slides() {
    let law = Sliding { dry: 0.1, viscous: 1e-3 };
    let (mobility, motor, mut speed) = (1e-3 / 3e-4, -0.3, 0.0);
    for _ in 0..20_000 {
        speed = law.speed_after(speed + mobility * motor, mobility);
    }
    assert!((speed + 200.0).abs() < 1e-9, "{speed}");
}

/// The smooth sign: no jump at rest, and the sharp law from ω_eps on.
#[test]
fn smooth_sign() {
    for friction in TABLE_C1.map(Friction::Harmonic) {
        let at = |w: f64| friction.torque(w, 0.5, 1.0).unwrap();
        assert!(at(0.0) == 0.0 && at(1e-9).abs() < 1e-8);
        for w in [-20.0, -1.0, 1.0, 20.0] {
            assert_eq!(at(w), friction.torque(w, 0.5, 0.0).unwrap());
        }
    }
}
