//! The simulated robot at the end of the bus: power, pushes, falls, repeatability.

use codec::frames::{DriveCommand, decode_sensors, encode_targets};
use config::{Setup, root};
use messages::command::PushCommand;
use messages::{BusFrames, EventCode, JointMode, JointTargets, Power, Sensors, SimState};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use sim_backend::SimBackend;

fn setup() -> Setup {
    Setup::load(&root(None), "stand").unwrap()
}

/// Controlwords that switch all drives on.
fn enabling(tick: u64) -> [u32; messages::MAX_JOINTS] {
    [if tick == 1 { 0x06 } else { 0x0F }; messages::MAX_JOINTS]
}

/// Holds the start pose for `cycles` with the supply on, `until` that cycle; gives the last truth and sensors.
fn hold(sim: &mut SimBackend, setup: &Setup, cycles: u64, until: u64) -> (SimState, Sensors) {
    let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
    for (j, q) in setup.robot.poses[&setup.scene.start_pose].iter().enumerate() {
        targets.angle[j] = *q;
    }
    let (mut frames, mut sensors) = (BusFrames::default(), Sensors::default());
    for tick in 1..=cycles {
        targets.header.tick = tick;
        encode_targets(
            &setup.robot.layout,
            &DriveCommand { targets, control: enabling(tick), ..DriveCommand::default() },
            &mut frames,
        );
        let power = Power { toggle: tick.min(until), on: 1, arming: 1, ..Power::default() };
        let (answer, _) = sim.step(Some(&frames), Some(&power));
        assert_eq!(decode_sensors(&setup.robot.layout, answer, &mut sensors).missed(), 0);
    }
    (*sim.state(), sensors)
}

#[test]
fn a_still_robot_reads_its_weight_and_gravity() {
    let setup = setup();
    let (truth, sensors) =
        hold(&mut SimBackend::new(&setup.robot, &setup.scene).unwrap(), &setup, 3000, u64::MAX);
    let fz: f64 = sensors.foot_wrench.iter().map(|w| w.force[2]).sum();
    assert!((fz - 60.885 * 9.81).abs() < 0.5, "{fz} N");
    assert!((sensors.imu.acceleration[2] - 9.81).abs() < 0.01);
    assert!(truth.fallen == 0 && sensors.power == 1);
}

#[test]
fn power_falls_with_the_toggle_and_the_joints_stay_where_they_are() {
    let setup = setup();
    let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
    let (truth, sensors) = hold(&mut sim, &setup, 110, 100);
    assert_eq!((truth.power, sensors.power), (0, 0), "off after cycles without a toggle");
    assert!((0..24).all(|j| sensors.joint_speed[j] == 0.0));
}

#[test]
fn a_push_moves_the_momentum_by_its_impulse_and_a_large_one_fells() {
    let setup = setup();
    let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
    hold(&mut sim, &setup, 1000, u64::MAX);
    let before = sim.state().com;
    sim.push(&PushCommand { force: [60.0, 0.0, 0.0], duration: 0.01 });
    hold(&mut sim, &setup, 10, u64::MAX);
    // 0.6 N s on 60.885 kg, before the feet have answered.
    assert!(sim.state().com[0] - before[0] > 0.2 * 0.6 / 60.885 * 0.01, "{:?}", sim.state().com);
    assert_eq!(sim.events().pop(), None);
    sim.push(&PushCommand { force: [0.0, 2000.0, 0.0], duration: 0.2 });
    hold(&mut sim, &setup, 3000, u64::MAX);
    assert_eq!(sim.state().fallen, 1);
    assert!(sim.events().drain().any(|(code, _)| code == EventCode::Fallen));
}

/// A force sensor of a robot that is pushed, filtered and late, read every millisecond: against the differential equation of
/// its filter on the forces of every twentieth of that, from a simulation with shorter cycles.
#[test]
fn sensors_see_what_is_between_two_readings() {
    let (time, delay, steps) = (0.8e-3, 0.33e-3, 20);
    let readings = |cycle: f64, substeps: u32, sensors: config::SensorErrors| {
        let mut setup = setup();
        (setup.scene.cycle, setup.scene.substeps, setup.scene.sensors) = (cycle, substeps, sensors);
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        let mut sensors = Sensors::default();
        let mut cycle_of = |k: u32| {
            if k == 1 {
                sim.push(&PushCommand { force: [0.0, 300.0, 400.0], duration: 0.004 });
            }
            let (frames, _) = sim.step(None, None);
            decode_sensors(&setup.robot.layout, frames, &mut sensors);
            sensors.foot_wrench[0].force
        };
        (1..=(0.03 / cycle) as u32).map(&mut cycle_of).collect::<Vec<_>>()
    };
    let h = 1e-3 / f64::from(steps);
    let fine = readings(h, 1, config::SensorErrors::default());
    let force_torque = config::sensors::ForceTorqueErrors { filter_time: time, delay, ..Default::default() };
    let coarse = readings(1e-3, steps, config::SensorErrors { force_torque, ..Default::default() });
    for axis in 0..3 {
        // Euler with a hundredth of the step, input on chords.
        let (mut y, mut way) = (fine[0][axis], Vec::new());
        for pair in fine.windows(2) {
            for k in 0..100 {
                let u = pair[0][axis] + f64::from(k) / 100.0 * (pair[1][axis] - pair[0][axis]);
                way.push(y);
                y += h / 100.0 / time * (u - y);
            }
        }
        let swing = |x: &[[f64; 3]]| x.iter().map(|f| (f[axis] - fine[0][axis]).abs()).fold(0.0, f64::max);
        for (i, read) in coarse.iter().enumerate().skip(2) {
            // The first fine reading is one step after the start.
            let t = 1e-3 * (i + 1) as f64 - delay - h;
            let expected = way[(t / h * 100.0).round() as usize];
            let wrong = (read[axis] - expected).abs();
            assert!(wrong < 0.01 * swing(&fine), "axis {axis}, {i} ms: {wrong} of {}", swing(&fine));
        }
    }
}

