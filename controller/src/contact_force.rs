//! Contact force modification (thesis 5.2): foot wrenches that keep the upper body upright.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | F_d0, p | planned total force, planned zero-moment point | N, m | I |
//! | dphi | inclination error, desired minus actual | rad | - |
//! | r_ref | load-weighted mean of the force sensors (5.7) | m | I |
//! | rho | load factors, sum 1 | 1 | - |
//! | lambda_d1 | desired forces and moments at the sensors (5.22) | N, N m | I |
//!
//! Errata 2: (5.2), (5.3) have their axes exchanged and one sign wrong; Delta r_ref,i points from the reference point to
//! the sensor; the lower right entry of (5.11) is 1; below 5 cm between the sensors no normal force is shifted;
//! moments are limited to what the sole can carry.

use config::gait::StabilizerGains;
use nalgebra::{Vector2, Vector3};

/// \[1\] F_z,max over the robot's weight (5.12): thesis 5.2.
const FORCE_MAX: f64 = 2.0;

/// Force and moment about a force sensor, axes of the planning frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FootWrench {
    /// \[N\]
    pub force: Vector3<f64>,
    /// \[N m\]
    pub moment: Vector3<f64>,
}

/// Support that a foot can give.
#[derive(Clone, Copy, Debug)]
pub struct Support {
    /// \[m\] @I Force sensor.
    pub sensor: Vector3<f64>,
    /// \[1\] Load factor rho.
    pub load: f64,
    /// \[1\] Whether the foot is felt to be on the ground, whatever its load.
    pub felt: f64,
    /// \[m\] @I axes, from the sensor: rectangle of the sole, x back, x front, y right, y left, in the foot's heading.
    pub sole: [f64; 4],
    /// \[m\] Height of the sensor above the sole.
    pub height: f64,
    /// \[rad\] Heading of the foot.
    pub heading: f64,
}

/// Stabilizing force and moment at the centre of gravity: Delta T_x, Delta T_y, Delta F_z (5.2)-(5.4).
///
/// `error` and `rate` are (dphi_x, dphi_y) and their rates, `height` and `height_rate` the error of the centre of
/// gravity's height \[m, m/s\], all desired minus actual.
pub fn stabilize(
    gains: &StabilizerGains,
    error: Vector2<f64>,
    rate: Vector2<f64>,
    height: f64,
    height_rate: f64,
) -> (Vector3<f64>, f64) {
    let (kp, kd) = (gains.inclination_p, gains.inclination_d);
    let moment = Vector3::new(
        -(kp[1] * error.y + kd[1] * rate.y), // (5.2), corrected
        kp[0] * error.x + kd[0] * rate.x,    // (5.3), corrected
        0.0,
    );
    (moment, gains.height_p * height + gains.height_d * height_rate) // (5.4)
}

/// The planned total wrench with its modification, shared between the feet: lambda_d1 (5.5)-(5.19).
///
/// `zmp` is the planned zero-moment point on the ground at height 0 \[m\], `force` the planned total force \[N\],
/// `com` the centre of gravity \[m\], `weight` \[N\] the robot's weight.
pub(crate) fn distribute(
    gains: &StabilizerGains,
    weight: f64,
    (force, zmp, com): (Vector3<f64>, Vector2<f64>, Vector3<f64>),
    (moment_com, lift): (Vector3<f64>, f64),
    feet: &[Support; 2],
) -> [FootWrench; 2] {
    let [rho_0, rho_1] = [feet[0].load, feet[1].load];
    let r_ref = feet[0].sensor * rho_0 + feet[1].sensor * rho_1; // (5.7)
    let planned = (Vector3::new(zmp.x, zmp.y, 0.0) - com).cross(&force); // T_d0 about the CoG
    let f = force + Vector3::z() * lift; // (5.5)
    let t = planned + moment_com + (com - r_ref).cross(&f); // (5.6)

    let (delta, rest) = shift_normal_force(gains, weight, f.z, t, feet);
    let mut wrenches = [
        FootWrench { force: f * rho_0 + Vector3::z() * delta, moment: rest * rho_0 }, // (5.15), (5.17)
        FootWrench { force: f * rho_1 - Vector3::z() * delta, moment: rest * rho_1 }, // (5.16), (5.18)
    ];
    let lack = limit_to_soles(&mut wrenches, feet);
    lean_on(&mut wrenches, feet, lack);
    wrenches
}

