//! Test vectors of errata 1: V3 (knee), V4 (ankle), V9, V10 (friction), V11 (elasticity).

use crate::linkages;
use drives::{Ankle, Elasticity, Friction, HarmonicFriction, Knee, ScrewFriction, Transmission};

fn near(is: f64, wanted: f64) {
    assert!((is - wanted).abs() < 1e-11 * wanted.abs().max(1.0), "{is} instead of {wanted}");
}

#[test]
fn v3_knee() {
    let geometry = linkages::sample_knee();
    let knee = Transmission::Knee(Knee::new(&geometry).unwrap());
    let (q, qd) = ([0.7, 0.0, 0.0], [1.3, 0.0, 0.0]);
    let gear = knee.at(q, qd).unwrap();
    near(gear.ratio[0], -18.706852166);
    near(gear.speed(qd), -24.3189078158);
    near(gear.bias, 156.925891629);
    // Angles count from the zero pose: l(0) = |(0.31, -0.005)|, l(0.7) of the vector.
    let rest = 0.31_f64.hypot(0.005);
    near(gear.angle, std::f64::consts::TAU * (0.28407693168345227 - rest) / 0.005);
}

#[test]
fn v4_ankle() {
    let (q, qd) = ([0.0, 0.12, -0.25], [0.5, 0.8, -1.1]);
    for (share, rate) in [(0.0, 37.6743826962), (1.0, 38.1743826962), (-1.0, 37.1743826962)] {
        let ankle = Transmission::Ankle(Ankle::new(&linkages::sample_ankle(share)).unwrap());
        let gear = ankle.at(q, qd).unwrap();
        let turns = std::f64::consts::TAU / 0.005;
        near(gear.ratio[0], share);
        near(gear.ratio[1] / turns, -0.05188277873564248);
        near(gear.ratio[2] / turns, -0.06498776741702006);
        near(gear.bias / turns, -0.03143345969009449);
        near(gear.speed(qd), rate);
        let zero = ankle.at([0.0; 3], [0.0; 3]).unwrap();
        near(zero.angle, 0.0);
    }
}

/// Table C.1.
const HFUC_25_100: HarmonicFriction =
    HarmonicFriction { starting: 0.104, load: 0.0, viscous: 8.94e-5, coupled: 6.58e-4 };
const HFUC_32_50: HarmonicFriction =
    HarmonicFriction { starting: 0.246, load: 5.49e-3, viscous: 1.52e-4, coupled: 6.21e-4 };

#[test]
fn v9_harmonic_drive() {
    let vectors = [
        (HFUC_25_100, 200.0, 1.0, 0.775998586073, -0.224001413927),
        (HFUC_25_100, 200.0, -0.5, -0.716121602948, -0.216121602948),
        (HFUC_25_100, -350.0, -0.8, -0.54028285784, 0.25971714216),
        (HFUC_25_100, -350.0, 0.3, 0.565532025464, 0.265532025464),
        (HFUC_25_100, 100.0, 0.05, -0.0673731535003, -0.1173731535),
        (HFUC_32_50, 200.0, 1.0, 0.640529702839, -0.359470297161),
        (HFUC_32_50, 200.0, -0.5, -0.892095919845, -0.392095919845),
        (HFUC_32_50, -350.0, -0.8, -0.409538451474, 0.390461548526),
        (HFUC_32_50, -350.0, 0.3, 0.771012404138, 0.471012404138),
        (HFUC_32_50, 100.0, 0.05, -0.226509797192, -0.276509797192),
    ];
    for (gear, speed, motor, load, friction) in vectors {
        near(gear.load_torque(speed, motor, 0.0).unwrap(), load);
        near(Friction::Harmonic(gear).torque(speed, motor, 0.0).unwrap(), friction);
        near(gear.torque(speed, load, 0.0), friction); // the same from (2.61) at the load found
    }
}

#[test]
fn v10_roller_screw() {
    let knee = ScrewFriction { direct: 0.860, indirect: 0.858 };
    let ankle = ScrewFriction { direct: 0.8379, indirect: 0.82222 };
    let vectors = [
        (knee, 10.0, 1.5, -0.21),
        (knee, -10.0, -1.5, 0.21),
        (knee, 10.0, -1.5, -0.248251748252),
        (knee, -10.0, 1.5, 0.248251748252),
        (ankle, 10.0, 1.5, -0.24315),
        (ankle, -10.0, -1.5, 0.24315),
        (ankle, 10.0, -1.5, -0.324329254944),
        (ankle, -10.0, 1.5, 0.324329254944),
    ];
    for (screw, speed, motor, friction) in vectors {
        near(screw.torque(speed, motor, 0.0), friction);
    }
}

#[test]
fn v11_elasticity() {
    let gear = Elasticity { stiffness: [1e4, 1.6e4, 2.1e4], knees: [14.0, 48.0] };
    let vectors = [
        (0.001, 10.0, 0.005),
        (0.0014, 14.0, 0.0098),
        (0.002, 23.6, 0.02108),
        (0.003525, 48.0, 0.075675),
        (0.006, 99.975, 0.2587940625),
        (-0.002, -23.6, 0.02108),
        (-0.006, -99.975, 0.2587940625),
    ];
    for (torsion, torque, energy) in vectors {
        near(gear.torque(torsion), torque);
        near(gear.energy(torsion), energy);
        near(gear.torsion(torque), torsion);
    }
}
