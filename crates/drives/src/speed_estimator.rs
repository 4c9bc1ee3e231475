//! Speed of a shaft from the counts of its encoder, by counts over the time between two edges (M/T, at less than one count
//! a sample 1/T), and a first-order filter behind it. Counts over a sample show steps of one count a period, 1042 rpm with
//! 360 counts and 160 us (errata 3, 2.9); edges, whose times the drive notes, do not.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | d | angle of one count; 0: the angle itself is seen, and its difference taken | rad |
//! | T, T_f | period, time constant of the filter | s |

/// Estimator of one shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedEstimator {
    /// \[rad\] d.
    count: f64,
    /// \[s\] T_f.
    filter: f64,
    /// \[rad\] Angle at the last sample.
    last: Option<f64>,
    /// \[rad\], \[s\] The last edge, and how long ago it was.
    edge: (f64, f64),
    /// \[rad/s\] Before and behind the filter.
    raw: f64,
    speed: f64,
}

impl SpeedEstimator {
    /// Estimator of a shaft at rest with counts of `count` \[rad\] and a filter of `filter` \[s\]; 0: without.
    pub fn new(count: f64, filter: f64) -> Self {
        Self { count, filter, last: None, edge: (0.0, 0.0), raw: 0.0, speed: 0.0 }
    }

    /// Sample of the `angle` \[rad\], `period` \[s\] after the last one: speed \[rad/s\]. Between samples the shaft is taken
    /// to turn evenly, which times its edges. An angle that is not finite changes nothing.
    pub fn sample(&mut self, angle: f64, period: f64) -> f64 {
        if !angle.is_finite() {
            return self.speed;
        }
        let Some(last) = self.last.replace(angle) else {
            self.edge = (angle, 0.0);
            return self.speed;
        };
        self.raw =
            if self.count > 0.0 { self.by_edges(last, angle, period) } else { (angle - last) / period };
        let share = if self.filter > 0.0 { -(-period / self.filter).exp_m1() } else { 1.0 };
        self.speed += share * (self.raw - self.speed);
        self.speed
    }

    fn by_edges(&mut self, last: f64, angle: f64, period: f64) -> f64 {
        let [before, now] = [last, angle].map(|x| (x / self.count).floor());
        if before == now {
            // No edge: slower than one count since the last.
            self.edge.1 += period;
            return self.raw.clamp(-self.count / self.edge.1, self.count / self.edge.1);
        }
        let edge = if now > before { now * self.count } else { (now + 1.0) * self.count };
        let share = ((edge - last) / (angle - last)).clamp(0.0, 1.0);
        let (turned, time) = (edge - self.edge.0, self.edge.1 + share * period);
        self.edge = (edge, (1.0 - share) * period);
        // To and fro over one edge is no motion.
        if time > 0.0 { turned / time } else { self.raw }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const PERIOD: f64 = 160e-6;
    const COUNT: f64 = TAU / 360.0;

    /// 1200 rpm and less are read to rounding, where differences of counts read 0 or 1042 rpm.
    #[test]
    fn an_even_speed_is_read_from_the_second_edge_on() {
        for speed in [125.66, -125.66, 3.0, 700.0] {
            let mut estimator = SpeedEstimator::new(COUNT, 0.0);
            let mut read = 0.0;
            for k in 0..200 {
                read = estimator.sample(0.3 + speed * PERIOD * f64::from(k), PERIOD);
            }
            assert!((read / speed - 1.0).abs() < 1e-9, "{speed}: {read}");
        }
    }

    #[test]
    fn a_shaft_that_stops_is_read_to_stop() {
        let mut estimator = SpeedEstimator::new(COUNT, 0.0);
        (0..50).for_each(|k| _ = estimator.sample(0.1 * f64::from(k), PERIOD));
        let read = (0..625).map(|_| estimator.sample(4.9, PERIOD)).last().unwrap();
        assert!(read > 0.0 && read <= COUNT / 0.0999, "{read}: one count in 0.1 s at most");
        // Over one edge, to and fro.
        let edge = (4.9 / COUNT).floor() * COUNT;
        let read = [1e-4, -1e-4, 1e-4, -1e-4].map(|x| estimator.sample(edge + x, PERIOD));
        assert_eq!(read[3], 0.0);
    }

    #[test]
    fn the_filter_takes_its_time_constant() {
        let mut estimator = SpeedEstimator::new(0.0, 10.0 * PERIOD);
        let read = (0..=10).map(|k| estimator.sample(PERIOD * f64::from(k), PERIOD)).last().unwrap();
        assert!((read - (1.0 - (-1.0_f64).exp())).abs() < 1e-12, "{read}");
        assert_eq!(estimator.sample(f64::NAN, PERIOD), read);
    }
}
