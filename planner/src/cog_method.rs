//! Methods for the centre of gravity: the seam between the three-mass model and what solves its boundary value problem.
//!
//! | `model.cog_method` | thesis | solves | error |
//! |---|---|---|---|
//! | `collocation` | (4.50) | whatever the heights and the legs do | fourth order in the distance of the knots |
//! | `closed_form` | (4.44) | one mass at constant height, zero-moment point straight between knots | none |
//!
//! Another method is another implementation of [`BoundarySolver`], a variant here and a word in `config::gait::CogMethod`.

use crate::boundary::BoundarySolver;
use crate::closed_form::ClosedForm;
use crate::collocation::Collocation;
use config::gait;

/// The method that a gait names.
#[derive(Clone)]
pub(crate) enum CogSolver {
    Collocation(Box<Collocation>),
    ClosedForm(Box<ClosedForm>),
}

impl CogSolver {
    pub(crate) fn new(method: gait::CogMethod) -> Self {
        match method {
            gait::CogMethod::Collocation => Self::Collocation(Box::default()),
            gait::CogMethod::ClosedForm => Self::ClosedForm(Box::default()),
        }
    }

    pub(crate) fn solver(&self) -> &dyn BoundarySolver {
        match self {
            Self::Collocation(method) => &**method,
            Self::ClosedForm(method) => &**method,
        }
    }

    pub(crate) fn solver_mut(&mut self) -> &mut dyn BoundarySolver {
        match self {
            Self::Collocation(method) => &mut **method,
            Self::ClosedForm(method) => &mut **method,
        }
    }
}
