//! Top view of a scene: the way that its commands ask for, its objects, its pushes. What a robot makes of that is for the run to show.

use config::Scene;
use environment::Object;
use messages::Command;
use messages::command::VelocityCommand;
use nalgebra::{Isometry2, Vector2};
use serde_json::{Value, json};

use crate::picture::schedule;

/// \[rad\] Piece of an arc that is drawn as a line, and \[1\] most of them: a walk may turn round and round for hours.
const PIECE: f64 = 0.1;
const PIECES: f64 = 500.0;
const REST: VelocityCommand = VelocityCommand { forward: 0.0, left: 0.0, turn: 0.0 };

/// `way`: points \[m\] from where it starts, facing along x; `objects`: boxes around them, two corners \[m\] each; `pushes`: places
/// \[m\] and forces \[N\].
///
/// # Errors
/// An object's mesh cannot be read.
pub(crate) fn top_view(scene: &Scene) -> Result<Value, String> {
    let objects = scene.objects.iter().map(|object| {
        let mesh = object.shape.mesh().map_err(|e| format!("object {}: {e}", object.name))?;
        let object = Object::new(&object.name, mesh, None, schedule(object));
        let bounds = object.bounds();
        Ok([bounds.lo.xy(), bounds.hi.xy()].map(point))
    });
    let objects: Vec<_> = objects.collect::<Result<_, String>>()?;
    let mut walker = Walker::default();
    let pushes: Vec<_> =
        timeline(scene).into_iter().filter_map(|(time, event)| walker.pass(time, event)).collect();
    Ok(json!({"way": walker.way, "objects": objects, "pushes": pushes}))
}

/// Instant of a scene: a command, a push \[N\], or its end.
#[derive(Clone, Copy, Debug)]
enum Happening {
    Command(Command),
    Push([f64; 2]),
    End,
}

/// Commands, pushes and the end by time \[s\].
fn timeline(scene: &Scene) -> Vec<(f64, Happening)> {
    let commands = scene.commands.iter().map(|(time, command)| (*time, Happening::Command(*command)));
    let pushes =
        scene.pushes.iter().map(|(time, push)| (*time, Happening::Push([push.force[0], push.force[1]])));
    let mut all: Vec<_> = commands.chain(pushes).chain([(scene.duration, Happening::End)]).collect();
    all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    all
}

/// Walks exactly as it is told: at once, without steps.
#[derive(Debug)]
struct Walker {
    time: f64,
    pose: Isometry2<f64>,
    velocity: VelocityCommand,
    /// Velocity of `walk/start`, from the step parameters.
    step: VelocityCommand,
    /// \[s\] End of a distance that was commanded.
    until: f64,
    way: Vec<[f64; 2]>,
}

impl Default for Walker {
    fn default() -> Self {
        let pose = Isometry2::identity();
        Self { time: 0.0, pose, velocity: REST, step: REST, until: f64::INFINITY, way: vec![[0.0; 2]] }
    }
}

impl Walker {
    /// Walks on to `time` \[s\], and takes what happens then; place and force of a push.
    fn pass(&mut self, time: f64, event: Happening) -> Option<[f64; 4]> {
        self.walk(time.min(self.until) - self.time);
        self.time = time;
        match event {
            Happening::Command(command) => self.take(&command),
            Happening::Push([x, y]) => {
                let [here_x, here_y] = point(self.pose.translation.vector);
                return Some([here_x, here_y, x, y]);
            }
            Happening::End => {}
        }
        None
    }

    fn take(&mut self, command: &Command) {
        let go_on = (self.velocity, self.until);
        (self.velocity, self.until) = match *command {
            Command::Velocity(velocity) => (velocity, f64::INFINITY),
            Command::Start => (self.step, f64::INFINITY),
            Command::Stop => (REST, f64::INFINITY),
            Command::Distance(way) => {
                let forward = way.speed.copysign(way.distance);
                (VelocityCommand { forward, ..REST }, self.time + way.distance.abs() / way.speed)
            }
            // As far as the edge: where behind it she stands is for the planner to say.
            Command::Platform(platform) => {
                self.go(Vector2::x() * platform.distance, 0.0);
                go_on
            }
            Command::Step(step) => {
                let [forward, left, turn] = [step.length, step.side, step.turn].map(|x| x / step.duration);
                self.step = VelocityCommand { forward, left, turn };
                go_on
            }
            _ => go_on,
        };
    }

    /// Walks for `duration` \[s\].
    fn walk(&mut self, duration: f64) {
        let VelocityCommand { forward, left, turn } = self.velocity;
        if duration <= 0.0 || self.velocity == REST {
            return;
        }
        let pieces = (turn.abs() * duration / PIECE).ceil().clamp(1.0, PIECES);
        let (way, angle) = (Vector2::new(forward, left) * duration / pieces, turn * duration / pieces);
        (0..pieces as usize).for_each(|_| self.go(way, angle));
    }

    /// One piece of the way, an arc: its chord points in the direction in the middle of its turn.
    fn go(&mut self, way: Vector2<f64>, angle: f64) {
        let half = Isometry2::rotation(0.5 * angle);
        let chord = if angle == 0.0 { way } else { way * ((0.5 * angle).sin() / (0.5 * angle)) };
        self.pose = self.pose * half * Isometry2::translation(chord.x, chord.y) * half;
        self.way.push(point(self.pose.translation.vector));
    }
}

