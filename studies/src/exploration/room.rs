//! Rooms: four walls, boxes at random places, and people who walk about between them.

use std::f64::consts::PI;

use config::terrain::{ObjectShape, TerrainObject, TerrainPose};

use crate::random::Random;

/// \[m\] Sides of the room along x and y, thickness and height of its walls.
const SIDES: [f64; 2] = [7.0, 4.0];
const WALL: f64 = 0.1;
const WALL_HEIGHT: f64 = 1.2;
/// \[m\] How far the robot begins from the wall behind it, in the middle of the other two.
const BEHIND: f64 = 1.2;
/// \[m\] Room about the robot's start that stays free, and about a box for who walks past it.
const START: f64 = 1.0;
const PASSAGE: f64 = 0.35;
/// \[m\] Boxes: sides along the floor, height.
const SIDE: [f64; 2] = [0.3, 0.8];
const HEIGHT: [f64; 2] = [0.25, 1.2];
/// People: \[m\] depth, width and height, \[m/s\] speed, \[s\] rest at each place, \[m\] how near they come to a robot's feet.
const PERSON: [f64; 3] = [0.3, 0.45, 1.7];
const PERSON_SPEED: [f64; 2] = [0.2, 0.5];
const REST: [f64; 2] = [2.0, 8.0];
const KEEPS_CLEAR: f64 = 0.8;
/// Places in a row that nobody who is not shut in finds out of reach.
const TRIED: u32 = 1000;

/// A rectangle of the floor that something stands on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    /// \[m\] @world
    middle: [f64; 2],
    /// \[m\]
    half: [f64; 2],
    /// \[rad\]
    yaw: f64,
}

impl Rectangle {
    /// \[m\] From a point @world; 0 inside.
    pub(super) fn distance(&self, at: [f64; 2]) -> f64 {
        let (sin, cos) = self.yaw.sin_cos();
        let [dx, dy] = [at[0] - self.middle[0], at[1] - self.middle[1]];
        let local = [cos * dx + sin * dy, cos * dy - sin * dx];
        let [ox, oy] = [0, 1].map(|i| (local[i].abs() - self.half[i]).max(0.0));
        ox.hypot(oy)
    }

    /// \[m\] @world Its corners, once around.
    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let (sin, cos) = self.yaw.sin_cos();
        [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[a, b]| {
            let [x, y] = [a * self.half[0], b * self.half[1]];
            [self.middle[0] + cos * x - sin * y, self.middle[1] + sin * x + cos * y]
        })
    }
}

/// A room, in the world: the robot begins at its origin, x ahead.
pub(super) struct Room {
    /// Walls and boxes.
    pub(super) standing: Vec<Rectangle>,
    /// All of it, for a scene.
    pub(super) objects: Vec<TerrainObject>,
    /// \[m\] @world Its inside: from, to.
    pub(super) inside: [[f64; 2]; 2],
}

impl Room {
    /// The room of a seed, with so many boxes, and so many people who walk for `time` \[s\].
    pub(super) fn draw(seed: u64, boxes: usize, people: usize, time: f64) -> Self {
        let mut random = Random(seed);
        let inside = [[-BEHIND, -0.5 * SIDES[1]], [SIDES[0] - BEHIND, 0.5 * SIDES[1]]];
        let mut room = Self { standing: Vec::new(), objects: Vec::new(), inside };
        room.add_walls();
        // Boxes anywhere but on the robot, then people, whose ways lead around them.
        for k in 0..boxes {
            let place = |random: &mut Random| Rectangle {
                middle: [0, 1].map(|i| random.within([inside[0][i], inside[1][i]])),
                half: [0.5 * random.within(SIDE), 0.5 * random.within(SIDE)],
                yaw: random.within([-PI, PI]),
            };
            let rectangle = loop {
                let rectangle = place(&mut random);
                if rectangle.distance([0.0; 2]) > START {
                    break rectangle;
                }
            };
            room.stand(&format!("box {}", k + 1), rectangle, random.within(HEIGHT));
        }
        for k in 0..people {
            let person = room.person(&format!("person {}", k + 1), time, &mut random);
            room.objects.push(person);
        }
        room
    }

    fn add_walls(&mut self) {
        let [low, high] = self.inside;
        for (name, axis, at) in
            [("wall behind", 0, low), ("wall ahead", 0, high), ("right wall", 1, low), ("left wall", 1, high)]
        {
            let mut middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
            middle[axis] = at[axis] + 0.5 * WALL * (at[axis] - middle[axis]).signum();
            let mut half = [0.5 * SIDES[0] + WALL, 0.5 * SIDES[1] + WALL];
            half[axis] = 0.5 * WALL;
            self.stand(name, Rectangle { middle, half, yaw: 0.0 }, WALL_HEIGHT);
        }
    }

    fn stand(&mut self, name: &str, rectangle: Rectangle, height: f64) {
        let Rectangle { middle: [x, y], half, yaw } = rectangle;
        self.standing.push(rectangle);
        let size = [2.0 * half[0], 2.0 * half[1], height];
        self.objects.push(object(name, size, pose([x, y], yaw, height)));
    }

    /// Someone who walks from place to place, never through what stands there.
    fn person(&self, name: &str, end: f64, random: &mut Random) -> TerrainObject {
        let is_free = |at: [f64; 2]| self.standing.iter().all(|r| r.distance(at) > PASSAGE);
        let [low, high] = self.inside;
        let place = |random: &mut Random| loop {
            let at = [0, 1].map(|i| random.within([low[i], high[i]]));
            if is_free(at) {
                break at;
            }
        };
        let start = loop {
            let at = place(random);
            if at[0].hypot(at[1]) > START + KEEPS_CLEAR {
                break at;
            }
        };
        let mut person =
            TerrainObject { keeps_clear: KEEPS_CLEAR, ..object(name, PERSON, pose(start, 0.0, PERSON[2])) };
        let (mut time, mut at, mut yaw, mut missed) = (0.0, start, 0.0, 0);
        // Among many boxes someone may be shut in, and stands there.
        while time < end && missed < TRIED {
            let to = place(random);
            let [dx, dy] = [to[0] - at[0], to[1] - at[1]];
            let straight =
                (0..=100).all(|i| is_free([0, 1].map(|k| at[k] + f64::from(i) / 100.0 * [dx, dy][k])));
            if !straight || dx.hypot(dy) < 0.5 {
                missed += 1;
                continue;
            }
            missed = 0;
            // Turns within the rest, and then goes.
            time += random.within(REST);
            yaw = nearest_turn(yaw, dy.atan2(dx));
            person.poses.push((time, pose(at, yaw, PERSON[2])));
            time += dx.hypot(dy) / random.within(PERSON_SPEED);
            person.poses.push((time, pose(to, yaw, PERSON[2])));
            at = to;
        }
        person
    }
}

/// The angle that is `to` but for whole turns, and nearest to `from` \[rad\].
fn nearest_turn(from: f64, to: f64) -> f64 {
    from + (to - from + PI).rem_euclid(2.0 * PI) - PI
}

fn pose([x, y]: [f64; 2], yaw: f64, height: f64) -> TerrainPose {
    TerrainPose { position: [x, y, 0.5 * height], rotation: [0.0, 0.0, yaw] }
}

fn object(name: &str, size: [f64; 3], pose: TerrainPose) -> TerrainObject {
    TerrainObject {
        name: name.into(),
        shape: ObjectShape::Box(size),
        pose,
        friction: None,
        appears: 0.0,
        vanishes: f64::INFINITY,
        known: false,
        keeps_clear: 0.0,
        poses: Vec::new(),
    }
}
