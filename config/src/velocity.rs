//! Velocities that a gait admits, as whoever steers by sliders or sticks needs them.

use messages::command_text::CommandInfo;

use crate::Gait;

/// Velocities that are worth a command: so many of them in 1 m/s or 1 rad/s.
pub const VELOCITY_STEPS: f64 = 100.0;

impl Gait {
    /// Ranges of `walk/velocity`, forward, left \[m/s\] and turn \[rad/s\]: those of the longest step in its shortest time, within the
    /// command's own, in whole steps ([`VELOCITY_STEPS`]). Forward at most the last speed of the gait's table.
    pub fn velocities(&self) -> [[f64; 2]; 3] {
        let limits = &self.limits;
        let mut all =
            [limits.length, limits.side, limits.turn].map(|range| range.map(|x| x / limits.duration[0]));
        // To the side only every other step goes far: the mean is half of it.
        all[1] = all[1].map(|x| x / 2.0);
        let fastest = self.step.by_speed.last().map_or(0.0, |row| row[0]);
        all[0] = [all[0][0].max(-fastest), all[0][1].min(fastest)];
        let fields = CommandInfo::find("walk/velocity").map_or(&[][..], |command| command.fields);
        for (range, field) in all.iter_mut().zip(fields) {
            // Towards zero: what is rounded is still within.
            *range = range.map(|x| {
                let x = x.clamp(field.range[0], field.range[1]);
                (x * VELOCITY_STEPS + 1e-9 * x.signum()).trunc() / VELOCITY_STEPS
            });
        }
        all
    }

    /// \[s\] Duration of a step on the spot.
    pub fn on_the_spot(&self) -> f64 {
        self.step.by_speed.first().map_or(self.limits.duration[1], |row| row[2])
    }
}

#[cfg(test)]
mod tests {
    /// Every shipped gait: ranges hold zero, are finite, and Lola's are those of her file.
    #[test]
    fn ranges_are_those_of_the_longest_step() {
        let root = crate::root(None);
        let of = |scene: &str| crate::Setup::load(&root, scene).unwrap().gait.velocities();
        for (name, _) in crate::scenes::list(&root).unwrap() {
            for [low, high] in of(&name) {
                assert!(low <= 0.0 && high >= 0.0 && low >= -2.0 && high <= 2.0, "{name}: [{low}, {high}]");
            }
        }
        let expected = [[-0.28, 0.94], [-0.14, 0.14], [-0.49, 0.49]];
        for (range, wanted) in of("demo").into_iter().zip(expected) {
            assert_eq!(range, wanted);
        }
    }
}