/// Delta F_z,stab and the moment that remains for the feet, (5.10)-(5.14), (5.19).
fn shift_normal_force(
    gains: &StabilizerGains,
    weight: f64,
    f_z: f64,
    t: Vector3<f64>,
    feet: &[Support; 2],
) -> (f64, Vector3<f64>) {
    let f_max = FORCE_MAX * weight;
    let [rho_0, rho_1] = [feet[0].load, feet[1].load];
    let low = (-rho_0 * f_z).max(rho_1 * (f_z - f_max)); // (5.12)
    let high = (rho_0 * (f_max - f_z)).min(rho_1 * f_z);
    let Some((axis, d)) = shift_axis(feet).filter(|_| low < high) else { return (0.0, t) };
    let delta = gains.force_shift * (t.dot(&axis) / d).clamp(low, high); // (5.13), (5.14)
    (delta, t - axis * (delta * d)) // (5.19)
}

/// Keeps each centre of pressure in its sole and offers what one foot cannot carry to the other. Returns the moment that
/// neither can.
fn limit_to_soles(wrenches: &mut [FootWrench; 2], feet: &[Support; 2]) -> Vector3<f64> {
    let over_0 = limit(&mut wrenches[0], &feet[0]);
    wrenches[1].moment += over_0;
    let over_1 = limit(&mut wrenches[1], &feet[1]);
    wrenches[0].moment += over_1;
    limit(&mut wrenches[0], &feet[0])
}

/// Moves normal force to the foot on whose side the moment `lack` is missing, if it is felt to be on the ground: one that has
/// come before its load may carry what the other cannot.
fn lean_on(wrenches: &mut [FootWrench; 2], feet: &[Support; 2], lack: Vector3<f64>) {
    let Some((axis, d)) = shift_axis(feet) else { return };
    let wanted = lack.dot(&axis) / d;
    let to = usize::from(wanted < 0.0);
    let most = wrenches[1 - to].force.z.max(0.0) * feet[to].felt;
    let moved = wanted.abs().min(most);
    wrenches[to].force.z += moved;
    wrenches[1 - to].force.z -= moved;
}

/// Axis of the moment that normal force shifted between the feet makes: x axis of frame N (5.11), and their distance \[m\]; none
/// if they are too near.
fn shift_axis(feet: &[Support; 2]) -> Option<(Vector3<f64>, f64)> {
    let r = feet[0].sensor - feet[1].sensor; // Delta r_ref,01
    let d = r.xy().norm();
    (d >= 0.05).then(|| (Vector3::new(r.y / d, -r.x / d, 0.0), d))
}