#[test]
fn two_simulations_are_bit_for_bit_the_same() {
    let setup = setup();
    let run = || hold(&mut SimBackend::new(&setup.robot, &setup.scene).unwrap(), &setup, 500, 300);
    assert_eq!(run(), run());
}

#[test]
fn a_robot_with_a_wrong_link_name_is_refused() {
    let mut setup = setup();
    setup.robot.feet[0].sensor_link = "right_foott".into();
    let error = SimBackend::new(&setup.robot, &setup.scene).err().expect("refused").to_string();
    assert!(error.contains("right_foott"), "{error}");
}

/// Ground, soles and calibration that the software does not know of (`[plant_mismatch]`), each against its closed form.
#[test]
fn on_tilted_ground_the_robot_stands_by_friction_and_slides_beyond_it() {
    let mut setup = setup();
    setup.robot.contact.friction = 0.1;
    for (tilt, slides) in [(0.03_f64, false), (0.15, true)] {
        setup.scene.plant_mismatch.ground_tilt = [0.0, tilt];
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        let (truth, _) = hold(&mut sim, &setup, if slides { 1000 } else { 8000 }, u64::MAX);
        let sum = |k: usize| truth.foot_wrench.iter().map(|w| w.force[k]).sum::<f64>();
        let (normal, along) =
            (sum(0) * tilt.sin() + sum(2) * tilt.cos(), sum(0) * tilt.cos() - sum(2) * tilt.sin());
        let way = truth.position[0];
        if slides {
            // Down the hill, and friction holds back with mu times the normal force.
            assert!(way > 0.1 && (along / normal + 0.1).abs() < 1e-3, "{way} m, {along} N of {normal} N");
        } else {
            assert!((sum(2) - 60.885 * 9.81).abs() < 0.5, "{} N, {way} m, {}", sum(2), truth.fallen);
            assert!((along / normal + tilt.tan()).abs() < 1e-3, "{along} N of {normal} N, {way} m");
            assert!(truth.fallen == 0 && way.abs() < 0.1, "{way} m");
        }
    }
}

/// The soles lie on the ground from the first cycle on, all of them.
#[test]
fn on_tilted_ground_the_robot_begins_on_flat_soles() {
    let mut setup = setup();
    for tilt in [[0.08, 0.0], [-0.05, 0.05], [0.0, -0.08]] {
        setup.scene.plant_mismatch.ground_tilt = tilt;
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        let (truth, _) = hold(&mut sim, &setup, 1, u64::MAX);
        // A quarter of the weight or more on each foot, each of whose edges would be 8 mm or more over ground they did not lie on.
        let normal = tilt[0].cos() * tilt[1].cos() * setup.robot.weight();
        let loads = truth.foot_wrench.map(|w| w.force[2] / normal);
        assert!(loads.iter().all(|load| (load - 0.5).abs() < 0.02), "{tilt:?}: {loads:?}");
        let up = UnitQuaternion::from_quaternion(Quaternion::from(truth.orientation)) * Vector3::z();
        let [roll, pitch] = tilt;
        let expected = Vector3::new(pitch.sin() * roll.cos(), -roll.sin(), pitch.cos() * roll.cos());
        assert!((up - expected).norm() < 1e-3, "{tilt:?}: {up}");
    }
}

#[test]
fn softer_soles_are_pressed_in_as_much_more() {
    let mut setup = setup();
    let mut height = |factor: f64| {
        setup.scene.plant_mismatch.contact_stiffness = factor;
        hold(&mut SimBackend::new(&setup.robot, &setup.scene).unwrap(), &setup, 2000, u64::MAX).0.feet[0][2]
    };
    let (nominal, soft) = (height(1.0), height(0.5));
    // Not quite: the robot leans a little, the more the softer it stands, and the sole frames are not below its middle.
    assert!((soft / nominal - 2.0).abs() < 0.15, "{nominal} m, {soft} m");
}

#[test]
fn a_joint_with_a_wrong_zero_stands_beside_where_its_encoder_says() {
    let mut setup = setup();
    let joint = setup.robot.joint("right_knee_flexion").unwrap();
    let own = vec![("right_knee_flexion".to_string(), 0.01)];
    setup.scene.plant_mismatch.joint_offset = config::sensors::PerJoint { all: None, own };
    let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
    let (truth, sensors) = hold(&mut sim, &setup, 500, u64::MAX);
    let wanted = setup.robot.poses["stand"][joint];
    assert!((sensors.joint_angle[joint] - wanted).abs() < 1e-9, "the drive works with its encoder");
    assert!((truth.joint_angle[joint] - wanted + 0.01).abs() < 1e-9, "{}", truth.joint_angle[joint]);
}
