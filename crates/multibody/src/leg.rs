//! Leg of six joints in closed form: from its Denavit-Hartenberg rows to the pose of the torso, and back.
//!
//! The chain begins in the foot. Axis 1 is the frontal one of the ankle, axes 2 to 4 (ankle, knee, hip) are parallel, axes
//! 4 to 6 meet in the hip centre. So the hip centre alone gives theta_1 to theta_3, and what then is left of the rotation
//! theta_4 to theta_6. M. M. Daniali, "Walking control of a humanoid robot", TU Vienna, 2013, (3-26)-(3-100), as corrected
//! in docs/errata.md; what failed there as printed is kept in `tests/leg_as_printed.rs`.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | s | side: +1 left, -1 right; twist of row 1 over 90 deg | 1 | |
//! | a1, a2, a3 | between the axes of the ankle, of ankle and knee, of knee and hip | m | |
//! | d3 | plane of the leg beside axis 1 | m | |
//! | a6, d6 | frame {6} beside the hip centre, a6 with the sign of its row | m | {6} |
//! | p | hip centre P_5 | m | {0} |
//! | rho, w | foot of p in the plane of the leg, from axis 1 and from axis 2 | m | along the leg |
//! | `c1`, `s23` | cosine of theta_1, sine of theta_2 + theta_3 | 1 | |
//!
//! The determinant of the Jacobian is -a2 a3 sin(theta_3) rho sin(theta_5): singular are the straight knee, where the pose
//! is still met to rounding, but the angles only to its square root (7e-8 rad); the hip centre on the cylinder of radius d3
//! around axis 1; and theta_5 = 0 or 180 deg. rho < 0, a crouch with the hip below axis 1, is another branch, not offered.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector3};

pub use crate::leg_error::{LegError, LegRowError};

/// One link in the convention of Denavit and Hartenberg, (3-6): T = Rot(z, theta) Trans(z, d) Trans(x, a) Rot(x, alpha).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DhRow {
    /// \[m\] Length.
    pub a: f64,
    /// \[rad\] Twist.
    pub alpha: f64,
    /// \[m\] Offset.
    pub d: f64,
    /// \[rad\] Initial joint angle: that of the robot standing upright.
    pub theta: f64,
}

/// Leg in closed form. Angles are theta_1 to theta_6 from the foot on \[rad\], not counted from the initial ones.
#[derive(Clone, Copy, Debug)]
pub struct ClosedFormLeg {
    rows: [DhRow; 6],
    s: f64,
    a1: f64,
    a2: f64,
    a3: f64,
    d3: f64,
    a6: f64,
    d6: f64,
}

/// \[rad, m\] Entries of rows that the pattern fixes may be off by so much.
const ROW_TOLERANCE: f64 = 1e-12;
/// Largest entry of R^T R - 1 of a rotation.
const ROTATION_TOLERANCE: f64 = 1e-6;
/// Excess of the knee's cosine over its range that counts as rounding; 0.14 nm at Archie's straight knee.
const COSINE_TOLERANCE: f64 = 1e-9;
/// \[m\] Least rho: below it theta_1 is not determined.
const LEAST_RHO: f64 = 1e-8;
/// Least sine of theta_5: below it only the sum of theta_4 and theta_6 is determined.
const LEAST_SINE: f64 = 1e-6;

impl DhRow {
    /// Rotation and position \[m\] of this row's frame in that of the row before, its joint at `theta` \[rad\]: (3-6).
    pub fn transform(&self, theta: f64) -> (Matrix3<f64>, Vector3<f64>) {
        let (s, c) = theta.sin_cos();
        let (sa, ca) = self.alpha.sin_cos();
        let rotation = Matrix3::new(c, -s * ca, s * sa, s, c * ca, -c * sa, 0.0, sa, ca);
        (rotation, Vector3::new(self.a * c, self.a * s, self.d))
    }
}