/// To the millimetre, which no picture shows.
fn point(p: Vector2<f64>) -> [f64; 2] {
    <[f64; 2]>::from(p).map(|x| (x * 1e3).round() / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::DistanceCommand;

    fn of(scene: &str) -> Value {
        let file = config::root(None).join("scenes").join(scene).with_extension("toml");
        top_view(&Scene::load(&file).unwrap()).unwrap()
    }

    fn last(view: &Value) -> [f64; 2] {
        let way = view["way"].as_array().unwrap();
        serde_json::from_value(way[way.len() - 1].clone()).unwrap()
    }

    /// Against the arithmetic of each file: speed times time.
    #[test]
    fn ways_are_as_long_as_the_commands_say() {
        // 2 km/h from 3 to 16 s.
        let [x, y] = last(&of("walk_2kmh"));
        assert!((x - 2.0 / 3.6 * 13.0).abs() < 0.1 && y == 0.0, "{x} {y}");
        assert!(last(&of("walk_backwards"))[0] < -1.0);
        assert!(last(&of("walk_sideways"))[1].abs() > 0.3);
        assert_eq!(of("stand")["way"], json!([[0.0, 0.0]]));
        assert_eq!(last(&of("walk_turn")), [0.0, 0.0], "on the spot");
        let scene = Scene::load(&config::root(None).join("scenes/distance.toml")).unwrap();
        let asked = scene.commands.iter().find_map(|(_, c)| match c {
            Command::Distance(way) => Some(way.distance),
            _ => None,
        });
        assert!((last(&of("distance"))[0] - asked.unwrap()).abs() < 1e-3);
    }

    /// Commands at random instants, against the same walked in steps of 1 ms.
    #[test]
    fn random_commands_lead_where_small_steps_do() {
        for seed in 1..=20_u64 {
            let mut state = seed;
            let mut draw = |low: f64, high: f64| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
            };
            let (mut walker, mut end) = (Walker::default(), 0);
            // The other walker: place, heading, velocity in its own axes, and how far it is yet to go.
            let ([mut x, mut y, mut heading], mut v, mut left_to_go) =
                ([0.0_f64; 3], [0.0; 3], f64::INFINITY);
            for _ in 0..8 {
                let ms = draw(1.0, 6000.0) as u64;
                for _ in 0..ms {
                    let dt = f64::min(1e-3, left_to_go / f64::hypot(v[0], v[1]).max(1e-9));
                    let (sin, cos) = (heading + 0.5 * v[2] * dt).sin_cos();
                    x += (v[0] * cos - v[1] * sin) * dt;
                    y += (v[0] * sin + v[1] * cos) * dt;
                    heading += v[2] * dt;
                    left_to_go -= f64::hypot(v[0], v[1]) * dt;
                }
                end += ms;
                let command = match draw(0.0, 4.0) as u32 {
                    0 => Command::Stop,
                    1 => {
                        let [distance, speed] = [draw(-2.0, 2.0), draw(0.1, 0.5)];
                        Command::Distance(DistanceCommand { distance, speed, acceleration: 0.1 })
                    }
                    _ => {
                        let [forward, left, turn] = [draw(-0.3, 0.9), draw(-0.1, 0.1), draw(-0.5, 0.5)];
                        Command::Velocity(VelocityCommand { forward, left, turn })
                    }
                };
                (v, left_to_go) = match command {
                    Command::Distance(d) => ([d.speed * d.distance.signum(), 0.0, 0.0], d.distance.abs()),
                    Command::Velocity(c) => ([c.forward, c.left, c.turn], f64::INFINITY),
                    _ => ([0.0; 3], f64::INFINITY),
                };
                walker.pass(end as f64 * 1e-3, Happening::Command(command));
                let [walked_x, walked_y] = *walker.way.last().unwrap();
                assert!(
                    (walked_x - x).hypot(walked_y - y) < 2e-3,
                    "seed {seed}: {walked_x} {walked_y}, {x} {y}"
                );
            }
        }
    }

    #[test]
    fn an_arc_lies_on_its_circle() {
        let mut walker =
            Walker { velocity: VelocityCommand { forward: 0.3, left: 0.0, turn: 0.18 }, ..Walker::default() };
        let radius = 0.3 / 0.18;
        // After hours, too, and then in no more points.
        for (time, points) in [(30.0, 54), (30_000.0, 554)] {
            walker.pass(time, Happening::End);
            assert_eq!(walker.way.len(), points + 1);
            let turned = 0.18 * time;
            let [x, y] = walker.way[points];
            let end = [radius * turned.sin(), radius * (1.0 - turned.cos())];
            assert!((x - end[0]).hypot(y - end[1]) < 1e-3, "{x} {y}, {end:?}");
        }
        for [x, y] in walker.way {
            assert!((x.hypot(y - radius) - radius).abs() < 1e-3, "{x} {y}");
        }
    }

    #[test]
    fn objects_and_pushes_lie_where_the_files_say() {
        assert_eq!(of("uneven")["objects"].as_array().unwrap().len(), 1);
        let push = of("push");
        let pushes: Vec<[f64; 4]> = serde_json::from_value(push["pushes"].clone()).unwrap();
        assert_eq!(pushes.len(), 1);
        assert!(pushes[0][2].hypot(pushes[0][3]) > 10.0, "{push}");
        assert_eq!(of("passing_box")["objects"].as_array().unwrap().len(), 1);
    }
}
