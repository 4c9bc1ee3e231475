//! Masses of the simulated robot where they are not what its software believes.

use config::plant_mismatch::PlantMismatch;
use multibody::{Inertia, Model, ModelError};
use nalgebra::Vector3;

/// The model with the masses of a plant mismatch. What hangs on a locked joint is part of the body before it.
///
/// # Errors
/// A body would have an inertia that does not exist.
pub(crate) fn with_mismatch(model: Model, mismatch: &PlantMismatch) -> Result<Model, ModelError> {
    if mismatch.weighs_as_described() {
        return Ok(model);
    }
    let factors: Vec<f64> =
        model.joint_names().iter().map(|name| mismatch.mass_factor.of(name).unwrap_or(1.0)).collect();
    model.with_bodies(|joint, described| {
        let factor = joint.map_or(mismatch.torso_mass_factor, |joint| factors[joint]);
        let heavier =
            Inertia { mass: factor * described.mass, moments: factor * described.moments, ..described };
        if joint.is_some() {
            return heavier;
        }
        let torso = Inertia { center: heavier.center + Vector3::from(mismatch.torso_cog_shift), ..heavier };
        mismatch.payload.map_or(torso, |load| {
            let center = described.center + Vector3::from(load.position);
            torso.with(&Inertia { mass: load.mass, center, ..Inertia::NONE })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::Setup;
    use config::plant_mismatch::Payload;
    use config::sensors::PerJoint;
    use multibody::Data;

    fn lola() -> Model {
        Setup::load(&config::root(None), "stand").unwrap().robot.model().unwrap()
    }

    /// Weight and centre of gravity against sums over the bodies, and the mass matrix against both.
    #[test]
    fn heavier_bodies_and_a_payload_move_weight_and_centre_of_gravity() {
        let model = lola();
        let mut mismatch = PlantMismatch::default();
        assert!(mismatch.weighs_as_described());
        mismatch.mass_factor = PerJoint { all: None, own: vec![("right_knee_flexion".into(), 2.0)] };
        mismatch.torso_cog_shift = [0.03, 0.0, 0.0];
        mismatch.payload = Some(Payload { mass: 8.0, position: [0.1, 0.0, 0.2] });
        let shank = std::cell::Cell::new(0.0);
        let knee = model.joint_index("right_knee_flexion");
        let torso = std::cell::Cell::new(Inertia::NONE);
        let same = model.clone().with_bodies(|joint, body| {
            if joint == knee {
                shank.set(body.mass);
            }
            if joint.is_none() {
                torso.set(body);
            }
            body
        });
        let (shank, torso) = (shank.get(), torso.get());
        assert!((same.unwrap().mass() - model.mass()).abs() < 1e-12);
        let changed = with_mismatch(model.clone(), &mismatch).unwrap();
        assert!((changed.mass() - model.mass() - shank - 8.0).abs() < 1e-9);
        let expected = (torso.mass * (torso.center + Vector3::new(0.03, 0.0, 0.0))
            + 8.0 * (torso.center + Vector3::new(0.1, 0.0, 0.2)))
            / (torso.mass + 8.0);
        assert!((changed.base_cog() - expected).norm() < 1e-12);
        // At rest the force on the base is the whole weight.
        let (mut data, q) = (Data::new(&changed), changed.neutral());
        let (rest, mut force) = (vec![0.0; changed.nv()], vec![0.0; changed.nv()]);
        changed.forward_kinematics(&mut data, &q);
        changed.inverse_dynamics(&mut data, &q, &rest, &rest, &mut force);
        assert!((force[2] - changed.mass() * multibody::GRAVITY_ACCELERATION).abs() < 1e-9);
    }
}
