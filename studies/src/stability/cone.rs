//! How much of the contact-wrench cone of a rectangular sole a wrench uses up (thesis 3.3.3).
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | f, t | force of the ground on the sole, moment about the middle of the rectangle | N, N m | sole |
//! | X, Y | half lengths of the rectangle | m | |
//! | mu | coefficient of friction | 1 | |
//! | s | gauge: by 1/s all tangential forces and moments could grow before the sole slips, tips or turns | 1 | |
//!
//! A sole that touches the ground at its four corners with friction pyramids along its sides can bear
//!
//! ```text
//! |f_x|, |f_y| <= mu f_z      |t_x| <= Y f_z      |t_y| <= X f_z
//! |Y f_x + mu t_x| + |X f_y + mu t_y| + t_z <= mu (X + Y) f_z
//! |Y f_x - mu t_x| + |X f_y - mu t_y| - t_z <= mu (X + Y) f_z
//! ```
//!
//! (Caron, Pham and Nakamura 2015, proven there; the tests compare it with forces at the corners.) All of it is
//! homogeneous in f_x, f_y, t, so s is the largest of left side over right side. The pyramid touches the friction cone
//! along the axes and is wider between them; the cone itself is asked beside it. The margin 1 - s is 1 in the middle
//! and 0 on the border.

use nalgebra::Vector3;

/// What would give way first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// Sliding: the friction cone.
    Slip,
    /// Turning about a side edge, roll.
    TipSideways,
    /// Turning about the front or back edge, pitch.
    TipForward,
    /// Turning about the vertical.
    Twist,
}

impl Border {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slip => "slip",
            Self::TipSideways => "tip sideways",
            Self::TipForward => "tip forward or back",
            Self::Twist => "twist",
        }
    }
}

