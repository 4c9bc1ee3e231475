//! What `[sensors]` of a scene becomes.

use config::sensors::{
    EncoderErrors, EncoderSide, ForceTorqueErrors, ImuErrors, PerJoint, SensorErrors, SignalErrors,
};
use config::{Scene, root};

/// The shipped scene `stand` with more at its end.
fn scene(test: &str, more: &str) -> Scene {
    let path = std::env::temp_dir().join(format!("gangwerk-sensors-{test}-{}.toml", std::process::id()));
    let stand = std::fs::read_to_string(root(None).join("scenes/stand.toml")).unwrap();
    std::fs::write(&path, stand + more).unwrap();
    let scene = Scene::load(&path);
    let _ = std::fs::remove_file(path);
    scene.unwrap_or_else(|e| panic!("{e}"))
}

fn named(all: Option<f64>, own: &[(&str, f64)]) -> PerJoint {
    PerJoint { all, own: own.iter().map(|(name, x)| ((*name).to_owned(), *x)).collect() }
}

#[test]
fn absent_is_exact() {
    let exact = SensorErrors::default();
    assert_eq!(scene("absent", "").sensors, exact);
    assert_eq!(scene("empty", "[sensors]\n[sensors.encoder]\n[sensors.imu]").sensors, exact);
}

#[test]
fn every_key() {
    let text = r#"
        [sensors]
        side = "motor"
        [sensors.encoder]
        bits = { all = 17, right_toe_flexion = 16 }
        bias_rad = { right_ankle_flexion = -0.05 }
        speed_by_difference = true
        delay = 0.002
        [sensors.motor_encoder]
        counts = { all = 11520, head_pan = 2000 }
        gear_ratio = { all = 100, right_toe_flexion = 50 }
        [sensors.force_torque]
        inertia = true
        bias_compensation = true
        offset = [3.0, 0.2]
        filter_time = 0.001
        noise = [1.0, 0.1]
        step = [1.0, 0.1]
        force_range = [700.0, 700.0, 2000.0]
        moment_range = [200.0, 200.0, 100.0]
        delay = 0.001
        [sensors.imu]
        bandwidth = 50.0
        bias_rad = [0.005, 0.0, 0.0]
        orientation_noise = 2e-4
        orientation_step = 1e-4
        rate_noise = 1e-3
        rate_step = 2e-3
        rate_range = 3.49
        acceleration_noise = 0.02
        acceleration_step = 0.01
        acceleration_range = 19.62
        period = 0.005
        delay = 0.003
    "#;
    let expected = SensorErrors {
        side: EncoderSide::Motor,
        encoder: EncoderErrors {
            counts: named(Some(131_072.0), &[("right_toe_flexion", 65_536.0)]),
            bias: named(None, &[("right_ankle_flexion", -0.05)]),
            speed_by_difference: true,
            delay: 0.002,
        },
        motor_encoder: EncoderErrors {
            counts: named(Some(1_152_000.0), &[("head_pan", 200_000.0), ("right_toe_flexion", 576_000.0)]),
            ..EncoderErrors::default()
        },
        force_torque: ForceTorqueErrors {
            inertia: true,
            bias_compensation: true,
            offset: [3.0, 0.2],
            filter_time: 0.001,
            noise: [1.0, 0.1],
            step: [1.0, 0.1],
            force_range: [700.0, 700.0, 2000.0],
            moment_range: [200.0, 200.0, 100.0],
            delay: 0.001,
        },
        imu: ImuErrors {
            bandwidth: 50.0,
            bias: [0.005, 0.0, 0.0],
            orientation: SignalErrors { noise: 2e-4, step: 1e-4, range: f64::INFINITY },
            rate: SignalErrors { noise: 1e-3, step: 2e-3, range: 3.49 },
            acceleration: SignalErrors { noise: 0.02, step: 0.01, range: 19.62 },
            period: 0.005,
            delay: 0.003,
        },
    };
    assert_eq!(scene("all", text).sensors, expected);
}

/// A joint that is not named has what stands under `all`; without `all`, nothing.
#[test]
fn joints_have_their_own_or_that_of_all() {
    let encoder = scene("own", "[sensors.encoder]\nbits = { head_pan = 9 }\nbias_rad = 0.01").sensors.encoder;
    assert_eq!((encoder.counts.of("head_pan"), encoder.counts.of("head_tilt")), (Some(512.0), None));
    assert_eq!(encoder.bias.of("head_tilt"), Some(0.01));
}
