//! Motor equations against their power balance and against many small steps; elasticity against its energy.

use drives::{Elasticity, Motor};
use proptest::prelude::*;

/// A hip motor.
const MOTOR: Motor = Motor { inductance: 0.64e-3, resistance: 0.4, torque_constant: 0.147 };
const GEAR: Elasticity = Elasticity { stiffness: [31e3, 50e3, 57e3], knees: [14.0, 48.0] };

/// \[A\] Mean current over `h` \[s\] at constant voltage and speed, exactly: it gives charge and impulse of the torque.
fn mean_current(current: f64, voltage: f64, speed: f64, h: f64) -> f64 {
    let x = h / MOTOR.time_constant();
    let gone = if x < 1e-4 { x * (0.5 - x / 6.0) } else { 1.0 + (-x).exp_m1() / x };
    current + (MOTOR.steady_current(voltage, speed) - current) * gone
}

proptest! {
    /// The exact step is many small Runge-Kutta steps, and two halves make a whole.
    #[test]
    fn exact_current(i in -50.0..50.0, u in -70.0..70.0, w in -400.0..400.0, h in 1e-6..0.02) {
        let f = |i: f64| MOTOR.current_rate(i, u, w);
        let (n, mut fine) = (400, i);
        let dt = h / f64::from(n);
        for _ in 0..n {
            let k1 = f(fine);
            let k2 = f(fine + dt / 2.0 * k1);
            let k3 = f(fine + dt / 2.0 * k2);
            let k4 = f(fine + dt * k3);
            fine += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        let exact = MOTOR.current_after(i, u, w, h);
        prop_assert!((exact - fine).abs() < 1e-8 * (1.0 + exact.abs()), "{exact} {fine}");
        let halves = MOTOR.current_after(MOTOR.current_after(i, u, w, h / 2.0), u, w, h / 2.0);
        prop_assert!((exact - halves).abs() < 1e-10 * (1.0 + exact.abs()));
    }

    /// Power balance of (2.57) over a step, with charge from the mean current: voltage in, heat, field and shaft out.
    /// Heat is integrated by Gauss's rule.
    #[test]
    fn power_balance(i in -50.0..50.0, u in -70.0..70.0, w in -400.0..400.0, h in 1e-6..4e-3) {
        let mean = mean_current(i, u, w, h);
        let field = |i: f64| 0.5 * MOTOR.inductance * i * i;
        let stored = field(MOTOR.current_after(i, u, w, h)) - field(i);
        let nodes = [(-0.906_179_845_938_664, 0.236_926_885_056_189_1), (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (0.0, 0.568_888_888_888_888_9), (0.538_469_310_105_683_1, 0.478_628_670_499_366_5), (0.906_179_845_938_664, 0.236_926_885_056_189_1)];
        let heat = (0..8).flat_map(|k| nodes.map(|(x, weight)| {
            let i = MOTOR.current_after(i, u, w, h / 8.0 * (f64::from(k) + 0.5 * (1.0 + x)));
            0.5 * weight * h / 8.0 * MOTOR.resistance * i * i
        })).sum::<f64>();
        let shaft = MOTOR.torque(mean) * w * h;
        let scale = u.abs() * 100.0 * h + field(50.0);
        prop_assert!((u * mean * h - heat - stored - shaft).abs() < 1e-10 * scale);
    }

    /// F15: torque is the derivative of the energy, its derivative the tangent, its inverse the torsion; it is odd.
    #[test]
    fn elasticity(torsion in -0.004..0.004) {
        let h = 1e-8;
        let slope = (GEAR.energy(torsion + h) - GEAR.energy(torsion - h)) / (2.0 * h);
        prop_assert!((slope - GEAR.torque(torsion)).abs() < 1e-3);
        let tangent = (GEAR.torque(torsion + h) - GEAR.torque(torsion - h)) / (2.0 * h);
        let bends = [14.0 / 31e3, 14.0 / 31e3 + 34.0 / 50e3].iter().any(|b| (torsion.abs() - b).abs() < h);
        prop_assert!(bends || (tangent - GEAR.tangent(torsion)).abs() < 1e-2 * tangent);
        prop_assert!((GEAR.torsion(GEAR.torque(torsion)) - torsion).abs() < 1e-15);
        prop_assert_eq!(GEAR.torque(-torsion), -GEAR.torque(torsion));
    }
}

/// The exact step does not care how stiff the circuit is; Euler's does: its limit is 2 L/R.
#[test]
fn steps_longer_than_the_time_constant() {
    let tau = MOTOR.time_constant();
    assert!((tau - 1.6e-3).abs() < 1e-15);
    let steady = MOTOR.steady_current(20.0, 30.0);
    assert!((MOTOR.current_after(-40.0, 20.0, 30.0, 100.0 * tau) - steady).abs() < 1e-12);
    let euler = |h: f64| (0..400).fold(0.0, |i, _| i + h * MOTOR.current_rate(i, 20.0, 30.0));
    assert!(
        (euler(1.98 * tau) - steady).abs() < steady.abs()
            && !((euler(2.02 * tau) - steady).abs() < 100.0 * steady.abs())
    );
}

#[test]
fn steady_state() {
    let u = MOTOR.voltage(12.0, 300.0);
    assert!((u - (0.4 * 12.0 + 0.147 * 300.0)).abs() < 1e-12);
    assert!(
        (MOTOR.steady_current(u, 300.0) - 12.0).abs() < 1e-12
            && MOTOR.current_rate(12.0, u, 300.0).abs() < 1e-9
    );
}

/// F15: (2.69) as printed jumps by K_1 T_1/K_0 at T_1; the continuous form does not.
#[test]
fn continuous_at_the_knees() {
    let [k0, k1, _] = GEAR.stiffness;
    let [t1, t2] = GEAR.knees;
    for torque in [t1, t2, -t1, -t2] {
        let torsion = GEAR.torsion(torque);
        let jump = GEAR.torque(torsion * (1.0 + 1e-15)) - GEAR.torque(torsion * (1.0 - 1e-15));
        assert!(jump.abs() < 1e-12, "{jump} N m at {torque}");
    }
    let printed = |torsion: f64| if k0 * torsion < t1 { k0 * torsion } else { t1 + k1 * torsion };
    let jump = printed(t1 / k0 * (1.0 + 1e-12)) - printed(t1 / k0 * (1.0 - 1e-12));
    assert!((jump - k1 * t1 / k0).abs() < 1e-6);
}

#[test]
fn one_stiffness() {
    let spring = Elasticity::linear(2e4);
    for torsion in [-3e-3, -1e-6, 0.0, 5e-5, 1e-3] {
        assert!((spring.torque(torsion) - 2e4 * torsion).abs() < 1e-12);
        assert!((spring.energy(torsion) - 1e4 * torsion * torsion).abs() < 1e-14);
    }
}
