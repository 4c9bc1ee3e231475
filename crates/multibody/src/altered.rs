//! The same tree with other masses: a robot that is not as it is described.

use crate::body::Body;
use crate::error::ModelError;
use crate::inertia::Inertia;
use crate::model::Model;
use crate::space::Sym3;

impl Model {
    /// The same robot whose bodies have the inertia that `alter` makes of theirs; it is given none for the base, the index of
    /// the joint that moves it for any other, and the inertia in the axes of the base at zero coordinates, from the body's
    /// origin. Free rotors keep theirs, which must still be in the bodies that carry them.
    ///
    /// # Errors
    /// A body would have an inertia that does not exist.
    pub fn with_bodies(
        mut self,
        alter: impl Fn(Option<usize>, Inertia) -> Inertia,
    ) -> Result<Model, ModelError> {
        for k in 0..self.bodies.len() {
            let body = &mut self.bodies[k];
            let center = nalgebra::Vector3::from(body.mc) * (1.0 / body.m);
            let altered = alter(k.checked_sub(1), Inertia::about_origin(body.m, center, body.i.matrix()));
            if let Some(fault) = altered.fault().or_else(|| altered.fault_of_moving_body()) {
                let name = self.links.iter().find(|link| link.body == k).map_or("", |link| &link.name);
                return Err(ModelError::Inertia(name.into(), fault));
            }
            (body.m, body.mc) = (altered.mass, (altered.center * altered.mass).into());
            body.i = Sym3::from_matrix(&altered.moments_about_origin());
            body.s = Body::second_moments(body.i);
            self.own[k] = body.own();
        }
        self.weigh();
        Ok(self)
    }
}
