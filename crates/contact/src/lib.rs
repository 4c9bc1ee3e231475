//! Contact of the feet with the ground (thesis 2.3.1): massless viscoelastic layers on unilateral constraints with
//! Coulomb friction.
//!
//! | part | where |
//! |---|---|
//! | independent points, closed form | [`point`] |

pub mod point;
