//! Hybrid position/force control (thesis 5.3): foot motion that brings the contact forces to their targets.
//!
//! Per foot three coordinates are force controlled while it carries and position controlled while it swings:
//! height, roll, pitch (z, -s1, s0) against F_z, T_x, T_y.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | C | stiffness of one contact point | N/m |
//! | K | stiffness of one foot on its closed contact points | N/m, N m/rad |
//! | K^+ | its damped inverse, zero where no contact resists | m/N, rad/(N m) |
//! | P = K^+ K | what of a foot's motion the contact resists | 1 |
//! | N | motion of both soles against the torso per unit of modification, feet coupled through the moving CoG | 1 |
//! | Delta x_lambda | modification (z, roll, pitch) of each foot | m, rad, rad |
//!
//! G = K N is what (5.30) inverts. Errata 2: N needs the same weighted inverse as the inverse kinematics does (5.30);
//! the return to zero uses x_d0 (5.32); compression is positive, so the stiffness enters with a minus sign (5.28);
//! an edge has no vanishing row but rank 2: what it does not resist is position controlled.

use config::gait::StabilizerGains;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::contact::{ContactPhase, FootContact};

/// Change of (F_z, T_x, T_y) about the sensor with (z, roll, pitch) of the sole frame (5.23).
///
/// `points` are the contact points relative to the sole frame and how closed each is, `sensor` the force sensor
/// relative to it \[m\].
pub fn contact_stiffness(
    points: impl Iterator<Item = (Vector3<f64>, f64)>,
    sensor: Vector3<f64>,
    stiffness: f64,
) -> Matrix3<f64> {
    let mut k = Matrix3::zeros();
    for (p, closed) in points {
        let compression = Vector3::new(-1.0, -p.y, p.x); // of this point, per (z, roll, pitch)
        let lever = Vector3::new(1.0, p.y - sensor.y, -(p.x - sensor.x)); // (F_z, T_x, T_y) per unit of force
        k += lever * compression.transpose() * (stiffness * closed);
    }
    k
}

/// \[m/s\] Speed at which a foot is lowered that finds no ground at its time ...
const SEARCH_SPEED: f64 = 0.7;
/// \[m\] ... and how far.
const SEARCH_DEPTH: f64 = 0.1;
/// \[m\] A residue below this one is none.
const NOTHING: f64 = 1e-6;
/// \[m/s^2\] Acceleration of a foot that searches the ground, up to this speed \[m/s\], and beyond it: what it misses is mostly
/// just below it.
const GENTLE: (f64, f64) = (3.0, 0.15);
const HASTE: f64 = 20.0;

/// Compliance of a foot's contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Compliance {
    /// K^+ \[m/N, rad/(N m)\]
    pub inverse: Matrix3<f64>,
    /// P
    pub resisted: Matrix3<f64>,
}

impl Compliance {
    /// Of a foot with stiffness K: damped where K is nearly singular, exact elsewhere.
    pub(crate) fn new(k: &Matrix3<f64>) -> Self {
        const LENGTH: f64 = 0.1; // m: moments and angles against forces and heights (errata 2, gap 18)
        /// Singular values below this share of the largest are damped: with 0.02 the moments of a foot whose toe bends
        /// chatter at 20 Hz (knee 25 mrad off its target at 2 km/h, 4 mrad with 0.06), from 0.2 on she falls ...
        const SMALL: f64 = 0.06;
        let s = Vector3::new(1.0, 1.0 / LENGTH, 1.0 / LENGTH);
        let scale = Matrix3::from_diagonal(&s);
        let svd = (scale * k * scale).svd(true, true);
        let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return Self::none() };
        let small = SMALL * svd.singular_values.max();
        if !(small > 0.0) {
            return Self::none();
        }
        // ... so that their inverse goes to zero with them.
        let inverse = svd.singular_values.map(|x| if x < small { x / (small * small) } else { 1.0 / x });
        let inverse = scale * v.transpose() * Matrix3::from_diagonal(&inverse) * u.transpose() * scale;
        Self { inverse, resisted: inverse * k }
    }

    fn none() -> Self {
        Self { inverse: Matrix3::zeros(), resisted: Matrix3::zeros() }
    }
}

/// Modifications of both feet: (z, roll, pitch) right, then left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Modification {
    /// Delta x_lambda \[m, rad, rad\]
    pub value: Vector6<f64>,
    /// Its rate \[m/s, rad/s, rad/s\]
    pub rate: Vector6<f64>,
    /// \[m\] @torso Distance of each sole from where the plan wants it, that a plan from a measured pose began with; it
    /// fades.
    pub residue: [Vector3<f64>; 2],
    /// \[m/s\] Its rate.
    pub residue_rate: [Vector3<f64>; 2],
    /// A limit held it back.
    pub limited: bool,
}