/// Moves the centre of pressure to the nearest point of the sole; returns the moment taken away.
fn limit(w: &mut FootWrench, foot: &Support) -> Vector3<f64> {
    let before = w.moment;
    if w.force.z <= 1.0 {
        w.moment = Vector3::zeros();
        return before;
    }
    let h = foot.height;
    // (p_z F_x - T_y)/F_z, (T_x + p_z F_y)/F_z with p_z = -h (errata 1, F13)
    let p = Vector2::new((-h * w.force.x - w.moment.y) / w.force.z, (w.moment.x - h * w.force.y) / w.force.z);
    let (s, c) = foot.heading.sin_cos();
    let local = Vector2::new(c * p.x + s * p.y, -s * p.x + c * p.y);
    let [back, front, right, left] = foot.sole;
    let inside = Vector2::new(local.x.clamp(back, front), local.y.clamp(right, left));
    if inside != local {
        let q = Vector2::new(c * inside.x - s * inside.y, s * inside.x + c * inside.y);
        w.moment.y = -h * w.force.x - q.x * w.force.z;
        w.moment.x = q.y * w.force.z + h * w.force.y;
    }
    before - w.moment
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gains() -> StabilizerGains {
        crate::test_gains()
    }

    fn feet(rho: [f64; 2], r: [Vector3<f64>; 2]) -> [Support; 2] {
        std::array::from_fn(|i| Support {
            sensor: r[i],
            load: rho[i],
            felt: 0.0,
            sole: [-10.0, 10.0, -10.0, 10.0],
            height: 0.0,
            heading: 0.0,
        })
    }

    /// Errata 2.12: moment given about r_ref; here it is brought in as the stabilizing moment at a CoG above r_ref.
    fn errata_case(t: Vector3<f64>) -> [FootWrench; 2] {
        let f = Vector3::new(20.0, -10.0, 590.0);
        let feet = feet([0.7, 0.3], [Vector3::new(0.0, -0.12, 0.0), Vector3::new(0.35, 0.13, 0.0)]);
        let r_ref = feet[0].sensor * 0.7 + feet[1].sensor * 0.3;
        distribute(&gains(), 588.6, (f, r_ref.xy(), r_ref), (t, 0.0), &feet)
    }

    #[test]
    fn distribution_of_the_errata() {
        let [a, b] = errata_case(Vector3::new(25.0, -12.0, 3.0));
        assert!((a.force.z - 356.513513514).abs() < 1e-8 && (b.force.z - 233.486486486).abs() < 1e-8);
        assert!((a.moment - Vector3::new(7.61486486486, 5.43918918919, 2.1)).norm() < 1e-10);
        assert!((b.moment - Vector3::new(3.26351351351, 2.33108108108, 0.9)).norm() < 1e-10);
        let [a, b] = errata_case(Vector3::new(250.0, -120.0, 30.0));
        assert!((a.force.z - 236.84).abs() < 1e-8 && (b.force.z - 353.16).abs() < 1e-8);
        assert!((a.moment - Vector3::new(144.172, -40.8408, 21.0)).norm() < 1e-8);
        assert!((b.moment - Vector3::new(61.788, -17.5032, 9.0)).norm() < 1e-8);
    }

    #[test]
    fn wrenches_add_up_to_the_demand() {
        let feet = feet([0.4, 0.6], [Vector3::new(0.1, -0.1, 0.08), Vector3::new(-0.1, 0.12, 0.09)]);
        let (f, zmp, com) =
            (Vector3::new(12.0, 30.0, 610.0), Vector2::new(0.02, 0.03), Vector3::new(0.0, 0.01, 0.8));
        let (dt, df) = (Vector3::new(15.0, -20.0, 0.0), 13.0);
        let mut shifted = Vec::new();
        for force_shift in [0.0, 0.5, 1.0] {
            let w = distribute(
                &StabilizerGains { force_shift, ..gains() },
                597.0,
                (f, zmp, com),
                (dt, df),
                &feet,
            );
            let total: Vector3<f64> = w[0].force + w[1].force;
            assert!((total - f - Vector3::z() * df).norm() < 1e-10);
            let about_com: Vector3<f64> =
                (0..2).map(|i| w[i].moment + (feet[i].sensor - com).cross(&w[i].force)).sum();
            let wanted = (Vector3::new(zmp.x, zmp.y, 0.0) - com).cross(&f) + dt;
            assert!((about_com - wanted).norm() < 1e-10);
            shifted.push(w[0].force.z - feet[0].load * total.z);
        }
        assert!(shifted[0].abs() < 1e-10 && shifted[2].abs() > 10.0);
        assert!((shifted[1] - 0.5 * shifted[2]).abs() < 1e-10);
    }

    #[test]
    fn no_force_is_shifted_between_feet_that_are_together_or_when_one_carries_all() {
        let together = feet([0.5, 0.5], [Vector3::zeros(), Vector3::new(0.0, 1e-9, 0.0)]);
        let w = distribute(
            &gains(),
            588.6,
            (Vector3::z() * 588.6, Vector2::zeros(), Vector3::z() * 0.8),
            (Vector3::x() * 40.0, 0.0),
            &together,
        );
        assert!((w[0].force.z - 294.3).abs() < 1e-9 && w.iter().all(|x| x.moment.norm() < 100.0));
        let single = feet([1.0, 0.0], [Vector3::zeros(), Vector3::new(0.0, 0.2, 0.0)]);
        let w = distribute(
            &gains(),
            588.6,
            (Vector3::z() * 588.6, Vector2::zeros(), Vector3::z() * 0.8),
            (Vector3::x() * 40.0, 0.0),
            &single,
        );
        assert_eq!(w[1].force.z, 0.0);
    }

    /// What lies beyond the sole that carries goes to a foot that has come before its load, as normal force, if it is there.
    #[test]
    fn a_foot_that_touches_carries_what_the_other_cannot() {
        let mut feet = feet([1.0, 0.0], [Vector3::new(0.0, -0.1, 0.0), Vector3::new(0.0, 0.1, 0.0)]);
        feet[0].sole = [-0.08, 0.22, -0.05, 0.05];
        let carried = |feet: &[Support; 2]| {
            let force = (Vector3::z() * 588.6, Vector2::new(0.0, -0.1), Vector3::new(0.0, -0.1, 0.8));
            // Towards the left by 0.1 m: half of it in the right sole.
            distribute(&gains(), 588.6, force, (Vector3::x() * 58.86, 0.0), feet)
        };
        assert_eq!(carried(&feet)[1].force.z, 0.0, "nobody is there");
        feet[1].felt = 1.0;
        let [right, left] = carried(&feet);
        assert!((left.force.z - 0.05 / 0.2 * 588.6).abs() < 1e-9, "{}", left.force.z);
        assert!((right.force.z + left.force.z - 588.6).abs() < 1e-9);
    }

    #[test]
    fn centre_of_pressure_stays_in_the_sole_and_the_other_foot_helps() {
        let mut feet = feet([0.5, 0.5], [Vector3::new(0.0, -0.1, 0.08), Vector3::new(0.0, 0.1, 0.08)]);
        for f in &mut feet {
            f.sole = [-0.08, 0.22, -0.05, 0.05];
            f.height = 0.08;
        }
        let demand = Vector3::new(0.0, 100.0, 0.0); // pitch moment beyond one heel
        let w = distribute(
            &gains(),
            588.6,
            (Vector3::z() * 588.6, Vector2::zeros(), Vector3::z() * 0.8),
            (demand, 0.0),
            &feet,
        );
        for x in w {
            let cop = (-0.08 * x.force.x - x.moment.y) / x.force.z;
            assert!((-0.08 - 1e-12..=0.22 + 1e-12).contains(&cop), "{cop}");
        }
    }

    /// A rigid body on an ideal contact returns to upright: the literal (5.2), (5.3) throw it over.
    #[test]
    fn the_stabilizing_moment_rights_a_tilted_body() {
        let (inertia, mgz) = (54.0, 508.0);
        for axis in 0..2 {
            let (mut tilt, mut rate) = (0.05, 0.0); // about the world axis: roll (x) or pitch (y)
            for _ in 0..3000 {
                // phi_x rises with pitch, phi_y falls with roll; error = desired - actual
                let error = if axis == 0 { Vector2::new(0.0, tilt) } else { Vector2::new(-tilt, 0.0) };
                let d = if axis == 0 { Vector2::new(0.0, rate) } else { Vector2::new(-rate, 0.0) };
                let (moment, _) = stabilize(&gains(), error, d, 0.0, 0.0);
                rate += 1e-3 * (mgz * tilt + moment[axis]) / inertia;
                tilt += 1e-3 * rate;
            }
            assert!(tilt.abs() < 1e-3, "axis {axis}: {tilt}");
        }
    }
}