/// 1 - s, and what is nearest; none if the ground does not push, or pulls. `half` is X, Y.
pub fn margin(force: &Vector3<f64>, moment: &Vector3<f64>, half: [f64; 2], mu: f64) -> Option<(f64, Border)> {
    let ([x, y], f) = (half, force.z);
    let sound = f > super::points::LEAST_FORCE && x > 0.0 && y > 0.0 && mu > 0.0;
    if !sound || !force.iter().chain(moment.iter()).all(|x| x.is_finite()) {
        return None;
    }
    let twist = |sign: f64| {
        let a = (y * force.x + sign * mu * moment.x).abs() + (x * force.y + sign * mu * moment.y).abs();
        (a + sign * moment.z) / (mu * (x + y) * f)
    };
    let used = [
        (force.x.hypot(force.y) / (mu * f), Border::Slip),
        (moment.x.abs() / (y * f), Border::TipSideways),
        (moment.y.abs() / (x * f), Border::TipForward),
        (twist(1.0), Border::Twist),
        (twist(-1.0), Border::Twist),
    ];
    let (s, border) = used.into_iter().fold((0.0, Border::Slip), |a, b| if b.0 > a.0 { b } else { a });
    Some((1.0 - s, border))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF: [f64; 2] = [0.15, 0.04];
    const MU: f64 = 0.7;

    fn of(force: [f64; 3], moment: [f64; 3]) -> (f64, Border) {
        margin(&Vector3::from(force), &Vector3::from(moment), HALF, MU).unwrap()
    }

    /// A block at rest uses nothing; on a slope it slides at tan = mu, tips at tan = Y/h or X/h, and twists at
    /// mu (X + Y) f_z, the moment of four corners that all slide across.
    #[test]
    fn a_block_slides_tips_and_twists_at_its_closed_form_limits() {
        assert_eq!(of([0.0, 0.0, 100.0], [0.0; 3]), (1.0, Border::Slip));
        let near = |(m, border): (f64, Border), expected: f64, which: Border| {
            assert!((m - expected).abs() < 1e-12 && border == which, "{m} {border:?}");
        };
        near(of([70.0, 0.0, 100.0], [0.0; 3]), 0.0, Border::Slip);
        near(of([30.0, 40.0, 100.0], [0.0; 3]), 1.0 - 50.0 / 70.0, Border::Slip);
        near(of([0.0, 0.0, 100.0], [4.0, 0.0, 0.0]), 0.0, Border::TipSideways);
        near(of([0.0, 0.0, 100.0], [0.0, 7.5, 0.0]), 0.5, Border::TipForward);
        near(of([0.0, 0.0, 100.0], [0.0, 0.0, -13.3]), 0.0, Border::Twist);
        // A block of height 2 h on a slope: f_y = f_z tan, t_x = -h f_y about the middle of the sole.
        let (h, slope) = (0.1, 0.3);
        near(
            of([0.0, 100.0 * slope, 100.0], [-h * 100.0 * slope, 0.0, 0.0]),
            1.0 - 0.75,
            Border::TipSideways,
        );
    }

    /// Scaling every force changes no margin; scaling all but f_z by 1/s leads to the border.
    #[test]
    fn the_margin_is_a_gauge() {
        let (f, t) = (Vector3::new(12.0, -9.0, 200.0), Vector3::new(1.5, -6.0, 3.0));
        let (m, border) = margin(&f, &t, HALF, MU).unwrap();
        assert_eq!(margin(&(f * 4.0), &(t * 4.0), HALF, MU).unwrap(), (m, border));
        let grow = 1.0 / (1.0 - m);
        let at_border = margin(&Vector3::new(f.x * grow, f.y * grow, f.z), &(t * grow), HALF, MU).unwrap();
        assert!(at_border.0.abs() < 1e-12 && at_border.1 == border);
    }

    /// Force and moment of the four corners, each a combination of the four edges of its pyramid.
    fn generators() -> Vec<[f64; 6]> {
        let mut all = Vec::new();
        for (cx, cy) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            for (ex, ey) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                let f = Vector3::new(MU * ex, MU * ey, 1.0);
                let t = Vector3::new(cx * HALF[0], cy * HALF[1], 0.0).cross(&f);
                all.push([f.x, f.y, f.z, t.x / 0.1, t.y / 0.1, t.z / 0.1]); // moments in units of 0.1 N m
            }
        }
        all
    }

    /// Least distance of a wrench to the cone of the generators, by coordinate descent.
    fn distance(wrench: [f64; 6]) -> f64 {
        let g = generators();
        let mut rest = wrench;
        let mut share = vec![0.0; g.len()];
        for _ in 0..20_000 {
            for (w, g) in share.iter_mut().zip(&g) {
                let (dot, square) =
                    (0..6).fold((0.0, 0.0), |(d, s), i| (d + g[i] * rest[i], s + g[i] * g[i]));
                let new = (*w + dot / square).max(0.0);
                for i in 0..6 {
                    rest[i] -= (new - *w) * g[i];
                }
                *w = new;
            }
        }
        rest.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    /// The other route: a wrench a little inside of the closed form's border can be made of forces at the corners, and
    /// one a little outside cannot. The resultant's cone is left out by keeping f_x, f_y small.
    #[test]
    fn the_closed_form_is_what_four_corners_can_bear() {
        let mut random = 12345_u64;
        let mut uniform = || {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (random >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        let mut seen = [false; 4];
        for _ in 0..100 {
            let f = Vector3::new(0.3 * uniform(), 0.3 * uniform(), 1.0);
            let t = Vector3::new(0.06 * uniform(), 0.2 * uniform(), 0.1 * uniform());
            let (m, border) = margin(&f, &t, HALF, MU).unwrap();
            if border == Border::Slip {
                continue;
            }
            seen[border as usize] = true;
            for (scale, inside) in [(0.97, true), (1.03, false)] {
                let k = scale / (1.0 - m);
                let w = [f.x * k, f.y * k, f.z, t.x * k / 0.1, t.y * k / 0.1, t.z * k / 0.1];
                let d = distance(w);
                assert!((d < 1e-6) == inside, "{border:?} {scale}: {d}");
            }
        }
        assert_eq!(seen, [false, true, true, true]);
    }

    #[test]
    fn a_sole_that_bears_nothing_has_no_margin() {
        let (up, none) = (Vector3::new(0.0, 0.0, 10.0), Vector3::zeros());
        assert_eq!(margin(&none, &none, HALF, MU), None);
        assert_eq!(margin(&-up, &none, HALF, MU), None);
        assert_eq!(margin(&up, &none, [0.0, 0.1], MU), None);
        assert_eq!(margin(&up, &none, HALF, 0.0), None);
        assert_eq!(margin(&Vector3::new(f64::NAN, 0.0, 1.0), &none, HALF, MU), None);
    }
}