impl Modification {
    /// Takes up steps \[m\] in the planned heights of the soles, so that the feet do not jump.
    pub(crate) fn absorb_plan_switch(&mut self, steps: [Option<f64>; 2]) {
        for (foot, step) in steps.into_iter().enumerate() {
            if let Some(step) = step {
                self.value[3 * foot] += step;
            }
        }
    }

    /// Lets the residue fade by a cycle.
    fn fade(&mut self, gain: f64, dt: f64) {
        for (residue, rate) in self.residue.iter_mut().zip(&mut self.residue_rate) {
            *rate = *residue * -gain;
            *residue += *rate * dt;
            if residue.amax() < NOTHING {
                (*residue, *rate) = (Vector3::zeros(), Vector3::zeros());
            }
        }
    }

    /// Forgets what was modified.
    pub(crate) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Moves component `i`, which is coordinate `c` of its foot, within its limits (5.33).
    fn step(&mut self, control: &StabilizerGains, (i, c): (usize, usize), wanted: f64, dt: f64) {
        let (limit, rate_limit) = (control.modification_limit[c], control.modification_rate[c]);
        let rate = wanted.clamp(-rate_limit, rate_limit);
        let value = (self.value[i] + rate * dt).clamp(-limit, limit);
        self.limited |= rate != wanted || value != self.value[i] + rate * dt;
        self.rate[i] = (value - self.value[i]) / dt;
        self.value[i] = value;
    }
}

/// Force targets of a cycle beside the measured forces; vectors are (F_z, T_x, T_y) right, then left \[N, N m\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct ForceTargets {
    /// Desired, modified: lambda_d1.
    pub desired: Vector6<f64>,
    /// Rate of the planned ones.
    pub desired_rate: Vector6<f64>,
    /// Measured and filtered: lambda.
    pub measured: Vector6<f64>,
}

/// Position-control inputs of one foot: contact state, planned vertical speed, target of its modification.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FootReference {
    /// Contact of the foot.
    pub contact: FootContact,
    /// \[m/s\] Planned vertical velocity of the sole.
    pub rise: f64,
    /// \[m, rad, rad\] Modification that a foot in the air returns to.
    pub target: Vector3<f64>,
}

/// One cycle of `dt` \[s\]: the rate of the modification (5.32) and its integral (5.33), both limited.
///
/// `motion` is N. A foot in the air is position controlled; its forces do not matter (errata 2 to (5.32)).
pub(crate) fn modify(
    control: &StabilizerGains,
    motion: &Matrix6<f64>,
    feet: &[(Compliance, FootReference); 2],
    forces: &ForceTargets,
    last: &Modification,
    dt: f64,
) -> Modification {
    let k = Vector6::from_fn(|i, _| control.force_gain[i % 3]);
    let wanted = forces.desired_rate * control.force_feed_forward
        + k.component_mul(&(forces.desired - forces.measured)); // (5.26)
    // Motion of each sole that answers its force error, as far as the foot is force controlled.
    let mut of_soles = Vector6::zeros();
    for (i, (compliance, reference)) in feet.iter().enumerate() {
        let alpha = reference.contact.force_share();
        of_soles
            .fixed_rows_mut::<3>(3 * i)
            .copy_from(&(compliance.inverse * wanted.fixed_rows::<3>(3 * i) * alpha));
    }
    let force_part = motion.lu().solve(&of_soles).unwrap_or_else(Vector6::zeros); // (5.30)
    // What the contact does not resist is position controlled; both parts within the same limits.
    let mut next = *last;
    next.limited = false;
    next.fade(control.position_gain, dt);
    for (i, (compliance, reference)) in feet.iter().enumerate() {
        let value = last.value.fixed_rows::<3>(3 * i).into_owned();
        let most = if reference.contact.touched { GENTLE.1 } else { SEARCH_SPEED };
        let fall = search_speed(value[0], -last.rate[3 * i] - reference.rise, dt).min(most);
        let rate =
            force_part.fixed_rows::<3>(3 * i) + free_part(control, compliance, reference, &value, fall);
        for c in 0..3 {
            next.step(control, (3 * i + c, c), rate[c], dt);
        }
    }
    next
}

