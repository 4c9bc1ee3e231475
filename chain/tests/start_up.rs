//! From a robot on a crane without power to one that walks: the scene `startup`, and what is refused on the way.

use chain::{Chain, Cycle};
use config::{Setup, root};
use messages::command::LowerCommand;
use messages::{Command, Detail, EventCode, GaitState, Process, StartUp};

/// A scene as it is shipped, with the commands that `keep` keeps.
fn scene(keep: impl Fn(f64, &Command) -> bool) -> Setup {
    let mut setup = Setup::load(&root(None), "startup").unwrap();
    setup.scene.commands.retain(|(time, command)| keep(*time, command));
    setup
}

/// What a run said, and the states of the start-up with the ticks at which they began.
#[derive(Debug, Default)]
struct Story {
    events: Vec<(u64, Process, EventCode, Detail)>,
    states: Vec<(u64, StartUp)>,
    /// \[rad\] Furthest that any joint was from where it began.
    moved: f64,
    begun: Option<messages::Joints>,
    last: Cycle,
}

impl Story {
    fn add(&mut self, cycle: &Cycle) {
        let tick = cycle.sensors.header.tick;
        self.events.extend(cycle.events.iter().map(|&(p, code, detail)| (tick, p, code, detail)));
        let state = StartUp::from_number(cycle.sensors.start_up);
        if self.states.last().is_none_or(|last| last.1 != state) {
            self.states.push((tick, state));
        }
        let begun = self.begun.get_or_insert(cycle.sim_state.joint_angle);
        for (now, then) in cycle.sim_state.joint_angle.iter().zip(begun) {
            self.moved = self.moved.max((now - *then).abs());
        }
        self.last = cycle.clone();
    }

    fn of(setup: &Setup, seconds: f64) -> Self {
        let mut chain = Chain::new(setup).unwrap();
        let mut story = Self::default();
        for _ in 0..(seconds / setup.scene.cycle).round() as u64 {
            story.add(chain.step());
        }
        story
    }

    fn order(&self) -> Vec<StartUp> {
        self.states.iter().map(|s| s.1).collect()
    }

    fn told(&self, code: EventCode) -> Option<Detail> {
        self.events.iter().find(|e| e.2 == code).map(|e| e.3)
    }
}

#[test]
fn an_operator_leads_the_robot_from_the_crane_to_a_walk() {
    let story = Story::of(&scene(|_, _| true), 30.0);
    let order = [
        StartUp::Off,
        StartUp::Enabling,
        StartUp::NotHomed,
        StartUp::Homing,
        StartUp::Enabling,
        StartUp::Hanging,
        StartUp::Zeroed,
        StartUp::Standing,
    ];
    assert_eq!(story.order(), order, "{:?} {:?}", story.states, story.events);
    let stands = story.states.last().unwrap().0;
    assert!((5000..9000).contains(&stands), "{:?}", story.states);
    assert!(story.told(EventCode::Homed).is_some() && story.told(EventCode::ForceZeroed).is_some());
    let last = &story.last;
    assert_eq!(last.sim_state.fallen, 0, "{:?}", story.events);
    assert_eq!(last.sim_state.rope, 0.0, "walks on a slack rope");
    assert!(last.sim_state.position[0] > 3.0, "walked {} m: {:?}", last.sim_state.position[0], story.events);
    assert_eq!(GaitState::from(last.controller_state.gait), GaitState::Standing);
}

/// The same scene without what `left_out` names.
fn without(left_out: &[Command]) -> Setup {
    scene(|_, command| !left_out.iter().any(|c| c.address() == command.address()))
}

#[test]
fn without_homing_no_drive_is_switched_on_and_nothing_moves() {
    let story = Story::of(&without(&[Command::Home]), 13.0);
    assert_eq!(story.order().last(), Some(&StartUp::NotHomed));
    assert_eq!(
        story.told(EventCode::NotHomed),
        Some(Detail::Joint(22)),
        "the camera head: {:?}",
        story.events
    );
    assert!(story.told(EventCode::ZeroRefused).is_some() && story.told(EventCode::NotStanding).is_some());
    assert!(story.moved < 5e-3, "held until the drives are on: {} rad", story.moved);
}

/// Lowered, but not zeroed: it does not count as standing, and walking is refused.
#[test]
fn without_zeroed_force_sensors_it_does_not_walk() {
    let story = Story::of(&without(&[Command::ZeroForce]), 13.0);
    assert_eq!(story.order().last(), Some(&StartUp::Hanging));
    let refused = story.events.iter().filter(|e| e.2 == EventCode::NotStanding).count();
    assert_eq!(refused, 2, "{:?}", story.events);
    assert_eq!(story.last.controller_state.plan_id, 0);
}

#[test]
fn without_lowering_it_does_not_walk() {
    let lower = Command::Lower(LowerCommand { distance: 0.0 });
    let story = Story::of(&without(&[lower]), 13.0);
    assert_eq!(story.order().last(), Some(&StartUp::Zeroed));
    assert!(story.told(EventCode::NotStanding).is_some());
    let rope = story.last.sim_state.rope;
    assert!((rope - 60.885 * 9.81).abs() < 5.0, "the rope carries it: {rope} N");
}

/// A knee that is nearly too hot when the robot begins to walk: its drive fails safe, the joint loop stops the others.
#[test]
fn a_winding_that_becomes_too_hot_while_walking_is_named_and_stops_the_robot() {
    let mut setup = scene(|_, _| true);
    setup.robot.protection.as_mut().unwrap().windings[5].continuous_current = 1.0;
    let story = Story::of(&setup, 30.0);
    let tripped = story.told(EventCode::DriveTripped);
    assert_eq!(tripped, Some(Detail::Drive { joint: 5, error: 0x4310 }), "{:?}", story.events);
    assert_eq!(story.order().last(), Some(&StartUp::Stopped));
    let end = &story.last;
    assert!(end.sensors.joint_speed.iter().all(|speed| speed.abs() < 0.1), "at rest");
    assert_eq!(end.sensors.drive_error[5], 0x4310);
}
