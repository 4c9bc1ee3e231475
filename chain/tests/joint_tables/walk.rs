//! Archie's own walk from tables: planner, controller, joint loop and simulated robot.

use chain::Chain;
use codec::interpreter::{BG, QP, Telegram};
use config::pattern::{Pattern, TorsoHeight};
use config::{Gait, Setup, root};
use lowlevel::joint_loop::LoopState;
use messages::command::VelocityCommand;
use messages::{BusFrames, Command, Detail, EventCode, JointTables, TableFault};

use crate::joint_tables::remove;
use crate::joint_tables::rig::Rig;

/// The shipped scene with whole steps of another pattern, on type 1, whose joints follow their drives exactly.
fn setup(change: impl Fn(&mut Pattern)) -> Setup {
    let mut setup = Setup::load(&root(None), "archie_tables").unwrap();
    let mut pattern = setup.gait.pattern.unwrap();
    change(&mut pattern);
    setup.gait = Gait::from(pattern);
    setup.scene.depth = 1;
    let forward = VelocityCommand { forward: pattern.length / pattern.step_time, left: 0.0, turn: 0.0 };
    setup.scene.commands[1].1 = Command::Velocity(forward);
    setup
}

/// Thesis 4.3, in the step time nearest to 2 s that the drives can play: all its times are 0.8 % longer.
fn example(p: &mut Pattern) {
    (p.step_time, p.double_support, p.over_time) = (2.016, 0.4032, 1.2096);
    (p.low_time, p.high_time) = (0.08064, 1.2096);
    p.pitch_times = [0.08064, 1.9152, 2.29824];
    (p.length, p.over_length, p.leave, p.land) = (0.2, 0.2, 0.2, 0.3);
    (p.end_ahead, p.start_behind) = (0.07, 0.07);
}

/// Run of a scene: tables, in which cycles the drives began with them, and with each of them the largest distance \[deg\] of
/// a joint from its target.
struct Played {
    tables: Vec<JointTables>,
    begun: Vec<u64>,
    apart: Vec<f64>,
}

fn play(setup: &Setup, mut every_cycle: impl FnMut(&Chain)) -> Played {
    let mut chain = Chain::new(setup).unwrap();
    let mut played = Played { tables: Vec::new(), begun: Vec::new(), apart: Vec::new() };
    for tick in 1..=(setup.scene.duration / setup.scene.cycle) as u64 {
        let c = chain.step();
        for (_, code, detail) in &c.events {
            assert!(
                !matches!(code, EventCode::TablesRefused | EventCode::PlanRefused),
                "{code:?} {detail:?} at {tick}"
            );
            if *code == EventCode::TablesBegun {
                played.begun.push(tick);
                played.apart.push(0.0);
            }
        }
        let apart = (0..12).map(|j| (c.sim_state.joint_angle[j] - c.joint_targets.angle[j]).abs());
        if let Some(most) = played.apart.last_mut() {
            *most = most.max(apart.fold(0.0, f64::max).to_degrees());
        }
        played.tables.extend(chain.parts().1.tables());
        every_cycle(&chain);
    }
    played
}

/// Thesis 6.2 with the spline of z_h: the counts that a second program has for its right leg at t = 0, from ankle to hip, in
/// the table of the first whole stride, and on the bus.
#[test]
fn the_first_points_of_a_stride_are_the_published_ones() {
    let setup = setup(|p| (p.height, p.start_height) = (TorsoHeight::Spline, 0.542));
    let mut sent = 0;
    // The second walking plan stands behind the first one in the drives.
    let frame = Telegram::set(QP, 513, -7644).frame(0, 0x305);
    let played =
        play(&setup, |chain| sent += chain.told().as_slice().iter().filter(|f| **f == frame).count());
    let stride = &played.tables[2];
    assert_eq!([5, 4, 3, 2, 1, 0].map(|j| stride.of(j)[0]), [2596, -7644, 11669, -4025, -2596, 0]);
    assert_eq!((stride.points, stride.spacing, sent), (512, 250, 1));
}

/// From standing, into the walk, from plan to plan in mid-walk, through a stop to the end: joints are where the targets say.
/// Points are off by half a count of 0.00625 deg, cubics through such points by at most 5/4 of that, and by their own error,
/// which a second program has. Tables begin with their plans, and end at rest.
#[test]
fn the_drives_are_where_the_targets_are() {
    // Of a stride, cubics' error; tables that are played, and from which of them on the walk is periodic.
    for (name, cubics, tables, periodic) in [("6.2", 0.0012, 4, 0), ("4.3", 0.0023, 10, 4)] {
        let mut setup = if name == "4.3" { setup(example) } else { setup(|_| ()) };
        // The faster walk falls over on the ground without a stabilizer.
        let startup = Setup::load(&root(None), "archie_startup").unwrap();
        setup.scene.crane = startup.scene.crane.filter(|_| name == "4.3");
        let Played { tables: made, begun, apart } = play(&setup, |_| ());
        println!("{name}: {apart:.5?} deg, tables begun {begun:?}");
        assert!(apart.iter().all(|apart| *apart <= 0.625 * 0.00625 + cubics), "{name}: {apart:?} deg");
        assert!(apart[periodic..].iter().all(|apart| *apart <= 0.004), "{name}: {apart:?} deg");
        let starts: Vec<u64> = made.iter().map(|t| t.start_tick).collect();
        assert_eq!((begun.len(), begun), (tables, starts), "{name}");
        let rests = |t: &JointTables, j: usize| t.of(j).ends_with(&[t.of(j)[t.points as usize - 1]; 2]);
        assert!(made.iter().all(|t| (0..12).all(|j| rests(t, j))), "{name}");
    }
}