/// Rate of what is not force controlled: (5.32), second line, and what early and late contact ask for; a foot
/// that is late, or has bounced off, goes down at `fall` \[m/s\].
fn free_part(
    control: &StabilizerGains,
    foot: &Compliance,
    reference: &FootReference,
    value: &Vector3<f64>,
    fall: f64,
) -> Vector3<f64> {
    let alpha = reference.contact.force_share();
    let back = (reference.target - value) * control.position_gain;
    let mut rate = back - foot.resisted * back * alpha;
    match reference.contact.phase {
        // A foot that rises must not be held down by what it gives up.
        ContactPhase::Swing if reference.rise >= 0.0 => rate[0] = rate[0].max(-reference.rise),
        ContactPhase::Swing | ContactPhase::Stance => {}
        ContactPhase::Early if reference.contact.felt > 0.0 => rate[0] -= reference.rise,
        ContactPhase::Early => rate[0] -= reference.rise + fall,
        ContactPhase::Late => rate[0] = -fall,
    }
    rate
}

/// \[m/s\] Speed of a foot that goes down to search for the ground, whose modification is `height` \[m\] and that went down
/// at `last` \[m/s\].
fn search_speed(height: f64, last: f64, dt: f64) -> f64 {
    let last = last.max(0.0);
    let faster = last + dt * if last < GENTLE.1 { GENTLE.0 } else { HASTE };
    if height > -SEARCH_DEPTH { SEARCH_SPEED.min(faster) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat_foot() -> impl Iterator<Item = (Vector3<f64>, f64)> {
        [(-0.1, -0.05), (-0.1, 0.05), (0.15, -0.05), (0.15, 0.05)]
            .into_iter()
            .map(|(x, y)| (Vector3::new(x, y, 0.0), 1.0))
    }

    fn stiffness() -> Matrix3<f64> {
        contact_stiffness(flat_foot(), Vector3::zeros(), 1.5e5)
    }

    fn foot(phase: ContactPhase, felt: f64) -> (Compliance, FootReference) {
        let reference = FootReference {
            contact: FootContact { phase, felt, ..FootContact::default() },
            rise: 0.0,
            target: Vector3::zeros(),
        };
        (Compliance::new(&stiffness()), reference)
    }

    fn no_forces() -> ForceTargets {
        ForceTargets { desired: Vector6::zeros(), desired_rate: Vector6::zeros(), measured: Vector6::zeros() }
    }

    fn raised() -> Modification {
        Modification { value: Vector6::new(0.004, 0.01, -0.01, 0.0, 0.0, 0.0), ..Default::default() }
    }

    /// Errata 2.13.
    #[test]
    fn stiffness_and_solution_of_the_errata() {
        let k = stiffness();
        let expected = Matrix3::new(-6e5, 0.0, 1.5e4, 0.0, -1500.0, 0.0, 1.5e4, 0.0, -9750.0);
        assert!((k - expected).abs().max() < 1e-9);
        let c = Compliance::new(&k);
        let expected = Vector3::new(-0.000152, -0.00333333333333, 0.000586666666667);
        assert!((c.inverse * Vector3::new(100.0, 5.0, -8.0) - expected).abs().max() < 1e-14);
        assert!((c.resisted - Matrix3::identity()).abs().max() < 1e-12);
    }

    /// On its toe edge a foot resists being pressed and rolled, and not being turned about that edge.
    #[test]
    fn an_edge_is_force_controlled_in_two_directions_and_position_controlled_in_the_third() {
        let edge = flat_foot().map(|(p, _)| (p, f64::from(u8::from(p.x > 0.0))));
        let k = contact_stiffness(edge, Vector3::zeros(), 1.5e5);
        let c = Compliance::new(&k);
        let about_the_edge = Vector3::new(0.15, 0.0, 1.0); // pitch, toe down, about x = 0.15
        assert!((k * about_the_edge).norm() < 1e-9 && (c.resisted * about_the_edge).norm() < 1e-9);
        assert!((c.resisted * c.resisted - c.resisted).abs().max() < 1e-9, "a projection");
        let force = Vector3::new(100.0, 0.0, -15.0); // at the edge: possible
        assert!((k * (c.inverse * force) - force).norm() < 1e-9);
        assert!((c.inverse * Vector3::new(0.0, 0.0, 5.0)).norm() < 1e-3, "an impossible moment moves little");
    }

    #[test]
    fn inverse_stays_bounded_while_a_contact_opens() {
        for k in 0..=100 {
            let rear = 1.0 - 0.01 * f64::from(k);
            let opening = flat_foot().map(|(p, _)| (p, if p.x > 0.0 { 1.0 } else { rear }));
            let c = Compliance::new(&contact_stiffness(opening, Vector3::zeros(), 1.5e5));
            assert!((c.inverse * Vector3::new(0.0, 0.0, 10.0)).norm() < 0.05, "{rear}");
        }
    }

    /// (5.26): on the contact it assumes, each force error decays as exp(-K t), by itself, feet coupled or not.
    #[test]
    fn force_errors_decay_independently() {
        let control = StabilizerGains { force_feed_forward: 0.0, ..crate::test_gains() };
        let mut motion = Matrix6::identity();
        (motion[(0, 3)], motion[(3, 0)], motion[(2, 5)]) = (-0.2, -0.3, 0.1);
        let mut k = Matrix6::zeros();
        k.fixed_view_mut::<3, 3>(0, 0).copy_from(&stiffness());
        k.fixed_view_mut::<3, 3>(3, 3).copy_from(&stiffness());
        let mut forces = ForceTargets {
            desired: Vector6::new(330.0, 4.0, -6.0, 270.0, 0.0, 0.0),
            measured: Vector6::new(300.0, 0.0, 0.0, 300.0, 0.0, 0.0),
            ..no_forces()
        };
        let error = forces.desired - forces.measured;
        let feet = [foot(ContactPhase::Stance, 1.0); 2];
        let mut m = Modification::default();
        for _ in 0..100 {
            m = modify(&control, &motion, &feet, &forces, &m, 1e-3);
            assert!(!m.limited);
            forces.measured += k * motion * m.rate * 1e-3;
        }
        for i in 0..6 {
            let expected = error[i] * (1.0 - 1e-3 * control.force_gain[i % 3]).powi(100);
            assert!((forces.desired[i] - forces.measured[i] - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn a_foot_in_the_air_forgets_its_modification_but_never_presses_down_for_it_while_it_rises() {
        let control = crate::test_gains();
        let mut feet = [foot(ContactPhase::Swing, 0.0), foot(ContactPhase::Stance, 1.0)];
        feet[0].1.rise = 1e-4;
        let mut m = raised();
        for _ in 0..100 {
            m = modify(&control, &Matrix6::identity(), &feet, &no_forces(), &m, 1e-3);
            assert!(m.rate[0] + feet[0].1.rise >= -1e-12);
        }
        feet[0].1.rise = -0.1;
        for _ in 0..500 {
            m = modify(&control, &Matrix6::identity(), &feet, &no_forces(), &m, 1e-3);
        }
        assert!(m.value[0].abs() < 0.004 * (-0.49 * control.position_gain).exp());
    }

    #[test]
    fn an_early_foot_stops_and_a_late_one_goes_down_to_its_depth() {
        let control = crate::test_gains();
        let mut feet = [foot(ContactPhase::Early, 1.0), foot(ContactPhase::Late, 0.0)];
        feet[0].1.rise = -0.2;
        let mut m = Modification::default();
        m = modify(&control, &Matrix6::identity(), &feet, &no_forces(), &m, 1e-3);
        assert!((m.rate[0] + feet[0].1.rise).abs() < 1e-12, "does not go on down");
        assert!((m.rate[3] + GENTLE.0 * 1e-3).abs() < 1e-12, "begins gently");
        for _ in 0..100 {
            m = modify(&control, &Matrix6::identity(), &feet, &no_forces(), &m, 1e-3);
        }
        assert!((m.rate[3] + SEARCH_SPEED.min(control.modification_rate[0])).abs() < 1e-12);
        for _ in 0..1000 {
            m = modify(&control, &Matrix6::identity(), &feet, &no_forces(), &m, 1e-3);
        }
        let lowest = SEARCH_DEPTH.min(control.modification_limit[0]);
        assert!((m.value[3] + lowest).abs() < 1e-3, "{}", m.value[3]);

        // One that has been on the ground bounced off: it strikes the harder the faster it follows.
        feet[1].1.contact.touched = true;
        let mut m = Modification::default();
        for _ in 0..100 {
            m = modify(&control, &Matrix6::identity(), &feet, &no_forces(), &m, 1e-3);
            assert!(m.rate[3] >= -GENTLE.1 - 1e-12, "{}", m.rate[3]);
        }
    }

    /// One of Lola's: 9 cm lower within 0.2 s.
    #[test]
    fn a_late_foot_gets_nine_centimetres_down() {
        let lola = config::root(None).join("gaits/lola.toml");
        let control = config::Gait::load(&lola).expect("the shipped gait").control;
        let feet = [foot(ContactPhase::Late, 0.0), foot(ContactPhase::Stance, 1.0)];
        let (mut m, mut cycles) = (Modification::default(), 0);
        while m.value[0] > -0.09 {
            m = modify(&control, &Matrix6::identity(), &feet, &no_forces(), &m, 1e-3);
            cycles += 1;
            assert!(!m.limited && m.rate[0] >= -0.7 - 1e-12 && cycles < 200, "{} m", m.value[0]);
        }
    }

    #[test]
    fn without_contact_or_numbers_nothing_is_inverted() {
        assert_eq!(Compliance::new(&Matrix3::zeros()), Compliance::none());
        assert_eq!(Compliance::new(&Matrix3::from_element(f64::NAN)), Compliance::none());
    }
}