impl ClosedFormLeg {
    /// Leg of these rows: alpha = s 90 deg, 0, 0, -s 90 deg, -90 deg, 0; lengths only where tables 3.1 and 3.2 have them
    /// (a1, a2, a3, d3, a6, d6).
    ///
    /// # Errors
    ///
    /// A row without this pattern, or an entry that is not finite.
    pub fn new(rows: &[DhRow; 6]) -> Result<Self, LegRowError> {
        let wrong = |row, entry, value, wanted| Err(LegRowError { row, entry, value, wanted });
        for (row, r) in rows.iter().enumerate() {
            for (entry, value) in [("a", r.a), ("alpha", r.alpha), ("d", r.d), ("theta", r.theta)] {
                if !value.is_finite() {
                    return wrong(row, entry, value, "a finite number");
                }
            }
        }
        if (rows[0].alpha.abs() - FRAC_PI_2).abs() > ROW_TOLERANCE {
            return wrong(0, "alpha", rows[0].alpha, "pi/2 (a left leg) or -pi/2 (a right one)");
        }
        let s = rows[0].alpha.signum();
        let hip = if s > 0.0 { "-pi/2, as row 1 has pi/2" } else { "pi/2, as row 1 has -pi/2" };
        // Twists, then lengths that must vanish, in the order of the rows.
        let zero = "0: axes 2 to 4 are parallel";
        let twists = [(1, 0.0, zero), (2, 0.0, zero), (3, -s * FRAC_PI_2, hip)];
        for (row, is, wanted) in twists.into_iter().chain([(4, -FRAC_PI_2, "-pi/2"), (5, 0.0, "0")]) {
            if (rows[row].alpha - is).abs() > ROW_TOLERANCE {
                return wrong(row, "alpha", rows[row].alpha, wanted);
            }
        }
        if let Some(row) = [0, 1, 3, 4].into_iter().find(|&row| rows[row].d.abs() > ROW_TOLERANCE) {
            return wrong(row, "d", rows[row].d, "0: only rows 3 and 6 have an offset");
        }
        if let Some(row) = [3, 4].into_iter().find(|&row| rows[row].a.abs() > ROW_TOLERANCE) {
            return wrong(row, "a", rows[row].a, "0: the axes of the hip meet");
        }
        for (row, least) in [(0, -ROW_TOLERANCE), (1, ROW_TOLERANCE), (2, ROW_TOLERANCE)] {
            if rows[row].a < least {
                return wrong(row, "a", rows[row].a, "a length above 0 (row 1: or 0)");
            }
        }
        let [a1, a2, a3] = [0, 1, 2].map(|row| rows[row].a);
        Ok(Self { rows: *rows, s, a1, a2, a3, d3: -rows[2].d, a6: rows[5].a, d6: rows[5].d })
    }

    /// Rotation and position \[m\] of frame {6} in frame {0} at theta `q` \[rad\], (3-14), (3-23).
    pub fn pose(&self, q: &[f64; 6]) -> (Matrix3<f64>, Vector3<f64>) {
        let mut pose = (Matrix3::identity(), Vector3::zeros());
        for (row, theta) in self.rows.iter().zip(q) {
            let (rotation, position) = row.transform(*theta);
            pose = (pose.0 * rotation, pose.1 + pose.0 * position);
        }
        pose
    }