/// Told to walk while he stands up, to stop in the first step, and to walk again at once: the drives have room for each plan
/// beside the one that they play, long or short.
#[test]
fn a_plan_has_room_beside_any_other() {
    let walk = Command::Velocity(VelocityCommand { forward: 0.0208, left: 0.0, turn: 0.0 });
    for (told, tables) in [
        (vec![(3.1, walk), (20.0, Command::Stop)], 4),
        (vec![(3.0, walk), (4.3, Command::Stop), (5.2, walk), (60.0, Command::Stop)], 7),
    ] {
        let mut setup = setup(|_| ());
        let end = told[told.len() - 1].0;
        setup.scene.commands = std::iter::once((0.2, Command::Stand)).chain(told).collect();
        setup.scene.duration = end + 36.0;
        let played = play(&setup, |_| ());
        assert!(played.begun.len() >= tables, "{:?}", played.begun);
        assert!(played.apart.iter().all(|apart| *apart <= 0.004), "{:?} deg", played.apart);
    }
}

/// Ankles bent by 0.02 rad with the soles not flat, which no plan has: the first table leads them from where they rest.
#[test]
fn the_first_table_comes_from_where_the_joints_rest() {
    let mut setup = setup(|_| ());
    let pose = setup.robot.poses.get_mut("stand").unwrap();
    (pose[4], pose[10]) = (pose[4] + 0.02, pose[10] - 0.02);
    setup.scene.duration = 5.0;
    let played = play(&setup, |_| ());
    let counts = |j: usize| [0, 26].map(|i| played.tables[0].of(j)[i]);
    // 0.02 rad are 183 of the 6240 counts of the pose.
    assert_eq!((counts(4), counts(10)), ([-6057, -7262], [6057, 7262]));
    assert!(played.apart.iter().all(|apart| *apart <= 0.004), "{:?} deg", played.apart);
}

/// He is told to stand while the way to or from a drive is bent.
fn bent(to: bool, bend: impl FnMut(u64, &mut BusFrames) + 'static) -> Option<(usize, usize, TableFault)> {
    let mut rig = Rig::waiting();
    let way = if to { &mut rig.to_drives } else { &mut rig.from_drives };
    *way = Some(Box::new(bend));
    rig.cycle_with(&[Command::Stand]);
    let still = rig.angles();
    rig.cycles(400);
    if rig.refusal().is_some() {
        let moved = rig.angles().iter().zip(&still).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(moved < 1e-9, "moved by {moved}: {:?}", rig.events);
        assert_eq!(rig.joints.state(), LoopState::Stop(EventCode::TablesRefused), "{:?}", rig.events);
        assert_eq!(rig.when(EventCode::TablesBegun), None);
    }
    rig.refusal()
}

/// Right knee: drive 4, joint 3; left hip adduction: drive 8, joint 7.
#[test]
fn a_plan_whose_tables_do_not_arrive_moves_nothing() {
    assert_eq!(bent(false, |_, _| ()), None);
    let wrong = bent(false, |_, frames| {
        for frame in &mut frames.frames[..frames.count as usize] {
            if Telegram::of(frame).is_some_and(|t| frame.id == 0x284 && t.letters == QP && t.index == 17) {
                frame.data[4] ^= 1;
            }
        }
    });
    assert_eq!(wrong, Some((3, 17, TableFault::WrongAnswer)));
    let missing = bent(false, |_, frames| _ = remove(frames, 0x284, *b"PT", 0));
    assert_eq!(missing, Some((3, 0, TableFault::NoAnswer)));
    let not_armed = bent(true, |_, frames| _ = remove(frames, 0x308, BG, 0));
    assert_eq!(not_armed, Some((7, 0, TableFault::NotArmed)));
}

/// A plan that starts before its tables can be in the drives is not followed; the robot stands, and nothing is sent.
#[test]
fn a_plan_that_comes_too_late_for_its_tables_is_refused() {
    let mut rig = Rig::waiting();
    rig.cycle_with(&[Command::Stand]);
    // 27 points: 2 cycles to fill, 1 to check, 8 to load, 10 to spare, 20 to announce.
    let mut refused_at = |ahead: u64, id: u64| {
        let walker = rig.walker.as_mut().unwrap();
        let plan = walker.plan.as_mut().unwrap();
        (plan.id, plan.start_tick) = (id, rig.tick + 1 + ahead);
        rig.cycle();
        let walker = rig.walker.as_mut().unwrap();
        walker.controller.events().drain().any(|e| e == (EventCode::PlanRefused, Detail::Plan(id)))
    };
    assert!(refused_at(40, 7));
    assert!(!refused_at(41, 8));
}
