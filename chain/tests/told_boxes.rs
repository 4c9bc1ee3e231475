//! A box that somebody tells of is the same box as one of the scene.

use chain::Chain;
use config::{Setup, root};
use messages::command::{BoxCommand, VelocityCommand};
use messages::{Command, EventCode};

/// A walk without a fall: each plan, and how far she came \[m\].
struct Walk {
    plans: Vec<String>,
    way: f64,
}

fn walk(setup: &Setup) -> Walk {
    let mut chain = Chain::new(setup).expect("a shipped scene, or nearly");
    let (mut plans, mut way) = (Vec::new(), 0.0);
    for _ in 0..(setup.scene.duration / setup.scene.cycle) as u64 {
        let cycle = chain.step();
        assert_eq!(cycle.sim_state.fallen, 0, "at {} m", cycle.sim_state.position[0]);
        // All digits: the same text is the same bits, but for the sign of NaN.
        plans.extend(cycle.plan.iter().map(|plan| format!("{plan:?}")));
        way = cycle.sim_state.position[0];
    }
    Walk { plans, way }
}

/// The scene's object is not known to the scene.
fn unknown(setup: &Setup) -> Setup {
    let mut blind = setup.clone();
    blind.scene.objects[0].known = false;
    blind
}

/// The same, but told when the scene begins.
fn told(setup: &Setup, height: f64) -> Setup {
    let (mut told, begin) = (unknown(setup), setup.start().unwrap());
    let pose = &setup.scene.objects[0].pose;
    let base = [pose.position[0] - begin.x, pose.position[1] - begin.y, 0.0];
    let seen = BoxCommand { id: 3, base, yaw: pose.rotation[2], size: [0.06, 1.2, height], lifetime: 60.0 };
    told.scene.commands.insert(0, (0.0, Command::Box(seen)));
    told
}

/// Random numbers between two ends, of `SEED` or of this seed.
fn random(seed: u64) -> impl FnMut(f64, f64) -> f64 {
    let mut x = std::env::var("SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(seed);
    move |low, high| {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        low + (high - low) * (x >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[test]
fn a_box_that_is_told_is_stepped_over_as_one_of_the_scene_bit_for_bit() {
    let setup = Setup::load(&root(None), "obstacle").unwrap();
    let (known, told) = (walk(&setup), walk(&told(&setup, 0.1)));
    assert!(known.plans.len() > 10 && known.way > 2.0, "{} plans, {} m", known.plans.len(), known.way);
    for (k, (known, told)) in known.plans.iter().zip(&told.plans).enumerate() {
        assert_eq!(known, told, "plan {k}");
    }
    assert_eq!((known.plans.len(), known.way), (told.plans.len(), told.way));
}

/// Anywhere, at any angle: the same but for the last bits of a sum, and then for the micrometres that these become.
#[test]
fn a_box_that_is_told_anywhere_is_walked_over_as_one_of_the_scene() {
    let (mut setup, mut random) = (Setup::load(&root(None), "obstacle").unwrap(), random(28));
    for _ in 0..6 {
        let pose = &mut setup.scene.objects[0].pose;
        pose.position = [random(1.2, 2.4), random(-0.3, 0.3), 0.05];
        pose.rotation = [0.0, 0.0, random(-0.4, 0.4)];
        let at = (pose.position, pose.rotation);
        let (known, told) = (walk(&setup), walk(&told(&setup, 0.1)));
        assert_eq!(known.plans.len(), told.plans.len(), "{at:?}");
        assert!((known.way - told.way).abs() < 1e-5, "{at:?}: {} m and {} m", known.way, told.way);
    }
}

/// Otherwise the tests above would be passed by a planner that hears nothing.
#[test]
fn a_box_that_is_not_told_changes_the_plans() {
    let setup = Setup::load(&root(None), "obstacle").unwrap();
    let mut empty = unknown(&setup);
    empty.scene.objects.clear();
    let (known, blind) = (walk(&setup), walk(&empty));
    assert!(known.plans.iter().zip(&blind.plans).any(|(a, b)| a != b));
}

/// A box whose top is the ground: she walks as if nobody had told.
#[test]
fn a_box_under_the_ground_changes_no_plan() {
    let mut setup = Setup::load(&root(None), "obstacle").unwrap();
    let mut buried = told(&setup, 0.1);
    let Command::Box(seen) = &mut buried.scene.commands[0].1 else { panic!("a box is told first") };
    seen.base[2] = -0.1;
    setup.scene.objects.clear();
    buried.scene.objects.clear();
    assert_eq!(walk(&setup).plans, walk(&buried).plans);
}

/// A box too high to be stepped over is stopped before, and she stands.
#[test]
fn a_high_box_is_stopped_before() {
    let setup = Setup::load(&root(None), "obstacle").unwrap();
    let mut wall = told(&setup, 0.6);
    wall.scene.objects.clear();
    let begin = setup.start().unwrap();
    let way = walk(&wall).way;
    let toes = setup.robot.feet[0].support[1];
    assert!(way > 0.5 && way + toes < 1.47 - begin.x, "she stands at {way} m, her toes {toes} m ahead");
}

/// Boxes at random instants and places, under the foot that is about to land too, told to a robot that walks on.
#[test]
fn boxes_at_random_do_not_throw_her() {
    let mut setup = Setup::load(&root(None), "obstacle").unwrap();
    setup.scene.objects.clear();
    let (mut stops, mut random) = (0, random(5));
    let mut chain = Chain::new(&setup).unwrap();
    for tick in 1..60_000u32 {
        let cycle = chain.step();
        let ([x, y, _], fallen) = (cycle.sim_state.position, cycle.sim_state.fallen);
        assert_eq!(fallen, 0, "at tick {tick}");
        stops += cycle.events.iter().filter(|e| e.1 == EventCode::ObstacleTooHigh).count();
        if tick > 4000 && tick % 70 == 0 {
            chain.command(&Command::Velocity(VelocityCommand { forward: 0.278, left: 0.0, turn: 0.0 }));
        }
        if tick > 4000 && random(0.0, 1.0) < 1e-3 {
            let (id, lifetime) = (random(1.0, 6.0) as u32, random(0.1, 3.0));
            let base = [x + random(-0.3, 0.9), y + random(-0.4, 0.4), 0.0];
            let size = [random(0.02, 0.2), random(0.1, 1.0), random(0.01, 0.25)];
            let seen = BoxCommand { id, base, yaw: random(-3.0, 3.0), size, lifetime };
            chain.command(&Command::Box(seen));
        }
    }
    assert!(stops > 3 && chain.last().sim_state.position[0] > 2.0, "{stops} stops: nothing was tried");
}