    /// Angles theta_1 to theta_6 \[rad\], within half a turn, for a rotation and position \[m\] of frame {6} in frame {0}: the
    /// knee bent from 0 to 90 deg to its side, theta_5 between 0 and 180 deg, rho > 0.
    ///
    /// # Errors
    ///
    /// No such angles, or not one set of them: every case of [`LegError`] but `JointLimit`.
    pub fn angles(&self, rotation: &Matrix3<f64>, position: &Vector3<f64>) -> Result<[f64; 6], LegError> {
        if !rotation.iter().chain(position.iter()).all(|x| x.is_finite()) {
            return Err(LegError::NotFinite);
        }
        check_rotation(rotation)?;
        let (&Self { s, a1, a2, a3, d3, .. }, r6) = (self, rotation);

        // Hip centre: P_5 of frame {6} is (-a6, 0, -d6). (3-27), (3-67)
        let p = position - r6.column(0) * self.a6 - r6.column(2) * self.d6;

        // First axis of the ankle: it turns the plane of the leg, which lies d3 beside it, into the hip centre.
        let across = p.x * p.x + p.y * p.y;
        let n = across - d3 * d3;
        if n < 0.0 {
            return Err(LegError::InsideAnkleCylinder { distance: across.sqrt(), radius: d3.abs() });
        }
        let rho = n.sqrt();
        if rho < LEAST_RHO {
            return Err(LegError::AnkleSingular { rho, least: LEAST_RHO });
        }
        // Atan2(p_y, p_x) - s Atan2(d3, rho), the difference taken between complex numbers. (3-31), (3-70)
        let (x, y) = (p.x * rho + s * d3 * p.y, p.y * rho - s * d3 * p.x);
        let theta_1 = y.atan2(x);
        let (c1, s1) = (x / across, y / across);

        // Knee, by the law of cosines in the plane of the leg. w has a sign. (3-37), (3-76)
        let (w, z) = (rho - a1, s * p.z);
        let distance = w * w + z * z;
        let c3 = (distance - a2 * a2 - a3 * a3) / (2.0 * a2 * a3);
        let c3 = self.knee_in_range(c3, distance)?;
        let s3 = -s * ((1.0 - c3) * (1.0 + c3)).sqrt(); // (3-38), (3-77)
        let theta_3 = s3.atan2(c3); // (3-40), (3-79)

        // Second axis of the ankle: Atan2(z, w) - phi, again between complex numbers. (3-47), (3-52), (3-91)
        let (along, beside) = (a2 + a3 * c3, a3 * s3); // r cos(phi), r sin(phi): (3-43), (3-44)
        let (x, y) = (w * along + z * beside, z * along - w * beside);
        let theta_2 = y.atan2(x);
        let r = (x * x + y * y).sqrt();
        let (c2, s2) = (x / r, y / r);

        // Rotation that is left to the hip, R' = R_3^0^T R_6. (3-56)-(3-58), (3-92)-(3-94)
        let (c23, s23) = (c2 * c3 - s2 * s3, s2 * c3 + c2 * s3);
        let x3 = Vector3::new(c1 * c23, s1 * c23, s * s23);
        let y3 = Vector3::new(-c1 * s23, -s1 * s23, s * c23);
        let z3 = Vector3::new(s * s1, -s * c1, 0.0);
        let (r13, r23, r33) = (x3.dot(&r6.column(2)), y3.dot(&r6.column(2)), z3.dot(&r6.column(2)));
        let (r31, r32) = (z3.dot(&r6.column(0)), z3.dot(&r6.column(1)));
        let s5 = (r13 * r13 + r23 * r23).sqrt(); // (3-61), (3-97), corrected
        if s5 < LEAST_SINE {
            return Err(LegError::HipSingular { sine: s5, least: LEAST_SINE });
        }
        let theta_4 = (-r23).atan2(-r13); // (3-63), (3-99)
        let theta_5 = s5.atan2(-s * r33); // (3-62), (3-98)
        let theta_6 = (s * r32).atan2(-s * r31); // (3-64), (3-100)
        Ok([theta_1, theta_2, theta_3, theta_4, theta_5, theta_6])
    }

    /// Cosine of the knee without what is rounding, for the square `distance` of ankle and hip. (3-39), (3-78)
    fn knee_in_range(&self, cosine: f64, distance: f64) -> Result<f64, LegError> {
        let (longest, shortest) = (self.a2 + self.a3, (self.a3 - self.a2).abs());
        match cosine {
            c if c > 1.0 + COSINE_TOLERANCE => {
                Err(LegError::TooFar { distance: distance.sqrt(), reach: longest })
            }
            c if c < -1.0 => Err(LegError::TooNear { distance: distance.sqrt(), least: shortest }),
            c if c < -COSINE_TOLERANCE => Err(LegError::KneeLimit { angle: c.acos(), limit: FRAC_PI_2 }),
            c => Ok(c.min(1.0)),
        }
    }
}

/// Whether a matrix is a rotation.
///
/// # Errors
///
/// [`LegError::NotFinite`] or [`LegError::NotARotation`].
pub fn check_rotation(rotation: &Matrix3<f64>) -> Result<(), LegError> {
    let error = (rotation.tr_mul(rotation) - Matrix3::identity()).amax();
    if !error.is_finite() {
        return Err(LegError::NotFinite);
    }
    let mirrored = rotation.determinant() < 0.0;
    if error > ROTATION_TOLERANCE || mirrored {
        return Err(LegError::NotARotation { error, tolerance: ROTATION_TOLERANCE, mirrored });
    }
    Ok(())
}
