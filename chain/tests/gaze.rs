//! Scene `gaze`: where the cameras of the simulated robot really look while it walks.

use chain::Chain;
use config::{Setup, root};
use messages::{Command, EventCode, JointTargets, Process, SimState};
use multibody::{Data, Frame, Model};
use nalgebra::{Rotation3, Vector3};

/// \[rad\] Largest error of pursuit, on soles that slip.
const PURSUIT: f64 = 0.008;

/// The robot as it really is.
struct Truth {
    model: Model,
    data: Data,
    camera: Frame,
    q: Vec<f64>,
}

impl Truth {
    fn new(setup: &Setup) -> Self {
        let robot = &setup.robot;
        let model = robot.model().unwrap();
        let head = robot.head.as_ref().unwrap();
        let camera = model.frame(&head.link, head.camera).unwrap();
        Self { data: Data::new(&model), camera, q: model.neutral(), model }
    }

    /// \[rad\] Angle between the optical axis and the way to a point.
    fn error(&mut self, s: &SimState, point: &Vector3<f64>) -> f64 {
        let [x, y, z, w] = s.orientation;
        self.q[7..].copy_from_slice(&s.joint_angle[..self.model.n()]);
        let turn = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        // The base stays at its neutral attitude; the point is brought into its axes instead.
        self.model.forward_kinematics(&mut self.data, &self.q);
        let pose = self.model.frame_pose(&self.data, &self.camera);
        let seen = turn.inverse() * (point - Vector3::from(s.position));
        let sight = seen - pose.translation.vector;
        let axis = pose.rotation * Vector3::x();
        axis.cross(&sight).norm().atan2(axis.dot(&sight))
    }
}

/// A point of a frame (x, y, heading) in the frame around it.
fn in_world([x, y, heading]: &[f64; 3], point: &[f64; 3]) -> Vector3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), *heading) * Vector3::from(*point)
        + Vector3::new(*x, *y, 0.0)
}

/// A jump as it was done: when it began and how long it was to take \[s\].
#[derive(Debug)]
struct Saccade {
    begin: f64,
    planned: f64,
}

#[test]
fn the_cameras_look_where_they_are_told_while_lola_walks() {
    let setup = Setup::load(&root(None), "gaze").unwrap();
    let head = setup.robot.head.clone().unwrap();
    let mut chain = Chain::new(&setup).unwrap();
    let mut truth = Truth::new(&setup);
    let dt = setup.scene.cycle;
    let mut goal: Option<(f64, [f64; 3])> = None;
    let mut commands = setup.scene.commands.iter().filter(|(_, c)| c.address().0.name() == "head").peekable();
    let mut saccades: Vec<Saccade> = Vec::new();
    let mut before = JointTargets::default();
    let (mut speed, mut acceleration) = (0.0f64, 0.0f64);
    let (mut worst, mut square, mut cycles) = (0.0f64, 0.0, 0.0);
    let mut lost = 0.0f64;
    // I_0: the middle of the sole frames where the robot begins.
    let feet = chain.robot().state().feet;
    let start = [0, 1, 3].map(|i| 0.5 * (feet[0][i] + feet[1][i]));
    let mut swayed = [f64::INFINITY, f64::NEG_INFINITY];
    for k in 1..=(setup.scene.duration / dt) as u64 {
        let t = k as f64 * dt;
        while let Some((_, command)) = commands.next_if(|(at, _)| *at <= t + 1e-9) {
            goal = if let Command::Fixate(f) = command { Some((t, f.point)) } else { None };
        }
        let c = chain.step();
        for (process, code, detail) in &c.events {
            assert!(!matches!(code, EventCode::HeadRefused | EventCode::GazeHeld), "{process:?} {code:?}");
            if *code == EventCode::Saccade {
                assert_eq!(*process, Process::Controller);
                saccades.push(Saccade { begin: t, planned: detail.pack() as f64 * 1e-6 });
            }
        }
        for j in [head.pan, head.tilt] {
            speed = speed.max(c.joint_targets.speed[j].abs());
            let change = c.joint_targets.speed[j] - before.speed[j];
            acceleration = acceleration.max(change.abs() / dt);
        }
        before = c.joint_targets;
        assert_eq!(c.sim_state.fallen, 0);
        if let Some((since, point)) = goal {
            let landed = saccades.iter().all(|s| t > s.begin + s.planned + 0.05);
            if landed && t > since + 0.2 {
                let (sim, state) = (&c.sim_state, &c.controller_state);
                let e = truth.error(sim, &in_world(&start, &point));
                worst = worst.max(e);
                let believed = in_world(&start, &in_world(&state.origin, &state.com).into());
                lost = lost.max((Vector3::from(sim.com) - believed).xy().norm());
                square += e * e;
                cycles += 1.0;
                swayed[0] = swayed[0].min(c.sim_state.joint_angle[head.pan]);
                swayed[1] = swayed[1].max(c.sim_state.joint_angle[head.pan]);
            }
        }
    }
    let rms = 1e3 * f64::sqrt(square / cycles);
    println!("in pursuit, {:.1} s: {:.2} mrad at most, {rms:.2} rms", cycles * dt, 1e3 * worst);
    println!("odometry of the planned footholds is {:.0} mm beside by then", 1e3 * lost);
    println!("pan {:.2} to {:.2} rad meanwhile", swayed[0], swayed[1]);
    println!("peaks {speed:.3} rad/s, {acceleration:.1} rad/s^2; {saccades:.2?}");
    assert!(cycles * dt > 8.0, "most of the time it is pursuit");
    assert!(swayed[1] - swayed[0] > 0.5, "the head had something to make up for");
    assert!(worst < PURSUIT, "{worst} rad beside the point");
    assert_eq!(saccades.len(), 4, "one per command: {saccades:?}");
    assert!(saccades.iter().all(|s| s.planned < 1.0), "{saccades:?}");
    assert!(speed <= 1.02 * head.saccade_speed, "{speed} rad/s");
    assert!(acceleration <= 1.05 * head.acceleration, "{acceleration} rad/s^2");
}
