//! Linkages to test with: the sample geometries of errata 1 (V3, V4), and legs of the size of Lola's.

use drives::{Ankle, AnkleGeometry, Knee, KneeGeometry, Transmission};

/// V3.
pub(crate) fn sample_knee() -> KneeGeometry {
    KneeGeometry {
        axis: [0.0, 0.0, 1.0],
        joint: [0.44, 0.0, 0.0],
        pivot: [0.10, 0.06, 0.0],
        attachment: [-0.03, 0.055, 0.0],
        lead: 0.005,
    }
}

/// V4.
pub(crate) fn sample_ankle(knee_share: f64) -> AnkleGeometry {
    let norm = (0.05_f64.powi(2) + 0.02_f64.powi(2) + 1.0).sqrt();
    AnkleGeometry {
        adduction_axis: [1.0, 0.0, 0.0],
        flexion_axis: [0.0, 1.0, 0.0],
        ankle: [0.0, 0.0, -0.43],
        foot: [0.0, 0.0, -0.012],
        screw_top: [-0.06, 0.045, -0.02],
        screw_axis: [0.05 / norm, 0.02 / norm, -1.0 / norm],
        attachment: [-0.065, 0.05, 0.01],
        coupler: 0.25,
        lead: 0.005,
        bevel: 1.0,
        belt: 1.0,
        knee_share,
    }
}

/// Knee of a leg, axis mirrored for `side` = -1.
pub(crate) fn knee(side: f64) -> Transmission {
    let geometry = KneeGeometry {
        axis: [0.0, side, 0.0],
        joint: [0.0, 0.0, -0.424],
        pivot: [0.0, 0.0, -0.124],
        attachment: [0.0349, 0.0, 0.0548],
        lead: 0.010,
    };
    Transmission::Knee(Knee::new(&geometry).unwrap())
}

/// Inner (`share` = 1) or outer (-1) ankle motor of the right leg.
pub(crate) fn ankle(share: f64) -> Ankle {
    let geometry = AnkleGeometry {
        adduction_axis: [-1.0, 0.0, 0.0],
        flexion_axis: [0.0, 1.0, 0.0],
        ankle: [0.0, 0.0, -0.426],
        foot: [0.0; 3],
        screw_top: [-0.055, 0.045 * share, -0.122],
        screw_axis: [0.0, 0.0, -1.0],
        attachment: [-0.055, 0.045 * share, 0.0],
        coupler: 0.18,
        lead: 0.005,
        bevel: 1.0,
        belt: 1.0,
        knee_share: share,
    };
    Ankle::new(&geometry).unwrap()
}
