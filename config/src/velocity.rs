//! Velocities that a gait admits, as whoever steers by sliders or sticks needs them.

use messages::command_text::CommandInfo;

use crate::Gait;

/// Velocities that are worth a command: so many of them in 1 m/s or 1 rad/s.
pub const VELOCITY_STEPS: f64 = 100.0;

impl Gait {
    /// Fastest velocities that are accepted, forward, left \[m/s\] and turn \[rad/s\], each with its lower and its upper limit: those of
    /// the largest step in the shortest time. Forward and backward at most the last speed of the gait's table.
    pub fn fastest(&self) -> [[f64; 2]; 3] {
        let limits = &self.limits;
        let mut all =
            [limits.length, limits.side, limits.turn].map(|range| range.map(|x| x / limits.duration[0]));
        let most = self.step.by_speed.last().map_or(0.0, |row| row[0]);
        all[0] = [all[0][0].max(-most), all[0][1].min(most)];
        all
    }

    /// Ranges of `walk/velocity`, forward, left \[m/s\] and turn \[rad/s\]: the [`fastest`](Self::fastest), within the command's own, in
    /// whole steps ([`VELOCITY_STEPS`]).
    pub fn velocities(&self) -> [[f64; 2]; 3] {
        let mut all = self.fastest();
        // To the side only every other step goes far: the mean is half of it.
        all[1] = all[1].map(|x| x / 2.0);
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

    /// A scene whose way back is too fast is refused when it is loaded, and not in the middle of its walk.
    #[test]
    fn a_way_back_that_is_too_fast_is_named_when_the_scene_is_loaded() {
        let root = crate::root(None);
        let scene = std::fs::read_to_string(root.join("scenes/distance.toml")).unwrap();
        let load = |distance: f64, speed: f64| {
            let way = format!("distance = {distance:?}\nspeed = {speed:?}");
            let file = std::env::temp_dir().join(format!("gangwerk-way-back-{}.toml", std::process::id()));
            std::fs::write(&file, scene.replace("distance = 3.0\nspeed = 0.28", &way)).unwrap();
            let loaded = crate::Setup::load(&root, file.to_str().unwrap());
            std::fs::remove_file(&file).unwrap();
            loaded.map(drop).map_err(|e| e.to_string())
        };
        assert_eq!((load(1.0, 0.5), load(-1.0, 0.28)), (Ok(()), Ok(())));
        let refused = load(-1.0, 0.5).unwrap_err();
        let said = "command[1]: at 3 s: speed = 0.5 is beyond the 0.2857 m/s backward of gait lola";
        assert!(refused.contains(said), "{refused}");
    }
}
